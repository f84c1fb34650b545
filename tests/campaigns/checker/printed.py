"""Verdicts of ``symrot check`` on the corpus of printed formulas, against the expected ones.

    python -m tests.campaigns.checker.printed [--workers 2] [--chapter NAME] [--list OUTCOME .. misnamed lost]
        [--slowest 25]

A formula of the corpus has one of these outcomes; the first two are wrong answers:

accused    a correct formula is called false or doubtful
believed   a faulty formula is called true, conditional or recognised
refused    the text, or its context in words, cannot be read
unknown    a correct formula is called a definition or undecided; a faulty one is not called false or doubtful
right      the verdict is the expected one, or another one that the corpus counts as right

Two shares are printed, of the faulty formulas that are called false or doubtful and of all faulty formulas: those whose
diagnosis names the fault of the corpus, and those with the original formula among the three repairs, up to a renaming
of its letters. ``--list misnamed lost`` prints the faulty formulas with another diagnosis, and those without their
original among the repairs. A table counts the formulas of each chapter. ``--slowest N`` prints the N formulas that take
the most processor time.

The command ends with exit code 1 if there is a wrong answer.
"""

import argparse
import re
import sys
import tomllib
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from dataclasses import replace
from itertools import islice, product
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

from sympy import Expr, ImmutableMatrix, acos, asin, atan, atan2

import symrot
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.functions import ROTATIONS
from symrot.checker.claim.reader import readings_of
from symrot.checker.claim.source.lines import claims_of_reading
from symrot.checker.claim.source.text import functions_of_time, is_latex
from symrot.checker.claim.tree import Node, negated
from symrot.checker.claim.tree import product as product_of
from symrot.checker.latex.reader import Names, latex_readings
from symrot.checker.recognition.fingerprint import NotInField, fingerprint
from symrot.checker.recognition.formulas.common_factors import primitive
from symrot.checker.recognition.signature_pairs import pairings
from symrot.checker.recognition.single_faults.letters import is_atom
from symrot.checker.repair.canonical_form import terms_of_equation
from symrot.checker.typed.readings import Declared, Reading
from symrot.errors import SymrotError
from symrot.exact.decide import decide
from symrot.exact.decision import flatten

CORPUS = Path(__file__).parent / "corpus"
OUTCOMES = ("accused", "believed", "refused", "unknown", "right")
SHORTCOMINGS = ("misnamed", "lost")
"""A faulty formula whose diagnosis is another one, and one whose original is not among the repairs."""
GOOD, BAD = ("true", "conditional", "recognised"), ("false", "doubtful")

AGREEING: dict[str, tuple[str, ...]] = {
    "sign": ("sign_of_term", "overall_sign", "inertia_product_sign", "quaternion_product_order", "commutator_order",
             "active_passive_transpose"),
    "factor": ("factor", "half_angle", "double_half_angle"), "missing_square": ("exponent", "factor"), "exponent": ("exponent", "factor"),
    "wrong_denominator": ("factor", "wrong_symbol", "sin_cos_swap", "exponent", "sign_of_term", "extra_term"),
    "half_angle": ("half_angle", "double_half_angle"), "missing_term": ("missing_term", "factor"),
    "swapped_function": ("sin_cos_swap",), "swapped_index": ("wrong_symbol",),
    "wrong_axis": ("wrong_symbol", "wrong_sequence_type"),
    "transposed": ("active_passive_transpose", "commutator_order", "frame_body_space"),
}  # fmt: skip
"""Fault of the corpus -> the codes of diagnoses that name it; any code names "other"."""
MOST_PAIRINGS = 200
"""The most renamings of the letters of a repair that are tried."""


class Judgement(NamedTuple):
    """What ``symrot.check`` says about a formula: outcome, verdict, sentence, time in s, diagnosis and repairs."""

    outcome: str
    verdict: str
    sentence: str
    seconds: float
    code: str = "none"
    repairs: tuple[str, ...] = ()


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


