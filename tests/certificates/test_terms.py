"""The laws of terms are exact to the bit, and instructions on terms agree with the processor."""

import ctypes
import math
import random
import struct
import subprocess
from fractions import Fraction

import pytest

from symrot.certificates.object_code import machine
from symrot.certificates.object_code.disassembly import read_listing
from symrot.certificates.object_code.state import ArrayArgument, CallContext
from symrot.certificates.object_code.terms import RELATION, Terms, number_from_bits
from tests.needs import needs_avx2, needs_objdump

SPECIAL = (0.0, -0.0, 1.0, -1.0, 2.0, 0.5, math.inf, -math.inf, 5e-324, -5e-324, 2.2250738585072014e-308, 1.7e308, -1.7e308,
           1e-160, 3.0, -0.1, 1 + 2.0**-52)  # fmt: skip


def divided(a, b):
    if b == 0:
        return math.nan if a == 0 or a != a else math.copysign(math.inf, a) * math.copysign(1, b)
    return a / b


OPERATIONS = {
    "add": (Terms.add, lambda a, b: a + b), "sub": (Terms.sub, lambda a, b: a - b), "mul": (Terms.mul, lambda a, b: a * b),
    "div": (Terms.div, divided), "copysign": (Terms.copysign, math.copysign),
}  # fmt: skip


def grown(rng, terms, values, depth):
    """Return a random expression: its term, and its value in Python's arithmetic for each assignment of values."""
    if depth == 0 or rng.random() < 0.2:
        if rng.random() < 0.4:
            constant = rng.choice((0.0, -0.0, 1.0, -1.0, 2.0, 4.0, 0.5, 0.25, -2.0, 3.0, 2.0**-1074, 2.0**1023))
            return terms.bits(64, struct.unpack("<Q", struct.pack("<d", constant))[0]), [constant] * len(values)
        name = rng.choice("ab")
        return terms.input(64, name), [value[name] for value in values]
    if rng.random() < 0.2:
        inner, numbers = grown(rng, terms, values, depth - 1)
        return terms.neg(inner), [-number for number in numbers]
    make, calculate = OPERATIONS[rng.choice(list(OPERATIONS))]
    (first, one), (second, other) = (grown(rng, terms, values, depth - 1) for _ in range(2))
    return make(terms, first, second), [calculate(a, b) for a, b in zip(one, other, strict=True)]


def bits_of(value):
    return "nan" if value != value else struct.pack("<d", value)


def test_terms_that_are_one_have_the_same_bits_on_every_input():
    """Random expressions over signed zeros, subnormals and infinities: if two become one term, all their values agree."""
    rng, values = random.Random(7), [{"a": a, "b": b} for a in SPECIAL for b in SPECIAL]
    terms, seen, met = Terms(), {}, 0
    for _ in range(6000):
        term, numbers = grown(rng, terms, values, rng.randrange(1, 4))
        bits = [bits_of(number) for number in numbers]
        if term in seen:
            met += 1
            assert seen[term] == bits, terms.nodes[term]
        seen[term] = bits
    assert met > 1000  # many expressions met under one term: the laws were at work


def test_comparisons_turn_but_never_change_their_outcome():
    terms = Terms()
    a, b = terms.input(64, "a"), terms.input(64, "b")
    less, more = RELATION["<"], RELATION[">"]
    assert terms.mask(64, less, a, b) == terms.mask(64, more, b, a) == terms.mask(64, less, terms.neg(b), terms.neg(a))
    assert terms.mask(64, RELATION["<="], a, b) != terms.mask(64, less, a, b)
    zero, minus = terms.number(64, Fraction(0)), terms.bits(64, 1 << 63)
    assert terms.mask(64, less, a, zero) == terms.mask(64, less, a, minus)
    nan = terms.bits(64, 0x7FF8 << 48)
    assert terms.constant(terms.mask(64, RELATION["!="], nan, nan)) == 2**64 - 1


def test_what_moves_a_rounding_or_a_sign_of_zero_is_no_law():
    terms = Terms()
    a, b, c = (terms.input(64, name) for name in "abc")
    assert terms.neg(terms.add(a, b)) != terms.add(terms.neg(a), terms.neg(b))
    assert terms.add(terms.add(a, b), c) != terms.add(a, terms.add(b, c))
    assert terms.add(a, terms.number(64, Fraction(0))) != a
    assert terms.sub(a, a) != terms.number(64, Fraction(0))
    third = terms.number(64, Fraction(1 / 3))
    assert terms.div(a, terms.number(64, Fraction(3))) != terms.mul(a, third)
    quarter, half = (terms.number(64, Fraction(1, n)) for n in (4, 2))
    assert terms.mul(half, terms.mul(half, a)) != terms.mul(quarter, a)  # it rounds twice below 2^-1022
    assert terms.fma(a, b, c) != terms.add(terms.mul(a, b), c)


