"""Verdicts of ``symrot check`` on the corpus of printed formulas, against the expected ones.

    python -m tests.campaigns.checker.printed [--workers 2] [--chapter NAME] [--list OUTCOME ..]

A formula of the corpus has one of these outcomes; the first two are wrong answers:

accused    a correct formula is called false or doubtful
believed   a faulty formula is called true, conditional or recognised
refused    the text, or its context in words, cannot be read
unknown    a correct formula is called a definition or undecided; a faulty one is not called false or doubtful
right      the verdict is the expected one, or one that the corpus counts as right in its place

The command ends with exit code 1 if there is a wrong answer.
"""

import argparse
import sys
import tomllib
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from time import process_time
from typing import Any

import symrot
from symrot.errors import SymrotError

CORPUS = Path(__file__).parent / "corpus"
OUTCOMES = ("accused", "believed", "refused", "unknown", "right")
GOOD, BAD = ("true", "conditional", "recognised"), ("false", "doubtful")


def formulas(chapter: str = "") -> list[dict[str, Any]]:
    """Return the entries of the corpus, or those of one chapter."""
    files = sorted(CORPUS.glob("*.toml"))
    tables = [tomllib.loads(path.read_text("utf-8")) for path in files if not chapter or path.stem == chapter]
    return [entry for table in tables for entry in table["formula"]]


def outcome(expected: str, verdict: str) -> str:
    """Return the outcome of a formula with an expected and a given verdict ("refused" for a text that is not read)."""
    if verdict == "refused":
        return "refused"
    correct = expected not in BAD
    if correct and verdict in BAD:
        return "accused"
    if not correct and verdict in GOOD:
        return "believed"
    right = verdict in GOOD if expected in GOOD else verdict == expected if correct else verdict in BAD
    return "right" if right else "unknown"


def judged(entry: dict[str, Any]) -> tuple[str, str, str, float]:
    """Return a formula's outcome, verdict, sentence and processor time, s."""
    context = {key: entry[key] for key in ("where", "body", "frame", "sequence") if key in entry}
    start = process_time()
    try:
        verdict = symrot.check(entry["text"], assume=entry.get("given", []), **context)
        word, sentence = verdict.verdict, "; ".join(map(str, verdict.recognised_as)) or verdict.reason
    except SymrotError as reason:
        word, sentence = "refused", str(reason)
    name = outcome(entry["expected"], word)
    return name, word, sentence, process_time() - start


def main(arguments: list[str] | None = None) -> int:
    """Print the outcomes by chapter, and the formulas with the outcomes that are listed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--chapter", default="")
    parser.add_argument("--list", nargs="*", default=["accused", "believed"], choices=OUTCOMES)
    options = parser.parse_args(arguments)
    entries = formulas(options.chapter)
    with ProcessPoolExecutor(options.workers) as pool:
        results = list(pool.map(judged, entries, chunksize=8))
    for group in ("correct", "faulty"):
        chosen = [
            (entry, result)
            for entry, result in zip(entries, results, strict=True)
            if (entry["expected"] in BAD) == (group == "faulty")
        ]
        counts = Counter(result[0] for _, result in chosen)
        print(f"{group:8}{len(chosen):5}  " + "  ".join(f"{name} {counts[name]}" for name in OUTCOMES))
    print(
        f"slowest {max(seconds for *_, seconds in results):.1f} s, all {sum(seconds for *_, seconds in results):.0f} s"
    )
    for entry, (name, word, sentence, _) in zip(entries, results, strict=True):
        if name in options.list:
            print(f"{name:9}{word:12}{entry['id']:34}{entry['text']!r:60}  {sentence[:150]}")
    return int(any(name in ("accused", "believed") for name, *_ in results))


if __name__ == "__main__":
    sys.exit(main())
