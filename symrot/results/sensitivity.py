"""Derivatives of a motion with respect to initial values and constants, at the sample times, with labels."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.results.labels import Labelled
from symrot.results.tables import BY

__all__ = [
    "OUTPUTS", "Sensitivities", "Sensitivity", "SwitchSlopes", "event_time_items", "quotient_unit", "restored",
    "time_slopes",
]  # fmt: skip

OUTPUTS = {  # quantity -> components, unit, frame, meaning
    "omega": (("omega_1", "omega_2", "omega_3"), "rad/s", "body", "angular velocity, body components"),
    "quaternion": (("q0", "q1", "q2", "q3"), "1", "body to space", "attitude"),
    "rotation": (("rotation_1", "rotation_2", "rotation_3"), "rad", "body", "small rotation about the body axes"),
}

Floats = NDArray[np.float64]
TIME = "t"


class Sensitivity(NamedTuple):
    """Derivatives of a motion at n samples with respect to one variable, or to the k components of a vector.

    For a vector, the last axis of the arrays counts its components.

    Attributes
    ----------
    omega : array, shape (n, 3) or (n, 3, k)
        Derivative of the angular velocity, body components.
    quaternion : array, shape (n, 4) or (n, 4, k)
        Derivative of the attitude as a quaternion, scalar first.
    rotation : array, shape (n, 3) or (n, 3, k)
        Derivative of the attitude as a small rotation: components, rad, about the body axes at that time.

    Examples
    --------
    >>> import symrot
    >>> motion = symrot.propagate("t_handle", t=[0, 1], sensitivities=["omega", "attitude"])
    >>> motion.sensitivities["omega"].rotation.shape
    (2, 3, 3)
    """

    omega: Floats
    quaternion: Floats
    rotation: Floats


class SwitchSlopes(NamedTuple):
    """The derivatives of the time at which a function in a torque, such as ``sign(omega_3)``, switches.

    Attributes
    ----------
    t : float
        The time, s.
    function, how : str
        The function, and how it switches, as in ``stats.switchings`` of a trajectory.
    slopes : array, shape (m,)
        The derivatives of the time with respect to the m variables, s per unit of variable; NaN where they do not
        exist.

    Examples
    --------
    >>> import symrot
    >>> motion = symrot.propagate("friction_wheel", t=[7], sensitivities=["omega_3"])
    >>> motion.sensitivities.switchings[0].slopes.round(9).tolist()
    [0.2]
    """

    t: float
    function: str
    how: str
    slopes: Floats


@dataclass(frozen=True, eq=False)
class Sensitivities(Mapping[str, Sensitivity]):
    """Derivatives of a motion at n samples with respect to m variables, as a mapping.

    The keys are the requested names, such as ``"omega"``, and each value is a :class:`Sensitivity`.

    Attributes
    ----------
    variables : tuple of str
        The m variables: the requested names, for a vector with the number of the component, such as ``omega_2``. The
        name of each variable is accepted as a key, too.
    units : tuple of str
        Units of the variables; empty for a parameter of a formula, whose unit no scene states.
    groups : mapping
        Requested name -> the numbers of its variables.
    omega, quaternion, rotation : array, shape (n, 3, m), (n, 4, m), (n, 3, m)
        The derivatives, as in :class:`Sensitivity`; for an ensemble, with one more axis, the first, over the motions.
        NaN exactly at a switch of a torque, for variables whose derivatives jump there.
    t_events : tuple of arrays, shape (k, m)
        For each event, the derivatives of its k times, s per unit of the variable; NaN where they do not exist, as
        where the formula of the event touches zero.
    switchings : tuple of SwitchSlopes
        The switches of the torques up to the last sample, with the derivatives of their times.
    times : array, shape (n, m), or None
        The derivatives of the times of the samples, if these are the times of an event (``at_events`` of a trajectory);
        None for samples at fixed times.

    Examples
    --------
    >>> import symrot
    >>> motion = symrot.propagate("t_handle", t=[0, 1], sensitivities=["omega", "attitude"])
    >>> motion.sensitivities.variables
    ('omega_1', 'omega_2', 'omega_3', 'attitude_1', 'attitude_2', 'attitude_3')
    """

    variables: tuple[str, ...]
    units: tuple[str, ...]
    groups: Mapping[str, tuple[int, ...]]
    omega: Floats
    quaternion: Floats
    rotation: Floats
    t_events: tuple[Floats, ...] = ()
    switchings: tuple[SwitchSlopes, ...] = ()
    times: Floats | None = None

    def __getitem__(self, name: str) -> Sensitivity:
        if name in self.groups:
            group = list(self.groups[name])
            places: int | list[int] = group if len(group) > 1 else group[0]
        elif name in self.variables:
            places = self.variables.index(name)
        else:
            raise KeyError(name)
        return Sensitivity(self.omega[..., places], self.quaternion[..., places], self.rotation[..., places])

    def __iter__(self) -> Iterator[str]:
        return iter(self.groups)

    def __len__(self) -> int:
        return len(self.groups)

    def __repr__(self) -> str:
        *motions, samples = self.omega.shape[:-2]
        of = f"{motions[0]} trajectories, " if motions else ""
        return f"<Sensitivities with respect to {', '.join(self.variables)}: {of}{samples} samples>"

    def of(self, motion: int) -> "Sensitivities":
        """Return the derivatives of motion number ``motion``, from 0, of an ensemble."""
        omega, quaternion, rotation = (array[motion] for array in (self.omega, self.quaternion, self.rotation))
        return replace(self, omega=omega, quaternion=quaternion, rotation=rotation)

    @property
    def record(self) -> dict[str, Any]:
        """Data for JSON: the variables, and the derivatives of the times of events and switches.

        The variables have names and units, and ``groups`` says which variables belong to each requested name. A file of
        samples contains this record; :func:`restored` reads it.
        """
        record: dict[str, Any] = {
            "variables": list(self.variables),
            "units": list(self.units),
            "groups": dict(self.groups),
        }
        record["t_events"] = [[_numbers(row) for row in rows] for rows in self.t_events]
        record["switchings"] = [
            {"t": each.t, "function": each.function, "how": each.how, "slopes": _numbers(each.slopes)}
            for each in self.switchings
        ]
        return record

    def _labelled(self) -> list[Labelled]:
        """Return the derivatives with labels, for tables.

        There are three quantities for each variable, such as ``omega_by_weight``, ``quaternion_by_weight`` and
        ``rotation_by_weight``; for samples at the times of an event also ``t_by_weight``.
        """
        items = []
        for number, (variable, unit) in enumerate(zip(self.variables, self.units, strict=True)):
            for quantity, (components, own, frame, meaning) in OUTPUTS.items():
                names = tuple(f"{component}{BY}{variable}" for component in components)
                values = getattr(self, quantity)[..., number]
                text = f"derivative of the {meaning} with respect to {variable}"
                items.append(
                    Labelled(f"{quantity}{BY}{variable}", values, names, quotient_unit(own, unit), frame, text)
                )
        return items if self.times is None else [*items, *event_time_items(self.variables, self.units, self.times)]


def event_time_items(variables: Sequence[str], units: Sequence[str], slopes: Floats) -> list[Labelled]:
    """Return the derivatives of k event times with respect to m variables, with labels such as ``t_by_weight``."""
    items = []
    for number, (variable, unit) in enumerate(zip(variables, units, strict=True)):
        name = f"{TIME}{BY}{variable}"
        text = f"derivative of the time of the event with respect to {variable}"
        items.append(Labelled(name, slopes[:, number], (name,), quotient_unit("s", unit), "", text))
    return items


def _numbers(row: Floats) -> list[float | None]:
    """Return a row of derivatives for JSON, which has no NaN: None where a derivative does not exist."""
    return [None if value != value else value for value in row.tolist()]


def quotient_unit(unit: str, other: str) -> str:
    """Return the unit of a derivative, ``unit`` divided by ``other``: ``"(rad/s)/(kg)"``."""
    if other == "1":
        return unit
    # an empty unit of the variable is unknown
    return f"({unit})/({other})" if other else f"({unit}) per unit of the parameter"


def restored(record: Mapping[str, Any], items: Mapping[str, Labelled]) -> Sensitivities | None:
    """Return the derivatives in a file, from its record and its labelled arrays by name; None if one is missing."""
    # written by Sensitivities.record
    variables = [str(variable) for variable in record["variables"]]
    if not all(f"{quantity}{BY}{variable}" in items for quantity in OUTPUTS for variable in variables):
        return None
    omega, quaternion, rotation = (
        np.stack([items[f"{quantity}{BY}{variable}"].values for variable in variables], axis=-1) for quantity in OUTPUTS
    )
    groups = {str(key): tuple(places) for key, places in record["groups"].items()}
    # files of earlier versions have no derivatives of times
    t_events = tuple(time_slopes(rows, len(variables)) for rows in record.get("t_events", ()))
    switchings = tuple(
        SwitchSlopes(float(each["t"]), str(each["function"]), str(each["how"]), time_slopes([each["slopes"]], None)[0])
        for each in record.get("switchings", ())
    )
    of_times = [items[f"{TIME}{BY}{variable}"].values for variable in variables if f"{TIME}{BY}{variable}" in items]
    times = np.stack(of_times, axis=-1) if of_times else None
    return Sensitivities(
        tuple(variables), tuple(record["units"]), groups, omega, quaternion, rotation, t_events, switchings, times
    )


def time_slopes(rows: Sequence[Sequence[float | None]], variables: int | None) -> Floats:
    """Return the derivatives of k times with respect to m variables as an array, shape (k, m), from ``rows`` in a file.

    None in the file is NaN in the result. ``variables`` is m; if it is None, k must be at least 1.
    """
    table = np.array([[np.nan if value is None else value for value in row] for row in rows], dtype=np.float64)
    return table if variables is None else table.reshape(len(rows), variables)
