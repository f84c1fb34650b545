"""Trajectories: the states of a motion at the sample times, and quantities that are computed from them on first use."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from pickle import PicklingError
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

import symrot
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.kinematics import conversions
from symrot.propagation.events.event_result import EventResult
from symrot.propagation.motions.motion import Motion
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers.stats import Stats
from symrot.results.samples import MotionSamples
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

if TYPE_CHECKING:
    from symrot.results.sensitivity import Sensitivities

__all__ = ["Invariant", "Trajectory"]

Floats = NDArray[np.float64]
_RECOMPUTED = (
    "_motion", "_path", "_solution", "_states", "at_events", "dcm", "omega", "omega_space", "quaternion", "rotation",
)  # fmt: skip
"""Attributes that a copy of a trajectory computes again from the states and the propagator."""


class Invariant(NamedTuple):
    """Values of a conserved quantity along a trajectory, and their drift.

    Attributes
    ----------
    name, unit, reason : str
        Name of the quantity, its SI unit, and the reason why it is conserved.
    values : array, shape (n,)
        Values of the quantity at the sample times.
    scale : float
        The number by which the drift is divided: the largest magnitude of the quantity along the trajectory. For a
        component of the angular momentum, it is the largest magnitude of the whole vector; for an energy, at least the
        largest kinetic energy. For the norm of the quaternion, and without samples, the scale is 1.
    drift : float
        Largest change since the start, divided by ``scale`` unless that is 0.

    Examples
    --------
    >>> import symrot
    >>> symrot.propagate("t_handle").invariants[0].unit
    'J'
    """

    name: str
    unit: str
    reason: str
    values: Floats  # shape (n,)
    scale: float
    drift: float


class MotionSource(Protocol):
    """What a trajectory needs from its propagator to compute more about the motion, such as states between samples."""

    # a trajectory that pickle loaded also computes its motion again in this way
    def motion_from(self, initial: Initial) -> Motion:
        """Return the motion of the scene from an initial state."""

    def sensitivities_of(self, scene: Scene, times: Floats) -> "Sensitivities | None":
        """Return the derivatives of a scene's motion at sample times; None if none were requested."""

    def transition(self, scene: Scene, t0: float, t1: float) -> Floats:
        """Return the state transition matrix of a scene's motion from ``t0`` to ``t1``, s, shape (6, 6)."""


