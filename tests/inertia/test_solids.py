"""Mass properties of the solids agree with Cartesian cubature, SymPy's own integrals, limits and published tables."""

import os
import subprocess
import sys
import tomllib
from math import pi
from pathlib import Path

import numpy as np
import pytest
import sympy
from sympy import Rational, Symbol, cancel, integrate, limit, zeros

from symrot import symbols
from symrot.errors import InputError
from symrot.formula.tree import evaluate, parse
from symrot.inertia.closed_forms import CLOSED_FORMS
from symrot.inertia.composite import Part, mass_properties
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import closed_forms_text, solid

EXTENDED = [name for name, shape in SHAPES.items() if shape.kind != "points"]
REFERENCE = Path(__file__).parents[1] / "reference" / "landau_lifshitz_inertia.toml"

# Each shape again, by hand, as a set of points: signed pieces (sign, limits of z, of y at z, of x at y, z).
A, B, C = 1.3, 0.7, 2.1


def revolved(sign, low, high, radius):
    """Return the limits of the part of space within ``radius(z)`` of the z axis."""
    return (
        sign, (low, high), lambda z: (-radius(z), radius(z)),
        lambda y, z: (-np.sqrt(np.maximum(radius(z) ** 2 - y**2, 0)), np.sqrt(np.maximum(radius(z) ** 2 - y**2, 0))),
    )  # fmt: skip


def ball(sign, radius, low=-1):
    return revolved(sign, low * radius, radius, lambda z: np.sqrt(radius**2 - z**2))


def triangle(low, high, base, apex, height):
    """Return limits of x from the left edge to the right edge of the triangle (0, 0), (base, 0), (apex, height)."""
    sides = lambda y, z: (apex * y / height, base + (apex - base) * y / height)  # noqa: E731
    return (1, (low, high), lambda z: (0 * z, height + 0 * z), sides)


ELLIPSE = lambda z: B * np.sqrt(1 - (z / C) ** 2)  # noqa: E731
ELLIPSOID = lambda y, z: A * np.sqrt(np.maximum(1 - (z / C) ** 2 - (y / B) ** 2, 0))  # noqa: E731
CORNERS = [[1, 0, "1/2"], ["23/10", 0, "1/2"], [1, "7/10", "1/2"], [1, 0, "13/5"]]  # legs A, B, C from (1, 0, 1/2)

REGIONS = {
    "box": (
        {"a": "1.3", "b": "0.7", "c": "2.1"},
        [(1, (-C / 2, C / 2), lambda z: (-B / 2 + 0 * z, B / 2 + 0 * z), lambda y, z: (-A / 2, A / 2))],
    ),
    "cylinder": ({"radius": "1.3", "length": "2.1"}, [revolved(1, -C / 2, C / 2, lambda z: A + 0 * z)]),
    "hollow_cylinder": (
        {"inner": "0.7", "outer": "1.3", "length": "2.1"},
        [revolved(1, -C / 2, C / 2, lambda z: A + 0 * z), revolved(-1, -C / 2, C / 2, lambda z: B + 0 * z)],
    ),
    "cone": ({"radius": "1.3", "height": "2.1"}, [revolved(1, 0, C, lambda z: A * (1 - z / C))]),
    "frustum": (
        {"bottom": "1.3", "top": "0.7", "height": "2.1"},
        [revolved(1, 0, C, lambda z: A + (B - A) * z / C)],
    ),
    "sphere": ({"radius": "1.3"}, [ball(1, A)]),
    "hollow_sphere": ({"inner": "0.7", "outer": "1.3"}, [ball(1, A), ball(-1, B)]),
    "hemisphere": ({"radius": "1.3"}, [ball(1, A, low=0)]),
    "ellipsoid": (
        {"a": "1.3", "b": "0.7", "c": "2.1"},
        [(1, (-C, C), lambda z: (-ELLIPSE(z), ELLIPSE(z)), lambda y, z: (-ELLIPSOID(y, z), ELLIPSOID(y, z)))],
    ),
    "torus": (
        {"ring": "2.1", "tube": "0.7"},
        [revolved(s, -B, B, lambda z, s=s: C + s * np.sqrt(B**2 - z**2)) for s in (1, -1)],
    ),
    "triangular_prism": (
        {"base": "1.3", "apex": "-0.2", "height": "0.7", "length": "2.1"},
        [triangle(-C / 2, C / 2, A, -0.2, B)],
    ),
    "tetrahedron": (
        {"vertices": CORNERS},
        [(
            1, (0.5, 0.5 + C), lambda z: (0 * z, B * (1 - (z - 0.5) / C)),
            lambda y, z: (1 + 0 * y, 1 + A * (1 - (z - 0.5) / C - y / B)),
        )],
    ),
    "disk": ({"radius": "1.3"}, [revolved(1, None, None, lambda z: A + 0 * z)]),
    "plate": (
        {"a": "1.3", "b": "0.7"},
        [(1, (None, None), lambda z: (-B / 2 + 0 * z, B / 2 + 0 * z), lambda y, z: (-A / 2, A / 2))],
    ),
    "triangular_plate": ({"base": "1.3", "apex": "-0.2", "height": "0.7"}, [triangle(None, None, A, -0.2, B)]),
}  # fmt: skip

NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def stretched(low, high):
    """Return points and weights of Gauss's rule in t, with x = middle + half sin t, between limits; roots at the ends
    are exact.
    """
    t = NODES * pi / 2
    middle, half = (high + low) / 2, (high - low) / 2
    shape = (*np.shape(middle), 1)
    middle, half = np.reshape(middle, shape), np.reshape(half, shape)
    return middle + half * np.sin(t), half * np.cos(t) * WEIGHTS * pi / 2


def cartesian_points(name):
    """Return points (n, 3) and weights (n,) that integrate smooth functions over a shape, from its Cartesian limits."""
    if name == "rod":
        z, weight = stretched(-C / 2, C / 2)
        return np.stack([0 * z, 0 * z, z], -1), weight
    turn = 2 * pi * np.arange(12) / 12  # twelve equal points integrate polynomials of degree < 12 on a circle exactly
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], -1)
    if name == "ring":
        return A * circle, np.full(12, 2 * pi * A / 12)
    if name == "spherical_shell":  # Archimedes: the area between two planes is that of the cylinder around
        z, weight = stretched(-A, A)
        points = np.sqrt(A**2 - z**2)[:, None, None] * circle + z[:, None, None] * np.array([0, 0, 1])
        return points.reshape(-1, 3), np.repeat(weight * 2 * pi * A / 12, 12)
    pieces = []
    for sign, z_limits, y_limits, x_limits in REGIONS[name][1]:
        z, wz = (np.zeros(1), np.ones(1)) if z_limits[0] is None else stretched(*z_limits)
        y, wy = stretched(*y_limits(z))
        deep = np.broadcast_to(z[:, None], y.shape)
        x, wx = stretched(*(np.broadcast_to(edge, y.shape) for edge in x_limits(y, deep)))
        weight = sign * wx * wy[..., None] * wz[:, None, None]
        points = np.stack(np.broadcast_arrays(x, y[..., None], deep[..., None]), -1)
        pieces.append((points.reshape(-1, 3), weight.ravel()))
    points, weights = zip(*pieces, strict=True)
    return np.concatenate(points), np.concatenate(weights)


SIMPLE = {"rod": {"length": "2.1"}, "ring": {"radius": "1.3"}, "spherical_shell": {"radius": "1.3"}}


def dimensions_of(name):
    return SIMPLE[name] if name in SIMPLE else REGIONS[name][0]


def summed(points, weights):
    """Return the mass, the centre of mass and the inertia about it of weighted points."""
    mass = weights.sum()
    center = weights @ points / mass
    r = points - center
    return mass, center, np.einsum("n,nk,nk", weights, r, r) * np.eye(3) - np.einsum("n,ni,nj->ij", weights, r, r)


def close(body, expected):
    mass, center, inertia = expected
    assert float(body.mass) == pytest.approx(mass, rel=1e-12)
    assert np.allclose(np.array(body.center_of_mass, float).ravel(), center, rtol=1e-12, atol=1e-13)
    size = abs(inertia).max()  # 40 Gauss nodes leave only rounding
    assert np.allclose(np.array(sympy.Matrix(body.inertia).tolist(), float), inertia, rtol=1e-12, atol=1e-13 * size)


