"""Exact steps in C: equal to propagation, in chains of steps, for any axes; their certificates, forgeries, refusals."""

import ctypes
import json
import subprocess
from dataclasses import replace
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from sys import float_info

import mpmath
import numpy as np
import pytest

import symrot
from symrot.certificates.c_machine.machine import Machine
from symrot.certificates.certificate import certificate_json, seal
from symrot.certificates.exact_step import law
from symrot.certificates.exact_step.bounds import free_body_bounds
from symrot.certificates.exact_step.law import law_section
from symrot.certificates.step_certificate import formula_section
from symrot.cli.main import main
from symrot.codegen.steps import SteadyRotations, stepped
from symrot.errors import CertificateError, InputError
from symrot.formula.tree import FUNCTIONS, parse
from symrot.workshop.step_text import StepText, step_text
from symrot.workshop.steps import exact
from symrot.workshop.steps.whole_state import WholeState
from tests.needs import needs_compiler

CAMPAIGN = pytest.mark.campaign
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
SYMMETRIC = {"body": {"principal": [1, 2, 2]}}
SPHERE = {"body": {"principal": [2, 2, 2]}}
# the rotor alone rotates omega
SPHERE_WITH_ROTOR = {**SPHERE, "torque": [{"kind": "rotor", "angular_momentum": [0, 0, 3]}]}
PLANAR = {"body": {"principal": [2, 2, 3]}, "initial": {"omega": [0, 0, 2]}}
BOX = {"omega_1": (-1, 1), "omega_2": (-1, 1), "omega_3": (-1, 1), "dt": (0, "1/10")}


def scene_of(content):
    return symrot.Scene.from_dict({"schema": 1, "initial": START, "span": {"t": [0, 1]}, **content})


