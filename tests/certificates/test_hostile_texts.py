"""C texts that C and a careless reader read differently, certified again by a forger: each is refused in one sentence.

The hash in the certificate is corrected and the certificate is sealed again, so that only the meaning of the text can
refuse it. Some texts are not C at all, or are C that computes the same: a kernel may be written in one way only.
"""

import json
import re
from hashlib import sha256

import pytest

from symrot.certificates import exact_check, recheck
from symrot.certificates.audit import audit
from symrot.certificates.certificate import certificate_json
from symrot.codegen.printing.math_header import math_header
from symrot.errors import CertificateError
from symrot.workshop.kernel_text import kernel_text
from tests.campaigns.certificates.mutations import Files, printed_certificate

R, S, V = "euler_zyx_body_rates", "rotation_vector_of_quaternion", "rotation_vector_body_rates"
T, Q, Z = "rigid_body_tensor", "quaternion_of_dcm", "euler_zxz_of_quaternion"
SUM, TURN = (
    "dangles[1] = omega_2*cos_psi - sin_psi*omega_3;",
    "const double turning = (omega_2*sin_psi + omega_3*cos_psi)/cos_theta;",
)
EACH, GUARD = SUM.replace("[1]", "[n + k]"), "SYMROT_ROTATION_VECTOR_OF_QUATERNION_H"
PSI, FAR = "const double psi = angles[2];", "beyond += symrot_far(psi) + symrot_far(theta);"
HOSTILE = {  # what it is: kernel, what is replaced in the text of it, by what
    "integer division": (R, SUM, SUM.replace("cos_psi -", "cos_psi + 1/2 -")),
    "integer": (R, SUM, SUM.replace("cos_psi -", "cos_psi*1 -")),
    "octal index": (Q, "dcm[8]", "dcm[010]"),
    "hex": (S, "2.0*(v1_arc_ratio_1", "0x2p0*(v1_arc_ratio_1"),
    "underscores": (S, "2.0*(v1_arc_ratio_1", "2_0.0e-1*(v1_arc_ratio_1"),
    "power of a pointer": (R, "omega_2*sin_psi", "omega_2**omega*sin_psi"),
    "line comment": (R, "turning*sin_theta;", "turning // *sin_theta\n;"),
    "comment that ends twice": (R, SUM, SUM.replace(" - ", " /*/ - /*/ + ")),
    "comment hides a line": (R, SUM, "/* " + SUM.replace("*", " * ") + " */"),
    "spliced line": (R, PSI, "// \\\n" + PSI + "\n" + PSI.replace("2", "0")),
    "trigraph splice": (R, PSI, "/* ??/\n*/" + PSI),
    "digraph": (R, "angles[2]", "angles<:2:>"),
    "macro": (R, "\nvoid", "\n#define sin cos\nvoid"),
    "macro after a comment": (R, "\nvoid", "\n/* */ #define sin cos\nvoid"),
    "pragma": (R, SUM, '_Pragma("STDC FP_CONTRACT ON") ' + SUM),
    "vertical tab": (R, SUM, SUM.replace(" - ", " -\v ")),
    "other alphabet": (R, "psi = angles[2]", "p\u0455i = angles[2]"),
    "float in double": (R, TURN, TURN.replace("double", "float")),
    "float literal": (S, "2.0*(v1_arc_ratio_1", "2.0f*(v1_arc_ratio_1"),
    "long literal": (S, "2.0*(v1_arc_ratio_1", "2.0L*(v1_arc_ratio_1"),
    "float function": (R, "sin(psi)", "sinf(psi)"),
    "cast": (R, TURN, TURN.replace("= (", "= (float)(")),
    "cast of minus": (R, SUM, SUM.replace("= omega_2", "= (int)-omega_2")),
    "no const": (R, PSI, "double psi = angles[2]; psi = angles[0];"),
    "assigned twice": (R, PSI, PSI + " *(double *)&psi = 0.0;"),
    "shadowed in a block": (R, SUM, "{ const double omega_2 = omega[0]; " + SUM + " }"),
    "shadowed in the loop": (R, FAR, "const double k = 1.0; " + FAR),
    "sum in an inner block": (R, FAR, "uint64_t beyond = 0; " + FAR),
    "comma": (R, SUM, SUM.replace("= omega_2", "= (omega_1, omega_2)")),
    "chain of choices": (S, "s == 0.0 ? 1.0/c : atan2(s, c)/s", "s == 0.0 ? 1.0/c : c == 0.0 ? 1.0 : atan2(s, c)/s"),
    "chain of comparisons": (S, "s == 0.0 ? 1.0/c", "0.0 < s == 0.0 ? 1.0/c"),
    "choice at a threshold": (Q, "const double one_plus_R_11 = 1.0 + R_11;", "const double one_plus_R_11 = symrot_select_ge(R_22, 1000.0, R_11, 1.0 + R_11);"),
    "bump": (R, SUM, SUM.replace(";", " + fabs(psi - 7.0) + fabs(psi - 8.0) - 2.0*fabs(psi - 7.5);")),
    "square root of a square": (R, SUM, SUM.replace("= omega_2", "= sqrt((omega_2 + 9.0)*(omega_2 + 9.0)) - 9.0 + 0.0*omega_2")),
    "decrement": (R, SUM, SUM.replace(" - sin", " --sin")),
    "early return": (R, SUM, "return; " + SUM),
    "statement after return": (S, "return s == 0.0 ?", "return 1.0/c; return s == 0.0 ?"),
    "goto": (R, SUM, "goto end; " + SUM + " end:"),
    "if": (R, SUM, "if (psi < 9.0) " + SUM),
    "negative index": (R, "omega[2]", "omega[-1]"),
    "index beyond": (R, "omega[2]", "omega[3]"),
    "reversed index": (R, "omega[2]", "2[omega]"),
    "index of one sample": (R, "angles[2*n + k]", "angles[2*n]"),
    "index for one number of samples": (R, "angles[2*n + k]", "angles[10 + k]"),
    "written elsewhere": (R, "dangles[2*n + k] =", "dangles[3*n + k] ="),
    "not written": (R, SUM, ""),
    "input written": (R, SUM, SUM + " ((double *)omega)[0] = 0.0;"),
    "input not const": (R, "(const double angles[3]", "(double angles[3]"),
    "arguments swapped": (R, "const double angles[3], const double omega[3]", "const double omega[3], const double angles[3]"),
    "function twice": (R, "\nvoid", "\nvoid symrot_euler_zyx_body_rates_batch(size_t n) { }\n\nvoid"),
    "own sine": (R, "\nvoid", "\nstatic inline double symrot_sin(double x)\n{\n    return x;\n}\n\nvoid"),
    "global": (R, "\nvoid", "\nstatic const double pi = 3.0;\n\nvoid"),
    "local function": (R, SUM, "double cos(double); " + SUM),
    "angle that no one asks": (R, FAR, FAR.replace(" + symrot_far(theta)", "")),
    "another angle asked": (R, FAR, FAR.replace("(theta)", "(omega_1)")),
    "angles asked by a product": (R, FAR, FAR.replace(" + ", "*")),
    "angles asked by a difference": (R, FAR, FAR.replace(" + ", " - ")),
    "never again": (R, "beyond == 0 ? start : end", "beyond == 0 ? start : start"),
    "again only a part": (R, "k < again", "k < again - 1"),
    "range in one sample": (R, "sin(psi)", "symrot_sin(psi)"),
    "range in a safe function": (V, "return x == 0.0 ? 1.0 : sin(x)/x;", "return x == 0.0 ? 1.0 : symrot_sin(x)/x;"),
    "first sample left out": (R, "for (size_t start = 0;", "for (size_t start = 1;"),
    "last sample left out": (S, "k < n; ++k", "k < n - 1; ++k"),
    "every other sample": (S, "++k", "k += 2"),
    "span beyond the end": (T, "n - start < SYMROT_SPAN ? n : start + SYMROT_SPAN", "start + SYMROT_SPAN"),
    "steps larger than spans": (T, "start += SYMROT_SPAN", "start += 2*SYMROT_SPAN"),
    "inner number of samples": (T, "const size_t end", "const size_t n = 1; const size_t end"),
    "narrow sum": (R, "uint64_t beyond", "uint8_t beyond"),
    "start of a block shadowed": (R, "const size_t end", "const double start = 0.5; const size_t end"),
    "first loop empty": (S, "SYMROT_INDEPENDENT\n    for (size_t k = 0; k < n; ++k) {", "for (size_t k = 0; k < n; ++k) { } {"),
    "function of itself": (V, "return x == 0.0 ? 1.0 : sin(x)/x;", "return symrot_sinc(x);"),
    "two functions of each other": (V, "return x == 0.0 ? 1.0 : sin(x)/x;", "return symrot_near_sinc(x);"),
    "series, last digit": (V, "0.0011904761904761906", "0.0011904761904761908"),
    "series, a term less": (V, " + t*(-3.9145882126782523e-19)", ""),
    "series, split": (V, "t < 2.25 ?", "t < 2.5 ?"),
    "too small to matter": (R, SUM, SUM.replace(";", " + 1e-300;")),
    "attribute": (R, "cos_psi - sin_psi", "cos_psi.real - sin_psi"),
    "import": (R, SUM, SUM.replace("= omega_2", "= __import__('os').getpid()")),
    "number of the sample": (R, EACH, EACH.replace(";", " + k;")),
    "name of Python": (R, SUM, SUM.replace(";", " + False;")),
    "name of the compiler": (R, SUM, SUM.replace(";", "*__debug__;")),
    "number without a digit before its point": (R, SUM, SUM.replace(";", "*(.9/.9);")),
    "comma behind a choice": (S, "return s == 0.0 ? 1.0/c : atan2(s, c)/s;", "return fabs(s == 0.0 ? 1.0/c : c), fabs, s, c;"),
    "macro among arguments": (R, "(const double angles[3],", "(\n#define sin cos\nconst double angles[3],"),
    "digraph among arguments": (R, "(const double angles[3],", "(\n%:define sin cos\nconst double angles[3],"),
    "comment among arguments": (S, "symrot_arc_ratio(double s, double c)", "symrot_arc_ratio(double c, double // s, double\n s)"),
    "guard of the header as a name": (S, "symrot_arc_ratio(double s, double c)\n{\n    return s == 0.0 ? 1.0/c",
                                      f"symrot_arc_ratio(double s, double {GUARD} c)\n{{\n    return s == 0.0 ? {GUARD} -c"),
    "choice by a name of the checker": (R, "\nvoid", "\nstatic inline double if_(double a)\n{\n    return a;\n}\n\nvoid"),
    "square root of another type": (S, "\nstatic", "\nstatic inline long sqrt(double x)\n{\n    return 3;\n}\n\nstatic"),
    "range asked in a quotient": (R, SUM, SUM.replace(";", "*(symrot_far(psi)/symrot_far(psi));")),
    "text behind an include": (R, SUM, SUM.replace(" - ", f'\n#include "{R}.h" - ')),
    "comment of later C around one": (R, SUM, SUM.replace(";", " + 1.0 - 2.0 //**/ 2.0\n;")),
    "macro in a function that nobody calls": (R, "\nvoid", "\nstatic inline double symrot_unused(double x)\n{\n    return x;\n"
                                              "#define sin(x) (7.0*(x))\n}\n\nvoid"),
    "quotes in a function that nobody calls": (R, "\nvoid", "\nstatic inline double symrot_unused(double x)\n{\n    return '{';\n"
                                               "}\n\nvoid"),
    "argument of another type": (R, "(const double angles[3],", "(const long double angles[3],"),
    "nested comments": (R, SUM, "/* /* */ " + SUM.replace(" - ", " + ") + " /* */"),
}  # fmt: skip


