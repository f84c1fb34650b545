"""The formulas that symrot derives, with names and fingerprints; running this module writes ``known_formulas.toml``."""

import json
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from sympy import Expr, ImmutableMatrix, Integer, Matrix, Mul, Symbol, diag

from symrot import catalogue, symbols
from symrot.checker.context.bodies import with_article
from symrot.checker.recognition.fingerprint import NotInField, fingerprint
from symrot.checker.recognition.formulas.bodies import bodies
from symrot.checker.recognition.formulas.kinematics import GYROSCOPE, OF_ONE_ENTRY, along_axes, rotations, vectors
from symrot.checker.recognition.formulas.mechanics import one_axis, tops
from symrot.checker.recognition.formulas.points import ANY_VECTORS, GENERAL, points
from symrot.checker.recognition.relations import new_symbol, primitive, relations, solved
from symrot.conventions import SEQUENCES
from symrot.dynamics.equations import euler_equations
from symrot.dynamics.structure import FieldPattern, FieldTorque, Pattern
from symrot.dynamics.torques import Motion, torque_law
from symrot.exact.decision import flatten
from symrot.exact.printing import as_text
from symrot.inertia import tensor
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import Solid, solid
from symrot.kinematics import attitude, euler, quaternion, rotation_vector
from symrot.kinematics.rotations import elementary_rotation, skew

__all__ = [
    "CROSS_PRODUCT", "FILE", "SYMMETRIC_EULER", "Known", "Named", "by_fingerprint", "derived", "ending_of", "page",
    "relation_key", "stated",
]  # fmt: skip

FILE = Path(__file__).with_name("known_formulas.toml")
CROSS_PRODUCT = "cross product v x n"
"""The end of the names of the known cross product and of its components."""
LONGEST = 6000
LONGEST_DERIVED = 900
"""The most letters of a formula in the file: of a formula with a name of its own, and of a side of a step."""

SYMMETRIC_EULER = "by Euler's equations of a symmetric body"
"""Part of the names of formulas in which the two transverse moments have one letter."""

FRAMES = ("body", "space")


@dataclass(frozen=True)
class Known:
    """A formula that symrot derives: its name, its derivation page and its text."""

    name: str
    source: str
    text: str
    scaled: bool = False  # multiples of the formula have the same name
    only_named: bool = False  # such as C*omega_3: only for a named quantity, in the letters of books
    is_relation: bool = False  # the left side of an equation minus the right side

    @property
    def is_placed(self) -> bool:
        """Whether the formula is for one axis or matrix entry only, such as roll: its axes must not be exchanged."""
        return self.name.startswith(("yaw", "pitch", "roll", "entry"))

    @property
    def is_step(self) -> bool:
        """Whether the formula is a side of a derivation's step; then it has no name of its own."""
        return ", step " in self.source


Named = tuple[str, str, Any]
"""Name, source and value of a formula."""


def _sequences() -> Iterator[Named]:
    rates = Matrix(symbols.angle_rates)
    for name in SEQUENCES:
        kind = "intrinsic" if name.isupper() else "extrinsic"
        yield f"rotation matrix of {kind} {name}, body to space", f'symrot.dcm("{name}")', euler.dcm(name)
        yield f"quaternion of {kind} {name}", "derivations/euler_parameters.md", euler.quaternion_of_euler(name)
        for frame in FRAMES:
            matrix = euler.rate_jacobian(name, frame)
            omega = Matrix(symbols.omega_b if frame == "body" else symbols.omega_s)
            source = f'symrot.rate_jacobian("{name}", "{frame}")'
            plain = matrix.as_immutable()
            yield f"{name} {frame}-frame rate Jacobian, omega = B dq/dt", source, plain
            yield f"inverse of the {name} {frame}-frame rate Jacobian, dq/dt = B^-1 omega", source, matrix.inverse
            yield f"angular velocity of {name} in the {frame} frame", source, plain * rates
            yield f"angle rates of {name} from omega in the {frame} frame", source, matrix.inverse * omega


