"""Bounds of the errors of an exact step of a free body on a box of states, from its C text.

An exact step computes the closed form of the motion, with elliptic functions. Its C text runs on numbers with bounds of
their errors (bounded_number.py), for one part of the box after another. In a part no component of omega changes its
sign; the phase of the elliptic functions takes 64 equal ranges in turn.
Nearly all of the error comes from single operations on doubles, and each of them adds its rounding error. Operations on
sums of two doubles add the relative errors that functions.py states. Some intervals are cut to the known range of the
exact value, such as 0 <= m <= 1 for the modulus m.

Bounds exist where the modulus m is below 0.7, that is not near the rotation about the middle axis. There the series
in the nome q are cut after q^15, which makes an error below 40 q^16 in the elliptic functions.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from math import exp, inf, pi, sqrt
from typing import Any

from symrot.certificates.c_machine.machine import Machine
from symrot.certificates.c_machine.values import Place, called
from symrot.certificates.exact_step.bounded_number import DOUBLE, PAIR, Bounded, UndecidedError, point
from symrot.certificates.exact_step.box import MIDDLE, Box, halves, power_near, shells, signed_parts
from symrot.certificates.exact_step.functions import (
    ELLIPTIC,
    SLACK,
    SMALL,
    agm,
    carlson_rf,
    exponential,
    mean_of,
    pair,
    pair_total,
    sine_and_cosine,
    unit_quaternion,
    widened,
    with_pairs,
)
from symrot.errors import CertificateError, InputError

__all__ = ["free_body_bounds"]

CELLS = 64  # parts of the phase of a period
MOST_PARTS = 600  # of the box of omega, with the parts that were divided
LONGEST = 2.0**20  # revolutions, in one step, of an angle of the motion, such as the phase of the elliptic functions
SIZES = 1e298  # largest dt*(scale of omega) whose rounding error the C text computes without overflow
SMALL_MODULUS = 0.7


class _Context:
    """The C code for exact steps of a free body, interpreted in Python with :class:`Bounded` numbers as its doubles.

    ``prepare`` computes the constants of all motions whose initial states lie in given ranges, and ``after`` their
    states after a step.
    """

    def __init__(self, source: str, prefix: str) -> None:
        self.scale = 1.0  # the power of two by which omega is divided
        self.phase = (0.0, 1.0)  # range of the phase of the elliptic functions, in revolutions
        self.nome = 1.0
        self.series_error = 0.0
        self.motion: list[Any] = []
        self.prefix = prefix
        changes = {
            # components of the angular momentum are at most its length
            "signs[n]*dd_div(c.amplitudes[n], c.total).hi": "signs[n]*known_sine(dd_div(c.amplitudes[n], c.total)).hi",
            "GROUP = 8": "GROUP = 1",  # samples are independent of each other
            "static void canonical(const dd inertia[3],": "static void canonical_plain(const dd inertia[3],",
            # terms of series that the C text omits, because they are below 2^-110, are computed
            "#define NEGLIGIBLE 0x1p-110": "#define NEGLIGIBLE (-1.0)",
            "/* The quaternion of the change from": "static dd known_nome(dd x);\nstatic dd known_positive(dd x);\n"
            "static dd known_sine(dd x);\n/* The quaternion of the change from",
            "dd_scale(dd_div(L[1], c->amplitudes[1]), c->s)": "dd_scale(known_sine(dd_div(L[1], c->amplitudes[1])), "
            "c->s)",
            "const dd nome = dd_mul(shift, close);": "const dd nome = known_nome(dd_mul(shift, close));",
            "dd_mul(per, dd_sub(k_prime, c->eta))": "dd_mul(per, known_positive(dd_sub(k_prime, c->eta)))",
        }
        for old, new in changes.items():
            if source.count(old) != 1:
                raise CertificateError(f"expected {old!r} once in the C text of a free body, got another text")
            source = source.replace(old, new)
        self.machine = Machine(source, lambda value: point(float(value)), self._own())
        self.fields = self.machine.structs["free_body"].names

    def _own(self) -> dict[str, tuple[str, Callable[..., Any]]]:
        pairs: dict[str, tuple[str, Callable[..., Any]]] = {
            "dd_of": ("s", lambda x: [Bounded(x.low, x.high, x.error, x.relative, x), point(0.0)]),
            "dd_pair": ("s", self._dd_pair),
            "dd_negative": ("s", with_pairs(lambda x: -x)),
            "dd_abs": ("s", with_pairs(abs)),
            "dd_add": ("s", with_pairs(lambda x, y: x.plus(y, PAIR))),
            "dd_sub": ("s", with_pairs(lambda x, y: x.plus(-y, PAIR))),
            "dd_mul": ("s", with_pairs(lambda x, y: x.times(y, PAIR))),
            "dd_square": ("s", with_pairs(lambda x: abs(x).times(abs(x), PAIR))),
            "dd_div": ("s", with_pairs(lambda x, y: x.over(y, PAIR))),
            "dd_sqrt": ("s", with_pairs(lambda x: x.root(PAIR))),
            "dd_scale": ("s", lambda a, power: pair(pair_total(a).times(power, PAIR))),
            "dd_agm": ("s", with_pairs(agm)),
            "dd_rf": ("s", with_pairs(carlson_rf)),
            "dd_exp": ("s", with_pairs(exponential)),
            "known_nome": ("s", with_pairs(lambda x: x.clipped(0.0, self.nome))),
            "known_positive": ("s", with_pairs(lambda x: x.clipped(0.0, inf))),
            "known_sine": ("s", with_pairs(lambda x: x.clipped(-1.0, 1.0))),
        }
        return pairs | {
            "fabs": ("rr", abs), "sqrt": ("rr", lambda x: x.root(DOUBLE)), "rint": ("rr", _nearest),
            "dd_less": ("", lambda a, b: int(pair_total(a) < pair_total(b))), "dd_sound": ("", lambda: 1),
            "near_power": ("", self._near_power), "exact_defect": ("", _exact_defect), "normalise": ("", _normalise),
            "quaternion_product": ("", _quaternion_product), "dd_sincos_turns": ("", _sincos),
            "canonical": ("vppppp", self._canonical), "put_quaternion": ("", _put_quaternion), "turn": ("", self._turn),
            "exp_moderate": ("", _refused), "memcpy": ("vppi", _refused),
        }  # fmt: skip

    @staticmethod
    def _dd_pair(high: Bounded, low: Any) -> list[Any]:
        if low is None or not (low.is_exact and low.low == 0):
            return [high, low]
        return [Bounded(high.low, high.high, high.error, high.relative, high), low]

    def _near_power(self, values: Place, count: int) -> Bounded:
        container, start = values
        numbers = [container[start + 2 * i] for i in range(count)]
        if count == 4:  # a quaternion, which is divided by its norm
            return point(1.0)
        if all(each.is_exact for each in numbers):
            return point(power_near(max(each.most for each in numbers)))
        return point(self.scale)

    def _canonical(self, inertia: Place, omega: Place, differences: Place, defect: Any, c: Place) -> None:
        machine = self.machine
        called(machine.functions["canonical_plain"], (inertia, omega, differences, defect, c))
        fields, names = c[0][c[1]], machine.structs["canonical_motion"].names

        def clip(name: str, low: float, high: float) -> Bounded:
            place = names.index(name)
            value = pair_total(fields[place]).clipped(low, high)
            fields[place] = pair(value)
            return value

        modulus = clip("modulus", 0.0, 1.0)
        complement = clip("complement", 0.0, 1.0)
        clip("eta", 0.0, inf)
        if not modulus < point(SMALL_MODULUS):
            raise UndecidedError
        # m + m' = 1, and |u| <= K
        most = min(modulus.high, 1 - complement.low, SMALL_MODULUS)
        clip("complement", 1 - most - 1e-15, 1.0)
        quarter = pi / 2 / mean_of(sqrt(1 - most)) * (1 + SLACK)
        clip("u", -quarter, quarter)
        self.nome = exp(-pi * mean_of(sqrt(1 - most)) / mean_of(sqrt(max(most, 1e-300)))) * (1 + 1e-9) + 1e-300

    def _turn(
        self, phase: Place, slope: Bounded, count: int, t: Place, whole: Place, sine: Place, cosine: Place
    ) -> None:
        """Store sine and cosine of ``rate*t + start`` with error bounds; this method replaces the C function ``turn``.

        ``phase`` points to rate and start, each a sum of two doubles, in revolutions. ``t`` points to one interval, the
        times of all samples in units of the time scale (the C text multiplies seconds by a power of two near |omega|).
        All ``count`` samples get the same sine and cosine, those of this interval. The C function also adds
        ``slope*whole[i]`` revolutions to the phase of sample i. It needs them only for motions near the separatrix; for
        a modulus below 0.7 the C text passes the slope 0. So ``whole`` is ignored here. InputError is raised for
        another slope, for more than ``LONGEST`` revolutions, and for times above ``SIZES``.
        """
        values, first = phase
        rate, start = pair_total([values[first], values[first + 1]]), pair_total([values[first + 2], values[first + 3]])
        size = t[0][t[1]]
        turns = rate.most * size.most
        if not (slope.is_exact and slope.low == 0 and turns <= LONGEST):
            raise InputError(
                f"expected a range of dt in which each angle of the motion, such as the precession, grows by at most "
                f"{LONGEST:.0f} revolutions, got {turns:.3g} revolutions; lower the upper end of the range of dt"
            )
        if not size.most <= SIZES:
            raise InputError(f"expected dt times |omega| of at most {SIZES}, got {size.most:.3g}")
        # the error of the phase: of its rate and start, and of the roundings in `phase_rest`. Where `small` moves the
        # phase beyond 1/8, one more, 2^-56, makes 3*2^-57; sine and cosine, with slopes of 0.708, have 0.1327*2^-53
        error = (
            size.most * rate.error
            + turns * 2.0**-104
            + start.error
            + DOUBLE * (0.1327 + 4 * (turns * 2.0**-52 + 2.0**-54))
        )
        # of the polynomials in `sincos_quarters`: rounding, coefficients and the rest of the series
        both = 2 * pi * error * (1 + SLACK) + self.series_error
        cell = self.phase if values is self.motion[self.fields.index("axial")] else (0.0, 1.0)
        s, c = sine_and_cosine(Bounded(*cell, 0.0, 0.0), both)
        for i in range(count):
            sine[0][sine[1] + i], cosine[0][cosine[1] + i] = s, c

    # --- runs ---------------------------------------------------------------------------------------------------------

    def prepare(self, moments: list[float], omega: list[Bounded]) -> None:
        """Compute the constants of all motions whose initial angular velocity is in given ranges.

        ``omega`` has the ranges of its three components; the initial quaternion is any unit quaternion. The constants
        are stored in ``self.motion``. InputError is raised if the C code rejects the states, UndecidedError if the
        ranges must be divided into smaller ones.
        """
        motion = [self.machine.blank("free_body")]
        zero = point(0.0)
        arguments = (
            ([x for m in moments for x in (point(m), zero)], 0), ([x for w in omega for x in (w, zero)], 0),
            ([x for _ in range(4) for x in (Bounded(-1.0, 1.0, 0.0, 0.0), zero)], 0), None, None, (motion, 0),
        )  # fmt: skip
        if self.machine.call(f"{self.prefix}_prepare", *arguments):
            raise InputError(
                "expected moments of inertia above 0 and |omega| up to 1e308, got values that the C text of the step "
                "rejects"
            )
        self.motion = motion[0]

    def after(self, size: Bounded) -> list[Bounded]:
        """Return the state after a step of ``size`` seconds: omega, then the quaternion, with error bounds.

        The bounds hold if the phase of the elliptic functions after the step is in the range ``self.phase``.
        """
        result: list[Any] = [point(0.0)] * 7
        self.machine.call(f"{self.prefix}_at", ([self.motion], 0), 1, ([size], 0), (result, 0), (result, 3))
        return result

    @property
    def is_steady(self) -> bool:
        return int(self.motion[self.fields.index("regime")]) == self.machine.constants["STEADY"]


def _refused(*arguments: Any) -> Any:
    raise UndecidedError


def _nearest(x: Bounded) -> Bounded:
    low, high = x.computed
    if not -0.49 < low <= high < 0.49:
        raise UndecidedError
    return point(0.0)


def _pairs_at(place: Place, count: int) -> list[Bounded]:
    return [pair_total(place[0][place[1] + i]) for i in range(count)]


def _exact_defect(moments: Place, omega: Place) -> list[Any]:
    """Return |L|^2 - 2 T I_mid as a sum of two doubles; it replaces the C function ``exact_defect``.

    L is the angular momentum, T the kinetic energy, I_mid the middle moment. The C function sums exactly and rounds
    once, so the result has the relative error of one operation, ``PAIR`` = 2^-102. ``moments`` and ``omega`` point to
    three sums of two doubles each. UndecidedError is raised if a product may underflow.
    """
    inertia, velocities = _pairs_at(moments, 3), _pairs_at(omega, 3)
    middle = sorted(range(3), key=lambda i: inertia[i].low)[1]
    total = point(0.0)
    for i in range(3):
        if i != middle:
            share = Fraction(inertia[i].low) * (Fraction(inertia[i].low) - Fraction(inertia[middle].low))
            sizes = velocities[i].least, velocities[i].most
            ends = sorted(float(share) * x * x for x in sizes)
            if share and any(x and abs(end) < SMALL for x in sizes for end in ends):
                raise UndecidedError  # the product may underflow
            total = total.plus(Bounded(*widened(*ends), 0.0, 0.0), 0.0)
    return pair(Bounded(total.low, total.high, inf, PAIR))


def _normalise(q: Place) -> None:
    for i, x in enumerate(unit_quaternion(_pairs_at(q, 4))):
        q[0][q[1] + i] = pair(x)


def _quaternion_product(a: Place, b: Place, c: Place) -> None:
    """Store at ``c`` the product of the quaternions at ``a`` and ``b``, with bounds of its errors.

    Each of the two has norm 1, or is 0: the C text has the quaternion 0 in place of the axis of rotation of a body at
    rest.
    """
    left, right = _pairs_at(a, 4), _pairs_at(b, 4)
    error = 4 * (max(x.error for x in left) + max(x.error for x in right)) + 64 * PAIR
    for i in range(4):
        c[0][c[1] + i] = pair(Bounded(-1.0, 1.0, error, inf))


def _put_quaternion(rows: Place, count: int, *columns: Any) -> None:
    """Store ``count`` quaternions, each an orthogonal 4x4 matrix times a unit vector, with bounds of their errors.

    ``rows`` points to the matrix; ``columns`` are four arrays with the vectors' components, then the array for the
    results. The matrix does not change the length of the vector's error. The rows have length 1, so the roundings of
    the matrix, the four products and the three sums add at most 5.1*2^-53.
    """
    *vector, q = columns
    before = 2 * max((x.pair or x).error for row in rows[0] for x in row)  # of the matrix, before it was rounded
    for i in range(count):
        error = sqrt(sum(each[0][each[1] + i].error ** 2 for each in vector)) + 5.1 * DOUBLE + before
        for k in range(4):
            q[0][q[1] + 4 * i + k] = Bounded(-1.0, 1.0, error, inf)


def _sincos(turns: list[Any], sine: Place, cosine: Place) -> None:
    value = pair_total(turns)
    s, c = sine_and_cosine(value, 2 * pi * value.error * (1 + SLACK) + ELLIPTIC)
    sine[0][sine[1]], cosine[0][cosine[1]] = pair(s), pair(c)


def _series_error(machine: Machine) -> float:
    """Return a bound of the error of a sine or cosine that the C function ``sincos_quarters`` computes.

    It holds for phases of at most 1/8 revolution; the error that a wrong phase causes is not included.
    """
    results: list[Any] = [None, None]
    machine.call("sincos_quarters", Bounded(-0.1251, 0.1251, 0.0, 0.0), point(0.0), (results, 0), (results, 1))
    rounding = max(each.error for each in results)
    # of a polynomial whose coefficients are the doubles nearest to those of the series, after r^17 and r^16
    angle = 2 * pi * 0.1251
    coefficients = 2.0**-53 * exp(angle)
    return float(rounding + coefficients + angle**18 / 6.4e15) * (1 + SLACK)


def free_body_bounds(source: str, name: str, moments: list[float], box: Box) -> tuple[list[float], list[float]]:
    """Return (rounding, truncation): bounds of the errors of an exact step of a free body.

    An exact step computes the closed form of the motion; its truncation error is that of the series in the C text. Each
    of the two is a list of seven bounds: of omega_1 to omega_3, then of q0 to q3. The last 16 results are cached.

    Parameters
    ----------
    source : str
        The C text of the step.
    name : str
        The start of the names of its C functions, ``NAME_prepare`` and ``NAME_at``.
    moments : list of float
        The principal moments, in kg m^2.
    box : mapping
        Ranges of omega_1, omega_2, omega_3 and dt.

    Raises
    ------
    InputError
        If no bounds are known: near a rotation about the middle axis, for omega whose size varies by a factor above
        about 2^8, for steps of more than ``LONGEST`` revolutions, or for ranges that are too wide.
    CertificateError
        If the C text is no exact step of a free body.
    """
    rounding, truncation = _bounds(source, name, tuple(moments), tuple(box.items()))
    return list(rounding), list(truncation)


@lru_cache(maxsize=16)
def _bounds(
    source: str, name: str, moments: tuple[float, ...], ranges: tuple[tuple[str, tuple[Fraction, Fraction]], ...]
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    box = dict(ranges)
    context = _Context(source, name)
    context.series_error = _series_error(context.machine)
    low, high = (float(end) for end in box["dt"])
    size = Bounded(low, high, 0.0, 0.0)
    rounding, truncation = [0.0] * 7, [0.0] * 7
    parts = [(scale, each) for part in signed_parts(box) for scale, each in shells(part)]
    count = 0
    while parts:
        scale, part = parts.pop()
        count += 1
        if count > MOST_PARTS:
            raise InputError(
                f"{MIDDLE}, got ranges on which symrot finds no bound of the step's errors, although it divided them "
                f"into {MOST_PARTS} parts; write narrower ranges, or take --step taylor --order 16"
            )
        context.scale = scale
        try:
            context.prepare(list(moments), [point(a) if a == b else Bounded(a, b, 0.0, 0.0) for a, b in part])
            cells = 1 if context.is_steady else CELLS
            for k in range(cells):
                context.phase = (k / cells, (k + 1) / cells)
                errors = context.after(size)
                rounding = [max(a, b.error) for a, b in zip(rounding, errors, strict=True)]
                cut = 0.0 if context.is_steady else 40 * context.nome**16
                sizes = [b.most for b in errors[:3]] + [2.0] * 4
                truncation = [max(a, cut * b + 2.0**-100 * b) for a, b in zip(truncation, sizes, strict=True)]
        except UndecidedError:
            parts += [(scale, half) for half in halves(part)]
    if not all(x < inf for x in rounding):
        raise InputError(
            "expected ranges of omega and dt on which symrot finds a finite bound of the step's errors, got ranges on "
            "which it finds none; write narrower ranges"
        )
    return tuple(rounding), tuple(truncation)
