"""Inertia of the standard solids (cylinder, sphere, ..), by integration in coordinates fitted to each solid.

Beer & Johnston, Vector Mechanics, appendix.
"""

from collections import Counter
from collections.abc import Sequence

from sympy import Add, Expr, Matrix, diag, eye, factor_terms

from symrot import symbols
from symrot.catalogue.tools.integral import Stage, iterated
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import Solid, solid
from symrot.proof.derivation import Derivation

AXES = "xyz"
MEASURE = {"solid": "V", "surface": "S", "curve": r"\ell"}
PRODUCTS = ((0, 1), (0, 2), (1, 2))
LONG = 300  # characters of LaTeX
SPECIAL = {"tetrahedron": {"vertices": [(0, 0, 0), (symbols.a, 0, 0), (0, symbols.b, 0), (0, 0, symbols.c)]}}
"Tetrahedron with one corner at the origin and three edges along the axes; a linear map and a shift turn it into any "
"other tetrahedron."

Moments = dict[tuple[int, ...], Expr]


def derive() -> Derivation:
    d = Derivation(
        "standard_solids",
        title="Inertia of the standard solids",
        source="Beer, Johnston & Cornwell, *Vector Mechanics for Engineers: Dynamics*, appendix; Goldstein, Poole & "
        "Safko, "
        "*Classical Mechanics*, 3rd ed., section 5.3",
        about=(
            "A map from coordinates with given limits describes each uniform body of mass $m$. Its measure (volume, "
            "area or length), centre of mass and second moments are iterated integrals of the map's Jacobian, "
            "computed from the innermost integral outward. Each antiderivative is proven by differentiation. The "
            "inertia tensor about the centre of mass follows from the second moments."
        ),
    )
    d.passage(
        r"Let $S_{xy} = \int x\,y\,dm$ and so on be the second moments about the origin of the given axes, and $c$ "
        "the centre of mass. Then the inertia tensor about the centre of mass is",
        ("I", r"\mathrm{tr}\,S\;\mathbf{1} - S - m \left( |c|^2\,\mathbf{1} - c\,c^{\mathsf T} \right)"),
    )
    for name, shape in SHAPES.items():
        if shape.position:
            _shape(d, solid(name, **SPECIAL.get(name, {})))
    return d


def _shape(d: Derivation, body: Solid) -> None:
    coordinates = [variable for variable, _, _ in body.limits]
    letter = MEASURE[body.shape.kind]
    d.section(body.name.replace("_", " ").capitalize())
    axes = body.shape.axes
    d.passage(
        f"{axes[0].upper()}{axes[1:].rstrip('.')}. The map, with {_limits(body)}:",
        (r"(x, y, z)^{\mathsf T}", body.position),
    )
    columns = body.position.jacobian(coordinates)
    d.step(
        "The Jacobian of the map is:",
        (columns.T * columns).det(method="berkowitz"),
        body.jacobian**2,
        because="the square of the measure of a cell is the determinant of the scalar products of its edges",
        named=r"J^2 = \det \left( \frac{\partial (x,y,z)}{\partial ("
        + ",".join(map(_latex, coordinates))
        + r")}^{\mathsf T} "
        r"\frac{\partial (x,y,z)}{\partial (" + ",".join(map(_latex, coordinates)) + r")} \right)",
        display=None if body.jacobian.is_number else rf"\left( {_latex(body.jacobian)} \right)^2",
    )
    d.step(
        "The measure of the body is:",
        _integral(body, ()),
        body.measure,
        because=_antiderivatives(body, ()),
        via=_between(body, ()),
        named=rf"{letter} = {_integral_sign(body, ())}",
    )
    _moments(d, body, letter)


def _limits(body: Solid) -> str:
    """Return the limits of the integration coordinates of a solid in words, such as ``$r$ from $0$ to $R$``."""
    return ", ".join(f"${_latex(u)}$ from ${_latex(low)}$ to ${_latex(high)}$" for u, low, high in body.limits)


def _moments(d: Derivation, body: Solid, letter: str) -> None:
    moments: Moments = {}
    products: list[tuple[int, ...]] = [(0,), (1,), (2,), (0, 0), (1, 1), (2, 2), *PRODUCTS]
    values = {step.quantity: step.value for step in body.steps}
    for axes in products:
        moments[axes] = body.density * _integral(body, axes)
    zero = [axes for axes in products if values[_quantity(axes)] == 0]
    if zero:
        d.step(
            "These first and second moments are zero.",
            Matrix([moments[axes] for axes in zero]),
            0,
            because="each of these integrals is zero; they are computed like the following integrals",
            named=r"\frac{m}{" + letter + r"} \int \left( " + r",\ ".join(_product(axes) for axes in zero)
            + rf" \right) d{letter}",
        )  # fmt: skip
    for axes in products:
        if axes not in zero and len(axes) == 1:
            d.step(
                f"The coordinate ${AXES[axes[0]]}$ of the centre of mass is:",
                moments[axes] / symbols.m,
                body.center_of_mass[axes[0]],
                because=_antiderivatives(body, axes),
                via=_between(body, axes),
                named=rf"c_{AXES[axes[0]]} = \frac{{1}}{{{letter}}} {_integral_sign(body, axes)}",
            )
        elif axes not in zero:
            d.step(
                f"The second moment of ${_product(axes)}$ is:",
                moments[axes],
                values[_quantity(axes)],
                because=_antiderivatives(body, axes),
                via=_between(body, axes),
                named=rf"S_{{{''.join(AXES[i] for i in axes)}}} = \frac{{m}}{{{letter}}} {_integral_sign(body, axes)}",
            )
    _tensor(d, body, moments)


