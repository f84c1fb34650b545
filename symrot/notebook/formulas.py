"""Markdown for derivations, solids, singularities and kernels; a notebook typesets the formulas in it."""

from symrot.inertia.solids import Solid
from symrot.kinematics.dossier import SingularityDossier
from symrot.notebook.fragments import drawing, equation
from symrot.proof.derivation import Derivation
from symrot.proof.notation.printer import formula
from symrot.proof.page import Figure, Page, Step
from symrot.proof.pages.markdown import inline, markdown
from symrot.proof.pages.parts import equation as displayed
from symrot.proof.pages.parts import remarks
from symrot.workshop.derivation_pages import illustrated
from symrot.workshop.emit import Emitted

__all__ = ["derivation", "dossier", "kernel", "solid", "step"]

LANGUAGES = {"#include": "c", "import": "python", "export": "javascript"}


def derivation(page: Page) -> str:
    """Return a derivation or another page as Markdown with LaTeX formulas; its figures are embedded as SVG."""
    whole = illustrated(page) if isinstance(page, Derivation) else page
    text = inline(markdown(whole))
    for item in (*whole.opening, *whole.items):
        if isinstance(item, Figure):
            text = text.replace(f"![{item.title}]({item.file})", drawing(item.title, item.svg()))
    return text


def step(one: Step) -> str:
    """Return one step of a derivation (its claim, equation and reason) as Markdown."""
    return f"{one.claim}\n\n$$\n{displayed(one)}\n$$\n\n{' '.join(remarks(one))}"


def solid(body: Solid) -> str:
    """Return the mass, the centre of mass and the inertia tensor of a solid as Markdown with formulas.

    A mass that is a bare symbol and a centre at the origin are left out.
    """
    lengths = ", ".join(f"{name.replace('_', ' ')} ${formula(value)}$" for name, value in _lengths(body))
    title = f"**{body.name.replace('_', ' ')}**" + (f", {lengths}" if lengths else "")
    parts = [title, equation("m", body.mass)] if not body.mass.is_Symbol else [title]
    if any(body.center_of_mass):
        parts.append(equation("r_C", body.center_of_mass))
    return "\n\n".join([*parts, equation("I_C", body.inertia)])


def _lengths(body: Solid) -> list[tuple[str, object]]:
    return [(name, value) for name, value in body.dimensions.items() if hasattr(value, "free_symbols")]


def dossier(singularities: SingularityDossier) -> str:
    """Return Markdown about an Euler sequence: the matrix B, its determinant, and what happens at gimbal lock.

    B maps the rates of the Euler angles to the angular velocity in body components. At gimbal lock no rates rotate the
    body about a certain axis; the text names this axis, and the sequences that are regular there.
    """
    parts = [
        f"**Singularities of {singularities.sequence}**",
        equation(r"\omega_b = B\,\dot q, \quad B", singularities.jacobian_b),
        equation(r"\det B", singularities.determinant),
    ]
    for point in singularities.locked:
        middle = singularities.singular_set.variable
        parts.append(
            f"At ${formula(middle)} = {formula(point.middle)}$ the attitude depends on ${formula(point.combination)}$ "
            f"alone. No rates of the angles rotate the body about ${formula(point.lost_axis_b)}$ (body components)."
        )
    parts.append(f"Regular there: {', '.join(singularities.regular_sequences)}.")
    return "\n\n".join(parts)


def kernel(emitted: Emitted) -> str:
    """Return the text of an emitted kernel as a block of code in Markdown.

    A kernel is a function that symrot prints in a programming language from derived formulas.
    """
    language = next((name for word, name in LANGUAGES.items() if f"\n{word} " in emitted.source), "")
    return f"```{language}\n{emitted.source}```"
