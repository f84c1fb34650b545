"""The gain of specialised kernels: cost of each motion with the most general kernel and with the scene's own kernel.

The general kernel has a full inertia tensor, the attitude and all kinds of torques that can act together. The result is
a table with a row for each motion: nanoseconds per evaluation of the rates in C, and microseconds per motion, each with
the general kernel and with the scene's own kernel. The column ``auto us`` is the time of the motion with the method
``auto``, for which symrot chooses a closed form or a stepper by itself. A row is marked ``TOO FAR`` if the final states
of these computations differ by more than AGREEMENT.
"""

import ctypes
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from symrot.bench.comparison.problem import Floats, Problem, State
from symrot.bench.comparison.race import Measured, race, seconds_of
from symrot.build import cache
from symrot.dynamics.torque_kinds import TORQUE_KINDS
from symrot.errors import InputError
from symrot.planning.general_structure import general_structure
from symrot.planning.plan import Plan, make_plan
from symrot.propagation.method import Choice
from symrot.propagation.motions.make import stepped_motion
from symrot.propagation.propagate import propagator
from symrot.scene.file import read_toml
from symrot.scene.scene import Scene, load_scene
from symrot.scene.torque import Torque

__all__ = ["LADDER", "general_plan", "lines", "measure", "rungs"]

LADDER = Path(__file__).with_name("skip.toml")
TOLERANCE, AGREEMENT = 1e-12, 1e-10  # tolerance of the motions, and allowed difference of their final states
STATES, TURNS = 64, 400  # evaluations in one call
ABOUT_CENTRE = ("gravity_gradient",)  # excludes gravity: it needs the centre of mass at rest, not a fixed point
ABOUT_POINT = ("gravity",)
LOOP = """
void many(long turns, const double *y, const double *p, double *dy)
{{
    for (long turn = 0; turn < turns; ++turn)
        for (int k = 0; k < {states}; ++k)
            symrot_rates((double)turn, y + {size}*k, p, dy + {size}*k);
}}
"""

Progress = Callable[[str], object]


def rungs() -> dict[str, tuple[str, Scene]]:
    """Return a map from the name of each compared motion to (description, scene), the most general motion first."""
    scenes = {}
    for name, entry in read_toml(LADDER, LADDER.name).items():
        about = str(entry.pop("about"))
        scenes[name] = (about, Scene.from_dict({"title": about, **entry}, name))
    return scenes


def _nothing(kind: str) -> Torque:
    """Return a torque of the given kind, such as ``damping``, whose constants make it zero."""
    zeros: dict[str, Any] = {
        "scalar": Fraction(0), "vector": (Fraction(0),) * 3, "scalar or vector": (Fraction(0),) * 3,
        "attitude": (Fraction(1), *(Fraction(0),) * 3),
    }  # fmt: skip
    fields = [field for field in TORQUE_KINDS[kind].fields if (kind, field.name) != ("gravity", "gravity")]
    return Torque(kind, {field.name: zeros[field.shape] for field in fields})


def general_plan(scene: Scene) -> Plan:
    """Return a plan for ``scene`` with full inertia tensor, no symmetry and all kinds of torques that can act together.

    A torque of a kind that the scene lacks is zero; a torque given by an expression is not added.
    """
    kinds = {torque.kind for torque in scene.torques}
    left_out = ABOUT_POINT if kinds & set(ABOUT_CENTRE) else ABOUT_CENTRE
    lacking = [kind for kind in TORQUE_KINDS if kind not in kinds and kind != "expression" and kind not in left_out]
    whole = replace(scene, torques=(*scene.torques, *map(_nothing, lacking)))
    return Plan(whole, general_structure(whole), ())


def measure(name: str | None = None, quick: bool = False, say: Progress = lambda text: None) -> dict[str, Any]:
    """Measure the time that specialised kernels save, and return it as data for JSON.

    The motion is the scene ``name``; without a name, a list of motions is measured.

    Raises
    ------
    InputError
        For a scene that cannot be used, or if there is no C compiler.
    """
    if cache.missing():
        raise InputError(f"--skip compares compiled kernels, so it needs a C compiler: {cache.missing()}")
    ladder = rungs() if name is None else {name: (load_scene(name).title, load_scene(name))}
    rows, entries = [], []
    for about, scene in ladder.values():
        say(f"{about} ..")
        row, runs = _row(about, scene)
        rows.append(row)
        entries += [(row, key, Measured(key, 0.0, 0, 0.0, seconds_of(run)), run) for key, run in runs.items()]
    race([(measured, run) for _, _, measured, run in entries], 5 if quick else 15,
         lambda number: say(f"{len(entries)} runs in turn: round {number + 1}"))  # fmt: skip
    for row, key, measured, _ in entries:
        side, what = key.split()
        row[side][what] = measured.median / (STATES * TURNS if what == "evaluation" else 1)
    return {"format": "symrot skip 1", "tolerance": TOLERANCE, "rows": rows}


