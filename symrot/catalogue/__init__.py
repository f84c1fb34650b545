"""The catalogue of derivations, in reading order: a folder for each chapter, a file for each derivation.

Importing this package derives nothing and does not import SymPy; :func:`derivation` does both on demand.
"""

from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING

from symrot.errors import InputError, nearest

if TYPE_CHECKING:
    from symrot.proof.derivation import Derivation

__all__ = ["READING_ORDER", "derivation", "module_of", "names", "require_name"]

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


def names() -> tuple[str, ...]:
    """Return the names of all derivations, such as ``poinsot``, in reading order."""
    return tuple(name for part in READING_ORDER.values() for name in part)


def module_of(name: str) -> str:
    """Return the name of a derivation's module, such as ``symrot.catalogue.free_bodies.poinsot`` for ``poinsot``."""
    chapter = next(chapter for chapter, members in READING_ORDER.items() if name in members)
    return f"{__name__}.{chapter.lower().replace(' ', '_')}.{name}"


def require_name(name: str) -> None:
    """Raise InputError if no derivation is called ``name``; the message has the most similar name, or else all."""
    if name not in names():
        hint = nearest(name, names())
        known = "" if hint else f", one of {', '.join(names())}"
        after = f" ({hint} `symrot derive` lists all)" if hint else ""
        raise InputError(f"expected the name of a derivation{known}, got {str(name)[:60]!r}{after}")


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
    require_name(name)
    module = module_of(name)
    page: Derivation = import_module(module).derive()
    page.file = f"{module.replace('.', '/')}.py"
    return page
