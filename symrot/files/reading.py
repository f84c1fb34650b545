"""Read a file that somebody else may have made: a regular file, up to a size, so that no pipe or device blocks.

Every scene, claim file, table, certificate and study is opened here. Standard library only.
"""

import os
import stat
from errno import EFBIG, EINVAL
from pathlib import Path

__all__ = ["read_input", "refuse_special"]

SPECIAL = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)
"""Files that are not regular: how the mode of a file shows them, and what a sentence calls them."""


def refuse_special(path: Path) -> os.stat_result:
    """Return the status of a regular file, links followed.

    Raises
    ------
    OSError
        For a folder, pipe, socket or device, and where there is no file; ``strerror`` continues "expected .., got".
    """
    status = path.stat()
    _refuse_mode(status.st_mode)
    return status


def _refuse_mode(mode: int) -> None:
    if not stat.S_ISREG(mode):
        raise OSError(EINVAL, next((name for shows, name in SPECIAL if shows(mode)), "no regular file"))


def read_input(path: Path, largest: int) -> bytes:
    """Return the content of a regular file of at most ``largest`` bytes.

    The kind of the file is asked for before it is opened, since opening alone starts some devices, and again of what
    was opened, which may have been exchanged in between.

    Raises
    ------
    OSError
        As :func:`refuse_special`, for a larger file, and for one that cannot be read.
    """
    try:
        refuse_special(path)
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except ValueError as reason:  # a NUL in the name
        raise OSError(EINVAL, str(reason)) from None
    with open(descriptor, "rb", buffering=0) as stream:  # noqa: PTH123 - a descriptor has no path
        _refuse_mode(os.fstat(descriptor).st_mode)
        parts, rest = [], largest + 1
        while rest and (part := stream.read(rest)):
            parts.append(part)
            rest -= len(part)
    if not rest:
        raise OSError(EFBIG, "a larger one")
    return b"".join(parts)
