"""Kernels with derivatives: against complex steps and mpmath, their laws, their certificates, bad input."""

import json
from math import inf

import mpmath
import numpy as np
import pytest

import symrot
from symrot.certificates.certificate import certificate_text
from symrot.codegen.library_kernels import kernel_program
from symrot.errors import CertificateError, InputError
from symrot.formula.float_functions import FLOAT_FUNCTIONS
from symrot.formula.program import Program
from symrot.kernels.jacobian import BY
from symrot.kernels.library import definition, kernel_names
from symrot.workshop.certify import audit_file, certify
from symrot.workshop.kernel_text import kernel_text

WITHOUT = ("rotation_vector_of_quaternion",)  # the derivative of its arc tangent over a length is no kernel's function


def _own(x: mpmath.mpf, name: str) -> mpmath.mpf:
    quotients = {
        "sinc": lambda: mpmath.sin(x) / x,
        "sine_gap": lambda: (x - mpmath.sin(x)) / x**3,
        "tangent_gap": lambda: (mpmath.sin(x) - x * mpmath.cos(x)) / x**3,
        "sine_bend": lambda: (2 * x + x * mpmath.cos(x) - 3 * mpmath.sin(x)) / x**5,
        "tangent_bend": lambda: ((3 - x**2) * mpmath.sin(x) - 3 * x * mpmath.cos(x)) / x**5,
    }
    return quotients[name]()


FUNCTIONS = {
    **{name: getattr(mpmath, name) for name in FLOAT_FUNCTIONS if name not in ("abs",)},
    "abs": abs,
    "copysign": lambda x, y: abs(x) * (1 if y >= 0 else -1),
    "select_ge": lambda a, b, x, y: x if a >= b else y,
    **{name: lambda x, name=name: _own(x, name) for name in
       ("sinc", "sine_gap", "tangent_gap", "sine_bend", "tangent_bend")},
}  # fmt: skip


def _values(program: Program, point: dict[str, mpmath.mpf]) -> dict[str, mpmath.mpf]:
    return program.evaluate(point, FUNCTIONS, lambda value: mpmath.mpf(value.numerator) / value.denominator)


def _point(name: str) -> dict[str, mpmath.mpf]:
    draw = np.random.default_rng(11)
    box = definition(name).box
    inside = {each: draw.uniform(0.1, 0.9) for each in box}
    return {each: mpmath.mpf(float(low) + inside[each] * float(high - low)) for each, (low, high) in box.items()}


def _derived(name: str) -> str:
    return BY.join([name, *(argument.name for argument in definition(name).inputs)])


@pytest.mark.thinned(30)
@pytest.mark.parametrize("name", [name for name in kernel_names() if name not in WITHOUT])
def test_derivatives_are_differences_of_values(name):
    """Each derivative equals the central difference of the kernel itself, to half of 60 digits."""
    with mpmath.workdps(60):
        point, step = _point(name), mpmath.mpf(10) ** -20
        derived = _values(kernel_program(_derived(name)), point)
        for variable in point:
            ends = [
                _values(kernel_program(name), point | {variable: point[variable] + sign * step}) for sign in (1, -1)
            ]
            for output in ends[0]:
                slope = (ends[0][output] - ends[1][output]) / (2 * step)
                error = abs(derived[f"{output}{BY}{variable}"] - slope)
                assert error < mpmath.mpf(10) ** -30 * (1 + abs(slope)), (output, variable)


@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", ["quaternion_dcm", "heavy_top_symmetric", "rotation_vector_dcm"])
def test_the_values_stay_the_same(name):
    """The outputs of a kernel with derivatives are those of the kernel, and the derivatives follow them."""
    with mpmath.workdps(40):
        plain, derived = kernel_program(name), kernel_program(_derived(name))
        point = _point(name)
        ours = _values(derived, point)
        assert list(ours)[: len(plain.outputs)] == [output for output, _ in plain.outputs]
        for output, value in _values(plain, point).items():
            assert abs(ours[output] - value) < mpmath.mpf(10) ** -35 * (1 + abs(value))


