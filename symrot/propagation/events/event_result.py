"""Results of a motion with events: times of the events, states at these times, and samples up to a terminal event.

A *side* of a motion is the part of it after its initial time, or the part before.
"""

from collections.abc import Callable, Generator, Iterator, Sequence
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.build import cache as library
from symrot.errors import InputError, PropagationError
from symrot.planning.scene_kernel import bind
from symrot.propagation.compiled_models import error_blocks
from symrot.propagation.events.event import Event, timed, uses_attitude
from symrot.propagation.events.library import event_library_source
from symrot.propagation.events.polynomials import HEAD, Piece, fitted, fitted_pieces, stepped
from symrot.propagation.events.search import EventZero, SearchResult, ZerosNotSeparated, search
from symrot.propagation.motions.methods import ClosedFormMotion, SciPyMotion
from symrot.propagation.motions.motion import Motion, MotionInParts, SteppedInC, on_clock
from symrot.propagation.steppers.integration_stopped import IntegrationStopped
from symrot.propagation.steppers.segments import split_at
from symrot.propagation.steppers.stats import Stats, Switching, stats_of

__all__ = ["EventResult", "integrate_with_events"]

Floats = NDArray[np.float64]

TURN_PER_PIECE = 2.0  # rad: rotation in each of the first pieces into which a motion without steps is cut
SAMPLES_OF_RATE = 257  # samples from which the largest rate of such a motion is estimated
TOLERANCES = 20.0  # largest error of a stepped motion, in tolerances, see docs/step_control.md
RESIDUE = 4.0 * float(np.finfo(np.float64).eps)  # relative to the largest state: rounding error left in a zero state
EXACT_ERROR = 16.0 * float(np.finfo(np.float64).eps)  # error of a motion in closed form


class EventResult(NamedTuple):
    """Samples of a motion together with its events.

    Attributes
    ----------
    t, states : arrays, shapes (n,) and (n, N)
        Samples at the requested times; one sample at a terminal event replaces all samples beyond it.
    t_events, y_events : lists of arrays, shapes (k,) and (k, N)
        For each event: its times in increasing order, and the states at these times.
    kinds : list of lists of str
        For each event and each of its times: ``"rising"``, ``"falling"`` or ``"touching"``, in the direction in which
        the motion is followed, away from its start.
    ended : bool
        Whether a terminal event ended the motion, at a time after or before its start.
    events : tuple of Event
        The events, in the order in which they were requested.
    warnings : tuple of str
        A sentence for each event whose formula comes nearer to zero than the error of the motion, or is zero for a
        while.
    error : PropagationError or None
        The error that ended the motion or the search early; samples and events end at its time.
    """

    t: Floats
    states: Floats
    stats: Stats
    t_events: list[Floats]
    y_events: list[Floats]
    kinds: list[list[str]]
    ended: bool
    events: tuple[Event, ...]
    warnings: tuple[str, ...]
    error: PropagationError | None


class _Side(NamedTuple):
    """The part of a motion after its initial time, or the part before, as the search for events needs it."""

    # polynomials of the states
    pieces: Generator[Piece, None, None]
    states: Callable[[Floats], Floats]
    # the error that ended the motion early in this direction, if any
    broken: list[PropagationError]
    stats: Callable[[], Stats]


