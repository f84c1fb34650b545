"""Formulas with jumps or kinks, rewritten as smooth formulas that a stepper integrates from one jump to the next.

A switch is a jump or kink of a formula. It has a guard, which is a smooth formula, and a mode, which is a symbol for
the sign of the guard (1 or -1) or for its floor. The mode is constant between two jumps: ``sign(u)`` becomes s and
``abs(u)`` becomes ``s*u``, with the guard u and the mode s. Standard library only.
"""

from collections.abc import Collection, Iterable, Mapping
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple

from symrot.formula.squares import as_polynomial, square_under_root
from symrot.formula.tree import SWITCHING, Node, children, evaluate, names, parse, text, with_children

__all__ = [
    "CHANGING", "MODES", "STATES", "Conditions", "Smooth", "Switch", "between_sides", "blended", "chosen",
    "condition_error", "has_choices", "has_switches", "hold", "on_line", "placed", "smooth",
]  # fmt: skip

ONE: Node = ("number", Fraction(1))
HALF: Node = ("number", Fraction(1, 2))
PI: Node = ("symbol", "pi")
STATES = ("omega_1", "omega_2", "omega_3", "q0", "q1", "q2", "q3")
"""The names of the states of a motion in formulas: angular velocity in the body frame, and quaternion."""

CHANGING = frozenset({"t", *STATES})
BENDING = {*SWITCHING, "abs", "atan2"}
CONDITIONS = {"less", "and", "or", "not"}
MODES = "switch_"  # prefix of the names of modes
HARMLESS_DEGREE = 6  # polynomials up to this degree are defined everywhere and have no short pulse
RISKY = HARMLESS_DEGREE + 1
"""The degree that stands for formulas that may have a pole, a short pulse or no value somewhere.

A short pulse, such as that of ``exp(-(50*t - 9)**2)``, lasts so short a time that a long step may miss it.
"""

Conditions = tuple[tuple[Node, int], ...]
"""Conditions under which a part of a formula applies, as pairs (formula, value): each formula must have its value.

The symbols of these formulas are modes, which stand for the sign or floor of a guard (see `Switch`). The part a of
``where(t < 1, a, b)`` applies under the condition ``((1 + s)/2, 1)``, where the mode s is the sign of 1 - t.
"""


class Switch(NamedTuple):
    """A jump or kink of a formula: a mode, and the guard whose sign or floor is the mode.

    Attributes
    ----------
    mode : str
        Name of the mode in the smooth formulas.
    kind : str
        ``"sign"``: the mode is the sign of the guard; ``"floor"``: the mode is the largest integer that is not above
        the guard.
    guard : Node
        A smooth formula, which may contain modes.
    where : Conditions
        The switch affects the formula only while these conditions hold.
    label : str
        The call of the function that jumps, as the user wrote it.
    at_zero : int
        Value of the mode while the guard is exactly zero. It follows from sign(0) = 0 and step(0) = 0, and from 0 < 0
        being false.
    """

    mode: str
    kind: str
    guard: Node
    where: Conditions
    label: str
    at_zero: int = 1


class Smooth(NamedTuple):
    """Smooth formulas in place of formulas with jumps and kinks, and a :class:`Switch` for each jump or kink."""

    formulas: tuple[Node, ...]  # with modes, and with where(p, a, b), where p is a formula of modes, equal to 1 or 0
    switches: tuple[Switch, ...]  # a switch comes after the switches whose modes occur in its guard


def has_switches(node: Node) -> bool:
    """Return whether a formula contains a function that jumps or has a kink, such as sign, abs or max."""
    if node[0] == "call" and node[1] in SWITCHING:
        return True
    if node[0] == "call" and node[1] in BENDING and names(node) & CHANGING:
        return True
    if node[:2] == ("call", "sqrt") and names(node) & CHANGING and (split := square_under_root(node[2][0])):
        return bool(names(split[0]) & CHANGING) or has_switches(split[1])
    return any(map(has_switches, children(node)))


