"""Certify, audit and bound from Python: the results equal those of the commands, and wrong arguments raise errors."""

import dataclasses
import json

import pytest

import symrot
from symrot.cli.main import main

KERNEL = "euler_zxz_body_rates"


def test_a_mapping_and_texts_name_the_same_box():
    bounds = symrot.bound(KERNEL, {"theta": (1, "3/2")})
    assert bounds == symrot.bound(KERNEL, ["theta=1:3/2"]) and bounds.box["angles[1]"] == (1.0, 1.5)
    assert 0.0 < bounds.largest < symrot.bound(KERNEL, {"theta": (0.5, 1.5)}).largest


def test_the_command_prints_the_result(capsys):
    assert main(["bound", KERNEL, "--box", "theta=1:2"]) == 0
    assert capsys.readouterr().out == f"{symrot.bound(KERNEL, {'theta': (1, 2)})}\n"
    assert main(["bound", KERNEL, "--box", "theta=1:2", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == symrot.bound(KERNEL, {"theta": (1, 2)}).data


def test_an_edited_kernel_fails_its_audit(tmp_path):
    certificate = symrot.certify(KERNEL, directory=tmp_path)
    path = tmp_path / f"{KERNEL}.cert.json"
    assert path in certificate.files and symrot.audit(path).statements[str(path)]
    source = tmp_path / f"{KERNEL}.c"
    source.write_text(source.read_text().replace("sin(", "cos(", 1))
    with pytest.raises(symrot.CertificateError):
        symrot.audit(path)


def test_results_are_frozen():
    bounds = symrot.bound(KERNEL, {"theta": (1, 2)})
    with pytest.raises(dataclasses.FrozenInstanceError):
        bounds.kernel = "another"


@pytest.mark.parametrize("box", ["theta=1:2", {"theta": 1}, {"theta": (1, 2, 3)}, {"theta": (2, 1)}, {"eta": (1, 2)},
                                 {"theta": (float("nan"), 1)}, [3], None])  # fmt: skip
def test_a_box_that_cannot_be_used_is_an_input_error(box):
    with pytest.raises(symrot.InputError, match="box"):
        symrot.bound(KERNEL, box)


def test_wrong_precision_and_missing_paths_are_input_errors():
    with pytest.raises(symrot.InputError, match="precision: expected one of double, float, got 'quad'"):
        symrot.bound(KERNEL, precision="quad")
    with pytest.raises(symrot.InputError, match="path of a certificate"):
        symrot.audit()
