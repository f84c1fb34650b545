"""The SymPy symbols of symrot's formulas, with assumptions and units (see :mod:`symrot.conventions`).

All symbols are defined here, except those of a scene's constants, such as the weight: :func:`constant` makes these when
a formula needs them.
"""

from sympy import Symbol

UNIT: dict[Symbol, str] = {}


def _make(names: str, unit: str, **assumptions: bool) -> tuple[Symbol, ...]:
    assumptions = assumptions or {"real": True}
    made = tuple(Symbol(name, **assumptions) for name in names.split())
    UNIT.update(dict.fromkeys(made, unit))
    return made


def constant(name: str) -> Symbol:
    """Return the real symbol of a constant in a scene, such as the weight in a gravity torque."""
    return Symbol(name, real=True)


(t,) = _make("t", "s")

# Euler angles in order of application (precession, nutation, spin for ZXZ), and their rates
angles = phi, theta, psi = _make("phi theta psi", "rad")
angle_rates = dphi, dtheta, dpsi = _make("dphi dtheta dpsi", "rad/s")

# attitude
quaternion = q0, q1, q2, q3 = _make("q0 q1 q2 q3", "1")  # unit, scalar first, body to space
rotation_vector = v1, v2, v3 = _make("v1 v2 v3", "rad")  # axis times angle
axis = n1, n2, n3 = _make("n1 n2 n3", "1")  # unit axis
(alpha,) = _make("alpha", "rad")  # angle about the axis
rodrigues = g1, g2, g3 = _make("g1 g2 g3", "1")  # classical: axis times tan(angle/2)
mrp = s1, s2, s3 = _make("s1 s2 s3", "1")  # modified: axis times tan(angle/4)

# angular velocity, acceleration
omega_b = omega_1, omega_2, omega_3 = _make("omega_1 omega_2 omega_3", "rad/s")  # body components
omega_s = omega_x, omega_y, omega_z = _make("omega_x omega_y omega_z", "rad/s")  # space components

# inertia: principal moments; tensor components, products with the minus sign
principal = A, B, C = _make("A B C", "kg m^2", positive=True)
moments = I_xx, I_yy, I_zz = _make("I_xx I_yy I_zz", "kg m^2", positive=True)
products = I_xy, I_xz, I_yz = _make("I_xy I_xz I_yz", "kg m^2")
(m,) = _make("m", "kg", positive=True)
position = x, y, z = _make("x y z", "m")

# solids: dimensions, corners, uniform density of a solid; coordinates of the maps
dimensions = a, b, c, h, L, r, R, R_1, R_2 = _make("a b c h L r R R_1 R_2", "m", positive=True)
(e,) = _make("e", "m")  # x of the third corner of a triangle
corners = _make(" ".join(f"{axis}_{n}" for n in range(1, 5) for axis in "xyz"), "m")
(rho,) = _make("rho", "kg/m^3", positive=True)
map_lengths = s, u, v, w = _make("s u v w", "m")
map_shares = f_1, f_2, f_3 = _make("f_1 f_2 f_3", "1")

# torque, body components
torque_b = tau_1, tau_2, tau_3 = _make("tau_1 tau_2 tau_3", "N m")

# rates of change, for derivations
omega_rates = domega_1, domega_2, domega_3 = _make("domega_1 domega_2 domega_3", "rad/s^2")  # body components
quaternion_rates = dq0, dq1, dq2, dq3 = _make("dq0 dq1 dq2 dq3", "1/s")
rotation_vector_rates = _make("dv1 dv2 dv3", "rad/s")
rodrigues_rates = _make("dg1 dg2 dg3", "1/s")
mrp_rates = _make("ds1 ds2 ds3", "1/s")

# vectors in body components, for derivations
center_of_mass = c_1, c_2, c_3 = _make("c_1 c_2 c_3", "m")  # from the fixed point
vertical = gamma_1, gamma_2, gamma_3 = _make("gamma_1 gamma_2 gamma_3", "1")  # a direction fixed in space
radius = r_1, r_2, r_3 = _make("r_1 r_2 r_3", "1")  # direction of the attracting centre's radius
normal = k_1, k_2, k_3 = _make("k_1 k_2 k_3", "1")  # normal of the orbit
rotor = h_1, h_2, h_3 = _make("h_1 h_2 h_3", "kg m^2/s")  # angular momentum of a rotor relative to the body
offset = d_x, d_y, d_z = _make("d_x d_y d_z", "m")

