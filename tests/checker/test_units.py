"""The check of units: contradictions are found, units that may fit are accepted, and the verdict does not change."""

import json
import re
from fractions import Fraction

import pytest

import symrot
from symrot import catalogue, symbols
from symrot.checker.claim.source.file import read_claims
from symrot.checker.units.check import dimensions_of_formulas
from symrot.checker.units.units import (
    CONVENTIONAL_UNITS,
    UnitSystem,
    conventional_unit,
    raised,
    read_unit,
    times,
    unit_text,
)
from symrot.cli.main import main
from symrot.errors import InputError
from symrot.textbook import DOCUMENTS, document

LETTERS = {"t": "s", "m": "kg", "g": "m/s^2"}


def physical(claim):
    """Return the unit of the first of these letters in a claim, which gives the others their conventional units."""
    return {letter: LETTERS[letter] for letter in re.findall(r"\b[tmg]\b", claim)[:1]}


def dimension(claim, **units):
    return symrot.check(claim, units=units, repair=False).dimension


# -- units ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("text", "shown"), [
    ("kg m^2/s", "kg m^2/s"), ("N m", "kg m^2/s^2"), ("J/s", "kg m^2/s^3"), ("N m s/rad", "kg m^2/s"), ("rad", "1"), ("1/s", "1/s"),
    ("m^(1/2)", "m^(1/2)"), ("kg*m**2", "kg m^2"), ("1", "1"), ("Pa", "kg/(m s^2)"), ("mm/ms", "m/s"), ("slug ft^2", "kg m^2"), ("deg/s", "1/s"),
])  # fmt: skip
def test_units_are_read_and_shown(text, shown):
    assert unit_text(read_unit(text)) == shown
    assert read_unit(unit_text(read_unit(text))) == read_unit(text)


@pytest.mark.parametrize("text", ["", "kg..m", "furlong", "/s", "kg^", "m^x", "2 m", "m^(1/0)", "m^" + "9" * 5000])
def test_what_is_no_unit_is_refused(text):
    with pytest.raises(InputError, match="expected a unit like"):
        read_unit(text)


def test_every_symbol_of_symrot_has_a_unit_that_is_read():
    """The symbols of a vector of any kind have no unit."""
    for unit in filter(None, symbols.UNIT.values()):
        read_unit(unit)


def test_custom_agrees_with_the_symbols_of_symrot():
    """Where a book and symrot use the same name, they mean the same unit."""
    own = {symbol.name: unit for symbol, unit in symbols.UNIT.items()}
    shared = [name for name in own if conventional_unit(name)]
    assert len(shared) > 25
    assert all(read_unit(own[name]) == read_unit(conventional_unit(name)) for name in shared)
    assert all(read_unit(unit) is not None for _, unit in CONVENTIONAL_UNITS)


def test_equations_between_units_are_solved_over_the_rationals():
    system = UnitSystem()
    x, y, metre = {"x": Fraction(1)}, {"y": Fraction(1)}, read_unit("m")
    assert system.equate(times(x, y), raised(metre, Fraction(3)))
    assert system.equate(raised(x, Fraction(2)), y)
    assert (unit_text(system.reduced(x)), unit_text(system.reduced(y))) == ("m", "m^2")
    assert not system.equate(x, y)
    assert unit_text(system.reduced(times(x, {"z": Fraction(1, 2)}))) == "m [z]^(1/2)"


# -- claims -----------------------------------------------------------------------------------------------------------


def test_a_true_identity_with_terms_of_two_units():
    """The algebra is right, but the units are not: the verdict stays true, and the line on units says where."""
    verdict = symrot.check("x*(1 + x) == x + x**2", units={"x": "m"})
    assert verdict.verdict == "true" and verdict.diagnosis.code == "none"
    assert verdict.dimension.status == "inconsistent"
    assert verdict.dimension.text == "on the left side term 1 of the sum 1 + x is dimensionless, term 2 is m"
    assert symrot.check("x*(1 + x) == x + x**2").dimension.status == "unknown"


