"""Sheets of exercises that are chosen by topic and random seed."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle
from random import Random
from typing import Any, overload

from symrot.errors import InputError
from symrot.exercises.exercise import SCHEMA, Exercise, make, sheet_data
from symrot.exercises.templates import TOPICS, chosen, template, topic_of

__all__ = ["ExerciseSheet", "exercise", "read_sheet"]

MOST = 1000


@dataclass(frozen=True)
class ExerciseSheet:
    """A sheet of exercises; iterate over it, or take one exercise by its index.

    Attributes
    ----------
    exercises : tuple of Exercise
        The exercises, in order.

    Examples
    --------
    >>> import symrot
    >>> sheet = symrot.exercise("inertia", seed=1, count=2)
    >>> len(sheet), sheet.markdown().splitlines()[0]
    (2, '# Exercises')
    """

    exercises: tuple[Exercise, ...]

    def __len__(self) -> int:
        return len(self.exercises)

    def __iter__(self) -> Iterator[Exercise]:
        return iter(self.exercises)

    @overload
    def __getitem__(self, place: int) -> Exercise: ...
    @overload
    def __getitem__(self, place: slice) -> tuple[Exercise, ...]: ...
    def __getitem__(self, place: int | slice) -> Exercise | tuple[Exercise, ...]:
        return self.exercises[place]

    def to_json(self) -> dict[str, Any]:
        """Return the sheet as plain data for JSON."""
        return sheet_data(self.exercises)

    def print(self, form: str, solutions: bool = True, *, statements: bool = True, title: str = "") -> str:
        """Return the text of the sheet in a format.

        Parameters
        ----------
        form : str
            ``"markdown"``, ``"latex"``, ``"html"``, ``"moodle"`` or ``"json"``.
        solutions : bool
            Whether the sheet has hints and solutions.
        statements : bool
            Whether the sheet has the exercises themselves; without them it is a sheet of solutions.
        title : str
            The title of the sheet; default: "Exercises", or "Exercises: solutions".

        Raises
        ------
        InputError
            If the format is unknown, or if both ``solutions`` and ``statements`` are false. For the formats
            ``"moodle"`` and ``"json"``, also if a title is given or one of the two is false: these formats have no
            title, and always statements and solutions.
        """
        from symrot.exercises.formats import FORMATS, HANDOUTS, TITLE

        if not (statements or solutions):
            raise InputError("sheet: expected statements, solutions or both")
        if form in HANDOUTS:
            heading = title or (TITLE if statements else f"{TITLE}: solutions")
            return HANDOUTS[form](self.exercises, heading, statements, solutions)
        if form not in FORMATS:
            raise InputError(f"format: expected one of {', '.join((*HANDOUTS, *FORMATS))}, got {form!r}")
        if title or not (statements and solutions):
            raise InputError(
                f"format: expected one of {', '.join(HANDOUTS)} for a sheet with a title, or with statements or "
                f"solutions alone, got {form!r}"
            )
        return FORMATS[form](self.exercises)

    def markdown(self) -> str:
        """Return the sheet as Markdown, with hints and solutions after the exercises."""
        return self.print("markdown")

    def latex(self) -> str:
        """Return the sheet as a LaTeX document."""
        return self.print("latex")

    def html(self) -> str:
        """Return the sheet as the text of a self-contained HTML page that grades numerical answers."""
        return self.print("html")

    def moodle(self) -> str:
        """Return the sheet as Moodle XML, for import into a question bank."""
        return self.print("moodle")

    def json(self) -> str:
        """Return the sheet as JSON text; ``symrot grade`` reads such a text."""
        return self.print("json")

    def _repr_markdown_(self) -> str:
        return self.markdown()


def exercise(topic: str | Sequence[str] = "", *, seed: int = 0, count: int = 1) -> ExerciseSheet:
    """Return a sheet of exercises with random numbers, hints and proven solutions.

    Parameters
    ----------
    topic : str or sequence of str
        A topic or the name of a template, see ``symrot exercise --list``, or several of them; an empty text means all
        topics. The sheet is in the order of the topics; with all topics, the seed decides which of them is the first.
    seed : int
        Seed of the random choices. Another seed usually gives other numbers and begins with another template; the same
        seed gives the same exercises on every machine.
    count : int
        The number of exercises. They are divided evenly among the topics; the first topics get one more if needed.

    Returns
    -------
    ExerciseSheet
        With the methods ``markdown``, ``latex``, ``html``, ``moodle`` and ``json``.

    Raises
    ------
    InputError
        For an unknown topic, a count that is not from 1 to 1000, or a negative seed.
    ProofError
        If a line of a solution does not hold.

    Examples
    --------
    >>> import symrot
    >>> (sheet,) = symrot.exercise("rod_about_end", seed=3)
    >>> sheet.questions[0].prompt
    'Find $I_O$, the moment of inertia about the axis, as a formula in $m$, $L$.'
    >>> [each.topic for each in symrot.exercise(["gears", "rolling"], count=3)]
    ['gears', 'gears', 'rolling']
    """
    if not isinstance(seed, int) or seed < 0:
        raise InputError(f"seed: expected a whole number, 0 or more, got {seed!r}")
    if not isinstance(count, int) or not 1 <= count <= MOST:
        raise InputError(f"count: expected a whole number from 1 to {MOST}, got {count!r}")
    topics = [topic] if isinstance(topic, str) else list(topic)
    if not all(isinstance(each, str) for each in topics):
        raise InputError(f"topic: expected the name of a topic, or a list of such names, got {topic!r}")
    if any(topics):
        lists, start = [chosen(each) for each in topics], seed
    else:
        lists = [*TOPICS.values()]
        start, first = divmod(seed, len(lists))
        lists = lists[first:] + lists[:first]
    names = [members[(start + n // len(lists)) % len(members)] for n, members in zip(range(count), cycle(lists))]
    uses: Counter[str] = Counter()
    exercises = []
    for name in names:
        exercises.append(_exercise(name, seed + uses[name]))
        uses[name] += 1
    # the topics took turns; on the sheet, the exercises of a topic are together
    order = sorted(range(count), key=lambda place: place % len(lists))
    return ExerciseSheet(tuple(exercises[place] for place in order))


def _exercise(name: str, seed: int) -> Exercise:
    source = Random(f"{name} {seed}")
    return make(name, topic_of(name), seed, template(name)(source), source)


def read_sheet(data: Any, where: str) -> ExerciseSheet:
    """Return the sheet from the data of its JSON text; ``where`` is the name of the file for error messages.

    Raise InputError if the data are no sheet, or have another version of the format (``schema``).
    """
    try:
        if data["schema"] != SCHEMA:
            raise InputError(f"{where}: expected exercises of schema {SCHEMA}, got {data['schema']!r}")
        return ExerciseSheet(tuple(Exercise.from_json(each) for each in data["exercises"]))
    except (KeyError, TypeError, ValueError, AttributeError) as fault:
        if isinstance(fault, InputError):
            raise
        raise InputError(
            f"{where}: expected the JSON that `symrot exercise --format json` writes, got other data ({fault})"
        ) from None
