"""Ensembles in closed form: trajectories whose motions have the same closed form are computed together.

A batch holds the constants of the motions as arrays, from which one call of C computes all samples. Trajectories with
unusual numbers (beyond 1e205, or varying products of inertia close to zero) are computed one by one, as single motions.
"""

from collections.abc import Callable, Hashable, Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form.arithmetic import double_double as dd
from symrot.closed_form.arithmetic.pairs import LARGEST, SMALLEST, attitude, pair
from symrot.closed_form.build import available
from symrot.closed_form.registry import ClosedForm, Exact, exact_form
from symrot.ensemble.variation import PRINCIPAL, PRODUCTS, Variation
from symrot.errors import InputError
from symrot.propagation.steppers.stepping import Floats
from symrot.scene.tables import Initial

if TYPE_CHECKING:
    from symrot.closed_form.many import Batch

__all__ = ["ALONE_LOSES_BELOW", "ARRAYS_LOSE_BELOW", "Solved", "choose", "follow_exact", "forms_of"]

Rows = NDArray[np.intp]
MOST_BITS = 59  # largest number of conditions in a pattern, without the three of the angular velocity


class Kind(NamedTuple):
    """A closed form and the index (0, 1 or 2) of the body axis to which it refers, such as a symmetry axis."""

    form: ClosedForm | None  # None for trajectories without a closed form
    axis: int | None  # None if the form refers to no axis


def forms_of(variation: Variation) -> list[tuple[Kind, Rows]]:
    """Return the closed forms that occur in an ensemble, as pairs (:class:`Kind`, indices of the trajectories)."""
    chosen: dict[Kind, list[Rows]] = {}
    known: dict[Hashable, Kind] = variation.cached("forms", dict)
    for pattern, rows in _patterns(variation):
        kind = known.get(pattern)
        if kind is None:
            # one trajectory of each pattern suffices: the form depends only on zero components and equal constants
            scene = variation.scene_of(int(rows[0]))
            form = exact_form(scene)
            kind = Kind(form, form and form.axis(scene))
            if pattern is not None:
                known[pattern] = kind
        chosen.setdefault(kind, []).append(rows)
    return [(kind, parts[0] if len(parts) == 1 else np.sort(np.concatenate(parts))) for kind, parts in chosen.items()]


def _patterns(variation: Variation) -> list[tuple[Hashable, Rows]]:
    """Return trajectories grouped by which numbers are zero or equal, as pairs (pattern, indices of trajectories).

    All trajectories with one pattern, a hashable key, have the same closed form. Each trajectory is a group of its own,
    with None instead of a pattern, in two cases. The first: a constant varies of a torque that is not the only one of
    its kind, so that the closed form depends on whether sums of constants are zero. The second: so many constants vary
    that a pattern would need more than MOST_BITS conditions.
    """
    columns, n = variation.columns, len(variation)
    code = (variation.omega != 0) @ np.array([1, 2, 4])
    if not columns:
        if (code == code[0]).all():
            return [(int(code[0]), np.arange(n))]
        return [(k, rows) for k in range(8) if len(rows := np.flatnonzero(code == k))]
    # in all trajectories of a group, the same components are zero and the same constants are equal
    bits = [column != 0 for column in columns.values()]
    bits += [one == other for one, other in combinations(columns.values(), 2)]
    bits += [abs(columns[name]) <= variation.negligible for name in columns if name in PRODUCTS]
    bits += [columns[name] == value for name in columns for value in variation.constants_beside(name)]
    kinds = [torque.kind for torque in variation.scene.torques]
    varied = [kinds[place] for name in columns if (place := variation.places[name].torque) >= 0]
    summed = any(kinds.count(kind) > 1 for kind in varied)
    if summed or len(bits) > MOST_BITS:
        return [(None, np.array([i])) for i in range(n)]
    code = code + np.array(bits).T @ (8 << np.arange(len(bits)))
    order = np.argsort(code, kind="stable")
    edges = np.flatnonzero(np.diff(code[order])) + 1
    names = tuple(columns)
    return [((names, int(code[rows[0]])), rows) for rows in np.split(order, edges)]


