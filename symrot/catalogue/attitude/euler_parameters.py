"""Euler angles and Euler parameters (Goldstein, 3rd ed., section 4.5; Bernardes & Viollet, PLoS ONE 17, 2022)."""

from sympy import Matrix, cos, pi, sin

from symrot import symbols
from symrot.catalogue.tools.motion import squared
from symrot.conventions import INTRINSIC_SEQUENCES
from symrot.kinematics.euler import dcm, quaternion_of_euler
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.proof.derivation import Derivation, Step
from symrot.proof.notation.printer import formula

PHI, THETA, PSI = symbols.angles
Q = symbols.quaternion


def derive() -> Derivation:
    d = Derivation(
        "euler_parameters",
        title="Euler parameters from Euler angles",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 4.5; Bernardes & Viollet, *PLoS "
        "ONE* 17 "
        "(2022) e0276302",
        about=(
            "The Euler parameters of an attitude are the components of its unit quaternion. The quaternion is the "
            r"product of one factor $\cos\frac{q}{2} + e \sin\frac{q}{2}$ for each of the three rotations, where $q$ "
            "is the angle and $e$ the axis. The parameters contain half the sum and half the difference of the first "
            "and the last angle; the angles follow from them."
        ),
    )
    _precession(d)
    _all(d)
    return d


def _precession(d: Derivation) -> None:
    d.section("Precession, nutation, spin: ZXZ")
    q = Matrix(quaternion_of_euler("ZXZ"))
    total, difference = (PHI + PSI) / 2, (PHI - PSI) / 2
    d.step(
        "The quaternion is the product of three factors, one for each rotation.",
        q,
        Matrix(
            [
                cos(THETA / 2) * cos(total),
                sin(THETA / 2) * cos(difference),
                sin(THETA / 2) * sin(difference),
                cos(THETA / 2) * sin(total),
            ]
        ),
        because="the product of the half angles' sines and cosines is written with the sum and the difference of the "
        "first and the last angle",
        named=r"\begin{bmatrix} q_0 \\ q_1 \\ q_2 \\ q_3 \end{bmatrix}",
    )
    d.step(
        "The quaternion has norm 1.",
        squared(q),
        1,
        because="each factor of the product has unit norm",
        named="|q|^2",
    )
    tilt = dict(zip(Q, q, strict=True))
    d.step(
        "Two sums of squares of the parameters depend on the nutation alone.",
        Matrix([Q[0] ** 2 + Q[3] ** 2, Q[1] ** 2 + Q[2] ** 2]).subs(tilt),
        Matrix([cos(THETA / 2) ** 2, sin(THETA / 2) ** 2]),
        because=r"$\cos^2 + \sin^2 = 1$ for half the sum and half the difference of $\phi$ and $\psi$",
        named=r"\begin{bmatrix} q_0^2 + q_3^2 \\ q_1^2 + q_2^2 \end{bmatrix}",
    )
    d.step(
        r"The first and the last angle follow from $\frac{\phi + \psi}{2} = \mathrm{atan2}(q_3, q_0)$ and $\frac{\phi "
        r"- \psi}{2} = \mathrm{atan2}(q_2, q_1)$.",
        Matrix([Q[3] * cos(total) - Q[0] * sin(total), Q[2] * cos(difference) - Q[1] * sin(difference)]).subs(tilt),
        0,
        because="the parameters of step 1 are inserted; a half angle is defined where its two parameters are not both "
        "zero",
        named=r"\begin{bmatrix} q_3 \cos\frac{\phi+\psi}{2} - q_0 \sin\frac{\phi+\psi}{2} \\"
        r" q_2 \cos\frac{\phi-\psi}{2} - q_1 \sin\frac{\phi-\psi}{2} \end{bmatrix}",
    )
    d.step(
        r"At $\theta = 0$ the parameters depend only on the sum of $\phi$ and $\psi$, and are regular.",
        q.subs(THETA, 0),
        Matrix([cos(total), 0, 0, sin(total)]),
        because=r"$\sin\frac\theta2 = 0$",
        named=r"q\,|_{\theta = 0}",
    )
    d.step(
        r"If one angle grows by $2\pi$, all four parameters change their signs, and the rotation matrix is unchanged.",
        q.subs(PHI, PHI + 2 * pi) + q,
        0,
        because=r"half of $2\pi$ is $\pi$",
        named=r"q(\phi + 2\pi) + q(\phi)",
    )


def _all(d: Derivation) -> None:
    d.section("All sequences")
    d.step(
        "An extrinsic sequence has the parameters of the intrinsic sequence of the reversed name, with the first and "
        "the last angle exchanged.",
        quaternion_of_euler("zyx"),
        Matrix(quaternion_of_euler("XYZ")).subs({PHI: PSI, PSI: PHI}, simultaneous=True),
        because="a rotation about an axis of space multiplies the quaternion from the left",
        named=r"q_{\mathrm{zyx}}(\phi, \theta, \psi)",
        display=r"q_{\mathrm{XYZ}}(\psi, \theta, \phi)",
    )
    d.step(
        "The rotation matrix is quadratic in the parameters, without sines; so is its trace.",
        quaternion_to_dcm().trace(),
        4 * symbols.q0**2 - 1,
        because="$q_1^2 + q_2^2 + q_3^2 = 1 - q_0^2$",
        relations=[unit_relation()],
        named=r"\mathrm{tr}\,R",
    )
    d.tabulate(
        r"The parameters of all sequences, each the product of three factors. For each of them $R(q)$ is proven to be "
        r"the matrix of the three rotations, $R(\phi, \theta, \psi)$.",
        ("Sequence", "$q$"),
        [((sequence, f"${formula(quaternion_of_euler(sequence))}$"), [_step(d, sequence)]) for sequence in
         INTRINSIC_SEQUENCES],
    )  # fmt: skip


def _step(d: Derivation, sequence: str) -> Step:
    """Add the step that proves: the quaternion of an Euler ``sequence`` has the rotation matrix of the sequence.

    The quaternion is the product of the quaternions of the three rotations; its components are the Euler parameters.
    """
    return d.step(
        f"The Euler parameters give the rotation {sequence}.",
        quaternion_to_dcm(quaternion_of_euler(sequence)),
        dcm(sequence),
        because="the quaternion of a product is the product of the quaternions",
        named="R(q)",
        display=rf"R_{{\mathrm{{{sequence}}}}}(\phi, \theta, \psi)",
    )
