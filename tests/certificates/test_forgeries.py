"""Forged kernels that `recheck.py` alone must refuse, each in one sentence that says where and what it expected.

A forger edits a text or a certificate, corrects the hashes and seals the certificate again. Forgeries that all checkers
refuse are in :mod:`tests.certificates.test_hostile_texts`.
"""

import json
import re
import shutil
from hashlib import sha256
from pathlib import Path
from time import process_time

import pytest

from symrot.certificates import recheck
from symrot.certificates.certificate import certificate_json

GENERATED = Path(__file__).parents[2] / "generated" / "c"
ATTITUDE, TOP, ANGLES = "quaternion_of_dcm", "heavy_top", "euler_zyx_body_rates"
VECTOR, ANGLES_OF, PLATE = "rotation_vector_body_rates", "euler_zxz_of_quaternion", "inertia_triangular_plate"


class Forgery:
    """The files of a kernel in a folder, which a test edits and certifies again."""

    def __init__(self, name, folder, source=GENERATED):
        self.name, self.folder = name, folder
        self.path = folder / f"{name}.cert.json"
        self.data = json.loads((source / f"{name}.cert.json").read_text(encoding="utf-8"))
        for file in (f"{name}.c", f"{name}.h"):
            shutil.copy(source / file, folder)
        shutil.copy(GENERATED / "symrot_math.h", folder)

    def read(self, end):
        return (self.folder / f"{self.name}{end}").read_text(encoding="utf-8")

    def write(self, end, text):
        (self.folder / f"{self.name}{end}").write_text(text, encoding="utf-8")

    def edit(self, old, new, behind="\nvoid ", end=".c"):
        """Replace the first occurrence of a text after another text."""
        text = self.read(end)
        start = text.index(old, text.index(behind))
        self.write(end, text[:start] + new + text[start + len(old) :])

    def seal(self):
        """Correct all hashes and seal the certificate."""
        for end in (".c", ".h"):
            text = (self.folder / f"{self.name}{end}").read_bytes()
            self.data["files"][f"{self.name}{end}"] = sha256(text).hexdigest()
        self.path.write_text(certificate_json(self.data), encoding="utf-8")

    def refusal(self):
        """Return the sentence that refuses the certificate; the check must be quick and the message one line."""
        start = process_time()
        with pytest.raises(ValueError) as caught:
            recheck.check(self.path)
        sentence = str(caught.value)
        assert type(caught.value) is ValueError and process_time() - start < 20
        assert sentence and "\n" not in sentence and len(sentence) < 400
        return sentence


@pytest.fixture
def forgery(tmp_path):
    return lambda name, **options: Forgery(name, tmp_path, **options)


@pytest.mark.parametrize("name", [ATTITUDE, TOP, ANGLES, VECTOR, ANGLES_OF, PLATE])
def test_what_is_not_forged_is_accepted(forgery, name):
    """Otherwise the refusals below would prove nothing. An added comment or blank line changes nothing either."""
    files = forgery(name)
    files.edit("\nvoid ", "\n\n/* a remark */\nvoid ")
    files.seal()
    assert recheck.check(files.path).startswith(f"{name}: ")


