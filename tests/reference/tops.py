"""Free bodies and tops as kernels written by hand, with their motions by a Taylor series in 38 digits that shares
nothing else.
"""

import math
from functools import cache
from operator import mul

import mpmath
import numpy as np

RIGID_BODY = """
/* p = A, B, C, weight times centre of mass (3, body axes); gravity along -z of space */
static inline void rigid_body(double t, const double y[7], const double p[6], double dy[7])
{
    const double w1 = y[0], w2 = y[1], w3 = y[2], q0 = y[3], q1 = y[4], q2 = y[5], q3 = y[6];
    const double n = q0*q0 + q1*q1 + q2*q2 + q3*q3;
    const double g1 = -2*(q1*q3 - q0*q2)/n, g2 = -2*(q2*q3 + q0*q1)/n, g3 = -(q0*q0 - q1*q1 - q2*q2 + q3*q3)/n;
    (void)t;
    dy[0] = ((p[1] - p[2])*w2*w3 + p[4]*g3 - p[5]*g2)/p[0];
    dy[1] = ((p[2] - p[0])*w3*w1 + p[5]*g1 - p[3]*g3)/p[1];
    dy[2] = ((p[0] - p[1])*w1*w2 + p[3]*g2 - p[4]*g1)/p[2];
    dy[3] = 0.5*(-q1*w1 - q2*w2 - q3*w3);
    dy[4] = 0.5*(q0*w1 + q2*w3 - q3*w2);
    dy[5] = 0.5*(q0*w2 + q3*w1 - q1*w3);
    dy[6] = 0.5*(q0*w3 + q1*w2 - q2*w1);
}
"""


def rigid_body(t, y, p):
    """Return the rates, computed in Python."""
    a, b, c, m1, m2, m3 = p
    w1, w2, w3, q0, q1, q2, q3 = y
    n = q0 * q0 + q1 * q1 + q2 * q2 + q3 * q3
    g1, g2 = -2 * (q1 * q3 - q0 * q2) / n, -2 * (q2 * q3 + q0 * q1) / n
    g3 = -(q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3) / n
    return [
        ((b - c) * w2 * w3 + m2 * g3 - m3 * g2) / a,
        ((c - a) * w3 * w1 + m3 * g1 - m1 * g3) / b,
        ((a - b) * w1 * w2 + m1 * g2 - m2 * g1) / c,
        0.5 * (-q1 * w1 - q2 * w2 - q3 * w3),
        0.5 * (q0 * w1 + q2 * w3 - q3 * w2),
        0.5 * (q0 * w2 + q3 * w1 - q1 * w3),
        0.5 * (q0 * w3 + q1 * w2 - q2 * w1),
    ]


def state(omega, angle=0.0):
    """Return a state from omega and the attitude turned by an angle about x."""
    return np.array([*omega, math.cos(angle / 2), math.sin(angle / 2), 0.0, 0.0])


MOTIONS = {  # moments, weight times centre of mass, initial state
    "flips about the middle axis": ((5 / 12, 20 / 12, 17 / 12), (0, 0, 0), state((0, 0.01, 1))),
    "asymmetric": ((1.0, 2.0, 3.0), (0, 0, 0), state((0.3, 1, 0.5))),
    "top with cusps": ((1.0, 1.0, 0.5), (0, 0, 1.0), state((0, 0, 5), 0.5)),
    "top with loops": ((1.0, 1.0, 0.5), (0, 0, 1.0), state((0.3, -1.8, 4), 0.5)),
    "asymmetric top": ((1.0, 1.5, 0.7), (0.1, 0.2, 0.9), state((0.5, 0.3, 4))),
}
STOP = 20.0
TIMES = np.linspace(0.0, STOP, 9)


BITS = 128
"""The series below are integers in units of 2^-128; with mpmath's floats they take six times as long."""


def fixed(x):
    return int(mpmath.ldexp(mpmath.mpf(x), BITS))


def times(u, v):
    """Return the newest coefficient of the product of two series."""
    return sum(map(mul, u, v[::-1])) >> BITS


def cross(u, v):
    """Return the newest coefficients of the cross product of two vectors of series."""
    return [times(u[(i + 1) % 3], v[(i + 2) % 3]) - times(u[(i + 2) % 3], v[(i + 1) % 3]) for i in range(3)]


def value(series, at):
    """Return a series at a time, by Horner's scheme."""
    total = 0
    for coefficient in reversed(series):
        total = (total * at >> BITS) + coefficient
    return total


@cache
def taylor(name):
    """Return the states at TIMES, from Taylor series in 38 digits; gravity is a vector in body axes."""
    moments, arm, start = MOTIONS[name]
    with mpmath.workdps(50):
        a, b, c = map(fixed, moments)
        m = [fixed(x) for x in arm]
        y = [fixed(float(x)) for x in start]
        now, order, rows = 0, 26, []
        for time in TIMES:
            while True:
                w, q = [[x] for x in y[:3]], [[x] for x in y[3:]]
                q0, q1, q2, q3 = y[3:]
                norm = sum(x * x for x in y[3:]) >> BITS
                g = [[-2 * (q1 * q3 - q0 * q2) // norm], [-2 * (q2 * q3 + q0 * q1) // norm]]
                g.append([-(q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3) // norm])
                for n in range(order):
                    h = [x[n] for x in g]
                    dw = [
                        ((b - c) * times(w[1], w[2]) + m[1] * h[2] - m[2] * h[1]) // a,
                        ((c - a) * times(w[2], w[0]) + m[2] * h[0] - m[0] * h[2]) // b,
                        ((a - b) * times(w[0], w[1]) + m[0] * h[1] - m[1] * h[0]) // c,
                    ]
                    turn = cross(q[1:], w)
                    dq = [-sum(times(q[i + 1], w[i]) for i in range(3)) // 2]
                    dq += [(times(q[0], w[i]) + turn[i]) // 2 for i in range(3)]
                    for series, rates in ((w, dw), (g, cross(g, w)), (q, dq)):
                        for one, rate in zip(series, rates, strict=True):
                            one.append(rate // (n + 1))
                last = max(abs(one[-1]) + abs(one[-2]) for one in (*w, *q))
                step = fixed((mpmath.mpf(10) ** -24 / mpmath.ldexp(last, -BITS)) ** (mpmath.mpf(1) / order))
                left = fixed(float(time)) - now
                if left <= step:
                    break
                now += step
                y = [value(one, step) for one in (*w, *q)]
            rows.append([float(mpmath.ldexp(value(one, left), -BITS)) for one in (*w, *q)])
    return np.array(rows)


def error(states, reference):
    """Return the error that the tolerance bounds: of omega relative to its largest size, or of the quaternion."""
    omega, size = abs(states[:, :3] - reference[:, :3]).max(), np.linalg.norm(reference[:, :3], axis=1).max()
    return max(omega / size, abs(states[:, 3:] - reference[:, 3:]).max())


def parameters(name):
    """Return the parameters of a motion, as rigid_body takes them."""
    return (*MOTIONS[name][0], *MOTIONS[name][1])


def wave(times):
    """Return the oscillator's states at the times, from the start (1, 0)."""
    return np.array([np.cos(times), -np.sin(times)]).T
