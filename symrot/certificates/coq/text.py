"""Coq text of SymPy expressions and kernels: rational functions, sines, cosines and square roots of real variables."""

from collections.abc import Iterable, Sequence
from textwrap import fill

from sympy import Add, Expr, Integer, Mul, Pow, Rational, Symbol, cos, fraction, sin

from symrot.errors import CertificateError
from symrot.kernels.definition import Definition

__all__ = ["comment", "coq_expression", "definition_text", "folded", "matrix_text", "variables"]

WIDTH = 118
_SHAPES = {1: "R", 3: "vector", 4: "quaternion", 6: "matrix", 9: "matrix"}  # number of components -> type in rotation.v
_MAKERS = {3: "vec", 4: "quat", 6: "tensor", 9: "mat"}
_FUNCTIONS = {sin: "sin", cos: "cos"}
_SUM, _PRODUCT, _POWER, _ATOM = range(4)  # precedence of the outermost operation of a text


def coq_expression(expression: Expr) -> str:
    """Return the Coq text of a real expression.

    Raises
    ------
    CertificateError
        If the expression contains anything but rational numbers, symbols, sums, products, integer powers, square roots,
        sines and cosines.
    """
    return _print(expression)[0]


# Terms and factors come in SymPy's canonical order, so that a formula gives the same bytes on every machine.
def _print(expression: Expr) -> tuple[str, int]:
    """Return the Coq text of an expression, and the precedence of its outermost operation."""
    if isinstance(expression, Symbol):
        return str(expression), _ATOM
    if isinstance(expression, Rational):
        return _rational(expression)
    if isinstance(expression, Add):
        return _sum(expression), _SUM
    if isinstance(expression, Mul):
        return _product(expression)
    if isinstance(expression, Pow):
        return _power(expression)
    if expression.func in _FUNCTIONS:
        return f"{_FUNCTIONS[expression.func]} {_within(expression.args[0], _ATOM)}", _POWER
    raise CertificateError(
        f"expected a formula of sums, products, quotients, sines, cosines and square roots, got {expression}"
    )


def _within(expression: Expr, least: int) -> str:
    text, tightness = _print(expression)
    return text if tightness >= least else f"({text})"


def _rational(number: Rational) -> tuple[str, int]:
    if number < 0:
        return f"- {_rational(-number)[0]}", _SUM
    return (str(number.p), _ATOM) if number.q == 1 else (f"{number.p} / {number.q}", _PRODUCT)


def _sum(expression: Add) -> str:
    text = ""
    for term in expression.as_ordered_terms():
        negative = term.could_extract_minus_sign() and term.as_coeff_Mul()[0] < 0
        size = _within(-term if negative else term, _PRODUCT)
        sign = "-" if negative else "+"
        text += f" {sign} {size}" if text else (f"- {size}" if negative else size)
    return text


def _product(expression: Mul) -> tuple[str, int]:
    if expression.as_coeff_Mul()[0] < 0:
        return f"- {_within(-expression, _PRODUCT)}", _SUM
    above, below = fraction(expression)
    text = " * ".join(_within(factor, _POWER) for factor in _factors(above))
    if below == 1:
        return text, _PRODUCT
    return f"{text} / {_within(below, _POWER)}", _PRODUCT


def _factors(expression: Expr) -> list[Expr]:
    return list(expression.as_ordered_factors()) if isinstance(expression, Mul) else [expression]


def _power(expression: Pow) -> tuple[str, int]:
    base, exponent = expression.args
    if exponent == Rational(1, 2):
        return f"sqrt {_within(base, _ATOM)}", _POWER
    if exponent.is_negative:
        return f"1 / {_within(base**-exponent, _POWER)}", _PRODUCT
    if isinstance(exponent, Integer):
        return f"{_within(base, _ATOM)} ^ {exponent}", _POWER
    raise CertificateError(f"expected an integer power or a square root, got {expression}")


def folded(text: str, indent: int = 0) -> str:
    """Return a text in lines of at most :data:`WIDTH` characters, unless one word is longer.

    All lines but the first are indented by ``indent`` blanks.
    """
    return fill(text, WIDTH, subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False)


def comment(text: str) -> str:
    """Return a Coq comment in folded lines; comment marks inside ``text`` are split, so that none ends the comment."""
    return folded("(* " + text.replace("(*", "( *").replace("*)", "* )") + " *)", 3)


def _record(formulas: Sequence[Expr]) -> str:
    """Return the Coq text of one number, vector, quaternion or matrix that has ``formulas`` as components.

    A matrix has nine formulas, row by row, or six if it is symmetric: the components xx, yy, zz, xy, xz and yz.
    """
    if len(formulas) == 1:
        return folded(f"  {coq_expression(formulas[0])}", 4)
    texts = [_within(formula, _ATOM) for formula in formulas]
    row = 3 if len(formulas) == 9 else len(formulas)
    rows = ["    " + " ".join(texts[start : start + row]) for start in range(0, len(texts), row)]
    if max(map(len, rows)) > WIDTH:
        rows = [folded(f"    {text}", 6) for text in texts]
    return "\n".join([f"  {_MAKERS[len(formulas)]}", *rows])


def _defined(name: str, variable_names: Iterable[str], size: int, body: str) -> str:
    return folded(f"Definition {name} ({' '.join(variable_names)} : R) : {_SHAPES[size]} :=", 4) + f"\n{body}."


def matrix_text(name: str, variable_names: Iterable[str], formulas: Sequence[Expr]) -> str:
    """Return the Coq definition of a function ``name`` of real variables, whose value has the components ``formulas``.

    The value is a number for 1 formula, a vector for 3, a quaternion for 4, a symmetric matrix for 6, a matrix for 9.
    """
    return _defined(name, variable_names, len(formulas), _record(formulas))


def definition_text(kernel: Definition, name: str, output: str | None = None) -> str:
    """Return the Coq definition of a function that computes one output of a kernel from the components of its inputs.

    Parameters
    ----------
    kernel : Definition
        The kernel whose formulas are printed.
    name : str
        The name of the function in Coq.
    output : str, optional
        The name of the output; default: the first output.
    """
    formulas = next(values for target, values in kernel.results if output in (None, target.name))
    lines = [folded(f"  let {symbol} := {coq_expression(value)} in", 4) for symbol, value in kernel.named]
    body = "\n".join([*lines, _record(formulas)])
    return _defined(name, variables(kernel), len(formulas), body)


def variables(kernel: Definition) -> list[str]:
    """Return the names of the components of a kernel's inputs, in order."""
    return [component[0] for argument in kernel.inputs for component in argument.components]
