"""Formulas of outputs and of their derivatives, in several forms that differ in the number of operations.

All forms are equal in exact arithmetic; the caller counts the operations of each and chooses. The derivatives come from
the chain rule, from forward accumulation (each temporary is differentiated with respect to the inputs) or from backward
accumulation (each output is differentiated with respect to the temporaries). A temporary is an intermediate result.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import sympy
from sympy import Abs, Add, Expr, Function, Rational, S, Symbol

from symrot.codegen.lowering.lower import ANONYMOUS, Lowered, lower
from symrot.codegen.lowering.tape import tape_of
from symrot.formula.program import Program, Signature
from symrot.formula.tree import FUNCTIONS, Node, evaluate
from symrot.kernels.derivative import exact_derivative
from symrot.kernels.jacobian import BY
from symrot.kernels.removable import DERIVATIVES
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

__all__ = ["Formulas", "cheapest", "ways"]

_ARITHMETIC = ("+", "-", "*", "/", "neg")
_OWN = {name: Function(name, real=True) for name in OWN_FUNCTIONS}
_FUNCTIONS = {name: Abs if name == "abs" else getattr(sympy, name) for name in FUNCTIONS} | _OWN

Entries = Sequence[tuple[str, str]]  # names of an output and of the input with respect to which it is differentiated
Groups = Sequence[Sequence[str]]  # inputs that belong together, such as the components of a vector


@dataclass(frozen=True)
class Formulas:
    """Formulas of a kernel's outputs, and of the temporaries (intermediate quantities) that occur in them."""

    # pairs (name, formula), such as ("y", sin(s)/s)
    outputs: tuple[tuple[str, Expr], ...]
    # pairs (symbol, formula) of temporaries in order of computation, such as (s, sqrt(a + b)); a formula may contain
    # the symbols before it
    named: tuple[tuple[Symbol, Expr], ...] = ()

    @classmethod
    def of(cls, program: Program) -> "Formulas":
        """Return the formulas of a program; its temporaries are the intermediate quantities."""
        inputs = [name for a in program.signature.arguments if a.role == "in" for name, *_ in a.components]
        symbols = {name: Symbol(name, real=True) for name in [*inputs, *(name for name, _ in program.temporaries)]}

        def formula(node: Node) -> Expr:
            return evaluate(node, symbols, _FUNCTIONS, _rational)

        return cls(
            tuple((name, formula(node)) for name, node in program.outputs),
            tuple((symbols[name], formula(node)) for name, node in program.temporaries),
        )

    @property
    def explicit(self) -> "Formulas":
        """The same outputs as formulas in the inputs alone: ``u + 1`` with u = a*b becomes ``a*b + 1``."""
        outputs = []
        for name, formula in self.outputs:
            for symbol, value in reversed(self.named):
                formula = formula.xreplace({symbol: value})
            outputs.append((name, formula))
        return Formulas(tuple(outputs))


def ways(value: Formulas, chained: Formulas, base: Program, entries: Entries, groups: Groups) -> Iterator[Formulas]:
    """Yield the formulas of a kernel's outputs and their derivatives, once for each way to compute them.

    All results are equal in exact arithmetic.

    Parameters
    ----------
    value : Formulas
        The outputs, without derivatives.
    chained : Formulas
        The outputs and their derivatives, computed by the chain rule. This is the first result.
    base : Program
        A program that computes the outputs alone; its temporaries are differentiated too.
    entries : sequence of (output, input)
        Names of the derivatives d(output)/d(input), in the order in which they are printed.
    groups : sequence of sequences of str
        Groups of inputs, such as the three components of omega. If an output is linear in a group, as ``a*x + b*y``
        is in (x, y), further ways compute it from its derivatives a and b.

    Notes
    -----
    A derivative of sin(x)/x contains divisions by x, which give NaN at x = 0. The chain rule writes it in functions
    that are finite there. So programs that call sinc and similar functions are differentiated by the chain rule alone.
    """
    explicit = _explicit(value.explicit, entries)
    every = [chained]
    if not set(base.operations()) & set(DERIVATIVES):
        every.append(explicit)
        own = Formulas.of(base)
        for formulas in (own, Formulas.of(_single_operations(base)), _with_coefficients(own, entries)):
            every += [_forward(formulas, entries), _backward(formulas, entries)]
    linear = _linear_outputs(explicit, entries, groups)
    yield from every
    for formulas in every if linear else ():
        yield _with_sums(formulas, linear)


