"""Renamings of the symbols of a known formula that respect the axes and angles in the names of the symbols.

The equation ``I_1*omega_1' = (I_3 - I_2)*omega_2*omega_3`` has a wrong sign. Exchanging the symbols I_2 and I_3 would
turn it into Euler's equation. This renaming does not respect the axes: it moves the two moments of inertia to other
axes, but leaves omega_2 and omega_3 where they are. So the equation is not taken for Euler's equation in other letters.
"""

import re
from collections.abc import Mapping, Sequence
from functools import cache

__all__ = ["axes_of", "component", "is_consistent", "quantity_of"]

AXIS = {letter: axis for axis, letters in ((0, "0sw"), (1, "1x"), (2, "2y"), (3, "3z")) for letter in letters}
"""Last letter of a name -> its axis; 0 is the scalar part of a quaternion."""

LETTERS = {"A": 1, "B": 2, "C": 3, "p": 1, "q": 2, "r": 3, "x": 1, "y": 2, "z": 3}
"""Letter without an index -> its axis: A is the principal moment about axis 1, p the roll rate, x a coordinate."""

CYCLIC = ((1, 2, 3), (2, 3, 1), (3, 1, 2))
"""The orders of axes that keep right-handed axes right-handed; Euler's equations change signs under other orders."""

COMPONENTS = {"first": "1", "second": "2", "third": "3", "scalar": "0"}

RATE = re.compile(r"diff\((.+?)(?:, t)+\)|(.+)\(t\)|(\w+?)_d*dot|d{1,2}(phi|theta|psi|omega_[1-3]|q[0-3]|L_[1-3])")
"""Pattern of the text of a rate or function of time: ``diff(phi(t), t)``, ``phi(t)``, ``phi_dot``, ``dphi``.

The one group that matches is the quantity, phi or ``phi(t)``.
"""

ENTRY = re.compile(r"[RrACc]_?([1-3])([1-3])")
"""Pattern of the name of an entry of a rotation matrix; its groups are the row and the column."""

EARLIER_AND_LATER = (("omega_i", "omega_f"), ("theta_i", "theta_f"))
"""Pairs of names in known formulas for one quantity, at an earlier and at a later time."""

MIDDLE, OUTER = ("theta",), ("phi", "psi", "varphi")
"""Names of the second of three Euler angles, and of the first or third."""
ANGLES = {*MIDDLE, *OUTER}


def is_consistent(renaming: Sequence[tuple[str, str]], fixed: bool = False) -> bool:
    """Return whether pairs (known name, new name) agree on the axes: not so for (omega_1, omega_x) with (I_1, I_y).

    Pairs also disagree if they give one name to two quantities or two names to one, exchange a quantity with its rate,
    exchange an initial with a final value, or exchange the middle one of three Euler angles with an outer one. With
    ``fixed``, each axis keeps its number: 1 becomes 1 or x. Otherwise the axes may be permuted in a cycle: 1 to y, 2 to
    z and 3 to x.
    """
    pairs = [_pair_of_quantities(known, new) for known, new in renaming]
    if not _keeps_rates(renaming):
        return False
    if len({*pairs}) != len({known for known, _ in pairs}) or len({*pairs}) != len({new for _, new in pairs}):
        return False
    if not _keeps_time_order(dict(pairs)):
        return False
    angles = [pair for pair in pairs if pair[0] in ANGLES and pair[1] in ANGLES]
    if len(angles) > 1 and any((known in MIDDLE) != (new in MIDDLE) for known, new in angles):
        return False
    plain = transposed = frozenset(CYCLIC[: 1 if fixed else None])
    for known, new in pairs:
        orders, reversed_orders = _orders(known, new)
        plain, transposed = plain & orders, transposed & reversed_orders
        if not plain and not transposed:
            return False
    return True


@cache
def _pair_of_quantities(known: str, new: str) -> tuple[str, str]:
    """Return both names without their time derivatives: (phi, psi) for ``dphi`` and ``diff(psi(t), t)``.

    A function of time becomes the name of its quantity: ``psi(t)`` becomes psi. If ``new`` is neither a rate nor a
    function of time, return both names unchanged.
    """
    quantity = quantity_of(new)
    return (quantity_of(known), quantity) if quantity != new else (known, new)