def _axes() -> Iterator[Named]:
    for axis in "xyz":
        rotation = elementary_rotation(axis.upper(), symbols.phi)
        yield f"rotation about the {axis} axis, body to space", f"R{axis}(phi)", rotation
    flat = elementary_rotation("Z", symbols.phi)[:2, :2]
    yield "rotation matrix in a plane, body to space", "Rz(phi)", flat


def _quaternions() -> Iterator[Named]:
    q, p = symbols.quaternion, symbols.second_quaternion
    page_of = "derivations/quaternion_rates.md"
    yield (
        "rotation matrix of a unit quaternion, body to space",
        "symrot.quaternion_to_dcm()",
        quaternion.quaternion_to_dcm(q),
    )
    for form in ("homogeneous", "normalised"):
        matrix = quaternion.quaternion_to_dcm(q, form)
        yield (
            f"rotation matrix of a quaternion, {form}, body to space",
            f'symrot.quaternion_to_dcm(q, "{form}")',
            matrix,
        )
    yield "quaternion product q p", "symrot.quaternion_product(q, p)", quaternion.quaternion_product(q, p)
    yield "matrix of the product with a quaternion on the left", "symrot.quaternion_product", quaternion.left_matrix(q)
    yield (
        "matrix of the product with a quaternion on the right",
        "symrot.quaternion_product",
        quaternion.right_matrix(q),
    )
    for frame in FRAMES:
        rates, jacobian = quaternion.quaternion_rates(frame), quaternion.quaternion_rate_jacobian(frame)
        omega = Matrix(symbols.omega_b if frame == "body" else symbols.omega_s)
        yield f"quaternion rate matrix, {frame} frame, dq/dt = E omega", f'symrot.quaternion_rates("{frame}")', rates
        yield f"quaternion rates from omega in the {frame} frame", page_of, rates * omega
        yield f"quaternion rate Jacobian, {frame} frame, omega = B dq/dt", page_of, jacobian.as_immutable()
        omega_of_rates = jacobian.as_immutable() * Matrix(symbols.quaternion_rates)
        yield f"angular velocity of a quaternion in the {frame} frame", page_of, omega_of_rates


def _vectors() -> Iterator[Named]:
    yield "skew matrix of a vector, [v] w = v x w", "skew(v1, v2, v3)", skew(symbols.rotation_vector)
    pair = Matrix(symbols.rotation_vector), Matrix(symbols.axis)
    yield CROSS_PRODUCT, "cross(v, n)", pair[0].cross(pair[1])
    for name, title in (("rotation_vector", "rotation vector"), ("rodrigues", "Rodrigues parameters"),
                        ("mrp", "modified Rodrigues parameters")):  # fmt: skip
        chart = attitude.chart(name)
        page_of = f"derivations/{'rotation_vector' if name == 'rotation_vector' else 'rodrigues'}.md"
        yield f"rotation matrix of the {title}, body to space", page_of, chart.dcm
        yield f"quaternion of the {title}", page_of, chart.quaternion
        for frame in FRAMES:
            matrix = chart.rate_matrix(frame)
            yield f"{frame}-frame rate Jacobian of the {title}", page_of, matrix.as_immutable()
            yield f"inverse {frame}-frame rate Jacobian of the {title}", page_of, matrix.inverse
    page_of = "derivations/axis_and_angle.md"
    yield "rotation matrix of axis and angle (Rodrigues' formula)", page_of, rotation_vector.dcm_of_axis_angle()
    yield "quaternion of axis and angle", page_of, rotation_vector.quaternion_of_axis_angle()


PLACES = {
    "cone": (("its tip", ("0", "0", "h")),),
    "rod": (("an end", ("0", "0", "L/2")),),
    "cylinder": (("the centre of an end", ("0", "0", "L/2")),),
    "disk": (("a point of its rim", ("R", "0", "0")),),
    "ring": (("a point of its rim", ("R", "0", "0")),),
    "sphere": (("a point of its surface", ("0", "0", "R")),),
    "box": (("a corner", ("a/2", "b/2", "c/2")),),
    "plate": (("a corner", ("a/2", "b/2", "0")), ("the middle of a side", ("a/2", "0", "0"))),
}
"""Shape -> (name, position) of special points, in the axes and symbols of the shape."""


