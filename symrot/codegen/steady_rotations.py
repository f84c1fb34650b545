"""The closed form of a motion without outer torque of a sphere, a symmetric body or a symmetric gyrostat.

The angular velocity omega rotates in the body at a constant rate sigma about the symmetry axis e:
``domega/dt = sigma omega x e``. The attitude is then a product of two steady rotations::

    q(t + dt) = q(t) exp(dt (omega - sigma e)/2) exp(dt sigma e/2)

The first rotates about the angular momentum, the second about the symmetry axis. A sphere needs the first alone.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from symrot.formula.program import Program

__all__ = ["STATES", "SteadyRotations"]

_OMEGA, _QUATERNION = ("omega_1", "omega_2", "omega_3"), ("q0", "q1", "q2", "q3")
STATES = (*_OMEGA, *_QUATERNION)
"""The states that :class:`SteadyRotations` steps: the components of omega, then those of the quaternion."""
_HALF, _TWO = Fraction(1, 2), Fraction(2)


@dataclass(frozen=True)
class SteadyRotations:
    """The method of a step that computes the exact motion, as a product of one or two steady rotations.

    It is one of the methods of :func:`symrot.codegen.steps.step_program`. The module's docstring has the formula of the
    attitude.
    """

    # the symmetry axis, 0 to 2, about which omega rotates in the body; None if omega is constant
    axis: int | None
    name: str = "exact"

    @property
    def formula(self) -> str:
        """The method in words, such as ``"closed form of the motion, one steady rotation"``."""
        if self.axis is None:
            return "closed form of the motion, one steady rotation"
        return f"closed form of the motion, two steady rotations, one of them about body axis {self.axis + 1}"

    def after(
        self, rates: Program, values: Mapping[str, Any], dt: Any, functions: Mapping[str, Callable[..., Any]],
        number: Callable[[Fraction], Any],
    ) -> list[Any]:  # fmt: skip
        """Return omega and the quaternion after a step of size ``dt``, s: a list of 7 numbers.

        ``rates`` is the right-hand side of the equations of motion. ``values`` maps the names of the states and
        parameters to numbers of any kind, such as floats or Decimals. ``functions`` maps names such as ``"sin"`` to the
        functions of this kind of number, and ``number`` converts a Fraction to it.
        """
        # this is the motion if the rates are those of the module's docstring; certificates prove it
        omega, half = [values[name] for name in _OMEGA], number(_HALF) * dt
        q = [values[name] for name in _QUATERNION]
        if self.axis is None:
            cosine, vector = _rotation(omega, half, functions)
            return [*omega, *_product(q, [cosine, *vector])]
        e, a, b = self.axis, (self.axis + 1) % 3, (self.axis + 2) % 3
        # domega_a/dt = sigma omega_b
        place = dict(values) | {_OMEGA[a]: number(Fraction(0)), _OMEGA[b]: number(Fraction(1))}
        sigma = rates.evaluate(place, functions, number)[f"d{_OMEGA[a]}"]
        cosine, vector = _rotation([w - sigma if i == e else w for i, w in enumerate(omega)], half, functions)
        angle = half * sigma
        c, s = functions["cos"](angle), functions["sin"](angle)
        both = [cosine * c - vector[e] * s, *vector]
        both[1 + e] = cosine * s + vector[e] * c
        both[1 + a], both[1 + b] = vector[a] * c + vector[b] * s, vector[b] * c - vector[a] * s
        # of the whole angle: omega rotates by it
        cosine, sine = (c - s) * (c + s), number(_TWO) * (s * c)
        after = list(omega)
        after[a], after[b] = omega[a] * cosine + omega[b] * sine, omega[b] * cosine - omega[a] * sine
        return [*after, *_product(q, both)]


def _rotation(rate: list[Any], half: Any, functions: Mapping[str, Callable[..., Any]]) -> tuple[Any, list[Any]]:
    """Return the scalar and the vector part of the quaternion exp(half*rate)."""
    length = functions["sqrt"](rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2])
    angle = half * length
    # sinc(x) = sin(x)/x is 1 at x = 0, so that a body at rest needs no case
    factor = half * functions["sinc"](angle)
    return functions["cos"](angle), [factor * each for each in rate]


def _product(a: list[Any], b: list[Any]) -> list[Any]:
    """Return the product a b of two quaternions, scalar first."""
    return [
        a[0] * b[0] - (a[1] * b[1] + a[2] * b[2] + a[3] * b[3]),
        a[0] * b[1] + a[1] * b[0] + (a[2] * b[3] - a[3] * b[2]),
        a[0] * b[2] + a[2] * b[0] + (a[3] * b[1] - a[1] * b[3]),
        a[0] * b[3] + a[3] * b[0] + (a[1] * b[2] - a[2] * b[1]),
    ]
