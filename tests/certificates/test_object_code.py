"""Object code equals C text: code that compilers make from kernels is accepted, code that computes something else is
refused.
"""

import shutil
import subprocess
from pathlib import Path

import pytest

from symrot.certificates.flags import BITS, BOUNDS, NOTHING
from symrot.certificates.object_code import build as object_code_build
from symrot.certificates.object_code.build import FLAGS, STRICT, compile_object, objects_section
from symrot.certificates.object_code.comparison import CONTRACTED, DIFFERS, IDENTICAL, NOT_UNDERSTOOD, compare_object
from symrot.cli.main import main
from symrot.errors import CertificateError, CompilerError
from symrot.workshop import object_code as compiled
from symrot.workshop.certify import lacks_proof_of_bits
from tests.campaigns.certificates.object_campaign import corrupted
from tests.campaigns.certificates.object_code_mutants import same_bits
from tests.needs import HERE, needs_avx2, needs_objdump

KERNELS = Path(__file__).parents[2] / "generated" / "c"
SOME = ("quaternion_of_dcm", "rotation_vector_of_quaternion", "inertia_rotated", "euler_zyx_body_rates", "mrp_shadow")


def verdicts(directory, text, compiler="gcc", flags=("-O2", *STRICT), against=None):
    """Compile a text and return the verdicts of comparing it with itself, or with the text ``against``."""
    source, target = directory / "kernel.c", directory / "kernel.o"
    source.write_text(text)
    compile_object(compiler, (*flags, "-I", str(KERNELS)), source, target)
    return compare_object(against or text, target)


# --- what compilers make of kernels -----------------------------------------------------------------------------------


@pytest.mark.thinned(2)
@needs_objdump
@pytest.mark.parametrize("compiler", HERE)
@pytest.mark.parametrize("flags", [FLAGS[1::2], pytest.param(FLAGS[::2], marks=pytest.mark.campaign)], ids=["", "more"])
@pytest.mark.parametrize(
    "name",
    [*SOME[:1], *(pytest.param(name, marks=pytest.mark.campaign) for name in SOME[1:])],  # branches, series, fused
)
def test_compiled_kernels_are_accepted(name, flags, compiler):
    """Strict flags give identical operations for SSE2; with AVX2 and FMA, contracted functions are reported as such."""
    section = objects_section(KERNELS / f"{name}.c", (), [compiler], flags)
    assert len(section["objects"]) == len(flags)
    for item in section["objects"]:
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
    """At -O3 gcc 12 fuses a*b + c (vfmsubadd) despite -ffp-contract=off; the verdict says so, and the bits differ."""
    source, good, other = KERNELS / "inertia_rotated.c", tmp_path / "good.o", tmp_path / "other.o"
    compile_object(compiler, ("-O1", *STRICT), source, good)
    compile_object(compiler, ("-O3", "-mavx2", "-mfma", *STRICT), source, other)
    text = source.read_text()
    assert all(item.verdict == IDENTICAL for item in compare_object(text, good))
    is_identical = all(item.verdict == IDENTICAL for item in compare_object(text, other))
    assert same_bits(source, good, other) == is_identical


@pytest.mark.thinned(3)
@needs_objdump
@pytest.mark.parametrize(
    "flags",
    [("-O0",), ("-O2", "-fstack-protector-all", "-fcf-protection"), ("-O2", "-fPIC", "-fno-plt"), ("-O2", "-g")],
)
@pytest.mark.parametrize("compiler", HERE)
def test_other_harmless_ways_of_compiling_are_accepted_too(compiler, flags):
    section = objects_section(
        KERNELS / "rotation_vector_of_quaternion.c", (), [compiler], [(*flags, "-ffp-contract=off")]
    )
    assert section["accepted"], section["objects"]


@needs_objdump
@pytest.mark.parametrize("compiler", HERE)
@pytest.mark.parametrize("flags", ["-O2 -ffast-math", "-O3 -Ofast", "-O2 -funsafe-math-optimizations"])
def test_fast_math_is_refused_with_the_output_that_differs(compiler, flags):
    try:
        section = objects_section(KERNELS / "quaternion_of_dcm.c", (), [compiler], [flags.split()])
    except CompilerError as reason:  # a text that refuses the flag itself
        assert "-ffast-math" in str(reason)
        return
    (item,) = section["objects"]
    assert not item["accepted"] and item["flags_hold"] == NOTHING
    for function in item["functions"]:
        assert function["verdict"] == DIFFERS
        assert function["output"].startswith("q[") and "the C text has" in function["reason"]


