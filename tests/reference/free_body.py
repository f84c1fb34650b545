"""The free body to 60 digits at any time, through elliptic integrals of the third kind (mpmath).

It shares no formula of the phase with symrot, which uses theta functions: here ``psi' = |L|/I3 + (2T - |L|^2/I3)/(|L| +
L3)`` is integrated to Legendre's Pi and an arc tangent. It is compared with the Taylor series of
:mod:`tests.reference.taylor`, which uses no elliptic functions.
"""

import mpmath
from mpmath import atan, atan2, cos, ellipfun, ellipk, ellippi, elliprf, elliprj, floor, mp, mpf, pi, sin, sqrt

DIGITS = 130
"""Working precision unless another is asked for: near the separatrix, and near steady rotation, tens of digits cancel."""


def exactly(value):
    """Return a Fraction or a double as mpf."""
    return mpf(value.numerator) / value.denominator if hasattr(value, "numerator") else mpf(value)


def multiply(a, b):
    """Return the quaternion product, scalar first."""
    a0, a1, a2, a3 = a
    b0, b1, b2, b3 = b
    return [
        a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3,
        a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
        a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1,
        a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0,
    ]


def worst_errors(motion, times, rates, attitudes, size):
    """Return the largest errors at the times, compared with a motion: of omega, divided by ``size``, and of q, up to
    sign.
    """
    worst = [0.0, 0.0]
    for time, rate, attitude in zip(times, rates.tolist(), attitudes.tolist(), strict=True):
        w, q = motion(time)
        apart = [max(abs(x - s * y) for x, y in zip(attitude, q, strict=True)) for s in (1, -1)]
        worst[0] = max(worst[0], float(max(abs(x - y) for x, y in zip(rate, w, strict=True)) / size))
        worst[1] = max(worst[1], float(min(apart)))
    return worst


def conjugate(a):
    return [a[0], -a[1], -a[2], -a[3]]


def normalised(q):
    norm = sqrt(sum(x * x for x in q))
    return [x / norm for x in q]


def quaternion_of(rows):
    """Return the quaternion of a proper rotation matrix."""
    trace = rows[0][0] + rows[1][1] + rows[2][2]
    candidates = [
        [1 + trace, rows[2][1] - rows[1][2], rows[0][2] - rows[2][0], rows[1][0] - rows[0][1]],
        [rows[2][1] - rows[1][2], 1 + 2 * rows[0][0] - trace, rows[0][1] + rows[1][0], rows[2][0] + rows[0][2]],
        [rows[0][2] - rows[2][0], rows[0][1] + rows[1][0], 1 + 2 * rows[1][1] - trace, rows[1][2] + rows[2][1]],
        [rows[1][0] - rows[0][1], rows[2][0] + rows[0][2], rows[1][2] + rows[2][1], 1 + 2 * rows[2][2] - trace],
    ]
    return normalised([mpf(x) for x in max(candidates, key=lambda c: sum(x * x for x in c))])


def motion(moments, omega, quaternion, digits=DIGITS):
    """Return a function of time that gives ``(omega_b, quaternion)``, in principal axes; the given numbers are taken
    exactly.
    """
    with mp.workdps(digits):
        moments, omega = [exactly(x) for x in moments], [exactly(x) for x in omega]
        start = normalised([exactly(x) for x in quaternion])
        torque = [
            (moments[(i + 1) % 3] - moments[(i + 2) % 3]) * omega[(i + 1) % 3] * omega[(i + 2) % 3] for i in range(3)
        ]
        return _steady(omega, start, digits) if not any(torque) else _elliptic(moments, omega, start, digits)


def _steady(omega, start, digits):
    def at(t):
        with mp.workdps(digits):
            speed = sqrt(sum(x * x for x in omega))
            angle = exactly(t) * speed / 2
            turn = [cos(angle), *((x / speed if speed else mpf(0)) * sin(angle) for x in omega)]
            return omega, multiply(start, turn)

    at.period = None
    return at


