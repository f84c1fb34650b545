"""Coq theorems about unit quaternions: the rotations that they represent, and the quaternion rates."""

from collections.abc import Sequence

from symrot import symbols
from symrot.certificates.coq.euler import DCM_RATE, OMEGA
from symrot.certificates.coq.file import CoqFile, Theorem, derivatives, statement
from symrot.certificates.coq.text import definition_text
from symrot.kernels.library import definition

__all__ = ["quaternion_file"]

Q = tuple(map(str, symbols.quaternion))
DQ = tuple(map(str, symbols.quaternion_rates))
_QUAT = f"quat {' '.join(Q)}"
_QUAT_T = "quat " + " ".join(f"({q} t)" for q in Q)
_UNIT_T = f"norm2 ({_QUAT_T}) = 1"
_ORDER = {"body": "{q} *q pure {v}", "space": "pure {v} *q {q}"}


def quaternion_file() -> CoqFile:
    """Return the Coq file about unit quaternions."""
    kernels = ("dcm", "body_rates", "space_rates", "product", "to_space", "to_body")
    return CoqFile(
        "quaternions",
        "Unit quaternions: the formulas of their kernels, and what they are.",
        ("rotation",),
        tuple(definition_text(definition(f"quaternion_{name}"), name) for name in kernels),
        (_product(), _dcm(), *(_turned(towards) for towards in reversed(OMEGA)),
         *(_rates(frame) for frame in OMEGA), *(_only_rates(frame) for frame in OMEGA)),
    )  # fmt: skip


def _product() -> Theorem:
    left = tuple(map(str, symbols.second_quaternion))
    return Theorem(
        "quaternion_product",
        "The kernel is the product of Hamilton.",
        statement(f"{' '.join(left + Q)} : R",
                  conclusion=f"product {' '.join(left + Q)} = quat {' '.join(left)} *q {_QUAT}"),
        "  intros. unfold product. by_ring.",
    )  # fmt: skip


def _dcm() -> Theorem:
    return Theorem(
        "quaternion_dcm",
        "The dcm of a unit quaternion turns vectors as the quaternion does.",
        statement(f"{' '.join(Q)} : R", f"  norm2 ({_QUAT}) = 1 ->",
                  conclusion=f"represents ({_QUAT}) (dcm {' '.join(Q)})"),
        f"  intros {' '.join(Q)} H. replace (dcm {' '.join(Q)}) with (turn ({_QUAT})).\n"
        "  - apply turn_represents. exact H.\n"
        "  - unfold turn, dcm. by_ring.",
    )  # fmt: skip


def _turned(towards: str) -> Theorem:
    vector = " ".join(map(str, symbols.vector))
    left, right = (_QUAT, f"conjugate ({_QUAT})")
    if towards == "body":
        left, right = right, left
    return Theorem(
        f"quaternion_to_{towards}",
        f"The kernel carries components to {towards} axes: {'q v q*' if towards == 'space' else 'q* v q'}.",
        statement(f"{' '.join(Q)} {vector} : R", f"  norm2 ({_QUAT}) = 1 ->",
                  conclusion=f"pure (to_{towards} {' '.join(Q)} {vector}) =\n"
                  f"{_wrapped(left)} *q pure (vec {vector}) *q {_wrapped(right)}"),
        f"  intros {' '.join(Q)} {vector} H. pose proof (norm2_square _ H) as N. cbn in N. clear H.\n"
        f"  unfold to_{towards}. spread. f_equal; ring [N].",
    )  # fmt: skip


def _wrapped(text: str) -> str:
    return f"({text})"


def _path(name: str, parameters: Sequence[str]) -> tuple[str, str]:
    """Return a matrix function of time as Coq text, and its value at t.

    ``"dcm"`` and ``["q0", "q1"]`` give ``fun u => dcm (q0 u) (q1 u)`` and ``dcm (q0 t) (q1 t)``.
    """
    return (f"fun u => {name} " + " ".join(f"({each} u)" for each in parameters),
            f"{name} " + " ".join(f"({each} t)" for each in parameters))  # fmt: skip


def _halved(frame: str) -> str:
    return "vec " + " ".join(f"({each} / 2)" for each in OMEGA[frame])


