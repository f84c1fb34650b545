"""Printer of derivations as complete LaTeX documents; a derivation always gives the same bytes."""

import re

from symrot.proof.notation.mathml import rows
from symrot.proof.page import Figure, Page, Passage, Section, Step, Table
from symrot.proof.pages.parts import equation, footer, passage_equations, remarks, repetitions, table_rows, units

__all__ = ["latex_document"]

WIDTH = 62  # letters per line of a displayed formula

LATEX_HEAD = r"""\documentclass[a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\IfFileExists{lmodern.sty}{\usepackage{lmodern}}{}
\usepackage{amsmath}
\usepackage{booktabs,longtable}
\usepackage{graphicx}
\usepackage[margin=20mm]{geometry}
\setcounter{MaxMatrixCols}{12}
\setlength{\parindent}{0pt}
\setlength{\emergencystretch}{3em}
\newsavebox{\displayed}
% a display that is wider than the page is scaled to it
\newcommand{\fitted}[1]{\sbox{\displayed}{$\displaystyle #1$}\[\ifdim\wd\displayed>\linewidth
  \resizebox{\linewidth}{!}{\usebox{\displayed}}\else\usebox{\displayed}\fi\]}
"""


def latex_document(page: Page) -> str:
    """Return a page as a LaTeX document."""
    parts = [LATEX_HEAD + rf"\title{{{_prose(page.title)}}}" + "\n\\date{}\n\\begin{document}\n\\maketitle"]
    parts += [_figure(item) if isinstance(item, Figure) else _passage(item) for item in page.opening]
    if page.about:
        parts.append(_prose(page.about))
    if page.source:
        parts.append(rf"\emph{{Source:}} {_prose(page.source)}.")
    number, repeats = page.first - 1, repetitions(page)
    for item in page.items:
        if isinstance(item, Section):
            parts.append(rf"\section*{{{_prose(item.title)}}}")
        elif isinstance(item, Step):
            number += 1
            parts.append(
                rf"\paragraph{{{number}.}} {_prose(item.claim)}" + f"\n{_display(equation(item))}\n"
                + _prose(" ".join(remarks(item, number in repeats)))
            )  # fmt: skip
        elif isinstance(item, Figure):
            parts.append(_figure(item))
        elif isinstance(item, Table):
            parts += [_prose(item.text), _table(item, number)]
            number += len(item.steps)
        else:
            parts.append(_passage(item))
    used = units(page)
    if used:
        parts.append(rf"\paragraph{{Units}} of the symbols in the proofs: {_prose(used)}.")
    parts += [
        rf"\section*{{{_prose(item.title)}}}" if isinstance(item, Section) else _passage(item) for item in page.closing
    ]
    parts += [r"\medskip\hrule\medskip", _prose(footer(page)), r"\end{document}"]
    return "\n\n".join(parts) + "\n"


def _figure(figure: Figure) -> str:
    """Return a figure in LaTeX: its caption, above it the picture if its PDF file exists when LaTeX runs."""
    path = figure.file.removesuffix(".svg")
    included = rf"\IfFileExists{{{path}.pdf}}{{\centerline{{\includegraphics[width=0.7\linewidth]{{{path}.pdf}}}}}}{{}}"
    return f"{included}\n\n" + rf"\emph{{Figure:}} {_prose(figure.caption)}"


def _table(table: Table, number: int) -> str:
    """Return a table in LaTeX, which may go over several pages."""
    head, *rows = (" & ".join(map(_prose, cells)) + r" \\" for cells in table_rows(table, number))
    columns = "l" * (head.count(" & ") + 1)
    body = "\n\\addlinespace\n".join(rows)
    return (
        "{\\footnotesize\\setlength{\\tabcolsep}{3pt}\\setlength{\\arraycolsep}{2pt}\n"
        f"\\begin{{longtable}}{{{columns}}}\n{head}\n\\midrule\n\\endhead\n{body}\n\\end{{longtable}}}}"
    )


def _passage(passage: Passage) -> str:
    return "\n".join([_prose(passage.text), *map(_display, passage_equations(passage))])


def _display(latex: str) -> str:
    """Return a displayed formula in LaTeX, broken into lines if it is long."""
    lines = ["".join(item.latex for item in line) for line in rows(latex, WIDTH)]
    if len(lines) == 1:
        return f"\\fitted{{{latex}}}"
    body = " \\\\\n".join(f"&{line}" if number == 0 else f"&\\quad{{}}{line}" for number, line in enumerate(lines))
    return f"\\fitted{{\\begin{{aligned}}\n{body}\n\\end{{aligned}}}}"


ESCAPES = {"&": r"\&", "%": r"\%", "#": r"\#", "_": r"\_", "^": r"\^{}", "~": r"\~{}"}


def _prose(text: str) -> str:
    """Return Markdown prose as LaTeX: formulas in ``$`` stay as they are; code, links and emphasis are translated."""
    linked = re.sub(r"\[([^\]$]+)\]\([^)]+\.md\)", r"\1", text)
    pieces = re.split(r"(\$[^$]+\$|`[^`]+`)", linked)
    return "".join(_piece(piece) for piece in pieces)


def _piece(piece: str) -> str:
    if piece.startswith("$"):
        return piece
    code = piece.startswith("`")
    escaped = "".join(ESCAPES.get(letter, letter) for letter in piece.strip("`" if code else ""))
    if code:
        return rf"\texttt{{{escaped}}}"
    return re.sub(r"\*([^*]+)\*", r"\\emph{\1}", escaped)
