"""Point masses among other parts of a body: the inertia about the common centre of mass is the sum over all parts."""

from fractions import Fraction as F

import numpy as np
import pytest

from symrot import Scene

PARTS = [
    [{"shape": "sphere", "radius": 1, "mass": 1}, {"shape": "point_masses", "masses": [2], "points": [[1, 0, 0]]}],
    [{"shape": "box", "a": 1, "b": 2, "c": 3, "mass": 6, "at": [1, "1/2", 0]},
     {"shape": "point_masses", "masses": [1, 2], "points": [[0, 1, 2], [3, -1, "1/3"]], "at": [0, 1, 0]}],
    [{"shape": "sphere", "radius": 2, "mass": 5, "at": [0, 0, 1]},
     {"shape": "point_masses", "masses": ["1/2", "1/2", 3], "points": [[1, 1, 1], [-1, 0, 2], [0, 2, 0]]}],
]  # fmt: skip
OWN = {"sphere": lambda part: [F(2, 5) * part["mass"] * F(part["radius"]) ** 2] * 3,
       "box": lambda part: [F(part["mass"], 12) * sum(F(part[k]) ** 2 for k in others) for others in ("bc", "ac", "ab")]}  # fmt: skip


def point_sum(parts):
    """Return the tensor about the common centre of mass: each solid counts as its own tensor and a point at its centre."""
    points, own = [], np.zeros((3, 3), dtype=object)
    for part in parts:
        at = [F(x) for x in part.get("at", (0, 0, 0))]
        if part["shape"] == "point_masses":
            points += [
                (F(m), [a + F(x) for a, x in zip(at, p, strict=True)])
                for m, p in zip(part["masses"], part["points"], strict=True)
            ]
        else:
            points.append((F(part["mass"]), at))
            own += np.diag(OWN[part["shape"]](part))
    mass = sum(m for m, _ in points)
    centre = [sum(m * p[k] for m, p in points) / mass for k in range(3)]
    for m, p in points:
        r = np.array([x - c for x, c in zip(p, centre, strict=True)], dtype=object)
        own = own + m * (np.diag([r @ r] * 3) - np.outer(r, r))
    return own


@pytest.mark.parametrize("parts", PARTS, ids=["sphere", "box", "three points"])
def test_point_masses_in_a_composite(parts):
    scene = Scene.from_dict({
        "schema": 1, "body": {"part": parts}, "initial": {"omega": [1, 1, 1]}, "span": {"t": [0, 5]},
    })  # fmt: skip
    expected = np.linalg.eigvalsh(point_sum(parts).astype(float))
    found = sorted(map(float, scene.body.principal.moments))
    assert np.allclose(found, expected, rtol=1e-13, atol=0)
