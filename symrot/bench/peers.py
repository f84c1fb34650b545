"""heyoka around the very right-hand sides that symrot emits, for comparisons; ``None`` where it is not installed."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from symrot.kernel import Program

__all__ = ["heyoka_integrator", "heyoka_system"]

FUNCTIONS = ("sqrt", "sin", "cos", "exp", "log", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan", "atan2")


def heyoka_system(rates: Program, parameters: Mapping[str, float]) -> list[Any]:
    """Return heyoka's form of a right-hand side, its parameters compiled in as numbers."""
    import heyoka

    names = [name for name, *_ in rates.signature.argument("y").components]
    variables = dict(zip(names, heyoka.make_vars(*names), strict=True))
    functions = {name: getattr(heyoka, name) for name in FUNCTIONS}
    found = rates.evaluate({**variables, **parameters, "t": heyoka.time}, functions, float)
    return [(variables[name], found[f"d{name}"]) for name in names]


def heyoka_integrator(
    rates: Program, parameters: Mapping[str, float], start: Sequence[float], tolerance: float, settings: dict[str, bool]
) -> Callable[[float], tuple[Any, int]] | None:
    """Return a function from the end of a span, which begins at 0, to the last state and the number of steps."""
    try:
        import heyoka
    except ImportError:
        return None
    integrator = heyoka.taylor_adaptive(heyoka_system(rates, parameters), list(start), tol=tolerance, **settings)

    def run(stop: float) -> tuple[Any, int]:
        integrator.time = 0.0
        integrator.state[:] = start
        steps = integrator.propagate_until(stop)[3]
        return integrator.state.copy(), int(steps)

    return run
