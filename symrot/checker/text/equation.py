"""The verdict on one equation of a text, with allowance for assumptions that the text does not state.

The author may assume that R is a rotation matrix, that an angle is in degrees, that I is an inertia tensor and not the
unit matrix, or that i and k in I_ik are indices.
"""

import re
from dataclasses import replace

from symrot.checker.arrays.index_notation import has_index_symbols
from symrot.checker.arrays.matrices import as_rotations, matrices_of_entries
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.notation import Notation
from symrot.checker.claim.source.text import ON_PAULI, claim_of_relation
from symrot.checker.claim.tree import TIME, Node, number, walk, with_names
from symrot.checker.claim_verdict import check_claim, ended_note, within_limits
from symrot.checker.measured import in_degrees
from symrot.checker.open_equation import as_equation
from symrot.checker.rounding import with_rounding
from symrot.checker.special_cases import for_complex_numbers, for_special_directions
from symrot.checker.text.repairs import as_typed_repairs
from symrot.checker.time_limit import TimeUp
from symrot.checker.typed.readings import Reading
from symrot.checker.verdict import Diagnosis, Verdict
from symrot.exact.limits.operations import OutOfOperations

__all__ = ["for_numbers", "names_in", "verdict_on_equation"]

INDICES = "it is in index notation, which symrot does not check here; write one component, such as I_xy"

INDEX_CONDITION = "it is a condition on the quantities with indices, not an identity"

ROTATION = re.compile(r"[RCQ](_\w+)?")
"""Pattern of the names that most books use for a rotation matrix."""

MASS_OR_INERTIA = re.compile(r"[mM](_?\w)?|[IJ]_\w+|rho")
"""Pattern of the names of masses, moments of inertia and densities; a formula for an inertia tensor has such a name."""

ARRAY = re.compile(r"[A-Zpq](_?[0-9])?")
"""Pattern of the names that are often those of matrices or quaternions."""


def verdict_on_equation(claim: Claim, notation: Notation, repair: bool, plain: bool) -> Verdict:
    """Return the verdict on one equation, written in the notation of the text.

    ``repair`` says whether repairs are sought, ``plain`` whether the text is read as people type, not as SymPy syntax.
    """
    verdict = with_rounding(claim, check_claim(claim, repair and not claim.has_parts))
    if verdict.verdict == "false" and repair and claim.unsplit is not None:
        verdict = _with_complex_repairs(claim, verdict)
    verdict = in_degrees(claim, verdict, lambda other: with_rounding(other, check_claim(other, repair=False)))
    verdict = _on_rotations(claim, verdict) if verdict.verdict == "false" else verdict
    verdict = _on_rotation_by_letter(claim, verdict) if verdict.verdict == "definition" and plain else verdict
    verdict = for_special_directions(claim, for_complex_numbers(claim, verdict)) if plain else verdict
    verdict = _with_two_meanings(claim, verdict) if verdict.verdict == "false" and plain else verdict
    # a false equation outside SymPy syntax may be meant as a condition, such as x^2 = 4
    verdict = as_equation(claim, verdict, notation) if verdict.verdict == "false" and plain else verdict
    verdict = _on_inertia_matrix(claim, verdict) if verdict.verdict == "false" else verdict
    if verdict.verdict in ("recognised", "doubtful") and _has_indices(claim):
        verdict = replace(verdict, verdict="definition", recognised_as=(), repairs=(), reason=INDICES)
    if verdict.verdict == "false" and claim.relation is not None and has_index_symbols(claim.relation):
        verdict = Verdict("definition", reason=INDEX_CONDITION, notes=verdict.notes, dimension=verdict.dimension)
    repairs = as_typed_repairs(verdict.repairs, claim, notation)
    requires, conditions = (
        tuple(notation.condition(text) for text in texts) for texts in (verdict.requires, verdict.conditions)
    )
    notes = (*claim.notes, *verdict.notes, *_on_numbers(claim, verdict), *_on_zero_powers(claim, verdict))
    return replace(verdict, repairs=repairs, notes=notes, requires=requires, conditions=conditions)