def _solids() -> Iterator[Named]:
    for name, shape in SHAPES.items():
        if shape.kind == "points":
            continue
        body, title = solid(name), with_article(name.replace("_", " "))
        places = [("its centre of mass", tuple(body.center_of_mass))]
        if any(body.center_of_mass):
            origin = shape.axes.partition(",")[0].removeprefix("origin at ")
            places.append(("the corner at (0, 0)" if origin.startswith("corners ") else origin, (0, 0, 0)))
        for where, point in [*places, *PLACES.get(name, ())]:
            matrix = body.inertia_about(point)
            source = f'symrot.solid("{name}").inertia_about(({", ".join(map(str, point))}))'
            yield f"inertia tensor of {title} about {where}", source, matrix
            for place, axis in enumerate("xyz"):
                yield f"moment of inertia of {title} about {where}, {axis} axis", source, matrix[place, place]
            for axes, (i, j) in (("xy", (0, 1)), ("xz", (0, 2)), ("yz", (1, 2))):
                if matrix[i, j] != 0:
                    product_name = f"product of inertia of {title} about {where}, {axes}"
                    yield product_name, source, matrix[i, j]
                    yield f"{product_name}, without the minus sign", source, -matrix[i, j]


def _stretched(body: Solid, factors: Sequence[Expr]) -> Matrix:
    """Return the inertia tensor of a body whose coordinates are multiplied by ``factors``, with the same mass."""
    # by S_i = sum of m x_i^2 = tr(I)/2 - I_ii; the axes are principal
    tensor_of = body.inertia_about(tuple(body.center_of_mass))
    sums = [factor**2 * (tensor_of.trace() / 2 - tensor_of[i, i]) for i, factor in enumerate(factors)]
    return diag(*(sum(sums) - own for own in sums)).expand()


def _thin_bodies() -> Iterator[Named]:
    """Yield the moments of bodies that are limits of solids, made of rings, or stretched: annulus, elliptical disk."""
    inner, outer, length, mass = (Symbol(name, positive=True) for name in ("R_1", "R_2", "L", "m"))
    hollow = solid("hollow_cylinder")
    tensor_of = hollow.inertia_about(tuple(hollow.center_of_mass))
    radius = Symbol("R", positive=True)
    source = 'symrot.solid("hollow_cylinder")'
    flat, tube = tensor_of.subs(length, 0), tensor_of.subs({inner: radius, outer: radius})
    height, part = Symbol("h", positive=True), Symbol("s", positive=True)
    axes = (*(Symbol(name, positive=True) / radius for name in "ab"), Integer(1))
    stretched = {name: _stretched(solid(name), axes) for name in ("disk", "cylinder")}
    ring = diag(radius**2 / 2, radius**2 / 2, radius**2) * part**2 + diag(1, 1, 0) * height**2 * part**2
    cone = (mass * 2 * part * ring).applyfunc(lambda entry: entry.integrate((part, 0, 1)))  # rings of mass 2 m s ds
    for title, origin, matrix in (
        ("annulus about its centre of mass", source, flat),
        ("thin tube about its centre of mass", source, tube),
        ("conical shell about its tip", "rings from the tip, of mass 2 m s ds", cone),
        *(
            (f"elliptical {name} about its centre of mass", f'symrot.solid("{name}"), stretched', matrix)
            for name, matrix in stretched.items()
        ),
    ):
        for place, axis in enumerate("xyz"):
            yield f"moment of inertia of {with_article(title)}, {axis} axis", origin, matrix[place, place]


def _mechanics() -> Iterator[Named]:
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
        yield f"Euler's equations as torque minus its need, {axes}", page_of, torque - needed
        yield f"gyroscopic torque omega x I omega, {axes}", page_of, omega.cross(momentum)
        yield f"angular momentum I omega, {axes}", "derivations/angular_momentum.md", momentum
        yield f"kinetic energy of rotation, {axes}", "derivations/kinetic_energy.md", omega.dot(momentum) / 2
    wheels = Matrix([new_symbol(f"h_{n}", "kg m^2/s") for n in (1, 2, 3)])
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
"""Kind of a torque, its name, and the pattern of each of its values: FREE stands for a symbol."""


