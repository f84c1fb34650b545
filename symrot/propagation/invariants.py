"""C text and parameters of the conserved quantities, which the Taylor stepper keeps constant."""

from collections.abc import Sequence
from fractions import Fraction

from symrot.formula import exact_numbers as number
from symrot.formula.exact_functions import EXACT_FUNCTIONS
from symrot.formula.tree import evaluate
from symrot.planning.plan import Plan
from symrot.planning.scene_kernel import SceneKernel

__all__ = ["invariant_parameters", "invariant_source"]


def invariant_source(kernel: SceneKernel, states: Sequence[str]) -> str:
    """Return C code that computes the conserved quantities from an array of the states, in the order of ``states``."""
    from symrot.codegen.taylor.invariant_source import invariant_definitions

    # those that the derivation of the kernel has proved; invariant_definitions adds the norm of the quaternion
    outputs = [item.output for item in kernel.conserved if item.holds]
    return invariant_definitions(kernel.quantities, outputs, states, [name for name, _ in kernel.quantity_parameters])


def invariant_parameters(kernel: SceneKernel, plan: Plan) -> list[float]:
    """Return the parameters of the conserved quantities, each as two doubles: the nearest one and the rounded rest."""
    values = {"pi": number.PI, **plan.constants}
    pairs: list[float] = []
    for _, node in kernel.quantity_parameters:
        exact = Fraction(evaluate(node, values, EXACT_FUNCTIONS))
        pairs += [float(exact), float(exact - Fraction(float(exact)))]
    return pairs
