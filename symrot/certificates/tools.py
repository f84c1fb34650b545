"""Running of external programs, such as objdump and coqc, with a time limit."""

import os
import signal
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from subprocess import DEVNULL, PIPE, CompletedProcess, Popen, TimeoutExpired

from symrot.errors import CompilerError

__all__ = ["run_tool"]


def run_tool(
    command: Sequence[str],
    seconds: float,
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> CompletedProcess[str]:
    """Run a program and return its output, error output and exit status.

    Raises
    ------
    CompilerError
        If the program cannot be started, or does not end within ``seconds``; then it and all programs that it started
        are killed.
    """
    try:
        process = Popen(
            command, cwd=cwd, env=environment, stdin=DEVNULL, stdout=PIPE, stderr=PIPE, start_new_session=True
        )
    except OSError as error:
        raise CompilerError(f"{command[0]} cannot be started: {error.strerror or error}") from None
    with process:
        try:
            out, complaint = process.communicate(timeout=seconds)
        except TimeoutExpired:
            raise CompilerError(f"{command[0]} was stopped, because it did not end within {seconds:g} s") from None
        finally:
            if process.poll() is None:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL) if hasattr(os, "killpg") else process.kill()
    return CompletedProcess(
        [*command], process.returncode, out.decode("utf-8", "replace"), complaint.decode("utf-8", "replace")
    )