def _torques() -> Iterator[Named]:
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
    attraction = new_symbol("mu_g", "m^3/s^2")  # Kepler: n^2 = mu/R^3 on a circle
    by_distance = by_rate.subs(symbols.n**2, attraction / symbols.R**3)
    for torque in (by_rate, by_distance):
        yield (
            "torque of the gravity gradient by the tensor of inertia",
            'symrot.dynamics.torques, kind "gravity_gradient"',
            torque,
        )


def _letters_of_books(torque: Matrix) -> list[dict[Symbol, Symbol]]:
    """Return dictionaries from a torque's symbols to letters of books, such as {mean_motion: n, radius_1: n1, ..}."""
    # only the torque of the gravity gradient has other letters in books
    named = {symbol.name: symbol for symbol in torque.free_symbols}
    if "mean_motion" not in named:
        return [{}]
    direction = [named[f"radius_{axis}"] for axis in (1, 2, 3)]
    rate = {named["mean_motion"]: symbols.n}
    # the direction to the planet's centre: a column of a rotation matrix, or a unit vector
    columns = [symbols.rotation_entries[2::3], symbols.axis]
    return [rate | dict(zip(direction, column, strict=True)) for column in columns]


@cache
def _formulas_of(group: Callable[[], Iterator[Named]]) -> tuple[Named, ...]:
    """Return the formulas that a function of this file or of ``formulas`` yields, derived once per process."""
    return tuple(group())


def stated() -> Iterator[Named]:
    """Yield the formulas of kinematics, inertia and dynamics in a fixed order, then the components of the vectors."""
    columns: list[Named] = []
    for group in (
        _axes,
        _sequences,
        _quaternions,
        _vectors,
        _solids,
        _thin_bodies,
        _mechanics,
        _torques,
        one_axis,
        tops,
        _solved,
        vectors,
        points,
        along_axes,
        rotations,
        bodies,
    ):
        for name, source, value in _formulas_of(group):
            yield name, source, value
            if getattr(value, "shape", None) in COMPONENTS and group is not along_axes:
                columns.append((name, source, value))
    for name, source, column in columns:
        for place, entry in zip(COMPONENTS[column.shape], column, strict=True):
            if len(entry.free_symbols) >= LEAST_OF_COMPONENT:
                yield f"{place} component of the {name}", source, entry


COMPONENTS = {(3, 1): ("first", "second", "third"), (4, 1): ("scalar", "first", "second", "third")}
"""Shape of a column -> the names of its components; a quaternion begins with the scalar."""
LEAST_OF_RELATION = 3
"""The fewest symbols of a relation."""
LEAST_OF_COMPONENT = 3
"""The fewest symbols of a component that is looked up by itself: one with fewer symbols could be too many formulas."""


def derived() -> Iterator[Named]:
    """Yield both sides of each step of all derivations."""
    for name in catalogue.names():
        derivation = catalogue.derivation(name)
        for number, step in enumerate(derivation.steps, start=1):
            claim = " ".join(step.claim.split()).rstrip(".:")
            between = (side for _, before, after in step.via for side in (before, after))
            for side in (step.left, step.right, *between):
                yield f"{derivation.title}: {claim}", f"derivations/{name}.md, step {number}", side


def _solved() -> Iterator[Named]:
    """Yield the relations of mechanics, solved for the quantities for which books solve them."""
    for relation in relations():
        yield from solved(relation)


def _related() -> Iterator[Named]:
    """Yield each relation of mechanics as (name, source, left side minus right side)."""
    for relation in relations():
        yield f"relation for {relation.title}", relation.source, primitive(relation.difference)


SCALAR_PRODUCTS = ("power of a torque", "kinetic energy from the angular momentum")
"""Formulas of the form a . b, which is a formula of mechanics only if the letters say so."""


