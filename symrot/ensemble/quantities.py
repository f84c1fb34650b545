"""Output quantities of many motions at once, computed by the scene's kernel from arrays of states and constants."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from symrot.ensemble.numbers import Numbers
from symrot.ensemble.variation import Variation
from symrot.planning.plan import Plan
from symrot.propagation.array_functions import ARRAY_FUNCTIONS
from symrot.propagation.compiled_models import scene_kernel
from symrot.propagation.steppers.stepping import Floats

__all__ = ["Source"]


class Source(NamedTuple):
    """The initial states and constants of each motion of an ensemble, and equations (a plan) valid for all motions."""

    variation: Variation
    plan: Plan

    def evaluate(
        self, names: Sequence[str], t: Floats, omega: Floats, quaternion: Floats | None, chosen: Sequence[int]
    ) -> Floats:
        """Return the output quantities ``names`` of the motions ``chosen``, shape (n, m, len(names)).

        The times ``t`` have the shape (m,) or (n, m).
        """
        structure = self.plan.structure.unreduced()
        plan = replace(self.plan, structure=replace(structure, attitude=quaternion is not None))
        kernel = scene_kernel(plan)
        numbers = Numbers(self.variation, plan, chosen).values_of(kernel.quantity_parameters)
        values: dict[str, Any] = {f"omega_{k + 1}": omega[..., k] for k in range(3)}
        if quaternion is not None:
            values |= {f"q{k}": quaternion[..., k] for k in range(4)}
        values = {name: values[name] for name in plan.states} | {"t": t}
        values |= {name: numbers[:, k, None] for k, (name, _) in enumerate(kernel.quantity_parameters)}
        outputs = kernel.quantities.evaluate(values, ARRAY_FUNCTIONS, float, names)
        result = np.empty((*omega.shape[:-1], len(names)))
        for k, name in enumerate(names):
            result[..., k] = outputs[name]
        return result
