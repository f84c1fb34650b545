"""The effect of SSE2 and AVX instructions that only rearrange 32-bit words: unpack, shuffle, blend, insert, broadcast.

Each function of the table ``SHUFFLES`` takes the sources' words and the instruction's constant. Most instructions
do the same in every block of 128 bits. Within a block, the numbers 0 to 3 name the four words of the first source,
and the numbers 4 to 7 name the four words of the last source.
"""

from collections.abc import Callable, Sequence

from symrot.certificates.object_code.state import MachineState, NotUnderstood, Words

__all__ = ["SHUFFLES", "SOURCE_BYTES", "Shuffle"]

Shuffle = Callable[[MachineState, list[Words], int], Words]


def _pick(places: Sequence[int]) -> Shuffle:
    """Return the function that picks the words with the numbers ``places`` from each 128-bit block of the sources.

    The numbers 0 to 3 are the block's words in the first source, and 4 to 7 those in the last source.
    """

    def shuffle(_: MachineState, sources: list[Words], __: int) -> Words:
        picked: Words = []
        for start in range(0, len(sources[0]), 4):
            both = sources[0][start : start + 4] + sources[-1][start : start + 4]
            picked += [both[place] for place in places]
        return picked

    return shuffle


def _by_constant(places: Callable[[int, int], Sequence[int]]) -> Shuffle:
    """Return the function that executes a shuffle whose instruction says, by a constant, which 32-bit words to pick.

    ``places(constant, k)`` are the numbers of the words to pick from the k-th 128-bit block: 0 to 3 are the block's
    words in the first source, and 4 to 7 those in the last source.
    """

    def shuffle(state: MachineState, sources: list[Words], constant: int) -> Words:
        picked: Words = []
        for lane, start in enumerate(range(0, len(sources[0]), 4)):
            part = [words[start : start + 4] for words in sources]
            picked += _pick(places(constant, lane))(state, part, 0)
        return picked

    return shuffle


def _two_bits(constant: int) -> list[int]:
    return [constant >> 2 * place & 3 for place in range(4)]


def _shufps(constant: int, _: int) -> list[int]:
    a, b, c, d = _two_bits(constant)
    return [a, b, 4 + c, 4 + d]


def _shufpd(constant: int, lane: int) -> list[int]:
    first, second = (constant >> 2 * lane + place & 1 for place in range(2))
    return [2 * first, 2 * first + 1, 4 + 2 * second, 5 + 2 * second]


def _permilpd(constant: int, lane: int) -> list[int]:
    first, second = (constant >> 2 * lane + place & 1 for place in range(2))
    return [4 + 2 * first, 5 + 2 * first, 4 + 2 * second, 5 + 2 * second]


def _permilps(constant: int, _: int) -> list[int]:
    return [4 + place for place in _two_bits(constant)]


