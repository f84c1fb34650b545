"""The symmetric heavy top to 60 digits at any time, through elliptic integrals of the third kind (mpmath).

``(arg alpha)' = (omega_3 - l + Sigma/(2 - s))/2`` and ``(arg beta)' = (l - omega_3 + D/s)/2`` with ``s = S1 - (S1 - S2)
sn^2 u`` are integrated to Legendre's Pi; symrot uses theta functions instead. Motions through the vertical are
excluded. The results are compared with the Taylor series of :mod:`tests.reference.taylor`.
"""

from mpmath import (
    atan2,
    cos,
    ellipfun,
    ellipk,
    ellippi,
    elliprf,
    elliprj,
    expj,
    floor,
    mp,
    mpc,
    mpf,
    polyroots,
    sin,
    sqrt,
)

from tests.reference.free_body import exactly, normalised

DIGITS = 90


def motion(transverse, axial, pull, omega, quaternion, digits=DIGITS):
    """Return a function of time that gives ``(omega_b, quaternion)``; e3 is the symmetry axis, gravity acts along -z."""
    with mp.workdps(digits):
        c, m2 = exactly(axial) / exactly(transverse), 2 * exactly(pull) / exactly(transverse)
        w1, w2, w3 = (exactly(x) for x in omega)
        q = normalised([exactly(x) for x in quaternion])
        alpha, beta, across, spin = mpc(q[0], q[3]), mpc(q[1], q[2]), mpc(w1, w2), c * w3
        s0, c0 = 2 * abs(beta) ** 2, 2 * abs(alpha) ** 2
        lever = across * (2 * alpha.conjugate() * beta).conjugate()
        speed, d, sigma = lever.real, lever.imag - spin * s0, lever.imag + spin * c0
        em2 = abs(across) ** 2 - m2 * s0
        cubic = [-m2, 2 * m2 - em2 - spin**2, 2 * em2 - 2 * d * spin, -(d**2)]
        r3, r2, r1 = sorted(x.real for x in polyroots(cubic, maxsteps=500, extraprec=600))
        m, rate = (r1 - r2) / (r1 - r3), sqrt(m2 * (r1 - r3)) / 2
        whole = ellipk(m)
        kinds = {"a": (r1 - r2) / (r1 - 2), "b": (r1 - r2) / r1}
        wholes = {key: ellippi(n, m) for key, n in kinds.items()}
        sine = sqrt(max((r1 - s0) / (r1 - r2), mpf(0)))
        u0 = (-1 if speed > 0 else 1) * sine * elliprf(max((s0 - r2) / (r1 - r2), mpf(0)), (s0 - r3) / (r1 - r3), 1)

    def place(u):
        turns = floor(u / (2 * whole) + mpf(1) / 2)
        rest = u - 2 * whole * turns
        phi = atan2(ellipfun("sn", rest, m=m), abs(ellipfun("cn", rest, m=m)))
        x, y = sin(phi), cos(phi) ** 2
        plain = x * elliprf(y, 1 - m * x * x, 1)
        found = {
            key: 2 * turns * wholes[key] + plain + n / 3 * x**3 * elliprj(y, 1 - m * x * x, 1, 1 - n * x * x)
            for key, n in kinds.items()
        }
        s = r1 - (r1 - r2) * x * x
        odd = sin(phi) * cos(phi) * sqrt(1 - m * x * x)
        return s, -2 * (r1 - r2) * rate * odd, found

    def angles(u):
        s, slope, found = place(u)
        a_angle = (w3 - spin) * u / rate + sigma / (2 - r1) * found["a"] / rate
        b_angle = (spin - w3) * u / rate + d / r1 * found["b"] / rate
        return s, slope, a_angle / 2, b_angle / 2

    with mp.workdps(digits):
        _, _, a_first, b_first = angles(u0)
        a_unit, b_unit = alpha / abs(alpha) * expj(-a_first), beta / abs(beta) * expj(-b_first)

    def at(t):
        with mp.workdps(digits):
            s, slope, a_angle, b_angle = angles(u0 + rate * exactly(t))
            first = sqrt(1 - s / 2) * a_unit * expj(a_angle)
            second = sqrt(s / 2) * b_unit * expj(b_angle)
            turning = mpc(slope, d + spin * s) * 2 * first.conjugate() * second / (s * (2 - s))
            return [turning.real, turning.imag, w3], [first.real, second.real, second.imag, first.imag]

    at.period, at.roots = 2 * whole / rate, (r3, r2, r1)
    return at
