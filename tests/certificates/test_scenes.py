"""Rounding bounds of a scene's own kernel: on a box that the user states, audited, and quoted in the header comment."""

import json
from fractions import Fraction
from pathlib import Path
from random import Random

import pytest

from symrot.certificates import recheck
from symrot.certificates.certificate import certificate_json
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.constants import parameter_range
from symrot.certificates.rounding.section import check_section
from symrot.cli.main import main
from symrot.errors import InputError
from symrot.formula.tree import parse
from symrot.planning.scene_kernel import bind
from symrot.scene.scene import load_scene
from symrot.workshop.bounds import facts, rounding_problem, section
from symrot.workshop.emit import emit
from symrot.workshop.kernel_files import stored_bounds
from symrot.workshop.kernel_text import kernel_text, scene_text

CUBE = ("omega_1=-1:1", "omega_2=-1:1", "omega_3=-1:1")
PART = ("q0=1/2:1", "q1=0:1/2", "q2=0:1/2", "q3=0:1/2")
BOXES = {  # scenes of different structure
    "t_handle": ("omega_1=0:1", "omega_2=0:1", "omega_3=0:2", *PART),
    "heavy_top_loops": ("omega_1=1:10", "omega_2=1:10", *PART),
    "damped_disk": ("omega_1=0:3", "omega_2=0:3", "omega_3=0:3", *PART),
}


def _options(ranges):
    return [part for text in ranges for part in ("--box", text)]


@pytest.mark.thinned(3)
@pytest.mark.parametrize("scene", BOXES)
def test_no_error_is_above_its_bound(scene):
    """The formulas are polynomials, so Fractions compute the exact values at the same floating-point inputs."""
    operations, _, box = rounding_problem(kernel_text(scene), BOXES[scene], "double")
    (part,) = section(kernel_text(scene), BOXES[scene])["precisions"]
    bounds = {each["output"]: Fraction(float.fromhex(each["absolute"])) for each in part["outputs"]}
    draw, worst = Random(5), dict.fromkeys(bounds, 0.0)
    for _ in range(150):
        point = {place: draw.uniform(*map(float, ends)) for place, ends in box.items() if place[0] != "t"}
        quaternion = [place for place in point if place[0] == "y"][-4:]
        norm = sum(point[place] ** 2 for place in quaternion) ** 0.5
        point |= {place: point[place] / norm for place in quaternion} | {"t": 0.0}
        if not all(box[place][0] <= Fraction(x) <= box[place][1] for place, x in point.items()):
            continue
        exact = _exactly(operations, point)
        for place, value in _computed(operations, point).items():
            error = abs(Fraction(value) - exact[place])
            assert error <= bounds[place]
            worst[place] = max(worst[place], float(error / bounds[place]) if bounds[place] else 0.0)
    assert min(worst.values()) > 0.2  # and no bound is idle


