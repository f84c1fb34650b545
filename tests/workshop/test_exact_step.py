"""Exact steps in C: equal to propagation, in chains of steps, for any axes, and refusals."""

import ctypes
import subprocess

import numpy as np
import pytest

import symrot
from symrot.cli.main import main
from symrot.errors import CertificateError, InputError
from symrot.workshop.steps.exact import ExactStepText
from tests.needs import needs_compiler

START = {"omega": ["1/2", "1/3", 2], "attitude": {"quaternion": [3, 1, 2, 1]}}
FREE = {"body": {"principal": [2, 3, 4]}}
TOP = {
    "body": {"principal": [1, 2, 2], "about": "fixed_point"},
    "torque": [{"kind": "gravity", "weight": 3, "center_of_mass": [-1, 0, 0], "direction": [1, 2, -2]}],
}
GYROSTAT = {
    "body": {"principal": [2, 3, 2]},
    "torque": [{"kind": "rotor", "angular_momentum": [0, -4, 0]}],
}


def scene_of(content):
    return symrot.Scene.from_dict({"schema": 1, "initial": START, "span": {"t": [0, 1]}, **content})


@needs_compiler
@pytest.mark.parametrize("content", [FREE, TOP, GYROSTAT], ids=["free", "top", "gyrostat"])
def test_an_exact_step_is_the_motion(content, tmp_path):
    """To a few units of rounding, after a step of any size; twenty steps agree to their accumulated rounding."""
    scene = scene_of(content)
    text = ExactStepText(scene)
    for name, content_of_file in text.c_files().items():
        (tmp_path / name).write_text(content_of_file)
    cc = ["cc", "-std=c99", "-Og", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror", "-fPIC"]
    subprocess.run([*cc, "-shared", f"{text.name}.c", "-lm", "-o", "step.so"], cwd=tmp_path, check=True)
    assert "malloc" not in text.c()[0]
    step = getattr(ctypes.CDLL(str(tmp_path / "step.so")), f"symrot_{text.name}")
    numbers = np.ctypeslib.ndpointer(np.float64)
    step.argtypes = [ctypes.c_double, numbers, numbers, ctypes.c_double, numbers]
    p = np.array([float(value) for _, _, value in text.form.parameters])
    start = np.array([float(x) for x in (*scene.initial.omega_b, *scene.initial.quaternion)])
    for dt in (0.01, -2.0, 1000.0):
        after = np.empty(7)
        assert step(0.0, start, p, dt, after) == 0
        motion = symrot.propagate(scene, t=[dt], omega=start[:3], quaternion=start[3:])
        expected = np.concatenate([motion.omega[0], motion.quaternion[0]])
        rounding = 4e-15 + 2.0**-52 * abs(dt) * 3  # a rounding of the start or of p, times the time
        assert np.abs(after - expected).max() <= rounding * np.abs(start).max()
    state = start.copy()
    for _ in range(20):
        assert step(0.0, state, p, 0.05, state) == 0
    motion = symrot.propagate(scene, t=[1.0])
    assert np.abs(state - [*motion.omega[0], *motion.quaternion[0]]).max() < 1e-13
    state[0] = np.nan
    assert step(0.0, state, p, 0.1, after) == 1 and np.isnan(after).all()


@needs_compiler
def test_the_emitted_test_passes(tmp_path):
    assert main(["emit", "tumbling_prism", "--step", "exact", "-o", str(tmp_path)]) == 0
    files = sorted(path.name for path in tmp_path.glob("*.c"))
    subprocess.run(
        ["cc", "-std=c99", "-O0", "-ffp-contract=off", *files, "-lm", "-o", "check"], cwd=tmp_path, check=True
    )
    assert b"agrees" in subprocess.run([tmp_path / "check"], capture_output=True, check=True).stdout


def test_exact_steps_have_no_certificate(capsys):
    assert main(["certify", "tumbling_prism", "--step", "exact"]) == 2
    assert "exact steps have a test and no certificate" in capsys.readouterr().err
    with pytest.raises(CertificateError, match="only a test"):
        _ = symrot.emit("tumbling_prism", step="exact").certificate


@pytest.mark.parametrize(
    ("scene", "options", "message"),
    [
        ("spin_up", {}, "use the step 'rk4', 'taylor' or 'dop853'"),
        ("gyrostat", {}, "without such a closed form"),
        ("friction_wheel", {}, "without switches"),
        ("tumbling_prism", {"target": "js"}, "expected the target 'c'"),
        ("tumbling_prism", {"order": 4}, "order: expected no value"),
        ("tumbling_prism", {"jacobian": ["x"]}, "jacobian: expected no value"),
    ],
)
def test_what_has_no_exact_step_is_refused(scene, options, message):
    with pytest.raises(InputError, match=message):
        symrot.emit(scene, step="exact", **options)
