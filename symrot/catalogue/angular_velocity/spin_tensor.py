"""The spin tensor and the angular velocity (Arnold, Mathematical Methods, 2nd ed., section 26)."""

from sympy import Matrix, eye

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, attitude_rates, pairs, rate, squared
from symrot.kinematics.quaternion import quaternion_rates, quaternion_to_dcm, unit_relation
from symrot.kinematics.rotations import skew, vee
from symrot.proof.derivation import Derivation

MATRIX = Matrix(3, 3, symbols.rotation_entries)
MATRIX_RATE = Matrix(3, 3, symbols.rotation_entry_rates)
OMEGA_S, U = Matrix(symbols.omega_s), Matrix(symbols.position)
P, Q = symbols.second_quaternion, symbols.quaternion


def derive() -> Derivation:
    d = Derivation(
        "spin_tensor",
        title="The spin tensor and the angular velocity",
        source="Arnold, *Mathematical Methods of Classical Mechanics*, 2nd ed., section 26; Goldstein, Poole & Safko, "
        "*Classical Mechanics*, 3rd ed., section 4.9",
        about=(
            r"Because $R R^{\mathsf T} = 1$ at all times, the matrix $W = \dot R R^{\mathsf T}$ (the spin tensor) is "
            "skew. In three dimensions a skew matrix corresponds to a vector, here the angular velocity. This vector "
            "gives the velocities of all points of the body."
        ),
    )
    _skewness(d)
    _frames(d)
    _points(d)
    return d


def _skewness(d: Derivation) -> None:
    d.section("Why the spin tensor is a vector")
    moving = pairs(symbols.rotation_entries, symbols.rotation_entry_rates)
    d.notation({"R": MATRIX, r"\omega": OMEGA_S, "u": U}, moving)
    spin = MATRIX_RATE * MATRIX.T
    d.passage("Let $R$ be any matrix that changes with time, and define", (r"W", r"\dot R\,R^{\mathsf T}"))
    d.step(
        r"The matrix $W + W^{\mathsf T}$ is the rate of $R R^{\mathsf T}$. For a rotation $R R^{\mathsf T} = 1$ is "
        "constant, so $W$ is skew.",
        spin + spin.T,
        rate(MATRIX * MATRIX.T, moving),
        because="the product rule gives one term from each factor",
        named=r"W + W^{\mathsf T}",
        display=r"\frac{d}{dt} \left( R R^{\mathsf T} \right)",
    )
    d.step(
        r"In three dimensions a skew matrix has a vector $\omega$: multiplication by the matrix is the cross product "
        r"with $\omega$.",
        skew(OMEGA_S) * U,
        OMEGA_S.cross(U),
        because=r"a skew matrix has $3 \cdot 2 / 2 = 3$ independent entries",
        named=r"[\omega]_\times u",
        display=r"\omega \times u",
    )
    d.step(
        "The components of the vector are three entries of its skew matrix.",
        vee(skew(OMEGA_S)),
        OMEGA_S,
        because="the other nonzero entries of a skew matrix are their negatives",
        named=r"\mathrm{vee}\,[\omega]_\times",
        display=r"\omega",
    )
    d.step(
        "The square of the skew matrix is symmetric.",
        skew(OMEGA_S) ** 2,
        OMEGA_S * OMEGA_S.T - squared(OMEGA_S) * eye(3),
        because=r"$\omega \times (\omega \times u) = \omega\,(\omega \cdot u) - |\omega|^2 u$",
        named=r"[\omega]_\times^2",
        display=r"\omega\,\omega^{\mathsf T} - |\omega|^2\,\mathbf{1}",
    )


