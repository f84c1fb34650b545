"""Kernels with derivatives: the outputs of a kernel, then their derivatives with respect to some of its inputs.

Such a kernel has a name of its own, ``euler_zxz_body_rates_by_angles_by_omega``. It is a kernel like any other: under
this name its code is printed, its formulas are proven, and its rounding errors are bounded.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

from sympy import Add, Expr, Rational, Symbol

from symrot.errors import InputError
from symrot.formula.program import Argument
from symrot.kernels.definition import Definition, Law
from symrot.kernels.derivative import Derivatives, exact_derivative
from symrot.kernels.removable import explicit

__all__ = ["BY", "jacobian_argument", "jacobian_kernel", "jacobian_name", "unit_of_quotient"]

BY = "_by_"
"""The mark before each input in the name of a kernel with derivatives, such as ``quaternion_dcm_by_q``."""


def jacobian_name(kernel: str, variables: Sequence[str]) -> str:
    """Return the name of ``kernel`` with derivatives with respect to ``variables``, such as ``quaternion_dcm_by_q``."""
    return BY.join((kernel, *variables))


def unit_of_quotient(above: str, below: str) -> str:
    """Return the unit of a derivative, such as ``(rad/s)/(kg m^2)``; empty if the unit ``below`` is empty (unknown)."""
    if not below:
        return ""  # a constant of a scene, whose unit the scene does not say
    if below == "1" or above == below:
        return above if below == "1" else "1"
    if above.startswith(f"{below}/"):
        return f"1{above.removeprefix(below)}"
    bracketed = [f"({unit})" if set(unit) & set("/ ") else unit for unit in (above, below)]
    return "/".join(bracketed)


def jacobian_argument(target: Argument, name: str, variables: Sequence[tuple[str, str, str]]) -> Argument:
    """Return the output array of the derivatives of ``target`` with respect to components of the input ``name``.

    ``variables`` has (name, unit, meaning) of each component. The array has one row for each component of ``target``,
    and is stored row by row.
    """
    components = tuple(
        (f"{output}{BY}{variable}", unit_of_quotient(unit, by), f"derivative of {target.name} by {name}")
        for (output, unit, _), (variable, by, _) in product(target.components, variables)
    )
    return Argument(f"{target.name}{BY}{name}", "out", components)


def jacobian_kernel(kernel: Definition, variables: Sequence[str]) -> Definition:
    """Return a kernel that computes the outputs of ``kernel`` and their derivatives with respect to some of its inputs.

    Parameters
    ----------
    kernel : Definition
        The kernel without derivatives.
    variables : sequence of str
        Names of inputs: arguments such as ``"omega"``, or single components such as ``"omega_1"``.

    Returns
    -------
    Definition
        The outputs of the kernel, then for each output and each input an array of derivatives, row by row.

    Raises
    ------
    InputError
        If the kernel has no such input, an input is named twice, or kernels cannot compute a derivative.
    """
    chosen = {name: _components(kernel, name) for name in _distinct(kernel, variables)}
    symbols, slopes = _symbols(kernel), Derivatives(kernel.named)
    results = list(kernel.results)
    for target, formulas in kernel.results:
        for name, components in chosen.items():
            inputs = [symbols[component] for component, *_ in components]
            entries = tuple(slopes.of(formula, variable) for formula, variable in product(formulas, inputs))
            results.append((jacobian_argument(target, name, components), entries))
    listed = ", ".join(chosen)
    return replace(
        kernel, name=jacobian_name(kernel.name, variables), results=tuple(results),
        domain=f"{kernel.domain}; derivatives: where no divisor is zero and no choice changes",
        title=f"{kernel.title}; with its derivatives by {listed}, row by row",
        named=(*kernel.named, *slopes.named.items()), laws=lambda: _laws(kernel, chosen),
    )  # fmt: skip


def _symbols(kernel: Definition) -> dict[str, Symbol]:
    """Return a map from the name of each input to the SymPy symbol for it in the kernel's formulas."""
    formulas = [formula for _, formula in (*kernel.formulas, *kernel.named)]
    # Symbols of one name but other assumptions (positive, real) differ for SymPy, so the formulas' own are used.
    held = {str(symbol): symbol for formula in formulas for symbol in formula.free_symbols}
    return {name: held.get(name, Symbol(name, real=True)) for a in kernel.inputs for name, *_ in a.components}


def _distinct(kernel: Definition, variables: Sequence[str]) -> Sequence[str]:
    seen: set[str] = set()
    for name in variables:
        components = {component for component, *_ in _components(kernel, name)}
        if components & seen:
            raise InputError(f"{kernel.name}: expected each input once, got {name!r} twice")
        seen |= components
    return variables


def _components(kernel: Definition, name: str) -> tuple[tuple[str, str, str], ...]:
    """Return the components of an input as (name, unit, meaning).

    ``name`` is an argument such as ``"omega"``, which has three components, or one component such as ``"omega_1"``.
    """
    for argument in kernel.inputs:
        if argument.name == name:
            return argument.components
        for component in argument.components:
            if component[0] == name:
                return (component,)
    known = ", ".join(dict.fromkeys(n for a in kernel.inputs for n in (a.name, *(c[0] for c in a.components))))
    raise InputError(f"{kernel.name}: expected derivatives with respect to its inputs ({known}), got {name!r}")


def _laws(kernel: Definition, chosen: dict[str, tuple[tuple[str, str, str], ...]]) -> tuple[Law, ...]:
    """Return the laws (provable identities) of a kernel with derivatives.

    These are the laws of ``kernel`` and one law for each input: the derivatives with respect to it are those of the
    formulas of the outputs. ``chosen`` maps each input to (name, unit, meaning) of its components.
    """
    symbols, laws = _symbols(kernel), list(kernel.laws())
    roots = {symbol: value for symbol, value in kernel.named if value.is_Pow and value.exp == Rational(1, 2)}
    for name, components in chosen.items():
        vanishing = []
        for (output, formula), (variable, *_) in product(kernel.formulas, components):
            for symbol, value in reversed(kernel.named):
                formula = formula if symbol in roots else formula.xreplace({symbol: value})
            above, below = explicit(formula).as_numer_denom()
            own, entry = (Symbol(each, real=True) for each in (output, f"{output}{BY}{variable}"))
            slopes = [_slope(part, symbols[variable], roots) for part in (above, below)]
            # for an output y = a/b: b y' = a' - y b', shorter than the derivative of the quotient
            vanishing.append(below * entry - slopes[0] + own * slopes[1])
        laws.append(
            Law(f"the derivatives with respect to {name} are those of the formulas of the outputs", tuple(vanishing))
        )
    return tuple(laws)


def _slope(formula: Expr, variable: Symbol, roots: dict[Symbol, Expr]) -> Expr:
    """Return the derivative of ``formula`` with respect to ``variable``.

    ``roots`` maps symbols in the formula to the square roots that they stand for.
    """
    through = [
        exact_derivative(formula, root) * exact_derivative(value.base, variable) / (2 * root)
        for root, value in roots.items()
    ]
    return Add(exact_derivative(formula, variable), *through)
