"""Computation of the chunks of a sweep (many motions of a scene with varied values) by the workers of a Dask cluster.

Workers on this machine write their chunks into the file of the sweep; other workers send them to this process, which
writes.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from typing import Any

from symrot.errors import InputError, PropagationError
from symrot.formula.exact_numbers import show
from symrot.sweeps.chunk import Chunk, Job
from symrot.sweeps.layout import Store
from symrot.sweeps.optional import optional
from symrot.sweeps.processes import IN_FLIGHT, Range, compute_packed, packed
from symrot.sweeps.stores.shared_store import Offer, Written, offered, stored

__all__ = ["run_on_cluster"]

SECONDS = 30  # longest wait for the scheduler and for its first worker
RETRIES = 3


def _address(scheduler: object) -> str:
    """Return the address of a scheduler from its text, or from a client or a cluster of Dask."""
    owner = getattr(scheduler, "scheduler", None)
    address = scheduler if isinstance(scheduler, str) else getattr(owner, "address", None)
    if not isinstance(address, str):
        raise InputError(
            "--scheduler: expected the address of a Dask scheduler, such as tcp://host:8786, or a client or cluster of "
            f"Dask, got {show(scheduler)}"
        )
    return address


def _client(scheduler: object) -> Any:
    make, address = optional("distributed", "--scheduler", "cluster").Client, _address(scheduler)
    try:
        # checked here, because a client of a wrong address would wait for a minute when the process ends
        if not address.startswith("inproc:"):
            optional("distributed.comm", "--scheduler", "cluster").get_address_host_port(address)
        client = make(address, timeout=SECONDS, set_as_default=False)
    except (OSError, ValueError, TypeError) as reason:
        raise InputError(
            f"--scheduler: expected the address of a Dask scheduler that answers within {SECONDS} s, such as "
            f"tcp://host:8786, got {address!r} ({str(reason).partition(chr(10))[0][:200]})"
        ) from None
    try:
        client.wait_for_workers(1, timeout=SECONDS)
    except (TimeoutError, OSError):  # no worker came, or the scheduler went away
        client.close()
        raise InputError(
            f"--scheduler: expected a Dask cluster with a worker, but {address} has none after {SECONDS} s"
        ) from None
    return client


def compute_and_store(text: bytes, start: int, stop: int, offer: Offer | None) -> Chunk | Written:
    """Compute the trajectories ``start`` to ``stop - 1``; return their chunk, or its range if this worker stored it.

    ``text`` is the job from :func:`packed`. ``offer`` is what a worker on the machine of the sweep needs to write into
    the file of the sweep; if it is None, the chunk is returned.
    """
    chunk = compute_packed(text, start, stop)
    return chunk if offer is None else stored(chunk, offer)


def run_on_cluster(job: Job, ranges: Sequence[Range], scheduler: object, store: Store) -> Iterator[Chunk | Written]:
    """Yield the chunks of a job, as each is complete, computed by the workers of a Dask cluster.

    Parameters
    ----------
    job : Job
        The sweep.
    ranges : sequence of (start, stop)
        The trajectories of each chunk.
    scheduler : str, Client or cluster of Dask
        The address of the scheduler, or an object that has it.
    store : Store
        The store of the sweep. If a worker on this machine has written a chunk into the store itself, the chunk's range
        of trajectories (:class:`Written`) is yielded instead of the chunk.

    Raises
    ------
    InputError
        If Dask is not installed, or if no scheduler with a worker answers at the address.
    PropagationError
        If the cluster fails to compute a chunk.
    """
    client = _client(scheduler)
    in_order = optional("distributed", "--scheduler", "cluster").as_completed
    with ExitStack() as stack:
        stack.callback(client.close)
        offer = stack.enter_context(offered(store))
        text, missing = packed(job), deque(ranges)
        threads = sum(client.nthreads().values()) or 1

        def submit() -> Any:
            # if a worker is lost, Dask computes its chunks on another one
            return client.submit(compute_and_store, text, *missing.popleft(), offer, pure=False, retries=RETRIES)

        # at most two chunks for each thread of the cluster at a time
        running = in_order([submit() for _ in range(min(len(missing), IN_FLIGHT * threads))], loop=client.loop)
        for future in running:
            try:
                chunk: Chunk | Written = future.result()
            except Exception as reason:
                raise PropagationError(
                    f"the cluster did not compute a chunk ({type(reason).__name__}: "
                    f"{str(reason).partition(chr(10))[0][:300]}); run the sweep again to go on"
                ) from None
            future.release()
            if missing:
                running.add(submit())
            yield chunk
