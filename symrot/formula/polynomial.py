"""Sparse polynomials with exact coefficients. Standard library only.

The variables of a polynomial are called generators: names such as ``x``, ``cos(phi)`` and ``pi`` in integrals over
solids, or numbers in Taylor steppers.
"""

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from math import isqrt
from typing import Any, Union

__all__ = [
    "Monomial", "Polynomial", "constant", "cosine", "exact_quotient", "generator", "products_of_monomials",
    "reduce_circular", "sine", "square_root",
]  # fmt: skip

Monomial = tuple[tuple[Any, int], ...]  # pairs (generator, power > 0), ordered by generator
Term = tuple[Monomial, Fraction]
Operand = Union["Polynomial", Fraction, int]


class Polynomial:
    """A polynomial, never changed; ``terms`` maps monomials to coefficients.

    ``3 z x^2 + 5`` has the terms ``{(("x", 2), ("z", 1)): 3, (): 5}``.
    """

    __slots__ = ("terms",)

    def __init__(self, terms: Mapping[Monomial, Fraction]) -> None:
        self.terms = {monomial: coefficient for monomial, coefficient in terms.items() if coefficient}

    def __repr__(self) -> str:
        return f"Polynomial({self.terms})"

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Polynomial) and self.terms == other.terms

    def __hash__(self) -> int:
        return hash(frozenset(self.terms.items()))

    def __add__(self, other: Operand) -> "Polynomial":
        total = dict(self.terms)
        for monomial, coefficient in _lift(other).terms.items():
            total[monomial] = total.get(monomial, Fraction(0)) + coefficient
        return Polynomial(total)

    def __neg__(self) -> "Polynomial":
        return Polynomial({monomial: -coefficient for monomial, coefficient in self.terms.items()})

    def __sub__(self, other: Operand) -> "Polynomial":
        return self + -_lift(other)

    def __rsub__(self, other: Operand) -> "Polynomial":
        return -self + other

    def __mul__(self, other: Operand) -> "Polynomial":
        total: dict[Monomial, Fraction] = {}
        right = list(_lift(other).terms.items())
        for monomial, coefficient in self.terms.items():
            for factor, scale in right:
                product = _join(monomial, factor)
                total[product] = total.get(product, Fraction(0)) + coefficient * scale
        return Polynomial(total)

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other: Operand) -> "Polynomial":
        """Return the quotient by a number; raise ``ValueError`` if the divisor contains a generator.

        Raise ``ZeroDivisionError`` if the divisor is zero.
        """
        divisor = _lift(other)
        if not divisor:
            raise ZeroDivisionError("division by zero")
        if set(divisor.terms) != {()}:
            raise ValueError("expected a number as the divisor of a polynomial, got a polynomial that is not constant")
        inverse = 1 / divisor.terms[()]
        return Polynomial({monomial: coefficient * inverse for monomial, coefficient in self.terms.items()})

    def __pow__(self, exponent: int) -> "Polynomial":
        if exponent < 0:
            return constant(1) / self**-exponent
        power = constant(1)
        for _ in range(exponent):
            power = power * self
        return power

    def collect(self, names: Iterable[str]) -> dict[tuple[int, ...], "Polynomial"]:
        """Return the coefficients of the polynomial in the generators ``names``, by exponents.

        ``3 z x^2 + 5`` in x gives ``{(2,): 3 z, (0,): 5}``.
        """
        order = tuple(names)
        parts: dict[tuple[int, ...], dict[Monomial, Fraction]] = {}
        for monomial, coefficient in self.terms.items():
            powers = dict(monomial)
            exponents = tuple(powers.pop(name, 0) for name in order)
            parts.setdefault(exponents, {})[tuple(sorted(powers.items()))] = coefficient
        return {exponents: Polynomial(part) for exponents, part in parts.items()}

    def derivative(self, name: str) -> "Polynomial":
        """Return the partial derivative with respect to the coordinate or angle ``name``."""
        # the generators for the cosine and sine of an angle depend on it too
        inner = ((generator(name), constant(1)), (cosine(name), -sine(name)), (sine(name), cosine(name)))
        total = constant(0)
        for argument, rate in inner:
            ((((symbol, _),), _),) = argument.terms.items()
            for (power,), coefficient in self.collect([symbol]).items():
                if power:
                    total = total + coefficient * argument ** (power - 1) * power * rate
        return total

    def value(self, values: Mapping[str, Fraction]) -> Fraction:
        """Return the value of the polynomial; raise ``KeyError`` if a generator has no value."""
        total = Fraction(0)
        for monomial, coefficient in self.terms.items():
            for name, power in monomial:
                coefficient *= values[name] ** power
            total += coefficient
        return total

    def symbol(self) -> str:
        """Return the name of the generator if the polynomial is a single generator; raise ``ValueError`` otherwise."""
        ((monomial, coefficient),) = self.terms.items()
        name: str
        ((name, power),) = monomial
        if power != 1 or coefficient != 1:
            raise ValueError(f"expected a single variable, such as x, got {self}")
        return name


