"""Run a C compiler: for a bounded time, and so that it ends with everything it started when this process is stopped.

Imported when something has to be compiled, which most runs do not need.
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
"""Names of threads that wait for a compiler."""

_running: set[Popen[bytes]] = set()


def run_compiler(command: Sequence[str], flags: Sequence[str], source: str, output: Path, seconds: float) -> str:
    """Compile a text; return the first complaint, or an empty text when the library is there.

    Raises
    ------
    CompilerError
        If the compiler takes longer than ``seconds``, or is killed: other flags would not help.
    """
    words = [*command, *flags, "-x", "c", "-", "-o", str(output), "-lm"]
    environment = {**os.environ, "LC_ALL": "C"}
    try:
        process = Popen(words, stdin=PIPE, stdout=PIPE, stderr=PIPE, env=environment, start_new_session=True)
    except OSError as error:
        return f"it cannot be run: {error.strerror or error}"
    with process:
        _running.add(process)
        if current_thread().name == STOPPED:  # in between: whoever stopped the others did not see this one
            _kill(process)
        try:
            complaint = process.communicate(source.encode(), seconds)[1].decode("utf-8", "replace")
        except TimeoutExpired:
            raise CompilerError(
                f"the C compiler {command[0]} is stopped: no answer within {seconds:g} s; set CC to another one"
            ) from None
        finally:
            _running.discard(process)
            _kill(process)
    if process.returncode == -SIGKILL:
        raise CompilerError(f"the C compiler {command[0]} was killed before it was done")
    if process.returncode == 0 and output.is_file() and output.stat().st_size:
        return ""
    lines = [line.strip() for line in complaint.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line.lower()]
    silence = f"exit status {process.returncode}, no message" if process.returncode else "no library was written"
    return (errors or lines or [silence])[0]


def stop_all() -> None:
    """Kill the compilers that threads wait for, and those that these threads would start next."""
    for thread in enumerate_threads():
        if thread.name == WAITING:
            thread.name = STOPPED
    for process in list(_running):
        _kill(process)


def _kill(process: Popen[bytes]) -> None:
    """End a compiler and the programs that it started; it is a group of processes of its own."""
    if process.poll() is None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, SIGKILL) if hasattr(os, "killpg") else process.kill()
