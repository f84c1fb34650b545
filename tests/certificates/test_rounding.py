"""Rounding bounds: no error exceeds its bound, bounds are close to measured errors, and wrong bounds are refused."""

import copy
import json
import math
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest

from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding import functions, intervals, store
from symrot.certificates.rounding.adjoint import evaluate
from symrot.certificates.rounding.bounds import (
    STORE,
    bound_outputs,
    bound_task,
    bound_tasks,
)
from symrot.certificates.rounding.bounds_text import bounds_sentence, library_section, rounded_up
from symrot.certificates.rounding.library import largest_box, library_problem, operations_of, prepare, resized
from symrot.certificates.rounding.output_graph import output_graph
from symrot.certificates.rounding.region import Region
from symrot.certificates.rounding.section import check_section, rounding_section
from symrot.certificates.rounding.store import TABLE, method, printed_table, table
from symrot.cli.main import main
from symrot.errors import CertificateError, InputError
from symrot.formula.exact_numbers import PI
from symrot.kernels.library import definition, kernel_names
from symrot.workshop.bound_table import understated
from tests.campaigns.certificates import rounding_campaign
from tests.campaigns.certificates.rounding_campaign import compare, loosest
from tests.campaigns.certificates.rounding_measured import measure

GENERATED = Path(__file__).parents[2] / "generated" / "c"
UNIT = {"binary64": 2.0**-53, "binary32": 2.0**-24}
SLICE = ("quaternion_dcm", "quaternion_body_rates", "euler_zxz_dcm", "euler_zyx_body_rates", "mrp_shadow",
         "rotation_vector_of_quaternion", "rotation_vector_space_rates", "inertia_cone", "euler_zxz_of_quaternion")  # fmt: skip
BUDGET = 12_000  # of a slice; the certificates use eight times as many


def text_of(name):
    return (GENERATED / f"{name}.c").read_text(encoding="utf-8")


def kernel(body, real="double"):
    """Return the operations of a kernel with the input x[3] and one output, from its expression."""
    head = f"void k{'f' if real == 'float' else ''}(const {real} x[3], {real} y[1])"
    return read_kernel(f"#include <math.h>\n{head}\n{{\n    y[0] = {body};\n}}\n", "kf" if real == "float" else "k")


def box_of(low, high, count=3):
    return {f"x[{i}]": (Fraction(low), Fraction(high)) for i in range(count)}


def bound_of(body, low, high, real="double"):
    operations, box = kernel(body, real), box_of(low, high)
    return bound_outputs(operations, {p: box[p] for p in operations.inputs}, budget=BUDGET, fresh=True)[0]


# --- known errors -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("body", "low", "high", "units"),
    [
        ("x[0] + x[1]", -1, 1, 1),  # half a unit of the binade [1, 2)
        ("x[0]*x[1]", -1, 1, "1/2"),  # never above 1: half a unit of [1/2, 1)
        ("x[0]*x[1]", 1, 2, 2),
        ("2.0*x[0]", -1, 1, 0),  # exact
        ("-x[0]", -1, 1, 0),
        ("x[0] - x[1]", 1, 2, 0),  # Sterbenz
        ("1.0 - x[0]", 2, 4, 0),  # both are multiples of 2^-51 and the difference is below 4
        ("sqrt(x[0])", 1, 4, 1),
        ("x[0]/x[1]", 1, 2, 1),
        ("sin(x[0])", -1, 1, 1),  # one unit in the last place of what is below 1
    ],
)
def test_the_error_of_one_operation(body, low, high, units):
    bound = bound_of(body, low, high)
    assert bound.converged
    assert bound.bound == pytest.approx(float(Fraction(units)) * 2.0**-53, rel=1e-9, abs=1e-300)
    single = bound_of(body.replace("sin", "sinf").replace("sqrt", "sqrtf").replace(".0", ".0f"), low, high, "float")
    assert single.bound == pytest.approx(float(Fraction(units)) * 2.0**-24, rel=1e-6, abs=1e-40)


