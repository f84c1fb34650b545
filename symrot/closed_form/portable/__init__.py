"""Motions in closed form that need no C compiler: mpmath computes the constants, NumPy the samples.

They also compute heavy tops so near to the separatrix that the 31 digits of C do not determine the motion.

The formulas are the same as in the C files. The motions are slower (milliseconds for the constants, about a microsecond
for each sample) but equally accurate, since constants have 120 digits. Tests compare the samples with those of the C
code.
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
"""The motions of this folder by the names of the corresponding C files; arguments are those of the C functions."""
