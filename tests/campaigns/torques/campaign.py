"""Random torques against the truth: ``python -m tests.campaigns.torques.campaign --count 10000``.

It prints, by family and by method, how many motions were right, how many ended with a message and how many were wrong
without one, with the command that repeats each wrong case; the exit code is 1 if any was wrong.
:mod:`tests.campaigns.torques.verdict` says what right means. With ``--save FILE`` each result is written at once, and
the same command resumes an interrupted campaign.
"""

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from tests.campaigns.torques.cases import OF_TIME, Case, Draw, toml_of
from tests.campaigns.torques.formulas import SWITCHES
from tests.campaigns.torques.pool import run_all
from tests.campaigns.torques.state_cases import OF_STATES
from tests.campaigns.torques.verdict import OUTCOMES, WRONG, Result, grouped, judge

FAMILIES = {**OF_TIME, **OF_STATES}
JUMPING = ("switch_time", "switch_tumbling", "thruster", "dry_friction", "bang_bang", "switch_state")
LIMIT = 60.0  # s
COLUMNS = tuple(OUTCOMES)


def case_of(family: str, index: int, seed: int, methods: tuple[str, ...] = ()) -> Case:
    """Return one case; ``methods``, if given, replace its method by one of them."""
    draw = Draw.new(family, index, seed)
    case = FAMILIES[family][0](draw, family, index, seed)
    if methods and case.method not in (*methods, "function", "table"):
        case.method, case.others = methods[index % len(methods)], []
    return case


def _work(job: tuple[str, int], started: Callable[[], None], seed: int, methods: tuple[str, ...]) -> Result:
    return judge(case_of(*job, seed, methods), started)


def _broken(job: tuple[str, int], why: str, seed: int, methods: tuple[str, ...], limit: float) -> Result:
    case = case_of(*job, seed, methods)
    details = {
        "no end": f"not ended after {limit:g} s",
        "doubt": "the reference did not end",
        "traceback": "the process died",
    }
    detail = details[why]
    return Result(case.key, case.family, case.method, case.shape, why, detail, 0.0, 1.0, limit)


def switches_are_read() -> bool:
    """Return whether formulas may use all functions that jump: a scene that names all of them can be read."""
    import symrot

    text = ("step(t-1)+sign(t)+min(t, 1)+max(t, 1)", "clip(t, 0, 1)+floor(t)+mod(t, 1)", "where(t < 1, 0, 1)")
    scene = {
        "schema": 1, "body": {"principal": [1, 2, 2]}, "initial": {"omega": [0, 0, 0]}, "span": {"t": [0, 1]},
        "torque": [{"kind": "expression", "torque": list(text)}],
    }  # fmt: skip
    try:
        symrot.Scene.from_dict(scene)
    except symrot.InputError:
        return False
    return True


def jobs_of(count: int, families: list[str], seed: int) -> list[tuple[str, int]]:
    """Return (family, index) of every case, in random order."""
    weights = np.array([FAMILIES[name][1] for name in families])
    exact = weights / weights.sum() * count
    counts = np.floor(exact).astype(int)
    for place in np.argsort(counts - exact)[: count - counts.sum()]:
        counts[place] += 1
    jobs = [(name, index) for name, number in zip(families, counts, strict=True) for index in range(number)]
    order = np.random.default_rng(seed).permutation(len(jobs))
    return [jobs[i] for i in order]


class Record:
    """Results of a campaign in a file, one JSON object per line; without a file, no results are kept."""

    def __init__(self, path: str, seed: int, methods: tuple[str, ...]) -> None:
        self.path, self.run = Path(path) if path else None, {"seed": seed, "methods": list(methods)}

    def results(self) -> list[Result]:
        """Return the results of this campaign in the file; a line cut off by an interruption does not count."""
        results = []
        if self.path is not None and self.path.exists():
            for line in self.path.read_text().splitlines():
                try:
                    entry = json.loads(line)
                except json.JSONDecodeError:
                    continue
                if {name: entry.pop(name) for name in self.run} == self.run:
                    results.append(Result(**entry))
        return results

    def add(self, result: Result) -> None:
        if self.path is not None:
            with self.path.open("a") as file:
                file.write("\n" + json.dumps({**self.run, **result._asdict()}))  # a line cut off before stays alone


def table(results: list[Result], by: str) -> list[str]:
    """Return the lines of outcomes by ``family`` or by ``method``."""
    rows = sorted({getattr(r, by) for r in results})
    lines = [f"{by:22}{'cases':>8}" + "".join(f"{name:>12}" for name in COLUMNS)]
    for row in [*rows, "all"]:
        chosen = [r for r in results if row in ("all", getattr(r, by))]
        counts = Counter(r.outcome for r in chosen)
        lines.append(f"{row:22}{len(chosen):8}" + "".join(f"{counts[name] or '-':>12}" for name in COLUMNS))
    return lines