def cheapest(signature: Signature, formulas: Iterable[Formulas], parameter_argument: str = "p") -> Lowered:
    """Return the program with the fewest operations among programs for equal formulas.

    Changes of sign are not counted, except to choose between programs that are equal in the number of other operations.

    Parameters
    ----------
    signature : Signature
        Name and arguments of the program, without the array argument for constants.
    formulas : iterable of Formulas
        The results of :func:`ways`, which all describe the same outputs.
    parameter_argument : str
        Name of the array argument for constants, which this function adds.

    Returns
    -------
    Lowered
        The program and the formulas of its constants.
    """

    def cost(lowered: Lowered) -> tuple[int, int]:
        counts = lowered.program.operations()
        return counts.total() - counts["neg"], counts["neg"]  # changes of sign decide between equal counts

    every = (lower(signature, each.outputs, each.named, parameter_argument) for each in formulas)
    return min(every, key=cost)


def _rational(value: Fraction) -> Rational:
    return Rational(value.numerator, value.denominator)


def _entry(output: str, variable: str) -> str:
    return f"{output}{BY}{variable}"


def _explicit(value: Formulas, entries: Entries) -> Formulas:
    """Return the outputs ``value`` and their derivatives ``entries``, each as one formula in the inputs."""
    formulas = dict(value.outputs)
    slopes = []
    for output, variable in entries:
        symbol = _symbols(formulas[output]).get(variable)
        slope = S.Zero if symbol is None else exact_derivative(formulas[output], symbol)
        slopes.append((_entry(output, variable), slope))
    return Formulas((*value.outputs, *slopes))


def _symbols(formula: Expr) -> Mapping[str, Symbol]:
    return {str(symbol): symbol for symbol in formula.free_symbols}


def _single_operations(program: Program) -> Program:
    """Return a program for the same outputs in which each assignment has one operation: ``y = a*b + c`` becomes two."""
    names = [name for name, _ in program.outputs]
    tape = tape_of(program, names)
    nodes: list[Node] = []
    temporaries: list[tuple[str, Node]] = []
    for kind, operands, value in tape.operations:
        if kind in ("number", "symbol"):
            nodes.append((kind, value))
            continue
        parts = tuple(nodes[i] for i in operands)
        name = f"{ANONYMOUS}step_{len(temporaries)}"
        temporaries.append((name, (kind, *parts) if kind in _ARITHMETIC else ("call", kind, parts)))
        nodes.append(("symbol", name))
    outputs = tuple(zip(names, (nodes[i] for i in tape.outputs), strict=True))
    return Program(program.signature, tuple(temporaries), outputs)


def _slopes(formula: Expr, value: Symbol | None = None) -> dict[Symbol, Expr]:
    """Return the partial derivatives of a formula with respect to each symbol in it: a map from symbols to derivatives.

    The derivatives may contain ``value``, the symbol for the formula itself: y = sqrt(a) has the derivative 1/(2 y)
    with respect to a.
    """
    held = sorted(formula.free_symbols, key=str)
    above, below = formula.as_numer_denom()
    # y = sqrt(a) has the derivative a'/(2 y), without a second root
    if value is not None and formula.is_Pow and formula.exp == Rational(1, 2):
        return {s: exact_derivative(formula.base, s) / (2 * value) for s in held}
    # y = a/b has the derivative (a' - y b')/b, without b^2
    if value is not None and below.free_symbols:
        return {s: (exact_derivative(above, s) - value * exact_derivative(below, s)) / below for s in held}
    return {s: exact_derivative(formula, s) for s in held}


def _forward(value: Formulas, entries: Entries) -> Formulas:
    inputs = {variable for _, variable in entries}
    named: list[tuple[Symbol, Expr]] = []
    slopes: dict[Symbol, dict[str, Expr]] = {}

    def total(formula: Expr, symbol: Symbol | None) -> dict[str, Expr]:
        result: dict[str, Expr] = {}
        for inner, slope in _slopes(formula, symbol).items():
            by = slopes.get(inner, {str(inner): S.One} if str(inner) in inputs else {})
            for name, inner_slope in by.items():
                result[name] = result.get(name, S.Zero) + slope * inner_slope
        return result

    for symbol, formula in value.named:
        named.append((symbol, formula))
        rates = {name: slope for name, slope in total(formula, symbol).items() if slope != 0}
        slopes[symbol] = {name: _symbol(named, _entry(str(symbol), name), slope) for name, slope in rates.items()}
    rows = {name: total(formula, None) for name, formula in value.outputs}
    derivatives = ((_entry(output, variable), rows[output].get(variable, S.Zero)) for output, variable in entries)
    return Formulas((*value.outputs, *derivatives), tuple(named))


