"""A campaign on claims of other systems' test suites: STACK's AlgEquiv, and SymPy's tests of trigsimp and fu.

``python -m tests.campaigns.checker.peers`` checks the claims of ``peers.toml``, in which each has the verdict that
mathematics gives over the real numbers. It prints how many verdicts are wrong, undecided or refused without need, and
the claims concerned. It exits with 1 if there are any.
"""

import sys
import tomllib
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import symrot
from symrot.errors import InputError

__all__ = ["PeerClaim", "fault_of", "main", "peer_claims"]

CLAIMS = Path(__file__).with_suffix(".toml")

REFUSED = "refused"


@dataclass(frozen=True)
class PeerClaim:
    """A claim with its source and the verdict that it must get; ``reason`` says why, if that is not obvious."""

    source: str
    text: str
    verdict: str
    reason: str


def peer_claims(path: Path = CLAIMS) -> Iterator[PeerClaim]:
    """Yield the claims of a TOML file.

    Raises
    ------
    ValueError
        If a claim that is not simply true comes without a reason, or a verdict is unknown.
    """
    for suite in tomllib.loads(path.read_text(encoding="utf-8"))["suite"]:
        for text, verdict, *reason in suite["claims"]:
            if verdict not in ("true", "false", "conditional", "definition", REFUSED):
                raise ValueError(f"{path.name}: expected a verdict for {text!r}, got {verdict!r}")
            if verdict in ("conditional", REFUSED) and not reason:
                raise ValueError(f"{path.name}: expected a reason why {text!r} is {verdict}")
            yield PeerClaim(suite["source"], text, verdict, "".join(reason))


def verdict_on(claim: PeerClaim) -> tuple[str, str]:
    """Return the verdict on a claim, and the condition that it needs."""
    try:
        verdict = symrot.check(claim.text, repair=False)
    except InputError:
        return REFUSED, ""
    return verdict.verdict, " or ".join(verdict.requires)


def fault_of(claim: PeerClaim, verdict: str, condition: str) -> str:
    """Return what is wrong with a verdict: ``"wrong"``, ``"undecided"``, ``"refused"``, or nothing.

    A conditional claim must get its condition.
    """
    if verdict == claim.verdict:
        return "wrong" if verdict == "conditional" and condition != claim.reason else ""
    return verdict if verdict in ("undecided", REFUSED) else "wrong"


def main(arguments: Sequence[str] = ()) -> int:
    """Check the claims and print the result; return 1 if a verdict is wrong or missing."""
    parser = ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="check only every Nth claim")
    options = parser.parse_args(arguments)
    start, faults, verdicts = perf_counter(), Counter[str](), Counter[str]()
    claims = list(peer_claims())[:: options.every]
    for claim in claims:
        verdict, condition = verdict_on(claim)
        fault = fault_of(claim, verdict, condition)
        verdicts[verdict] += 1
        if fault:
            faults[fault] += 1
            print(f"{fault}: {claim.text} is {verdict} {condition}, not {claim.verdict} ({claim.source})")
    print(", ".join(f"{number} {verdict}" for verdict, number in sorted(verdicts.items())))
    counts = ", ".join(f"{faults[fault]} {fault}" for fault in ("wrong", "undecided"))
    print(f"{len(claims)} claims: {counts}, {faults[REFUSED]} refused without need, {perf_counter() - start:.0f} s")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
