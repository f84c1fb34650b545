"""Outputs of a sweep: quantities of each trajectory at all sample times or at one time, or their extremes and means.

Examples: ``energy`` at all sample times, ``omega_1@end`` at the last time, ``axis_z@2.5`` at 2.5 s, ``omega_3@max``,
the largest sample, and ``omega_2_by_weight@end``, a derivative with respect to an initial value or a constant.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.conventions import parse_sequence
from symrot.errors import InputError, nearest, with_hint
from symrot.formula.exact_numbers import read, show
from symrot.propagation.sensitivities.variables import ATTITUDE, Variable, read_variables
from symrot.results.labels import COMPONENTS, FRAMES
from symrot.results.sensitivity import OUTPUTS, quotient_unit
from symrot.results.tables import BY
from symrot.scene.scene import Scene
from symrot.scene.tables import QUANTITIES, Output

__all__ = [
    "AT_TIMES",
    "REDUCTIONS",
    "UNAVERAGED",
    "SweepOutput",
    "evaluate",
    "read_outputs",
    "sample_times",
    "scene_for",
    "variable_keys",
]

Floats = NDArray[np.float64]

AT_TIMES = ("start", "end")
UNAVERAGED = {
    "euler": "angles jump by 360 degrees, and the mean of 179 and -179 degrees is not 0",
    "quaternion": "q and -q are one attitude",
}
"""Quantity -> why its components have no mean and no percentiles over trajectories.

Angles have no mean over time either.
"""

REDUCTIONS: dict[str, tuple[str, Callable[[Floats], Floats]]] = {
    "min": ("smallest value among the samples", lambda values: values.min(axis=1)),
    "max": ("largest value among the samples", lambda values: values.max(axis=1)),
    "mean": ("mean of the samples", lambda values: values.mean(axis=1)),
}
"""Name of a reduction, such as ``max`` in the output ``omega_3@max`` -> its meaning and its function.

