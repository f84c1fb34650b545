"""Exact polynomials, compared with SymPy, and what they must refuse."""

from fractions import Fraction as F

import pytest
import sympy
from sympy import cos, sin

from symrot.formula.polynomial import (
    Polynomial,
    constant,
    cosine,
    exact_quotient,
    generator,
    products_of_monomials,
    reduce_circular,
    sine,
    square_root,
)

x, y, z = map(generator, "xyz")


def test_square_roots_of_squares():
    """The root of p^2 is p with the sign that makes the lowest term positive; coefficients are exact fractions."""
    for p in (x + 1, F(2, 3) * x**2 * y + z - y, 1 - x, 3 * x * y, constant(F(4, 9)) + x**3):
        root = square_root(p * p)
        assert root in (p, -p)
    assert square_root((x - 1) ** 2) == 1 - x


@pytest.mark.parametrize("p", [x, x * x + 1, x * x + y * y, constant(2), constant(-1), x * x + 2 * x * y - y * y])
def test_what_is_no_square_is_refused(p):
    """ValueError is raised, without an endless series."""
    with pytest.raises(ValueError, match="expected the square"):
        square_root(p)


def test_exact_quotients():
    """(p q)/p = q; None if p does not divide; the operator / accepts only a number as divisor."""
    p, q = x * y - z + F(1, 2), x**2 + y * z * 3 - 7
    assert exact_quotient(p * q, p) == q
    assert exact_quotient(p * q + 1, p) is None
    assert (p * 6) / 3 == p * 2
    with pytest.raises(ValueError, match="expected a number as the divisor"):
        p / q
    with pytest.raises(ZeroDivisionError):
        p / 0


def test_derivatives_of_angles():
    """d/dtheta of s cos^2 sin, reduced, equals SymPy's result."""
    theta, s = sympy.symbols("theta s")
    source = generator("s") * cosine("theta") ** 2 * sine("theta")
    found = reduce_circular(source.derivative("theta"), ["theta"])
    values = {"s": s, "cos(theta)": cos(theta), "sin(theta)": sin(theta)}
    total = sum(
        sympy.Rational(c.numerator, c.denominator) * sympy.Mul(*(values[name] ** p for name, p in monomial))
        for monomial, c in found.terms.items()
    )
    assert sympy.trigsimp(total - sympy.diff(s * cos(theta) ** 2 * sin(theta), theta)) == 0


def test_polynomials_compare_and_show_themselves():
    """Polynomials with equal terms are equal; zero has no terms."""
    assert x - x == constant(0) and not (x - x)
    assert x + y == y + x and hash(x + y) == hash(y + x)
    assert x != 1 and "x" in repr(x)
    assert isinstance(1 - x, Polynomial)  # a number on the left is lifted
    with pytest.raises(ValueError, match="a single variable"):
        (2 * x).symbol()


def test_generators_are_names_or_numbers():
    """Numbers are sorted as numbers: 2 before 10."""
    a, b = generator(10), generator(2)
    assert (a * b * 3).terms == {((2, 1), (10, 1)): F(3)}
    assert (a + b) ** 2 == a * a + 2 * a * b + b * b


def test_products_are_counted_before_terms_cancel():
    assert len(products_of_monomials(x + y, x - y)) == 3 > len(((x + y) * (x - y)).terms)
    assert products_of_monomials(x + 1, constant(0)) == set()