@needs_compiler
@pytest.mark.parametrize("content", [FREE, TOP, GYROSTAT, SPHERE], ids=["free", "top", "gyrostat", "sphere"])
def test_an_exact_step_is_the_motion(content, tmp_path):
    """To a few units of rounding, after a step of any size; twenty steps agree to their accumulated rounding."""
    scene = scene_of(content)
    text = step_text(scene, "exact")
    for name, content_of_file in text.c_files().items():
        (tmp_path / name).write_text(content_of_file)
    cc = ["cc", "-std=c99", "-Og", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror", "-fPIC"]
    subprocess.run([*cc, "-shared", f"{text.name}.c", "-lm", "-o", "step.so"], cwd=tmp_path, check=True)
    assert "malloc" not in text.c()[0]
    compiled = getattr(ctypes.CDLL(str(tmp_path / "step.so")), f"symrot_{text.name}")
    numbers = np.ctypeslib.ndpointer(np.float64)
    p = np.array([value for _, value in text._parameters])
    compiled.argtypes = [ctypes.c_double, numbers, *[numbers] * bool(p.size), ctypes.c_double, numbers]
    elliptic = not isinstance(text, StepText)
    compiled.restype = ctypes.c_int if elliptic else None

    def step(x, dt, after):
        return compiled(0.0, x, *[p] * bool(p.size), dt, after)

    start = np.array([float(x) for x in (*scene.initial.omega_b, *scene.initial.quaternion)])
    for dt in (0.01, -2.0, 1000.0):
        after = np.empty(7)
        assert step(start, dt, after) == (0 if elliptic else None)
        motion = symrot.propagate(scene, t=[dt], omega=start[:3], quaternion=start[3:])
        expected = np.concatenate([motion.omega[0], motion.quaternion[0]])
        rounding = 4e-15 + 2.0**-52 * abs(dt) * 3  # a rounding of the start or of p, times the time
        assert np.abs(after - expected).max() <= rounding * np.abs(start).max()
    state = start.copy()
    for _ in range(20):
        before = state.copy()  # the inputs of a certified step do not overlap its outputs
        step(before, 0.05, state)
    motion = symrot.propagate(scene, t=[1.0])
    assert np.abs(state - [*motion.omega[0], *motion.quaternion[0]]).max() < 1e-13
    state[0] = np.nan
    assert step(state, 0.1, after) == (1 if elliptic else None)
    assert np.isnan(after).all() if elliptic else np.isnan(after).any()


@needs_compiler
@pytest.mark.parametrize("scene", ["tumbling_prism", "axisymmetric_satellite"])
def test_the_emitted_test_passes(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(exact, "CHECKED", 1)  # states at which the certificate is checked
    assert main(["emit", scene, "--step", "exact", "-o", str(tmp_path)]) == 0
    files = sorted(path.name for path in tmp_path.glob("*.c"))
    subprocess.run(
        ["cc", "-std=c99", "-O0", "-ffp-contract=off", *files, "-lm", "-o", "check"], cwd=tmp_path, check=True
    )
    assert b"agrees" in subprocess.run([tmp_path / "check"], capture_output=True, check=True).stdout


@pytest.fixture(scope="module")
def elliptic(tmp_path_factory):
    """Return the folder and the certificate of the exact step of a heavy top, checked at one state."""
    folder = tmp_path_factory.mktemp("elliptic")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(exact, "CHECKED", 1)
        yield folder, symrot.certify("heavy_top_loops", directory=folder, step="exact")


def test_the_text_of_a_step_with_elliptic_functions_solves_the_equations(elliptic):
    """Run with 60 digits, at states that follow from the text; both functions, and nothing is called a proof."""
    folder, certificate = elliptic
    assert certificate.proofs == () and "checked, not proven" in str(certificate)
    laws = list(certificate.data["formula"].values())
    assert len(laws) == 2 and all(float(law["largest_violation"]) < 1e-15 for law in laws)
    (path,) = folder.glob("*.cert.json")
    statements = symrot.audit(path).statements[str(path)]
    assert "the scene in the certificate is the scene heavy_top_loops of symrot" in statements


@pytest.mark.campaign
@pytest.mark.parametrize("content", [FREE, TOP, {"body": {"principal": [1, 5, "5.9"]}}], ids=["free", "top", "flat"])
def test_the_law_holds_at_many_states(content):
    """A comment at the end changes the states: ten times five states, in all regimes."""
    text = step_text(scene_of(content), "exact")
    rates, p = WholeState(text.scene), [value for _, _, value in text.form.parameters]
    for k in range(10):
        source = f"{text.c()[0]}/* {k} */"
        law_section(source, f"symrot_{text.name}", rates.program, rates.exact_parameters, p, text._rate)


@pytest.mark.parametrize(("content", "old", "new"), [
    (FREE, "c->u = dd_mul(sine, ", "c->u = dd_mul(dd_negative(sine), "),  # the start of the phase
    (FREE, "1.0 + f->momentum[2]*b->dn[i]", "1.0 - f->momentum[2]*b->dn[i]"),  # the tilt of the angular momentum
    *(pytest.param(*each, marks=pytest.mark.campaign) for each in (
        (FREE, "kappa = prepare_circular(", "kappa = dd_of(1.0); prepare_circular("),  # the rate of precession
        (FREE, "next, next + 3);", "next + 4, next);"),  # the order of the state
        (TOP, "rates[6] = {x[", "rates[6] = {2.0*x["),
    )),
])  # fmt: skip
def test_a_wrong_text_violates_the_equations(content, old, new):
    text = step_text(scene_of(content), "exact")
    source, rates = text.c()[0], WholeState(text.scene)
    assert source.count(old) == 1
    p = [value for _, _, value in text.form.parameters]
    with pytest.raises(CertificateError, match="expected"):
        law_section(
            source.replace(old, new), f"symrot_{text.name}", rates.program, rates.exact_parameters, p, text._rate, 1
        )


def _edited(name, old, new):
    def change(folder):
        path = next(folder.glob(name))
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new, 1))

    return change


def _sealed(edit):
    def change(folder):
        (path,) = folder.glob("*.cert.json")
        data = json.loads(path.read_text())
        edit(data)
        data["seal"] = seal(data)
        path.write_text(certificate_json(data))

    return change


