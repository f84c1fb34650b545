"""Motions from plans: a plan has the equations of a scene, a :class:`Choice` the method by which they are solved."""

from dataclasses import replace

from symrot.closed_form.registry import ClosedForm
from symrot.planning.plan import Plan
from symrot.planning.rules import RuleOutcome
from symrot.propagation.compiled_models import compiled, scene_kernel, taylor_library
from symrot.propagation.method import Choice
from symrot.propagation.motions.methods import ClosedFormMotion, ConstantMotion, SciPyMotion, SteppedMotion
from symrot.propagation.motions.motion import RestartableMotion
from symrot.propagation.motions.setup import ClosedFormSetup, Setup, SteppedSetup, stepped_on_own_clock

__all__ = ["make_motion", "on_own_clock", "stepped_motion", "with_full_state"]


def make_motion(plan: Plan, choice: Choice, tolerance: float) -> RestartableMotion:
    """Return the motion that a plan, the equations of a scene, describes, from the initial state of the scene.

    ``choice`` is the method by which the motion is computed.
    """
    if choice.form is not None:
        choice.form.begin()
        plan = with_full_state(plan, choice.form)
        return ClosedFormMotion(ClosedFormSetup(_setup(plan, choice, tolerance), choice.form), plan)
    if choice.method in ("taylor", "dop853"):
        return stepped_motion(plan, choice, tolerance)
    setup = _setup(plan, choice, tolerance)
    return ConstantMotion(setup, plan) if choice.method == "constant" else SciPyMotion(setup, plan)


def _setup(plan: Plan, choice: Choice, tolerance: float) -> Setup:
    return Setup(plan, choice, tolerance, float(plan.scene.span.start), lambda: scene_kernel(plan))


def stepped_motion(plan: Plan, choice: Choice, tolerance: float) -> SteppedMotion:
    """Return the motion of a plan (equations of a scene), integrated in C by Taylor series or DOP853."""
    setup = _setup(plan, choice, tolerance)
    if choice.method == "taylor":
        library = taylor_library(plan, setup.kernel, tolerance)
    else:
        kernel, library = compiled(plan)
        setup = replace(setup, load_kernel=lambda: kernel)
    return SteppedMotion(SteppedSetup(setup, library), plan)


def on_own_clock(plan: Plan, choice: Choice, tolerance: float) -> SteppedMotion | SciPyMotion:
    """Return the motion of a plan (equations of a scene), integrated by the method of ``choice``, in C or by SciPy.

    Time is counted from the start of the motion if its rates depend on time.
    """
    setup = _setup(plan, choice, tolerance)
    timed, steps_in_c = setup.kernel.rates.uses("t"), choice.method in ("taylor", "dop853")
    if not timed:
        # the clock remains scene time
        return stepped_motion(plan, choice, tolerance) if steps_in_c else SciPyMotion(setup, plan)
    # the epoch, the scene time at which the clock shows 0, becomes a parameter of the rates
    setup = setup.on_own_clock
    if steps_in_c:
        return SteppedMotion(stepped_on_own_clock(setup), setup.plan)
    return SciPyMotion(setup, setup.plan)


def with_full_state(plan: Plan, form: ClosedForm) -> Plan:
    """Return a plan (the equations of a scene) for a motion in closed form, in which no state is eliminated.

    The rules that eliminate states are left out of the plan's list of rules; a last entry is added, whose reason is
    that the motion has the closed form ``form``.
    """
    # a closed form gives all states at no cost, since nothing has to be integrated
    structure = plan.structure.unreduced()
    rows, before = [], structure.reductions
    for row in plan.rows:
        if row.structure.reductions == before:
            rows.append(row)
        before = row.structure.reductions
    why = f"the motion has a closed form: {form.name}"
    rows.append(RuleOutcome(structure, True, why, form.derivation, "stepping"))
    return replace(plan, structure=structure, rows=tuple(rows))
