"""Times to compute a motion from a new initial state: by another call of a propagator, and in an ensemble.

    python -m symrot.bench.starts [--rounds 300] [SCENE ...]
    python -m symrot.bench.starts --ensembles [--most 100000] [--rounds 5] [SCENE ...]

The first table has microseconds per call, the second per trajectory of 101 samples. All are medians of processor time.
"""

import argparse
from collections.abc import Callable, Iterator
from functools import partial
from statistics import median
from time import process_time_ns
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symrot.closed_form import motion as forms
from symrot.ensemble.ensemble import propagate_ensemble
from symrot.ensemble.variation import PLACES
from symrot.errors import InputError
from symrot.propagation.propagate import propagator
from symrot.propagation.propagator import Propagator, read_start
from symrot.scene.scene import Scene, load_scene

__all__ = ["main"]

SCENES = ("t_handle", "heavy_top_loops", "gyrostat", "damped_disk", "gravity_gradient_satellite")
ENSEMBLES = ("t_handle", "axisymmetric_satellite", "heavy_top_loops", "spin_up")
METHODS = ("exact", "taylor", "dop853")
SAMPLES = 101
SIZES = (10, 100, 1_000, 10_000, 100_000)
SPREAD = 0.01

Floats = NDArray[np.float64]


_BRAKE = {"kind": "damping", "linear": ["1/10", "1/10", "1/5"]}
_PUSH = {"kind": "constant_body", "torque": [0, 0, "1/9"]}
_ROTOR = {"kind": "rotor", "angular_momentum": [0, 0, "3/7"]}
_PULL = {"kind": "gravity", "weight": "13/10", "center_of_mass": ["-1/5", 0, 0], "direction": [1, 2, 2]}
_TENSOR = {"inertia": {"xx": 3, "yy": 4, "zz": 5, "xy": "-1/10", "xz": "1/5", "yz": "1/7"}}
MADE: dict[str, tuple[dict[str, Any], list[dict[str, Any]], list[str]]] = {
    "tilted free body": (_TENSOR, [], ["1/3", "-1/7", "2"]),
    "turned heavy top": ({"principal": [1, 2, 2], "about": "fixed_point"}, [_PULL], ["2", "1/7", "1/3"]),
    "symmetric gyrostat": ({"principal": [2, 2, 1]}, [_ROTOR], ["1/3", "-1/7", "2"]),
    "driven about one axis": ({"principal": [2, 3, 4]}, [_PUSH], ["0", "0", "1/2"]),
    "braked about one axis": ({"principal": [2, 3, 4]}, [_PUSH, _BRAKE], ["0", "0", "1/2"]),
    "braked symmetric body": ({"principal": [2, 2, 1]}, [_PUSH, _BRAKE], ["1/3", "-1/7", "2"]),
    "spun up far off": ({"principal": [2, 2, 1]}, [_PUSH], ["1/3", "-1/7", "20"]),
}
"""Motions with a closed form for which symrot ships no scene: name -> body, torques, angular velocity."""


def _scene(name: str) -> Scene:
    if name not in MADE:
        return load_scene(name)
    body, torques, omega = MADE[name]
    initial = {"omega": omega, "attitude": {"quaternion": [1, "1/3", "-1/5", "2/7"]}}
    # a braked symmetric body has a closed form of its angular velocity alone
    output = {"quantities": ["omega"]} if name == "braked symmetric body" else {}
    return Scene.from_dict({
        "schema": 1, "title": name, "body": body, "torque": torques, "initial": initial,
        "span": {"t": [0, 20], "samples": SAMPLES}, "output": output,
    })  # fmt: skip


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


def _medians(one: Callable[[], object], other: Callable[[], object], rounds: int) -> tuple[float, float]:
    """Time two functions alternately; return two medians, microseconds: the time of ``one``, and its excess over
    ``other``.
    """
    times = np.empty((rounds, 2))
    for k in range(rounds):
        began = process_time_ns()
        one()
        between = process_time_ns()
        other()
        # A slow change of the machine's speed affects both and cancels in their difference.
        times[k] = between - began, 2 * between - began - process_time_ns()
    call, more = np.median(times, axis=0).tolist()
    return call / 1e3, more / 1e3


