"""Translation of LaTeX formulas into native MathML, for the part of LaTeX that the pages of derivations use.

A formula becomes a row of items, such as a symbol, a fraction or a bracketed group. The same items serve to break long
formulas into lines. Unknown LaTeX raises InputError.
"""

from collections.abc import Callable, Iterator
from html import escape
from string import ascii_letters, digits
from typing import Any, NamedTuple

from symrot.errors import InputError, complaint
from symrot.latex import reader
from symrot.latex.tokens import GREEK, Token
from symrot.latex.tree import Accent, Delimited, Font, Fraction, Node, Root, Row, Scripts, Table

__all__ = ["Item", "mathml", "read", "rows"]

LETTERS = GREEK | {"pi": "π", "partial": "∂", "infty": "∞"}
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
    "arcsin", "arccos", "arg",
}  # fmt: skip
SPACES = {",": 0.17, ":": 0.22, ";": 0.28, "!": -0.17, " ": 0.28, "quad": 1.0, "qquad": 2.0}
ACCENTS = {"dot": "˙", "ddot": "¨", "bar": "¯", "overline": "¯", "hat": "^", "vec": "→", "tilde": "~"}
FONTS = {
    "mathsf": "sans-serif", "mathrm": "normal", "mathbf": "bold", "mathcal": "script", "text": "normal",
    "operatorname": "normal",
}  # fmt: skip
FENCES = {"(": "(", ")": ")", "[": "[", "]": "]", "|": "|", "\\{": "{", "\\}": "}", ".": "", "/": "/", "\\lbrace": "{",
          "\\rbrace": "}", "\\lvert": "|", "\\rvert": "|", "\\langle": "⟨", "\\rangle": "⟩"}  # fmt: skip
TABLES = {"matrix": ("", ""), "bmatrix": ("[", "]"), "pmatrix": ("(", ")"), "vmatrix": ("|", "|"), "cases": ("{", "")}
MARK = "\\boxed"
"""The command before a group that is highlighted on a page."""

THIN = '<mspace width="0.17em"></mspace>'
WIDEST = 42  # letters per line
SMALL = 0.75  # scripts, relative to the line


class Item(NamedTuple):
    """One part of a formula, such as a symbol or a fraction: its MathML, its width in letters, and its LaTeX."""

    mathml: str
    width: float
    # "relation" for = or <, "sign" for a plus or minus between two terms, "function" for a name such as \sin; lines are
    # broken before relations and signs
    kind: str = ""
    latex: str = ""


TOKENS = {
    **{mark: Item(f'<mo stretchy="false">{fence}</mo>', 0.4) for mark, fence in FENCES.items()},
    **{mark: Item(f"<mo>{mark}</mo>", 0.4) for mark in ",;./!"},
    "|": Item('<mo stretchy="false" form="prefix" lspace="0" rspace="0">|</mo>', 0.4),
    **{mark: Item(f"<mo>{escape(mark)}</mo>", 1.4, "relation") for mark in "=<>:"},
    "\\displaystyle": Item("", 0.0),
    "\\textstyle": Item("", 0.0),
    **{f"\\{name}": Item(f"<mo>{escape(mark)}</mo>", 1.2, "relation" if mark in RELATIONS else "")
       for name, mark in OPERATORS.items()},
    **{f"\\{name}": Item(f'<mo largeop="true">{mark}</mo>', 1.0) for name, mark in LARGE.items()},
    **{f"\\{name}": Item(f"<mi>{name}</mi>", 1.8, "function") for name in FUNCTIONS},
    "\\lim": Item("<mo>lim</mo>", 1.8, "function"),
    **{letter: Item(f"<mi>{letter}</mi>", 0.7) for letter in ascii_letters},
    **{digit: Item(f"<mn>{digit}</mn>", 0.6) for digit in digits},
    **{f"\\{name}": Item(f"<mi>{letter}</mi>", 0.7) for name, letter in LETTERS.items()},
    **{f"\\{name}": Item(f'<mspace width="{em}em"></mspace>', max(em, 0.0)) for name, em in SPACES.items()},
}  # fmt: skip
SCRIPTS = {
    (True, False): ("msub", "munder"), (False, True): ("msup", "mover"), (True, True): ("msubsup", "munderover"),
}  # fmt: skip
SIGNS = {"+": "+", "-": "−", "\\pm": "±", "\\mp": "∓"}
OPENING = ("(", "[", ",", "\\{", "\\lbrace")
CLOSE = ("(", ")", "]", ",", ";", "=", "<", ">", "&", "\\left", "\\right", "\\\\", "\\neq", "\\ne", "\\,", "\\ ")
"""LaTeX that needs no thin space between it and the name of a function before it."""
# what needs brackets taller than a line; around other formulas, browsers would stretch brackets for each index
TALL = ("<mfrac", "<mtable", "<msqrt", "<mroot", "<munder", "∑", "∏", "∫", 'stretchy="true"')


