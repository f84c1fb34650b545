r"""LaTeX commands that abbreviate other LaTeX, such as ``\dv{x}{t}``, and commands that mean nothing in a formula.

The tokens of the longer LaTeX have the position of the command; the tokens of an argument keep their own.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import cache

from symrot.errors import InputError, complaint
from symrot.latex.tokens import Token, tokens

__all__ = ["INSTEAD", "expanded", "with_spelled_functions"]

_SHORT: Sequence[tuple[str, Mapping[int, str]]] = (
    (r"\vb \va \vectorbold \vectorarrow \pmb \textbf", {1: r"\mathbf{#1}"}),
    (r"\vu \vectorunit", {1: r"\hat{\mathbf{#1}}"}), (r"\widehat", {1: r"\hat{#1}"}), (r"\dd", {1: r"\mathrm{d}#1"}),
    (r"\dv", {1: r"\frac{d}{d#1}", 2: r"\frac{d #1}{d#2}"}),
    (r"\pdv", {1: r"\frac{\partial}{\partial#1}", 2: r"\frac{\partial #1}{\partial#2}",
                3: r"\frac{\partial^2 #1}{\partial#2\partial#3}"}),
    (r"\boxed \fbox \cancel \ensuremath \underbrace \overbrace", {1: r"{#1}"}), (r"\stackrel \overset", {2: r"#2"}),
    (r"\nicefrac \sfrac", {2: r"\frac{#1}{#2}"}), (r"\abs", {1: r"\left|#1\right|"}),
    (r"\norm", {1: r"\left\|#1\right\|"}),
    (r"\num \mathop", {1: r"#1"}), (r"\ang", {1: r"#1^\circ"}), (r"\vdot \dotproduct \bullet", {0: r"\cdot"}),
    (r"\cross \cp \crossproduct \wedge", {0: r"\times"}), (r"\Tr \tr \trace", {0: r"\operatorname{tr}"}),
    (r"\Rightarrow \implies \iff \Leftrightarrow \Longrightarrow \Longleftrightarrow \land \therefore", {0: ","}),
    (r"\coloneqq \triangleq \doteq \coloneq", {0: "="}), (r"\dagger", {0: r"\top"}), (r"\colon", {0: ":"}),
    (r"\imath", {0: "i"}), (r"\jmath", {0: "j"}), (r"\iint", {0: r"\int\int"}), (r"\iiint", {0: r"\int\int\int"}),
)  # fmt: skip

MACROS: Mapping[str, Mapping[int, str]] = {command: forms for names, forms in _SHORT for command in names.split()}
"""Command -> number of its arguments -> the longer LaTeX, in which ``#1`` is the first argument.

A star after the command is skipped.
"""

OF_ORDER: Mapping[str, Mapping[int, str]] = {
    "\\dv": {1: r"\frac{d^{#0}}{d#1^{#0}}", 2: r"\frac{d^{#0} #1}{d#2^{#0}}"},
    "\\pdv": {1: r"\frac{\partial^{#0}}{\partial#1^{#0}}", 2: r"\frac{\partial^{#0} #1}{\partial#2^{#0}}"},
}
"""Command with an order in square brackets, ``\\dv[2]{x}{t}`` -> number of arguments -> LaTeX; ``#0`` is the order."""

DROPPED = {
    **dict.fromkeys(("\\label", "\\tag", "\\color", "\\hspace", "\\vspace", "\\index"), 1),
    **dict.fromkeys(("\\phantom", "\\hphantom", "\\vphantom"), 1),
    **dict.fromkeys(("\\nonumber", "\\hfill", "\\mathstrut", "\\strut", "\\allowbreak", "\\thinspace", "\\enspace"), 0),
}
"""Command that says nothing about the formula, such as ``\\label`` -> the number of arguments left out with it."""

BRACED = ("\\underbrace", "\\overbrace")
"""Commands that draw a brace below or above a formula. An index or power after such a command, as in
``\\underbrace{a + b}_{sum}``, is a remark on the formula and is left out."""

LONGEST_EQUATION_NUMBER = 8
"""The largest number of tokens of an equation number such as ``(5.12)`` after ``\\quad``, together with the token after
it, which must be the end of the formula or line."""

