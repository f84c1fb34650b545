"""Smoothness of the torques of a plan, which decides whether Taylor series can be used.

A series needs derivatives of every order. Quotients, powers, sin, cos, exp and log have them wherever they are
defined; absolute value and square root have none at zero, which a motion may reach. This module does not use SymPy.
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
    """Return a sentence that says which torque of a plan has no Taylor series somewhere; empty if none."""
    return next(filter(None, map(_of_torque, plan.structure.torques)), "")