def judged(entry: dict[str, Any]) -> Judgement:
    """Return what the check says about a formula of the corpus."""
    context = {key: entry[key] for key in ("where", "body", "frame", "sequence") if key in entry}
    start = process_time()
    code, repairs = "none", ()
    try:
        verdict = symrot.check(entry["text"], assume=entry.get("given", []), **context)
        word, sentence = verdict.verdict, "; ".join(map(str, verdict.recognised_as)) or verdict.reason
        code, repairs = verdict.diagnosis.code, tuple(repair.text for repair in verdict.repairs)
    except SymrotError as reason:
        word, sentence = "refused", str(reason)
    name = outcome(entry["expected"], word)
    return Judgement(name, word, sentence, process_time() - start, code, repairs)


def names_fault(fault: str, code: str) -> bool:
    """Return whether the code of a diagnosis names a fault of the corpus."""
    return code != "none" and (fault not in AGREEING or code in AGREEING[fault])


def offers(
    repairs: tuple[str, ...], original: str, given: Sequence[str] = (), given_with_original: Sequence[str] = ()
) -> bool:
    """Return whether one of the repairs is proven equal to an equation of the original, under a renaming.

    The names that the hypotheses ``given`` define, such as c1 = cos(alpha), are replaced by their formulas, and in the
    original those of ``given_with_original``.
    """
    return any(
        _direction(repair) == _direction(original)
        and (
            _same_terms(repair, original)
            or any(
                _equal_renamed(mine, other)
                for source in (original, _without_bold(original))
                for mine, other in product(_equations(repair, given), _equations(source, given_with_original))
            )
        )
        for repair in repairs
    )


def _same_terms(repair: str, original: str) -> bool:
    """Return whether two texts are the same equation, up to the order and the side of its terms.

    Rx and R_x are the same rotation.
    """
    forms = []
    for source in (repair, original):
        sides = [map(_with_one_spelling, claim.relation[1:]) for claim in _claims(source) if claim.relation]
        forms.append({terms_of_equation(left, right, lambda tree: False) for left, right in sides})
    return bool(forms[0] & forms[1])


def _with_one_spelling(tree: Node) -> Node:
    """Return a tree in which the rotations about the axes are spelled Rx, Ry and Rz, and Rx(-a) for Rx(a)^T.

    The scalar product of two names is their product: without a mark, the names in ``omega . L`` may be numbers.
    """
    args = tuple(map(_with_one_spelling, tree.args))
    if tree.kind == "call" and tree.value in ROTATIONS:
        return replace(tree, value=str(tree.value).replace("_", ""), args=args)
    if tree.kind == "transpose" and args[0].kind == "call" and args[0].value in ROTATIONS:
        return replace(args[0], args=(negated(args[0].args[0]),))
    if tree.kind == "call" and tree.value == "dot" and all(argument.kind == "name" for argument in args):
        return product_of(list(args))
    return replace(tree, args=args)


def _claims(source: str, given: Sequence[str] = ()) -> list[Claim]:
    """Return the claims of all readings of a text; ``kx`` is a name in one and a product in the other."""
    claims: list[Claim] = []
    functions = functions_of_time(given)
    try:
        if is_latex(source):
            readings = list(latex_readings(source, Names(functions=functions)))
        else:
            readings = list(readings_of(source, declared=Declared(functions=functions)))
    except SymrotError:
        return []
    for reading in readings:
        with suppress(SymrotError):
            for first, *others in claims_of_reading(_as_equations(reading), source, given):
                claims += [first, *others]
                if first.relation is not None:  # a = b = c says that a = c
                    links = [(first.relation[1], link.relation[2]) for link in others if link.relation is not None]
                    claims += [first.with_relation(("==", left, right)) for left, right in links]
    return claims


def _without_bold(source: str) -> str:
    """Return a LaTeX text without bold letters, which plain text does not have; a text with products of vectors stays
    as it is.
    """
    has_products = re.search(r"\\times|\\cdot|\\tilde|\\hat|\^", source) is not None
    return source if has_products else re.sub(r"\\(boldsymbol|mathbf|bm)\b", " ", source)


