"""C code of the Taylor coefficients of an ensemble: each SIMD lane (element of a vector) holds one trajectory.

The jet is the list of the Taylor coefficients of all states at one time. A convolution ``sum(u[k] v[n-k], k = 0..n)``
is coefficient n of the product of two series u and v; its inner terms are those for k = 1 to n - 1. A slot is a sum of
several convolutions, each added or subtracted. The code is placed between :file:`lanes.h` and :file:`lanes.c` of
:mod:`symrot.ensemble`.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from symrot.codegen.printing.c_function import c_expression
from symrot.codegen.taylor.lane_functions import lane_functions
from symrot.codegen.taylor.linear_forms import ONE, ZERO, split_sign
from symrot.codegen.taylor.recurrences import Recurrences, Series, recurrences
from symrot.codegen.taylor.source import checked_system
from symrot.formula.program import Program
from symrot.formula.tree import Node, names, rename

__all__ = ["lane_definitions", "multiplications"]

CIRCLE = {"sin", "cos"}  # both are computed by one call
LOAD_OF_LOOP = 24  # accumulators and factors of a loop: by measurement, half more than the 16 registers of AVX2


class Convolution(NamedTuple):
    """A convolution ``sum(a[k] b[n-k])`` of the Taylor coefficients of two series, given by their indices a and b."""

    a: int
    b: int
    ends: str  # its terms k = 0 and k = n: both, last (only k = n, with the newest coefficient of a) or none

    @property
    def square(self) -> bool:
        return self.a == self.b


class Slot(NamedTuple):
    """A sum of several convolutions, each added or subtracted: ``terms`` holds pairs (sign, convolution)."""

    terms: tuple[tuple[int, Convolution], ...]

    @property
    def square(self) -> bool:
        return self.terms[0][1].square


CONVOLUTIONS = {  # rule -> operands a and b of its convolution (-1 is the series itself), and its end terms
    "product": (0, 1, "both"),
    "quotient": (-2, -1, "last"),
    "root": (-1, -1, "none"),
    "driven": (0, 1, "last"),
    "primitive": (1, 2, "none"),
}


def lane_definitions(program: Program, edges: Sequence[int], scales: Sequence[float], order: int) -> str:
    """Return C code for :file:`lanes.c`, the stepper of ensembles: sizes, and a function for the Taylor coefficients.

    See :func:`symrot.codegen.taylor.source.taylor_definitions` for the arguments.

    Raises
    ------
    InputError
        If an operation has no Taylor series, if ``order`` is odd or below 4, or if ``edges`` and ``scales`` do not
        fit the states.
    """
    system = checked_system(program, edges, scales, order)
    inverses = ", ".join(["0.0", *(f"1.0/{n}" for n in range(1, order + 1))])
    return "\n".join(
        (
            f"#define SYMROT_STATES {len(system.states)}",
            f"#define SYMROT_PARAMETERS {len(system.parameters)}",
            f"#define SYMROT_ORDER {order}",
            f"#define SYMROT_ROOTS {len(_roots(system))}",
            f"#define SYMROT_BLOCKS {len(scales)}",
            f"#define SYMROT_EDGES {{{', '.join(map(str, edges))}}}",
            f"#define SYMROT_SCALES {{{', '.join(repr(float(scale)) for scale in scales)}}}",
            "",
            f"static const double symrot_inverse[] = {{{inverses}}};",
            lane_functions() if any(s.rule == "clock" or s.function in CIRCLE for s in system.series) else "",
            _Jet(system).text(),
        )
    )


def multiplications(program: Program, order: int) -> int:
    """Return the approximate number of multiplications in the convolutions of one Taylor step of one trajectory."""
    # a measure of the time of a step
    jet = _Jet(recurrences(program))
    shares = [(0.5 if slot.square else 1.0) * len(slot.terms) for slot in jet.slots]
    return int(sum(shares) * order * (order + 1) / 2)


class _Jet:
    """Writes the C function that computes the Taylor coefficients of all states: coefficients 0, then 1, and so on.

    A slot is a sum of several convolutions ``sum(u[k] v[n-k], k = 0..n)``, each added or subtracted. From n = 2 on, a C
    loop first adds up the inner terms of slot i, k = 1 to n - 1, in the C variable ``a{i}`` for even n and ``b{i}`` for
    odd n.
    """

    def __init__(self, system: Recurrences) -> None:
        # in C, v{i} is the newest coefficient of series i, and u{i} the array of all (x[..] for a state)
        self.system, self.series = system, system.series
        self.state = {i: s.number for i, s in enumerate(self.series) if s.rule == "state"}
        self.roots = {i: place for place, i in enumerate(_roots(system), start=len(system.states))}
        self.constants: dict[Node, int] = {}
        self.slots: list[Slot] = []
        self.slot_of: dict[int, tuple[int, int]] = {}  # series -> its sign in its slot, and the index of the slot
        self.shared: set[int] = set()  # products that occur only in sums and get no variable of their own
        self._make_slots()
        self.stored = {
            operand for slot in self.slots for _, c in slot.terms for operand in (c.a, c.b) if operand not in self.state
        }
        self.divided = [i for i, s in enumerate(self.series) if s.rule in ("quotient", "root", "primitive")]

    def _make_slots(self) -> None:
        """Fill ``slots``: the sums of convolutions, each the series of one product, that C adds up in one variable.

        If several products occur only together, with the same weights in the same sums, C needs their sum alone: their
        convolutions share a slot. Every other convolution gets a slot of its own.
        """
        uses: dict[int, list[tuple[int, Node, int]]] = {}
        own: set[int] = set()
        for place, s in enumerate((*self.series, *self.system.rates)):
            if s.rule == "sum":
                for operand, weight in zip(s.operands, s.weights, strict=False):
                    assert weight is not None
                    sign, size = split_sign(weight)
                    uses.setdefault(operand, []).append((place, size, sign))
            else:
                own |= set(s.operands)
        groups: dict[object, list[tuple[int, Convolution, int]]] = {}
        for i, s in enumerate(self.series):
            if s.rule not in CONVOLUTIONS:
                continue
            c, sign = self._convolution(i, s), 1
            key: object = i
            if s.rule == "product" and i not in own and i in uses:
                sign = uses[i][0][2]
                # products that occur with equal weights in the same sums share a slot
                key = (c.square, tuple((place, size, sign * other) for place, size, other in uses[i]))
                self.shared.add(i)
            groups.setdefault(key, []).append((sign, c, i))
        for members in sorted(groups.values(), key=lambda one: (one[0][1].square, -len(one))):
            lead = members[0][0]
            self.slot_of |= {i: (sign * lead, len(self.slots)) for sign, _, i in members}
            self.slots.append(Slot(tuple((sign * lead, c) for sign, c, _ in members)))

    def _convolution(self, i: int, s: Series) -> Convolution:
        a, b, ends = CONVOLUTIONS[s.rule]
        places = {-1: i, -2: s.operands[-1], **dict(enumerate(s.operands))}
        return Convolution(places[a], places[b], ends)

    # -------------------------------------------------------------------------------------------- expressions

    def at(self, series: int, n: str) -> str:
        return f"x[{self.state[series]}][{n}]" if series in self.state else f"u{series}[{n}]"

    def weight(self, node: Node) -> str:
        """Return the C expression of a constant: a literal for a number, ``c[k]`` for a formula.

        The caller has split off a minus sign in front of the constant.
        """
        if not names(node) and node[0] == "number":
            return f"V_ALL({c_expression(node)})"
        return f"c[{self.constants.setdefault(node, len(self.constants))}]"

    def signed(self, node: Node | None) -> str:
        """Return the C expression of a constant of any sign; None stands for zero."""
        sign, size = split_sign(node or ZERO)
        return self.weight(size) if sign > 0 else f"V_SUB(V_ALL(0.0), {self.weight(size)})"

    def slot(self, number: int, stage: str, sums: str) -> str:
        """Return the C expression for coefficient n of slot ``number``, a sum of convolutions ``sum(u[k] v[n-k])``.

        ``stage`` is "first" for n = 0, "second" for n = 1, else "later". ``sums`` is, from n = 2 on, "a" for even n and
        "b" for odd n: the C variable ``a{number}`` or ``b{number}`` has the terms k = 1 to n - 1.
        """
        # the C variable such as a3 holds the terms k = 1..n-1; terms with coefficients n are added here
        older = f"{sums}{number}" if stage == "later" else ""
        # terms with v[n] are summed apart, so that the processor can add them while it waits for u[n]
        newer = ""
        for sign, (a, b, ends) in self.slots[number].terms:
            if stage == "first":
                older = _plus(older, sign, f"{self.at(a, '0')}, {self.at(b, '0')}") if ends == "both" else older
            elif a == b and ends == "both":
                older = _plus(older, sign, f"V_ADD({self.at(a, '0')}, {self.at(a, '0')}), v{a}")
            elif ends != "none":
                older = _plus(older, sign, f"v{a}, {self.at(b, '0')}")
                if ends == "both":
                    newer = _plus(newer, sign, f"{self.at(a, '0')}, v{b}")
        return f"V_ADD({older}, {newer})" if older and newer else older or newer

    def sum(self, s: Series, first: bool, factor: str = "") -> str:
        """Return the C expression for coefficient n of the sum ``s`` of weighted series, times ``factor`` (C text).

        ``first`` says whether n is 0; an empty ``factor`` stands for 1.
        """
        value = ""
        *weights, constant = s.weights
        if first and constant is not None and constant != ZERO:  # coefficient 0
            sign, size = split_sign(constant)
            value = f"V_MUL({self.weight(size)}, {factor})" if factor else self.weight(size)
            value = value if sign > 0 else f"V_SUB(V_ALL(0.0), {value})"
        done: set[int] = set()
        parts = []
        for operand, weight in zip(s.operands, weights, strict=True):
            assert weight is not None
            sign, size = split_sign(weight)
            name = f"v{operand}"
            if operand in self.shared:
                own, slot = self.slot_of[operand]
                if slot in done:
                    continue
                done.add(slot)
                sign, name = sign * own, f"s{slot}"
            parts.append((operand in self.shared, sign, size, name))
        # terms that are computed last are added last
        for _, sign, size, name in sorted(parts, key=lambda part: part[0]):
            scale = "" if size == ONE else self.weight(size)
            scale = f"V_MUL({scale}, {factor})" if scale and factor else scale or factor
            if scale:
                value = _plus(value, sign, f"{name}, {scale}")
            elif value:
                value = f"V_{'ADD' if sign > 0 else 'SUB'}({value}, {name})"
            else:
                value = name if sign > 0 else f"V_SUB(V_ALL(0.0), {name})"
        return value or "V_ALL(0.0)"

    # -------------------------------------------------------------------------------------------- series

    def coefficient(self, i: int, n: str, stage: str, sums: str) -> list[str]:
        """Return the C statements that set the variable ``v{i}`` to coefficient ``n`` (C text) of series ``i``.

        ``stage`` is "first" for n = 0, "second" for n = 1, else "later"; ``sums`` is, from n = 2 on, "a" for even n and
        "b" for odd n.
        """
        s, name = self.series[i], f"v{i}"
        if s.rule == "sum":
            return [f"{name} = {self.sum(s, stage == 'first')};"]
        if s.rule == "time":
            value = {"first": "t", "second": "unit"}.get(stage, "V_ALL(0.0)")
            return [f"{name} = {value};"]
        if s.rule == "theta":
            factor = {"first": "0.0", "second": "1.0"}.get(stage, f"(double)({n})")
            return [f"{name} = V_MUL(v{s.operands[0]}, V_ALL({factor}));"]
        if s.rule == "clock":
            return self._clock_start(i, s) if stage == "first" else self._clock(s, name, n)

        total = self.slot(self.slot_of[i][1], stage, sums)
        if s.rule == "product":
            return [f"{name} = {total};"]
        if s.rule == "quotient":
            divisor = s.operands[-1]
            if stage == "first":
                upper = f"v{s.operands[0]}" if len(s.operands) > 1 else "V_ALL(1.0)"
                return [f"d{i} = v{divisor};", f"{name} = V_DIV({upper}, d{i});"]
            upper = f"v{s.operands[0]}" if len(s.operands) > 1 else "V_ALL(0.0)"
            return [f"{name} = V_DIV(V_SUB({upper}, {total}), d{i});"]
        if s.rule == "driven":
            if stage == "first" and s.function in CIRCLE:
                v, w = (f"v{one}" for one in (i, s.operands[1]))
                return [f"symrot_circle(v{s.operands[2]}, V_ALL(0.0), &{v}, &{w});"] if s.function == "sin" else []
            if stage == "first":
                return [f"{name} = {_called(s, 2)};"]
            sign = "" if s.sign > 0 else "-"
            return [f"{name} = V_MUL({total}, V_ALL({sign}symrot_inverse[{n}]));"]
        if s.rule == "root":
            if stage == "first":
                return [f"{name} = {_called(s, 0)};", f"d{i} = V_ADD({name}, {name});"]
            upper = f"V_SUB(v{s.operands[0]}, {total})" if total else f"v{s.operands[0]}"
            return [f"{name} = V_DIV({upper}, d{i});"]
        if stage == "first":  # primitive
            return [f"{name} = {_called(s, 3)};", f"d{i} = v{s.operands[2]};"]
        upper = f"V_SUB(v{s.operands[0]}, {total})" if total else f"v{s.operands[0]}"
        return [f"{name} = V_DIV({upper}, V_MUL(d{i}, V_ALL((double)({n}))));"]

    def _clock(self, s: Series, name: str, n: str) -> list[str]:
        """Return the C statement that sets ``name`` to coefficient ``n`` (C text) of ``s``, such as cos(a t + b)."""
        rate, _ = s.weights
        assert rate is not None
        sign, size = split_sign(rate)
        step = f"V_MUL(unit, V_ALL(symrot_inverse[{n}]))"
        step = step if size == ONE else f"V_MUL({self.weight(size)}, {step})"
        step = step if sign * s.sign > 0 else f"V_SUB(V_ALL(0.0), {step})"
        # p{i} is coefficient n - 1 of the function's derivative, such as cosine for sine
        return [f"{name} = V_MUL(p{s.operands[0]}, {step});"]

    def _clock_start(self, i: int, s: Series) -> list[str]:
        """Return the C statements that compute coefficient 0 of series i, such as cos(a t + b)."""
        both = sorted({i, s.operands[0]})
        # sine and cosine are computed together, by the statements of the series with the lower index
        if i != both[0]:
            return []
        rate, offset = (self.signed(node) for node in s.weights)
        lines = [f"symrot_v low{i};", f"const symrot_v high{i} = symrot_turn({rate}, {offset}, t, t_low, &low{i});"]
        if s.function in CIRCLE:
            return [*lines, f"symrot_circle(high{i}, low{i}, &v{i}, &v{both[1]});"]
        for one in both:
            lines.append(f"const symrot_v k{one} = V_CALL({self.series[one].function}, high{i});")
        for one in both:  # the rounding error of the phase is corrected to first order, by the function's slope
            slope = "FMA" if self.series[one].sign > 0 else "FNMA"
            lines.append(f"v{one} = V_{slope}(low{i}, k{self.series[one].operands[0]}, k{one});")
        return lines

    # -------------------------------------------------------------------------------------------- orders

    def order(self, n: str, stage: str, sums: str) -> list[str]:
        """Return the C statements that compute coefficient ``n`` of all series, then coefficient n + 1 of the states.

        ``n`` is the index as C text: ``"0"``, ``"1"``, ``"n"`` (an even index from 2 on) or ``"m"`` (an odd index from
        3 on). ``stage`` is "first" for the index 0, "second" for 1, else "later". ``sums`` is the first letter of the C
        variables that hold the sums of inner terms: "a" for ``"n"`` and "b" for ``"m"``. For 0 and 1, which have no
        inner terms, ``sums`` is empty.
        """
        lines: list[str] = []
        made: set[int] = set()

        def slots_of(s: Series) -> Iterable[str]:
            for operand in s.operands if s.rule == "sum" else ():
                if operand in self.shared and (slot := self.slot_of[operand][1]) not in made:
                    made.add(slot)
                    yield f"const symrot_v s{slot} = {self.slot(slot, stage, sums)};"

        if stage != "first":
            lines += [f"const symrot_v p{i} = v{i};" for i in self._partners()]
        for i, s in enumerate(self.series):
            if s.rule == "state" or i in self.shared:
                continue
            lines += slots_of(s)
            lines += self.coefficient(i, n, stage, sums)
            if i in self.stored:
                lines.append(f"u{i}[{n}] = v{i};")
            if i in self.roots:
                lines.append(f"x[{self.roots[i]}][{n}] = v{i};")
        following = {"0": "1", "1": "2", "n": "n + 1", "m": "m + 1"}[n]
        lines.append(f"const symrot_v step = V_MUL(unit, V_ALL(symrot_inverse[{following}]));")
        for s in self.system.rates:
            lines += slots_of(s)
        rates = self.system.rates
        lines += [f"const symrot_v y{i} = {self.sum(s, stage == 'first', 'step')};" for i, s in enumerate(rates)]
        lines += [f"x[{i}][{following}] = y{i};" for i in range(len(rates))]
        lines += [f"v{series} = y{i};" for series, i in self.state.items()]
        return lines

    def _partners(self) -> list[int]:
        """Return the indices of the series whose coefficient n - 1 another series needs, such as sine for cosine."""
        return sorted({s.operands[0] for s in self.series if s.rule == "clock"})

    def loops(self) -> list[str]:
        """Return the C loops that add up terms of all convolutions for two coefficients: n (even) and n + 1.

        Slot i is a sum of convolutions ``sum(u[k] v[n-k])``. For coefficient n, the loops set the C variable ``a{i}``
        to the sum of its terms u[k] v[n-k] for k = 1 to n - 1. For coefficient n + 1, they set ``b{i}`` to the sum of
        its terms u[k] v[n+1-k] for k = 2 to n - 1. The terms k = 1 and k = n need coefficient n, which is still
        unknown.
        """
        # each number is read once for both coefficients
        return [line for group in self._groups() for line in self._loop(group)]

    def _groups(self) -> list[list[int]]:
        """Return, for each C loop, the indices of the slots (sums of convolutions) that it computes."""
        left = list(range(len(self.slots)))
        groups: list[list[int]] = []
        while left:
            group = [left.pop(0)]
            alike = [i for i in left if self.slots[i].square == self.slots[group[0]].square]
            # slots with common factors share a loop as long as registers suffice
            while (
                alike
                and self._load([*group, best := min(alike, key=lambda i: self._load([*group, i]))]) <= LOAD_OF_LOOP
            ):
                group.append(best)
                alike.remove(best)
                left.remove(best)
            groups.append(group)
        return groups

    def _load(self, group: Sequence[int]) -> int:
        """Return the number of registers that a C loop needs to add up the slots (sums of convolutions) ``group``.

        ``group`` has their indices in ``slots``.
        """
        terms = [c for i in group for _, c in self.slots[i].terms]
        # two sums of each slot, the values of each series u for two k, and one value of each series v
        return 2 * len(group) + 2 * len({c.a for c in terms}) + len({c.b for c in terms})

    def _loop(self, group: Sequence[int]) -> list[str]:
        square = self.slots[group[0]].square
        terms = [(i, sign, c) for i in group for sign, c in self.slots[i].terms]
        left, right = sorted({c.a for *_, c in terms}), sorted({c.b for *_, c in terms})
        lines = [f"symrot_v a{i} = V_ALL(0.0), b{i} = a{i};" for i in group]
        if not square:
            return lines + self._products(terms, left, right)
        lines.append("for (int64_t k = 1; k < n/2; ++k) {")
        lines += [f"    const symrot_v h{i} = {self.at(i, 'n - k')};" for i in right]
        lines += [f"    const symrot_v f{i} = {self.at(i, 'k')}, g{i} = {self.at(i, 'k + 1')};" for i in left]
        for i, sign, (a, b, _) in terms:
            lines.append(f"    {_add(f'a{i}', sign, f'f{a}, h{b}')}")
            lines.append(f"    {_add(f'b{i}', sign, f'g{a}, h{b}')}")
        lines.append("}")
        lines += [f"{sums}{i} = V_ADD({sums}{i}, {sums}{i});" for i in group for sums in "ab"]
        lines += [_add(f"a{i}", sign, f"{self.at(c.a, 'n/2')}, {self.at(c.b, 'n/2')}") for i, sign, c in terms]
        return lines

    def _products(
        self, terms: Sequence[tuple[int, int, Convolution]], left: Sequence[int], right: Sequence[int]
    ) -> list[str]:
        """Return the C code that adds up the inner terms of convolutions of two different series u and v.

        Each of ``terms`` is (i, sign, convolution), which stands for one convolution of slot i (a sum of convolutions).
        A C loop runs over k in steps of 2. For each convolution it adds ``sign`` times the products u[k] v[n-k] and
        u[k+1] v[n-k-1] to the C variable ``a{i}``, for coefficient n; and ``sign`` times u[k+1] v[n-k] and
        u[k+2] v[n-k-1] to ``b{i}``, for coefficient n + 1. ``left`` are the indices of all series u, and ``right`` of
        all series v.
        """
        lines = ["{", *(f"    symrot_v f{i} = {self.at(i, '1')};" for i in left)]
        lines.append("    for (int64_t k = 1; k < n - 1; k += 2) {")
        for new, old, ahead, behind in (("g", "f", "k + 1", "n - k"), ("f", "g", "k + 2", "n - k - 1")):
            kind = "const symrot_v " if new == "g" else ""
            lines += [f"        {kind}{new}{i} = {self.at(i, ahead)};" for i in left]
            for factor in right:
                value = f"{'h' if new == 'g' else 'j'}{factor}"
                lines.append(f"        const symrot_v {value} = {self.at(factor, behind)};")
                for i, sign, c in terms:
                    if c.b == factor:
                        lines.append(f"        {_add(f'a{i}', sign, f'{old}{c.a}, {value}')}")
                        lines.append(f"        {_add(f'b{i}', sign, f'{new}{c.a}, {value}')}")
        lines.append("    }")
        lines += [f"    {_add(f'a{i}', sign, f'f{c.a}, ' + self.at(c.b, '1'))}" for i, sign, c in terms]
        return [*lines, "}"]

    def completed_sums(self) -> list[str]:
        """Return the C statements that add the missing terms u[1] v[n] and u[n] v[1] to the sums ``b{i}``.

        The C variable ``b{i}`` is the sum of the inner terms of slot i (a sum of convolutions) for coefficient n + 1.
        The C loops of :meth:`loops` left out these two terms, because coefficient n was still unknown; it is known
        where these statements are placed.
        """
        lines: list[str] = []
        for i, slot in enumerate(self.slots):
            for sign, (a, b, _) in slot.terms:
                one = self.at(a, "1")
                if a == b:
                    lines.append(_add(f"b{i}", sign, f"V_ADD({one}, {one}), {self.at(a, 'n')}"))
                else:
                    lines.append(_add(f"b{i}", sign, f"{one}, {self.at(b, 'n')}"))
                    lines.append(_add(f"b{i}", sign, f"{self.at(a, 'n')}, {self.at(b, '1')}"))
        return lines

    def text(self) -> str:
        own = [i for i in range(len(self.series)) if i not in self.shared]
        orders = {"0": self.order("0", "first", ""), "1": self.order("1", "second", ""),
                  "n": self.order("n", "later", "a"), "m": self.order("m", "later", "b")}  # fmt: skip
        body = [
            "(void)c;",
            "(void)t;",
            "(void)t_low;",
            *(f"symrot_v u{i}[SYMROT_ORDER + 1];" for i in sorted(self.stored)),
            *(f"symrot_v v{i} = {self.at(i, '0')};" if i in self.state else f"symrot_v v{i};" for i in own),
            *(f"symrot_v d{i};" for i in self.divided),
            "{", *_indented(orders["0"]), "}",
            "{", *_indented(orders["1"]), "}",
            # no loop over the order is unrolled, so that the code stays small
            "for (int64_t n = 2; n < order; n += 2) {",
            *_indented(["const int64_t m = n + 1;", *self.loops(), "{", *_indented(orders["n"]), "}",
                        *self.completed_sums(), "{", *_indented(orders["m"]), "}"]),
            "}",
        ]  # fmt: skip
        places = {name: f"p[{i}]" for i, name in enumerate(self.system.parameters)}
        values = [f"c[{i}] = {c_expression(rename(node, places))};" for node, i in self.constants.items()]
        return "\n".join([
            f"#define SYMROT_CONSTANTS {max(1, len(self.constants))}",
            "",
            "static void symrot_constants(const double *p, double *c)",
            "{",
            *_indented(["(void)p;", "c[0] = 0.0;" if not values else "", *values]),
            "}",
            "",
            "/*",
            " * Fill x[i][1] to x[i][order], order even, from x[i][0], in powers of the unit of time of each lane. The",
            " * rows after those of the states receive coefficients 0 to order - 1 of the square roots.",
            " */",
            "static SYMROT_APART void symrot_jet(const symrot_v *SYMROT_RESTRICT c, symrot_v t, symrot_v t_low,",
            "    symrot_v unit, int64_t order, symrot_v (*SYMROT_RESTRICT x)[SYMROT_ORDER + 1])",
            "{",
            *_indented(body),
            "}",
        ]) + "\n"  # fmt: skip


def _roots(system: Recurrences) -> list[int]:
    """Return the indices of the series that are square roots, such as that of ``|omega|``."""
    return [i for i, s in enumerate(system.series) if s.rule == "root"]


def _plus(value: str, sign: int, factors: str) -> str:
    """Return the C expression of ``value + sign*u*v``, where ``factors`` is the text ``"u, v"``.

    An empty ``value`` stands for zero.
    """
    if value:
        return f"V_{'FMA' if sign > 0 else 'FNMA'}({factors}, {value})"
    return f"V_MUL({factors})" if sign > 0 else f"V_SUB(V_ALL(0.0), V_MUL({factors}))"


def _add(name: str, sign: int, factors: str) -> str:
    """Return the C statement that adds ``sign*u*v`` to the variable ``name``; ``factors`` is the text ``"u, v"``."""
    return f"{name} = V_{'FMA' if sign > 0 else 'FNMA'}({factors}, {name});"


def _called(s: Series, first: int) -> str:
    """Return the C call, such as ``V_CALL(exp, v3)``, that computes coefficient 0 of the function ``s``.

    The arguments of the function are the operands of ``s`` from number ``first`` on.
    """
    arguments = [f"v{operand}" for operand in s.operands[first:]]
    return f"V_CALL{'' if len(arguments) == 1 else len(arguments)}({s.function}, {', '.join(arguments)})"


def _indented(lines: Iterable[str]) -> list[str]:
    return [f"    {line}" if line else "" for line in lines]
