"""Kernels compute the equations exactly, in every language, without unnecessary operations, with the same bytes on
every machine.
"""

import ctypes
import json
import os
import random
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy

import symrot
from symrot import symbols
from symrot.certificates import exact_check, recheck
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.lowering.formulas import to_node
from symrot.codegen.lowering.lower import lower
from symrot.codegen.numpy_kernel import load_numpy_kernel
from symrot.codegen.printing.banner import Description
from symrot.codegen.printing.c_source import c_header, c_source
from symrot.codegen.scene_kernels import derive_scene_kernel, rates_program
from symrot.dynamics.equations import equations_of_motion
from symrot.dynamics.structure import PrincipalInertia, Structure
from symrot.errors import InputError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import children, evaluate, names, text
from symrot.planning.plan import make_plan
from symrot.planning.scene_kernel import SceneKernel, bind
from symrot.scene.file import names_with_kernels
from symrot.scene.scene import Scene, load_scene

SCENES = names_with_kernels()
MP = {name: getattr(mpmath, name) for name in ("sqrt", "sin", "cos", "exp")} | {"abs": abs}


@pytest.fixture(scope="module", params=SCENES)
def scene_rates(request):
    """Return the plan, the equations and the lowered rates of a shipped scene."""
    plan = make_plan(load_scene(request.param))
    equations = equations_of_motion(plan.structure)
    return plan, equations, rates_program(equations, "rates")


def random_values(program, seed):
    draw = random.Random(seed)
    used = [name for a in program.signature.arguments if a.role == "in" for name, *_ in a.components]
    return {name: Fraction(draw.randint(-40, 40), 8) for name in used}


def test_programs_equal_their_equations_to_50_digits(scene_rates):
    plan, equations, lowered = scene_rates
    with mpmath.workdps(60):
        values = {k: mpmath.mpf(v.numerator) / v.denominator for k, v in random_values(lowered.program, 1).items()}
        constants = {k: mpmath.mpf(v.numerator) / v.denominator for k, v in plan.constants.items()}
        number = lambda v: mpmath.mpf(v.numerator) / v.denominator  # noqa: E731
        values |= {name: evaluate(node, constants, MP, number) for name, node in lowered.parameters}
        found = lowered.program.evaluate(values, MP, number)
        known = {sympy.Symbol(k, real=True): v for k, v in values.items()}
        for state, rate in zip(equations.states, equations.explicit_rates, strict=True):
            free = sorted(rate.free_symbols, key=str)
            exact = sympy.lambdify(free, rate, "mpmath")(
                *(constants.get(str(s), known.get(s, values.get(str(s)))) for s in free)
            )
            assert abs(found[f"d{state}"] - exact) <= mpmath.mpf(10) ** -50 * (1 + abs(exact))


@pytest.mark.parametrize("shapes", [((3,), (4,)), ((3,), (2,)), ((5, 3), (5, 3)), ((3, 5), (4, 5)), ((3, 4), (4, 3))])
def test_numpy_kernels_refuse_arrays_whose_first_axis_is_not_the_components(shapes):
    """Samples along the first axis, or a quaternion for an angular velocity, would give numbers without meaning."""
    kernel = load_numpy_kernel(kernel_program("euler_zxz_body_rates"))
    with pytest.raises(ValueError, match=r"values to unpack \(expected 3"):
        kernel(*map(np.ones, shapes))


def test_no_operation_is_constant_trivial_or_unused(scene_rates):
    _, _, lowered = scene_rates
    program = lowered.program
    used = set().union(*(names(node) for _, node in program.temporaries + program.outputs))
    assert {name for name, _ in program.temporaries} <= used
    assert {name for name, _ in lowered.parameters} <= used
    trivial = {
        ("*", Fraction(1)),
        ("*", Fraction(0)),
        ("*", Fraction(-1)),
        ("+", Fraction(0)),
        ("-", Fraction(0)),
        ("/", Fraction(1)),
    }

    def visit(node):
        operands = children(node)
        if operands:
            assert any(operand[0] != "number" for operand in operands), text(node)
            assert not any((node[0], o[1]) in trivial for o in operands if o[0] == "number"), text(node)
        for operand in operands:
            visit(operand)

    for _, node in program.temporaries + program.outputs:
        visit(node)
    written = [node for _, node in program.temporaries + program.outputs if children(node)]
    assert len(written) == len(set(written))


def counts(name):
    plan = make_plan(load_scene(name))
    return rates_program(equations_of_motion(plan.structure), "rates").program.operations()


