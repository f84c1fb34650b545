"""Measured rounding errors at points where errors are large: bounds that are too small are refuted."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from symrot.certificates.rounding.bounds import bound_outputs
from symrot.certificates.rounding.library import library_problem, operations_of
from symrot.certificates.rounding.region import UNIT_NORM, Region
from symrot.kernels.library import definition
from tests.campaigns.certificates import rounding_campaign
from tests.campaigns.certificates.rounding_adversary import Field, climb
from tests.campaigns.certificates.rounding_campaign import compare
from tests.campaigns.certificates.rounding_measured import measure

GENERATED = Path(__file__).parents[2] / "generated" / "c"


def text_of(name):
    return (GENERATED / f"{name}.c").read_text(encoding="utf-8")


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    ("name", "part", "suffix"),
    [("quaternion_dcm", 0.9, ""), ("quaternion_of_dcm", 0.75, ""), ("quaternion_of_dcm", 0.66, "f"),
     ("euler_zyx_of_quaternion", 0.6, ""), ("rotation_vector_of_quaternion", 0.4, "f")],
)  # fmt: skip
def test_a_bound_that_is_too_small_is_caught(name, part, suffix):
    """The adversarial points refute half the bound, so bounds are less than twice as large as necessary."""
    operations = operations_of(name, text_of(name))[1 if suffix else 0]
    problem = library_problem(definition(name), operations)
    bounds = bound_outputs(operations, problem.box, problem.region)[:1]
    measured = measure(operations, problem.box, bounds, problem.region, 100_000)
    assert all(row.holds and row.tight for row in compare(operations, bounds, measured, name))
    small = [replace(each, bound=each.bound * part) for each in bounds]
    assert not any(row.holds for row in compare(operations, small, measured, name))


def test_the_campaign_refuses_a_bound_that_is_too_small(monkeypatch, capsys):
    name, bound = "quaternion_of_dcm", rounding_campaign.bound_outputs
    monkeypatch.setattr(
        rounding_campaign,
        "bound_outputs",
        lambda *arguments: [replace(x, bound=x.bound / 2) for x in bound(*arguments)],
    )
    rows = rounding_campaign.rows(name, text_of(name), 10_000)
    assert not any(row.holds for row in rows)
    monkeypatch.setattr(rounding_campaign, "prepare", lambda *arguments: 0)
    monkeypatch.setattr(rounding_campaign, "table", lambda *arguments: [(name, rows)])
    assert rounding_campaign.main([name, "--generated", str(GENERATED.parent)]) == 1
    assert "BROKEN" in capsys.readouterr().out


def test_what_is_measured_is_found_again_and_of_the_region():
    operations = operations_of("euler_zxz_of_quaternion", text_of("euler_zxz_of_quaternion"))[0]
    problem = library_problem(definition("euler_zxz_of_quaternion"), operations)
    bounds = bound_outputs(operations, problem.box, problem.region)[:1]
    first, second = (measure(operations, problem.box, bounds, problem.region, 2000) for _ in range(2))
    assert first == second
    q = [x for _, x in first[0].at]
    assert abs(sum(x * x for x in q) - 1) < UNIT_NORM
    assert min(np.hypot(q[0], q[3]), np.hypot(q[1], q[2])) > problem.region.clearance


def test_a_climb_leads_up_and_stays_in_the_region():
    field = Field(("x", "y"), "binary64", {"x": (Fraction(-1), Fraction(1)), "y": (Fraction(-1), Fraction(1))},
                  Region((("x", "y"),)))  # fmt: skip
    rng = np.random.default_rng(3)
    start = field.points(100, rng)
    ends = climb(lambda points: np.asarray(points[0] + 2 * points[1]), field, start, 60, rng)
    assert (np.abs((ends**2).sum(axis=0) - 1) < UNIT_NORM).all()
    assert ends[0, 0] + 2 * ends[1, 0] == pytest.approx(5**0.5, rel=1e-5)