@cache
def _orders(known: str, new: str) -> tuple[frozenset[tuple[int, ...]], frozenset[tuple[int, ...]]]:
    """Return the cyclic permutations of axes that turn the axes of the symbol ``known`` into those of ``new``.

    The result is a pair of sets of tuples from CYCLIC, the second set for a transposed matrix. The tuple (2, 3, 1)
    replaces axis 1 by 2, 2 by 3 and 3 by 1: omega_1 becomes omega_2, and R_12 becomes R_23 or, transposed, R_32. If one
    of the symbols has no axes, all three permutations are returned.
    """
    axes, own = axes_of(known), axes_of(new)
    moved_axes = {order: {order[axis - 1] if axis else 0 for axis in axes} for order in CYCLIC}
    possible = [order for order in CYCLIC if not axes or not own or moved_axes[order] == own]
    entry, new_entry = ENTRY.fullmatch(known), ENTRY.fullmatch(new)
    if not entry or not new_entry:
        return frozenset(possible), frozenset(possible)
    moved = {order: tuple(str(order[int(place) - 1]) for place in entry.groups()) for order in possible}
    plain = frozenset(order for order in possible if moved[order] == new_entry.groups())
    return plain, frozenset(order for order in possible if moved[order][::-1] == new_entry.groups())


def _keeps_time_order(renaming: Mapping[str, str]) -> bool:
    """Return whether the claim's names for initial and final values are numbered in the order of time.

    ``renaming`` maps symbols of a known formula to names of a claim: with w_2 for the initial omega_i and w_1 for the
    final omega_f, return False. Return True for names without numbers.
    """
    for earlier, later in EARLIER_AND_LATER:
        if earlier in renaming and later in renaming:
            numbers = [name[-1] for name in (renaming[earlier], renaming[later]) if re.search("[0-9]$", name)]
            if len(numbers) == 2 and numbers[0] > numbers[1]:
                return False
    return True


def component(known: str, quantity: str) -> list[tuple[str, str]]:
    """Return [("component_2", "H_y")] if ``known`` is "second component of .." and ``quantity`` is "H_y".

    ``known`` is the name of a known formula. `is_consistent` compares the axes in pairs of names; with this pair, it
    also compares the axis in the formula's name with the axis of the quantity. A formula's name that contains
    "(parallel-axis theorem), y axis" gives [("component_y", quantity)]. Other names give [], and so does a quantity
    without an axis in its name.
    """
    # a moment of inertia by the parallel-axis theorem has an axis, too
    parallel = re.search(r"\(parallel-axis theorem\), ([xyz]) axis", known)
    if parallel and axes_of(quantity):
        return [(f"component_{parallel[1]}", quantity)]
    # with this pair, is_consistent demands that axis 1 becomes x in the other pairs too
    word, _, rest = known.partition(" ")
    if word not in COMPONENTS or not rest.startswith("component") or not axes_of(quantity):
        return []
    return [(f"component_{COMPONENTS[word]}", quantity)]


@cache
def quantity_of(name: str) -> str:
    """Return the quantity that a name belongs to: phi for ``dphi`` and ``phi(t)``; other names stay as they are."""
    while (inner := RATE.fullmatch(name)) is not None:
        name = next(part for part in inner.groups() if part)
    return name


def _keeps_rates(renaming: Sequence[tuple[str, str]]) -> bool:
    """Return whether quantities become quantities and their rates become rates.

    With (q2, diff(q_2(t), t)) and (dq2, q_2(t)), return False: q_2 and its rate are exchanged.
    """
    orders: dict[tuple[str, str], int] = {}
    for known, new in renaming:
        marks = new.count("_prime")
        quantities = quantity_of(known), quantity_of(new.replace("_prime", ""))
        difference = _order_of_rate(new) + marks - _order_of_rate(known)
        if orders.setdefault(quantities, difference) != difference:
            return False
    return True


@cache
def _order_of_rate(name: str) -> int:
    """Return the order of a time derivative: 1 for ``dphi``, 2 for ``diff(phi(t), t, t)``, 0 for ``phi``."""
    if (rate := RATE.fullmatch(name)) is None or rate[2]:
        return 0
    before, _, after = name.partition(quantity_of(name))
    return after.count(", t") or len(re.findall("d", before or after.removesuffix("ot")))


@cache
def axes_of(name: str) -> frozenset[int]:
    """Return the axes that a name states: {1, 2} for I_xy, {3} for omega_3, empty for omega.

    The axis 0 means the scalar part of a quaternion, such as q_0.
    """
    name = re.sub("(_bar|_prime)+$", "", name)
    if re.fullmatch(r"[IJk]_?0|(omega|theta|v)_?0", name):
        return frozenset()  # a moment about a point O, or a value at the start
    if name in LETTERS:
        # such as C, usual for the moment about axis 3
        return frozenset({LETTERS[name]})
    index = re.fullmatch(r"(?:[A-Za-z]+?_?|\w+_)([0-3]|[xyz]|11|22|33|12|13|23|21|31|32|[xyz]{2})", name)
    return frozenset(AXIS[letter] for letter in index[1]) if index else frozenset()
