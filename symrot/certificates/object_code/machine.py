"""Symbolic execution of one function in an object file, along every path that its comparisons allow.

Integers and addresses must be known. Where the outcome of a floating-point comparison is unknown, both branches are
followed. Unknown instructions and violations of the calling convention (System V, x86-64) raise
:class:`NotUnderstood`.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from symrot.certificates.object_code.disassembly import RELATIVE, Constant, Instruction, Memory, Register
from symrot.certificates.object_code.integers import (
    CONDITIONS,
    INTEGERS,
    condition_holds,
    operands_of,
    pop_words,
    read,
    relocated_place,
    stack_place,
)
from symrot.certificates.object_code.moves import run_vector_instruction
from symrot.certificates.object_code.state import (
    STACK,
    CallContext,
    MachineState,
    NotUnderstood,
    UndecidedBranch,
    Words,
)
from symrot.certificates.object_code.terms import Outcomes, Terms
from symrot.certificates.readback.readback import LIBRARY

__all__ = ["ExecutionPath", "execution_paths", "state_at_call"]

MAX_INSTRUCTIONS = 100_000  # on one path
MAX_PATHS = 4096  # through one function
CALLEE_SAVED = ("rbx", "rbp", "r12", "r13", "r14", "r15")
CALLER_SAVED = ("rax", "rcx", "rdx", "rsi", "rdi", "r8", "r9", "r10", "r11")
POINTERS = ("rdi", "rsi", "rdx", "rcx", "r8", "r9")
EXACT: dict[str, tuple[int, Callable[..., int]]] = {
    "sqrt": (1, Terms.sqrt), "fabs": (1, Terms.abs), "copysign": (2, Terms.copysign),
}  # fmt: skip
NO_OPERATION = {"nop", "endbr64"}


@dataclass(frozen=True)
class ExecutionPath:
    """One path through a function: the memory at the return, and the outcomes of comparisons that lead there."""

    memory: Mapping[tuple[str, int], int]
    # compared terms -> possible outcomes
    known: Mapping[tuple[int, int], Outcomes]
    instructions: int
    # addresses of the executed instructions
    visited: frozenset[tuple[str, int]]


def state_at_call(
    context: CallContext, names: tuple[str, ...], numbers: tuple[str, ...], start: tuple[str, int]
) -> MachineState:
    """Return the processor's state when a function with the arrays ``names`` and the numbers ``numbers`` is called."""
    terms = context.terms
    state = MachineState(context, start, {}, {})
    for name in (*CALLER_SAVED, *CALLEE_SAVED, "rsp"):
        state.general[name] = state.halves(terms.token(f"{name} at the call"))
    for number in range(32):
        state.vector[f"ymm{number}"] = [terms.unknown() for _ in range(8)]
    # System V: six pointers in registers, further pointers on the stack above the return address
    for place, name in enumerate(names):
        pointer = state.halves(terms.address(name, 0))
        if place < len(POINTERS):
            state.general[POINTERS[place]] = pointer
        else:
            at = context.top + 8 * (place - len(POINTERS) + 1)
            state.memory |= {(STACK, at): pointer[0], (STACK, at + 4): pointer[1]}
    if len(numbers) > 8:
        raise NotUnderstood("expected at most eight numbers as arguments, got more")
    for place, name in enumerate(numbers):
        words = state.halves(terms.input(context.width, name))
        state.vector[f"ymm{place}"][: len(words)] = words
    low, high = state.halves(terms.token("the return address"))
    state.memory |= {(STACK, context.top): low, (STACK, context.top + 4): high}
    state.general["rsp"] = state.halves(terms.address(STACK, context.top))
    return state


def execution_paths(state: MachineState) -> Iterator[ExecutionPath]:
    """Yield every path through a function, from its call to a return.

    Raises
    ------
    NotUnderstood
        If an instruction cannot be followed (the message names it and its address), or there are too many paths.
    """
    waiting, count = [(state, 0, frozenset[tuple[str, int]]())], 0
    while waiting:
        current, steps, visited = waiting.pop()
        count += 1
        if count > MAX_PATHS:
            raise NotUnderstood(f"expected at most {MAX_PATHS} paths through the function, got more")
        seen = set(visited)
        try:
            while current.at != ("", 0):
                seen.add(current.at)
                _run_step(current)
                steps += 1
                if steps > MAX_INSTRUCTIONS:
                    raise NotUnderstood(f"expected at most {MAX_INSTRUCTIONS} executed instructions, got more")
        except UndecidedBranch as split:
            for outcomes in reversed(split.branches):
                waiting.append((current.branch(split.pair, outcomes), steps, frozenset(seen)))
            continue
        yield ExecutionPath(current.memory, current.known, steps, frozenset(seen))


def _run_step(state: MachineState) -> None:
    """Execute the next instruction; if symbolic execution cannot follow it, raise NotUnderstood with its address."""
    instruction = state.context.listing.code.get(state.at)
    if instruction is None:
        raise NotUnderstood(f"expected an instruction, got none at {state.at[1]:#x} of {state.at[0]}")
    try:
        state.at = _run_instruction(state, instruction)
    except NotUnderstood as reason:
        raise NotUnderstood(
            f"{instruction.text!r} at {instruction.address:#x} of {instruction.section}: {reason}"
        ) from None


