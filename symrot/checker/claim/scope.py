"""The scope in which a claim is evaluated: its names, the divisors and roots of its text, and its error messages."""

from abc import ABC, abstractmethod
from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import sympy
from sympy import Expr, ImmutableMatrix, Mul

from symrot.checker.claim.size import MOST_NESTED, MOST_PIECES, nesting
from symrot.checker.claim.tree import Node
from symrot.errors import InputError, complaint
from symrot.exact.intervals import enclosure
from symrot.exact.limits.size import pieces

__all__ = ["Divisor", "Scope", "described", "is_matrix"]

MOST_BITS_FACTORED = 64


@dataclass(frozen=True)
class Divisor:
    """A divisor in the text of a claim: its SymPy formula, and its position in the tree."""

    value: Expr
    node: Node


def is_matrix(value: Any) -> bool:
    """Return whether a value is a matrix; a column vector is one too."""
    return isinstance(value, sympy.MatrixBase)


def described(value: Any) -> str:
    """Return words for the kind of a value: "a 3 x 1 matrix" or "a scalar"."""
    return f"a {value.rows} x {value.cols} matrix" if is_matrix(value) else "a scalar"


@dataclass
class Scope(ABC):
    """The names of one claim, the divisors and radicands of its text, and error messages with positions.

    Attributes
    ----------
    source, where : str
        The text being read and its place, for error messages.
    values : dict
        Name of a symbol or a definition -> its value.
    functions : set of str
        Functions of time.
    implied : bool
        Whether undeclared names become real symbols and functions of time.
    divisors : list of Divisor
        Divisors in the text that may be zero; each evaluation appends its own.
    radicands : list of Expr
        Formulas that must not be negative, such as those under a root; each evaluation appends its own.
    bases : list of Expr
        Bases of powers whose exponents are not numbers; they are assumed to be positive.
    """

    values: dict[str, Any] = field(default_factory=dict)
    functions: set[str] = field(default_factory=set)
    implied: bool = False
    source: str = ""
    where: str = ""
    divisors: list[Divisor] = field(default_factory=list)
    radicands: list[Expr] = field(default_factory=list)
    bases: list[Expr] = field(default_factory=list)

    @property
    def assumed_bases(self) -> tuple[Expr, ...]:
        """Bases x of powers x^a that must be assumed to be positive, as no log or root of the claim implies it."""
        powers = Counter(self.bases)
        radicands = Counter(self.radicands)
        return tuple(base for base, times in powers.items() if radicands[base] <= times)

    def fail(self, node: Node, expected: str) -> InputError:
        return complaint(self.source, self.where, node.span[0], expected)

    @abstractmethod
    def evaluate(self, node: Node) -> Any:
        """Return the value of a tree: Expr, ImmutableMatrix or a tuple of such values."""

    def scalar(self, node: Node, role: str) -> Expr:
        """Return the value of ``node``; raise InputError if it is a matrix or a list.

        ``role`` is for the message, such as "as an exponent".
        """
        value = self.evaluate(node)
        if is_matrix(value) or isinstance(value, tuple):
            actual = "a list" if isinstance(value, tuple) else described(value)
            raise self.fail(node, f"a scalar {role} instead of {actual}")
        return value

    def argument(self, node: Node, role: str) -> Expr:
        """Return the value of ``node``, an argument of a function; raise InputError if it is no scalar, or nested too
        deeply.

        ``role`` is for the message, such as "as the argument of sin".
        """
        value = self.scalar(node, role)
        self.within_nesting(value, node)
        return value

    def within_nesting(self, value: Expr, node: Node) -> None:
        """Raise InputError if ``value`` has so many nested functions and roots that one more would be too many."""
        if nesting(value) >= MOST_NESTED:
            raise self.fail(node, f"at most {MOST_NESTED} functions and roots inside each other")

    def matrix(self, node: Node, role: str, shape: tuple[int | None, int | None] = (None, None)) -> ImmutableMatrix:
        """Return the value of ``node``; raise InputError if it is no matrix with this number of rows and columns.

        None in ``shape`` stands for any number. A list of scalars is a column.
        """
        value = self.evaluate(node)
        rows, columns = shape
        if isinstance(value, tuple) and all(not isinstance(part, tuple) and not is_matrix(part) for part in value):
            value = ImmutableMatrix(value)  # a bare list of components is a column
        fits = is_matrix(value) and rows in (None, value.rows) and columns in (None, value.cols)
        if not fits:
            expected = "matrix" if shape == (None, None) else f"{rows or 'n'} x {columns or 'n'} matrix"
            actual = "a list" if isinstance(value, tuple) else described(value)
            defined = node.kind == "name" and self.implied and actual == "a scalar"
            hint = f" (write its entries on a line before, {node.value} = [[a, b], [c, d]])" if defined else ""
            raise self.fail(node, f"a {expected} {role} instead of {actual}{hint}")
        return value

    def shape(self, value: Any, node: Node) -> tuple[int, int] | None:
        """Return the shape of a matrix, or None for a scalar; raise InputError for a list."""
        if isinstance(value, tuple):
            raise self.fail(node, "a formula instead of a list (write Matrix([..]))")
        return (value.rows, value.cols) if is_matrix(value) else None

    def bounded(self, value: Any, node: Node, most: int = MOST_PIECES) -> Any:
        """Return the value; raise InputError if it has more than ``most`` symbols, numbers and operations."""
        if pieces(value if is_matrix(value) else [value]) > most:
            raise self.fail(
                node, f"a shorter formula (at most {most} symbols, numbers and operations after evaluation)"
            )
        return value

    def divide_by(self, value: Expr, node: Node) -> None:
        """Record those factors of a divisor that may be zero; raise InputError if the divisor is obviously zero."""
        # a zero that takes a proof, such as sin(x)**2 + cos(x)**2 - 1, is refused when the claim is decided
        if value.is_zero:
            raise self.fail(node, "a divisor that is not zero")
        for factor in Mul.make_args(value):
            base = factor.as_base_exp()[0]
            interval = enclosure(base) if base.is_number else None
            if interval is None or 0 in interval:
                self.divisors.append(Divisor(base, node))

    def factorable(self, value: Expr, node: Node) -> None:
        """Raise InputError if the number ``value`` under a root is too long to be factored."""
        if value.is_Rational and max(int(value.p).bit_length(), int(value.q).bit_length()) > MOST_BITS_FACTORED:
            raise self.fail(node, f"a smaller number under a root (at most {MOST_BITS_FACTORED} bits, to be factored)")

    def take_root(self, value: Expr, node: Node) -> None:
        """Record that ``value``, a formula under a root, must not be negative.

        A number that is zero or positive needs no record. Raise InputError for a negative number, and for a number too
        long to be factored.
        """
        interval = enclosure(value) if value.is_number else None
        if (interval is None and value.is_negative) or (interval is not None and interval.b < 0):
            raise self.fail(node, "a number that is not negative under a root")
        self.factorable(value, node)
        if interval is None or not interval.a >= 0:
            self.radicands.append(value)
