"""One attempt at the proof of a law: functions become generators of a ring, and what vanishes a sum of cofactors."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import gcd, isqrt
from typing import Any

from sympy import Abs, Expr, atan2, cos, pi, sin
from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix
from sympy.polys.rings import PolyElement, PolyRing

from symrot.errors import CertificateError
from symrot.kernels.definition import Law
from symrot.kernels.removable import explicit, select_ge

__all__ = ["Attempt", "CaseProof", "Choice", "Coarse", "Cofactors", "Entry", "Full", "Step", "Undecided"]

Quotient = tuple[PolyElement, PolyElement]  # numerator, denominator, in lowest terms
Cofactors = tuple[tuple[int, str], ...]  # number of a relation, polynomial; those that are zero left out
Choice = tuple[str, str, str]  # left, ">=" or "<", right
Step = tuple[Any, ...]  # kind, what it is about


@dataclass(frozen=True)
class Entry:
    """What vanishes, times ``factor``, is the sum of cofactor times relation."""

    factor: str
    cofactors: Cofactors


@dataclass(frozen=True)
class CaseProof:
    """The proof of a law in one case of its choices.

    ``steps`` are, in order, tuples that begin with their kind; x and y are expressions as text::

        ("name", symbol, x)             a generator, and what it stands for
        ("circle", x) ("root", x) ("sign", x)     a relation: of sine and cosine, of sqrt(x), of copysign(1, x)
        ("sum", x, y) ("odd", x) ("quarter", x)   sine and cosine of x + y, of -x, of x + pi/2
        ("arc", y, x) ("wrap", x)                 of atan2(y, x), of x brought to [-pi, pi]
        ("square", x, y, factor, cofactors)       sqrt(x) is y: (x - y^2) factor has these cofactors
    """

    case: tuple[Choice, ...]
    steps: tuple[Step, ...]
    relations: tuple[str, ...]
    entries: tuple[Entry, ...]


class Undecided(Exception):
    """A choice that the case at hand says nothing about: left, right."""


class Coarse(Exception):
    """An angle that is no whole multiple of its base angle: what it is a multiple of, the base that is needed."""


class Full(Exception):
    """More generators than the ring has room for."""


@dataclass
class Attempt:
    """One attempt at the proof of a law, in one case, over one ring."""

    name: str
    law: Law
    formulas: Mapping[str, Expr]
    ring: PolyRing
    bases: Mapping[str, Fraction]  # what an angle is a multiple of, as text -> least coefficient so far
    steps: dict[Step, None] = field(default_factory=dict)
    values: dict[Expr, Quotient] = field(default_factory=dict)
    hypotheses: list[PolyElement] = field(default_factory=list)
    rules: list[PolyElement] = field(default_factory=list)  # each leads with a power of a generator of its own
    roots: dict[Quotient, Quotient] = field(default_factory=dict)
    radicals: dict[PolyElement, PolyElement] = field(default_factory=dict)  # a radicand -> its root
    signs: dict[Quotient, PolyElement] = field(default_factory=dict)
    arcs: dict[tuple[Quotient, Quotient], PolyElement] = field(default_factory=dict)
    turns: dict[PolyElement, tuple[Quotient, Quotient]] = field(default_factory=dict)  # an angle -> cosine, sine
    found: dict[str, Fraction] = field(default_factory=dict)
    nonnegative: set[int] = field(default_factory=set)
    made: int = 0

    def __post_init__(self) -> None:
        self.known = dict(zip(map(str, self.ring.symbols), self.ring.gens, strict=True))
        self.pool = sum(name.endswith("_") and name[0] == "g" and name[1:-1].isdigit() for name in self.known)

    def run(self, decided: Sequence[Choice]) -> CaseProof:
        """Return the proof; ``CertificateError`` for an entry that is no combination of the relations."""
        self.decided = {(left, right): relation for left, relation, right in decided}
        given = [self.value(relation) for relation in self.law.relations]
        if any(below != 1 for _, below in given):
            raise CertificateError(f"{self.name}: expected polynomials as hypotheses of {self.law.text!r}")
        self.hypotheses = [above for above, _ in given]
        fractions = [self.value(entry) for entry in self.law.vanishing]
        entries = []
        for above, below in fractions:
            cofactors = self.cofactors(above)
            if cofactors is None:
                raise CertificateError(f"{self.name}: expected the law {self.law.text!r} to follow, and it does not")
            entries.append(Entry(str(below), cofactors))
        relations = tuple(map(str, (*self.hypotheses, *self.rules)))
        return CaseProof(tuple(decided), tuple(self.steps), relations, tuple(entries))

    def step(self, *step: Any) -> None:
        """Write down a fact that is used from here on."""
        self.steps.setdefault(step)

    # --- fractions ----------------------------------------------------------------------------------------------------

    def lowest(self, above: PolyElement, below: PolyElement) -> Quotient:
        """Return a fraction in lowest terms, the denominator led by 1."""
        if not below:
            raise CertificateError(f"{self.name}: expected a law that is defined somewhere, got a division by zero")
        if not below.is_ground:
            above, below = above.cancel(below)
        lead = below.LC
        return (above, below) if lead == 1 else (above.quo_ground(lead), below.quo_ground(lead))

    def add(self, a: Quotient, b: Quotient) -> Quotient:
        """Return a + b."""
        if a[1] == b[1]:
            return self.lowest(a[0] + b[0], a[1])
        return self.lowest(a[0] * b[1] + b[0] * a[1], a[1] * b[1])

    def multiply(self, a: Quotient, b: Quotient) -> Quotient:
        """Return a b."""
        return self.lowest(a[0] * b[0], a[1] * b[1])

    def power(self, a: Quotient, exponent: int) -> Quotient:
        """Return a power, also a negative one."""
        above, below = a if exponent > 0 else (a[1], a[0])
        return self.lowest(above ** abs(exponent), below ** abs(exponent))

    def number(self, value: Fraction | int) -> Quotient:
        """Return a rational number as a fraction of the ring."""
        value = Fraction(value)
        return self.ring.ground_new(QQ(value.numerator, value.denominator)), self.ring.one

    # --- expressions --------------------------------------------------------------------------------------------------

    def value(self, expr: Expr) -> Quotient:
        """Return an expression as a fraction; outputs are replaced by their formulas."""
        if expr not in self.values:
            self.values[expr] = self._value(expr)
        return self.values[expr]

    def _value(self, expr: Expr) -> Quotient:
        if expr.is_Rational:
            return self.number(Fraction(int(expr.p), int(expr.q)))
        if expr.is_Symbol or expr is pi:
            name = str(expr)
            return self.value(self.formulas[name]) if name in self.formulas else (self.known[name], self.ring.one)
        if expr.is_Add or expr.is_Mul:
            combine = self.add if expr.is_Add else self.multiply
            first, *rest = map(self.value, expr.args)
            for value in rest:
                first = combine(first, value)
            return first
        if expr.is_Pow and (2 * expr.exp).is_Integer:
            base = self.value(expr.base)
            whole = expr.exp.is_Integer
            return self.power(base if whole else self.root(base), int(expr.exp if whole else 2 * expr.exp))
        return self._function(expr)

    def _function(self, expr: Expr) -> Quotient:
        name = "abs" if isinstance(expr, Abs) else expr.func.__name__
        if isinstance(expr, (cos, sin)):
            return self.turned(self.angle(expr.args[0]))[isinstance(expr, sin)]
        if isinstance(expr, atan2):
            return self.arc(self.value(expr.args[0]), self.value(expr.args[1])), self.ring.one
        if name == "abs":
            value = self.value(expr.args[0])
            return self.multiply((self.sign(value), self.ring.one), value)
        if name == "copysign" and expr.args[0] == 1:
            return self.sign(self.value(expr.args[1])), self.ring.one
        if name == "select_ge":
            return self.value(expr.args[2 if self.is_taken(expr) else 3])
        plain = explicit(expr)
        if plain == expr:
            raise CertificateError(f"{self.name}: expected functions of kernels in a law, got {name}")
        return self.value(plain)

    def is_taken(self, choice: Expr) -> bool:
        """Tell whether the case at hand takes the first branch of a choice."""
        left, right = (_text(self.value(argument)) for argument in choice.args[:2])
        if (left, right) not in self.decided:
            raise Undecided(left, right)
        return self.decided[left, right] == ">="

    def generator(self, meaning: str) -> PolyElement:
        """Return a new generator, and write down what it stands for; ``Full`` where the ring has none left."""
        if self.made == self.pool:
            raise Full
        self.made += 1
        name = f"g{self.made - 1}_"
        self.step("name", name, meaning)
        return self.known[name]

    def root(self, square: Quotient) -> Quotient:
        """Return the square root of a fraction: of its rest by the relations, a product if that is a square."""
        if square not in self.roots:
            above, below = self.lowest(self.rest(square[0]), self.rest(square[1]))
            if not self.is_nonnegative(below):
                raise CertificateError(f"{self.name}: expected a root over a sum of squares, got one over {below}")
            value = self.roots[square] = self.lowest(self.radical(above * below), below)
            if square != (above * below, below) or value[0] in self.radicals:
                factor = square[1] * value[1] ** 2
                cofactors = self.cofactors(square[0] * value[1] ** 2 - value[0] ** 2 * square[1])
                if cofactors is None:
                    raise CertificateError(f"{self.name}: expected the square of a root to be what it is the root of")
                self.step("square", _text(square), _text(value), str(factor), cofactors)
        return self.roots[square]

    def radical(self, inside: PolyElement) -> PolyElement:
        """Return the square root of a polynomial: a polynomial where it is a perfect square, else a generator."""
        if inside not in self.radicals:
            found = self.perfect(inside)
            if found is None:
                found = self.generator(f"sqrt({inside})")
                self.step("root", str(inside))
                self.rules.append(found**2 - inside)
                self.nonnegative.add(self.ring.gens.index(found))
            self.radicals[inside] = found
        return self.radicals[inside]

    def perfect(self, inside: PolyElement) -> PolyElement | None:
        """Return the root of the square of something that is not negative; None for anything else."""
        content, factors = inside.factor_list()
        roots = [isqrt(abs(int(number))) for number in (content.numerator, content.denominator)]
        if content < 0 or roots[0] ** 2 != content.numerator or roots[1] ** 2 != content.denominator:
            return None
        value = self.ring.ground_new(QQ(*roots))
        for base, power in factors:
            if power % 2 or (power % 4 and not self.is_nonnegative(base)):
                return None
            value *= base ** (power // 2)
        return value

    def is_nonnegative(self, value: PolyElement) -> bool:
        """Tell whether a polynomial is a sum of even powers, or of generators that are not negative."""
        return all(
            coefficient > 0 and all(not n % 2 or place in self.nonnegative for place, n in enumerate(monomial))
            for monomial, coefficient in value.items()
        )

    def sign(self, value: Quotient) -> PolyElement:
        """Return the generator of the sign of a value: 1 or -1, which times the value is its absolute value."""
        if value not in self.signs:
            made = self.signs[value] = self.generator(f"copysign(1, {_text(value)})")
            self.step("sign", _text(value))
            self.rules.append(made**2 - 1)
        return self.signs[value]

    def arc(self, y: Quotient, x: Quotient) -> PolyElement:
        """Return the generator of ``atan2(y, x)``, with its cosine and sine."""
        if (y, x) not in self.arcs:
            radius = self.root(self.add(self.power(x, 2), self.power(y, 2)))
            made = self.arcs[y, x] = self.generator(f"atan2({_text(y)}, {_text(x)})")
            self.step("arc", _text(y), _text(x))
            inverse = self.power(radius, -1)
            self.turns[made] = self.multiply(x, inverse), self.multiply(y, inverse)
            if self.is_nonnegative(y[0]) and self.is_nonnegative(y[1]):
                self.nonnegative.add(self.ring.gens.index(made))
        return self.arcs[y, x]

    # --- angles -------------------------------------------------------------------------------------------------------

    def angle(self, expr: Expr) -> Quotient:
        """Return an angle, up to whole turns: one that is brought to [-pi, pi] is what it was before."""
        while str(expr) in self.formulas and expr.is_Symbol:
            expr = self.formulas[str(expr)]
        if isinstance(expr, select_ge) and isinstance(expr.args[2], select_ge):
            inner = expr.args[1]
            lifted = select_ge(inner, -pi, inner, inner + 2 * pi)
            if expr == select_ge(pi, inner, lifted, inner - 2 * pi):
                angle = self.value(inner)
                self.turned(angle)
                self.step("wrap", _text(angle))
                return angle
        return self.value(expr)

    def turned(self, angle: Quotient) -> tuple[Quotient, Quotient]:
        """Return cosine and sine of a sum of multiples of base angles and right angles."""
        above, below = angle
        if below != 1:
            raise CertificateError(f"{self.name}: expected a sum of angles under a sine, got {_text(angle)}")
        right_angles, so_far, turn = Fraction(0), self.ring.zero, (self.number(1), self.number(0))
        for monomial, coefficient in above.terms():
            unit, times = (
                self.ring({monomial: QQ(1)}),
                Fraction(int(coefficient.numerator), int(coefficient.denominator)),
            )
            if unit == 1:
                raise CertificateError(f"{self.name}: expected no radians beside angles under a sine, got {above}")
            if unit == self.known["pi"]:
                right_angles = 2 * times
                continue
            found = self._multiple(unit, times)
            if so_far:
                self.step("sum", str(so_far), str(coefficient * unit))
            so_far, turn = so_far + coefficient * unit, self._rotated(turn, found)
        if right_angles.denominator != 1:
            raise CertificateError(f"{self.name}: expected right angles beside angles under a sine, got {above}")
        for _ in range(abs(int(right_angles))):
            step = 1 if right_angles > 0 else -1
            self.step("quarter" if step > 0 else "quarter back", str(so_far))
            so_far, turn = (
                so_far + self.known["pi"] * QQ(step, 2),
                self._rotated(turn, (self.number(0), self.number(step))),
            )
        return turn

    def _rotated(self, a: tuple[Quotient, Quotient], b: tuple[Quotient, Quotient]) -> tuple[Quotient, Quotient]:
        def negative(value: Quotient) -> Quotient:
            return -value[0], value[1]

        return (
            self.add(self.multiply(a[0], b[0]), negative(self.multiply(a[1], b[1]))),
            self.add(self.multiply(a[1], b[0]), self.multiply(a[0], b[1])),
        )

    def _multiple(self, unit: PolyElement, coefficient: Fraction) -> tuple[Quotient, Quotient]:
        base = self._base(unit, coefficient)
        first = unit * QQ(base.numerator, base.denominator)
        result = turn = self._pair(unit, first)
        times = int(coefficient / base)
        for k in range(1, abs(times)):
            self.step("sum", str(k * first), str(first))
            result = self._rotated(result, turn)
        if times < 0:
            self.step("odd", str(-times * first))
        return result if times > 0 else (result[0], (-result[1][0], result[1][1]))

    def _base(self, unit: PolyElement, coefficient: Fraction) -> Fraction:
        if unit in self.turns and unit in self.arcs.values():
            if coefficient.denominator != 1:
                raise CertificateError(f"{self.name}: expected whole multiples of an arc tangent under a sine")
            return Fraction(1)
        known = self.bases.get(str(unit), self.found.setdefault(str(unit), abs(coefficient)))
        if (coefficient / known).denominator != 1:
            finer = Fraction(
                gcd(known.numerator * coefficient.denominator, coefficient.numerator * known.denominator),
                known.denominator * coefficient.denominator,
            )
            raise Coarse(str(unit), finer)
        return known

    def _pair(self, unit: PolyElement, angle: PolyElement) -> tuple[Quotient, Quotient]:
        if unit not in self.turns:
            cosine, sine = self.generator(f"cos({angle})"), self.generator(f"sin({angle})")
            self.step("circle", str(angle))
            self.rules.append(sine**2 + cosine**2 - 1)
            self.turns[unit] = (cosine, self.ring.one), (sine, self.ring.one)
        return self.turns[unit]

    # --- cofactors ----------------------------------------------------------------------------------------------------

    def rest(self, value: PolyElement) -> PolyElement:
        """Return what the rules, and a hypothesis that stands alone, leave of a polynomial."""
        basis = [*self.rules, *(self.hypotheses if len(self.hypotheses) == 1 else ())]
        return value.rem(basis) if basis else value

    def cofactors(self, value: PolyElement) -> Cofactors | None:
        """Return the cofactors of the relations whose sum of products is a polynomial; None if none are found.

        The rules lead with powers of different generators: they are divided by. Where dividing by the hypotheses as
        well leaves a rest, constants and then linear polynomials are tried as their cofactors, by linear algebra.
        """
        if not value:
            return ()
        count, basis = len(self.rules), [*self.rules, *self.hypotheses]
        found, rest = value.div(basis) if basis else ([], value)
        attempts: list[Callable[[], Any]] = [lambda degree=degree: self._combined(value, degree) for degree in (0, 1)]  # type: ignore[misc]
        while rest and attempts and len(self.hypotheses) > 1:
            found, rest = attempts.pop(0)()
        if rest:
            return None
        by_relation = [*found[count:], *found[:count]]  # hypotheses first: their numbers stay while rules are added
        return tuple((place, str(cofactor)) for place, cofactor in enumerate(by_relation) if cofactor)

    def _combined(self, value: PolyElement, degree: int) -> tuple[list[PolyElement], PolyElement]:
        by_rules, rest = value.div(self.rules) if self.rules else ([], value)
        found = _combination(rest, self.hypotheses, degree)
        return (list(by_rules), rest) if found is None else ([*by_rules, *found], self.ring.zero)


def _text(value: Quotient) -> str:
    above, below = value
    return str(above) if below == 1 else f"({above})/({below})"


def _combination(polynomial: PolyElement, relations: Sequence[PolyElement], degree: int) -> list[PolyElement] | None:
    """Return polynomials of a degree whose products with relations add up to a polynomial, or None."""
    ring = polynomial.ring
    occurring = {
        place for p in (polynomial, *relations) for monomial in p for place, power in enumerate(monomial) if power
    }
    factors = [ring.one, *(ring.gens[place] for place in sorted(occurring))] if degree else [ring.one]
    products = [(k, factor, relation * factor) for k, relation in enumerate(relations) for factor in factors]
    rows = sorted({monomial for p in (polynomial, *(product for *_, product in products)) for monomial in p})
    row_of = {monomial: row for row, monomial in enumerate(rows)}
    entries: dict[int, dict[int, Any]] = {row: {} for row in range(len(rows))}
    for column, (*_, product) in enumerate(products):
        for monomial, coefficient in product.items():
            entries[row_of[monomial]][column] = coefficient
    for monomial, coefficient in polynomial.items():
        entries[row_of[monomial]][len(products)] = coefficient
    reduced, pivots = DomainMatrix(entries, (len(rows), len(products) + 1), QQ).rref()
    if len(products) in pivots:
        return None
    found = [ring.zero] * len(relations)
    for row, column in enumerate(pivots):
        k, factor, _ = products[column]
        found[k] += factor * reduced[row, len(products)].element
    return found
