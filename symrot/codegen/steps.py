"""One time step of fixed size as a straight-line program: Runge-Kutta methods, Taylor series, closed forms.

A step takes t, the state x, the parameters p and dt, and returns the state at t + dt. It has no loop, heap or branch of
its own, so its time is bounded. The method is evaluated with numbers that record their operations; the record is the
program.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from typing import Any

from symrot.codegen.duals import Dual, dual_functions
from symrot.codegen.recording import Recorder
from symrot.codegen.steady_rotations import SteadyRotations
from symrot.codegen.taylor.coefficients import coefficients
from symrot.codegen.taylor.recurrences import recurrences
from symrot.errors import InputError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import FUNCTIONS
from symrot.kernels.jacobian import jacobian_argument

__all__ = [
    "RK4", "SIZE", "Method", "RungeKutta", "SteadyRotations", "TaylorSeries", "WithDerivatives", "derivative_inputs",
    "step_program", "step_signature", "stepped", "without_factors",
]  # fmt: skip

STATE, SIZE, NEXT = "x", "dt", "next"


@dataclass(frozen=True)
class RungeKutta:
    """An explicit Runge-Kutta method, whose rates are evaluated at several stages within a step."""

    name: str
    order: int
    # stage i is at the time t + nodes[i] dt
    nodes: tuple[Fraction, ...]
    # its state is the initial state plus stages[i][j] dt times the rates at each earlier stage j
    stages: tuple[Mapping[int, Fraction], ...]
    # the step adds weights[j] dt times the rates at each stage j to the initial state
    weights: Mapping[int, Fraction]
    # whether the coefficients are rounded decimals, which fulfil the order conditions to 25 digits
    rounded: bool = False

    @property
    def formula(self) -> str:
        """The method in words, such as ``"explicit Runge-Kutta method rk4 of order 4 with 4 stages"``."""
        return f"explicit Runge-Kutta method {self.name} of order {self.order} with {len(self.nodes)} stages"


@dataclass(frozen=True)
class TaylorSeries:
    """A Taylor method: the step is the Taylor polynomial of the motion up to the power ``order`` of dt."""

    order: int
    name: str = "taylor"

    @property
    def formula(self) -> str:
        """The method in words, such as ``"Taylor series of the motion up to dt^8"``."""
        return f"Taylor series of the motion up to dt^{self.order}"


@dataclass(frozen=True)
class WithDerivatives:
    """A numerical method whose step also computes exact derivatives of the new state.

    The derivatives are those with respect to some inputs of the step, such as the old state.
    """

    # the same method without derivatives
    plain: RungeKutta | TaylorSeries
    # the inputs: "x" (all states), "omega", "q", "p" (all parameters), "dt", "t", one state or one parameter
    by: tuple[str, ...]

    @property
    def name(self) -> str:
        """The name of the numerical method alone, without its derivatives, such as ``rk4``."""
        return self.plain.name

    @property
    def order(self) -> int:
        """The order of accuracy of the numerical method, such as 4 for ``rk4``."""
        return self.plain.order

    @property
    def formula(self) -> str:
        """The method in words, such as ``"Taylor series of the motion up to dt^8, and its derivatives by x"``."""
        return f"{self.plain.formula}, and its derivatives by {', '.join(self.by)}"


Method = RungeKutta | TaylorSeries | SteadyRotations | WithDerivatives
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
    """Return the components of the state after one step as a list, computed with any kind of number.

    For a :class:`WithDerivatives`, the derivatives of the new state follow. Each entry of ``method.by`` is the name of
    one or several inputs of the step, such as "omega" for omega_1, omega_2 and omega_3. For each entry there is a
    matrix, row by row: a row for each state, with its derivatives with respect to these inputs.

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
    functions : mapping
        The functions of this kind of number by name, such as ``"sin"``.
    number : callable
        Converts a Fraction to this kind of number.
    """
    states = [name for name, *_ in rates.signature.argument("y").components]
    if isinstance(method, WithDerivatives):
        groups = [[name for name, *_ in derivative_inputs(rates, name)] for name in method.by]
        chosen, one, zero = set(chain(*groups)), number(Fraction(1)), number(Fraction(0))
        duals = {name: Dual(x, {name: one} if name in chosen else {}) for name, x in {**values, SIZE: dt}.items()}
        plain = (method.plain, duals, duals[SIZE], dual_functions(functions))
        results = stepped(rates, *plain, lambda value: Dual(number(value), {}))
        slopes_of = [(result, name) for group in groups for result in results for name in group]
        return [result.value for result in results] + [result.slopes.get(name, zero) for result, name in slopes_of]
    if isinstance(method, SteadyRotations):
        return method.after(rates, values, dt, functions, number)
    if isinstance(method, TaylorSeries):
        series = coefficients(recurrences(rates), method.order, values, functions, number)
        return [_polynomial(each, dt) for each in series]

    bare, factors = without_factors(rates)

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


def without_factors(rates: Program) -> tuple[Program, list[Fraction]]:
    """Return the rates without leading numeric factors, and the factors: ``1/2*(a - b)`` gives a - b and 1/2."""
    # a step multiplies its weights by these numbers once, instead of each rate at each stage
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
    """Return the value of the polynomial with the coefficients ``series``, lowest power first, at ``dt``."""
    value = series[-1]
    for coefficient in reversed(series[:-1]):
        value = coefficient + dt * value
    return value


def derivative_inputs(rates: Program, name: str) -> tuple[tuple[str, str, str], ...]:
    """Return (name, unit, meaning) of each input of a step that ``name`` selects, such as all states for ``"x"``.

    Raises
    ------
    InputError
        If the step has no such input.
    """
    inputs = {each.name: each for each in step_signature(rates, "").arguments if each.role == "in"}
    families = {"omega": "omega_", "q": "q"}
    states = [each for each in inputs[STATE].components if name in families and each[0].startswith(families[name])]
    if name in inputs or states:
        return tuple(states) or inputs[name].components
    every = {each[0]: each for argument in inputs.values() for each in argument.components}
    if name in every:
        return (every[name],)
    raise InputError(
        f"jacobian: expected inputs of the step ({', '.join(dict.fromkeys([*inputs, *every]))}), got {name!r}"
    )


def step_signature(rates: Program, name: str, by: Sequence[str] = ()) -> Signature:
    """Return the name and the arguments of a step: t, x, p (if any), dt, and the results, ``next`` and its derivatives.

    ``next`` is the state after the step. ``by`` names the inputs with respect to which ``next`` is differentiated.
    """
    time, state = rates.signature.argument("t"), rates.signature.argument("y")
    size = Argument(SIZE, "in", ((SIZE, "s", "size of the step"),), is_scalar=True)
    results = tuple((f"{NEXT}_{each}", unit, f"{meaning} at t + dt") for each, unit, meaning in state.components)
    parameters = tuple(a for a in rates.signature.arguments if a.name == "p" and a.size)
    target = Argument(NEXT, "out", results)
    slopes = [jacobian_argument(target, each, derivative_inputs(rates, each)) for each in by]
    return Signature(name, (time, replace(state, name=STATE), *parameters, size, target, *slopes))


def step_program(rates: Program, method: Method, name: str) -> Program:
    """Return the program of one step, with the arguments t, x, p (if the rates have parameters), dt, next.

    For a :class:`WithDerivatives`, further output arrays follow: one for each entry of ``method.by``, with the
    derivatives of ``next`` with respect to the inputs that the entry names, such as ``"omega"``.

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
        If the method is a Taylor series and the rates contain an operation without one, if ``method.by`` names an input
        that the step does not have, or if derivatives are required and the rates contain the function abs.
    """
    signature = step_signature(rates, name, method.by if isinstance(method, WithDerivatives) else ())
    recorder = Recorder()
    inputs = {each: recorder.symbol(each) for a in signature.arguments if a.role == "in" for each, *_ in a.components}
    functions = {each: recorder.function(each) for each in (*FUNCTIONS, "sinc")}
    outputs = stepped(rates, method, inputs, inputs[SIZE], functions, recorder.constant)
    results = [each for a in signature.arguments if a.role == "out" for each, *_ in a.components]
    return recorder.program(signature, dict(zip(results, outputs, strict=True)))
