"""The audit of the certificate of an exact time step, which computes the motion in closed form by elliptic functions.

The certificate contains a scene. symrot generates the C files and the certificate of this scene's step again, which
includes the check of the C text against the equations of motion, and compares them with the user's files.
"""

import json
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from symrot.certificates.audit import LARGEST
from symrot.certificates.certificate import Data, certificate_json
from symrot.certificates.exact_step.law import DIGITS, STATES
from symrot.certificates.step_certificate import with_bounds
from symrot.codegen.steady_rotations import STATES as STATE_NAMES
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input
from symrot.scene.file import shipped_names
from symrot.scene.scene import Scene, SceneSource, load_scene
from symrot.workshop.steps.exact import ExactStepText, plain_content

__all__ = ["audit_elliptic"]

NEAR = 1 + 1e-6
"""Largest ratio by which a bound in a certificate may differ from the bound that this machine computes again.

The bound in the certificate still holds: symrot states bounds that are 1 + 2e-6 times as large as the computed ones.
"""


def audit_elliptic(path: Path, data: Data, scene: SceneSource | None = None) -> list[str]:
    """Audit the certificate of an exact step with elliptic functions; return the statements that hold, one line each.

    Such a step computes the state at a later time from the closed form of the motion.

    Parameters
    ----------
    path : Path
        NAME.cert.json, in the folder with the files that it names.
    data : mapping
        The content of that file.
    scene : Scene, str, Path or dict, optional
        The scene whose step this should be; by default a shipped scene of the name in the certificate.

    Raises
    ------
    CertificateError
        If a file is not the one that symrot prints for the scene in the certificate, or if the C text does not solve
        the equations of motion at one of the tested states.
    """
    step = _step(path, data)
    if path.name != f"{step.name}.cert.json":
        raise CertificateError(f"{path}: expected the certificate of {path.name.removesuffix('.cert.json')}, "
                               f"got that of {step.name[:60]}")  # fmt: skip
    texts = step.c_files()
    for file, text in texts.items():
        try:
            content = read_input(path.parent / file, LARGEST)
        except OSError:
            raise CertificateError(f"{path}: expected its file {file} in the same folder, got none") from None
        if content != text.encode():
            raise CertificateError(
                f"{path.parent / file}: expected the text that symrot prints for the scene in the certificate, got an "
                "edited one"
            )
    stated = step.statement
    _same(path, stated, {section: data.get(section) for section in stated})
    own = json.loads(step.certificate())
    if "bounds" in data:
        own = json.loads(certificate_json(with_bounds(own, _bounds(path, step, data))))
    if read_input(path, LARGEST) != certificate_json(own).encode():
        _same(path, own, data)
        raise CertificateError(f"{path}: expected the layout of a certificate as symrot prints it, got another layout")
    return [
        f"{step.name}: {len(texts)} files are those that symrot prints for the scene in the certificate",
        f"the C text solves the equations of motion at {STATES} states to {DIGITS} digits; nothing is proven for other "
        "states",
        _of_scene(path, step.scene.name, data, scene),
        "bounds of rounding and truncation are those that symrot computes"
        if "bounds" in data
        else "no bounds of rounding and truncation",
    ]


def _box(path: Path, data: Data) -> dict[str, tuple[Fraction, Fraction]]:
    """Return the ranges of the inputs on which a certificate (``data``) bounds the errors: name -> (low, high).

    CertificateError, with the ``path`` of the certificate in its message, is raised if there are no such ranges.
    """
    try:
        box = data["bounds"]["box"]
        ends = {name: (float.fromhex(low), float.fromhex(high)) for name, (low, high) in box.items()}
        if not all(low <= high for low, high in ends.values()):
            raise ValueError("a range whose smaller value is not first")
        return {name: (Fraction(low), Fraction(high)) for name, (low, high) in ends.items()}
    except (AttributeError, KeyError, OverflowError, TypeError, ValueError) as reason:
        raise CertificateError(
            f"{path}: expected the entry 'box' of the section 'bounds' in the form that symrot writes, got other "
            f"content ({reason})"
        ) from None