def test_a_free_body_costs_at_most_6_multiplications_and_with_attitude_24():
    structure = Structure(PrincipalInertia(), (), attitude=False)
    rates = rates_program(equations_of_motion(structure), "rates").program.operations()
    assert rates["mul"] <= 6 and rates["div"] == 0
    full = rates_program(equations_of_motion(replace(structure, attitude=True)), "rates").program.operations()
    assert full["mul"] <= 24 and full["div"] == 0


def test_no_shipped_kernel_divides():
    assert all(counts(name)["div"] == 0 for name in SCENES)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", ["free", "tensor", "gradient"])
def test_constants_are_bound_exactly_and_rounded_once(name):
    plan = make_plan(
        load_scene({"free": "tumbling_prism", "tensor": "gyrostat", "gradient": "gravity_gradient_satellite"}[name])
    )
    kernel = derive_scene_kernel(plan.structure)
    for (_, node), bound in zip(kernel.rate_parameters, bind(kernel.rate_parameters, plan.constants), strict=True):
        exact = evaluate(node, plan.constants)
        assert bound == exact.numerator / exact.denominator


def euler_rates():
    """Return the inverse rates of ZXZ, the example of the style guide."""
    psi, theta = symbols.psi, symbols.theta
    w1, w2, w3 = symbols.omega_b
    q = Argument("q", "in", tuple((str(a), "rad", "") for a in symbols.angles))
    omega = Argument("omega", "in", tuple((str(w), "rad/s", "") for w in symbols.omega_b))
    dq = Argument("dq", "out", tuple((f"d{a}", "rad/s", "") for a in symbols.angles))
    turn = (w1 * sympy.sin(psi) + w2 * sympy.cos(psi)) / sympy.sin(theta)
    outputs = [turn, w1 * sympy.cos(psi) - w2 * sympy.sin(psi), w3 - sympy.cos(theta) * turn]
    names_of = [f"d{a}" for a in symbols.angles]
    return lower(Signature("euler_zxz_rates", (q, omega, dq)), list(zip(names_of, outputs, strict=True)))


def test_common_quotients_are_shared():
    assert euler_rates().program.operations() == {"mul": 5, "add": 3, "div": 1, "sin": 2, "cos": 2}


def test_a_divisor_alone_is_inverted_once():
    a, b, c = (sympy.Symbol(s, real=True) for s in "abc")
    given = Argument("v", "in", tuple((s, "1", "") for s in "abc"))
    out = Argument("out", "out", (("x", "1", ""), ("y", "1", "")))
    lowered = lower(Signature("f", (given, out)), [("x", a / c), ("y", b / c)])
    assert lowered.program.operations() == {"mul": 2, "div": 1}


def test_equal_formulas_are_computed_once_whatever_their_sign_and_factor():
    a, b = (sympy.Symbol(s, real=True) for s in "ab")
    k = sympy.Symbol("k", real=True)
    given = Argument("v", "in", (("a", "1", ""), ("b", "1", "")))
    out = Argument("out", "out", tuple((s, "1", "") for s in "xyz"))
    lowered = lower(Signature("f", (given, out)), [("x", a - b), ("y", 3 * (b - a)), ("z", k * a - k * b)])
    assert lowered.program.operations() == {"add": 1, "mul": 2}


@pytest.mark.parametrize(
    "wrong", [sympy.Float(0.5) * symbols.theta, symbols.theta ** sympy.Rational(1, 3), sympy.gamma(symbols.theta), symbols.theta**symbols.psi]
)  # fmt: skip
def test_what_a_kernel_cannot_hold_is_refused(wrong):
    given = Argument("q", "in", (("theta", "rad", ""), ("psi", "rad", "")))
    with pytest.raises(InputError):
        lower(Signature("f", (given, Argument("x", "out", (("x", "1", ""),)))), [("x", wrong)])


def test_a_program_that_uses_what_is_not_there_is_refused():
    signature = Signature("f", (Argument("x", "out", (("x", "1", ""),)),))
    with pytest.raises(ValueError, match="uses"):
        Program(signature, (), (("x", ("symbol", "nowhere")),))


def test_saved_kernels_come_back_equal(scene_rates):
    plan, _, _ = scene_rates
    kernel = derive_scene_kernel(plan.structure)
    again = SceneKernel(json.loads(json.dumps(kernel.record)))
    assert again.rates == kernel.rates and again.quantities == kernel.quantities
    assert again.rate_parameters == kernel.rate_parameters and again.conserved == kernel.conserved


def test_formula_trees_keep_the_value():
    a, b, c = symbols.principal
    expr = (a - b) ** 2 / (c * sympy.sqrt(a)) - 3 * b**-2 + sympy.Abs(c - a)
    values = {"A": mpmath.mpf(3), "B": mpmath.mpf(2), "C": mpmath.mpf(7)}
    found = evaluate(to_node(expr), values, MP, lambda v: mpmath.mpf(v.numerator) / v.denominator)
    expected = mpmath.mpf(str(sympy.N(expr.subs({a: 3, b: 2, c: 7}), 30)))
    assert mpmath.almosteq(found, expected, rel_eps=1e-15)


