"""Smoothness of the torques of a plan, which decides whether Taylor series can be used. This module does not use SymPy.

A series needs derivatives of every order at its centre. Quotients, powers, sin, cos, exp and log have them wherever
they are defined. The absolute value and the square root have no derivative at zero, and a motion may reach such a
point, for example at rest. For such torques Dormand and Prince's method is used instead.
"""

from symrot.dynamics.structure import FormulaTorque, Pattern, TorqueStructure
from symrot.formula import tree as expression
from symrot.formula.switches import CHANGING
from symrot.planning.plan import Plan

__all__ = ["non_smooth_torque"]

BRANCHING = frozenset({"abs", "sqrt", "asin", "acos", "atan2"})  # not smooth somewhere on their domain


def _of_formulas(torque: FormulaTorque) -> str:
    for formula in torque.formulas:
        waiting = [expression.parse(formula)]
        while waiting:
            node = waiting.pop()
            inner = expression.children(node)
            waiting += inner
            if node[0] == "call" and node[1] in BRANCHING and any(CHANGING & expression.names(part) for part in inner):
                return f"the torque contains {node[1]}, which has no Taylor series at some arguments"
    return ""


def _of_torque(torque: TorqueStructure) -> str:
    if isinstance(torque, FormulaTorque):
        return _of_formulas(torque)
    if torque.kind == "damping" and torque.number("quadratic") is not Pattern.ZERO:
        return "quadratic damping has no Taylor series at rest"
    return ""


def non_smooth_torque(plan: Plan) -> str:
    """Return a sentence that says which torque of a plan is not smooth; an empty text if all torques are smooth.

    A torque is smooth if its Taylor series exists at every point where it is defined.
    """
    return next(filter(None, map(_of_torque, plan.structure.torques)), "")
