"""The table of figures, with captions, for the page of each derivation."""

from symrot.figures import attitude, free_bodies, mechanics, tops
from symrot.figures.solids import solid_figures
from symrot.proof.page import Figure

__all__ = ["FIGURES", "figures_of"]

FIGURES: dict[str, tuple[Figure, ...]] = {
    "rotation_matrices": (
        Figure(
            "rotation_matrices", "One vector in two frames",
            r"The vector $v$ (red) keeps its length. Its components along the axes of the frame rotated by $\alpha$ "
            "(blue) differ from those along the fixed axes (black); the rotation matrix converts one into the other.",
            attitude.plane_rotation,
        ),
    ),
    "axis_and_angle": (
        Figure(
            "axis_and_angle", "Rotation of a vector about an axis",
            r"A rotation about $n$ leaves the part $v_\parallel$ along the axis and rotates the part $v_\perp$ across "
            r"it by $\alpha$. The end of $v$ moves on a circle to $v'$.",
            attitude.rodrigues_rotation,
        ),
    ),
    "composition": (
        Figure(
            "composition", "Two quarter rotations in both orders",
            "The same box after a quarter rotation about the fixed axis $x$ and one about the fixed axis $y$. The two "
            "orders end in different attitudes.",
            attitude.order_of_rotations,
        ),
    ),
    "euler_parameters": (
        Figure(
            "quaternion_double_cover", "Two quaternions for each attitude",
            r"The quaternions of the rotations by $\alpha$ about one axis $n$ are a circle, on which the angle is "
            r"$\alpha/2$. One full rotation, from $0$ to $2\pi$, leads from $1$ to $-1$ (blue); only the second one "
            r"(red) leads back. Opposite points, $q$ and $-q$, are the same attitude.",
            attitude.double_cover,
        ),
    ),
    "spin_tensor": (
        Figure(
            "angular_velocity", "Velocity of a point of a rotating body",
            r"The point at $r$ moves on a circle about the axis of $\omega$. Its velocity $\omega \times r$ is across "
            r"both, of size $|\omega|\,|r| \sin\theta$.",
            attitude.angular_velocity,
        ),
    ),
    "euler_body_rates": (
        Figure(
            "euler_zxz", "The three rotations of ZXZ: precession, nutation, spin",
            r"A proper Euler sequence, ZXZ. The first rotation, by $\phi$, is about $z$; the second, by $\theta$, "
            r"about the new axis $x'$; the third, by $\psi$, about the new axis $z''$. Each panel shows the frame "
            "before the rotation in grey.",
            attitude.proper_euler,
        ),
        Figure(
            "euler_zyx", "The three rotations of ZYX: yaw, pitch, roll",
            r"A Tait-Bryan sequence, ZYX: yaw $\psi$ about $z$, pitch $\theta$ about the new axis $y'$, roll $\phi$ "
            "about the new axis $x''$.",
            attitude.tait_bryan,
        ),
    ),
    "euler_singularities": (
        Figure(
            "gimbal_lock", "Gimbal rings in a general attitude and locked",
            r"Three rings for the sequence ZYX. On the left their axes have three different directions. On the right "
            r"$\theta$ is a right angle: the axes of $\psi$ and $\phi$ are in one line, and the body cannot rotate "
            "about the direction across both of the two axes that are left.",
            attitude.gimbal_lock,
        ),
    ),
    "rotation_vector": (
        Figure(
            "rotation_vector", "The ball of rotation vectors",
            r"A section through the ball of radius $\pi$ whose points are all rotations. Each attitude has one "
            r"rotation vector $\alpha n$ inside; $(\alpha - 2\pi)\,n$ gives the same attitude the other way round.",
            attitude.rotation_vectors,
        ),
    ),
    "rodrigues": (
        Figure(
            "rodrigues", "Two projections of a quaternion",
            "The circle of the quaternions about one axis, with $q_0$ upward. The classical parameters $g$ (blue) "
            "project $q$ from the centre to the tangent at $1$; the modified ones $s$ (red) project it from $-1$ to "
            "the diameter.",
            attitude.projected_quaternions,
        ),
    ),
    "relative_motion": (
        Figure(
            "relative_motion", "Velocities of two points of a body",
            r"The second point moves with the velocity $v$ of $P$ plus $\omega \times R\,d$, which is across the line "
            "between both points.",
            attitude.two_points,
        ),
    ),
    "angular_momentum": (
        Figure(
            "angular_momentum", "Angular momentum and angular velocity have different directions",
            r"The ellipsoid on which the kinetic energy is constant, in the axes of the body. The angular momentum $L$ "
            r"is along its normal at the end of $\omega$; it is along $\omega$ only on a principal axis.",
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
            "In the axes $x, y$ the body has a product of inertia. In the axes $x', y'$ along its directions of "
            "symmetry (red), its principal axes, it has none.",
            mechanics.principal_axes,
        ),
    ),
    "standard_solids": solid_figures(),
    "euler_equations": (
        Figure(
            "euler_equations", "The torque changes the angular momentum",
            r"In a short time $dt$ the angular momentum changes by $\tau\,dt$, along the torque. The angular velocity "
            "has in general another direction than both.",
            mechanics.torque_and_rate,
        ),
    ),
    "impulse_and_momentum": (
        Figure(
            "impulse", "A rod after a blow",
            "A free rod is struck by $J$ at the distance $d$ from its centre of mass $c$. The velocities of its points "
            "(red) grow along the rod. One point, the centre of percussion, stays at rest.",
            mechanics.struck_rod,
        ),
    ),
    "free_body_invariants": (
        Figure(
            "momentum_sphere", "Paths of the angular momentum in the body",
            "In the body the angular momentum moves on a sphere, since its length is constant. Each curve is a "
            "different energy. The red curves, the separatrices, cross on the axis of the intermediate moment.",
            free_bodies.momentum_sphere,
        ),
    ),
    "symmetric_top": (
        Figure(
            "cones_direct", "Direct precession: the body cone rolls outside the space cone",
            r"A slender body, $A > C$. The body cone, around the axis of symmetry $e_3$, rolls on the outside of the "
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
            "polhodes", "Polhodes on the ellipsoid of energy",
            "Paths of the angular velocity in the body, on the ellipsoid of energy of a body with moments "
            "$A < B < C$. Around axes 1 and 3 the paths are closed loops: small disturbances stay small. Near axis 2 "
            "they lead away. The two red curves, the separatrices, cross there.",
            free_bodies.polhodes,
        ),
        Figure(
            "flips", "Flips of a T-handle",
            r"Angular velocity of the scene `t_handle`, which starts about its intermediate axis, here axis 3. It "
            r"rotates nearly steadily for a while, then flips: $\omega_3$ changes its sign.",
            free_bodies.flips,
        ),
    ),
    "poinsot": (
        Figure(
            "poinsot", "Poinsot's ellipsoid rolls on the invariable plane",
            r"The ellipsoid of energy touches the invariable plane at the end of $\omega$ and rolls there without "
            r"slipping. The polhode (blue) is the path of that point on the ellipsoid, the herpolhode (red) its path "
            r"on the plane. Dashed lines are hidden by the ellipsoid. The angular momentum $L$ is across the plane.",
            free_bodies.poinsot,
        ),
    ),
    "free_asymmetric_body": (
        Figure(
            "free_body_rates", "Angular velocity of a free asymmetric body",
            r"The three components of $\omega$ of a free body with three different moments are the elliptic functions "
            r"sn, cn and dn of time. The energy is less than on the separatrix, so that $\omega_3$ keeps its sign.",
            free_bodies.rates,
        ),
    ),
    "heavy_top": (
        Figure(
            "heavy_top", "A top with its angles",
            r"Precession $\phi$ leads from the fixed axis $x$ to the line of nodes, nutation $\theta$ from the "
            r"vertical $z$ to the axis of symmetry $e_3$, and spin $\psi$ goes around that axis. The weight $W$ acts "
            "at the centre of mass.",
            tops.top_with_angles,
        ),
    ),
    "gyroscopic_wheel": (
        Figure(
            "gyroscopic_wheel", "A spinning wheel on a cord",
            r"The weight $W$ has a level torque $\tau$ about the cord. The angular momentum $L$ changes along $\tau$: "
            "the axle goes round the cord and does not fall.",
            tops.hung_wheel,
        ),
    ),
    "gravity_gradient": (
        Figure(
            "gravity_gradient", "Tidal force on a long satellite",
            "Left: a satellite on its orbit. Right: the gravity near it, without that at its centre, stretches along "
            r"the radius $r$ and squeezes across it (grey). The forces on its two ends (red) have a torque $\tau$ that "
            "rotates the long axis toward the radius.",
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
            r"The body leaves one steady rotation about its intermediate axis 2 and settles into the opposite one. "
            r"Between them $\omega_1$ and $\omega_3$ rise and fall once.",
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
            ("loops", "pushed against its precession", tops.loops),
            ("cusps", "released with its axis at rest", tops.cusps),
            ("waves", "pushed a little along its precession", tops.waves),
        )
    ),
    "pendulum": (
        Figure(
            "pendulum", "A pendulum and its phase curves",
            r"Each curve is one motion: $\dot\theta$ over $\theta$. Inside the red curve the pendulum swings (blue); "
            "outside it turns over (green); on it the pendulum takes for ever to reach the top.",
            tops.pendulum_phases,
        ),
        Figure(
            "spherical_pendulum", "Path of a spherical pendulum",
            "The path of the bob from the side and from above. It swings between two heights, and its plane of swing "
            "goes round.",
            tops.spherical_pendulum,
            "The spherical pendulum",
        ),
    ),
    "sleeping_top": (
        Figure(
            "sleeping_top", "Effective potential at the vertical",
            "The effective potential of an upright top, $p_\\phi = p_\\psi$, for three spins. Above the limit "
            "$p_\\psi^2 = 4 A W c_3$ the vertical is a valley, and the top sleeps (blue). Below it, it is a summit, "
            "and the top falls (red).",
            tops.sleeping_potential,
        ),
    ),
    "driven_rotation": (
        Figure(
            "driven_rotation", "Angular velocity under a torque and damping",
            r"From any start the angular velocity tends to $\tau / k$, where the damping $k\,\omega$ balances the "
            r"constant torque $\tau$.",
            mechanics.driven_rates,
        ),
    ),
    "rolling": (
        Figure(
            "rolling", "A wheel that rolls without slipping",
            "The point of contact (green) is at rest. The velocity of every other point (red) is across the dashed "
            "line to the contact and grows with the distance. A point of the rim moves on a cycloid (blue).",
            mechanics.rolling_disk,
            "A wheel on a straight line",
        ),
    ),
    "gear_trains": (
        Figure(
            "gear_trains", "A planetary gear",
            "Three planets (red) run between the sun (blue) and the ring (grey); the carrier (green) holds their "
            "axles.",
            mechanics.planetary_gear,
        ),
    ),
    "planar_linkages": (
        Figure(
            "slider_crank", "Slider-crank",
            r"The crank $r$ at the angle $\phi$ moves the slider to $x$ by the rod $L$, which is at the angle $\psi$.",
            mechanics.slider_crank,
            "Slider-crank",
        ),
        Figure(
            "four_bars", "Four bars",
            r"The crank $a$, the coupler $b$ and the rocker $c$ on the ground $h$. A point of the coupler draws the "
            "violet curve while the crank goes round once.",
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
