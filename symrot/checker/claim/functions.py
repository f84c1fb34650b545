"""The built-in functions of claims, such as sin and cross, each with the function that evaluates it.

Every divisor that may be zero, and every formula under a root that may be negative, is recorded before SymPy can cancel
it.
"""

import re
from collections.abc import Callable, Mapping
from typing import Any

import sympy
from sympy import Expr, ImmutableMatrix
from sympy.core.function import AppliedUndef

from symrot import symbols
from symrot.checker.claim.integration import definite_integral
from symrot.checker.claim.scope import Divisor, Scope, is_matrix
from symrot.checker.claim.size import (
    LARGE_MATRIX,
    LARGEST_INVERSE,
    MOST_ANGLE_TERMS,
    MOST_DIFFERENTIATED,
    MOST_PRODUCTS,
    products_of_determinant,
    terms_of_angle,
)
from symrot.checker.claim.tree import Node
from symrot.errors import InputError
from symrot.exact.intervals import enclosure
from symrot.exact.limits.size import pieces
from symrot.kinematics.quaternion import quaternion_product, quaternion_to_dcm
from symrot.kinematics.rotations import elementary_rotation, skew, vee

__all__ = ["BUILT_IN", "ROTATIONS", "arguments_expected", "inverted"]

LARGEST_MATRIX = 12

ROTATIONS = {f"R{bar}{axis}": axis.upper() for bar in ("", "_") for axis in "xyz"}
"""Maps a function to the axis of its rotation. Without brackets, R_x is a symbol; with an angle, R_x(a) is a
function."""


def _of_scalar(function: Callable[[Expr], Expr], below: Callable[[Expr], Expr] | None = None) -> Any:
    """Return a function (scope, tree) -> SymPy expression, which evaluates trees of calls such as ``tan(x)``.

    The scope has the values of names. ``below`` returns the denominator of the value, cos(x) for tan(x), which is
    recorded as a divisor that may be zero.
    """

    def call(scope: Scope, node: Node) -> Expr:
        value = scope.argument(node.args[0], f"as the argument of {node.value}")
        if terms_of_angle(value) > MOST_ANGLE_TERMS:
            raise scope.fail(node.args[0], f"an angle whose sine has at most {MOST_ANGLE_TERMS} terms when expanded")
        if below is not None:
            scope.divide_by(below(value), node)
        made = function(value)
        if value.is_number and not made.is_Rational and enclosure(made) is None:
            raise scope.fail(node, "a number whose digits symrot can compute (with fewer functions inside one another)")
        return made

    return call


def _sqrt(scope: Scope, node: Node) -> Expr:
    value = scope.argument(node.args[0], "under the root")
    scope.take_root(value, node.args[0])
    return sympy.sqrt(value)


def _abs(scope: Scope, node: Node) -> Expr:
    """Return the value of ``abs(x)``: the absolute value of a scalar, or the length of a column vector."""
    value = scope.evaluate(node.args[0])
    if is_matrix(value) and value.cols == 1:
        return sympy.sqrt(value.dot(value))
    return _of_scalar(sympy.Abs)(scope, node)


def _atan2(scope: Scope, node: Node) -> Expr:
    y, x = (scope.argument(argument, "as an argument of atan2") for argument in node.args)
    scope.divide_by(x**2 + y**2, node)
    return sympy.atan2(y, x)


def _arc(function: Callable[[Expr], Expr]) -> Any:
    """Return the evaluator of asin or acos; it raises InputError if the argument is a number outside of -1 to 1."""

    def call(scope: Scope, node: Node) -> Expr:
        value = scope.argument(node.args[0], f"as the argument of {node.value}")
        if (1 - value**2).is_negative:
            raise scope.fail(node.args[0], f"a number from -1 to 1 in {node.value}")
        scope.take_root(1 - value**2, node.args[0])
        result = function(value)
        # SymPy takes acos(tanh(10)) for zero, since it rounds tanh(10) to 1
        return sympy.pi / 2 - sympy.asin(value) if result.is_zero and result != 0 and function == sympy.acos else result

    return call


def _log(scope: Scope, node: Node) -> Expr:
    value = scope.argument(node.args[0], "as the argument of log")
    if value.is_nonpositive:
        raise scope.fail(node.args[0], "a positive number in log")
    scope.divide_by(value, node.args[0])
    scope.take_root(value, node.args[0])
    return sympy.log(value)


