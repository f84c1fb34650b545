"""Reading of mesh files: vertices and triangles as arrays, and one clear error for each unusable file."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from symrot.errors import InputError
from symrot.exchange.glb_file import read_glb
from symrot.exchange.obj_file import read_obj
from symrot.exchange.ply_file import read_ply
from symrot.exchange.stl_file import read_stl
from symrot.exchange.surface import MOST_TRIANGLES, Surface, merge
from symrot.files.reading import read_input
from symrot.formula.exact_numbers import show

__all__ = ["SUFFIXES", "read_surface"]

_READERS: dict[str, Callable[[bytes], tuple[Any, Any]]] = {
    ".stl": read_stl, ".obj": read_obj, ".ply": read_ply, ".glb": read_glb
}  # fmt: skip
SUFFIXES = tuple(_READERS)
LARGEST_FILE = 500_000_000
"""Largest size, in bytes, of a mesh file."""

LARGEST_COORDINATE = 1e30


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
        If the file cannot be read, has no triangles, or has coordinates that are not finite or beyond 1e30.
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
    try:
        mesh = _READERS[suffix](content)
    except InputError as reason:
        raise InputError(f"{where}: {reason}") from None
    except MemoryError:
        raise InputError(f"{where}: expected a mesh that fits in memory, got a larger one") from None
    except Exception:  # hostile values, of any kind, where the format has others
        raise InputError(
            f"{where}: expected a mesh in the format {suffix[1:].upper()}, got a file of another format or one that "
            "ends early"
        ) from None
    return _checked(mesh, where)


def _checked(mesh: tuple[Any, Any], where: str) -> Surface:
    vertices, triangles = mesh
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
