"""Identification of a formula: a look-up by fingerprint among the formulas that symrot derives, then a proof.

A formula is recognised whatever its symbols are called, transposed or not, with either sign, and with the scalar part
of a quaternion first or last. The signature of a symbol is the value of a formula where this symbol has one number and
all others have another; symbols with equal signatures are paired. Every match is proven by the exact engine.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import islice, permutations
from typing import Any

from sympy import Expr, Function, ImmutableMatrix, Rational, Symbol
from sympy.matrices import MatrixBase

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.interpreter import Interpreter, time
from symrot.checker.claim.named_formula import named_formula
from symrot.checker.claim.quantities import has_natural_base, letters_of_quantities, with_natural_base
from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.source.text import claim_of_text
from symrot.checker.claim.tree import Node, walk
from symrot.checker.context.admission import admits_letters, admits_name
from symrot.checker.context.statements import read_context
from symrot.checker.latex.reader import read_latex_formula
from symrot.checker.recognition.fingerprint import PRIME, Fingerprint, NotInField, fingerprint, values_at
from symrot.checker.recognition.formulas.attitudes import CROSS_PRODUCT
from symrot.checker.recognition.known_formulas import Known, by_fingerprint, relation_key
from symrot.checker.recognition.printed_text import read_printed
from symrot.checker.recognition.renaming import component, is_consistent
from symrot.checker.recognition.signature_pairs import MOST_TRIES, name_of, pairings
from symrot.checker.recognition.usual_letters import UNIT_OF_NAME, agree_in_unit, has_usual_letter, plain_name
from symrot.checker.verdict import Identification
from symrot.errors import InputError, complaint
from symrot.exact.decide import decide
from symrot.exact.decision import flatten
from symrot.exact.ring.ratio import TooLarge

__all__ = ["Identification", "identified", "identify", "known_value", "named_parts"]

MOST = 8
"""The largest number of known formulas that `identify` returns by default."""

MOST_DRAWS = 24
"""The largest number of test points at which the constant factor between two formulas is sought."""
FACTORS = tuple(Rational(*pair) for pair in ((1, 1), (-1, 1)))
SCALES = (*FACTORS, *(Rational(*pair) for pair in ((2, 1), (-2, 1), (1, 2), (-1, 2), (4, 1), (1, 4))))
FEW_SYMBOLS = 4
"""A formula for a named quantity with at most this many symbols is recognised only in the letters that books use.

For a matrix, whose entries say more, the limit is one symbol less.
"""
LAST_FIRST = (3, 0, 1, 2)
"""The order of the rows of a scalar-last quaternion that puts the scalar first."""


@dataclass(frozen=True)
class View:
    """One arrangement of a formula's entries, such as the transpose."""

    how: str  # the difference from the formula in words, such as "transposed"
    shape: tuple[int, int] | None
    order: tuple[int, ...]  # entry i of the arrangement is entry order[i] of the formula, both counted row by row


def identify(
    formula: Any, *, most: int = MOST, body: str = "", frame: str = "", sequence: str = ""
) -> list[Identification]:
    """Return the known formulas that a formula equals, up to letters, sign and transposition; the most similar first.

    Parameters
    ----------
    formula : str, Expr or Matrix
        Text in SymPy syntax or as typed, LaTeX (text with a backslash or a dollar sign), or a SymPy value. An equation
        such as ``I = ..``, which gives a formula for the quantity I, stands for this formula.
    most : int
        How many names to return at most.
    body, frame, sequence : str
        A body in words, such as ``"thin rod"``; the frame, ``"body"`` or ``"space"``; a sequence of Euler angles, such
        as ``"ZXZ"``. Formulas for other bodies, frames or sequences are left out.

    Returns
    -------
    list of Identification
        Each match is proven. The list is empty for a formula that symrot does not know.

    Raises
    ------
    InputError
        For text that is not understood, with the position; for a ``formula`` of another type; and for words in
        ``body``, ``frame`` or ``sequence`` that symrot does not know.

    Notes
    -----
    Source: ``.source`` of each identification names the call or page that derives it.

    Examples
    --------
    >>> identify("Matrix([[sin(b)*sin(c), cos(c), 0], [sin(b)*cos(c), -sin(c), 0], [cos(b), 0, 1]])")[0].name
    'ZXZ body-frame rate Jacobian, omega = B dq/dt'
    """
    stated = read_context((), body, frame, sequence)
    fitting = (
        known
        for known in identified(_value(formula))
        if admits_name(stated, known.name, "") and admits_letters(stated, known.name, known.mapping, ())
    )
    return list(islice(fitting, most))


