"""Verdicts of ``symrot check`` on claims with a context in words, against an oracle that shares no code with symrot.

    python -m tests.campaigns.checker.contexts [--seed 2026] [--count 1] [--list OUTCOME ..]

The claims mix angle rates and components of all sequences, solved for either; name angles as yaw, pitch and roll in
every order; mix spin, momenta and energies of a top; use products of inertia with both signs; and state whole, half and
diametral dimensions of bodies. Half of them have one fault. A claim is correct if it holds at random motions of a body:
the angular velocity comes from the rotation matrix by finite rotations, moments by sums over points of the body.

``wrong`` is a correct claim called false or doubtful, or a faulty one called true, recognised or conditional; ``open``
is a definition, and ``right`` the rest. The command ends with exit code 1 if there is a wrong answer.
"""

import argparse
import random
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from itertools import permutations
from typing import NamedTuple

import numpy as np
from sympy import Expr, Matrix, Symbol, cancel, cos, expand, eye, simplify, sin

import symrot
from symrot.errors import SymrotError

SEQUENCES = [a + b + c for a in "XYZ" for b in "XYZ" for c in "XYZ" if a != b != c]
SEQUENCES += [name.lower() for name in SEQUENCES]
GOOD, BAD = ("true", "conditional", "recognised"), ("false", "doubtful")
OUTCOMES = ("wrong", "open", "refused", "right")


class Case(NamedTuple):
    """A claim in words, its context, and whether it is correct."""

    text: str
    context: Mapping[str, object]
    is_correct: bool


# -- angle rates and components ---------------------------------------------------------------------------------------


