"""What the instructions on whole numbers and addresses do, and where any instruction finds its operands."""

from collections.abc import Callable

from symrot.certificates.object_code.disassembly import INDIRECT, RELATIVE, Constant, Instruction, Memory, Register
from symrot.certificates.object_code.state import GENERAL, STACK, NotUnderstood, State, Words
from symrot.certificates.object_code.terms import Outcomes

__all__ = [
    "CONDITIONS",
    "INTEGERS",
    "holds",
    "linked",
    "operands_of",
    "place_of",
    "popped",
    "read",
    "stack_of",
    "symbol_of",
    "write",
]

OF_NUMBERS: dict[str, Outcomes] = {
    name: frozenset(outcomes)
    for names, outcomes in (
        ("a nbe", ">"), ("ae nb nc", "=>"), ("b nae c", "<?"), ("be na", "<=?"), ("e z", "=?"), ("ne nz", "<>"),
        ("p pe", "?"), ("np po", "<=>"),
    )
    for name in names.split()
}  # fmt: skip
OF_INTEGERS: dict[str, Callable[[int, int, int, int], bool]] = {  # zero, sign, carry, overflow
    name: test
    for names, test in (
        ("e z", lambda z, s, c, o: z), ("ne nz", lambda z, s, c, o: not z), ("s", lambda z, s, c, o: s),
        ("ns", lambda z, s, c, o: not s), ("b c nae", lambda z, s, c, o: c), ("ae nc nb", lambda z, s, c, o: not c),
        ("be na", lambda z, s, c, o: c or z), ("a nbe", lambda z, s, c, o: not (c or z)),
        ("l nge", lambda z, s, c, o: s != o), ("ge nl", lambda z, s, c, o: s == o),
        ("le ng", lambda z, s, c, o: z or s != o), ("g nle", lambda z, s, c, o: not z and s == o),
    )
    for name in names.split()
}  # fmt: skip
CONDITIONS = set(OF_NUMBERS) | set(OF_INTEGERS)


def place_of(state: State, instruction: Instruction, operand: Memory) -> tuple[str, int]:
    if operand.base != "rip":
        return state.address(operand)
    if operand.segment or operand.index:
        raise NotUnderstood(f"segment {operand.segment}")
    return linked(state, instruction, RELATIVE)


def linked(state: State, instruction: Instruction, kinds: tuple[str, ...]) -> tuple[str, int]:
    """Return base and offset that a relocation points to; base "" for what another file defines."""
    relocation = instruction.relocation
    if relocation is None or relocation.kind not in kinds:
        raise NotUnderstood("an address without a relocation of a kind that is known")
    place = state.context.listing.symbols.get(relocation.symbol)
    if place is None:
        raise NotUnderstood(f"the symbol {relocation.symbol}")
    section, offset = place
    return (f"section {section}", offset + relocation.addend) if section else ("", relocation.addend)


def symbol_of(state: State, instruction: Instruction) -> int:
    """Return the address of what another file defines, as the table of the linker holds it."""
    base, offset = linked(state, instruction, INDIRECT)
    if base or offset or instruction.relocation is None:
        raise NotUnderstood("an address that only the linker knows")
    return state.context.terms.address(f"symbol {instruction.relocation.symbol}", 0)


