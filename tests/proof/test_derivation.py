"""A derivation refuses a step that does not hold, and prints the same page every time."""

from itertools import pairwise

import pytest
from sympy import Eq, Integer, MatMul, Matrix, cos, eye, sin, sqrt

from symrot.errors import InputError
from symrot.exact.decide import decide, is_zero
from symrot.exact.rewriting_chain import chains
from symrot.proof.derivation import Derivation, Passage, ProofError, Section, Step
from symrot.proof.notation.latex_reader import Unread, read
from symrot.proof.notation.mathml import mathml, rows
from symrot.proof.pages.html import prose
from symrot.symbols import A, B, C, delta_1, dphi, omega_1, omega_b, phi, q0, q1, q2, q3, theta, x

UNIT = q0**2 + q1**2 + q2**2 + q3**2 - 1


@pytest.fixture
def page():
    return Derivation("page", title="A page", source="Nobody, *Nothing*, p. 1", about="About $x$.")


def test_a_true_step_is_kept_with_all_that_belongs_to_it(page):
    step = page.step("One.", sin(x) / sin(x) * cos(theta) / sin(theta), cos(theta) / sin(theta), because="both are one",
                     relations=[Eq(q0**2, 1)], source="p. 2")  # fmt: skip
    assert page.steps == (step,)
    assert isinstance(step, Step) and step.reason == "both are one" and step.source == "p. 2"
    assert [str(c) for c in step.conditions] == ["Ne(sin(theta), 0)"]
    assert step.hypotheses == (q0**2 - 1,)


@pytest.mark.parametrize(
    "left, right, relations",
    [
        (sin(2 * x), 2 * sin(x), ()),
        (Matrix([omega_1, 0]), Matrix([omega_1, sin(x)]), ()),
        (q0**2 + q1**2 + q2**2, 1, (UNIT,)),
        (eye(3), 0, ()),
        (sqrt(x**2), x, ()),
    ],
)
def test_a_false_step_cannot_be_built(page, left, right, relations):
    with pytest.raises(ProofError, match=r"page, step 1, 'Wrong.' does not hold: left - right = .* \(at|does not hold"):
        page.step("Wrong.", left, right, because="it is not so", relations=relations)
    assert page.steps == ()


def test_a_false_step_says_where_it_fails(page):
    with pytest.raises(ProofError, match=r"entry \(2, 1\).*entry \(2, 1\): 0 against 1 at x = pi/2"):
        page.step("Wrong.", Matrix([omega_1, 0]), Matrix([omega_1, sin(x)]), because="it is not so")


def test_floats_and_shapes_are_refused(page):
    with pytest.raises(InputError, match="float"):
        page.step("Wrong.", 0.5 * x, x, because="it is not so")
    with pytest.raises(InputError, match="shape"):
        page.step("Wrong.", eye(3), eye(2), because="it is not so")


def test_positive_follows_from_signs_alone(page):
    page.positive("Yes.", (A - C).subs(A, C + delta_1) * B, because="both are")
    for doubtful in (A - B, omega_1**2, -A, A * 0):
        with pytest.raises(ProofError, match="positive"):
            page.positive("No.", doubtful, because="it is not so")


def test_what_is_assumed_once_is_not_repeated(page):
    page.nonzero("There is an inverse,", (x - 1) * (x + 1), "D")
    step = page.step("One.", (x**2 - 1) / (1 - x**2), -1, because="it cancels")
    other = page.step("Two.", 1 / (x - 2), 1 / (x - 2), because="it is the same")
    assert step.conditions == () and len(other.conditions) == 1


def filled(page):
    page.section("Part, one")
    page.passage("Let", (omega_1, dphi), (r"R", eye(3)))
    assert page.define("With 50% of", A, x + 1) == x + 1
    page.step("It is.", sin(phi) ** 2 + cos(phi) ** 2, 1, because="of $[a]_\\times$ & `b_c`", named="s")
    page.step("So.", Matrix([q0**2]), Matrix([1 - q1**2 - q2**2 - q3**2]), because="norm", relations=[UNIT],
              display=MatMul(eye(2), Matrix(omega_b[:2])))  # fmt: skip
    page.positive("And.", A * B, because="both are", named="p")
    return page


