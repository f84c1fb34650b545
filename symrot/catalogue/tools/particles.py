"""Sums over the particles of a body; in the LaTeX of a page they are written ``\\sum_i (m_i r_i)``."""

from collections.abc import Callable
from typing import Any

from sympy import Expr, Matrix, Symbol

from symrot import symbols
from symrot.inertia.tensor import inertia_of_point

__all__ = ["COUNT", "FIRST_MOMENT", "INERTIA", "MASS", "NAMES", "over_particles"]

COUNT = r"\sum_i"
PLACES = [Matrix(symbols.corners[3 * i : 3 * i + 3]) for i in range(3)]
ANY_MASS, ANY_PLACE = Symbol("m_i"), Matrix([Symbol(f"r_i{axis}") for axis in "xyz"])


def over_particles(term: Callable[[Expr, Matrix], Any]) -> Any:
    """Return the sum of ``term(mass, position)`` over three particles.

    Examples
    --------
    >>> over_particles(lambda m, r: m * r)[2]
    m_1*z_1 + m_2*z_2 + m_3*z_3
    """
    first, *others = (term(m, r) for m, r in zip(symbols.particle_masses, PLACES, strict=True))
    return sum(others, first)


def _sum_of(term: Any) -> Any:
    """Return the sum of ``term`` over three particles; its symbols m_i and r_i are mass and position of particle i."""
    return over_particles(
        lambda m, r: term.subs({ANY_MASS: m} | dict(zip(ANY_PLACE, r, strict=True)), simultaneous=True)
    )


MASS = over_particles(lambda m, r: m)
"""The total mass of the particles."""

FIRST_MOMENT = over_particles(lambda m, r: m * r)
"""The sum of mass times position, which is zero if the positions are measured from the centre of mass."""

INERTIA = over_particles(lambda m, r: Matrix(inertia_of_point(m, r)))
"""The inertia tensor of the particles about the point from which their positions are measured."""

NAMES: dict[str, Any] = {"m_i": ANY_MASS, "r_i": ANY_PLACE, COUNT: _sum_of}
"""Names in the LaTeX of a step -> what they mean, an argument of :meth:`symrot.proof.derivation.Derivation.notation`.

``m_i`` and ``r_i`` are mass and position of particle i. The sum sign ``\\sum_i`` sums the expression in the parentheses
after it over the three particles.
"""
