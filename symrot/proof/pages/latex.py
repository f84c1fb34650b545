"""Printer of derivations as LaTeX: one page as a document, or many pages as a book.

The same pages always give the same bytes.
"""

import re
from collections.abc import Iterator, Mapping, Sequence

from symrot.proof.notation.mathml import rows
from symrot.proof.page import Figure, Page, Passage, Section, Step, Table
from symrot.proof.pages.parts import equation, footer, passage_equations, remarks, repetitions, table_rows, units

__all__ = ["latex_book", "latex_document"]

WIDTH = 62  # letters per line of a displayed formula
LONGEST_INLINE = 120  # letters of LaTeX; a longer formula in a sentence is displayed on a line of its own

SHARE_OF_WIDE = 0.75
"""The fraction of the line width that the columns with long formulas of a table share equally."""

PACKAGES = r"""\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\IfFileExists{lmodern.sty}{\usepackage{lmodern}}{}
\usepackage{amsmath}
\usepackage{longtable}
\usepackage{graphicx}
\usepackage[margin=20mm]{geometry}
\setcounter{MaxMatrixCols}{12}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt plus 2pt}
\setlength{\emergencystretch}{3em}
\newsavebox{\displayed}
% a display that is wider than the page is scaled to it
\newcommand{\fitted}[1]{\sbox{\displayed}{$\displaystyle #1$}\[\ifdim\wd\displayed>\linewidth
  \resizebox{\linewidth}{!}{\usebox{\displayed}}\else\usebox{\displayed}\fi\]}
% a figure that is wider than a line is scaled to it
\newcommand{\drawn}[1]{\sbox{\displayed}{\includegraphics{#1}}\centerline{\ifdim\wd\displayed>\linewidth
  \resizebox{\linewidth}{!}{\usebox{\displayed}}\else\usebox{\displayed}\fi}}
% a formula in a table that is wider than its share of the line is scaled to it
\newcommand{\fittedcell}[2]{\sbox{\displayed}{$#2$}\ifdim\wd\displayed>#1\linewidth
  \sbox{\displayed}{\resizebox{#1\linewidth}{!}{\usebox{\displayed}}}\fi
  \rule[-\dimexpr\dp\displayed+2pt]{0pt}{\dimexpr\ht\displayed+\dp\displayed+4pt}\usebox{\displayed}}
"""

DOCUMENT = (
    "\\documentclass[a4paper]{article}\n"
    + PACKAGES
    + r"""% a link to another page is its title
\newcommand{\pagelink}[2]{#2}
"""
)

BOOK = (
    "\\documentclass[a4paper,oneside]{book}\n"
    + PACKAGES
    + r"""\usepackage[hidelinks]{hyperref}
% the header of a page is the title of its chapter
\renewcommand{\chaptermark}[1]{\markboth{\small #1}{}}
\renewcommand{\sectionmark}[1]{}
% a link to another page of the book; the title alone if the book does not have that page
\newcommand{\pagelink}[2]{\ifcsname r@#1\endcsname\hyperref[#1]{#2}\else#2\fi}
"""
)


def latex_document(page: Page) -> str:
    """Return a page as a LaTeX document."""
    head = DOCUMENT + rf"\title{{{_prose(page.title)}}}" + "\n\\date{}\n\\begin{document}\n\\maketitle"
    return "\n\n".join([head, *_body(page), r"\end{document}"]) + "\n"


def latex_book(title: str, about: str, chapters: Mapping[str, Sequence[Page]]) -> str:
    r"""Return pages as one LaTeX book with a table of contents and links between its pages.

    Parameters
    ----------
    title, about : str
        The title of the book, and a paragraph below it.
    chapters : mapping of str to sequence of Page
        A map from the title of a part to its pages, in reading order. An empty title is not printed.

    Examples
    --------
    >>> r"\chapter{Spin}\label{spin}" in latex_book("Mechanics", "All of it.", {"First": [Page("spin", "Spin")]})
    True
    """
    below = rf"\date{{\parbox{{0.8\linewidth}}{{\normalsize {_prose(about)}}}}}"
    head = rf"\title{{{_prose(title)}}}" + f"\n{below}\n\\begin{{document}}\n\\maketitle"
    # LaTeX must run twice: contents and links need the numbers of the first run
    parts = [BOOK + head, r"\tableofcontents"]
    for chapter, pages in chapters.items():
        parts += [rf"\part{{{_prose(chapter)}}}"] if chapter else []
        for page in pages:
            parts += [rf"\chapter{{{_prose(page.title)}}}\label{{{page.name}}}", *_body(page)]
    return "\n\n".join([*parts, r"\end{document}"]) + "\n"