def _selected(
    formulas: Iterator[Named],
    least: int,
    longest: int,
    is_relation: bool = False,  # stored too: relations are looked up for equations only
) -> Iterator[tuple[str, Known]]:
    """Yield (key, formula) for formulas with at least ``least`` symbols and at most ``longest`` characters."""
    general = (*GENERAL, *OF_ONE_ENTRY)
    of_letters = {*(name for name, *_ in _formulas_of(along_axes)), GYROSCOPE, *SCALAR_PRODUCTS, *ANY_VECTORS, *general}
    groups = (tops, one_axis, _solved, rotations, bodies, points)
    seen, few = set(), {name for group in groups for name, *_ in _formulas_of(group)}
    for name, source, value in formulas:
        entries, shape = flatten(value)
        if sum(entry.count_ops() for entry in entries) > longest // 3:
            continue
        text = " ".join(as_text(ImmutableMatrix(value) if shape else value).split())
        try:
            own = fingerprint(entries)
        except NotInField:
            continue
        is_general = _is_general(entries) and not ending_of(name) and name not in general
        if is_general or len(own.atoms) < least or len(text) > longest or (name, text) in seen:
            continue
        seen.add((name, text))
        scaled = "quaternion rate" in name
        only_named = (name in few and all(map(_is_monomial, entries))) or name in of_letters
        known = Known(name, source, text, scaled or is_relation, only_named, is_relation)
        yield relation_key(own.key(shape, range(len(entries))), is_relation), known


def ending_of(name: str) -> str:
    """Return the end ", squared" or ", acos" of a known formula's name, or "" if the name has no such end."""
    # the formula then is a function of the quantity: its square, cosine, or half angle's cosine
    ending = re.search(r", (squared|(\S+ )?(acos|asin|atan2))$", name)
    return ending[0] if ending else ""


def relation_key(key: str, is_relation: bool) -> str:
    """Return the key of a formula in the file: its fingerprint ``key``, with ``=`` in front for a relation."""
    return f"={key}" if is_relation else key


def _is_monomial(entry: Expr) -> bool:
    """Return whether a formula is a product of powers of symbols."""
    factors = [factor.as_base_exp()[0] for factor in Mul.make_args(entry)]
    return all(factor.is_Symbol or factor.is_number for factor in factors)


def _is_general(entries: Sequence[Expr]) -> bool:
    """Return whether the nonzero entries of a formula are different symbols, as in ``diag(A, B, C)``."""
    nonzero = [entry for entry in entries if entry != 0]  # all such matrices have the same fingerprint
    return all(entry.is_Symbol for entry in nonzero) and len(set(nonzero)) == len(nonzero)


def page(*groups: Iterator[Named]) -> str:
    """Return the text of the file ``known_formulas.toml``, with all formulas that symrot derives.

    A test may pass ``groups`` of formulas to print only these.
    """
    lines = [
        "# What symrot derives, by fingerprint (checker/recognition/fingerprint.py), up to the names of symbols.",
        "# Printed by `python -m symrot.checker.recognition.known_formulas`; do not edit.",
    ]
    texts: set[str] = set()
    bounds = ((1, LONGEST, False), (3, LONGEST_DERIVED, False), (LEAST_OF_RELATION, LONGEST, True))
    for (least, longest, relation), formulas in zip(bounds, groups or (stated(), derived(), _related()), strict=False):
        for key, known in _selected(formulas, least, longest, relation):
            if least > 1 and known.text in texts:
                continue
            texts.add(known.text)
            lines += ["", "[[formula]]", f'key = "{key}"']
            lines += [f"{field} = {_quoted(getattr(known, field))}" for field in ("name", "source", "text")]
            lines += [f"{flag} = true" for flag in ("scaled", "only_named", "is_relation") if getattr(known, flag)]
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


@cache
def by_fingerprint() -> dict[str, list[Known]]:
    """Return {key: known formulas}; formulas with one key differ only in the names of symbols or by a factor."""
    # values that `page` prints are JSON too, which is read in a fraction of the time of TOML
    formulas: dict[str, list[Known]] = {}
    _, *entries = FILE.read_text(encoding="utf-8").split("\n[[formula]]\n")
    for entry in entries:
        fields = {
            name: json.loads(value) for name, _, value in (line.partition(" = ") for line in entry.splitlines() if line)
        }
        formulas.setdefault(fields.pop("key"), []).append(Known(**fields))
    return formulas


if __name__ == "__main__":
    FILE.write_bytes(page().encode())