@pytest.mark.parametrize("name", EXTENDED)
def test_the_uniform_solid_is_what_cartesian_cubature_finds(name):
    """Cubature with density 3 finds the measure, centre of mass and inertia of the printed closed form."""
    points, weights = cartesian_points(name)
    close(mass_properties([Part(name, dimensions_of(name), density=3)]), summed(points, 3 * weights))


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", EXTENDED)
def test_a_polynomial_density_is_what_cartesian_cubature_finds(name):
    """A density with every kind of term, once without SymPy and once with symbols."""
    text = "5 + x/2 - y*z/3 + z**2 + x*y**2/7 + x**2*y"
    points, weights = cartesian_points(name)
    x, y, z = points.T
    expected = summed(points, weights * (5 + x / 2 - y * z / 3 + z**2 + x * y**2 / 7 + x**2 * y))
    close(mass_properties([Part(name, dimensions_of(name), density=text)]), expected)
    close(solid(name, density=text, **dimensions_of(name)), expected)


@pytest.mark.parametrize("name", EXTENDED)
def test_the_two_exact_paths_agree(name):
    """The closed form and the direct integral of a constant polynomial are equal, with pi replaced by a number to
    2^-300.
    """
    one, other = (mass_properties([Part(name, dimensions_of(name), density=d)]) for d in ("2", "2 + 0*x"))
    pairs = zip([one.mass, *sum(one.inertia, ())], [other.mass, *sum(other.inertia, ())], strict=True)
    assert all(abs(a - b) <= abs(a) / 2**250 for a, b in pairs)


SLOW_FOR_SYMPY = {"tetrahedron"}  # twelve symbols; covered by the affine law below


@pytest.mark.thinned(3)
@pytest.mark.parametrize("name", [name for name in EXTENDED if name not in SLOW_FOR_SYMPY])
def test_sympy_finds_the_same_integrals(name):
    """SymPy integrates the integrand and limits of the printed steps: the measure and one second moment."""
    steps = {step.quantity: step for step in solid(name, density=symbols.rho).steps}
    for quantity in ("measure", "second moment xx", "first moment z"):
        step = steps[quantity]
        assert cancel(sympy.expand(integrate(sympy.expand(step.integrand), *step.limits) - step.value)) == 0


def test_the_steps_reproduce_the_tensor_about_the_origin():
    """I = trace(M) 1 - M for the second moments M of the printed steps; the mass agrees too."""
    cone = solid("cone", density="rho*(1 + z/height)")
    value = {step.quantity: step.value for step in cone.steps}
    second = [[value["second moment " + "".join(sorted(i + j))] for j in "xyz"] for i in "xyz"]
    trace = sum(second[i][i] for i in range(3))
    expected = sympy.eye(3) * trace - sympy.Matrix(second)
    assert (sympy.Matrix(cone.inertia_about((0, 0, 0))) - expected).applyfunc(cancel) == zeros(3)
    assert cancel(value["first moment z"] / value["mass"] - cone.center_of_mass[2]) == 0


@pytest.mark.parametrize("name", EXTENDED)
def test_jacobians_are_positive_inside(name):
    """The Jacobian of each map is positive at an inner point, so that masses are positive."""
    body = solid(name, **dimensions_of(name))
    inside = {c: low + (high - low) * Rational(2, 7) for c, low, high in body.limits}
    assert body.jacobian.subs(inside).evalf() > 0
    assert body.measure.evalf() > 0


def load_reference():
    with REFERENCE.open("rb") as file:
        return {name: entry for name, entry in tomllib.load(file).items() if name != "source"}


@pytest.mark.parametrize(("name", "entry"), load_reference().items())
def test_the_table_of_landau_and_lifshitz(name, entry):
    """Landau & Lifshitz, Mechanics, section 32, problem 2, exactly."""
    known = {n: Symbol(n, positive=True) for n in ("mu", "R", "h", "l", "a", "b", "c")}
    body = solid(name, mass=known["mu"], **{d: known[text] for d, text in entry["dimensions"].items()})
    moments = [
        evaluate(parse(text), known, None, lambda f: Rational(f.numerator, f.denominator)) for text in entry["moments"]
    ]
    assert (body.inertia - sympy.diag(*moments)).applyfunc(cancel) == zeros(3)
    center = evaluate(parse(entry.get("center_of_mass", "0*mu")), known)
    assert cancel(body.center_of_mass[2] - center) == 0


