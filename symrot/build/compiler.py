"""Runs of a C compiler with a time limit; after it, or after Ctrl-C, the compiler and its child processes are killed.

This module is imported only if something has to be compiled; mostly the library is already in the cache.
"""

import os
import signal
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from subprocess import PIPE, Popen, TimeoutExpired
from threading import current_thread
from threading import enumerate as enumerate_threads

from symrot.errors import CompilerError

__all__ = ["WAITING", "run_compiler", "stop_all"]

SIGKILL = getattr(signal, "SIGKILL", signal.SIGTERM)

WAITING, STOPPED = "symrot compiles", "symrot compiles no more"
"""Names of a thread that waits for a compiler: before and after :func:`stop_all`."""

_running: set[Popen[bytes]] = set()


def run_compiler(command: Sequence[str], flags: Sequence[str], source: str, output: Path, seconds: float) -> str:
    """Compile the C text ``source`` into the file ``output``; return "" or the first error message of the compiler.

    Raises
    ------
    CompilerError
        If the compiler takes longer than ``seconds``, or is killed, so that a second try with other flags is useless.
    """
    words = [*command, *flags, "-x", "c", "-", "-o", str(output), "-lm"]
    environment = {**os.environ, "LC_ALL": "C"}
    try:
        process = Popen(words, stdin=PIPE, stdout=PIPE, stderr=PIPE, env=environment, start_new_session=True)
    except OSError as error:
        return f"it cannot be run: {error.strerror or error}"
    with process:
        _running.add(process)
        if current_thread().name == STOPPED:  # stop_all ran after the thread started and before this process was listed
            _kill(process)
        try:
            complaint = process.communicate(source.encode(), seconds)[1].decode("utf-8", "replace")
        except TimeoutExpired:
            raise CompilerError(
                f"the C compiler {command[0]} did not end within {seconds:g} s and was stopped; "
                "set CC to another compiler"
            ) from None
        finally:
            _running.discard(process)
            _kill(process)
    if process.returncode == -SIGKILL:
        raise CompilerError(f"the C compiler {command[0]} was killed before it had finished")
    if process.returncode == 0 and output.is_file() and output.stat().st_size:
        return ""
    lines = [line.strip() for line in complaint.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower()]
    silence = f"exit status {process.returncode}, no message" if process.returncode else "no library was written"
    return (errors or lines or [silence])[0]


def stop_all() -> None:
    """Kill all running compilers; a compiler that a waiting thread starts afterwards is killed at once."""
    for thread in enumerate_threads():
        if thread.name == WAITING:
            thread.name = STOPPED
    for process in list(_running):
        _kill(process)


def _kill(process: Popen[bytes]) -> None:
    """Kill a compiler and the programs that it started; all belong to the same process group."""
    if process.poll() is None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, SIGKILL) if hasattr(os, "killpg") else process.kill()
