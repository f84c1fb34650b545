"""Formulas as people type them: one tree for each text, the other reading of an ambiguous text, and helpful refusals."""

from pathlib import Path

import pytest

import symrot
from symrot.checker import language
from symrot.checker.claim.functions import BUILT_IN
from symrot.checker.claim.notation import notation_of
from symrot.checker.claim.reader import read_expression, readings_of
from symrot.checker.claim.tree import text
from symrot.checker.typed.tokens import tokens_of
from symrot.cli.main import main
from symrot.errors import InputError

PAGE = Path(__file__).parents[3] / "docs" / "checkers.md"

SAME = (
    # powers
    ("-x^2", "-x**2"), ("2^-1", "2**(-1)"), ("2^3^2", "2**3**2"), ("x²", "x**2"), ("x⁻¹ + y³", "x**(-1) + y**3"),
    ("(a + b)²c", "(a + b)**2*c"), ("x^2 y", "x**2*y"), ("r^2/5", "r**2/5"), ("e^(2x)", "e**(2*x)"), ("e^-kt", "e**(-k*t)"), ("√x", "sqrt(x)"),
    ("√(x + 1) y", "sqrt(x + 1)*y"), ("R^T", "R.T"), ("Rᵀ R⁻¹", "R.T*R**(-1)"),
    # products
    ("2x", "2*x"), ("2 x y", "2*x*y"), ("1/12 m (b^2 + c^2)", "1/12*m*(b**2 + c**2)"), ("(a + b)(a - b)", "(a + b)*(a - b)"),
    ("x(y + 1)", "x*(y + 1)"), ("2(x)(y)", "2*x*y"), ("a·b × 3", "a*b*3"), ("m[a^2 + b^2]", "m*(a**2 + b**2)"),
    ("1/2 m v²", "1/2*m*v**2"), ("½ m", "1/2*m"), ("¾x", "3/4*x"), ("m g l sin θ", "m*g*l*sin(theta)"),
    ("-2x", "-(2*x)"), ("a − b – c", "a - b - c"), ("a÷b", "a/b"), ("1⁄2", "1/2"), ("|x|y", "abs(x)*y"),
    # functions
    ("sin x", "sin(x)"), ("sin 2x cos y", "sin(2*x)*cos(y)"), ("2 sin x cos x", "2*sin(x)*cos(x)"), ("sin 2x", "sin(2*x)"),
    ("sin^2 x", "sin(x)**2"), ("cos²θ", "cos(theta)**2"), ("cos^2(theta/2)", "cos(theta/2)**2"), ("sin ωt", "sin(omega*t)"),
    ("sin(2x)cos(y)", "sin(2*x)*cos(y)"), ("sin x/cos x", "sin(x)/cos(x)"), ("arcsin x + ln y", "asin(x) + log(y)"),
    ("sin -x", "sin(-x)"), ("sin cos x", "sin(cos(x))"), ("sin (x + y) z", "sin(x + y)*z"), ("tan(x) y", "tan(x)*y"),
    ("cos 45°", "cos(45*pi/180)"), ("sin θ cos φ ψ̇", "sin(theta)*cos(phi)*diff(psi(t), t)"),
    ("sin θ φ̇", "sin(theta)*diff(phi(t), t)"), ("4 cos²x sin y", "4*cos(x)**2*sin(y)"),
    # names
    ("ω₁ + ω_1 + ω1", "omega_1 + omega_1 + omega_1"), ("ωx ωy", "omega_x*omega_y"), ("Iₓₓ + I_ω", "I_xx + I_omega"),
    ("p_ψ + M_θ", "p_psi + M_theta"), ("ϕ + φ", "phi + phi"), ("𝜔 𝑚", "omega*m"), ("π r²", "pi*r**2"), ("ΔE", "Delta_E"),
    # rates
    ("φ̇", "diff(phi(t), t)"), ("θ̈ + θ", "diff(theta(t), t, t) + theta(t)"), ("ẋy − xẏ", "diff(x(t), t)*y(t) - x(t)*diff(y(t), t)"),
    ("ω̇₁", "diff(omega_1(t), t)"), ("φ̇²", "diff(phi(t), t)**2"), ("mẍ", "m*diff(x(t), t, t)"), ("φ̇(t)", "diff(phi(t), t)"),
    ("dθ/dt", "diff(theta(t), t)"), ("d²x/dt²", "diff(x(t), t, t)"), ("d^2x/dt^2 + x", "diff(x(t), t, t) + x(t)"),
    ("d/dt (x y)", "diff(x(t)*y(t), t)"), ("dω₁/dt I", "diff(omega_1(t), t)*I"),
    # matrices and methods
    ("[c, -s; s, c]", "Matrix([[c, -s], [s, c]])"), ("[[c, -s], [s, c]]", "Matrix([[c, -s], [s, c]])"),
    ("2[1, 2, 3]", "2*Matrix([1, 2, 3])"), ("R.inv() + R.T.det()", "inverse(R) + det(R.T)"),
    ("Matrix.hstack(a, b).adjugate()", "adjugate(hstack(a, b))"), ("v.norm() + v.dot(w)", "sqrt(dot(v, v)) + dot(v, w)"),
    ("Derivative(x(t), t) + Abs(x)", "diff(x(t), t) + abs(x)"), ("Rational(1, 2)*x", "1/2*x"), ("Matrix.eye(3)", "eye(3)"),
)  # fmt: skip


