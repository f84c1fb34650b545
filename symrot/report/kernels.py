"""Emitted kernels as files: those of one scene, those of all shipped scenes, and whether the files there are stale."""

from collections.abc import Callable, Mapping, Sequence
from difflib import unified_diff
from pathlib import Path

from symrot.errors import InputError
from symrot.interface import emit
from symrot.report.files import write
from symrot.scene import load_scene
from symrot.scene_file import shipped_names

__all__ = ["scene_files", "stale", "write_all", "write_files"]

SUFFIXES = {"c": (".c", ".h"), "numpy": (".py",)}
ROOM = "scenes"  # under the folder of each target


def scene_files(scene: str | Path, target: str) -> dict[str, str]:
    """Return file name -> text of a scene's own kernel; in C the header comes first."""
    found = emit(load_scene(scene), target)
    if target == "numpy":
        return {f"{found.name}.py": found.source}
    return {f"{found.name}.h": found.header, f"{found.name}.c": found.source}


def _all_files(targets: Sequence[str], progress: Callable[[str], object]) -> dict[str, str]:
    """Return path -> text of the kernels of all shipped scenes."""
    files: dict[str, str] = {}
    for name in shipped_names():
        progress(f"emitting {name} ..")
        for target in targets:
            files |= {f"{target}/{ROOM}/{file}": text for file, text in scene_files(name, target).items()}
    return files


def _printed_before(directory: Path, targets: Sequence[str]) -> list[str]:
    """Return the paths of the kernels that are there, those of scenes that are gone among them."""
    return [
        path.relative_to(directory).as_posix()
        for target in targets
        for path in sorted((directory / target / ROOM).glob("*"))
        if path.suffix in SUFFIXES[target]
    ]


def write_files(directory: Path, files: Mapping[str, str]) -> list[Path]:
    """Write texts into a folder, made if it is not there, and return the paths that changed.

    Raises
    ------
    InputError
        If the folder or a file cannot be written.
    """
    changed = []
    for name, text in files.items():
        path, content = directory / name, text.encode()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            same = path.is_file() and path.read_bytes() == content
        except OSError as reason:
            raise InputError(f"{str(path)!r} cannot be written: {reason.strerror or reason}") from None
        if not same:
            write(path, lambda stream, content=content: stream.write(content))  # type: ignore[misc]
            changed.append(path)
    return changed


def write_all(directory: Path, targets: Sequence[str], progress: Callable[[str], object]) -> list[Path]:
    """Write the kernels of all shipped scenes, remove those of scenes that are gone, return the paths that changed."""
    files = _all_files(targets, progress)
    changed = write_files(directory, files)
    for name in _printed_before(directory, targets):
        if name not in files:
            (directory / name).unlink()
            changed.append(directory / name)
    return changed


def stale(directory: Path, targets: Sequence[str], progress: Callable[[str], object]) -> list[str]:
    """Return a unified diff from the kernels that are there to those that would be printed now; nothing if equal.

    Raises
    ------
    InputError
        If the folder is not there.
    """
    if not directory.is_dir():
        raise InputError(f"{str(directory)!r}: expected the folder that `symrot emit --all` writes, there is none")
    files = _all_files(targets, progress)
    lines: list[str] = []
    for name in sorted({*files, *_printed_before(directory, targets)}):
        path = directory / name
        old = path.read_bytes().decode(errors="replace") if path.is_file() else ""
        new = files.get(name, "")
        if old != new or name not in files:
            before, after = f"{path} (on disk)", f"{path} (emitted)"
            diff = list(unified_diff(old.splitlines(), new.splitlines(), before, after, lineterm=""))
            lines += diff or [f"{path}: {'line ends differ' if name in files else 'a kernel of no scene'}"]
    return lines
