"""Reports of a run's switches and of a plan's narrow features, and the width of these lines."""

import json
import sys

import pytest

import symrot
from symrot.cli import main as cli
from symrot.report import layout
from symrot.scene.scene import Scene
from tests.needs import needs_compiler

pytestmark = pytest.mark.usefixtures("quick_compiler")
FRICTION = "-k*sign(omega_3) + where(t > 8, 2*k, 0)"
METHODS = ["taylor", "dop853", "scipy:DOP853"]


def wheel(formula=FRICTION, omega=3, **more):
    return {
        "schema": 1, "title": "wheel", "body": {"principal": [1, 1, 2]}, "initial": {"omega": [0, 0, omega]},
        "torque": [{"kind": "expression", "torque": ["0", "0", formula], "parameters": {"k": 1}}],
        "span": {"t": [0, 10], "samples": 3},
    } | more  # fmt: skip


def toml(scene):
    torque = scene["torque"][0]
    return "\n".join([
        "schema = 1", f'title = "{scene["title"]}"', "[body]", f"principal = {scene['body']['principal']}",
        "[initial]", f"omega = {scene['initial']['omega']}", "[[torque]]", 'kind = "expression"',
        f"torque = {json.dumps(torque['torque'])}", "parameters = {k = 1}", "[span]", f"t = {scene['span']['t']}",
    ])  # fmt: skip


# --- switches of a run ------------------------------------------------------------------------------------------------


@needs_compiler
@pytest.mark.parametrize("method", METHODS)
def test_a_switch_that_holds_is_told_from_one_that_is_passed(method):
    """Friction of 1 N m stops 2 kg m^2 at 3 rad/s after 6 s and holds it until a torque of 2 N m begins at 8 s."""
    stats = symrot.propagate(Scene.from_dict(wheel(), "wheel"), method=method, tolerance=1e-9).stats
    assert [(each.function, each.how) for each in stats.switchings] == [
        ("sign(omega_3)", "held"), ("8 < t", "passed"), ("sign(omega_3)", "released"),
    ]  # fmt: skip
    assert [each.t for each in stats.switchings] == pytest.approx([6, 8, 8], abs=1e-7)


@needs_compiler
def test_switches_that_coincide_have_one_time():
    formula = "where(t > 2, 1, 0) + step(2 - t) + sign(t - 2) + floor(t/2)"
    stats = symrot.propagate(Scene.from_dict(wheel(formula, span={"t": [0, 3], "samples": 3}), "wheel")).stats
    assert stats.switching_times == (2.0,)
    assert stats.switches == 1
    assert {each.function for each in stats.switchings} == {"2 < t", "step(2 - t)", "sign(t - 2)", "floor(t/2)"}


@needs_compiler
def test_the_dense_output_and_the_events_of_a_motion_tell_the_same():
    scene = Scene.from_dict(wheel(), "wheel")
    plain, watched = symrot.propagate(scene), symrot.propagate(scene, events=["omega_3 - 1"])
    assert watched.stats.switchings == plain.stats.switchings


@needs_compiler
@pytest.mark.parametrize("method", METHODS)
def test_friction_stops_a_body_in_one_direction_by_every_method(method):
    """omega_3 falls to zero at 6 s, whichever way the wheel turns when it breaks loose at 8 s."""
    scene = Scene.from_dict(wheel(), "wheel")
    events = ["omega_3", {"formula": "omega_3", "direction": -1}, {"formula": "omega_3", "direction": 1}]
    found = symrot.propagate(scene, method=method, events=events)
    assert [times.tolist() for times in found.t_events[:2]] == [[pytest.approx(6, abs=1e-12)]] * 2
    assert found.event_kinds[0] == ["falling"] and not len(found.t_events[2])


