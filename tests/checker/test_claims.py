"""Files of claims: their allowed content, refusals, and the command that reads them."""

import json
import re
from collections import Counter
from pathlib import Path

import pytest

import symrot
from symrot.checker.interface import RefusedClaims
from symrot.cli.main import main
from symrot.errors import InputError

GOOD = """
schema = 1

[[claim]]
id = "body-rates-zxz"
where = "p. 17"
functions = ["phi", "theta", "psi"]
symbols = ["t"]
define = [
    ["R", "Rz(phi(t))*Rx(theta(t))*Rz(psi(t))"],
    ["w1", "diff(phi(t), t)*sin(theta(t))*sin(psi(t)) + diff(theta(t), t)*cos(psi(t))"],
    ["w2", "diff(phi(t), t)*sin(theta(t))*cos(psi(t)) - diff(theta(t), t)*sin(psi(t))"],
    ["w3", "diff(phi(t), t)*cos(theta(t)) + diff(psi(t), t)"],
    ["W", "skew(w1, w2, w3)"],
]
claim = "diff(R, t) == R*W"

[[claim]]
id = "unit"
symbols = ["q0", "q1", "q2", "q3"]
define = [["R", "dcm_of(Matrix([q0, q1, q2, q3]))"]]
given = ["q0**2 + q1**2 + q2**2 + q3**2 == 1"]
claim = "R*R.T == eye(3)"

[[claim]]
id = "lagrange"
symbols = ["t", "m", "g", "l"]
functions = ["theta"]
define = [["L", "m*l**2*diff(theta(t), t)**2/2 + m*g*l*cos(theta(t))"]]
claim = "diff(diff(L, diff(theta(t), t)), t) - diff(L, theta(t)) == m*l**2*diff(theta(t), t, t) + m*g*l*sin(theta(t))"

[[claim]]
id = "worked"
value = "2*pi*sqrt(2)/3"
printed_value = "2.96"
"""


def write(tmp_path, text):
    path = tmp_path / "claims.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_of_true_claims_is_true_throughout(tmp_path):
    verdicts = symrot.check_file(write(tmp_path, GOOD))
    assert [(v.id, v.verdict) for v in verdicts] == [
        (name, "true") for name in ("body-rates-zxz", "unit", "lagrange", "worked")
    ]
    assert verdicts[0].where == "p. 17"
    assert all(verdict.seconds > 0 for verdict in verdicts)


@pytest.mark.parametrize(("printed", "verdict"), [
    ("2.96", "true"), ("2.962", "true"), ("2.9619", "true"), ("2.9620", "false"), ("3", "true"), ("3.0", "true"),
    ("2.97", "false"), ("-2.96", "false"), ("296e-2", "true"), ("0.296e1", "true"),
])  # fmt: skip
def test_a_printed_number_is_right_when_the_value_rounds_to_it(tmp_path, printed, verdict):
    """The example is 2 pi sqrt(2)/3 = 2.96192..."""
    (last,) = symrot.check_file(write(tmp_path, GOOD.replace('"2.96"', f'"{printed}"')))[3:]
    assert last.verdict == verdict
    assert (last.counterexample is None) == (verdict == "true")


def test_halves_round_either_way(tmp_path):
    path = write(tmp_path, 'schema = 1\n[[claim]]\nid = "a"\nvalue = "1/8"\nprinted_value = "0.12"\n')
    assert symrot.check_file(path)[0].verdict == "true"


@pytest.mark.parametrize(("value", "shown"), [
    ("10^400*sqrt(2)", "1.41421356237e+400"), ("sqrt(2)/10^400", "1.41421356237e-400"), ("sqrt(2)", "1.41421356237"),
])  # fmt: skip
def test_a_value_beyond_the_range_of_floats_is_written_with_its_power_of_ten(value, shown, tmp_path):
    text = f'schema = 1\n[[claim]]\nid = "a"\nvalue = "{value}"\nprinted_value = "3"\n'
    (verdict,) = symrot.check_file(write(tmp_path, text))
    assert verdict.verdict == "false" and f" = {shown}.. " in str(verdict.counterexample)