BATCH, FLOAT = f"void symrot_{TOP}_batch(", f"void symrot_{TOP}f("
TEXTS = {  # what it is: kernel, text, what takes its place, behind which text, what the refusal says
    "sign": (TOP, "q0*q1 + q2*q3", "q0*q1 - q2*q3", "\nvoid ", r"heavy_top does not compute its formulas: expected domega\[0\]"),
    "sign in the batch alone": (TOP, "q0*q1 + q2*q3", "q0*q1 - q2*q3", BATCH, "heavy_top_batch does not compute its formulas"),
    "sign in float alone": (TOP, "q0*q1 + q2*q3", "q0*q1 - q2*q3", FLOAT, "heavy_topf does not compute its formulas"),
    "sign in the batch of float": (TOP, "q0*q1 + q2*q3", "q0*q1 - q2*q3", f"void symrot_{TOP}f_batch(", "heavy_topf_batch does not compute its formulas"),
    "sign of a whole formula": (TOP, "dq[0] = -(", "dq[0] = (", "\nvoid ", r"does not compute its formulas: expected dq\[0\]"),
    "digit of a half": (TOP, "0.5*omega_1", "0.6*omega_1", "\nvoid ", "heavy_top does not compute its formulas"),
    "last digit of a constant": (PLATE, "0.05555555555555555", "0.05555555555555556", "\nvoid ", "inertia_.* does not compute its formulas"),
    "digit of a constant in float": (PLATE, "0.055555556f*m", "0.055555550f*m", f"void symrot_{PLATE}f(", "inertia_.*f does not compute its formulas"),
    "number of another size": (TOP, "2.0*W", "2.0e1*W", "\nvoid ", "heavy_top does not compute its formulas"),
    "operands of a difference": (TOP, "(B - C)", "(C - B)", "\nvoid ", "heavy_top does not compute its formulas"),
    "operands of a quotient": (VECTOR, "tangent_gap_half_angle/sinc_half_angle", "sinc_half_angle/tangent_gap_half_angle", "\nvoid ", f"{VECTOR} does not compute its formulas"),
    "operands of atan2": (ANGLES_OF, "atan2(q2, q1)", "atan2(q1, q2)", "\nvoid ", f"{ANGLES_OF} does not compute its formulas"),
    "parentheses": (TOP, "(B - C)*omega_2", "B - C*omega_2", "\nvoid ", "heavy_top does not compute its formulas"),
    "missing term": (TOP, " - q1*q1 - q2*q2", " - q1*q1", "\nvoid ", "heavy_top does not compute its formulas"),
    "missing factor": (TOP, "c_3*two_W", "c_3", "\nvoid ", "heavy_top does not compute its formulas"),
    "term too much": (TOP, "q0*q1 + q2*q3", "q0*q1 + q2*q3 + q3*q3", "\nvoid ", "heavy_top does not compute its formulas"),
    "output written twice": (TOP, "dq[1] =", "dq[0] =", "\nvoid ", r"heavy_top\.c, line \d+: expected an output .* once"),
    "output written once more": (TOP, "    dq[1] =", "    dq[0] = 0.0;\n    dq[1] =", "\nvoid ", "expected an output .* once"),
    "output as an input": (TOP, "dq[1] = q0", "dq[1] = dq[0]", "\nvoid ", "expected an array of inputs, got 'dq'"),
    "empty statement": (TOP, "c_3*two_W;", "c_3*two_W;;", "\nvoid ", r"heavy_top\.c, line \d+: expected .*, got ';'"),
    "statement without effect": (TOP, "    dq[1]", "    q0;\n    dq[1]", "\nvoid ", r"heavy_top\.c, line \d+: expected .*, got 'q0'"),
    "local of a name in use": (TOP, "    dq[1]", "    const double q0 = q[1];\n    dq[1]", "\nvoid ", "q0 is already in use"),
    "local by itself": (TOP, "const double two_W = 2.0*W;", "const double two_W = 2.0*two_W;", "\nvoid ", "declared above, got 'two_W'"),
    "local before its declaration": (TOP, "const double A =", "const double early = B;\n    const double A =", "\nvoid ", "got 'B'"),
    "function for one sample again": (TOP, "void symrot_heavy_top_batch(", "void symrot_heavy_top(", "\nvoid ", "symrot_heavy_top is already in use"),
    "inline function again": (VECTOR, "symrot_near_sinc(double", "symrot_sinc(double", "static", "symrot_sinc is already in use"),
    "inline function of another type again": (VECTOR, "symrot_sincf(float", "symrot_sinc(float", "static", "symrot_sinc is already in use"),
    "function of C defined": (VECTOR, "symrot_sinc(double x)", "sqrt(double x)", "static", "sqrt is already in use"),
    "branches of a choice": (VECTOR, "1.0 : sin(x)/x", "sin(x)/x : 1.0", "static", f"{VECTOR} does not compute its formulas"),
    "comparison of a choice": (VECTOR, "t < 2.25", "t >= 2.25", "static", f"{VECTOR} does not compute its formulas"),
    "strict comparison": (ATTITUDE, "a >= b", "a > b", "static", r"expected .*, got '>'"),
    "operands of a choice": (ATTITUDE, "(q0_term_3, q0_term_4, q0_term_3, q0_term_4)", "(q0_term_4, q0_term_3, q0_term_3, q0_term_4)", "\nvoid ", f"{ATTITUDE} does not compute its formulas"),
    "ways of a choice": (ATTITUDE, "(q0_term_3, q0_term_4, q0_term_3, q0_term_4)", "(q0_term_3, q0_term_4, q0_term_4, q0_term_3)", "\nvoid ", f"{ATTITUDE} does not compute its formulas"),
    "choice with an argument less": (ATTITUDE, "(q0_term_3, q0_term_4, q0_term_3, q0_term_4)", "(q0_term_3, q0_term_4, q0_term_3)", "\nvoid ", "expected 4 arguments of symrot_select_ge"),
    "index beyond the array": (TOP, "q[3]", "q[4]", "\nvoid ", "expected an index of q below 4, got 4"),
    "index one less": (TOP, "q[3]", "q[2]", "\nvoid ", "heavy_top does not compute its formulas"),
    "output one further": (TOP, "dq[3]", "dq[4]", "\nvoid ", "expected an index of dq below 4, got 4"),
    "index in the batch": (TOP, "q[3*n + k]", "q[4*n + k]", BATCH, r"heavy_top\.c, line \d+: expected an index of q below 4, got 4"),
    "array of another size": (TOP, "const double q[4]", "const double q[5]", "\nvoid ", "heavy_top.h holds more than prototypes"),
    "index that is computed": (TOP, "q[3*n + k]", "q[3*n + k + 0]", BATCH, r"expected `\]`"),
    "index of the next sample": (TOP, "q[3*n + k]", "q[n + k + 2*n]", BATCH, r"expected `\]`"),
    "other include": (TOP, '"heavy_top.h"', '"other.h"', "#include", r"line \d+: expected #include of"),
    "include of the system": (TOP, '#include "heavy_top.h"', "#include <other.h>", "#include", r"line \d+: expected #include of"),
    "include twice": (TOP, '"heavy_top.h"\n', '"heavy_top.h"\n#include "heavy_top.h"\n', "#include", r"line \d+: expected #include"),
    "include behind a function": (TOP, "\nvoid symrot_heavy_top_batch", '\n#include "heavy_top.h"\nvoid symrot_heavy_top_batch', "\nvoid ", "got '#'"),
    "include of functions that nobody certified": (TOP, '"heavy_top.h"', '"heavy_top.h"\n#include "symrot_math.h"', "#include", "expected #include"),
    "macro in front of all": (TOP, '#include "heavy_top.h"', '#define q1 q2\n#include "heavy_top.h"', "#include", r"line \d+: expected #include"),
    "macro with a space": (TOP, '"heavy_top.h"\n', '"heavy_top.h"\n # define q1 q2\n', "#include", r"line \d+: expected #include"),
    "macro without a line of its own": (TOP, "q0*q1", "q0 /* */ #define q1 q2\n *q1", "\nvoid ", "got '#'"),
    "macro of the header as a factor": (TOP, "q0*q1", "q0*SYMROT_SPAN", "\nvoid ", "got 'SYMROT_SPAN'"),
    "condition of the preprocessor": (TOP, "    dq[1] =", "#if 0\n    dq[1] =", "\nvoid ", "got '#'"),
    "name of the compiler as a factor": (TOP, "q0*q1", "q0*__LINE__", "\nvoid ", "got '__LINE__'"),
    "comment that does not end": (TOP, "q0*q1", "q0/* *q1", f"void symrot_{TOP}f_batch(", "expected comments that end, without"),
    "end of no comment": (TOP, "q0*q1", "q0*/q1", "\nvoid ", "got '/'"),
    "comment inside a name": (TOP, "omega_1*omega_2", "ome/**/ga_1*omega_2", "\nvoid ", "got 'ome'"),
    "comment around a sign": (TOP, "q0*q1 + q2*q3", "q0*q1 /* + q2 */ *q3", "\nvoid ", "heavy_top does not compute its formulas"),
    "line joined to the next one": (TOP, "q0*q1", "q0*\\\nq1", "\nvoid ", "expected plain ASCII"),
    "trigraph": (TOP, "q[3]", "q??(3??)", "\nvoid ", r"expected plain ASCII .* got '\?\?'"),
    "digraph": (TOP, "{\n    const double A", "<%\n    const double A", "\nvoid ", "got '<'|got '%'"),
    "carriage return": (TOP, "q0*q1", "q0*\rq1", "\nvoid ", "expected plain ASCII"),
    "null character": (TOP, "q0*q1", "q0*\0q1", "\nvoid ", "expected plain ASCII"),
    "loop from the second sample": (TOP, "size_t k = 0", "size_t k = 1", BATCH, "expected `0` of"),
    "loop without its promise": (TOP, "    SYMROT_INDEPENDENT\n", "", BATCH, "heavy_top.c, line .*expected"),
    "counter by another type": (ANGLES, "uint64_t beyond = 0", "uint64_t beyond = 1", f"void symrot_{ANGLES}_batch(", "expected `0`"),
    "angles counted twice, one never": (ANGLES, "symrot_far(psi) + symrot_far(theta)", "symrot_far(psi) + symrot_far(psi)", f"void symrot_{ANGLES}_batch(", "does not test all angles for their range"),
    "float in a function of double": (TOP, "const double half_1", "const float half_1", "\nvoid ", "expected `double`"),
    "inputs in another order": (TOP, "double W, const double center_of_mass[3]", "const double center_of_mass[3], double W", "\nvoid ", "arguments or loops of heavy_top are others|prototypes"),
    "parentheses too deep": (TOP, "q0*q1", "(" * 9000 + "q0*q1" + ")" * 9000, "\nvoid ", "expected fewer nested parentheses and calls"),
    "minus upon minus": (TOP, "q0*q1", "- " * 9000 + "q0*q1", "\nvoid ", "expected fewer nested parentheses and calls"),
    "number of many digits": (TOP, "2.0*W", f"2.{'0' * 9000}*W", "\nvoid ", "expected a double such as 2.0"),
    "number without an end": (TOP, "2.0*W", "2.0e308*W", "\nvoid ", "expected a double such as 2.0"),
    "numbers that grow": (TOP, "    const double two_W = 2.0*W;", "    const double z0 = W*W;\n" + "".join(
        f"    const double z{k + 1} = z{k}*z{k};\n" for k in range(40)) + "    const double two_W = 2.0*W + (z40 - z40);", "\nvoid ", "binary digits"),
    "functions that double their work": (VECTOR, "static inline double symrot_sinc(", "static inline double symrot_f0(double x)\n{\n    return x;\n}\n" + "".join(
        f"static inline double symrot_f{k + 1}(double x)\n{{\n    return symrot_f{k}(x) + symrot_f{k}(x);\n}}\n" for k in range(40))
        + "static inline double symrot_sinc(", "static", "expected at most 200000 words"),
}  # fmt: skip


