"""The state of an x86-64 processor whose values are symbolic: registers, memory, flags, known comparisons.

Values are lists of 32-bit words. The outcome of a comparison is less, equal, greater or, with a NaN, unordered.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from symrot.certificates.object_code.disassembly import Listing, Memory
from symrot.certificates.object_code.terms import ANY, Outcomes, Pair, Terms

__all__ = [
    "GENERAL",
    "STACK",
    "VECTORS",
    "ArrayArgument",
    "CallContext",
    "MachineState",
    "NotUnderstood",
    "UndecidedBranch",
    "Words",
]

Words = list[int]
STACK = "stack"
_LOW = {"rax": "al", "rcx": "cl", "rdx": "dl", "rbx": "bl", "rsi": "sil", "rdi": "dil", "rbp": "bpl", "rsp": "spl"}
_OLD = {full: (f"e{full[1:]}", full[1:]) for full in _LOW}
_NEW = [f"r{number}" for number in range(8, 16)]
GENERAL: dict[str, tuple[str, int]] = {  # name -> the full register, size in bytes
    **{name: (name, 8) for name in (*_LOW, *_NEW)},
    **{short: (full, size) for full, names in _OLD.items() for short, size in zip(names, (4, 2), strict=True)},
    **{low: (full, 1) for full, low in _LOW.items()},
    **{f"{name}{mark}": (name, size) for name in _NEW for mark, size in (("d", 4), ("w", 2), ("b", 1))},
}
VECTORS: dict[str, tuple[str, int]] = {  # name -> the full register, size in words
    **{f"xmm{number}": (f"ymm{number}", 4) for number in range(32)},
    **{f"ymm{number}": (f"ymm{number}", 8) for number in range(32)},
}


class NotUnderstood(Exception):
    """Raised for an instruction, or its effect in the current state, that symbolic execution cannot follow."""


class UndecidedBranch(Exception):
    """Raised for a branch on a comparison of unknown outcome: execution must continue along both branches."""

    def __init__(self, pair: Pair, first: Outcomes, second: Outcomes) -> None:
        # ``pair``: the compared terms; ``branches``: for each branch, the comparison outcomes that lead to it
        self.pair, self.branches = pair, (first, second)


@dataclass(frozen=True)
class ArrayArgument:
    """An array argument of a function: its name, its size in bytes, and whether the function may write it."""

    name: str
    size: int
    is_output: bool


@dataclass(frozen=True)
class CallContext:
    """What stays the same while a compiled function is executed symbolically: its code, its arguments, its stack."""

    terms: Terms
    listing: Listing
    width: int  # bits of a number: 64 or 32
    arrays: Mapping[str, ArrayArgument]
    top: int  # offset of the return address: from here on the stack belongs to the caller


@dataclass
class MachineState:
    """The symbolic state of the processor before one instruction."""

    context: CallContext
    # section and address of the instruction
    at: tuple[str, int]
    general: dict[str, Words]
    vector: dict[str, Words]
    memory: dict[tuple[str, int], int] = field(default_factory=dict)
    # compared terms -> outcomes that are possible after earlier branches
    known: dict[Pair, Outcomes] = field(default_factory=dict)
    # the flags, by their origin: ("integers", (zero, sign, carry, overflow)), the flags themselves; ("numbers", (a, b))
    # after a comparison of the terms a and b, which are floating-point numbers; or ("unknown", ())
    flags: tuple[str, tuple[int, ...]] = ("unknown", ())

    def branch(self, pair: Pair, outcomes: Outcomes) -> "MachineState":
        """Return a copy of the state on the branch where comparing the two terms ``pair`` has one of ``outcomes``."""
        return replace(
            self,
            general={name: list(words) for name, words in self.general.items()},
            vector={name: list(words) for name, words in self.vector.items()},
            memory=dict(self.memory),
            known=self.known | {pair: outcomes},
        )

    # --- numbers ------------------------------------------------------------------------------------------------------

    def decide(self, outcomes: Outcomes, a: int, b: int) -> bool:
        """Return whether comparing the term ``a`` with ``b`` has one of ``outcomes``, such as less or equal.

        UndecidedBranch is raised if that depends on the inputs.
        """
        terms = self.context.terms
        a, b = terms.rebuilt((a, b), self.known)
        inner = terms.undecided((a, b))
        mask = terms.mask(terms.width(a), outcomes, a, b) if inner is None else inner
        decided = terms.constant(mask)
        if decided is not None:
            return decided != 0
        _, _, accepted, *pair = terms.nodes[mask]
        possible = self.known.get((pair[0], pair[1]), ANY)
        if inner is None and (possible <= accepted or not possible & accepted):
            return bool(possible <= accepted)
        raise UndecidedBranch((pair[0], pair[1]), possible & accepted, possible - accepted)

    def integer(self, words: Words) -> int | None:
        """Return the integer that 32-bit words hold, the lowest first; None if a word is not constant."""
        values = [self.context.terms.constant(word) for word in words]
        if any(value is None for value in values):
            return None
        return sum(value << 32 * place for place, value in enumerate(values) if value is not None)

    def whole(self, words: Words) -> int:
        """Return one or two 32-bit words, the low one first, joined into one term, a symbolic value."""
        return words[0] if len(words) == 1 else self.context.terms.join(*words)

    def halves(self, term: int) -> Words:
        """Return the 32-bit words of a term, a symbolic value of 32 or 64 bits; the low word comes first."""
        terms = self.context.terms
        return [term] if terms.width(term) == 32 else [terms.word(term, 0), terms.word(term, 1)]

    def zeros(self, count: int) -> Words:
        """Return ``count`` words whose bits are all 0."""
        return [self.context.terms.bits(32, 0)] * count

    # --- registers ----------------------------------------------------------------------------------------------------

    def register(self, name: str) -> Words:
        """Return the words of a general-purpose register of 4 or 8 bytes, or of a vector register."""
        if name in VECTORS:
            whole, count = VECTORS[name]
            return self.vector[whole][:count]
        whole, size = GENERAL.get(name, ("", 0))
        if size < 4:
            raise NotUnderstood(f"expected a register that kernels use, got {name}")
        return self.general[whole][: size // 4]

    def set_register(self, name: str, words: Words) -> None:
        """Write words to a general-purpose register; writing its lower half sets the upper half to zero."""
        whole, size = GENERAL.get(name, ("", 0))
        if size < 4 or len(words) != size // 4:
            raise NotUnderstood(f"expected a register that kernels use, got {name}")
        self.general[whole] = words + self.zeros(2 - len(words))

    def set_vector(self, name: str, words: Words, is_vex: bool) -> None:
        """Write the low words of a vector register.

        With ``is_vex`` (an instruction with the prefix ``v``), the register's other words become zero.
        """
        if name not in VECTORS:
            raise NotUnderstood(f"expected a register that kernels use, got {name}")
        whole = VECTORS[name][0]
        self.vector[whole] = words + (self.zeros(8 - len(words)) if is_vex else self.vector[whole][len(words) :])

    # --- memory -------------------------------------------------------------------------------------------------------

    def address(self, operand: Memory) -> tuple[str, int]:
        """Return the address of a memory operand as a base, such as an array or the stack, and an offset in bytes."""
        if operand.segment:
            raise NotUnderstood(
                f"expected an address without a segment, got an address in the segment {operand.segment}"
            )
        base, offset = "", operand.offset
        for name, scale in ((operand.base, 1), (operand.index, operand.scale)):
            if not name:
                continue
            if GENERAL.get(name, ("", 0))[1] != 8:
                raise NotUnderstood(f"expected a 64-bit register in an address, got {name}")
            words = self.register(name)
            node = self.context.terms.nodes[self.whole(words)]
            value = self.integer(words)
            if node[0] == "address" and scale == 1 and not base:
                base, offset = node[2], offset + node[3]
            elif value is not None:
                offset += scale * (value - (1 << 64) if value >> 63 else value)
            else:
                raise NotUnderstood(
                    "expected an address in an argument's array or on the stack, got one that cannot be computed"
                )
        if not base:
            raise NotUnderstood(
                "expected an address in an argument's array or on the stack, got one that cannot be computed"
            )
        return base, offset

    def load(self, base: str, offset: int, count: int) -> Words:
        """Return the ``count`` 32-bit words of memory that begin at an address (base and offset)."""
        if offset % 4:
            raise NotUnderstood(f"expected an address that is a multiple of 4, got the offset {offset}")
        return [self._load(base, offset + 4 * place) for place in range(count)]

    def _load(self, base: str, offset: int) -> int:
        terms, array = self.context.terms, self.context.arrays.get(base)
        if (base, offset) in self.memory:
            return self.memory[base, offset]
        if base == STACK:
            return terms.unknown()
        if array is not None:
            if not 0 <= offset < array.size:
                raise NotUnderstood(f"expected a read inside the array {array.name}, got the offset {offset}")
            if array.is_output:
                raise NotUnderstood(f"expected a write to {array.name} before it is read, got a read first")
            size = self.context.width // 8
            place = terms.input(self.context.width, f"{array.name}[{offset // size}]")
            return terms.word(place, offset % size // 4) if size == 8 else place
        content = self.context.listing.constants.get(base.removeprefix("section "), b"")
        if not base.startswith("section ") or not 0 <= offset <= len(content) - 4:
            raise NotUnderstood(f"expected a read of a known constant, got a read from {base.removeprefix('section ')}")
        return terms.bits(32, int.from_bytes(content[offset : offset + 4], "little"))

    def store(self, base: str, offset: int, words: Words) -> None:
        """Write words to memory: to the function's own part of the stack, or to an output array."""
        array = self.context.arrays.get(base)
        if offset % 4:
            raise NotUnderstood(f"expected an address that is a multiple of 4, got the offset {offset}")
        for place, word in enumerate(words):
            at = offset + 4 * place
            if array is None and not (base == STACK and at < self.context.top):
                raise NotUnderstood(
                    f"expected writes to the stack or to output arrays, got a write to {base.removeprefix('section ')}"
                )
            if array is not None and not (array.is_output and 0 <= at < array.size):
                raise NotUnderstood(f"expected writes inside the output arrays, got a write outside, to {array.name}")
            self.memory[base, at] = word

    def forget_below(self, offset: int) -> None:
        """Discard the memory below the stack pointer, which a called function may overwrite."""
        for place in [place for place in self.memory if place[0] == STACK and place[1] < offset]:
            del self.memory[place]
