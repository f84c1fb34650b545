"""The search for events: all times at which a formula of the motion is zero, located to the last bits.

The search in C bounds the formula on intervals, so that it misses no zero. A *piece* is a group of consecutive
polynomials of the motion; an *entry* is an interval that may contain a zero; a *doubt* is an extremum nearer to zero
than the motion's error.
"""

import ctypes
from bisect import bisect, insort
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import PropagationError
from symrot.propagation.events.event import Event
from symrot.propagation.events.library import search_library
from symrot.propagation.events.polynomials import HEAD, Piece

__all__ = ["EventZero", "SearchResult", "ZerosNotSeparated", "search", "signs_at_ends"]

Floats = NDArray[np.float64]
NEAR = 64 * float(np.finfo(float).eps)  # relative distance in time below which two entries are joined
FIELDS = 6  # numbers in one entry of events.c
ROOM = 1024  # entries per call
LONG = 1e-3  # part of the motion: a formula that is zero for longer than this, up to an end, has no event there
OPERATIONS_PER_CALL = 5e6  # operations in some 20 ms, after which Python can react to an interrupt
MOST_OPERATIONS, OPERATIONS_PER_ROW = 4e9, 2e5  # operations allowed for a search; each row of a motion adds to them
MOST_ENTRIES = 500_000
STATE_ERROR = 4 * float(np.finfo(float).eps)  # relative rounding error of a state in the C source


class ZerosNotSeparated(PropagationError):
    """Raised if the search cannot separate neighbouring zeros within its limits of operations and intervals.

    The search ends at the time ``t``, s: the zeros of ``formulas`` before t, in the order of the motion, are known and
    stored as ``zeros``; those beyond t are not. ``effort`` says how many operations and intervals the search has used.
    """

    def __init__(self, t: float, formulas: Sequence[str], effort: str) -> None:
        named = ", ".join(map(repr, formulas))
        super().__init__(
            f"events: expected formulas whose zeros can be separated, but beyond t = {t!r} s the zeros of {named} are "
            f"not separated after {effort}"
        )
        self.t, self.formulas, self.effort = t, formulas, effort
        self.zeros: list[EventZero] = []

    def later(self, epoch: float) -> "ZerosNotSeparated":
        """Return the error with its time t converted to scene time, by adding ``epoch``, s."""
        later = ZerosNotSeparated(self.t + epoch, self.formulas, self.effort)
        later.zeros = self.zeros
        return later


class EventZero(NamedTuple):
    """A zero of an event's formula: index of the event, time, s, and ``"rising"``, ``"falling"`` or ``"touching"``."""

    event: int
    t: float
    kind: str


