"""Integrals of a density over the volume, area or length of a body, as integrals over its mass."""

from symrot.checker.claim.tree import Node, number, product

__all__ = ["over_mass"]

DENSITIES = ("rho", "sigma", "lambda", "mu")
"""Letters of a mass per volume, area or length."""


def over_mass(integrand: Node) -> Node | None:
    """Return an integrand without its density, so that ``∫ rho x² dV`` becomes ``∫ x² dm``; None if it has no density.

    Examples
    --------
    >>> from symrot.checker.claim.tree import text
    >>> text(over_mass(product([Node("name", "rho"), Node("name", "x"), Node("name", "y")])))
    'x*y'
    """
    factors = list(integrand.args) if integrand.kind == "product" else [integrand]
    density = next((factor for factor in factors if factor.kind == "name" and factor.value in DENSITIES), None)
    if density is None:
        return None
    factors.remove(density)
    return product(factors) if factors else number(1)
