"""Conserved quantities for the Taylor stepper, which corrects the states so that these quantities stay constant.

The module provides their C text and the values of their parameters. The derivation of the kernel proves which
quantities are conserved; the norm of the quaternion is added.
"""

from collections.abc import Sequence
from fractions import Fraction

from symrot.formula import exact_numbers as number
from symrot.formula.exact_functions import EXACT_FUNCTIONS
from symrot.formula.tree import evaluate
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import SceneKernel

__all__ = ["invariant_parameters", "invariant_source"]


def invariant_source(kernel: SceneKernel, states: Sequence[str]) -> str:
    """Return C code that computes the conserved quantities, whose values the Taylor stepper keeps constant.

    ``states`` are the names of the states, in the order of the C array that the code reads.
    """
    from symrot.codegen.taylor.invariant_source import invariant_definitions

    outputs = [item.output for item in kernel.conserved if item.holds]
    return invariant_definitions(kernel.quantities, outputs, states, [name for name, _ in kernel.quantity_parameters])


def invariant_parameters(kernel: SceneKernel, plan: Plan) -> list[float]:
    """Return the parameters of the conserved quantities, each as two doubles: the nearest one and the rounded rest.

    The order is that of the kernel's quantities: for two parameters the list is [first, its rest, second, its rest].
    """
    values = {"pi": number.PI, **plan.constants}
    pairs: list[float] = []
    for _, node in kernel.quantity_parameters:
        exact = Fraction(evaluate(node, values, EXACT_FUNCTIONS))
        pairs += [float(exact), float(exact - Fraction(float(exact)))]
    return pairs
