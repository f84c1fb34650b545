"""Drawing of curves over time in one panel: fast oscillations become a filled band, overlapping curves are dashed.

Lengths in a panel are counted in pixels of 1/150 inch, as a figure is printed.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.report.picture import COLOURS

__all__ = ["BAND_NOTE", "PIXELS_PER_INCH", "draw_curves", "envelope", "hidden_parts", "is_too_fast", "size_in_pixels"]

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

PIXELS_PER_INCH = 150  # of a printed figure
LEAST_PER_PERIOD = 5.0  # pixels: a faster oscillation would be a solid block and is drawn as a band
PERIODS_IN_BIN = 2.0  # a bin that holds whole periods contains their extremes
WIDTHS = (2.0, 1.6, 1.2, 0.9)  # points: later curves are thinner and drawn on top, so that close curves stay visible
NEAR = 2.5  # pixels: a curve this close to an earlier one hides it
LONG = 0.04  # fraction of the panel: shorter overlaps are mere crossings
DASH = 5.0  # points
ROUNDING = 1e-9  # smaller changes of a curve, relative to its size, are rounding errors
HATCHES = ("", "///", "\\\\\\", "...")  # later bands are hatched, so that equal bands all stay visible
BAND_NOTE = "filled: least to greatest"


def size_in_pixels(axes: Any) -> tuple[float, float]:
    """Return the width and the height of matplotlib axes, in pixels of 1/150 inch."""
    box, dpi = axes.get_window_extent(), axes.figure.dpi
    return PIXELS_PER_INCH * box.width / dpi, PIXELS_PER_INCH * box.height / dpi


def _turns(values: Floats) -> int:
    """Return the number of turning points of a curve, at which it changes between rising and falling."""
    slopes = np.sign(np.diff(values))
    slopes = slopes[slopes != 0]
    return int(np.count_nonzero(np.diff(slopes)))


def is_too_fast(t: Floats, values: Floats, width: float, visible: float) -> bool:
    """Return whether a curve oscillates too fast to be drawn as a line.

    Parameters
    ----------
    t, values : arrays, shape (n,)
        Times in increasing order, and the values of the curve there.
    width : float
        The width of the panel in pixels.
    visible : float
        The least change that can be seen, in the unit of the values; smaller oscillations, such as rounding errors, do
        not count.
    """
    if 0.5 * _turns(values) * LEAST_PER_PERIOD <= width:
        return False
    _, low, high = envelope(t, values, width)
    return bool(np.median(high - low) > visible)


def envelope(t: Floats, values: Floats, width: float) -> tuple[Floats, Floats, Floats]:
    """Return the band, lower and upper bound, that is drawn instead of a curve that oscillates too fast for a line.

    Parameters
    ----------
    t, values : arrays, shape (n,)
        Times in increasing order, and the values of the curve there.
    width : float
        The width of the panel in pixels. The band is computed from the least and the greatest value in each bin of
        time; a bin is at least one pixel wide and holds about two periods of the curve.

    Returns
    -------
    tuple of 3 arrays, shape (m,)
        Times, and the lower and the upper bound there; between the times both bounds are straight lines. No sample lies
        outside the band.
    """
    periods = max(0.5 * _turns(values), 1.0)
    count = int(max(1, min(width, periods / PERIODS_IN_BIN, len(t) // 2)))
    edges = np.linspace(t[0], t[-1], count + 1)
    starts = np.searchsorted(t, edges[:-1], side="left")
    starts, places = np.unique(starts, return_index=True)  # a bin without samples joins the one after it
    edges = np.append(edges[places], t[-1])
    bounds = []
    for reduction in (np.minimum, np.maximum):
        inside = reduction.reduceat(values, starts)
        following = np.append(inside[1:], inside[-1])
        bounds.append(np.concatenate([inside[:1], reduction(inside, following)]))
    return edges, bounds[0], bounds[1]


def hidden_parts(curves: Sequence[Floats], size: tuple[float, float], height: float) -> list[Mask]:
    """Return one mask for each curve: True where the curve would hide an earlier one and is drawn dashed instead.

    Parameters
    ----------
    curves : sequence of arrays, shape (n,)
        The curves at the same evenly spaced times, in the order in which they are drawn; NaN where one is interrupted.
    size : tuple of 2 floats
        Width and height of the panel in pixels.
    height : float
        Height of the panel in the unit of the curves.
    """
    parts = []
    for number, curve in enumerate(curves):
        hidden = np.zeros(len(curve), dtype=bool)
        for earlier in curves[:number]:
            with np.errstate(invalid="ignore"):
                near = np.abs(curve - earlier) * size[1] <= NEAR * height
            hidden |= _long_runs(near, LONG)
        parts.append(hidden)
    return parts


def _long_runs(mask: Mask, fraction: float) -> Mask:
    """Return ``mask`` without short runs of True: single ones, and those shorter than ``fraction`` of its length."""
    steps = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    long = np.zeros(len(mask), dtype=bool)
    for start, stop in steps.reshape(-1, 2):
        long[start:stop] = stop - start >= max(2.0, fraction * len(mask))
    return long


def _pieces(values: Floats, hidden: Mask) -> Iterator[tuple[Floats, bool]]:
    """Yield the hidden and the other part of a curve, the longer first, as pairs (values, whether the part is hidden).

    ``hidden`` is True where the curve hides an earlier one. Values outside the part are NaN; an empty part is left out.
    """
    grown = hidden.copy()  # both parts share their end points, so that the curve has no gaps
    grown[1:] |= hidden[:-1]
    grown[:-1] |= hidden[1:]
    parts = [(np.where(grown, values, np.nan), True), (np.where(hidden, np.nan, values), False)]
    parts.sort(key=lambda part: -np.count_nonzero(np.isfinite(part[0])))
    return (part for part in parts if np.isfinite(part[0]).any())


def draw_curves(axes: Any, t: Floats, curves: Sequence[Floats], names: Sequence[str], colours: Sequence[str] = COLOURS,
                widths: Sequence[float] = WIDTHS) -> None:  # fmt: skip
    """Draw curves over the times ``t`` and label them; NaN interrupts a curve.

    The scale of the axes must be set before.
    """
    size = size_in_pixels(axes)
    scale = np.log10 if axes.get_yscale() == "log" else np.asarray
    heights = [scale(curve) for curve in curves]
    extremes = [(np.nanmin(curve), np.nanmax(curve)) for curve in heights if np.isfinite(curve).any()]
    height = max((high for _, high in extremes), default=1.0) - min((low for low, _ in extremes), default=0.0)
    height = max(height, ROUNDING * max((max(abs(low), abs(high)) for low, high in extremes), default=0.0))
    # faster than the pixels: a band between the extremes
    fast = [_is_band(t, curve, size, height) for curve in heights]
    slow = [number for number in range(len(curves)) if not fast[number]]
    hidden = hidden_parts([heights[number] for number in slow], size, 1.1 * height or 1.0)
    parts = dict(zip(slow, hidden, strict=True))
    for number, (curve, name) in enumerate(zip(curves, names, strict=True)):
        colour, width = colours[number % len(colours)], widths[min(number, len(widths) - 1)]
        if fast[number]:
            _draw_band(axes, t, curve, name, size[0], colour, HATCHES[sum(fast[:number]) % len(HATCHES)])
            continue
        if not np.isfinite(curve).any():
            axes.plot([], [], " ", label=name)
            continue
        dashes = (0, (DASH / width, (DASH + number) / width))
        label = name
        for part, is_hidden in _pieces(curve, parts[number]):
            axes.plot(t, part, color=colour, linewidth=width, label=label, linestyle=dashes if is_hidden else "-",
                      dash_capstyle="butt")  # fmt: skip
            label = f"_{name}"  # an underscore keeps the second part out of the legend
        lonely = _lonely(curve)
        if lonely.any():
            axes.plot(t[lonely], curve[lonely], ".", color=colour, label=f"_{name}")
    if any(fast):
        axes.plot([], [], " ", label=BAND_NOTE)
    axes.grid(True)


def _lonely(values: Floats) -> Mask:
    """Return a mask of the values of a curve without a neighbour that is finite; no line shows them."""
    known = np.pad(np.isfinite(values), 1)
    lonely: Mask = known[1:-1] & ~known[:-2] & ~known[2:]
    return lonely


def _is_band(t: Floats, curve: Floats, size: tuple[float, float], height: float) -> bool:
    """Return whether a curve oscillates too fast for a line, so that a band between its envelopes is drawn."""
    # size: width and height of the panel in pixels (size_in_pixels); height: the range of values that it shows
    known = np.isfinite(curve)
    if np.count_nonzero(known) < 3 or np.any(np.diff(t) < 0):
        return False
    return is_too_fast(t[known], curve[known], size[0], 2.0 * NEAR * height / size[1])


def _draw_band(axes: Any, t: Floats, curve: Floats, name: str, width: float, colour: Any, hatch: str) -> None:
    from matplotlib.colors import to_rgba

    known = np.isfinite(curve)
    times, low, high = envelope(t[known], curve[known], width)
    face = "none" if hatch else to_rgba(colour, 0.3)
    axes.fill_between(times, low, high, facecolor=face, edgecolor=colour, linewidth=0.8, hatch=hatch, zorder=1.8,
                      label=name)  # fmt: skip
