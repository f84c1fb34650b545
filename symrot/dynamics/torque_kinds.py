"""Table of the kinds of torque that a scene may have, each with its fields, units and default values.

:mod:`symrot.dynamics.torques` contains the formulas of the torques and their potentials. The functions that read scenes
use only this table, because it needs only the standard library.
"""

from fractions import Fraction
from typing import NamedTuple

__all__ = ["EXPRESSION_NAMES", "TABLE_KIND", "TORQUE_KINDS", "Field", "TorqueKind"]

EXPRESSION_NAMES = ("t", "omega_1", "omega_2", "omega_3", "q0", "q1", "q2", "q3")
"""The names in an ``expression`` torque that are not parameters: time (s), omega_b (rad/s) and quaternion."""


class Field(NamedTuple):
    """One entry of a torque's table in a scene file, such as a stiffness: shape, unit, meaning, sign and default."""

    name: str
    shape: str  # scalar | vector | scalar or vector | attitude | formulas | parameters | a choice "x|y"
    unit: str
    meaning: str
    required: bool = False
    default: object = None
    sign: str = "any"  # any | positive | nonnegative; of a vector: any | nonzero | nonnegative (each component)


class TorqueKind(NamedTuple):
    """One kind of torque, such as ``"gravity"``: its name, its fields, and the point about which the body
    must rotate.
    """

    kind: str
    fields: tuple[Field, ...]
    # center_of_mass, fixed_point, or any
    about: str
    meaning: str


_ZERO = Fraction(0)
_DOWN = (_ZERO, _ZERO, Fraction(-1))

_TABLE = (
    TorqueKind(
        "constant_body",
        (Field("torque", "vector", "N m", "the torque, body components", required=True),),
        "any",
        "a torque that turns with the body, such as a thruster's",
    ),
    TorqueKind(
        "constant_space",
        (Field("torque", "vector", "N m", "the torque, space components", required=True),),
        "any",
        "a torque of fixed direction in space",
    ),
    TorqueKind(
        "gravity",
        (
            Field("weight", "scalar", "N", "the weight; or give gravity, for a body with a mass", sign="positive"),
            Field("gravity", "scalar", "m/s^2", "the acceleration of free fall, instead of the weight",
                  sign="positive"),
            Field("center_of_mass", "vector", "m", "from the fixed point, body components", sign="nonzero"),
            Field("direction", "vector", "1", "where the weight points, space components", default=_DOWN,
                  sign="nonzero"),
        ),
        "fixed_point",
        "the weight, acting at the centre of mass of a body that turns about a fixed point",
    ),
    TorqueKind(
        "gravity_gradient",
        (Field("mean_motion", "scalar", "rad/s", "rate n of the circular orbit", required=True, sign="positive"),),
        "center_of_mass",
        "the tide on a circular orbit in the x-y plane of space, the radius along (cos n t, sin n t, 0)",
    ),
    TorqueKind(
        "damping",
        (
            Field("linear", "scalar or vector", "N m s", "torque -linear * omega_b, per axis if three are given",
                  default=(_ZERO, _ZERO, _ZERO), sign="nonnegative"),
            Field("quadratic", "scalar", "N m s^2", "torque -quadratic * |omega| * omega_b", default=_ZERO,
                  sign="nonnegative"),
        ),
        "any",
        "a torque against the rotation",
    ),
    TorqueKind(
        "spring",
        (
            Field("stiffness", "scalar", "N m/rad", "k of the torque -2 k q_e0 (q_e1, q_e2, q_e3), q_e = q_rest* q",
                  required=True, sign="positive"),
            Field("attitude", "attitude", "1", "the attitude of rest, a quaternion (q0, q1, q2, q3)", required=True),
        ),
        "any",
        "a torsional spring toward an attitude, of potential 2 k (1 - q_e0^2): k angle^2 / 2 for small angles",
    ),
    TorqueKind(
        "rotor",
        (
            Field("angular_momentum", "vector", "kg m^2/s", "constant, relative to the body, body components",
                  required=True, sign="nonzero"),
        ),
        "any",
        "an internal rotor at constant relative speed: a gyrostat",
    ),
    TorqueKind(
        "expression",
        (
            Field("torque", "formulas", "N m", f"three formulas in {', '.join(EXPRESSION_NAMES)} and the parameters",
                  required=True),
            Field("parameters", "parameters", "1", "numbers by name", default={}),
            Field("frame", "body|space", "1", "the axes of the components", default="body"),
        ),
        "any",
        "a torque given by formulas",
    ),
)  # fmt: skip

TORQUE_KINDS: dict[str, TorqueKind] = {entry.kind: entry for entry in _TABLE}
"""The kinds of torque that have formulas, by name, in the order of the documentation."""

TABLE_KIND = TorqueKind(
    "table",
    (
        Field("t", "times", "s", "times of the samples, increasing; each switching time twice"),
        Field("moment", "moments", "N m", "the samples, three components each"),
        Field("file", "path", "1", "instead of both: a CSV file beside the scene, columns t, M1, M2, M3"),
        Field("interpolation", "cubic_spline", "1", "through the samples between switching times",
              default="cubic_spline"),
        Field("frame", "body|space", "1", "the axes of the components", default="body"),
        Field("switching_times", "times", "s", "times at which the torque jumps: the motion is stepped exactly to each",
              default=()),
    ),
    "any",
    "a torque given by samples instead of formulas",
)  # fmt: skip
"""The only kind of torque without a formula; :mod:`symrot.scene.samples` reads it, and no kernel is derived from it."""