# matrices and vectors, for derivations
rotation_entries = _make(" ".join(f"R_{i}{j}" for i in "123" for j in "123"), "1")
rotation_entry_rates = _make(" ".join(f"dR_{i}{j}" for i in "123" for j in "123"), "1/s")
second_quaternion = _make("p0 p1 p2 p3", "1")
angle_accelerations = ddphi, ddtheta, ddpsi = _make("ddphi ddtheta ddpsi", "rad/s^2")
particle_masses = m_1, m_2, m_3 = _make("m_1 m_2 m_3", "kg", positive=True)
velocity = v_x, v_y, v_z = _make("v_x v_y v_z", "m/s")  # of a reference point
acceleration = a_x, a_y, a_z = _make("a_x a_y a_z", "m/s^2")
relative_velocity = u_x, u_y, u_z = _make("u_x u_y u_z", "m/s")  # seen from the body
relative_acceleration = w_x, w_y, w_z = _make("w_x w_y w_z", "m/s^2")
force = F_x, F_y, F_z = _make("F_x F_y F_z", "N")
damping = b_1, b_2, b_3 = _make("b_1 b_2 b_3", "N m s", positive=True)
impulse = J_x, J_y, J_z = _make("J_x J_y J_z", "N s")

# scalars, for derivations
(W,) = _make("W", "N", positive=True)  # weight
(n,) = _make("n", "rad/s", positive=True)  # mean motion
(Omega,) = _make("Omega", "rad/s", positive=True)
excess = delta_1, delta_2 = _make("delta_1 delta_2", "kg m^2", positive=True)  # differences of principal moments
(epsilon,) = _make("epsilon", "1")
(D,) = _make("D", "1", positive=True)  # number of dimensions
(E,) = _make("E", "J")  # energy
(H,) = _make("H", "kg m^2/s", positive=True)  # length of the angular momentum
momenta = p_phi, p_theta, p_psi = _make("p_phi p_theta p_psi", "kg m^2/s")  # conjugate to the Euler angles
(g,) = _make("g", "m/s^2", positive=True)
elliptic = sn, cn, dn = _make("sn cn dn", "1")  # Jacobi's elliptic functions at the argument p t
(mu,) = _make("mu", "1")  # parameter of the elliptic functions, the square of their modulus
(p,) = _make("p", "rad/s", positive=True)
amplitudes = a_1, a_3 = _make("a_1 a_3", "rad/s", positive=True)
(mu_f,) = _make("mu_f", "1", positive=True)  # coefficient of friction
gear_rates = omega_S, omega_R, omega_C, omega_P = _make("omega_S omega_R omega_C omega_P", "rad/s")
teeth = Z_S, Z_R, Z_P = _make("Z_S Z_R Z_P", "1", positive=True)

# exact motions, for derivations
elliptic_w = sn_w, cn_w, dn_w = _make("sn_w cn_w dn_w", "1")  # at a fixed argument w
(zeta,) = _make("zeta", "1")  # Jacobi's zeta function
(sigma,) = _make("sigma", "1")  # a sign, +1 or -1
momentum_b = L_1, L_2, L_3 = _make("L_1 L_2 L_3", "kg m^2/s")  # angular momentum, body components
momentum_amplitudes = ell_1, ell_2, ell_3 = _make("ell_1 ell_2 ell_3", "kg m^2/s", positive=True)
heights = u_1, u_2, u_3 = _make("u_1 u_2 u_3", "1")  # zeros of the cubic of a heavy top, in cos(theta)

# outputs of kernels
jacobian_entries = _make(" ".join(f"B_{i}{j}" for i in "123" for j in "123"), "1")
product_quaternion = _make("pq0 pq1 pq2 pq3", "1")
vector = _make("vector_1 vector_2 vector_3", "")  # any vector, with the unit of the quantity that it represents
turned_vector = _make("turned_1 turned_2 turned_3", "")
