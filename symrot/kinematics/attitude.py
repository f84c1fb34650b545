"""Look-up of attitude descriptions (charts) by name, and the symbolic conversion from any description to any other."""

from collections.abc import Callable, Sequence
from typing import Any

from sympy import ImmutableMatrix, Matrix, nan, zoo

from symrot.conventions import SEQUENCES
from symrot.errors import InputError
from symrot.kinematics import euler, quaternion, rodrigues, rotation_vector
from symrot.kinematics.chart import Chart
from symrot.kinematics.rotations import expressions

__all__ = ["CHARTS", "chart", "convert"]

CHARTS: dict[str, Callable[[], Chart]] = {
    "quaternion": quaternion.chart,
    "rotation_vector": rotation_vector.chart,
    "axis_angle": rotation_vector.axis_angle_chart,
    "rodrigues": rodrigues.CLASSICAL.chart,
    "mrp": rodrigues.MODIFIED.chart,
}


def chart(name: str) -> Chart:
    """Return the chart (attitude description) with a given name.

    Parameters
    ----------
    name : str
        A key of :data:`CHARTS`, such as ``"quaternion"``, or an Euler sequence, such as ``"ZXZ"``.

    Raises
    ------
    InputError
        If the name is neither.
    """
    if name in CHARTS:
        return CHARTS[name]()
    if name in SEQUENCES:
        return euler.chart(name)
    raise InputError(f"expected an attitude description ({', '.join(CHARTS)}) or an Euler sequence, got {name!r}")


def convert(source: str, target: str, values: Sequence[Any] | Matrix | None = None) -> ImmutableMatrix:
    """Return the parameters of the description ``target``, shape (n, 1), as expressions in the parameters of
    ``source``.

    Parameters
    ----------
    source, target : str
        Names of the descriptions; see :func:`chart`.
    values : sequence of Expr, optional
        Values of the parameters of ``source``; default: its symbols. The values must satisfy the constraint of
        ``source``, such as unit norm.

    Raises
    ------
    InputError
        If a name is unknown, or if no set of ``target`` parameters describes the attitude, or more than one: for a
        rotation by zero, for example, any axis will do.
    """
    # Every description converts to and from the quaternion. The dcm is none of them: chart(name).dcm, euler_of_dcm.
    start = chart(source)
    parameters = expressions(start.parameters if values is None else values, len(start.parameters), source)
    if source == "rotation_vector":  # its formula is 0/0 at the zero vector
        q = rotation_vector.quaternion_of_rotation_vector(parameters)
    else:
        q = start.quaternion.xreplace(dict(zip(start.parameters, parameters, strict=True)))
    converted = chart(target).of_quaternion(q)
    if converted.has(nan, zoo):
        raise InputError(
            f"convert: expected an attitude with unique parameters in the description {target}, got the attitude "
            f"{tuple(parameters)} of the description {source}; it has no {target} parameters, or several sets"
        )
    return converted