# Measured times, in microseconds per trajectory of 101 samples, among 400, for rotation by 0.01 to 10^4 rad and
# tolerances of 1e-6 and 1e-12 (`python -m symrot.bench.starts --ensembles` prints them for the spans of the scenes):
#
# - In a batch, a closed form takes 4 to 18 us if only initial states vary and 4 to 29 us if constants vary. Steps up to
#   10 rad take 13 to 46 us in the first case and 33 to 75 us in the second, and more for larger angles. If products of
#   inertia vary, a batch takes 23 us and steps take 280 us.
# - For a symmetric damped body without its attitude, if only initial states vary, a batch takes 12 us and steps take
#   6 to 9 us: there are few steps, because the motion ends.
# - Computed alone, a trajectory takes 1100 us if products of inertia vary and are nearly zero, or if moments of inertia
#   are nearly equal, because its principal axes are computed in fractions. It takes 40 to 80 us for rotation about one
#   axis or spin-up, if constants are too large or too small for a batch.
ARRAYS_LOSE_BELOW = {"symmetric body driven about its axis, angular velocity alone": 1e4}
"""Name of a closed form -> angle of rotation, rad, below which integration of a trajectory in steps is faster.

This limit is used if only initial states vary in the ensemble, so that the closed form is computed for whole arrays of
trajectories; see :func:`choose`.
"""

ALONE_LOSES_BELOW = {"free_body": 1e4, "axial": 1e3, "spin_up": 1e3}
"""Name of a closed form's C library -> angle of rotation, rad, below which integration in steps is faster.

This limit is used where the closed form is computed for one trajectory after the other, not for arrays of them.
"""


class Solved(NamedTuple):
    """Trajectories that one closed form computes: their indices ``rows``, and the constants of the form as arrays."""

    form: ClosedForm
    rows: Rows
    batch: "Batch | None"  # the arrays; None if the trajectories are computed one by one
    # false for numbers so large or small that intermediate results lose digits: these are computed one by one
    in_batch: Any  # whether the batch gives the same bits as a single motion, for each row or for all rows


def choose(variation: Variation, times: Floats, start: float, faster: bool) -> list[Solved]:
    """Return the trajectories of an ensemble to compute in closed form, in groups with equal form.

    All other trajectories are integrated in steps. With ``faster``, steps are also used for a trajectory that has a
    closed form and for which steps are faster.
    """
    solved: list[Solved] = []
    for kind, rows in forms_of(variation):
        if kind.form is None:
            continue
        without_compiler = not available(kind.form.library)
        if without_compiler and faster:  # without a compiler, SciPy makes the steps
            continue
        # only the trajectory's own angle counts, so that the choice does not depend on other trajectories
        least = ARRAYS_LOSE_BELOW.get(kind.form.name) if faster and not variation.columns else None
        if least is not None:
            rows = rows[_angles(variation, times, start)[rows] > least]
        for each, batch, in_batch in [(rows, None, None)] if without_compiler else _batches(variation, kind, rows):
            if batch is None and faster:
                each = each[_angles(variation, times, start)[each] > ALONE_LOSES_BELOW.get(kind.form.library, 0.0)]
            if len(each):
                solved.append(Solved(kind.form, each, batch, in_batch))
    return solved


def _angles(variation: Variation, times: Floats, start: float) -> Floats:
    """Return a rough angle of rotation, rad, of each trajectory from ``start`` to its farthest sample time."""
    # estimated from the initial angular velocity and the constant torques
    n = len(variation)
    span = np.broadcast_to(abs(times - start).max(axis=-1, initial=0.0), (n,))
    push: Any = np.zeros(n)
    smallest = variation.moments.min(axis=1)
    for k, torque in enumerate(variation.scene.torques):
        if torque.kind == "constant_body":
            for axis in (1, 2, 3):
                value = variation.constant(f"{variation.prefix(k)}torque_{axis}")
                push = push + abs(float(value) if isinstance(value, Fraction) else value)
    with np.errstate(all="ignore"):  # an angle that overflows counts as large
        angles: Floats = np.sqrt((variation.omega**2).sum(axis=1)) * span + 0.5 * push / smallest * span**2
    return np.nan_to_num(angles, nan=np.inf)