def _backward(value: Formulas, entries: Entries) -> Formulas:
    named = list(value.named)
    slopes = {symbol: _slopes(formula, symbol) for symbol, formula in value.named}
    outputs, rows = dict(value.outputs), dict[str, dict[str, Expr]]()
    for output in dict.fromkeys(output for output, _ in entries):
        row = _slopes(outputs[output])
        for symbol in reversed(slopes):
            if (adjoint := row.pop(symbol, S.Zero)) == 0:
                continue
            adjoint = _symbol(named, _entry(output, str(symbol)), adjoint)
            for inner, slope in slopes[symbol].items():
                row[inner] = row.get(inner, S.Zero) + adjoint * slope
        rows[output] = {str(symbol): entry for symbol, entry in row.items()}
    derivatives = ((_entry(output, variable), rows[output].get(variable, S.Zero)) for output, variable in entries)
    return Formulas((*value.outputs, *derivatives), tuple(named))


def _symbol(named: list[tuple[Symbol, Expr]], name: str, slope: Expr) -> Expr:
    """Return a new symbol ``name`` for the derivative ``slope``, and append the pair (symbol, slope) to ``named``.

    If ``slope`` is a number, a symbol, or a number times a symbol, return ``slope`` itself and append nothing.
    """
    if not slope.args or slope.as_coeff_Mul()[1].is_Symbol:
        return slope
    symbol = Symbol(f"{ANONYMOUS}{name.replace(ANONYMOUS, '')}", real=True)
    named.append((symbol, slope))
    return symbol


def _with_coefficients(value: Formulas, entries: Entries) -> Formulas:
    """Return formulas in which the constant factors of each term of an output are one temporary.

    ``(a*b*x + c*y)/d`` with the variables x and y becomes ``e*x + f*y`` with ``e = a*b/d`` and ``f = c/d``. Derivatives
    have the same coefficients, so that these are computed once, and no division of the sum is left. An output whose
    divisor contains a variable is unchanged.
    """
    varying = {variable for _, variable in entries}
    for symbol, formula in value.named:
        if varying & _symbols(formula).keys():
            varying.add(str(symbol))
    named, outputs = list(value.named), []
    for name, formula in value.outputs:
        above, below = formula.as_numer_denom()
        if varying & _symbols(below).keys():
            outputs.append((name, formula))
            continue
        terms = []
        for k, term in enumerate(Add.make_args(above)):
            constant, rest = term.as_independent(*(s for s in term.free_symbols if str(s) in varying), as_Add=False)
            terms.append(_symbol(named, f"{name}_coefficient_{k}", constant / below) * rest)
        outputs.append((name, Add(*terms)))
    return Formulas(tuple(outputs), tuple(named))


Linear = dict[str, tuple[tuple[str, Symbol], ...]]  # output -> names of derivatives, each with the input of its term


def _linear_outputs(explicit: Formulas, entries: Entries, groups: Groups) -> Linear:
    """Return the outputs that are linear in a group of inputs, each with pairs (name of the derivative, input).

    For ``f = a*x + b*y`` the result is ``{"f": (("f_by_x", x), ("f_by_y", y))}``.
    """
    formulas, known, linear = dict(explicit.outputs), set(entries), Linear()
    for output in dict.fromkeys(output for output, _ in entries):
        symbols = _symbols(formulas[output])
        for group in groups:
            inputs = [symbols[name] for name in group if name in symbols]
            if not inputs or any((output, str(symbol)) not in known for symbol in inputs):
                continue
            slopes = [formulas[_entry(output, str(symbol))] for symbol in inputs]
            at_zero = formulas[output].xreplace(dict.fromkeys(inputs, S.Zero))
            # then the output is the sum of these inputs times these derivatives
            if at_zero == 0 and not any(slope.free_symbols & set(inputs) for slope in slopes):
                linear[output] = tuple((_entry(output, str(symbol)), symbol) for symbol in inputs)
                break
    return linear


def _with_sums(formulas: Formulas, linear: Linear) -> Formulas:
    """Return formulas in which each output f that is linear in some inputs is computed from its derivatives.

    If f is linear in x and y, with f = 0 at x = y = 0, it is computed as ``x*f_by_x + y*f_by_y``: the products of the
    inputs with the derivatives of f with respect to them.

    ``linear`` lists these outputs, as :func:`_linear_outputs` returns them.
    """
    outputs, named = dict(formulas.outputs), list(formulas.named)
    # the derivatives are outputs anyway, so the sum costs few operations
    for output, terms in linear.items():
        outputs[output] = Add(*(symbol * _symbol(named, f"term_{entry}", outputs[entry]) for entry, symbol in terms))
    return Formulas(tuple(outputs.items()), tuple(named))
