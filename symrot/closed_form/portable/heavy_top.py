"""The motion of a symmetric heavy top, computed by mpmath and NumPy without a C compiler.

The formulas are those of :file:`heavy_top.h`. The Cayley-Klein parameters of the attitude, ``alpha = q0 + 1j*q3`` and
``beta = q1 + 1j*q2``, are quotients of theta series times phase factors. Numbers have 160 digits, so the constants are
computed directly from the roots of the cubic, without the rearrangements that doubles need.

The form of the series depends on the parameter m of the elliptic functions, whose quarter periods are ``K = K(m)`` and
``K' = K(1 - m)``, and whose argument u grows linearly with time. The attribute ``regime`` has its name: ``steady`` for
a top that rotates about its vertical axis, without any series; ``circular`` for m < SWITCH, with sines and cosines of
the angle z = pi u/(2 K); ``hyperbolic`` for other m < 1, with hyperbolic functions of v = pi u/(2 K'); ``separatrix``
for ``m = 1``, the motion that tends to the upright position, with hyperbolic functions of the same v.
"""

from typing import Any

import numpy as np

from symrot.closed_form.build import Floats
from symrot.closed_form.portable.phases import (
    SWITCH,
    TERMS,
    Phase,
    hyperbolic,
    multiples,
    number,
    power_of_two,
    quarter_periods,
    vector,
)
from symrot.closed_form.portable.quaternions import Axes, mapping, unit
from symrot.formula.precision import digits, mp
from symrot.kinematics.hamilton import conjugate, hamilton

__all__ = ["PortableHeavyTop"]

mpc, mpf = mp.mpc, mp.mpf

DIGITS = 160  # digits of the constants
EQUAL = mpf(10) ** -70  # closer roots, relative to their size, count as equal: equal roots are found to about 80 digits
NOTHING = mpf(10) ** -31  # size, relative to alpha or beta, that counts as zero
NEAR = mpf(10) ** -29  # nearer starts to the unstable upright position are refused, as in heavy_top.c


