"""The catalogue's own formulas as claims, for the campaign against diagnosis: as derived, and as the pages show them.

An equation of a step becomes a claim with its hypotheses; if it is too long for the reader, each entry becomes a claim.
Derivations multiply matrices out, but pages show products, so the claims here contain products: only there can a fault
of order, transpose or sequence occur.
"""

from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

from sympy import MatrixBase

from symrot.catalogue import derivation, names
from symrot.checker.claim.claims import Claim
from symrot.checker.claim.reader import read_expression, read_relation
from symrot.checker.typed.readings import Relation
from symrot.conventions import INTRINSIC_SEQUENCES, SEQUENCES
from symrot.errors import InputError
from symrot.exact.printing import as_text
from symrot.kinematics.euler import rate_jacobian
from symrot.proof.derivation import Step

__all__ = ["STATEMENTS", "catalogue_claims", "claims_of_statements", "claims_of_step", "claims_of_steps"]

Q, P = "(q0, q1, q2, q3)", "(p0, p1, p2, p3)"
N, V, R, D = "Matrix([n1, n2, n3])", "Matrix([v_x, v_y, v_z])", "Matrix([x, y, z])", "Matrix([d_x, d_y, d_z])"
W, U = "Matrix([omega_1, omega_2, omega_3])", "Matrix([u_x, u_y, u_z])"
DW, DV = "Matrix([domega_1, domega_2, domega_3])", "Matrix([a_x, a_y, a_z])"
TAU = "Matrix([tau_1, tau_2, tau_3])"
INERTIA = "Matrix([[I_xx, I_xy, I_xz], [I_xy, I_yy, I_yz], [I_xz, I_yz, I_zz]])"
UNIT_Q, UNIT_P = "q0**2 + q1**2 + q2**2 + q3**2 == 1", "p0**2 + p1**2 + p2**2 + p3**2 == 1"
UNIT_N = "n1**2 + n2**2 + n3**2 == 1"
EULER = ("R", "Rz(phi(t))*Rx(theta(t))*Rz(psi(t))")
SPIN_S, SPIN_B = ("w", "vee(diff(R, t)*R.T)"), ("w", "vee(R.T*diff(R, t))")

