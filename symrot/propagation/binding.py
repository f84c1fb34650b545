"""The parameters of kernels as numbers, for one start of a scene after another.

Most of them are the scene's: masses, moments, torques. They are evaluated once for a structure. Only those whose
formulas hold a number of the initial state, such as a constant spin, are evaluated again for another start.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction

from symrot import number
from symrot.expression import Node, evaluate, names
from symrot.planner import START_CONSTANTS, Plan
from symrot.scene_kernel import EXACT_FUNCTIONS, Parameters

__all__ = ["Binding", "folded", "one_double", "two_doubles", "value_of"]


def one_double(value: Fraction) -> list[float]:
    """Return the double nearest to a number."""
    return [float(value)]


def two_doubles(value: Fraction) -> list[float]:
    """Return the double nearest to a number, and what rounding to it left out."""
    high = float(value)
    return [high, float(value - Fraction(high))]


class Binding:
    """Parameters of a kernel, with the numbers that all starts of a structure share.

    Parameters
    ----------
    parameters : pairs of name and formula
        As a :class:`symrot.scene_kernel.SceneKernel` holds them.
    plan : Plan
        Of the structure, with any start.
    rounded : function
        From an exact number to the doubles that stand for it.
    known : mapping
        More constants of the formulas, by name.

    Raises
    ------
    OverflowError
        If a parameter is beyond all doubles; a call raises it too.
    """

    def __init__(
        self,
        parameters: Parameters,
        plan: Plan,
        rounded: Callable[[Fraction], list[float]] = one_double,
        known: Mapping[str, Fraction] | None = None,
    ) -> None:
        constants = {"pi": number.PI, **(known or {}), **plan.constants}
        fixed = {name: value for name, value in constants.items() if name not in START_CONSTANTS}
        self._rounded, self._numbers = rounded, [rounded(value_of(node, constants)) for _, node in parameters]
        self._moving = [
            (k, folded(node, fixed)) for k, (_, node) in enumerate(parameters) if names(node) & START_CONSTANTS
        ]

    def __call__(self, plan: Plan) -> list[float]:
        """Return the numbers for a plan of the structure: exact arithmetic, one rounding each."""
        found = self._numbers
        if self._moving:
            found, constants = list(found), plan.constants
            for k, node in self._moving:
                found[k] = self._rounded(value_of(node, constants))
        return [value for values in found for value in values]


def value_of(formula: Node, constants: Mapping[str, Fraction]) -> Fraction:
    """Return the exact value of a formula of constants."""
    return Fraction(evaluate(formula, constants, EXACT_FUNCTIONS))


def folded(node: Node, known: Mapping[str, Fraction]) -> Node:
    """Return a formula with each largest part that holds known constants alone as a number."""
    if names(node) <= known.keys():
        return ("number", value_of(node, known))
    if node[0] == "call":
        return ("call", node[1], tuple(folded(child, known) for child in node[2]))
    return tuple(folded(part, known) if isinstance(part, tuple) else part for part in node)
