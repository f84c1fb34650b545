"""Scenes, plans, propagators and ensembles as tables of HTML."""

from symrot.ensemble.ensemble import Ensemble
from symrot.errors import InputError
from symrot.notebook.fragments import disclosure, heading, table
from symrot.planning.plan import Plan
from symrot.propagation.propagator import Propagator
from symrot.report import explain
from symrot.report.layout import number_text
from symrot.scene.scene import Scene
from symrot.scene.torque import Torque

__all__ = ["ensemble", "plan", "propagator", "scene"]

PARTS_OF_SAMPLE = (5, 50, 95)
"""Percentiles of each component of omega over the motions of an ensemble, at its last time, that a table shows."""


def scene(one: Scene) -> str:
    """Return the data of a scene as HTML: body, initial state, torques, time span, output; its file's text if known."""
    moments = ", ".join(map(number_text, one.body.principal.moments))
    rows = [
        ("body", f"{one.body.description}, principal moments {moments} kg m²"),
        ("start", f"ω = ({', '.join(map(number_text, one.initial.omega_b))}) rad/s in the body"),
        ("attitude", f"q = ({', '.join(map(number_text, one.initial.quaternion))})"),
        *(("torque", _torque(torque)) for torque in one.torques),
        *([("torque", f"{len(one.table.times)} samples")] if one.table else []),
        ("span", f"{number_text(one.span.start)} to {number_text(one.span.stop)} s, {one.span.samples} samples"),
        ("output", ", ".join(one.output.quantities)),
    ]
    try:
        text = disclosure("scene file", one.to_toml())
    except InputError:  # its body or torques were replaced after it was read
        text = ""
    return heading(one.title, one.name) + table(rows) + text


def _torque(torque: Torque) -> str:
    if torque.formulas:
        return f"({', '.join(torque.formulas)}) N m, {torque.frame} components"
    values = (
        f"{name} = ({', '.join(map(number_text, value))})"
        if isinstance(value, tuple)
        else f"{name} = {number_text(value)}"
        for name, value in torque.values.items()
    )
    return f"{torque.kind.replace('_', ' ')}: {', '.join(values)}"


def plan(one: Plan) -> str:
    """Return an HTML table of the plan of a scene: which quantities are computed or skipped, by which rule."""
    report = explain.facts(one)
    rows = [
        (row["item"], "skipped" if row["skipped"] else "kept", row["why"], row["derivation"])
        for row in report["rows"]
        if row["item"] != explain.KERNEL  # depends on the cache, not on the plan
    ]
    counts = report["operations"]
    cost = f"One evaluation of the rates costs {counts['specialised']} operations instead of {counts['general']}."
    return heading(one.scene.title, "plan") + table(rows, ("item", "", "rule", "derivation")) + f"<p>{cost}</p>"


def propagator(one: Propagator) -> str:
    """Return HTML about a propagator: its method with the reason for the choice, and the data of its scene."""
    return heading(f"Propagator: {one.method}", one.reason) + scene(one.scene)


def ensemble(one: Ensemble) -> str:
    """Return an HTML table about the motions of an ensemble: number, samples, method, percentiles of omega at the end.

    Motions that ended early are left out of the percentiles.
    """
    import numpy as np

    last = one.omega[:, -1, :]
    reached = last[np.isfinite(last).all(axis=1)]
    rows = [("motions", str(len(one))), ("samples", str(one.t.shape[-1])), ("method", one.method)]
    if len(reached) < len(one):
        rows.append(("stopped early", str(len(one) - len(reached))))
    head = heading(one.scene.title, "ensemble") + table(rows)
    if not len(reached):
        return head
    percentiles = np.percentile(reached, PARTS_OF_SAMPLE, axis=0)
    values = [(f"omega_{k + 1}", *(f"{percentiles[n, k]:.6g}" for n in range(3))) for k in range(3)]
    return head + table(values, ("at the last time, rad/s", *(f"{part} %" for part in PARTS_OF_SAMPLE)))
