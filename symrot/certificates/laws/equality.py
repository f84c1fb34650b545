"""Proof that the operations of a C text compute a kernel's formulas exactly, as functions of real numbers.

The C text and the formulas become fractions of polynomials over the inputs, pi and atoms, symbols for function values
such as ``sin(psi)``. A function that is 0/0 at zero, such as sin(x)/x, is recognised by its two branches.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, zip_longest
from typing import Any

from sympy import QQ, Abs, Expr, Integer, Symbol, atan2
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

from symrot.certificates.laws.fractions import FormulaReader, FractionField, Quotient
from symrot.certificates.readback.intended_constants import IntendedConstant, intended_value
from symrot.certificates.readback.operations import Operations, operands
from symrot.errors import CertificateError
from symrot.kernels.removable import REMOVABLE, arc_ratio, explicit, sinc

__all__ = ["FUNCTIONS_WITH_LIMIT", "Equality", "Truncation", "prove_equal"]

MOST_ATOMS = 80


@dataclass(frozen=True)
class Truncation:
    """A truncated series by which the C text computes a function, such as (x - sin x)/x^3, near x = 0."""

    function: str
    # the series is used where x^2 is less than this number
    split: Fraction
    terms: int
    relative: Fraction  # bound of the truncation error, relative to the value


@dataclass(frozen=True)
class Equality:
    """The proof that the C text computes the formula of each output."""

    # constants of the C text that stand for an exact number, such as 1/3
    rounded: tuple[IntendedConstant, ...]
    truncations: tuple[Truncation, ...]


class _AtomField(FractionField):
    """The field of fractions of polynomials over inputs, pi and atoms, which are symbols for function values."""

    def __init__(self, inputs: Sequence[str], name: str) -> None:
        super().__init__(PolyRing([*inputs, "pi", *(f"atom_{k}" for k in range(MOST_ATOMS))], QQ, lex), name)
        self.atoms: dict[tuple[str, tuple[Quotient, ...]], str] = {}

    def atom(self, function: str, arguments: tuple[Quotient, ...]) -> Quotient:
        """Return the symbol (atom) for a function value such as sin(x); ``arguments`` are fractions of polynomials."""
        # equal arguments give the same atom, so that equal function values are equal in the proof
        key = (function, arguments)
        if key not in self.atoms:
            if len(self.atoms) == MOST_ATOMS:
                raise CertificateError(
                    f"expected a kernel with at most {MOST_ATOMS} different function values such as sin(x), got more"
                )
            self.atoms[key] = f"atom_{len(self.atoms)}"
        return self.generator(self.atoms[key])


class _Formulas(FormulaReader):
    """A converter of SymPy formulas to fractions of polynomials, with a symbol for each function value ``sin(x)``."""

    def __init__(self, fractions: _AtomField, named: Sequence[tuple[Symbol, Expr]] = ()) -> None:
        self.fractions: _AtomField = fractions
        self.values = {}
        for symbol, value in named:
            self.values[symbol] = self.read(value)

    def symbol(self, name: str) -> Quotient:
        return self.fractions.generator(name)

    def root(self, square: Quotient) -> Quotient:
        return self.fractions.atom("sqrt", (square,))

    def function(self, expr: Expr) -> Quotient:
        name = "abs" if isinstance(expr, Abs) else expr.func.__name__
        return self.fractions.atom(name, tuple(map(self.read, expr.args)))


# one branch is the function's formula, the other its limit or its series
@dataclass(frozen=True)
class FunctionWithLimit:
    """A function, such as ``sin(x)/x``, that the C text computes by its limit at zero and its formula elsewhere."""

    name: str
    formula: Expr
    limit: Expr
    arguments: tuple[Symbol, ...]


_x, _c = Symbol("x", real=True), Symbol("c", real=True)
FUNCTIONS_WITH_LIMIT = (
    FunctionWithLimit("sinc", explicit(sinc(_x)), (explicit(sinc(_x)) * _x).diff(_x).xreplace({_x: Integer(0)}), (_x,)),
    FunctionWithLimit(
        "arc_ratio", explicit(arc_ratio(_x, _c)), atan2(_x, _c).diff(_x).xreplace({_x: Integer(0)}), (_x, _c)
    ),
)


# Atoms of the C text and of the formulas are equal if their arguments are equal fractions. A constant that is not a
# short binary fraction stands for the simplest fraction or multiple of pi that rounds to it; if the formula has another
# number there, the proof fails.
class _EqualityProver:
    """The evaluation of a C text's operations in exact fractions of polynomials, for comparison with the formulas."""

    # ``symbol_of``: input component such as "q[1]" -> its symbol; ``intended``: symbol -> the formula for which it
    # stands
    def __init__(
        self,
        operations: Operations,
        fractions: _AtomField,
        symbol_of: Mapping[str, str],
        intended: Mapping[str, Quotient],
    ) -> None:
        self.operations, self.fractions, self.symbol_of, self.intended = operations, fractions, symbol_of, intended
        self.values: list[Quotient] = []
        self.rounded: dict[Fraction, IntendedConstant] = {}
        self.truncations: list[Truncation] = []
        self.in_series: set[int] = set()

    def run(self) -> dict[str, Quotient]:
        """Return a map from each output component, such as ``"q[1]"``, to its exact value."""
        nodes = self.operations.nodes
        for node in nodes:
            if node[0] == "select" and node[1] == "<":
                self.in_series |= self._below(node[4], node[2])
        self.in_series -= self._outside_series()
        for index, node in enumerate(nodes):
            self.values.append(self.fractions.number(Fraction(0)) if index in self.in_series else self._value(node))
        return {place: self.values[index] for place, index in self.operations.outputs}

    def _outside_series(self) -> set[int]:
        """Return the indices of the nodes that the outputs use outside truncated series.

        A truncated series is the first value of a conditional ``x*x < c ? series : formula``, by which the C text
        computes a function such as (x - sin x)/x^3 near x = 0.
        """
        outside: set[int] = set()
        waiting = [index for _, index in self.operations.outputs]
        while waiting:
            index = waiting.pop()
            if index not in outside:
                outside.add(index)
                node = self.operations.nodes[index]
                near = 2 if node[0] == "select" and node[1] == "<" else None
                waiting += [each for place, each in enumerate(operands(node)) if place != near]
        return outside

    def _below(self, index: int, leaf: int) -> set[int]:
        """Return the indices of the nodes that compute node ``index`` from node ``leaf``.

        CertificateError is raised unless they are constants, sums and products: a polynomial in node ``leaf``.
        """
        if index == leaf:
            return set()
        node = self.operations.nodes[index]
        if node[0] == "const":
            return {index}
        if node[0] not in ("add", "mul"):
            raise CertificateError(
                f"{self.operations.name}: expected the series in each C conditional x*x < c ? series : formula to "
                f"consist of constants, sums and products, got a series with the operation {node[0]!r}"
            )
        return {index} | self._below(node[1], leaf) | self._below(node[2], leaf)

    def _value(self, node: tuple[Any, ...]) -> Quotient:
        """Return the exact value of one operation (``node``) as a fraction of polynomials.

        The values of its operands must have been computed before.
        """
        fractions, kind = self.fractions, node[0]
        if kind == "in":
            if node[1] not in self.symbol_of:
                expected = f"one of the inputs {', '.join(self.symbol_of)}, got {node[1]}"
                raise CertificateError(f"{self.operations.name}: expected {expected}")
            symbol = self.symbol_of[node[1]]
            return self.intended.get(symbol) or fractions.generator(symbol)
        if kind == "const":
            return self._constant(node[1])
        if kind == "select":
            return self._choice(node)
        if kind == "call":
            return fractions.atom(node[1], tuple(self.values[i] for i in node[2]))
        arguments = [self.values[i] for i in node[1:]]
        if kind in _ARITHMETIC:
            return _ARITHMETIC[kind](fractions, *arguments)
        return fractions.atom(kind, tuple(arguments))

    def _constant(self, value: Fraction) -> Quotient:
        """Return the exact number for which a constant of the C text stands, such as 1/3 for 0.333..."""
        intended = intended_value(value, self.operations.precision)
        if intended.fraction != value or intended.times_pi:
            # the certificate lists the constants that are only a rounding of their exact number
            self.rounded[value] = intended
        number = self.fractions.number(intended.fraction)
        return self.fractions.multiply(number, self.fractions.generator("pi")) if intended.times_pi else number

    def _choice(self, node: tuple[Any, ...]) -> Quotient:
        """Return the exact value of a C conditional ``a < b ? x : y``, which the formulas must contain too."""
        _, relation, *places = node
        if relation == "<":
            return self._series(*places)
        left, right, then, other = (self.values[i] for i in places)
        if relation == ">=":
            return self.fractions.atom("select_ge", (left, right, then, other))
        if relation == "==" and not right[0]:
            for (name, arguments), atom in list(self.fractions.atoms.items()):
                for function in FUNCTIONS_WITH_LIMIT:
                    if (
                        name == function.name
                        and arguments[0] == left
                        and self._is_limit_or_formula(function, arguments, then, other)
                    ):
                        return self.fractions.generator(atom)
        raise CertificateError(
            f"{self.operations.name}: expected each conditional in the C text to be in the formulas of the kernel "
            f"too, got a conditional that the formulas lack, with the relation {relation!r}"
        )

    def _is_limit_or_formula(
        self, function: FunctionWithLimit, arguments: tuple[Quotient, ...], then: Quotient, other: Quotient
    ) -> bool:
        """Return whether ``then`` is the limit of ``function`` at zero, and ``other`` its formula."""
        reader = _Formulas(self.fractions)
        reader.values.update(zip(function.arguments, arguments, strict=True))
        return then == reader.read(function.limit) and other == reader.read(function.formula)

    def _series(self, square: int, split: int, near: int, far: int) -> Quotient:
        """Return the function value that a conditional ``x*x < c ? series : formula`` computes.

        An example is sine_gap(x) = (x - sin x)/x^3. Like every function value it is an atom, a variable of the
        polynomials, and so the result is a fraction of polynomials. The arguments are the indices of the nodes of x*x,
        c, the series and the formula.
        """
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
                return self.fractions.generator(atom)
        raise CertificateError(
            f"{self.operations.name}: expected each conditional x*x < c ? series : formula in the C text to compute a "
            "function in the formulas of the kernel, such as (x - sin(x))/x^3, got a conditional that computes another "
            "function"
        )

    def _coefficients(self, index: int, leaf: int) -> list[Fraction]:
        """Return the coefficients of node ``index`` as a polynomial in node ``leaf``: [2, 3] for 2 + 3*leaf."""
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
        """Return a record, with an error bound, of the Taylor polynomial by which the C text computes a function.

        The C text uses the polynomial for x^2 < ``split``; ``written`` are its coefficients there. CertificateError is
        raised if they are not those of the series of the function ``name``, or if the terms up to the first
        omitted one do not alternate in sign and decrease.
        """
        exact = REMOVABLE[name].taylor(len(written) + 1)
        for value, true in zip(written, exact, strict=False):
            if not IntendedConstant(value, true, False).rounds(self.operations.precision):
                expected = f"the coefficient {true} of the series of {name}"
                raise CertificateError(f"{self.operations.name}: expected {expected}, got {float(value)!r}")
        terms = [abs(a) * split**k for k, a in enumerate(exact)]
        if sorted(terms, reverse=True) != terms or any(a * b >= 0 for a, b in pairwise(exact)):
            raise CertificateError(
                f"{self.operations.name}: expected a series whose terms alternate in sign and decrease up to "
                f"x^2 = {split}, got a series without this property"
            )
        return Truncation(name, split, len(written), terms[-1] / (terms[0] - terms[1]))


