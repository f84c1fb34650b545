"""Reading of mesh files, mostly by trimesh: vertices and triangles as arrays, a clear error for an unusable file."""

import logging
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from symrot.errors import InputError
from symrot.exchange.mesh_format import EARLY_END, FACTS_OF, Facts
from symrot.exchange.obj_file import read_plain_obj, refers_backwards
from symrot.exchange.polygons import bent_polygons
from symrot.exchange.surface import Surface, merge
from symrot.files.reading import read_input
from symrot.formula.exact_numbers import show

__all__ = ["SUFFIXES", "read_surface"]

SUFFIXES = (".stl", ".obj", ".ply", ".glb")
LARGEST_FILE = 500_000_000
"""Largest size, in bytes, of a mesh file."""

LARGEST_COORDINATE = 1e30
MOST_TRIANGLES = 20_000_000


def read_surface(path: Path, where: str) -> Surface:
    """Return the triangles of a mesh file, with vertices at equal positions merged.

    Parameters
    ----------
    path : Path
        A file with a suffix in SUFFIXES. Files that it refers to, such as textures, are not opened.
    where : str
        Place for error messages.

    Raises
    ------
    InputError
        If the suffix is not in SUFFIXES, if trimesh is needed and not installed, or if the file cannot be read, is too
        large, has no triangles, or has coordinates that are not finite or of a magnitude beyond 1e30.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"{where}: expected a mesh file ({', '.join(SUFFIXES)}), got {show(path.name)}")
    try:
        content = read_input(path, LARGEST_FILE)
    except OSError as reason:
        limit = f"{LARGEST_FILE // 1_000_000} MB"
        raise InputError(
            f"{where}: expected a readable mesh file of at most {limit}, got {reason.strerror or reason}"
        ) from None
    facts = Facts()
    try:
        mesh: Any = read_plain_obj(content) if suffix == ".obj" else None
        if mesh is None and suffix == ".obj" and refers_backwards(content):
            # trimesh counts them from the end of the file
            raise InputError(
                "expected positive vertex indices in an OBJ file whose lines do not all have the same form, got a line "
                "such as f -3 -2 -1; save the mesh again with positive indices or with triangles alone"
            )
        if mesh is None:
            trimesh, facts = _trimesh(), FACTS_OF[suffix](content)
            vertices, triangles, bent = _load(trimesh, content, suffix[1:])
            if facts.triangles not in (None, len(triangles)):
                raise InputError(
                    f"expected the {facts.triangles} triangles of the file, but trimesh reads {len(triangles)}; save "
                    "the mesh again as triangles alone"
                )
            mesh, facts = (vertices, triangles), facts._replace(bent=facts.bent + bent)
    except InputError as reason:
        raise InputError(f"{where}: {reason}") from None
    except MemoryError:
        raise InputError(f"{where}: expected a mesh that fits in memory, got a larger one") from None
    except ImportError:  # a reader of trimesh looks for the encoding of a file that is no text
        raise InputError(f"{where}: {EARLY_END.format(suffix[1:].upper())}") from None
    except Exception as reason:  # a broken file raises errors of many kinds in the readers of trimesh
        fault = " ".join(str(reason).split())[:80] or type(reason).__name__
        raise InputError(f"{where}: expected a mesh in the format {suffix[1:].upper()}, got a fault: {fault}") from None
    return _checked(mesh[0], mesh[1], where)._replace(bent=facts.bent)


def _trimesh() -> Any:
    """Return the module trimesh; raise InputError if it is not installed."""
    try:
        import trimesh
    except ImportError:
        raise InputError(
            "expected trimesh, which reads meshes, but it is not installed; install it with pip install 'symrot[mesh]'"
        ) from None
    log = logging.getLogger("trimesh")
    if not log.hasHandlers():  # its warnings contain tracebacks
        log.addHandler(logging.NullHandler())
    return trimesh


def _load(trimesh: Any, content: bytes, kind: str) -> tuple[Any, Any, int]:
    """Return the vertices and triangles of a file, and how many polygons of a PLY file are not flat.

    All bodies in the file, at their positions, form one mesh.
    """
    options: dict[str, Any] = {"process": False, "maintain_order": True}
    if kind in ("obj", "glb"):
        options["skip_materials"] = True
    scene = trimesh.load_scene(BytesIO(content), file_type=kind, **options)
    vertices, faces, count, bent = [np.empty((0, 3))], [np.empty((0, 3), np.int64)], 0, 0
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        geometry = scene.geometry[name]
        if not hasattr(geometry, "faces"):
            continue
        points = np.asarray(geometry.vertices, dtype=np.float64).reshape(-1, 3)
        if not np.array_equal(transform, np.eye(4)):
            points = points @ transform[:3, :3].T + transform[:3, 3]
        corners = np.asarray(geometry.faces, dtype=np.int64).reshape(-1, 3)
        if np.linalg.det(transform[:3, :3]) < 0:  # a reflection reverses the orientation
            corners = corners[:, ::-1]
        vertices.append(points)
        faces.append(corners + count)
        count += len(points)
        if "_ply_raw" in geometry.metadata:
            bent += _bent_in_ply(geometry.metadata["_ply_raw"])
    if len(vertices) == 2:
        return vertices[1], faces[1], bent
    return np.concatenate(vertices), np.concatenate(faces), bent


def _bent_in_ply(elements: Any) -> int:
    """Return how many polygons of a PLY file are not flat; ``elements`` is trimesh's record of the file."""
    points, faces = elements["vertex"]["data"], elements["face"]["data"]
    names = faces if isinstance(faces, dict) else faces.dtype.names or ()
    name = next((each for each in names if each in ("vertex_indices", "vertex_index")), None)
    if name is None:
        return 0
    polygons = faces[name] if isinstance(faces, dict) else faces[name]["f1"]
    return bent_polygons(np.column_stack([points[axis] for axis in "xyz"]).astype(np.float64), polygons)


def _checked(vertices: Any, triangles: Any, where: str) -> Surface:
    if not len(triangles):
        raise InputError(f"{where}: expected a mesh with triangles, got {len(vertices)} points and no triangle")
    if len(triangles) > MOST_TRIANGLES:
        raise InputError(f"{where}: expected at most {MOST_TRIANGLES} triangles, got {len(triangles)}")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise InputError(
            f"{where}: expected corners from 0 to {len(vertices) - 1}, got a triangle with corner "
            f"{triangles.min() if triangles.min() < 0 else triangles.max()}"
        )
    if not np.isfinite(vertices).all():
        wrong = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
        raise InputError(f"{where}: expected finite coordinates, got {vertices[wrong[0]].tolist()}")
    largest = float(max(vertices.max(), -vertices.min()))
    if largest > LARGEST_COORDINATE:
        raise InputError(f"{where}: expected coordinates up to {LARGEST_COORDINATE:g}, got {largest:.6g}")
    return merge(vertices, triangles)