@pytest.mark.parametrize(("change", "message"), [
    (_edited("*step.c", "status)", "status && x[0] == 3.0)"), "an edited one"),
    (_edited("*parameters.h", "0.", "1."), "an edited one"), (_edited("*.cert.json", "5,", "7,"), "as symrot prints it"),
    (_sealed(lambda data: data["scene"]["content"]["body"].update(mass="0.6")), "an edited one"),
    (_sealed(lambda data: data["scene"]["content"].update(source="elsewhere")), "to be the scene heavy_top_loops"),
    (_sealed(lambda data: data["scene"].update(content=3)), "expected 'scene'"),
    (_sealed(lambda data: data["scene"]["content"].update(body={})), "expected 'scene'"),
    (_sealed(lambda data: data["scene"].update(name="other")), "got that of other_exact_step"),
    (_sealed(lambda data: data.update(trusted={})), "'trusted' as symrot prints it"),
    (_sealed(lambda data: data["rates"]["formulas"].pop()), "'rates' as symrot prints it"),
])  # fmt: skip
def test_forged_certificates_of_steps_with_elliptic_functions_are_refused(elliptic, tmp_path, change, message):
    for path in elliptic[0].iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    change(tmp_path)
    with pytest.raises(CertificateError, match=message):
        symrot.audit(next(tmp_path.glob("*.cert.json")))


WOBBLE = {"omega_1": (1, 1.2), "omega_2": (0.01, 0.1), "omega_3": (0.01, 0.1), "dt": (-1, 100)}


@pytest.fixture(scope="module")
def bounded(tmp_path_factory):
    """Return the folder and the certificate of the exact step of a body that wobbles about the axis of least inertia."""
    folder = tmp_path_factory.mktemp("bounded")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(exact, "CHECKED", 1)
        yield folder, symrot.certify("tumbling_prism", WOBBLE, directory=folder, step="exact")


def test_bounds_of_a_step_with_elliptic_functions_hold_at_random_states(bounded):
    """In doubles with rounding as in C, against 60 digits."""
    folder, certificate = bounded
    bounds = certificate.data["bounds"]
    most = np.array([float.fromhex(value) for value in bounds["rounding"].values()])
    assert max(map(float.fromhex, bounds["truncation"].values())) < 1e-19 and most.max() < 1e-14
    text = step_text("tumbling_prism", "exact")
    subprocess.run(
        ["cc", "-std=c99", "-Og", "-ffp-contract=off", "-fPIC", "-shared", f"{text.name}.c", "-lm", "-o", "step.so"],
        cwd=folder, check=True,
    )  # fmt: skip
    compiled = getattr(ctypes.CDLL(str(folder / "step.so")), f"symrot_{text.name}")
    numbers = np.ctypeslib.ndpointer(np.float64)
    compiled.argtypes = [ctypes.c_double, numbers, numbers, ctypes.c_double, numbers]
    machine, draw = Machine(text.c()[0], law._number, law._OWN), np.random.default_rng(4)
    p, worst = np.array([float(value) for _, _, value in text.form.parameters]), np.zeros(7)
    with localcontext(Context(prec=60)):
        for _ in range(5):
            omega, dt = [draw.uniform(low, high) for low, high in list(WOBBLE.values())[:3]], draw.uniform(-1, 100)
            x, after = np.array([*omega, *draw.normal(size=4)]), np.empty(7)
            compiled(0.0, x, p, dt, after)
            result = [Decimal(0)] * 7
            places = [([Decimal(float(number)) for number in numbers], 0) for numbers in (x, p)]
            machine.call(f"symrot_{text.name}", Decimal(0), *places, Decimal(dt), (result, 0))
            expected = [law._slope(each).value for each in result]
            worst = np.maximum(
                worst, [abs(float(Decimal(a) - b)) for a, b in zip(after.tolist(), expected, strict=True)]
            )
    assert (worst <= most).all() and most.max() < 200 * worst.max()


@pytest.mark.campaign
def test_bounds_hold_on_a_box_with_the_axis_of_rotation():
    """The components of omega across the axis have either sign, or are zero; the bounds are hardly larger."""
    box = {"omega_1": (1, 1.2), "omega_2": (-0.1, 0.1), "omega_3": (-0.1, 0.1), "dt": (-1, 100)}
    small, wide = (symrot.certify("tumbling_prism", each, step="exact").data["bounds"] for each in (WOBBLE, box))
    for name, value in wide["rounding"].items():
        assert float.fromhex(small["rounding"][name]) * 0.999 <= float.fromhex(value) < 1e-14


