"""Laws of the report on stability: the reference is right, errors are detected, and the laws hold and are proven."""

import json
import math
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from symrot.bench.comparison import exact_path
from symrot.bench.comparison.exact_path import ExactPath
from symrot.bench.error_growth import growth, points, stability
from symrot.cli import main as cli
from symrot.errors import InputError
from symrot.propagation.propagate import propagator
from symrot.scene.scene import load_scene
from tests.reference import free_body as reference
from tests.reference.figures import GRAVITY, body, largest
from tests.reference.figures import TILT as TILTED

pytestmark = pytest.mark.usefixtures("quick_compiler")


def plate(omega=stability.STARTS[0]):
    return stability._scene("free plate", {"principal": list(stability.PLATE)}, omega)


@pytest.fixture(scope="module")
def track():
    """Return a track of three to fifty revolutions."""
    revolutions = 10.0 ** np.linspace(0.5, 1.7, 10)
    size = math.sqrt(sum(float(Fraction(w)) ** 2 for w in stability.STARTS[0]))
    return growth.Track(plate(), revolutions * 2 * math.pi / size, periodic=True), revolutions


@pytest.mark.campaign
def test_the_truth_is_that_of_elliptic_integrals_a_million_turns_later():
    times = np.array([0.0, 3.3, 1e7])
    motion = propagator(plate(), "taylor", 1e-15)._motion
    path = ExactPath(motion.plan, motion.kernel)
    found = path.states_of_free_body(times)
    expected = reference.motion(stability.PLATE, [Fraction(w) for w in stability.STARTS[0]], (1, 0, 0, 0), 50)
    ratio = float(path.period() / expected.period)
    assert abs(ratio - round(ratio)) < 1e-15  # the search may find a later return first
    for row, t in zip(found, times, strict=True):
        omega, q = ([float(x) for x in part] for part in expected(t))
        assert largest(row[:3], omega) < 2e-16 and largest(row[3:], q, sign=True) < 2e-16


def test_the_attitude_is_computed_even_if_it_is_no_output():
    asked = plate().with_({"output.quantities": ["omega"]})
    track = growth.Track(asked, np.array([0.0, 1.0]), periodic=False)
    assert track.curve("exact", propagator(track.scene, "exact")(track.times)).attitude.max() < 1e-14


def test_the_error_of_the_reference_is_that_of_its_own_series():
    """The check of a coarse series gives its distance from one with 1e-12 of its last terms."""
    motion = propagator(plate(), "taylor", 1e-15)._motion
    coarse, fine = (ExactPath(motion.plan, motion.kernel, tail=tail) for tail in (1e-16, 1e-28))
    with mpmath.workdps(exact_path.DIGITS):
        rows = [path.state(mpmath.mpf(1)) for path in (coarse, fine)]
        apart = max(abs(x - y) for x, y in zip(*rows, strict=True))
    assert 1e-22 < coarse.error(1.0, periodic=False) == pytest.approx(float(apart), rel=0.5)
    assert fine.error(1.0, periodic=False) < 1e-27
    lines = stability._growth_lines({**GROWTH, "reference_error": 3e-24})
    assert "compared with a series in 40 digits, 23 of them correct at the end" in lines[2]


GROWTH = {"title": "a plate", "variable": "t", "at": [0.0, 1.0], "curves": [
    {"method": "exact", "attitude": [0.0, 1e-16], "invariants": {"energy": [0.0, 1e-16]}}]}  # fmt: skip


def test_the_truth_under_gravity():
    scene = body((1, 1, "1/2"), ("3/10", "-9/5", 4), [{**GRAVITY, "center_of_mass": [0, 0, 1]}], TILTED)
    times = np.linspace(0, 1, 5)
    motion = propagator(scene, "taylor", 1e-15)._motion
    found = motion.evaluate(
        times, ExactPath(motion.plan, motion.kernel).states(times), [f"q{i} of t" for i in range(4)]
    )
    assert largest(found, propagator(scene, "exact")(times).quaternion, sign=True) < 4e-16


def test_a_motion_that_never_comes_back_is_refused(monkeypatch):
    separatrix = stability._scene("separatrix", {"principal": [3, 4, 6]}, (2, "3/2", 1))
    monkeypatch.setattr(exact_path, "MOST_STEPS", 12)
    motion = propagator(separatrix, "taylor", 1e-15)._motion
    with pytest.raises(InputError, match="does not return"):
        exact_path.ExactPath(motion.plan, motion.kernel).period()


