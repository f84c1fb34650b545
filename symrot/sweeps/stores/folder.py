"""The folder with the results of a sweep, which one process creates and several processes may fill."""

import os
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from uuid import uuid4

from symrot.errors import InputError
from symrot.sweeps.layout import Header, continued

__all__ = ["create", "require_own"]


def create(path: Path, fill: Callable[[Path], None]) -> bool:
    """Create the folder ``path`` with the content that ``fill(folder)`` writes into an empty folder.

    The folder gets its name when the content is complete. Return False, and change nothing, if another process has
    created a folder with content there in the meantime.
    """
    part = path.with_name(f".{path.name}.{uuid4().hex}.part")
    try:
        part.mkdir()
        fill(part)
        try:
            os.replace(part, path)  # noqa: PTH105 - replaces an empty folder, but no other one
        except OSError:
            if not path.exists():
                raise
            return False
        return True
    finally:
        shutil.rmtree(part, ignore_errors=True)


def require_own(header: Header, path: Path, description: Callable[[], Mapping[str, Any]]) -> None:
    """Raise InputError unless the folder ``path`` still has the results of the sweep that ``header`` describes.

    The number of trajectories in a chunk must be the same too. ``description`` reads the folder and returns the
    settings of its sweep and this number, as for :func:`symrot.sweeps.layout.continued`.
    """
    # somebody may have removed the folder and begun another sweep there while this one runs
    rows = continued(header, path, description).rows
    if rows != header.rows:
        raise InputError(
            f"{path}: expected the results of this sweep in chunks of {header.rows} trajectories, got chunks of "
            f"{rows}, because another run has begun the sweep anew at this path; choose another path"
        )
