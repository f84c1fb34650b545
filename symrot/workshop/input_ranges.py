"""The box of ``--box NAME=LOW:HIGH``: ranges of what a kernel takes, and of the physical constants of a scene."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from sys import float_info

from symrot.certificates.rounding.constants import enclosed
from symrot.certificates.rounding.library import Problem
from symrot.certificates.rounding.scenes import SceneInputs
from symrot.errors import InputError
from symrot.formula import exact_numbers as number
from symrot.formula.tree import names
from symrot.scene.reader import nearest

__all__ = ["boxed"]

Ends = tuple[Fraction, Fraction]
LARGEST = Fraction(float_info.max)
FORM = "expected NAME=LOW:HIGH, such as theta=-1.4:1.4"


def boxed(found: Problem, inputs: SceneInputs | None, ranges: Sequence[str]) -> dict[str, Ends]:
    """Return the box of a kernel, some ranges of it replaced.

    Parameters
    ----------
    found : Problem
        The kernel's own box, the names of its inputs.
    inputs : SceneInputs, optional
        What the parameters of a scene's kernel are; None for a kernel of the library.
    ranges : sequence of str
        ``NAME=LOW:HIGH``: by component ("theta"), by place ("angles[1]"), or of a constant in a scene's parameters.

    Raises
    ------
    InputError
        For a range that is none, an unknown name, a name that is given twice, one way or another.
    """
    given: dict[str, tuple[str, Ends]] = {}
    for text in ranges:
        name, ends = _range(text)
        place = _place(found, inputs, name, text)
        if place in given:
            raise InputError(f"--box {text[:60]}: expected one range of {name}, got {given[place][0][:60]!r} too")
        given[place] = text, ends
    box = {**found.box} | {place: ends for place, (_, ends) in given.items() if place in found.symbols}
    constants = {name: ends for name, (_, ends) in given.items() if name not in found.symbols}
    for place, (name, formula) in (inputs.formulas if inputs else {}).items():
        used = names(formula) & constants.keys()
        if used and place in given:
            both = f"{given[place][0][:60]!r} and {given[min(used)][0][:60]!r}"
            raise InputError(f"--box: expected a range of {name} or of what it is made of, got {both}")
        if used and inputs and place in found.symbols:
            box[place] = enclosed(name, formula, inputs.constants, constants)
            _check_finite(name, box[place], given[min(used)][0])
    return dict(box)


def _range(text: str) -> tuple[str, Ends]:
    name, sign, ends = text.partition("=")
    low, colon, high = ends.partition(":")
    if not sign or not colon or not name.strip():
        raise InputError(f"--box: {FORM}, got {text[:60]!r}")
    where = f"--box {text[:60]}"
    least, largest = number.read(low.strip(), where), number.read(high.strip(), where)
    if least > largest:
        raise InputError(f"{where}: expected the least value first, got {number.show(least)} to {number.show(largest)}")
    _check_finite(name.strip(), (least, largest), text)
    return name.strip(), (least, largest)


def _check_finite(name: str, ends: Ends, text: str) -> None:
    if max(map(abs, ends)) > LARGEST:
        raise InputError(
            f"--box {text[:60]}: expected a range of {name} inside that of a double, which ends at 1.8e308"
        )


def _place(found: Problem, inputs: SceneInputs | None, name: str, text: str) -> str:
    """Return the place of an input, or the name of a constant in a scene's parameters."""
    for place, symbol in found.symbols.items():
        if name in (place, symbol):
            return place
    constants: Mapping[str, Fraction] = inputs.constants if inputs else {}
    if name in constants:
        return name
    known = [*found.symbols.values(), *constants]
    hint = nearest(name, known)
    what = "an input of the kernel or a constant in its parameters" if constants else "an input"
    said = f"--box {text[:60]}: expected {what}, one of {', '.join(known)}, got {name[:60]!r}"
    raise InputError(f"{said} ({hint})" if hint else said)
