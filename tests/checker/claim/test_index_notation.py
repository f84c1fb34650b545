"""Index notation with delta and epsilon, compared with sums that NumPy's einsum makes of whole numbers."""

import numpy as np
import pytest

import symrot
from symrot.errors import InputError

DELTA = np.eye(3, dtype=int)
EPSILON = np.array([[[(j - i) * (k - j) * (k - i) // 2 for k in range(3)] for j in range(3)] for i in range(3)])
A, B, C = np.array([1, 2, 5]), np.array([-3, 1, 7]), np.array([2, 9, -4])


def summed(rule, *factors):
    return np.einsum(rule, *factors)


CASES = (
    (r"\epsilon_{ijk}\epsilon_{ijk} = 6", summed("ijk,ijk", EPSILON, EPSILON) - 6),
    (r"\epsilon_{ijk}\epsilon_{ijk} = 3", summed("ijk,ijk", EPSILON, EPSILON) - 3),
    (r"\delta_{ii} = 3", summed("ii", DELTA) - 3),
    ("ε_ijk ε_ilm = δ_jl δ_km - δ_jm δ_kl", summed("ijk,ilm->jklm", EPSILON, EPSILON)
     - summed("jl,km->jklm", DELTA, DELTA) + summed("jm,kl->jklm", DELTA, DELTA)),
    ("ε_ijk ε_ilm = δ_jl δ_km + δ_jm δ_kl", summed("ijk,ilm->jklm", EPSILON, EPSILON)
     - summed("jl,km->jklm", DELTA, DELTA) - summed("jm,kl->jklm", DELTA, DELTA)),
    (r"\varepsilon_{imn}\varepsilon_{jmn} = 2\delta_{ij}", summed("imn,jmn->ij", EPSILON, EPSILON) - 2 * DELTA),
    (r"\epsilon_{ijk} a_j a_k = 0", summed("ijk,j,k->i", EPSILON, A, A)),
    ("ε_ijk a_j b_k = ε_ijk b_j a_k", summed("ijk,j,k->i", EPSILON, A, B) - summed("ijk,j,k->i", EPSILON, B, A)),
    ("ε_ijk a_i b_j c_k = ε_ijk b_i c_j a_k",
     summed("ijk,i,j,k", EPSILON, A, B, C) - summed("ijk,i,j,k", EPSILON, B, C, A)),
)  # fmt: skip


@pytest.mark.parametrize(("text", "difference"), CASES, ids=[text for text, _ in CASES])
def test_an_identity_is_decided_by_its_components(text, difference):
    assert symrot.check(text).verdict == ("false" if np.any(difference) else "true")


@pytest.mark.parametrize("text", [
    r"R_{ik} R_{jk} = \delta_{ij}", r"\epsilon_{ijk} a_j b_k = 0", r"I_{ij} = m(r^2 \delta_{ij} - x_i x_j)",
    r"\delta_{ij} \sigma_{ij} = 0",
])  # fmt: skip
def test_a_condition_or_a_formula_for_a_tensor_is_not_false(text):
    assert symrot.check(text).verdict == "definition"


@pytest.mark.parametrize(("text", "verdict"), [
    ("v_i = ε_ijk ω_j r_k", "recognised"), ("I_ij = ∫(r² δ_ij - x_i x_j) dm", "recognised"),
    (r"I_{ij} = \int \rho (x_k x_k\delta_{ij} - x_i x_j)\,dV", "recognised"),
    ("I_ij = ∫(r² δ_ij + x_i x_j) dm", "definition"), ("(a × b)_i = ε_ijk a_j b_k", "true"),
    (r"(\mathbf a\times\mathbf b)_i = \epsilon_{ijk} a_k b_j", "false"),
    ("R_ij = cos θ δ_ij + (1 - cos θ) n_i n_j - sin θ ε_ijk n_k", "recognised"),
])  # fmt: skip
def test_a_formula_for_components_is_one_for_the_whole_quantity(text, verdict):
    assert symrot.check(text, repair=False).verdict == verdict


def test_the_indices_are_named_in_a_note():
    assert any("j, k, l, m take every value" in note for note in symrot.check(CASES[3][0]).notes)


@pytest.mark.parametrize(("text", "words"), [
    (r"\delta_{ij} a_i b_j = \delta_{ij} a_i b_i", "at most twice in a term, got i 3 times"),
    (r"\delta_{ij} a_j b_k= \delta_{ij} a_j b_l", "the same free indices in each term"),
])  # fmt: skip
def test_indices_that_do_not_fit_are_refused(text, words):
    with pytest.raises(InputError, match=words):
        symrot.check(text)