@pytest.mark.thinned(2)
@pytest.mark.parametrize("what", TEXTS)
def test_a_forged_c_text_is_refused(forgery, what):
    name, old, new, behind, sentence = TEXTS[what]
    files = forgery(name)
    files.edit(old, new, behind)
    files.seal()
    assert re.search(sentence, files.refusal())


def formula(change):
    """Return a forger that changes the text of the first formula."""

    def changed(data):
        place, symbol, text = data["spec"]["formulas"][0]
        data["spec"]["formulas"][0] = [place, symbol, change(text)]

    return changed


def part(change, *way):
    """Return a forger that changes one part of a certificate."""

    def changed(data):
        for key in way[:-1]:
            data = data[key]
        data[way[-1]] = change(data[way[-1]])

    return changed


CERTIFICATES = {  # what it is: how the certificate of heavy_top is forged, what the refusal says
    "sign of a formula": (formula(lambda text: f"-({text})"), "does not follow"),
    "formula that is no text": (formula(lambda text: 1), r"certificate.spec.formulas\[0\]\[2\]: expected a text"),
    "formula without an end": (formula(lambda text: text + " +"), r"formula of 'domega\[0\]', .* got 'the end'"),
    "formula with more behind it": (formula(lambda text: text + " q0"), "expected the end of the formula, got 'q0'"),
    "code of Python": (formula(lambda text: "__import__('os').getpid()"), r"formula of 'domega\[0\]'"),
    "attribute": (formula(lambda text: text + ".real"), "expected names, numbers and operators"),
    "huge exponent": (formula(lambda text: "q0**99999"), "exponent of one or two digits"),
    "tower of exponents": (formula(lambda text: "q0**9**9"), "expected one exponent"),
    "power of powers": (formula(lambda text: "((((q0**99)**99)**99)**99)**99"), "does not follow|binary digits|usual size|defined somewhere"),
    "deep parentheses": (formula(lambda text: "(" * 50000 + "q0" + ")" * 50000), "expected fewer nested parentheses and calls"),
    "deep functions": (formula(lambda text: "sin(" * 5000 + "q0" + ")" * 5000), "expected fewer nested parentheses and calls"),
    "number of many digits": (formula(lambda text: text + " + 0*" + "9" * 5000), "expected a number such as 2 or 0.5"),
    "number of many nines": (formula(lambda text: text + " + 0*1e999999999"), "expected a number such as 2 or 0.5"),
    "formula that is defined nowhere": (formula(lambda text: text + " + 0*sqrt(-1 - q0**2)"), "defined somewhere"),
    "division by zero": (formula(lambda text: text + " + 1/(q0 - q0)"), "defined somewhere"),
    "unknown function": (formula(lambda text: text + " + open(q0)"), "expected a known function, got 'open'"),
    "function without arguments": (formula(lambda text: "sin()"), r"got '\)'"),
    "function with too many arguments": (formula(lambda text: "sin(q0, q1)"), "expected 1 arguments of sin, got 2"),
    "function as a variable": (formula(lambda text: "sin + 1"), "expected the name of a variable, got 'sin'"),
    "other name of the kernel": (part(lambda name: "heavy_bottom", "kernel"), "belongs to another file"),
    "kernel of another folder": (part(lambda name: "../heavy_top", "kernel"), "belongs to another file"),
    "other title": (part(lambda title: "light top", "title"), "expected the comment at the top to begin with the kernel"),
    "title without its end": (part(lambda title: title[:-3], "title"), "expected the comment at the top to begin with the kernel"),
    "no command": (part(lambda command: "", "regenerate"), "expected the comment at the top to name the command"),
    "other command": (part(lambda text: "symrot emit mrp_shadow --target c", "regenerate"), "expected the comment at the top to name the command"),
    "law that is no text": (part(lambda laws: [5], "laws", 0, "vanishing"), r"certificate.laws\[0\].vanishing\[0\]: expected a text"),
    "laws that are none": (part(lambda laws: [], "laws"), "there are no laws"),
    "law of nothing": (part(lambda laws: [], "laws", 0, "vanishing"), "does not follow"),
    "sign in a law": (part(lambda text: f"{text} + 2*A*domega_1", "laws", 0, "vanishing", 0), "does not follow"),
    "inputs as an object": (part(lambda inputs: {}, "inputs"), "certificate.inputs: expected a list"),
    "input of two parts": (part(lambda row: row[:2], "inputs", 0), r"certificate.inputs\[0\]: expected a list of 3"),
    "inputs of one place": (part(lambda row: ["inertia[0]", *row[1:]], "inputs", 1), "expected components in order"),
    "inputs swapped": (part(lambda rows: [rows[1], rows[0], *rows[2:]], "inputs"), "expected components in order"),
    "specification that is missing": (part(lambda spec: None, "spec"), "certificate.spec: expected an object"),
    "types of no number": (part(lambda text: "long", "readback", "symrot_heavy_top", "type"), "another name or type"),
    "box of no number": (part(lambda ends: ["low", "high"], "rounding", "box", "W"), "rounding.box.W: expected a number such as"),
    "box without an end": (part(lambda ends: ["0x0p0", "inf"], "rounding", "box", "W"), "finite range of 'W'"),
    "box of another input": (part(lambda box: {}, "rounding", "box"), "expected a range of 'inertia"),
    "bound below the error": (
        part(lambda bounds: [each | {"outputs": [out | {"absolute": "0x1p-900"} for out in each["outputs"]]} for each in bounds],
             "rounding", "precisions"), "has a larger rounding error than its bound"),
    "file of another folder": (part(lambda files: files | {"/etc/passwd": "0" * 64}, "files"), "is not the path of a kernel's file: expected a path such as NAME.c"),
    "hash of no text": (part(lambda files: files | {"heavy_top.py": 1}, "files"), r"certificate.files.heavy_top.py: expected a text"),
}  # fmt: skip


