"""Arrangement of the Taylor series of one motion in SIMD vectors of four elements, called lanes.

A row is a vector of up to four series that are computed together, by the same recurrence rule (such as "product"). A
pack is a vector of any four series, and a column the convolution of two packs. A slot is a sum of columns; the sum is
multiplied by a vector of four constants.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise, product
from typing import NamedTuple

from symrot.codegen.taylor.linear_forms import ONE, ZERO, split_sign
from symrot.codegen.taylor.recurrences import Recurrences, Series
from symrot.formula.tree import Node

__all__ = ["LANES", "Address", "Column", "Layout", "Pack", "Row", "Slot", "Term", "cost", "lay_out"]

LANES = 4
MOST_USES = (1, 2)  # a product in at most this many sums is computed in each of them; the faster layout is used


class Address(NamedTuple):
    """The place of a Taylor series, with a sign as factor: one element (``lane``) of the SIMD vector number ``row``."""

    sign: int  # 1, -1, or 0 for the value zero
    row: int
    lane: int


# if all four are the same, the series is read as one number for all lanes (broadcast) and needs no storage
Pack = tuple[Address, ...]  # a vector of four series, each given by its address
_Pair = tuple[tuple[int, int], tuple[int, int]]  # two factors, each given by its sign and the index of its series


class Column(NamedTuple):
    """Four convolutions ``sum(a[k] b[n-k])``, one in each lane of the packs (vectors of four series) a and b."""

    a: Pack
    b: Pack
    ends: str  # which of the terms k = 0 and k = n are included: both, last (k = n) or none; always k = 1 to n - 1


class Slot(NamedTuple):
    """A sum of columns (vectors of four convolutions), multiplied by a vector of four constants, ``weights``."""

    columns: tuple[int, ...]  # indices
    weights: tuple[Node, ...]


class Term(NamedTuple):
    """One term of a vector of four sums: four series (``pack``), each multiplied by its own constant of ``weights``."""

    pack: Pack
    weights: tuple[Node, ...]


class Row(NamedTuple):
    """Up to four series with the same recurrence rule that are computed together, one in each lane of a SIMD vector."""

    rule: str  # see symrot.codegen.taylor.recurrences
    lanes: tuple[int | None, ...]  # indices of the series; None for an unused lane, whose value is zero
    slots: tuple[Slot, ...] = ()  # in a sum, the summands that are products; else the convolutions of the rule
    terms: tuple[Term, ...] = ()  # in a sum, the other summands; else the operands of the rule
    constant: tuple[Node, ...] | None = None  # in a sum, added to coefficient 0


class Layout(NamedTuple):
    """The series of a system, arranged in rows: vectors of up to four series that are computed together."""

    series: tuple[Series, ...]
    rows: tuple[Row, ...]  # in order of computation: states, auxiliary states, other series
    rates: tuple[Row, ...]  # the time derivatives of each row of states or auxiliary states
    columns: tuple[Column, ...]
    states: tuple[tuple[int, ...], ...]  # the indices of the states in each row of states
    names: tuple[str, ...]  # names of the states
    seeds: tuple[tuple[Node, ...], ...] = ()  # formulas of the auxiliary states at the start of a step, by row


def lay_out(system: Recurrences, edges: Sequence[int]) -> Layout:
    """Return the arrangement of the Taylor series of a system in SIMD vectors of four.

    Block j of states, from ``edges[j]`` to ``edges[j + 1] - 1``, shares no vector with another block.
    """
    bundled = _with_bundles(system)
    # a product that occurs in two sums is computed once, or once in each sum, whichever costs less
    return min((_Placer(bundled, edges, uses).layout() for uses in MOST_USES), key=cost)


def cost(layout: Layout) -> int:
    """Return an estimate of the time that one coefficient of all series takes: number of columns plus number of rows.

    A column is a vector of four convolutions, a row a vector of up to four series.
    """
    return len(layout.columns) + len(layout.rows)


def _with_bundles(system: Recurrences) -> Recurrences:
    """Return a system in which products that occur together in several sums are added up once, as one more series.

    If ``a*b - c*d`` occurs in two sums, it becomes a series that both sums contain.
    """
    series = list(system.series)
    sums = [(i, s) for i, s in enumerate(series) if s.rule == "sum"]
    sums += [(-1 - i, rate) for i, rate in enumerate(system.rates)]
    elsewhere = {i for s in series if s.rule != "sum" for i in s.operands}
    uses: dict[int, list[tuple[int, int, Node]]] = {}
    for name, s in sums:
        for operand, weight in zip(s.operands, s.weights, strict=False):
            if series[operand].rule == "product" and operand not in elsewhere:
                uses.setdefault(operand, []).append((name, *split_sign(weight)))  # type: ignore[arg-type]
    bundles: dict[tuple[object, ...], list[tuple[int, int]]] = {}
    for operand, used in uses.items():
        if len(used) > 1:
            turn = used[0][1]
            key = tuple((name, sign * turn, weight) for name, sign, weight in used)
            bundles.setdefault(key, []).append((operand, turn))
    swap: dict[int, tuple[int, int]] = {}  # product -> the sum that replaces it, and its sign (0: without replacement)
    for members in bundles.values():
        if len(members) > 1:
            signs = [ONE if sign > 0 else ("neg", ONE) for _, sign in members]
            new = len(series)
            series.append(Series("sum", tuple(operand for operand, _ in members), (*signs, None)))
            swap.update({operand: (new, sign if k == 0 else 0) for k, (operand, sign) in enumerate(members)})

    def bundled(s: Series) -> Series:
        operands: list[int] = []
        weights: list[Node | None] = []
        for operand, weight in zip(s.operands, s.weights, strict=False):
            into, sign = swap.get(operand, (operand, 1))
            if sign:
                operands.append(into)
                weights.append(weight if sign > 0 else ("neg", weight))
        return s._replace(operands=tuple(operands), weights=(*weights, s.weights[-1]))

    series_in_place = [bundled(s) if s.rule == "sum" and i < len(system.series) else s for i, s in enumerate(series)]
    return system._replace(series=tuple(series_in_place), rates=tuple(map(bundled, system.rates)))


class _Placer:
    """Assigns the series of a system to rows (vectors of up to four series), and products of series to columns."""

    def __init__(self, system: Recurrences, edges: Sequence[int], most_uses: int) -> None:
        self.system, self.series = system, system.series
        self.rows: list[Row] = []
        self.columns: list[Column] = []
        self.place: dict[int, Address] = {}
        numbers = {s.number: i for i, s in enumerate(self.series) if s.rule == "state"}
        count = edges[-1]
        self.state_rows = [
            tuple(range(first, min(first + LANES, high)))
            for low, high in pairwise([*edges, count + len(system.seeds)])
            for first in range(low, high, LANES)
        ]
        self.companion_rows = [states for states in self.state_rows if states[0] >= count]
        for states in self.state_rows:
            self.put(Row("state", tuple(numbers.get(s) for s in states)))
        self.inlined = self._inlined(most_uses)
        self.levels: dict[int, int] = {}

    def put(self, row: Row) -> None:
        lanes = (*row.lanes, *(None,) * (LANES - len(row.lanes)))
        for lane, series in enumerate(lanes):
            if series is not None:
                self.place.setdefault(series, Address(1, len(self.rows), lane))
        self.rows.append(row._replace(lanes=lanes))

    def _inlined(self, most_uses: int) -> set[int]:
        """Return the indices of the products of two series that are computed only as summands of sums.

        A product is one of them if only sums contain it, and at most ``most_uses`` sums.
        """
        count: dict[int, int] = {}
        for s in (*self.series, *self.system.rates):
            for operand in s.operands:
                if self.series[operand].rule == "product":
                    count[operand] = count.get(operand, 0) + (1 if s.rule == "sum" else most_uses + 1)
        # for a product in few sums, this costs less than to compute it in a row, store it and add it
        return {operand for operand, uses in count.items() if uses <= most_uses}

    def level(self, i: int) -> int:
        """Return how many series must be computed one after the other to obtain series ``i``; 0 for a state."""
        # for one coefficient n; the series of one row have equal levels, because none of them may need another one
        if i not in self.levels:
            s = self.series[i]
            older = {"driven": (1,), "primitive": (1,), "clock": (0,)}.get(s.rule, ())  # operands used up to n - 1 only
            waits = [operand for k, operand in enumerate(s.operands) if k not in older]
            deepest = max((self.level(operand) for operand in waits), default=0)
            self.levels[i] = 0 if s.rule == "state" else deepest if i in self.inlined else 1 + deepest
        return self.levels[i]

    def layout(self) -> Layout:
        waiting = [i for i, s in enumerate(self.series) if s.rule != "state" and i not in self.inlined]
        waiting.sort(key=lambda i: (self.level(i), self.series[i].rule, *self._shape(i), i))
        groups: list[list[int]] = []
        for i in waiting:
            kind = (self.level(i), self.series[i].rule)
            last = groups[-1] if groups else []
            if last and len(last) < LANES and kind == (self.level(last[0]), self.series[last[0]].rule):
                last.append(i)
            else:
                groups.append([i])
        for group in groups:  # every lane gets a series, so that no lane divides by zero
            self.put(Row(self.series[group[0]].rule, tuple(group + [group[-1]] * (LANES - len(group)))))
        for number in range(len(self.state_rows), len(self.rows)):
            self.rows[number] = self._filled(self.rows[number])
        rates = []
        for states in self.state_rows:
            sums = [self.system.rates[s] for s in states]
            rates.append(self._sum_row((*(None for _ in range(LANES)),), [*sums, *[None] * (LANES - len(sums))]))
        count = len(self.system.states)
        seeds = tuple(tuple(self.system.seeds[number - count] for number in numbers) for numbers in self.companion_rows)
        own = tuple(self.state_rows[: len(self.state_rows) - len(seeds)])
        return Layout(self.series, tuple(self.rows), tuple(rates), tuple(self.columns), own, self.system.states, seeds)

    def _shape(self, i: int) -> tuple[int, ...]:
        """Return the key by which series with the same rule are sorted, so that similar series share a SIMD vector.

        The key of series ``i`` is (1 if it is an exponential else 0, -m), where m is the number of its operands that
        are products computed only as summands of sums (see :meth:`_inlined`).
        """
        s = self.series[i]
        products = sum(operand in self.inlined for operand in s.operands)
        # exponentials come after pairs such as sine and cosine
        return (s.function == "exp", -products)

    # -------------------------------------------------------------------------------------------- packs

    def pack(self, items: Sequence[tuple[int, int] | None]) -> Pack:
        """Return a pack, a vector of four series, for four ``items``: pairs (sign, index of a series) or None.

        None stands for an element whose value does not matter: it is read from the SIMD vector of the first pair, so
        that no further vector is needed.
        """
        addresses = [None if item is None else self.address(*item, lane) for lane, item in enumerate(items)]
        first = next(address for address in addresses if address is not None)
        if (
            len({address for address in addresses if address is not None}) == 1
            and len(addresses) - addresses.count(None) > 1
        ):
            return (first,) * LANES
        return tuple(Address(1, first.row, lane) if a is None else a for lane, a in enumerate(addresses))

    def address(self, sign: int, series: int, lane: int) -> Address:
        """Return where to read ``series`` (an index): its row and lane, with the factor ``sign``.

        A row may have the series in several lanes; ``lane`` is then preferred, so that no permutation is needed.
        """
        first = self.place[series]
        return Address(sign, first.row, lane if self.rows[first.row].lanes[lane] == series else first.lane)

    def column(self, pairs: Sequence[_Pair | None], ends: str, needed: Sequence[bool] = ()) -> int:
        """Add a column, a vector of four convolutions ``sum(a[k] b[n-k])``, and return the index of the new column.

        ``pairs[i]`` are the two series a and b of lane i, each as (sign, index). None stands for no convolution: lane i
        then has the value zero if ``needed[i]``, otherwise any value. ``ends`` says which of the terms ``a[0] b[n]``
        and ``a[n] b[0]`` are included: ``"both"``, ``"last"`` (only the second) or ``"none"``.
        """
        a = self.pack([None if pair is None else pair[0] for pair in pairs])
        b = self.pack([None if pair is None else pair[1] for pair in pairs])
        empty = [pair is None and need for pair, need in zip(pairs, needed, strict=False)]
        if any(empty):
            b = tuple(b[lane]._replace(sign=0) if empty[lane] else b[lane] for lane in range(LANES))
        self.columns.append(Column(a, b, ends))
        return len(self.columns) - 1

    # -------------------------------------------------------------------------------------------- rows

    def _filled(self, row: Row) -> Row:
        lanes = [self.series[i] for i in row.lanes if i is not None]
        own = [i for i in row.lanes if i is not None]

        def operand(number: int) -> Term:
            return Term(self.pack([(1, s.operands[number]) for s in lanes]), (ONE,) * LANES)

        def one(pairs: list[_Pair], ends: str) -> tuple[Slot, ...]:
            return (Slot((self.column(pairs, ends),), (ONE,) * LANES),)

        if row.rule == "sum":
            return self._sum_row(row.lanes, lanes)
        if row.rule == "product":
            return row._replace(slots=one([((1, s.operands[0]), (1, s.operands[1])) for s in lanes], "both"))
        if row.rule == "theta":
            return row._replace(terms=(operand(0),))
        if row.rule == "quotient":
            pairs = [((1, s.operands[-1]), (1, i)) for s, i in zip(lanes, own, strict=True)]
            top = [None if len(s.operands) == 1 else (1, s.operands[0]) for s in lanes]
            weights = tuple(ZERO if item is None else ONE for item in top)
            terms = [Term(self.pack(top), weights)] if any(top) else []
            constant = tuple(ONE if item is None else ZERO for item in top)
            return row._replace(slots=one(pairs, "last"), terms=(operand(-1), *terms), constant=constant)
        if row.rule == "root":
            return row._replace(slots=one([((1, i), (1, i)) for i in own], "none"), terms=(operand(0),))
        if row.rule == "driven":
            pairs = [((s.sign, s.operands[0]), (1, s.operands[1])) for s in lanes]
            return row._replace(slots=one(pairs, "last"))
        if row.rule == "primitive":
            pairs = [((1, s.operands[1]), (1, s.operands[2])) for s in lanes]
            return row._replace(slots=one(pairs, "none"), terms=(operand(2), operand(0)))
        if row.rule == "clock":
            rates = tuple(s.weights[0] if s.sign > 0 else ("neg", s.weights[0]) for s in lanes)
            offsets = tuple(ZERO if s.weights[1] is None else s.weights[1] for s in lanes)
            return row._replace(terms=(operand(0)._replace(weights=rates),), constant=offsets)  # type: ignore[arg-type]
        return row

    def _sum_row(self, lanes: tuple[int | None, ...], sums: Sequence[Series | None]) -> Row:
        slots: list[list[tuple[Node, list[tuple[int, int]]]]] = []  # per lane: weight, signed products
        lines: list[list[tuple[Node, int]]] = []
        for s in sums:
            products: dict[Node, list[tuple[int, int]]] = {}
            line = []
            for operand, weight in zip(s.operands, s.weights, strict=False) if s is not None else ():
                assert weight is not None
                if operand in self.inlined:
                    sign, size = split_sign(weight)
                    products.setdefault(size, []).append((sign, operand))
                else:
                    line.append((weight, operand))
            slots.append(sorted(map(_first_positive, products.items()), key=lambda item: -len(item[1])))
            lines.append(line)
        constants = tuple(ZERO if s is None or s.weights[-1] is None else s.weights[-1] for s in sums)
        made = []
        for depth in range(max(map(len, slots))):
            held = [slot[depth] if depth < len(slot) else (ZERO, []) for slot in slots]
            made.append(Slot(tuple(self._columns([terms for _, terms in held])), tuple(w for w, _ in held)))
        terms = []
        for depth in range(max(map(len, lines))):
            at = [line[depth] if depth < len(line) else None for line in lines]
            pack = self.pack([None if item is None else (1, item[1]) for item in at])
            terms.append(Term(pack, tuple(ZERO if item is None else item[0] for item in at)))
        return Row("sum", lanes, tuple(made), tuple(terms), None if set(constants) == {ZERO} else constants)

    def _columns(self, lanes: list[list[tuple[int, int]]]) -> Iterable[int]:
        """Add columns (vectors of four convolutions) that compute all products in ``lanes``; yield the column indices.

        ``lanes[i]`` are the products to add up in lane i, as (sign, index of the product). A column computes one
        product in each of the four lanes.
        """
        rest = [[(sign, self.series[p].operands[0], self.series[p].operands[1]) for sign, p in lane] for lane in lanes]
        needed = [bool(lane) for lane in lanes]
        while any(rest):
            # a factor in every lane that still has products is broadcast to all lanes as one number
            shared = self._shared([lane for lane in rest if lane])
            picked: list[_Pair | None] = []
            if shared is None:
                yield self._mixed([lane.pop(0) if lane else None for lane in rest], needed)
                continue
            for lane in rest:
                term = next((term for term in lane if shared in term[1:]), None)
                if term is None:
                    picked.append(None)
                    continue
                lane.remove(term)
                sign, u, v = term
                picked.append(((1, shared), (sign, v if u == shared else u)))
            yield self.column(picked, "both", needed)

    def _shared(self, lanes: list[list[tuple[int, int, int]]]) -> int | None:
        """Return the lowest index of a series that is a factor in every lane, or None if there is no such series.

        Each lane is a list of products (sign, u, v) with the indices u and v of their factors. For one lane the result
        is None.
        """
        if len(lanes) < 2:
            return None
        common = set.intersection(*({u for _, *pair in lane for u in pair} for lane in lanes))
        return min(common, default=None)

    def _mixed(self, terms: list[tuple[int, int, int] | None], needed: Sequence[bool]) -> int:
        """Add a column (vector of four convolutions) with the product ``terms[i]`` in lane i, and return its index.

        A product is (sign, u, v) with the indices of two series, or None. A lane with None has the value zero if
        ``needed[i]``, otherwise any value.
        """
        known = {pack for column in self.columns for pack in (column.a, column.b)}
        whole = {tuple(Address(1, row, lane) for lane in range(LANES)) for row in range(len(self.rows))}
        best: tuple[int, list[_Pair | None]] | None = None
        # each product is written as u v or as v u, so that both packs (of first and of second factors) are, if
        # possible, already in use in other columns
        for turns in product((False, True), repeat=sum(term is not None for term in terms)):
            turn = iter(turns)
            pairs: list[_Pair | None] = []
            for term in terms:
                if term is None:
                    pairs.append(None)
                    continue
                sign, u, v = term
                u, v = (v, u) if next(turn) else (u, v)
                pairs.append(((1, u), (sign, v)))
            sides = [self.pack([None if pair is None else pair[side] for pair in pairs]) for side in (0, 1)]
            score = sum((side in known) + 2 * (side in whole or len(set(side)) == 1) for side in sides)
            if best is None or score > best[0]:
                best = score, pairs
        assert best is not None
        return self.column(best[1], "both", needed)


def _first_positive(item: tuple[Node, list[tuple[int, int]]]) -> tuple[Node, list[tuple[int, int]]]:
    """Return (weight, [(sign, product), ..]), that is ``weight*sum(sign*product)``, so that the first sign is positive.

    ``(a, [(-1, u), (1, v)])`` gives ``(-a, [(1, u), (-1, v)])``.
    """
    # so -a*(u v - w x) and a*(w x - u v) are recognised as equal if their products are listed in the same order
    weight, terms = item
    return item if terms[0][0] > 0 else (("neg", weight), [(-sign, operand) for sign, operand in terms])
