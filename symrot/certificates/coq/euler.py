"""Coq theorems about Euler angles in 24 sequences: the angle rates agree with the rotation matrix's derivative.

The matrix is a product of three rotations. ``rotation.v`` proves that its angular velocity is the sum of the three
rotations' angular velocities, in one frame. The theorems here prove that the printed rate Jacobian gives this sum.
"""

from sympy import cos, sin

from symrot import symbols
from symrot.certificates.coq.file import CoqFile, Theorem, derivatives, statement
from symrot.certificates.coq.text import coq_expression, definition_text
from symrot.conventions import AXES, SEQUENCES, parse_sequence
from symrot.kernels.euler import prefix
from symrot.kernels.library import definition
from symrot.kinematics.euler import factors, rate_jacobian

__all__ = ["euler_file", "euler_files"]

ANGLES = tuple(map(str, symbols.angles))
RATES = tuple(map(str, symbols.angle_rates))
OMEGA = {"body": tuple(map(str, symbols.omega_b)), "space": tuple(map(str, symbols.omega_s))}
DCM_RATE = {"body": "{dcm} *m skew {omega}", "space": "skew {omega} *m {dcm}"}  # dR/dt in terms of omega

_AT_T = " ".join(f"({angle} t)" for angle in ANGLES)
_DCM = f"dcm {_AT_T}"
_PATH = "fun u => dcm " + " ".join(f"({angle} u)" for angle in ANGLES)
_HYPOTHESES = derivatives(ANGLES, RATES)
_PRINTED = {
    "dcm": "dcm",
    "body_jacobian": "body_jacobian",
    "space_jacobian": "space_jacobian",
    "body_rates": "body_rates",
    "space_rates": "space_rates",
    "unit_quaternion": "quaternion",
}  # name in Coq -> end of the kernel's name


def euler_files() -> dict[str, str]:
    """Return a map from the name of each Coq file about Euler angles to its sequence: ``euler_zxz`` -> ``"ZXZ"``."""
    return {prefix(sequence): sequence for sequence in SEQUENCES}


def euler_file(sequence: str) -> CoqFile:
    """Return the Coq file about the kernels of one Euler sequence, such as ``"ZXZ"`` or ``"zxz"``."""
    name = prefix(sequence)
    kind = "intrinsic" if parse_sequence(sequence)[1] else "extrinsic"
    return CoqFile(
        name,
        f"Euler angles of the {kind} sequence {sequence}: the formulas of its kernels, and what they are.",
        ("rotation",),
        tuple(definition_text(definition(f"{name}_{suffix}"), local) for local, suffix in _PRINTED.items()),
        (
            _dcm(name, sequence),
            *(_jacobian(name, sequence, frame) for frame in OMEGA),
            *(_determinant(name, sequence, frame) for frame in OMEGA),
            *(_rates(name, sequence, frame) for frame in OMEGA),
            _quaternion(name, sequence),
        ),
    )


def _rotations(sequence: str) -> list[tuple[str, str]]:
    """Return the rotations of an Euler sequence, from left to right, such as ``("z", "phi")``, about axis z."""
    return [(AXES[factor.axis].lower(), str(factor.angle)) for factor in factors(sequence)]


def _dcm(name: str, sequence: str) -> Theorem:
    product = " *m ".join(f"R{axis} {angle}" for axis, angle in _rotations(sequence))
    dcm_text = f"dcm {' '.join(ANGLES)}"
    return Theorem(
        f"{name}_dcm",
        f"The matrix dcm is the product of the three turns of {sequence}.",
        statement(f"{' '.join(ANGLES)} : R", conclusion=f"{dcm_text} = {product}"),
        "  intros. unfold dcm. by_ring.",
    )


def _jacobian(name: str, sequence: str, frame: str) -> Theorem:
    omega = f"{frame}_jacobian {_AT_T} *v vec {' '.join(RATES)}"
    derived = DCM_RATE[frame].format(dcm=f"{_DCM}", omega="omega")
    turns = [(axis, angle, RATES[ANGLES.index(angle)]) for axis, angle in _rotations(sequence)]
    carrying = turns[1:] if frame == "body" else turns[:-1]  # rotations that carry the others' omega into the frame
    steps = [
        "  intros phi theta psi t dphi dtheta dpsi Dphi Dtheta Dpsi omega.",
        f"  eapply (three_turns_{frame} ({_PATH})).",
        f"  - intro u. apply {name}_dcm.",
        *(f"  - apply R{axis}_rotation." for axis, _, _ in carrying),
        *(f"  - exact (R{axis}_{frame} {angle} t {rate} D{angle})." for axis, angle, rate in turns),
        f"  - unfold omega, {frame}_jacobian. by_ring.",
    ]
    return Theorem(
        f"{name}_{frame}_jacobian",
        f"Where the angles have derivatives, the dcm R has one: "
        f"dR/dt = {'R skew(omega)' if frame == 'body' else 'skew(omega) R'} with omega = B(angles) dangles/dt in the "
        f"{frame} frame.",
        statement(
            f"({' '.join(ANGLES)} : R -> R) (t {' '.join(RATES)} : R)",
            _HYPOTHESES,
            f"  let omega := {omega} in",
            conclusion=f"derivative ({_PATH}) t\n  ({derived})",
        ),
        "\n".join(steps),
    )