@pytest.mark.parametrize("name", ["rotation_vector_quaternion", "rotation_vector_dcm", "rotation_vector_body_rates"])
def test_derivatives_are_finite_at_zero(name):
    """A rotation vector of zero has derivatives: in NumPy they are the limit of the derivatives nearby."""
    emitted = symrot.emit(name, "numpy", jacobian=["v"])
    room: dict = {}
    exec(emitted.source, room)
    more = [np.array([0.3, -0.2, 0.5])] * (len(definition(name).inputs) - 1)
    at_zero = room[emitted.name](np.zeros(3), *more)
    nearby = room[emitted.name](np.array([1e-9, -2e-9, 1e-9]), *more)
    for zero, near in zip(at_zero, nearby, strict=True):
        assert np.all(np.isfinite(zero))
        assert np.max(np.abs(zero - near)) < 1e-8


@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", ["quaternion_dcm_by_q", "euler_zxz_body_rates_by_theta_by_omega",
                                  "rotation_vector_quaternion_by_v", "rotation_vector_body_jacobian_by_v"])  # fmt: skip
def test_a_certificate_proves_the_derivatives(name, tmp_path):
    """The C text is proven equal to the derivatives, and the audit accepts the certificate."""
    data, _ = certify(name, directory=tmp_path)
    assert any(law["law"].startswith("the derivatives with respect to") for law in data["laws"])
    for folder, suffix in (("numpy", ".py"), ("js", ".js")):
        (tmp_path.parent / folder).mkdir(exist_ok=True)
        text = kernel_text(name).source(folder)
        (tmp_path.parent / folder / f"{name}{suffix}").write_text(text, encoding="utf-8")
    assert audit_file(tmp_path / f"{name}.cert.json")


def test_a_wrong_derivative_is_not_certified():
    """A C text with one wrong sign in a derivative is refused."""
    kernel = kernel_text("quaternion_dcm_by_q").under_test()
    text = kernel.files["quaternion_dcm_by_q.c"]
    lines = [line for line in text.splitlines() if line.strip().startswith("dcm_by_q[5] =")]
    wrong = text.replace(lines[0], lines[0].replace("= ", "= -(").replace(";", ");"))
    files = dict(kernel.files) | {"quaternion_dcm_by_q.c": wrong}
    with pytest.raises(CertificateError):
        certificate_text(type(kernel)(**{**kernel.__dict__, "files": files}))


def test_fewer_operations_than_differences():
    """Value and derivatives share terms: quaternion_dcm needs less than twice the operations of the value."""
    plain, derived = (kernel_program(name).operations().total() for name in ("quaternion_dcm", "quaternion_dcm_by_q"))
    assert plain < derived < 2 * plain < inf


def test_divisors_of_values_and_derivatives_are_shared():
    """Each moment divides once: values and derivatives of the heavy top use its inverse."""
    counts = kernel_program("heavy_top_by_omega_by_q").operations()
    assert counts["div"] == 3
    # CasADi needs 110, from symrot's own program of the values
    assert counts.total() - counts["neg"] <= 110


@pytest.mark.parametrize(
    ("kernel", "variables", "words"),
    [
        ("quaternion_dcm", ["omega"], "derivatives with respect to its inputs (q, q0, q1, q2, q3), got 'omega'"),
        ("quaternion_dcm", ["q", "q1"], "each input once"),
        ("quaternion_dcm", ["q", "q"], "each input once"),
        ("rotation_vector_of_quaternion", ["q"], "arc_ratio"),
        ("t_handle", ["mass"], "states or constants of the equations of motion"),
        ("t_handle", ["omega", "omega_1"], "each state and constant at most once"),
        ("quaternion_dcm", "q", "a list of names"),
    ],
)
def test_unusable_variables_are_refused_in_one_sentence(kernel, variables, words):
    """Bad input names the place, the expectation and the value."""
    with pytest.raises(InputError, match=words.replace("(", r"\(").replace(")", r"\)")):
        _ = symrot.emit(kernel, jacobian=variables).source