class _Translator:
    """Translates one parsed LaTeX text into items: parts of a formula, each with its MathML and width."""

    def __init__(self, latex: str) -> None:
        self.latex = latex

    def refuse(self, node: Node) -> InputError:
        return complaint(self.latex, "formula", node.start, "LaTeX that the pages use")

    def row(self, row: Row) -> list[Item]:
        """Return the parts of a parsed formula, from left to right, each as an :class:`Item` with its MathML."""
        items: list[Item] = []
        kind = "sign"
        marked = False
        for place, node in enumerate(row.items, start=1):
            if node.text == MARK:
                marked = True
                continue
            # the LaTeX of an item extends up to the next item
            end = row.items[place].start if place < len(row.items) else row.end
            opens = place > 1 and row.items[place - 2].text in OPENING
            item = self.item(node, kind in ("", "function") and not opens)
            body = item.mathml
            if marked:
                body, marked = f'<mrow class="mark">{body}</mrow>', False
            if item.kind == "function":  # set off by thin spaces, but not from brackets, relations and punctuation
                before = THIN if items and kind == "" and not opens else ""
                body = before + body + ("" if end >= row.end or self.latex.startswith(CLOSE, end) else THIN)
            kind = item.kind
            # the constructor of a NamedTuple takes twice as long
            items.append(tuple.__new__(Item, (body, item.width, kind, self.latex[node.start : end])))
        return items

    def argument(self, node: Node) -> list[Item]:
        """Return the argument of a command as a list: all items of a group ``{..}``, or the item of a single node."""
        return self.row(node) if isinstance(node, Row) else [self.item(node)]

    def group(self, node: Node) -> Item:
        """Return the argument of a command as one item, such as the numerator of a fraction, ``{a + b}``."""
        return _joined(self.argument(node))

    def item(self, node: Node, after_operand: bool = False) -> Item:
        """Return one node of parsed LaTeX as an :class:`Item`, with its MathML, width and kind.

        With ``after_operand``, a sign such as - is binary, not a prefix.
        """
        if not isinstance(node, Token):
            return self.scripted(node, after_operand) if isinstance(node, Scripts) else ITEMS[type(node)](self, node)
        text = node.text
        if node.kind == "sized" and text in FENCES:
            return Item(f'<mo stretchy="true" minsize="1.6em">{FENCES[text]}</mo>', 0.5)
        sign = SIGNS.get(text)
        if sign and not after_operand:
            return Item(f'<mo form="prefix">{sign}</mo>', 0.7)
        if text in TOKENS:
            return TOKENS[text]
        if node.kind == "number":
            return Item(f"<mn>{text}</mn>", 0.6 * len(text))
        if sign:
            return Item(f"<mo>{sign}</mo>", 1.2, "sign")
        if text.isalpha():
            return Item(f"<mi>{text}</mi>", 0.7)
        raise self.refuse(node)

    def scripted(self, node: Scripts, after_operand: bool) -> Item:
        base = self.item(node.base, after_operand)
        below, above = [], []
        for script in node.scripts:
            if script.text == "'":  # the font's prime is small and raised: it is no superscript
                primes = f'<mo form="postfix" lspace="0" rspace="0">{"′" * len(script.inside.text)}</mo>'
                base = Item(f"<mrow>{base.mathml}{primes}</mrow>", base.width + 0.3, base.kind)
            elif script.text == "_":
                below.append(self.group(script.inside))
            else:
                above.append(self.group(script.inside))
        if not (below or above):
            return base
        tag = SCRIPTS[bool(below), bool(above)]["lim" in base.mathml or "∑" in base.mathml]
        parts = [items[0] if len(items) == 1 else _joined(items) for items in (below, above) if items]
        width = base.width + SMALL * max([part.width for part in parts])
        return Item(f"<{tag}>{base.mathml}{''.join([part.mathml for part in parts])}</{tag}>", width, base.kind)

    def accent(self, accent: Accent) -> Item:
        name = accent.text[1:]
        if name not in ACCENTS:
            raise self.refuse(accent)
        inner = self.group(accent.inside)
        return Item(f'<mover accent="true">{inner.mathml}<mo>{ACCENTS[name]}</mo></mover>', inner.width)

    def font(self, font: Font) -> Item:
        inside, variant = font.inside, FONTS.get(font.text[1:])
        text = self.latex[inside.start + 1 : inside.end] if isinstance(inside, Row) else inside.text
        if variant is None or "\\" in text or not isinstance(inside, Row | Token):
            raise self.refuse(font)
        text = text.strip() if variant != "normal" else text
        letters = "".join(_letter(letter, variant) for letter in text)
        tag = "mtext" if " " in text else "mi"
        style = ' mathvariant="normal"' if tag == "mi" else ""
        kind = "function" if font.text == "\\operatorname" else ""
        return Item(f"<{tag}{style}>{escape(letters)}</{tag}>", 0.6 * len(text) + 0.4, kind)

    def fraction(self, fraction: Fraction) -> Item:
        small = fraction.command == "\\tfrac"
        shape = _joined if small else _stacked
        above, below = shape(self.argument(fraction.above)), shape(self.argument(fraction.below))
        body = f"<mfrac>{above.mathml}{below.mathml}</mfrac>"
        if small:
            body = f'<mstyle displaystyle="false">{body}</mstyle>'
        return Item(body, max(above.width, below.width) * (SMALL if small else 1) + 0.3)

    def root(self, root: Root) -> Item:
        inner = self.group(root.inside)
        if root.index is None:
            return Item(f"<msqrt>{inner.mathml}</msqrt>", inner.width + 1)
        return Item(f"<mroot>{inner.mathml}{self.group(root.index).mathml}</mroot>", inner.width + 1)

    def delimited(self, node: Delimited) -> Item:
        for mark in (node.opening, node.closing):
            if mark.text not in FENCES:
                raise self.refuse(mark)
        inner = self.group(node.inside)
        tall = any(tag in inner.mathml for tag in TALL)
        first = _fence(FENCES[node.opening.text], "prefix", tall)
        last = _fence(FENCES[node.closing.text], "postfix", tall)
        return Item(f"<mrow>{first}{inner.mathml}{last}</mrow>", inner.width + 0.8)

    def table(self, table: Table) -> Item:
        if table.name not in TABLES:
            raise self.refuse(table)
        lines = [[self.group(cell) for cell in line] for line in table.lines]
        body = "".join("<mtr>" + "".join(f"<mtd>{cell.mathml}</mtd>" for cell in line) + "</mtr>" for line in lines)
        widths = (max((line[n].width for line in lines if n < len(line)), default=0) for n in range(len(lines[0])))
        first, last = map(_fence, TABLES[table.name], ("prefix", "postfix"))
        return Item(f"<mrow>{first}<mtable>{body}</mtable>{last}</mrow>", sum(widths) + len(lines[0]) + 0.5)


