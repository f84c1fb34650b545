"""The table of templates by topic. A template is a function from a random number generator to a problem.

The name of a template is the name of its function. A module is imported when one of its templates is used.
"""

from importlib import import_module

from symrot.errors import InputError
from symrot.exercises.problem import Template

__all__ = ["TOPICS", "chosen", "template", "topic_of"]

TOPICS: dict[str, tuple[str, ...]] = {
    "inertia": ("rod_about_end", "solid_about_axis", "disk_about_rim"),
}
"""Topic, which is the name of a module -> the names of its templates."""


def template(name: str) -> Template:
    """Return the template of a name."""
    made: Template = getattr(import_module(f"{__name__}.{topic_of(name)}"), name)
    return made


def topic_of(name: str) -> str:
    """Return the topic of a template."""
    return next(topic for topic, names in TOPICS.items() if name in names)


def chosen(topic: str) -> tuple[str, ...]:
    """Return the templates of a topic, one template by its name, or all templates for an empty text.

    All templates come in turn: the first of each topic, then the second of each.

    Raises
    ------
    InputError
        For a text that names neither a topic nor a template.
    """
    if not topic:
        longest = max(map(len, TOPICS.values()))
        return tuple(names[n] for n in range(longest) for names in TOPICS.values() if n < len(names))
    if topic in TOPICS:
        return TOPICS[topic]
    if any(topic in names for names in TOPICS.values()):
        return (topic,)
    raise InputError(
        f"exercise: expected a topic, one of {', '.join(TOPICS)}, or a template that `symrot exercise --list` names, "
        f"got {topic!r}"
    )
