"""Tighter enclosures of polynomials: the value at the middle of a box, and derivatives over it.

Plain intervals of ``x*y - x*z`` forget that both x are one. The mean value form ``f(c) + sum of f_k'(box)*(x_k - c_k)``
does not, to first order in the width. What is enclosed are the values on the way from exact to computed ones: those of
the polynomial, and at most the rounding errors so far beside them.
"""

from collections.abc import Sequence

import numpy as np

from symrot.certificates.readback.operations import Node
from symrot.certificates.rounding.intervals import Array, add, magnitude, multiply, negative, square, widened

__all__ = ["Centred"]


class _Form:
    """A polynomial on boxes: its value at the middle, its gradient (2, inputs, n), how far mixed values are from it."""

    __slots__ = ("apart", "gradient", "middle")

    def __init__(self, middle: Array, gradient: Array, apart: Array) -> None:
        self.middle, self.gradient, self.apart = middle, gradient, apart


def _times(gradient: Array, values: Array) -> Array:
    """Return the product of gradients and intervals, outward."""
    products = gradient[:, None] * values[None, :, None]
    found = np.stack([products.min(axis=(0, 1)), products.max(axis=(0, 1))])
    return widened(found, 0.0)


class Centred:
    """The forms of the nodes of one pass, in their order; None for what is no polynomial."""

    def __init__(self, boxes: Array) -> None:
        self.boxes = boxes
        self.middle = (boxes[0] + boxes[1]) / 2
        self.radius = np.maximum(boxes[1] - self.middle, self.middle - boxes[0]) * (1 + 2.0**-50)
        self.forms: list[_Form | None] = []
        self.waiting: _Form | None = None

    def refined(self, node: Node, places: Sequence[int], values: Sequence[Array], plain: Array) -> Array:
        """Return an enclosure of an exact result that is no larger than the plain one."""
        self.waiting = form = self._combined(node, [self.forms[i] for i in places], values)
        if form is None:
            return plain
        spread = (magnitude(form.gradient) * self.radius).sum(axis=0) * (1 + 2.0**-40) + form.apart
        near = widened(form.middle, spread)
        low, high = np.maximum(plain[0], near[0]), np.minimum(plain[1], near[1])
        return np.where(low <= high, np.stack([low, high]), plain)

    def _combined(self, node: Node, forms: Sequence[_Form | None], values: Sequence[Array]) -> _Form | None:
        if any(form is None for form in forms):
            return None
        a = forms[0]
        b = forms[-1]
        assert a is not None and b is not None
        first, last = values[0], values[-1]
        if node[0] == "square":
            apart = a.apart * (2 * magnitude(first) + a.apart)
            return _Form(square(a.middle), _times(a.gradient, 2 * first), _up(apart))
        if node[0] == "mul":
            gradient = add(_times(a.gradient, last), _times(b.gradient, first))
            apart = a.apart * magnitude(last) + b.apart * magnitude(first) + a.apart * b.apart
            return _Form(multiply(a.middle, b.middle), gradient, _up(apart))
        plus = node[0] == "add"
        return _Form(
            add(a.middle, b.middle if plus else negative(b.middle)),
            add(a.gradient, b.gradient if plus else negative(b.gradient)), _up(a.apart + b.apart),
        )  # fmt: skip

    def close(self, node: Node, places: Sequence[int], error: Array | None) -> None:
        """Keep the form of a node, its own rounding error included."""
        form = self.waiting
        inputs, count = self.middle.shape
        none = np.zeros(count)
        if node[0] == "in":
            gradient = np.zeros((2, inputs, count))
            gradient[:, node[1]] = 1.0
            form = _Form(np.stack([self.middle[node[1]]] * 2), gradient, none)
        elif node[0] == "const":
            form = _Form(np.full((2, count), float(node[1])), np.zeros((2, inputs, count)), none)
        elif node[0] == "neg":
            inner = self.forms[places[0]]
            form = None if inner is None else _Form(negative(inner.middle), negative(inner.gradient), inner.apart)
        if form is not None and error is not None:
            form.apart = _up(form.apart + error)
        self.forms.append(form)
        self.waiting = None


def _up(values: Array) -> Array:
    return values * (1 + 2.0**-50)
