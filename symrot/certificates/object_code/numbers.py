"""What the SSE2 and AVX instructions on numbers do: arithmetic, comparisons, masks, fused operations.

Each entry of the table takes the sources as words and returns the words it writes. Moves of words from place to place
are in :mod:`symrot.certificates.object_code.shuffles`. Scalar instructions keep the rest of the first source; VEX forms
(``v...``) name the first source, the older ones take it from where they write.
"""

from collections.abc import Callable

from symrot.certificates.object_code.state import NotUnderstood, State, Words
from symrot.certificates.object_code.terms import ANY, Outcomes, Terms

__all__ = ["NUMERIC", "Numeric"]

Numeric = Callable[[State, list[Words], int], Words]  # state, sources (first the one that is kept), constant
WIDTHS = {"d": 64, "s": 32}
PREDICATES: dict[str, Outcomes] = {
    "eq": frozenset("="), "lt": frozenset("<"), "le": frozenset("<="), "unord": frozenset("?"),
    "neq": frozenset("<>?"), "nlt": frozenset("=>?"), "nle": frozenset(">?"), "ord": frozenset("<=>"),
    "eq_uq": frozenset("=?"), "nge": frozenset("<?"), "ngt": frozenset("<=?"), "false": frozenset(),
    "neq_oq": frozenset("<>"), "ge": frozenset(">="), "gt": frozenset(">"), "true": ANY,
}  # fmt: skip
_QUIET = (  # other names of the same relation, which differ in exceptions
    ("eq", "eq_os"), ("lt", "lt_oq"), ("le", "le_oq"), ("unord", "unord_s"), ("neq", "neq_us"), ("nlt", "nlt_uq"),
    ("nle", "nle_uq"), ("ord", "ord_s"), ("eq_uq", "eq_us"), ("nge", "nge_uq"), ("ngt", "ngt_uq"),
    ("false", "false_os"), ("neq_oq", "neq_os"), ("ge", "ge_oq"), ("gt", "gt_oq"), ("true", "true_us"),
)  # fmt: skip


def _lanes(state: State, words: Words, width: int) -> list[int]:
    """Return the terms of that width that words are."""
    if width == 32:
        return list(words)
    return [state.whole(words[place : place + 2]) for place in range(0, len(words), 2)]


def _each(suffix: str, operation: Callable[..., int], arguments: int = 2) -> Numeric:
    """Return an instruction that does one operation on each lane (``p``) or on the first (``s``)."""
    width, is_packed = WIDTHS[suffix[1]], suffix[0] == "p"

    def numeric(state: State, sources: list[Words], _: int) -> Words:
        taken = sources[-arguments:]
        count = len(sources[0]) if is_packed else width // 32
        lanes = zip(*(_lanes(state, words[:count], width) for words in taken), strict=True)
        done = [word for lane in lanes for word in state.halves(operation(state.context.terms, *lane))]
        return done + sources[0][count:]

    return numeric


def _alternating(suffix: str, even: Callable[..., int], odd: Callable[..., int]) -> Numeric:
    def numeric(state: State, sources: list[Words], _: int) -> Words:
        lanes = zip(*(_lanes(state, words, WIDTHS[suffix[1]]) for words in sources), strict=True)
        terms = state.context.terms
        return [
            word
            for place, lane in enumerate(lanes)
            for word in state.halves((odd if place % 2 else even)(terms, *lane))
        ]

    return numeric


def _horizontal(suffix: str, operation: Callable[..., int]) -> Numeric:
    def numeric(state: State, sources: list[Words], _: int) -> Words:
        found: Words = []
        for start in range(0, len(sources[0]), 4):
            for words in sources:
                lanes = _lanes(state, words[start : start + 4], WIDTHS[suffix[1]])
                for first, second in zip(lanes[::2], lanes[1::2], strict=True):
                    found += state.halves(operation(state.context.terms, first, second))
        return found

    return numeric


def _bitwise(operation: Callable[..., int]) -> Numeric:
    """Return an instruction on bits: 64 at a time where a source is a number or a mask of 64."""

    def numeric(state: State, sources: list[Words], _: int) -> Words:
        terms, found = state.context.terms, list[int]()
        for place in range(0, len(sources[0]), 2):
            halves = [words[place : place + 2] for words in sources]
            if any(terms.kind(terms.join(*words)) != "join" for words in halves) and any(
                terms.kind(word) == "part" for words in halves for word in words
            ):
                found += state.halves(operation(terms, *(terms.join(*words) for words in halves)))
            else:
                found += [operation(terms, first, second) for first, second in zip(*halves, strict=True)]
        return found

    return numeric


def _compare(suffix: str, outcomes: Outcomes | None) -> Numeric:
    """Return a comparison into masks; the constant says which where the name does not."""
    by_number = list(PREDICATES.values())

    def numeric(state: State, sources: list[Words], constant: int) -> Words:
        if outcomes is None and not 0 <= constant < 32:
            raise NotUnderstood(f"the comparison {constant}")
        chosen = by_number[constant % 16] if outcomes is None else outcomes
        return _each(suffix, lambda terms, a, b: terms.mask(WIDTHS[suffix[1]], chosen, a, b))(state, sources, 0)

    return numeric