@pytest.mark.parametrize("what", CERTIFICATES)
def test_a_forged_certificate_is_refused(forgery, what):
    change, sentence = CERTIFICATES[what]
    files = forgery(TOP)
    change(files.data)
    files.seal()
    assert re.search(sentence, files.refusal())


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "expected JSON"), ("no JSON", "expected JSON"), ('{"schema": ', "expected JSON"), ("\xff", "expected"),
        ("[]", "expected an object"), ("7", "expected an object"), ("null", "expected an object"), ("{}", "'schema'"),
        ("[" * 100000, "lists nested too deeply"), ('{"a": 1, "a": 2}', "each name once"), ('{"schema": 1}', "schema"),
        ('{"schema": "symrot.certificate/1", "seal": "", "kernel": [], "files": {}}', "expected a text"),
        ('{"schema": "symrot.certificate/1", "seal": "", "kernel": "heavy_top", "files": {}}', "sealed"),
    ],
)  # fmt: skip
def test_what_is_no_certificate_is_refused(forgery, text, sentence):
    files = forgery(TOP)
    files.path.write_bytes(text.encode("latin-1"))
    assert re.search(sentence, files.refusal())


def renamed(files, name, folder, *kept):
    """Write a kernel under another name with correct hashes; some parts of it keep the old name."""

    def changed(text, what):
        return text if what in kept else text.replace(files.name, name).replace(files.name.upper(), name.upper())

    banner, code = files.read(".c").split("*/", 1)
    (folder / f"{name}.c").write_text(f"{changed(banner, 'banner')}*/{changed(code, 'code')}", encoding="utf-8")
    (folder / f"{name}.h").write_text(changed(files.read(".h"), "header"), encoding="utf-8")
    data = json.loads(changed(json.dumps(files.data), "certificate"))
    data |= {"kernel": name, "regenerate": changed(files.data["regenerate"], "command")}
    data["files"] |= {
        f"{name}{end}": sha256((folder / f"{name}{end}").read_bytes()).hexdigest() for end in (".c", ".h")
    }
    path = folder / f"{name}.cert.json"
    path.write_text(certificate_json(data), encoding="utf-8")
    return path