def follow_exact(
    variation: Variation, solved: Solved, times: Floats, start: float, omega: Floats, quaternion: Floats | None,
    workers: int,
) -> None:  # fmt: skip
    """Write the samples of the trajectories ``solved``, by their closed form, into ``omega`` and ``quaternion``.

    ``quaternion`` is None if no attitude is needed.
    """
    since = times - start if start else times
    form, rows, batch, in_batch = solved
    whole = len(rows) == len(variation)
    alone: Sequence[int] = range(len(rows))
    if batch is not None:
        from symrot.closed_form.many import evaluate

        own = since if since.ndim == 1 or whole else since[rows]
        shape = len(rows), since.shape[-1]
        rates = omega if whole else np.empty((*shape, 3))
        attitudes = quaternion if whole or quaternion is None else np.empty((*shape, 4))
        odd = evaluate(batch, own, rates, attitudes, workers)
        alone = sorted({*odd, *np.flatnonzero(np.logical_not(in_batch)).tolist()})
        if not whole:
            omega[rows] = rates
            if quaternion is not None and attitudes is not None:
                quaternion[rows] = attitudes
    motions = _Alone(variation, form)
    for i in rows[list(alone)].tolist():
        own_rates, turned = motions(i).evaluate(
            since if since.ndim == 1 else since[i], quaternion=quaternion is not None
        )
        omega[i] = own_rates
        if quaternion is not None:
            quaternion[i] = turned
    _put_starts(variation, rows, times == start, omega, quaternion)


def _put_starts(
    variation: Variation, rows: Rows, at_start: NDArray[np.bool_], omega: Floats, quaternion: Floats | None
) -> None:
    """Set the samples of the trajectories ``rows`` at the initial time to their exact initial states."""
    # the formulas would give these samples with rounding errors
    if not at_start.any():
        return
    states = variation.initial_states
    if at_start.ndim == 1:
        own = slice(None) if len(rows) == len(variation) else rows
        for k in np.flatnonzero(at_start).tolist():
            omega[own, k] = states[own, :3]
            if quaternion is not None:
                quaternion[own, k] = states[own, 3:]
        return
    chosen, sample = np.nonzero(at_start[rows])
    omega[rows[chosen], sample] = states[rows[chosen], :3]
    if quaternion is not None:
        quaternion[rows[chosen], sample] = states[rows[chosen], 3:]


class _Alone:
    """A function from the index of a trajectory to its motion in closed form, for trajectories computed one by one."""

    def __init__(self, variation: Variation, form: ClosedForm) -> None:
        self._variation, self._form = variation, form
        # if no constant of the scene varies, the motions share the constants of the body
        self._starts: dict[tuple[bool, ...], Callable[[Initial], Exact]] = {}

    def __call__(self, i: int) -> Exact:
        variation = self._variation
        if variation.columns:
            return self._form.motion(variation.scene_of(i))
        key = tuple((variation.omega[i] != 0).tolist())
        if key not in self._starts:
            self._starts[key] = self._form.starts(variation.scene_of(i))
        return self._starts[key](variation.initial(i))


# ------------------------------------------------------------------------------------------------ arrays of each form

_FAR = 1e100  # quotients of moments, torques and damping between 1/_FAR and _FAR neither over- nor underflow
InBatch = NDArray[np.bool_] | bool
"""Whether a batch computes a trajectory with the same bits as a single motion.

The value is an array with a boolean for each trajectory, or one boolean if it is the same for all.
"""


class _Part(NamedTuple):
    """Trajectories of an ensemble with the same closed form about the same body axis, which one call of C computes."""

    variation: Variation
    axis: int | None
    rows: Rows
    omega: Floats  # (n, 3)

    def of(self, chosen: NDArray[np.bool_]) -> "_Part":
        """Return a :class:`_Part` with only the trajectories k for which ``chosen[k]`` is true."""
        return self._replace(rows=self.rows[chosen], omega=self.omega[chosen])

    @property
    def start(self) -> Floats:
        """The initial quaternions, each component as two doubles (hi, lo): shape (n, 8), or (8,) if all are equal."""
        variation, attitudes = self.variation, self.variation.attitudes
        if attitudes is None:
            own = variation.cached("attitude", lambda: np.array(attitude(variation.scene.initial.quaternion)))
            return own  # type: ignore[no-any-return]
        return attitudes if len(self.rows) == len(variation) else attitudes[self.rows]

    def constant(self, name: str) -> Any:
        """Return the constant ``name``, such as ``weight``: a Fraction, or an array (n,) if it varies."""
        value = self.variation.constant(name)
        return value if isinstance(value, Fraction) else value[self.rows]

    def moments(self) -> tuple[Any, Any]:
        """Return the moments of inertia, kg m^2, about an axis normal to the symmetry axis and about the symmetry axis.

        A moment that varies between the trajectories is an array (n,), otherwise a Fraction.
        """
        assert self.axis is not None
        return self.constant(PRINCIPAL[self.axis - 2]), self.constant(PRINCIPAL[self.axis])