def test_the_markdown_page(page):
    text = filled(page).markdown()
    assert text.startswith(
        "# A page\n\nAbout $x$.\n\n*Source:* Nobody, *Nothing*, p. 1.\n\n## Part, one\n\nLet\n\n$$\n"
    )
    assert "$$\n\\omega_{1} = \\dot{\\phi}\n$$" in text
    assert "**1.** It is.\n\n$$\ns = 1\n$$\n\n*Why:* of $`[a]_\\times`$ & `b_c`." in text
    assert "*Given:* $q_{0}^{2} + q_{1}^{2} + q_{2}^{2} + q_{3}^{2} = 1$." in text
    assert "$$\np = A B > 0\n$$" in text
    assert "in kg m^2" in text and "3 steps, each proven" in text
    assert text.count("$$") % 2 == 0 and all(line == line.rstrip() for line in text.splitlines())


def test_the_latex_document(page):
    text = filled(page).latex()
    assert text.startswith(r"\documentclass") and text.endswith("\\end{document}\n")
    assert (
        r"With 50\% of" in text
        and r"\texttt{b\_\allowbreak{}c}" in text
        and r"\emph{Nothing}" in text
        and r"\&" in text
    )
    assert text.count(r"\fitted{") == 6
    assert text.count(r"\left[") == text.count(r"\right]")


def test_items_are_what_was_written(page):
    assert [type(item) for item in filled(page).items] == [Section, Passage, Passage, Step, Step, Step]


def test_the_html_page(page):
    text = filled(page).html()
    assert text.startswith("<!DOCTYPE html>") and text.endswith("</html>\n")
    assert "<h2" in text and "<code>b_c</code>" in text and "<em>Nothing</em>" in text and "&amp;" in text
    assert text.count('<section class="step"') == 3 and "<script" not in text and "src=" not in text
    assert "<mi>θ</mi>" not in text and "<mi>ϕ</mi>" in text
    assert "kg m<sup>2</sup>" in text


def test_one_step_alone(page):
    part = filled(page).part(2)
    assert [type(item) for item in part.items] == [Section, Step] and part.first == 2
    text = part.markdown()
    assert "**2.** So." in text and "**1.**" not in text and "One step, proven" in text
    assert "2.</span>So." in part.html() and r"\paragraph{2.}" in part.latex()
    for wrong in (0, 4, -1, 1.5):
        with pytest.raises(InputError, match=rf"page: expected the number of a step from 1 to 3, got {wrong}"):
            page.part(wrong)


def test_one_step_in_detail(page):
    filled(page)
    scalar, matrix, sign = (page.part(number, detail=True).markdown() for number in (1, 2, 3))
    assert (
        r"With $\sin^{2} \phi = 1 - \cos^{2} \phi$" in scalar or r"with $\sin^{2} \phi = 1 - \cos^{2} \phi$" in scalar
    )
    assert "Entry (1, 1), from the left" in matrix and "q_{0}^{2} = 1 - q_{1}^{2}" in matrix.replace(
        "- q_{1}^{2} - q_{2}^{2} - q_{3}^{2} + 1", "1 - q_{1}^{2}")  # fmt: skip
    assert "Every factor is positive" in sign


HARD = [
    (sin(2 * phi + theta), sin(2 * phi) * cos(theta) + cos(2 * phi) * sin(theta), ()),
    (Matrix([q0**4, q1]), Matrix([(1 - q1**2 - q2**2 - q3**2) ** 2, q1]), (UNIT,)),
    (1 / (1 - cos(theta)), (1 + cos(theta)) / sin(theta) ** 2, ()),
    ((1 - sqrt(A)) * (1 + sqrt(A)) / (1 - A), Integer(1), ()),
    (x**2 * A, B * A, (Eq(x**2, B),)),
    (x * phi**2, phi * C, (x * phi - C, phi * theta - B)),
]


