"""Known formulas that differ from a claim by one fault: a numeric search, whose results are not yet proven.

For each formula that symrot derives for the claim's quantity, the search computes the values that the claim's formula
should have. It then looks for a single part whose change gives these values.
"""

import math
import re
from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from itertools import chain
from typing import Any, NamedTuple

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.reader import read_expression
from symrot.checker.claim.tree import TIME, Node, Path, number, replaced, walk
from symrot.checker.recognition.array_faults import ArrayFault, agree, array_faults, has_arrays, matching
from symrot.checker.recognition.identification import UNIT_OF_NAME
from symrot.checker.recognition.known_formulas import Known, by_fingerprint, ending_of
from symrot.checker.recognition.letters import POINTS, ids_of_nodes, is_atom, letters_of_formula, nodes_of, text_of
from symrot.checker.recognition.moments import is_shifted_moment, is_symmetric_body
from symrot.checker.recognition.pairing import absent_name, is_fitting, renaming_of_product, renamings, strangeness
from symrot.checker.recognition.parts import (
    LACKING,
    Change,
    Letters,
    Part,
    PointOfLetters,
    Values,
    Variant,
    is_multiple,
    is_superfluous,
    multiples,
    near,
    parts,
    values_of,
    variants,
)
from symrot.checker.recognition.renaming import is_consistent
from symrot.checker.recognition.solved_relations import solved_relations
from symrot.checker.repair.edits import COST, PRODUCT_OF_INERTIA, flattened, normalise_factors
from symrot.checker.repair.filter import NumericFilter
from symrot.checker.repair.points import UndefinedValue
from symrot.checker.repair.rows import entries_of, is_matrix, shape_of, times, transposed
from symrot.checker.units.units import read_unit

__all__ = ["Near", "near_formulas"]

MOST_PAIRS = 1500
"""The most pairs of a known formula and a renaming that are compared."""
MOST_NODES = 500
"""The most symbols and operations of a formula that is searched."""
FEW = 3
"""The most symbols of a known formula with an angle that a claim without angles may mean."""
SQUARED = ", squared"


class Near(NamedTuple):
    """A candidate for a repair: the claim's formula after one change has the values of a known formula."""

    cost: float
    code: str  # of the fault that the change corrects
    tree: Node  # the claim's formula after the change
    known: Known
    renamed: int  # the number of symbols of ``known`` that have another letter in the claim
    has_other_unit: bool  # the claim's formula has another unit than ``known``
    is_shifted: bool  # the claim's formula is ``known`` plus m d^2, for a parallel axis
    is_symmetric: bool  # the claim's formula is ``known`` for a body with two equal moments of inertia
    letter: str  # the changed part, if it is a symbol
    array_letters: int = 0  # letters of a formula with vectors, each component as one letter; 0 for other formulas
    renaming: tuple[tuple[str, str], ...] = ()  # (symbol of ``known``, letter of the claim)


def near_formulas(claim: Claim, named: NamedFormula, fits: Callable[[Known], bool]) -> list[Near]:
    """Return changes of a claim's formula that may turn it into a known formula with ``fits(known)``, the cheapest
    first. The code "none" means that no change is needed.
    """
    if sum(1 for _ in walk(named.formula)) > MOST_NODES:
        return []
    letters = letters_of_formula(claim, named)
    if letters is None:
        return []
    scale = values_of(named.formula, letters.points)
    if scale is None:
        return []
    search = _search(claim, named, letters, scale)
    names = [text_of(atom) for atom in letters.atoms]
    inside = {node for angle in letters.angles for node in nodes_of(angle)}
    angles = {text_of(atom) for atom in letters.atoms if atom in inside}
    nearest: dict[tuple[Node, str], Near] = {}
    pairs = 0
    quantity = text_of(_quantity(named))
    for mine, known in chain((("", known) for known in _known_formulas() if fits(known)), _relations(quantity)):
        is_wrong_kind = _is_column(known) != is_matrix(scale[0])
        is_of_body = claim.context.body is not None and claim.context.body.kind.title in known.name
        has_one_angle = (
            len(letters.angles) == 1 and len(_names(known)) == len(letters.atoms) - 1
        )  # in a factor too many
        is_other = _has_angles(known) != bool(letters.angles) and len(_names(known)) > FEW and not has_one_angle
        is_wrong_kind = is_wrong_kind or (is_other and not is_of_body)
        if is_wrong_kind or abs(len(_names(known)) - len(letters.atoms)) > 1:
            continue
        of_product = renaming_of_product(names) if "quaternion product" in known.name else None
        for renaming in [of_product] if of_product else renamings(_names(known), names, angles):
            own = [(old, new) for old, new in renaming.items() if new is not None]
            if mine and not is_consistent([*own, (mine, quantity)]):
                continue
            pairs += 1
            if pairs > MOST_PAIRS:
                break
            compared = _compared(search, known, renaming)
            # under the hypotheses the claim's formula equals a known one: no change is needed
            if compared is None and claim.hypotheses:
                return []
            if compared is None and has_root_of_sum(named.formula):
                texts = tuple((old, new) for old, new in renaming.items() if new is not None)
                whole = Near(
                    0.0, "none", named.formula, known, strangeness(renaming), False, False, False, "", 0, texts
                )
                return [whole]
            for candidate in compared or ():
                key = (candidate.tree, known.name)
                if key not in nearest or candidate.cost < nearest[key].cost:
                    nearest[key] = candidate
    return sorted(nearest.values(), key=lambda candidate: candidate.cost)


