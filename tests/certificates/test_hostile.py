"""Forged certificates with correct hashes and seals: `audit`, `certify` and ``recheck.py`` refuse each in one sentence."""

import copy
import json
import random
import shutil
from hashlib import sha256
from pathlib import Path

import pytest

import symrot
from symrot.certificates import recheck
from symrot.certificates.audit import load_certificate
from symrot.certificates.certificate import certificate_json
from symrot.cli import main as cli
from symrot.errors import CertificateError

KERNELS = Path(symrot.__file__).parents[1] / "generated" / "c"
PAIRS = [
    ("rodrigues_space_rates", "quaternion_of_dcm"), ("inertia_triangular_prism", "euler_extrinsic_xyz_of_quaternion"),
    ("euler_yxz_body_rates", "inertia_triangular_plate"), ("mrp_shadow", "euler_extrinsic_yzx_space_jacobian"),
    ("rodrigues_dcm", "euler_xyz_dcm"), ("euler_xzx_space_rates", "euler_zxz_dcm"), ("quaternion_dcm", "torque_gravity"),
]  # fmt: skip
STRANGE = [
    None, True, 0, -1, 1e308, "", "x", "1/0", "9" * 5000, "1e400", "pi", "(", "x**99999", "(" * 200, "-" * 3000 + "1",
    "sin(" * 400 + "x" + ")" * 400, [], [1], [None] * 3, {}, {"a": 1}, "0x1p0", "inf", [["a"]], "\u0435", "../../x",
    "float", "'", "\\", "x[0]", 10**50, 1.5, "sqrt(-1)", "1/(x-x)", "atan2(0,0)", "lambda: 0", "x if 1 else 2", "f(*x)",
    "1j", "x < y", "sin()", "Abs(x, x)",
]  # fmt: skip


def renamed(old, new, folder):
    """Write the files of a kernel under another kernel's name, with correct hashes; return the certificate."""

    def changed(text):
        return text.replace(old, new).replace(old.upper(), new.upper())

    data = json.loads(changed((KERNELS / f"{old}.cert.json").read_text(encoding="utf-8")))
    shutil.copy(KERNELS / "symrot_math.h", folder)
    for end in (".c", ".h"):
        text = changed((KERNELS / f"{old}{end}").read_text(encoding="utf-8"))
        (folder / f"{new}{end}").write_text(text, encoding="utf-8")
        data["files"][f"{new}{end}"] = sha256(text.encode()).hexdigest()
    path = folder / f"{new}.cert.json"
    path.write_text(certificate_json(data), encoding="utf-8")
    return path


@pytest.mark.parametrize(("old", "new"), PAIRS)
def test_a_kernel_under_the_name_of_another_one_is_refused(old, new, tmp_path, capsys):
    path = renamed(old, new, tmp_path)
    assert cli.main(["audit", str(path)]) == 1
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith(f"symrot: {path}: expected ") and said.err.count("\n") == 1


def places(node, place=()):
    """Yield the path to every value in a certificate."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield (*place, key)
        yield from places(value, (*place, key))


def changed_somewhere(data, chance):
    """Return a certificate in which one random value is removed, doubled or replaced by a strange value."""
    data = copy.deepcopy(data)
    part = chance.choice([key for key in data if key != "seal"])
    *way, key = chance.choice([place for place in places(data) if place[0] == part])
    node = data
    for each in way:
        node = node[each]
    kind = chance.choice(["gone", "twice", "elsewhere", "strange", "strange"])
    if kind == "gone":
        node.pop(key)
    elif kind == "twice" and isinstance(node, list):
        node.append(copy.deepcopy(node[key]))
    elif kind == "elsewhere":
        other = data
        for each in chance.choice(list(places(data))):
            other = other[each]
        node[key] = copy.deepcopy(other)
    else:
        node[key] = copy.deepcopy(chance.choice(STRANGE))
    return data


@pytest.mark.thinned(2)
@pytest.mark.parametrize(("seed", "count"), [("", 6), pytest.param("more", 200, marks=pytest.mark.campaign)])
@pytest.mark.parametrize(
    "name",
    [
        "quaternion_of_dcm",
        "euler_zyx_body_rates",
        "rotation_vector_body_rates",
        "mrp_shadow",
        "scenes/heavy_top_loops_rates",
    ],
)
def test_a_strange_value_anywhere_in_a_certificate_gets_one_sentence(name, seed, count, tmp_path, capsys):
    """No other exception leaves the audit, certify or ``recheck.py``."""
    source = KERNELS / f"{name}.cert.json"
    chance, data = random.Random(name + seed), json.loads(source.read_text(encoding="utf-8"))
    for file in (
        source.with_suffix("").with_suffix(".c"),
        source.with_suffix("").with_suffix(".h"),
        KERNELS / "symrot_math.h",
    ):
        shutil.copy(file, tmp_path)
    path = tmp_path / source.name
    refused = 0
    for _ in range(count):
        path.write_text(certificate_json(changed_somewhere(data, chance)), encoding="utf-8")
        words = chance.choice([["audit"], ["audit"], ["audit", "--rerun-bounds"], ["certify", "--no-bounds"]])
        code = cli.main([*words, str(path)])
        said = capsys.readouterr()
        assert code in (0, 1, 2) and said.err.count("\n") == (code != 0) and len(said.err) < 3000, said.err
        refused += code != 0
        try:
            recheck.check(path)
        except Exception as reason:
            assert "\n" not in str(reason)
    assert refused > 0.75 * count


def test_a_section_of_another_type_is_named_with_the_expected_one(tmp_path):
    """This holds for every section; null is accepted only in sections that may be null."""
    data = json.loads((KERNELS / "mrp_shadow.cert.json").read_text(encoding="utf-8"))
    path = tmp_path / "mrp_shadow.cert.json"
    for name in data:
        for strange in (7, None):
            if strange is None and name in ("coq", "rounding", "objects"):
                continue
            path.write_text(json.dumps({**data, name: strange}), encoding="utf-8")
            with pytest.raises(
                CertificateError, match=f"expected '{name}' to be of type .*, got {type(strange).__name__}"
            ):
                load_certificate(path)


def test_a_file_name_that_no_folder_can_hold_is_refused(tmp_path):
    path = renamed("quaternion_dcm", "quaternion_other", tmp_path)
    data = json.loads(path.read_text(encoding="utf-8"))
    data["files"]["x" * 400] = "0" * 64
    path.write_text(certificate_json(data), encoding="utf-8")
    with pytest.raises(CertificateError):
        symrot.audit(path)


def test_a_name_that_many_others_precede_is_refused_at_once(tmp_path):
    """The search for the repeated name went through all earlier names for each name, for minutes."""
    names = [f'"n{k}": 0' for k in range(200_000)]
    path = tmp_path / "long.cert.json"
    path.write_text("{" + ", ".join([*names, names[-1]]) + "}")
    with pytest.raises(CertificateError, match="expected each name at most once in a JSON object, got 'n199999' twice"):
        load_certificate(path)