def condition_error(node: Node) -> str:
    """Return how the first wrong condition of ``where`` should be written, for a message; empty if none is wrong.

    ``where(1 < t < 2, 1, 0)`` gives "one comparison at a time: ..".
    """

    def wrong(node: Node, condition: bool) -> str:
        if node[0] != "call" or node[1] not in CONDITIONS:
            if condition:
                return "a comparison such as omega_3 < 1 as the first argument of 'where'"
            asked = [node[0] == "call" and node[1] == "where" and k == 0 for k, _ in enumerate(children(node))]
        elif node[1] == "less" and any(part[0] == "call" and part[1] in ("less", "not") for part in node[2]):
            return "one comparison at a time: '1 < t and t < 2' instead of '1 < t < 2'"
        elif not condition:
            return "comparisons only in the first argument of 'where', such as where(t < 1, 1, 0)"
        else:
            asked = [node[1] != "less"] * len(children(node))
        errors = (wrong(child, each) for child, each in zip(children(node), asked, strict=True))
        return next((error for error in errors if error), "")

    return wrong(node, False)


def hold(conditions: Iterable[tuple[Node, int]], modes: Mapping[str, int], held: Collection[str] = ()) -> bool:
    """Return whether all ``conditions``, pairs (formula, value), hold: each formula must have its value.

    The symbols in the formulas are modes: each stands for the sign or floor of a guard, see :class:`Switch`. ``modes``
    maps their names to their present values. ``held`` are the names of modes without a value, because the motion stays
    at the jump (slides along it), where the guard is zero. A condition with such a mode counts as true.
    """
    return all(names(indicator) & set(held) or evaluate(indicator, modes) == value for indicator, value in conditions)


def has_choices(node: Node) -> bool:
    """Return whether a smooth formula still contains a call ``where(p, a, b)``, which :func:`chosen` replaces."""
    return node[:2] == ("call", "where") or any(map(has_choices, children(node)))


def chosen(node: Node, modes: Mapping[str, int], held: Collection[str] = ()) -> Node:
    """Return a formula in which each ``where(p, a, b)`` is replaced by a if p is 1, or by b if p is 0.

    p is a formula whose symbols are modes: each stands for the sign or floor of a guard, see :class:`Switch`. ``modes``
    maps their names to their present values. ``held`` are the names of modes without a value, as for :func:`hold`:
    ``where(p, a, b)`` with such a mode in p is replaced by ``b + p*(a - b)``.
    """
    if not has_choices(node):
        return node
    if node[:2] == ("call", "where"):
        indicator, yes, no = node[2]
        # a motion slides along the switch: the mode changes too fast to be 1 or -1, and the sum is a mean
        if names(indicator) & set(held):
            return _blend(indicator, chosen(yes, modes, held), chosen(no, modes, held))
        return chosen(yes if evaluate(indicator, modes) == 1 else no, modes, held)
    return with_children(node, [chosen(child, modes, held) for child in children(node)])


def blended(node: Node) -> Node:
    """Return a smooth formula in which each ``where(p, a, b)`` is replaced by the sum ``b + p (a - b)``.

    p is a formula of modes (signs that are constant between two jumps), with the value 1 where a applies and 0 where b
    applies. The sum then equals a or b, but it needs the values of both.
    """
    return chosen(node, {}, names(node))


def placed(node: Node, values: Mapping[str, Node]) -> Node:
    """Return the formula in which each symbol whose name is in ``values`` is replaced by the formula given there."""
    if node[0] == "symbol":
        return values.get(node[1], node)
    return with_children(node, [placed(child, values) for child in children(node)])


def on_line(node: Node) -> tuple[Any, int]:
    """Return (key, sign) of a formula; proportional polynomials in symbols and function calls have equal keys.

    ``t - 1`` and ``2 - 2*t`` have the same key and different signs. Any other formula is its own key, with the sign 1.
    """
    polynomial = as_polynomial(node, {})
    if polynomial is None or not polynomial.terms:
        return node, 1
    (_, first), *_ = terms = sorted(polynomial.terms.items())
    # formulas with one key have the same zeros, so that one search for zeros is enough for all of them
    return tuple((monomial, coefficient / first) for monomial, coefficient in terms), 1 if first > 0 else -1