FAULTS = (
    ("schema = 1", "schema = 2", "schema = 1"),
    ("schema = 1", "", "schema = 1"),
    ('where = "p. 17"', "where = 17", "where: expected a text"),
    ('where = "p. 17"', 'verdict = "true"', "got 'verdict'"),
    ('symbols = ["t"]', 'symbols = "t"', "a list of strings"),
    ('symbols = ["t"]', 'symbols = ["t", "t"]', "every name once"),
    ('symbols = ["t"]', 'symbols = ["phi"]', "declared once, got 'phi' twice"),
    ('symbols = ["t"]', 'symbols = ["sin"]', "built in"),
    ('symbols = ["t"]', 'symbols = ["__import__"]', "letters, digits"),
    ('symbols = ["t"]', "", "body-rates-zxz: .*declared"),
    ('claim = "diff(R, t) == R*W"', 'claim = "diff(R, t) == R*V"', "'V'"),
    ('claim = "diff(R, t) == R*W"', 'claim = "diff(R, t) == R*"', "at position"),
    ('claim = "diff(R, t) == R*W"', 'claim = "diff(R, t) > R*W"', "'=='"),
    ('claim = "diff(R, t) == R*W"', "", "exactly one of claim"),
    ('claim = "diff(R, t) == R*W"', 'claim = "diff(R, t) == R*W"\nvalue = "1"', "exactly one of claim"),
    ('["W", "skew(w1, w2, w3)"]', '["W", "skew(w1, w2)"]', "define W: .*3 components"),
    ('["W", "skew(w1, w2, w3)"]', '["w1", "skew(w1, w2, w3)"]', "expected a new name, got 'w1'"),
    ('["W", "skew(w1, w2, w3)"]', '["W"]', "list of pairs"),
    ('id = "unit"', 'id = "worked"', "'worked' twice"),
    ("q3**2 == 1", "q3**2 < 1", "hypothesis like"),
    ('printed_value = "2.96"', 'printed_value = "about 3"', "decimal"),
    ('printed_value = "2.96"', f'printed_value = "2.{"9" * 5000}"', "at most 200 characters"),
    ('printed_value = "2.96"', "", "printed_value"),
    ('value = "2*pi', 'value = "[1, 2]*pi', "expected a number, got a 2 x 1 matrix"),
    ('value = "2*pi', 'symbols = ["x"]\nvalue = "2*x*pi', "expected a number"),
    ("[[claim]]", "[[clam]]", "claim"),
    ("schema = 1", "schema = ", "TOML"),
)


@pytest.mark.thinned(3)
@pytest.mark.parametrize(("old", "new", "words"), FAULTS, ids=[new[:40] or old[:40] for old, new, _ in FAULTS])
def test_a_fault_in_a_file_is_named_with_its_claim(tmp_path, old, new, words):
    assert old in GOOD
    with pytest.raises(InputError, match=words) as refusal:
        symrot.check_file(write(tmp_path, GOOD.replace(old, new)))
    assert "\n" not in str(refusal.value)
    assert "claims.toml" in str(refusal.value) or any(
        name in str(refusal.value) for name in ("body-", "unit", "worked")
    )


def test_contradicting_hypotheses_prove_nothing(tmp_path):
    with pytest.raises(InputError, match="contradict"):
        symrot.check("x == y", assume=["x == 1", "x == 2"])


# -- the files of an author ------------------------------------------------------------------------------------------

TWENTY = Path(__file__).parents[1] / "data" / "rotation_claims.toml"
FAULT_OF_AN_AUTHOR = ("dot(w, L)/2 == (I1*w1**2 + I2", "dot(w, L)/2 == (I1*w1**2 - I2")


def test_twenty_claims_of_an_author_hold():
    found = symrot.check_file(TWENTY)
    assert len(found) == 20
    assert [verdict.id for verdict in found if not verdict] == []
    assert all(verdict.notes == () for verdict in found)


def author(tmp_path, *faults):
    text = TWENTY.read_text(encoding="utf-8")
    for old, new in faults:
        assert old in text
        text = text.replace(old, new, 1)
    return write(tmp_path, text)


def test_one_wrong_sign_among_twenty_fails_and_is_repaired(tmp_path, capsys):
    assert main(["check", str(author(tmp_path, FAULT_OF_AN_AUTHOR))]) == 1
    out = capsys.readouterr().out
    assert "20 claims: 19 true, 1 false" in out
    assert sum(line.startswith("true ") for line in out.splitlines()) == 19
    assert "false       kinetic-energy (eq. (11))" in out
    assert "[sign_of_term]" in out
    assert max(map(len, out.splitlines())) <= 110


def test_a_bad_claim_leaves_the_verdicts_of_the_others(tmp_path, capsys):
    path = author(tmp_path, ("trace(dcm_of(q0, q1, q2, q3)) ==", "trace(dcm_of(q0, q1, q2)) =="), FAULT_OF_AN_AUTHOR)
    assert main(["check", str(path), "--no-repair"]) == 2
    shown = capsys.readouterr()
    assert "20 claims: 18 true, 1 false, 1 refused" in shown.out
    (sentence,) = shown.err.splitlines()
    assert "claims.toml" in sentence and "trace-and-scalar-part" in sentence and "4 components" in sentence
    with pytest.raises(RefusedClaims, match="trace-and-scalar-part") as refusal:
        symrot.check_file(path, repair=False)
    assert Counter(verdict.verdict for verdict in refusal.value.verdicts) == {"true": 18, "false": 1, "refused": 1}


FIELDS = {
    "id": str, "verdict": str, "entry": list | None, "conditions": list, "counterexample": dict | None,
    "diagnosis": dict, "repairs": list, "seconds": float,
}  # fmt: skip
"""What a machine may rely on, in this order (DESIGN, section 6)."""


