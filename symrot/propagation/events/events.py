"""Events: the times at which a formula of the motion is zero, all of them, located to the last bits.

An event is a formula in t, omega_1..3, q0..q3, or an equation between two. It is read by the safe reader, printed as C
together with a bound of its rounding errors and with enclosures of its values, and searched along the polynomials of a
motion (:file:`events.c`). Sign changes are told from touches, and both are located however close they stand, several in
one step too; no zero is so short that it hides between samples. Poles, jumps past zero and zeros at the edge of the
domain of a formula are no events.
"""

import ctypes
from collections.abc import Generator, Iterable, Sequence
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.build.sources import c_text
from symrot.errors import InputError, PropagationError
from symrot.formula import exact_numbers as number
from symrot.formula.program import Program
from symrot.formula.tree import Node, names, parse, rename
from symrot.propagation.events.polynomials import HEAD, Piece, rows_of

__all__ = [
    "Event",
    "Found",
    "Piece",
    "event_library_source",
    "read_events",
    "search",
    "stepped",
    "timed",
    "uses_attitude",
]

Floats = NDArray[np.float64]
ATTITUDE = frozenset(f"q{i}" for i in range(4))
KNOWN = {"t", "omega_1", "omega_2", "omega_3", *ATTITUDE}
NEAR = 64 * float(np.finfo(float).eps)  # of the time: entries so close are one
FIELDS = 5  # of an entry in events.c
ROOM = 1024  # entries per call
LONG = 1e-3  # of the motion: an event that stays zero for longer, up to an end, is none
OPERATIONS_PER_CALL = 5e6  # some 20 ms, after which Python can see an interrupt
MOST_OPERATIONS, OPERATIONS_PER_ROW = 4e9, 2e5  # of a search; each row of a motion earns more
MOST_ENTRIES = 500_000


class Event(NamedTuple):
    """A formula whose zeros are sought.

    Attributes
    ----------
    formula : str
        In t, omega_1..3 (rad/s, body components) and q0..q3, with the functions of scene formulas; ``"lhs == rhs"`` is
        their difference.
    terminal : bool or int
        Whether the motion ends there; a number ends it at that occurrence.
    direction : int
        1 for zeros through which the formula rises as the motion goes, -1 for those through which it falls, 0 for all,
        those that it only touches among them.

    Examples
    --------
    >>> import symrot
    >>> event = symrot.Event("omega_3 == 0", terminal=True)
    >>> symrot.propagate("t_handle", events=[event]).status
    1
    """

    formula: str
    terminal: bool | int = False
    direction: int = 0

    @property
    def node(self) -> Node:
        """The formula as a tree."""
        left, equals, right = self.formula.partition("==")
        node = parse(left, "event")
        return ("-", node, parse(right, "event")) if equals else node


class Found(NamedTuple):
    """One zero: which event, when, and ``"rising"``, ``"falling"`` or ``"touching"``."""

    event: int
    t: float
    kind: str


def read_events(events: Any) -> tuple[Event, ...]:
    """Return events as they may be given: formulas as text, :class:`Event` or mappings with its fields.

    Raises
    ------
    InputError
        For anything else, and for names that are none of a motion.
    """
    if isinstance(events, str | Event) or hasattr(events, "keys"):
        events = [events]
    found = []
    for place, given in enumerate(events):
        where = f"events[{place}]"
        if isinstance(given, str):
            event = Event(given)
        elif isinstance(given, Event):
            event = given
        elif hasattr(given, "keys") and "formula" in given and set(given) <= set(Event._fields):
            event = Event(**given)
        else:
            raise InputError(
                f'{where}: expected a formula as text, such as "omega_3" or "q0 == 0.5", or a mapping with formula, '
                f"terminal and direction, got {number.show(given)}"
            )
        found.append(_checked(event, where))
    return tuple(found)


