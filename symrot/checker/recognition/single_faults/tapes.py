"""Scalar formulas as tapes: lists of operations, each after its arguments, for many evaluations of one formula.

One pass along the tape gives the value of every part of the formula. One pass back starts from a value that the formula
should have instead, and gives the value that each part should have if only this part is wrong.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from symrot.checker.claim.tree import Node
from symrot.checker.recognition.single_faults.parts import CLOSE, NEUTRAL

__all__ = ["Tape", "tape_of_tree"]

FUNCTIONS: dict[str, Callable[..., float]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "sqrt": math.sqrt, "abs": abs, "acos": math.acos,
    "asin": math.asin, "atan": math.atan,
}  # fmt: skip
INVERSES: dict[str, Callable[[float], float]] = {
    "sqrt": lambda needed: needed**2, "acos": math.cos, "asin": math.sin, "atan": math.tan,
}  # fmt: skip
"""Name of a function -> its inverse, which computes the argument from the value that the call should have."""
SLACK = 1000.0
"""Tolerance of `Tape.may_have_too_much`, a quick test for a superfluous term or factor, in units of ``CLOSE``.

``CLOSE`` is the tolerance of the final test.
"""


class Operation(NamedTuple):
    """One entry of a tape: a symbol, a number, an operation or a function call of the formula."""

    kind: str  # as in Node, and "constant" for pi
    arguments: tuple[int, ...]  # the places of the arguments on the tape
    value: float | str  # of a number; the name of a symbol or function
    parent: str  # the kind of the node above


class Tape(NamedTuple):
    """A scalar formula as a list of operations, each after its arguments; the last one gives the formula's value."""

    operations: tuple[Operation, ...]

    def values(self, symbols: Mapping[str, float]) -> list[float] | None:
        """Return the values of all operations where the symbols have the given values; None if one has no value."""
        values: list[float] = []
        try:
            for kind, arguments, value, _ in self.operations:
                values.append(_value(kind, [values[n] for n in arguments], value, symbols))
        except (ZeroDivisionError, OverflowError, ValueError):
            return None
        return None if any(isinstance(value, complex) for value in values) else values

    def may_have_too_much(self, values: Sequence[Sequence[float]], needed: float) -> bool:
        """Return whether the formula may get the value ``needed`` at the first point by leaving out a term or a factor.

        ``values`` has a list for each point, with the values of all operations in the order of the tape. The test is
        quick: True may be wrong. Numbers, exponents and parts inside sin, cos and tan are not tested.
        """
        own = values[0]
        required: list[float | None] = [None] * len(own)
        required[-1] = needed
        for place in range(len(own) - 1, -1, -1):
            want, operation = required[place], self.operations[place]
            if want is None:
                continue
            neutral = NEUTRAL.get(operation.parent)
            if neutral is not None and operation.kind != "number":
                size = max(abs(at_point[place]) for at_point in values)
                if abs(want - neutral) <= SLACK * CLOSE * (size + neutral):
                    return True
            for argument in operation.arguments:
                required[argument] = _required_value(operation, own, place, argument, want)
        return False


def _value(kind: str, arguments: list[float], value: float | str, symbols: Mapping[str, float]) -> float:
    if kind == "name":
        return symbols[str(value)]
    if kind in ("number", "constant"):
        return float(value)
    if kind == "sum":
        return sum(arguments)
    if kind == "product":
        return math.prod(arguments)
    if kind == "neg":
        return -arguments[0]
    if kind == "inv":
        return 1.0 / arguments[0]
    if kind == "power":
        base, exponent = arguments
        power: float = base**exponent
        return power
    return FUNCTIONS[str(value)](*arguments)


def _required_value(operation: Operation, own: Sequence[float], place: int, argument: int, want: float) -> float | None:
    """Return the value that an argument should have for its operation to have the value ``want``; None if none fits.

    ``own`` has the present values of all operations of the tape; ``place`` and ``argument`` are indices in the tape.
    """
    try:
        if operation.kind == "sum":
            return want - (own[place] - own[argument])
        if operation.kind == "product":
            return want * own[argument] / own[place]
        if operation.kind == "neg":
            return -want
        if operation.kind == "inv":
            return 1.0 / want
        if operation.kind == "power" and argument == operation.arguments[0]:
            exponent = own[operation.arguments[1]]
            size = abs(want) ** (1 / exponent)
            is_even = exponent.is_integer() and exponent % 2 == 0
            return None if want < 0 and is_even else math.copysign(size, own[argument] if is_even else want)
        if operation.value == "abs":
            return math.copysign(want, own[argument])
        inverse = INVERSES.get(str(operation.value)) if operation.kind == "call" else None
        return None if inverse is None else inverse(want)
    except (ArithmeticError, ValueError):
        return None


def tape_of_tree(tree: Node) -> Tape | None:
    """Return a formula as a list of operations, each after its arguments.

    Return None for a formula with a written-out matrix, an index, or a function that is not in ``FUNCTIONS``.
    """
    operations: list[Operation] = []

    def place_of(node: Node, parent: str) -> int | None:
        is_known = node.kind in ("name", "number", "sum", "product", "neg", "inv", "power") or node.value in FUNCTIONS
        places = [place_of(argument, node.kind) for argument in node.args] if is_known else [None]
        if None in places:
            return None
        value = math.pi if node == Node("name", "pi") else node.value
        kind = "constant" if value is math.pi else node.kind
        operations.append(Operation(kind, tuple(n for n in places if n is not None), value, parent))
        return len(operations) - 1

    return None if place_of(tree, "") is None else Tape(tuple(operations))
