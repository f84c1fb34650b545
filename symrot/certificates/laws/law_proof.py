"""One attempt to prove a law: the numerator of each expression stated to be zero is a sum of cofactors times relations.

A relation is a polynomial known to be zero. A generator is a variable for a function value such as ``cos(x)``. A base
angle is an angle, such as x/2, whose sine and cosine are generators; all other angles in the formulas are sums of
integer multiples of base angles and of pi/2. A case is a list of assumptions that selects one branch of each
conditional in the formulas.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import gcd, isqrt
from typing import Any

from sympy import Abs, Expr, atan2, cos, pi, sin
from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix
from sympy.polys.rings import PolyElement, PolyRing

from symrot.certificates.laws.fractions import FormulaReader, FractionField, Quotient, quotient_text
from symrot.errors import CertificateError
from symrot.kernels.definition import Law
from symrot.kernels.removable import explicit, select_ge

__all__ = [
    "BaseAngleTooLarge",
    "CaseProof",
    "Choice",
    "Cofactors",
    "EntryProof",
    "LawProver",
    "OutOfGenerators",
    "ProofStep",
    "UndecidedChoice",
]

Cofactors = tuple[tuple[int, str], ...]  # (index of a relation, its cofactor); zero cofactors are left out
Choice = tuple[str, str, str]  # left side, ">=" or "<", right side
ProofStep = tuple[Any, ...]  # kind, arguments


# Every angle must be a sum of integer multiples of base angles and of pi/2.
@dataclass(frozen=True)
class EntryProof:
    """The proof that an expression is zero: expression times ``factor`` = sum of ``cofactors`` times relations."""

    factor: str
    cofactors: Cofactors


@dataclass(frozen=True)
class CaseProof:
    """The proof of a law in one case: for one selection of the branches of all conditionals in the formulas."""

    case: tuple[Choice, ...]
    # the facts that the proof uses, in order; x and y are expressions as text:
    #     ("name", symbol, x)                       the generator ``symbol`` stands for the function value x
    #     ("circle", x) ("root", x) ("sign", x)     sin(x)^2 + cos(x)^2 = 1; sqrt(x)^2 = x; copysign(1, x)^2 = 1
    #     ("sum", x, y) ("odd", x) ("quarter", x)   sine and cosine of x + y; of -x; of x + pi/2
    #     ("quarter back", x)                       sine and cosine of x - pi/2
    #     ("arc", y, x) ("wrap", x)                 sine and cosine of atan2(y, x); of x wrapped to [-pi, pi]
    #     ("square", x, y, factor, cofactors)       sqrt(x) is y: (x - y^2)*factor = sum of cofactors times relations;
    #                                               y is never negative
    steps: tuple[ProofStep, ...]
    # polynomials that are zero
    relations: tuple[str, ...]
    # one proof for each expression that the law states to be zero
    entries: tuple[EntryProof, ...]


class UndecidedChoice(Exception):
    """Raised for a conditional whose branch the current case does not choose, with the two compared values as text."""


class BaseAngleTooLarge(Exception):
    """Raised for an angle, such as x/2, that is no integer multiple of its base angle, such as x."""


class OutOfGenerators(Exception):
    """Raised if a proof needs more variables for values such as sin(x) ("generators") than the polynomial ring has."""


@dataclass
class LawProver(FormulaReader):
    """One attempt to prove a law, for one selection of the branches of all conditionals in its formulas."""

    name: str
    law: Law
    formulas: Mapping[str, Expr]
    # has a variable for each input, and a limited number of generators
    ring: PolyRing
    bases: Mapping[str, Fraction]  # monomial of an angle, as text -> coefficient of its base angle
    steps: dict[ProofStep, None] = field(default_factory=dict)
    values: dict[Expr, Quotient] = field(default_factory=dict)
    hypotheses: list[PolyElement] = field(default_factory=list)
    rules: list[PolyElement] = field(
        default_factory=list
    )  # relations between generators; no two have the same leading generator
    roots: dict[Quotient, Quotient] = field(default_factory=dict)
    radicals: dict[PolyElement, PolyElement] = field(default_factory=dict)  # a radicand -> its root
    signs: dict[Quotient, PolyElement] = field(default_factory=dict)
    arcs: dict[tuple[Quotient, Quotient], PolyElement] = field(default_factory=dict)
    angle_functions: dict[PolyElement, tuple[Quotient, Quotient]] = field(
        default_factory=dict
    )  # an angle -> cosine, sine
    first_coefficients: dict[str, Fraction] = field(default_factory=dict)  # monomial, not in ``bases`` -> coefficient
    nonnegative: set[int] = field(default_factory=set)  # numbers of the generators whose values are not negative
    generator_count: int = 0

    def __post_init__(self) -> None:
        self.fractions = FractionField(self.ring, self.name)
        generators = self.fractions.generators
        self.pool = sum(name.endswith("_") and name[0] == "g" and name[1:-1].isdigit() for name in generators)

    def run(self, decided: Sequence[Choice]) -> CaseProof:
        """Return the proof of one case; ``decided`` lists its conditions as (left, relation, right) in text form.

        UndecidedChoice is raised for a conditional that is not in the list, CertificateError if the proof fails.
        """
        self.decided = {(left, right): relation for left, relation, right in decided}
        hypotheses = [self.read(relation) for relation in self.law.relations]
        divisors = [below for _, below in hypotheses if below != 1]
        if divisors:
            raise CertificateError(
                f"{self.name}: expected hypotheses without divisions in the law {self.law.text!r}, got a division by "
                f"{divisors[0]}; multiply the hypothesis by it"
            )
        self.hypotheses = [above for above, _ in hypotheses]
        fractions = [self.read(entry) for entry in self.law.vanishing]
        entries = []
        for above, below in fractions:
            cofactors = self.cofactors(above)
            if cofactors is None:
                raise CertificateError(
                    f"{self.name}: expected the law {self.law.text!r} to follow from the formulas, but it does not"
                )
            entries.append(EntryProof(str(below), cofactors))
        relations = tuple(map(str, (*self.hypotheses, *self.rules)))
        return CaseProof(tuple(decided), tuple(self.steps), relations, tuple(entries))

    def step(self, *step: Any) -> None:
        """Add a step to the proof, such as ``("circle", "x")``; :class:`CaseProof` lists the kinds of steps."""
        self.steps.setdefault(step)

    # --- expressions --------------------------------------------------------------------------------------------------

    def symbol(self, name: str) -> Quotient:
        """Return a symbol as a fraction over the ring: its formula if it has one, else the variable of its name."""
        return self.read(self.formulas[name]) if name in self.formulas else self.fractions.generator(name)

    def function(self, expr: Expr) -> Quotient:
        """Return a function call, such as ``sin(x)``, as a fraction over the ring, and record the identities used."""
        name = "abs" if isinstance(expr, Abs) else expr.func.__name__
        if isinstance(expr, (cos, sin)):
            return self.cosine_and_sine(self.angle(expr.args[0]))[isinstance(expr, sin)]
        if isinstance(expr, atan2):
            return self.arc(self.read(expr.args[0]), self.read(expr.args[1])), self.ring.one
        if name == "abs":
            value = self.read(expr.args[0])
            return self.fractions.multiply((self.sign(value), self.ring.one), value)
        if name == "copysign" and expr.args[0] == 1:
            return self.sign(self.read(expr.args[1])), self.ring.one
        if name == "select_ge":
            return self.read(expr.args[2 if self.takes_first_branch(expr) else 3])
        plain = explicit(expr)
        if plain == expr:
            raise CertificateError(
                f"{self.name}: expected functions that kernels use, such as sin, in a law, got {name}"
            )
        return self.read(plain)

    def takes_first_branch(self, choice: Expr) -> bool:
        """Return whether the first branch of the conditional ``choice`` applies in the case that is being proven.

        The case is a list of assumptions about the conditionals, ``left >= right`` or ``left < right``.
        UndecidedChoice is raised if the list contains no assumption about this conditional.
        """
        left, right = (quotient_text(self.read(argument)) for argument in choice.args[:2])
        if (left, right) not in self.decided:
            raise UndecidedChoice(left, right)
        return self.decided[left, right] == ">="

    def generator(self, meaning: str) -> PolyElement:
        """Return an unused variable of the ring for a function value; ``meaning`` is its text, such as ``"sin(x)"``.

        OutOfGenerators is raised if no unused variable is left.
        """
        if self.generator_count == self.pool:
            raise OutOfGenerators
        self.generator_count += 1
        name = f"g{self.generator_count - 1}_"
        self.step("name", name, meaning)
        return self.fractions.generators[name]

    def root(self, square: Quotient) -> Quotient:
        """Return the square root of the fraction ``square``."""
        if square not in self.roots:
            # the remainder after division by the relations: with it, 1 - sin(x)^2 is seen to be a perfect square
            above, below = self.fractions.lowest(self.remainder(square[0]), self.remainder(square[1]))
            if not self.is_nonnegative(below):
                raise CertificateError(
                    f"{self.name}: expected a sum of squares as the denominator of the fraction under a square root, "
                    f"got {below}"
                )
            value = self.roots[square] = self.fractions.lowest(self.radical(above * below), below)
            if square != (above * below, below) or value[0] in self.radicals:
                factor = square[1] * value[1] ** 2
                cofactors = self.cofactors(square[0] * value[1] ** 2 - value[0] ** 2 * square[1])
                if cofactors is None:
                    raise CertificateError(
                        f"{self.name}: expected the square of a root to equal its radicand, but it differs"
                    )
                self.step("square", quotient_text(square), quotient_text(value), str(factor), cofactors)
        return self.roots[square]

    def radical(self, inside: PolyElement) -> PolyElement:
        """Return the square root of a polynomial: a polynomial if it is a square, else a new variable for the root."""
        if inside not in self.radicals:
            root = self.perfect(inside)
            if root is None:
                root = self.generator(f"sqrt({inside})")
                self.step("root", str(inside))
                self.rules.append(root**2 - inside)
                self.nonnegative.add(self.ring.gens.index(root))
            self.radicals[inside] = root
        return self.radicals[inside]

    def perfect(self, inside: PolyElement) -> PolyElement | None:
        """Return the square root of the polynomial ``inside`` if it is a polynomial and never negative, else None."""
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
        """Return whether a polynomial is certainly not negative, because none of its terms can be negative."""
        # a term: a positive number times even powers and generators that are not negative
        return all(
            coefficient > 0 and all(not n % 2 or place in self.nonnegative for place, n in enumerate(monomial))
            for monomial, coefficient in value.items()
        )

    def sign(self, value: Quotient) -> PolyElement:
        """Return the variable of the ring that stands for the sign of a value, 1 or -1."""
        if value not in self.signs:
            generator = self.signs[value] = self.generator(f"copysign(1, {quotient_text(value)})")
            self.step("sign", quotient_text(value))
            # sign times value is the absolute value
            self.rules.append(generator**2 - 1)
        return self.signs[value]

    def arc(self, y: Quotient, x: Quotient) -> PolyElement:
        """Return the generator, a variable of the polynomials, for ``atan2(y, x)``; record its cosine and sine."""
        if (y, x) not in self.arcs:
            radius = self.root(self.fractions.add(self.fractions.power(x, 2), self.fractions.power(y, 2)))
            generator = self.arcs[y, x] = self.generator(f"atan2({quotient_text(y)}, {quotient_text(x)})")
            self.step("arc", quotient_text(y), quotient_text(x))
            inverse = self.fractions.power(radius, -1)
            self.angle_functions[generator] = self.fractions.multiply(x, inverse), self.fractions.multiply(y, inverse)
            if self.is_nonnegative(y[0]) and self.is_nonnegative(y[1]):
                self.nonnegative.add(self.ring.gens.index(generator))
        return self.arcs[y, x]

    # --- angles -------------------------------------------------------------------------------------------------------

    def angle(self, expr: Expr) -> Quotient:
        """Return an angle as a fraction of polynomials, up to multiples of 2 pi.

        The variables of the polynomials are the inputs, pi, and generators for function values such as
        ``atan2(y, x)``. For an angle that a formula wraps to [-pi, pi], the result is the angle before wrapping.
        """
        while str(expr) in self.formulas and expr.is_Symbol:
            expr = self.formulas[str(expr)]
        if isinstance(expr, select_ge) and isinstance(expr.args[2], select_ge):
            inner = expr.args[1]
            lifted = select_ge(inner, -pi, inner, inner + 2 * pi)
            if expr == select_ge(pi, inner, lifted, inner - 2 * pi):
                angle = self.read(inner)
                self.cosine_and_sine(angle)
                self.step("wrap", quotient_text(angle))
                return angle
        return self.read(expr)

    def cosine_and_sine(self, angle: Quotient) -> tuple[Quotient, Quotient]:
        """Return the pair (cosine, sine) of an angle, each a fraction of polynomials.

        The variables of the polynomials are the inputs and generators, which stand for function values such as
        cos(x/2).
        """
        above, below = angle
        if below != 1:
            raise CertificateError(
                f"{self.name}: expected a sum of angles as the argument of a sine or cosine, got {quotient_text(angle)}"
            )
        right_angles, angle_so_far, result = (
            Fraction(0),
            self.ring.zero,
            (self.fractions.number(1), self.fractions.number(0)),
        )
        # the angle must be a sum of integer multiples of base angles and of pi/2
        for monomial, coefficient in above.terms():
            unit, multiple = (
                self.ring({monomial: QQ(1)}),
                Fraction(int(coefficient.numerator), int(coefficient.denominator)),
            )
            if unit == 1:
                raise CertificateError(
                    f"{self.name}: expected a sum of angles and of multiples of pi as the argument of a sine or "
                    f"cosine, got {above}"
                )
            if unit == self.fractions.generators["pi"]:
                right_angles = 2 * multiple
                continue
            pair = self._multiple(unit, multiple)
            if angle_so_far:
                self.step("sum", str(angle_so_far), str(coefficient * unit))
            angle_so_far, result = angle_so_far + coefficient * unit, self._sum_of_angles(result, pair)
        if right_angles.denominator != 1:
            raise CertificateError(
                f"{self.name}: expected a sum of angles and of integer multiples of pi/2 as the argument of a sine "
                f"or cosine, got {above}"
            )
        for _ in range(abs(int(right_angles))):
            direction = 1 if right_angles > 0 else -1
            self.step("quarter" if direction > 0 else "quarter back", str(angle_so_far))
            angle_so_far, result = (
                angle_so_far + self.fractions.generators["pi"] * QQ(direction, 2),
                self._sum_of_angles(result, (self.fractions.number(0), self.fractions.number(direction))),
            )
        return result

    def _sum_of_angles(self, a: tuple[Quotient, Quotient], b: tuple[Quotient, Quotient]) -> tuple[Quotient, Quotient]:
        """Return the (cosine, sine) of the sum of two angles from the (cosine, sine) of each."""
        add, subtract, multiply = self.fractions.add, self.fractions.subtract, self.fractions.multiply
        cosine = subtract(multiply(a[0], b[0]), multiply(a[1], b[1]))
        return cosine, add(multiply(a[1], b[0]), multiply(a[0], b[1]))

    def _multiple(self, unit: PolyElement, coefficient: Fraction) -> tuple[Quotient, Quotient]:
        """Return the pair (cosine, sine) of the angle ``coefficient*unit``, each a fraction of polynomials.

        ``unit`` is a monomial, such as x. The angle must be an integer multiple of the base angle of ``unit``, such as
        x/2, which :meth:`_base` gives.
        """
        base = self._base(unit, coefficient)
        first = unit * QQ(base.numerator, base.denominator)
        result = pair = self._pair(unit, first)
        times = int(coefficient / base)
        for k in range(1, abs(times)):
            self.step("sum", str(k * first), str(first))
            result = self._sum_of_angles(result, pair)
        if times < 0:
            self.step("odd", str(-times * first))
        return result if times > 0 else (result[0], (-result[1][0], result[1][1]))

    def _base(self, unit: PolyElement, coefficient: Fraction) -> Fraction:
        """Return b such that the angles of the law are integer multiples of ``b*unit``, the base angle of ``unit``.

        ``unit`` is a monomial. For ``unit`` = x, b is 1/2 if the law contains x/2 and x. BaseAngleTooLarge is raised if
        ``coefficient*unit`` is no integer multiple of the base angle that was assumed so far.
        """
        if unit in self.angle_functions and unit in self.arcs.values():
            if coefficient.denominator != 1:
                raise CertificateError(
                    f"{self.name}: expected integer multiples of an arc tangent as the argument of a "
                    "sine or cosine, got a fraction of an arc tangent"
                )
            return Fraction(1)
        known = self.bases.get(str(unit), self.first_coefficients.setdefault(str(unit), abs(coefficient)))
        if (coefficient / known).denominator != 1:
            finer = Fraction(
                gcd(known.numerator * coefficient.denominator, coefficient.numerator * known.denominator),
                known.denominator * coefficient.denominator,
            )
            # ``coefficient*unit`` is no integer multiple of the base angle, but of ``finer*unit``
            raise BaseAngleTooLarge(str(unit), finer)
        return known

    def _pair(self, unit: PolyElement, angle: PolyElement) -> tuple[Quotient, Quotient]:
        """Return the pair (cosine, sine) of a base angle, each a fraction of polynomials.

        ``unit`` is a monomial, such as x. ``angle`` is its base angle, such as x/2: all multiples of ``unit`` in the
        formulas are integer multiples of this angle. The first call for ``unit`` makes two new generators, variables of
        the polynomials; later calls return the same pair. For an arc tangent, cosine and sine are the fractions found
        by :meth:`arc`.
        """
        if unit not in self.angle_functions:
            cosine, sine = self.generator(f"cos({angle})"), self.generator(f"sin({angle})")
            self.step("circle", str(angle))
            self.rules.append(sine**2 + cosine**2 - 1)
            self.angle_functions[unit] = (cosine, self.ring.one), (sine, self.ring.one)
        return self.angle_functions[unit]

    # --- cofactors ----------------------------------------------------------------------------------------------------

    def remainder(self, value: PolyElement) -> PolyElement:
        """Return the remainder of a polynomial after division by the relations; if it is 0, the polynomial is 0."""
        # several hypotheses are left to :meth:`cofactors`
        basis = [*self.rules, *(self.hypotheses if len(self.hypotheses) == 1 else ())]
        return value.rem(basis) if basis else value

    def cofactors(self, value: PolyElement) -> Cofactors | None:
        """Return pairs (k, cofactor of relation k) such that the sum of cofactors times relations is ``value``.

        The result is None if no such cofactors are found.
        """
        if not value:
            return ()
        count, basis = len(self.rules), [*self.rules, *self.hypotheses]
        # without hypotheses the division finds cofactors if there are any: the leading generators of the relations
        # differ
        quotients, remainder = value.div(basis) if basis else ([], value)
        # constants, then linear polynomials, as cofactors of several hypotheses
        attempts: list[Callable[[], Any]] = [lambda degree=degree: self._combined(value, degree) for degree in (0, 1)]  # type: ignore[misc]
        while remainder and attempts and len(self.hypotheses) > 1:
            quotients, remainder = attempts.pop(0)()
        if remainder:
            return None
        by_relation = [*quotients[count:], *quotients[:count]]  # hypotheses first: their numbers do not change
        return tuple((place, str(cofactor)) for place, cofactor in enumerate(by_relation) if cofactor)

    def _combined(self, value: PolyElement, degree: int) -> tuple[list[PolyElement], PolyElement]:
        """Return (cofactors, rest) such that ``value`` is the sum of cofactors times relations, plus the rest.

        There are two kinds of relations: first the rules, which hold between generators, such as sin^2 + cos^2 = 1;
        then the hypotheses of the law, such as the unit norm of a quaternion. The cofactor of a hypothesis has at most
        the degree ``degree``; the cofactor of a rule may have any degree.
        """
        by_rules, remainder = value.div(self.rules) if self.rules else ([], value)
        # without cofactors of that degree the rest is not zero
        by_hypotheses = _combination(remainder, self.hypotheses, degree)
        return (list(by_rules), remainder) if by_hypotheses is None else ([*by_rules, *by_hypotheses], self.ring.zero)


def _combination(polynomial: PolyElement, relations: Sequence[PolyElement], degree: int) -> list[PolyElement] | None:
    """Return cofactors of at most ``degree`` whose products with ``relations`` sum to ``polynomial``, or None."""
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
    combination = [ring.zero] * len(relations)
    for row, column in enumerate(pivots):
        k, factor, _ = products[column]
        combination[k] += factor * reduced[row, len(products)].element
    return combination
