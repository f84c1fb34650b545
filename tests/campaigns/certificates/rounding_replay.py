"""A kernel's operations, replayed at many points at once: rounded as in the kernel, beside nearly exact values.

Every operation is done twice along the same branches: rounded, and with 64 bits, or 53 bits for float kernels. That
suffices to search for large errors, not to state them (:mod:`tests.campaigns.certificates.rounding_measured`).
"""

from collections.abc import Callable
from fractions import Fraction
from math import atan2, cos, pi, sin
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.readback.intended_constants import intended_value
from symrot.certificates.readback.operations import RELATIONS, GraphBuilder, Operations, operands
from symrot.certificates.rounding.region import Region
from symrot.errors import CertificateError

__all__ = ["FLOAT", "Points", "behind", "meant", "replay", "scan"]

Points: TypeAlias = NDArray[Any]  # (inputs, n)

FLOAT = {"binary64": np.float64, "binary32": np.float32}
_WIDE = {"binary64": np.longdouble, "binary32": np.float64}
_CALLS: dict[str, Callable[..., Any]] = {
    "sin": np.frompyfunc(sin, 1, 1), "cos": np.frompyfunc(cos, 1, 1), "atan2": np.frompyfunc(atan2, 2, 1),
}  # fmt: skip
_ROUNDED: dict[str, Callable[..., Any]] = {
    "add": np.add, "sub": np.subtract, "mul": np.multiply, "div": np.divide, "neg": np.negative, "abs": np.abs,
    "sqrt": np.sqrt, "copysign": np.copysign,
}  # fmt: skip
_WIDE_CALLS: dict[str, Callable[..., Any]] = {"sin": np.sin, "cos": np.cos, "atan2": np.arctan2}


def meant(value: Fraction, precision: str) -> tuple[Fraction, bool]:
    """Return the exact value that a constant stands for, and whether it is times pi; the constant itself if that is not
    known.
    """
    try:
        constant = intended_value(value, precision)
    except CertificateError:
        return value, False
    return constant.fraction, constant.times_pi


def behind(operations: Operations, output: str) -> Operations:
    """Return the operations that one output needs, with the same inputs."""
    builder = GraphBuilder()
    builder.nodes = list(operations.nodes)
    root = dict(operations.outputs)[output]
    return builder.finish(operations.name, operations.precision, operations.inputs, [(output, root)])


def replay(operations: Operations, points: Points) -> tuple[list[Any], list[Any]]:
    """Return the rounded and the nearly exact values of all nodes."""
    kind: Any = FLOAT[operations.precision]
    wide: Any = _WIDE[operations.precision]
    count = points.shape[1]
    computed: list[Any] = []
    exact: list[Any] = []
    for node in operations.nodes:
        if node[0] == "in":
            value = points[operations.inputs.index(node[1])]
            computed.append(value)
            exact.append(value.astype(wide))
        elif node[0] == "const":
            fraction, times_pi = meant(node[1], operations.precision)
            stands: Any = wide(fraction.numerator) / wide(fraction.denominator)
            computed.append(np.full(count, kind(float(node[1]))))
            exact.append(np.full(count, stands * np.arctan2(wide(0), wide(-1)) if times_pi else stands))
        elif node[0] == "select":
            holds = RELATIONS[node[1]](computed[node[2]], computed[node[3]])
            computed.append(np.where(holds, computed[node[4]], computed[node[5]]))
            exact.append(np.where(holds, exact[node[4]], exact[node[5]]))
        elif node[0] == "call":
            arguments = [computed[i].astype(np.float64) for i in node[2]]
            computed.append(_CALLS[node[1]](*arguments).astype(np.float64).astype(kind))
            exact.append(_WIDE_CALLS[node[1]](*(exact[i] for i in node[2])))
        else:
            computed.append(_ROUNDED[node[0]](*(computed[i] for i in operands(node))))
            exact.append(_ROUNDED[node[0]](*(exact[i] for i in operands(node))))
    return computed, exact


def scan(operations: Operations, region: Region, points: Points) -> dict[str, NDArray[np.float64]]:
    """Return the errors of all outputs at points; -1 where a point is too near to a point without an angle."""
    with np.errstate(all="ignore"):
        computed, exact = replay(operations, points)
        outside = np.zeros(points.shape[1], bool)
        for node in operations.nodes if region.clearance else ():
            if node[0] == "call" and node[1] == "atan2":
                outside |= np.hypot(*(exact[i] for i in node[2])) < region.clearance
        extremes = {}
        for place, index in operations.outputs:
            error = np.abs(computed[index].astype(exact[index].dtype) - exact[index]).astype(np.float64)
            if region.unit:
                error = np.abs(error - 2 * pi * np.rint(error / (2 * pi)))
            extremes[place] = np.where(outside | ~np.isfinite(error), -1.0, error)
    return extremes
