"""The motions in closed form for use without a C compiler: constants by mpmath, samples by NumPy, the same formulas.

They are slower (milliseconds for the constants, about a microsecond for each sample) and equally accurate: the
constants have 120 digits, and phases are represented in turns. Tests compare the results of C with them.
"""

from collections.abc import Callable
from typing import Any

from symrot.closed_form.portable.free_body import PortableFreeBody
from symrot.closed_form.portable.gyrostat import PortableGyrostat
from symrot.closed_form.portable.heavy_top import PortableHeavyTop

__all__ = ["MOTIONS"]

MOTIONS: dict[str, Callable[..., Any]] = {
    "free_body": PortableFreeBody,
    "gyrostat": PortableGyrostat,
    "heavy_top": PortableHeavyTop,
}
"""The motions by the names of their C files, with the arguments of the C functions."""