def test_errors_of_operations_add_up_with_their_derivatives():
    """(x*y)*z on [1, 2]: the first product has an error of 2 units, which is doubled; the second, up to 8, has 4 units."""
    assert bound_of("(x[0]*x[1])*x[2]", 1, 2).bound == pytest.approx(8 * 2.0**-53)


def test_a_constant_errs_by_half_a_unit_where_it_is_rounded():
    assert bound_of("x[0] + 0.5", 0, 0).bound == 0
    third = bound_of("x[0]*0.3333333333333333", 1, 1)
    assert third.bound >= float(Fraction(1, 3) - Fraction(1 / 3))


def test_a_constant_errs_by_what_it_is_off_from_what_it_stands_for():
    off = float(abs(Fraction(math.pi) - PI))
    assert bound_of("x[0]*3.141592653589793", 1, 1).bound == pytest.approx(off + 2.0**-52, rel=1e-9)


def test_the_larger_of_two_is_known_to_be_large():
    """max(1 + x, 1 - x) is at least 1, and so is its root; half the inverse is at most 1/2, with an error of 1/4 unit."""
    larger = "(1.0 + x[0] >= 1.0 - x[0] ? 1.0 + x[0] : 1.0 - x[0])"
    bound = bound_of(f"0.5/sqrt({larger})", -1, 1)
    assert bound.converged
    assert bound.bound == pytest.approx((1 / 4 + 1 / 2 + 1 / 4) * 2.0**-53, rel=0.03)


def test_underflow_is_part_of_the_bound():
    bound = bound_of("x[0]*x[1]", 0, Fraction(1, 10**170))
    assert 0 < bound.bound < 1e-318


@pytest.mark.parametrize(
    "body",
    [
        "atan2(x[2]/x[0], x[2]/x[0])",  # the angle of (0, 0): C computes 0 or pi by the signs of the zeros
        "atan2(x[2]/x[0], x[2]/x[1])",
        "atan2(x[2], x[2])",
        "copysign(1.0, x[0]*x[2])",  # C computes -1 for x[0] < 0, although the product is 0
        "copysign(1.0, x[0] - x[1])",
        "copysign(x[0], -(x[1]*x[2]))",
    ],
)
def test_a_result_that_depends_on_the_sign_of_a_computed_zero_has_no_bound(body):
    operations = kernel(body)
    box = {"x[0]": (Fraction(-2), Fraction(-1)), "x[1]": (Fraction(-2), Fraction(2)), "x[2]": (Fraction(0),) * 2}
    with pytest.raises(InputError, match="no bound"):
        bound_outputs(operations, {p: box[p] for p in operations.inputs}, budget=BUDGET, fresh=True)


def test_the_sign_of_an_input_is_exact():
    assert bound_of("copysign(1.0, x[0])", -1, 1).bound == 0
    assert bound_of("copysign(1.0, x[0]*x[1])", 1, 2).bound == 0
    assert bound_of("atan2(x[0], x[1])", 1, 2).bound == pytest.approx(2.0**-52)


def test_fused_products_are_covered_where_nothing_else_takes_them():
    assert bound_of("x[0]*x[1] + x[2]", -1, 1).contraction_safe
    assert not bound_of("x[0]*x[1] + x[2] + (x[2] - x[0]*x[1])", -1, 1).contraction_safe


def test_a_derivative_that_is_infinite_at_a_point_only_by_parts():
    """The norm of a vector and sin(x)/x have no bound at zero step by step, but have one as a whole."""
    assert bound_of("sqrt(x[0]*x[0] + x[1]*x[1])", -1, 1).bound < 4 * 2.0**-53
    assert bound_of("x[0] == 0.0 ? 1.0 : sin(x[0])/x[0]", -1, 1).bound < 4 * 2.0**-53
    with pytest.raises(InputError, match="singular"):
        bound_of("sqrt(x[0])*x[1]", -1, 1)


# --- enclosures -------------------------------------------------------------------------------------------------------

