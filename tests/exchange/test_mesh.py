"""Mass properties of polyhedra: exact sums of fractions, closed forms of solids, laws of translation and rotation."""

from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np
import pytest

import symrot
from symrot.errors import InputError
from symrot.exchange.mesh import polyhedron
from symrot.exchange.surface import Surface, merge
from symrot.exchange.volume_moments import approximate_moments, exact_moments, exponents
from symrot.inertia.bodies import compose, place
from tests.exchange.polyhedra import box, exact_sums, joined, octahedron, refined, revolved, rotated, sphere

F = Fraction


def body(surface, mass=None, density=None, unit=1):
    return polyhedron(surface, "part", "part", mass, density, F(unit))


def moved(surface, offset):
    return Surface(surface.vertices + np.array(offset, dtype=float), surface.triangles)


def floats(tensor):
    return np.array(tensor, dtype=float)


# --- integrals --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "surface", [box((2, 3, 0.5), (1, -7, 0.1)), rotated(sphere(2))[0], moved(octahedron(), (1e6, 0, 1e-9))]
)
def test_integrals_are_the_sums_of_the_textbook_formula(surface):
    volume, first, second = exact_sums(surface)
    exact = exact_moments(surface, 2)
    center = exact.center
    assert exact.values[0, 0, 0] == volume
    for axis in range(3):
        unit = tuple(int(axis == k) for k in range(3))
        assert exact.values[unit] == first[axis] - center[axis] * volume
    for (i, j), value in second.items():
        powers = tuple((i == k) + (j == k) for k in range(3))
        assert (
            exact.values[powers] == value - center[i] * first[j] - center[j] * first[i] + center[i] * center[j] * volume
        )


def test_a_power_of_a_coordinate_over_the_unit_box():
    """The integral of x^l from -c to 1 - c is ((1-c)^(l+1) - (-c)^(l+1))/(l+1)."""
    moments = exact_moments(box(), 6)
    for powers in exponents(6):
        expected = F(1)
        for power, c in zip(powers, moments.center, strict=True):
            expected *= ((1 - c) ** (power + 1) - (-c) ** (power + 1)) / (power + 1)
        assert moments.values[powers] == expected


@pytest.mark.parametrize("surface", [
    rotated(sphere(3))[0],
    moved(rotated(refined(refined(box((3, 2, 1)))))[0], (1e8, -1e8, 3e7)),
    rotated(box((1, 1, 1e-9)))[0],
    joined(sphere(3), Surface(sphere(3).vertices * (1 - 1e-6), sphere(3).flipped().triangles)),
    Surface(sphere(2).vertices * 1e-25, sphere(2).triangles),
])  # fmt: skip
def test_the_bound_of_integrals_in_doubles_holds(surface):
    exact, doubles = exact_moments(surface, 4), approximate_moments(surface, 4)
    shift = [a - b for a, b in zip(doubles.center, exact.center, strict=True)]
    assert abs(exact.values[0, 0, 0] - doubles.values[0, 0, 0]) <= doubles.errors[0, 0, 0]
    for axis in range(3):
        unit = tuple(int(axis == k) for k in range(3))
        expected = exact.values[unit] - shift[axis] * exact.values[0, 0, 0]
        assert abs(expected - doubles.values[unit]) <= doubles.errors[unit]
        square = tuple(2 * k for k in unit)
        expected = (
            exact.values[square] - 2 * shift[axis] * exact.values[unit] + shift[axis] ** 2 * exact.values[0, 0, 0]
        )
        assert abs(expected - doubles.values[square]) <= doubles.errors[square]


