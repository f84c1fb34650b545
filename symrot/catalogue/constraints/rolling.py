"""Rolling without slipping (Neimark & Fufaev, Dynamics of Nonholonomic Systems, chapter I; Goldstein, section 1.3)."""

from sympy import Matrix, Rational, cos, sin, solve

from symrot import symbols
from symrot.catalogue.tools.motion import pairs, rate, squared
from symrot.proof.derivation import Derivation

PHI, THETA, PSI = symbols.angles
R, M, G = symbols.R, symbols.m, symbols.g
OMEGA_S, V = Matrix(symbols.omega_s), Matrix(symbols.velocity)
UP = Matrix([0, 0, 1])
HALF = Rational(1, 2)


def derive() -> Derivation:
    d = Derivation(
        "rolling",
        title="Rolling without slipping",
        source="Neimark & Fufaev, *Dynamics of Nonholonomic Systems*, chapter I; Beer, Johnston & Cornwell, *Vector "
        "Mechanics "
        "for Engineers: Dynamics*, chapters 15 and 16",
        about=(
            "A body rolls without slipping if its point of contact is at rest. This determines the velocity of its "
            "centre from its angular velocity. In plane motion, the angle also determines the position; a wheel that "
            "can be steered, however, can reach every position at every angle."
        ),
    )
    _ball(d)
    _wheel(d)
    _slope(d)
    _nonholonomic(d)
    return d


def _ball(d: Derivation) -> None:
    d.section("A ball on a plane")
    velocity = R * OMEGA_S.cross(UP)
    contact = -R * UP
    d.passage(r"Let $n$ be the normal of the plane, here the $z$ axis. The centre of the ball is at $R\,n$ from the "
        "point of contact, and has the velocity",
            ("v", r"R\;\omega \times n"))  # fmt: skip
    d.step(
        r"With the velocity $v = R\,\omega \times n$ of the centre, the point of contact is at rest.",
        velocity + OMEGA_S.cross(contact),
        0,
        because=r"the vector from the centre to the point of contact is $-R\,n$",
        named=r"v + \omega \times (-R\,n)",
    )
    d.step(
        "The top of the ball moves twice as fast as the centre.",
        velocity + OMEGA_S.cross(R * UP),
        2 * velocity,
        because="the top is twice as far from the point of contact as the centre",
        named=r"v + \omega \times R\,n",
        display="2 v",
    )
    d.step(
        "Rotation about the normal does not move the centre.",
        velocity.diff(symbols.omega_z),
        0,
        because=r"$n \times n = 0$",
        named=r"\frac{\partial v}{\partial \omega_z}",
    )
    force = Matrix([symbols.F_x, symbols.F_y, symbols.F_z])
    d.step(
        "The contact force does no work.",
        force.dot(velocity) + contact.cross(force).dot(OMEGA_S),
        0,
        because="the contact force acts on a point that is at rest",
        named=r"F \cdot v + (-R\,n \times F) \cdot \omega",
    )


def _wheel(d: Derivation) -> None:
    d.section("A wheel on a straight line")
    motion = {THETA: symbols.dtheta, symbols.dtheta: symbols.ddtheta}
    rim = Matrix([R * THETA - R * sin(THETA), R - R * cos(THETA)])
    velocity = rate(rim, motion)
    d.define("A point of the rim moves along a cycloid:", "r", rim)
    d.step(
        "A point of the rim has the velocity of a rotation about the point of contact.",
        velocity,
        symbols.dtheta * Matrix([rim[1], R * THETA - rim[0]]),
        because="the point of contact is the instantaneous centre",
        named=r"\dot r",
        display=r"\dot\theta \begin{bmatrix} y \\ R\,\theta - x \end{bmatrix}",
    )
    d.step(
        "When a point of the rim touches the ground, its velocity is zero, but its acceleration is not: the "
        "acceleration points toward the centre.",
        Matrix.hstack(velocity, rate(velocity, motion)).subs(THETA, 0),
        Matrix([[0, 0], [0, R * symbols.dtheta**2]]),
        because="the centre moves on a straight line, and the point rotates about the centre",
        named=r"\left. \begin{bmatrix} \dot r & \ddot r \end{bmatrix} \right|_{\theta = 0}",
    )


