"""Exact real points that obey constraints: rational points first, then points with algebraic coordinates.

A point is chosen at random, equation by equation. An equation is solved if it is linear in an unknown, a quadric, a
polynomial in one unknown, or a product; otherwise an unknown gets a simple value. Every point is checked exactly.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from random import Random
from typing import Any

from sympy import Expr, Poly, Symbol
from sympy.polys.domains import QQ
from sympy.polys.rings import PolyElement

from symrot.checker.decide.constraints import Constraints, distinct_factors
from symrot.checker.decide.quadrics import SIMPLE, point_of_quadric
from symrot.exact.ring.polynomials import occurring, value_at

__all__ = ["ATTEMPTS", "RealPoint", "real_points"]

ATTEMPTS = 120
"""Default number of attempts to find a random point that obeys the constraints."""
RATIONAL = 60
"""In this number of attempts, the first ones, all values of a point are rational. Later attempts may use irrational
roots of equations."""

MOST_STEPS = 60
"""Largest number of steps in one attempt to find a point; a step chooses values of unknowns or solves an equation."""
MOST_TERMS = 300
"""Largest number of terms in an equation for the unknowns; if an equation grows beyond it, the attempt ends."""

MOST_BARREN = 3
"""Number of failures to find an allowed point on a quadric (the surface of an equation of degree 2). After them, the
method for quadrics is no longer used for this equation."""

LARGEST_EXTENSION = 8
"""The largest degree of a field of algebraic numbers over the rationals."""

LARGEST_NORM, MOST_NORMS = 24, 400
"""The largest norm of a polynomial that is factored over a field of algebraic numbers, and the largest sum of the norms
of all polynomials that one search factors over such fields.

The norm is the degree of the polynomial times the degree of the field. A norm of 24 takes a fifth of a second, a norm
of 64 six seconds."""


class _DeadEnd(Exception):
    """Exception raised if an attempt to find a point fails: the values chosen so far leave no allowed value for another
    unknown, or the computation becomes too long.
    """


@dataclass(frozen=True)
class RealPoint:
    """A point: the values of unknowns in one field, the rational numbers or a field of real algebraic numbers."""

    values: dict[int, Any]
    field: Any = QQ

    @property
    def rational(self) -> bool:
        """Whether the point's field is the rational numbers."""
        return bool(self.field == QQ)

    def value(self, poly: PolyElement) -> Any:
        """Return the value of a polynomial at the point, as an element of the point's field of numbers."""
        domain = poly.ring.domain
        return value_at(poly, self.values, lambda coefficient: self.field.convert(coefficient, domain))

    def number(self, value: Any) -> Expr:
        """Return ``value``, an element of the point's field, as an exact SymPy number."""
        number: Expr = self.field.to_sympy(value)
        return number if self.rational else number.expand()

    @property
    def size(self) -> tuple[int, int]:
        """A sort key that puts short points first: rational points, then by the length of the point as text."""
        return (not self.rational, sum(len(str(value)) for value in self.values.values() if value))


def _sign(value: Any, field: Any) -> int:
    if not value:
        return 0
    if field == QQ:
        return 1 if value > 0 else -1
    return 1 if field.to_sympy(value).evalf(15, strict=True) > 0 else -1


def real_points(constraints: Constraints, attempts: int = ATTEMPTS) -> Iterator[RealPoint | None]:
    """Yield, for each attempt, a point that exactly obeys all constraints, or None.

    The points are the same on every machine. Nothing is yielded if the imaginary unit is an unknown of the ring.
    """
    source = Random(1)
    known: dict[Any, Any] = {}
    for attempt in range(attempts if constraints.real else 0):
        try:
            point = _Drawing(constraints, source, attempt >= RATIONAL, known).point()
        except _DeadEnd:
            yield None
        else:
            yield point if obeys(constraints, point) else None


def obeys(constraints: Constraints, point: RealPoint) -> bool:
    """Return whether a point with a value for every unknown obeys all constraints."""
    return (
        not any(map(point.value, constraints.zeros))
        and all(map(point.value, constraints.nonzero))
        and all(_sign(point.value(poly), point.field) >= 0 for poly in constraints.products)
        and all(_allowed(constraints, place, value, point.field) for place, value in point.values.items())
    )


def _allowed(constraints: Constraints, place: int, value: Any, field: Any) -> bool:
    sign = _sign(value, field)
    if place in constraints.whole and not (field == QQ and value.denominator == 1):
        return False
    return not (
        (place in constraints.positive and sign <= 0)
        or (place in constraints.negative and sign >= 0)
        or (place in constraints.nonnegative and sign < 0)
    )