def _with_complex_repairs(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict on a false claim about complex numbers, with its probable fault and repairs."""
    from symrot.checker.repair.of_complex import complex_repairs

    try:
        with within_limits():
            diagnosis, repairs = complex_repairs(claim)
    except (OutOfOperations, TimeUp) as limit:
        return replace(verdict, notes=(*verdict.notes, ended_note(limit)))
    return replace(verdict, diagnosis=diagnosis, repairs=repairs) if repairs else verdict


def _on_inertia_matrix(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict on an equation such as ``I = -m [r]^2``, where I may be an inertia tensor or the unit matrix.

    ``verdict`` is the verdict with I as the unit matrix. If one side is just the letter I, the equation is checked once
    more with I as an inertia tensor. The new verdict is returned unless it is "false" or "definition".

    In these two cases the equation may still define the inertia tensor of some body. So the result is "definition" if
    the side opposite to I is a written-out matrix, or contains a mass, a density or a moment of inertia. In all other
    cases return ``verdict``.
    """
    sides = claim.relation[1:] if claim.relation else ()
    units = [side for side in sides if side.value == "eye"]
    if len(units) != 1 or not re.search(r"\bI\b", claim.text):
        return verdict
    assert claim.relation is not None
    sign, left, right = claim.relation
    tensor = Node("name", "I")
    renamed = (sign, tensor, right) if left is units[0] else (sign, left, tensor)
    other = check_claim(replace(claim.with_relation(renamed), symbols=tuple({*claim.symbols, "I"})))
    if other.verdict not in ("definition", "false"):
        note = "I by itself is a tensor of inertia; if it is the unit matrix, the equation is false"
        return replace(other, notes=(*other.notes, note))
    (formula,) = (side for side in sides if side is not units[0])
    names = {str(node.value) for _, node in walk(formula) if node.kind == "name"}
    is_matrix = formula.kind == "list" or formula.value in ("Matrix", "diag")
    if not is_matrix and not any(MASS_OR_INERTIA.fullmatch(name) for name in names):
        return verdict
    reason = (
        "I may be a tensor of inertia, of which the text says nothing; if it is the unit matrix, the equation is false"
    )
    return Verdict("definition", reason=reason, notes=verdict.notes, dimension=verdict.dimension)


def _with_two_meanings(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict on a claim that uses a letter for two quantities: ``L = T - V`` after a line ``I = m L^2``.

    The claim is checked with L renamed to L_1 in the earlier lines if three conditions hold. First, its left side is
    the letter L, which does not occur on the right side. Second, earlier lines use L, but do not define it. Third, L is
    not the argument of a function there. The result is the new verdict, with a note on both meanings, unless it is
    "false". In all other cases return ``verdict``.
    """
    assert claim.relation is not None
    _, left, right = claim.relation
    name, others = str(left.value), {own for own, tree in claim.define if left in [node for _, node in walk(tree)]}
    if left.kind != "name" or not others or name in dict(claim.define) or left in [node for _, node in walk(right)]:
        return verdict
    inside = {own for own, tree in claim.define for _, node in walk(tree) if node.kind == "call" and left in node.args}
    if inside:
        return verdict  # the angle of a rotation in R is the angle on the left side of psi = atan2(R11, R21)
    define = tuple((own, with_names(tree, {name: f"{name}_1"})) for own, tree in claim.define)
    other = check_claim(replace(claim, define=define), repair=False)
    if other.verdict == "false":
        return verdict  # two meanings do not help
    note = (
        f"{name} here is read as another quantity than {name} in {' and '.join(sorted(others))}; "
        "if both are the same quantity, the claim is false"
    )
    return replace(other, notes=(*other.notes, note))


def _on_zero_powers(claim: Claim, verdict: Verdict) -> tuple[str, ...]:
    """Return (note,), on the convention ``0^0 = 1``, for a true claim with a power ``x^0``; () for other claims."""
    sides = claim.relation[1:] if claim.relation else ()
    nodes = [node for side in sides for _, node in walk(side)]
    powers = [node.args[0] for node in nodes if node.kind == "power" and node.args[1] == number(0)]
    is_open = any(base.kind != "number" or not base.value for base in powers)
    return ("0^0 is read as 1, by the convention of algebra",) if is_open and verdict.verdict == "true" else ()


def _on_numbers(claim: Claim, verdict: Verdict) -> tuple[str, ...]:
    """Return (note,) for a true claim such as ``A B = B A`` whose letters are read as numbers; () for other claims."""
    if verdict.verdict != "true" or claim.relation is None:
        return ()
    known = {*dict(claim.define), *claim.symbols}
    orders = [
        [str(factor.value) for factor in node.args if factor.kind == "name" and ARRAY.fullmatch(str(factor.value))]
        for side in claim.relation[1:]
        for _, node in walk(side)
        if node.kind == "product"
    ]
    letters = [name for order in orders if len(order) > 1 for name in order if name not in known]
    exchanged = any(first != second and sorted(first) == sorted(second) for first in orders for second in orders)
    if not exchanged or not letters:
        return ()
    return (f"{' and '.join(sorted({*letters}))} are read as numbers, for which the order of factors is free",)


def _on_rotations(claim: Claim, verdict: Verdict) -> Verdict:
    """Return the verdict "conditional" on a claim that is false for general matrices but true for rotation matrices.

    Return ``verdict`` for other claims.
    """
    names = matrices_of_entries(claim.define)
    # each matrix alone, any of which suffices; then all together
    groups = [(name,) for name in names] + ([tuple(names)] if len(names) > 1 else [])
    conditions: list[str] = []
    for group in groups:
        if len(group) > 1 and conditions:
            break
        other = check_claim(replace(claim, define=tuple(as_rotations(claim.define, group))), repair=False)
        if other.verdict == "true":
            conditions.append(" and ".join(f"{name} is a rotation" for name in group))
            verdict = replace(
                other, verdict="conditional", conditions=tuple(conditions), requires=tuple(conditions),
                counterexample=verdict.counterexample,
            )  # fmt: skip
    return verdict


def _on_rotation_by_letter(claim: Claim, verdict: Verdict) -> Verdict:
    """Return "conditional" for a condition such as ``R R^T = I`` that all rotations R satisfy; otherwise ``verdict``.

    The verdict changes only for a claim about a single matrix with a letter that books use for rotations, such as R. If
    some rotations do not satisfy a condition without other letters, the verdict gets a note that says so.
    """
    names = matrices_of_entries(claim.define)
    if len(names) != 1 or not ROTATION.fullmatch(names[0]):
        return verdict
    on_rotation = _on_rotations(claim, verdict)
    if on_rotation.verdict == "conditional":
        return replace(on_rotation, reason="", repairs=(), diagnosis=Diagnosis("none", ""))
    letters = {name for side in (claim.relation or ())[1:] for name in names_in(side)}
    if letters - {names[0], "pi"}:
        return verdict  # the other letters may depend on R, as those of tr R = 1 + 2 cos(theta) do
    return replace(verdict, notes=(*verdict.notes, f"it does not hold for all rotations {names[0]}"))


def _has_indices(claim: Claim) -> bool:
    """Return whether a claim is in index notation, such as ``I_ik = m*a_i*a_k`` with the indices i and k."""
    assert claim.relation is not None
    names = {name for side in claim.relation[1:] for name in names_in(side)}
    pairs = {name.rpartition("_")[2] for name in names if re.fullmatch(r"\w+_[ijkl]{2}", name)}
    return any(f"_{index}" in name[-2:] for pair in pairs for index in pair for name in names)


def for_numbers(reading: Reading, part: tuple[Claim, Verdict], source: str) -> Verdict | None:
    """Return the verdict "conditional" on an equation that is false for Pauli's matrices and true for numbers sigma_x.

    ``part`` is the equation as a claim about matrices, and its verdict. Return None for other equations. Also return
    None if no sum is multiplied or raised to a power: the author of ``σ_x σ_y = σ_y σ_x`` means matrices, as this would
    be trivial for numbers.
    """
    claim, verdict = part
    link = reading.lines[0].links[0]
    nodes = [node for side in link[1:] for _, node in walk(side)]
    has_sum = any(node.kind in ("product", "power") and any(a.kind == "sum" for a in node.args) for node in nodes)
    if verdict.verdict != "false" or ON_PAULI not in claim.notes or not has_sum:
        return None
    other = check_claim(claim_of_relation(link, source, pauli_as_numbers=True), repair=False)
    if other.verdict != "true":
        return None
    names = sorted({str(node.value) for node in nodes if str(node.value).startswith("sigma_")})
    condition = f"{' and '.join(names)} are numbers, such as stresses, and not Pauli's matrices"
    notes = tuple(note for note in verdict.notes if note != ON_PAULI)
    return replace(
        verdict, verdict="conditional", requires=(condition,), conditions=(condition,), notes=notes, repairs=(),
        diagnosis=Diagnosis("none", ""),
    )  # fmt: skip


def names_in(tree: Node) -> set[str]:
    """Return the names of the quantities in a formula, constants and functions of time."""
    return {
        str(node.value)
        for _, node in walk(tree)
        if node.kind == "name" or (node.kind == "call" and node.args == (TIME,))
    }