EXACT = {
    "sine": mpmath.sin, "cosine": mpmath.cos,
    "sinc": lambda x: mpmath.sin(x) / x, "sinc_slope": lambda x: (x * mpmath.cos(x) - mpmath.sin(x)) / x**2,
    "sine_gap": lambda x: (x - mpmath.sin(x)) / x**3,
    "sine_gap_slope": lambda x: (3 * mpmath.sin(x) - x * mpmath.cos(x) - 2 * x) / x**4,
    "tangent_gap": lambda x: (mpmath.sin(x) - x * mpmath.cos(x)) / x**3,
    "tangent_gap_slope": lambda x: ((x**2 - 3) * mpmath.sin(x) + 3 * x * mpmath.cos(x)) / x**4,
}  # fmt: skip


@pytest.mark.parametrize("name", EXACT)
def test_functions_are_enclosed(name):
    rng = np.random.default_rng(5)
    middle, width = rng.uniform(-9, 9, 120), 10.0 ** rng.uniform(-16, 0.5, 120)
    middle[:20] = np.arange(1, 21) * 0.5 * np.pi
    ends = np.stack([middle - width, middle + width])
    enclosure = getattr(functions, name)(ends)
    with mpmath.workdps(60):
        for k in range(120):
            for part in (0.0, 0.3, 0.5, 1.0):
                x = mpmath.mpf(ends[0, k] + part * (ends[1, k] - ends[0, k]))
                assert enclosure[0, k] <= EXACT[name](x) <= enclosure[1, k]
    assert (enclosure[1] - enclosure[0])[width < 1e-9].max() < 1e-8


def test_arithmetic_is_enclosed_and_exact_ends_stay():
    rng = np.random.default_rng(6)
    a, b = (np.sort(rng.uniform(-2, 2, (2, 200)) * 2.0 ** rng.integers(-30, 30, 200), axis=0) for _ in range(2))
    a[:, :40], b[:, :40] = np.round(a[:, :40]), np.round(b[:, :40])
    for name, exact in (("add", lambda x, y: x + y), ("multiply", lambda x, y: x * y), ("divide", lambda x, y: x / y)):
        with np.errstate(all="ignore"):
            enclosure = getattr(intervals, name)(a, b)
        for k in np.flatnonzero(np.isfinite(enclosure).all(axis=0)):
            ends = [exact(Fraction(x), Fraction(y)) for x in a[:, k] for y in b[:, k] if name != "divide" or y]
            assert Fraction(enclosure[0, k]) <= min(ends) and max(ends) <= Fraction(enclosure[1, k])
            if (
                name != "divide"
                and all(Fraction(float(end)) == end for end in ends)
                and max(abs(a[:, k]).max(), abs(b[:, k]).max()) < 2**20
            ):
                assert k >= 40 or (enclosure[:, k] == [float(min(ends)), float(max(ends))]).all()


# --- bounds against measured errors -----------------------------------------------------------------------------------


def rows_of(name, suffix):
    operations = operations_of(name, text_of(name))[1 if suffix else 0]
    problem = library_problem(definition(name), operations)
    bounds = bound_outputs(operations, problem.box, problem.region, BUDGET)
    return compare(operations, bounds, measure(operations, problem.box, bounds, problem.region, 2000), name)


@pytest.mark.thinned(8)
@pytest.mark.parametrize(
    "name", [*SLICE[::2], *(pytest.param(name, marks=pytest.mark.campaign) for name in SLICE[1::2])]
)
@pytest.mark.parametrize("suffix", ["", "f"], ids=["double", "float"])
def test_no_error_is_larger_than_its_bound_nor_the_bound_far_from_it(name, suffix):
    for row in rows_of(name, suffix):
        assert row.holds, f"{row.output}: {row.measured} above {row.bound} at {row.at}"
        assert row.ratio < 2 * loosest(name)  # with few points less is measured


@pytest.mark.campaign
@pytest.mark.parametrize("name", kernel_names())
def test_no_error_of_any_kernel_is_larger_than_its_bound(name):
    for row in rounding_campaign.rows(name, text_of(name), 100_000, budget=100_000):
        assert row.holds and row.tight, row


