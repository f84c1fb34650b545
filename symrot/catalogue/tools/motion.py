"""Time derivatives along a motion by the chain rule, and the motions that derivations share."""

from collections.abc import Mapping, Sequence
from typing import Any

from sympy import Add, Expr, Matrix, MatrixBase, Symbol

from symrot import symbols
from symrot.catalogue.tools.derivative import derivative
from symrot.kinematics.quaternion import quaternion_rates

__all__ = ["OMEGA", "TENSOR", "attitude_rates", "pairs", "rate", "squared"]

OMEGA = Matrix(symbols.omega_b)
TENSOR = Matrix(
    [
        [symbols.I_xx, symbols.I_xy, symbols.I_xz],
        [symbols.I_xy, symbols.I_yy, symbols.I_yz],
        [symbols.I_xz, symbols.I_yz, symbols.I_zz],
    ]
)
"""The general inertia tensor in body axes, about the point for which the equations hold: the fixed point of the body,
or its centre of mass."""


def pairs(variables: Sequence[Symbol], rates: Any) -> dict[Symbol, Expr]:
    """Return a map from each variable to its rate of change, for :func:`rate`; ``rates`` has the same order."""
    return dict(zip(variables, list(rates), strict=True))


def attitude_rates() -> dict[Symbol, Expr]:
    """Return a map from the quaternion components q0 to q3 to their rates, for the body rates ``OMEGA``."""
    return pairs(symbols.quaternion, quaternion_rates("body") * OMEGA)


def rate(quantity: Any, rates: Mapping[Symbol, Expr]) -> Any:
    """Return d/dt of an expression or matrix ``quantity`` by the chain rule, with the rate of each variable."""
    if isinstance(quantity, MatrixBase):
        return quantity.applyfunc(lambda entry: rate(entry, rates))
    return Add(*(derivative(quantity, variable) * speed for variable, speed in rates.items()))


def squared(vector: Matrix) -> Expr:
    """Return the square of the length of a vector, ``v . v``."""
    return vector.dot(vector)
