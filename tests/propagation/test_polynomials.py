"""Motions as polynomials: rows of steppers agree with their dense output, and fits follow a function to rounding."""

import signal

import numpy as np
import pytest

import symrot
from symrot.errors import PropagationError
from symrot.propagation.events.polynomials import HEAD, fitted, fitted_pieces, stepped
from tests.propagation.test_events import run, scene


def value(row, t, count):
    """Return the states that a row gives at a time, shape (count,)."""
    terms = row[HEAD:].reshape(-1, count)
    return ((((t - row[0]) - row[2]) / row[3]) ** np.arange(len(terms))) @ terms


@pytest.mark.parametrize("method", ["taylor", "dop853"])
@pytest.mark.parametrize("end", [9.0, -9.0])
def test_rows_are_the_dense_output(method, end):
    task = symrot.propagator(scene(), method=method, tolerance=1e-10)._motion.stepping.restarted()
    records, steps = [], 0
    for piece in stepped(task, end, [], records):
        assert len(piece.edges) == len(piece.rows) + 1
        for row, low, high in zip(piece.rows, piece.edges[:-1], piece.edges[1:], strict=True):
            times = low + (high - low) * np.array([0.0, 0.2, 0.7, 1.0])
            expected = task.stepper.dense(records[-1], times)
            actual = np.array([value(row, t, expected.shape[1]) for t in times])
            assert np.abs(actual - expected)[1:].max() < 1e-14
            steps += 1
    assert steps == task.accepted and piece.edges[-1] == end


def test_fits_follow_a_motion_to_rounding_and_are_cut_where_it_is_steep():
    def states(t):
        return np.stack([np.tanh(40 * (t - 1.3)), np.cos(3 * t)], axis=1)

    for start, end in ((0.0, 7.0), (7.0, -1.0)):
        pieces = list(fitted_pieces(states, start, end, 1.0, [0, 1, 2], [0.0, 1.0]))
        assert pieces[0].edges[0] == start and pieces[-1].edges[-1] == end
        for piece in pieces:
            for row, low, high in zip(piece.rows, piece.edges[:-1], piece.edges[1:], strict=True):
                times = low + (high - low) * np.linspace(0, 1, 9)
                assert np.abs(np.array([value(row, t, 2) for t in times]) - states(times)).max() < 1e-13
        assert max(len(piece.rows) for piece in pieces) > 8


def test_what_polynomials_cannot_follow_is_refused():
    with pytest.raises(PropagationError, match="expected a motion that piecewise polynomials can approximate"):
        fitted(lambda t: np.sign(t - 0.3)[:, None], np.array([0.0, 1.0]), [0, 1], [1.0])


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs the timers of POSIX")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # from a finaliser
@pytest.mark.parametrize("method", ["exact", "taylor"])
def test_an_interrupt_ends_a_search(method):
    """The search checks for Ctrl-C between short calls of the library; uninterrupted, it would end with a message."""

    class Interrupt(BaseException):
        pass

    def stop(number, frame):
        raise Interrupt

    run(scene(), ["sin(1/(t - 4))", "t - 40"], method, t=[0.0, 1.0])  # compile
    before = signal.signal(signal.SIGALRM, stop)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.2, 1.0)  # again, should the first one fall into a finaliser
        with pytest.raises(Interrupt):
            run(scene(), ["sin(1/(t - 4))", "t - 40"], method)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
