"""The propagator of a scene: it chooses a method and prepares the kernel once, then computes any number of motions."""

from collections.abc import Hashable, Mapping, Sequence
from copy import copy
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from math import isfinite, isqrt
from time import perf_counter
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

import symrot
from symrot.errors import InputError, PropagationError
from symrot.formula import exact_numbers as number
from symrot.inertia.tensor import rotation_of
from symrot.planning.plan import Plan, make_plan, structure_key
from symrot.planning.scene_kernel import SceneKernel
from symrot.propagation.method import choose_method
from symrot.propagation.motions.make import make_motion
from symrot.propagation.motions.methods import ClosedFormMotion
from symrot.propagation.motions.motion import Motion, RestartableMotion
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers.integration_stopped import Samples
from symrot.propagation.steppers.stepping import is_sorted
from symrot.propagation.trajectory import Trajectory
from symrot.scene.attitude import Attitude, read_attitude, refuse_two
from symrot.scene.content import plain
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial, with_other_attitude

if TYPE_CHECKING:
    from symrot.results.sensitivity import Sensitivities

__all__ = ["Propagator", "read_start"]

SMALLEST = float(number.SMALLEST)
_UNIT_BITS = number.BITS + 2
_PREPARED = ("_motion", "_by_structure", "sample_times")  # attributes that follow from the others

Floats = NDArray[np.float64]


