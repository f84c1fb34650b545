"""The effect of SSE2 and AVX instructions on numbers: arithmetic, comparisons, masks, fused operations.

The table ``NUMERIC`` maps the name of an instruction, such as ``addpd``, to the Python function that executes it. The
function takes the instruction's source operands, each as a list of 32-bit words, and returns the result in this form; a
word is a symbolic value. The last two letters of a name are a suffix. It says whether the numbers are packed (``p``)
or scalar (``s``), and whether they are doubles (``d``) or floats (``s``): packed instructions act on all numbers of a
register, scalar instructions on the first.
"""

from collections.abc import Callable

from symrot.certificates.object_code.state import MachineState, NotUnderstood, Words
from symrot.certificates.object_code.terms import ANY, Outcomes, Terms

__all__ = ["NUMERIC", "Numeric"]

# from the state, the sources (the first supplies the upper words) and a constant
Numeric = Callable[[MachineState, list[Words], int], Words]
WIDTHS = {"d": 64, "s": 32}
PREDICATES: dict[str, Outcomes] = {
    "eq": frozenset("="), "lt": frozenset("<"), "le": frozenset("<="), "unord": frozenset("?"),
    "neq": frozenset("<>?"), "nlt": frozenset("=>?"), "nle": frozenset(">?"), "ord": frozenset("<=>"),
    "eq_uq": frozenset("=?"), "nge": frozenset("<?"), "ngt": frozenset("<=?"), "false": frozenset(),
    "neq_oq": frozenset("<>"), "ge": frozenset(">="), "gt": frozenset(">"), "true": ANY,
}  # fmt: skip
_QUIET = (  # predicates of the same relation, which differ in the floating-point exceptions that they raise
    ("eq", "eq_os"), ("lt", "lt_oq"), ("le", "le_oq"), ("unord", "unord_s"), ("neq", "neq_us"), ("nlt", "nlt_uq"),
    ("nle", "nle_uq"), ("ord", "ord_s"), ("eq_uq", "eq_us"), ("nge", "nge_uq"), ("ngt", "ngt_uq"),
    ("false", "false_os"), ("neq_oq", "neq_os"), ("ge", "ge_oq"), ("gt", "gt_oq"), ("true", "true_us"),
)  # fmt: skip


def _lanes(state: MachineState, words: Words, width: int) -> list[int]:
    """Return the numbers of ``width`` bits in a list of 32-bit words, each as a term; a double has two words."""
    if width == 32:
        return list(words)
    return [state.whole(words[place : place + 2]) for place in range(0, len(words), 2)]


# Scalar instructions keep the upper words of the first source.
def _each(suffix: str, operation: Callable[..., int], arguments: int = 2) -> Numeric:
    """Return the function for an instruction that applies ``operation`` to numbers, element by element.

    ``suffix`` is ``"pd"``, ``"ps"``, ``"sd"`` or ``"ss"``, such as ``"pd"`` for packed doubles. ``operation`` takes
    ``arguments`` numbers, one from each of the instruction's last ``arguments`` source operands.
    """
    width, is_packed = WIDTHS[suffix[1]], suffix[0] == "p"

    def numeric(state: MachineState, sources: list[Words], _: int) -> Words:
        operands = sources[-arguments:]
        count = len(sources[0]) if is_packed else width // 32
        lanes = zip(*(_lanes(state, words[:count], width) for words in operands), strict=True)
        done = [word for lane in lanes for word in state.halves(operation(state.context.terms, *lane))]
        return done + sources[0][count:]

    return numeric


def _alternating(suffix: str, even: Callable[..., int], odd: Callable[..., int]) -> Numeric:
    def numeric(state: MachineState, sources: list[Words], _: int) -> Words:
        lanes = zip(*(_lanes(state, words, WIDTHS[suffix[1]]) for words in sources), strict=True)
        terms = state.context.terms
        return [
            word
            for place, lane in enumerate(lanes)
            for word in state.halves((odd if place % 2 else even)(terms, *lane))
        ]

    return numeric


def _horizontal(suffix: str, operation: Callable[..., int]) -> Numeric:
    def numeric(state: MachineState, sources: list[Words], _: int) -> Words:
        results: Words = []
        for start in range(0, len(sources[0]), 4):
            for words in sources:
                lanes = _lanes(state, words[start : start + 4], WIDTHS[suffix[1]])
                for first, second in zip(lanes[::2], lanes[1::2], strict=True):
                    results += state.halves(operation(state.context.terms, first, second))
        return results

    return numeric