def _walk(operations, point, number):
    rules = {"add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "neg": lambda a: -a}
    values = []
    for kind, *rest in operations.nodes:
        if kind in ("in", "const"):
            values.append(number(point[rest[0]] if kind == "in" else rest[0]))
        else:
            values.append(rules[kind](*(values[i] for i in rest)))
    return {place: values[index] for place, index in operations.outputs}


def _exactly(operations, point):
    return _walk(operations, point, Fraction)


def _computed(operations, point):
    return _walk(operations, point, float)


def test_certify_audit_and_emit_keep_the_bounds(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["certify", "t_handle", *_options(BOXES["t_handle"]), "-o", "k"]) == 0
    assert "  rounding " in capsys.readouterr().out
    path = Path("k/t_handle_rates.cert.json")
    certificate, source = path.read_text(encoding="utf-8"), Path("k/t_handle_rates.c").read_text(encoding="utf-8")
    head = " ".join(line.strip(" *") for line in source.splitlines())
    assert (
        "Box: omega_1, omega_2 in [0, 1]; omega_3 in [0, 2]; q0 in [0.5, 1]; q1, q2, q3 in [0, 0.5]; other par" in head
    )
    assert "rad/s^2 in domega_1, domega_2, domega_3" in head
    assert main(["audit", str(path), "--rerun-bounds"]) == 0
    assert "computed again" in capsys.readouterr().out
    assert main(["emit", "t_handle", "-o", "k"]) == 0  # writes nothing: all is as it was
    assert (capsys.readouterr().out, path.read_text(encoding="utf-8")) == ("", certificate)
    assert main(["certify", "t_handle", "-o", "k"]) == 0
    assert path.read_text(encoding="utf-8") == certificate
    Path("k/t_handle_rates.c").write_text(source.replace("1/s in dq0", "5/s in dq0"), encoding="utf-8")
    assert main(["audit", str(path)]) == 1
    Path("k/t_handle_rates.c").write_text(source, encoding="utf-8")
    data = json.loads(certificate)
    data["rounding"]["box"]["y[0]"] = [(-9.0).hex(), (9.0).hex()]
    path.write_text(json.dumps(data), encoding="utf-8")
    assert main(["audit", str(path)]) == 1


@pytest.mark.parametrize("part", ["absolute", "scale", "budget"])
def test_a_forged_bound_is_not_printed_again(tmp_path, capsys, monkeypatch, part):
    """The forged bound is consistent, so that one point cannot refute it; emitting again leaves out any bound."""
    monkeypatch.chdir(tmp_path)
    assert main(["certify", "t_handle", *_options(BOXES["t_handle"]), "-o", "k"]) == 0
    path = Path("k/t_handle_rates.cert.json")
    data = json.loads(path.read_text(encoding="utf-8"))
    outputs, less = data["rounding"]["precisions"][0]["outputs"], 1 - 2**-31
    if part == "absolute":
        worst = outputs[-1]  # of 2.6875 units, 2.688 as they are rounded up
        worst["absolute"], worst["pointwise"] = (
            (float.fromhex(worst[name]) * less).hex() for name in ("absolute", "pointwise")
        )
    elif part == "scale":
        outputs[0]["scale"] = (float.fromhex(outputs[0]["scale"]) / 2).hex()
    else:
        data["rounding"]["budget"] = 10**9
    emitted = emit("t_handle")
    check_section(data["rounding"], read_kernel(emitted.source, emitted.function, "t_handle_rates.c"), None)
    path.write_text(json.dumps(data), encoding="utf-8")
    assert stored_bounds(kernel_text("t_handle"), Path("k")) is None
    assert main(["emit", "t_handle", "-o", "k"]) == 0
    assert "Errors:" not in Path("k/t_handle_rates.c").read_text(encoding="utf-8")
    assert json.loads(path.read_text(encoding="utf-8")).get("rounding") is None
    assert main(["audit", str(path)]) == 0


def test_bounds_of_a_scene_file_and_without_any(tmp_path, capsys, monkeypatch):
    """A scene file of the user is certified in the same way; without ranges there are no bounds, and no comment states
    any.
    """
    monkeypatch.chdir(tmp_path)
    shipped = Path(__file__).parents[2] / "symrot" / "scene" / "shipped" / "gyrostat.toml"
    Path("mine.toml").write_bytes(shipped.read_bytes())
    ranges = _options(("omega_1=-1:1", "omega_2=-1:1", "omega_3=-1:1", "p0=0:1"))
    assert main(["certify", "mine.toml", *ranges, "-o", "k"]) == 0
    assert main(["audit", "k/mine_rates.cert.json"]) == 0
    assert "p0 in [0, 1]" in Path("k/mine_rates.c").read_text(encoding="utf-8").replace("\n *    ", "")
    assert main(["certify", "gyrostat", "-o", "k"]) == 0
    assert json.loads(Path("k/gyrostat_rates.cert.json").read_text(encoding="utf-8")).get("rounding") is None
    assert "Errors:" not in Path("k/gyrostat_rates.c").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("part", "change"),
    [
        ("flags", lambda flags: flags | {"allowed": flags["allowed"] | {"-Ofast": "changes no value"}}),
        ("flags", lambda flags: flags | {"void": {}}),
        ("trusted", lambda trusted: {}),
        ("coq", lambda section: {"file": "quaternion.v", "theorem": "own", "statement": "proven"}),
    ],
)
def test_an_audit_without_the_scene_still_knows_flags_assumptions_and_theorems(tmp_path, capsys, part, change):
    """They do not depend on the scene: no flag becomes harmless, and no theorem proven, because a forger says so."""
    path = tmp_path / "own.toml"
    path.write_text(load_scene("gyrostat").to_toml(), encoding="utf-8")
    assert main(["emit", str(path), "-o", str(tmp_path)]) == 0
    certificate = tmp_path / "own_rates.cert.json"
    assert main(["audit", str(certificate)]) == 0
    forged = json.loads(certificate.read_text(encoding="utf-8"))
    certificate.write_text(certificate_json(forged | {part: change(forged[part])}), encoding="utf-8")
    assert main(["audit", str(certificate)]) == 1
    assert f"expected '{part}' as symrot prints it now" in capsys.readouterr().err


def test_time_is_the_span_of_the_scene_and_parameters_are_points():
    _, problem, box = rounding_problem(
        kernel_text("gravity_gradient_satellite"), [f"omega_{i}=-0.01:0.01" for i in (1, 2, 3)], "double"
    )
    assert box["t"] == (0, 28400) and problem.region.unit == (("y[3]", "y[4]", "y[5]", "y[6]"),)
    assert all(low == high for place, (low, high) in box.items() if place[0] == "p")
    _, _, free = rounding_problem(kernel_text("t_handle"), CUBE, "double")
    emitted = emit("t_handle")
    operations = read_kernel(emitted.source, emitted.function, "t_handle_rates.c")
    assert list(free) == list(operations.inputs) and free["t"][1] > 10**308  # not used: any