def _row(about: str, scene: Scene) -> tuple[dict[str, Any], dict[str, Callable[[], object]]]:
    """Return the measurements of ``scene`` without its times, which are None, and a dictionary of functions to time.

    ``about`` describes the motion. A key of the dictionary, such as ``"own motion"``, says which time the function
    measures: here of the motion with the kernel specialised to the scene.
    """
    plans = {"general": general_plan(scene), "own": make_plan(scene)}
    row: dict[str, Any] = {"motion": about}
    runs: dict[str, Callable[[], object]] = {}
    ends: dict[str, State] = {}
    for side, plan in plans.items():
        row[side] = {"states": len(plan.states), "operations": 0, "evaluation": None, "motion": None}
        if not plan.states:
            continue
        problem = Problem(scene, plan)
        counts = problem.kernel.rates.operations()
        row[side]["operations"] = sum(count for name, count in counts.items() if name != "neg")
        runs[f"{side} evaluation"] = _evaluations(problem)
        motion, at = stepped_motion(plan, Choice("taylor", ""), TOLERANCE), np.array([problem.stop])
        runs[f"{side} motion"] = lambda motion=motion, at=at: motion.integrate(at)  # type: ignore[misc]
        ends[side] = problem.state(motion.integrate(at)[0][0], problem.stop)
    auto, at = propagator(scene, "auto", TOLERANCE), np.array([float(scene.span.stop)])
    trajectory = auto(at)
    ends["auto"] = State(trajectory.omega[0], trajectory.quaternion[0] if trajectory.has_attitude else None)
    runs["auto motion"] = lambda: auto(at)
    row["auto"] = {"method": auto.method, "motion": None}
    row["apart"] = max(Problem.error(end, ends["general"]) for end in ends.values())
    row["agrees"] = bool(row["apart"] <= AGREEMENT)
    return row, runs


def _evaluations(problem: Problem) -> Callable[[], object]:
    """Return a function to be timed: it evaluates the rates of a scene at many states near the initial state."""
    size = len(problem.y0)
    function = ctypes.CDLL(str(cache.build(problem.kernel.source + LOOP.format(states=STATES, size=size), "many"))).many
    function.argtypes, function.restype = (ctypes.c_long, *(ctypes.c_void_p,) * 3), None
    y: Floats = np.array(problem.y0) + 1e-3 * np.arange(STATES)[:, None]
    p, dy = np.array(problem.p or [0.0]), np.empty_like(y)
    return lambda: function(TURNS, y.ctypes.data, p.ctypes.data, dy.ctypes.data)


def _scaled(value: float | None, unit: float) -> str:
    return "-" if value is None else f"{value / unit:.3g}"


def lines(results: Mapping[str, Any]) -> list[str]:
    """Return, as lines of text with a title, the table of times that specialised kernels save.

    ``results`` come from :func:`measure`.
    """
    from symrot.report.layout import columns, fields, room

    rows = [["motion", "states", "operations", "ns", "motion us", "auto us", "", "ends apart"]]
    for row in results["rows"]:
        pairs = [row[side] for side in ("general", "own")]
        rows.append(
            [
                row["motion"],
                " -> ".join(str(side["states"]) for side in pairs),
                " -> ".join(str(side["operations"]) for side in pairs),
                " -> ".join(_scaled(side["evaluation"], 1e-9) for side in pairs),
                " -> ".join(_scaled(side["motion"], 1e-6) for side in pairs),
                _scaled(row["auto"]["motion"], 1e-6), row["auto"]["method"],
                f"{row['apart']:.0e}" + ("" if row["agrees"] else " TOO FAR"),
            ]
        )  # fmt: skip
    legend = (
        "general kernel -> the scene's own: states, operations and nanoseconds of one evaluation of the rates, "
        f"microseconds of the whole motion by Taylor series at {results['tolerance']:g}, and by the method that auto "
        "chooses"
    )
    return ["Time saved by specialised kernels, which leave out what a motion does not need", "",
            *columns(rows, right=(1, 2, 3, 4, 5, 7), width=room(140)), "", *fields([("", legend)])]  # fmt: skip