def integrate_with_events(motion: Motion, times: Floats, events: Sequence[Event]) -> EventResult:
    """Return the samples of a motion at ``times``, scene time in s, and all events between its start and these times.

    Raises
    ------
    InputError
        If an event needs the attitude and the plan does not compute it, or if no state of the motion changes.
    CompilerError
        If there is no C compiler.
    PropagationError
        If the motion cannot be followed at all. If it stops before the last time, the part before is returned, with the
        error as ``error``.
    """
    began, plan = perf_counter(), motion.plan
    if uses_attitude(events) and not plan.structure.attitude:
        raise InputError(
            "events: the attitude is not computed, since neither a torque nor the output of the scene needs it: "
            'add "quaternion" to output.quantities'
        )
    if not plan.states:
        raise InputError(
            f"events: every state of the scene {plan.scene.name!r} is constant, so there is no motion to search for "
            "events; change the initial state or the torques"
        )
    quantities = motion.kernel.quantities
    motion = motion if timed(quantities, events) else on_clock(motion, times)
    zero, sample_times = motion.epoch, times.copy()
    times = times - zero if zero else times
    source = event_library_source(quantities, events, plan.states, *error_blocks(plan))
    path, p = library.build(source, "events"), bind(motion.kernel.quantity_parameters, plan.constants)
    states, known = (
        np.empty((len(times), len(plan.states))),
        np.zeros(len(times), dtype=bool),
    )  # before a terminal event
    zeros: list[tuple[EventZero, Floats]] = []
    counts, ended, switchings = np.zeros(3, dtype=int), False, list[Switching]()
    doubts, errors = list[tuple[int, float]](), list[PropagationError]()
    flat, rounded = list[tuple[int, float, float]](), list[float]()
    accuracy = EXACT_ERROR if isinstance(motion, ClosedFormMotion) else TOLERANCES * motion.tolerance
    with motion.following(times):
        for part in split_at(times, motion.start):
            end = float(times[part[-1]])
            try:
                side = _side(motion, end)
            except IntegrationStopped as early:
                raise (early.later(zero) if zero else early) from None
            result, early_end = _searched(path, events, p, side, motion.start, end, accuracy)
            listed, stop = result.zeros, result.stop
            ended |= stop is not None
            reached = abs((end if stop is None else stop) - motion.start)
            if early_end is not None:
                motion.raise_torque_error()
                errors.append(early_end.later(zero) if zero else early_end)
                reached = abs(early_end.t - motion.start)
            inside = part[np.abs(times[part] - motion.start) <= reached]
            known[inside] = True
            states[inside] = side.states(times[inside])
            rows = side.states(np.array([each.t for each in listed]))
            if stop is not None and times[inside[-1:]].tolist() != [stop]:
                last = part[len(inside)]  # the sample at the event replaces the first sample beyond it
                known[last], sample_times[last], states[last] = True, stop + zero, rows[-1]
            zeros = _joined(zeros, list(zip(listed, rows, strict=True)), motion.start)
            doubts += [(event, t + zero) for event, t in result.doubts]
            flat += [(event, first + zero, last + zero) for event, first, last in result.flat]
            side.pieces.close()
            stats = side.stats()
            counts += stats[:3]
            switchings += [each for each in stats.switchings if abs(each.t - motion.start) <= reached]
            rounded += [t for t in stats.later(zero).rounded_beyond if abs(t - zero - motion.start) <= reached]
    zeros.sort(key=lambda each: each[0].t)
    own = [[each for each in zeros if each[0].event == number] for number in range(len(events))]
    return EventResult(
        sample_times[known],
        states[known],
        stats_of(counts, perf_counter() - began, switchings, rounded),
        [np.array([each.t + zero for each, _ in group]) for group in own],
        [np.array([row for _, row in group]).reshape(-1, len(plan.states)) for group in own],
        [[each.kind for each, _ in group] for group in own],
        ended,
        tuple(events),
        (*_warnings(events, doubts), *_flat_warnings(events, flat)),
        errors[0] if errors else None,
    )


def _searched(
    path: Path, events: Sequence[Event], p: Sequence[float], side: "_Side", start: float, end: float, accuracy: float
) -> tuple[SearchResult, IntegrationStopped | ZerosNotSeparated | None]:
    """Return the events on one side of a motion's initial time, and the error that ended the search early or None.

    The side is the part of the motion from the initial time ``start`` to the time ``end``, s, which may be later or
    earlier. ``path`` is the compiled library of the search, ``p`` are the values of its parameters. ``accuracy`` is the
    error of the states, relative to their sizes.
    """
    if end == start:
        return SearchResult([], None, []), None

    def state_at(t: float) -> list[float]:
        values: list[float] = side.states(np.array([t]))[0].tolist()
        return values

    try:
        at_end = lambda: None if side.broken else state_at(end)  # noqa: E731
        result = search(path, events, p, side.pieces, start, accuracy, state_at(start), at_end)
    except ZerosNotSeparated as early:
        return SearchResult(early.zeros, None, []), early
    if not side.broken or result.stop is not None:
        return result, None
    stopped = side.broken[0]
    if not isinstance(stopped, IntegrationStopped):
        raise stopped
    return result, stopped


def _warnings(events: Sequence[Event], doubts: Sequence[tuple[int, float]]) -> Iterator[str]:
    """Yield a warning for each event in ``doubts``, whose formula comes nearer to zero than the motion's error."""
    # a doubt is (number of the event, time of the extremum, s)
    for number, event in enumerate(events):
        times = [t for each, t in doubts if each == number]
        if times:
            more = f" and at {len(times) - 1} more times" if len(times) > 1 else ""
            yield (
                f"events: {event.formula!r} differs from zero at t = {times[0]!r} s{more} by less than the error of "
                "the motion: whether it is zero there is not known"
            )


