"""The plot page of a motion: it shows the quantities of the motion, in every format, with the same bytes each time."""

import importlib.util
import sys
import tomllib

import numpy as np
import pytest

import symrot
from symrot.cli import main as cli
from symrot.scene.scene import Scene

pytest.importorskip("matplotlib")

from matplotlib import pyplot
from matplotlib.figure import Figure

from symrot.report import plot, sphere

STARTS = {".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}

SCENE = """
schema = 1
title = "Costs $5 \\\\ or less"
[body]
{body}
[initial]
omega = {omega}
[span]
t = [0, 2]
samples = 3
[output]
quantities = {quantities}
"""


@pytest.mark.thinned(2)
@pytest.mark.parametrize("suffix", plot.SUFFIXES)
def test_pages_are_the_same_twice_and_name_no_date(tmp_path, capsys, suffix):
    pages = []
    for name in ("one", "two"):
        path = tmp_path / f"{name}{suffix}"
        assert cli.main(["run", "tumbling_prism", "--plot", str(path)]) == 0
        pages.append(path.read_bytes())
    assert pages[0] == pages[1] and pages[0].startswith(STARTS[suffix]) and len(pages[0]) > 20_000
    assert b"CreationDate" not in pages[0] and b"<dc:date>" not in pages[0]


@pytest.mark.parametrize(("scene", "titles"), [
    ("tumbling_prism", ["Angular velocity", "Attitude, quaternion", "Drift", "Body axis 3", "Angular momentum"]),
    ("heavy_top_loops", ["Angular velocity", "Euler angles ZXZ, intrinsic", "Centre of mass", "Drift", "Symmetry axis", "Axis of rot"]),
])  # fmt: skip
def test_panels_and_their_units(scene, titles):
    motion = symrot.propagator(scene)()
    page = plot.figure(motion)
    found = [panel.get_title(loc="left") or panel.get_title() for panel in page.axes]
    assert all(any(one.startswith(title) for one in found) for title in titles)
    over_time = [panel for panel in page.axes if panel.get_xlabel() == "t (s)"]
    assert len(over_time) == len(titles) - 2 and all(panel.get_ylabel() for panel in over_time)
    drawn = [line for line in over_time[0].lines if len(line.get_xdata()) == len(motion)]
    for number in range(3 if scene == "tumbling_prism" else 2):
        parts = [line.get_ydata() for line in drawn if line.get_label().strip("_") == rf"$\omega_{number + 1}$"]
        together = np.where(np.isfinite(parts[0]), parts[0], parts[-1])  # visible and hidden part of one curve
        assert np.array_equal(together, motion.omega[:, number])


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("body", "omega", "quantities"), [
    ("principal = [1, 2, 2.5]", "[0.1, 1, 0.1]", '["omega"]'),
    ("principal = [1, 1, 1]", "[0.1, 1, 0.1]", '["quaternion"]'),
    ("principal = [1, 2, 2.5]", "[0, 0, 0]", '["quaternion"]'),
    ("principal = [1, 2, 2.5]", "[0, 0, 1]", '["quaternion"]'),
    ("inertia = {xx = 2, yy = 3, zz = 4, xy = 0.3}", "[0.1, 1, 0.1]", '["energy"]'),
    ("principal = [1, 1, 2]", "[1e-6, 0, 1]", '["axis"]'),
], ids=["no attitude", "spherical", "at rest", "one axis", "products", "small cone"])  # fmt: skip
def test_plain_motions_can_be_drawn(tmp_path, capsys, recwarn, body, omega, quantities):
    scene, path = tmp_path / "scene.toml", tmp_path / "page.png"
    scene.write_text(SCENE.format(body=body, omega=omega, quantities=quantities))
    assert cli.main(["run", str(scene), "--plot", str(path)]) == 0, capsys.readouterr().err
    assert path.read_bytes().startswith(STARTS[".png"])
    assert not [str(warning.message) for warning in recwarn]


def test_a_motion_with_one_sample_can_be_drawn(tmp_path, recwarn):
    """A motion that stops before its second sample."""
    motion = symrot.propagate("tumbling_prism", t=[0])
    plot.save(motion, tmp_path / "page.png")
    assert not [str(warning.message) for warning in recwarn]
    points = [line for line in symrot.plot(motion, Figure().add_subplot()).lines if line.get_marker() == "."]
    assert [line.get_ydata().tolist() for line in points] == [[value] for value in motion.omega[0]]


