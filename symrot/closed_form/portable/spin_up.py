"""The motion of a symmetric body driven about its axis, computed by NumPy; the formulas are those of :file:`spin_up.h`.

The words resonance, sweep and rotating axes are explained in :mod:`symrot.closed_form.spin_up.motion`.
"""

from collections.abc import Callable, Sequence
from itertools import islice
from typing import Any

import numpy as np

from symrot.closed_form.arithmetic import double_double as dd
from symrot.closed_form.arithmetic.pairs import pair
from symrot.closed_form.build import Floats
from symrot.closed_form.spin_up.resonance import PIECES
from symrot.closed_form.spin_up.series import DEGREE
from symrot.formula import exact_numbers as number

__all__ = ["PortableSpinUp"]

_QUARTER = pair(1 / (4 * number.PI))
_TERMS = 10  # terms of the series of atanh, for arguments up to 1/60
_SMALL = 2.0**-5


def _atanh_ratio(x: dd.Pair) -> dd.Pair:
    """Return atanh(x)/x of small double-double numbers, by its power series."""
    square, total = dd.multiply(x, x), (np.zeros_like(x[0]), 0.0)
    for k in range(_TERMS, -1, -1):
        total = dd.add(dd.multiply(total, square), dd.divide((1.0, 0.0), (2.0 * k + 1.0, 0.0)))
    return total


def _asinh_ratio(z: dd.Pair, root: dd.Pair) -> dd.Pair:
    """Return asinh(z)/z of double-double numbers, where ``root`` is sqrt(1 + z^2).

    The value asinh(z) is halved repeatedly until its power series converges fast.
    """
    size = (np.abs(z[0]), np.where(z[0] < 0.0, -z[1], z[1]))
    small, above, times = size, dd.add(root, (1.0, 0.0)), np.ones_like(z[0])
    while (large := small[0] > _SMALL).any():
        halved = dd.divide(small, dd.square_root(dd.multiply((2.0, 0.0), above)))
        small = tuple(np.where(large, new, old) for new, old in zip(halved, small, strict=True))
        times = np.where(large, 2.0 * times, times)
        above = dd.add(dd.square_root(dd.add((1.0, 0.0), dd.multiply(small, small))), (1.0, 0.0))
    tau = dd.divide(small, above)
    whole = dd.multiply((2.0 * times, 0.0), dd.divide(_atanh_ratio(tau), above))
    shrunk = dd.divide(small, (np.where(size[0] == 0.0, 1.0, size[0]), size[1]))
    ratio = dd.multiply(whole, shrunk)
    return np.where(times == 1.0, whole[0], ratio[0]), np.where(times == 1.0, whole[1], ratio[1])


def _circle(turns: dd.Pair) -> tuple[Floats, Floats]:
    whole = (turns[0] - np.rint(turns[0])) + (turns[1] - np.rint(turns[1]))
    return np.sin(2.0 * np.pi * whole), np.cos(2.0 * np.pi * whole)