def test_a_large_mesh_far_from_the_origin_is_right_to_1e_12():
    surface = box((3, 2, 1), (1e6, -1e6, 5e5))
    for _ in range(6):
        surface = refined(surface)
    assert len(surface.triangles) == 12 * 4**6
    result = body(surface, density=2)
    assert 0 < result.error <= 1e-12
    assert abs(result.mass / 12 - 1) <= 1e-12
    expected = np.array([F(12, 12) * x for x in (2**2 + 1, 3**2 + 1, 3**2 + 2**2)], dtype=float)
    assert floats(result.inertia) == pytest.approx(np.diag(expected), abs=1e-12 * 13)
    assert [float(x) for x in result.center_of_mass] == pytest.approx([1e6 + 1.5, -1e6 + 1, 5e5 + 0.5], rel=1e-15)


def test_a_thin_wall_whose_terms_cancel_is_computed_exactly():
    """The volume is a millionth of the terms of its sum, so doubles do not reach 1e-12."""
    outer = sphere(6)
    surface = joined(outer, Surface(outer.vertices * (1 - 2.0**-36), outer.flipped().triangles))
    result = body(surface, mass=1)
    assert result.error == 0
    assert float(result.volume) == pytest.approx(
        3 * 2.0**-36 * float(exact_moments(outer, 0).values[0, 0, 0]), rel=1e-9
    )


def test_a_large_mesh_whose_terms_cancel_is_refused(monkeypatch):
    from symrot.exchange import mesh

    monkeypatch.setattr(mesh, "MOST_EXACT", 10)
    monkeypatch.setattr(mesh, "LARGEST_WORK", 20)
    outer = sphere(1)
    wall = joined(outer, Surface(outer.vertices * (1 - 2.0**-36), outer.flipped().triangles))
    with pytest.raises(InputError, match="because large terms cancel; reduce the number of triangles from 64"):
        body(wall, mass=1)
    with pytest.raises(InputError, match=r"turned inside out, with a volume of -1 m\^3"):
        body(box().flipped(), mass=1)
    assert body(box(), mass=6).error > 0


# --- laws -------------------------------------------------------------------------------------------------------------


def test_a_box_has_the_tensor_of_the_solid():
    result = body(box((2, 3, 4), (1, 1, 1)), mass=12)
    assert result.inertia == ((25, 0, 0), (0, 20, 0), (0, 0, 13))
    assert result.center_of_mass == (2, F(5, 2), 3)
    assert result.volume == 24 and result.error == 0


def test_translation_moves_the_centre_alone():
    surface = rotated(sphere(1))[0]
    rounded = Surface(np.round(surface.vertices * 1024), surface.triangles)  # so that the sum has no rounding error
    one, two = body(rounded, density=1), body(moved(rounded, (5, -2, 2048)), density=1)
    assert one.inertia == two.inertia and one.mass == two.mass
    assert [b - a for a, b in zip(one.center_of_mass, two.center_of_mass, strict=True)] == [5, -2, 2048]


def test_rotation_rotates_the_tensor():
    surface, matrix = rotated(box((1, 2, 3)))
    assert floats(body(surface, mass=1).inertia) == pytest.approx(
        matrix @ floats(body(box((1, 2, 3)), mass=1).inertia) @ matrix.T
    )


def test_a_length_scales_the_mass_by_its_cube_and_the_tensor_by_its_fifth_power():
    metres, millimetres = body(octahedron(), density=7), body(octahedron(), density=7, unit=F(1, 1000))
    assert millimetres.mass == metres.mass / 1000**3
    assert millimetres.inertia[0][0] == metres.inertia[0][0] / 1000**5


def test_shells_add_and_cavities_subtract():
    one, two = box((1, 1, 1)), box((1, 2, 1), (5, 0, 0))
    whole = body(joined(one, two), density=3)
    assert whole.properties == compose([body(one, density=3).properties, body(two, density=3).properties])
    outer, inner = box((4, 4, 4)), box((1, 1, 2), (1, 1, 1))
    hollow = body(joined(outer, inner.flipped()), density=3)
    assert hollow.properties == compose([body(outer, density=3).properties], [body(inner, density=3).properties])


