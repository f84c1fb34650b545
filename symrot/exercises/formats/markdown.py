"""Sheets of exercises as Markdown: first the exercises, then hints and solutions."""

from collections.abc import Iterator, Sequence

from symrot.exercises.exercise import Datum, Exercise, related
from symrot.exercises.formats.figures import image_address, title_of
from symrot.exercises.units import unit_latex

__all__ = ["data_text", "markdown_sheet"]


def data_text(data: Sequence[Datum]) -> str:
    r"""Return the given quantities of an exercise as one sentence, such as ``Data: $m = 2\,\mathrm{kg}$ (mass).``"""
    pairs = (f"${each.latex} = {each.value}{unit_latex(each.unit)}$ ({each.words})" for each in data)
    return f"Data: {', '.join(pairs)}." if data else ""


def markdown_sheet(exercises: Sequence[Exercise], title: str, statements: bool, solutions: bool) -> str:
    """Return the statements of exercises as Markdown, or their hints and solutions, or both, in this order."""
    lines = [f"# {title}", ""]
    for number, exercise in enumerate(exercises if statements else (), 1):
        lines += [f"## {number}. {exercise.title}", "", exercise.statement, ""]
        if exercise.figure:
            lines += [f"![{title_of(exercise.figure)}]({image_address(exercise.figure)})", ""]
        lines += [data_text(exercise.data), ""]
        lines += [f"- ({question.key}) {question.prompt}" for question in exercise.questions]
        lines.append("")
    if not solutions:
        return "\n".join(lines).rstrip() + "\n"
    lines += ["# Hints" if statements else "## Hints", ""]
    for number, exercise in enumerate(exercises, 1):
        lines += [f"**{number}.**", "", *(f"{stage}. {hint}" for stage, hint in enumerate(exercise.hints, 1)), ""]
    lines += ["# Solutions", ""] if statements else []
    for number, exercise in enumerate(exercises, 1):
        lines += [f"## Solution of {number}: {exercise.title}", "", *_solution(exercise)]
    return "\n".join(lines).rstrip() + "\n"


def _solution(exercise: Exercise) -> Iterator[str]:
    for equation in exercise.solution:
        yield from (equation.reason, "", f"$${equation.latex}$$", "")
    answers = (f"({question.key}) ${question.name} {related(question.latex)}$" for question in exercise.questions)
    yield from (f"**Answers:** {'; '.join(answers)}.", "")
