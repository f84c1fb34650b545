"""The oracle of the corpus of formulas: every entry's `check`, evaluated with numbers.

A `check` is a Python expression that says with NumPy what the entry's formula says: one side is the formula as printed, the other side is computed from
the definition of the quantity (a sum over particles, an integral over a solid, a difference quotient of a rotation matrix). Names that this file does
not define receive random numbers between 0.4 and 1.2. A correct entry must hold at every draw, a faulty one must fail at every draw. Nothing here is
taken from symrot, so that an error of symrot cannot hide.

Run `python tests/campaigns/checker/corpus/verify.py` to list the entries whose check disagrees with their label.
"""

import functools
import itertools
import pathlib
import random
import sys
import tomllib
from types import CodeType

import numpy as np
from scipy.linalg import expm

FOLDER = pathlib.Path(__file__).resolve().parent
CORRECT = ("true", "conditional", "recognised", "definition")
FAULTY = ("doubtful", "false")
DRAWS = 3
RELATIVE = 1e-6


def close(*sides):
    """Return whether all arguments agree: numbers, vectors or matrices."""
    arrays = [np.asarray(side, dtype=complex) for side in sides]
    first = arrays[0]
    return all(
        other.shape == first.shape and bool(np.all(abs(other - first) <= RELATIVE * (1 + abs(first))))
        for other in arrays[1:]
    )


# Rotations: active matrices, the columns are the rotated axes.


