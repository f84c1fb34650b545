"""Bounds of the rounding error of one output on many boxes at once: the sum of local errors times derivatives.

A box is one range per input. Going forward, interval arithmetic encloses the exact and the computed value of each
operation. Going backward, it encloses the output's derivatives. Half a unit in the last place bounds the rounding
error of ``+ - * / sqrt``; the error of sin, cos and atan2 is assumed to be at most one unit.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cache
from math import inf, nextafter, pi

import numpy as np
from numpy.typing import NDArray

from symrot.certificates.readback.intended_constants import intended_value
from symrot.certificates.readback.operations import Node
from symrot.certificates.rounding import functions, intervals
from symrot.certificates.rounding.centred import CentredForms
from symrot.certificates.rounding.choices import decide_branches, narrow_to_branch
from symrot.certificates.rounding.intervals import DIGITS, Array
from symrot.certificates.rounding.output_graph import OutputGraph, is_short, operand_places
from symrot.certificates.rounding.region import EVERYWHERE, Region, off_unit
from symrot.errors import CertificateError
from symrot.formula.exact_numbers import PI

__all__ = ["LIBM_ULP", "Evaluation", "evaluate"]

LIBM_ULP = 1.0  # error of sin, cos and atan2, in units in the last place of the exact value


# Let the operations 1 to k be rounded and the others exact. As k grows from 0 to the number of operations, the output
# moves from its exact to its computed value. By the mean value theorem,
#     computed - exact = sum over operations of d(output)/d(result of the operation) * (its rounding error),
# with derivatives between exact and computed values, where each operation acts on computed operands. Conditionals
# compare computed numbers, so the condition of a branch narrows the intervals of computed numbers, which give the
# rounding errors, but not the intervals in which derivatives are evaluated.
# No second-order term is neglected.
@dataclass(frozen=True)
class Evaluation:
    """The bounds of the rounding error on many boxes; every field has one entry for each box."""

    # infinite if there is no bound; -1 if the box contains no point of the region (the allowed inputs)
    bound: Array
    # the node that prevents a finite bound, or -1
    obstacle: NDArray[np.int64]
    # a condition that holds on a part of the box only, or -1
    undecided: NDArray[np.int64]
    # largest absolute value of the output
    value: Array
    # whether an atan2 may jump by 2 pi
    turns: NDArray[np.bool_]


@dataclass
class _ErrorPass:
    """The state of a forward pass over the nodes of a graph: values and error bounds so far, on many boxes."""

    graph: OutputGraph
    boxes: Array  # (2, inputs, n)
    decided: NDArray[np.int8]  # (conditions, n)
    region: Region
    libm_ulp: float
    values: list[Array]
    errors: list[Array | None]
    outside: NDArray[np.bool_]
    centred: CentredForms | None
    cuts: dict[int, NDArray[np.bool_]]  # node of an atan2 -> boxes on which it may jump at its branch cut

    def __post_init__(self) -> None:
        self.precision = self.graph.precision
        self.unit = 2.0 ** -DIGITS[self.precision]

    def rounded(self, exact: Array, factor: float = 1.0) -> tuple[Array, Array]:
        """Return (intervals of the computed values, error bounds) of an operation whose exact results lie in ``exact``.

        An error is at most ``factor`` times half a unit in the last place of the largest result.
        """
        error = intervals.half_ulp(intervals.magnitude(exact), self.precision) * factor
        if factor != 1.0:
            return intervals.widened(exact, error), error
        return intervals.rounded_to(exact, self.precision), error

    def refined(self, node: Node, values: Sequence[Array], plain: Array) -> Array:
        """Return an interval that contains a node's exact result, at most as wide as ``plain``."""
        # ``plain`` follows from the operands' intervals; the mean value form may be narrower
        if self.centred is None:
            return plain
        return self.centred.refined(node, operand_places(node), values, plain)

    def relative(self, exact: Array, units: float, least: float) -> tuple[Array, Array]:
        """Return (intervals of the computed values, error bounds) of a function whose exact values lie in ``exact``.

        An error is at most ``units`` unit roundoffs (2^-53 or 2^-24) of the largest value, plus ``least``: a bound of
        the error that underflow within the function causes, or 0.
        """
        error = intervals.magnitude(exact) * (units * self.unit * (1 + 2.0**-20)) + least
        return intervals.widened(exact, error), error


