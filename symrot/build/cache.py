"""Compile C source once, keep the result in the user's cache, and find it again without running a compiler.

An entry is keyed by the source, the identity of the compiler (resolved path, size, time of change), the flags and the
processor; it is named by its own checksum, so a truncated or altered file is noticed and built anew instead of loaded.
Files appear by atomic rename, so any number of processes may build at once. The directory is private (mode 0700); one
that belongs to another user, or that another user could exchange, is not used. Where the cache cannot be used, a
temporary directory of this process takes its place and :func:`cache` says why.

Environment: ``CC`` names the compiler; ``SYMROT_CACHE`` the cache directory, else ``XDG_CACHE_HOME/symrot``, else the
platform's own place. This module imports neither SymPy nor NumPy nor SciPy.
"""

import os
import re
import stat
import sys
from functools import cache as cache_once
from pathlib import Path
from typing import Any, NamedTuple

from symrot.errors import CompilerError

try:
    from _sha256 import sha256  # type: ignore[import-not-found]  # hashlib loads OpenSSL for its own: 2 ms of a start
except ImportError:  # another version of Python
    from hashlib import sha256

__all__ = [
    "FLAGS",
    "Building",
    "Cache",
    "Compiler",
    "build",
    "built",
    "cache",
    "clear",
    "compiler",
    "fetch",
    "missing",
    "stop_compilers",
    "store",
]

NATIVE = "-march=native"
FLAGS = (
    "-std=c99",
    "-O2",
    "-fno-tree-slp-vectorize",  # it slows long straight-line code
    NATIVE,
    "-ffp-contract=fast",
    "-fno-math-errno",
    "-fPIC",
    "-shared",
)
SCHEDULED = ("-fschedule-insns", "-fsched-pressure")  # sums in an order that suits the registers there are
TUNING = (*SCHEDULED, "-fno-tree-pre", "-fno-gcse", "-fno-ivopts")  # numbers in memory rather than in registers
"""Flags of gcc for long sums, each where it was measured to gain; a compiler that refuses them does without."""

COMPILERS = ("cc", "gcc", "clang")
SECONDS_TO_COMPILE = 300  # a compiler that takes longer is taken to hang
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
ROOM = "kernels"  # the only directory inside the cache that is written, checked and cleared
OWN_FILE = re.compile(r"(\w+-[0-9a-f]{32}\.(so|dll|dylib|index|text)|\.symrot-\w+)\Z")


class Compiler(NamedTuple):
    """A C compiler: the words that start it, and what identifies the program found."""

    command: tuple[str, ...]
    identity: str


class Cache(NamedTuple):
    """Where compiled kernels are kept; ``reason`` says why it is not the user's cache, or is empty."""

    directory: Path
    reason: str


def compiler() -> Compiler:
    """Return the C compiler named by ``CC``, or the first of cc, gcc, clang on the path; no program is run.

    Raises
    ------
    CompilerError
        If there is none; the sentence names ``CC``.
    """
    chosen = os.environ.get("CC", "").strip()
    candidates = [(chosen,), tuple(chosen.split())] if chosen else [(name,) for name in COMPILERS]
    for command in candidates:
        path = _which(command[0])
        if path is not None:
            return Compiler((path, *command[1:]), _identity(path, command[1:]))
    wanted = f"CC={chosen!r} names no program" if chosen else f"none of {', '.join(COMPILERS)} is on the path"
    raise CompilerError(f"a C compiler is needed: {wanted}; set CC to one")


def missing() -> str:
    """Return an empty text, or the sentence that says why there is no C compiler."""
    try:
        compiler()
    except CompilerError as error:
        return str(error)
    return ""


def cache(probe: bool = False) -> Cache:
    """Return the directory in use and why it is a temporary one, if it is; a probe notices a full disk too."""
    if probe:
        _keep(_text_name("probe"), b"")
    if _temporary.path is not None:
        return Cache(_temporary.path, _temporary.reason)
    directory, reason = _own_room()
    return Cache(_temporary.use(reason) if reason else directory, reason)


