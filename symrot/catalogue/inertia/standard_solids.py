"""Inertia of the standard solids (cylinder, sphere, ..), by integration in coordinates fitted to each solid.

Beer & Johnston, Vector Mechanics, appendix.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from sympy import Add, Expr, Matrix, collect, degree, diag, eye, factor_terms

from symrot import symbols
from symrot.catalogue.tools.integral import Stage, iterated
from symrot.inertia.shapes import SHAPES
from symrot.inertia.solids import Solid, solid
from symrot.proof.derivation import Derivation, Step
from symrot.proof.notation.printer import formula

AXES = "xyz"
MEASURE = {"solid": "V", "surface": "S", "curve": r"\ell"}
PRODUCTS = ((0, 1), (0, 2), (1, 2))
LONG, WIDE = 300, 140  # characters of LaTeX of a reason, and of a cell of a table
EXAMPLE = "cone"
"""The body whose proof is printed in full; tables have a row for each other body."""
DRAWN = "The bodies with their axes"
"""Title of the section of the printed derivation with the figures of all bodies except :data:`EXAMPLE`."""
SPECIAL = {"tetrahedron": {"vertices": [(0, 0, 0), (symbols.a, 0, 0), (0, symbols.b, 0), (0, 0, symbols.c)]}}
"""Name of a body -> arguments of :func:`symrot.inertia.solids.solid` that simplify the body without loss of generality.

The tetrahedron has a corner at the origin and three edges along the axes; a linear map and a translation turn it into
any other tetrahedron."""

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
            "inertia tensor about the centre of mass follows from the second moments. The page shows this for the "
            "cone; the tables below give the results for the other bodies, each proven by its own integrals."
        ),
    )
    d.passage(
        r"Let $S_{xy} = \int x\,y\,dm$ and so on be the second moments about the origin of the given axes, and $c$ "
        "the centre of mass. Then the inertia tensor about the centre of mass is",
        ("I", r"\mathrm{tr}\,S\;\mathbf{1} - S - m \left( |c|^2\,\mathbf{1} - c\,c^{\mathsf T} \right)"),
    )
    d.section(f"The argument, for the {EXAMPLE}")
    _argument(d, solid(EXAMPLE))
    d.section("The other bodies")
    _tabulate(d, [solid(name, **SPECIAL.get(name, {})) for name, shape in SHAPES.items()
                  if shape.position and name != EXAMPLE])  # fmt: skip
    d.section(DRAWN)
    return d


def _argument(d: Derivation, body: Solid) -> None:
    axes = body.shape.axes
    d.passage(
        f"{axes[0].upper()}{axes[1:].rstrip('.')}. The map, with {_limits(body)}:",
        (r"(x, y, z)^{\mathsf T}", body.position),
    )
    _measure(d, body)
    _moments(d, body)


def _tabulate(d: Derivation, bodies: Sequence[Solid]) -> None:
    """Add three tables of ``bodies``: their parametrisations, their moments of inertia, and centres and products.

    A parametrisation maps the integration coordinates to the point (x, y, z). The third table has only bodies whose
    centre of mass is not the origin, or that have a product of inertia.
    """
    maps = []
    for body in bodies:
        jacobian, measure = (f"${formula(value)}$" for value in (body.jacobian, body.measure))
        cells = _title(body), _ranges(body), f"${formula(body.position)}$", jacobian, measure
        maps.append((cells, _measure(d, body, f"{_title(body)}: ")))
    d.tabulate(
        "The table has the map of each body, its Jacobian $J$ and its measure, which is a volume, an area or a length. "
        "$J^2$ is the determinant of the scalar products of the edges of a cell.",
        ("Body", "Coordinates", r"$(x, y, z)^{\mathsf T}$", "$J$", "Measure"),
        maps,
    )
    results = []
    for body in bodies:
        row = _title(body), *_moment_cells(body.inertia)
        results.append((row, _moments(d, body, f"{_title(body)}: ")))
    d.tabulate(
        "The table has the moments of inertia about axes through the centre of mass. `symrot derive standard_solids "
        "--step N --detail` prints each integral with its antiderivatives.",
        ("Body", "$I_{xx}$", "$I_{yy}$", "$I_{zz}$"),
        results,
    )
    d.tabulate(
        "The same steps prove the formulas for the centres of mass and the products of inertia. The bodies that are "
        "not in this table have their centre of mass at the origin, and their axes are principal axes.",
        ("Body", "$c$", "$I_{xy}$", "$I_{xz}$", "$I_{yz}$"),
        [
            ((_title(body), _center_cell(body), *_product_cells(body.inertia)), ())
            for body in bodies
            if any(body.center_of_mass) or not body.inertia.is_diagonal()
        ],
    )


def _title(body: Solid) -> str:
    return body.name.replace("_", " ").capitalize()


def _ranges(body: Solid) -> str:
    """Return the limits of the integration coordinates of a solid as LaTeX."""
    return _stack(rf"{formula(low)} \le {formula(u)} \le {formula(high)}" for u, low, high in body.limits)


def _stack(lines: Iterable[str]) -> str:
    """Return formulas as one cell of a table, each below the one before; ``$0$`` if there are none."""
    formulas = [*lines]
    if len(formulas) < 2:
        return f"${''.join(formulas) or '0'}$"
    return r"$\begin{matrix}" + r"\\".join(formulas) + r"\end{matrix}$"


def _center_cell(body: Solid) -> str:
    return _stack(f"c_{axis} = {formula(x)}" for axis, x in zip(AXES, body.center_of_mass, strict=True) if x != 0)


def _moment_cells(tensor: Matrix) -> list[str]:
    """Return the three moments of an inertia tensor as LaTeX; for a moment equal to I_xx, for instance, ``= I_xx``."""
    moments = [tensor[i, i].factor() for i in range(3)]
    cells = []
    for i, moment in enumerate(moments):
        first = AXES[moments.index(moment)]
        cells.append(_stack(_terms(moment)) if first == AXES[i] else f"$= I_{{{first}{first}}}$")
    return cells


def _terms(moment: Expr) -> Iterator[str]:
    """Yield a moment of inertia as LaTeX; a long one in parts, one for each power of the body's height h."""
    if len(formula(moment)) <= WIDE:
        yield formula(moment)
        return
    numerator, denominator = moment.as_numer_denom()
    powers = collect(numerator.expand(), symbols.h, evaluate=False)
    for number, (power, factor) in enumerate(sorted(powers.items(), key=lambda item: degree(item[0], symbols.h))):
        yield ("+ " if number else "") + formula((power * factor / denominator).factor())


