"""LaTeX is read as the same equation or refused with a position: nothing is dropped and nothing is guessed."""

import re

import pytest

import symrot
from symrot.checker.latex.reader import Names, read_latex, read_latex_formula
from symrot.errors import InputError
from symrot.latex.tokens import tokens

READINGS = (
    (r"\ddot{\theta} = -\frac{g}{l}\sin\theta", "diff(theta(t), t, t) == -g/l*sin(theta(t))"),
    (r"$\cos 2\theta = 1 - 2\sin^2\theta$.", "cos(2*theta) == 1 - 2*sin(theta)**2"),
    (r"\[ a^{2}_1 = \frac{a_{12}}{2} \]", "a_1**2 == a_12/2"),
    (r"a_1^{2} = \frac{a_{12}}{2}", "a_1**2 == a_12/2"),
    (r"I_1\dot\omega_1 = (I_2-I_3)\omega_2\omega_3 + \tau_1", "I_1*diff(omega_1(t), t) == (I_2 - I_3)*omega_2*omega_3 + tau_1"),
    (r"\dot{\omega}_{1} = \dot{\omega_1}", "diff(omega_1(t), t) == diff(omega_1(t), t)"),
    (r"\frac{d}{dt}\left(\frac{\partial L}{\partial \dot\theta}\right) = 0", "diff(diff(L, diff(theta(t), t)), t) == 0"),
    (r"\frac{d^2\theta}{dt^2}=\ddot\theta", "diff(theta(t), t, t) == diff(theta(t), t, t)"),
    (r"\frac{\mathrm{d}\theta}{\mathrm{d}t}=1", "diff(theta(t), t) == 1"),
    (r"\frac{\partial^2 f}{\partial x\partial y}=1", "diff(diff(f, x), y) == 1"),
    (r"\dfrac12 m v^2 = 1/2 m v^2", "1/2*m*v**2 == 1/2*m*v**2"),
    (r"\begin{pmatrix}c & -s\\ s & c\end{pmatrix}^T = \left[\begin{array}{cc}c & s\\ -s & c\end{array}\right]",
     "Matrix([[c, -s], [s, c]]).T == Matrix([[c, s], [-s, c]])"),
    (r"\begin{vmatrix}a & b\\ c & d\end{vmatrix} = ad - bc", "det(Matrix([[a, b], [c, d]])) == a*d - b*c"),
    (r"\left|\begin{matrix}3\\4\end{matrix}\right| = 5", "sqrt(dot(Matrix([[3], [4]]), Matrix([[3], [4]]))) == 5"),
    (r"x' = x\cos\theta + y\sin\theta", "x_prime == x*cos(theta) + y*sin(theta)"),
    (r"x^{\prime} = x'", "x_prime == x_prime"),
    (r"f'(t) = \dot f", "diff(f(t), t) == diff(f(t), t)"),
    (r"\sin\omega t = \sin(\omega t)", "sin(omega*t) == sin(omega*t)"),
    (r"\sin\theta\,\dot\phi = \dot\phi\sin\theta", "sin(theta)*diff(phi(t), t) == diff(phi(t), t)*sin(theta)"),
    (r"\sin\theta\cos\phi = \tfrac{1}{2}(\sin(\theta+\phi)+\sin(\theta-\phi))",
     "sin(theta)*cos(phi) == 1/2*(sin(theta + phi) + sin(theta - phi))"),
    (r"\tan\frac{\theta}{2} = \frac{\sin\theta}{1+\cos\theta}", "tan(theta/2) == sin(theta)/(1 + cos(theta))"),
    (r"d \cdot 2 = 2d", "d*2 == 2*d"),
    (r"\sqrt[3]{x^3} = |x|", "(x**3)**(1/3) == abs(x)"),
    (r"I_{xx}=\int_{-a/2}^{a/2} \rho x^2\,dx", "I_xx == integrate(rho*x**2, (x, -a/2, a/2))"),
    (r"\int_0^{2\pi}\int_0^R r^3\,dr\,d\theta = \frac{\pi R^4}{2}", "integrate(r**3, (r, 0, R), (theta, 0, 2*pi)) == pi*R**4/2"),
    (r"\int_0^1 \mathrm{d}x = 1", "integrate(1, (x, 0, 1)) == 1"),
    (r"\operatorname{tr}(A) = \mathrm{tr}\,A", "trace(A) == trace(A)"),
    (r"I_{\text{cm}} = I_\mathrm{cm}", "I_cm == I_cm"),
    (r"I_{\mathrm{cm}} = \bar{I}_{1}", "I_cm == I_bar_1"),
    (r"−a·b = -a \times b", "-a*b == -a*b"),
    (r"a/b = \frac{a}{b}", "a/b == a/b"),
    (r"e^{-1} = \frac1e", "e**(-1) == 1/e"),
    (r"\frac{d_1}{d_2} = x^{T/2}", "d_1/d_2 == x**(T/2)"),
    (r"x^a(t) = \frac ab(t)", "x**a*t == a/b*t"),
)  # fmt: skip


