"""One step of a derivation as a page of its own.

With details, the page also shows expressions that lead from the left side to the right, as many as fit on a screen.
"""

from sympy import MatrixBase, factor

from symrot.errors import InputError
from symrot.exact import normal_form
from symrot.exact.rewriting_chain import Chain, Link, chains
from symrot.proof.notation.mathml import rows
from symrot.proof.notation.printer import formula
from symrot.proof.page import Page, Passage, Section, Step, Table
from symrot.proof.pages.parts import passage_equations

__all__ = ["excerpt"]

LONGEST_IN_TEXT = 100  # letters of LaTeX
LINES = 33  # of a page in detail: a screen
LINE = 62  # letters on a line of a formula
LETTERS = 5000  # of LaTeX on a screen
LEFT_OUT = (
    "does not fit on a screen and is left out: both sides are multiplied out in components, like terms are collected, "
    "and the two normal forms are the same."
)
OTHER_PROOF = (
    "The two sides have different normal forms. They are proven equal by another method, as sums of inverse functions "
    "and of logarithms are, which gives no chain of expressions."
)


def excerpt(whole: Page, number: int, detail: bool = False) -> Page:
    """Return a page with one step of the page ``whole``.

    Parameters
    ----------
    whole : Page
        The page of a derivation.
    number : int
        The number of the step; the first is 1.
    detail : bool
        Whether the new page also shows the calculation from the left to the right side of the step's equation, as far
        as it fits on a screen.

    Raises
    ------
    InputError
        If there is no such step.
    """
    count = len(whole.steps)
    if not isinstance(number, int) or not 1 <= number <= count:
        raise InputError(f"{whole.name}: expected the number of a step from 1 to {count}, got {number!r}")
    step = whole.steps[number - 1]
    page = Page(whole.name, f"{whole.title}: step {number}", whole.source, first=number, file=whole.file)
    place = next(
        n
        for n, item in enumerate(whole.items)
        if any(each is step for each in (item.steps if isinstance(item, Table) else (item,)))
    )
    headings = [item for item in whole.items[:place] if isinstance(item, Section)]
    page.items += [*headings[-1:], step]
    if detail:
        page.items += [Section("In detail"), *_in_detail(step)]
    return page


def _in_detail(step: Step) -> list[Passage]:
    if step.board:
        return _on_board(step)
    return _on_one_screen(_detail(step) if step.relation == "=" else _signs(step))


def _on_board(step: Step) -> list[Passage]:
    """Return the proof of a step as a teacher writes it, as paragraphs: a reason, and the next expression."""
    # the first equation begins with the left side, the others with =
    left = step.named or formula(step.left)
    passages = []
    for words, text in step.board:
        passages.append(Passage(words, ((left, text),)))
        left = ""
    return passages


def _on_one_screen(passages: list[Passage]) -> list[Passage]:
    """Return as many of the first paragraphs as fit on one screen."""
    screen: list[Passage] = []
    lines = letters = 0
    for passage in passages:
        texts = list(passage_equations(passage))
        letters += sum(map(len, texts))
        if letters > LETTERS:
            break
        lines += 2 + sum(len(rows(text, LINE)) + 2 for text in texts)
        if lines > LINES - (2 if passage is not passages[-1] else 0):  # 2 for the sentence on what is left out
            break
        screen.append(passage)
    # a last paragraph says that expressions are left out
    if len(screen) < len(passages):
        screen.append(Passage(f"{'The rest' if screen else 'The calculation'} {LEFT_OUT}"))
    return screen


def _signs(step: Step) -> list[Passage]:
    reduced = normal_form(step.left)
    return [
        Passage("As it was derived, brought to its normal form, and in factors:",
                ((step.left, reduced), ("", factor(reduced)))),
        Passage("Every factor is positive, by the signs of its symbols."),
    ]  # fmt: skip


def _detail(step: Step) -> list[Passage]:
    try:
        rewritings = chains(step.left, step.right, step.hypotheses)
    except ValueError:  # the normal forms differ
        return [Passage(OTHER_PROOF)]
    # a value that comes out in the form in which it is printed, such as that of an integral, is printed once
    passages = [
        Passage(words, ((left, right) if formula(left) != formula(right) else ("", right),))
        for words, left, right in step.via
    ]
    if not rewritings:
        words = "For this reason, both sides are the same expression when they are written out:"
        return [*passages, Passage(words, ((step.named or "", step.left),))]
    if isinstance(step.left, MatrixBase) and (step.named or step.display is not None):
        passages.append(Passage("The two sides as they were derived:", ((formula(step.left), formula(step.right)),)))
    total = 1 if rewritings[0].entry is None else len(step.left)
    if total > len(rewritings):
        passages.append(
            Passage(f"Entries that are the same expression on both sides: {total - len(rewritings)} of {total}.")
        )
    for chain in rewritings:
        passages += _chain(chain)
    return passages


def _chain(chain: Chain) -> list[Passage]:
    start = (
        "From the left side:" if chain.entry is None else f"Entry ({chain.entry[0]}, {chain.entry[1]}), from the left:"
    )
    first, second = chain.links[0].expression, chain.links[1]
    passages = [Passage(f"{start} {_reason(second)}", ((first, second.expression),))]
    for link in chain.links[2:]:
        passages.append(Passage(_capitalized(_reason(link)), (*_subtracted_multiples(link), ("", link.expression))))
    return passages


def _subtracted_multiples(link: Link) -> tuple[tuple[str, str], ...]:
    """Return the products q*b that one step of a rewriting subtracts, each as an equation (LaTeX of q*b, "0").

    b is an expression that is zero by the hypotheses of the proof, and q is a factor. ``link`` is the expression after
    the step, with the pairs (q, b). The result is empty if the products are short enough to stand in the sentence about
    the step, or if nothing is subtracted.
    """
    terms = _terms(link)
    return () if _short(terms) else tuple((term, "0") for term in terms)


def _terms(link: Link) -> list[str]:
    return [rf"({formula(q)}) \cdot ({formula(b)})" for q, b in link.cofactors]


def _short(terms: list[str]) -> bool:
    return sum(map(len, terms)) <= LONGEST_IN_TEXT


def _capitalized(reason: str) -> str:
    return f"{reason[0].upper()}{reason[1:]}" if reason[0] != "$" else reason


def _reason(link: Link) -> str:
    if link.rule:
        return f"with ${formula(link.rule[0])} = {formula(link.rule[1])}$:"
    if link.cofactors:
        terms = _terms(link)
        listed = f", {', '.join(f'${term}$' for term in terms)}" if _short(terms) else ""
        return f"{link.reason} are subtracted{listed}:"
    return f"{link.reason}:"
