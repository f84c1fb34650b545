"""Times to compute a motion from a new initial state: by another call of a propagator, and in an ensemble.

    python -m symrot.bench.starts [--rounds 300] [SCENE ...]
    python -m symrot.bench.starts --ensembles [--most 100000] [--rounds 5] [SCENE ...]

The first table has microseconds per call, the second per trajectory of 101 samples. All are medians of processor time.
"""

import argparse
import ctypes
from collections.abc import Callable, Iterator
from functools import partial
from math import nan
from statistics import median
from time import process_time_ns
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.build.address import address
from symrot.closed_form import motion as forms
from symrot.closed_form.spin_up import compiled as spin_up_compiled
from symrot.ensemble.ensemble import propagate_ensemble
from symrot.ensemble.variation import PLACES
from symrot.errors import InputError
from symrot.planning.plan import structure_key
from symrot.propagation.propagate import propagator
from symrot.propagation.propagator import Propagator, read_start
from symrot.propagation.steppers.stepping import DONE
from symrot.scene.scene import Scene, load_scene

__all__ = ["main"]

SCENES = ("t_handle", "heavy_top_loops", "gyrostat", "damped_disk", "gravity_gradient_satellite")
ENSEMBLES = ("t_handle", "axisymmetric_satellite", "heavy_top_loops", "spin_up")
METHODS = ("exact", "taylor", "dop853")
SAMPLES = 101
SIZES = (10, 100, 1_000, 10_000, 100_000)
SPREAD = 0.01

Floats = NDArray[np.float64]


def _made(name: str, torques: list[dict[str, Any]], inertia: Any, omega: list[str], **more: Any) -> Scene:
    body: dict[str, Any] = {"inertia": inertia} if isinstance(inertia, dict) else {"principal": inertia}
    if any(torque["kind"] == "gravity" for torque in torques):
        body["about"] = "fixed_point"
    initial = {"omega": omega, "attitude": {"quaternion": [1, "1/3", "-1/5", "2/7"]}}
    span = {"t": [0, 20], "samples": SAMPLES}
    return Scene.from_dict(
        {"schema": 1, "title": name, "body": body, "torque": torques, "initial": initial, "span": span, **more}
    )


_BRAKE = {"kind": "damping", "linear": ["1/10", "1/10", "1/5"]}
_PUSH = {"kind": "constant_body", "torque": [0, 0, "1/9"]}
MADE: dict[str, Callable[[], Scene]] = {
    "tilted free body": lambda: _made(
        "tilted free body",
        [],
        {"xx": 3, "yy": 4, "zz": 5, "xy": "-1/10", "xz": "1/5", "yz": "1/7"},
        ["1/3", "-1/7", "2"],
    ),
    "turned heavy top": lambda: _made(
        "turned heavy top",
        [{"kind": "gravity", "weight": "13/10", "center_of_mass": ["-1/5", 0, 0], "direction": [1, 2, 2]}],
        [1, 2, 2],
        ["2", "1/7", "1/3"],
    ),
    "symmetric gyrostat": lambda: _made(
        "symmetric gyrostat",
        [{"kind": "rotor", "angular_momentum": [0, 0, "3/7"]}],
        [2, 2, 1],
        ["1/3", "-1/7", "2"],
    ),
    "driven about one axis": lambda: _made("driven about one axis", [_PUSH], [2, 3, 4], ["0", "0", "1/2"]),
    "braked about one axis": lambda: _made("braked about one axis", [_PUSH, _BRAKE], [2, 3, 4], ["0", "0", "1/2"]),
    "braked symmetric body": lambda: _made(
        "braked symmetric body", [_PUSH, _BRAKE], [2, 2, 1], ["1/3", "-1/7", "2"], output={"quantities": ["omega"]}
    ),
    "spun up far off": lambda: _made("spun up far off", [_PUSH], [2, 2, 1], ["1/3", "-1/7", "20"]),
}
"""Names and scenes of motions with a closed form for which symrot ships no scene."""


def _scene(name: str) -> Scene:
    return MADE[name]() if name in MADE else load_scene(name)


VARIED = (("weight", "weight", None), ("torque_3", "torque", 2), ("angular_momentum_3", "angular_momentum", 2))
"""Constants that an ensemble varies if the first torque has them: (name in the ensemble, field, component)."""


def _median(run: Callable[[], object], rounds: int) -> float:
    """Return the median processor time of ``run`` over ``rounds`` calls, in microseconds."""
    times = []
    for _ in range(rounds):
        began = process_time_ns()
        run()
        times.append(process_time_ns() - began)
    return median(times) / 1e3


def _start(scene: Scene) -> tuple[Floats, Floats]:
    """Return an angular velocity and a quaternion that differ a little from the initial state of a scene."""
    omega, quaternion = (
        np.array([float(x) for x in vector]) for vector in (scene.initial.omega_b, scene.initial.quaternion)
    )
    return omega * (1 + SPREAD) + SPREAD * abs(omega).max(), quaternion + SPREAD