SPELLED = {
    **{name: f"\\{name}" for name in ("sin", "cos", "tan", "cot", "sec", "csc", "sinh", "cosh", "tanh", "exp", "ln",
                                      "arcsin", "arccos", "arctan", "det")},
    **dict.fromkeys(("tr", "Tr", "trace"), "\\operatorname{tr}"),
}  # fmt: skip
"""Function that people write without a backslash, as in ``2 sin\\theta cos\\theta`` -> the LaTeX for it."""

ARGUMENTS = ("command", "letter", "number", "group", "font", "left", "fraction")
"""Kinds of the tokens with which an argument without brackets begins."""

MATRIX_MARKS = ("\\mathbf", "\\bm", "\\boldsymbol", "\\mathrm", "[", "\\bf", "{")

INSTEAD = {
    **dict.fromkeys(("\\SI", "\\si", "\\unit"), "the number without its unit"),
    **dict.fromkeys(("\\approx", "\\simeq"), "'=' and the value to as many digits as you know, such as x = 0.333"),
    **dict.fromkeys(("\\sim", "\\propto"), "'=' and a factor"),
    **dict.fromkeys(("\\neq", "\\ne"), "a claim with '='"),
    **dict.fromkeys(("\\to", "\\rightarrow", "\\mapsto"), "'='"),
    **dict.fromkeys(("\\ldots", "\\cdots", "\\dots"), "all terms"),
    **dict.fromkeys(("\\eqref", "\\ref"), "the formula itself"),
    **dict.fromkeys(("\\forall", "\\in"), "the equation alone"),
    **dict.fromkeys(("\\text", "\\mbox", "\\textrm"), "the formula alone, without words"),
    "\\log": "\\ln, or \\log_{10}(x) as \\frac{\\ln x}{\\ln 10}",
    "\\nabla": "the derivatives \\frac{\\partial f}{\\partial x}",
    "\\infty": "a finite number", "\\oint": "an integral \\int_a^b with limits", "\\prod": "the factors of the product",
    "\\lim": "the limit itself", "\\newcommand": "the formula without macros of your own",
}  # fmt: skip
"""Command that is refused -> what to write instead."""


def expanded(pieces: Sequence[Token], source: str, where: str = "") -> list[Token]:
    r"""Return tokens in which every abbreviating command is replaced by its longer form.

    Raises
    ------
    InputError
        For a command without its arguments.

    Examples
    --------
    >>> from symrot.latex.tokens import tokens
    >>> "".join(piece.text for piece in expanded(tokens(r"\dv[2]{x}{t} \label{eq:a}"), ""))
    '\\frac{d^{2}x}{dt^{2}}'
    """
    return list(_Expansion(pieces, source, where).all())


def with_spelled_functions(pieces: Sequence[Token]) -> tuple[list[Token], list[str]]:
    r"""Return tokens with the command ``\sin`` for the letters ``sin``, and the names of the functions so spelled.

    Examples
    --------
    >>> from symrot.latex.tokens import tokens
    >>> pieces, names = with_spelled_functions(tokens(r"2 sin\theta"))
    >>> "".join(piece.text for piece in pieces), names
    ('2\\sin\\theta', ['sin'])
    """
    result, names, place = list[Token](), list[str](), 0
    while place < len(pieces):
        end = place + 1
        while pieces[place].kind == "letter" and _touches(pieces[end - 1], pieces[end]):
            end += 1
        word = "".join(piece.text for piece in pieces[place:end])
        # the letters stand side by side and an argument follows; tr(t) stays a product, as only a matrix has a trace
        if word in SPELLED and _is_argument(pieces[end:], word):
            names += [word] if word not in names else []
            result += [piece._replace(start=pieces[place].start) for piece in _template(SPELLED[word])]
        else:
            result += pieces[place:end]
        place = end
    return result, names


def _touches(letter: Token, after: Token) -> bool:
    return after.kind == "letter" and after.start == letter.start + 1


def _is_argument(after: Sequence[Token], function: str) -> bool:
    """Return whether the tokens ``after`` a function's name begin with an argument or a power of the function."""
    first, *rest = after
    # tr, Tr or trace: a matrix must follow, perhaps in brackets, with a capital letter or a mark such as \mathbf
    if SPELLED[function] != f"\\{function}":
        inside = rest[0] if first.text == "(" and rest else first
        return inside.text in MATRIX_MARKS or (inside.kind == "letter" and inside.text.isupper())
    return first.text in ("(", "^") or first.kind in ARGUMENTS


