"""What there is to certify: kernels of the library, and the equations of motion of scenes, with laws that they obey."""

from collections.abc import Mapping, Sequence
from functools import reduce
from operator import add

from sympy import Expr, Matrix, Rational, Symbol, zeros

from symrot.certificates.certificate import Subject
from symrot.codegen.printing.banner import Description
from symrot.dynamics.equations import Equations
from symrot.formula.program import Program
from symrot.formula.tree import Node, evaluate
from symrot.kernels.definition import Definition, Law
from symrot.kinematics.quaternion import quaternion_product
from symrot.symbols import constant, omega_b

__all__ = ["library_subject", "scene_laws", "scene_subject"]

DOUBLE_AND_FLOAT, ONLY_DOUBLE = {"": "double", "f": "float"}, {"": "double"}


def library_subject(found: Definition, description: Description, files: Mapping[str, str]) -> Subject:
    """Return a kernel of the library as something to certify.

    Parameters
    ----------
    found : Definition
        What it computes.
    description : Description
        What the heads of its files say.
    files : mapping of str to str
        Path as seen from the certificate -> text.
    """
    return Subject(
        found.name, found.title, description, found.inputs, found.results, found.named, found.laws(), files,
        DOUBLE_AND_FLOAT,
    )  # fmt: skip


def scene_subject(
    equations: Equations,
    program: Program,
    parameters: Sequence[tuple[str, Node]],
    description: Description,
    files: Mapping[str, str],
) -> Subject:
    """Return the equations of motion of a scene as something to certify; parameters are formulas in its constants."""
    inputs = tuple(a for a in program.signature.arguments if a.role == "in" and a.size)
    (target,) = (a for a in program.signature.arguments if a.role == "out")
    return Subject(
        program.signature.name, description.title, description, inputs,
        ((target, equations.rates),), equations.definitions, scene_laws(equations), files, ONLY_DOUBLE,
        {name: _expression(node) for name, node in parameters},
    )  # fmt: skip


def _expression(node: Node) -> Expr:
    """Return a formula in the constants of a scene as an expression."""
    return evaluate(node, _Constants(), number=lambda value: Rational(value.numerator, value.denominator))


class _Constants(dict[str, Symbol]):
    """Every name is a constant."""

    def __missing__(self, name: str) -> Symbol:
        return constant(name)


def scene_laws(equations: Equations) -> tuple[Law, ...]:
    """Return what the rates of a scene have to obey, said without solving for them.

    ``I domega/dt + omega x (I omega + h)`` is the torque, in each component of omega that is a state, and also where
    a component is left out because it keeps its value; ``dq/dt`` is ``q (0, omega) / 2``.
    """
    motion = equations.motion
    rate = {state: constant(f"d{state}") for state in equations.states}
    relations = tuple(equations.relations)
    found = []
    if any(state in omega_b for state in equations.states):
        torque = reduce(add, (law.torque for law in equations.laws), zeros(3, 1))
        acceleration = Matrix([rate.get(w, 0) for w in omega_b])
        balance = motion.inertia * acceleration + motion.omega_b.cross(equations.momentum_b) - torque
        found.append(Law("I domega/dt + omega x (I omega + h) is the torque", tuple(balance), relations))
    if motion.quaternion is not None and (turning := [s for s in equations.states if s not in omega_b]):
        q = Matrix(motion.quaternion)
        turned = reduce(add, (q.diff(state) * rate[state] for state in turning), zeros(4, 1))
        wanted = quaternion_product(motion.quaternion, [0, *motion.omega_b]) / 2
        found.append(Law("dq/dt is q (0, omega) / 2", tuple(turned - Matrix(wanted)), relations))
    return tuple(found)
