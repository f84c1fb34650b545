"""The types of the public names of symrot, which ``__init__.py`` imports at their first use."""

from symrot.catalogue import derivation
from symrot.checker.interface import RefusedClaims, check, check_file
from symrot.checker.recognition.identification import identify
from symrot.checker.verdict import Diagnosis, Dimensions, Identification, Repair, Verdict
from symrot.conventions import SEQUENCES
from symrot.dynamics.equations import euler_equations
from symrot.dynamics.structure import Structure
from symrot.ensemble.ensemble import Ensemble, EnsembleMember, EnsembleStats, propagate_ensemble
from symrot.errors import CertificateError, CompilerError, InputError, PropagationError, SymrotError
from symrot.exact.decide import normal_form
from symrot.exact.evidence import Counterexample
from symrot.exchange.inertial import Inertial
from symrot.exchange.mesh import mesh
from symrot.exchange.robot import Link, link, links
from symrot.exchange.robot_text import write_link
from symrot.exercises.exercise import Datum, Equation, Exercise, Question
from symrot.exercises.grading.grade import grade
from symrot.exercises.grading.mark import Grades, Mark
from symrot.exercises.sheet import ExerciseSheet, exercise
from symrot.inertia.solids import Solid, solid
from symrot.kinematics.chart import Limit, RateMatrix, SingularSet
from symrot.kinematics.dossier import LockedPoint, SingularityDossier, singularity_dossier
from symrot.kinematics.euler import EulerRateMatrix, dcm, rate_jacobian
from symrot.kinematics.quaternion import quaternion_product, quaternion_rates, quaternion_to_dcm
from symrot.notebook.show import in_notebook
from symrot.planning.plan import Plan
from symrot.planning.rules import RuleOutcome
from symrot.planning.scene_kernel import SceneKernel
from symrot.proof.derivation import Derivation, ProofError
from symrot.proof.page import Step
from symrot.propagation.events.event import Event
from symrot.propagation.method import METHODS
from symrot.propagation.propagate import propagate, propagator
from symrot.propagation.propagator import Propagator
from symrot.propagation.steppers.stats import Stats
from symrot.propagation.trajectory import Invariant, Trajectory
from symrot.report.output import save
from symrot.report.plot import plot
from symrot.results.saved import SavedTrajectory, load
from symrot.results.sensitivity import Sensitivities, Sensitivity, SwitchSlopes
from symrot.scene.body import Body
from symrot.scene.samples import Table
from symrot.scene.scene import Scene, load_scene, shipped_scenes
from symrot.scene.tables import Initial, Output, Span
from symrot.scene.torque import Torque
from symrot.sweeps.sweep import Sweep, sweep
from symrot.viewer.show import show
from symrot.workshop.certification import (
    Audit,
    Certificate,
    LargestBox,
    OutputError,
    RoundingBounds,
    audit,
    bound,
    certify,
    largest_box,
)
from symrot.workshop.emit import Emitted, emit, explain, kernel_names, plan
from symrot.workshop.sympy_mechanics import from_sympy, to_sympy

__version__: str

__all__ = [
    "METHODS",
    "SEQUENCES",
    "Audit",
    "Body",
    "Certificate",
    "CertificateError",
    "CompilerError",
    "Counterexample",
    "Datum",
    "Derivation",
    "Diagnosis",
    "Dimensions",
    "Emitted",
    "Ensemble",
    "EnsembleMember",
    "EnsembleStats",
    "Equation",
    "EulerRateMatrix",
    "Event",
    "Exercise",
    "ExerciseSheet",
    "Grades",
    "Identification",
    "Inertial",
    "Initial",
    "InputError",
    "Invariant",
    "LargestBox",
    "Limit",
    "Link",
    "LockedPoint",
    "Mark",
    "Output",
    "OutputError",
    "Plan",
    "ProofError",
    "PropagationError",
    "Propagator",
    "Question",
    "RateMatrix",
    "RefusedClaims",
    "Repair",
    "RoundingBounds",
    "RuleOutcome",
    "SavedTrajectory",
    "Scene",
    "SceneKernel",
    "Sensitivities",
    "Sensitivity",
    "SingularSet",
    "SingularityDossier",
    "Solid",
    "Span",
    "Stats",
    "Step",
    "Structure",
    "Sweep",
    "SwitchSlopes",
    "SymrotError",
    "Table",
    "Torque",
    "Trajectory",
    "Verdict",
    "__version__",
    "audit",
    "bound",
    "certify",
    "check",
    "check_file",
    "dcm",
    "derivation",
    "emit",
    "euler_equations",
    "exercise",
    "explain",
    "from_sympy",
    "grade",
    "identify",
    "in_notebook",
    "kernel_names",
    "largest_box",
    "link",
    "links",
    "load",
    "load_scene",
    "mesh",
    "normal_form",
    "plan",
    "plot",
    "propagate",
    "propagate_ensemble",
    "propagator",
    "quaternion_product",
    "quaternion_rates",
    "quaternion_to_dcm",
    "rate_jacobian",
    "save",
    "shipped_scenes",
    "show",
    "singularity_dossier",
    "solid",
    "sweep",
    "to_sympy",
    "write_link",
]
