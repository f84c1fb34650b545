"""Integrals of polynomials in coordinates, cosines and sines; and the limits of integration that are refused."""

from fractions import Fraction as F

import pytest

from symrot.formula.polynomial import constant, cosine, generator
from symrot.inertia.integration import _circular, domain, integrate
from symrot.inertia.shapes import SHAPES, Coordinate


@pytest.mark.thinned(10)
@pytest.mark.parametrize("powers", [(a, b) for a in range(6) for b in range(6)])
@pytest.mark.parametrize("quarters", [(0, 1), (0, 2), (0, 4), (1, 3), (-1, 1), (2, 3)])
def test_integrals_of_cosines_and_sines(powers, quarters):
    """Each agrees with 50-digit quadrature, for every sign and every quadrant."""
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
    """A limit between two quarter turns is refused with its name, not rounded."""
    angle = Coordinate("phi", "0", "pi/3")
    with pytest.raises(ValueError, match="multiples of pi/2"):
        integrate(cosine("phi"), ((angle, constant(0), generator("pi") / 3),))


def test_a_map_with_numbers_gives_the_measure_of_the_numbers():
    """The ellipsoid has the volume 4/3 pi a b c of its three numbers."""
    region = domain(SHAPES["ellipsoid"], {"a": F(1, 2), "b": F(3), "c": F(5)})
    assert integrate(region.jacobian, region.limits) == generator("pi") * 10
