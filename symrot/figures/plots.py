"""Plots of curves over one variable, with axes, for figures."""

import numpy as np

from symrot.figures.picture import Picture
from symrot.figures.view import Floats, Plane

__all__ = ["Axes"]


class Axes:
    """A rectangle of a picture in which curves are plotted over a horizontal variable.

    Parameters
    ----------
    picture : Picture
        The picture to which the plot is added.
    x, y : (float, float)
        The limits of the two variables.
    size : (float, float)
        Width and height, SVG units.
    corner : (float, float)
        The position of the rectangle's lower left corner in the picture.
    """

    def __init__(
        self, picture: Picture, x: tuple[float, float], y: tuple[float, float], size: tuple[float, float],
        corner: tuple[float, float] = (0.0, 0.0),
    ) -> None:  # fmt: skip
        self.picture, self.x, self.y = picture, (float(x[0]), float(x[1])), (float(y[0]), float(y[1]))
        width, height = self.x[1] - self.x[0], self.y[1] - self.y[0]
        scale_x, scale_y = size[0] / width, size[1] / height
        self.plane = Plane(scale_x, (corner[0] - scale_x * self.x[0], corner[1] + scale_y * self.y[0]), scale_y)

    def frame(self, x_label: str, y_label: str) -> None:
        """Draw both axes with their labels; the horizontal axis is at y = 0, or at the bottom if 0 is out of range."""
        (left, right), (low, high) = self.x, self.y
        zero = 0.0 if low <= 0.0 <= high else low
        self.picture.arrow(self.plane, (left, zero), (right + 0.11 * (right - left), zero), x_label, "soft")
        self.picture.arrow(self.plane, (left, low), (left, high + 0.06 * (high - low)), y_label, "soft")

    def curve(self, x: Floats, y: Floats, style: str = "blue thick", label: str = "", at: float = 1.0) -> None:
        """Draw a curve through the points (x, y), with a label above the point at the fraction ``at`` of all points.

        With ``at = 1``, the default, the label is to the right of the last point that is drawn.
        """
        # points above or below the rectangle are left out
        inside = (y >= self.y[0]) & (y <= self.y[1])
        starts = np.flatnonzero(inside & ~np.concatenate([[False], inside[:-1]]))
        ends = np.flatnonzero(inside & ~np.concatenate([inside[1:], [False]])) + 1
        for first, last in zip(starts, ends, strict=True):
            self.picture.curve(self.plane, np.stack([x[first:last], y[first:last]], axis=1), style)
        if label:
            place = round(at * (len(x) - 1)) if at < 1.0 else ends[-1] - 1
            self.picture.label(self.plane, (x[place], y[place]), label, (16, 0) if at == 1.0 else (6, -12))

    def level(self, y: float, label: str = "", style: str = "soft dashed") -> None:
        """Draw a horizontal line at the height ``y`` with a label at its right end."""
        self.picture.curve(self.plane, np.array([[self.x[0], y], [self.x[1], y]]), style)
        if label:
            self.picture.label(self.plane, (self.x[1], y), label, (16, 0))

    def upright(self, x: float, label: str = "", low: float | None = None, high: float | None = None) -> None:
        """Draw a vertical line at ``x``, from ``low`` to ``high`` or over the whole height.

        Its label is below the rectangle.
        """
        bottom, top = self.y[0] if low is None else low, self.y[1] if high is None else high
        self.picture.curve(self.plane, np.array([[x, bottom], [x, top]]), "soft dashed")
        if label:
            self.picture.label(self.plane, (x, self.y[0]), label, (0, 13))