class PortableSpinUp:
    """The motion of a symmetric body driven about its axis, from its constants and a table of Taylor polynomials.

    ``constants`` come from :class:`symrot.closed_form.spin_up.integers.Integers`. The polynomials in ``table`` give the
    attitude near resonance: the time at which the rotating axes have the axial rate zero. ``table`` may be None if no
    sample is near resonance.
    """

    def __init__(self, constants: Sequence[float], table: Floats | None) -> None:
        values = iter(constants)

        def take(count: int) -> list[float]:
            return list(islice(values, count))

        def both() -> tuple[float, float]:
            return next(values), next(values)

        self._scale, self._edge, self._wide = take(3)
        self._turn, self._sweep = (both(), both()), (both(), both())
        self._across, self._inverse, self._unit = both(), both(), next(values)
        self._series = [np.array(take(DEGREE + 1)) for _ in range(3)]
        self._rates, self._axial = np.array(take(6)).reshape(3, 2), np.array(take(3))
        self._spin = both(), both()
        self._sides = [(both(), both(), next(values), np.array(take(16)).reshape(4, 4)) for _ in range(2)]
        self._near, self._table = np.array(take(16)).reshape(4, 4), table

    def evaluate(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        """Write the samples at ``times``, s, into ``omega`` (n, 3) and ``quaternion`` (n, 4).

        An array that is None is skipped.
        """
        t = (times * self._scale, np.zeros_like(times))
        sine, cosine = _circle(dd.multiply(t, dd.add(self._turn[0], dd.multiply(t, self._turn[1]))))
        if omega is not None:
            spin = dd.add(self._spin[0], dd.multiply(t, self._spin[1]))[0]
            turned = np.stack([(cosine - sine) * (cosine + sine), 2.0 * sine * cosine], axis=1)
            omega[:] = turned @ self._rates.T + np.multiply.outer(spin, self._axial)
        if quaternion is None:
            return
        here = dd.add(self._sweep[0], dd.multiply(t, self._sweep[1]))
        close = (np.abs(here[0]) < self._edge) & (self._wide == 0.0)
        upper = (here[0] > 0.0) & (self._wide == 0.0)
        ways: list[tuple[Any, Callable[..., tuple[Any, Any]], Floats]] = [(close, self._near_resonance, self._near)]
        for k, chosen in enumerate((~upper & ~close, upper & ~close)):
            ways.append((chosen, lambda t, here, k=k: self._off_resonance(self._sides[k], t, here), self._sides[k][3]))
        for chosen, way, mapping in ways:
            if chosen.any():
                a, b = way(*((x[0][chosen], x[1][chosen]) for x in (t, here)))
                turn = cosine[chosen] + 1j * sine[chosen]
                a, b = a * turn.conj(), b * turn
                quaternion[chosen] = np.stack([a.real, b.real, b.imag, a.imag], axis=1) @ mapping.T

    def _off_resonance(self, side: Any, t: dd.Pair, omega: dd.Pair) -> tuple[Any, Any]:
        """Return (q0 + i q3, q1 + i q2) of an attitude at times t far from resonance, by the asymptotic series.

        The attitude is that of axes that rotate with the transverse angular velocity; ``omega`` is their axial rate at
        these times, which is zero at resonance. ``side`` has the motion's constants before resonance or after it.
        """
        # the formulas are in symrot.closed_form.spin_up.motion
        time, start, delta, _ = side
        square = dd.multiply(self._across, self._across)
        here, there = (dd.add(dd.multiply(x, x), square) for x in (omega, start))
        speed, product = dd.square_root(here), dd.multiply(omega, start)
        speeds = dd.multiply(speed, dd.square_root(tuple(np.array([x]) for x in there)))  # type: ignore[arg-type]
        opposed = dd.multiply(square, dd.add(here, dd.multiply(start, start)))
        other = product[0] < 0.0
        apart = dd.subtract(speeds, (-np.abs(product[0]), np.where(other, product[1], -product[1])))
        ratio = dd.divide(opposed, apart)
        together = np.where(other, ratio[0], apart[0]), np.where(other, ratio[1], apart[1])
        middle = dd.square_root(dd.multiply((0.5, 0.0), dd.add(square, together)))
        half = dd.multiply((0.5, 0.0), dd.divide(dd.subtract(t, time), middle))
        z = dd.multiply(self._sweep[1], half)
        root = dd.square_root(dd.add((1.0, 0.0), dd.multiply(z, z)))
        steady = dd.add(dd.multiply(root, together), dd.multiply(square, _asinh_ratio(z, root)))
        r = 1.0 / speed[0]
        across, along = self._across[0] * r, omega[0] * r
        y = self._unit * r * r
        g, c, e = (np.polynomial.polynomial.polyval(y, series) for series in self._series)
        m1, m2 = across * along * y * y * g, across * y * c
        more = (along * e - delta) * _QUARTER[0]
        sine, cosine = _circle(dd.add(dd.multiply(dd.multiply(half, steady), _QUARTER), (more, 0.0)))
        m3 = 1.0 + np.sqrt(1.0 - m1 * m1 - m2 * m2)
        norm = 1.0 / np.sqrt(m3 * m3 + m1 * m1 + m2 * m2)
        n0, n1, n2 = m3 * norm, m1 * norm, m2 * norm
        larger = np.sqrt(0.5 + 0.5 * np.abs(along))
        smaller = 0.5 * across / larger
        first, second = np.where(along >= 0.0, [larger, smaller], [smaller, larger])
        turn = cosine + 1j * sine
        return (
            turn * ((n0 * first - n1 * second) - 1j * (n2 * second)),
            turn * (n2 * first - 1j * (n0 * second + n1 * first)),
        )

    def _near_resonance(self, _: dd.Pair, omega: dd.Pair) -> tuple[Any, Any]:
        """Return (q0 + i q3, q1 + i q2) of an attitude near resonance, by Taylor polynomials.

        The attitude is that of axes that rotate with the transverse angular velocity; ``omega`` is their axial rate,
        which is zero at resonance.
        """
        # Taylor polynomials in x = Omega/sqrt(s) give the rotation since resonance (x = 0)
        assert self._table is not None
        sign = np.where(omega[0] < 0.0, -1.0, 1.0)
        high, low = dd.multiply((sign * omega[0], sign * omega[1]), self._inverse)
        piece = np.minimum(np.floor(high * PIECES), len(self._table) - 1)  # the right end belongs to the last interval
        rest = (high - (piece + 0.5) / PIECES) + low
        terms = self._table[piece.astype(np.int64)]
        q = terms[:, -1]
        for n in range(terms.shape[1] - 2, -1, -1):
            q = q * rest[:, None] + terms[:, n]
        return q[:, 0] + 1j * q[:, 3], sign * (q[:, 1] + 1j * q[:, 2])
