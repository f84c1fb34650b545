"""Verdicts on claims such as ``I_zz == m/12*(a**2 + b**2)``, which only give a formula for a named quantity.

Nothing in such a claim defines the left side; so the right side is compared with known formulas, which symrot derives.
The verdict is "recognised" if the right side equals a known formula, "doubtful" if it does after a single edit, and
"definition" otherwise. The readings of a claim are the known formulas that it can mean.
"""

import re
from collections.abc import Collection, Sequence
from dataclasses import replace
from itertools import islice

from sympy import S, acos, asin, atan2, pi

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.named_formula import NamedFormula, related_formula
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.scope import is_matrix
from symrot.checker.claim.tree import Node, exchanged, is_derivative, negated, number, product, text
from symrot.checker.recognition.naming.edited import doubtful, readings_by_other_products
from symrot.checker.recognition.naming.evidence import is_steady
from symrot.checker.recognition.naming.fit import is_unusual
from symrot.checker.recognition.naming.near_verdicts import MOST_PROOFS, formulas_nearby, nearest_verdict
from symrot.checker.recognition.naming.quantities import MOST_COMPONENTS, names_in
from symrot.checker.recognition.naming.quantity_variants import by_lengths
from symrot.checker.recognition.naming.ranks import is_in_usual_sequence
from symrot.checker.recognition.naming.readings import (
    LEAST_SYMBOLS,
    least_symbols_related,
    readings_of_claim,
    readings_of_relation,
)
from symrot.checker.recognition.single_faults.letters import is_atom
from symrot.checker.recognition.single_faults.solved_relations import put_back
from symrot.checker.repair.edits.names import PRODUCT_OF_INERTIA
from symrot.checker.repair.filter import matrix_entries
from symrot.checker.verdict import Identification, Repair, Verdict

__all__ = ["AS_IT_STANDS", "verdict_on_name", "verdict_on_relation"]

AS_IT_STANDS = "as it stands, it is the"
"""The beginning of a note on the unusual convention in which a doubtful claim is right."""

EXCHANGES = ("wrong_symbol", "sin_cos_swap")
"""Codes of the faults that turn a formula in one convention into a formula in another."""

MINUS_PRODUCTS = "products of inertia are those with the minus sign, I_xy = -integral of x*y dm"

DECELERATION = r"alpha(_\w+)?|a"
"""Pattern of the letters that may mean a deceleration."""

ENDS = {acos: (S.Zero, pi), asin: (-pi / 2, pi / 2), atan2: (-pi, pi)}
"""Inverse function -> the least and the largest of its values."""


def verdict_on_name(claim: Claim, named: NamedFormula, repair: bool) -> Verdict:
    """Return the verdict on a claim that only gives a formula for a named quantity.

    With ``repair``, also look for a fault whose correction makes the formula a known one. If there is one, the verdict
    is "doubtful", which is given only with ``repair``.

    Raises
    ------
    InputError
        For a side that cannot be read.
    """
    _ = claim.equation  # refuses a side that cannot be read
    if (mapped := _by_matrix(claim, named, repair) or _by_inverse(claim, named, repair)) is not None:
        return mapped
    readings = readings_of_claim(claim, named, named.formula, LEAST_SYMBOLS)
    readings = readings or readings_by_other_products(claim, named, named.formula) or _slowing_down(claim, named)
    if readings and not claim.context and (axes := _axes_of_symmetry(readings)):
        return Verdict("definition", reason=f"it is right for a body that is symmetric about axis {axes}; for a body "
                                            "with three different moments, one moment has a wrong index")  # fmt: skip
    if readings:
        usual = _near_usual(claim, named, readings) if repair else None
        notes = (*_on_signs_of_products(claim, named, readings), *_on_principal_values(claim, named))
        recognised = Verdict("recognised", recognised_as=readings, notes=notes)
        return recognised if usual is None else usual
    nearest = nearest_verdict(claim, named) if repair else None
    if nearest is None:
        nearest = by_lengths(named, lambda changed: verdict_on_name(claim, changed, repair))
    if nearest is not None:
        return nearest
    own, others = names_in(named.side), names_in(named.formula)
    shared = sorted(own & others if own and others else own | others)
    if named.solve is None and shared:
        names = " and ".join(filter(None, [", ".join(shared[:-1]), shared[-1]]))
        what = "this is" if len(shared) == 1 else "these are"
        reason = f"the claim is about {names}, but nothing here says what {what}"
    elif named.solve is None:
        reason = "its sides have no letter in common, and nothing here says what these quantities are"
    else:
        reason = (
            f"nothing here says what {named.name} is, and symrot derives no formula like the one on the other side: "
            "it may be a definition"
        )
    return Verdict("definition", reason=reason)


