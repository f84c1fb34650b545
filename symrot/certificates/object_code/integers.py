"""The effect of machine instructions on integers and addresses; reading and writing of operands.

Values are lists of 32-bit words. An address is a pair (base, offset): the base is an array, the stack, a section or a
symbol. Functions raise NotUnderstood for an effect that symbolic execution cannot follow.
"""

from collections.abc import Callable

from symrot.certificates.object_code.disassembly import INDIRECT, RELATIVE, Constant, Instruction, Memory, Register
from symrot.certificates.object_code.state import GENERAL, STACK, MachineState, NotUnderstood, Words
from symrot.certificates.object_code.terms import Outcomes

__all__ = [
    "CONDITIONS",
    "INTEGERS",
    "condition_holds",
    "memory_place",
    "operands_of",
    "pop_words",
    "read",
    "relocated_place",
    "stack_place",
    "symbol_of",
    "write",
]

SINGLE_BYTES = "expected an instruction on registers of 4 or 8 bytes, got one on single bytes whose value is not known"

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


def memory_place(state: MachineState, instruction: Instruction, operand: Memory) -> tuple[str, int]:
    """Return the address of a memory operand as (base, offset in bytes); the base is, for example, an array."""
    if operand.base != "rip":
        return state.address(operand)
    if operand.segment or operand.index:
        raise NotUnderstood(f"expected an address without a segment, got an address in the segment {operand.segment}")
    # relative to the address of the instruction
    return relocated_place(state, instruction, RELATIVE)


def relocated_place(state: MachineState, instruction: Instruction, kinds: tuple[str, ...]) -> tuple[str, int]:
    """Return (base, offset) of the address that the linker fills into an instruction.

    NotUnderstood is raised unless the kind of the relocation, such as ``"R_X86_64_PC32"``, is in ``kinds``.
    """
    relocation = instruction.relocation
    if relocation is None or relocation.kind not in kinds:
        raise NotUnderstood("expected an address that a relocation of a known kind defines, got another address")
    place = state.context.listing.symbols.get(relocation.symbol)
    if place is None:
        raise NotUnderstood(f"expected an address of the object file's symbol table, got {relocation.symbol}")
    section, offset = place
    # the base is empty for a symbol of another file
    return (f"section {section}", offset + relocation.addend) if section else ("", relocation.addend)


def symbol_of(state: MachineState, instruction: Instruction) -> int:
    """Return the term for the address of another file's symbol, such as a function of the C library."""
    # the instruction reads the address from the global offset table, which the linker fills
    base, offset = relocated_place(state, instruction, INDIRECT)
    if base or offset or instruction.relocation is None:
        raise NotUnderstood("expected an address within the object file, got an address that only the linker knows")
    return state.context.terms.address(f"symbol {instruction.relocation.symbol}", 0)


