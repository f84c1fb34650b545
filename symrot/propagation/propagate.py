"""The functions propagator() and propagate(), which check the options and choose the class of propagator."""

from collections.abc import Mapping, Sequence
from math import inf
from typing import Any

from numpy.typing import ArrayLike

from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.planning.general_structure import switched
from symrot.propagation.propagator import Propagator
from symrot.propagation.real_array import real_array
from symrot.propagation.trajectory import Trajectory
from symrot.scene.attitude import refuse_two
from symrot.scene.scene import Scene, SceneSource, load_scene
from symrot.scene.tables import read_tolerance

__all__ = ["propagate", "propagator"]


def propagator(
    scene: SceneSource,
    method: str = "auto",
    tolerance: float | None = None,
    *,
    omega: ArrayLike | None = None,
    quaternion: ArrayLike | None = None,
    attitude: Any = None,
    parameters: Mapping[str, Any] | None = None,
    torque: Any = None,
    switching_times: ArrayLike = (),
    torque_frame: str = "body",
    state: str = "quaternion",
    switching: bool = True,
    max_step: float = inf,
    sensitivities: Sequence[str] | None = None,
) -> Propagator:
    """Return the propagator of a scene: a function from times to the motion.

    Its equations are derived and compiled, or loaded from the cache.

    Parameters
    ----------
    scene : Scene, mapping, str or Path
        A scene, the content of a scene file as a dict, the name of a shipped scene, or the path of a scene file.
    method : str
        One of :data:`symrot.propagation.method.METHODS` except ``constant``, or a method of SciPy such as
        ``"scipy:LSODA"``.
    tolerance : float, optional
        Error of the trajectory to aim for, in rad for the attitude and relative to its size for the angular velocity;
        default: the tolerance of the scene.
    omega : array, shape (3,), optional
        Initial angular velocity, body components, rad/s; default: the value in the scene.
    quaternion : array, shape (4,), optional
        Initial attitude, scalar first; it is normalised. Default: the value in the scene. An angular velocity that the
        scene gives by ``omega_space`` keeps its components in space.
    attitude : optional
        Initial attitude in any form of :meth:`symrot.Scene.with_`, instead of ``quaternion``: a rotation of SciPy, a
        matrix ``dcm_sb``, a pair such as ``("ZXZ", [0.1, 0.2, 0.3])``.
    parameters : mapping, optional
        Other values of constants, by the names of :meth:`symrot.Scene.with_`, such as ``{"weight": 2}``.
    torque : optional
        An additional torque, N m, without a formula: a function of (t, omega, quaternion) that returns three numbers;
        a C function of ctypes, ``int (double t, const double omega[3], const double quaternion[4], double torque[3],
        void *user)``, which writes the components that are not zero, returns 0 and is called with a null pointer as
        ``user``; or a table (times, samples of shape (n, 3)), which is interpolated by cubic splines between the
        switching times. The method is then ``dop853``.
    switching_times : array, optional
        Times, s, at which the additional torque jumps: a step ends exactly there, and the integration restarts. A
        function is called just before and just after each of these times; a table has two samples there, before and
        after the jump.
    torque_frame : str
        ``"body"`` or ``"space"``: the frame of the components of ``torque``; not allowed without it.
    state : str
        ``"quaternion"``, or an Euler sequence such as ``"ZXZ"`` to step its angles instead, for teaching; see
        :mod:`symrot.propagation.euler_state`.
    switching : bool
        Whether Euler angles change to another, regular sequence before they reach gimbal lock; ``stats`` counts the
        changes.
    max_step : float
        Longest step, s, under an additional torque that is a function; choose it shorter than the shortest pulse of the
        torque. Formulas need no such limit; for a table it follows from the samples.
    sensitivities : sequence of str, optional
        Initial values and constants with respect to which the motion is differentiated: ``"omega"`` (three components),
        ``"attitude"`` (a small rotation about each body axis), or names of :meth:`symrot.Scene.with_` such as
        ``"weight"``. The derivatives are in the attribute ``sensitivities`` of a trajectory. For every method, also for
        closed forms, Taylor series of the variational equations compute them.

    Returns
    -------
    Propagator
        Call it with times, s, as often as needed.

    Raises
    ------
    InputError
        If the scene or an option cannot be used.
    CompilerError
        If the method needs a compiler and no compiler is installed, or if the compiler rejects the kernel.

    Notes
    -----
    Convention: :mod:`symrot.conventions`. Source: ``docs/step_control.md`` says how errors are controlled.

    Examples
    --------
    >>> import symrot
    >>> propagator = symrot.propagator("t_handle")
    >>> propagator([0.0, 1.0, 2.0]).omega.shape
    (3, 3)
    """
    scene = _with_values(load_scene(scene), omega, quaternion, attitude, parameters)
    aim = float(scene.tolerance) if tolerance is None else read_tolerance(tolerance)
    if scene.table is not None and torque is not None:
        raise InputError(f"torque: leave it out for a scene with a torque of kind table, got {number.show(torque)}")
    if torque is None and real_array(switching_times, "switching_times", "finite times in s").size:
        reason = "leave it out unless torque is a function or a table"
        raise InputError(f"switching_times: {reason}, got {number.show(switching_times)}")
    if torque is None and torque_frame != "body":
        where = "a table of the scene has a frame of its own" if scene.table is not None else "no torque is given"
        raise InputError(
            f"torque_frame: leave it out unless torque is a function or a table, got {number.show(torque_frame)} "
            f"({where})"
        )
    if state == "quaternion" and switching is not True:
        raise InputError(
            "switching: leave it out unless state is an Euler sequence, such as 'ZXZ', which can reach gimbal lock, "
            f"got {number.show(switching)}"
        )
    if scene.table is not None:
        samples = scene.table
        torque, switching_times, torque_frame = samples[:2], samples.switching_times, samples.frame
    if sensitivities is not None:
        _refuse_sensitivities(scene, torque, state)
    if state != "quaternion":
        if torque is not None:
            raise InputError(f"state: expected 'quaternion' for a torque without a formula, got {state!r}")
        if switched(scene):
            raise InputError(f"state: expected 'quaternion' for torques with a jump or a kink, got {state!r}")
        from symrot.propagation.euler_state import EulerPropagator

        return EulerPropagator(scene, method, aim, state, switching)
    if torque is None:
        if max_step != inf:
            raise InputError(
                f"max_step: leave it out unless a torque without a formula acts, got {number.show(max_step)}"
            )
        if switched(scene):
            from symrot.propagation.switched.propagator import SwitchedPropagator

            return SwitchedPropagator(scene, method, aim, sensitivities)
        return Propagator(scene, method, aim, sensitivities)
    if method not in ("auto", "dop853"):
        raise InputError(f"method: expected 'auto' or 'dop853' for a torque without a formula, got {method!r}")
    if switched(scene):
        raise InputError(
            "torque: expected no additional torque, since a formula of the scene jumps or bends (abs, sign, ..), "
            f"got {number.show(torque)}"
        )
    from symrot.propagation.external_torque import ExternallyDrivenPropagator

    longest = _longest_step(max_step)
    return ExternallyDrivenPropagator(scene, aim, torque, switching_times, torque_frame, longest, sensitivities)