def _determinant(name: str, sequence: str, frame: str) -> Theorem:
    jacobian = f"{frame}_jacobian {' '.join(ANGLES)}"
    value = coq_expression(rate_jacobian(sequence, frame).determinant)
    circles = ", ".join(f"(sine_square {angle})" for angle in ANGLES).replace(",", "")
    return Theorem(
        f"{name}_{frame}_determinant",
        "Where the sequence locks: the determinant of B.",
        statement(f"{' '.join(ANGLES)} : R", conclusion=f"det ({jacobian}) = {value}"),
        f"  intros. unfold {frame}_jacobian. spread. ring [{circles}].",
        kernel=False,
    )


def _rates(name: str, sequence: str, frame: str) -> Theorem:
    omega = f"vec {' '.join(OMEGA[frame])}"
    rates = f"{frame}_rates {_AT_T} {' '.join(OMEGA[frame])}"
    (middle,) = rate_jacobian(sequence, frame).determinant.atoms(
        sin, cos
    )  # the sine or cosine that is zero at the singularity
    locked = f"{middle.func.__name__} (theta t)"
    circles = " ".join(f"(sine_square ({angle} t))" for angle in ANGLES)
    derived = DCM_RATE[frame].format(dcm=_DCM, omega=f"({omega})")
    steps = [
        f"  intros phi theta psi t dphi dtheta dpsi {' '.join(OMEGA[frame])} Dphi Dtheta Dpsi K.",
        f"  assert (N : {locked} <> 0).",
        f"  {{ intro E. apply K. rewrite {name}_{frame}_determinant, E. ring. }}",
        f"  apply (only_{frame}_rates ({_PATH}) t ({frame}_jacobian {_AT_T})).",
        f"  - rewrite {name}_dcm. repeat apply rotation_mmul; first [apply Rx_rotation | apply Ry_rotation | "
        "apply Rz_rotation].",
        f"  - exact ({name}_{frame}_jacobian phi theta psi t dphi dtheta dpsi Dphi Dtheta Dpsi).",
        "  - exact K.",
        f"  - unfold {frame}_jacobian, {frame}_rates. spread. f_equal; field [{circles}]; exact N.",
    ]
    return Theorem(
        f"{name}_{frame}_rates",
        f"Off the lock, the angles move at the printed rates if and only if the dcm turns with the angular velocity "
        f"omega, given in the {frame} frame.",
        statement(
            f"({' '.join(ANGLES)} : R -> R) (t {' '.join(RATES)} {' '.join(OMEGA[frame])} : R)",
            _HYPOTHESES,
            f"  det ({frame}_jacobian {_AT_T}) <> 0 ->",
            conclusion=f"(derivative ({_PATH}) t\n   ({derived})\n <->\n vec {' '.join(RATES)} = {rates})",
        ),
        "\n".join(steps),
    )


def _quaternion(name: str, sequence: str) -> Theorem:
    quaternion = f"unit_quaternion {' '.join(ANGLES)}"
    turns = [f"Q{axis} {angle}" for axis, angle in _rotations(sequence)]
    steps = [
        "  intros. rewrite " + f"{name}_dcm.",
        f"  replace ({quaternion}) with ({' *q '.join(turns)})",
        "    by (unfold unit_quaternion, Qx, Qy, Qz; by_ring).",
        "  repeat apply represents_qmul; first [apply Qx_represents | apply Qy_represents | apply Qz_represents].",
    ]
    return Theorem(
        f"{name}_quaternion",
        "The quaternion of the angles is a unit quaternion, and it turns vectors as the dcm does.",
        statement(f"{' '.join(ANGLES)} : R", conclusion=f"represents ({quaternion}) (dcm {' '.join(ANGLES)})"),
        "\n".join(steps),
    )
