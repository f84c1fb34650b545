"""Motions by any method as piecewise polynomials in time, for the search for events.

A *row* is an array with the polynomials of all states in one step, in powers of ``(time - t)/unit``. It begins with
four numbers: t, the start of the step (in a fitted row its middle), the length of the step, the digits of the time that
do not fit into t, and the unit, a time. Then follow coefficient 0 of all states, coefficient 1 of all states, and so
on. An *edge* is the time at which two rows meet.
"""

import math
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import PropagationError
from symrot.propagation.steppers.stepping import Integration

__all__ = ["HEAD", "Piece", "fitted", "fitted_pieces", "rows_of", "stepped"]

Floats = NDArray[np.float64]

HEAD = 4  # numbers before the coefficients of a row
POINTS = 21  # coefficients of a fit, whose degree is one less
EPS = float(np.finfo(float).eps)
NOISE = 16.0  # units in the last place: assumed error of a motion's samples
ROUGH = 1e-9  # relative: a fit that is off by more does not follow the motion
SURE, HALVINGS = 6, 40  # halvings of a piece: after SURE of them accuracy ROUGH is enough; HALVINGS is the limit
MOST_PIECES = 20_000  # halves of pieces that one call may make by cutting the motion
FEWEST, MOST = 16, 1024  # pieces fitted at a time


# Steps of the Taylor stepper are such rows (taylor.c). The dense output of DOP853 is converted to rows, exact up to
# rounding. Any other motion is interpolated at Chebyshev points, on intervals that are halved until polynomial and
# motion agree up to rounding.
class Piece(NamedTuple):
    """Consecutive polynomials of a motion: row i, one polynomial per state, is valid from edge i to edge i + 1, s.

    The edges are in the order of the motion: they decrease if it runs backward in time.
    """

    edges: Floats
    rows: Floats


def rows_of(stepper: Any, record: Floats) -> Floats:
    """Return the recorded steps of a stepper (Taylor or DOP853) as rows of polynomial coefficients, one per step."""
    if stepper.name == "taylor":
        # the layout of a row, see the top of this file
        return record
    count = len(record)
    terms = record[:, 2:].reshape(count, -1, stepper.states)
    rows = np.empty((count, HEAD + terms[0].size if count else HEAD))
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3] = record[:, 0], record[:, 1], 0.0, record[:, 1]
    if count:
        rows[:, HEAD:] = np.einsum("mk,nki->nmi", _nested(terms.shape[1]), terms).reshape(count, -1)
    return rows


def stepped(
    integration: Integration, end: float, broken: list[PropagationError], records: list[Floats]
) -> Generator[Piece, None, None]:
    """Integrate a motion from its start to ``end``, s, and yield its polynomials in groups of steps.

    The recorded steps are appended to ``records``. If the motion stops early, the error is appended to ``broken``.
    """
    room = integration.stepper.rows_per_call
    with closing(integration.runs(end)) as runs:
        for run in runs:
            while run.t != run.stop:
                rows = np.empty((room, integration.stepper.row))
                try:
                    integration.advance(run, None, 0, None, rows.ctypes.data, room)
                except PropagationError as error:
                    broken.append(error)
                rows = rows[: run.recorded]
                if len(rows):
                    records.append(rows)
                    yield Piece(np.append(rows[:, 0], run.t), rows_of(integration.stepper, rows))
                if broken:
                    return


@cache
def _nested(terms: int) -> Floats:
    """Return the matrix that turns coefficients of DOP853's dense output into ``terms`` coefficients of powers of s.

    s is the fraction of the step: 0 at the start, 1 at the end.
    """
    # dense output is a sum of the functions 1, s, s r, s^2 r, s^2 r^2, .., with r = 1 - s
    matrix = np.zeros((terms, terms))
    power = np.zeros(terms)
    power[0] = 1.0
    for k in range(terms):
        matrix[:, k] = power
        shifted = np.roll(power, 1)
        shifted[0] = 0.0
        power = shifted if k % 2 == 0 else power - shifted
    return matrix


@cache
def _chebyshev() -> tuple[Floats, Floats, Floats]:
    """Return the Chebyshev points on [-1, 1], and matrices from values to Chebyshev series and to powers."""
    from numpy.polynomial import chebyshev

    angles = (np.arange(POINTS) + 0.5) * (math.pi / POINTS)
    to_series = np.cos(np.outer(np.arange(POINTS), angles)) * (2.0 / POINTS)
    to_series[0] *= 0.5
    to_powers = np.zeros((POINTS, POINTS))
    for k, unit in enumerate(np.eye(POINTS)):
        to_powers[: k + 1, k] = chebyshev.cheb2poly(unit[: k + 1])
    # shapes (21,), (21, 21), (21, 21); the second matrix takes the result of the first
    return np.cos(angles), to_series, to_powers


CHECKS = np.array([-1.0, -0.9037, -0.1618, 0.6543, 1.0])  # points on [-1, 1] at which a fit is compared with the motion


