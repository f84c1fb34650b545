"""The parts of a box of angular velocities on which errors of an exact step are bounded one by one.

In a part, no component of the angular velocity changes its sign, and the C text scales all angular velocities by the
same power of two.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import product
from math import frexp, inf, ldexp, ulp

from symrot.errors import InputError

__all__ = ["MIDDLE", "TINY", "Box", "Part", "halves", "power_near", "shells", "signed_parts"]

TINY = 1e-100  # smaller components of omega, relative to the largest, are not covered; the C text takes some as zero
LEAST_POWER, LARGEST_POWER = -1000, 1000  # exponents of two of the scale of omega in the C text
MIDDLE = (
    "expected ranges of omega without rotations near the middle axis, so that the modulus of the elliptic functions is "
    "below 0.7"
)

Box = Mapping[str, tuple[Fraction, Fraction]]  # name of an input, such as "omega_1" or "dt" -> least and largest value
Part = tuple[tuple[float, float], ...]  # the range of each component of omega


def signed_parts(box: Box) -> Iterator[Part]:
    """Split a box of omega by the signs of its components: in a part, each is negative, zero or positive throughout.

    The parts leave out values of a component that are not zero but have a size below TINY times the largest in the box.
    InputError is raised if all values of a component are left out.
    """
    ends = [(float(low), float(high)) for low, high in (box[f"omega_{i}"] for i in (1, 2, 3))]
    least = max(max(max(abs(low), abs(high)) for low, high in ends) * TINY, ulp(0.0))
    choices = []
    for i, (low, high) in enumerate(ends, start=1):
        parts = [(0.0, 0.0)] if low <= 0 <= high else []
        parts += [(max(low, least), high)] if high >= least else []
        parts += [(low, min(high, -least))] if low <= -least else []
        if not parts:
            raise InputError(
                f"expected a range of omega_{i} that contains 0 or a value of at least {least:.3g} rad/s in size "
                f"({TINY:g} times the largest component of omega in the given ranges), got {low:g} to {high:g}"
            )
        choices.append(parts)
    yield from product(*choices)


def shells(part: Part) -> Iterator[tuple[float, Part]]:
    """Split ranges of the components of omega by the power of two that scales omega in the C code.

    The C code divides omega by a power of two near its largest component. Yield pairs (power of two, smaller ranges of
    omega): within the smaller ranges the power is the same.
    InputError is raised if the ranges contain omega = 0 and other values, or if the size of the largest component
    varies by a factor above about 2^8. If omega is 0 throughout, the power is 1.
    """
    smallest = max(min(abs(low), abs(high)) for low, high in part)
    largest = max(max(abs(low), abs(high)) for low, high in part)
    if largest == 0:
        yield 1.0, part
        return
    first, last = frexp(smallest)[1] if smallest else -1100, frexp(largest)[1]
    if last - first > 8:
        raise InputError(f"{MIDDLE}, got ranges that reach omega = 0, or come close to it")
    for exponent in range(first, last + 1):
        most = ldexp(1.0, exponent) if exponent < 1024 else inf
        clipped = tuple((max(low, -most), min(high, most)) for low, high in part)
        largest = max(max(abs(a), abs(b)) for a, b in clipped)
        if all(low <= high for low, high in clipped) and largest >= ldexp(1.0, exponent - 1):
            yield _power(exponent), clipped


def _power(exponent: int) -> float:
    """Return the power of two by which the C code divides omega: ``2**exponent``, but at least 2^-1000, at most 2^1000.

    ``exponent`` is that of the largest component of omega, as :func:`math.frexp` returns it.
    """
    return 2.0 ** min(max(exponent, LEAST_POWER), LARGEST_POWER)


def power_near(largest: float) -> float:
    """Return the power of two by which the C code divides numbers whose largest absolute value is ``largest``."""
    return _power(frexp(largest)[1]) if largest else 1.0


def halves(part: Part) -> tuple[Part, Part]:
    """Return the two halves of ``part``, ranges of the components of omega, divided in the middle of the widest range.

    InputError is raised if no double is inside the widest range, so that the part cannot be divided. This happens where
    no bound of the step's errors is found, however small the part: for example where the modulus of the elliptic
    functions is 0.7 or more.
    """
    widths = [abs(high - low) for low, high in part]
    place = widths.index(max(widths))
    low, high = part[place]
    middle = (low + high) / 2
    if not low < middle < high:
        omega = ", ".join(f"{low:g}" for low, _ in part)
        raise InputError(f"{MIDDLE}, got omega near ({omega}), where symrot finds no bound of the step's errors")
    return tuple((low, middle) if i == place else each for i, each in enumerate(part)), tuple(
        (middle, high) if i == place else each for i, each in enumerate(part)
    )