def _blend(words_per_bit: int) -> Shuffle:
    def shuffle(_: MachineState, sources: list[Words], constant: int) -> Words:
        first, second = sources
        return [(second if constant >> place // words_per_bit & 1 else first)[place] for place in range(len(first))]

    return shuffle


def _pblendw(_: MachineState, sources: list[Words], constant: int) -> Words:
    blended: Words = []
    for place in range(len(sources[0])):
        chosen = constant >> 2 * (place % 4) & 3
        if chosen not in (0, 3):
            raise NotUnderstood("expected a blend of 32-bit words, got a blend of 16-bit words")
        blended.append(sources[1 if chosen else 0][place])
    return blended


def _permpd(_: MachineState, sources: list[Words], constant: int) -> Words:
    return [sources[-1][2 * place + half] for place in _two_bits(constant) for half in (0, 1)]


def _permute_lanes(state: MachineState, sources: list[Words], constant: int) -> Words:
    halves = [words[start : start + 4] for words in sources for start in (0, 4)]
    picked = ((constant >> shift & 8, halves[constant >> shift & 3]) for shift in (0, 4))
    return [word for is_zero, words in picked for word in (state.zeros(4) if is_zero else words)]


def _permps(state: MachineState, sources: list[Words], _: int) -> Words:
    """Execute vpermps or vpermd: the first source contains the numbers of the words to pick from the second."""
    return [sources[1][_constant(state, word) & 7] for word in sources[0]]


def _permilps_by_words(state: MachineState, sources: list[Words], _: int) -> Words:
    return [sources[0][place & ~3 | _constant(state, word) & 3] for place, word in enumerate(sources[1])]


def _permilpd_by_words(state: MachineState, sources: list[Words], _: int) -> Words:
    chosen = [_constant(state, word) >> 1 & 1 for word in sources[1][::2]]
    return [sources[0][place // 2 * 4 + 2 * bit + half] for place, bit in enumerate(chosen) for half in (0, 1)]


def _insert_lane(_: MachineState, sources: list[Words], constant: int) -> Words:
    low, high = sources[0][:4], sources[0][4:]
    return low + sources[1] if constant & 1 else sources[1] + high


def _extract_lane(_: MachineState, sources: list[Words], constant: int) -> Words:
    return sources[-1][4 * (constant & 1) : 4 * (constant & 1) + 4]


def _insertps(state: MachineState, sources: list[Words], constant: int) -> Words:
    source = sources[1][constant >> 6 if len(sources[1]) == 4 else 0]
    words = list(sources[0])
    words[constant >> 4 & 3] = source
    return [state.zeros(1)[0] if constant >> place & 1 else word for place, word in enumerate(words)]


def _align(_: MachineState, sources: list[Words], constant: int) -> Words:
    if constant % 4 or constant > 16:
        raise NotUnderstood(f"expected a shift by 0, 4, 8, 12 or 16 bytes, got {constant} bytes")
    aligned: Words = []
    for start in range(0, len(sources[0]), 4):
        aligned += (sources[1][start : start + 4] + sources[0][start : start + 4])[constant // 4 :][:4]
    return aligned


def _shift_bytes(left: bool) -> Shuffle:
    def shuffle(state: MachineState, sources: list[Words], constant: int) -> Words:
        if constant % 4:
            raise NotUnderstood(f"expected a shift by whole 32-bit words, a multiple of 4 bytes, got {constant} bytes")
        moved, shifted = min(constant // 4, 4), list[int]()
        for start in range(0, len(sources[-1]), 4):
            words, zeros = sources[-1][start : start + 4], state.zeros(moved)
            shifted += zeros + words[: 4 - moved] if left else words[moved:] + zeros
        return shifted

    return shuffle


def _constant(state: MachineState, word: int) -> int:
    value = state.context.terms.constant(word)
    if value is None:
        raise NotUnderstood("expected a shuffle with constant indices of words, got variable indices")
    return value


def _pshufb(state: MachineState, sources: list[Words], _: int) -> Words:
    shuffled: Words = []
    for place, word in enumerate(sources[1]):
        control = _constant(state, word).to_bytes(4, "little")
        if all(byte & 0x80 for byte in control):
            shuffled += state.zeros(1)
        elif control[0] % 4 == 0 and all((byte & 0x8F) == (control[0] & 15) + i for i, byte in enumerate(control)):
            shuffled.append(sources[0][(place & ~3) + (control[0] & 15) // 4])
        else:
            raise NotUnderstood("expected a shuffle of 32-bit words, got a shuffle of single bytes")
    return shuffled


def _broadcast(count: int) -> Shuffle:
    """Return the function that executes a broadcast: it fills the register with the first ``count`` words."""
    return lambda _, sources, __: sources[-1][:count] * (8 // count)


def _broadcast_byte(state: MachineState, sources: list[Words], _: int) -> Words:
    byte = state.context.terms.lowest_byte(sources[-1][0])
    if byte is None:
        raise NotUnderstood("expected a byte that is the same for all inputs, got a byte that depends on the inputs")
    return [state.context.terms.bits(32, byte * 0x01010101)] * 8


def _doubled(_: MachineState, sources: list[Words], __: int) -> Words:
    """Execute movddup: repeat the low 64 bits of each 128 bits."""
    return [word for start in range(0, len(sources[-1]), 4) for word in sources[-1][start : start + 2] * 2]


SHUFFLES: dict[str, Shuffle] = {
    "unpcklpd": _pick((0, 1, 4, 5)), "unpckhpd": _pick((2, 3, 6, 7)), "unpcklps": _pick((0, 4, 1, 5)),
    "unpckhps": _pick((2, 6, 3, 7)), "punpcklqdq": _pick((0, 1, 4, 5)), "punpckhqdq": _pick((2, 3, 6, 7)),
    "punpckldq": _pick((0, 4, 1, 5)), "punpckhdq": _pick((2, 6, 3, 7)), "movlhps": _pick((0, 1, 4, 5)),
    "movhlps": _pick((6, 7, 2, 3)), "movshdup": _pick((5, 5, 7, 7)), "movsldup": _pick((4, 4, 6, 6)),
    "movddup": _doubled, "shufps": _by_constant(_shufps), "shufpd": _by_constant(_shufpd),
    "pshufd": _by_constant(_permilps), "permilps": _by_constant(_permilps), "permilpd": _by_constant(_permilpd),
    "blendps": _blend(1), "pblendd": _blend(1), "blendpd": _blend(2), "pblendw": _pblendw, "permpd": _permpd,
    "permq": _permpd, "perm2f128": _permute_lanes, "perm2i128": _permute_lanes, "permps": _permps, "permd": _permps,
    "insertf128": _insert_lane, "inserti128": _insert_lane, "extractf128": _extract_lane, "extracti128": _extract_lane,
    "insertps": _insertps, "palignr": _align, "psrldq": _shift_bytes(False), "pslldq": _shift_bytes(True),
    "pshufb": _pshufb, "broadcastss": _broadcast(1), "pbroadcastd": _broadcast(1), "broadcastsd": _broadcast(2),
    "pbroadcastq": _broadcast(2), "broadcastf128": _broadcast(4), "broadcasti128": _broadcast(4),
    "pbroadcastb": _broadcast_byte, "permilps by words": _permilps_by_words, "permilpd by words": _permilpd_by_words,
}  # fmt: skip
SOURCE_BYTES: dict[str, int] = {
    "insertps": 4,
    "extractf128": 32,
    "extracti128": 32,
}  # bytes of the last source, if it is in memory
