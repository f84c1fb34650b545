"""Measurement of the errors of functions that kernels call, in units in the last place (ulp), against mpmath.

    python -m symrot.bench.ulps [--points 20000]

The functions come from emitted C in two forms, for one sample (``one``) and without branches for batches (``batch``).
"""

import argparse
import ctypes
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache as memoised
from itertools import product
from math import frexp, inf, ldexp, pi
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray
from sympy import Symbol, lambdify

from symrot.build import cache
from symrot.codegen.library_kernels import kernel_description, kernel_program
from symrot.codegen.printing.c_function import DOUBLE, FLOAT, Real
from symrot.codegen.printing.c_source import MATH_HEADER, c_functions, c_header
from symrot.codegen.printing.math_header import FAR, math_header
from symrot.kernels.library import definition
from symrot.kernels.removable import REMOVABLE

__all__ = ["FUNCTIONS", "Measured", "main", "measured"]

CONTRACTION = {"unfused": ("-ffp-contract=off",), "fused": ("-ffp-contract=fast", cache.NATIVE)}
FLAGS = ("-std=c99", "-O2", "-fPIC", "-shared")
DIGITS = {"binary64": (53, -1074), "binary32": (24, -149)}  # bits of the fraction; exponent of the least number
EXACT = 60  # digits of exact values
LEAST = {"binary64": 2.0**-1021, "binary32": 2.0**-125}
REACH = {"binary64": float(np.finfo(np.float64).max), "binary32": float(np.finfo(np.float32).max)}  # largest numbers

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Function:
    """A function that kernels call: how mpmath computes it, its C functions, and the range of the tested arguments."""

    name: str
    exact: Callable[..., Any]  # from the arguments, numbers of mpmath, to the exact value
    kernel: str  # kernel whose C text contains the function
    # C functions: pairs ("one" for single samples or "batch" for batches, prefix of the function's name)
    forms: tuple[tuple[str, str], ...] = (("one", "symrot_"), ("batch", "symrot_near_"))
    reach: float = inf  # largest |x| that is tested
    # if not 0: the smallest tested |x|; errors are then counted in units of 2^-53/x^2 (float: 2^-24/x^2)
    beyond: float = 0.0


@dataclass(frozen=True)
class Measured:
    """The largest error of one C function (for one sample or for batches), in ulp, and the argument where it occurs."""

    name: str
    real: str
    form: str
    contraction: str
    ulp: float
    where: tuple[float, ...]


@memoised
def _quotient(name: str) -> Callable[[Any], Any]:
    """Return the quotient, such as sin(x)/x, that defines a function with a removable singularity, for mpmath."""
    x = Symbol("x", real=True)
    function: Callable[[Any], Any] = lambdify(x, REMOVABLE[name].formula(x), "mpmath")
    return function


@memoised
def _coefficients(name: str) -> list[Any]:
    """Return the coefficients of the function ``name`` in powers of x^2, the highest first, for mpmath."""
    with mpmath.workdps(EXACT):
        return [mpmath.mpf(a.numerator) / a.denominator for a in reversed(REMOVABLE[name].taylor(26))]


def _series(name: str, x: Any) -> Any:
    """Return the exact value at ``x`` of the function ``name`` with a removable singularity, by its series near 0."""
    return _quotient(name)(x) if abs(x) > 1 else mpmath.polyval(_coefficients(name), x * x)


def _sinc(x: Any) -> Any:
    return mpmath.sin(x) / x if x else mpmath.mpf(1)


def _arc_ratio(s: Any, c: Any) -> Any:
    return mpmath.atan2(s, c) / s if s else 1 / c


_BATCH = (("batch", "symrot_"),)
FUNCTIONS = (
    Function("sinc", _sinc, "rotation_vector_quaternion"),
    Function("sine_gap", lambda x: _series("sine_gap", x), "rotation_vector_body_jacobian"),
    Function("tangent_gap", lambda x: _series("tangent_gap", x), "rotation_vector_body_rates", reach=pi),
    Function("tangent_gap", lambda x: _series("tangent_gap", x), "rotation_vector_body_rates", beyond=pi),
    Function("sine_bend", lambda x: _series("sine_bend", x), "rotation_vector_body_jacobian_by_v"),
    Function("tangent_bend", lambda x: _series("tangent_bend", x), "rotation_vector_body_rates_by_v", reach=pi),
    Function("tangent_bend", lambda x: _series("tangent_bend", x), "rotation_vector_body_rates_by_v", beyond=pi),
    Function("arc_ratio", _arc_ratio, "rotation_vector_of_quaternion"),
    Function("atan2", mpmath.atan2, "rotation_vector_of_quaternion", _BATCH),
    Function("sin", mpmath.sin, "rotation_vector_quaternion", _BATCH),
    Function("cos", mpmath.cos, "rotation_vector_quaternion", _BATCH),
)