class Trajectory(MotionSamples):
    """The motion of a scene at the sample times, returned by a propagator; it can be copied and pickled.

    Conventions: :mod:`symrot.conventions`.

    Attributes
    ----------
    t : array, shape (n,)
        The requested sample times, s; the time of a terminal event replaces all requested times beyond it.
    y : array, shape (N, n)
        The integrated states, in the order of ``states``; same layout as in solve_ivp.
    method, stats : str, Stats
        The method, and the cost of the motion: steps, evaluations, seconds.
    plan : Plan
        The plan of the motion, which says which states are integrated and why the others are not.
    tolerance : float
        Error of the trajectory to aim for.
    has_external_torque : bool
        Whether a torque without a formula acted: a function, or a table of samples.
    status, message, success : int, str, bool
        As in solve_ivp: status is 1 if a terminal event ended the motion, else 0. If a motion cannot be followed, a
        PropagationError is raised; its ``trajectory`` holds the samples before, with status -1 and ``success`` false.
    warnings : tuple of str
        Sentences about what cannot be guaranteed: the accuracy under a torque without a formula, or far from t = 0
        under a torque whose formula contains the time; or an event whose formula comes so close to zero that the error
        of the motion matters. They also contain the warnings of the scene.
    t_events, y_events : list of arrays or None
        For each requested event: its times, s, shape (k,), and the states at these times, shape (k, N).
    events : tuple of Event, or None
        The requested events. :attr:`at_events` has a trajectory of the samples at each of them.
    sensitivities : Sensitivities or None
        The derivatives of the motion with respect to initial values and constants, if they were requested.
    event_kinds : list of lists of str, or None
        For each event and each of its times: ``"rising"``, ``"falling"`` or ``"touching"``.

    Examples
    --------
    >>> import symrot
    >>> trajectory = symrot.propagate("t_handle")
    >>> max(invariant.drift for invariant in trajectory.invariants) < 1e-12
    True
    """

    def __init__(
        self,
        motion: Motion,
        t: Floats,
        states: Floats | tuple[Floats, ...],
        method: str,
        stats: Stats,
        message: str,
        events: EventResult | None = None,
        propagator: "MotionSource | None" = None,
    ) -> None:
        self._motion, self._parts, self._propagator = motion, states, propagator
        self.plan, self.tolerance, self.has_external_torque = motion.plan, motion.tolerance, motion.has_external_torque
        self.t, self.method, self.stats, self.message = t, method, stats, message
        self.status = 0
        own = (*motion.setup.warnings, *map(motion.rounding_warning, stats.rounded_beyond))
        self.warnings = (*motion.plan.scene.warnings, *own)
        self.t_events, self.y_events, self.event_kinds, self.events = None, None, None, None
        self.sensitivities: Sensitivities | None = None
        if events is not None:
            self.status, self.warnings = int(events.ended), (*self.warnings, *events.warnings)
            self.t_events, self.y_events, self.event_kinds = events.t_events, events.y_events, events.kinds
            self.events = events.events

    def __getstate__(self) -> dict[str, Any]:
        """Return the samples and the propagator for pickle; a copy prepares the motion again when needed."""
        if self._propagator is None:
            raise PicklingError("expected a trajectory that a propagator returned, got one made from states alone")
        return {name: value for name, value in self.__dict__.items() if name not in _RECOMPUTED}

    @cached_property
    def _motion(self) -> Motion:
        assert self._propagator is not None
        return self._propagator.motion_from(self.scene.initial)

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        name = self.scene.name
        return f"<Trajectory of {name}: {len(self.t)} samples, {self.method}, {self.stats.accepted} steps>"

    @property
    def success(self) -> bool:
        """Whether the motion was computed to its end; false only for the trajectory that a PropagationError holds."""
        # the end is the last sample time or a terminal event
        return self.status >= 0

    @property
    def scene(self) -> Scene:
        """The scene of the motion, with the initial state of this trajectory."""
        return self.plan.scene

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the integrated states, such as omega_1 and q0, in the order of ``y``."""
        return self.plan.states

    @cached_property
    def _states(self) -> Floats:
        """The states, one row per sample, shape (n, N).

        A motion in closed form has two arrays, angular velocities and quaternions, which are joined on first use.
        """
        return np.concatenate(self._parts, axis=1) if isinstance(self._parts, tuple) else self._parts

    @property
    def y(self) -> Floats:
        """The integrated states at the samples, shape (N, n), one row per state."""
        return self._states.T

    def _evaluate(self, *names: str) -> Floats:
        """Return output quantities of the kernel at the n sample times, shape (n, len(names)).

        ``names`` are the kernel's names of the quantities, such as ``"omega_1 of t"`` for the component omega_1.
        """
        columns = [name.removesuffix(" of t") for name in names]
        if set(columns) <= set(self.states):
            return self._states[:, [self.states.index(name) for name in columns]]
        return self._motion.evaluate(self.t, self._states, names)

    @property
    def has_attitude(self) -> bool:
        """Whether the attitude was computed; it is not if neither a torque nor the output of the scene needs it."""
        return self.plan.structure.attitude

    def _need_attitude(self) -> None:
        if not self.has_attitude:
            raise InputError(
                "the attitude was not computed, since neither a torque nor the output of the scene needs it: "
                'add "quaternion" to output.quantities'
            )

    @cached_property
    def omega(self) -> Floats:
        """Angular velocity at the samples, body components, rad/s, shape (n, 3)."""
        if isinstance(self._parts, tuple):
            return self._parts[0].copy()
        return self._evaluate("omega_1 of t", "omega_2 of t", "omega_3 of t")

    @cached_property
    def quaternion(self) -> Floats:
        """Attitude at the samples as unit quaternions, scalar first, body to space, shape (n, 4).

        Raise InputError if it was not computed.
        """
        self._need_attitude()
        if isinstance(self._parts, tuple):  # of a closed form: rounded from a unit quaternion
            return self._parts[1].copy()
        return conversions.normalize(self._evaluate(*(f"q{i} of t" for i in range(4))))

    @cached_property
    def invariants(self) -> list[Invariant]:
        """The quantities proven to be conserved, with their values at the samples and their drift."""
        invariants = []
        conserved = [item for item in self._motion.kernel.conserved if item.holds]
        for item in conserved:
            values = self._evaluate(item.output)[:, 0]
            invariants.append(
                self._invariant(item.name, item.unit, item.reason, values, self._scale(item.name, values))
            )
        if "q0" in self.states:
            first = self.states.index("q0")
            # the last item, if the quaternion is integrated
            norm = np.sqrt(np.einsum("ni,ni->n", self._states[:, first:], self._states[:, first:]))
            invariants.append(self._invariant("quaternion norm", "1", "rotations keep lengths", norm, 1.0))
        return invariants

    def _invariant(self, name: str, unit: str, reason: str, values: Floats, scale: float) -> Invariant:
        start = self._motion.initial_quantity(name)
        change = float(np.max(np.abs(values - start), initial=0.0))
        return Invariant(name, unit, reason, values, scale, change / scale if scale > 0 else change)

    def _scale(self, name: str, values: Floats) -> float:
        if not len(values):
            return 1.0
        if "momentum" in name:
            return float(np.sqrt(np.max(np.sum(self.angular_momentum_body**2, axis=1))))
        if name.startswith("spin"):
            return float(np.max(np.abs(values)))
        return float(max(np.max(np.abs(values)), np.max(np.abs(self.kinetic_energy))))

    def at(self, t: ArrayLike) -> "Trajectory":
        """Return the trajectory at other times of the span, from the dense solution.

        Parameters
        ----------
        t : float or array, shape (m,)
            Times, s, between the first and the last time of the motion.

        Returns
        -------
        Trajectory
            The m samples, with all quantities. It has no events.

        Raises
        ------
        InputError
            If a time is not finite or lies outside the motion.

        Examples
        --------
        >>> import symrot
        >>> symrot.propagate("t_handle").at(0.5).omega.shape
        (1, 3)
        """
        times = real_array(t, "t", "times in s", ndmin=1)
        if times.ndim != 1 or not np.isfinite(times).all():
            raise InputError(f"t: expected finite times in s, shape (m,), got {number.show(t)}")
        if len(times) and not (self._span[0] <= times.min() and times.max() <= self._span[1]):
            low, high = self._span
            raise InputError(f"t: expected times from {low!r} to {high!r} s, where the motion is known, got {t!r}")
        return self._sampled(times, self._path(times))

    def resample(self, times: ArrayLike | int) -> "Trajectory":
        """Return the trajectory at the given times, or at a number of evenly spaced times of its span, without events.

        Parameters
        ----------
        times : int or array, shape (m,)
            The number of samples, 2 or more, or their times, s, as for :meth:`at`.

        Examples
        --------
        >>> import symrot
        >>> symrot.propagate("t_handle").resample(5).t.tolist()
        [0.0, 3.0, 6.0, 9.0, 12.0]
        """
        if isinstance(times, bool) or not isinstance(times, int | np.integer):
            return self.at(times)
        if times < 2:
            raise InputError(f"times: expected 2 or more as the number of new samples, got {times}")
        if not len(self):
            raise InputError(
                f"times: expected a list of sample times, got the number {times}: a number asks for evenly spaced "
                "samples between the first and the last sample of the trajectory, but it has none"
            )
        return self.at(np.linspace(float(self.t.min()), float(self.t.max()), int(times)))

    @cached_property
    def at_events(self) -> "list[Trajectory]":
        """For each requested event, the trajectory at the times of the event; an empty list if none was requested."""
        pairs = zip(self.t_events or (), self.y_events or (), strict=True)
        samples = [self._sampled(t, states) for t, states in pairs]
        for place, each in enumerate(samples):
            if each.sensitivities is not None and self.sensitivities is not None:
                each.sensitivities = replace(each.sensitivities, times=self.sensitivities.t_events[place])
        return samples

    def _sampled(self, t: Floats, states: Floats) -> "Trajectory":
        other = Trajectory(self._motion, t, states, self.method, self.stats, self.message, propagator=self._propagator)
        other.warnings = self.warnings
        if self.sensitivities is not None and self._propagator is not None:
            other.sensitivities = self._propagator.sensitivities_of(self.scene, t)
        return other

    def transition(self, t0: float, t1: float) -> Floats:
        """Return the state transition matrix from time t0 to t1, shape (6, 6), such as a Kalman filter needs.

        The state: omega_b, rad/s, then a small rotation about the body axes, rad.

        Parameters
        ----------
        t0, t1 : float
            Two times, s; t1 may be before t0.

        Raises
        ------
        InputError
            If the times are not finite, or if a torque acts that was passed to :func:`symrot.propagate` as ``torque``.
        PropagationError
            If the motion cannot be followed to both times, or if it has no derivatives beyond a switch of a torque.

        Examples
        --------
        >>> import symrot
        >>> motion = symrot.propagate("t_handle")
        >>> there, back = motion.transition(1.0, 1.5), motion.transition(1.5, 1.0)
        >>> float(abs(there @ back - np.eye(6)).max()) < 1e-12
        True
        """
        times = [real_array(t, name, "a time in s") for t, name in ((t0, "t0"), (t1, "t1"))]
        if any(time.ndim for time in times) or not np.isfinite(times).all():
            raise InputError(f"t0, t1: expected finite times in s, got {number.show(t0)} and {number.show(t1)}")
        if (self.has_external_torque and self.scene.table is None) or self._propagator is None:
            raise InputError(
                "transition: expected a motion under torques of the scene (formulas or a table), got one with a "
                "function passed as torque="
            )
        # variational Taylor series, for every method, also for closed forms
        return self._propagator.transition(self.scene, float(times[0]), float(times[1]))

    @cached_property
    def _span(self) -> tuple[float, float]:
        ends = float(self.scene.span.start), *self.t.tolist()
        return min(ends), max(ends)

    @cached_property
    def _path(self) -> Callable[[Floats], Floats]:
        return self._motion.path(self.t)

    def sol(self, t: ArrayLike) -> Floats:
        """Return omega and quaternion at m times, shape (7, m), as solve_ivp's ``sol`` does.

        Without attitude the shape is (3, m).
        """
        # the first call integrates the motion again and records its steps
        return self._solution(t)

    @cached_property
    def _solution(self) -> Callable[[ArrayLike], Floats]:
        return self._motion.solution(self._path, self.has_attitude)

    def plot(self, ax: Any = None, panel: str = "rates") -> Any:
        """Draw one panel of the figure into axes of matplotlib, and return the axes; see :func:`symrot.plot`.

        ``panel`` is ``"rates"``, ``"attitude"``, ``"vertical"``, ``"drift"``, ``"space"`` or ``"body"``.
        """
        return symrot.plot(self, ax, panel)

    def save(self, path: str | Path, quantities: Sequence[str] | None = None) -> list[str]:
        """Write the samples with labels and events to a file; see :func:`symrot.save`.

        ``quantities`` default to omega, the attitude if computed, the scene's output quantities and any derivatives.
        """
        if quantities is None:
            present = ("omega", "quaternion") if self.has_attitude else ("omega",)
            derivatives = [item.name for item in self.sensitivities._labelled()] if self.sensitivities else []
            quantities = tuple(dict.fromkeys((*present, *self.scene.output.quantities, *derivatives)))
        return symrot.save(self, path, quantities)

    def show(self, path: str | Path | None = None) -> Path:
        """Write the motion as one offline page of HTML that plays it, by default NAME.html; see :func:`symrot.show`."""
        return symrot.show(self, path)

    def _repr_html_(self) -> str | None:
        """Return HTML that shows the animated page of the motion in a notebook, inside an iframe."""
        try:
            return symrot.in_notebook(self)
        except InputError:  # no page can play it, such as a motion at a single time: a notebook then shows the text
            return None
