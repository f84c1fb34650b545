"""The audit of a step's certificate: every statement about the files in its folder is proven again."""

import json
import re
from collections.abc import Callable
from fractions import Fraction
from hashlib import sha256
from pathlib import Path

from symrot.certificates.audit import LARGEST
from symrot.certificates.certificate import Data, certificate_json, seal
from symrot.certificates.readback.header import check_header, check_source
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.section import box_of, check_section
from symrot.certificates.step_certificate import (
    SCHEMA,
    bounds_of_step,
    formula_section,
    is_step,
    rates_of,
    rates_section,
    step_section,
    trusted,
)
from symrot.codegen.printing.parameters_header import parameters_file, parameters_header
from symrot.codegen.steps import Method, SteadyRotations, WithDerivatives
from symrot.errors import CertificateError, InputError
from symrot.files.reading import read_input
from symrot.kernels.jacobian import jacobian_name
from symrot.scene.file import shipped_names
from symrot.scene.scene import SceneSource, load_scene
from symrot.workshop.kernel_text import scene_kernel_name
from symrot.workshop.step_text import ORDER, step_method, step_text
from symrot.workshop.steps.elliptic_audit import audit_elliptic

__all__ = ["audit_step", "step_data"]

SECTIONS = (
    "schema", "kernel", "title", "regenerate", "method", "step", "rates", "files", "formula", "bounds", "trusted",
    "seal",
)  # fmt: skip


def step_data(path: Path) -> Data | None:
    """Return the content of a JSON file if it is the certificate of a time step; None for any other file."""
    try:
        data = json.loads(read_input(path, LARGEST))
    except (OSError, ValueError, RecursionError):
        return None
    return data if is_step(data) else None


def audit_step(
    path: Path, data: Data, rerun: bool = False, scene: SceneSource | None = None,
    progress: Callable[[str], object] = lambda text: None,
) -> list[str]:  # fmt: skip
    """Audit the certificate of a step; return the statements that were checked and hold, one line each.

    Parameters
    ----------
    path : Path
        NAME.cert.json, in the folder with the files that it names.
    data : mapping
        The content of that file, from :func:`step_data`.
    rerun : bool
        Whether to search for the bounds of rounding errors again; bounds of truncation are always computed again.
    scene : Scene, str, Path or dict, optional
        The scene whose step this should be; by default a shipped scene of the name in the certificate.

    Raises
    ------
    CertificateError
        If a statement does not hold; the message names the first such statement.
    """
    if "scene" in data:
        progress("checking ..")
        return audit_elliptic(path, data, scene)
    name = str(data.get("kernel"))
    if data.get("schema") != SCHEMA:
        raise CertificateError(f"{path}: expected the schema {SCHEMA}, got {data.get('schema')}; emit the step again")
    missing = [each for each in SECTIONS if each not in data and each != "bounds"]
    unknown = sorted(set(data) - set(SECTIONS))
    if missing or unknown:
        problem = f"{missing[0]!r} is missing" if missing else f"{unknown[0]!r} is unknown"
        raise CertificateError(f"{path}: expected the sections of a step's certificate, but {problem}")
    if not re.fullmatch(r"[A-Za-z]\w*", name, re.ASCII) or path.name != f"{name}.cert.json":
        raise CertificateError(f"{path}: expected the certificate of {path.name.removesuffix('.cert.json')}, "
                               f"got that of {name[:60]}")  # fmt: skip
    if data["seal"] != seal(data) or path.read_text("utf-8", "replace") != certificate_json(data):
        raise CertificateError(f"{path}: expected a certificate as symrot prints it, got one that was edited")
    method = _method(path, data)
    if data["trusted"] != trusted(method.name, "bounds" in data):
        raise CertificateError(
            f"{path}: expected the section 'trusted' (the assumptions) as symrot prints it, got other content; emit "
            "the step again"
        )
    try:
        texts = _files(path, name, data)
    except (KeyError, TypeError, ValueError, OverflowError) as reason:
        raise CertificateError(
            f"{path}: expected the entries 'files' and 'parameters' in the form that symrot prints, got a fault in "
            f"them ({reason}); emit the step again"
        ) from None
    source = texts[f"{name}.c"]
    check_source(source, name)
    check_header(texts[f"{name}.h"], source, name)
    # files, C text and bounds are compared with the rates that the certificate states
    rates, values = rates_of(data), [float.fromhex(value) for _, _, value in data["rates"]["parameters"]]
    named = _scene_name(path, data, method)
    for section, own in (("step", step_section(method)), ("rates", rates_section(rates, values))):
        if data[section] != own:
            raise CertificateError(
                f"{path}: expected {section!r} in the form that symrot prints, got other content; emit the step again"
            )
    progress("proving ..")
    if formula_section(name, rates, method, source) != data["formula"]:
        raise CertificateError(
            f"{path}: expected the section 'formula' to be the proof that symrot derives from the C text, got another "
            "proof; emit the step again"
        )
    report = [
        f"{name}: {len(texts)} hashes agree; the C text of symrot_{name} and symrot_{name}f, and of their batch "
        f"functions, computes the {method.formula}"
    ]
    if isinstance(method, SteadyRotations):
        report.append("the C text is the motion itself, not an approximation: it solves the equations of the rates")
    report.append(_of_scene(path, data, method, scene or (named if named in shipped_names() else None)))
    if "bounds" in data:
        progress("bounding ..")
        report.append(_bounds(path, data, method, source, rerun))
    else:
        report.append("no bounds of rounding and truncation")
    return report


