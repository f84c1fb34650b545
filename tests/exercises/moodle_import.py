"""What Moodle's importer requires of a file of questions, as far as this file can check it without Moodle.

Source: https://docs.moodle.org/en/Moodle_XML_format, and what Moodle reads in ``question/format/xml/format.php``,
``question/format.php`` and ``question/type/numerical/questiontype.php``. The importer passes over elements that it does
not know without a word; here they are faults.
"""

from base64 import b64decode
from binascii import Error
from collections.abc import Iterator
from xml.etree.ElementTree import Element, ParseError, fromstring

FORMATS = {"moodle_auto_format", "html", "plain_text", "wiki_like", "markdown"}
FRACTIONS = {
    100, 90, 83.33333, 80, 75, 70, 66.66667, 60, 50, 40, 33.33333, 30, 25, 20, 16.66667, 14.28571, 12.5, 11.11111, 10,
    5, 0,
}  # fmt: skip
"""The shares of the marks that an answer may have, percent; Moodle refuses others."""
LONGEST_NAME = 255
COMMON = {"name", "questiontext", "generalfeedback", "defaultgrade", "penalty", "hidden", "idnumber", "tags", "hint"}
CHILDREN = {
    "category": {"category", "info", "idnumber"},
    "shortanswer": COMMON | {"answer", "usecase"},
    "numerical": COMMON
    | {"answer", "units", "unitgradingtype", "unitpenalty", "showunits", "unitsleft", "instructions"},
    "description": COMMON,
}
"""Type of a question -> the elements in it that the importer reads, for the types that symrot writes."""
ANSWER = {"shortanswer": {"text", "feedback"}, "numerical": {"text", "feedback", "tolerance"}}
NUMBERS = {
    "defaultgrade": (0, 1000), "penalty": (0, 1), "hidden": (0, 1), "usecase": (0, 1), "unitgradingtype": (0, 2),
    "unitpenalty": (0, 1), "showunits": (0, 3), "unitsleft": (0, 1),
}  # fmt: skip
"""Element -> the least and the largest number that it may contain."""
NO_UNITS = 3
"""The value of ``showunits`` for a question without units."""


def faults(text: str) -> Iterator[str]:
    """Yield a sentence for each place of a file that Moodle's importer refuses, or reads as something else."""
    try:
        quiz = fromstring(text.encode())
    except ParseError as error:
        yield f"not XML: {error}"
        return
    if quiz.tag != "quiz":
        yield f"expected the root quiz, got {quiz.tag}"
    for number, question in enumerate(quiz, 1):
        kind = question.get("type", "")
        if question.tag != "question" or kind not in CHILDREN:
            yield f"element {number}: expected a question of a known type, got {question.tag} {kind!r}"
            continue
        yield from (f"question {number}: {fault}" for fault in _question(question, kind))


def _question(question: Element, kind: str) -> Iterator[str]:
    yield from (f"{child.tag} is not read" for child in question if child.tag not in CHILDREN[kind])
    if kind == "category":
        if not (question.findtext("category/text") or "").strip():
            yield "a category without a name"
        return
    name = (question.findtext("name/text") or "").strip()
    if not 0 < len(name) <= LONGEST_NAME:
        yield f"a name with {len(name)} characters"
    for child in question.iter():
        if child.get("format", "html") not in FORMATS:
            yield f"{child.tag}: unknown format {child.get('format')!r}"
        if child.tag == "text" and len(child):
            yield "text with elements in it: the markup must be escaped"
    for tag in ("questiontext", "generalfeedback", "hint"):
        for content in question.findall(tag):
            if not (content.findtext("text") or "").strip():
                yield f"{tag} without text"
            yield from _files(content)
    for tag, (least, largest) in NUMBERS.items():
        for element in question.findall(tag):
            if not least <= _number(element.text) <= largest:
                yield f"{tag}: expected a number from {least} to {largest}, got {element.text!r}"
    if kind in ANSWER:
        yield from _answers(question, kind)
    if kind == "numerical":
        yield from _units(question)


def _number(text: str | None) -> float:
    """Return the number that a text contains, or NaN, which fails every comparison."""
    try:
        return float(text or "")
    except ValueError:
        return float("nan")


def _files(content: Element) -> Iterator[str]:
    """Yield the faults of the files in a text: each must be encoded in base64, and each address must have a file."""
    text, names = content.findtext("text") or "", set()
    for file in content.findall("file"):
        names.add(file.get("name", ""))
        try:
            data = b64decode(file.text or "", validate=True)
        except Error:
            data = b""
        if file.get("encoding") != "base64" or not data:
            yield f"file {file.get('name')!r} is not encoded in base64"
    addresses = {part.partition('"')[0] for part in text.split("@@PLUGINFILE@@/")[1:]}
    if addresses != names:
        yield f"addresses of files {sorted(addresses)}, files {sorted(names)}"


def _answers(question: Element, kind: str) -> Iterator[str]:
    answers = question.findall("answer")
    fractions = [_number(answer.get("fraction")) for answer in answers]
    yield from (f"an answer with {fraction} %" for fraction in fractions if fraction not in FRACTIONS)
    if 100 not in fractions:
        yield "no answer with all marks"
    for answer in answers:
        yield from (f"{child.tag} of an answer is not read" for child in answer if child.tag not in ANSWER[kind])
        text = (answer.findtext("text") or "").strip()
        if not text:
            yield "an empty answer"
        if kind == "numerical" and text != "*":
            if not abs(_number(text)) < float("inf"):
                yield f"expected a number as answer, got {text!r}"
            if not 0 <= _number(answer.findtext("tolerance")) < float("inf"):
                yield f"expected a number as tolerance, got {answer.findtext('tolerance')!r}"


def _units(question: Element) -> Iterator[str]:
    names = [(unit.findtext("unit_name") or "").strip() for unit in question.findall("units/unit")]
    multipliers = [_number(unit.findtext("multiplier")) for unit in question.findall("units/unit")]
    if "" in names or len(set(names)) < len(names):
        yield f"units without a name, or twice: {names}"
    if multipliers and not (all(abs(each) > 0 for each in multipliers) and 1 in multipliers):
        yield f"expected multipliers of units, one of them 1, got {multipliers}"
    if (_number(question.findtext("showunits")) == NO_UNITS) == bool(names):
        yield "showunits does not suit the units"
