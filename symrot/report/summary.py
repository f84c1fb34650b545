"""The report of a run: its settings and results as plain data, and as text on one screen."""

from typing import TYPE_CHECKING, Any

from symrot import __version__
from symrot.report.layout import apart, columns, duration, exact, fields, number_text, one_line

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from symrot.propagation.propagator import Propagator
    from symrot.propagation.trajectory import Trajectory
    from symrot.report.records import (
        BodyRecord,
        CostRecord,
        FinalRecord,
        LostRecord,
        RunReport,
        SwitchingRecord,
        WrittenRecord,
    )

__all__ = ["facts", "summary"]

SWITCHES_SHOWN = 6
HOW = {"passed": "", "held": " (held from there on)", "released": " (released)"}
ABOUT = {"center_of_mass": "its centre of mass", "fixed_point": "a fixed point"}


def facts(propagator: "Propagator", trajectory: "Trajectory", preparation: float) -> "RunReport":
    """Return the settings and results of a run as data for JSON.

    Parameters
    ----------
    propagator, trajectory : Propagator, Trajectory
        The propagator, and the trajectory that it returned for the times of the scene.
    preparation : float
        The time in seconds that it took to derive and compile the kernel, or to load it.
    """
    scene, plan, stats = trajectory.scene, propagator.plan, trajectory.stats
    body = scene.body
    final: FinalRecord = {"t": float(trajectory.t[-1]), "omega": trajectory.omega[-1].tolist()}
    if trajectory.has_attitude:
        final["quaternion"] = trajectory.quaternion[-1].tolist()
    if (every := trajectory.sensitivities) is not None:
        final["sensitivities"] = {
            name: {
                "omega": _unless_nan(every[name].omega[-1]),
                "rotation": _unless_nan(every[name].rotation[-1]),
                "unit": unit,
            }
            for name, unit in zip(every.variables, every.units, strict=True)
        }
    return {
        "symrot": __version__,
        "scene": {"name": scene.name, "title": scene.title, "source": scene.source, "path": scene.path},
        "body": {
            "description": body.description,
            "class": body.principal.kind,
            "principal_moments": [exact(moment) for moment in body.principal.moments],
            "axes_are_principal": body.principal.given_axes,
            "about": body.about,
            "mass": None if body.mass is None else exact(body.mass),
        },
        "torques": list(scene.torque_kinds),
        "initial": {
            "omega": [exact(value) for value in scene.initial.omega_b],
            "quaternion": [float(value) for value in scene.initial.quaternion],
        },
        "span": {"start": exact(scene.span.start), "stop": exact(scene.span.stop), "samples": scene.span.samples},
        "method": {"name": propagator.method, "reason": propagator.reason, "tolerance": propagator.tolerance},
        "states": list(plan.states),
        "plan": [
            {"item": row.item, "skipped": row.skipped, "why": row.why, "derivation": row.derivation}
            for row in plan.rows
        ],
        "cost": {
            "steps": stats.accepted,
            "rejected": stats.rejected,
            "evaluations": stats.evaluations,
            "seconds": stats.seconds,
            "preparation_seconds": preparation,
        },
        "switching_times": list(stats.switching_times),
        "switchings": [{"t": each.t, "function": each.function, "how": each.how} for each in stats.switchings],
        "warnings": list(trajectory.warnings),
        "invariants": [
            {
                "name": item.name, "unit": item.unit, "initial": float(item.values[0]), "scale": item.scale,
                "drift": item.drift, "reason": item.reason,
            }
            for item in trajectory.invariants
        ],
        "not_conserved": [
            {"name": item.name, "unit": item.unit, "reason": item.reason}
            for item in propagator.kernel.conserved
            if not item.holds
        ],
        "final": final,
        "written": {},
    }  # fmt: skip


def _numbers(values: list[Any], digits: int = 6) -> str:
    return ", ".join(number_text(float(value), digits) for value in values)


