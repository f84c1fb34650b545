"""The table of closed forms: each has a condition on scenes, and a function that returns its motions.

A closed form is a formula for angular velocity and attitude at any time, such as the theta functions of a free body.
:func:`exact_form` chooses the first form in :data:`FORMS` whose condition a scene meets; other scenes are integrated
step by step.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple, Protocol

from numpy.typing import ArrayLike

from symrot.build import cache as library
from symrot.closed_form.build import Floats
from symrot.formula.exact_numbers import equal
from symrot.planning.rules import ATTITUDE_QUANTITIES
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = ["FORMS", "ClosedForm", "Exact", "exact_form", "torque_and_damping"]


class Exact(Protocol):
    """A motion that is computed by a closed form."""

    def evaluate(
        self, t: ArrayLike, omega: bool = True, quaternion: bool = True
    ) -> tuple[Floats | None, Floats | None]:
        """Return angular velocity (n, 3), rad/s, body components, and attitude (n, 4), body to space, at times ``t``.

        A result that is not requested is None. Times, s, are counted from the initial state.
        """


Vector = tuple[Fraction, ...]
Starts = Callable[[Initial], Exact]


class ClosedForm(NamedTuple):
    """A closed form: its name, its condition on a scene, and a function that returns the motions of a scene."""

    name: str  # such as "symmetric gyrostat, two steady rotations"
    applies: Callable[[Scene], bool]
    starts: Callable[[Scene], Starts]  # returns a function from initial states to motions that share constants
    library: str  # name of its C files, see symrot.closed_form.build; "" if it has no C files
    derivation: str  # the derivation that proves it
    axis: Callable[[Scene], int | None] = lambda scene: None  # body axis of the motion, if any

    def motion(self, scene: Scene) -> Exact:
        """Return the motion of a scene to which this closed form applies, from the scene's initial state."""
        return self.starts(scene)(scene.initial)

    def begin(self) -> None:
        """Start to compile the C files of the closed form in the background, if they are not compiled yet."""
        from symrot.closed_form.build import begin

        if self.library and not library.missing():
            begin(self.library)


def _torques(scene: Scene) -> list[str]:
    return [torque.kind for torque in scene.torques]


def _moments(scene: Scene) -> tuple[Fraction, Fraction, Fraction]:
    a, b, c = (scene.body.inertia[i][i] for i in range(3))
    return a, b, c


def _symmetric_about(scene: Scene, axis: int) -> bool:
    across, other = (moment for i, moment in enumerate(_moments(scene)) if i != axis)
    return scene.body.principal.given_axes and equal(across, other)


def _only_axis(vector: tuple[Fraction, ...]) -> int | None:
    """Return the index of the only nonzero component of a vector, or None: ``(0, 0, 5)`` gives 2, (1, 1, 0) None."""
    along = [axis for axis, component in enumerate(vector) if component != 0]
    return along[0] if len(along) == 1 else None


def _is_free(scene: Scene) -> bool:
    return not scene.torques


def _free_body(scene: Scene) -> Starts:
    from symrot.closed_form.free_body import motion as free_body

    return free_body.starts(scene.body.principal)


def _is_symmetric_top(scene: Scene) -> bool:
    if _torques(scene) != ["gravity"]:
        return False
    axis = _only_axis(scene.torques[0].vector("center_of_mass"))
    return axis is not None and _symmetric_about(scene, axis)


def _heavy_top(scene: Scene) -> Starts:
    from symrot.closed_form.heavy_top import motion as heavy_top

    torque = scene.torques[0]
    constants = torque.number("weight"), torque.vector("center_of_mass"), torque.vector("direction")
    return heavy_top.starts(_moments(scene), *constants)


def _is_symmetric_gyrostat(scene: Scene) -> bool:
    if _torques(scene) != ["rotor"]:
        return False
    axis = _only_axis(scene.torques[0].vector("angular_momentum"))
    return axis is not None and _symmetric_about(scene, axis)


def _gyrostat(scene: Scene) -> Starts:
    from symrot.closed_form.gyrostat import motion as gyrostat

    return gyrostat.starts(_moments(scene), scene.torques[0].vector("angular_momentum"))


def torque_and_damping(scene: Scene) -> tuple[Vector, Vector]:
    """Return two vectors: the sum of a scene's torques of constant body components, and its damping coefficients.

    Their units are N m and N m s.
    """
    sums = []
    for kind, field in (("constant_body", "torque"), ("damping", "linear")):
        vectors = [torque.vector(field) for torque in scene.torques if torque.kind == kind]
        sums.append(tuple(sum((vector[i] for vector in vectors), Fraction(0)) for i in range(3)))
    return sums[0], sums[1]


