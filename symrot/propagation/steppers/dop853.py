"""Dormand-Prince 8(5,3) for an emitted kernel: Python calls the C functions of :file:`dop853.c` once per span.

A kernel is the generated C function of the rates (time derivatives) of the states. The *epoch* is the time from which
a kernel counts time. The tolerance limits the error of the whole trajectory, not of one step.
"""

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, ClassVar

from numpy.typing import ArrayLike

from symrot.build.sources import c_text
from symrot.errors import InputError
from symrot.propagation.steppers.segments import Segment
from symrot.propagation.steppers.stepping import (
    MAX_STEPS,
    NOT_FINITE,
    NOT_FINITE_SENTENCE,
    PAUSED,
    UNDERFLOW,
    Integration,
    PathLike,
    Run,
    Stepper,
    Window,
    check_tolerance,
)

__all__ = ["DENSE_ORDER", "MAX_STEPS", "NO_ENCLOSURE", "Clock", "integration", "step_tolerance", "translation_unit"]

# A double holds 53 bits of a phase a*t, which loses digits as the time grows; rounding errors then look like a rapidly
# varying torque to the step control. If a kernel has a Clock, its epoch is therefore moved to the present time every
# WINDOW steps, and when steps are short compared with the time since the epoch.
STEP_SHARE, NATURAL_TIMES = 0.14, 0.16  # fractions of the tolerance and of the span, see step_tolerance
TERMS = 8  # coefficients of the dense output
DENSE_ORDER = 7  # order of the error of the dense output
NO_ENCLOSURE = "#define SYMROT_ENCLOSED 0\n#define SYMROT_DEPENDS 0\n#define SYMROT_ROUNDS 0\n"
ENCLOSURE = "/* ENCLOSURE */\n"  # line of dop853.c that is replaced by enclosure.h
ROUGH = "#define SYMROT_ROUGH\n"  # the error control handles corners, such as a root at zero: see disc.h
MIDDLE_REACH = 3  # index of the first disc to try in symrot.codegen.enclosure.terms.REACHES

Clock = Callable[[float], tuple[PathLike, Sequence[float]]]
"""Function that takes an epoch, s, and returns a kernel's library and the values of its parameters for this epoch.

With these values the rates of the kernel count time from the epoch."""

FAR = 1e4  # steps from the epoch: farther on, the time would be rounded to more than 1e-12 of a step
WINDOW = 2048
"""Number of steps after which the epoch, the zero of the time t in the rates, is moved to the present time.

Phases ``a*t`` in the rates then stay below some 1e3 rad, and the moves cost a few per cent of the time. Phase errors
between two moves are alike and add up: with 8192 steps they were five times as large."""


def step_tolerance(tolerance: float) -> tuple[float, float]:
    """Return the error allowed in one long step, and the least length of a long step, as a fraction of the span.

    In a shorter step, the allowed error is smaller in proportion to its length.
    """
    # Steps are about tolerance^(1/8) natural times long (a natural time: the motion changes noticeably), and a shorter
    # step gets a proportional share of the error. So the sum of all shares grows with the number of natural times in
    # the span, not of steps: the final error over the tolerance hardly depends on tolerance or span.
    check_tolerance(tolerance)
    # Both factors are calibrated against 40-digit references for free asymmetric bodies and heavy tops
    # (tests/propagation/test_dop853.py): errors stay below 5 tolerances, unless the motion amplifies them.
    return tolerance * STEP_SHARE, tolerance**0.125 * NATURAL_TIMES


def translation_unit(
    kernel: str,
    name: str,
    states: int,
    parameters: int,
    blocks: Sequence[int] = (0, 3, 7),
    scales: Sequence[float] = (0.0, 1.0),
    enclosure: str = NO_ENCLOSURE,
) -> str:
    """Return the C source of a library: the kernel and the stepper around it.

    Parameters
    ----------
    kernel : str
        C source that defines ``static inline void name(double t, const double y[], const double p[], double dy[])``.
    name : str
        The kernel's name in C.
    states, parameters : int
        Lengths of y and p.
    blocks : sequence of int
        Edges of the blocks of states whose errors are measured separately (omega, then quaternion), from 0 to
        ``states``: block k consists of the states from edge k up to edge k + 1.
    scales : sequence of float
        One number per block: the size to which errors of the block are relative (1 for a unit quaternion, or for an
        angle in rad). 0 means the norm of the block itself (angular velocity).
    enclosure : str
        C code that bounds the changes of the rates, so that the stepper can limit its steps, and the rounding errors of
        the rates. It is the output of :func:`symrot.codegen.enclosure.source.enclosure_source` for the kernel and the
        order :data:`DENSE_ORDER`, followed by the output of :func:`symrot.codegen.enclosure.source.rounding_source`.
    """
    edges = list(blocks)
    if edges[:1] != [0] or edges[-1] != states or edges != sorted(set(edges)) or len(scales) != len(edges) - 1:
        raise InputError(
            f"blocks: expected block edges that increase from 0 to {states} (the number of states), and one scale for "
            f"each block, got edges {edges} and scales {list(scales)}; a block is a group of consecutive states whose "
            "errors are measured together, and its scale is the size to which these errors are relative"
        )
    bounds = c_text("propagation/enclosures/enclosure.h")
    return "\n".join(
        (
            c_text("propagation/steppers/library.h"),
            kernel,
            f"#define SYMROT_STATES {states}",
            f"#define SYMROT_PARAMETERS {parameters}",
            f"#define SYMROT_STEP_SHARE {STEP_SHARE!r}",
            f"#define SYMROT_RHS {name}",
            f"#define SYMROT_BLOCKS {{{', '.join(map(str, edges))}}}",
            f"#define SYMROT_SCALES {{{', '.join(map(repr, map(float, scales)))}}}",
            c_text("propagation/steppers/dop853_tableau.h"),
            ROUGH,
            c_text("propagation/enclosures/disc.h"),
            enclosure,
            c_text("propagation/steppers/dop853.c").replace(ENCLOSURE, bounds),
        )
    )


