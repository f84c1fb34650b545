"""Holes of bodies: proven within their parts, refused where the density would be negative, or reported as doubtful."""

import math
import random
import re

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import symrot
from symrot.errors import InputError
from symrot.inertia.composite import Part, doubtful_holes
from symrot.inertia.containment import are_apart, excess, outside
from symrot.inertia.cutting import cut
from symrot.inertia.holes import dense_part, pose
from symrot.inertia.hulls import center, corners, size
from symrot.inertia.integration import shape_points
from symrot.inertia.shapes import SHAPES, check_dimensions, scalars

ABOUT_X = ((1, 0, 0), (0, 0, -1), (0, 1, 0))


def part(shape, at=(0, 0, 0), density=2, rotation=((1, 0, 0), (0, 1, 0), (0, 0, 1)), **dimensions):
    return Part(shape, dimensions, density=density, at=at, rotation=rotation)


def hole(*arguments, **options):
    return part(*arguments, **options)._replace(subtract=True)


BOX = part("box", a=4, b=3, c=2)
DRUM = part("cylinder", radius=3, length=5)
STEPPED = (part("cylinder", radius=2, length=2), part("cylinder", (0, 0, 2), radius=1, length=2))
HALVES = (part("box", (-1, 0, 0), a=2, b=2, c=2), part("box", (1, 0, 0), a=2, b=2, c=2))
QUARTERS = [part("box", (x, y, 0), a=2, b=2, c=2) for x in (-1, 1) for y in (-1, 1)]


@pytest.mark.parametrize("parts", [
    [DRUM, hole("cylinder", radius=1, length=5)],
    [DRUM, hole("cylinder", radius=3, length=1)],
    [BOX, hole("cylinder", rotation=ABOUT_X, radius="1/2", length=3)],
    [DRUM, hole("cylinder", rotation=ABOUT_X, radius="1/2", length="59/10")],
    [*STEPPED, hole("cylinder", (0, 0, 1), radius="1/2", length=4)],
    [*HALVES, hole("box", a=1, b=1, c=2)],
    *([*HALVES, each] for each in (
        hole("cylinder", radius="1/2", length=2), hole("sphere", radius="9/10"), hole("cone", (0, 0, -1), radius="1/2", height=2),
        hole("hemisphere", radius="9/10"), hole("ellipsoid", a="9/10", b="1/3", c="1/2"),
        hole("cylinder", rotation=((0.6, 0, 0.8), (0, 1, 0), (-0.8, 0, 0.6)), radius="1/4", length=2),
    )),
    [*QUARTERS, hole("cylinder", radius=1, length=2), hole("cylinder", ("3/2", 0, 0), radius="1/4", length=2)],
    [HALVES[0], HALVES[1]._replace(density=1), hole("cylinder", density=1, radius="1/2", length=2)],
    [part("plate", (-1, 0, 0), a=2, b=2), part("plate", (1, 0, 0), a=2, b=2), hole("disk", radius="1/2")],
    [BOX, hole("box", a=1, b=1, c=1), hole("box", (1, 0, 0), a=1, b=1, c=1)],
    [BOX, *(hole("box", (x, 0, 0), density=1, a=1, b=1, c=1) for x in (0, 0.5))],
    [BOX, hole("cylinder", radius=1, length=2), part("cylinder", radius=1, length=2, density=7)],
    [BOX, hole("cylinder", radius=1, length=2), part("cylinder", radius=1, length=2, density=7),
     hole("cylinder", radius="1/2", length=2, density=7)],
    [part("cone", radius=3, height=6), hole("cone", (0, 0, 4), radius=1, height=2)],
    [part("frustum", bottom=3, top=1, height=2), hole("sphere", (0, 0, 1), radius=1)],
    [part("ellipsoid", a=4, b=2, c=3), hole("ellipsoid", a=3, b=1, c=2)],
    [part("ellipsoid", a=4, b=2, c=3), hole("sphere", radius=2)],
    [part("box", a=8, b=8, c=2), hole("torus", ring=3, tube=1)],
    [part("torus", ring=3, tube=1), hole("torus", ring=3, tube="1/2")],
    [part("hollow_cylinder", inner=1, outer=2, length=5), hole("sphere", (1.5, 0, 0), radius="1/2")],
    [part("hollow_sphere", inner=1, outer=2), hole("hollow_sphere", inner="5/4", outer=2)],
    [part("triangular_prism", base=4, height=3, apex=1, length=2), hole("cylinder", (1.5, 1, 0), radius="1/2", length=2)],
    [part("tetrahedron", vertices=[[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]]), hole("box", (0.5, 0.5, 0.5), a=1, b=1, c=1)],
    [part("box", a=6, b=6, c=6), hole("hemisphere", radius=3)],
    [part("plate", a=4, b=3), hole("disk", (1, 0.5, 0), radius=1)],
    [part("rod", length=4), hole("rod", (0, 0, 1), length=2)],
    [part("ring", radius=4), hole("ring", radius=4)],
    [BOX._replace(density="3 + x"), hole("sphere", density="3 + x", radius=1)],
    [Part("box", {"a": 1, "b": 1, "c": 1}, mass=1), Part("cylinder", {"radius": 0.1, "length": 1}, mass=0.0315, subtract=True)],
    [Part("point_masses", {"masses": [1, 2], "points": [[0, 0, 0], [1, 0, 0]]}),
     Part("point_masses", {"masses": [1], "points": [[0, 0, 0]]}, at=(1, 0, 0), subtract=True)],
], ids=lambda parts: "-".join(each.shape for each in parts))  # fmt: skip
def test_a_hole_within_parts_is_accepted(parts):
    assert doubtful_holes(parts) == ()