def _frames(d: Derivation) -> None:
    d.section("In space and in the body")
    unit, dcm_sb = [unit_relation()], Matrix(quaternion_to_dcm())
    d.notation({"R": dcm_sb, r"\omega_b": OMEGA, "R_1": dcm_sb, "R_2": quaternion_to_dcm(P)}, attitude_rates())
    d.step(
        r"The skew matrix of a rotated vector is the rotated skew matrix. So $\dot R = [\omega_s]_\times R$ and $\dot "
        r"R = R\,[\omega_b]_\times$ are the same equation, with $\omega_s = R\,\omega_b$.",
        skew(dcm_sb * OMEGA),
        dcm_sb * skew(OMEGA) * dcm_sb.T,
        because="a rotation preserves cross products",
        relations=unit,
        named=r"[R\,\omega_b]_\times",
        display=r"R\,[\omega_b]_\times R^{\mathsf T}",
    )
    motion = attitude_rates()
    d.step(
        r"If $R$ is computed from a unit quaternion, $\dot R R^{\mathsf T}$ is the skew matrix of the angular velocity "
        "in space.",
        rate(dcm_sb, motion) * dcm_sb.T,
        skew(dcm_sb * OMEGA),
        because=r"$\dot q = \tfrac12\,q\,(0, \omega_b)$",
        relations=unit,
        named=r"\dot R R^{\mathsf T}",
        display=r"[R\,\omega_b]_\times",
    )
    # the angular velocity of R_2 relative to the frame of R_1 has components in this frame
    inner = pairs(P, quaternion_rates("space", P) * OMEGA)
    outer = pairs(Q, quaternion_rates("space") * OMEGA_S)
    product = dcm_sb * quaternion_to_dcm(P)
    d.notation({r"\nu": OMEGA}, inner | outer)
    d.step(
        r"Angular velocities add. If $R_1$ rotates with $\omega$ in space, and $R_2$ rotates with $\nu$ relative "
        r"to the frame of $R_1$, then $R_1 R_2$ rotates with $\omega + R_1 \nu$.",
        rate(product, inner | outer),
        skew(OMEGA_S + dcm_sb * OMEGA) * product,
        because=r"$\frac{d}{dt} (R_1 R_2) = \dot R_1 R_2 + R_1 \dot R_2$",
        relations=[unit_relation(Q), unit_relation(P)],
        named=r"\frac{d}{dt} \left( R_1 R_2 \right)",
        board=(
            ("The product rule:", r"\dot R_1 R_2 + R_1 \dot R_2"),
            (
                r"$\dot R_1 = [\omega]_\times R_1$ and $\dot R_2 = [\nu]_\times R_2$:",
                r"[\omega]_\times R_1 R_2 + R_1\,[\nu]_\times R_2",
            ),
            (
                r"A rotated skew matrix is the skew matrix of the rotated vector, $R_1\,[\nu]_\times = [R_1 "
                r"\nu]_\times R_1$:",
                r"\left( [\omega]_\times + [R_1 \nu]_\times \right) R_1 R_2",
            ),
        ),
        display=r"\left[ \omega + R_1 \nu \right]_\times R_1 R_2",
    )


def _points(d: Derivation) -> None:
    d.section("Velocities of points and rates of vectors")
    unit, dcm_sb = [unit_relation()], Matrix(quaternion_to_dcm())
    point, moving = Matrix(symbols.offset), Matrix(symbols.relative_velocity)
    motion = attitude_rates() | pairs(symbols.omega_b, symbols.omega_rates)
    d.notation({"d": point, r"\omega_s": dcm_sb * OMEGA}, motion)
    d.step(
        r"A point of the body has the velocity $\omega \times r$.",
        rate(dcm_sb * point, motion),
        (dcm_sb * OMEGA).cross(dcm_sb * point),
        because="the components of the position in body axes are constant",
        relations=unit,
        named=r"\frac{d}{dt}\,(R\,d)",
        board=(
            ("The vector $d$ is constant:", r"\dot R\,d"),
            (r"$\dot R = R\,[\omega_b]_\times$:", r"R \left( \omega_b \times d \right)"),
            ("A rotation preserves cross products:", r"\omega_s \times R\,d"),
        ),
        display=r"\omega_s \times R\,d",
    )
    d.notation({}, pairs(symbols.offset, moving))
    d.step(
        r"The rate of a vector in space is its rate relative to the body plus the cross product of $\omega$ and the "
        "vector.",
        dcm_sb.T * rate(dcm_sb * point, motion | pairs(symbols.offset, moving)),
        moving + OMEGA.cross(point),
        because="the product rule gives one term from each factor",
        relations=unit,
        named=r"R^{\mathsf T} \frac{d}{dt}\,(R\,d)",
        board=(
            ("The product rule:", r"R^{\mathsf T} \left( R\,\dot d + \dot R\,d \right)"),
            (r"$\dot R = R\,[\omega_b]_\times$:", r"R^{\mathsf T} R \left( \dot d + \omega_b \times d \right)"),
            (r"$R^{\mathsf T} R = 1$:", r"\dot d + \omega_b \times d"),
        ),
        display=r"\dot d + \omega_b \times d",
    )
    d.step(
        "The rate of the angular velocity itself is the same in space and relative to the body.",
        dcm_sb.T * rate(dcm_sb * OMEGA, motion),
        Matrix(symbols.omega_rates),
        because=r"$\omega \times \omega = 0$",
        relations=unit,
        named=r"R^{\mathsf T} \dot\omega_s",
        board=(
            (
                r"The product rule for $\omega_s = R\,\omega_b$:",
                r"R^{\mathsf T} \left( R\,\dot\omega_b + \dot R\,\omega_b \right)",
            ),
            (r"$\dot R = R\,[\omega_b]_\times$ and $R^{\mathsf T} R = 1$:", r"\dot\omega_b + \omega_b \times \omega_b"),
            (r"$\omega_b \times \omega_b = 0$:", r"\dot\omega_b"),
        ),
        display=r"\dot\omega_b",
    )
    velocity = OMEGA_S.cross(U)
    gradient = velocity.jacobian(U)
    d.step(
        "The velocity field of the body has no divergence.",
        gradient.trace(),
        0,
        because="the trace of a skew matrix is zero",
        named=r"\mathrm{div}\,(\omega \times r)",
    )
    d.step(
        "The curl of the velocity field is twice the angular velocity.",
        vee(gradient - gradient.T),
        2 * OMEGA_S,
        because=r"the velocity gradient is $[\omega]_\times$, and the curl contains each entry of it twice",
        named=r"\mathrm{curl}\,(\omega \times r)",
        display=r"2\,\omega",
    )