class _Search:
    """A search for events along one motion: its state in C, and the number of its operations so far."""

    def __init__(self, path: Path | str, p: Sequence[float], formulas: Sequence[str], error: float = 0.0) -> None:
        # error: of the states, relative to their sizes
        self.library, self.formulas, self.doubt = search_library(str(path)), formulas, error / STATE_ERROR
        self.p = (ctypes.c_double * len(p))(*p)
        self.state = ctypes.create_string_buffer(self.library.bytes)
        self.arrived: set[tuple[int, float]] = set()  # events that are zero at an edge of a piece, with the time
        self.flat: list[tuple[int, float, float]] = []  # events that are zero for long, from one time to another
        self.doubts: list[tuple[int, float]] = []  # events nearer to zero than the motion's error, with times
        self.again, self.spent, self.allowed = False, 0.0, MOST_OPERATIONS

    def entries(self, piece: Piece) -> tuple[list[list[float]], ZerosNotSeparated | None]:
        """Return the intervals in ``piece``, a part of the motion, that may contain zeros, and an error or None.

        An interval is [event, start, end, sign before, sign after]. If the limit of operations or intervals is
        exceeded, the intervals reach only to the time of the error.
        """
        edges, rows = np.ascontiguousarray(piece.edges), np.ascontiguousarray(piece.rows)
        count, listed, answer = len(rows), [], (ctypes.c_int64 * 3)()
        self.allowed += OPERATIONS_PER_ROW * count * self.library.events
        self.library.begin(
            self.state,
            rows.ctypes.data,
            self.terms(rows),
            edges.ctypes.data,
            count,
            ctypes.addressof(self.p),
            self.doubt,
            self.again,
        )
        self.again = True
        batch = np.empty((ROOM, FIELDS))
        while not answer[1]:
            self.spent += self.library.next(self.state, batch.ctypes.data, ROOM, OPERATIONS_PER_CALL, answer)
            listed += batch[: answer[0]].tolist()
            if self.spent > self.allowed or len(listed) > MOST_ENTRIES:
                t = float(edges[min(answer[2], count)])
                effort = f"{self.spent:.1g} operations and {len(listed)} entries"
                side = 1.0 if edges[-1] >= edges[0] else -1.0
                known = [entry[:5] for entry in listed if side * (entry[2] - t) <= 0.0 and not entry[5]]
                return known, ZerosNotSeparated(t, self.formulas, effort)
        # an extremum nearer to zero than the motion's error gives no interval
        self.doubts += [(int(entry[0]), entry[1]) for entry in listed if entry[5]]
        return [entry[:5] for entry in listed if not entry[5]], None

    def terms(self, rows: Floats) -> int:
        """Return the number of coefficients of each polynomial in ``rows`` (one row per step), its degree plus 1."""
        count: int = (rows.shape[1] - HEAD) // self.library.states
        return count

    def sign(self, event: int, t: float, piece: Piece) -> int:
        """Return the sign of an event's formula at the time t, which lies in ``piece``, a part of the motion.

        The sign is 0 if rounding errors are larger than the value, or if the formula has no value at t.
        """
        sign = self.sign_or_none(event, t, piece)
        return 0 if sign is None else sign

    def sign_or_none(self, event: int, t: float, piece: Piece) -> int | None:
        """Return the sign of an event's formula at the time t, which lies in ``piece``, a part of the motion.

        The sign is 0 if rounding errors are larger than the value. Return None if the formula has no value at t, as the
        root of a negative number.
        """
        edges, side = piece.edges, 1.0 if piece.edges[-1] >= piece.edges[0] else -1.0
        place = int(np.searchsorted(side * edges, side * t, "left")) - 1
        row = np.ascontiguousarray(piece.rows[min(max(place, 0), len(piece.rows) - 1)])
        value: int = self.library.sign(event, t, row.ctypes.data, self.terms(piece.rows), ctypes.addressof(self.p))
        return None if value == 2 else value


class SearchResult(NamedTuple):
    """Zeros of events along a motion.

    Attributes
    ----------
    zeros : list of EventZero
        The zeros, in the order of the motion.
    stop : float or None
        Time of the terminal event, s; None if the motion did not reach one.
    doubts : list of (int, float)
        Index of the event and time, s, for each extremum whose distance from zero is less than the error of the motion:
        whether the formula touches zero there, crosses it twice or misses it is not known.
    flat : list of (int, float, float)
        Index of the event and two times, s, between which its formula is zero within rounding, without an event.
    """

    zeros: list[EventZero]
    stop: float | None
    doubts: list[tuple[int, float]]
    flat: Sequence[tuple[int, float, float]] = ()


