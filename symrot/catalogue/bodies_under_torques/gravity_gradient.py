"""Gravity gradient on a circular orbit (Hughes, Spacecraft Attitude Dynamics, chapters 8 and 9)."""

from sympy import Matrix, Rational, S

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, attitude_rates, pairs, rate, squared
from symrot.dynamics.equations import angular_acceleration
from symrot.inertia.tensor import inertia_of_point
from symrot.kinematics.quaternion import quaternion_to_dcm, unit_relation
from symrot.kinematics.rotations import elementary_rotation
from symrot.proof.derivation import Derivation

R, K, P = Matrix(symbols.radius), Matrix(symbols.normal), Matrix(symbols.position)


def derive() -> Derivation:
    d = Derivation(
        "gravity_gradient",
        title="Gravity gradient on a circular orbit",
        source="Hughes, *Spacecraft Attitude Dynamics*, chapters 8 and 9",
        about=(
            "Gravity is stronger on the near side of a satellite than on the far side. To first order in the size of "
            "the satellite, this gives a torque that is quadratic in the direction $r$ of the orbital radius. The "
            "motion has one invariant: the energy in axes that rotate with the orbit."
        ),
    )
    d.nonzero("The inertia tensor has an inverse,", TENSOR.det(), r"\det I")
    unit = [squared(R) - 1]
    n, epsilon, mass = symbols.n, symbols.epsilon, symbols.m
    d.section("The torque")
    d.passage(
        r"The satellite's centre of mass is at the distance $a$ from the centre of attraction, in the direction $r$. "
        r"The small parameter $\epsilon$ is $1/a$. A point of mass $m$ at $\rho = (x, y, z)$ from the centre of mass "
        r"is attracted by a force that decreases with the square of the distance. On a circular orbit $\mu / a^3 = "
        r"n^2$, where $n$ is the mean motion (Kepler):",
        (r"F", r"-\,m\,n^2 a\, \frac{r + \epsilon \rho}{|r + \epsilon \rho|^3}"),
    )
    place = R + epsilon * P
    pull = -mass * n**2 * place * squared(place) ** Rational(-3, 2)
    tidal = pull.diff(epsilon).subs(epsilon, S.Zero)
    d.notation({"r": R, r"\rho": P, "I": TENSOR, "m": mass, "n": n, r"\omega": OMEGA, "k": K})
    d.step(
        "To first order in the size of the body, the tidal force stretches the body along the radius and compresses "
        "it perpendicular to the radius.",
        tidal,
        mass * n**2 * (3 * R.dot(P) * R - P),
        because="the derivative is taken at the centre of mass, where the radius has length 1",
        relations=unit,
        named=r"\frac{1}{a} \left. \frac{\partial F}{\partial \epsilon} \right|_0",
        display=r"m\,n^2 \left( 3\,(r \cdot \rho)\,r - \rho \right)",
    )
    tensor = Matrix(inertia_of_point(mass, P))
    d.notation({r"I_\rho": tensor})
    d.step(
        "The moment of the tidal force depends on the inertia tensor of the point. The sum over the body depends in "
        "the same way on the inertia tensor of the body.",
        P.cross(tidal),
        3 * n**2 * R.cross(tensor * R),
        because=r"$I_\rho\, r = m\,(|\rho|^2 r - (r \cdot \rho)\,\rho)$, and the first term is along $r$",
        relations=unit,
        named=r"\tau = \rho \times \frac{1}{a} \left. \frac{\partial F}{\partial \epsilon} \right|_0",
        board=(
            ("The tidal force is inserted:", r"\rho \times m\,n^2 \left( 3\,(r \cdot \rho)\,r - \rho \right)"),
            (r"$\rho \times \rho = 0$:", r"3 m\,n^2\,(r \cdot \rho)\,\rho \times r"),
            (
                r"The factors of the cross product are exchanged, and a multiple of $r$ is added to the second factor, "
                r"which changes nothing, since $r \times r = 0$:",
                r"3 n^2\,r \times m \left( |\rho|^2\,r - (r \cdot \rho)\,\rho \right)",
            ),
            (r"$I_\rho\,r = m \left( |\rho|^2\,r - (r \cdot \rho)\,\rho \right)$:", r"3 n^2\,r \times I_\rho\,r"),
        ),
        display=r"3 n^2\, r \times I_\rho\, r",
    )
    torque = 3 * n**2 * R.cross(TENSOR * R)
    d.notation({r"\tau": torque})
    d.step(
        "The torque has no component along the radius.",
        torque.dot(R),
        0,
        because="a vector product is perpendicular to its factors",
        named=r"\tau \cdot r",
        board=(
            ("The torque is inserted:", r"3 n^2 \left( r \times I\,r \right) \cdot r"),
            ("A cross product is perpendicular to its factors:", "0"),
        ),
    )

    d.section("The invariant")
    space_radius = elementary_rotation(2, n * symbols.t) * Matrix([1, 0, 0])
    dcm_sb = Matrix(quaternion_to_dcm())
    seen, normal_s = dcm_sb.T * space_radius, Matrix([0, 0, 1])
    d.notation({"r": seen, "k": dcm_sb.T * normal_s}, attitude_rates() | {symbols.t: S.One})
    d.step(
        "In body axes, the direction of the radius rotates with the angular velocity of the orbit minus the angular "
        "velocity of the body; $k$ is the normal of the orbit.",
        rate(seen, attitude_rates() | {symbols.t: S.One}),
        seen.cross(OMEGA - n * dcm_sb.T * normal_s),
        because="in space the radius rotates about the normal at the rate $n$",
        relations=[unit_relation()],
        named=r"\dot r",
        display=r"r \times (\omega - n\,k)",
    )
    motion = (
        pairs(symbols.omega_b, angular_acceleration(TENSOR, OMEGA, torque))
        | pairs(symbols.radius, R.cross(OMEGA - n * K))
        | pairs(symbols.normal, K.cross(OMEGA))
    )
    d.notation({"r": R, "k": K}, motion)
    kinetic, potential = OMEGA.dot(TENSOR * OMEGA) / 2, Rational(3, 2) * n**2 * R.dot(TENSOR * R)
    d.step(
        "The sum of kinetic and potential energy is not constant, because the orbital motion does work.",
        rate(kinetic + potential, motion),
        n * torque.dot(K),
        because="the potential depends on time through the radius",
        named=r"\frac{d}{dt} \left( \tfrac12\,\omega \cdot I\,\omega + \tfrac32 n^2\, r \cdot I\,r \right)",
        display=r"n\, k \cdot \tau",
    )
    d.step(
        r"The angular momentum about the normal of the orbit changes at the rate $k \cdot \tau$. This term also occurs "
        "in the rate of the energy.",
        rate(K.dot(TENSOR * OMEGA), motion),
        torque.dot(K),
        because="the rate of a component of angular momentum along a fixed direction is the component of the torque",
        named=r"\frac{d}{dt} \left( k \cdot I\,\omega \right)",
        display=r"k \cdot \tau",
    )
    d.step(
        "So the energy in axes that rotate with the orbit is constant (the Jacobi integral).",
        rate(kinetic + potential - n * K.dot(TENSOR * OMEGA), motion),
        0,
        because="$n$ times the rate of the angular momentum is subtracted from the rate of the energy",
        named=r"\frac{d}{dt} \left( \tfrac12\,\omega \cdot I\,\omega + \tfrac32 n^2\, r \cdot I\,r"
        r" - n\, k \cdot I\,\omega \right)",
    )
    return d
