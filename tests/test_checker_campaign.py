"""A slice of the campaign: generated claims, no wrong verdict. ``python -m symrot.checker.campaign`` runs more of it."""

from random import Random

import pytest
from mpmath import mp

from symrot.checker.campaign import RULES, Outcome, campaign, claims, main
from symrot.checker.judge import RationalPoint, Undefined, random_point, truth
from symrot.checker.points import Meaningless, Point, agree
from symrot.checker.reader import read_expression, read_relation
from symrot.checker.tree import walk


def test_a_slice_of_the_campaign_has_no_wrong_verdict():
    found = campaign(160, seed=2)
    assert found.wrong == found.refused == ()
    assert found.undecided <= 1
    assert sum(found.counts.values()) == 160
    assert found.counts[True, "true"] == 80


def test_generated_claims_are_repeatable_and_half_of_them_true():
    first, second = list(claims(20, seed=5)), list(claims(20, seed=5))
    assert first == second
    assert sum(true for _, true in first) == 10


def numbers(seed):
    source = Random(seed)
    scalars = {name: source.uniform(0.3, 1.3) for name in ("A", "B", "X", "Y", "Z", "a", "b", "c", "x", "y", "z", "t")}
    vectors = {
        name: read_expression(f"Matrix([{', '.join(str(source.randint(1, 9)) for _ in range(n))}])")
        for name, n in (("U", 3), ("V", 3), ("P", 4), ("Q", 4))
    }
    return Point(scalars, {"F": (0.4, 0.7, 0.9)}, vectors)


@pytest.mark.parametrize(("left", "right"), RULES)
def test_every_rule_holds_in_numbers(left, right):
    """The rules of the generator, in double precision; letters of functions of time are called as such."""
    trees = [read_expression(side.replace("F", "F(t)")) for side in (left, right)]
    if left.startswith("qmul"):
        trees = [read_expression(side) for side in ("qmul(P, qmul(Q, P))", "qmul(qmul(P, Q), P)")]
    for seed in range(3):
        point = numbers(seed)
        assert all(agree(*(point.value(tree) for tree in trees)))


@pytest.mark.parametrize("seed", range(6))
def test_the_exact_values_agree_with_fifty_digits(seed):
    """Claims evaluated over the rationals and, independently, in double precision at the same point."""
    source = Random(seed)
    for claim, _ in claims(6, seed):
        exact = random_point(source)
        mp.dps = 30
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
            except (Undefined, Meaningless):
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
    """Every verdict turned round is reported, and the command fails."""
    from symrot.checker import campaign as module
    from symrot.checker.verdict import Verdict

    monkeypatch.setattr(module, "check", lambda claim, repair: Verdict("true"))
    found = module.campaign(10, seed=1)
    assert len(found.wrong) == 5
    assert isinstance(found, Outcome)
    assert main(["--count", "4"]) == 1


def test_a_point_refuses_what_it_does_not_know():
    point = RationalPoint({}, {}, {})
    for formula in ("sqrt(2)", "sin(x)", "nothing", "1/0*2"):
        with pytest.raises(Undefined):
            point.value(read_expression(formula))
    assert [node.kind for _, node in walk(read_expression("-x"))] == ["neg", "name"]
