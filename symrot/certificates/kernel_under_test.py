"""The kernels that can be certified: library kernels, and the equations of motion of a scene.

A law is a property of a kernel's outputs that the certificate proves, such as "the norm is 1". It is a list of
expressions in inputs and outputs that must be zero.
"""

from collections.abc import Mapping, Sequence
from functools import reduce
from operator import add

import sympy
from sympy import Expr, Matrix, Rational, Symbol, zeros

from symrot.certificates.certificate import KernelUnderTest
from symrot.codegen.printing.banner import Description
from symrot.dynamics.equations import Equations
from symrot.formula.program import Program
from symrot.formula.tree import FUNCTIONS, Node, evaluate
from symrot.kernels.definition import Definition, Law
from symrot.kernels.derivative import exact_derivative
from symrot.kernels.jacobian import BY
from symrot.kernels.removable import explicit
from symrot.kinematics.quaternion import quaternion_product
from symrot.symbols import constant, omega_b

__all__ = ["library_kernel_under_test", "scene_kernel_under_test", "scene_laws"]

_FUNCTIONS = {name: sympy.Abs if name == "abs" else getattr(sympy, name) for name in FUNCTIONS}
DOUBLE_AND_FLOAT, ONLY_DOUBLE = {"": "double", "f": "float"}, {"": "double"}


def library_kernel_under_test(
    kernel: Definition, description: Description, files: Mapping[str, str]
) -> KernelUnderTest:
    """Return a library kernel with all that its certificate states: formulas, laws, description and files.

    Parameters
    ----------
    kernel : Definition
        The kernel's formulas and laws.
    description : Description
        The content of the header comments in the kernel's files.
    files : mapping of str to str
        A map from each file's path, relative to the certificate, to its text.
    """
    return KernelUnderTest(
        kernel.name, kernel.title, description, kernel.inputs, kernel.results, kernel.named, kernel.laws(), files,
        DOUBLE_AND_FLOAT,
    )  # fmt: skip


def scene_kernel_under_test(
    equations: Equations,
    program: Program,
    parameters: Sequence[tuple[str, Node]],
    description: Description,
    files: Mapping[str, str],
    outputs: Mapping[str, Expr],
    named: Sequence[tuple[Symbol, Expr]],
) -> KernelUnderTest:
    """Return the kernel of a scene's equations of motion, with all that its certificate states.

    Parameters
    ----------
    equations : Equations
        The equations of motion.
    program : Program
        The operations of the kernel, with the names of its arguments.
    parameters : sequence of (str, Node)
        Inputs that stand for formulas in physical constants, such as (B - C)/A, with these formulas.
    description, files
        As for :func:`library_kernel_under_test`.
    outputs : mapping of str to Expr
        A map from the name of each output to its formula: ``domega_1``, or its derivative ``domega_1_by_A``.
    named : sequence of (Symbol, Expr)
        Symbols for parts of the formulas, with their own formulas.
    """
    inputs = tuple(a for a in program.signature.arguments if a.role == "in" and a.size)
    targets = (a for a in program.signature.arguments if a.role == "out")
    results = tuple((a, tuple(outputs[component] for component, *_ in a.components)) for a in targets)
    laws = (*scene_laws(equations), *_derivative_laws(equations, tuple(outputs)))
    return KernelUnderTest(
        program.signature.name, description.title, description, inputs, results, tuple(named), laws, files, ONLY_DOUBLE,
        {name: _expression(node) for name, node in parameters},
    )  # fmt: skip


def _expression(node: Node) -> Expr:
    """Convert a formula from its syntax tree (``node``) to a SymPy expression in symbols of physical constants."""
    return evaluate(node, _ConstantsByName(), _FUNCTIONS, lambda value: Rational(value.numerator, value.denominator))


def _derivative_laws(equations: Equations, outputs: Sequence[str]) -> tuple[Law, ...]:
    """Return a tuple with the law that each output such as ``domega_1_by_A`` is the derivative that its name says.

    This output is the derivative of the rate ``domega_1`` with respect to ``A``. The tuple is empty if no output is a
    derivative.
    """
    rates = {f"d{state}": rate for state, rate in zip(equations.states, equations.explicit_rates, strict=True)}
    vanishing = []
    for output in outputs:
        rate, by, variable = output.partition(BY)
        if by:
            formula = explicit(rates[rate])
            symbols = {str(symbol): symbol for symbol in formula.free_symbols}
            slope = exact_derivative(formula, symbols[variable]) if variable in symbols else 0
            vanishing.append(constant(output) - slope)
    return (Law("each derivative is that of the formula of its rate", tuple(vanishing)),) if vanishing else ()


class _ConstantsByName(dict[str, Symbol]):
    """A dictionary in which any name is a key: its value is the symbol of the physical constant of that name."""

    def __missing__(self, name: str) -> Symbol:
        return constant(name)


def scene_laws(equations: Equations) -> tuple[Law, ...]:
    """Return laws that the time derivatives of a scene's states obey, such as "dq/dt is q (0, omega) / 2"."""
    # the equations of motion before they are solved for the rates, so that the laws also check the solution
    motion = equations.motion
    rate = {state: constant(f"d{state}") for state in equations.states}
    relations = tuple(equations.relations)
    laws = []
    if any(state in omega_b for state in equations.states):
        torque = reduce(add, (law.torque for law in equations.laws), zeros(3, 1))
        acceleration = Matrix([rate.get(w, 0) for w in omega_b])
        # in every component, even where a component of omega is constant and therefore not a state
        balance = motion.inertia * acceleration + motion.omega_b.cross(equations.momentum_b) - torque
        laws.append(Law("I domega/dt + omega x (I omega + h) is the torque", tuple(balance), relations))
    if motion.quaternion is not None and (quaternion_states := [s for s in equations.states if s not in omega_b]):
        q = Matrix(motion.quaternion)
        chain_rule = reduce(add, (q.diff(state) * rate[state] for state in quaternion_states), zeros(4, 1))
        quaternion_rate = quaternion_product(motion.quaternion, [0, *motion.omega_b]) / 2
        laws.append(Law("dq/dt is q (0, omega) / 2", tuple(chain_rule - Matrix(quaternion_rate)), relations))
    return tuple(laws)