# --- the emitted text -------------------------------------------------------------------------------------------------

STRICT = ["-O2", "-Wall", "-Wextra", "-Wconversion", "-Wpedantic", "-Werror", "-ffp-contract=off", "-fPIC", "-shared"]
needs_cc = pytest.mark.skipif(shutil.which("gcc") is None or shutil.which("g++") is None, reason="needs gcc and g++")


def build(directory, emitted, language):
    (directory / f"{emitted.name}.h").write_text(emitted.header)
    source = directory / f"{emitted.name}.c"
    source.write_text(emitted.source)
    compiler = ["gcc", "-std=c99"] if language == "c" else ["g++", "-std=c++17", "-x", "c++"]
    library = directory / f"{emitted.name}-{language}.so"
    subprocess.run(
        [*compiler, *STRICT, str(source), "-o", str(library), "-lm"], check=True, capture_output=True, text=True
    )
    return ctypes.CDLL(str(library))


def array(values):
    return np.ascontiguousarray(values, dtype=float)


def pointer(values):
    return values.ctypes.data_as(ctypes.c_void_p)


@pytest.mark.thinned(3)
@pytest.mark.thinned(6)
@needs_cc
@pytest.mark.parametrize("language", ["c", "c++"])
@pytest.mark.parametrize("name", SCENES)
def test_c_cpp_numpy_and_program_agree_to_the_last_bit(tmp_path, name, language):
    emitted = symrot.emit(name)
    library = build(tmp_path, emitted, language)
    plan = symrot.plan(name)
    lowered = rates_program(equations_of_motion(plan.structure), "rates")
    n, size = 5, len(plan.states)
    draw = np.random.default_rng(7)
    y, t = draw.normal(size=(size, n)), draw.normal(size=n)
    p = array(bind(lowered.parameters, plan.constants))
    by_numpy = load_numpy_kernel(lowered.program)
    one, batch = getattr(library, emitted.function), getattr(library, f"{emitted.function}_batch")
    many = np.empty((size, n))
    arguments = [pointer(t), pointer(array(y)), *([pointer(p)] if len(p) else []), pointer(many)]
    batch(ctypes.c_size_t(n), *arguments)
    for k in range(n):
        single, sample = np.empty(size), array(y[:, k])
        one(ctypes.c_double(t[k]), pointer(sample), *([pointer(p)] if len(p) else []), pointer(single))
        values = {"t": t[k], **dict(zip(plan.states, sample, strict=True)), **{f"p{i}": v for i, v in enumerate(p)}}
        functions = {"sin": np.sin, "cos": np.cos, "abs": abs, "sqrt": np.sqrt}
        expected = list(lowered.program.evaluate(values, functions).values())
        from_numpy = by_numpy(t[k], sample, p) if len(p) else by_numpy(t[k], sample)
        assert np.array_equal(single, expected) and np.array_equal(single, many[:, k])
        assert np.array_equal(single, from_numpy)


def test_no_emitted_line_is_long_and_nothing_of_the_machine_is_in_it():
    for name in SCENES:
        for target in symrot.workshop.emit.TARGETS:
            emitted = symrot.emit(name, target)
            for line in (emitted.header + emitted.source).splitlines():
                assert len(line) <= 120
            assert str(Path.cwd()) not in emitted.source and "/tmp" not in emitted.source


@needs_cc
def test_a_title_cannot_break_out_of_its_comment(tmp_path):
    hostile = 'quick */ int x; /* """ \\ ??/ #error \U0001f600'
    scene = Scene.from_dict({
        "schema": 1, "title": hostile, "body": {"principal": [1, 2, 3]}, "initial": {"omega": [1, 1, 1]}, "span": {"t": [0, 9]},
    })  # fmt: skip
    emitted = symrot.emit(scene)
    build(tmp_path, emitted, "c")
    assert emitted.source.count("*/") == emitted.source.count("/*") == 1
    compile(symrot.emit(scene, "numpy").source, "kernel", "exec")


