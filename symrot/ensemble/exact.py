"""Ensembles in closed form: which trajectories have one, and all of a form in one call.

Trajectories whose numbers are unusual (beyond 1e205, a top that is turned first, an axis that is driven) are made one
by one, each as a motion alone; where no constant varies, they share what the body and its torques give.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.build import cache as library
from symrot.closed_form.arithmetic import double_double as dd
from symrot.closed_form.arithmetic.pairs import LARGEST, SMALLEST, attitude, pair
from symrot.closed_form.registry import Exact, Form, exact_form
from symrot.ensemble.variation import PRINCIPAL, PRODUCTS, Variation
from symrot.propagation.steppers.stepping import Floats
from symrot.scene.scene import Initial

if TYPE_CHECKING:
    from symrot.closed_form.many import Batch

__all__ = ["STEPS_BELOW", "Solved", "choose", "follow_exact", "forms_of"]

Rows = NDArray[np.intp]
MOST_BITS = 62  # of a pattern


def forms_of(variation: Variation) -> list[tuple[Form | None, Rows]]:
    """Return the forms of an ensemble, each with its trajectories; one look at a scene for each pattern of zeros.

    A form is chosen by which components are zero and which moments and coefficients are equal: never by other numbers.
    """
    chosen: dict[Form | None, list[Rows]] = {}
    for rows in _patterns(variation):
        chosen.setdefault(exact_form(variation.scene_of(int(rows[0]))), []).append(rows)
    return [(form, np.sort(np.concatenate(parts))) for form, parts in chosen.items()]


def _patterns(variation: Variation) -> list[Rows]:
    """Return the trajectories in groups with the same zeros and the same equal constants."""
    columns, n = variation.columns, len(variation)
    bits = [variation.omega[:, k] != 0 for k in range(3)]
    bits += [column != 0 for column in columns.values()]
    bits += [one == other for one, other in combinations(columns.values(), 2)]
    bits += [abs(columns[name]) <= variation.negligible for name in columns if name in PRODUCTS]
    bits += [columns[name] == value for name in columns for value in variation.constants_beside(name)]
    summed = len(variation.scene.torques) > 1 and any(variation.places[name].torque >= 0 for name in columns)
    if summed or len(bits) > MOST_BITS:  # sums of constants may vanish too
        return [np.array([i]) for i in range(n)]
    code = np.zeros(n, dtype=np.int64)
    for k, bit in enumerate(bits):
        code |= bit.astype(np.int64) << k
    order = np.argsort(code, kind="stable")
    edges = np.flatnonzero(np.diff(code[order])) + 1
    return np.split(order, edges)


STEPS_BELOW = {"axial": 1000.0, "spin_up": 1500.0, "heavy_top": 100.0}
"""Up to which angle, rad, steps are faster than closed forms that are made one by one; see :func:`choose`."""


class Solved(NamedTuple):
    """Trajectories of one closed form, as arrays if there are such."""

    form: Form
    rows: Rows
    batch: "Batch | None"
    usual: Any  # which rows the arrays are good for


def choose(variation: Variation, times: Floats, start: float, faster: bool) -> list[Solved]:
    """Return the trajectories to be followed in closed form: with ``faster``, those for which steps take longer.

    Measured by ``python -m symrot.bench.starts --ensembles``, for spans of 0.1 to 1000 s and tolerances of 1e-6 and
    1e-12: a closed form made as an array takes 3 to 14 us, less than any steps, which take 5 to 30 us and 0.05 us for
    each rad. Made one by one it takes 40 us (a top whose axes are turned first), 60 us (a rotation about one axis) or
    90 us (a spin-up): then steps are faster up to the angles of :data:`STEPS_BELOW`. The angle is that of the
    trajectory itself, so that its method does not depend on the others.
    """
    found, without_compiler = [], bool(not faster and library.missing())  # steps need one too
    for form, rows in forms_of(variation):
        if form is None:
            continue
        batch, usual = (None, None) if without_compiler else _batch(variation, form, rows)
        if batch is None and faster:
            rows = rows[_angles(variation, times, start)[rows] > STEPS_BELOW.get(form.library, 0.0)]
        if len(rows):
            found.append(Solved(form, rows, batch, usual))
    return found


def _angles(variation: Variation, times: Floats, start: float) -> Floats:
    """Return the angles that bodies turn about at the rate of their start and under constant torques, rad, (n,)."""
    n = len(variation)
    span = np.broadcast_to(abs(times - start).max(axis=-1, initial=0.0), (n,))
    push: Any = np.zeros(n)
    smallest = variation.moments.min(axis=1)
    for k, torque in enumerate(variation.scene.torques):
        if torque.kind == "constant_body":
            for axis in (1, 2, 3):
                value = variation.constant(f"{variation.prefix(k)}torque_{axis}")
                push = push + abs(float(value) if isinstance(value, Fraction) else value)
    with np.errstate(all="ignore"):  # what overflows is far
        angles: Floats = np.sqrt((variation.omega**2).sum(axis=1)) * span + 0.5 * push / smallest * span**2
    return np.nan_to_num(angles, nan=np.inf)


def follow_exact(
    variation: Variation, solved: Solved, times: Floats, start: float, omega: Floats, quaternion: Floats | None,
    workers: int,
) -> None:  # fmt: skip
    """Write angular velocity and attitude of trajectories of one form at times (m,) or (n, m), s."""
    since = times - start if start else times
    form, rows, batch, usual = solved
    whole = len(rows) == len(variation)
    alone: Sequence[int] = range(len(rows))
    if batch is not None:
        from symrot.closed_form.many import evaluate

        own = since if since.ndim == 1 or whole else since[rows]
        shape = len(rows), since.shape[-1]
        rates = omega if whole else np.empty((*shape, 3))
        attitudes = quaternion if whole or quaternion is None else np.empty((*shape, 4))
        odd = evaluate(batch, own, rates, attitudes, workers)
        alone = sorted({*odd, *np.flatnonzero(np.logical_not(usual)).tolist()})
        if not whole:
            omega[rows] = rates
            if quaternion is not None and attitudes is not None:
                quaternion[rows] = attitudes
    motions = _Alone(variation, form)
    for i in rows[list(alone)].tolist():
        found, turned = motions(i).evaluate(since if since.ndim == 1 else since[i], quaternion=quaternion is not None)
        omega[i] = found
        if quaternion is not None:
            quaternion[i] = turned
    _put_starts(variation, rows, times == start, omega, quaternion)


def _put_starts(
    variation: Variation, rows: Rows, at_start: NDArray[np.bool_], omega: Floats, quaternion: Floats | None
) -> None:
    """Write the initial states where times are that of the start: to the last bit, as every method has them."""
    if not at_start.any():
        return
    states = variation.initial_states
    if at_start.ndim == 1:
        at_start = np.broadcast_to(at_start, (len(variation), len(at_start)))
    chosen, sample = np.nonzero(at_start[rows])
    omega[rows[chosen], sample] = states[rows[chosen], :3]
    if quaternion is not None:
        quaternion[rows[chosen], sample] = states[rows[chosen], 3:]


class _Alone:
    """Motions one by one; those of the same form and pattern of zeros share what does not depend on the start."""

    def __init__(self, variation: Variation, form: Form) -> None:
        self._variation, self._form = variation, form
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


def _batch(variation: Variation, form: Form, rows: Rows) -> tuple["Batch | None", Any]:
    """Return the motions as arrays, or None where they are made one by one; and which rows the arrays are good for."""
    make = BATCHES.get(form.library)
    if make is None:
        return None, None
    from symrot.closed_form.batches import usual

    omega = np.ascontiguousarray(variation.omega[rows])
    start = variation.attitudes
    start = np.array(attitude(variation.scene.initial.quaternion)) if start is None else start[rows]
    batch, fine = make(variation, rows, omega, start)
    if batch is None:
        return None, None
    for name in variation.columns:
        size = abs(variation.columns[name][rows])
        fine = fine & (size <= LARGEST) & ((size >= SMALLEST) | (size == 0))
    return batch, fine & usual(omega)


def _free(variation: Variation, rows: Rows, omega: Floats, start: Floats) -> tuple["Batch | None", Any]:
    from symrot.closed_form import batches

    if not variation.columns:
        return batches.free_bodies(variation.scene.body.principal, omega, start), True
    if not variation.in_principal_axes:
        return None, None
    if any(isinstance(x, Fraction) and Fraction(float(x)) != x for x in map(variation.constant, PRINCIPAL)):
        return None, None
    table = variation.moments[rows]
    return batches.free_bodies_of_moments(table, omega, start), table.min(axis=1) > 0


def _doubles(value: Any, rows: Rows) -> Any:
    return float(value) if isinstance(value, Fraction) else value[rows]


def _top(variation: Variation, rows: Rows, omega: Floats, start: Floats) -> tuple["Batch | None", Any]:
    from symrot.closed_form import batches
    from symrot.closed_form.heavy_top.motion import Top

    torque, body = variation.scene.torques[0].values, variation.scene.body
    if not variation.columns:
        moments = [body.inertia[k][k] for k in range(3)]
        top = Top(moments, torque["weight"], torque["center_of_mass"], torque["direction"])
        return (batches.tops(top, omega, start), True) if top.plain else (None, None)
    prefix = variation.prefix(0)
    names = ("weight", *(f"center_of_mass_{k}" for k in (1, 2, 3)))
    constants = {name: variation.constant(f"{prefix}{name}") for name in names}
    direction = torque["direction"]
    sizes = {name: np.broadcast_to(_doubles(x, rows), len(rows)) for name, x in constants.items()}
    if direction[0] or direction[1]:
        return None, None
    pull = np.zeros((len(rows), 2))
    if all(not isinstance(x, Fraction) or Fraction(float(x)) == x for x in constants.values()):
        pull[:, 0], pull[:, 1] = dd.two_product(sizes["weight"], sizes["center_of_mass_3"])
    else:
        weight, height = (constants[name] for name in ("weight", "center_of_mass_3"))
        for k, i in enumerate(rows.tolist()):
            factors = [x if isinstance(x, Fraction) else Fraction(float(x[i])) for x in (weight, height)]
            pull[k] = pair(factors[0] * factors[1])
    plain = (sizes["center_of_mass_1"] == 0) & (sizes["center_of_mass_2"] == 0) & (abs(pull[:, 0]) > SMALLEST)
    plain &= (pull[:, 0] > 0) if direction[2] < 0 else (pull[:, 0] < 0)
    plain &= np.all([(abs(x) < 1e120) & ((x == 0) | (abs(x) > 1e-120)) for x in sizes.values()], axis=0)
    across, own = (variation.constant(name) for name in ("I_xx", "I_zz"))
    across, own = (x if isinstance(x, Fraction) else x[rows] for x in (across, own))
    upright = np.array([1.0, *[0.0] * 7])
    return batches.tops_of(across, own, pull * np.sign(pull[:, :1]), upright, omega, start), plain


def _gyrostat(variation: Variation, rows: Rows, omega: Floats, start: Floats) -> tuple["Batch | None", Any]:
    from symrot.closed_form import batches
    from symrot.closed_form.gyrostat.motion import Gyrostat

    if variation.columns:
        return None, None
    scene = variation.scene
    body = Gyrostat([scene.body.inertia[k][k] for k in range(3)], scene.torques[0].values["angular_momentum"])
    return batches.gyrostats(body, omega, start), True


BATCHES: dict[str, Callable[[Variation, Rows, Floats, Floats], tuple["Batch | None", Any]]] = {
    "free_body": _free,
    "heavy_top": _top,
    "gyrostat": _gyrostat,
}
"""How the trajectories of a form become arrays; those of other forms are made one by one."""
