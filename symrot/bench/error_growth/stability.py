"""The report on numerical stability: growth of errors, drift of invariants, gimbal lock, moving points of a body.

    symrot bench --stability [SCENE] [--long] [--plot FILE.png] [--json]

Without a scene, a free plate (moments 1, 3, 4) is followed for 1e5 revolutions, with ``--long`` 1e6. The reference is
a Taylor series with 40 digits; the closed form shares no code with it.
"""

import math
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.bench.comparison.exact_path import DIGITS
from symrot.bench.error_growth.growth import FROM, METHODS, Track, exponent, growth, median_curve
from symrot.bench.error_growth.points import carried, laws
from symrot.errors import InputError, PropagationError
from symrot.propagation.propagate import propagator
from symrot.report.layout import columns, room
from symrot.scene.scene import Scene

__all__ = ["lines", "stability"]

Floats = NDArray[np.float64]

STARTS = (("3/8", 1, "1/2"), (1, "1/4", "1/8"), ("5/8", "3/4", "-1/2"))  # rad/s, exact in doubles
PLATE = (1, 3, 4)  # kg m^2; (B - C)/A and its permutations are exact in doubles: all methods rotate the same body
POWERS = {False: 5, True: 6}  # exponent of ten: revolutions, by default and with --long
SAMPLES = 241  # samples of a scene
PASSES = ("1/10", "1/1000", "1/100000", "1/10000000", "1/1000000000", 0)  # smallest distances to gimbal lock, rad
SEQUENCE = "ZXZ"
STEPS = (0.1, 0.01, 0.001)  # step sizes for points of a body, s
CARRIED_FOR = 10.0  # duration for points of a body, s
CYLINDER = {"principal": [0.6375, 0.6375, 0.075]}  # chen, p. 23


def _scene(title: str, body: Any, omega: Any, attitude: Any = None) -> Scene:
    return Scene.from_dict(
        {
            "schema": 1, "title": title, "body": body, "span": {"t": [0, 1], "samples": 2},
            "initial": {"omega": list(omega), "attitude": attitude or {"quaternion": [1, 0, 0, 0]}},
            "output": {"quantities": ["omega", "quaternion"]},
        },
        title,
    )  # fmt: skip


def stability(scene: Scene | None = None, long: bool = False, say: Callable[[str], object] = lambda t: None) -> Any:
    """Return the report on numerical stability as data for JSON.

    Parameters
    ----------
    scene : Scene, optional
        The motion to follow; default: a free plate for many revolutions.
    long : bool
        Whether to follow the free plate for 1e6 revolutions instead of 1e5. For every motion, a scene's too, it also
        raises the limits of the slow methods: SciPy runs for at most 1e4 revolutions instead of 1e3, RK4 for at most
        1e6 instead of 1e5.
    say : callable
        Called with messages about the progress.

    Raises
    ------
    InputError
        If the scene cannot be followed, for example because its last time is its first.
    SymrotError
        If a method, or the reference in 40 digits, cannot follow the motion.
    """
    results: dict[str, Any] = {"format": "symrot stability 1", "long": long}
    results["growth"] = _of_scene(scene, long, say) if scene else _of_plates(long, say)
    say("Euler angles as state ..")
    results["passes"] = passes()
    say("points of a body ..")
    results["laws"] = [{"law": name, "holds": holds} for name, holds in laws()]
    results["points"] = [
        {"motion": name, **each._asdict()}
        for name, body, omega, size in (
            ("steady, position perpendicular to axis", {"principal": [1, 2, 3]}, (0, 0, 1), (1.0, 2.0, 0.0)),
            ("chen, p. 23: cylinder", CYLINDER, (1, 0, 1), (1.0, 1.0, 3.0)),
        )
        for each in carried(_scene(name, body, omega), CARRIED_FOR, STEPS, size)
    ]
    return _finite(results)