def _body(page: Page) -> Iterator[str]:
    """Yield the paragraphs of a page as LaTeX, in order, without the page's title."""
    parts: list[str] = []
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
    yield from [*parts, r"\medskip\hrule\medskip", _prose(footer(page))]


def _figure(figure: Figure) -> str:
    """Return a figure in LaTeX: the picture, and below it the caption."""
    path = figure.file.removesuffix(".svg")
    # a PDF file in ``figures``, left out if it does not exist when LaTeX runs
    included = rf"\IfFileExists{{{path}.pdf}}{{\drawn{{{path}.pdf}}}}{{}}"
    return f"{included}\n\n" + rf"\emph{{Figure:}} {_prose(figure.caption)}"


def _table(table: Table, number: int) -> str:
    """Return a table of a page in LaTeX; ``number`` is the number of the last step before the table."""
    cells = [*table_rows(table, number)]
    wide = sum(max(map(len, column)) > LONGEST_INLINE for column in zip(*cells, strict=True))
    share = f"{SHARE_OF_WIDE / max(wide, 1):.2f}"
    head, *rows = (" & ".join(_cell(cell, share) for cell in row) + r" \\[4pt]" for row in cells)
    # the table may go over several sheets of paper
    columns = "l" * len(cells[0])
    body = "\n".join(rows)
    return (
        "{\\footnotesize\\setlength{\\tabcolsep}{3pt}\\setlength{\\arraycolsep}{2pt}\n"
        f"\\begin{{longtable}}{{{columns}}}\n{head}\n\\hline\n\\endhead\n{body}\n\\end{{longtable}}}}"
    )


def _cell(cell: str, share: str) -> str:
    """Return a cell of a table in LaTeX; a long formula shrinks to ``share``, the part of the line for its column."""
    is_long = re.fullmatch(r"\$[^$]+\$", cell) and len(cell) > LONGEST_INLINE
    return rf"\fittedcell{{{share}}}{{{cell.strip('$')}}}" if is_long else _prose(cell)


def _passage(passage: Passage) -> str:
    return "\n".join([_prose(passage.text), *map(_display, passage_equations(passage))])


def _display(latex: str) -> str:
    """Return a LaTeX formula as a display of its own, broken into lines if it is wider than WIDTH letters."""
    lines = ["".join(item.latex for item in line) for line in rows(latex, WIDTH)]
    if len(lines) == 1:
        return f"\\fitted{{{latex}}}"
    body = " \\\\\n".join(f"&{line}" if number == 0 else f"&\\quad{{}}{line}" for number, line in enumerate(lines))
    return f"\\fitted{{\\begin{{aligned}}\n{body}\n\\end{{aligned}}}}"


ESCAPES = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "&": r"\&",
    "%": r"\%",
    "#": r"\#",
    "_": r"\_",
    "^": r"\^{}",
    "~": r"\~{}",
}


def _prose(text: str) -> str:
    """Return Markdown prose as LaTeX: code, links and emphasis are translated.

    Formulas in ``$`` stay as they are; those longer than LONGEST_INLINE letters are displayed on lines of their own.
    """
    text = re.sub(r"`[^`]+`|\*\*(.+?)\*\*", lambda m: m[0] if m[1] is None else f"\1{m[1]}\2", text)
    pieces = re.split(r"(\$[^$]+\$[.,;]?|`[^`]+`|\[[^\]]+\]\([^)]+\.md\))", text)
    return "".join(_piece(piece) for piece in pieces).replace("\1", r"\textbf{").replace("\2", "}")


def _piece(piece: str) -> str:
    if piece.startswith("$"):
        body, stop = piece[1:].split("$")
        return rf"\fitted{{{body}{stop}}}" if len(body) > LONGEST_INLINE else piece
    link = re.fullmatch(r"\[([^\]]+)\]\(([^)]+)\.md\)", piece)
    if link:
        return rf"\pagelink{{{link[2]}}}{{{_prose(link[1])}}}"
    code = piece.startswith("`")
    escaped = "".join(ESCAPES.get(letter, letter) for letter in piece.strip("`" if code else ""))
    if code:
        straight = escaped.replace("'", r"\textquotesingle{}").replace("--", "-{}-")  # as a shell needs them
        breakable = re.sub(r"(?<=[,(*])(?=[^*])|(?<=\\_)", r"\\allowbreak{}", straight)
        return rf"\texttt{{{breakable}}}"
    raised = re.sub(r"\\\^\{\}(\d+)", r"\\textsuperscript{\1}", escaped)
    return re.sub(r"\*([^*]+)\*", r"\\emph{\1}", raised)