The function takes the m samples of n trajectories, shape (n, m), and returns one number for each, shape (n,).
"""


@dataclass(frozen=True)
class SweepOutput:
    """One output: its name, a component of a quantity, and the times or the reduction (such as ``max``) for it."""

    name: str
    quantity: str
    component: int
    reduction: str  # "" for the samples at all times, a name in REDUCTIONS, or "at" for one time
    time: float  # the time, s, of the reduction "at"
    unit: str
    frame: str
    meaning: str

    @property
    def is_series(self) -> bool:
        """Whether the output has one value for each sample time."""
        return not self.reduction


def _components(output: Output) -> dict[str, tuple[str, int]]:
    """Return a map from the name of each component, such as ``omega_1``, to its quantity and index."""
    names = {name: (quantity, k) for quantity, parts in COMPONENTS.items() for k, name in enumerate(parts)}
    if output.sequence:
        names |= {f"euler_{output.sequence}_{k + 1}": ("euler", k) for k in range(3)}
    return names


def scene_for(scene: Scene, texts: Sequence[str]) -> Scene:
    """Return a scene with the Euler sequence that the outputs ``texts`` name, and with angles in rad.

    The output ``euler_ZYX_1@end``, for example, names the sequence ZYX. The scene is returned unchanged if the outputs
    name no sequence, or the sequence of the scene. Raise InputError for two sequences, or for three letters that are no
    sequence.
    """
    from dataclasses import replace

    sequences = []
    for text in (text for text in texts if isinstance(text, str)):  # others are refused when they are read
        word, _, rest = text.partition("@")[0].strip().partition("_")
        sequence = rest.partition("_")[0]
        if word == "euler" and len(sequence) == 3 and sequence not in sequences:
            sequences.append(sequence)
    if not sequences or sequences == [scene.output.sequence]:
        return scene
    if len(sequences) > 1:
        raise InputError(f"output: expected Euler angles of one sequence, got {' and '.join(sequences)}")
    parse_sequence(sequences[0])
    return replace(scene, output=Output(scene.output.quantities, sequences[0], False))


def read_outputs(texts: Sequence[str], scene: Scene, times: Floats) -> tuple[SweepOutput, ...]:
    """Return the outputs that texts such as ``omega_1@end`` describe.

    Parameters
    ----------
    texts : sequence of str
        Names of quantities or of components, each alone or with ``@start``, ``@end``, ``@min``, ``@max``, ``@mean`` or
        ``@TIME`` in s. A quantity of several components stands for all of them. A derivative is written
        ``omega_by_weight`` or ``q0_by_omega_3``, with the names of :class:`symrot.Sensitivities`.
    scene : Scene
        The scene; it determines the Euler sequence and the variables of derivatives.
    times : array, shape (m,)
        Sample times, s.

    Raises
    ------
    InputError
        If a name or a reduction is unknown, a time is outside the sample times, an output occurs twice, or there is
        none.
    """
    outputs = [output for text in texts for output in _read(text, scene, times)]
    names = [output.name for output in outputs]
    twice = next((name for k, name in enumerate(names) if name in names[:k]), None)
    if twice is not None:
        raise InputError(f"output: expected each output once, got {twice} a second time")
    if not outputs:
        raise InputError("output: expected at least one output, such as omega_1@end")
    return tuple(outputs)


def _read(text: object, scene: Scene, times: Floats) -> list[SweepOutput]:
    if not isinstance(text, str):
        raise InputError(f"output: expected a text such as 'omega_1@end', got {show(text)}")
    name, at, word = (part.strip() for part in text.partition("@"))
    reduction, time, suffix = _reduction(word, times) if at else ("", 0.0, "")
    components = _components(scene.output)
    if BY in name:
        return _derivatives(name, scene, reduction, time, suffix)
    if name in components:
        chosen = [name]
    elif name in QUANTITIES:
        chosen = [key for key, (quantity, _) in components.items() if quantity == name]
    else:
        chosen = []
    if not chosen:
        known = [*QUANTITIES, *components]
        reason = nearest(name, known) or "Euler angles are written as euler_ZXZ_1"
        raise InputError(f"output: expected one of {', '.join(QUANTITIES)} or a component, got {show(name)} ({reason})")
    outputs = []
    for key in chosen:
        quantity, k = components[key]
        unit, meaning = QUANTITIES[quantity]
        if quantity == "euler" and reduction == "mean":
            raise InputError(
                f"output: expected an output other than {key + suffix}, since {UNAVERAGED[quantity]}; take the mean of "
                "axis or dcm"
            )
        if quantity == "euler":
            unit = "deg" if scene.output.degrees else "rad"
            meaning = f"Euler angle {k + 1} of {scene.output.sequence}, in order of application"
        meaning += _reduced(reduction, time)
        frame = FRAMES.get(quantity, "")
        outputs.append(SweepOutput(key + suffix, quantity, k, reduction, time, unit, frame, meaning))
    return outputs


def _reduced(reduction: str, time: float) -> str:
    """Return the end of an output's description: ``", at t = 2.5 s"`` for ``omega_1@2.5``; empty for ``omega_1``."""
    if not reduction:
        return ""
    return f", {REDUCTIONS[reduction][0]}" if reduction in REDUCTIONS else f", at t = {time!r} s"


def _derivatives(name: str, scene: Scene, reduction: str, time: float, suffix: str) -> list[SweepOutput]:
    """Return the outputs for the name of a derivative: one for ``omega_2_by_weight``, three for ``omega_by_weight``.

    ``reduction``, ``time`` and ``suffix`` come from the word after @ in the output's text, see :func:`_reduction`.
    """
    part, _, variable = name.partition(BY)
    parts = {component: (quantity, k) for quantity, (names, *_) in OUTPUTS.items() for k, component in enumerate(names)}
    chosen = [part] if part in parts else [key for key, (quantity, _) in parts.items() if quantity == part]
    if not chosen:
        known = [*OUTPUTS, *parts]
        message = f"output: expected one of {', '.join(known)} before {BY}, got {show(name)}"
        raise InputError(with_hint(message, part, known))
    outputs = []
    for item in variables_of(variable, scene):
        for key in chosen:
            quantity, k = parts[key]
            _, unit, frame, meaning = OUTPUTS[quantity]
            text = f"derivative of the {meaning} with respect to {item.name}{_reduced(reduction, time)}"
            own = f"{quantity}{BY}{item.name}"
            label = f"{key}{BY}{item.name}{suffix}"
            outputs.append(SweepOutput(label, own, k, reduction, time, quotient_unit(unit, item.unit), frame, text))
    return outputs