class PortableHeavyTop:
    """The motion of a symmetric heavy top, computed with mpmath and NumPy.

    The arguments are those of the C function symrot_heavy_top_prepare in :file:`heavy_top.c`, which explains them and
    computes the constants of the motion. Each is a list hi, lo, hi, lo, .. of doubles, in which each sum hi + lo is one
    number. ValueError is raised if the moment about a transverse axis is not positive, or if the quaternion is zero.
    """

    @digits(DIGITS)
    def __init__(
        self, moments: list[float], pull: list[float], omega: list[float], quaternion: list[float],
        space: list[float], axes: list[float] | None,
    ) -> None:  # fmt: skip
        a, c = vector(moments)
        if a <= 0 or not any(vector(quaternion)):
            raise ValueError("expected positive moments of inertia and a quaternion that is not zero")
        force, w = number(*pull) / a, vector(omega)
        self.scale = power_of_two(max(mp.sqrt(force), *(abs(x) for x in w)))
        self.frame, self.space = Axes(axes), vector(space)
        w = [x / self.scale for x in w]
        q = unit(vector(quaternion))
        start = [mpc(q[0], q[3]), mpc(q[1], q[2])]  # alpha, beta
        pull, spin = force / self.scale**2, c / a * w[2]
        if 0 < abs(start[1]) ** 2 + w[0] ** 2 + w[1] ** 2 < NEAR**2 and spin**2 < 4 * pull:
            raise ValueError("expected a start that is not so near to the unstable upright position")
        start = [mpc(0) if abs(x) < NOTHING else x for x in start]
        self._prepare(c / a, pull, w, start)

    def _prepare(self, shape: Any, pull: Any, w: list[Any], start: list[Any]) -> None:
        alpha, beta = start
        across, spin = mpc(w[0], w[1]), shape * w[2]
        lever = 2 * mp.conj(mp.conj(alpha) * beta) * across
        s = 2 * abs(beta) ** 2  # 1 - cos theta
        momentum = lever.imag + spin * (1 - s)  # L_z
        d, sigma = momentum - spin, momentum + spin
        if not across and not (alpha and beta):
            half, upright = w[2] / 2, not beta
            self.regime, self.slopes = "steady", [0.0, 0.0]
            self.turning = [Phase.of(half / (2 * mp.pi)), Phase.of(-half / (2 * mp.pi))]
            self.steady = (1.0, 0.0) if upright else (0.0, 1.0)
            self._maps(start[0] if upright else mpc(1), mpc(1) if upright else start[1], w[2])
            return
        twice = abs(across) ** 2 - 2 * pull * s  # 2 (E - M)
        s1, s2, s3 = _roots(pull, twice, d, spin)
        m, complement = (s1 - s2) / (s1 - s3), (s2 - s3) / (s1 - s3)
        rate = mp.sqrt(pull * (s1 - s3) / 2)
        u = mpf(0)
        if m:
            sine = min(max((s1 - s) / (s1 - s2), mpf(0)), mpf(1))
            u = mp.sqrt(sine) * mp.elliprf(1 - sine, 1 - m * sine, 1)
            u = -u if lever.real > 0 else u
        k, k_prime = quarter_periods(m, complement)
        ys = [
            _zero((2 - s1) / (2 - s2), m) if m else mpf(0),
            _zero(s2 / s1 / complement, m) if m and complement else mpf(0),
        ]
        signs = [-1 if sigma > 0 else 1, -1 if d > 0 else 1]
        steady = [(w[2] - spin + (sigma / (2 - s2) if s2 < 2 else 0)) / 2, (spin - w[2] + (d / s1 if s1 else 0)) / 2]
        series = self._circular if m < SWITCH else self._hyperbolic
        numerators, kappas, leads, speed, place, below = series(m, k, k_prime, ys, signs, steady, rate, u)
        self._scale_numerators(numerators, kappas, leads, speed, place, below, start, across, w[2])

    def _circular(
        self, m: Any, k: Any, k_prime: Any, ys: list[Any], signs: list[int], steady: list[Any], rate: Any, u: Any
    ) -> Any:
        self.regime, self.slopes = "circular", [0.0, 0.0]
        per = mp.pi / k
        q = mp.exp(-per * k_prime) if m else mpf(0)
        speed = per * rate / 2  # dz/dt
        numerators, kappas = [], []
        for i, (y, sign) in enumerate(zip(ys, signs, strict=True)):
            rise = [mp.exp((2 * n + 1) * per * y / 2 - per * y / 2) if m else mpf(n == 0) for n in range(TERMS)]
            fall = [mp.exp(-(2 * n + 2) * per * y / 2) if m else mpf(0) for n in range(TERMS)]
            weights = [q ** (n * (n + 1)) for n in range(TERMS)]
            even = [x * (up + down) for x, up, down in zip(weights, rise, fall, strict=True)]
            odd = [sign * x * (up - down) for x, up, down in zip(weights, rise, fall, strict=True)]
            drift = -sum((2 * n + 1) * x for n, x in enumerate(odd)) / sum(even)
            flips = [(-1) ** n if i == 0 else 1 for n in range(TERMS)]
            numerators.append(([f * x for f, x in zip(flips, even, strict=True)],
                               [(f if i == 0 else -f) * x for f, x in zip(flips, odd, strict=True)]))  # fmt: skip
            kappas.append(steady[i] - speed * drift)
        self.turning = [Phase.of(x / (2 * mp.pi)) for x in kappas]
        self.axial = Phase.of(rate / k / 4, u / k / 4)
        z = mp.pi * u / (2 * k)
        below = [1 + 2 * sum((-1) ** n * q ** (n * n) * mp.cos(2 * n * z) for n in range(1, TERMS)),
                 -4 * sum((-1) ** n * n * q ** (n * n) * mp.sin(2 * n * z) for n in range(1, TERMS))]  # fmt: skip
        return numerators, kappas, [mpf(0), mpf(0)], speed, z, below

    def _hyperbolic(
        self, m: Any, k: Any, k_prime: Any, ys: list[Any], signs: list[int], steady: list[Any], rate: Any, u: Any
    ) -> Any:
        endless = k == mp.inf
        self.regime = "separatrix" if endless else "hyperbolic"
        per = mp.pi / k_prime
        q = mpf(0) if endless else mp.exp(-per * k)
        self.nome, self.log_nome = q, -np.inf if endless else float(-per * k)
        speed = per * rate / 2  # dv/dt
        numerators, kappas, slopes, even_parts = [], [], [], []
        for i, (y, sign) in enumerate(zip(ys, signs, strict=True)):
            chi = mp.pi * y / (2 * k_prime)
            orders = [2 * n + 1 if i == 0 else 2 * n for n in range(TERMS)]
            sines, cosines = [mp.sin(o * chi) for o in orders], [mp.cos(o * chi) for o in orders]
            if i == 0:
                re = [(-1) ** n * sign * x for n, x in enumerate(sines)]
                im = [-((-1) ** n) * x for n, x in enumerate(cosines)]
                grown = [q ** (n * n) for n in range(TERMS + 1)]  # at u = K, times 2 sqrt(nome)
                value = sum(mpc(a * (grown[n] + grown[n + 1]), b * (grown[n] - grown[n + 1]))
                            for n, (a, b) in enumerate(zip(re, im, strict=True)))  # fmt: skip
                slope = sum(orders[n] * mpc(a * (grown[n] - grown[n + 1]), b * (grown[n] + grown[n + 1]))
                            for n, (a, b) in enumerate(zip(re, im, strict=True)))  # fmt: skip
            else:
                re = [(2 if n else 1) * (-1) ** n * x for n, x in enumerate(cosines)]
                im = [sign * (2 if n else 1) * (-1) ** n * x for n, x in enumerate(sines)]
                value = sum(q ** (n * n) * x for n, x in enumerate(re))
                slope = sum(orders[n] * q ** (n * n) * mpc(0, x) for n, x in enumerate(im))
            numerators.append((re, im))
            kappas.append(steady[i] - speed * (slope / value).imag)
            slopes.append(mpf(0) if endless else -sign * y / (2 * k_prime))
            even_parts.append(mpf(0) if endless else slopes[i] * mp.pi / k * rate)
        self.turning = [Phase.of((x - e) / (2 * mp.pi)) for x, e in zip(kappas, even_parts, strict=True)]
        self.slopes = [float(x) for x in slopes]
        v = per * u / 2
        if endless:
            self.axial = Phase.of(speed, v, periodic=False)
        else:
            self.stretch, self.axial = float(per * k), Phase.of(rate / k / 4, u / k / 4)
        leads = [mpf(0) if endless else u / k / 2 * x for x in slopes]
        below = [sum(q ** (n * (n + 1)) * mp.cosh((2 * n + 1) * v) for n in range(TERMS)),
                 sum((2 * n + 1) * q ** (n * (n + 1)) * mp.sinh((2 * n + 1) * v) for n in range(TERMS))]  # fmt: skip
        return numerators, kappas, leads, speed, v, below

    def _orders(self, i: int) -> list[int]:
        """Return the multiples n of z or v in the theta series of alpha or beta: 1, 3, 5, .. or 0, 2, 4, ..

        ``i`` is 0 for alpha, 1 for beta. The arguments z and v are explained in the module's docstring.
        """
        odd = self.regime == "circular" or i == 0
        return [2 * n + odd for n in range(TERMS)]

    def _signs(self, i: int) -> tuple[int, int]:
        """Return the signs (a, b) in the derivatives f' = a n g and g' = b n f of the functions of :meth:`_functions`.

        Example: f = sin(n z) and g = cos(n z) have the derivatives n g and -n f, so the signs are (1, -1). ``i`` is 0
        for alpha, 1 for beta.
        """
        if self.regime != "circular":
            return 1, 1
        return (1, -1) if i == 0 else (-1, 1)

    def _functions(self, i: int, place: Any) -> tuple[list[Any], list[Any], list[Any], list[Any]]:
        """Return the values at ``place`` of the functions f, g, f', g' in the theta series of a Cayley-Klein parameter.

        ``i`` is 0 for alpha, 1 for beta. ``place`` is a value of z in the regime circular, otherwise of v. The series
        of the real part is a sum of multiples of the functions f, that of the imaginary part a sum of multiples of the
        functions g; f' and g' are their derivatives with respect to z or v. Each of the four is a list with one entry
        for each n of :meth:`_orders`. For alpha in the regime circular they are sin(n z), cos(n z), n cos(n z) and
        ``-n sin(n z)`` with n = 1, 3, 5, ..
        """
        orders, weights = self._orders(i), self._weights(i)
        sine, cosine = (mp.sin, mp.cos) if self.regime == "circular" else (mp.sinh, mp.cosh)
        f = [x * cosine(o * place) for x, o in zip(weights, orders, strict=True)]
        g = [x * sine(o * place) for x, o in zip(weights, orders, strict=True)]
        if self.regime == "circular" and i == 0:
            f, g = g, f
        forward, back = self._signs(i)
        return (f, g, [forward * o * x for o, x in zip(orders, g, strict=True)],
                [back * o * x for o, x in zip(orders, f, strict=True)])  # fmt: skip

    def _weights(self, i: int) -> list[Any]:
        """Return the factors of f and g in :meth:`_functions`: powers of the nome, or ones in the regime circular.

        There is one factor for each n. ``i`` is 0 for the series of alpha, 1 for that of beta.
        """
        if self.regime == "circular":
            return [mpf(1)] * TERMS
        powers = [n * (n + 1) if i == 0 else n * n for n in range(TERMS)]
        return [self.nome**x for x in powers]

    def _scale_numerators(
        self, numerators: Any, kappas: Any, leads: Any, speed: Any, place: Any, below: Any, start: Any, across: Any,
        spin: Any,
    ) -> None:  # fmt: skip
        """Set the constant factors of the theta series so that they give the initial state at the start.

        ``start`` is [alpha, beta] at the start; ``across`` is w1 + 1j*w2 and ``spin`` is w3, both at the start and in
        units of ``scale``. The other arguments are the results of :meth:`_circular` or :meth:`_hyperbolic`. Three of
        them have an entry for alpha and one for beta: ``numerators``, pairs (coefficients of f, coefficients of g) of
        the functions of :meth:`_functions`; ``kappas``, the constant rates of the phases of the factors exp(1j*phase)
        of the series; ``leads``, phases in revolutions at the start, which are subtracted. ``speed`` is the time
        derivative of z or v, ``place`` is z or v at the start, and ``below`` is the pair (value, derivative) of the
        series in the denominator at ``place``.
        """
        alpha, beta = start
        initial_rates = [
            mpc(0, spin / 2) * alpha - beta * mp.conj(across) / 2,
            alpha * across / 2 - mpc(0, spin / 2) * beta,
        ]
        inner = speed * below[1] / below[0]
        constants = []
        for i, (re, im) in enumerate(numerators):
            f, g, df, dg = self._functions(i, place)
            value = mpc(mp.fdot(re, f), mp.fdot(im, g))
            slope = mpc(mp.fdot(re, df), mp.fdot(im, dg))
            moving = slope * speed + mpc(0, kappas[i]) * value - inner * value
            # if a series is nearly zero at the start, the time derivative of its parameter determines the factor
            by_rate = abs(value) < mpf(10) ** -3 * abs(moving)
            constant = initial_rates[i] / moving if by_rate else start[i] / value
            constants.append(constant * mp.expjpi(-2 * leads[i]))
        sizes = [abs(x) for x in constants]
        total = mp.hypot(*sizes)
        self.terms, self.rate_terms = [], []
        for i, (size, (re, im)) in enumerate(zip(sizes, numerators, strict=True)):
            forward, back = self._signs(i)
            orders = [order * speed for order in self._orders(i)]
            re_rate = [forward * o * a - kappas[i] * b for o, a, b in zip(orders, re, im, strict=True)]
            im_rate = [back * o * b + kappas[i] * a for o, a, b in zip(orders, re, im, strict=True)]
            self.terms += [[float(x * size / total) for x in part] for part in (re, im)]
            self.rate_terms += [[float(x * size / total) for x in part] for part in (re_rate, im_rate)]
        units = [x / size if size else mpc(1) for x, size in zip(constants, sizes, strict=True)]
        self._maps(units[0], units[1], spin)

    def _maps(self, a: Any, b: Any, spin: Any) -> None:
        zero, back = mpf(0), conjugate(self.frame.quaternion)
        columns = [[a.real, zero, zero, a.imag], [-a.imag, zero, zero, a.real],
                   [zero, b.real, b.imag, zero], [zero, -b.imag, b.real, zero]]  # fmt: skip
        self.attitude = mapping([hamilton(hamilton(self.space, x), back) for x in columns])
        turn, rows = b * mp.conj(a), self.frame.matrix
        self.omega = np.array([[float((r[0] * turn.real + r[1] * turn.imag) * self.scale),
                                float((r[1] * turn.real - r[0] * turn.imag) * self.scale),
                                float(r[2] * spin * self.scale)] for r in rows])  # fmt: skip

    def evaluate(self, times: Floats, omega: Floats | None, quaternion: Floats | None) -> None:
        """Write the samples at ``times``, s, into ``omega`` (n, 3) and ``quaternion`` (n, 4).

        An array that is None is skipped.
        """
        t = times * float(self.scale)
        (a, b), (da, db), whole = self._values(t)
        inverse = 1.0 / ((a * a.conj()).real + (b * b.conj()).real)
        turns = [phase.circle(t, slope * whole) for phase, slope in zip(self.turning, self.slopes, strict=True)]
        turned = [cosine + 1j * sine for sine, cosine in turns]
        if omega is not None:
            across = 2.0 * (a.conj() * db - b * da.conj()) * turned[0].conj() * turned[1] * inverse
            omega[:] = np.stack([across.real, across.imag, np.ones_like(t)], axis=1) @ self.omega.T
        if quaternion is not None:
            unit_size = np.sqrt(inverse)
            a, b = a * turned[0] * unit_size, b * turned[1] * unit_size
            quaternion[:] = np.stack([a.real, a.imag, b.real, b.imag], axis=1) @ self.attitude.T

    def _values(self, t: Floats) -> tuple[Any, Any, Floats]:
        """Return ((alpha, beta), (their time derivatives), phase) at the times t.

        alpha = q0 + 1j*q3 and beta = q1 + 1j*q2 are not normalised, and lack the factors exp(1j*angle) that
        :meth:`evaluate` applies. In the regime hyperbolic, ``phase`` is the argument of the elliptic functions divided
        by 2 K, minus the nearest whole number; in the other regimes (see the module's docstring) it is 0.
        """
        none = np.zeros_like(t)
        if self.regime == "steady":
            a, b = (np.full(t.shape, x, dtype=complex) for x in self.steady)
            return (a, b), (0.0 * a, 0.0 * b), none
        if self.regime == "circular":
            sine, cosine = self.axial.circle(t)
            odd: list[Any] = multiples(sine, cosine)[1::2]
            return (*self._summed([odd, [(c, s) for s, c in odd]]), none)
        separatrix = self.regime == "separatrix"
        whole, flip, v = self.axial.argument_once(t) if separatrix else self.axial.argument(t, self.stretch)

        def term(weight: int, order: int) -> list[Any]:
            return [flip * part for part in hyperbolic(self.log_nome, weight, order, v)]

        pairs = [[term(n * (n + 1), 2 * n + 1) for n in range(TERMS)], [term(n * n, 2 * n) for n in range(TERMS)]]
        return (*self._summed(pairs), whole)

    def _summed(self, pairs: Any) -> tuple[Any, Any]:
        """Return ([alpha, beta], [their time derivatives]) at several times, by summing the theta series.

        ``pairs`` has a list for alpha and a list for beta. Each list has a pair (f, g) for each term of the series: the
        values of the functions f and g of :meth:`_functions`, arrays with one number for each time.
        """
        values, rates = [], []
        for i, functions in enumerate(pairs):
            part = slice(2 * i, 2 * i + 2)
            values.append(sum(a * f + 1j * (b * g) for a, b, (f, g) in zip(*self.terms[part], functions, strict=True)))
            rates.append(
                sum(a * g + 1j * (b * f) for a, b, (f, g) in zip(*self.rate_terms[part], functions, strict=True))
            )
        return values, rates