def _of_plates(long: bool, say: Callable[[str], object]) -> dict[str, Any]:
    power = POWERS[long]
    revolutions = 10.0 ** np.linspace(1, power, 6 * (power - 1) + 1)
    tracks = []
    for omega in STARTS:
        say(f"reference in {DIGITS} digits ..")
        scene = _scene("free plate", {"principal": list(PLATE)}, omega)
        size = math.sqrt(sum(float(w) ** 2 for w in scene.initial.omega_b))
        tracks.append(Track(scene, revolutions * (2.0 * math.pi / size), periodic=True))
    every = [growth(track, long, say) for track in tracks]
    curves = []
    for same in zip(*every, strict=True):
        invariants = {
            name: _median([c.invariants[name] for c in same], len(revolutions)) for name in same[0].invariants
        }
        curves.append(_curve(same[0].method, revolutions, median_curve(list(same), "attitude"),
                             median_curve(list(same), "rates"), invariants))  # fmt: skip
    title = f"free plate, moments {PLATE}, medians of {len(STARTS)} starts"
    return {
        "title": title, "variable": "revolutions", "at": revolutions.tolist(), "curves": curves,
        "reference_error": max(track.reference_error for track in tracks),
    }  # fmt: skip


def _median(rows: list[Floats], count: int) -> Floats:
    medians = np.full(count, np.nan)
    medians[: len(rows[0])] = np.median(rows, axis=0)
    return medians


def _of_scene(scene: Scene, long: bool, say: Callable[[str], object]) -> dict[str, Any]:
    if not scene.span.stop > scene.span.start:
        raise InputError(
            f"{scene.name}: span: expected a last time after the first, got {scene.span.start} to {scene.span.stop} s"
        )
    times = np.linspace(float(scene.span.start), float(scene.span.stop), SAMPLES)
    say(f"{scene.name}: reference in {DIGITS} digits ..")
    track = Track(scene, times, periodic=False)
    curves = []
    for curve in growth(track, long, say):
        invariants = {name: _median([values], len(times)) for name, values in curve.invariants.items()}
        curves.append(_curve(curve.method, None, curve.attitude, curve.rates, invariants))
    return {
        "title": scene.title, "variable": "t", "at": times.tolist(), "curves": curves,
        "omega": track.truth.omega.tolist(), "revolutions": track.turns(float(times[-1] - times[0])),
        "reference_error": track.reference_error,
    }  # fmt: skip


def _curve(
    method: str, at: Floats | None, attitude: Floats, rates: Floats, invariants: dict[str, Floats]
) -> dict[str, Any]:
    drift = np.max(
        [values for name, values in invariants.items() if name != "quaternion norm"] or [np.zeros(len(attitude))], 0
    )
    entry: dict[str, Any] = {
        "method": method, "about": next(each.about for each in METHODS if each.name == method),
        "attitude": attitude.tolist(), "rates": rates.tolist(),
        "invariants": {name: values.tolist() for name, values in invariants.items()},
    }  # fmt: skip
    if at is not None:
        entry["exponents"] = {"attitude": exponent(at, attitude), "invariants": exponent(at, drift)}
    return entry


def passes() -> list[dict[str, Any]]:
    """Return steps and errors of motions that pass near gimbal lock, for three choices of the integrated state.

    For a choice with which the motion cannot be computed, the dict has the reason (``"failed"``) instead.
    """
    t, rows = np.linspace(-3, 8, 45), []
    for distance in PASSES:
        attitude = {"sequence": SEQUENCE, "angles": ["1/5", distance, "3/10"]}
        scene = _scene("pass by gimbal lock", {"principal": [1, "6/5", 2]}, (0, "2/5", 1), attitude)
        exact = propagator(scene, "exact")(t)
        row: dict[str, Any] = {"distance": float(Fraction(distance))}
        # quaternion, Euler angles whose sequence is switched, Euler angles of one sequence
        for name, options in (("quaternion", {}), ("switching", {"state": SEQUENCE}),
                              ("angles", {"state": SEQUENCE, "switching": False})):  # fmt: skip
            try:
                trajectory = propagator(scene, "taylor", 1e-13, **options)(t)
            except PropagationError as error:
                row[name] = {"failed": str(error)}
                continue
            chord = np.minimum(*(np.abs(trajectory.quaternion - s * exact.quaternion).max(axis=1) for s in (1, -1)))
            row[name] = {
                "steps": trajectory.stats.accepted, "error": float(chord.max()), "switches": trajectory.stats.switches,
            }  # fmt: skip
        rows.append(row)
    return rows


# ------------------------------------------------------------------------------------------------ as text


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.1e}"


def _power(value: float | None) -> str:
    return "-" if value is None else f"t^{value:.2f}"


def _worst(values: Iterable[float | None]) -> float | None:
    return max((value for value in values if value is not None), default=None)


def lines(results: Any) -> list[str]:
    """Return the report on numerical stability as lines of text; ``results`` come from :func:`stability`."""
    return [*_growth_lines(results["growth"]), "", *_pass_lines(results["passes"]), "", *_point_lines(results)]


