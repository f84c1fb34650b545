"""Conditions under which a false claim becomes true, such as a unit norm, equal moments, or the sign of a root.

A condition comes from a common factor of all residuals (left minus right side of each entry): where the factor is zero,
the claim is true. Every residual vanishes somewhere; so only conditions of the kinds that textbooks state are returned.
"""

import re
from collections.abc import Sequence
from functools import reduce
from typing import Any

from sympy import Expr
from sympy.core.function import AppliedUndef
from sympy.polys.rings import PolyElement

from symrot.checker.decide.definite import surely_nonnegative
from symrot.checker.decide.ranges.text import range_text
from symrot.exact.decide import normal_form
from symrot.exact.evidence import Requirement
from symrot.exact.factors import factor_list
from symrot.exact.printing import as_text
from symrot.exact.ring.ring import FormulaRing

__all__ = ["branch_requirements", "requirements"]

MOMENT = re.compile(r"[ABC]|[IJ]_?([xyz1-3]|([xyz1-3])\2|p|perp|par|parallel|t|s|a)?", re.ASCII)
"""Pattern of the usual names of moments of inertia, such as A, I_x and I_xx."""
PRODUCT_OF_INERTIA = re.compile(r"[IJP]_?(xy|yx|xz|zx|yz|zy|12|21|13|31|23|32)", re.ASCII)
"""Pattern of the usual names of products of inertia, such as I_xy and I_12."""

MOST_TERMS, LARGEST_DEGREE, MOST_LETTERS = 400, 24, 20
"""Limits on the shortest residual (left minus right) of a claim: terms, degree and letters, beyond which nothing is
factored.

The difference of the traces of A B C and B A C has 48 terms in 27 letters; factoring it takes seconds.
"""


def requirements(
    ring: FormulaRing, numerators: Sequence[PolyElement], sides: Sequence[tuple[Expr, Expr]], entries: int
) -> list[Requirement]:
    """Return conditions of the kinds that textbooks state, such as ``A == B``, each of which makes the claim true.

    Parameters
    ----------
    ring : FormulaRing
    numerators : sequence of PolyElement
        The numerator, in lowest terms, of each nonzero difference of the left and right entries of the claim.
    sides : sequence of (Expr, Expr)
        The left and the right side of the entry to which each numerator belongs.
    entries : int
        The number of all entries of the claim. If it is 1, a condition that only repeats the claim is usually left
        out.
    """
    conditions = []
    for factor in _shared_factors(ring, numerators):
        requirement = _classified(ring, factor)
        if requirement is None:
            continue
        itself = entries == 1 and _associated(factor, numerators[0])
        if itself and (requirement.code != "requires_unit_norm" or any(side.is_number for side in sides[0])):
            continue
        if requirement.code == "requires_unit_norm" or _left_out(requirement, sides, ring.hypotheses):
            conditions.append(requirement)
    return conditions or _no_products(ring, numerators, sides)


def _shared_factors(ring: FormulaRing, numerators: Sequence[PolyElement]) -> list[PolyElement]:
    """Return the irreducible factors that divide all ``numerators``; none if the shortest of these polynomials is too
    large to be factored.
    """
    # each numerator is one of left minus right: where a shared factor is zero, all entries agree
    smallest = min(numerators, key=len)
    if not ring.generators or len(smallest) > MOST_TERMS or max(map(sum, smallest)) > LARGEST_DEGREE:
        return []
    if sum(degree > 0 for degree in smallest.degrees()) > MOST_LETTERS:
        return []
    shared = reduce(lambda a, b: a if a.is_ground else a.gcd(b), sorted(numerators, key=len))
    return [] if shared.is_ground else [factor for factor, _ in factor_list(shared)[1]]


def _left_out(requirement: Requirement, sides: Sequence[tuple[Expr, Expr]], hypotheses: Sequence[Expr]) -> bool:
    """Return whether the author of a false claim may have assumed ``requirement``, such as ``A = B``, without stating
    it.
    """
    (formula,) = requirement.zeros
    symbols = formula.free_symbols

    # a side with x has A too if a hypothesis relates x to A
    def involved(side: Expr) -> set[Any]:
        own = side.free_symbols
        groups = [own, *(h.free_symbols for h in hypotheses if own & h.free_symbols)]
        return {symbol for symbol in symbols if any(symbol in group for group in groups)}

    def one_sided(pair: tuple[Expr, Expr]) -> bool:
        return any(symbols <= side.free_symbols and not involved(other) for side, other in (pair, pair[::-1]))

    # who assumes A = B writes only one of them on a side: (A - B) w against (B - A) w is wrong in another way,
    # and so is a pair of which one side has A and B and the other neither
    return all(any(involved(side) != symbols for side in pair) and not one_sided(pair) for pair in sides)


def _associated(first: PolyElement, second: PolyElement) -> bool:
    return len(first) == len(second) and bool(first.primitive()[1] in (second.primitive()[1], -second.primitive()[1]))


