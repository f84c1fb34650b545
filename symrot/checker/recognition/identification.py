"""Identification of a formula: a look-up by fingerprint among the formulas that symrot derives, then a proof.

A formula is recognised whatever its symbols are called, transposed or not, with either sign, and with the scalar part
of a quaternion first or last. The signature of a symbol is the value of a formula where this symbol has one number and
all others have another; symbols with equal signatures are paired. Every match is proven by the exact engine.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import islice, permutations, product
from typing import Any

from sympy import Expr, Function, ImmutableMatrix, Rational, Symbol
from sympy.matrices import MatrixBase

from symrot import symbols
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
from symrot.checker.recognition.fingerprint import PRIME, Fingerprint, NotInField, Values, fingerprint, values_at
from symrot.checker.recognition.known_formulas import CROSS_PRODUCT, Known, by_fingerprint, relation_key
from symrot.checker.recognition.relations import OTHERS
from symrot.checker.recognition.renaming import axes_of, component, is_consistent
from symrot.checker.units.units import conventional_unit
from symrot.checker.verdict import Identification
from symrot.errors import InputError, complaint
from symrot.exact.decide import decide
from symrot.exact.decision import flatten
from symrot.exact.printing import as_text
from symrot.exact.ring.ratio import TooLarge

__all__ = [
    "Identification", "agree_in_unit", "identified", "identify", "known_value", "named_parts", "pairings", "plain_name",
    "unit_of",
]  # fmt: skip

UNIT_OF_NAME = {symbol.name: unit for symbol, unit in (symbols.UNIT | OTHERS).items()}

MOST = 8
"""The most names that are returned by default."""
MOST_TRIES = 720
"""The most ways of pairing symbols of equal signatures that are tried."""
MOST_DRAWS = 24
"""The most points at which the constant factor between two formulas is sought."""
FACTORS = tuple(Rational(*pair) for pair in ((1, 1), (-1, 1)))
SCALES = (*FACTORS, *(Rational(*pair) for pair in ((2, 1), (-2, 1), (1, 2), (-1, 2), (4, 1), (1, 4))))
FEW_SYMBOLS = 4
"""A formula of so few symbols is recognised only in the letters that books use for its quantities.

For a matrix, whose entries say more, it is one symbol less.
"""
LAST_FIRST = (3, 0, 1, 2)
"""The order of the rows of a scalar-last quaternion that puts the scalar first."""


LETTERS = {
    "kg m^2": r"[ABCIJ]\w*|lambda_?[1-3]", "kg": r"[mM]\w*", "N": r"[WPFG]\w*",
    "N, of a string": r"[TSF](_\w+)?", "m": r"[a-hlrsxyzLRD]\w*|ell",
    "kg m^2/s": r"[LHGhpM]\w*",
    "kg m/s": r"[pP]\w*", "N m, of momentum": r"d[LHhM]\w*",
    "N m": r"(M|N|T|Q|tau|Gamma)(_\w+)?|K_?[1-3xyz]",
    "rad/s": r"(omega|w|Omega|n|nu|p|q|r|s|S|lambda)(_?\w+)?|d(phi|theta|psi|alpha|beta|gamma)(_?[1-3])?",
    "rad/s^2": r"alpha\w*|d(omega|w|Omega)\w*|dd\w+|d[pqr]", "m/s": r"[vuV]\w*", "m/s^2": r"[ga]\w*",
    "s": r"[tTP]\w*|tau|Delta_t", "J": r"[ETKVUW]\w*", "N m/rad": r"(k|c|kappa)(_\w+)?", "m, of gyration": r"[kri]\w*",
    "1": r"([nkeulqpsgcabdr]|beta|eps|epsilon|varepsilon|eta|xi|rho|sigma|gamma|lambda|mu|[RACQ]_?[0-9])\w*",
}  # fmt: skip
"""Unit of a symbol -> the letters that books use for it; a product of few symbols is recognised in these letters."""


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
        Text in SymPy syntax or as typed, LaTeX (text with a backslash), or a SymPy value.
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
        For text that is not understood, with the position.

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
    """Return the SymPy value of a tree, with the names in ``define`` replaced by the formulas that define them."""
    # a name becomes a function of time if its rate occurs; define has names with their formulas, such as vectors
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
    """Yield (words, value) for each side of a claim and each definition in use: ("the left side", value)."""
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
    """Yield the known formulas to which a SymPy value is equal, those with the fewest changes and renamings first.

    Parameters
    ----------
    value : Any
        A scalar or matrix. If ``is_relation``, it is the difference of an equation's sides, and known relations are
        searched.
    steps : bool
        Whether steps of derivations are searched too.
    named : bool
        Whether the claim has a name for the value. Otherwise products of few symbols are left out.
    quantity : str or None
        The name that the claim gives to the value. If there is one, the renaming must not mix up axes:
        if I_1 stands for the moment about some axis, omega_1 must be the component along the same axis.
    fits : function
        Tells whether a claim may mean an identification, by its units and names; others are left out.
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
    """Return a sort key: how many rearrangements, renamed symbols and changed first letters a match needs."""
    others = sum(mine.lstrip("d")[0].lower() != new[0].lower() for mine, new in match.mapping.items())
    return bool(match.how) + match.how.count(" and "), len(match.mapping), others


