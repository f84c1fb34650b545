"""Text that printed kernels of several languages share.

It defines functions such as sinc, which <math.h> does not contain (:mod:`symrot.kernels.removable`), and checks the
arrays that a caller passes to a kernel in Python.
"""

from collections.abc import Collection, Iterable, Iterator
from fractions import Fraction

from symrot.formula.program import Argument, Program
from symrot.formula.tree import Node, children, parse
from symrot.kernels.removable import FUNCTIONS, REMOVABLE, Removable

__all__ = ["BRANCH_FREE", "called", "has_branch_free_calls", "own_function", "series", "turning_arguments", "unpacked"]

TURNING = ("sinc", *REMOVABLE)  # functions of symrot that call sine or cosine of their argument
BRANCH_FREE = (*TURNING, "arc_ratio")  # functions of symrot that have a form without branches, for batches

Statement = tuple[str, Node]  # name of a temporary, formula
ONE, ZERO = ("number", Fraction(1)), ("number", Fraction(0))
Choice = tuple[str, Node, Node, Node, Node]  # relation, left, right, then, else
_A, _B, _X, _Y, _S, _C = (("symbol", name) for name in "abxysc")
_CHOICES: dict[str, tuple[tuple[str, ...], Choice]] = {
    "select_ge": (("a", "b", "x", "y"), (">=", _A, _B, _X, _Y)),
    "sinc": (("x",), ("==", _X, ZERO, ONE, ("/", ("call", "sin", (_X,)), _X))),
    "arc_ratio": (("s", "c"), ("==", _S, ZERO, ("/", ONE, _C), ("/", ("call", "atan2", (_S, _C)), _S))),
}


def _calls(program: Program) -> Iterator[tuple[str, tuple[Node, ...]]]:
    """Yield (function name, arguments) of every call in a program's formulas; calls inside arguments come first."""

    def visit(node: Node) -> Iterator[tuple[str, tuple[Node, ...]]]:
        for child in children(node):
            yield from visit(child)
        if node[0] == "call":
            yield node[1], node[2]

    for _, node in program.temporaries + program.outputs:
        yield from visit(node)


def turning_arguments(program: Program) -> list[Node]:
    """Return the formulas of all angles whose sine or cosine a program computes, each once."""
    # sinc and similar functions call sine or cosine of their argument too
    return list(dict.fromkeys(arguments[0] for name, arguments in _calls(program) if name in ("sin", "cos", *TURNING)))


def has_branch_free_calls(program: Program) -> bool:
    """Return whether a program calls a function, such as sin or sinc, that a batch can compute without branches."""
    return any(name in ("sin", "cos", "atan2", "select_ge", *BRANCH_FREE) for name, _ in _calls(program))


def called(program: Program) -> list[str]:
    """Return the names of the functions, such as sinc, that a program calls and <math.h> does not contain."""
    used = {name for name, _ in _calls(program)}
    return [name for name in FUNCTIONS if name in used and (name in _CHOICES or name in REMOVABLE)]


def series(coefficients: Iterable[Fraction], variable: str) -> Node:
    """Return the polynomial with ``coefficients``, lowest power first: a, b, c give ``a + x*(b + x*c)``."""
    first, *rest = reversed(tuple(coefficients))
    node: Node = ("number", first)
    for coefficient in rest:
        node = ("+", ("number", coefficient), ("*", ("symbol", variable), node))
    return node


def own_function(name: str, precision: str) -> tuple[tuple[str, ...], list[Statement], Choice]:
    """Return the definition of a function that <math.h> lacks, such as sinc, as (parameters, temporaries, choice).

    The choice ``("<", left, right, a, b)`` stands for the value ``a if left < right else b``.
    """
    if name in _CHOICES:
        parameters, choice = _CHOICES[name]
        return parameters, [], choice
    return _removable(REMOVABLE[name], precision)


def _removable(which: Removable, precision: str) -> tuple[tuple[str, ...], list[Statement], Choice]:
    square = ("t", ("*", ("symbol", "x"), ("symbol", "x")))
    taylor = ("taylor", series(which.coefficients(precision), "t"))
    direct = ("/", ("/", parse(which.scaled), _X), _X)
    choice = ("<", ("symbol", "t"), ("number", which.split), ("symbol", "taylor"), direct)
    # a Taylor series near zero, its length determined by the precision; elsewhere a quotient
    return ("x",), [square, taylor], choice


def unpacked(argument: Argument, used: Collection[str]) -> str:
    """Return the Python statement, such as ``_, theta, psi = angles``, that names the ``used`` components.

    Python then raises ValueError for an array of another length, such as samples along the first axis. If components
    were read by index instead, NumPy would ignore surplus components, and JAX would use the last component in place
    of missing ones.
    """
    components = [name if name in used else "_" for name, *_ in argument.components]
    return f"    {', '.join(components) if len(components) > 1 else f'({components[0]},)'} = {argument.name}"