@pytest.mark.parametrize(("latex", "text"), READINGS)
def test_latex_is_read_as(latex, text):
    assert read_latex(latex).text == text


@pytest.mark.parametrize(("latex", "text"), READINGS)
def test_no_symbol_is_dropped(latex, text):
    """Every letter of the source outside of commands occurs in the text equally often, except signs of derivatives."""
    latex = re.sub(r"(?<=\\,)d(?=[a-z\\])|_\{?\w+\}?", " ", latex)
    commands = re.sub(
        r"\\(mathrm|operatorname|text)\{?[a-z]*\}?|\\begin\{array\}\{\w*\}|\\(begin|end)\{\w*\}|\\[A-Za-z]+", " ", latex
    )
    letters = [letter for letter in re.findall(r"[A-Za-z]", commands) if letter not in "dfTte"]
    shown = re.sub(r"[a-z]{2,}|Matrix", " ", re.sub(r"_\w+", " ", text))
    for letter in set(letters):
        assert shown.count(letter) >= letters.count(letter), letter


VECTORS = Names(
    symbols={"m", "t", "omega1", "I_2"}, functions={"theta"}, matrices={"omega", "r", "R", "I", "L"}, columns={"omega", "r", "L"},
    others={"T"}, implied=False,
)  # fmt: skip


@pytest.mark.parametrize(("latex", "text"), [
    (r"\mathbf{L} = m\,\mathbf r\times(\boldsymbol\omega\times\mathbf r)", "L == cross(m*r, cross(omega, r))"),
    (r"\vec r\cdot\vec r = |\mathbf r|^2", "dot(r, r) == sqrt(dot(r, r))**2"),
    (r"\|\vec r\| = |R|", "sqrt(dot(r, r)) == det(R)"),
    (r"\omega\cdot I\omega = 2T", "dot(omega, I*omega) == 2*T"),
    (r"\dot{\mathbf R} = \mathbf{R}^{\mathsf T}", "diff(R, t) == R.T"),
    (r"R^{-1}R = R^\top R", "R**(-1)*R == R.T*R"),
    (r"\omega_1 + I_2 = \dot\theta", "omega1 + I_2 == diff(theta(t), t)"),
])  # fmt: skip
def test_declared_names_give_vectors_their_meaning(latex, text):
    assert read_latex(latex, "", VECTORS).text == text


