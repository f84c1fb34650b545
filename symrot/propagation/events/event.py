"""Events: formulas of time, angular velocity and attitude whose zeros along a motion are located."""

from collections.abc import Iterable
from numbers import Real
from typing import Any, NamedTuple

from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.formula.program import Program
from symrot.formula.tree import Node, names, parse

__all__ = ["KNOWN", "Event", "read_events", "timed", "uses_attitude"]

ATTITUDE = frozenset(f"q{i}" for i in range(4))
KNOWN = {"t", "omega_1", "omega_2", "omega_3", *ATTITUDE}
"""The names that the formula of an event may contain, besides pi."""


# Not events: poles, jumps past zero, and zeros at the edge of the domain of a formula.
class Event(NamedTuple):
    """A formula whose zeros along the motion are located.

    Attributes
    ----------
    formula : str
        A formula in t, omega_1..3 (rad/s, body components) and q0..q3, with the functions of scene formulas;
        ``"lhs == rhs"`` means lhs - rhs.
    terminal : bool or int
        Whether the motion ends at the first zero after its start; with a number n it ends at the n-th such zero. Only
        zeros in the requested direction count.
    direction : int
        1 to locate only zeros through which the formula rises along the motion, -1 only those through which it falls, 0
        all zeros, including touches.

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
        """The formula as a tree: ``("-", ("symbol", "t"), ("symbol", "q0"))`` for ``t - q0`` or ``t == q0``."""
        left, equals, right = self.formula.partition("==")
        node = parse(left, "event")
        return ("-", node, parse(right, "event")) if equals else node


def read_events(events: Any) -> tuple[Event, ...]:
    """Return the requested events; each is given as a formula, an :class:`Event`, or a mapping with its fields.

    Raises
    ------
    InputError
        If an event is given in another form, or if a formula contains an unknown name.
    """
    if isinstance(events, str | Event) or hasattr(events, "keys"):
        events = [events]
    if not isinstance(events, Iterable):
        raise InputError(f'events: expected formulas as text, such as ["omega_3", "t - 1"], got {number.show(events)}')
    checked = []
    for place, entry in enumerate(events):
        where = f"events[{place}]"
        if isinstance(entry, str):
            event = Event(entry)
        elif isinstance(entry, Event):
            event = entry
        elif hasattr(entry, "keys") and "formula" in entry and set(entry) <= set(Event._fields):
            event = Event(**entry)
        else:
            raise InputError(
                f'{where}: expected a formula as text, such as "omega_3" or "q0 == 0.5", or a mapping with formula, '
                f"terminal and direction, got {number.show(entry)}"
            )
        checked.append(_checked(event, where))
    return tuple(checked)


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
    is_number = isinstance(event.direction, Real) and not isinstance(event.direction, bool)
    if not is_number or event.direction not in (-1, 0, 1):
        raise InputError(f"{where}: direction: expected -1, 0 or 1, got {number.show(event.direction)}")
    return event._replace(direction=int(event.direction))


def uses_attitude(events: Iterable[Event]) -> bool:
    """Return whether the formula of at least one event contains a quaternion component, q0 to q3.

    The motion then has to compute the attitude.
    """
    return any(names(event.node) & ATTITUDE for event in events)


def timed(quantities: Program, events: Iterable[Event]) -> bool:
    """Return whether the formula of any event, or an output quantity in such a formula, contains the time t.

    ``quantities`` is the program that computes the output quantities from the states.
    """
    # if not, the search may count time from the start of the motion
    used = set().union(*(names(event.node) for event in events))
    return "t" in used or quantities.uses("t", tuple(f"{name} of t" for name in used))
