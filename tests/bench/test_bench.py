"""Laws of the benchmark: references agree, measured errors are true errors, tables and comparisons add up.

No test depends on a measured time, because times depend on the machine.
"""

import json
import math
import re
from argparse import Namespace
from dataclasses import replace
from fractions import Fraction
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from symrot.bench import check, command, kernels, overhead, skip, starts
from symrot.bench.by_hand.kernel_peers import input_names, textbook_program
from symrot.bench.comparison import meshes, steps, suite, work_precision
from symrot.bench.comparison import reference as reference_module
from symrot.bench.comparison.contestants import CONTESTANTS, chosen
from symrot.bench.comparison.exact_path import ExactPath
from symrot.bench.comparison.peers import scalar_kernel
from symrot.bench.comparison.problem import Problem, State
from symrot.bench.comparison.race import Measured, race
from symrot.bench.comparison.reference import REFERENCES, longer, reference
from symrot.bench.comparison.work_precision import DECADES, against, decades, digest, study
from symrot.cli.main import main
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.numpy_kernel import load_numpy_kernel
from symrot.errors import InputError, SymrotError
from symrot.planning.plan import make_plan
from symrot.propagation.propagate import propagator
from symrot.report.work_precision import compared, lines, lines_of_comparison, read_study
from symrot.scene.scene import Scene, load_scene

pytestmark = pytest.mark.usefixtures("quick_compiler")
SHORT = {
    "schema": 1, "title": "short", "body": {"principal": [1, 2, 3]}, "initial": {"omega": ["3/10", 1, "1/2"]},
    "span": {"t": ["1/2", 3], "samples": 2},
}  # fmt: skip
SCENE = """schema = 1
body = { principal = [1, 2, 3] }
initial = { omega = [0.3, 1, 0.5] }
span = { t = [0, 2], samples = 2 }
"""


def scene(**more):
    return Scene.from_dict(SHORT | more, "short")


@cache
def short_reference():
    return reference(Problem(scene()))


@pytest.fixture
def known_reference(monkeypatch):
    """Let a study of the short scene take the reference that is already computed."""
    monkeypatch.setattr(work_precision, "reference", lambda *given: short_reference())


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(work_precision, "reference", lambda *given: short_reference())
        return study(scene(), "exact,taylor,DOP853", quick=True, rounds=1)


# --- references -------------------------------------------------------------------------------------------------------


@pytest.mark.thinned(3)
@pytest.mark.parametrize(
    "more",
    [
        {},
        {"torque": [{"kind": "expression", "torque": ["sin(3*t/2)/4", "exp(-t)*omega_1/7", "q0*q3/10"]}]},
        {"torque": [{"kind": "rotor", "angular_momentum": [0, 0, 1]}], "body": {"principal": [2, 2, 3]}},
    ],
    ids=["free", "expression", "gyrostat"],
)
def test_the_references_share_nothing_and_agree(more):
    """The references are a series in 40 digits, Runge-Kutta steps in long double on general equations, and the closed
    form.
    """
    result = reference(Problem(scene(**more))) if more else short_reference()
    assert result.others
    assert all(difference < 1e-15 for _, difference in result.others)
    assert all("no closed form" in why or "long double" in why for why in result.skipped)


def test_a_reference_starts_from_the_exact_numbers():
    """The moment of inertia 1/3 is no double; the reference must use 1/3 itself, not the rounded number."""
    thirds = scene(body={"principal": ["4/3", "5/3", "7/3"]}, initial={"omega": ["1/3", "1/7", "5/11"]})
    scaled = scene(body={"principal": [4, 5, 7]}, initial={"omega": ["1/3", "1/7", "5/11"]})
    ends = [reference(Problem(one)).states for one in (thirds, scaled)]  # only ratios of moments matter
    assert Problem.worst(ends[0], ends[1]) < 2e-16