def _product_cells(tensor: Matrix) -> list[str]:
    return [f"${formula(tensor[i, j].factor())}$" for i, j in PRODUCTS]


def _claim(prefix: str, claim: str) -> str:
    return f"{prefix}{claim[0].lower()}{claim[1:]}" if prefix else claim


def _measure(d: Derivation, body: Solid, prefix: str = "") -> list[Step]:
    """Add and return two steps: the Jacobian of the map from coordinates to points of a body, and the body's measure.

    The measure is the volume, area or length. The sentence that each step states begins with ``prefix``.
    """
    coordinates = [variable for variable, _, _ in body.limits]
    letter = MEASURE[body.shape.kind]
    columns = body.position.jacobian(coordinates)
    jacobian = d.step(
        _claim(prefix, "The Jacobian of the map is:"),
        (columns.T * columns).det(method="berkowitz"),
        body.jacobian**2,
        because="the square of the measure of a cell is the determinant of the scalar products of its edges",
        named=r"J^2 = \det \left( \frac{\partial (x,y,z)}{\partial ("
        + ",".join(map(formula, coordinates))
        + r")}^{\mathsf T} "
        r"\frac{\partial (x,y,z)}{\partial (" + ",".join(map(formula, coordinates)) + r")} \right)",
        display=None if body.jacobian.is_number else rf"\left( {formula(body.jacobian)} \right)^2",
    )
    measure = d.step(
        _claim(prefix, "The measure of the body is:"),
        _integral(body, ()),
        body.measure,
        because=_antiderivatives(body, ()),
        via=_between(body, ()),
        named=rf"{letter} = {_integral_sign(body, ())}",
    )
    return [jacobian, measure]


