"""Marking the differences between a claim and its repair, in plain text, LaTeX and HTML."""

import re
from collections.abc import Callable, Sequence
from difflib import SequenceMatcher
from html import escape

from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.tree import Node, text
from symrot.checker.typed.readings import Relation
from symrot.errors import InputError

__all__ = ["carets", "changed_entry", "changed_spans", "html_with_marks", "latex_with_marks"]

Span = tuple[int, int]
"""Start and end (exclusive) of a part of a text."""

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[^\W\d]\w*|\d+(?:\.\d+)?|\*\*|==|\s+|.", re.DOTALL)
"""Pattern of one token of a text: a name, a number, a command of LaTeX, a sign, or a run of blanks."""


def changed_spans(claim: str, repair: str) -> tuple[Span, ...]:
    """Return the positions (start, end), end exclusive, of the parts of a repair's text that differ from the claim.

    Examples
    --------
    >>> changed_spans("sin(2*x) == sin(x)*cos(x)", "sin(2*x) == 2*sin(x)*cos(x)")
    ((12, 14),)
    """
    old = [token for token in TOKEN.findall(claim) if not token.isspace()]
    matches = [match for match in TOKEN.finditer(repair) if not match.group().isspace()]
    spans: list[Span] = []
    blocks = SequenceMatcher(None, old, [match.group() for match in matches], autojunk=False).get_opcodes()
    for tag, _, _, start, end in blocks:
        if tag == "equal" or not matches:
            continue
        if start == end:
            # something left out: the sign next to the gap is marked
            start, end = (start - 1, start) if start == len(matches) else (start, start + 1)
        span = matches[start].start(), matches[end - 1].end()
        if spans and not repair[spans[-1][1] : span[0]].strip():
            spans[-1] = spans[-1][0], span[1]
        else:
            spans.append(span)
    return tuple(spans)


def changed_entry(relation: Relation, repaired: str) -> tuple[int, int] | None:
    """Return (row, column), from 1, of the only matrix entry in which ``repaired``, a text, differs from a relation.

    Return None if anything else differs.
    """
    try:
        other = read_relation(repaired.partition(" with ")[0])
    except InputError:
        return None
    entries: list[tuple[int, int]] = []
    for old, new in zip(relation[1:], other[1:], strict=True):
        if text(old) == text(new):
            continue
        before, after = _rows(old), _rows(new)
        if before is None or after is None or [len(row) for row in before] != [len(row) for row in after]:
            return None
        entries += [
            (n + 1, m + 1)
            for n, pair in enumerate(zip(before, after, strict=True))
            for m, cells in enumerate(zip(*pair, strict=True))
            if text(cells[0]) != text(cells[1])
        ]
    return entries[0] if len(entries) == 1 else None


def _rows(side: Node) -> list[tuple[Node, ...]] | None:
    """Return the rows of a matrix that is written with all its entries, otherwise None."""
    if side.kind != "call" or side.value != "Matrix" or side.args[0].kind != "list":
        return None
    return [row.args if row.kind == "list" else (row,) for row in side.args[0].args]


def carets(spans: Sequence[Span], start: int, end: int) -> str:
    """Return a line for a terminal with a caret under each character in ``spans``, from ``start`` to before ``end``."""
    marks = (any(first <= place < last for first, last in spans) for place in range(start, end))
    return "".join("^" if mark else " " for mark in marks).rstrip()


def html_with_marks(text: str, spans: Sequence[Span]) -> str:
    """Return a text as HTML with the marked positions in ``<mark>``.

    Examples
    --------
    >>> html_with_marks("a < 2*b", ((4, 5),))
    'a &lt; <mark>2</mark>*b'
    """
    return _with_marks(text, spans, escape, ("<mark>", "</mark>"))


def latex_with_marks(text: str, spans: Sequence[Span]) -> str:
    r"""Return LaTeX with the marked parts underlined; if a part is no complete formula, return the text unchanged.

    Examples
    --------
    >>> latex_with_marks("a = 2 b", ((4, 5),))
    'a = \\underline{2} b'
    """
    if not all(_is_formula(text[start:end]) and _stands_alone(text, start, end) for start, end in spans):
        return text
    return _with_marks(text, spans, str, ("\\underline{", "}"))


def _is_formula(piece: str) -> bool:
    r"""Return whether a part of a LaTeX text is a complete formula, such as ``x^{2}``, not ``\frac`` or ``{2``."""
    depth = 0
    for token in TOKEN.findall(piece):
        depth += (token in ("{", "\\left")) - (token in ("}", "\\right"))
        if depth < 0:
            return False
    return depth == 0 and not re.search(
        r"[&=^_]|\\\\|\\(begin|end|frac|sqrt|dot|ddot|mathbf|mathrm|operatorname|hat|text)$", piece
    )


def _stands_alone(text: str, start: int, end: int) -> bool:
    """Return whether the part of a LaTeX text from ``start`` to ``end`` can be underlined without changing the formula.

    It cannot for 2 in ``x^2``.
    """
    before, after = text[:start].rstrip(), text[end:].lstrip()
    if re.search(r"([\^_]|\\(?!\\)[A-Za-z]+\{?|\}\{)$", before) and not before.endswith(("\\cdot", "\\times")):
        return before.endswith("{") and after.startswith("}")
    return not after.startswith(("^", "_"))


def _with_marks(text: str, spans: Sequence[Span], written: Callable[[str], str], marks: tuple[str, str]) -> str:
    pieces, place = [], 0
    for start, end in spans:
        pieces += [written(text[place:start]), marks[0], written(text[start:end]), marks[1]]
        place = end
    return "".join([*pieces, written(text[place:])])
