"""Coq theorems about classical and modified Rodrigues parameters: the attitude, and the parameter rates."""

from symrot import symbols
from symrot.certificates.coq.euler import DCM_RATE, OMEGA
from symrot.certificates.coq.file import CoqFile, Theorem, derivatives, statement
from symrot.certificates.coq.text import coq_expression, definition_text, matrix_text
from symrot.kernels.library import definition
from symrot.kinematics.rodrigues import projection

__all__ = ["rodrigues_file"]

_RATES = {"rodrigues": tuple(map(str, symbols.rodrigues_rates)), "mrp": tuple(map(str, symbols.mrp_rates))}


def rodrigues_file(name: str) -> CoqFile:
    """Return the Coq file about classical (``"rodrigues"``) or modified (``"mrp"``) Rodrigues parameters."""
    which = projection(name)
    parameters = tuple(map(str, which.parameters))
    return CoqFile(
        name,
        f"Rodrigues parameters, {which.about}: the formulas of the kernels, and what they are.",
        ("rotation",),
        (
            "From Coq Require Import Lra.",
            definition_text(definition(f"{name}_dcm"), "dcm"),
            definition_text(definition(f"{name}_quaternion"), "unit_quaternion"),
            *(definition_text(definition(f"{name}_{frame}_rates"), f"{frame}_rates") for frame in OMEGA),
            *(matrix_text(f"{frame}_jacobian", parameters, tuple(which.rate_matrix(frame))) for frame in OMEGA),
        ),
        (
            _quaternion(name, parameters),
            _turning(name, parameters),
            *(_rates(name, parameters, frame) for frame in OMEGA),
        ),
    )


def _norm(parameters: tuple[str, ...], at: str = "") -> str:
    """Return the Coq text of 1 plus the squared ``parameters``, such as ``p1 ^ 2 + p2 ^ 2 + 1``.

    With ``at`` = ``" t"`` the parameters are functions of time: ``p1 t ^ 2 + p2 t ^ 2 + 1``.
    """
    return " + ".join(f"{each}{at} ^ 2" for each in parameters) + " + 1"


def _positive(parameters: tuple[str, ...], at: str = "") -> str:
    """Return a Coq tactic that proves the goal ``0 < S`` or ``S <> 0``, with S = 1 plus the squared ``parameters``.

    S is the text that :func:`_norm` returns for the same arguments; with ``at`` = ``" t"`` the parameters are functions
    of time.
    """
    return "(" + "; ".join(f"pose proof (pow2_ge_0 ({each}{at}))" for each in parameters) + "; lra)"


def _quaternion(name: str, parameters: tuple[str, ...]) -> Theorem:
    names, norm = " ".join(parameters), _norm(parameters)
    return Theorem(
        f"{name}_quaternion",
        "The quaternion of the parameters is a unit quaternion, and it turns vectors as the dcm does.",
        statement(f"{names} : R", conclusion=f"represents (unit_quaternion {names}) (dcm {names})"),
        f"  intros {names}. assert (P : 0 < {norm}) by {_positive(parameters)}.\n"
        f"  pose proof (sqrt_lt_R0 _ P) as S. pose proof (sqrt_sqrt ({norm}) (Rlt_le _ _ P)) as E.\n"
        "  assert (N := Rgt_not_eq _ _ P). assert (M := Rgt_not_eq _ _ S).\n"
        "  unfold unit_quaternion, dcm.\n"
        f"  set (r := sqrt ({norm})) in *. assert (F : r ^ 2 = {norm}) by (rewrite <- E; ring).\n"
        "  split; [|intro v]; spread; try f_equal; try (field; assumption);\n"
        f"    try (rewrite <- F; field); try exact M; field_simplify_eq; try (split; assumption); try assumption;\n"
        "    rewrite ?F; ring.",
    )


def _path(parameters: tuple[str, ...]) -> str:
    return "fun u => dcm " + " ".join(f"({each} u)" for each in parameters)


def _at(parameters: tuple[str, ...]) -> str:
    return " ".join(f"({each} t)" for each in parameters)


