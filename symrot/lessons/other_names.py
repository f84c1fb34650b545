"""Other names of the subjects of pages, such as "Steiner's theorem", by which readers search the book."""

__all__ = ["OTHER_NAMES"]

OTHER_NAMES: dict[str, str] = {
    "rotation_matrices": "direction cosine matrix, DCM, change of frame, coordinate transformation, active and passive",
    "axis_and_angle": "axis-angle, Rodrigues' rotation formula, Euler's theorem on rotations, trace of a rotation",
    "composition": "order of rotations, rotations do not commute, product of rotations",
    "euler_parameters": "unit quaternion, double cover, quaternion from Euler angles, conversion, half angle",
    "spin_tensor": "angular velocity, skew-symmetric matrix, cross product matrix, v = ω × r",
    "euler_body_rates":
        "Euler angle rates, body rates, yaw pitch roll, roll pitch yaw, Tait-Bryan and Cardan angles, precession "
        "nutation spin, rate matrix, Jacobian",
    "euler_singularities": "gimbal lock, singularity of Euler angles, loss of a degree of freedom",
    "quaternion_rates":
        "quaternion kinematics, quaternion derivative, quaternion multiplication, quaternion product, Hamilton "
        "product",
    "rotation_vector": "exponential map, logarithm of a rotation, Bortz equation",
    "rodrigues": "Gibbs vector, Cayley transform, modified Rodrigues parameters, MRP",
    "relative_motion": "Coriolis acceleration, centripetal acceleration, rotating frame, transport theorem",
    "angular_momentum": "inertia tensor, inertia matrix, products of inertia",
    "kinetic_energy": "rotational energy, kinetic energy of rotation, König's theorem",
    "parallel_axis": "parallel axis theorem, Steiner's theorem, Huygens-Steiner theorem",
    "tensor_rotation":
        "principal axes, principal axes of inertia, principal moments, diagonalisation of the inertia tensor, "
        "Mohr's circle",
    "standard_solids":
        "moment of inertia, moments of inertia of rod, disk, ring, cylinder, cone, sphere, box, ellipsoid, table "
        "of moments of inertia",
    "euler_equations": "Euler's equations of rotation, Euler's rotation equations, gyroscopic torque",
    "lagrange_and_euler": "Lagrangian mechanics, Lagrange equations for Euler angles",
    "work_and_power": "power of a torque, work-energy theorem, work of a torque",
    "impulse_and_momentum": "angular impulse, center of percussion, centre of percussion, sweet spot, collision, blow",
    "planar_motion": "fixed axis rotation, unbalanced shaft, balancing, bearing reactions",
    "free_body_invariants":
        "conservation of angular momentum, angular momentum conservation, conservation of energy, momentum sphere, "
        "torque-free motion",
    "symmetric_top":
        "free precession, wobble of the Earth, Chandler wobble, Feynman's plate, body cone and space cone, "
        "torque-free symmetric top",
    "intermediate_axis":
        "tennis racket theorem, Dzhanibekov effect, intermediate axis theorem, T-handle flip, stability of "
        "rotation about principal axes",
    "poinsot": "Poinsot ellipsoid, polhode and herpolhode, invariable plane, inertia ellipsoid",
    "free_asymmetric_body": "Euler top, asymmetric top, torque-free motion by elliptic functions",
    "heavy_top_invariants": "Lagrange top, conserved quantities of a spinning top",
    "heavy_top": "Lagrange top, spinning top, effective potential, steady precession, nutation",
    "gyroscopic_wheel":
        "bicycle wheel, spinning wheel, gyroscope, gyroscopic precession, why a spinning wheel does not fall",
    "gyrostat_invariants": "reaction wheel, momentum wheel, dual-spin satellite, rotor in a body",
    "gravity_gradient": "satellite libration, tidal torque, tidal locking",
    "elliptic_functions": "sn, cn, dn, elliptic integral, Jacobi elliptic functions",
    "free_body_separatrix": "separatrix, heteroclinic motion, intermediate axis flip",
    "heavy_top_motion": "nutation of a top, loops cusps and waves, looping precession, fast top",
    "pendulum": "compound pendulum, simple pendulum, period of a pendulum, spherical pendulum, Foucault",
    "sleeping_top": "sleeping top, upright top, stability of a vertical top",
    "driven_rotation": "damped rotation, spin-up, spin-down, viscous friction, terminal angular velocity",
    "rolling": "rolling without slipping, rolling down an incline, wheel, ball, cycloid",
    "gear_trains": "planetary gear, epicyclic gear, differential, sun planet ring carrier",
    "planar_linkages": "crank mechanism, piston, four-bar linkage, coupler curve",
}  # fmt: skip
"""Name of a derivation -> other names of its subject, separated by commas; English and American spelling."""