def test_a_rough_torque_has_no_series_and_says_so(monkeypatch):
    rough = scene(torque=[{"kind": "expression", "torque": ["-abs(omega_1)/10", "0", "0"]}])
    monkeypatch.setattr(reference_module, "MOST_LONG_SECONDS", 0.3)
    result = reference(Problem(rough))
    assert "DOP853 in long double" in result.name
    assert any("abs" in why for why in result.skipped)
    assert 1e-14 < result.doubt < 1e-6  # steps of any method stumble over corners, and the report says how far


def test_a_motion_without_series_has_two_references_that_share_no_coefficient():
    """They are Dormand-Prince steps on general equations, and Gragg's extrapolated midpoints on the scene's own
    equations.
    """
    result = reference(Problem(scene(torque=[{"kind": "damping", "quadratic": "1/10"}])))
    assert "DOP853 in long double" in result.name
    ((name, difference),) = result.others
    assert "midpoints" in name
    assert difference < 1e-15


PULSE = {"kind": "expression", "torque": ["0", "0", "exp(-((t - 2)/w)**2)/w"], "parameters": {"w": "1/1000"}}
AT_REST = {"initial": {"omega": [0, 0, 0]}, "span": {"t": [0, 5], "samples": 2}}


@pytest.mark.parametrize(
    "computed",
    [
        pytest.param(computed, id=name.split()[0], marks=[pytest.mark.campaign] * name.startswith("Taylor"))
        for name, computed in REFERENCES
        if name != "closed form"
    ],
)
def test_no_reference_steps_over_a_pulse(computed):
    """A body at rest gets the momentum sqrt(pi), the area of the Gaussian pulse, and gets it only after the pulse."""
    problem = Problem(scene(torque=[PULSE], **AT_REST))
    states = computed(problem, lambda text: None, 60.0)
    assert [problem.ends[0] < 1.99, problem.ends[1] > 2.01] == [True, True]
    assert abs(states[0].omega[2]) < 1e-300
    for state in states[1:]:
        assert state.omega[2] == pytest.approx(math.sqrt(math.pi) / 3, rel=1e-15)


def test_two_fixed_step_references_do_not_agree_on_having_missed_a_pulse():
    """Air drag has no Taylor series, so both references take fixed steps; neither may step over the pulse."""
    air = {"kind": "damping", "quadratic": "1/10"}
    problem = Problem(scene(torque=[{**PULSE, "parameters": {"w": "1/100000"}}, air], **AT_REST))
    result = reference(problem)
    assert "long double" in result.name
    assert result.doubt < 1e-12
    spin = [state.omega[2] for state in result.states]
    begin, end = problem.ends[1], problem.ends[3]
    assert 1 / spin[3] - 1 / spin[1] == pytest.approx((end - begin) / 30, rel=1e-12)  # d(1/omega)/dt is k/C


@pytest.mark.campaign
def test_the_path_of_the_stability_study_does_not_step_over_a_pulse():
    motion = propagator(scene(torque=[PULSE], **AT_REST), "taylor")._motion
    assert ExactPath(motion.plan, motion.kernel).states(np.array([1.9, 5.0]))[:, 2] == pytest.approx(
        [0, math.sqrt(math.pi) / 3], rel=1e-15
    )


def test_a_body_that_a_pulse_has_yet_to_set_going_is_measured_by_its_later_motion():
    """Before the pulse the body rotates at 1e-40 rad/s, where errors do not matter; after it a wrong motion is
    detected.
    """
    slow, fast = (State(np.array([0, 0, omega]), None) for omega in (1e-40, 1.0))
    off = State(np.array([0, 0, 2e-40]), None)
    assert Problem.worst([off, fast], [slow, fast]) < 1e-30
    assert Problem.worst([slow, slow], [slow, fast]) == 1.0
    assert Problem.worst([State(np.array([0, 0, 1.5]), None), fast], [slow, fast]) > 1.0


