"""symrot: rigid-body rotation from derivation to trajectory.

SymPy derives the formulas from first principles; symrot proves them, specialises them to a scene, emits them as kernels
and propagates the motion. Each public name is imported at its first use, so ``import symrot`` is fast; the stub
``__init__.pyi`` tells type checkers where the names come from. Conventions: :mod:`symrot.conventions`.
"""

from importlib import import_module
from typing import Any

__version__ = "0.2.0"

_NAMES_OF_MODULES = {
    "conventions": ("SEQUENCES",),
    "errors": ("CertificateError", "CompilerError", "InputError", "PropagationError", "SymrotError"),
    "kinematics.chart": ("Limit", "RateMatrix", "SingularSet"),
    "kinematics.euler": ("EulerRateMatrix", "dcm", "rate_jacobian"),
    "kinematics.quaternion": ("quaternion_product", "quaternion_rates", "quaternion_to_dcm"),
    "kinematics.dossier": ("LockedPoint", "SingularityDossier", "singularity_dossier"),
    "dynamics.equations": ("euler_equations",),
    "dynamics.structure": ("Structure",),
    "inertia.solids": ("Solid", "solid"),
    "proof.derivation": ("Derivation", "ProofError"),
    "proof.page": ("Step",),
    "catalogue": ("derivation",),
    "exact": ("normal_form",),
    "exact.evidence": ("Counterexample",),
    "checker.interface": ("RefusedClaims", "check", "check_file"),
    "checker.recognition.identification": ("identify",),
    "checker.verdict": ("Diagnosis", "Dimensions", "Identification", "Repair", "Verdict"),
    "exercises.exercise": ("Datum", "Equation", "Exercise", "Question"),
    "exercises.sheet": ("ExerciseSheet", "exercise"),
    "exercises.grading.mark": ("Grades", "Mark"),
    "exercises.grading.grade": ("grade",),
    "exchange.inertial": ("Inertial",),
    "exchange.mesh": ("mesh",),
    "exchange.robot": ("Link", "link", "links"),
    "exchange.robot_text": ("write_link",),
    "scene.body": ("Body",),
    "scene.torque": ("Torque",),
    "scene.samples": ("Table",),
    "scene.tables": ("Initial", "Output", "Span"),
    "scene.scene": ("Scene", "load_scene", "shipped_scenes"),
    "planning.plan": ("Plan",),
    "planning.rules": ("RuleOutcome",),
    "planning.scene_kernel": ("SceneKernel",),
    "ensemble.ensemble": ("Ensemble", "EnsembleMember", "EnsembleStats", "propagate_ensemble"),
    "workshop.certification": (
        "Audit",
        "Certificate",
        "LargestBox",
        "OutputError",
        "RoundingBounds",
        "audit",
        "bound",
        "certify",
        "largest_box",
    ),
    "workshop.sympy_mechanics": ("from_sympy", "to_sympy"),
    "workshop.emit": ("Emitted", "emit", "explain", "kernel_names", "plan"),
    "propagation.events.event": ("Event",),
    "propagation.method": ("METHODS",),
    "propagation.propagate": ("propagate", "propagator"),
    "propagation.propagator": ("Propagator",),
    "propagation.steppers.stats": ("Stats",),
    "propagation.trajectory": ("Invariant", "Trajectory"),
    "report.output": ("save",),
    "report.plot": ("plot",),
    "results.saved": ("SavedTrajectory", "load"),
    "results.sensitivity": ("Sensitivities", "Sensitivity", "SwitchSlopes"),
    "sweeps.sweep": ("Sweep", "sweep"),
    "viewer.show": ("show",),
    "notebook.show": ("in_notebook",),
}
_MODULE = {name: module for module, names in _NAMES_OF_MODULES.items() for name in names}
_RENAMED = {"dcm_of": "quaternion_to_dcm", "qmul": "quaternion_product"}

__all__ = ["__version__", *sorted(_MODULE)]


def __getattr__(name: str) -> Any:
    if name in _RENAMED:
        from warnings import warn

        warn(f"symrot.{name} is now symrot.{_RENAMED[name]}", DeprecationWarning, stacklevel=2)
        return __getattr__(_RENAMED[name])
    if name not in _MODULE:
        raise AttributeError(f"module 'symrot' has no attribute {name!r}")
    value = getattr(import_module(f"symrot.{_MODULE[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
