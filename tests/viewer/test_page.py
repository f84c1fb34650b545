"""Pages that move: one file without links, which runs in a browser and says how far it can be trusted."""

import base64
import json
import re

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from symrot.scene.scene import Scene
from symrot.viewer import film
from symrot.viewer.body_surface import patches
from symrot.viewer.page import page
from tests.viewer.browser import BROWSER, Browser

needs_browser = pytest.mark.skipif(BROWSER is None, reason="needs Chromium")


@pytest.fixture(scope="module")
def browser():
    """A browser for all tests of this file."""
    with Browser() as running:
        yield running


def scene_of(body, **more):
    content = {
        "schema": 1, "title": "test", "body": body, "initial": {"omega": [0.1, 0.2, 3]},
        "span": {"t": [0, 2], "samples": 5}, "output": {"quantities": ["omega"]},
    }  # fmt: skip
    return Scene.from_dict(content | more)


def text_of(browser, name):
    return browser.evaluate(f"document.getElementById('{name}').textContent")


@needs_browser
def test_a_page_agrees_with_symrot_in_a_browser(browser, tmp_path):
    browser.open(symrot.show("heavy_top_loops", tmp_path / "page.html"))
    agreement = re.search(r"Agrees with the motion that symrot computed to ([\d.e-]+)\.", text_of(browser, "trust"))[1]
    assert float(agreement) < 1e-12
    assert text_of(browser, "time") == "t = 0.000 s"
    assert browser.errors == []


@needs_browser
def test_a_browser_plays_a_motion_that_symrot_computed(browser, tmp_path):
    browser.open(symrot.show("friction_wheel", tmp_path / "page.html"))
    assert "plays the motion" in text_of(browser, "played")
    assert browser.errors == []


@needs_browser
def test_the_last_motion_is_shown_while_the_next_is_computed(browser, tmp_path):
    """A slider of a long motion does not stop the page: frames and keys go on, and the new motion comes at last."""
    scene = scene_of({"principal": [1, 2, 2.5]}, span={"t": [0, 300], "samples": 5})
    browser.open(symrot.show(scene, tmp_path / "page.html"))
    old = browser.evaluate("symrot.first.energy")
    shown = browser.evaluate(
        "symrot.change('omega_3', 3.5), symrot.seek(1), [symrot.job !== null, symrot.state.energy]"
    )
    assert shown == [True, pytest.approx(old)]
    browser.wait("!symrot.job")
    assert browser.evaluate("symrot.first.energy") == pytest.approx((0.1**2 + 2 * 0.2**2 + 2.5 * 3.5**2) / 2)
    assert browser.evaluate("symrot.frames") > 1
    assert browser.errors == []


@needs_browser
def test_a_moment_beyond_the_sum_of_the_others_is_limited_and_the_body_is_stretched(browser, tmp_path):
    browser.open(symrot.show(scene_of({"shape": "box", "a": 1, "b": 2, "c": 3, "mass": 12}), tmp_path / "page.html"))
    browser.evaluate("symrot.change('A', 100)")
    browser.wait("!symrot.job")
    assert browser.evaluate("symrot.model.constants.A") == 10 + 5
    assert "A = 15 kg m²: no moment of a body is larger" in text_of(browser, "warning")
    assert "has these moments" in text_of(browser, "kept")


@needs_browser
def test_a_motion_too_long_for_a_page_says_where_it_ends(browser, tmp_path):
    """What is not computed is not claimed to agree."""
    path = symrot.show(scene_of({"principal": [1, 2, 2.5]}), tmp_path / "page.html")
    path.write_text(path.read_text(encoding="utf-8").replace("MOST_STEPS = 200000", "MOST_STEPS = 2"), encoding="utf-8")
    browser.open(path)
    assert "at most 2 steps" in text_of(browser, "warning")
    assert "Agrees" not in text_of(browser, "trust")


def test_a_page_is_one_file_of_at_most_two_megabytes(tmp_path):
    path = symrot.show("t_handle", tmp_path / "page.html")
    text = path.read_text(encoding="utf-8")
    assert path.stat().st_size < 2_000_000
    assert re.findall(r"""(?:src|href)\s*=\s*["']?(?!data:)[\w/:.]+""", text.split("<script>")[0]) == []
    assert re.findall(r"\b(?:fetch|XMLHttpRequest|importScripts)\b", re.sub(r"var libraries.*", "", text)) == []


def test_equal_scenes_give_equal_bytes():
    assert page(symrot.load_scene("heavy_top_loops")) == page(symrot.load_scene("heavy_top_loops"))


def test_a_title_cannot_end_the_script():
    title = "</script><script>alert(1)</script> <b>&"
    text = page(scene_of({"shape": "box", "a": 1, "b": 2, "c": 3, "mass": 1}, title=title))
    assert "alert(1)</script>" not in text
    data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)[1])
    assert data["title"] == title


