"""Sheets of exercises as a LaTeX document: first the exercises, then hints and solutions."""

import re
from collections.abc import Sequence

from symrot.exercises.exercise import Exercise, related
from symrot.exercises.formats.figures import tikz
from symrot.exercises.formats.markdown import data_text

__all__ = ["latex_sheet"]

HEAD = r"""\documentclass[a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage{amsmath}
\usepackage{graphicx}
\usepackage{tikz}
\usepackage[margin=22mm]{geometry}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
\setlength{\emergencystretch}{3em}
\newsavebox{\displayed}
% a display that is wider than the page is scaled to it
\newcommand{\fitted}[1]{\sbox{\displayed}{$\displaystyle #1$}\[\ifdim\wd\displayed>\linewidth
  \resizebox{\linewidth}{!}{\usebox{\displayed}}\else\usebox{\displayed}\fi\]}
\begin{document}
"""
ESCAPES = {"&": r"\&", "%": r"\%", "#": r"\#", "_": r"\_", "^": r"\^{}", "~": r"\~{}", "°": r"\textdegree{}"}


def latex_sheet(exercises: Sequence[Exercise], title: str, statements: bool, solutions: bool) -> str:
    """Return a LaTeX document with the statements of exercises, or with their hints and solutions, or with both."""
    parts = [HEAD + rf"\section*{{{prose(title)}}}"]
    for number, exercise in enumerate(exercises if statements else (), 1):
        questions = "\n".join(rf"\item[({each.key})] {prose(each.prompt)}" for each in exercise.questions)
        parts += [
            rf"\subsection*{{{number}. {prose(exercise.title)}}}",
            prose(exercise.statement),
            *(f"\\nopagebreak\n\\begin{{center}}\n{tikz(svg)}\n\\end{{center}}" for svg in [exercise.figure] if svg),
            prose(data_text(exercise.data)),
            f"\\begin{{itemize}}\n{questions}\n\\end{{itemize}}",
        ]
    if not solutions:
        return "\n\n".join([*parts, r"\end{document}"]) + "\n"
    parts.append("\\clearpage\n\\section*{Hints}" if statements else r"\subsection*{Hints}")
    for number, exercise in enumerate(exercises, 1):
        hints = "\n".join(rf"\item {prose(hint)}" for hint in exercise.hints)
        parts.append(rf"\textbf{{{number}.}}" + f"\n\\begin{{enumerate}}\n{hints}\n\\end{{enumerate}}")
    if statements:
        parts.append("\\clearpage\n\\section*{Solutions}")
    for number, exercise in enumerate(exercises, 1):
        parts.append(rf"\subsection*{{{number}. {prose(exercise.title)}}}")
        parts += [f"{prose(line.reason)}\n\\fitted{{{line.latex}}}" for line in exercise.solution]
        answers = (f"({each.key}) ${each.name} {related(each.latex)}$" for each in exercise.questions)
        parts.append(rf"\textbf{{Answers:}} {'; '.join(answers)}.")
    return "\n\n".join([*parts, r"\end{document}"]) + "\n"


def prose(text: str) -> str:
    """Return Markdown as LaTeX; displayed formulas that are wider than a line are scaled to fit."""
    pieces = re.split(r"(\$\$.+?\$\$|\$[^$]+\$)", text)
    return "".join(_piece(piece) for piece in pieces)


def _piece(piece: str) -> str:
    if piece.startswith("$$"):
        return rf"\fitted{{{piece.strip('$')}}}"
    if piece.startswith("$"):
        return piece
    return "".join(ESCAPES.get(letter, letter) for letter in piece)