def integration(
    library: PathLike,
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    tolerance: float,
    max_step: float = math.inf,
    max_steps: int = MAX_STEPS,
    breaks: Sequence[float] = (),
    clock: Clock | None = None,
) -> Integration:
    """Return the integration of one motion, which can be sampled or recorded; the arguments are checked.

    Parameters
    ----------
    library : path
        Built from :func:`translation_unit`.
    p, y0 : arrays, shapes (parameters,) and (N,)
        Parameters of the kernel; state at ``t0``.
    t0 : float
        Initial time, s.
    tolerance : float
        Error of the whole trajectory to aim for, see :func:`step_tolerance`.
    max_step : float
        Longest step, s; needed if a longer step could pass over a short pulse in the rates.
    max_steps : int
        Number of steps after which the integration is given up.
    breaks : sequence of float
        Times, s, at which the rates jump; a step ends exactly at each of them, and the integration restarts.
    clock : function, optional
        A :data:`Clock`: takes an epoch, s, and returns library and parameters of rates that take the time since it.
        It is needed for rates that depend on time: the stepper moves the epoch so that late times keep their digits.

    Raises
    ------
    InputError
        If a shape, a time or the tolerance cannot be used.
    """
    if clock is None:
        return Integration(_stepper, library, p, y0, t0, tolerance, max_step, max_steps, breaks)
    return _Clocked(clock, _stepper, library, p, y0, t0, tolerance, max_step, max_steps, breaks)


class _Clocked(Integration):
    """Integration with a kernel that counts time from an epoch; the epoch is moved repeatedly to the present time."""

    def __init__(self, clock: Clock, *arguments: Any) -> None:
        super().__init__(*arguments)
        # takes an epoch; returns library and parameters
        self._clock = clock

    def step_function(self, run: Run) -> tuple[Callable[..., Any], Any, int]:
        """Return the C function that continues a run, its parameters, and the largest number of steps per call."""
        tried = self.stepper.tried(run)
        window = run.window
        if window is None:
            window = Window(self.stepper.run, self.p, -WINDOW if run.t else 0)
            run.far = FAR
        if tried - window.since >= WINDOW or abs(run.t - run.epoch) > FAR * abs(run.h) > 0.0:
            # far from the epoch: the epoch is moved to the present time
            path, p = self._clock(run.t)
            stepper = _stepper(str(path))
            window = Window(stepper.run, stepper.new_parameters(*p), max(tried, 0))
            run.epoch = run.t
        run.window = window
        return window.step, window.parameters, WINDOW - (tried - window.since)


class _Stepper(Stepper):
    """A loaded library with a kernel and the DOP853 stepper, built from :func:`translation_unit`."""

    name = "dop853"
    reals = (
        "t",
        "h",
        "growth",
        "stop",
        "first",
        "last",
        "tolerance",
        "pace",
        "max_step",
        "proven",
        "variation",
        "epoch",
        "far",
        "rounded",
        "rounded_from",
        "turned",
        "largest",
    )
    integers = ("reach", "next", "accepted", "rejected", "evaluations", "recorded")
    vectors = ("y", "carry", "dy")
    steps_per_call, rows_per_call = 100_000, 256
    reasons: ClassVar = {
        NOT_FINITE: NOT_FINITE_SENTENCE,
        UNDERFLOW: "the step shrank to nothing, as it does before a singularity or a jump",
        PAUSED: "{steps} steps were not enough; the next would be {run.h!r} s",
    }
    allowance = staticmethod(step_tolerance)

    def row_length(self) -> int:
        return 2 + TERMS * self.states

    def enter(self, run: Run, segment: Segment, allowed: float) -> None:
        run.h, run.first, run.last, run.tolerance = 0.0, segment.first, segment.last, allowed
        run.proven, run.reach = 0.0, MIDDLE_REACH

    @staticmethod
    def tried(run: Run) -> int:
        return run.accepted + run.rejected

    @staticmethod
    def cost(run: Run) -> tuple[int, int, int]:
        return run.accepted, run.rejected, run.evaluations


_stepper = cache(_Stepper)
