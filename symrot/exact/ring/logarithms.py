"""Logarithms as sums of logarithms of irreducible factors: ``log(a^2 b) = 2 log|a| + log(b)``.

A product is positive only where no factor is zero. So the logarithm of ``c f^n g^m`` is ``log(c) + n log|f| + m
log|g|`` wherever it has a value. If ``log(f)`` occurs too, f is positive and ``|f|`` is f.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import prod

from sympy import Abs, Add, Expr, Integer, Rational, default_sort_key, exp, factorint, log
from sympy.polys.domains import ZZ
from sympy.polys.rings import PolyElement

from symrot.exact.factors import factor_list
from symrot.exact.functions import REWRITTEN
from symrot.exact.intervals import enclosure
from symrot.exact.ring.roots import sign_of

__all__ = ["Product", "logarithms_in", "product_of", "sums_of_logarithms"]

MOST_BITS_FACTORED = 64
"""Largest number of bits of a number that is factored into primes."""

MOST_TERMS = 60
"""Largest number of terms of a polynomial, in the argument of a logarithm, that is factored."""


@dataclass(frozen=True)
class Product:
    """The argument of a logarithm: ``sign * product(number^power) * product(factor^power) * exp(exponent)``."""

    sign: int  # 1 or -1; 0 if it is not known because the argument contains roots
    numbers: tuple[tuple[Rational, Rational], ...]  # pairs (positive number, power)
    powers: Mapping[Expr, Rational]
    exponent: Expr


def logarithms_in(expressions: Iterable[Expr]) -> list[Expr]:
    """Return the logarithms in expressions, except those inside other logarithms.

    Inverse hyperbolic functions count as the logarithms that equal them.
    """
    stack, seen, logarithms = list(expressions), set(), []
    while stack:
        node = stack.pop()
        if node in seen:
            continue
        seen.add(node)
        if isinstance(node, log):
            logarithms.append(node)
        elif type(node) in REWRITTEN:
            stack.append(REWRITTEN[type(node)](*node.args))
        else:
            stack.extend(node.args)
    return sorted(logarithms, key=default_sort_key)


def product_of(
    content: Rational, above: PolyElement, below: PolyElement, generators: Sequence[Expr],
    roots: Mapping[int, tuple[int, PolyElement]],
) -> Product:  # fmt: skip
    """Return the fraction ``content * above / below``, the argument of a logarithm, in irreducible factors.

    ``generators`` are the formulas that the variables of the two polynomials stand for. ``roots`` maps the index of
    each variable that stands for a root g to a pair (n, P) with ``g^n = P``.
    """
    sign, exponent = 1, Integer(0)
    numbers = [(content, Rational(1))]
    powers: dict[Expr, Rational] = {}
    stack = [(above, Rational(1)), (below, Rational(-1))]
    while stack:
        poly, times = stack.pop()
        denominator, poly = poly.clear_denoms()
        poly = poly.set_ring(poly.ring.clone(domain=ZZ))
        if poly.is_ground:
            constant, pairs = poly.LC, []
        else:
            constant, pairs = factor_list(poly) if len(poly) <= MOST_TERMS else (1, [(poly, 1)])
        numbers.append((Rational(abs(int(constant)), int(denominator)), times))
        sign *= -1 if constant < 0 else 1
        for factor, n in pairs:
            place = factor.leading_expv().index(1) if factor.is_generator else -1
            formula = factor.as_expr(*generators)
            if place in roots:
                index, inside = roots[place]
                sign = 0
                stack.append((inside, times * n / index))
            elif isinstance(formula, exp):
                exponent += times * n * formula.args[0]
            else:
                powers[formula] = powers.get(formula, Integer(0)) + times * n
    return Product(sign, tuple(numbers), {factor: power for factor, power in powers.items() if power}, exponent)


def sums_of_logarithms(products: Mapping[Expr, Product]) -> dict[Expr, Expr]:
    """Return, for each logarithm, an equal sum of simpler logarithms: ``2*log(|a|) + log(b)`` for ``log(a^2*b)``.

    ``products`` maps each logarithm to its argument in factors.
    """
    signs = _known_signs(list(products.values()))
    # equal wherever all of the logarithms have a value
    return {node: _sum(product, signs) for node, product in products.items()}


def _known_signs(products: Sequence[Product]) -> dict[Expr, int]:
    """Return a map from factors to their signs, 1 or -1, for all factors whose sign is known.

    A sign is known from the factor itself, or follows because all ``products`` are positive.
    """
    factors = {factor for product in products for factor in product.powers}
    signs = {factor: sign for factor in factors if (sign := _sign(factor))}
    open_products = [product for product in products if product.sign]
    while True:
        learned = {}
        for product in open_products:
            odd = [factor for factor, power in product.powers.items() if power % 2]
            unknown = [factor for factor in odd if factor not in signs]
            if len(unknown) == 1:
                # if a b and a are positive, so is b
                learned[unknown[0]] = product.sign * prod(signs[factor] for factor in odd if factor in signs)
        if not learned:
            return signs
        signs |= learned


def _sign(factor: Expr) -> int:
    """Return the sign, 1 or -1, of a factor if its value or SymPy's assumptions show it, otherwise 0."""
    if factor.is_number:
        interval = enclosure(factor)
        return 0 if interval is None or 0 in interval else 1 if interval.a > 0 else -1
    return sign_of(factor)


def _sum(product: Product, signs: Mapping[Expr, int]) -> Expr:
    terms = [product.exponent]
    terms += [power * _of_number(number) for number, power in product.numbers]
    for factor, power in product.powers.items():
        sign = signs.get(factor, 0)
        terms.append(power * log(sign * factor if sign else Abs(factor)))
    return Add(*terms)


def _of_number(number: Rational) -> Expr:
    """Return the logarithm of a positive rational number as a sum of logarithms of primes.

    A numerator or denominator of more than MOST_BITS_FACTORED bits is not factored.
    """
    terms = []
    for whole, sign in ((int(number.p), 1), (int(number.q), -1)):
        primes = factorint(whole) if whole.bit_length() <= MOST_BITS_FACTORED else {whole: 1}
        terms += [sign * power * log(prime) for prime, power in primes.items() if prime != 1]
    return Add(*terms)