def _files(path: Path, name: str, data: Data) -> dict[str, str]:
    """Return a map from name to text of a step's files; raise CertificateError if a hash differs."""
    expected = {f"{name}.c", f"{name}.h", f"{name}_test.c"}
    parameters = [(symbol, value) for symbol, _, value in data["rates"]["parameters"]]
    expected |= {parameters_file(name)} if parameters else set()
    if not isinstance(data["files"], dict) or set(data["files"]) != expected:
        raise CertificateError(f"{path}: expected the hashes of {', '.join(sorted(expected))}, got others")
    texts = {}
    for file, digest in data["files"].items():
        try:
            content = read_input(path.parent / file, LARGEST)
        except OSError:
            raise CertificateError(f"{path}: expected its file {file} in the same folder, got none") from None
        if sha256(content).hexdigest() != digest:
            raise CertificateError(f"{path.parent / file}: expected the file of the certificate, got an edited one")
        texts[file] = content.decode("utf-8", "replace")
    values = [(symbol, float.fromhex(value)) for symbol, value in parameters]
    if values and texts[parameters_file(name)] != parameters_header(name, values):
        raise CertificateError(
            f"{path.parent / parameters_file(name)}: expected the parameters that the certificate states, got others"
        )
    return texts


def _method(path: Path, data: Data) -> Method:
    step = data["step"]
    if isinstance(step, dict) and step.get("method") == SteadyRotations.name:
        axis = step.get("axis")
        if set(step) != {"method", "axis"} or axis not in (None, 1, 2, 3) or isinstance(axis, bool | float):
            raise CertificateError(f"{path}: expected the symmetry axis (1, 2, 3 or null) of an exact step, got {step}")
        exact = SteadyRotations(None if axis is None else axis - 1)
        if data["method"] != exact.formula:
            raise CertificateError(f"{path}: expected the method {exact.formula!r}, got {data['method']!r}")
        return exact
    try:
        jacobian, order = tuple(step.get("jacobian", ())), step["order"]
        if not all(isinstance(name, str) for name in jacobian):
            raise TypeError("'jacobian' is not a list of names")
        method = step_method(step["method"], order if step["method"] == "taylor" else None, jacobian)
    except (InputError, KeyError, TypeError, AttributeError) as reason:
        raise CertificateError(f"{path}: expected a method that symrot knows: {reason}") from None
    assert not isinstance(method, SteadyRotations)
    if order != method.order:
        raise CertificateError(f"{path}: expected the order {method.order} of {method.name}, got {order}")
    if data["method"] != method.formula:
        raise CertificateError(f"{path}: expected the method {method.formula!r}, got {data['method']!r}")
    return method


def _options(method: Method) -> tuple[int | None, tuple[str, ...]]:
    """Return the options with which a step is emitted: its order, and the names of some inputs.

    The step is also differentiated with respect to these inputs.
    The order is None for the default order of a Taylor step, and for any other method.
    """
    if isinstance(method, SteadyRotations):
        return None, ()
    order = method.order if method.name == "taylor" and method.order != ORDER else None
    return order, method.by if isinstance(method, WithDerivatives) else ()