@cache
def _template(text: str) -> tuple[Token, ...]:
    return tuple(tokens(text)[:-1])


class _Expansion:
    def __init__(self, pieces: Sequence[Token], source: str, where: str) -> None:
        self.pieces, self.source, self.where = pieces, source, where
        self.place = 0

    def all(self) -> Iterator[Token]:
        while self.place < len(self.pieces):
            piece = self.pieces[self.place]
            self.place += 1
            if piece.kind == "group" and self.at("\\bf", "\\boldmath", "\\rm"):  # {\\bf a}
                font = "\\mathrm" if self.at("\\rm") else "\\mathbf"
                self.place += 1
                yield Token("font", font, piece.start)
                yield piece
            elif piece.text in ("\\quad", "\\qquad") and (length := self.equation_number()):
                self.place += length
            elif piece.text in DROPPED:
                for _ in range(DROPPED[piece.text]):
                    self.argument(piece)
            elif piece.kind != "command" or piece.text not in MACROS:
                yield piece
            else:
                yield from self.longer(piece)

    def equation_number(self) -> int:
        r"""Return how many tokens an equation number in brackets has, such as ``(5.12)`` after ``a = b \qquad``.

        Return 0 if there is none at the cursor.
        """
        rest = self.pieces[self.place : self.place + LONGEST_EQUATION_NUMBER]
        texts = [piece.text for piece in rest]
        end = texts.index(")") if texts[:1] == ["("] and ")" in texts[:-1] else 0
        inside = rest[1:end]
        is_number = all(piece.kind == "number" or piece.text in ".-" for piece in inside)
        return end + 1 if inside and is_number and rest[end + 1].kind in ("end", "line", "close") else 0

    def longer(self, command: Token) -> Iterator[Token]:
        r"""Yield the tokens for which a command stands: those of ``\frac{dx}{dt}`` for ``\dv{x}{t}``.

        The cursor is at the command's arguments.
        """
        forms = MACROS[command.text]
        if self.at("*"):
            self.place += 1
        arguments = [self.order() if command.text in OF_ORDER else ()]
        forms = OF_ORDER[command.text] if arguments[0] else forms
        while len(arguments) <= max(forms) and (len(arguments) <= min(forms) or self.at("{")):
            arguments.append(self.argument(command))
        last = ""
        for piece in _template(forms[len(arguments) - 1]):
            if last == "#":
                yield from expanded(arguments[int(piece.text)], self.source, self.where)
            elif piece.text != "#":
                yield piece._replace(start=command.start)
            last = piece.text
        if command.text in BRACED and self.at("_", "^"):
            self.place += 1
            self.argument(command)

    def at(self, *texts: str) -> bool:
        return self.place < len(self.pieces) and self.pieces[self.place].text in texts

    def order(self) -> Sequence[Token]:
        """Parse the order of a derivative, ``[2]``, and return the tokens in the brackets; [] without brackets."""
        if not self.at("["):
            return []
        texts = [piece.text for piece in self.pieces[self.place :]]
        end = self.place + (texts.index("]") if "]" in texts else 0)
        inside = self.pieces[self.place + 1 : end]
        self.place = end + 1
        return inside

    def argument(self, command: Token) -> Sequence[Token]:
        """Parse the argument of a command and return its tokens: a group without its braces, or a single token."""
        while self.place < len(self.pieces) and self.pieces[self.place].kind == "space":
            self.place += 1
        first = self.place
        if not self.at("{"):
            if self.place >= len(self.pieces) or self.pieces[first].kind == "end":
                raise self.fail(command)
            self.place += 1
            return self.pieces[first : self.place]
        depth = 0
        for place in range(first, len(self.pieces)):
            depth += (self.pieces[place].text == "{") - (self.pieces[place].text == "}")
            if depth == 0:
                self.place = place + 1
                return self.pieces[first + 1 : place]
        raise self.fail(command)

    def fail(self, command: Token) -> InputError:
        return complaint(self.source, self.where, command.start, f"a group in braces after {command.text}")
