"""C code of the Taylor series of one motion: a function computes all Taylor coefficients of all states (the jet).

The series are arranged in rows (SIMD vectors of four), and their products in columns (convolutions of two vectors), see
:mod:`symrot.codegen.taylor.lanes`. The code is placed between :file:`taylor.h`, the operations on vectors, and
:file:`taylor.c`, the stepper.
"""

from collections.abc import Iterable, Mapping, Sequence

from symrot.codegen.printing.c_function import c_expression
from symrot.codegen.taylor.auxiliary_states import with_companions
from symrot.codegen.taylor.lanes import LANES, Address, Layout, Pack, Row, cost, lay_out
from symrot.codegen.taylor.linear_forms import ONE, ZERO
from symrot.codegen.taylor.recurrences import Recurrences, recurrences
from symrot.errors import InputError
from symrot.formula.program import Program
from symrot.formula.tree import Node, children, names, rename, with_children

__all__ = ["ORDER", "checked_system", "jet_source", "taylor_definitions"]

ORDER = 20  # as measured: for errors below 1e-6, the times of orders 16 to 24 differ by less than a tenth
COLUMNS_PER_LOOP = 4  # each with two sums, so that sums and factors fit into 16 registers


def taylor_definitions(program: Program, edges: Sequence[int], scales: Sequence[float], order: int = ORDER) -> str:
    """Return C code for the stepper :file:`taylor.c`: tables, and a function for the Taylor coefficients of a motion.

    Parameters
    ----------
    program : Program
        The right-hand side ``dy = f(t, y, p)``.
    edges : sequence of int
        State i is in block j if ``edges[j] <= i < edges[j + 1]``; each block of states has its own error.
    scales : sequence of float
        One number per block: the size to which errors of the block are relative; 0 means the norm of the block itself.
    order : int
        Order of the series: even, at least 4.

    Raises
    ------
    InputError
        If an operation has no Taylor series, if ``order`` is odd or below 4, or if ``edges`` and ``scales`` do not
        fit the states.
    """
    system = checked_system(program, edges, scales, order)
    layout = min((lay_out(one, edges) for one in (system, with_companions(system))), key=cost)
    blocks = [next(b for b in range(len(scales)) if states[0] < edges[b + 1]) for states in layout.states]
    return "\n".join(
        (
            f"#define SYMROT_STATES {len(system.states)}",
            f"#define SYMROT_PARAMETERS {len(system.parameters)}",
            f"#define SYMROT_ORDER {order}",
            f"#define SYMROT_ROWS {len(layout.states)}",
            f"#define SYMROT_ROW_STARTS {_table(str(states[0]) for states in layout.states)}",
            f"#define SYMROT_ROW_SIZES {_table(str(len(states)) for states in layout.states)}",
            f"#define SYMROT_ROW_BLOCKS {_table(map(str, blocks))}",
            f"#define SYMROT_SCALES {_table(repr(float(scale)) for scale in scales)}",
            "",
            f"static const double symrot_inverse[] = {_table(['0.0', *(f'1.0/{n}' for n in range(1, order + 1))])};",
            "",
            jet_source(layout, system.parameters),
        )
    )


def checked_system(program: Program, edges: Sequence[int], scales: Sequence[float], order: int) -> Recurrences:
    """Return the Taylor recurrences of ``program`` after a check of the arguments of :func:`taylor_definitions`.

    Raise InputError if ``order`` is odd or below 4, if ``edges`` (the limits of blocks of states) do not increase from
    0 to the number of states, or if ``scales`` is not one number per block.
    """
    if order < 4 or order % 2:
        raise InputError(f"order of the Taylor method: expected an even number, at least 4, got {order}")
    system = recurrences(program)
    count = len(system.states)
    if [*edges[:1], *edges[-1:]] != [0, count] or list(edges) != sorted(set(edges)) or len(scales) != len(edges) - 1:
        raise InputError(
            f"blocks: expected block edges that increase from 0 to {count} (the number of states), and one scale for "
            f"each block, got edges {list(edges)} and scales {list(scales)}; a block is a group of consecutive states "
            "whose errors are measured together, relative to the scale of the block"
        )
    return system


