"""Times and rounding errors of mass, centre of mass and inertia of a mesh with a million triangles, by file format.

    python -m symrot.bench.comparison.meshes [--triangles 1000000] [--rounds 3]

The mesh is an ellipsoid, written by trimesh (``pip install 'symrot[mesh]'``) and read by :func:`symrot.mesh`. The
rounding error is measured on a mesh with a hundredth of the triangles, where exact integrals are quick.
"""

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np

import symrot
from symrot.exchange import mesh as meshes
from symrot.report.layout import columns

__all__ = ["ellipsoid", "main"]

FORMATS = ("stl", "ply", "glb", "obj")
AXES = (1.0, 1.5, 0.7)  # m


def ellipsoid(triangles: int) -> tuple[Any, Any]:
    """Return the vertices and about ``triangles`` triangles of an ellipsoid with the semi-axes :data:`AXES`."""
    count = max(3, round((triangles / 2) ** 0.5))
    polar, around = np.linspace(0, np.pi, count + 1)[1:-1], np.linspace(0, 2 * np.pi, count, endpoint=False)
    theta, phi = (grid.ravel() for grid in np.meshgrid(polar, around, indexing="ij"))
    ring = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    vertices = np.concatenate([ring, [[0, 0, 1], [0, 0, -1]]]) * AXES
    number = np.arange(len(ring)).reshape(count - 1, count)
    beside = np.roll(number, -1, axis=1)
    north, south = (np.full(count, len(ring) + pole) for pole in (0, 1))
    corners = [(number[:-1], number[1:], beside[1:]), (number[:-1], beside[1:], beside[:-1]),
               (north, number[0], beside[0]), (south, beside[-1], number[-1])]  # fmt: skip
    return vertices, np.concatenate([np.stack(each, axis=-1).reshape(-1, 3) for each in corners])


def _measured_error(path: Path) -> float:
    """Return the largest relative rounding error of the moments of inertia of the mesh in ``path``.

    The mesh is integrated once in doubles and once exactly, in integers.
    """
    most = meshes.MOST_EXACT
    try:
        meshes.MOST_EXACT = sys.maxsize
        exact = symrot.mesh(path, mass=1)
        meshes.MOST_EXACT = 0
        rounded = symrot.mesh(path, mass=1)
    finally:
        meshes.MOST_EXACT = most
    pairs = [(exact.inertia[i][i], rounded.inertia[i][i]) for i in range(3)]
    return max(float(abs(one - other) / one) for one, other in pairs)


def main() -> None:
    """Print, for each format of mesh files, the least processor time in which symrot reads and integrates an ellipsoid.

    Two more columns are the bound of the relative rounding error of its moments of inertia, and the measured error of a
    smaller mesh.
    """
    parser = argparse.ArgumentParser(description="mass and inertia of large meshes")
    parser.add_argument("--triangles", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    import trimesh

    rows = [("format", "triangles", "seconds", "bound of the error", "error with 1/100 of the triangles")]
    with TemporaryDirectory(prefix="symrot-") as folder:
        for form in FORMATS:
            whole, part = Path(folder, f"whole.{form}"), Path(folder, f"part.{form}")
            for path, count in ((part, options.triangles // 100), (whole, options.triangles)):
                vertices, triangles = ellipsoid(count)
                trimesh.Trimesh(vertices, triangles, process=False).export(path)
            seconds = []
            for _ in range(options.rounds):
                began = process_time()
                body = symrot.mesh(whole, mass=1)
                seconds.append(process_time() - began)
            rows.append(
                (form, str(len(triangles)), f"{min(seconds):.2f}", f"{body.error:.1e}", f"{_measured_error(part):.1e}")
            )
    print("\n".join(columns(rows)))


if __name__ == "__main__":
    main()