@pytest.mark.parametrize("wrong", [0, 1])
def test_a_wrong_reference_is_refused(wrong, monkeypatch):
    """If one of two references is wrong by 1e-5 in one component, the study ends with an error."""
    table = list(REFERENCES[:2])
    name, true = table[wrong]

    def shifted(*given):
        return [State(state.omega + np.array([0, 1e-5, 0]), state.quaternion) for state in true(*given)]

    table[wrong] = (name, shifted)
    monkeypatch.setattr(reference_module, "REFERENCES", tuple(table))
    with pytest.raises(SymrotError, match="one of the references is wrong") as caught:
        reference(Problem(scene()))
    assert "but the following differ from Taylor series in 40 digits: DOP853 in long double" in str(caught.value)


def test_a_reference_that_is_no_number_confirms_nothing(monkeypatch):
    lost = ("lost", lambda *given: [State(np.full(3, np.nan), None)] * 4)
    monkeypatch.setattr(reference_module, "REFERENCES", (REFERENCES[0], lost))
    with pytest.raises(SymrotError, match="lost by inf"):
        reference(Problem(scene()))


def test_every_reference_is_refused_by_the_measure_when_it_is_wrong():
    """The measure of errors detects a wrong sign, a swapped component and a rotation by 1e-9 rad."""
    exact = short_reference().states[-1]
    q = exact.quaternion
    turned = np.array([q[0], q[1], q[2], q[3]]) + 0.5e-9 * np.array([-q[1], q[0], q[3], -q[2]])
    assert Problem.error(State(exact.omega, -q), exact) < 1e-15  # one attitude
    assert Problem.error(State(exact.omega, turned), exact) == pytest.approx(1e-9, rel=1e-3)
    assert Problem.error(State(exact.omega, q * [1, -1, -1, -1]), exact) > 0.1
    assert Problem.error(State(exact.omega[::-1], q), exact) > 0.1
    assert Problem.error(State(np.full(3, np.nan), None), exact) == np.inf


def test_long_text_has_every_double_long():
    text = longer("const double x = 0.5*sin(y[1]) + 1e-3 + 2.0/3.0; int i = 3; fmax1(x2.5)")
    assert text.startswith("const long double x = 0.5L*sinl(y[1]) + 1e-3L + 2.0L/3.0L; int i = 3;")


def test_references_cover_what_a_study_needs():
    assert [name.split()[0] for name, _ in REFERENCES] == ["Taylor", "DOP853", "closed", "extrapolated"]


# --- contestants ------------------------------------------------------------------------------------------------------


def test_the_kernel_for_scipy_is_the_emitted_one():
    """The kernel rewritten for one state returns the same numbers, also for sine and square root."""
    torque = [{"kind": "expression", "torque": ["sin(t)*sqrt(2+q0)", "atan2(q1, 2)", "exp(-t)*tanh(omega_3)"]}]
    problem = Problem(scene(torque=torque))
    whole, narrow = load_numpy_kernel(problem.kernel.rates), scalar_kernel(problem.kernel.rates)
    y = np.array(problem.y0) + 0.1
    given = (problem.p,) if problem.p else ()
    assert np.allclose(
        narrow(0.3, y.tolist(), *given), whole(0.3, y, *given), rtol=4e-15, atol=0
    )  # math and NumPy differ in last bits


@pytest.mark.campaign
def test_every_method_reaches_the_reference(found):
    least = {}
    for run in found["runs"]:
        least[run["method"]] = min(run["error"], least.get(run["method"], 1.0))
    assert least["exact"] < 1e-15
    assert least["exact with set-up"] < 1e-15
    assert least["taylor"] < 1e-14
    assert least["SciPy DOP853"] < 1e-11


@pytest.mark.campaign
def test_tighter_tolerances_give_less_error(found):
    errors = [run["error"] for run in found["runs"] if run["method"] == "SciPy DOP853"]
    assert errors[-1] < 1e-6 * errors[0]