def _call(propagate: Propagator, start: dict[str, Any], rounds: int) -> tuple[float, float]:
    """Return two times, microseconds, of a propagator's call with a new initial state: in all, and outside of C.

    ``start`` holds the new ``omega``, the new ``quaternion``, or both.
    """
    times = np.linspace(0.0, float(propagate.scene.span.stop), SAMPLES)
    propagate(times, **start)
    initial = read_start(propagate.scene, start.get("omega"), start.get("quaternion"))
    own = propagate.motion_from(initial)
    own.follow(times, True)
    call, more = _medians(partial(propagate, times, **start), lambda: own.follow(times, True), rounds)
    return call, more - _in_c(own, initial, rounds)


def _in_c(motion: Any, initial: Any, rounds: int) -> float:
    """Return the time, microseconds, in which C computes the constants of a closed form from a new initial state.

    It is 0 for steppers, which have no such constants, and for the closed forms of libraries ``axial`` and ``spin_up``,
    for which the time in C is not separated from the time in Python.
    """
    if motion.choice.method != "exact" or motion.form.library in ("axial", "spin_up"):
        return 0.0
    functions, calls = forms.functions, list[tuple[Any, ...]]()

    def recorded(name: str, arguments: int) -> tuple[Any, Any, Any]:
        prepare, evaluate, record = functions(name, arguments)

        def prepared(*addresses: Any) -> Any:
            calls.append((prepare, addresses))
            return prepare(*addresses)

        return prepared, evaluate, record

    forms.functions = recorded  # type: ignore[assignment]
    try:
        alive = motion.from_start(initial).exact
    finally:
        forms.functions = functions
    prepare, addresses = calls[0]
    return _median(lambda alive=alive: prepare(*addresses), rounds)  # type: ignore[misc]  # keeps the memory alive


def changed_starts(scenes: list[str], rounds: int) -> None:
    """Print a table of the times, microseconds, of a propagator's call with a new initial state.

    It has a row for each scene and each method that can compute the scene. The first three columns are whole calls:
    with a new angular velocity, with a new attitude, and with both. Column 4 is the time outside of C in one of the
    first two calls (the larger of the two), and column 5 the time outside of C in the third call.
    """
    heads = ("omega", "attitude", "both", "Python", "of both")
    print(f"{'us of a changed start':28}{'method':>8}" + "".join(f"{head:>9}" for head in heads))
    for name in scenes:
        for method in METHODS:
            try:
                propagate = propagator(name, method)
            except InputError:
                continue
            if propagate.method == method:
                omega, quaternion = _start(propagate.scene)
                starts: list[dict[str, Any]] = [{"omega": omega}, {"quaternion": quaternion}]
                starts.append({"omega": omega, "quaternion": quaternion})
                calls, python = zip(*(_call(propagate, start, rounds) for start in starts), strict=True)
                cells = (*calls, max(python[:2]), python[2])
                print(f"{name:28}{method:>8}" + "".join(f"{cell:9.1f}" for cell in cells))


def _ensemble(scene: Scene, n: int, random: np.random.Generator) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield two ensembles of ``n`` motions similar to the motion of ``scene``.

    In the first ensemble the initial states vary, in the second also the inertia tensor, or the principal moments and
    constants of the torque. Each ensemble is a pair (what varies, in words; arguments of :func:`propagate_ensemble`).
    """
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
    try:
        for name in options.scenes:
            (_scene if options.ensembles else load_scene)(name)
    except InputError as reason:
        parser.error(str(reason))
    if options.ensembles:
        ensembles(options.scenes or [*ENSEMBLES, *MADE], options.rounds or 5, options.most)
    else:
        changed_starts(options.scenes or list(SCENES), options.rounds or 300)


if __name__ == "__main__":
    main()
