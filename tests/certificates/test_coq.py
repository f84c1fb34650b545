"""Coq theorems: printed from the derived formulas, complete and deterministic; Coq accepts true ones and refuses wrong
ones.
"""

import json
import os
import re
import subprocess
import sys

import pytest
from sympy import atan2, expand, sympify

from symrot import symbols
from symrot.certificates.coq import check as coq_check
from symrot.certificates.coq.check import check_texts, coqc, unproven
from symrot.certificates.coq.library import (
    STANDARD_AXIOMS,
    coq_file,
    coq_file_names,
    coq_section,
    coq_texts,
    rules_text,
)
from symrot.certificates.coq.text import coq_expression
from symrot.cli import main as cli
from symrot.conventions import SEQUENCES
from symrot.errors import CertificateError, InputError
from symrot.kernels.euler import prefix
from symrot.kernels.library import definition, kernel_names

needs_coq = pytest.mark.skipif(coqc() is None, reason="no coqc (Debian package coq)")
KINDS = ("dcm", "body_jacobian", "space_jacobian", "body_rates", "space_rates", "quaternion")


def theorems():
    return [(name, theorem) for name in coq_file_names() for theorem in coq_file(name).theorems]


def test_every_sequence_has_its_theorems_in_both_frames():
    names = [theorem.name for _, theorem in theorems()]
    expected = {f"{prefix(sequence)}_{kind}" for sequence in SEQUENCES for kind in KINDS}
    assert len(expected) == 24 * len(KINDS)
    assert len([name for name in expected if name.endswith("_jacobian")]) == 48
    assert expected <= set(names)
    assert len(set(names)) == len(names)


def test_a_theorem_about_a_kernel_has_the_name_of_the_kernel():
    about = {theorem.name for _, theorem in theorems() if theorem.kernel}
    assert about <= set(kernel_names())
    assert all(coq_section(name)["theorem"] == name for name in sorted(about)[::10])


def test_the_text_is_the_same_in_every_process():
    names = ("euler_zxz", "euler_extrinsic_zyx", "quaternions")
    code = f"from symrot.certificates.coq.library import coq_file; print(*(coq_file(name).digest for name in {names}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                          env=os.environ | {"PYTHONHASHSEED": "12345"})  # fmt: skip
    assert done.stdout.split() == [coq_file(name).digest for name in names]


def test_nothing_is_assumed_or_skipped_in_the_sources():
    for name, text in coq_texts().items():
        assert unproven(text) == (), name
        assert text.isascii()
        assert max(map(len, text.splitlines())) <= 120, name
        assert text.count("\nProof.") == text.count("Qed."), name


@pytest.mark.parametrize(
    "text",
    ("Admitted.", "  admit.", "Axiom a : False.", "Parameter p : R.", "Hypothesis h : 0 = 1.", "Unset Guard Checking."),
)
def test_what_assumes_is_seen_but_not_in_comments(text):
    assert unproven(f"Lemma a : True.\n{text}\n")
    assert unproven(f"(* {text} *)") == ()


def read_back(text, names):
    """Return the SymPy expression of a Coq text over R, in which application binds more tightly than any operation."""
    text = re.sub(r"\b(sin|cos|sqrt) (\w+)", r"\1(\2)", text).replace("^", "**")
    return sympify(text, locals={str(symbol): symbol for symbol in names})


@pytest.mark.parametrize(
    "kernel", ("euler_zyz_dcm", "euler_extrinsic_xyz_quaternion", "quaternion_dcm", "mrp_dcm", "rodrigues_quaternion")
)
def test_a_formula_is_printed_as_it_is(kernel):
    for _, formula in definition(kernel).formulas:
        assert expand(read_back(coq_expression(formula), formula.free_symbols) - formula) == 0


def test_a_function_that_coq_is_not_told_about_is_refused():
    with pytest.raises(CertificateError, match="sums, products, quotients"):
        coq_expression(atan2(symbols.q0, symbols.q1))
    with pytest.raises(CertificateError, match="integer power"):
        coq_expression(symbols.A ** sympify("1/3"))


def test_the_section_of_a_certificate_says_which_statement():
    section = coq_section("euler_zxz_body_rates")
    assert section["file"] == "euler_zxz.v"
    assert section["statement"] in coq_file("euler_zxz").text
    assert set(section["requires"]) == {"rotation.v"}
    assert tuple(section["axioms"]) == STANDARD_AXIOMS
    assert json.loads(json.dumps(section)) == section
    assert coq_section("inertia_box") is None
    assert coq_section("nothing") is None
    with pytest.raises(InputError, match="file of theorems"):
        coq_file("nothing")


