"""Euler's equations, angular momentum and energy of rigid bodies, and the torques that act on them."""

from collections.abc import Iterator

from sympy import Matrix, Symbol, diag

from symrot import symbols
from symrot.checker.recognition.formulas.named import Named
from symrot.dynamics.equations import euler_equations
from symrot.dynamics.structure import FieldPattern, FieldTorque, Pattern
from symrot.dynamics.torques import Motion, torque_law
from symrot.inertia import tensor

__all__ = ["SYMMETRIC_EULER", "rigid_bodies", "torques"]

SYMMETRIC_EULER = "by Euler's equations of a symmetric body"
"""Words in the name of a formula for a symmetric body: its moments of inertia about axes 1 and 2 are equal, and the
formula has the letter A for both."""


def rigid_bodies() -> Iterator[Named]:
    omega, moments = Matrix(symbols.omega_b), symbols.principal
    (xx, yy, zz), (xy, xz, yz) = symbols.moments, symbols.products
    full = Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    rates, torque = Matrix(symbols.omega_rates), Matrix(symbols.torque_b)
    principal = diag(*moments)
    page_of = "derivations/euler_equations.md"
    yield "Euler's equations of a free body, solved for the rates", page_of, euler_equations(moments, None)
    yield "Euler's equations, solved for the rates", page_of, euler_equations(moments)
    for inertia, axes in ((principal, "principal axes"), (full, "any body axes")):
        momentum = inertia * omega
        needed = inertia * rates + omega.cross(momentum)
        yield f"torque by Euler's equations, {axes}", page_of, needed
        yield f"Euler's equations with all terms on one side, {axes}", page_of, torque - needed
        yield f"gyroscopic torque omega x I omega, {axes}", page_of, omega.cross(momentum)
        yield f"angular momentum I omega, {axes}", "derivations/angular_momentum.md", momentum
        yield f"kinetic energy of rotation, {axes}", "derivations/kinetic_energy.md", omega.dot(momentum) / 2
    wheels = Matrix([Symbol(f"h_{n}", real=True) for n in (1, 2, 3)])
    for inertia, axes in ((principal, "principal axes"), (full, "any body axes")):
        needed = inertia * rates + omega.cross(inertia * omega + wheels)
        yield f"torque by Euler's equations of a gyrostat, {axes}", "derivations/gyroscopic_wheel.md", needed
    A, B, C = moments
    symmetric = diag(A, A, C)
    needed = symmetric * rates + omega.cross(symmetric * omega)
    yield f"torque {SYMMETRIC_EULER}", "derivations/euler_equations.md", needed
    for number, inertia in enumerate((diag(A, B, B), diag(A, B, A), diag(A, A, C)), start=1):
        title = f"angular momentum I omega of a body that is symmetric about axis {number}"
        yield title, "derivations/angular_momentum.md", inertia * omega
    point = Matrix(tensor.inertia_of_point(symbols.m, symbols.position))
    page_of = "derivations/parallel_axis.md"
    yield "inertia tensor of a point mass, which is what the parallel-axis theorem adds", page_of, point
    yield "parallel-axis theorem for the full tensor", page_of, full + point


FREE, ZERO = Pattern.FREE, Pattern.ZERO
VECTOR, DOWN = (FREE,) * 3, (ZERO, ZERO, Pattern.MINUS_ONE)
ACTING: tuple[tuple[str, str, dict[str, FieldPattern]], ...] = (
    ("gravity", "gravity on a body about a fixed point",
     {"weight": FREE, "center_of_mass": VECTOR, "direction": DOWN}),
    ("gravity", "gravity in any direction", {"weight": FREE, "center_of_mass": VECTOR, "direction": VECTOR}),
    ("gravity_gradient", "gravity gradient on a circular orbit", {"mean_motion": FREE}),
    ("damping", "linear damping", {"linear": VECTOR, "quadratic": ZERO}),
    ("spring", "torsional spring", {"stiffness": FREE, "attitude": (FREE,) * 4}),
)  # fmt: skip
"""Torques with a known formula: triples (kind in symrot's table of torques, words for the formula's name, fields).

The fields map each constant of the torque to a pattern: FREE for a symbol in the formula, ZERO for 0. A vector has one
pattern for each component: VECTOR is any vector, DOWN is the vector (0, 0, -1)."""


def torques() -> Iterator[Named]:
    motion = Motion(Matrix(symbols.omega_b), symbols.quaternion, diag(*symbols.principal))
    for kind, title, fields in ACTING:
        law = torque_law(FieldTorque(kind, "", tuple(fields.items())), motion)
        source = f'symrot.dynamics.torques, kind "{kind}"'
        for letters in _letters_of_books(law.torque):
            yield f"torque of {title}, body components", source, law.torque.subs(letters)
        if law.potential is not None:
            yield f"potential of {title}", source, law.potential
    yield from _gravity_gradient()


def _gravity_gradient() -> Iterator[Named]:
    """Yield the torque of the gradient of gravity on a body with any tensor of inertia."""
    (xx, yy, zz), (xy, xz, yz) = symbols.moments, symbols.products
    full = Matrix([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    motion = Motion(Matrix(symbols.omega_b), symbols.quaternion, full)
    law = torque_law(FieldTorque("gravity_gradient", "", (("mean_motion", FREE),)), motion)
    named = {symbol.name: symbol for symbol in law.torque.free_symbols}
    direction = dict(zip((named[f"radius_{axis}"] for axis in (1, 2, 3)), symbols.axis, strict=True))
    by_rate = law.torque.subs({named["mean_motion"]: symbols.n, **direction})
    attraction = Symbol("mu_g", real=True)  # Kepler: n^2 = mu/R^3 on a circle
    by_distance = by_rate.subs(symbols.n**2, attraction / symbols.R**3)
    for torque in (by_rate, by_distance):
        yield (
            "torque of the gravity gradient from the tensor of inertia",
            'symrot.dynamics.torques, kind "gravity_gradient"',
            torque,
        )


def _letters_of_books(torque: Matrix) -> list[dict[Symbol, Symbol]]:
    """Return the ways to write a torque in the letters of books, each as {symbol of the torque: letter}.

    For instance {mean_motion: n, radius_1: n1, ..}. Only the gravity gradient has other letters in books, in two ways;
    other torques give [{}].
    """
    named = {symbol.name: symbol for symbol in torque.free_symbols}
    if "mean_motion" not in named:
        return [{}]
    direction = [named[f"radius_{axis}"] for axis in (1, 2, 3)]
    rate = {named["mean_motion"]: symbols.n}
    # the direction to the planet's centre: a column of a rotation matrix, or a unit vector
    columns = [symbols.rotation_entries[2::3], symbols.axis]
    return [rate | dict(zip(direction, column, strict=True)) for column in columns]