@pytest.mark.parametrize("kept", ["banner", "code", "header", "command", "certificate", ("banner", "command")])
def test_a_kernel_that_keeps_its_name_anywhere_is_not_renamed(forgery, tmp_path, kept):
    """If all files agree on a wrong name, only the audit can refuse, because it knows the kernel of that name."""
    files = forgery(TOP)
    files.path = renamed(files, "light_top", tmp_path, *([kept] if isinstance(kept, str) else kept))
    assert files.refusal()


def test_a_formula_and_a_text_that_are_wrong_alike_break_a_law(forgery):
    """Formulas alone do not prove anything about mechanics; the law does."""
    files = forgery(TOP)
    for text in ("q0*q1 + q2*q3",) * 4:
        for behind in (f"void symrot_{TOP}(", BATCH, FLOAT, f"void symrot_{TOP}f_batch("):
            if text in files.read(".c")[files.read(".c").index(behind) :]:
                files.edit(text, "q0*q1 - q2*q3", behind)
    named = files.data["spec"]["named"]
    assert ["half_vertical_2", "q0*q1 + q2*q3"] in named
    named[named.index(["half_vertical_2", "q0*q1 + q2*q3"])][1] = "q0*q1 - q2*q3"
    files.seal()
    assert "the law 'I domega/dt + omega x I omega is the torque' does not follow" in files.refusal()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("#endif\n\n#ifdef __cplusplus", "#endif\n#define q1 q2\n#ifdef __cplusplus"), ("void symrot_heavy_top(", "int symrot_heavy_top("),
        ("#ifdef __cplusplus\n}", "void symrot_heavy_top_other(void);\n#ifdef __cplusplus\n}"), ("double W, ", "double V, "),
        ("#include <stddef.h>", "#include <stddef.h>\n#include <other.h>"), ("restrict\n", "restrict const\n"),
    ],
    ids=["macro", "result", "prototype", "name", "include", "restrict"],
)  # fmt: skip
def test_a_forged_header_is_refused(forgery, old, new):
    files = forgery(TOP)
    files.edit(old, new, "#ifndef", ".h")
    files.seal()
    assert files.refusal().startswith("heavy_top.h holds more than prototypes: expected")


def test_a_series_that_differs_from_its_function_for_negative_numbers_is_refused(forgery):
    files = forgery(VECTOR)
    (function,) = (each for each in files.data["spec"]["functions"] if each[0] == "tangent_gap")
    function[1] += " + Abs(x) - x"
    text = re.sub(r"(/x - (?:symrot_)?cos(f?)\(x\)\)/x/x)", r"\1 + fabs\2(x) - x", files.read(".c"))
    files.write(".c", text)
    files.seal()
    assert "series of 'tangent_gap'" in files.refusal()


def test_the_program_ends_with_one_line_and_exit_code_one(forgery, capsys):
    files = forgery(TOP)
    files.seal()
    recheck.main([str(files.path)])
    assert capsys.readouterr().out == f"{recheck.check(files.path)}\n"
    files.write(".c", files.read(".c") + " ")
    with pytest.raises(SystemExit) as ended:
        recheck.main([str(files.path)])
    assert ended.value.code == f"{files.path}: {files.refusal()}"
    with pytest.raises(SystemExit) as ended:
        recheck.main([])
    assert ended.value.code == "usage: python recheck.py NAME.cert.json .."
