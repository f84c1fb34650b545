"""Object files that differ from their C text: every checker of object code has to refuse them.

Four kinds: a flipped bit of the machine code or of a constant, exchanged relocations, a source that was edited before
it was compiled, and other flags. An accepted mutant must compute the same: :func:`same_bits` runs both files on many
inputs and compares the bits of all outputs, which shares nothing with the comparison of terms.
"""

import ctypes
import json
import re
import struct
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from random import Random

from symrot.certificates.object_code.build import compile_object
from symrot.certificates.readback.c_functions import functions_of
from symrot.certificates.tools import run_tool
from symrot.errors import CompilerError

__all__ = ["KINDS", "Mutant", "mutants", "same_bits"]

KINDS = ("code", "constants", "relocations", "source", "flags")
OTHER_FLAGS = (("-O2", "-ffast-math"), ("-O3", "-Ofast", "-mavx2", "-mfma"), ("-O2", "-fassociative-math",
               "-fno-signed-zeros", "-fno-trapping-math"), ("-O2", "-funsafe-math-optimizations"))  # fmt: skip
_HEADER, _SECTION, _RELOCATION, _SYMBOL = "<16sHHIQQQIHHHHHH", "<IIQQQQIIQQ", "<QQq", "<IBBHQQ"
SAMPLES, SECONDS = 300, 60


@dataclass(frozen=True)
class Mutant:
    """A corrupted object file: its kind, the change, and its path."""

    kind: str
    what: str
    path: Path


@dataclass(frozen=True)
class _Section:
    name: str
    offset: int
    size: int
    link: int


def _sections(content: bytes) -> list[_Section]:
    """Return the sections of an ELF file."""
    header = struct.unpack_from(_HEADER, content)
    start, size, count, names = header[6], header[11], header[12], header[13]
    rows = [struct.unpack_from(_SECTION, content, start + size * place) for place in range(count)]
    text = rows[names][4]

    def name(at: int) -> str:
        return content[text + at : content.index(0, text + at)].decode()

    return [_Section(name(row[0]), row[4], row[5], row[6]) for row in rows]


def _spans(content: bytes, sections: list[_Section], functions: Sequence[str]) -> list[tuple[int, int]]:
    """Return where in the file the code of the functions is, as (start, end)."""
    (table,) = (section for section in sections if section.name == ".symtab")
    strings, spans = sections[table.link], []
    for at in range(table.offset, table.offset + table.size, 24):
        name, _, _, index, value, size = struct.unpack_from(_SYMBOL, content, at)
        begin = strings.offset + name
        if content[begin : content.index(0, begin)].decode() in functions and 0 < index < len(sections):
            start = sections[index].offset + value
            spans.append((start, start + size))
    return spans


def _flipped(content: bytes, at: int, bit: int) -> bytes:
    return content[:at] + bytes([content[at] ^ 1 << bit]) + content[at + 1 :]


def _links(content: bytes, functions: Sequence[str]) -> list[tuple[int, tuple[int, int, int], int]]:
    """Return the relocations in the code of the functions: the place of the entry, the entry, and the place that it
    overwrites.
    """
    sections = _sections(content)
    text = next(section for section in sections if section.name == ".text")
    table = next((section for section in sections if section.name == ".rela.text"), None)
    if table is None:
        return []
    rows = (
        (at, struct.unpack_from(_RELOCATION, content, at)) for at in range(table.offset, table.offset + table.size, 24)
    )
    spans = _spans(content, sections, functions)
    places = [(at, row, text.offset + row[0]) for at, row in rows]
    return [item for item in places if any(start <= item[2] < stop for start, stop in spans)]


def _code(content: bytes, functions: Sequence[str], random: Random) -> tuple[str, bytes] | None:
    """Flip a bit of an instruction that the linker will not overwrite."""
    written = {at + byte for _, _, at in _links(content, functions) for byte in range(4)}
    start, stop = random.choice(_spans(content, _sections(content), functions))
    at, bit = random.choice([at for at in range(start, stop) if at not in written]), random.randrange(8)
    return f"bit {bit} of byte {at - start:#x} of a function flipped", _flipped(content, at, bit)


