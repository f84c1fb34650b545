"""Certificates of steps: bounds of rounding and truncation hold, wrong steps and edited certificates are refused."""

import json
import re
from dataclasses import replace
from fractions import Fraction
from hashlib import sha256
from sys import float_info

import mpmath
import numpy as np
import pytest

import symrot
from symrot.certificates.certificate import certificate_json, seal
from symrot.certificates.readback.header import check_source
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.step_certificate import _require_intended, bounds_of_step, formula_section, rates_of
from symrot.certificates.truncation import bounds as truncation
from symrot.certificates.truncation import intervals, leading, order
from symrot.certificates.truncation.bounds import truncation_bounds
from symrot.certificates.truncation.order import require_order, trees
from symrot.certificates.truncation.series import SERIES_FUNCTIONS, PowerSeries
from symrot.cli.main import main
from symrot.codegen.steps import RK4, TaylorSeries, stepped
from symrot.errors import CertificateError, InputError
from symrot.formula.tree import FUNCTIONS, parse
from symrot.workshop.step_text import step_text
from symrot.workshop.steps import exact
from symrot.workshop.steps.certify import certify_step

BOX = {"omega_1": (-1, 1), "omega_2": (-1, 1), "omega_3": (-1, 1), "dt": (0, "1/100")}
QUATERNION = {f"q{i}": (Fraction(-1), Fraction(1)) for i in range(4)}