def test_units_explain_a_false_formula():
    verdict = symrot.check("m*g*h == I1*omega_1*theta + F", units={"h": "m", "F": "J"})
    assert verdict.verdict == "false"
    assert verdict.diagnosis.code == "dimension"
    assert verdict.dimension.text == (
        "on the right side term 1 of the sum I1*omega_1*theta + F is kg m^2/s, term 2 is kg m^2/s^2"
        " (assuming m in kg, g in m/s^2, I1 in kg m^2, omega_1 in rad/s)"
    )
    assert verdict.to_json()["dimension"]["status"] == "inconsistent"
    assert f"units: {verdict.dimension.text}" in str(verdict)


@pytest.mark.parametrize("claim", [
    "m*g*h == I1*omega_1**2/2", "0.5*m*v**2 == m*v**2/2", "diff(theta(t), t, t) == -g/l*sin(theta(t))",
    "I1*diff(omega_1(t), t) == (I2 - I3)*omega_2(t)*omega_3(t) + tau_1", "omega_1 == 2*pi/5", "sqrt(g/h)*t == 2*pi", "cos(omega*t) == 1 - omega**2*t**2/2",
    "q0**2 + q1**2 + q2**2 + q3**2 == 1", "atan2(I1*omega_1, I2*omega_2) == theta", "integrate(m*x**2, (x, 0, h)) == m*h**3/3",
    "diff(m*diff(theta(t), t)**2/2, diff(theta(t), t)) == m*diff(theta(t), t)", "det(Matrix([[m, g], [t, 1]])) == m - g*t + 0*t",
    "Matrix([[1, t], [0, 1]])*Matrix([[x], [v]]) == Matrix([[x + v*t], [v]])", "inverse(Matrix([[1, t], [0, 1]])) == Matrix([[1, -t], [0, 1]])",
    "skew(omega_1, omega_2, omega_3)*Matrix([x, y, z]) == cross(Matrix([omega_1, omega_2, omega_3]), Matrix([x, y, z]))",
])  # fmt: skip
def test_what_fits_is_not_complained_of(claim):
    """The examples are matrices of mixed units, inferred units, numbers with units, and rational exponents."""
    found = dimension(claim, **physical(claim))
    assert found.status == ("inconsistent" if "det" in claim else "consistent"), found.text


@pytest.mark.parametrize(("claim", "words"), [
    ("tau_1 == I1*omega_1", "the left side is kg m^2/s^2, the right side is kg m^2/s"),
    ("diff(I1*omega_1(t), t) == I1*omega_1(t)", "the left side is kg m^2/s^2, the right side is kg m^2/s"),
    ("sin(omega_1) == 0", "the argument of sin, omega_1, is 1/s"), ("exp(t) == 1", "the argument of exp, t, is s"),
    ("Matrix([[m], [t]]) == Matrix([[m], [g]])", "in entry (2, 1) the left side is s, the right side is m/s^2"),
    ("Rx(t*g)*Matrix([x, y, z]) == Matrix([x, y, z])", "the argument of Rx, t*g, is m/s"),
    ("atan2(t, m) == theta", "the arguments of atan2 are s and kg"), ("abs(t) + sqrt(t) == 0", "term 1 of the sum"),
    ("integrate(x, (x, 0, t)) == m", "the left side is s^2, the right side is kg"), ("t**(1/2) == m", "s^(1/2)"),
    ("trace(Matrix([[t, 0], [0, m]])) == t + m", "of a trace is s"), ("dot(Matrix([t, m]), Matrix([t, m])) == 0", "product of vectors"),
])  # fmt: skip
def test_contradictions_are_found_and_named(claim, words):
    found = dimension(claim, **physical(claim))
    assert found.status == "inconsistent"
    assert words in found.text


@pytest.mark.parametrize(
    "claim",
    ["(m + 1)**2 == m**2 + 2*m + 1", "diff(exp(t)*x(t), t) == exp(t)*(x(t) + diff(x(t), t))", "(g + t)*m == g*m + t*m"],
)
def test_single_letters_may_be_mathematics(claim):
    assert dimension(claim).status == "unknown"
    assert dimension(claim, **physical(claim)).status == "inconsistent"


def test_units_of_names_are_inferred():
    assert dimension("m*g*x == k*x**2/2", x="m").units == {"k": "kg/s^2"}
    assert dimension("F == m*a", F="N").units == {"a": "m/s^2"}


