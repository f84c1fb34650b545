"""LaTeX as lectures, papers and posts have it: short forms, macros, both signs, and texts with two readings."""

import pytest

import symrot
from symrot.checker.claim.tree import text
from symrot.checker.latex.reader import Names, latex_readings, read_latex
from symrot.errors import InputError


def equations(latex):
    """The equations of the usual reading of a text in LaTeX, as SymPy's text."""
    return [
        f" {chain.signs[0]} ".join(map(text, chain.sides)) for chain in latex_readings(latex)[0].lines
    ]  # fmt: skip


SHORT = (
    (r"x = c_\theta s_\theta", ["x == cos(theta)*sin(theta)"]), (r"x = c\psi\,s\psi", ["x == cos(psi)*sin(psi)"]),
    (r"x = C_\alpha + S_\beta", ["x == cos(alpha) + sin(beta)"]), (r"c^2_\theta + s_\theta^2 = 1", ["cos(theta)**2 + sin(theta)**2 == 1"]),
    (r"c^2\theta + s^{2}\theta = 1", ["cos(theta)**2 + sin(theta)**2 == 1"]),
    (r"c_{12} = c_1 c_2 - s_1 s_2", ["cos(theta_1 + theta_2) == cos(theta_1)*cos(theta_2) - sin(theta_1)*sin(theta_2)"]),
    (r"x = l_1 c_1 + l_2 c_{12}, y = l_1 s_1 + l_2 s_{12}",
     ["x == l_1*cos(theta_1) + l_2*cos(theta_1 + theta_2)", "y == l_1*sin(theta_1) + l_2*sin(theta_1 + theta_2)"]),
    (r"c_1 q_1 + c_2 s_1 + s_2 = 0", ["cos(q_1)*q_1 + cos(q_2)*sin(q_1) + sin(q_2) == 0"]),
    (r"x = k^2 v\theta + c\theta - k s\theta", ["x == k**2*(1 - cos(theta)) + cos(theta) - k*sin(theta)"]),
)  # fmt: skip


@pytest.mark.parametrize(("latex", "full"), SHORT)
def test_short_forms_of_cosines_and_sines_are_read_and_said(latex, full):
    first, second, *more = latex_readings(latex)
    assert equations(latex) == full and not more
    assert any("cos(" in note or "sin(" in note for note in first.notes)
    assert "cos" not in " ".join(text(side) for side in second.lines[0].sides)
    assert second.flipped


@pytest.mark.parametrize("latex", [
    r"c_\psi = 3", r"c_1 = k", r"c_1 x + s_1 y = p", r"c_\theta + s_\theta = c", r"c_\omega + s_\omega = 1", r"s = c_\theta s_\theta",
    r"c_1\alpha_1 + c_2\beta_2 + s_1 + s_2 = 0", r"c_v + s_p = 1",
])  # fmt: skip
def test_other_letters_c_and_s_stay_names(latex):
    assert not any(f"{name}(" in equation for equation in equations(latex) for name in ("cos", "sin"))


def test_declared_letters_c_and_s_stay_names():
    names = Names(symbols={"c_theta", "s_theta", "x"}, implied=False)
    assert read_latex(r"x = c_\theta s_\theta", "", names).text == "x == c_theta*s_theta"