def _extreme(scope: Scope, node: Node) -> Expr:
    """Return the value of ``max(x, y)`` or ``min(x, y)``: the mean of x and y, plus or minus half their distance."""
    first, second = (scope.scalar(part, f"as an argument of {node.value}") for part in node.args)
    distance = sympy.Abs(first - second)
    return (first + second + (distance if node.value == "max" else -distance)) / 2


def _part(scope: Scope, node: Node) -> Expr:
    """Return the value of ``Re(x)`` or ``Im(x)`` of a real formula x: the formula itself, or zero."""
    value = scope.scalar(node.args[0], f"as the argument of {node.value}")
    return value if node.value == "real_part" else sympy.S.Zero


def _rotation(axis: str) -> Any:
    return lambda scope, node: elementary_rotation(axis, scope.scalar(node.args[0], "as an angle"))


def _components(scope: Scope, node: Node, size: int) -> list[Expr]:
    """Return the components in a call such as ``skew(a, b, c)``: its ``size`` arguments, or the entries of the column
    of this size that is its only argument. Raise InputError for other arguments.
    """
    if len(node.args) == size:
        return [scope.scalar(argument, f"as a component in {node.value}") for argument in node.args]
    if len(node.args) != 1:
        raise scope.fail(node, f"{size} components, or one column of them, as arguments of {node.value}")
    return list(scope.matrix(node.args[0], f"as the argument of {node.value}", (size, 1)))


def _skew(scope: Scope, node: Node) -> ImmutableMatrix:
    return skew(_components(scope, node, 3))


def _vee(scope: Scope, node: Node) -> ImmutableMatrix:
    matrix = scope.matrix(node.args[0], "as the argument of vee", (3, 3))
    if not (matrix + matrix.T).applyfunc(sympy.expand).is_zero_matrix:
        from symrot.exact import is_zero

        if not is_zero(matrix + matrix.T):
            raise scope.fail(node.args[0], "a skew-symmetric matrix as the argument of vee")
    return vee(matrix)


def _cross(scope: Scope, node: Node) -> ImmutableMatrix:
    left, right = (scope.matrix(argument, "as an argument of cross", (3, 1)) for argument in node.args)
    return ImmutableMatrix(left.cross(right))


def _dot(scope: Scope, node: Node) -> Expr:
    left = scope.matrix(node.args[0], "as an argument of dot", (None, 1))
    right = scope.matrix(node.args[1], "as an argument of dot", (left.rows, 1))
    return left.dot(right)


def _square(scope: Scope, node: Node) -> ImmutableMatrix:
    """Return the matrix in a call such as ``det(A)``; raise InputError unless it is square and not too large."""
    matrix = scope.matrix(node.args[0], f"as the argument of {node.value}")
    if matrix.rows != matrix.cols or matrix.rows > LARGEST_MATRIX:
        raise scope.fail(node.args[0], f"a square matrix of at most {LARGEST_MATRIX} x {LARGEST_MATRIX} entries")
    return matrix


def _det(scope: Scope, node: Node) -> Expr:
    return _determinant(scope, _square(scope, node), node.args[0], MOST_PRODUCTS)


def _determinant(scope: Scope, matrix: ImmutableMatrix, node: Node, most_products: int) -> Expr:
    """Return a determinant; raise InputError if it expands to more than ``most_products`` products of entries."""
    products = products_of_determinant(matrix)
    if products > most_products:
        raise scope.fail(node, _smaller_determinant(most_products, products))
    return _by_cofactors(matrix) if pieces(matrix) > LARGE_MATRIX else matrix.det(method="berkowitz")


def _smaller_determinant(most: int, products: int) -> str:
    """Return words for an error message: a determinant expands to ``products`` products, more than ``most``."""
    return f"a smaller matrix (its determinant expands to {products} products of entries, symrot takes at most {most})"


def _by_cofactors(matrix: ImmutableMatrix) -> Expr:
    """Return a determinant by cofactor expansion. The products in the sum are not multiplied out."""
    if matrix.rows == 1:
        return matrix[0, 0]
    rest = matrix[1:, :]
    minors = [ImmutableMatrix.hstack(rest[:, :column], rest[:, column + 1 :]) for column in range(matrix.cols)]
    places = [column for column in range(matrix.cols) if matrix[0, column] != 0]
    return sympy.Add(*((-1) ** place * matrix[0, place] * _by_cofactors(minors[place]) for place in places))


def _inverse_of(scope: Scope, node: Node) -> ImmutableMatrix:
    return inverted(scope, _square(scope, node), node.args[0])


