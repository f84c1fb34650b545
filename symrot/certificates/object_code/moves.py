"""The execution of SSE2 and AVX instructions on symbolic values.

Moves are executed here, other instructions by functions in the tables ``SHUFFLES`` (shuffles.py) and ``NUMERIC``
(numbers.py). ``bare`` is an instruction's name without the prefix ``v`` of its VEX form, and ``is_vex`` tells whether
it had that prefix: ``vaddpd`` is ``addpd``, True.
"""

from collections.abc import Callable

from symrot.certificates.object_code.disassembly import Constant, Instruction, Memory, Register
from symrot.certificates.object_code.integers import memory_place, operands_of, read, write
from symrot.certificates.object_code.numbers import NUMERIC
from symrot.certificates.object_code.shuffles import SHUFFLES, SOURCE_BYTES
from symrot.certificates.object_code.state import VECTORS, MachineState, NotUnderstood, Words

__all__ = ["run_vector_instruction"]

ALIGNED = {"movaps", "movapd", "movdqa", "movdqa32", "movdqa64", "movntpd", "movntps"}
UNALIGNED = {"movups", "movupd", "movdqu", "movdqu32", "movdqu64", "lddqu"}


def _source(state: MachineState, instruction: Instruction, operand: object, size: int, bare: str) -> Words:
    """Return the 32-bit words of a source operand: a vector register, or ``size`` bytes of memory.

    ``bare`` is the instruction's name without the prefix ``v``. The name decides whether the address in memory must be
    a multiple of ``size`` (aligned). If so, NotUnderstood is raised for an address that may not be aligned.
    """
    if isinstance(operand, Register) and operand.name in VECTORS:
        return list(state.register(operand.name))
    if not isinstance(operand, Memory) or operand.size not in (size, 0):
        raise NotUnderstood(
            "expected a vector register or memory of the instruction's size as source, got another operand"
        )
    base, offset = memory_place(state, instruction, operand)
    is_vex = instruction.mnemonic.startswith("v")
    must_be_aligned = size >= 16 and bare not in UNALIGNED and (not is_vex or bare in ALIGNED)
    if must_be_aligned and (base in state.context.arrays or offset % size):
        raise NotUnderstood(f"expected an aligned address, got an address in {base} that may not be aligned")
    return state.load(base, offset, size // 4)


def run_vector_instruction(state: MachineState, instruction: Instruction) -> None:
    """Execute an instruction on vector registers; raise NotUnderstood if its effect is unknown."""
    is_vex = instruction.mnemonic.startswith("v")
    bare = instruction.mnemonic[1:] if is_vex else instruction.mnemonic
    move = MOVES.get(bare)
    if move is not None:
        move(state, instruction, bare, is_vex)
        return
    operands = instruction.operands
    constant = operands[-1].value if operands and isinstance(operands[-1], Constant) else None
    if constant is not None:
        operands = operands[:-1]
    elif bare.startswith(("psll", "psrl", "psra")):
        raise NotUnderstood("expected a shift by a constant, got a variable shift")
    if constant is None and is_vex and bare in ("permilps", "permilpd"):
        bare = f"{bare} by words"
    operation = SHUFFLES.get(bare) or NUMERIC.get(bare)
    if operation is None or not operands:
        raise NotUnderstood(f"expected a machine instruction that symrot can execute, got {bare}")
    target = operands[0]
    if isinstance(target, Memory):  # vextractf128
        words = operation(state, [_source(state, instruction, item, 32, bare) for item in operands[1:]], constant or 0)
        write(state, instruction, target, words)
        return
    if not isinstance(target, Register) or target.name not in VECTORS:
        raise NotUnderstood("expected a vector register or memory as destination, got another operand")
    count = VECTORS[target.name][1]
    keeps_target = not is_vex or bare.startswith(("fmadd", "fmsub", "fnmadd", "fnmsub"))
    source_words = [
        _source(state, instruction, item, _bytes_of(bare, item, 4 * count), bare)
        for item in (operands if keeps_target else operands[1:])
    ]
    state.set_vector(target.name, operation(state, source_words, constant or 0)[:count], is_vex)


def _bytes_of(bare: str, operand: object, whole: int) -> int:
    """Return how many bytes an instruction reads from a source operand, at most ``whole``, the size of its register."""
    if not isinstance(operand, Memory):
        return whole
    if bare in SOURCE_BYTES:
        return SOURCE_BYTES[bare]
    if bare.startswith(("broadcast", "pbroadcast", "insertf128", "inserti128", "movddup")):
        return operand.size
    # movsd, for example, reads 8 bytes from memory
    if bare.endswith(("sd", "ss")) and not bare.startswith("p"):
        return 8 if bare.endswith("sd") else 4
    return whole


def _move_whole(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
    target, source = operands_of(instruction, 2)
    if isinstance(target, Memory):
        words = _source(state, instruction, source, 0, bare)
        base, offset = memory_place(state, instruction, target)
        if bare in ALIGNED and (base in state.context.arrays or offset % (4 * len(words))):
            raise NotUnderstood(f"expected an aligned address, got an address in {base} that may not be aligned")
        write(state, instruction, target, words)
        return
    assert isinstance(target, Register)
    count = VECTORS.get(target.name, ("", 0))[1]
    state.set_vector(target.name, _source(state, instruction, source, 4 * count, bare), is_vex)


def _move_scalar(size: int) -> Callable[[MachineState, Instruction, str, bool], None]:
    """Return the function that executes movss (``size`` 4) or movsd (``size`` 8), which copies one number."""

    def move(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
        target, *sources = instruction.operands
        words = _source(state, instruction, sources[-1], size, bare)[: size // 4]
        if isinstance(target, Memory):
            write(state, instruction, target, words)
            return
        assert isinstance(target, Register)
        # a load clears the upper words of the register, a move between registers keeps them
        if isinstance(sources[-1], Memory):
            rest = state.zeros(4 - len(words))
        else:
            first = sources[0] if len(sources) == 2 else target
            rest = _source(state, instruction, first, 16, bare)[size // 4 :]
        state.set_vector(target.name, words + rest, is_vex)

    return move


def _move_bits(size: int) -> Callable[[MachineState, Instruction, str, bool], None]:
    """Return the function that executes movd (``size`` 4) or movq (8): copy bits between registers and memory."""

    def move(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
        target, source = operands_of(instruction, 2)
        if isinstance(source, Register) and source.name in VECTORS:
            words = state.register(source.name)[: size // 4]
        else:
            words = read(state, instruction, source, size)
        if isinstance(target, Register) and target.name in VECTORS:
            state.set_vector(target.name, words + state.zeros(4 - len(words)), is_vex)
        else:
            write(state, instruction, target, list(words))

    return move


def _move_half(start: int) -> Callable[[MachineState, Instruction, str, bool], None]:
    """Return the function that executes movlpd (``start`` 0) or movhpd (2), which move half a 128-bit register."""

    def move(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
        # ``start`` is the first 32-bit word of the half
        target, *sources = instruction.operands
        if isinstance(target, Memory):
            write(state, instruction, target, _source(state, instruction, sources[0], 0, bare)[start : start + 2])
            return
        assert isinstance(target, Register)
        first = _source(state, instruction, sources[0] if len(sources) == 2 else target, 16, bare)
        words = _source(state, instruction, sources[-1], 8, bare)
        if not isinstance(sources[-1], Memory):
            raise NotUnderstood("expected memory as source, got a register")
        state.set_vector(target.name, first[:start] + words + first[start + 2 :], is_vex)

    return move


def _extract(size: int) -> Callable[[MachineState, Instruction, str, bool], None]:
    def move(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
        target, source, place = operands_of(instruction, 3)
        if not isinstance(place, Constant):
            raise NotUnderstood("expected a constant as last operand, got another operand")
        start = place.value * (size // 4) % 4
        write(state, instruction, target, _source(state, instruction, source, 16, bare)[start : start + size // 4])

    return move


def _insert(size: int) -> Callable[[MachineState, Instruction, str, bool], None]:
    def move(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
        target, *sources, place = instruction.operands
        if not isinstance(place, Constant) or not isinstance(target, Register):
            raise NotUnderstood("expected a register as destination and a constant as last operand, got other operands")
        first = _source(state, instruction, sources[0] if len(sources) == 2 else target, 16, bare)
        start, words = place.value * (size // 4) % 4, read(state, instruction, sources[-1], size)
        state.set_vector(target.name, first[:start] + words + first[start + size // 4 :], is_vex)

    return move


def _ucomi(size: int) -> Callable[[MachineState, Instruction, str, bool], None]:
    def compare(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
        first, second = (
            _source(state, instruction, item, size, bare)[: size // 4] for item in operands_of(instruction, 2)
        )
        state.flags = ("numbers", (state.whole(first), state.whole(second)))

    return compare


def _clear_upper(state: MachineState, instruction: Instruction, bare: str, is_vex: bool) -> None:
    for number in range(16):
        state.vector[f"ymm{number}"][4:] = state.zeros(4)


MOVES: dict[str, Callable[[MachineState, Instruction, str, bool], None]] = {
    **dict.fromkeys(sorted(ALIGNED | UNALIGNED), _move_whole),
    "zeroupper": _clear_upper, "ucomisd": _ucomi(8), "comisd": _ucomi(8), "ucomiss": _ucomi(4), "comiss": _ucomi(4),
    "movss": _move_scalar(4), "movsd": _move_scalar(8), "movd": _move_bits(4), "movq": _move_bits(8),
    "movlpd": _move_half(0), "movlps": _move_half(0), "movhpd": _move_half(2), "movhps": _move_half(2),
    "extractps": _extract(4), "pextrd": _extract(4), "pextrq": _extract(8), "pinsrd": _insert(4), "pinsrq": _insert(8),
}  # fmt: skip