def _value(formula: Any) -> Any:
    if isinstance(formula, MatrixBase):
        return ImmutableMatrix(formula)
    if isinstance(formula, Expr):
        return formula
    if not isinstance(formula, str):
        raise InputError(f"expected a formula as text or a SymPy value to identify, got {type(formula).__name__}")
    latex = "\\" in formula or "$" in formula
    if "=" in formula and (named := named_formula(claim := claim_of_text(formula))) is not None:
        return _in_new_names(named.formula, formula, claim.define)
    if not latex and "=" in formula:
        raise complaint(formula, "", formula.index("="), "one formula without '=' to identify")
    text, vectors = read_latex_formula(formula) if latex else (formula, ())
    return _in_new_names(read_expression(text), text, [(vector.name, vector.components) for vector in vectors])


def _in_new_names(tree: Node, source: str, define: Sequence[tuple[str, Node]] = ()) -> Any:
    """Return the SymPy value of a formula's tree, with a new real symbol for each letter.

    Names in ``define``, pairs (name, tree), are replaced by their formulas. A name whose rate occurs becomes a function
    of time. ``source`` is the text of the formula, for error messages.
    """
    tree = with_natural_base(tree) if has_natural_base([tree]) else tree
    quantities: dict[str, Any] = {letter: Symbol(letter, real=True) for letter in letters_of_quantities([tree])}
    for name, definition in define:
        quantities[name] = Interpreter(implied=True, values=quantities).read(definition, source)
    return Interpreter(implied=True, values=quantities).read(tree, source)


def named_parts(claim: Claim) -> tuple[str, ...]:
    """Return notes on the known matrices in a claim and its definitions, such as "R is the rotation matrix .."."""
    return tuple(
        f"{place} is the {identification}"
        for place, value in _parts(claim)
        if isinstance(value, MatrixBase) and len(value) > 2 and len(value.atoms(Function, Symbol) - {time}) > 1
        for identification in islice(identified(ImmutableMatrix(value), steps=False), 1)
    )


def _parts(claim: Claim) -> Iterator[tuple[str, Any]]:
    """Yield (words, value), such as ("the left side", value), for each side that is not a single name, and (name,
    value) for each definition that a side uses.
    """
    assert claim.relation is not None
    sides = claim.relation[1:]
    values = (claim.equation.left, claim.equation.right)
    for place, side, value in zip(("the left side", "the right side"), sides, values, strict=True):
        if side.kind != "name":
            yield place, value
    used = {node.value for side in sides for _, node in walk(side) if node.kind == "name"}
    for name, _ in claim.define:
        if name in used:
            yield name, claim.definitions.values[name]


def _any(known: Identification) -> bool:
    return True


def identified(
    value: Any,
    steps: bool = True,
    named: bool = False,
    quantity: str | None = None,
    is_relation: bool = False,
    fits: Callable[[Identification], bool] = _any,
) -> Iterator[Identification]:
    """Yield the formulas known to symrot that equal a SymPy value, perhaps transposed or with other letters.

    First come the formulas that need the fewest changes of form (transposition, sign, factor) and of letters.

    Parameters
    ----------
    value : Any
        A scalar or matrix, from a claim of a user. If ``is_relation``, the value is the difference of the sides of the
        claim's equation, and only known relations are searched.
    steps : bool
        Whether steps of derivations are searched too.
    named : bool
        Whether the claim has a name for the value. Otherwise products of few symbols are left out.
    quantity : str or None
        The name that the claim gives to the value. If there is one, the letters of the claim must not mix up axes: if
        I_1 stands for the moment about some axis, omega_1 must be the component along the same axis.
    fits : function
        Takes a known formula, as Identification; tells whether the author of a claim can mean it, judged by units and
        names. The formulas that cannot be meant are left out.
    """
    entries, shape = flatten(value)
    try:
        own = fingerprint(entries)
    except NotInField:
        return
    for views in (_views(shape, len(entries)), _permuted(entries, shape)):
        matches = [
            match
            for view in views
            for known in by_fingerprint().get(relation_key(own.key(view.shape, view.order), is_relation), ())
            if (steps or not known.is_step)
            and (named or not known.only_named)
            and (match := _matched(known, own, entries, view, quantity, fits)) is not None
        ]
        if matches:
            break
    matches.sort(key=lambda match: (quantity is not None and "sign" in match.how, *_changes(match)))
    names = set()
    for identification in matches:
        if identification.name not in names:
            names.add(identification.name)
            yield identification


