"""Prove the laws of a kernel from its formulas, as polynomial identities with cofactors that anyone can multiply out.

The outputs in a law are replaced by their formulas; sines and cosines of sums and multiples become polynomials in those
of base angles, roots and absolute values become generators. What is left of each entry is a numerator, which is a sum
of cofactors times relations: ``s^2 + c^2 - 1`` of a base angle, ``r^2 - P`` of a root, and the hypotheses of the law.
Choices are followed one branch at a time.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import count
from typing import Any

from sympy import Abs, Expr, Integer, Poly, Rational, Symbol, atan2, cos, fraction, sin, sqrt, together
from sympy.polys.domains import QQ
from sympy.polys.matrices import DomainMatrix
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyElement, PolyRing

from symrot.errors import CertificateError
from symrot.exact.angles import LinearForm, base_coefficients, chebyshev, constant_cosine_sine, linear_form
from symrot.kernels.definition import Definition, Law
from symrot.kernels.removable import explicit, select_ge

__all__ = ["Entry", "Generator", "LawProof", "prove_laws"]


@dataclass(frozen=True)
class Generator:
    """What a symbol of a proof stands for: ``kind`` of ``of`` (text): sin, cos, root, sign or angle (an atan2)."""

    symbol: str
    kind: str
    of: str


@dataclass(frozen=True)
class Entry:
    """One entry of a law: ``numerator = sum of cofactor * relation``, all polynomials as text."""

    numerator: str
    cofactors: tuple[str, ...]


@dataclass(frozen=True)
class LawProof:
    """The proof of one law in one case of its choices."""

    text: str
    case: tuple[str, ...]  # the conditions of the choices taken
    generators: tuple[Generator, ...]
    relations: tuple[str, ...]
    entries: tuple[Entry, ...]


def prove_laws(found: Definition) -> tuple[LawProof, ...]:
    """Prove every law of a kernel, in every case of its choices.

    Raises
    ------
    CertificateError
        For a law that does not follow.
    """
    formulas = _formulas(found)
    return tuple(
        _Case(found.name, law, conditions).prove(entries, relations)
        for law in found.laws()
        for conditions, entries, relations in _cases(law, formulas)
    )


def _formulas(found: Definition) -> dict[Symbol, Expr]:
    """Return the outputs as formulas in the inputs alone."""
    named: dict[Symbol, Expr] = {}
    for symbol, value in found.named:
        named[symbol] = value.xreplace(named)
    return {
        Symbol(name, **_assumptions(name, found)): explicit(formula.xreplace(named)) for name, formula in found.formulas
    }


def _assumptions(name: str, found: Definition) -> dict[str, bool]:
    for law in found.laws():
        for entry in law.vanishing:
            for symbol in entry.free_symbols:
                if str(symbol) == name:
                    return dict(symbol.assumptions0)
    return {"real": True}


Case = tuple[tuple[str, ...], tuple[Expr, ...], tuple[Expr, ...]]  # conditions, entries, relations


def _cases(law: Law, formulas: dict[Symbol, Expr]) -> Iterator[Case]:
    entries = tuple(explicit(entry).xreplace(formulas) for entry in law.vanishing)
    yield from _split((), entries, law.relations)


def _split(conditions: tuple[str, ...], entries: tuple[Expr, ...], relations: tuple[Expr, ...]) -> Iterator[Case]:
    """Follow both branches of the innermost choice that is left."""
    choices = sorted(
        {choice for entry in entries for choice in entry.atoms(select_ge)}, key=lambda e: (e.count_ops(), str(e))
    )
    choices = [choice for choice in choices if not any(argument.has(select_ge) for argument in choice.args)]
    if not choices:
        yield conditions, entries, relations
        return
    left, right, *_ = choices[0].args
    same = [choice for choice in choices if choice.args[:2] == (left, right)]
    for taken, relation in ((2, ">="), (3, "<")):
        chosen = {choice: choice.args[taken] for choice in same}
        yield from _split(
            (*conditions, f"{left} {relation} {right}"), tuple(e.xreplace(chosen) for e in entries), relations
        )


def _cofactors(polynomial: PolyElement, basis: Sequence[PolyElement], rules: int) -> list[PolyElement] | None:
    """Return the cofactors of relations whose sum of products is a polynomial; None if none are found.

    Leading powers of the first ``rules`` relations are those of different generators: they are divided by. Where
    dividing by the other relations as well leaves a rest, constants and then linear polynomials are tried as their
    cofactors, by linear algebra.
    """
    if not basis:
        return None if polynomial else []
    found, rest = polynomial.div(list(basis))
    if not rest:
        return list(found)
    by_rules, rest = polynomial.div(list(basis[:rules])) if rules else ([], polynomial)
    for degree in (0, 1):
        rest_of = _combination(rest, basis[rules:], degree)
        if rest_of is not None:
            return [*by_rules, *rest_of]
    return None


def _combination(polynomial: PolyElement, relations: Sequence[PolyElement], degree: int) -> list[PolyElement] | None:
    """Return polynomials of a degree whose products with relations add up to a polynomial, or None."""
    ring = polynomial.ring
    occurring = {
        place for p in (polynomial, *relations) for monomial in p for place, power in enumerate(monomial) if power
    }
    factors = [ring.one, *(ring.gens[place] for place in sorted(occurring))] if degree else [ring.one]
    products = [(k, factor, relation * factor) for k, relation in enumerate(relations) for factor in factors]
    rows = sorted({monomial for p in (polynomial, *(product for *_, product in products)) for monomial in p})
    row_of = {monomial: row for row, monomial in enumerate(rows)}
    entries: dict[int, dict[int, Any]] = {row: {} for row in range(len(rows))}
    for column, (*_, product) in enumerate(products):
        for monomial, coefficient in product.items():
            entries[row_of[monomial]][column] = coefficient
    for monomial, coefficient in polynomial.items():
        entries[row_of[monomial]][len(products)] = coefficient
    reduced, pivots = DomainMatrix(entries, (len(rows), len(products) + 1), QQ).rref()
    if len(products) in pivots:
        return None
    found = [ring.zero] * len(relations)
    for row, column in enumerate(pivots):
        k, factor, _ = products[column]
        found[k] += factor * reduced[row, len(products)].element
    return found


@dataclass
class _Case:
    """The symbols of one proof, made as they are met."""

    name: str
    law: Law
    conditions: tuple[str, ...]
    generators: list[Generator] = field(default_factory=list)
    known: dict[Expr, Expr] = field(default_factory=dict)
    rules: list[tuple[Symbol, Expr]] = field(default_factory=list)  # generator whose power leads, what is zero
    nonnegative: set[Symbol] = field(default_factory=set)
    angles: dict[Symbol, tuple[Expr, Expr]] = field(default_factory=dict)  # an atan2 -> its cosine and sine
    pairs: dict[Expr, tuple[Symbol, Symbol]] = field(default_factory=dict)  # a base angle -> its cosine and sine
    roots: dict[Expr, Expr] = field(default_factory=dict)  # a radicand -> its root
    numbers: Iterator[int] = field(default_factory=count)

    def prove(self, entries: Iterable[Expr], relations: Sequence[Expr]) -> LawProof:
        """Return the proof; ``CertificateError`` for an entry that is not a combination of the relations."""
        read = [self.rewrite(entry) for entry in (*entries, *relations)]
        forms = [
            self._form(angle) for entry in read for f in (sin, cos) for node in entry.atoms(f) for angle in node.args
        ]
        self.bases = base_coefficients(forms)
        read = [self.expand(entry) for entry in read]
        vanishing, hypotheses = read[: len(read) - len(relations)], read[len(read) - len(relations) :]
        numerators = [self._numerator(entry) for entry in vanishing]
        zero = [self._numerator(entry) for _, entry in self.rules] + [self._numerator(entry) for entry in hypotheses]
        ring = self._ring([*numerators, *zero])
        basis = [ring.from_expr(entry) for entry in zero]
        proven = []
        for numerator in numerators:
            polynomial = ring.from_expr(numerator)
            cofactors = _cofactors(polynomial, basis, len(self.rules))
            if cofactors is None:
                raise CertificateError(f"{self.name}: expected the law {self.law.text!r} to follow, and it does not")
            proven.append(Entry(str(polynomial), tuple(map(str, cofactors))))
        return LawProof(self.law.text, self.conditions, tuple(self.generators), tuple(map(str, basis)), tuple(proven))

    def _numerator(self, entry: Expr) -> Expr:
        return fraction(together(entry))[0].expand()

    def _ring(self, polynomials: Sequence[Expr]) -> PolyRing:
        """Return a ring whose leading powers are those of the rules: roots first, later ones before earlier ones."""
        leading = [symbol for symbol, _ in reversed(self.rules)]
        others = sorted({s for p in polynomials for s in p.free_symbols} - set(leading), key=str)
        return PolyRing([*leading, *others], QQ, lex)

    def symbol(self, kind: str, of: Expr, letter: str) -> Symbol:
        """Return a new generator."""
        made = Symbol(f"{letter}{next(self.numbers)}_", real=True)
        self.generators.append(Generator(str(made), kind, str(of)))
        return made

    def rewrite(self, expr: Expr) -> Expr:
        """Return an expression with roots, absolute values, signs and arc tangents as generators."""
        if expr.is_Atom:
            return self.known.get(expr, expr)
        if expr not in self.known:
            self.known[expr] = self._rewritten(expr)
        return self.known[expr]

    def _rewritten(self, expr: Expr) -> Expr:
        arguments = [self.rewrite(argument) for argument in expr.args]
        if expr.is_Pow and not expr.exp.is_Integer:
            return self.root(arguments[0]) ** (2 * expr.exp)
        if isinstance(expr, Abs):
            return self.root(arguments[0] ** 2)
        if isinstance(expr, atan2):
            return self.arc(*arguments)
        if getattr(expr.func, "__name__", "") == "copysign":
            return self.sign(arguments[1])
        return expr.func(*arguments)

    def root(self, radicand: Expr) -> Expr:
        """Return the square root: a product of what is not negative where it is one, else a generator."""
        above, below = fraction(together(self._reduced(radicand)))
        inside = (above * below).expand()
        if inside not in self.roots:
            self.roots[inside] = self._perfect(inside) or self._new_root(inside)
        return self.roots[inside] / below

    def _new_root(self, inside: Expr) -> Symbol:
        made = self.symbol("root", inside, "r")
        self.rules.append((made, made**2 - inside))
        self.nonnegative.add(made)
        return made

    def _perfect(self, inside: Expr) -> Expr | None:
        """Return the root of the square of something that is not negative; None for anything else."""
        if not inside.free_symbols:
            return sqrt(inside)
        content, factors = Poly(inside, *sorted(inside.free_symbols, key=str), domain=QQ).factor_list()
        value = sqrt(content)
        if not value.is_Rational:
            return None
        for factor, power in factors:
            base = factor.as_expr()
            if power % 2 or (power % 4 and not self._is_nonnegative(base)):
                return None
            value *= base ** (power // 2)
        return value

    def _reduced(self, radicand: Expr) -> Expr:
        """Return a radicand reduced by the rules and the hypotheses, as far as they lead with a square."""
        above, below = fraction(together(radicand))
        hypotheses = [(None, entry) for entry in self.law.relations if len(self.law.relations) == 1]
        relations = [entry.expand() for _, entry in (*self.rules, *hypotheses)]
        ring = self._ring([above.expand(), below.expand(), *relations])
        basis = [ring.from_expr(entry) for entry in relations]
        if not basis:
            return radicand
        return ring.from_expr(above.expand()).rem(basis).as_expr() / ring.from_expr(below.expand()).rem(basis).as_expr()

    def _is_nonnegative(self, base: Expr) -> bool:
        """Tell whether a polynomial is a sum of even powers, or of generators that are not negative."""
        for term in base.as_ordered_terms():
            coefficient, rest = term.as_coeff_Mul()
            powers = rest.as_powers_dict()
            if coefficient < 0 or not all(
                s in self.nonnegative or s.is_positive or n % 2 == 0 for s, n in powers.items() if s != 1
            ):
                return False
        return True

    def arc(self, y: Expr, x: Expr) -> Symbol:
        """Return the generator of ``atan2(y, x)``, with its cosine and sine."""
        key = atan2(y, x, evaluate=False)
        if key not in self.known:
            made = self.symbol("angle", key, "a")
            radius = self.root((x**2 + y**2).expand())
            self.angles[made] = (x / radius, y / radius)
            if self._is_nonnegative(y):
                self.nonnegative.add(made)
            self.known[key] = made
        return self.known[key]

    def sign(self, value: Expr) -> Symbol:
        """Return the generator of the sign of a value, 1 or -1, which times its absolute value is the value."""
        made = self.symbol("sign", value, "g")
        size = self.root(value**2)
        self.rules.append((made, made**2 - 1))
        if value.is_Symbol:
            self.known[value] = made * size
        return made

    def _form(self, angle: Expr) -> LinearForm:
        return linear_form(angle)

    def expand(self, expr: Expr) -> Expr:
        """Return an expression with sines and cosines as polynomials in those of base angles."""
        replaced: dict[Expr, Expr] = {}
        for node in expr.atoms(sin, cos):
            cosine, sine = self._turned(linear_form(node.args[0]))
            replaced[node] = cosine if isinstance(node, cos) else sine
        return expr.xreplace(replaced)

    def _turned(self, form: LinearForm) -> tuple[Expr, Expr]:
        cosine, sine = constant_cosine_sine(form.half_turns) if form.half_turns else (Integer(1), Integer(0))
        for atom, coefficient in form.terms:
            c, s = self._multiple(atom, coefficient)
            cosine, sine = cosine * c - sine * s, sine * c + cosine * s
        return cosine, sine

    def _multiple(self, atom: Expr, coefficient: Fraction) -> tuple[Expr, Expr]:
        base = self.bases[atom]
        if atom in self.angles:
            if base.denominator != 1:
                raise CertificateError(f"{self.name}: expected whole multiples of an arc tangent in a law")
            base = Fraction(1)
        times = int(coefficient / base)
        c, s = self._pair(atom, base)
        first, second = chebyshev(abs(times))
        cosine = sum(k * c**n for n, k in enumerate(first))
        sine = s * sum(k * c**n for n, k in enumerate(second))
        return cosine, sine if times > 0 else -sine

    def _pair(self, atom: Expr, base: Fraction) -> tuple[Expr, Expr]:
        if atom in self.angles:
            return self.angles[atom]
        angle = Rational(base.numerator, base.denominator) * atom
        if angle not in self.pairs:
            c, s = self.pairs[angle] = self.symbol("cos", angle, "c"), self.symbol("sin", angle, "s")
            self.rules.append((s, s**2 + c**2 - 1))
        return self.pairs[angle]
