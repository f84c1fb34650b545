"""Reference trajectories to 50 digits: fixed-point Taylor series of Euler's equations with the attitude as a matrix.

This module shares nothing with symrot's equations, kernels or steppers: the state is omega_b and the nine entries of
dcm_sb, the arithmetic uses Python integers scaled by 2^BITS, and order and step go far beyond 50 digits.

``python -m tests.reference.taylor`` prints ``trajectories.toml`` anew.
"""

import sys
from fractions import Fraction
from operator import mul

BITS = 260
ORDER = 60
ACCURACY = 2.0**-200  # size of the last terms of each step

Vector = list[int]


def fixed(value: Fraction) -> int:
    return round(value * 2**BITS)


def _product(a: Vector, b: Vector, n: int) -> int:
    """Return coefficient n of the product of two series."""
    return sum(map(mul, a[: n + 1], b[n::-1])) >> BITS


def _series(omega, dcm, moments, torque):
    """Return the Taylor coefficients of omega (3 lists) and dcm (3 by 3 lists)."""
    w = [[x] for x in omega]
    r = [[[x] for x in row] for row in dcm]
    a, b, c = moments
    gyro = [fixed((b - c) / a), fixed((c - a) / b), fixed((a - b) / c)]
    for n in range(ORDER):
        turning = [gyro[i] * _product(w[(i + 1) % 3], w[(i + 2) % 3], n) >> BITS for i in range(3)]
        pull = [0, 0, 0]
        if torque:
            arm, down, size = torque  # all fixed: centre of mass, direction in space, weight over moments
            body = [sum(r[j][i][n] * down[j] for j in range(3)) >> BITS for i in range(3)]
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                pull[i] = size[i] * ((arm[j] * body[k] - arm[k] * body[j]) >> BITS) >> BITS
        for i in range(3):
            w[i].append((turning[i] + pull[i]) // (n + 1))
        for row in r:
            new = [
                _product(row[(i + 1) % 3], w[(i + 2) % 3], n) - _product(row[(i + 2) % 3], w[(i + 1) % 3], n)
                for i in range(3)
            ]
            for i in range(3):
                row[i].append(new[i] // (n + 1))
    return w, r


def _sum(series: Vector, h: int) -> int:
    total = 0
    for coefficient in reversed(series):
        total = (total * h >> BITS) + coefficient
    return total


def trajectory(moments, omega, quaternion, times, torque=None):
    """Return [(omega_b, dcm_sb)] at increasing times from 0, as Fractions.

    Parameters
    ----------
    moments, omega, quaternion : Fractions
        Principal moments, initial omega_b, initial unit quaternion (scalar first).
    times : Fractions
        Increasing, not negative.
    torque : (weight, arm, direction), optional
        Gravity: N, centre of mass in the body, direction in space.
    """
    q0, q1, q2, q3 = quaternion
    dcm = [
        [q0 * q0 + q1 * q1 - q2 * q2 - q3 * q3, 2 * (q1 * q2 - q0 * q3), 2 * (q1 * q3 + q0 * q2)],
        [2 * (q1 * q2 + q0 * q3), q0 * q0 - q1 * q1 + q2 * q2 - q3 * q3, 2 * (q2 * q3 - q0 * q1)],
        [2 * (q1 * q3 - q0 * q2), 2 * (q2 * q3 + q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3],
    ]
    w, r = [fixed(x) for x in omega], [[fixed(x) for x in row] for row in dcm]
    if torque:
        weight, arm, direction = torque
        torque = [fixed(x) for x in arm], [fixed(x) for x in direction], [fixed(weight / x) for x in moments]
    found, now = [], Fraction(0)
    for time in times:
        while now < time:
            series_w, series_r = _series(w, r, moments, torque)
            flat = [*series_w, *(s for row in series_r for s in row)]
            scale = max(abs(x) for x in w) / 2**BITS
            last = [
                max(abs(s[-1]) / (scale if i < 3 and scale else 1) for i, s in enumerate(flat)) / 2**BITS,
                max(abs(s[-2]) / (scale if i < 3 and scale else 1) for i, s in enumerate(flat)) / 2**BITS,
            ]
            sizes = [(ACCURACY / x) ** (1 / n) for x, n in zip(last, (ORDER, ORDER - 1), strict=True) if x]
            h = min(Fraction(min(sizes, default=float(time - now))).limit_denominator(10**6), time - now)
            step = fixed(h)
            w = [_sum(s, step) for s in series_w]
            r = [[_sum(s, step) for s in row] for row in series_r]
            now += h
        found.append(([Fraction(x, 2**BITS) for x in w], [[Fraction(x, 2**BITS) for x in row] for row in r]))
    return found


SCENES = ("tumbling_prism", "t_handle", "heavy_top_loops", "heavy_top_cusps", "heavy_top_waves")
SAMPLES = 4


def decimal(value: Fraction, digits: int = 50) -> str:
    """Return the value with ``digits`` digits after the point."""
    scaled = round(abs(value) * 10**digits)
    sign = "-" if value < 0 else ""
    return f"{sign}{scaled // 10**digits}.{scaled % 10**digits:0{digits}d}"


def main() -> None:
    """Print the reference file."""
    from symrot.scene.scene import load_scene

    print(
        "# Reference trajectories of shipped scenes: omega_b (rad/s) and dcm_sb, row by row, 50 digits behind the point."
    )
    print("# Printed by `python -m tests.reference.taylor`; the scenes give moments, initial state and gravity alone.")
    for name in SCENES:
        scene = load_scene(name)
        start, stop = scene.span.start, scene.span.stop
        times = [(stop - start) * k / SAMPLES for k in range(1, SAMPLES + 1)]
        torque = None
        if scene.torques:
            values = scene.torques[0].values
            torque = (values["weight"], values["center_of_mass"], values["direction"])
        moments = [scene.body.inertia[i][i] for i in range(3)]
        found = trajectory(moments, scene.initial.omega_b, scene.initial.quaternion, times, torque)
        for time, (omega, dcm) in zip(times, found, strict=True):
            print(f'\n[[{name}]]\nt = "{time}"')
            print("omega = [" + ", ".join(f'"{decimal(x)}"' for x in omega) + "]")
            print("dcm = [\n" + "\n".join(f'  "{decimal(x)}",' for row in dcm for x in row) + "\n]")
        print(f"{name} done", file=sys.stderr)


if __name__ == "__main__":
    main()
