"""Lessons of the chapter on inertia."""

from sympy import Integer

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

LESSONS = {
    "angular_momentum": Lesson(
        question="Why does a body need six numbers of inertia, where a point needs only its mass?",
        before=("spin_tensor",),
        mistake=Mistake(
            "For motion in a plane the angular momentum of a particle is $m r^2 \\omega$. Students carry this over to "
            "space.",
            "cross(Matrix([x, y, z]), cross(Matrix([a, b, c]), Matrix([x, y, z])))"
            " == (x**2 + y**2 + z**2)*Matrix([a, b, c])",
            lesson="The term $-r\\,(r \\cdot \\omega)$ is missing; it makes the products of inertia.",
        ),
        worked="product_of_two_masses",
        kernel="angular_momentum_body",
        topic="inertia",
    ),
    "kinetic_energy": Lesson(
        question="How much energy is in the rotation of a body?",
        before=("angular_momentum",),
        mistake=Mistake(
            "Students add up products where squares belong.",
            "T == (A*omega_1 + C*omega_3)**2/(2*(A + C))",
            facts=("T == A*omega_1**2/2 + C*omega_3**2/2", "A > 0", "C > 0"),
            lesson="Energies about principal axes add; angular velocities do not add into one with a common moment.",
        ),
        scene="t_handle",
        numbers=(
            Number("The kinetic energy of the handle:", "T", "Along principal axes, in angular velocity", "J"),
            Number(
                "Its angular momentum about axis 3:",
                "L_3",
                "Its gradient is the angular momentum.",
                "kg m^2/s",
                entry=2,
            ),
        ),
        kernel="kinetic_energy",
        topic="euler_equations",
    ),
    "parallel_axis": Lesson(
        question="The inertia about the centre of mass is in a table. What is it about another point?",
        before=("angular_momentum",),
        mistake=Mistake(
            "The theorem holds from the centre of mass only. Students move from one end of a rod, at $a$ from the "
            "centre, "
            "to another point, at $b$, with the square of the distance between the two.",
            "I_2 == I_1 + m*(b - a)**2",
            facts=("I_1 == I_0 + m*a**2", "I_2 == I_0 + m*b**2", "m > 0", "I_0 > 0"),
            lesson="Go back to the centre of mass first, then out again.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "The centre of mass of the top is 60 mm above its tip. Moving the point of reference to the tip adds "
                "to "
                "the moment across the axis",
                "(I_O - I)_{xx}",
                "No axis through the centre of mass",
                "kg m^2",
                where={s.d_x: s.c_3, s.d_y: Integer(0)},
            ),
        ),
        kernel="inertia_parallel_axis",
        topic="inertia",
    ),
    "tensor_rotation": Lesson(
        question="The axes rotate, the body stays. How do the six numbers of inertia change?",
        before=("angular_momentum", "rotation_matrices"),
        mistake=Mistake(
            "The matrix stands on the left, its transpose on the right. Students exchange them, and the product of "
            "inertia "
            "gets the wrong sign.",
            "(transpose(Rz(alpha))*diag(A, B, C)*Rz(alpha))*Matrix([1, 0, 0])"
            " == Matrix([A*cos(alpha)**2 + B*sin(alpha)**2, (A - B)*sin(alpha)*cos(alpha), 0])",
            facts=("A > 0", "B > 0", "C > 0"),
            lesson="With $R$ from body to space, $I_s = R\\,I\\,R^{\\mathsf T}$ acts on vectors of space.",
        ),
        worked="principal_moment",
        kernel="inertia_rotated",
        topic="inertia",
    ),
    "standard_solids": Lesson(
        question="Where do the fractions in the tables of moments of inertia come from?",
        before=("angular_momentum", "parallel_axis"),
        mistake=Mistake(
            "A disk consists of rings of mass $2 m r\\,dr/R^2$. Students give each ring the same mass, $m\\,dr/R$, as "
            "if "
            "the disk were a rod.",
            "integrate(r**2*m/R, (r, 0, R)) == m*R**2/2",
            facts=("m > 0", "R > 0"),
            lesson="Outer rings are longer, so they have more mass: half of $m R^2$ for the disk, a third for the rod.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "The satellite is a cylinder. Its moment about its axis is",
                "C",
                "The tensor of inertia about the centre of mass.",
                "kg m^2",
                entry=8,
                section="Cylinder",
            ),
            Number(
                "and across it",
                "A",
                "The tensor of inertia about the centre of mass.",
                "kg m^2",
                entry=0,
                section="Cylinder",
            ),
        ),
        kernel="inertia_cylinder",
        topic="inertia",
    ),
}