# --- ranges of physical constants ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scene", "ranges"),
    [("t_handle", ("A=1:2", "B=2:5/2", "C=1:3/2")), ("heavy_top_loops", ("weight=4:5", "A=1/500:1/400")),
     ("gravity_gradient_satellite", ("mean_motion=1e-3:2e-3",)), ("damped_disk", ("linear_3=-1:1",))],
)  # fmt: skip
def test_parameters_of_constants_in_their_ranges_are_in_the_box(scene, ranges):
    """Random constants give parameters inside the box, and the box is not much larger than necessary."""
    free = [f"{symbol}=-1/2:1/2" for symbol in ("omega_1", "omega_2", "omega_3") if symbol in _states(scene)]
    _, _, box = rounding_problem(kernel_text(scene), [*free, *ranges], "double")
    inputs, draw = scene_text(scene).inputs, Random(3)
    wide = {name: list(map(Fraction, ends.split(":"))) for name, ends in (text.split("=") for text in ranges)}
    for place, parameter in inputs.formulas.items():
        met = []
        for number in range(200):
            corner = [draw.randrange(2) if number < 60 else Fraction(draw.random()) for _ in wide]
            drawn = {
                name: low + at * (high - low) for at, (name, (low, high)) in zip(corner, wide.items(), strict=True)
            }
            met.append(Fraction(bind((parameter,), inputs.constants | drawn)[0]))
        low, high = box[place]
        spare = max(abs(low), abs(high)) / 2**53
        assert low - spare <= min(met) and max(met) <= high + spare
        assert high - low <= Fraction(5, 4) * (max(met) - min(met)) + 2 * spare


def _states(scene):
    return [symbol for symbol, _ in scene_text(scene).inputs.components.values()]


def test_a_range_of_a_constant_is_as_wide_as_the_parameters_it_makes():
    """A range of one point changes nothing; powers, roots and quotients are enclosed."""
    a, ends = parse("a"), (Fraction(-1), Fraction(2))
    assert parameter_range("p", a, {}, {"a": ends}) == ends
    assert parameter_range("p", parse("a**2"), {}, {"a": ends}) == (0, 4)
    assert parameter_range("p", parse("abs(a)**3"), {}, {"a": ends}) == (0, 8)
    low, high = parameter_range("p", parse("sqrt(a)/(1 + a)"), {}, {"a": (Fraction(1), Fraction(4))})
    assert Fraction(39, 100) < low < Fraction(2, 5) and Fraction(1, 2) < high < Fraction(51, 100)
    low, high = parameter_range("p", parse("b*sin(a)*pi"), {"b": Fraction(2)}, {"a": ends})
    assert (low, high) == (-high, high) and 6 < high < 7
    for formula in ("1/a", "sqrt(a)", "a**-2"):
        with pytest.raises(InputError, match=r"is a finite number, got a -1 \.\. 2"):
            parameter_range("p", parse(formula), {}, {"a": ends})
    with pytest.raises(InputError, match=r"if its constants vary, got tan\(a\), which contains tan"):
        parameter_range("p", parse("tan(a)"), {}, {"a": ends})
    _, _, points = rounding_problem(kernel_text("t_handle"), CUBE, "double")
    exact = scene_text("t_handle").inputs.constants["A"]
    _, _, same = rounding_problem(
        kernel_text("t_handle"),
        (*CUBE, f"A={exact.limit_denominator(10**9)}:{exact.limit_denominator(10**9)}"),
        "double",
    )
    assert all(abs(same[place][0] / points[place][0] - 1) < 1e-8 for place in ("p[0]", "p[1]", "p[2]"))