def _checked(event: Event, where: str) -> Event:
    if not isinstance(event.formula, str):
        raise InputError(f"{where}: expected a formula as text, got {number.show(event.formula)}")
    try:
        node = event.node
    except InputError as error:
        raise InputError(f"{where}: {str(error).removeprefix('event: ')}") from None
    unknown = sorted(names(node) - KNOWN - {"pi"})
    if unknown:
        from symrot.formula.advice import name_advice  # only on the way to an error

        advice = name_advice(unknown[0], KNOWN | {"pi"})
        reason = f" ({advice})" if advice else ""
        expectation = "expected names among t, omega_1..3, q0..q3 and pi"
        raise InputError(f"{where}: {expectation}, got {', '.join(unknown)}{reason}")
    if not isinstance(event.terminal, bool | int) or event.terminal < 0:
        raise InputError(f"{where}: terminal: expected true, false or a count, got {number.show(event.terminal)}")
    if isinstance(event.direction, bool) or event.direction not in (-1, 0, 1):
        raise InputError(f"{where}: direction: expected -1, 0 or 1, got {number.show(event.direction)}")
    return event._replace(direction=int(event.direction))


def uses_attitude(events: Iterable[Event]) -> bool:
    """Return whether some event needs the attitude."""
    return any(names(event.node) & ATTITUDE for event in events)


def timed(quantities: Program, events: Iterable[Event]) -> bool:
    """Return whether the time stands in some event, or in the quantities that events are made of."""
    used = set().union(*(names(event.node) for event in events))
    return "t" in used or quantities.uses("t", tuple(f"{name} of t" for name in used))


def event_library_source(
    quantities: Program, events: Sequence[Event], states: Sequence[str], edges: Sequence[int], scales: Sequence[float]
) -> str:
    """Return the C source of a library that finds events; its parameters are those of the quantities."""
    return guard_library_source(quantities, [_with_pi(event.node) for event in events], states, edges, scales)


def guard_library_source(
    quantities: Program, formulas: Sequence[Node], states: Sequence[str], edges: Sequence[int], scales: Sequence[float]
) -> str:
    """Return the C source of a library that finds zeros of formulas in t, omega, q and parameters of the quantities."""
    from symrot.codegen.printing.event_source import event_definitions

    columns = {name: f"{name} of t" for name in KNOWN if name != "t"}
    columned = [rename(formula, columns) for formula in formulas]
    definitions = event_definitions(quantities, columned, states, edges, scales)
    head = c_text("propagation/events/event_enclosures.h")
    head += "\nstatic const double SYMROT_ROUNDING = 0.5*DBL_EPSILON, SYMROT_STATE_ERROR = 4.0*DBL_EPSILON;\n\n"
    return head + definitions + "\n" + c_text("propagation/events/events.c")


def _with_pi(node: Node) -> Node:
    """Return a formula with pi as a number, of 33 digits."""
    if node[0] == "symbol":
        return ("number", number.PI) if node[1] == "pi" else node
    if node[0] == "call":
        return ("call", node[1], tuple(map(_with_pi, node[2])))
    return tuple(_with_pi(part) if isinstance(part, tuple) else part for part in node)


class _Library:
    """A loaded library of :func:`event_library_source`."""

    def __init__(self, path: str) -> None:
        library: Any = ctypes.CDLL(path)
        pointer, integer, real = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
        self.begin = library.symrot_events_begin
        self.begin.restype = None
        self.begin.argtypes = (pointer, pointer, integer, pointer, integer, pointer, ctypes.c_int)
        self.next = library.symrot_events_next
        self.next.restype = real
        self.next.argtypes = (pointer, pointer, integer, real, pointer)
        self.sign = library.symrot_events_sign
        self.sign.restype = ctypes.c_int
        self.sign.argtypes = (ctypes.c_int, real, pointer, integer, pointer)
        sizes = (integer * 3)()
        library.symrot_events_sizes(sizes)
        self.states, self.events, self.bytes = sizes


_library = cache(_Library)


