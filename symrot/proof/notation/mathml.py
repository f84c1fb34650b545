"""Translation of LaTeX formulas into native MathML, for the part of LaTeX that the pages use.

The same reader serves HTML and line breaking: a formula becomes a row of items, each with its LaTeX, its MathML, an
estimate of its width, and whether a line may be broken before it. Unknown LaTeX raises InputError.
"""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from html import escape

from symrot.errors import InputError

__all__ = ["Item", "mathml", "read", "rows"]

TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[{}^_&]|\d+(?:\.\d+)?|\s+|.", re.DOTALL)

LETTERS = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ϵ", "zeta": "ζ", "eta": "η", "theta": "θ",
    "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ",
    "phi": "ϕ", "varphi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ",
    "Lambda": "Λ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω", "ell": "ℓ", "partial": "∂", "infty": "∞",
}  # fmt: skip
OPERATORS = {
    "times": "×", "cdot": "⋅", "le": "≤", "ge": "≥", "leq": "≤", "geq": "≥", "neq": "≠", "ne": "≠", "to": "→",
    "in": "∈", "Rightarrow": "⇒", "rightarrow": "→", "mapsto": "↦", "ldots": "…", "cdots": "⋯", "dots": "…",
    "angle": "∠", "pm": "±", "mp": "∓", "parallel": "∥", "perp": "⊥", "lbrace": "{", "rbrace": "}", "approx": "≈",
    "equiv": "≡", "sim": "∼", "circ": "∘", "mid": "∣",
}  # fmt: skip
RELATIONS = {"=", "<", ">", "≤", "≥", "≠", "→", "⇒", "↦", "∈", "≈", ":"}
LARGE = {"sum": "∑", "prod": "∏", "int": "∫"}
FUNCTIONS = {
    "sin", "cos", "tan", "cot", "sec", "csc", "det", "dim", "lim", "log", "exp", "max", "min", "sinh", "cosh", "tanh",
    "ln", "arctan",
    "arcsin", "arg",
}  # fmt: skip
SPACES = {",": 0.17, ":": 0.22, ";": 0.28, "!": -0.17, " ": 0.28, "quad": 1.0, "qquad": 2.0}
ACCENTS = {"dot": "˙", "ddot": "¨", "bar": "¯", "overline": "¯", "hat": "^", "vec": "→", "tilde": "~"}
FONTS = {
    "mathsf": "sans-serif", "mathrm": "normal", "mathbf": "bold", "mathcal": "script", "text": "normal",
    "operatorname": "normal",
}  # fmt: skip
SIZES = {"Bigl", "Bigr", "bigl", "bigr", "Big", "big"}
FENCES = {"(": "(", ")": ")", "[": "[", "]": "]", "|": "|", "\\{": "{", "\\}": "}", ".": "", "/": "/", "\\lbrace": "{",
          "\\rbrace": "}", "\\lvert": "|", "\\rvert": "|", "\\langle": "⟨", "\\rangle": "⟩"}  # fmt: skip
TABLES = {"matrix": ("", ""), "bmatrix": ("[", "]"), "pmatrix": ("(", ")"), "vmatrix": ("|", "|"), "cases": ("{", "")}
THIN = '<mspace width="0.17em"></mspace>'
BAR = '<mo stretchy="false" form="prefix" lspace="0" rspace="0">|</mo>'
WIDEST = 42  # letters to a line
SMALL = 0.75  # scripts, relative to the line


@dataclass(frozen=True)
class Item:
    """One item of a formula: LaTeX, MathML, width in letters; ``kind`` is "relation", "sign", "function" or ""."""

    latex: str
    mathml: str
    width: float
    kind: str = ""


