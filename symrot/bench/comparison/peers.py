"""Runs of heyoka and SciPy, for comparison with symrot, on the right-hand sides that symrot derives."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from symrot.codegen.numpy_kernel import UNNAMED, function_in
from symrot.codegen.printing.numpy_source import numpy_source
from symrot.formula.program import Program

__all__ = ["heyoka_integrator", "heyoka_system", "scalar_kernel"]

FUNCTIONS = ("sqrt", "sin", "cos", "exp", "log", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan", "atan2")


def heyoka_system(
    rates: Program, parameters: Mapping[str, Any], number: Callable[[Any], Any] = float
) -> list[tuple[Any, Any]]:
    """Return the right-hand side dy/dt in heyoka's form: pairs (variable, formula), in the order of the states.

    Parameters
    ----------
    rates : Program
        The rates dy/dt.
    parameters : mapping
        The values of the parameters of the rates, numbers or expressions of heyoka, which replace their names.
    number : callable
        Converts the constants in the formulas, for example to long double.
    """
    import heyoka

    names = [name for name, *_ in rates.signature.argument("y").components]
    variables = dict(zip(names, heyoka.make_vars(*names), strict=True))
    functions = {name: getattr(heyoka, name) for name in FUNCTIONS}
    derivatives = rates.evaluate({**variables, **parameters, "t": heyoka.time}, functions, number)
    return [(variables[name], derivatives[f"d{name}"]) for name in names]


def heyoka_integrator(
    rates: Program, parameters: Mapping[str, float], start: Sequence[float], tolerance: float,
    settings: dict[str, bool], initial_time: float = 0.0,
) -> Callable[[float], tuple[Any, int]] | None:  # fmt: skip
    """Return a function from an end time, s, to (state, steps): heyoka's state at this time, and its number of steps.

    The result is None if heyoka is not installed.

    Parameters
    ----------
    rates : Program
        The rates dy/dt.
    parameters : mapping
        The values of the parameters of the rates, by name.
    start : sequence of float
        The initial state.
    tolerance : float
        heyoka's tolerance.
    settings : dict
        Further arguments of heyoka's ``taylor_adaptive``, such as ``{"compact_mode": True}``.
    initial_time : float
        The time of the initial state, s.
    """
    try:
        import heyoka
    except ImportError:
        return None
    integrator = heyoka.taylor_adaptive(heyoka_system(rates, parameters), list(start), tol=tolerance, **settings)

    def run(stop: float) -> tuple[Any, int]:
        integrator.time = initial_time
        integrator.state[:] = start
        steps = integrator.propagate_until(stop)[3]
        return integrator.state.copy(), int(steps)

    return run


def scalar_kernel(program: Program) -> Callable[..., Any]:
    """Return the NumPy function that symrot emits for dy/dt, as ``f(t, y, p)`` for one state ``y`` (a list).

    Without parameters ``p`` of the rates, the function is ``f(t, y)``.
    """
    # Python floats and math replace zero-dimensional arrays. This halves SciPy's time; an expert would do it too.
    text = numpy_source(program, UNNAMED).replace("import numpy as np", "import math\n\nimport numpy as np")
    text = re.sub(r"np\.empty\(\((\d+), \*np\.shape\(y\)\[1:\]\)\)", r"np.empty(\1)", text)
    for name in ("sqrt", "sin", "cos", "tan", "exp", "log", "sinh", "cosh", "tanh"):
        text = text.replace(f"np.{name}(", f"math.{name}(")
    for name in ("sin", "cos", "tan", "tan2"):
        text = text.replace(f"np.arc{name}(", f"math.a{name}(")
    return function_in(text, program.signature.name)
