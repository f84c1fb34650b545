"""Compiled libraries that integrate a motion together with its derivatives.

The derivatives are those with respect to variables: initial values and constants of a scene.

Taylor series need derivatives of every order. A root such as ``|omega|`` has none where it is zero; there
Dormand-Prince 8(5,3), whose error control handles corners, takes their place.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from symrot.build import cache as library
from symrot.errors import InputError, PropagationError
from symrot.formula.program import Program, node_from_json, node_to_json
from symrot.formula.switches import STATES
from symrot.formula.tree import Node
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import Parameters
from symrot.propagation.compiled_models import has_formulas, kernel_key, needs_bounds
from symrot.propagation.sensitivities.corners import places_within, rests_at_corner
from symrot.propagation.steppers import dop853, taylor
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.smoothness import non_smooth_torque

__all__ = ["ORDER", "RATES", "TOLERANCE", "MotionLibrary", "rates_of", "variation_source"]

Floats = NDArray[np.float64]
RATES = 3  # the first states are angular velocities
ORDER = 20
TOLERANCE = 1e-16


def rates_of(plan: Plan) -> tuple[Program, Parameters]:
    """Return the rates (time derivatives of the states) in the equations of a scene's plan, as a program.

    The second result has the parameters of the program, pairs (name, formula).
    """
    key = f"rates alone\n{kernel_key(plan)}"
    # a clock counts time from an epoch, which is a further constant in the formulas
    saved = library.fetch(key)
    if saved is None and plan.structure.clock:
        from symrot.codegen.taylor.time_shift import moved

        rates, formulas = moved(*rates_of(replace(plan, structure=replace(plan.structure, clock=None))))
        saved = json.dumps(
            {"rates": rates.to_json(), "parameters": [(name, node_to_json(node)) for name, node in formulas]}
        )
        library.store(key, saved)
    if saved is None:
        from symrot.codegen.scene_kernels import rates_program
        from symrot.dynamics.equations import equations_of_motion

        derived = rates_program(equations_of_motion(plan.structure), "rates")
        parameters = [(name, node_to_json(node)) for name, node in derived.parameters]
        saved = json.dumps({"rates": derived.program.to_json(), "parameters": parameters})
        library.store(key, saved)
    record = json.loads(saved)
    formulas = tuple((name, node_from_json(node)) for name, node in record["parameters"])
    return Program.from_json(record["rates"]), formulas


def variation_source(
    plan: Plan,
    rates: Program,
    depends: Sequence[Sequence[str]],
    stepper: str,
    source: Callable[..., str],
    rough: bool = False,
) -> str:
    """Return the C source of a library that integrates a motion and its derivatives with respect to variables.

    Parameters
    ----------
    plan : Plan
        The plan of the rates; the source is kept in the cache under its key.
    rates : Program
        The time derivatives of the states.
    depends : sequence of sequences of str
        For each variable of the derivatives, the names of those parameters of ``rates`` whose values depend on it.
    stepper : str
        The name of the stepper, Taylor series or Dormand-Prince, which is a part of the key.
    source : function
        Returns the C source for three arguments: the program of the rates of states and derivatives, ``edges`` and
        ``scales``. The error of a step is measured in blocks of the state vector: block i goes from index ``edges[i]``
        to ``edges[i + 1]``, and its error is divided by ``scales[i]`` or, where this is 0, by the size of the block
        (:func:`symrot.propagation.compiled_models.error_blocks`).
    rough : bool
        See :func:`symrot.codegen.variational.variational_program`.

    Raises
    ------
    InputError
        If the rates have no derivatives, or no Taylor series where ``source`` needs them.
    """
    key = f"variation {stepper} {ORDER} {json.dumps(depends)}\n{kernel_key(plan)}"
    text = library.fetch(key)
    if text is None:
        from symrot.codegen.variational import variational_program

        size = len(STATES)
        edges, scales = [0], []
        for column in range(len(depends) + 1):
            edges += [column * size + RATES, (column + 1) * size]
            scales += [0.0, 1.0]
        try:
            text = source(variational_program(rates, depends, rough), edges, scales)
        except InputError as reason:
            raise InputError(f"{plan.scene.name}: sensitivities: {reason}") from None
        library.store(key, text)
    return text


class MotionLibrary:
    """The compiled code that integrates one motion with its derivatives with respect to variables.

    The arguments ``plan``, ``rates`` and ``depends`` are those of :func:`variation_source`.
    """

    def __init__(self, plan: Plan, rates: Program, depends: Sequence[Sequence[str]]) -> None:
        self._plan, self._rates, self._depends = plan, rates, depends

        def source(program: Program, edges: Sequence[int], scales: Sequence[float]) -> str:
            return taylor.translation_unit(program, edges, scales, ORDER, "", needs_bounds(plan))

        text = variation_source(plan, rates, depends, f"taylor {needs_bounds(plan)}", source)
        self._path = library.build(text, "taylor", taylor.FLAGS)

    @cached_property
    def _rough_path(self) -> Path:
        """The path of the library that integrates by Dormand-Prince 8(5,3), compiled on first use."""

        def source(program: Program, edges: Sequence[int], scales: Sequence[float]) -> str:
            from symrot.codegen.enclosure.source import enclosure_source
            from symrot.codegen.lowering.lower import Lowered
            from symrot.codegen.scene_kernels import rates_source

            arguments = {argument.name: argument.components for argument in program.signature.arguments}
            parameters = tuple((name, ("symbol", name)) for name, *_ in arguments.get("p", ()))
            text = rates_source(Lowered(program, parameters))
            # the bounds are those of the rates alone: derivatives of roots have poles, which no bound encloses
            zero: Node = ("number", Fraction(0))
            outputs = tuple((name, node if k < len(STATES) else zero) for k, (name, node) in enumerate(program.outputs))
            own = replace(program, outputs=outputs)
            bounds = (enclosure_source(own, dop853.DENSE_ORDER, edges),) if has_formulas(self._plan) else ()
            sizes = len(arguments["y"]), len(parameters)
            return dop853.translation_unit(text, "symrot_rates", *sizes, edges, scales, *bounds)

        text = variation_source(self._plan, self._rates, self._depends, "dop853", source, rough=True)
        return library.build(text, "motion")

    def sample(self, p: Sequence[float], y: Sequence[float], begin: float, times: Floats) -> Floats:
        """Return the states and their derivatives with respect to m variables at n times, s, shape (n, 7 + 7 m).

        ``p`` holds the parameters of the rates, then their derivatives; ``y`` the states and derivatives at ``begin``.

        Raises
        ------
        PropagationError
            If the motion cannot be followed to the last time, or has no derivatives.
        """
        try:
            samples, _ = taylor.integration(self._path, p, y, begin, TOLERANCE).sample(times)
        except PropagationError as error:
            if not non_smooth_torque(self._plan):
                raise
            between = places_within(begin, times)
            try:
                motion = dop853.integration(self._rough_path, p, y, begin, TOLERANCE)
                samples, _ = motion.sample(np.concatenate([times, between]))
            except PropagationError:
                raise error from None
            if rests_at_corner(self._rates, self._depends, p, between, samples[len(times) :]):
                reason = "the torque is not differentiable there, since a square root such as |omega| stays at zero"
                raise IntegrationStopped(begin, reason) from None
        return samples[: len(times)]