def build(source: str, name: str, flags: tuple[str, ...] = FLAGS) -> Path:
    """Return the shared library compiled from ``source``, from the cache where it is there and sound.

    Parameters
    ----------
    source : str
        One whole C translation unit; it is compiled from standard input.
    name : str
        Letters, digits and underscores; begins the file's name, for people.
    flags : tuple of str
        As the compiler takes them. A compiler that does not know ``-march=native`` is asked again without it.

    Raises
    ------
    CompilerError
        If there is no compiler, or it refuses the source: its first complaint is quoted.
    """
    tool = compiler()
    found = built(source, name, flags)
    return _compile(tool, source, name, _entry(tool, source, name, flags), flags) if found is None else found


def built(source: str, name: str, flags: tuple[str, ...] = FLAGS) -> Path | None:
    """Return the library that :func:`build` would return without compiling, or None where it would have to compile."""
    entry = _entry(compiler(), source, name, flags)
    for directory in _rooms():
        if (found := _sound_library(directory, entry, name)) is not None:
            return found
    return None


class Building:
    """A library that is compiled while its caller does something else; arguments as :func:`build`."""

    def __init__(self, source: str, name: str, flags: tuple[str, ...] = FLAGS) -> None:
        self._path: Path | None = built(source, name, flags)
        self._error: Exception | None = None
        self._thread: Any = None
        if self._path is None:
            from threading import Thread

            self._thread = Thread(target=self._work, args=(source, name, flags), name="symrot compiles")
            self._thread.start()

    def _work(self, source: str, name: str, flags: tuple[str, ...]) -> None:
        try:
            self._path = build(source, name, flags)
        except Exception as error:  # carried over to the thread that asks
            self._error = error

    def wait(self) -> None:
        """Return when the compiler is done, well or not."""
        if self._thread is not None:
            try:
                self._thread.join()
            except KeyboardInterrupt:
                stop_compilers()
                raise

    def path(self) -> Path:
        """Return the library when it is there.

        Raises
        ------
        CompilerError
            As :func:`build`.
        """
        self.wait()
        if self._error is not None:
            raise self._error
        assert self._path is not None
        return self._path


def stop_compilers() -> None:
    """Kill the compilers that threads of this process wait for, as after Ctrl-C; who waits gets a CompilerError."""
    from symrot.build.compiler import stop_all

    stop_all()


def _entry(tool: Compiler, source: str, name: str, flags: tuple[str, ...]) -> str:
    processor = _processor() if NATIVE in flags else ""
    key = _digest("\0".join((source, tool.identity, *flags, processor, sys.platform)))
    return f"{name}-{key}.index"


def store(key: str, text: str) -> None:
    """Keep a small text under a key (any string). A cache that cannot be written keeps it for this process only."""
    try:
        _keep(_text_name(key), f"{_digest(text)}\n{text}".encode())
    except CompilerError:
        _temporary.texts[key] = text


def fetch(key: str) -> str | None:
    """Return the text stored under the key, or None where there is none or it is damaged."""
    for directory in _rooms():
        kept = _read(directory / _text_name(key))
        if kept is not None:
            checksum, _, text = kept.decode("utf-8", "replace").partition("\n")
            if checksum == _digest(text):
                return text
    return _temporary.texts.get(key)


def clear() -> tuple[Path, ...]:
    """Remove every file of ours from the cache and return their paths; what is not ours stays where it is."""
    removed = []
    for directory in _rooms():
        for path in sorted(directory.iterdir()):
            if OWN_FILE.match(path.name) and path.is_file() and not path.is_symlink():
                path.unlink(missing_ok=True)
                removed.append(path)
    return tuple(removed)


# ------------------------------------------------------------------------------------------------ identities


def _digest(text: str) -> str:
    found: str = sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:32]
    return found


def _which(program: str) -> str | None:
    """Return the full path of an executable file, searched as the shell does (shutil is slow to import)."""
    endings = ("", ".exe") if sys.platform == "win32" else ("",)
    named = os.sep in program or (os.altsep is not None and os.altsep in program)
    for place in [""] if named else os.environ.get("PATH", os.defpath).split(os.pathsep):
        for ending in endings:
            path = os.path.join(place, program + ending)  # noqa: PTH118  # a tenth of the time of a Path
            if os.access(path, os.X_OK) and Path(path).is_file():
                return str(Path(path).absolute())
    return None


