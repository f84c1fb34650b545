"""Formulas that jump or bend, as smooth formulas with modes, which a stepper follows from switch to switch.

A switch is a guard, a formula that changes its sign, and a mode, the number that the smooth formula takes on one side
of it. While no guard vanishes, the smooth formula with the modes of the moment is the formula itself:

=====================  =============================  ==========================================
formula                smooth formula                 guard
=====================  =============================  ==========================================
``sign(u)``            ``s``                          ``u``, s = 1 or -1
``step(u)``            ``(1 + s)/2``                  ``u``
``abs(u)``             ``s u``                        ``u``, unless u contains modes alone
``sqrt(u^2 v)``        ``s u sqrt(v)``                ``u``
``max(a, b)``          ``b + (1 + s)/2 (a - b)``      ``a - b``
``where(c, a, b)``     ``b + p (a - b)``              those of the condition, p = 1 or 0
                       or a or b alone (see below)
``floor(u)``           ``n``                          ``u - n`` and ``n + 1 - u``, n whole
``mod(a, b)``          ``a - b n``                    of ``floor(a/b)``
``atan2(y, x)``        where it is cut (see below)    ``x``, and ``y`` where x < 0
=====================  =============================  ==========================================

The arc tangent of two arguments jumps across the negative x axis; on that side it is ``s pi - atan2(y, -x)``, with s
the sign of y, which is smooth there.

In ``where(t > 1, sqrt(t - 1), 0)`` the root has no value before t = 1, and zero times no value is none. So a ``where``
with such a part, or with one whose features could shorten steps, stays in the formulas until the modes are known:
:func:`chosen` then leaves the part that holds alone, and guards inside the other part do not matter.

Standard library only.
"""

from collections.abc import Collection, Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

from symrot.formula.squares import as_polynomial, square_under_root
from symrot.formula.tree import SWITCHING, Node, children, evaluate, names, parse, text

__all__ = [
    "CHANGING", "MODES", "Conditions", "Smooth", "Switch", "between_sides", "blended", "chosen", "condition_error",
    "has_choices", "has_switches", "hold", "on_line", "placed", "smooth",
]  # fmt: skip

ONE: Node = ("number", Fraction(1))
HALF: Node = ("number", Fraction(1, 2))
PI: Node = ("symbol", "pi")
CHANGING = frozenset({"t", *(f"omega_{i}" for i in (1, 2, 3)), *(f"q{i}" for i in range(4))})
BENDING = {*SWITCHING, "abs", "atan2"}
CONDITIONS = {"less", "and", "or", "not"}
MODES = "switch_"  # how the names of modes begin
HARMLESS_DEGREE = 6  # of polynomials, which have a value everywhere and no narrow feature: they may stay unchosen
RISKY = HARMLESS_DEGREE + 1

