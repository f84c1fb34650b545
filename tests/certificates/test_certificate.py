"""Certificates: their statements are proven, checked again without symrot, and audited; any change is refused."""

import ast
import json
import math
import os
import re
import shutil
import subprocess
import sys
from decimal import Context, Decimal, localcontext
from hashlib import sha256
from pathlib import Path
from random import Random

import pytest
from mpmath import mp

from symrot.certificates import exact_check, recheck
from symrot.certificates.audit import audit
from symrot.certificates.certificate import certificate_json, certificate_text, with_sections
from symrot.certificates.laws.laws import prove_law
from symrot.certificates.readback.header import check_header
from symrot.cli.main import main
from symrot.errors import CertificateError
from symrot.kernels.definition import Law
from symrot.kernels.library import definition, kernel_names
from symrot.scene.file import names_with_kernels
from symrot.symbols import constant
from symrot.workshop import certify as certificates
from symrot.workshop.emit import emit
from symrot.workshop.kernel_text import kernel_text
from tests.campaigns.certificates.claims import is_weaker_or_equal, same_but_for_bounds
from tests.campaigns.certificates.mutations import Files, corrupted_c, printed_certificate, tampered_certificates

SLICE = ("quaternion_dcm", "quaternion_of_dcm", "euler_zyx_body_rates", "euler_zxz_of_quaternion", "mrp_shadow",
         "rotation_vector_body_rates", "rotation_vector_of_quaternion", "torque_gravity", "gravity_gradient_satellite")  # fmt: skip
RECHECK = Path(recheck.__file__)


@pytest.fixture(scope="module")
def kernels(tmp_path_factory):
    """Write some kernels and their certificates into a folder."""
    directory = tmp_path_factory.mktemp("kernels")
    return {name: Files(directory, kernel_text(name).under_test(), printed_certificate(name)) for name in SLICE}


def resealed(files, **changes):
    files.path.write_text(certificate_json(files.data | changes), encoding="utf-8")


@pytest.fixture
def dcm(kernels):
    files = kernels["quaternion_dcm"]
    yield files
    files.restore()


def refused(files, said, *options):
    """Check that all checkers refuse the files, and that the audit's message contains ``said``."""
    with pytest.raises(Exception):  # noqa: B017 - whatever it is, it is a refusal
        recheck.check(files.path)
    with pytest.raises(exact_check.REFUSALS):
        exact_check.check(files.path)
    with pytest.raises(CertificateError, match=said) as caught:
        audit(files.path, lambda data: files.said)
    assert "\n" not in str(caught.value)


@pytest.mark.thinned(4)
@pytest.mark.parametrize("name", SLICE)
def test_a_certificate_holds_and_is_rechecked_without_symrot(kernels, name):
    files = kernels[name]
    assert files.accepted() == ["recheck", "exact", "audit"]
    assert emit(name).certificate == files.path.read_text(encoding="utf-8")
    bare = {part: value for part, value in files.data.items() if part != "rounding"}
    assert certificate_text(files.subject) == certificate_json(bare)
    assert ("rounding" in files.data) == (name in kernel_names())


def test_recheck_imports_nothing_of_symrot(kernels, tmp_path):
    """A copy of the program runs in a process without symrot or any other package."""
    shutil.copy(RECHECK, tmp_path)
    nodes = list(ast.walk(ast.parse(RECHECK.read_text(encoding="utf-8"))))
    modules = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    modules |= {node.module for node in nodes if isinstance(node, ast.ImportFrom)}
    assert modules <= sys.stdlib_module_names
    paths = [str(files.path) for files in kernels.values()]
    command = [sys.executable, "-I", "-S", str(tmp_path / "recheck.py"), *paths]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path.root)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("hold") == len(paths)
    kernels["quaternion_dcm"].path.write_text("{}", encoding="utf-8")
    done = subprocess.run([sys.executable, str(tmp_path / "recheck.py"), paths[0]], capture_output=True, text=True)
    kernels["quaternion_dcm"].restore()
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and "schema" in done.stderr


@pytest.mark.campaign
@pytest.mark.parametrize("name", (*kernel_names(), *names_with_kernels()))
def test_every_certificate_holds(name, tmp_path):
    assert Files(tmp_path, kernel_text(name).under_test(), emit(name).certificate).accepted() == [
        "recheck",
        "exact",
        "audit",
    ]