class _Reader:
    def __init__(self, latex: str) -> None:
        self.latex = latex
        self.tokens = TOKEN.findall(latex)
        self.place = 0

    def peek(self) -> str:
        while self.place < len(self.tokens) and self.tokens[self.place].isspace():
            self.place += 1
        return self.tokens[self.place] if self.place < len(self.tokens) else ""

    def next(self) -> str:
        token = self.peek()
        if not token:
            raise InputError(f"expected a complete formula, got {self.latex!r}, which ends too early")
        self.place += 1
        return token

    def refuse(self, token: str) -> InputError:
        return InputError(f"expected LaTeX that the pages use, got {token!r} in {self.latex!r}")

    # -- rows -------------------------------------------------------------------------------------------------------

    def row(self, *stops: str) -> list[Item]:
        """Return the items of a formula up to one of the stop tokens, which is not consumed, or up to the end."""
        items: list[Item] = []
        while (token := self.peek()) not in stops and token:
            start = self.place
            item = self.scripted(bool(items) and items[-1].kind in ("", "function"))
            source = "".join(self.tokens[start : self.place])
            body = item.mathml
            if item.kind == "function":  # set off by thin spaces, but for a parenthesis after it
                body = THIN * bool(items and items[-1].kind == "") + body + THIN * (self.peek() not in ("\\left", "("))
            items.append(Item(source, body, item.width, item.kind))
        if self.peek() not in (stops or ("",)):
            raise InputError(f"expected {' or '.join(stops)} before the end of the formula {self.latex!r}")
        return items

    def argument(self) -> list[Item]:
        """Return the argument of a LaTeX command, a braced row or one token, as a list of items."""
        if self.peek() == "{":
            self.next()
            items = self.row("}")
            self.next()
            return items
        token = self.peek()
        if token.isdigit() and len(token) > 1:  # \tfrac12 is one over two
            self.tokens[self.place : self.place + 1] = list(token)
        return [self.atom(False)]

    def group(self) -> Item:
        """Return the argument of a LaTeX command as one item."""
        return _joined(self.argument())

    def scripted(self, after_operand: bool) -> Item:
        base = self.atom(after_operand)
        scripts: dict[str, Item] = {}
        while self.peek() in ("^", "_", "'"):
            mark = self.next()
            scripts["^" if mark == "'" else mark] = Item("'", "<mo>′</mo>", 0.4) if mark == "'" else self.group()
        if not scripts:
            return base
        width = base.width + SMALL * max(item.width for item in scripts.values())
        tag = {"^": "msup", "_": "msub", "^_": "msubsup"}["".join(sorted(scripts, reverse=True)).replace("_^", "^_")]
        if "lim" in base.mathml or "∑" in base.mathml:
            tag = {"msup": "mover", "msub": "munder", "msubsup": "munderover"}[tag]
        inside = "".join(scripts[mark].mathml for mark in ("_", "^") if mark in scripts)
        return Item("", f"<{tag}>{base.mathml}{inside}</{tag}>", width, base.kind)

    # -- atoms ------------------------------------------------------------------------------------------------------

    def atom(self, after_operand: bool) -> Item:
        token = self.next()
        if token.startswith("\\"):
            return self.command(token, after_operand)
        if token == "{":
            items = self.row("}")
            self.next()
            return _joined(items)
        if token[0].isdigit():
            return Item("", f"<mn>{token}</mn>", 0.6 * len(token))
        if token.isalpha():
            return Item("", f"<mi>{token}</mi>", 0.7)
        if token in "+-":
            character = "−" if token == "-" else token
            if after_operand:
                return Item("", f"<mo>{character}</mo>", 1.2, "sign")
            return Item("", f'<mo form="prefix">{character}</mo>', 0.7)
        if token in "=<>:":
            return Item("", f"<mo>{escape(token)}</mo>", 1.4, "relation")
        if token == "|":
            return Item("", BAR, 0.4)
        if token in "()[]":
            return Item("", f'<mo stretchy="false">{token}</mo>', 0.4)
        if token in ",;./!":
            return Item("", f"<mo>{token}</mo>", 0.4)
        raise self.refuse(token)

    def command(self, token: str, after_operand: bool) -> Item:
        name = token[1:]
        if name in STRUCTURES:
            return STRUCTURES[name](self)
        if name in SPACES:
            return Item("", f'<mspace width="{SPACES[name]}em"></mspace>', max(SPACES[name], 0.0))
        if name in ACCENTS:
            inner = self.group()
            return Item("", f'<mover accent="true">{inner.mathml}<mo>{ACCENTS[name]}</mo></mover>', inner.width)
        if name in FONTS:
            return self.font(FONTS[name])
        if name in LETTERS:
            return Item("", f"<mi>{LETTERS[name]}</mi>", 0.7)
        if name in FUNCTIONS:
            return Item("", "<mo>lim</mo>" if name == "lim" else f"<mi>{name}</mi>", 1.8, "function")
        if name in LARGE:
            return Item("", f'<mo largeop="true">{LARGE[name]}</mo>', 1.0)
        if name in OPERATORS:
            operator = OPERATORS[name]
            kind = "relation" if operator in RELATIONS else ""
            return Item("", f"<mo>{escape(operator)}</mo>", 1.2, kind)
        if token in FENCES:
            return Item("", f'<mo stretchy="false">{FENCES[token]}</mo>', 0.4)
        if name in SIZES:
            fence = self.next()
            return Item("", f'<mo stretchy="true" minsize="1.6em">{FENCES[fence]}</mo>', 0.5)
        raise self.refuse(token)

    def font(self, variant: str) -> Item:
        if self.peek() != "{":
            text = self.next()
        else:
            self.next()
            start = self.place
            while self.peek() != "}":
                self.next()
            text = "".join(self.tokens[start : self.place])
            self.next()
        text = text.strip() if variant != "normal" else text
        letters = "".join(_letter(letter, variant) for letter in text)
        tag = "mtext" if " " in text else "mi"
        style = ' mathvariant="normal"' if tag == "mi" else ""
        return Item("", f"<{tag}{style}>{escape(letters)}</{tag}>", 0.6 * len(text) + 0.4)

    # -- structures -------------------------------------------------------------------------------------------------

    def fraction(self) -> Item:
        small = self.tokens[self.place - 1] == "\\tfrac"
        shape = _joined if small else _stacked
        above, below = shape(self.argument()), shape(self.argument())
        body = f"<mfrac>{above.mathml}{below.mathml}</mfrac>"
        if small:
            body = f'<mstyle displaystyle="false">{body}</mstyle>'
        return Item("", body, max(above.width, below.width) * (SMALL if small else 1) + 0.3)

    def root(self) -> Item:
        if self.peek() == "[":
            self.next()
            index = _joined(self.row("]"))
            self.next()
            inner = self.group()
            return Item("", f"<mroot>{inner.mathml}{index.mathml}</mroot>", inner.width + 1)
        inner = self.group()
        return Item("", f"<msqrt>{inner.mathml}</msqrt>", inner.width + 1)

    def fenced(self) -> Item:
        opening = self.next()
        items = self.row("\\right")
        self.next()
        closing = self.next()
        inner = _joined(items)
        first, last = (_fence(mark, side) for mark, side in ((FENCES[opening], "prefix"), (FENCES[closing], "postfix")))
        return Item("", f"<mrow>{first}{inner.mathml}{last}</mrow>", inner.width + 0.8)

    def table(self) -> Item:
        name = self.environment()
        if name not in TABLES:
            raise self.refuse(f"\\begin{{{name}}}")
        lines: list[list[Item]] = [[]]
        while True:
            lines[-1].append(_joined(self.row("&", "\\\\", "\\end")))
            stop = self.next()
            if stop == "\\\\":
                lines.append([])
            elif stop == "\\end":
                break
        self.environment()
        if len(lines[-1]) == 1 and not lines[-1][0].width:
            lines.pop()
        body = "".join("<mtr>" + "".join(f"<mtd>{cell.mathml}</mtd>" for cell in line) + "</mtr>" for line in lines)
        widths = (max((line[n].width for line in lines if n < len(line)), default=0) for n in range(len(lines[0])))
        first, last = (_fence(mark, side) for mark, side in zip(TABLES[name], ("prefix", "postfix"), strict=True))
        width = sum(widths) + len(lines[0]) + 0.5
        return Item("", f"<mrow>{first}<mtable>{body}</mtable>{last}</mrow>", width)

    def environment(self) -> str:
        """Return the name of an environment, read from ``{name}``."""
        self.next()
        name = ""
        while (token := self.next()) != "}":
            name += token
        return name

    def phantom(self) -> Item:
        """Return an empty item for a style command, which is ignored."""
        return Item("", "", 0.0)


