"""Auxiliary states ("companions") for Taylor series: functions of the attitude that are integrated like states.

The components of a fixed direction seen from the body, ``gamma = R(q)^T e``, contain products of q0..q3, which take
convolutions. But ``gamma' = gamma x omega``, so gamma can be integrated like a state. At the start of every step it is
computed from the attitude, so that it cannot drift.
"""

from collections.abc import Iterable
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.codegen.taylor.linear_forms import ONE
from symrot.codegen.taylor.recurrences import Recurrences, Series
from symrot.formula.polynomial import Monomial, Polynomial, constant, generator, products_of_monomials
from symrot.formula.tree import Node, children

__all__ = ["with_companions"]

QUATERNION = ("q0", "q1", "q2", "q3")
MOST_COMPANIONS, MOST_TERMS = 9, 200  # nine are the companions of three directions; more do not save time


class _NotClosed(Exception):
    """The exception for a Taylor system that gets no auxiliary states, for example because it would need too many.

    :func:`with_companions` then returns the system unchanged.
    """


class _Term(NamedTuple):
    """One term of a rate: ``number * constant * companion * state``, where a companion is an auxiliary state."""

    companion: int | None  # index of an auxiliary state; None for the factor 1
    number: Fraction
    constant: Node  # a formula that does not change during the motion
    state: int | None  # index of a state; None for the factor 1


def with_companions(system: Recurrences) -> Recurrences:
    """Return a Taylor system in which functions of the attitude alone, such as R(q)^T e, are additional states.

    A system without such functions, or one that would need too many, is returned unchanged.
    """
    if not set(QUATERNION) <= set(system.states):
        return system
    try:
        return _Closure(system).result()
    except _NotClosed:
        return system


def _times(a: Polynomial, b: Polynomial) -> Polynomial:
    """Return the product of two polynomials; raise _NotClosed if multiplying it out gives too many terms."""
    if len(a.terms) * len(b.terms) > MOST_TERMS and len(products_of_monomials(a, b)) > MOST_TERMS:
        raise _NotClosed
    return a * b