def test_textbook_moments_beyond_that_table():
    """Hemisphere (83/320), torus, hoop, thin shell and thick shell have their standard moments."""
    R, r, m = symbols.R, symbols.r, symbols.m
    assert solid("hemisphere").inertia[0, 0] == Rational(83, 320) * m * R**2
    assert cancel(solid("torus").inertia[2, 2] - m * (R**2 + Rational(3, 4) * r**2)) == 0
    assert cancel(solid("torus").inertia[0, 0] - m * (R**2 / 2 + Rational(5, 8) * r**2)) == 0
    assert solid("ring").inertia[2, 2] == m * R**2
    assert solid("spherical_shell").inertia[0, 0] == Rational(2, 3) * m * R**2
    inner, outer = symbols.R_1, symbols.R_2
    thick = Rational(2, 5) * m * (outer**5 - inner**5) / (outer**3 - inner**3)
    assert cancel(solid("hollow_sphere").inertia[0, 0] - thick) == 0


a, b, c, R, r, h, L = symbols.a, symbols.b, symbols.c, symbols.R, symbols.r, symbols.h, symbols.L
LIMITS = [
    ("frustum", {"bottom": R, "top": 0}, {}, "cone", {}, True),
    ("hollow_cylinder", {"inner": 0, "outer": R}, {}, "cylinder", {}, True),
    ("hollow_sphere", {"inner": 0, "outer": R}, {}, "sphere", {}, True),
    ("ellipsoid", {"a": R, "b": R, "c": R}, {}, "sphere", {}, True),
    ("hollow_sphere", {"inner": r, "outer": R}, {r: R}, "spherical_shell", {}, False),
    ("cylinder", {}, {L: 0}, "disk", {}, False),
    ("hollow_cylinder", {"inner": r, "outer": R}, {r: R, L: 0}, "ring", {}, False),
    ("torus", {}, {r: 0}, "ring", {}, False),
    ("box", {}, {c: 0}, "plate", {}, False),
    ("box", {}, {a: 0, b: 0}, "rod", {"length": c}, False),
    ("cylinder", {}, {R: 0}, "rod", {}, False),
    ("triangular_prism", {}, {L: 0}, "triangular_plate", {}, False),
]


@pytest.mark.parametrize(("name", "dimensions", "toward", "other", "others", "same_measure"), LIMITS)
def test_solids_go_over_into_one_another(name, dimensions, toward, other, others, same_measure):
    """As dimensions vanish or become equal, a solid takes the inertia and centre of mass of another one of equal mass."""
    body, target = solid(name, **dimensions), solid(other, **others)
    inertia = body.inertia
    for symbol, value in toward.items():
        inertia = inertia.applyfunc(lambda entry, s=symbol, v=value: limit(entry, s, v))
    assert (inertia - target.inertia).applyfunc(cancel) == zeros(3)
    assert (body.center_of_mass - target.center_of_mass).applyfunc(cancel) == zeros(3, 1)
    assert not same_measure or cancel(body.measure - target.measure) == 0


def test_a_frustum_of_equal_radii_is_a_cylinder_on_its_end():
    """The inertia is equal; the centre is half the height above the bottom, where the frustum has its origin."""
    body = solid("frustum", bottom=R, top=R, height=L)
    assert (body.inertia - solid("cylinder").inertia).applyfunc(cancel) == zeros(3)
    assert (body.center_of_mass[2], body.measure) == (L / 2, solid("cylinder").measure)


def test_a_flat_cone_is_a_disk_with_the_density_of_its_height():
    """A flat cone has more mass in the middle than a uniform disk: it is a disk of density 1 - s/R."""
    flat = limit(solid("cone").inertia[2, 2], h, 0)
    s = Symbol("s", positive=True)
    weighted = integrate((1 - s / R) * s**3, (s, 0, R)) / integrate((1 - s / R) * s, (s, 0, R))
    assert cancel(flat - symbols.m * weighted) == 0
    assert cancel(flat - solid("disk").inertia[2, 2]) != 0


@pytest.mark.parametrize("name", [n for n in EXTENDED if SHAPES[n].position[2] == "0"])
def test_perpendicular_axes(name):
    """A body in the plane z = 0 has I_zz = I_xx + I_yy about each of its points."""
    for inertia in (solid(name).inertia, solid(name).inertia_about((a, b, 0))):
        assert cancel(inertia[2, 2] - inertia[0, 0] - inertia[1, 1]) == 0


