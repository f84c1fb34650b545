"""Which formulas of the four documents no claim covers: ``python -m tests.textbook.coverage FOLDER``.

FOLDER holds the texts of the documents as they were extracted, ``000_*.txt`` to ``003_*.txt`` in the order of
``symrot.textbook.DOCUMENTS``. A piece of text with a formula is the text around the relation signs of a line, or before
the number of an equation. It is covered if a claim prints half of it, or names the number as its place, or if
``symrot/textbook/lines.toml`` says why it states no formula of its own. :func:`signs_left_out` asks the same of each
relation sign of a piece.

With ``--write``, the pieces are written to ``tests/reference/textbook_pieces.txt``, which tests read in place of the
documents.
"""

import re
import sys
import unicodedata
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from symrot.textbook import DOCUMENTS, document, lines

__all__ = [
    "PIECES", "Piece", "is_covered", "main", "pieces", "plain", "reference_pieces", "signs_left_out", "uncovered",
]  # fmt: skip

PIECES = Path(__file__).parents[1] / "reference" / "textbook_pieces.txt"
AROUND = 50
"""The most characters of a piece before and after a relation sign."""

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
        elif len(plain(line)) >= SHORTEST:
            for start, end in _windows(line):
                yield number, line[start:end]


def _windows(line: str) -> list[tuple[int, int]]:
    """Return the places of the text around the relation signs of a line; places that overlap are joined.

    A line with a double encoding, in which a letter is several characters, is one place.
    """
    places: list[tuple[int, int]] = []
    if MATHEMATICAL in line and RELATION.search(line):
        return [(0, len(line))]
    for match in RELATION.finditer(line):
        start, end = max(0, match.start() - AROUND), min(len(line), match.end() + AROUND)
        if places and start <= places[-1][1]:
            start = places.pop()[0]
        places.append((start, end))
    return places


def is_covered(piece: str, printed: str, numbers: set[str]) -> bool:
    """Return whether a piece is in the printed texts, at least half of it in one go, or its number is a place."""
    numbered = NUMBERED.search(piece)
    if numbered:
        return numbered[1] in numbers
    text = plain(piece)
    size = max(min(len(text), SHORTEST), min(len(text) // 2, LONGEST))
    return any(text[start : start + size] in printed for start in range(len(text) - size + 1))


def reference_pieces() -> dict[str, list[Piece]]:
    """Return the pieces of each document as they were written by ``--write``."""
    by_document: dict[str, list[Piece]] = {name: [] for name in DOCUMENTS}
    for line in PIECES.read_text(encoding="utf-8").splitlines():
        name, number, piece = line.split(":", 2)
        by_document[name].append((int(number), piece))
    return by_document


def uncovered(name: str, every: Sequence[Piece]) -> list[Piece]:
    """Return the pieces of a document that no claim and no entry of ``lines.toml`` covers."""
    claims = document(name).claims.values()
    printed = "\n".join(plain(claim["printed"]) for claim in claims)
    numbers = {number for claim in claims for number in _numbers(claim["where"])}
    others = {plain(line.printed) for line in lines(name)}
    return [
        (number, piece)
        for number, piece in every
        if not is_covered(piece, printed, numbers) and not _is_listed(plain(piece), others)
    ]


NEAR_SIGN, OF_SIGN = 12, 6
"""The letters on each side of a relation sign that belong to it, and how many in a row with it a claim must print."""


def signs_left_out(name: str) -> list[Piece]:
    """Return the surroundings of each relation sign of a document that no claim prints and no line lists.

    A sign without a letter or digit near it, and the garbled lines of a double encoding, are not asked for.
    """
    printed = "\n".join(plain(claim["printed"]) for claim in document(name).claims.values())
    others = [plain(line.printed) for line in lines(name)]
    missing = []
    for number, piece in reference_pieces()[name]:
        text = plain(piece)
        listed = [range(at, at + len(other)) for other in others for at in _places(other, text)]
        for sign in RELATION.finditer(text if MATHEMATICAL not in piece else ""):
            start = max(0, sign.start() - NEAR_SIGN)
            near = text[start : sign.end() + NEAR_SIGN]
            size, at = min(OF_SIGN, len(near)), sign.start() - start
            windows = (near[k : k + size] for k in range(max(0, at - size + 1), min(at, len(near) - size) + 1))
            is_listed = any(sign.start() in places for places in listed) or any(text in other for other in others)
            if any(map(str.isalnum, near)) and not is_listed and not any(window in printed for window in windows):
                missing.append((number, near))
    return missing


def _places(part: str, text: str) -> list[int]:
    return [match.start() for match in re.finditer(re.escape(part), text)]


def _is_listed(piece: str, others: Collection[str]) -> bool:
    return piece in others or any(len(other) > SHORTEST and other in piece for other in others)


def main(arguments: list[str]) -> int:
    """Print the pieces that are not covered, and a count for each document."""
    folder, *options = arguments
    written = []
    for place, name in enumerate(DOCUMENTS):
        (path,) = Path(folder).glob(f"{place:03}_*.txt")
        every = list(pieces(path.read_text(encoding="utf-8")))
        written += [f"{name}:{number}:{piece.strip()}\n" for number, piece in every]
        missing = uncovered(name, every)
        for number, piece in missing:
            print(f"{name}:{number}: {piece.strip()[:150]}")
        print(f"{name}: {len(every) - len(missing)} of {len(every)} pieces with a formula are covered")
        for number, near in signs_left_out(name):
            print(f"{name}:{number}: no claim has the sign in {near}")
    if options == ["--write"]:
        PIECES.write_text("".join(written), encoding="utf-8")
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
