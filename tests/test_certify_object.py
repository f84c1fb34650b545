"""Object code = C text: what compilers make of kernels is accepted, what computes something else is refused."""

import ctypes
import math
import random
import shutil
import struct
import subprocess
from fractions import Fraction
from pathlib import Path

import pytest

from symrot.certify import object_code_build
from symrot.certify import object_code_machine as machine
from symrot.certify.disassembly import listing, missing
from symrot.certify.flags import BITS, BOUNDS, NOTHING, flags_section, judge
from symrot.certify.object_campaign import corrupted
from symrot.certify.object_code import CONTRACTED, DIFFERS, IDENTICAL, NOT_UNDERSTOOD, compare_object
from symrot.certify.object_code_build import FLAGS, STRICT, compile_object, objects_section
from symrot.certify.object_code_mutants import same_bits
from symrot.certify.object_code_state import Array, Context
from symrot.certify.object_code_terms import RELATION, Terms, value_of
from symrot.cli import main
from symrot.errors import CertificateError, CompilerError, InputError
from symrot.report import compiled
from symrot.report.certificates import refuted

KERNELS = Path(__file__).parents[1] / "generated" / "c"
SOME = ("euler_zyx_body_rates", "quaternion_of_dcm", "rotation_vector_of_quaternion", "mrp_shadow", "inertia_rotated")
HERE = [name for name in ("gcc", "clang") if shutil.which(name)]
PROCESSOR = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
needs_objdump = pytest.mark.skipif(bool(missing()) or "gcc" not in HERE, reason="needs gcc and objdump")
needs_avx2 = pytest.mark.skipif(
    not {"avx2", "fma"} <= set(PROCESSOR.split()), reason="needs a processor with AVX2, FMA"
)


def verdicts(directory, text, compiler="gcc", flags=("-O2", *STRICT), against=None):
    """Compile a text and compare it with itself, or with another."""
    source, target = directory / "kernel.c", directory / "kernel.o"
    source.write_text(text)
    compile_object(compiler, (*flags, "-I", str(KERNELS)), source, target)
    return compare_object(against or text, target)


# --- the laws of terms ------------------------------------------------------------------------------------------------

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
    """A random expression: its term, and its value by Python's own arithmetic for each assignment of values."""
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
    """Random expressions over signed zeros, subnormals, infinities: where two become one term, all their values agree."""
    rng, values = random.Random(7), [{"a": a, "b": b} for a in SPECIAL for b in SPECIAL]
    terms, seen, met = Terms(), {}, 0
    for _ in range(6000):
        term, numbers = grown(rng, terms, values, rng.randrange(1, 4))
        found = [bits_of(number) for number in numbers]
        if term in seen:
            met += 1
            assert seen[term] == found, terms.nodes[term]
        seen[term] = found
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


