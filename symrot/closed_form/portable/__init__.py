"""The exact motions without a C compiler: constants by mpmath, samples by NumPy, the same formulas.

Slower (milliseconds to find the constants, about a microsecond for each sample) and as exact: the constants have 120
digits, and phases are carried in turns. What C returns is held against it in tests.
"""

from collections.abc import Callable
from typing import Any

from symrot.closed_form.portable.free_body import FreeBody
from symrot.closed_form.portable.gyrostat import Gyrostat
from symrot.closed_form.portable.heavy_top import HeavyTop

__all__ = ["MOTIONS"]

MOTIONS: dict[str, Callable[..., Any]] = {"free_body": FreeBody, "gyrostat": Gyrostat, "heavy_top": HeavyTop}
"""Each motion by the name of its C file; it takes what the C function takes."""
