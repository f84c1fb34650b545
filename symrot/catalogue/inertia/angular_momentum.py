"""Angular momentum and the inertia tensor from the sum over particles (Goldstein, 3rd ed., sections 5.1 and 5.3)."""

from sympy import Matrix, eye

from symrot import symbols
from symrot.catalogue.tools.motion import OMEGA, TENSOR, squared
from symrot.catalogue.tools.particles import COUNT, FIRST_MOMENT, INERTIA, MASS, NAMES, over_particles
from symrot.inertia.tensor import inertia_of_point
from symrot.proof.derivation import Derivation

PLACE, V = Matrix(symbols.position), Matrix(symbols.velocity)


def derive() -> Derivation:
    d = Derivation(
        "angular_momentum",
        title="Angular momentum and the inertia tensor",
        source="Goldstein, Poole & Safko, *Classical Mechanics*, 3rd ed., sections 5.1 to 5.3; Landau & Lifshitz, "
        "*Mechanics*, 3rd ed., section 32",
        about=(
            "A rigid body consists of particles that rotate with a common angular velocity. Its angular momentum is "
            "linear in the angular velocity, and the matrix of this linear map is the inertia tensor."
        ),
    )
    _one_particle(d)
    _sum(d)
    _center(d)
    _properties(d)
    return d


def _one_particle(d: Derivation) -> None:
    d.section("One particle")
    mass, point = symbols.m, PLACE
    d.notation({"r": point, r"\omega": OMEGA})
    momentum = point.cross(mass * OMEGA.cross(point))
    d.step(
        r"A particle at $r$ that moves with the angular velocity $\omega$ has an angular momentum that is linear in "
        r"$\omega$.",
        momentum,
        mass * (squared(point) * eye(3) - point * point.T) * OMEGA,
        because=r"$r \times (\omega \times r) = |r|^2 \omega - r\,(r \cdot \omega)$",
        named=r"r \times m\,(\omega \times r)",
        board=(
            (
                r"$a \times (b \times c) = b\,(a \cdot c) - c\,(a \cdot b)$:",
                r"m \left( \omega\,(r \cdot r) - r\,(r \cdot \omega) \right)",
            ),
            (
                r"$r\,(r \cdot \omega) = r\,r^{\mathsf T} \omega$:",
                r"m \left( |r|^2\,\mathbf{1} - r\,r^{\mathsf T} \right) \omega",
            ),
        ),
        display=r"m \left( |r|^2\,\mathbf{1} - r\,r^{\mathsf T} \right) \omega",
    )
    d.step(
        "The matrix of the linear map from angular velocity to angular momentum has the moments of inertia on its "
        "diagonal and the products of inertia, such as $I_{xy} = -m\\,x\\,y$, beside the diagonal.",
        momentum.jacobian(OMEGA),
        Matrix(inertia_of_point(mass, point)),
        because=r"the coefficients of the components of $\omega$ are compared",
        named=r"I = \frac{\partial L}{\partial \omega}",
    )


def _sum(d: Derivation) -> None:
    d.section("Many particles")
    d.passage(
        "The proof uses three particles. It holds for any number, because every sum below is linear in the "
        "contributions of the particles."
    )
    d.step(
        "All particles have the same angular velocity, so their inertia tensors add.",
        over_particles(lambda m, r: r.cross(m * OMEGA.cross(r))),
        INERTIA * OMEGA,
        because="a sum of linear maps is the map of the sum",
        named=rf"L = {COUNT} r_i \times m_i\,(\omega \times r_i)",
        display=rf"\Bigl( {COUNT} m_i \left( |r_i|^2\,\mathbf{{1}} - r_i\,r_i^{{\mathsf T}} \right) \Bigr) \omega = "
        rf"I\,\omega",
    )
    d.notation({"I": INERTIA})
    d.step(
        "The inertia tensor is symmetric.",
        INERTIA - INERTIA.T,
        0,
        because=r"$r\,r^{\mathsf T}$ is symmetric",
        named=r"I - I^{\mathsf T}",
    )