def inverted(scope: Scope, matrix: ImmutableMatrix, node: Node) -> ImmutableMatrix:
    """Return the inverse of a matrix, and record its determinant as a divisor.

    Raise InputError if the determinant is zero or expands to more than LARGEST_INVERSE products of entries.
    """
    determinant = _determinant(scope, matrix, node, LARGEST_INVERSE)
    from symrot.exact import normal_form

    shortest = normal_form(determinant)
    if shortest == 0:
        raise scope.fail(node, "a matrix whose determinant is not zero")
    scope.divide_by(shortest, node)
    return matrix.adjugate(method="berkowitz") / shortest


def _adjugate(scope: Scope, node: Node) -> ImmutableMatrix:
    matrix = _square(scope, node)
    products = products_of_determinant(matrix)
    if products > LARGEST_INVERSE:
        raise scope.fail(node.args[0], _smaller_determinant(LARGEST_INVERSE, products))
    return matrix.adjugate(method="berkowitz")


def _trace(scope: Scope, node: Node) -> Expr:
    return _square(scope, node).trace()


def _transpose_of(scope: Scope, node: Node) -> ImmutableMatrix:
    return scope.matrix(node.args[0], "as the argument of transpose").T


def _eye(scope: Scope, node: Node) -> ImmutableMatrix:
    size = scope.scalar(node.args[0], "as a size")
    if not (size.is_Integer and 1 <= size <= LARGEST_MATRIX):
        raise scope.fail(node.args[0], f"a size from 1 to {LARGEST_MATRIX}")
    return ImmutableMatrix(sympy.eye(int(size)))


def _diag(scope: Scope, node: Node) -> ImmutableMatrix:
    return ImmutableMatrix(sympy.diag(*(scope.scalar(a, "on the diagonal") for a in node.args)))


def _matrix(scope: Scope, node: Node) -> ImmutableMatrix:
    rows = scope.evaluate(node.args[0])
    return rows if is_matrix(rows) else _of_blocks(scope, node, rows)


def _of_blocks(scope: Scope, node: Node, rows: Any) -> ImmutableMatrix:
    """Return a matrix from rows of scalars or of blocks (smaller matrices). A zero may stand for a block of zeros."""
    rows = rows if isinstance(rows, tuple) else ()
    rows = tuple(row if isinstance(row, tuple) else (row,) for row in rows)
    cells = [cell for row in rows for cell in row]
    if len({len(row) for row in rows}) != 1 or any(isinstance(cell, tuple) for cell in cells):
        raise scope.fail(node, "rows of scalars of equal length, as in Matrix([[a, b], [c, d]])")
    heights = [max(cell.rows if is_matrix(cell) else 1 for cell in row) for row in rows]
    widths = [max(cell.cols if is_matrix(cell) else 1 for cell in column) for column in zip(*rows, strict=True)]
    if max(sum(heights), sum(widths)) > LARGEST_MATRIX:
        raise scope.fail(node, f"a matrix of at most {LARGEST_MATRIX} x {LARGEST_MATRIX}")
    lines = []
    for row, height in zip(rows, heights, strict=True):
        blocks = [_block(cell, height, width) for cell, width in zip(row, widths, strict=True)]
        if None in blocks:
            raise scope.fail(node, "blocks that fit together, or rows of scalars of equal length")
        lines.append(ImmutableMatrix.hstack(*blocks))
    return ImmutableMatrix.vstack(*lines)


def _block(cell: Any, height: int, width: int) -> ImmutableMatrix | None:
    """Return an entry of a block matrix ``[[A, b], [0, 1]]`` as a matrix of ``height`` x ``width``.

    Return None if the entry has another height or width.
    """
    # a scalar 0 stands for a zero matrix of any size
    if cell == 0 and not is_matrix(cell):
        return ImmutableMatrix.zeros(height, width)
    matrix = cell if is_matrix(cell) else ImmutableMatrix([[cell]])
    return matrix if matrix.shape == (height, width) else None


def _hstack(scope: Scope, node: Node) -> ImmutableMatrix:
    first = scope.matrix(node.args[0], "in hstack")
    rest = [scope.matrix(argument, "in hstack", (first.rows, None)) for argument in node.args[1:]]
    return ImmutableMatrix.hstack(first, *rest)


def _qmul(scope: Scope, node: Node) -> ImmutableMatrix:
    return quaternion_product(*(_quaternion(scope, argument) for argument in node.args))