# --- forward: each function returns the values of a node and a bound of its rounding error, None without error --------

Forward = Callable[[_ErrorPass, Node, Sequence[Array]], tuple[Array, Array | None]]


def _input(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    return state.boxes[:, node[1]], None


def _constant(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    value = intervals.point(float(node[1]), state.boxes.shape[2])
    series = any(relation == "<" for relation, _, _ in state.graph.conditions)
    error = _constant_error(node[1], state.precision, not series)
    if not error:
        return value, None
    return intervals.widened(value, error), np.full(value.shape[1], error)


@cache
def _constant_error(written: Fraction, precision: str, use_intended: bool) -> float:
    """Return a bound of the distance between a constant of the C text, such as 0.3333, and its exact number, 1/3.

    If ``use_intended`` is false, the exact number may be any that rounds to the constant.
    """
    if is_short(written):
        return 0.0
    try:
        # the simple fraction or multiple of pi that the reader of the C text recovers
        intended = intended_value(written, precision) if use_intended else None
    except CertificateError:
        intended = None
    # perhaps a Taylor coefficient: bound the distance to any number that rounds to the constant
    if intended is None:
        return float(intervals.half_ulp(np.array([nextafter(abs(float(written)), inf)]), precision)[0])
    error = abs(written - intended.fraction * (PI if intended.times_pi else 1))
    return float(error) * (1 + 2.0**-50)


def _grid_step(state: _ErrorPass, index: int) -> Array:
    """Return, for each box, a power of two that divides all values of a node; it shows that some sums are exact."""
    node, value = state.graph.nodes[index], state.values[index]
    if node[0] == "const":
        above, below = abs(node[1].numerator), node[1].denominator
        return np.full(value.shape[1], (above & -above) / below if above else inf)
    least = np.where(intervals.contains_zero(value), 0.0, np.abs(value).min(axis=0))
    return intervals.binade(least) * (2 * state.unit)


def _sum(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    a, b = operands[0], operands[1] if node[0] == "add" else intervals.negative(operands[1])
    value, error = state.rounded(state.refined(node, operands, intervals.add(a, b)))
    error = np.minimum(
        error, np.minimum(intervals.magnitude(a), intervals.magnitude(b))
    )  # a and b are floating-point numbers: the rounded sum is at least as near as they are
    near = (a[0] > 0) & (b[1] < 0) & (-2 * b[1] >= a[1]) & (2 * a[0] >= -b[0])  # exact for b/2 <= a <= 2b (Sterbenz)
    near |= (b[0] > 0) & (a[1] < 0) & (-2 * a[1] >= b[1]) & (2 * b[0] >= -a[0])
    step = np.minimum(*(_grid_step(state, i) for i in node[1:]))  # both operands, and so their sum, are multiples of it
    near |= intervals.magnitude(value) * state.unit <= step
    return value, np.where(near, 0.0, error)


def _power_of_two(node: Node) -> bool:
    if node[0] != "const" or not node[1]:
        return False
    above, below = abs(node[1].numerator), node[1].denominator
    return bool(above & (above - 1) == 0 and below & (below - 1) == 0)


def _product(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    value, error = state.rounded(state.refined(node, operands, intervals.multiply(*operands)))
    factors = [state.graph.nodes[i] for i in node[1:]]
    scaled = [factor for factor in factors if _power_of_two(factor)]
    if scaled:  # exact, except for results below the least normal number
        return value, np.full_like(error, intervals.ETA) if abs(scaled[0][1]) < 1 else None
    return value, error


def _square(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    return state.rounded(state.refined(node, operands, intervals.square(operands[0])))


def _quotient(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    return state.rounded(intervals.divide(*operands))


def _root(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    return state.rounded(intervals.square_root(operands[0]))


def _sign(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    a = operands[0]
    if node[0] == "neg":
        return intervals.negative(a), None
    size = np.stack([np.where(intervals.contains_zero(a), 0.0, np.abs(a).min(axis=0)), np.abs(a).max(axis=0)])
    if node[0] == "abs":
        return size, None
    b = operands[1]
    # The sign of a computed zero says nothing: 0.0*(-1.0) is -0.0. The sign of an input is exact.
    largest = size[1] if state.graph.exact[node[2]] else np.full_like(size[1], inf)
    either = np.stack([-largest, largest])
    return np.where(b[0] > 0, size, np.where(b[1] < 0, intervals.negative(size), either)), None


def _circular(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    enclosure = functions.sine if node[0] == "sin" else functions.cosine
    value, error = state.rounded(enclosure(operands[0]), 2 * state.libm_ulp)
    return np.clip(value, -1.0, 1.0), error


def _angle(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    y, x = operands
    if state.region.clearance:
        length = intervals.add(intervals.square(y), intervals.square(x))
        state.outside |= length[1] < state.region.clearance**2
    state.cuts[len(state.values)] = intervals.contains_zero(y) & (x[0] < 0)
    value, error = state.rounded(np.clip(functions.arc_tangent(y, x), -pi, pi), 2 * state.libm_ulp)
    if not state.region.clearance:  # the angle of (0, 0) is not defined, and C computes 0 or pi by the sign of a zero
        undefined = intervals.contains_zero(y) & intervals.contains_zero(x)
        value = np.where(undefined, np.array([[-inf], [inf]]), value)
    return value, error


def _error_of_root(state: _ErrorPass, operands: Sequence[Array], total: Array) -> Array:
    """Return a bound of the error of sqrt(a^2 + b^2 + ..) that comes from rounding the squares and their sum."""
    # ``operands`` are intervals of a, b, .., ``total`` those of the sum
    squares = [intervals.half_ulp(intervals.magnitude(intervals.square(part)), state.precision) for part in operands]
    size = intervals.magnitude(total) * (1 + len(operands) * 2.0**-22)  # bound of a partial sum, its rounding included
    error = sum(squares, (len(operands) - 1) * intervals.half_ulp(size, state.precision))
    least = np.sqrt(np.maximum(total[0] - error, 0.0))
    # infinite near zero
    return np.where(least > 0, error / (2 * least), inf) * (1 + 2.0**-40)


def _norm(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    total = intervals.square(operands[0])
    for part in operands[1:]:
        total = intervals.add(total, intervals.square(part))
    least = {"binary64": 1e-161, "binary32": 1e-22}[state.precision]  # squares below the least normal number
    root = intervals.square_root(total)
    value, error = state.relative(root, node[1] / 2, least)
    error = np.minimum(error, _error_of_root(state, operands, total))
    rounding = intervals.half_ulp(intervals.magnitude(value), state.precision)
    value = intervals.rounded_to(intervals.widened(value, rounding), state.precision)
    return np.stack([np.maximum(value[0], 0.0), value[1]]), error + rounding


def _sinc(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    exact = functions.sinc(operands[0])
    sine = intervals.magnitude(functions.sine(operands[0]))
    size = np.where(intervals.contains_zero(operands[0]), 0.0, np.abs(operands[0]).min(axis=0))
    with np.errstate(divide="ignore"):
        of_sine = 2 * state.libm_ulp * intervals.half_ulp(sine, state.precision) / size
    of_sine = np.fmin(of_sine, intervals.magnitude(exact) * (2 * state.libm_ulp * state.unit)) * (1 + 2.0**-20)
    value = intervals.widened(exact, of_sine)
    rounding = intervals.half_ulp(intervals.magnitude(value), state.precision)
    return intervals.widened(value, rounding), of_sine + rounding


def _arc_ratio(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    s, c = operands
    value, _, _ = functions.arc_ratio_terms(s, c, _length(s, c))
    return state.relative(value, 2 * state.libm_ulp + 1, 0.0)


GAP_END = 8.0  # largest |x| for which the error of a gap function is tabulated
GAP_CELLS = 8192


@cache
def _gap_errors(own: OutputGraph, libm_ulp: float) -> tuple[Array, ...]:
    """Return error bounds of a function such as (x - sin x)/x^3 for 0 <= x <= GAP_END, cut into equal cells.

    Entry i of array k is the bound on the 2^k cells that begin with cell i.
    """
    ends = np.linspace(0.0, GAP_END, GAP_CELLS + 1)
    boxes = np.stack([ends[:-1], ends[1:]])[:, None]
    sides = [evaluate(own, boxes, np.full((1, GAP_CELLS), side, np.int8), libm_ulp=libm_ulp).bound for side in (0, 1)]
    # two entries cover any range within [0, GAP_END]
    levels = [np.maximum(*sides)]
    while levels[-1].size > 1:
        step = 2 ** (len(levels) - 1)
        levels.append(np.maximum(levels[-1][:-step], levels[-1][step:]) if levels[-1].size > step else levels[-1][:1])
    return tuple(levels)


def _gap(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    levels = _gap_errors(node[2], state.libm_ulp)
    size = intervals.magnitude(operands[0])
    least = np.where(intervals.contains_zero(operands[0]), 0.0, np.abs(operands[0]).min(axis=0))
    inside = size < GAP_END
    first = np.floor(np.where(inside, least, 0.0) * (GAP_CELLS / GAP_END)).astype(np.int64)
    last = np.floor(np.where(inside, size, 0.0) * (GAP_CELLS / GAP_END)).astype(np.int64)
    level = np.frexp((last - first + 1).astype(np.float64))[1] - 1  # 2^level <= number of cells
    error = np.full(size.size, inf)
    for k, values in enumerate(levels):
        here = inside & (level == k)
        error[here] = np.maximum(values[first[here]], values[last[here] - 2**k + 1])
    return intervals.widened(_GAP_VALUES[node[1]](operands[0]), error), error


_GAP_VALUES = {"sine_gap": functions.sine_gap, "tangent_gap": functions.tangent_gap}
_GAP_SLOPES = {"sine_gap": functions.sine_gap_slope, "tangent_gap": functions.tangent_gap_slope}


def _length(a: Array, b: Array) -> Array:
    return intervals.square_root(intervals.add(intervals.square(a), intervals.square(b)))


def _choice(state: _ErrorPass, node: Node, operands: Sequence[Array]) -> tuple[Array, Array | None]:
    decision = state.decided[node[1]]
    value = np.where(decision == 1, operands[0], np.where(decision == 0, operands[1], intervals.hull(*operands)))
    if state.graph.conditions[node[1]][0] != "<":
        return value, None
    left_out = intervals.magnitude(operands[0]) * _truncation_error(state.precision)
    return intervals.widened(value, left_out), np.where(decision == 0, 0.0, left_out)


def _truncation_error(precision: str) -> float:
    """Return a bound of the relative error of any Taylor series that the C text computes near zero."""
    # a quarter of the unit roundoff: the proof of the C text accepts only series whose omitted terms sum to less
    return 2.0 ** -(DIGITS[precision] + 2) * (1 + 2.0**-20)


FORWARD: dict[str, Forward] = {
    "in": _input, "const": _constant, "add": _sum, "sub": _sum, "mul": _product, "square": _square, "div": _quotient,
    "sqrt": _root, "neg": _sign, "abs": _sign, "copysign": _sign, "sin": _circular, "cos": _circular, "atan2": _angle,
    "norm": _norm, "sinc": _sinc, "arc_ratio": _arc_ratio, "gap": _gap, "select": _choice,
}  # fmt: skip

# --- backward: from d(output)/d(node), the derivatives of the output with respect to the node's operands --------------

_multiply = intervals.multiply_loosely


def _from_sum(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    return [adjoint, adjoint if state.graph.nodes[index][0] == "add" else intervals.negative(adjoint)]


def _from_product(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    a, b = state.graph.nodes[index][1:]
    return [_multiply(adjoint, state.values[b]), _multiply(adjoint, state.values[a])]


def _from_square(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    return [_multiply(adjoint, 2 * state.values[state.graph.nodes[index][1]])]


def _from_quotient(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    a, b = (state.values[i] for i in state.graph.nodes[index][1:])
    by_above = intervals.divide(adjoint, b)
    return [by_above, intervals.negative(_multiply(by_above, intervals.divide(a, b)))]


def _from_root(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    root = intervals.square_root(state.values[state.graph.nodes[index][1]])
    return [intervals.divide(adjoint, 2 * root)]


def _from_sign(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    node = state.graph.nodes[index]
    if node[0] == "neg":
        return [intervals.negative(adjoint)]
    size = intervals.magnitude(adjoint)
    either = np.stack([-size, size])
    a = state.values[node[1]]
    if node[0] == "abs":
        return [np.where(a[0] >= 0, adjoint, np.where(a[1] <= 0, intervals.negative(adjoint), either))]
    return [either, np.zeros_like(adjoint)]


def _from_sine(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    return [_multiply(adjoint, functions.cosine(state.values[state.graph.nodes[index][1]]))]


def _from_cosine(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    return [intervals.negative(_multiply(adjoint, functions.sine(state.values[state.graph.nodes[index][1]])))]


def _from_angle(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    y, x = (state.values[i] for i in state.graph.nodes[index][1:])
    return [
        _multiply(adjoint, functions.arc_slope(x, y)),
        intervals.negative(_multiply(adjoint, functions.arc_slope(y, x))),
    ]


def _from_norm(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    parts = [state.values[i] for i in state.graph.nodes[index][2:]]
    total = intervals.square(parts[0])
    for part in parts[1:]:
        total = intervals.add(total, intervals.square(part))
    root = intervals.square_root(total)
    derivatives = []
    for part in parts:
        slope = intervals.divide(part, root)
        bounded = np.where(np.isfinite(slope), np.clip(slope, -1.0, 1.0), np.array([[-1.0], [1.0]]))
        derivatives.append(_multiply(adjoint, bounded))
    return derivatives


def _from_sinc(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    return [_multiply(adjoint, functions.sinc_slope(state.values[state.graph.nodes[index][1]]))]


def _from_arc_ratio(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    s, c = (state.values[i] for i in state.graph.nodes[index][1:])
    _, by_s, by_c = functions.arc_ratio_terms(s, c, _length(s, c))
    return [_multiply(adjoint, by_s), _multiply(adjoint, by_c)]


def _from_gap(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    node = state.graph.nodes[index]
    return [_multiply(adjoint, _GAP_SLOPES[node[1]](state.values[node[3]]))]


def _from_choice(state: _ErrorPass, index: int, adjoint: Array) -> list[Array]:
    decision = state.decided[state.graph.nodes[index][1]]
    return [np.where(decision != 0, adjoint, 0.0), np.where(decision != 1, adjoint, 0.0)]


BACKWARD: dict[str, Callable[[_ErrorPass, int, Array], list[Array]]] = {
    "add": _from_sum, "sub": _from_sum, "mul": _from_product, "square": _from_square, "div": _from_quotient,
    "sqrt": _from_root, "neg": _from_sign, "abs": _from_sign, "copysign": _from_sign, "sin": _from_sine,
    "cos": _from_cosine, "atan2": _from_angle, "norm": _from_norm, "sinc": _from_sinc, "arc_ratio": _from_arc_ratio,
    "gap": _from_gap, "select": _from_choice,
}  # fmt: skip


def evaluate(
    graph: OutputGraph, boxes: Array, decided: NDArray[np.int8], region: Region = EVERYWHERE,
    libm_ulp: float = LIBM_ULP, centred: bool = False,
) -> Evaluation:  # fmt: skip
    """Return bounds of the rounding error of an output, one bound for each box.

    Parameters
    ----------
    graph : OutputGraph
        The computation of the output.
    boxes : ndarray, shape (2, inputs, n)
        Least and largest value of each input.
    decided : ndarray of int8, shape (conditions, n)
        The branch of each condition on each box: 1 if the relation holds, 0 if not, -1 if both are possible.
    region : Region
        Restrictions of the inputs; a box without a point of the region gets the bound -1.
    libm_ulp : float
        Largest error of sin, cos and atan2, in units in the last place.
    centred : bool
        Enclose polynomials by mean value forms (the value at the middle of a box plus slopes on the box times
        deviations from the middle), which is tighter and slower.
    """
    count = boxes.shape[2]
    state = _ErrorPass(graph, boxes, decided.copy(), region, libm_ulp, [], [], np.zeros(count, bool),
                   CentredForms(boxes) if centred else None, {})  # fmt: skip
    undecided = np.full(count, -1, np.int64)
    waiting: dict[int, list[int]] = {}
    for number, (_, i, j) in enumerate(graph.conditions):
        waiting.setdefault(max(i, j), []).append(number)
    computed = replace(state, values=[], outside=state.outside.copy(), cuts={}) if graph.conditions else state
    with np.errstate(all="ignore"):
        state.outside |= off_unit(boxes, region, graph.places)
        for index, node in enumerate(graph.nodes):
            state.errors.append(_forward_pass(state, computed, node))
            for number in waiting.get(index, ()):
                relation, i, j = graph.conditions[number]
                excluded, open_ = decide_branches(
                    relation, computed.values[i], computed.values[j], state.decided[number]
                )
                state.outside |= excluded
                undecided = np.where((undecided < 0) & open_, number, undecided)
                narrow_to_branch(graph, number, state.decided[number], computed.values)
        bound, obstacle, turns = _backward_pass(state)
    bound = np.where((obstacle >= 0) | (undecided >= 0), inf, bound)
    bound = np.where(state.outside, -1.0, bound)
    return Evaluation(bound, obstacle, undecided, intervals.magnitude(state.values[-1]), turns & ~state.outside)


def _forward_pass(state: _ErrorPass, computed: _ErrorPass, node: Node) -> Array | None:
    """Append intervals of a node's value to ``state.values`` and ``computed.values``; return a bound of its error.

    The interval in ``state.values`` contains the exact value and the computed, rounded value. The interval in
    ``computed.values`` contains the computed value and may be narrower. In a graph without branches, ``computed`` is
    the same object as ``state``. The bound is None for an operation without rounding error.
    """
    value, error = FORWARD[node[0]](state, node, [state.values[i] for i in operand_places(node)])
    state.values.append(value)
    if state.centred is not None:
        state.centred.close(node, operand_places(node), error)
    if computed is not state:
        # narrower: a box assumes the branches that computed values take, and exact values close to a border may lie on
        # its other side
        computed_value, error = FORWARD[node[0]](computed, node, [computed.values[i] for i in operand_places(node)])
        both = np.stack([np.maximum(value[0], computed_value[0]), np.minimum(value[1], computed_value[1])])
        computed.values.append(np.where(both[0] <= both[1], both, value))
    return error


def _backward_pass(state: _ErrorPass) -> tuple[Array, NDArray[np.int64], NDArray[np.bool_]]:
    """Return, for each box, the error bound, the node that makes it infinite, and whether an atan2 may jump by 2 pi."""
    nodes = state.graph.nodes
    count = state.boxes.shape[2]
    adjoints: list[Array | None] = [None] * len(nodes)
    adjoints[-1] = intervals.point(1.0, count)
    used = [np.zeros(count, bool) for _ in nodes]
    used[-1][:] = True
    bound, of_value = np.zeros(count), np.full(count, -1, np.int64)
    of_slope, turns = of_value, np.zeros(count, bool)
    combine = intervals.add if state.graph.conditions else lambda a, b: intervals.widened(a + b, 0.0)
    for index in range(len(nodes) - 1, -1, -1):
        adjoint, error, here = adjoints[index], state.errors[index], used[index]
        if adjoint is None:
            continue
        of_value = np.where(here & ~np.isfinite(state.values[index]).all(axis=0), index, of_value)
        if error is not None:
            bound = bound + np.where(here & (error != 0), intervals.magnitude(adjoint) * error, 0.0)
        kind = nodes[index][0]
        if index in state.cuts:
            # the output's error is then meant modulo 2 pi, so its derivative must be 1 or -1
            jumps = here & state.cuts[index]
            turns |= jumps
            of_value = np.where(jumps & ~((adjoint[0] == adjoint[1]) & (np.abs(adjoint[0]) == 1)), index, of_value)
        if kind not in BACKWARD:
            continue
        clear = (of_slope < 0) & here & np.isfinite(adjoint).all(axis=0)
        decision = state.decided[nodes[index][1]] if kind == "select" else None
        for branch, (place, part) in enumerate(
            zip(operand_places(nodes[index]), BACKWARD[kind](state, index, adjoint), strict=True)
        ):
            # a node that no possible branch uses may have any value
            active = here if decision is None else here & (decision != branch)
            used[place] |= active
            of_slope = np.where(clear & active & ~np.isfinite(part).all(axis=0), index, of_slope)
            known = adjoints[place]
            part = np.where(active, part, 0.0)
            adjoints[place] = part if known is None else combine(known, part)
    whole = bound * (1 + 2.0**-52 * (2 * len(nodes) + 4)) + 1e-320 * len(nodes) * (bound > 0)
    # -1 if the bound is finite; the bound is the sum of local errors times derivatives
    obstacle = np.where(of_value >= 0, of_value, np.where(np.isfinite(whole), -1, of_slope))
    obstacle = np.where((obstacle < 0) & ~np.isfinite(whole), len(nodes) - 1, obstacle)
    return np.where(of_value >= 0, inf, whole), obstacle, turns
