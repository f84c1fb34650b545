"""Radicands of square roots: extraction of squares, and roots of products as products of roots.

``sqrt(x^2 y) = |x| sqrt(y)``. If the product of some radicands is a square, as of ``a``, ``b`` and ``a b``, one root is
expressed by the others, ``sqrt(a b) = sqrt(a) sqrt(b)``, wherever all of them are real.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sympy import Abs, Expr, Rational
from sympy.polys.domains import ZZ
from sympy.polys.rings import PolyElement

from symrot.exact.factors import factor_list
from symrot.exact.ring.roots import Root, absolute, sign_of, written

__all__ = ["Dependence", "dependences", "take_squares", "without_circles"]

MOST_TERMS = 60
"""Largest number of terms of a radicand that is factored."""


Outside = tuple[tuple[Root | Expr, int], ...]


def take_squares(above: PolyElement, below: PolyElement, generators: Sequence[Expr]) -> tuple[Expr, Outside, bool]:
    """Take the squares out of a radicand, the fraction ``above/below``; return (P, pairs (f, n), loose).

    The radicand is ``P * product(f^(2 n))``, P is a polynomial, and no f is negative. So the square root of the
    radicand is sqrt(P) times the product of all f^n; n is negative for a divisor. ``loose`` says whether P may be
    negative where an f is zero. ``x^2 y`` gives P = y, the pair (``|x|``, 1) and True, because at x = 0, y = -1 the
    square root of ``x^2 y`` is real, but that of P is not. ``generators`` are the expressions for which the variables
    of the polynomials stand.
    """
    whole = above.ring.clone(domain=ZZ)
    above, below = above.set_ring(whole), below.set_ring(whole)
    rest, squares = _square_part(above)
    # there sqrt(P f^2) is real, but sqrt(P) is not
    loose = any(rest.rem([factor]) for factor, _ in squares)
    divisor, inverse = _square_part(below)
    squares += [(factor, -times) for factor, times in inverse]
    outside: list[tuple[Root | Expr, int]] = []
    if not divisor.is_ground:
        written_divisor, sign = divisor.as_expr(*generators), sign_of(rest.as_expr(*generators))
        if sign:  # rest/divisor is not negative
            outside.append((sign * written_divisor, -1))
        else:
            squares += [(factor, -times) for factor, times in _irreducible(divisor)]
        rest = rest * divisor
    outside += [(absolute(factor.as_expr(*generators)), times) for factor, times in squares]
    return rest.as_expr(*generators), tuple(outside), loose


def _square_part(poly: PolyElement) -> tuple[PolyElement, list[tuple[PolyElement, int]]]:
    """Return (P, [(f, n), ..]) with ``poly = P * product(f^(2n))``, P square-free and each f irreducible.

    A polynomial of more than MOST_TERMS terms is returned whole.
    """
    if poly.is_ground or len(poly) > MOST_TERMS or all(degree < 2 for degree in poly.degrees()):
        return poly, []
    rest, squares = poly, []
    for part, times in poly.sqf_list()[1]:
        if times > 1 and not part.is_ground:
            rest = rest.exquo(part ** (times // 2 * 2))
            squares += [(factor, n * (times // 2)) for factor, n in factor_list(part)[1]]
    return rest, squares


def _irreducible(poly: PolyElement) -> list[tuple[PolyElement, int]]:
    if len(poly) > MOST_TERMS:
        return [(poly, 1)]
    return factor_list(poly)[1]


@dataclass(frozen=True)
class Dependence:
    """A square root as ``sqrt(number) * product(roots)``, divided by ``f^n`` for each pair (f, n) in ``divisors``.

    ``sqrt(a c) = sqrt(a b) sqrt(b c) / |b|`` has number 1 and the pair (``|b|``, 1).
    """

    number: Rational
    roots: tuple[Root, ...]
    divisors: tuple[tuple[Root | Expr, int], ...]

    @property
    def needs(self) -> list[Root]:
        """The roots by which the square root is expressed: sqrt(a) and sqrt(b) for sqrt(a*b)."""
        return [*self.roots, *(factor for factor, _ in self.divisors if isinstance(factor, Root))]


def dependences(radicands: Mapping[Root, PolyElement], generators: Sequence[Expr]) -> dict[Root, Dependence]:
    """Return a map from each square root that is a product of other roots to this product, a :class:`Dependence`.

    Parameters
    ----------
    radicands : mapping
        The polynomial under each square root, all in one ring.
    generators : sequence of Expr
        The generators of that ring.
    """
    factored = {root: _factored(poly) for root, poly in radicands.items()}
    odd = {root: frozenset(f for f, n in powers.items() if n % 2) for root, (_, powers) in factored.items()}
    candidates = [root for root in radicands if odd[root] or not isinstance(root.expression, Abs)]
    candidates.sort(key=lambda root: (-isinstance(root.expression, Abs), len(odd[root]), written(root.expression)))
    texts = {factor: str(factor) for factors in odd.values() for factor in factors}
    # linear algebra modulo 2 on the factors with odd exponents: a b and b c give a c, as b has an even exponent
    basis: list[tuple[PolyElement, frozenset[PolyElement], frozenset[Root]]] = []
    relations: dict[Root, Dependence] = {}
    for root in candidates:
        left, used = odd[root], frozenset([root])
        for least, factors, members in basis:
            if least in left:
                left, used = left ^ factors, used ^ members
        if left:
            basis.append((min(left, key=texts.__getitem__), left, used))
            continue
        others = sorted(used - {root}, key=lambda other: written(other.expression))
        number, total = factored[root][0], {f: -n for f, n in factored[root][1].items()}
        for other in others:
            number /= factored[other][0]
            for factor, n in factored[other][1].items():
                total[factor] = total.get(factor, 0) + n
        if number > 0:  # otherwise all of them are real only at isolated points
            divisors = ((absolute(f.as_expr(*generators)), n // 2) for f, n in sorted(total.items(), key=str) if n)
            relations[root] = Dependence(number, tuple(others), tuple(divisors))
    return relations


def without_circles(new: Mapping[Root, Dependence], known: Mapping[Root, Dependence]) -> dict[Root, Dependence]:
    """Return the entries of ``new`` (root -> product of other roots) in which no root is expressed by itself.

    A root could be expressed by itself through other roots too. ``known`` are entries that were accepted before.
    """
    accepted: dict[Root, Dependence] = {}
    for root, dependence in new.items():
        stack, seen = dependence.needs, set[Root]()
        while stack:
            other = stack.pop()
            if other not in seen:
                seen.add(other)
                further = accepted.get(other) or known.get(other)
                stack += further.needs if further else []
        if root not in seen:
            accepted[root] = dependence
    return accepted


def _factored(poly: PolyElement) -> tuple[Rational, dict[PolyElement, int]]:
    """Return (number, powers): a polynomial as a rational number times powers of irreducible factors.

    ``powers`` maps each factor to its exponent.
    """
    if poly.is_ground or len(poly) > MOST_TERMS:
        # a long polynomial is not factored: it is the only factor
        return (_rational(poly.LC), {}) if poly.is_ground else (Rational(1), {poly: 1})
    constant, pairs = factor_list(poly)
    return _rational(constant), dict(pairs)


def _rational(value: Any) -> Rational:
    return Rational(int(value.numerator), int(value.denominator))