def _medians(one: Callable[[], object], other: Callable[[], object], rounds: int) -> tuple[float, float, float]:
    """Time two functions alternately; return the median times of both, us, and the median of their difference."""
    times = np.empty((rounds, 3))
    for k in range(rounds):
        began = process_time_ns()
        one()
        between = process_time_ns()
        other()
        times[k, :2] = between - began, process_time_ns() - between
    # A slow change of the machine's speed affects both and cancels.
    times[:, 2] = times[:, 0] - times[:, 1]
    first, second, more = np.median(times, axis=0).tolist()
    return first / 1e3, second / 1e3, more / 1e3


class _Row(NamedTuple):
    """One motion's times, us: whole calls of the propagator, and the parts of one call."""

    parts: tuple[float, ...]  # to read the initial state, plan, bind parameters, set up the motion
    motion: float  # the motion itself, with both changed
    # with a new angular velocity, a new attitude, and both
    calls: tuple[float, ...]
    python: tuple[float, ...]  # the part of each call that is not the motion itself
    idle: float  # the most expensive call of a stepper while nothing is done in C


def _row(propagate: Propagator, rounds: int) -> _Row:
    scene = propagate.scene
    (omega, quaternion), times = _start(scene), np.linspace(0.0, float(scene.span.stop), SAMPLES)
    propagate(times, omega=omega, quaternion=quaternion)
    initial = read_start(scene, omega, quaternion)
    motion: Any = propagate.motion_from(initial)
    parts = motion.exact if motion.choice.method == "exact" else motion.stepping
    motion.follow(times, True)
    fresh = [motion.from_start(initial) for _ in range(2 * rounds)]
    moving, bound = iter(fresh[:rounds]), iter(fresh[rounds:])

    def bind() -> Any:
        each = next(bound)
        return () if motion.choice.method == "exact" else (each.plan.initial_state, each.taylor_parameters)

    def prepare(each: Iterator[Any] = moving) -> Any:
        one = next(each)
        return one.exact if motion.choice.method == "exact" else one.stepping

    def whole(start: dict[str, Any]) -> tuple[float, float, float]:
        """Return three times, us, of a propagator's call with a new initial state: the call, its motion in C, and the
        rest.
        """
        initial = read_start(scene, start.get("omega"), start.get("quaternion"))
        own = propagate.motion_from(initial)
        own.follow(times, True)
        call, following, more = _medians(partial(propagate, times, **start), lambda: own.follow(times, True), rounds)
        constants = _in_c(own, initial, times, rounds)
        return call, following + constants, more - constants

    assert parts is not None
    both: dict[str, Any] = {"omega": omega, "quaternion": quaternion}
    starts = ({"omega": omega}, {"quaternion": quaternion}, both)
    costs = (
        _median(lambda: read_start(scene, omega, quaternion), rounds),
        _median(lambda: structure_key(scene, initial), rounds) + _median(lambda: motion.from_start(initial), rounds),
        _median(bind, rounds),
        _median(prepare, rounds),
    )
    calls, motions, python = zip(*map(whole, starts), strict=True)
    idle = nan
    if motion.choice.method != "exact":
        stepper = motion.stepping.stepper
        run, stepper.run = stepper.run, lambda *arguments: DONE
        try:
            idle = max([_median(partial(propagate, times, **start), rounds) for start in starts])
        finally:
            stepper.run = run
    return _Row(costs, motions[2], calls, python, idle)


def _in_c(motion: Any, initial: Any, times: Floats, rounds: int) -> float:
    """Return the microseconds that C takes for the constants of a closed form from a new initial state."""
    if motion.choice.method != "exact":
        # a stepper has no such constants
        return 0.0
    if motion.form.library == "spin_up":
        return _spin_up_in_c(motion.exact._source, times, rounds)
    functions = forms._bound.get(motion.form.library)
    if functions is None:
        return 0.0
    calls: list[tuple[Any, ...]] = []

    def recorded(*arguments: Any) -> Any:
        calls.append(arguments)
        return functions[0](*arguments)

    forms._bound[motion.form.library] = (recorded, *functions[1:])
    try:
        alive = motion.from_start(initial).exact
    finally:
        forms._bound[motion.form.library] = functions
    return _median(lambda alive=alive: functions[0](*calls[0]), rounds)  # type: ignore[misc]  # keeps the memory alive


