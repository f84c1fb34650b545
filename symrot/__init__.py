"""symrot: rigid-body rotation from derivation to trajectory.

Formulas are derived by SymPy from first principles, proven, specialised to a scene, emitted as kernels and propagated.
Every name here is loaded when it is first used, so that ``import symrot`` costs next to nothing.
Conventions: :mod:`symrot.conventions`.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOMES = {
    "conventions": ("SEQUENCES",),
    "errors": ("CompilerError", "InputError", "PropagationError", "SymrotError"),
    "kinematics.euler": ("dcm", "rate_jacobian"),
    "kinematics.quaternion": ("dcm_of", "qmul", "quaternion_rates"),
    "kinematics.dossier": ("singularity_dossier",),
    "dynamics.equations": ("euler_equations",),
    "inertia.solids": ("solid",),
    "catalogue": ("derivation",),
    "exact": ("normal_form",),
    "checker": ("check", "check_file", "identify"),
    "scene.scene": ("Scene", "load_scene", "shipped_scenes"),
    "planning.plan": ("Plan",),
    "ensemble.ensemble": ("Ensemble", "propagate_ensemble"),
    "workshop.emit": ("emit", "explain", "kernel_names", "plan"),
    "propagation.events.events": ("Event",),
    "propagation.propagate": ("propagate", "propagator"),
    "propagation.propagator": ("Propagator",),
    "propagation.trajectory": ("Trajectory",),
}
_HOME = {name: module for module, names in _HOMES.items() for name in names}

__all__ = ["__version__", *sorted(_HOME)]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'symrot' has no attribute {name!r}")
    value = getattr(import_module(f"symrot.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
