"""The cache of compiled C: a library is compiled once, stored for the user, and later loaded without being compiled.

The name of a library contains the checksum of its content, so a damaged one is built again. ``CC`` names the compiler,
``SYMROT_CACHE`` the cache directory. If that directory cannot be used, a temporary one replaces it. This module does
not import NumPy, which would be slow.
"""

import os
import re
import sys
from collections.abc import Callable
from functools import cache as cache_once
from pathlib import Path
from typing import Any, NamedTuple

from symrot.build.directories import Temporary, foreign, user_directory
from symrot.errors import CompilerError

try:
    from _sha256 import sha256  # type: ignore[import-not-found]  # hashlib would load OpenSSL, 2 ms at each start
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
SCHEDULED = ("-fschedule-insns", "-fsched-pressure")  # reorder sums to fit the number of registers
TUNING = (*SCHEDULED, "-fno-tree-pre", "-fno-gcse", "-fno-ivopts")  # so that numbers stay in memory, not in registers
"""Flags of gcc that make long sums faster, as measured; they are left out if the compiler does not accept them."""

COMPILERS = ("cc", "gcc", "clang")
SECONDS_TO_COMPILE = 300  # a compiler that takes longer is stopped
SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
_temporary = Temporary()
OWN_FILE = re.compile(r"(\w+-[0-9a-f]{32}\.(so|dll|dylib|index|text)|\.symrot-\w+)\Z")


class Compiler(NamedTuple):
    """A C compiler: the words of its command line, and a text that differs for another program or other options."""

    command: tuple[str, ...]
    # a part of cache keys, so that another compiler never gets libraries of this one
    identity: str


class Cache(NamedTuple):
    """The directory that stores compiled libraries, and, if it is temporary, the reason.

    The reason says why the user's directory cannot be used; it is empty if that directory is used.
    """

    directory: Path
    reason: str


def compiler() -> Compiler:
    """Return the C compiler that ``CC`` names, or the first of cc, gcc and clang on the path; no program is run.

    Raises
    ------
    CompilerError
        If there is no compiler; the message names ``CC``.
    """
    chosen = os.environ.get("CC", "").strip()
    candidates = [(chosen,), tuple(chosen.split())] if chosen else [(name,) for name in COMPILERS]
    for command in candidates:
        path = _which(command[0])
        if path is not None:
            return Compiler((path, *command[1:]), _identity(path, command[1:]))
    reason = f"CC={chosen!r} names no program" if chosen else f"none of {', '.join(COMPILERS)} is on the path"
    raise CompilerError(f"expected a C compiler, but {reason}; set CC to one")


def missing() -> str:
    """Return the sentence that says why no C compiler can be used, or an empty text if one can be used."""
    try:
        compiler()
    except CompilerError as error:
        return str(error)
    return ""


def cache(probe: bool = False) -> Cache:
    """Return the cache directory in use: the user's, or a temporary one with the reason why the user's cannot be used.

    With ``probe`` a small file is written first, so that a full disk is noticed.

    Raises
    ------
    CompilerError
        If no directory can be used, not even a temporary one.
    """
    if probe:
        _keep(_text_name("probe"), b"")
    if _temporary.path is not None:
        return Cache(_temporary.path, _temporary.reason)
    directory, reason = user_directory()
    return Cache(_temporary.use(reason) if reason else directory, reason)


def build(source: str, name: str, flags: tuple[str, ...] = FLAGS) -> Path:
    """Return the path of the shared library compiled from ``source``; an undamaged library in the cache is reused.

    Parameters
    ----------
    source : str
        The complete C text; the compiler reads it from standard input.
    name : str
        Beginning of the file name: letters, digits and underscores.
    flags : tuple of str
        Flags of the compiler. If the compiler fails, it is run again without the flags in ``TUNING``, and then also
        without ``-march=native``.

    Raises
    ------
    CompilerError
        If there is no compiler, if it rejects the source (the message quotes the first error) or takes too long, or if
        the library cannot be written to any directory.
    """
    tool = compiler()
    library = built(source, name, flags)
    return _compile(tool, source, name, _entry(tool, source, name, flags), flags) if library is None else library


def built(source: str, name: str, flags: tuple[str, ...] = FLAGS) -> Path | None:
    """Return the path of the library if the cache contains it, otherwise None; nothing is compiled.

    The arguments are the arguments of :func:`build`. CompilerError is raised if there is no compiler, even if the
    cache contains a library: the compiler is a part of the library's key.
    """
    entry = _entry(compiler(), source, name, flags)
    for directory in _directories():
        if (library := _sound_library(directory, entry, name)) is not None:
            return library
    return None


class Building:
    """The compilation of a library in another thread, unless the cache has the library; :meth:`path` waits for its end.

    CompilerError is raised at once if there is no compiler.
    """

    def __init__(self, source: str, name: str, flags: tuple[str, ...] = FLAGS) -> None:
        self._path: Path | None = built(source, name, flags)
        self._error: Exception | None = None
        self._thread: Any = None
        if self._path is None:
            self._thread = _thread(self._work, source, name, flags)
            self._thread.start()

    def _work(self, source: str, name: str, flags: tuple[str, ...]) -> None:
        try:
            self._path = build(source, name, flags)
        except Exception as error:  # raised again in the thread that calls path()
            self._error = error

    def wait(self) -> None:
        """Wait until the compiler has ended, successfully or not; Ctrl-C kills all running compilers."""
        if self._thread is not None:
            try:
                self._thread.join()
            except KeyboardInterrupt:
                stop_compilers()
                raise

    def path(self) -> Path:
        """Wait for the compiler and return the path of the library.

        Raises
        ------
        CompilerError
            As for :func:`build`.
        """
        self.wait()
        if self._error is not None:
            raise self._error
        assert self._path is not None
        return self._path


