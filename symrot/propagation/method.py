"""Choice of the method that computes a motion, with the reason for it."""

from typing import NamedTuple

from symrot.build import cache as library
from symrot.closed_form.registry import FORMS, ClosedForm, exact_form
from symrot.errors import CompilerError, InputError, with_hint
from symrot.formula.exact_numbers import show
from symrot.planning.plan import Plan
from symrot.propagation.steppers.smoothness import non_smooth_torque

__all__ = ["EXTERNAL_TORQUE", "METHODS", "Choice", "choose_method"]

METHODS = {
    "auto": "the first of the following methods that can compute the motion",
    "constant": "every state keeps its value",
    "exact": "closed form, at any time without stepping",
    "taylor": "Taylor series in steps, in C, with recurrences generated for the scene",
    "dop853": "Dormand-Prince 8(5,3) in steps, in C, with a kernel generated for the scene",
    "scipy": "a method of SciPy, with a NumPy kernel generated for the scene",
}
"""The name and description of every method; ``scipy`` means SciPy's DOP853, ``scipy:NAME`` another method of SciPy."""


class Choice(NamedTuple):
    """The chosen method, such as ``"taylor"``, the reason as text, and, only for ``exact``, the closed form."""

    method: str
    reason: str
    form: ClosedForm | None = None


def _automatic(plan: Plan) -> Choice:
    """Return the method that computes the motion of a plan if the user names no method, with the reason."""
    if not plan.states:
        return Choice("constant", "no state changes, so there is nothing to integrate")
    if form := exact_form(plan.scene):
        return Choice("exact", form.name, form)
    # without a compiler, SciPy takes the place of Taylor series and Dormand-Prince
    if no_compiler := library.missing():
        return Choice("scipy", no_compiler)
    if rough := non_smooth_torque(plan):
        return Choice("dop853", f"{rough}, and a C compiler is installed")
    between = " between its switches" if plan.switches else ""
    return Choice("taylor", f"the torque is smooth{between}, and a C compiler is installed")


EXTERNAL_TORQUE = Choice("dop853", "a torque without a formula has no Taylor series")
"""The method for motions under a torque without a formula."""


def choose_method(plan: Plan, method: str = "auto") -> Choice:
    """Return the named method; for ``"auto"``, the first method of :data:`METHODS` that can compute the motion.

    A scene with a table of torque samples always gets ``dop853``. If the plan has no state to integrate, the method
    ``constant`` replaces a method that takes steps.

    Raises
    ------
    InputError
        If there is no such method, or if it cannot compute this motion.
    CompilerError
        If the method needs a compiler and no compiler is installed.
    """
    if not isinstance(method, str):
        raise InputError(
            f"method: expected the name of a method, such as 'auto', got {show(method)}; pass times as the argument t"
        )
    if plan.scene.table is not None:
        if method not in ("auto", "dop853"):
            raise InputError(f"method: expected 'auto' or 'dop853' for a torque without a formula, got {method!r}")
        return EXTERNAL_TORQUE
    if method == "auto":
        return _automatic(plan)
    if method == "exact":
        form = exact_form(plan.scene)
        if form is None:
            raise InputError(
                f"method: expected a motion with a closed form ({', '.join(form.name for form in FORMS)}) for 'exact', "
                f"got the scene {plan.scene.name!r}"
            )
        return Choice(method, form.name, form)
    name, colon, solver = method.partition(":")
    if name == "scipy" and solver:
        from symrot.propagation.steppers.fallback import method_name

        method_name(solver)
    elif name not in METHODS or colon or name == "constant":
        known = [name for name in METHODS if name != "constant"]
        message = f"method: expected one of {', '.join(known)} or scipy:NAME, got {method!r}"
        raise InputError(with_hint(message, method, known))
    if not plan.states:
        return choose_method(plan)
    if name in ("taylor", "dop853") and (reason := library.missing()):
        raise CompilerError(f"method: {reason}, or use method 'scipy'")
    return Choice(method, "the method was requested")