class Propagator:
    """Function from sample times to the motion of one scene; :func:`symrot.propagator` returns it.

    Its equations are derived and compiled once. It can be copied and pickled.

    Attributes
    ----------
    scene : Scene
        The scene whose motion is computed.
    tolerance : float
        Error of the trajectory to aim for.
    sensitivities : sequence of str, or None
        The initial values and constants with respect to which the motion is differentiated.

    Examples
    --------
    >>> import symrot
    >>> propagator = symrot.propagator("t_handle")
    >>> propagator([0.0, 0.5], omega=[0.0, 2.0, 0.1]).omega[0].tolist()
    [0.0, 2.0, 0.1]
    """

    sensitivities: Sequence[str] | None = None

    def __init__(self, scene: Scene, method: str, tolerance: float, sensitivities: Sequence[str] | None = None) -> None:
        self.scene, self.tolerance, self._method = scene, tolerance, method
        if sensitivities is not None:
            self.sensitivities = _variables(scene, sensitivities)
        self._motion  # noqa: B018

    def __repr__(self) -> str:
        return f"<Propagator of {self.scene.name}: method {self._method}, tolerance {self.tolerance:g}>"

    def _repr_html_(self) -> str:
        return symrot.in_notebook(self)

    def __getstate__(self) -> dict[str, Any]:
        """Return the scene and the options for pickle; a copy prepares its motion from them when it is first used."""
        # a copy loads its compiled equations from the cache
        return {name: value for name, value in self.__dict__.items() if name not in _PREPARED}

    @cached_property
    def _motion(self) -> Motion:
        return self._prepare(self._planned())

    @cached_property
    def _by_structure(self) -> dict[Hashable, Motion]:
        """Key of an initial state (:func:`symrot.planning.plan.structure_key`) -> the first motion with this key.

        States with equal keys have equations of the same form, so that later motions copy the first one.
        """
        return {structure_key(self.scene, self.scene.initial): self._motion}

    def _planned(self, initial: Initial | None = None) -> Plan:
        return make_plan(self.scene, initial)

    def _prepare(self, plan: Plan) -> Motion:
        return make_motion(plan, choose_method(plan, self._method), self.tolerance)

    def motion_from(self, initial: Initial) -> Motion:
        """Return the motion from another initial state."""
        if initial is self.scene.initial:
            return self._motion
        if not isinstance(self._motion, RestartableMotion):
            return self._prepare(self._planned(initial))
        key = structure_key(self.scene, initial)
        first = self._by_structure.get(key)
        if isinstance(first, RestartableMotion):
            # the equations have the same form: only numbers change
            return first.from_start(initial)
        motion = self._by_structure[key] = self._prepare(self._planned(initial))
        return motion

    @property
    def plan(self) -> Plan:
        """The plan of the scene: which states and quantities are computed, and which are skipped."""
        return self._motion.plan

    @property
    def method(self) -> str:
        """The name of the method that computes the motion, such as ``"taylor"``."""
        return self._motion.choice.method

    @property
    def reason(self) -> str:
        """The reason why the method was chosen."""
        return self._motion.choice.reason

    @property
    def kernel(self) -> SceneKernel:
        """The kernel of the scene, which computes the rates of the states and the output quantities."""
        return self._motion.kernel

    def prepare(self) -> None:
        """Prepare the first call: derive the kernel, and compute the closed form if the motion has one."""
        self._motion.kernel  # noqa: B018
        if isinstance(self._motion, ClosedFormMotion):
            self._motion.exact  # noqa: B018

    @cached_property
    def sample_times(self) -> Floats:
        """The sample times that the scene specifies, s."""
        span = self.scene.span
        return np.linspace(float(span.start), float(span.stop), span.samples)

    def __call__(
        self,
        t: ArrayLike | None = None,
        *,
        omega: ArrayLike | None = None,
        quaternion: ArrayLike | None = None,
        attitude: Any = None,
        parameters: Mapping[str, Any] | None = None,
        events: Any = None,
    ) -> Trajectory:
        """Return the motion at the times ``t``.

        Parameters
        ----------
        t : array, shape (n,), optional
            Sample times in s, in any order, before or after the initial time; default: the sample times of the scene.
        omega : array, shape (3,), optional
            Initial angular velocity, body components, rad/s; default: the value in the scene.
        quaternion : array, shape (4,), optional
            Initial attitude, scalar first; it is normalised. Default: the value in the scene. An angular velocity that
            the scene gives by ``omega_space`` keeps its components in space.
        attitude : optional
            Initial attitude in any form of :meth:`symrot.Scene.with_`, instead of ``quaternion``: a rotation of SciPy,
            a matrix ``dcm_sb``, a pair such as ``("ZXZ", [0.1, 0.2, 0.3])``.
        parameters : mapping, optional
            Other values of constants, by the names of :meth:`symrot.Scene.with_`, such as ``{"weight": 2}``. Use
            :func:`symrot.propagate_ensemble` for many values at once.
        events : sequence, optional
            Formulas whose zeros are located, each as text, as a :class:`symrot.Event`, or as
            a mapping with the fields of an Event. The times are ``t_events`` of the trajectory; at a terminal event the
            trajectory ends.

        Raises
        ------
        InputError
            If times or states are not finite or have a wrong shape.
        PropagationError
            If the motion cannot be followed to the last time; ``trajectory`` of the error holds the samples before.
        """
        if parameters is not None:
            return self._of(self.scene.with_(parameters))(
                t, omega=omega, quaternion=quaternion, attitude=attitude, events=events
            )
        times = self.sample_times if t is None else _times(t)
        in_order = _in_order(times)
        motion = self._motion
        if omega is not None or quaternion is not None or attitude is not None:
            motion = self.motion_from(read_start(self.scene, omega, quaternion, attitude))
        setup, began = motion.setup, perf_counter()
        try:
            if events is not None:
                return self._with_events(motion, times, events)
            states, stats = motion.follow(times, in_order)
        except (PropagationError, KeyboardInterrupt) as error:
            raise self._with_samples(error, motion, times, began) from None
        trajectory = Trajectory(motion, times, states, setup.choice.method, stats, setup.message, propagator=self)
        trajectory.sensitivities = self.sensitivities_of(trajectory.scene, times)
        return trajectory

    def sensitivities_of(self, scene: Scene, times: Floats) -> "Sensitivities | None":
        """Return the derivatives of the motion of ``scene`` at times, s; None if the propagator computes none."""
        if self.sensitivities is None:
            return None
        from symrot.propagation.sensitivities.derivatives import variation

        return variation(scene, self.sensitivities, times)

    def transition(self, scene: Scene, t0: float, t1: float) -> Floats:
        """Return the derivatives of the state at ``t1``, s, with respect to the state at ``t0``, s, shape (6, 6).

        The state is omega, rad/s, then a small rotation about the body axes, rad.
        """
        from symrot.propagation.sensitivities.derivatives import transition_matrix

        return transition_matrix(scene, t0, t1)

    def _of(self, scene: Scene) -> Self:
        """Return a propagator of another scene with the same options; it is prepared on first use."""
        other = copy(self)
        other.scene = scene
        return other

    def _with_events(self, motion: Motion, times: Floats, events: Any) -> Trajectory:
        from symrot.propagation.events.event import read_events
        from symrot.propagation.events.event_result import integrate_with_events

        requested = read_events(events)
        if self.sensitivities is not None:
            from symrot.propagation.sensitivities.event_times import require_smooth_events

            require_smooth_events(requested)
        result = integrate_with_events(motion, times, requested)
        message = motion.setup.message if result.error is None else str(result.error)
        trajectory = Trajectory(
            motion, result.t, result.states, motion.choice.method, result.stats, message, result, propagator=self
        )
        if result.error is not None:
            result.error.trajectory = trajectory  # type: ignore[attr-defined]
            raise result.error
        derivatives = self.sensitivities_of(trajectory.scene, result.t)
        if derivatives is not None and self.sensitivities is not None:
            from symrot.propagation.sensitivities.derivatives import event_slopes

            slopes = event_slopes(trajectory.scene, self.sensitivities, result, self.tolerance)
            trajectory.sensitivities = replace(derivatives, t_events=slopes)
        return trajectory

    def _with_samples(self, error: BaseException, motion: Motion, times: Floats, began: float) -> BaseException:
        """Return the exception to raise for ``error``, which ended a motion early, with a partial ``trajectory``.

        The trajectory holds the samples that were reached; without samples the exception has none. A PropagationError
        is replaced by one whose message begins with the name of the scene. ``began``: when the computation began, s.
        """
        samples: Samples | None = getattr(error, "samples", None)
        part: Trajectory | None = getattr(error, "trajectory", None)
        ended: BaseException = error
        if isinstance(error, PropagationError):
            # the message begins with the name of the scene
            ended = PropagationError(f"{self.scene.name}: {error}")
        if samples is not None:
            numbers = np.argsort(samples.numbers)  # in the order of the requested times
            states, stats = samples.states[numbers], samples.stats._replace(seconds=perf_counter() - began)
            reached = times[samples.numbers[numbers]]
            part = Trajectory(motion, reached, states, motion.choice.method, stats, "", propagator=self)
        if part is not None:
            part.message, part.status = str(ended) or "interrupted", -1
            ended.trajectory = part  # type: ignore[attr-defined]
        return ended


