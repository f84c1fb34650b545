"""Variations: the checked arrays that describe an ensemble, and a plan (choice of equations) valid for all of it.

A column is the array of the values of one constant, one value per trajectory. The place of a constant is its position
in the scene: in the inertia tensor, or in a field of a torque.
"""

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import combinations
from typing import Any, NamedTuple
from weakref import finalize

import numpy as np
from numpy.typing import ArrayLike, NDArray

from symrot.dynamics.structure import FormulaTorque, Pattern, Structure, component_names
from symrot.dynamics.torque_kinds import TORQUE_KINDS
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.inertia.principal import principal_axes, require_admissible, why_not_propagable
from symrot.kinematics.conversions import dcm_to_quaternion, quaternion_to_dcm
from symrot.planning.general_structure import general_structure, switched
from symrot.planning.plan import Plan, make_plan
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers.stepping import Floats
from symrot.scene.attitude import ORTHOGONAL, refuse_two
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = [
    "FIXED", "PLACES", "Place", "Variation", "constant_places", "own_rates", "read_times", "read_variation", "to_body",
]  # fmt: skip

PLACES = {"I_xx": (0, 0), "I_yy": (1, 1), "I_zz": (2, 2), "I_xy": (0, 1), "I_xz": (0, 2), "I_yz": (1, 2)}
PRINCIPAL = ("I_xx", "I_yy", "I_zz")
PRODUCTS = ("I_xy", "I_xz", "I_yz")
CLEARLY = 1e-12  # difference, relative to the largest moment, that is certain in doubles
FIXED = {"direction": "rotate the initial quaternions instead", "attitude": "rotate the initial quaternions instead"}
SIGNS = {  # test of the sign that a field requires, for each trajectory: shape (n, k) -> (n,)
    "positive": lambda values: (values > 0).all(axis=1),
    "nonnegative": lambda values: (values >= 0).all(axis=1),
    "nonzero": lambda values: (values != 0).any(axis=1),
}
GENERAL_START = Initial(  # initial state without special values, so that no rule of the planner applies to it
    (Fraction(3, 7), Fraction(5, 11), Fraction(7, 13)),
    (Fraction(1, 5), Fraction(2, 5), Fraction(4, 5), Fraction(2, 5)),
)
BY_ZEROS = {"gravity", "rotor", "constant_body", "damping"}
"""Kinds of torques whose numbers affect the plan only by being zero or not."""

DISTINCT = (Fraction(4), Fraction(5), Fraction(6))  # different moments that satisfy the triangle inequalities


_caches: dict[int, dict[Hashable, Any]] = {}  # cached values of scenes by their ids, deleted with the scene


class Place(NamedTuple):
    """The position of a constant in a scene: in the inertia tensor, or in a field of a torque."""

    # component 3 of center_of_mass of the first torque is (0, "center_of_mass", 2)
    torque: int  # -1: the inertia
    field: str
    entry: int | str | None  # index in a vector, name of a parameter; None: the field is a number