def _changes(match: Identification) -> tuple[int, int, int]:
    """Return the sort key of a match, smallest if the claim is written most like the known formula.

    It has three numbers: the changes of the formula as a whole, such as a transposed matrix or another sign; the
    symbols of the known formula that have another name in the claim; and those of them that begin with another letter.
    """
    others = sum(mine.lstrip("d")[0].lower() != new[0].lower() for mine, new in match.mapping.items())
    return bool(match.how) + match.how.count(" and "), len(match.mapping), others


def _views(shape: tuple[int, int] | None, count: int) -> Iterator[View]:
    """Yield the arrangements of ``count`` entries in which a formula is searched.

    The first arrangement is the formula itself, the second its transpose, if it is a vector or matrix. A formula with
    four rows or columns may belong to quaternions: then each of the two arrangements is also yielded in the form that
    it has if the scalar part of a quaternion is stored last.
    """
    plain = tuple(range(count))
    yield View("", shape, plain)
    if shape is None or shape == (1, 1):
        return
    rows, columns = shape
    transposed = tuple(i * columns + j for j in range(columns) for i in range(rows))
    how = "transposed" if min(shape) > 1 else "as a row" if columns == 1 else "as a column"
    yield View(how, (columns, rows), transposed)
    if 4 not in shape:
        return
    row = LAST_FIRST if rows == 4 else range(rows)
    column = LAST_FIRST if columns == 4 else range(columns)
    stored = tuple(i * columns + j for i in row for j in column)
    yield View("with the scalar part of the quaternion stored last", shape, stored)
    both = tuple(i * columns + j for j in column for i in row)
    yield View("transposed and with the scalar part of the quaternion stored last", (columns, rows), both)


def _permuted(entries: Sequence[Expr], shape: tuple[int, int] | None) -> Iterator[View]:
    """Yield the arrangements of a symmetric 3 x 3 matrix with the axes x, y, z in another order.

    Yield nothing for any other formula.
    """
    if shape != (3, 3) or any(entries[3 * i + j] != entries[3 * j + i] for i in range(3) for j in range(i)):
        return
    for axes in permutations(range(3)):
        if axes != (0, 1, 2):
            order = tuple(3 * i + j for i in axes for j in axes)
            yield View(f"with the axes in the order {', '.join('xyz'[axis] for axis in axes)}", shape, order)


@cache
def known_value(text: str) -> Any:
    """Return the SymPy value of a known formula's text, whose names become real symbols."""
    tree = read_printed(text)
    names = {str(node.value) for _, node in walk(tree) if node.kind == "name" and node.value != "pi"}
    interpreter = Interpreter(values={name: Symbol(name, real=True) for name in names}, implied=True)
    return interpreter.read(tree, text)


@cache
def _known_entries(text: str) -> tuple[tuple[Expr, ...], Fingerprint]:
    entries, _ = flatten(known_value(text))
    return tuple(entries), fingerprint(entries)


def _matched(
    known: Known,
    own: Fingerprint,
    entries: Sequence[Expr],
    view: View,
    quantity: str | None,
    fits: Callable[[Identification], bool],
) -> Identification | None:
    """Return the identification of a formula with ``known`` if the two are proven equal; otherwise None.

    Parameters
    ----------
    known : Known
    own : Fingerprint
        The fingerprint of the formula.
    entries : sequence of Expr
        The entries of the formula; ``view`` is the order in which they are compared.
    view : View
    quantity : str or None
        The name that the claim gives to the formula.
    fits : function
        Takes an identification; tells whether the author of a claim can mean it, judged by names, units and context.
    """
    theirs, print_of = _known_entries(known.text)
    ordered = [entries[n] for n in view.order]
    for pairing in islice(pairings(print_of, own, view.order), MOST_TRIES):
        few = known.is_relation or (quantity is not None and len(pairing) <= FEW_SYMBOLS - (view.shape is not None))
        if (known.only_named or few) and not all(_is_usual(*pair) for pair in pairing.items()):
            continue
        pairs = [(name_of(mine), name_of(other)) for mine, other in pairing.items()]
        if (few or (known.only_named and view.shape is not None)) and not _keeps_names(pairs):
            continue
        has_units = view.shape == (3, 1) and not known.name.endswith(CROSS_PRODUCT)  # v and n are any vectors there
        if quantity is not None and not (_keeps_rates(pairs) and (not has_units or _keeps_units(pairs))):
            continue
        ordered_by_factor = "quaternion product" in known.name  # in a1*a2 - b1*b2 the numbers distinguish the factors
        placed = [*pairs, *component(known.name, quantity or "")]
        if quantity is not None and not ordered_by_factor and not is_consistent(placed, known.has_fixed_axes):
            continue
        factor = _factor(theirs, ordered, pairing, own.idle, SCALES if known.scaled else FACTORS)
        if factor is None:
            continue
        renaming = {mine: other for mine, other in pairs if not _alike(mine, other)}
        changes = [part for part in (view.how, "" if known.is_relation else _factor_text(factor)) if part]
        match = Identification(known.name, " and ".join(changes), dict(sorted(renaming.items())), known.source)
        if not fits(match):
            continue
        left = [factor * entry.xreplace(pairing) for entry in theirs]
        try:
            if decide(ImmutableMatrix(left), ImmutableMatrix(ordered)).verdict != "true":
                continue
        except (InputError, TooLarge):
            continue
        return match
    return None


