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
            "A body rolls where its point of contact is at rest. That fixes the velocity of its centre by its angular "
            "velocity, "
            "and in the plane its place by its angle; a wheel that can turn, however, gets anywhere."
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
    d.passage(r"The centre is at $R\,n$ over the point of contact, $n$ the normal of the plane, here the axis $z$.",
            ("v", r"R\;\omega \times n"))  # fmt: skip
    d.step(
        "With this velocity of the centre the point of contact is at rest.",
        velocity + OMEGA_S.cross(contact),
        0,
        because=r"the vector from the centre to the point of contact is $-R\,n$",
        named=r"v + \omega \times (-R\,n)",
    )
    d.step(
        "The top moves twice as fast.",
        velocity + OMEGA_S.cross(R * UP),
        2 * velocity,
        because="the top is twice as far from the point of contact as the centre",
        named=r"v + \omega \times R\,n",
        display="2 v",
    )
    d.step(
        "Turning about the normal does not move it.",
        velocity.diff(symbols.omega_z),
        0,
        because=r"$n \times n = 0$",
        named=r"\frac{\partial v}{\partial \omega_z}",
    )
    force = Matrix([symbols.F_x, symbols.F_y, symbols.F_z])
    d.step(
        "The force of contact does no work.",
        force.dot(velocity) + contact.cross(force).dot(OMEGA_S),
        0,
        because="the contact force acts on a point at rest",
        named=r"F \cdot v + (-R\,n \times F) \cdot \omega",
    )


def _wheel(d: Derivation) -> None:
    d.section("A wheel on a straight line")
    motion = {THETA: symbols.dtheta, symbols.dtheta: symbols.ddtheta}
    rim = Matrix([R * THETA - R * sin(THETA), R - R * cos(THETA)])
    velocity = rate(rim, motion)
    d.define("A point of the rim goes along a cycloid:", "r", rim)
    d.step(
        "Its velocity is as in a turn about the point of contact.",
        velocity,
        symbols.dtheta * Matrix([rim[1], R * THETA - rim[0]]),
        because="the point of contact is the instantaneous centre",
        named=r"\dot r",
        display=r"\dot\theta \begin{bmatrix} y \\ R\,\theta - x \end{bmatrix}",
    )
    d.step(
        "Where it touches, it is at rest, but not without acceleration: that is towards the centre.",
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
        r"A round body with the moment $C$ rolls down a slope of angle $\alpha$; along it acts friction $F_x$ "
        r"upwards. Force and "
        r"moment give $a_x$, with $a_x = R\,\ddot\theta$:",
        (r"m\,a_x", r"m g \sin\alpha - F_x"),
        (r"C\,\frac{a_x}{R}", r"F_x R"),
    )
    solution = solve(equations, (acceleration, friction), dict=True)[0]
    d.step(
        "Its acceleration: the part of the moment that spins delays it.",
        solution[acceleration],
        G * sin(slope) / (1 + gyration / (M * R**2)),
        because="friction is eliminated",
        named="a_x",
    )
    speed = symbols.v_x
    d.step(
        "Energy says the same, for friction does no work.",
        rate(
            HALF * M * speed**2 + HALF * gyration * (speed / R) ** 2 - M * G * symbols.x * sin(slope),
            {speed: solution[acceleration], symbols.x: speed},
        ),
        0,
        because=r"the contact force acts on a point at rest",
        named=r"\frac{d}{dt} \left( \tfrac12 m v^2 + \tfrac12 C \frac{v^2}{R^2} - m g x \sin\alpha \right)",
    )
    bodies = {"a ring": 1, "a disk": HALF, "a ball": Rational(2, 5)}
    d.step(
        f"Shares of $g \\sin\\alpha$ for {', '.join(bodies)}: whatever mass and radius.",
        Matrix(
            [solution[acceleration].subs(gyration, share * M * R**2) / (G * sin(slope)) for share in bodies.values()]
        ),
        Matrix([HALF, Rational(2, 3), Rational(5, 7)]),
        because=r"$C = m R^2,\ \tfrac12 m R^2,\ \tfrac25 m R^2$",
        named=r"\frac{a_x}{g \sin\alpha}",
    )
    d.step(
        r"It slips where friction, at most $\mu_f$ times the normal force, would not reach this ratio.",
        solution[friction] / (M * G * cos(slope)),
        gyration / (gyration + M * R**2) * sin(slope) / cos(slope),
        because="the equations are solved for the friction",
        named=r"\frac{F_x}{m g \cos\alpha}",
    )


def _nonholonomic(d: Derivation) -> None:
    d.section("A wheel that can turn: a constraint that cannot be integrated")
    state = Matrix([symbols.x, symbols.y, PSI, THETA])
    roll = Matrix([R * cos(PSI), R * sin(PSI), 0, 1])
    turn = Matrix([0, 0, 1, 0])
    d.passage(
        r"An upright wheel at $(x, y)$ with heading $\psi$ and angle $\theta$ has two motions: to roll on, and to "
        r"turn on the spot.",
        (r"\text{roll}", roll),
        (r"\text{turn}", turn),
    )
    bracket = roll.jacobian(state) * turn - turn.jacobian(state) * roll
    aside = R * Matrix([-sin(PSI), cos(PSI), 0, 0])
    d.step(
        "Turn, roll, turn back, roll back: to second order the wheel has moved aside, which it cannot do at once.",
        bracket,
        aside,
        because="the Lie bracket of two motions is the change of one along the other",
        named=r"[\text{turn}, \text{roll}] = \frac{\partial\,\text{roll}}{\partial (x, y, \psi, \theta)}\,\text{turn}",
    )
    d.step(
        "Repeated once more, all four directions are there: every place, heading and angle can be reached, so that no "
        "equation "
        "between the coordinates stands for the constraint.",
        Matrix.hstack(roll, turn, aside, aside.jacobian(state) * turn).det(),
        -(R**2),
        because="the determinant of the four motions is not zero",
        named=r"\det \begin{bmatrix} \text{roll} & \text{turn} & [\text{turn}, \text{roll}] & [\text{turn}, "
        r"[\text{turn}, "
        r"\text{roll}]] \end{bmatrix}",
    )
    d.step(
        "On a straight line the constraint can be integrated.",
        rate(symbols.x - R * THETA, pairs((symbols.x, THETA), (R * symbols.dtheta, symbols.dtheta))),
        0,
        because=r"$\dot x = R\,\dot\theta$",
        named=r"\frac{d}{dt} (x - R\,\theta)",
    )
    d.step(
        "The speed of the contact along the ground is the rate of the angle times the radius.",
        squared((roll * symbols.dtheta)[:2, :]),
        (R * symbols.dtheta) ** 2,
        because=r"$\cos^2\psi + \sin^2\psi = 1$",
        named=r"\dot x^2 + \dot y^2",
    )