def _roots(pull: Any, twice: Any, d: Any, spin: Any) -> list[Any]:
    """Return the roots S1 >= S2 >= S3 of the cubic ``(twice + 2 pull s) s (2 - s) - (d + spin s)^2`` in s.

    Rounding errors are removed: S1 is at most 2, S2 at least 0, S3 at most 0, and nearly equal roots are equal.
    """
    # it is (ds/dt)^2 of a heavy top with transverse moment 1, for s = 1 - cos theta. M = pull: weight times distance of
    # the centre of mass; 2 (E - M) = twice: E is the energy without that of the spin; l = spin: the angular momentum
    # along the axis; D = d: L_z - l
    # -2M s^3 + (4M - 2(E - M) - l^2) s^2 + (4 (E - M) - 2 D l) s - D^2
    cubic = [-2 * pull, 4 * pull - twice - spin**2, 2 * twice - 2 * d * spin, -(d**2)]
    roots = sorted((mp.re(x) for x in mp.polyroots(cubic, maxsteps=400, extraprec=800)), reverse=True)
    s1, s2, s3 = roots
    s3, s2, s1 = min(s3, mpf(0)), max(s2, mpf(0)), min(s1, mpf(2))
    size = max(s1, min(-s3, mpf(2)))  # S1 and S2 are at most 2, but -S3 grows without limit as the pull vanishes
    if s1 - s2 < EQUAL * size:
        s2 = s1
    if s2 - s3 < EQUAL * size:
        s2 = s3 = mpf(0)
    return [s1, s2, s3]


def _zero(square: Any, m: Any) -> Any:
    """Return the argument y at which sn(y)^2 = ``square``, for the elliptic function sn of parameter 1 - m."""
    square = min(max(square, mpf(0)), mpf(1))
    return mp.sqrt(square) * mp.elliprf(1 - square, 1 - (1 - m) * square, 1)
