"""The plan of a scene as a table: what is computed or skipped, by which rule, and how many operations that saves."""

from collections import Counter
from typing import TYPE_CHECKING

from symrot.dynamics.structure import Structure
from symrot.planning.plan import Plan
from symrot.report.layout import apart, columns, one_line, room
from symrot.scene.tables import QUANTITIES

if TYPE_CHECKING:
    from symrot.report.records import PlanReport, PlanRow

__all__ = ["KERNEL", "explanation", "facts", "lines"]

KERNEL = "deriving the kernel"
"""Name of the row in the table of `symrot explain` that says whether the cache contains the scene's kernel."""

HEAD = ("item", "", "rule", "derivation", "operations", "saved")
FREE = frozenset({"neg"})  # a minus sign counts as part of its addition or multiplication


def _operations(structure: Structure) -> Counter[str]:
    """Return how many operations of each kind one evaluation of the equations of motion needs: ``{"mul": 12, ..}``."""
    from symrot.codegen.scene_kernels import rates_program
    from symrot.dynamics.equations import equations_of_motion

    counts = rates_program(equations_of_motion(structure), "rates").program.operations()
    return Counter({name: count for name, count in counts.items() if name not in FREE})


def _row(item: str, skipped: bool, why: str, derivation: str = "", operations: Counter[str] | None = None) -> "PlanRow":
    counts = None if operations is None else dict(sorted(operations.items()))
    return {"item": item, "skipped": skipped, "why": why, "derivation": derivation, "operations": counts, "saved": None}


def _ladder(plan: Plan) -> "list[PlanRow]":
    """Return rows of the table of `symrot explain` that count the operations of the equations of motion.

    The first row counts the operations of the most general equations. Each further row is about a rule that may shorten
    equations for this scene, such as equal moments, with the number of operations that the rule saves.
    """
    from symrot.planning.general_structure import general_structure

    general = _operations(general_structure(plan.scene, bool(plan.switches)))
    rows = [_row("general motion", False, "any tensor, any direction of every torque, full attitude", "", general)]
    before = general
    for rule in plan.rows:
        after = _operations(rule.structure)
        rows.append(_row(rule.item, rule.skipped, rule.why, rule.derivation, after))
        rows[-1]["saved"] = before.total() - after.total()
        before = after
    return rows


def _others(plan: Plan) -> "list[PlanRow]":
    """Return the rows of the table of `symrot explain` that count no operations.

    They are about states, method, samples and formulas of torques, outputs and cache.
    """
    from symrot.build import cache as library
    from symrot.propagation.compiled_models import kernel_key
    from symrot.propagation.method import choose_method

    choice, asked = choose_method(plan), plan.scene.output.quantities
    missing = [name for name in QUANTITIES if name not in asked]
    form = choice.form
    stepped = f"the motion has a closed form: {form.name}" if form else f"{choice.method}: {choice.reason}"
    known = library.fetch(kernel_key(plan)) is not None
    kernel = (
        "the kernel of these equations is in the cache"
        if known
        else "the first run derives and compiles, later ones load"
    )
    return [
        _row("states", not plan.states, f"{', '.join(plan.states) or 'none changes'}"),
        _row("stepping", form is not None or not plan.states, stepped, form.derivation if form else ""),
        *_samples(plan),
        *_formulas(plan, choice.method),
        _row("outputs asked for", False, ", ".join(asked)),
        *([_row("other outputs", True, f"not asked for: {', '.join(missing)}")] if missing else []),
        _row(KERNEL, known, kernel),
    ]


BENDS = frozenset({"abs", "min", "max", "clip"})


def _formulas(plan: Plan, method: str) -> "list[PlanRow]":
    """Return the rows of the table of `symrot explain` about short pulses, jumps and kinks in torque formulas.

    They say how the steps of the integration notice these features; ``method`` is the integration method. The list is
    empty if no torque is a formula.
    """
    from symrot.propagation.compiled_models import has_formulas

    if not has_formulas(plan):
        return []
    if method in ("exact", "constant"):
        return [_row("narrow features", True, "the motion has no steps that could miss a narrow feature")]
    return [_narrow_features(plan), *([_switches(plan.switches)] if plan.switches else [])]