class _Drawing:
    """One attempt to find a point: the equations still to be solved, the values so far, and the solved unknowns."""

    def __init__(self, constraints: Constraints, source: Random, algebraic: bool, known: dict[Any, Any]) -> None:
        self.constraints, self.source, self.algebraic, self.known = constraints, source, algebraic, known
        self.field: Any = QQ
        self.roots: list[Expr] = []
        self.ring = constraints.ring
        self.zeros = list(constraints.zeros)
        self.values: dict[int, Any] = {}
        self.solved: list[tuple[int, PolyElement, PolyElement]] = []

    def point(self) -> RealPoint:
        steps = _ORDERS[self.source.randrange(len(_ORDERS))]
        for _ in range(MOST_STEPS):
            self.zeros = [poly for poly in self.zeros if poly]
            if any(poly.is_ground or len(poly) > MOST_TERMS for poly in self.zeros):
                raise _DeadEnd
            if not self.zeros:
                return self.completed()
            if not any(step(self) for step in steps):
                break
        raise _DeadEnd

    def completed(self) -> RealPoint:
        """Return the finished point: first free unknowns get values, then the unknowns for which equations were
        solved.
        """
        later = {place for place, _, _ in self.solved}
        for place in sorted(self.constraints.free - later - self.values.keys()):
            self.values[place] = self.field.convert(self.drawn(place), QQ)
        for place, above, below in reversed(self.solved):
            point = RealPoint(self.values, self.field)
            divisor = point.value(below)
            if not divisor:
                raise _DeadEnd
            self.values[place] = point.value(above) / divisor
        return RealPoint(self.values, self.field)

    def drawn(self, place: int) -> Any:
        """Return a random rational value for an unknown, of a sign that the constraints allow.

        ``place`` is the index of the unknown.
        """
        source = self.source
        for _ in range(20):
            value = (
                source.choice(SIMPLE[:8])
                if source.random() < 0.5
                else QQ(source.randint(-9, 9), source.choice((1, 1, 2, 3)))
            )
            if place in self.constraints.positive | self.constraints.nonnegative:
                value = abs(value)
            if _allowed(self.constraints, place, value, QQ):
                return value
        raise _DeadEnd

    def put(self, values: dict[int, Any]) -> None:
        self.values.update(values)
        pairs = list(values.items())
        self.zeros = [poly.subs(pairs) for poly in self.zeros]

    # -- steps: each returns whether it applied -----------------------------------------------------------------------

    def factor(self) -> bool:
        """Replace an equation ``a*b = 0`` by ``a = 0``, with a factor chosen at random; return whether there was one.

        Once a value is irrational, do nothing and return False: equations are factored over the rationals only.
        """
        for number, poly in enumerate(self.zeros):
            if self.field != QQ:
                return False
            if poly not in self.known:
                self.known[poly] = distinct_factors(poly)
            factors = self.known[poly]
            if len(factors) > 1 or factors[0] != poly.monic():
                self.zeros[number] = self.source.choice(factors)
                return True
        return False

    def substitution(self) -> bool:
        """Solve an equation for an unknown whose coefficient is a number, as ``2*x + y^2 = 1`` for x.

        Return whether there was such an equation.
        """
        return self._solve(lambda slope: slope.is_ground)

    def fraction(self) -> bool:
        """Solve an equation for an unknown in which it is linear, as ``y*x + z = 1`` for x.

        Return whether there was such an equation.
        """
        return self._solve(lambda slope: True)

    def _solve(self, fits: Callable[[PolyElement], bool]) -> bool:
        solvable = []
        for poly in self.zeros:
            for place in sorted(occurring([poly])):
                if poly.degrees()[place] == 1 and place not in self.constraints.whole:
                    slope = poly.diff(place)
                    if fits(slope):
                        solvable.append((len(poly), place, poly, slope))
        if not solvable:
            return False
        smallest = min(item[0] for item in solvable)
        _, place, poly, slope = self.source.choice([item for item in solvable if item[0] == smallest])
        above = -(poly - slope * self.ring.gens[place])
        self.solved.append((place, above, slope))
        self.zeros = [_eliminated(p, place, above, slope) for p in self.zeros if p is not poly]
        return True

    def univariate(self) -> bool:
        """Solve the first of the remaining equations ``zeros`` with a single unknown, and store its value.

        Return False if there is no such equation.
        """
        for poly in self.zeros:
            places = occurring([poly])
            if len(places) == 1:
                (place,) = places
                self.put({place: self.root(poly, place)})
                return True
        return False

    def quadric(self) -> bool:
        """Choose a rational point that solves an equation of degree 2 in several unknowns, as ``x^2 + y^2 = 1``.

        Return whether a point was chosen.
        """
        if self.field != QQ:
            return False
        fitting = [p for p in self.zeros if max(map(sum, p)) == 2 and self.known.get(("barren", p), 0) < MOST_BARREN]
        if not fitting:
            return False
        poly = self.source.choice(fitting)
        places = sorted(occurring([poly]))
        if len(places) < 2:
            return False
        for _ in range(4):
            point = point_of_quadric(poly, places, self.source)
            if point and all(_allowed(self.constraints, place, value, QQ) for place, value in point.items()):
                self.put(point)
                return True
        self.known["barren", poly] = self.known.get(("barren", poly), 0) + 1
        return False

    def guess(self) -> bool:
        """Set one unknown of a random equation to a simple random number, and return True.

        Every method in ``_ORDERS`` returns whether it could be applied; this one always can.
        """
        poly = self.source.choice(self.zeros)

        place = self.source.choice(sorted(occurring([poly])))
        self.put({place: self.field.convert(self.drawn(place), QQ)})
        return True

    # -- roots --------------------------------------------------------------------------------------------------------

    def root(self, poly: PolyElement, place: int) -> Any:
        """Return a root of ``poly``, which contains one unknown, with the index ``place``.

        An irrational root is first added to the field.
        """
        generator = self.ring.gens[place]
        key = (poly, self.field)
        if key not in self.known:
            self.spend(poly.degrees()[place])
            self.known[key] = [factor for factor, _ in poly.factor_list()[1]]
        factors = self.known[key]
        roots = [-f.coeff(1) / f.coeff(generator) for f in factors if f.degrees()[place] == 1]
        roots = [value for value in roots if _allowed(self.constraints, place, value, self.field)]
        if roots:
            return self.source.choice(roots)
        if not self.algebraic or place in self.constraints.whole:
            raise _DeadEnd
        return self.adjoined(self.source.choice(factors), place)

    def spend(self, degree: int) -> None:
        """Add the cost of factoring a polynomial of this degree; raise _DeadEnd if the sum exceeds the budget."""
        if self.field != QQ:
            # only polynomials over an algebraic field, with irrational numbers, cost anything
            norm = degree * self.field.mod.degree()
            self.known["norms"] = self.known.get("norms", 0) + norm
            if norm > LARGEST_NORM or self.known["norms"] > MOST_NORMS:
                raise _DeadEnd

    def adjoined(self, factor: PolyElement, place: int) -> Any:
        """Return an irrational root of ``factor``, and extend the number field by it.

        ``place`` is the index of the unknown of this polynomial.

        Raise _DeadEnd if that is impossible.
        """
        degree = factor.degrees()[place]
        numbers = [
            _as_rational(factor.coeff(self.ring.gens[place] ** n if n else 1), self.field) for n in range(degree + 1)
        ]
        if None in numbers or degree * (self.field.mod.degree() if self.roots else 1) > LARGEST_EXTENSION:
            raise _DeadEnd
        key = tuple(numbers)
        if key not in self.known:
            self.known[key] = Poly([QQ.to_sympy(c) for c in reversed(numbers)], Symbol("x")).real_roots()
        signs = (place in self.constraints.positive | self.constraints.nonnegative, place in self.constraints.negative)
        roots = [r for r in self.known[key] if not (signs[0] and r < 0) and not (signs[1] and r > 0)]
        # no real root has the sign of the unknown
        if not roots:
            raise _DeadEnd
        root = self.source.choice(roots)
        old, self.roots = self.field, [*self.roots, root]
        field = self.known.setdefault(("field", *self.roots), None) or QQ.algebraic_field(*self.roots)
        self.known["field", *self.roots] = field
        self.field, self.ring = field, self.ring.clone(domain=field)
        # the values of the other unknowns in the new field
        raised = {n: self.field.convert(value, old) for n, value in self.values.items()}
        self.values = raised
        self.zeros = [poly.set_ring(self.ring) for poly in self.zeros]
        self.solved = [(n, above.set_ring(self.ring), below.set_ring(self.ring)) for n, above, below in self.solved]
        return field.unit if len(self.roots) == 1 else field.from_sympy(root)


