"""The free rigid body at any time, exactly: spherical, symmetric, asymmetric, about either outer axis, on separatrices.

No stepping: each sample costs the same however far it lies from the start, forward or backward, and carries an error
of a few 1e-16, since the constants of the motion are found to 31 digits and phases are carried in turns. The formulas
are in :file:`free_body.c`; where there is no C compiler, :mod:`symrot.closed_form.free_body_fallback` evaluates them in
Decimal and NumPy.

Source: Whittaker, Analytical Dynamics, 4th ed., section 69; van Zon & Schofield, J. Comput. Phys. 225 (2007) 145.
"""

import ctypes
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symrot import number
from symrot.closed_form.library import Floats, address, load, times_of
from symrot.closed_form.pairs import Number, common, numbers, quotient, spread
from symrot.errors import CompilerError, InputError
from symrot.inertia.principal import Principal, principal_axes

__all__ = ["REGIMES", "FreeBody", "motion", "motion_of_tensor"]

REGIMES = ("steady", "circular", "hyperbolic", "separatrix")
"""Which series a motion takes: none; those of the elliptic functions; their imaginary transforms; on the separatrix."""

_NEGLIGIBLE = 200  # bits: what is smaller is taken for zero, as in number.equal

_DOMAIN = 1
_REFUSED = (
    "a free body has three positive moments of inertia (kg m^2), a finite angular velocity (rad/s) and a quaternion "
    "that is not zero"
)


class FreeBody:
    """One motion of a free rigid body. Times are counted from that of the initial state."""

    def __init__(self, constants: Any, evaluate: Any) -> None:
        self.constants, self._evaluate = constants, evaluate
        self._address = ctypes.addressof(constants)

    @property
    def regime(self) -> str:
        """One of :data:`REGIMES`."""
        return REGIMES[int(self.constants[0])]

    def evaluate(
        self, t: ArrayLike, omega: bool = True, quaternion: bool = True
    ) -> tuple[Floats | None, Floats | None]:
        """Return angular velocity and attitude at any times.

        Parameters
        ----------
        t : number or sequence of n numbers
            s, from the initial state, in any order, negative ones too.
        omega, quaternion : bool
            What is asked for; the other is None and costs nothing.

        Returns
        -------
        omega : array, shape (n, 3), or None
            rad/s, along the body's axes.
        quaternion : array, shape (n, 4), or None
            Body to space, scalar first, unit, continuous in time.

        Raises
        ------
        InputError
            If a time is not finite.
        """
        times = times_of(t)
        rates = np.empty((len(times), 3)) if omega else None
        attitudes = np.empty((len(times), 4)) if quaternion else None
        self._evaluate(self._address, len(times), address(times), address(rates), address(attitudes))
        return rates, attitudes


def motion(
    inertia: Sequence[Number], omega0: Sequence[Number], quaternion0: Sequence[Number] = (1.0, 0.0, 0.0, 0.0)
) -> FreeBody:
    """Return the motion of a free body from its initial state.

    Parameters
    ----------
    inertia : 3 numbers
        Principal moments, kg m^2, positive, in any order. Fractions, ints and floats are taken at their exact values.
    omega0 : 3 numbers
        Angular velocity along the principal axes, rad/s. Components below 1e-150 of the largest count as zero.
    quaternion0 : 4 numbers
        Attitude, body to space, scalar first; it is normalised.

    Raises
    ------
    InputError
        If a number is not of this domain.

    Examples
    --------
    >>> omega, _ = motion((1, 1, 2), (1, 0, 1)).evaluate([0.0], quaternion=False)
    >>> omega.tolist()
    [[1.0, 0.0, 1.0]]
    """
    moments, rates = numbers("inertia", inertia, 3), numbers("omega", omega0, 3)
    attitude = numbers("quaternion", quaternion0, 4)
    exact = None if all(isinstance(x, float) for x in (*moments, *rates)) else _differences(moments, rates)
    return _prepared(spread(moments), spread(rates), spread(attitude), exact, None)