def test_a_motion_seen_as_one_angle_is_compared_as_a_rotation():
    """The plan integrates omega_3 and an angle, the closed form returns omega and quaternion; both are compared as one
    state.
    """
    planar = scene(initial={"omega": [0, 0, 1]}, torque=[{"kind": "damping", "linear": "1/10"}])
    problem = Problem(planar)
    assert problem.plan.states == ("omega_3", "theta")
    result = study(planar, "exact,taylor", quick=True)
    assert max(run["error"] for run in result["runs"] if run["method"].startswith("exact")) < 1e-14


def test_a_scene_with_nothing_to_integrate_is_refused():
    still = scene(initial={"omega": [0, 0, 1]}, output={"quantities": ["omega"]})
    assert make_plan(still).states == ()
    with pytest.raises(InputError, match="states to integrate"):
        study(still)


def test_what_cannot_take_part_is_said(monkeypatch):
    monkeypatch.setattr("symrot.bench.comparison.contestants.find_spec", lambda name: None)
    result = study(scene(torque=[{"kind": "constant_space", "torque": [0, 0, "1/10"]}]), "exact,heyoka,dop853", True)
    said = {item["method"]: item["why"] for item in result["skipped"]}
    assert "no closed form" in said["exact"]
    assert "not installed" in said["heyoka"]
    with pytest.raises(InputError, match="heyoka: not installed: pip install"):
        study(scene(), "heyoka", True)


@pytest.mark.usefixtures("known_reference")
def test_tolerances_are_those_that_a_method_can_hold():
    result = study(scene(), "exact,taylor,DOP853", True, tolerances=(1e-4, 1e-15), rounds=1)
    asked = {(run["method"], run["tolerance"]) for run in result["runs"]}
    assert {("taylor", 1e-4), ("SciPy DOP853", 1e-4), ("exact", None)} <= asked
    assert ("SciPy DOP853", 1e-15) not in asked
    assert all(run["turns"] == 1 for run in result["runs"])


@pytest.mark.skipif(find_spec("heyoka") is None, reason="heyoka is an extra")
def test_heyoka_follows_any_plan_of_ours():
    problem = Problem(scene(torque=[{"kind": "expression", "torque": ["sin(t)/4", "0", "q1*q2"]}]))
    heyoka = next(one for one in CONTESTANTS if one.name == "heyoka")
    last, steps = heyoka.prepare(problem, 1e-15)(problem.stop)
    assert steps > 3
    assert problem.error(problem.state(last, problem.stop), reference(problem).states[-1]) < 1e-13


def test_methods_are_chosen_by_name():
    assert {one.group for one in chosen("taylor, LSODA", quick=False)} == {"taylor", "LSODA"}
    assert len(chosen(None, quick=True)) < len(chosen(None, quick=False)) == len(CONTESTANTS)
    with pytest.raises(InputError, match="'euler'"):
        chosen("taylor,euler", quick=False)


def test_runs_take_turns():
    order = []
    entries = [(Measured(name, 0.0, 0, 0.0, 1.0), lambda name=name: order.append(name)) for name in "abc"]
    race(entries, 2)
    assert order == list("abcabc")
    assert all(len(measured.seconds) == 2 for measured, _ in entries)


# --- tables -----------------------------------------------------------------------------------------------------------


def made(method, error, seconds):
    return {"method": method, "tolerance": error, "steps": 1, "error": error, "seconds": seconds, "least": seconds}


RUNS = [made("taylor", 1e-4, 1.0), made("taylor", 1e-9, 2.0), made("heyoka", 1e-5, 4.0), made("heyoka", 1e-3, 5.0)]


def test_decades_take_the_fastest_that_is_good_enough():
    """A run with a looser tolerance that is slower never counts, and no curve is extrapolated."""
    rows = {row["error"]: row for row in decades(RUNS)}
    assert set(rows) == {error for error in DECADES if error >= 1e-9}
    assert rows[1e-3]["methods"]["heyoka"]["seconds"] == 4.0
    assert rows[1e-3]["methods"]["heyoka"]["ratio"] == 4.0
    assert rows[1e-5]["fastest"] == "taylor"
    assert rows[1e-5]["methods"]["heyoka"]["ratio"] == 2.0
    assert "heyoka" not in rows[1e-6]["methods"]


