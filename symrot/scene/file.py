"""Scene files: functions that find a file by name or path, check that it contains TOML text, and return its table."""

import re
from decimal import Decimal
from pathlib import Path
from typing import Any

from symrot.dynamics.torque_kinds import TABLE_KIND
from symrot.errors import InputError, nearest
from symrot.files.reading import read_input, utf8_text
from symrot.formula.switches import has_switches
from symrot.formula.tree import parse

__all__ = ["LARGEST_FILE", "SHIPPED", "find_scene", "names_with_kernels", "read_toml", "shipped_names"]

SHIPPED = Path(__file__).parent / "shipped"
LARGEST_FILE = 1_000_000
"""Largest size, in bytes, of a scene file."""

MOST_PARTS = 100
_KEY = re.compile(r"[A-Za-z0-9_-]+|\"[^\"\n]*\"|'[^'\n]*'")


def shipped_names() -> list[str]:
    """Return the names of the scenes that come with symrot, sorted."""
    return sorted(path.stem for path in SHIPPED.iterdir() if path.suffix == ".toml")


def names_with_kernels() -> list[str]:
    """Return the names of the shipped scenes whose equations of motion can be printed as C and certified."""
    # A table of samples has no formula; with jumps or kinks, the equations change at each of them.
    return [name for name in shipped_names() if all(map(_has_kernel, _torques(name)))]


def _torques(name: str) -> list[dict[str, Any]]:
    return list(read_toml(SHIPPED / f"{name}.toml", name).get("torque", []))


def _has_kernel(torque: dict[str, Any]) -> bool:
    if torque["kind"] != "expression":
        return str(torque["kind"]) != TABLE_KIND.kind
    return not any(has_switches(parse(str(formula), switching=True)) for formula in torque["torque"])


def find_scene(source: str | Path) -> Path:
    """Return the path of a scene file, from the name of a shipped scene or from a path.

    Raises
    ------
    InputError
        If the path is a folder, or if there is no such scene; the message then proposes the most similar name, or
        lists the shipped scenes.
    """
    if not isinstance(source, str | Path) or not str(source).strip() or "\0" in str(source):
        raise InputError(f"expected the name of a scene or the path of a scene file, got {str(source)[:60]!r}")
    path = Path(source)
    names = shipped_names()
    # Without suffix and folder, the name of a shipped scene comes before a file of the current folder.
    is_name = isinstance(source, str) and path.name == source and not path.suffix
    if is_name and source in names:
        return SHIPPED / f"{source}.toml"
    try:
        if path.is_dir():
            raise InputError(f"{source}: expected a scene file, got a folder")
        if path.exists():
            return path
    except OSError as reason:
        raise InputError(f"{str(source)[:80]}: expected a scene file, got {reason.strerror}") from None
    label = str(source) if str(source).isprintable() else repr(str(source))
    in_folder = nearest(path.name, [file.name for file in path.parent.glob("*.toml")])
    shipped = nearest(path.stem, names)
    if in_folder and not (is_name and shipped):
        hints = in_folder
    else:
        hints = f"{shipped} `symrot scenes` lists all" if shipped else f"the shipped scenes are {', '.join(names)}"
    raise InputError(f"{label}: expected a scene or a scene file, but there is none of this name ({hints})")


def read_toml(path: Path, label: str, what: str = "scene") -> dict[str, Any]:
    """Return the table of a TOML file, in which numbers with a decimal point are Decimals, exactly as written.

    Parameters
    ----------
    path : Path
        The file.
    label : str
        Name of the file in error messages.
    what : str
        Name of the content in error messages, such as ``"scene"``.

    Raises
    ------
    InputError
        If the file cannot be read, is not a regular file, is larger than 1 MB, is empty, is not UTF-8 text, or is not
        TOML; in the last case the message usually names the line.
    """
    try:
        content = read_input(path, LARGEST_FILE)
    except OSError as reason:
        expectation = f"a readable {what} file of at most {LARGEST_FILE // 1_000_000} MB"
        raise InputError(f"{label}: expected {expectation}, got {reason.strerror or reason}") from None
    text = utf8_text(content, label)
    if not text.strip():
        raise InputError(f"{label}: expected a {what}, got an empty file")
    return _parse(text, label)


def _longest_key(text: str) -> int:
    """Return an estimate of the number of parts of the longest dotted key, such as ``a.b.c``, in TOML text."""
    # The time and memory of tomllib are quadratic in this number, so a file with a very long key is refused.
    longest = run = 0
    for part in text.split("."):
        run = run + 1 if _KEY.fullmatch(part.strip(" \t")) else 1
        longest = max(longest, run)
    return longest


def _parse(text: str, label: str) -> dict[str, Any]:
    import tomllib  # compiles its patterns when imported

    if _longest_key(text) > MOST_PARTS:
        raise InputError(f"{label}: expected keys of at most {MOST_PARTS} parts (a.b.c has 3), got a key of more parts")
    try:
        return tomllib.loads(text, parse_float=Decimal)
    except tomllib.TOMLDecodeError as reason:
        fault = str(reason).splitlines()[0][:200]
        raise InputError(f"{label}: expected a TOML document, got a fault: {fault[:1].lower()}{fault[1:]}") from None
    except RecursionError:
        raise InputError(f"{label}: expected a TOML document, got tables or lists nested too deeply") from None
    except (ValueError, ArithmeticError) as reason:  # an integer of more than 4300 digits, an impossible date
        fault = str(reason).partition(":")[0][:200]
        raise InputError(f"{label}: expected a TOML document, got a fault: {fault[:1].lower()}{fault[1:]}") from None
