"""Steps with their derivatives: exact derivatives, certificates that prove them, and the C test that compares them."""

import json
import subprocess
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from symrot.certificates.step_certificate import step_certificate
from symrot.cli.main import main
from symrot.codegen.steps import RK4, TaylorSeries, WithDerivatives
from symrot.errors import CertificateError, InputError
from symrot.scene.scene import Scene
from symrot.workshop.emit import emit
from symrot.workshop.step_text import step_text
from tests.needs import needs_compiler

SCENE = "tumbling_prism"


@pytest.mark.parametrize(("step", "order"), [("rk4", None), ("taylor", 3)])
def test_derivatives_are_those_of_the_step(step, order):
    """In exact fractions, difference quotients over 1e-30 differ by less than 1e-25."""
    plain, full = step_text(SCENE, step, order)._program, step_text(SCENE, step, order, ["x", "p", "dt"])._program
    inputs = [name for a in plain.signature.arguments if a.role == "in" for name, *_ in a.components]
    values = {name: Fraction(number + 1, 7) for number, name in enumerate(inputs)}
    results, at = full.evaluate(values, number=Fraction), plain.evaluate(values, number=Fraction)
    assert {name: results[name] for name in at} == at
    small = Fraction(1, 10**30)
    for variable in inputs[1:]:
        moved = plain.evaluate(values | {variable: values[variable] + small}, number=Fraction)
        for name, value in at.items():
            assert abs((moved[name] - value) / small - results[f"{name}_by_{variable}"]) < Fraction(1, 10**25)


@needs_compiler
def test_a_step_with_derivatives_is_certified_and_tested(tmp_path, capsys):
    assert main(["emit", SCENE, "--step", "rk4", "--jacobian", "omega,q0", "-o", str(tmp_path)]) == 0
    name = f"{SCENE}_rk4_step_by_omega_by_q0"
    files = [str(tmp_path / f"{name}{end}.c") for end in ("", "_test")]
    subprocess.run(["cc", "-std=c99", "-O1", "-ffp-contract=off", *files, "-lm", "-o", tmp_path / "check"], check=True)
    assert subprocess.run([tmp_path / "check"], capture_output=True, check=True).stdout.endswith(b"40 digits\n")
    assert main(["audit", str(tmp_path / f"{name}.cert.json")]) == 0
    assert "its derivatives by omega, q0" in capsys.readouterr().out


def test_a_wrong_derivative_is_not_certified():
    """The C text has the derivatives of another method, or in another order than the formula."""
    step = step_text(SCENE, "rk4", None, ["omega"]).certified
    with pytest.raises(CertificateError, match="its derivatives by omega, got another formula"):
        step_certificate(replace(step, method=WithDerivatives(TaylorSeries(3), ("omega",))))
    with pytest.raises(CertificateError, match=r"double next_by_omega_2\[7\], double next_by_omega_1\[7\], .*, got \("):
        step_certificate(replace(step, method=WithDerivatives(RK4, ("omega_2", "omega_1", "omega_3"))))


def test_the_certificate_names_the_inputs():
    assert json.loads(step_text(SCENE, "rk4", None, ["omega"]).certificate())["step"]["jacobian"] == ["omega"]


@pytest.mark.parametrize("jacobian", [["mass"], ["omega", "omega"], [""]])
def test_unknown_inputs_are_refused(jacobian):
    with pytest.raises(InputError, match="jacobian: expected"):
        step_text(SCENE, "rk4", None, jacobian)


@pytest.mark.parametrize(("options", "message"), [
    ({"step": "taylor", "order": 2.5}, "order: expected 1 to 16 for the step 'taylor', got 2.5"),
    ({"step": "taylor", "order": "x"}, "order: expected 1 to 16 for the step 'taylor', got 'x'"),
    ({"jacobian": [3]}, "jacobian: expected a list of names"),
])  # fmt: skip
def test_options_of_other_types_are_refused(options, message):
    with pytest.raises(InputError, match=message):
        emit("t_handle", **options)


def test_derivatives_of_an_angle_of_two_states():
    scene = Scene.build(
        name="angle",
        body={"principal": [1, 2, 3]},
        initial={"omega": [1, 2, 3]},
        torque=[{"kind": "expression", "torque": ["atan2(omega_1, omega_2)", "0", "0"]}],
        span={"t": [0, 1]},
        output={"quantities": ["omega"]},
    )
    steps = []
    for jacobian in ([], ["omega_1"]):
        kernel, room = emit(scene, target="numpy", step="rk4", jacobian=jacobian), {}
        exec(kernel.source, room)
        steps.append(room[kernel.name])
    p = step_text(scene, "rk4").rates.inputs.parameters
    plain, full = steps
    above, below = (np.asarray(plain(0.0, [1 + h, 2, 3], p, 0.1)) for h in (1e-6, -1e-6))
    assert np.abs(full(0.0, [1, 2, 3], p, 0.1)[1] - (above - below) / 2e-6).max() < 1e-8


def test_a_high_power_has_a_taylor_step():
    torque = [{"kind": "expression", "torque": ["omega_1**64", "0", "0"]}]
    scene = Scene.build(
        name="power", body={"principal": [1, 2, 3]}, initial={"omega": [1, 2, 3]}, torque=torque, span={"t": [0, 1]}
    )
    assert len(step_text(scene, "taylor")._program.outputs) == 7
