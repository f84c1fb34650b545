"""Exact arithmetic with fractions of polynomials over the rationals, and SymPy formulas as such fractions.

Two kinds of proof use this arithmetic: that a kernel's formulas obey a law (an identity, such as that a dcm is
orthogonal), and that a C text computes the formulas. :mod:`symrot.certificates.exact_check` checks both kinds
independently, without polynomials.
"""

from abc import ABC, abstractmethod
from fractions import Fraction

from sympy import Expr, pi
from sympy.polys.domains import QQ
from sympy.polys.rings import PolyElement, PolyRing

from symrot.errors import CertificateError

__all__ = ["FormulaReader", "FractionField", "Quotient", "quotient_text"]

Quotient = tuple[PolyElement, PolyElement]  # numerator, denominator, in lowest terms


class FractionField:
    """Fractions of polynomials, as pairs (numerator, denominator) in lowest terms; equal fractions are equal pairs."""

    def __init__(self, ring: PolyRing, name: str) -> None:
        self.ring, self.name = ring, name
        self.generators = dict(zip(map(str, ring.symbols), ring.gens, strict=True))

    def number(self, value: Fraction | int) -> Quotient:
        """Return a rational number as a constant fraction of polynomials."""
        value = Fraction(value)
        return self.ring.ground_new(QQ(value.numerator, value.denominator)), self.ring.one

    def generator(self, name: str) -> Quotient:
        """Return the variable of the polynomial ring that has the given name."""
        return self.generators[name], self.ring.one

    def lowest(self, above: PolyElement, below: PolyElement) -> Quotient:
        """Return ``above/below`` in lowest terms, scaled so that the denominator's leading coefficient is 1.

        CertificateError is raised if ``below`` is zero.
        """
        if not below:
            raise CertificateError(
                f"{self.name}: expected a formula that is defined somewhere, got a formula that divides by "
                "an expression that is zero everywhere"
            )
        if not below.is_ground:
            above, below = above.cancel(below)
        lead = below.LC
        return (above, below) if lead == 1 else (above.quo_ground(lead), below.quo_ground(lead))

    def add(self, a: Quotient, b: Quotient) -> Quotient:
        """Return the sum of two fractions of polynomials, ``a + b``."""
        if a[1] == b[1]:
            return self.lowest(a[0] + b[0], a[1])
        return self.lowest(a[0] * b[1] + b[0] * a[1], a[1] * b[1])

    def negative(self, a: Quotient) -> Quotient:
        """Return the negative of a fraction of polynomials, ``-a``."""
        return -a[0], a[1]

    def subtract(self, a: Quotient, b: Quotient) -> Quotient:
        """Return the difference of two fractions of polynomials, ``a - b``."""
        return self.add(a, self.negative(b))

    def multiply(self, a: Quotient, b: Quotient) -> Quotient:
        """Return the product of two fractions of polynomials, ``a*b``."""
        return self.lowest(a[0] * b[0], a[1] * b[1])

    def divide(self, a: Quotient, b: Quotient) -> Quotient:
        """Return the quotient of two fractions of polynomials, ``a/b``; raise CertificateError if ``b`` is zero."""
        return self.lowest(a[0] * b[1], a[1] * b[0])

    def power(self, a: Quotient, exponent: int) -> Quotient:
        """Return the fraction ``a`` to an integer power; a negative exponent gives a power of the reciprocal."""
        above, below = a if exponent > 0 else (a[1], a[0])
        return self.lowest(above ** abs(exponent), below ** abs(exponent))


def quotient_text(value: Quotient) -> str:
    """Return a fraction of polynomials as text: ``(x + 1)/(y)``, or only the numerator if the denominator is 1."""
    above, below = value
    return str(above) if below == 1 else f"({above})/({below})"


class FormulaReader(ABC):
    """A converter of SymPy formulas to fractions of polynomials; subclasses define symbols and functions."""

    fractions: FractionField
    # the fractions of formulas that were converted before
    values: dict[Expr, Quotient]

    @abstractmethod
    def symbol(self, name: str) -> Quotient:
        """Return the symbol ``name``, or the number pi, as a fraction of polynomials; each subclass defines how."""

    @abstractmethod
    def root(self, square: Quotient) -> Quotient:
        """Return the square root of the fraction ``square`` as a fraction of polynomials; each subclass defines how."""

    @abstractmethod
    def function(self, expr: Expr) -> Quotient:
        """Return the value of a call ``expr``, such as ``sin(x)``, as a fraction; each subclass defines how."""

    def read(self, expr: Expr) -> Quotient:
        """Return a SymPy formula as a fraction of polynomials."""
        if expr not in self.values:
            self.values[expr] = self._read(expr)
        return self.values[expr]

    def _read(self, expr: Expr) -> Quotient:
        fractions = self.fractions
        if expr.is_Rational:
            return fractions.number(Fraction(int(expr.p), int(expr.q)))
        if expr.is_Symbol or expr is pi:
            return self.symbol(str(expr))
        if expr.is_Add or expr.is_Mul:
            combine = fractions.add if expr.is_Add else fractions.multiply
            result, *others = map(self.read, expr.args)
            for value in others:
                result = combine(result, value)
            return result
        if expr.is_Pow and (2 * expr.exp).is_Integer:
            base = self.read(expr.base)
            if expr.exp.is_Integer:
                return fractions.power(base, int(expr.exp))
            return fractions.power(self.root(base), int(2 * expr.exp))
        return self.function(expr)