def _spin_up_in_c(source: Any, times: Floats, rounds: int) -> float:
    """Return the microseconds that C takes for the constants of the motion of a body driven about its symmetry axis."""
    functions, total = spin_up_compiled.functions(), 0.0
    record, table = functions.record(), np.empty(spin_up_compiled.TABLE)
    arguments = source._numbers, functions.limits(*spin_up_compiled.limits())
    omega, quaternion = np.empty((SAMPLES, 3)), np.empty((SAMPLES, 4))
    samples = len(times), address(times), address(omega), address(quaternion)
    lacking = source._known[2] is not None
    # The table of Taylor polynomials counts only if samples near resonance need it.
    for room in (None, table) if lacking else (None,):
        place = address(room), ctypes.addressof(record)
        total += _median(lambda place=place: functions.prepare(source._axis, *arguments, *place), rounds)  # type: ignore[misc]
        if lacking and room is None:  # the table is made only after samples have shown that they need it
            total += _median(lambda: functions.evaluate(ctypes.addressof(record), None, *samples), rounds)
    return total


def changed_starts(scenes: list[str], rounds: int) -> None:
    """Print a table of the times of propagator calls with a new initial state, a row for each scene and method."""
    # us: read the initial state, plan, bind the parameters, set up the motion; the motion in C; whole calls; overhead
    # with one of omega and attitude changed (the larger) and with both; a stepper's call without work in C
    heads = ("read", "plan", "bind", "set up", "motion", "omega", "attitude", "both", "Python", "of both", "no C")
    print(f"{'us of a changed start':28}{'method':>8}" + "".join(f"{head:>9}" for head in heads))
    for name in scenes:
        for method in METHODS:
            try:
                propagate = propagator(name, method)
            except InputError:
                continue
            if propagate.method == method:
                row = _row(propagate, rounds)
                cells = (*row.parts, row.motion, *row.calls, max(row.python[:2]), row.python[2], row.idle)
                print(f"{name:28}{method:>8}" + "".join(f"{cell:9.1f}" for cell in cells))


def _ensemble(scene: Scene, n: int, random: np.random.Generator) -> Iterator[tuple[str, dict[str, Any]]]:
    omega, quaternion = _start(scene)
    if sum(w == 0 for w in scene.initial.omega_b) == 2 and scene.torques:
        omega = omega * [w != 0 for w in scene.initial.omega_b]  # a rotation about one axis stays about that axis
    variations: dict[str, Any] = {
        "omega": omega * (1 + SPREAD * random.standard_normal((n, 3))),
        "quaternion": quaternion + SPREAD * random.standard_normal((n, 4)),
        "t": np.linspace(0.0, float(scene.span.stop), SAMPLES),
    }
    yield "starts", variations
    if not scene.body.principal.given_axes:
        tensor = {
            name: float(scene.body.inertia[i][j]) * (1 + SPREAD * random.random(n)) for name, (i, j) in PLACES.items()
        }
        yield "and tensor", {**variations, "parameters": tensor}
        return
    moments = np.array([float(scene.body.inertia[k][k]) for k in range(3)])
    varied = {"principal": moments * (1 + SPREAD * random.random((n, 1)))}
    for name, field, entry in VARIED:
        if scene.torques and field in scene.torques[0].values:
            varied[name] = float(scene.torques[0].constant(field, entry)) * (1 + SPREAD * random.random(n))
    yield "and " + ", ".join(varied), {**variations, "parameters": varied}


def ensembles(scenes: list[str], rounds: int, most: int) -> None:
    """Print the times per trajectory of ensembles of up to ``most`` motions, in closed form and by steps."""
    print(f"{'us per trajectory':26}{'varied':36}{'n':>8}{'exact':>9}{'taylor':>9}   auto takes")
    for name in scenes:
        scene = _scene(name)
        for n in (size for size in SIZES if size <= most):
            for varied, variations in _ensemble(scene, n, np.random.default_rng(1)):
                auto = propagate_ensemble(scene, **variations).methods[0]
                cells = []
                for method in ("exact", "taylor"):
                    run = partial(propagate_ensemble, scene, method=method, **variations)
                    run()
                    cells.append(_median(run, rounds) / n)
                print(f"{name:26}{varied:36}{n:8d}{cells[0]:9.1f}{cells[1]:9.1f}   {auto}")


def main(arguments: list[str] | None = None) -> None:
    """Print a table of times of a propagator's calls with new initial states; with ``--ensembles``, of ensembles.

    Both tables are explained in the module's text.
    """
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.starts", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("scenes", metavar="SCENE", nargs="*")
    parser.add_argument("--rounds", type=int)
    parser.add_argument("--ensembles", action="store_true", help="measure ensembles instead of single calls")
    parser.add_argument("--most", type=int, default=SIZES[-1], help="number of trajectories in the largest ensemble")
    options = parser.parse_args(arguments)
    if options.ensembles:
        ensembles(options.scenes or [*ENSEMBLES, *MADE], options.rounds or 5, options.most)
    else:
        changed_starts(options.scenes or list(SCENES), options.rounds or 300)


if __name__ == "__main__":
    main()
