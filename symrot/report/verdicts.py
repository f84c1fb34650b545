"""Verdicts on claims as text: in full for one claim, as a list with a count for a file of claims."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any

from symrot.checker.marks import carets
from symrot.checker.verdict import Repair, Verdict
from symrot.errors import InputError
from symrot.report.layout import duration, one_line, room

__all__ = ["check", "lines"]

INDENT = 18
"""The column at which the texts of a verdict begin, after their labels."""

VERDICTS = ("true", "false", "conditional", "undecided", "recognised", "doubtful", "definition", "refused")
"""All verdicts on claims, in their order in the line of counts below a list, such as "3 true, 1 false"."""


def check(
    source: str,
    assumptions: Sequence[str],
    units: Sequence[str],
    repair: bool,
    progress: Callable[[str], None] = lambda text: None,
    stated: Mapping[str, Any] | None = None,
) -> list[Verdict]:
    """Check a claim (an equation as text or LaTeX), or all claims of a file, and return the verdicts.

    Parameters
    ----------
    source : str
        The claim, or the path of the file.
    assumptions : sequence of str
        Hypotheses of the claim, such as ``"A > 0"``.
    units : sequence of str
        Units of the claim's quantities, such as ``"F=kg m/s^2"``.
    repair : bool
        Whether to search for a correction of each false claim.
    progress : callable
        Called with a line of text before the check of each claim of a file.
    stated : mapping, optional
        The context of the claim, as further keyword arguments of :func:`symrot.check`.

    Raises
    ------
    InputError
        For a text that :func:`symrot.check` rejects, or a file without claims. Also for a file together with
        ``assumptions``, ``units`` or ``stated``, because a file states these itself.
    """
    from symrot.checker.interface import check as check_text
    from symrot.checker.interface import verdicts_of_file

    if not _is_file(source):
        return [check_text(source, assume=assumptions, units=_units(units), repair=repair, **(stated or {}))]
    if not source.endswith(".toml") and not Path(source).is_file():
        raise InputError(f"expected a claim 'left == right' or the path of a file of claims, got {source[:60]!r}")
    if units:
        raise InputError("--unit: expected a claim as text, got a file; state the units in the file instead")
    if assumptions:
        raise InputError("--given: expected a claim as text, got a file; state the hypotheses in the file instead")
    for option, value in (stated or {}).items():
        if value:
            raise InputError(f"--{option}: expected a claim as text, got a file; state this in the file instead")
    # a claim that cannot be parsed gets the verdict "refused"
    return list(verdicts_of_file(source, repair, progress))


def _units(words: Sequence[str]) -> dict[str, str]:
    """Return a map from the name of each quantity to its unit, from texts such as ``F=kg m/s^2``."""
    pairs = [word.partition("=") for word in words]
    for word, (name, sign, unit) in zip(words, pairs, strict=True):
        if not (name.strip() and sign and unit.strip()):
            raise InputError(f"--unit: expected NAME=UNIT like 'F=kg m/s^2', got {word[:60]!r}")
    return {name.strip(): unit for name, _, unit in pairs}


SIGNS = "=≈≃≤≥⩽⩾<>≠"
"""The signs of relations. Every claim as text has one of them, or a backslash if it is LaTeX."""


def _is_file(source: str) -> bool:
    """Return whether ``source``, the argument of `symrot check`, is taken as the path of a file and not as a claim.

    The name of an existing file that ends with .toml is a path, unless it contains ``==``. Any other text is a claim if
    it contains a relation sign (:data:`SIGNS`), or if it contains a backslash, as LaTeX does, and does not end with
    .toml. All remaining texts are paths.
    """
    is_text = any(sign in source for sign in SIGNS) or ("\\" in source and not source.endswith(".toml"))
    return not is_text or (source.endswith(".toml") and "==" not in source and Path(source).is_file())


def lines(verdicts: Sequence[Verdict], source: str) -> list[str]:
    """Return the lines that `symrot check` prints about verdicts; ``source`` is the claim or the file's path."""
    if len(verdicts) == 1 and not _is_file(source):
        return _full(verdicts[0], verdicts[0].verdict)
    text: list[str] = []
    for verdict in verdicts:
        place = f" ({one_line(verdict.where)})" if verdict.where else ""
        name = f"{verdict.verdict:<11} {one_line(verdict.id)}{place}"
        # true claims take one line, all others are shown in full
        text += [name] if verdict else _full(verdict, name)
    counts = Counter(verdict.verdict for verdict in verdicts)
    total = ", ".join(f"{counts[name]} {name}" for name in VERDICTS if counts[name])
    seconds = duration(sum(verdict.seconds for verdict in verdicts))
    return [*text, "", f"{len(verdicts)} claim{'s' if len(verdicts) != 1 else ''}: {total}, in {seconds}"]


def _full(verdict: Verdict, head: str) -> list[str]:
    rows = [head]
    repairs = {f"{repair.text}  {repair.note}": repair for repair in verdict.repairs}
    for name, text in verdict.facts():
        lines = wrap(one_line(text), room(), initial_indent=f"  {name + ':':<16}", subsequent_indent=" " * INDENT,
                     break_long_words=False, break_on_hyphens=False)  # fmt: skip
        repair = repairs.get(text) if "instead" in name else None
        rows += lines if repair is None else _with_carets(lines, repair)
    return rows


def _with_carets(lines: Sequence[str], repair: Repair) -> list[str]:
    """Return the lines of a corrected claim, with carets (^) below the characters that the correction changed.

    ``lines`` are the text of the correction ``repair``, broken and indented.
    """
    rows, place = [], 0
    for line in lines:
        piece = line[INDENT:]
        place = repair.text.find(piece[:1], place) if piece else place
        end = place + len(piece)
        marks = carets(repair.changed, place, min(end, len(repair.text)))
        rows += [line, " " * INDENT + marks] if marks else [line]
        place = end
    return rows