class _Search:
    """A search along one motion: its state in C, and the operations it spent."""

    def __init__(self, path: Path | str, p: Sequence[float], formulas: Sequence[str]) -> None:
        self.library, self.formulas = _library(str(path)), formulas
        self.p = (ctypes.c_double * len(p))(*p)
        self.state = ctypes.create_string_buffer(self.library.bytes)
        self.arrived: set[tuple[int, float]] = set()  # events that reach zero at an edge between pieces, and the time
        self.again, self.spent, self.allowed = False, 0.0, MOST_OPERATIONS

    def entries(self, piece: Piece) -> list[list[float]]:
        """Return the entries of a piece, see :file:`events.c`.

        Raises
        ------
        PropagationError
            If the search takes more operations than a motion of so many rows may.
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
            self.again,
        )
        self.again = True
        batch = np.empty((ROOM, FIELDS))
        while not answer[1]:
            self.spent += self.library.next(self.state, batch.ctypes.data, ROOM, OPERATIONS_PER_CALL, answer)
            listed += batch[: answer[0]].tolist()
            if self.spent > self.allowed or len(listed) > MOST_ENTRIES:
                t = float(edges[min(answer[2], count)])
                shown = ", ".join(map(repr, self.formulas))
                raise PropagationError(
                    f"events: expected formulas whose zeros can be told apart, but beyond t = {t!r} s those of {shown} "
                    f"are not settled after {self.spent:.1g} operations and {len(listed)} entries"
                )
        return listed

    def terms(self, rows: Floats) -> int:
        """Return the number of terms of the polynomials in rows."""
        count: int = (rows.shape[1] - HEAD) // self.library.states
        return count

    def sign(self, event: int, t: float, piece: Piece) -> int:
        """Return the sign of an event at a time of a piece, 0 within its rounding errors."""
        edges, side = piece.edges, 1.0 if piece.edges[-1] >= piece.edges[0] else -1.0
        place = int(np.searchsorted(side * edges, side * t, "left")) - 1
        row = np.ascontiguousarray(piece.rows[min(max(place, 0), len(piece.rows) - 1)])
        given = event, t, row.ctypes.data, self.terms(piece.rows), ctypes.addressof(self.p)
        value: int = self.library.sign(*given)
        return value


def search(
    path: Path | str, events: Sequence[Event], p: Sequence[float], pieces: Iterable[Piece], t0: float
) -> tuple[list[Found], float | None]:
    """Return the zeros along a motion in its order, and the time of the terminal one or None.

    A zero at t0 itself is listed, with the sign it takes on after it, but ends no motion.

    Parameters
    ----------
    path : Path
        The library of :func:`event_library_source` for these events.
    p : sequence of float
        The parameters of its quantities.
    pieces : iterable of Piece
        The motion from t0 on as polynomials (:mod:`symrot.propagation.events.polynomials`), in its order, one Piece
        going on where the one before ends. They are asked for one after the other, until a terminal event.

    Raises
    ------
    PropagationError
        If the zeros cannot be told apart with the operations that a motion of such a length may take.
    """
    task = _Search(path, p, [event.formula for event in events])
    left = [int(event.terminal) for event in events]
    found: list[Found] = []
    held: list[list[float]] = []  # entries at the last edge, which the next piece may go on with
    previous: Piece | None = None
    for piece in pieces:
        if not len(piece.rows):
            continue
        entries = held + task.entries(piece)
        for entry in entries:  # a zero from the first edge on: the piece before tells the sign before it
            if previous is not None and not entry[3] and entry[1] == float(piece.edges[0]):
                entry[3] = _sign_before_end(task, int(entry[0]), previous)
                task.arrived.add((int(entry[0]), entry[1]))
        last = float(piece.edges[-1])
        whole, held = _merged(entries, last)
        stop = _settled(task, piece, events, whole, t0, left, found)
        if stop is not None:
            return found, stop
        previous = piece
    if previous is not None and held:
        stop = _settled(task, previous, events, held, t0, left, found)
        return found, stop
    return found, None


def signs_at_ends(
    path: Path | str, formulas: Sequence[str], p: Sequence[float], piece: Piece
) -> tuple[list[int], list[int]]:
    """Return the signs that formulas have from the start of a piece on, and at its end; 0 within rounding of zero."""
    task, numbers = _Search(path, p, formulas), range(len(formulas))
    last = float(piece.edges[-1])
    return [_first_sign(task, number, piece) for number in numbers], [task.sign(n, last, piece) for n in numbers]


def _first_sign(task: _Search, number: int, piece: Piece) -> int:
    """Return the first sign of a formula after the start of a piece that is beyond rounding, and holds twice as far."""
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    width, side = 4 * NEAR * max(abs(first), abs(last - first)), 1.0 if last >= first else -1.0
    before = 0
    while width < abs(last - first):
        sign = task.sign(number, first + side * width, piece)
        if sign and sign == before:
            return sign
        before = sign
        width *= 2
    return before


def _merged(entries: list[list[float]], last: float) -> tuple[list[list[float]], list[list[float]]]:
    """Return entries with those that go on with one another put together, and those that reach the last edge apart."""
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


def _sign_before_end(task: _Search, event: int, piece: Piece) -> int:
    """Return the last sign that an event has before the end of a piece, beyond rounding."""
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    width, side = 4 * NEAR * max(abs(last), abs(last - first)), 1.0 if last >= first else -1.0
    while width < abs(last - first):
        sign = task.sign(event, last - side * width, piece)
        if sign:
            return sign
        width *= 2
    return 0


def _settled(
    task: _Search, piece: Piece, events: Sequence[Event], entries: list[list[float]], t0: float, left: list[int],
    found: list[Found],
) -> float | None:  # fmt: skip
    """Add what entries stand for, in the order of the motion; return the time at which it ends, or None."""
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    side = 1.0 if last >= first else -1.0

    def sign(event: int, t: float, end: float, step: float) -> int:
        """Return the sign away from a zero, the first one that is beyond rounding."""
        width = 4 * NEAR * max(abs(t), abs(last - first))
        while width < abs(end - t):
            value = task.sign(event, t + step * width, piece)
            if value:
                return value
            width *= 2
        return 0

    for number_, start, end, before, after in sorted(entries, key=lambda entry: side * entry[1]):
        event, at_start = int(number_), start == t0
        before = before or (0 if at_start else sign(event, start, first, -side))
        after = after or sign(event, end, last, side)
        if not before and not after:
            continue  # zero all along: no event
        rests = abs(end - start) > LONG * abs(last - t0)
        arrived = bool(before) and (event, start) in task.arrived  # and stays, as a wheel that friction stops
        near = 4 * NEAR * max(abs(start), abs(last - t0))
        if arrived and any(each.event == event and abs(each.t - start) <= near for each in found):
            continue  # it was seen to cross within rounding of the edge
        if not (before and after) and rests and not arrived:
            continue  # zero all along up to an end of what is known: it passes through nothing
        if rests and arrived:
            after = 0  # where it goes when it is let go is another matter
        t = t0 if at_start else start if rests and arrived else end if start == end else 0.5 * (start + end)
        kind = "rising" if after > before else "falling" if after < before else "touching"
        if events[event].direction and kind != {1: "rising", -1: "falling"}[events[event].direction]:
            continue
        found.append(Found(event, t, kind))
        if left[event] and not at_start:
            left[event] -= 1
            if not left[event]:
                return t
    return None


def stepped(
    task: Any, end: float, broken: list[PropagationError], records: list[Floats]
) -> Generator[Piece, None, None]:
    """Yield the steps of a task from its start to an end, as they are made.

    What the stepper records is added to ``records``; what cuts the motion off, to ``broken``.
    """
    room = task.stepper.rows_per_call
    with closing(task.runs(end)) as runs:
        for run in runs:
            while run.t != run.stop:
                rows = np.empty((room, task.stepper.row))
                try:
                    task.advance(run, None, 0, None, rows.ctypes.data, room)
                except PropagationError as error:
                    broken.append(error)
                rows = rows[: run.recorded]
                if len(rows):
                    records.append(rows)
                    yield Piece(np.append(rows[:, 0], run.t), rows_of(task.stepper, rows))
                if broken:
                    return