def report(results: list[Result], seed: int, most: int) -> list[str]:
    """Return the lines of the whole report."""
    lines = [*table(results, "family"), "", *table(results, "method"), ""]
    lines += [f"{name:10} {meaning}" for name, meaning in OUTCOMES.items()]
    sentences = Counter(grouped(r.detail) for r in results if r.outcome == "sentence")
    lines += ["", "sentences:"] + [f"{number:6}  {text}" for text, number in sentences.most_common(40)]
    grown = sorted((r for r in results if r.outcome == "growth"), key=lambda r: -r.tolerances / r.growth)
    if grown:
        lines += ["", f"right by growth alone: {len(grown)}; nearest to their limits:"]
        lines += [
            f"  {r.key:24} {r.method:14} {r.tolerances:9.3g} tolerances, growth {r.growth:.3g}, {r.shape}"
            for r in grown[:8]
        ]
    errors = np.array([r.tolerances for r in results if r.outcome == "right"])
    if len(errors):
        lines += ["", f"right: errors in tolerances, median {np.median(errors):.2g}, 95 % {np.quantile(errors, 0.95):.2g}, "
                  f"largest {errors.max():.3g}"]  # fmt: skip
    slowest = sorted(results, key=lambda r: -r.seconds)[:5]
    lines += ["", "slowest:"] + [
        f"  {r.key:24} {r.method:14} {r.seconds:8.2f} s  {r.outcome}, {r.shape}" for r in slowest
    ]
    for outcome in (*WRONG, "warned", "no formula", "doubt"):
        chosen = sorted((r for r in results if r.outcome == outcome), key=lambda r: r.key)
        if chosen:
            lines += ["", f"{outcome}: {len(chosen)}"]
        for r in chosen[:most]:
            lines.append(
                f"  --seed {seed} --case {r.key:22} {r.method:14} {r.shape}: {r.tolerances:.3g} tolerances; {r.detail}"
            )
        if len(chosen) > most:
            lines.append(f"  and {len(chosen) - most} more: raise --list")
    return lines


def main(arguments: list[str] | None = None) -> int:
    """Run the campaign; return 1 if any motion was wrong."""
    parser = argparse.ArgumentParser(description="Random torques against closed forms and references.")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds that a case may take")
    parser.add_argument("--methods", default="", help="comma-separated; default: every method")
    parser.add_argument("--families", default="", help=f"comma-separated, of {', '.join(FAMILIES)}")
    parser.add_argument("--switches", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--list", type=int, default=30, help="how many wrong ones to list")
    parser.add_argument("--save", default="", help="file of results, which an interrupted campaign goes on from")
    parser.add_argument("--case", default="", help="FAMILY:INDEX: one case alone, with its scene")
    options = parser.parse_args(arguments)
    methods = tuple(filter(None, options.methods.split(",")))
    if options.case:
        return _one(options.case, options.seed, methods)
    families = list(filter(None, options.families.split(","))) or list(FAMILIES)
    if unknown := set(families) - set(FAMILIES):
        parser.error(f"--families: expected some of {', '.join(FAMILIES)}, got {', '.join(sorted(unknown))}")
    if not (options.switches and switches_are_read()):
        skipped = [name for name in families if name in JUMPING]
        families = [name for name in families if name not in JUMPING]
        if skipped:
            print(f"skipped, for formulas do not know {', '.join(SWITCHES)}: {', '.join(skipped)}", file=sys.stderr)
    record = Record(options.save, options.seed, methods)
    jobs = jobs_of(options.count, families, options.seed)
    keys = {f"{family}:{index}" for family, index in jobs}
    results = [result for result in record.results() if result.key in keys]
    judged = {result.key for result in results}
    count, jobs = len(jobs), [(family, index) for family, index in jobs if f"{family}:{index}" not in judged]
    began = time.monotonic()
    broken = partial(_broken, seed=options.seed, methods=methods, limit=options.limit)
    work = partial(_work, seed=options.seed, methods=methods)
    for result in run_all(work, jobs, options.workers, options.limit, broken):
        results.append(result)
        record.add(result)
        wrong = sum(r.outcome in WRONG for r in results)
        passed = time.monotonic() - began
        print(f"\r{len(results)} of {count}, {wrong} wrong, {passed:.0f} s", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    print("\n".join(report(results, options.seed, options.list)))
    return int(any(r.outcome in WRONG for r in results))


def _one(key: str, seed: int, methods: tuple[str, ...]) -> int:
    family, _, index = key.partition(":")
    case = case_of(family, int(index), seed, methods)
    print(toml_of(case.problem, case.tolerance))
    print(f"# method {case.method}, samples {case.samples.tolist()}")
    print(f"# dense {case.dense.tolist()}")
    result = judge(case)
    print(f"{result.outcome}: {result.tolerances:.4g} tolerances, growth {result.growth:.3g}; {result.detail}")
    return int(result.outcome in WRONG)


if __name__ == "__main__":
    sys.exit(main())
