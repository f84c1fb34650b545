"""Derivations as pages: Markdown for a code-hosting site, LaTeX for paper. Same derivation, same bytes."""

import re
from collections.abc import Iterable, Iterator
from typing import Any

from sympy import Add, Expr, MatrixBase, Mul, Symbol
from sympy.printing.latex import LatexPrinter

from symrot.proof import Derivation, Passage, Section, Step
from symrot.symbols import UNIT

__all__ = ["formula", "latex_document", "markdown"]

MANY_SECTIONS = 8
MADE = {str(symbol): symbol for symbol in UNIT}
RATES = {"dd": "ddot", "d": "dot"}
ROMAN = ("sn", "cn", "dn")


class PagePrinter(LatexPrinter):  # type: ignore[misc]
    """SymPy's LaTeX, read as a person writes it: a dot for a rate, no parentheses around a plain angle."""

    def _print_Symbol(self, symbol: Symbol, style: str = "plain") -> str:
        name = symbol.name
        if name in ROMAN:
            return rf"\mathrm{{{name}}}"
        for rate, dot in RATES.items():
            if name.startswith(rate) and name[len(rate) :] in MADE:
                letter, _, index = self._print_Symbol(MADE[name[len(rate) :]]).partition("_")
                return rf"\{dot}{{{letter}}}" + (f"_{index}" if index else "")
        return str(super()._print_Symbol(symbol))

    def _print_of_angle(self, function: Expr, exp: str | None = None) -> str:
        power = f"^{{{exp}}}" if exp else ""
        argument = function.args[0]
        inside = self._print(argument)
        if not argument.is_Symbol:
            inside = rf"\left({inside}\right)"
        return rf"\{type(function).__name__}{power} {inside}"

    _print_sin = _print_cos = _print_tan = _print_cot = _print_sec = _print_csc = _print_of_angle

    def _print_MatrixBase(self, matrix: MatrixBase) -> str:
        """Print zero as 0, the unit matrix as 1, and a common denominator of all entries in front."""
        if matrix.is_zero_matrix:
            return "0"
        if matrix.is_square and matrix.is_Identity:
            return r"\mathbf{1}"
        scale = _common_scale(matrix)
        if scale == 1:
            return str(super()._print_MatrixBase(matrix))
        scaled = matrix.applyfunc(lambda entry: entry / scale)
        return rf"{self._print(scale)} {super()._print_MatrixBase(scaled)}"

    def _print_Add(self, expr: Expr, order: str | None = None) -> str:
        """Print a sum with its positive terms first, so that few begin with a minus."""
        terms = self._as_ordered_terms(expr, order=order)
        terms = sorted(terms, key=lambda term: term.could_extract_minus_sign())  # stable
        text = ""
        for term in terms:
            negative = term.could_extract_minus_sign() and not term.is_Add
            piece = self._print(-term if negative else term)
            if self._needs_add_brackets(term):
                piece = rf"\left({piece}\right)"
            text += (" - " if negative else " + ") + piece if text else ("-" if negative else "") + piece
        return text

    _print_ImmutableDenseMatrix = _print_Matrix = _print_ImmutableMatrix = _print_MatrixBase


def _common_scale(matrix: MatrixBase) -> Any:
    """Return 1/D when every nonzero entry has the same denominator D, else 1."""
    denominators = {entry.as_numer_denom()[1] for entry in matrix if entry != 0}
    if len(denominators) != 1 or len(matrix) < 2:
        return 1
    (denominator,) = denominators
    return Mul(1, 1 / denominator) if denominator != 1 else 1


_PRINTER = PagePrinter({"mat_delim": "[", "mat_str": "matrix", "fold_short_frac": False, "ln_notation": True})


def formula(side: Any) -> str:
    """Return the LaTeX of an expression or matrix on one line; text is LaTeX already."""
    return side if isinstance(side, str) else str(_PRINTER.doprint(side)).replace("\n", " ")


def _equation(step: Step) -> str:
    left = step.named or formula(step.left)
    right = formula(step.right if step.shown is None else step.shown)
    return f"{left} = {right} > 0" if step.relation == ">" else f"{left} = {right}"


def _remarks(step: Step) -> Iterator[str]:
    """Yield the reason, what is assumed, where it holds, and where it is printed, as sentences."""
    yield f"*Why:* {step.reason}."
    if step.hypotheses:
        yield f"*Given:* {_list(map(_hypothesis, step.hypotheses))}."
    if step.conditions:
        yield f"*Where:* {_list(map(formula, step.conditions))}."
    if step.source:
        yield f"*Printed in:* {step.source}."


def _hypothesis(zero: Expr) -> str:
    """Return ``P - Q = 0`` as ``P = Q``, the terms with a minus sign on the right."""
    terms = zero.expand().as_ordered_terms()
    right = [-term for term in terms if term.could_extract_minus_sign()]
    left = [term for term in terms if not term.could_extract_minus_sign()]
    return f"{formula(Add(*left))} = {formula(Add(*right))}"


def _list(formulas: Iterable[str]) -> str:
    return ", ".join(f"${text}$" for text in formulas)