def _scene_name(path: Path, data: Data, method: Method) -> str:
    """Return the name of the scene that a certificate names.

    CertificateError is raised unless its sections ``regenerate``, ``title`` and ``kernel`` name the same scene.
    """
    order, jacobian = _options(method)
    options = f" --order {order}" * bool(order) + f" --jacobian {','.join(jacobian)}" * bool(jacobian)
    command = rf"symrot emit (.+) --step {method.name}{re.escape(options)} --target c"
    match = re.fullmatch(command, str(data["regenerate"]))
    if match is None:
        raise CertificateError(
            f"{path}: expected 'regenerate' to be the command that emits the step, `symrot emit SCENE --step "
            f"{method.name}{options} --target c`, got another text"
        )
    slopes = "; with its derivatives, row by row" if jacobian else ""
    title = rf"one time step of the scene {re.escape(repr(match[1]))} \(.*\): next is the state at t \+ dt{slopes}"
    kernel = f"{scene_kernel_name(match[1]).removesuffix('_rates')}_{method.name}_step"
    if not re.fullmatch(title, str(data["title"])) or jacobian_name(kernel, jacobian) != data["kernel"]:
        raise CertificateError(f"{path}: expected 'title' and 'kernel' to name the scene {match[1]}, got others")
    return match[1]


def _of_scene(path: Path, data: Data, method: Method, scene: SceneSource | None) -> str:
    """Compare a step's certificate with the certificate that symrot generates for ``scene``; return a sentence.

    ``scene`` is the user's scene or the shipped scene of the name in the certificate. If it is None, the sentence says
    that the certificate was not compared. CertificateError is raised if the certificates differ.
    """
    if scene is None:
        return (
            "the rates of the motion were not compared with a scene, because symrot has no scene of the name in "
            "the certificate; pass yours by --scene"
        )
    own_scene, (order, jacobian) = load_scene(scene), _options(method)
    own = json.loads(step_text(own_scene, method.name, order, jacobian).certificate())
    for section in SECTIONS:
        if section not in ("bounds", "trusted", "seal") and own[section] != data[section]:
            raise CertificateError(
                f"{path}: expected {section!r} as symrot prints it for the scene {own_scene.name}, got other content"
            )
    return f"rates, parameters and files are those that symrot derives for the scene {own_scene.name}"


def _bounds(path: Path, data: Data, method: Method, source: str, rerun: bool) -> str:
    """Compute the bounds in a step's certificate again; return a sentence that says that they agree.

    CertificateError is raised if they differ. If ``rerun`` is false, stored bounds of rounding errors may be used.
    """
    name, rates = data["kernel"], rates_of(data)
    try:
        section = data["bounds"]["rounding"]
        operations = read_kernel(source, f"symrot_{name}", f"{name}.c")
        box = box_of(section)
        check_section(section, operations, None)
        for index, (symbol, _, value) in enumerate(data["rates"]["parameters"]):
            low, high = box.get(f"p[{index}]", (Fraction(0), Fraction(0)))
            if f"p[{index}]" in box and not low <= Fraction(float.fromhex(value)) <= high:
                raise CertificateError(
                    f"{path}: expected 'box' in 'bounds' to have a range of p[{index}] ({symbol}) that contains its "
                    f"value {float.fromhex(value):.9g}, got {float(low):.9g} to {float(high):.9g}"
                )
        own = bounds_of_step(operations, rates, method, box, rerun)
    except InputError as reason:
        raise CertificateError(f"{path}: {reason}") from None
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as reason:
        raise CertificateError(
            f"{path}: expected the section 'bounds' of rounding errors in the form that symrot prints, got a fault "
            f"in it ({reason}); certify the step again"
        ) from None
    if json.dumps(own, sort_keys=True) != json.dumps(data["bounds"], sort_keys=True):
        raise CertificateError(
            f"{path}: expected the bounds that symrot computes for the ranges in the certificate, got other bounds; "
            "certify the step again"
        )
    agreement = "were computed again and agree" if rerun else "are those that symrot computes"
    return f"bounds of rounding and truncation {agreement}"
