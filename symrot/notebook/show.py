"""The function that returns the HTML or Markdown with which a notebook displays an object of symrot."""

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any

from symrot.errors import InputError

__all__ = ["in_notebook"]

RENDERERS: Mapping[str, tuple[str, str]] = {
    "Trajectory": ("symrot.viewer.show", "in_frame"),
    "Scene": ("symrot.notebook.scenes", "scene"),
    "Plan": ("symrot.notebook.scenes", "plan"),
    "Propagator": ("symrot.notebook.scenes", "propagator"),
    "Ensemble": ("symrot.notebook.scenes", "ensemble"),
    "Verdict": ("symrot.notebook.verdicts", "verdict"),
    "Identification": ("symrot.notebook.verdicts", "identification"),
    "Page": ("symrot.notebook.formulas", "derivation"),
    "Step": ("symrot.notebook.formulas", "step"),
    "Solid": ("symrot.notebook.formulas", "solid"),
    "SingularityDossier": ("symrot.notebook.formulas", "dossier"),
    "Emitted": ("symrot.notebook.formulas", "kernel"),
}
"""Name of a class -> module and function that turn its values into HTML or Markdown."""


def in_notebook(value: Any) -> str:
    """Return the HTML or Markdown that shows a value of symrot in a notebook.

    A notebook calls this function through ``_repr_html_`` and ``_repr_markdown_`` of the value.

    Parameters
    ----------
    value : Trajectory, Scene, Plan, Propagator, Ensemble, Verdict, Identification, Derivation, Step, Solid, \
SingularityDossier or Emitted

    Returns
    -------
    str
        For a trajectory, an ``iframe`` with the page that plays the motion; Markdown for derivations, steps, solids,
        singularities and kernels; tables in HTML for the others.

    Raises
    ------
    InputError
        For a value of another type, for a trajectory that reached none of its sample times or has only one time, and
        for a trajectory without attitude whose torque is a Python function.

    Examples
    --------
    >>> import symrot
    >>> symrot.in_notebook(symrot.propagate("t_handle")).startswith("<iframe")
    True
    """
    name = next((kind.__name__ for kind in type(value).__mro__ if kind.__name__ in RENDERERS), None)
    if name is None or not type(value).__module__.startswith("symrot."):
        raise InputError(f"expected an object of one of the types {', '.join(RENDERERS)}, got {type(value).__name__}")
    module, function = RENDERERS[name]
    render: Callable[[Any], str] = getattr(import_module(module), function)
    return render(value)