@pytest.mark.parametrize("left, right, relations", HARD)
def test_every_link_of_a_chain_is_proven(left, right, relations):
    found = chains(left, right, relations)
    assert len(found) == 1
    links = found[0].links
    first, last = (links[0].expression, links[-1].expression)
    entries = (left, right) if not isinstance(left, Matrix) else (left[0], right[0])
    assert (first, last) == entries and len(links) >= 2
    for before, after in pairwise(links):
        assert before.expression != after.expression and after.reason
        assert decide(before.expression, after.expression, relations).verdict == "true"
    for link in links:
        if link.rule:
            assert is_zero(link.rule[0] - link.rule[1], relations)
        for _, consequence in link.cofactors:
            assert is_zero(consequence, relations)


def test_a_chain_between_unequal_sides_is_refused():
    with pytest.raises(ValueError, match="expected two sides that are proven equal"):
        chains(sin(x), cos(x))


def test_mathml_of_the_pages_own_latex():
    assert mathml(r"\dot{\theta}") == (
        '<math xmlns="http://www.w3.org/1998/Math/MathML"><mover accent="true"><mi>θ</mi><mo>˙</mo></mover></math>'
    )
    assert "<mfrac><mn>1</mn><mn>2</mn></mfrac>" in mathml(r"\tfrac12 x")
    assert mathml("x_1^2").count("<msubsup>") == 1
    assert mathml("f''").count("′") == 2 and "<mn>2</mn></msup>" in mathml("x'^2")
    assert '<mo form="prefix">−</mo>' in mathml("(-x, y)") and '<mo form="prefix">±</mo>' in mathml(r"u = \pm 1")
    assert 'stretchy="false"' in mathml(r"\left(x_1\right)") and 'stretchy="true"' in mathml(r"\left(\frac12\right)")
    # names of functions are set off from factors, but not from brackets, relations and commas
    assert mathml(r"\operatorname{cn}\operatorname{dn}").count("<mspace") == 1
    assert "<mspace" not in mathml(r"(\tanh, \operatorname{sn}) = 0")
    assert '<mo form="prefix">−</mo>' in mathml("-x") and "<mo>−</mo>" in mathml("x - y")
    for letter, character in {"a": "𝒶", "e": "ℯ", "g": "ℊ", "o": "ℴ", "R": "ℛ", "1": "1"}.items():
        assert f">{character}</mi>" in mathml(rf"\mathcal{{{letter}}}")


@pytest.mark.parametrize(
    "text",
    [
        r"\undefined x",
        r"\frac{1}",
        r"\begin{tikz}x\end{tikz}",
        "{x",
        r"\left( x",
        "x^",
        "}",
        "x^2^3",
        "50%",
        r"\mathbf{\omega}",
        r"\left< x \right>",
        r"x \end{array}",
        r"x \right)",
        r"\mathbf\begin{matrix}x\end{matrix}",
    ],
)
def test_latex_that_is_not_known_is_refused(text):
    with pytest.raises(InputError, match=r"LaTeX|formula"):
        mathml(text)


def test_a_long_sum_is_broken_into_lines():
    text = "y = " + " + ".join(f"x_{n}" for n in range(10)) + " - " + " - ".join("z" * 5 for _ in range(20))
    lines = rows(text, 30)
    assert len(lines) > 3
    assert "".join(item.latex for line in lines for item in line).replace(" ", "") == text.replace(" ", "")
    assert all(sum(item.width for item in line) <= 30 for line in lines)
    assert mathml(text, display=True, width=30).count("<mtr>") == len(lines)


def test_equations_on_the_way_are_proven_and_shown_in_detail(page):
    page.step("It is.", x**2, x * x, because="of powers", via=[("First, with $x$:", x + x, 2 * x)])
    assert "First, with $x$" not in page.markdown()
    text = page.part(1, detail=True).markdown()
    assert "First, with $x$:\n\n$$\n= 2 x\n$$" in text and "both sides are the same expression" in text
    with pytest.raises(ProofError, match=r"It is not.*First.*does not hold"):
        page.step("It is not.", x, x, because="of nothing", via=[("First:", x, 2 * x)])
    assert len(page.steps) == 1


V, DV = Matrix(omega_b), Matrix([dphi, 0, 0])