@pytest.fixture(scope="module", autouse=True)
def _few_pieces():
    """Divide boxes into few parts: the bounds are larger, and the tests shorter."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(truncation, "PIECES", 3)
        yield


def problem(scene, step, sizes):
    """Return rates, method, parameters by name and the box of the step of a scene; states are in [-1, 1]."""
    text = step_text(scene, step)
    rates, method = text._rates_program, text.method
    states = [name for name, *_ in rates.signature.argument("y").components]
    parameters = dict(zip(text._parameter_names, map(Fraction, text.rates.inputs.parameters), strict=True))
    box = {name: (Fraction(-1), Fraction(1)) for name in states} | {"t": (Fraction(0), Fraction(1)), "dt": sizes}
    return rates, method, parameters, box | {name: (value, value) for name, value in parameters.items()}


def errors(rates, method, parameters, box, samples):
    """Return the largest |step - exact motion| of each state at random starts, with 40 digits."""
    draw, worst = np.random.default_rng(5), None
    functions = {name: abs if name == "abs" else getattr(mpmath, name) for name in FUNCTIONS}
    states = [name for name, *_ in rates.signature.argument("y").components]
    with mpmath.workdps(40):

        def number(value):
            return mpmath.mpf(value.numerator) / value.denominator

        for _ in range(samples):
            values = {name: mpmath.mpf(draw.choice([-1, 1]) * draw.uniform(0.8, 1)) for name in states}
            values |= {name: number(value) for name, value in parameters.items()} | {"t": mpmath.mpf(draw.uniform())}
            dt = number(box["dt"][1])
            ours, exact = (stepped(rates, each, values, dt, functions, number) for each in (method, TaylorSeries(16)))
            here = [abs(a - b) for a, b in zip(ours, exact, strict=True)]
            worst = here if worst is None else list(map(max, worst, here))
    return list(map(float, worst))


@pytest.mark.parametrize(("scene", "step", "size", "wide"), [
    ("tumbling_prism", "rk4", Fraction(1, 100), 40), ("tumbling_prism", "taylor", Fraction(1, 10), 100),
    ("damped_disk", "rk4", Fraction(-1, 100), 400),
])  # fmt: skip
def test_bounds_of_truncation_hold_and_are_not_much_too_large(scene, step, size, wide):
    rates, method, parameters, box = problem(scene, step, (min(size, Fraction(0)), max(size, Fraction(0))))
    box["dt"] = tuple(sorted((Fraction(0), size)))
    bounds = truncation_bounds(rates, method, box)
    measured = errors(rates, method, parameters, box | {"dt": (Fraction(0), size)}, 4)
    for bound, error in zip(bounds.values(), measured, strict=True):
        assert error <= bound
    assert max(bounds.values()) < wide * max(measured)


def test_intervals_alone_bound_rates_that_are_no_polynomials():
    """The same rates with a quotient in them have no exact coefficients; the bound is larger, and holds."""
    rates, method, parameters, box = problem("tumbling_prism", "rk4", (Fraction(0), Fraction(1, 100)))
    (first, node), *others = rates.outputs
    quotient = replace(
        rates,
        outputs=(
            (first, ("/", node, ("+", ("number", Fraction(1)), ("*", ("symbol", "q0"), ("symbol", "q0"))))),
            *others,
        ),
    )
    bounds = truncation_bounds(quotient, method, box)
    measured = errors(quotient, method, parameters, box, 2)
    assert all(error <= bound for bound, error in zip(bounds.values(), measured, strict=True))
    assert leading.leading_terms(quotient, method, list(bounds), box) == (quotient, ())


def test_polynomials_with_too_many_terms_are_left_to_intervals(monkeypatch):
    rates, method, _, box = problem("tumbling_prism", "rk4", (Fraction(0), Fraction(1, 100)))
    exact = truncation_bounds(rates, method, box)
    monkeypatch.setattr(leading, "MOST_TERMS", 10)
    assert max(truncation_bounds(rates, method, box).values()) > max(exact.values())


def test_a_wrong_step_is_refuted():
    """With one wrong weight the method loses its order, is refused, and errs by more than the bound of the right one."""
    wrong = replace(RK4, weights={0: Fraction(1, 6), 1: Fraction(1, 3), 2: Fraction(1, 6), 3: Fraction(1, 3)})
    rates, method, parameters, box = problem("tumbling_prism", "rk4", (Fraction(0), Fraction(1, 100)))
    with pytest.raises(CertificateError, match="expected a method of order 4"):
        truncation_bounds(rates, wrong, box)
    assert max(errors(rates, wrong, parameters, box, 3)) > max(truncation_bounds(rates, method, box).values())


def rounded(method, digits):
    """Return a Runge-Kutta method whose coefficients are decimals, rounded down."""

    def near(value):
        return Fraction(int(value * 10**digits), 10**digits)

    stages = tuple({j: near(a) for j, a in stage.items()} for stage in method.stages)
    return replace(method, stages=stages, weights={j: near(b) for j, b in method.weights.items()}, rounded=True)


def test_defects_of_rounded_coefficients_are_in_the_bound(monkeypatch):
    """With weights of 5 digits, the defects of the order conditions are the larger part of the error."""
    monkeypatch.setattr(order, "DEFECT", Fraction(1, 10**4))
    rates, method, parameters, box = problem("tumbling_prism", "rk4", (Fraction(0), Fraction(1, 1000)))
    near = rounded(method, 5)
    bounds, measured = truncation_bounds(rates, near, box), errors(rates, near, parameters, box, 4)
    assert all(error <= bound for bound, error in zip(bounds.values(), measured, strict=True))
    assert max(bounds.values()) < 20 * max(measured)
    assert max(measured) > 1000 * max(errors(rates, method, parameters, box, 4))


def test_coefficients_of_dop853_fulfil_the_conditions_to_25_digits():
    """One digit of a weight changed in the twentieth place is refused, and so are rates that no polynomial gives."""
    method = step_text("tumbling_prism", "dop853").method
    assert 0 < max(require_order(method)) < order.DEFECT
    wrong = replace(method, weights=dict(method.weights) | {0: method.weights[0] + Fraction(1, 10**20)})
    with pytest.raises(CertificateError, match="violates the order condition of a rooted tree with 1 node:"):
        require_order(wrong)
    text = step_text("damped_disk", "dop853")
    (first, _), *others = text._rates_program.outputs
    driven = replace(text._rates_program, outputs=((first, ("symbol", "t")), *others))
    with pytest.raises(InputError, match="polynomials in the states, without the time"):
        truncation_bounds(driven, method, {})


def test_a_step_of_dop853_with_one_wrong_digit_is_refused():
    text = step_text("tumbling_prism", "dop853")
    source, name = text.c_files()[f"{text.name}.c"], text.name
    assert formula_section(name, text._rates_program, text.method, source)
    digits = repr(float(text.method.stages[1][0]))
    assert digits in source
    wrong = source.replace(digits, f"{digits[:-1]}{(int(digits[-1]) + 5) % 10}")
    with pytest.raises(CertificateError, match="got another formula"):
        formula_section(name, text._rates_program, text.method, wrong)


@pytest.mark.campaign
def test_a_certificate_of_dop853_bounds_the_errors_of_one_step(tmp_path):
    """The constants of the C text stand for the decimals; the bound holds at random starts, and the audit repeats it."""
    certificate = symrot.certify("tumbling_prism", BOX | {"dt": (0, "1/1000")}, directory=tmp_path, step="dop853")
    bounds = {name: float.fromhex(value) for name, value in certificate.data["bounds"]["truncation"].items()}
    rates, method, parameters, box = problem("tumbling_prism", "dop853", (Fraction(0), Fraction(1, 1000)))
    measured = errors(rates, method, parameters, box, 2)
    assert all(error <= bound < 1e-15 for bound, error in zip(bounds.values(), measured, strict=True))
    (path,) = tmp_path.glob("*.cert.json")
    assert (
        "bounds of rounding and truncation are those that symrot computes" in symrot.audit(path).statements[str(path)]
    )


def test_order_conditions_of_all_trees():
    """There are 1, 1, 2, 4, 9 and 20 rooted trees of 1 to 6 nodes; RK4 fulfils those up to 4 and no more."""
    assert [len(trees(size)) for size in range(1, 7)] == [1, 1, 2, 4, 9, 20]
    require_order(RK4)
    with pytest.raises(CertificateError, match="a rooted tree with 5 nodes"):
        require_order(replace(RK4, order=5))


@pytest.mark.parametrize("name", SERIES_FUNCTIONS)
def test_series_of_functions_contain_their_derivatives(name):
    """The series of f(a + b h + c h^2) contains the Taylor coefficients of the composed function."""
    with mpmath.workdps(40):
        a, b, c = (mpmath.mpf(value) / 8 for value in (5, -3, 7))
        exact = mpmath.taylor(lambda h: getattr(mpmath, name)(a + b * h + c * h * h), 0, 5)
    series = SERIES_FUNCTIONS[name](
        PowerSeries((*(intervals.number(Fraction(value, 8)) for value in (5, -3, 7)), 0, 0, 0))
    )
    for interval, value in zip(series.terms, exact, strict=True):
        assert float(interval.a) - 1e-12 <= float(value) <= float(interval.b) + 1e-12
        assert float(interval.delta) < 1e-10


def test_ranges_of_single_numbers_have_bounds():
    """A component that starts at one number moves, though its range has no width by which it could grow."""
    rates, method, _, box = problem("tumbling_prism", "rk4", (Fraction(0), Fraction(1, 10000)))
    bounds = truncation_bounds(rates, method, box | {"omega_2": (Fraction(1, 2), Fraction(1, 2))})
    assert max(bounds.values()) <= max(truncation_bounds(rates, method, box).values()) < 1e-20


def test_steps_too_large_for_a_bound_are_refused():
    rates, method, _, box = problem("tumbling_prism", "rk4", (Fraction(0), Fraction(10)))
    with pytest.raises(
        InputError, match=r"got sizes dt up to 10 s; take dt up to [\d.]+ s, or a smaller box"
    ) as refusal:
        truncation_bounds(rates, method, box)
    advice = Fraction(re.findall(r"[\d.]+", str(refusal.value))[-1])
    assert all(map(np.isfinite, truncation_bounds(rates, method, box | {"dt": (Fraction(0), advice)}).values()))
    with pytest.raises(InputError, match="take smaller dt or a smaller box"):
        truncation_bounds(rates, method, box | {"dt": (Fraction(8), Fraction(10))})


def test_bounds_on_the_largest_range_of_time_hold_at_all_times():
    """A range of all doubles is no sign that an input is not used."""
    scene = symrot.Scene.from_dict(
        {"schema": 1, "initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 1]}, "body": {"principal": [2, 2, 2]},
         "torque": [{"kind": "expression", "torque": ["0", "0", "sin(t)**4"]}]}
    )  # fmt: skip
    box, largest = ["omega_2=0:0", "omega_3=0:1", "dt=0:1/2"], float_info.max
    everywhere, once, at_zero = (
        float.fromhex(certify_step(scene, "taylor", 2, [*box, f"t={t}"])[0]["bounds"]["truncation"]["omega_3"])
        for t in (f"{-largest!r}:{largest!r}", "0:7", "0:0")
    )
    assert everywhere >= once > 2 * at_zero


@pytest.mark.parametrize(("number", "other"), [("0.3333333333333333", "1/3"), ("0.50000000000000001", "1/2"),
                                               ("3.141592653589793", "1[*]pi")])  # fmt: skip
def test_a_constant_that_is_rounded_as_another_has_no_bounds(number, other):
    """The error of a rounded 1/3 is no bound of that of 0.3333333333333333, which rounds to the same double."""
    rates, method, *_ = problem("tumbling_prism", "rk4", (Fraction(0), Fraction(1, 100)))
    near = replace(rates, outputs=((rates.outputs[0][0], parse(f"cos({number}*omega_2)")), *rates.outputs[1:]))
    with pytest.raises(InputError, match=f"expected the constant {other}, got {number}: both round to the same double"):
        bounds_of_step(read_kernel(*step_source("tumbling_prism")), near, method, {})
    exact = replace(rates, outputs=((rates.outputs[0][0], parse("cos(omega_2/3)/4")), *rates.outputs[1:]))
    _require_intended(exact)


HEAD = '#include "tumbling_prism_rk4_step.h"\n'
TEXTS = {  # C that the proof does not read, or that other compilers read otherwise: what is replaced, by what
    "another header": (HEAD, HEAD + '#include "other.h"\n'), "header of the system": (HEAD, HEAD + "#include <tgmath.h>\n"),
    "no header": (HEAD, ""), "header of functions": (HEAD, HEAD + '#include "symrot_math.h"\n'), "macro": (HEAD, HEAD + "#define t dt\n"),
    "pragma": (HEAD, HEAD + "#pragma STDC FP_CONTRACT OFF\n"),
    "function of the C library": (HEAD, HEAD + "double memcpy(double x)\n{\n    return x;\n}\n"),
    "static function of the C library": (HEAD, HEAD + "static inline double fmin(double x)\n{\n    return x;\n}\n"),
    "prototype": (HEAD, HEAD + "float cos(float x);\n"), "indented function": (HEAD, HEAD + " void exit(double x)\n{\n}\n"),
    "variable": (HEAD, HEAD + "double errno;\n"), "text at the end": ("", "\nextern int x;\n"),
    "function without its header": (HEAD, HEAD + "static inline double symrot_f(double x)\n{\n    return sqrt(x);\n}\n"),
    "line comment": ("0.5*dt;", "0.5*dt //**/ 2.0\n;"), "carriage return": ("0.5*dt;", "0.5*dt; /* \r */"),
    "guard of the header": (
        HEAD, HEAD + "static inline double symrot_f(double x, double SYMROT_TUMBLING_PRISM_RK4_STEP_H)\n{\n    return x;\n}\n",
    ),
}  # fmt: skip


def step_source(scene):
    text = step_text(scene, "rk4")
    return text.c()[0], f"symrot_{text.name}"


@pytest.mark.parametrize("what", TEXTS)
def test_a_c_text_with_more_than_its_functions_is_refused(what):
    old, new = TEXTS[what]
    source, name = step_source("tumbling_prism")
    check_source(source, name.removeprefix("symrot_"))
    text = source.replace(old, new, 1) if old else source + new
    assert text != source
    with pytest.raises(CertificateError, match="tumbling_prism_rk4_step"):
        check_source(text, name.removeprefix("symrot_"))


@pytest.mark.parametrize(("old", "new"), [
    ("double t, const double x[7], const double p[3], double dt", "double dt, const double x[7], const double p[3], double t"),
    ("const double x[7], const double p[3]", "const double p[3], const double x[7]"), ("double dt,", "double dt, double u,"),
    ("const double p[3], double dt", "const double p[4], double dt"), ("double t,", "double time,"),
    ("RESTRICT t, const double *SYMROT_RESTRICT x", "RESTRICT x, const double *SYMROT_RESTRICT t"),
])  # fmt: skip
def test_arguments_of_another_order_are_refused(old, new):
    """A header with the same order declares them, and the C text computes the method from their names."""
    text = step_text("tumbling_prism", "rk4")
    source = text.c()[0]
    assert old in source
    wrong = source.replace(old, new, 1).replace("(void)t;", f"(void){'time' if 'time' in new else 't'};", 1)
    with pytest.raises(CertificateError, match="to have the arguments"):
        formula_section(text.name, text._rates_program, text.method, wrong)


@pytest.mark.parametrize("literal", ["1e400", "1e-1000000000", "1e39f", "0x1p99999"])
def test_a_literal_beyond_its_type_is_refused(literal):
    source, name = step_source("tumbling_prism")
    at = source.index("void symrot_tumbling_prism_rk4_stepf(") if literal.endswith("f") else 0
    text = source[:at] + source[at:].replace("(void)t;", f"(void)t;\n    const double_ x9 = {literal};", 1)
    text = text.replace("double_", "float" if literal.endswith("f") else "double")
    with pytest.raises(CertificateError, match="expected a literal within the range of"):
        read_kernel(text, name + ("f" if literal.endswith("f") else ""))


def test_an_audit_refuses_a_c_text_that_includes_another_file(tmp_path):
    """Such a file, which no hash covers, could define sin as cos."""
    scene = tmp_path / "other.toml"
    scene.write_text("schema = 1\nbody = {principal = [1, 2, 2]}\ninitial = {omega = [0, 0, 1]}\nspan = {t = [0, 1]}\n")
    symrot.certify(str(scene), directory=tmp_path, step="exact")
    source, path = tmp_path / "other_exact_step.c", tmp_path / "other_exact_step.cert.json"
    assert symrot.audit(path).statements
    text = source.read_text().replace("#include <math.h>", '#include <math.h>\n#include "macros.h"')
    source.write_text(text)
    data = json.loads(path.read_text())
    data["files"][source.name] = sha256(text.encode()).hexdigest()
    path.write_text(certificate_json(data))
    with pytest.raises(CertificateError, match="expected no #include but <math"):
        symrot.audit(path)


@pytest.fixture(scope="module")
def certified(tmp_path_factory):
    """Return the folder and the certificate of a step of order 2, with bounds."""
    folder = tmp_path_factory.mktemp("step")
    return folder, symrot.certify("tumbling_prism", BOX, directory=folder, step="taylor", order=2)


def test_a_certificate_bounds_the_errors_of_one_step(certified):
    folder, certificate = certified
    assert certificate.proofs == ("C text", "rounding", "truncation")
    assert "truncation  at most" in str(certificate)
    (path,) = folder.glob("*.cert.json")
    statements = symrot.audit(path).statements[str(path)]
    assert "rates, parameters and files are those that symrot derives for the scene tumbling_prism" in statements
    assert "bounds of rounding and truncation are those that symrot computes" in statements


def test_emitting_a_step_again_keeps_the_bounds_in_its_certificate(certified, tmp_path, capsys):
    """The build files for CMake are printed after the certificate, into the same folder."""
    folder, _ = certified
    for path in folder.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    step = ["tumbling_prism", "--step", "taylor", "--order", "2"]
    assert main(["emit", *step, "--cmake", "-o", str(tmp_path)]) == 0
    (path,) = tmp_path.glob("*.cert.json")
    assert path.read_text() == next(folder.glob("*.cert.json")).read_text() and (tmp_path / "CMakeLists.txt").exists()


def forged(certified, folder, change):
    """Write the certified step with a changed certificate, whose seal is right, and return its path."""
    source, certificate = certified
    for path in source.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())
    data = json.loads(json.dumps(certificate.data))
    change(data, folder)
    data["seal"] = seal(data)
    path = folder / f"{data['kernel']}.cert.json"
    path.write_text(certificate_json(data), encoding="utf-8")
    return path


def _smaller_truncation(data, folder):
    data["bounds"]["truncation"]["q0"] = (float.fromhex(data["bounds"]["truncation"]["q0"]) / 2).hex()


def _smaller_rounding(data, folder):
    output = data["bounds"]["rounding"]["precisions"][0]["outputs"][0]
    output["absolute"] = (float.fromhex(output["absolute"]) * 0.9).hex()


def _other_rates(data, folder):
    data["rates"]["formulas"][0][1] = data["rates"]["formulas"][1][1]


def _divided_by_zero(data, folder):
    data["rates"]["formulas"][0][1] = "1/0"


def _other_order(data, folder):
    data["step"]["order"] = 4


def _other_text(data, folder):
    path = folder / f"{data['kernel']}.c"
    path.write_text(path.read_text("utf-8").replace("0.5*", "0.25*"), encoding="utf-8")


def _other_parameter(data, folder):
    data["rates"]["parameters"][0][2] = (1.0).hex()


def _other_entry(section, name, value=1):
    return lambda data, folder: (data[section] if section else data).update({name: value})


@pytest.mark.parametrize(("change", "message"), [
    (_other_entry("step", "tolerance"), "'step' in the form"), (_other_entry("rates", "error"), "'rates' in the form"),
    (_other_entry("", "title", "a step without errors"), "'title' and 'kernel' to name the scene tumbling_prism"),
    (_other_entry("", "regenerate", "symrot emit other"), "the command that emits the step"),
    # otherwise the rates would not be compared with those of tumbling_prism
    (_other_entry("", "regenerate", "symrot emit other --step taylor --order 2 --target c"), "to name the scene other"),
    (_smaller_truncation, "expected the bounds that symrot computes"), (_smaller_rounding, "expected"),
    (_other_rates, "expected next"), (_divided_by_zero, "'rates' in the certificate as symrot prints"), (_other_order, "expected the method .* dt.4.*, got .*dt.2"), (_other_text, "an edited one"),
    (_other_parameter, "the parameters that the certificate states"),
    (_other_entry("", "step", []), "a method that symrot knows"), (_other_entry("", "step", None), "that symrot knows"),
    (_other_entry("", "step", {"method": "rk4"}), "a method that symrot knows: 'order'"),
    (_other_entry("step", "jacobian", [1]), "a method that symrot knows: 'jacobian' is not a list of names"),
])  # fmt: skip
def test_forged_certificates_are_refused(certified, tmp_path, change, message):
    with pytest.raises(CertificateError, match=message):
        symrot.audit(forged(certified, tmp_path, change))


def test_a_certificate_in_another_encoding_is_refused(certified, tmp_path):
    path = forged(certified, tmp_path, lambda data, folder: None)
    path.write_bytes(path.read_text("utf-8").encode("utf-16"))
    with pytest.raises(CertificateError, match="as symrot prints it, got one that was edited"):
        symrot.audit(path)


def test_the_rates_in_a_certificate_are_those_of_the_scene():
    """Text and parser return the same trees, also for fractions."""
    text = step_text("gravity_gradient_satellite", "rk4")
    stated = rates_of(json.loads(text.certificate()))
    assert (stated.temporaries, stated.outputs) == (text._rates_program.temporaries, text._rates_program.outputs)


@pytest.mark.parametrize(("options", "message"), [
    ({"step": "rk4", "box": {"omega_1": (-1, 1)}}, "expected --box omega_2=LOW:HIGH .* --box dt=LOW:HIGH"),
    ({"step": "rk4", "objects": True}, "neither objects nor rounding=False"), ({"order": 3}, "expected a step as well"),
    ({"step": "rk4", "box": BOX | {"weight": (1, 2)}}, "an input of the kernel or a constant"),
])  # fmt: skip
def test_impossible_requests_are_one_sentence(options, message):
    with pytest.raises(InputError, match=message):
        symrot.certify("tumbling_prism", **options)


def test_an_audit_says_whether_bounds_were_computed_again(certified):
    folder, _ = certified
    (path,) = folder.glob("*.cert.json")
    statements = symrot.audit(path, rerun_bounds=True).statements[str(path)]
    assert "bounds of rounding and truncation were computed again and agree" in statements


def test_a_quotient_of_whole_numbers_is_enclosed():
    """As a double, 1/3 was a number outside every enclosure of 1/3."""
    assert intervals.quotient(0, 3) == 0 and intervals.quotient(6, 3) == 2
    third = intervals.quotient(1, 3)
    assert third.a < third.b and 1 in 3 * third


@pytest.mark.parametrize("words", [[], ["--jacobian", "omega"], ["--step", "rk4"], ["--step", "exact"]], ids=" ".join)
def test_an_audit_compares_with_the_scene_of_the_user(tmp_path, capsys, monkeypatch, words):
    """Kernel and steps of a scene outside the package are those of its file, and not those of a file with another moment."""
    monkeypatch.setattr(exact, "CHECKED", 1)  # states at which an exact step is checked
    text = symrot.load_scene("tumbling_prism").with_(principal=[1, 2, "5/2"]).to_toml()
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "own.toml").write_text(text.replace("5/2", "9/4"), encoding="utf-8")
    assert "9/4" in (tmp_path / "other" / "own.toml").read_text(encoding="utf-8")
    assert main(["emit", str(tmp_path / "own.toml"), *words, "-o", str(tmp_path)]) == 0
    (certificate,) = tmp_path.glob("*.cert.json")
    capsys.readouterr()
    assert main(["audit", str(certificate)]) == 0 and "pass " in capsys.readouterr().out
    assert main(["audit", str(certificate), "--scene", str(tmp_path / "own.toml")]) == 0
    out = capsys.readouterr().out
    assert "not compared" not in out and ("the scene own" in out or "equal those that symrot derives" in out)
    assert main(["audit", str(certificate), "--scene", str(tmp_path / "other" / "own.toml")]) == 1
    assert "expected" in capsys.readouterr().err
    assert main(["audit", str(certificate), "--scene", "t_handle"]) == 1
