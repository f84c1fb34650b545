"""Composite bodies: parts add up, holes are subtracted, parts are rotated and moved; each bad part is refused in one
sentence.
"""

from fractions import Fraction as F

import pytest
import sympy
from sympy import Matrix, cancel, cos, diag, expand, sin, zeros

from symrot import symbols
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.inertia import tensor
from symrot.inertia.bodies import compose, place
from symrot.inertia.composite import Part, mass_properties
from symrot.inertia.principal import principal_axes
from symrot.inertia.solids import solid

QUARTER_ABOUT_X = ((1, 0, 0), (0, 0, -1), (0, 1, 0))
HALF_ABOUT_X = ((1, 0, 0), (0, -1, 0), (0, 0, -1))


def turn(angle, axis):
    """Return the rotation about a coordinate axis by an angle whose cosine and sine are irrational."""
    c, s = number.cos(F(angle)), number.sin(F(angle))
    rows = [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    order = [(axis - 2 + k) % 3 for k in range(3)]
    back = [order.index(k) for k in range(3)]
    return tensor.matrix([[rows[back[i]][back[j]] for j in range(3)] for i in range(3)])


def agree(one, other):
    """Return whether all entries agree within 2^-250 of the largest one; the numbers may contain pi."""
    flat = [[body.mass, *body.center_of_mass, *sum(body.inertia, ())] for body in (one, other)]
    scale = max(map(abs, flat[0]))
    return all(abs(a - b) * 2**250 <= scale for a, b in zip(*flat, strict=True))


def test_two_halves_make_a_box():
    """The inertia of the halves adds up to the inertia of the box, exactly."""
    halves = [Part("box", {"a": 2, "b": 1, "c": 3}, density="7/3", at=(x, 0, 0)) for x in (-1, 1)]
    assert mass_properties(halves) == mass_properties([Part("box", {"a": 4, "b": 1, "c": 3}, density="7/3")])


def test_two_hemispheres_make_a_sphere():
    """A half turn about x makes the lower hemisphere; the parallel axis theorem refers both to one centre."""
    half = Part("hemisphere", {"radius": "1/2"}, density=2)
    whole = mass_properties([Part("sphere", {"radius": "1/2"}, density=2)])
    assert agree(mass_properties([half, half._replace(rotation=HALF_ABOUT_X)]), whole)


@pytest.mark.parametrize(
    ("solid_part", "hole", "rest"),
    [
        (
            Part("cylinder", {"radius": 3, "length": 5}, density=2),
            Part("cylinder", {"radius": 1, "length": 5}, density=2, subtract=True),
            Part("hollow_cylinder", {"inner": 1, "outer": 3, "length": 5}, density=2),
        ),
        (
            Part("sphere", {"radius": 3}, density=2),
            Part("sphere", {"radius": 1}, density=2, subtract=True),
            Part("hollow_sphere", {"inner": 1, "outer": 3}, density=2),
        ),
        (
            Part("cone", {"radius": 3, "height": 6}, density=2),
            Part("cone", {"radius": 1, "height": 2}, density=2, subtract=True, at=(0, 0, 4)),
            Part("frustum", {"bottom": 3, "top": 1, "height": 4}, density=2),
        ),
    ],
    ids=lambda part: part.shape,
)
def test_a_hole_is_subtracted(solid_part, hole, rest):
    """A solid sphere without its inner sphere has the inertia of the hollow sphere."""
    assert agree(mass_properties([solid_part, hole]), mass_properties([rest]))


def test_triangles_make_a_rectangle_and_a_prism_a_box():
    """Two halves along the diagonal make the body, and their products of inertia cancel."""
    dimensions = {"base": 4, "height": 3, "apex": 0}
    lower = Part("triangular_plate", dimensions, density=1)
    upper = lower._replace(at=(4, 3, 0), rotation=((-1, 0, 0), (0, -1, 0), (0, 0, 1)))
    plate = mass_properties([Part("plate", {"a": 4, "b": 3}, density=1, at=(2, F(3, 2), 0))])
    assert mass_properties([lower, upper]) == plate
    prism = [part._replace(shape="triangular_prism", dimensions={**dimensions, "length": 2}) for part in (lower, upper)]
    box = mass_properties([Part("box", {"a": 4, "b": 3, "c": 2}, density=1, at=(2, F(3, 2), 0))])
    assert mass_properties(prism) == box


def test_six_tetrahedra_fill_a_cube():
    """The Kuhn triangulation has one tetrahedron for each order of the axes; three are right-handed, three left-handed."""
    from itertools import permutations

    def path(order):
        corner, corners = [0, 0, 0], [[0, 0, 0]]
        for axis in order:
            corner = [value + (k == axis) for k, value in enumerate(corner)]
            corners.append(corner)
        return corners

    parts = [Part("tetrahedron", {"vertices": path(order)}, density=5) for order in permutations(range(3))]
    half = F(1, 2)
    cube = Part("box", {"a": 1, "b": 1, "c": 1}, density=5, at=(half, half, half))
    assert mass_properties(parts) == mass_properties([cube])
    varied = [part._replace(density="1 + x*y + z**3") for part in parts]  # the axes of the corners are the cube's
    moved = "1 + (x + 1/2)*(y + 1/2) + (z + 1/2)**3"
    assert mass_properties(varied) == mass_properties([cube._replace(density=moved)])


def test_rotations_compose_and_keep_the_moments():
    """R2 (R1 body) = (R2 R1) body, and rotations leave the principal moments unchanged."""
    body = mass_properties([Part("box", {"a": 1, "b": 2, "c": 3}, mass=12)])
    first, second = turn(1, 2), turn(F(2, 7), 0)
    twice = place(place(body, rotation=first), rotation=second)
    assert agree(twice, place(body, rotation=tensor.multiply(second, first)))
    moments = principal_axes(twice.inertia).moments
    assert all(any(number.equal(moment, F(entry)) for entry in (5, 10, 13)) for moment in moments)


def test_equal_moments_survive_pi_and_irrational_rotations():
    """A cylinder of given density, turned by one radian, is still symmetric; a ball is still spherical."""
    rotation = tensor.multiply(turn(1, 2), turn(2, 0))
    drum = mass_properties([Part("cylinder", {"radius": "1/3", "length": 2}, density=7, rotation=rotation)])
    ball = mass_properties([Part("sphere", {"radius": "1/3"}, density=7, rotation=rotation, at=(1, 2, 3))])
    assert principal_axes(drum.inertia).kind == "symmetric"
    assert principal_axes(ball.inertia).kind == "spherical"


def test_a_very_small_body_is_a_body():
    """Where moments are near the smallest double, the rounding error of an irrational rotation is no fault."""
    grain = Part("cylinder", {"radius": "1e-100", "length": "3e-100"}, mass="1e-100", rotation=turn(1, 0))
    assert principal_axes(mass_properties([grain]).inertia).kind == "symmetric"


def test_a_cross_of_equal_rods_is_symmetric_about_its_normal():
    """Four parts with densities and rotations have exactly equal moments."""
    bar = Part("cylinder", {"radius": "1/10", "length": 1}, density=7800)
    cross = mass_properties([bar._replace(rotation=QUARTER_ABOUT_X), bar])
    body = principal_axes(cross.inertia)
    assert (body.kind, body.symmetry_axis, body.given_axes) == ("symmetric", 0, True)


def test_symbolic_bodies_use_the_same_code():
    """A cone on a hemisphere with symbols: parallel axes and a change of axes act on SymPy matrices too."""
    R, h, rho = symbols.R, symbols.h, symbols.rho
    top, bottom = solid("cone", density=rho), place(solid("hemisphere", density=rho), rotation=Matrix(HALF_ABOUT_X))
    body = compose([top, bottom])
    assert expand(body.mass - sympy.pi * rho * (R**2 * h / 3 + 2 * R**3 / 3)) == 0
    numbers = mass_properties(
        [
            Part("cone", {"radius": 2, "height": 3}, density=5),
            Part("hemisphere", {"radius": 2}, density=5, rotation=HALF_ABOUT_X),
        ]
    )
    values = {R: 2, h: 3, rho: 5}
    for symbolic, exact in zip(sum(body.inertia, ()), sum(numbers.inertia, ()), strict=True):
        assert abs(float(sympy.sympify(symbolic).subs(values)) - float(exact)) <= 1e-14 * float(numbers.inertia[0][0])


def test_parallel_axes_and_rotation_of_a_symbolic_tensor():
    """Both agree with SymPy: with the integral of a rod's second moments, and with R I R^T."""
    m, L, angle = symbols.m, symbols.L, symbols.alpha
    rod = solid("rod")
    assert rod.inertia_about((0, 0, L / 2))[0, 0] == m * L**2 / 3
    dcm = Matrix([[cos(angle), 0, sin(angle)], [0, 1, 0], [-sin(angle), 0, cos(angle)]])
    turned = Matrix(tensor.rotate(rod.inertia, dcm))
    assert (turned - dcm * Matrix(rod.inertia) * dcm.T).applyfunc(expand) == zeros(3)
    offset = symbols.position
    there = tensor.about_point(rod.inertia, m, offset)
    back = Matrix(tensor.about_center_of_mass(there, m, offset))
    assert (back - Matrix(rod.inertia)).applyfunc(cancel) == zeros(3)
    r = Matrix(offset)
    expected = Matrix(rod.inertia) + m * (r.dot(r) * sympy.eye(3) - r * r.T)
    assert (Matrix(there) - expected).applyfunc(expand) == zeros(3)


def test_inertia_about_a_fixed_point_of_a_composite():
    """The Huygens-Steiner theorem holds for numbers, products of inertia included."""
    body = mass_properties([Part("box", {"a": 1, "b": 2, "c": 3}, mass=12, at=(1, 2, 3))])
    assert body.inertia_about((0, 0, 0)) == tensor.add(
        ((13, 0, 0), (0, 10, 0), (0, 0, 5)), ((156, -24, -36), (-24, 120, -72), (-36, -72, 60))
    )


def test_tensor_operations_agree_with_sympy():
    """Product, determinant, cross product and transpose agree on symbols."""
    left, right = (Matrix(3, 3, sympy.symbols(f"{name}:9")) for name in "ab")
    assert (Matrix(tensor.multiply(left, right)) - left * right).applyfunc(expand) == zeros(3)
    assert expand(tensor.determinant(left) - left.det()) == 0
    assert Matrix(tensor.transpose(left)) == left.T
    u, v = left.col(0), right.row(1)
    assert Matrix(tensor.cross(u, v)) == u.cross(v.T)
    for wrong in ([1, 2], diag(1, 2)):
        with pytest.raises(ValueError, match="expected"):
            tensor.matrix(wrong)


BOX = Part("box", {"a": 1, "b": 1, "c": 1}, mass=1)
FLAT = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
REFUSED = [
    ([], "at least one part"),
    ([BOX._replace(mass=None)], "either a mass"),
    ([BOX._replace(density=1)], "either a mass"),
    ([BOX._replace(shape="bax")], "one of box"),
    ([BOX._replace(dimensions={"a": 1, "b": 1})], "'c' is missing"),
    ([BOX._replace(dimensions={"a": 1, "b": 1, "c": 1, "d": 1})], "'d' is not one of them"),
    ([BOX._replace(dimensions={"a": 1, "b": 1, "c": 0})], r"s.toml: body.c: expected a positive number \(side along z"),
    ([BOX._replace(dimensions={"a": 1, "b": 1, "c": "1 m"})], "body.c: .* without a unit"),
    ([BOX._replace(dimensions={"a": 1, "b": 1, "c": float("nan")})], "body.c: .*not finite"),
    ([BOX._replace(dimensions={"a": "1e200", "b": "1e200", "c": 1})], "range of a double"),
    ([BOX._replace(mass=0)], "body.mass: expected a positive number"),
    ([BOX._replace(mass=None, density=0)], "body.density: expected a positive number"),
    ([BOX._replace(mass=None, density="x")], "positive mass"),
    ([BOX._replace(mass=None, density="1 + 3*x")], "negative nowhere in the body"),
    ([BOX._replace(mass=None, density="1 + w")], "'w' is not one of"),
    ([BOX._replace(mass=None, density="1/x")], "expected a number as the divisor"),
    ([BOX._replace(mass=None, density="sin(x)")], "calls sin"),
    ([BOX._replace(mass=None, density="x**64")], "degree"),
    ([BOX._replace(mass=None, density="((x**64)**64)**64")], "degree"),
    ([BOX._replace(mass=None, density="1/0")], "division by zero"),
    ([BOX._replace(mass=None, density="(1 + z")], "body.density: expected '\\)'"),
    ([BOX._replace(mass=None, density="1 - 18/5*(x**2 + y**2 + z**2)")], "negative nowhere"),
    ([BOX._replace(at=(0, 1))], "at = "),
    ([BOX._replace(rotation=((1, 0, 0), (0, 1, 0)))], "3x3 rotation"),
    ([BOX._replace(rotation=((1, 0, 0), (0, 1, 0), (0, 0, -1)))], "body.rotation: expected a right-handed"),
    ([BOX._replace(rotation=((1, 0, 0), (0, 2, 0), (0, 0, 1)))], "body.rotation: expected a right-handed"),
    ([BOX, BOX._replace(mass=2, subtract=True)], "positive total mass, got -1 kg"),
    ([BOX, BOX._replace(subtract=True)], "positive total mass, got 0 kg"),
    ([BOX._replace(subtract=True)], "positive total mass"),
    (
        [BOX._replace(mass=3), BOX._replace(mass=2, dimensions={"a": 9, "b": 1, "c": 1}, subtract=True)],
        "principal moments of inertia that are not negative",
    ),
    (
        [BOX._replace(mass=3), BOX._replace(mass=1, dimensions={"a": 2, "b": "1/9", "c": "1/9"}, subtract=True)],
        "exceeds the sum of the other two",
    ),
    ([BOX, BOX._replace(mass="heavy")], r"s.toml: body\[1\].mass"),
    ([Part("hollow_sphere", {"inner": 2, "outer": 1}, mass=1)], "inner < outer"),
    ([Part("torus", {"ring": 1, "tube": 2}, mass=1)], "tube <= ring"),
    ([Part("tetrahedron", {"vertices": FLAT}, mass=1)], "one plane"),
    ([Part("tetrahedron", {"vertices": FLAT}, density="1 + x")], "one plane"),
    ([Part("tetrahedron", {"vertices": FLAT[:3]}, mass=1)], "list of 4"),
    ([Part("sphere", {"radius": 1}, density="1" + "+x" * 2000)], "too many operations"),
    ([Part("sphere", {"radius": "1e40"}, density="x**12")], "range of a double"),
    ([Part("tetrahedron", {"vertices": [*FLAT[:3], [1, 1]]}, mass=1)], r"vertices\[3\]: expected a point"),
    ([Part("tetrahedron", {"vertices": "corners"}, mass=1)], "list of 4"),
    ([Part("point_masses", {"masses": [1, 2], "points": [[0, 0, 0]]})], "as many masses as points"),
    ([Part("point_masses", {"masses": [1, -2], "points": FLAT[:2]})], r"masses\[1\]: expected a positive number"),
    ([Part("point_masses", {"masses": [], "points": []})], "at least one entry"),
    ([Part("point_masses", {"masses": [1], "points": [[0, 0, 0]]}, mass=1)], "no mass or density"),
]


@pytest.mark.parametrize(("parts", "sentence"), REFUSED)
def test_what_is_no_body_is_refused_in_one_sentence(parts, sentence):
    """An InputError of one line begins with the place in the scene."""
    with pytest.raises(InputError, match=sentence) as refused:
        mass_properties(parts, "s.toml: body")
    assert str(refused.value).startswith("s.toml: body")
    assert "\n" not in str(refused.value)
