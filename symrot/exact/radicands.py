"""What stands under a square root, taken apart: squares leave it, and roots of products are products of roots.

``sqrt(x^2 y) = |x| sqrt(y)``. Of several square roots whose radicands multiply to a square, say ``a``, ``b`` and
``a b``, one is expressed by the others, ``sqrt(a b) = sqrt(a) sqrt(b)``: true wherever all of them are real.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from sympy import Abs, Expr, Integer, factorint
from sympy.polys.domains import ZZ
from sympy.polys.rings import PolyElement

from symrot.exact.roots import Root, absolute

__all__ = ["Dependence", "dependences", "take_squares"]

MOST_TERMS = 60
"""Of a radicand that is still taken apart."""


Outside = tuple[tuple[Root | Expr, int], ...]


def take_squares(above: PolyElement, below: PolyElement, generators: Sequence[Expr]) -> tuple[Expr, Outside]:
    """Return (P, outside) with ``above/below = P * product(factor^(2 n))``; P a polynomial, no factor negative."""
    whole = above.ring.clone(domain=ZZ)
    above, below = above.set_ring(whole), below.set_ring(whole)
    rest, squares = _square_part(above)
    divisor, inverse = _square_part(below)
    squares += [(factor, -times) for factor, times in inverse]
    outside: list[tuple[Root | Expr, int]] = []
    if not divisor.is_ground:
        shown, sign = divisor.as_expr(*generators), _sign(rest.as_expr(*generators))
        if sign:  # rest/divisor is not negative
            outside.append((sign * shown, -1))
        else:
            squares += [(factor, -times) for factor, times in _irreducible(divisor)]
        rest = rest * divisor
    outside += [(absolute(factor.as_expr(*generators)), times) for factor, times in squares]
    return rest.as_expr(*generators), tuple(outside)


def _sign(value: Expr) -> int:
    """Return 1 or -1 for a real expression that is never of the other sign, 0 where that is not known."""
    return 1 if value.is_nonnegative else -1 if value.is_nonpositive else 0


def _square_part(poly: PolyElement) -> tuple[PolyElement, list[tuple[PolyElement, int]]]:
    """Return (P, [(f, n), ..]) with ``poly = P * product(f^(2n))``, P without squares, the f irreducible."""
    if poly.is_ground or len(poly) > MOST_TERMS or all(degree < 2 for degree in poly.degrees()):
        return poly, []
    rest, squares = poly, []
    for part, times in poly.sqf_list()[1]:
        if times > 1 and not part.is_ground:
            rest = rest.exquo(part ** (times // 2 * 2))
            squares += [(factor, n * (times // 2)) for factor, n in part.factor_list()[1]]
    return rest, squares


def _irreducible(poly: PolyElement) -> list[tuple[PolyElement, int]]:
    if len(poly) > MOST_TERMS:
        return [(poly, 1)]
    return [(factor, n) for factor, n in poly.factor_list()[1]]


@dataclass(frozen=True)
class Dependence:
    """A root that is ``product(roots) / product(factor^n)``, the factors as those outside a radical."""

    roots: tuple[Root, ...]
    divisors: tuple[tuple[Root | Expr, int], ...]


def dependences(roots: Sequence[Root]) -> dict[Root, Dependence]:
    """Return the square roots that are products of others, by what they are.

    Linear algebra over the field of two elements: a root is the set of irreducible factors, -1 and primes among them,
    that its radicand has an odd number of times.
    """
    plain = [root for root in roots if root.index == 2 and not isinstance(root.expression, Abs)]
    plain = [root for root in plain if not root.power_expression.is_number]
    if len(plain) < 2:
        return {}
    powers = {root: _factors(root.power_expression) for root in plain}
    plain.sort(key=lambda root: (len(powers[root]), str(root.expression)))
    basis: list[tuple[frozenset[Expr], frozenset[Root]]] = []
    found: dict[Root, Dependence] = {}
    for root in plain:
        left, used = frozenset(f for f, n in powers[root].items() if n % 2), frozenset([root])
        for factors, members in basis:
            if min(factors, key=str) in left:
                left, used = left ^ factors, used ^ members
        if left:
            basis.append((left, used))
        else:
            found[root] = _dependence(root, sorted(used - {root}, key=lambda other: str(other.expression)), powers)
    return found


def _dependence(root: Root, others: Sequence[Root], powers: Mapping[Root, Mapping[Expr, int]]) -> Dependence:
    total: dict[Expr, int] = {}
    for member, sign in [*((other, 1) for other in others), (root, -1)]:
        for factor, n in powers[member].items():
            total[factor] = total.get(factor, 0) + sign * n
    divisors = tuple((absolute(factor), n // 2) for factor, n in sorted(total.items(), key=str) if n)
    return Dependence(tuple(others), divisors)


def _factors(formula: Expr) -> dict[Expr, int]:
    """Return the irreducible factors of a polynomial over the integers with their powers; itself where it is large."""
    poly = formula.as_poly()
    if poly is None or not (poly.domain.is_ZZ or poly.domain.is_QQ) or len(poly.terms()) > MOST_TERMS:
        return {formula: 1}
    constant, factors = poly.factor_list()
    if not constant.is_Integer:
        return {formula: 1}
    powers = {factor.as_expr(): int(n) for factor, n in factors}
    powers |= {Integer(prime): n for prime, n in factorint(abs(int(constant))).items()}
    return powers | ({Integer(-1): 1} if constant < 0 else {})
