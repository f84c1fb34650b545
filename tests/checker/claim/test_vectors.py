"""Vectors in bold, with arrows or with hats: identities of vector algebra, unit vectors, tensors, several equations."""

import pytest

import symrot
from symrot.errors import InputError

IDENTITIES = (
    r"\mathbf a\times(\mathbf b\times\mathbf c) = \mathbf b(\mathbf a\cdot\mathbf c) - \mathbf c(\mathbf a\cdot\mathbf b)",
    r"\vec a\cdot(\vec b\times\vec c) = \vec b\cdot(\vec c\times\vec a)",
    r"\vec a\times\vec a = 0",
    r"|\mathbf a\times\mathbf b|^2 = a^2b^2 - (\mathbf a\cdot\mathbf b)^2",
    r"[\omega]_\times\mathbf v = \omega\times\mathbf v",
    r"\tilde{\mathbf a}\,\mathbf b = \mathbf a\times\mathbf b",
    r"[\mathbf a\times]\mathbf b = -[\mathbf b\times]\mathbf a",
    r"\hat n\cdot\hat n = 1",
    r"|q_{1:3}|^2 = q_1^2 + q_2^2 + q_3^2",
    r"\hat{\mathbf n}\times(\hat{\mathbf n}\times\mathbf v) = (\hat{\mathbf n}\cdot\mathbf v)\hat{\mathbf n} - \mathbf v",
    r"[\hat n]_\times^2 = \hat n\hat n^T - I",
    r"[\hat n]_\times^3 = -[\hat n]_\times",
    r"\hat{\mathbf x}\times\hat{\mathbf y} = \hat{\mathbf z}",
    r"\mathbf r\cdot\mathbf I\cdot\mathbf s = \mathbf s\cdot\mathbf I\cdot\mathbf r",
    r"\frac{d}{dt}(\mathbf r\cdot\mathbf r) = 2\,\mathbf r\cdot\dot{\mathbf r}",
    "a × (b × c) = b (a·c) − c (a·b)",
    "n̂×(n̂×v) = (n̂·v) n̂ − v",
    "[a]× b = a × b",
    "(a × b)·(c × d) = (a·c)(b·d) − (a·d)(b·c)",
)

WRONG = (
    r"\mathbf a\times(\mathbf b\times\mathbf c) = \mathbf b(\mathbf a\cdot\mathbf c) + \mathbf c(\mathbf a\cdot\mathbf b)",
    r"\vec a\cdot(\vec b\times\vec c) = \vec b\cdot(\vec a\times\vec c)",
    r"|\mathbf a\times\mathbf b|^2 = a^2b^2 + (\mathbf a\cdot\mathbf b)^2",
    r"[\omega]_\times\mathbf v = \mathbf v\times\omega",
    r"\hat{\mathbf n}\times(\hat{\mathbf n}\times\mathbf v) = (\hat{\mathbf n}\cdot\mathbf v)\hat{\mathbf n} + \mathbf v",
    r"[\hat n]_\times^2 = \hat n\hat n^T + I",
    r"[\hat n]_\times^3 = [\hat n]_\times",
    r"\hat{\mathbf x}\times\hat{\mathbf y} = -\hat{\mathbf z}",
    r"\hat n\cdot\hat n = 2",
    r"\frac{d}{dt}(\mathbf r\cdot\mathbf r) = \mathbf r\cdot\dot{\mathbf r}",
    "a × (b × c) = (a × b) × c",
    "n̂×(n̂×v) = (n̂·v) n̂",
    "[a]× b = b × a",
)


@pytest.mark.parametrize("claim", IDENTITIES)
def test_identities_of_vectors_are_proven(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "true", verdict


@pytest.mark.parametrize("claim", WRONG)
def test_wrong_identities_of_vectors_have_a_counterexample(claim):
    verdict = symrot.check(claim)
    assert verdict.verdict == "false", verdict
    assert verdict.counterexample


def test_a_vector_without_a_hat_may_have_any_length():
    verdict = symrot.check(
        r"\mathbf n\times(\mathbf n\times\mathbf v) = (\mathbf n\cdot\mathbf v)\mathbf n - \mathbf v"
    )
    assert verdict.verdict == "conditional"
    assert verdict.conditions == ("n_x^2 + n_y^2 + n_z^2 = 1",)


@pytest.mark.parametrize(
    "claim", [r"\vec r = 1", "n̂ = 1", r"\mathbf a\times\mathbf b = 5", r"\mathbf a + \mathbf b = 1"]
)
def test_a_vector_is_no_number(claim):
    with pytest.raises(InputError, match="two sides of the same shape"):
        symrot.check(claim)


def test_a_hat_in_a_hypothesis_is_refused():
    with pytest.raises(InputError, match="a vector without a hat here"):
        symrot.check("x = y", assume=["n̂·n̂ = 1"])


def test_the_components_and_hats_of_vectors_are_told():
    verdict = symrot.check(r"\hat n\times\vec v = -\vec v\times\hat n")
    assert verdict
    assert verdict.reading == r"\hat{\mathbf{n}} \times \mathbf{v} = -\mathbf{v} \times \hat{\mathbf{n}}"
    assert verdict.notes == (
        "n and v are vectors with the components n_x, n_y, n_z and so on",
        "n has the length 1, as its hat says",
    )


@pytest.mark.parametrize("claim", [
    r"\mathbf L = \mathbf r\times\mathbf p", r"\mathbf M = I\,\boldsymbol\Omega\times\mathbf p", r"\vec F = m\vec a",
    r"\bar{\mathbf r} = \frac{m_1\mathbf r_1 + m_2\mathbf r_2}{m_1 + m_2}", r"\boldsymbol\tau = \frac{d\mathbf L}{dt}",
    r"T = \tfrac12\boldsymbol\omega\cdot\mathbf L = \tfrac12\boldsymbol\omega^T\mathbf J\boldsymbol\omega", "a . b = 0",
])  # fmt: skip
def test_vectors_without_a_definition_are_not_called_false(claim):
    assert symrot.check(claim).verdict in ("definition", "recognised")


def test_a_chain_in_latex_is_decided_link_by_link():
    good = symrot.check(r"\sin 2x = 2\sin x\cos x = 2\cos x\sin x")
    assert good.verdict == "true"
    bad = symrot.check(r"\sin 2x = 2\sin x\cos x = \cos x\sin x")
    assert bad.verdict == "false"
    assert bad.notes == (r"\sin(2 x) = 2 \sin(x) \cos(x) is true", r"2 \sin(x) \cos(x) = \cos(x) \sin(x) is false")


@pytest.mark.parametrize(("claim", "expected"), [
    (r"\begin{aligned} \sin 2x &= 2\sin x\cos x \\ &= 2\cos x\sin x,\\ \cos^2 x &= 1 - \sin^2 x. \end{aligned}", "true"),
    (r"\begin{align*} \sin 2x &= 2\sin x\cos x \\ \cos^2 x &= 1 + \sin^2 x \end{align*}", "false"),
    (r"\sin^2 x = 1 - \cos^2 x, \quad \tan x = \frac{\sin x}{\cos x}", "true"),
])  # fmt: skip
def test_equations_on_lines_are_decided_one_by_one(claim, expected):
    assert symrot.check(claim).verdict == expected