def rotation(axis: str, angle: float) -> np.ndarray:
    """Return the rotation about a coordinate axis, by Rodrigues' formula."""
    e = np.eye(3)["XYZ".index(axis.upper())]
    cross = np.array([[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def attitude(sequence: str, angles: np.ndarray) -> np.ndarray:
    """Return the matrix from body to space: moving axes multiply on the right, fixed axes on the left."""
    whole = np.eye(3)
    for axis, angle in zip(sequence, angles, strict=True):
        part = rotation(axis, angle)
        whole = whole @ part if sequence.isupper() else part @ whole
    return whole


def angular_velocity(sequence: str, frame: str, angles: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Return omega from the change of the matrix in a short time, by Richardson's extrapolation."""
    matrix = attitude(sequence, angles)

    def change(h: float) -> np.ndarray:
        return (attitude(sequence, angles + h * rates) - attitude(sequence, angles - h * rates)) / (2 * h)

    rate = (4 * change(1e-3) - change(2e-3)) / 3
    skew = matrix.T @ rate if frame == "body" else rate @ matrix.T
    return np.array([skew[2, 1], skew[0, 2], skew[1, 0]])


def _symbolic_velocity(sequence: str, frame: str, q: list[Symbol], dq: list[Symbol]) -> list[Expr]:
    """Return omega in the angles and rates: the sum of the axes of rotation, carried by the other rotations."""
    axes = ["XYZ".index(axis.upper()) for axis in sequence]
    order = [0, 1, 2] if sequence.isupper() else [2, 1, 0]
    parts = []
    for n in range(3):
        i, j = [k for k in range(3) if k != axes[n]]
        sign = 1 if axes[n] != 1 else -1
        part = eye(3)
        part[i, i] = part[j, j] = cos(q[n])
        part[i, j], part[j, i] = -sign * sin(q[n]), sign * sin(q[n])
        parts.append(part)
    total, carried = Matrix([0, 0, 0]), eye(3)
    for n in order:
        total += carried * eye(3)[:, axes[n]] * dq[n]
        carried = carried * parts[n]
    return list(total if frame == "space" else carried.T * total)


FAMILIES = (("phi", "theta", "psi"), ("alpha", "beta", "gamma"), ("q_1", "q_2", "q_3"))
COMPONENTS = (("omega_1", "omega_2", "omega_3"), ("omega_x", "omega_y", "omega_z"), ("w_x", "w_y", "w_z"),
              ("p", "q", "r"))  # fmt: skip


def _written(formula: Expr, names: list[str]) -> str:
    """Return a formula as people type it, with primes for rates."""
    text = str(formula).replace("**", "^")
    return re.sub(r"\bd(" + "|".join(names) + r")\b", r"\1'", text)


def _faulty(text: str, draw: random.Random) -> str:
    """Return a formula with one fault: the sign of a term, or sine and cosine exchanged."""
    places = [*re.finditer(r"(?<=\S) [+-] ", text)]
    functions = [*re.finditer(r"\b(sin|cos)\(", text)]
    if places and (not functions or draw.random() < 0.5):
        place = draw.choice(places)
        return text[: place.start()] + (" - " if "+" in place[0] else " + ") + text[place.end() :]
    if functions:
        place = draw.choice(functions)
        return text[: place.start()] + ("cos(" if place[1] == "sin" else "sin(") + text[place.end() :]
    return f"2*({text})"


def _residual(sides: tuple[str, str], names: list[str], values: Mapping[str, float]) -> float:
    """Return the relative difference of two sides with rates written with primes, at a point."""
    own = {**values, "sin": np.sin, "cos": np.cos, "tan": np.tan, "sqrt": np.sqrt}
    left, right = (eval(re.sub(r"\b(" + "|".join(names) + r")'", r"d\1", side).replace("^", "**"), {}, own)
                   for side in sides)  # fmt: skip
    return float(abs(left - right) / (1e-9 + abs(left) + abs(right)))


def _holds(
    sides: tuple[str, str], names: list[str], point: Callable[[np.random.Generator], Mapping[str, float]]
) -> bool:
    numbers = np.random.default_rng(7)
    return all(_residual(sides, names, point(numbers)) < 1e-7 for _ in range(4))


def rates(draw: random.Random) -> Iterator[Case]:
    """Yield claims about the rates of each sequence in each frame, solved for a rate or a component."""
    for sequence in SEQUENCES:
        for frame in ("body", "space"):
            is_proper = sequence[0] == sequence[-1]
            names = list(draw.choice(FAMILIES if is_proper else FAMILIES[1:]))
            components = draw.choice(COMPONENTS if frame == "body" else COMPONENTS[1:3])
            q, dq = [Symbol(name) for name in names], [Symbol(f"d{name}") for name in names]
            omega = [Symbol(name) for name in components]
            formulas = _symbolic_velocity(sequence, frame, q, dq)
            axis = draw.randrange(3)
            equation = expand(omega[axis] - simplify(formulas[axis]))
            unknown = draw.choice([rate for rate in (*dq, omega[axis]) if equation.has(rate)])
            formula = cancel(unknown - equation / equation.coeff(unknown))
            left, right = (_written(side, names) for side in (unknown, formula))

            def point(numbers: np.random.Generator, s: str = sequence, f: str = frame, own: list[str] = names,
                      parts: tuple[str, ...] = components) -> dict[str, float]:  # fmt: skip
                angles, speeds = numbers.uniform(0.3, 1.2, 3), numbers.uniform(-1, 1, 3)
                values = dict(zip(own, angles, strict=True)) | {f"d{n}": v for n, v in zip(own, speeds, strict=True)}
                return values | dict(zip(parts, angular_velocity(s, f, angles, speeds), strict=True))

            for side in (right, _faulty(right, draw)):
                is_correct = _holds((left, side), names, point)
                yield Case(f"{left} = {side}", {"sequence": sequence, "frame": frame}, is_correct)


def words_about_angles() -> Iterator[Case]:
    """Yield claims about yaw, pitch and roll in which words give the letters in each order."""
    axes = {"yaw": "Z", "pitch": "Y", "roll": "X"}
    for sequence in ("ZYX", "xyz", "XYZ", "YXZ"):
        for letters in (("alpha", "beta", "gamma"), ("phi", "theta", "psi")):
            place = {word: sequence.upper().index(axis) for word, axis in axes.items()}
            for order in permutations(axes):
                own = [next(letter for letter, word in zip(letters, order, strict=True) if place[word] == n)
                       for n in range(3)]  # fmt: skip
                q, dq = [Symbol(n) for n in own], [Symbol(f"d{n}") for n in own]
                where = [f"{letter} = {word}" for letter, word in zip(letters, order, strict=True)]
                context = {"sequence": sequence, "frame": "body", "where": where}
                formula = simplify(_symbolic_velocity(sequence, "body", q, dq)[0])
                yield Case(f"omega_x = {_written(formula, own)}", context, True)
                exchanged = formula.subs({q[0]: q[2], q[2]: q[0], dq[0]: dq[2], dq[2]: dq[0]}, simultaneous=True)
                yield Case(f"omega_x = {_written(exchanged, own)}", context, simplify(exchanged - formula) == 0)


# -- tops, products of inertia, dimensions ----------------------------------------------------------------------------

TOPS = (
    "psi' = omega_3 - cos(theta)*(L_z - L_3*cos(theta))/(I_1*sin(theta)^2)",
    "p_phi = I_1*phi'*sin(theta)^2 + I_3*omega_3*cos(theta)", "p_psi = I_3*omega_3",
    "p_phi = I_1*phi'*sin(theta)^2 + p_psi*cos(theta)", "L_z = I_1*phi'*sin(theta)^2 + L_3*cos(theta)",
    "E = I_1*(theta'^2 + phi'^2*sin(theta)^2)/2 + I_3*omega_3^2/2 + m*g*l*cos(theta)",
    "E = I_1*theta'^2/2 + (L_z - L_3*cos(theta))^2/(2*I_1*sin(theta)^2) + L_3^2/(2*I_3) + m*g*l*cos(theta)",
    "phi' = (p_phi - p_psi*cos(theta))/(I_1*sin(theta)^2)", "omega_3 = L_3/I_3", "omega_3 = psi' + phi'*cos(theta)",
    "T = I_1*(theta'^2 + phi'^2*sin(theta)^2)/2 + L_3^2/(2*I_3)", "p_theta = I_1*theta'",
    "L = I_1*(theta'^2 + phi'^2*sin(theta)^2)/2 + I_3*omega_3^2/2 - m*g*l*cos(theta)",
    "phi'*cos(theta) = omega_3 - psi'", "L_3*cos(theta) = L_z - I_1*phi'*sin(theta)^2",
)  # fmt: skip


def tops(draw: random.Random) -> Iterator[Case]:
    """Yield formulas of a symmetric top in several letters, each also with a fault."""

    def point(numbers: np.random.Generator) -> dict[str, float]:
        angles, speeds = numbers.uniform(0.3, 1.2, 3), numbers.uniform(-1, 1, 3)
        a, c, m, g, length = numbers.uniform(1, 2, 5)
        omega = angular_velocity("ZXZ", "body", angles, speeds)
        momentum = np.array([a, a, c]) * omega
        vertical = float((attitude("ZXZ", angles) @ momentum)[2])
        kinetic, potential = float(omega @ momentum) / 2, m * g * length * np.cos(angles[1])
        return {
            "phi": angles[0], "theta": angles[1], "psi": angles[2], "dphi": speeds[0], "dtheta": speeds[1],
            "dpsi": speeds[2], "I_1": a, "I_3": c, "m": m, "g": g, "l": length, "omega_3": omega[2],
            "p_phi": vertical, "L_z": vertical, "p_psi": momentum[2], "L_3": momentum[2], "p_theta": a * speeds[1],
            "T": kinetic, "E": kinetic + potential, "L": kinetic - potential,
        }  # fmt: skip

    names = ["phi", "theta", "psi"]
    for source in TOPS:
        left, _, right = source.partition(" = ")
        for body in ("", "heavy symmetric top"):
            for side in (right, _faulty(right, draw), _faulty(right, draw)):
                is_correct = _holds((left, side), names, point)
                is_of_cardan_angles = side == "psi' + phi'*sin(theta)"  # right for XYZ, if nothing says it is a top
                yield Case(f"{left} = {side}", {"body": body}, is_correct or (is_of_cardan_angles and not body))


def products() -> Iterator[Case]:
    """Yield momenta and energies with both signs of the products, in words that say which sign they have."""
    sums = {
        "L_x": ("I_xx*omega_x", "I_xy*omega_y", "I_xz*omega_z"),
        "L_y": ("I_yy*omega_y", "I_xy*omega_x", "I_yz*omega_z"),
        "L_z": ("I_zz*omega_z", "I_xz*omega_x", "I_yz*omega_y"),
    }
    for words, right_sign in (("∫ xy dm", "-"), ("product of inertia ∫ xy dm", "-"), ("-∫ xy dm", "+"),
                              ("product of inertia without the minus sign", "-"),
                              ("product of inertia with the minus sign", "+")):  # fmt: skip
        for left, (first, *rest) in sums.items():
            used = sorted({term.partition("*")[0] for term in rest})
            for sign in "+-":
                text = f"{left} = {first} " + " ".join(f"{sign} {term}" for term in rest)
                yield Case(text, {"where": [f"{', '.join(used)} = {words}"]}, sign == right_sign)


def dimensions() -> Iterator[Case]:
    """Yield moments of bodies about their centre with whole, half and diametral dimensions, by sums over points."""
    grid = (np.arange(60) + 0.5) / 30 - 1
    x, y, z = np.meshgrid(grid, grid, grid)
    ball = x**2 + y**2 + z**2 < 1
    box = float(np.mean(x**2))  # of a half side 1
    round_body = float(np.mean(x[ball] ** 2))  # of a semi-axis 1
    for body, unit, scale in (
        ("box of sides a, b, c about its centre", box, 0.5), ("box with half sides a, b, c about its centre", box, 1),
        ("cuboid of half-edges a, b and c about its centre", box, 1), ("box of sides 2a, 2b, 2c about its centre", box, 1),
        ("ellipsoid with semi-axes a, b, c", round_body, 1), ("ellipsoid of diameters a, b, c", round_body, 0.5),
        ("plate with half-sides a and b about its centre", box, 1),
    ):  # fmt: skip
        for divisor in (3, 4, 5, 6, 12, 20):
            is_correct = abs(unit * scale**2 * divisor - 1) < 0.02
            yield Case(f"I_zz = m*(a^2 + b^2)/{divisor}", {"body": body}, is_correct)


def cases(seed: int = 2026) -> list[Case]:
    """Return all claims, with the faults that a seed chooses."""
    draw = random.Random(seed)
    return [*rates(draw), *words_about_angles(), *tops(draw), *products(), *dimensions()]


def outcome(case: Case) -> tuple[str, str]:
    """Return the outcome of a claim, and the verdict with a sentence."""
    try:
        verdict = symrot.check(case.text, **case.context)
    except SymrotError as reason:
        return "refused", str(reason)
    sentence = f"{verdict.verdict}: {'; '.join(map(str, verdict.recognised_as)) or verdict.reason}"
    if verdict.verdict in (BAD if case.is_correct else GOOD):
        return "wrong", sentence
    return ("right" if verdict.verdict in (*GOOD, *BAD) else "open"), sentence


def main(arguments: list[str] | None = None) -> int:
    """Print the outcomes of correct and of faulty claims, and the claims with the outcomes that are listed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--count", type=int, default=1, help="number of seeds, from --seed on")
    parser.add_argument("--list", nargs="*", default=["wrong"], choices=OUTCOMES)
    options = parser.parse_args(arguments)
    every = [case for n in range(options.count) for case in cases(options.seed + n)]
    results = [outcome(case) for case in every]
    for group in (True, False):
        counts = Counter(name for case, (name, _) in zip(every, results, strict=True) if case.is_correct == group)
        print(f"{'correct' if group else 'faulty':8}{sum(counts.values()):5}  "
              + "  ".join(f"{name} {counts[name]}" for name in OUTCOMES))  # fmt: skip
    for case, (name, sentence) in zip(every, results, strict=True):
        if name in options.list:
            print(
                f"{name:8}{'correct' if case.is_correct else 'faulty':8} {case.text!r} {case.context}  {sentence[:160]}"
            )
    return int(any(name == "wrong" for name, _ in results))


if __name__ == "__main__":
    sys.exit(main())
