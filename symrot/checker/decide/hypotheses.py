"""The hypotheses of a claim: points where they hold, and whether they imply the claim or can hold at all.

A claim is refused if its hypotheses provably hold nowhere, or if its sides are provably real nowhere. It is undecided
if no point is known where the hypotheses hold and the sides are real.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property

from sympy import CRootOf, Expr, Rational, Symbol, atan2
from sympy.polys.rings import PolyElement

from symrot.checker.claim.interpreter import atoms_of
from symrot.checker.decide.constraints import Constraints, constraints_of
from symrot.checker.decide.infeasibility import Infeasibility, infeasibility_proof, vanishes_on
from symrot.checker.decide.real_points import ATTEMPTS, RealPoint, real_points
from symrot.errors import InputError
from symrot.exact.angles.angles import base_angle
from symrot.exact.counterexample import coordinates_of
from symrot.exact.decide import is_zero, normal_form
from symrot.exact.decision import Search
from symrot.exact.domain.domain import is_dense
from symrot.exact.domain.everywhere import fails_everywhere, range_everywhere
from symrot.exact.domain.known_points import holds, known_point
from symrot.exact.domain.needs import Need, is_leaf, leaves_of
from symrot.exact.evidence import Counterexample
from symrot.exact.intervals import enclosure, is_nonnegative_at
from symrot.exact.printing import as_text
from symrot.exact.ring.polynomials import occurring
from symrot.exact.ring.ring import FormulaRing

__all__ = ["Hypotheses"]

FEW = 24
"""The number of random points that are tried before proofs, which take longer."""

CANDIDATES = 8
"""The search for a counterexample ends after this many points at which the sides differ. The point that is shortest as
text becomes the counterexample, a rational one if there is any."""

OTHER_VALUES = tuple(Rational(n, d) for n, d in ((1, 1), (2, 1), (1, 2), (-1, 1), (3, 1), (-1, 3), (5, 7), (-3, 2)))
"""Values for symbols that occur in no hypothesis. A random point that obeys the hypotheses has no values for them."""


NOWHERE = "there are no real values of the letters for which both sides are real numbers"


class Hypotheses:
    """The hypotheses of one claim, with methods that find points where they hold or prove that there is none.

    Parameters
    ----------
    ring : FormulaRing
        The ring of the claim's formulas, with all divisors of the claim.
    needs : sequence of Need
        Conditions under which sides and hypotheses, as they are written, are real numbers.
    """

    def __init__(self, ring: FormulaRing, needs: Sequence[Need] = ()) -> None:
        self.ring, self.needs = ring, tuple(needs)
        self._drawn: list[RealPoint | None] = []

    @cached_property
    def constraints(self) -> Constraints:
        """The hypotheses, and the assumed signs of symbols, as polynomial constraints."""
        return constraints_of(self.ring)

    @cached_property
    def present(self) -> bool:
        """Whether there are hypotheses, or symbols that are assumed to have a sign or to be integers."""
        signs = self.constraints
        return bool(self.ring.hypotheses or signs.positive or signs.negative or signs.nonnegative or signs.whole)

    @cached_property
    def _source(self) -> Iterator[RealPoint | None]:
        return real_points(self.constraints)

    def points(self, attempts: int = ATTEMPTS) -> Iterator[RealPoint]:
        """Yield random points that obey all constraints, at most one for each of ``attempts`` attempts."""
        number = 0
        while number < attempts:
            # each point is drawn once and stored for later calls
            if number == len(self._drawn):
                self._drawn.append(next(self._source, None))
            point = self._drawn[number]
            number += 1
            if point is not None:
                yield point

    # -- a point of the domain ----------------------------------------------------------------------------------------

    def point_is_known(self, further: Sequence[Need] = (), zeros: Sequence[Expr] = ()) -> bool:
        """Return whether a real point is known at which the hypotheses hold and the claim's formulas have real values.

        Parameters
        ----------
        further : sequence of Need
            Further conditions on the point: nonzero divisors of a proof, the sign that a condition states.
        zeros : sequence of Expr
            Further formulas, such as those of a condition for the claim, that must be zero at the point.

        Raises
        ------
        InputError
            If even without ``further`` and ``zeros`` there is provably no such point.
        """
        needs = list(dict.fromkeys([*self.needs, *further]))
        if not self.ring.hypotheses and not zeros and self._points_are_dense(needs):
            return True
        # only the sides' own needs say that they are not real; a condition that fails leaves no point
        needs = [need for need in needs if leaves_of([need.formula]) or not self._true_number(need, need in self.needs)]
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
        """Raise InputError if the hypotheses make a divisor zero, or the formula under a root a negative number."""
        for need in self.needs if self.ring.hypotheses else ():
            try:
                reduced = normal_form(need.formula, self.ring.hypotheses)
            except InputError:
                continue
            if reduced.is_Rational and fails_everywhere(Need(reduced, need.sign)):
                raise InputError(
                    f"under the hypotheses the sides are not real numbers: {_need_text(need)} does not hold"
                )

    def refuse_if_nowhere(self) -> None:
        """Raise InputError if the ranges of formulas show that a side of the claim is real nowhere, such as
        ``sqrt(-1 - x**2)``, or that a hypothesis holds nowhere.
        """
        for need in self.needs:
            if fails_everywhere(need):
                raise InputError(f"{NOWHERE}: {_need_text(need)} never holds")
        for hypothesis in self.ring.hypotheses:
            low, high = range_everywhere(hypothesis)
            if low > 0 or high < 0:
                contradiction = f"{as_text(hypothesis)} would have to be zero and cannot be"
                raise InputError(f"the hypotheses hold at no real point: {contradiction}")

    def _points_are_dense(self, needs: Sequence[Need]) -> bool:
        """Return whether every neighbourhood of every point provably has a point that meets all ``needs``."""
        # the points where no divisor vanishes are dense; no other need than x != 0 may restrict them
        return is_dense(self.ring) and all(need.sign == "!= 0" for need in needs)

    def _true_number(self, need: Need, is_of_claim: bool) -> bool:
        """Return whether a condition without symbols, such as ``2 - 1 > 0``, is proven; False if it may fail.

        ``is_of_claim`` says that the sides and hypotheses of the claim, as they are written, are real numbers only
        under this condition.

        Raises
        ------
        InputError
            If ``is_of_claim`` and the condition is proven to be false.
        """
        interval = enclosure(need.formula)
        if interval is None:
            return False
        zero = 0 in interval and is_zero(need.formula)
        fails = (interval.b < 0 and need.sign != "!= 0") or (zero and need.sign != ">= 0")
        if fails and is_of_claim:
            raise InputError(f"the sides are not real numbers: {_need_text(need)} does not hold")
        return not fails and (zero or holds(need, {}))

    def _drawn_point(self, needs: Sequence[Need], attempts: int) -> bool:
        """Return whether one of ``attempts`` random points obeys the hypotheses exactly and meets ``needs``.

        A :class:`Need` is a condition such as ``x >= 0``, without which ``sqrt(x)`` has no real value.
        """
        # the points need not obey a hypothesis that is not among the constraints
        if not self.constraints.complete:
            return False
        formulas = [need.formula for need in needs]
        for point in self.points(attempts):
            values = self._values_for(formulas, point)
            if all(holds(need, values) for need in needs):
                return True
        return False

    def _values(self, point: RealPoint) -> dict[Expr, Expr]:
        """Return the values of symbols and angles at ``point``, which has values for symbols, sines and cosines."""
        values = {leaf: point.number(point.values[n]) for leaf, n in self.ring.symbols.items() if n in point.values}
        for atom, place in self.ring.sines.items():
            if place in point.values and is_leaf(atom):
                sine, cosine = (point.number(point.values[n]) for n in (place, self.ring.cosines[atom]))
                # the point has values for sin(theta) and cos(theta), of which atan2 gives theta
                values[atom] = atan2(sine, cosine) * atom / base_angle(atom, self.ring.bases[atom])
        return values

    def _values_for(self, formulas: Sequence[Expr], point: RealPoint) -> dict[Expr, Expr]:
        """Return the values of all symbols in ``formulas`` at a point; symbols in no hypothesis get simple values."""
        values = self._values(point)
        for number, leaf in enumerate(leaves_of(formulas)):
            values.setdefault(leaf, OTHER_VALUES[number % len(OTHER_VALUES)])
        return values

    @cached_property
    def _infeasibility(self) -> Infeasibility | None:
        return infeasibility_proof(self.constraints) if self.present or self.ring.roots else None

    def refuse_if_empty(self) -> None:
        """Raise InputError if provably no real point exists where the hypotheses hold and both sides of the claim have
        a value.
        """
        infeasibility = self._infeasibility
        if infeasibility is None:
            return
        generators = self.ring.generators
        reason, poly = infeasibility.reason, infeasibility.polynomial
        if poly is not None and not occurring([poly]) - set(range(len(generators))):
            formula = poly.as_expr(*generators, *[Symbol("inverse")] * (poly.ring.ngens - len(generators)))
            reason = f"{as_text(formula)} would have to be zero and cannot be" if formula else reason
        if not self.ring.hypotheses:
            raise InputError(f"{NOWHERE}: {reason}")
        divisors = " where both sides are defined" if self.constraints.nonzero else ""
        raise InputError(f"the hypotheses hold at no real point{divisors}: {reason}")

    def entails(self, numerators: Iterable[PolyElement]) -> bool:
        """Return whether hypotheses and assumed signs provably make the ``numerators`` of left - right zero; False for
        a claim without hypotheses and assumed signs.
        """
        target = self.constraints.ring
        return self.present and all(vanishes_on(self.constraints, poly.set_ring(target)) for poly in numerators)

    def consistent_with(self, zeros: Sequence[Expr]) -> bool:
        """Return False if the hypotheses provably rule out that all formulas ``zeros`` are zero at a point; otherwise
        True.
        """
        if not self.present or not zeros:
            return True
        # a condition that contradicts the hypotheses is not offered
        target = self.constraints.ring
        added = [self.ring.ratio(zero).numerator.set_ring(target) for zero in zeros]
        return infeasibility_proof(replace(self.constraints, zeros=(*self.constraints.zeros, *added))) is None

    def checked(self, search: Search) -> Search:
        """Return a search for counterexamples that drops the points of ``search`` at which a divisor of the claim is
        zero.
        """

        def searched(
            ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None
        ) -> Counterexample | None:
            witness = search(ring, left, right, entry)
            return witness if witness is not None and self._divisors_nonzero(dict(witness.point)) else None

        return searched

    # -- counterexamples ----------------------------------------------------------------------------------------------

    def near_witness(
        self, ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None
    ) -> Counterexample | None:
        """Return a counterexample to ``left == right`` among the first few points that obey the hypotheses, or None.

        The arguments are those of :meth:`witness`.
        """
        return self.witness(ring, left, right, entry, FEW)

    def witness(
        self, ring: FormulaRing, left: Expr, right: Expr, entry: tuple[int, int] | None, attempts: int = ATTEMPTS
    ) -> Counterexample | None:
        """Return a counterexample to ``left == right``: an exact point that obeys the hypotheses, or None.

        Parameters
        ----------
        ring : FormulaRing
            The ring in which left - right is computed.
        left, right : Expr
            The sides of a claim, or one entry of each side of a matrix equation.
        entry : (int, int) or None
            The row and column of this entry; None for a claim about scalars.
        attempts : int
            The number of attempts to find a point.
        """
        if not self.present or not self.constraints.real or not self.constraints.complete:
            return None
        residual = ring.difference(left, right).numerator.set_ring(self.constraints.ring)
        parts = [part for side in (left, right) for part in self._parts(side)]  # terms of both sides may cancel
        if not occurring([residual, *parts]) <= self.constraints.free:
            return self._by_enclosures(left, right, entry, attempts)
        candidates = []
        for point in self.points(attempts):
            if point.value(residual) and self._other_divisors_nonzero(point):
                candidates.append(point)
            if len(candidates) == CANDIDATES:
                break
        if not candidates:
            return None

        return self._counterexample(min(candidates, key=lambda point: point.size), left, right, entry)

    def _counterexample(
        self, point: RealPoint, left: Expr, right: Expr, entry: tuple[int, int] | None
    ) -> Counterexample:
        numbers = {n: point.number(value) for n, value in point.values.items()}
        pairs = list(coordinates_of(self.ring, numbers, (left, right, *self.ring.hypotheses)))
        sides = [self._value(side, point) for side in (left, right)]
        roots = sorted({root for value in (*sides, *(v for _, v in pairs)) for root in value.atoms(CRootOf)}, key=str)
        names = {root: Symbol("root" + "_" * number) for number, root in enumerate(roots, start=0)}
        values = [(name, value.xreplace(names)) for name, value in pairs] + [(n, root) for root, n in names.items()]
        return Counterexample(tuple(values), entry, *(side.xreplace(names) for side in sides))

    def _value(self, side: Expr, point: RealPoint) -> Expr:
        above, below = map(point.value, self._parts(side))
        return point.number(above / below)

    def _parts(self, side: Expr) -> tuple[PolyElement, PolyElement]:
        """Return numerator and denominator of a side of the claim, as polynomials in ``self.constraints.ring``."""
        ratio, target = self.ring.ratio(side), self.constraints.ring
        return ratio.numerator.set_ring(target), self.ring.ratios.denominator(ratio).set_ring(target)

    def _by_enclosures(
        self, left: Expr, right: Expr, entry: tuple[int, int] | None, attempts: int
    ) -> Counterexample | None:
        """Return a counterexample: a point where the intervals that enclose the two sides are disjoint; or None.

        The arguments are those of :meth:`witness`.
        """
        ring, constraints = self.ring, self.constraints
        known = {*ring.symbols.values(), *ring.roots.values()}
        known |= {n for atom, n in ring.sines.items() if is_leaf(atom)}
        known |= {n for atom, n in ring.cosines.items() if is_leaf(atom)}
        if not occurring([*constraints.zeros, *constraints.products]) <= known & constraints.free:
            return None
        for point in self.points(attempts):
            values = self._values_for([left, right], point)
            if not self._defined(values):
                continue
            intervals = [enclosure(side, values) for side in (left, right)]
            if None not in intervals and 0 not in intervals[0] - intervals[1]:
                sides = left.xreplace(values), right.xreplace(values)
                used = atoms_of([left, right, *self.ring.hypotheses, *self.ring.domain])
                coordinates = sorted(((name, value) for name, value in values.items() if name in used), key=str)
                return Counterexample(tuple(coordinates), entry, *sides)
        return None

    def _other_divisors_nonzero(self, point: RealPoint) -> bool:
        """Return whether the divisors that the random search ignores, such as tanh(x), are nonzero at a point.

        These divisors are ``constraints.unconstrained``; the search solves polynomial equations only.
        """
        factors = [factor.as_expr(*self.ring.generators) for factor in self.constraints.unconstrained]
        values = self._values_for(factors, point)
        return all(holds(Need(factor, "!= 0"), values) for factor in factors)

    def _divisors_nonzero(self, values: dict[Expr, Expr]) -> bool:
        factors = (factor.as_expr(*self.ring.generators) for factor in self.ring.ratios.factors)
        return all(holds(Need(factor, "!= 0"), values) for factor in factors)

    def _defined(self, values: dict[Expr, Expr]) -> bool:
        if not self._divisors_nonzero(values):
            return False
        return all(is_nonnegative_at(radical.base, values) for radical in self.ring.radicals.values())


def _need_text(need: Need) -> str:
    return f"{as_text(need.formula)} {need.sign}"
