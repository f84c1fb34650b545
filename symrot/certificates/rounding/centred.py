"""Intervals that contain a polynomial on a box, from its value at the middle and its derivatives (mean value form).

The form is ``f(c) + sum of f_k'(box)*(x_k - c_k)`` with c the middle. Plain interval arithmetic for ``x*y - x*z``
ignores that both x are the same number; the form accounts for this.
"""

from collections.abc import Sequence

import numpy as np

from symrot.certificates.readback.operations import Node
from symrot.certificates.rounding.intervals import Array, add, magnitude, multiply, negative, square, widened

__all__ = ["CentredForms"]


# Each interval is widened by the bounds of the rounding errors made so far, so that it contains the exact and the
# computed value of the polynomial.
class _CentredForm:
    """The mean value form, on each box, of the result of one operation (a node) that is a polynomial in the inputs.

    The form encloses the polynomial by its value at the middle of the box and its gradient on the box.
    """

    # ``deviation``: at every point of a box, the exact value of the node, its computed value and all numbers between
    # them differ from the polynomial by at most this.
    # ``middle``: intervals of the values at the middle; ``gradient``: intervals of the derivatives, (2, inputs, n).
    __slots__ = ("deviation", "gradient", "middle")

    def __init__(self, middle: Array, gradient: Array, deviation: Array) -> None:
        self.middle, self.gradient, self.deviation = middle, gradient, deviation


def _scaled_gradient(gradient: Array, values: Array) -> Array:
    """Return intervals that contain the products of gradients and ``values``, rounded outward."""
    products = gradient[:, None] * values[None, :, None]
    extremes = np.stack([products.min(axis=(0, 1)), products.max(axis=(0, 1))])
    return widened(extremes, 0.0)


class CentredForms:
    """The mean value forms of the operations that compute an output, in the order of the operations.

    The operations are the nodes of an OutputGraph. A mean value form encloses a polynomial on a box: it is the value at
    the middle plus the sum of slopes on the box times deviations from the middle. An operation whose result is not a
    polynomial in the inputs has None instead.
    """

    def __init__(self, boxes: Array) -> None:
        self.boxes = boxes
        self.middle = (boxes[0] + boxes[1]) / 2
        self.radius = np.maximum(boxes[1] - self.middle, self.middle - boxes[0]) * (1 + 2.0**-50)
        self.forms: list[_CentredForm | None] = []
        self.waiting: _CentredForm | None = None

    def refined(self, node: Node, places: Sequence[int], values: Sequence[Array], plain: Array) -> Array:
        """Return an interval that contains a node's exact result: ``plain``, narrowed by the node's mean value form."""
        self.waiting = form = self._combined(node, [self.forms[i] for i in places], values)
        if form is None:
            return plain
        spread = (magnitude(form.gradient) * self.radius).sum(axis=0) * (1 + 2.0**-40) + form.deviation
        near = widened(form.middle, spread)
        low, high = np.maximum(plain[0], near[0]), np.minimum(plain[1], near[1])
        return np.where(low <= high, np.stack([low, high]), plain)

    def _combined(
        self, node: Node, forms: Sequence[_CentredForm | None], values: Sequence[Array]
    ) -> _CentredForm | None:
        if any(form is None for form in forms):
            return None
        a = forms[0]
        b = forms[-1]
        assert a is not None and b is not None
        first, last = values[0], values[-1]
        if node[0] == "square":
            deviation = a.deviation * (2 * magnitude(first) + a.deviation)
            return _CentredForm(square(a.middle), _scaled_gradient(a.gradient, 2 * first), _rounded_up(deviation))
        if node[0] == "mul":
            gradient = add(_scaled_gradient(a.gradient, last), _scaled_gradient(b.gradient, first))
            deviation = a.deviation * magnitude(last) + b.deviation * magnitude(first) + a.deviation * b.deviation
            return _CentredForm(multiply(a.middle, b.middle), gradient, _rounded_up(deviation))
        plus = node[0] == "add"
        return _CentredForm(
            add(a.middle, b.middle if plus else negative(b.middle)),
            add(a.gradient, b.gradient if plus else negative(b.gradient)), _rounded_up(a.deviation + b.deviation),
        )  # fmt: skip

    def close(self, node: Node, places: Sequence[int], error: Array | None) -> None:
        """Append the mean value form of a node whose operands are the nodes ``places``.

        ``error`` bounds the node's own rounding error and is added to the form; None means that the node is exact.
        """
        form = self.waiting
        inputs, count = self.middle.shape
        zero = np.zeros(count)
        if node[0] == "in":
            gradient = np.zeros((2, inputs, count))
            gradient[:, node[1]] = 1.0
            form = _CentredForm(np.stack([self.middle[node[1]]] * 2), gradient, zero)
        elif node[0] == "const":
            form = _CentredForm(np.full((2, count), float(node[1])), np.zeros((2, inputs, count)), zero)
        elif node[0] == "neg":
            inner = self.forms[places[0]]
            form = (
                None
                if inner is None
                else _CentredForm(negative(inner.middle), negative(inner.gradient), inner.deviation)
            )
        if form is not None and error is not None:
            form.deviation = _rounded_up(form.deviation + error)
        self.forms.append(form)
        self.waiting = None


def _rounded_up(values: Array) -> Array:
    return values * (1 + 2.0**-50)
