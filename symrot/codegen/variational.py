"""Variational equations: the rates of a motion's states and of their sensitivities.

The sensitivities are the derivatives of the states with respect to initial values and parameters.

If ``dy/dt = f(t, y, p)``, the derivative S of y with respect to a variable v obeys
``dS/dt = (df/dy) S + (df/dp) dp/dv``. Integrated together with y, as one system, S has the same step control as y.
"""

from collections.abc import Collection, Sequence
from dataclasses import replace
from fractions import Fraction

from symrot.codegen.duals import Dual, dual_functions
from symrot.codegen.recording import Recorder
from symrot.formula.program import Argument, Program
from symrot.formula.tree import FUNCTIONS

__all__ = ["variational_program"]

LEAST_ROOT = Fraction(1, 1 << 1000)
"""Added to roots in divisors: it changes no double that is larger than 1e-284."""


def variational_program(rates: Program, columns: Sequence[Collection[str]], rough: bool = False) -> Program:
    """Return the program of the rates of the states and of their derivatives with respect to variables.

    A variable is an initial value, or a constant on which parameters of the rates depend.

    Parameters
    ----------
    rates : Program
        The right-hand side ``dy = f(t, y, p)``.
    columns : sequence of collections of str
        One collection for each variable v: the names of the parameters p that depend on v. The collection is empty if v
        is an initial value.
    rough : bool
        Whether the derivative of a root such as sqrt(x**2) is zero, not undefined, at x = 0.

    Returns
    -------
    Program
        Its states are y, then for each variable the derivatives of y with respect to it: ``omega_1_by_1`` is the
        derivative of omega_1 with respect to variable 1. Its parameters are p, then for each variable the derivatives
        of the parameters that ``columns`` names for it.

    Raises
    ------
    InputError
        If the rates call abs, which has no derivative at zero.
    """
    inputs = {argument.name: argument for argument in rates.signature.arguments}
    states, parameters = inputs["y"].components, inputs["p"].components if "p" in inputs else ()
    marks = [f"_by_{number}" for number in range(1, len(columns) + 1)]
    recorder = Recorder()

    def dual(name: str, by: Sequence[str]) -> Dual:
        return Dual(recorder.symbol(name), {mark: recorder.symbol(f"{name}{mark}") for mark in by})

    values = {name: dual(name, marks) for name, *_ in states}
    slopes = []
    for name, *_ in parameters:
        by = [mark for mark, depends in zip(marks, columns, strict=True) if name in depends]
        values[name] = dual(name, by)
    for mark, depends in zip(marks, columns, strict=True):
        slopes += [(f"{name}{mark}", "", "") for name, *_ in parameters if name in depends]
    if "t" in inputs:
        values["t"] = Dual(recorder.symbol("t"), {})
    functions = dual_functions({name: recorder.function(name) for name in FUNCTIONS}, LEAST_ROOT if rough else 0)
    results = rates.evaluate(values, functions, recorder.constant)
    outputs = {}
    for name, result in results.items():
        outputs[name] = result.value if isinstance(result, Dual) else result
    for mark in marks:
        for name, result in results.items():
            outputs[f"{name}{mark}"] = result.slopes.get(mark, 0) if isinstance(result, Dual) else 0

    def widened(argument: Argument) -> Argument:
        more = [(f"{name}{mark}", "", meaning) for mark in marks for name, _, meaning in argument.components]
        return replace(argument, components=(*argument.components, *more))

    arguments = [inputs["t"]] if "t" in inputs else []
    arguments.append(widened(inputs["y"]))
    if parameters or slopes:
        arguments.append(replace(inputs["p"], components=(*parameters, *slopes)))
    arguments.append(widened(inputs["dy"]))
    return recorder.program(replace(rates.signature, arguments=tuple(arguments)), outputs)