def _units(derivation: Derivation) -> str:
    """Return one sentence with the unit of every symbol that occurs."""
    sides: list[Any] = [side for step in derivation.steps for side in (step.left, step.right)]
    passages = (item for item in derivation.items if isinstance(item, Passage))
    sides += [side for passage in passages for pair in passage.equations for side in pair]
    used = {symbol for side in sides for symbol in getattr(side, "free_symbols", ())}
    groups: dict[str, list[str]] = {}
    for symbol, unit in UNIT.items():
        if symbol in used:
            groups.setdefault(unit, []).append(f"${formula(symbol)}$")
    shown = ((", ".join(names), "without unit" if unit == "1" else f"in {unit}") for unit, names in groups.items())
    return "; ".join(f"{names} {unit}" for names, unit in shown)


def _footer(derivation: Derivation) -> str:
    count = len(derivation.steps)
    return (
        f"{count} steps, each proven when this page was printed: the normal form of left minus right is zero. "
        f"Derived in `symrot/catalogue/{derivation.name}.py`, printed by `symrot derive "
        f"{derivation.name}`; do not edit."
    )


def markdown(derivation: Derivation) -> str:
    """Return a Markdown page; display formulas stand between ``$$`` on lines of their own."""
    parts = [f"# {derivation.title}"]
    if derivation.about:
        parts.append(derivation.about)
    if derivation.source:
        parts.append(f"*Source:* {derivation.source}.")
    parts += _contents(derivation)
    number = 0
    for item in derivation.items:
        if isinstance(item, Section):
            parts.append(f"## {item.title}")
        elif isinstance(item, Step):
            number += 1
            parts += [f"**{number}.** {item.claim}", _display(_equation(item)), " ".join(_remarks(item))]
        else:
            parts.append(item.text)
            parts += [_display(text) for text in _passage_equations(item)]
    units = _units(derivation)
    if units:
        parts.append(f"**Units** of the symbols in the proofs: {units}.")
    parts += ["---", _footer(derivation)]
    return "\n\n".join(map(_host_safe, parts)) + "\n"


MARKED = re.compile(r"\\[^A-Za-z]|[\])}]_|\*")
"""What Markdown would read as its own inside a formula in a line of text."""


def _host_safe(part: str) -> str:
    """Return a paragraph with formulas in the line quoted as ``$`...`$`` where Markdown would spoil them."""
    if part.startswith("$$"):
        return part
    return re.sub(r"\$([^$]+)\$", lambda m: f"$`{m[1]}`$" if MARKED.search(m[1]) else m[0], part)


def _contents(derivation: Derivation) -> Iterator[str]:
    """Yield one line of links to the sections of a long page."""
    titles = [item.title for item in derivation.items if isinstance(item, Section)]
    if len(titles) > MANY_SECTIONS:
        anchors = (re.sub("[^a-z0-9 -]", "", title.lower()).replace(" ", "-") for title in titles)
        links = (f"[{title.split(',')[0]}](#{anchor})" for title, anchor in zip(titles, anchors, strict=True))
        yield f"Sections: {' · '.join(links)}"


def _passage_equations(passage: Passage) -> Iterator[str]:
    for left, right in passage.equations:
        yield f"{formula(left)} = {formula(right)}"


def _display(text: str) -> str:
    return f"$$\n{text}\n$$"


LATEX_HEAD = r"""\documentclass[a4paper]{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage{amsmath}
\usepackage[margin=20mm]{geometry}
\setcounter{MaxMatrixCols}{12}
"""


def latex_document(derivation: Derivation) -> str:
    """Return a LaTeX document that compiles as it is."""
    parts = [LATEX_HEAD + rf"\title{{{_prose(derivation.title)}}}" + "\n\\date{}\n\\begin{document}\n\\maketitle"]
    if derivation.about:
        parts.append(_prose(derivation.about))
    if derivation.source:
        parts.append(rf"\emph{{Source:}} {_prose(derivation.source)}.")
    number = 0
    for item in derivation.items:
        if isinstance(item, Section):
            parts.append(rf"\section*{{{_prose(item.title)}}}")
        elif isinstance(item, Step):
            number += 1
            parts.append(
                rf"\paragraph{{{number}.}} {_prose(item.claim)}" + f"\n\\[\n{_equation(item)}\n\\]\n"
                + _prose(" ".join(_remarks(item)))
            )  # fmt: skip
        else:
            parts.append("\n".join([_prose(item.text), *(f"\\[\n{text}\n\\]" for text in _passage_equations(item))]))
    units = _units(derivation)
    if units:
        parts.append(rf"\paragraph{{Units}} of the symbols in the proofs: {_prose(units)}.")
    parts += [r"\medskip\hrule\medskip", _prose(_footer(derivation)), r"\end{document}"]
    return "\n\n".join(parts) + "\n"


ESCAPES = {"&": r"\&", "%": r"\%", "#": r"\#", "_": r"\_", "^": r"\^{}", "~": r"\~{}"}


def _prose(text: str) -> str:
    """Return Markdown prose as LaTeX: formulas in ``$`` stay, code and emphasis are translated, the rest is escaped."""
    pieces = re.split(r"(\$[^$]+\$|`[^`]+`)", text)
    return "".join(_piece(piece) for piece in pieces)


def _piece(piece: str) -> str:
    if piece.startswith("$"):
        return piece
    code = piece.startswith("`")
    escaped = "".join(ESCAPES.get(letter, letter) for letter in piece.strip("`" if code else ""))
    if code:
        return rf"\texttt{{{escaped}}}"
    return re.sub(r"\*([^*]+)\*", r"\\emph{\1}", escaped)
