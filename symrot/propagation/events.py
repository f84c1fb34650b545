"""Events: the times at which a formula of the motion is zero, all of them, located to the last bits.

An event is a formula in t, omega_1..3, q0..q3, or an equation between two. It is read by the safe reader, printed as C
together with a bound of its rounding errors, and searched along the steps of a stepper (:file:`events.c`). Sign changes
are told from touches, and both are found however close they stand, several in one step too.
"""

import ctypes
import math
from collections.abc import Callable, Generator, Iterable, Sequence
from contextlib import closing
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot import number
from symrot.errors import InputError, PropagationError
from symrot.expression import Node, names, parse, rename
from symrot.kernel import Program

__all__ = ["Event", "Found", "Piece", "event_library_source", "read_events", "search", "timed", "uses_attitude"]

Floats = NDArray[np.float64]
Dense = Any  # a function in C: record, steps, times, count, states

ATTITUDE = frozenset(f"q{i}" for i in range(4))
KNOWN = {"t", "omega_1", "omega_2", "omega_3", *ATTITUDE}
NEAR = 64 * float(np.finfo(float).eps)  # of the time: entries so close are one
FIELDS = 5  # of an entry in events.c
ROOM = 256  # entries per call, before it is made again with more


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


class Piece(NamedTuple):
    """A part of a motion: edges in its order, and a record for ``dense``."""

    edges: Floats
    record: Floats


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
        raise InputError(f"{where}: expected names among t, omega_1..3, q0..q3 and pi, got {', '.join(unknown)}")
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
    from symrot.codegen.event_source import event_definitions

    columns = {name: f"{name} of t" for name in KNOWN if name != "t"}
    columned = [rename(formula, columns) for formula in formulas]
    definitions = event_definitions(quantities, columned, states, edges, scales)
    head = "#include <float.h>\n#include <math.h>\n#include <stdint.h>\n\n"
    head += "static const double SYMROT_ROUNDING = 0.5*DBL_EPSILON, SYMROT_STATE_ERROR = 4.0*DBL_EPSILON;\n\n"
    return head + definitions + "\n" + Path(__file__).with_name("events.c").read_text(encoding="utf-8")


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
        library = ctypes.CDLL(path)
        pointer, integer, real = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
        self.find = library.symrot_events
        self.find.restype = integer
        self.find.argtypes = (pointer, integer, pointer, pointer, integer, pointer, pointer, integer)
        self.sign = library.symrot_events_sign
        self.sign.restype = ctypes.c_int
        self.sign.argtypes = (ctypes.c_int, real, pointer, pointer, integer, pointer)


_library = cache(_Library)


def search(
    path: Path | str, events: Sequence[Event], p: Sequence[float], dense: Dense, pieces: Iterable[Piece], t0: float
) -> tuple[list[Found], float | None]:
    """Return the zeros along a motion in its order, and the time of the terminal one or None.

    A zero at t0 itself is listed, with the sign it takes on after it, but ends no motion.

    Parameters
    ----------
    dense : function in C
        Gives the states at times inside a record; its address is handed to the library.
    pieces : iterable of Piece
        Taken one after the other until a terminal event.
    """
    library, values = _library(str(path)), (ctypes.c_double * len(p))(*p)
    left = [int(event.terminal) for event in events]
    found: list[Found] = []
    held: list[list[float]] = []  # entries at the last edge, which the next piece may go on with
    previous: Piece | None = None
    for piece in pieces:
        entries = held + _entries(library, values, dense, piece)
        last = float(piece.edges[-1])
        whole, held = _merged(entries, last)
        stop = _settled(library, values, dense, piece, events, whole, t0, left, found)
        if stop is not None:
            return found, stop
        previous = piece
    if previous is not None and held:
        stop = _settled(library, values, dense, previous, events, held, t0, left, found)
        return found, stop
    return found, None