def test_a_polynomial_density_on_a_box_is_that_of_the_shape():
    """symrot's own solids integrate over a map of coordinates: another method."""
    scene = {"initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 1]}}
    density = "3 + x**2 - x*y/4 + y*z**2/8 + x**3/16"
    shape = symrot.Scene.build(body={"shape": "box", "a": 2, "b": 3, "c": 4, "density": density}, **scene).body
    result = body(box((2, 3, 4), (-1, -1.5, -2)), density=density)
    assert (result.mass, result.inertia) == (shape.mass, shape.inertia)


def test_a_polynomial_density_is_measured_in_metres_of_the_file():
    """A density of x over a box from x = 2 m to 3 m has the mass 5/2, in any unit and at any place."""
    assert body(box((1, 1, 1), (2, 0, 0)), density="x").mass == F(5, 2)
    assert body(box((1000, 1000, 1000), (2000, 0, 0)), density="x", unit=F(1, 1000)).mass == F(5, 2)


def ring(count):
    turns = 2 * np.pi * np.arange(count) / count
    return revolved([(2 + 0.5 * np.cos(t), 0.5 * np.sin(t)) for t in turns], count)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("make,levels,expected", [
    (sphere, (2, 3, 4), [2 / 5] * 3),
    (lambda n: revolved([(0, -1), (1, -1), (1, 1), (0, 1)], n), (16, 32, 64), [1 / 4 + 4 / 12, 1 / 4 + 4 / 12, 1 / 2]),
    (ring, (12, 24, 48), [5 / 8 / 4 + 4 / 2, 5 / 8 / 4 + 4 / 2, 3 / 4 / 4 + 4]),
], ids=["sphere", "cylinder", "torus"])  # fmt: skip
def test_refined_meshes_approach_the_solid_with_order_2(make, levels, expected):
    errors = [np.abs(np.diag(floats(body(make(level), mass=1).inertia)) - expected).max() for level in levels]
    orders = [np.log2(before / after) for before, after in pairwise(errors)]
    assert orders == pytest.approx([2, 2], abs=0.1)


# --- refusals ---------------------------------------------------------------------------------------------------------


def without(surface, *triangles):
    return Surface(surface.vertices, np.delete(surface.triangles, triangles, axis=0))


def with_flipped(surface, triangle):
    triangles = surface.triangles.copy()
    triangles[triangle] = triangles[triangle, ::-1]
    return Surface(surface.vertices, triangles)


def doubled(surface):
    return Surface(surface.vertices, np.concatenate([surface.triangles, surface.triangles]))


@pytest.mark.parametrize("surface,sentence", [
    (without(box(), 0), "3 open edges, the first from (0, 0, 0) to (1, 0, 0)"),
    (without(sphere(2), 0, 20), "6 open edges"),
    (with_flipped(box(), 3), "3 edges at which two neighbouring triangles have opposite orientation"),
    (box().flipped(), "turned inside out, with a volume of -1 m^3; write flip = true"),
    (doubled(box()), "expected each triangle once, got 12 repeated triangles"),
    (joined(box(), box((1, 1, 1), (0.4, 0.3, 0.2))), "a winding number of 2"),
    (joined(box((3, 3, 3)), box((1, 1, 1), (1, 1, 1))), "a winding number of 2"),
    (joined(box((3, 3, 3)), box((1, 1, 1), (7, 7, 7)).flipped()), "a winding number of -1"),
    (joined(box((3, 3, 3)), box((1, 1, 1), (2.5, 1, 1)).flipped()), "a winding number of -1"),
    (Surface(box().vertices * [1, 1, 0], box().triangles), "a volume of zero"),
], ids=str)  # fmt: skip
def test_a_surface_that_bounds_no_body_is_refused(surface, sentence):
    with pytest.raises(InputError) as refusal:
        body(surface, mass=1)
    assert sentence in str(refusal.value)
    assert str(refusal.value).startswith("part: expected ")


def test_crossing_triangles_are_noticed():
    """A spike of a sphere that is pulled through its other side."""
    surface = sphere(3)
    vertices = surface.vertices.copy()
    vertices[np.argmax(vertices[:, 2])] = (0.11, 0.07, -1.5)
    with pytest.raises(InputError, match=r"does not cross itself"):
        body(Surface(vertices, surface.triangles), mass=1)


def test_boxes_that_cross_at_edges_alone_are_noticed():
    """An edge of the second box passes through the middle of a face of the first, where two triangles meet."""
    first = box((4, 4, 4))
    for other in (box((4, 4, 4), (2, 2, 2)), box((2, 2, 2), (2, 2, 3)).flipped()):
        for matrix in (np.eye(3), np.array([[1, 2, 2], [2, 1, -2], [-2, 2, -1]]) / 4):
            surface = joined(first, other)
            with pytest.raises(InputError, match="does not cross itself"):
                body(Surface(surface.vertices @ matrix.T, surface.triangles), density=1)


def tetrahedron(*corners):
    corners = np.array(corners, dtype=float)
    triangles = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    turns = np.linalg.det(corners[1:] - corners[0]) > 0
    return Surface(corners, triangles if turns else triangles[:, ::-1])


@pytest.mark.parametrize("depth", [F(1, 2**k) for k in (1, 10, 20, 30, 40)], ids=float)
@pytest.mark.parametrize("first,second,shift", [
    ([(-1, 0, 0), (0, 1, -1), (0, 1, 1), (0, 0, 0)], [(0, 1, 1), (-1, 0, 0), (-1, 1, 1), (-1, 1, -1)], (1, 0, 0)),
    ([(-1, 0, -1), (-1, 1, -1), (1, 1, -1), (0, 1, 0)], [(1, 0, -1), (0, 0, 0), (0, 1, 0), (-1, 0, -1)], (0, 1, 0)),
    ([(0, 0, -1), (0, -1, -1), (0, 1, 0), (-1, 0, 1)], [(1, -1, 1), (0, 0, -1), (1, -1, 0), (-1, 0, 1)], None),
], ids=["parallel edges", "coplanar faces", "two common corners"])  # fmt: skip
def test_tetrahedra_that_overlap_little_are_noticed_and_those_that_touch_are_a_body(first, second, shift, depth):
    """No triangle is passed by an edge in its interior: the triangles cross between two edges, or up to a corner."""
    for sign in (1, -1) if shift else (1,):
        other = np.array(second, dtype=object)
        if shift:
            other = other + sign * depth * np.array(shift, dtype=object)
        else:
            other[2, 1] -= depth
        edges = [np.array(list(combinations(corners, 2)), dtype=object) for corners in (first, other)]
        directions = [each[:, 1] - each[:, 0] for each in edges]
        # convex bodies are apart if a plane separates them: a face of one, or parallel to an edge of each
        normals = np.concatenate([
            *(np.cross(each[:, None], each[None]).reshape(-1, 3) for each in directions),
            np.cross(directions[0][:, None], directions[1][None]).reshape(-1, 3),
        ])  # fmt: skip
        heights = [np.array(corners, dtype=object) @ normals.T for corners in (first, other)]
        apart = (heights[0].max(axis=0) <= heights[1].min(axis=0)) | (heights[1].max(axis=0) <= heights[0].min(axis=0))
        surface = joined(tetrahedron(*first), tetrahedron(*other))
        if apart[normals.any(axis=1)].any():
            assert "no two triangles cross" in body(surface, density=1).checks
        else:
            with pytest.raises(InputError, match="does not cross itself"):
                body(surface, density=1)


@pytest.mark.parametrize("surface,mass", [
    (joined(box(), box((1, 1, 1), (1, 0.25, 0.25))), 2),
    (joined(box((4, 4, 4)), box((1, 1, 1), (0, 1, 1)).flipped()), 63),
    (joined(box((2, 2, 2)), box((2, 2, 1)).flipped()), 4),
    (joined(box(), box((1, 1, 1), (1, 1, 0))), 2),
])  # fmt: skip
def test_bodies_may_touch(surface, mass):
    assert body(surface, density=1).mass == mass


def test_a_small_crossing_in_a_fine_mesh_is_noticed_among_all_pairs():
    from symrot.exchange.crossing import _Boxes, _search_pairs

    surface = joined(sphere(3), moved(Surface(sphere(3).vertices, sphere(3).triangles), (1.99, 0.013, 0.007)))
    corners = surface.vertices[surface.triangles].transpose(1, 2, 0)
    with pytest.raises(InputError, match=r"triangles that cross near"):
        _search_pairs(surface, _Boxes(corners.min(axis=0), corners.max(axis=0)), "part")
    apart = joined(sphere(3), moved(sphere(3), (2.001, 0, 0)))
    corners = apart.vertices[apart.triangles].transpose(1, 2, 0)
    assert not len(_search_pairs(apart, _Boxes(corners.min(axis=0), corners.max(axis=0)), "part"))


def test_degenerate_triangles_of_a_closed_surface_are_harmless():
    surface = box()
    extra = np.concatenate([surface.triangles, [[0, 0, 1], [3, 3, 3]]])
    assert body(Surface(surface.vertices, extra), mass=6).inertia == body(surface, mass=6).inertia


@pytest.mark.parametrize(
    "density", ["x**2 + y**2 + z**2 - 1/2", "x**2 - 1/100", "1 - 5*(1 - x**2)*(1 - y**2)*(1 - z**2)/2"]
)
@pytest.mark.parametrize("unit", [1, F(1, 1000)])
def test_a_density_that_is_negative_inside_alone_is_refused(density, unit):
    size = 2 / float(unit)
    surface = box((size, size, size), (-size / 2, -size / 2, -size / 2))
    with pytest.raises(InputError, match="a density that is negative nowhere in the body"):
        body(surface, density=density, unit=unit)


def test_points_inside_are_not_in_a_cavity():
    hollow = joined(box((4, 4, 4)), box((2, 2, 2), (1, 1, 1)).flipped())
    assert body(hollow, density="(x - 2)**2 + (y - 2)**2 + (z - 2)**2 - 1").mass > 0
    with pytest.raises(InputError, match="negative nowhere"):
        body(box((4, 4, 4)), density="(x - 2)**2 + (y - 2)**2 + (z - 2)**2 - 1")


def test_a_density_without_mass_is_refused():
    with pytest.raises(InputError, match=r"part: density: expected a density with a positive mass, got 'x - 1'"):
        body(box(), density="x - 1")
    with pytest.raises(InputError, match=r"part: density: expected a density that is a polynomial"):
        body(box(), density="sin(x)")


def test_vertices_with_equal_hashes_stay_apart():
    points = np.random.default_rng(1).integers(-3, 3, (500, 3)).astype(float)
    surface = merge(points, np.arange(498).reshape(-1, 3))
    assert np.array_equal(surface.vertices[surface.triangles.ravel()], points[:498])
    assert len(surface.vertices) == len(np.unique(points, axis=0))


def test_bodies_placed_and_meshes_placed_agree():
    matrix = ((0, -1, 0), (1, 0, 0), (0, 0, 1))
    surface = box((1, 2, 3))
    turned = Surface(surface.vertices @ np.array(matrix, dtype=float).T + [4, 5, 6], surface.triangles)
    assert body(turned, mass=2).properties == place(body(surface, mass=2).properties, (4, 5, 6), matrix)


def test_a_density_that_is_negative_at_a_corner_is_refused():
    with pytest.raises(InputError, match=r"part: density: expected a density that is negative nowhere in the body"):
        body(box(), density="x - 1/10")