ITEMS: dict[type, Callable[[_Translator, Any], Item]] = {
    Row: _Translator.group, Accent: _Translator.accent, Font: _Translator.font, Fraction: _Translator.fraction,
    Root: _Translator.root, Delimited: _Translator.delimited, Table: _Translator.table,
}  # fmt: skip


def _fence(mark: str, form: str, tall: bool = True) -> str:
    return f'<mo form="{form}" stretchy="{str(tall).lower()}" fence="true">{mark}</mo>' if mark else ""


def _letter(letter: str, variant: str) -> str:
    """Return the Unicode character of a letter or digit in a font, such as "ℛ" for ("R", "script")."""
    # browsers no longer support the attributes of MathML for most fonts; other characters are unchanged
    if not (letter.isascii() and letter.isalnum()):
        return letter
    if variant == "script":
        special = {"B": "ℬ", "E": "ℰ", "F": "ℱ", "H": "ℋ", "I": "ℐ", "L": "ℒ", "M": "ℳ", "R": "ℛ"}
        special |= {"e": "ℯ", "g": "ℊ", "o": "ℴ", **{digit: digit for digit in digits}}  # there are no script digits
        return special.get(letter) or chr((0x1D49C if letter.isupper() else 0x1D4B6) + ord(letter.upper()) - ord("A"))
    starts = {"bold": (0x1D400, 0x1D41A, 0x1D7CE), "sans-serif": (0x1D5A0, 0x1D5BA, 0x1D7E2)}.get(variant)
    if starts is None:
        return letter
    upper, lower, digit = starts
    if letter.isdigit():
        return chr(digit + int(letter))
    return chr(upper + ord(letter) - ord("A")) if letter.isupper() else chr(lower + ord(letter) - ord("a"))


