"""Numerical values of the parameters of kernels, for many initial states of one scene.

A kernel is the generated code for the rates (time derivatives) of the states or for the output quantities. Its
parameters are formulas such as ``(B - C)/A``. For another initial state, only the formulas that contain a component of
the initial state, such as ``omega_1``, are evaluated again.
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
    """Return the double nearest to the ratio top/bottom, in a tuple of length 1, as :class:`Binding` expects it.

    For the ratio 1/4 it is ``(0.25,)``.
    """
    return (top / bottom,)


def two_doubles(top: int, bottom: int) -> tuple[float, ...]:
    """Return two doubles whose sum is the ratio top/bottom to 31 digits: about ``(0.333, 1.85e-17)`` for 1/3."""
    return quotient(top, bottom)


class Binding:
    """Function that takes a plan (the equations of a scene) and returns the values of a kernel's parameters.

    The plan may have any initial state: only formulas that contain components of the initial state are evaluated again.
    The values are doubles.

    Parameters
    ----------
    parameters : pairs of name and formula
        Parameters of a :class:`symrot.planning.scene_kernel.SceneKernel`.
    plan : Plan
        Plan of the scene, with any initial state; the plans in calls may differ from it in their initial state only.
    rounded : function
        Takes the numerator and denominator of a value, and returns the doubles that represent the value.
    known : mapping
        Values of names that occur in the formulas and are not constants of the plan.

    Raises
    ------
    OverflowError
        If the value of a parameter exceeds the range of doubles; a call raises the same error.
    InputError
        If the formula of a parameter has no real value.
    """

    def __init__(
        self,
        parameters: Parameters,
        plan: Plan,
        rounded: Callable[[int, int], tuple[float, ...]] = one_double,
        known: Mapping[str, Fraction] | None = None,
    ) -> None:
        constants = {"pi": number.PI, **(known or {}), **plan.constants}
        # values that do not depend on the initial state are computed once, here
        fixed = {name: value for name, value in constants.items() if name not in START_CONSTANTS}
        values = [value_of(node, constants).as_integer_ratio() for _, node in parameters]
        self._rounded, self._numbers = rounded, [x for value in values for x in rounded(*value)]
        length = len(rounded(1, 1))
        self._start_formulas = [
            (slice(length * k, length * (k + 1)), _StartFormula(folded(node, fixed)))
            for k, (_, node) in enumerate(parameters)
            if names(node) & START_CONSTANTS
        ]

    def __call__(self, plan: Plan) -> list[float]:
        """Return the values of the parameters, in order, for the initial state of ``plan``.

        In all else, ``plan`` must agree with the plan given to the constructor. The constructor's argument ``rounded``
        turns a value into doubles: one double by default, or two whose sum is more exact.
        """
        numbers = self._numbers.copy()
        if self._start_formulas:
            constants = plan.start_constants
            for place, formula in self._start_formulas:
                # exact, then rounded once: to one double or, for closed forms, to two doubles with 31 digits
                numbers[place] = self._rounded(*formula.ratio(constants))
        return numbers


class _StartFormula:
    """A formula that contains components of the initial state, such as ``3*omega_1**2``.

    It is evaluated for many initial states.
    """

    def __init__(self, formula: Node) -> None:
        # a monomial in one name is evaluated with integers, which is faster than with Fractions
        self._formula, self._monomial = formula, _monomial(formula)

    def ratio(self, constants: Mapping[str, Fraction]) -> tuple[int, int]:
        """Return the value of this formula of the initial state as two integers: (numerator, positive denominator).

        ``constants`` is a map from the names in the formula, such as ``"omega_1"``, to their values.
        """
        if self._monomial is None:
            return value_of(self._formula, constants).as_integer_ratio()
        top, bottom, name, power = self._monomial
        base = constants[name]
        return top * base.numerator**power, bottom * base.denominator**power


def _monomial(node: Node) -> tuple[int, int, str, int] | None:
    """Return a monomial in one name as (numerator, denominator, name, power): ``3*a**2/2`` gives ``(3, 2, "a", 2)``.

    Return None for any other formula, and for products in which the name occurs twice, such as ``a*a``.
    """
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
    """Return the value of a formula that contains numbers and named constants only: exact, or of some 90 digits.

    Raises
    ------
    InputError
        If the formula has no real value, such as the logarithm of a negative number.
    """
    value = exact_value(formula, constants)
    if value != value:
        raise InputError(f"torque: expected constants with real values, but {text(formula)} has no real value")
    return Fraction(value)


def folded(node: Node, known: Mapping[str, Fraction]) -> Node:
    """Return a formula with its known names replaced by their values.

    For ``known = {"A": 2}``, ``(A + 1)*omega_1`` becomes ``3*omega_1``.
    """
    if names(node) <= known.keys():
        return ("number", value_of(node, known))
    if node[0] == "call":
        return ("call", node[1], tuple(folded(child, known) for child in node[2]))
    return tuple(folded(part, known) if isinstance(part, tuple) else part for part in node)
