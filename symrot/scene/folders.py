"""The folders from which a scene may read files: its own, and others that the user allows. Standard library only."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from symrot.scene.reader import fail

__all__ = ["Folders", "listed_folders"]


class Folders(NamedTuple):
    """The folder of a scene, and further folders that the user allows; a scene may name only files in or below them."""

    folder: Path = Path()
    others: str | Path | Sequence[str | Path] = ()

    def file(self, name: str, where: str, what: str) -> Path:
        """Return the path of a file that a scene names, existing or not.

        Raise InputError if the path is outside the allowed folders, or if the name is empty or has a backslash.

        Parameters
        ----------
        name : str
            The name in the scene, relative to the scene's folder.
        where : str
            Place of the name, for error messages.
        what : str
            The kind of file, such as ``"a CSV file"``.
        """
        others = listed_folders(self.others)
        if not name.strip() or "\\" in name:
            fail(where, f"the name of {what}, with / between folders", name)
        try:
            # Links are followed first: a scene from an untrusted source must not make symrot open any other file of the
            # user and quote it in a message.
            path = (self.folder / name).resolve()
            inside = any(path.is_relative_to(Path(each).resolve()) for each in (self.folder, *others))
        except (OSError, RuntimeError, ValueError) as reason:  # RuntimeError: links that lead in a circle
            fail(where, f"the name of {what}, got {getattr(reason, 'strerror', None) or reason}")
        if not inside:
            fail(where, "a file in the folder of the scene or below it", name, "`--table-folder DIR`, in Python "
                     "load_scene(.., table_folders=[DIR]), allows files in another folder")  # fmt: skip
        return path


def listed_folders(value: str | Path | Sequence[str | Path]) -> tuple[str | Path, ...]:
    """Return the argument ``table_folders``, one folder or several, as a tuple; raise InputError for other values."""
    folders = (value,) if isinstance(value, str | Path) else tuple(value) if isinstance(value, Iterable) else (value,)
    if not all(isinstance(folder, str | Path) for folder in folders):
        fail("table_folders", "a folder or a list of folders", value)
    return folders
