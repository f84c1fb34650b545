"""Object code = C text, rounding for rounding, for the one-sample functions of a kernel.

The machine code of a function is run on terms (:mod:`symrot.certificates.object_code.machine`), the C text is read back
(:mod:`symrot.certificates.readback.readback`), and both are compared as terms under bit-exact laws
(:mod:`symrot.certificates.object_code.terms`), case by case where comparisons of numbers decide.

What ``identical`` says: for all inputs the outputs have the same bits, signed zeros and infinities included, NaN for
NaN (their payloads are not compared); in rounding to nearest, with the same functions of libm, input and output arrays
apart from each other, and the processor and ``objdump`` right. Loops over samples (``*_batch``) are not compared.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from symrot.certificates.object_code.disassembly import Listing, listing
from symrot.certificates.object_code.machine import Finished, arguments, ways
from symrot.certificates.object_code.state import Array, Context, NotUnderstood
from symrot.certificates.object_code.terms import ANY, RELATION, Known, Outcomes, Pair, Terms, value_of
from symrot.certificates.readback.c_functions import Function, functions_of
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

IDENTICAL, CONTRACTED = "identical", "identical up to contraction"
DIFFERS, NOT_UNDERSTOOD = "differs", "not understood"
WIDTH = {"binary64": 64, "binary32": 32}
TOPS = (8, 24, 40, 56)  # places of the return address, modulo 64: 8 modulo 16 is all that is agreed on
MOST_CASES = 20_000


@dataclass(frozen=True)
class ObjectVerdict:
    """What was found of one function.

    ``verdict`` is one of "identical", "identical up to contraction" (each fused multiply-add is the product and the sum
    of the C text with one rounding fewer, the sign of a sum that is zero aside), "differs" (``output`` is the first
    that does, ``reason`` says how) and "not understood" (``reason`` names instruction and address). Only the first two
    are acceptance.
    """

    function: str
    verdict: str
    output: str = ""
    reason: str = ""
    cases: int = 0
    instructions: int = 0

    @property
    def accepted(self) -> bool:
        return self.verdict in (IDENTICAL, CONTRACTED)

    def sentence(self) -> str:
        """Return the verdict as one line."""
        where = f", output {self.output}" if self.output else ""
        return f"{self.function}: {self.verdict}{where}{f': {self.reason}' if self.reason else ''}"


def compare_object(
    text: str, path: Path, functions: Sequence[str] = (), where: str = "kernel"
) -> tuple[ObjectVerdict, ...]:
    """Compare functions of an object file with the C text they were compiled from.

    Parameters
    ----------
    text : str
        A C file as symrot emits it.
    path : Path
        What ``cc -c`` made of it, for x86-64 ELF.
    functions : sequence of str
        One-sample functions; default: all that the text defines.
    where : str
        The name of the C file, for errors.

    Raises
    ------
    CertificateError
        For a text that is not of the emitted subset, or a file that is no object file for x86-64 or lacks a function.
    CompilerError
        If there is no ``objdump``.
    """
    found = functions_of(text, where)
    names = tuple(functions) or one_sample_functions(found)
    unknown = [name for name in names if name not in found]
    if unknown:
        raise CertificateError(f"{where}: expected a definition of {unknown[0]}, got {', '.join(found)}")
    shown = listing(path)
    return tuple(compare_function(read_kernel(text, name, where), found[name], shown) for name in names)


def one_sample_functions(found: dict[str, Function]) -> tuple[str, ...]:
    """Return the names of the functions that compute one sample."""
    return tuple(
        name
        for name, function in found.items()
        if function.returns == "void" and all(p.type != "size_t" for p in function.parameters)
    )


def compare_function(text: Operations, function: Function, shown: Listing) -> ObjectVerdict:
    """Compare the operations of a C function with the machine code of the same name."""
    start = shown.function(function.name)
    masked = any(
        instruction.mnemonic == "and" and instruction.text.split(None, 1)[1].startswith("rsp,")
        for instruction in shown.code.values()
        if instruction.operands
    )
    verdicts = [_compare(text, function, shown, start, top) for top in (TOPS if masked else TOPS[:1])]
    order = (NOT_UNDERSTOOD, DIFFERS, CONTRACTED, IDENTICAL)
    return min(verdicts, key=lambda item: order.index(item.verdict))


def _compare(text: Operations, function: Function, shown: Listing, start: tuple[str, int], top: int) -> ObjectVerdict:
    width, terms = WIDTH[text.precision], Terms()
    wanted = _terms_of(text, terms, width)
    pointers = [p for p in function.parameters if p.size > 0]
    arrays = {p.name: Array(p.name, p.size * width // 8, not p.is_const) for p in pointers}
    numbers = tuple(p.name for p in function.parameters if p.size == 0)
    context = Context(terms, shown, width, arrays, top)
    worst, cases, instructions = IDENTICAL, 0, 0
    try:
        for way in ways(arguments(context, tuple(arrays), numbers, start)):
            instructions = max(instructions, way.instructions)
            got = _outputs(way, text, terms, width)
            got, known, split = _unfused(terms, got, way.known)
            for output, reason in _cases(terms, text, wanted, got, known, known is not way.known):
                cases += 1
                if output or split:
                    reason = reason or f"the product {split} is rounded in one place and fused in another"
                    return ObjectVerdict(function.name, DIFFERS, output, reason, cases, instructions)
                if cases > MOST_CASES:
                    raise NotUnderstood(f"more than {MOST_CASES} cases of comparisons")
            worst = CONTRACTED if known is not way.known else worst
    except NotUnderstood as reason:
        return ObjectVerdict(function.name, NOT_UNDERSTOOD, "", str(reason), cases, instructions)
    return ObjectVerdict(function.name, worst, "", "", cases, instructions)


def _terms_of(text: Operations, terms: Terms, width: int) -> list[int]:
    """Return the outputs of the C text as terms."""
    known: list[int] = []
    binary = {"add": terms.add, "sub": terms.sub, "mul": terms.mul, "div": terms.div, "copysign": terms.copysign}
    unary = {"neg": terms.neg, "abs": terms.abs, "sqrt": terms.sqrt}
    for node in text.nodes:
        taken = [known[place] for place in operands(node)]
        kind = node[0]
        if kind == "in":
            known.append(terms.input(width, node[1]))
        elif kind == "const":
            known.append(terms.number(width, node[1]))
        elif kind == "call":
            known.append(terms.call(node[1], width, taken))
        elif kind == "select":
            known.append(terms.choose(terms.mask(width, RELATION[node[1]], *taken[:2]), *taken[2:]))
        elif kind in unary:
            known.append(unary[kind](*taken))
        else:
            known.append(binary[kind](*taken))
    return [known[place] for _, place in text.outputs]


def _outputs(way: Finished, text: Operations, terms: Terms, width: int) -> list[int]:
    """Return the outputs as they stand in memory at the end of one way."""
    found = []
    for place, _ in text.outputs:
        name, index = place.removesuffix("]").split("[")
        words = [way.memory.get((name, (int(index) * width + 32 * part) // 8)) for part in range(width // 32)]
        if None in words:
            raise NotUnderstood(f"an end at which {place} is not written")
        found.append(words[0] if width == 32 else terms.join(*(word for word in words if word is not None)))
    return [item for item in found if item is not None]


def _unfused(terms: Terms, got: list[int], known: Known) -> tuple[list[int], Known, str]:
    """Return outputs and comparisons with every fused operation as two; and a product that is fused only in places."""
    pairs = [operand for pair in known for operand in pair]
    if not any(terms.kind(index) in ("fma", "fnma") for index in terms.order(got + pairs)):
        return got, known, ""
    merged: dict[Pair, Outcomes] = {}
    split = _split_product(terms, got + pairs)
    for pair, outcomes in known.items():
        a, b = terms.rebuilt(pair, {}, fused=False)
        turned_outcomes, *rounded = terms.compared(outcomes, a, b)
        place = (rounded[0], rounded[1])
        merged[place] = merged.get(place, ANY) & turned_outcomes
        split = split or ("" if merged[place] else shown_term(terms, a, 2))
    return terms.rebuilt(got, {}, fused=False), merged, split


def _cases(
    terms: Terms, text: Operations, wanted: list[int], got: list[int], known: Known, fused: bool
) -> Iterable[tuple[str, str]]:
    """Compare outputs in all cases that comparisons leave: of each, the first that differs and how, or nothing."""
    waiting = [dict(known)]
    while waiting:
        case = waiting.pop()
        first, second = terms.rebuilt(wanted, case), terms.rebuilt(got, case)
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
    """Return whether outputs are equal but for signs of zeros: gcc fuses -(a*b + c) into (-a)*b + (-c)."""
    return terms.without_signs_of_zero(first) == terms.without_signs_of_zero(second)


def _split_product(terms: Terms, roots: list[int]) -> str:
    """Return a product that is rounded in one place and not in another: its error would not cancel where it did."""
    below = terms.order(roots)
    fused = {terms.mul(*terms.nodes[index][2:4]) for index in below if terms.kind(index) in ("fma", "fnma")}
    both = [index for index in below if index in fused and terms.kind(index) == "mul" and not _is_exact(terms, index)]
    return shown_term(terms, both[0], 2) if both else ""


def _is_exact(terms: Terms, product: int) -> bool:
    width = terms.width(product)
    return any(terms.constant(factor) == terms.constant(terms.number(width, Fraction(2)))
               for factor in terms.nodes[product][2:])  # fmt: skip


def _difference(terms: Terms, want: int, have: int) -> str:
    """Return where two terms part, as a sentence: the C text has one operation, the object code another."""
    while True:
        first, second = terms.operands(want), terms.operands(have)
        left, right = terms.nodes[want], terms.nodes[have]
        if (
            not first
            or len(first) != len(second)
            or left[: len(left) - len(first)] != right[: len(right) - len(second)]
        ):
            break
        apart = [(a, b) for a, b in zip(first, second, strict=True) if a != b]
        if len(apart) != 1:
            break
        want, have = apart[0]
    return f"the C text has {shown_term(terms, want)}, the object code {shown_term(terms, have)}"


def shown_term(terms: Terms, index: int, depth: int = 3) -> str:
    """Return a term as text, to a depth."""
    node = terms.nodes[index]
    kind = node[0]
    if kind == "in":
        return str(node[2])
    if kind == "bits":
        return repr(value_of(node[2], node[1]))
    if kind in ("token", "address", "unknown"):
        return {"token": str(node[2]), "unknown": "a value that nobody set"}.get(kind, f"the address of {node[2]}")
    if depth == 0:
        return ".."
    name = str(node[2]) if kind == "call" else kind
    return f"{name}({', '.join(shown_term(terms, operand, depth - 1) for operand in terms.operands(index))})"