def _thread(work: Callable[..., None], *arguments: object) -> Any:
    """Return a thread, not yet started, that compiles by calling ``work(*arguments)``."""
    # All modules that the work needs are imported here: Ctrl-C during an import of the main thread can leave Python's
    # import lock locked, and then a thread that imports a module would never end.
    import atexit  # noqa: F401
    import shutil  # noqa: F401
    import tempfile  # noqa: F401
    from threading import Thread

    from symrot.build.compiler import WAITING

    return Thread(target=work, args=arguments, name=WAITING)


def stop_compilers() -> None:
    """Kill all running compilers of this process, for example after Ctrl-C; waiting callers get a CompilerError."""
    from symrot.build.compiler import stop_all

    stop_all()


def _entry(tool: Compiler, source: str, name: str, flags: tuple[str, ...]) -> str:
    processor = _processor() if NATIVE in flags else ""
    key = _digest("\0".join((source, tool.identity, *flags, processor, sys.platform)))
    return f"{name}-{key}.index"


def store(key: str, text: str) -> None:
    """Store a small text in the cache; ``key`` is any string.

    If no directory can be written, the text is kept in memory, for this process only.
    """
    try:
        _keep(_text_name(key), f"{_digest(text)}\n{text}".encode())
    except CompilerError:
        _temporary.texts[key] = text


def fetch(key: str) -> str | None:
    """Return the text that :func:`store` has stored under a key, or None if the text is missing or damaged."""
    for directory in _directories():
        content = _read(directory / _text_name(key))
        if content is not None:
            checksum, _, text = content.decode("utf-8", "replace").partition("\n")
            if checksum == _digest(text):
                return text
    return _temporary.texts.get(key)


def clear() -> tuple[Path, ...]:
    """Remove all files that symrot wrote into the cache directories in use, and return their paths.

    Other files are not touched.
    """
    removed = []
    for directory in _directories():
        for path in sorted(directory.iterdir()):
            if OWN_FILE.match(path.name) and path.is_file() and not path.is_symlink():
                path.unlink(missing_ok=True)
                removed.append(path)
    return tuple(removed)


# ------------------------------------------------------------------------------------------------ identities


def _digest(text: str) -> str:
    digest: str = sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:32]
    return digest


def _which(program: str) -> str | None:
    """Return the full path of the executable ``program``, searched in the folders of ``PATH``, or None if it is
    missing.
    """
    # the module shutil has such a function but is slow to import
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
    status = real.stat()
    return "\0".join((str(real), str(status.st_size), str(status.st_mtime_ns), *arguments))


@cache_once
def _processor() -> str:
    """Return a text that identifies this computer's processor: family, model and features."""
    # A part of cache keys: code compiled with -march=native may not run on another processor.
    try:
        with Path("/proc/cpuinfo").open(encoding="ascii", errors="replace") as stream:
            first = stream.read(16384).split("\n\n")[0]
    except OSError:
        # Without this file, the name of the machine identifies its processor.
        return " ".join(os.uname()) if hasattr(os, "uname") else os.environ.get("PROCESSOR_IDENTIFIER", "")
    telling = ("vendor", "cpu family", "model", "stepping", "flags", "CPU ", "Features", "isa", "uarch", "cpu\t")
    return "\n".join(line for line in first.splitlines() if line.startswith(telling))


# ------------------------------------------------------------------------------------------------ files


def _directories() -> list[Path]:
    """Return the directories that may hold compiled libraries: the user's, if it can be used, and the temporary one."""
    directory, reason = user_directory()
    return [*([] if reason else [directory]), *([] if _temporary.path is None else [_temporary.path])]


def _read(path: Path) -> bytes | None:
    """Return the content of the file ``path``, or None if it is missing, unreadable, or not to be trusted."""
    try:
        # another user could have put foreign machine code into the cache
        return None if foreign(path) else path.read_bytes()
    except OSError:
        return None


def _replace(path: Path, content: bytes) -> None:
    """Write a file atomically: other processes see either the old or the new content, never a part of it."""
    passing = path.with_name(f".symrot-{os.getpid()}_{os.urandom(4).hex()}")
    try:
        passing.write_bytes(content)
        passing.replace(path)
    finally:
        passing.unlink(missing_ok=True)


def _keep(name: str, content: bytes) -> Path:
    """Write ``content`` to the file ``name`` of the cache, and return its path.

    If that fails, the file is written to the temporary directory; if this fails too, CompilerError is raised.
    """
    if _temporary.path is None:
        directory, reason = user_directory()
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
        raise CompilerError(f"compiled kernels need space on a disk: {path.parent}: {error.strerror}") from error
    return path


def _text_name(key: str) -> str:
    return f"text-{_digest(key)}.text"


def _library_name(name: str, content: bytes) -> str:
    return f"{name}-{sha256(content).hexdigest()[:32]}{SUFFIX}"


def _sound_library(directory: Path, entry: str, name: str) -> Path | None:
    """Return the path of the library that the file ``entry`` names, or None if the library is missing or damaged."""
    pointer = _read(directory / entry)
    if pointer is None:
        return None
    library = pointer.decode("ascii", "replace").strip()
    if not OWN_FILE.match(library):
        return None
    # damaged: not matching the checksum in its name
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
    return _keep(library.name, content)  # the disk became full between the two writes