def test_what_does_not_overflow_is_bounded_to_the_largest_numbers(capsys):
    """Bounds that are too large for a double in units of 2^-53 are still printed, rounded up."""
    assert main(["bound", "t_handle", *_options((*CUBE, "p0=-1e308:1e308")), "--json"]) == 0
    (part,) = json.loads(capsys.readouterr().out)["precisions"]
    error, units = (part["outputs"][0][name] for name in ("absolute", "units"))
    assert 1 <= Fraction(units) / (Fraction(float.fromhex(error)) * 2**53) < 1 + Fraction(1, 500)


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["bound", "t_handle", *_options((*CUBE, "mass=1:2"))], "or a constant in its parameters, one of t, omega_1"),
        (
            ["bound", "t_handle", *_options((*CUBE, "A=0:1"))],
            "on which p0 = (B - C)/A is a finite number, got A 0 .. 1",
        ),
        (
            ["bound", "t_handle", *_options((*CUBE, "A=1:2", "p0=0:1"))],
            "either a range of p0 or ranges of the constants",
        ),
        (["bound", "t_handle", *_options((*CUBE, "y[0]=0:1"))], "expected one range of y[0], got also 'omega_1=-1:1'"),
        (["bound", "t_handle", *_options((*CUBE, "q0=0:1.7976931348623158e308"))], "within the range of a double"),
        (["bound", "t_handle", *_options((*CUBE, "A=1e-300:1e-290", "B=1e20:1e30"))], "within the range of a double"),
        (["bound", "t_handle", *_options((*CUBE, "=0:1"))], "expected NAME=LOW:HIGH"),
        (["bound", "t_handle", "--box", "omega_1=0:1 rad/s"], "expected a number"),
        (["bound", "t_handle", "--box", "omega_1=0:60deg"], "write it without a unit"),
        (["bound", "t_handle", "--box", "omga_1=0:1"], "did you mean 'omega_1'?"),
        (["bound", "t_handle"], "--box omega_1=LOW:HIGH --box omega_2=LOW:HIGH --box omega_3=LOW:HIGH"),
        (["certify", "t_handle", "--box", "omega_1=-1:1"], "--box omega_2=LOW:HIGH --box omega_3=LOW:HIGH"),
        (["certify", "t_handle", "--box", "omega_1=nan:1"], "expected a number"),
        (["certify", "t_handle", "--box", "omega_9=0:1"], "in its parameters, one of t, omega_1"),
        (
            ["bound", "t_handle", *_options(("omega_1=2:1", "omega_2=0:1", "omega_3=0:1"))],
            "the smaller value first, got 2 to 1",
        ),
        (["bound", "t_handle", *_options((*CUBE, "q0=2:3"))], "a box that contains a unit quaternion"),
        (
            ["bound", "t_handle", *_options([f"omega_{i}=-1e200:1e200" for i in (1, 2, 3)])],
            "the error of domega_1 is bounded",
        ),
        (["bound", "t_handle", *_options(CUBE), "--target", "1e-13", "--variable", "t"], "it does not use t"),
        (["bound", "t_handle", "--precision", "float"], "expected double for a scene"),
        (["bound", "t_handl"], "did you mean 't_handle'?"),
        (["certify", "t_handle", "--no-bounds", "--box", "omega_1=0:1"], "leave out one of them"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_bad_box_is_one_sentence(arguments, sentence, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    output = capsys.readouterr()
    assert sentence in output.err and output.err.count("\n") == 1 and output.out == "" and not list(tmp_path.iterdir())


def test_the_largest_box_of_a_scene_has_the_target():
    from symrot.workshop.bounds import target_facts

    result = target_facts("t_handle", BOXES["t_handle"], "double", 1e-13, ("omega_1",))
    assert result["size"] > 1 and float.fromhex(result["largest_error"]) <= 1e-13
    assert result["box"]["y[3]"] == [(0.5).hex(), (1.0).hex()]
    (part,) = facts("t_handle", BOXES["t_handle"], "double")["precisions"]
    assert max(float.fromhex(each["absolute"]) for each in part["outputs"]) < 1e-13


@pytest.mark.parametrize("q0, q1", [("3/5", "4/5"), (1, 0)])
def test_a_pendulum_that_starts_anywhere_is_certified(q0, q1, tmp_path, capsys):
    """The laws hold for the attitudes from which it may start: two numbers whose squares sum to one."""
    scene = tmp_path / "pendulum.toml"
    scene.write_text(
        f"""schema = 1
title = "Pendulum"
source = "made for this test"
body = {{about = "fixed_point", principal = ["11/10", "11/10", "4/5"]}}
initial = {{omega = ["1/2", 0, 0], attitude = {{quaternion = ["{q0}", "{q1}", 0, 0]}}}}
torque = [{{kind = "gravity", center_of_mass = [0, 0, "1/10"], weight = 9.81}}]
span = {{t = [0, 10], samples = 11}}
output = {{quantities = ["omega", "quaternion"]}}
""",
        encoding="utf-8",
    )
    assert main(["emit", str(scene), "--target", "c", "-o", str(tmp_path)]) == 0
    path = tmp_path / "pendulum_rates.cert.json"
    hypotheses = [law["given"] for law in json.loads(path.read_text(encoding="utf-8"))["laws"]]
    assert hypotheses == [["initial_q0", "initial_q1"] if q1 else []] * len(hypotheses)
    assert "laws" in recheck.check(path)
    assert main(["audit", str(path)]) == 0
    capsys.readouterr()