@needs_objdump
def test_fast_math_that_did_nothing_is_refused_by_its_flags_alone():
    section = objects_section(
        KERNELS / "euler_zyx_dcm.c", (), ["gcc"], [("-O2", "-freciprocal-math", "-ffp-contract=off")]
    )
    (item,) = section["objects"]
    assert {function["verdict"] for function in item["functions"]} == {IDENTICAL}
    assert not item["accepted"] and item["flags_hold"] == NOTHING


@needs_objdump
def test_the_section_is_the_same_each_time_and_lists_compilers_that_are_missing():
    source = KERNELS / "euler_xyz_dcm.c"
    first, second = (objects_section(source, (), ["gcc", "no_such_compiler"], FLAGS[:1]) for _ in range(2))
    assert first == second
    assert first["missing"] == ["no_such_compiler"] and first["accepted"]


@needs_objdump
def test_a_changed_sign_in_the_text_is_seen_in_the_object(tmp_path):
    text = (KERNELS / "euler_zyx_dcm.c").read_text()
    edited = text.replace(" + ", " - ", 1)
    assert edited != text
    differing = verdicts(tmp_path, edited, against=text)
    assert differing[0].verdict == DIFFERS and differing[0].output and not differing[0].accepted
    assert differing[1].verdict == IDENTICAL  # the float form was left alone
    assert "euler_zyx_dcm: differs, output dcm[" in differing[0].sentence()


@pytest.mark.thinned(3)  # one compiler with both kernels, the other with one
@needs_objdump
@pytest.mark.parametrize("compiler", HERE)
@pytest.mark.parametrize("names", [["euler_zyx_body_rates", "mrp_shadow"], ["mrp_shadow"]], ids="+".join)
def test_corrupted_object_files_are_refused(names, compiler):
    """This is a part of `python -m tests.campaigns.certificates.object_campaign`; a change that gives equal bits is no
    corruption.
    """
    sources = [KERNELS / f"{name}.c" for name in names]
    counts, report = corrupted(sources, compiler, ("-O2", *STRICT), 5 * len(names), 11)
    assert counts.total() == 5 * len(names) and all(name.endswith(": refused") for name in counts), report
    assert len({name.partition(":")[0] for name in counts}) >= 4  # of different kinds


# --- what is refused --------------------------------------------------------------------------------------------------

TEXT = "void f(const double x[2], double y[1])\n{\n    y[0] = x[0]*x[1] + x[0];\n}\n"
GOOD = "movsd xmm0,QWORD PTR [rdi]; movapd xmm1,xmm0; mulsd xmm1,QWORD PTR [rdi+8]; addsd xmm1,xmm0; movsd QWORD PTR [rsi],xmm1"
UPPER = ("vmovsd xmm17,QWORD PTR [rdi]{}; vmulsd xmm18,xmm17,QWORD PTR [rdi+8]; vmovdqa64 ymm19,ymm17; "
         "vaddsd xmm18,xmm18,xmm17; vmovsd QWORD PTR [rsi],xmm18; ret")  # fmt: skip
