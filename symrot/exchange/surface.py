"""Triangulated surfaces: vertices merged by position, and the test that a surface is closed and oriented."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.errors import InputError

__all__ = ["Surface", "merge", "require_closed", "shells"]

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

CHUNK = 1 << 14  # points at a time, so that arrays stay in the cache of the processor
_MIXERS = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)  # odd constants of hash functions


class Surface(NamedTuple):
    """Triangles in space; each triangle lists its corners counterclockwise as seen from outside the body.

    Attributes
    ----------
    vertices : array, shape (n, 3)
        Coordinates in the unit of the file; no two vertices are equal.
    triangles : array, shape (m, 3)
        Indices of vertices.
    bent : int
        Number of polygons in the file that are not flat; their division into triangles decides the shape.
    """

    vertices: Floats
    triangles: Indices
    bent: int = 0

    @property
    def note(self) -> str:
        """A sentence about the polygons of the file that are not flat; empty if there are none."""
        if not self.bent:
            return ""
        polygons = "1 polygon of the file is not flat" if self.bent == 1 else (
            f"{self.bent} polygons of the file are not flat")  # fmt: skip
        return f"{polygons}, so the shape depends on how it is divided into triangles; save the mesh as triangles"

    def flipped(self) -> "Surface":
        """Return the surface with the opposite orientation: the corners of each triangle in reverse order."""
        return self._replace(triangles=np.ascontiguousarray(self.triangles[:, ::-1]))


def merge(vertices: Floats, triangles: Indices) -> Surface:
    """Return a surface in which vertices with equal coordinates are one vertex."""
    # STL files repeat a vertex for each triangle, other formats for each normal or colour.
    points = np.ascontiguousarray(vertices, dtype=np.float64) + 0.0  # -0.0 and 0.0 are the same coordinate
    mixed = np.empty(len(points), np.uint64)
    parts = [slice(start, start + CHUNK) for start in range(0, len(points), CHUNK)]
    for part in parts:
        mixed[part] = _hashes(points[part])
    order = np.argsort(mixed)
    ordered = mixed[order]
    is_new = np.append(True, ordered[1:] != ordered[:-1])
    number = np.empty(len(points), np.int64)
    number[order] = np.cumsum(is_new) - 1
    first = order[is_new]
    merged = points[first]
    if not all(np.array_equal(merged[number[part]], points[part]) for part in parts):  # two positions with one hash
        merged, number = np.unique(points, axis=0, return_inverse=True)
    return Surface(merged, number.reshape(-1)[triangles])


def _hashes(points: Floats) -> NDArray[np.uint64]:
    """Return a hash of the coordinates of each point, so that equal points can be detected by sorting."""
    bits = points.view(np.uint64)
    mixed = np.zeros(len(points), np.uint64)
    for column, mixer in enumerate(_MIXERS):
        mixed = (mixed ^ bits[:, column]) * np.uint64(mixer)
        mixed ^= mixed >> np.uint64(29)
    return mixed


def _edges(surface: Surface) -> tuple[Indices, Indices]:
    """Return the start vertices and the end vertices of the three edges of each triangle, as two arrays of indices."""
    columns = [np.ascontiguousarray(surface.triangles[:, corner]) for corner in range(3)]
    return np.concatenate(columns), np.concatenate([columns[1], columns[2], columns[0]])


def _undirected(start: Indices, end: Indices, count: int) -> Indices:
    return np.minimum(start, end) * count + np.maximum(start, end)


def require_closed(surface: Surface, where: str) -> None:
    """Raise InputError unless the surface is closed and no triangle is repeated.

    A surface is closed if its triangles follow each edge equally often in both directions. It then bounds a region, so
    that its volume does not depend on an origin.
    """
    start, end = _edges(surface)
    keys = np.sort(_undirected(start, end, len(surface.vertices)) * 2 + (start > end))
    if len(keys) % 2 == 0 and np.array_equal(keys[::2] ^ 1, keys[1::2]) and np.all(keys[2::2] != keys[:-2:2]):
        return  # two triangles at each edge, which follow it in opposite directions
    count = len(surface.vertices)
    ordered = np.sort(start * count + end)
    if not np.array_equal(ordered, np.sort(end * count + start)):
        raise InputError(f"{where}: expected a closed surface, got {_defect(surface)}")
    if np.any(ordered[1:] == ordered[:-1]):  # a triangle that occurs twice has each of its edges twice
        lowest = np.argmin(surface.triangles, axis=1)
        rolled = np.take_along_axis(surface.triangles, (lowest[:, None] + np.arange(3)) % 3, axis=1)
        proper = rolled[
            (rolled[:, 0] != rolled[:, 1]) & (rolled[:, 1] != rolled[:, 2]) & (rolled[:, 2] != rolled[:, 0])
        ]
        repeats = len(proper) - len(np.unique(proper, axis=0))
        if repeats:
            raise InputError(f"{where}: expected each triangle once, got {repeats} repeated triangles; remove them")


def _defect(surface: Surface) -> str:
    """Return the clause of an error message that counts the edges at which a surface is open.

    If it is open nowhere, the clause counts the edges at which its orientation changes.
    """
    start, end = _edges(surface)
    keys, number = np.unique(_undirected(start, end, len(surface.vertices)), return_inverse=True)
    balance = np.bincount(number, weights=np.sign(end - start)).astype(np.int64)
    uses = np.bincount(number)
    wrong = np.flatnonzero(balance)
    is_open = uses[wrong] % 2 == 1
    count = int(is_open.sum())
    if count:
        ends = divmod(int(keys[wrong[is_open][0]]), len(surface.vertices))
        place = " to ".join(_point(surface.vertices[end]) for end in ends)
        return f"{count} open edges, the first from {place}; close the holes or join the vertices in your mesh program"
    return (
        f"{len(wrong)} edges at which two neighbouring triangles have opposite orientation; make the normals "
        "consistent in your mesh program"
    )


def _point(vertex: Floats) -> str:
    return "(" + ", ".join(f"{x:.6g}" for x in vertex) + ")"


def shells(surface: Surface) -> Indices:
    """Return for each triangle the number, from 0, of its shell; different shells have no vertex in common."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    count = len(surface.vertices)
    start = np.repeat(surface.triangles[:, 0], 2)  # two edges of a triangle connect its three corners
    end = surface.triangles[:, 1:].ravel()
    graph = coo_matrix((np.ones(len(start), np.int8), (start, end)), shape=(count, count))
    _, labels = connected_components(graph, directed=False)
    _, numbers = np.unique(labels[surface.triangles[:, 0]], return_inverse=True)
    return numbers.astype(np.int64)
