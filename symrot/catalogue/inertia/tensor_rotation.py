"""The components of the inertia tensor in rotated axes."""

from sympy import Matrix, eye

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, attitude_rates, pairs, rate
from symrot.inertia.tensor import inertia_of_point, rotate
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation


def derive() -> Derivation:
    d = Derivation(
        "tensor_rotation",
        title="The inertia tensor in other axes",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 5.2",
        about=(
            "Turning the axes by $R$ takes the tensor to $R\\,I\\,R^{\\mathsf T}$. One point of the body "
            "proves it, for "
            "every rotation; and as the body turns, its tensor in space changes by the commutator with $\\omega$."
        ),
    )
    unit = [unit_relation()]
    dcm_sb, point = Matrix(quaternion_to_dcm()), Matrix(symbols.position)
    d.step(
        "A point that is turned has the turned tensor.",
        Matrix(inertia_of_point(symbols.m, dcm_sb * point)),
        Matrix(rotate(inertia_of_point(symbols.m, point), dcm_sb)),
        because="$R$ preserves lengths, and $(R r)(R r)^{\\mathsf T} = R\\,r\\,r^{\\mathsf T} R^{\\mathsf T}$",
        relations=unit,
        named="I(R r)",
        display=r"R\,I(r)\,R^{\mathsf T}",
    )
    turned = dcm_sb * TENSOR * dcm_sb.T
    d.notation(
        {"R": dcm_sb, r"\omega_s": dcm_sb * OMEGA, r"\omega_b": OMEGA, "I_s": turned, "I_b": TENSOR}, attitude_rates()
    )
    d.step(
        "The kinetic energy does not depend on the axes.",
        (dcm_sb * OMEGA).dot(turned * dcm_sb * OMEGA),
        OMEGA.dot(TENSOR * OMEGA),
        because="$R^{\\mathsf T} R = 1$, twice",
        relations=unit,
        named=r"\omega_s \cdot I_s\,\omega_s",
        display=r"\omega_b \cdot I_b\,\omega_b",
    )
    d.step(
        "Nor does the trace; and as the square of the tensor turns in the same way, nor its trace: with "
        "the determinant "
        "they fix the principal moments.",
        turned.trace(),
        TENSOR.trace(),
        because="the trace of a product does not change under cyclic permutation of its factors",
        relations=unit,
        named=r"\mathrm{tr}\,I_s",
        display=r"\mathrm{tr}\,I_b",
    )
    omega_s = dcm_sb * OMEGA
    d.step(
        "The tensor of a turning body, in space.",
        rate(turned, attitude_rates()),
        skew(omega_s) * turned - turned * skew(omega_s),
        because=r"$\dot R = [\omega_s]_\times R$",
        relations=unit,
        named=r"\dot I_s",
        display=r"[\omega_s]_\times I_s - I_s\,[\omega_s]_\times",
    )
    motion = attitude_rates() | pairs(symbols.omega_b, symbols.omega_rates)
    d.notation({}, motion)
    d.step(
        "In the rate of angular momentum the changing tensor makes the gyroscopic term: Euler's equations, in axes of "
        "space.",
        rate(turned, motion) * omega_s + turned * rate(omega_s, motion),
        turned * dcm_sb * Matrix(symbols.omega_rates) + omega_s.cross(turned * omega_s),
        because=r"$\left( [\omega]_\times I - I\,[\omega]_\times \right) \omega = \omega \times I\,\omega$, and "
        r"$\dot\omega_s = R\,\dot\omega_b$",
        relations=unit,
        named=r"\dot I_s\,\omega_s + I_s\,\dot\omega_s",
        display=r"I_s\,\dot\omega_s + \omega_s \times I_s\,\omega_s",
    )
    d.notation({"I_s": dcm_sb * (symbols.A * eye(3)) * dcm_sb.T})
    d.step(
        "It stays constant if the body is spherical.",
        rate(dcm_sb * (symbols.A * eye(3)) * dcm_sb.T, attitude_rates()),
        0,
        because="a multiple of the unit matrix commutes with every matrix",
        relations=unit,
        named=r"\dot I_s",
    )
    return d
