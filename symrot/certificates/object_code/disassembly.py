"""The content of an object file, read through the program ``objdump``: instructions, constants and relocations.

A relocation is an address that the linker fills in later. The file itself is never opened; the meaning of instructions
is defined in :mod:`symrot.certificates.object_code.machine`.
"""

import re
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from symrot.certificates.tools import run_tool
from symrot.errors import CertificateError, CompilerError

__all__ = [
    "Constant",
    "Instruction",
    "Listing",
    "Memory",
    "Operand",
    "Register",
    "Relocation",
    "read_listing",
    "why_no_objdump",
]

FORMAT = "elf64-x86-64"
SECONDS = 60
"""The time in seconds that objdump may take."""

SIZES = {"BYTE": 1, "WORD": 2, "DWORD": 4, "QWORD": 8, "XMMWORD": 16, "YMMWORD": 32}
RELATIVE = (
    "R_X86_64_PC32",
    "R_X86_64_PLT32",
)  # both are symbol + addend - place, after linking directly or through the procedure linkage table
INDIRECT = ("R_X86_64_GOTPCREL", "R_X86_64_GOTPCRELX", "R_X86_64_REX_GOTPCRELX")
_PREFIXES = {"rep", "repz", "bnd", "notrack", "data16", "cs", "ds"}
_PREFIXED = {"nop", "ret", "jmp", "call"}  # instructions whose effect these prefixes do not change

_HEAD = re.compile(r"[0-9a-f]+ <(?P<name>.+)>:")
_LINE = re.compile(r"\s*(?P<address>[0-9a-f]+):\t(?P<bytes>(?:[0-9a-f]{2} )+)\s*(?:\t(?P<text>.*))?")
_RELOCATION = re.compile(
    r"\s*(?P<address>[0-9a-f]+): (?P<kind>R_X86_64_\w+)\s+(?P<symbol>[^\s+-]+)(?P<plus>[+-]0x[0-9a-f]+)?"
)
_SYMBOL = re.compile(
    r"(?P<value>[0-9a-f]{16}) (?P<flags>.{7}) (?P<section>\S+)\t(?P<size>[0-9a-f]+) ?(?:\.hidden )?(?P<name>.*)"
)
_SECTION = re.compile(r"\s*\d+ (?P<name>\S+)\s+(?P<size>[0-9a-f]+) .*?(?P<flags>(?:[A-Z_]+(?:, )?)+)\s*$")
_BYTES = re.compile(r" (?P<address>[0-9a-f]{4,16}) (?P<words>(?:[0-9a-f]{2,8} ){1,4})")
_MEMORY = re.compile(
    r"(?:(?P<size>[A-Z]+) PTR )?(?:(?P<segment>[a-z]s):)?(?:\[(?P<inside>[^\]]+)\]|(?P<plain>0x[0-9a-f]+))"
)
_PART = re.compile(r"(?P<sign>[+-]?)(?:(?P<register>[a-z]\w*)(?:\*(?P<scale>[1248]))?|(?P<number>0x[0-9a-f]+))")


@dataclass(frozen=True)
class Register:
    """A register operand: ``name`` as the instruction writes it, such as ``eax`` for the lower half of ``rax``."""

    name: str


@dataclass(frozen=True)
class Constant:
    """A number inside an instruction: an operand of the operation, or the target address of a jump."""

    value: int


@dataclass(frozen=True)
class Memory:
    """A memory operand: ``size`` bytes at base + index*scale + offset; ``size`` is 0 if the instruction omits it."""

    size: int
    segment: str
    base: str
    index: str
    scale: int
    offset: int


Operand = Register | Constant | Memory


@dataclass(frozen=True)
class Relocation:
    """An address in an instruction that the linker fills in: symbol + ``addend`` - end of the instruction."""

    kind: str
    symbol: str
    addend: int


@dataclass(frozen=True)
class Instruction:
    """One machine instruction: its section and address, its length ``size`` in bytes, and its operands."""

    section: str
    address: int
    size: int
    mnemonic: str
    operands: tuple[Operand, ...]
    text: str
    relocation: Relocation | None


@dataclass(frozen=True)
class Listing:
    """The content of an object file: its instructions, the section and offset of each symbol, and its constants."""

    where: str
    code: Mapping[tuple[str, int], Instruction]
    symbols: Mapping[str, tuple[str, int]]  # name -> section, offset; section "" if another file defines it
    constants: Mapping[str, bytes]  # name of a read-only section without relocations -> its bytes

    def function(self, name: str) -> tuple[str, int]:
        """Return the section and address at which a function begins.

        Raises
        ------
        CertificateError
            If the object file does not define the function.
        """
        section, address = self.symbols.get(name, ("", 0))
        if (section, address) in self.code:
            return section, address
        others = [other for other, place in self.symbols.items() if place in self.code and not other.startswith(".")]
        if not self.code:
            why = "no code at all (with -flto, add -ffat-lto-objects)"
        else:
            why = f"only that of {', '.join(sorted(others)[:4])}" if others else "code without names"
        raise CertificateError(f"{self.where}: expected machine code of {name}, got {why}")