def guard_sign(path: Path | str, formula: int, dense: Dense, piece: Piece, p: Sequence[float]) -> int:
    """Return the sign that a formula has from the start of a piece on: the first one that is beyond rounding."""
    library, values = _library(str(path)), (ctypes.c_double * len(p))(*p)
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    width, side = 4 * NEAR * max(abs(first), abs(last - first)), 1.0 if last >= first else -1.0
    while width < abs(last - first):
        record = piece.record
        sign: int = library.sign(
            formula, first + side * width, dense, record.ctypes.data, len(record), ctypes.addressof(values)
        )
        if sign:
            return sign
        width *= 2
    return 0


def _entries(library: _Library, p: Any, dense: Dense, piece: Piece) -> list[list[float]]:
    room = ROOM
    while True:
        rows = np.empty((room, FIELDS))
        count = library.find(
            piece.edges.ctypes.data, len(piece.edges) - 1, dense, piece.record.ctypes.data, len(piece.record),
            ctypes.addressof(p), rows.ctypes.data, room,
        )  # fmt: skip
        if count <= room:
            listed: list[list[float]] = rows[:count].tolist()
            return listed
        room = int(count)


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
            and (before[4] == 0 or entry[3] == 0)
        ):
            before[2] = max(before[2], entry[2], key=lambda t: side * t)
            before[4] = entry[4]
            before[3] = before[3] or 0.0
            continue
        open_ones[entry[0]] = entry
        whole.append(entry)
    at_end = [entry for entry in whole if entry[4] == 0 and abs(entry[2] - last) <= NEAR * abs(last)]
    return [entry for entry in whole if entry not in at_end], at_end


def _settled(
    library: _Library, p: Any, dense: Dense, piece: Piece, events: Sequence[Event], entries: list[list[float]],
    t0: float, left: list[int], found: list[Found],
) -> float | None:  # fmt: skip
    """Add what entries stand for, in the order of the motion; return the time at which it ends, or None."""
    first, last = float(piece.edges[0]), float(piece.edges[-1])
    side = 1.0 if last >= first else -1.0

    def sign(event: int, t: float, end: float, step: float) -> int:
        """Return the sign away from a zero, the first one that is beyond rounding."""
        width = 4 * NEAR * max(abs(t), abs(last - first))
        while width < abs(end - t):
            value: int = library.sign(
                event, t + step * width, dense, piece.record.ctypes.data, len(piece.record), ctypes.addressof(p)
            )
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
        t = t0 if at_start else end if start == end else 0.5 * (start + end)
        kind = "rising" if after > before else "falling" if after < before else "touching"
        if events[event].direction and kind != {1: "rising", -1: "falling"}[events[event].direction]:
            continue
        found.append(Found(event, t, kind))
        if left[event] and not at_start:
            left[event] -= 1
            if not left[event]:
                return t
    return None


def stepped(task: Any, end: float, broken: list[PropagationError]) -> Generator[Piece, None, None]:
    """Yield the steps of a task from its start to an end, as they are made; what cuts it off goes into ``broken``."""
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
                    yield Piece(np.append(rows[:, 0], run.t), rows)
                if broken:
                    return


def exact_dense(states: Callable[[Floats], Floats], count: int) -> Dense:
    """Return a function in C around one in Python that gives the states, shape (n, count), at times."""

    def call(record: int, steps: int, times: int, n: int, out: int) -> None:
        asked = np.ctypeslib.as_array(ctypes.cast(times, ctypes.POINTER(ctypes.c_double)), (n,))
        given = np.ctypeslib.as_array(ctypes.cast(out, ctypes.POINTER(ctypes.c_double)), (n, count))
        given[:] = states(asked.copy())

    pointer, integer = ctypes.c_void_p, ctypes.c_int64
    return ctypes.CFUNCTYPE(None, pointer, integer, pointer, integer, pointer)(call)


def even_pieces(t0: float, end: float, longest: float) -> Generator[Piece, None, None]:
    """Yield pieces of a motion that has no steps, none longer than ``longest``; 64 to each."""
    count = max(1, math.ceil(abs(end - t0) / longest))
    for low in range(0, count, 64):
        share = np.arange(low, min(low + 64, count) + 1) / count
        edges = t0 + (end - t0) * share
        if low + 64 >= count:
            edges[-1] = end
        yield Piece(edges, np.empty((1, 1)))