def test_a_trajectory_shows_its_own_start_and_span(tmp_path):
    trajectory = symrot.propagator("t_handle")([0.0, 3.0], omega=[0, 5, 1])
    text = trajectory.show(tmp_path / "page.html").read_text(encoding="utf-8")
    data = json.loads(re.search(r'id="data">(.*?)</script>', text, re.DOTALL)[1])
    assert data["omega"] == [0, 5, 1]
    assert data["stop"] == 3.0
    assert trajectory._repr_html_().startswith("<iframe srcdoc=")


def test_a_motion_of_an_ensemble_shows_its_own_start_and_span(tmp_path):
    rates = [[0, 5, 1], [0, 6, 1]]
    ensemble = symrot.propagate_ensemble("t_handle", omega=rates, t=[0.0, 3.0])
    path = ensemble[1].show(tmp_path / "page.html")
    single = symrot.propagator("t_handle")([0.0, 3.0], omega=rates[1]).show(tmp_path / "single.html")
    assert path.read_bytes() == single.read_bytes()
    with pytest.raises(InputError, match=r"got an ensemble; show one of its motions: ensemble\[0\]"):
        symrot.show(ensemble, tmp_path / "page.html")


def test_a_torque_of_python_is_played(tmp_path):
    scene = symrot.load_scene("tumbling_prism")
    trajectory = symrot.propagator(scene, torque=lambda t, omega, quaternion: (0.1, 0.0, 0.0))()
    data = json.loads(
        re.search(r'id="data">(.*?)</script>', trajectory.show(tmp_path / "p.html").read_text(), re.DOTALL)[1]
    )
    assert "without a formula" in data["played"]


@pytest.mark.parametrize(("name", "message"), [("x.pdf", "ends in .html"), ("no/folder/x.html", "existing folder")])
def test_a_file_that_cannot_be_written_is_refused(name, message, tmp_path):
    with pytest.raises(InputError, match=message):
        symrot.show("t_handle", tmp_path / name)


@pytest.mark.parametrize(("shape", "dimensions", "faces"), [
    ("box", {"a": 1, "b": 2, "c": 3}, 6), ("cylinder", {"radius": 1, "length": 2}, 3), ("sphere", {"radius": 1}, 1),
    ("cone", {"radius": 1, "height": 2}, 2), ("hemisphere", {"radius": 1}, 2), ("torus", {"ring": 2, "tube": 1}, 1),
    ("hollow_sphere", {"inner": 0.5, "outer": 1}, 2), ("triangular_prism", {"base": 1, "height": 1, "apex": 0, "length": 1}, 5),
    ("tetrahedron", {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}, 4), ("disk", {"radius": 1}, 1),
])  # fmt: skip
def test_a_solid_has_its_faces(shape, dimensions, faces):
    assert len(patches(scene_of({"shape": shape, "mass": 1, **dimensions}).body)) == faces


def test_the_surface_encloses_the_volume():
    """The divergence theorem: the flux of r/3 through the faces of a cylinder is its volume, up to the facets."""
    body = scene_of({"shape": "cylinder", "radius": 2, "length": 3, "mass": 1}).body
    volume = 0.0
    for patch in patches(body):
        grid = np.array(patch.points).reshape(patch.rows, patch.columns, 3)
        for i in range(patch.rows - 1):
            for j in range(patch.columns - 1):
                a, b, c, d = grid[i, j], grid[i, j + 1], grid[i + 1, j + 1], grid[i + 1, j]
                volume += abs(np.dot(a, np.cross(b, c))) / 6 + abs(np.dot(a, np.cross(c, d))) / 6
    assert volume == pytest.approx(np.pi * 4 * 3, rel=0.01)


def test_a_body_without_parts_is_the_box_with_its_moments():
    """Sides a, b, c of the drawn box have moments in the ratio of the body's."""
    points = np.array([point for patch in patches(scene_of({"principal": [2, 3, 4]}).body) for point in patch.points])
    a, b, c = np.ptp(points, axis=0)
    assert np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2]) / (b**2 + c**2) == pytest.approx([1, 1.5, 2])


def test_a_body_about_a_fixed_point_is_drawn_from_it():
    points = np.array([point for patch in patches(symrot.load_scene("heavy_top_loops").body) for point in patch.points])
    assert points[:, 2].min() == pytest.approx(0.05)
    assert points[:, 2].max() == pytest.approx(0.07)


def test_the_picture_of_a_top_is_not_empty_below_its_tip():
    """A body that stays above the origin moves the picture up; a free body stays in its middle."""
    still, path = np.eye(3)[None], np.array([[0.0, 0.0, 1.0], [0.3, 0.0, 0.9]])
    top, free = np.array([[0.0, 0.0, 0.0], [0.2, 0.0, 0.9]]), np.array([[0.0, 0.0, -0.9], [0.0, 0.0, 0.9]])
    assert film._middle(top, still, path) > 0.5 and film._middle(free, still, np.vstack([path, -path])) < 0.1