def _variables(scene: Scene, names: Sequence[str]) -> Sequence[str]:
    """Return ``names``, the variables of the derivatives; raise InputError if one is no initial value or constant."""
    from symrot.propagation.sensitivities.variables import read_variables

    read_variables(scene, names)
    return names


def _times(t: ArrayLike) -> Floats:
    times = real_array(t, "t", "an array of times in s", ndmin=1)
    if times.ndim != 1:
        raise InputError(f"t: expected a one-dimensional array of times in s, got shape {times.shape}")
    return times


def _in_order(times: Floats) -> bool:
    """Return whether the times never decrease; raise InputError if a time is not finite."""
    if not len(times):
        return True
    if isfinite(times.item(0)) and isfinite(times.item(-1)) and is_sorted(times):
        return True
    if not np.isfinite(times).all():
        raise InputError(f"t: expected finite times in s, got {times[~np.isfinite(times)][0]}")
    return False


def _vector(values: ArrayLike, size: int, name: str, unit: str) -> list[float]:
    array = real_array(values, name, f"{size} numbers in {unit}")
    numbers: list[float] = array.tolist()
    if array.shape != (size,) or not all(map(isfinite, numbers)):
        raise InputError(f"{name}: expected {size} finite numbers in {unit}, got {number.show(numbers)}")
    return numbers


def _exact(value: float, name: str) -> Fraction:
    """Return a finite double as a Fraction; raise InputError, which names the argument ``name``, if it is subnormal."""
    return _lowest(*value.as_integer_ratio()) if abs(value) >= SMALLEST or not value else number.read(value, name)


def _lowest(top: int, bottom: int) -> Fraction:
    """Return the Fraction top/bottom of two coprime integers, faster than Fraction(), which divides by their gcd."""
    fraction: Any = object.__new__(Fraction)
    fraction._numerator, fraction._denominator = top, bottom  # as Fraction._from_coprime_ints of Python 3.12 does
    return fraction  # type: ignore[no-any-return]


def _unit(q: list[float]) -> tuple[Fraction, ...]:
    """Return a quaternion of doubles divided by its norm, as fractions with an error below 2^-320."""
    # the same as exact_numbers.unit in half the time, since all denominators are powers of two
    ratios = [x.as_integer_ratio() for x in q]
    shared = max([bottom for _, bottom in ratios])  # all are powers of two
    tops = [top * (shared // bottom) for top, bottom in ratios]
    square = sum([x * x for x in tops])
    norm = isqrt(square)
    if norm * norm == square:
        return number.unit(q)
    shift = max(0, _UNIT_BITS - square.bit_length() // 2)
    # the norm is irrational here, and is approximated
    norm, components = isqrt(square << 2 * shift), []
    length = _UNIT_BITS + norm.bit_length()
    for x in tops:
        bits = length - x.bit_length()
        if bits > shift and x:
            # made odd, so that the fraction is in lowest terms; the last of some 322 bits is arbitrary
            components.append(_lowest((x << bits) // norm | 1, 1 << bits - shift))
        else:
            components.append(Fraction((x << bits) // norm >> bits - shift if x else 0))
    return tuple(components)


def read_start(scene: Scene, omega: ArrayLike | None, quaternion: ArrayLike | None, attitude: Any = None) -> Initial:
    """Return the initial state for a call of a propagator, in exact numbers; None means the value in the scene."""
    initial = scene.initial
    # quaternion and attitude are two forms of one argument
    refuse_two(attitude, quaternion)
    if attitude is not None:
        initial = with_other_attitude(initial, read_attitude(plain(attitude, "attitude"), "attitude"))
    if quaternion is not None:
        q = _vector(quaternion, 4, "quaternion", "1")
        for value in q:
            if abs(value) < SMALLEST:
                _exact(value, "quaternion")
        if not any(q):
            raise InputError(f"quaternion: expected a quaternion that is not zero, got {number.show(q)}")
        q0, q1, q2, q3 = _unit(q)
        w, x, y, z = map(Fraction, q)
        initial = with_other_attitude(initial, Attitude((q0, q1, q2, q3), rotation_of((w, x, y, z))))
    if omega is not None:
        x, y, z = (_exact(value, "omega") for value in _vector(omega, 3, "omega", "rad/s"))
        initial = initial._replace(omega_b=(x, y, z))
    return initial