REFUSED = (
    (r"a/b c = 1", 2), (r"\sin\theta/2 = 1", 11), (r"\sin^{-1}x = 1", 1), (r"x_12 = 1", 3), (r"x^10 = 1", 3), (r"\cos(a)^2 = 1", 8),
    (r"\sin\theta\phi = 1", 11), (r"\foo = 1", 1), (r"\sum_i m_i = 1", 1), (r"a = b = c", 7), (r"a \le b", 3),
    (r"a = b \text{ for all } x", 7), (r"\left.x\right|_0 = 1", 6), (r"\frac{d}{dt} R v = 0", 16), (r"\frac{d x}{d t^2} = 1", 1),
    (r"\begin{pmatrix}1&2\\3\end{pmatrix} = 1", 1), (r"\begin{cases}1\end{cases} = 1", 1), (r"(a = b)", 4), (r"a) = b", 2),
    (r"\left(a] = 1", 13), (r"\left(a\right] = 1", 8), (r"\bar{x}(y) = 1", 8), (r"\mathrm\mathrm{tr} = 1", 8), (r"\mathrm{\theta t} = 1", 16), (r"\dot{ab}_1 = 1", 9),
    (r"\frac{a} = b", 10), (r"a^2^3 = b", 4), (r"a_{i,} = \sqrt", 15), (r"x = y!", 6), (r"\mathrm{d}x = 1", 1),
    (r"\int_0^1 x = 1", 12), (r"|x = 1", 4), (r"x2 = 1", 2), ("a = b\n\n§", 8), ("(" * 500 + "a = b", 31), (r"\sin -x = 1", 6),
)  # fmt: skip


@pytest.mark.parametrize(("latex", "position"), REFUSED, ids=[latex[:30] for latex, _ in REFUSED])
def test_what_is_not_understood_is_refused_with_its_place(latex, position):
    with pytest.raises(InputError, match=f"position {position},"):
        read_latex(latex)


@pytest.mark.parametrize(("latex", "words"), [
    (r"\mathbf r\times\mathbf r\times\mathbf r = 0", "brackets"), (r"m\times\mathbf r = 0", "a vector on both sides"),
    (r"\theta'(3) = 0", "a declared function"), (r"m'(t) = 0", "a declared function"), (r"\dot{m} = 0", "to be declared as a function of t"), (r"\vec v = 0", "v to be declared as a vector"),
])  # fmt: skip
def test_vectors_are_refused_where_they_make_no_sense(latex, words):
    with pytest.raises(InputError, match=words):
        read_latex(latex, "", VECTORS)


PAPERS = (  # as books and papers on rotating bodies print them
    (r"I_1\dot\omega_1 - (I_2-I_3)\omega_2\omega_3 = N_1", "I_1*diff(omega_1(t), t) - (I_2 - I_3)*omega_2*omega_3 == N_1"),
    (r"\omega_x = \dot\phi \sin\theta\sin\psi + \dot\theta\cos\psi", "omega_x == diff(phi(t), t)*sin(theta(t))*sin(psi) + diff(theta(t), t)*cos(psi)"),
    (r"T = \tfrac12 I_1(\dot\phi^2\sin^2\theta + \dot\theta^2)", "T == 1/2*I_1*(diff(phi(t), t)**2*sin(theta(t))**2 + diff(theta(t), t)**2)"),
    (r"\frac{d}{dt}\left(\frac{\partial L}{\partial\dot\theta}\right) = \frac{\partial L}{\partial\theta}", "diff(diff(L, diff(theta(t), t)), t) == diff(L, theta(t))"),
    (r"\frac{\mathrm{d}^2\theta}{\mathrm{d}t^2} = -\frac{g}{l}\sin\theta", "diff(theta(t), t, t) == -g/l*sin(theta(t))"),
    (r"\dot{\theta}\left(t\right) = \omega", "diff(theta(t), t) == omega"), (r"\theta''(t) = -\sin\theta(t)", "diff(theta(t), t, t) == -sin(theta(t))"),
    (r"\cos 2\theta = 1 - 2\sin^2\theta", "cos(2*theta) == 1 - 2*sin(theta)**2"), (r"\tan\frac\theta2 = \frac{\sin\theta}{1+\cos\theta}", "tan(theta/2) == sin(theta)/(1 + cos(theta))"),
    (r"I_{xy} = -\int_0^a\!\int_0^b \rho x y \,dx\,dy", "I_xy == -integrate(rho*x*y, (x, 0, b), (y, 0, a))"), (r"\omega^2_x = \omega_{\rm body}", "omega_x**2 == omega_body"),
    (r"x_{1,2} = x_{12}", "x_1_2 == x_12"), (r"\mathcal{L} = T - V", "L_cal == T - V"), (r"\cfrac{1}{2}\,m\,\dot x^2 = E", "1/2*m*diff(x(t), t)**2 == E"),
    (r"\left[\begin{array}{cc}c_\theta&-s_\theta\\s_\theta&c_\theta\end{array}\right] = R", "Matrix([[cos(theta), -sin(theta)], [sin(theta), cos(theta)]]) == R"),
    (r"\det\begin{bmatrix}a&b\\c&d\end{bmatrix} = ad-bc", "det(Matrix([[a, b], [c, d]])) == a*d - b*c"), (r"2\pi r = \frac{2\pi}{\omega}", "2*pi*r == 2*pi/omega"),
)  # fmt: skip
VECTOR_PAPERS = (
    (r"\mathbf I\,\dot{\boldsymbol{\omega}} + \boldsymbol\omega\times\mathbf I\boldsymbol\omega = \boldsymbol\tau", "I*diff(omega, t) + cross(omega, I*omega) == tau"),
    (r"\dot{\mathbf{H}}_G = \boldsymbol\tau", "diff(H_G, t) == tau"), (r"\hat{\mathbf n}\cdot\hat n = 1", "dot(n, n) == 1"), (r"\mathbf r^2 = \|\mathbf r\|^2", "dot(r, r) == sqrt(dot(r, r))**2"),
    (r"[\boldsymbol\omega]_\times\mathbf r = \omega^{\times}\mathbf r", "skew(omega)*r == skew(omega)*r"), (r"\vec{\boldsymbol\omega} = \dot\phi\,\hat n", "omega == diff(phi(t), t)*n"),
    (r"T = \tfrac12\,\boldsymbol\omega^{\mathsf T}\mathbf I\boldsymbol\omega", "T == 1/2*omega.T*I*omega"), (r"\vec n\cdot(\vec r\times\vec\tau) = 0", "dot(n, cross(r, tau)) == 0"),
)  # fmt: skip
WIDER = Names(
    symbols={"m", "t"}, functions={"phi"}, matrices={"omega", "r", "n", "I", "tau", "H_G"}, columns={"omega", "r", "n", "tau", "H_G"}, others={"T"},
    implied=False,
)  # fmt: skip