@pytest.mark.parametrize(
    "time, last, text", [(1.5, 12.0, "1.50"), (0.0, 2.0, "0.000"), (5e3, 9e4, "5000"), (1e-4, 3e-3, "0.000100")]
)
def test_the_clock_of_a_film_has_the_same_decimals_in_each_frame(time, last, text):
    assert film._clock(time, last) == f"t = {text} s"


@pytest.mark.parametrize("films", [1, pytest.param(2, marks=pytest.mark.campaign)])
def test_a_film_has_the_frames_of_the_dense_motion(films, tmp_path):
    """A scene with five samples gives as many frames as any other, and two films are the same bytes."""
    pytest.importorskip("matplotlib")
    from PIL import Image

    scene = scene_of({"shape": "box", "a": 1, "b": 2, "c": 3, "mass": 1}, span={"t": [0, 0.2], "samples": 5})
    first = symrot.show(scene, tmp_path / "a.gif")
    assert Image.open(first).n_frames == 40
    if films == 2:
        assert first.read_bytes() == symrot.show(scene, tmp_path / "b.gif").read_bytes()


def test_a_missing_encoder_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr("symrot.viewer.film.find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"symrot\[film\]"):
        symrot.show("t_handle", tmp_path / "x.mp4")


def data_of(path):
    return json.loads(re.search(r'id="data">(.*?)</script>', path.read_text(encoding="utf-8"), re.DOTALL)[1])


def doubles(text, columns):
    return np.frombuffer(base64.b64decode(text), dtype="<f8").reshape(-1, columns)


@pytest.mark.parametrize("times", [[5.0, 6.5, 8.0], [8.0, 5.0], [-3.0, -1.0]])
def test_a_page_begins_with_the_state_of_the_trajectory(times, tmp_path):
    """A part of a motion, in any order of its times, shows that part, not the start of the scene."""
    trajectory = symrot.propagator("t_handle")(times)
    data = data_of(trajectory.show(tmp_path / "page.html"))
    expected = symrot.propagator("t_handle")(np.sort(times))
    states = doubles(data["reference"]["y"], 7)
    assert data["start"] == min(times)
    assert states[0, :3] == pytest.approx(expected.omega[0], abs=1e-10)
    assert states[-1, :3] == pytest.approx(expected.omega[-1], abs=1e-6)
    assert data["omega"] == pytest.approx(list(expected.omega[0]), abs=1e-10)


def test_a_single_time_is_refused(tmp_path):
    with pytest.raises(InputError, match="single time"):
        symrot.propagator("t_handle")([3.0]).show(tmp_path / "page.html")


def test_a_body_under_a_torque_of_python_is_not_free(tmp_path):
    trajectory = symrot.propagator("tumbling_prism", torque=lambda t, omega, q: (0.01, 0, 0))([5.0, 2.0, 0.0])
    data = data_of(trajectory.show(tmp_path / "page.html"))
    assert not data["free"] and data["hasTorque"]
    assert data["start"] < data["stop"]


def test_the_rotor_of_a_played_motion_belongs_to_its_momentum(tmp_path):
    torques = [
        {"kind": "rotor", "angular_momentum": [0, 0, 5]}, {"kind": "expression", "torque": ["0", "0", "1e-9*sin(t)"]},
    ]  # fmt: skip
    data = data_of(symrot.show(scene_of({"principal": [1, 2, 2.5]}, torque=torques), tmp_path / "page.html"))
    assert data["rotor"] == [0, 0, 5]


def test_a_long_fast_motion_is_played_in_part_and_says_so(tmp_path):
    """Samples farther apart than a tenth of a radian would show another motion."""
    torque = [{"kind": "expression", "torque": ["0", "0", "sin(t)/1000"]}]
    scene = scene_of(
        {"principal": [1, 1, 1.5]}, torque=torque, initial={"omega": [30, 0, 100]}, span={"t": [0, 100], "samples": 3}
    )
    data = data_of(symrot.show(scene, tmp_path / "page.html"))
    assert "plays only the first" in data["played"] or "plays the first" in data["played"]
    rates = doubles(data["samples"], 7)
    step = (data["stop"] - data["start"]) / (len(rates) - 1)
    assert step * np.linalg.norm(rates[:, :3], axis=1).max() < 0.11


def test_the_axis_of_symmetry_need_not_be_an_axis_of_the_body(tmp_path):
    body = {"inertia": {"xx": "5/2", "yy": 2, "zz": "5/2", "xz": "1/2"}}
    data = data_of(symrot.show(scene_of(body), tmp_path / "page.html"))
    assert np.abs(data["axis"]) == pytest.approx([np.sqrt(0.5), 0, np.sqrt(0.5)])
    assert data["axisName"] == "symmetry axis"


def test_a_body_without_symmetry_axis_shows_a_principal_axis(tmp_path):
    body = {"inertia": {"xx": "5/2", "yy": "11/4", "zz": "5/2", "xz": "1/2"}}
    data = data_of(symrot.show(scene_of(body), tmp_path / "page.html"))
    assert data["axisName"] == "principal axis 3"
