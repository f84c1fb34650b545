"""Claims of other systems' test suites: every 16th of them, and the judge of the campaign."""

import pytest

from tests.campaigns.checker.peers import PeerClaim, fault_of, peer_claims, verdict_on

THINNED = list(peer_claims())[::16]


@pytest.mark.parametrize("claim", THINNED, ids=[claim.text[:60] for claim in THINNED])
def test_claims_of_other_systems_get_the_verdict_of_mathematics(claim):
    assert fault_of(claim, *verdict_on(claim)) == ""


@pytest.mark.parametrize(("verdict", "condition", "fault"), [
    ("true", "", "wrong"), ("conditional", "x > 0", "wrong"), ("undecided", "", "undecided"), ("refused", "", "refused"),
    ("conditional", "x >= 0", ""),
])  # fmt: skip
def test_the_campaign_names_a_wrong_or_missing_verdict(verdict, condition, fault):
    claim = PeerClaim("a book", "sqrt(x**2) == x", "conditional", "x >= 0")
    assert fault_of(claim, verdict, condition) == fault


def test_a_conditional_claim_without_its_condition_is_rejected(tmp_path):
    file = tmp_path / "claims.toml"
    file.write_text('[[suite]]\nsource = "a book"\nclaims = [["sqrt(x**2) == x", "conditional"]]\n')
    with pytest.raises(ValueError, match="a reason why"):
        list(peer_claims(file))