STRUCTURES: dict[str, Callable[[_Reader], Item]] = {
    "frac": _Reader.fraction,
    "tfrac": _Reader.fraction,
    "dfrac": _Reader.fraction,
    "sqrt": _Reader.root,
    "left": _Reader.fenced,
    "begin": _Reader.table,
    "displaystyle": _Reader.phantom,
    "textstyle": _Reader.phantom,
}


def _fence(mark: str, form: str) -> str:
    return f'<mo form="{form}" stretchy="true" fence="true">{mark}</mo>' if mark else ""


def _letter(letter: str, variant: str) -> str:
    """Return the Unicode character of a letter in a font, since MathML no longer has most font attributes."""
    if not (letter.isascii() and letter.isalnum()):
        return letter
    if variant == "script":
        special = {"B": "ℬ", "E": "ℰ", "F": "ℱ", "H": "ℋ", "I": "ℐ", "L": "ℒ", "M": "ℳ", "R": "ℛ"}
        return special.get(letter) or chr((0x1D49C if letter.isupper() else 0x1D4B6) + ord(letter.upper()) - ord("A"))
    starts = {"bold": (0x1D400, 0x1D41A, 0x1D7CE), "sans-serif": (0x1D5A0, 0x1D5BA, 0x1D7E2)}.get(variant)
    if starts is None:
        return letter
    upper, lower, digit = starts
    if letter.isdigit():
        return chr(digit + int(letter))
    return chr(upper + ord(letter) - ord("A")) if letter.isupper() else chr(lower + ord(letter) - ord("a"))