def search(
    path: Path | str, events: Sequence[Event], p: Sequence[float], pieces: Iterable[Piece], t0: float,
    error: float = 0.0, y0: Sequence[float] | None = None,
    y1: Callable[[], Sequence[float] | None] = lambda: None,
) -> SearchResult:  # fmt: skip
    """Return the zeros of events along a motion, up to the terminal event if there is one.

    Parameters
    ----------
    path : Path
        The library of :func:`event_library_source` for these events.
    p : sequence of float
        Values of the parameters of the kernel in the library.
    pieces : iterable of Piece
        Consecutive pieces of the motion from t0 on, as polynomials (:mod:`symrot.propagation.events.polynomials`). The
        search takes pieces until it finds a terminal event.
    error : float
        Error of the states, relative to their sizes. An extremum that this error may move past zero is listed in
        ``doubts`` of the result.
    y0 : sequence of float, optional
        The exact states at t0, passed if the polynomials of ``pieces`` reproduce them only up to rounding errors.
    y1 : function, optional
        Returns the exact states at the end of the last piece, or None if the motion stopped early; called after the
        search.

    Raises
    ------
    ZerosNotSeparated
        If the limit of operations, which grows with the number of steps, is too low to separate the zeros.
    """
    searcher = _Search(path, p, [event.formula for event in events], error)
    left = [int(event.terminal) for event in events]
    zeros: list[EventZero] = []
    held: list[list[float]] = []  # candidates at the last edge, which may continue in the next piece
    previous: Piece | None = None
    for piece in pieces:
        if not len(piece.rows):
            continue
        own, early = searcher.entries(piece)
        entries = held + own
        for entry in entries:  # a zero from the first edge on: the piece before tells the sign before it
            if previous is not None and not entry[3] and entry[1] == float(piece.edges[0]):
                entry[3] = _sign_before_end(searcher, int(entry[0]), previous)
                searcher.arrived.add((int(entry[0]), entry[1]))
        last = float(piece.edges[-1])
        if previous is None and y0 is not None:
            known = {int(entry[0]) for entry in entries if entry[1] == t0}
            entries += _zeros_at(searcher, set(range(len(events))) - known, t0, y0)
        whole, held = _merged(entries, last)
        # a zero at t0 is listed but does not end the motion; the sign just after it makes it rising or falling
        stop = _settled(searcher, piece, events, whole, t0, left, zeros)
        if stop is not None:
            before = [(event, t) for event, t in searcher.doubts if abs(t - t0) < abs(stop - t0)]
            return SearchResult(zeros, stop, _open_doubts(before, zeros, t0), searcher.flat)
        if early is not None:
            early.zeros = zeros
            raise early
        previous = piece
    if previous is not None and (at_end := y1()) is not None:
        last = float(previous.edges[-1])
        near = NEAR * abs(last - t0)
        known = {int(entry[0]) for entry in held} | {zero.event for zero in zeros if abs(zero.t - last) <= near}
        held += _zeros_at(searcher, set(range(len(events))) - known, last, at_end)
    stop = _settled(searcher, previous, events, held, t0, left, zeros) if previous is not None and held else None
    return SearchResult(zeros, stop, _open_doubts(searcher.doubts, zeros, t0), searcher.flat)


def _zeros_at(searcher: _Search, events: Iterable[int], t: float, y: Sequence[float]) -> list[list[float]]:
    """Return an interval for each of the ``events`` whose formula is zero, up to rounding, at time t and states y.

    The interval is [event, t, t, 0, 0]: it begins and ends at t, and the signs before and after are not known.
    """
    # a fitted polynomial is zero there only up to rounding: a body at rest got a tiny velocity
    still = Piece(np.array([t, t + 1.0]), np.array([[t, 1.0, 0.0, 1.0, *y]]))
    return [[float(event), t, t, 0.0, 0.0] for event in sorted(events) if searcher.sign_or_none(event, t, still) == 0]


def _open_doubts(doubts: list[tuple[int, float]], zeros: list[EventZero], t0: float) -> list[tuple[int, float]]:
    """Return the ``doubts``, each once, without those that are also listed as zeros.

    A doubt is a pair (event, time) of an extremum so close to zero that the error of the motion matters.
    """
    settled: dict[int, list[float]] = {}
    for zero in zeros:
        if zero.kind == "touching" or zero.t == t0:
            insort(settled.setdefault(zero.event, []), zero.t)
    own: list[tuple[int, float]] = []
    for event, t in sorted(doubts, key=lambda doubt: (doubt[0], abs(doubt[1] - t0))):
        times = settled.setdefault(event, [])
        place = bisect(times, t)
        if all(abs(t - other) > 4 * NEAR * max(abs(t), abs(other)) for other in times[max(place - 1, 0) : place + 1]):
            times.insert(place, t)
            own.append((event, t))
    return own


def signs_at_ends(
    path: Path | str, formulas: Sequence[str], p: Sequence[float], piece: Piece
) -> tuple[list[int], list[int]]:
    """Return two lists: the signs of formulas just after the start of ``piece``, a part of a motion, and at its end.

    ``path`` is the compiled library with the search for zeros of these formulas, ``p`` are the values of the parameters
    that the library expects.

    A sign is 0 if the value is smaller than its rounding errors.
    """
    searcher, numbers = _Search(path, p, formulas), range(len(formulas))
    last = float(piece.edges[-1])
    return [_first_sign(searcher, number, piece) for number in numbers], [
        searcher.sign(n, last, piece) for n in numbers
    ]


def _first_sign(searcher: _Search, number: int, piece: Piece) -> int:
    """Return the sign (1, -1, 0) of formula ``number`` just after the start of a piece of the motion."""
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    width, side = 4 * NEAR * max(abs(first), abs(last - first)), 1.0 if last >= first else -1.0
    before = 0
    # the value may be zero at the start itself: the sign has to agree at two distances, one twice the other
    while width < abs(last - first):
        sign = searcher.sign(number, first + side * width, piece)
        if sign and sign == before:
            return sign
        before = sign
        width *= 2
    return before


