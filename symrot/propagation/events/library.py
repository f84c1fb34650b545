"""Compiled libraries that locate the zeros of formulas along a motion: their C source, and their functions.

:file:`events.c` contains the search; the formulas and the bounds of their values on intervals are emitted.
"""

import ctypes
from collections.abc import Sequence
from functools import cache
from typing import Any

from symrot.build.sources import c_text
from symrot.formula import exact_numbers as number
from symrot.formula.program import Program
from symrot.formula.tree import Node, rename
from symrot.propagation.events.event import KNOWN, Event

__all__ = ["SearchLibrary", "event_library_source", "guard_library_source", "search_library"]


def event_library_source(
    quantities: Program, events: Sequence[Event], states: Sequence[str], edges: Sequence[int], scales: Sequence[float]
) -> str:
    """Return the C source of a library that locates the events of a motion.

    The library computes omega and the quaternion from the states by the program ``quantities``. ``states`` has the
    names of the states. ``edges`` and ``scales`` describe blocks of states (omega, attitude): block k consists of the
    states from ``edges[k]`` up to ``edges[k + 1]``, and the errors of these states are relative to ``scales[k]`` or, if
    it is 0, to the largest of them.
    """
    # its functions take the parameters of quantities, the kernel that computes omega and q from the states
    return _library_source(quantities, [_with_pi(event.node) for event in events], states, edges, scales, False)


def guard_library_source(
    quantities: Program, formulas: Sequence[Node], states: Sequence[str], edges: Sequence[int], scales: Sequence[float]
) -> str:
    """Return the C source of a library that locates where formulas change their signs along a motion.

    A change of sign at a pole or jump of a formula counts too: a function such as sign, which has the formula as its
    argument, changes its value there. The arguments ``quantities``, ``states``, ``edges`` and ``scales`` are those of
    :func:`event_library_source`.
    """
    return _library_source(quantities, formulas, states, edges, scales, True)


def _library_source(
    quantities: Program, formulas: Sequence[Node], states: Sequence[str], edges: Sequence[int],
    scales: Sequence[float], jumps: bool,
) -> str:  # fmt: skip
    from symrot.codegen.printing.event_source import event_definitions

    # The formulas contain t, omega, q, and the parameters of quantities, the program that computes omega and q from the
    # states. jumps: whether a change of sign at a pole or jump counts.
    columns = {name: f"{name} of t" for name in KNOWN if name != "t"}
    columned = [rename(formula, columns) for formula in formulas]
    definitions = event_definitions(quantities, columned, states, edges, scales)
    head = c_text("propagation/steppers/library.h") + c_text("propagation/events/event_enclosures.h")
    head += "\nstatic const double SYMROT_ROUNDING = 0.5*DBL_EPSILON, SYMROT_STATE_ERROR = 4.0*DBL_EPSILON;\n"
    head += f"enum {{ SYMROT_JUMPS = {int(jumps)} }};  /* whether changes of sign at poles and jumps count */\n\n"
    return head + definitions + "\n" + c_text("propagation/events/events.c")


def _with_pi(node: Node) -> Node:
    """Return the formula in which the name pi is replaced by its value, a fraction right to 96 digits."""
    if node[0] == "symbol":
        return ("number", number.PI) if node[1] == "pi" else node
    if node[0] == "call":
        return ("call", node[1], tuple(map(_with_pi, node[2])))
    return tuple(_with_pi(part) if isinstance(part, tuple) else part for part in node)


class SearchLibrary:
    """A compiled library that locates zeros of formulas along a motion, loaded: its C functions and three numbers.

    ``states`` and ``events`` are the numbers of states and of formulas; ``bytes`` is the memory that a search needs.
    Its source is from :func:`event_library_source` or :func:`guard_library_source`.
    """

    def __init__(self, path: str) -> None:
        library: Any = ctypes.CDLL(path)
        pointer, integer, real = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
        self.begin = library.symrot_events_begin
        self.begin.restype = None
        self.begin.argtypes = (pointer, pointer, integer, pointer, integer, pointer, real, ctypes.c_int)
        self.next = library.symrot_events_next
        self.next.restype = real
        self.next.argtypes = (pointer, pointer, integer, real, pointer)
        self.sign = library.symrot_events_sign
        self.sign.restype = ctypes.c_int
        self.sign.argtypes = (ctypes.c_int, real, pointer, integer, pointer)
        sizes = (integer * 3)()
        library.symrot_events_sizes(sizes)
        self.states, self.events, self.bytes = sizes


search_library = cache(SearchLibrary)
"""Function that takes the path of a compiled library and returns its :class:`SearchLibrary`, each loaded only once."""