def test_the_shell_is_the_derivative_of_the_ball():
    """dI/dR of a solid sphere of unit density is the inertia of a shell of unit density."""
    ball_inertia, shell = solid("sphere", density=1).inertia[0, 0], solid("spherical_shell", density=1).inertia[0, 0]
    assert cancel(ball_inertia.diff(R) - shell) == 0


def test_a_tetrahedron_follows_its_affine_map():
    """Under x -> T x + d at equal mass, second moments M about the centre of mass become T M T^T, exactly."""
    unit = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    turn = sympy.Matrix([[2, Rational(1, 3), -1], [0, Rational(5, 7), 1], [1, 1, 3]])
    moved = [list(turn * sympy.Matrix(p) + sympy.Matrix([1, -2, Rational(1, 2)])) for p in unit]

    def second(body):
        return sympy.eye(3) * body.inertia.trace() / 2 - body.inertia

    one, other = solid("tetrahedron", vertices=unit, mass=1), solid("tetrahedron", vertices=moved, mass=1)
    assert second(other) == turn * second(one) * turn.T
    assert other.measure == abs(turn.det()) / 6
    swapped = solid("tetrahedron", vertices=[moved[n] for n in (1, 0, 2, 3)], mass=1)
    assert (swapped.inertia, swapped.measure) == (other.inertia, other.measure)


def test_per_mass_and_per_density():
    """A body given by its mass equals the same body given by its density; another mass scales the inertia."""
    rho, m = symbols.rho, symbols.m
    by_density = solid("cylinder", density=rho)
    assert cancel(by_density.mass - sympy.pi * L * R**2 * rho) == 0
    assert by_density.with_mass(m).inertia == solid("cylinder").inertia
    assert cancel(solid("cylinder").density - m / (sympy.pi * L * R**2)) == 0
    assert solid("sphere", radius="1/2", mass="3").inertia[0, 0] == Rational(3, 10)


def test_corners_in_either_order_keep_their_names_in_a_density():
    corners = [[0, 0, 0], [1, 0, 0], [0, 0, 2], [0, 1, 0]]
    for vertices in (corners, corners[::-1]):
        parts = [Part("tetrahedron", {"vertices": vertices}, density="1 + z1 + 2*z2 + 3*z3 + 5*z4 + x*z3")]
        assert solid("tetrahedron", density=parts[0].density, vertices=vertices).mass == mass_properties(parts).mass


def test_another_mass_is_positive_and_that_of_the_points():
    for mass in (-1, 0):
        with pytest.raises(InputError, match="expected a positive mass of the cone"):
            solid("cone").with_mass(mass)
    points = solid("point_masses", masses=[1, 2], points=[[0, 0, 0], [1, 0, 0]]).with_mass(6)
    assert (points.dimensions["masses"], points.density, points.inertia[1, 1]) == ((2, 4), 1, Rational(4, 3))


def test_inertia_about_a_point():
    """A rolling sphere has 7/5 m R^2 about its point of contact."""
    assert solid("sphere").inertia_about((0, 0, R))[0, 0] == Rational(7, 5) * symbols.m * R**2


def test_point_masses():
    """Two masses on a line have the reduced mass times the distance squared, directly and from a scene."""
    first, second, distance = (Symbol(n, positive=True) for n in ("m1", "m2", "d"))
    body = solid("point_masses", masses=[first, second], points=[[0, 0, 0], [0, 0, distance]])
    reduced = first * second / (first + second) * distance**2
    assert (body.inertia - sympy.diag(reduced, reduced, 0)).applyfunc(cancel) == zeros(3)
    scene = mass_properties([Part("point_masses", {"masses": [1, 2], "points": [[0, 0, 0], [0, 0, 3]]})])
    assert scene.inertia == ((6, 0, 0), (0, 6, 0), (0, 0, 0))


def test_the_printed_closed_forms_are_the_derived_ones():
    """They agree byte for byte; `python -m symrot.inertia.solids` prints them."""
    assert CLOSED_FORMS.read_text(encoding="utf-8") == closed_forms_text()


@pytest.mark.campaign
def test_printing_does_not_depend_on_the_hash_seed():
    """The printing command prints the same bytes in a fresh process."""
    command = [sys.executable, "-m", "symrot.inertia.solids"]
    root = str(CLOSED_FORMS.parents[2])
    environment = {**os.environ, "PYTHONHASHSEED": "77", "PYTHONPATH": root}
    printed = subprocess.run(command, capture_output=True, env=environment, cwd=root, check=True).stdout
    assert printed == CLOSED_FORMS.read_bytes()