@pytest.fixture(scope="module")
def kernels(tmp_path_factory):
    """Write some kernels and their certificates into a folder."""
    directory = tmp_path_factory.mktemp("kernels")
    return {
        name: Files(directory, kernel_text(name).under_test(), printed_certificate(name)) for name in (R, S, V, T, Q, Z)
    }


@pytest.fixture
def refused(kernels):
    """Return a function that writes a text and its certificate and checks that all checkers refuse it in one sentence."""
    written = []

    def refused(name, text, **changes):
        files = kernels[name]
        written.append(files)
        (files.directory / f"{name}.c").write_text(text, encoding="utf-8")
        digests = files.data["files"] | {f"{name}.c": sha256(text.encode()).hexdigest()}
        files.path.write_text(certificate_json(files.data | {"files": digests} | changes), encoding="utf-8")
        with pytest.raises(Exception) as caught:
            recheck.check(files.path)
        said = [str(caught.value)]
        with pytest.raises(exact_check.REFUSALS) as caught:
            exact_check.check(files.path)
        said.append(exact_check.sentence(caught.value))
        with pytest.raises(CertificateError) as caught:
            audit(files.path, lambda data: files.said)
        assert "\n" not in "".join(said) + str(caught.value)
        return said[0]

    yield refused
    for files in written:
        files.restore()


