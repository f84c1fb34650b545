"""The comparison of a claim's formula with one known formula: the single changes that make their values equal."""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula
from symrot.checker.claim.tree import TIME, Node, Path, exchanged, number, replaced, walk
from symrot.checker.recognition.known_formulas import Known, ending_of
from symrot.checker.recognition.single_faults.absent_names import absent_name
from symrot.checker.recognition.single_faults.array_faults import ArrayFault, agree, array_faults, has_arrays, matching
from symrot.checker.recognition.single_faults.known_values import RANDOM, KnownValues, needed_values, tree_of, views
from symrot.checker.recognition.single_faults.letters import POINTS, is_atom, nodes_of, text_of
from symrot.checker.recognition.single_faults.moments import is_shifted_moment, is_symmetric_body
from symrot.checker.recognition.single_faults.parts import (
    Correction,
    Letters,
    Part,
    Valued,
    Values,
    is_multiple,
    is_superfluous,
    multiples,
    near,
    parts,
)
from symrot.checker.recognition.single_faults.renamings import strangeness
from symrot.checker.recognition.single_faults.units_by_value import has_other_unit
from symrot.checker.recognition.single_faults.variants import LACKING, Variant, variants
from symrot.checker.repair.edits.faults import COST
from symrot.checker.repair.edits.trees import flattened, normalise_factors
from symrot.checker.repair.filter import NumericFilter
from symrot.checker.repair.rows import is_matrix
from symrot.exact.limits.operations import operations_left, spend

__all__ = ["Near", "Search", "compare", "search_of"]


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
    array_letters: int = 0  # number of letters, each component as one, in a formula with vectors; 0 for other formulas
    renaming: tuple[tuple[str, str], ...] = ()  # (symbol of ``known``, letter of the claim)


class Search(NamedTuple):
    """Data for finding one fault of a claim's formula, computed once and compared with every known formula."""

    named: NamedFormula
    letters: Letters
    formula: Valued  # the claim's formula
    at_two_points: Valued  # the same at the first two points only, for a quick look
    variants: dict[Path, tuple[list[float], list[Variant]]]  # path of a part -> values at the first point, changes
    arrays: list[ArrayFault]  # edits of the whole formula
    has_arrays: bool
    values: Values  # of the claim's formula
    atoms: dict[str, Node]  # text of a symbol or rate -> its node
    comparisons: dict[Any, tuple[list["Near"] | None, int]]  # results of `compare` so far, with their operations

    def matching(self, part: Part) -> Iterator[Variant]:
        """Yield the changes of a part of the claim's formula after which this part has the values ``part.needed``.

        If the part has these values, the whole formula has the values of the known formula.
        """
        values, made = self.variants[part.path]
        first = part.needed[0]
        if is_matrix(first) or not values:
            return
        slack = abs(first) * CLOSE
        for place in range(bisect_left(values, first - slack), bisect_right(values, first + slack)):
            if all(map(near, made[place].values, part.needed)):
                yield made[place]


CLOSE = 1e-8
"""Largest relative difference of two values of a part at the first test point for which the other points are tested.

One value is that of the part after a change. The other is the value that the part must have to make the whole formula
right.
"""


def search_of(claim: Claim, named: NamedFormula, letters: Letters, values: Values) -> Search:
    """Return the data for comparing a claim's formula with known formulas.

    They are the possible changes of each part of the formula, such as another sign, with the values that the part then
    has at the test points; they are computed once for all known formulas. ``letters`` has the formula's symbols and the
    test points, ``values`` are the formula's values there.
    """
    everything = Letters({**letters.atoms, LACKING: RANDOM}, letters.angles, [
        replace(point, symbols={**point.symbols, str(LACKING.value): value})
        for point, value in zip(letters.points, RANDOM, strict=True)
    ], letters.aliases)  # fmt: skip
    kinds = {path: node.kind for path, node in walk(named.formula)}
    by_path = {}
    for path, node in walk(named.formula):
        parent = kinds[path[:-1]] if path else ""
        made = sorted(variants(node, parent, everything), key=lambda variant: variant.values[0])
        by_path[path] = [variant.values[0] for variant in made], made
    numeric = NumericFilter(claim)
    arrays = array_faults(named.formula, numeric, everything)
    formula, at_two_points = Valued(named.formula, letters.points), Valued(named.formula, letters.points[:2])
    atoms = {text_of(atom): atom for atom in letters.atoms}
    has_vectors = has_arrays(named.formula, numeric)
    return Search(named, letters, formula, at_two_points, by_path, arrays, has_vectors, values, atoms, {})


def compare(search: Search, known: Known, renaming: dict[str, str | None]) -> list[Near] | None:
    """Return the single changes after which the claim's formula has the values of ``known``.

    None if the claim's formula has the values of ``known`` already. ``renaming`` maps the symbols of ``known`` to names
    in the claim, or to None for a symbol that the claim lacks.
    """
    key = known, tuple(renaming.items())
    if key not in search.comparisons:
        before = operations_left() or 0
        result = _compared(search, known, renaming)
        search.comparisons[key] = result, before - (operations_left() or 0)
        return result
    result, operations = search.comparisons[key]
    spend(operations)  # as in the first comparison: the budget of a claim does not depend on those before it
    return result


