"""Exact derivatives of the formulas of kernels, which reuse quantities that the kernel computes for its values.

A named quantity, such as ``angle = sqrt(v . v)``, keeps its name in the chain rule; a quotient ``y = a/b`` gives ``(a'
- y b')/b``, a root ``r = sqrt(a)`` gives ``a'/(2 r)``. Derivatives stay short, and finite where values are.
"""

from collections.abc import Callable, Mapping, Sequence

from sympy import Expr, Integer, Mul, Rational, S, Symbol, cos, sign, sin
from sympy.core.function import AppliedUndef

from symrot.errors import InputError
from symrot.kernels.removable import DERIVATIVES, copysign, select_ge, sinc

__all__ = ["Derivatives", "exact_derivative"]

Named = tuple[tuple[Symbol, Expr], ...]
Slope = Callable[..., tuple[Expr, ...]]  # arguments of a function -> its partial derivatives

_SLOPES: Mapping[str, Slope] = {
    **{name: lambda x, slope=slope: (slope(x),) for name, slope in DERIVATIVES.items()},
    "copysign": lambda x, y: (copysign(1, x) * copysign(1, y) if x.free_symbols else S.Zero, S.Zero),
}


def exact_derivative(expr: Expr, variable: Symbol) -> Expr:
    """Return the derivative of an expression with respect to a symbol; other symbols are constants.

    A choice between two formulas has the derivative of the chosen formula.

    Raises
    ------
    InputError
        If kernels cannot compute the derivative of a function in the expression.

    Examples
    --------
    >>> from sympy import Symbol
    >>> x = Symbol("x", real=True)
    >>> exact_derivative(sinc(x), x)
    -x*tangent_gap(x)
    """
    if variable not in expr.free_symbols:
        return S.Zero
    calls = sorted((call for call in expr.atoms(AppliedUndef) if _is_outermost(call, expr)), key=str)
    stand_in = {call: Symbol(f"call_{k}", real=True) for k, call in enumerate(calls)}
    plain = expr.xreplace(stand_in)
    back = {symbol: call for call, symbol in stand_in.items()}
    total = _plain(plain, variable, back)
    for call, symbol in stand_in.items():
        if variable in call.free_symbols:
            total += _plain(plain, symbol, back) * _slope(call, variable)
    return total


def _plain(expr: Expr, variable: Symbol, back: Mapping[Expr, Expr]) -> Expr:
    """Return the derivative of an expression whose symbols in ``back`` stand for calls of functions such as sinc."""
    # SymPy cannot differentiate symrot's own functions; their symbols are constants here.
    slope = expr.diff(variable).replace(sign, lambda value: copysign(Integer(1), value))
    return slope.xreplace(dict(back))


def _is_outermost(call: Expr, expr: Expr) -> bool:
    """Return whether a call of a function such as sinc occurs in ``expr`` outside the arguments of other such calls."""
    if expr == call:
        return True
    if isinstance(expr, AppliedUndef):
        return False
    return any(_is_outermost(call, argument) for argument in expr.args)


def _slope(call: Expr, variable: Symbol) -> Expr:
    """Return the derivative of a call of one of symrot's own functions, such as sinc(u), by the chain rule."""
    name = call.func.__name__
    if name == "select_ge":
        # a choice between two formulas: the choice between their derivatives
        left, right, *choices = call.args
        one, other = (exact_derivative(choice, variable) for choice in choices)
        return one if one == other else select_ge(left, right, one, other)
    if name not in _SLOPES:
        raise InputError(
            f"expected a kernel whose functions have derivatives that kernels can compute, got the function {name}"
        )
    slopes = _SLOPES[name](*call.args)
    return sum((slope * exact_derivative(argument, variable)
                for slope, argument in zip(slopes, call.args, strict=True) if slope != 0), S.Zero)  # fmt: skip


