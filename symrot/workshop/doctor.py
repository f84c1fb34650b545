"""The check of this installation: versions, extras, compiler, cache, and whether a small kernel compiles and runs."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import metadata
from pathlib import Path
from typing import TypedDict

from symrot import __version__
from symrot.build import cache as build_cache
from symrot.errors import SymrotError
from symrot.report.layout import fields

__all__ = ["clear_cache", "facts", "lines"]

NEEDED = ("sympy", "numpy", "scipy")
EXTRAS = {
    "plot": ("matplotlib",), "film": ("imageio-ffmpeg",), "frames": ("pandas", "xarray"), "mesh": ("trimesh",),
    "sweep": ("zarr", "pyarrow", "tqdm"), "cluster": ("dask", "distributed"), "completion": ("argcomplete",),
    "jax": ("jax",), "bench": ("heyoka",), "test": ("pytest", "pytest-xdist", "hypothesis"), "dev": ("ruff", "mypy"),
}  # fmt: skip
"""The packages that each extra of pyproject.toml adds."""
SECONDS_TO_ANSWER = 10
TINY = "double symrot_check(double x) { return 3.0*x + 0.5; }\n"


def _version(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _first_line(command: tuple[str, ...]) -> str:
    """Return the first line that ``command --version`` prints, for a compiler; or "unknown version" and the reason."""
    import subprocess

    try:
        done = subprocess.run([*command, "--version"], capture_output=True, timeout=SECONDS_TO_ANSWER, check=False)
    except (OSError, subprocess.TimeoutExpired) as reason:
        return f"unknown version: {reason}"
    output = done.stdout.decode("utf-8", "replace").strip()
    return output.splitlines()[0] if output else "unknown version"


@contextmanager
def _empty_cache() -> Iterator[None]:
    """Run a ``with`` block with an empty cache of compiled libraries, so that the compiler really runs."""
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
    """Compile and run a tiny kernel as a test; return the reason if that fails, else an empty text."""
    import ctypes

    try:
        with _empty_cache():
            function = ctypes.CDLL(str(build_cache.build(TINY, "check"))).symrot_check
            function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double]
            result = function(0.5)
    except (SymrotError, OSError) as reason:
        return str(reason)
    return "" if result == 2.0 else f"the compiled 3 x + 1/2 at x = 1/2 is {result}, not 2"


def _cached(directory: Path) -> tuple[int, int]:
    """Return the number of files in the cache and their total size in bytes."""
    sizes = [entry.stat().st_size for entry in os.scandir(directory) if entry.is_file(follow_symlinks=False)]
    return len(sizes), sum(sizes)


class CompilerRecord(TypedDict):
    """One C compiler: its command, and the first line that it prints about its version."""

    command: str
    version: str


class CacheRecord(TypedDict):
    """The cache directory of this installation; ``persistent`` says whether it lasts longer than this process."""

    directory: str
    files: int
    bytes: int
    persistent: bool


class PythonRecord(TypedDict):
    """The Python interpreter of this installation: version and path."""

    version: str
    executable: str


class DoctorReport(TypedDict):
    """The state of this installation: versions, extras, compiler, cache; the version of a missing package is None."""

    symrot: str
    python: PythonRecord
    platform: str
    needed: dict[str, str | None]
    extras: dict[str, dict[str, str | None]]
    compiler: CompilerRecord | None
    cache: CacheRecord
    problems: list[str]


def facts() -> DoctorReport:
    """Return the state of this installation as data for JSON: versions, extras, compiler, cache, problems."""
    cache = build_cache.cache()
    count, size = _cached(cache.directory)
    versions = {name: _version(name) for name in NEEDED}
    problems = [f"{name} is not installed" for name, version in versions.items() if version is None]
    compiler: CompilerRecord | None = None
    try:
        tool = build_cache.compiler()
        compiler = {"command": " ".join(tool.command), "version": _first_line(tool.command)}
        problems += [reason] if (reason := _compiled_and_run()) else []
    except SymrotError as reason:
        problems.append(str(reason))
    problems += [f"the cache lasts for this process only: {cache.reason}"] if cache.reason else []
    return {
        "symrot": __version__,
        "python": {"version": sys.version.split()[0], "executable": sys.executable},
        "platform": sys.platform,
        "needed": versions,
        "extras": {extra: {name: _version(name) for name in names} for extra, names in EXTRAS.items()},
        "compiler": compiler,
        "cache": {"directory": str(cache.directory), "files": count, "bytes": size, "persistent": not cache.reason},
        "problems": problems,
    }


def _packages(versions: dict[str, str | None]) -> str:
    return ", ".join(f"{name} {version or 'missing'}" for name, version in versions.items())


def _cache_text(cache: CacheRecord) -> str:
    remark = "" if cache["persistent"] else ", for this process only"
    return f"{cache['directory']}: {cache['files']} files, {cache['bytes'] / 1e6:.2g} MB{remark}"


def _compiler_text(compiler: CompilerRecord | None) -> str:
    return (
        f"{compiler['command']}: {compiler['version']}"
        if compiler
        else "none; SciPy integrates scenes, much more slowly"
    )


ROWS: tuple[tuple[str, Callable[[DoctorReport], str]], ...] = (  # label -> text of the facts
    ("symrot", lambda report: str(report["symrot"])),
    ("python", lambda report: f"{report['python']['version']}, {report['python']['executable']}"),
    ("needed", lambda report: _packages(report["needed"])),
    ("compiler", lambda report: _compiler_text(report["compiler"])),
    ("cache", lambda report: _cache_text(report["cache"])),
)


def lines(report: DoctorReport) -> list[str]:
    """Return the lines that `symrot doctor` prints; ``report`` is the data of :func:`facts`."""
    rows = [(name, text(report)) for name, text in ROWS]
    for extra, versions in report["extras"].items():
        hint = "" if all(versions.values()) else f" (pip install 'symrot[{extra}]')"
        rows.append((f"[{extra}]", f"{_packages(versions)}{hint}"))
    verdicts = report["problems"] or ["all is well: a kernel was compiled, loaded and run"]
    return fields(rows + [("check", verdict) for verdict in verdicts])


def clear_cache() -> int:
    """Remove every file that symrot wrote into the cache, and return the number of files removed."""
    return len(build_cache.clear())