def test_json_has_the_fields_that_were_promised_and_is_the_same_twice(tmp_path, capsys):
    path = author(tmp_path, FAULT_OF_AN_AUTHOR)
    printed = []
    for _ in range(2):
        assert main(["check", str(path), "--json"]) == 1
        printed.append(re.sub(r'"seconds": [0-9.e-]+', '"seconds": 0', capsys.readouterr().out))
    assert printed[0] == printed[1]
    found = json.loads(printed[0])
    assert len(found) == 20
    for entry in found:
        assert list(entry)[: len(FIELDS)] == list(FIELDS)
        assert all(isinstance(entry[name], kind) for name, kind in FIELDS.items() if name != "seconds")
        assert list(entry["diagnosis"]) == ["code", "text"]
        fields = ["text", "code", "cost", "proven", "changed", "entry"]
        assert all(list(repair) == fields for repair in entry["repairs"])
    (wrong,) = (entry for entry in found if entry["verdict"] == "false")
    assert list(wrong["counterexample"]) == ["values", "lhs", "rhs", "entry"]
    assert wrong["diagnosis"]["code"] == wrong["repairs"][0]["code"] == "sign_of_term"


READINGS = """
schema = 1
[[claim]]
id = "read-again"
symbols = ["x"]
claim = "cos(2*x) == 1 - sin(x)**2"
alternatives = ["cos(2*x) == 1 + 2*sin(x)**2", '\\cos 2x = 1 - 2\\sin^2 x']

[[claim]]
id = "only-alternatives"
symbols = ["x"]
alternatives = ["x == 2*x", "x + x == 2*x"]

[[claim]]
id = "none-holds"
symbols = ["x"]
claim = "x == 2*x"
alternatives = ["x == 3*x"]
"""


def test_any_reading_of_a_claim_may_be_the_true_one(tmp_path, capsys):
    path = write(tmp_path, READINGS)
    first, second, third = symrot.check_file(path)
    assert (first.verdict, first.text) == ("true", "cos(2*x) == 1 - 2*sin(x)**2")
    assert first.notes == ("this is another reading of the claim; the first, cos(2*x) == 1 - sin(x)**2, is false",)
    assert (second.verdict, second.text) == ("true", "x + x == 2*x")
    assert (third.verdict, third.text) == ("false", "x == 2*x")
    assert main(["check", str(path)]) == 1
    assert "3 claims: 2 true, 1 false" in capsys.readouterr().out


def test_a_formula_of_a_paper_takes_its_functions_from_the_hypotheses():
    given = ["I_1*diff(omega_1(t), t) == (I_2 - I_3)*omega_2(t)*omega_3(t)"]
    assert symrot.check(r"I_1\dot\omega_1 = (I_2 - I_3)\omega_2\omega_3", assume=given).verdict == "true"
    wrong = symrot.check(r"I_1\dot\omega_1 = (I_3 - I_2)\omega_2\omega_3", assume=given)
    assert wrong.verdict == "false"
    assert wrong.repairs


def test_braces_mean_latex():
    assert symrot.check("I_{xy} = -I_{yx}", assume=["I_xy == -I_yx"]).verdict == "true"


# -- the command ------------------------------------------------------------------------------------------------------


def test_the_command_says_true_and_exits_0(capsys):
    assert main(["check", "cos(2*x) == 1 - 2*sin(x)**2"]) == 0
    assert capsys.readouterr().out.splitlines() == ["true", "  claim:          cos(2*x) == 1 - 2*sin(x)**2"]


def test_the_command_exits_1_when_a_claim_fails(tmp_path, capsys):
    path = write(tmp_path, GOOD.replace("R*W", "W*R"))
    assert main(["check", str(path), "--no-repair"]) == 1
    out = capsys.readouterr().out
    assert "4 claims: 3 true, 1 false" in out
    assert "counterexample" in out
    assert max(map(len, out.splitlines())) <= 110


def test_the_command_prints_json(tmp_path, capsys):
    assert main(["check", str(write(tmp_path, GOOD.replace("R*W", "W*R"))), "--json", "--no-repair"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert [entry["verdict"] for entry in found] == ["false", "true", "true", "true"]
    assert set(found[0]) >= {
        "id",
        "verdict",
        "entry",
        "conditions",
        "counterexample",
        "diagnosis",
        "repairs",
        "seconds",
    }
    assert found[0]["entry"] == found[0]["counterexample"]["entry"]


def test_hypotheses_on_the_command_line(capsys):
    assert main(["check", "sqrt(x**2) == x", "--given", "x > 0"]) == 0
    assert main(["check", "sqrt(x**2) == x", "--json"]) == 1


@pytest.mark.parametrize("words", [
    ["check", "x + == 1"], ["check", "x"], ["check", "no_such.toml"], ["check"], ["check", "1 == 1", "--given", "x"],
])  # fmt: skip
def test_bad_input_exits_2_with_one_line(words, capsys):
    assert main(words) == 2
    assert len(capsys.readouterr().err.splitlines()) == 1