@pytest.mark.thinned(6)
@pytest.mark.parametrize("what", HOSTILE)
def test_a_text_that_c_reads_differently_is_refused(kernels, refused, what):
    name, old, new = HOSTILE[what]
    text = kernels[name].source
    start = text.index("#include")
    assert old in text[start:]
    said = refused(name, text[:start] + text[start:].replace(old, new, 1))
    assert "hash" not in said and "certified" not in said


def test_angles_beyond_the_range_are_computed_again_by_the_c_library(kernels, refused):
    """The second loop of a block must not call functions of limited range, not even through functions of the file."""
    text = kernels[R].source
    at = text.index("k < again")
    for function in ("sin", "cos"):
        changed = text[at:].replace(f"= {function}(", f"= symrot_{function}(", 1)
        assert "does not test all angles for their range" in refused(R, text[:at] + changed)
    text = kernels[V].source
    for function in ("sinc", "tangent_gap"):
        at = text.index(f"double symrot_{function}(")
        assert "does not test all angles for their range" in refused(
            V, text[:at] + text[at:].replace(" sin(x)", " symrot_sin(x)").replace("(sin(x)", "(symrot_sin(x)", 1)
        )


def test_angles_are_asked_for_before_anything_is_computed_again(kernels, refused):
    """A test of angles in the second loop, or a first loop that computes nothing, would leave samples wrong."""
    text = kernels[R].source
    at = text.index("k < again")
    end = text.index("        }\n", at)
    late = text[:at].replace(FAR, "") + text[at:end] + "    " + FAR + "\n" + text[end:]
    assert late.count(FAR) == 1
    assert "got 'beyond'" in refused(R, late)
    start = text.index("{\n", text.index("k < end")) + 2
    assert "does not compute its formulas" in refused(R, text[:start] + text[text.index("        }\n", start) :])


