"""Times of derivations: the rate Jacobians of every Euler sequence in both frames, and the inertia of every solid.

``python -m symrot.bench.derive`` prints seconds of processor time, without the import of SymPy.
"""

import sys
from collections.abc import Callable
from time import process_time

from symrot.conventions import SEQUENCES
from symrot.inertia.shapes import SHAPES

__all__ = ["main"]


def _sequences() -> int:
    from symrot.kinematics.euler import rate_jacobian

    made = [rate_jacobian(sequence, frame) for sequence in SEQUENCES for frame in ("body", "space")]
    return len([(jacobian.inverse, jacobian.determinant) for jacobian in made])


def _solids() -> int:
    from symrot.inertia.solids import solid

    return len([solid(name).inertia for name, shape in SHAPES.items() if shape.kind != "points"])


ROWS: tuple[tuple[str, Callable[[], int]], ...] = (
    ("Euler rate Jacobians with inverse and determinant", _sequences),
    ("inertia tensors of solids by integration", _solids),
)


def main() -> int:
    """Print the processor time of deriving all Euler rate Jacobians and the inertia tensors of all solids."""
    import sympy

    print(f"SymPy {sympy.__version__}")
    for name, derive in ROWS:
        began = process_time()
        count = derive()
        print(f"  {process_time() - began:6.2f} s  {count:3d} {name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