@pytest.mark.parametrize("parts,sentence", [
    ([DRUM, hole("cylinder", radius=1, length=5.001)], "reaches out of them"),
    ([DRUM, hole("cylinder", rotation=ABOUT_X, radius="1/2", length=6)], "reaches out of them"),
    ([*STEPPED, hole("cylinder", (0, 0, 1), radius="1/2", length=4.001)], "reaches out of them"),
    ([BOX, hole("box", (1.6, 0, 0), a=1, b=1, c=1)], "reaches out of them"),
    ([part("sphere", radius=3), hole("sphere", (0, 0, 2.0001), radius=1)], "to (0, 0, 3.0001) m"),
    ([part("ellipsoid", a=4, b=2, c=3), hole("sphere", (3.1, 0, 0), radius=1)], "reaches out of them"),
    ([part("torus", ring=3, tube=1), hole("sphere", radius="1/2")], "reaches out of them"),
    ([part("hollow_cylinder", inner=1, outer=2, length=5), hole("cylinder", radius="1/2", length=5)], "reaches out"),
    ([part("plate", a=4, b=3), hole("disk", (1, 0.6, 0), radius=1)], "reaches out of them"),
    ([part("plate", a=4, b=3), hole("disk", (0, 0, 0.1), radius=1)], "reaches out of them"),
    ([BOX, hole("disk", density=0.1, radius=1)], "reaches out of them"),
    ([BOX, hole("box", density=3, a=1, b=1, c=1)], "got a density of 3 kg/m^3 where the other parts have 2 kg/m^3"),
    ([BOX._replace(density="3 + x"), hole("sphere", density=2.5, radius=1)], "got a density of 2.5 kg/m^3 where the other"),
    ([part("cylinder", radius=1, length=1, density="8*x**2/radius"),
      hole("cylinder", radius="1/2", length=1, density="8*x**2/radius")], "kg/m^3 where the other parts have"),
    ([BOX, hole("box", a=1, b=1, c=1), hole("box", (0.5, 0, 0), a=1, b=1, c=1)], "overlaps another hole"),
    ([Part("point_masses", {"masses": [1], "points": [[0, 0, 0]]}),
      Part("point_masses", {"masses": [0.5], "points": [[0, 0, 1]]}, subtract=True)], "expected at most 0 kg to subtract at"),
], ids=str)  # fmt: skip
def test_a_hole_that_makes_the_density_negative_is_refused(parts, sentence):
    with pytest.raises(InputError, match=re.escape(sentence)) as refusal:
        doubtful_holes(parts, "body.part")
    assert re.match(r"body\.part\[\d\]: expected ", str(refusal.value))


def test_a_gap_between_parts_is_not_covered():
    gap = part("box", (1.0000001, 0, 0), a=2, b=2, c=2)
    assert len(doubtful_holes([HALVES[0], gap, hole("cylinder", radius="1/2", length=2)])) == 1


