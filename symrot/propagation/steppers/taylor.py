"""Taylor series, usually of order 20: Python calls the C functions of :file:`taylor.c` once per span.

The right-hand side is the function of the rates, ``dy/dt = f(t, y, p)``. A *jet* is the list of Taylor coefficients of
all states at one time, computed by generated C code. The tolerance limits the error of the trajectory, not of steps.
"""

import ctypes
import math
from collections.abc import Sequence
from functools import cache, lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from symrot.build import cache as compiled
from symrot.build.sources import c_text
from symrot.errors import CompilerError, InputError
from symrot.formula.program import Program
from symrot.formula.tree import operations
from symrot.propagation.steppers.segments import Segment
from symrot.propagation.steppers.stepping import (
    MAX_STEPS,
    NOT_FINITE,
    PAUSED,
    ROUNDED,
    UNDERFLOW,
    Floats,
    Integration,
    PathLike,
    Run,
    Stepper,
    check_tolerance,
)

__all__ = ["FLAGS", "integration", "order_for", "refusal", "step_tail", "translation_unit"]

# Smooth motions need few long steps. With a small tolerance, each is accurate up to rounding errors, and the same
# coefficients give the states at any time inside the step.
FLAGS = (*compiled.FLAGS, *compiled.SCHEDULED)
STEPS_OF_ALL = 4.0  # in a span of this many steps or fewer, each step may use the whole tolerance, see step_tail
FILES = {
    "error_free.h": "closed_form/arithmetic/error_free.h",
    **{
        name: f"propagation/steppers/{name}"
        for name in ("library.h", "taylor.h", "series.h", "pairs.h", "projection.c", "taylor.c")
    },
    **{name: f"propagation/enclosures/{name}" for name in ("disc.h", "enclosure.h")},
}
PROJECTION = "/* PROJECTION */\n"  # line of taylor.c that is replaced by projection.c
ENCLOSURE = "/* ENCLOSURE */\n"  # line that is replaced by enclosure.h
NO_INVARIANT = "#define SYMROT_INVARIANTS 0\n"
NO_INVARIANTS = NO_INVARIANT + "#define SYMROT_INVARIANT_PARAMETERS 0\n"
NO_ENCLOSURE = "#define SYMROT_ENCLOSED 0\n#define SYMROT_ROUNDS 0\n"
MIDDLE_REACH = 3  # index of the first disc to try in symrot.codegen.enclosure.terms.REACHES
PROJECTED_EVERY = 16  # steps: by measurement, seldom enough to cost a few percent and often enough to lose nothing
MANY_PRODUCTS = 40  # from this number of products on, the sums of a step (order squared) dominate its cost
ORDERS = {  # for few and for many products: least tolerance, and the fastest order from there on
    False: ((1e-3, 14), (1e-6, 16), (0.0, 20)),
    True: ((3e-2, 8), (1e-3, 10), (1e-5, 12), (1e-7, 16), (0.0, 20)),
}


def step_tail(tolerance: float) -> tuple[float, float]:
    """Return a limit for the last terms of a step's Taylor series, and the shortest step that may use the whole limit.

    The step length is given as a fraction of the time for which the motion is computed. A shorter step has a smaller
    limit.
    """
    # The stepper multiplies the limit by r^(7/4) in a step that is r times as long. For n equal steps, r is
    # proportional to 1/n, and their errors add up to about n^(7/4) times one of them: the final error hardly depends
    # on n.
    check_tolerance(tolerance)
    # Calibrated against references of 50 digits for free asymmetric bodies and heavy tops
    # (tests/propagation/test_taylor.py): errors stay below 5 tolerances.
    return tolerance, 1.0 / STEPS_OF_ALL


def order_for(tolerance: float, program: Program | None = None) -> int:
    """Return the order at which Taylor series take the least time for a tolerance; ``program`` computes the rates."""
    formulas = (*program.temporaries, *program.outputs) if program else ()
    products = sum(operations(formula)["mul"] for _, formula in formulas)
    # measured with `python -m symrot.bench.taylor --orders`; every order is accurate enough, and below 1e-6 the times
    # of orders 16 to 24 differ by less than a tenth
    return next(order for least, order in ORDERS[products >= MANY_PRODUCTS] if tolerance >= least)


@lru_cache(maxsize=16)
def refusal(program: Program) -> str:
    """Return why a right-hand side has no Taylor series, such as the absolute value of a state; empty if it has one."""
    from symrot.codegen.taylor.recurrences import recurrences

    try:
        recurrences(program)
    except InputError as error:
        return str(error)
    return ""