def _turning(name: str, parameters: tuple[str, ...]) -> Theorem:
    rates, at = _RATES[name], _at(parameters)
    return Theorem(
        f"{name}_turning",
        "The dcm turns with the angular velocity that the Jacobian makes of the rates of the parameters.",
        statement(
            f"({' '.join(parameters)} : R -> R) (t {' '.join(rates)} : R)",
            derivatives(parameters, rates),
            conclusion=f"derivative ({_path(parameters)}) t\n"
            f"  (dcm {at} *m skew (body_jacobian {at} *v vec {' '.join(rates)}))",
        ),
        f"  intros {' '.join(parameters)} t {' '.join(rates)} D1 D2 D3. assert (P : {_norm(parameters, ' t')} <> 0)\n"
        f"    by {_positive(parameters, ' t')}.\n"
        "  pose proof (pow_nonzero _ 2 P) as P2. unfold body_jacobian, dcm, derivative. spread.\n"
        "  repeat match goal with |- _ /\\ _ => split end;\n"
        "    (eapply derivative_is; [differentiate | cbv beta; unfold Rsqr; field; exact P]).",
        kernel=False,
    )


def _rates(name: str, parameters: tuple[str, ...], frame: str) -> Theorem:
    rates, path, at = _RATES[name], _path(parameters), _at(parameters)
    turning = f"{name}_turning {' '.join(parameters)} t {' '.join(rates)} D1 D2 D3"
    rotation = f"represents_rotation _ _ ({name}_quaternion {at})"
    derivative_proof = f"  - exact ({turning}).\n"
    if frame == "space":
        derivative_proof = (
            f"  - replace (space_jacobian {at} *v vec {' '.join(rates)})\n"
            f"      with (dcm {at} *v (body_jacobian {at} *v vec {' '.join(rates)}))\n"
            "      by (unfold space_jacobian, body_jacobian, dcm; spread; f_equal; field; exact P).\n"
            f"    rewrite <- (skew_of_turned _ _ ({rotation})).\n    exact ({turning}).\n"
        )
    omega = f"vec {' '.join(OMEGA[frame])}"
    opened = f"{' '.join(parameters)} t {' '.join(rates)} {' '.join(OMEGA[frame])} D1 D2 D3"
    determinant = coq_expression(projection(name).rate_matrix(frame).determinant)
    for each in parameters:
        determinant = determinant.replace(each, f"{each} t")
    derived = DCM_RATE[frame].format(dcm=f"dcm {at}", omega=f"({omega})")
    return Theorem(
        f"{name}_{frame}_rates",
        f"The parameters move at the printed rates if and only if the dcm turns with the angular velocity omega, given "
        f"in the {frame} frame.",
        statement(
            f"({' '.join(parameters)} : R -> R) (t {' '.join(rates)} {' '.join(OMEGA[frame])} : R)",
            derivatives(parameters, rates),
            conclusion=f"(derivative ({path}) t\n   ({derived})\n <->\n vec {' '.join(rates)} = "
            f"{frame}_rates {at} {' '.join(OMEGA[frame])})",
        ),
        f"  intros {opened}. assert (P : {_norm(parameters, ' t')} <> 0)\n"
        f"    by {_positive(parameters, ' t')}.\n"
        "  pose proof (pow_nonzero _ 2 P) as P2. pose proof (pow_nonzero _ 3 P) as P3.\n"
        f"  apply (only_{frame}_rates ({path}) t ({frame}_jacobian {at})).\n"
        f"  - exact ({rotation}).\n"
        + derivative_proof
        + f"  - replace (det ({frame}_jacobian {at})) with ({determinant})\n"
        f"      by (unfold {frame}_jacobian; spread; field; exact P).\n"
        "    unfold Rdiv. apply Rmult_integral_contrapositive_currified; [lra | apply Rinv_neq_0_compat; assumption].\n"
        f"  - unfold {frame}_jacobian, {frame}_rates. spread. f_equal; field; exact P.",
    )