@dataclass(frozen=True)
class Variation:
    """What differs between the n trajectories of an ensemble: initial states, and columns of varying constants."""

    scene: Scene
    omega: Floats  # (n, 3), rad/s, body components
    quaternion: Floats | None  # (n, 4), of any norm but zero; None: the scene's own
    columns: dict[str, Floats]  # (n,) each, by the name of the constant in plans, such as weight or I_xx
    places: dict[str, Place]

    def __len__(self) -> int:
        return len(self.omega)

    def of(self, rows: NDArray[np.intp]) -> "Variation":
        """Return the variation of only the trajectories with the indices ``rows``."""
        quaternion = None if self.quaternion is None else self.quaternion[rows]
        columns = {name: column[rows] for name, column in self.columns.items()}
        return replace(self, omega=self.omega[rows], quaternion=quaternion, columns=columns)

    def scene_of(self, i: int) -> Scene:
        """Return the scene of trajectory i: the common scene with this trajectory's initial state and constants."""
        # doubles become fractions of exactly the same value
        return self._with(self.initial(i), {name: Fraction(float(column[i])) for name, column in self.columns.items()})

    def initial(self, i: int) -> Initial:
        """Return the initial state of trajectory i; its quaternion is divided by its norm."""
        # doubles become fractions of exactly the same value
        x, y, z = map(Fraction, self.omega[i].tolist())
        if self.quaternion is None:
            return Initial((x, y, z), self.scene.initial.quaternion)
        return Initial((x, y, z), _unit(self.quaternion[i].tolist()))

    def cached(self, key: Hashable, make: Callable[[], Any]) -> Any:
        """Return the value that is cached under ``key`` for the scene; on first use, ``make()`` computes it."""
        # the value may depend only on the scene: all ensembles of the scene share it
        place = id(self.scene)
        values = _caches.get(place)
        if values is None:
            values = _caches[place] = {}
            finalize(self.scene, _caches.pop, place, None)
        if key not in values:
            values[key] = make()
        return values[key]

    @cached_property
    def attitudes(self) -> Floats | None:
        """Initial unit quaternions, each component as two doubles (hi, lo), shape (n, 8); None if they do not vary."""
        from symrot.closed_form.batches import attitudes

        return None if self.quaternion is None else attitudes(self.quaternion)

    @cached_property
    def initial_states(self) -> Floats:
        """Initial angular velocity and unit quaternion of each trajectory, rounded to doubles, shape (n, 7)."""
        states = np.empty((len(self), 7))
        states[:, :3] = self.omega
        own = [float(q) for q in self.scene.initial.quaternion]
        states[:, 3:] = own if self.attitudes is None else self.attitudes[:, ::2]
        return states

    @property
    def in_principal_axes(self) -> bool:
        """Whether the products of inertia are zero in every trajectory."""
        fixed = all(self.scene.body.inertia[i][j] == 0 for name, (i, j) in PLACES.items() if name not in PRINCIPAL)
        return fixed and not any(self.columns[name].any() for name in self.columns if name in PRODUCTS)

    def constant(self, name: str) -> Fraction | Floats:
        """Return the constant ``name``, such as ``weight``: a Fraction, or an array (n,) if it varies."""
        if name in self.columns:
            return self.columns[name]
        torque, field, entry = self.places[name]
        if torque < 0:
            i, j = PLACES[name]
            return self.scene.body.inertia[i][j]
        return self.scene.torques[torque].constant(*_constant_place(field, entry))

    def prefix(self, torque: int) -> str:
        """Return the prefix of the names of a torque's constants: ``"torque2_"``, or ``""`` if the names are unique.

        ``torque`` is the number of the torque, from 0.
        """
        structure: Structure = self.cached("structure", lambda: general_structure(self.scene))
        return structure.torques[torque].prefix

    def constants_beside(self, name: str) -> list[float]:
        """Return the constants in the vector or tensor of ``name`` that do not vary: I_yy, I_zz, I_xy, .. for I_xx."""
        place = self.places[name]
        same = [key for key, other in self.places.items() if other[:2] == place[:2] and key not in self.columns]
        values = {self.constant(key) for key in same if not isinstance(self.places[key].entry, str)}
        # varying doubles are compared with them; a constant that no double equals, up to 2^-200, is left out
        return [float(x) for x in values if isinstance(x, Fraction) and number.equal(Fraction(float(x)), x)]

    @property
    def negligible(self) -> Floats:
        """The limit, kg m^2, up to which products of inertia count as zero, for each trajectory, shape (n,)."""
        bounds: Floats = np.ldexp(abs(self.moments).max(axis=1), -number.NEGLIGIBLE_BITS)
        return bounds

    @property
    def moments(self) -> Floats:
        """The moments I_xx, I_yy and I_zz of each trajectory, kg m^2, rounded to doubles, shape (n, 3)."""
        moments = np.empty((len(self), 3))
        for k, name in enumerate(PRINCIPAL):
            value = self.constant(name)
            moments[:, k] = float(value) if isinstance(value, Fraction) else value
        return moments

    def _with(self, start: Initial, values: Mapping[str, Fraction]) -> Scene:
        if not values:
            return replace(self.scene, initial=start)
        body, torques = self.scene.body, list(self.scene.torques)
        tensor = [list(row) for row in body.inertia]
        for name, value in values.items():
            torque, field, entry = self.places[name]
            if torque < 0:
                i, j = PLACES[name]
                tensor[i][j] = tensor[j][i] = value
                continue
            torques[torque] = torques[torque].with_constant(*_constant_place(field, entry), value)
        if not PLACES.keys().isdisjoint(values):
            (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor
            inertia = (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)
            body = body._replace(inertia=inertia, principal=principal_axes(tensor), parts=())
        return replace(self.scene, initial=start, body=body, torques=tuple(torques))

    def plan(self) -> Plan:
        """Return a plan (the choice of equations and states) that is valid for all trajectories."""
        # the plan uses zero or equal constants only if they are zero or equal in every trajectory
        values = {name: _representative(column) for name, column in self.columns.items()}
        if not PLACES.keys().isdisjoint(values):
            values |= self._representative_inertia()
        if not {self.scene.torques[place.torque].kind for place in self._varied if place.torque >= 0} <= BY_ZEROS:
            return self._planned(values)
        moments = [(name, values[name]) for name in PLACES if name in values]
        zeros = [(name, not values[name]) for name in self.columns if name not in PLACES]
        plan: Plan = self.cached(("plan", *moments, *zeros), lambda: self._planned(values))
        return plan

    def patterns(self) -> list[NDArray[np.intp]]:
        """Return the trajectories grouped by their plans (choices of equations), as arrays of indices."""
        # only the trajectory's own constants count: which are zero, and which moments are equal
        bits = [column != 0 for column in self.columns.values()]
        if not PLACES.keys().isdisjoint(self.columns):
            moments = [self.constant(name) for name in PRINCIPAL]
            bits += [np.asarray(_equal(one, other)) for one, other in combinations(moments, 2)]
        if not bits:
            return [np.arange(len(self))]
        table = np.stack(np.broadcast_arrays(*bits, np.zeros(len(self), dtype=bool)), axis=1)
        if (table == table[0]).all():
            return [np.arange(len(self))]
        _, group = np.unique(table, axis=0, return_inverse=True)
        return [np.flatnonzero(group.ravel() == k) for k in range(int(group.max()) + 1)]

    @property
    def _varied(self) -> list[Place]:
        return [self.places[name] for name in self.columns]

    def _planned(self, values: Mapping[str, Fraction]) -> Plan:
        return make_plan(self._with(GENERAL_START, values), switched=switched(self.scene))

    def _representative_inertia(self) -> dict[str, Fraction]:
        """Return the entries, by name, of one inertia tensor from which a plan for all trajectories is made."""
        # its moments are equal and its products zero only if they are so in every trajectory
        inertia = self.scene.body.inertia
        tensor: dict[str, Fraction] = {}
        for k, name in enumerate(PRINCIPAL):
            same = next((j for j in range(k) if self._agree(PRINCIPAL[j], name)), k)
            tensor[name] = tensor[PRINCIPAL[same]] if same < k else DISTINCT[k]
        for k, name in enumerate(name for name in PLACES if name not in PRINCIPAL):
            i, j = PLACES[name]
            present = self.columns[name].any() if name in self.columns else inertia[i][j] != 0
            tensor[name] = Fraction(k + 1, 10) if present else Fraction(0)
        return tensor

    def _agree(self, one: str, other: str) -> bool:
        """Return whether two moments, such as ``"I_xx"`` and ``"I_yy"``, are equal in every trajectory."""
        own = [self.scene.body.inertia[PLACES[name][0]][PLACES[name][1]] for name in (one, other)]
        if one not in self.columns and other not in self.columns:
            return number.equal(*own)
        left, right = (self.columns.get(name, float(value)) for name, value in zip((one, other), own, strict=True))
        return bool(np.all(left == right))


def _equal(one: Fraction | Floats, other: Fraction | Floats) -> Any:
    """Return whether two constants are equal: one bool, or an array with one entry per trajectory if one varies."""
    if isinstance(one, Fraction) and isinstance(other, Fraction):
        return number.equal(one, other)  # up to 2^-200 of their size
    left, right = (float(value) if isinstance(value, Fraction) else value for value in (one, other))
    return left == right


def _constant_place(field: str, entry: int | str | None) -> tuple[str, int | None]:
    """Return the arguments (name, component) with which :class:`Torque` finds the constant at a :class:`Place`.

    ``("center_of_mass", 2)`` is unchanged; ``("parameters", "k")`` gives ``("k", None)``.
    """
    return (entry, None) if isinstance(entry, str) else (field, entry)


def _unit(row: list[float]) -> tuple[Fraction, Fraction, Fraction, Fraction]:
    """Return a quaternion of four doubles divided by its norm, as fractions.

    The norm of the result differs from 1 by less than 2^-200.
    """
    q0, q1, q2, q3 = number.unit([Fraction(value) for value in row])
    return q0, q1, q2, q3


def _representative(column: Floats) -> Fraction:
    """Return one value of a column, zero only if all are zero: ``[0, 3, 4]`` gives 3."""
    # a plan is made from it for all trajectories, and makes use of zeros
    return Fraction(float(column[np.argmax(column != 0)]))


# ------------------------------------------------------------------------------------------------ reading


def read_variation(
    scene: Scene,
    omega: ArrayLike | None,
    quaternion: ArrayLike | None,
    parameters: Mapping[str, ArrayLike] | None,
    attitude: Any = None,
) -> Variation:
    """Return the variation that the arguments of an ensemble describe; for None, the value in the scene is used.

    Raises
    ------
    InputError
        If an array has a wrong shape, a value is not finite, a quaternion is zero, a name is unknown, or no body can
        have the moments of inertia.
    """
    if parameters is not None and not isinstance(parameters, Mapping):
        raise InputError(f"parameters: expected a dict of arrays by name, got {number.show(parameters)}")
    refuse_two(attitude, quaternion)
    if attitude is not None:
        quaternion = _quaternions(attitude)
    places = constant_places(scene)
    arrays: dict[str, Floats] = {}
    if omega is not None:
        arrays["omega"] = _array(omega, (3,), "omega", "rad/s")
    if quaternion is not None:
        arrays["quaternion"] = _array(quaternion, (4,), "quaternion", "1")
    columns: dict[str, Floats] = {}
    for name, values in (parameters or {}).items():
        own_columns = _columns(scene, places, name, values)
        twice = next((other for other in own_columns if other in columns), None)
        if twice is not None:
            raise InputError(f"parameters: expected each constant once, got {twice} a second time, in {name!r}")
        columns |= own_columns
        arrays[name] = next(iter(own_columns.values()))
    counts = {name: len(array) for name, array in arrays.items()}
    if len(set(counts.values())) > 1:
        listed = ", ".join(f"{count} of {name}" for name, count in counts.items())
        raise InputError(f"ensemble: expected the same number of trajectories in every array, got {listed}")
    n = next(iter(counts.values()), 1)
    if n == 0:
        raise InputError("ensemble: expected at least one trajectory, got arrays of length 0")
    attitudes = arrays.get("quaternion")
    if attitudes is not None and not attitudes.any(axis=1).all():
        at = int(np.argmin(attitudes.any(axis=1)))
        raise InputError(f"quaternion: expected quaternions that are not zero, got zero in trajectory {at}")
    rates = arrays["omega"] if "omega" in arrays else own_rates(scene.initial, attitudes, n)
    variation = Variation(scene, rates, attitudes, columns, places)
    if not PLACES.keys().isdisjoint(columns):
        _check_bodies(variation)
    return variation


def own_rates(initial: Initial, quaternion: Floats | None, count: int) -> Floats:
    """Return the angular velocity that a scene gives, body components, rad/s, for ``count`` motions, shape (count, 3).

    With other attitudes, quaternions of any norm but zero, the components that the scene gives stay: body or space.
    """
    if quaternion is None or initial.omega_s is None:
        return np.tile([float(x) for x in initial.omega_b], (count, 1))
    return to_body(quaternion, np.array([float(x) for x in initial.omega_s]))


def to_body(quaternion: Floats, omega_s: Floats) -> Floats:
    """Return body components from space components, shape (3,) or (n, 3), for n quaternions of any norm but zero."""
    unit = quaternion / abs(quaternion).max(axis=1, keepdims=True)
    unit = unit / np.sqrt((unit**2).sum(axis=1, keepdims=True))
    columns = np.moveaxis(quaternion_to_dcm(unit), -1, 0)  # the body axes in space components
    rates: Floats = np.stack([axis[:, 0] * omega_s[..., 0] + axis[:, 1] * omega_s[..., 1] + axis[:, 2] * omega_s[..., 2]
                              for axis in columns], axis=1)  # fmt: skip
    return rates


def _quaternions(attitude: Any) -> ArrayLike:
    """Return n rotations of SciPy, n quaternions or n matrices ``dcm_sb`` as quaternions, shape (n, 4)."""
    if hasattr(attitude, "as_quat"):
        return np.roll(np.atleast_2d(attitude.as_quat()), 1, axis=1)
    array = real_array(attitude, "attitude", "rotations of SciPy, or an array of shape (n, 4) or (n, 3, 3)")
    if array.shape[1:] == (3, 3):
        # a NaN is no rotation either
        right = abs(array @ array.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2)) <= float(ORTHOGONAL)
        right &= (np.cross(array[:, 0], array[:, 1]) * array[:, 2]).sum(axis=1) > 0
        if not right.all():
            raise InputError(
                "attitude: expected rotations, matrices with orthonormal rows, to 1e-9, and the determinant +1, got "
                f"another matrix in trajectory {int(np.argmin(right))}"
            )
        return dcm_to_quaternion(array)
    if array.shape[1:] != (4,):
        raise InputError(f"attitude: expected an array of shape (n, 4) or (n, 3, 3), got shape {array.shape}")
    return array