SINGLE = (
    "vunpcklps ymm0,ymm0,ymm1", "vunpckhps ymm0,ymm0,ymm1", "vunpcklpd ymm0,ymm0,ymm1", "vunpckhpd ymm0,ymm0,ymm1",
    "unpcklps xmm0,xmm1", "unpckhps xmm0,xmm1", "unpcklpd xmm0,xmm1", "unpckhpd xmm0,xmm1", "punpckldq xmm0,xmm1",
    "punpcklqdq xmm0,xmm1", "punpckhqdq xmm0,xmm1", "punpckhdq xmm0,xmm1", "movlhps xmm0,xmm1", "movhlps xmm0,xmm1",
    "vmovlhps xmm0,xmm0,xmm1", "vmovhlps xmm0,xmm0,xmm1", "movss xmm0,xmm1", "vmovss xmm0,xmm1,xmm0",
    "vmovss xmm0,DWORD PTR [rdi+12]", "movss xmm0,DWORD PTR [rdi+12]", "movsd xmm0,xmm1", "movsd xmm0,QWORD PTR [rdi+8]",
    "vmovsd xmm0,xmm1,xmm0", "movlps xmm0,QWORD PTR [rdi+36]", "movhps xmm0,QWORD PTR [rdi+36]",
    "vmovhps xmm0,xmm1,QWORD PTR [rdi+36]", "vmovlps xmm0,xmm1,QWORD PTR [rdi+36]", "movshdup xmm0,xmm1",
    "vmovsldup ymm0,ymm1", "movddup xmm0,xmm1", "vmovddup ymm0,ymm1", "vmovddup xmm0,QWORD PTR [rdi+4]",
    *(f"shufps xmm0,xmm1,{imm}" for imm in (0x1B, 0xE4, 0x4E)), *(f"vshufpd ymm0,ymm0,ymm1,{imm}" for imm in (2, 5, 9)),
    *(f"vshufps ymm0,ymm0,ymm1,{imm}" for imm in (0x1B, 0xC9)), "shufpd xmm0,xmm1,1", "pshufd xmm0,xmm1,0x2d",
    "vpermilps ymm0,ymm1,0xd7", "vpermilpd ymm0,ymm1,6", "vpermpd ymm0,ymm1,0x9c", "vpermq ymm0,ymm1,0x1b",
    *(f"vperm2f128 ymm0,ymm0,ymm1,{imm}" for imm in (0x20, 0x31, 0x13, 0x08, 0x81)),
    *(f"vblendps ymm0,ymm0,ymm1,{imm}" for imm in (0x5A, 0x81)), "vblendpd ymm0,ymm0,ymm1,5", "blendps xmm0,xmm1,6",
    "pblendw xmm0,xmm1,0xcc", "vinsertf128 ymm0,ymm0,xmm1,1", "vinsertf128 ymm0,ymm1,xmm0,0", "vextractf128 xmm0,ymm1,1",
    *(f"vinsertps xmm0,xmm0,xmm1,{imm}" for imm in (0x10, 0x9C, 0x61)), "insertps xmm0,DWORD PTR [rdi+40],0x25",
    "vbroadcastss ymm0,xmm1", "vbroadcastss xmm0,DWORD PTR [rdi+8]", "vbroadcastsd ymm0,xmm1",
    "vbroadcastf128 ymm0,XMMWORD PTR [rdi+20]", "palignr xmm0,xmm1,8", "vpalignr ymm0,ymm0,ymm1,4", "psrldq xmm0,4",
    "pslldq xmm0,8", "vpsrldq ymm0,ymm1,12", "vhsubps ymm0,ymm0,ymm1", "vhaddps xmm0,xmm0,xmm1", "vaddsubps ymm0,ymm0,ymm1",
    "addps xmm0,xmm1", "vsubps ymm0,ymm0,ymm1", "mulss xmm0,xmm1", "vdivss xmm0,xmm1,xmm0", "vmulps ymm0,ymm0,ymm1",
    "minps xmm0,xmm1", "maxss xmm0,xmm1", "sqrtss xmm0,xmm1", "vsqrtps ymm0,ymm1", "vsqrtss xmm0,xmm1,xmm0",
    *(f"vf{n}m{s}{order}{form}" for n in ("", "n") for s in ("add", "sub") for order in ("132", "213", "231")
      for form in ("ps ymm0,ymm1,ymm2", "ss xmm0,xmm1,xmm2")),
    "vfmaddsub231ps ymm0,ymm1,ymm2", "vfmsubadd132ps ymm0,ymm1,ymm2", "cmpltps xmm0,xmm1", "vcmpnleps ymm0,ymm0,ymm1",
    "vcmpeqss xmm0,xmm0,xmm1", "vcmpge_oqps ymm0,ymm0,ymm1", "cmpunordps xmm0,xmm1",
    "pextrd eax,xmm1,2; movd xmm0,eax", "movq rax,xmm1; movq xmm0,rax", "movd eax,xmm1; vpinsrd xmm0,xmm0,eax,1",
    "extractps eax,xmm1,3; movd xmm0,eax", "vcmpltps ymm2,ymm0,ymm1; vblendvps ymm0,ymm0,ymm1,ymm2",
    "vmovups XMMWORD PTR [rsp-32],xmm1; vmovlps xmm0,xmm0,QWORD PTR [rsp-24]", "vzeroupper", "movaps xmm0,xmm1",
    "vmovaps xmm0,xmm1", "vaddps xmm0,xmm0,xmm1", "addps xmm0,xmm0", "vxorps xmm0,xmm0,xmm0",
)  # fmt: skip
DOUBLE = tuple(
    item.replace("ps ", "pd ").replace("ss ", "sd ")
    for item in SINGLE
    if item.startswith(
        ("vf", "min", "max", "sqrt", "vsqrt", "add", "mul", "vsub", "vdiv", "vmul", "vh", "vadd", "cmp", "vcmp")
    )
    and ";" not in item
)
NUMBERS = (
    1.0,
    -2.0,
    3.0,
    0.5,
    -5.0,
    6.0,
    7.0,
    -8.0,
    3.0,
    4.0,
    -1.0,
    0.5,
    2.0,
    -6.0,
    5.0,
    9.0,
    1.5,
    -2.5,
    4.0,
    8.0,
    -3.0,
    2.0,
    6.0,
    1.0,
)