def _join(left: Monomial, right: Monomial) -> Monomial:
    if not left or not right:
        return left or right
    powers = dict(left)
    for name, power in right:
        powers[name] = powers.get(name, 0) + power
    return tuple(sorted(powers.items()))


def products_of_monomials(left: Polynomial, right: Polynomial) -> set[Monomial]:
    """Return the products of each monomial of ``left`` with each of ``right``, without coefficients, each product once.

    ``(x + 1)*(x - 1)`` gives x^2, x and 1.
    """
    # products whose coefficients cancel count too: callers use the number as the cost of left * right
    return {_join(monomial, factor) for monomial in left.terms for factor in right.terms}


def _lift(value: Operand) -> Polynomial:
    return value if isinstance(value, Polynomial) else constant(value)


def constant(value: Fraction | int) -> Polynomial:
    """Return the constant polynomial with a given value."""
    return Polynomial({(): Fraction(value)})


def generator(name: str | int) -> Polynomial:
    """Return the polynomial that is the single variable (generator) ``name``."""
    return Polynomial({((name, 1),): Fraction(1)})


def cosine(angle: str) -> Polynomial:
    """Return the polynomial for the cosine of an angle: a single generator, with the name "cos(``angle``)"."""
    return generator(f"cos({angle})")


def sine(angle: str) -> Polynomial:
    """Return the polynomial for the sine of an angle: a single generator, with the name "sin(``angle``)"."""
    return generator(f"sin({angle})")


def reduce_circular(source: Polynomial, angles: Iterable[str]) -> Polynomial:
    """Return an equal polynomial in which ``cos^2`` of each of the ``angles`` is replaced by ``1 - sin^2``."""
    # no cosine keeps a power above 1, so equal formulas give equal polynomials
    for angle in angles:
        reduced = constant(0)
        for (power,), coefficient in source.collect([f"cos({angle})"]).items():
            reduced = reduced + coefficient * cosine(angle) ** (power % 2) * (1 - sine(angle) ** 2) ** (power // 2)
        source = reduced
    return source


def _exponents(names: list[str]) -> Callable[[Term], list[int]]:
    """Return a sort key for monomials in the generators ``names``.

    The key is the list of exponents, so that the order is lexicographic.
    """
    return lambda term: [dict(term[0]).get(name, 0) for name in names]


def _term_quotient(term: Term, divisor: Term) -> Polynomial | None:
    powers = dict(term[0])
    for name, power in divisor[0]:
        powers[name] = powers.get(name, 0) - power
    if min(powers.values(), default=0) < 0:
        return None
    return Polynomial({tuple(sorted((n, p) for n, p in powers.items() if p)): term[1] / divisor[1]})


def exact_quotient(dividend: Polynomial, divisor: Polynomial) -> Polynomial | None:
    """Return ``dividend/divisor`` by long division, or None if the quotient is not a polynomial."""
    order = _exponents(sorted({name for monomial in (*dividend.terms, *divisor.terms) for name, _ in monomial}))
    highest = max(divisor.terms.items(), key=order)
    quotient, rest = constant(0), dividend
    while rest:
        term = _term_quotient(max(rest.terms.items(), key=order), highest)
        if term is None:
            return None
        quotient, rest = quotient + term, rest - term * divisor
    return quotient


def square_root(source: Polynomial) -> Polynomial:
    """Return the square root of a polynomial, with a positive lowest term.

    Raise ``ValueError`` if the polynomial is not a square.
    """
    order = _exponents(sorted({name for monomial in source.terms for name, _ in monomial}))
    if not source:
        return source
    monomial, coefficient = min(source.terms.items(), key=order)
    scale = Fraction(isqrt(max(coefficient.numerator, 0)), isqrt(coefficient.denominator))
    if scale**2 != coefficient or any(power % 2 for _, power in monomial):
        raise ValueError("expected the square of a polynomial")
    lowest = tuple((name, power // 2) for name, power in monomial)
    # term by term from the lowest one up, as for a power series
    root = Polynomial({lowest: scale})
    for _ in source.terms:
        rest = source - root * root
        if not rest:
            return root
        term = _term_quotient(min(rest.terms.items(), key=order), (lowest, 2 * scale))
        if term is None:
            break
        root = root + term
    raise ValueError("expected the square of a polynomial")