@pytest.mark.parametrize(("change", "message"), [
    (_sealed(lambda data: data["bounds"]["rounding"].update(q0=(1e-15).hex())), "the bounds that symrot computes"),
    (_sealed(lambda data: data["bounds"]["box"].update(omega_1=[(0.9).hex(), (1.2).hex()])), "the bounds that symrot"),
    (_sealed(lambda data: data["bounds"]["box"].update(dt=[(1.0).hex(), (0.0).hex()])), "smaller value is not first"),
    pytest.param(_sealed(lambda data: data["bounds"]["box"].update(omega_1=3)), "'box' in 'bounds'", marks=CAMPAIGN),
    pytest.param(
        _sealed(lambda data: data["bounds"]["rounding"].update(energy=(0.0).hex())), "as symrot prints it",
        marks=CAMPAIGN,
    ),
    pytest.param(_sealed(lambda data: data["bounds"].update(meaning="")), "'bounds' as symrot", marks=CAMPAIGN),
    pytest.param(_sealed(lambda data: data["bounds"].pop("truncation")), "'truncation' in 'bounds'", marks=CAMPAIGN),
])  # fmt: skip
def test_forged_bounds_of_steps_with_elliptic_functions_are_refused(bounded, tmp_path, monkeypatch, change, message):
    monkeypatch.setattr(exact, "CHECKED", 1)
    for path in bounded[0].iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (path,) = tmp_path.glob("*.cert.json")
    if message == "'box' in 'bounds'":
        assert (
            "bounds of rounding and truncation are those that symrot computes"
            in symrot.audit(path).statements[str(path)]
        )
    change(tmp_path)
    with pytest.raises(CertificateError, match=message):
        symrot.audit(path)


MOMENTS = [2.0, 3.0, 4.0]


@pytest.mark.parametrize(("box", "most"), [
    ({"omega_1": (0, 0), "dt": (0, "1e9")}, 0.0),  # at rest
    ({"omega_1": (5e-324, 5e-324), "dt": (-1, 1)}, 1e-318),
    ({"omega_3": ("7e307", "8e307"), "omega_1": ("1e307", "1e307"), "dt": (0, "1e-308")}, 1e293),
])  # fmt: skip
def test_bounds_exist_for_the_smallest_and_the_largest_doubles(box, most):
    ranges = {name: (Fraction(0), Fraction(0)) for name in BOX} | {
        name: (Fraction(low), Fraction(high)) for name, (low, high) in box.items()
    }
    text = step_text(scene_of(FREE), "exact")
    rounding, truncation = free_body_bounds(text.c()[0], f"symrot_{text.name}", MOMENTS, ranges)
    assert max(rounding[:3]) <= most and 1e-15 < max(rounding[3:]) < 1e-14 and max(truncation[3:]) < 1e-29


@pytest.mark.parametrize(("box", "message"), [
    # too small for the C text, which takes some of them as zero: a bound of no state at all would be true and useless
    ({"omega_2": (Fraction(1, 10**150), Fraction(1, 10**120))}, "omega_2 that contains 0 or .* at least 1e-100"),
    ({"dt": (0, 10**300)}, "grows by at most 1048576 revolutions, got"),
    ({"omega_1": (0, 0), "dt": (0, 10**300)}, "expected dt times .omega. of at most"),
    ({"omega_1": (1, Fraction(float_info.max))}, "middle axis"),
])  # fmt: skip
def test_boxes_beyond_the_range_of_the_bounds_are_refused(box, message):
    ranges = (
        {name: (Fraction(0), Fraction(0)) for name in BOX}
        | {"omega_1": (Fraction(1), Fraction(1))}
        | {name: (Fraction(low), Fraction(high)) for name, (low, high) in box.items()}
    )
    text = step_text(scene_of(FREE), "exact")
    with pytest.raises(InputError, match=message):
        free_body_bounds(text.c()[0], f"symrot_{text.name}", MOMENTS, ranges)