def test_a_kernel_that_rounds_worse_has_a_larger_bound():
    text = text_of("euler_zyx_body_rates")
    at = text.index("void symrot_euler_zyx_body_rates(")
    body = text[at : text.index("}", at)]
    product = next(line for line in body.splitlines() if "dangles[0]" in line)
    value = product.split("=", 1)[1].strip().rstrip(";")
    changed = text.replace(product, product.replace(value, f"({value} + 1024.0) - 1024.0"), 1)
    bounds = []
    for source in (text, changed):
        operations = read_kernel(source, "symrot_euler_zyx_body_rates")
        problem = library_problem(definition("euler_zyx_body_rates"), operations)
        bounds.append(bound_outputs(operations, problem.box, budget=BUDGET)[0].bound)
    assert bounds[1] > 2 * bounds[0]


def test_the_bound_of_a_part_is_never_larger():
    """The bounds on the halves of a box are at most the bound on the box; the bound at a point is at most that of its
    box.
    """
    operations = operations_of("euler_zyx_body_rates", text_of("euler_zyx_body_rates"))[0]
    problem = library_problem(definition("euler_zyx_body_rates"), operations)
    graph = output_graph(operations, operations.outputs[0][1])
    ends = np.array([[float(problem.box[place][k]) for place in graph.places] for k in (0, 1)])
    rng = np.random.default_rng(2)
    inner = np.sort(rng.uniform(ends[0][:, None], ends[1][:, None], (2, len(graph.places), 200)), axis=0)
    outer = np.stack([(inner[0] + ends[0][:, None]) / 2, (inner[1] + ends[1][:, None]) / 2])
    none = np.zeros((0, 200), np.int8)
    assert (evaluate(graph, inner, none).bound <= evaluate(graph, outer, none).bound * (1 + 1e-12)).all()


def test_an_angle_is_compared_modulo_whole_turns_and_said_so():
    operations = operations_of("euler_zxz_of_quaternion", text_of("euler_zxz_of_quaternion"))[0]
    problem = library_problem(definition("euler_zxz_of_quaternion"), operations)
    first, second, _ = bound_outputs(operations, problem.box, problem.region, BUDGET)
    assert first.turns and not second.turns
    assert all("whole turns" in choice for choice in first.choices)


# --- the section ------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def section():
    kernels = operations_of("quaternion_dcm", text_of("quaternion_dcm"))
    problem = library_problem(definition("quaternion_dcm"), kernels[0])
    return rounding_section(*kernels, problem.box, problem.region, BUDGET), kernels


def test_a_section_is_plain_data_and_the_same_again(section):
    data, kernels = section
    again = rounding_section(
        *kernels, library_problem(definition("quaternion_dcm"), kernels[0]).box, Region(), BUDGET, fresh=True
    )
    assert json.dumps(again) == json.dumps(json.loads(json.dumps(data)))
    check_section(data, *kernels)
    check_section(data, *kernels, rerun=True)


def _halved(section):
    item = section["precisions"][0]["outputs"][1]
    item["absolute"] = (float.fromhex(item["absolute"]) / 2).hex()


def _halved_throughout(section):
    for item in section["precisions"][1]["outputs"]:
        for key in ("absolute", "pointwise"):
            item[key] = (float.fromhex(item[key]) / 2).hex()
        item["units"] = f"{float(item['units']) / 2:.3f}"


def _without_output(section):
    del section["precisions"][0]["outputs"][3]


def _infinite(section):
    section["precisions"][0]["outputs"][0]["absolute"] = "inf"


def _smaller_box(section):
    section["box"]["q[0]"] = [(0.1).hex(), (0.2).hex()]


def _other_libm(section):
    section["libm_ulp"] = (0.5).hex()


def _unsafe_choice(section):
    section["precisions"][0]["outputs"][0]["choices"] = ["q[0] >= q[1]"]


def _garbage(section):
    section["precisions"][0]["outputs"][0]["at"] = {"q[0]": 3}


def _without_float(section):
    del section["precisions"][1]


def _other_operations(section):
    section["precisions"][0]["operations_sha256"] = "0" * 64