def _batches(variation: Variation, kind: Kind, rows: Rows) -> Iterator[tuple[Rows, "Batch | None", Any]]:
    """Yield groups of the trajectories ``rows``, all of one closed form, as (indices, batch, in_batch).

    ``batch`` has the constants of a group as arrays, and ``in_batch`` tells which of its trajectories are computed with
    these arrays. The others are computed one by one; if ``batch`` is None, these are all trajectories of the group.
    """
    make = BATCHES.get(kind.form.library) if kind.form else None
    if make is None:
        yield rows, None, None
        return
    from symrot.closed_form.batches import fits_batch

    for part in _parts(variation, kind, rows):
        batch, fine = make(part)
        if batch is not None and make is _free and not np.all(fine):
            # principal axes in fractions take long: these motions are evaluated one by one
            clear = np.asarray(fine)
            yield part.rows[~clear], None, None
            if not clear.any():
                continue
            part, batch, fine = part.of(clear), batch.of(clear), True
        if batch is not None:
            for name in variation.columns:
                size = abs(variation.columns[name][part.rows])
                fine = fine & (size <= LARGEST) & ((size >= SMALLEST) | (size == 0))
            fine = fine & fits_batch(part.omega)
        yield part.rows, batch, fine


def _parts(variation: Variation, kind: Kind, rows: Rows) -> Iterator[_Part]:
    """Yield the trajectories ``rows`` in groups, each of which one call of C can compute.

    Usually there is one group. Heavy tops whose centre of mass varies give two groups: in one group the component of
    the centre of mass along the symmetry axis is positive, in the other group it is not. The formulas use different
    axes of space for the two groups.
    """
    groups = [rows]
    if kind.form and kind.form.library == "heavy_top" and variation.columns:
        height = variation.constant(f"{variation.prefix(0)}center_of_mass_{(kind.axis or 0) + 1}")
        if not isinstance(height, Fraction):
            groups = [rows[height[rows] > 0], rows[height[rows] <= 0]]
    for group in groups:
        if len(group):
            yield _Part(variation, kind.axis, group, np.ascontiguousarray(variation.omega[group]))


def _free(part: _Part) -> tuple["Batch | None", InBatch]:
    from symrot.closed_form import batches
    from symrot.closed_form.free_body.motion import FreeRigidBody

    variation = part.variation
    if not variation.columns:
        body = variation.cached("free body", lambda: FreeRigidBody(variation.scene.body.principal))
        return batches.free_bodies(body, part.omega, part.start), True
    if not variation.in_principal_axes:
        entries = [part.constant(name) for name in (*PRINCIPAL, *PRODUCTS)]
        return batches.free_bodies_of_tensors(entries, part.omega, part.start)
    moments = [part.constant(name) for name in PRINCIPAL]
    fine = variation.moments[part.rows].min(axis=1) > 0
    return batches.free_bodies_of_moments(moments, part.omega, part.start), fine


def _doubles(value: Any) -> Any:
    return float(value) if isinstance(value, Fraction) else value


def _top(part: _Part) -> tuple["Batch | None", InBatch]:
    from symrot.closed_form import batches
    from symrot.closed_form.heavy_top.motion import Frame

    assert part.axis is not None
    variation = part.variation
    prefix, torque = variation.prefix(0), variation.scene.torques[0]
    weight, height = (part.constant(f"{prefix}{name}") for name in ("weight", f"center_of_mass_{part.axis + 1}"))
    fine: Any = True
    if isinstance(weight, Fraction) and isinstance(height, Fraction):
        pull = np.array(pair(weight * height))
    else:
        pull = np.empty((len(part.rows), 2))
        if all(not isinstance(x, Fraction) or Fraction(float(x)) == x for x in (weight, height)):
            pull[:, 0], pull[:, 1] = dd.two_product(_doubles(weight), _doubles(height))
        else:
            for k in range(len(part.rows)):
                factors = [x if isinstance(x, Fraction) else Fraction(float(x[k])) for x in (weight, height)]
                pull[k] = pair(factors[0] * factors[1])
        fine = abs(pull[:, 0]) > SMALLEST
        for size in (abs(_doubles(weight)), abs(_doubles(height))):
            fine = fine & (size < 1e120) & (size > 1e-120)
    sign = 1 if pull.flat[0] > 0 else -1
    axis, key = part.axis, (part.axis, sign)
    frame = variation.cached(("frame", key), lambda: Frame(axis, [-sign * x for x in torque.vector("direction")]))
    if frame.plain:
        start = part.start
    elif variation.quaternion is None:
        own = variation.scene.initial.quaternion
        start = variation.cached(("turned attitude", key), lambda: np.array(frame.start(own)))
    else:
        start = batches.turned(frame, variation.quaternion[part.rows])
    return batches.tops(*part.moments(), sign * pull, frame, part.omega, start), fine


