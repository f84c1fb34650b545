"""A hook with which Ctrl-C ends the command even at moments when Python discards the KeyboardInterrupt.

Python discards an exception raised inside a weak reference's callback, a ``__del__`` method or a callback from C: it
passes the exception to ``sys.unraisablehook`` and continues. A KeyboardInterrupt at such a moment, for example during
an import, would leave the command running. The hook raises the interrupt again a moment later.
"""

import signal
import sys
from threading import Timer, main_thread
from typing import Any

__all__ = ["end_quietly", "repeat_lost_interrupts"]

SECONDS = 0.02  # enough time for the interrupted callback to return


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
