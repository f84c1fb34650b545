"""Every attitude description by name, and the symbolic conversions between any two of them."""

from collections.abc import Callable, Sequence
from typing import Any

from sympy import ImmutableMatrix, Matrix

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
    """Return a chart by name: one of :data:`CHARTS`, or an Euler sequence such as ``"ZXZ"``.

    Raises
    ------
    InputError
        For a name that is neither.
    """
    if name in CHARTS:
        return CHARTS[name]()
    if name in SEQUENCES:
        return euler.chart(name)
    raise InputError(f"an attitude description is one of {', '.join(CHARTS)} or an Euler sequence; got {name!r}")


def convert(source: str, target: str, values: Sequence[Any] | Matrix | None = None) -> ImmutableMatrix:
    """Return the parameters of ``target`` as expressions in those of ``source``, shape (n, 1).

    Through the quaternion, which both charts know. A dcm is reached by ``chart(name).dcm``, and left by
    :func:`symrot.kinematics.quaternion.quaternion_of_dcm` or :func:`symrot.kinematics.euler.euler_of_dcm`.

    Parameters
    ----------
    source, target : str
        See :func:`chart`.
    values : sequence of Expr, optional
        In place of the symbols of ``source``; they must obey its relations (unit norm).
    """
    start = chart(source)
    parameters = expressions(start.parameters if values is None else values, len(start.parameters), source)
    q = start.quaternion.xreplace(dict(zip(start.parameters, parameters, strict=True)))
    return chart(target).of_quaternion(q)