FORGED = {  # what it is: kernel, part of its readback or law, what takes its place
    "pi by another number": (Z, "constants", lambda each: [each[0], "22/7"]),
    "twice pi": (Z, "constants", lambda each: [each[0], "2*pi"]),
    "another number of pi": (Z, "constants", lambda each: ["3", each[1]]),
    "a whole number for one beside it": (Z, "constants", lambda each: ["8", "8 + 1/10**20"]),
    "a bump between points": (
        V,
        "series",
        lambda each: [*each[:2], [each[2][0] + " + 10**9*(x**2 - 1)", *each[2][1:]], each[3]],
    ),
    "a split by functions": (V, "series", lambda each: [each[0], "1/(10**12*exp(-100)**2)", *each[2:]]),
    "a split further out": (V, "series", lambda each: [each[0], "5/2", *each[2:]]),
    "a term more": (V, "series", lambda each: [*each[:2], [*each[2], "1/10**30"], each[3]]),
    "a term less": (V, "series", lambda each: [*each[:2], each[2][:-1], each[3]]),
    "a larger rest": (V, "series", lambda each: [*each[:2], [*each[2][:-1], "1/10"], "1"]),
    "a smaller rest": (V, "series", lambda each: [*each[:3], "0"]),
}


@pytest.mark.thinned(4)
@pytest.mark.parametrize("what", FORGED)
def test_a_certificate_of_other_constants_or_series_is_refused(kernels, refused, what):
    name, part, changed = FORGED[what]
    readback = json.loads(json.dumps(kernels[name].data["readback"]))
    function = f"symrot_{name}"
    readback[function][part][0] = changed(readback[function][part][0])
    assert refused(name, kernels[name].source, readback=readback)


def test_an_output_may_not_take_the_name_of_an_input(kernels, refused):
    """Otherwise a law about the output would seem to be about the input."""
    spec = kernels[R].data["spec"]
    for symbol in ("omega_1", "phi", "pi", spec["formulas"][1][1], *(name for name, _ in spec["named"][:1])):
        (place, _, text), *formulas = spec["formulas"]
        said = refused(R, kernels[R].source, spec=spec | {"formulas": [[place, symbol, text], *formulas]})
        assert said.startswith(f"{symbol} is already in use")


@pytest.mark.parametrize(
    "given",
    [
        lambda given: given[:6], lambda given: [*given[3:6], *given[:3], *given[6:]], lambda given: [],
        lambda given: ["q0", "q1", "q2", "q3"], lambda given: given[:1] * 9, lambda given: [*given[:6], *given[:3]],
        lambda given: ["1", *given[1:]],
    ],
    ids=["rows", "mirrors", "nothing", "outputs", "one of them", "twice", "no name"],
)  # fmt: skip
def test_what_is_given_is_a_rotation_or_of_length_one(kernels, refused, given):
    laws = kernels[Q].data["laws"]
    changed = [law | {"given": given(law["given"])} if len(law["given"]) > 1 else law for law in laws]
    assert changed != laws
    said = refused(Q, kernels[Q].source, laws=changed)
    assert re.match(
        r"expected the law .* to follow|the law .* does not follow|.* is already in use|the law .*: expected a list of names",
        said,
    )