def _slope(d: Derivation) -> None:
    d.section("Down a slope")
    slope, friction, gyration = symbols.alpha, symbols.F_x, symbols.C
    acceleration = symbols.a_x
    equations = (
        M * acceleration - (M * G * sin(slope) - friction),
        gyration * acceleration / R - friction * R,
    )
    d.passage(
        r"A round body with the moment of inertia $C$ rolls down a slope of angle $\alpha$. The friction $F_x$ acts "
        r"uphill. With $a_x = R\,\ddot\theta$, force and moment give two equations for $a_x$ and $F_x$:",
        (r"m\,a_x", r"m g \sin\alpha - F_x"),
        (r"C\,\frac{a_x}{R}", r"F_x R"),
    )
    solution = solve(equations, (acceleration, friction), dict=True)[0]
    d.step(
        "A rolling body has a smaller acceleration than a sliding body, because part of the energy goes into the "
        "rotation.",
        solution[acceleration],
        G * sin(slope) / (1 + gyration / (M * R**2)),
        because="friction is eliminated",
        named="a_x",
    )
    speed = symbols.v_x
    d.step(
        "With this acceleration of the rolling body its energy is constant, since friction does no work.",
        rate(
            HALF * M * speed**2 + HALF * gyration * (speed / R) ** 2 - M * G * symbols.x * sin(slope),
            {speed: solution[acceleration], symbols.x: speed},
        ),
        0,
        because="the contact force acts on a point that is at rest",
        named=r"\frac{d}{dt} \left( \tfrac12 m v^2 + \tfrac12 C \frac{v^2}{R^2} - m g x \sin\alpha \right)",
    )
    bodies = {"a ring": 1, "a disk": HALF, "a ball": Rational(2, 5)}
    d.step(
        rf"In units of $g \sin\alpha$, the accelerations of {', '.join(bodies)} do not depend on mass and radius.",
        Matrix(
            [solution[acceleration].subs(gyration, share * M * R**2) / (G * sin(slope)) for share in bodies.values()]
        ),
        Matrix([HALF, Rational(2, 3), Rational(5, 7)]),
        because=r"$C = m R^2,\ \tfrac12 m R^2,\ \tfrac25 m R^2$",
        named=r"\frac{a_x}{g \sin\alpha}",
    )
    d.step(
        r"The body slips if the ratio of friction to normal force exceeds the friction coefficient $\mu_f$.",
        solution[friction] / (M * G * cos(slope)),
        gyration / (gyration + M * R**2) * sin(slope) / cos(slope),
        because="the equations are solved for the friction",
        named=r"\frac{F_x}{m g \cos\alpha}",
    )


def _nonholonomic(d: Derivation) -> None:
    d.section("A wheel that can be steered: a constraint that cannot be integrated")
    state = Matrix([symbols.x, symbols.y, PSI, THETA])
    roll = Matrix([R * cos(PSI), R * sin(PSI), 0, 1])
    turn = Matrix([0, 0, 1, 0])
    d.passage(
        r"An upright wheel at $(x, y)$ with the heading $\psi$ and the angle of rotation $\theta$ has two motions: it "
        "can roll, and it can turn on the spot (change its heading).",
        (r"\text{roll}", roll),
        (r"\text{turn}", turn),
    )
    bracket = roll.jacobian(state) * turn - turn.jacobian(state) * roll
    aside = R * Matrix([-sin(PSI), cos(PSI), 0, 0])
    d.step(
        "The sequence turn, roll, turn back, roll back, each by a small angle, moves the wheel sideways, in proportion "
        "to the product of the two angles. Neither motion alone does this.",
        bracket,
        aside,
        because="the sideways motion is the Lie bracket of the two motions",
        named=r"[\text{turn}, \text{roll}] = \frac{\partial\,\text{roll}}{\partial (x, y, \psi, \theta)}\,\text{turn}",
    )
    d.step(
        "The two motions, their Lie bracket and a second Lie bracket are four independent directions. So the wheel "
        "can reach every position with every heading and angle, and the constraint is not equivalent to an equation "
        "between the coordinates.",
        Matrix.hstack(roll, turn, aside, aside.jacobian(state) * turn).det(),
        -(R**2),
        because="the determinant of the four directions is not zero",
        named=r"\det \begin{bmatrix} \text{roll} & \text{turn} & [\text{turn}, \text{roll}] & [\text{turn}, "
        r"[\text{turn}, "
        r"\text{roll}]] \end{bmatrix}",
    )
    d.step(
        r"On a straight line the constraint can be integrated: $x - R\,\theta$ is constant.",
        rate(symbols.x - R * THETA, pairs((symbols.x, THETA), (R * symbols.dtheta, symbols.dtheta))),
        0,
        because=r"$\dot x = R\,\dot\theta$",
        named=r"\frac{d}{dt} (x - R\,\theta)",
    )
    d.step(
        "The speed of the point of contact along the ground is the radius times the rate of the angle of rotation.",
        squared((roll * symbols.dtheta)[:2, :]),
        (R * symbols.dtheta) ** 2,
        because=r"$\cos^2\psi + \sin^2\psi = 1$",
        named=r"\dot x^2 + \dot y^2",
    )