def has_root_of_sum(formula: Node) -> bool:
    """Return whether a formula has the root of a sum."""
    # fingerprints of equal formulas with such roots may differ by a sign
    roots = (node.args[0] for _, node in walk(formula) if node.kind == "call" and node.value == "sqrt")
    return any(node.kind == "sum" for root in roots for _, node in walk(root))


def _quantity(named: NamedFormula) -> Node:
    """Return the name or rate, such as L or ``diff(L(t), t)``, for which a claim is solved."""
    atoms = (node for _, node in walk(named.side) if is_atom(node))
    own = (atom for atom in atoms if named.name in (atom.value, *(str(n.value) for _, n in walk(atom))))
    return next(own, named.side)


def _relations(quantity: str) -> Iterator[tuple[str, Known]]:
    """Yield (symbol, formula) for each known relation, solved for a symbol that the claim may call ``quantity``."""
    for name, known in solved_relations():
        if is_fitting(name, quantity, is_angle=False):
            yield name, known


@cache
def _known_formulas() -> tuple[Known, ...]:
    formulas = [known for group in by_fingerprint().values() for known in group]
    return tuple(known for known in formulas if not known.is_step and not known.is_relation)


@cache
def _names(known: Known) -> tuple[str, ...]:
    words = dict.fromkeys(re.findall(r"[A-Za-z]\w*", known.text))
    return tuple(word for word in words if word not in _BUILT_IN)


_BUILT_IN = {"sin", "cos", "tan", "cot", "sec", "csc", "sqrt", "pi", "Matrix", "abs", "Abs", "atan2", "acos", "asin"}


@cache
def _known_pieces(known: Known) -> frozenset[int]:
    return ids_of_nodes(_tree(known))


def _is_column(known: Known) -> bool:
    """Return whether a known formula is a vector or matrix; False for the two arguments of an atan2."""
    return known.text.startswith("Matrix") and not ending_of(known.name).endswith("atan2")


@cache
def _has_angles(known: Known) -> bool:
    return re.search(r"\b(sin|cos|tan)\(", known.text) is not None


@cache
def _tree(known: Known) -> Node:
    return read_expression(known.text)


class Search(NamedTuple):
    """A claim's formula, its values, and its changes that undo usual faults, sorted by the values that they give."""

    named: NamedFormula
    letters: Letters
    variants: dict[Path, list[tuple[float, Variant]]]  # for each part: (value at the first test point, change)
    arrays: list[ArrayFault]  # edits of the whole formula
    has_arrays: bool
    values: Values

    def matching(self, part: Part) -> Iterator[Variant]:
        """Yield the changes that give a part the values ``part.needed``, with which the whole formula is right."""
        values = self.variants.get(part.path, [])
        (first, *_) = part.needed
        if is_matrix(first) or not values:
            return
        slack = abs(first) * CLOSE
        place = bisect_left(values, first - slack, key=lambda pair: pair[0])
        while place < len(values) and values[place][0] <= first + slack:
            variant = values[place][1]
            if all(map(near, variant.values, part.needed)):
                yield variant
            place += 1


CLOSE = 1e-8
"""The largest relative difference between values that are compared further."""