def test_no_window_and_no_global_figure(tmp_path, capsys):
    assert cli.main(["run", "tumbling_prism", "--plot", str(tmp_path / "page.png")]) == 0
    assert "matplotlib.pyplot" not in sys.modules or not sys.modules["matplotlib.pyplot"].get_fignums()


def test_missing_matplotlib_is_one_sentence(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(plot, "find_spec", lambda name: None)
    assert importlib.util.find_spec("matplotlib") is not None
    assert cli.main(["run", "tumbling_prism", "--plot", str(tmp_path / "page.png")]) == 2
    assert "symrot[plot]" in capsys.readouterr().err and not any(tmp_path.iterdir())


@pytest.mark.parametrize(("size", "expected"), [
    (20.0, (1.0, "rad/s")), (0.15, (1.0, "rad/s")), (2e-3, (1e-3, "mrad/s")), (7e-11, (1e-12, "prad/s")),
    (0.0, (1.0, "rad/s")), (1e-30, (1e-12, "prad/s")),
])  # fmt: skip
def test_units_suit_small_numbers(size, expected):
    assert sphere.prefixed(size, "rad/s") == expected


def test_each_panel_is_drawn_into_axes_as_on_the_page():
    motion = symrot.propagate("heavy_top_loops")
    titles = {panel.get_title(loc="left") or panel.get_title() for panel in plot.figure(motion).axes}
    for name in plot.PANELS:
        axes = Figure().add_subplot()
        assert motion.plot(ax=axes, panel=name) is axes
        title = axes.get_title(loc="left") or axes.get_title()
        assert title in titles
        titles.remove(title)
        assert (axes.get_xlabel() == "t (s)") == (name in plot.OVER_TIME)
    assert not titles


def test_a_panel_without_axes_gets_a_figure_of_pyplot():
    axes = symrot.propagate("t_handle").plot()
    assert (
        pyplot.get_fignums()
        and axes.figure is pyplot.gcf()
        and {"$\\omega_1$", "$\\omega_2$", "$\\omega_3$"} <= {line.get_label() for line in axes.lines}
    )
    pyplot.close(axes.figure)


def test_panels_that_cannot_be_drawn_are_refused_in_a_sentence():
    motion = symrot.propagate("t_handle")
    with pytest.raises(
        symrot.InputError, match="panel: expected one of rates, attitude, vertical, drift, space, body, got 'x'"
    ):
        motion.plot(panel="x")
    with pytest.raises(symrot.InputError, match="plot: expected a trajectory with samples"):
        motion.at([]).plot()
    scene = Scene.from_dict(
        tomllib.loads(SCENE.format(body="principal = [1, 2, 3]", omega="[1, 0.1, 1]", quantities='["omega"]'))
    )
    with pytest.raises(symrot.InputError, match="the attitude was not computed"):
        symrot.propagate(scene).plot(panel="space")
    with pytest.raises(symrot.InputError, match=r"panel: expected for .vertical. a scene with exactly one torque"):
        motion.plot(panel="vertical")
    assert not pyplot.get_fignums()
    assert symrot.propagator("t_handle")([1.0]).plot(Figure().add_subplot(), "rates").get_xlabel() == "t (s)"


def test_ticks_of_whole_rotations_and_letters_of_names():
    """Angles that go all the way round have ticks at multiples of 90 degrees; omega_3 is a letter with an index."""
    top = symrot.propagate("heavy_top_loops")
    assert symrot.plot(top, Figure().add_subplot(), "attitude").get_yticks().tolist() == [-180, -90, 0, 90, 180]
    texts = [text.get_text() for text in symrot.plot(top, Figure().add_subplot(), "drift").get_legend().get_texts()]
    assert any(text.startswith(r"spin $\omega_3$") for text in texts)


def test_a_constant_component_is_written_in_a_unit_of_its_own():
    """The Earth's spin is 72.9 microradians a second, however small the wobble in the same panel."""
    axes = symrot.plot(symrot.propagate("earth_wobble"), Figure().add_subplot(), "rates")
    assert any("72.9211 \N{GREEK SMALL LETTER MU}rad/s" in text.get_text() for text in axes.get_legend().get_texts())
