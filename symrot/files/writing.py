"""Writing that never leaves an incomplete file: a temporary file in the same folder is renamed when it is complete."""

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import BinaryIO

from symrot.errors import InputError

__all__ = ["check_target", "write"]


def check_target(path: Path, suffixes: Sequence[str], option: str) -> None:
    """Raise InputError if a file cannot be written at ``path``; commands call this before they compute the content.

    ``option``, such as ``--out``, is named in messages.

    Raises
    ------
    InputError
        If the suffix is unknown, the folder is missing, the path is a folder, or a permission is missing.
    """
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{option}: expected a file name that ends in {', '.join(suffixes)}, got {str(path)!r}")
    try:
        if path.is_dir():
            raise InputError(f"{option}: expected the name of a file, got the folder {str(path)!r}")
        if path.exists() and not path.is_file():
            raise InputError(f"{option}: expected the name of a file, got the device or pipe {str(path)!r}")
        if not path.parent.is_dir():
            raise InputError(f"{option}: expected a file in an existing folder, got {str(path)!r}")
        if not os.access(path if path.exists() else path.parent, os.W_OK):
            raise InputError(f"{option}: expected a file that can be written, got {str(path)!r} (permission denied)")
    except InputError:
        raise
    except (OSError, ValueError) as reason:  # the name is too long or contains a NUL character
        raise _refusal(path, reason) from None


def _refusal(path: Path, reason: Exception) -> InputError:
    return InputError(f"{str(path)!r} cannot be written: {getattr(reason, 'strerror', None) or reason}")


def write(path: Path, content: Callable[[BinaryIO], object]) -> None:
    """Write a file at ``path`` completely or not at all; ``content`` writes the bytes into an open binary file.

    Raises
    ------
    InputError
        If writing fails with an OSError; an existing file at ``path`` is then unchanged.
    """
    target = path.resolve()  # a link keeps pointing to its file
    # a temporary file in the same folder, renamed when complete
    passing = target.with_name(f".{target.name[:100]}.{os.getpid()}.part")
    try:
        try:
            with passing.open("xb") as stream:
                content(stream)
                stream.flush()
                os.fsync(stream.fileno())
                if target.exists():
                    passing.chmod(target.stat().st_mode & 0o777)
            passing.replace(target)
        finally:
            passing.unlink(missing_ok=True)
    except OSError as reason:
        raise _refusal(path, reason) from reason  # a sweep sees by the cause that it can go on
