"""Reading of files of unknown origin: only regular files up to a size limit, so that no pipe or device blocks.

symrot opens all scenes, claim files, tables, certificates, studies, robot files and meshes here. Imports only the
standard library and :mod:`symrot.errors`.
"""

import os
import stat
from collections.abc import Iterable
from errno import EFBIG, EINVAL
from pathlib import Path

from symrot.errors import InputError

__all__ = ["read_input", "refuse_special", "repeated_name", "utf8_text"]

SPECIAL = (
    (stat.S_ISDIR, "a folder"),
    (stat.S_ISFIFO, "a pipe"),
    (stat.S_ISSOCK, "a socket"),
    (stat.S_ISCHR, "a device"),
    (stat.S_ISBLK, "a device"),
)
"""Kinds of special files: a test of the mode of the file, and the name of the kind for an error message."""


def refuse_special(path: Path) -> os.stat_result:
    """Return the status (``os.stat``) of a regular file, following links; raise OSError for any other path.

    Raises
    ------
    OSError
        If the path is a folder, pipe, socket or device, or if the file does not exist. The attribute ``strerror`` is
        the end of a message "expected .., got ..": the words "a folder", for instance.
    ValueError
        If the name of the file contains a NUL character.
    """
    status = path.stat()
    _refuse_mode(status.st_mode)
    return status


def _refuse_mode(mode: int) -> None:
    if not stat.S_ISREG(mode):
        raise OSError(EINVAL, next((name for shows, name in SPECIAL if shows(mode)), "a special file"))


def read_input(path: Path, largest: int) -> bytes:
    """Return the content of a regular file of at most ``largest`` bytes.

    Raises
    ------
    OSError
        If the file is special or missing (see :func:`refuse_special`), too large, or cannot be read.
    """
    try:
        # before opening, because the mere opening has an effect on some devices
        refuse_special(path)
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    except ValueError as reason:  # the name contains a NUL character
        raise OSError(EINVAL, str(reason)) from None
    with open(descriptor, "rb", buffering=0) as stream:  # noqa: PTH123 - a descriptor has no path
        # again after opening, because the file may have been replaced in between
        _refuse_mode(os.fstat(descriptor).st_mode)
        parts, rest = [], largest + 1
        while rest and (part := stream.read(rest)):
            parts.append(part)
            rest -= len(part)
    if not rest:
        raise OSError(EFBIG, "a larger one")
    return b"".join(parts)


def utf8_text(content: bytes, label: object) -> str:
    """Return the content of a file, which ``label`` names, as text without a byte order mark.

    Raise InputError with the first byte that is no UTF-8 text.
    """
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as reason:
        byte = content[reason.start]
        raise InputError(f"{label}: expected UTF-8 text, got byte 0x{byte:02x} at position {reason.start}") from None


def repeated_name(pairs: Iterable[tuple[str, object]]) -> str | None:
    """Return the first name that occurs twice in the (name, value) pairs of a JSON object; None if all names differ."""
    names = set[str]()
    for name, _ in pairs:
        if name in names:
            return name
        names.add(name)
    return None
