"""The exact ring under the integrals, against SymPy; and what it must refuse."""

from fractions import Fraction as F

import pytest
import sympy
from sympy import cos, sin

from symrot.inertia.integration import _circular, domain, integrate
from symrot.inertia.polynomial import (
    Polynomial,
    constant,
    cosine,
    exact_quotient,
    generator,
    reduce_circular,
    sine,
    square_root,
)
from symrot.inertia.shapes import SHAPES, Coordinate

x, y, z = map(generator, "xyz")


def test_square_roots_of_squares():
    """Root of p^2 is p, up to the sign that makes the lowest term positive; exact fractions."""
    for p in (x + 1, F(2, 3) * x**2 * y + z - y, 1 - x, 3 * x * y, constant(F(4, 9)) + x**3):
        root = square_root(p * p)
        assert root in (p, -p)
    assert square_root((x - 1) ** 2) == 1 - x


@pytest.mark.parametrize("p", [x, x * x + 1, x * x + y * y, constant(2), constant(-1), x * x + 2 * x * y - y * y])
def test_what_is_no_square_is_refused(p):
    """ValueError, and no endless series."""
    with pytest.raises(ValueError, match="not the square"):
        square_root(p)


def test_exact_quotients():
    """(p q)/p = q; None when it does not divide; division by numbers only in the operator."""
    p, q = x * y - z + F(1, 2), x**2 + y * z * 3 - 7
    assert exact_quotient(p * q, p) == q
    assert exact_quotient(p * q + 1, p) is None
    assert (p * 6) / 3 == p * 2
    with pytest.raises(ValueError, match="numbers only"):
        p / q
    with pytest.raises(ZeroDivisionError):
        p / 0


def test_derivatives_of_angles():
    """d/dtheta of s cos^2 sin, reduced, as SymPy has it."""
    theta, s = sympy.symbols("theta s")
    source = generator("s") * cosine("theta") ** 2 * sine("theta")
    found = reduce_circular(source.derivative("theta"), ["theta"])
    values = {"s": s, "cos(theta)": cos(theta), "sin(theta)": sin(theta)}
    total = sum(
        sympy.Rational(c.numerator, c.denominator) * sympy.Mul(*(values[name] ** p for name, p in monomial))
        for monomial, c in found.terms.items()
    )
    assert sympy.trigsimp(total - sympy.diff(s * cos(theta) ** 2 * sin(theta), theta)) == 0


@pytest.mark.thinned(5)
@pytest.mark.parametrize("powers", [(a, b) for a in range(6) for b in range(6)])
@pytest.mark.parametrize("quarters", [(0, 1), (0, 2), (0, 4), (1, 3), (-1, 1), (2, 3)])
def test_integrals_of_cosines_and_sines(powers, quarters):
    """Against 50-digit quadrature, each sign and each quadrant."""
    import mpmath

    with mpmath.workdps(50):
        low, high = (q * mpmath.pi / 2 for q in quarters)
        middle = [low + (high - low) * k / 4 for k in range(5)]
        expected = mpmath.quad(lambda t: mpmath.cos(t) ** powers[0] * mpmath.sin(t) ** powers[1], middle)
        found = _circular(*powers, *quarters)
        value = sum(
            mpmath.mpf(c.numerator) / c.denominator * (mpmath.pi ** dict(monomial).get("pi", 0))
            for monomial, c in found.terms.items()
        )
        assert abs(value - expected) < mpmath.mpf(10) ** -40


def test_angles_end_at_quarter_turns():
    """A limit in between is refused by name, not rounded."""
    angle = Coordinate("phi", "0", "pi/3")
    with pytest.raises(ValueError, match="quarter turn"):
        integrate(cosine("phi"), ((angle, constant(0), generator("pi") / 3),))


def test_a_map_with_numbers_gives_the_measure_of_the_numbers():
    """Ellipsoid 4/3 pi a b c."""
    region = domain(SHAPES["ellipsoid"], {"a": F(1, 2), "b": F(3), "c": F(5)})
    assert integrate(region.jacobian, region.limits) == generator("pi") * 10


def test_polynomials_compare_and_show_themselves():
    """Equality is of terms; zero has none."""
    assert x - x == constant(0) and not (x - x)
    assert x + y == y + x and hash(x + y) == hash(y + x)
    assert x != 1 and "x" in repr(x)
    assert isinstance(1 - x, Polynomial)  # a number on the left is lifted
    with pytest.raises(ValueError, match="one generator"):
        (2 * x).symbol()
