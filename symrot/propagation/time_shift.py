"""Clocks that show 0 at the start, for motions that start far from t = 0.

The clock of a motion is the time that its stepper counts; the epoch is the scene time at which it shows 0. With an
epoch at the start, times are small: phases ``a*t + b`` and ends of short steps keep their digits.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import lcm
from typing import Any

from symrot.build import cache as library
from symrot.formula import exact_numbers as number
from symrot.formula.exact_functions import exact_value
from symrot.formula.tree import Node, children, names
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import EPOCH, Parameters, SceneKernel
from symrot.propagation.compiled_models import kernel_key, motion_library
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.stepping import NOT_FINITE_SENTENCE

__all__ = ["ShiftedParameters", "clock", "starts_far", "time_shifted"]

# Long motions from 0 keep the digits of their phases in other ways: Taylor steps hold the time in two doubles, DOP853
# moves the clock of the rates repeatedly, SciPy restarts on a moved clock where its steps are short.
# Not covered: a torque without a formula is evaluated at scene times, on which a phase a*t has an error of up to
# 1e-16*|a*t| rad; motions in Euler angles start on scene time too.


def starts_far(start: float, low: float, high: float) -> bool:
    """Return whether the start is not 0 and all times from ``low`` to ``high`` lie between half and twice the start."""
    # A clock with 0 at the start pays only there: a motion that goes farther loses no more digits than a motion of
    # that length from t = 0.
    nearest, farthest = sorted((0.5 * start, 2.0 * start))
    return start != 0.0 and nearest <= low and high <= farthest  # time - start is exact there (Sterbenz)


def time_shifted(plan: Plan, kernel: SceneKernel) -> tuple[Plan, SceneKernel]:
    """Return a plan (equations of a scene) and its kernel, in which t is the scene time minus an epoch.

    The epoch is a new constant of the plan. Plan and kernel are returned unchanged if the rates do not depend on time.
    """
    if not kernel.rates.uses("t"):
        # the rates do not depend on time
        return plan, kernel
    plan = replace(plan, structure=replace(plan.structure, clock=EPOCH))
    saved = library.fetch(kernel_key(plan))
    if saved is not None:
        return plan, SceneKernel(json.loads(saved))
    from symrot.codegen.taylor.time_shift import from_epoch

    kernel = from_epoch(kernel)
    library.store(kernel_key(plan), json.dumps(kernel.record))
    return plan, kernel


class ShiftedParameters:
    """Values of formulas that contain the epoch, the time from which a stepper counts; long motions move it.

    Parameters
    ----------
    parameters : pairs of name and formula
        Formulas of the epoch, for example the parameters of the rates of a kernel that :func:`time_shifted` returns.
    constants : mapping
        Constants of the scene, by name.
    start : float
        Time of the scene, s, at which the clock of the motion shows 0.
    """

    def __init__(self, parameters: Parameters, constants: Mapping[str, Fraction], start: float = 0.0) -> None:
        known = {"pi": number.PI, **constants}
        self._start = Fraction(start)
        # subexpressions without the epoch are computed once, here
        self._formulas = [_folded(node, known) for _, node in parameters]
        self.fixed = all(node[0] == "number" for node in self._formulas)
        self._lines = [_line(node) for node in self._formulas]

    def parameters(self, epoch: float | Fraction) -> list[float]:
        """Return the values of all formulas, in order, for one epoch, given as a time in s after ``start``.

        ``start`` is an argument of the constructor. The formulas contain the epoch as a time of the scene: ``start`` +
        ``epoch``.

        Each value is computed exactly, or to many more digits than a double has, and rounded once; it is NaN where the
        formula has no real value. Raise IntegrationStopped if a value exceeds the range of doubles.
        """
        time = self._start + Fraction(epoch)
        top, bottom, values = time.numerator, time.denominator, {EPOCH: time}
        try:
            return [
                float(exact_value(node, values))
                if line is None
                else (line[0] * bottom + line[1] * top) / (line[2] * bottom)
                for node, line in zip(self._formulas, self._lines, strict=True)
            ]
        except OverflowError:
            raise IntegrationStopped(float(epoch), NOT_FINITE_SENTENCE) from None


def _line(node: Node) -> tuple[int, int, int] | None:
    """Return integers (a, b, c) of a formula (a + b*epoch)/c: (2, 3, 6) for ``epoch/2 + 1/3``; else None."""
    # this is fast to evaluate
    values = _coefficients(node)
    if values is None:
        return None
    constant, slope = values
    shared = lcm(constant.denominator, slope.denominator)
    return int(constant * shared), int(slope * shared), shared


def _coefficients(node: Node) -> tuple[Fraction, Fraction] | None:
    """Return (a, b) of a formula that is evidently a + b*epoch: (2, 2) for ``2*(epoch + 1)``; None for any other."""
    if node[0] == "number":
        return None if node[1] != node[1] else (Fraction(node[1]), Fraction(0))
    if node == ("symbol", EPOCH):
        return Fraction(0), Fraction(1)
    parts = [_coefficients(child) for child in children(node)]
    if node[0] == "call" or any(part is None for part in parts):
        return None
    (a, b), *others = (part for part in parts if part is not None)
    if node[0] == "neg":
        return -a, -b
    if node[0] == "**":
        return (a, b) if node[2] == 1 else None
    ((c, d),) = others
    if node[0] in "+-":
        sign = 1 if node[0] == "+" else -1
        return a + sign * c, b + sign * d
    if node[0] == "*" and not (b and d):
        return a * c, a * d + b * c
    return (a / c, b / c) if node[0] == "/" and not d else None


def clock(
    shifted: Callable[[], tuple[Plan, SceneKernel]],
    constants: Mapping[str, Fraction],
    start: float = 0.0,
    make: Callable[[Plan, SceneKernel], Any] = motion_library,
) -> Callable[[float], tuple[Any, list[float]]]:
    """Return a function from an epoch, s after ``start``, to the rates and the values of their parameters.

    In the rates, t is the time since the epoch. At a late time, a stepper begins to count its time from a new epoch and
    calls this function. The rates are the same for every epoch and are made on first use; only the values of the
    parameters differ.

    Parameters
    ----------
    shifted : function
        Returns a plan (equations of a scene) and its kernel in which the epoch is a constant, as :func:`time_shifted`
        does.
    constants : mapping
        The other constants of the scene, by name.
    start : float
        Time of the scene, s, at which the clock of the motion shows 0.
    make : function
        Takes this plan and kernel and returns the rates: a compiled library for DOP853, a Python function for SciPy.
    """

    @cache
    def rates() -> tuple[Any, ShiftedParameters]:
        plan, kernel = shifted()
        return make(plan, kernel), ShiftedParameters(kernel.rate_parameters, constants, start)

    return lambda since: (rates()[0], rates()[1].parameters(since))


def _folded(node: Node, known: Mapping[str, Fraction]) -> Node:
    """Return a formula in which each subexpression that does not contain the symbol epoch is replaced by its value.

    For a = 3, ``a*2*epoch`` becomes ``6*epoch``.
    """
    if node == ("symbol", EPOCH):
        return node
    if EPOCH not in names(node):
        return ("number", exact_value(node, known))
    if node[0] == "call":
        return ("call", node[1], tuple(_folded(child, known) for child in node[2]))
    return (node[0], *(_folded(child, known) for child in children(node)), *(node[2:] if node[0] == "**" else ()))
