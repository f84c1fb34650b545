"""Many motions of one closed form in one call of C: constants that vary are arrays, shared constants are passed once.

Each motion is computed by the same compiled functions and from the same numbers as a single motion, so that all bits of
the results are equal.
"""

import ctypes
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from symrot.build.address import address
from symrot.closed_form.build import Floats, load
from symrot.closed_form.motion import functions

__all__ = ["Batch", "evaluate"]

AT_ONCE = 1024  # motions per call of C, about 10 ms, after which Python can react to an interrupt


class Batch(NamedTuple):
    """Arguments for the C function `prepare` of the closed form ``name``, for n motions at once."""

    name: str
    # shape (k,) if all motions share it, or (n, k); for axial, all members of the C struct `axial`; for spin_up, the 20
    # numbers of each motion, then the axis and the results of symrot.closed_form.spin_up.compiled.limits
    arguments: tuple[Floats | None, ...]

    def of(self, chosen: NDArray[np.bool_]) -> "Batch":
        """Return the batch of the motions i for which ``chosen[i]`` is true."""
        own = (values[chosen] if values is not None and values.ndim == 2 else values for values in self.arguments)
        return Batch(self.name, tuple(own))


class _Motions(ctypes.Structure):
    """The C struct ``symrot_many_motions`` of many.c: constants and times of many motions, arrays for the samples."""

    _fields_ = (
        ("prepare", ctypes.c_void_p), ("at", ctypes.c_void_p), ("record", ctypes.c_void_p), ("table", ctypes.c_void_p),
        ("arguments", ctypes.c_ssize_t), ("constants", ctypes.c_void_p * 6), ("strides", ctypes.c_ssize_t * 6),
        ("times", ctypes.c_void_p), ("times_stride", ctypes.c_ssize_t), ("samples", ctypes.c_ssize_t),
        ("omega", ctypes.c_void_p), ("quaternion", ctypes.c_void_p),
    )  # fmt: skip


def _place(function: Any) -> int:
    return int(ctypes.cast(function, ctypes.c_void_p).value or 0)


def evaluate(batch: Batch, times: Floats, omega: Floats, quaternion: Floats | None, workers: int = 1) -> list[int]:
    """Write the samples of n motions into arrays, and return the indices of motions with invalid samples, in order.

    Parameters
    ----------
    batch : Batch
        The motions to evaluate.
    times : array, shape (m,) or (n, m)
        Times from the start, s.
    omega, quaternion : array, shape (n, m, 3); array, shape (n, m, 4), or None
        The arrays to fill, contiguous for each motion. If ``quaternion`` is None, no attitudes are computed.
    workers : int
        Number of threads; each computes some of the motions.
    """
    # motions that are not valid exceed the range of the batch; the caller computes them one by one
    run, prepare, at, record, table = _linked(batch)
    arguments = [None if values is None else np.ascontiguousarray(values) for values in batch.arguments]
    times = np.ascontiguousarray(times)
    n, samples = omega.shape[:2]
    if not samples:
        return []

    def share(first: int, last: int, stop: Any = bool) -> list[int]:
        room, refused = record(), []
        polynomials = np.empty(table) if table else None
        motions = _Motions(
            prepare, at, ctypes.addressof(room), address(polynomials), len(arguments), times=address(times),
            times_stride=samples if times.ndim == 2 else 0, samples=samples, omega=address(omega),
            quaternion=address(quaternion),
        )  # fmt: skip
        for k, values in enumerate(arguments):
            if values is not None:
                motions.constants[k] = address(values)
                motions.strides[k] = values.shape[1] if values.ndim == 2 else 0
        while first < last and not stop():
            end = min(first + AT_ONCE, last)
            first = run(ctypes.addressof(motions), first, end)
            if first < end:
                # its numbers exceed the range of double-double arithmetic
                refused.append(first)
                first += 1
        return refused

    odd = _shared(share, n, min(workers, max(1, n // AT_ONCE)))
    values = omega if quaternion is None else quaternion
    # NaN if a motion overflows at one of its times; evaluated alone, it raises the error
    squares = np.einsum("nmk,nmk->n", values, values)
    return sorted({*odd, *np.flatnonzero(np.isnan(squares)).tolist()})


class _Linked(NamedTuple):
    """The compiled loop over many motions, with the addresses of the C functions of one closed form."""

    run: Any  # calls the functions at the addresses prepare and at for each motion
    prepare: int  # 0 if there is no such function
    at: int
    record: Any  # type of the C array with the constants of a motion
    table: int  # doubles; 0 if there is no table


def _loop(name: str, library_name: str = "many") -> Any:
    (library,) = load(library_name)
    run, size = getattr(library, name), ctypes.c_ssize_t
    run.argtypes, run.restype = (ctypes.c_void_p, size, size), size
    return run


def _linked(batch: Batch) -> _Linked:
    if batch.name == "axial":
        from symrot.closed_form.axial import compiled as axial_compiled

        at, record = axial_compiled.functions()
        return _Linked(_loop("symrot_many_axial"), 0, _place(at), record, 0)
    if batch.name == "spin_up":
        from symrot.closed_form.spin_up import compiled as spin_up_compiled

        spin_up = spin_up_compiled.functions()
        places = _place(spin_up.prepare), _place(spin_up.evaluate)
        together = load("spin_up_many")[0].symrot_many_spin_ups_at_once()
        room = ctypes.c_double * (ctypes.sizeof(spin_up.record) // 8 * together)
        return _Linked(_loop("symrot_many_spin_ups", "spin_up_many"), *places, room, spin_up_compiled.TABLE * together)
    prepare, at, record = functions(batch.name, len(batch.arguments))
    return _Linked(_loop("symrot_many"), _place(prepare), _place(at), record, 0)


def _shared(share: Any, n: int, workers: int) -> Sequence[int]:
    if workers <= 1:
        statuses: list[int] = share(0, n)
        return statuses
    from concurrent.futures import ThreadPoolExecutor
    from threading import Event

    interrupted, edges = Event(), [n * k // workers for k in range(workers + 1)]
    with ThreadPoolExecutor(workers) as pool:
        try:
            jobs = [pool.submit(share, edges[k], edges[k + 1], interrupted.is_set) for k in range(workers)]
            return [i for job in jobs for i in job.result()]
        finally:
            interrupted.set()