def _limits(body: Solid) -> str:
    """Return the limits of the integration coordinates of a solid in words, such as ``$r$ from $0$ to $R$``."""
    return ", ".join(f"${formula(u)}$ from ${formula(low)}$ to ${formula(high)}$" for u, low, high in body.limits)


def _moments(d: Derivation, body: Solid, prefix: str = "") -> list[Step]:
    """Add and return the steps that prove the first and second moments of a body and its inertia tensor.

    The sentence that each step states begins with ``prefix``, such as ``"Cone: "``.
    """
    letter, steps = MEASURE[body.shape.kind], []
    moments: Moments = {}
    products: list[tuple[int, ...]] = [(0,), (1,), (2,), (0, 0), (1, 1), (2, 2), *PRODUCTS]
    values = {step.quantity: step.value for step in body.steps}
    for axes in products:
        moments[axes] = body.density * _integral(body, axes)
    zero = [axes for axes in products if values[_quantity(axes)] == 0]
    if zero:
        none = d.step(
            _claim(prefix, "These first and second moments are zero."),
            Matrix([moments[axes] for axes in zero]),
            0,
            because="each of these integrals is zero; they are computed like the following integrals",
            named=r"\frac{m}{" + letter + r"} \int \left( " + r",\ ".join(_product(axes) for axes in zero)
            + rf" \right) d{letter}",
        )  # fmt: skip
        steps.append(none)
    for axes in products:
        if axes not in zero and len(axes) == 1:
            coordinate = d.step(
                _claim(prefix, f"The coordinate ${AXES[axes[0]]}$ of the centre of mass is:"),
                moments[axes] / symbols.m,
                body.center_of_mass[axes[0]],
                because=_antiderivatives(body, axes),
                via=_between(body, axes),
                named=rf"c_{AXES[axes[0]]} = \frac{{1}}{{{letter}}} {_integral_sign(body, axes)}",
            )
            steps.append(coordinate)
        elif axes not in zero:
            second = d.step(
                _claim(prefix, f"The second moment of ${_product(axes)}$ is:"),
                moments[axes],
                values[_quantity(axes)],
                because=_antiderivatives(body, axes),
                via=_between(body, axes),
                named=rf"S_{{{''.join(AXES[i] for i in axes)}}} = \frac{{m}}{{{letter}}} {_integral_sign(body, axes)}",
            )
            steps.append(second)
    return [*steps, _tensor(d, body, moments, prefix)]


def _tensor(d: Derivation, body: Solid, moments: Moments, prefix: str) -> Step:
    second = diag(*(moments[i, i] for i in range(3)))
    for i, j in PRODUCTS:
        second[i, j] = second[j, i] = moments[i, j]
    center = Matrix([moments[i,] for i in range(3)]) / body.mass
    about_origin = second.trace() * eye(3) - second
    return d.step(
        _claim(prefix, "The inertia tensor about the centre of mass is:"),
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
    formulas = [f"${formula(factor_terms(stage.antiderivative))}$ in ${formula(stage.variable)}$" for stage in stages]
    before = "" if constant == 1 else f", without the constant factor ${formula(constant)}$"
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
        limits = f"from ${formula(stage.lower)}$ to ${formula(stage.upper)}$"
        antiderivative = f"with the antiderivative ${formula(stage.antiderivative)}$"
        words = f"Integration over ${formula(stage.variable)}$ {limits}, {antiderivative}:"
        equations.append((words, upper if lower == 0 else Add(upper, -lower, evaluate=False), stage.value))
    return equations


def _integral_sign(body: Solid, axes: Sequence[int]) -> str:
    signs = "".join(rf"\int_{{{formula(low)}}}^{{{formula(high)}}} " for _, low, high in reversed(body.limits))
    measure = "".join(rf"\,d{formula(variable)}" for variable, _, _ in body.limits)
    factors = Counter(factor for factor in (*(body.position[axis] for axis in axes), body.jacobian) if factor != 1)
    integrand = r"\,".join(_factor(factor, power) for factor, power in factors.items())
    return f"{signs}{integrand}{measure}"


def _factor(factor: Expr, power: int) -> str:
    text = formula(factor)
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