def test_decades_stop_where_the_reference_is_in_doubt():
    assert min(row["error"] for row in decades(RUNS, floor=5e-8)) == 1e-7


def test_ratios_against_peers():
    (row,) = against(decades(RUNS))
    assert row["peer"] == "heyoka"
    assert row["stepped"]["ratios"] == {"1e-02": 4.0, "1e-03": 4.0, "1e-04": 4.0, "1e-05": 2.0}
    assert row["stepped"]["median"] == 4.0
    assert row["stepped"]["least"] == 2.0


def test_a_study_against_itself_is_one_and_against_a_slower_one_half(found):
    same = compared(found, found)
    assert all(ratio == 1.0 for item in same["ratios"].values() for ratio in item["decades"].values())
    slower = json.loads(json.dumps(found))
    for row in slower["decades"]:
        for cell in row["methods"].values():
            cell["seconds"] *= 2
    half = compared(slower, found)["ratios"]["taylor"]
    assert half["mean"] == pytest.approx(0.5)
    assert "0.50" in "\n".join(lines_of_comparison(compared(slower, found)))


def test_studies_of_two_scenes_are_not_compared(found):
    other = json.loads(json.dumps(found)) | {"scene": {"name": "other", "title": "", "span": [0, 1]}}
    with pytest.raises(InputError, match="'short' and 'other'"):
        compared(found, other)
    changed = found | {"scene": found["scene"] | {"digest": "another"}}
    with pytest.raises(InputError, match="two different motions with the same name 'short'"):
        compared(found, changed)
    with pytest.raises(InputError, match="expected a method that both studies measured at the same error"):
        compared(found, found | {"decades": []})


def test_the_digest_is_that_of_the_motion():
    """Another title does not change the digest; another moment of inertia does."""
    base, titled, heavier = (
        digest(Problem(scene(**more))) for more in ({}, {"title": "other"}, {"body": {"principal": [1, 2, "5/2"]}})
    )
    assert base == titled != heavier


@pytest.mark.parametrize("value", ["x", 0, -1.0, math.nan, None, [1]])
def test_a_study_with_an_impossible_time_is_refused(found, value, tmp_path):
    broken = json.loads(json.dumps(found))
    broken["decades"][0]["methods"]["taylor"]["seconds"] = value
    path = tmp_path / "x.json"
    path.write_text(json.dumps(broken))
    with pytest.raises(InputError, match="missing parts or impossible"):
        read_study(path)


def test_the_lines_name_references_and_every_method(found):
    text = "\n".join(lines(found))
    for words in ("Taylor series in 40 digits", "long double", "closed form", "exact", "taylor", "SciPy DOP853"):
        assert words in text


@pytest.mark.parametrize(
    ("content", "said"),
    [("{", "not JSON"), ("[]", "format"), ('{"format": "symrot work-precision 1"}', "missing parts")],
)
def test_a_file_that_is_no_study_is_refused(tmp_path, content, said):
    path = tmp_path / "x.json"
    path.write_text(content)
    with pytest.raises(InputError, match=said):
        read_study(path)
    with pytest.raises(InputError, match="expected a study"):
        read_study(tmp_path / "missing.json")


# --- what specialisation saves ----------------------------------------------------------------------------------------


@pytest.mark.campaign
def test_the_general_kernel_follows_the_same_motions(monkeypatch):
    """The final states agree, although the general kernel has a full tensor and all torques, some of which are zero."""
    whole = skip.rungs()
    kept = {name: whole[name] for name in ("full_tensor_all_torques", "free_symmetric", "constant")}
    monkeypatch.setattr(skip, "rungs", lambda: kept)
    rows = skip.measure(quick=True)["rows"]
    assert all(row["agrees"] for row in rows)
    assert len({row["general"]["operations"] for row in rows}) == 1
    assert all(row["general"]["operations"] > row["own"]["operations"] for row in rows)
    assert rows[-1]["own"]["operations"] == 0