def _joined(items: list[Item]) -> Item:
    body = "".join(item.mathml for item in items)
    return Item("", body if len(items) == 1 and body.count("<mspace") == 0 else f"<mrow>{body}</mrow>",
                sum(item.width for item in items))  # fmt: skip


def read(latex: str) -> list[Item]:
    """Return a formula as a row of items.

    Raises
    ------
    InputError
        For unsupported LaTeX.
    """
    return _Reader(latex).row()


def rows(latex: str, width: float) -> list[list[Item]]:
    """Return a formula broken into lines of a given width where possible: before relations, then before signs."""
    return _broken(read(latex), width)


def _broken(items: list[Item], width: float) -> list[list[Item]]:
    if sum(item.width for item in items) <= width:
        return [items]
    lines: list[list[Item]] = []
    for piece in _pieces(items, "relation"):
        if not lines or sum(i.width for i in [*lines[-1], *piece]) > width or len(lines) == 1:
            lines.append([])
        for term in _pieces(piece, "sign"):
            if lines[-1] and sum(item.width for item in [*lines[-1], *term]) > width:
                lines.append([])
            lines[-1].extend(term)
    return [line for line in lines if line]


def _stacked(items: list[Item]) -> Item:
    """Return a row of items as one item; a long sum becomes several lines."""
    lines = _broken(items, WIDEST)
    if len(lines) == 1:
        return _joined(items)
    body = "".join(f"<mtr><mtd>{''.join(item.mathml for item in line)}</mtd></mtr>" for line in lines)
    return Item("", f"<mtable>{body}</mtable>", max(sum(item.width for item in line) for line in lines))


def _pieces(items: list[Item], kind: str) -> Iterator[list[Item]]:
    """Yield the parts of a row, which is split before each item of a kind."""
    piece: list[Item] = []
    for item in items:
        if item.kind == kind and piece:
            yield piece
            piece = []
        piece.append(item)
    yield piece


def mathml(latex: str, *, display: bool = False, width: float = WIDEST) -> str:
    """Return a LaTeX formula as a MathML ``math`` element; a display that is too wide is broken into lines."""
    start = '<math xmlns="http://www.w3.org/1998/Math/MathML"' + (' display="block"' if display else "") + ">"
    lines = rows(latex, width) if display else [read(latex)]
    if len(lines) == 1:
        return f"{start}{_joined(lines[0]).mathml}</math>"
    body = ""
    for number, line in enumerate(lines):
        indent = '<mspace width="2em"></mspace>' if number else ""
        body += f"<mtr><mtd>{indent}{''.join(item.mathml for item in line)}</mtd></mtr>"
    return f'{start}<mtable displaystyle="true" class="lines">{body}</mtable></math>'
