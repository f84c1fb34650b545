"""The domain of a formula: its divisors, which must not be zero, and its radicands, which must not be negative."""

from collections.abc import Container, Iterable

from sympy import Abs, Expr, Pow, acos, asin, atan2, log
from sympy.core.function import AppliedUndef

from symrot.exact.domain.needs import is_leaf
from symrot.exact.ring.ring import FormulaRing
from symrot.exact.ring.roots import Root

__all__ = ["divisors", "free_angles", "is_dense", "radicands", "signs", "split_radicands"]


def divisors(ring: FormulaRing, granted: Container[int] = ()) -> list[tuple[Expr, Expr]]:
    """Return pairs (divisor as the formula writes it, a factor of the divisor) for all divisors in a ring's formulas.

    The formulas are defined only where no factor is zero. Factors that SymPy knows not to be zero are omitted. The
    caller may omit others that cannot be zero: ``granted`` has their indices in ``ring.ratios.factors``.
    """
    roots = {place: root for root, place in ring.roots.items()}
    pairs: list[tuple[Expr, Expr]] = []
    for number, (source, factor) in enumerate(zip(ring.ratios.sources, ring.ratios.factors, strict=True)):
        if number in granted:
            continue
        places = [n for n, power in enumerate(factor.leading_expv()) if power] if len(factor) == 1 else []
        root = roots.get(places[0]) if len(places) == 1 else None
        # a root is zero where its radicand is
        inside = _inside(root) if root else factor.as_expr(*ring.generators)
        pairs.append((source, inside))
    # arguments of logarithms and ``x^2 + y^2`` of ``atan2(y, x)``
    pairs += [(formula, formula) for leaf in _leaves(ring) for formula in _nonzero(leaf)]
    return [pair for pair in dict.fromkeys(pairs) if not any(form.is_nonzero or form.is_number for form in pair)]


def _inside(root: Root) -> Expr:
    return root.expression.args[0] if isinstance(root.expression, Abs) else root.power_expression


def radicands(ring: FormulaRing) -> list[Expr]:
    """Return formulas that must not be negative: radicands, arguments of logarithms, 1 - x^2 of asin(x) and acos(x)."""
    bases = [radical.base for node, radical in ring.radicals.items() if isinstance(node, Pow)]
    formulas = [base for base in bases if not _is_square(base)]
    formulas += [formula for leaf in _leaves(ring) for formula in _nonnegative(leaf)]
    formulas += split_radicands(ring)
    return [formula for formula in dict.fromkeys(formulas) if not (formula.is_nonnegative or formula.is_number)]


def split_radicands(ring: FormulaRing) -> list[Expr]:
    """Return the formulas P of those square roots ``sqrt(P f^2)`` that the ring reads as ``|f| sqrt(P)``.

    Where f = 0 and P < 0 only the first formula is real, so proofs in the ring hold only where P >= 0. A P is omitted
    if it is zero wherever f is zero, or if SymPy knows that it is positive.
    """
    # where f = 0 and P = -1, sqrt(P f^2) is 0 but |f| sqrt(P) is not real: the proof does not cover such a point
    loose = [root for radical in ring.radicals.values() if radical.loose for root in radical.roots]
    return list(dict.fromkeys(root.power_expression for root in loose if not root.power_expression.is_positive))


def is_dense(ring: FormulaRing) -> bool:
    """Return whether the points at which no divisor is zero are known to be dense among all real points."""
    # angles and exponents may depend on each other, as ``x log(4)`` and ``x log(2)``: they must be plain
    return not ring.roots and not ring.outside_scope and all(map(_is_plain, (*ring.bases, *ring.exponent_bases)))


def _is_plain(atom: Expr) -> bool:
    """Return whether an angle or exponent is made of symbols, functions of time and rational numbers alone."""
    if is_leaf(atom):
        return True
    if atom.is_Add or atom.is_Mul or (atom.is_Pow and atom.exp.is_Integer):
        return all(map(_is_plain, atom.args))
    return bool(atom.is_Rational)


def free_angles(ring: FormulaRing) -> list[Expr]:
    """Return the angles of a ring's sines and cosines that may have any value, whatever the other variables are.

    Such an angle is proportional to a symbol or a function of time that occurs in no other variable, as x is in
    ``sin(x) + y``, but not in ``sin(x) + x``.
    """
    # time derivatives may occur: at one instant they are independent of the value of the function
    holders = [*ring.bases, *(leaf for leaf in ring.symbols if not leaf.is_Derivative)]
    free = []
    for atom in ring.bases:
        factors = atom.args if atom.is_Mul else (atom,)
        others = [holder for holder in holders if holder is not atom]
        is_plain = all(factor.is_Symbol or isinstance(factor, AppliedUndef) for factor in factors)
        if is_plain and atom not in ring.symbols and any(not any(o.has(f) for o in others) for f in factors):
            free.append(atom)
    return free


def signs(ring: FormulaRing) -> list[Expr]:
    """Return formulas that are nonnegative wherever the formulas of the ring are defined, such as radicands."""
    # 1 + x and 1 - x for asin(x) and acos(x)
    sides = [1 + sign * leaf.args[0] for leaf in _leaves(ring) if isinstance(leaf, asin | acos) for sign in (1, -1)]
    return [*radicands(ring), *sides]


def _leaves(ring: FormulaRing) -> Iterable[Expr]:
    """Return the inverse functions and logarithms in the formulas of a ring, whose arguments limit the domain.

    Those inside sines and cosines are included.
    """
    leaves = [*ring.symbols, *(atom for form in ring.forms.values() for atom, _ in form.terms)]
    return [*(leaf for leaf in leaves if leaf not in ring.own_logarithms), *ring.logarithms]


def _nonzero(leaf: Expr) -> list[Expr]:
    if isinstance(leaf, atan2):
        return [leaf.args[0] ** 2 + leaf.args[1] ** 2]
    return [leaf.args[0]] if isinstance(leaf, log) else []


def _nonnegative(leaf: Expr) -> list[Expr]:
    if isinstance(leaf, asin | acos):
        return [1 - leaf.args[0] ** 2]
    return [leaf.args[0]] if isinstance(leaf, log) else []


def _is_square(base: Expr) -> bool:
    """Return whether a radicand is written as an even power of a real number, so that it is never negative."""
    return bool(isinstance(base, Pow) and base.exp.is_Integer and base.exp % 2 == 0)
