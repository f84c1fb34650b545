"""Labelled quantities as a data frame of pandas or a data set of xarray, with units, frames and meanings.

``symrot[frames]`` installs both packages.
"""

from collections.abc import Sequence
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np

from symrot.errors import InputError
from symrot.results.labels import About, Labelled

__all__ = ["BY", "dataframe", "dataset"]

MOTION, TIME = "trajectory", "time"
BY = "_by_"  # between the names of a quantity and of the variable of its derivative
BODY, SPACE = ("body_axis", [1, 2, 3]), ("space_axis", ["x", "y", "z"])
AXES: dict[str, tuple[tuple[str, Sequence[Any]], ...]] = {
    "quaternion": (("component", ["q0", "q1", "q2", "q3"]),),
    "euler": (("angle", [1, 2, 3]),),
    "dcm": (SPACE, BODY),
}
"""Axes of quantities that are not vectors: dimension and labels; the axis of a vector follows from its frame."""


def _package(name: str, method: str) -> ModuleType:
    try:
        return import_module(name)
    except ImportError:
        raise InputError(
            f"{method}: expected {name}, but it is not installed; install it with pip install 'symrot[frames]'"
        ) from None


def _axes(item: Labelled) -> tuple[tuple[str, Sequence[Any]], ...]:
    if len(item.components) == 1:
        return ()
    return AXES.get(item.name.partition(BY)[0]) or ((BODY if item.frame == "body" else SPACE),)


def dataframe(items: Sequence[Labelled], origin: About) -> Any:
    """Return a pandas DataFrame with one row for each sample and one column for each component.

    ``items[0]`` is the time, which becomes the index; ``origin`` becomes attributes of the table.

    Raises
    ------
    InputError
        If pandas is not installed.
    """
    pandas = _package("pandas", "to_dataframe")
    columns: dict[str, Any] = {}
    t = items[0].values
    lead = _lead(items)
    for item in items[1:]:
        table = item.values.reshape(-1, len(item.components))
        columns |= {name: table[:, k] for k, name in enumerate(item.components)}
    times = np.broadcast_to(t, lead).ravel()
    if len(lead) == 1:
        # of one motion: the time t, s
        index = pandas.Index(times, name="t")
    else:
        # of n motions: (trajectory, t)
        index = pandas.MultiIndex.from_arrays([np.repeat(np.arange(lead[0]), lead[1]), times], names=[MOTION, "t"])
    frame = pandas.DataFrame(columns, index=index)
    by_column = [(name, item) for item in items for name in item.components]
    # dicts by column, and the names of scene and method
    frame.attrs |= origin._asdict() | {
        "units": {name: item.unit for name, item in by_column},
        "frames": {name: item.frame for name, item in by_column},
        "meanings": {name: item.meaning for name, item in by_column},
    }
    return frame


def _lead(items: Sequence[Labelled]) -> tuple[int, ...]:
    """Return the shape of the samples without components: (m,) for m samples of one motion, (n, m) for n motions."""
    if len(items) < 2:
        return items[0].values.shape
    item = items[1]
    shape: tuple[int, ...] = item.values.shape
    return shape[: len(shape) - len(_axes(item))]


def dataset(items: Sequence[Labelled], origin: About) -> Any:
    """Return an xarray Dataset with one variable for each quantity.

    ``items[0]`` is the time, which becomes a coordinate; ``origin`` becomes attributes of the data set.

    Raises
    ------
    InputError
        If xarray is not installed.
    """
    xarray = _package("xarray", "to_xarray")
    lead = (MOTION, TIME) if len(_lead(items)) == 2 else (TIME,)
    time = items[0]
    attributes = {"units": time.unit, "long_name": time.meaning}
    coordinates: dict[str, Any] = {TIME: (TIME, time.values, attributes)}
    if time.values.ndim == 2:  # each motion has its own times
        coordinates = {"t": (lead, time.values, attributes)}
    variables = {}
    for item in items[1:]:
        axes = _axes(item)
        # the axes of a quantity: body_axis (1, 2, 3), space_axis (x, y, z), component of a quaternion, angle of an
        # Euler sequence
        coordinates |= dict(axes)
        attributes = {"units": item.unit, "long_name": item.meaning, "frame": item.frame}
        variables[item.name] = ((*lead, *(name for name, _ in axes)), item.values, attributes)
    return xarray.Dataset(variables, coordinates, dict(origin._asdict()))
