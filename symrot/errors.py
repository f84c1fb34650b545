"""The exceptions of symrot, and hints for their messages.

Each message is one sentence: the place, the expected value and the value that arrived.

The command line prints the message and exits with code 2, or with code 1 if an audit fails. :class:`InputError` is also
a ``ValueError``, because an argument has an unusable value. The other exceptions do not derive from ``ValueError``,
because they report the outcome of a computation, which an ``except ValueError`` must not hide.
"""

from collections.abc import Iterable

__all__ = [
    "CertificateError",
    "CompilerError",
    "InputError",
    "PropagationError",
    "SymrotError",
    "complaint",
    "nearest",
    "prefix",
    "with_hint",
]


class SymrotError(Exception):
    """Base class of all exceptions that symrot raises on purpose.

    Examples
    --------
    >>> import symrot
    >>> try:
    ...     symrot.load_scene("no_such_scene")
    ... except symrot.SymrotError as error:
    ...     print(type(error).__name__)
    InputError
    """


class InputError(SymrotError, ValueError):
    """An error in the user's input: a scene, formula, mesh, option or other argument cannot be used.

    Examples
    --------
    >>> import symrot
    >>> symrot.dcm("ABC")
    Traceback (most recent call last):
    ...
    symrot.errors.InputError: an Euler sequence is three axis letters, ...
    """


class CompilerError(SymrotError):
    """The error raised if no C compiler is installed, or if the compiler rejects the emitted kernel.

    Examples
    --------
    >>> import symrot
    >>> issubclass(symrot.CompilerError, symrot.SymrotError)
    True
    """


class PropagationError(SymrotError):
    """The error raised if a motion cannot be propagated to its last time.

    Attributes
    ----------
    trajectory : Trajectory
        The samples before the failure, with ``status`` -1; the attribute is absent if there are no samples.

    Examples
    --------
    >>> import symrot
    >>> issubclass(symrot.PropagationError, ValueError)
    False
    """


class CertificateError(SymrotError):
    """The error raised if a kernel, an object file or a certificate fails a check of its claims.

    Examples
    --------
    >>> import symrot
    >>> symrot.audit("heavy_top.c")
    Traceback (most recent call last):
    ...
    symrot.errors.CertificateError: heavy_top.c: expected a certificate, got another kind of file; ...
    """


def prefix(where: str) -> str:
    """Return the beginning of a message: a place followed by a colon and a blank, or an empty text for no place."""
    return f"{where}: " if where else ""


def complaint(source: str, where: str, position: int, expected: str) -> InputError:
    """Return an InputError that names the expected text and its position, with an excerpt of the source around it."""
    start = max(0, position - 25)
    excerpt = ("..." if start else "") + source[start : start + 50] + ("..." if len(source) > start + 50 else "")
    return InputError(f"{prefix(where)}expected {expected} at position {position + 1}, near {excerpt!r}")


def nearest(word: object, known: Iterable[str]) -> str:
    """Return ``"did you mean 'x'?"``, where x is the known word most similar to a mistyped word, or an empty text."""
    from difflib import get_close_matches  # only on the way to an error

    matches = get_close_matches(str(word)[:80], list(known), 1, 0.5)
    return f"did you mean '{matches[0]}'?" if matches else ""


def with_hint(message: str, word: object, known: Iterable[str]) -> str:
    """Return a message, followed by "did you mean 'x'?" if a known word x is similar to the mistyped word."""
    hint = nearest(word, known)
    return f"{message} ({hint})" if hint else message
