"""The interpreter of claims turns syntax trees into SymPy formulas, by a table with one function per kind of node."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any

import sympy
from sympy import Expr, Function, ImmutableMatrix, Integer, Rational, Symbol
from sympy.core.function import AppliedUndef

from symrot.checker.claim.functions import BUILT_IN, ROTATIONS, arguments_expected, inverted
from symrot.checker.claim.scope import Scope, described, is_matrix
from symrot.checker.claim.tree import Node
from symrot.checker.decide.unordered import is_unordered
from symrot.checker.typed.defined_functions import DISPUTED_NAMES, instead
from symrot.exact.limits.operations import spend

__all__ = ["CONSTANTS", "Interpreter", "atoms_of", "time"]

LARGEST_EXPONENT = 64
"""The largest exponent of a matrix, and the largest numerator of a fractional exponent, as 3 in x^(3/2)."""

LARGEST_WHOLE_EXPONENT = 1_000_000
LARGEST_ROOT = 12
MOST_BITS = 20_000

time = Symbol("t", real=True)

CONSTANTS: dict[str, Expr] = {"pi": sympy.pi}
UNKNOWN_HERE = (
    "ln", "arcsin", "arccos", "arctan", "E", "I", "Rational", "nan", "NaN", "NAN", "inf", "Inf", "INF", "oo", "zoo",
    "infinity", "Infinity", *DISPUTED_NAMES,
)  # fmt: skip
"""Names that a claim must declare to use them as symbols, since to most readers they mean something else."""

INSTEAD = {"I": "I_1", "E": "E_k"}
"""Maps a name that is refused as an undeclared symbol to a name for the quantity that it means in mechanics."""


@dataclass
class Interpreter(Scope):
    """The interpreter of one claim: it knows the claim's names and turns syntax trees into SymPy formulas."""

    def read(self, node: Node, source: str = "", where: str = "") -> Any:
        """Return the value of a tree: Expr or ImmutableMatrix.

        Raises
        ------
        InputError
            If a part of the formula has no value; the message gives its position in ``source``.
        """
        self.source, self.where = source or self.source, where or self.where
        value = self.evaluate(node)
        if isinstance(value, tuple):
            raise self.fail(node, "a formula instead of a list")
        return value

    def evaluate(self, node: Node) -> Any:
        spend(30)
        try:
            return _EVALUATE[node.kind](self, node)
        except (TypeError, AttributeError) as reason:
            if is_unordered(reason):
                raise self.fail(node, "numbers that symrot can compare by size") from None
            raise


def atoms_of(formulas: Iterable[Expr]) -> set[Expr]:
    """Return the symbols, functions of time ``f(t)``, and derivatives in formulas: x and ``diff(f(t), t)`` for
    ``x*diff(f(t), t)``.
    """
    atoms: set[Expr] = set()
    stack = list(formulas)
    while stack:
        node = stack.pop()
        if node.is_Symbol or isinstance(node, AppliedUndef) or node.is_Derivative:
            # the f(t) inside a derivative is no atom of its own
            atoms.add(node)
        else:
            stack.extend(node.args)
    return atoms


# -- the kinds of node ------------------------------------------------------------------------------------------------


def _number(interpreter: Interpreter, node: Node) -> Expr:
    return Rational(node.value.numerator, node.value.denominator)


def _name(interpreter: Interpreter, node: Node) -> Any:
    name = node.value
    if name in interpreter.values:
        return interpreter.values[name]
    if name in CONSTANTS:
        return CONSTANTS[name]
    if name in interpreter.functions:
        raise interpreter.fail(node, f"{name}(t) instead of {name}, which is declared as a function of t")
    if name in BUILT_IN and not (name in ROTATIONS and "_" in name):
        raise interpreter.fail(node, f"brackets after the function {name}")
    if not interpreter.implied:
        raise interpreter.fail(node, f"a name that is declared ({_nearest(name, interpreter)}) instead of {name!r}")
    if name in DISPUTED_NAMES:
        raise interpreter.fail(node, instead(DISPUTED_NAMES[name]))
    if name in UNKNOWN_HERE:
        hint = f" such as {INSTEAD[name]}" if name in INSTEAD else ""
        raise interpreter.fail(
            node, f"a symbol with another name{hint} ({name!r} means something else to most readers)"
        )
    symbol = interpreter.values[name] = time if name == "t" else Symbol(name, real=True)
    return symbol


