"""The table of kernels: names and definitions, in the order in which they are printed."""

from collections.abc import Callable
from functools import cache

from symrot.errors import InputError
from symrot.kernels import dynamics, euler, inertia, quaternion, rodrigues, rotation_vector, torques
from symrot.kernels.definition import Definition
from symrot.kernels.jacobian import BY, jacobian_kernel

__all__ = ["definition", "is_kernel", "kernel_names"]

_GROUPS = (euler, quaternion, rotation_vector, rodrigues, dynamics, torques, inertia)


@cache
def _table() -> dict[str, Callable[[], Definition]]:
    return dict(item for group in _GROUPS for item in group.definitions())


def kernel_names() -> tuple[str, ...]:
    """Return the names of all kernels of the library, in the order in which they are printed."""
    return tuple(_table())


def is_kernel(name: object) -> bool:
    """Return whether ``name`` is the name of a library kernel; a suffix that begins with ``_by_`` is ignored."""
    # The name of a kernel with derivatives has the suffix "_by_" with an argument, which is not checked.
    return isinstance(name, str) and name.split(BY, maxsplit=1)[0] in _table()


@cache
def definition(name: str) -> Definition:
    """Return the definition of a kernel, or of one with derivatives, such as ``quaternion_dcm_by_q``; cached.

    Raises
    ------
    InputError
        If there is no kernel of this name.
    """
    base, *variables = name.split(BY)
    if variables and base in _table():
        return jacobian_kernel(definition(base), variables)
    if name not in _table():
        raise InputError(f"expected the name of a kernel, such as quaternion_dcm or euler_zxz_body_rates, got {name!r}")
    return _table()[name]()