def _points(function: Function, real: Real, form: str, count: int) -> Floats:
    """Return about ``count`` test arguments of a function, one column per point.

    ``form`` is ``"one"`` to test the C function for one sample, or ``"batch"`` to test that for batches, which is valid
    in a smaller range.
    """
    draw = np.random.default_rng(3)
    far = float(FAR[real.precision])
    reach = min(function.reach, REACH[real.precision] if form == "one" else far)
    kind = np.float32 if real.suffix else np.float64
    sizes = np.exp(draw.uniform(np.log(LEAST[real.precision]), np.log(reach), count // 4))
    if function.name == "atan2":
        return _directions(real, count, kind)
    if function.name == "arc_ratio":
        angles = np.concatenate([[0.0], sizes[sizes < pi], draw.uniform(0, pi, count - len(sizes))])
        return np.array([np.sin(angles), np.cos(angles)]).astype(kind).astype(float)
    turns = np.rint(draw.uniform(1, min(reach, far) * 2 / pi, count // 4)) * (pi / 2)
    # the thresholds below which a series is used, and multiples of pi/2 before them
    splits = [float(each.split) ** 0.5 for each in REMOVABLE.values()]
    around = [split + np.arange(-40, 41) * float(np.spacing(kind(split))) for split in splits]
    wide = draw.uniform(-min(reach, far), min(reach, far), count // 4)
    close = draw.uniform(0, min(reach, 8.0), count // 4)
    points = np.concatenate([[0.0], sizes, -sizes[:99], turns, *around, wide, close]).astype(kind).astype(float)
    inside: Floats = points[(np.abs(points) <= reach) & (np.abs(points) >= function.beyond)][None, :]
    return inside


def _directions(real: Real, count: int, kind: Any) -> Floats:
    """Return about ``count`` test arguments y and x of the arc tangent, as two rows."""
    draw, third = np.random.default_rng(4), count // 3
    low, high = np.log(LEAST[real.precision]), np.log(REACH[real.precision])
    angles = draw.uniform(-pi, pi, third)
    # near the lines y = x/2, y = x and y = 2 x
    around = [np.stack([sizes, sizes]) for sizes in np.exp(draw.uniform(-3, 3, (2, third // 2)))]
    around[0][0] *= 0.5 + draw.integers(-9, 10, third // 2) * float(np.finfo(kind).eps)
    around[1][0] *= 1 + draw.integers(-9, 10, third // 2) * float(np.finfo(kind).eps)
    spread = np.exp(draw.uniform(low, high, (2, third)))
    directions = np.concatenate([[np.sin(angles), np.cos(angles)], spread, *around, around[0][::-1]], axis=1)
    signs = draw.choice([-1.0, 1.0], directions.shape)
    few = np.array(list(product((0.0, 1.0, -1.0, float(np.finfo(kind).max), LEAST[real.precision]), repeat=2))).T
    return np.concatenate([directions * signs, few[:, few[1] >= 0]], axis=1).astype(kind).astype(float)


def _text(kernel: str) -> str:
    """Return the C text of a kernel, and of loops over arrays that call its functions.

    There is a loop for each C function of the kernel that :data:`FUNCTIONS` lists.
    """
    program, reals = kernel_program(kernel), (DOUBLE, FLOAT)
    source = c_functions(program, reals, branch_free=True).replace(f'#include "{MATH_HEADER}"', "")
    header = c_header(program, kernel_description(definition(kernel), "c"), reals)
    text = math_header() + source.replace(f'#include "{kernel}.h"', header)
    functions = {function.name: function for function in FUNCTIONS if function.kernel == kernel}
    for real, (name, function) in product(reals, functions.items()):
        arguments = ", ".join(f"x[{i}*n + k]" for i in range(2 if name in ("arc_ratio", "atan2") else 1))
        for form, prefix in function.forms:
            text += (
                f"\nvoid {form}_{name}{real.suffix}(size_t n, const {real.type} *x, {real.type} *y)\n{{\n"
                "    for (size_t k = 0; k < n; ++k)\n"
                f"        y[k] = {prefix}{name}{real.suffix}({arguments});\n}}\n"
            )
    return text


def _ulps(computed: float, exact: Any, real: Real, x: float = 0.0) -> float:
    """Return the distance of ``computed`` from ``exact`` in units in the last place of ``exact``, or in units of
    2^-53/x^2 (float: 2^-24/x^2) if x is not 0.
    """
    digits, least = DIGITS[real.precision]
    # tangent_gap, (sin x - x cos x)/x^3, decreases as cos(x)/x^2: near its zeros, which are no floating-point numbers,
    # its relative error has no bound.
    if x:
        return abs(float((computed - exact) / max(ldexp(1.0, -digits) / x / x, ldexp(1.0, least))))
    if not exact:
        return 0.0 if computed == 0 else float("inf")
    unit = ldexp(1.0, max(frexp(float(exact))[1] - digits, least))
    return abs(float((computed - exact) / unit)) if np.isfinite(computed) else float("inf")


def measured(points: int = 20_000, contraction: Sequence[str] = tuple(CONTRACTION)) -> Iterator[Measured]:
    """Yield the largest error of each tested function, for one sample and for batches, by precision and contraction.

    Parameters
    ----------
    points : int
        Approximate number of arguments of each function.
    contraction : sequence of str
        Among ``"unfused"`` and ``"fused"``: whether the compiler may fuse a product and a sum.
    """
    for function in FUNCTIONS:
        text = _text(function.kernel)
        built = {each: cache.build(text, "ulps", (*FLAGS, *CONTRACTION[each])) for each in contraction}
        for real, (form, _) in product((DOUBLE, FLOAT), function.forms):
            arguments = _points(function, real, form, points)
            with mpmath.workdps(EXACT):
                exact = [function.exact(*map(mpmath.mpf, each)) for each in arguments.T.tolist()]
                for each, path in built.items():
                    values = _called(ctypes.CDLL(str(path)), f"{form}_{function.name}{real.suffix}", arguments, real)
                    far = arguments[0].tolist() if function.beyond else [0.0] * len(values)
                    errors = [_ulps(value, right, real, x) for value, right, x in zip(values, exact, far, strict=True)]
                    worst = int(np.argmax(errors))
                    where = tuple(arguments[:, worst].tolist())
                    name = f"{function.name} >pi" if function.beyond else function.name
                    yield Measured(name, real.type, form, each, errors[worst], where)


def _called(loaded: ctypes.CDLL, name: str, arguments: Floats, real: Real) -> list[float]:
    inputs = np.ascontiguousarray(arguments.astype(np.float32 if real.suffix else np.float64))
    outputs = np.empty(inputs.shape[1], inputs.dtype)
    function = getattr(loaded, name)
    function.argtypes = (ctypes.c_size_t, ctypes.c_void_p, ctypes.c_void_p)
    function(inputs.shape[1], inputs.ctypes.data, outputs.ctypes.data)
    values: list[float] = outputs.astype(float).tolist()
    return values


def main(arguments: list[str] | None = None) -> None:
    """Print the largest errors of the functions that kernels call, in ulp."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.ulps", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--points", type=int, default=20_000)
    points = parser.parse_args(arguments).points
    print(f"largest error in ulp over about {points} points\n{'':16}{'':8}{'':8}{'':10}{'ulp':>7}  at")
    rows = []
    for row in measured(points):
        rows.append(row)
        where = ", ".join(map(repr, row.where))
        print(f"{row.name:16}{row.real:8}{row.form:8}{row.contraction:10}{row.ulp:7.3f}  {where}", flush=True)
    worst = max(rows, key=lambda row: row.ulp)
    print(f"largest of all: {worst.ulp:.3f} ulp, {worst.name} in {worst.real}, {worst.form}, {worst.contraction}")


if __name__ == "__main__":
    main()
