"""Principal axes, rates and differences of many bodies in C have the bits that exact fractions give, or the body is
marked.
"""

import subprocess
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest

import symrot
from symrot.build.cache import compiler
from symrot.closed_form import build as library
from symrot.closed_form.arithmetic.pairs import quotient
from symrot.closed_form.free_body import bodies
from symrot.closed_form.free_body.motion import Defect, FreeRigidBody
from symrot.inertia.principal import principal_axes
from symrot.propagation.propagate import propagator
from tests.propagation.test_changed_start import SCENES

N = 24
RANDOM = np.random.default_rng(7)
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def tensors(moments, scale=1.0):
    """Return bodies with these moments of inertia, in axes of any direction, as columns xx, yy, zz, xy, xz, yz."""
    axes = np.linalg.qr(RANDOM.standard_normal((len(moments), 3, 3)))[0]
    full = scale * np.einsum("nik,nk,njk->nij", axes, moments, axes)
    return np.column_stack([full[:, i, j] for i, j in PLACES])


def with_products(products):
    return np.column_stack([[3.0, 4.0, 5.0] + 0.1 * RANDOM.standard_normal((N, 3)), products])


MOMENTS = RANDOM.uniform(2.0, 3.9, (N, 3))
SMALL = 0.1 * RANDOM.standard_normal((N, 3))
BODIES = {
    "any": tensors(MOMENTS),
    "small products": with_products(SMALL),
    "one product": with_products(SMALL * [0, 1, 0]),
    "two products": with_products(SMALL * [1, 0, 1]),
    "moments 1e-12 apart": tensors(MOMENTS[:, [0, 0, 1]] * [1, 1 + 1e-12, 1]),
    "two equal moments, rounded": tensors(MOMENTS[:, [0, 0, 1]]),
    "three equal moments, rounded": tensors(MOMENTS[:, [0, 0, 0]]),
    "two equal moments": np.tile([7.0, 7.0, 7.0, 1.0, 1.0, 1.0], (N, 1)),
    "needles": tensors(MOMENTS[:, [0, 0, 0]] * [1, 1, 1e-9]),
    "needles, 1e-14": tensors(MOMENTS[:, [0, 0, 0]] * [1, 1 + 1e-5, 1e-14]),
    "rational moments": np.tile([2.0, 2.0, 3.0, -1.0, 0.0, 0.0], (N, 1)),
    "integers": np.round(tensors(8 * MOMENTS)),
    "products down to 1e-60": with_products(SMALL * 10.0 ** RANDOM.uniform(-60, 0, (N, 1))),
    "huge": tensors(MOMENTS, 1e150),
    "tiny": tensors(MOMENTS, 1e-150),
}
CLEAR = {"any", "small products", "one product", "two products", "moments 1e-12 apart", "needles", "huge", "tiny"}
"""Bodies none of which needs fractions."""


def rates():
    found = RANDOM.standard_normal((N, 3)) * 10.0 ** RANDOM.choice([0, 0, -9, 100, -100], (N, 1))
    found[::5, 1] = 0.0
    found[1::5, :2] = 0.0
    found[2] = 0.0
    found[3] *= [1, 1e-30, 1]
    return found


