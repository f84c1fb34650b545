"""Lessons of the chapter on angular velocity."""

from sympy import Integer, Rational

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

BAR = Rational(1, 20)  # m, half the bar of the scene t_handle

LESSONS = {
    "spin_tensor": Lesson(
        question="Why is there a vector of angular velocity, although an attitude is not a vector?",
        before=("rotation_matrices",),
        mistake=Mistake(
            "The cross product changes its sign if its factors are exchanged. Students write the factors of a "
            "velocity in the wrong order.",
            "skew(Matrix([a, b, c]))*Matrix([x, y, z]) == cross(Matrix([x, y, z]), Matrix([a, b, c]))",
            repair=1,
            lesson="The angular velocity comes first: $v = \\omega \\times r$.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The end of the bar, 50 mm from the centre of the bar along axis 1, moves along axis 2 with",
                "v_2",
                "In three dimensions a skew matrix",
                "m/s",
                entry=1,
                where={
                    s.x: BAR,
                    s.y: Integer(0),
                    s.z: Integer(0),
                    s.omega_x: s.omega_1,
                    s.omega_y: s.omega_2,
                    s.omega_z: s.omega_3,
                },
            ),
        ),
        kernel="quaternion_to_space",
        topic="euler_angles",
    ),
    "euler_body_rates": Lesson(
        question="The three Euler angles of a body change at known rates. What is its angular velocity?",
        before=("spin_tensor",),
        mistake=Mistake(
            "In body components, the rate of the precession has the factors sine and cosine of the spin. It is easy "
            "to exchange the two.",
            "omega_1 == dphi*sin(theta)*cos(psi) + dtheta*cos(psi)",
            facts=("omega_1 == dphi*sin(theta)*sin(psi) + dtheta*cos(psi)",),
            lesson=r"Check the formula at $\psi = 0$: then axis 1 is the line of nodes, and only the rotation with "
            r"$\dot\theta$ is about it.",
        ),
        worked="body_rates",
        kernel="euler_zxz_body_rates",
        topic="euler_angles",
    ),
    "euler_singularities": Lesson(
        question="Why do Euler angles fail at some attitudes, and can a better choice of the sequence avoid it?",
        before=("euler_body_rates",),
        mistake=Mistake(
            "The sequence ZXZ is in gimbal lock where the nutation is 0, the sequence ZYX where the pitch is a right "
            "angle. Students take the determinant of one sequence for the determinant of the other.",
            "det(Matrix([[sin(psi)*sin(theta), cos(psi), 0], [cos(psi)*sin(theta), -sin(psi), 0], [cos(theta), 0, 1]]))"
            " == -cos(theta)",
            repair=1,
            lesson="A proper Euler sequence is in gimbal lock where the middle rotation makes the first and the last "
            "axis parallel.",
        ),
        worked="growth_near_lock",
        kernel="euler_zyx_body_rates",
        topic="singularities",
    ),
    "quaternion_rates": Lesson(
        question="How does a quaternion change while the body rotates, and why is there no gimbal lock?",
        before=("euler_parameters", "spin_tensor"),
        mistake=Mistake(
            "The angular velocity in body components is the right factor of the product with the quaternion, the "
            "angular velocity in space components the left factor. Students put the same vector on either side.",
            "qmul(Matrix([a, b, c, d]), Matrix([0, x, y, z])) == qmul(Matrix([0, x, y, z]), Matrix([a, b, c, d]))",
            lesson="The two products agree only if the rotation axis of the attitude is along the angular velocity.",
        ),
        worked="rate_of_component",
        kernel="quaternion_body_rates",
        topic="quaternions",
    ),
    "rotation_vector": Lesson(
        question="Axis times angle is one vector, the rotation vector. Is its rate the angular velocity?",
        before=("axis_and_angle", "spin_tensor"),
        mistake=Mistake(
            r"The formulas contain half angles. Students lose the factor 2 of $1 - \cos a = 2 \sin^2 (a/2)$.",
            "1 - cos(a) == sin(a/2)**2",
            lesson="To check the formula, take small angles: the left side is then $a^2/2$, the right side $a^2/4$.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                r"The satellite starts with the rotation vector $(0, -20^\circ, 0)$. The determinant of the matrix "
                "$B_b$ is close to 1 there, so the rate of the vector is nearly the angular velocity:",
                "\\det B_b",
                "The matrix $B_b$ is singular at whole revolutions",
                "1",
            ),
        ),
        kernel="rotation_vector_body_rates",
        topic="axis_and_angle",
    ),
    "rodrigues": Lesson(
        question="Three numbers can describe a rotation without sines and cosines. What is the disadvantage?",
        before=("quaternion_rates",),
        mistake=Mistake(
            "The angles of two rotations about the same axis add. Students add the parameters instead, which are "
            "tangents of half the angles.",
            "tan((a + b)/2) == tan(a/2) + tan(b/2)",
            repair=None,
            lesson=r"Tangents do not add: $\tan(a + b) = (\tan a + \tan b)/(1 - \tan a \tan b)$.",
        ),
        worked="rodrigues_parameter",
        kernel="rodrigues_body_rates",
        topic="axis_and_angle",
    ),
    "relative_motion": Lesson(
        question="Two points of a body: how do their velocities and accelerations differ?",
        before=("spin_tensor",),
        mistake=Mistake(
            "The acceleration contains $\\omega \\times (\\omega \\times d)$. Students move the brackets and get "
            "zero, as "
            "$\\omega \\times \\omega = 0$.",
            "cross(Matrix([a, b, c]), cross(Matrix([a, b, c]), Matrix([x, y, z])))"
            " == cross(cross(Matrix([a, b, c]), Matrix([a, b, c])), Matrix([x, y, z]))",
            lesson="The cross product is not associative: the brackets matter.",
        ),
        scene="t_handle",
        numbers=(
            Number(
                "The end of the bar, 50 mm from the axis, is pulled towards the axis with the acceleration",
                "a_1",
                "The centripetal term of the acceleration",
                "m/s^2",
                entry=0,
                where={s.d_x: BAR, s.d_y: Integer(0), s.d_z: Integer(0)},
            ),
        ),
        kernel="quaternion_to_space",
        topic="linkages",
    ),
}