STATEMENTS: tuple[tuple[str, str, tuple[tuple[str, str], ...], tuple[str, ...]], ...] = (
    ("rotation_matrices", "Rx(alpha).T*Rx(alpha) == eye(3)", (), ()),
    ("rotation_matrices", "det(Ry(alpha)) == cos(alpha)**2 + sin(alpha)**2", (), ()),
    ("rotation_matrices", "Rz(alpha) == Matrix([[cos(alpha), -sin(alpha), 0], [sin(alpha), cos(alpha), 0], [0, 0, 1]])",
     (), ()),
    ("axis_and_angle", "dot(v - n*dot(n, v), n) == 0", (("n", N), ("v", V)), (UNIT_N,)),
    ("axis_and_angle", "n*dot(n, v) + cos(alpha)*(v - n*dot(n, v)) + sin(alpha)*cross(n, v) == "
     "(eye(3) + sin(alpha)*skew(n) + (1 - cos(alpha))*skew(n)*skew(n))*v", (("n", N), ("v", V)), (UNIT_N,)),
    ("axis_and_angle", "eye(3) + sin(alpha)*skew(n) + (1 - cos(alpha))*skew(n)*skew(n) == "
     "cos(alpha)*eye(3) + (1 - cos(alpha))*n*n.T + sin(alpha)*skew(n)", (("n", N),), (UNIT_N,)),
    ("axis_and_angle", "trace(cos(alpha)*eye(3) + (1 - cos(alpha))*n*n.T + sin(alpha)*skew(n)) == 1 + 2*cos(alpha)",
     (("n", N),), (UNIT_N,)),
    ("composition", f"dcm_of(qmul({P}, {Q})) == dcm_of({P[1:-1]})*dcm_of({Q[1:-1]})", (), (UNIT_Q, UNIT_P)),
    ("composition", "qmul((cos(alpha/2), n1*sin(alpha/2), n2*sin(alpha/2), n3*sin(alpha/2)), "
     "(cos(theta/2), k_1*sin(theta/2), k_2*sin(theta/2), k_3*sin(theta/2)))[0] == "
     "cos(alpha/2)*cos(theta/2) - sin(alpha/2)*sin(theta/2)*dot(n, k)",
     (("n", N), ("k", "Matrix([k_1, k_2, k_3])")), ()),
    ("composition", "Rz(alpha)*Rz(theta) == Rz(alpha + theta)", (), ()),
    ("composition", "R*skew(w)*R.T == skew(R*w)", (("R", f"dcm_of{Q}"), ("w", W)), (UNIT_Q,)),
    ("euler_parameters", "qmul(qmul((cos(phi/2), 0, 0, sin(phi/2)), (cos(theta/2), sin(theta/2), 0, 0)), "
     "(cos(psi/2), 0, 0, sin(psi/2))) == Matrix([cos(theta/2)*cos(phi/2 + psi/2), sin(theta/2)*cos(phi/2 - psi/2), "
     "sin(theta/2)*sin(phi/2 - psi/2), cos(theta/2)*sin(phi/2 + psi/2)])", (), ()),
    ("euler_parameters", "R == dcm_of(cos(theta/2)*cos(phi/2 + psi/2), sin(theta/2)*cos(phi/2 - psi/2), "
     "sin(theta/2)*sin(phi/2 - psi/2), cos(theta/2)*sin(phi/2 + psi/2))", (("R", "Rz(phi)*Rx(theta)*Rz(psi)"),), ()),
    ("euler_parameters", f"trace(dcm_of{Q}) == 4*q0**2 - 1", (), (UNIT_Q,)),
    ("spin_tensor", "skew(w)*u == cross(w, u)", (("w", W), ("u", U)), ()),
    ("spin_tensor", "skew(w)*skew(w) == w*w.T - dot(w, w)*eye(3)", (("w", W),), ()),
    ("spin_tensor", "diff(R*d, t) == cross(w, R*d)", (EULER, SPIN_S, ("d", D)), ()),
    ("spin_tensor", "R.T*diff(R*d, t) == cross(w, d)", (EULER, SPIN_B, ("d", D)), ()),
    ("spin_tensor", "skew(vee(R.T*diff(R, t))) == R.T*skew(vee(diff(R, t)*R.T))*R", (EULER,), ()),
    ("quaternion_rates", "dq == qmul(q, (0, omega_1, omega_2, omega_3))/2",
     (("q", f"Matrix([{Q[1:-1]}])"), ("dq", "Matrix([-q1*omega_1 - q2*omega_2 - q3*omega_3, "
      "q0*omega_1 + q2*omega_3 - q3*omega_2, q0*omega_2 - q1*omega_3 + q3*omega_1, "
      "q0*omega_3 + q1*omega_2 - q2*omega_1])/2")), ()),
    ("quaternion_rates", f"qmul(qmul({Q}, (0, omega_1, omega_2, omega_3)), (q0, -q1, -q2, -q3)) == "
     "Matrix([0, (R*w)[0], (R*w)[1], (R*w)[2]])", (("R", f"dcm_of{Q}"), ("w", W)), (UNIT_Q,)),
    ("quaternion_rates", "R == Matrix([[q0**2 + q1**2 - q2**2 - q3**2, 2*(q1*q2 - q0*q3), 2*(q1*q3 + q0*q2)], "
     "[2*(q1*q2 + q0*q3), q0**2 - q1**2 + q2**2 - q3**2, 2*(q2*q3 - q0*q1)], "
     "[2*(q1*q3 - q0*q2), 2*(q2*q3 + q0*q1), q0**2 - q1**2 - q2**2 + q3**2]])", (("R", f"dcm_of{Q}"),), (UNIT_Q,)),
    ("quaternion_rates", "R*R.T == eye(3)", (("R", f"dcm_of{Q}"),), (UNIT_Q,)),
    ("relative_motion", "cross(w, cross(w, d)) == w*dot(w, d) - dot(w, w)*d", (("w", W), ("d", D)), ()),
    ("relative_motion", "R.T*diff(R*diff(d, t) + R*cross(w, d), t) == diff(diff(d, t), t) + cross(diff(w, t), d) + "
     "cross(w, cross(w, d)) + 2*cross(w, diff(d, t))",
     (("R", "Rz(phi(t))*Rx(theta(t))"), SPIN_B, ("d", "Matrix([x(t), y(t), 0])")), ()),
    ("relative_motion", "v + cross(w, cross(w, v)/dot(w, w)) == w*dot(w, v)/dot(w, w)", (("w", W), ("v", V)), ()),
    ("angular_momentum", "cross(r, m*cross(w, r)) == m*(dot(r, r)*eye(3) - r*r.T)*w", (("r", R), ("w", W)), ()),
    ("angular_momentum", "m*(dot(r, r)*eye(3) - r*r.T) == "
     "Matrix([[m*(y**2 + z**2), -m*x*y, -m*x*z], [-m*x*y, m*(x**2 + z**2), -m*y*z], "
     "[-m*x*z, -m*y*z, m*(x**2 + y**2)]])",
     (("r", R),), ()),
    ("kinetic_energy", "m*dot(cross(w, r), cross(w, r))/2 == dot(w, m*(dot(r, r)*eye(3) - r*r.T)*w)/2",
     (("r", R), ("w", W)), ()),
    ("kinetic_energy", "dot(w, J*w)/2 == I_xx*omega_1**2/2 + I_yy*omega_2**2/2 + I_zz*omega_3**2/2 + "
     "I_xy*omega_1*omega_2 + I_xz*omega_1*omega_3 + I_yz*omega_2*omega_3", (("J", INERTIA), ("w", W)), ()),
    ("parallel_axis", "m*(dot(r + d, r + d)*eye(3) - (r + d)*(r + d).T) == m*(dot(r, r)*eye(3) - r*r.T) + "
     "m*(dot(d, d)*eye(3) - d*d.T) + m*(2*dot(d, r)*eye(3) - d*r.T - r*d.T)", (("r", R), ("d", D)), ()),
    ("tensor_rotation", "diff(J, t) == skew(w)*J - J*skew(w)",
     (("R", "Rz(phi(t))*Rx(theta(t))"), SPIN_S, ("J", f"R*{INERTIA}*R.T")), ()),
    ("tensor_rotation", "trace(R*J*R.T) == trace(J)", (("R", f"dcm_of{Q}"), ("J", INERTIA)), (UNIT_Q,)),
    ("tensor_rotation", "m*(dot(R*r, R*r)*eye(3) - R*r*(R*r).T) == R*(m*(dot(r, r)*eye(3) - r*r.T))*R.T",
     (("R", f"dcm_of{Q}"), ("r", R)), (UNIT_Q,)),
    ("euler_equations", "J*inverse(J)*(tau - cross(w, J*w)) + cross(w, J*w) == tau",
     (("J", "diag(A, B, C)"), ("w", W), ("tau", TAU)), ()),
    ("euler_equations", "R.T*diff(R*J*w, t) == J*diff(w, t) + cross(w, J*w)",
     (("R", "Rz(phi(t))*Rx(theta(t))"), SPIN_B, ("J", INERTIA)), ()),
    ("euler_equations", "inverse(J)*(tau - cross(w, J*w)) == Matrix([((B - C)*omega_2*omega_3 + tau_1)/A, "
     "((C - A)*omega_3*omega_1 + tau_2)/B, ((A - B)*omega_1*omega_2 + tau_3)/C])",
     (("J", "diag(A, B, C)"), ("w", W), ("tau", TAU)), ()),
    ("euler_equations", "J*dw + cross(w, J*w) == Matrix([A*domega_1 + (C - B)*omega_2*omega_3, "
     "B*domega_2 + (A - C)*omega_3*omega_1, C*domega_3 + (B - A)*omega_1*omega_2])",
     (("J", "diag(A, B, C)"), ("w", W), ("dw", DW)), ()),
    ("work_and_power", "dot(w, cross(w, J*w)) == 0", (("J", INERTIA), ("w", W)), ()),
    ("work_and_power", "m*dot(a, v + cross(w, r)) == dot(m*a, v) + dot(cross(r, m*a), w)",
     (("a", DV), ("v", V), ("w", W), ("r", R)), ()),
)  # fmt: skip
"""Derivation, claim, definitions, hypotheses: what its page shows as a product, in the language of claims."""


