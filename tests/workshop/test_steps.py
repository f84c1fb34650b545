"""Emitted time steps: they keep their order, agree with the propagator, and are the formulas that they say."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from fractions import Fraction
from itertools import product
from math import prod

import numpy as np
import pytest

import symrot
from symrot.certificates.step_certificate import step_certificate
from symrot.codegen.steps import RungeKutta, TaylorSeries, stepped
from symrot.errors import CertificateError, InputError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import parse
from symrot.scene.scene import load_scene
from symrot.workshop.step_text import STEPS, StepText, step_method, step_text

needs_cc = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")


def _stepper(scene, step, order=None):
    """The step of a scene as a function (t, x, dt) of NumPy, with its parameters, and its emitted text."""
    text, room = step_text(scene, step, order), {}
    exec(text.source("numpy"), room)
    parameters = [np.array(text.rates.inputs.parameters)] if text._parameter_names else []
    return lambda t, x, dt: room[text.name](t, x, *parameters, dt)


@pytest.mark.parametrize(("scene", "step", "count", "tolerance"), [
    ("tumbling_prism", "rk4", 400, 2e-7), ("tumbling_prism", "taylor", 100, 1e-11),
    ("tumbling_prism", "dop853", 100, 1e-11), ("damped_disk", "taylor", 200, 1e-11),
    ("gravity_gradient_satellite", "dop853", 400, 1e-9),
])  # fmt: skip
def test_steps_agree_with_the_propagator(scene, step, count, tolerance):
    """Many steps over a part of the span reach the state of symrot.propagate."""
    loaded = load_scene(scene)
    start = float(loaded.span[0])
    stop = start + min(float(loaded.span[1]) - start, 2.0 if scene != "gravity_gradient_satellite" else 600.0)
    trajectory = symrot.propagate(loaded, t=np.array([start, stop]))
    names = [name for name, *_ in step_text(scene, step)._rates_program.signature.argument("y").components]
    columns = {f"omega_{i + 1}": trajectory.omega[:, i] for i in range(3)}
    columns |= {f"q{i}": trajectory.quaternion[:, i] for i in range(4)}
    x, dt = np.array([columns[name][0] for name in names]), (stop - start) / count
    after = _stepper(scene, step)
    for k in range(count):
        x = after(start + k * dt, x, dt)
    expected = np.array([columns[name][1] for name in names])
    assert np.max(np.abs(x - expected)) < tolerance * (1 + np.max(np.abs(expected)))


@pytest.mark.parametrize(("step", "order"), [("rk4", 4), ("taylor", 6), ("dop853", 8)])
def test_the_error_of_a_step_has_its_order(step, order):
    """Half the step divides the error of one step by 2^(order + 1), against a Taylor series of order 14."""
    x = np.array([0.3, 2.0, 1.1, 1.0, 0.0, 0.0, 0.0])
    after = _stepper("tumbling_prism", step, order if step == "taylor" else None)
    exact = _stepper("tumbling_prism", "taylor", 14)
    sizes = (0.2, 0.1) if order == 8 else (0.08, 0.04)
    errors = [np.max(np.abs(after(0.0, x, dt) - exact(0.0, x, dt))) for dt in sizes]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order + 1, abs=0.6)


@pytest.mark.parametrize("method", [STEPS[name](8) for name in ("rk4", "dop853")], ids=lambda method: method.name)
def test_runge_kutta_methods_fulfil_their_order_conditions(method):
    """A quadrature of t^k is exact for k below the order, and the nodes are the sums of the weights of stages."""
    assert isinstance(method, RungeKutta)
    for node, weights in zip(method.nodes, method.stages, strict=True):
        assert abs(sum(weights.values()) - node) < Fraction(1, 10**25)
    for power in range(method.order):
        total = sum(weight * method.nodes[stage] ** power for stage, weight in method.weights.items())
        assert abs(total - Fraction(1, power + 1)) < Fraction(1, 10**25)


def test_a_taylor_step_of_a_linear_equation_is_the_exponential_series():
    """dy/dt = p y: the step multiplies y by the first terms of exp(p dt), in exact fractions."""
    y, p, dy = Argument("y", "in", (("y0", "", ""),)), Argument("p", "in", (("p0", "", ""),)), ("dy0", "", "")
    time = Argument("t", "in", (("t", "s", ""),), is_scalar=True)
    rates = Program(Signature("linear", (time, y, p, Argument("dy", "out", (dy,)))), (), (("dy0", parse("p0*y0")),))
    values = {"t": Fraction(0), "y0": Fraction(2, 3), "p0": Fraction(5, 7)}
    (after,) = stepped(rates, TaylorSeries(6), values, Fraction(1, 3), {}, Fraction)
    terms = [Fraction(5, 21) ** k / prod(range(1, k + 1)) for k in range(7)]
    assert after == Fraction(2, 3) * sum(terms)


@needs_cc
@pytest.mark.thinned(3)
@pytest.mark.parametrize(("scene", "step"), [("tumbling_prism", "rk4"), ("gyrostat", "dop853"),
                                             ("gravity_gradient_satellite", "taylor")])  # fmt: skip
def test_the_emitted_test_passes_and_notices_a_change(scene, step, tmp_path):
    """The C files compile without a warning as C99; their own test returns 0, and 1 after a change of one constant."""
    text = step_text(scene, step, 4 if step == "taylor" else None)
    files = text.c_files()
    for name, content in files.items():
        (tmp_path / name).write_text(content, encoding="utf-8")

    def outcome() -> int:
        flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"]
        command = ["gcc", *flags, f"{text.name}.c", f"{text.name}_test.c", "-o", "check", "-lm"]
        subprocess.run(command, cwd=tmp_path, check=True, timeout=60)
        return subprocess.run([tmp_path / "check"], timeout=60).returncode

    assert outcome() == 0
    source = files[f"{text.name}.c"]
    assert "malloc" not in source
    (tmp_path / f"{text.name}.c").write_text(re.sub(r"= 0\.(\d+)\*", r"= 0.1\1*", source), encoding="utf-8")
    assert outcome() == 1


def test_the_certificate_states_the_formula_and_refuses_another():
    """The certificate covers double and float; a C text with one changed sign is refused."""
    text = StepText(load_scene("tumbling_prism"), step_method("rk4"))
    certificate = json.loads(text.certificate())
    assert list(certificate["formula"]) == ["symrot_tumbling_prism_rk4_step", "symrot_tumbling_prism_rk4_stepf"]
    under_test = text.certified
    name = f"{text.name}.c"
    wrong = under_test.files[name].replace("omega_1*q3 +", "omega_1*q3 -")
    assert wrong != under_test.files[name]
    with pytest.raises(CertificateError, match="explicit Runge-Kutta method rk4"):
        step_certificate(replace(under_test, files={**under_test.files, name: wrong}))


def test_steps_are_emitted_by_the_public_function():
    """symrot.emit gives C, NumPy and JavaScript of a step, the same text each time."""
    for target in ("c", "numpy", "js"):
        first, second = (symrot.emit("t_handle", target, step="rk4").source for _ in range(2))
        assert first == second
        assert "t_handle_rk4_step" in first


@pytest.mark.parametrize(
    ("scene", "options", "words"),
    [
        ("t_handle", {"step": "euler"}, "expected one of the methods rk4, taylor, dop853, exact, got 'euler'"),
        ("t_handle", {"step": "rk4", "order": 3}, "an order only for the step 'taylor'"),
        ("t_handle", {"step": "taylor", "order": 17}, "expected 1 to 16"),
        ("t_handle", {"step": "taylor", "order": 0}, "expected 1 to 16"),
        ("t_handle", {"order": 4}, "expected a step as well"),
        ("t_handle", {"step": "rk4", "jacobian": ["y"]}, "inputs of the step"),
        ("quaternion_dcm", {"step": "rk4"}, "only a motion has steps"),
        ("friction_wheel", {"step": "rk4"}, "without switches"),
    ],
)
def test_impossible_steps_are_refused_in_one_sentence(scene, options, words):
    """Bad input names the place, the expectation and the value."""
    with pytest.raises(InputError, match=words):
        _ = symrot.emit(scene, **options).source


def test_every_smooth_shipped_scene_has_every_step():
    """Each method gives a program for each scene whose torques are smooth formulas."""
    for scene, step in product(("axisymmetric_satellite", "gyrostat", "heavy_top_loops", "spin_up"), STEPS):
        assert step_text(scene, step)._program.outputs
