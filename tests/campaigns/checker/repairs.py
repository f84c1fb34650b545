"""A campaign against diagnosis: one random fault in a formula of the catalogue; is the original among the repairs?

``python -m tests.campaigns.checker.repairs --count N`` takes the codes of faults in turn, puts a fault into claims of
the catalogue, keeps faults that make a claim false, and asks for repairs. A repair is the original if both sides and
all definitions are proven to have the original's values; ``--faults 2`` makes two faults at once.
"""

import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from random import Random
from statistics import quantiles
from time import perf_counter

from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.claim.tree import Node
from symrot.checker.decide.decision import Decision, decide_equation
from symrot.checker.latex.cursor import MATRIX_CALLS
from symrot.checker.repair.canonical_form import canonical
from symrot.checker.repair.diagnose import diagnose
from symrot.checker.verdict import Repair
from symrot.errors import InputError
from symrot.exact.decide import decide
from tests.campaigns.checker.mutations import MUTATIONS, IsMatrix, mutated, places
from tests.campaigns.checker.repair_claims import catalogue_claims

__all__ = ["Fault", "Outcome", "campaign", "faults", "main", "rank_of"]

MOST_TRIES = 40
"""Claims that are tried for one fault."""


@dataclass(frozen=True)
class Fault:
    """A formula of the catalogue, the formula with a fault, the codes of the mutations, and the verdict on the fault."""

    derivation: str
    original: Claim
    claim: Claim
    codes: tuple[str, ...]
    decision: Decision


@dataclass(frozen=True)
class Outcome:
    """The result of one diagnosis: the rank of the original among the repairs (0: absent), and the time."""

    fault: Fault
    code: str
    repairs: tuple[Repair, ...]
    rank: int
    same_text: bool
    unproven: int
    seconds: float


def matrix_test(claim: Claim) -> IsMatrix:
    """Return a function that says whether a piece of a claim is a matrix, by its form and the definitions."""
    matrices = {name for name, value in claim.definitions.values.items() if getattr(value, "is_Matrix", False)}

    def is_matrix(node: Node) -> bool:
        if node.kind == "name":
            return node.value in matrices
        if node.kind == "call":
            return node.value in MATRIX_CALLS or (node.value == "diff" and is_matrix(node.args[0]))
        return node.kind not in ("index", "list", "number") and any(map(is_matrix, node.args))

    return is_matrix


def faults(count: int, seed: int = 0, at_once: int = 1) -> Iterator[Fault]:
    """Yield claims with faults that are proven false, the codes in turn, the claims and places at random.

    Parameters
    ----------
    count, seed : int
    at_once : int
        Faults in one claim.
    """
    source = Random(seed)
    pool = catalogue_claims()
    for number in range(count):
        for _ in range(MOST_TRIES):
            derivation, original = source.choice(pool)
            codes = [list(MUTATIONS)[number % len(MUTATIONS)]]
            codes += [source.choice(list(MUTATIONS)) for _ in range(at_once - 1)]
            claim = _with_faults(original, codes, source)
            decision = None if claim is None else _decided(claim)
            if claim is not None and decision is not None and decision.verdict == "false":
                yield Fault(derivation, original, claim, tuple(codes), decision)
                break


def _with_faults(original: Claim, codes: Sequence[str], source: Random) -> Claim | None:
    claim = original
    is_matrix = matrix_test(original)
    for code in codes:
        among = places(claim, code, is_matrix)
        if not among:
            return None
        claim = mutated(claim, code, source, is_matrix, among)
    return claim


def _decided(claim: Claim) -> Decision | None:
    try:
        return decide_equation(claim.equation)
    except InputError:
        return None


def campaign(
    count: int, seed: int = 0, at_once: int = 1, progress: Callable[[int], None] = lambda done: None
) -> list[Outcome]:
    """Diagnose claims with faults and return the outcomes."""
    found = []
    for done, fault in enumerate(faults(count, seed, at_once), start=1):
        start = perf_counter()
        diagnosis, repairs = diagnose(fault.claim, fault.decision)
        seconds = perf_counter() - start
        rank, same_text = rank_of(fault, repairs)
        unproven = sum(not _is_true(fault.claim, repair) for repair in repairs)
        found.append(Outcome(fault, diagnosis.code, repairs, rank, same_text, unproven, seconds))
        progress(done)
    return found


def repaired(claim: Claim, repair: Repair) -> Claim:
    """Return the claim that a repair describes: its relation, and the definitions that it changes."""
    equation, _, changed = repair.text.partition(" with ")
    define = dict(claim.define)
    for name in define if changed else ():
        _, found, tail = f", {changed}".partition(f", {name} = ")
        if found:
            ends = [tail.find(f", {other} = ") for other in define if f", {other} = " in tail]
            define[name] = read_expression(tail[: min(ends)] if ends else tail)
    return replace(claim, relation=read_relation(equation), define=tuple(define.items()), sources={"claim": equation})


def _is_true(claim: Claim, repair: Repair) -> bool:
    decision = _decided(repaired(claim, repair))
    return decision is not None and decision.verdict == "true"


def rank_of(fault: Fault, repairs: Sequence[Repair]) -> tuple[int, bool]:
    """Return the rank of the original among repairs, from 1 (0 if absent), and whether a repair is written like it."""
    found = [repaired(fault.claim, repair) for repair in repairs]
    rank = next((rank for rank, claim in enumerate(found, start=1) if _same(fault.original, claim)), 0)
    return rank, any(_written(claim) == _written(fault.original) for claim in found)