Conditions = tuple[tuple[Node, int], ...]
"""Formulas of modes, and the values that all of them must have."""


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
    where : Conditions
        Without them the guard does not matter.
    label : str
        The function that switches, as it was written.
    at_zero : int
        The mode for as long as the guard is zero: sign(0) = 0, step(0) = 0, 0 < 0 is false.
    """

    mode: str
    kind: str
    guard: Node
    where: Conditions
    label: str
    at_zero: int = 1


class Smooth(NamedTuple):
    """Smooth formulas, and the switches that they had; each switch comes after the switches that occur in its guard.

    Formulas and guards may hold ``where(p, a, b)``, with p a formula of modes that is 1 or 0, see :func:`chosen`.
    """

    formulas: tuple[Node, ...]
    switches: tuple[Switch, ...]


def has_switches(node: Node) -> bool:
    """Return whether a formula jumps or bends as the time or a state passes some value."""
    if node[0] == "call" and node[1] in SWITCHING:
        return True
    if node[0] == "call" and node[1] in BENDING and names(node) & CHANGING:
        return True
    if node[:2] == ("call", "sqrt") and names(node) & CHANGING and (split := square_under_root(node[2][0])):
        return bool(names(split[0]) & CHANGING) or has_switches(split[1])
    return any(map(has_switches, children(node)))


def condition_error(node: Node) -> str:
    """Return a sentence about a fault of the conditions in a formula; an empty text if they are right."""

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


def hold(conditions: Iterable[tuple[Node, int]], modes: Mapping[str, int], held: Collection[str] = ()) -> bool:
    """Return whether conditions hold for given modes; one whose mode slides between its values counts as true."""
    return all(names(share) & set(held) or evaluate(share, modes) == value for share, value in conditions)


def has_choices(node: Node) -> bool:
    """Return whether a smooth formula contains a ``where``, whose part is chosen once the modes are known."""
    return node[:2] == ("call", "where") or any(map(has_choices, children(node)))


def chosen(node: Node, modes: Mapping[str, int], held: Collection[str] = ()) -> Node:
    """Return a smooth formula in which each ``where`` is replaced by the part that holds for given modes.

    Where a mode of the condition is held between its values, both parts hold in shares.
    """
    if not has_choices(node):
        return node
    if node[:2] == ("call", "where"):
        share, yes, no = node[2]
        if names(share) & set(held):
            return _blend(share, chosen(yes, modes, held), chosen(no, modes, held))
        return chosen(yes if evaluate(share, modes) == 1 else no, modes, held)
    parts = tuple(chosen(child, modes, held) for child in children(node))
    return ("call", node[1], parts) if node[0] == "call" else (node[0], *parts, *(node[2:] if node[0] == "**" else ()))


def blended(node: Node) -> Node:
    """Return a smooth formula in which each ``where`` is the sum of both parts, each times its share."""
    return chosen(node, {}, names(node))


def placed(node: Node, values: Mapping[str, Node]) -> Node:
    """Return a formula in which names are replaced by formulas."""
    if node[0] in ("number", "symbol"):
        return values.get(node[1], node) if node[0] == "symbol" else node
    parts = tuple(placed(child, values) for child in children(node))
    return ("call", node[1], parts) if node[0] == "call" else (node[0], *parts, *(node[2:] if node[0] == "**" else ()))


def on_line(node: Node) -> tuple[Any, int]:
    """Return a key and a sign: formulas of one key are proportional, and have the same sign if their signs agree.

    A formula that is no polynomial of symbols and functions is its own key.
    """
    polynomial = as_polynomial(node, {})
    if polynomial is None or not polynomial.terms:
        return node, 1
    (_, first), *_ = terms = sorted(polynomial.terms.items())
    return tuple((monomial, coefficient / first) for monomial, coefficient in terms), 1 if first > 0 else -1


def between_sides(node: Node, mode: str) -> Node:
    """Return a formula with a held mode as the mixture of its values for the modes 1 and -1, which is linear in it.

    A motion that slides along a switch moves with a mixture of the rates on both sides (A. F. Filippov); a formula that
    is linear in the mode is that mixture already.
    """
    if _is_linear(node, mode):
        return node
    above, below = (placed(node, {mode: ("number", Fraction(side))}) for side in (1, -1))
    return _blend(("*", HALF, ("+", ONE, ("symbol", mode))), above, below)


def _is_linear(node: Node, mode: str) -> bool:
    """Return whether a formula is linear in a mode, by its form."""
    if mode not in names(node) or node == ("symbol", mode):
        return True
    parts = children(node)
    if node[0] in ("+", "-", "neg"):
        return all(_is_linear(part, mode) for part in parts)
    within = [part for part in parts if mode in names(part)]
    return (
        node[0] in ("*", "/") and within in ([parts[0]], [parts[1]][: node[0] == "*"]) and _is_linear(within[0], mode)
    )


def _degree(node: Node) -> int:
    """Return the degree of a formula between its switches as a polynomial, in sines and cosines of the time too.

    RISKY for what may have no value, a pole or a narrow feature.
    """
    kind = node[0]
    if kind in ("number", "symbol"):
        return int(kind == "symbol" and node[1] in CHANGING)
    if kind == "call" and not names(node) & CHANGING:
        return 0
    degrees = [_degree(child) for child in children(node)]
    most = max(degrees)
    if most >= RISKY:
        return RISKY
    if kind == "*":
        return min(sum(degrees), RISKY)
    if kind == "/":
        return degrees[0] if not names(node[2]) & CHANGING else RISKY
    if kind == "**":
        return min(most * node[2], RISKY) if node[2] >= 0 or not most else RISKY
    if kind != "call":
        return most
    function, operands = node[1], node[2]
    if function in ("sin", "cos"):
        return 1 if most <= 1 and names(node) & CHANGING == {"t"} else RISKY
    if function == "mod":
        return most if not names(operands[1]) & CHANGING else RISKY
    if function in ("sign", "step", "floor") or function in CONDITIONS:
        return 0
    return most if function in ("abs", "min", "max", "clip", "where") else RISKY


@lru_cache(maxsize=256)
def smooth(sources: tuple[str, ...]) -> Smooth:
    """Return formulas, given as text, as smooth formulas with modes."""
    nodes = [parse(source, switching=True) for source in sources]
    used_names = set().union(*map(names, nodes))
    prefix = MODES
    while any(name.startswith(prefix) for name in used_names):
        prefix = f"_{prefix}" if len(prefix) > 40 else f"{prefix}_"
    writer = _Writer(prefix)
    return Smooth(tuple(map(writer.smooth, nodes)), tuple(writer.switches))


class _Writer:
    def __init__(self, prefix: str) -> None:
        self.prefix, self.switches = prefix, list[Switch]()
        self.known: dict[tuple[str, Node, Conditions, int], Node] = {}
        self.label = ""  # the function that is being rewritten
        self.conditions: Conditions = ()  # under which what is being rewritten matters

    def mode(self, kind: str, guard: Node, where: Conditions = (), at_zero: int = 1) -> Node:
        """Return the mode of a guard, a new one at the first call."""
        where = self.conditions + where
        for count in range(len(where) + 1):  # one that matters wherever this one does will do
            if (mode := self.known.get((kind, guard, where[:count], at_zero))) is not None:
                return mode
        name = f"{self.prefix}{len(self.switches) + 1}"
        self.switches.append(Switch(name, kind, guard, where, self.label, at_zero))
        self.known[kind, guard, where, at_zero] = ("symbol", name)
        return ("symbol", name)

    def part(self, node: Node, share: Node, value: int) -> Node:
        """Return a part of a ``where`` as a smooth formula; its guards matter where the share has that value alone."""
        outside = self.conditions
        self.conditions = (*outside, (share, value))
        smooth = self.smooth(node)
        self.conditions = outside
        return smooth

    def smooth(self, node: Node) -> Node:
        kind = node[0]
        if kind in ("number", "symbol"):
            return node
        if kind == "call" and node[1] == "where":
            condition, yes, no = node[2]
            share = self.share(condition)
            if max(_degree(yes), _degree(no)) < RISKY:
                return _blend(share, self.smooth(yes), self.smooth(no))
            return ("call", "where", (share, self.part(yes, share, 1), self.part(no, share, 0)))
        parts = tuple(map(self.smooth, children(node)))
        if node[:2] == ("call", "sqrt") and (split := square_under_root(parts[0])) and names(split[0]) & CHANGING:
            self.label = text(node)
            size = self._abs(split[0])
            return size if split[1] == ONE else ("*", size, ("call", "sqrt", (split[1],)))
        if kind != "call":
            return (kind, *parts, *(node[2:] if kind == "**" else ()))
        if node[1] not in BENDING or (node[1] in ("abs", "atan2") and not names(node) & CHANGING):
            return ("call", node[1], parts)
        if node[1] == "abs" and not names(parts[0]) & CHANGING:
            return ("call", "abs", parts)  # of modes alone: a constant between switches
        self.label = text(node)
        return getattr(self, f"_{node[1]}")(*parts)  # type: ignore[no-any-return]

    def share(self, condition: Node) -> Node:
        """Return 1 where a condition holds, else 0."""
        name, parts = condition[1], condition[2]
        if name == "less":
            left, right = map(self.smooth, parts)
            self.label = text(condition)
            return self._step(_difference(right, left))
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
        return _blend(self._step(_difference(a, b)), a, b)

    def _min(self, a: Node, b: Node) -> Node:
        if a == b:
            return a
        return _blend(self._step(_difference(a, b)), b, a)

    def _clip(self, u: Node, low: Node, high: Node) -> Node:
        return self._max(low, self._min(u, high))

    def _floor(self, u: Node) -> Node:
        return self.mode("floor", u)

    def _mod(self, a: Node, b: Node) -> Node:
        return ("-", a, ("*", b, self._floor(("/", a, b))))

    def _atan2(self, y: Node, x: Node) -> Node:
        right = self.mode("sign", x)
        above = self.mode("sign", y, ((right, -1),))
        angle: Node = ("*", right, ("call", "atan2", (y, ("*", right, x))))
        return ("+", angle, ("*", ("*", HALF, ("-", ONE, right)), ("*", above, PI)))


def _difference(a: Node, b: Node) -> Node:
    """Return the formula a - b, shortened to a for b = 0, so that functions of a share one guard."""
    return a if b == ("number", 0) else ("-", a, b)


def _blend(share: Node, yes: Node, no: Node) -> Node:
    return ("+", no, ("*", share, ("-", yes, no)))
