"""JavaScript text of kernels: the same operations as the program, read by Node.js."""

import json
import shutil
import subprocess

import numpy as np
import pytest

from symrot.certificates.readback.javascript import compare_javascript
from symrot.codegen.library_kernels import kernel_description, kernel_program
from symrot.codegen.printing.c_source import c_functions
from symrot.codegen.printing.js_source import COPYSIGN, js_function, js_source
from symrot.errors import CertificateError
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import parse
from symrot.kernels.library import definition, kernel_names
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

needs_node = pytest.mark.skipif(shutil.which("node") is None, reason="needs Node.js")


def text_of(name):
    return js_source(kernel_program(name), kernel_description(definition(name), "js"))


def values_in_node(names, samples, folder):
    """The outputs of kernels in Node.js: name -> for each sample the numbers of all output arrays."""
    for name in names:
        (folder / f"{name}.mjs").write_text(text_of(name), encoding="utf-8")
    sizes = {
        name: [(a.role, a.is_scalar, a.size) for a in kernel_program(name).signature.arguments if a.size]
        for name in names
    }
    script = """
    const results = {};
    for (const [name, shapes] of Object.entries(sizes)) {
        const kernel = (await import(`./${name}.mjs`))[name];
        results[name] = samples[name].map((values) => {
            let place = 0;
            const outputs = [], call = shapes.map(([role, scalar, size]) => {
                if (role === "out") { outputs.push(new Float64Array(size)); return outputs.at(-1); }
                place += size;
                return scalar ? values[place - 1] : values.slice(place - size, place);
            });
            kernel(...call);
            return outputs.flatMap((output) => [...output]);
        });
    }
    console.log(JSON.stringify(results));
    """
    (folder / "run.mjs").write_text(
        f"const sizes = {json.dumps(sizes)}, samples = {json.dumps(samples)};\n{script}", encoding="utf-8"
    )
    done = subprocess.run(["node", "run.mjs"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@needs_node
def test_every_kernel_computes_in_javascript_what_its_program_says(tmp_path):
    """Only sine, cosine and arc tangent may differ by their last bits."""
    random = np.random.default_rng(20261124)
    names = list(kernel_names())
    samples, expected = {}, {}
    for name in names:
        program = kernel_program(name)
        inputs = [c for a in program.signature.arguments if a.role == "in" for c, *_ in a.components]
        rows = random.uniform(0.5, 1.5, (3, len(inputs))).tolist()
        samples[name] = rows
        order = [c for a in program.signature.arguments if a.role == "out" for c, *_ in a.components]
        outputs = [program.evaluate(dict(zip(inputs, row, strict=True)), functions()) for row in rows]
        expected[name] = [[values[component] for component in order] for values in outputs]
    results = values_in_node(names, samples, tmp_path)
    for name in names:
        scale = max(1.0, np.abs(expected[name]).max())
        np.testing.assert_allclose(results[name], expected[name], rtol=0, atol=1e-12 * scale, err_msg=name)


def functions():
    """The functions of programs for floats; those with a removable singularity are wanted away from it."""
    from math import atan2, copysign, cos, sin

    return FLOAT_FUNCTIONS | {
        "sinc": lambda x: sin(x) / x, "sine_gap": lambda x: (1 - sin(x) / x) / x / x,
        "tangent_gap": lambda x: (sin(x) / x - cos(x)) / x / x,
        "sine_bend": lambda x: (2 + cos(x) - 3 * (sin(x) / x)) / x / x / x / x,
        "tangent_bend": lambda x: (3 * (sin(x) / x - cos(x)) / x - sin(x)) / x / x / x, "arc_ratio": lambda s, c: atan2(s, c) / s,
        "copysign": copysign, "select_ge": lambda a, b, x, y: x if a >= b else y,
    }  # fmt: skip


def test_every_own_function_is_tested_above():
    assert OWN_FUNCTIONS.keys() <= functions().keys()


@needs_node
def test_an_array_of_another_length_is_refused(tmp_path):
    """By index, the quaternion (1, 0, 0, 0) would pass for the angular velocity (1, 0, 0)."""
    (tmp_path / "kernel.mjs").write_text(text_of("euler_zxz_body_rates"), encoding="utf-8")
    calls = "[[[0, 1, 0], [1, 0, 0, 0]], [[0, 1], [1, 0, 0]], [[0, 1, 0], [1, 0, 0]]]"
    (tmp_path / "run.mjs").write_text(
        'import { euler_zxz_body_rates as rates } from "./kernel.mjs";\n'
        f"for (const inputs of {calls}) try {{ rates(...inputs, []); console.log(1); }} catch (e) {{ console.log(e.message); }}"
    )
    done = subprocess.run(["node", "run.mjs"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["omega: expected 3 numbers, got 4", "angles: expected 3 numbers, got 2", "1"]


@needs_node
def test_copysign_minds_the_sign_of_zero(tmp_path):
    (tmp_path / "sign.mjs").write_text("\n".join([*COPYSIGN, "console.log(copysign(2, -0), copysign(-2, 0))"]))
    done = subprocess.run(["node", "sign.mjs"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["-2", "2"]


def test_the_text_does_not_change_from_call_to_call():
    assert text_of("heavy_top") == text_of("heavy_top")
    assert "export function heavy_top(inertia, W, center_of_mass, omega, q, domega, dq) {" in text_of("heavy_top")


def test_a_constant_may_have_the_name_of_a_word_of_javascript():
    components = (("in", "", ""), ("in_", "", ""), ("var", "", ""))
    signature = Signature("f", (Argument("p", "in", components), Argument("out", "out", (("sum", "", ""),))))
    program = Program(signature, (), (("sum", parse("in + in_*var")),))
    assert js_function(program)[1:] == [
        "    const in__ = p[0];", "    const in_ = p[1];", "    const var_ = p[2];", "    out[0] = in__ + in_*var_;", "}",
    ]  # fmt: skip


def test_the_operations_are_those_of_the_c_text():
    for name in kernel_names():
        compare_javascript(text_of(name), name, c_functions(kernel_program(name)))


@pytest.mark.parametrize(("old", "new", "message"), [
    ("q1*half_1 + ", "q1*half_1 - ", "got other operations"),
    ("const half_1 = 0.5*", "const half_1 = 0.25*", "got other operations"),
    ("dq[0] =", "dq[1] =", "one assignment"),
    ("    dq[3] =", "    // dq[3] =", "to assign"),
    ("const A", "let A", "an output array"),
    ("const A", "const double A", "the word double"),
    ("2.0*W", "2*W", "literal"),
    ("const B", "const A", "not yet used"),
    ("omega.length !== 3", "omega.length !== 4", "a check that omega has 3 numbers"),
    ("0.5*omega_1", "Math.max(0.5, 1.0)*omega_1", "a function of Math"),
    ("(inertia, W,", "(W, inertia,", "expected the arguments"),
    ("export function heavy_top", "eval(1);\nexport function heavy_top", "only functions"),
    ("B - C", "B - C, A", "expected"),
    ("q2*q3", "q2**q3", "expected"),
])  # fmt: skip
def test_wrong_javascript_is_refused(old, new, message):
    text = text_of("heavy_top")
    assert old in text
    with pytest.raises(CertificateError, match=message):
        compare_javascript(text.replace(old, new, 1), "heavy_top", c_functions(kernel_program("heavy_top")))


def test_another_copysign_is_refused():
    name = next(name for name in kernel_names() if "copysign" in text_of(name))
    with pytest.raises(CertificateError):
        compare_javascript(text_of(name).replace("? -1 : 1", "? 1 : -1"), name, c_functions(kernel_program(name)))