@pytest.mark.parametrize(("latex", "text"), PAPERS, ids=[latex[:30] for latex, _ in PAPERS])
def test_formulas_of_papers(latex, text):
    assert read_latex(latex).text == text


@pytest.mark.parametrize(("latex", "text"), VECTOR_PAPERS, ids=[latex[:30] for latex, _ in VECTOR_PAPERS])
def test_vector_formulas_of_papers(latex, text):
    assert read_latex(latex, "", WIDER).text == text


@pytest.mark.parametrize(("latex", "words"), [
    (r"\begin{aligned} a &= b \\ c &= d\end{aligned}", "one equation instead of the environment aligned"), (r"\begin{align*}a&=b\end{align*}", "the environment align"),
    (r"a &= b", "at position 3"), (r"a = b \\ c = d", "at position 7"), (r"\Delta\theta = \omega", "for a change"),
    (r"\sin\theta^2 = 1", "brackets around the argument"), (r"f(x) = 1", "a declared function"), (r"\theta(0) = 1", "a declared function"),
    (r"x^{(2)} = 1", "a power like x^2"), (r"a \pm b = c", "at position 3"), (r"\left(\frac{dL}{dt}\right)_{space} = N", "operator or '='"),
])  # fmt: skip
def test_what_reads_in_two_ways_in_papers_is_refused(latex, words):
    with pytest.raises(InputError) as refusal:
        read_latex(latex)
    assert words in str(refusal.value) and "position" in str(refusal.value)


def test_a_formula_without_equals_sign():
    assert read_latex_formula(r"\frac{\dot\theta}{2}") == ("diff(theta(t), t)/2", ())
    with pytest.raises(InputError, match="one formula without '='"):
        read_latex_formula("a = b")


@pytest.mark.parametrize(
    "latex", [r"\frac{" * 3000, "a" * 30_000 + r"\theta = 1", "$", r"\[\]", "{" * 40, r"\dot" * 100 + "x=1"]
)
def test_hostile_latex_is_refused_at_once(latex):
    with pytest.raises(InputError):
        symrot.check(latex)