@pytest.mark.parametrize(("scene", "box", "message"), [
    ("tumbling_prism", BOX, "middle axis"), ("tumbling_prism", {"dt": (0, 1)}, "--box omega_1=LOW:HIGH"),
    ("heavy_top_loops", BOX, "does not bound the errors of the exact step of a heavy top"),
    ("tumbling_prism", {**WOBBLE, "omega_3": (1, 1.2), "omega_1": (0, 0)}, "middle axis"),
    ("tumbling_prism", {"omega_1": (0.1, 0.1), "omega_2": (0.1, 0.1), "omega_3": (5, 5), "dt": (0, 1)},
     r"got omega near \(0.1, 0.1, 5\), where symrot finds no bound"),
])  # fmt: skip
def test_boxes_without_bounds_are_refused(monkeypatch, scene, box, message):
    monkeypatch.setattr(exact, "CHECKED", 1)
    with pytest.raises(InputError, match=message):
        symrot.certify(scene, box, step="exact")


@pytest.mark.parametrize(
    ("content", "axis"), [(SYMMETRIC, 1), (GYROSTAT, 2), (SPHERE_WITH_ROTOR, 3), (PLANAR, 3), (SPHERE, None)]
)
def test_the_certificate_proves_that_the_step_is_the_motion(content, axis):
    """In double and float: from a start x, the step of size 0 is x; its derivative with respect to dt is the rates."""
    data = json.loads(step_text(scene_of(content), "exact").certificate())
    assert data["step"] == {"method": "exact", "axis": axis}
    proofs = [function["motion"] for function in data["formula"].values()]
    assert len(proofs) == 2 and all("the derivative of the new state with respect to dt" in p["law"] for p in proofs)
    assert all(int(p["wrong_with_probability_below"].removeprefix("2^-")) > 400 for p in proofs)


@pytest.fixture(scope="module")
def certified(tmp_path_factory):
    """Return the folder and the certificate of an exact step, with bounds."""
    folder = tmp_path_factory.mktemp("exact")
    return folder, symrot.certify("axisymmetric_satellite", BOX, directory=folder, step="exact")


def test_the_bound_of_rounding_contains_the_errors_of_one_step(certified):
    """Against 50 digits, at random states of the box; there is no truncation."""
    _, certificate = certified
    bounds = certificate.data["bounds"]
    assert set(bounds["truncation"].values()) == {(0.0).hex()} and "truncation  none" in str(certificate)
    (precision,) = bounds["rounding"]["precisions"]
    most = np.array([float.fromhex(output["absolute"]) for output in precision["outputs"]])
    text, room = step_text("axisymmetric_satellite", "exact"), {}
    exec(text.source("numpy"), room)
    p, draw, worst = np.array(text.rates.inputs.parameters), np.random.default_rng(2), np.zeros(7)
    functions = {name: abs if name == "abs" else getattr(mpmath, name) for name in (*FUNCTIONS, "sinc")}
    names = [name for name, *_ in text._rates_program.signature.argument("y").components]
    with mpmath.workdps(50):
        for _ in range(60):
            q = draw.normal(size=4)
            x, dt = np.array([*draw.uniform(-1, 1, 3), *q / np.linalg.norm(q)]), draw.uniform(0.05, 0.1)
            values = dict(zip(names, map(mpmath.mpf, x), strict=True)) | {"t": mpmath.mpf(0)}
            values |= dict(zip(text._parameter_names, map(mpmath.mpf, p), strict=True))
            expected = stepped(
                text._rates_program, text.method, values, mpmath.mpf(dt), functions,
                lambda value: mpmath.mpf(value.numerator) / value.denominator,
            )  # fmt: skip
            computed = room[text.name](0.0, x, p, dt)
            worst = np.maximum(worst, [abs(float(mpmath.mpf(a) - b)) for a, b in zip(computed, expected, strict=True)])
    assert (worst <= most).all()
    assert most.max() < 5 * worst.max()


def test_the_audit_repeats_all_proofs(certified):
    folder, certificate = certified
    assert certificate.proofs == ("C text", "rounding", "truncation")
    (path,) = folder.glob("*.cert.json")
    statements = symrot.audit(path).statements[str(path)]
    assert "the C text is the motion itself, not an approximation: it solves the equations of the rates" in statements
    assert any("those that symrot derives for the scene axisymmetric_satellite" in line for line in statements)
    assert "bounds of rounding and truncation are those that symrot computes" in statements


def _half_rounding(data):
    output = data["bounds"]["rounding"]["precisions"][0]["outputs"][3]
    output["absolute"] = (float.fromhex(output["absolute"]) / 2).hex()


