"""One time step of fixed size as a straight-line program: Runge-Kutta methods and Taylor series.

A step takes t, the state x, the parameters p and dt, and returns the state at t + dt. It has no loop, no heap and no
branch of its own, so its time is bounded. Each method is written once, for any kind of number; here it is evaluated
with numbers that record their operations, and the record is the program.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from symrot.codegen.recording import Recorder
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import FUNCTIONS

__all__ = ["RK4", "SIZE", "Method", "RungeKutta", "TaylorSeries", "step_program", "step_signature", "stepped"]

STATE, SIZE, NEXT = "x", "dt", "next"


@dataclass(frozen=True)
class RungeKutta:
    """An explicit Runge-Kutta method: stage i adds ``weights[i][j] dt`` times the rates of each earlier stage j."""

    name: str
    order: int
    nodes: tuple[Fraction, ...]
    stages: tuple[Mapping[int, Fraction], ...]
    weights: Mapping[int, Fraction]

    @property
    def formula(self) -> str:
        """The method in words, for the head comment of its text."""
        return f"explicit Runge-Kutta method {self.name} of order {self.order} with {len(self.nodes)} stages"


@dataclass(frozen=True)
class TaylorSeries:
    """The Taylor series of the motion up to the power ``order`` of dt."""

    order: int
    name: str = "taylor"

    @property
    def formula(self) -> str:
        """The method in words, for the head comment of its text."""
        return f"Taylor series of the motion up to dt^{self.order}"


Method = RungeKutta | TaylorSeries
_HALF = Fraction(1, 2)
RK4 = RungeKutta(
    "rk4", 4, (Fraction(0), _HALF, _HALF, Fraction(1)), ({}, {0: _HALF}, {1: _HALF}, {2: Fraction(1)}),
    {0: Fraction(1, 6), 1: Fraction(1, 3), 2: Fraction(1, 3), 3: Fraction(1, 6)},
)  # fmt: skip
"""W. Kutta's method of order 4. Source: Hairer, Norsett, Wanner, Solving ODEs I, 2nd ed., table II.1.2."""


def stepped(
    rates: Program, method: Method, values: Mapping[str, Any], dt: Any,
    functions: Mapping[str, Callable[..., Any]], number: Callable[[Fraction], Any],
) -> list[Any]:  # fmt: skip
    """Return the state after one step, computed with any kind of number.

    Parameters
    ----------
    rates : Program
        The right-hand side ``dy = f(t, y, p)``.
    method : Method
        The method of the step.
    values : mapping
        Values of t, of the states and of the parameters, by name.
    dt : number
        Size of the step, s; may be negative.
    functions, number
        As for :meth:`symrot.formula.program.Program.evaluate`.
    """
    states = [name for name, *_ in rates.signature.argument("y").components]
    if isinstance(method, TaylorSeries):
        series = coefficients(recurrences(rates), method.order, values, functions, number)
        return [_polynomial(each, dt) for each in series]

    bare, factors = _without_factors(rates)

    def moved(weights: Mapping[int, Fraction]) -> list[Any]:
        stages = [
            [stage for stage, own in weights.items() if own == weight] for weight in dict.fromkeys(weights.values())
        ]
        result = []
        for i, name in enumerate(states):
            value = values[name]
            for equal in stages:  # stages of equal weight are added first
                first, *others = (slopes[stage][i] for stage in equal)
                weight = weights[equal[0]] * factors[i]
                move = number(abs(weight)) * dt * sum(others, start=first)
                value = value + move if weight > 0 else value - move
            result.append(value)
        return result

    slopes: list[list[Any]] = []
    for node, weights in zip(method.nodes, method.stages, strict=True):
        point = dict(values) | dict(zip(states, moved(weights), strict=True)) | {"t": values["t"] + number(node) * dt}
        slopes.append(list(bare.evaluate(point, functions, number).values()))
    return moved(method.weights)


def _without_factors(rates: Program) -> tuple[Program, list[Fraction]]:
    """Return rates without the numbers by which whole formulas are multiplied, such as 1/2, and these numbers.

    A step multiplies each of its weights by them once, instead of each rate at each stage.
    """
    outputs, factors = [], []
    for name, node in rates.outputs:
        factor = Fraction(1)
        while node[0] in ("*", "neg"):
            if node[0] == "neg":
                node, factor = node[1], -factor
            elif node[1][0] == "number":
                node, factor = node[2], factor * node[1][1]
            else:
                break
        outputs.append((name, node))
        factors.append(factor)
    return replace(rates, outputs=tuple(outputs)), factors


def _polynomial(series: Sequence[Any], dt: Any) -> Any:
    """Return the value of a polynomial by Horner's rule; ``series`` begins with the constant."""
    value = series[-1]
    for coefficient in reversed(series[:-1]):
        value = coefficient + dt * value
    return value


def step_signature(rates: Program, name: str) -> Signature:
    """Return the name and the arguments of a step: t, x, p (if the rates have parameters), dt, next."""
    time, state = rates.signature.argument("t"), rates.signature.argument("y")
    size = Argument(SIZE, "in", ((SIZE, "s", "size of the step"),), is_scalar=True)
    results = tuple((f"{NEXT}_{each}", unit, f"{meaning} at t + dt") for each, unit, meaning in state.components)
    parameters = tuple(a for a in rates.signature.arguments if a.name == "p" and a.size)
    return Signature(name, (time, replace(state, name=STATE), *parameters, size, Argument(NEXT, "out", results)))


def step_program(rates: Program, method: Method, name: str) -> Program:
    """Return the program of one step, with the arguments t, x, p (if the rates have parameters), dt, next.

    Parameters
    ----------
    rates : Program
        The right-hand side ``dy = f(t, y, p)``.
    method : Method
        The method of the step.
    name : str
        Name of the program.

    Raises
    ------
    InputError
        If the method is a Taylor series and the rates contain an operation without one.
    """
    signature = step_signature(rates, name)
    recorder = Recorder()
    inputs = {each: recorder.symbol(each) for a in signature.arguments if a.role == "in" for each, *_ in a.components}
    functions = {each: recorder.function(each) for each in FUNCTIONS}
    outputs = stepped(rates, method, inputs, inputs[SIZE], functions, recorder.constant)
    results = (each for each, *_ in signature.argument(NEXT).components)
    return recorder.program(signature, dict(zip(results, outputs, strict=True)))