def _axes_of_symmetry(readings: Sequence[Identification]) -> str:
    """Return "1" if all ``readings`` are formulas for a body that is symmetric about axis 1, "2" for axis 2, else "".

    Also "" for axis 3, which books usually choose as the axis of symmetry.
    """
    # I_2 twice in (I_1 w_1, I_2 w_2, I_2 w_3) may be a misprint
    axes = {axis[1] if (axis := re.search("symmetric about axis ([12])$", known.name)) else "" for known in readings}
    return axes.pop() if len(axes) == 1 else ""


def _near_usual(claim: Claim, named: NamedFormula, readings: Sequence[Identification]) -> Verdict | None:
    """Return the verdict "doubtful" if a formula is right in the space frame and, after one change, in the body frame.

    Otherwise return None.
    """
    if claim.context or claim.hypotheses or not all(is_unusual(known) for known in readings):
        return None
    # such as psi' = (omega_2 sin phi + omega_1 cos phi)/cos theta: true for components in the space frame;
    # for the usual ones in the body frame, omega_1 should be omega_3
    exchanged = (near for near in formulas_nearby(claim, named)
                 if near.code in EXCHANGES and is_in_usual_sequence(near.known.name))  # fmt: skip
    for near in islice(exchanged, MOST_PROOFS):
        usual = tuple(known for known in readings_of_claim(claim, named, near.tree, 1) if not is_unusual(known))
        if usual:
            repair = Repair(f"{text(named.side)} == {text(near.tree)}", near.code, near.cost)
            return doubtful((repair,), usual, (f"{AS_IT_STANDS} {readings[0]}",))
    return None


def _by_matrix(claim: Claim, named: NamedFormula, repair: bool) -> Verdict | None:
    """Return the verdict on the matrix of a claim ``omega = [matrix] q_dot``, with repairs of the whole claim.

    None for claims of another form, for a matrix with MOST_COMPONENTS entries or fewer, and for a matrix that is
    neither equal nor near to a known rate matrix.
    """
    factors = named.formula.args if named.formula.kind == "product" else ()
    is_map = len(factors) == 2 and factors[0].value == "Matrix" and (is_atom(factors[1]) or is_derivative(factors[1]))
    if not is_map or len(matrix_entries(factors[0])) <= MOST_COMPONENTS:
        return None
    verdict = verdict_on_name(claim, named._replace(formula=factors[0]), repair)
    if not any(re.search("rate Jacobian|rate matrix", known.name) for known in verdict.recognised_as):
        return None
    repairs = []
    # a repair of the matrix becomes one of the whole equation
    for edited in verdict.repairs:
        side = product([read_relation(edited.text)[2], factors[1]])
        repairs.append(replace(edited, text=f"{text(named.side)} == {text(side)}"))
    return replace(verdict, repairs=tuple(repairs))


