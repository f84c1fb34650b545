"""Writing of chunks by workers on the machine of the client, so that they need not send the chunks to the client.

The client is the process that runs a sweep and submits its chunks to workers. While it runs, the client lets the
workers write into its store. For this, the client creates an anonymous file (Linux memfd), which vanishes when the
client ends. The file contains the *mark* of the client, a text that no other client has. The client sends the workers
an *offer*: the path of this file under /proc, the mark, and a description of the store. A worker writes only if it
finds the mark in the file. Otherwise the client is on another machine or has ended, and the worker returns its chunk.
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

__all__ = ["Offer", "Written", "offered", "stored"]

BOOT = Path("/proc/sys/kernel/random/boot_id")  # of Linux: differs between machines


class Written(NamedTuple):
    """A range of trajectories, ``start`` to ``stop - 1``, whose chunk a worker has stored."""

    start: int
    stop: int


class Offer(NamedTuple):
    """What a worker needs to write chunks of a sweep into the store of the client, the process that runs the sweep.

    ``file`` is the path, under /proc, of the anonymous file that the client keeps open while it runs. ``mark`` is the
    text in this file, which no other client has.
    """

    file: str
    mark: str
    # device and inode number of the store's folder, which differ for another folder of the same name in a container
    folder: tuple[int, int]
    # class, path and header of the store, pickled
    store: bytes


def _machine() -> str:
    """Return a text that is the same for all processes on a running Linux machine; empty on other systems."""
    try:
        return BOOT.read_text(encoding="ascii").strip()
    except OSError:
        return ""


@contextmanager
def offered(store: Store) -> Iterator[Offer | None]:
    """Context manager: provide the :class:`Offer` with which workers on this machine may write into a store.

    It is None if they cannot, because the store is in memory or the system is not Linux.

    Use: ``with offered(store) as offer: ..``. The offer ends with the block, or with the process.
    """
    path, machine = getattr(store, "path", None), _machine()
    if path is None or not machine or not hasattr(os, "memfd_create"):
        yield None
        return
    mark = f"{machine} {uuid4().hex}"
    # no file on a disk, which would stay there if the client were killed
    with os.fdopen(os.memfd_create("symrot"), "wb", buffering=0) as stream:
        stream.write(mark.encode())
        file = f"/proc/{os.getpid()}/fd/{stream.fileno()}"
        yield Offer(file, mark, _folder(path), pickle.dumps((type(store), path.resolve(), store.header)))


def _folder(path: Path) -> tuple[int, int]:
    """Return the numbers of the device and of the inode of a folder."""
    state = path.stat()
    return state.st_dev, state.st_ino


@lru_cache(maxsize=1)
def _opened(store: bytes, mark: str) -> Any:
    """Return the store that the field ``store`` of an :class:`Offer` describes, or None if its folder is missing.

    The result is cached until this function is called with the field ``mark`` of another client's offer. A client is a
    process that runs a sweep.
    """
    kind, path, header = pickle.loads(store)
    return kind(path, header) if path.is_dir() else None


def _is_valid(offer: Offer) -> bool:
    """Return whether the client that sent ``offer`` to this worker still runs, and on the same machine as the worker.

    The client is the process that runs the sweep.
    """
    try:
        return offer.mark.startswith(f"{_machine()} ") and Path(offer.file).read_bytes() == offer.mark.encode()
    except OSError:
        return False


def stored(chunk: Chunk, offer: Offer) -> Chunk | Written:
    """Write a chunk into the store of the client, and return its range of trajectories (:class:`Written`).

    The client is the process that runs the sweep. Its ``offer`` describes the store, into which workers on the same
    machine may write. Return the chunk itself if this worker cannot write: the client then writes it, or says why it
    cannot.
    """
    try:
        store = _opened(offer.store, offer.mark) if _is_valid(offer) else None
        if store is None or _folder(store.path) != offer.folder:
            return chunk
        store.write(chunk)
    except Exception:  # a full disk, a folder or package that is missing here
        return chunk
    return Written(chunk.start, chunk.stop)
