"""Lessons of the chapter on inertia."""

from sympy import Integer

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

LESSONS = {
    "angular_momentum": Lesson(
        question="Why does the rotation of a body need six numbers of inertia, while a point has only a mass?",
        before=("spin_tensor",),
        mistake=Mistake(
            r"For plane motion the angular momentum of a particle is $m r^2 \omega$. Students use this formula in "
            "space too.",
            "cross(Matrix([x, y, z]), cross(Matrix([a, b, c]), Matrix([x, y, z])))"
            " == (x**2 + y**2 + z**2)*Matrix([a, b, c])",
            lesson=r"The term $-r\,(r \cdot \omega)$ is missing; the products of inertia come from this term.",
        ),
        worked="product_of_two_masses",
        kernel="angular_momentum_body",
        topic="inertia",
    ),
    "kinetic_energy": Lesson(
        question="How large is the kinetic energy of a rotating body?",
        before=("angular_momentum",),
        mistake=Mistake(
            "Students add angular momenta and then square the sum, instead of adding squares.",
            "T == (A*omega_1 + C*omega_3)**2/(2*(A + C))",
            facts=("T == A*omega_1**2/2 + C*omega_3**2/2", "A > 0", "C > 0"),
            lesson="The energies of rotation about the principal axes add; no single moment of inertia applies to "
            "the sum of the angular velocities.",
        ),
        scene="t_handle",
        numbers=(
            Number("The kinetic energy of the handle:", "T", "Along principal axes, the energy is", "J"),
            Number(
                "Its angular momentum about axis 3:",
                "L_3",
                "The gradient of the kinetic energy",
                "kg m^2/s",
                entry=2,
            ),
        ),
        kernel="kinetic_energy",
        topic="euler_equations",
    ),
    "parallel_axis": Lesson(
        question="A table gives the inertia about the centre of mass. What is the inertia about another point?",
        before=("angular_momentum",),
        mistake=Mistake(
            "The theorem of parallel axes refers to the centre of mass. Students apply it from one end of a rod, at "
            "the distance $a$ from the centre, to another point, at the distance $b$, with the square of the distance "
            "between the two points.",
            "I_2 == I_1 + m*(b - a)**2",
            facts=("I_1 == I_0 + m*a**2", "I_2 == I_0 + m*b**2", "m > 0", "I_0 > 0"),
            lesson="First apply the theorem back to the centre of mass, then from the centre to the other point.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "The centre of mass of the top is 60 mm above its tip. The moment about a transverse axis through the "
                "tip is larger than the moment about a parallel axis through the centre of mass by",
                "(I_O - I)_{xx}",
                "Among all parallel axes",
                "kg m^2",
                where={s.d_x: s.c_3, s.d_y: Integer(0)},
            ),
        ),
        kernel="inertia_parallel_axis",
        topic="inertia",
    ),
    "tensor_rotation": Lesson(
        question="The same body is described in rotated axes. How do the six numbers of inertia change?",
        before=("angular_momentum", "rotation_matrices"),
        mistake=Mistake(
            "The rotation matrix is on the left of the tensor, its transpose on the right. Students exchange them, "
            "and the product of inertia gets the wrong sign.",
            "(transpose(Rz(alpha))*diag(A, B, C)*Rz(alpha))*Matrix([1, 0, 0])"
            " == Matrix([A*cos(alpha)**2 + B*sin(alpha)**2, (A - B)*sin(alpha)*cos(alpha), 0])",
            facts=("A > 0", "B > 0", "C > 0"),
            lesson=r"If $R$ maps body components to space components, then $I_s = R\,I\,R^{\mathsf T}$ acts on space "
            "components.",
        ),
        worked="principal_moment",
        kernel="inertia_rotated",
        topic="inertia",
    ),
    "standard_solids": Lesson(
        question="Where do the fractions in the tables of moments of inertia come from?",
        before=("angular_momentum", "parallel_axis"),
        mistake=Mistake(
            r"A disk consists of rings of mass $2 m r\,dr/R^2$. Students give each ring the same mass $m\,dr/R$, as "
            "for a rod.",
            "integrate(r**2*m/R, (r, 0, R)) == m*R**2/2",
            facts=("m > 0", "R > 0"),
            lesson="Outer rings are longer, so they have more mass. The integral is half of $m R^2$ for the disk, but "
            "a third of $m R^2$ for the rod.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "The satellite is a cylinder. Its moment of inertia about its axis is",
                "C",
                "Cylinder: the inertia tensor about the centre of mass",
                "kg m^2",
                entry=8,
            ),
            Number(
                "and its moment about a transverse axis through the centre of mass is",
                "A",
                "Cylinder: the inertia tensor about the centre of mass",
                "kg m^2",
                entry=0,
            ),
        ),
        kernel="inertia_cylinder",
        topic="inertia",
    ),
}