def _as_rational(value: Any, field: Any) -> Any:
    """Return an element of a field as a rational number; None if it is irrational."""
    if field == QQ:
        return value
    coefficients = value.to_list() if value else [QQ(0)]
    return coefficients[0] if len(coefficients) == 1 else None


def _eliminated(poly: PolyElement, place: int, above: PolyElement, below: PolyElement) -> PolyElement:
    """Return a polynomial with ``above/below`` for an unknown, times the power of ``below`` that clears its
    divisors.
    """
    degree = poly.degrees()[place]
    if not degree:
        return poly
    if len(above) ** degree * len(poly) > 20 * MOST_TERMS:
        raise _DeadEnd
    parts: dict[int, dict[tuple[int, ...], Any]] = {}
    for mono, coefficient in poly.items():
        parts.setdefault(mono[place], {})[(*mono[:place], 0, *mono[place + 1 :])] = coefficient
    total = poly.ring.zero
    for power, terms in sorted(parts.items()):
        total = total + poly.new(terms) * above**power * below ** (degree - power)
    return total


_Step = Callable[[_Drawing], bool]
_FIRST: Sequence[_Step] = (_Drawing.factor, _Drawing.univariate, _Drawing.substitution)
_ORDERS: tuple[Sequence[_Step], ...] = (
    (*_FIRST, _Drawing.quadric, _Drawing.fraction, _Drawing.guess),
    (*_FIRST, _Drawing.fraction, _Drawing.quadric, _Drawing.guess),
    (_Drawing.factor, _Drawing.univariate, _Drawing.quadric, _Drawing.substitution, _Drawing.guess),
    (_Drawing.factor, _Drawing.univariate, _Drawing.guess),
)
"""Lists of methods for solving the constraint equations. Each attempt to find a point chooses one list at random; then,
until no equation is left, it applies the first method of this list that can be applied. Most systems of equations can
be solved with at least one of the lists."""