def between_sides(node: Node, mode: str) -> Node:
    """Return a formula that is linear in the symbol ``mode`` and equals ``node`` if the symbol is 1 or -1.

    A mode stands for the sign of a formula, such as that in ``sign(u)``.
    """
    # a motion that slides along a switch has a mean of the rates on both sides (A. F. Filippov), linear in the mode
    if _is_linear(node, mode):
        return node
    above, below = (placed(node, {mode: ("number", Fraction(side))}) for side in (1, -1))
    return _blend(("*", HALF, ("+", ONE, ("symbol", mode))), above, below)


def _is_linear(node: Node, mode: str) -> bool:
    """Return whether a formula, as it is written, is linear in the symbol ``mode`` (of degree 0 or 1)."""
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
    """Return the degree of a formula in time, states and sines of time.

    It is :data:`RISKY` for a polynomial of at least that degree, and for a formula that may have a pole, a short pulse
    or no value somewhere.
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


def _risky(condition: Node) -> bool:
    """Return whether a condition compares a formula that may have a pole, a short pulse or no value somewhere."""
    if condition[1] == "less":
        return max(map(_degree, condition[2])) >= RISKY
    return any(map(_risky, condition[2]))


@lru_cache(maxsize=256)
def smooth(sources: tuple[str, ...]) -> Smooth:
    """Return smooth formulas in place of formulas (given as text) with jumps and kinks, and a switch for each of these.

    ``abs(t)`` becomes ``s*t`` with the symbol s, a mode, which stands for the sign of t. Its switch has the mode s and
    the guard t: the sign changes where t is zero.
    """
    nodes = [parse(source, switching=True) for source in sources]
    used_names = set().union(*map(names, nodes))
    prefix = MODES
    while any(name.startswith(prefix) for name in used_names):
        prefix = f"_{prefix}" if len(prefix) > 40 else f"{prefix}_"
    writer = _Writer(prefix)
    return Smooth(tuple(map(writer.smooth, nodes)), tuple(writer.switches))


# formula            smooth formula                guard
# sign(u)            s                             u, s = 1 or -1
# step(u)            (1 + s)/2                     u
# abs(u)             s u                           u; as it is if u contains only modes, constant between switches
# sqrt(u^2 v)        s u sqrt(v)                   u
# max(a, b)          b + (1 + s)/2 (a - b)         a - b
# where(c, a, b)     b + p (a - b), or a, or b     guards of the condition c, p = 1 or 0
# floor(u)           n                             u - n and n + 1 - u, n whole
# mod(a, b)          a - b n                       guards of floor(a/b)
# atan2(y, x)        as it is for x > 0, else      x, and y where x < 0: atan2 jumps across the negative x axis
#                    s pi - atan2(y, -x)
#
# In where(t > 1, sqrt(t - 1), 0) the root has no value before t = 1, and zero times an undefined value is undefined. A
# part may also have a short pulse at a time when it does not apply, for which the stepper would shorten its steps. So a
# where with such a part stays in the smooth formula until the modes are known; chosen() then replaces it by the part
# that applies, and guards inside the other part are ignored.


class _Writer:
    def __init__(self, prefix: str) -> None:
        self.prefix, self.switches = prefix, list[Switch]()
        self.known: dict[tuple[str, Node, Conditions, int], Node] = {}
        self.label = ""  # the function call that is being rewritten
        self.conditions: Conditions = ()  # conditions under which the part being rewritten applies

    def mode(self, kind: str, guard: Node, conditions: Conditions = (), at_zero: int = 1) -> Node:
        """Return the symbol (mode) that stands for the sign or the floor of the formula ``guard``.

        If there is no such symbol yet, a new :class:`Switch` is added to ``switches``.

        Parameters
        ----------
        kind : str
            ``"sign"`` or ``"floor"``.
        guard : Node
            A smooth formula.
        conditions : Conditions
            Conditions under which the switch affects the formula. In addition it has the condition under which the
            part being rewritten applies, if this is the a or b of a call ``where(c, a, b)``.
        at_zero : int
            Value of the mode while the guard is exactly zero.
        """
        where = self.conditions + conditions
        for count in range(len(where) + 1):  # a mode that applies under fewer of the conditions serves as well
            if (mode := self.known.get((kind, guard, where[:count], at_zero))) is not None:
                return mode
        name = f"{self.prefix}{len(self.switches) + 1}"
        self.switches.append(Switch(name, kind, guard, where, self.label, at_zero))
        self.known[kind, guard, where, at_zero] = ("symbol", name)
        return ("symbol", name)

    def branch(self, node: Node, indicator: Node, value: int) -> Node:
        """Return ``node``, the a or b of ``where(c, a, b)``, as a smooth formula.

        ``indicator`` is a formula that is 1 where c holds and 0 elsewhere. Each new switch (jump or kink) in the node
        is limited to the points where the indicator has the ``value``: 1 for a, 0 for b.
        """
        outside = self.conditions
        self.conditions = (*outside, (indicator, value))
        smooth = self.smooth(node)
        self.conditions = outside
        return smooth

    def smooth(self, node: Node) -> Node:
        kind = node[0]
        if kind in ("number", "symbol"):
            return node
        if kind == "call" and node[1] == "where":
            condition, yes, no = node[2]
            indicator = self.indicator(condition)
            # a risky part is not evaluated while the other part applies
            if max(_degree(yes), _degree(no)) < RISKY:
                return _blend(indicator, self.smooth(yes), self.smooth(no))
            return ("call", "where", (indicator, self.branch(yes, indicator, 1), self.branch(no, indicator, 0)))
        parts = tuple(map(self.smooth, children(node)))
        if node[:2] == ("call", "sqrt") and (split := square_under_root(parts[0])) and names(split[0]) & CHANGING:
            self.label = text(node)
            size = self._abs(split[0])
            return size if split[1] == ONE else ("*", size, ("call", "sqrt", (split[1],)))
        if kind != "call":
            return with_children(node, parts)
        if node[1] not in BENDING or (node[1] in ("abs", "atan2") and not names(node) & CHANGING):
            return with_children(node, parts)
        if node[1] == "abs" and not names(parts[0]) & CHANGING:
            return ("call", "abs", parts)  # an argument of modes alone is constant between switches
        self.label = text(node)
        return getattr(self, f"_{node[1]}")(*parts)  # type: ignore[no-any-return]

    def indicator(self, condition: Node) -> Node:
        """Return a formula of modes that is 1 if a condition holds, otherwise 0.

        ``t < 1`` gives ``(1 + s)/2`` with the symbol s, a mode, which stands for the sign of 1 - t.
        """
        name, parts = condition[1], condition[2]
        if name == "less":
            left, right = map(self.smooth, parts)
            self.label = text(condition)
            return self._step(_difference(right, left))
        indicators = [self.indicator(parts[0])]
        if name == "not":
            return ("-", ONE, indicators[0])
        # in t < 1 and sqrt(1 - t) < omega_1, the root needs a value only before t = 1
        outside, risky = self.conditions, _risky(parts[1])
        self.conditions = (*outside, (indicators[0], int(name == "and"))) if risky else outside
        indicators.append(self.indicator(parts[1]))
        self.conditions = outside
        # t < 1 and omega_1 < 0 gives (1 + s1)/2 * (1 + s2)/2
        both: Node = ("*", *indicators)
        return both if name == "and" else ("-", ("+", *indicators), both)

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
    """Return the formula a - b, or only a if b is 0.

    So ``u > 0`` has the guard u, the same as ``sign(u)``.
    """
    return a if b == ("number", 0) else ("-", a, b)


def _blend(indicator: Node, yes: Node, no: Node) -> Node:
    return ("+", no, ("*", indicator, ("-", yes, no)))
