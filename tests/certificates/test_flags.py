"""The compiler flags under which a certificate holds."""

from pathlib import Path

import pytest

from symrot.certificates.flags import BITS, BOUNDS, NOTHING, classify_flags, flags_section
from symrot.cli.main import main
from symrot.errors import InputError

KERNELS = Path(__file__).parents[2] / "generated" / "c"


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
        ("-m32 -m64 -ffp-contract=off", BITS),
        ("-m32 -mfpmath=sse -ffp-contract=off", NOTHING),  # gcc: SSE instruction set disabled, using 387 arithmetics
        ("-m32 -msse2 -mfpmath=sse -ffp-contract=off", BITS),
        ("-mfpmath=387 -m64 -ffp-contract=off", NOTHING),  # gcc has FLT_EVAL_METHOD 2
        ("-mno-sse2 -m64 -ffp-contract=off", NOTHING),
        ("-mno-sse2 -mfpmath=sse -ffp-contract=off", NOTHING),
        ("-fdenormal-fp-math=preserve-sign -ffp-contract=off", NOTHING),
        ("-fsingle-precision-constant -ffp-contract=off", NOTHING),
        # clang 14 does not take these flags back: `clang -### -c x.c ..` lists what is on
        ("-fapprox-func -ffp-model=precise -ffp-contract=off", NOTHING),
        ("-ffast-math -ffp-model=strict -ffp-contract=off", NOTHING),
        ("-funsafe-math-optimizations -ffp-model=strict -ffp-contract=off", NOTHING),
        ("-funsafe-math-optimizations -fno-unsafe-math-optimizations -ffp-contract=off", BITS),
        ("-mrecip -fno-reciprocal-math -ffp-contract=off", NOTHING),
        ("-mrecip -fno-fast-math -ffp-contract=off", NOTHING),
        ("-freciprocal-math -mno-recip -ffp-contract=off", NOTHING),
        ("-mrecip -mrecip=none -ffp-contract=off", BITS),
        ("-fveclib=libmvec -fno-fast-math -ffp-contract=off", NOTHING),
        ("-fveclib=libmvec -fno-approx-func -ffp-contract=off", NOTHING),
        ("-fveclib=libmvec -fveclib=none -ffp-contract=off", BITS),
        ("-ffinite-math-only -fhonor-nans -ffp-contract=off", NOTHING),
        ("-fno-honor-nans -fhonor-infinities -ffp-contract=off", NOTHING),
        ("-ffinite-math-only -fhonor-nans -fhonor-infinities -ffp-contract=off", BITS),
        ("-Ofast -fno-fast-math -ffp-contract=off", NOTHING),
        ("-mdaz-ftz -fno-fast-math -ffp-contract=off", NOTHING),
        ("-fdenormal-fp-math=preserve-sign -fdenormal-fp-math-f32=ieee -ffp-contract=off", NOTHING),
        ("-fdenormal-fp-math=ieee,preserve-sign -ffp-contract=off", NOTHING),
        ("-ffp-model=precise", BOUNDS),
        ("-frounding-math -fno-trapping-math -ffp-contract=off", BITS),
    ],
)
def test_flags_are_judged_in_their_order(flags, holds):
    effect = classify_flags(flags)
    assert effect.holds == holds and effect.accepted == (holds != NOTHING)
    assert effect == classify_flags(flags.split())
    if holds == NOTHING:
        assert effect.sentence().startswith("the certificate is void (-")


@pytest.mark.parametrize(
    "flag",
    ["-funny", "-fno-rounding", "-Dsin=cos", "-mllvm", "/fp:fast", '-O2 "', "", "cl /fp:fast", "icx -O2", "zig cc -O2", "tcc",
     "gcc @flags", "gcc -Wp,-Dsin=cos", "gcc -Wa,--defsym", "gcc -DNAN=0", "gcc -DSYMROT_RESTRICT=x", "gcc -include sin.h"],
)  # fmt: skip
def test_a_flag_or_a_compiler_that_nobody_knows_is_refused_in_one_sentence(flag):
    with pytest.raises(InputError, match=r"^flags: expected"):
        classify_flags(flag)


@pytest.mark.parametrize(
    ("flags", "holds"),
    [("/usr/bin/x86_64-linux-gnu-gcc-12 -ffp-contract=off -DMY_APP=1 main.c kernel.c -o main", BITS),
     ("ccache clang++-14 -O2 -ffp-contract=off", BITS), ("C:\\\\gcc.exe -O2", BOUNDS), ("kernel.c -ffp-contract=off", BITS),
     ("i686-linux-gnu-gcc -O2 -ffp-contract=off", NOTHING), ("i686-linux-gnu-gcc -msse2 -mfpmath=sse -ffp-contract=off", BITS)],
)  # fmt: skip
def test_compilers_are_known_by_their_names(flags, holds):
    """A compiler for a processor with x87 keeps more digits than the type has, unless SSE2 is requested."""
    assert classify_flags(flags).holds == holds


def test_the_section_of_flags_gives_a_reason_for_each():
    section = flags_section()
    assert list(section["required"]) == ["-ffp-contract=off"]
    for name, rows in section.items():
        assert all(rows.values()), name
    for flag in section["void"]:
        assert classify_flags([flag, "-ffp-contract=off"]).holds == NOTHING
    for flag in section["allowed"]:
        assert classify_flags([flag, "-ffp-contract=off"]).holds == BITS


@pytest.mark.parametrize(
    ("flags", "code", "sentence"),
    [
        ("gcc -O3 -mavx2 -ffp-contract=off", 0, "the results are those of the C text bit for bit"),
        ("gcc -O2 -march=native", 0, "the error bounds hold, but the bits of results may differ"),
        ("gcc -O2 -ffast-math", 1, "the certificate is void"),
        ("gcc -fmagic", 2, "got '-fmagic'"),
    ],
)
def test_the_audit_says_what_holds_under_flags(capsys, flags, code, sentence):
    assert main(["audit", str(KERNELS / "torque_spring.cert.json"), "--flags", flags]) == code
    output = capsys.readouterr()
    assert sentence in (output.err if code else output.out)
    assert output.err.count("\n") == (1 if code else 0)
