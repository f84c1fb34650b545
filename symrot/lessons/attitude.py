"""Lessons of the chapter on attitude."""

from sympy import Integer

from symrot import symbols as s
from symrot.lessons.lesson import Lesson, Mistake, Number

UPRIGHT = {s.phi: Integer(0), s.psi: Integer(0)}  # precession and spin of heavy_top_loops at the start

LESSONS = {
    "rotation_matrices": Lesson(
        question="Which matrices are rotations, and why do three numbers determine a matrix of nine entries?",
        before=(),
        mistake=Mistake(
            "Some books rotate the vector, other books rotate the axes and leave the vector unchanged. Students mix "
            "the two and put the minus sign at the wrong place.",
            "Rz(alpha) == Matrix([[cos(alpha), sin(alpha), 0], [-sin(alpha), cos(alpha), 0], [0, 0, 1]])",
            lesson="To find the sign, rotate the first axis by a small positive angle: it moves toward the second "
            "axis.",
        ),
        worked="matrix_entry",
        kernel="euler_zxz_dcm",
        topic="euler_angles",
    ),
    "axis_and_angle": Lesson(
        question="A body rotates about a slanted axis. Where does each of its points go?",
        before=("rotation_matrices",),
        mistake=Mistake(
            r"The trace of a rotation of the plane is $2\cos\alpha$. For a rotation in space, students forget the "
            "axis, which is unchanged and adds 1.",
            "trace(Rz(alpha)) == 2*cos(alpha)",
            lesson="So the angle follows from $\\cos\\alpha = (\\mathrm{tr}\\,R - 1)/2$.",
        ),
        scene="axisymmetric_satellite",
        numbers=(
            Number(
                "The satellite starts in an inclined attitude. The first entry of its rotation matrix is the cosine "
                "of the angle by which its first axis is inclined:",
                "R_{11}",
                "The rotation matrix in terms of axis and angle.",
                "1",
                entry=0,
            ),
            Number(
                "The cosine of the rotation angle, from the trace of this matrix:",
                "\\cos\\alpha",
                "The trace gives the cosine of the angle.",
                "1",
            ),
        ),
        kernel="rotation_vector_dcm",
        topic="axis_and_angle",
        library=("The axis without loss of digits",),
    ),
    "composition": Lesson(
        question="A body rotates twice, about two axes. Which single rotation is that, and does the order matter?",
        before=("rotation_matrices", "axis_and_angle"),
        mistake=Mistake(
            "Numbers may be multiplied in any order, so students exchange the factors of a product of rotations.",
            "Rz(alpha)*Rx(beta) == Rx(beta)*Rz(alpha)",
            repair=None,
            lesson="Take a book and try it with two quarter rotations.",
        ),
        worked="angle_of_two_rotations",
        kernel="quaternion_product",
        topic="composition",
    ),
    "euler_parameters": Lesson(
        question="How do three Euler angles become the four numbers of a quaternion, and why do half angles appear?",
        before=("composition",),
        mistake=Mistake(
            "The quaternion of a rotation contains half the rotation angle. Students put in the whole angle.",
            "dcm_of(Matrix([cos(alpha), 0, 0, sin(alpha)])) == Rz(alpha)",
            lesson=r"The quaternion occurs on both sides of the vector, in $q\,v\,\bar q$, and each side rotates the "
            "vector by half the angle.",
        ),
        scene="heavy_top_loops",
        numbers=(
            Number(
                "The top starts with the precession 0, the nutation 30 degrees and the spin 0. Its quaternion has the "
                "component",
                "q_0",
                "The quaternion is the product of three factors",
                "1",
                entry=0,
                where=UPRIGHT,
            ),
            Number("and", "q_1", "The quaternion is the product of three factors", "1", entry=1, where=UPRIGHT),
        ),
        kernel="euler_zxz_quaternion",
        topic="quaternions",
    ),
}
