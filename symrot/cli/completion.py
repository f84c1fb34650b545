"""Completion of the command line in bash, zsh and fish, by argcomplete: scenes, kernels, derivations, topics."""

from argparse import Action, ArgumentParser, _SubParsersAction
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from symrot.catalogue import names as derivations
from symrot.conventions import SEQUENCES
from symrot.exercises.templates import TOPICS
from symrot.propagation.method import METHODS
from symrot.scene.file import shipped_names
from symrot.sweeps.points import SAMPLINGS
from symrot.sweeps.statistics import STATISTICS
from symrot.textbook import DOCUMENTS

__all__ = ["complete", "completers"]


def _kernels() -> list[str]:
    from symrot.workshop.emit import kernel_names

    return [*kernel_names(), *shipped_names()]


def _steps() -> list[str]:
    from symrot.workshop.step_text import STEPS

    return [*STEPS, "exact"]


NAMES: Mapping[str, Callable[[], Iterable[str]]] = {
    "scene": shipped_names,
    "kernel": _kernels,
    "name": derivations,
    "topic": lambda: TOPICS,
    "method": lambda: METHODS.keys() - {"constant"},
    "state": lambda: ("quaternion", *SEQUENCES),
    "step": _steps,
    "sampling": lambda: SAMPLINGS,
    "statistics": lambda: STATISTICS,
    "textbook": lambda: DOCUMENTS,
}
"""Name of an argument -> function that returns the names that the argument accepts."""
OR_FILES = frozenset({"scene", "kernel"})
"""The arguments in :data:`NAMES` that also accept files."""


def completers(parser: ArgumentParser) -> dict[str, Action]:
    """Give a completer to each argument that takes a name, such as SCENE; return these arguments by their names.

    A completer is the function that proposes words when the user presses Tab. The arguments of all subcommands of the
    parser are included.
    """
    from argcomplete.completers import FilesCompleter

    known: dict[str, Action] = {}
    for action in parser._actions:
        if isinstance(action, _SubParsersAction):
            for command in action.choices.values():
                known |= completers(command)
        elif action.dest in NAMES:
            files = FilesCompleter() if action.dest in OR_FILES else None
            action.completer = _Names(NAMES[action.dest], files)  # type: ignore[attr-defined]
            known[action.dest] = action
    return known


class _Names:
    """A function that completes a word typed in a shell: it returns the names that begin with the word, and files.

    ``files`` completes names of files in the same way; None if the argument accepts no file.
    """

    def __init__(self, names: Callable[[], Iterable[str]], files: Any) -> None:
        self.names, self.files = names, files

    def __call__(self, prefix: str, **context: Any) -> list[str]:
        names = [name for name in self.names() if name.startswith(prefix)]
        return names + (list(self.files(prefix, **context)) if self.files else [])


def complete(parser: ArgumentParser) -> None:
    """Answer a shell that asks for completions of a command line: print them and end the process.

    In a normal run, or if argcomplete is not installed, the function does nothing.
    """
    try:
        from argcomplete import autocomplete
    except ImportError:
        return
    completers(parser)
    autocomplete(parser)