@pytest.mark.parametrize(
    "text, value",
    [
        (r"\omega \times I\,\omega", V.cross(Matrix.diag(A, B, C) * V)),
        (r"\tfrac12\,\omega \cdot I\,\omega", V.dot(Matrix.diag(A, B, C) * V) / 2),
        (r"|\omega|^2\,\mathbf{1} - \omega\,\omega^{\mathsf T}", V.dot(V) * eye(3) - V * V.T),
        (r"[\omega]_\times^2 + 1", Matrix([[0, -V[2], V[1]], [V[2], 0, -V[0]], [-V[1], V[0], 0]]) ** 2 + eye(3)),
        (r"\left. \frac{\partial}{\partial x} \sin^2 x \right|_{x = 0} + \frac{A}{2 B}", A / (2 * B)),
        (r"\begin{bmatrix} \omega \\ x \end{bmatrix}", Matrix([*V, x])),
        (r"\mathrm{tr}\,I - \det I / (A B)", A + B),
        (r"\dot\omega", DV),
    ],
)
def test_what_a_page_shows_is_read_as_a_person_reads_it(text, value):
    names = {r"\omega": V, "I": Matrix.diag(A, B, C), "A": A, "B": B, "x": x}
    assert decide(read(text, names, {omega_1: dphi}), value).verdict == "true"


@pytest.mark.parametrize(
    "text",
    [
        r"\omega \times",
        r"f(t)",
        "y",
        r"x + \omega",
        r"\omega I",
        r"\frac{x}{0}",
        "x_",
        "{x",
        "",
        "x^I",
        r"\left. x \right|_0",
        r"\left. x \right|_{2 = 0}",
        r"\left. x \right|_{\omega = 0}",
        r"(x]",
        "I + \\omega",
        r"\sqrt[3]{x}",
        "f(x, x)",
        "f()",
        "f(x)",
        r"\sin^\omega x",
        r"\exp I",
        r"\mathrm{vee} \omega",
    ],
)
def test_what_has_no_meaning_is_not_read(text):
    with pytest.raises(Unread):
        read(text, {r"\omega": V, "I": Matrix.diag(A, B, C), "x": x, "f": lambda vector: vector.T})


@pytest.mark.parametrize(
    "named, display",
    [
        (r"\omega \times u", r"u \times \omega"),
        (r"\omega \times u", r"\omega \times \omega"),
        (r"u \times \omega", r"-u \times \omega"),
        (r"u", ""),
        (r"w", r"w \times u, \quad w = 2\,\omega"),
    ],
)
def test_a_page_cannot_show_what_was_not_proven(page, named, display):
    """Both sides of the equation are proven; the LaTeX given for them shows something else."""
    u = Matrix([q1, q2, q3])
    page.notation({r"\omega": V, "u": u})
    good = {"because": "the product is antisymmetric", "named": r"\omega \times u"}
    step = page.step("It turns.", V.cross(u), -u.cross(V), display=r"-u \times w, \quad w = \omega", **good)
    assert step.printed == (True, True)
    with pytest.raises(ProofError, match=r"as displayed|displayed equation .* does not hold"):
        page.step("It turns.", V.cross(u), -u.cross(V), because="of nothing", named=named, display=display or None)
    assert len(page.steps) == 1


def test_a_matrix_shown_as_a_product_is_that_product(page):
    with pytest.raises(ProofError, match="as displayed"):
        page.step("No.", V, Matrix(omega_b), because="of nothing", display=MatMul(2 * eye(3), V))


def test_a_name_is_said_to_be_one(page):
    step = page.step("It is.", 2 * x, x + x, because="of sums", named="\\text{twice}")
    assert step.printed == (False, True)
    assert "in the proof: 1 of 2; the others are names or words" in page.markdown()


def test_a_condition_is_said_once(page):
    root = sqrt(x**2 + phi**2)
    step = page.step("It is.", x / root / (x**2 + phi**2), x / root**3, because="of powers")
    assert [str(c) for c in step.conditions] == ["Ne(phi**2 + x**2, 0)"]


def test_a_long_formula_in_a_sentence_scrolls_by_itself():
    long = " + ".join(f"x_{{{n}}}" for n in range(30))
    assert prose(f"It is ${long}$.").startswith('It is <span class="wide"><math')
    assert "wide" not in prose("It is $x$.")