def _fused(suffix: str, order: str, negated: bool, subtracted: tuple[bool, ...]) -> Numeric:
    """Return a*b + c in one rounding; ``order`` says which operands are a, b and c, ``subtracted`` by lane."""
    places = tuple(int(digit) - 1 for digit in order)

    def of(lane_subtracted: bool) -> Callable[..., int]:
        def one(terms: Terms, *lane: int) -> int:
            a, b, c = (lane[place] for place in places)
            return terms.fma(terms.neg(a) if negated else a, b, terms.neg(c) if lane_subtracted else c)

        return one

    if len(subtracted) == 2:
        return _alternating(suffix, of(subtracted[0]), of(subtracted[1]))
    return _each(suffix, of(subtracted[0]), 3)


def _less(terms: Terms, a: int, b: int) -> int:
    return terms.choose(terms.mask(terms.width(a), frozenset("<"), a, b), a, b)


def _greater(terms: Terms, a: int, b: int) -> int:
    return terms.choose(terms.mask(terms.width(a), frozenset(">"), a, b), a, b)


def _blended(suffix: str) -> Numeric:
    """Return a choice by the sign bit of the last source: a mask has that of all its bits."""

    def one(terms: Terms, a: int, b: int, mask: int) -> int:
        value = terms.constant(mask)
        if value is not None:
            return b if value >> terms.width(mask) - 1 else a
        return terms.choose(mask, b, a)

    return _each(suffix, one, 3)


def _approximate(name: str) -> Callable[..., int]:
    return lambda terms, a: terms.opaque(name, terms.width(a), a)


def _same(state: State, sources: list[Words], _: int) -> Words:
    if sources[0] != sources[1]:
        raise NotUnderstood("a comparison of whole numbers")
    return [state.context.terms.bits(32, -1)] * len(sources[0])


def _shifted(width: int, shift: Callable[[int, int, int], int]) -> Numeric:
    """Return a shift of constants; others are not shifted in kernels."""

    def numeric(state: State, sources: list[Words], constant: int) -> Words:
        terms, found = state.context.terms, list[int]()
        for lane in _lanes(state, sources[-1], width):
            value = terms.constant(lane)
            if value is None:
                raise NotUnderstood("a shift of what is no constant")
            found += state.halves(
                terms.bits(width, shift(value, constant, width) if constant < width else _out(shift, value, width))
            )
        return found

    return numeric


def _out(shift: Callable[[int, int, int], int], value: int, width: int) -> int:
    return -(value >> width - 1) if shift is _right_signed else 0


def _left(value: int, count: int, _: int) -> int:
    return value << count


def _right(value: int, count: int, _: int) -> int:
    return value >> count


def _right_signed(value: int, count: int, width: int) -> int:
    return (value - ((value >> width - 1) << width)) >> count


def _table() -> dict[str, Numeric]:
    table: dict[str, Numeric] = {}
    binary = {"add": Terms.add, "sub": Terms.sub, "mul": Terms.mul, "div": Terms.div, "min": _less, "max": _greater}
    for suffix in ("pd", "ps", "sd", "ss"):
        for name, operation in binary.items():
            table[name + suffix] = _each(suffix, operation)
        table["sqrt" + suffix] = _each(suffix, Terms.sqrt, 1)
        table["cmp" + suffix] = _compare(suffix, None)
        for name, outcomes in PREDICATES.items():
            table[f"cmp{name}{suffix}"] = _compare(suffix, outcomes)
        for name, other in _QUIET:
            table[f"cmp{other}{suffix}"] = table[f"cmp{name}{suffix}"]
        for order in ("132", "213", "231"):
            for name, negated, subtracted in _FUSED:
                if suffix[0] == "p" or len(subtracted) == 1:
                    table[f"f{name}{order}{suffix}"] = _fused(suffix, order, negated, subtracted)
    for suffix in ("ps", "ss"):
        for name in ("rcp", "rsqrt"):
            table[name + suffix] = _each(suffix, _approximate(name), 1)
    for suffix in ("pd", "ps"):
        table["addsub" + suffix] = _alternating(suffix, Terms.sub, Terms.add)
        table["hadd" + suffix] = _horizontal(suffix, Terms.add)
        table["hsub" + suffix] = _horizontal(suffix, Terms.sub)
        table["blendv" + suffix] = _blended(suffix)
    bitwise = {"and": Terms.bit_and, "andn": Terms.bit_andn, "or": Terms.bit_or, "xor": Terms.bit_xor}
    for name, operation in bitwise.items():
        for full in (f"{name}pd", f"{name}ps", f"p{name}"):
            table[full] = _bitwise(operation)
    for mark, width in (("d", 32), ("q", 64)):
        table |= {f"psll{mark}": _shifted(width, _left), f"psrl{mark}": _shifted(width, _right)}
    table["psrad"] = _shifted(32, _right_signed)
    return table | {"pcmpeqd": _same, "pcmpeqq": _same, "pcmpeqb": _same, "pcmpeqw": _same}


_FUSED = (  # name, is the product negated, is the last operand subtracted, by lane
    ("madd", False, (False,)), ("msub", False, (True,)), ("nmadd", True, (False,)), ("nmsub", True, (True,)),
    ("maddsub", False, (True, False)), ("msubadd", False, (False, True)),
)  # fmt: skip
NUMERIC = _table()