def _identity(path: str, arguments: tuple[str, ...]) -> str:
    real = Path(path).resolve()
    found = real.stat()
    return "\0".join((str(real), str(found.st_size), str(found.st_mtime_ns), *arguments))


@cache_once
def _processor() -> str:
    """Return what tells processors apart for ``-march=native``: the first one's family, model and features."""
    try:
        with Path("/proc/cpuinfo").open(encoding="ascii", errors="replace") as stream:
            first = stream.read(16384).split("\n\n")[0]
    except OSError:
        # No such file: the machine's own name stands for its processor.
        return " ".join(os.uname()) if hasattr(os, "uname") else os.environ.get("PROCESSOR_IDENTIFIER", "")
    telling = ("vendor", "cpu family", "model", "stepping", "flags", "CPU ", "Features", "isa", "uarch", "cpu\t")
    return "\n".join(line for line in first.splitlines() if line.startswith(telling))


# ------------------------------------------------------------------------------------------------ places


class _Temporary:
    """The private directory of this process, made when first needed and removed at exit."""

    def __init__(self) -> None:
        self.path: Path | None = None
        self.reason = ""
        self.texts: dict[str, str] = {}  # kept here when no disk takes them

    def use(self, reason: str) -> Path:
        if self.path is None:
            import atexit
            import shutil
            import tempfile

            try:
                self.path = Path(tempfile.mkdtemp(prefix="symrot-"))
            except OSError as error:
                raise CompilerError(
                    f"compiled kernels need a directory: {reason}, and no temporary one can be made: {error}"
                ) from error
            atexit.register(shutil.rmtree, self.path, ignore_errors=True)
            self.reason = reason
        return self.path


_temporary = _Temporary()


def _cache_directory() -> Path:
    if chosen := os.environ.get("SYMROT_CACHE"):
        return Path(chosen)
    if chosen := os.environ.get("XDG_CACHE_HOME"):
        return Path(chosen) / "symrot"
    if sys.platform == "win32" and (chosen := os.environ.get("LOCALAPPDATA")):
        return Path(chosen) / "symrot"
    return Path("~").expanduser() / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "symrot"


def _foreign(path: Path) -> str:
    """Return why a file or directory is not to be trusted, or an empty text."""
    found = path.lstat()
    if hasattr(os, "getuid") and found.st_uid != os.getuid():
        return f"{path} belongs to another user (uid {found.st_uid})"
    if stat.S_ISLNK(found.st_mode):
        return f"{path} is a symbolic link"
    if not (stat.S_ISREG(found.st_mode) or stat.S_ISDIR(found.st_mode)):
        return f"{path} is no regular file"
    return ""


@cache_once
def _exposed(room: Path) -> str:
    """Return why another user could put a directory in the place of ours, or an empty text.

    Whoever may write a directory may rename what is in it, whomever that belongs to; where the directory is sticky, as
    ``/tmp`` is, only who owns the entry, the directory or the machine may. So every directory on the way, links
    followed or not, has to be of the user or of root, and to be sticky if others may write it.
    """
    if not hasattr(os, "getuid"):
        return ""
    for path in dict.fromkeys((*room.absolute().parents, *room.resolve().parents)):
        for found in (path.lstat(), path.stat()):  # a link, and where it leads
            if found.st_uid not in (0, os.getuid()):
                return f"{path} belongs to another user (uid {found.st_uid}), who could replace {room}"
        mode = found.st_mode
        others = mode & stat.S_IWOTH or (mode & stat.S_IWGRP and _shared_group(found.st_gid))
        if others and not mode & stat.S_ISVTX:
            return f"{path} can be written by other users, who could replace {room}"
    return ""


def _shared_group(group: int) -> bool:
    """Return whether a group may have members beside the user; a user's own group has the user's name."""
    import grp
    import pwd

    try:
        user, found = pwd.getpwuid(os.getuid()), grp.getgrgid(group)
    except KeyError:
        return True
    return found.gr_name != user.pw_name or not {user.pw_name}.issuperset(found.gr_mem)


