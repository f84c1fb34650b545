"""Hooks with which Ctrl-C ends the command even where Python or a library loses the KeyboardInterrupt.

Python discards an exception raised inside a weak reference's callback, a ``__del__`` method or a callback from C: it
passes the exception to ``sys.unraisablehook`` and continues. A KeyboardInterrupt at such a moment, for example during
an import, would leave the command running. The hook raises the interrupt again a moment later.

C code may also replace the KeyboardInterrupt by an exception of its own: NumPy raises an ImportError if Ctrl-C arrives
while it imports ``datetime``. So a handler notes that Ctrl-C was pressed.
"""

import signal
import sys
from threading import Timer, current_thread, main_thread
from types import FrameType
from typing import Any

__all__ = ["end_quietly", "is_interrupt", "note_interrupts", "repeat_lost_interrupts"]

SECONDS = 0.02  # enough time for the interrupted callback to return
SIGNALS: list[int] = []  # one entry each time Ctrl-C was pressed; appending needs no lock, as a handler must not wait


def note_interrupts() -> None:
    """Install a signal handler that notes Ctrl-C for `is_interrupt` before it raises KeyboardInterrupt.

    Another handler, or a shell that makes the process ignore Ctrl-C, keeps its effect.
    """
    SIGNALS.clear()
    if current_thread() is main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _note_and_raise)


def is_interrupt(error: BaseException) -> bool:
    """Tell whether an exception ends the command because of Ctrl-C: a KeyboardInterrupt, or any after Ctrl-C."""
    return isinstance(error, KeyboardInterrupt) or bool(SIGNALS)


def repeat_lost_interrupts() -> None:
    """Install a hook that raises a KeyboardInterrupt again if Python discards it (see the module's text).

    Other discarded exceptions go to the hook that was installed before.
    """
    previous = sys.unraisablehook

    def hook(discarded: Any, /) -> None:
        if discarded.exc_type is KeyboardInterrupt:
            _interrupt_later()
        else:
            previous(discarded)

    sys.unraisablehook = hook


def end_quietly() -> None:
    """Make Python print nothing about the exceptions that it discards while it exits.

    For example, a clean-up at the exit may find that the pipe to a killed process is closed.
    """
    sys.unraisablehook = lambda discarded: None


def _note_and_raise(number: int, frame: FrameType | None, /) -> None:
    SIGNALS.append(number)
    signal.default_int_handler(number, frame)


def _interrupt_later() -> None:
    timer = Timer(SECONDS, _interrupt)
    timer.daemon = True
    timer.start()


def _interrupt() -> None:
    """Interrupt the main thread by a signal, because only a signal wakes a thread that waits for a lock."""
    main = main_thread().ident
    if hasattr(signal, "pthread_kill") and main is not None:
        signal.pthread_kill(main, signal.SIGINT)
    else:
        signal.raise_signal(signal.SIGINT)
