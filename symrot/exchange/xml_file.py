"""Safe reading of XML files of unknown origin: document types (and so entities) are refused, size and depth limited."""

from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree
from xml.parsers import expat

from symrot.errors import InputError
from symrot.files.reading import read_input

__all__ = ["Span", "read_xml", "span_of"]

LARGEST_FILE = 20_000_000
DEEPEST = 200


class Span(NamedTuple):
    """The place of an element in the bytes of a file: ``content[start:stop]``; empty if the element is missing."""

    start: int
    stop: int


class _Refusal(Exception):
    """Exception with the reason why a file is refused; the parser's handlers raise it."""


def read_xml(path: Path, where: str) -> tuple[bytes, ElementTree.Element]:
    """Return the bytes and the root element of an XML file.

    Raises
    ------
    InputError
        If the file cannot be read, is larger than 20 MB, is not XML, has a document type, or is nested too deeply.
    """
    try:
        content = read_input(path, LARGEST_FILE)
    except OSError as reason:
        limit = f"{LARGEST_FILE // 1_000_000} MB"
        raise InputError(
            f"{where}: expected a readable robot file of at most {limit}, got {reason.strerror or reason}"
        ) from None
    if content.lstrip()[:1] not in (b"<", b"\xef", b"\xfe", b"\xff"):  # a bracket, or a mark of the encoding before it
        raise InputError(
            f"{where}: expected an XML file, a robot in URDF, MJCF or SDF, got a file of another format; meshes are "
            "read in the formats STL, OBJ, PLY and GLB"
        )
    parser = expat.ParserCreate()
    depth = 0

    def doctype(*_: Any) -> None:
        raise _Refusal("a file without a document type, got <!DOCTYPE ..>; remove it")

    def start(*_: Any) -> None:
        nonlocal depth
        depth += 1
        if depth > DEEPEST:
            raise _Refusal(f"elements nested at most {DEEPEST} deep, got more")

    def end(*_: Any) -> None:
        nonlocal depth
        depth -= 1

    parser.StartDoctypeDeclHandler, parser.StartElementHandler, parser.EndElementHandler = doctype, start, end
    try:
        parser.Parse(content, True)
        return content, ElementTree.fromstring(content)
    except _Refusal as reason:
        raise InputError(f"{where}: expected {reason}") from None
    except (expat.ExpatError, ElementTree.ParseError, ValueError, LookupError) as reason:
        raise InputError(f"{where}: expected an XML file, got a fault: {' '.join(str(reason).split())[:80]}") from None


def span_of(content: bytes, owner: str, number: int, element: str) -> tuple[Span, bool]:
    """Return the range of bytes of a child element, and whether this child exists.

    Parameters
    ----------
    content : bytes
        The XML file.
    owner, number : str and int
        The tag of the parent, and its index, from 0, among the elements with this tag in the order of the file.
    element : str
        The tag of the child. If the parent has no such child, the range is empty: at the byte where
        the child can be inserted or, if the parent is one tag that ends with ``/>``, after this tag.
    """
    parser = expat.ParserCreate()
    stack: list[bool] = []  # for each open element whether it is the parent
    places: dict[str, int] = {}
    waits: list[str] = []  # names of places that are where the next event is
    count = -1

    def mark(*_: Any) -> None:
        while waits:
            places.setdefault(waits.pop(), parser.CurrentByteIndex)

    def start(tag: str, _: dict[str, str]) -> None:
        nonlocal count
        mark()
        if tag == element and stack and stack[-1] and "start" not in places:
            places["start"] = parser.CurrentByteIndex
        count += tag == owner
        stack.append(tag == owner and count == number)
        if stack[-1]:
            waits.append("inside")

    def end(tag: str) -> None:
        mark()
        stack.pop()
        if tag == element and stack and stack[-1] and "stop" not in places:
            waits.append("stop")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = parser.CommentHandler = parser.ProcessingInstructionHandler = mark
    parser.StartCdataSectionHandler = mark
    parser.Parse(content, True)
    if "stop" in places:
        return Span(places["start"], places["stop"]), True
    # empty, directly after the owner's start tag: a new element can be inserted there
    return Span(places["inside"], places["inside"]), False