def _written(claim: Claim) -> tuple[Node, ...]:
    """Return the trees of a claim, with terms and scalar factors in a fixed order."""
    assert claim.relation is not None
    is_matrix = matrix_test(claim)
    return tuple(canonical(tree, is_matrix) for tree in (*claim.relation[1:], *(tree for _, tree in claim.define)))


def _same(original: Claim, found: Claim) -> bool:
    """Return whether two claims have the same sides and definitions, proven entry by entry."""
    assert original.relation is not None and found.relation is not None
    hypotheses = original.equation.hypotheses
    if _written(original) == _written(found):
        return True
    first, second = original.interpreter(), found.interpreter()
    pairs = [(first.values[name], second.values[name]) for name, _ in original.define]
    try:
        sides = zip(original.relation[1:], found.relation[1:], strict=True)
        pairs += [(first.read(before), second.read(after)) for before, after in sides]
        return all(a == b or decide(a, b, hypotheses).verdict == "true" for a, b in pairs)
    except (InputError, ValueError):
        return False


# -- the command ------------------------------------------------------------------------------------------------------


WIDTHS = (7, 7, 7, 7, 12, 10, 11)


def table(outcomes: Sequence[Outcome]) -> list[str]:
    """Return the lines of a report: per code, how often the original came first, among the first three, or not at all."""
    heads = ("faults", "first", "in 3", "%", "as written", "named so", "no repair")
    lines = [
        f"{'code of the fault':<26}" + "".join(f"{head:>{width}}" for head, width in zip(heads, WIDTHS, strict=True))
    ]
    groups = [(code, [o for o in outcomes if o.fault.codes[0] == code]) for code in MUTATIONS]
    for code, group in (*groups, ("all", list(outcomes))):
        if group:
            first, three = sum(o.rank == 1 for o in group), sum(o.rank > 0 for o in group)
            named, none = sum(o.code == o.fault.codes[0] for o in group), sum(not o.repairs for o in group)
            share, words = f"{100 * three / len(group):.1f}", sum(o.same_text for o in group)
            lines.append(_row(code, (len(group), first, three, share, words, named, none)))
    seconds = sorted(outcome.seconds for outcome in outcomes)
    marks = quantiles(seconds, n=20, method="inclusive") if len(seconds) > 1 else seconds * 19
    slow = sum(second >= 5 for second in seconds)
    lines.append(
        f"seconds per diagnosis: median {marks[9]:.2f}, 95 % {marks[18]:.2f}, most {seconds[-1]:.2f}; {slow} over 5 s"
    )
    counted = Counter(outcome.rank for outcome in outcomes)
    ranks = ", ".join(
        f"{name} {counted[rank]}" for rank, name in ((1, "first"), (2, "second"), (3, "third"), (0, "none"))
    )
    offered = sum(len(outcome.repairs) for outcome in outcomes)
    lines.append(f"the original: {ranks}")
    lines.append(f"repairs offered {offered}, not proven {sum(outcome.unproven for outcome in outcomes)}")
    return lines


def _row(label: str, cells: Sequence[object]) -> str:
    return f"{label:<26}" + "".join(f"{cell:>{width}}" for cell, width in zip(cells, WIDTHS, strict=True))


def main(argv: Sequence[str] | None = None) -> int:
    """Run a campaign; exit with 1 if a repair is not true, or the original is too rarely among the first three."""
    parser = ArgumentParser(prog="python -m tests.campaigns.checker.repairs", description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=150, help="faults (default: 150)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--faults", type=int, default=1, choices=(1, 2), help="faults in one claim (default: 1)")
    parser.add_argument("--missed", action="store_true", help="show claims whose original was not offered so")
    options = parser.parse_args(argv)
    show = _shown_progress if sys.stderr.isatty() else lambda done: None
    outcomes = campaign(options.count, options.seed, options.faults, show)
    pool = catalogue_claims()
    derivations = len({name for name, _ in pool})
    print(f"{len(pool)} claims of {derivations} derivations, {len(outcomes)} faults, each proven false")
    for line in table(outcomes):
        print(line)
    for outcome in outcomes if options.missed else ():
        if not (outcome.rank and outcome.same_text):
            _show(outcome)
    found = sum(outcome.rank > 0 for outcome in outcomes)
    wanted = 0.9 if options.faults == 1 else 0.0
    return int(any(outcome.unproven for outcome in outcomes) or found < wanted * len(outcomes))


def _show(outcome: Outcome) -> None:
    fault = outcome.fault
    codes = ", ".join(fault.codes)
    print(f"\n{fault.original.id}: {codes}; {outcome.seconds:.2f} s")
    definitions = [f"{name} = {_differing(fault, name)}" for name, _ in fault.claim.define if _differing(fault, name)]
    for label, text in (("was", fault.original.text), ("is", fault.claim.text)):
        print(f"  {label:<4}{text[:300]}")
    for line in (*definitions, *(f"{repair.code} {repair.cost}: {repair.text}" for repair in outcome.repairs)):
        print(f"      {line[:300]}")


def _differing(fault: Fault, name: str) -> str:
    from symrot.checker.claim.tree import text

    before, after = dict(fault.original.define)[name], dict(fault.claim.define)[name]
    return "" if before == after else f"{text(before)} -> {text(after)}"


def _shown_progress(done: int) -> None:
    sys.stderr.write(f"\r{done}")


if __name__ == "__main__":
    sys.exit(main())
