"""Processor time of `symrot check` on typical, naming and conditional claims, each in a process of its own.

    python -m symrot.bench.check [GROUP ..] [--list]

A naming claim is like ``I = 2/5 m r^2``, a conditional one like ``sqrt(x**2) == x``. The times of Python's start,
SymPy's import and the shortest claim are subtracted.
"""

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import NamedTuple

from symrot.errors import InputError, with_hint

__all__ = ["LIMITS", "Timed", "claims", "main", "timed"]

LIMITS = {"typical": 0.5, "naming": 2.0, "conditional": 0.5}
"""Group of claims -> the seconds that a claim may take after the start of Python and the imports."""

SHORTEST = "x == x"
STARTS = 3
"""How often the shortest claim is timed; the least time counts."""


class Timed(NamedTuple):
    """A claim, its verdict, and the seconds of processor time of its process."""

    claim: str
    verdict: str
    seconds: float


def claims(group: str) -> list[str]:
    """Return the claims of a group, ``typical``, ``naming`` or ``conditional`` (see the module's text).

    Raises
    ------
    InputError
        If there is no such group.
    """
    if group not in LIMITS:
        message = f"expected a group of claims, one of {', '.join(LIMITS)}; got {group!r}"
        raise InputError(with_hint(message, group, LIMITS))
    listed: list[str] = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))[group]
    return listed


def timed(claim: str) -> Timed:
    """Check a claim in a new process; return its verdict (``"refused"`` if there is none) and its processor time, s."""
    before = os.times()
    command = [sys.executable, "-m", "symrot", "check", claim, "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    after = os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    verdict = json.loads(done.stdout)[0]["verdict"] if done.returncode in (0, 1) else "refused"
    return Timed(claim, verdict, spent)


def main(arguments: Sequence[str]) -> int:
    """Print the median and the largest time of the claims in each group, and each claim that is slower than its limit.

    ``arguments`` may name the groups; with ``--list`` all claims are printed.
    """
    listing = "--list" in arguments
    groups = [argument for argument in arguments if argument != "--list"] or [*LIMITS]
    lists = {group: claims(group) for group in groups}
    start = min(timed(SHORTEST).seconds for _ in range(STARTS))
    print(f"`symrot check {SHORTEST!r}` takes {start:.2f} s of processor time; time of other claims minus this, s:")
    for group, listed in lists.items():
        rows = [row._replace(seconds=row.seconds - start) for row in map(timed, listed)]
        for row in sorted(rows, key=lambda row: -row.seconds):
            if listing or row.seconds > LIMITS[group]:
                print(f"  {row.seconds:6.2f}  {row.verdict:<12} {row.claim}")
        seconds = [row.seconds for row in rows]
        print(f"{group:<12} {len(rows)} claims: median {median(seconds):.2f}, largest {max(seconds):.2f}; "
              f"limit {LIMITS[group]}")  # fmt: skip
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except InputError as reason:
        print(reason, file=sys.stderr)
        sys.exit(2)