def _bitwise(operation: Callable[..., int]) -> Numeric:
    """Return the function that executes a bitwise instruction such as ``andpd`` by ``operation`` on two terms."""

    def numeric(state: MachineState, sources: list[Words], _: int) -> Words:
        terms, results = state.context.terms, list[int]()
        for place in range(0, len(sources[0]), 2):
            # a 64-bit number is not split into words, so that the sign of a number can be recognised
            halves = [words[place : place + 2] for words in sources]
            if any(terms.kind(terms.join(*words)) != "join" for words in halves) and any(
                terms.kind(word) == "part" for words in halves for word in words
            ):
                results += state.halves(operation(terms, *(terms.join(*words) for words in halves)))
            else:
                results += [operation(terms, first, second) for first, second in zip(*halves, strict=True)]
        return results

    return numeric


def _compare(suffix: str, outcomes: Outcomes | None) -> Numeric:
    """Return the function for an instruction that compares numbers: all bits of a result are 1 for true, else 0.

    ``suffix`` is the end of the instruction's name, such as ``"pd"``. The comparison is true for ``outcomes``, such as
    ``{"<", "="}``; if they are None, a constant in the instruction selects the comparison.
    """
    by_number = list(PREDICATES.values())

    def numeric(state: MachineState, sources: list[Words], constant: int) -> Words:
        if outcomes is None and not 0 <= constant < 32:
            raise NotUnderstood(f"expected a comparison predicate from 0 to 31 in the instruction, got {constant}")
        chosen = by_number[constant % 16] if outcomes is None else outcomes
        return _each(suffix, lambda terms, a, b: terms.mask(WIDTHS[suffix[1]], chosen, a, b))(state, sources, 0)

    return numeric


def _fused(suffix: str, order: str, negated: bool, subtracted: tuple[bool, ...]) -> Numeric:
    """Return the function that executes a fused multiply-add, such as a*b + c or -(a*b) - c, rounded once.

    ``suffix`` is the end of the instruction's name, such as ``"pd"``. ``order`` has the numbers of the operands: for
    "132", a is operand 1, b is operand 3 and c is operand 2. If ``negated``, the product is -(a*b). ``subtracted`` says
    whether c is subtracted: one Boolean for all numbers in a register, or two, for those at even and at odd positions.
    """
    places = tuple(int(digit) - 1 for digit in order)

    def fused(lane_subtracted: bool) -> Callable[..., int]:
        def one(terms: Terms, *lane: int) -> int:
            a, b, c = (lane[place] for place in places)
            return terms.fma(terms.neg(a) if negated else a, b, terms.neg(c) if lane_subtracted else c)

        return one

    if len(subtracted) == 2:
        return _alternating(suffix, fused(subtracted[0]), fused(subtracted[1]))
    return _each(suffix, fused(subtracted[0]), 3)


def _less(terms: Terms, a: int, b: int) -> int:
    return terms.choose(terms.mask(terms.width(a), frozenset("<"), a, b), a, b)


def _greater(terms: Terms, a: int, b: int) -> int:
    return terms.choose(terms.mask(terms.width(a), frozenset(">"), a, b), a, b)


def _blended(suffix: str) -> Numeric:
    """Return the function that executes a blend: take the second source where the third has its sign bit set.

    ``suffix`` is the end of the instruction's name, ``"pd"`` for packed doubles or ``"ps"`` for packed floats.
    """

    def one(terms: Terms, a: int, b: int, mask: int) -> int:
        # the sign bit of the mask decides
        value = terms.constant(mask)
        if value is not None:
            return b if value >> terms.width(mask) - 1 else a
        return terms.choose(mask, b, a)

    return _each(suffix, one, 3)


def _approximate(name: str) -> Callable[..., int]:
    return lambda terms, a: terms.opaque(name, terms.width(a), a)


def _same(state: MachineState, sources: list[Words], _: int) -> Words:
    if sources[0] != sources[1]:
        raise NotUnderstood("expected a comparison of floating-point numbers, got a comparison of integers")
    return [state.context.terms.bits(32, -1)] * len(sources[0])


def _shifted(width: int, shift: Callable[[int, int, int], int]) -> Numeric:
    """Return the function that executes a shift of packed integers of ``width`` bits by the instruction's constant.

    ``shift(number, count, width)`` returns one integer shifted by ``count`` bits. The returned function raises
    NotUnderstood if an integer to shift depends on the kernel's inputs.
    """

    def numeric(state: MachineState, sources: list[Words], constant: int) -> Words:
        terms, results = state.context.terms, list[int]()
        for lane in _lanes(state, sources[-1], width):
            value = terms.constant(lane)
            # kernels shift only constants
            if value is None:
                raise NotUnderstood(
                    "expected this instruction to shift a constant, got a number that depends on the kernel's inputs"
                )
            results += state.halves(
                terms.bits(width, shift(value, constant, width) if constant < width else _out(shift, value, width))
            )
        return results

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


_FUSED = (  # name, whether the product is negated, whether c is subtracted (for all, or for even and odd positions)
    ("madd", False, (False,)), ("msub", False, (True,)), ("nmadd", True, (False,)), ("nmsub", True, (True,)),
    ("maddsub", False, (True, False)), ("msubadd", False, (False, True)),
)  # fmt: skip
NUMERIC = _table()
