"""Derivations: chains of equations, each of which holds or cannot be written down.

A :class:`Derivation` is built step by step. A step whose two sides are not equal by the exact normal form
(:mod:`symrot.exact`) raises :class:`ProofError`, so whatever a derivation shows has been proven while it was built.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any

from sympy import (
    Abs,
    Expr,
    ImmutableMatrix,
    Matrix,
    MatrixBase,
    MatrixExpr,
    Mul,
    Ne,
    S,
    factor,
    factor_list,
    fraction,
    sympify,
)

from symrot.errors import SymrotError
from symrot.exact.decide import Verdict, decide, is_zero, normal_form
from symrot.exact.ring.ring import as_zero
from symrot.proof.notation.latex_reader import Unread, key, parts, read
from symrot.proof.notation.printer import formula
from symrot.proof.page import Page, Passage, Section, Step
from symrot.proof.pages import excerpt, html_document, latex_document, markdown

__all__ = ["Derivation", "Passage", "PrintedPage", "ProofError", "Section", "Step"]


class ProofError(SymrotError):
    """A step of a derivation that does not hold."""


@dataclass
class PrintedPage(Page):
    """A page that prints itself; its fields are those of :class:`symrot.proof.page.Page`."""

    def markdown(self) -> str:
        """Return the page as Markdown, with the formulas in ``$$``."""
        return markdown(self)

    def latex(self) -> str:
        """Return the page as a LaTeX document."""
        return latex_document(self)

    def html(self) -> str:
        """Return the page as one HTML file with native MathML; it needs no network."""
        return html_document(self)

    def part(self, number: int, detail: bool = False) -> "PrintedPage":
        """Return a page with one step, from 1; in detail with every expression between its two sides.

        Raises
        ------
        InputError
            If there is no such step.
        """
        page = excerpt(self, number, detail)
        return PrintedPage(**{each.name: getattr(page, each.name) for each in fields(page)})


@dataclass
class Derivation(PrintedPage):
    """A page of a textbook in code, proven while it is built.

    Parameters
    ----------
    assumed : list of Expr
        Expressions that are stated once not to be zero (:meth:`nonzero`).
    names, rates : dict
        What names on the page mean, and how fast variables change (:meth:`notation`).

    The others are those of :class:`symrot.proof.page.Page`.
    """

    assumed: list[Expr] = field(default_factory=list)
    names: dict[str, Any] = field(default_factory=dict)
    rates: dict[Expr, Expr] = field(default_factory=dict)

    def notation(self, names: Mapping[str, Any], rates: Mapping[Expr, Expr] | None = None) -> None:
        """Say what names on the page mean, so that the LaTeX of the steps after it is read back and decided.

        Parameters
        ----------
        names : mapping
            LaTeX of a name -> Expr, Matrix, or a function of what is in parentheses after it.
        rates : mapping, optional
            Variable -> its rate, for dots and time derivatives.
        """
        self.names |= {key(name): meaning for name, meaning in names.items()}
        self.rates |= rates or {}

    def section(self, title: str) -> None:
        """Begin a section."""
        self.items.append(Section(title))

    def given(self, text: str, *equations: tuple[Any, Any]) -> None:
        """State what is assumed, in words and perhaps in equations ``(left, right)``; text in a pair is LaTeX."""
        self.items.append(Passage(text, tuple(equations)))
        for left, right in equations:
            self._note(left, right)

    def nonzero(self, text: str, expression: Expr, named: str) -> None:
        """State once that an expression (LaTeX ``named``) is not zero; the steps after it do not repeat that."""
        self.items.append(Passage(f"{text} ${named} \\neq 0$."))
        self.assumed += [part.expand() for part in (expression, *_factors(expression))]

    def define(self, text: str, left: Any, right: Any) -> Any:
        """Give something a name, ``left`` (a symbol, or LaTeX), and return what it stands for."""
        self.given(text, (left, right))
        return right

    def step(
        self,
        claim: str,
        left: Any,
        right: Any,
        *,
        because: str,
        relations: Sequence[Any] = (),
        named: str = "",
        shown: Any = None,
        source: str = "",
        via: Sequence[tuple[str, Any, Any]] = (),
    ) -> Step:
        """Add ``left = right``, proven; return the step.

        Parameters
        ----------
        claim : str
        left, right : Expr or Matrix
            Of equal shape; 0 stands for a zero matrix.
        because : str
        relations : sequence of Expr or Eq
            Hypotheses, e.g. unit norm.
        named : str
            LaTeX to show in place of the left side.
        shown : str, Expr or Matrix
            To show in place of the right side: the same thing, written for a reader.
        source : str
        via : sequence of (str, Expr, Expr)
            Equations on the way, each proven as well, shown in detail.

        Raises
        ------
        ProofError
            If left - right does not reduce to zero: what is left of it, and a point where the sides differ.
        InputError
            For what :func:`symrot.exact.decide.decide` refuses.
        """
        verdict = self._proven(claim, left, right, relations)
        for words, before, after in via:
            self._proven(f"{claim} {words}", before, after, relations)
        hypotheses = tuple(zero for zero in map(as_zero, relations) if zero != 0)
        conditions = tuple(condition for condition in _tidied(verdict.conditions) if not self._is_assumed(condition))
        right = Matrix.zeros(*left.shape) if right == 0 and isinstance(left, MatrixBase) else right
        left, right = _frozen(left), _frozen(right)
        sides = left, right
        printed = (
            self._is_shown(claim, named or None, left, sides, relations),
            self._is_shown(claim, shown, right, sides, relations),
        )
        return self._add(
            Step(claim, left, right, because, "=", hypotheses, conditions, named, shown, source, tuple(via), printed)
        )

    def positive(self, claim: str, expression: Any, *, because: str, named: str = "") -> Step:
        """Add ``expression > 0``, which must follow from the signs of the symbols in it; return the step.

        Raises
        ------
        ProofError
            If it does not follow term by term, factor by factor.
        """
        reduced = factor(normal_form(expression))
        if reduced.is_positive is not True:
            raise ProofError(f"{self.name}, {claim!r}: the signs of the symbols do not make {reduced} positive")
        return self._add(Step(claim, _frozen(expression), S.Zero, because, ">", named=named, shown=reduced))

    def _proven(self, claim: str, left: Any, right: Any, relations: Sequence[Any]) -> Verdict:
        """Return the verdict on an equation that holds; ``ProofError`` for one that does not."""
        verdict = decide(left, right, relations)
        if verdict.verdict != "true":
            where = f" ({verdict.counterexample})" if verdict.counterexample else ""
            raise ProofError(
                f"{self.name}, step {len(self.steps) + 1}, {claim!r} does not hold: left - right = "
                f"{_short(verdict.residual)}{where}"
            )
        return verdict

    def _is_shown(self, claim: str, shown: Any, side: Any, sides: tuple[Any, Any], relations: Sequence[Any]) -> bool:
        """Return whether what is shown for a side is read back; ``ProofError`` where it is and is something else."""
        if shown is None:
            return True
        try:
            values = self._read(shown, sides) if isinstance(shown, str) else [shown]
        except Unread:
            return False
        values = [_as_side(value, side) for value in values]
        if any(_shape(value) != _shape(side) for value in values):
            return False
        for value in values:
            if value != side:
                self._proven(f"{claim} as it is shown, {shown}", value, side, relations)
        return True

    def _read(self, text: str, sides: tuple[Any, Any] = (S.Zero, S.Zero)) -> list[Any]:
        """Return what a text for one side means, in each of the forms it gives, ``X = Y``.

        The equations beside it, ``, \\quad a = b``, say what a name means, or must hold themselves.
        """
        used = {symbol for side in sides for symbol in side.free_symbols}
        names = {key(formula(symbol)): symbol for symbol in used} | self.names
        chains = parts(text)
        main = chains.pop(-1 if len(chains) > 1 and len(chains[-1]) == 1 else 0)
        for chain in chains:
            *others, last = (read(side, names, self.rates) if n or key(side) in names else None
                             for n, side in enumerate(chain))  # fmt: skip
            names.setdefault(key(chain[0]), last)
            if any(other is not None and not is_zero(other - last) for other in others):
                raise ProofError(f"{self.name}: {text} does not hold where it is shown")
        found = []
        for number, side in enumerate(main):
            try:
                found.append(read(side, names, self.rates))
            except Unread:
                if number or len(main) == 1:
                    raise
        if len(found) < len(main):
            self.names[key(main[0])] = found[0]
        return found

    def _note(self, left: Any, right: Any) -> None:
        """Remember what a name stands for, if the right side says it in a formula, or in LaTeX that can be read."""
        if isinstance(right, str):
            try:
                right = self._read(right)[-1]
            except Unread:
                self.names.pop(key(left) if isinstance(left, str) else "", None)
                return
        if isinstance(left, str) and left:
            self.names[key(left)] = right
        elif isinstance(left, Expr) and left.is_Symbol:
            self.names[key(formula(left))] = right

    def _is_assumed(self, condition: Any) -> bool:
        if not isinstance(condition, Ne):
            return False
        value = condition.lhs.expand()
        return any(value in (known, -known) for known in self.assumed)

    def _add(self, step: Step) -> Step:
        self.items.append(step)
        return step


def _tidied(conditions: Sequence[Any]) -> list[Any]:
    """Return conditions without those that others imply: a root is zero where its radicand is, a product by factor."""
    found: dict[Any, Any] = {}
    for condition in conditions:
        if not isinstance(condition, Ne):
            found.setdefault((type(condition), normal_form(condition.lhs)), condition)
            continue
        for piece in Mul.make_args(condition.lhs):
            base = piece.base if piece.is_Pow and piece.exp.is_Rational else piece
            base = base.args[0] if isinstance(base, Abs) else base
            for part in (part for side in fraction(base) for part in _factors(side)):
                value = normal_form(part)
                if not (part.is_nonzero or value.is_number or (Ne, -value) in found):
                    found.setdefault((Ne, value), Ne(part, 0))
    return list(found.values())


def _factors(expression: Expr) -> list[Expr]:
    """Return what must not vanish for a product not to: its factors, or the expression where it has none."""
    plain = not expression.is_number and expression.is_polynomial(*expression.free_symbols)
    factors = [base for base, _ in factor_list(expression)[1]] if plain else []
    return factors if len(factors) > 1 else [expression]


def _shape(side: Any) -> Any:
    return side.shape if isinstance(side, MatrixBase) else None


def _as_side(shown: Any, side: Any) -> Any:
    """Return what is shown in the shape of the side it stands for: a number for that multiple of the unit matrix."""
    shown = _frozen(shown)
    if isinstance(side, MatrixBase) and not isinstance(shown, MatrixBase):
        if shown == 0:
            return ImmutableMatrix.zeros(*side.shape)
        return ImmutableMatrix.eye(side.rows) * shown if side.is_square else shown
    return shown


def _frozen(side: Any) -> Any:
    side = sympify(side)
    if isinstance(side, MatrixExpr):
        side = side.as_explicit()
    return ImmutableMatrix(side) if isinstance(side, MatrixBase) else side


def _short(residual: Any) -> str:
    """Return the first wrong entry of a residual, cut to a line."""
    if isinstance(residual, MatrixBase):
        place = next(n for n, entry in enumerate(residual) if entry != 0)
        text = f"{residual[place]} in entry ({place // residual.cols + 1}, {place % residual.cols + 1})"
    else:
        text = str(residual)
    return text if len(text) <= 160 else text[:157] + "..."
