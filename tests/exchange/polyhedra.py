"""Polyhedra as vertices and triangles, and their integrals as sums over tetrahedra in exact fractions."""

from fractions import Fraction
from itertools import combinations_with_replacement, product

import numpy as np

from symrot.exchange.surface import Surface, merge

BOX_FACES = (
    (0, 3, 1),
    (0, 2, 3),
    (4, 5, 7),
    (4, 7, 6),
    (0, 1, 5),
    (0, 5, 4),
    (2, 7, 3),
    (2, 6, 7),
    (0, 6, 2),
    (0, 4, 6),
    (1, 3, 7),
    (1, 7, 5),
)


def box(sides=(1, 1, 1), at=(0, 0, 0)):
    """Return a box with a corner at ``at``."""
    corners = np.array([at + np.array(sides) * np.array(c)[::-1] for c in product((0, 1), repeat=3)], dtype=float)
    return Surface(corners, np.array(BOX_FACES, dtype=np.int64))


def joined(*surfaces):
    """Return one surface of several shells."""
    starts = np.cumsum([0, *(len(each.vertices) for each in surfaces)])
    triangles = [each.triangles + start for each, start in zip(surfaces, starts, strict=False)]
    return merge(np.concatenate([each.vertices for each in surfaces]), np.concatenate(triangles))


def refined(surface, place=lambda points: points):
    """Return a surface with each triangle divided into four; ``place`` moves the vertices."""
    a, b, c = (surface.vertices[surface.triangles[:, k]] for k in range(3))
    p, q, r = (a + b) / 2, (b + c) / 2, (c + a) / 2
    corners = np.stack([a, p, r, p, b, q, r, q, c, p, q, r], axis=1).reshape(-1, 3)
    return merge(place(corners), np.arange(len(corners)).reshape(-1, 3))


def octahedron():
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1.0]])
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return Surface(vertices, np.array(triangles, dtype=np.int64))


def to_sphere(points):
    return points / np.linalg.norm(points, axis=1)[:, None]


def sphere(level):
    """Return a sphere of radius 1 as a refined octahedron, with 8 * 4**level triangles."""
    surface = octahedron()
    for _ in range(level):
        surface = refined(surface, to_sphere)
    return surface


def revolved(profile, count):
    """Return a closed profile of points (radius, height) revolved about z in ``count`` steps, as a ring."""
    angles = 2 * np.pi * np.arange(count) / count
    points = np.array([[r * np.cos(t), r * np.sin(t), z] for t in angles for r, z in profile])
    size, triangles = len(profile), []
    for i, j in product(range(count), range(size)):
        a, b = i * size + j, i * size + (j + 1) % size
        c, d = ((i + 1) % count) * size + j, ((i + 1) % count) * size + (j + 1) % size
        triangles += [(a, c, b), (b, c, d)]
    merged = merge(points, np.array(triangles, dtype=np.int64))
    proper = (merged.triangles != np.roll(merged.triangles, 1, axis=1)).all(axis=1)
    return Surface(merged.vertices, merged.triangles[proper])


def rotated(surface, angle=0.7):
    """Return a surface rotated about a skew axis, and the matrix."""
    from scipy.spatial.transform import Rotation

    matrix = Rotation.from_rotvec(angle * np.array([0.6, -0.3, 0.9])).as_matrix()
    return Surface(surface.vertices @ matrix.T, surface.triangles), matrix


def exact_sums(surface):
    """Return volume, first and second moments about the origin, tetrahedron by tetrahedron, by the textbook formula.

    The integral of x_i x_j over the tetrahedron (0, a, b, c) is det/120 * ((a+b+c)_i (a+b+c)_j + a_i a_j + b_i b_j
    + c_i c_j).
    """
    points = [[Fraction(x) for x in vertex] for vertex in surface.vertices.tolist()]
    volume, first, second = Fraction(0), [Fraction(0)] * 3, {}
    for triangle in surface.triangles.tolist():
        a, b, c = (points[k] for k in triangle)
        det = (
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        )
        s = [x + y + z for x, y, z in zip(a, b, c, strict=True)]
        volume += det / 6
        first = [f + det / 24 * x for f, x in zip(first, s, strict=True)]
        for i, j in combinations_with_replacement(range(3), 2):
            second[i, j] = second.get((i, j), 0) + det / 120 * (s[i] * s[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j])
    return volume, first, second