def of_fractions(columns, omega):
    """Return the same quantities from the exact computation for a single motion."""
    xx, yy, zz, xy, xz, yz = map(Fraction, columns.tolist())
    body = FreeRigidBody(principal_axes([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
    integers, shared = body.along(omega.tolist())
    along = [part for x in integers for part in quotient(x, shared)]
    return body.moments, along, [*body.gaps, *body.defect(integers)], body.axes


@pytest.mark.parametrize("name", BODIES)
def test_bodies_have_the_bits_of_fractions_or_are_marked(name):
    columns, omega = BODIES[name], rates()
    found = bodies.principal_bodies(list(columns.T), omega)
    clear = sorted({*range(N)} - {*found.doubtful.tolist()})
    if name in CLEAR:  # but one that is at rest about an axis to 1e-30, where digits are lost
        assert len(clear) >= N - 1
    for i in clear:
        for own, each in zip(of_fractions(columns[i], omega[i]), found[:4], strict=True):
            assert list(own) == each[i].tolist(), i


def test_what_doubles_and_248_bits_cannot_tell_is_marked():
    """Examples are equal moments, rational moments whose last digits are ties, and negligible products."""
    for name in ("two equal moments", "rational moments"):
        assert len(bodies.principal_bodies(list(BODIES[name].T), rates()).doubtful) == N
    given = [np.array([x]) for x in (3.0, 4.0, 5.0, 1e-70, 0.0, 1e-300)]
    assert bodies.principal_bodies(given, np.ones((1, 3))).doubtful.tolist() == [0]
    none = [np.array([x]) for x in (3.0, 4.0, 5.0, 0.0, 0.0, 0.0)]
    assert bodies.principal_bodies(none, np.ones((1, 3))).doubtful.tolist() == [0]
    far = [np.array([x]) for x in (3.0, 4.0, 5.0, 0.1, 0.0, 0.2)]
    for omega in ([5e-324, 0, 0], [1e300, 1.0, 0.0], [1.0, 1e-100, 0.0]):
        assert bodies.principal_bodies(far, np.array([omega])).doubtful.tolist() == [0]
    assert bodies.principal_bodies([Fraction(10) ** 210, *far[1:]], np.ones((1, 3))) is None


@pytest.mark.parametrize("name", ["any", "moments 1e-12 apart", "needles", "huge", "tiny", "one product"])
def test_moments_are_those_of_mpmath(name):
    """mpmath uses another algorithm and 50 digits."""
    columns = BODIES[name]
    found = bodies.principal_bodies(list(columns.T), np.ones((N, 3)))
    with mpmath.workdps(50):
        for i in sorted({*range(N)} - {*found.doubtful.tolist()}):
            full = mpmath.matrix(3)
            for (j, k), value in zip(PLACES, columns[i], strict=True):
                full[j, k] = full[k, j] = mpmath.mpf(float(value))
            true = sorted(mpmath.eigsy(full, eigvals_only=True))
            pairs = found.moments[i].reshape(3, 2).tolist()
            own = sorted(mpmath.mpf(high) + mpmath.mpf(low) for high, low in pairs)
            for one, other in zip(own, true, strict=True):
                assert abs(one - other) <= mpmath.mpf(10) ** -31 * other + mpmath.mpf(10) ** -47 * true[-1]


def test_constants_that_all_share_are_fractions():
    """They need not be doubles: 1/7 kg m^2 stays 1/7."""
    shared = [Fraction(3), Fraction(4), Fraction(5), Fraction(-1, 10), Fraction(1, 7)]
    varied, omega = 0.1 + 0.1 * RANDOM.random(N), RANDOM.standard_normal((N, 3))
    found = bodies.principal_bodies([*shared, varied], omega)
    assert found.doubtful.tolist() == []
    for i in range(N):
        xx, yy, zz, xy, xz = shared
        yz = Fraction(float(varied[i]))
        body = FreeRigidBody(principal_axes([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]))
        assert body.moments == found.moments[i].tolist() and body.axes == found.axes[i].tolist()


def test_defects_of_given_moments_have_the_bits_of_integers():
    """This holds near the separatrix too, where digits cancel; if all digits cancel, the body is marked."""
    moments = 1 + RANDOM.random((400, 3))
    omega = RANDOM.standard_normal((400, 3))
    small, middle, large = np.sort(moments, axis=1).T
    moments[:200] = np.column_stack([small, middle, large])[:200]
    ratio = small * (middle - small) / (large * (large - middle))
    omega[:200, 2] = omega[:200, 0] * np.sqrt(ratio[:200])  # on it but for rounding
    moments[5], omega[5] = [1.0, 2.0, 3.0], [3.0, 1.0, 1.0]
    moments[6], omega[6] = [6.0, 4.0, 3.0], [1.0, 5.0, 2.0]  # exactly on it
    found, doubtful = bodies.defects(moments, omega)
    assert 6 in doubtful.tolist() and len(doubtful) <= 3
    for i in sorted({*range(400)} - {*doubtful.tolist()}):
        ratios = [Fraction(x) for x in (*moments[i].tolist(), *omega[i].tolist())]
        shared = max(x.denominator for x in ratios)
        integers = [int(x * shared) for x in ratios]
        assert Defect(integers[:3])(integers[3:]) == tuple(found[i].tolist()), i


@pytest.mark.parametrize(
    "name", ["small products", "moments 1e-12 apart", "integers", "needles", "products down to 1e-60"]
)
def test_an_ensemble_of_tensors_has_the_bits_of_its_motions(name):
    """Marked bodies are computed one by one, all others in arrays."""
    columns, omega, times = BODIES[name], RANDOM.standard_normal((N, 3)), np.array([0.0, 0.7, 1e3, -2.5])
    names = ("I_xx", "I_yy", "I_zz", "I_xy", "I_xz", "I_yz")
    given = dict(zip(names, np.ascontiguousarray(columns.T), strict=True))
    found = symrot.propagate_ensemble(SCENES["tilted"], omega=omega, parameters=given, t=times, method="exact")
    variation = symrot.ensemble.reading.read_variation(SCENES["tilted"], omega, None, given)
    for i in range(N):
        own = propagator(variation.scene_of(i), "exact")(times)
        assert found.omega[i].tobytes() == own.y[:3].T.tobytes(), i
        assert found.quaternion[i].tobytes() == own.y[3:].T.tobytes(), i


PRODUCTS = r"""
#include "fixed_point.h"
#include <stdio.h>

int main(void)
{
    const double x[] = {0.75, -0.1, 1.0, -1.0, 0.0, 3e-20, 7.5, -0x1.fffffffffffffp-1, 0x1p-60, 1.1};
    for (int i = 0; i < 10; ++i)
        for (int j = 0; j < 10; ++j) {
            fixed a = fixed_of(x[i]), b = fixed_of(x[j]);
            a = fixed_add(a, fixed_mul(b, fixed_of(0x1.3456789abcdefp-70)));
            const fixed results[] = {fixed_mul(a, b), fixed_add(a, b), fixed_sub(a, b), fixed_half(a)};
            for (int k = 0; k < 4; ++k) {
                for (int limb = 3; limb >= 0; --limb)
                    printf("%016llx", (unsigned long long)results[k].limb[limb]);
                printf(" ");
            }
            printf("\n");
        }
    return 0;
}
"""


@pytest.mark.parametrize("options", [[], ["-U__SIZEOF_INT128__"]])
def test_fixed_point_is_that_of_integers_with_and_without_integers_of_128_bits(options, tmp_path):
    (tmp_path / "products.c").write_text(PRODUCTS, encoding="utf-8")
    headers = Path(library.__file__).parent / "arithmetic"
    flags = [flag for flag in library.FLAGS if flag not in ("-shared", "-fPIC")]
    command = [*compiler().command, *flags, "-O2", "-I", str(headers), *options, "products.c", "-o", "products", "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True)
    lines = subprocess.run([tmp_path / "products"], check=True, capture_output=True, text=True).stdout.splitlines()
    values = [0.75, -0.1, 1.0, -1.0, 0.0, 3e-20, 7.5, -float.fromhex("0x1.fffffffffffffp-1"), 2.0**-60, 1.1]
    unit, tiny = 1 << bodies.FRACTION, Fraction(float.fromhex("0x1.3456789abcdefp-70"))
    for line, (one, other) in zip(lines, ((x, y) for x in values for y in values), strict=True):
        b = Fraction(other) * unit
        a = Fraction(one) * unit + b * tiny
        true = (a * b / unit, a + b, a - b, a / 2)
        for text, exact in zip(line.split(), true, strict=True):
            raw = int(text, 16)
            assert abs(raw - (raw >> 255 << 256) - exact) <= (8 + 2 if exact is true[0] else 2)