def test_a_scene_needs_no_sympy_for_its_inertia():
    """Uniform and polynomial densities, composed, with principal axes, in a process without SymPy and NumPy."""
    program = (
        "import sys\n"
        "from symrot.inertia.composite import Part, mass_properties\n"
        "from symrot.inertia.principal import principal_axes\n"
        "parts = [Part('torus', {'ring': 2, 'tube': 1}, density=d, at=(1, 2, 3)) for d in (1, '9 + z')]\n"
        "principal_axes(mass_properties(parts).inertia)\n"
        "print([name for name in ('sympy', 'numpy') if name in sys.modules])\n"
    )
    root = str(CLOSED_FORMS.parents[2])
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=root, check=True)
    assert done.stdout.strip() == "[]"


REFUSED = [
    (("pyramid",), {}, "one of box"),
    (("sphere",), {"radius": 0}, "positive radius"),
    (("sphere",), {"radius": -R}, "positive radius"),
    (("sphere",), {"radius": sympy.nan}, "positive radius"),
    (("sphere",), {"radius": sympy.oo}, "positive radius"),
    (("sphere",), {"radius": "diameter/2"}, "'diameter'"),
    (("sphere",), {"diameter": 1}, "'diameter' is not one of them"),
    (("sphere",), {"mass": 1, "density": 1}, "a mass or a density"),
    (("sphere",), {"mass": -1}, "positive mass"),
    (("sphere",), {"density": -1}, "positive density"),
    (("sphere",), {"density": "x"}, "positive mass"),
    (("sphere",), {"density": "-1 - x**2"}, "positive mass"),
    (("sphere",), {"density": "1/x"}, "polynomial"),
    (("sphere",), {"density": "1/0"}, "polynomial"),
    (("point_masses",), {"masses": [1], "points": [["1/0", 0, 0]]}, "finite coordinates"),
    (("sphere",), {"density": "sin(x)"}, "polynomial"),
    (("sphere",), {"density": "x**13"}, "degree"),
    (("sphere",), {"density": "1" + "+x" * 2000}, "fewer operations"),
    (("hollow_sphere",), {"inner": 2, "outer": 1}, "inner < outer"),
    (("hollow_sphere",), {"inner": R, "outer": R}, "inner < outer"),
    (("torus",), {"ring": 1, "tube": 2}, "tube <= ring"),
    (("tetrahedron",), {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 4, 0]]}, "one plane"),
    (("tetrahedron",), {"vertices": [[0, 0, 0]] * 3}, "4 points"),
    (("point_masses",), {}, "missing"),
    (("point_masses",), {"masses": [1, 2], "points": [[0, 0, 0]]}, "as many masses as points"),
    (("point_masses",), {"masses": [1], "points": [[0, 0, 0]], "density": 2}, "masses"),
]


@pytest.mark.parametrize(("arguments", "keywords", "sentence"), REFUSED)
def test_what_is_no_solid_is_refused_in_one_sentence(arguments, keywords, sentence):
    """The InputError is one line."""
    with pytest.raises(InputError, match=sentence) as refused:
        solid(*arguments, **keywords)
    assert "\n" not in str(refused.value)


def test_the_cubature_would_notice_a_wrong_formula():
    """Cubature tells a cylinder from one whose length is off by one part in 1e9."""
    points, weights = cartesian_points("cylinder")
    wrong = mass_properties([Part("cylinder", {"radius": "1.3", "length": "2.1000000021"}, density=3)])
    with pytest.raises(AssertionError):
        close(wrong, summed(points, 3 * weights))


def test_a_density_that_is_negative_in_a_part_is_refused_as_in_scenes():
    """A box with the density 1 + 3*x had the moments of a body that cannot exist."""
    with pytest.raises(InputError, match=r"negative nowhere in the body, got '3\*x \+ 1' with -2 at x = -1"):
        solid("box", a=2, b=1, c=1, density="1 + 3*x")
    assert solid("box", a=2, b=1, c=1, density="1 + x").mass == 2  # zero at an edge
    assert solid("box", density="1 + 3*x").mass.free_symbols  # whether it is negative depends on the dimensions
