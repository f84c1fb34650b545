"""Recording of straight-line programs: numbers that append each operation on them to a record.

A method is written once for any kind of number. If it is evaluated with recording numbers, the record of the operations
becomes a program.
"""

from collections import Counter
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from symrot.codegen.lowering.tape import Operation
from symrot.codegen.lowering.temporary_names import with_names
from symrot.codegen.powers import power
from symrot.formula.program import Program, Signature
from symrot.formula.tree import Node

__all__ = ["Recorded", "Recorder", "is_exactly"]

ANONYMOUS = "#"  # first letter of temporaries that get their names later
MOST_LEVELS = 200  # deepest nesting of operations in one formula: functions over trees recurse once per level
LEAST, LARGEST = Fraction(1, 10**290), Fraction(10) ** 290  # bounds of a merged factor: a double holds all its digits


class Recorder:
    """A record of the operations of one computation, from which :meth:`program` makes a straight-line program.

    The method ``symbol`` returns an input of the program.
    """

    def __init__(self) -> None:
        self.operations: list[Operation] = []
        self.known: dict[Operation, int] = {}

    def add(self, kind: str, *operands: int, value: Any = None) -> "Recorded":
        # equal operations have one entry
        operation = Operation(kind, operands, value)
        index = self.known.setdefault(operation, len(self.operations))
        if index == len(self.operations):
            self.operations.append(operation)
        return Recorded(self, index)

    def symbol(self, name: str) -> "Recorded":
        return self.add("symbol", value=name)

    def constant(self, value: Fraction) -> Fraction:
        return value

    def index(self, value: Any) -> int:
        return value.index if isinstance(value, Recorded) else self.add("number", value=Fraction(value)).index

    def multiple(self, factor: Fraction, index: int) -> "Recorded":
        """Record ``factor`` times the result of the operation ``index``; two times two times x becomes 4 x."""
        kind, operands, _ = self.operations[index]
        if kind == "*" and self.operations[operands[0]].kind == "number":
            both: Fraction = factor * self.operations[operands[0]].value
            if LEAST < abs(both) < LARGEST:
                product: Recorded = Recorded(self, operands[1]) * both
                return product
        return self.add("*", self.index(factor), index)

    def function(self, name: str) -> Callable[..., "Recorded"]:
        return lambda *arguments: self.add(f"call {name}", *(self.index(argument) for argument in arguments))

    def program(self, signature: Signature, outputs: Mapping[str, Any]) -> Program:
        """Return the straight-line program that computes ``outputs``, a mapping from names to recorded numbers."""
        roots = {name: self.index(value) for name, value in outputs.items()}
        operations = self.operations
        uses = Counter(roots.values())
        # operations that no output needs are left out
        needed = set(roots.values())
        for index in range(len(operations) - 1, -1, -1):
            if index in needed:
                uses.update(operations[index].operands)
                needed.update(operations[index].operands)
        nodes: dict[int, Node] = {}
        depths: dict[int, int] = {}
        temporaries: list[tuple[str, Node]] = []
        for index in sorted(needed):
            kind, operands, value = operations[index]
            if kind in ("number", "symbol"):
                nodes[index], depths[index] = (kind, value), 1
                continue
            parts = tuple(nodes[i] for i in operands)
            node: Node = ("call", kind.removeprefix("call "), parts) if kind.startswith("call ") else (kind, *parts)
            depths[index] = 1 + max(depths[i] for i in operands)
            # a repeated result, a call or a formula of very many levels becomes a temporary
            if uses[index] > 1 or node[0] == "call" or depths[index] > MOST_LEVELS:
                temporaries.append((f"{ANONYMOUS}{index}", node))
                node, depths[index] = ("symbol", f"{ANONYMOUS}{index}"), 1
            nodes[index] = node
        program = Program(signature, tuple(temporaries), tuple((name, nodes[i]) for name, i in roots.items()))
        return with_names(program, [name for name, _ in temporaries], {})


class Recorded:
    """A symbolic number: an operation with it, such as ``a + b``, is recorded by ``recorder`` instead of computed."""

    def __init__(self, recorder: Recorder, index: int) -> None:
        # index: the position of the operation that computes this number
        self.recorder, self.index = recorder, index

    def _operation(self, kind: str, left: Any, right: Any) -> "Recorded":
        return self.recorder.add(kind, self.recorder.index(left), self.recorder.index(right))

    def __add__(self, other: Any) -> "Recorded":
        # operations that change nothing, such as adding 0, are not recorded
        return self if is_exactly(other, 0) else self._operation("+", self, other)

    def __radd__(self, other: Any) -> "Recorded":
        return self if is_exactly(other, 0) else self._operation("+", other, self)

    def __sub__(self, other: Any) -> "Recorded":
        return self if is_exactly(other, 0) else self._operation("-", self, other)

    def __rsub__(self, other: Any) -> "Recorded":
        return -self if is_exactly(other, 0) else self._operation("-", other, self)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Recorded):
            return self._operation("*", self, other)
        if other in (0, 1, -1):
            return 0 if other == 0 else self if other == 1 else -self
        return self.recorder.multiple(Fraction(other), self.index)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Any:
        return self._operation("/", self, other) if isinstance(other, Recorded) else self * (1 / Fraction(other))

    def __rtruediv__(self, other: Any) -> Any:
        return 0 if is_exactly(other, 0) else self._operation("/", other, self)

    def __neg__(self) -> "Recorded":
        return self.recorder.add("neg", self.index)

    def __pow__(self, exponent: int) -> Any:
        return power(self, exponent)


def is_exactly(value: Any, number: int) -> bool:
    """Return whether ``value`` is a number equal to ``number``, such as 0; False for a :class:`Recorded`."""
    # the value of a Recorded is unknown while a program is recorded
    return not isinstance(value, Recorded) and bool(value == number)