def _views(shape: tuple[int, int] | None, count: int) -> Iterator[View]:
    """Yield the ways to read ``count`` entries: as they are, transposed, or as a quaternion with its scalar last."""
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

    Nothing is yielded for other formulas.
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
    tree = read_expression(text)
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
        Tells whether a claim may mean an identification, by its names, units and context.
    """
    theirs, print_of = _known_entries(known.text)
    ordered = [entries[n] for n in view.order]
    for pairing in islice(pairings(print_of, own, view.order), MOST_TRIES):
        few = known.is_relation or (quantity is not None and len(pairing) <= FEW_SYMBOLS - (view.shape is not None))
        if (known.only_named or few) and not all(_is_usual(*pair) for pair in pairing.items()):
            continue
        pairs = [(_name(mine), _name(other)) for mine, other in pairing.items()]
        if (few or (known.only_named and view.shape is not None)) and not _keeps_names(pairs):
            continue
        has_units = view.shape == (3, 1) and not known.name.endswith(CROSS_PRODUCT)  # v and n are any vectors there
        if quantity is not None and not (_keeps_rates(pairs) and (not has_units or _keeps_units(pairs))):
            continue
        ordered_by_factor = "quaternion product" in known.name  # in a1*a2 - b1*b2 the numbers distinguish the factors
        placed = [*pairs, *component(known.name, quantity or "")]
        if quantity is not None and not ordered_by_factor and not is_consistent(placed, known.is_placed):
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


@lru_cache(maxsize=4096)  # thousands of renamings of one claim need the same texts
def _name(atom: Expr) -> str:
    """Return the text of a symbol or rate, such as ``omega_1`` or ``diff(phi(t), t)``."""
    return as_text(atom)


def _keeps_names(pairs: Sequence[tuple[str, str]]) -> bool:
    """Return whether a name that occurs in both formulas is paired with itself: False for (I, J) and (J, I)."""
    # pairs (I, J) and (J, I) exchange two names
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
    """Return whether, in each of ``pairs``, books use the claim's letter with the unit of the known symbol."""
    # a symbol without unit may have any letter; x, y, z may be the components of any vector
    with_unit = [(mine, other) for mine, other in pairs if UNIT_OF_NAME.get(mine) != "1"]
    return all(agree_in_unit(mine, other) for mine, other in with_unit) and all(
        _has_usual_letter(mine, other) for mine, other in with_unit if mine not in ("x", "y", "z")
    )


def _is_usual(known: Expr, own: Expr) -> bool:
    """Return whether books use the claim's letter ``own`` with the unit of ``known``, a symbol of a known formula."""
    return _has_usual_letter(_name(known), _name(own))


def _has_usual_letter(known: str, own: str) -> bool:
    pattern = LETTERS.get(UNIT_OF_NAME.get(known, ""))
    return pattern is None or re.fullmatch(pattern, plain_name(own)) is not None


@lru_cache(maxsize=20_000)
def plain_name(name: str) -> str:
    """Return the plain name of a quantity: x for ``x(t)``, dx for ``diff(x(t), t)`` and ``x_dot``."""
    rate = re.fullmatch(r"diff\((\w+)(\(t\))?((, t)+)\)", name)
    if rate is None and (dots := re.fullmatch(r"(\w+?)_(d*)dot", name)) is not None:
        return f"d{dots[2]}{dots[1]}"
    return "d" * rate[3].count("t") + rate[1] if rate else name.removesuffix("(t)")


def _alike(mine: str, other: str) -> bool:
    """Return whether two texts name the same quantity, such as ``dphi`` and ``diff(phi(t), t)``."""
    return other in (mine, f"{mine}(t)") or (mine.startswith("d") and other == f"diff({mine[1:]}(t), t)")


def _factor_text(factor: Rational) -> str:
    return {1: "", -1: "with the other sign"}.get(factor, f"{factor} times")