def translation_unit(
    program: Program,
    blocks: Sequence[int] = (0, 3, 7),
    scales: Sequence[float] = (0.0, 1.0),
    order: int | None = None,
    invariants: str = "",
    enclosed: bool = True,
) -> str:
    """Return the C source of a library that integrates a motion by Taylor series.

    The source contains the function that computes the Taylor coefficients of the states from the right-hand side, and
    the stepper that calls it.

    Parameters
    ----------
    program : Program
        The right-hand side ``dy = f(t, y, p)``.
    blocks, scales
        As for :func:`symrot.propagation.steppers.dop853.translation_unit`.
    order : int, optional
        Order of the series, even; default: 20. See :func:`order_for`.
    invariants : str
        Output of :func:`symrot.codegen.taylor.invariant_source.invariant_definitions`: conserved quantities, to which
        the stepper corrects the states. Their parameters follow the parameters of the program.
    enclosed : bool
        Whether bounds of the rates on complex discs limit the steps, see :mod:`symrot.codegen.enclosure.terms`.

    Raises
    ------
    InputError
        If the right-hand side is not smooth, for example because it contains abs.
    """
    from symrot.codegen.enclosure.source import enclosure_source, rounding_source
    from symrot.codegen.taylor.source import ORDER, taylor_definitions

    order = ORDER if order is None else order
    own = {name: c_text(path) for name, path in FILES.items()}
    definitions = taylor_definitions(program, blocks, scales, order)
    invariants = invariants or NO_INVARIANTS
    # without invariants projection.c would call a missing function: an error in C that only optimizers overlook
    projection = "" if NO_INVARIANT in invariants else own["projection.c"]
    stepper = own["taylor.c"].replace(PROJECTION, projection)
    bounds = enclosure_source(program, order, blocks) + rounding_source(program) if enclosed else NO_ENCLOSURE
    stepper = stepper.replace(ENCLOSURE, own["enclosure.h"])
    arithmetic = (own["library.h"], own["taylor.h"], own["error_free.h"], own["pairs.h"])
    parts = (*arithmetic, definitions, own["series.h"], invariants, own["disc.h"], bounds, stepper)
    return "\n".join(parts)


def integration(
    library: PathLike,
    p: ArrayLike,
    y0: ArrayLike,
    t0: float,
    tolerance: float,
    max_step: float = math.inf,
    max_steps: int = MAX_STEPS,
    project: bool = True,
) -> Integration:
    """Return the integration of a motion by Taylor series; see :func:`symrot.propagation.steppers.dop853.integration`.

    Its ``stats`` count as one evaluation the computation of all Taylor coefficients at one time.

    Parameters
    ----------
    library : path
        Built from :func:`translation_unit`.
    tolerance : float
        Error of the whole trajectory to aim for, see :func:`step_tail`.
    max_steps : int
        Number of steps after which the integration is given up.
    project : bool
        Whether the states are corrected so that conserved quantities stay constant, if the library has any.
    """
    motion = Integration(_stepper, library, p, y0, t0, tolerance, max_step, max_steps)
    motion.fields["every"] = PROJECTED_EVERY if project else 0
    return motion


class _Stepper(Stepper):
    """A loaded library that integrates a motion by Taylor series, built from the source of :func:`translation_unit`."""

    name = "taylor"
    reals = (
        "t",
        "t_low",
        "unit",
        "stop",
        "tail",
        "pace",
        "max_step",
        "proven",
        "rounded",
        "rounded_from",
        "largest",
        "longest",
    )
    integers = ("next", "accepted", "jets", "recorded", "reach", "every", "since", "projected")
    vectors = ("y", "carry")
    tail = ("kept",)
    steps_per_call, rows_per_call = 50_000, 64
    reasons: ClassVar = {
        NOT_FINITE: "its derivatives are not finite there",
        ROUNDED: "rounding errors in a formula that contains the time change the torque by more than the tolerance",
        UNDERFLOW: "the step shrank to nothing, as it does before a singularity",
        PAUSED: "{steps} steps were not enough",
    }
    allowance = staticmethod(step_tail)

    def __init__(self, path: str) -> None:
        super().__init__(path)
        pointer, integer, real = ctypes.c_void_p, ctypes.c_int64, ctypes.c_double
        self._jet = self._function("_jet", None, real, pointer, pointer, real, integer, pointer)
        if self._function("_carry", real, real, real)(1.0, 2.0**-60) != 2.0**-60:
            raise CompilerError(
                f"the compiled kernel {path} ignores rounding errors: the compiler removed the code that adds them in "
                "the next step; compile without -ffast-math"
            )

    def row_length(self) -> int:
        return 4 + (self.order + 1) * self.states

    def enter(self, run: Run, segment: Segment, allowed: float) -> None:
        run.unit, run.proven, run.tail, run.reach = 0.0, 0.0, allowed, MIDDLE_REACH

    @staticmethod
    def tried(run: Run) -> int:
        return run.accepted

    @staticmethod
    def cost(run: Run) -> tuple[int, int, int]:
        return run.accepted, run.jets - run.accepted, run.jets

    def jet(self, t: float, y: ArrayLike, p: ArrayLike, unit: float = 1.0) -> Floats:
        """Return the Taylor coefficients of the states at t, shape (order + 1, N).

        Row k is the k-th derivative, times ``unit``^k, over k!.
        """
        state, values = np.array(y, dtype=np.float64), np.array(p, dtype=np.float64)
        coefficients = np.empty((self.order + 1, self.states))
        self._jet(t, state.ctypes.data, values.ctypes.data, unit, self.order, coefficients.ctypes.data)
        return coefficients


_stepper = cache(_Stepper)