@pytest.mark.campaign
def test_no_rung_of_the_ladder_costs_more_than_the_one_above():
    result = skip.measure(quick=True)
    counts = [row["own"]["operations"] for row in result["rows"]]
    assert counts == sorted(counts, reverse=True)
    assert all(row["agrees"] for row in result["rows"])


def test_a_wrong_general_kernel_would_be_seen(monkeypatch):
    """If a torque that should be zero is not zero, the final state differs and the row of the table says so."""
    true = skip._nothing

    def wrong(kind):
        made = true(kind)
        return made._replace(values={"torque": (Fraction(1, 10**6), *made.values["torque"][1:])}) \
            if kind == "constant_body" else made  # fmt: skip

    monkeypatch.setattr(skip, "_nothing", wrong)
    monkeypatch.setattr(skip, "rungs", lambda: {"wrong": ("wrong", scene())})
    arguments = Namespace(**dict.fromkeys(("scene", "plot", "out", "directory", "json")), quick=True)
    assert not command._skip(arguments, lambda text: None).good  # the command exits with 1
    row, _ = skip._row("wrong", scene())
    assert not row["agrees"]


def test_general_torques_are_all_kinds_that_act_together():
    kinds = {torque.kind for torque in skip.general_plan(scene()).scene.torques}
    assert kinds == {"constant_body", "constant_space", "gravity", "damping", "spring", "rotor"}
    orbit = load_scene("gravity_gradient_satellite")
    assert "gravity" not in {torque.kind for torque in skip.general_plan(orbit).scene.torques}
    assert replace(orbit, torques=()).torques == ()


# --- the suite and the command ----------------------------------------------------------------------------------------


def test_the_suite_holds_what_it_promises():
    abouts = [about for about, _ in suite.motions().values()]
    assert abouts == [
        "free symmetric", "free asymmetric", "near the separatrix", "heavy symmetric, loops", "heavy symmetric, cusps",
        "heavy asymmetric", "gravity gradient", "damped and driven", "extreme inertia", "fast spin",
    ]  # fmt: skip


@pytest.mark.usefixtures("known_reference")
def test_the_suite_writes_its_files(tmp_path, monkeypatch):
    monkeypatch.setattr(suite, "motions", lambda: {"one": ("one kind", scene())})
    result, said = suite.run(tmp_path / "bench", "taylor,DOP853", True, lambda text: None, rounds=1)
    assert [item["peer"] for item in result["summary"]] == ["SciPy DOP853"]
    names = {path.name for path in (tmp_path / "bench").iterdir()}
    figures = {"motions.png", "suite.png"} if find_spec("matplotlib") else set()
    assert names == {"suite.json", "suite.md"} | figures
    assert json.loads((tmp_path / "bench" / "suite.json").read_text())["format"] == "symrot suite 1"
    assert any("one kind" in line for line in said)


def test_an_interrupted_suite_goes_on(tmp_path, monkeypatch, found):
    """Finished studies are kept and files of an earlier suite stay complete; with other options the suite starts again."""
    studied, broken = [], True

    def pretended(one, *rest):
        if one.name == "second" and broken:
            raise KeyboardInterrupt
        studied.append(one.name)
        return found | {"scene": found["scene"] | {"digest": digest(Problem(one))}}

    motions = {name: (name, Scene.from_dict(SHORT, name)) for name in ("first", "second")}
    monkeypatch.setattr(suite, "motions", lambda: motions)
    monkeypatch.setattr(suite, "study", pretended)
    with pytest.raises(KeyboardInterrupt):
        suite.run(tmp_path, None, True, lambda text: None)
    assert [path.name for path in tmp_path.iterdir()] == ["unfinished.json"]
    broken = False
    _, said = suite.run(tmp_path, None, True, lambda text: None)
    assert studied == ["first", "second"]
    assert "1 of 2 motions come from an earlier run, which was interrupted." in said
    assert not (tmp_path / "unfinished.json").exists()
    (tmp_path / "unfinished.json").write_text("{")
    suite.run(tmp_path, None, False, lambda text: None)
    assert studied == ["first", "second"] * 2


