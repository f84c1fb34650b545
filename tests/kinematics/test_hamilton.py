"""The Hamilton product of any numbers: it is the product of symbols, and exact where the numbers are."""

import random
from fractions import Fraction

import numpy as np
import pytest
from sympy import Matrix, eye, symbols, zeros

from symrot.checker.repair.dual import Dual
from symrot.kinematics.conversions import multiply
from symrot.kinematics.hamilton import hamilton
from symrot.kinematics.quaternion import quaternion_product


def quaternions(count, *, low=-(2**120), high=2**120):
    draw = random.Random(21)
    return [tuple(draw.randint(low, high) for _ in range(4)) for _ in range(count)]


def test_it_is_the_product_of_symbols():
    a, b = symbols("a:4"), symbols("b:4")
    assert (Matrix(hamilton(a, b)) - quaternion_product(a, b)).expand() == zeros(4, 1)
    assert (Matrix(hamilton(b, a)) - quaternion_product(a, b)).expand() != zeros(4, 1)


def test_units_multiply_as_quaternions():
    """i j = k and i j k = -1; the first unit is one."""
    one, i, j, k = (tuple(eye(4).row(n)) for n in range(4))
    assert hamilton(i, j) == k and hamilton(hamilton(i, j), k) == tuple(-x for x in one)
    assert all(hamilton(one, q) == q == hamilton(q, one) for q in (one, i, j, k))


def test_integers_and_fractions_are_exact():
    for a, b, c in zip(quaternions(9)[:3], quaternions(9)[3:6], quaternions(9)[6:], strict=True):
        assert hamilton(hamilton(a, b), c) == hamilton(a, hamilton(b, c))
        assert sum(x * x for x in hamilton(a, b)) == sum(x * x for x in a) * sum(x * x for x in b)
        thirds = [Fraction(x, 3) for x in a]
        assert hamilton(thirds, b) == tuple(Fraction(x, 3) for x in hamilton(a, b))


def test_arrays_of_components_agree_with_the_product_of_arrays():
    """Both add the same four products, each below 1, in different orders, so three roundings bound the difference."""
    p, q = np.random.default_rng(21).uniform(-1.0, 1.0, size=(2, 500, 4))
    assert np.abs(np.array(hamilton(p.T, q.T)).T - multiply(p, q)).max() <= 6 * np.spacing(1.0)


def test_the_slope_of_a_dual_number_follows_the_product_rule():
    a, b, da, db = quaternions(4, low=-99, high=99)
    product = hamilton(
        [Dual(x, dx) for x, dx in zip(a, da, strict=True)], [Dual(x, dx) for x, dx in zip(b, db, strict=True)]
    )
    assert tuple(x.value for x in product) == hamilton(a, b)
    rule = [x + y for x, y in zip(hamilton(da, b), hamilton(a, db), strict=True)]
    assert [x.slope for x in product] == rule
    mixed = hamilton([Dual(x, dx) for x, dx in zip(a, da, strict=True)], b)  # plain numbers have slope 0
    assert [x.slope for x in mixed] == list(hamilton(da, b))


def test_other_lengths_are_refused():
    with pytest.raises(ValueError, match="unpack"):
        hamilton((1, 0, 0), (1, 0, 0, 0))