# --- laws -------------------------------------------------------------------------------------------------------------


def test_a_law_that_does_not_follow_is_refused():
    q = [constant(f"q{i}") for i in range(4)]
    norm = sum(each**2 for each in q) - 1
    formulas = dict(definition("quaternion_dcm").formulas)
    first = constant("R_11")
    wrong = Law("wrong", (first - 1 + 2 * q[2] ** 2 + 2 * q[3] ** 2 + q[0],), (norm,))
    with pytest.raises(CertificateError, match="'wrong' to follow"):
        prove_law("kernel", wrong, formulas)
    with pytest.raises(CertificateError, match="to follow"):  # without its hypothesis
        prove_law("kernel", Law("bare", (norm,)), {})
    assert prove_law("kernel", Law("given", (norm * q[0],), (norm,)), {}).cases[0].entries[0].cofactors == ((0, "q0"),)


@pytest.mark.parametrize("name", ["euler_equations_principal", "torque_rotor", "mrp_of_quaternion"])
def test_laws_are_proven_in_every_case(name):
    kernel = definition(name)
    formulas = {str(symbol): value for symbol, value in kernel.named} | dict(kernel.formulas)
    for law in kernel.laws():
        proof = prove_law(name, law, formulas)
        assert exact_check.complete([[list(choice) for choice in case.case] for case in proof.cases])
        assert len(proof.cases) == (2 if name == "mrp_of_quaternion" else 1)


def test_a_proof_by_what_vanishes_itself_is_refused(dcm):
    """Any expression times a relation is a multiple of the relation, so factors and cofactors must not hide a relation."""
    norm = "q0**2 + q1**2 + q2**2 + q3**2 - 1"
    (law,) = [law for law in dcm.data["laws"] if law["given"]][:1]
    forgeries = (
        {"entries": [[norm, [[0, "q0"]]]]}, {"entries": [["1", [[0, f"q0/({norm})"]]]]},
        {"entries": [["g0_**2", [[0, "q0"], [1, "q0"]]]], "steps": [["name", "g0_", f"sqrt({norm})"], ["root", norm]],
         "relations": [norm, f"g0_**2 - ({norm})"]},
    )  # fmt: skip
    for forgery in ({"entries": [["1", [[0, "q0"]]]]}, *forgeries):
        case = {"case": [], "steps": [], "relations": [norm]} | forgery
        wrong = law | {"law": "q0 vanishes", "vanishing": ["q0"], "cases": [case]}
        resealed(dcm, laws=[*dcm.data["laws"], wrong])
        refused(dcm, "expected the law 'q0 vanishes' to follow|division|cofactor|schema")
    right = law | {"vanishing": [f"q0*({norm})"], "cases": [
        {"case": [], "steps": [], "relations": [norm], "entries": [["1", [[0, "q0"]]]]}]}  # fmt: skip
    resealed(dcm, laws=[*dcm.data["laws"], right])
    recheck.check(dcm.path)
    exact_check.check(dcm.path)
    resealed(dcm, laws=[right | {"witness": right["witness"] | {"q0": "1"}}])
    recheck.check(dcm.path)  # proofs are not what it looks at
    with pytest.raises(ValueError, match="witness"):
        exact_check.check(dcm.path)
    with pytest.raises(CertificateError, match="witness"):
        audit(dcm.path, lambda data: dcm.said)


def test_cases_that_are_missing_are_noticed():
    less, more = ["a", "<", "b"], ["a", ">=", "b"]
    assert exact_check.complete([[]]) and exact_check.complete([[less], [more]])
    assert exact_check.complete([[less], [more, ["c", "<", "d"]], [more, ["c", ">=", "d"]]])
    for cases in ([], [[less]], [[less], [less]], [[], []], [[less], [more], []], [[less], ["b", ">=", "a"]]):
        assert not exact_check.complete(cases)


# --- what is hostile --------------------------------------------------------------------------------------------------


def edit(files, name, old, new):
    path = files.directory / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_a_kernel_edited_by_hand_is_refused(dcm):
    edit(dcm, "quaternion_dcm.c", " - ", " + ")
    refused(dcm, "quaternion_dcm.c was changed after it was certified")


