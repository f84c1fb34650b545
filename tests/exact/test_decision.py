"""The engine that decides equations in stages, and what it refuses."""

import pytest
from sympy import Matrix, Rational, Symbol, symbols

from symrot.checker.claim.interpreter import Interpreter
from symrot.checker.claim.source.text import claim_of_text
from symrot.checker.decide import stages as claims
from symrot.exact import decide as formulas
from symrot.exact.decision import Decision, ShapeMismatch, first_decision, matched_sides, place_in_matrix
from symrot.exact.evidence import Counterexample
from symrot.exact.ring.ring import FormulaRing

x, y = symbols("x y", real=True)


def case_of(left, right, hypotheses=()):
    return formulas._FormulaCase([left], [right], None, FormulaRing([left, right], hypotheses))


def test_the_first_stage_that_decides_ends_the_way():
    calls = []
    stages = [
        lambda case: calls.append("first"),
        lambda case: Decision("undecided"),
        lambda case: calls.append("third"),
    ]
    assert first_decision(case_of(x, y), stages) == Decision("undecided") and calls == ["first"]


@pytest.mark.parametrize("stages", [formulas.STAGES, claims.STAGES], ids=["formulas", "claims"])
def test_every_way_ends_with_a_stage_that_decides(stages):
    assert [stage.__name__ for stage in stages][-1] == "leave_open"
    assert len({stage.__name__ for stage in stages}) == len(stages)


def test_a_way_without_a_decision_is_an_error_and_no_verdict():
    def silent(case):
        return None

    with pytest.raises(AssertionError, match="last stage, silent"):
        first_decision(case_of(x, y), [silent])


def test_claims_share_the_stages_of_formulas():
    shared = {stage for stage in formulas.STAGES if stage.__module__ == "symrot.exact.decision"}
    assert len(shared) == 5 and shared < set(claims.STAGES)


def test_a_point_that_breaks_a_hypothesis_is_no_counterexample():
    """Under x = y, the point x = 1, y = 2 refutes nothing, whatever a search returns."""
    wrong = Counterexample(((x, Rational(1)), (y, Rational(2))), None, 1, 2)
    right = Counterexample(((x, Rational(3)), (y, Rational(3))), None, 9, 3)
    case = case_of(x**2, y, [x - y])
    case.unproven = [0]
    assert case.search(lambda *_: wrong) is None
    assert case.search(lambda *_: wrong, lambda *_: right) is right


def test_sides_are_matched_entry_by_entry():
    row = Matrix([[x, y]])
    assert matched_sides(row, 0) == ([x, y], [0, 0], (1, 2))
    assert matched_sides(0, row) == ([0, 0], [x, y], (1, 2))
    for left, right in ((row, row.T), (row, 1), (x, row)):
        with pytest.raises(ShapeMismatch, match="one shape"):
            matched_sides(left, right)
    assert place_in_matrix(5, (2, 3)) == (2, 3) and place_in_matrix(0, None) is None


def test_a_counterexample_reads_as_text():
    time = Symbol("t", real=True)
    witness = Counterexample(((x, Rational(1, 2)), (time, Rational(0))), (1, 2), Rational(3), "1/3 = 0.333..")
    assert str(witness) == "entry (1, 2): 3 against 1/3 = 0.333.. at x = 1/2, t = 0"
    assert witness.values == {"x": "1/2", "t": "0"} and (witness.lhs, witness.rhs) == ("3", "1/3 = 0.333..")


def test_the_formulas_of_a_claim_are_computed_once(monkeypatch):
    """Decision, diagnosis, repairs and recognition use the same values."""
    trees = []
    read = Interpreter.read

    def counted(self, node, source="", where=""):
        trees.append(node)
        return read(self, node, source, where)

    monkeypatch.setattr(Interpreter, "read", counted)
    claim = claim_of_text("sin(2*x) == sin(x)*cos(x)", ["x > 0"])
    assert claim.equation is claim.equation and claim.definitions is claim.definitions
    assert len(trees) == 4  # two sides of the hypothesis, two sides of the claim
    other = claim.with_relation(("==", claim.relation[2], claim.relation[1]))
    assert other.definitions is claim.definitions and other.equation.left == claim.equation.right