class Derivatives:
    """Computes derivatives of formulas that contain named quantities, such as ``angle = sqrt(v . v)``.

    Parameters
    ----------
    named : sequence of (Symbol, Expr)
        The quantities with their formulas, which may contain the symbols of earlier quantities.
    short : bool
        Whether the derivative of a quantity is a named quantity too, such as ``turning_by_theta``. This keeps formulas
        short.

    Attributes
    ----------
    named : dict of Symbol to Expr
        The named derivatives with their formulas, filled by the calls of :meth:`of`; empty if not ``short``.
    """

    def __init__(self, named: Sequence[tuple[Symbol, Expr]], short: bool = True) -> None:
        self.values, self.short = dict(named), short
        self.roots = {symbol for symbol, value in named if value.is_Pow and value.exp == Rational(1, 2)}
        self.named: dict[Symbol, Expr] = {}
        self.slopes: dict[tuple[Symbol, Symbol], Expr] = {}

    def of(self, expr: Expr, variable: Symbol, value: Expr | None = None) -> Expr:
        """Return the derivative of ``expr`` with respect to the input ``variable``.

        The result may contain the symbols of the quantities that the constructor received and of the derivatives in
        ``named``. ``value`` is the symbol of the quantity whose formula is ``expr``; None if ``expr`` has no symbol.
        """
        # With the symbol y of y = a/b the derivative is (a' - y b')/b, of y = sqrt(a) it is a'/(2 y).
        root_of = expr.base if expr.is_Pow and expr.exp == Rational(1, 2) else None
        if value is not None and root_of is not None:
            return self.of(root_of, variable) / (2 * value)
        above, below = expr.as_numer_denom()
        if value is not None and self._depends(below, variable):
            return (self.of(above, variable) - value * self.of(below, variable)) / below
        total = exact_derivative(expr, variable)
        for symbol in sorted(expr.free_symbols & set(self.values), key=str):
            if (slope := self._of_named(symbol, variable)) != 0:
                total += self._by_named(expr, symbol, slope)
        return total

    def _depends(self, expr: Expr, variable: Symbol) -> bool:
        held = expr.free_symbols
        return variable in held or any(self._of_named(symbol, variable) != 0 for symbol in held & set(self.values))

    def _of_named(self, symbol: Symbol, variable: Symbol) -> Expr:
        key = (symbol, variable)
        if key not in self.slopes:
            slope = self.of(self.values[symbol], variable, symbol)
            if self.short and slope.args and symbol not in self.roots and not _is_multiple_of_symbol(slope):
                name = Symbol(f"{symbol}_by_{variable}", real=True)
                self.named[name], slope = slope, name
            self.slopes[key] = slope
        return self.slopes[key]

    def _by_named(self, expr: Expr, symbol: Symbol, slope: Expr) -> Expr:
        """Return one term of the chain rule: d ``expr``/d ``symbol``, times ``slope``.

        ``symbol`` stands for a named quantity; ``slope`` is the derivative of this quantity with respect to the input.
        """
        partial = exact_derivative(expr, symbol)
        if symbol in self.roots:
            partial = _with_sinc(expr, symbol, partial)
        return Mul(partial, slope) if not partial.is_Add else sum((term * slope for term in partial.args), S.Zero)


def _is_multiple_of_symbol(expr: Expr) -> bool:
    """Return whether an expression is a symbol, or a number times a symbol: too short to get a name of its own."""
    return bool(expr.as_coeff_Mul()[1].is_Symbol)


def _with_sinc(expr: Expr, symbol: Symbol, partial: Expr) -> Expr:
    """Return ``partial``, the derivative of ``expr`` with respect to ``symbol``, with sines written as sinc.

    The symbol stands for a square root, such as an angle ``|v|``: ``-sin(angle)`` becomes ``-angle*sinc(angle)``.
    """
    # The caller multiplies by the root's derivative v_i/angle, which has no value at angle = 0; now the angle cancels.
    angles = [call.args[0] for call in expr.atoms(cos) if symbol in call.free_symbols]
    for angle in angles:
        partial = partial.xreplace({sin(angle): angle * sinc(angle)})
    return partial
