"""JAX text of kernels: the operations of the C text, under jit, vmap and derivatives."""

import numpy as np
import pytest

from symrot.certificates.readback.jax_text import compare_jax
from symrot.codegen.library_kernels import kernel_description, kernel_program
from symrot.codegen.printing.c_source import c_functions
from symrot.codegen.printing.jax_source import SLOPES, jax_source
from symrot.codegen.printing.numpy_source import numpy_source
from symrot.errors import CertificateError
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import parse
from symrot.kernels.library import definition, kernel_names
from symrot.kernels.removable import DERIVATIVES
from symrot.workshop.kernel_text import kernel_text

KINDS = ("heavy_top", "rotation_vector_dcm", "rotation_vector_body_rates", "quaternion_of_dcm", "mrp_of_quaternion")


@pytest.fixture(scope="module")
def jax():
    """Return JAX, which computes in double precision during these tests."""
    module = pytest.importorskip("jax")
    before = module.config.jax_enable_x64
    module.config.update("jax_enable_x64", True)
    yield module
    module.config.update("jax_enable_x64", before)


def text_of(name):
    return jax_source(kernel_program(name), kernel_description(definition(name), "jax"))


def function_of(text, name):
    names = {}
    exec(text, names)
    return names[name]


def as_tuple(result):
    return result if isinstance(result, tuple) else (result,)


@pytest.mark.parametrize("name", KINDS)
def test_kernels_agree_with_numpy_under_jit_and_vmap(jax, name):
    program = kernel_program(name)
    ours = function_of(text_of(name), name)
    reference = function_of(numpy_source(program, kernel_description(definition(name), "numpy")), name)
    random = np.random.default_rng(20261128)
    inputs = [a for a in program.signature.arguments if a.role == "in" and a.size]
    samples = [random.uniform(0.5, 1.5, 4 if a.is_scalar else (a.size, 4)) for a in inputs]
    batch = jax.jit(jax.vmap(ours, in_axes=-1, out_axes=-1))(*samples)
    for mine, theirs in zip(as_tuple(batch), as_tuple(reference(*samples)), strict=True):
        np.testing.assert_allclose(mine, theirs, rtol=0, atol=1e-13 * max(1, np.abs(theirs).max()))


@pytest.mark.parametrize("shapes", [((3,), (4,)), ((3,), (2,)), ((5, 3), (5, 3)), ((3, 5), (4, 5))])
def test_an_array_of_another_length_is_refused(jax, shapes):
    """By index, JAX would take the last component for each that is missing."""
    ours = function_of(text_of("euler_zxz_body_rates"), "euler_zxz_body_rates")
    for function in (ours, jax.jit(ours)):
        with pytest.raises(ValueError, match=r"values to unpack \(expected 3"):
            function(*map(np.ones, shapes))


def test_derivatives_of_a_scene_agree_with_the_emitted_ones(jax):
    """jax.jacfwd of the rates is what --jacobian prints, in NumPy."""
    rates, slopes = (kernel_text("heavy_top_loops", variables) for variables in ((), ("y",)))
    y, p = np.array([0.3, -0.2, 0.1, 0.7, -0.5, 0.5]), np.array(rates.inputs.parameters)
    ours = jax.jacfwd(function_of(rates.source("jax"), rates.name), argnums=1)(0.0, y, p)
    parameters = np.array(slopes.inputs.parameters)
    _, theirs = function_of(slopes.source("numpy"), slopes.name)(0.0, y, parameters)
    np.testing.assert_allclose(np.ravel(ours), theirs, rtol=0, atol=1e-13 * np.abs(theirs).max())


def test_sinc_has_its_first_two_derivatives_everywhere(jax):
    """sinc'(0) = 0 and sinc''(0) = -1/3; a branch that is differentiated naively gives 0 or NaN."""
    sinc = function_of(text_of("rotation_vector_dcm"), "_sinc")
    assert (float(jax.grad(sinc)(0.0)), float(jax.grad(jax.grad(sinc))(0.0))) == (0.0, pytest.approx(-1 / 3))
    x = 1.7
    exact = np.cos(x) / x - np.sin(x) / x**2, 2 * np.sin(x) / x**3 - 2 * np.cos(x) / x**2 - np.sin(x) / x
    assert (float(jax.grad(sinc)(x)), float(jax.grad(jax.grad(sinc))(x))) == pytest.approx(exact, rel=1e-13)


