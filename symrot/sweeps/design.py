"""The design of a sweep: which values vary, by which laws, in how many trajectories; and the values of a trajectory.

Each draw of the distributions is used at every point of the grids: trajectory i belongs to draw ``i // g`` and grid
point ``i % g``, where g is the number of grid points.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError, with_hint
from symrot.formula.exact_numbers import show
from symrot.scene.scene import Scene
from symrot.sweeps.laws import Distribution, Grid, Law, read_law
from symrot.sweeps.points import SAMPLINGS, unit_points
from symrot.sweeps.rotations import ROTATION_STREAMS, uniform_rotations
from symrot.sweeps.targets import Content, Target, read_target

__all__ = ["ATTITUDES", "Axis", "Design", "Draws", "read_design"]

Floats = NDArray[np.float64]
ATTITUDES = ("scene", "uniform")
MOST_TRAJECTORIES = 10**12


@dataclass(frozen=True)
class Axis:
    """One value that varies: a number of the scene, and the law of its values, such as a normal distribution."""

    target: Target
    law: Law


@dataclass(frozen=True)
class Draws:
    """The values that vary in a sweep, for some of its trajectories: one row for each trajectory."""

    values: Floats  # (n, axes)
    attitudes: Floats | None  # (n, 4), unit quaternions; None: the attitude of the scene


# A sweep of more trajectories begins with the trajectories of a smaller one, with the sampling random or sobol.
@dataclass(frozen=True)
class Design:
    """What varies in a sweep, with the number of trajectories, the sampling (how values are drawn) and the seed."""

    axes: tuple[Axis, ...]
    attitudes: str
    sampling: str
    count: int
    seed: int

    @cached_property
    def _grid(self) -> tuple[int, ...]:
        return tuple(len(axis.law) for axis in self.axes if isinstance(axis.law, Grid))

    @cached_property
    def grid_points(self) -> int:
        """The number of points in the product of all grids: 6 for grids of 2 and of 3 values; 1 without grids."""
        return prod(self._grid)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the values that vary, in the order of the columns of :class:`Draws`."""
        return tuple(axis.target.name for axis in self.axes)

    def draws(self, start: int, stop: int) -> Draws:
        """Return the varied values of the trajectories ``start`` to ``stop - 1``.

        They depend only on the design and on the index of the trajectory, so that any process can compute any of them.
        """
        index = np.arange(start, stop)
        draw, point = np.divmod(index, self.grid_points)
        drawn = [axis for axis in self.axes if isinstance(axis.law, Distribution)]
        streams = [axis.target.name for axis in drawn] + (list(ROTATION_STREAMS) if self.attitudes == "uniform" else [])
        first, last = (int(draw[0]), int(draw[-1]) + 1) if len(index) else (0, 0)
        units = unit_points(self.sampling, self.seed, streams, self.count // self.grid_points, first, last)
        units = np.ascontiguousarray(units.T)
        places = np.unravel_index(point, self._grid) if self._grid else ()
        columns, k, g = [], 0, 0
        for axis in self.axes:
            if isinstance(axis.law, Distribution):
                columns.append(axis.law.quantile(units[k])[draw - first])
                k += 1
            else:
                columns.append(np.array(axis.law.values)[places[g]])
                g += 1
        values = np.stack(columns, axis=1) if columns else np.empty((len(index), 0))
        attitudes = uniform_rotations(units[-3:].T)[draw - first] if self.attitudes == "uniform" else None
        return Draws(values, attitudes)


def read_design(
    scene: Scene, content: Content | None, vary: Mapping[str, object], attitudes: str = "scene",
    sampling: str = "random", count: object = None, seed: object = 0,
) -> Design:  # fmt: skip
    """Return the design that the arguments of a sweep describe, after checks.

    Parameters
    ----------
    scene, content
        The scene, and the content of its file, or None if it is not known.
    vary : mapping
        For each value that varies, its name and its law, see :func:`symrot.sweeps.laws.read_law`.
    attitudes : str
        ``scene``: all trajectories start with the attitude of the scene, unless a law varies it; ``uniform``: with
        random attitudes, uniformly distributed over all rotations.
    sampling : str
        A name in :data:`symrot.sweeps.points.SAMPLINGS`.
    count : number, optional
        Number of trajectories, a multiple of the number of grid points. It is needed if values are drawn; otherwise it
        is the number of grid points.
    seed : int
        Seed of the random numbers, zero or more.

    Raises
    ------
    InputError
        If a name, a law or a number cannot be used.
    """
    _choice(attitudes, ATTITUDES, "attitudes")
    _choice(sampling, tuple(SAMPLINGS), "sampling")
    axes = tuple(Axis(read_target(name, scene, content), read_law(law, f"vary {name}")) for name, law in vary.items())
    if attitudes == "uniform" and any(axis.target.path[:2] == ("initial", "attitude") for axis in axes):
        raise InputError("attitudes: expected either uniform attitudes or values for initial.attitude, got both")
    if not axes and attitudes == "scene":
        raise InputError("sweep: expected at least one value that varies, such as --vary 'omega_1 ~ normal(0, 0.1)'")
    _require_apart(axes)
    points = prod(len(axis.law) for axis in axes if isinstance(axis.law, Grid))
    random = attitudes == "uniform" or any(isinstance(axis.law, Distribution) for axis in axes)
    if not random and sampling != "random":
        raise InputError(f"sampling: leave it out unless values are drawn from distributions, got {show(sampling)}")
    number, first = _count(count, points, random), _whole(seed, "seed", 0, 2**64 - 1)
    if not random and first:
        raise InputError(f"seed: leave it out unless values are drawn from distributions, got {show(seed)}")
    return Design(axes, attitudes, sampling, number, first)


def _choice(value: object, known: Sequence[str], where: str) -> None:
    if value not in known:
        raise InputError(with_hint(f"{where}: expected one of {', '.join(known)}, got {show(value)}", value, known))


def _require_apart(axes: Sequence[Axis]) -> None:
    """Raise InputError if two varied values may set the same number, as ``omega_1`` and ``initial.omega[0]`` do."""
    initial = [axis.target.path for axis in axes if axis.target.path[:1] == ("initial",)]
    rates = [axis.target.name for axis in axes if axis.target.unit == "rad/s" and axis.target.name.startswith("omega_")]
    if initial and rates:
        raise InputError(
            f"vary: expected angular velocities either by name or by path in the scene file, got both {rates[0]} and "
            "a path that starts with 'initial'"
        )
    paths = any(axis.target.path[:1] in (("body",), ("torque",)) for axis in axes)
    constants = [axis.target.name for axis in axes if not axis.target.path and axis.target.name not in rates]
    if paths and constants:
        raise InputError(
            f"vary: expected constants either by name or by path in the scene file, got both {constants[0]} and a "
            "path that starts with 'body' or 'torque'"
        )


def _count(count: object, points: int, random: bool) -> int:
    if count is None:
        if random:
            raise InputError("count: expected the number of trajectories, since values are drawn from distributions")
        return points
    number = _whole(count, "count", 1, MOST_TRAJECTORIES)
    if not random and number != points:
        raise InputError(f"count: expected {points}, the number of grid points, or no count, got {number}")
    if number % points:
        nearest_count = max(1, round(number / points)) * points
        raise InputError(
            f"count: expected a multiple of {points}, the number of grid points, such as {nearest_count}, got {number}"
        )
    return number


def _whole(value: object, where: str, low: int, high: int) -> int:
    """Return a whole number from ``low`` to ``high`` as an int; it may be a text such as ``"1e6"``.

    Raise InputError for anything else.
    """
    expectation = f"{where}: expected a whole number from {low} to {high:g}, got {show(value)}"
    if isinstance(value, bool) or not isinstance(value, int | float | str | np.integer):
        raise InputError(expectation)
    try:
        number = int(value) if not isinstance(value, str) or value.strip().isdigit() else int(float(value))
        exact = (isinstance(value, str) and value.strip().isdigit()) or number == float(value)
    except (ValueError, OverflowError):
        raise InputError(expectation) from None
    if not exact or not low <= number <= high:
        raise InputError(expectation)
    return number
