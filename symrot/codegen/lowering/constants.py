"""Constant parts of expressions: each part without variables becomes a parameter that is computed once per motion."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

from sympy import Expr, Integer, Mul, S, Symbol, default_sort_key

from symrot.codegen.lowering.formulas import function_name
from symrot.dynamics.torques import LEVELLING
from symrot.errors import InputError

__all__ = ["HOISTED", "Gather", "Tree"]

Tree = tuple[Any, ...]
"""A formula as nested tuples, whose first entry is the kind of formula.

``("sym", name)``, ``("num", Fraction)``, ``("mul", factors, divisors)`` with two tuples of trees, ``("add", terms)``
with a tuple of pairs (1 or -1, tree), or ``("call", name of the function, arguments)`` with a tuple of trees.
"""

HOISTED = "$"
"""First character of the preliminary name, such as ``$3``, of a constant part of a formula.

:func:`symrot.codegen.lowering.lower.lower` replaces the name by that of a parameter, such as ``p0``.
"""

LARGEST_POWER = 64  # largest power that is written as a single product
ONE: Tree = ("num", Fraction(1))


class Gather:
    """Splits expressions into a constant and a core with variables: ``2*m*sin(theta)`` into ``2*m`` and ``sin(theta)``.

    The constants become parameters of the program.

    Parameters
    ----------
    variables : iterable of Symbol
        Symbols that change with time or state; all other symbols are constants.
    flat : bool
        Whether a sum inside another sum is merged into the outer sum, so that the constants of both are combined.
    """

    def __init__(self, variables: Iterable[Symbol], flat: bool = False) -> None:
        self.variables, self.flat = frozenset(variables), flat
        self.hoisted: dict[Expr, str] = {}  # constant -> name of its parameter, which is computed once per motion
        self.memo: dict[Expr, tuple[Expr, Tree]] = {}

    def is_variable(self, expr: Expr) -> bool:
        """Return whether an expression contains a variable; otherwise it is constant during a motion."""
        return bool(expr.free_symbols & self.variables)

    def constant(self, value: Expr) -> tuple[int, Tree | None]:
        """Return a constant as (sign, tree), with ``value = sign*tree``: -3 gives -1 and the tree of 3.

        The tree is None for 1 and -1.
        """
        sign, value = _oriented(value)
        if value == 1:
            return sign, None
        if value.is_Rational:
            return sign, ("num", Fraction(int(value.p), int(value.q)))
        # any other constant is the symbol of a parameter
        name = self.hoisted.setdefault(value, f"{HOISTED}{len(self.hoisted)}")
        return sign, ("sym", name)

    def scaled(self, coefficient: Expr, core: Tree) -> tuple[int, Tree]:
        """Return the product of a constant, ``coefficient``, and ``core``, a tree with variables, as (sign, tree)."""
        sign, atom = self.constant(coefficient)
        if atom is None:
            return sign, core
        if core == ONE:
            return sign, atom
        factors, divisors = (core[1], core[2]) if core[0] == "mul" else ((core,), ())
        return sign, ("mul", (atom, *factors), divisors)

    def split(self, expr: Expr) -> tuple[Expr, Tree]:
        """Return (constant, core) with ``expr = constant*core``: ``2*m*sin(x)`` gives 2 m and the tree of sin(x).

        The core of a constant is ONE.
        """
        if expr not in self.memo:
            self.memo[expr] = self._split(expr)
        return self.memo[expr]

    def _split(self, expr: Expr) -> tuple[Expr, Tree]:
        if not self.is_variable(expr):
            return expr, ONE
        if expr.is_Symbol:
            return S.One, ("sym", str(expr))
        if expr.is_Mul:
            return self._product(expr.args)
        if expr.is_Add:
            return self._sum(expr.args)
        if expr.is_Pow:
            return self._power(expr)
        name = function_name(expr)
        return S.One, ("call", name, tuple(self.whole(argument) for argument in expr.args))

    def whole(self, expr: Expr) -> Tree:
        """Return the formula tree of an expression, in which parameters replace the constant factors."""
        sign, tree = self.scaled(*self.split(expr))
        return tree if sign > 0 else ("add", ((-1, tree),))

    def _distributed(self, ordered: Sequence[Expr]) -> list[Expr]:
        """Return the terms of a constant times a sum, multiplied out.

        The list is empty for any other product, and for a sum such as ``1 + tanh(u)`` that may tend to zero.
        """
        sums = [argument for argument in ordered if self.is_variable(argument)]
        # multiplied out, a sum that tends to zero would keep a rounding error proportional to the constant
        if len(sums) != 1 or not sums[0].is_Add or sums[0].atoms(*LEVELLING):
            return []
        # c*(a + b*x) becomes c*a + (c*b)*x, which has one operation less
        outer = Mul(*(argument for argument in ordered if argument is not sums[0]))
        return [outer * term for term in sums[0].args]

    def _flattened(self, terms: Iterable[Expr]) -> Iterable[Expr]:
        """Yield the terms of a sum and of the sums inside it, so that constants and equal terms can be combined."""
        for term in terms:
            inner = list(term.args) if term.is_Add else []
            if term.is_Mul:
                inner = self._distributed(sorted(term.args, key=default_sort_key))
            yield from self._flattened(inner) if inner else (term,)

    def _product(self, arguments: Iterable[Expr]) -> tuple[Expr, Tree]:
        constant, factors, divisors = S.One, [], []
        ordered = sorted(arguments, key=default_sort_key)
        if terms := self._distributed(ordered):
            return self._sum(terms)
        for argument in ordered:
            own, core = self.split(argument)
            constant *= own
            if core == ONE:
                continue
            if core[0] == "mul":
                factors += core[1]
                divisors += core[2]
            else:
                factors.append(core)
        if not divisors and len(factors) == 1:
            return constant, factors[0]
        return constant, ("mul", tuple(factors), tuple(divisors))

    def _power(self, expr: Expr) -> tuple[Expr, Tree]:
        base, power = expr.as_base_exp()
        if not (2 * power).is_Integer:
            raise InputError(
                f"expected powers in a kernel to be multiples of 1/2, such as x**2 or sqrt(x)**3, got {expr}"
            )
        if power.is_Integer:
            constant, core = self.split(base)
        else:
            constant, core, power = S.One, ("call", "sqrt", (self.whole(base),)), Integer(2 * power)
        factors, divisors = (core[1], core[2]) if core[0] == "mul" else ((core,), ())
        if power < 0:
            factors, divisors = divisors, factors
        count = abs(int(power))
        if count == 1 and not divisors and len(factors) == 1:
            return constant**power, factors[0]
        if count > LARGEST_POWER:
            return constant**power, _repeated(("mul", factors, divisors), count)
        return constant**power, ("mul", factors * count, divisors * count)

    def _sum(self, terms: Iterable[Expr]) -> tuple[Expr, Tree]:
        total: dict[Tree, Expr] = {}  # core -> its constant, with equal cores combined
        for term in sorted(self._flattened(terms) if self.flat else terms, key=default_sort_key):
            constant, core = self.split(term)
            total[core] = total.get(core, S.Zero) + constant
        groups: dict[Expr, list[tuple[int, Tree]]] = {}
        for core, constant in total.items():
            if constant != 0:
                sign, constant = _oriented(constant)
                groups.setdefault(constant, []).append((sign, core))
        if not groups:
            return S.Zero, ONE
        if len(groups) == 1:
            ((constant, group),) = groups.items()
            sign, tree = _signed_sum(group)
            return constant * sign, tree
        parts: list[tuple[int, Tree]] = []
        for constant, group in groups.items():
            if constant == 1:
                parts += group
                continue
            outer, tree = _signed_sum(group)
            inner, scaled = self.scaled(constant, tree)
            parts.append((outer * inner, scaled))
        sign, tree = _signed_sum(parts)
        return Integer(sign), tree


def _repeated(tree: Tree, count: int) -> Tree:
    """Return the tree of the power ``tree^count``, by repeated squaring if ``count`` exceeds LARGEST_POWER."""
    if count <= LARGEST_POWER:
        return ("mul", (tree,) * count, ())
    half = _repeated(tree, count // 2)
    return ("mul", (half, half, tree) if count % 2 else (half, half), ())


def _oriented(value: Expr) -> tuple[int, Expr]:
    """Return a constant as (sign, magnitude), so that (A - C)/A and (C - A)/A differ only in the sign."""
    # one parameter serves both; the magnitude need not be positive, as the sign of A - C is unknown
    sign, factors = 1, []
    for factor in Mul.make_args(value):
        base, power = factor.as_base_exp()
        if power.is_Integer and (base.is_Add or base.is_Number) and base.could_extract_minus_sign():
            sign, factor = sign * (-1) ** int(power), (-base) ** power
        factors.append(factor)
    return sign, Mul(*factors)


def _signed_sum(terms: Sequence[tuple[int, Tree]]) -> tuple[int, Tree]:
    """Return the sum of ``terms`` as (sign, tree) with few minus signs: ``-a - b`` gives -1 and ``a + b``."""
    if len(terms) == 1:
        return terms[0]
    surplus = sum(s for s, _ in terms)
    sign = -1 if surplus < 0 or (surplus == 0 and terms[0][0] < 0) else 1
    return sign, ("add", tuple((s * sign, tree) for s, tree in terms))