def test_a_header_with_a_macro_is_refused(dcm):
    source, header = (dcm.texts[f"quaternion_dcm{end}"] for end in (".c", ".h"))
    check_header(header, source, "quaternion_dcm")
    edit(dcm, "quaternion_dcm.h", "#include <stddef.h>", "#include <stddef.h>\n#define sin cos")
    refused(dcm, "quaternion_dcm.h was changed after it was certified")
    for old, new in (
        ("#include <stddef.h>", "#include <stddef.h>\n#define sin cos"), ("#include <stddef.h>", "#include <math.h>"),
        ("__restrict\n", "__restrict\n#define q p\n"), ("double dcm[9]);", "float dcm[9]);"),
        ("/* one sample */", "/* one sample */\n#define dcm cdm"), ("/* one sample */", "void more(double x);"),
        ("/* one sample */", "??=define sin cos"), ("\n#endif\n", "\n#define cos sin\n#endif\n"),
        ("/* one sample */", "/* */ \\"), ("const double q[4], ", "double q[4], "),
    ):  # fmt: skip
        assert old in header
        with pytest.raises(CertificateError, match=r"quaternion_dcm\.h"):
            check_header(header.replace(old, new, 1), source, "quaternion_dcm")


def test_the_span_of_a_batch_in_parts_is_a_number_that_headers_may_set():
    kernel = emit("rigid_body_tensor")
    source, header = kernel.source, kernel.header
    check_header(header, source, "rigid_body_tensor")
    assert "#define SYMROT_SPAN 2048" in header
    for other in ("0", "2048*n", "2048 ;"):
        with pytest.raises(CertificateError, match=r"rigid_body_tensor\.h"):
            check_header(header.replace("SYMROT_SPAN 2048", f"SYMROT_SPAN {other}"), source, "rigid_body_tensor")


