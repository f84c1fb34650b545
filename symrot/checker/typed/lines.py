"""The lines of a text: its equations, which semicolons, commas and most line breaks divide."""

from collections.abc import Iterator, Sequence

from symrot.checker.typed.tokens import SIGNS, Token

__all__ = ["lines_of", "with_signs"]

OPERATORS = ("+", "-", "*", "/", "^", "**", "·", "×", "⊗")


def lines_of(tokens: Sequence[Token]) -> Iterator[list[Token]]:
    """Yield the tokens of each equation; semicolons, commas and most line breaks end one.

    A line that starts or ends with an operator, or has no relation sign, is joined to another line. A line that starts
    with a minus is an equation of its own if it has a relation sign.
    """
    line: list[Token] = []
    depth = 0
    for token in tokens:
        at_top = depth == 0
        depth += (token.text in ("(", "[")) - (token.text in (")", "]"))
        separates = at_top and (token.text == ";" or _is_comma_between(line, token, tokens))
        if line and at_top and (separates or (token.breaks and _is_new_line(line, token, tokens))):
            yield _ended(line)
            line = []
        if separates:
            continue
        if token.kind == "end":
            break
        line.append(token)
    if line:
        yield _ended(line)


def _is_comma_between(line: Sequence[Token], token: Token, tokens: Sequence[Token]) -> bool:
    """Return whether ``token`` is a comma between two equations, as in ``a = b, c = d``.

    ``line`` has the tokens of the equation before the comma, ``a = b``; ``tokens`` are those of the whole text.
    """
    if token.text != "," or not any(piece.text in SIGNS for piece in line):
        return False
    after = tokens[list(tokens).index(token) + 1 :]
    end = next((n for n, piece in enumerate(after) if piece.text == "," or piece.kind == "end"), len(after))
    return any(piece.text in SIGNS for piece in after[:end])


def _is_new_line(line: Sequence[Token], token: Token, tokens: Sequence[Token]) -> bool:
    """Return whether the first token after a line break starts a new equation; if not, it continues ``line``."""
    if line[-1].text in (*OPERATORS, *SIGNS) or token.kind == "end":
        return False
    if token.text != "-" and token.text in (*OPERATORS, *SIGNS, ")", "]", ","):
        return False
    if not any(piece.text in SIGNS for piece in line):
        return False
    if token.text == "-":
        following = tokens[list(tokens).index(token) + 1 :]
        rest = next((n for n, piece in enumerate(following) if piece.breaks), len(following))
        return any(piece.text in SIGNS for piece in following[:rest])
    return True


def _ended(line: list[Token]) -> list[Token]:
    """Return the tokens of a line without commas and full stops at its end, and with an end token."""
    while len(line) > 1 and line[-1].kind == "mark" and line[-1].text in (",", "."):
        line = line[:-1]
    return [*line, Token("end", "", line[-1].end, line[-1].end)]


def with_signs(line: list[Token]) -> Iterator[list[Token]]:
    """Yield the tokens of a line; for a line with ± or ∓, first with the upper signs, then with the lower signs."""
    if not any(sign in token.text for token in line for sign in "±∓"):
        yield line
        return
    for signs in ({"±": "+", "∓": "-"}, {"±": "-", "∓": "+"}):
        names = {mark: {"+": "plus", "-": "minus"}[sign] for mark, sign in signs.items()}
        yield [
            token._replace(text=signs[token.text]) if token.text in signs
            else token._replace(text=token.text[:-1] + names[token.text[-1]]) if token.text[-1:] in names
            else token
            for token in line
        ]  # fmt: skip
