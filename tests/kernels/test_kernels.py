"""The library of kernels: each obeys its laws, agrees with other libraries, and stays accurate at removable
singularities.
"""

import importlib.util
from pathlib import Path

import mpmath
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sympy import Symbol, lambdify

import symrot
from symrot.codegen.library_kernels import kernel_program
from symrot.errors import InputError
from symrot.kernels.library import definition, kernel_names
from symrot.kernels.removable import REMOVABLE

GENERATED = Path(__file__).parents[2] / "generated"
RNG = np.random.default_rng(11)


def module(name):
    spec = importlib.util.spec_from_file_location(name, GENERATED / "numpy" / f"{name}.py")
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


def computed(name, *arguments):
    return getattr(module(name), name)(*arguments)


def sample(found, count):
    """Return inputs in the box of a kernel, one array per component: unit quaternions, and matrices that are rotations."""
    values = {key: RNG.uniform(float(low), float(high), count) for key, (low, high) in found.box.items()}
    for letter in "qp":
        names = [f"{letter}{i}" for i in range(4)]
        if values.keys() >= set(names):
            norm = np.sqrt(sum(values[name] ** 2 for name in names))
            values |= {name: values[name] / norm for name in names}
    if "R_11" in values:
        matrix = Rotation.random(count, random_state=5).as_matrix()
        values |= {f"R_{i + 1}{j + 1}": matrix[:, i, j] for i in range(3) for j in range(3)}
    return values


def arguments(found, values):
    return [
        values[a.components[0][0]] if a.is_scalar else np.array([values[name] for name, *_ in a.components])
        for a in found.inputs
    ]


@pytest.mark.thinned(6)  # certificates prove the same laws for all kernels
@pytest.mark.parametrize("name", kernel_names())
def test_every_kernel_obeys_its_laws(name):
    """At random points of the box, each expression that vanishes by a law is as small as rounding."""
    found = definition(name)
    values = sample(found, 40)
    results = computed(name, *arguments(found, values))
    results = results if isinstance(results, tuple) else (results,)
    for (target, _), rows in zip(found.results, results, strict=True):
        values |= {component: row for (component, *_), row in zip(target.components, rows, strict=True)}
    laws = found.laws()
    assert laws
    for law in laws:
        names = sorted({str(s) for entry in law.vanishing for s in entry.free_symbols})
        evaluated = lambdify(names, list(law.vanishing), "numpy")(*(values[name] for name in names))
        worst = max(np.max(np.abs(entry)) for entry in evaluated)
        scale = max(1.0, *(np.max(np.abs(values[name])) for name in names)) if names else 1.0
        assert worst <= 2e-13 * scale**4, (law.text, worst)


@pytest.mark.parametrize("sequence", symrot.SEQUENCES)
def test_euler_kernels_agree_with_scipy(sequence):
    prefix = f"euler_{sequence.lower()}" if sequence.isupper() else f"euler_extrinsic_{sequence}"
    proper = sequence[0] == sequence[2]
    angles = RNG.uniform(-3.1, 3.1, (3, 50))
    angles[1] = RNG.uniform(0.1, 3.0, 50) if proper else RNG.uniform(-1.5, 1.5, 50)
    reference = Rotation.from_euler(sequence, angles.T)
    matrix = computed(f"{prefix}_dcm", angles).T.reshape(-1, 3, 3)
    assert np.max(np.abs(matrix - reference.as_matrix())) < 2e-15
    q = computed(f"{prefix}_quaternion", angles)
    expected = reference.as_quat(scalar_first=True).T
    assert np.max(np.abs(np.abs(np.sum(q * expected, axis=0)) - 1)) < 1e-15
    assert np.max(np.abs(computed(f"{prefix}_of_quaternion", q) - angles)) < 2e-14


def test_the_quaternion_of_a_dcm_is_safe_in_every_branch():
    for pivot in range(4):
        q = RNG.normal(scale=1e-9, size=(4, 30))
        q[pivot] += 1
        q /= np.linalg.norm(q, axis=0)
        back = computed("quaternion_of_dcm", computed("quaternion_dcm", q))
        assert np.max(np.abs(back * np.sign(np.sum(back * q, axis=0)) - q)) < 1e-15