def variables_of(name: str, scene: Scene) -> list[Variable]:
    """Return the variables of differentiation that ``name`` stands for in an output such as ``omega_by_weight``.

    ``name`` is the part of the output's name after ``_by_``. ``weight`` stands for one variable, ``attitude`` for
    three, and ``attitude_2`` for one of these three.
    """
    stem, _, number = name.rpartition("_")
    key = stem if stem == ATTITUDE and number in ("1", "2", "3") else name
    try:
        variables = read_variables(scene, [key])
    except InputError as reason:
        raise InputError(f"output: {str(reason).removeprefix('sensitivities: ')}") from None
    return [variable for variable in variables if key == name or variable.name == name]


def variable_keys(outputs: Sequence[SweepOutput]) -> list[str]:
    """Return the names of the variables of all derivatives among the outputs, as ``sensitivities`` expects them."""
    names = dict.fromkeys(output.quantity.partition(BY)[2] for output in outputs if BY in output.quantity)
    return list(dict.fromkeys(ATTITUDE if name.rpartition("_")[0] == ATTITUDE else name for name in names))


def _reduction(word: str, times: Floats) -> tuple[str, float, str]:
    """Return (reduction, time in s, ending) for the word after @ in the name of an output.

    ``max`` gives ("max", 0.0, "@max"), and 2.5 gives ("at", 2.5, "@2.5").
    """
    if word in REDUCTIONS:
        return word, 0.0, f"@{word}"
    if word in AT_TIMES:
        # the first or the last time, s
        return "at", float(times[0] if word == "start" else times[-1]), f"@{word}"
    known = (*AT_TIMES, *REDUCTIONS)
    expectation = with_hint(f"one of {', '.join(known)} or a time in s after @", word, known)
    time = float(read(word, "output", expectation))
    low, high = float(times.min()), float(times.max())
    if not low <= time <= high:
        raise InputError(f"output: expected a time from {low!r} to {high!r} s after @, got {show(word)}")
    return "at", time, f"@{word}"


def sample_times(outputs: Sequence[SweepOutput], times: Floats) -> Floats:
    """Return the times, s, at which the motions must be sampled so that all outputs can be computed."""
    # fewer than all sample times if every output is at a single time
    whole = any(output.reduction != "at" for output in outputs)
    own = [output.time for output in outputs if output.reduction == "at"]
    return np.unique([*(times.tolist() if whole else []), *own])


def evaluate(outputs: Sequence[SweepOutput], ensemble: Any, times: Floats, samples: Floats) -> dict[str, Floats]:
    """Return the outputs of the n motions of an ensemble by name, shape (n, m) at m times, else (n,).

    Parameters
    ----------
    outputs : sequence of SweepOutput
        The outputs.
    ensemble : Ensemble
        n motions with samples at the times ``samples``.
    times : array, shape (m,)
        The sample times that the sweep asks for, s.
    samples : array
        All times at which the ensemble was computed, s, ascending, from :func:`sample_times`: the ``times``, and
        single times of outputs such as ``omega_1@2.5``.
    """
    places = np.searchsorted(samples, times) if np.isin(times, samples).all() else np.empty(0, dtype=np.intp)
    values: dict[str, Floats] = {}
    quantities: dict[str, Floats] = {}
    for output in outputs:
        if output.quantity not in quantities:
            whole = _samples(ensemble, output.quantity)
            quantities[output.quantity] = whole.reshape(*whole.shape[:2], -1)
        column = quantities[output.quantity][..., output.component]
        if output.reduction == "at":
            values[output.name] = column[:, int(np.searchsorted(samples, output.time))]
        else:
            series = column[:, places]
            values[output.name] = REDUCTIONS[output.reduction][1](series) if output.reduction else series
    return values


def _samples(ensemble: Any, quantity: str) -> Floats:
    """Return the samples of a quantity or of a derivative such as ``omega_by_weight``.

    The shape is (n, m, ...) for the n motions of the ensemble and its m sample times; the further dimensions are those
    of the quantity.
    """
    part, by, variable = quantity.partition(BY)
    samples: Floats = getattr(ensemble.sensitivities[variable], part) if by else ensemble.quantity(quantity)
    return samples