def _constants(content: bytes, functions: Sequence[str], random: Random) -> tuple[str, bytes] | None:
    """Flip a bit in the first four bytes of a constant that the functions use."""
    sections = _sections(content)
    (table,) = (section for section in sections if section.name == ".symtab")
    places = []
    for _, (_, info, addend), _ in _links(content, functions):
        _, _, _, index, value, _ = struct.unpack_from(_SYMBOL, content, table.offset + 24 * (info >> 32))
        if 0 < index < len(sections) and sections[index].name.startswith(".rodata"):
            places.append((sections[index], value + addend + 4))
    if not places:
        return None
    section, offset = random.choice(places)
    at, bit = offset + random.randrange(4), random.randrange(8)
    if not 0 <= at < section.size:
        return None
    return f"bit {bit} of byte {at:#x} of {section.name} flipped", _flipped(content, section.offset + at, bit)


def _relocations(content: bytes, functions: Sequence[str], random: Random) -> tuple[str, bytes] | None:
    """Exchange the targets of two relocations in the code of the functions."""
    kind = 0xFFFFFFFF  # calls with calls, constants with constants
    inside = [(at, row) for at, row, _ in _links(content, functions)]
    pairs = [(a, b) for a in inside for b in inside if a[1][1:] < b[1][1:] and a[1][1] & kind == b[1][1] & kind]
    if not pairs:
        return None
    (first, one), (second, other) = random.choice(pairs)
    changed = bytearray(content)
    struct.pack_into(_RELOCATION, changed, first, one[0], *other[1:])
    struct.pack_into(_RELOCATION, changed, second, other[0], *one[1:])
    return f"the relocations at {one[0]:#x} and {other[0]:#x} exchanged", bytes(changed)


_BYTES = {"code": _code, "constants": _constants, "relocations": _relocations}
_EDITS = (  # in a statement of a function: pattern, what takes its place
    (re.compile(r" \+ "), (" - ",)), (re.compile(r" - "), (" + ",)), (re.compile(r"\*(?=\w)"), (" + ",)),
    (re.compile(r"\bsin(?=f?\()"), ("cos",)), (re.compile(r"\bcos(?=f?\()"), ("sin",)),
    (re.compile(r">="), (">", "<=")), (re.compile(r"\b\d+\.\d+"), ("1.25", "3.0")),
    (re.compile(r"= (?=\w+\*)"), ("= -",)), (re.compile(r"\[0\]"), ("[1]",)), (re.compile(r"/(?=\w)"), ("*",)),
)  # fmt: skip


def _edited(text: str, random: Random) -> tuple[str, str] | None:
    """Change one thing in one statement of a one-sample function."""
    lines = text.split("\n")
    batch, places = False, []
    for number, line in enumerate(lines):
        if line.startswith(("void", "static")):
            batch = "_batch(" in line
        if not batch and line.startswith("    ") and "=" in line and line.rstrip().endswith(";"):
            places.append(number)
    for _ in range(50):
        number, (pattern, new) = random.choice(places), random.choice(_EDITS)
        matches = list(pattern.finditer(lines[number], lines[number].index("=")))
        if matches:
            match, replacement = random.choice(matches), random.choice(new)
            line = lines[number][: match.start()] + replacement + lines[number][match.end() :]
            if line != lines[number]:
                return f"line {number + 1}: {line.strip()}", "\n".join([*lines[:number], line, *lines[number + 1 :]])
    return None