def _search(claim: Claim, named: NamedFormula, letters: Letters, values: Values) -> Search:
    everything = Letters({**letters.atoms, LACKING: RANDOM}, letters.angles, [
        replace(point, symbols={**point.symbols, str(LACKING.value): value})
        for point, value in zip(letters.points, RANDOM, strict=True)
    ], letters.aliases)  # fmt: skip
    kinds = {path: node.kind for path, node in walk(named.formula)}
    by_path = {}
    for path, node in walk(named.formula):
        parent = kinds[path[:-1]] if path else ""
        made = [(variant.values[0], variant) for variant in variants(node, parent, everything)]
        by_path[path] = sorted(made, key=lambda pair: pair[0])
    numeric = NumericFilter(claim)
    arrays = array_faults(named.formula, numeric, everything)
    return Search(named, letters, by_path, arrays, has_arrays(named.formula, numeric), values)


def _compared(search: Search, known: Known, renaming: dict[str, str | None]) -> list[Near] | None:
    """Return the single changes after which the claim's formula has the values of ``known``.

    None if the claim's formula has the values of ``known`` already.
    """
    named, letters = search.named, search.letters
    # renaming: known symbol -> name in the claim, or None for a symbol that the claim lacks
    atoms = {text_of(atom): atom for atom in letters.atoms}
    values = {mine: RANDOM if other is None else letters.atoms[atoms[other]] for mine, other in renaming.items()}
    own = [
        PointOfLetters({mine: value[n] for mine, value in values.items()}, {}, {}, _known_pieces(known))
        for n in range(POINTS)
    ]
    target = values_of(_tree(known), own)
    if target is None:
        return []
    changes: list[tuple[Path, Change, str]] = []
    by_edit: list[tuple[float, str, Node, str]] = []
    for view in (*_views(known, target), *_with_other_products(known, own)):
        needed = _needed(named, known, view, letters)
        if needed is not None and not known.scaled and all(map(agree, search.values, needed)):
            return None
        if needed is not None and _is_promising(search, needed):
            for part in parts(named.formula, letters.points, needed):
                letter = text_of(part.node) if is_atom(part.node) else ""
                changes += ((part.path, change, letter) for change in _changes(search, part))
        if needed is not None:
            by_edit += ((edit.cost, edit.code, edit.tree, "") for edit in matching(search.arrays, needed))
    trees = [
        (change.cost, change.code, _repaired(named.formula, path, change), letter) for path, change, letter in changes
    ]
    trees += by_edit
    actual = values_of(named.formula, letters.points)
    if actual and named.side.kind in ("name", "call") and not ending_of(known.name):
        for part in parts(_tree(known), own, actual):
            if is_superfluous(part):
                code = "missing_term" if part.parent == "sum" else "factor"
                cost = COST["missing_term" if part.parent == "sum" else "solved_factor"]
                trees.append(
                    (
                        cost,
                        code,
                        _renamed(
                            _tree(known),
                            {mine: LACKING if other is None else atoms[other] for mine, other in renaming.items()},
                        ),
                        "",
                    )
                )
    if not trees:
        return []
    absent = next((name for name, other in renaming.items() if other is None), None)
    unused = [text_of(atom) for atom in letters.atoms if text_of(atom) not in renaming.values()]
    name, is_similar = absent_name(absent, renaming, unused) if absent is not None else ("", False)
    lacking = _lacking_letter(absent, name, letters) if absent is not None else None
    if lacking in letters.atoms:
        return []
    nodes = {mine: lacking if other is None else atoms[other] for mine, other in renaming.items()}
    other_unit = _has_other_unit(named, known, {mine: node for mine, node in nodes.items() if node}, letters)
    renamed = strangeness(renaming)
    is_central = "about its centre of mass" in known.name
    is_shifted = actual is not None and is_central and is_shifted_moment(actual, target, letters)
    array_letters = len(letters.atoms) if search.has_arrays else 0
    near_ones = []
    texts = tuple((mine, text_of(node)) for mine, node in nodes.items() if node is not None)
    written = [text_of(node) for node in nodes_of(named.formula) if is_atom(node)]
    for cost, code, tree, letter in trees:
        has_lacking = LACKING in nodes_of(tree)
        if has_lacking and (lacking is None or (code == "wrong_symbol" and not is_similar)):
            continue
        whole = _renamed(tree, {str(LACKING.value): lacking}) if lacking is not None else tree
        times = written.count(letter)
        is_symmetric = absent is not None and is_symmetric_body(absent, letter, renaming, times)
        flags = other_unit, is_shifted, is_symmetric
        near_ones.append(Near(cost, code, whole, known, renamed, *flags, letter, array_letters, texts))
    return near_ones