class _Closure:
    """A Taylor system with the auxiliary states (additional states) that replace polynomials in q0..q3 in its rates."""

    def __init__(self, system: Recurrences) -> None:
        self.system, self.series = system, system.series
        self.variables: list[tuple[str, Any]] = []  # state and number, clock and series, constant and formula
        self.polynomials: dict[int, Polynomial | None] = {}
        numbers = [system.states.index(name) for name in QUATERNION]
        self.attitude = {self.variable("state", number) for number in numbers}
        self.norm = Polynomial({((q, 2),): Fraction(1) for q in self.attitude})
        # the identities hold for a unit quaternion, so its norm must be constant along the motion
        if self.derivative(self.norm):
            raise _NotClosed
        self.companions: list[Polynomial] = []
        self.known: dict[frozenset[tuple[Monomial, Fraction]], tuple[int, Fraction]] = {}
        self.replaced: dict[int, list[_Term]] = {}  # series -> its terms in companions
        self.parts: dict[Series, tuple[set[int], list[_Term]]] = {}  # sum -> operands replaced, and their replacement

    # -------------------------------------------------------------------------------------------- polynomials

    def variable(self, kind: str, what: Any) -> int:
        if (kind, what) not in self.variables:
            self.variables.append((kind, what))
        return self.variables.index((kind, what))

    def single(self, kind: str, what: Any) -> Polynomial:
        return generator(self.variable(kind, what))

    def constant(self, node: Node) -> Polynomial:
        """Return a constant formula as a polynomial: ``2*sqrt(a)`` gives 2 u with the new variable u = sqrt(a)."""
        if node[0] == "number":
            return constant(node[1])
        if node[0] not in ("neg", "*", "+", "-"):
            return self.single("constant", node)
        parts = [self.constant(child) for child in children(node)]
        if node[0] == "neg":
            return _times(parts[0], constant(-1))
        if node[0] == "*":
            return _times(*parts)
        return parts[0] + (parts[1] if node[0] == "+" else _times(parts[1], constant(-1)))

    def polynomial(self, i: int) -> Polynomial | None:
        """Return series ``i`` as a polynomial in states, constants and functions of time such as sin(a t + b).

        The result is None if the series is no such polynomial: a quotient, for instance.
        """
        if i not in self.polynomials:
            s = self.series[i]
            result: Polynomial | None = None  # other rules, such as a quotient, give no polynomial
            if s.rule == "state":
                result = self.single("state", s.number)
            elif s.rule == "clock":
                result = self.single("clock", i)
            elif s.rule == "sum":
                result = self.sum(s)
            elif s.rule == "product":
                a, b = map(self.polynomial, s.operands)
                result = None if a is None or b is None else _times(a, b)
            self.polynomials[i] = result
        return self.polynomials[i]

    def sum(self, s: Series, only: Iterable[int] | None = None) -> Polynomial | None:
        """Return the sum ``s`` of series as a polynomial in states, constants and functions of time.

        The result is None if a summand is no such polynomial: a quotient, for instance. With ``only``, indices of
        series, all other summands and the constant of ``s`` are left out.
        """
        *weights, constant = s.weights
        total = self.constant(constant) if constant is not None and only is None else Polynomial({})
        for operand, weight in zip(s.operands, weights, strict=True):
            if only is None or operand in only:
                part = self.polynomial(operand)
                if part is None or weight is None:
                    return None
                total = total + _times(part, self.constant(weight))
        return total

    def rate(self, variable: int) -> Polynomial:
        """Return the time derivative of a variable of the polynomials, which is a polynomial too.

        ``variable`` is the index of a state, a function of time or a constant in ``self.variables``. Raise
        :class:`_NotClosed` if the derivative is no polynomial, such as a quotient, or has too many terms.
        """
        kind, what = self.variables[variable]
        if kind == "constant":
            return Polynomial({})
        if kind == "clock":
            s = self.series[what]
            assert s.weights[0] is not None
            partner = _times(self.single("clock", s.operands[0]), self.constant(s.weights[0]))
            return _times(partner, constant(s.sign))
        polynomial = self.sum(self.system.rates[what])
        if polynomial is None:
            raise _NotClosed
        return polynomial

    def derivative(self, form: Polynomial) -> Polynomial:
        total = Polynomial({})
        for monomial, x in form.terms.items():
            for variable, power in monomial:
                rest = tuple((v, p - (v == variable)) for v, p in monomial if (v, p) != (variable, 1))
                total = total + _times(Polynomial({rest: x * power}), self.rate(variable))
        return total

    def is_inner(self, variable: int) -> bool:
        return variable in self.attitude or self.variables[variable][0] == "clock"

    def of_attitude(self, form: Polynomial | None) -> bool:
        """Return whether a polynomial depends on the attitude alone, so that auxiliary states can replace it.

        It must have a term of degree 2 or more in q0..q3. It may contain constants and functions of time, but no other
        state. The result is False for None.
        """
        if form is None:
            return False
        free = [v for monomial in form.terms for v, _ in monomial if self.variables[v][0] != "constant"]
        return all(map(self.is_inner, free)) and max(map(self.degree, form.terms), default=0) > 1

    def degree(self, monomial: Monomial) -> int:
        """Return the degree of a monomial in q0..q3 alone: ``omega_1 q0 q1`` has degree 2."""
        return sum(power for variable, power in monomial if variable in self.attitude)

    def split(self, form: Polynomial) -> list[tuple[Node, int | None, Polynomial]]:
        """Return a polynomial as a sum of products (constant, index of a state, polynomial of the attitude and time).

        ``I omega_1 q0 q1 + I omega_1 q2 q3`` gives one product: I, the index of omega_1, and ``q0 q1 + q2 q3``.
        """
        # inner: attitude and functions of time alone; the caller makes each inner polynomial an auxiliary state
        groups: dict[Monomial, dict[Monomial, Fraction]] = {}
        for monomial, x in form.terms.items():
            outer = tuple((v, p) for v, p in monomial if not self.is_inner(v))
            groups.setdefault(outer, {})[tuple((v, p) for v, p in monomial if self.is_inner(v))] = x
        parts = []
        for outer, inner in groups.items():
            constant, state = ONE, None
            for variable, power in outer:
                kind, what = self.variables[variable]
                if kind == "state":
                    # the rate of an auxiliary state must be a sum of constant * (state or 1) * auxiliary state
                    if state is not None or power > 1:
                        raise _NotClosed
                    state = what
                for _ in range(power if kind == "constant" else 0):
                    constant = what if constant == ONE else ("*", constant, what)
            parts.append((constant, state, Polynomial(inner)))
        return parts

    # -------------------------------------------------------------------------------------------- closing

    def adjoin(self, inner: Polynomial) -> tuple[int | None, Fraction, Fraction]:
        """Return (index, factor, number) such that the polynomial ``inner`` is ``factor*state + number``.

        The formula holds for unit quaternions. ``state`` is the auxiliary state ``companions[index]``, added if it is
        new; the index is None if ``inner`` is a number. Raise _NotClosed if the state cannot be added.
        """
        # polynomials that differ only by the identity q0^2 + q1^2 + q2^2 + q3^2 = 1 must give the same state
        degrees = {self.degree(monomial) for monomial in inner.terms}
        top = max(degrees)
        if any((top - degree) % 2 for degree in degrees):
            raise _NotClosed
        # terms are multiplied by the squared norm until their degrees are equal: q0^2 + 1 becomes 2 q0^2 + q1^2 + q2^2
        # + q3^2
        whole = Polynomial({})
        for monomial, x in inner.terms.items():
            part = Polynomial({monomial: x})
            for _ in range((top - self.degree(monomial)) // 2):
                part = _times(part, self.norm)
            whole = whole + part
        # a multiple of the squared norm is subtracted, so that the coefficients of the squares sum to zero: 5/4 in the
        # example, which leaves 3/4 q0^2 - 1/4 (q1^2 + q2^2 + q3^2)
        spare = Fraction(0)
        if top == 2 and all(variable in self.attitude for monomial in inner.terms for variable, _ in monomial):
            spare = sum((whole.terms.get(square, Fraction(0)) for square in self.norm.terms), start=Fraction(0)) / 4
            whole = whole + _times(self.norm, constant(-spare))
            inner = inner + constant(-spare)
        if not whole:
            return None, Fraction(0), spare
        lead = whole.terms[min(whole.terms)]
        key = frozenset((monomial, x / lead) for monomial, x in whole.terms.items())
        if key not in self.known:
            if len(self.companions) == MOST_COMPANIONS:
                raise _NotClosed
            self.known[key] = len(self.companions), lead
            self.companions.append(inner)
        index, own = self.known[key]
        return index, lead / own, spare

    def terms(self, form: Polynomial) -> list[_Term]:
        result = []
        for weight, state, inner in self.split(form):
            index, number, spare = self.adjoin(inner)
            result += [_Term(one, x, weight, state) for one, x in ((index, number), (None, spare)) if x]
        return result

    def seek(self, i: int) -> None:
        """Turn polynomials in q0..q3 that occur in series ``i`` or its operands into auxiliary (additional) states.

        The series itself is not changed yet: ``replaced`` and ``parts`` list what :meth:`result` is to replace.
        """
        s = self.series[i]
        if i in self.replaced or s.rule not in ("sum", "product"):
            return
        if self.of_attitude(self.polynomial(i)):
            self.replaced[i] = self.terms(self.polynomial(i) or Polynomial({}))
        elif s.rule == "sum":
            self.seek_in(s)
        else:
            for operand in s.operands:
                self.seek(operand)

    def seek_in(self, s: Series) -> None:
        """Turn polynomials in q0..q3 that occur in ``s``, a sum of series, into auxiliary (additional) states.

        The sum itself is not changed yet: ``replaced`` and ``parts`` list what :meth:`result` is to replace.
        """
        # products of components of the attitude are replaced together: q1 q3 + q0 q2 in q1 q3 + q0 q2 + t
        alone = {
            i for i in s.operands if self.series[i].rule == "product" and self.of_attitude(self.polynomial(i))
            and not any(self.of_attitude(self.polynomial(factor)) for factor in self.series[i].operands)
        }  # fmt: skip
        if alone and s not in self.parts:
            self.parts[s] = alone, self.terms(self.sum(s, alone) or Polynomial({}))
        for operand in s.operands:
            if operand in alone:
                continue
            if self.series[operand].rule == "product":  # products of companions: each companion is replaced separately
                for factor in self.series[operand].operands:
                    self.seek(factor)
            else:
                self.seek(operand)

    def result(self) -> Recurrences:
        for rate in self.system.rates:
            self.seek_in(rate)
        if not self.companions:
            return self.system
        rates: list[list[_Term]] = []
        # the derivative of a companion may need further companions, until none is new
        while len(rates) < len(self.companions):
            rates.append(self.terms(self.derivative(self.companions[len(rates)])))
        return _rebuilt(self, rates)

    def seed(self, form: Polynomial) -> Node:
        """Return the formula, in states and t, by which an auxiliary state is computed at the start of each step.

        ``form`` is the polynomial in the attitude and in functions of time that defines the auxiliary state.
        """
        # terms with the same functions of time are put in one bracket
        groups: dict[Monomial, dict[Fraction, list[Node]]] = {}
        for monomial, x in sorted(form.terms.items()):
            clocks = tuple((v, p) for v, p in monomial if v not in self.attitude)
            product = _product(self.symbol(v) for v, p in monomial if v in self.attitude for _ in range(p))
            size = abs(x)
            if product == ONE:
                product, size = ("number", size), Fraction(1)
            groups.setdefault(clocks, {}).setdefault(size, []).append(product if x > 0 else ("neg", product))
        parts = []
        for clocks, numbers in groups.items():
            sums = [_product([*([("number", x)] if x != 1 else []), _total(terms)]) for x, terms in numbers.items()]
            parts.append(_product([*(self.symbol(v) for v, p in clocks for _ in range(p)), _total(sums)]))
        return _total(parts)

    def symbol(self, variable: int) -> Node:
        kind, what = self.variables[variable]
        if kind == "state":
            return ("symbol", self.system.states[what])
        s = self.series[what]
        rate, offset = s.weights
        turned: Node = ("*", rate, ("symbol", "t"))
        return ("call", s.function, (turned if offset is None else ("+", turned, offset),))


def _product(factors: Iterable[Node]) -> Node:
    product = ONE
    for factor in factors:
        product = factor if product == ONE else product if factor == ONE else ("*", product, factor)
    return product


def _total(terms: list[Node]) -> Node:
    first = next((i for i, term in enumerate(terms) if term[0] != "neg"), 0)
    total, *rest = [terms[first], *terms[:first], *terms[first + 1 :]]
    for term in rest:
        total = ("-", total, term[1]) if term[0] == "neg" else ("+", total, term)
    return total


def _rebuilt(closure: _Closure, rates: list[list[_Term]]) -> Recurrences:
    """Return the system with the auxiliary states as further states, and without the series that they replace."""
    # as a series, q1 q3 + q0 q2 takes two convolutions per coefficient; as a state, its coefficients follow from its
    # rate
    system, old = closure.system, closure.series
    count = len(system.states)
    alias = {
        i: terms[0].companion for i, terms in closure.replaced.items()
        if len(terms) == 1 and terms[0].companion is not None and terms[0].number == 1 and terms[0].constant == ONE
    }  # fmt: skip

    def left(s: Series) -> list[int]:
        """Return the indices of the operands of the series ``s`` that auxiliary states do not replace."""
        return [i for i in s.operands if i not in closure.parts.get(s, (set(),))[0]]

    needed: set[int] = set()
    waiting = [i for rate in system.rates for i in left(rate)]
    while waiting:
        i = waiting.pop()
        if i not in needed:
            needed.add(i)
            waiting += [] if i in closure.replaced else left(old[i])
    place = {i: s.number for i, s in enumerate(old) if s.rule == "state"}
    place |= {i: count + companion for i, companion in alias.items()}
    carried = [i for i in sorted(needed) if i not in place]
    place |= {i: count + len(rates) + k for k, i in enumerate(carried)}
    series = [Series("state", number=number) for number in range(count + len(rates))]

    def weight(term: _Term) -> Node:
        number: Node = ("number", term.number)
        return _product([*([number] if term.number != 1 else []), term.constant])

    def summed(
        terms: list[_Term], pairs: Iterable[tuple[int, Node | None]] = (), constant: Node | None = None
    ) -> Series:
        """Return the series of a sum of auxiliary states (``terms``), other series (``pairs``) and a constant.

        Each of ``pairs`` is (index of a series, weight).
        """
        for term in terms:
            if term.companion is None:
                constant = weight(term) if constant is None else ("+", constant, weight(term))
        both = [*pairs, *((count + term.companion, weight(term)) for term in terms if term.companion is not None)]
        return Series("sum", tuple(i for i, _ in both), (*(w for _, w in both), constant))

    def moved(s: Series) -> Series:
        if s.rule != "sum":
            operands = tuple(place[i] for i in s.operands)
            return s._replace(operands=tuple(sorted(operands)) if s.rule == "product" else operands)
        gone, terms = closure.parts.get(s, (set(), []))
        pairs = [(place[i], w) for i, w in zip(s.operands, s.weights, strict=False) if i not in gone]
        return summed(terms, pairs, s.weights[-1])

    for i in carried:
        series.append(summed(closure.replaced[i]) if i in closure.replaced else moved(old[i]))
    rates_in_place = [moved(rate) for rate in system.rates]
    products: dict[tuple[int, int], int] = {}
    for terms in rates:
        operands = []
        for term in terms:
            if term.companion is None and term.state is None:
                raise _NotClosed  # a companion with zero rate would be a constant
            both = (term.state, None if term.companion is None else count + term.companion)
            pair = [own for own in both if own is not None]
            if len(pair) == 2 and tuple(pair) not in products:
                products[(pair[0], pair[1])] = len(series)
                series.append(Series("product", tuple(pair)))
            operands.append(products[(pair[0], pair[1])] if len(pair) == 2 else pair[0])
        rates_in_place.append(Series("sum", tuple(operands), (*map(weight, terms), None)))
    seeds = tuple(map(closure.seed, closure.companions))
    return Recurrences(system.states, system.parameters, tuple(series), tuple(rates_in_place), seeds)
