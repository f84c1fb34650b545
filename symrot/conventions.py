"""The conventions of symrot, stated once.

Frames
    Right-handed. ``s`` is the space frame (fixed axes), ``b`` the body frame (axes that rotate with the body).
    A suffix names the frame whose components are meant: ``omega_b``, ``omega_s``.
Direction cosine matrix
    ``dcm_sb`` maps body components to space components: ``v_s = dcm_sb * v_b`` (SciPy ``Rotation.as_matrix()``).
    ``dcm_bs`` is its transpose, the matrix A of Goldstein.
Quaternion
    ``(q0, q1, q2, q3)``: unit, scalar first, Hamilton (``i j = k``), body to space: ``v_s = q v_b q*``.
Rates
    ``dq/dt = 1/2 q (0, omega_b) = 1/2 (0, omega_s) q``, rad/s. Euler's equations are in body axes.
Euler sequences
    ``"ZXZ"`` upper case: intrinsic, ``dcm_sb = Rz(q1) Rx(q2) Rz(q3)``. ``"zxz"`` lower case: extrinsic,
    ``dcm_sb = Rz(q3) Rx(q2) Rz(q1)``. Angles in order of application, rad.
Inertia tensor
    ``I_xy = -integral of x y dm``: products carry the minus sign. About the centre of mass, or about the
    fixed point of a body that has one.
State
    The propagated numbers: ``omega_b`` (3), quaternion (4), then further states such as a clock. symrot leaves out
    the numbers that a scene does not need (:mod:`symrot.planning.plan`).
Units
    SI; angles in rad unless a label says deg.
"""

__all__ = [
    "AXES",
    "EXTRINSIC_SEQUENCES",
    "INTRINSIC_SEQUENCES",
    "SEQUENCES",
    "check_frame",
    "parse_sequence",
]

from itertools import product

from symrot.errors import InputError

AXES = "XYZ"

INTRINSIC_SEQUENCES: tuple[str, ...] = tuple(a + b + c for a, b, c in product(AXES, repeat=3) if a != b != c)
EXTRINSIC_SEQUENCES: tuple[str, ...] = tuple(name.lower() for name in INTRINSIC_SEQUENCES)
SEQUENCES: tuple[str, ...] = INTRINSIC_SEQUENCES + EXTRINSIC_SEQUENCES


def parse_sequence(name: str) -> tuple[tuple[int, int, int], bool]:
    """Return the three axis numbers (0, 1, 2) of an Euler sequence, and whether it is intrinsic.

    Parameters
    ----------
    name : str
        Three axis letters, upper case for intrinsic, lower case for extrinsic, such as ``"ZXZ"`` or ``"zyx"``.

    Raises
    ------
    InputError
        If the name is not one of the 24 sequences: wrong length, mixed case, unknown letter, or two equal
        neighbours (which would leave only two degrees of freedom).
    """
    if not isinstance(name, str) or name not in SEQUENCES:
        raise InputError(
            "an Euler sequence is three axis letters, neighbours different, all upper case (intrinsic) or all lower "
            f"case (extrinsic), such as 'ZXZ' or 'zyx'; got {name!r}"
        )
    first, second, third = (AXES.index(letter) for letter in name.upper())
    return (first, second, third), name.isupper()


def check_frame(frame: str) -> str:
    """Return ``frame``, which says whether omega has body or space components.

    Anything but ``"body"`` and ``"space"`` raises ``InputError``.
    """
    if frame not in ("body", "space"):
        raise InputError(f"frame: expected 'body' or 'space', the frame of the components of omega; got {frame!r}")
    return frame