@pytest.mark.parametrize(
    "tamper",
    [_halved, _halved_throughout, _without_output, _infinite, _smaller_box, _other_libm, _garbage, _without_float,
     _other_operations, _unsafe_choice],
)  # fmt: skip
def test_a_tampered_section_is_refused_at_once(section, tamper):
    data, kernels = section
    changed = copy.deepcopy(data)
    tamper(changed)
    with pytest.raises(CertificateError):
        check_section(changed, *kernels)


def test_a_bound_that_is_only_a_little_smaller_is_refused_by_bounding_again(section):
    data, kernels = section
    changed = copy.deepcopy(data)
    changed["precisions"][0]["outputs"][0]["evaluations"] += 1
    with pytest.raises(CertificateError, match=r"that symrot computes for dcm\[0\] on the same ranges"):
        check_section(changed, *kernels, rerun=True)


def test_processes_find_what_one_finds(monkeypatch, tmp_path):
    monkeypatch.setenv("SYMROT_CACHE", str(tmp_path))
    kernels = [("inertia_rod", text_of("inertia_rod")), ("inertia_disk", text_of("inertia_disk"))]
    assert prepare(kernels, workers=2, budget=999) > 0
    assert prepare(kernels, workers=2, budget=999) == 0


def test_one_process_does_not_take_the_bounds_of_an_earlier_method_from_the_table(monkeypatch, tmp_path):
    monkeypatch.setenv("SYMROT_CACHE", str(tmp_path))
    monkeypatch.setattr(STORE, "memory", {})
    operations = operations_of("inertia_rod", text_of("inertia_rod"))
    problem = library_problem(definition("inertia_rod"), operations[0])
    tasks = [task for each in operations for task in bound_tasks(each, problem.box, problem.region, 999).values()]
    stale = {task.key: next(iter(table()["bounds"].values())) | {"bound": "0x0.0p+0"} for task in tasks}
    monkeypatch.setattr(store, "table", lambda: {"method": "earlier", "bounds": stale})
    assert prepare([("inertia_rod", text_of("inertia_rod"))], workers=1, budget=999, with_table=False) == len(stale)
    bounds = [STORE.get(key, with_table=False).bound for key in stale]
    assert max(bounds) > 0


# --- the table that comes with symrot, and what is printed of it ------------------------------------------------------


def test_the_table_is_of_this_method_and_holds_the_library():
    """If this test fails, run `python -m symrot.workshop.bound_table`."""
    assert table()["method"] == method()
    for name in SLICE:
        for operations in operations_of(name, text_of(name)):
            problem = library_problem(definition(name), operations)
            for task in bound_tasks(operations, problem.box, problem.region).values():
                assert task.key in table()["bounds"]
    bounds = {key: STORE.get(key) for key in table()["bounds"]}
    assert printed_table(bounds.items()) == TABLE.read_text(encoding="utf-8")
    assert all(each.pointwise <= each.bound < float("inf") for each in bounds.values())


def test_a_docstring_of_the_method_keeps_its_hash_and_an_operator_does_not(monkeypatch):
    read = Path.read_text
    for name, old, new, same in [
        ("intervals.py", '"""', '"""Plainly: ', True),
        ("intervals.py", "np.stack([values[0] - step[0]", "np.stack([values[0] + step[0]", False),
        ("branch_and_bound.py", "(least < parts.bound", "(least <= parts.bound", False),
    ]:

        def changed(path, *arguments, name=name, old=old, new=new, **options):
            text = read(path, *arguments, **options)
            assert path.name != name or old in text
            return text.replace(old, new, 1) if path.name == name else text

        with monkeypatch.context() as patch:
            patch.setattr(Path, "read_text", changed)
            assert (method.__wrapped__() == method()) is same, name


@pytest.mark.parametrize("name", ["quaternion_dcm", "inertia_cone"])
def test_bounds_of_the_table_are_found_again(name):
    for operations in operations_of(name, text_of(name)):
        problem = library_problem(definition(name), operations)
        for task in bound_tasks(operations, problem.box, problem.region).values():
            assert bound_task(task, fresh=True) == STORE.get(task.key)