@pytest.mark.parametrize("normal,height", [((0.6, 0.0, 0.8), 0.3), ((0.0, 0.0, 1.0), -0.2), ((0.36, 0.48, 0.8), 0.1)])
def test_a_plane_divides_the_volume_of_a_hull(normal, height):
    rng = random.Random(2)
    points = [(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)) for _ in range(40)]
    below, above = cut(points, normal, height, 1e-12)
    heights = [[sum(a * b for a, b in zip(p, normal, strict=True)) - height for p in half] for half in (below, above)]
    assert max(heights[0]) < 1e-12 and min(heights[1]) > -1e-12
    assert ConvexHull(below).volume + ConvexHull(above).volume == pytest.approx(ConvexHull(points).volume, rel=1e-12)


@pytest.mark.parametrize("shape", [name for name, shape in SHAPES.items() if shape.kind == "solid" and name != "torus"])
def test_a_shape_is_within_the_hull_of_its_corners(shape):
    rng = random.Random(3)
    body = drawn(rng, shape, 1)
    hull = ConvexHull(corners(body.solid))
    numbers = scalars(SHAPES[shape], body.exact_dimensions)
    points = [body.solid.pose.to_body((p["x"], p["y"], p["z"]))
              for p in shape_points(SHAPES[shape], numbers, (0.0, 0.17, 0.3, 0.52, 0.7, 0.96, 1.0))]  # fmt: skip
    assert (hull.equations[:, :3] @ np.array(points).T + hull.equations[:, 3:]).max() < 1e-12


SCENE = {"initial": {"omega": [0, 0, 1]}, "span": {"t": [0, 1]}}


def test_a_hole_that_cannot_be_decided_is_a_warning_of_the_run():
    boxes = [{"shape": "box", "a": 2, "b": 2, "c": 2, "density": 1, "at": [x, 0, 0]} for x in (-1, 1)]
    groove = {"shape": "torus", "ring": 0.5, "tube": 0.25, "density": 1, "subtract": True}
    scene = symrot.Scene.build(body={"part": [*boxes, groove]}, **SCENE)
    (warning,) = symrot.propagate(scene).warnings
    assert warning.startswith("scene: body.part[2]: whether this hole lies within parts at least")
    assert "whether this hole" in symrot.explain(scene)


def solid(shape, at, rotation, dimensions):
    return dense_part(shape, check_dimensions(SHAPES[shape], dimensions, ""), pose(at, rotation), 1, False)


def drawn(rng, shape, longest):
    """Return a shape with random dimensions, place and rotation."""
    numbers = sorted(rng.uniform(0.1, 1) * longest for _ in range(4))
    names = [each.name for each in SHAPES[shape].dimensions]
    order = {"hollow_cylinder": numbers, "hollow_sphere": numbers, "torus": numbers[::-1]}.get(shape)
    dimensions = dict(zip(names, order or rng.sample(numbers, 4), strict=False))
    if shape == "tetrahedron":
        dimensions = {"vertices": [[rng.uniform(-1, 1) * longest for _ in range(3)] for _ in range(4)]}
    axes = rng.choice([((1, 0, 0), (0, 1, 0), (0, 0, 1)), ABOUT_X, ((0.6, -0.8, 0), (0.8, 0.6, 0), (0, 0, 1)),
                       ((0.6, 0, 0.8), (0, 1, 0), (-0.8, 0, 0.6))])  # fmt: skip
    return solid(shape, [rng.choice([0, rng.uniform(-0.5, 0.5)]) for _ in range(3)], axes, dimensions)


def test_a_shape_that_is_within_another_has_no_point_outside():
    rng = random.Random(1)
    shapes = [name for name, shape in SHAPES.items() if shape.kind == "solid"]
    within = 0
    for _ in range(80):
        inner, outer = drawn(rng, rng.choice(shapes), 0.4), drawn(rng, rng.choice(shapes), 2)
        numbers = scalars(SHAPES[inner.solid.shape], inner.exact_dimensions)
        points = [inner.solid.pose.to_body((p["x"], p["y"], p["z"]))
                  for p in shape_points(SHAPES[inner.solid.shape], numbers, (0.0, 0.3, 0.7, 1.0))]  # fmt: skip
        assert max(excess(inner.solid, point) for point in points) <= 1e-12
        assert max(math.dist(center(inner.solid), point) for point in points) <= size(inner.solid) * (1 + 1e-12)
        if outside(inner.solid, outer.solid) <= 0:
            within += 1
            assert max(excess(outer.solid, point) for point in points) <= 1e-12
        if are_apart(inner.solid, outer.solid, 0.0):
            assert min(excess(outer.solid, point) for point in points) >= -1e-12
    assert within > 8