def _of_sequences() -> Iterator[tuple[str, str, tuple[tuple[str, str], ...], tuple[str, ...]]]:
    """Yield the rates of all 24 sequences in both frames and the Euler parameters of 12, each made from its name."""
    angles = ("phi(t)", "theta(t)", "psi(t)")
    for sequence in SEQUENCES:
        turns = [f"R{axis.lower()}({angle})" for axis, angle in zip(sequence, angles, strict=True)]
        dcm = ("R", "*".join(turns if sequence.isupper() else turns[::-1]))
        for frame, claim in (("body", "diff(R, t) == R*skew(w)"), ("space", "diff(R, t) == skew(w)*R")):
            jacobian = rate_jacobian(sequence, frame)
            rows = [[_in_time(as_text(jacobian[i, j])) for j in range(3)] for i in range(3)]
            terms = [
                " + ".join(f"({entry})*diff({angle}, t)" for entry, angle in zip(row, angles, strict=True)
                           if entry != "0") for row in rows
            ]  # fmt: skip
            yield "euler_body_rates", claim, (dcm, ("w", f"Matrix([{', '.join(terms)}])")), ()
    for sequence in INTRINSIC_SEQUENCES:
        names_of, factors, turns = ("phi", "theta", "psi"), [], []
        for axis, angle in zip(sequence, names_of, strict=True):
            vector = [f"sin({angle}/2)" if axis == other else "0" for other in "XYZ"]
            factors.append(f"(cos({angle}/2), {', '.join(vector)})")
            turns.append(f"R{axis.lower()}({angle})")
        quaternion = f"qmul(qmul({factors[0]}, {factors[1]}), {factors[2]})"
        yield "euler_parameters", f"dcm_of({quaternion}) == {'*'.join(turns)}", (), ()