def _value(text: str) -> float:
    """Return a number from its text, a fraction or decimal: ``"51/80"`` -> 0.6375, ``"1e-9"`` -> 1e-9."""
    numerator, _, denominator = text.partition("/")
    return float(numerator) / float(denominator or 1)


def _body(body: "BodyRecord") -> str:
    moments = [_value(moment) for moment in body["principal_moments"]]
    turned = "" if body["axes_are_principal"] else " (the axes of the scene are not principal)"
    return (
        f"{one_line(body['description'])}: {body['class']}, principal moments {_numbers(moments)} kg m^2 about "
        f"{ABOUT[body['about']]}{turned}"
    )


def _states(names: list[str]) -> str:
    return ", ".join(names).replace("omega_1, omega_2, omega_3", "omega_1..3").replace("q0, q1, q2, q3", "q0..q3")


def _steps(cost: "CostRecord", exact: bool) -> str:
    if exact:
        samples, preparation = duration(cost["seconds"]), duration(cost["preparation_seconds"])
        return f"no steps, {samples} for the samples, {preparation} to prepare"
    again = f" ({cost['rejected']} tried again)" if cost["rejected"] else ""
    return (
        f"{cost['steps']} steps{again}, {cost['evaluations']} evaluations in {duration(cost['seconds'])}; "
        f"the kernel was ready in {duration(cost['preparation_seconds'])}"
    )


def _settings(report: "RunReport") -> list[tuple[str, str]]:
    span, method = report["span"], report["method"]
    from symrot.propagation.method import METHODS  # imported here: an error found earlier needs no NumPy

    meaning = METHODS[method["name"].partition(":")[0]]
    torques = ", ".join(kind.replace("_", " ") for kind in report["torques"]) or "none"
    exact = method["name"] == "exact"
    start, stop = apart(_value(span["start"]), _value(span["stop"]))
    return [
        ("body", _body(report["body"])),
        ("torque", torques),
        ("start", f"omega = ({_numbers([_value(x) for x in report['initial']['omega']])}) rad/s in the body"),
        ("span", f"{start} to {stop} s, {span['samples']} samples"),
        ("method", f"{method['name']} ({meaning}); {method['reason']}"),
        ("tolerance", f"{method['tolerance']:g}"),
        ("states", (not exact and _states(report["states"])) or "none to integrate"),
        ("cost", _steps(report["cost"], exact)),
        *_switches(report["switching_times"], report["switchings"], span["start"], span["stop"]),
        *(("warning", text) for text in report["warnings"]),
    ]  # fmt: skip


def _switches(times: list[float], switchings: "list[SwitchingRecord]", start: str, stop: str) -> list[tuple[str, str]]:
    """Return rows (label, text) for functions with jumps or kinks: the times at which each switched.

    At most SWITCHES_SHOWN functions and times are listed, with the total numbers if there are more. Times of a table of
    samples are listed if no function switched.
    """
    by_function: dict[str, list[tuple[float, str]]] = {}
    for item in switchings:
        by_function.setdefault(f"{one_line(item['function'])} ", []).append((item["t"], HOW[item["how"]]))
    if times and not by_function:
        by_function[""] = [(t, "") for t in times]
    listed = dict(list(by_function.items())[:SWITCHES_SHOWN])
    seen = [t for own in listed.values() for t, _ in own[:SWITCHES_SHOWN]]
    texts = dict(zip(seen, apart(_value(start), _value(stop), *seen)[2:], strict=True))
    rows = []
    for function, own in listed.items():
        listed_times = ", ".join(f"{texts[t]}{how}" for t, how in own[:SWITCHES_SHOWN])
        more = f", .. ({len(own)} times in all)" if len(own) > SWITCHES_SHOWN else ""
        rows.append(f"{function}at t = {listed_times}{more} s")
    if len(by_function) > len(listed):
        rows.append(f".. ({len(by_function)} functions in all; --json lists them)")
    return [("switches" if number == 0 else "", row) for number, row in enumerate(rows)]