def _gyrostat(part: _Part) -> tuple["Batch | None", InBatch]:
    from symrot.closed_form import batches

    assert part.axis is not None
    rotor = part.constant(f"{part.variation.prefix(0)}angular_momentum_{part.axis + 1}")
    return batches.gyrostats(*part.moments(), rotor, part.axis, part.omega, part.start), True


def _driving(part: _Part, kind: str, field: str, axis: int) -> Any:
    """Return the sum, over all torques of a ``kind``, of one component of the vector in their field ``field``.

    For the kind ``"constant_body"`` and the field ``"torque"`` this is component ``axis`` (0 to 2) of the total
    constant torque. The result is an array (n,) if it varies between the trajectories, otherwise a Fraction. It is None
    if it varies and several torques have the kind.
    """
    variation = part.variation
    components = [
        part.constant(f"{variation.prefix(k)}{field}_{axis % 3 + 1}")
        for k, torque in enumerate(variation.scene.torques)
        if torque.kind == kind
    ]
    if all(isinstance(value, Fraction) for value in components):
        return sum(components, Fraction(0))
    # sums of arrays would have to be computed exactly for each trajectory
    return components[0] if len(components) == 1 else None


def _driven(part: _Part) -> tuple["Batch | None", InBatch]:
    from symrot.closed_form import batches
    from symrot.closed_form.axial.compiled import Constants
    from symrot.closed_form.axial.motion import Driven

    axis = part.axis
    assert axis is not None
    push = _driving(part, "constant_body", "torque", axis)
    drags = [_driving(part, "damping", "linear", k) for k in (axis, axis - 1)]
    if any(value is None for value in (push, *drags)):
        return None, False
    inputs = [*part.moments(), push, *drags]
    try:
        if all(isinstance(value, Fraction) for value in inputs):
            moments = [part.constant(name) for name in PRINCIPAL]
            return batches.driven(Driven(moments, axis, push, *drags).constants, part.omega, part.start), True
        bounds = [_doubles(value) for value in inputs]
        if any((np.abs(x) > _FAR).any() for x in bounds) or any(
            (x < 1 / _FAR).any() for x in map(np.array, bounds[:2])
        ):
            return None, False
        columns = [[value] * len(part.rows) if isinstance(value, Fraction) else value.tolist() for value in inputs]
        ratios = [[x.as_integer_ratio() for x in column] for column in columns]
        bodies = [Constants(axis, (a, c), *rest) for a, c, *rest in zip(*ratios, strict=True)]
        return batches.driven(bodies, part.omega, part.start), True
    except InputError:  # caused by one trajectory, whose single motion reports the error
        return None, False


def _spin_up(part: _Part) -> tuple["Batch | None", InBatch]:
    from symrot.closed_form import batches

    assert part.axis is not None
    torque = _driving(part, "constant_body", "torque", part.axis)
    if torque is None:
        return None, False
    return batches.spin_ups(*part.moments(), torque, part.axis, part.omega, part.start), True


BATCHES: dict[str, Callable[[_Part], tuple["Batch | None", InBatch]]] = {
    "free_body": _free,
    "heavy_top": _top,
    "gyrostat": _gyrostat,
    "axial": _driven,
    "spin_up": _spin_up,
}
"""Name of a closed form's C library -> function that prepares some trajectories (a :class:`_Part`) for it.

The function returns (batch, in_batch). ``batch`` are the constants of the trajectories as arrays, or None if the
trajectories must be computed one by one. ``in_batch`` tells, for each trajectory or for all, whether the arrays give
the same bits as the computation of a single motion."""