def _in_time(formula: str) -> str:
    for angle in ("phi", "theta", "psi"):
        formula = formula.replace(angle, f"{angle}(t)")
    return formula


FUNCTIONS_OF_TIME = ("phi", "theta", "psi", "x", "y")


def claims_of_statements() -> Iterator[tuple[str, Claim]]:
    """Yield (derivation, claim) for the statements with products."""
    for name, source, define, given in (*STATEMENTS, *_of_sequences()):
        texts = [source, *(formula for _, formula in define), *given]
        functions = tuple(f for f in FUNCTIONS_OF_TIME if any(f"{f}(t)" in text for text in texts))
        definitions = tuple((word, read_expression(formula)) for word, formula in define)
        relation = read_relation(source)
        hypotheses = tuple(map(read_relation, given))
        trees = [*relation[1:], *(tree for _, tree in definitions), *(side for h in hypotheses for side in h[1:])]
        known = {*functions, *(word for word, _ in define), "pi"}
        symbols = sorted({piece for tree in trees for piece in _names(tree)} - known)
        yield name, Claim(
            id=name, symbols=tuple(symbols), functions=functions, define=definitions, hypotheses=hypotheses,
            relation=relation, sources={"claim": source},
        )  # fmt: skip


def _names(tree: Any) -> Iterator[str]:
    from symrot.checker.claim.tree import walk

    return (node.value for _, node in walk(tree) if node.kind == "name")


def claims_of_steps() -> Iterator[tuple[str, Claim]]:
    """Yield (derivation, claim) for the equations of all steps; those too long for the reader entry by entry."""
    for name in names():
        for number, step in enumerate(derivation(name).steps, start=1):
            if step.relation == "=":
                for claim in claims_of_step(step, f"{name}-{number}"):
                    yield name, claim


def claims_of_step(step: Step, label: str) -> list[Claim]:
    """Return the equation of a step as a claim, or its entries, or nothing if the reader does not accept it."""
    whole = _claim(step.left, step.right, step.hypotheses, label)
    if whole is not None or not isinstance(step.left, MatrixBase):
        return [] if whole is None else [whole]
    cells = enumerate(zip(step.left, step.right, strict=True), start=1)
    entries = (_claim(*sides, step.hypotheses, f"{label}-{place}") for place, sides in cells if sides[0] != sides[1])
    return [claim for claim in entries if claim is not None]


def _claim(left: Any, right: Any, hypotheses: Sequence[Any], label: str) -> Claim | None:
    """Return an equation as a claim, or None if the reader does not accept it."""
    source = f"{as_text(left)} == {as_text(right)}"
    symbols = sorted(set().union(*(side.free_symbols for side in (left, right, *hypotheses))), key=str)
    try:
        signs: list[Relation] = [read_relation(f"{symbol} > 0") for symbol in symbols if symbol.is_positive]
        zeros = [read_relation(f"{as_text(formula)} == 0") for formula in hypotheses]
        relation = read_relation(source)
    except InputError:  # the coefficients of a series have names such as a_{k-2}
        return None
    return Claim(
        id=label, symbols=tuple(map(str, symbols)), hypotheses=(*zeros, *signs), relation=relation,
        sources={"claim": " ".join(source.split())},
    )  # fmt: skip


@cache
def catalogue_claims() -> tuple[tuple[str, Claim], ...]:
    """Return all claims of the catalogue, first those with products, without claims of the form x == x."""
    return tuple(
        (name, claim)
        for name, claim in (*claims_of_statements(), *claims_of_steps())
        if claim.relation is not None and claim.relation[1] != claim.relation[2]
    )