def _tensor(d: Derivation, body: Solid, moments: Moments) -> None:
    second = diag(*(moments[i, i] for i in range(3)))
    for i, j in PRODUCTS:
        second[i, j] = second[j, i] = moments[i, j]
    center = Matrix([moments[i,] for i in range(3)]) / body.mass
    about_origin = second.trace() * eye(3) - second
    d.step(
        "The inertia tensor about the centre of mass is:",
        about_origin - body.mass * (center.dot(center) * eye(3) - center * center.T),
        body.inertia,
        because="a moment is the integral of the sum of two squares, a product of inertia has a minus sign, "
        "and the parallel axis theorem is applied",
        named="I",
    )


def _stages(body: Solid, axes: Sequence[int]) -> tuple[Expr, tuple[Stage, ...]]:
    """Return (constant, stages): the integral of a product of coordinates over the solid ``body``, ready to be printed.

    ``axes`` lists the factors of the product: 0 for x, 1 for y, 2 for z; (0, 0) stands for x^2. ``constant`` is a
    factor before the integral. ``stages`` has one :class:`Stage` for each integration, the innermost first.
    """
    coordinates = [variable for variable, _, _ in body.limits]
    constant, weight = body.jacobian.as_independent(*coordinates, as_Add=False)
    for axis in axes:
        weight = weight * body.position[axis]
    return constant, iterated(weight, body.limits)


def _integral(body: Solid, axes: Sequence[int]) -> Expr:
    """Return the integral of a product of coordinates x, y, z over a solid, in closed form.

    ``axes`` contains the numbers of the factors: (0, 0) for x^2, (0, 1) for x y, () for the volume.
    """
    constant, stages = _stages(body, axes)
    return constant * stages[-1].value


def _antiderivatives(body: Solid, axes: Sequence[int]) -> str:
    """Return the antiderivatives of an integral over a solid as text for the reason of a step, the innermost first.

    If the text would be long, only the last antiderivative is in it.
    """
    constant, stages = _stages(body, axes)
    formulas = [f"${_latex(factor_terms(stage.antiderivative))}$ in ${_latex(stage.variable)}$" for stage in stages]
    before = "" if constant == 1 else f", without the constant factor ${_latex(constant)}$"
    if sum(map(len, formulas)) > LONG:
        return (
            f"the integrals are computed from the innermost outward{before}; the last antiderivative is {formulas[-1]}"
        )
    return f"the antiderivatives are {', then '.join(formulas)}{before}"


def _between(body: Solid, axes: Sequence[int]) -> list[tuple[str, Expr, Expr]]:
    """Return, for each integration, the line (words, left, right) that inserts the limits into the antiderivative.

    ``axes`` lists the factors of the integrand: 0 for x, 1 for y, 2 for z.
    """
    equations = []
    for stage in _stages(body, axes)[1]:
        upper, lower = (stage.antiderivative.subs(stage.variable, end) for end in (stage.upper, stage.lower))
        limits = f"from ${_latex(stage.lower)}$ to ${_latex(stage.upper)}$"
        antiderivative = f"with the antiderivative ${_latex(stage.antiderivative)}$"
        words = f"Integration over ${_latex(stage.variable)}$ {limits}, {antiderivative}:"
        equations.append((words, upper if lower == 0 else Add(upper, -lower, evaluate=False), stage.value))
    return equations


def _integral_sign(body: Solid, axes: Sequence[int]) -> str:
    signs = "".join(rf"\int_{{{_latex(low)}}}^{{{_latex(high)}}} " for _, low, high in reversed(body.limits))
    measure = "".join(rf"\,d{_latex(variable)}" for variable, _, _ in body.limits)
    factors = Counter(factor for factor in (*(body.position[axis] for axis in axes), body.jacobian) if factor != 1)
    integrand = r"\,".join(_factor(factor, power) for factor, power in factors.items())
    return f"{signs}{integrand}{measure}"


def _factor(factor: Expr, power: int) -> str:
    text = _latex(factor)
    if factor.is_Add or factor.could_extract_minus_sign() or (power > 1 and not factor.is_Symbol):
        text = rf"\left( {text} \right)"
    return f"{text}^{power}" if power > 1 else text


def _product(axes: Sequence[int]) -> str:
    if len(axes) == 2 and axes[0] == axes[1]:
        return f"{AXES[axes[0]]}^2"
    return r"\,".join(AXES[axis] for axis in axes)


def _quantity(axes: Sequence[int]) -> str:
    kind = {1: "first", 2: "second"}[len(axes)]
    return f"{kind} moment {''.join(AXES[axis] for axis in axes)}"


def _latex(value: object) -> str:
    from symrot.proof.notation.printer import formula

    return formula(value)