def _bounds(path: Path, step: ExactStepText, data: Data) -> Data:
    """Compute the section ``bounds`` of a certificate again, and return it with the certificate's own error bounds.

    ``data`` is the certificate. Its error bounds replace the computed ones, whose last digits depend on the machine.
    CertificateError is raised if an error bound of the certificate differs by more than the factor ``NEAR`` from the
    one that symrot computes on the same box.
    """
    box = _box(path, data)
    stated = {kind: _numbers(path, data["bounds"], kind) for kind in ("rounding", "truncation")}
    try:
        own = step.bounds(box)
    except InputError as reason:
        raise CertificateError(f"{path}: {reason}") from None
    for kind, numbers in stated.items():
        for name, value in own[kind].items():
            # the last digits depend on the functions of the machine
            if not float.fromhex(value) / NEAR <= numbers[name] <= float.fromhex(value) * NEAR:
                raise CertificateError(
                    f"{path}: expected the bounds that symrot computes for the ranges in the certificate, got another "
                    f"{kind} bound of {name}; certify the step again"
                )
    return own | {kind: {name: x.hex() for name, x in numbers.items()} for kind, numbers in stated.items()}


def _numbers(path: Path, bounds: Data, kind: str) -> dict[str, float]:
    """Return the bounds of one ``kind`` of error, "rounding" or "truncation": name of a state -> bound.

    ``bounds`` is the section ``bounds`` of a certificate. CertificateError is raised for a missing number.
    """
    try:
        return {name: float.fromhex(bounds[kind][name]) for name in STATE_NAMES}
    except (KeyError, TypeError, ValueError, OverflowError) as reason:
        raise CertificateError(
            f"{path}: expected the entry {kind!r} of the section 'bounds' in the form that symrot writes, got other "
            f"content ({reason})"
        ) from None


def _same(path: Path, own: Data, data: Data) -> None:
    """Raise CertificateError if a section of a certificate differs from the section that symrot itself generates.

    ``own`` maps the names of symrot's sections to their content, and ``data`` the names of the certificate's sections.
    """
    for section in (*own, *data):
        if json.dumps(own.get(section), sort_keys=True) != json.dumps(data.get(section), sort_keys=True):
            raise CertificateError(
                f"{path}: expected {section!r} as symrot prints it for the scene in the certificate, got other content"
            )


def _step(path: Path, data: Data) -> ExactStepText:
    """Return the time step, with its C files and certificate, of the scene that is stored in a certificate (``data``).

    CertificateError is raised if this scene has no exact step with elliptic functions.
    """
    try:
        name, content = data["scene"]["name"], data["scene"]["content"]
        if not isinstance(name, str) or not isinstance(content, Mapping):
            raise TypeError("'name' is not a string, or 'content' is not a mapping")
        return ExactStepText(replace(Scene.from_dict(content), name=name))
    except (InputError, KeyError, TypeError, ValueError, RecursionError) as reason:
        raise CertificateError(
            f"{path}: expected 'scene' to be a scene with an exact step in elliptic functions, got other content "
            f"({reason})"
        ) from None


def _of_scene(path: Path, name: str, data: Data, scene: SceneSource | None) -> str:
    """Compare the scene in a certificate with ``scene``, the user's; return a sentence with the result.

    If ``scene`` is None, the shipped scene ``name`` takes its place; if symrot has no scene of this name either, the
    sentence says that the scene was not compared. CertificateError is raised if the scenes differ.
    """
    if scene is None and name not in shipped_names():
        return (
            "the scene in the certificate was not compared, because symrot has no scene of its name; pass yours by "
            "--scene"
        )
    own = load_scene(name if scene is None else scene)
    if plain_content(own.to_dict()) != data["scene"]["content"]:
        raise CertificateError(f"{path}: expected 'scene' to be the scene {own.name}, got other content")
    return f"the scene in the certificate is the scene {own.name}{' of symrot' if scene is None else ''}"
