"""The output quantities of a trajectory with labels: names of components, meaning, unit and frame."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError, with_hint
from symrot.formula.exact_numbers import show
from symrot.scene.tables import QUANTITIES, Output

__all__ = ["LOCK", "About", "Labelled", "about", "chosen_names", "labelled"]

BODY, SPACE = ("1", "2", "3"), ("x", "y", "z")
LOCK = "euler_lock"

COMPONENTS: dict[str, tuple[str, ...]] = {
    "omega": tuple(f"omega_{i}" for i in BODY),
    "omega_space": tuple(f"omega_{i}" for i in SPACE),
    "quaternion": ("q0", "q1", "q2", "q3"),
    "dcm": tuple(f"dcm_{i}{j}" for i in BODY for j in BODY),
    "energy": ("energy",),
    "kinetic_energy": ("kinetic_energy",),
    "angular_momentum_body": tuple(f"L_{i}" for i in BODY),
    "angular_momentum_space": tuple(f"L_{i}" for i in SPACE),
    "polhode": tuple(f"polhode_{i}" for i in BODY),
    "herpolhode": tuple(f"herpolhode_{i}" for i in SPACE),
    "axis": tuple(f"axis_{i}" for i in SPACE),
}
FRAMES = {
    **dict.fromkeys(("omega", "angular_momentum_body", "polhode"), "body"),
    **dict.fromkeys(("omega_space", "angular_momentum_space", "herpolhode", "axis"), "space"),
    **dict.fromkeys(("quaternion", "euler", "dcm", LOCK), "body to space"),
}


class Labelled(NamedTuple):
    """One quantity of a trajectory with its labels: name, components, unit, frame and meaning."""

    name: str
    # shape (n,) or (n, ...) for n samples
    values: NDArray[Any]
    components: tuple[str, ...]
    unit: str
    frame: str  # body | space | body to space | ""
    meaning: str


def _euler(output: Output) -> tuple[tuple[str, ...], str, str]:
    sequence = output.sequence or ""
    kind = "intrinsic" if sequence.isupper() else "extrinsic"
    names = tuple(f"euler_{sequence}_{i}" for i in BODY)
    return names, "deg" if output.degrees else "rad", f"Euler angles {sequence}, {kind}, in order of application"


class About(NamedTuple):
    """Where a result comes from: the scene (name, title, source), the method and the tolerance; printed with tables."""

    scene: str
    title: str
    source: str
    method: str
    tolerance: float


def about(trajectory: Any) -> About:
    """Return where a trajectory comes from: its scene, and the method and tolerance with which it was computed."""
    scene = trajectory.scene
    return About(scene.name, scene.title, scene.source, trajectory.method, trajectory.tolerance)


def event_array(number: int, quantity: str) -> str:
    """Return the name, in an NPZ file, of a quantity at the times of event ``number``, from 1: ``"event_2_omega"``."""
    return f"event_{number}_{quantity}"


def chosen_names(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return the argument ``quantities``, one name or several, as a tuple.

    Raises
    ------
    InputError
        If the argument is not made of texts, or has a name twice.
    """
    chosen = (names,) if isinstance(names, str) or not isinstance(names, Iterable) else tuple(names)
    if not all(isinstance(name, str) for name in chosen):
        raise InputError(f"quantities: expected a name or a list of names such as 'omega', got {show(names)}")
    if twice := [name for place, name in enumerate(chosen) if name in chosen[:place]]:
        raise InputError(f"quantities: expected each quantity once, got {twice[0]!r} twice")
    return chosen


def labelled(trajectory: Any, names: Sequence[str] | None = None) -> list[Labelled]:
    """Return the time and the quantities ``names`` of a trajectory with labels, for tables and files.

    By default (None), they are the output quantities of the scene, and the derivatives if there are any. After
    ``euler`` comes :data:`LOCK`, which says where the Euler angles are at gimbal lock.

    Raises
    ------
    InputError
        If there is no quantity with one of the names, or if the trajectory cannot compute it.
    """
    output, derivatives = trajectory.scene.output, _derivatives(trajectory)
    quantities = [Labelled("t", trajectory.t, ("t",), "s", "", "time")]
    chosen = output.quantities if names is None else chosen_names(names)
    for name in chosen:
        if name in derivatives:
            quantities.append(derivatives[name])
            continue
        if name not in QUANTITIES:
            known = [*QUANTITIES, *derivatives]
            message = f"quantities: expected names among {', '.join(known)}, got {name!r}"
            raise InputError(with_hint(message, str(name), known))
        unit, meaning = QUANTITIES[name]
        components = COMPONENTS.get(name, ())
        if name == "euler":
            components, unit, meaning = _euler(output)
        quantities.append(Labelled(name, trajectory.quantity(name), components, unit, FRAMES.get(name, ""), meaning))
        if name == "euler":
            # at gimbal lock, only the sum or the difference of two angles is defined
            locked = np.asarray(trajectory.gimbal_lock(output.sequence))
            meaning = "1 where the Euler sequence is at gimbal lock, else 0"
            quantities.append(Labelled(LOCK, locked, (LOCK,), "1", FRAMES[LOCK], meaning))
    return quantities if names is not None else [*quantities, *derivatives.values()]


def _derivatives(trajectory: Any) -> dict[str, Labelled]:
    """Return the labelled derivatives of a trajectory by name, such as ``"omega_by_weight"``; empty if it has none."""
    sensitivities = getattr(trajectory, "sensitivities", None)
    return {} if sensitivities is None else {item.name: item for item in sensitivities._labelled()}