def _flat_warnings(events: Sequence[Event], flat: Sequence[tuple[int, float, float]]) -> Iterator[str]:
    """Yield a warning for each event whose formula is zero for a while.

    ``flat`` has triples: number of the event, and the times, s, between which its formula is zero.
    """
    for number, event in enumerate(events):
        times = [t for each, *both in flat if each == number for t in both]
        if times:
            yield (
                f"events: {event.formula!r} is zero within rounding from t = {min(times)!r} to {max(times)!r} s: no "
                "event is listed there"
            )


def _joined(
    before: list[tuple[EventZero, Floats]], after: list[tuple[EventZero, Floats]], t0: float
) -> list[tuple[EventZero, Floats]]:
    """Return one list of the zeros before and after the start t0 of a motion, each with the states there."""
    at_start = {each.event: each for each, _ in before if each.t == t0}
    joined = [
        pair for pair in before if pair[0].t != t0 or pair[0].event not in {e.event for e, _ in after if e.t == t0}
    ]
    for each, row in after:
        other = at_start.get(each.event) if each.t == t0 else None
        # a zero at the start is listed once; it touches if the sign is the same before and after it
        joined.append((each._replace(kind="touching") if other and other.kind == each.kind else each, row))
    return joined


def _side(motion: Motion, end: float) -> _Side:
    """Return the part of a motion from its initial time to ``end``, s, as polynomials and as a function of times.

    The time ``end`` may be earlier than the initial time.
    """
    plan = motion.plan
    start, y0 = motion.start, np.array(plan.initial_state, dtype=np.float64)
    broken: list[PropagationError] = []
    if isinstance(motion, MotionInParts):
        pieces, path = motion.parts(end, broken)
        clean = _without_residues(pieces, error_blocks(plan)[0])
        return _Side(clean, path, broken, lambda: path.stats)
    if isinstance(motion, SteppedInC):
        integration = motion.stepping.restarted()
        rows: list[Floats] = []

        def states(times: Floats) -> Floats:
            dense = integration.stepper.dense
            values = dense(np.concatenate(rows), times) if rows else np.empty((len(times), len(y0)))
            values[times == start] = y0
            return values

        return _Side(stepped(integration, end, broken, rows), states, broken, integration.stats)
    blocks = error_blocks(plan)
    if isinstance(motion, SciPyMotion):
        from symrot.propagation.steppers import fallback

        recording = fallback.record(
            motion.rates,
            motion.rate_parameters,
            y0,
            start,
            (start, end),
            motion.tolerance,
            motion.options(motion.rate_parameters),
        )

        def steps() -> Generator[Piece, None, None]:
            for edges in recording.edges(start, end):
                yield fitted(recording, edges, *blocks)

        return _Side(steps(), recording, broken, lambda: recording.stats)

    def anywhere(times: Floats) -> Floats:
        return motion.integrate(times)[0]

    rates = anywhere(np.linspace(start, end, SAMPLES_OF_RATE))[:, : blocks[0][1]]
    longest = min(TURN_PER_PIECE / max(float(np.abs(rates).max()), 1e-300), abs(end - start))
    followed = fitted_pieces(anywhere, start, end, longest, *blocks)
    return _Side(followed, anywhere, broken, lambda: Stats(0, 0, 0, 0.0))


def _without_residues(pieces: Sequence[Piece], blocks: Sequence[int]) -> Generator[Piece, None, None]:
    """Yield the polynomials of a motion, with states that are zero up to rounding errors set to zero.

    ``blocks`` are the edges of the blocks of states (omega, attitude), such as (0, 3, 7).
    """
    # Such as the angular velocity of a body that friction has stopped, whose sign must not change again and again. A
    # state is compared with the largest value in its block (omega, attitude).
    count = blocks[-1]
    terms = [np.abs(piece.rows[:, HEAD:]).reshape(len(piece.rows), -1, count) for piece in pieces]
    largest = np.max([each[:, 0].max(axis=0) for each in terms if len(each)], axis=0)
    for low, high in pairwise(blocks):
        largest[low:high] = largest[low:high].max()
    for piece, sizes in zip(pieces, terms, strict=True):
        rows = piece.rows.copy()
        coefficients = rows[:, HEAD:].reshape(sizes.shape)
        coefficients[:, 0][sizes[:, 0] <= RESIDUE * largest] = 0.0
        coefficients *= (sizes.sum(axis=1) > RESIDUE * largest)[:, None, :]
        rows[:, HEAD:] = coefficients.reshape(len(rows), -1)
        yield Piece(piece.edges, rows)
