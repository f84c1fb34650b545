"""Variations: what differs between the motions of an ensemble, and a plan (choice of equations) valid for all of it.

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
from numpy.typing import NDArray

from symrot.dynamics.structure import Structure
from symrot.formula import exact_numbers as number
from symrot.inertia.principal import principal_axes
from symrot.planning.general_structure import general_structure, switched
from symrot.planning.plan import Plan, make_plan
from symrot.propagation.steppers.stepping import Floats
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = ["PLACES", "PRINCIPAL", "PRODUCTS", "Place", "Variation"]

PLACES = {"I_xx": (0, 0), "I_yy": (1, 1), "I_zz": (2, 2), "I_xy": (0, 1), "I_xz": (0, 2), "I_yz": (1, 2)}
PRINCIPAL = ("I_xx", "I_yy", "I_zz")
PRODUCTS = ("I_xy", "I_xz", "I_yz")
GENERAL_START = Initial(  # initial state without special values, so that no rule of the planner applies to it
    (Fraction(3, 7), Fraction(5, 11), Fraction(7, 13)),
    (Fraction(1, 5), Fraction(2, 5), Fraction(4, 5), Fraction(2, 5)),
)
BY_ZEROS = {"gravity", "rotor", "constant_body", "damping"}
"""Kinds of torques whose numbers affect the choice of the equations only by being zero or not."""

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
    """What differs between the n trajectories of an ensemble: initial states, and arrays of varying constants."""

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
        """Return the trajectories grouped by the equations that suit them, as arrays of indices.

        In all trajectories of a group the same constants are zero, and the same moments of inertia are equal. So the
        group of a trajectory depends only on its own constants.
        """
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
        """Return the entries, by name, of one inertia tensor that stands for the tensors of all trajectories.

        Its moments are equal, and its products of inertia zero, only where they are so in every trajectory. So a plan
        (choice of equations) that is made from it is valid for all trajectories.
        """
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
    """Return whether two constants are equal: a bool for two fractions, else an array with a bool for each trajectory.

    A constant is a fraction if it is the same for all trajectories, else an array of its values.
    """
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
    """Return one value of a column, zero only if all values are zero: ``[0, 3, 4]`` gives 3.

    A plan (choice of equations) that is made from this value is valid for all trajectories: it drops a term only if the
    constant is zero in each of them.
    """
    return Fraction(float(column[np.argmax(column != 0)]))
