"""Code blocks of a Markdown page: find them, run them, and compare their output with the output that the page shows.

A comment on the line above a block says how the test treats the block:

``<!-- file: NAME -->``
    The block is a file that later blocks of the page use.
``<!-- exit: N -->``
    Each command of the block ends with exit code N (0 without the comment); its messages count as output.
``<!-- diagram -->``
    The block is a drawing.
``<!-- not run: REASON -->``
    The block is not run. The test states the number of such blocks.

Python blocks run in the order of the page and share their names. Lines of a ``sh`` block run one after another. A
``text`` block below a block that runs is its expected output: ``...`` on a line of its own stands for any number of
lines, numbers must agree to nine digits, rounding noise below 1e-12 agrees with other noise, and times are not
compared.
"""

import contextlib
import io
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from symrot.cli.main import main

__all__ = ["Block", "agree", "blocks", "run_block"]

FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
DIRECTIVE = re.compile(r"<!-- (file|exit|diagram|not run|test command)(?:: (.*?))? -->\n\Z")
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?")
TIME = re.compile(r"\b\d[\d.]* (ns|us|ms|s)\b")
NOISE = 1e-12
DIGITS = 1e-9


@dataclass(frozen=True)
class Block:
    """A block of code: its language and text, the line where it begins, and the comment above it."""

    language: str
    text: str
    line: int
    directive: str = ""
    argument: str = ""
    output: str | None = None

    @property
    def runs(self) -> bool:
        return self.directive not in ("diagram", "not run", "test command")


def blocks(page: str) -> Iterator[Block]:
    """Yield the blocks of a page, each with the ``text`` block directly below it as its output."""
    matches = list(FENCE.finditer(page))
    outputs: set[int] = set()
    for k, match in enumerate(matches):
        if k in outputs:
            continue
        mark = DIRECTIVE.search(page[: match.start()])
        directive, argument = (mark[1], mark[2] or "") if mark else ("", "")
        output = None
        below = matches[k + 1] if k + 1 < len(matches) else None
        runs = directive in ("", "exit") and match[1] in ("python", "sh")
        if runs and below and below[1] == "text" and not page[match.end() : below.start()].strip():
            output = below[2]
            outputs.add(k + 1)
        yield Block(match[1], match[2], page.count("\n", 0, match.start()) + 1, directive, argument, output)


def run_block(block: Block, names: dict[str, Any], directory: Path) -> str:
    """Run a block in the current directory; return what it prints."""
    if block.directive == "file":
        (directory / block.argument).write_text(block.text, encoding="utf-8")
        return ""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed if block.argument else sys.stderr):
        if block.language == "python":
            exec(compile(block.text, f"<line {block.line}>", "exec"), names)
        elif block.language == "sh":
            for line in block.text.replace("\\\n", " ").splitlines():
                _run_line(line, int(block.argument or 0))
        else:
            raise ValueError(f"line {block.line}: a block of {block.language!r} needs a comment that says what it is")
    return printed.getvalue()


def _run_line(line: str, code: int) -> None:
    words = shlex.split(line, comments=True)
    if not words:
        return
    if words[0] == "symrot":
        ended = main(words[1:])
    else:
        program = [sys.executable, *words[1:]] if words[0] == "python" else words
        done = subprocess.run(program, capture_output=True, text=True)
        print(done.stdout, end="")
        ended = done.returncode
        assert ended == code, f"{line}: exit code {ended}\n{done.stderr}"
    assert ended == code, f"{line}: exit code {ended}, expected {code}"


def agree(shown: str, printed: str) -> bool:
    """Return whether the output that a page shows agrees with the printed output."""
    return _lines_agree(_lines(shown), _lines(printed))


def _lines(text: str) -> list[str]:
    return [" ".join(line.split()) for line in text.splitlines() if line.strip()]


def _lines_agree(shown: list[str], printed: list[str]) -> bool:
    if not shown:
        return not printed
    if shown[0] == "...":
        return any(_lines_agree(shown[1:], printed[k:]) for k in range(len(printed) + 1))
    return bool(printed) and _line_agrees(shown[0], printed[0]) and _lines_agree(shown[1:], printed[1:])


def _line_agrees(shown: str, printed: str) -> bool:
    if shown.startswith("cost"):
        shown, printed = TIME.sub("TIME", shown), TIME.sub("TIME", printed)
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    return all(_number_agrees(a, b) for a, b in zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True))


def _number_agrees(shown: str, printed: str) -> bool:
    if shown == printed:
        return True
    if "." not in shown and "." not in printed:
        return False
    a, b = float(shown), float(printed)
    return max(a, b) < NOISE or abs(a - b) <= DIGITS * max(a, b)
