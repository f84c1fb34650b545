"""The figures with their captions, for the page of each derivation."""

from symrot.figures import attitude, free_bodies, mechanics, tops
from symrot.figures.solids import solid_figures
from symrot.proof.page import Figure

__all__ = ["FIGURES", "figures_of"]

FIGURES: dict[str, tuple[Figure, ...]] = {
    "rotation_matrices": (
        Figure(
            "rotation_matrices", "One vector in two frames",
            r"The vector $v$ (red) does not change. Its components along the axes rotated by $\alpha$ (blue) differ "
            "from its components along the fixed axes (black); the rotation matrix converts the components.",
            attitude.plane_rotation,
        ),
    ),
    "axis_and_angle": (
        Figure(
            "axis_and_angle", "Rotation of a vector about an axis",
            r"A rotation about $n$ leaves the component $v_\parallel$ along the axis unchanged and rotates the "
            r"perpendicular component $v_\perp$ by $\alpha$. The tip of $v$ moves on a circle to $v'$.",
            attitude.rodrigues_rotation,
        ),
    ),
    "composition": (
        Figure(
            "composition", "Two quarter rotations in both orders",
            "The same box after a quarter rotation about the fixed axis $x$ and a quarter rotation about the fixed "
            "axis $y$. The two orders give different attitudes.",
            attitude.order_of_rotations,
        ),
    ),
    "euler_parameters": (
        Figure(
            "quaternion_double_cover", "Two quaternions for each attitude",
            "The quaternions of all rotations about one axis $n$ form a circle, on which the angle is half the "
            r"rotation angle $\alpha$. One full rotation, from $0$ to $2\pi$, leads from $1$ to $-1$ (blue); a second "
            "full rotation (red) leads back to $1$. Opposite points, $q$ and $-q$, describe the same attitude.",
            attitude.double_cover,
        ),
    ),
    "spin_tensor": (
        Figure(
            "angular_velocity", "Velocity of a point of a rotating body",
            r"The point at $r$ moves on a circle about the axis of $\omega$. Its velocity $\omega \times r$ is "
            r"perpendicular to $\omega$ and $r$, and has the size $|\omega|\,|r| \sin\theta$.",
            attitude.angular_velocity,
        ),
    ),
    "euler_body_rates": (
        Figure(
            "euler_zxz", "The three rotations of ZXZ: precession, nutation, spin",
            r"A proper Euler sequence, ZXZ. The first rotation, by $\phi$, is about $z$; the second, by $\theta$, "
            r"about the new axis $x'$; the third, by $\psi$, about the new axis $z''$. Each panel shows in grey the "
            "frame before the rotation.",
            attitude.proper_euler,
        ),
        Figure(
            "euler_zyx", "The three rotations of ZYX: yaw, pitch, roll",
            r"A Tait-Bryan sequence, ZYX: yaw $\phi$ about $z$, pitch $\theta$ about the new axis $y'$, roll $\psi$ "
            r"about the new axis $x''$. Books on aircraft call the angle of yaw $\psi$ and the angle of roll $\phi$.",
            attitude.tait_bryan,
        ),
    ),
    "euler_singularities": (
        Figure(
            "gimbal_lock", "Gimbal rings in a general attitude and locked",
            "Three rings for the sequence ZYX. On the left their axes have three different directions. On the right "
            r"$\theta$ is a right angle: the axes of $\phi$ and $\psi$ coincide, and the body cannot rotate about the "
            "direction that is perpendicular to the two remaining axes.",
            attitude.gimbal_lock,
        ),
    ),
    "rotation_vector": (
        Figure(
            "rotation_vector", "The ball of rotation vectors",
            r"A section through the ball of radius $\pi$ whose points represent all rotations. Each attitude has one "
            r"rotation vector $\alpha n$ inside the ball. The vector $(\alpha - 2\pi)\,n$, a rotation in the opposite "
            "direction, gives the same attitude.",
            attitude.rotation_vectors,
        ),
    ),
    "rodrigues": (
        Figure(
            "rodrigues", "Two projections of a quaternion",
            "The circle of the quaternions about one axis, with $q_0$ upward. The classical parameters $g$ (blue) "
            "project $q$ from the centre to the tangent at $1$; the modified parameters $s$ (red) project $q$ from "
            "$-1$ to the diameter.",
            attitude.projected_quaternions,
        ),
    ),
    "relative_motion": (
        Figure(
            "relative_motion", "Velocities of two points of a body",
            r"The second point moves with the velocity $v$ of $P$ plus $\omega \times R\,d$, which is perpendicular "
            "to the line between both points.",
            attitude.two_points,
        ),
    ),
    "angular_momentum": (
        Figure(
            "angular_momentum", "Angular momentum and angular velocity have different directions",
            "The ellipsoid of constant kinetic energy, in body axes. The angular momentum $L$ is along the normal of "
            r"the ellipsoid at the tip of $\omega$; it is along $\omega$ only on a principal axis.",
            mechanics.momentum_and_rate,
        ),
    ),
    "parallel_axis": (
        Figure(
            "parallel_axis", "An axis through the centre of mass and a parallel one",
            "The moment about the axis through $P$ is the moment about the parallel axis through the centre of mass "
            "$c$ plus $m\\,d^2$, where $d$ is the distance between the two axes.",
            mechanics.parallel_axes,
        ),
    ),
    "tensor_rotation": (
        Figure(
            "tensor_rotation", "Principal axes of a tilted body",
            "In the axes $x, y$ the body has a product of inertia. In its principal axes $x', y'$ (red), along its "
            "directions of symmetry, the product of inertia is zero.",
            mechanics.principal_axes,
        ),
    ),
    "standard_solids": solid_figures(),
    "euler_equations": (
        Figure(
            "euler_equations", "The torque changes the angular momentum",
            r"In a short time $dt$ the angular momentum changes by $\tau\,dt$, along the torque. The direction of the "
            "angular velocity generally differs from both.",
            mechanics.torque_and_rate,
        ),
    ),
    "impulse_and_momentum": (
        Figure(
            "impulse", "A rod after a blow",
            "A free rod is struck by $J$ at the distance $h$ from its centre of mass $c$. The velocities of its points "
            "(red) grow along the rod. One point, the centre of percussion, stays at rest.",
            mechanics.struck_rod,
        ),
    ),
    "free_body_invariants": (
        Figure(
            "momentum_sphere", "Paths of the angular momentum in the body",
            "In body axes the angular momentum moves on a sphere, since its length is constant. Each curve belongs to "
            "a different energy. The red curves, the separatrices, cross on the intermediate axis.",
            free_bodies.momentum_sphere,
        ),
    ),
    "symmetric_top": (
        Figure(
            "cones_direct", "Direct precession: the body cone rolls outside the space cone",
            "A slender body, $A > C$. The body cone, around the symmetry axis $e_3$, rolls on the outside of the "
            r"space cone, around $L$. They touch along $\omega$.",
            free_bodies.direct_cones,
            "Direct or retrograde",
        ),
        Figure(
            "cones_retrograde", "Retrograde precession: the space cone is inside the body cone",
            r"A flat body, $A < C$. The space cone is inside the body cone, which rolls around it.",
            free_bodies.retrograde_cones,
            "Direct or retrograde",
        ),
    ),
    "intermediate_axis": (
        Figure(
            "polhodes", "Polhodes on the energy ellipsoid",
            "Paths of the angular velocity in body axes, on the energy ellipsoid of a body with the moments $A < B < "
            "C$. Around axes 1 and 3 the paths are small loops, so small disturbances stay small. Near axis 2 the "
            "paths lead away from the axis. The two red curves, the separatrices, cross on axis 2.",
            free_bodies.polhodes,
        ),
        Figure(
            "flips", "Flips of a T-handle",
            "The angular velocity in the scene `t_handle`, which starts with rotation about its intermediate axis, "
            r"here axis 3. It rotates nearly steadily for some time and then flips: $\omega_3$ changes its sign.",
            free_bodies.flips,
        ),
    ),
    "poinsot": (
        Figure(
            "poinsot", "Poinsot's ellipsoid rolls on the invariable plane",
            r"The energy ellipsoid touches the invariable plane at the tip of $\omega$ and rolls on it without "
            "slipping. The polhode (blue) is the path of this point on the ellipsoid, the herpolhode (red) its path "
            "on the plane. Dashed lines are hidden by the ellipsoid. The angular momentum $L$ is perpendicular to "
            "the plane.",
            free_bodies.poinsot,
        ),
    ),
    "free_asymmetric_body": (
        Figure(
            "free_body_rates", "Angular velocity of a free asymmetric body",
            r"The three components of $\omega$ of a free body with the moments $A < B < C$ are the elliptic functions "
            r"sn, cn and dn of time. The energy is less than on the separatrix, so the sign of $\omega_3$ does not "
            "change.",
            free_bodies.rates,
        ),
    ),
    "heavy_top": (
        Figure(
            "heavy_top", "A top with its angles",
            r"The precession $\phi$ is the angle from the fixed axis $x$ to the line of nodes, the nutation $\theta$ "
            r"the angle from the vertical $z$ to the symmetry axis $e_3$, and the spin $\psi$ the angle about this "
            "axis. The weight $W$ acts at the centre of mass.",
            tops.top_with_angles,
        ),
    ),
    "gyroscopic_wheel": (
        Figure(
            "gyroscopic_wheel", "A spinning wheel on a cord",
            r"The weight $W$ has a horizontal torque $\tau$ about the point of suspension. The angular momentum $L$ "
            r"changes along $\tau$: the axle rotates about the cord and does not fall.",
            tops.hung_wheel,
        ),
    ),
    "gravity_gradient": (
        Figure(
            "gravity_gradient", "Tidal force on a long satellite",
            "Left: a satellite on its orbit. Right: the tidal forces (grey), which are gravity minus the gravity at "
            "the centre of the satellite, stretch it along the radius $r$ and compress it perpendicular to $r$. The "
            r"forces on its two ends (red) have a torque $\tau$ that rotates the long axis toward the radius.",
            tops.tidal_field,
        ),
    ),
    "elliptic_functions": (
        Figure(
            "elliptic_functions", "Jacobi's elliptic functions",
            r"The functions sn, cn and dn for the parameter $\mu = 0.8$. The quarter period is $K$.",
            mechanics.elliptic_curves,
        ),
    ),
    "free_body_separatrix": (
        Figure(
            "separatrix", "Angular velocity on the separatrix",
            "The body leaves a steady rotation about its intermediate axis 2 and approaches the opposite steady "
            r"rotation. Between the two, $\omega_1$ and $\omega_3$ rise and fall once.",
            free_bodies.separatrix,
        ),
    ),
    "heavy_top_motion": tuple(
        Figure(
            f"top_{name}", f"Effective potential and path of the axis: {name}",
            r"Left: the effective potential $U$, with the turning points $\theta_1, \theta_2$ where it equals the "
            r"energy $E$. Right: the path of the axis on the sphere, from the red point, between the parallels of both "
            f"angles. The top is {start}: the axis draws {name}.",
            draw,
            "Nutation",
        )
        for name, start, draw in (
            ("loops", "pushed against the direction of its precession", tops.loops),
            ("cusps", "released with its axis at rest", tops.cusps),
            ("waves", "pushed slightly in the direction of its precession", tops.waves),
        )
    ),
    "pendulum": (
        Figure(
            "pendulum", "A pendulum and its phase curves",
            r"Each curve is one motion: $\dot\theta$ over $\theta$. Inside the red curve the pendulum oscillates "
            "(blue); outside it goes around (green); on the red curve it approaches the highest position in an "
            "infinite time.",
            tops.pendulum_phases,
        ),
        Figure(
            "spherical_pendulum", "Path of a spherical pendulum",
            "The path of the bob from the side and from above. The bob oscillates between two heights, while its "
            "plane of oscillation rotates.",
            tops.spherical_pendulum,
            "The spherical pendulum",
        ),
    ),
    "sleeping_top": (
        Figure(
            "sleeping_top", "Effective potential at the vertical",
            r"The effective potential of an upright top, $p_\phi = p_\psi$, for three spins. Above the limit "
            r"$p_\psi^2 = 4 A W c_3$ the potential has a minimum at the vertical, and the top sleeps (blue). Below "
            "the limit it has a maximum there, and the top falls (red).",
            tops.sleeping_potential,
        ),
    ),
    "driven_rotation": (
        Figure(
            "driven_rotation", "Angular velocity under a torque and damping",
            r"From every initial value the angular velocity approaches $\tau / b$, where the damping $b\,\omega$ "
            r"balances the constant torque $\tau$.",
            mechanics.driven_rates,
        ),
    ),
    "rolling": (
        Figure(
            "rolling", "A wheel that rolls without slipping",
            "The point of contact (green) is at rest. The velocity of every other point (red) is perpendicular to the "
            "dashed line to the point of contact and grows with the distance from it. A point of the rim moves on a "
            "cycloid (blue).",
            mechanics.rolling_disk,
            "A wheel on a straight line",
        ),
    ),
    "gear_trains": (
        Figure(
            "gear_trains", "A planetary gear",
            "Three planets (red) roll between the sun (blue) and the ring (grey); the carrier (green) holds their "
            "axles.",
            mechanics.planetary_gear,
        ),
    ),
    "planar_linkages": (
        Figure(
            "slider_crank", "Slider-crank",
            r"The crank $r$ at the angle $\phi$ moves the slider to $x$ through the rod $L$, which has the angle "
            r"$\psi$.",
            mechanics.slider_crank,
            "Slider-crank",
        ),
        Figure(
            "four_bars", "Four bars",
            "The crank $a$, the coupler $b$ and the rocker $c$ on the fixed bar $h$. During one revolution of the "
            "crank, a point of the coupler moves along the violet curve.",
            mechanics.four_bars,
            "Four bars",
        ),
    ),
}  # fmt: skip
"""Name of a derivation -> its figures."""


def figures_of(name: str) -> tuple[Figure, ...]:
    """Return the figures on the page of the derivation called ``name``, in order.

    Parameters
    ----------
    name : str
        The name of the derivation; a page without figures has an empty tuple.

    Examples
    --------
    >>> [figure.name for figure in figures_of("poinsot")]
    ['poinsot']
    """
    return FIGURES.get(name, ())