# --- instructions, against the processor ------------------------------------------------------------------------------

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
    """The number that a term is, by plain arithmetic: the inputs are small, so that nothing rounds but roots."""
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
            known[index] = value_of(rest[0], width)
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
    """Each instruction of the tables, run on terms and by the processor, on the same registers."""
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
    loaded, shown, count = ctypes.CDLL(str(library)), listing(target), 96 // size
    real = ctypes.c_double if width == 64 else ctypes.c_float
    for number, instruction in enumerate(chosen):
        given, got = (real * count)(*NUMBERS[:count]), (ctypes.c_uint64 if width == 64 else ctypes.c_uint32)
        out = (got * (32 // size))()
        getattr(loaded, f"run{number}")(given, out)
        terms = Terms()
        arrays = {"x": Array("x", 96, False), "y": Array("y", 32, True)}
        context = Context(terms, shown, width, arrays, 8)
        (way,) = machine.ways(machine.arguments(context, ("x", "y"), (), shown.function(f"run{number}")))
        for place in range(32 // size):
            words = [way.memory["y", size * place + 4 * part] for part in range(size // 4)]
            term = words[0] if width == 32 else terms.join(*words)
            native = value_of(out[place], width)
            expected = out[place] if native == native or out[place] + 1 == 1 << width else "nan"
            assert as_bits(calculated(terms, term, width), width) == expected, (instruction, place)


# --- what compilers make of kernels -----------------------------------------------------------------------------------


@needs_objdump
@pytest.mark.parametrize("compiler", HERE)
@pytest.mark.parametrize("name", SOME)
def test_compiled_kernels_are_accepted(name, compiler):
    """Strict flags give identical operations for SSE2; with AVX2 and FMA the contracted ones are named as such."""
    found = objects_section(KERNELS / f"{name}.c", compilers=[compiler])
    assert len(found["objects"]) == len(FLAGS)
    for item in found["objects"]:
        assert len(item["functions"]) == 2
        if "-mfma" not in item["flags"]:
            assert {function["verdict"] for function in item["functions"]} == {IDENTICAL}, item
        for function in item["functions"]:
            fused = function["verdict"] == DIFFERS and "rounded in one place and fused in another" in function["reason"]
            assert function["verdict"] in (IDENTICAL, CONTRACTED) or fused, function


@needs_objdump
@needs_avx2
@pytest.mark.parametrize("compiler", HERE)
def test_what_is_not_identical_gives_other_bits(compiler, tmp_path):
    """gcc 12 fuses a*b + c at -O3 though -ffp-contract=off is given (vfmsubadd): found here, and seen in the bits."""
    source, good, other = KERNELS / "inertia_rotated.c", tmp_path / "good.o", tmp_path / "other.o"
    compile_object(compiler, ("-O1", *STRICT), source, good)
    compile_object(compiler, ("-O3", "-mavx2", "-mfma", *STRICT), source, other)
    text = source.read_text()
    assert all(item.verdict == IDENTICAL for item in compare_object(text, good))
    is_identical = all(item.verdict == IDENTICAL for item in compare_object(text, other))
    assert same_bits(source, good, other) == is_identical


@needs_objdump
@pytest.mark.parametrize(
    "flags",
    [("-O0",), ("-O2", "-fstack-protector-all", "-fcf-protection"), ("-O2", "-fPIC", "-fno-plt"), ("-O2", "-g")],
)
@pytest.mark.parametrize("compiler", HERE)
def test_other_harmless_ways_of_compiling_are_accepted_too(compiler, flags):
    found = objects_section(
        KERNELS / "rotation_vector_of_quaternion.c", (), [compiler], [(*flags, "-ffp-contract=off")]
    )
    assert found["accepted"], found["objects"]


@needs_objdump
@pytest.mark.parametrize("compiler", HERE)
@pytest.mark.parametrize("flags", ["-O2 -ffast-math", "-O3 -Ofast", "-O2 -funsafe-math-optimizations"])
def test_fast_math_is_refused_with_the_output_that_differs(compiler, flags):
    try:
        found = objects_section(KERNELS / "quaternion_of_dcm.c", (), [compiler], [flags.split()])
    except CompilerError as reason:  # a text that refuses the flag itself
        assert "-ffast-math" in str(reason)
        return
    (item,) = found["objects"]
    assert not item["accepted"] and item["flags_hold"] == NOTHING
    for function in item["functions"]:
        assert function["verdict"] == DIFFERS
        assert function["output"].startswith("q[") and "the C text has" in function["reason"]


@needs_objdump
def test_fast_math_that_did_nothing_is_refused_by_its_flags_alone():
    found = objects_section(
        KERNELS / "euler_zyx_dcm.c", (), ["gcc"], [("-O2", "-freciprocal-math", "-ffp-contract=off")]
    )
    (item,) = found["objects"]
    assert {function["verdict"] for function in item["functions"]} == {IDENTICAL}
    assert not item["accepted"] and item["flags_hold"] == NOTHING


@needs_objdump
def test_the_section_is_the_same_each_time_and_lists_compilers_that_are_missing():
    source = KERNELS / "euler_xyz_dcm.c"
    first, second = (objects_section(source, (), ["gcc", "no_such_compiler"], FLAGS[:2]) for _ in range(2))
    assert first == second
    assert first["missing"] == ["no_such_compiler"] and first["accepted"]


@needs_objdump
def test_a_changed_sign_in_the_text_is_seen_in_the_object(tmp_path):
    text = (KERNELS / "euler_zyx_dcm.c").read_text()
    edited = text.replace(" + ", " - ", 1)
    assert edited != text
    found = verdicts(tmp_path, edited, against=text)
    assert found[0].verdict == DIFFERS and found[0].output and not found[0].accepted
    assert found[1].verdict == IDENTICAL  # the float form was left alone
    assert "euler_zyx_dcm: differs, output dcm[" in found[0].sentence()


@needs_objdump
@pytest.mark.parametrize("compiler", HERE)
def test_corrupted_object_files_are_refused(compiler):
    """A slice of `python -m symrot.certify.object_campaign`: what gives the same bits on many inputs is no corruption."""
    sources = [KERNELS / f"{name}.c" for name in ("euler_zyx_body_rates", "mrp_shadow")]
    counts, said = corrupted(sources, compiler, ("-O2", *STRICT), 20, 11)
    assert counts.total() == 20 and all(name.endswith(": refused") for name in counts), said
    assert len({name.partition(":")[0] for name in counts}) >= 4  # of different kinds


# --- what is refused --------------------------------------------------------------------------------------------------

TEXT = "void f(const double x[2], double y[1])\n{\n    y[0] = x[0]*x[1] + x[0];\n}\n"
GOOD = "movsd xmm0,QWORD PTR [rdi]; movapd xmm1,xmm0; mulsd xmm1,QWORD PTR [rdi+8]; addsd xmm1,xmm0; movsd QWORD PTR [rsi],xmm1"
UPPER = ("vmovsd xmm17,QWORD PTR [rdi]{}; vmulsd xmm18,xmm17,QWORD PTR [rdi+8]; vmovdqa64 ymm19,ymm17; "
         "vaddsd xmm18,xmm18,xmm17; vmovsd QWORD PTR [rsi],xmm18; ret")  # fmt: skip
STRANGE = (
    (f"{GOOD}; ret", IDENTICAL, ""),
    (f"{GOOD}; xor ebx,ebx; ret", NOT_UNDERSTOOD, "rbx is not as it was"),
    (f"sub rsp,8; {GOOD}; ret", NOT_UNDERSTOOD, "'ret"),
    (f"{GOOD}; movsd QWORD PTR [rdi],xmm1; ret", NOT_UNDERSTOOD, "a write outside the outputs, to x"),
    (f"{GOOD}; movsd QWORD PTR [rsi+8],xmm1; ret", NOT_UNDERSTOOD, "a write outside the outputs, to y"),
    (f"{GOOD}; movsd QWORD PTR [rsp+8],xmm1; ret", NOT_UNDERSTOOD, "a write to stack"),
    (f"movsd xmm2,QWORD PTR [rdi+16]; {GOOD}; ret", NOT_UNDERSTOOD, "a read outside the array x"),
    (f"movsd xmm2,QWORD PTR [rsi]; {GOOD}; ret", NOT_UNDERSTOOD, "which is not written yet"),
    (f"movapd xmm3,XMMWORD PTR [rdi]; {GOOD}; ret", NOT_UNDERSTOOD, "an aligned access to x"),
    (f"movsd xmm2,QWORD PTR fs:[rdi]; {GOOD}; ret", NOT_UNDERSTOOD, "segment fs"),
    (f"movsd xmm2,QWORD PTR fs:[rip+f]; {GOOD}; ret", NOT_UNDERSTOOD, "segment fs"),
    ("ret", NOT_UNDERSTOOD, "y[0] is not written"),
    (f"{GOOD}", NOT_UNDERSTOOD, "no instruction"),
    (f"cvtsd2si eax,xmm0; {GOOD}; ret", NOT_UNDERSTOOD, "an instruction that is not known"),
    (f"ldmxcsr DWORD PTR [rdi]; {GOOD}; ret", NOT_UNDERSTOOD, "an instruction that is not known"),
    (f"call tgamma; {GOOD}; ret", NOT_UNDERSTOOD, "16 bytes"),
    (f"sub rsp,8; call tgamma; {GOOD}; add rsp,8; ret", NOT_UNDERSTOOD, "a call of tgamma"),
    (f"jmp rax; {GOOD}; ret", NOT_UNDERSTOOD, "a jump to an address that is computed"),
    ("1: jmp 1b; ret", NOT_UNDERSTOOD, "more than"),
    (GOOD.replace("addsd xmm1,xmm0", "addsd xmm1,xmm3") + "; ret", DIFFERS, "a value that nobody set"),
    (GOOD.replace("mulsd", "divsd") + "; ret", DIFFERS, "div(x[0], x[1])"),
    (GOOD.replace("addsd xmm1,xmm0", "subsd xmm1,xmm0") + "; ret", DIFFERS, "the object code"),
    (UPPER.format(""), IDENTICAL, ""),  # registers that AVX-512 has
    (UPPER.format("; vzeroupper"), IDENTICAL, ""),
    (UPPER.replace("xmm18,xmm18,", "xmm18{{k1}},xmm18,").format(""), NOT_UNDERSTOOD, "an instruction that is not known"),
    (UPPER.replace("xmm18,xmm18,xmm17", "xmm18,xmm18,xmm17,{{ru-sae}}").format(""), NOT_UNDERSTOOD, "not known"),
    (UPPER.replace("vaddsd", "vsubsd").format(""), DIFFERS, "the object code"),
    ("movsd xmm0,QWORD PTR [rdi]; movsd xmm1,QWORD PTR [rdi+8]; vfmadd213sd xmm1,xmm0,xmm0; movsd QWORD PTR [rsi],xmm1; ret",
     CONTRACTED, ""),
)  # fmt: skip


@needs_objdump
@pytest.mark.parametrize(("code", "verdict", "said"), STRANGE, ids=range(len(STRANGE)))
def test_machine_code_by_hand(tmp_path, code, verdict, said):
    assembly, target = tmp_path / "f.s", tmp_path / "f.o"
    rows = [
        ".intel_syntax noprefix",
        ".text",
        ".globl f",
        "f:",
        *code.split(";"),
        '.section .note.GNU-stack,"",@progbits',
    ]
    assembly.write_text("\n".join([*rows, ""]))
    subprocess.run(["gcc", "-c", assembly, "-o", target], check=True)
    (found,) = compare_object(TEXT, target)
    assert (found.verdict, said in found.reason) == (verdict, True), found


@needs_objdump
def test_a_product_that_is_rounded_here_and_fused_there_is_refused(tmp_path):
    """y = (x0*x1 + x2) - x0*x1: with one of the two products fused, the error of the other no longer cancels."""
    text = "void f(const double x[3], double y[1])\n{\n    const double p = x[0]*x[1];\n    y[0] = (p + x[2]) - p;\n}\n"
    rows = ["movsd xmm0,QWORD PTR [rdi]", "movsd xmm1,QWORD PTR [rdi+8]", "movsd xmm2,QWORD PTR [rdi+16]",
            "vmulsd xmm3,xmm0,xmm1", "vfmadd231sd xmm2,xmm0,xmm1", "vsubsd xmm2,xmm2,xmm3",
            "movsd QWORD PTR [rsi],xmm2", "ret"]  # fmt: skip
    (tmp_path / "f.s").write_text("\n".join([".intel_syntax noprefix", ".globl f", "f:", *rows, ""]))
    subprocess.run(["gcc", "-c", tmp_path / "f.s", "-o", tmp_path / "f.o"], check=True)
    (found,) = compare_object(text, tmp_path / "f.o")
    assert found.verdict == DIFFERS and "rounded in one place and fused in another" in found.reason


@needs_objdump
def test_files_that_are_no_object_files_are_refused_in_one_sentence(tmp_path):
    source, target = tmp_path / "kernel.c", tmp_path / "kernel.o"
    source.write_text(TEXT)
    with pytest.raises(CertificateError, match="got none"):
        compare_object(TEXT, target)
    with pytest.raises(CertificateError, match="got a folder"):
        compare_object(TEXT, tmp_path)
    target.write_bytes(b"")
    with pytest.raises(CertificateError, match="got an empty one"):
        compare_object(TEXT, target)
    target.write_text("no object")
    with pytest.raises(CertificateError, match="objdump cannot read it"):
        compare_object(TEXT, target)
    compile_object("gcc", ("-O2",), source, target)
    with pytest.raises(CertificateError, match="expected machine code of g, got that of f"):
        compare_object(TEXT.replace("void f(", "void g("), target)
    with pytest.raises(CertificateError, match="expected a definition of h"):
        compare_object(TEXT, target, ["h"])
    subprocess.run(["gcc", "-shared", "-o", tmp_path / "kernel.so", target], check=True)
    with pytest.raises(CertificateError, match="linked"):
        compare_object(TEXT, tmp_path / "kernel.so")
    with pytest.raises(CompilerError, match="refuses"):
        compile_object("gcc", ("-fno_such_flag",), source, target)
    with pytest.raises(CompilerError, match="not on the path"):
        compile_object("no_such_compiler", (), source, target)


@needs_objdump
@pytest.mark.parametrize("compiler", HERE)
def test_objects_of_link_time_optimisation_are_refused_with_what_to_do(compiler, tmp_path):
    with pytest.raises(CertificateError, match="-flto"):
        verdicts(tmp_path, TEXT, compiler, ("-O2", "-flto"))
    if compiler == "gcc":
        assert verdicts(tmp_path, TEXT, compiler, ("-O2", "-flto", "-ffat-lto-objects"))[0].verdict == IDENTICAL


WRONG = GOOD.replace("addsd xmm1,xmm0", "subsd xmm1,xmm0")


@needs_objdump
def test_code_of_another_part_of_the_file_does_not_stand_for_a_function(tmp_path):
    """A wrong f, and under the same section and address in another part the right code: an archive, a group."""
    for name, code in (("f", WRONG), ("g", GOOD)):
        source = tmp_path / f"{name}.s"
        source.write_text(f".intel_syntax noprefix\n.text\n.globl {name}\n{name}: {code}; ret\n")
        subprocess.run(["gcc", "-c", source, "-o", tmp_path / f"{name}.o"], check=True)
    subprocess.run(["ar", "rcs", tmp_path / "both.a", tmp_path / "f.o", tmp_path / "g.o"], check=True)
    with pytest.raises(CertificateError, match="got an archive"):
        compare_object(TEXT, tmp_path / "both.a")
    parts = [
        f'.section .text.f,"axG",@progbits,{name},comdat\n.globl {name}\n{name}: {code}; ret\n'
        for name, code in (("f", WRONG), ("g", GOOD))
    ]
    (tmp_path / "both.s").write_text(".intel_syntax noprefix\n" + "".join(parts))
    subprocess.run(["gcc", "-c", tmp_path / "both.s", "-o", tmp_path / "both.o"], check=True)
    with pytest.raises(CertificateError, match="two sections of one name"):
        compare_object(TEXT, tmp_path / "both.o")


# --- flags ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("flags", "holds"),
    [
        ("gcc -O2 -ffp-contract=off -fno-math-errno -c kernel.c -o kernel.o", BITS),
        ("-O3 -mavx2 -std=c99 -Wall -g -fPIC -Iinclude -DNDEBUG -ffp-contract=off", BITS),
        ("clang -O3 -march=native -ffp-contract=off", BITS),
        ("gcc -O3 -march=native -ffp-contract=off -fno-tree-slp-vectorize", BITS),
        ("gcc -O3 -march=native -ffp-contract=off", BOUNDS),  # gcc 12 fuses in vectors all the same
        ("-O2", BOUNDS),
        ("-O2 -mavx2 -mfma -ffp-contract=fast", BOUNDS),
        ("-ffp-contract=off -ffp-contract=fast", BOUNDS),
        ("-ffp-contract=fast -ffp-contract=off", BITS),
        ("-Ofast -ffp-contract=off", NOTHING),
        ("-ffast-math", NOTHING),
        ("-ffast-math -fno-fast-math -ffp-contract=off", BITS),
        ("-funsafe-math-optimizations -ffp-contract=off", NOTHING),
        ("-fassociative-math -ffp-contract=off", NOTHING),
        ("-freciprocal-math -ffp-contract=off", NOTHING),
        ("-ffinite-math-only -ffp-contract=off", NOTHING),
        ("-fno-signed-zeros -ffp-contract=off", NOTHING),
        ("-mfpmath=387 -ffp-contract=off", NOTHING),
        ("-m32 -ffp-contract=off", NOTHING),
        ("-fdenormal-fp-math=preserve-sign -ffp-contract=off", NOTHING),
        ("-fsingle-precision-constant -ffp-contract=off", NOTHING),
        ("-ffp-model=precise", BOUNDS),
        ("-frounding-math -fno-trapping-math -ffp-contract=off", BITS),
    ],
)
def test_flags_are_judged_in_their_order(flags, holds):
    found = judge(flags)
    assert found.holds == holds and found.accepted == (holds != NOTHING)
    assert found == judge(flags.split())
    if holds == NOTHING:
        assert found.sentence().startswith("the certificate is void (-")


@pytest.mark.parametrize(
    "flag",
    ["-funny", "-fno-rounding", "-Dsin=cos", "-mllvm", "/fp:fast", '-O2 "', "", "cl /fp:fast", "icx -O2", "zig cc -O2", "tcc",
     "gcc @flags", "gcc -Wp,-Dsin=cos", "gcc -Wa,--defsym", "gcc -DNAN=0", "gcc -DSYMROT_RESTRICT=x", "gcc -include sin.h"],
)  # fmt: skip
def test_a_flag_or_a_compiler_that_nobody_knows_is_refused_in_one_sentence(flag):
    with pytest.raises(InputError, match=r"^flags: expected"):
        judge(flag)


@pytest.mark.parametrize(
    ("flags", "holds"),
    [("/usr/bin/x86_64-linux-gnu-gcc-12 -ffp-contract=off -DMY_APP=1 main.c kernel.c -o main", BITS),
     ("ccache clang++-14 -O2 -ffp-contract=off", BITS), ("C:\\\\gcc.exe -O2", BOUNDS), ("kernel.c -ffp-contract=off", BITS),
     ("i686-linux-gnu-gcc -O2 -ffp-contract=off", NOTHING), ("i686-linux-gnu-gcc -mfpmath=sse -ffp-contract=off", BITS)],
)  # fmt: skip
def test_compilers_are_known_by_their_names(flags, holds):
    """One for a processor with x87 keeps more digits than a type has, unless it is told to use SSE."""
    assert judge(flags).holds == holds


def test_the_section_of_flags_gives_a_reason_for_each():
    section = flags_section()
    assert list(section["required"]) == ["-ffp-contract=off"]
    for name, rows in section.items():
        assert all(rows.values()), name
    for flag in section["void"]:
        assert judge([flag, "-ffp-contract=off"]).holds == NOTHING
    for flag in section["allowed"]:
        assert judge([flag, "-ffp-contract=off"]).holds == BITS


@pytest.mark.parametrize(
    ("flags", "code", "said"),
    [
        ("gcc -O3 -mavx2 -ffp-contract=off", 0, "the bits of the C text and its error bounds hold"),
        ("gcc -O2 -march=native", 0, "the error bounds hold, not the bits"),
        ("gcc -O2 -ffast-math", 1, "the certificate is void"),
        ("gcc -fmagic", 2, "got '-fmagic'"),
    ],
)
def test_the_audit_says_what_holds_under_flags(capsys, flags, code, said):
    assert main(["audit", str(KERNELS / "torque_spring.cert.json"), "--flags", flags]) == code
    found = capsys.readouterr()
    assert said in (found.err if code else found.out)
    assert found.err.count("\n") == (1 if code else 0)


# --- link 5 of certificates -------------------------------------------------------------------------------------------


@needs_objdump
def test_certify_compares_object_code_and_keeps_what_it_found(tmp_path, capsys, monkeypatch):
    """Compiled and compared once; a refusal names the function and what differs, and is an exit code of 1."""
    monkeypatch.setenv("SYMROT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(object_code_build, "FLAGS", FLAGS[1:2])
    monkeypatch.setattr(object_code_build.objects_section, "__defaults__", ((), tuple(HERE), FLAGS[1:2]))
    folder = tmp_path / "k"
    assert main(["certify", "quaternion_product", "--objects", "-o", str(folder)]) == 0
    said = capsys.readouterr().out
    assert said.count("the C text, rounding for rounding: bits and bounds hold") == len(HERE)
    monkeypatch.setattr(compiled, "objects_section", None)  # not called again
    assert main(["certify", "quaternion_product", "--objects"]) == 0
    assert capsys.readouterr().out in said
    assert main(["certify", "quaternion_product", "-o", str(folder)]) == 0
    assert "compared before, which is kept and not looked at" in capsys.readouterr().out
    path = folder / "quaternion_product.cert.json"
    assert main(["audit", str(path)]) == 0
    assert "what it says of object code was not looked at" in capsys.readouterr().out


def test_a_difference_under_flags_that_keep_bits_fails():
    """Under flags that contract, a product that is fused in places is said and is no failure."""
    function = {"name": "f", "verdict": DIFFERS, "output": "y", "reason": "the C text has a + b", "cases": 1}
    objects = [{"compiler": "gcc", "flags": f"for {holds}", "flags_hold": holds, "accepted": False, "functions": [function]}
               for holds in (BITS, BOUNDS)]  # fmt: skip
    strict, contracted = ({"objects": [each], "missing": []} for each in objects)
    assert not compiled.holds(strict) and not compiled.holds(contracted) and not compiled.holds(None)
    same = {**objects[0], "accepted": True, "functions": [function | {"verdict": IDENTICAL}]}
    both = {"objects": [same, objects[1]], "missing": ["clang"]}
    assert compiled.holds(both) and not refuted([{"objects": both}, {}]) and refuted([{"objects": strict}])
    said = compiled.lines(both)
    assert "not the C text (f: differs, output y: the C text has a + b)" in said[1] and "clang is not on" in said[2]
    counts = compiled.table({"one": both, "two": both, "three": None})
    assert counts[:2] == ["  gcc for bits: 2 of 2", "  gcc for bounds: 0 of 2"] and counts[2].startswith("    one: not")


@pytest.mark.parametrize("arguments", [["quaternion_dcm"], ["--all"]])
@pytest.mark.parametrize(("there", "said"), [((), "gcc or clang on the path"), (("gcc",), "objdump")])
def test_without_compiler_or_objdump_nothing_is_written(arguments, there, said, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(compiled, "compiler_version", lambda name: "1" if name in there else "")
    monkeypatch.setattr(shutil, "which", lambda name, *_: None)
    assert main(["certify", *arguments, "--objects", "-o", str(tmp_path / "k")]) == 2
    found = capsys.readouterr()
    assert said in found.err and found.err.count("\n") == 1 and not found.out and not list(tmp_path.iterdir())