def _growth_lines(data: Any) -> list[str]:
    at = data["at"]
    if data["variable"] == "revolutions":
        places = [i for i, turns in enumerate(at) if abs(math.log10(turns) % 1) < 1e-9]
        heads = [f"1e{round(math.log10(at[i]))} rev" for i in places]
    else:
        places = [round(k * (len(at) - 1) / 6) for k in range(1, 7)]
        heads = [f"{at[i]:.4g} s" for i in places]
    error = data["reference_error"]
    right = DIGITS if not error else math.floor(-math.log10(error))
    text_lines = [
        data["title"], "",
        f"error of the attitude, rad, compared with a series in {DIGITS} digits, {right} of them correct at the end",
    ]  # fmt: skip
    rows = [["  method", *heads, *(["grows as"] if "exponents" in data["curves"][0] else [])]]
    drifts = [["  method", *heads, *rows[0][len(heads) + 1 :], "norm of q"]]
    for curve in data["curves"]:
        rows.append([f"  {curve['method']}", *(_figure(curve["attitude"][i]) for i in places)])
        invariants = {name: values for name, values in curve["invariants"].items() if name != "quaternion norm"}
        worst = [_worst(values[i] for values in invariants.values()) for i in places]
        drifts.append([f"  {curve['method']}", *map(_figure, worst)])
        if "exponents" in curve:
            rows[-1].append(_power(curve["exponents"]["attitude"]))
            drifts[-1].append(_power(curve["exponents"]["invariants"]))
        drifts[-1].append(_figure(_worst(curve["invariants"].get("quaternion norm", []))))
    aligned = tuple(range(1, len(drifts[0])))
    invariant_names = [name for name in data["curves"][0]["invariants"] if name != "quaternion norm"]
    text_lines += columns(rows, right=aligned[:-1])
    text_lines += [
        "",
        f"largest relative drift of {', '.join(invariant_names) or 'invariants (there are none)'}, "
        "and in the last column that of the norm of the quaternion during the whole motion",
        *columns(drifts, right=aligned),
    ]
    notes = "; ".join(f"{each.name}: {each.about}" for each in METHODS)
    if data["variable"] == "revolutions":
        notes += f". Powers are fitted from {FROM:.0f} revolutions on; rounding alone grows as t^0.5 in an invariant, "
        notes += "t^1.5 in an angle"
    return [*text_lines, "", *_wrapped(f"{notes}.")]


def _wrapped(text: str) -> list[str]:
    from textwrap import wrap

    return wrap(text, room(), initial_indent="  ", subsequent_indent="  ")


def _pass_lines(rows: Any) -> list[str]:
    def cells(row: Any, name: str) -> list[str]:
        one = row[name]
        return ["fails", "-"] if "failed" in one else [str(one["steps"]), _figure(one["error"])]

    table = [["  nearest", "quaternion", "error", f"{SEQUENCE}, switched", "error", f"{SEQUENCE} alone", "error"]]
    for row in rows:
        distance = "gimbal lock itself" if row["distance"] == 0 else f"{row['distance']:.0e} rad"
        table.append([f"  {distance}", *cells(row, "quaternion"), *cells(row, "switching"), *cells(row, "angles")])
    text_lines = [
        "a pass near gimbal lock: steps of the Taylor method and error, for each choice of the integrated state",
        *columns(table, right=tuple(range(1, 7))),
    ]
    failed = [row["angles"]["failed"] for row in rows if "failed" in row["angles"]]
    return text_lines + [line for text in failed[:1] for line in _wrapped(text)]


def _point_lines(results: Any) -> list[str]:
    text_lines = [f"points moved along their velocity for {CARRIED_FOR:g} s", *(
        f"  {'proven' if law['holds'] else 'NOT PROVEN'}: {law['law']}" for law in results["laws"])]  # fmt: skip
    rows = [["  motion", "step", "h, s", "growth", "by the law", "strain", "error"]]
    before = ""
    for each in results["points"]:
        name = "" if each["motion"] == before else each["motion"]
        before = each["motion"]
        rows.append([f"  {name}", each["scheme"], f"{each['h']:g}", f"{each['growth']:.10f}", f"{each['derived']:.10f}",
                     _figure(each["strain"]), _figure(each["error"])])  # fmt: skip
    return [*text_lines, *columns(rows, right=(2, 3, 4, 5, 6))]


def _finite(value: Any) -> Any:
    """Return data for JSON with None in place of nan and infinities."""
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