def _elliptic(moments, omega, start, digits):
    momenta = [i * w for i, w in zip(moments, omega, strict=True)]
    square, twice = sum(x * x for x in momenta), sum(x * w for x, w in zip(momenta, omega, strict=True))
    small, middle, large = sorted(range(3), key=lambda k: moments[k])
    third = large if square >= twice * moments[middle] else small
    first = small if third == large else large
    signs = {k: -1 if omega[k] < 0 else 1 for k in (first, third)}
    proper = 1 if (first, middle, third) in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1
    signs[middle] = signs[first] * signs[third] * proper
    order = (first, middle, third)
    i1, i2, i3 = (moments[k] for k in order)
    l1, l2, l3 = (momenta[k] * signs[k] for k in order)
    s = 1 if i3 > i2 else -1
    a1 = sqrt(l1**2 + l2**2 * i1 * (i3 - i2) / (i2 * (i3 - i1)))
    a2 = sqrt(l2**2 + l1**2 * i2 * (i3 - i1) / (i1 * (i3 - i2)))
    a3 = sqrt(l3**2 + l2**2 * i3 * (i2 - i1) / (i2 * (i3 - i1)))
    g = sqrt(square)
    m = (i2 - i1) * i3 * a2**2 / ((i3 - i1) * i2 * a3**2)
    if abs(1 - m) < mpf(10) ** (10 - digits):
        m = mpf(1)
    rate = a3 / i3 * sqrt((i3 - i2) * (i3 - i1) / (i1 * i2))
    whole = ellipk(m) if m < 1 else None
    n = -(a3**2) * m / a1**2
    whole_pi = ellippi(n, m) if m < 1 else None
    root = sqrt(1 - n)

    def amplitude(u):
        if m == 1:
            return 0, 2 * atan(mpmath.tanh(u / 2))
        turns = floor(u / (2 * whole) + mpf(1) / 2)
        rest = u - 2 * whole * turns
        return turns, atan2(ellipfun("sn", rest, m=m), abs(ellipfun("cn", rest, m=m)))

    def third_kind(phi):
        if m < 1:
            x, y = sin(phi), cos(phi) ** 2
            turning = 1 - m * x * x
            return x * elliprf(y, turning, 1) + n / 3 * x**3 * elliprj(y, turning, 1, 1 - n * x * x)
        x = sin(phi)  # integral of dx/((1 - n x^2)(1 - x^2))
        k = sqrt(-n)
        return (mpmath.atanh(x) + k * atan(k * x)) / (1 - n)

    def psi(turns, phi, u):
        """Return the integral of psi' from u = 0, times rate."""
        pi_part = third_kind(phi) + (2 * turns * whole_pi if turns else 0)
        arc = atan2(root * sin(phi), abs(cos(phi))) + pi * turns
        return g / i3 * u + (twice - square / i3) * (g * pi_part / a1**2 - a3 * arc / (a1**2 * root))

    def state(u):
        turns, phi = amplitude(u)
        sn, cn = sin(phi) * (-1) ** int(turns), cos(phi) * (-1) ** int(turns)
        m1, m2 = a1 * cn / g, s * a2 * sn / g
        m3 = a3 * sqrt(cos(phi) ** 2 + (1 - m) * sin(phi) ** 2) / g
        half = psi(turns, phi, u) / rate / 2
        x = multiply([cos(half), 0, 0, sin(half)], normalised([1 + m3, m2, -m1, mpf(0)]))
        body = dict(zip(order, (m1 * g / i1, m2 * g / i2, m3 * g / i3), strict=True))
        return [signs[k] * body[k] for k in range(3)], x

    sine, cosine = s * l2 / a2, l1 / a1
    u0 = sine * elliprf(cosine**2, (l3 / a3) ** 2, 1)
    rename = quaternion_of([[signs[k] * (axis == k) for axis in range(3)] for k in order])
    left = multiply(start, conjugate(multiply(state(u0)[1], rename)))

    def at(t):
        with mp.workdps(digits):
            found, x = state(u0 + rate * exactly(t))
            return found, multiply(multiply(left, x), rename)

    at.period = 4 * whole / rate if whole else None
    return at
