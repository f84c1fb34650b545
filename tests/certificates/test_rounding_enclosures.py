"""The intervals from which rounding bounds are computed: slopes of an angle, unit quaternions in a box, branches."""

from fractions import Fraction

import numpy as np
import pytest

from symrot.certificates.readback.operations import RELATIONS
from symrot.certificates.rounding import functions
from symrot.certificates.rounding.choices import decide_branches, narrow_to_branch
from symrot.certificates.rounding.output_graph import OutputGraph
from symrot.certificates.rounding.region import Region, narrowed, off_unit


def test_slopes_of_an_angle_are_enclosed_as_near_as_can_be():
    """The extrema of a/(a^2 + b^2) on a box are at its corners, or where a = |b|."""
    rng = np.random.default_rng(8)
    a, b = np.sort(rng.uniform(-2, 2, (2, 2, 300)), axis=1)
    a[:, :60], b[:, 60:120] = np.abs(a[:, :60]) + 0.1, np.abs(b[:, 60:120]) + 0.1
    with np.errstate(all="ignore"):
        slopes = functions.arc_slope(np.sort(a, axis=0), np.sort(b, axis=0))
    part = np.linspace(0, 1, 41)
    x = a[0] + (a[1] - a[0]) * part[:, None, None]
    y = b[0] + (b[1] - b[0]) * part[None, :, None]
    values = x / (x * x + y * y)
    low, high = values.min(axis=(0, 1)), values.max(axis=(0, 1))
    assert (slopes[0] <= low + 1e-15 * np.abs(low)).all()
    assert (slopes[1] >= high - 1e-15 * np.abs(high)).all()
    bounded = np.isfinite(slopes).all(axis=0)
    assert bounded.sum() > 200
    assert ((slopes[1] - slopes[0])[bounded] <= (high - low)[bounded] * 1.2 + 1e-12).mean() > 0.9


def test_a_unit_quaternion_stays_in_what_is_left_of_its_box():
    rng = np.random.default_rng(9)
    q = rng.standard_normal((4, 500))
    q /= np.sqrt((q**2).sum(axis=0))
    boxes = np.stack([q - rng.uniform(0, 0.5, q.shape), q + rng.uniform(0, 0.5, q.shape)])
    region = Region((("a", "b", "c", "d"),))
    left = narrowed(boxes, region, tuple("abcd"))
    assert ((left[0] <= q) & (q <= left[1])).all()
    assert ((left[0] >= boxes[0]) & (left[1] <= boxes[1])).all()
    assert (left[1] - left[0]).sum() < 0.9 * (boxes[1] - boxes[0]).sum()
    assert not off_unit(boxes, region, tuple("abcd")).any()
    assert off_unit(np.full((2, 4, 1), 0.6), region, tuple("abcd")).all()


@pytest.mark.parametrize("relation", RELATIONS)
def test_what_a_branch_tells_holds_of_computed_numbers(relation):
    """The numbers a, b, RN(a + b) and RN(a - b), rounded to float, stay in the intervals narrowed for the branch."""
    rng = np.random.default_rng(10)
    a, b = (rng.choice([1.0, 2.0**-20, 2.0**-26], 400) * rng.uniform(-1, 1, 400) for _ in range(2))
    a, b = (x.astype(np.float32).astype(float) for x in (a, np.where(rng.random(400) < 0.2, a, b)))
    total, difference = (x.astype(np.float32).astype(float) for x in (a + b, a - b))
    values = [a, b, total, difference]
    nodes = (("in", 0), ("in", 1), ("add", 0, 1), ("sub", 0, 1))
    for i, j in ((0, 1), (2, 3), (3, 2), (1, 2)):
        graph = OutputGraph("binary32", ("a", "b"), nodes, ((relation, i, j),))
        boxes = [np.stack([x - rng.uniform(0, 0.5, 400), x + rng.uniform(0, 0.5, 400)]) for x in values]
        truth = RELATIONS[relation](values[i], values[j])
        decided = np.where(rng.random(400) < 0.5, truth, -1).astype(np.int8)
        outside, open_ = decide_branches(relation, boxes[i], boxes[j], decided)
        assert not outside.any() and (open_ | (decided == truth)).all()
        narrow_to_branch(graph, 0, decided, boxes)
        for x, box in zip(values, boxes, strict=True):
            assert ((box[0] <= x) & (x <= box[1])).all()
        wrong = (1 - truth).astype(np.int8)
        apart = (boxes[i][0] > boxes[j][1]) | (boxes[i][1] < boxes[j][0])
        assert decide_branches(relation, boxes[i], boxes[j], wrong)[0][apart].all()


@pytest.mark.parametrize(("name", "at_zero"), [("sine_gap", Fraction(1, 6)), ("tangent_gap", Fraction(1, 3))])
def test_the_value_at_zero_is_in_the_interval_of_all_angles(name, at_zero):
    """The double nearest to 1/3 is below 1/3."""
    low, high = getattr(functions, name)(np.array([[-9.0], [9.0]]))[:, 0]
    assert Fraction(float(low)) <= -at_zero and at_zero <= Fraction(float(high))


@pytest.mark.parametrize(
    ("y", "x", "angle"),
    [((1.0, 1.0), (5e-324, 5e-324), np.pi / 2), ((-1.0, 5.7), (5e-324, 1.0), np.pi / 2), ((-1.0, 5.7), (5e-324, 1.0), -np.pi / 2),
     ((5e-324, 1e-100), (-58.0, -57.0), np.pi), ((-1e-100, -5e-324), (-58.0, -57.0), -np.pi), ((5e-324, 1.0), (57.0, 58.0), 0.0)],
)  # fmt: skip
def test_an_angle_is_enclosed_also_if_its_tangent_overflows(y, x, angle):
    with np.errstate(all="ignore"):
        low, high = functions.arc_tangent(np.array([[y[0]], [y[1]]]), np.array([[x[0]], [x[1]]]))[:, 0]
    assert low <= angle <= high and high - low <= np.pi + 1e-12