def _direction(source: str) -> str:
    """Return ">" or "<" for the text of an inequality, and "" for other texts."""
    sign = re.search(r"(>|≥|\\g[et]q?\b)|(<|≤|\\l[et]q?\b)", source)
    return "" if sign is None else ">" if sign[1] else "<"


def _as_equations(reading: Reading) -> Reading:
    """Return a reading with ``==`` in place of the signs of inequalities.

    Two inequalities are compared by the equations in which they end.
    """
    return replace(reading, lines=tuple(replace(line, signs=tuple("==" for _ in line.signs)) for line in reading.lines))


def _equations(source: str, given: Sequence[str] = ()) -> list[list[Expr]]:
    """Return forms of the equations of a text: the entries of both sides, their primitive differences, and others.

    If a side is a name or its rate, the other side alone is a form. So are the differences of the squares: a formula
    for k^2 is the same as one for k.
    """
    forms: list[list[Expr]] = []
    for claim in _claims(source, given):
        assert claim.relation is not None
        try:
            equation = claim.expanded.equation
        except SymrotError:
            continue
        sides = [flatten(equation.left), flatten(equation.right)]
        for own, (entries, _) in zip(claim.relation[1:], reversed(sides), strict=True):
            if _is_name(own):
                forms.append(list(entries))
        (left, shape), (right, own_shape) = sides
        if shape == own_shape:
            forms.append([*left, *right])
            forms.append([primitive(a - b) for a, b in zip(left, right, strict=True)])
            forms.append([primitive(a**2 - b**2) for a, b in zip(left, right, strict=True)])
    return forms


def _is_name(tree: Node) -> bool:
    """Return whether a tree is a name, a function of time, a derivative of one, or R_z(alpha)."""
    while tree.kind == "call" and tree.value == "diff":
        tree = tree.args[0]
    return is_atom(tree) or (tree.kind == "call" and tree.value in ROTATIONS)


def _equal_renamed(first: list[Expr], second: list[Expr]) -> bool:
    if len(first) != len(second):
        return False
    try:
        mine, other = fingerprint([*map(_in_field, first)]), fingerprint([*map(_in_field, second)])
    except NotInField:
        return False
    order = range(len(first))
    if mine.key(None, order) != other.key(None, order):
        return False
    for pairing in islice(pairings(mine, other, order), MOST_PAIRINGS):
        renamed = ImmutableMatrix([entry.xreplace(pairing) for entry in first])
        if any(decide(sign * renamed, ImmutableMatrix(second)).verdict == "true" for sign in (1, -1)):
            return True
    return False


def _in_field(formula: Expr) -> Expr:
    """Return a formula with polynomials in place of inverse functions, for a fingerprint."""
    arcs = formula.atoms(acos, asin, atan, atan2)
    return formula.xreplace({arc: sum((n + 2) * u ** (n + 3) for n, u in enumerate(arc.args)) for arc in arcs})


def _share(flags: list[bool]) -> str:
    return f"{sum(flags)} of {len(flags)} ({100 * sum(flags) / max(1, len(flags)):.0f} %)"


class Diagnosed(NamedTuple):
    """A faulty formula of the corpus: whether its diagnosis names the fault, and whether the original is offered."""

    is_named: bool
    is_offered: bool


def diagnosed(entries: list[dict[str, Any]], results: list[Judgement]) -> dict[str, Diagnosed]:
    """Return, for the id of each faulty formula, what its diagnosis and its repairs are worth."""
    originals = {entry["id"]: entry for entry in formulas("")}
    return {
        entry["id"]: Diagnosed(
            result.verdict in BAD and names_fault(entry["fault"], result.code),
            result.verdict in BAD and _offers_original(result.repairs, entry, originals[entry["original"]]),
        )
        for entry, result in zip(entries, results, strict=True)
        if entry.get("fault")
    }


