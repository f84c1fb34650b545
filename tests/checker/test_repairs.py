"""A part of the campaign that tests diagnoses, and for every code of a diagnosis a formula that a book might print."""

from dataclasses import replace
from functools import cache
from random import Random

import pytest

import symrot
from symrot.checker.claim.reader import read_expression
from symrot.checker.repair.canonical_form import canonical
from symrot.checker.repair.edits.faults import FAULT_DESCRIPTIONS
from symrot.checker.verdict import Repair
from tests.campaigns.checker import repairs as module
from tests.campaigns.checker.mutations import MUTATIONS, mutated, places
from tests.campaigns.checker.repair_claims import claims_of_statements
from tests.campaigns.checker.repairs import campaign, main, matrix_test, rank_of, table

TURN = "Matrix([[cos(alpha), {}sin(alpha), 0], [{}sin(alpha), cos(alpha), 0], [0, 0, 1]])"
R = "Rz(phi(t))*Rx(theta(t))"
Q, P = "q0, q1, q2, q3", "p0, p1, p2, p3"
PRINTED = {  # code: what is printed, what would be right (None: the claim holds under a condition)
    "frame_body_space": (f"diff({R}, t) == skew(vee(({R}).T*diff({R}, t)))*{R}",
                         f"diff({R}, t) == skew(vee(diff({R}, t)*({R}).T))*{R}"),
    "active_passive_transpose": (f"Rz(alpha) == {TURN.format('', '-')}", f"Rz(-alpha) == {TURN.format('', '-')}"),
    "quaternion_product_order": (f"dcm_of(qmul(({P}), ({Q}))) == dcm_of({Q})*dcm_of({P})",
                                 f"dcm_of(qmul(({Q}), ({P}))) == dcm_of({Q})*dcm_of({P})"),
    "quaternion_storage_order": (f"qmul(({Q}), (1, 0, 0, 0)) == Matrix([q1, q2, q3, q0])",
                                 f"qmul(({Q}), (1, 0, 0, 0)) == Matrix([{Q}])"),
    "commutator_order": ("Rx(a)*Ry(b) == Ry(b)*Rx(a)", "Rx(a)*Ry(b) == Rx(a)*Ry(b)"),
    "sign_of_term": ("(x + y)*(x - y) == x**2 + y**2", "(x + y)*(x - y) == x**2 - y**2"),
    "overall_sign": ("cross((a, b, c), (x, y, z)) == Matrix([c*y - b*z, a*z - c*x, b*x - a*y])",
                     "cross((a, b, c), (x, y, z)) == -Matrix([c*y - b*z, a*z - c*x, b*x - a*y])"),
    "factor": ("sin(2*x) == sin(x)*cos(x)", "sin(2*x) == 2*sin(x)*cos(x)"),
    "half_angle": ("sin(x) == 2*sin(x)*cos(x/2)", "sin(x) == 2*sin(x/2)*cos(x/2)"),
    "double_half_angle": ("cos(x) == 1 - 2*sin(x)**2", "cos(2*x) == 1 - 2*sin(x)**2"),
    "sin_cos_swap": ("cos(a + b) == cos(a)*cos(b) - sin(a)*cos(b)", "cos(a + b) == cos(a)*cos(b) - sin(a)*sin(b)"),
    "wrong_symbol": ("A*w1*w2 - B*w1*w1 == (A - B)*w1*w2", "A*w1*w2 - B*w2*w1 == (A - B)*w1*w2"),
    "missing_term": ("(a + b)**2 == a**2 + b**2", "(a + b)**2 == a**2 + b**2 + 2*a*b"),
    "extra_term": ("x*(y + z) == x*y + x*z + y*z", "x*(y + z) == x*y + x*z"),
    "lost_brackets": ("(x + y)*(x - y)*z == x**2 - y**2*z", "(x + y)*(x - y)*z == (x**2 - y**2)*z"),
    "inertia_product_sign": ("Matrix([[I_xx, -I_xy], [-I_xy, I_yy]])*Matrix([x, y]) == "
                             "Matrix([I_xx*x + I_xy*y, I_yy*y + I_xy*x])",
                             "Matrix([[I_xx, I_xy], [I_xy, I_yy]])*Matrix([x, y]) == "
                             "Matrix([I_xx*x + I_xy*y, I_yy*y + I_xy*x])"),
    "wrong_sequence_type": ("Rz(phi)*Ry(theta)*Rz(psi)*Rz(-psi)*Rx(-theta) == Rz(phi)",
                            "Rz(phi)*Rx(theta)*Rz(psi)*Rz(-psi)*Rx(-theta) == Rz(phi)"),
    "two_faults": ("cross((a, b, c), (x, y, z)) == Matrix([b*z - c*y, a*z - c*x, a*y + b*x])",
                   "cross((a, b, c), (x, y, z)) == Matrix([b*z - c*y, c*x - a*z, a*y - b*x])"),
    "requires_unit_norm": (f"det(dcm_of({Q})) == 1", None),
    "requires_symmetric_top": ("A*w == B*w", None),
    "requires_condition": ("I_xx*w + I_xy*u == I_xx*w", None),
    "sign_branch": ("sqrt(x**2) == x", None),
    "principal_value": ("asin(sin(x)) == x", None),
}  # fmt: skip
ELSEWHERE = {"none", "domain", "dimension", "exponent"}
"""No diagnosis, those that come without an edit, and those of formulas that only name a quantity."""