def _quaternion(scope: Scope, node: Node) -> ImmutableMatrix:
    """Return the four components of a quaternion, scalar part first: 0 and the components of v for a vector v."""
    value = scope.evaluate(node)
    if isinstance(value, tuple):
        value = _of_blocks(scope, node, value)
    if is_matrix(value) and value.shape == (3, 1):
        return ImmutableMatrix([0, *value])
    return scope.matrix(node, "as a quaternion", (4, 1)) if getattr(value, "shape", ()) != (4, 1) else value


def _conjugate(scope: Scope, node: Node) -> ImmutableMatrix:
    scalar, *vector = _quaternion(scope, node.args[0])
    return ImmutableMatrix([scalar, *(-component for component in vector)])


def _vector_part(scope: Scope, node: Node) -> ImmutableMatrix:
    return ImmutableMatrix(_quaternion(scope, node.args[0])[1:, :])


def _dcm_of(scope: Scope, node: Node) -> ImmutableMatrix:
    components = dict(zip(symbols.quaternion, _components(scope, node, 4), strict=True))
    # nothing is multiplied out: components may be long
    return quaternion_to_dcm(form="homogeneous").xreplace(components)


def _diff(scope: Scope, node: Node) -> Any:
    formula = scope.evaluate(node.args[0])
    scope.shape(formula, node.args[0])
    last = None
    for argument in node.args[1:]:
        variable = scope.scalar(argument, "as the variable of differentiation")
        times = 1
        if variable.is_Integer and last is not None and 1 <= variable <= 9:
            variable, times = last, int(variable) - 1
        elif not (variable.is_Symbol or isinstance(variable, AppliedUndef) or _is_rate(variable)):
            raise scope.fail(
                argument, "a symbol, a function of t or its time derivative as the variable of differentiation"
            )
        for _ in range(times):
            formula = scope.bounded(formula, node, MOST_DIFFERENTIATED).diff(variable)
        last = variable
    return formula


def _is_rate(value: Expr) -> bool:
    return bool(value.is_Derivative) and isinstance(value.expr, AppliedUndef)


def _integrate(scope: Scope, node: Node) -> Any:
    """Return an integral; a vector or matrix is integrated entry by entry.

    The divisors of the integral are recorded.

    Raises
    ------
    InputError
        If the integrand has a divisor that contains the variable of integration and may be zero, or a root of a formula
        that contains this variable and may be negative. Also for a wrong range, and for an integral that symrot cannot
        compute.
    """
    integrand, *ranges = node.args
    limits = []
    for place in ranges:
        if place.kind != "list" or len(place.args) != 3:
            raise scope.fail(place, "a range (x, from, to) after the integrand")
        variable = scope.scalar(place.args[0], "to integrate over")
        lower, upper = (scope.scalar(limit, "as a limit of an integral") for limit in place.args[1:])
        is_inside = lower.has(variable) or upper.has(variable)
        # books write the integral of f(t) dt from 0 to t
        if not variable.is_Symbol or (is_inside and (len(ranges) > 1 or str(variable) != "t")):
            raise scope.fail(place, "a symbol to integrate over that does not occur in its limits")
        limits.append((variable, lower, upper))
    divisors_before, radicands_before = len(scope.divisors), len(scope.radicands)
    total = scope.evaluate(integrand)
    scope.shape(total, integrand)
    needs = [d.value for d in scope.divisors[divisors_before:] if not d.value.is_nonzero]
    needs += [radicand for radicand in scope.radicands[radicands_before:] if not radicand.is_nonnegative]
    if any(need.has(variable) for need in needs for variable, _, _ in limits):
        raise scope.fail(integrand, "an integrand without the variable in divisors and under roots")
    for (variable, lower, upper), place in zip(limits, ranges, strict=True):
        entries = []
        inside = variable
        if lower.has(variable) or upper.has(variable):  # the inner t of an integral from 0 to t is another one
            inside = sympy.Dummy(str(variable), real=True)
        for written in total if is_matrix(total) else [total]:
            if inside != variable and written.atoms(AppliedUndef):
                raise scope.fail(place, f"a variable of integration other than {variable}, which is in the limits")
            entry = written.xreplace({variable: inside})
            try:
                value, divisors = definite_integral(entry, inside, lower, upper)
            except InputError as reason:
                raise scope.fail(place, f"an integral that symrot can compute ({reason})") from None
            scope.divisors.extend(Divisor(value, place) for value in divisors)
            entries.append(value)
        total = ImmutableMatrix(*total.shape, entries) if is_matrix(total) else entries[0]
    return total


