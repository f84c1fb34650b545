"""Propagation of a scene from many initial states and with many values of its constants, all at once."""

from collections.abc import Mapping
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.ensemble.motions import Followed, Problem, follow
from symrot.ensemble.variation import read_times, read_variation
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.propagation.propagator import Propagator
from symrot.propagation.steppers.stepping import Floats
from symrot.scene.scene import TOLERANCES, Scene, load_scene

__all__ = ["Ensemble", "EnsembleStats", "propagate_ensemble"]

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


class Ensemble:
    """The result of :func:`propagate_ensemble`: n motions of one scene. Conventions: :mod:`symrot.conventions`.

    Attributes
    ----------
    t : array, shape (m,) or (n, m)
        Sample times, s, in the order in which they were passed.
    omega : array, shape (n, m, 3)
        Angular velocity, body components, rad/s; NaN at times that a motion did not reach.
    status : array, shape (n,)
        0 for a motion that was followed to its last time, -1 for a motion that stopped early, as in SciPy's solve_ivp.
    messages : n texts
        For each motion that stopped early, the time at which it stopped and the reason; empty for the other motions.
    methods : n texts
        The name of the method by which each motion was computed.
    stats : EnsembleStats
        Steps, evaluations and time.

    Examples
    --------
    >>> import symrot
    >>> symrot.propagate_ensemble("t_handle", omega=[[0, 1, 2]], t=[0, 1]).quaternion.shape
    (1, 2, 4)
    """

    def __init__(self, scene: Scene, t: Floats, followed: Followed, seconds: float) -> None:
        self.scene, self.t, self.omega, self._quaternion = scene, t, followed.omega, followed.quaternion
        self.methods, self.messages = followed.methods, followed.messages
        self.status = np.array([-1 if message else 0 for message in followed.messages], dtype=np.int64)
        self.stats = EnsembleStats(followed.steps, followed.evaluations, seconds)

    def __len__(self) -> int:
        return len(self.omega)

    def __repr__(self) -> str:
        broken = int((self.status != 0).sum())
        ending = f", {broken} stopped early" if broken else ""
        kinds = "/".join(dict.fromkeys(self.methods))
        return f"<Ensemble of {self.scene.name}: {len(self)} trajectories, {self.t.shape[-1]} samples, {kinds}{ending}>"

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
        """Whether every motion reached its last time."""
        return not self.status.any()


def propagate_ensemble(
    scene: Scene | Propagator | str | Path,
    *,
    omega: ArrayLike | None = None,
    quaternion: ArrayLike | None = None,
    parameters: Mapping[str, ArrayLike] | None = None,
    t: ArrayLike | None = None,
    method: str = "auto",
    tolerance: float | None = None,
    workers: int = 1,
) -> Ensemble:
    """Return n motions of a scene that differ in their initial states and in constants of the scene.

    To the last bit, the samples of a motion do not depend on the other motions, their order or the number of threads.
    The method ``auto`` uses a closed form for each motion that has one; the samples then have the same bits as those of
    :func:`symrot.propagate`. For other motions, and where steps were measured to be faster
    (:func:`symrot.ensemble.exact.choose`), ``auto`` uses Taylor series with one trajectory in each SIMD lane. If a
    motion stops before its last time, the other motions are not affected; its ``status`` is -1 and its message says
    why.

    Parameters
    ----------
    scene : Scene, Propagator, str or Path
        A scene, the name of a shipped scene, the path of a scene file, or a propagator, whose tolerance is then used.
    omega : array, shape (n, 3), optional
        Initial angular velocities, body components, rad/s; default: the angular velocity in the scene for all motions.
    quaternion : array, shape (n, 4), optional
        Initial attitudes, scalar first, which are normalised; default: the attitude in the scene for all motions.
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
        ``auto``, or one of :data:`symrot.propagation.method.METHODS` for all motions.
    tolerance : float, optional
        Error of each trajectory to aim for; default: the tolerance of the scene.
    workers : int
        Number of threads that compute motions.

    Returns
    -------
    Ensemble
        Angular velocity in rad/s, body components, shape (n, m, 3); attitude, shape (n, m, 4).

    Raises
    ------
    InputError
        If the scene, an array or a name cannot be used.

    Notes
    -----
    Convention: :mod:`symrot.conventions`.

    Examples
    --------
    >>> import numpy as np
    >>> rates = np.array([[0, 0.01, 1.0], [0, 0.02, 1.0]])
    >>> propagate_ensemble("tumbling_prism", omega=rates, t=[0.0, 10.0]).omega.shape
    (2, 2, 3)
    """
    began = perf_counter()
    source = scene if isinstance(scene, Scene) else scene.scene if isinstance(scene, Propagator) else load_scene(scene)
    own = scene.tolerance if isinstance(scene, Propagator) else float(source.tolerance)
    variation = read_variation(source, omega, quaternion, parameters)
    times = read_times(t, source, len(variation))
    if isinstance(workers, bool) or not isinstance(workers, int) or not 1 <= workers <= MOST_WORKERS:
        raise InputError(f"workers: expected a whole number from 1 to {MOST_WORKERS}, got {number.show(workers)}")
    aim = own if tolerance is None else _tolerance(tolerance)
    problem = Problem(variation, variation.plan(), float(source.span.start), times, aim, workers)
    return Ensemble(source, times, follow(problem, method), perf_counter() - began)


def _tolerance(tolerance: float) -> float:
    low, high = TOLERANCES
    value = number.read(tolerance, "tolerance")
    if not low <= value <= high:
        raise InputError(f"tolerance: expected a number from {float(low):g} to {float(high):g}, got {tolerance}")
    return float(value)
