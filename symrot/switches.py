"""Formulas that jump or bend, as smooth formulas with modes: what a stepper follows from one switch to the next.

A switch is a guard, a formula that changes its sign, and a mode, the number that the smooth formula takes on one side
of it. While no guard vanishes, the smooth formula with the modes of the moment is the formula itself:

=====================  =============================  ==========================================
formula                smooth formula                 guard
=====================  =============================  ==========================================
``sign(u)``            ``s``                          ``u``, s = 1 or -1
``step(u)``            ``(1 + s)/2``                  ``u``
``abs(u)``             ``s u``                        ``u``
``max(a, b)``          ``b + (1 + s)/2 (a - b)``      ``a - b``
``where(c, a, b)``     ``b + p (a - b)``              those of the condition, p = 1 or 0
``floor(u)``           ``n``                          ``u - n`` and ``n + 1 - u``, n whole
``mod(a, b)``          ``a - b n``                    of ``floor(a/b)``
``atan2(y, x)``        where it is cut (see below)    ``x``, and ``y`` where x < 0
=====================  =============================  ==========================================

The arc tangent of two arguments jumps across the negative x axis; on that side it is ``s pi - atan2(y, -x)``, with s
the sign of y, which is smooth there.

Standard library only.
"""

from fractions import Fraction
from functools import lru_cache
from typing import NamedTuple

from symrot.expression import SWITCHING, Node, children, names, parse, text

__all__ = ["CHANGING", "MODES", "Smooth", "Switch", "condition_error", "has_switches", "smooth"]

ONE: Node = ("number", Fraction(1))
HALF: Node = ("number", Fraction(1, 2))
PI: Node = ("symbol", "pi")
CHANGING = frozenset({"t", *(f"omega_{i}" for i in (1, 2, 3)), *(f"q{i}" for i in range(4))})
BENDING = {*SWITCHING, "abs", "atan2"}
CONDITIONS = {"less", "and", "or", "not"}
MODES = "switch_"  # how the names of modes begin


class Switch(NamedTuple):
    """A mode and its guards.

    Attributes
    ----------
    mode : str
        Its name in the smooth formulas.
    kind : str
        ``"sign"``: the mode is the sign of the guard; ``"floor"``: it is the whole number below the guard.
    guard : Node
        A smooth formula, which may hold modes.
    where : tuple of (str, int) or None
        A mode and the value of it without which the guard does not matter.
    label : str
        The function that switches, as it was written.
    at_zero : int
        The mode for as long as the guard is zero: sign(0) = 0, step(0) = 0, 0 < 0 is false.
    """

    mode: str
    kind: str
    guard: Node
    where: tuple[str, int] | None
    label: str
    at_zero: int = 1


class Smooth(NamedTuple):
    """Formulas without switches, and the switches that were in them, each after those that stand in its guard."""

    formulas: tuple[Node, ...]
    switches: tuple[Switch, ...]


def has_switches(node: Node) -> bool:
    """Return whether a formula jumps or bends where what changes (time, state) passes some value."""
    if node[0] == "call" and node[1] in SWITCHING:
        return True
    if node[0] == "call" and node[1] in BENDING and names(node) & CHANGING:
        return True
    return any(map(has_switches, children(node)))


def condition_error(node: Node) -> str:
    """Return an empty text, or what is wrong with the conditions in a formula."""

    def wrong(node: Node, condition: bool) -> str:
        if node[0] != "call" or node[1] not in CONDITIONS:
            if condition:
                return "a comparison such as omega_3 < 1 as the condition of where"
            asked = [node[0] == "call" and node[1] == "where" and k == 0 for k, _ in enumerate(children(node))]
        elif node[1] == "less" and any(part[0] == "call" and part[1] in ("less", "not") for part in node[2]):
            return "one comparison at a time, such as 1 < t and t < 2"
        elif not condition:
            return "comparisons only in the condition of where"
        else:
            asked = [node[1] != "less"] * len(children(node))
        errors = (wrong(child, each) for child, each in zip(children(node), asked, strict=True))
        return next((error for error in errors if error), "")

    return wrong(node, False)