def _compared(search: Search, known: Known, renaming: dict[str, str | None]) -> list[Near] | None:
    named, letters, atoms = search.named, search.letters, search.atoms
    values = {mine: RANDOM if other is None else letters.atoms[atoms[other]] for mine, other in renaming.items()}
    own = KnownValues(known, [{mine: value[n] for mine, value in values.items()} for n in range(POINTS)])
    target = own.whole
    if target is None:
        return []
    changes: list[tuple[Path, Correction, str]] = []
    by_edit: list[tuple[float, str, Node, str]] = []
    for view in (*views(known, target), *own.with_other_signs()):
        needed = needed_values(named, known, view, letters)
        if needed is not None and not known.scaled and all(map(agree, search.values, needed)):
            return None
        if needed is not None and _is_promising(search, needed):
            for part in parts(search.formula, needed):
                letter = text_of(part.node) if is_atom(part.node) else ""
                changes += ((part.path, change, letter) for change in _changes(search, part))
        if needed is not None:
            by_edit += ((edit.cost, edit.code, edit.tree, "") for edit in matching(search.arrays, needed))
    trees = [
        (change.cost, change.code, _repaired(named.formula, path, change), letter) for path, change, letter in changes
    ]
    trees += by_edit
    if named.side.kind in ("name", "call") and not ending_of(known.name):
        nodes_of_known = {
            Node("name", mine): LACKING if other is None else atoms[other] for mine, other in renaming.items()
        }
        for part in own.superfluous(search.values):
            code, kind = ("missing_term", "missing_term") if part.parent == "sum" else ("factor", "solved_factor")
            trees.append((COST[kind], code, exchanged(tree_of(known), nodes_of_known), ""))
    if not trees:
        return []
    absent = next((name for name, other in renaming.items() if other is None), None)
    unused = [text_of(atom) for atom in letters.atoms if text_of(atom) not in renaming.values()]
    name, is_similar = absent_name(absent, renaming, unused) if absent is not None else ("", False)
    lacking = _lacking_letter(absent, name, letters) if absent is not None else None
    if lacking in letters.atoms:
        return []
    nodes = {mine: lacking if other is None else atoms[other] for mine, other in renaming.items()}
    other_unit = has_other_unit(named, known, {mine: node for mine, node in nodes.items() if node}, letters)
    renamed = strangeness(renaming)
    is_central = "about its centre of mass" in known.name
    is_shifted = is_central and is_shifted_moment(search.values, target, letters)
    array_letters = len(letters.atoms) if search.has_arrays else 0
    near_ones = []
    texts = tuple((mine, text_of(node)) for mine, node in nodes.items() if node is not None)
    written = [text_of(node) for node in nodes_of(named.formula) if is_atom(node)]
    for cost, code, tree, letter in trees:
        has_lacking = LACKING in nodes_of(tree)
        if has_lacking and (lacking is None or (code == "wrong_symbol" and not is_similar)):
            continue
        whole = exchanged(tree, {LACKING: lacking}) if lacking is not None else tree
        times = written.count(letter)
        is_symmetric = absent is not None and is_symmetric_body(absent, letter, renaming, times)
        flags = other_unit, is_shifted, is_symmetric
        near_ones.append(Near(cost, code, whole, known, renamed, *flags, letter, array_letters, texts))
    return near_ones


def _lacking_letter(absent: str, name: str, letters: Letters) -> Node:
    """Return the tree that a claim would have for ``absent``, a symbol of the known formula that the claim lacks.

    ``name`` is the claim's name for the symbol: theta gives ``theta(t)`` if the claim has the rate of theta, and dtheta
    gives ``diff(theta(t), t)`` if the claim has rates.
    """
    moving = {node.args[0] for atom in letters.atoms if atom.kind == "call" for node in nodes_of(atom) if node.args}
    timed = Node("call", name, (TIME,))  # if its rate occurs in the claim
    if absent.startswith("d") and name.startswith("d") and any(atom.value == "diff" for atom in letters.atoms):
        return Node("call", "diff", (Node("call", name[1:], (TIME,)), TIME))
    return timed if timed in moving else Node("name", name)


def _is_promising(search: Search, needed: Values) -> bool:
    """Return whether there is a part of the claim's formula whose change alone gives the formula the values ``needed``.

    Only the first two test points are used. `_changes` describes the changes.
    """
    # quicker than the full comparison, which follows
    return any(
        is_superfluous(part) or is_multiple(part) or any(search.matching(part))
        for part in parts(search.at_two_points, needed[:2])
    )


def _changes(search: Search, part: Part) -> Iterator[Correction]:
    """Yield the changes of a part of the claim's formula that give the part the values ``part.needed``.

    The part may be left out, get another sign or numeric factor, or have a usual fault corrected.
    """
    if is_superfluous(part):
        code, cost = ("extra_term", 0.0) if part.parent == "sum" else ("factor", COST["factor_removed"])
        yield Correction(number(int(part.parent == "product")), code, COST[code] + cost)
    elif is_multiple(part):
        yield from multiples(part)
    yield from (variant.change for variant in search.matching(part))


def _repaired(formula: Node, path: Path, change: Correction) -> Node:
    """Return ``formula`` with the part at ``path`` changed."""
    tree = flattened(replaced(formula, path, change.made))
    # a new factor may leave factors 1 and fractions in fractions; other numbers stay as typed
    return normalise_factors(tree) if change.code == "factor" else tree
