"""Coq theorems about dynamics: Euler's equations, angular momentum, kinetic energy and the rotated inertia tensor."""

from symrot import symbols
from symrot.certificates.coq.file import CoqFile, Theorem, statement
from symrot.certificates.coq.quaternion import Q
from symrot.certificates.coq.text import definition_text
from symrot.kernels.library import definition

__all__ = ["dynamics_file"]

OMEGA = tuple(map(str, symbols.omega_b))
_ENTRIES = tuple(map(str, (*symbols.moments, *symbols.products)))
_TENSOR = f"tensor {' '.join(_ENTRIES)}"
_BODIES = {
    "tensor": (_ENTRIES, _TENSOR),
    "principal": (("A", "B", "C"), "tensor A B C 0 0 0"),
    "symmetric": (("A", "C"), "tensor A A C 0 0 0"),
    "spherical": (("A",), "tensor A A A 0 0 0"),
}  # class of body -> parameters of its kernel, inertia tensor
_VECTOR = f"vec {' '.join(OMEGA)}"
_OF_T = "(x1 (omega t)) (x2 (omega t)) (x3 (omega t))"
_TAU_T = "(x1 tau) (x2 tau) (x3 tau)"


_ROWS = [[_ENTRIES[place] for place in row] for row in ((0, 3, 4), (3, 1, 5), (4, 5, 2))]
_POWER = " + ".join(
    f"x{i} (omega t) * ({' + '.join(f'{entry} * x{j} domega' for j, entry in enumerate(row, 1))})"
    for i, row in enumerate(_ROWS, 1)
)  # omega . I domega/dt


def dynamics_file() -> CoqFile:
    """Return the Coq file about Euler's equations, angular momentum, energy and the inertia tensor in space axes."""
    kernels = (*(f"euler_equations_{body}" for body in _BODIES), "kinetic_energy", "angular_momentum_body",
               "angular_momentum_space", "inertia_rotated")  # fmt: skip
    return CoqFile(
        "dynamics",
        "Dynamics of a rigid body: the formulas of its kernels, and the law of angular momentum.",
        ("rotation",),
        tuple(definition_text(definition(name), f"{name}_kernel") for name in kernels),
        (*(_euler_equations(body) for body in _BODIES), _momentum_body(), _momentum_space(), _energy(),
         _rotated_tensor(), _rotated_tensor_rate()),
    )  # fmt: skip


def _euler_equations(body: str) -> Theorem:
    parameters, inertia = _BODIES[body]
    name = f"euler_equations_{body}"
    return Theorem(
        name,
        "In a body that turns with the angular velocity omega, the angular momentum D I omega in space has the rate "
        "D tau (the torque in space) if and only if omega moves as the kernel says.",
        statement(
            f"(D : R -> matrix) (omega : R -> vector) (domega tau : vector) (t {' '.join(parameters)} : R)",
            "  derivative D t (D t *m skew (omega t)) -> vderivative omega t domega ->",
            f"  rotation (D t) -> det ({inertia}) <> 0 ->",
            conclusion=f"(vderivative (fun u => D u *v ({inertia} *v omega u)) t (D t *v tau)\n <->\n"
            f" domega = {name}_kernel {' '.join(parameters)} {_OF_T} {_TAU_T})",
        ),
        f"  intros D omega domega tau t {' '.join(parameters)} H K N I.\n"
        f"  apply (only_acceleration D ({inertia}) omega t domega tau _ H K N I).\n"
        f"  revert I. unfold {name}_kernel, tensor. destruct (omega t), tau. spread. intro I.\n"
        f"  f_equal; field; repeat split; intro Z; apply I; first [etransitivity; [|exact Z]; ring | ring [Z]].",
    )


def _momentum_body() -> Theorem:
    variables = f"{' '.join(_ENTRIES)} {' '.join(OMEGA)}"
    return Theorem(
        "angular_momentum_body",
        "The kernel is the inertia tensor times omega.",
        statement(f"{variables} : R", conclusion=f"angular_momentum_body_kernel {variables} = {_TENSOR} *v {_VECTOR}"),
        "  intros. unfold angular_momentum_body_kernel, tensor. by_ring.",
    )


def _momentum_space() -> Theorem:
    variables = f"{' '.join(_ENTRIES)} {' '.join(OMEGA)} {' '.join(Q)}"
    return Theorem(
        "angular_momentum_space",
        "The kernel is the angular momentum, turned into space by the attitude that the quaternion represents.",
        statement(f"(a : matrix) ({variables} : R)", f"  represents (quat {' '.join(Q)}) a ->",
                  conclusion=f"angular_momentum_space_kernel {variables} = a *v ({_TENSOR} *v {_VECTOR})"),
        f"  intros a {variables} H. rewrite (turn_only _ _ H).\n"
        "  pose proof (norm2_square _ (proj1 H)) as N. cbn in N.\n"
        "  unfold angular_momentum_space_kernel, turn, tensor. spread. f_equal; ring [N].",
    )  # fmt: skip


def _energy() -> Theorem:
    variables = f"{' '.join(_ENTRIES)}"
    return Theorem(
        "kinetic_energy",
        "Where omega moves as Euler's equations say, the rate of the kinetic energy is the power of the torque.",
        statement(
            f"(omega : R -> vector) (domega tau : vector) (t {variables} : R)",
            "  vderivative omega t domega ->",
            f"  {_TENSOR} *v domega = vadd tau (cross ({_TENSOR} *v omega t) (omega t)) ->",
            conclusion="derivable_pt_lim\n"
            f"  (fun u => kinetic_energy_kernel {variables} (x1 (omega u)) (x2 (omega u)) (x3 (omega u))) t\n"
            "  (dot tau (omega t))",
        ),
        f"  intros omega domega tau t {variables} K. unfold vderivative in K. decompose [and] K. clear K.\n"
        "  unfold kinetic_energy_kernel, tensor. spread. intro E. injection E. clear E. intros E3 E2 E1.\n"
        "  eapply derivative_is; [differentiate | cbv beta].\n"
        f"  transitivity ({_POWER}).\n"
        "  - field.\n"
        "  - rewrite E1, E2, E3. ring.",
    )


def _rotated_tensor() -> Theorem:
    variables = f"{' '.join(Q)} {' '.join(_ENTRIES)}"
    return Theorem(
        "inertia_rotated",
        "The kernel is the inertia tensor in space axes, a I a^T, of a body whose attitude the quaternion represents.",
        statement(f"(a : matrix) ({variables} : R)", f"  represents (quat {' '.join(Q)}) a ->",
                  conclusion=f"inertia_rotated_kernel {variables} = a *m ({_TENSOR}) *m transpose a"),
        f"  intros a {variables} H. rewrite (turn_only _ _ H).\n"
        "  unfold inertia_rotated_kernel, turn, tensor. by_ring.",
    )  # fmt: skip


def _rotated_tensor_rate() -> Theorem:
    return Theorem(
        "inertia_rotated_rate",
        "The inertia tensor in space has the rate skew(omega) I - I skew(omega).",
        statement(
            "(D : R -> matrix) (i : matrix) (t : R) (omega : vector)",
            "  derivative D t (skew omega *m D t) ->",
            "  let turned := D t *m i *m transpose (D t) in",
            conclusion="derivative (fun u => D u *m i *m transpose (D u)) t\n"
            "  (msub (skew omega *m turned) (turned *m skew omega))",
        ),
        "  exact turned_tensor_rate.",
        kernel=False,
    )
