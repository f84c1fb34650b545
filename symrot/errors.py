"""The errors that symrot raises for what a user gave it.

Every one of them carries one sentence: where, what was expected, what arrived. The command line prints that
sentence and exits with code 2; nothing else of symrot's own may reach a user.
"""

__all__ = ["CertificateError", "CompilerError", "InputError", "PropagationError", "SymrotError"]


class SymrotError(ValueError):
    """Base of all errors with a sentence for the user."""


class InputError(SymrotError):
    """A scene, formula, mesh or option that cannot be used as given."""


class CompilerError(SymrotError):
    """No C compiler, or one that refuses the emitted kernel."""


class PropagationError(SymrotError):
    """A motion that could not be followed to the end of its span."""


class CertificateError(SymrotError):
    """A kernel, an object file or a certificate that is not what it claims to be."""
