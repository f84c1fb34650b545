"""Rigid bodies, inertia dyadics and frames of ``sympy.physics.mechanics``, to and from symrot.

Conventions agree: inertia tensors contain the minus sign of the products, and for a space frame N and a body frame B,
``N.dcm(B)`` is symrot's ``dcm_sb``, which maps body components to space components.
"""

from fractions import Fraction
from typing import Any

from sympy import Expr, Float, ImmutableMatrix, Matrix, Rational
from sympy.physics.mechanics import Dyadic, Inertia, Point, ReferenceFrame, RigidBody, inertia

from symrot.errors import InputError
from symrot.inertia.solids import Solid
from symrot.scene.body import Body
from symrot.scene.scene import Scene

__all__ = ["from_sympy", "to_sympy"]

NAME = "body"


def from_sympy(value: Any, frame: ReferenceFrame | None = None) -> Any:
    """Return a value of ``sympy.physics.mechanics`` in the form that symrot uses.

    Parameters
    ----------
    value : RigidBody, Inertia, Dyadic or ReferenceFrame
    frame : ReferenceFrame, optional
        For a dyadic, the frame of the components; for a reference frame, the frame relative to which it is oriented,
        the space frame; none for a rigid body.

    Returns
    -------
    dict
        For a rigid body whose mass and inertia are numbers: the table ``body`` of a scene, about its centre of mass, in
        the axes of ``value.frame``.
    ImmutableMatrix, shape (3, 3)
        For an inertia or a dyadic: the tensor, kg m^2, with negated products. For a reference frame: ``dcm_sb``.

    Raises
    ------
    InputError
        For a value of another type, a missing frame, frames that are not connected, a rigid body with a ``frame``
        argument, or a rigid body whose mass or inertia contains symbols.

    Examples
    --------
    >>> import symrot
    >>> from sympy.physics.mechanics import ReferenceFrame, inertia
    >>> N = ReferenceFrame("N")
    >>> symrot.from_sympy(inertia(N, 1, 2, 3), N)[2, 2]
    3
    """
    if isinstance(value, RigidBody):
        if frame is not None:
            raise InputError(f"from_sympy: frame: expected none for a RigidBody, which has its own, got {frame}")
        try:
            tensor = value.central_inertia.to_matrix(value.frame)
        except ValueError as reason:
            raise InputError(
                f"from_sympy: expected a body whose points and frames are connected, got {reason}"
            ) from None
        return _table(value, tensor)
    if not isinstance(value, Inertia | Dyadic | ReferenceFrame):
        raise InputError(
            f"from_sympy: expected a RigidBody, Inertia, Dyadic or ReferenceFrame, got {type(value).__name__}"
        )
    if not isinstance(frame, ReferenceFrame):
        kind = "space frame" if isinstance(value, ReferenceFrame) else "frame of the components"
        raise InputError(f"from_sympy: frame: expected a ReferenceFrame, the {kind}, got {type(frame).__name__}")
    try:
        if isinstance(value, ReferenceFrame):
            return ImmutableMatrix(frame.dcm(value))
        return ImmutableMatrix((value.dyadic if isinstance(value, Inertia) else value).to_matrix(frame))
    except ValueError as reason:
        raise InputError(
            f"from_sympy: expected frames with a known orientation relative to each other, got {reason}"
        ) from None


def _table(body: RigidBody, tensor: Any) -> dict[str, Any]:
    """Return the table ``body`` of a scene (name, mass, inertia) from a SymPy rigid body with numbers.

    ``tensor`` is its inertia about the centre of mass. InputError is raised for symbols.
    """
    rows = [[_number(tensor[i, j], f"inertia[{i}][{j}]") for j in range(3)] for i in range(3)]
    return {"name": str(body.name), "mass": _number(body.mass, "mass"), "inertia": rows}


def _number(value: Any, place: str) -> Any:
    """Return a number of SymPy as a scene accepts it: a fraction, a float, or text such as sqrt(2)."""
    value = Rational(value) if isinstance(value, int | Fraction) else value
    if isinstance(value, float):
        return value
    if not isinstance(value, Expr) or not value.is_number or not value.is_real:
        names = ", ".join(sorted(map(str, getattr(value, "free_symbols", ())))) or str(value)
        # ``place`` names the number that contains symbols
        raise InputError(
            f"from_sympy: {place}: expected a real number, got {names}; replace symbols by numbers, "
            "for example by xreplace, before the body is passed to symrot"
        )
    if isinstance(value, Rational):
        return Fraction(int(value.p), int(value.q))
    return float(value) if isinstance(value, Float) or value.has(Float) else str(value)


def to_sympy(value: Solid | Scene | Body, frame: ReferenceFrame | None = None) -> RigidBody:
    """Return a body of symrot as a ``RigidBody`` of ``sympy.physics.mechanics``.

    Parameters
    ----------
    value : Solid, Scene or Body
        A solid stays symbolic. The body of a scene has numbers; its frame is oriented as at the start of the scene,
        relative to a frame N, and has the initial angular velocity.
    frame : ReferenceFrame, optional
        The frame of a solid or body; for a scene, the space frame. Default: a new one.

    Returns
    -------
    RigidBody
        With the inertia about the centre of mass, kg m^2, in the axes of the body.

    Raises
    ------
    InputError
        For another value, and for a body without a mass or whose inertia refers to a fixed point at an unknown place.

    Examples
    --------
    >>> import symrot
    >>> body = symrot.to_sympy(symrot.solid("sphere"))
    >>> body.central_inertia.to_matrix(body.frame)[0, 0]
    2*R**2*m/5
    """
    if isinstance(value, Solid):
        return _rigid_body(value.name, frame or ReferenceFrame("B"), value.mass, value.inertia)
    if isinstance(value, Scene):
        return _of_scene(value, frame or ReferenceFrame("N"))
    if isinstance(value, Body):
        return _of_body(value, NAME, frame or ReferenceFrame("B"))
    raise InputError(f"to_sympy: expected a Solid, a Scene or a Body, got {type(value).__name__}")


def _of_scene(scene: Scene, space: ReferenceFrame) -> RigidBody:
    own = ReferenceFrame("B")
    own.orient_quaternion(space, tuple(map(_rational, scene.initial.quaternion)))
    rates = map(_rational, scene.initial.omega_b)
    own.set_ang_vel(space, sum((rate * axis for rate, axis in zip(rates, own, strict=True)), 0 * own.x))
    return _of_body(scene.body, scene.name, own)


def _of_body(body: Body, name: str, frame: ReferenceFrame) -> RigidBody:
    tensor = Matrix(3, 3, [_rational(entry) for row in body.inertia for entry in row])
    if body.mass is None:
        raise InputError("to_sympy: expected a body with a mass, got one whose mass is unknown; give its mass")
    mass = _rational(body.mass)
    if body.about == "fixed_point":
        if body.center_of_mass is None:
            raise InputError("to_sympy: expected a body whose centre of mass is known; give center_of_mass")
        offset = Matrix([_rational(x) for x in body.center_of_mass])
        tensor -= mass * (offset.dot(offset) * Matrix.eye(3) - offset * offset.T)
    return _rigid_body(name, frame, mass, tensor)


def _rational(value: Fraction) -> Rational:
    return Rational(value.numerator, value.denominator)


def _rigid_body(name: str, frame: ReferenceFrame, mass: Expr, tensor: Any) -> RigidBody:
    center = Point(f"{name}_center")
    dyadic = inertia(frame, tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[1, 2], tensor[2, 0])
    return RigidBody(name, center, frame, mass, (dyadic, center))