@needs_compiler
def test_the_summary_and_json_say_what_each_switch_does(tmp_path, capsys):
    path = tmp_path / "wheel.toml"
    path.write_text(toml(wheel()))
    assert cli.main(["run", str(path)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "switches sign(omega_3) at t = 6 (held from there on), 8 (released) s 8 < t at t = 8 s" in said
    assert cli.main(["run", str(path), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert len(found["switching_times"]) == 2
    assert [item["how"] for item in found["switchings"]] == ["held", "passed", "released"]


@needs_compiler
def test_switching_times_close_together_are_told_apart(tmp_path, capsys):
    path = tmp_path / "wheel.toml"
    path.write_text(toml(wheel("step(t - 5) - step(t - 5.0000001)")))
    assert cli.main(["run", str(path)]) == 0
    said = capsys.readouterr().out
    assert "at t = 5 s" in said and "at t = 5.0000001 s" in said


def test_many_switches_stay_few_lines():
    from symrot.report.summary import _switches

    times = [k / 7 for k in range(1, 100)]
    items = [{"t": t, "function": f"sign(t - {k % 9})", "how": "passed"} for k, t in enumerate(times)]
    rows = _switches(times, items, "0", "20")
    assert len(rows) == 7 and rows[-1][1] == ".. (9 functions in all; --json lists them)"
    assert rows[0][1].endswith("(11 times in all) s")


# --- explain ----------------------------------------------------------------------------------------------------------


def rows_of(formula, **more):
    torque = {"kind": "expression", "torque": ["0", formula, "0.0"], "parameters": {"k": 1}} | more
    scene = Scene.from_dict(wheel(torque=[torque]), "wheel")
    from symrot.report.explain import facts

    return {row["item"]: row for row in facts(symrot.plan(scene))["rows"]}


def test_components_without_torque_are_named_in_words():
    assert rows_of("exp(-t)")["torque terms"]["why"] == "the formulas give no torque about body axes 1 and 3"
    assert rows_of("0", frame="space")["torque terms"]["why"].endswith("about space axes 1, 2 and 3")
    assert rows_of("exp(-t)")["torque terms"]["skipped"]


def test_a_torque_by_formulas_is_not_said_to_leave_the_axis():
    """This torque stays along axis 3, but the plan does not check this and may not claim the opposite."""
    scene = Scene.from_dict(wheel("exp(-t)"), "wheel")
    (row,) = [row for row in symrot.plan(scene).rows if row.item == "rotation out of one axis"]
    assert not row.skipped and "is assumed to change the axis" in row.why


def test_explain_says_what_is_done_about_narrow_features():
    assert "enclosure" in rows_of("exp(-((t - 2)/0.01)**2)")["narrow features"]["why"]
    assert rows_of("sin(3*t)*omega_2 - k*q0")["narrow features"]["skipped"]
    assert "narrow features" not in {row.item for row in symrot.plan(symrot.load_scene("t_handle")).rows}


def test_explain_says_what_is_done_at_switches():
    why = rows_of("-k*sign(omega_3) + max(t, 2)*step(t - 1)")["switches"]["why"]
    assert why.startswith("sign(omega_3), step(t - 1) jump; max(t, 2) bend: ")
    assert "slides" in why and "located" in why
    assert "switches" not in rows_of("exp(-t)")


# --- the width of a terminal ------------------------------------------------------------------------------------------


class Terminal:
    def __init__(self, stream):
        self._stream = stream

    def isatty(self):
        return True

    def __getattr__(self, name):
        return getattr(self._stream, name)


def narrow(monkeypatch):
    """Make standard output a terminal of 80 columns until the test ends."""
    monkeypatch.setattr(sys, "stdout", Terminal(sys.stdout))
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("NO_COLOR", "1")


@needs_compiler
@pytest.mark.parametrize("command", ["run", "explain"])
def test_texts_fit_a_terminal_of_80_columns(command, tmp_path, monkeypatch, capsys):
    path = tmp_path / "wheel.toml"
    path.write_text(toml(wheel("where(mod(t, 1) < 1/10, k, 0) - clip(omega_3, -k, k)*abs(omega_3)*exp(-t)")))
    assert cli.main(["run", str(path)]) == 0  # fills the cache, which `explain` mentions
    capsys.readouterr()
    assert cli.main([command, str(path)]) == 0
    wide = capsys.readouterr().out
    narrow(monkeypatch)
    assert cli.main([command, str(path)]) == 0
    out = capsys.readouterr().out
    assert max(map(len, wide.splitlines())) > 80 >= max(map(len, out.splitlines()))
    assert len(out.split()) >= len(wide.split())  # nothing is cut
    assert {word for word in wide.split() if word.isidentifier()} - {"us", "ms", "s"} <= {*out.split(), "us", "ms"}


def test_a_pipe_gets_the_same_bytes_however_wide_the_terminal(monkeypatch):
    rows = [("item", "rule " * 40)]
    plain = layout.columns(rows)
    monkeypatch.setenv("COLUMNS", "60")
    assert layout.columns(rows) == plain and layout.room() == 110


def test_a_wide_table_of_numbers_goes_on_below_itself(monkeypatch):
    narrow(monkeypatch)
    rows = [["method", *(f"1e-{k:02d}" for k in range(30))], ["taylor", *(f"{k}.25" for k in range(30))]]
    lines = layout.columns(rows, right=range(1, 31))
    assert max(map(len, lines)) <= 78
    named = layout.columns([["fastest, us", *rows[0][1:]]], right=range(1, 31))
    assert all(line.startswith("fastest, us") for line in named if line)  # which is not wrapped instead
    assert sum(line.startswith("method") for line in lines) == sum(line.startswith("taylor") for line in lines) > 1
    assert " ".join(lines).count("1e-") == 30


def test_every_column_of_text_is_wrapped_before_a_line_is_too_long(monkeypatch):
    narrow(monkeypatch)
    rows = [("a long name of an item", "many words in the middle of it all " * 3, "and more words at the end")] * 2
    assert max(map(len, layout.columns(rows, wrap=1))) <= 78
