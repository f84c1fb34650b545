"""Principal axes and moments of inertia, the symmetry of a body, and the test that a body can have these moments.

Moments have 120 digits and count as equal if they agree to 2^-200: bodies whose moments differ in the last digit of a
double are distinguished, and a rotation keeps equal moments equal. Only the standard library is used.
"""

from decimal import Decimal, localcontext
from fractions import Fraction
from itertools import permutations
from typing import Any, NamedTuple

from symrot.errors import InputError, prefix
from symrot.formula.exact_numbers import NEGLIGIBLE, equal, read, show
from symrot.inertia.tensor import IDENTITY, Tensor, cross, determinant, dot, matrix, subtract, transpose

__all__ = ["Principal", "principal_axes", "require_admissible", "why_not_propagable"]

DIGITS = 120
_PAIRS = ((0, 1), (0, 2), (1, 2))
_LARGEST_DENOMINATOR = 10**40  # a moment is replaced by a fraction with such a denominator if that is an exact root

_Work = list[list[Decimal]]


class Principal(NamedTuple):
    """Principal moments and axes of a body, and its kind of symmetry."""

    # kg m^2; rational moments are exact, two equal moments are the same number
    moments: tuple[Fraction, Fraction, Fraction]
    # v_given = axes * v_principal: right-handed, orthonormal to 1e-110. The identity if the given axes are principal;
    # otherwise each principal axis gets number and direction of the closest given axis.
    axes: Tensor
    kind: str  # spherical | symmetric | asymmetric
    symmetry_axis: int | None  # 0, 1 or 2 for a symmetric body, otherwise None
    given_axes: bool  # whether the given axes are principal

    @property
    def flat(self) -> bool:
        """Whether all mass lies in a plane: the largest moment equals the sum of the other two."""
        small, middle, large = sorted(self.moments)
        return equal(small + middle, large)

    @property
    def needle(self) -> bool:
        """Whether all mass lies on a line or in a point: at least one moment is zero."""
        return min(self.moments) == 0


def _read_tensor(inertia: Any, where: str) -> Tensor:
    try:
        rows = matrix(inertia)
    except (TypeError, ValueError):
        raise InputError(
            f"{prefix(where)}expected an inertia tensor, 3 rows of 3 numbers in kg m^2, got {show(inertia)}"
        ) from None
    tensor = matrix([[e if isinstance(e, Fraction) else read(e, where) for e in row] for row in rows])
    largest = max(abs(entry) for row in tensor for entry in row)
    for i, j in _PAIRS:
        if abs(tensor[i][j] - tensor[j][i]) > largest * NEGLIGIBLE:
            raise InputError(
                f"{prefix(where)}expected a symmetric inertia tensor, got {float(tensor[i][j])!r} and "
                f"{float(tensor[j][i])!r} on either side of the diagonal"
            )
    return tensor


def _jacobi(tensor: Tensor) -> tuple[list[Decimal], _Work]:
    """Return eigenvalues and eigenvectors (columns) of a symmetric tensor by Jacobi's method, with 120 digits."""
    # Each step makes one entry beside the diagonal zero (Golub & Van Loan, section 8.5).
    work = [[Decimal(entry.numerator) / Decimal(entry.denominator) for entry in row] for row in tensor]
    vectors = [[Decimal(int(i == j)) for j in range(3)] for i in range(3)]
    scale = max(abs(entry) for row in work for entry in row)
    limit = scale.scaleb(5 - DIGITS)
    while any(work[p][q] for p, q in _PAIRS):
        for p, q in _PAIRS:
            if abs(work[p][q]) > limit:
                _eliminate(work, vectors, p, q)
            work[p][q] = work[q][p] = Decimal(0) if abs(work[p][q]) <= limit else work[p][q]
    return [work[i][i] for i in range(3)], vectors


def _eliminate(work: _Work, vectors: _Work, p: int, q: int) -> None:
    """Rotate the axes p and q by the smallest angle that makes ``work[p][q]`` zero; change tensor and axes in place."""
    # one step of Jacobi's method; the columns of vectors are the axes
    cotangent = (work[q][q] - work[p][p]) / (2 * work[p][q])  # of twice the rotation angle
    tangent = 1 / (abs(cotangent) + (cotangent * cotangent + 1).sqrt())
    tangent = tangent if cotangent >= 0 else -tangent
    cosine = 1 / (tangent * tangent + 1).sqrt()
    sine = tangent * cosine
    shift, r = tangent * work[p][q], 3 - p - q
    work[p][p], work[q][q] = work[p][p] - shift, work[q][q] + shift
    work[p][q] = work[q][p] = Decimal(0)
    work[r][p], work[r][q] = cosine * work[r][p] - sine * work[r][q], sine * work[r][p] + cosine * work[r][q]
    work[p][r], work[q][r] = work[r][p], work[r][q]
    for row in vectors:
        row[p], row[q] = cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]