def test_a_certificate_of_another_file_is_refused(kernels, dcm):
    other = kernels["mrp_shadow"]
    dcm.path.write_text(other.path.read_text(encoding="utf-8"), encoding="utf-8")
    refused(dcm, "belongs to another file")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "as JSON"), (b'{"schema": "symrot.certificate/1", "kernel', "as JSON"), (b"[]", "a JSON object"),
        (b"{}", "'schema' in a certificate"), (b"\xff\xfe\x00", "as JSON"), (b"[" * 100000, "as JSON"),
        (b'{"schema": 1, "schema": 2}', "twice"), (b'{"schema": NaN}', "NaN"), (b'{"schema": 1e999}', "'schema'"),
        (b'{"schema": ' + b"9" * 5000 + b"}", "as JSON"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_certificate_is_refused(dcm, content, said):
    dcm.path.write_bytes(content)
    refused(dcm, said)


def test_wrong_schemas_missing_parts_and_huge_numbers_are_refused(dcm):
    resealed(dcm, schema="symrot.certificate/2")
    refused(dcm, "schema")
    dcm.path.write_text(certificate_json({k: v for k, v in dcm.data.items() if k != "laws"}), encoding="utf-8")
    refused(dcm, "'laws'")
    spec = dcm.data["spec"]
    for text in ("q0**99999999999", "1/0", "9" * 5000, "(" * 3000 + "q0" + ")" * 3000, "__import__('os')", "q0.real"):
        formulas = [[spec["formulas"][0][0], spec["formulas"][0][1], text], *spec["formulas"][1:]]
        resealed(dcm, spec=spec | {"formulas": formulas})
        refused(dcm, "expected|formula|power|division|schema|digits")
    resealed(dcm, title="direction cosine matrix of any quaternion")
    with pytest.raises(CertificateError, match="'title' as symrot prints"):
        audit(dcm.path, lambda data: dcm.said)
    dcm.path.write_text(json.dumps(dcm.data), encoding="utf-8")
    with pytest.raises(CertificateError, match="another layout"):
        audit(dcm.path, lambda data: dcm.said)


COUNTS = [24, pytest.param(300, marks=pytest.mark.campaign)]


@pytest.mark.parametrize("count", COUNTS)
def test_corrupted_c_files_are_refused(kernels, count):
    """The hash of the file is corrected and the certificate sealed again, so only the meaning of the C text can refuse
    it.
    """
    campaign = corrupted_c(list(kernels.values()), count, Random(2))
    assert campaign.survivors == []
    assert campaign.same.total() < count / 10 and len(campaign.tried) > 9


@pytest.mark.parametrize("count", [8, COUNTS[1]])
def test_tampered_certificates_are_refused(kernels, count):
    assert tampered_certificates(list(kernels.values()), count, Random(12), sealed=False).survivors == []
    campaign = tampered_certificates(list(kernels.values()), count // 2, Random(13), sealed=True)
    assert campaign.survivors == []
    assert campaign.words and campaign.proofs < campaign.words.total()


@pytest.mark.skipif(not shutil.which("cc"), reason="needs a C compiler")
def test_what_computes_the_same_bits(kernels):
    """The text computes -x instead of x where only the square of x is used."""
    files, draw = kernels["rotation_vector_body_rates"], Random(3)
    for text in (files.source.replace(" + ", " - ", 1), files.source.replace("0.5*", "0.25*", 1), "void f(void) {"):
        assert not files.same_bits(text, draw)
    assert files.same_bits(files.source.replace("v1*v1", "(-v1)*(-v1)"), draw) and files.same_bits(files.source, draw)


def test_what_claims_the_same(kernels):
    """The campaigns accept a changed certificate only if it states the same: a law times -1, or a weaker law."""
    files = kernels["torque_gravity"]
    data, spec, (law, *laws) = files.data, files.data["spec"], files.data["laws"]
    text = law["vanishing"][0]

    def with_law(**changes):
        return data | {"laws": [law | changes, *laws]}

    assert is_weaker_or_equal(data, data | {"title": "of any torque", "laws": data["laws"][:1]})
    for true in (f"-({text})", f"7*({text})", f"weight*({text})"):
        assert is_weaker_or_equal(data, with_law(vanishing=[true])), true
    place, symbol, formula = spec["formulas"][0]
    for other in (
        with_law(vanishing=[f"{text} + weight"]), with_law(vanishing=["weight"]), with_law(vanishing=[7]),
        data | {"inputs": [["more", "more", ""], *data["inputs"]]}, data | {"files": {}, "laws": [{}]},
        data | {"spec": spec | {"formulas": [[place, symbol, f"2*({formula})"], *spec["formulas"][1:]]}},
    ):  # fmt: skip
        assert not is_weaker_or_equal(data, other)
    assert same_but_for_bounds(data, data, *files.operations)
    assert not same_but_for_bounds(data, data | {"domain": "all"}, *files.operations)
    assert not same_but_for_bounds(data, data | {"rounding": None}, *files.operations)


def test_arguments_that_a_kernel_does_not_take_are_refused(kernels):
    """Even inputs that no formula uses must be arguments of the kernel, and parameters must be inputs."""
    files = kernels["euler_zyx_body_rates"]
    (first, *described), *inputs = files.data["inputs"]
    assert first == "angles[0]"
    for place in ("angles[0]0", "angles[7]", "angles[00]", "angles", "angles[1]"):
        resealed(files, inputs=[[place, *described], *inputs])
        refused(files, "argument|two inputs|of")
    resealed(files, spec=files.data["spec"] | {"parameters": {"other": 1}})
    refused(files, "the same parameters")
    files.restore()


@pytest.mark.parametrize(("name", "term", "huge"), [
    ("quaternion_dcm", r"2.0\*q1", "1e20"), ("quaternion_dcm", r"2.0\*q1", "4096.0"),
    ("euler_zyx_body_rates", r"omega\[2\]", "1e20"), ("rotation_vector_body_jacobian", r"v\[2\]", "1e9"),
])  # fmt: skip
def test_recheck_refuses_a_text_that_rounds_more_than_it_says(name, term, huge, tmp_path):
    """``(x + 1e20) - 1e20`` is x in exact arithmetic, but nearly always 0 in C."""
    files = Files(tmp_path, kernel_text(name).under_test(), emit(name).certificate)
    head = files.source.index("{\n", files.source.index(f"void symrot_{name}("))
    place = re.compile(term).search(files.source, head)
    text = f"{files.source[: place.start()]}(({place[0]} + {huge}) - {huge}){files.source[place.end() :]}"
    (files.directory / f"{name}.c").write_text(text, encoding="utf-8")
    hashes = files.data["files"] | {f"{name}.c": sha256(text.encode()).hexdigest()}
    files.path.write_text(certificate_json(files.data | {"files": hashes}), encoding="utf-8")
    with pytest.raises(ValueError, match=f"{name} has a larger rounding error than its bound"):
        recheck.check(files.path)
    bare = {key: value for key, value in files.data.items() if key != "rounding"}
    files.path.write_text(certificate_json(bare | {"files": hashes}), encoding="utf-8")
    assert recheck.check(files.path)  # who says nothing of rounding says nothing wrong


def test_recheck_refuses_functions_without_the_prefix_of_symrot(tmp_path):
    """A kernel that is consistent under other names is not a kernel of symrot."""
    name = "quaternion_dcm"
    files = Files(tmp_path, kernel_text(name).under_test(), emit(name).certificate)
    texts = {
        file: (files.directory / file).read_text(encoding="utf-8").replace(f"symrot_{name}", name)
        for file in (f"{name}.c", f"{name}.h")
    }
    for file, text in texts.items():
        (files.directory / file).write_text(text, encoding="utf-8")
    hashes = files.data["files"] | {file: sha256(text.encode()).hexdigest() for file, text in texts.items()}
    readback = {function.removeprefix("symrot_"): each for function, each in files.data["readback"].items()}
    files.path.write_text(certificate_json(files.data | {"files": hashes, "readback": readback}), encoding="utf-8")
    with pytest.raises(ValueError, match="another name or type: expected symrot_quaternion_dcm"):
        recheck.check(files.path)


def test_recheck_computes_as_c_does_in_float():
    """Each sum and product of floats is rounded: 2^24 + 1 is not a float."""
    floats, doubles = recheck.Machine(recheck.c_float), recheck.Machine(recheck.c_double)
    for machine, lost in ((floats, 1.0), (doubles, 0.0)):
        total = machine.operate("+", 16777216.0, 1.0)
        assert machine.operate("-", total, 16777216.0) == 1.0 - lost
    assert floats.operate("/", 1.0, 3.0) == recheck.c_float(1 / 3).value != 1 / 3 == doubles.operate("/", 1.0, 3.0)
    assert (
        floats.apply("sin", [1.0]) == recheck.c_float(math.sin(1)).value != doubles.apply("sin", [1.0]) == math.sin(1)
    )
    assert floats.apply("symrot_atan2", [1.0, -2.0]) == recheck.c_float(math.atan2(1, -2)).value
    assert floats.apply("fabs", [floats.negate(1.5)]) == 1.5 and math.isnan(floats.operate("/", 1.0, 0.0))


def test_bounds_are_those_of_their_box(kernels):
    """On a slightly larger box or another region, the bounds of the kernel's own box prove nothing."""
    files = kernels["quaternion_dcm"]
    bounds = files.data["rounding"]
    low, high = bounds["box"]["q[2]"]
    point = bounds["precisions"][1]
    for changes in (
        {"box": bounds["box"] | {"q[2]": [(float.fromhex(low) * 1.001).hex(), high]}},
        {"box": bounds["box"] | {"q[2]": [low.replace("0x", "0X"), high]}}, {"budget": bounds["budget"] - 1},
        {"unit_groups": [["q[0]", "q[1]", "q[2]", "q[4]"]]}, {"clearance": (0.5).hex()}, {"other": 1},
        {"precisions": [bounds["precisions"][0], point | {"other": 1}]},
        {"precisions": [bounds["precisions"][0], point | {"unit": point["unit"].replace("p", "P")}]},
        {"precisions": [bounds["precisions"][0], point | {"outputs": [
            each | {"converged": int(each["converged"])} for each in point["outputs"]]}]},
    ):  # fmt: skip
        resealed(files, rounding=bounds | changes)
        with pytest.raises(CertificateError, match="expected"):
            audit(files.path, lambda data: files.said)
        recheck.check(files.path)  # bounds are not what it looks at
    files.restore()


# --- commands ---------------------------------------------------------------------------------------------------------


def test_certify_and_audit(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["emit", "quaternion_product", "-o", "k"]) == 0
    assert sorted(path.name for path in Path("k").iterdir()) == [
        "quaternion_product.c", "quaternion_product.cert.json", "quaternion_product.h"]  # fmt: skip
    assert main(["certify", "quaternion_product", "-o", "k"]) == 0
    said = capsys.readouterr().out
    labels = {line.split("  ")[1].strip() for line in said.splitlines()[1:] if line.startswith("  ")}
    assert {"laws", "C text", "rounding"} <= labels and "-ffp-contract=off" in said
    kept = Path("k/quaternion_product.cert.json").read_text(encoding="utf-8")
    assert main(["emit", "quaternion_product", "-o", "k"]) == 0
    assert Path("k/quaternion_product.cert.json").read_text(encoding="utf-8") == kept  # bounds are kept
    assert main(["audit", "k/quaternion_product.cert.json", "--rerun-bounds"]) == 0
    assert "computed again" in capsys.readouterr().out
    assert main(["certify", "k/quaternion_product.c", "--no-bounds", "--json"]) == 0
    text = Path("k/quaternion_product.c").read_text(encoding="utf-8")
    Path("k/quaternion_product.c").write_text(text.replace(" - ", " + ", 1), encoding="utf-8")
    capsys.readouterr()
    assert main(["audit", "k/quaternion_product.cert.json"]) == 1
    assert main(["certify", "k/quaternion_product.c"]) == 2
    assert main(["audit", "k/nothing.cert.json"]) == 2
    assert main(["certify", "quaternion_produkt"]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 4 and "Traceback" not in said.err
    assert sorted(path.name for path in Path("k").iterdir()) == [
        "quaternion_product.c", "quaternion_product.cert.json", "quaternion_product.h"]  # fmt: skip


def test_certify_all(tmp_path, capsys, monkeypatch):
    """The table of proofs is made for one kernel and one scene; the files are those of `symrot certify KERNEL -o`."""
    monkeypatch.setattr(certificates, "kernel_names", lambda: ("quaternion_dcm",))
    monkeypatch.setattr(certificates, "names_with_kernels", lambda: ("heavy_top_loops",))
    for options in ([], ["-o", str(tmp_path)]):
        assert main(["certify", "--all", *options]) == 0
        lines = capsys.readouterr().out.splitlines()
        assert lines[0] == "quaternion_dcm   laws  Coq  C text  rounding  -----------"
        assert lines[1] == "heavy_top_loops  laws  ---  C text  --------  -----------"
        assert lines[2].endswith("2 of 2") and lines[6].endswith("0 of 2") and len(lines) == (13 if options else 7)
    assert recheck.check(tmp_path / "scenes" / "heavy_top_loops_rates.cert.json")
    for wrong in (["certify"], ["certify", "--all", "quaternion_dcm"], ["certify", "--all", "--box", "q0=0:1"]):
        assert main(wrong) == 2
    assert capsys.readouterr().err.count("\n") == 3


KERNELS = Path(__file__).parents[2] / "generated" / "c"


@pytest.mark.parametrize(
    "path",
    ["quaternion_dcm.c", "quaternion_dcm.cert.json", "scenes/t_handle_rates.c", "scenes/t_handle_rates.cert.json"],
)
def test_a_kernel_may_be_named_by_what_was_emitted_of_it(path, tmp_path, capsys):
    """An unchanged file stands for its kernel or shipped scene; an edited file is refused."""
    assert main(["certify", str(KERNELS / path)]) == 0
    assert f"{Path(path).name.partition('.')[0]}: " in capsys.readouterr().out
    for file in (KERNELS / path).parent.glob(f"{Path(path).name.partition('.')[0]}.*"):
        shutil.copy(file, tmp_path)
    edited = tmp_path / Path(path).name
    text = edited.read_text(encoding="utf-8")
    edited.write_text(text.replace("0.5", "0.25") if "0.5" in text else text.replace("2", "3", 1), encoding="utf-8")
    assert main(["certify", str(edited)]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.count("\n") == 1 and str(edited) in said.err


EDITS = {  # file, what is edited -> what takes its place, what is said of it
    "sign": (".c", "omega_2*cos_psi - sin_psi", "omega_2*cos_psi + sin_psi",
             "line 40 is 'dangles[1] = omega_2*cos_psi + sin_psi*omega_3;'", "expected dangles[1] to be omega_2*cos(psi) - omega"),
    "order": (".c", "omega_2*cos_psi - ", "cos_psi*omega_2 - ", "with other operations", "but symrot emits"),
    "arguments": (".c", "(const double angles[3], const double omega[3]", "(const double omega[3], const double angles[3]",
                  "is 'void symrot_euler_zyx_body_rates(const double omega[3], const double angles[3]", "but symrot emits"),
    "constant": (".c", "cos_theta;\n", "cos_theta*1.0000000000000002;\n", "1.0000000000000002", "but symrot emits"),
    "header": (".h", "double dangles[3]);", "double dangles[4]);", "double dangles[4]);'", "euler_zyx_body_rates.h was changed"),
    "more": (".h", "\n#endif\n", "\n#endif\n#define sin cos\n", "'#define sin cos', but symrot emits no such line", ".h was changed"),
    "ends": (".c", "\n", "\r\n", "its line endings differ", "was changed after it was certified"),
    "none": (".c", None, None, "expected its file euler_zyx_body_rates.c in the same folder", "but it is missing"),
}  # fmt: skip


@pytest.mark.parametrize("edit", EDITS)
def test_an_edited_file_is_refused_with_its_line_and_what_it_computes(edit, tmp_path, capsys):
    end, old, new, *said = EDITS[edit]
    for name in ("euler_zyx_body_rates.c", "euler_zyx_body_rates.h", "euler_zyx_body_rates.cert.json", "symrot_math.h"):
        shutil.copy(KERNELS / name, tmp_path)
    path = tmp_path / f"euler_zyx_body_rates{end}"
    if old is None:
        path.unlink()
    else:
        text = path.read_text(encoding="utf-8")
        at = text.rindex(old) if edit == "more" else text.index(old, text.index("*/"))
        changed = text.replace(old, new) if edit == "ends" else text[:at] + new + text[at + len(old) :]
        path.write_bytes(changed.encode())
    assert main(["audit", str(tmp_path / "euler_zyx_body_rates.cert.json")]) == 1
    found = capsys.readouterr()
    assert found.out == "" and found.err.count("\n") == 1
    assert all(each in found.err for each in said), found.err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["certify", "quaternion_to_dcm"], "did you mean 'quaternion_of_dcm'?"),
        (["certify", "mine.c"], "`symrot audit` takes the certificate of any kernel"),
        (["certify", "quaternion_dc.cert.json"], "did you mean 'quaternion_dcm'?"),
        (["certify", "nowhere/quaternion_dcm.c"], "a readable file of at most 16 MB, got No such file or directory"),
        (["bound", str(KERNELS / "quaternion_dcm.c")], "did you mean 'quaternion_dcm'?"),
        (["audit", "quaternion_dcm.c"], "certificate, quaternion_dcm.cert.json"),
    ],
    ids=lambda value: Path(value[1]).name if isinstance(value, list) else "",
)
def test_what_is_no_kernel_is_refused_in_one_sentence(arguments, said, capsys):
    assert main(arguments) in (1, 2)
    found = capsys.readouterr()
    assert found.out == "" and said in found.err and found.err.count("\n") == 1


def test_nothing_is_half_written(tmp_path, capsys):
    """If one file cannot be written, no other file is written."""
    (tmp_path / "quaternion_dcm.cert.json").mkdir()
    for command in ("certify", "emit"):
        assert main([command, "quaternion_dcm", "-o", str(tmp_path)]) == 2
        assert "cannot be written" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["quaternion_dcm.cert.json"]


def test_bounds_of_other_operations_are_not_kept():
    text = emit("quaternion_dcm").certificate
    found = {"precisions": [{"operations_sha256": "0"}, {"operations_sha256": "1"}]}
    assert with_sections(text, {"rounding": found, "objects": {"source": 1}}) == text
    digests = [each["digest"] for each in json.loads(text)["readback"].values()]
    found = {"precisions": [{"operations_sha256": digest} for digest in digests]}
    assert json.loads(with_sections(text, {"rounding": found}))["rounding"] == found


def test_certificates_are_the_same_bytes_whatever_the_seed_of_hashes():
    """A process with another hash seed and an empty cache prints the same certificate."""
    code = "import sys, symrot; print(*(symrot.emit(name).certificate for name in sys.argv[1:]), sep='')"
    names = ("euler_zyx_body_rates", "heavy_top_loops")
    seed = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"
    environment = {"PYTHONHASHSEED": seed, "SYMROT_CACHE": "/nowhere"}
    done = subprocess.run([sys.executable, "-c", code, *names], capture_output=True, check=True, env=environment)
    assert done.stdout.decode() == "".join(emit(name).certificate for name in names) + "\n"


@pytest.mark.parametrize("name", ["sin", "cos", "sqrt", "atan2", "sinc", "sine_gap", "tangent_gap", "arc_ratio", "pi"])
def test_recheck_evaluates_functions_to_what_mpmath_finds(name, kernels):
    """The values agree to 80 digits; laws need 60."""
    jacobian = json.loads(emit("rotation_vector_body_jacobian").certificate)
    defined = [
        each
        for data in (
            jacobian,
            kernels["rotation_vector_body_rates"].data,
            kernels["rotation_vector_of_quaternion"].data,
        )
        for each in data["spec"]["functions"]
    ]
    own = {
        "sinc": lambda x: mp.sin(x) / x, "sine_gap": lambda x: (x - mp.sin(x)) / x**3, "arc_ratio": lambda x, y: mp.atan2(x, y) / x,
        "tangent_gap": lambda x: (mp.sin(x) - x * mp.cos(x)) / x**3, "pi": lambda: mp.pi,
    }  # fmt: skip
    oracle = own.get(name) or getattr(mp, name)
    with localcontext(Context(prec=90)), mp.workdps(110):
        numbers, functions = recheck.Decimals(), recheck.defined_functions(dict(defined).items())
        scale = 30
        for x, y in ((Decimal("0.7301"), Decimal("-0.21")), (Decimal("0.013"), Decimal("0.9"))):
            arguments = [x * scale, y][: 2 if name in ("atan2", "arc_ratio") else name != "pi"]
            if name in functions:
                value = functions[name].call(numbers, arguments)
            else:
                value = numbers.apply(name, arguments) if arguments else recheck.Names(numbers)[name]
            expected = oracle(*(mp.mpf(str(each)) for each in arguments))
            assert abs(mp.mpf(str(value)) / expected - 1) < mp.mpf(10) ** -80


def test_a_rotation_that_recheck_draws_is_one():
    with localcontext(Context(prec=90)):
        names = [f"R_{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)]
        values = recheck.Names(recheck.Decimals())
        recheck.draw_hypothesis(names, values)
        rows = [*map(values.get, names)]
        a, b, c = (rows[start : start + 3] for start in (0, 3, 6))
        products = [sum(x * y for x, y in zip(p, q, strict=True)) for p in (a, b, c) for q in (a, b, c)]
        assert all(abs(each - (k % 4 == 0)) < Decimal("1e-85") for k, each in enumerate(products))
        assert all(abs(a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] - c[k]) < Decimal("1e-85") for k in range(3))


def test_javascript_with_other_operations_is_refused_although_its_hash_is_right(dcm):
    """The audit reads the JavaScript back; the two checkers that know no JavaScript compare its hash alone."""
    (file,) = (name for name in dcm.texts if name.endswith(".js"))
    text = dcm.texts[file].replace("q1*q2", "q1*q3", 1).replace("2.0*", "4.0*", 1)
    assert text != dcm.texts[file]
    (dcm.directory / file).write_text(text, encoding="utf-8")
    hashes = dcm.data["files"] | {file: sha256(text.encode()).hexdigest()}
    dcm.path.write_text(certificate_json(dcm.data | {"files": hashes}), encoding="utf-8")
    with pytest.raises(CertificateError, match="operations"):
        audit(dcm.path, lambda data: dcm.said)


def test_an_audit_says_that_javascript_was_compared(dcm):
    assert any(
        "performs the operations of the C text" in sentence for sentence in audit(dcm.path, lambda data: dcm.said)[1]
    )