def mutants(
    source: Path, directory: Path, compiler: str, flags: Sequence[str], count: int, seed: int
) -> Iterator[Mutant]:
    """Yield object files that differ from what the compiler makes of a kernel, one after the other.

    Parameters
    ----------
    source : Path
        A C file as symrot emits it.
    directory : Path
        The folder for the files; ``good.o`` is the uncorrupted one.
    compiler, flags : str, sequence of str
        The compiler and its flags.
    count, seed : int
        The number of mutants, and the seed of their choice.
    """
    random, text = Random(f"{seed} {source.name} {compiler} {' '.join(flags)}"), source.read_text(encoding="utf-8")
    functions = [
        name for name, function in functions_of(text).items() if function.returns == "void" and "_batch" not in name
    ]
    good = directory / "good.o"
    compile_object(compiler, flags, source, good)
    content, made = good.read_bytes(), 0
    for attempt in range(4 * count):
        kind, path = KINDS[attempt % len(KINDS)], directory / f"mutant{attempt}.o"
        if made == count:
            return
        what = None
        if kind in _BYTES:
            changed = _BYTES[kind](content, functions, random)
            if changed is not None and changed[1] != content:
                path.write_bytes(changed[1])
                what = changed[0]
        elif kind == "source":
            what = _from_edited(source, text, path, compiler, flags, random)
        else:
            what = _from_other_flags(source, path, compiler, random)
        if what is not None:
            made += 1
            yield Mutant(kind, what, path)


def _from_other_flags(source: Path, path: Path, compiler: str, random: Random) -> str | None:
    """Compile with flags that void the certificate; return None if the text itself refuses these flags."""
    chosen = random.choice(OTHER_FLAGS)
    try:
        compile_object(compiler, chosen, source, path)
    except CompilerError:
        return None
    return " ".join(chosen)


def _from_edited(
    source: Path, text: str, path: Path, compiler: str, flags: Sequence[str], random: Random
) -> str | None:
    edited = _edited(text, random)
    if edited is None:
        return None
    changed = path.with_suffix(".c")
    changed.write_text(edited[1], encoding="utf-8")
    try:
        compile_object(compiler, (*flags, "-w", "-I", str(source.parent)), changed, path)
    except CompilerError:
        return None
    return edited[0]


# --- both files, run --------------------------------------------------------------------------------------------------


def same_bits(source: Path, good: Path, mutant: Path, seed: int = 1) -> bool:
    """Return whether two object files of one kernel give the same bits on many inputs, NaN for NaN; False after a
    crash.
    """
    outputs = []
    for path in (good, mutant):
        library = path.with_suffix(".so")
        command = [
            sys.executable,
            "-m",
            "tests.campaigns.certificates.object_code_mutants",
            str(source),
            str(library),
            str(seed),
        ]
        try:
            linked = run_tool(["cc", "-shared", "-o", str(library), str(path), "-lm"], SECONDS)
            done = run_tool(command, SECONDS) if linked.returncode == 0 else linked
        except CompilerError:
            return False
        if done.returncode:
            return False
        outputs.append(json.loads(done.stdout))
    return bool(outputs[0] == outputs[1])


SPECIAL = (0.0, -0.0, 1.0, -1.0, 0.5, float("inf"), float("-inf"), float("nan"), 5e-324, 1e-160, 1e160, 1e-30, 3.5)


def _outputs(source: Path, library: Path, seed: int) -> list[list[str]]:
    """Run the one-sample functions of a library and return their outputs as text."""
    random, values = Random(seed), []
    loaded = ctypes.CDLL(str(library))
    for name, function in functions_of(source.read_text(encoding="utf-8")).items():
        if function.returns != "void" or any(p.type == "size_t" for p in function.parameters):
            continue
        real = ctypes.c_double if function.parameters[0].type == "double" else ctypes.c_float
        for sample in range(SAMPLES):
            arguments, outputs = [], []
            for parameter in function.parameters:
                size = max(parameter.size, 1)
                chosen = [random.choice(SPECIAL) if sample % 3 == 0 else random.uniform(-3, 3) for _ in range(size)]
                array = (real * size)(*chosen)
                arguments.append(array if parameter.size else real(chosen[0]))
                outputs += [array] if parameter.size and not parameter.is_const else []
            getattr(loaded, name)(*arguments)
            values.append([float(value).hex() for array in outputs for value in array])
    return values


if __name__ == "__main__":
    print(json.dumps(_outputs(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))))