def why_no_objdump() -> str:
    """Return a sentence that says why object files cannot be read here; an empty text if they can."""
    return (
        "" if shutil.which("objdump") else "reading object code needs objdump (GNU binutils), which is not on the path"
    )


def read_listing(path: Path) -> Listing:
    """Return the code and the constants of a relocatable object file (``cc -c``) for x86-64 ELF.

    Raises
    ------
    CompilerError
        If there is no ``objdump``.
    CertificateError
        If the file is missing, is for another machine, is linked already, or has content that cannot be parsed.
    """
    if why_no_objdump():
        raise CompilerError(why_no_objdump())
    where = path.name
    if not path.is_file():
        got = "a folder" if path.is_dir() else "another kind of file" if path.exists() else "no file"
        raise CertificateError(f"{path}: expected an object file, got {got}")
    if not path.stat().st_size:
        raise CertificateError(f"{path}: expected an object file, got an empty file")
    header = _objdump(path, "-f")
    if "In archive " in header:
        raise CertificateError(f"{where}: expected one object file as `cc -c` makes it, got an archive of object files")
    format_match = re.search(r"file format (\S+)", header)
    if format_match is None or format_match[1] != FORMAT or "DYNAMIC" in header or "EXEC_P" in header:
        kind = (
            f"{format_match[1]}{', linked' if format_match[1] == FORMAT else ''}" if format_match else "no object code"
        )
        raise CertificateError(f"{where}: expected an object file as `cc -c` makes it for {FORMAT}, got {kind}")
    symbols = _symbols(_objdump(path, "-t", "-w"), where)
    return Listing(
        where, _code(_objdump(path, "-d", "-r", "-w", "-M", "intel"), where), symbols, _constants(path, where)
    )


def _objdump(path: Path, *options: str) -> str:
    """Run objdump with ``options`` on a file and return what it prints; raise CertificateError if it fails."""
    environment = {"LC_ALL": "C", "PATH": _search_path()}
    command = ["objdump", *options, "--", str(path)]
    done = run_tool(command, SECONDS, environment=environment)
    if done.returncode:
        complaint = done.stderr.strip().split("\n")[-1].removeprefix("objdump: ")[:200]
        hint = ": clang -flto writes no machine code" if "not recognized" in complaint else ""
        raise CertificateError(f"{path.name}: objdump cannot read it ({complaint}){hint}")
    return done.stdout


def _search_path() -> str:
    import os

    return os.environ.get("PATH", os.defpath)


def _symbols(text: str, where: str) -> dict[str, tuple[str, int]]:
    """Return the symbol table in objdump's ``text``: a map from each name to its section and offset."""
    symbols: dict[str, tuple[str, int]] = {}
    for line in text.splitlines():
        match = _SYMBOL.fullmatch(line)
        if match is None or "f" in match["flags"]:  # a line without a symbol, or the name of a source file
            continue
        # a symbol of another file has an empty section
        section = {"*UND*": "", "*COM*": "*COM*"}.get(match["section"], match["section"])
        place = (section, int(match["value"], 16))
        if symbols.setdefault(match["name"], place) != place:
            raise CertificateError(f"{where}: expected one definition of the symbol {match['name']!r}, got two")
    return symbols


def _constants(path: Path, where: str) -> dict[str, bytes]:
    """Return the contents of an object file's read-only data sections by section name."""
    constants: dict[str, bytes] = {}
    for line in _objdump(path, "-h", "-w").splitlines():
        match = _SECTION.fullmatch(line)
        if match is None:
            continue
        flags = set(re.findall(r"[A-Z_]+", match["flags"]))
        # a section with addresses that the linker fills in has unknown content
        if not {"READONLY", "DATA", "CONTENTS"} <= flags or "RELOC" in flags:
            continue
        name, size = match["name"], int(match["size"], 16)
        content = bytearray()
        for dumped in _objdump(path, "-s", "-j", name).splitlines():
            row = _BYTES.match(dumped)
            if row is not None:
                if int(row["address"], 16) != len(content):
                    raise CertificateError(
                        f"{where}: expected the bytes of section {name} in increasing order of "
                        "addresses, got another order from objdump"
                    )
                content += bytes.fromhex(row["words"])
        if len(content) != size:
            raise CertificateError(f"{where}: expected {size} bytes in section {name}, got {len(content)}")
        constants[name] = bytes(content)
    return constants