def test_every_token_is_kept():
    source = r"\left( a \, \quad b \right) % comment"
    assert [token.text for token in tokens(source)] == ["(", "a", r"\,", r"\quad", "b", ")", "% comment", ""]


def test_a_formula_copied_from_a_paper_gets_its_verdict():
    """The claim is the body rates of ZXZ; the second copy has a wrong sign in omega_2."""
    line = r"\left(\dot\phi\sin\theta\cos\psi %s \dot\theta\sin\psi\right)^2 + \left(\dot\phi\sin\theta\sin\psi + \dot\theta\cos\psi\right)^2" \
        r" = \dot\phi^2\sin^2\theta + \dot\theta^2"  # fmt: skip
    assert symrot.check(line % "-").verdict == "true"
    assert symrot.check(line % "+", repair=False).verdict == "false"


def test_latex_in_a_file_of_claims(tmp_path):
    path = tmp_path / "claims.toml"
    path.write_text(
        "schema = 1\n[[claim]]\nid = 'euler'\nsymbols = ['t', 'x', 'y', 'z']\nfunctions = ['theta']\n"
        "define = [['R', 'Rz(theta(t))'], ['omega', 'Matrix([0, 0, diff(theta(t), t)])'], ['r', 'Matrix([x, y, z])']]\n"
        r"latex = '\frac{d}{dt}(\mathbf{R}\vec r) = \boldsymbol\omega\times(\mathbf R\vec r)'",
        encoding="utf-8",
    )
    (verdict,) = symrot.check_file(path)
    assert (verdict.verdict, verdict.text) == ("true", "diff(R*r, t) == cross(omega, R*r)")


@pytest.mark.parametrize(("claim", "verdict"), [
    (r"a\times(b\times c) = b(a\cdot c) - c(a\cdot b)", "true"), (r"a\times(b\times c) = b(a\cdot c) + c(a\cdot b)", "false"),
    (r"v = \omega\times r", "recognised"), (r"M = I\dot\omega + \omega\times I\omega", "recognised"),
    (r"\dot L = M - \omega\times L", "recognised"), (r"a\times a = 0", "true"), (r"a\times a = a^2", "true"),
    (r"a\times b = -b\times a", "true"), (r"2(a\times b + b\times c) = 2b\times(a + c)", "true"),
    (r"a\cdot b = |a||b|\cos\theta", "definition"), (r"|a\times b| = |a||b|\sin\theta", "definition"),
    (r"|a\cdot b| = |a|\cdot|b|", "true"), (r"\hat{\imath}\times\hat{\jmath} = \hat k", "true"), (r"m\times g = mg", "true"), (r"W = F\times d", "definition"),
    (r"A = \frac12 b\times h", "definition"), (r"I = \frac25\times m\times r^2", "recognised"),
])  # fmt: skip
def test_letters_around_a_cross_are_vectors_where_the_text_shows_it(claim, verdict):
    """``a\\times b`` was the product of two numbers, and the rule for a triple product false."""
    assert symrot.check(claim, repair=False).verdict == verdict


def test_powers_of_brackets_and_of_numbers_side_by_side_are_read():
    for claim in (r"\left(a^b\right)^c = a^{bc}", r"(2^n)^2 10^{a} 10^{b} = 2^{2n} 10^{a+b}"):
        assert symrot.check(claim).verdict in ("true", "conditional")


@pytest.mark.parametrize(("latex", "verdict"), [
    (r"\sin(2\theta) = 2 sin\theta cos\theta", "true"), (r"\theta = \arccos\frac{tr(R) - 1}{2}", "recognised"),
    (r"{\rm tr}(AB) = \mathop{\mathrm{tr}}(BA)", "true"), (r"F = 2tr(t)\frac{1}{2}", "definition"),
])  # fmt: skip
def test_functions_spelled_with_letters_are_functions(latex, verdict):
    assert symrot.check(latex, repair=False).verdict == verdict
