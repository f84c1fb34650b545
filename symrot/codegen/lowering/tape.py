"""Tapes: straight-line programs as lists of single operations, in which equal operations occur only once.

Two kinds of C code treat each operation separately and are therefore printed from a tape: conserved quantities with
their gradients (:mod:`symrot.codegen.taylor.invariant_source`), and event functions with bounds of their rounding
errors (:mod:`symrot.codegen.printing.event_source`). Standard library only.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from symrot.formula.program import Program
from symrot.formula.tree import Node, children

__all__ = ["Operation", "Tape", "tape_of"]


class Operation(NamedTuple):
    """One entry of a tape: an arithmetic operation, a function call, a number, or an input of a program.

    A tape lists such entries in the order of computation.
    """

    # + - * / neg, the name of a function such as sin, number or symbol
    kind: str
    operands: tuple[int, ...] = ()  # indices of earlier entries
    value: Any = None  # the Fraction of a number, the name of a symbol


class Tape(NamedTuple):
    """Operations in order of computation, and for each output the index of the operation that computes it."""

    operations: tuple[Operation, ...]
    outputs: tuple[int, ...]

    def of(self, output: int) -> list[int]:
        """Return the indices of the operations that output number ``output`` needs, in the order of computation."""
        needed = {self.outputs[output]}
        for index in range(self.outputs[output], -1, -1):
            if index in needed:
                needed.update(self.operations[index].operands)
        return sorted(needed)


class _Writer:
    def __init__(self) -> None:
        self.known: dict[Operation, int] = {}
        self.names: dict[str, int] = {}

    def add(self, kind: str, *operands: int, value: Any = None) -> int:
        return self.known.setdefault(Operation(kind, operands, value), len(self.known))

    def read(self, node: Node) -> int:
        kind = node[0]
        if kind == "number":
            return self.add("number", value=node[1])
        if kind == "symbol":
            return self.names[node[1]] if node[1] in self.names else self.add("symbol", value=node[1])
        parts = [self.read(child) for child in children(node)]
        if kind == "**":
            return self.power(parts[0], node[2])
        return self.add(node[1] if kind == "call" else kind, *parts)

    def power(self, base: int, exponent: int) -> int:
        if exponent < 0:
            return self.add("/", self.add("number", value=Fraction(1)), self.power(base, -exponent))
        if exponent == 0:
            return self.add("number", value=Fraction(1))
        result = base
        for bit in format(exponent, "b")[1:]:
            result = self.add("*", result, result)
            result = self.add("*", result, base) if bit == "1" else result
        return result


def tape_of(program: Program, outputs: Sequence[str], more: Sequence[Node] = ()) -> Tape:
    """Return the tape (list of single operations) of named ``outputs`` of a program, and of the formulas ``more``."""
    writer = _Writer()
    formulas = dict(program.outputs)
    for name, node in program.temporaries:
        writer.names[name] = writer.read(node)
    places = [writer.read(formulas[name]) for name in outputs]
    if more:
        # these formulas may contain inputs and outputs of the program; each is a further output of the tape
        writer.names |= {name: writer.read(node) for name, node in formulas.items()}
        places += [writer.read(node) for node in more]
    return _trimmed(Tape(tuple(writer.known), tuple(places)))


def _trimmed(tape: Tape) -> Tape:
    """Return a tape without the operations that none of its outputs needs."""
    used = sorted({index for output in range(len(tape.outputs)) for index in tape.of(output)})
    place = {old: new for new, old in enumerate(used)}
    operations = (tape.operations[old] for old in used)
    return Tape(
        tuple(op._replace(operands=tuple(place[i] for i in op.operands)) for op in operations),
        tuple(place[old] for old in tape.outputs),
    )