def _by_inverse(claim: Claim, named: NamedFormula, repair: bool) -> Verdict | None:
    """Return the verdict on a claim ``w' = J^-1*(M - ..)``, found by checking ``J*w' = M - ..`` in its place.

    The claim must define J. Return None for claims of another form, and if symrot knows no formula like
    ``J*w' = M - ..``. Repairs are written in the form of the given claim where this is possible.
    """
    if named.formula.kind != "product" or len(named.formula.args) != 2:
        return None
    first, rest = named.formula.args
    base = _inverted(first)
    if base is None or base.value not in dict(claim.define):
        return None
    left = product([base, named.side])
    moved = claim.with_relation(("==", left, rest))
    other = related_formula(moved)
    verdict = None if other is None else verdict_on_name(moved, other, repair)
    if other is None or verdict is None or verdict.verdict == "definition":
        return None
    repairs = []
    for edited in verdict.repairs:
        sides = put_back(left, rest, other, read_relation(edited.text)[2])
        if sides is not None and sides[0] == left:
            edited = replace(edited, text=f"{text(named.side)} == {text(product([first, sides[1]]))}")
        repairs.append(edited)
    return replace(verdict, repairs=tuple(repairs))


def _inverted(node: Node) -> Node | None:
    """Return the name J for the trees of 1/J and ``J^-1``; None for other trees."""
    if node.kind == "inv" and node.args[0].kind == "name":
        return node.args[0]
    is_power = node.kind == "power" and node.args[0].kind == "name"
    return node.args[0] if is_power and node.args[1] in (number(-1), negated(number(1))) else None


def verdict_on_relation(claim: Claim) -> Verdict | None:
    """Return the verdict "recognised" on a claim that is a known equation between quantities; otherwise None."""
    assert claim.relation is not None
    _, left, right = claim.relation
    whole = NamedFormula(text(left), left, right, solve=None)
    readings = readings_of_relation(claim, whole, right, least_symbols_related(left, right))
    return Verdict("recognised", recognised_as=readings) if readings else None


def _slowing_down(claim: Claim, named: NamedFormula) -> tuple[Identification, ...]:
    """Return the known formulas for constant angular acceleration that equal a claim's formula with -alpha for alpha.

    The claim then calls a deceleration alpha: ``omega = omega_0 - alpha*t``. Other letters of ``DECELERATION`` count
    too. Return () if no formula is equal.
    """
    letters = sorted(name for name in names_in(named.formula) if re.fullmatch(DECELERATION, name))
    for letter in letters:
        tree = Node("name", letter)
        other = named._replace(formula=exchanged(named.formula, {tree: negated(tree)}))
        readings = readings_of_claim(claim, other, other.formula, LEAST_SYMBOLS)
        slowing = [replace(known, how=f"{letter} is the deceleration") for known in readings if is_steady(known.name)]
        if slowing:
            return tuple(slowing)
    return ()


def _on_signs_of_products(claim: Claim, named: NamedFormula, readings: Collection[Identification]) -> tuple[str, ...]:
    """Return a note, in a tuple, on the sign of products of inertia, or () if the sign does not matter or is stated."""
    names = [name for name in names_in(named.formula) if PRODUCT_OF_INERTIA.fullmatch(name)]
    if not names or claim.context.sign_of_products or any("minus sign" in f"{k.name} {k.how}" for k in readings):
        return ()
    interpreter = claim.interpreter()
    value, symbols = interpreter.read(named.formula), [interpreter.read(Node("name", name)) for name in names]
    is_even = value == value.xreplace({symbol: -symbol for symbol in symbols})
    return () if is_even else (MINUS_PRODUCTS,)


def _on_principal_values(claim: Claim, named: NamedFormula) -> tuple[str, ...]:
    """Return a note, in a tuple, on the range of an angle that a claim gives by an inverse function; otherwise ()."""
    value = claim.interpreter().read(named.formula)
    factor, function = (1, None) if is_matrix(value) else value.as_coeff_Mul()
    if not isinstance(function, acos | asin | atan2) or named.side.kind != "name":
        return ()
    least, most = sorted(factor * end for end in ENDS[type(function)])
    below = "<" if isinstance(function, atan2) else "<="
    return (f"for {least} {below} {named.name} <= {most}: {function.func} gives only these angles",)