def test_only_the_axioms_of_the_real_numbers_are_known():
    printed = "Axioms:\nClassicalDedekindReals.sig_forall_dec\n  : forall P : nat -> Prop, P\nwrong.trust_me : False\n"
    assert coq_check._axioms(printed) == ("ClassicalDedekindReals.sig_forall_dec", "wrong.trust_me")
    assert coq_check._axioms("Closed under the global context\n") == ()


def replaced(text, old, new):
    assert old in text
    return text.replace(old, new, 1)


@needs_coq
def test_a_wrong_theorem_is_refused():
    """Coq accepts the theorem before a wrong sign, refuses the wrong one, and refuses a theorem without proof."""
    rules = "Require Import Reals.\nOpen Scope R_scope.\n"
    theorem = "Theorem {} : forall x y : R, (x {} y)^2 = x^2 + 2*x*y + y^2.\nProof. intros; ring. Qed.\n"
    texts = {"squares.v": rules + theorem.format("sum", "+") + theorem.format("flipped", "-") + theorem.format("last", "+"),
             "skipped.v": "Theorem skipped : 0 = 1.\nProof.\nAdmitted.\n"}  # fmt: skip
    result = check_texts(texts)
    outcome = {each.name: each.outcome for each in result.theorems if each.file == "squares.v"}
    assert outcome == {"sum": "ok", "flipped": "refused", "last": "not reached"}
    assert {problem.split(":")[0] for problem in result.problems} >= set(texts)
    assert any("Admitted" in problem for problem in result.problems)
    assert not result


@needs_coq
@pytest.mark.campaign
@pytest.mark.parametrize(
    ("wrong", "old", "new", "proven", "refused"),
    [
        ("flipped", "(sin theta * cos psi) (- sin psi) 0", "(sin theta * cos psi) (sin psi) 0", "dcm", "body_jacobian"),
        ("swapped", "(sin phi * sin theta)", "(cos phi * sin theta)", None, "dcm"),
        ("doubled", "omega_1 * cos psi", "2 * omega_1 * cos psi", "body_jacobian", "body_rates"),
    ],
)  # fmt: skip
def test_wrong_formulas_are_refused(wrong, old, new, proven, refused):
    """Coq refuses a flipped sign, sine for cosine and a wrong factor in the file of ZXZ, and a theorem without proof."""
    texts = coq_texts(("euler_zxz",))
    texts = {"rotation.v": texts["rotation.v"], f"{wrong}.v": replaced(texts["euler_zxz.v"], old, new)}
    texts["skipped.v"] = "Theorem skipped : 0 = 1.\nProof.\nAdmitted.\n"
    result = check_texts(texts)
    outcome = {(each.file, each.name.removeprefix("euler_zxz_")): each.outcome for each in result.theorems}
    assert outcome[f"{wrong}.v", refused] == "refused"
    assert proven is None or outcome[f"{wrong}.v", proven] == "ok"
    assert outcome[f"{wrong}.v", "quaternion"] == "not reached"
    assert {problem.split(":")[0] for problem in result.problems} >= {f"{wrong}.v", "skipped.v"}
    assert any("Admitted" in problem for problem in result.problems)
    assert not result


@needs_coq
@pytest.mark.campaign
@pytest.mark.parametrize("name", ["quaternions", "rodrigues", "mrp", "euler_zxz"])
def test_true_theorems_hold(name):
    result = check_texts(coq_texts((name,)))
    assert result and {each.outcome for each in result.theorems} == {"ok"}
    assert result.axioms
    assert set(result.axioms) <= set(STANDARD_AXIOMS)


def test_without_coq_the_files_are_written_and_said_to_be_unchecked(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("COQC", "no-such-coqc")
    assert cli.main(["prove", "--coq", str(tmp_path / "a")]) == 0
    assert "not checked: coqc is not on the path" in capsys.readouterr().out
    assert (tmp_path / "a" / "rotation.v").read_text() == rules_text()
    assert len(list((tmp_path / "a").glob("*.v"))) == len(coq_file_names()) + 2
    assert cli.main(["prove", "--coq", str(tmp_path / "b"), "--check"]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert not (tmp_path / "b").exists()
    with pytest.raises(CertificateError, match="expected Coq's compiler"):
        check_texts({})
