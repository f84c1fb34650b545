"""A slice of the campaign of generated claims: no wrong verdict. ``python -m tests.campaigns.checker.identities`` runs
more.
"""

import re
from random import Random

import pytest
from mpmath import mp, workdps

from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.tree import walk
from symrot.checker.repair.points import Point, UndefinedValue
from tests.campaigns.checker.identities import RULES, UNDER, campaign, claims, main
from tests.campaigns.checker.oracle import RationalPoint, Undefined, random_point, truth
from tests.campaigns.checker.oracle_extended import HYPOTHESES, INVERSES, truth_under, wider_point

WIDER = ("exp", *INVERSES)


def test_a_slice_of_the_campaign_has_no_wrong_verdict():
    found = campaign(40, seed=2)
    assert found.wrong == found.refused == found.late == []
    assert found.counts["true claims: undecided"] + found.counts["false claims: undecided"] <= 1
    assert found.count == 40
    assert found.counts["true claims: true"] == 20


def test_generated_claims_are_repeatable_and_half_of_them_true():
    first, second = list(claims(20, seed=5)), list(claims(20, seed=5))
    assert first == second
    assert sum(true for _, _, true in first) == 10
    assert {given for _, given, _ in claims(80, seed=5)} >= {(), ("x**2 + y**2 == 1",), ("z == x*y",)}


LETTERS = {
    "A": "(a + b)", "B": "c/2", "X": "(x - z)", "Y": "y", "Z": "(z + 2)", "F": "phi(t)", "H": "(u - v)", "J": "u/2",
    "U": "Matrix([x, 2, z])", "V": "Matrix([1, y, z])", "P": "(p0, p1, p2, p3)", "Q": "(q0, q1, q2, q3)",
}  # fmt: skip


def filled(side):
    """Return a side of a rule with formulas in place of its capital letters."""
    return read_expression(re.sub(r"\b[ABXYZFHJUVPQ]\b", lambda letter: LETTERS[letter[0]], side))


@pytest.mark.parametrize(("left", "right"), RULES)
def test_every_rule_holds_exactly(left, right):
    """The rules of the generator hold over the rationals, with formulas for their letters."""
    assert truth_under(filled(left), filled(right), (), Random(1)) is True


@pytest.mark.parametrize(("given", "rules"), [(given, rules) for given, _, rules in UNDER], ids=str)
def test_rules_under_hypotheses_hold_exactly_there_and_not_everywhere(given, rules):
    for left, right in rules:
        sides = filled(left), filled(right)
        assert truth_under(*sides, given, Random(1)) is True
    assert any(truth_under(filled(left), filled(right), (), Random(1)) is False for left, right in rules)


@pytest.mark.parametrize("seed", range(3))
def test_points_obey_every_hypothesis_of_the_table(seed):
    for hypothesis in HYPOTHESES:
        point = wider_point(Random(seed), (hypothesis,))
        _, left, right = read_relation(hypothesis)
        assert point.value(left) == point.value(right)


@pytest.mark.parametrize(("formula", "function"), [
    ("sin(2*asin(k))", lambda k, n, u, v: mp.sin(2 * mp.asin(k))), ("cos(acos(k))", lambda k, n, u, v: k),
    ("cos(a + acos(k))", None), ("sin(atan(l))*cos(atan(l))", lambda k, n, u, v: mp.sin(2 * mp.atan(n)) / 2),
    ("exp(u)*exp(v/2)", lambda k, n, u, v: mp.exp(u + v / 2)),
    ("abs(-k) + sqrt(l**2)", lambda k, n, u, v: abs(k) + abs(n)),
])  # fmt: skip
@workdps(30)
def test_wider_values_agree_with_thirty_digits(formula, function):
    """Rational values of inverse functions, exponentials and roots agree with mpmath at the same point."""
    for seed in range(4):
        point = wider_point(Random(seed))
        k, n = (mp.mpf(point.values[name].numerator) / point.values[name].denominator for name in "kl")
        u, v = (2 * mp.log(mp.mpf(point.bases[n].numerator) / point.bases[n].denominator) for n in "uv")
        exact = point.value(read_expression(formula))
        if function is None:
            c, s = (mp.mpf(n.numerator) / n.denominator for n in point.halves["a"])
            expected = mp.cos(2 * mp.atan2(s, c) + mp.acos(k))
        else:
            expected = function(k, n, u, v)
        assert abs(mp.mpf(exact.numerator) / exact.denominator - expected) < mp.mpf(10) ** -25


@pytest.mark.parametrize(
    "formula", ["sqrt(2)", "sqrt(-1*abs(x))", "asin(x) + 0*x", "exp(x)", "exp(u/3)", "sin(acos(x))"]
)
def test_values_that_are_not_rational_are_undefined(formula):
    with pytest.raises(Undefined):
        wider_point(Random(0)).value(read_expression(formula))


@pytest.mark.parametrize("seed", range(6))
@workdps(30)
def test_the_exact_values_agree_with_fifty_digits(seed):
    """Rational values of claims agree with independent ones in double precision at the same point."""
    source = Random(seed)
    for claim, given, _ in claims(8, seed):
        if given or any(name in claim for name in (*WIDER, "sqrt", "abs")):
            continue
        exact = random_point(source)
        angles = {
            name: float(2 * mp.atan2(mp.mpf(s.numerator) / s.denominator, mp.mpf(c.numerator) / c.denominator))
            for name, (c, s) in exact.halves.items()
        }
        point = Point(
            {**{n: angles[n] for n in "abc"}, **{n: float(v) for n, v in exact.values.items()}, "t": 0.0},
            {f: (angles[f], float(exact.rates[f]), 0.0) for f in exact.rates}, {},
        )  # fmt: skip
        for side in read_relation(claim)[1:]:
            try:
                value = exact.value(side)
                shown = point.value(side)
            except (Undefined, UndefinedValue):
                continue
            rows = value if isinstance(value, list) else [[value]]
            others = shown if isinstance(shown, tuple) else ((shown,),)
            for row, other in zip(rows, others, strict=True):
                assert [float(v) for v in row] == pytest.approx([float(v) for v in other], rel=1e-7, abs=1e-7)


def test_truth_tells_true_from_false_and_undefined():
    source = Random(0)
    sides = {"sin(a)**2 + cos(a)**2": "1", "sin(a)": "cos(a)", "1/(x - x)": "1"}
    found = [truth(read_expression(left), read_expression(right), source) for left, right in sides.items()]
    assert found == [True, False, None]


def test_a_wrong_engine_is_caught(monkeypatch):
    """If every verdict is reversed, each is reported, and the command fails."""
    from symrot.checker.verdict import Verdict
    from tests.campaigns.checker import identities as module

    monkeypatch.setattr(module, "check", lambda claim, assume, repair: Verdict("true"))
    found = module.campaign(10, seed=1)
    assert len(found.wrong) == 5
    assert main(["--count", "4"]) == 1


def test_a_point_refuses_what_it_does_not_know():
    point = RationalPoint({}, {}, {})
    for formula in ("sqrt(2)", "sin(x)", "nothing", "1/0*2"):
        with pytest.raises(Undefined):
            point.value(read_expression(formula))
    assert [node.kind for _, node in walk(read_expression("-x"))] == ["neg", "name"]