def _classified(ring: FormulaRing, factor: PolyElement) -> Requirement | None:
    """Return the condition ``factor == 0`` if textbooks state such conditions, as ``q0**2 + q1**2 == 1``;
    otherwise None.
    """
    places = [n for n, degree in enumerate(factor.degrees()) if degree > 0]
    leaves = {number: leaf for leaf, number in ring.symbols.items()}
    if not all(n in leaves and (leaves[n].is_Symbol or isinstance(leaves[n], AppliedUndef)) for n in places):
        return None
    names = [leaves[n] for n in places]
    formula = factor.as_expr(*ring.generators)
    if _is_unit_norm(factor, len(places)):
        squares = " + ".join(f"{name}**2" for name in names)
        return Requirement("requires_unit_norm", f"{squares} == 1", (formula,))
    linear = all(sum(mono) == 1 and abs(coefficient) == 1 for mono, coefficient in factor.items())
    if linear and len(names) in (2, 3) and all(_matches(MOMENT, name) for name in names):
        # A == B, or A + B == C
        return _of_moments(factor, names, ring, formula)
    if len(names) == 1 and _matches(PRODUCT_OF_INERTIA, names[0]) and len(factor) == 1:
        return Requirement("requires_condition", f"{names[0]} == 0", (formula,))
    return None


def _of_moments(factor: PolyElement, names: list[Expr], ring: FormulaRing, formula: Expr) -> Requirement | None:
    """Return the condition ``I1 + I2 == I3`` for the factor I1 + I2 - I3; None for I1 + I2, which is positive."""
    coefficients = [int(factor[ring.ring.gens[ring.symbols[name]].leading_expv()]) for name in names]
    sides = [[str(n) for n, c in zip(names, coefficients, strict=True) if c * sign > 0] for sign in (1, -1)]
    if not all(sides):
        return None
    left, right = sorted(sides, key=lambda side: (-len(side), side))
    code = "requires_symmetric_top" if len(names) == 2 else "requires_condition"
    return Requirement(code, f"{' + '.join(left)} == {' + '.join(right)}", (formula,))


def _is_unit_norm(factor: PolyElement, variables: int) -> bool:
    constant = factor.coeff(1)
    squares = [mono for mono in factor if any(mono)]
    return (
        variables > 1
        and len(squares) == variables
        and constant != 0
        and all(sum(mono) == max(mono) == 2 and factor[mono] == -constant for mono in squares)
    )


def _no_products(
    ring: FormulaRing, numerators: Sequence[PolyElement], sides: Sequence[tuple[Expr, Expr]]
) -> list[Requirement]:
    """Return [condition] if a claim is true where its products of inertia are zero, as a book may assume; otherwise [].

    ``numerators`` are the numerators of left minus right, one for each entry whose sides differ, and ``sides`` are the
    left and right sides of these entries. A book that assumes principal axes writes no products of inertia: so one side
    of each entry must contain none of the products that the condition sets to zero.
    """
    products = [(leaf, n) for leaf, n in ring.symbols.items() if _matches(PRODUCT_OF_INERTIA, leaf)]
    if not products or not all(any(mono[n] for _, n in products) for poly in numerators for mono in poly):
        return []
    used = [leaf for leaf, n in products if any(mono[n] for poly in numerators for mono in poly)]
    if not all(any(not side.has(*used) for side in pair) for pair in sides):
        return []
    return [Requirement("requires_condition", " and ".join(f"{leaf} == 0" for leaf in used), tuple(used))]


def _matches(pattern: re.Pattern[str], leaf: Expr) -> bool:
    return bool(leaf.is_Symbol and pattern.fullmatch(leaf.name))


# -- roots ------------------------------------------------------------------------------------------------------------


def branch_requirements(ring: FormulaRing, numerators: Sequence[PolyElement]) -> list[Requirement] | None:
    """Return [condition] for a claim with square roots that is true under this condition on signs.

    The condition is ``x >= 0`` for ``sqrt(x**2) == x``. ``numerators`` are the numerators of left minus right, one for
    each entry whose sides differ. Return [] if the condition always holds, and None if no condition is known.
    """
    for root, place in ring.roots.items():
        if root.index != 2 or root.expression.is_number:
            continue
        generator = ring.ring.gens[place]
        square = ring._polynomial(root)
        signs: dict[str, Expr] = {}
        for poly in numerators:
            # the numerator of a residual is a + b*g with the root g, g^2 = P: where a^2 - b^2 P = 0, g is a/b or -a/b
            without, rest = _split(poly, place, generator)
            if not rest or ring.reduce(without**2 - rest**2 * square):
                break
            # the claim says g = -a/b, which holds exactly where -a/b >= 0
            # where b is zero, a is zero too, and the claim holds: so b != 0 is no condition
            value = normal_form(-without.as_expr(*ring.generators) / rest.as_expr(*ring.generators), ring.hypotheses)
            if not surely_nonnegative(value):
                signs[f"{as_text(value)} >= 0"] = value
        else:
            stated = tuple(signs[text] for text in sorted(signs))
            text = range_text([(value, ">= 0") for value in stated], divided=False)
            return [Requirement("sign_branch", text, signs=stated)] if text else []
    return None


def _split(poly: PolyElement, place: int, generator: PolyElement) -> tuple[PolyElement, PolyElement]:
    """Return polynomials (a, b) with poly = a + b*generator, a without the ``generator``, whose index is ``place``."""
    without = poly.new({mono: c for mono, c in poly.items() if not mono[place]})
    return without, (poly - without).exquo(generator) if poly != without else poly.ring.zero