def test_methods_are_told_apart(track):
    """The closed form has the smallest error, then the Taylor series, and RK4 the largest; projection reduces the
    drift.
    """
    curves = {curve.method: curve for curve in growth.growth(track[0])}
    assert list(curves) == [method.name for method in growth.METHODS]
    last = {name: curve.attitude[-1] for name, curve in curves.items()}
    assert last["exact"] < 1e-15 < 1e-12 < last["SciPy DOP853"] < 1e-8 < last["RK4"] < 1e-3
    assert last["taylor"] < 1e-13 and last["taylor, plain"] < 1e-11 and last["dop853"] < 1e-9
    assert last["RK4, normalised"] == pytest.approx(last["RK4"], rel=0.05)
    assert max(curves["RK4, normalised"].invariants["quaternion norm"]) < 4e-16
    assert curves["RK4"].invariants["quaternion norm"][-1] > 1e-9
    assert curves["RK4, normalised"].invariants["energy"][-1] > 1e-9  # the defect that renormalising hides
    assert math.isnan(growth.exponent(track[1][:8], curves["RK4"].attitude[:8]))  # too few past thirty turns


def test_a_wrong_motion_is_seen(track):
    followed, _ = track
    wrong = propagator(plate(), "exact")(followed.times, omega=[0.375, 1.0, 0.5 + 1e-9])
    assert followed.curve("wrong", wrong).attitude[-1] > 1e-8


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0])
def test_exponents_are_those_of_the_growth(power):
    turns = np.logspace(1, 5, 30)
    assert growth.exponent(turns, 1e-15 * turns**power) == pytest.approx(power)
    assert math.isnan(growth.exponent(turns, np.full(30, np.nan)))


def test_angles_pay_near_gimbal_lock_and_the_quaternion_does_not():
    rows = stability.passes()
    assert len({row["quaternion"]["steps"] for row in rows}) == 1
    assert max(row["switching"]["steps"] for row in rows) < 2 * rows[0]["quaternion"]["steps"]
    alone = [row["angles"]["steps"] for row in rows[:-1]]
    assert alone == sorted(alone) and alone[-1] > 10 * rows[0]["quaternion"]["steps"]
    assert "failed" in rows[-1]["angles"] and rows[-1]["switching"]["switches"] >= 1
    assert max(row[name]["error"] for row in rows for name in ("quaternion", "switching")) < 1e-13


def test_the_laws_of_tangent_and_secant_are_decided():
    assert [holds for _, holds in points.laws()] == [True] * 3


def test_a_body_grows_along_tangents_by_the_law_and_keeps_along_secants():
    """Points at right angles to a steady rotation move outward by the factor sqrt(1 + (omega h)^2) per step, to the
    last digits.
    """
    scene = stability._scene("steady", {"principal": [1, 2, 3]}, (0, 0, 2))
    found = {each.scheme: each for each in points.carried(scene, 3.0, (0.01,), (1.0, 2.0, 0.0))}
    assert found["tangent"].growth == pytest.approx((1 + 0.02**2) ** 150, rel=1e-13)
    assert found["tangent"].derived == pytest.approx(found["tangent"].growth, rel=1e-13)
    for name in ("secant (midpoint)", "rotation", "tangent, rescaled"):
        assert found[name].growth == pytest.approx(1, abs=1e-13)
    assert found["rotation"].error < 1e-13 < 1e-5 < found["secant (midpoint)"].error < found["tangent"].error
    tumbling = stability._scene("cylinder", stability.CYLINDER, (1, 0, 1))
    coarse, fine = (
        {each.scheme: each for each in points.carried(tumbling, 2.0, (h,), (1.0, 1.0, 3.0))} for h in (0.02, 0.01)
    )
    for name, order in (("tangent", 1), ("secant (midpoint)", 2), ("rotation", 2)):
        assert math.log2(coarse[name].error / fine[name].error) == pytest.approx(order, abs=0.2)
    assert fine["tangent"].growth == pytest.approx(fine["tangent"].derived, rel=1e-3)
    assert fine["tangent, rescaled"].strain > 1e-3  # each point is back at its distance, the shape is not


@pytest.mark.campaign
def test_the_report_of_a_scene(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(stability, "STEPS", (0.1,))
    monkeypatch.setattr(stability, "PASSES", ("1/10", 0))
    scene = tmp_path / "short.toml"
    scene.write_text(
        'schema = 1\ntitle = "short"\n[body]\nprincipal = [1, 2, 3]\n[initial]\nomega = [0.01, 1, 0]\n[span]\nt = [0, 2]\n'
    )
    page = tmp_path / "short.png"
    assert cli.main(["bench", str(scene), "--stability", "--plot", str(page), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert page.read_bytes()[:4] == b"\x89PNG"
    assert {curve["method"] for curve in found["growth"]["curves"]} == {method.name for method in growth.METHODS}
    said = "\n".join(stability.lines(found))
    assert "proven: tangent" in said and "gimbal lock itself" in said and "NOT PROVEN" not in said


@pytest.mark.parametrize("name", ["friction_wheel", "thruster_train"])
def test_a_motion_with_switches_is_refused(name):
    """The reference series would continue past a switch with the old equations, and reject every correct motion."""
    with pytest.raises(InputError, match="expected torques without switches"):
        stability.stability(load_scene(name))
