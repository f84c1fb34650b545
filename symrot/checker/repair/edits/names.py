"""Names that are easily confused with each other, and functions that are exchanged by mistake."""

import re
from collections.abc import Collection

__all__ = ["INVERSE_OPPOSITE", "OPPOSITE", "PRODUCT_OF_INERTIA", "neighbours", "spelled_like"]

MOST_NEIGHBOURS = 12
"""The largest number of names that are tried in place of one name."""

OPPOSITE = {"sin": "cos", "cos": "sin", "tan": "cot", "cot": "tan", "sec": "csc", "csc": "sec"}
INVERSE_OPPOSITE = {"asin": "acos", "acos": "asin"}
FAMILIES = (("A", "B", "C"), ("phi", "theta", "psi"), ("x", "y", "z"), ("alpha", "beta", "gamma"), ("a", "b", "c"))
_STEM = re.compile(r"([A-Za-z]+?)_?([0-9]+|[xyz]{1,2}|[sb])")
PRODUCT_OF_INERTIA = re.compile(r"[IJP]_?(xy|yx|xz|zx|yz|zy|12|21|13|31|23|32)", re.ASCII)


def neighbours(name: str, names: Collection[str]) -> list[str]:
    """Return names that are easily confused with ``name``: ``w_2`` for ``w_1``, ``phi`` for ``theta``.

    At most ``MOST_NEIGHBOURS`` of them, the first in alphabetical order.
    """
    family = next((set(members) for members in FAMILIES if name in members), set())
    match = _STEM.fullmatch(name)
    stem = match and match[1]
    near = []
    for other in names:
        other_match = _STEM.fullmatch(other)
        same_stem = stem and other_match and other_match[1] == stem
        same = other in family or other.lower() == name.lower() or same_stem
        if other != name and same:
            near.append(other)
    return sorted(near)[:MOST_NEIGHBOURS]


def spelled_like(rotation: str) -> tuple[str, ...]:
    """Return the names of the rotations about x, y and z in the spelling of ``rotation``: Rx, Ry and Rz for ``Rz``."""
    return tuple(rotation[:-1] + axis for axis in "xyz")