_ARITHMETIC: dict[str, Callable[..., Quotient]] = {
    "add": FractionField.add,
    "sub": FractionField.subtract,
    "mul": FractionField.multiply,
    "div": FractionField.divide,
    "neg": FractionField.negative,
}


def prove_equal(
    operations: Operations,
    symbol_of: Mapping[str, str],
    formulas: Mapping[str, Expr],
    named: Sequence[tuple[Symbol, Expr]] = (),
    parameters: Mapping[str, Expr] | None = None,
) -> Equality:
    """Prove that the operations of a C text compute formulas, for all real inputs at which both are defined.

    Parameters
    ----------
    operations : Operations
        The operations that were read from the C text.
    symbol_of : mapping of str to str
        A map from each input component, such as ``"q[1]"``, to its symbol in the formulas.
    formulas : mapping of str to Expr
        A map from each output component, such as ``"dq[1]"``, to its formula.
    named : sequence of (Symbol, Expr)
        Intermediate quantities: symbols that later quantities and the formulas use, with their formulas.
    parameters : mapping of str to Expr, optional
        A map from the symbol of an input to the formula for which it stands, in symbols that are not inputs.

    Raises
    ------
    CertificateError
        If an output differs, or an operation has no counterpart in the formulas; the message names it.
    """
    parameters = parameters or {}
    constants = {str(symbol) for value in parameters.values() for symbol in value.free_symbols}
    fractions = _AtomField(sorted(constants.union(symbol_of.values())), operations.name)
    reader = _Formulas(fractions, named)
    expected = {place: reader.read(formula) for place, formula in formulas.items()}
    intended = {symbol: reader.read(value) for symbol, value in parameters.items()}
    prover = _EqualityProver(operations, fractions, symbol_of, intended)
    computed = prover.run()
    if list(computed) != list(expected):
        raise CertificateError(
            f"{operations.name}: expected the outputs {', '.join(expected)}, got {', '.join(computed)}"
        )
    for place, value in computed.items():
        if value != expected[place]:
            raise CertificateError(
                f"{operations.name}: expected {place} to be {formulas[place]}, but the C text computes another value"
            )
    return Equality(tuple(prover.rounded.values()), tuple(prover.truncations))
