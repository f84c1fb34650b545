"""Reading of the arrays that describe an ensemble: initial states, constants and sample times, all of them checked."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from symrot.dynamics.structure import FormulaTorque, Pattern, component_names
from symrot.dynamics.torque_kinds import TORQUE_KINDS
from symrot.ensemble.variation import PLACES, PRINCIPAL, Place, Variation
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.inertia.principal import require_admissible, why_not_propagable
from symrot.kinematics.conversions import dcm_to_quaternion, quaternion_to_dcm
from symrot.planning.general_structure import general_structure
from symrot.propagation.real_array import real_array
from symrot.propagation.steppers.stepping import Floats
from symrot.scene.attitude import ORTHOGONAL, refuse_two
from symrot.scene.scene import Scene
from symrot.scene.tables import Initial

__all__ = ["FIXED", "constant_places", "own_rates", "read_times", "read_variation", "to_body"]

CLEARLY = 1e-12  # difference, relative to the largest moment, that is certain in doubles
FIXED = {"direction": "rotate the initial quaternions instead", "attitude": "rotate the initial quaternions instead"}
SIGNS = {  # test of the sign that a field requires, for each trajectory: shape (n, k) -> (n,)
    "positive": lambda values: (values > 0).all(axis=1),
    "nonnegative": lambda values: (values >= 0).all(axis=1),
    "nonzero": lambda values: (values != 0).any(axis=1),
}


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
        If an array has a wrong shape, a value is not finite or has a wrong sign, an attitude is no rotation, a name is
        unknown or occurs twice, or no body can have the moments of inertia.
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

    ``quaternion``, shape (count, 4), holds other initial attitudes, of any norm but zero. If the scene gives space
    components, these stay the same, and the body components follow from the attitudes.
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
    """Convert n rotations of SciPy, n quaternions or n matrices ``dcm_sb`` to quaternions, shape (n, 4)."""
    if hasattr(attitude, "as_quat"):
        return np.roll(np.atleast_2d(attitude.as_quat()), 1, axis=1)
    array = real_array(attitude, "attitude", "rotations of SciPy, or an array of shape (n, 4) or (n, 3, 3)")
    if array.shape[1:] == (3, 3):
        # a NaN is no rotation either
        right = abs(array @ array.swapaxes(1, 2) - np.eye(3)).max(axis=(1, 2)) <= float(ORTHOGONAL)
        right &= (np.cross(array[:, 0], array[:, 1]) * array[:, 2]).sum(axis=1) > 0
        if not right.all():
            raise InputError(
                "attitude: expected rotation matrices (rows orthonormal to within 1e-9, determinant +1), got another "
                f"matrix in trajectory {int(np.argmin(right))}"
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
    """Return the sample times, s: shape (m,) if all trajectories share them, otherwise (n, m).

    Raise InputError for another shape, or for a time that is not finite.
    """
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

    ``torque2_stiffness`` has the place ``(1, "stiffness", None)``: the torque with index 1, its field, and None because
    the field is a single number.
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
                f"{', '.join(PLACES)} instead"
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
