"""The motion that a page computes in JavaScript, against symrot's own motion of the same scene."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

import symrot
from symrot.viewer import page as page_module
from symrot.viewer.model import page_model
from tests.viewer.test_page import scene_of

pytestmark = pytest.mark.skipif(shutil.which("node") is None, reason="needs Node.js")

ASSETS = Path(page_module.__file__).with_name("assets")
WITHIN_A_PAGE = [
    "axisymmetric_satellite", "chen_cylinder", "damped_disk", "gravity_gradient_satellite", "gyrostat",
    "heavy_top_cusps", "heavy_top_loops", "precessing_wheel", "spin_up", "t_handle", "tumbling_prism",
]  # fmt: skip


def in_node(model, script, folder):
    """Run a script in Node.js beside the model of a page, without the picture; return what it prints, from JSON."""
    text = "\n".join([
        _asset("motion.js"), f"const data = {json.dumps(model.data)}, computed = !data.played;", model.kernel,
        _asset("model.js"), script,
    ])  # fmt: skip
    return run(text, folder)


def _asset(name):
    return re.sub(r"^export ", "", (ASSETS / name).read_text(encoding="utf-8"), flags=re.MULTILINE)


def run(text, folder):
    """Run a module in Node.js; return what it prints, from JSON."""
    (folder / "motion.mjs").write_text(text, encoding="utf-8")
    done = subprocess.run(["node", "motion.mjs"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout)


AGREEMENT = """
const model = new Model();
model.motion.reach(data.stop);
console.log(JSON.stringify({agreement: model.agreement(), failure: model.motion.failure, steps: model.motion.steps.length}));
"""


@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", WITHIN_A_PAGE)
def test_the_page_agrees_with_symrot(name, tmp_path):
    result = in_node(page_model(symrot.load_scene(name)), AGREEMENT, tmp_path)
    assert result["failure"] == ""
    assert result["agreement"] < 1e-12


def test_the_agreement_notices_a_wrong_constant(tmp_path):
    wrong = "model.constants.A *= 1 + 1e-8; model.restart(); model.motion.reach(data.stop);"
    script = AGREEMENT.replace("console", f"{wrong} console")
    assert in_node(page_model(symrot.load_scene("tumbling_prism")), script, tmp_path)["agreement"] > 1e-10


def test_a_played_motion_is_interpolated_closely(tmp_path):
    """Between samples the attitude of a played page is right to 1e-6."""
    scene = symrot.load_scene("friction_wheel")
    model = page_model(scene)
    times = [0.123, 1.777, 3.21]
    script = f"const model = new Model(); console.log(JSON.stringify({times}.map((t) => [...model.motion.at(t)])));"
    scene = replace(scene, output=scene.output._replace(quantities=("omega", "quaternion")))
    trajectory = symrot.propagator(scene)(times)
    for row, omega, quaternion in zip(
        in_node(model, script, tmp_path), trajectory.omega, trajectory.quaternion, strict=True
    ):
        assert row[:3] == pytest.approx(omega, abs=1e-3 * max(abs(omega)))
        assert row[3:] == pytest.approx(quaternion, abs=1e-6)


def test_a_free_body_keeps_energy_and_momentum_to_more_digits_than_a_double(tmp_path):
    """Without that, rounding is amplified to 1e-9 near the separatrix of the T-handle."""
    model = page_model(symrot.load_scene("t_handle"))
    forgetful = AGREEMENT.replace("model.motion.reach", "model.motion.invariants = null; model.motion.reach")
    assert in_node(model, forgetful, tmp_path)["agreement"] > 1e-11


def test_a_stretched_body_has_the_moments_of_the_sliders(tmp_path):
    """The second moments of the drawn box, such as (B + C - A)/2, become those of the new moments."""
    script = """
    const model = new Model({...data, constants: {...data.constants, A: 2.5, B: 3, C: 3.5}});
    console.log(JSON.stringify(model.stretch));
    """
    body = {"shape": "box", "a": 1, "b": 2, "c": 3, "mass": 12}
    stretch = in_node(page_model(scene_of(body)), script, tmp_path)
    a, b, c = (side * factor for side, factor in zip((1, 2, 3), stretch["factors"], strict=True))
    assert [b**2 + c**2, a**2 + c**2, a**2 + b**2] == pytest.approx([2.5, 3, 3.5])
    assert "has these moments" in stretch["note"]


def test_a_top_is_stretched_about_its_center_of_mass(tmp_path):
    """A cylinder with its centre at height h has A = m (3 r^2 + l^2)/12 + m h^2; r and l change, h stays."""
    script = """
    const {A, C} = data.constants;
    const model = new Model({...data, constants: {...data.constants, A: 1.01*A, B: 1.01*A, C: 1.05*C}});
    console.log(JSON.stringify([data.constants, data.mass, model.stretch]));
    """
    old, mass, stretch = in_node(page_model(symrot.load_scene("heavy_top_loops")), script, tmp_path)
    height = old["center_of_mass_3"]
    radius_squared = 2 * old["C"] / mass * stretch["factors"][0] ** 2
    length_squared = (12 * (old["A"] / mass - height**2) - 6 * old["C"] / mass) * stretch["factors"][2] ** 2
    assert stretch["from"] == stretch["to"] == [0, 0, height]
    assert mass * radius_squared / 2 == pytest.approx(1.05 * old["C"])
    assert mass * ((3 * radius_squared + length_squared) / 12 + height**2) == pytest.approx(1.01 * old["A"])


def in_panels(script, folder):
    return run(f"{_asset('panels.js')}\nconsole.log(JSON.stringify({script}));", folder)


def test_an_angle_that_passes_the_end_of_its_range_leaves_a_gap(tmp_path):
    """The curve is drawn to 180, interrupted, and goes on at -180; every sample stays."""
    result = in_panels("withGaps([0, 1, 2, 3], [[100, 160, -160, -100], [0, 10, 20, 30]], 360)", tmp_path)
    assert result["times"] == [0, 1, 1.5, 1.5, 1.5, 2, 3]
    assert result["series"] == [[100, 160, 180, None, -180, -160, -100], [0, 10, 15, 15, 15, 20, 30]]


def test_angles_that_pass_the_end_together_are_interrupted_once_each(tmp_path):
    result = in_panels("withGaps([0, 1], [[170, -170], [170, -170]], 360)", tmp_path)
    for curve in result["series"]:
        pieces = [piece.split() for piece in " ".join(map(str, curve)).split("None")]
        assert [{float(value) > 0 for value in piece} for piece in pieces] == [{True}, {False}]


def test_ticks_are_round_numbers(tmp_path):
    script = "[ticks(-184, 184, 5, [1, 2, 5, 10, 15, 30, 45, 90, 180]), ticks(0, 12, 7), ticks(0, 694.4, 7), ticks(-7.2, 7.2, 3), ticks(3, 3, 5)]"
    angles, seconds, days, rates, point = (ticks["values"] for ticks in in_panels(script, tmp_path))
    assert angles == [-180, -90, 0, 90, 180]
    assert seconds == [0, 2, 4, 6, 8, 10, 12]
    assert days == [0, 100, 200, 300, 400, 500, 600]
    assert rates == [-5, 0, 5]
    assert point == [3]


def test_a_curve_with_more_periods_than_pixels_is_a_band(tmp_path):
    wave = "Array.from({length: 8000}, (_, k) => Math.sin(k))"
    script = f"[band([...Array(8000).keys()], {wave}, 300, 0.01), band([...Array(8000).keys()], {wave}, 8000, 0.01)]"
    pieces, line = in_panels(script, tmp_path)
    assert line is None
    assert 100 < len(pieces) <= 301
    assert all(low < -0.9 and high > 0.9 for _, low, high in pieces)


def test_a_motion_whose_numbers_overflow_does_not_go_on(tmp_path):
    """An infinite norm would make every error look small."""
    script = """
    const model = new Model({...data, omega: [1e308, 0, 200]});
    model.motion.reach(data.stop);
    console.log(JSON.stringify([model.motion.failure, model.motion.t]));
    """
    failure, reached = in_node(page_model(symrot.load_scene("heavy_top_loops")), script, tmp_path)
    assert "beyond all bounds" in failure
    assert reached == 0
