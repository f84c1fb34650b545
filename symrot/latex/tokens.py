r"""Splitting LaTeX into tokens with positions; ``\left(`` is one token, and so is ``\begin{matrix}``."""

import re
from typing import NamedTuple

__all__ = ["GREEK", "Token", "tokens"]

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ϵ", "varepsilon": "ε", "zeta": "ζ", "eta": "η",
    "theta": "θ", "vartheta": "ϑ", "iota": "ι", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ",
    "rho": "ρ", "varrho": "ϱ", "sigma": "σ", "tau": "τ", "upsilon": "υ", "phi": "ϕ", "varphi": "φ", "chi": "χ",
    "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ", "Lambda": "Λ", "Xi": "Ξ", "Pi": "Π",
    "Sigma": "Σ", "Upsilon": "Υ", "Phi": "Φ", "Psi": "Ψ", "Omega": "Ω", "ell": "ℓ",
}  # fmt: skip
"""Name of a Greek letter -> its character; pi is missing, because it is a number."""

_DELIMITER = r"(?:[()\[\]|/.<>]|\\[{}|]|\\(?:[lr](?:brace|brack|vert|Vert|angle|floor|ceil)|[vV]ert)(?![A-Za-z]))"
_PRIME = r"(?:['′]|\\prime(?![A-Za-z]))"
_TOKEN = re.compile(  # the most frequent tokens first; blanks are no token
    r"(?P<letter>[A-Za-z])|(?P<mark>[-+=()}\[\]&])|(?P<group>\{)|(?P<number>\d+(?:\.\d+)?|\.\d+)"
    rf"|(?P<prime>\^\s*(?:{_PRIME}+|\{{\s*(?:{_PRIME}\s*)+\}})|{_PRIME}+)|(?P<script>[_^])"
    rf"|(?P<sized>\\(?:left|right|middle|[bB]igg?[lrm]?)\s*{_DELIMITER})"
    r"|(?P<environment>\\(?:begin\s*\{(?:array\}\s*\{[clr|\s]*|(?!array\})[A-Za-z]+\*?)\}|end\s*\{[A-Za-z]+\*?\}))"
    r"|(?P<command>\\(?:[A-Za-z]+|[\\{}|]))|(?P<space>~|%[^\n]*|\\[,:;! ])|(?P<other>\\.|\S)",
    re.ASCII | re.DOTALL,
)
_COMMANDS = {
    "space": "quad qquad displaystyle textstyle limits nolimits nonumber notag",
    "fraction": "frac tfrac dfrac cfrac", "root": "sqrt", "line": "\\ cr", "unpaired": "left right begin end",
    "accent": "dot ddot dddot hat bar overline vec overrightarrow tilde widetilde underline",
    "font": "mathbf bm boldsymbol mathrm mathit mathsf mathcal text textrm operatorname",
}  # fmt: skip
_KINDS = {f"\\{name}": kind for kind, names in _COMMANDS.items() for name in names.split()}


class Token(NamedTuple):
    """A token of LaTeX; ``kind`` is for example ``letter`` or ``command``, ``start`` is its position in the source."""

    kind: str
    text: str
    start: int


def tokens(source: str, start: int = 0, stop: int | None = None) -> list[Token]:
    """Return the tokens of ``source[start:stop]``, without blanks; the last token has the kind ``end``."""
    stop = len(source) if stop is None else stop
    pieces = []
    # every other character is a token of its own, so that an interpreter can report its position
    for match in _TOKEN.finditer(source, start, stop):
        kind, text = str(match.lastgroup), match[0]
        if kind == "command":
            kind = _KINDS.get(text, kind)
        elif kind == "sized":
            size, text = re.match(r"(\\[A-Za-z]+)\s*(.*)", text).groups()  # type: ignore[union-attr]
            kind = size[1:] if size in ("\\left", "\\right") else kind
        elif kind == "environment":
            kind, text = "begin" if text.startswith("\\begin") else "close", re.split("[{}]", text)[1]
        elif kind == "prime":
            text = "'" * len(re.findall(r"\\prime|['′]", text))
        # the constructor of a NamedTuple takes twice as long
        pieces.append(tuple.__new__(Token, ("mark" if kind == "other" else kind, text, match.start())))
    return [*pieces, Token("end", "", stop)]