def _check_bodies(variation: Variation) -> None:
    """Raise InputError if a trajectory has moments of inertia that no body has, or those of a point or a needle."""
    # a point or a needle has a moment of zero, so that a torque does not determine its angular acceleration
    moments: Any = variation.moments
    if not variation.in_principal_axes:
        tensors = np.empty((len(variation), 3, 3))
        for name, (i, j) in PLACES.items():
            value = variation.constant(name)
            tensors[:, i, j] = tensors[:, j, i] = float(value) if isinstance(value, Fraction) else value
        moments = np.linalg.eigvalsh(tensors)  # with errors of about 1e-15 of the largest
    small, middle, large = np.sort(moments, axis=1).T
    # moments that clearly satisfy the triangle inequalities are checked in doubles, all others exactly
    doubtful = ~((small > CLEARLY * large) & (small + middle > (1 + CLEARLY) * large))
    for i in np.flatnonzero(doubtful).tolist():
        principal = variation.scene_of(i).body.principal
        require_admissible(principal, f"parameters, trajectory {i}")
        if reason := why_not_propagable(principal):
            raise InputError(f"parameters, trajectory {i}: {reason}")


def read_times(t: ArrayLike | None, scene: Scene, n: int) -> Floats:
    """Return the sample times, s, after checks: shape (m,) if all trajectories share them, otherwise (n, m)."""
    if t is None:  # the sample times of the scene
        span = scene.span
        return np.linspace(float(span.start), float(span.stop), span.samples)
    times = real_array(t, "t", "times in s", ndmin=1)
    if times.ndim > 2 or (times.ndim == 2 and len(times) != n):
        raise InputError(
            f"t: expected times in s, shape (m,) for all trajectories or ({n}, m) for each, got shape {times.shape}"
        )
    if not np.isfinite(times).all():
        raise InputError(f"t: expected finite times in s, got {times[~np.isfinite(times)][0]}")
    return times