def _own_room() -> tuple[Path, str]:
    """Return the user's cache directory and why it cannot be used, or an empty text."""
    room = _cache_directory() / ROOM
    try:
        if not room.is_dir():
            for place in (*reversed(room.parents), room):
                place.mkdir(mode=0o700, exist_ok=True)
        reason = _foreign(room) or _exposed(room)
        if not reason and room.stat().st_mode & 0o077:
            room.chmod(0o700)
        if not reason and not os.access(room, os.W_OK):
            reason = f"{room} cannot be written"
    except OSError as error:
        reason = f"{room} cannot be used: {error.strerror or error}"
    return room, reason


def _rooms() -> list[Path]:
    """Return the directories that may hold entries: the user's cache if it can be used, and the temporary one."""
    directory, reason = _own_room()
    return [*([] if reason else [directory]), *([] if _temporary.path is None else [_temporary.path])]


# ------------------------------------------------------------------------------------------------ files


def _read(path: Path) -> bytes | None:
    """Return a file's bytes, or None where it is missing, unreadable or not ours."""
    try:
        return None if _foreign(path) else path.read_bytes()
    except OSError:
        return None


def _replace(path: Path, content: bytes) -> None:
    """Write a file so that others see the old one or the new one, never a part."""
    passing = path.with_name(f".symrot-{os.getpid()}_{os.urandom(4).hex()}")
    try:
        passing.write_bytes(content)
        passing.replace(path)
    finally:
        passing.unlink(missing_ok=True)


def _keep(name: str, content: bytes) -> Path:
    """Write a file into the cache, or into the temporary directory where the cache is full or read-only."""
    if _temporary.path is None:
        directory, reason = _own_room()
        if not reason:
            try:
                _replace(directory / name, content)
                return directory / name
            except OSError as error:
                reason = f"{directory} cannot be written: {error.strerror or error}"
        _temporary.use(reason)
    path = _temporary.use("") / name
    try:
        _replace(path, content)
    except OSError as error:
        raise CompilerError(f"compiled kernels need room on a disk: {path.parent}: {error.strerror}") from error
    return path


def _text_name(key: str) -> str:
    return f"text-{_digest(key)}.text"


def _library_name(name: str, content: bytes) -> str:
    return f"{name}-{sha256(content).hexdigest()[:32]}{SUFFIX}"


def _sound_library(directory: Path, entry: str, name: str) -> Path | None:
    """Return the library an index entry points to, if its content still has the checksum in its name."""
    pointer = _read(directory / entry)
    if pointer is None:
        return None
    library = pointer.decode("ascii", "replace").strip()
    if not OWN_FILE.match(library):
        return None
    content = _read(directory / library)
    return directory / library if content is not None and _library_name(name, content) == library else None


# ------------------------------------------------------------------------------------------------ the compiler


def _compile(tool: Compiler, source: str, name: str, entry: str, flags: tuple[str, ...]) -> Path:
    import tempfile

    from symrot.build.compiler import run_compiler

    try:
        with tempfile.TemporaryDirectory(prefix="symrot-", ignore_cleanup_errors=True) as place:
            output = Path(place) / f"{name}{SUFFIX}"
            complaint = run_compiler(tool.command, flags, source, output, SECONDS_TO_COMPILE)
            for spared in (set(TUNING), {*TUNING, NATIVE}):
                if complaint and spared.intersection(flags):
                    fewer = tuple(flag for flag in flags if flag not in spared)
                    again = run_compiler(tool.command, fewer, source, output, SECONDS_TO_COMPILE)
                    complaint = complaint if again else ""
            if complaint:
                raise CompilerError(f"the C compiler {tool.command[0]} fails on the kernel {name!r}: {complaint}")
            content = output.read_bytes()
    except OSError as error:
        raise CompilerError(f"compiling {name} needs a temporary directory: {error}") from error
    library = _keep(_library_name(name, content), content)
    if _keep(entry, library.name.encode()).parent == library.parent:
        return library
    return _keep(library.name, content)  # the disk filled up in between
