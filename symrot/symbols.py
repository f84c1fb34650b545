"""Every SymPy symbol of symrot, made once, with its assumptions and its unit (see :mod:`symrot.conventions`)."""

from collections.abc import Iterable

from sympy import Symbol

UNIT: dict[Symbol, str] = {}


def _make(names: str, unit: str, **assumptions: bool) -> tuple[Symbol, ...]:
    assumptions = assumptions or {"real": True}
    made = tuple(Symbol(name, **assumptions) for name in names.split())
    UNIT.update(dict.fromkeys(made, unit))
    return made


def unit_of(symbols: Iterable[Symbol]) -> dict[Symbol, str]:
    """Return the unit of each symbol, ``"1"`` for one without dimension; ``KeyError`` for one not made here."""
    return {symbol: UNIT[symbol] for symbol in symbols}


def constant(name: str) -> Symbol:
    """Return the real symbol of a constant of a scene, e.g. the weight in a gravity torque."""
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

# scalars, for derivations
(W,) = _make("W", "N", positive=True)  # weight
(n,) = _make("n", "rad/s", positive=True)  # mean motion
(Omega,) = _make("Omega", "rad/s", positive=True)
excess = delta_1, delta_2 = _make("delta_1 delta_2", "kg m^2", positive=True)  # of one moment over another
(epsilon,) = _make("epsilon", "1")