def _nearest(name: str, interpreter: Interpreter) -> str:
    """Return words for an error message on an undeclared name: the known name nearest to it, or the declared names."""
    known = [*interpreter.values, *interpreter.functions, *CONSTANTS, *BUILT_IN]
    close = get_close_matches(name, known, 1, 0.6)
    declared = ", ".join([*interpreter.values, *interpreter.functions])
    return f"did you mean {close[0]!r}?" if close else f"declared: {declared[:80]}" if declared else "none is declared"


def _sum(interpreter: Interpreter, node: Node) -> Any:
    values = [interpreter.evaluate(term) for term in node.args]
    shapes = {interpreter.shape(value, term) for value, term in zip(values, node.args, strict=True)}
    if len(shapes) == 1:
        if None in shapes:
            return sympy.Add(*values)
        total = values[0]
        for value in values[1:]:
            total = total + value
        return total
    first = described(values[0])
    other, actual = next((n, described(value)) for n, value in enumerate(values) if described(value) != first)
    expected = f"every term of the sum to be {first} like the first one (this one is {actual})"
    raise interpreter.fail(node.args[other], expected)


def _product(interpreter: Interpreter, node: Node) -> Any:
    total: Any = None
    for factor in node.args:
        value = interpreter.evaluate(factor)
        interpreter.shape(value, factor)
        if total is None:
            total = value
        elif is_matrix(total) and is_matrix(value) and total.cols != value.rows:
            raise interpreter.fail(factor, f"a matrix with {total.cols} rows instead of {described(value)}")
        else:
            large = is_matrix(total) and is_matrix(value)
            total = interpreter.bounded(total * value, factor) if large else total * value
    return total


def _negative(interpreter: Interpreter, node: Node) -> Any:
    value = interpreter.evaluate(node.args[0])
    interpreter.shape(value, node.args[0])
    return -value


def _inverse(interpreter: Interpreter, node: Node) -> Any:
    value = interpreter.scalar(node.args[0], "to divide by")
    interpreter.divide_by(value, node.args[0])
    return 1 / value


def _power(interpreter: Interpreter, node: Node) -> Any:
    base, exponent = interpreter.evaluate(node.args[0]), interpreter.scalar(node.args[1], "as an exponent")
    if not exponent.is_Rational and not is_matrix(base):
        return _power_of_positive(interpreter, node, base, exponent)
    if not exponent.is_Rational:
        raise interpreter.fail(node.args[1], "a number as an exponent")
    most = LARGEST_WHOLE_EXPONENT if exponent.q == 1 and not is_matrix(base) else LARGEST_EXPONENT
    if abs(exponent.p) > most or exponent.q > LARGEST_ROOT:
        raise interpreter.fail(node.args[1], f"an exponent up to {most}, or a root of degree at most {LARGEST_ROOT}")
    if is_matrix(base):
        if base.rows != base.cols or exponent.q != 1:
            raise interpreter.fail(node, "a square matrix to a whole power")
        if exponent < 0:
            base = inverted(interpreter, base, node.args[0])
        total = ImmutableMatrix(sympy.eye(base.rows))
        for _ in range(abs(int(exponent))):
            total = interpreter.bounded(total * base, node)
        return total
    interpreter.shape(base, node.args[0])
    if exponent < 0:
        interpreter.divide_by(base, node.args[0])
    if base.is_Rational and abs(exponent.p) * max(int(base.p).bit_length(), int(base.q).bit_length()) > MOST_BITS:
        raise interpreter.fail(node, f"a number of at most {MOST_BITS} bits")
    if exponent.q > 1:  # roots of odd index too: the principal value of a negative number is not real
        interpreter.within_nesting(base, node.args[0])
        interpreter.take_root(base, node.args[0])
    return base**exponent