def _array(values: ArrayLike, shape: tuple[int, ...], name: str, unit: str) -> Floats:
    expected = "(" + ", ".join(["n", *map(str, shape)]) + ("," if not shape else "") + ")"
    array = real_array(values, name, f"an array of shape {expected} in {unit}")
    if array.ndim != 1 + len(shape) or array.shape[1:] != shape:
        raise InputError(f"{name}: expected an array of shape {expected} in {unit}, got shape {array.shape}")
    if not np.isfinite(array).all():
        place = np.argwhere(~np.isfinite(array))[0]
        raise InputError(
            f"{name}: expected finite numbers in {unit}, got {array[tuple(place)]} in trajectory {place[0]}"
        )
    return array + 0.0  # -0.0 becomes 0.0, since exact numbers have no sign of zero


def constant_places(scene: Scene) -> dict[str, Place]:
    """Return a map from each constant that may vary, such as ``weight``, to its place in the scene.

    ``torque2_stiffness`` has the place ``(1, "stiffness", None)``.
    """
    places = {name: Place(-1, "inertia", None) for name in PLACES}
    for index, torque in enumerate(general_structure(scene).torques):
        if isinstance(torque, FormulaTorque):
            places |= {f"{torque.prefix}{name}": Place(index, "parameters", name) for name in torque.parameters}
            continue
        for field, pattern in torque.fields:
            entries = [None] if isinstance(pattern, Pattern) else range(len(pattern))
            names = component_names(f"{torque.prefix}{field}", pattern)
            places |= {name: Place(index, field, entry) for name, entry in zip(names, entries, strict=True)}
    return places