def pairings(theirs: Fingerprint, own: Fingerprint, order: Sequence[int]) -> Iterator[dict[Expr, Expr]]:
    """Yield the ways to pair all symbols of a known formula ``theirs`` with those of ``own``, as dictionaries.

    ``order`` is the order in which the entries of ``own`` are compared.
    """
    # symbols are paired if their signatures are equal; pairs with equal names come first
    mine: dict[Values, list[Expr]] = {}
    for atom, row in zip(own.atoms, own.rows(order), strict=True):
        mine.setdefault(row, []).append(atom)
    groups: dict[Values, list[Expr]] = {}
    for atom, row in zip(theirs.atoms, theirs.rows(range(len(theirs.signatures[0]))), strict=True):
        groups.setdefault(row, []).append(atom)
    if {row: len(atoms) for row, atoms in mine.items()} != {row: len(atoms) for row, atoms in groups.items()}:
        return
    choices = []
    own_names = {plain_name(_name(atom)) for atom in own.atoms}
    # symbols with the names of the known formula stay as they are while the orders of the others are tried
    ordered_groups = sorted(groups.items(), key=lambda group: not {*map(_name, group[1])} <= own_names)
    for row, atoms in ordered_groups:
        names = {_name(atom) for atom in atoms}
        ordered = sorted(mine[row], key=lambda atom: (_name(atom) not in names, _name(atom)))
        choices.append([(atoms, chosen) for chosen in _nearest(atoms, ordered)])
    for chosen in product(*choices):
        yield {a: b for atoms, others in chosen for a, b in zip(atoms, others, strict=True)}


def _nearest(atoms: Sequence[Expr], others: Sequence[Expr]) -> list[tuple[Expr, ...]]:
    """Return ``others`` in several orders, to be paired one by one with ``atoms``; the most plausible order first."""
    known = {atom: (_name(atom), unit_of(_name(atom))) for atom in (*atoms, *others)}

    def difference(atom: Expr, other: Expr) -> int:
        (name, unit), (own, own_unit) = known[atom], known[other]
        contradicting = None not in (unit, own_unit) and unit != own_unit
        # a sum of these is ordered by contradicting units, then by other names, then by other first letters
        return (contradicting << 40) + ((name != own) << 20) + (name[0].lower() != own[0].lower())

    differences = [{other: difference(atom, other) for other in others} for atom in atoms]
    orders = islice(permutations(_likeliest(atoms, others, known)), MOST_TRIES)
    return sorted(orders, key=lambda order: sum(row[other] for row, other in zip(differences, order, strict=True)))


def _likeliest(
    atoms: Sequence[Expr], others: Sequence[Expr], known: Mapping[Expr, tuple[str, str | None]]
) -> list[Expr]:
    """Return ``others`` reordered so that each symbol fits the one at the same position in ``atoms``."""
    # for many symbols the caller cannot try all orders, and begins with this one
    rest, ordered = list(others), []
    names = {plain_name(known[atom][0]) for atom in atoms}
    for atom in atoms:
        name, unit = plain_name(known[atom][0]), known[atom][1]
        axes = axes_of(name)
        costs = []
        for place, other in enumerate(rest):
            own, own_unit = plain_name(known[other][0]), known[other][1]
            is_other_unit = None not in (unit, own_unit) and unit != own_unit
            is_other_axis = bool(axes) and axes_of(own) != axes
            is_other_letter = own[0].lower() != name[0].lower()
            costs.append((is_other_unit, own != name, own in names, is_other_letter, is_other_axis, place))
        ordered.append(rest.pop(min(costs)[-1]))
    return ordered


@lru_cache(maxsize=20_000)
def unit_of(name: str) -> str | None:
    """Return the conventional unit of a symbol, or None if books use the symbol for different quantities."""
    name = plain_name(name)
    if re.fullmatch(r"[ABC]", name):
        return "kg m^2"
    return "1" if re.fullmatch(r"[qp][0-3]", name) else conventional_unit(name)


def agree_in_unit(known: str, own: str) -> bool:
    """Return whether a claim's symbol ``own`` may have the unit of ``known``, a symbol of a known formula."""
    unit, conventional = UNIT_OF_NAME.get(known), unit_of(own)
    # books use some letters for different quantities
    return unit is None or conventional is None or conventional == unit


def _factor(
    theirs: Sequence[Expr],
    own: Sequence[Expr],
    pairing: dict[Expr, Expr],  # known symbol -> symbol of the claim
    idle: Sequence[Expr],  # symbols in own that do not change its value
    factors: Sequence[Rational],
) -> Rational | None:
    """Return the first k in ``factors`` with own = k * theirs at a test point, or None if there is none."""
    for draw in range(MOST_DRAWS):
        point = {mine: pow(7 + 2 * draw, 40 + n * n, PRIME) for n, mine in enumerate(pairing)}
        try:
            left = values_at(theirs, point)
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
