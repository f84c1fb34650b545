"""Writing of chunks by workers on the machine of the client, which then need not send them.

While a client runs, it holds a lock on a file beside the results. A worker writes only if it is on the same machine,
this file has the mark of its own client, and the lock is held. Otherwise the client is remote, dead, or another one,
and the worker returns its chunk.
"""

import os
import pickle
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple
from uuid import uuid4

from symrot.sweeps.chunk import Chunk
from symrot.sweeps.layout import Store

try:
    import fcntl
except ImportError:  # Windows has no such locks
    fcntl = None  # type: ignore[assignment]

__all__ = ["Offer", "Written", "offered", "stored"]

BOOT = Path("/proc/sys/kernel/random/boot_id")  # of Linux: differs between machines


class Written(NamedTuple):
    """A range of trajectories, ``start`` to ``stop - 1``, whose chunk a worker has stored."""

    start: int
    stop: int


class Offer(NamedTuple):
    """What a worker needs to write: the file with the lock, the client's mark in it, and a store to be opened."""

    lock: str
    mark: str
    # class, path and header
    store: bytes


def _machine() -> str:
    """Return a text that is the same for all processes on a running machine; empty if there is none."""
    try:
        return BOOT.read_text(encoding="ascii").strip()
    except OSError:
        return ""


@contextmanager
def offered(store: Store) -> Iterator[Offer | None]:
    """Provide the offer to workers to write into a store; None if they cannot.

    Use: ``with offered(store) as offer: ..``. The offer ends with the block, or with the process.
    """
    path = getattr(store, "path", None)
    machine = _machine()
    if path is None or fcntl is None or not machine:
        yield None
        return
    path = path.resolve()
    lock, mark = path.with_name(f".{path.name}.lock"), f"{machine} {uuid4().hex}"
    try:
        stream = os.open(lock, os.O_RDWR | os.O_CREAT, 0o600)
    except OSError:  # a folder in which nobody may write new files
        yield None
        return
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:  # another client runs the same sweep
        os.close(stream)
        yield None
        return
    try:
        os.ftruncate(stream, 0)
        os.write(stream, mark.encode())
        yield Offer(str(lock), mark, pickle.dumps((type(store), path, store.header)))
    finally:
        lock.unlink(missing_ok=True)
        os.close(stream)


@lru_cache(maxsize=1)
def _opened(store: bytes, mark: str) -> Any:
    """Return the store of an offer; each client (``mark``) has its own."""
    kind, path, header = pickle.loads(store)
    return kind(path, header) if path.is_dir() else None


def _stands(offer: Offer) -> bool:
    """Return whether the client that made an offer runs on this machine."""
    if fcntl is None or not offer.mark.startswith(f"{_machine()} "):
        return False
    try:
        with Path(offer.lock).open("rb") as stream:
            if stream.read() != offer.mark.encode():
                return False
            try:
                fcntl.flock(stream, fcntl.LOCK_SH | fcntl.LOCK_NB)
            except BlockingIOError:
                return True
    except OSError:
        pass
    return False


def stored(chunk: Chunk, offer: Offer) -> Chunk | Written:
    """Write a chunk into the store of an offer; return the chunk itself if that is not possible.

    The client then writes the chunk, or says why it cannot.
    """
    try:
        store = _opened(offer.store, offer.mark) if _stands(offer) else None
        if store is None or not store.path.is_dir():
            return chunk
        store.write(chunk)
    except Exception:  # a full disk, a package that is missing here
        return chunk
    return Written(chunk.start, chunk.stop)
