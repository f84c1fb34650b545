"""For a true formula of which one side is defined at fewer points than the other, the verdict says so."""

from math import inf

import pytest
from sympy import exp

import symrot
from symrot.exact.domain.everywhere import fails_everywhere, range_everywhere
from symrot.exact.domain.needs import Need


@pytest.mark.parametrize(("claim", "needs"), [
    ("(x**2 - 1)/(x - 1) == x + 1", "the left side needs x != 1"), ("x == sqrt(x)**2", "the right side needs x >= 0"),
    ("sin(theta) == sin(theta)**2/sin(theta)", "the right side needs sin(theta) != 0"), ("cos(acos(x)) == x", "the left side needs -1 <= x <= 1"),
])  # fmt: skip
def test_what_holds_only_where_it_is_defined(claim, needs):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.diagnosis.code) == ("true", "domain")
    assert needs in verdict.diagnosis.text
    assert verdict.to_json()["diagnosis"]["code"] == "domain"


@pytest.mark.parametrize(
    "claim",
    [
        "tan(x) == sin(x)/cos(x)",
        "1/x + 1/x == 2/x",
        "sin(x)**2 + cos(x)**2 == 1",
        "sqrt(x)*sqrt(x)*y/y == x*y/y*(x/x)**0",
    ],
)
def test_sides_that_are_defined_alike_are_not_remarked(claim):
    verdict = symrot.check(claim)
    assert (verdict.verdict, verdict.diagnosis.code) == ("true", "none")


def test_the_remark_is_left_out_with_the_repairs():
    assert symrot.check("x/x == 1", repair=False).diagnosis.code == "none"


def test_a_number_too_small_for_a_bound_stops_no_decision():
    assert symrot.check("sqrt(exp(-3000)*x) == sqrt(x)*exp(-1500)", repair=False).verdict == "true"


def test_of_a_number_without_a_bound_the_sign_is_known():
    assert range_everywhere(exp(-3000)) == (0, inf) and range_everywhere(-exp(-3000)) == (-inf, 0)
    assert fails_everywhere(Need(-exp(-3000), "> 0")) and not fails_everywhere(Need(exp(-3000), "> 0"))