def motion_of_tensor(
    inertia: Sequence[Sequence[Number]],
    omega0: Sequence[Number],
    quaternion0: Sequence[Number] = (1.0, 0.0, 0.0, 0.0),
) -> FreeBody:
    """Return the motion of a free body whose axes need not be principal; omega and attitude refer to the given axes.

    The principal axes are found to 110 digits and turn into the constants of the motion before anything is rounded to a
    double. Arguments as :func:`motion`, but ``inertia`` is a symmetric 3x3 tensor (kg m^2).
    """
    body = principal_axes([list(row) for row in inertia])
    given = [Fraction(x) for x in numbers("omega", omega0, 3)]
    attitude = numbers("quaternion", quaternion0, 4)
    rates = [sum((body.axes[i][k] * given[i] for i in range(3)), Fraction(0)) for k in range(3)]
    largest = max(map(abs, given))
    rates = [Fraction(0) if abs(x) * 2**_NEGLIGIBLE < largest else x for x in rates]
    exact = _differences(body.moments, rates)
    axes = None if body.given_axes else spread(_axes(body))
    return _prepared(spread(body.moments), spread(rates), spread(attitude), exact, axes)


def _differences(moments: Sequence[Number], omega: Sequence[Number]) -> list[float]:
    """Return I2 - I3, I3 - I1, I1 - I2 and the defect |L|^2 - 2 T I_mid, scaled as free_body.c takes it, as hi, lo."""
    i, shared = common(moments)
    w, _ = common(omega)
    found: list[float] = []
    for k in range(3):
        difference = i[(k + 1) % 3] - i[(k + 2) % 3]
        if abs(difference) << _NEGLIGIBLE < max(i[(k + 1) % 3], i[(k + 2) % 3]):
            difference = 0
        found += quotient(difference, shared)
    middle = sorted(i)[1]
    shares = [moment * (moment - middle) * rate * rate for moment, rate in zip(i, w, strict=True)]
    defect, largest = sum(shares), max(i) * max(map(abs, w))
    if abs(defect) << _NEGLIGIBLE < max(map(abs, shares)) or not largest:
        defect, largest = 0, 1
    return [*found, *quotient(defect, largest * largest)]


def _axes(body: Principal) -> list[Fraction]:
    """Return the matrix of the principal axes, row by row, and its quaternion (Shepperd's choice of the largest)."""
    r = body.axes
    trace = r[0][0] + r[1][1] + r[2][2]
    candidates = (
        (1 + trace, r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]),
        (r[2][1] - r[1][2], 1 + 2 * r[0][0] - trace, r[0][1] + r[1][0], r[2][0] + r[0][2]),
        (r[0][2] - r[2][0], r[0][1] + r[1][0], 1 + 2 * r[1][1] - trace, r[1][2] + r[2][1]),
        (r[1][0] - r[0][1], r[2][0] + r[0][2], r[1][2] + r[2][1], 1 + 2 * r[2][2] - trace),
    )
    best = max(candidates, key=lambda row: sum(x * x for x in row))
    norm = number.sqrt(sum((x * x for x in best), Fraction(0)))
    return [*(x for row in r for x in row), *(x / norm for x in best)]


def _functions() -> tuple[Any, Any, Any]:
    """Return prepare, evaluate and the type of the constants: those of the compiled library where there is one."""
    if not _bound:
        library = load("free_body")
        prepare, evaluate, length = (
            library.symrot_free_body_prepare, library.symrot_free_body_at, library.symrot_free_body_length
        )
        pointer, size = ctypes.c_void_p, ctypes.c_ssize_t
        prepare.argtypes, prepare.restype = (pointer,) * 6, ctypes.c_int
        evaluate.argtypes, evaluate.restype = (pointer, size, pointer, pointer, pointer), None
        length.restype = size
        _bound.append((prepare, evaluate, ctypes.c_double * length()))
    return _bound[0]


_bound: list[tuple[Any, Any, Any]] = []
_Six, _Eight = ctypes.c_double * 6, ctypes.c_double * 8
_Axes = ctypes.c_double * 26


def _prepared(
    moments: list[float], omega: list[float], attitude: list[float], exact: list[float] | None, axes: list[float] | None
) -> FreeBody:
    prepare, evaluate, record = _functions()
    constants = record()
    status = prepare(
        _Six(*moments), _Six(*omega), _Eight(*attitude), _Eight(*exact) if exact else None,
        _Axes(*axes) if axes else None, ctypes.addressof(constants),
    )
    if status == _DOMAIN:
        raise InputError(f"{_REFUSED}; got moments {moments[::2]}, omega {omega[::2]}, quaternion {attitude[::2]}")
    if status:
        raise CompilerError("the C compiler breaks error-free arithmetic: it must round every operation as written")
    return FreeBody(constants, evaluate)