def _center(d: Derivation) -> None:
    d.section("Angular momentum about any point")
    d.passage(
        "Let the centre of mass be at $x$, with the velocity $v$, and particle $i$ at $x + r_i$:",
        (rf"{COUNT} m_i\,r_i", "0"),
        ("M", rf"{COUNT} m_i"),
    )
    d.notation(NAMES | {"x": PLACE, "v": V, "M": MASS, "I": INERTIA})
    d.step(
        "The angular momentum of a body is the angular momentum of its total mass, moving with the centre of mass, "
        "plus the angular momentum of the rotation about the centre of mass.",
        over_particles(lambda m, r: (PLACE + r).cross(m * (V + OMEGA.cross(r)))),
        PLACE.cross(MASS * V) + INERTIA * OMEGA,
        because=rf"the mixed terms contain the factor ${COUNT} m_i\,r_i = 0$",
        relations=list(FIRST_MOMENT),
        named=rf"{COUNT} \left( (x + r_i) \times m_i \left( v + \omega \times r_i \right) \right)",
        board=(
            (
                "The product is multiplied out:",
                r"\sum_i (m_i\,x \times v) + x \times \left( \omega \times \sum_i (m_i\,r_i) \right) + \sum_i "
                r"(m_i\,r_i) \times v + \sum_i (m_i\,r_i \times (\omega \times r_i))",
            ),
            (r"$\sum_i m_i\,r_i = 0$:", r"M\,x \times v + \sum_i (m_i\,r_i \times (\omega \times r_i))"),
            (
                "The last sum is the angular momentum of the rotation about the centre of mass:",
                r"x \times M\,v + I\,\omega",
            ),
        ),
        display=r"x \times M v + I\,\omega",
    )


def _properties(d: Derivation) -> None:
    d.section("Properties of every inertia tensor")
    d.notation({r"\omega": OMEGA, "I": INERTIA})
    d.step(
        r"The product $\omega \cdot I\,\omega$ is a sum of squares. So no principal moment is negative, and a "
        "principal moment is zero only if all particles lie on one line.",
        OMEGA.dot(INERTIA * OMEGA),
        over_particles(lambda m, r: m * squared(OMEGA.cross(r))),
        because=r"$\omega \cdot (r \times (\omega \times r)) = |\omega \times r|^2$",
        named=r"\omega \cdot I\,\omega",
        board=(
            (
                "The angular momentum is a sum over the particles:",
                r"\omega \cdot \sum_i (m_i\,r_i \times (\omega \times r_i))",
            ),
            (
                r"$\omega \cdot (r \times u) = (\omega \times r) \cdot u$, with $u = \omega \times r$:",
                r"\sum_i (m_i\,|\omega \times r_i|^2)",
            ),
        ),
        display=rf"{COUNT} m_i\,|\omega \times r_i|^2",
    )
    d.step(
        "No moment of inertia exceeds the sum of the other two.",
        INERTIA[0, 0] + INERTIA[1, 1] - INERTIA[2, 2],
        2 * over_particles(lambda m, r: m * r[2] ** 2),
        because="the squares $x^2$ and $y^2$ cancel, and $z^2$ occurs in both of the first two moments",
        named=r"I_{xx} + I_{yy} - I_{zz}",
    )
    d.step(
        "Half the trace of the tensor is the polar moment of inertia, which is the same in all axes.",
        INERTIA.trace() / 2,
        over_particles(lambda m, r: m * squared(r)),
        because="each of $x^2$, $y^2$, $z^2$ occurs in two of the three moments",
        named=r"\tfrac12\,\mathrm{tr}\,I",
        display=rf"{COUNT} m_i\,|r_i|^2",
    )
    about_third = Matrix([0, 0, symbols.omega_3])
    d.step(
        "The angular momentum is parallel to the angular velocity only if the axis is a principal axis. About axis 3, "
        "the products of inertia add components along axes 1 and 2.",
        (TENSOR * about_third).cross(about_third),
        symbols.omega_3**2 * Matrix([symbols.I_yz, -symbols.I_xz, 0]),
        because="the first two entries of the third column of the tensor are products of inertia",
        named=r"I\,\omega \times \omega\ \text{for}\ \omega = \omega_3\,e_3",
    )
    d.step(
        "A needle along axis 3 has the moment of inertia zero about its own line.",
        Matrix(inertia_of_point(symbols.m, Matrix([0, 0, symbols.z]))) * Matrix([0, 0, 1]),
        0,
        because="all particles of a needle lie on its axis",
        named=r"I\,e_3\ \text{for}\ r = z\,e_3",
    )