def test_a_law_of_nothing_is_refused(kernels, refused):
    (law, *laws) = kernels[S].data["laws"]
    for nothing in ([], "00"):
        assert refused(S, kernels[S].source, laws=[law | {"vanishing": nothing}, *laws])
    assert refused(S, kernels[S].source, laws=[])


def test_an_input_is_a_name_and_a_parameter_has_its_own_place(kernels, refused):
    (first, *inputs), spec = kernels[R].data["inputs"], kernels[R].data["spec"]
    for symbol in ("0", "1/2", "theta*psi", ""):
        assert refused(R, kernels[R].source, inputs=[[first[0], symbol, first[2]], *inputs])
    assert refused(R, kernels[R].source, spec=spec | {"parameters": {first[1]: "0"}})


def test_a_name_that_a_certificate_says_twice_is_refused(kernels):
    """A person reads the first value, programs use the last."""
    files = kernels[R]
    text = files.path.read_text(encoding="utf-8")
    files.path.write_text(text.replace('"laws":', '"laws": [],\n "laws":', 1), encoding="utf-8")
    with pytest.raises(Exception):  # noqa: B017 - whatever it is, it is a refusal
        recheck.check(files.path)
    with pytest.raises(CertificateError, match="twice"):
        audit(files.path, lambda data: files.said)
    files.restore()


@pytest.mark.parametrize(
    "vanishing",
    [
        "(q0 - 5)*(q0**2 + q1**2 + q2**2 + q3**2)**90",
        "(q0 - 5 + 10**95) - 10**95",
        "q0/10**60",
        "q0 - q0**2/q0 + 1/10**50",
        "q0**2 + q1**2 + q2**2 + q3**2 - 2",
    ],
)
def test_a_law_that_is_nearly_true_is_refused(kernels, refused, vanishing):
    (law, *laws) = kernels[S].data["laws"]
    assert refused(S, kernels[S].source, laws=[law | {"vanishing": [vanishing, *law["vanishing"][1:]]}, *laws])


HEADERS = {  # what a header says beside its prototypes, or instead of them: what is replaced, by what
    "macro": ("\n#endif\n", "\n#endif\n#define sin cos\n"),
    "macro among prototypes": ("/* one sample */", "#define sin(x) (7.0*(x))\n"),
    "macro of another restrict": ("SYMROT_RESTRICT restrict", "SYMROT_RESTRICT volatile"),
    "loop by a macro": ('_Pragma("GCC ivdep")', "if (0)"),
    "another header": ("#include <stddef.h>", '#include "other.h"'),
    "function": ("/* one sample */", "static inline double sin(double x) { return x; }"),
    "prototype of another function": ("/* one sample */", "double sin(double x);"),
    "other arguments": ("const double omega[3]", "const double omega[4]"),
    "no guard": ("#ifndef SYMROT_EULER_ZYX_BODY_RATES_H", "#ifndef SYMROT_OTHER_H"),
    "spliced line": ("/* one sample */", "/* one sample */ \\\n"),
    "line comment": ("/* one sample */", "// /* one sample */"),
    "trigraph": ("/* one sample */", "/* ??/\n */"),
    "other alphabet": ("/* one sample */", "/* \u0435 */"),
}  # fmt: skip


@pytest.mark.parametrize("what", HEADERS)
def test_a_header_that_says_more_than_prototypes_is_refused(what, kernels):
    files = kernels[R]
    old, new = HEADERS[what]
    text = files.texts[f"{R}.h"]
    start = text.index("#ifndef")
    assert old in text[start:]
    text = text[:start] + text[start:].replace(old, new, 1)
    (files.directory / f"{R}.h").write_text(text, encoding="utf-8")
    digests = files.data["files"] | {f"{R}.h": sha256(text.encode()).hexdigest()}
    files.path.write_text(certificate_json(files.data | {"files": digests}), encoding="utf-8")
    with pytest.raises(ValueError, match=f"{R}.h holds"):
        recheck.check(files.path)
    with pytest.raises(CertificateError):
        audit(files.path, lambda data: files.said)
    files.restore()


def test_another_header_of_functions_is_refused(kernels):
    files = kernels[R]
    text = math_header().replace("sin", "cos")
    (files.directory / "symrot_math.h").write_text(text, encoding="utf-8")
    digests = files.data["files"] | {"symrot_math.h": sha256(text.encode()).hexdigest()}
    files.path.write_text(certificate_json(files.data | {"files": digests}), encoding="utf-8")
    with pytest.raises(ValueError, match=r"symrot_math\.h was changed"):
        recheck.check(files.path)
    files.restore()
    assert (
        sha256(math_header().encode()).hexdigest() == recheck.MATH_HEADER_SHA256
    )  # print it anew where symrot_math.h changes
