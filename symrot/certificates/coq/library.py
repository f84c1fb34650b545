"""The Coq files that symrot prints, and the theorem about each kernel."""

from collections.abc import Callable
from functools import cache, partial
from importlib.resources import files
from typing import Any

from symrot.build.code_digest import text_digest
from symrot.certificates.coq.dynamics import dynamics_file
from symrot.certificates.coq.euler import euler_file, euler_files
from symrot.certificates.coq.file import CoqFile, Theorem
from symrot.certificates.coq.quaternion import quaternion_file
from symrot.certificates.coq.rodrigues import rodrigues_file
from symrot.errors import InputError

__all__ = [
    "STANDARD_AXIOMS",
    "assumptions_text",
    "coq_file",
    "coq_file_names",
    "coq_section",
    "coq_texts",
]

RULES = "rotation"
"""Name of the Coq file of definitions and lemmas about rotations that all printed Coq files require.

The file comes with symrot, written by hand.
"""

ASSUMPTIONS = "assumptions"
"""The file that makes Coq print the axioms on which the theorems rest."""

STANDARD_AXIOMS = (
    "Classical_Prop.classic",
    "ClassicalDedekindReals.sig_forall_dec",
    "ClassicalDedekindReals.sig_not_dec",
    "FunctionalExtensionality.functional_extensionality_dep",
)
"""The axioms of the real numbers in Coq's standard library; no theorem may rest on any other."""

_FILES: dict[str, tuple[tuple[str, ...], Callable[[], CoqFile]]] = {
    "quaternions": (("quaternion_",), quaternion_file),
    **{name: ((f"{name}_",), partial(rodrigues_file, name)) for name in ("rodrigues", "mrp")},
    "dynamics": (("euler_equations_", "kinetic_", "angular_", "inertia_rotated"), dynamics_file),
    **{name: ((f"{name}_",), partial(euler_file, sequence)) for name, sequence in euler_files().items()},
}
"""File name without ``.v`` -> the prefixes of its kernels' names, and the function that makes the file.

Each file comes after the files that it requires.
"""


def coq_file_names() -> tuple[str, ...]:
    """Return the names of the Coq files without ``.v``; each file comes after the files that it needs."""
    return tuple(_FILES)


@cache
def coq_file(name: str) -> CoqFile:
    """Return the Coq file of a name such as ``euler_zxz``.

    Raises
    ------
    InputError
        If there is no file of that name.
    """
    if name not in _FILES:
        raise InputError(f"expected the name of a Coq file of theorems, such as euler_zxz, got {name!r}")
    _, make = _FILES[name]
    return make()


@cache
def rules_text() -> str:
    """Return the text of ``rotation.v``, the Coq file with the definitions and rules that all other files use."""
    return (files("symrot.certificates.coq") / f"{RULES}.v").read_text(encoding="utf-8")


def assumptions_text(names: tuple[str, ...]) -> str:
    """Return a Coq file that makes Coq print all axioms on which the theorems of the files ``names`` rest."""
    lines = [f"  let _ := {name}.{theorem.name} in" for name in names for theorem in coq_file(name).theorems]
    return "\n".join([
        "(* The axioms on which the theorems rest, all together. Printed by `symrot prove --coq`; do not edit. *)",
        "", *(f"From symrot Require {name}." for name in names), "",
        "Definition theorems : True :=", *lines, "  I.", "", "Print Assumptions theorems.",
    ]) + "\n"  # fmt: skip


def coq_texts(names: tuple[str, ...] | None = None) -> dict[str, str]:
    """Return the texts of the Coq files ``names`` (default: all) and of three files that go with them, by file name.

    The three are ``rotation.v``, which all others need, ``assumptions.v`` and ``_CoqProject``. Unknown names are
    ignored.
    """
    names_needed = tuple(name for name in coq_file_names() if names is None or name in names)
    printed = {name: coq_file(name).text for name in names_needed}
    texts = {RULES: rules_text(), **printed, ASSUMPTIONS: assumptions_text(names_needed)}
    # _CoqProject lists all files for the build tool coq_makefile
    project = "".join(f"{line}\n" for line in ("-R . symrot", *(f"{name}.v" for name in texts)))
    return {"_CoqProject": project, **{f"{name}.v": text for name, text in texts.items()}}


def _theorem_about(kernel: str) -> tuple[str, Theorem] | None:
    """Return (name of the Coq file, theorem) for the theorem about a kernel; None if there is no theorem about it."""
    for name, (beginnings, _) in _FILES.items():
        if kernel.startswith(beginnings):
            for theorem in coq_file(name).theorems:
                if theorem.kernel and theorem.name == kernel:
                    return name, theorem
    return None


def coq_section(kernel: str) -> dict[str, Any] | None:
    """Return the ``coq`` section of a kernel's certificate, with the theorem about the kernel; None without a theorem.

    Parameters
    ----------
    kernel : str
        Name of a kernel of the library.

    Returns
    -------
    dict or None
        ``file``, ``theorem`` (its name), ``statement`` (its text), ``statement_sha256``, ``file_sha256``, ``requires``
        (required file -> sha256) and ``axioms``, the only axioms on which the theorem may rest.
    """
    # Coq is not needed here; coq/check.py runs it
    home = _theorem_about(kernel)
    if home is None:
        return None
    name, theorem = home
    texts = {RULES: rules_text(), **{each: coq_file(each).text for each in coq_file(name).requires if each != RULES}}
    statement = f"Theorem {theorem.name} :\n{theorem.statement}."
    return {
        "file": f"{name}.v",
        "theorem": theorem.name,
        "statement": statement,
        "statement_sha256": text_digest(statement),
        "file_sha256": coq_file(name).digest,
        "requires": {f"{each}.v": text_digest(text) for each, text in texts.items()},
        "axioms": list(STANDARD_AXIOMS),
    }