def test_functions_of_constants_are_certified(tmp_path):
    """A parameter of the kernel may be a formula with a square root, such as sqrt(k)/A."""
    torque = {"kind": "expression", "torque": ["sqrt(k)*sin(k)*omega_1", "0", "0"], "parameters": {"k": 2}}
    content = {"schema": 1, "title": "A root", "body": {"principal": [1, 2, 3]}, "torque": [torque],
               "initial": {"omega": [1, 1, 1]}, "span": {"t": [0, 9]}}  # fmt: skip
    emitted = symrot.emit(Scene.from_dict(content))
    path = tmp_path / f"{emitted.name}.cert.json"
    for file, content in ((path, emitted.certificate), (path.with_name(f"{emitted.name}.c"), emitted.source),
                       (path.with_name(f"{emitted.name}.h"), emitted.header)):  # fmt: skip
        file.write_text(content, encoding="utf-8")
    assert json.loads(emitted.certificate)["spec"]["parameters"]["p0"] == "sqrt(k)*sin(k)/A"
    assert recheck.check(path).startswith(emitted.name)
    exact_check.check(path)


NAMES = ("\\", "*\\ int x;", "a??", "??/", "http:", "caf\u00e9", "\u65e5\u672c", "\t", "a\nb", "\u202eabc", "'", '"', "-x",
         "int", "x" * 200, "#", "%s", "quaternion_dcm", "class", '"""')  # fmt: skip


@pytest.mark.thinned(4)
@needs_cc
@pytest.mark.parametrize("name", NAMES, ids=ascii)
def test_a_scene_of_any_name_is_emitted_and_certified(name, tmp_path, monkeypatch):
    """Name and title appear in comments; the name of the function is derived from the scene's name."""
    monkeypatch.chdir(tmp_path)
    title = name if name.isprintable() else ascii(name)
    torque = {"kind": "expression", "torque": ["sin(t)", "0", "0"]}
    content = {"schema": 1, "title": f"{title} http://x.org *\\ */ ??/", "body": {"principal": [1, 2, 3]}, "torque": [torque],
               "initial": {"omega": [1, 1, 1]}, "span": {"t": [0, 9]}}  # fmt: skip
    scene = replace(Scene.from_dict(content), name=name)
    emitted = symrot.emit(scene)
    assert emitted.source.isascii()
    assert emitted.source.count("*/") == emitted.source.count("/*") == 1 and "//" not in emitted.source
    compile(symrot.emit(scene, "numpy").source, "kernel", "exec")
    (tmp_path / f"{emitted.name}.c").write_text(emitted.source, encoding="utf-8")
    (tmp_path / f"{emitted.name}.h").write_text(emitted.header, encoding="utf-8")
    path = tmp_path / f"{emitted.name}.cert.json"
    path.write_text(emitted.certificate, encoding="utf-8")
    subprocess.run(["cc", "-std=c99", "-trigraphs", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-c", path.name.replace(".cert.json", ".c")],
                   check=True)  # fmt: skip
    assert recheck.check(path).startswith(emitted.name)
    exact_check.check(path)


def test_emitted_text_is_the_same_under_any_hash_seed():
    chosen = SCENES[::6]
    code = (
        "import symrot, sys; print(*(''.join(symrot.emit(n, t)) for n in sys.argv[1:] for t in ('c', 'numpy')), sep='')"
    )
    seed = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"
    printed = subprocess.run([sys.executable, "-c", code, *chosen], env=os.environ | {"PYTHONHASHSEED": seed},
                             capture_output=True, text=True, check=True).stdout  # fmt: skip
    assert printed == "".join("".join(symrot.emit(n, t)) for n in chosen for t in ("c", "numpy")) + "\n"


def test_arguments_that_are_not_used_do_not_warn_and_literals_are_doubles():
    given = Argument("q", "in", (("theta", "rad", ""),))
    lowered = lower(Signature("f", (given, Argument("x", "out", (("x", "1", ""),)))), [("x", sympy.Rational(1, 3))])
    emitted = c_source(lowered.program, Description("constant", "all", "none", "none"))
    assert "(void)q;" in emitted and "x[0] = 0.3333333333333333;" in emitted
    assert "#ifndef SYMROT_F_H" in c_header(lowered.program, Description("constant", "all", "none", "none"))


@pytest.mark.parametrize(("scene", "target"), [("chen_cylinder", "fortran"), ("no_such_scene", "c")])
def test_what_cannot_be_emitted_is_refused(scene, target):
    with pytest.raises(InputError):
        symrot.emit(scene, target)


@pytest.mark.parametrize("options", [{}, {"step": "rk4"}, {"step": "exact"}], ids=str)
def test_an_emitted_kernel_has_the_parameters_of_its_scene(options):
    """They are the numbers of the C text: of its head comment, or of its file of parameters."""
    kernel = symrot.emit("heavy_top_loops", **options)
    texts = kernel.text.c_files()
    numbers = [float(word) for word in re.findall(r"[-+]?\d+\.\d*(?:e[-+]?\d+)?", "".join(texts.values()))]
    assert len(kernel.parameters) == 3 and set(kernel.parameters) <= set(numbers)
    assert symrot.emit("quaternion_dcm").parameters == ()