def _root(tensor: Tensor, value: Decimal) -> Fraction:
    """Return the fraction near ``value`` that is exactly an eigenvalue of the tensor, or else ``value`` itself."""
    approximate = Fraction(value)
    exact = approximate.limit_denominator(_LARGEST_DENOMINATOR)
    shifted = subtract(tensor, tuple(tuple(exact * entry for entry in row) for row in IDENTITY))
    return exact if determinant(shifted) == 0 else approximate


def _closest_order(vectors: _Work) -> tuple[int, ...]:
    return max(permutations(range(3)), key=lambda order: sum(abs(vectors[i][order[i]]) for i in range(3)))


def _directed(columns: list[tuple[Fraction, ...]]) -> Tensor:
    """Return principal axes as the columns of a right-handed matrix, with signs that bring column k close to axis k."""
    for k, column in enumerate(columns):
        leading = column[k] or max(column, key=abs)
        if leading < 0:
            columns[k] = tuple(-entry for entry in column)
    if dot(columns[0], cross(columns[1], columns[2])) < 0:
        loosest = min(range(3), key=lambda k: abs(columns[k][k]))
        columns[loosest] = tuple(-entry for entry in columns[loosest])
    return transpose(columns)


def _settle(moments: list[Fraction]) -> tuple[Fraction, Fraction, Fraction]:
    """Return the moments, with negligible moments replaced by zero and nearly equal moments by the same number."""
    # 2^-200 of their size; exact comparisons then give the kind of symmetry
    limit = max(map(abs, moments)) * NEGLIGIBLE
    settled = [Fraction(0) if abs(moment) <= limit else moment for moment in moments]
    for i, j in _PAIRS:
        if equal(settled[i], settled[j]):
            settled[j] = settled[i]
    first, second, third = settled
    return first, second, third


def _class(moments: tuple[Fraction, Fraction, Fraction]) -> tuple[str, int | None]:
    pairs = [(i, j) for i, j in _PAIRS if moments[i] == moments[j]]
    if len(pairs) == 1:
        return "symmetric", 3 - sum(pairs[0])
    return ("spherical" if pairs else "asymmetric"), None


def principal_axes(inertia: Any, where: str = "") -> Principal:
    """Return the principal axes, the principal moments and the kind of symmetry of a body.

    Parameters
    ----------
    inertia : 3x3 numbers or texts, kg m^2
        A symmetric tensor, with the products of inertia negated. A tensor that no body can have is accepted.
    where : str
        Place of the tensor in the scene, put in front of an error message.

    Returns
    -------
    Principal
        Moments and axes have far more digits than a double: converted to doubles, they are correctly rounded, even if
        moments are nearly equal.

    Raises
    ------
    InputError
        If the tensor is not 3x3, not finite or not symmetric.

    Examples
    --------
    >>> principal_axes([[2, -1, 0], [-1, 2, 0], [0, 0, 3]]).moments
    (Fraction(3, 1), Fraction(1, 1), Fraction(3, 1))
    """
    tensor = _read_tensor(inertia, where)
    limit = max(abs(tensor[i][i]) for i in range(3)) * NEGLIGIBLE
    if all(abs(tensor[i][j]) <= limit for i, j in _PAIRS):
        moments = _settle([tensor[i][i] for i in range(3)])
        return Principal(moments, IDENTITY, *_class(moments), True)
    with localcontext() as context:
        context.prec = DIGITS
        values, vectors = _jacobi(tensor)
        order = _closest_order(vectors)
        moments = _settle([_root(tensor, values[k]) for k in order])
        columns = [tuple(Fraction(vectors[i][k]) for i in range(3)) for k in order]
    return Principal(moments, _directed(columns), *_class(moments), False)


def _listed(moments: tuple[Fraction, Fraction, Fraction]) -> str:
    return ", ".join(f"{float(moment):.15g}" for moment in moments) + " kg m^2"


def require_admissible(body: Principal, where: str = "") -> None:
    """Raise InputError unless some distribution of mass has the principal moments of ``body``."""
    small, middle, large = sorted(body.moments)
    if small < 0:
        raise InputError(
            f"{prefix(where)}expected principal moments of inertia that are not negative, got {_listed(body.moments)}"
        )
    # It may equal this sum (a flat body), and one moment may be zero (a needle).
    if small + middle < large and not equal(small + middle, large):
        raise InputError(
            f"{prefix(where)}expected principal moments of inertia none of which exceeds the sum of the other two "
            f"(true of every body), got {_listed(body.moments)}, where "
            f"{float(large):.15g} exceeds {float(small):.15g} + {float(middle):.15g} "
            f"by {float(large - small - middle):.3g}"
        )


def why_not_propagable(body: Principal) -> str:
    """Return why Euler's equations do not determine the rates of omega, such as a moment of zero; empty if they do."""
    if max(body.moments) == 0:
        return "a point has no moments of inertia, so no torque determines its angular acceleration"
    if body.needle:
        return (
            f"a needle (principal moments {_listed(body.moments)}) has no moment of inertia about its own line, so its "
            "angular acceleration about that line is undetermined; give it a small thickness"
        )
    return ""