def _joined(items: list[Item]) -> Item:
    body = "".join([item.mathml for item in items])
    if len(items) != 1 or "<mspace" in body:
        body = f"<mrow>{body}</mrow>"
    return Item(body, sum([item.width for item in items]))


def read(latex: str) -> list[Item]:
    """Return a LaTeX formula as a list of its parts, which can be joined to MathML or broken into lines.

    Raises
    ------
    InputError
        For unsupported LaTeX.
    """
    return _Translator(latex).row(reader.read(latex, "formula"))


def rows(latex: str, width: float) -> list[list[Item]]:
    """Return the lines of a LaTeX formula, each a list of its parts, at most ``width`` letters wide if possible."""
    # broken before relations such as =, and if that is not enough, before plus and minus
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
    """Return the parts of a formula, such as a numerator, as one part; if wider than WIDEST, it gets several lines."""
    lines = _broken(items, WIDEST)
    if len(lines) == 1:
        return _joined(items)
    body = "".join(f"<mtr><mtd>{''.join(item.mathml for item in line)}</mtd></mtr>" for line in lines)
    return Item(f"<mtable>{body}</mtable>", max(sum(item.width for item in line) for line in lines))


def _pieces(items: list[Item], kind: str) -> Iterator[list[Item]]:
    """Yield the parts of a formula in consecutive lists, each but the first beginning with a part of ``kind``.

    For "relation", ``a = b + c = d`` gives ``a``, ``= b + c`` and ``= d``.
    """
    piece: list[Item] = []
    for item in items:
        if item.kind == kind and piece:
            yield piece
            piece = []
        piece.append(item)
    yield piece


def mathml(latex: str, *, display: bool = False, width: float = WIDEST) -> str:
    """Return a LaTeX formula as the text of a MathML element ``<math>``.

    With ``display`` it stands on lines of its own, and is broken into several if it is wider than ``width`` letters.
    """
    start = '<math xmlns="http://www.w3.org/1998/Math/MathML"' + (' display="block"' if display else "") + ">"
    lines = rows(latex, width) if display else [read(latex)]
    if len(lines) == 1:
        return f"{start}{_joined(lines[0]).mathml}</math>"
    body = ""
    for number, line in enumerate(lines):
        indent = '<mspace width="2em"></mspace>' if number else ""
        body += f"<mtr><mtd>{indent}{''.join(item.mathml for item in line)}</mtd></mtr>"
    return f'{start}<mtable displaystyle="true" class="lines">{body}</mtable></math>'