checked = cache(symrot.check)  # two tests inspect the verdicts on conditional claims


def same_text(first, second):
    """Return whether two claims are the same up to the order of terms and scalar factors."""
    sides = [
        [canonical(read_expression(side), lambda node: False) for side in claim.split(" == ")]
        for claim in (first, second)
    ]
    return sides[0] == sides[1]


@pytest.mark.thinned(3)
@pytest.mark.parametrize("code", PRINTED)
def test_a_printed_formula_gets_its_code_and_its_right_form(code):
    printed, right = PRINTED[code]
    verdict = checked(printed)
    assert verdict.diagnosis.code == code
    assert verdict.verdict == ("conditional" if right is None else "false")
    if right is not None:
        assert symrot.check(right, repair=False).verdict == "true"
        assert code == "two_faults" or any(same_text(repair.text, right) for repair in verdict.repairs)


def test_every_code_of_the_table_has_its_formula():
    assert set(PRINTED) == set(FAULT_DESCRIPTIONS) - ELSEWHERE


@pytest.mark.parametrize("claim", [claim for claim, right in PRINTED.values() if right is None])
def test_a_conditional_claim_is_not_repaired_by_adding_the_difference(claim):
    assert not any(repair.code == "missing_term" for repair in checked(claim).repairs)


def test_no_repair_divides_a_factor_by_itself():
    """``x/y*y/3 == 1`` was offered, which says nothing about y."""
    verdict = symrot.check("x*y == 1", assume=["x == 3"])
    assert verdict.verdict == "false" and [repair.text for repair in verdict.repairs] == ["x*y == 3*y"]


# -- the campaign -----------------------------------------------------------------------------------------------------


@pytest.fixture
def statements(monkeypatch):
    """The formulas with products only; the steps of all derivations are left to the long campaign."""
    pool = tuple(claims_of_statements())
    monkeypatch.setattr(module, "catalogue_claims", lambda: pool)
    return pool


def test_what_the_pages_show_as_products_is_true(statements):
    assert len(statements) >= 100
    source = Random(0)
    for _, claim in source.sample(statements, 12):
        assert module._decided(claim).verdict == "true", claim.text


def test_a_slice_of_the_campaign_finds_the_original_among_three_proven_repairs(statements):
    outcomes = campaign(8, seed=3)
    assert len(outcomes) >= 7
    assert sum(outcome.rank > 0 for outcome in outcomes) >= 0.9 * len(outcomes)
    assert not any(outcome.unproven for outcome in outcomes)
    assert "not proven 0" in table(outcomes)[-1]


def test_every_kind_of_fault_has_places_in_the_catalogue_and_changes_the_claim(statements):
    source = Random(1)
    for code in MUTATIONS:
        found_in = ((claim, places(claim, code, matrix_test(claim))) for _, claim in statements)
        claim, found = next((claim, found) for claim, found in found_in if found)
        made = mutated(claim, code, source, matrix_test(claim), found)
        assert (made.relation, made.define) != (claim.relation, claim.define)