def _scene_program(scene: str, variables: list[str]) -> tuple[Program, list[float]]:
    from symrot.planning.scene_kernel import bind
    from symrot.workshop.kernel_text import scene_text

    text = scene_text(scene, variables)
    return text._lowered.program, bind(text._lowered.parameters, text.plan.constants)


@pytest.mark.thinned(2)
@pytest.mark.parametrize("scene", ["heavy_top_loops", "gravity_gradient_satellite", "damped_disk", "gyrostat"])
def test_derivatives_of_rates_by_all_states_are_complex_steps(scene):
    """The derivatives of a scene's rates with respect to its states equal Im f(y + i h)/h."""
    program, parameters = _scene_program(scene, ["y"])
    (y,) = (a for a in program.signature.arguments if a.name == "y")
    draw = np.random.default_rng(3)
    point = {name: complex(draw.uniform(-1, 1)) for name, *_ in y.components} | {"t": 0.3 + 0j}
    point |= {f"p{k}": complex(value) for k, value in enumerate(parameters)}
    functions = {name: getattr(np, {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}.get(name, name))
                 for name in FLOAT_FUNCTIONS if name != "atan2"}  # fmt: skip
    values = program.evaluate(point, functions)
    for state, *_ in y.components:
        moved = program.evaluate(point | {state: point[state] + 1e-200j}, functions)
        for rate in (name for name in values if BY not in name):
            slope = np.imag(moved[rate]) / 1e-200
            assert abs(values[f"{rate}{BY}{state}"] - slope) <= 1e-13 * (1 + abs(slope)), (rate, state)


@pytest.mark.parametrize(("scene", "constant"), [("heavy_top_loops", "weight"), ("heavy_top_loops", "A"),
                                                 ("tumbling_prism", "B")])  # fmt: skip
def test_derivatives_of_rates_by_constants_are_exact_differences(scene, constant):
    """A derivative with respect to a constant equals a difference quotient of the rates of two scenes."""
    from fractions import Fraction

    from symrot.formula.exact_functions import EXACT_FUNCTIONS
    from symrot.formula.tree import evaluate
    from symrot.workshop.kernel_text import scene_text

    text = scene_text(scene, [constant])
    program, constants, step = text._lowered.program, dict(text.plan.constants), Fraction(1, 10**12)
    (y,) = (a for a in program.signature.arguments if a.name == "y")
    state = {name: Fraction(k + 2, 7) for k, (name, *_) in enumerate(y.components)} | {"t": Fraction(0)}

    def values(shift: Fraction) -> dict[str, Fraction]:
        moved = constants | {constant: constants[constant] + shift}
        parameters = {name: evaluate(node, moved, EXACT_FUNCTIONS, Fraction) for name, node in text._lowered.parameters}
        return program.evaluate(state | parameters, number=Fraction)

    at, above, below = values(Fraction(0)), values(step), values(-step)
    for rate in (name for name in at if BY not in name):
        slope = (above[rate] - below[rate]) / (2 * step)
        assert abs(at[f"{rate}{BY}{constant}"] - slope) <= Fraction(1, 10**9) * (1 + abs(slope))


def test_a_scene_with_derivatives_is_certified():
    """The certificate of a scene states the law that its derivatives are those of the rates."""
    certificate = json.loads(symrot.emit("heavy_top_loops", jacobian=["y", "weight"]).certificate)
    assert certificate["laws"][-1]["law"] == "each derivative is that of the formula of its rate"
    assert certificate["kernel"] == "heavy_top_loops_rates_by_y_by_weight"
