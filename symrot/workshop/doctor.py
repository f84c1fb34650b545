"""Whether this installation can do its work: versions, extras, compiler, cache, and a kernel compiled and run."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path
from typing import Any

from symrot import __version__
from symrot.build import cache as library
from symrot.errors import SymrotError
from symrot.report.layout import fields

__all__ = ["clear_cache", "facts", "lines"]

NEEDED = ("sympy", "numpy", "scipy")
EXTRAS = {
    "plot": ("matplotlib",), "bench": ("heyoka",), "test": ("pytest", "pytest-xdist", "hypothesis"),
    "dev": ("ruff", "mypy"),
}  # fmt: skip
SECONDS_TO_ANSWER = 10
TINY = "double symrot_check(double x) { return 3.0*x + 0.5; }\n"


def _version(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _first_line(command: tuple[str, ...]) -> str:
    """Return what a compiler says of its version."""
    import subprocess

    try:
        done = subprocess.run([*command, "--version"], capture_output=True, timeout=SECONDS_TO_ANSWER, check=False)
    except (OSError, subprocess.TimeoutExpired) as reason:
        return f"it says no version: {reason}"
    said = done.stdout.decode("utf-8", "replace").strip()
    return said.splitlines()[0] if said else "it says no version"


@contextmanager
def _empty_cache() -> Iterator[None]:
    """Let the library compile into a folder of its own, so that the compiler is really run."""
    from tempfile import TemporaryDirectory

    before = os.environ.get("SYMROT_CACHE")
    with TemporaryDirectory(prefix="symrot-") as directory:
        os.environ["SYMROT_CACHE"] = directory
        try:
            yield
        finally:
            if before is None:
                del os.environ["SYMROT_CACHE"]
            else:
                os.environ["SYMROT_CACHE"] = before


def _compiled_and_run() -> str:
    """Return an empty text, or why a tiny kernel could not be compiled and run."""
    import ctypes

    try:
        with _empty_cache():
            function = ctypes.CDLL(str(library.build(TINY, "check"))).symrot_check
            function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double]
            result = function(0.5)
    except (SymrotError, OSError) as reason:
        return str(reason)
    return "" if result == 2.0 else f"the compiled 3 x + 1/2 at x = 1/2 is {result}, not 2"


def _cached(directory: Path) -> tuple[int, int]:
    """Return the number of files in the cache and their bytes."""
    sizes = [entry.stat().st_size for entry in os.scandir(directory) if entry.is_file(follow_symlinks=False)]
    return len(sizes), sum(sizes)


def facts() -> dict[str, Any]:
    """Return the state of this installation as data for JSON; ``problems`` are what keeps symrot from working well."""
    cache = library.cache()
    count, size = _cached(cache.directory)
    versions = {name: _version(name) for name in NEEDED}
    problems = [f"{name} is not installed" for name, version in versions.items() if version is None]
    compiler: dict[str, Any] | None = None
    try:
        tool = library.compiler()
        compiler = {"command": " ".join(tool.command), "version": _first_line(tool.command)}
        problems += [reason] if (reason := _compiled_and_run()) else []
    except SymrotError as reason:
        problems.append(str(reason))
    problems += [f"the cache is not kept: {cache.reason}"] if cache.reason else []
    return {
        "symrot": __version__,
        "python": {"version": sys.version.split()[0], "executable": sys.executable},
        "platform": sys.platform,
        "needed": versions,
        "extras": {extra: {name: _version(name) for name in names} for extra, names in EXTRAS.items()},
        "compiler": compiler,
        "cache": {"directory": str(cache.directory), "files": count, "bytes": size, "kept": not cache.reason},
        "problems": problems,
    }


def _packages(versions: dict[str, str | None]) -> str:
    return ", ".join(f"{name} {version or 'missing'}" for name, version in versions.items())


def _spoken_cache(found: dict[str, Any]) -> str:
    kept = "" if found["kept"] else ", for this process only"
    return f"{found['directory']}: {found['files']} files, {found['bytes'] / 1e6:.2g} MB{kept}"


def _spoken_compiler(found: dict[str, str] | None) -> str:
    return f"{found['command']}: {found['version']}" if found else "none; scenes are stepped by SciPy, much slower"


SPOKEN: tuple[tuple[str, Callable[[dict[str, Any]], str]], ...] = (
    ("symrot", lambda found: str(found["symrot"])),
    ("python", lambda found: f"{found['python']['version']}, {found['python']['executable']}"),
    ("needed", lambda found: _packages(found["needed"])),
    ("compiler", lambda found: _spoken_compiler(found["compiler"])),
    ("cache", lambda found: _spoken_cache(found["cache"])),
)


def lines(found: dict[str, Any]) -> list[str]:
    """Return the lines for people that say what :func:`facts` says."""
    rows = [(name, spoken(found)) for name, spoken in SPOKEN]
    for extra, versions in found["extras"].items():
        hint = "" if all(versions.values()) else f" (pip install 'symrot[{extra}]')"
        rows.append((f"[{extra}]", f"{_packages(versions)}{hint}"))
    verdicts = found["problems"] or ["all is well: a kernel was compiled, loaded and run"]
    return fields(rows + [("check", verdict) for verdict in verdicts])


def clear_cache() -> int:
    """Remove every file of ours from the cache and return how many there were."""
    return len(library.clear())
