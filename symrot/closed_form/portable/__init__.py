"""Motions in closed form for use without a C compiler: mpmath computes the constants, NumPy the samples.

They use the formulas of the C files. They are slower (milliseconds for the constants, about a microsecond for each
sample) but equally accurate: constants have 120 digits, and phases are reduced to a fraction of a revolution. Tests
compare them with the results of C.
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
"""The motions of this folder by the names of the corresponding C files; arguments as for the C functions."""