def test_derivatives_at_the_zero_rotation_are_never_wrong(jax):
    """jax.jacfwd gives NaN there, since a root divides by zero; the kernel with its derivatives gives them."""
    slopes = kernel_text("rotation_vector_dcm", ("v",))
    naive = jax.jacfwd(function_of(text_of("rotation_vector_dcm"), "rotation_vector_dcm"))(np.zeros(3))
    _, exact = function_of(slopes.source("jax"), slopes.name)(np.zeros(3))
    generators = -np.cross(np.eye(3)[:, None], np.eye(3)[None, :]).transpose(1, 2, 0)
    assert np.isnan(naive).any()
    np.testing.assert_array_equal(np.reshape(exact, (3, 3, 3)), generators)


def test_a_step_is_emitted_too(jax):
    from symrot.workshop.step_text import step_text

    step = step_text("heavy_top_loops", "rk4")
    x, p = np.array([0.3, -0.2, 0.1, 0.7, -0.5, 0.5]), np.array(step.rates.inputs.parameters)
    ours, theirs = (
        function_of(text, step.name)(0.0, x, p, 1e-3) for text in (step.source("jax"), step.source("numpy"))
    )
    np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-14)


def test_the_rules_of_derivatives_are_those_of_the_kernels():
    assert {name: str(DERIVATIVES[name](parse_symbol())) for name in SLOPES} == {
        name: f"-x*{slope}(x)" for name, slope in SLOPES.items()
    }


def parse_symbol():
    from sympy import Symbol

    return Symbol("x", real=True)


@pytest.mark.thinned(8)
@pytest.mark.parametrize("name", kernel_names())
def test_the_operations_are_those_of_the_c_text(name):
    compare_jax(text_of(name), name, c_functions(kernel_program(name)))


def test_a_constant_may_have_the_name_of_a_word_of_python():
    components = (("in", "", ""), ("in_", "", ""), ("jnp", "", ""))
    signature = Signature("f", (Argument("p", "in", components), Argument("out", "out", (("sum", "", ""),))))
    program = Program(signature, (), (("sum", parse("in + in_*jnp")),))
    text = jax_source(program, kernel_description(definition("heavy_top"), "jax"))
    assert text.splitlines()[-5:] == [
        "    in__, in_, jnp_ = p", "    out = jnp.stack([", "        in__ + in_*jnp_,", "    ])", "    return out",
    ]  # fmt: skip


@pytest.mark.parametrize(("name", "old", "new", "message"), [
    ("heavy_top", "q1*half_1 + ", "q1*half_1 - ", "got other operations"),
    ("heavy_top", "half_1 = 0.5*", "half_1 = 0.25*", "got other operations"),
    ("heavy_top", "dq = jnp.stack([", "domega = jnp.stack([", "one assignment|to assign"),
    ("heavy_top", "    A, B, C = inertia\n", "    B, A, C = inertia\n", "got other operations"),
    ("heavy_top", "    A, B, C = inertia\n", "    A, B = inertia\n", "names for the 3 components of inertia"),
    ("heavy_top", "2.0*W", "2*W", "literal"),
    ("heavy_top", "    A, B, C = inertia\n", "    A, A, C = inertia\n", "not yet used"),
    ("heavy_top", "0.5*omega_1", "jnp.maximum(0.5, 1.0)*omega_1", "a function of jax.numpy"),
    ("heavy_top", "(inertia, W,", "(W, inertia,", "expected the arguments"),
    ("heavy_top", "return domega, dq", "return dq, domega", "expected the function to return"),
    ("heavy_top", "\n\ndef heavy_top", "\nprint(1)\n\ndef heavy_top", "expected"),
    ("heavy_top", "import jax.numpy as jnp\n", "import numpy as jnp\n", "the import of jax.numpy"),
    ("heavy_top", "\n\ndef heavy_top", "\n\ndef jnp(x):\n    return jnp.where(x == 0.0, 1.0, x)\n\n\ndef heavy_top", "functions with a name such as _sinc"),
    ("heavy_top", ")/A,", ")/A, A,", "one formula in each line"),
    ("heavy_top", "q2*q3", "q2**q3", "as symrot emits it"),
    ("rotation_vector_dcm", "-x*_tangent_gap(x)*dx", "x*_tangent_gap(x)*dx", "only definitions of functions"),
    ("rotation_vector_dcm", "x == 0.0, 1.0,", "x == 0.0, 2.0,", "got other operations"),
    ("rotation_vector_dcm", "@jax.custom_jvp\n", "", "a rule for the derivative"),
    ("rotation_vector_dcm", "jnp.where(x == 0.0, 1.0, jnp.sin(x)/x)", "jnp.sin(x)/x", "jnp.where"),
])  # fmt: skip
def test_wrong_jax_is_refused(name, old, new, message):
    text = text_of(name)
    assert old in text
    with pytest.raises(CertificateError, match=message):
        compare_jax(text.replace(old, new, 1), name, c_functions(kernel_program(name)))