@pytest.mark.parametrize(("units", "words"), [
    ({"y": "m"}, "names that occur in the claim, got 'y'"), ({"x": "cubit"}, "units: x: expected a unit like"), ({"x": 1}, "as text, got 1"),
])  # fmt: skip
def test_bad_units_are_refused(units, words):
    with pytest.raises(InputError, match=words):
        symrot.check("x == x", units=units)


def test_units_in_a_file_of_claims(tmp_path, capsys):
    path = tmp_path / "claims.toml"
    path.write_text(
        "schema = 1\n[[claim]]\nid = 'a'\nsymbols = ['x', 'k']\nunits = { x = 'm', k = 'N/m' }\ndefine = [['F', 'k*x**2']]\n"
        "given = ['k == 3']\nclaim = 'F*x == k*x**3'\n[[claim]]\nid = 'b'\nsymbols = ['x']\nunits = { x = 'm' }\nclaim = 'x**2 - x == x*(x - 1)'\n"
    )
    first, second = symrot.check_file(path)
    assert (first.dimension.status, second.dimension.status) == ("consistent", "inconsistent")
    assert first and second
    assert main(["check", str(path), "--json"]) == 0
    assert [found["dimension"]["status"] for found in json.loads(capsys.readouterr().out)] == [
        "consistent",
        "inconsistent",
    ]
    path.write_text(path.read_text().replace("x = 'm', k", "z = 'm', k"))
    with pytest.raises(InputError, match="a: units: expected units only for names that occur in the claim, got 'z'"):
        symrot.check_file(path)


def test_units_at_the_command_line(capsys):
    assert main(["check", "x + x**2 == x*(x + 1)", "--unit", "x=m"]) == 0
    assert "units:" in capsys.readouterr().out
    assert main(["check", "x == x", "--unit", "xm"]) == 2


def test_the_units_of_sympy_formulas_are_those_of_their_symbols():
    body, rate = symbols.A * symbols.omega_1, symbols.tau_1
    assert dimensions_of_formulas(body, rate).status == "inconsistent"
    assert dimensions_of_formulas(body, symbols.H).status == "consistent"
    assert symrot.check(symbols.m * symbols.g, symbols.W, repair=False).dimension.status == "consistent"


# -- everything that is known -----------------------------------------------------------------------------------------

GENUINE = {"sahakian-top-energy", "brown-force-sum"}
"""Read with I for 1 in a numerator; and force set equal to momentum. Both are false in these readings."""


@pytest.mark.campaign
def test_no_true_claim_of_the_documents_has_units_that_do_not_fit():
    from symrot.checker.units.check import check_dimensions

    found = {
        claim.id: check_dimensions(
            claim.relation[1:], claim.define, [pair[1:] for pair in claim.hypotheses], claim.units
        ).status
        for name in DOCUMENTS
        for claim in read_claims(document(name).path)
        if claim.relation is not None
    }
    assert {name for name, status in found.items() if status == "inconsistent"} == GENUINE
    assert sum(status == "consistent" for status in found.values()) > 420


LOCAL = {"poinsot": {"p": "kg^(1/2) m"}, "relative_motion": {"r_1": "m", "r_2": "m", "r_3": "m"},
         "driven_rotation": {"m_1": "rad", "m_2": "rad", "m_3": "rad"}}  # fmt: skip
"""Letters that a page uses in a meaning of its own."""
QUICK = ("euler_equations", "heavy_top_invariants", "gravity_gradient", "work_and_power", "poinsot", "kinetic_energy")


def assert_units_fit(name):
    for number, step in enumerate(catalogue.derivation(name).steps, start=1):
        own = {letter: unit for letter, unit in LOCAL.get(name, {}).items() if letter in str((step.left, step.right))}
        assert dimensions_of_formulas(step.left, step.right, own).status != "inconsistent", (name, number)


@pytest.mark.thinned(2)
@pytest.mark.parametrize("name", QUICK)
def test_the_units_of_derivations_fit(name):
    assert_units_fit(name)


@pytest.mark.campaign
@pytest.mark.parametrize("name", sorted(set(catalogue.names()) - set(QUICK)))
def test_the_units_of_all_derivations_fit(name):
    assert_units_fit(name)