def _less_truncation(data):
    data["bounds"]["truncation"]["q0"] = (-1.0).hex()


def _faster_rates(data):
    data["rates"]["formulas"][0][1] = "2*" + data["rates"]["formulas"][0][1]


def _coupled_rates(data):
    data["rates"]["formulas"][2][1] = "omega_1*omega_2"


def _other_states(data):
    data["rates"]["states"][0][0] = "omega_4"


def _other_axis(data):
    data["step"]["axis"] = 1
    data["method"] = SteadyRotations(0).formula


def _no_axis(data):
    data["step"]["axis"] = True


def _other_chance(data):
    next(iter(data["formula"].values()))["motion"]["wrong_with_probability_below"] = "2^-900"


def _less_trust(data):
    del data["trusted"]["rates"]


@pytest.mark.parametrize(("change", "message"), [
    (_half_rounding, "expected"), (_less_truncation, "expected the bounds that symrot computes"),
    (_faster_rates, "expected next|to be the rate"),
    (_coupled_rates, "omega_3 with respect to the step length dt to be the rate"),
    (_other_states, "in the form|exact step, got those of omega_4|as symrot prints"),
    (_other_axis, "got another formula"), (_no_axis, "symmetry axis"),
    (_other_chance, "the proof that symrot derives from the C text"), (_less_trust, "the section 'trusted'"),
])  # fmt: skip
def test_forged_certificates_are_refused(certified, tmp_path, change, message):
    source, certificate = certified
    for path in source.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    data = json.loads(json.dumps(certificate.data))
    change(data)
    data["seal"] = seal(data)
    path = tmp_path / f"{data['kernel']}.cert.json"
    path.write_text(certificate_json(data), encoding="utf-8")
    with pytest.raises(CertificateError, match=message):
        symrot.audit(path)


def test_a_wrong_closed_form_is_refused(monkeypatch):
    """A text that computes a wrong closed form is not the motion, in either sense of rotation."""
    original = SteadyRotations.after

    def backward(self, rates, values, dt, functions, number):
        return original(self, rates, values, -dt, functions, number)

    monkeypatch.setattr(SteadyRotations, "after", backward)
    with pytest.raises(CertificateError, match="with respect to the step length dt to be the rate"):
        step_text(scene_of(SYMMETRIC), "exact").certificate()


def test_a_closed_form_of_other_rates_is_refused():
    """With damping, the step of the free body is no longer the motion."""
    text = step_text(scene_of(SPHERE), "exact")
    (first, _), *others = text._rates_program.outputs
    damped = replace(text._rates_program, outputs=((first, parse("-omega_1")), *others))
    with pytest.raises(
        CertificateError, match="the derivative of omega_1 with respect to the step length dt to be the rate"
    ):
        formula_section(text.name, damped, text.method, text.c()[0])


@pytest.mark.parametrize(("scene", "step", "edits"), [
    ("axisymmetric_satellite", "exact", {"x == 0.0 ? 1.0": "x == 0.0 ? 2.0"}),
    ("axisymmetric_satellite", "exact", {"x == 0.0 ?": "x == 0.5 ?"}),
    ("tumbling_prism", "rk4", {"next[0] = ": "next[0] = omega_1 == 3 ? 7 : ", "next[k] = ": "next[k] = omega_1 == 3 ? 7 : "}),
])  # fmt: skip
def test_a_value_at_a_single_point_is_no_way_around_the_proof(scene, step, edits):
    """Random points meet only one branch of a case."""
    text = step_text(scene, step)
    double, head, single = text.c()[0].partition(f"void symrot_{text.name}f(")
    for old, new in edits.items():
        assert old in double
        double = double.replace(old, new.replace("3", "3.0").replace("7", "7.0"))
    with pytest.raises(CertificateError, match="expected no conditional expression"):
        formula_section(text.name, text._rates_program, text.method, f"{double}{head}{single}")


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


@pytest.mark.parametrize("target", ["numpy", "js", "jax"])
def test_steps_of_symmetric_bodies_exist_in_every_language(target):
    assert (
        "axisymmetric_satellite_exact_step" in symrot.emit("axisymmetric_satellite", step="exact", target=target).source
    )