def test_a_wrong_repair_is_caught(statements, monkeypatch):
    """If a diagnosis offers the claim itself, this is not proven and is not the original, and the command fails."""

    def wrong(claim, decision):
        return symrot.check("x == y").diagnosis, (Repair(claim.text, "factor", 1.0),)

    monkeypatch.setattr(module, "diagnose", wrong)
    outcomes = campaign(3, seed=1)
    assert [(outcome.rank, outcome.unproven) for outcome in outcomes] == [(0, 1)] * len(outcomes)
    assert main(["--count", "1"]) == 1


def test_the_original_is_recognised_by_its_values_and_another_true_formula_is_not(statements):
    (fault,) = module.faults(1, seed=4)
    original = fault.original.text
    definitions = dict(fault.original.define) == dict(fault.claim.define)
    assert not definitions or rank_of(replace(fault, claim=fault.original), [Repair(original, "factor", 1)])[0] == 1
    assert rank_of(fault, [Repair("eye(2) == eye(2)", "factor", 1)])[0] == 0


@pytest.mark.parametrize(("claim", "repair"), [
    ("q q* = 2|q|²", "q*conjugate(q) = abs(q)^2"), ("i j = -k", "j*i = -k"), ("σ_x σ_y = -i σ_z", "σ_y*σ_x = -i*σ_z"),
])  # fmt: skip
def test_repairs_with_quaternions_and_matrices_are_written_as_people_write_them(claim, repair):
    texts = [each.text for each in symrot.check(claim).repairs]
    assert texts[0] == repair
    assert not any(word in text for text in texts for word in ("qmul", "dot", "eye", ".T"))


@pytest.mark.parametrize(("claim", "repair"), [
    ("q̇ = ¼ q ⊗ (0, ω)", "q' = q ⊗ (0, ω)/2"),
    (r"\dot q = q\otimes\begin{bmatrix}0\\ \boldsymbol\omega\end{bmatrix}",
     r"\dot{q} = \frac{q \otimes \begin{bmatrix} 0 \\ \boldsymbol{\omega} \end{bmatrix}}{2}"),
    ("H_O = r_G x m v_G - H_G", "H_O = cross(r_G, m*v_G) + H_G"),
    ("q̇ = ½ (I + [q̃] − q qᵀ) ω", "q' = 1/2*(eye(3) + skew(q) + q*q.T)*ω"),
    ("J omega' = L + omega x (J omega)", "L = J*omega' + cross(omega, J*omega)"),
    ("q^{-1} = \\frac{q^*}{|q|}", "q^{-1} = \\frac{q^*}{|q|^2}"), ("q⁻¹ = q̄ / ‖q‖", "q^(-1) = conjugate(q)/abs(q)^2"),
])  # fmt: skip
def test_a_repair_can_be_checked_as_it_is_written(claim, repair):
    assert [each.text for each in symrot.check(claim).repairs] == [repair]
    assert symrot.check(repair).verdict in ("recognised", "true", "conditional")


def test_a_missing_vector_term_and_a_missing_square_of_a_matrix_are_found():
    (term,) = symrot.check("q p = (q0 p0 - qv . pv, q0 pv + qv x pv)", where=["q, p = quaternions"]).repairs
    assert (term.code, term.text) == ("missing_term", "q*p = [q0*p0 - dot(qv, pv), q0*pv + cross(qv, pv) + p0*qv]")
    claim = r"e^{\hat\omega\theta} = I + \hat\omega\sin\theta + \hat\omega(1-\cos\theta)"
    (square,) = symrot.check(claim).repairs
    assert square.code == "exponent" and r"[\hat{\boldsymbol{\omega}}]_\times^2 (1 - \cos(\theta))" in square.text
    assert symrot.check(square.text, repair=False).verdict == "true"


def test_the_inverse_of_a_tensor_before_a_sum_is_moved_to_the_other_side():
    claim = r"\dot{\boldsymbol\omega} = J^{-1}\left[\mathbf L %s \boldsymbol\omega\times(J\boldsymbol\omega)\right]"
    where = [r"\mathbf L = torque"]
    assert symrot.check(claim % "-", where=where).verdict == "true"
    right = r"\dot{\boldsymbol{\omega}} = J^{-1} (\mathbf{L} - \boldsymbol{\omega} \times (J \boldsymbol{\omega}))"
    assert [repair.text for repair in symrot.check(claim % "+", where=where).repairs] == [right]