def _columns(scene: Scene, places: dict[str, Place], name: str, values: ArrayLike) -> dict[str, Floats]:
    """Return the columns (one value per trajectory) that the entry ``name: values`` of ``parameters`` describes.

    ``center_of_mass`` gives ``center_of_mass_1``, ``_2`` and ``_3``.
    """
    if name == "principal":
        if not scene.body.principal.given_axes:
            raise InputError(
                "principal: expected a body given along its principal axes, got a body with products of inertia; vary "
                f"{', '.join(PLACES)}"
            )
        return dict(zip(PRINCIPAL, _array(values, (3,), name, "kg m^2").T, strict=True))
    components = [key for key, place in places.items() if _field(key, place) == name != key]
    chosen = [name] if name in places else components
    if not chosen:
        known = ["principal", *dict.fromkeys(_field(key, place) for key, place in places.items())]
        raise InputError(f"parameters: expected names among {', '.join(known)}, got {number.show(name)}")
    place = places[chosen[0]]
    if place.torque < 0:
        return {name: _array(values, (), name, "kg m^2")}
    kind = TORQUE_KINDS[scene.torques[place.torque].kind]
    field = next(field for field in kind.fields if field.name == place.field)
    if field.name in FIXED:
        raise InputError(f"parameters: {name} is the same for all trajectories and cannot vary; {FIXED[field.name]}")
    if field.shape == "scalar or vector" and name not in places and np.ndim(values) == 1:
        values = np.repeat(_array(values, (), name, field.unit)[:, None], len(chosen), axis=1)
    array = _array(values, () if name in places else (len(chosen),), name, field.unit)
    rows = array.reshape(len(array), -1)
    if field.sign in SIGNS and (field.sign != "nonzero" or name not in places):
        good = SIGNS[field.sign](rows)
        if not good.all():
            at = int(np.argmin(good))
            raise InputError(
                f"{name}: expected {field.sign} values in {field.unit}, got {array[at]} in trajectory {at}"
            )
    return dict(zip(chosen, rows.T, strict=True))


def _field(key: str, place: Place) -> str:
    """Return the name of the vector that contains the constant ``key``: ``center_of_mass`` for ``center_of_mass_3``."""
    # a constant that is no component of a vector is its own field
    return key.rpartition("_")[0] if isinstance(place.entry, int) else key