@pytest.mark.parametrize("size", [0.0, 1e-320, 1e-200, 1e-160, 1e-20, 1e-8, 1e-3, 1.0, 3.0, 3.1415926])
def test_rotation_vectors_are_safe_at_zero_and_at_pi(size):
    axis = np.array([2.0, -1.0, 2.0]) / 3
    v = size * axis
    q = computed("rotation_vector_quaternion", v)
    with mpmath.workdps(50):
        angle = mpmath.mpf(size)
        half = [mpmath.cos(angle / 2), *(mpmath.sin(angle / 2) * mpmath.mpf(float(n)) for n in axis)]
        assert max(abs(a - b) for a, b in zip(q, half, strict=True)) < 4e-16
    back = computed("rotation_vector_of_quaternion", q)
    assert np.all(np.isfinite(back))
    assert np.max(np.abs(back - v)) <= 8e-16 * max(size, 5e-324 / 1e-16)
    for frame in ("body", "space"):
        jacobian = computed(f"rotation_vector_{frame}_jacobian", v).reshape(3, 3)
        rates = np.column_stack([computed(f"rotation_vector_{frame}_rates", v, e) for e in np.eye(3)])
        assert np.max(np.abs(jacobian @ rates - np.eye(3))) < 2e-15


@pytest.mark.parametrize("name", REMOVABLE)
def test_removable_singularities_lose_four_ulp_at_most(name):
    """Compare with 40 digits near the point where the series takes over, and down to the smallest numbers."""
    which = REMOVABLE[name]
    kernel = {"sine_gap": "body_jacobian", "tangent_gap": "body_rates", "sine_bend": "body_jacobian_by_v",
              "tangent_bend": "body_rates_by_v"}[name]  # fmt: skip
    room = {}
    exec(symrot.emit(f"rotation_vector_{kernel}", "numpy").source, room)
    function, x = room[f"_{name}"], Symbol("x", real=True)
    quotient = lambdify(x, which.formula(x), "mpmath")
    split = float(which.split) ** 0.5
    points = np.concatenate(
        [np.linspace(1e-3, np.pi, 400), split + np.linspace(-1e-3, 1e-3, 101), 10.0 ** -np.arange(1, 300, 7)]
    )
    with mpmath.workdps(400):
        for x in points:
            first = which.coefficients()[0]
            exact = quotient(mpmath.mpf(x)) if x > 1e-60 else mpmath.mpf(first.numerator) / first.denominator
            value = float(function(np.float64(x)))
            assert abs(mpmath.mpf(value) - exact) <= 4 * np.spacing(abs(value)), x


BY_HAND = {  # multiplications, additions, divisions of the best formulas known
    "quaternion_dcm": (12, 11, 0), "quaternion_product": (16, 12, 0), "quaternion_to_space": (18, 12, 0),
    "quaternion_body_rates": (15, 8, 0), "quaternion_space_rates": (15, 8, 0), "rodrigues_dcm": (12, 14, 1),
    "mrp_dcm": (18, 15, 1), "rodrigues_body_rates": (15, 11, 0), "mrp_body_rates": (22, 14, 0),
    "inertia_parallel_axis": (9, 9, 0), "inertia_rotated": (57, 41, 0), "angular_momentum_space": (27, 18, 0),
    "euler_equations_tensor": (42, 26, 1), "rigid_body_tensor": (57, 34, 1), "rigid_body_principal": (21, 14, 3),
    "heavy_top": (37, 21, 3), "heavy_top_symmetric": (28, 13, 1), "torque_constant_space": (18, 12, 0),
    "torque_gravity": (27, 15, 0),
}  # fmt: skip


@pytest.mark.parametrize("name", BY_HAND)
def test_operations_are_no_more_than_by_hand(name):
    """Hand counts: dcm by doubled components, rates by half the angular velocity, tensor by cofactors."""
    counts = kernel_program(name).operations()
    assert all(counts[kind] <= most for kind, most in zip(("mul", "add", "div"), BY_HAND[name], strict=True)), counts


@pytest.mark.parametrize("sequence", symrot.SEQUENCES)
def test_euler_kernels_compute_no_more_than_by_hand(sequence):
    prefix = f"euler_{sequence.lower()}" if sequence.isupper() else f"euler_extrinsic_{sequence}"
    proper = sequence[0] == sequence[2]
    most = {"dcm": (12, 4, 0), "body_rates": (5, 3, 1), "space_rates": (5, 3, 1), "quaternion": (11 if proper else 15, 4, 0)}  # fmt: skip
    for suffix, allowed in most.items():
        counts = kernel_program(f"{prefix}_{suffix}").operations()
        assert all(counts[kind] <= allowed[i] for i, kind in enumerate(("mul", "add", "div"))), (suffix, counts)


def test_an_unknown_kernel_is_refused():
    with pytest.raises(InputError, match="quaternion_dcmm"):
        definition("quaternion_dcmm")
    with pytest.raises(InputError):
        symrot.emit("quaternion_dcmm")