@pytest.mark.parametrize(
    "change", [{"pointwise": 0.0, "bound": 0.0}, {"worst": ()}, {"pointwise": 1.0}, {"bound": float("inf")}]
)
def test_a_forged_bound_of_the_table_is_found(change, monkeypatch):
    """One point refutes it, the point stored with it; `python -m symrot.workshop.bound_table --check` tests all bounds."""
    double, _ = operations_of("quaternion_dcm", text_of("quaternion_dcm"))
    problem = library_problem(definition("quaternion_dcm"), double)
    tasks = {task.key: task for task in bound_tasks(double, problem.box, problem.region).values()}
    assert understated(tasks) == []
    key = next(iter(tasks))
    forged = replace(STORE.get(key), **change)
    stored = json.loads(printed_table([(key, forged)]))["bounds"][key]
    monkeypatch.setitem(table()["bounds"], key, stored)
    assert understated(tasks) == [key]


def test_certificates_and_heads_say_the_bounds_of_the_text_under_them():
    for name in ("quaternion_dcm", "euler_zxz_of_quaternion"):
        text = text_of(name)
        section = library_section(name, text)
        assert json.loads((GENERATED / f"{name}.cert.json").read_text(encoding="utf-8"))["rounding"] == section
        head = " ".join(line.strip(" *") for line in text[: text.index("*/")].splitlines())
        assert f"Errors: {bounds_sentence(name, section)}." in head


@pytest.mark.parametrize("value", ["0", "1/3", "1", "999", "9991/10", "1/1000", "123456789", "1/99999"])
def test_what_is_said_is_never_below_what_is_bounded(value):
    exact = Fraction(value)
    assert exact <= Fraction(rounded_up(exact)) <= exact * Fraction(101, 100)


# --- the inverse problem, and what is refused -------------------------------------------------------------------------


def test_the_largest_box_has_the_error_and_a_larger_one_has_not():
    operations = kernel("x[0]*x[1] + x[2]")
    box = box_of(-1, 1)
    size, largest = largest_box(operations, box, 1e-14)
    assert bound_outputs(operations, largest)[0].bound <= 1e-14
    assert bound_outputs(operations, resized(box, 1.01 * size, list(box)))[0].bound > 1e-14
    alone, only = largest_box(operations, box, 1e-15, ["x[2]"])
    assert only["x[0]"] == box["x[0]"] and alone > 1


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["euler_zyx_body_rates", "--box", "theta=-1.6:1.6"], "cos(angles[1])"),
        (["euler_equations_principal", "--box", "A=-1:1"], "inertia[0]"),
        (["euler_zyx_body_rates", "--box", "theta=1:-1"], "the smaller value first"),
        (["euler_zyx_body_rates", "--box", "theta=nan:1"], "expected a number"),
        (["euler_zyx_body_rates", "--box", "theta=0:inf"], "expected a number"),
        (["euler_zyx_body_rates", "--box", "theta"], "NAME=LOW:HIGH"),
        (["euler_zyx_body_rates", "--box", "nutation=0:1"], "one of phi, theta"),
        (["euler_zyx_body_rat"], "did you mean"),
        (["quaternion_dcm", "--target", "-1"], "above 0"),
        (["quaternion_dcm", "--target", "nan"], "above 0"),
        (["quaternion_dcm", "--target", "1e-30"], "1e-30"),
        (["quaternion_dcm", "--variable", "q0"], "--target"),
        (["quaternion_dcm", "--box", "q1=1e200:1e200"], "no bound"),
    ],
)
def test_what_has_no_bound_is_refused_in_one_sentence(capsys, words, sentence):
    assert main(["bound", *words]) == 2
    printed = capsys.readouterr()
    assert not printed.out and sentence in printed.err and printed.err.count("\n") == 1


def test_the_command_prints_bounds(capsys):
    assert main(["bound", "quaternion_dcm", "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert {item["units"] for item in facts["precisions"][0]["outputs"]} == {"4.001"}
    assert main(["bound", "quaternion_dcm", "--target", "1e-13"]) == 0
    assert "as wide" in capsys.readouterr().out
