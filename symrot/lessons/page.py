"""The page of a derivation as a lesson: the paragraphs before its steps and after them."""

from collections.abc import Sequence
from dataclasses import fields, replace

from symrot.catalogue import derivation, names
from symrot.errors import InputError
from symrot.lessons.lesson import Lesson
from symrot.lessons.mistakes import mistake_passages
from symrot.lessons.numbers import numbers_of
from symrot.lessons.table import LESSONS
from symrot.proof.page import Figure, Page, Passage, Section, Step, Table

__all__ = ["taught"]


def taught(page: Page, figures: Sequence[Figure] = ()) -> Page:
    """Return a page with its lesson: question, figures, prerequisites in front; numbers, mistake, links at the end.

    ``page`` is the page of a derivation of the catalogue; its lesson is looked up by its name.

    Examples
    --------
    >>> [item.title for item in taught(derivation("poinsot")).closing if isinstance(item, Section)]
    ['With numbers', 'A common mistake', 'Go on']
    """
    lesson = LESSONS[page.name]
    opening: list[Passage | Figure] = [Passage(f"**{lesson.question}**"), *figures, Passage(_before(lesson))]
    beyond = _steps_of(page, lesson.library)
    if beyond:
        opening.append(Passage(_for_the_library(lesson.library)))
    closing: list[Section | Passage] = [
        Section("With numbers"), *numbers_of(page, lesson),
        Section("A common mistake"), *mistake_passages(lesson.mistake),
        Section("Go on"), Passage(_links(page.name, lesson)),
    ]  # fmt: skip
    plain = Page(**{each.name: getattr(page, each.name) for each in fields(Page)})
    return replace(plain, opening=opening, closing=closing, beyond=beyond)


def _before(lesson: Lesson) -> str:
    pages = ", ".join(_link(name) for name in lesson.before)
    return f"**You need before:** {pages or 'vectors, matrices and derivatives; no other page'}."


def _steps_of(page: Page, sections: Sequence[str]) -> int:
    """Return how many steps the sections with the titles ``sections`` of a page have together.

    Raises
    ------
    InputError
        If the page does not have one of the sections.
    """
    counts: dict[str, int] = {}
    title = ""
    for item in page.items:
        if isinstance(item, Section):
            title = item.title
        elif isinstance(item, Step):
            counts[title] = counts.get(title, 0) + 1
        elif isinstance(item, Table):
            counts[title] = counts.get(title, 0) + len(item.steps)
    if not set(sections) <= set(counts):
        missing = [section for section in sections if section not in counts]
        raise InputError(
            f"{page.name}: expected titles of sections with steps on this page, {[*counts]}, got {missing}"
        )
    return sum(counts[section] for section in sections)


def _for_the_library(sections: Sequence[str]) -> str:
    titles = [f'"{section}"' for section in sections]
    if len(titles) == 1:
        return f"A course can leave out the section {titles[0]}: only symrot's numeric code needs it."
    listed = f"{', '.join(titles[:-1])} and {titles[-1]}"
    return f"A course can leave out the sections {listed}: only symrot's numeric code needs them."


def _link(name: str) -> str:
    return f"[{derivation(name).title}]({name}.md)"


def _links(name: str, lesson: Lesson) -> str:
    sentences = []
    if lesson.scene:
        sentences.append(f"See it move: `symrot show {lesson.scene}`.")
    if lesson.kernel:
        sentences.append(f"Compute with it: `symrot emit {lesson.kernel}`.")
    sentences.append(f"Exercises: `symrot exercise {lesson.topic}`.")
    order = names()
    place = order.index(name) + 1
    if place < len(order):
        sentences.append(f"Next page: {_link(order[place])}.")
    return " ".join(sentences)