@pytest.mark.parametrize(("typed", "sympy"), SAME)
def test_a_typed_formula_has_the_tree_of_the_formula_in_full(typed, sympy):
    first, *_ = readings_of(f"{typed} = 0")
    assert text(first.relation[1]) == text(read_expression(sympy))


@pytest.mark.parametrize("typed", [typed for typed, _ in SAME if "e^" not in typed])
def test_the_echo_of_a_reading_is_read_as_the_same_tree(typed):
    first, *_ = readings_of(f"{typed} = 0")
    assert first.plain
    echo = notation_of(first).relation(first.relation)
    assert [text(side) for side in readings_of(echo)[0].relation[1:]] == [text(side) for side in first.relation[1:]]


TWO = (
    ("1/2m", "1/2*m", "1/(2*m)"), ("p²/2m", "p**2/(2*m)", "p**2/2*m"), ("a/b c", "a/b*c", "a/(b*c)"),
    ("g/ωr", "g/(omega*r)", "g/omega*r"), ("1/2π", "1/(2*pi)", "1/2*pi"), ("6/2(1 + x)", "6/2*(1 + x)", "6/(2*(1 + x))"),
    ("sin x y", "sin(x)*y", "sin(x*y)"), ("sin x*y", "sin(x)*y", "sin(x*y)"), ("cos θ/2", "cos(theta/2)", "cos(theta)/2"),
    ("sin x/y", "sin(x)/y", "sin(x/y)"), ("sin x^2", "sin(x**2)", "sin(x)**2"), ("cos ω t", "cos(omega*t)", "cos(omega)*t"),
    ("sin 2 x", "sin(2*x)", "sin(2)*x"), ("tan^-1 x", "atan(x)", "tan(x)**(-1)"), ("sin⁻¹(x)", "asin(x)", "sin(x)**(-1)"),
    ("x^1/2", "x**(1/2)", "x**1/2"), ("x^3/2", "x**3/2", "x**(3/2)"), ("√2x", "sqrt(2)*x", "sqrt(2*x)"),
    ("x'", "diff(x(t), t)", "x_prime"), ("θ′′", "diff(theta(t), t, t)", "theta_prime_prime"), ("2mgh", "2*m*g*h", "2*mgh"),
    ("2bc", "2*bc", "2*b*c"), ("a + b + ab^2", "a + b + a*b**2", "a + b + ab**2"), ("sinx", "sin(x)", "sinx"),
    ("cos2theta", "cos(2*theta)", "cos2theta"), ("4/3πr³", "4/3*pi*r**3", "4/(3*pi)*r**3"), ("√k/m", "sqrt(k)/m", "sqrt(k/m)"),
    ("cθ sφ", "cos(theta)*sin(phi)", "c*theta*s*phi"), ("cθ + a", "c*theta + a", "cos(theta) + a"),
    ("2c_θ s_ψ²", "2*cos(theta)*sin(psi)**2", "2*c_theta*s_psi**2"), ("2kx", "2*k*x", "2*kx"), ("2qx", "2*qx", "2*q*x"),
)  # fmt: skip


@pytest.mark.parametrize(("typed", "usual", "other"), TWO)
def test_a_text_with_two_readings_has_both_the_usual_one_first(typed, usual, other):
    first, second, *more = readings_of(f"{typed} = 0")
    assert (text(first.relation[1]), text(second.relation[1])) == (usual, other)
    assert not more
    assert first.doubts and second.flipped and not first.flipped


@pytest.mark.parametrize(("typed", "usual", "other"), TWO)
def test_where_one_tree_is_needed_a_text_with_two_readings_is_refused(typed, usual, other):
    if typed in ("sinx", "cos2theta"):  # names of SymPy's text
        assert text(read_expression(typed)) == typed
        return
    with pytest.raises(InputError, match="has two readings"):
        read_expression(typed)


