"""Whether what a claim takes for granted holds anywhere, what follows from it, and where it leaves the claim false.

A claim about sides that are defined nowhere, or under hypotheses that nothing obeys, is true of nothing: it is refused
where that can be proven, and undecided where no point is known at which the sides are real numbers and the hypotheses
hold (:mod:`symrot.exact.domain.known_points`).
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property

from sympy import CRootOf, Expr, Rational, Symbol, atan2, pi, preorder_traversal
from sympy import cos as cosine_of
from sympy import sin as sine_of
from sympy.core.function import AppliedUndef
from sympy.polys.rings import PolyElement

from symrot.checker.claim.atoms import atoms_of
from symrot.checker.decide.constraints import Constraints, constraints_of, occurring
from symrot.checker.decide.infeasibility import Emptiness, vanishes_on, why_empty
from symrot.checker.decide.real_points import ATTEMPTS, RealPoint, real_points, value_at
from symrot.errors import InputError
from symrot.exact.angles.angles import base_angle
from symrot.exact.counterexample import Counterexample as Witness
from symrot.exact.decide import is_zero, normal_form
from symrot.exact.domain.domain import is_dense
from symrot.exact.domain.everywhere import fails_everywhere, range_everywhere
from symrot.exact.domain.known_points import holds, known_point
from symrot.exact.domain.needs import Need, is_leaf, leaves_of
from symrot.exact.intervals import enclosure
from symrot.exact.ring.ring import FormulaRing

__all__ = ["Grounds"]

Search = Callable[[FormulaRing, Expr, Expr, tuple[int, int] | None], Witness | None]

FEW = 24
"""Points drawn before proofs are tried, which cost more."""

CANDIDATES = 8
"""Points where the sides differ among which the one that reads best is shown."""

OTHER_VALUES = tuple(Rational(n, d) for n, d in ((1, 1), (2, 1), (1, 2), (-1, 1), (3, 1), (-1, 3), (5, 7), (-3, 2)))


class Grounds:
    """The hypotheses of one decision.

    Parameters
    ----------
    ring : FormulaRing
        Into which everything was read that the claim divides by.
    text : function
        From an expression to text.
    needs : sequence of Need
        What the sides and hypotheses need to be real numbers, as they are written.
    """

    def __init__(self, ring: FormulaRing, text: Callable[[Expr], str], needs: Sequence[Need] = ()) -> None:
        self.ring, self.text, self.needs = ring, text, tuple(needs)
        self._drawn: list[RealPoint | None] = []

    @cached_property
    def constraints(self) -> Constraints:
        """What is taken for granted, as polynomials."""
        return constraints_of(self.ring)

    @cached_property
    def matter(self) -> bool:
        """Whether there are hypotheses, or symbols with a sign, at all."""
        signs = self.constraints
        return bool(self.ring.hypotheses or signs.positive or signs.negative or signs.nonnegative or signs.whole)

    @cached_property
    def _source(self) -> Iterator[RealPoint | None]:
        return real_points(self.constraints)

    def points(self, attempts: int = ATTEMPTS) -> Iterator[RealPoint]:
        """Yield the points among the first so many drawn that obey all constraints; all are drawn once."""
        number = 0
        while number < attempts:
            if number == len(self._drawn):
                self._drawn.append(next(self._source, None))
            point = self._drawn[number]
            number += 1
            if point is not None:
                yield point

    # -- a point of the domain ----------------------------------------------------------------------------------------

    def known(self, further: Sequence[Need] = (), zeros: Sequence[Expr] = ()) -> bool:
        """Return whether a real point is known at which all needs and hypotheses hold.

        Parameters
        ----------
        further : sequence of Need
            Beside the needs of the claim: what a proof divides by, the sign that a condition states.
        zeros : sequence of Expr
            What vanishes too, of a condition.

        Raises
        ------
        InputError
            If there is proven to be none, were it not for ``further`` and ``zeros``.
        """
        needs = list(dict.fromkeys([*self.needs, *further]))
        if not self.ring.hypotheses and not zeros and self._polynomial_core(needs):
            return True
        needs = [need for need in needs if leaves_of([need.formula]) or not self._true_number(need)]
        if any(not leaves_of([need.formula]) for need in needs):
            return False
        if self.ring.hypotheses and not zeros and self._drawn_point(needs, FEW):
            return True
        if known_point(needs, [*self.ring.hypotheses, *zeros]) is not None:
            return True
        self.refuse_if_empty()
        self._refuse_if_excluded()
        return bool(self.ring.hypotheses and not zeros and self._drawn_point(needs, ATTEMPTS))

    def _refuse_if_excluded(self) -> None:
        """Raise ``InputError`` where the hypotheses turn a need into a number that breaks it."""
        for need in self.needs if self.ring.hypotheses else ():
            try:
                reduced = normal_form(need.formula, self.ring.hypotheses)
            except InputError:
                continue
            if reduced.is_Rational and fails_everywhere(Need(reduced, need.sign)):
                raise InputError(f"the hypotheses exclude that the sides are real numbers: {self._shown_need(need)}")

    def refuse_if_nowhere(self) -> None:
        """Raise ``InputError`` where the range of a formula shows that the sides are real numbers nowhere."""
        for need in self.needs:
            if fails_everywhere(need):
                raise InputError(f"the sides are real numbers nowhere: {self._shown_need(need)} holds at no real point")
        for hypothesis in self.ring.hypotheses:
            low, high = range_everywhere(hypothesis)
            if low > 0 or high < 0:
                shown = f"{self.text(hypothesis)} would have to be zero and cannot be"
                raise InputError(f"the hypotheses hold at no real point: {shown}")

    def _polynomial_core(self, needs: Sequence[Need]) -> bool:
        """Return whether the points where nothing vanishes that is divided by are dense, by the theorem of the core."""
        return is_dense(self.ring) and all(need.sign == "!= 0" for need in needs)

    def _shown_need(self, need: Need) -> str:
        return f"{self.text(need.formula)} {need.sign}"

    def _true_number(self, need: Need) -> bool:
        """Return whether a need of constants holds; ``InputError`` where it is proven not to."""
        held = enclosure(need.formula)
        if held is None:
            return False
        zero = 0 in held and is_zero(need.formula)
        fails = (held.b < 0 and need.sign != "!= 0") or (zero and need.sign != ">= 0")
        if fails:
            raise InputError(f"the sides are no real numbers: {self._shown_need(need)} does not hold")
        return zero or holds(need, {})

    def _drawn_point(self, needs: Sequence[Need], attempts: int) -> bool:
        """Return whether needs are proven to hold at one of the exact points of the hypotheses."""
        if not self.constraints.complete:
            return False
        leaves = leaves_of(need.formula for need in needs)
        for point in self.points(attempts):
            values = self._values(point)
            values.update((leaf, OTHER_VALUES[n % len(OTHER_VALUES)]) for n, leaf in enumerate(leaves)
                          if leaf not in values)  # fmt: skip
            if all(holds(need, values) for need in needs):
                return True
        return False

    def _values(self, point: RealPoint) -> dict[Expr, Expr]:
        """Return the values of symbols and of plain angles at a point."""
        values = {leaf: point.number(point.values[n]) for leaf, n in self.ring.symbols.items() if n in point.values}
        for atom, place in self.ring.sines.items():
            if place in point.values and is_leaf(atom):
                sine, cosine = (point.number(point.values[n]) for n in (place, self.ring.cosines[atom]))
                values[atom] = atan2(sine, cosine) * atom / base_angle(atom, self.ring.bases[atom])
        return values

    @cached_property
    def _empty(self) -> Emptiness | None:
        return why_empty(self.constraints) if self.matter or self.ring.roots else None

    def refuse_if_empty(self) -> None:
        """Raise ``InputError`` where hypotheses and sides are proven to have no real point in common."""
        empty = self._empty
        if empty is None:
            return
        generators = self.ring.generators
        reason, poly = empty.reason, empty.polynomial
        if poly is not None and not occurring([poly]) - set(range(len(generators))):
            formula = poly.as_expr(*generators, *[Symbol("inverse")] * (poly.ring.ngens - len(generators)))
            reason = f"{self.text(formula)} would have to be zero and cannot be" if formula else reason
        if not self.ring.hypotheses:
            raise InputError(f"the sides are real numbers nowhere: {reason}")
        divisors = " where both sides are defined" if self.constraints.nonzero else ""
        raise InputError(f"the hypotheses hold at no real point{divisors}: {reason}")

    def imply(self, numerators: Iterable[PolyElement]) -> bool:
        """Return whether polynomials are proven to vanish at all real points of the constraints."""
        target = self.constraints.ring
        return self.matter and all(vanishes_on(self.constraints, poly.set_ring(target)) for poly in numerators)

    def allow(self, zeros: Sequence[Expr]) -> bool:
        """Return whether expressions may vanish together: False where that is proven impossible."""
        if not self.matter or not zeros:
            return True
        target = self.constraints.ring
        added = [self.ring.ratio(zero).numerator.set_ring(target) for zero in zeros]
        return why_empty(replace(self.constraints, zeros=(*self.constraints.zeros, *added))) is None

    def checked(self, search: Search) -> Search:
        """Return a search for witnesses less those at which something is zero that must not be."""

        def searched(ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None) -> Witness | None:
            found = search(ring, left, right, entry)
            return found if found is not None and self._nowhere_zero(dict(found.values)) else None

        return searched

    # -- witnesses ----------------------------------------------------------------------------------------------------

    def near_witness(self, ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None) -> Witness | None:
        """As :meth:`witness`, among the first few points."""
        return self.witness(ring, left, right, entry, FEW)

    def witness(
        self, ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None, attempts: int = ATTEMPTS
    ) -> Witness | None:
        """Return an exact point of the constraints where two sides differ, or None if none was found."""
        if not self.matter or not self.constraints.real or not self.constraints.complete:
            return None
        residual = ring.difference(left, right).numerator.set_ring(self.constraints.ring)
        parts = [part for side in (left, right) for part in self._parts(side)]  # what both sides have cancels
        if not occurring([residual, *parts]) <= self.constraints.free:
            return self._by_enclosures(left, right, entry, attempts)
        found = []
        for point in self.points(attempts):
            if value_at(residual, point):
                found.append(point)
            if len(found) == CANDIDATES:
                break
        return self._shown(min(found, key=lambda point: point.size), left, right, entry) if found else None

    def _shown(self, point: RealPoint, left: Expr, right: Expr, entry: tuple[int, int] | None) -> Witness:
        used = set().union(*(preorder_traversal(formula) for formula in (left, right, *self.ring.hypotheses)))
        pairs = list(self._named(point, used))
        sides = [self._value(side, point) for side in (left, right)]
        roots = sorted({root for value in (*sides, *(v for _, v in pairs)) for root in value.atoms(CRootOf)}, key=str)
        names = {root: Symbol("root" + "_" * number) for number, root in enumerate(roots, start=0)}
        values = [(name, value.xreplace(names)) for name, value in pairs] + [(n, root) for root, n in names.items()]
        return Witness(tuple(values), entry, *(side.xreplace(names) for side in sides))

    def _value(self, side: Expr, point: RealPoint) -> Expr:
        above, below = (value_at(part, point) for part in self._parts(side))
        return point.number(above / below)

    def _parts(self, side: Expr) -> tuple[PolyElement, PolyElement]:
        """Return the numerator and denominator of a side."""
        ratio, target = self.ring.ratio(side), self.constraints.ring
        return ratio.numerator.set_ring(target), self.ring.ratios.denominator(ratio).set_ring(target)

    def _named(self, point: RealPoint, used: set[Expr]) -> Iterator[tuple[Expr, Expr]]:
        """Yield symbols and angles in use with their values; quarter turns as angles, others as cosine and sine."""
        quarters = {(0, 1): 0, (1, 0): 1, (0, -1): 2, (-1, 0): 3}
        for leaf, place in self.ring.symbols.items():
            if leaf in used and place in point.values:
                yield leaf, point.number(point.values[place])
        for atom, place in self.ring.sines.items():
            if not atom.atoms(Symbol, AppliedUndef) & used or place not in point.values:
                continue
            sine, cosine = (point.number(point.values[n]) for n in (place, self.ring.cosines[atom]))
            base = base_angle(atom, self.ring.bases[atom])
            if (sine, cosine) in quarters:
                yield atom, quarters[sine, cosine] * pi / 2 * atom / base
            else:
                yield cosine_of(base), cosine
                yield sine_of(base), sine

    def _by_enclosures(self, left: Expr, right: Expr, entry: tuple[int, int] | None, attempts: int) -> Witness | None:
        """Return a point of the symbols where 50-digit intervals of the sides are disjoint."""
        leaves = {place: leaf for leaf, place in self.ring.symbols.items()}
        involved = occurring([*self.constraints.zeros, *self.constraints.products])
        if not involved <= leaves.keys():
            return None
        others = sorted(atoms_of([left, right]) - set(leaves.values()), key=str)
        for point in self.points(attempts):
            values = {leaves[n]: point.number(value) for n, value in point.values.items() if n in leaves}
            values |= {name: OTHER_VALUES[n % len(OTHER_VALUES)] for n, name in enumerate(others)}
            if not self._defined(values):
                continue
            held = [enclosure(side, values) for side in (left, right)]
            if None not in held and 0 not in held[0] - held[1]:
                sides = left.xreplace(values), right.xreplace(values)
                used = atoms_of([left, right, *self.ring.hypotheses])
                shown = sorted(((name, value) for name, value in values.items() if name in used), key=str)
                return Witness(tuple(shown), entry, *sides)
        return None

    def _nowhere_zero(self, values: dict[Expr, Expr]) -> bool:
        factors = [factor.as_expr(*self.ring.generators) for factor in self.ring.ratios.factors]
        enclosures = [enclosure(factor, values) for factor in factors]
        return all(held is not None and 0 not in held for held in enclosures)

    def _defined(self, values: dict[Expr, Expr]) -> bool:
        if not self._nowhere_zero(values):
            return False
        roots = [enclosure(found.base, values) for found in self.ring.radicals.values()]
        return all(held is not None and held.a >= 0 for held in roots)
