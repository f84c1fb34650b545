"""Prove that what was read back from C is the formula it was printed from, exactly, as functions of real numbers.

Both sides become fractions of polynomials over the inputs, pi and atoms: values of functions such as ``sin(psi)``. An
atom of the C text is one of the formula's if their arguments are equal fractions. A function with a removable
singularity (:mod:`symrot.kernels.removable`) is recognised by what it does: each side of its choice is proven to be
what it has to be, the series with a bound of what it leaves out. A constant that is no short binary fraction stands for
the simplest fraction, or fraction of pi, that rounds to it; were that not what is meant, the proof would fail.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, zip_longest
from typing import Any

from sympy import QQ, Abs, Expr, Integer, Symbol, atan2, pi
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyElement, PolyRing

from symrot.certificates.readback.intended_constants import IntendedConstant, intended_value
from symrot.certificates.readback.operations import Operations
from symrot.errors import CertificateError
from symrot.kernels.removable import REMOVABLE, arc_ratio, explicit, sinc

__all__ = ["SAFE", "Equality", "Truncation", "prove_equal"]

Quotient = tuple[PolyElement, PolyElement]  # numerator, denominator, in lowest terms
MOST_ATOMS = 80


@dataclass(frozen=True)
class Truncation:
    """A series in the C text: its function, the square up to which it is summed, and what it leaves out at most."""

    function: str
    split: Fraction
    terms: int
    relative: Fraction  # of the value, bound


@dataclass(frozen=True)
class Equality:
    """What was proven: each output of the C text is its formula.

    ``atoms`` are (symbol, function, arguments) and ``formulas`` (place, numerator, denominator), as text over inputs,
    pi and atoms.
    """

    atoms: tuple[tuple[str, str, tuple[str, ...]], ...]
    formulas: tuple[tuple[str, str, str], ...]
    rounded: tuple[IntendedConstant, ...]
    truncations: tuple[Truncation, ...]


class _Fractions:
    """Fractions of polynomials over named inputs, pi, and atoms that are added as they are met."""

    def __init__(self, inputs: Sequence[str]) -> None:
        names = [*inputs, "pi", *(f"atom_{k}" for k in range(MOST_ATOMS))]
        self.ring = PolyRing(names, QQ, lex)
        self.known = dict(zip(names, self.ring.gens, strict=True))
        self.atoms: dict[tuple[str, tuple[Quotient, ...]], str] = {}

    def number(self, value: Fraction) -> Quotient:
        return self.ring.ground_new(QQ(value.numerator, value.denominator)), self.ring.one

    def of(self, name: str) -> Quotient:
        return self.known[name], self.ring.one

    def lowest(self, above: PolyElement, below: PolyElement) -> Quotient:
        if not below:
            raise CertificateError("expected a formula that is defined somewhere, got a division by zero")
        above, below = above.cancel(below)
        lead = below.LC
        return above.quo_ground(lead), below.quo_ground(lead)

    def add(self, a: Quotient, b: Quotient) -> Quotient:
        return self.lowest(a[0] * b[1] + b[0] * a[1], a[1] * b[1]) if a[1] != b[1] else self.lowest(a[0] + b[0], a[1])

    def negative(self, a: Quotient) -> Quotient:
        return -a[0], a[1]

    def multiply(self, a: Quotient, b: Quotient) -> Quotient:
        return self.lowest(a[0] * b[0], a[1] * b[1])

    def divide(self, a: Quotient, b: Quotient) -> Quotient:
        return self.lowest(a[0] * b[1], a[1] * b[0])

    def atom(self, function: str, arguments: tuple[Quotient, ...]) -> Quotient:
        """Return the value of a function; equal arguments give one and the same atom."""
        key = (function, arguments)
        if key not in self.atoms:
            if len(self.atoms) == MOST_ATOMS:
                raise CertificateError(f"expected at most {MOST_ATOMS} values of functions in a kernel")
            self.atoms[key] = f"atom_{len(self.atoms)}"
        return self.of(self.atoms[key])


class _Formulas:
    """Reads SymPy formulas into fractions."""

    def __init__(self, fractions: _Fractions, named: Sequence[tuple[Symbol, Expr]] = ()) -> None:
        self.fractions = fractions
        self.values: dict[Expr, Quotient] = {}
        for symbol, value in named:
            self.values[symbol] = self.read(value)

    def read(self, expr: Expr) -> Quotient:
        if expr not in self.values:
            self.values[expr] = self._read(expr)
        return self.values[expr]

    def _read(self, expr: Expr) -> Quotient:
        fractions = self.fractions
        if expr.is_Rational:
            return fractions.number(Fraction(int(expr.p), int(expr.q)))
        if expr.is_Symbol or expr is pi:
            return fractions.of(str(expr))
        if expr.is_Add or expr.is_Mul:
            combine = fractions.add if expr.is_Add else fractions.multiply
            first, *rest = map(self.read, expr.args)
            for value in rest:
                first = combine(first, value)
            return first
        if expr.is_Pow and (2 * expr.exp).is_Integer:
            base = self.read(expr.base)
            if not expr.exp.is_Integer:
                base = fractions.atom("sqrt", (base,))
            power = int(expr.exp if expr.exp.is_Integer else 2 * expr.exp)
            above, below = base if power > 0 else (base[1], base[0])
            return fractions.lowest(above ** abs(power), below ** abs(power))
        name = "abs" if isinstance(expr, Abs) else expr.func.__name__
        return fractions.atom(name, tuple(map(self.read, expr.args)))


@dataclass(frozen=True)
class Safe:
    """A function that the C text computes by a choice: at one point by its limit, elsewhere by its formula."""

    name: str
    formula: Expr
    limit: Expr
    arguments: tuple[Symbol, ...]


_x, _c = Symbol("x", real=True), Symbol("c", real=True)
SAFE = (
    Safe("sinc", explicit(sinc(_x)), (explicit(sinc(_x)) * _x).diff(_x).xreplace({_x: Integer(0)}), (_x,)),
    Safe("arc_ratio", explicit(arc_ratio(_x, _c)), atan2(_x, _c).diff(_x).xreplace({_x: Integer(0)}), (_x, _c)),
)


class _Prover:
    """Follows the operations of a kernel as fractions."""

    def __init__(
        self, operations: Operations, fractions: _Fractions, symbol_of: Mapping[str, str], meant: Mapping[str, Quotient]
    ) -> None:
        self.operations, self.fractions, self.symbol_of, self.meant = operations, fractions, symbol_of, meant
        self.values: list[Quotient] = []
        self.rounded: dict[Fraction, IntendedConstant] = {}
        self.truncations: list[Truncation] = []
        self.in_series: set[int] = set()

    def run(self) -> dict[str, Quotient]:
        """Return the outputs by place."""
        nodes = self.operations.nodes
        for node in nodes:
            if node[0] == "select" and node[1] == "<":
                self.in_series |= self._below(node[4], node[2])
        for index, node in enumerate(nodes):
            self.values.append(self.fractions.number(Fraction(0)) if index in self.in_series else self._value(node))
        return {place: self.values[index] for place, index in self.operations.outputs}

    def _below(self, index: int, leaf: int) -> set[int]:
        """Return the sums, products and constants under a node, down to a leaf."""
        if index == leaf:
            return set()
        node = self.operations.nodes[index]
        if node[0] == "const":
            return {index}
        if node[0] not in ("add", "mul"):
            raise CertificateError(f"{self.operations.name}: expected a polynomial where a series is summed")
        return {index} | self._below(node[1], leaf) | self._below(node[2], leaf)

    def _value(self, node: tuple[Any, ...]) -> Quotient:
        fractions, kind = self.fractions, node[0]
        if kind == "in":
            if node[1] not in self.symbol_of:
                said = f"no input but {', '.join(self.symbol_of)}, got {node[1]}"
                raise CertificateError(f"{self.operations.name}: expected {said}")
            symbol = self.symbol_of[node[1]]
            return self.meant.get(symbol) or fractions.of(symbol)
        if kind == "const":
            return self._constant(node[1])
        if kind == "select":
            return self._choice(node)
        if kind == "call":
            return fractions.atom(node[1], tuple(self.values[i] for i in node[2]))
        taken = [self.values[i] for i in node[1:]]
        if kind in _ARITHMETIC:
            return _ARITHMETIC[kind](fractions, *taken)
        return fractions.atom(kind, tuple(taken))

    def _constant(self, value: Fraction) -> Quotient:
        meant = intended_value(value, self.operations.precision)
        if meant.fraction != value or meant.times_pi:
            self.rounded[value] = meant
        number = self.fractions.number(meant.fraction)
        return self.fractions.multiply(number, self.fractions.of("pi")) if meant.times_pi else number

    def _choice(self, node: tuple[Any, ...]) -> Quotient:
        _, relation, *places = node
        if relation == "<":
            return self._series(*places)
        left, right, then, other = (self.values[i] for i in places)
        if relation == ">=":
            return self.fractions.atom("select_ge", (left, right, then, other))
        if relation == "==" and not right[0]:
            for (name, arguments), atom in list(self.fractions.atoms.items()):
                for safe in SAFE:
                    if name == safe.name and arguments[0] == left and self._is(safe, arguments, then, other):
                        return self.fractions.of(atom)
        raise CertificateError(
            f"{self.operations.name}: expected a choice that is part of the formula, got {relation!r}"
        )

    def _is(self, safe: Safe, arguments: tuple[Quotient, ...], then: Quotient, other: Quotient) -> bool:
        """Tell whether a choice takes the limit of a function at zero and its formula elsewhere."""
        reader = _Formulas(self.fractions)
        reader.values.update(zip(safe.arguments, arguments, strict=True))
        return then == reader.read(safe.limit) and other == reader.read(safe.formula)

    def _series(self, square: int, split: int, near: int, far: int) -> Quotient:
        """Return the function whose series and whose formula the choice between ``near`` and ``far`` holds."""
        for (name, arguments), atom in list(self.fractions.atoms.items()):
            if name not in REMOVABLE or self.fractions.multiply(arguments[0], arguments[0]) != self.values[square]:
                continue
            reader = _Formulas(self.fractions)
            reader.values[_x] = arguments[0]
            if self.values[far] != reader.read(REMOVABLE[name].formula(_x)):
                continue
            kind, limit = self.operations.nodes[split]
            if kind == "const":
                self.truncations.append(self._truncated(name, limit, self._coefficients(near, square)))
                return self.fractions.of(atom)
        raise CertificateError(f"{self.operations.name}: expected the series of a function of the formula")

    def _coefficients(self, index: int, leaf: int) -> list[Fraction]:
        """Return the coefficients of a polynomial in the value of ``leaf``, lowest first."""
        if index == leaf:
            return [Fraction(0), Fraction(1)]
        node = self.operations.nodes[index]
        if node[0] == "const":
            return [node[1]]
        left, right = self._coefficients(node[1], leaf), self._coefficients(node[2], leaf)
        if node[0] == "add":
            return [a + b for a, b in zip_longest(left, right, fillvalue=Fraction(0))]
        product = [Fraction(0)] * (len(left) + len(right) - 1)
        for i, a in enumerate(left):
            for j, b in enumerate(right):
                product[i + j] += a * b
        return product

    def _truncated(self, name: str, split: Fraction, written: list[Fraction]) -> Truncation:
        exact = REMOVABLE[name].taylor(len(written) + 1)
        for value, true in zip(written, exact, strict=False):
            if not IntendedConstant(value, true, False).rounds(self.operations.precision):
                expected = f"the coefficient {true} of the series of {name}"
                raise CertificateError(f"{self.operations.name}: expected {expected}, got {float(value)!r}")
        terms = [abs(a) * split**k for k, a in enumerate(exact)]
        if sorted(terms, reverse=True) != terms or any(a * b >= 0 for a, b in pairwise(exact)):
            raise CertificateError(f"{self.operations.name}: expected a series that falls up to x^2 = {split}")
        return Truncation(name, split, len(written), terms[-1] / (terms[0] - terms[1]))


_ARITHMETIC: dict[str, Callable[..., Quotient]] = {
    "add": _Fractions.add,
    "sub": lambda fractions, a, b: fractions.add(a, fractions.negative(b)),
    "mul": _Fractions.multiply,
    "div": _Fractions.divide,
    "neg": _Fractions.negative,
}


def prove_equal(
    operations: Operations,
    symbol_of: Mapping[str, str],
    formulas: Mapping[str, Expr],
    named: Sequence[tuple[Symbol, Expr]] = (),
    parameters: Mapping[str, Expr] | None = None,
) -> Equality:
    """Prove that operations compute given formulas, for real numbers wherever both are defined.

    Parameters
    ----------
    operations : Operations
        As read back from C.
    symbol_of : mapping of str to str
        Place of an input (``"q[1]"``) -> symbol in the formulas.
    formulas : mapping of str to Expr
        Place of an output -> formula.
    named : sequence of (Symbol, Expr)
        Quantities that later ones and the formulas use by a symbol.
    parameters : mapping of str to Expr, optional
        What symbols of inputs stand for, in symbols that are no inputs.

    Raises
    ------
    CertificateError
        Naming the first output that differs, or what is not understood.
    """
    parameters = parameters or {}
    constants = {str(symbol) for value in parameters.values() for symbol in value.free_symbols}
    fractions = _Fractions(sorted(constants.union(symbol_of.values())))
    reader = _Formulas(fractions, named)
    wanted = {place: reader.read(formula) for place, formula in formulas.items()}
    meant = {symbol: reader.read(value) for symbol, value in parameters.items()}
    prover = _Prover(operations, fractions, symbol_of, meant)
    found = prover.run()
    if list(found) != list(wanted):
        raise CertificateError(f"{operations.name}: expected the outputs {', '.join(wanted)}, got {', '.join(found)}")
    for place, value in found.items():
        if value != wanted[place]:
            raise CertificateError(f"{operations.name}: expected {place} to be {formulas[place]}, and it is not")
    return Equality(
        tuple((symbol, name, tuple(map(_text, taken))) for (name, taken), symbol in fractions.atoms.items()),
        tuple((place, str(above), str(below)) for place, (above, below) in wanted.items()),
        tuple(prover.rounded.values()),
        tuple(prover.truncations),
    )


def _text(value: Quotient) -> str:
    above, below = value
    return str(above) if below == 1 else f"({above})/({below})"