@pytest.mark.parametrize("source", [
    "mgh == ab", "sinx == dx/dt", "ab + a*b == x", "a/b*c == x", "1/2*m == x", "sin (a + b)/2 == x", "x.T == y", "M[0, 1] == y",
])  # fmt: skip
def test_names_of_sympy_s_text_stay_whole(source):
    first = readings_of(source)[0]
    assert not first.plain and text(first.relation[1]) == source.partition(" == ")[0].replace("n (", "n(")


def test_the_other_reading_is_decided_and_told_if_its_verdict_differs():
    verdict = symrot.check("sin x y = sin(x) y")
    assert verdict.verdict == "true"
    assert verdict.notes == ("'sin x y' can be read in two ways: read as sin(x*y) = sin(x)*y, it is false",)
    verdict = symrot.check("sin x y = sin(xy)")
    assert verdict.verdict == "false"
    assert any("read as sin(x*y) = sin(x*y), it is true" in note for note in verdict.notes)
    assert symrot.check("2 + 1/2x = 2 + x/2").notes == (
        "'1/2x' can be read in two ways: read as 2 + 1/(2*x) = 2 + x/2, it is false",
    )


def test_the_split_of_a_word_is_told():
    verdict = symrot.check("(a + b)^2 = a^2 + 2ab + b^2")
    assert verdict.verdict == "true"
    assert verdict.notes[0] == "ab is read as the product a*b, not as one name"
    assert "as (a + b)^2 = a^2 + 2*ab + b^2, it is false" in verdict.notes[1]
    strict = symrot.check("(a + b)**2 == a**2 + 2*ab + b**2")
    assert strict.verdict == "false"
    assert any("read as (a + b)^2 = a^2 + 2*a*b + b^2, it is true" in note for note in strict.notes)


REFUSED = (
    ("2x", "'==' between"), ("x 2 = 1", "a product sign before a number at position 3"), ("sin = 1", "brackets after the function sin"),
    ("sin^x y = 1", "a number as the exponent of sin"), ("∫x = 1", "limits and dx, as in"),
    ("∂x = 1", "write diff"), ("Σx = 0", "write the terms"), ("y = ¹/₀", "a divisor that is not zero at position 5"),
    ("x.applyfunc(f) == 1", "T, the transpose, or another of"), ("x.__class__ == 1", "position 3"), ("x.y == 1", "position 3"),
    ("x.free_symbols == 1", "position 3"), ("open(x + y) == 1", "'open'"), ("(x + = 1", "a number, a name"),
    ("x² + (y = 1", r"'\)'"), ("x = 1 < 2", "a chain of equals signs"), ("|x = 1", r"'\|'"), ("t' = 1", "can depend on t"),
    ("[1, 2; 3] = x", "equal length"), ("[a b; c d] = x", "commas between the entries"),
    ("2e3x = 1", "a product sign after the number"), ("x\n= 1\ny", "'=='"),
    ("a × b × c = 0", "which of the products"), ("xⁿ = 1", "position 2"), ("x²⁻ = 1", "a whole number"), ("м = 1", "position 1"),
    ("I*I == -1", "means something else"), ("log(E) == 1", "means something else"),
("x = 1, y", "on a line of its own"), (";", "a formula at position 1"), ("x.dot() == 1", "a number, a name|one argument"), ("M.inv(2) == 1", "no arguments"), ("Eq(x, y, z)", "two arguments in Eq"),
)  # fmt: skip


@pytest.mark.parametrize(("typed", "words"), REFUSED)
def test_a_refusal_says_the_place_and_what_to_write(typed, words):
    with pytest.raises(InputError, match=words) as refusal:
        symrot.check(typed)
    assert "\n" not in str(refusal.value) and len(str(refusal.value)) < 600


def test_a_chain_is_decided_link_by_link():
    verdict = symrot.check("(a + b)² = a² + 2 a b + b² = a (a + 2b) + b²")
    assert verdict.verdict == "true" and sum("is true" in note for note in verdict.notes) == 2
    wrong = symrot.check("(a + b)² = a² + 2 a b + b² = a² + b²")
    assert wrong.verdict == "false"
    assert "a^2 + 2*a*b + b^2 = a^2 + b^2 is false" in wrong.notes
    assert "(a + b)^2 = a^2 + 2*a*b + b^2 is true" in wrong.notes


