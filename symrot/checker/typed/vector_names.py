"""Which names in a text are vectors: signs show it, such as a hat, a cross product, or the bars of a length.

An argument ``flips`` has the keys (kind, position) of the ambiguous signs and words of the text that are read in their
less usual meaning.
"""

from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

from symrot.checker.typed.cursor import SHARED, is_cross_letter, is_mass_before_vector, is_usual_vector
from symrot.checker.typed.tokens import Token

__all__ = ["crossed", "dotted", "marked", "names_alone"]

DOT_OF_PRODUCTS = ("(", None, None, ")", "·", "(", None, None, ")")
"""The tokens of ``(R a)·(R b)``, with None in place of each name."""

SCALARS = ("m", "I", "J", "t")
"""Letters that no book uses for a vector: masses, moments of inertia and times."""


def names_alone(tokens: Sequence[Token], vectors: Collection[str]) -> Iterator[str]:
    """Yield the names in a text that no bracket follows, so that they are not functions."""
    padded = [*tokens, tokens[-1]]
    for before, token, after, last in zip((None, *tokens), tokens, tokens[1:], padded[2:], strict=False):
        own = last if is_mass_before_vector(after, last) else after
        # the x of a cross product is a sign, no name
        if token.kind == "name" and after.text != "(" and not _is_cross(before, token, after, own, vectors):
            yield token.text


def _is_cross(before: Token | None, token: Token, after: Token, factor: Token, vectors: Collection[str]) -> bool:
    """Return whether ``token`` is a letter x that means the cross product of ``before`` and ``factor``: ``r x v``.

    ``after`` is the token after the x. It is the factor itself, or in ``r x m v`` the mass before the factor.
    """
    if token.text != "x" or not token.spaced or not after.spaced or before is None:
        return False
    # in r x m v the token after the x is the mass m, and the factor is v
    return is_cross_letter(before, factor, vectors)


def crossed(tokens: Sequence[Token], vectors: Collection[str], flips: Collection[tuple[str, int]]) -> Iterator[str]:
    """Yield the names next to the sign of a cross product, ``×`` or a letter x: they are vectors.

    A letter x whose key ("cross", position) is in ``flips`` is read as a name, not as this sign. If the text has time
    derivatives written with dots or primes, also yield the names in ``cross(a, b)`` and ``skew(a)``, which would become
    functions of time otherwise.
    """
    alone = set(names_alone(tokens, vectors))
    padded = [*tokens, tokens[-1]]
    # a text with rates would make functions of time of the names in cross(a, b)
    if any(token.kind in ("prime", "dots") for token in tokens):
        for function, opening, operand, closing in zip(tokens, tokens[1:], tokens[2:], padded[3:], strict=False):
            is_call = function.text in ("cross", "skew") and opening.text == "(" and closing.text in (",", ")")
            if is_call and operand.kind == "name":
                yield operand.text
    for before, sign, after, last in zip(tokens, tokens[1:], tokens[2:], padded[3:], strict=False):
        factor = last if is_mass_before_vector(after, last) else after
        if (sign.kind == "mark" and sign.text == "×") or (
            "x" not in alone and _is_cross(before, sign, after, factor, vectors) and ("cross", sign.start) not in flips
        ):
            if "number" in (before.kind, after.kind):
                continue
            is_factor = after.text[:1].isupper() or not is_usual_vector(after.text)  # R a x R b and r x m v
            is_vector = is_usual_vector(last.text) or after.text in ("m", "M")
            is_followed = last.kind == "name" and last.text != "x" and is_vector
            own = last if is_factor and is_followed and not last.breaks else after
            yield from (token.text for token in (before, own) if token.kind == "name")