def fitted(
    states: Callable[[Floats], Floats], edges: Floats, blocks: Sequence[int], scales: Sequence[float], depth: int = 0,
    left: list[int] | None = None, accuracy: float | Floats = 0.0,
) -> Piece:  # fmt: skip
    """Return polynomials that approximate a motion between successive times ``edges``; more edges are added if needed.

    They agree with the motion usually up to rounding errors, and at least to 1e-9 of the states plus ``accuracy``,
    except on an interval that cannot be halved further because its ends are adjacent doubles.

    Parameters
    ----------
    states : function
        Takes times, shape (n,), returns states, shape (n, N).
    edges : array, shape (k + 1,)
        Times, s, increasing or decreasing.
    blocks : sequence of int
        Edges of the blocks of states (omega, attitude): block k consists of the states from edge k up to edge k + 1.
    scales : sequence of float
        For each block, the least size to which its errors are relative: 1 for a quaternion, 0 for omega.
    depth, left : int, list of int
        For recursive calls: the number of halvings so far, and a list of one number, from which each call subtracts the
        number of its polynomials. An error is raised if the number becomes negative.
    accuracy : float
        Error of the motion itself, relative to the largest values of the states between the edges. Where the steps of
        the motion do not join exactly, no fit can be closer. Recursive calls pass one error per state.

    Raises
    ------
    PropagationError
        If even the shortest allowed interval cannot be fitted, or if too many intervals are needed.
    """
    left = [MOST_PIECES + len(edges)] if left is None else left
    left[0] -= len(edges) - 1
    if left[0] < 0:
        raise PropagationError(
            f"events: expected a motion that piecewise polynomials can approximate, but {MOST_PIECES} pieces were not "
            f"enough near t = {float(edges[0])!r} s"
        )
    points, to_series, to_powers = _chebyshev()
    half, centre = 0.5 * np.diff(edges), edges[:-1] + 0.5 * np.diff(edges)
    at = np.concatenate([points, CHECKS])
    times = centre[:, None] + half[:, None] * at
    times[:, POINTS], times[:, -1] = edges[:-1], edges[1:]
    values = states(times.ravel()).reshape(len(half), len(at), -1)
    count = values.shape[2]
    series = np.einsum("kp,npi->nki", to_series, values[:, :POINTS])
    size = np.empty((len(half), count))
    for (low, high), scale in zip(pairwise(blocks), scales, strict=True):
        largest = np.abs(values[:, :, low:high]).max(axis=(1, 2))
        size[:, low:high] = np.maximum(largest, scale)[:, None]
    if depth == 0:
        accuracy = accuracy * size.max(axis=0)
    rate = np.abs(values[:, :, : blocks[1]]).max(axis=(1, 2)) if scales[0] == 0.0 else np.zeros(len(half))
    doubt = EPS * (NOISE + rate * np.abs(times).max(axis=1))[:, None] * size  # a phase is as inaccurate as the time
    series[np.abs(series) < 0.25 * EPS * size[:, None, :]] = 0.0  # outside [-1, 1] rounding errors would grow
    powers = np.einsum("mk,nki->nmi", to_powers, series)
    slope = np.abs(powers[:, 1]) / np.abs(half)[:, None]
    doubt = doubt + EPS * np.abs(times).max(axis=1)[:, None] * slope  # the time itself is rounded
    check = np.einsum("cm,nmi->nci", CHECKS[:, None] ** np.arange(POINTS), powers)
    off = np.maximum(np.abs(check - values[:, POINTS:]).max(axis=1), np.abs(series[:, -3:]).max(axis=1))
    bad = ~(off <= 4.0 * doubt).all(axis=1)
    rows = np.empty((len(half), HEAD + POINTS * count))
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3] = centre, 2.0 * half, 0.0, half
    rows[:, HEAD:] = powers.reshape(len(half), -1)
    if not bad.any():
        return Piece(edges, rows)
    if depth == HALVINGS:
        if not (off <= ROUGH * size + accuracy).all():
            t = float(edges[int(bad.argmax())])
            raise PropagationError(
                "events: expected a motion that piecewise polynomials can approximate, but it is not smooth near "
                f"t = {t!r} s"
            )
        return Piece(edges, rows)
    # if one polynomial cannot fit the motion between two edges, the interval is halved
    parts, ends = [], [edges[:1]]
    for i in range(len(half)):
        piece = Piece(edges[i : i + 2], rows[i : i + 1])
        middle = float(centre[i])
        if (
            bad[i]
            and (depth < SURE or (off[i] > ROUGH * size[i] + accuracy).any())
            and middle not in (edges[i], edges[i + 1])
        ):
            piece = fitted(
                states, np.array([edges[i], middle, edges[i + 1]]), blocks, scales, depth + 1, left, accuracy
            )
        parts.append(piece.rows)
        ends.append(piece.edges[1:])
    return Piece(np.concatenate(ends), np.concatenate(parts))


def fitted_pieces(
    states: Callable[[Floats], Floats],
    start: float,
    end: float,
    longest: float,
    blocks: Sequence[int],
    scales: Sequence[float],
) -> Generator[Piece, None, None]:
    """Yield polynomials that approximate a motion from ``start`` to ``end``, s, as closely as those of :func:`fitted`.

    ``states`` is the motion: a function that takes n times, s, and returns the states, shape (n, N). ``longest``, s, is
    a first guess of the length of the interval in which one polynomial is accurate. The arguments ``blocks`` and
    ``scales`` are those of :func:`fitted`.
    """
    side, t, most, count = math.copysign(1.0, end - start), start, 8.0 * longest, FEWEST
    while t != end:
        edges = t + side * longest * np.arange(count + 1)
        if (end - edges[-1]) * side <= 0.01 * longest:
            edges = np.append(edges[(end - edges) * side > 0.01 * longest], end)
        edges = edges[np.concatenate([[True], np.diff(edges) != 0.0])]
        piece = fitted(states, edges, blocks, scales)
        yield piece
        if len(piece.rows) > 1.5 * (len(edges) - 1):
            longest *= 0.5
        elif len(piece.rows) == len(edges) - 1 and not piece.rows[:, -5 * len(states(edges[:1])[0]) :].any():
            longest = min(1.25 * longest, most)
        # the number of polynomials doubles: first events come after little work, long motions take few calls
        t, count = float(edges[-1]), min(2 * count, MOST)