def _refuse_sensitivities(scene: Scene, torque: Any, state: str) -> None:
    """Raise InputError for motions without derivatives: Euler angles as state, or the argument ``torque``."""
    if state != "quaternion":
        raise InputError(f"sensitivities: expected state='quaternion', got {state!r}; Euler angles have none")
    if torque is not None and scene.table is None:
        raise InputError(
            "sensitivities: expected torques of the scene (formulas or a table of samples), got a function passed as "
            "torque="
        )


def _with_values(
    scene: Scene,
    omega: ArrayLike | None,
    quaternion: ArrayLike | None,
    attitude: Any,
    parameters: Mapping[str, Any] | None,
) -> Scene:
    """Return the scene with another initial state and other constants; None means the value in the scene.

    The arguments are those of :func:`propagator`.
    """
    refuse_two(attitude, quaternion)
    start = {"omega": omega, "attitude": attitude if quaternion is None else {"quaternion": quaternion}}
    changes = {key: value for key, value in start.items() if value is not None}
    return scene if parameters is None and not changes else scene.with_(parameters, **changes)


def _longest_step(max_step: float) -> float:
    longest = real_array(max_step, "max_step", "a positive number of seconds")
    if longest.shape or not longest > 0.0:
        raise InputError(f"max_step: expected a positive number of seconds, got {number.show(max_step)}")
    return float(longest)


def propagate(
    scene: SceneSource,
    method: str = "auto",
    tolerance: float | None = None,
    events: Any = None,
    *,
    t: ArrayLike | None = None,
    omega: ArrayLike | None = None,
    quaternion: ArrayLike | None = None,
    attitude: Any = None,
    parameters: Mapping[str, Any] | None = None,
    torque: Any = None,
    switching_times: ArrayLike = (),
    torque_frame: str = "body",
    state: str = "quaternion",
    switching: bool = True,
    max_step: float = inf,
    sensitivities: Sequence[str] | None = None,
) -> Trajectory:
    """Return the motion of a scene.

    Parameters
    ----------
    scene, method, tolerance
        As for :func:`propagator`.
    events : sequence, optional
        Formulas whose zeros are located, as for :class:`Propagator`: ``["omega_3 == 0"]``.
    t : array, shape (n,), optional
        Sample times in s, in any order; default: the sample times of the scene.
    omega, quaternion, attitude, parameters, torque, switching_times, torque_frame, state, switching, max_step
        As for :func:`propagator`.
    sensitivities
        As for :func:`propagator`.

    Returns
    -------
    Trajectory
        Angular velocity in rad/s, body components; attitude as unit quaternions, body to space.

    Raises
    ------
    InputError
        If the scene or an option cannot be used.
    PropagationError
        If the motion cannot be followed to the last sample time; ``trajectory`` of the error holds the samples before.
    CompilerError
        If the method needs a compiler and no compiler is installed.

    Notes
    -----
    Convention: :mod:`symrot.conventions`.

    Examples
    --------
    >>> import symrot
    >>> symrot.propagate("t_handle", events=["omega_3 == 0"]).t_events[0][:2].round(8).tolist()
    [1.18541555, 3.55624666]
    >>> symrot.propagate("t_handle", t=[0, 1], attitude=("ZXZ", [0, "pi/2", 0])).quaternion.shape
    (2, 4)
    """
    return propagator(
        scene,
        method,
        tolerance,
        omega=omega,
        quaternion=quaternion,
        attitude=attitude,
        parameters=parameters,
        torque=torque,
        switching_times=switching_times,
        torque_frame=torque_frame,
        state=state,
        switching=switching,
        max_step=max_step,
        sensitivities=sensitivities,
    )(t, events=events)