def test_the_command_studies_compares_and_draws(tmp_path, capsys):
    file, plot = tmp_path / "mine.toml", tmp_path / "mine.svg"
    file.write_text(SCENE)
    out = tmp_path / "a.json"
    extra = ["--plot", str(plot)] if find_spec("matplotlib") else []
    assert main(["bench", str(file), "--quick", "--methods", "exact,taylor,dop853", "--out", str(out), *extra]) == 0
    assert "time against error" in capsys.readouterr().out
    assert json.loads(out.read_text())["format"] == "symrot work-precision 1"
    if extra:
        assert "symrot Taylor" in re.sub(r"<!--|-->", "", plot.read_text())
    assert main(["bench", "--compare", str(out), str(out), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ratios"]["taylor"]["mean"] == pytest.approx(1.0)
    assert main(["bench", "--list"]) == 0
    assert "symrot.bench.dense" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "exactly one of"),
        (["--skip", "--list"], "exactly one of"),
        (["tumbling_prism", "--list"], "does not accept SCENE"),
        (["--skip", "--methods", "taylor"], "does not accept --methods"),
        (["tumbling_prism", "--methods", "euler"], "'euler'"),
        (["tumbling_prism", "--tolerances", "1e-3,nan"], "'1e-3,nan'"),
        (["tumbling_prism", "--tolerances", "-1"], "'-1'"),
        (["tumbling_prism", "--tolerances", "1e-9,1e-3"], "expected decreasing numbers"),
        (["tumbling_prism", "--tolerances", ""], "expected decreasing numbers"),
        (["tumbling_prism", "--rounds", "0"], "at least 1, got 0"),
        (["--skip", "--rounds", "3"], "does not accept --rounds"),
        (["--suite", "-o", "/dev/null/x"], "cannot be created"),
        (["tumbling_prism", "--out", "x.txt"], ".json"),
        (["tumbling_prism", "--plot", "x.doc"], ".svg"),
        (["tumbling_prism", "-o", "x"], "does not accept -o"),
        (["no_such_scene"], "no_such_scene"),
        (["--compare", "a.json", "b.json"], "a.json"),
    ],
)
def test_bad_options_are_one_sentence(words, said, capsys):
    assert main(["bench", *words]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_the_list_of_studies_is_complete():
    """`symrot bench --list` names each module of the room that runs as a command."""
    room = Path(command.__file__).parent
    runnable = [path for path in room.rglob("*.py") if 'if __name__ == "__main__":' in path.read_text(encoding="utf-8")]
    names = {".".join(path.relative_to(room).with_suffix("").parts) for path in runnable}
    assert names == set(command.STUDIES)


@pytest.mark.parametrize("name", ["inertia_box", "nosuch"])
def test_a_kernel_without_a_textbook_formula_is_refused_in_a_sentence(name, capsys):
    with pytest.raises(SystemExit) as caught:
        kernels.main(["--kernels", name])
    assert caught.value.code == 2
    assert "expected a kernel with a textbook formula (quaternion_dcm, " in (said := capsys.readouterr().err)
    assert said.endswith(f"got {name!r}\n")


@pytest.mark.parametrize("name", ["quaternion_dcm_by_q", "euler_zyx_body_rates_by_angles_by_omega"])
def test_derivatives_need_no_more_operations_than_those_of_other_tools(name):
    """SymPy always takes part; SymForce and CasADi do where they are installed."""
    operations, missing = kernels.counts(name)
    totals = {tool: count.total() for tool, count in operations.items()}
    assert "SymPy cse" in totals and set(missing) <= {"SymForce", "CasADi"}
    assert totals.pop("symrot") <= min(totals.values())


@pytest.mark.parametrize(
    "name", ["quaternion_dcm_by_q", pytest.param("heavy_top_by_omega_by_q", marks=pytest.mark.campaign)]
)
def test_textbook_derivatives_are_those_of_the_kernel(name):
    """The formulas that the other tools get have the values of symrot's kernel."""
    point = {each: Fraction(k + 2, 7) for k, each in enumerate(input_names(name))}
    theirs = textbook_program(name).evaluate(point, {}, Fraction)
    assert theirs == kernel_program(name).evaluate(point, {}, Fraction)


def test_the_operations_are_counted_in_one_command(capsys):
    kernels.main(["--count", "--kernels", "quaternion_dcm_by_q"])
    assert "quaternion_dcm_by_q: symrot 27, SymPy cse " in capsys.readouterr().out


def test_steps_of_other_tools_are_left_out_where_they_are_not_installed(capsys, monkeypatch):
    def absent(step):
        raise ImportError

    monkeypatch.setattr(steps, "PEERS", {"CasADi": absent})
    steps.main(["--count", "--scenes", "tumbling_prism"])
    assert "tumbling_prism_rk4_step: symrot 193" in (report := capsys.readouterr().out)
    assert "not installed, left out: CasADi" in report


@pytest.mark.campaign
def test_steps_of_other_tools_compile_and_agree(capsys):
    """The study compares the states after a step before it times the step."""
    steps.main(["--rounds", "1", "--scenes", "tumbling_prism"])
    rows = capsys.readouterr().out.splitlines()[:2]
    assert all(row.count(" ns)") == 1 + sum(tool in row for tool in steps.PEERS) for row in rows)


@pytest.mark.parametrize(
    ("run", "arguments"),
    [(overhead.main, ["nonsense"]), (starts.main, ["nonsense"]), (starts.main, ["nonsense", "--ensembles"]),
     (steps.main, ["--scenes", "nonsense"])],
)  # fmt: skip
def test_an_unknown_scene_is_refused_in_one_sentence(run, arguments, capsys):
    with pytest.raises(SystemExit):
        run(arguments)
    assert "nonsense: expected a scene" in capsys.readouterr().err


@pytest.mark.usefixtures("known_reference")
def test_a_method_whose_states_are_not_finite_is_left_out_with_the_reason(monkeypatch):
    """So that the study, as JSON, has no infinite error, which is no number of JSON."""
    lost = next(one for one in CONTESTANTS if one.name == "taylor")
    lost = lost._replace(name="lost", prepare=lambda problem, tolerance: lambda stop: (np.full(7, np.nan), 1))
    kept = next(one for one in CONTESTANTS if one.name == "dop853").at((1e-6,))
    monkeypatch.setattr(work_precision, "chosen", lambda methods, quick: (lost.at((1e-3, 1e-6)), kept))
    result = study(scene(), quick=True, rounds=1)
    assert {run["method"] for run in result["runs"]} == {"dop853"}
    assert result["skipped"] == [
        {"method": "lost", "why": "at 1e-03: expected finite states, got infinite or undefined ones"}
    ]
    json.dumps(result, allow_nan=False)


def test_the_error_of_a_mesh_is_that_against_exact_integrals_of_any_size(tmp_path, monkeypatch):
    """A mesh above the size up to which integrals are exact by default."""
    path = tmp_path / "ellipsoid.obj"
    vertices, triangles = meshes.ellipsoid(100)
    rows = [("v", *vertex) for vertex in vertices.tolist()] + [("f", *corners) for corners in (triangles + 1).tolist()]
    path.write_text("".join(f"{' '.join(map(str, row))}\n" for row in rows))
    monkeypatch.setattr(meshes.meshes, "MOST_EXACT", 1)
    assert 0 < meshes._measured_error(path) < 1e-14
    assert meshes.meshes.MOST_EXACT == 1


def test_claims_of_the_study_of_checks_are_forty_typical_and_forty_naming_ones():
    assert [len({*check.claims(group)}) for group in check.LIMITS] == [40, 40, 20]
    with pytest.raises(InputError, match=r"one of typical, naming, conditional; got 'typcal' .*did you mean 'typical'"):
        check.claims("typcal")