def _merged(entries: list[list[float]], last: float) -> tuple[list[list[float]], list[list[float]]]:
    """Join adjacent intervals that may contain zeros; return the complete intervals, and those that may continue.

    An interval is a list [event, start, end, sign before, sign after]. It may continue in the next piece of the motion
    if it ends at ``last``, the end of the present piece, and the sign of the formula after it is 0.
    """
    whole: list[list[float]] = []
    open_ones: dict[float, list[float]] = {}
    side = 1.0 if not entries or last >= min(entry[1] for entry in entries) else -1.0
    for entry in sorted(entries, key=lambda entry: (entry[0], side * entry[1], side * entry[2])):
        before = open_ones.get(entry[0])
        if (
            before is not None
            and side * (entry[1] - before[2]) <= NEAR * abs(last)
            and (before[4] == 0 or entry[3] == 0 or (before[3] == before[4] == entry[3] == entry[4]))
        ):
            before[2] = max(before[2], entry[2], key=lambda t: side * t)
            before[4] = entry[4]
            before[3] = before[3] or 0.0
            continue
        open_ones[entry[0]] = entry
        whole.append(entry)
    at_end = [entry for entry in whole if entry[4] == 0 and abs(entry[2] - last) <= NEAR * abs(last)]
    return [entry for entry in whole if entry not in at_end], at_end


def _sign_before_end(searcher: _Search, event: int, piece: Piece) -> int:
    """Return the sign of an event's formula just before the end of ``piece``, a part of a motion.

    The sign is 0 if the values are smaller than their rounding errors in the whole of ``piece``.
    """
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    width, side = 4 * NEAR * max(abs(last), abs(last - first)), 1.0 if last >= first else -1.0
    while width < abs(last - first):
        sign = searcher.sign(event, last - side * width, piece)
        if sign:
            return sign
        width *= 2
    return 0


def _settled(
    searcher: _Search, piece: Piece, events: Sequence[Event], entries: list[list[float]], t0: float, left: list[int],
    zeros: list[EventZero],
) -> float | None:  # fmt: skip
    """Append the zeros in ``entries`` to ``zeros``; return the time, s, of the zero that ends the motion, or None.

    An entry is an interval [event, start, end, sign before, sign after]. ``left`` has, for each event, the number of
    zeros that are left until it ends the motion, and is counted down; 0: the event never ends it.
    """
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    side = 1.0 if last >= first else -1.0

    def sign(event: int, t: float, end: float, step: float) -> int:
        """Return the sign of an event's formula just after t (``step`` = 1) or before t (``step`` = -1).

        It is 0 if rounding errors are larger.
        """
        width = 4 * NEAR * max(abs(t), abs(last - first))
        while width < abs(end - t):
            value = searcher.sign(event, t + step * width, piece)
            if value:
                return value
            width *= 2
        return 0

    for number_, start, end, before, after in sorted(entries, key=lambda entry: side * entry[1]):
        event, at_start = int(number_), start == t0
        before = before or (0 if at_start else sign(event, start, first, -side))
        after = after or sign(event, end, last, side)
        rests = abs(end - start) > LONG * abs(last - t0)
        if not before and not after:
            # the formula is zero throughout: no event
            if rests:
                searcher.flat.append((event, start, end))
            continue
        arrived = bool(before) and (event, start) in searcher.arrived  # the formula stays zero
        near = 4 * NEAR * max(abs(start), abs(last - t0))
        if arrived and any(each.event == event and abs(each.t - start) <= near for each in zeros):
            continue  # the crossing was already listed, within rounding of the edge
        if not (before and after) and rests and not arrived:
            # zero up to the end of the known motion: no crossing
            searcher.flat.append((event, start, end))
            continue
        if rests and arrived:
            after = 0  # the sign with which it leaves zero belongs to another event
        t = t0 if at_start else start if rests and arrived else end if start == end else 0.5 * (start + end)
        kind = "rising" if after > before else "falling" if after < before else "touching"
        if events[event].direction and kind != {1: "rising", -1: "falling"}[events[event].direction]:
            continue
        zeros.append(EventZero(event, t, kind))
        if left[event] and not at_start:
            left[event] -= 1
            if not left[event]:
                return t
    return None