def test_a_chain_that_names_a_quantity_may_have_formulas_in_different_letters():
    verdict = symrot.check("I = 1/2 m r² = 1/8 m d²")
    assert verdict.verdict == "recognised"
    assert any("is not an identity, since only one side has d" in note for note in verdict.notes)
    assert any("d is the diameter" in note for note in verdict.notes)
    assert symrot.check("I = 1/2 m r² = 1/3 m r²").verdict == "false"
    assert symrot.check("I = 1/2 m r² = m r²/2").verdict == "recognised"


def test_lines_that_name_a_formula_define_it_for_the_lines_after_them():
    lines = "x = r cos θ\ny = r sin θ\nx² + y² = r²"
    assert symrot.check(lines).verdict == "true"
    assert symrot.check(lines.replace("x² +", "x² -")).verdict == "false"
    assert symrot.check("R = [cos a, -sin a; sin a, cos a]\nR^T R = [1, 0; 0, 1]").verdict == "true"
    assert symrot.check("R = [cos a, sin a; sin a, cos a]; R^T R = [1, 0; 0, 1]").verdict == "false"
    assert symrot.check("x + y\n  = y + x,\nx = x").verdict == "true"


@pytest.mark.parametrize("claim", ["E = ½ I ω²", "T == I*omega**2/2", "I == m*r**2"])
def test_the_letters_of_an_inertia_and_an_energy_are_quantities(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict in ("definition", "recognised")
    letters = {"E = ½ I ω²": "IE", "T == I*omega**2/2": "I", "I == m*r**2": "I"}[claim]
    assert [note[0] for note in verdict.notes] == list(letters)
    assert all("is read as a quantity, not as" in note for note in verdict.notes)


def test_the_names_after_d_dt_that_have_no_rate_are_told_as_constants():
    verdict = symrot.check("d/dt (m l² θ̇) = m l² θ̈")
    assert verdict.verdict == "true"
    assert verdict.notes[0] == "l and m are read as constants, since the text has no rate of them, such as dl/dt"
    assert verdict.notes[1].endswith("it is false")
    assert symrot.check("d/dt (x y) = ẋ y + x ẏ").notes == ()
    assert (
        symrot.check("d/dt (x y) = ẏ x").notes[0]
        == "x is read as a constant, since the text has no rate of it, such as dx/dt"
    )
    latex = symrot.check(r"\frac{d}{dt}(x y) = \dot x y")
    assert latex.notes == ("y is read as a constant, since the text has no rate of it, such as dy/dt",)
    assert symrot.check("M = d/dt (I ω)").reading == "M = diff(I(t)*ω(t), t)"


def test_a_unit_next_to_other_names_is_told_to_be_a_name():
    assert symrot.check("5 km x = 5000 m x").notes[0] == "km is read as a name, not as a unit"
    assert symrot.check("ω = 1500 rpm").notes == ("1 rpm = pi/30 rad/s",)


HYPERBOLIC = (
    "coth x = 1/tanh x", "coth(x)**2 - csch(x)**2 == 1", "sech²x + tanh²x = 1", "sinh(asinh x) = x", "cosh(acosh(x)) == x",
    "atanh(tanh(x)) == x", "tanh(acoth x) = 1/x", "sech(asech(x)) == x", "csch(acsch x) = x", "tg x ctg x = 1",
    "d/dt (coth x) = -ẋ csch² x", "arcsinh x = ln(x + √(x² + 1))", "cosec x sin x = 1",
    r"\coth x = \frac{1}{\tanh x}", r"\operatorname{sech}^2 x = 1 - \tanh^2 x", r"\mathrm{sin}^2 x + \cos^2 x = 1",
    r"\operatorname{artanh} x = \frac12\ln\frac{1+x}{1-x}", r"\sinh^{-1} x = \ln(x + \sqrt{x^2+1})", "arsinh(x) = sinh^-1 x",
    "asech(x) == acosh(1/x)",
)  # fmt: skip


@pytest.mark.parametrize("claim", HYPERBOLIC)
def test_functions_that_are_formulas_of_others_are_decided(claim):
    assert symrot.check(claim).verdict == "true"


@pytest.mark.parametrize("claim", ["sech(x) == 2/cosh(x)", "coth x = tanh x", "asinh(x) == log(x + sqrt(x**2 - 1))"])
def test_a_wrong_formula_of_such_functions_is_not_true(claim):
    assert symrot.check(claim).verdict in ("false", "conditional")


def test_every_token_has_its_place():
    source = "ω̇₁ = ½ θ̈² − 𝜔"
    for token in tokens_of(source):
        assert 0 <= token.start <= token.end <= len(source)
    with pytest.raises(InputError, match="at position 11"):
        symrot.check("ω̇₁ = ½ 𝜔 ∑x")


def test_sympy_equations_and_values_are_read():
    from sympy import Eq, cos, sin, symbols

    x = symbols("x", real=True)
    assert symrot.check(Eq(sin(2 * x), 2 * sin(x) * cos(x))).verdict == "true"
    assert symrot.check("Eq(sin(2*x), 2*sin(x)*cos(x))").verdict == "true"
    with pytest.raises(InputError, match="two sides"):
        symrot.check(sin(x))


def test_the_text_of_sympy_expressions_is_read():
    from sympy import Derivative, Function, Integral, Matrix, Rational, cos, sin, sqrt, symbols

    t, x, y = symbols("t x y", real=True)
    theta = Function("theta")(t)
    matrix = Matrix([[cos(x), -sin(x)], [sin(x), y]])
    values = [Derivative(theta, t, t) + Rational(1, 3) * sqrt(x) * abs(y), theta.diff(t) ** 2, Integral(x * y, (x, 0, y)),
              matrix.det(), 2 * x ** Rational(3, 2) / y, sin(x) ** 2 * cos(theta)]  # fmt: skip
    for value in values:
        assert symrot.check(f"{value} == {value} + y - y").verdict == "true", value
    assert symrot.check(f"{matrix}.T == {matrix.T}").verdict == "true"


def test_the_page_and_the_help_have_the_tables_of_the_language(capsys):
    page = PAGE.read_text("utf-8")
    for title, rows in language.tables().items():
        assert title == "Context" or language.markdown_table(rows) in page
    with pytest.raises(SystemExit):
        main(["check", "--help"])
    shown = " ".join(capsys.readouterr().out.split())
    for rows in language.tables().values():
        assert all(row[0].replace("`", "").replace("\\|", "|") in shown for row in rows[1:])
    assert tuple(BUILT_IN) == language.functions()


def test_the_page_of_the_language_lists_every_built_in_function():
    page = PAGE.read_text("utf-8").partition("## How formulas are read")[2]
    names = page.partition("Built-in functions:")[2].partition(".\n")[0]
    assert [name.strip(" `\n") for name in names.split(",")] == list(BUILT_IN)


def test_the_table_of_two_readings_holds():
    """Each text in the table of the page has at least two readings."""
    rows = PAGE.read_text("utf-8").partition("| text | usual reading")[2].splitlines()[2:]
    texts = [cell for row in rows[: rows.index("")] for cell in row.split("|")[1].replace("`", "").split(",")]
    assert len(texts) > 15
    for typed in texts:
        _, *others = readings_of(f"y + {typed.strip()} + a + b = 0")
        assert others, typed


def test_a_greek_letter_with_an_index_is_a_name_where_it_is_the_whole_left_side():
    verdict = symrot.check("ωp = m g r/(I_3 ω)")
    assert verdict.reading == "ωp = m*g*r/(I_3*ω)"
    assert any("read as ω*p = " in note for note in verdict.notes)
    verdict = symrot.check("v = ωr")
    assert (verdict.verdict, verdict.reading) == ("recognised", "v = ω*r")


def test_tr_is_the_trace():
    assert symrot.check("R = [cos a, -sin a; sin a, cos a]\ntr R = 2 cos a").verdict == "true"
    assert symrot.check("tr == 2*x").verdict == "definition"


@pytest.mark.parametrize(("claim", "instead"), [
    ("tan^-1 x + cot^-1 x = π/2", r"atan\(1/x\) or pi/2"), (r"\cot^{-1} x = \tan^{-1}(1/x)", r"atan\(1/x\) or pi/2"),
    ("acot(x) == atan(1/x)", r"atan\(1/x\) or pi/2"), ("asec(x) == acos(1/x)", r"acos\(1/x\)"), ("arccsc x = 1", r"asin\(1/x\)"),
    (r"\operatorname{arcsec} x = \arccos(1/x)", r"acos\(1/x\)"),
])  # fmt: skip
def test_inverses_on_which_books_disagree_are_asked_about(claim, instead):
    with pytest.raises(InputError, match=f"expected {instead}.* instead of the inverse"):
        symrot.check(claim)


@pytest.mark.parametrize("energy", ["2EI₁", "2EI_1"])
def test_a_letter_before_one_with_an_index_is_a_factor_if_the_text_has_that_letter_elsewhere(energy):
    """Ω₃² of a free body: E I₁ is a product, since I₁ occurs by itself."""
    formula = f"Ω₃² = [(M² − {energy}) − I₂(I₂ − I₁)Ω₂²]/[I₃(I₃ − I₁)]"
    assert symrot.check(formula).verdict == "recognised"
    assert "EI_1" in symrot.check("x = 2EI_1 + y").text