def _lacking_letter(absent: str, name: str, letters: Letters) -> Node:
    """Return the tree for ``name``, the claim's name for the known symbol ``absent``: diff(theta(t), t) for dtheta."""
    moving = {node.args[0] for atom in letters.atoms if atom.kind == "call" for node in nodes_of(atom) if node.args}
    timed = Node("call", name, (TIME,))  # if its rate occurs in the claim
    if absent.startswith("d") and name.startswith("d") and any(atom.value == "diff" for atom in letters.atoms):
        return Node("call", "diff", (Node("call", name[1:], (TIME,)), TIME))
    return timed if timed in moving else Node("name", name)


def _is_promising(search: Search, needed: Values) -> bool:
    """Return whether a change of one part gives the whole formula the values ``needed`` at the first two points."""
    # quicker than the full comparison, which follows
    formula, at = search.named.formula, search.letters.points[:2]
    return any(
        is_superfluous(part) or is_multiple(part) or any(search.matching(part))
        for part in parts(formula, at, needed[:2])
    )


def _changes(search: Search, part: Part) -> Iterator[Change]:
    if is_superfluous(part):
        code, cost = ("extra_term", 0.0) if part.parent == "sum" else ("factor", COST["factor_removed"])
        yield Change(number(int(part.parent == "product")), code, COST[code] + cost)
    elif is_multiple(part):
        yield from multiples(part)
    yield from (variant.change for variant in search.matching(part))


def _repaired(formula: Node, path: Path, change: Change) -> Node:
    """Return ``formula`` with the part at ``path`` changed."""
    tree = flattened(replaced(formula, path, lambda _: change.made))
    # a new factor may leave factors 1 and fractions in fractions; other numbers stay as typed
    return normalise_factors(tree) if change.code == "factor" else tree


def _with_other_products(known: Known, own: Sequence[PointOfLetters]) -> Iterator[Values]:
    """Yield the values of a known formula with the signs of its products of inertia reversed, if it has any."""
    names = [name for name in _names(known) if PRODUCT_OF_INERTIA.fullmatch(name)]
    if names:
        changed = [{**point.symbols, **{name: -point.symbols[name] for name in names}} for point in own]
        values = values_of(_tree(known), [PointOfLetters(symbols, {}, {}) for symbols in changed])
        if values is not None:
            yield values


def _views(known: Known, values: Values) -> Iterator[Values]:
    """Yield the values of a known formula and its variants: transposed, doubled, or with a quaternion's scalar last."""
    yield values
    if not is_matrix(values[0]):
        return
    rows, columns = shape_of(values[0]) or (0, 0)
    if rows == columns:
        yield tuple(map(transposed, values))
    # multiples of a ``scaled`` formula have the same name
    doubled = [tuple(times(2.0, value) for value in values)] if known.scaled else []
    yield from doubled
    # a quaternion with its scalar part last
    if rows == len(LAST):
        for view in (values, *doubled):
            yield tuple(tuple(value[row] for row in LAST) for value in view)


LAST = (1, 2, 3, 0)
"""The rows of a quaternion whose scalar is stored last."""

RANDOM = (0.7310585786, 1.1752011936, 0.4812118251)
"""The values of a symbol that a claim lacks."""

UNITS = {"[kg]": 1.37, "[m]": 1.61, "[s]": 0.83}
"""Factors by which the base units are made smaller, to compare the units of formulas by their values."""