def _offers_original(repairs: tuple[str, ...], faulty: dict[str, Any], original: dict[str, Any]) -> bool:
    return offers(repairs, original["text"], faulty.get("given", ()), original.get("given", ()))


def _print_diagnoses(entries: list[dict[str, Any]], results: list[Judgement], faulty: dict[str, Diagnosed]) -> None:
    """Print how many diagnoses name the fault, and how many formulas have their original among their repairs."""
    called = [entry["id"] for entry, result in zip(entries, results, strict=True)
              if entry["id"] in faulty and result.verdict in BAD]  # fmt: skip
    for words, chosen in (
        (f"of the faulty formulas called {' or '.join(BAD)}", called),
        ("of all faulty formulas", faulty),
    ):
        print(f"{words}: diagnosis right in {_share([faulty[n].is_named for n in chosen])}, "
              f"original among the repairs in {_share([faulty[n].is_offered for n in chosen])}")  # fmt: skip


def _print_chapters(entries: list[dict[str, Any]], results: list[Judgement], faulty: dict[str, Diagnosed]) -> None:
    """Print, for each chapter, the numbers of correct formulas, of those judged right, and the same of faulty ones."""
    print(f"{'chapter':17}{'correct':>8}{'right':>7}{'faulty':>8}{'right':>7}{'named':>7}{'offered':>9}")
    by_chapter: dict[str, list[tuple[str, bool]]] = {}
    for entry, result in zip(entries, results, strict=True):
        by_chapter.setdefault(entry["id"].partition(".")[0], []).append((entry["id"], result.outcome == "right"))
    for chapter, rows in by_chapter.items():
        good, bad = ([row for row in rows if (row[0] in faulty) == flag] for flag in (False, True))
        counts = (len(good), sum(r for _, r in good), len(bad), sum(r for _, r in bad),
                  sum(faulty[n].is_named for n, _ in bad), sum(faulty[n].is_offered for n, _ in bad))  # fmt: skip
        print(f"{chapter:17}" + "".join(f"{n:{width}}" for n, width in zip(counts, (8, 7, 8, 7, 7, 9), strict=True)))


def main(arguments: list[str] | None = None) -> int:
    """Print the outcomes by chapter, and the formulas with the outcomes that are listed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--chapter", default="")
    parser.add_argument("--list", nargs="*", default=["accused", "believed"], choices=(*OUTCOMES, *SHORTCOMINGS))
    parser.add_argument("--slowest", type=int, default=0, metavar="N")
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
        counts = Counter(result.outcome for _, result in chosen)
        print(f"{group:8}{len(chosen):5}  " + "  ".join(f"{name} {counts[name]}" for name in OUTCOMES))
    faulty = diagnosed(entries, results)
    if faulty:
        _print_diagnoses(entries, results, faulty)
    _print_chapters(entries, results, faulty)
    times = sorted(result.seconds for result in results)
    print(f"slowest {times[-1]:.1f} s, median {times[len(times) // 2]:.2f} s, all {sum(times):.0f} s")
    slow = sorted(zip(entries, results, strict=True), key=lambda pair: -pair[1].seconds)[: options.slowest]
    for entry, result in slow:
        print(f"{result.seconds:6.2f} s  {result.verdict:12}{entry['id']}")
    for entry, result in zip(entries, results, strict=True):
        if result.outcome in options.list:
            line = f"{result.outcome:9}{result.verdict:12}{entry['id']:34}{entry['text']!r:60}"
            print(f"{line}  {result.sentence[:150]}")
        if (own := faulty.get(entry["id"])) is not None and result.verdict in BAD:
            for word, is_right in zip(SHORTCOMINGS, own, strict=True):
                if word in options.list and not is_right:
                    repairs = " | ".join(result.repairs)
                    print(
                        f"{word:9}{entry['fault']:17}{result.code:20}{entry['id']:38}{entry['text']!r}  ->  {repairs}"
                    )
    return int(any(result.outcome in ("accused", "believed") for result in results))


if __name__ == "__main__":
    sys.exit(main())
