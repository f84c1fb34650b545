"""Sketches of rigid bodies with their angular velocity, polhodes and cones: pictures in space."""

import numpy as np

from symrot.figures import free_bodies, mechanics
from symrot.figures.curves import circle, rotated, rotation, unit
from symrot.figures.picture import Picture
from symrot.figures.solids import draw_solid
from symrot.figures.view import Floats, View

__all__ = [
    "box_with_rate", "cones_of_flat_body", "plate_in_other_axes", "polhodes", "solid_with_axis", "wobbling_disk",
    "wobbling_pencil",
]  # fmt: skip

VIEW = View(azimuth=28, elevation=20, scale=95)


def solid_with_axis(name: str) -> str:
    """Return an SVG drawing of a standard solid, such as ``"cone"``, with its axes and its centre of mass."""
    return draw_solid(name).svg(f"A {name.replace('_', ' ')} with its axis z")


def plate_in_other_axes() -> str:
    """Return an SVG drawing of a plate with the axes x, y and with its principal axes."""
    return mechanics.principal_axes().svg("A plate with the axes x and y and with its principal axes")


def polhodes() -> str:
    """Return an SVG drawing of the polhodes of a body with the moments A > B > C."""
    picture = free_bodies.polhodes(largest_first=True)
    return picture.svg("Polhodes on the energy ellipsoid: paths of the angular velocity in body axes")


def cones_of_flat_body() -> str:
    """Return an SVG drawing of the body cone and the space cone of a flat symmetric body, C > A."""
    return free_bodies.retrograde_cones().svg("The body cone of a flat body rolls around the space cone")


def box_with_rate(*others: str) -> str:
    """Return an SVG drawing of a body with the principal axes 1, 2, 3, its angular velocity, and other vectors.

    Parameters
    ----------
    others : str
        ``"H"``, the angular momentum; ``"τ"``, a torque in a general direction; ``"τ_1"``, ``"τ_2"`` or ``"τ_3"``, a
        torque about one axis.
    """
    picture, half = Picture(), np.array([0.95, 0.55, 0.2])
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        corners = [half * np.eye(3)[i] + a * half[j] * np.eye(3)[j] + b * half[k] * np.eye(3)[k]
                   for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))]  # fmt: skip
        picture.area(VIEW, corners, "fill-soft")
        picture.curve(VIEW, corners, "soft", closed=True)
    for i in range(3):
        direction = np.eye(3)[i]
        picture.arrow(VIEW, half[i] * direction, (half[i] + 0.6) * direction, f"{i + 1}")
    omega = np.array([1.0, 0.75, 0.8])
    picture.arrow(VIEW, (0, 0, 0), omega, "ω", "red thick")
    for other in others:
        if other == "H":
            moments = half[[1, 0, 0]] ** 2 + half[[2, 2, 1]] ** 2
            picture.arrow(VIEW, (0, 0, 0), 1.5 * unit(moments * omega), other, "green thick")
        elif other == "τ":
            picture.arrow(VIEW, (0, 0, 0), (0.9, -0.9, 0.75), other, "violet thick")
        else:
            number = int(other[-1]) - 1
            direction = np.eye(3)[number]
            ring = circle((half[number] + 0.38) * direction, direction, 0.17, np.linspace(-0.4, 4.9, 41))
            picture.arc(VIEW, ring, "", "violet thick")
            picture.label(VIEW, (half[number] + 0.38) * direction, other, (24, -14) if number != 1 else (4, -26))
    picture.dot(VIEW, (0, 0, 0))
    return picture.svg("A rigid body with its principal axes and its angular velocity")


def _wobbling(half_length: float, radius: float) -> Picture:
    """Return a picture of a cylinder whose inclined axis goes around the vertical angular momentum H."""
    picture, view = Picture(), VIEW
    tilt = rotation((1, 0, 0), -26.0)
    axis = tilt[:, 2]

    def rim(height: float) -> Floats:
        return circle(height * axis, axis, radius)

    top, bottom = rim(half_length), rim(-half_length)
    side = unit(np.cross(axis, view.toward))
    for sign in (1.0, -1.0):
        edge = sign * radius * side
        picture.curve(view, [half_length * axis + edge, -half_length * axis + edge], "blue")
    picture.area(view, top)
    picture.curve(view, top, "blue", closed=True)
    picture.curve(view, bottom, "blue", (bottom + half_length * axis) @ view.toward > 0)
    reach = half_length + 0.75
    picture.arrow(view, half_length * axis, reach * axis, "", "blue thick")
    ring = circle((half_length + 0.4) * axis, axis, 0.17, np.linspace(-0.4, 4.9, 41))
    picture.arc(view, ring, "", "red")
    picture.label(view, (half_length + 0.4) * axis, "ω_3", (34, 6))
    picture.curve(view, [(0, 0, half_length), (0, 0, 0)], "green dashed")
    picture.arrow(view, (0, 0, half_length), (0, 0, reach + 0.35), "H", "green thick")
    path = rotated(reach * axis, (0, 0, 1), 360.0, 121)
    picture.curve(view, path, "soft dashed")
    picture.arc(view, path[10:34], "ϕ", "soft")
    return picture


def wobbling_disk() -> str:
    """Return an SVG drawing of a thin plate whose axis wobbles about the angular momentum."""
    return _wobbling(0.03, 0.95).svg("A thin plate that spins and wobbles")


def wobbling_pencil() -> str:
    """Return an SVG drawing of a long cylinder whose axis wobbles about the angular momentum."""
    return _wobbling(0.8, 0.2).svg("A long cylinder that spins and wobbles")
