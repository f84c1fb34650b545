"""Symbols of known formulas that :mod:`symrot.symbols` does not have, with their units."""

from sympy import Symbol

__all__ = [
    "AFTER", "ALPHA", "BEFORE", "DISTANCE", "END", "ENERGY", "FALL", "GYRATION", "LENGTH", "MOMENTUM_RATE",
    "MOMENTUM_RATES", "ONE_FORCE", "ONE_MOMENTUM", "PERIOD", "POINT_MOMENTUM", "PULLEY", "SLOPE", "SPEED", "START",
    "STIFFNESS", "TENSION", "TILT", "TIME", "TORQUE", "UNIT_OF_SYMBOL", "WHEEL_MOMENTUM", "WORK",
]  # fmt: skip

UNIT_OF_SYMBOL: dict[Symbol, str] = {}
"""Symbol of this module -> its unit; a few units have a remark, as in "N, of a string" for a tension."""


def _new(name: str, unit: str) -> Symbol:
    """Create a real symbol, record its unit, and return it."""
    symbol = Symbol(name, real=True)
    UNIT_OF_SYMBOL[symbol] = unit
    return symbol


ENERGY, STIFFNESS, SPEED = _new("E_k", "J"), _new("k_t", "N m/rad"), _new("v", "m/s")
BEFORE, AFTER = _new("omega_i", "rad/s"), _new("omega_f", "rad/s")
START, END, TIME = _new("theta_i", "rad"), _new("theta_f", "rad"), _new("t", "s")
ALPHA, FALL, SLOPE = _new("alpha_a", "rad/s^2"), _new("a_l", "m/s^2"), _new("beta", "rad")
TORQUE, PERIOD, LENGTH = _new("M", "N m"), _new("T_p", "s"), _new("q_d", "m")
PULLEY = _new("M_p", "kg")
TENSION = _new("T_s", "N, of a string")
GYRATION = _new("k_O", "m, of gyration")
TILT = _new("gamma", "rad")
WHEEL_MOMENTUM = _new("h_w", "kg m^2/s")
WORK = _new("W_k", "J")
POINT_MOMENTUM = tuple(_new(f"p_{axis}", "kg m/s") for axis in "xyz")
ONE_MOMENTUM, ONE_FORCE, DISTANCE = _new("p_m", "kg m/s"), _new("F", "N"), _new("d", "m")
MOMENTUM_RATE = _new("dH", "N m, of momentum")
MOMENTUM_RATES = tuple(_new(f"dL_{n}", "N m, of momentum") for n in "123")