def _run_instruction(state: MachineState, instruction: Instruction) -> tuple[str, int]:
    """Execute one instruction and return the section and address of the next instruction."""
    mnemonic = instruction.mnemonic
    following = (instruction.section, instruction.address + instruction.size)
    if (
        instruction.relocation is not None
        and mnemonic not in FLOW
        and not any(isinstance(item, Memory) and item.base == "rip" for item in instruction.operands)
    ):
        raise NotUnderstood("expected an address within the object file, got an address that only the linker knows")
    if mnemonic in NO_OPERATION or (mnemonic == "xchg" and instruction.operands == (Register("ax"), Register("ax"))):
        return following
    flow = FLOW.get(mnemonic)
    if flow is not None:
        return flow(state, instruction, following)
    plain = INTEGERS.get(mnemonic)
    if plain is not None:
        plain(state, instruction)
        return following
    run_vector_instruction(state, instruction)
    return following


# --- jumps and calls --------------------------------------------------------------------------------------------------


def _target(state: MachineState, instruction: Instruction) -> tuple[str, int] | str:
    """Return the target of a jump: an address in this object file, or the name of another file's function."""
    (operand,) = operands_of(instruction, 1)
    if isinstance(operand, Constant):
        if instruction.relocation is None:
            return instruction.section, operand.value
        base, offset = relocated_place(state, instruction, RELATIVE)
        if base or not offset:
            return (base.removeprefix("section "), offset) if base else instruction.relocation.symbol
        raise NotUnderstood("expected a jump to the beginning of a function, got a jump into its middle")
    node = state.context.terms.nodes[state.whole(read(state, instruction, operand, 8))]
    if node[0] != "address" or not node[2].startswith("symbol ") or node[3]:
        raise NotUnderstood("expected a jump to a fixed address, got a computed address")
    return str(node[2].removeprefix("symbol "))


def _jump(state: MachineState, instruction: Instruction, following: tuple[str, int]) -> tuple[str, int]:
    target = _target(state, instruction)
    if isinstance(target, str):
        _call_library(state, target, 8)
        return _return(state, instruction, following)
    return target


def _jump_if(condition: str) -> Callable[[MachineState, Instruction, tuple[str, int]], tuple[str, int]]:
    def jump(state: MachineState, instruction: Instruction, following: tuple[str, int]) -> tuple[str, int]:
        target = _target(state, instruction)
        if isinstance(target, str):
            raise NotUnderstood(f"expected a jump within the function, got a jump to {target}")
        return target if condition_holds(state, condition) else following

    return jump


def _call(state: MachineState, instruction: Instruction, following: tuple[str, int]) -> tuple[str, int]:
    target = _target(state, instruction)
    if isinstance(target, str):
        _call_library(state, target, 0)
        return following
    base, offset = stack_place(state)
    terms = state.context.terms
    state.store(base, offset - 8, state.halves(terms.address(f"section {following[0]}", following[1])))
    state.general["rsp"] = state.halves(terms.address(base, offset - 8))
    return target


def _return(state: MachineState, instruction: Instruction, _: tuple[str, int]) -> tuple[str, int]:
    terms = state.context.terms
    node = terms.nodes[state.whole(pop_words(state))]
    if node == ("token", 64, "the return address"):
        if stack_place(state) != (STACK, state.context.top + 8):
            raise NotUnderstood("expected the same stack pointer at the return as at the call, got another")
        for name in CALLEE_SAVED:
            if state.general[name] != state.halves(terms.token(f"{name} at the call")):
                raise NotUnderstood(
                    f"expected the same value of register {name} at the return as at the call, got another"
                )
        return "", 0
    if node[0] != "address" or not node[2].startswith("section "):
        raise NotUnderstood("expected a return to the caller, got a return to an unknown address")
    return node[2].removeprefix("section "), node[3]


FLOW: dict[str, Callable[[MachineState, Instruction, tuple[str, int]], tuple[str, int]]] = {
    "jmp": _jump, "call": _call, "ret": _return, **{f"j{name}": _jump_if(name) for name in CONDITIONS},
}  # fmt: skip


def _call_library(state: MachineState, name: str, on_stack: int) -> None:
    """Execute a call of the C library function ``name``; registers that the call may change become unknown.

    ``on_stack`` is 0 for a call instruction, and 8 for a jump, because the return address is then on the stack.
    """
    terms = state.context.terms
    _, offset = stack_place(state)
    if (offset + on_stack) % 16:
        raise NotUnderstood("expected a stack pointer aligned to 16 bytes at a call, got another")
    bare, width = (name[:-1], 32) if name.endswith("f") else (name, 64)
    operands = [state.whole(state.vector[f"ymm{place}"][: width // 32]) for place in range(2)]
    written: list[tuple[str, int, Words]] = []
    result: Words = []
    if bare == "sincos":
        for pointer, function in (("rdi", "sin"), ("rsi", "cos")):
            node = terms.nodes[state.whole(state.general[pointer])]
            if node[0] != "address":
                raise NotUnderstood("expected known addresses for the results of sincos, got unknown addresses")
            written.append((node[2], node[3], state.halves(terms.call(function, width, operands[:1]))))
    elif bare in LIBRARY:
        result = state.halves(terms.call(bare, width, operands[: LIBRARY[bare]]))
    elif bare in EXACT:
        count, operation = EXACT[bare]
        result = state.halves(operation(terms, *operands[:count]))
    else:
        raise NotUnderstood(f"expected a call of a known C library function, got {name}")
    state.forget_below(offset)
    for place in written:
        state.store(*place)
    for register in CALLER_SAVED:
        state.general[register] = [terms.unknown(), terms.unknown()]
    for number in range(32):
        state.vector[f"ymm{number}"] = [terms.unknown() for _ in range(8)]
    state.vector["ymm0"][: len(result)] = result
    state.flags = ("unknown", ())