def _keeps_names(pairs: Sequence[tuple[str, str]]) -> bool:
    """Return whether a name that occurs in both formulas is paired with itself: False for (I, J) and (J, I)."""
    names = [(plain_name(mine), plain_name(other)) for mine, other in pairs]
    new = {other for _, other in names}
    return all(mine == other or mine not in new for mine, other in names)


def _keeps_rates(pairs: Sequence[tuple[str, str]]) -> bool:
    """Return whether a renaming of L_1 to L(t) also renames dL_1 to ``diff(L(t), t)``.

    ``pairs`` are (known name, name in the claim).
    """
    renamed = dict(pairs)
    functions = {mine: renamed[mine] for mine in renamed if renamed[mine].endswith("(t)") and f"d{mine}" in renamed}
    return all(renamed[f"d{mine}"] == f"diff({function}, t)" for mine, function in functions.items())


def _keeps_units(pairs: Sequence[tuple[str, str]]) -> bool:
    """Return whether books use each letter of a claim with the unit of the known symbol for which it stands.

    ``pairs`` are (known symbol, letter of the claim). A symbol without a unit may have any letter; x, y and z may have
    any letter that books do not use with another unit.
    """
    # x, y, z may be the components of any vector
    with_unit = [(mine, other) for mine, other in pairs if UNIT_OF_NAME.get(mine) != "1"]
    return all(agree_in_unit(mine, other) for mine, other in with_unit) and all(
        has_usual_letter(mine, other) for mine, other in with_unit if mine not in ("x", "y", "z")
    )


def _is_usual(known: Expr, own: Expr) -> bool:
    """Return whether books use the claim's letter ``own`` with the unit of ``known``, a symbol of a known formula."""
    return has_usual_letter(name_of(known), name_of(own))


def _alike(mine: str, other: str) -> bool:
    """Return whether two texts name the same quantity, such as ``dphi`` and ``diff(phi(t), t)``."""
    return other in (mine, f"{mine}(t)") or (mine.startswith("d") and other == f"diff({mine[1:]}(t), t)")


def _factor_text(factor: Rational) -> str:
    return {1: "", -1: "with the other sign"}.get(factor, f"{factor} times")


def _factor(
    known: Sequence[Expr],  # the entries of a known formula
    own: Sequence[Expr],  # the entries of the claim's formula, in the same order
    pairing: dict[Expr, Expr],  # symbol of the known formula -> symbol of the claim
    idle: Sequence[Expr],  # symbols in own that do not change its value
    factors: Sequence[Rational],
) -> Rational | None:
    """Return the first number k in ``factors`` with own = k * known for all entries at a test point.

    A test point gives each symbol of the known formula a number, and the paired symbol of the claim the same number.
    The symbols in ``idle``, which have no partner, get another number. Return None if no factor fits, or if none of the
    test points gives both formulas a value.
    """
    for draw in range(MOST_DRAWS):
        point = {mine: pow(7 + 2 * draw, 40 + n * n, PRIME) for n, mine in enumerate(pairing)}
        try:
            left = values_at(known, point)
            placed = {pairing[mine]: value for mine, value in point.items()}
            right = values_at(own, placed | dict.fromkeys(idle, draw + 11))
        except NotInField:
            continue
        for factor in factors:
            scale = int(factor.p) * pow(int(factor.q), -1, PRIME)
            if all((scale * a - b) % PRIME == 0 for a, b in zip(left, right, strict=True)):
                return factor
        return None
    return None
