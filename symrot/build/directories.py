"""The directories for compiled libraries: the cache of the user, if nobody else can write there, or a temporary one.

Libraries are machine code that symrot runs, so a directory that another user could change is not used. This module
does not import NumPy, which would be slow.
"""

import os
import stat
import sys
from functools import cache
from pathlib import Path

from symrot.errors import CompilerError

__all__ = ["Temporary", "foreign", "user_directory"]

CACHE_SUBDIR = "kernels"  # the only directory inside the cache that is written, checked and cleared


class Temporary:
    """The private cache directory of this process, created on first use and removed when the process ends."""

    def __init__(self) -> None:
        self.path: Path | None = None
        self.reason = ""
        self.texts: dict[str, str] = {}  # used when no disk can be written

    def use(self, reason: str) -> Path:
        """Return the path of the temporary directory; the first call creates the directory.

        ``reason`` says why the user's directory cannot be used; later calls do not change the stored reason.

        Raises
        ------
        CompilerError
            If no temporary directory can be created.
        """
        if self.path is None:
            import atexit
            import shutil
            import tempfile

            try:
                self.path = Path(tempfile.mkdtemp(prefix="symrot-"))
            except OSError as error:
                raise CompilerError(
                    f"compiled kernels need a directory: {reason}, and a temporary directory cannot be created: {error}"
                ) from error
            atexit.register(shutil.rmtree, self.path, ignore_errors=True)
            self.reason = reason
        return self.path


def _cache_directory() -> Path:
    if chosen := os.environ.get("SYMROT_CACHE"):
        return Path(chosen)
    if chosen := os.environ.get("XDG_CACHE_HOME"):
        return Path(chosen) / "symrot"
    if sys.platform == "win32" and (chosen := os.environ.get("LOCALAPPDATA")):
        return Path(chosen) / "symrot"
    return Path("~").expanduser() / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "symrot"


def foreign(path: Path) -> str:
    """Return why a file or directory must not be trusted, such as another owner; an empty text if it can be trusted."""
    status = path.lstat()
    if hasattr(os, "getuid") and status.st_uid != os.getuid():
        return f"{path} belongs to another user (uid {status.st_uid})"
    if stat.S_ISLNK(status.st_mode):
        return f"{path} is a symbolic link"
    if not (stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)):
        return f"{path} is neither a regular file nor a directory"
    return ""


@cache
def _exposed(directory: Path) -> str:
    """Return why another user could replace the cache ``directory``; an empty text if nobody could."""
    if not hasattr(os, "getuid"):
        return ""
    # Who may write to a directory may rename its entries, even those of others; in a sticky directory such as /tmp,
    # only the owner of the entry, the owner of the directory and root may.
    for path in dict.fromkeys((*directory.absolute().parents, *directory.resolve().parents)):
        for status in (path.lstat(), path.stat()):  # a symbolic link, and its target
            if status.st_uid not in (0, os.getuid()):
                return (
                    f"{path} belongs to another user (uid {status.st_uid}), who could replace {directory}; set "
                    "SYMROT_CACHE to a directory below one of your own"
                )
        mode = status.st_mode
        others = mode & stat.S_IWOTH or (mode & stat.S_IWGRP and _shared_group(status.st_gid))
        if others and not mode & stat.S_ISVTX:
            return (
                f"{path} can be written by other users, who could replace {directory}; forbid them to write (chmod "
                "go-w), or set SYMROT_CACHE to another directory"
            )
    return ""


def _shared_group(group: int) -> bool:
    """Return whether a group may have members other than the user.

    True if the system does not know the group or the user.
    """
    import grp
    import pwd

    try:
        user, members = pwd.getpwuid(os.getuid()), grp.getgrgid(group)
    except KeyError:
        return True
    # the user's own group has the name of the user and no other members
    return members.gr_name != user.pw_name or not {user.pw_name}.issuperset(members.gr_mem)


def user_directory() -> tuple[Path, str]:
    """Return the user's cache directory and the reason why it cannot be used; the reason is "" if it can be used.

    If the directory does not exist, it is created; if others have access to it, this access is withdrawn.
    """
    try:
        directory = _cache_directory() / CACHE_SUBDIR
    except RuntimeError:
        return Path(CACHE_SUBDIR), "the home directory is unknown; set SYMROT_CACHE to a directory"
    try:
        if not directory.is_dir():
            for place in (*reversed(directory.parents), directory):
                place.mkdir(mode=0o700, exist_ok=True)
        reason = foreign(directory) or _exposed(directory)
        if not reason and directory.stat().st_mode & 0o077:
            # private, so that nobody else can add libraries
            directory.chmod(0o700)
        if not reason and not os.access(directory, os.W_OK):
            reason = f"{directory} cannot be written"
    except OSError as error:
        reason = f"{directory} cannot be used: {error.strerror or error}"
    return directory, reason