def read(state: MachineState, instruction: Instruction, operand: object, size: int) -> Words:
    """Return the value of a source operand of ``size`` bytes as 32-bit words, the lowest first."""
    if isinstance(operand, Register):
        if GENERAL.get(operand.name, ("", 0))[1] != size:
            raise NotUnderstood(f"expected {size} bytes, got the register {operand.name} of another size")
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
        raise NotUnderstood(
            f"expected an access to memory of the instruction's operand size, got an access to {operand.size} bytes"
        )
    return state.load(*memory_place(state, instruction, operand), size // 4)


def write(state: MachineState, instruction: Instruction, operand: object, words: Words) -> None:
    """Write 32-bit words to a destination operand: a general-purpose register or memory."""
    if isinstance(operand, Register):
        state.set_register(operand.name, words)
    elif isinstance(operand, Memory) and operand.size == 4 * len(words):
        state.store(*memory_place(state, instruction, operand), words)
    else:
        raise NotUnderstood("expected a general-purpose register or memory as destination, got another operand")


def _size(instruction: Instruction) -> int:
    """Return the number of bytes on which an instruction acts: the size of its first operand whose size is known."""
    for operand in instruction.operands:
        if isinstance(operand, Register) and operand.name in GENERAL:
            return GENERAL[operand.name][1]
        if isinstance(operand, Memory) and operand.size:
            return operand.size
    raise NotUnderstood("expected an operand whose size is known, got none")


# --- integers and addresses -------------------------------------------------------------------------------------------


def _mov(state: MachineState, instruction: Instruction) -> None:
    target, source = operands_of(instruction, 2)
    write(state, instruction, target, read(state, instruction, source, _size(instruction)))


def _lea(state: MachineState, instruction: Instruction) -> None:
    target, source = operands_of(instruction, 2)
    if not isinstance(source, Memory) or _size(instruction) != 8:
        raise NotUnderstood("expected an address of 64 bits, got a shorter one")
    terms = state.context.terms
    try:
        base, offset = memory_place(state, instruction, source)
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
    """Return the operands of an instruction; raise NotUnderstood unless there are ``count`` operands."""
    if len(instruction.operands) != count:
        raise NotUnderstood(f"expected {count} operands, got {len(instruction.operands)}")
    return instruction.operands


def _arithmetic(name: str) -> Callable[[MachineState, Instruction], None]:
    def arithmetic(state: MachineState, instruction: Instruction) -> None:
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


def _byte_test(state: MachineState, instruction: Instruction, name: str) -> None:
    """Execute a test of one byte, such as ``test al, al``; the value of the byte must be known."""
    target, source = instruction.operands
    if name not in ("test", "or", "and") or target != source or not isinstance(target, Register):
        raise NotUnderstood(SINGLE_BYTES)
    value = _known_byte(state, target.name)
    state.flags = ("integers", (int(value == 0), value >> 7, 0, 0))


def _known_byte(state: MachineState, name: str) -> int:
    whole, size = GENERAL.get(name, ("", 0))
    low = state.context.terms.lowest_byte(state.general[whole][0]) if size == 1 else None
    if low is None:
        raise NotUnderstood(SINGLE_BYTES)
    return low


def _computed(state: MachineState, name: str, first: Words, second: Words) -> tuple[Words, tuple[str, tuple[int, ...]]]:
    """Return the result and the flags of the instruction ``name``, such as ``add``, on two integers or addresses.

    If both operands are known integers, the flags are ``("integers", (zero, sign, carry, overflow))``; otherwise they
    are ``("unknown", ())``.
    """
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
            raise NotUnderstood("expected integers as operands of a bit mask, got an address")
        offset = {"add": node[3] + signed, "sub": node[3] - signed, "and": node[3] & signed}[name]
        return state.halves(terms.address(node[2], offset)), unknown
    if name in ("and", "or", "xor"):
        return state.halves({"and": terms.bit_and, "or": terms.bit_or, "xor": terms.bit_xor}[name](a, b)), unknown
    raise NotUnderstood(
        f"expected operands of {name} that are the same for all inputs, such as loop counters, got other values"
    )


_INTEGER: dict[str, Callable[[int, int], int]] = {
    "add": lambda x, y: x + y, "sub": lambda x, y: x - y, "cmp": lambda x, y: x - y, "and": lambda x, y: x & y,
    "test": lambda x, y: x & y, "or": lambda x, y: x | y, "xor": lambda x, y: x ^ y, "imul": lambda x, y: x * y,
    "shl": lambda x, y: x << (y & 63), "shr": lambda x, y: x >> (y & 63),
}  # fmt: skip


def _flags(name: str, x: int, y: int, value: int, bits: int) -> tuple[int, int, int, int]:
    """Return the flags (zero, sign, carry, overflow) after the instruction ``name`` on x and y gave ``value``."""
    top = bits - 1
    carry = overflow = 0
    if name in ("sub", "cmp"):
        carry, overflow = int(x < y), ((x ^ y) & (x ^ value)) >> top & 1
    elif name == "add":
        carry, overflow = int(x + y >> bits), (~(x ^ y) & (x ^ value)) >> top & 1
    return int(value == 0), value >> top, carry, overflow


def _with_constant(name: str, number: int) -> Callable[[MachineState, Instruction], None]:
    """Return the function that adds ``number`` to the operand (``name`` "add"), or subtracts it ("sub").

    ``number`` = 1 gives the instructions ``inc`` and ``dec``.
    """

    def step(state: MachineState, instruction: Instruction) -> None:
        (target,) = operands_of(instruction, 1)
        size = _size(instruction)
        constant = read(state, instruction, Constant(number), size)
        words, _ = _computed(state, name, read(state, instruction, target, size), constant)
        write(state, instruction, target, words)
        state.flags = ("unknown", ())

    return step


def _shift(name: str) -> Callable[[MachineState, Instruction], None]:
    def shift(state: MachineState, instruction: Instruction) -> None:
        target, count = instruction.operands if len(instruction.operands) == 2 else (*instruction.operands, Constant(1))
        size = _size(instruction)
        if not isinstance(count, Constant) or count.value >= 8 * size:
            raise NotUnderstood("expected a shift by a constant, got a variable shift")
        words, _ = _computed(state, name, read(state, instruction, target, size), read(state, instruction, count, size))
        write(state, instruction, target, words)
        state.flags = ("unknown", ())

    return shift


def _imul(state: MachineState, instruction: Instruction) -> None:
    target, *sources = instruction.operands
    size = _size(instruction)
    if not 1 <= len(sources) <= 2:
        raise NotUnderstood(f"expected two or three operands, got {len(instruction.operands)}")
    first, second = (
        read(state, instruction, item, size) for item in (sources if len(sources) == 2 else (target, *sources))
    )
    words, _ = _computed(state, "imul", first, second)
    write(state, instruction, target, words)
    state.flags = ("unknown", ())


def _push(state: MachineState, instruction: Instruction) -> None:
    (source,) = operands_of(instruction, 1)
    words = read(state, instruction, source, 8)
    base, offset = stack_place(state)
    state.store(base, offset - 8, words)
    state.general["rsp"] = state.halves(state.context.terms.address(base, offset - 8))


def _pop(state: MachineState, instruction: Instruction) -> None:
    (target,) = operands_of(instruction, 1)
    write(state, instruction, target, pop_words(state))


def pop_words(state: MachineState) -> Words:
    """Pop 8 bytes from the stack and return them as two 32-bit words."""
    base, offset = stack_place(state)
    words = state.load(base, offset, 2)
    state.general["rsp"] = state.halves(state.context.terms.address(base, offset + 8))
    return words


def stack_place(state: MachineState) -> tuple[str, int]:
    """Return the address (base and offset) to which the stack pointer points."""
    node = state.context.terms.nodes[state.whole(state.general["rsp"])]
    if node[0] != "address" or node[2] != STACK:
        raise NotUnderstood("expected a stack pointer that points into the stack, got another value")
    return node[2], node[3]


def _leave(state: MachineState, instruction: Instruction) -> None:
    state.general["rsp"] = list(state.general["rbp"])
    state.general["rbp"] = pop_words(state)


def condition_holds(state: MachineState, condition: str) -> bool:
    """Return whether a conditional jump such as ``jne``, whose ``condition`` is ``"ne"``, is taken.

    UndecidedBranch is raised if that depends on the inputs, NotUnderstood if the flags are unknown.
    """
    kind, values = state.flags
    if kind == "numbers" and condition in OF_NUMBERS:
        return state.decide(OF_NUMBERS[condition], values[0], values[1])
    if kind == "integers" and condition in OF_INTEGERS:
        zero, sign, carry, overflow = values
        return bool(OF_INTEGERS[condition](zero, sign, carry, overflow))
    raise NotUnderstood(
        f"expected processor flags that symrot has computed for the condition {condition!r}, got flags that it "
        "does not know"
    )


def _set(condition: str) -> Callable[[MachineState, Instruction], None]:
    def set_byte(state: MachineState, instruction: Instruction) -> None:
        (target,) = operands_of(instruction, 1)
        if not isinstance(target, Register) or GENERAL.get(target.name, ("", 0))[1] != 1:
            raise NotUnderstood(SINGLE_BYTES)
        whole, terms = GENERAL[target.name][0], state.context.terms
        low = terms.constant(state.general[whole][0])
        is_set = condition_holds(state, condition)
        if low is None:
            state.general[whole][0] = terms.unknown(int(is_set))
        else:
            state.general[whole][0] = terms.bits(32, low & ~0xFF | is_set)

    return set_byte


def _movzx(state: MachineState, instruction: Instruction) -> None:
    target, source = operands_of(instruction, 2)
    if not isinstance(source, Register) or not isinstance(target, Register):
        raise NotUnderstood(SINGLE_BYTES)
    byte = _known_byte(state, source.name)
    state.set_register(target.name, read(state, instruction, Constant(byte), GENERAL[target.name][1]))


def _cmov(condition: str) -> Callable[[MachineState, Instruction], None]:
    def cmov(state: MachineState, instruction: Instruction) -> None:
        target, source = operands_of(instruction, 2)
        size = _size(instruction)
        chosen = source if condition_holds(state, condition) else target
        write(state, instruction, target, read(state, instruction, chosen, size))

    return cmov


INTEGERS: dict[str, Callable[[MachineState, Instruction], None]] = {
    "mov": _mov, "movabs": _mov, "lea": _lea, "imul": _imul, "push": _push, "pop": _pop, "leave": _leave,
    "movzx": _movzx, "inc": _with_constant("add", 1), "dec": _with_constant("sub", 1),
    "shl": _shift("shl"), "sal": _shift("shl"), "shr": _shift("shr"),
    **{name: _arithmetic(name) for name in ("add", "sub", "and", "or", "xor", "cmp", "test")},
    **{f"set{name}": _set(name) for name in CONDITIONS}, **{f"cmov{name}": _cmov(name) for name in CONDITIONS},
}  # fmt: skip