def _narrow_features(plan: Plan) -> "PlanRow":
    from symrot.codegen.enclosure.terms import enclosure
    from symrot.codegen.taylor.recurrences import recurrences
    from symrot.errors import InputError
    from symrot.propagation.compiled_models import scene_kernel

    try:
        terms = enclosure(recurrences(scene_kernel(plan).rates))
    except InputError as reason:  # without a Taylor series there are no bounds inside a step
        return _row("narrow features", False, f"a step may miss a narrow feature: {reason}")
    if terms is None:
        why = "the formulas are polynomials of low degree, or sines and cosines of time: they have no narrow features"
        return _row("narrow features", True, why)
    why = "bounds of the formulas (an enclosure) limit each step, so that it misses no pulse, switch or pole"
    return _row("narrow features", False, why)


def _switches(functions: list[str]) -> "PlanRow":
    """Return the row of the table of `symrot explain` about functions with jumps or kinks, such as sign(x), in torques.

    ``functions`` are their calls as text.
    """
    named = [(text, text.partition("(")[0] in BENDS) for text in dict.fromkeys(functions)]
    parts = [
        f"{', '.join(text for text, bent in named if bent is bends)} {verb}"
        for bends, verb in ((False, "jump"), (True, "bend"))
        if any(bent is bends for _, bent in named)
    ]
    why = (
        f"{'; '.join(parts)}: these times are located to the last bits, by bounds of the formulas (an enclosure), and "
        "steps end exactly there; where both sides of a jump lead back to the jump, the motion slides along it"
    )
    return _row("switches", False, one_line(why))


def _samples(plan: Plan) -> "list[PlanRow]":
    """Return a list with one row of the table of `symrot explain`, about a torque given by samples in a file.

    The list is empty if the scene has no such torque.
    """
    table = plan.scene.table
    if table is None:
        return []
    first, last, *switches = apart(table.times[0], table.times[-1], *table.switching_times)
    jumps = f", jumps at {', '.join(switches)} s" if switches else ""
    why = f"{len(table.times)} samples from {first} to {last} s, cubic splines{jumps}"
    return [_row("torque by samples", False, f"{why}; its operations are not counted here")]


def facts(plan: Plan) -> "PlanReport":
    """Return the table of `symrot explain` as data for JSON.

    The first rows are about the rules that may shorten the equations, one after the other. In such a row,
    ``operations`` has the numbers of multiplications, additions, .. that remain in the equations after this rule and
    the rules of the rows above it, and ``saved`` is the number of operations that the rule saves. The other rows count
    no operations: both values are None.
    """
    scene = plan.scene
    ladder = _ladder(plan)
    rows = [*ladder, *_others(plan), *(_row("warning", False, one_line(text)) for text in scene.warnings)]
    return {
        "scene": {"name": scene.name, "title": scene.title, "source": scene.source},
        "rows": rows,
        "operations": {
            "general": sum((ladder[0]["operations"] or {}).values()),
            "specialised": sum((ladder[-1]["operations"] or {}).values()),
        },
    }


def _counts_text(counts: dict[str, int] | None) -> str:
    order = ("mul", "add", "div")
    if counts is None:
        return ""
    names = [*order, *sorted(set(counts) - set(order))]
    return ", ".join(f"{counts[name]} {name}" for name in names if counts.get(name)) or "none"


def lines(report: "PlanReport") -> list[str]:
    """Return the lines of text that `symrot explain` prints, from the data of :func:`facts`; the title comes first."""
    rows = [HEAD]
    for row in report["rows"]:
        changed = row["saved"] != 0
        saved = str(row["saved"]) if changed and row["saved"] else ""
        verdict = "skipped" if row["skipped"] else "kept"
        left = _counts_text(row["operations"]) if changed else ""
        rows.append((row["item"], verdict, one_line(row["why"]), row["derivation"], left, saved))
    table = columns(rows, width=room(118), wrap=2, right=(5,))
    counts = report["operations"]
    rule = "-" * max(map(len, table))
    last = f"One evaluation of the rates costs {counts['specialised']} operations instead of {counts['general']}."
    title = f"{one_line(report['scene']['title'])} [{one_line(report['scene']['name'])}]"
    return [title, "", table[0], rule, *table[1:], rule, last]


def explanation(plan: Plan) -> str:
    """Return the text that `symrot explain` prints: what is computed or skipped, and by which rule."""
    return "\n".join(lines(facts(plan)))
