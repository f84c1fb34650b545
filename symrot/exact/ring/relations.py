"""Relations between the variables of a polynomial ring, and the normal form of a polynomial modulo these relations.

A rule ``g^n = P``, where P contains only lower variables, replaces the power ``g^n``. Rules are applied from the
highest variable down. Any other relation needs a Groebner basis, by Buchberger's algorithm.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sympy.polys.domains import ZZ
from sympy.polys.rings import PolyElement

from symrot.exact.limits.operations import spend
from symrot.exact.ring.groebner import groebner_basis
from symrot.exact.ring.ratio import TooLarge

__all__ = ["Relations", "Rule", "relate"]

MOST_TERMS = 500_000
"""Largest number of terms that applying one relation may produce; terms with long monomials count more."""


@dataclass(frozen=True)
class Rule:
    """A rule ``generator^power = replacement`` for a variable; the replacement contains no higher variable."""

    generator: int
    power: int
    replacement: PolyElement  # without the generator, unless minimal
    minimal: bool = False  # minimal polynomial of an algebraic number: no other variable occurs

    @property
    def polynomial(self) -> PolyElement:
        """The polynomial ``generator^power - replacement`` of the ring, which is zero by the rule."""
        return self.replacement.ring.gens[self.generator] ** self.power - self.replacement


# The leading powers of rules belong to different variables and are coprime, so rules alone are a Groebner basis.
@dataclass(frozen=True)
class Relations:
    """The relations between the variables of a polynomial ring.

    They are ``rules``, highest variable first, or a Groebner ``basis`` if rules do not suffice.
    """

    rules: tuple[Rule, ...] = ()
    basis: tuple[PolyElement, ...] = ()

    def reduce(self, poly: PolyElement) -> PolyElement:
        """Return the normal form of a polynomial modulo the relations.

        It is 0 if and only if the polynomial is a sum of multiples of relations: ``x^2 = 0`` does not reduce x to 0.
        """
        for rule in self.rules:
            spend(2 * len(poly))
            poly = (_divide if rule.minimal else _replace)(poly, rule)
        return poly.rem(list(self.basis)) if self.basis and poly else poly

    @property
    def contradictory(self) -> bool:
        """Whether the relations contradict each other, that is, imply 1 = 0; then no point satisfies the hypotheses."""
        return any(poly.is_ground for poly in self.basis)


def relate(rules: Sequence[Rule], hypotheses: Sequence[PolyElement]) -> Relations | None:
    """Return the relations that follow from ``rules`` and ``hypotheses``, polynomials that are zero.

    Return None if these relations need fractions and the ring has integer coefficients.
    """
    known = _ordered(rules)
    for hypothesis in hypotheses:
        poly = known.reduce(hypothesis)
        if not poly:
            continue
        rule = _as_rule(poly, known)
        if rule is not None:
            known = _ordered([*known.rules, rule])
        elif poly.ring.domain is ZZ:
            # the caller starts again with rational coefficients
            return None
        else:
            everything = [*(rule.polynomial for rule in rules), *(p for p in hypotheses if p)]
            return Relations(basis=groebner_basis(everything, poly.ring))
    return known


def _ordered(rules: Sequence[Rule]) -> Relations:
    return Relations(tuple(sorted(rules, key=lambda rule: rule.generator)))


def _as_rule(poly: PolyElement, known: Relations) -> Rule | None:
    """Return ``poly = 0`` as a rule ``g^n = ..`` for a variable g that has no rule in ``known``, or None."""
    lead = poly.leading_expv()
    places = [number for number, power in enumerate(lead) if power]
    if len(places) != 1 or any(rule.generator == places[0] for rule in known.rules):
        return None
    place, coefficient = places[0], poly[lead]
    # g may occur in the leading term alone
    if any(mono[place] for mono in poly if mono != lead):
        return None
    if poly.ring.domain is ZZ and abs(coefficient) != 1:
        return None
    rest = poly - poly.ring.term_new(lead, coefficient)
    return Rule(place, lead[place], (-rest).quo_ground(coefficient))


def _replace(poly: PolyElement, rule: Rule) -> PolyElement:
    """Return a polynomial in which all powers of g from ``g^n`` on are replaced by the rule ``g^n = ..``."""
    place, power = rule.generator, rule.power
    low: dict[tuple[int, ...], Any] = {}
    high: dict[int, dict[tuple[int, ...], Any]] = {}
    for mono, coefficient in poly.items():
        times, left = divmod(mono[place], power)
        if times:
            high.setdefault(times, {})[(*mono[:place], left, *mono[place + 1 :])] = coefficient
        else:
            low[mono] = coefficient
    if not high:
        return poly
    weight = 1 + poly.ring.ngens // 8
    if weight * sum(len(terms) * len(rule.replacement) ** times for times, terms in high.items()) > MOST_TERMS:
        raise TooLarge(
            f"reducing the formula gives an intermediate result of more than {MOST_TERMS} terms; split the formula"
        )
    total = poly.new(low)
    for times in sorted(high):
        total = total + poly.new(high[times]) * rule.replacement**times
    return total


def _divide(poly: PolyElement, rule: Rule) -> PolyElement:
    """Return the remainder of ``poly`` after division by the polynomial ``g^n - P`` of a rule ``g^n = P``."""
    place, power = rule.generator, rule.power
    # variables other than that of the algebraic number count as coefficients
    groups: dict[tuple[int, ...], dict[int, Any]] = {}
    for mono, coefficient in poly.items():
        groups.setdefault((*mono[:place], 0, *mono[place + 1 :]), {})[mono[place]] = coefficient
    if all(max(column) < power for column in groups.values()):
        return poly
    replacement = [(mono[place], coefficient) for mono, coefficient in rule.replacement.items()]
    zero = poly.ring.domain.zero
    total: dict[tuple[int, ...], Any] = {}
    for mono, column in groups.items():
        for high in range(max(column), power - 1, -1):
            lead = column.pop(high, zero)
            for low, coefficient in replacement if lead else ():
                column[high - power + low] = column.get(high - power + low, zero) + lead * coefficient
        total |= {(*mono[:place], n, *mono[place + 1 :]): c for n, c in column.items() if c}
    return poly.new(total)