def _has_other_unit(named: NamedFormula, known: Known, nodes: dict[str, Node], letters: Letters) -> bool:
    """Return whether a claim's formula has another unit than ``known`` when its letters have their usual units."""
    # nodes: known symbol -> letter of the claim
    scales = {node: _scale(UNIT_OF_NAME.get(mine)) for mine, node in nodes.items()}
    if None in scales.values() or any(atom not in scales for atom in letters.atoms):
        return False
    scaled = Letters(
        {atom: tuple(value * (scales[atom] or 1) for value in values) for atom, values in letters.atoms.items()},
        letters.angles,
        [
            PointOfLetters(
                {**point.symbols, **{str(atom.value): v[n] * (scales[atom] or 1) for atom, v in letters.atoms.items()
                                     if atom.kind == "name"}},
                {}, point.definitions,
                rates={atom: v[n] * (scales[atom] or 1) for atom, v in letters.atoms.items() if atom.kind == "call"},
            )
            for n, point in enumerate(letters.points)
        ],
    )  # fmt: skip
    # if the ratio of the values changes from SI units to those of UNITS, the units differ
    ratios = []
    for n in range(POINTS):
        plain = {mine: letters.atoms.get(node, RANDOM)[n] for mine, node in nodes.items()}
        changed = {mine: value * (scales[nodes[mine]] or 1) for mine, value in plain.items()}
        pairs = []
        for own, values in ((letters, plain), (scaled, changed)):
            value = values_of(_tree(known), [PointOfLetters(values, {}, {})])
            needed = value and _needed(named, known, value, Letters({}, {}, [own.points[n]]))
            actual = values_of(named.formula, [own.points[n]])
            if not needed or not actual or is_matrix(actual[0]) or not needed[0] or not actual[0]:
                return False
            pairs.append(actual[0] / needed[0])
        ratios.append(pairs[0] / pairs[1])
    return not all(abs(ratio - 1) <= 1e-6 for ratio in ratios)


def _scale(unit: str | None) -> float | None:
    """Return the factor from a number in SI units to one in ``UNITS``: 1.61/0.83 for "m/s". None without a unit."""
    if unit is None:
        return None
    # with factors f for m and g for s, the factor for m/s^2 is f/g^2
    powers = read_unit(unit.partition(",")[0])
    return math.prod((UNITS.get(base, 1.0) ** float(power) for base, power in powers.items()), start=1.0)


def _renamed(tree: Node, nodes: dict[str, Node]) -> Node:
    if tree.kind == "name":
        return nodes.get(str(tree.value), tree)
    return Node(tree.kind, tree.value, tuple(_renamed(child, nodes) for child in tree.args))


def _needed(named: NamedFormula, known: Known, target: Values, letters: Letters) -> Values | None:
    """Return the values that the claim's formula needs for its quantity to have the values ``target``.

    None if the formula cannot have these values.
    """
    function = _FUNCTIONS_OF_ENDINGS.get(ending_of(known.name))
    if function is None:
        return None
    if named.solve is None:
        return None
    if ending_of(known.name) == SQUARED and named.side == Node("power", None, (_quantity(named), number(2))):
        return target
    if (named.side.value, ending_of(known.name)) in (("cos", ", acos"), ("sin", ", asin")) and is_atom(
        named.side.args[0]
    ):
        return target
    try:
        # the root for a known square, the angle for a known cosine
        target = tuple(map(function, target))
    except (ValueError, TypeError):
        return None
    values = []
    for point, value in zip(letters.points, target, strict=True):
        if is_matrix(value) or (named.side.value == "diff" and named.side.args[0].kind == "name"):
            if named.side.kind not in ("name", "call"):
                return None
            values.append(value)
            continue
        name = named.name
        rates = {node: value for _, node in walk(named.side) if is_atom(node) and node.kind == "call"}
        whole = PointOfLetters({**point.symbols, name: value}, {}, point.definitions, rates=rates)
        try:
            # for the side 2*omega, twice the value
            values.append(whole.value(named.side))
        except UndefinedValue:
            return None
    return tuple(values)


def _root(value: Any) -> float:
    return math.sqrt(value)


def _multiple_of_arc(factor: int, function: Callable[..., float]) -> Callable[[Any], float]:
    return lambda value: factor * function(*(entries_of(value) if is_matrix(value) else [value]))


_FUNCTIONS_OF_ENDINGS: dict[str, Callable[[Any], Any]] = {
    "": lambda value: value, SQUARED: _root, ", acos": _multiple_of_arc(1, math.acos),
    ", 2 acos": _multiple_of_arc(2, math.acos), ", asin": _multiple_of_arc(1, math.asin),
    ", atan2": _multiple_of_arc(1, math.atan2), ", 2 atan2": _multiple_of_arc(2, math.atan2),
}  # fmt: skip
"""Ending of the name of a known formula -> the function of its value that is the quantity."""