@lru_cache(maxsize=256)
def smooth(sources: tuple[str, ...]) -> Smooth:
    """Return formulas, given as text, as smooth formulas with modes."""
    nodes = [parse(source, switching=True) for source in sources]
    taken = set().union(*map(names, nodes))
    prefix = MODES
    while any(name.startswith(prefix) for name in taken):
        prefix = f"_{prefix}" if len(prefix) > 40 else f"{prefix}_"
    writer = _Writer(prefix)
    return Smooth(tuple(map(writer.smooth, nodes)), tuple(writer.switches))


class _Writer:
    def __init__(self, prefix: str) -> None:
        self.prefix, self.switches = prefix, list[Switch]()
        self.known: dict[tuple[str, Node, tuple[str, int] | None, int], Node] = {}
        self.label = ""  # the function that is being rewritten

    def mode(self, kind: str, guard: Node, where: tuple[str, int] | None = None, at_zero: int = 1) -> Node:
        """Return the mode of a guard, made when it is first asked for."""
        key = (kind, guard, where, at_zero)
        if key not in self.known:
            name = f"{self.prefix}{len(self.switches) + 1}"
            self.switches.append(Switch(name, kind, guard, where, self.label, at_zero))
            self.known[key] = ("symbol", name)
        return self.known[key]

    def smooth(self, node: Node) -> Node:
        kind = node[0]
        if kind in ("number", "symbol"):
            return node
        if kind == "call" and node[1] == "where":
            condition, yes, no = node[2]
            return _blend(self.share(condition), self.smooth(yes), self.smooth(no))
        parts = tuple(map(self.smooth, children(node)))
        if kind != "call":
            return (kind, *parts, *(node[2:] if kind == "**" else ()))
        if node[1] not in BENDING or (node[1] in ("abs", "atan2") and not names(node) & CHANGING):
            return ("call", node[1], parts)
        self.label = text(node)
        return getattr(self, f"_{node[1]}")(*parts)  # type: ignore[no-any-return]

    def share(self, condition: Node) -> Node:
        """Return 1 where a condition holds, else 0."""
        name, parts = condition[1], condition[2]
        if name == "less":
            left, right = map(self.smooth, parts)
            self.label = text(condition)
            return self._step(("-", right, left))
        shares = [self.share(part) for part in parts]
        if name == "not":
            return ("-", ONE, shares[0])
        both: Node = ("*", *shares)
        return both if name == "and" else ("-", ("+", *shares), both)

    def _sign(self, u: Node) -> Node:
        return self.mode("sign", u, at_zero=0)

    def _step(self, u: Node) -> Node:
        return ("*", HALF, ("+", ONE, self.mode("sign", u, at_zero=-1)))

    def _abs(self, u: Node) -> Node:
        return ("*", self.mode("sign", u), u)

    def _max(self, a: Node, b: Node) -> Node:
        if a == b:
            return a
        return _blend(self._step(("-", a, b)), a, b)

    def _min(self, a: Node, b: Node) -> Node:
        if a == b:
            return a
        return _blend(self._step(("-", a, b)), b, a)

    def _clip(self, u: Node, low: Node, high: Node) -> Node:
        return self._max(low, self._min(u, high))

    def _floor(self, u: Node) -> Node:
        return self.mode("floor", u)

    def _mod(self, a: Node, b: Node) -> Node:
        return ("-", a, ("*", b, self._floor(("/", a, b))))

    def _atan2(self, y: Node, x: Node) -> Node:
        right = self.mode("sign", x)
        above = self.mode("sign", y, (right[1], -1))
        angle: Node = ("*", right, ("call", "atan2", (y, ("*", right, x))))
        return ("+", angle, ("*", ("*", HALF, ("-", ONE, right)), ("*", above, PI)))


def _blend(share: Node, yes: Node, no: Node) -> Node:
    return ("+", no, ("*", share, ("-", yes, no)))
