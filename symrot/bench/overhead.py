"""Overhead of a call from Python: the time of ``propagator(t)`` against the bare call of the same C function.

    python -m symrot.bench.overhead [--rounds 25] [SCENE ...]

For the bare call, all addresses are computed beforehand. A stepper starts anew in each bare call: its state is set back
to the start of the motion by copying a few bytes. The two kinds of calls alternate; results are medians of processor
time.
"""

import argparse
import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np

from symrot.bench.comparison.race import Measured, race, seconds_of
from symrot.errors import InputError
from symrot.propagation.motions.methods import ClosedFormMotion, SteppedMotion
from symrot.propagation.propagate import propagator
from symrot.propagation.propagator import Propagator
from symrot.propagation.steppers.segments import Segment
from symrot.propagation.steppers.stepping import DONE
from symrot.scene.scene import load_scene

__all__ = ["main", "measure"]

SCENES = ("tumbling_prism", "heavy_top_loops", "gravity_gradient_satellite", "damped_disk")
SAMPLES = (1, 10, 100, 1000)
METHODS = ("taylor", "dop853", "exact")


def _bare_stepper(propagate: Propagator, times: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> Callable[[], object]:
    motion = propagate._motion
    assert isinstance(motion, SteppedMotion)
    task = motion.stepping
    stepper, end = task.stepper, float(times[-1])
    ready = stepper.new_run.from_buffer_copy(task._ready)
    ready.pace, ready.stop = (end - task.t0) * task.pace, end
    stepper.enter(ready, Segment(task.t0, end, task.t0, end), task.allowed)
    run = stepper.new_run()
    states = np.empty((len(times), stepper.states))
    size, place, source = ctypes.sizeof(run), ctypes.addressof(run), ctypes.addressof(ready)
    arguments = (ctypes.addressof(task.p), times.ctypes.data, len(times), states.ctypes.data, None, 0, 10**9)
    call, reset = stepper.run, ctypes.memmove

    def bare(alive: object = (states, ready, run, task)) -> None:  # keeps the memory that C uses alive
        reset(place, source, size)
        call(place, *arguments)

    bare()
    if run.next != len(times) or call(place, *arguments) != DONE:
        raise InputError(
            f"{propagate.scene.name}: expected a motion that the compiled integrator follows to its end in one "
            "call, so that this call can be timed; choose a shorter span or another scene"
        )
    return bare


def _bare_exact(propagate: Propagator, times: "np.ndarray[tuple[int], np.dtype[np.float64]]") -> Callable[[], object]:
    motion = propagate._motion
    assert isinstance(motion, ClosedFormMotion)
    exact: Any = motion.exact
    loops = getattr(exact, "_loops", None)
    call, constants = (loops.evaluate, loops.place) if loops else (exact._evaluate, exact._address)
    omega, quaternion = np.empty((len(times), 3)), np.empty((len(times), 4))
    arguments = (constants, len(times), times.ctypes.data, omega.ctypes.data, quaternion.ctypes.data)
    return lambda alive=(omega, quaternion): call(*arguments)  # type: ignore[misc]  # keeps the arrays alive


def measure(name: str, method: str, samples: int, rounds: int) -> tuple[float, float] | None:
    """Return the median seconds of ``propagator(t)`` and of the bare C call.

    None if the method cannot compute the scene.

    Raises
    ------
    InputError
        If a stepper in C cannot follow the motion to its end in one call.
    """
    try:
        propagate = propagator(name, method)
        if propagate.method != method:
            return None
    except InputError:
        return None
    times = np.linspace(0.0, float(propagate.scene.span.stop), samples + 1)[1:]
    propagate(times)
    bare = (_bare_exact if method == "exact" else _bare_stepper)(propagate, times)
    runs: tuple[Callable[[], object], ...] = (lambda: propagate(times), bare)
    entries = [(Measured("", 0.0, 0, 0.0, seconds_of(run)), run) for run in runs]
    race(entries, rounds)
    return entries[0][0].median, entries[1][0].median


def main(arguments: list[str] | None = None) -> None:
    """Print the times of calls from Python against bare calls of the same C function."""
    parser = argparse.ArgumentParser(prog="python -m symrot.bench.overhead", description=(__doc__ or "").split("\n")[0])
    parser.add_argument("scenes", metavar="SCENE", nargs="*", default=list(SCENES))
    parser.add_argument("--rounds", type=int, default=25)
    options = parser.parse_args(arguments)
    try:
        for name in options.scenes:
            load_scene(name)
    except InputError as reason:
        parser.error(str(reason))
    print(f"{'':28}{'method':>8}{'samples':>9}{'call us':>10}{'in C us':>10}{'Python us':>11}")
    every: dict[int, list[float]] = {}
    for name in options.scenes:
        for method in METHODS:
            for samples in SAMPLES:
                times = measure(name, method, samples, options.rounds)
                if times is None:
                    break
                call, bare = (seconds * 1e6 for seconds in times)
                every.setdefault(samples, []).append(call - bare)
                print(f"{name:28}{method:>8}{samples:9d}{call:10.1f}{bare:10.1f}{call - bare:11.1f}")
    for samples, costs in every.items():
        print(f"{samples} samples: median {np.median(costs):.1f} us of Python, maximum {max(costs):.1f}")


if __name__ == "__main__":
    main()
