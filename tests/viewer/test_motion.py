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

pytestmark = pytest.mark.skipif(shutil.which("node") is None, reason="needs Node.js")

ASSETS = Path(page_module.__file__).with_name("assets")
WITHIN_A_PAGE = [
    "axisymmetric_satellite", "chen_cylinder", "damped_disk", "gravity_gradient_satellite", "gyrostat",
    "heavy_top_cusps", "heavy_top_loops", "precessing_wheel", "spin_up", "t_handle", "tumbling_prism",
]  # fmt: skip


def in_node(model, script, folder):
    """Run a script in Node.js beside the model of a page, without the picture; return what it prints, from JSON."""
    source = (ASSETS / "page.js").read_text(encoding="utf-8")
    begin = source.index("const computed"), source.index("class Page")
    start = re.search(r"^function unpack", source, re.MULTILINE).start()
    end = source.index("/* --- the page ")
    text = "\n".join([
        "const window = {}; const element = () => null;",
        (ASSETS / "motion.js").read_text(encoding="utf-8").replace("export ", ""),
        f"const data = {json.dumps(model.data)};",
        source[begin[0] : source.index("\n", begin[0])],
        model.kernel,
        source[start:end],
        script,
    ])  # fmt: skip
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
