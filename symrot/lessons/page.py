"""The page of a derivation as a lesson: the paragraphs before its steps and after them.

The steps that only symrot's numeric code needs are on an appendix, a page of their own.
"""

from collections.abc import Sequence
from dataclasses import fields, replace

from symrot.catalogue import derivation, names
from symrot.errors import InputError
from symrot.lessons.lesson import Lesson
from symrot.lessons.mistakes import mistake_passages
from symrot.lessons.numbers import numbers_of
from symrot.lessons.table import LESSONS
from symrot.proof.page import Figure, Page, Passage, Section, Step, Table

__all__ = ["APPENDIX", "appendix", "taught"]

APPENDIX = "_appendix"
"""The name of an appendix is the name of its derivation with this ending, such as ``driven_rotation_appendix``."""

Items = list[Section | Passage | Step | Table | Figure]


def taught(page: Page, figures: Sequence[Figure] = ()) -> Page:
    """Return a page with its lesson: question, figures, prerequisites in front; numbers, mistake, links at the end.

    Raises
    ------
    InputError
        If the sections for the numeric code are not the last sections of the page.

    Examples
    --------
    >>> [item.title for item in taught(derivation("poinsot")).closing if isinstance(item, Section)]
    ['With numbers', 'A common mistake', 'Go on']
    """
    lesson = LESSONS[page.name]
    opening: list[Passage | Figure] = [Passage(f"**{lesson.question}**"), *figures, Passage(_before(lesson))]
    course, library = _divided(page, lesson.library)
    if library:
        opening.append(Passage(_to_the_appendix(page, course, library)))
    closing: list[Section | Passage] = [
        Section("With numbers"), *numbers_of(page, lesson),
        Section("A common mistake"), *mistake_passages(lesson.mistake),
        Section("Go on"), Passage(_links(page.name, lesson)),
    ]  # fmt: skip
    return replace(_plain(page), items=course, opening=opening, closing=closing)


def appendix(page: Page) -> Page | None:
    """Return the page with the steps that only symrot's numeric code needs, or None if there are none.

    Raises
    ------
    InputError
        If the sections for the numeric code are not the last sections of the page.

    Examples
    --------
    >>> appendix(derivation("elliptic_functions")).title
    "Jacobi's elliptic functions by their derivatives: for the numeric code"
    >>> appendix(derivation("poinsot")) is None
    True
    """
    course, library = _divided(page, LESSONS[page.name].library)
    if not library:
        return None
    about = (
        f"This page continues {_link(page.name)}, with the notation and the results of that page. Only symrot's "
        "numeric code needs its steps; a course can leave them out."
    )
    # the steps keep their numbers: if 8 steps stay on the page, the appendix begins with step 9
    first = page.first + len(replace(_plain(page), items=course).steps)
    title = f"{page.title}: for the numeric code"
    return replace(_plain(page), name=f"{page.name}{APPENDIX}", title=title, about=about, items=library, first=first)


def _plain(page: Page) -> Page:
    return Page(**{each.name: getattr(page, each.name) for each in fields(Page)})


def _before(lesson: Lesson) -> str:
    pages = ", ".join(_link(name) for name in lesson.before)
    return f"**You need before:** {pages or 'vectors, matrices and derivatives; no other page'}."


def _divided(page: Page, sections: Sequence[str]) -> tuple[Items, Items]:
    """Return the items of a page before the sections with the titles ``sections``, and the items in these sections.

    Raises
    ------
    InputError
        If the sections are not the last sections of the page.
    """
    titles = [item.title for item in page.items if isinstance(item, Section)]
    if [*sections] != titles[len(titles) - len(sections) :]:
        raise InputError(
            f"{page.name}: expected as `library` of the lesson the titles of the last sections of the page, in order, "
            f"got {[*sections]}; the titles of all sections are {titles}"
        )
    places = (n for n, item in enumerate(page.items) if isinstance(item, Section) and item.title in sections)
    place = next(places, len(page.items))
    return page.items[:place], page.items[place:]


def _to_the_appendix(page: Page, course: Items, library: Items) -> str:
    """Return the sentence in a lesson that links to its appendix, such as "Steps 7 to 9, .., are on a page of their
    own."
    """
    before, count = (len(Page("", "", items=items).steps) for items in (course, library))
    first, last = page.first + before, page.first + before + count - 1
    target = f"[{'another page' if count == 1 else 'a page of their own'}]({page.name}{APPENDIX}.md)"
    if count == 1:
        return f"Step {first}, which only symrot's numeric code needs, is on {target}."
    steps = f"Steps {first} {'and' if count == 2 else 'to'} {last}"
    return f"{steps}, which only symrot's numeric code needs, are on {target}."


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