LONGER = (
    (r"\begin{equation} \label{eq:a_b} T = \frac12 m v^2 \tag{3.5}\end{equation}", ["T == 1/2*m*v**2"]),
    (r"\begin{equation}\begin{aligned} a &= b + c \\ &= d, \\ e &= f - g \\ & + h. \end{aligned}\end{equation}",
     ["a == b + c == d", "e == f - g + h"]),
    (r"\boxed{a = b}", ["a == b"]), (r"x = \underbrace{m g}_{\text{weight}} + \cancel{y}", ["x == m*g + y"]),
    (r"\dv[2]{x}{t} = -\omega^2 x", ["diff(x(t), t, t) == -omega**2*x(t)"]), (r"\dv{t} (x y) = z", ["diff(x*y, t) == z"]),
    (r"\pdv{f}{x} = 2", ["diff(f, x) == 2"]), (r"\pdv{f}{x}{y} = 2", ["diff(diff(f, x), y) == 2"]),
    (r"\int_0^1 x \dd{x} = \frac12", ["integrate(x, (x, 0, 1)) == 1/2"]), (r"\abs{x} = \nicefrac{1}{2}", ["abs(x) == 1/2"]),
    (r"a \coloneqq b \Rightarrow c = d", ["a == b", "c == d"]), (r"a &= b \\ c &= d", ["a == b", "c == d"]),
    (r"a = b \text{ and } c = d", ["a == b", "c == d"]), (r"\vb{a}\vdot\vb*{b} = p", ["dot(a, b) == p"]),
    (r"\omega_{\max} = \omega_{x_1x_1} + \Delta t", ["omega_max == omega_x1x1 + Delta_t"]),
    (r"\theta = \operatorname{Atan2}(y, x)", ["theta == atan2(y, x)"]), (r"\iint_0^1 x \dd x \dd y = z".replace("iint_0^1", r"int_0^1\int_0^1"),
     ["integrate(x, (x, 0, 1), (y, 0, 1)) == z"]),
    (r"\sin(x)/2 = y", ["sin(x)/2 == y"]), (r"\cos(x)^2 = y", ["cos(x)**2 == y"]), (r"\cos -x = y", ["cos(-x) == y"]),
    (r"\omega_\pm = a \pm b \mp c", ["omega_plus == a + b - c", "omega_minus == a - b + c"]),
    (r"[M_3(\theta)] = \begin{bmatrix} \theta & 1 \\ 1 & \theta\end{bmatrix}", ["M_3 == Matrix([[theta, 1], [1, theta]])"]),
    (r"f(x, y) = x^2 + y", ["f == x**2 + y"]), (r"R(q) = \frac{q}{2}", ["R == q/2"]),
)  # fmt: skip


@pytest.mark.parametrize(("latex", "full"), LONGER)
def test_latex_of_papers_is_read(latex, full):
    assert equations(latex) == full


TWO = (
    (r"\theta = \cos^{-1} x", "theta == acos(x)", "theta == cos(x)**(-1)"), (r"y = \sin\theta^2", "y == sin(theta**2)", "y == sin(theta)**2"),
    (r"y = \sin\theta(a + b)", "y == sin(theta)*(a + b)", "y == sin(theta*(a + b))"),
    (r"y = \cos kx", "y == cos(k*x)", "y == cos(k)*x"), (r"y = \sin\theta\phi", "y == sin(theta)*phi", "y == sin(theta*phi)"),
    (r"y = \cos\theta/2", "y == cos(theta/2)", "y == cos(theta)/2"), (r"y = \sin\theta/I", "y == sin(theta)/I", "y == sin(theta/I)"),
    (r"y = a/b c", "y == a/b*c", "y == a/(b*c)"), (r"T = p^2/2m", "T == p**2/(2*m)", "T == p**2/2*m"),
    (r"W = M\Delta\theta", "W == M*Delta_theta", "W == M*Delta*theta"),
)  # fmt: skip


@pytest.mark.parametrize(("latex", "usual", "other"), TWO)
def test_latex_with_two_readings_has_both_the_usual_one_first(latex, usual, other):
    assert [" == ".join(map(text, reading.lines[0].sides)) for reading in latex_readings(latex)] == [usual, other]
    with pytest.raises(InputError):
        read_latex(latex)


def test_the_other_reading_of_latex_is_told_if_its_verdict_differs():
    verdict = symrot.check(r"\cos^{-1}(x)\cos x = 1")
    assert verdict.verdict == "false"
    assert any(r"\cos^{-1}" in note and "it is true" in note for note in verdict.notes)


def test_a_note_quotes_the_first_short_form():
    notes = symrot.check(r"2 s_\theta^2 + 2 c_\theta^2 = 2").notes
    assert notes[0] == r"s_\theta is read as sin(theta), and similar short forms likewise"
    assert notes[1].startswith(r"'s_\theta' can be read in two ways")


def test_words_after_an_equation_are_left_out_with_a_note():
    verdict = symrot.check(r"\sin 2x = 2\sin x\cos x \quad \text{for all } x")
    assert verdict.verdict == "true"
    assert any(r"\text{for all } x is not read" in note for note in verdict.notes)


@pytest.mark.parametrize(("latex", "words"), [
    (r"x \approx y", "'=' and the value to as many digits"), (r"\SI{3}{m} = x", "the number without its unit"), (r"\nabla f = 1", "derivatives"),
    (r"\log x = y", r"\ln"), (r"a = b + \ldots", "all terms"),
])  # fmt: skip
def test_a_refusal_says_what_to_write(latex, words):
    with pytest.raises(InputError) as refusal:
        symrot.check(latex)
    assert words in str(refusal.value)