def _is_driven(scene: Scene) -> bool:
    if not scene.torques or not set(_torques(scene)) <= {"constant_body", "damping"}:
        return False
    return scene.body.principal.given_axes and not any(torque.values.get("quadratic") for torque in scene.torques)


def _driven_axis(scene: Scene) -> int | None:
    """Return the index of the body axis about which the body rotates at all times; 0 if it stays at rest.

    None if the axis of rotation changes or is not one of the body axes 0, 1, 2, if the body axes are not principal
    axes, if a torque is neither constant in the body nor linear damping, or if the scene has no torque.
    """
    if not _is_driven(scene):
        return None
    push, turning = torque_and_damping(scene)[0], _only_axis(scene.initial.omega_b)
    axis = turning if turning is not None else _only_axis(push)
    # torque and angular velocity must be parallel to the axis
    across = [*scene.initial.omega_b, *push]
    if not any(across):
        return 0  # the body stays at rest
    return None if any(x for i, x in enumerate(across) if i % 3 != axis) else axis


def _driven_symmetry_axis(scene: Scene) -> int | None:
    """Return the index of the body's symmetry axis about which the sum of all constant torques acts, or None.

    The sum may be zero. The linear damping about the two other axes must be equal. None means that there is no such
    axis, that a torque is neither constant in the body nor linear damping, that the scene has no torque, or that the
    scene's output includes the attitude of a damped body, which has no closed form.
    """
    if not _is_driven(scene):
        return None
    push, drag = torque_and_damping(scene)
    if any(drag) and set(scene.output.quantities) & ATTITUDE_QUANTITIES:
        return None
    for axis in range(3):
        if (
            _symmetric_about(scene, axis)
            and drag[axis - 2] == drag[axis - 1]
            and not push[axis - 2]
            and not push[axis - 1]
        ):
            return axis
    return None


def _turning_axis(scene: Scene) -> int | None:
    axis = _driven_axis(scene)
    return _driven_symmetry_axis(scene) if axis is None else axis


def _axial(scene: Scene) -> Starts:
    from symrot.closed_form.axial import motion as axial

    axis = _turning_axis(scene)
    assert axis is not None
    push, drag = torque_and_damping(scene)
    return axial.starts(_moments(scene), axis, push[axis], drag[axis], drag[axis - 1])


def _field_axis(name: str) -> Callable[[Scene], int | None]:
    """Return a function that takes a scene and returns the body axis, 0, 1 or 2, along which a constant vector lies.

    ``name`` is the name of the vector in the first torque of the scene, such as ``center_of_mass`` of a gravity torque.
    The function returns None if the vector is zero or lies along none of the three axes.
    """
    return lambda scene: _only_axis(scene.torques[0].vector(name))


def _is_spun_up(scene: Scene) -> bool:
    return bool(set(scene.output.quantities) & ATTITUDE_QUANTITIES) and _driven_symmetry_axis(scene) is not None


def _spin_up(scene: Scene) -> Starts:
    from symrot.closed_form.spin_up import motion as spin_up

    axis = _driven_symmetry_axis(scene)
    assert axis is not None
    return spin_up.starts(_moments(scene), axis, torque_and_damping(scene)[0][axis])


FORMS = (
    ClosedForm("free body, theta functions", _is_free, _free_body, "free_body", "free_body_attitude"),
    ClosedForm(
        "symmetric heavy top, theta functions",
        _is_symmetric_top,
        _heavy_top,
        "heavy_top",
        "heavy_top_motion",
        _field_axis("center_of_mass"),
    ),
    ClosedForm(
        "symmetric gyrostat, two steady rotations",
        _is_symmetric_gyrostat,
        _gyrostat,
        "gyrostat",
        "symmetric_gyrostat",
        _field_axis("angular_momentum"),
    ),
    ClosedForm(
        "rotation about one axis",
        lambda scene: _driven_axis(scene) is not None,
        _axial,
        "axial",
        "driven_rotation",
        _driven_axis,
    ),
    ClosedForm(
        "symmetric body driven about its axis, parabolic cylinder functions",
        _is_spun_up,
        _spin_up,
        "spin_up",
        "driven_rotation",
        _driven_symmetry_axis,
    ),
    ClosedForm(
        "symmetric body driven about its axis, angular velocity alone",
        lambda scene: _driven_symmetry_axis(scene) is not None,
        _axial,
        "axial",
        "driven_rotation",
        _driven_symmetry_axis,
    ),
)
"""The closed forms, in the order in which their conditions are tested on a scene."""


def exact_form(scene: Scene) -> ClosedForm | None:
    """Return the first closed form in the table that applies to a scene, or None if none applies."""
    if scene.table is not None:  # the conditions do not cover a torque given by samples
        return None
    return next((form for form in FORMS if form.applies(scene)), None)
