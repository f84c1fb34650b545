"""Clocks that show 0 at the start, for motions that start far from t = 0.

The clock of a motion is the time that its stepper counts; the epoch is the time of the scene at which the clock shows
0. With an epoch at the start, times in the steppers are small: neither phases such as ``a*t + b`` nor the ends of short
steps lose digits. The clock is moved only if all times lie between half the start and twice the start, where their
differences from the start are exact. A motion that goes farther loses no more digits than a motion of that length from
t = 0. Long motions from 0 keep the digits of their phases in other ways: Taylor steps hold the time in two doubles,
DOP853 moves the clock of the rates repeatedly (:mod:`symrot.propagation.steppers.dop853`), and SciPy restarts on a
moved clock where its steps are short (:mod:`symrot.propagation.steppers.fallback`).

A torque without a formula is evaluated at the times of the scene, so that motions under such a torque use the clock of
the scene, on which a phase ``a*t`` has an error of up to ``1e-16*|a*t|`` rad. Motions in Euler angles start on the
clock of the scene too.
"""

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from math import lcm
from pathlib import Path
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

__all__ = ["ShiftedParameters", "clock", "compiled", "starts_far", "time_shifted"]


def starts_far(start: float, low: float, high: float) -> bool:
    """Return whether a motion over the times from ``low`` to ``high``, s, should use a clock that shows 0 at its start.

    It should if all times lie between half and twice the start, since differences from the start are exact there. For a
    start at 1000 s these are the times from 500 to 2000 s; for a start at 0 the result is False.
    """
    nearest, farthest = sorted((0.5 * start, 2.0 * start))
    return start != 0.0 and nearest <= low and high <= farthest  # time - start is exact there (Sterbenz)


def time_shifted(plan: Plan, kernel: SceneKernel) -> tuple[Plan, SceneKernel]:
    """Return a plan and its kernel that count time from an epoch, a new constant of the plan.

    The epoch is a time of the scene, s: in the result, t is the time of the scene minus the epoch. If the rates do not
    depend on time, plan and kernel are returned unchanged.
    """
    if not kernel.rates.uses("t"):
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
    """Values of formulas that contain the time of the scene at which the clock of a stepper shows 0.

    A motion has a clock, which shows 0 at its start. In a long motion, the stepper has another clock, which it sets to
    0 again and again, so that times keep their digits. The time on the motion's clock at such a moment is the epoch,
    and :meth:`parameters` returns the values of the formulas for it. Subexpressions without it are computed once.

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
        self._formulas = [_folded(node, known) for _, node in parameters]
        self.fixed = all(node[0] == "number" for node in self._formulas)
        self._lines = [_line(node) for node in self._formulas]

    def parameters(self, epoch: float | Fraction) -> list[float]:
        """Return the values of all parameters of the rates for an epoch, s, each computed exactly and rounded once.

        The stepper sets its clock to 0 again and again in a long motion; ``epoch`` is the time of the last reset, s, on
        the clock of the motion. IntegrationStopped is raised if a value exceeds the range of doubles.
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
    """Return integers a, b, c if a formula equals (a + b*epoch)/c, which is fast to evaluate; None otherwise.

    For the formula ``epoch/2 + 1/3`` they are (2, 3, 6).
    """
    values = _coefficients(node)
    if values is None:
        return None
    constant, slope = values
    shared = lcm(constant.denominator, slope.denominator)
    return int(constant * shared), int(slope * shared), shared


def _coefficients(node: Node) -> tuple[Fraction, Fraction] | None:
    """Return the numbers a and b of a formula that equals a + b*epoch, or None for any other formula.

    For the formula ``2*(epoch + 1)`` they are 2 and 2.
    """
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


def compiled(plan: Plan, kernel: SceneKernel) -> Path:
    """Return the path of the library (kernel and DOP853 stepper) for a plan whose time is counted from an epoch.

    Plan and kernel are those that :func:`time_shifted` returns.
    """
    return motion_library(plan, kernel)


def clock(
    moving: Callable[[], tuple[Plan, SceneKernel]],
    constants: Mapping[str, Fraction],
    start: float = 0.0,
    make: Callable[[Plan, SceneKernel], Any] = compiled,
) -> Callable[[float], tuple[Any, list[float]]]:
    """Return a function that takes an epoch, s, and returns rates that count time from it, with their parameters.

    ``moving`` returns plan and kernel as :func:`time_shifted` does; it is called on first use. ``constants`` and
    ``start`` are arguments of :class:`ShiftedParameters`. ``make`` converts plan and kernel to the rates: to the
    library that DOP853 calls, or to the Python function that SciPy calls.
    """

    @cache
    def following() -> tuple[Any, ShiftedParameters]:
        plan, kernel = moving()
        return make(plan, kernel), ShiftedParameters(kernel.rate_parameters, constants, start)

    return lambda since: (following()[0], following()[1].parameters(since))


def _folded(node: Node, known: Mapping[str, Fraction]) -> Node:
    """Return a formula in which each subexpression that does not contain the epoch is replaced by its value.

    ``known`` holds the exact values of all other names. With ``a`` = 3 the formula ``a*2*epoch`` becomes ``6*epoch``.
    """
    if node == ("symbol", EPOCH):
        return node
    if EPOCH not in names(node):
        return ("number", exact_value(node, known))
    if node[0] == "call":
        return ("call", node[1], tuple(_folded(child, known) for child in node[2]))
    return (node[0], *(_folded(child, known) for child in children(node)), *(node[2:] if node[0] == "**" else ()))
