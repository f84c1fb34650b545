"""Numerical values of the parameters of kernels, for many initial states of one scene.

Most parameters depend on the scene alone: masses, moments, torques. They are evaluated once. Only parameters whose
formulas contain a number of the initial state, such as a constant spin, are evaluated again for another initial state.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction

from symrot.closed_form.arithmetic.pairs import quotient
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.formula.exact_functions import exact_value
from symrot.formula.tree import Node, names, text
from symrot.planning.plan import START_CONSTANTS, Plan
from symrot.planning.scene_kernel import Parameters

__all__ = ["Binding", "folded", "one_double", "two_doubles", "value_of"]


def one_double(top: int, bottom: int) -> tuple[float, ...]:
    """Return the double nearest to the ratio top/bottom, in a tuple of length 1."""
    return (top / bottom,)


def two_doubles(top: int, bottom: int) -> tuple[float, ...]:
    """Return two doubles whose sum is nearest to the ratio top/bottom: the nearest double and the rounded remainder."""
    return quotient(top, bottom)


class Binding:
    """Parameters of a kernel as functions of the initial state; all other numbers are evaluated once.

    Parameters
    ----------
    parameters : pairs of name and formula
        Parameters of a :class:`symrot.planning.scene_kernel.SceneKernel`.
    plan : Plan
        Plan of the scene, with any initial state.
    rounded : function
        Takes numerator and denominator of a value, returns the doubles that represent it.
    known : mapping
        Values of further names in the formulas, in addition to the constants of the plan.

    Raises
    ------
    OverflowError
        If a parameter exceeds the range of doubles. A call raises it too.
    """

    def __init__(
        self,
        parameters: Parameters,
        plan: Plan,
        rounded: Callable[[int, int], tuple[float, ...]] = one_double,
        known: Mapping[str, Fraction] | None = None,
    ) -> None:
        constants = {"pi": number.PI, **(known or {}), **plan.constants}
        fixed = {name: value for name, value in constants.items() if name not in START_CONSTANTS}
        values = [value_of(node, constants).as_integer_ratio() for _, node in parameters]
        self._rounded, self._numbers = rounded, [x for value in values for x in rounded(*value)]
        length = len(rounded(1, 1))
        self._moving = [
            (slice(length * k, length * (k + 1)), _Moving(folded(node, fixed)))
            for k, (_, node) in enumerate(parameters)
            if names(node) & START_CONSTANTS
        ]

    def __call__(self, plan: Plan) -> list[float]:
        """Return the parameters for a plan with another initial state, each computed exactly and rounded once."""
        numbers = self._numbers.copy()
        if self._moving:
            constants = plan.start_constants
            for place, moving in self._moving:
                numbers[place] = self._rounded(*moving.ratio(constants))
        return numbers


class _Moving:
    """A formula that depends on the initial state.

    A monomial in a single number of the initial state is evaluated with integers, which is faster than with Fractions.
    """

    def __init__(self, formula: Node) -> None:
        self._formula, self._monomial = formula, _monomial(formula)

    def ratio(self, constants: Mapping[str, Fraction]) -> tuple[int, int]:
        """Return the value of the formula as a pair of integers: numerator and positive denominator."""
        if self._monomial is None:
            return value_of(self._formula, constants).as_integer_ratio()
        top, bottom, name, power = self._monomial
        base = constants[name]
        return top * base.numerator**power, bottom * base.denominator**power


def _monomial(node: Node) -> tuple[int, int, str, int] | None:
    """Return a monomial as (numerator, denominator, name, power >= 1), or None if the formula is not a monomial."""
    if node[0] == "symbol":
        return 1, 1, node[1], 1
    if node[0] == "neg" and (inner := _monomial(node[1])):
        return -inner[0], *inner[1:]
    if node[0] == "**" and node[2] > 0 and (inner := _monomial(node[1])):
        return inner[0] ** node[2], inner[1] ** node[2], inner[2], inner[3] * node[2]
    if node[0] in ("*", "/") and node[2][0] == "number" and (inner := _monomial(node[1])):
        factor = Fraction(node[2][1]) if node[0] == "*" else 1 / Fraction(node[2][1])
        return inner[0] * factor.numerator, inner[1] * factor.denominator, *inner[2:]
    if node[0] == "*" and node[1][0] == "number" and (inner := _monomial(node[2])):
        factor = Fraction(node[1][1])
        return inner[0] * factor.numerator, inner[1] * factor.denominator, *inner[2:]
    return None


def value_of(formula: Node, constants: Mapping[str, Fraction]) -> Fraction:
    """Return the exact value of a formula that contains numbers and named constants only.

    Raises
    ------
    InputError
        If it has no real value, such as the logarithm of a negative number.
    """
    value = exact_value(formula, constants)
    if value != value:
        raise InputError(f"torque: expected constants with real values, but {text(formula)} has no real value")
    return Fraction(value)


def folded(node: Node, known: Mapping[str, Fraction]) -> Node:
    """Return a formula with every part that contains only numbers and known constants replaced by its value."""
    if names(node) <= known.keys():
        return ("number", value_of(node, known))
    if node[0] == "call":
        return ("call", node[1], tuple(folded(child, known) for child in node[2]))
    return tuple(folded(part, known) if isinstance(part, tuple) else part for part in node)