def _rates(frame: str) -> Theorem:
    omega = f"vec {' '.join(OMEGA[frame])}"
    path, dcm = _path("dcm", Q)
    opened = f"{' '.join(Q)} t {' '.join(DQ)} {' '.join(OMEGA[frame])} {' '.join(f'D{q}' for q in Q)}"
    arguments = f"{' '.join(Q)} t {' '.join(DQ)} ({_halved(frame)}) {' '.join(f'D{q}' for q in Q)} H"
    return Theorem(
        f"quaternion_{frame}_rates",
        f"Where a quaternion is of unit norm and moves at the printed rates, its dcm turns with the angular velocity "
        f"omega, given in the {frame} frame, and its norm is stationary.",
        statement(
            f"({' '.join(Q)} : R -> R) (t {' '.join(DQ)} {' '.join(OMEGA[frame])} : R)",
            derivatives(Q, DQ),
            f"  {_UNIT_T} ->",
            f"  quat {' '.join(DQ)} = {frame}_rates {' '.join(f'({q} t)' for q in Q)} {' '.join(OMEGA[frame])} ->",
            conclusion=f"derivative ({path}) t\n  ({DCM_RATE[frame].format(dcm=dcm, omega=f'({omega})')}) /\\\n"
            f"derivable_pt_lim (fun u => norm2 (quat {' '.join(f'({q} u)' for q in Q)})) t 0",
        ),
        f"  intros {opened} H E.\n"
        f"  assert (P : quat {' '.join(DQ)} = {_ORDER[frame].format(q=f'({_QUAT_T})', v=f'({_halved(frame)})')})\n"
        f"    by (rewrite E; unfold {frame}_rates; spread; f_equal; field).\n"
        "  split.\n"
        f"  - replace ({omega}) with (vadd ({_halved(frame)}) ({_halved(frame)})) by (spread; f_equal; field).\n"
        f"    replace ({dcm}) with (turn ({_QUAT_T})) by (unfold turn, dcm; by_ring).\n"
        f"    apply (derivative_same _ (fun u => turn (quat {' '.join(f'({q} u)' for q in Q)})));\n"
        "      [intro u; unfold turn, dcm; by_ring|].\n"
        f"    exact (turn_{frame} {arguments} P).\n"
        f"  - revert E. unfold {frame}_rates. spread. intro E. injection E. clear E. intros E3 E2 E1 E0.\n"
        "    eapply derivative_is; [differentiate | cbv beta; rewrite E0, E1, E2, E3; field].",
    )


def _only_rates(frame: str) -> Theorem:
    omega = f"vec {' '.join(OMEGA[frame])}"
    path, dcm = _path("dcm", Q)
    opened = f"{' '.join(Q)} t {' '.join(DQ)} {' '.join(OMEGA[frame])} {' '.join(f'D{q}' for q in Q)}"
    rates = f"{frame}_rates {' '.join(f'({q} t)' for q in Q)}"
    arguments = f"{' '.join(Q)} t {' '.join(DQ)} ({omega}) {' '.join(f'D{q}' for q in Q)} U"
    return Theorem(
        f"quaternion_{frame}_rates_only",
        "No other rates of a quaternion that stays of unit norm turn its dcm with that angular velocity.",
        statement(
            f"({' '.join(Q)} : R -> R) (t {' '.join(DQ)} {' '.join(OMEGA[frame])} : R)",
            derivatives(Q, DQ),
            f"  (forall u, norm2 (quat {' '.join(f'({q} u)' for q in Q)}) = 1) ->",
            f"  derivative ({path}) t\n    ({DCM_RATE[frame].format(dcm=dcm, omega=f'({omega})')}) ->",
            conclusion=f"quat {' '.join(DQ)} = {rates} {' '.join(OMEGA[frame])}",
        ),
        f"  intros {opened} U H.\n"
        f"  destruct (only_quaternion_rates_{frame} {arguments}) as [v [W E]].\n"
        f"  - replace (turn ({_QUAT_T})) with ({dcm}) by (unfold turn, dcm; by_ring).\n"
        f"    apply (derivative_same _ ({path})); [intro u; unfold turn, dcm; by_ring | exact H].\n"
        f"  - rewrite E. unfold {frame}_rates. destruct v. unfold vadd in W. injection W. intros. subst.\n"
        "    spread. f_equal; field.",
        kernel=False,
    )
