"""A claim in LaTeX is answered in LaTeX; reading and repairs, parsed again, are the same equations."""

import pytest

import symrot
from symrot.checker.claim.reader import read_relation
from symrot.checker.claim.tree import text
from symrot.checker.latex.reader import read_latex
from symrot.checker.latex.writing import latex_of, latex_of_text

WRITTEN = (
    ("I_zz == m/12*(a**2 + b**2)", r"I_{zz} = \frac{m}{12} (a^2 + b^2)"),
    ("diff(theta(t), t, t) == -g/l*sin(theta(t))", r"\ddot{\theta} = -\frac{g}{l} \sin(\theta)"),
    ("diff(omega_1(t), t) == (I_2 - I_3)*omega_2*omega_3/I_1",
     r"\dot{\omega}_1 = (I_2 - I_3) \omega_2 \frac{\omega_3}{I_1}"),
    ("sin(x)**2 + cos(2*x)**2 == sqrt(a**(-1))", r"\sin^2(x) + \cos^2(2 x) = \sqrt{a^{-1}}"),
    ("M == Matrix([[a, -b], [c, 1/2]])", r"M = \begin{bmatrix} a & -b \\ c & \frac{1}{2} \end{bmatrix}"),
    ("p_psi == 2*3*pi", r"p_\psi = 2 \cdot 3 \pi"), ("abs(x) == exp(-(a - b)*x)", r"|x| = \exp(-(a - b) x)"),
)  # fmt: skip


@pytest.mark.parametrize(("source", "latex"), WRITTEN)
def test_an_equation_is_written_and_read_back(source, latex):
    relation = read_relation(source)
    assert latex_of(relation) == latex
    assert read_latex(latex).text == " == ".join(map(text, relation[1:]))


@pytest.mark.parametrize("source", ["qmul(p, q) == M[0, 1]", "diff(x(t), t) == x", "x != 0"])
def test_an_equation_that_would_be_read_differently_stays_as_it_is(source):
    assert latex_of(read_relation(source)) is None
    assert latex_of_text(f"{source} with w == 1") == f"{source} with w == 1"


def test_reading_and_repairs_are_in_latex():
    verdict = symrot.check(r"\cos 2\theta = \cos^2\theta + \sin^2\theta")
    assert verdict.text == r"\cos 2\theta = \cos^2\theta + \sin^2\theta"
    assert verdict.reading == r"\cos(2 \theta) = \cos^2(\theta) + \sin^2(\theta)"
    assert verdict.repairs[0].text == r"\cos(2 \theta) = \cos^2(\theta) - \sin^2(\theta)"
    assert symrot.check(verdict.repairs[0].text).verdict == "true"
    assert symrot.check(r"I_{zz} = \frac{m}{12}(a^2 + b^2)").reading == ""
