"""Values from a scene for the symbols that derivations use."""

from fractions import Fraction
from itertools import chain

from sympy import Expr, Matrix, Rational, acos, sqrt

from symrot import symbols
from symrot.kinematics.quaternion import quaternion_to_dcm
from symrot.scene.scene import Scene
from symrot.scene.torque import Torque

__all__ = ["scene_values"]


def scene_values(scene: Scene) -> dict[Expr, Expr]:
    """Return a map from symbols of derivations to the exact numbers of a scene at its start.

    Examples
    --------
    >>> from symrot.scene.scene import load_scene
    >>> scene_values(load_scene("tumbling_prism"))[symbols.A]
    5
    """
    body, start = scene.body, scene.initial
    inertia = Matrix(3, 3, [_exact(value) for value in chain.from_iterable(body.inertia)])
    omega = Matrix([_exact(value) for value in start.omega_b])
    quaternion = [_exact(value) for value in start.quaternion]
    dcm_sb = Matrix(quaternion_to_dcm()).subs(dict(zip(symbols.quaternion, quaternion, strict=True)))
    momentum = inertia * omega
    # alpha, n: angle and axis of the attitude; R_ij: entries of the dcm; p_psi, p_phi: angular momenta about the third
    # axis and about the vertical; theta: between the two; A, B, C: about the scene file's axes
    values: dict[Expr, Expr] = dict(zip(symbols.omega_b, omega, strict=True))
    values |= dict(zip(symbols.omega_s, dcm_sb * omega, strict=True))
    values |= dict(zip(symbols.quaternion, quaternion, strict=True))
    values |= dict(zip(symbols.rotation_entries, dcm_sb, strict=True))
    values |= dict(zip(symbols.principal, inertia.diagonal(), strict=True))
    values |= dict(zip(symbols.moments, inertia.diagonal(), strict=True))
    values |= {symbol: inertia[place] for symbol, place in zip(symbols.products, ((0, 1), (0, 2), (1, 2)), strict=True)}
    values |= {
        symbols.H: sqrt(momentum.dot(momentum)),
        symbols.E: omega.dot(momentum) / 2,
        symbols.theta: acos(dcm_sb[2, 2]),
        symbols.p_psi: momentum[2],
        symbols.p_phi: (dcm_sb * momentum)[2],
    }
    vector = Matrix(quaternion[1:])
    length = sqrt(vector.dot(vector))
    if length:
        values[symbols.alpha] = 2 * acos(quaternion[0])
        values |= dict(zip(symbols.axis, vector / length, strict=True))
        values |= dict(zip(symbols.rotation_vector, values[symbols.alpha] * vector / length, strict=True))
    if body.mass is not None:
        values[symbols.m] = _exact(body.mass)
    if len(body.parts) == 1:
        dimensions = {"radius": symbols.R, "length": symbols.L, "a": symbols.a, "b": symbols.b, "c": symbols.c}
        sizes = body.parts[0].dimensions
        values |= {symbol: _exact(sizes[name]) for name, symbol in dimensions.items() if name in sizes}
    for torque in scene.torques:
        values |= _of_torque(torque)
    return values


def _exact(value: Fraction) -> Rational:
    return Rational(value.numerator, value.denominator)


def _of_torque(torque: Torque) -> dict[Expr, Expr]:
    """Return a map from symbols that derivations use for constants of a torque, such as W, to their exact values.

    It is empty if derivations have no symbols for the torque.
    """
    vectors = {
        ("constant_body", "torque"): symbols.torque_b,
        ("rotor", "angular_momentum"): symbols.rotor,
        ("damping", "linear"): symbols.damping,
        ("gravity", "center_of_mass"): symbols.center_of_mass,
    }
    numbers = {("gravity", "weight"): symbols.W, ("gravity_gradient", "mean_motion"): symbols.n}
    values: dict[Expr, Expr] = {}
    for name in torque.values:
        place = torque.kind, name
        if place in vectors:
            values |= dict(zip(vectors[place], map(_exact, torque.vector(name)), strict=True))
        if place in numbers:
            values[numbers[place]] = _exact(torque.number(name))
    return values
