"""Quaternion rates from the angular velocity, in body and in space components.

The proof shows that with these rates the rotation matrix of the quaternion rotates with the angular velocity.
"""

from sympy import Matrix, eye

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, attitude_rates, pairs, rate, squared
from symrot.kinematics.quaternion import (
    norm_squared,
    quaternion_product,
    quaternion_rates,
    quaternion_to_dcm,
    unit_relation,
)
from symrot.kinematics.rotations import skew
from symrot.proof.derivation import Derivation

Q = Matrix(symbols.quaternion)
DQ = Matrix(symbols.quaternion_rates)
OMEGA_S = Matrix(symbols.omega_s)


def derive() -> Derivation:
    d = Derivation(
        "quaternion_rates",
        title="Quaternion rates",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., section 4.5, for the Euler parameters",
        about=(
            r"A unit quaternion $q$ rotates a vector by $v_s = q\,v_b\,\bar q$. The rate of $q$ is linear in $q$ and "
            "in the angular velocity, has no singularity, and needs neither sine nor cosine. Therefore symrot "
            "integrates this equation for the attitude."
        ),
    )
    unit = [unit_relation()]
    dcm_sb = quaternion_to_dcm()
    d.define(
        r"The direction cosine matrix is the matrix of the map $v_b \mapsto q\,v_b\,\bar q$, with $q \bar "
        "q = 1$:",
        "R",
        dcm_sb,
    )
    d.step(
        "The matrix is orthogonal.",
        dcm_sb * dcm_sb.T,
        eye(3),
        because="the Hamilton product of quaternions preserves lengths",
        relations=unit,
        named=r"R R^{\mathsf T}",
    )
    d.step(
        "The matrix is a rotation, not a reflection.",
        dcm_sb.det(),
        1,
        because="the determinant of the matrix is $|q|^6$",
        relations=unit,
        named=r"\det R",
    )

    d.section("Rates from the angular velocity in the body")
    body = attitude_rates()
    d.define(r"Let the rate of the quaternion be half the product $q\,(0, \omega_b)$:", DQ, Matrix([*body.values()]))
    d.step(
        "The norm of the quaternion is constant, even if it is not 1.",
        rate(norm_squared(symbols.quaternion), body),
        0,
        because=r"$q$ and $q\,(0, \omega_b)$ are orthogonal vectors of four components",
        named=r"\frac{d}{dt} |q|^2",
    )
    d.step(
        r"With the rate $\dot q = \tfrac12\,q\,(0, \omega_b)$, the direction cosine matrix rotates with the angular "
        r"velocity $\omega_b$ (body components), in all nine entries.",
        rate(dcm_sb, body),
        dcm_sb * skew(OMEGA),
        because="the matrix is quadratic in the quaternion, whose rate and norm are known",
        relations=unit,
        named=r"\dot R",
        display=r"R\,[\omega_b]_\times",
    )
    d.step(
        r"Conversely, the angular velocity is the vector part of $2\,\bar q\,\dot q$.",
        4 * quaternion_rates("body").T * Matrix([*body.values()]),
        OMEGA,
        because=r"the columns of the rate matrix $M$ in $\dot q = M \omega_b$ are orthogonal and have length one half",
        relations=unit,
        named=r"2\,\mathrm{vec}(\bar q\,\dot q)",
    )

    d.section("Rates from the angular velocity in space")
    space = pairs(symbols.quaternion, quaternion_rates("space") * OMEGA_S)
    d.define(
        "With the angular velocity in space components, the factors are in the opposite order: the rate of $q$ is half "
        r"the product $(0, \omega_s)\,q$:",
        DQ,
        Matrix([*space.values()]),
    )
    d.step(
        r"With the rate $\dot q = \tfrac12\,(0, \omega_s)\,q$, the direction cosine matrix rotates with the angular "
        r"velocity $\omega_s$ (space components).",
        rate(dcm_sb, space),
        skew(OMEGA_S) * dcm_sb,
        because="the matrix is quadratic in the quaternion, whose rate and norm are known",
        relations=unit,
        named=r"\dot R",
        display=r"[\omega_s]_\times R",
    )
    d.step(
        r"The equations with $\omega_s$ and with $\omega_b$ give the same rate: $\omega_s = R\,\omega_b$ turns the "
        "first equation into the second.",
        quaternion_rates("space") * dcm_sb * OMEGA,
        quaternion_product(Q, [0, *OMEGA]) / 2,
        because=r"$\omega_s = R\,\omega_b$",
        relations=unit,
        named=r"\tfrac12 (0, R\,\omega_b)\,q",
        display=r"\tfrac12\,q\,(0, \omega_b)",
    )
    d.step(
        "The opposite quaternion $-q$ describes the same attitude.",
        quaternion_to_dcm(tuple(-Q)) - dcm_sb,
        0,
        because="the matrix $R$ is quadratic in the components of $q$",
        named="R(-q) - R(q)",
    )
    d.step(
        "The equation for the rates of the quaternion is singular at no attitude.",
        (quaternion_rates("body").T * quaternion_rates("body")).det() * 64,
        1,
        because=r"the matrix $M$ of $\dot q = M \omega_b$ has full rank at every unit quaternion",
        relations=[squared(Q) - 1],
        named=r"\det \left( 4 M^{\mathsf T} M \right)",
    )
    return d