STRANGE = (
    (f"{GOOD}; ret", IDENTICAL, ""),
    (f"{GOOD}; xor ebx,ebx; ret", NOT_UNDERSTOOD, "expected the same value of register rbx"),
    (f"sub rsp,8; {GOOD}; ret", NOT_UNDERSTOOD, "'ret"),
    (f"{GOOD}; movsd QWORD PTR [rdi],xmm1; ret", NOT_UNDERSTOOD, "expected writes inside the output arrays, got a write outside, to x"),
    (f"{GOOD}; movsd QWORD PTR [rsi+8],xmm1; ret", NOT_UNDERSTOOD, "expected writes inside the output arrays, got a write outside, to y"),
    (f"{GOOD}; movsd QWORD PTR [rsp+8],xmm1; ret", NOT_UNDERSTOOD, "got a write to stack"),
    (f"movsd xmm2,QWORD PTR [rdi+16]; {GOOD}; ret", NOT_UNDERSTOOD, "expected a read inside the array x, got the offset 16"),
    (f"movsd xmm2,QWORD PTR [rsi]; {GOOD}; ret", NOT_UNDERSTOOD, "before it is read, got a read first"),
    (f"movapd xmm3,XMMWORD PTR [rdi]; {GOOD}; ret", NOT_UNDERSTOOD, "expected an aligned address, got an address in x"),
    (f"movsd xmm2,QWORD PTR fs:[rdi]; {GOOD}; ret", NOT_UNDERSTOOD, "segment fs"),
    (f"movsd xmm2,QWORD PTR fs:[rip+f]; {GOOD}; ret", NOT_UNDERSTOOD, "segment fs"),
    ("ret", NOT_UNDERSTOOD, "expected every path through the code to write y[0]"),
    (f"{GOOD}", NOT_UNDERSTOOD, "expected an instruction, got none"),
    (f"cvtsd2si eax,xmm0; {GOOD}; ret", NOT_UNDERSTOOD, "expected a machine instruction that symrot can execute"),
    (f"ldmxcsr DWORD PTR [rdi]; {GOOD}; ret", NOT_UNDERSTOOD, "expected a machine instruction that symrot can execute"),
    (f"call tgamma; {GOOD}; ret", NOT_UNDERSTOOD, "16 bytes"),
    (f"sub rsp,8; call tgamma; {GOOD}; add rsp,8; ret", NOT_UNDERSTOOD, "expected a call of a known C library function, got tgamma"),
    (f"jmp rax; {GOOD}; ret", NOT_UNDERSTOOD, "expected a jump to a fixed address, got a computed address"),
    ("1: jmp 1b; ret", NOT_UNDERSTOOD, "executed instructions, got more"),
    (GOOD.replace("addsd xmm1,xmm0", "addsd xmm1,xmm3") + "; ret", DIFFERS, "a value that nobody set"),
    (GOOD.replace("mulsd", "divsd") + "; ret", DIFFERS, "div(x[0], x[1])"),
    (GOOD.replace("addsd xmm1,xmm0", "subsd xmm1,xmm0") + "; ret", DIFFERS, "the object code"),
    (UPPER.format(""), IDENTICAL, ""),  # registers that AVX-512 has
    (UPPER.format("; vzeroupper"), IDENTICAL, ""),
    (UPPER.replace("xmm18,xmm18,", "xmm18{{k1}},xmm18,").format(""), NOT_UNDERSTOOD, "expected a machine instruction that symrot can execute"),
    (UPPER.replace("xmm18,xmm18,xmm17", "xmm18,xmm18,xmm17,{{ru-sae}}").format(""), NOT_UNDERSTOOD, "expected a machine instruction that symrot can execute"),
    (UPPER.replace("vaddsd", "vsubsd").format(""), DIFFERS, "the object code"),
    (GOOD.rpartition(";")[0] + "; pcmpeqd xmm3,xmm3; pxor xmm4,xmm4; psllq xmm3,xmm4; andnpd xmm3,xmm1; "
     "movsd QWORD PTR [rsi],xmm3; ret", NOT_UNDERSTOOD, "got a variable shift"),
    ("movsd xmm0,QWORD PTR [rdi]; movsd xmm1,QWORD PTR [rdi+8]; vfmadd213sd xmm1,xmm0,xmm0; movsd QWORD PTR [rsi],xmm1; ret",
     CONTRACTED, ""),
)  # fmt: skip


@pytest.mark.thinned(3)
@needs_objdump
@pytest.mark.parametrize(("code", "verdict", "reason"), STRANGE, ids=range(len(STRANGE)))
def test_machine_code_by_hand(tmp_path, code, verdict, reason):
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
    (result,) = compare_object(TEXT, target)
    assert (result.verdict, reason in result.reason) == (verdict, True), result


@needs_objdump
def test_a_product_that_is_rounded_here_and_fused_there_is_refused(tmp_path):
    """In y = (x0*x1 + x2) - x0*x1, if one product is fused, the rounding error of the other no longer cancels."""
    text = "void f(const double x[3], double y[1])\n{\n    const double p = x[0]*x[1];\n    y[0] = (p + x[2]) - p;\n}\n"
    rows = ["movsd xmm0,QWORD PTR [rdi]", "movsd xmm1,QWORD PTR [rdi+8]", "movsd xmm2,QWORD PTR [rdi+16]",
            "vmulsd xmm3,xmm0,xmm1", "vfmadd231sd xmm2,xmm0,xmm1", "vsubsd xmm2,xmm2,xmm3",
            "movsd QWORD PTR [rsi],xmm2", "ret"]  # fmt: skip
    (tmp_path / "f.s").write_text("\n".join([".intel_syntax noprefix", ".globl f", "f:", *rows, ""]))
    subprocess.run(["gcc", "-c", tmp_path / "f.s", "-o", tmp_path / "f.o"], check=True)
    (result,) = compare_object(text, tmp_path / "f.o")
    assert result.verdict == DIFFERS and "rounded in one place and fused in another" in result.reason