def _skipped(report: "RunReport") -> list[tuple[str, str]]:
    rows = [f"{row['item']}: {row['why']}" for row in report["plan"] if row["skipped"]]
    return [("skipped" if number == 0 else "", row) for number, row in enumerate(rows)]


def _conserved(report: "RunReport") -> list[str]:
    rows = [("  kept", "at the start", "relative drift", "why")]
    for item in report["invariants"]:
        unit = "" if item["unit"] == "1" else f" {item['unit']}"
        rows.append(
            (f"  {item['name']}", f"{number_text(item['initial'])}{unit}", f"{item['drift']:.1e}", item["reason"])
        )
    lines = columns(rows, right=(2,))
    if not report["invariants"]:
        lines = ["  kept  no conserved quantity can be formed from the integrated states"]
    return lines + [f"  {line}" for line in fields(_lost(report["not_conserved"]))]


def _lost(candidates: "list[LostRecord]") -> list[tuple[str, str]]:
    """Return rows (label, text) with the quantities that this motion does not conserve, one row for each reason."""
    names: dict[str, list[str]] = {}
    for item in candidates:
        names.setdefault(item["reason"], []).append(item["name"])
    rows = [f"{', '.join(quantities)}: {reason}" for reason, quantities in names.items()]
    return [("not kept" if number == 0 else "", row) for number, row in enumerate(rows)]


def _unless_nan(row: "NDArray[np.float64]") -> list[float] | None:
    """Return derivatives as a list; None if they do not exist, at a switch of a torque."""
    values: list[float] = row.tolist()
    return None if any(value != value for value in values) else values


def _final(final: "FinalRecord", start: float) -> list[str]:
    rows = [
        ("end", f"t = {apart(start, final['t'])[1]} s"),
        ("  omega", f"({_numbers(final['omega'], 12)}) rad/s in the body"),
    ]
    if "quaternion" in final:
        rows.append(("  attitude", f"({_numbers(final['quaternion'], 12)}) as a quaternion"))
    for name, slopes in final.get("sensitivities", {}).items():
        omega, rotation = slopes["omega"], slopes["rotation"]
        if omega is None or rotation is None:
            rows.append((f"  by {name}", "no derivative: a torque switches at this time, and the derivative jumps"))
            continue
        rows.append((f"  by {name}", f"omega ({_numbers(omega, 9)}), "
                     f"rotation about the body axes ({_numbers(rotation, 9)})"))  # fmt: skip
    return [f"  {line}" for line in fields(rows)]


def _written(written: "dict[str, WrittenRecord]") -> list[str]:
    rows = [("written", "nothing; --out FILE.npz or FILE.csv keeps the motion, --plot FILE.png draws it")]
    if written:
        rows = [("", f"{item['file']}{_holding(item)}") for item in written.values()]
        rows[0] = ("written", rows[0][1])
    return [f"  {line}" for line in fields(rows)]


def _holding(item: "WrittenRecord") -> str:
    return f": {', '.join(item['arrays'])} at {item['samples']} times" if "arrays" in item else ""


def summary(report: "RunReport") -> list[str]:
    """Return the lines that `symrot run` prints about a run; ``report`` is the data of :func:`facts`.

    The first line is a title.
    """
    scene = report["scene"]
    source = [f"  {line}" for line in fields([("", one_line(scene["source"]))])] if scene["source"] else []
    settings = [f"  {line}" for line in fields(_settings(report) + _skipped(report))]
    return [
        f"{one_line(scene['title'])} [{one_line(scene['name'])}]",
        *(line.replace("    ", "  ", 1) for line in source),
        "",
        *settings,
        "",
        *_conserved(report),
        "",
        *_final(report["final"], _value(report["span"]["start"])),
        "",
        *_written(report["written"]),
    ]
