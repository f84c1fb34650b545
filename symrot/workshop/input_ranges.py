"""The reader of ``--box NAME=LOW:HIGH``, the option with ranges of inputs and of a scene's physical constants."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from sys import float_info

from symrot.certificates.rounding.constants import parameter_range
from symrot.certificates.rounding.library import RoundingProblem
from symrot.certificates.rounding.scenes import SceneInputs
from symrot.errors import InputError, nearest
from symrot.formula import exact_numbers
from symrot.formula.tree import names

__all__ = ["input_box", "plain_box"]

Ends = tuple[Fraction, Fraction]
LARGEST = Fraction(float_info.max)
FORM = "expected NAME=LOW:HIGH, such as theta=-1.4:1.4"


def input_box(kernel_problem: RoundingProblem, inputs: SceneInputs | None, ranges: Sequence[str]) -> dict[str, Ends]:
    """Return the box of a kernel: for each input the user's range or, if the user gives none, the kernel's own range.

    An input without either is not in the box. If the user gives a range of a physical constant, the ranges of the
    parameters that depend on this constant are computed from it.

    Parameters
    ----------
    kernel_problem : RoundingProblem
        The kernel's own box and the names of its inputs.
    inputs : SceneInputs, optional
        The parameters of a scene's kernel as formulas; None for a library kernel.
    ranges : sequence of str
        ``NAME=LOW:HIGH``, where NAME is a component ("theta"), an index ("angles[1]") or a constant in a scene's
        parameters.

    Raises
    ------
    InputError
        For a malformed range, an unknown name, or two ranges of the same input (by name, index or constant).
    """
    by_place: dict[str, tuple[str, Ends]] = {}
    for text in ranges:
        name, ends = _range(text)
        place = _place(kernel_problem, inputs, name, text)
        if place in by_place:
            raise InputError(f"--box {text[:60]}: expected one range of {name}, got also {by_place[place][0][:60]!r}")
        by_place[place] = text, ends
    box = {**kernel_problem.box} | {
        place: ends for place, (_, ends) in by_place.items() if place in kernel_problem.symbols
    }
    constants = {name: ends for name, (_, ends) in by_place.items() if name not in kernel_problem.symbols}
    for place, (name, formula) in (inputs.formulas if inputs else {}).items():
        used = names(formula) & constants.keys()
        if used and place in by_place:
            both = f"{by_place[place][0][:60]!r} and {by_place[min(used)][0][:60]!r}"
            raise InputError(
                f"--box: expected either a range of {name} or ranges of the constants from which it follows, "
                f"got both: {both}; leave one out"
            )
        if used and inputs and place in kernel_problem.symbols:
            box[place] = parameter_range(name, formula, inputs.constants, constants)
            _check_finite(name, box[place], by_place[min(used)][0])
    return dict(box)


def plain_box(ranges: Sequence[str]) -> dict[str, Ends]:
    """Return the ranges ``NAME=LOW:HIGH`` by name, with ends rounded to doubles.

    InputError is raised for a malformed range, or for two ranges of one name.
    """
    box: dict[str, Ends] = {}
    for text in ranges:
        name, (low, high) = _range(text)
        if name in box:
            raise InputError(f"--box {text[:60]}: expected one range of {name}, got two")
        box[name] = Fraction(float(low)), Fraction(float(high))
    return box


def _range(text: str) -> tuple[str, Ends]:
    name, sign, ends = text.partition("=")
    low, colon, high = ends.partition(":")
    if not sign or not colon or not name.strip():
        raise InputError(f"--box: {FORM}, got {text[:60]!r}")
    where = f"--box {text[:60]}"
    least, largest = exact_numbers.read(low.strip(), where), exact_numbers.read(high.strip(), where)
    if least > largest:
        ends_text = f"{exact_numbers.show(least)} to {exact_numbers.show(largest)}"
        raise InputError(f"{where}: expected the smaller value first, got {ends_text}")
    _check_finite(name.strip(), (least, largest), text)
    return name.strip(), (least, largest)


def _check_finite(name: str, ends: Ends, text: str) -> None:
    if max(map(abs, ends)) > LARGEST:
        raise InputError(f"--box {text[:60]}: expected a range of {name} within the range of a double, at most 1.8e308")


def _place(kernel_problem: RoundingProblem, inputs: SceneInputs | None, name: str, text: str) -> str:
    """Return the input component that ``name`` means, such as ``angles[1]``, or the name of a scene's constant.

    ``text`` is the whole range, NAME=LOW:HIGH, for messages.
    """
    for place, symbol in kernel_problem.symbols.items():
        if name in (place, symbol):
            return place
    constants: Mapping[str, Fraction] = inputs.constants if inputs else {}
    if name in constants:
        return name
    known = [*kernel_problem.symbols.values(), *constants]
    hint = nearest(name, known)
    what = "an input of the kernel or a constant in its parameters" if constants else "an input"
    message = f"--box {text[:60]}: expected {what}, one of {', '.join(known)}, got {name[:60]!r}"
    raise InputError(f"{message} ({hint})" if hint else message)