def marked(tokens: Sequence[Token]) -> Iterator[str]:
    """Yield the names that signs show to be vectors, such as ``a`` with a hat, ``[n]×`` or ``a . b``."""
    triples = list(zip(tokens, tokens[1:], tokens[2:], strict=False))
    yield from _by_angle(tokens)
    lengths = {name.text for left, name, right in triples if left.text == right.text == "|" and name.kind == "name"}
    norms = [place for place, token in enumerate(tokens) if token.text == "‖"]
    for start, end in zip(norms[::2], norms[1::2], strict=False):
        lengths |= {token.text for token in tokens[start:end] if token.kind == "name"} - {"q", "p"}  # no quaternions
    # a·b = |a| |b| cos x, ‖a + b‖² = ‖a‖² + 2 a·b + ‖b‖²: names whose lengths occur
    for left, dot, right in triples:
        if dot.text == "·" and {left.text, right.text} <= lengths:
            yield from (left.text, right.text)
    for place in range(len(tokens) - len(DOT_OF_PRODUCTS)):
        pieces = [tokens[place + n].text for n in range(len(DOT_OF_PRODUCTS))]
        if all(sign in (None, piece) for sign, piece in zip(DOT_OF_PRODUCTS, pieces, strict=True)):
            (matrix, first), (other, second) = pieces[1:3], pieces[6:8]
            # (R a)·(R b): names that one matrix rotates
            if matrix == other and matrix.isupper() and is_usual_vector(first) and is_usual_vector(second):
                yield from (first, second)
    for place, name in enumerate(tokens[:-1]):
        before, after, last = tokens[max(place - 1, 0)], tokens[place + 1], tokens[min(place + 2, len(tokens) - 1)]
        bracketed = before.text == "["
        if name.kind == "name" and (
            after.kind in ("hat", "tilde")
            or (bracketed and after.text == "]" and last.text in ("x", "×") and last.tight)
            or (bracketed and after.text in ("x", "×") and last.text == "]")
            or (before.text == "(" and after.text == ")" and tokens[max(place - 2, 0)].text == "S")
            or (_is_dot(after) and last.spaced and last.kind == "name")
            or (_is_dot(before) and name.spaced)
        ):
            yield name.text


def dotted(tokens: Sequence[Token], vectors: Collection[str]) -> set[str]:
    """Return further names of vectors, found in scalar products: v in ``n·v`` if n is in ``vectors``; c in ``(a×b)·c``.

    Only letters that books usually give to vectors, and g, are returned. The letters in ``SHARED``, such as R and T,
    are left out, since books give them to numbers just as often.
    """
    names: set[str] = set()
    for place, dot in enumerate(tokens):
        if dot.text != "·" or not 0 < place < len(tokens) - 1:
            continue
        before, after = tokens[place - 1], tokens[place + 1]
        owner = tokens[place - 2] if before.kind == "hat" else before
        crosses = [token.text for token in tokens[max(place - 4, 0) : place]] if before.text == ")" else []  # (a × b)·c
        is_left = owner.text in vectors or "×" in crosses
        names |= {token.text for token, beside in ((after, is_left), (before, after.text in vectors)) if beside}
    usual = {name for name in names if is_usual_vector(name) or name == "g"}
    return usual - {*vectors, *SHARED}


def _by_angle(tokens: Sequence[Token]) -> Iterator[str]:
    """Yield the names that an equation such as ``F·d = F d cos θ`` shows to be vectors: F and d.

    One side is the scalar product, the other the product of both lengths and the cosine. Without the cosine, as in
    ``F·d = F d``, the names are yielded only if books usually give these letters to vectors.
    """
    sides: list[list[str]] = [[]]
    for token in tokens:
        if token.text in ("=", "=="):
            sides.append([])
        elif token.kind != "end":
            sides[-1].append(token.text)
    for product, lengths in [*pairwise(sides), *pairwise(sides[::-1])]:
        if len(product) != 3 or product[1] != "·" or product[0] == product[2]:
            continue
        first, _, second = product
        names = [word for word in lengths if word not in ("*", "·", "|", "(", ")")]
        has_lengths = {first, second} <= {*names} or first + second in names
        has_cosine = "cos" in names and len(names) <= 4 and first.isalpha() and second.isalpha()
        has_vectors = is_usual_vector(first) and is_usual_vector(second)
        are_letters = len(first) == len(second) == 1 and not {first, second} & {*SCALARS}
        # for numbers, F·d = F d without a cosine says nothing: the letters are vectors if books usually mean vectors
        is_bare = lengths in ([first, second], [second, first], [first + second]) and has_vectors
        if has_lengths and (is_bare or (has_cosine and (has_vectors or are_letters))):
            yield from (first, second)


def _is_dot(token: Token) -> bool:
    return token.kind == "mark" and token.text == "." and token.spaced
