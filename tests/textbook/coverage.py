"""Which formulas of the four documents no claim covers: ``python -m tests.textbook.coverage FOLDER``.

FOLDER holds the texts of the documents as they were extracted, ``000_*.txt`` to ``003_*.txt`` in the order of
``symrot.textbook.DOCUMENTS``. A piece of text with a formula is a line with a relation sign, or the text before the
number of an equation. It is covered if a claim prints half of it, or names the number as its place.
"""

import re
import sys
import unicodedata
from collections.abc import Iterator
from pathlib import Path

from symrot.textbook import DOCUMENTS, document

__all__ = ["Piece", "is_covered", "main", "pieces", "plain"]

RELATION = re.compile(r"[=≠≤≥≈<>∫∑√]")
NUMBERED = re.compile(r"\((12\.\d+)\)")
SHORTEST = 4
"""The fewest letters, digits and signs of a piece that is a formula."""

LONGEST = 9
"""The most letters, digits and signs that a claim must print of a piece."""

Piece = tuple[int, str]
"""The number of a line, and a piece of its text."""


def plain(text: str) -> str:
    """Return a text with a double encoding undone, mathematical letters as plain ones, and no blanks."""
    undone = _undone(text) if MATHEMATICAL in text else text
    letters = unicodedata.normalize("NFKC", undone).replace("−", "-").replace("’", "'")
    return "".join(letters.replace("\N{GREEK PHI SYMBOL}", "φ").split())


MATHEMATICAL = "\N{THAI DIGIT ZERO}"
"""What the first byte of a mathematical letter, F0, became; the second byte, 9D, was dropped, and so was 90 after it."""


def _undone(text: str) -> str:
    """Return a text whose UTF-8 was read as a mixture of cp874 and cp1252."""
    raw = bytearray()
    for letter in text:
        for encoding in ("cp874", "cp1252", "utf-8"):
            try:
                code = letter.encode(encoding)
                break
            except UnicodeEncodeError:
                continue
        if raw.endswith(b"\xf0\x9d") and not 0x91 <= code[0] <= 0x95:
            raw += b"\x90"
        raw += b"\xf0\x9d" if letter == MATHEMATICAL else code
    return raw.decode("utf-8", errors="ignore")


def pieces(text: str) -> Iterator[Piece]:
    """Yield the pieces of a document that have a formula."""
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("Page ") or line.startswith(" Page "):
            continue
        places = [match.end() for match in NUMBERED.finditer(line)]
        if places:
            for start, end in zip([0, *places], places, strict=False):
                yield number, line[max(start, end - 90) : end]
        elif RELATION.search(line) and len(plain(line)) >= SHORTEST:
            yield number, line


def is_covered(piece: str, printed: str, numbers: set[str]) -> bool:
    """Return whether a piece is in the printed texts, at least half of it in one go, or its number is a place."""
    numbered = NUMBERED.search(piece)
    if numbered:
        return numbered[1] in numbers
    text = plain(piece)
    size = max(min(len(text), SHORTEST), min(len(text) // 2, LONGEST))
    return any(text[start : start + size] in printed for start in range(len(text) - size + 1))


def main(arguments: list[str]) -> int:
    """Print the pieces that no claim covers, and a count for each document."""
    (folder,) = arguments
    for place, name in enumerate(DOCUMENTS):
        (path,) = Path(folder).glob(f"{place:03}_*.txt")
        claims = document(name).claims.values()
        printed = "\n".join(plain(claim["printed"]) for claim in claims)
        numbers = {number for claim in claims for number in _numbers(claim["where"])}
        every = list(pieces(path.read_text(encoding="utf-8")))
        missing = [(line, piece) for line, piece in every if not is_covered(piece, printed, numbers)]
        for line, piece in missing:
            print(f"{name}:{line}: {piece.strip()[:150]}")
        print(f"{name}: {len(every) - len(missing)} of {len(every)} pieces with a formula are covered")
    return 0


def _numbers(where: str) -> list[str]:
    """Return the numbers of equations in a place: of (12.3)-(12.5) all three."""
    numbers = re.findall(r"12\.\d+", where)
    if "-(" in where and len(numbers) == 2:
        first, last = (int(number.partition(".")[2]) for number in numbers)
        return [f"12.{n}" for n in range(first, last + 1)]
    return numbers


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
