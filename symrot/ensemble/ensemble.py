"""Ensembles: many motions of one scene with different initial states and constants, computed together."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from operator import index
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple
from warnings import catch_warnings, simplefilter

import numpy as np
from numpy.typing import ArrayLike, NDArray

import symrot
from symrot.ensemble.motions import Followed, Problem, follow
from symrot.ensemble.quantities import Source
from symrot.ensemble.reading import read_times, read_variation
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.propagation.propagator import Propagator
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers.stepping import Floats
from symrot.results.samples import MotionSamples
from symrot.results.sensitivity import Sensitivities
from symrot.scene.scene import Scene, SceneSource, load_scene
from symrot.scene.tables import QUANTITIES, read_tolerance

__all__ = ["Ensemble", "EnsembleMember", "EnsembleStats", "propagate_ensemble"]

UNAVERAGED = ("quaternion", "dcm", "euler")  # attitudes: the mean of their components is no attitude

MOST_WORKERS = 1024


class EnsembleStats(NamedTuple):
    """The cost of the motions of an ensemble.

    Attributes
    ----------
    steps, evaluations : array, shape (n,)
        Numbers of steps and evaluations of each motion. With Taylor series, one evaluation computes all coefficients.
    seconds : float
        Time in which the whole ensemble was computed.

    Examples
    --------
    >>> import symrot
    >>> symrot.propagate_ensemble("t_handle", omega=[[0, 1, 2]], t=[0, 1]).stats.steps.shape
    (1,)
    """

    steps: NDArray[np.int64]
    evaluations: NDArray[np.int64]
    seconds: float


class EnsembleMember(MotionSamples):
    """One motion of an ensemble, ``ensemble[k]``, with the quantities of a trajectory at its sample times.

    Attributes
    ----------
    t : array, shape (m,)
        Sample times, s.
    method, message : str
        The method, and the reason why the motion stopped early, or an empty text.
    warnings : tuple of str
        Warnings about the scene and about the accuracy of this motion.
    tolerance : float
        Tolerance with which the motion was computed.

    Examples
    --------
    >>> import symrot
    >>> ensemble = symrot.propagate_ensemble("t_handle", omega=[[0, 1, 2], [0, 2, 1]], t=[0, 1])
    >>> ensemble[1].energy.shape, ensemble[-1].euler("ZXZ").shape
    ((2,), (2, 3))
    """

    def __init__(self, ensemble: "Ensemble", number: int) -> None:
        self._ensemble, self._number = ensemble, number
        self.t = ensemble.t if ensemble.t.ndim == 1 else ensemble.t[number]
        self.method, self.message = ensemble.methods[number], ensemble.messages[number]
        self.tolerance, self.warnings = ensemble.tolerance, ensemble.warnings[number]

    def __len__(self) -> int:
        return len(self.t)

    def __repr__(self) -> str:
        return f"<Motion {self._number} of {self._ensemble!r}>"

    @property
    def success(self) -> bool:
        """Whether the motion was computed up to its last sample time; if not, :attr:`message` says why."""
        return not self.message

    @property
    def omega(self) -> Floats:
        """Angular velocity, body components, rad/s, shape (m, 3); NaN at times that the motion did not reach."""
        omega: Floats = self._ensemble.omega[self._number]
        return omega

    @property
    def quaternion(self) -> Floats:
        """Attitude as unit quaternions, scalar first, body to space, shape (m, 4)."""
        quaternion: Floats = self._ensemble.quaternion[self._number]
        return quaternion

    @property
    def sensitivities(self) -> Sensitivities | None:
        """The derivatives of this motion with respect to k variables, as arrays (m, ..., k); None if not requested."""
        every = self._ensemble.sensitivities
        return None if every is None else every.of(self._number)

    @cached_property
    def scene(self) -> Scene:
        """The scene of this motion: the ensemble's scene, with this motion's own initial state and constants."""
        return self._ensemble._source.variation.scene_of(self._number)

    def show(self, path: str | Path | None = None) -> Path:
        """Write the motion as one offline page of HTML that plays it, by default NAME.html; see :func:`symrot.show`."""
        return symrot.show(self, path)

    def _evaluate(self, *names: str) -> Floats:
        values: Floats = self._ensemble._evaluated(names, [self._number])[0]
        return values


class Ensemble(MotionSamples):
    """The result of :func:`propagate_ensemble`: n motions of one scene. Conventions: :mod:`symrot.conventions`.

    Quantities such as ``energy`` have the shape (n, m, ...); ``ensemble[k]`` is motion k.

    Attributes
    ----------
    t : array, shape (m,) or (n, m)
        Sample times, s, in the order in which they were passed.
    status : array, shape (n,)
        0 for a motion that was computed up to its last time, -1 for a motion that stopped early, as in SciPy's
        solve_ivp.
    messages : n texts
        For each motion that stopped early, the time at which it stopped and the reason; empty for the other motions.
    methods : n texts
        The name of the method by which each motion was computed.
    warnings : n tuples of str
        For each motion, the warnings that its trajectory would have: about the scene, such as a hole that may reach out
        of the body, and about the accuracy of the motion. Usually empty.
    stats : EnsembleStats
        Steps, evaluations and time.
    tolerance : float
        Tolerance with which the motions were computed.
    sensitivities : Sensitivities or None
        Derivatives of the motions with respect to k initial values and constants, if they were requested. The arrays
        have these variables on their last axis: the derivatives of ``omega`` and ``quaternion`` have the shapes
        (n, m, 3, k) and (n, m, 4, k); those of the rotation vector of the attitude, in the body, have (n, m, 3, k).

    Examples
    --------
    >>> import symrot
    >>> symrot.propagate_ensemble("t_handle", omega=[[0, 1, 2]], t=[0, 1]).quaternion.shape
    (1, 2, 4)
    """

    def __init__(
        self, problem: Problem, followed: Followed, seconds: float, sensitivities: Sensitivities | None = None
    ) -> None:
        self._source = Source(problem.variation, problem.plan)
        self.t, self.tolerance = problem.times, problem.tolerance
        self._omega, self._quaternion = followed.omega, followed.quaternion
        self.methods, self.messages = followed.methods, followed.messages
        self.status = np.array([-1 if message else 0 for message in followed.messages], dtype=np.int64)
        of_scene = self.scene.warnings
        self.warnings = tuple([of_scene + own for own in followed.warnings]) if of_scene else followed.warnings
        self.stats = EnsembleStats(followed.steps, followed.evaluations, seconds)
        self.sensitivities = sensitivities

    def __len__(self) -> int:
        return len(self.omega)

    def __getitem__(self, k: int) -> EnsembleMember:
        """Return motion k, from 0, as an :class:`EnsembleMember`; negative numbers count from the end."""
        return EnsembleMember(self, range(len(self))[index(k)])

    def __iter__(self) -> Iterator[EnsembleMember]:
        return (EnsembleMember(self, k) for k in range(len(self)))

    def __repr__(self) -> str:
        broken = int((self.status != 0).sum())
        ending = f", {broken} stopped early" if broken else ""
        doubtful = sum(1 for own in self.warnings if own)
        ending += f", {doubtful} with warnings" if doubtful else ""
        count = self.t.shape[-1]
        return f"<Ensemble of {self.scene.name}: {len(self)} trajectories, {count} samples, {self.method}{ending}>"

    def _repr_html_(self) -> str:
        return symrot.in_notebook(self)

    @property
    def scene(self) -> Scene:
        """The scene that all motions share, except for initial states and constants that vary."""
        return self._source.variation.scene

    @property
    def omega(self) -> Floats:
        """Angular velocity, body components, rad/s, shape (n, m, 3); NaN at times that a motion did not reach."""
        return self._omega

    @property
    def quaternion(self) -> Floats:
        """Attitude as unit quaternions, scalar first, body to space, shape (n, m, 4)."""
        if self._quaternion is None:
            raise InputError(
                "the attitude was not computed, because neither a torque nor the output of the scene needs it; "
                'add "quaternion" to output.quantities'
            )
        return self._quaternion

    @property
    def success(self) -> bool:
        """Whether every motion was computed up to its last sample time; :attr:`status` tells which were not."""
        return not self.status.any()

    @property
    def method(self) -> str:
        """The names of all methods by which motions were computed, separated by slashes, such as ``"exact/taylor"``."""
        return "/".join(dict.fromkeys(self.methods))

    def _evaluate(self, *names: str) -> Floats:
        return self._evaluated(names, range(len(self)))

    def _evaluated(self, names: Sequence[str], chosen: Sequence[int]) -> Floats:
        rows = slice(None) if chosen == range(len(self)) else list(chosen)  # a slice needs no copies
        t = self.t if self.t.ndim == 1 else self.t[rows]
        quaternion = None if self._quaternion is None else self._quaternion[rows]
        return self._source.evaluate(names, t, self.omega[rows], quaternion, chosen)

    def mean(self, quantity: str, omit_stopped: bool = False) -> Floats:
        """Return the mean of a quantity over all motions at each sample time, shape (m, ...).

        Parameters
        ----------
        quantity : str
            A name that ``output.quantities`` of a scene accepts, such as ``"omega"``. Attitudes are not accepted,
            because the mean of their components is not an attitude.
        omit_stopped : bool
            Whether to skip a motion at times that it did not reach; if False, the mean is NaN at these times.

        Raises
        ------
        InputError
            For an attitude, an unknown quantity, a quantity that needs the attitude if it was not computed, or sample
            times that the motions do not share.

        Examples
        --------
        >>> import symrot
        >>> ensemble = symrot.propagate_ensemble("t_handle", omega=[[0, 1, 2], [0, 3, 2]], t=[0, 1])
        >>> ensemble.mean("omega")[0].tolist()
        [0.0, 2.0, 2.0]
        """
        mean: Floats = self._statistic(quantity, omit_stopped, (np.mean, np.nanmean))
        return mean

    def percentiles(self, quantity: str, q: ArrayLike, omit_stopped: bool = False) -> Floats:
        """Return percentiles of a quantity over all motions at each sample time, shape (len(q), m, ...).

        Parameters
        ----------
        quantity : str
            A name that ``output.quantities`` of a scene accepts, such as ``"omega"``; attitudes are not accepted.
        q : float or array
            Percentages from 0 to 100, such as ``[5, 50, 95]``. For a single number, the result has shape (m, ...).
        omit_stopped : bool
            Whether to skip a motion at times that it did not reach; if False, percentiles are NaN at these times.

        Raises
        ------
        InputError
            If a percentage is not from 0 to 100, and for a quantity or sample times that :meth:`mean` refuses.

        Examples
        --------
        >>> import symrot
        >>> ensemble = symrot.propagate_ensemble("t_handle", omega=[[0, 1, 2], [0, 3, 2]], t=[0, 1])
        >>> ensemble.percentiles("omega", [0, 100])[:, 0, 1].tolist()
        [1.0, 3.0]
        """
        shares = real_array(q, "q", "percentages from 0 to 100")
        if not ((shares >= 0) & (shares <= 100)).all():
            raise InputError(f"q: expected percentages from 0 to 100, got {number.show(q)}")

        def of(percentile: Callable[..., Any]) -> Callable[..., Any]:
            return lambda values, axis: percentile(values, shares, axis=axis)

        percentiles: Floats = self._statistic(quantity, omit_stopped, (of(np.percentile), of(np.nanpercentile)))
        return percentiles

    def _statistic(self, quantity: str, omit_stopped: bool, pair: tuple[Callable[..., Any], Callable[..., Any]]) -> Any:
        """Return a statistic of a quantity over all motions, at each sample time: shape (m, ...).

        ``pair`` holds a function of all values, such as numpy.mean, and one that skips NaN, such as numpy.nanmean.
        """
        if not isinstance(quantity, str) or quantity in UNAVERAGED or quantity not in QUANTITIES:
            names = ", ".join(name for name in QUANTITIES if name not in UNAVERAGED)
            raise InputError(f"quantity: expected one of {names}, got {number.show(quantity)}")
        if self.t.ndim != 1:
            raise InputError(
                "t: expected sample times that all motions share, for statistics, got different times for each motion"
            )
        values = self.quantity(quantity)
        if not omit_stopped:
            return pair[0](values, axis=0)
        with catch_warnings():  # no motion reached a time: the statistic is NaN there
            simplefilter("ignore", RuntimeWarning)
            return pair[1](values, axis=0)


def propagate_ensemble(
    scene: SceneSource | Propagator,
    *,
    omega: ArrayLike | None = None,
    quaternion: ArrayLike | None = None,
    attitude: Any = None,
    parameters: Mapping[str, ArrayLike] | None = None,
    t: ArrayLike | None = None,
    method: str = "auto",
    tolerance: float | None = None,
    workers: int = 1,
    sensitivities: Sequence[str] | None = None,
) -> Ensemble:
    """Return n motions of a scene that differ in their initial states and in constants of the scene.

    Parameters
    ----------
    scene : Scene, Propagator, mapping, str or Path
        A scene, the content of a scene file as a dict, the name of a shipped scene, the path of a scene file, or a
        propagator, whose tolerance is then used.
    omega : array, shape (n, 3), optional
        Initial angular velocities, body components, rad/s; default: the angular velocity in the scene for all motions.
    quaternion : array, shape (n, 4), optional
        Initial attitudes, scalar first, which are normalised; default: the attitude in the scene for all motions. An
        angular velocity that the scene gives by ``omega_space`` keeps its components in space.
    attitude : optional
        Initial attitudes as n rotations of SciPy, or as an array of n matrices ``dcm_sb``, instead of ``quaternion``.
    parameters : dict of arrays, optional
        Values of constants of the scene, in SI units, by name. Moments of inertia: ``principal``, shape (n, 3), for a
        body given along principal axes, or ``I_xx`` to ``I_yz``, shape (n,). Fields of a torque by their names in the
        scene, such as ``weight``, shape (n,), or ``center_of_mass``, shape (n, 3), or one component of a vector, such
        as ``center_of_mass_3``, shape (n,). Parameters of an expression, shape (n,). If two torques have a field of the
        same name, the name of the second torque's field gets a prefix, as in ``torque2_weight``.
    t : array, shape (m,) or (n, m), optional
        Sample times, s, common to all motions, shape (m,), or separate for each motion, shape (n, m); in any order,
        before or after the initial time. Default: the sample times of the scene.
    method : str
        The method for all motions: ``auto``, one of :data:`symrot.propagation.method.METHODS` except ``constant``, or
        ``scipy:NAME`` for a method of SciPy's solve_ivp.
    tolerance : float, optional
        Tolerance for the error of each trajectory; default: the tolerance of the scene.
    workers : int
        Number of threads that compute motions.
    sensitivities : sequence of str, optional
        Initial values and constants with respect to which all motions are differentiated: ``"omega"``, ``"attitude"``,
        and numbers of the scene such as ``"weight"``, as for :func:`symrot.propagate`. The derivatives are in the
        attribute ``sensitivities`` of the ensemble and are computed by Taylor series for every method. If this
        computation stops before the last time for a motion, the motion stops there too.

    Returns
    -------
    Ensemble
        Angular velocity in rad/s, body components, shape (n, m, 3); attitude, shape (n, m, 4).

    Raises
    ------
    InputError
        If the scene, an array or a name cannot be used.
    CompilerError
        If the method needs a compiler and no compiler is installed.
    PropagationError
        If a constant of the equations exceeds the range of doubles. Motions that stop early raise no error.

    Notes
    -----
    Convention: :mod:`symrot.conventions`.
    The bits of a motion's samples do not depend on the other motions, their order or the number of threads.
    A motion that stops before its last time has the ``status`` -1, and its message says why.
    ``auto`` uses the closed form of each motion that has one; the samples then have the same bits as those of
    :func:`symrot.propagate`. For other motions, and where numeric integration is known to be faster
    (:func:`symrot.ensemble.exact.choose`), it uses Taylor series with one trajectory in each SIMD lane. Motions are
    computed one by one if a torque has jumps, kinks or no Taylor series, or if a torque formula has degree 3 or more in
    time and states or may have a short pulse (a large value for so short a time that a long step would miss it). A
    motion that reaches rest under quadratic damping has no Taylor series there and is computed by DOP853.

    Examples
    --------
    >>> import numpy as np
    >>> rates = np.array([[0, 0.01, 1.0], [0, 0.02, 1.0]])
    >>> propagate_ensemble("tumbling_prism", omega=rates, t=[0.0, 10.0]).omega.shape
    (2, 2, 3)
    """
    began = perf_counter()
    source = scene.scene if isinstance(scene, Propagator) else load_scene(scene)
    own = scene.tolerance if isinstance(scene, Propagator) else float(source.tolerance)
    variation = read_variation(source, omega, quaternion, parameters, attitude)
    times = read_times(t, source, len(variation))
    if isinstance(workers, bool) or not isinstance(workers, int) or not 1 <= workers <= MOST_WORKERS:
        raise InputError(f"workers: expected a whole number from 1 to {MOST_WORKERS}, got {number.show(workers)}")
    aim = own if tolerance is None else read_tolerance(tolerance)
    problem = Problem(variation, variation.plan(), float(source.span.start), times, aim, workers)
    derivatives, reasons = None, None
    if sensitivities is not None:
        from symrot.ensemble.sensitivities import follow_sensitivities

        derivatives, reasons = follow_sensitivities(problem, sensitivities)
    followed = follow(problem, method)
    if reasons is not None:
        messages = tuple(own or reason for own, reason in zip(followed.messages, reasons, strict=True))
        followed = followed._replace(messages=messages)
    return Ensemble(problem, followed, perf_counter() - began, derivatives)
