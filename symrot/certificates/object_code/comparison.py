"""Proofs that the object code of a kernel's one-sample functions performs the same roundings as the C text.

The machine code is executed on symbolic terms. Its outputs must equal the terms of the C text in every "case": for
every combination of outcomes of floating-point comparisons. Loops over samples (``*_batch``) are not compared.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from symrot.certificates.object_code.disassembly import Listing, read_listing
from symrot.certificates.object_code.machine import ExecutionPath, execution_paths, state_at_call
from symrot.certificates.object_code.state import ArrayArgument, CallContext, NotUnderstood
from symrot.certificates.object_code.terms import ANY, RELATION, Known, Outcomes, Pair, Terms, number_from_bits
from symrot.certificates.readback.c_functions import CFunction, functions_of
from symrot.certificates.readback.operations import Operations, operands
from symrot.certificates.readback.readback import read_kernel
from symrot.errors import CertificateError

__all__ = [
    "CONTRACTED",
    "DIFFERS",
    "IDENTICAL",
    "NOT_UNDERSTOOD",
    "ObjectVerdict",
    "compare_function",
    "compare_object",
]

# IDENTICAL: for all inputs the outputs have the same bits, signed zeros and infinities included, and are NaN together
# (payloads of NaN are not compared). Assumed: rounding to nearest, the same libm, input and output arrays that do not
# overlap, a correct processor and objdump. CONTRACTED: the code computes products and sums of the C text by fused
# multiply-adds, which round once instead of twice; apart from that, only the sign of a sum that is zero may differ.
IDENTICAL, CONTRACTED = "identical", "identical up to contraction"
DIFFERS, NOT_UNDERSTOOD = "differs", "not understood"
WIDTH = {"binary64": 64, "binary32": 32}
RETURN_ADDRESS_PLACES = (8, 24, 40, 56)  # modulo 64; the calling convention fixes the place to 8 modulo 16 only
MAX_CASES = 20_000


@dataclass(frozen=True)
class ObjectVerdict:
    """The result of comparing the machine code of one function with its C text."""

    function: str
    # one of the four texts IDENTICAL, CONTRACTED, DIFFERS, NOT_UNDERSTOOD
    verdict: str
    # the first output that differs
    output: str = ""
    # how it differs, or the instruction that is not understood
    reason: str = ""
    # number of combinations of comparison outcomes
    cases: int = 0
    # largest number of instructions executed in one case
    instructions: int = 0

    @property
    def accepted(self) -> bool:
        """Whether proofs about the C text hold for the object code: it is identical, perhaps up to contraction."""
        # the proven error bounds allow that a*b + c is rounded once instead of twice
        return self.verdict in (IDENTICAL, CONTRACTED)

    def sentence(self) -> str:
        """Return the verdict as one line: the function, the verdict, the first output that differs, and the reason."""
        where = f", output {self.output}" if self.output else ""
        return f"{self.function}: {self.verdict}{where}{f': {self.reason}' if self.reason else ''}"


def compare_object(
    text: str, path: Path, functions: Sequence[str] = (), where: str = "kernel"
) -> tuple[ObjectVerdict, ...]:
    """Compare functions of an object file with the C text from which they were compiled; return a verdict on each.

    Parameters
    ----------
    text : str
        A C file that symrot emitted.
    path : Path
        The object file that ``cc -c`` made from the C file, for x86-64 ELF.
    functions : sequence of str
        The functions to compare, each for one sample; default: all one-sample functions in the file.
    where : str
        The name of the C file, for error messages.

    Raises
    ------
    CertificateError
        If the text is not of the subset that symrot emits, or the file is not an object file for x86-64 or lacks a
        function.
    CompilerError
        If there is no ``objdump``.
    """
    functions_in_text = functions_of(text, where)
    names = tuple(functions) or one_sample_functions(functions_in_text)
    unknown = [name for name in names if name not in functions_in_text]
    if unknown:
        raise CertificateError(
            f"{where}: expected a function named {unknown[0]}, got only {', '.join(functions_in_text)}"
        )
    listing = read_listing(path)
    return tuple(compare_function(read_kernel(text, name, where), functions_in_text[name], listing) for name in names)


def one_sample_functions(functions: Mapping[str, CFunction]) -> tuple[str, ...]:
    """Return the names of the C functions for one sample; a function for many has a parameter of type ``size_t``."""
    return tuple(
        name
        for name, function in functions.items()
        if function.returns == "void" and all(p.type != "size_t" for p in function.parameters)
    )


def compare_function(text: Operations, function: CFunction, listing: Listing) -> ObjectVerdict:
    """Compare the operations of a C function, ``text``, with its machine code in ``listing``; return the verdict."""
    start = listing.function(function.name)
    masked = any(
        instruction.mnemonic == "and" and instruction.text.split(None, 1)[1].startswith("rsp,")
        for instruction in listing.code.values()
        if instruction.operands
    )
    verdicts = [
        _compare(text, function, listing, start, top)
        for top in (RETURN_ADDRESS_PLACES if masked else RETURN_ADDRESS_PLACES[:1])
    ]
    order = (NOT_UNDERSTOOD, DIFFERS, CONTRACTED, IDENTICAL)
    return min(verdicts, key=lambda item: order.index(item.verdict))


def _compare(
    text: Operations, function: CFunction, listing: Listing, start: tuple[str, int], top: int
) -> ObjectVerdict:
    """Return the verdict on a C function and its machine code at ``start``, for one alignment of the stack.

    ``top`` is the offset of the return address on the stack.
    """
    width, terms = WIDTH[text.precision], Terms()
    expected = _terms_from_operations(text, terms, width)
    # the remainder of ``top`` modulo 64 is the alignment
    pointers = [p for p in function.parameters if p.size > 0]
    arrays = {p.name: ArrayArgument(p.name, p.size * width // 8, not p.is_const) for p in pointers}
    numbers = tuple(p.name for p in function.parameters if p.size == 0)
    context = CallContext(terms, listing, width, arrays, top)
    worst, cases, instructions = IDENTICAL, 0, 0
    try:
        for path in execution_paths(state_at_call(context, tuple(arrays), numbers, start)):
            instructions = max(instructions, path.instructions)
            outputs = _outputs(path, text, terms, width)
            outputs, known, split = _unfused(terms, outputs, path.known)
            for output, reason in _cases(terms, text, expected, outputs, known, known is not path.known):
                cases += 1
                if output or split:
                    reason = reason or f"the product {split} is rounded in one place and fused in another"
                    return ObjectVerdict(function.name, DIFFERS, output, reason, cases, instructions)
                if cases > MAX_CASES:
                    raise NotUnderstood(
                        f"expected at most {MAX_CASES} combinations of outcomes of comparisons, got more"
                    )
            worst = CONTRACTED if known is not path.known else worst
    except NotUnderstood as reason:
        return ObjectVerdict(function.name, NOT_UNDERSTOOD, "", str(reason), cases, instructions)
    return ObjectVerdict(function.name, worst, "", "", cases, instructions)


def _terms_from_operations(text: Operations, terms: Terms, width: int) -> list[int]:
    """Return the outputs of the C text as symbolic terms of ``width`` bits, added to the store ``terms``."""
    known: list[int] = []
    binary = {"add": terms.add, "sub": terms.sub, "mul": terms.mul, "div": terms.div, "copysign": terms.copysign}
    unary = {"neg": terms.neg, "abs": terms.abs, "sqrt": terms.sqrt}
    for node in text.nodes:
        arguments = [known[place] for place in operands(node)]
        kind = node[0]
        if kind == "in":
            known.append(terms.input(width, node[1]))
        elif kind == "const":
            known.append(terms.number(width, node[1]))
        elif kind == "call":
            known.append(terms.call(node[1], width, arguments))
        elif kind == "select":
            known.append(terms.choose(terms.mask(width, RELATION[node[1]], *arguments[:2]), *arguments[2:]))
        elif kind in unary:
            known.append(unary[kind](*arguments))
        else:
            known.append(binary[kind](*arguments))
    return [known[place] for _, place in text.outputs]


def _outputs(path: ExecutionPath, text: Operations, terms: Terms, width: int) -> list[int]:
    """Return the output values at the end of a path, in the order of the outputs in ``text``.

    A value is the number of a symbolic term in the store ``terms``. NotUnderstood is raised if an output is not
    written.
    """
    outputs = []
    for place, _ in text.outputs:
        name, index = place.removesuffix("]").split("[")
        words = [path.memory.get((name, (int(index) * width + 32 * part) // 8)) for part in range(width // 32)]
        if None in words:
            raise NotUnderstood(f"expected every path through the code to write {place}, got a path that does not")
        outputs.append(words[0] if width == 32 else terms.join(*(word for word in words if word is not None)))
    return [item for item in outputs if item is not None]


def _unfused(terms: Terms, got: list[int], known: Known) -> tuple[list[int], Known, str]:
    """Return the outputs ``got`` and the comparisons ``known`` with each fused a*b + c split into product and sum.

    After the split, product and sum are rounded separately, as in the C text. ``known`` maps pairs of compared terms to
    the outcomes that are possible on this path through the code. The split is not valid if the code has a product that
    is rounded in one place and fused in another, or if it makes the known comparisons of a number contradict each
    other. The third result is the text of such a product or number, and the code is then rejected; if the split is
    valid, it is ``""``.
    """
    pairs = [operand for pair in known for operand in pair]
    if not any(terms.kind(index) in ("fma", "fnma") for index in terms.order(got + pairs)):
        return got, known, ""
    merged: dict[Pair, Outcomes] = {}
    split = _split_product(terms, got + pairs)
    for pair, outcomes in known.items():
        a, b = terms.rebuilt(pair, {}, fused=False)
        swapped_outcomes, *rounded = terms.compared(outcomes, a, b)
        place = (rounded[0], rounded[1])
        merged[place] = merged.get(place, ANY) & swapped_outcomes
        split = split or ("" if merged[place] else term_text(terms, a, 2))
    return terms.rebuilt(got, {}, fused=False), merged, split


def _cases(
    terms: Terms, text: Operations, expected: list[int], got: list[int], known: Known, fused: bool
) -> Iterable[tuple[str, str]]:
    """Yield, for each combination of comparison outcomes, the first output that differs and the reason.

    Both texts are empty if all outputs agree. ``expected`` are outputs of the C text, ``got`` of the machine code.
    """
    waiting = [dict(known)]
    while waiting:
        case = waiting.pop()
        first, second = terms.rebuilt(expected, case), terms.rebuilt(got, case)
        # ``fused``: the machine code has fused multiply-adds
        if first == second or (fused and _apart_from_zeros(terms, first, second)):
            yield "", ""
            continue
        mask = terms.undecided(first + second)
        if mask is None:
            pairs = zip(text.outputs, first, second, strict=True)
            yield next((place, _difference(terms, a, b)) for (place, _), a, b in pairs if a != b)
            continue
        _, _, outcomes, a, b = terms.nodes[mask]
        possible = case.get((a, b), ANY)
        waiting += [case | {(a, b): possible - outcomes}, case | {(a, b): possible & outcomes}]


def _apart_from_zeros(terms: Terms, first: list[int], second: list[int]) -> bool:
    """Return whether two lists of outputs differ at most in the signs of zeros."""
    # gcc turns -(a*b + c) into a fused (-a)*b - c, which differs only in these signs
    return terms.without_signs_of_zero(first) == terms.without_signs_of_zero(second)


def _split_product(terms: Terms, roots: list[int]) -> str:
    """Return the text of a product that is rounded in one place and fused into a multiply-add elsewhere, or ``""``."""
    # the rounding errors of such a product may cancel in the C text, but do not cancel in the object code
    below = terms.order(roots)
    fused = {terms.mul(*terms.nodes[index][2:4]) for index in below if terms.kind(index) in ("fma", "fnma")}
    both = [index for index in below if index in fused and terms.kind(index) == "mul" and not _is_exact(terms, index)]
    return term_text(terms, both[0], 2) if both else ""


def _is_exact(terms: Terms, product: int) -> bool:
    """Return whether a product (a term) needs no rounding, because one factor is the constant 2."""
    width = terms.width(product)
    return any(terms.constant(factor) == terms.constant(terms.number(width, Fraction(2)))
               for factor in terms.nodes[product][2:])  # fmt: skip


def _difference(terms: Terms, expected: int, got: int) -> str:
    """Return a sentence with the innermost difference of the terms ``expected`` (C text) and ``got`` (object code)."""
    while True:
        first, second = terms.operands(expected), terms.operands(got)
        left, right = terms.nodes[expected], terms.nodes[got]
        if (
            not first
            or len(first) != len(second)
            or left[: len(left) - len(first)] != right[: len(right) - len(second)]
        ):
            break
        apart = [(a, b) for a, b in zip(first, second, strict=True) if a != b]
        if len(apart) != 1:
            break
        expected, got = apart[0]
    return f"the C text has {term_text(terms, expected)}, the object code {term_text(terms, got)}"


def term_text(terms: Terms, index: int, depth: int = 3) -> str:
    """Return a symbolic term as text, such as ``add(mul(a, b), c)``; operations deeper than ``depth`` become ``..``."""
    node = terms.nodes[index]
    kind = node[0]
    if kind == "in":
        return str(node[2])
    if kind == "bits":
        return repr(number_from_bits(node[2], node[1]))
    if kind in ("token", "address", "unknown"):
        return {"token": str(node[2]), "unknown": "a value that nobody set"}.get(kind, f"the address of {node[2]}")
    if depth == 0:
        return ".."
    name = str(node[2]) if kind == "call" else kind
    return f"{name}({', '.join(term_text(terms, operand, depth - 1) for operand in terms.operands(index))})"
