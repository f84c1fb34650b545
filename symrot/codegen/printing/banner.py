"""The head comment of every emitted file: title, arguments, domain, contract, cost, derivation and release.

The contract, present in C files only, names the certificate (the file with proofs and error bounds of the code), the
assumptions of these proofs, and the compiler flags under which they hold.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, groupby, repeat
from textwrap import wrap

from symrot import __version__
from symrot.formula.program import Argument, Program

__all__ = ["CONTRACT", "Description", "banner", "cost"]

WIDTH = 110
LONGEST = 116  # largest length of a domain that is printed in one line
WIDEST = 56  # largest width of an aligned column; a longer entry shifts the rest of its row
ARITHMETIC = ("mul", "add", "neg", "div")  # operations that the line of costs lists before all functions

CONTRACT = (  # lines in the head of a C file: place of the certificate, its assumptions, compiler flags
    ("Certificate", "{kernel}.cert.json; re-check it by `python recheck.py {kernel}.cert.json` or `symrot audit`"),
    ("Assumes", "IEEE 754 arithmetic, rounding to nearest; outputs do not overlap inputs; for bounds of rounding "
     "errors, functions of <math.h> within 1 unit in the last place"),
    ("Flags", "-ffp-contract=off for the bits of this text, bounds hold without it; -ffast-math, -Ofast and their "
     "parts void the certificate"),
)  # fmt: skip


@dataclass(frozen=True)
class Description:
    """Texts in the head comment of an emitted file that do not follow from the program."""

    title: str  # what the kernel computes
    domain: str  # for which inputs it is valid
    derivation: str  # the page that derives it
    command: str  # the command that prints the file
    convention: str = "body axes; quaternion scalar first, Hamilton, body to space (symrot conventions)"
    contract: tuple[tuple[str, str], ...] = ()  # further lines (heading, text); {kernel} stands for the kernel's name


def _domain(domain: str) -> list[str]:
    """Return the lines of a head comment that state for which inputs a kernel is valid: one line, unless very long."""
    line = f"Domain: {domain}."
    return [line] if len(line) <= LONGEST else wrap(line, WIDTH, subsequent_indent="    ")


def _harmless(text: str) -> str:
    """Return ``text`` in printable ASCII, without trigraphs and end marks, so that it is safe inside a comment."""
    text = text.replace("\\", "/").replace('"""', "'''")
    text = re.sub(r"(?<=\*)(?=/)|(?<=/)(?=[*/])|(?<=\?)(?=\?)", " ", text)  # breaks ends of comments and trigraphs
    # the checker of certified C accepts only ASCII; compilers warn about characters that reverse a line
    return re.sub(r"[^ -~]", lambda letter: f"<U+{ord(letter[0]):04X}>", text)


def cost(program: Program) -> str:
    """Return the numbers of operations of a program as a text, e.g. ``5 mul, 3 add, 1 div, 2 sin, 2 cos``."""
    counts = program.operations()
    order = [*ARITHMETIC, *sorted(set(counts) - set(ARITHMETIC))]
    return ", ".join(f"{counts[name]} {name}" for name in order if counts[name]) or "none"


def _rows(argument: Argument) -> list[tuple[str, str, str, str]]:
    """Return the rows of the table of arguments for one argument, each as (argument, components, unit, meaning)."""
    size = "" if argument.is_scalar else f"[{argument.size}]"
    heads = chain([f"{argument.role:<4} {argument.name}{size}"], repeat(""))
    # components with equal unit and meaning share a row; the meaning of a scene's constant is its formula and value
    groups = groupby(argument.components, key=lambda component: component[1:])
    return [
        (head, _listed([name for name, *_ in components]), unit, meaning)
        for head, ((unit, meaning), components) in zip(heads, groups, strict=False)
    ]


def _listed(names: Sequence[str]) -> str:
    """Return names separated by commas, such as ``q0, q1, q2``; if this exceeds a line, ``first .. last``."""
    every = ", ".join(names)
    return every if len(every) <= WIDTH else f"{names[0]} .. {names[-1]}"


def _arguments(arguments: Iterable[Argument]) -> list[str]:
    """Return the lines of the table of arguments in a head comment: role and name, components, unit, meaning."""
    rows = [row for argument in arguments for row in _rows(argument)]
    widths = [min(max(len(row[column]) for row in rows), WIDEST) for column in range(3)]
    lines = []
    for row in rows:
        start = "".join(f"{text:<{width}}  " for text, width in zip(row, widths, strict=False))
        indent = " " * (sum(widths) + 2 * len(widths))
        lines += wrap(row[3], WIDTH, initial_indent=start, subsequent_indent=indent) or [start.rstrip()]
    return lines


def banner(program: Program, description: Description, start: str, each: str, end: str) -> list[str]:
    """Return the lines of the head comment of an emitted file.

    Parameters
    ----------
    program : Program
        The kernel.
    description : Description
        The texts that do not follow from the program: title, domain, derivation, command.
    start, each, end : str
        Comment marks of the language: the first line, the start of each line, and the last line.
    """
    name = program.signature.name
    lines = [*wrap(_harmless(" ".join(f"{name}: {description.title}".split())), WIDTH), ""]
    lines += _arguments(argument for argument in program.signature.arguments if argument.size)
    lines += [
        "",
        f"Convention: {description.convention}.",
        *_domain(description.domain),
        *(line for heading, text in description.contract
          for line in wrap(f"{heading}: {text.replace('{kernel}', name)}.", WIDTH, subsequent_indent="    ")),
        f"Cost: {cost(program)}.",
        f"Derivation: {description.derivation}",
        f"Generated by symrot {__version__}, `{description.command}`; do not edit.",
    ]  # fmt: skip
    return [start, *(f"{each} {_harmless(line)}".rstrip() for line in lines), end]
