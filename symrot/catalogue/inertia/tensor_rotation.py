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
            "If $R$ maps body components to space components, the inertia tensor $I$ in body axes becomes "
            r"$R\,I\,R^{\mathsf T}$ in space axes. The proof treats one point of the body and holds for every "
            r"rotation. If the body rotates, the rate of its tensor in space is a commutator with $\omega$."
        ),
    )
    unit = [unit_relation()]
    dcm_sb, point = Matrix(quaternion_to_dcm()), Matrix(symbols.position)
    d.step(
        "If a point of the body is rotated, its contribution to the inertia tensor is rotated too.",
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
        because=r"$R^{\mathsf T} R = 1$ is applied twice",
        relations=unit,
        named=r"\omega_s \cdot I_s\,\omega_s",
        board=(
            (
                r"$\omega_s = R\,\omega_b$ and $I_s = R\,I_b R^{\mathsf T}$:",
                r"R\,\omega_b \cdot R\,I_b\,R^{\mathsf T} R\,\omega_b",
            ),
            (r"$R^{\mathsf T} R = 1$, and a rotation preserves scalar products:", r"\omega_b \cdot I_b\,\omega_b"),
        ),
        display=r"\omega_b \cdot I_b\,\omega_b",
    )
    d.step(
        "The trace does not depend on the axes. Since $I^2$ is transformed in the same way, its trace does not depend "
        "on them either. With the determinant, the two traces determine the principal moments.",
        turned.trace(),
        TENSOR.trace(),
        because="the trace of a product does not change under cyclic permutation of its factors",
        relations=unit,
        named=r"\mathrm{tr}\,I_s",
        display=r"\mathrm{tr}\,I_b",
    )
    omega_s = dcm_sb * OMEGA
    d.step(
        "In space, the rate of a rotating body's tensor is the commutator of the angular velocity's skew matrix and "
        "the tensor.",
        rate(turned, attitude_rates()),
        skew(omega_s) * turned - turned * skew(omega_s),
        because=r"$\dot R = [\omega_s]_\times R$",
        relations=unit,
        named=r"\dot I_s",
        board=(
            (
                r"The product rule for $I_s = R\,I_b R^{\mathsf T}$:",
                r"\dot R\,I_b\,R^{\mathsf T} + R\,I_b\,\dot R^{\mathsf T}",
            ),
            (
                r"$\dot R = [\omega_s]_\times R$, and the transpose of a skew matrix is its negative:",
                r"[\omega_s]_\times R\,I_b\,R^{\mathsf T} - R\,I_b\,R^{\mathsf T} [\omega_s]_\times",
            ),
            (r"$R\,I_b R^{\mathsf T} = I_s$:", r"[\omega_s]_\times I_s - I_s\,[\omega_s]_\times"),
        ),
        display=r"[\omega_s]_\times I_s - I_s\,[\omega_s]_\times",
    )
    motion = attitude_rates() | pairs(symbols.omega_b, symbols.omega_rates)
    d.notation({}, motion)
    d.step(
        "In the rate of the angular momentum, the rate of the tensor gives the gyroscopic term: this is Euler's "
        "equation in space axes.",
        rate(turned, motion) * omega_s + turned * rate(omega_s, motion),
        turned * dcm_sb * Matrix(symbols.omega_rates) + omega_s.cross(turned * omega_s),
        because=r"$\left( [\omega]_\times I - I\,[\omega]_\times \right) \omega = \omega \times I\,\omega$, and "
        r"$\dot\omega_s = R\,\dot\omega_b$",
        relations=unit,
        named=r"\dot I_s\,\omega_s + I_s\,\dot\omega_s",
        board=(
            (
                "The rate of the tensor is inserted:",
                r"\omega_s \times I_s\,\omega_s - I_s \left( \omega_s \times \omega_s \right) + I_s\,\dot\omega_s",
            ),
            (r"$\omega_s \times \omega_s = 0$:", r"I_s\,\dot\omega_s + \omega_s \times I_s\,\omega_s"),
        ),
        display=r"I_s\,\dot\omega_s + \omega_s \times I_s\,\omega_s",
    )
    d.notation({"I_s": dcm_sb * (symbols.A * eye(3)) * dcm_sb.T})
    d.step(
        "The tensor of a spherical body is constant in space.",
        rate(dcm_sb * (symbols.A * eye(3)) * dcm_sb.T, attitude_rates()),
        0,
        because="a multiple of the unit matrix commutes with every matrix",
        relations=unit,
        named=r"\dot I_s",
    )
    return d