def _table(items: Iterable[str]) -> str:
    return f"{{{', '.join(items)}}}"


def jet_source(layout: Layout, parameters: Sequence[str]) -> str:
    """Return the C functions ``symrot_constants`` and ``symrot_jet``, which computes the Taylor coefficients.

    ``layout`` says how the series are arranged in SIMD vectors.
    """
    return _Jet(layout, parameters).text()


class _Jet:
    """Writes the C function that computes the Taylor coefficients of series in SIMD vectors: coefficients 0, then 1, ..

    ``layout`` arranges the series in rows (vectors of four series) and columns (vectors of four convolutions
    ``sum(a[k] b[n-k])``). From n = 2 on, a C loop first adds up the terms k = 1 to n - 1 of column i, in the C variable
    ``a{i}`` for even n and ``b{i}`` for odd n.
    """

    def __init__(self, layout: Layout, parameters: Sequence[str]) -> None:
        self.layout, self.rows, self.parameters = layout, layout.rows, parameters
        self.state_rows, self.own_rows = len(layout.rates), len(layout.states)
        self.constants: dict[tuple[Node, ...], int] = {}
        self.packs: dict[Pack, int] = {}  # vectors of series whose coefficients are stored -> number in their C name
        self.stored: set[int] = set()  # rows, other than states, whose coefficients are stored
        for column in layout.columns:
            for pack in (column.a, column.b):
                if _is_row(pack) or _is_broadcast(pack):
                    self.stored |= {pack[0].row} - set(range(self.own_rows))
                else:
                    self.packs.setdefault(pack, len(self.packs))

    # -------------------------------------------------------------------------------------------- expressions

    def constant(self, weights: tuple[Node, ...]) -> str:
        return f"c[{self.constants.setdefault(weights, len(self.constants))}]"

    def at(self, pack: Pack, n: str) -> str:
        """Return the C expression that reads coefficient ``n`` (C text) of a pack, a vector of four series."""
        if pack in self.packs:
            return f"k{self.packs[pack]}[{n}]"
        row = f"{self._array(pack[0].row)}[{n}]"
        return row if _is_row(pack) else f"V_ALL(V_LANE({row}, {pack[0].lane}))"

    def _array(self, row: int) -> str:
        return f"x[{row}]" if row < self.own_rows else f"u{row}"

    def newest(self, pack: Pack) -> str:
        """Return the C expression for coefficient n, the newest, of each of the four series in a pack."""
        return f"l{self.packs[pack]}" if pack in self.packs else self.picked(pack)

    def picked(self, pack: Pack) -> str:
        """Return the C expression that gathers coefficient n, the newest, of each of the four series in a pack.

        The C variable ``r{i}`` has coefficient n of each series in row i.
        """
        rows = sorted({address.row for address in pack})
        if _is_row(pack):
            return f"r{rows[0]}"
        if len(rows) <= 2:
            lanes = ", ".join(str(a.lane + LANES * rows.index(a.row)) for a in pack)
            value = f"V_PICK(r{rows[0]}, r{rows[-1]}, {lanes})"
        else:
            value = f"V_SET({', '.join(f'V_LANE(r{a.row}, {a.lane})' for a in pack)})"
        signs = [address.sign for address in pack]
        if 0 in signs:
            value = f"V_KEEP({value}, {', '.join(str(abs(sign)) for sign in signs)})"
        return f"V_FLIP({value}, {', '.join('-1' if sign < 0 else '1' for sign in signs)})" if -1 in signs else value

    def column(self, index: int, stage: str, sums: str) -> str:
        """Return the C expression for coefficient n of the four convolutions in column ``index``.

        The text is empty if all four are zero. ``stage`` is "first" for n = 0, "second" for n = 1, else "later".
        From n = 2 on, ``sums`` is "a" for even n and "b" for odd n: the C variable ``a{index}`` or ``b{index}`` has
        the terms k = 1 to n - 1, to which this expression adds k = 0 and k = n.
        """
        a, b, ends = self.layout.columns[index]
        known = f"{sums}{index}" if stage == "later" else ""
        if ends == "none":
            return known
        if stage == "first":
            return f"V_MUL({self.at(a, '0')}, {self.at(b, '0')})" if ends == "both" else ""
        last = f"{self.newest(a)}, {self.at(b, '0')}"
        inner = f"V_FMA({last}, {known})" if known else f"V_MUL({last})"
        return f"V_FMA({self.at(a, '0')}, {self.newest(b)}, {inner})" if ends == "both" else inner

    def slot(self, columns: Sequence[int], stage: str, sums: str) -> str:
        parts = [part for part in (self.column(index, stage, sums) for index in columns) if part]
        total = parts[0] if parts else ""
        for part in parts[1:]:
            total = f"V_ADD({total}, {part})"
        return total

    # -------------------------------------------------------------------------------------------- rows

    def sum(self, row: Row, stage: str, sums: str, factor: str = "", fused: str = "V_FMA") -> str:
        """Return the C expression for coefficient n of the sums in ``row``: one sum of series and products per lane.

        The expression is multiplied by ``factor`` (C text; empty for 1). ``stage`` is "first" for n = 0, "second" for
        n = 1, else "later"; ``sums`` is, from n = 2 on, "a" for even n and "b" for odd n. ``fused`` is the C function
        that computes a b + c.
        """
        # terms that are computed last are added last, so that others need not wait
        value = ""
        parts = [(self.picked(term.pack), term.weights) for term in row.terms]
        parts += [(self.slot(slot.columns, stage, sums), slot.weights) for slot in reversed(row.slots)]
        if stage == "first" and row.constant is not None:
            value = self._weighted(row.constant, factor) or "V_ALL(1.0)"
        for part, weights in parts:
            if part:
                scale = self._weighted(weights, factor)
                if not scale:
                    value = f"V_ADD({part}, {value})" if value else part
                else:
                    value = f"{fused}({part}, {scale}, {value})" if value else f"V_MUL({part}, {scale})"
        return value or "V_ALL(0.0)"

    def _weights_of_time(self, row: Row) -> str:
        """Return the C text of a vector: the coefficient of the time in each of the four sums in ``row``.

        The row consists of four series that are sums and are computed together, in one SIMD vector. The text is empty
        if no sum contains the time. The time is t + t_low, a sum of two doubles; the C code of the sums contains t
        alone, and :meth:`row` adds t_low times this vector.
        """
        weights: list[Node] = []
        for number in row.lanes:
            series = None if number is None else self.layout.series[number]
            pairs = zip(series.operands, series.weights, strict=False) if series else ()
            own = [w for operand, w in pairs if w and self.layout.series[operand].rule == "time"]
            weights.append(own[0] if own else ZERO)
        return self.constant(tuple(weights)) if any(weight != ZERO for weight in weights) else ""

    def _weighted(self, weights: tuple[Node, ...], factor: str) -> str:
        """Return the C expression of ``factor`` times the vector of four constants ``weights``.

        The text ``""`` stands for 1, both as ``factor`` and as the result.
        """
        ones = all(weight == ONE for weight in weights)
        if ones:
            return factor
        constant = self.constant(weights)
        return f"V_MUL({constant}, {factor})" if factor else constant

    def row(self, number: int, n: str, stage: str, sums: str) -> list[str]:
        """Return the C statements that set the vector ``r{number}`` to coefficient n of the series in row ``number``.

        A row is a vector of up to four series. The index ``n`` is C text, ``stage`` is "first" for n = 0, "second" for
        n = 1, else "later"; ``sums`` is, from n = 2 on, "a" for even n and "b" for odd n.
        """
        row, name = self.rows[number], f"r{number}"
        terms = [self.picked(term.pack) for term in row.terms]
        total = self.slot(row.slots[0].columns, stage, sums) if row.slots else ""
        if row.rule == "product":
            return [f"{name} = {total};"]
        if row.rule == "sum":
            rest = self._weights_of_time(row) if stage == "first" else ""
            value = self.sum(row, stage, sums, fused="symrot_fused" if rest else "V_FMA")
            return [f"{name} = {f'V_FMA(V_ALL(t_low), {rest}, {value})' if rest else value};"]
        if row.rule == "time":
            value = {"first": "t", "second": "step[1]"}.get(stage, "0.0")
            return [f"{name} = V_ALL({value});"]
        if row.rule == "theta":
            count = {"first": "0.0", "second": "1.0"}.get(stage, f"(double)({n})")
            return [f"{name} = {terms[0]};" if stage == "second" else f"{name} = V_MUL({terms[0]}, V_ALL({count}));"]
        if row.rule == "quotient":
            return self._quotient(row, name, stage, terms, total)
        if row.rule == "clock":
            if stage == "first":
                return self._clock_seed(row, name)
            rates = self._weighted(row.terms[0].weights, f"V_ALL(step[{n}])")
            return [f"{name} = V_MUL({terms[0]}, {rates});"]
        if row.rule == "driven":
            if stage == "first":
                return [f"{name} = {self._seed(row)};"]
            share = f"V_MUL({total}, V_ALL(symrot_inverse[{n}]))"
            return [f"{name} = {total if stage == 'second' else share};"]
        if row.rule == "root":
            if stage == "first":
                return [f"{name} = {self._seed(row)};", f"d{number} = V_ADD({name}, {name});"]
            upper = f"V_SUB({terms[0]}, {total})" if total else terms[0]
            return [f"{name} = V_DIV({upper}, d{number});"]
        if stage == "first":  # primitive
            return [f"{name} = {self._seed(row)};", f"d{number} = {terms[0]};"]
        upper = f"V_SUB({terms[1]}, {total})" if total else terms[1]
        lower = f"d{number}" if stage == "second" else f"V_MUL(d{number}, V_ALL((double)({n})))"
        return [f"{name} = V_DIV({upper}, {lower});"]

    def _quotient(self, row: Row, name: str, stage: str, terms: list[str], total: str) -> list[str]:
        """Return the C statements that set the variable ``name`` to coefficient n of w = u/v: ``(u[n] - total)/v[0]``.

        ``terms`` are the C texts of v[n] and u[n], ``total`` is the C text of ``sum(v[k] w[n-k], k = 1..n)``.
        """
        # u[n] is missing if u is constant
        divisor, upper = f"d{name[1:]}", "V_ALL(0.0)"
        if len(terms) > 1:
            weights = self._weighted(row.terms[1].weights, "")
            upper = f"V_MUL({terms[1]}, {weights})" if weights else terms[1]
        if stage != "first":
            return [f"{name} = V_DIV(V_SUB({upper}, {total}), {divisor});"]
        if row.constant is not None and set(row.constant) != {ZERO}:
            upper = f"V_ADD({upper}, {self.constant(row.constant)})"
        # v[0] is stored for later orders
        return [f"{divisor} = {terms[0]};", f"{name} = V_DIV({upper}, {divisor});"]

    def _seed(self, row: Row) -> str:
        """Return the C expression for coefficient 0 of the functions in ``row``, one in each element of a SIMD vector.

        An example is ``V_SET(exp(..), exp(..), exp(..), exp(..))``.
        """
        first = {"driven": 2, "primitive": 3, "root": 0}[row.rule]
        lanes = []
        for series in row.lanes:
            assert series is not None
            s = self.layout.series[series]
            arguments = [self._lane_of(operand) for operand in s.operands[first:]]
            lanes.append(f"{s.function}({', '.join(arguments)})")
        if len(set(lanes)) == 1:
            return f"V_ALL({lanes[0]})"
        return f"V_SET({', '.join(lanes)})"

    def _clock_seed(self, row: Row, name: str) -> list[str]:
        """Return the C statements that set the C vector ``name`` to coefficient 0 of the four functions in ``row``.

        They are functions of a linear phase, such as sin(a t + b).
        """
        series = [self.layout.series[i] for i in row.lanes if i is not None]
        rates = self.constant(tuple(s.weights[0] for s in series))  # type: ignore[misc]
        offsets = self.constant(row.constant) if row.constant and set(row.constant) != {ZERO} else ""
        lines, turns = [], {}  # series with equal phases share one call
        for lane, s in enumerate(series):
            if s.weights not in turns:
                turn = turns[s.weights] = f"turn_{name}_{lane}"
                a, b = f"V_LANE({rates}, {lane})", f"V_LANE({offsets}, {lane})" if offsets else "0.0"
                lines.append(f"const dd {turn} = symrot_pair_turn({a}, {b}, t, t_low);")
            for function in (s.function, self.layout.series[s.operands[0]].function):
                value = f"const double {_of(function, turns[s.weights])} = {function}({turns[s.weights]}.hi);"
                lines += [value] if value not in lines else []
        lanes = []
        for s in series:
            turn, partner = turns[s.weights], self.layout.series[s.operands[0]].function
            sign = "-" if s.sign < 0 else "+"
            # the rounding error of a t + b is corrected to first order, with the slope of the function
            lanes.append(f"{_of(s.function, turn)} {sign} {turn}.lo*{_of(partner, turn)}")
        return [*lines, f"{name} = V_SET({', '.join(lanes)});"]

    def _lane_of(self, series: int) -> str:
        row, lane = next((r, row.lanes.index(series)) for r, row in enumerate(self.rows) if series in row.lanes)
        return f"V_LANE(r{row}, {lane})"

    def seeds(self) -> list[str]:
        """Return the C statements that compute the auxiliary states at the start of a step.

        Auxiliary states are functions of the attitude that are integrated like states. Their values at the start are
        coefficient 0 of their Taylor series.
        """
        lines: list[str] = []
        formulas = [formula for row in self.layout.seeds for formula in row]
        places = {name: f"V_LANE({self.constant((('symbol', name),) * LANES)}, 0)"
                  for name in self.parameters if any(name in names(formula) for formula in formulas)}  # fmt: skip
        for row, states in enumerate(self.layout.states):
            for lane, number in enumerate(states):
                if any(self.layout.names[number] in names(formula) for formula in formulas):
                    places[self.layout.names[number]] = f"y{number}"
                    lines.append(f"const double y{number} = V_LANE(x[{row}][0], {lane});")
        calls: dict[Node, str] = {}
        for formula in formulas:
            for call in _calls(formula):
                if call not in calls:
                    calls[call] = f"e{len(calls)}"
                    lines.append(f"const double {calls[call]} = {c_expression(rename(call, places))};")
        for row, seeds in enumerate(self.layout.seeds, start=self.own_rows):
            parts = [c_expression(rename(_with_calls(formula, calls), places)) for formula in seeds]
            lines.append(f"symrot_v4 r{row} = V_SET({', '.join([*parts, *['0.0'] * (LANES - len(parts))])});")
            if row in self.stored:
                lines.append(f"u{row}[0] = r{row};")
        return lines

    # -------------------------------------------------------------------------------------------- orders

    def order(self, n: str, stage: str, sums: str) -> list[str]:
        """Return the C statements that compute coefficient ``n`` of all series, then coefficient n + 1 of the states.

        ``n`` is the index as C text: ``"0"``, ``"1"``, ``"n"`` (an even index from 2 on) or ``"m"`` (an odd index from
        3 on). ``stage`` is "first" for the index 0, "second" for 1, else "later". ``sums`` is the first letter of the C
        variables that hold the sums of the terms k = 1 to n - 1 of the convolutions: "a" for ``"n"`` and "b" for
        ``"m"``. For 0 and 1, which have no such terms, ``sums`` is empty.
        """
        lines: list[str] = []
        done, packed = set(range(self.state_rows)), set[Pack]()

        def pack_what_is_there() -> Iterable[str]:
            for pack, index in self.packs.items():
                if pack not in packed and {address.row for address in pack} <= done:
                    packed.add(pack)
                    yield f"const symrot_v4 l{index} = {self.picked(pack)};"
                    yield f"k{index}[{n}] = l{index};"

        lines += pack_what_is_there()
        for number in range(self.state_rows, len(self.rows)):
            lines += self.row(number, n, stage, sums)
            if number in self.stored:
                lines.append(f"u{number}[{n}] = r{number};")
            done.add(number)
            lines += pack_what_is_there()
        following = {"0": "1", "1": "2", "n": "n + 1", "m": "m + 1"}[n]
        lines.append(f"const symrot_v4 s = V_ALL(step[{following}]);")
        for number, rate in enumerate(self.layout.rates):
            lines.append(f"const symrot_v4 x{number} = {self.sum(rate, stage, sums, 's')};")
        for number in range(self.state_rows):
            lines.append(f"r{number} = x{number};")
            if number < self.own_rows or number in self.stored:
                lines.append(f"{self._array(number)}[{following}] = r{number};")
        return lines

    def loops(self) -> list[str]:
        """Return the C loops that add up terms of all convolutions for two coefficients: n (even) and n + 1.

        The layout groups the convolutions by four: column i of the layout is a SIMD vector of four convolutions
        ``sum(a[k] b[n-k])``. For coefficient n, the loops set the C variable ``a{i}``, a vector, to the sums of the
        terms a[k] b[n-k] for k = 1 to n - 1. For coefficient n + 1, they set ``b{i}`` to the sums of the terms
        a[k] b[n+1-k] for k = 2 to n - 1; the terms k = 1 and k = n need coefficient n, which is still unknown.
        """
        # each number is read once for both coefficients
        lines: list[str] = []
        columns = self.layout.columns
        loops = -(-len(columns) // COLUMNS_PER_LOOP)
        for loop in range(loops):  # groups of similar size: a loop over one column waits for its own last addition
            group = range(loop * len(columns) // loops, (loop + 1) * len(columns) // loops)
            for i in group:
                a, b, _ = columns[i]
                lines.append(f"symrot_v4 h{i} = {self.at(b, 'n - 1')};")
                lines.append(f"symrot_v4 a{i} = V_MUL({self.at(a, '1')}, h{i}), b{i} = V_ALL(0.0);")
            lines.append("for (int64_t k = 2; k < n; k += 2) {")
            for i in group:  # column by column, because this needs only three registers besides those of the sums
                a, b, _ = columns[i]
                lines += [
                    f"    const symrot_v4 f{i} = {self.at(a, 'k')}, j{i} = {self.at(b, 'n - k')};",
                    f"    b{i} = V_FMA(f{i}, h{i}, b{i});",
                    f"    a{i} = V_FMA(f{i}, j{i}, a{i});",
                    f"    const symrot_v4 g{i} = {self.at(a, 'k + 1')};",
                    f"    h{i} = {self.at(b, 'n - k - 1')};",
                    f"    b{i} = V_FMA(g{i}, j{i}, b{i});",
                    f"    a{i} = V_FMA(g{i}, h{i}, a{i});",
                ]
            lines.append("}")
        return lines

    def completed_sums(self) -> list[str]:
        """Return the C statements that add the missing terms a[1] b[n] and a[n] b[1] to the sums ``b{i}``.

        The C variable ``b{i}`` has the sums, for coefficient n + 1, of the terms k = 1 to n of column i, a vector of
        four convolutions. The C loops of :meth:`loops` left out these two terms, because coefficient n was still
        unknown; it is known where these statements are placed.
        """
        lines: list[str] = []
        for i, (a, b, _) in enumerate(self.layout.columns):
            one, two = (self.at(a, "1"), self.at(b, "n")), (self.at(a, "n"), self.at(b, "1"))
            lines.append(f"b{i} = V_FMA({one[0]}, {one[1]}, V_FMA({two[0]}, {two[1]}, b{i}));")
        return lines

    def text(self) -> str:
        rows = range(len(self.rows))
        orders = {"0": self.order("0", "first", ""), "1": self.order("1", "second", ""),
                  "n": self.order("n", "later", "a"), "m": self.order("m", "later", "b")}  # fmt: skip
        divisors = [i for i in rows if self.rows[i].rule in ("quotient", "root", "primitive")]
        body = [
            "(void)c;",
            "(void)t;",
            "(void)t_low;",
            *(f"symrot_v4 k{i}[SYMROT_ORDER + 1];" for i in self.packs.values()),
            *(f"symrot_v4 u{i}[SYMROT_ORDER + 1];" for i in sorted(self.stored)),
            *(f"symrot_v4 r{i} = x[{i}][0];" for i in range(self.own_rows)),
            *self.seeds(),
            *(f"symrot_v4 r{i};" for i in range(self.state_rows, len(self.rows))),
            *(f"symrot_v4 d{i};" for i in divisors),
            "{", *_indented(orders["0"]), "}",
            "{", *_indented(orders["1"]), "}",
            # no loop over the order is unrolled, so that the code stays small
            "for (int64_t n = 2; n < order; n += 2) {",
            *_indented(["const int64_t m = n + 1;", *self.loops(), "{", *_indented(orders["n"]), "}",
                        *self.completed_sums(), "{", *_indented(orders["m"]), "}"]),
            "}",
        ]  # fmt: skip
        places = {name: f"p[{i}]" for i, name in enumerate(self.parameters)}
        values = [
            f"c[{index}] = V_SET({', '.join(c_expression(rename(weight, places)) for weight in weights)});"
            for weights, index in self.constants.items()
        ]
        return "\n".join([
            f"#define SYMROT_CONSTANTS {max(1, len(self.constants))}",
            "",
            "static void symrot_constants(const double *p, symrot_v4 *c)",
            "{",
            *_indented(["(void)p;", "(void)c;", *values]),
            "}",
            "",
            "/*",
            " * Fill x[row][1] to x[row][order], order even, from x[row][0], at t + t_low; step[n] is the unit of time",
            " * over n.",
            " */",
            "static SYMROT_APART void symrot_jet(const symrot_v4 *SYMROT_RESTRICT c, double t, double t_low,",
            "    const double *SYMROT_RESTRICT step, int64_t order, symrot_v4 (*SYMROT_RESTRICT x)[SYMROT_ORDER + 1])",
            "{",
            *_indented(body),
            "}",
        ]) + "\n"  # fmt: skip


def _of(function: str, turn: str) -> str:
    """Return the C name of a function's value at an angle ``turn``: ``sin`` and ``turn_r3_0`` give sin_turn_r3_0."""
    return f"{function}_{turn}"


def _calls(node: Node) -> list[Node]:
    """Return the outermost function calls in a formula: ``a*sin(exp(b)) + tan(c)`` gives sin(exp(b)) and tan(c)."""
    if node[0] == "call":
        return [node]
    return [call for child in children(node) for call in _calls(child)]


def _with_calls(node: Node, calls: Mapping[Node, str]) -> Node:
    """Return a formula in which each function call in ``calls`` becomes the symbol named ``calls[call]``.

    With ``{sin(q): "e0"}``, ``2*sin(q)`` gives ``2*e0``.
    """
    if node in calls:
        return ("symbol", calls[node])
    return with_children(node, [_with_calls(child, calls) for child in children(node)])


def _indented(lines: Iterable[str]) -> list[str]:
    return [f"    {line}" for line in lines]


def _is_row(pack: Pack) -> bool:
    return pack == tuple(Address(1, pack[0].row, lane) for lane in range(LANES))


def _is_broadcast(pack: Pack) -> bool:
    return set(pack) == {pack[0]} and pack[0].sign > 0
