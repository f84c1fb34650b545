"""Jacobi's elliptic functions as symbols, with derivatives, quadratic relations and addition theorems."""

from sympy import Expr, S, Symbol

from symrot import symbols

__all__ = ["CN", "DN", "MU", "SN", "W_VALUES", "I", "derivatives", "imaginary", "shifted", "squares"]

SN, CN, DN = symbols.elliptic
W_VALUES = symbols.elliptic_w
MU = symbols.mu
I = Symbol("i")  # noqa: E741
"""The imaginary unit, as a symbol: a step that uses it has the hypothesis i^2 + 1 = 0 (:func:`imaginary`)."""


def imaginary() -> Expr:
    """Return i^2 + 1, where i is a plain symbol for the imaginary unit; proofs assume that this expression is zero."""
    return I**2 + 1


def derivatives(speed: Expr = S.One, parameter: Expr = MU) -> dict[Symbol, Expr]:
    """Return a map from the symbols sn, cn, dn to their time derivatives; their argument grows at ``speed``, 1/s.

    ``parameter`` is the parameter (square of the modulus) of the elliptic functions.
    """
    return {SN: speed * CN * DN, CN: -speed * SN * DN, DN: -speed * parameter * SN * CN}


def squares(parameter: Expr = MU, fixed: bool = False) -> list[Expr]:
    """Return ``[s^2 + c^2 - 1, d^2 + mu s^2 - 1]``, two expressions that are zero for s, c, d = sn, cn, dn.

    s, c and d are symbols for the values at the variable argument u, or with ``fixed`` at the constant argument w; mu
    is ``parameter``.
    """
    s, c, d = W_VALUES if fixed else (SN, CN, DN)
    return [c**2 - 1 + s**2, d**2 - 1 + parameter * s**2]


def shifted(sign: int = 1, at: tuple[Expr, Expr, Expr] = W_VALUES, parameter: Expr = MU) -> tuple[Expr, Expr, Expr]:
    """Return sn, cn and dn of u + w (``sign`` 1) or u - w (-1) by the addition theorems.

    ``at`` are sn, cn and dn of w; the symbols SN, CN and DN are sn, cn and dn of u.
    """
    s, c, d = at
    s = sign * s
    below = 1 - parameter * SN**2 * s**2
    return (
        (SN * c * d + s * CN * DN) / below,
        (CN * c - SN * DN * s * d) / below,
        (DN * d - parameter * SN * CN * s * c) / below,
    )