def _code(text: str, where: str) -> dict[tuple[str, int], Instruction]:
    """Return the instructions in the listing ``text`` of objdump, by section and address."""
    rows: list[tuple[str, int, bytes, str]] = []
    relocations: dict[tuple[str, int], tuple[str, str, int]] = {}
    section = ""
    for line in text.splitlines():
        if line.startswith("Disassembly of section "):
            section = line.removeprefix("Disassembly of section ").rstrip(":")
            continue
        if not line or not section or _HEAD.fullmatch(line):
            continue
        body, *relocated = re.split(r"\t(?=[0-9a-f]+: R_X86_64_)", line)
        row, alone = _LINE.fullmatch(body.rstrip()), None
        if row is None and body.strip() and body.strip() != "...":
            alone = _RELOCATION.fullmatch(body)
            if alone is None:
                raise CertificateError(f"{where}: expected a line as objdump prints it, got {body.strip()[:80]!r}")
        if row is not None:
            rows.append((section, int(row["address"], 16), bytes.fromhex(row["bytes"]), row["text"] or "(bad)"))
        for relocation in [alone, *(_RELOCATION.fullmatch(item) for item in relocated)]:
            if relocation is not None:
                plus = int(relocation["plus"] or "0", 16)
                relocations[section, int(relocation["address"], 16)] = (relocation["kind"], relocation["symbol"], plus)
    code = {(row[0], row[1]): _instruction(*row, relocations, where) for row in rows}
    if len(code) != len(rows):
        raise CertificateError(f"{where}: expected a different name for each section, got two sections of one name")
    return code


def _instruction(
    section: str, address: int, content: bytes, text: str,
    relocations: Mapping[tuple[str, int], tuple[str, str, int]], where: str,
) -> Instruction:  # fmt: skip
    """Return the instruction in a line of objdump's listing; ``content`` holds the bytes of the instruction."""
    # addresses within the instruction that the linker fills in
    inside = [
        (at, relocations[section, at]) for at in range(address, address + len(content)) if (section, at) in relocations
    ]
    relocation = None
    if len(inside) > 1:
        raise CertificateError(
            f"{where}: expected at most one relocation (address filled in by the linker) in the "
            f"instruction at {address:#x} of {section}, got {len(inside)}"
        )
    for at, (kind, symbol, plus) in inside:
        relocation = Relocation(kind, symbol, plus + address + len(content) - at)
    bare = re.split(r"\s+[#<]", text)[0].strip()
    words = bare.split(None, 1)
    is_prefixed = bool(words) and words[0] in _PREFIXES
    while len(words) > 1 and words[0] in _PREFIXES:
        words = words[1].split(None, 1)
    mnemonic = words[0] if words and (words[0] in _PREFIXED or not is_prefixed) else "(bad)"
    operands = _operands(words[1]) if len(words) > 1 else ()
    if operands is None:
        mnemonic, operands = "(bad)", ()
    return Instruction(section, address, len(content), mnemonic, operands, bare, relocation)


@cache
def _operands(text: str) -> tuple[Operand, ...] | None:
    """Return the operands in the text of an instruction, or None if any of them cannot be parsed."""
    operands = [_operand(item.strip()) for item in text.split(",")]
    return None if None in operands else tuple(item for item in operands if item is not None)


def _operand(text: str) -> Operand | None:
    """Return one operand in Intel syntax as a :class:`Register`, :class:`Constant` or :class:`Memory`.

    The result is None if the text cannot be parsed.
    """
    if re.fullmatch(r"-?0x[0-9a-f]+|[0-9a-f]+", text):
        return Constant(int(text, 16))
    if re.fullmatch(r"[a-z]\w*", text):
        return Register(text)
    match = _MEMORY.fullmatch(text)
    if match is None or (match["size"] or "QWORD") not in SIZES:
        return None
    size = SIZES[match["size"]] if match["size"] else 0
    if match["plain"]:
        return Memory(size, match["segment"] or "", "", "", 1, int(match["plain"], 16))
    return _address(match["inside"], size, match["segment"] or "")


def _address(inside: str, size: int, segment: str) -> Memory | None:
    """Return the memory operand that a text such as ``"rax+8*rcx-0x10"`` denotes, or None if it cannot be parsed."""
    base = index = ""
    scale, offset, position = 1, 0, 0
    while position < len(inside):
        part = _PART.match(inside, position)
        if part is None:
            return None
        position = part.end()
        if part["number"]:
            offset += int(part["number"], 16) * (-1 if part["sign"] == "-" else 1)
        elif part["sign"] == "-":
            return None
        elif part["scale"] and not index:
            index, scale = part["register"], int(part["scale"])
        elif not part["scale"] and not base:
            base = part["register"]
        else:
            return None
    return Memory(size, segment, base, index, scale, offset)
