"""Curves over time: a band contains every sample, dashes mark what would hide another curve, and small noise is a line."""

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from symrot.report.curves import BAND_NOTE, draw_curves, envelope, hidden_parts, is_too_fast, size_in_pixels


def panel():
    return Figure(figsize=(6, 3), dpi=100).add_axes((0, 0, 1, 1))


def outside(t, values, band):
    """Return how many samples lie outside a band."""
    times, low, high = band
    return int(np.sum((values < np.interp(t, times, low)) | (values > np.interp(t, times, high))))


@pytest.mark.parametrize("seed", range(5))
def test_a_band_contains_every_sample_and_nothing_far_from_them(seed):
    """Uneven times, a changing amplitude and a gap in the times."""
    random = np.random.default_rng(seed)
    t = np.sort(random.uniform(0, 10, 5000))
    t = t[(t < 4) | (t > 6)]
    size = 1 + np.sin(t) ** 2
    values = size * np.sin(random.uniform(300, 900) * t) + 0.1 * random.normal(size=len(t))
    band = envelope(t, values, 400)
    assert outside(t, values, band) == 0
    assert band[0][0] == t[0] and band[0][-1] == t[-1]
    assert band[1].min() == values.min() and band[2].max() == values.max()
    narrow = (band[0], 0.9 * band[1], 0.9 * band[2])
    assert outside(t, values, narrow) > 0  # the check notices a band that is too narrow


def test_bins_hold_whole_periods_so_that_the_band_of_a_sine_is_flat():
    t = np.linspace(0, 1, 200_001)
    for periods in (310, 317.3, 5000):
        _, low, high = envelope(t, np.sin(2 * np.pi * periods * t), 900)
        assert np.allclose(high, 1, atol=0.02) and np.allclose(low, -1, atol=0.02)


def test_only_visible_oscillations_faster_than_the_pixels_are_bands():
    t = np.linspace(0, 1, 20_001)
    for periods, is_band in ((3, False), (50, False), (400, True), (2000, True)):
        assert is_too_fast(t, np.sin(2 * np.pi * periods * t), 900, 0.02) is is_band
    noise = 20 + 1e-15 * np.random.default_rng(1).normal(size=len(t))
    assert not is_too_fast(t, noise, 900, 0.02)
    axes = panel()
    draw_curves(axes, t, [noise], ["steady"])
    assert not [item for item in axes.collections if isinstance(item, PolyCollection)]


def test_a_curve_with_times_out_of_order_stays_a_line():
    t = np.linspace(1, 0, 20_001)
    axes = panel()
    draw_curves(axes, t, [np.sin(5000 * t)], ["sine"])
    assert not axes.collections and np.array_equal(axes.lines[0].get_ydata(), np.sin(5000 * t))


def test_equal_bands_differ_in_hatching_and_a_note_explains_them():
    t = np.linspace(0, 1, 20_001)
    axes = panel()
    draw_curves(axes, t, [np.sin(5000 * t), np.cos(5000 * t), t], ["sine", "cosine", "ramp"])
    bands = axes.collections
    assert [band.get_label() for band in bands] == ["sine", "cosine"]
    assert len({band.get_hatch() for band in bands}) == 2
    assert {"ramp", BAND_NOTE} <= {line.get_label() for line in axes.lines}


def test_a_curve_is_dashed_exactly_where_it_hides_an_earlier_one():
    t = np.linspace(0, 1, 1001)
    first = np.sin(6 * t)
    second = np.where(t < 0.5, first, first + (t - 0.5))
    crossing = 2 * t - 1
    axes = panel()
    axes.set_xlim(0, 1)
    draw_curves(axes, t, [first, second, crossing], ["first", "second", "crossing"])
    dashed = [line for line in axes.lines if line.is_dashed()]
    assert [line.get_label().strip("_") for line in dashed] == ["second"]
    shown = np.isfinite(dashed[0].get_ydata())
    assert shown[t < 0.5].all() and not shown[t > 0.56].any()
    parts = [line.get_ydata() for line in axes.lines if line.get_label().strip("_") == "second"]
    assert len(parts) == 2 and all(np.array_equal(part[np.isfinite(part)], second[np.isfinite(part)]) for part in parts)
    assert np.isfinite(parts).any(axis=0).all()


def test_the_size_of_a_pixel_decides_what_is_hidden():
    curves = [np.zeros(100), np.full(100, 0.01)]
    assert hidden_parts(curves, (900, 150), 1.0)[1].all()
    assert not hidden_parts(curves, (900, 1500), 1.0)[1].any()
    assert not hidden_parts([np.full(100, np.nan), curves[1]], (900, 150), 1.0)[1].any()


def test_an_unknown_curve_keeps_its_name_in_the_legend():
    axes = panel()
    draw_curves(axes, np.arange(4.0), [np.full(4, np.nan)], ["energy (no change)"])
    assert axes.get_legend_handles_labels()[1] == ["energy (no change)"]
    assert size_in_pixels(axes) == (900, 450)


@pytest.mark.parametrize("curve", [[3.0], [1.0, np.nan, 2.0], [np.nan, 5.0, np.nan, 1.0, 2.0]], ids=str)
def test_every_value_is_visible_on_a_line_or_as_a_point(curve):
    axes, values = panel(), np.array(curve)
    draw_curves(axes, np.arange(float(len(values))), [values], ["omega"])
    shown = set()
    for line in axes.lines:
        known = np.flatnonzero(np.isfinite(line.get_ydata()))
        x, y = line.get_xdata()[known], line.get_ydata()[known]
        joined = {place for place in known if place - 1 in known or place + 1 in known}
        shown |= {
            (float(a), float(b))
            for place, a, b in zip(known, x, y, strict=True)
            if place in joined or line.get_marker() == "."
        }
    assert shown == {(float(place), value) for place, value in enumerate(curve) if np.isfinite(value)}
    assert axes.get_legend_handles_labels()[1] == ["omega"]