def read(state: State, instruction: Instruction, operand: object, size: int) -> Words:
    """Return the words of a general register, of memory or of a constant."""
    if isinstance(operand, Register):
        if GENERAL.get(operand.name, ("", 0))[1] != size:
            raise NotUnderstood(f"{operand.name} as {size} bytes")
        return state.register(operand.name)
    if isinstance(operand, Constant):
        terms = state.context.terms
        return [terms.bits(32, operand.value >> 32 * place) for place in range(size // 4)]
    assert isinstance(operand, Memory)
    if operand.segment == "fs" and (operand.base, operand.index, operand.offset) == ("", "", 0x28):
        return state.halves(state.context.terms.token("the guard of the stack"))
    if operand.base == "rip" and instruction.relocation is not None and instruction.relocation.kind in INDIRECT:
        return state.halves(symbol_of(state, instruction))
    if operand.size not in (size, 0) or size < 4:
        raise NotUnderstood(f"{operand.size} bytes of memory")
    return state.load(*place_of(state, instruction, operand), size // 4)


def write(state: State, instruction: Instruction, operand: object, words: Words) -> None:
    if isinstance(operand, Register):
        state.set_register(operand.name, words)
    elif isinstance(operand, Memory) and operand.size == 4 * len(words):
        state.store(*place_of(state, instruction, operand), words)
    else:
        raise NotUnderstood("where it writes")


def _size(instruction: Instruction) -> int:
    """Return the bytes of the first operand that tells."""
    for operand in instruction.operands:
        if isinstance(operand, Register) and operand.name in GENERAL:
            return GENERAL[operand.name][1]
        if isinstance(operand, Memory) and operand.size:
            return operand.size
    raise NotUnderstood("the size of its operands")


# --- whole numbers and addresses --------------------------------------------------------------------------------------


def _mov(state: State, instruction: Instruction) -> None:
    target, source = operands_of(instruction, 2)
    write(state, instruction, target, read(state, instruction, source, _size(instruction)))


def _lea(state: State, instruction: Instruction) -> None:
    target, source = operands_of(instruction, 2)
    if not isinstance(source, Memory) or _size(instruction) != 8:
        raise NotUnderstood("an address of less than 64 bits")
    terms = state.context.terms
    try:
        base, offset = place_of(state, instruction, source)
        words = state.halves(terms.address(base, offset))
    except NotUnderstood:
        parts = [
            (state.integer(state.register(name)) or 0) * scale
            for name, scale in ((source.base, 1), (source.index, source.scale))
            if name and name != "rip" and state.integer(state.register(name)) is not None
        ]
        if len(parts) != bool(source.base) + bool(source.index):
            raise
        words = state.halves(terms.bits(64, sum(parts) + source.offset))
    write(state, instruction, target, words)


def operands_of(instruction: Instruction, count: int) -> tuple[object, ...]:
    if len(instruction.operands) != count:
        raise NotUnderstood(f"{len(instruction.operands)} operands")
    return instruction.operands


def _arithmetic(name: str) -> Callable[[State, Instruction], None]:
    def arithmetic(state: State, instruction: Instruction) -> None:
        target, source = operands_of(instruction, 2)
        size = _size(instruction)
        if size == 1:
            _byte_test(state, instruction, name)
            return
        first, second = (read(state, instruction, item, size) for item in (target, source))
        words, flags = _computed(state, name, first, second)
        if name not in ("cmp", "test"):
            write(state, instruction, target, words)
        state.flags = flags

    return arithmetic


def _byte_test(state: State, instruction: Instruction, name: str) -> None:
    """test al, al and the like, of a byte that is known."""
    target, source = instruction.operands
    if name not in ("test", "or", "and") or target != source or not isinstance(target, Register):
        raise NotUnderstood("single bytes")
    value = _known_byte(state, target.name)
    state.flags = ("integers", (int(value == 0), value >> 7, 0, 0))


def _known_byte(state: State, name: str) -> int:
    whole, size = GENERAL.get(name, ("", 0))
    low = state.context.terms.lowest_byte(state.general[whole][0]) if size == 1 else None
    if low is None:
        raise NotUnderstood("single bytes")
    return low


def _computed(state: State, name: str, first: Words, second: Words) -> tuple[Words, tuple[str, tuple[int, ...]]]:
    terms, bits = state.context.terms, 32 * len(first)
    x, y = state.integer(first), state.integer(second)
    a, b = state.whole(first), state.whole(second)
    unknown: tuple[str, tuple[int, ...]] = ("unknown", ())
    if name in ("sub", "xor", "cmp") and first == second:
        x = y = 0
    if x is not None and y is not None:
        value = _INTEGER[name](x, y) & ((1 << bits) - 1)
        return state.halves(terms.bits(bits, value)), ("integers", _flags(name, x, y, value, bits))
    node = terms.nodes[a]
    if node[0] == "address" and y is not None and name in ("add", "sub", "and"):
        signed = y - (1 << bits) if y >> bits - 1 else y
        if name == "and" and (node[2] != STACK or signed not in (-16, -32, -64)):
            raise NotUnderstood("a mask on an address")
        offset = {"add": node[3] + signed, "sub": node[3] - signed, "and": node[3] & signed}[name]
        return state.halves(terms.address(node[2], offset)), unknown
    if name in ("and", "or", "xor"):
        return state.halves({"and": terms.bit_and, "or": terms.bit_or, "xor": terms.bit_xor}[name](a, b)), unknown
    raise NotUnderstood("whole numbers that are not known")


_INTEGER: dict[str, Callable[[int, int], int]] = {
    "add": lambda x, y: x + y, "sub": lambda x, y: x - y, "cmp": lambda x, y: x - y, "and": lambda x, y: x & y,
    "test": lambda x, y: x & y, "or": lambda x, y: x | y, "xor": lambda x, y: x ^ y, "imul": lambda x, y: x * y,
    "shl": lambda x, y: x << (y & 63), "shr": lambda x, y: x >> (y & 63),
}  # fmt: skip


def _flags(name: str, x: int, y: int, value: int, bits: int) -> tuple[int, int, int, int]:
    """Return zero, sign, carry and overflow."""
    top = bits - 1
    carry = overflow = 0
    if name in ("sub", "cmp"):
        carry, overflow = int(x < y), ((x ^ y) & (x ^ value)) >> top & 1
    elif name == "add":
        carry, overflow = int(x + y >> bits), (~(x ^ y) & (x ^ value)) >> top & 1
    return int(value == 0), value >> top, carry, overflow


def _one(name: str, number: int) -> Callable[[State, Instruction], None]:
    """Return inc, dec and shifts by one place."""

    def step(state: State, instruction: Instruction) -> None:
        (target,) = operands_of(instruction, 1)
        size = _size(instruction)
        constant = read(state, instruction, Constant(number), size)
        words, _ = _computed(state, name, read(state, instruction, target, size), constant)
        write(state, instruction, target, words)
        state.flags = ("unknown", ())

    return step


def _shift(name: str) -> Callable[[State, Instruction], None]:
    def shift(state: State, instruction: Instruction) -> None:
        target, count = instruction.operands if len(instruction.operands) == 2 else (*instruction.operands, Constant(1))
        size = _size(instruction)
        if not isinstance(count, Constant) or count.value >= 8 * size:
            raise NotUnderstood("a shift by what is no constant")
        words, _ = _computed(state, name, read(state, instruction, target, size), read(state, instruction, count, size))
        write(state, instruction, target, words)
        state.flags = ("unknown", ())

    return shift


def _imul(state: State, instruction: Instruction) -> None:
    target, *sources = instruction.operands
    size = _size(instruction)
    if not 1 <= len(sources) <= 2:
        raise NotUnderstood("its operands")
    first, second = (
        read(state, instruction, item, size) for item in (sources if len(sources) == 2 else (target, *sources))
    )
    words, _ = _computed(state, "imul", first, second)
    write(state, instruction, target, words)
    state.flags = ("unknown", ())


def _push(state: State, instruction: Instruction) -> None:
    (source,) = operands_of(instruction, 1)
    words = read(state, instruction, source, 8)
    base, offset = stack_of(state)
    state.store(base, offset - 8, words)
    state.general["rsp"] = state.halves(state.context.terms.address(base, offset - 8))


def _pop(state: State, instruction: Instruction) -> None:
    (target,) = operands_of(instruction, 1)
    write(state, instruction, target, popped(state))


def popped(state: State) -> Words:
    base, offset = stack_of(state)
    words = state.load(base, offset, 2)
    state.general["rsp"] = state.halves(state.context.terms.address(base, offset + 8))
    return words


def stack_of(state: State) -> tuple[str, int]:
    node = state.context.terms.nodes[state.whole(state.general["rsp"])]
    if node[0] != "address" or node[2] != STACK:
        raise NotUnderstood("a stack pointer that is none")
    return node[2], node[3]


def _leave(state: State, instruction: Instruction) -> None:
    state.general["rsp"] = list(state.general["rbp"])
    state.general["rbp"] = popped(state)


def holds(state: State, condition: str) -> bool:
    """Return whether a condition holds after the last comparison."""
    kind, values = state.flags
    if kind == "numbers" and condition in OF_NUMBERS:
        return state.decide(OF_NUMBERS[condition], values[0], values[1])
    if kind == "integers" and condition in OF_INTEGERS:
        zero, sign, carry, overflow = values
        return bool(OF_INTEGERS[condition](zero, sign, carry, overflow))
    raise NotUnderstood("a condition that is not known")


def _set(condition: str) -> Callable[[State, Instruction], None]:
    def set_byte(state: State, instruction: Instruction) -> None:
        (target,) = operands_of(instruction, 1)
        if not isinstance(target, Register) or GENERAL.get(target.name, ("", 0))[1] != 1:
            raise NotUnderstood("single bytes")
        whole, terms = GENERAL[target.name][0], state.context.terms
        low = terms.constant(state.general[whole][0])
        is_set = holds(state, condition)
        if low is None:
            state.general[whole][0] = terms.unknown(int(is_set))
        else:
            state.general[whole][0] = terms.bits(32, low & ~0xFF | is_set)

    return set_byte


def _movzx(state: State, instruction: Instruction) -> None:
    target, source = operands_of(instruction, 2)
    if not isinstance(source, Register) or not isinstance(target, Register):
        raise NotUnderstood("single bytes")
    byte = _known_byte(state, source.name)
    state.set_register(target.name, read(state, instruction, Constant(byte), GENERAL[target.name][1]))


def _cmov(condition: str) -> Callable[[State, Instruction], None]:
    def cmov(state: State, instruction: Instruction) -> None:
        target, source = operands_of(instruction, 2)
        size = _size(instruction)
        chosen = source if holds(state, condition) else target
        write(state, instruction, target, read(state, instruction, chosen, size))

    return cmov


INTEGERS: dict[str, Callable[[State, Instruction], None]] = {
    "mov": _mov, "movabs": _mov, "lea": _lea, "imul": _imul, "push": _push, "pop": _pop, "leave": _leave,
    "movzx": _movzx, "inc": _one("add", 1), "dec": _one("sub", 1), "shl": _shift("shl"), "sal": _shift("shl"),
    "shr": _shift("shr"),
    **{name: _arithmetic(name) for name in ("add", "sub", "and", "or", "xor", "cmp", "test")},
    **{f"set{name}": _set(name) for name in CONDITIONS}, **{f"cmov{name}": _cmov(name) for name in CONDITIONS},
}  # fmt: skip
