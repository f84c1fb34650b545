"""The certificate of an emitted time step of a scene, with bounds of its errors.

`symrot certify SCENE --step METHOD` prints or writes it.
"""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from symrot.certificates.certificate import Data, certificate_json
from symrot.certificates.readback.readback import read_kernel
from symrot.certificates.rounding.bounds_text import rounded_up
from symrot.certificates.rounding.library import RoundingProblem
from symrot.certificates.rounding.region import EVERYWHERE
from symrot.certificates.rounding.scenes import scene_problem
from symrot.certificates.step_certificate import bounds_of_step, rates_of, with_bounds
from symrot.codegen.steps import step_signature
from symrot.errors import InputError
from symrot.report.layout import fields
from symrot.workshop.input_ranges import input_box, plain_box
from symrot.workshop.kernel_files import write_files
from symrot.workshop.step_text import StepText, step_text
from symrot.workshop.steps.exact import ExactStepText

__all__ = ["certify_step", "lines", "proofs"]


def certify_step(
    scene: str, step: str, order: int | None = None, ranges: Sequence[str] = (), directory: Path | None = None,
    progress: Callable[[str], object] = lambda text: None,
) -> tuple[Data, list[Path]]:  # fmt: skip
    """Return the certificate of a time step of a scene's motion, and the paths of the written files.

    Parameters
    ----------
    scene : str
        The name of a shipped scene or the path of a scene file.
    step, order
        As for :func:`symrot.emit`.
    ranges : sequence of str
        ``NAME=LOW:HIGH``: the box on which the errors of one step are bounded. NAME is a state, dt, t or a physical
        constant. Without ranges, the certificate has no bounds.
    directory : Path, optional
        Folder for the step and its certificate; without it no file is written.

    Raises
    ------
    InputError
        For a step that cannot be emitted, an incomplete box, or a box on which an error has no bound.
    CertificateError
        If the C text does not compute the formulas of the method.
    """
    printed = step_text(scene, step, order)
    progress("proving ..")
    text = printed.certificate()
    if ranges and isinstance(printed, ExactStepText):
        progress("bounding ..")
        text = certificate_json(with_bounds(json.loads(text), printed.bounds(plain_box(ranges))))
    if ranges and isinstance(printed, StepText):
        progress("bounding ..")
        data = json.loads(text)
        text = certificate_json(with_bounds(data, _bounds(printed, data, ranges)))
    texts = printed.c_files() | {f"{printed.name}.cert.json": text}
    return json.loads(text), write_files(directory, texts) if directory else []


def _bounds(step: StepText, data: Data, ranges: Sequence[str]) -> Data:
    """Return the section ``bounds`` of a step's certificate: rounding and truncation on the box ``ranges``."""
    # ``data`` is the rest of the certificate, which states the rates dy/dt of the motion
    rates, name = rates_of(data), f"symrot_{step.name}"
    operations = replace(read_kernel(step.c()[0], name, f"{step.name}.c"), name=step.name)
    inputs = replace(step.rates.inputs, arguments=step_signature(rates, step.name).arguments)
    known = scene_problem(inputs, operations)
    problem = RoundingProblem(known.box, EVERYWHERE, known.symbols)
    box = input_box(problem, inputs, ranges)
    lacking = [f"--box {symbol}=LOW:HIGH" for place, symbol in problem.symbols.items() if place not in box]
    if lacking:
        raise InputError(
            f"{step.name}: expected {' '.join(lacking)} in addition to the ranges that the scene gives, got "
            f"{' '.join(ranges)[:60]}"
        )
    return bounds_of_step(operations, rates, step.method, {place: box[place] for place in operations.inputs})


def proofs(data: Data) -> tuple[str, ...]:
    """Return the kinds of proof in the certificate of a step, such as ``("C text", "rounding", "truncation")``.

    The result is empty for an exact step with elliptic functions (a closed form of the motion): its C text is checked
    at some states, which is no proof.
    """
    if "scene" in data:
        return ()
    return ("C text", "rounding", "truncation") if "bounds" in data else ("C text",)


def lines(data: Data) -> list[str]:
    """Return the lines that `symrot certify SCENE --step METHOD` prints about the step's certificate."""
    rows = [("method", data["method"])]
    if "scene" in data:
        return _printed(data, [*rows, *_law_rows(data)])
    for name, function in data["formula"].items():
        count = sum(function["operations"].values())
        rows.append(
            (
                "C text",
                f"{name} and its batch function compute the formula of the method in {count} operations (equal at "
                f"{function['points']} random points; wrong with a probability below "
                f"{function['wrong_with_probability_below']})",
            )
        )
        if "motion" in function:
            chance = function["motion"]["wrong_with_probability_below"]
            rows.append(
                (
                    "motion",
                    f"{name} solves the equations of the rates exactly (wrong with a probability below {chance})",
                )
            )
    if "bounds" in data:
        rows += _bound_rows(data["bounds"], [name for name, _ in data["rates"]["states"]])
    else:
        rows.append(("errors", "not bounded; --box omega_1=-1:1 .. --box dt=0:0.01 bounds rounding and truncation"))
    return _printed(data, rows)


def _law_rows(data: Data) -> list[tuple[str, str]]:
    """Return pairs (label, text) about a step that computes a closed form of the motion with elliptic functions.

    They say at how many states the C text was checked against the equations of motion, and how large its errors can be.
    """
    rows = [
        (
            "C text",
            f"{name} solves the equations of motion at {law['states']} of {law['states']} states to {law['digits']} "
            f"digits (largest difference {law['largest_violation']}); checked, not proven",
        )
        for name, law in data["formula"].items()
    ]
    if "bounds" not in data:
        return [
            *rows,
            ("errors", "not bounded; --box bounds them for a free body that does not rotate near its middle axis"),
        ]
    bounds = {kind: data["bounds"][kind] for kind in ("rounding", "truncation")}
    return rows + [
        _error_row(kind, {state: float.fromhex(value) for state, value in errors.items()})
        for kind, errors in bounds.items()
    ]


def _printed(data: Data, rows: Sequence[tuple[str, str]]) -> list[str]:
    return [f"{data['kernel']}: {data['title']}", *fields((f"  {label}", text) for label, text in rows)]


def _bound_rows(bounds: Mapping[str, Any], states: Sequence[str]) -> list[tuple[str, str]]:
    rounding = {
        state: float.fromhex(output["absolute"])
        for state, output in zip(states, bounds["rounding"]["precisions"][0]["outputs"], strict=True)
    }
    truncation = {state: float.fromhex(value) for state, value in bounds["truncation"].items()}
    return [_error_row("rounding", rounding), _error_row("truncation", truncation)]


def _error_row(kind: str, errors: Mapping[str, float]) -> tuple[str, str]:
    """Return a pair (label, text) that states the largest error bound of all states.

    ``kind`` is the kind of error, ``"rounding"`` or ``"truncation"``; ``errors`` maps each state to its error bound.
    """
    worst = max(errors, key=errors.__getitem__)
    if not errors[worst]:
        return kind, "none"
    return (
        kind,
        f"at most {rounded_up(Fraction(errors[worst]), 2)} in one step for inputs in the ranges of --box, in double "
        f"precision ({worst})",
    )
