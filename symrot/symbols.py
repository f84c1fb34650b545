"""Every SymPy symbol of symrot, made once, with its assumptions and its unit (see :mod:`symrot.conventions`)."""

from collections.abc import Iterable

from sympy import Symbol

UNIT: dict[Symbol, str] = {}


def _make(names: str, unit: str, **assumptions: bool) -> tuple[Symbol, ...]:
    assumptions = {"real": True} if not assumptions else assumptions
    made = tuple(Symbol(name, **assumptions) for name in names.split())
    UNIT.update(dict.fromkeys(made, unit))
    return made


def unit_of(symbols: Iterable[Symbol]) -> dict[Symbol, str]:
    """Return the unit of each symbol, ``"1"`` for one without dimension; ``KeyError`` for one not made here."""
    return {symbol: UNIT[symbol] for symbol in symbols}


def constant(name: str) -> Symbol:
    """Return the real symbol of a scene's own constant, e.g. the weight of a gravity torque; its unit is the scene's."""
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