@needs_objdump
def test_files_that_are_no_object_files_are_refused_in_one_sentence(tmp_path):
    source, target = tmp_path / "kernel.c", tmp_path / "kernel.o"
    source.write_text(TEXT)
    with pytest.raises(CertificateError, match="got no file"):
        compare_object(TEXT, target)
    with pytest.raises(CertificateError, match="got a folder"):
        compare_object(TEXT, tmp_path)
    target.write_bytes(b"")
    with pytest.raises(CertificateError, match="got an empty file"):
        compare_object(TEXT, target)
    target.write_text("no object")
    with pytest.raises(CertificateError, match="objdump cannot read it"):
        compare_object(TEXT, target)
    compile_object("gcc", ("-O2",), source, target)
    with pytest.raises(CertificateError, match="expected machine code of g, got only that of f"):
        compare_object(TEXT.replace("void f(", "void g("), target)
    with pytest.raises(CertificateError, match="expected a function named h"):
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
    """The function f is wrong, but correct code exists at the same section and address in another member or group."""
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


# --- objects in certificates ------------------------------------------------------------------------------------------


@needs_objdump
def test_certify_compares_object_code_and_keeps_what_it_found(tmp_path, capsys, monkeypatch):
    """Code is compiled and compared once; a refusal names function and difference and gives exit code 1."""
    monkeypatch.setenv("SYMROT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(object_code_build, "FLAGS", FLAGS[1:2])
    monkeypatch.setattr(object_code_build.objects_section, "__defaults__", ((), tuple(HERE), FLAGS[1:2]))
    folder = tmp_path / "k"
    assert main(["certify", "quaternion_product", "--objects", "-o", str(folder)]) == 0
    output = capsys.readouterr().out
    assert " ".join(output.split()).count("the C text, each rounded as there: the bits of results are the same") == len(
        HERE
    )
    monkeypatch.setattr(compiled, "objects_section", None)  # not called again
    assert main(["certify", "quaternion_product", "--objects"]) == 0
    assert capsys.readouterr().out in output
    assert main(["certify", "quaternion_product", "-o", str(folder)]) == 0
    assert "compared in an earlier run, not now" in capsys.readouterr().out
    path = folder / "quaternion_product.cert.json"
    assert main(["audit", str(path)]) == 0
    assert "verdicts on object code were not checked" in capsys.readouterr().out


def test_a_difference_under_flags_that_keep_bits_fails():
    """Under flags that allow contraction, a product that is fused in places is reported but is no failure."""
    function = {"name": "f", "verdict": DIFFERS, "output": "y", "reason": "the C text has a + b", "cases": 1}
    objects = [{"compiler": "gcc", "flags": f"for {holds}", "flags_hold": holds, "accepted": False, "functions": [function]}
               for holds in (BITS, BOUNDS)]  # fmt: skip
    strict, contracted = ({"objects": [each], "missing": []} for each in objects)
    assert not compiled.holds(strict) and not compiled.holds(contracted) and not compiled.holds(None)
    same = {**objects[0], "accepted": True, "functions": [function | {"verdict": IDENTICAL}]}
    both = {"objects": [same, objects[1]], "missing": ["clang"]}
    assert compiled.holds(both)
    assert not lacks_proof_of_bits([{"objects": both}, {}]) and lacks_proof_of_bits([{"objects": strict}])
    output_lines = compiled.lines(both)
    assert (
        "does not perform the operations of the C text (f: differs, output y: the C text has a + b)" in output_lines[1]
        and "clang is not on" in output_lines[2]
    )
    counts = compiled.table({"one": both, "two": both, "three": None})
    assert counts[:2] == ["  gcc for bits: 2 of 2", "  gcc for bounds: 0 of 2"] and counts[2].startswith(
        "    one: does not"
    )


@pytest.mark.parametrize("arguments", [["quaternion_dcm"], ["--all"]])
@pytest.mark.parametrize(("there", "sentence"), [((), "gcc or clang on the path"), (("gcc",), "objdump")])
def test_without_compiler_or_objdump_nothing_is_written(arguments, there, sentence, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(compiled, "compiler_version", lambda name: "1" if name in there else "")
    monkeypatch.setattr(shutil, "which", lambda name, *_: None)
    assert main(["certify", *arguments, "--objects", "-o", str(tmp_path / "k")]) == 2
    output = capsys.readouterr()
    assert sentence in output.err and output.err.count("\n") == 1 and not output.out and not list(tmp_path.iterdir())
