"""The catalogue of derivations, in reading order: a folder for each chapter, a file for each derivation.

Importing this package derives nothing and does not import SymPy; :func:`derivation` does both on demand.
"""

from collections.abc import Callable
from difflib import unified_diff
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from symrot.errors import InputError
from symrot.files.reading import refuse_special

if TYPE_CHECKING:
    from symrot.proof.derivation import Derivation

__all__ = ["READING_ORDER", "check", "derivation", "derive_all", "module_of", "names", "pages", "write_pages"]

READING_ORDER: dict[str, tuple[str, ...]] = {
    "Attitude": (
        "rotation_matrices",
        "axis_and_angle",
        "composition",
        "euler_parameters",
    ),
    "Angular velocity": (
        "spin_tensor",
        "euler_body_rates",
        "euler_singularities",
        "quaternion_rates",
        "rotation_vector",
        "rodrigues",
        "relative_motion",
    ),
    "Inertia": (
        "angular_momentum",
        "kinetic_energy",
        "parallel_axis",
        "tensor_rotation",
        "standard_solids",
    ),
    "Equations of motion": (
        "euler_equations",
        "lagrange_and_euler",
        "work_and_power",
        "impulse_and_momentum",
        "attitude_not_needed",
        "planar_motion",
    ),
    "Free bodies": (
        "free_body_invariants",
        "spherical_body",
        "symmetric_spin",
        "symmetric_top",
        "intermediate_axis",
        "poinsot",
        "free_asymmetric_body",
    ),
    "Bodies under torques": (
        "heavy_top_invariants",
        "heavy_top",
        "gyroscopic_wheel",
        "gyrostat_invariants",
        "gravity_gradient",
    ),
    "Exact motions": (
        "elliptic_functions",
        "free_body_attitude",
        "free_body_separatrix",
        "heavy_top_motion",
        "pendulum",
        "sleeping_top",
        "symmetric_gyrostat",
        "driven_rotation",
    ),
    "Constraints": (
        "rolling",
        "gear_trains",
        "planar_linkages",
    ),
}
"""Chapter -> names of its derivations; each is the name of a module in the chapter's folder."""

SUFFIXES = {"latex": ".tex", "html": ".html"}
"""Format of a page, other than Markdown -> suffix of its file."""


def names() -> tuple[str, ...]:
    """Return the names of all derivations, in reading order."""
    return tuple(name for part in READING_ORDER.values() for name in part)


def module_of(name: str) -> str:
    """Return the name of a derivation's module, such as ``symrot.catalogue.free_bodies.poinsot`` for ``poinsot``."""
    chapter = next(chapter for chapter, members in READING_ORDER.items() if name in members)
    return f"{__name__}.{chapter.lower().replace(' ', '_')}.{name}"


@cache
def derivation(name: str) -> "Derivation":
    """Return one derivation of the catalogue, in which every step is proven; it is derived once per process.

    Parameters
    ----------
    name : str
        A name that ``symrot derive`` lists, such as ``"intermediate_axis"``.

    Returns
    -------
    Derivation
        ``.steps`` are the proven steps; ``.markdown()``, ``.latex()`` and ``.html()`` print the page.

    Raises
    ------
    InputError
        If there is no derivation of that name.
    ProofError
        If a step does not hold.

    Notes
    -----
    Convention: :mod:`symrot.conventions`. Source: each page cites its own.

    Examples
    --------
    >>> import symrot
    >>> len(symrot.derivation("intermediate_axis").steps)
    6
    """
    if name not in names():
        raise InputError(f"expected the name of a derivation, one of {', '.join(names())}; got {name!r}")
    module = module_of(name)
    page: Derivation = import_module(module).derive()
    page.file = f"{module.replace('.', '/')}.py"
    return page


Say = Callable[[str], object]
"""Hears what is being derived."""


def _quiet(text: str) -> None:
    """Ignore a message about progress; this is the default for the parameter ``say``."""


def pages(say: Say = _quiet) -> dict[str, str]:
    """Return a map from file name to text of the printed pages of all derivations.

    The table of contents (``README.md``) comes first.
    """
    derived = {}
    for name in names():
        say(f"deriving {name} ..")
        derived[name] = derivation(name)
    lines = [
        "# Derivations",
        "",
        "Every formula that symrot computes with, from first principles, in reading order. Each step was proven when",
        "its page was printed: the exact normal form of left minus right is zero.",
    ]
    for part, members in READING_ORDER.items():
        lines += ["", f"## {part}", ""]
        lines += [f"- [{derived[name].title}]({name}.md), {len(derived[name].steps)} steps" for name in members]
    lines += ["", "Printed by `symrot derive --all`; do not edit.", ""]
    return {"README.md": "\n".join(lines)} | {f"{name}.md": page.markdown() for name, page in derived.items()}


def write_pages(directory: Path | str, form: str) -> list[Path]:
    """Write every derivation as LaTeX or HTML into a directory, one file each, and return the paths of the files.

    Parameters
    ----------
    directory : Path or str
        The directory, which is created if it does not exist.
    form : str
        ``"latex"`` or ``"html"``.

    Raises
    ------
    InputError
        For an unknown format.
    """
    if form not in SUFFIXES:
        raise InputError(f"form: expected {' or '.join(SUFFIXES)}, got {form!r}")
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    written = []
    for name in names():
        path = directory / f"{name}{SUFFIXES[form]}"
        path.write_bytes(getattr(derivation(name), form)().encode())
        written.append(path)
    return written


def derive_all(directory: Path | str, say: Say = _quiet) -> list[Path]:
    """Print every page into a directory and return the paths of the files that changed.

    Pages of derivations that are no longer in the catalogue are deleted; other files are not touched.
    """
    directory = Path(directory)
    directory.mkdir(parents=True, exist_ok=True)
    changed = []
    printed = pages(say)
    for name, text in printed.items():
        path = directory / name
        if not path.is_file() or path.read_bytes() != text.encode():
            if path.exists():
                refuse_special(path)  # a pipe would wait for a reader
            path.write_bytes(text.encode())
            changed.append(path)
    for path in _left_over(directory, printed):
        path.unlink()
        changed.append(path)
    return changed


def check(directory: Path | str, say: Say = _quiet) -> list[tuple[Path, str]]:
    """Return a unified diff for each page in a directory that differs from the newly printed page.

    The list is empty if all pages are up to date.
    """
    directory = Path(directory)
    printed = pages(say)
    stale = []
    for path in [*(directory / name for name in printed), *_left_over(directory, printed)]:
        old = path.read_bytes().decode(errors="replace") if path.is_file() else ""
        new = printed.get(path.name, "")
        if old != new:
            lines = unified_diff(
                old.splitlines(keepends=True), new.splitlines(keepends=True), f"{path} (on disk)", f"{path} (derived)"
            )
            stale.append((path, "".join(lines)))
    return stale


def _left_over(directory: Path, printed: dict[str, str]) -> list[Path]:
    """Return the pages in a directory that symrot printed earlier and whose derivation no longer exists."""
    others = (path for path in sorted(directory.glob("*.md")) if path.name not in printed and path.is_file())
    return [path for path in others if _mark(path.stem).encode() in path.read_bytes()]


def _mark(name: str) -> str:
    return f"printed by `symrot derive {name}`; do not edit."