COORDINATES = re.compile(r"[xyzr]|xi|eta|zeta|[rs]_[xyz123]")
"""Names of the coordinates of a point of a body."""


def _integral_over_body(scope: Scope, node: Node) -> Any:
    """Return an integral over a body of unknown shape, with one symbol for each product of coordinates: ``integral_xx``
    for ∫ x^2 dm.
    """
    value = scope.evaluate(node.args[0])
    scope.shape(value, node.args[0])
    if is_matrix(value):
        return value.applyfunc(lambda entry: _sum_of_moments(scope, node, entry))
    return _sum_of_moments(scope, node, value)


def _sum_of_moments(scope: Scope, node: Node, value: Expr) -> Expr:
    coordinates = [symbol for symbol in sorted(value.free_symbols, key=str) if COORDINATES.fullmatch(str(symbol))]
    if not value.is_polynomial(*coordinates):
        raise scope.fail(
            node.args[0], "a polynomial in the coordinates x, y and z to integrate over a body (as x**2*y)"
        )
    terms = sympy.Poly(value, *coordinates).terms() if coordinates else [((), value)]
    total = []
    for powers, factor in terms:
        name = "".join(str(symbol) * power for symbol, power in zip(coordinates, powers, strict=True))
        total.append(factor * sympy.Symbol(f"integral_{name or 1}", real=True))
    return sympy.Add(*total)


BUILT_IN: Mapping[str, tuple[int, int, Callable[[Scope, Node], Any]]] = {
    "sqrt": (1, 1, _sqrt),
    "sin": (1, 1, _of_scalar(sympy.sin)),
    "cos": (1, 1, _of_scalar(sympy.cos)),
    "tan": (1, 1, _of_scalar(sympy.tan, sympy.cos)),
    "cot": (1, 1, _of_scalar(sympy.cot, sympy.sin)),
    "sec": (1, 1, _of_scalar(sympy.sec, sympy.cos)),
    "csc": (1, 1, _of_scalar(sympy.csc, sympy.sin)),
    "asin": (1, 1, _arc(sympy.asin)),
    "acos": (1, 1, _arc(sympy.acos)),
    "atan": (1, 1, _of_scalar(sympy.atan)),
    "atan2": (2, 2, _atan2),
    "exp": (1, 1, _of_scalar(sympy.exp)),
    "log": (1, 1, _log),
    "sinh": (1, 1, _of_scalar(sympy.sinh)),
    "cosh": (1, 1, _of_scalar(sympy.cosh)),
    "tanh": (1, 1, _of_scalar(sympy.tanh)),
    "abs": (1, 1, _abs),
    "max": (2, 2, _extreme),
    "min": (2, 2, _extreme),
    "real_part": (1, 1, _part),
    "imaginary_part": (1, 1, _part),
    "diff": (2, 9, _diff),
    "integrate": (2, 9, _integrate),
    "integral_over_body": (1, 1, _integral_over_body),
    "Matrix": (1, 1, _matrix),
    "eye": (1, 1, _eye),
    "diag": (1, LARGEST_MATRIX, _diag),
    "hstack": (1, LARGEST_MATRIX, _hstack),
    "transpose": (1, 1, _transpose_of),
    "inverse": (1, 1, _inverse_of),
    "adjugate": (1, 1, _adjugate),
    "det": (1, 1, _det),
    "trace": (1, 1, _trace),
    **{name: (1, 1, _rotation(axis)) for name, axis in ROTATIONS.items()},
    "skew": (1, 3, _skew),
    "vee": (1, 1, _vee),
    "cross": (2, 2, _cross),
    "dot": (2, 2, _dot),
    "qmul": (2, 9, _qmul),
    "conjugate": (1, 1, _conjugate),
    "vector_part": (1, 1, _vector_part),
    "dcm_of": (1, 4, _dcm_of),
}
"""Maps the name of a function to the smallest and the largest number of its arguments, and the function that
evaluates it."""


def arguments_expected(node: Node) -> str:
    """Return words for an error message if a call of a built-in function has a wrong number of arguments, else ""."""
    least, most, _ = BUILT_IN[node.value]
    count = str(least) if least == most else f"{least} to {most}"
    wrong = not least <= len(node.args) <= most
    return f"{count} argument(s) of {node.value} instead of {len(node.args)}" if wrong else ""