def skew(v):
    """Return the matrix of the cross product with v."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]], dtype=float)


def rot(axis, angle):
    """Return the rotation about a unit axis, as a matrix exponential."""
    return expm(skew(np.asarray(axis, dtype=float)) * angle)


EX, EY, EZ = np.eye(3)
AXES = {"X": EX, "Y": EY, "Z": EZ}


def elementary(letter, angle):
    """Return the rotation about one coordinate axis, column by column."""
    k = "XYZ".index(letter)
    i, j = (k + 1) % 3, (k + 2) % 3
    matrix = np.zeros((3, 3))
    matrix[k, k] = 1
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[j, i], matrix[i, j] = np.sin(angle), -np.sin(angle)
    return matrix


def Rx(angle):
    """Return the rotation about x."""
    return elementary("X", angle)


def Ry(angle):
    """Return the rotation about y."""
    return elementary("Y", angle)


def Rz(angle):
    """Return the rotation about z."""
    return elementary("Z", angle)


def euler(sequence, *angles):
    """Return the matrix from body to space of an intrinsic sequence."""
    matrix = np.eye(3)
    for letter, angle in zip(sequence, angles, strict=True):
        matrix = matrix @ elementary(letter, angle)
    return matrix


def unit(*v):
    """Return the unit vector along v."""
    v = np.array(v[0] if len(v) == 1 else v, dtype=float)
    return v / np.linalg.norm(v)


def vee(matrix):
    """Return the vector of the skew part of a matrix."""
    skewed = (matrix - matrix.T) / 2
    return np.array([skewed[2, 1], skewed[0, 2], skewed[1, 0]])


def diff(function, at=0.0, h=1e-4):
    """Return the derivative of a function of one number (fourth order)."""

    def central(step):
        return (np.asarray(function(at + step)) - np.asarray(function(at - step))) / (2 * step)

    return (4 * central(h) - central(2 * h)) / 3


def grad(function, at):
    """Return the gradient of a function of several numbers."""
    at = np.asarray(at, dtype=float)
    return np.array([diff(lambda s, e=e: function(at + s * e)) for e in np.eye(len(at))])


def wb(sequence, angles, rates):
    """Return the angular velocity in the body frame by differentiating the matrix."""
    angles, rates = np.asarray(angles), np.asarray(rates)
    path = lambda t: euler(sequence, *(angles + t * rates))  # noqa: E731
    return vee(path(0).T @ diff(path))


def ws(sequence, angles, rates):
    """Return the angular velocity in the space frame by differentiating the matrix."""
    return euler(sequence, *angles) @ wb(sequence, angles, rates)


def solved(sequence, angles, omega, frame="b"):
    """Return the angle rates that give an angular velocity."""
    columns = [(wb if frame == "b" else ws)(sequence, angles, e) for e in np.eye(3)]
    return np.linalg.solve(np.array(columns).T, np.asarray(omega))


# Every usual reading of a formula for one component of the angular velocity, or for one rate: all sequences, both frames, all names and signs of angles.

SEQUENCES = [a + b + c for a in "XYZ" for b in "XYZ" for c in "XYZ" if a != b != c]
POINTS = [((0.61, 0.83, 1.07), (0.47, 1.13, 0.71)), ((0.93, 0.52, 0.68), (1.17, 0.58, 0.79))]


def _columns(sequence, angles, frame):
    first, second, third = (AXES[letter] for letter in sequence)
    one, two = elementary(sequence[0], angles[0]), elementary(sequence[1], angles[1])
    in_space = np.array([first, one @ second, one @ two @ third]).T
    return in_space if frame == "s" else (one @ two @ elementary(sequence[2], angles[2])).T @ in_space


@functools.cache
def _readings(inverse):
    rows = []
    for sequence, frame in itertools.product(SEQUENCES, "bs"):
        for order, signs in itertools.product(itertools.permutations(range(3)), itertools.product((1, -1), repeat=3)):
            values = []
            for angles, rates in POINTS:
                flipped = np.array(signs)
                place = np.array(angles)[list(order)] * flipped
                columns = _columns(sequence, place, frame)
                if inverse:
                    values.append(np.linalg.solve(columns, np.array(rates)) * flipped)
                else:
                    values.append(columns @ (np.array(rates)[list(order)] * flipped))
            rows.extend(np.array(values).T)
    return np.array(rows)


def _among(values, table):
    """Return whether a row of the table has these values, all with the same sign or all with the opposite sign."""
    return any(bool(np.any(np.all(abs(table - sign * values) < 1e-9, axis=1))) for sign in (1, -1))


def rate_like(formula):
    """Return whether a formula of (phi, theta, psi, dphi, dtheta, dpsi) is a component of omega in any usual reading."""
    table = _readings(inverse=False)
    values = np.array([formula(*angles, *rates) for angles, rates in POINTS])
    return bool(
        np.any(
            np.all(abs(abs(table) - abs(values)) < 1e-9, axis=1)
            & (np.ptp(np.sign(table) * np.sign(values), axis=1) == 0)
        )
    )


def solved_like(formula):
    """Return whether a formula of (phi, theta, psi, p, q, r) is the rate of one angle in any usual reading."""
    table = _readings(inverse=True)
    values = np.array([formula(*angles, *rates) for angles, rates in POINTS])
    return bool(
        np.any(
            np.all(abs(abs(table) - abs(values)) < 1e-9, axis=1)
            & (np.ptp(np.sign(table) * np.sign(values), axis=1) == 0)
        )
    )


def rotation(matrix):
    """Return whether a matrix is a rotation."""
    matrix = np.asarray(matrix, dtype=float)
    return close(matrix @ matrix.T, np.eye(3)) and close(np.linalg.det(matrix), 1)


# Quaternions: scalar first, Hamilton's product from its table i*j = k.


def qm(a, b):
    """Return the product of two quaternions as 2 by 2 complex matrices multiply."""

    def matrix(q):
        return np.array([[q[0] + 1j * q[3], q[2] + 1j * q[1]], [-q[2] + 1j * q[1], q[0] - 1j * q[3]]])

    # with these matrices i = sigma_x i, j = sigma_y i, k = sigma_z i the product is in the reversed order
    product = matrix(b) @ matrix(a)
    return np.array([product[0, 0].real, product[0, 1].imag, product[0, 1].real, product[0, 0].imag])


def qc(q):
    """Return the conjugate of a quaternion."""
    return np.array([q[0], -q[1], -q[2], -q[3]])


def qmatrix(q):
    """Return the matrix of v -> q v q*, column by column."""
    return np.array([qm(qm(q, np.concatenate(([0], e))), qc(q))[1:] for e in np.eye(3)]).T


def qaxis(axis, angle):
    """Return the unit quaternion of a rotation about a unit axis."""
    return np.concatenate(([np.cos(angle / 2)], np.sin(angle / 2) * np.asarray(axis)))


def qeuler(sequence, *angles):
    """Return the unit quaternion of an intrinsic sequence."""
    q = np.array([1.0, 0, 0, 0])
    for letter, angle in zip(sequence, angles, strict=True):
        q = qm(q, qaxis(AXES[letter], angle))
    return q


def qrate(q, omega, frame="b"):
    """Return the rate of a unit quaternion whose matrix rotates with omega, computed from a small rotation."""

    def path(t):
        step = qaxis(unit(omega), np.linalg.norm(omega) * t)
        return qm(q, step) if frame == "b" else qm(step, q)

    return diff(path)


# Solids: integrals by Gauss's rule over a map from the unit interval, square or cube.

_nodes, _weights = np.polynomial.legendre.leggauss(16)
NODES, WEIGHTS = (_nodes + 1) / 2, _weights / 2


def sample(dimension, place):
    """Return points and weights of a wire, shell or solid given by its map."""
    grids = np.meshgrid(*[NODES] * dimension, indexing="ij")
    weight = np.ones_like(grids[0])
    for grid in np.meshgrid(*[WEIGHTS] * dimension, indexing="ij"):
        weight = weight * grid

    def points(*where):
        return np.array([x + 0 * where[0] for x in place(*where)], dtype=float)

    h = 1e-5
    tangents = []
    for k in range(dimension):
        up, down = list(grids), list(grids)
        up[k], down[k] = grids[k] + h, grids[k] - h
        tangents.append((points(*up) - points(*down)) / (2 * h))
    if dimension == 1:
        size = np.sqrt((tangents[0] ** 2).sum(axis=0))
    elif dimension == 2:
        size = np.sqrt((np.cross(tangents[0], tangents[1], axis=0) ** 2).sum(axis=0))
    else:
        size = abs((np.cross(tangents[0], tangents[1], axis=0) * tangents[2]).sum(axis=0))
    return points(*grids).reshape(3, -1), (weight * size).ravel()


def inertia(dimension, place, m, about=(0, 0, 0)):
    """Return the inertia matrix of a uniform wire, shell or solid of mass m about a point."""
    points, weight = sample(dimension, place)
    points = points - np.array(about, dtype=float)[:, None]
    mass = m * weight / weight.sum()
    second = (points * mass) @ points.T
    return np.trace(second) * np.eye(3) - second


def centre(dimension, place):
    """Return the centre of mass of a uniform wire, shell or solid."""
    points, weight = sample(dimension, place)
    return points @ weight / weight.sum()


def amount(dimension, place):
    """Return the length, area or volume of a wire, shell or solid."""
    return sample(dimension, place)[1].sum()


TAU = 2 * np.pi


def box(a, b, c):
    """Return the map of a box about its centre."""
    return lambda u, v, w: (a * (u - 0.5), b * (v - 0.5), c * (w - 0.5))


def cylinder(R, h, inner=0.0, low=-0.5):
    """Return the map of a cylinder or tube along z."""
    return lambda u, v, w: (
        (inner + (R - inner) * u) * np.cos(TAU * v),
        (inner + (R - inner) * u) * np.sin(TAU * v),
        h * (w + low),
    )


def ellipsoid(a, b, c, inner=0.0, top=-1.0):
    """Return the map of an ellipsoid (top = 0: the upper half)."""

    def place(u, v, w):
        s, polar = inner + (1 - inner) * u, np.arccos(top) * w
        return a * s * np.sin(polar) * np.cos(TAU * v), b * s * np.sin(polar) * np.sin(TAU * v), c * s * np.cos(polar)

    return place


def sphere_shell(R, top=-1.0):
    """Return the map of a spherical shell (top = 0: the upper half)."""
    end = np.arccos(top)
    return lambda u, v: (
        R * np.sin(end * u) * np.cos(TAU * v),
        R * np.sin(end * u) * np.sin(TAU * v),
        R * np.cos(end * u),
    )


def cone(R, h):
    """Return the map of a cone with its tip at the origin and its axis along z."""
    return lambda u, v, w: (R * w * u * np.cos(TAU * v), R * w * u * np.sin(TAU * v), h * w)


def cone_shell(R, h):
    """Return the map of the lateral surface of a cone with its tip at the origin."""
    return lambda v, w: (R * w * np.cos(TAU * v), R * w * np.sin(TAU * v), h * w)


def torus(R, a):
    """Return the map of a solid ring: R to the centre of the tube, a the radius of the tube."""

    def place(u, v, w):
        r = R + a * u * np.cos(TAU * w)
        return r * np.cos(TAU * v), r * np.sin(TAU * v), a * u * np.sin(TAU * w)

    return place


def torus_shell(R, a):
    """Return the map of the surface of a ring."""
    return lambda v, w: (
        (R + a * np.cos(TAU * w)) * np.cos(TAU * v),
        (R + a * np.cos(TAU * w)) * np.sin(TAU * v),
        a * np.sin(TAU * w),
    )


def disk(R, inner=0.0):
    """Return the map of a disk or washer in the plane of x and y."""
    return lambda u, v: (
        (inner + (R - inner) * u) * np.cos(TAU * v),
        (inner + (R - inner) * u) * np.sin(TAU * v),
        0 * u,
    )


def hoop(R, part=TAU, start=0.0):
    """Return the map of a ring or arc in the plane of x and y."""
    return lambda u: (R * np.cos(start + part * u), R * np.sin(start + part * u), 0 * u)


def tube_shell(R, h):
    """Return the map of a cylindrical surface without ends along z."""
    return lambda v, w: (R * np.cos(TAU * v), R * np.sin(TAU * v), h * (w - 0.5))


def plate(a, b):
    """Return the map of a rectangular plate about its centre."""
    return lambda u, v: (a * (u - 0.5), b * (v - 0.5), 0 * u)


def triangle(p, q, r):
    """Return the map of a triangular plate."""
    p, q, r = (np.array([*x, 0.0]) for x in (p, q, r))
    return lambda u, v: [p[k] + u * (q[k] - p[k]) + u * v * (r[k] - q[k]) for k in range(3)]


def rod(length, low=-0.5):
    """Return the map of a thin rod along x."""
    return lambda u: (length * (u + low), 0 * u, 0 * u)


# Rigid bodies as sums over particles.


class Cloud:
    """Particles with masses and places that move as one rigid body."""

    def __init__(self, masses, places):
        """Store the masses and an array of places, one row per particle."""
        self.masses, self.places = np.array(masses, dtype=float), np.array(places, dtype=float)

    @property
    def inertia(self):
        """The inertia matrix about the origin, entry by entry."""
        x, y, z = self.places.T
        s = lambda f: (self.masses * f).sum()  # noqa: E731
        return np.array(
            [
                [s(y * y + z * z), -s(x * y), -s(x * z)],
                [-s(x * y), s(x * x + z * z), -s(y * z)],
                [-s(x * z), -s(y * z), s(x * x + y * y)],
            ]
        )

    def energy(self, omega, v=(0, 0, 0)):
        """Return the kinetic energy."""
        return (
            sum(
                m * np.sum((np.array(v) + np.cross(omega, r)) ** 2)
                for m, r in zip(self.masses, self.places, strict=True)
            )
            / 2
        )

    def momentum(self, omega, v=(0, 0, 0)):
        """Return the angular momentum about the origin."""
        return sum(
            m * np.cross(r, np.array(v) + np.cross(omega, r)) for m, r in zip(self.masses, self.places, strict=True)
        )

    def torque(self, omega, alpha):
        """Return the torque about the origin that the accelerations need."""
        pairs = zip(self.masses, self.places, strict=True)
        return sum(m * np.cross(r, np.cross(alpha, r) + np.cross(omega, np.cross(omega, r))) for m, r in pairs)


def body(I1, I2, I3):
    """Return particles on the axes with given principal moments (masses may be negative: sums are linear in them)."""
    quarter = (I1 + I2 + I3) / 4
    return Cloud(
        np.repeat([quarter - I1 / 2, quarter - I2 / 2, quarter - I3 / 2], 2), np.kron(np.eye(3), [[1], [-1]]) * 1.0
    )


def cloud():
    """Return five fixed particles in general position."""
    return Cloud(
        [1.1, 0.7, 1.6, 0.4, 0.9],
        [[0.3, -0.5, 0.8], [1.2, 0.4, -0.3], [-0.6, 0.9, 0.2], [0.1, -1.1, -0.7], [-0.4, 0.3, 1.3]],
    )


def arr(*values):
    """Return a vector."""
    return np.array(values, dtype=float)


def mat(*rows):
    """Return a matrix."""
    return np.array(rows, dtype=float)


def top_euler(I1, I3, angles, rates):
    """Return T of a symmetric body from its rates by ZXZ angles, as a sum over particles."""
    return body(I1, I1, I3).energy(wb("ZXZ", angles, rates))


def steady(I1, I3, theta, precession, spin):
    """Return the torque about the line of nodes for steady precession at constant theta with a relative spin rate."""
    at = lambda t: (precession * t, theta, spin * t)  # noqa: E731
    omega = lambda t: wb("ZXZ", at(t), (precession, 0, spin))  # noqa: E731
    return body(I1, I1, I3).torque(omega(0.0), diff(omega, 0.0, 1e-3))[0]


def asym(I1, I2, I3, omega):
    """Return the angular acceleration of a free body from the balance of accelerations of its particles."""
    particles = body(I1, I2, I3)
    bias = particles.torque(omega, np.zeros(3))
    columns = [particles.torque(np.zeros(3), e) for e in np.eye(3)]
    return np.linalg.solve(np.array(columns).T, -bias)


sin, cos, tan, sqrt, exp, pi = np.sin, np.cos, np.tan, np.sqrt, np.exp, np.pi
asin, acos, atan, atan2, sinh, cosh, tanh = np.arcsin, np.arccos, np.arctan, np.arctan2, np.sinh, np.cosh, np.tanh
dot, cross, norm, det, trace, inv, outer, eye = (
    np.dot,
    np.cross,
    np.linalg.norm,
    np.linalg.det,
    np.trace,
    np.linalg.inv,
    np.outer,
    np.eye(3),
)


def _names(code):
    found = set(code.co_names)
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            found |= _names(constant)
    return found


_BUILTIN = {"abs", "sum", "range", "zip", "len", "max", "min", "all", "any", "float", "complex", "tuple", "list"}


def holds(check, seed):
    """Evaluate a check at one draw of its free names."""
    code = compile(check, "<check>", "eval")
    known = {name: value for name, value in globals().items() if not name.startswith("_")}
    draw = random.Random(f"{check}{seed}")
    names = {
        name: draw.uniform(0.4, 1.2) for name in sorted(_names(code)) if name not in known and name not in _BUILTIN
    }
    return bool(eval(code, {**known, **names}))


def disagreement(entry):
    """Return a sentence if the check of an entry contradicts its label, otherwise an empty text."""
    if "check" not in entry:
        return "" if entry["expected"] == "definition" else f"{entry['id']}: has no check"
    try:
        results = [holds(entry["check"], seed) for seed in range(DRAWS)]
    except Exception as error:
        return f"{entry['id']}: the check does not run: {type(error).__name__}: {error}"
    if entry["expected"] in CORRECT and not all(results):
        return f"{entry['id']}: labelled {entry['expected']}, but its check fails"
    if entry["expected"] in FAULTY and any(results):
        return f"{entry['id']}: labelled {entry['expected']}, but its check holds"
    return ""


def read():
    """Return all entries, each with the name of its chapter."""
    entries = []
    for path in sorted(FOLDER.glob("*.toml")):
        entries += [
            {**entry, "chapter": path.stem} for entry in tomllib.loads(path.read_text(encoding="utf-8"))["formula"]
        ]
    return entries


def main():
    """Print every disagreement and the number of entries."""
    entries = read()
    wrong = [sentence for sentence in map(disagreement, entries) if sentence]
    print("\n".join([*wrong, f"{len(entries)} entries, {len(wrong)} disagreements"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