def calculated(terms, root, width):
    """Return the number that a term stands for, by plain arithmetic; the inputs are so small that only roots round."""
    known = {}
    exact = {
        "add": lambda a, b: a + b, "mul": lambda a, b: a * b, "neg": lambda a: -a, "fma": lambda a, b, c: a * b + c,
        "fnma": lambda a, b, c: c - a * b, "sqrt": lambda a: math.sqrt(a) if a >= 0 else math.nan, "div": lambda a, b: a / b,
        "choose": lambda m, x, y: x if m else y,
    }  # fmt: skip
    for index in terms.order([root]):
        kind, _, *rest = terms.nodes[index]
        if kind == "in":
            known[index] = NUMBERS[int(rest[0].split("[")[1][:-1])]
        elif kind == "bits":
            known[index] = number_from_bits(rest[0], width)
        elif kind == "mask":
            a, b = (known[operand] for operand in rest[1:])
            known[index] = ("<" if a < b else "=" if a == b else ">") in rest[0]
        else:
            known[index] = exact[kind](*(known[operand] for operand in rest))
    return known[root]


def as_bits(value, width):
    number, whole = ("<d", "<Q") if width == 64 else ("<f", "<I")
    if isinstance(value, bool):
        return (1 << width) - 1 if value else 0
    return "nan" if value != value else struct.unpack(whole, struct.pack(number, value))[0]


@needs_objdump
@needs_avx2
@pytest.mark.parametrize("width", [32, 64])
def test_every_instruction_does_what_the_processor_does(tmp_path, width):
    """Each instruction in the tables is run on terms and by the processor, with the same registers."""
    chosen, size = (SINGLE, 4) if width == 32 else (DOUBLE, 8)
    lines = [".intel_syntax noprefix", ".text"]
    for number, instruction in enumerate(chosen):
        lines += [f".globl run{number}", f".type run{number},@function", f"run{number}:"]
        lines += [f"vmovups ymm{place},YMMWORD PTR [rdi+{32 * place}]" for place in range(3)]
        lines += [*instruction.split(";"), "vmovups YMMWORD PTR [rsi],ymm0", "ret"]
    assembly, target, library = (tmp_path / f"run.{suffix}" for suffix in ("s", "o", "so"))
    assembly.write_text("\n".join([*lines, '.section .note.GNU-stack,"",@progbits', ""]))
    subprocess.run(["gcc", "-c", assembly, "-o", target], check=True)
    subprocess.run(["gcc", "-shared", target, "-o", library], check=True)
    loaded, listing, count = ctypes.CDLL(str(library)), read_listing(target), 96 // size
    real = ctypes.c_double if width == 64 else ctypes.c_float
    for number, instruction in enumerate(chosen):
        arguments, got = (real * count)(*NUMBERS[:count]), (ctypes.c_uint64 if width == 64 else ctypes.c_uint32)
        out = (got * (32 // size))()
        getattr(loaded, f"run{number}")(arguments, out)
        terms = Terms()
        arrays = {"x": ArrayArgument("x", 96, False), "y": ArrayArgument("y", 32, True)}
        context = CallContext(terms, listing, width, arrays, 8)
        (way,) = machine.execution_paths(
            machine.state_at_call(context, ("x", "y"), (), listing.function(f"run{number}"))
        )
        for place in range(32 // size):
            words = [way.memory["y", size * place + 4 * part] for part in range(size // 4)]
            term = words[0] if width == 32 else terms.join(*words)
            native = number_from_bits(out[place], width)
            expected = out[place] if native == native or out[place] + 1 == 1 << width else "nan"
            assert as_bits(calculated(terms, term, width), width) == expected, (instruction, place)