def _power_of_positive(interpreter: Interpreter, node: Node, base: Expr, exponent: Expr) -> Expr:
    """Return ``exp(exponent*log(base))``: the power of a positive base with an exponent that is not a number."""
    interpreter.shape(base, node.args[0])
    interpreter.within_nesting(exponent, node.args[1])
    if base.is_nonpositive:
        raise interpreter.fail(node.args[0], "a positive number as the base of a power whose exponent is not a number")
    interpreter.within_nesting(base, node.args[0])
    interpreter.divide_by(base, node.args[0])
    interpreter.take_root(base, node.args[0])
    if exponent.free_symbols:  # for a whole exponent the base might be negative too
        interpreter.bases.append(base)
    return sympy.exp(exponent * sympy.log(base))


def _transpose(interpreter: Interpreter, node: Node) -> ImmutableMatrix:
    return interpreter.matrix(node.args[0], "before .T").T


def _index(interpreter: Interpreter, node: Node) -> Expr:
    matrix = interpreter.matrix(node.args[0], "before an index")
    places = [interpreter.scalar(index, "as an index") for index in node.args[1:]]
    if len(places) == 1 and 1 in matrix.shape:
        places = [places[0], Integer(0)] if matrix.cols == 1 else [Integer(0), places[0]]
    if len(places) != 2 or not all(
        place.is_Integer and 0 <= place < size for place, size in zip(places, matrix.shape, strict=True)
    ):
        raise interpreter.fail(node, f"indices, counted from 0, of an entry of {described(matrix)}")
    return matrix[int(places[0]), int(places[1])]


def _list(interpreter: Interpreter, node: Node) -> tuple[Any, ...]:
    return tuple(interpreter.evaluate(member) for member in node.args)


def _call(interpreter: Interpreter, node: Node) -> Any:
    name, arguments = node.value, node.args
    if name in interpreter.functions:
        return _function_of_time(interpreter, node)
    if name in BUILT_IN:
        if wrong := arguments_expected(node):
            raise interpreter.fail(node, wrong)
        return BUILT_IN[name][2](interpreter, node)
    if name in interpreter.values:
        raise interpreter.fail(node, f"an operator between {name} and '(' ({name} is not a function)")
    close = get_close_matches(name, list(BUILT_IN), 1, 0.74)
    if not interpreter.implied or close or name in UNKNOWN_HERE or [a.value for a in arguments] != ["t"]:
        known = (
            f"did you mean {close[0]}?"
            if close
            else f"for a product write {name}*(..); symrot check --help lists the functions"
        )
        expected = f"a built-in function, or one declared as a function of t, instead of {name!r} ({known})"
        if name in DISPUTED_NAMES:
            expected = instead(DISPUTED_NAMES[name])
        raise interpreter.fail(node, expected)
    interpreter.functions.add(name)
    return _function_of_time(interpreter, node)


def _function_of_time(interpreter: Interpreter, node: Node) -> Expr:
    if [(argument.kind, argument.value) for argument in node.args] != [("name", "t")]:
        raise interpreter.fail(node, f"{node.value}(t)")
    if interpreter.evaluate(node.args[0]) != time:
        raise interpreter.fail(node.args[0], "the symbol t")
    return Function(node.value, real=True)(time)


_EVALUATE: dict[str, Callable[[Interpreter, Node], Any]] = {
    "number": _number, "name": _name, "sum": _sum, "product": _product, "neg": _negative, "inv": _inverse,
    "power": _power, "transpose": _transpose, "index": _index, "list": _list, "call": _call,
}  # fmt: skip
