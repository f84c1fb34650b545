"""The difference of an equation's sides without common factors, so that multiples of one equation become equal."""

from math import comb, prod

from sympy import Add, Expr, GeneratorsNeeded, Mul, Poly, PolynomialError, Pow, cancel, fraction, together

from symrot.checker.recognition.fingerprint import in_lowest_terms

__all__ = ["primitive", "terms_expanded", "without_common_powers"]


def terms_expanded(formula: Expr) -> int:
    """Return an upper bound on the number of terms of a formula after multiplying out: 3 for ``(a + b)**2``."""
    if isinstance(formula, Add):
        return sum(map(terms_expanded, formula.args))
    if isinstance(formula, Mul):
        return prod(map(terms_expanded, formula.args))
    if isinstance(formula, Pow) and formula.exp.is_Integer:
        terms, power = terms_expanded(formula.base), abs(int(formula.exp))
        return comb(terms + power - 1, power)
    return 1


def primitive(difference: Expr) -> Expr:
    """Return the numerator of a difference without common factors: a - b for ``2*c*a/d - 2*c*b/d``."""
    # equations that differ by a factor or denominator get the same result, perhaps with another sign
    quotients = [term for term in Add.make_args(difference) if not fraction(term)[1].is_number]
    is_whole = len(quotients) <= 1 and all(map(in_lowest_terms, quotients))
    is_cancelled = not is_whole and difference.count_ops() < LONGEST
    numerator = fraction(cancel(together(difference)) if is_cancelled else together(difference))[0]
    try:
        return Poly(numerator).terms_gcd()[1].primitive()[1].as_expr()
    except (PolynomialError, GeneratorsNeeded):
        return numerator


def without_common_powers(difference: Expr) -> Expr:
    """Return a difference divided by the powers that its terms share: ``a + b`` for ``c*a/d + c*b/d``."""
    # up to a constant factor the same as `primitive`, which is slower because it multiplies out
    common = _common_powers(difference)
    if common is None:
        return primitive(difference)
    return (
        Mul(difference, *(part**-power for part, power in common.items())).expand(deep=False) if common else difference
    )


def _common_powers(formula: Expr) -> dict[Expr, int] | None:
    """Return the powers of symbols and functions that divide all terms of a formula: {a: 1, b: -1} for ``a*c/b + a/b``.

    Return None if an exponent in the formula is not an integer, as in a root, or if the formula divides by a sum.
    """
    if isinstance(formula, Add):
        terms = [_common_powers(term) for term in formula.args]
        if None in terms:
            return None
        powers = [term for term in terms if term is not None]
        least = {part: min(term.get(part, 0) for term in powers) for part in {part for term in powers for part in term}}
        return {part: power for part, power in least.items() if power}
    if isinstance(formula, Mul):
        total: dict[Expr, int] = {}
        for factor in formula.args:
            own = _common_powers(factor)
            if own is None:
                return None
            for part, power in own.items():
                total[part] = total.get(part, 0) + power
        return total
    if isinstance(formula, Pow):
        inner = _common_powers(formula.base)
        if inner is None or not formula.exp.is_Integer or (formula.exp < 0 and formula.base.is_Add):
            return None
        return {part: power * int(formula.exp) for part, power in inner.items()}
    return {} if formula.is_number else {formula: 1}


LONGEST = 120
"""A difference with this many operations or more is not reduced to lowest terms, which would take long."""
