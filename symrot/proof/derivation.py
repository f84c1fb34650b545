"""Derivations: sequences of equations, each proven when it is added.

A step of a :class:`Derivation` states that the two sides of an equation are equal. :class:`ProofError` is raised if
the exact normal form (:mod:`symrot.exact`) shows that they are not. The page is the text, with formulas, that a reader
sees.
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

import symrot
from symrot.errors import SymrotError
from symrot.exact.decide import decide, is_zero, normal_form
from symrot.exact.decision import Decision
from symrot.exact.ring.ring import as_zero
from symrot.proof.notation.latex_reader import Unread, key, parts, read
from symrot.proof.notation.printer import formula
from symrot.proof.page import Page, Passage, Section, Step, Table
from symrot.proof.pages import excerpt, html_document, latex_document, markdown

__all__ = ["Derivation", "Passage", "PrintedPage", "ProofError", "Section", "Step"]


class ProofError(SymrotError):
    """Error that is raised if a step of a derivation does not hold.

    Examples
    --------
    >>> import symrot
    >>> issubclass(symrot.ProofError, symrot.SymrotError)
    True
    """


@dataclass(repr=False)
class PrintedPage(Page):
    """The page of a derivation, with methods that print it; its fields are those of :class:`symrot.proof.page.Page`."""

    def markdown(self) -> str:
        """Return the page as Markdown text; each displayed formula is LaTeX between lines ``$$``."""
        return markdown(self)

    def latex(self) -> str:
        """Return the page as the text of a complete LaTeX document."""
        return latex_document(self)

    def html(self) -> str:
        """Return the page as the text of one HTML file with native MathML, which needs neither script nor network."""
        return html_document(self)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.name}: {self.title}, {self.extent}>"

    def _repr_markdown_(self) -> str:
        return symrot.in_notebook(self)

    def part(self, number: int, detail: bool = False) -> "PrintedPage":
        """Return a page with one step, counted from 1.

        With ``detail``, the page also shows the calculation from the left to the right side of the step's equation, as
        far as it fits on a screen.

        Raises
        ------
        InputError
            If there is no such step.
        """
        page = excerpt(self, number, detail)
        return PrintedPage(**{each.name: getattr(page, each.name) for each in fields(page)})


@dataclass(repr=False)
class Derivation(PrintedPage):
    """Derivation of a result, built like a page of a textbook: every step is proven when it is added.

    Parameters
    ----------
    assumed : list of Expr
        Expressions that are assumed to be nonzero; the page states each assumption once (:meth:`nonzero`).
    names, rates : dict
        The meanings of names on the page, and the rates of variables (:meth:`notation`).

    The other parameters are those of :class:`symrot.proof.page.Page`.

    Examples
    --------
    >>> import symrot
    >>> symrot.derivation("intermediate_axis").title
    'The intermediate axis is unstable'
    """

    assumed: list[Expr] = field(default_factory=list)
    names: dict[str, Any] = field(default_factory=dict)
    rates: dict[Expr, Expr] = field(default_factory=dict)

    def notation(self, names: Mapping[str, Any], rates: Mapping[Expr, Expr] | None = None) -> None:
        """Declare the meanings of names, so that the LaTeX of later steps can be parsed and proven.

        Parameters
        ----------
        names : mapping
            A map from the LaTeX of a name to its meaning: Expr, Matrix, or a function that takes the arguments in
            parentheses after the name.
        rates : mapping, optional
            A map from a variable to its rate, for which a dot above the variable and ``d/dt`` stand.
        """
        self.names |= {key(name): meaning for name, meaning in names.items()}
        self.rates |= rates or {}

    def section(self, title: str) -> None:
        """Begin a new section of the page, with the heading ``title``; all later steps and paragraphs belong to it."""
        self.items.append(Section(title))

    def passage(self, text: str, *equations: tuple[Any, Any]) -> None:
        """Add a paragraph of assumptions or definitions to the page, optionally with equations ``(left, right)``.

        A str as ``left`` or ``right`` is LaTeX.
        """
        self.items.append(Passage(text, tuple(equations)))
        for left, right in equations:
            self._note(left, right)

    def nonzero(self, text: str, expression: Expr, named: str) -> None:
        """Assume that an expression is not zero, and add a paragraph to the page that says so.

        The paragraph consists of ``text`` and the formula "NAMED is not 0"; ``named`` is the expression in LaTeX.
        """
        self.items.append(Passage(f"{text} ${named} \\neq 0$."))
        # a step in which the expression is a denominator need not repeat this condition
        self.assumed += [part.expand() for part in (expression, *_factors(expression))]

    def define(self, text: str, left: Any, right: Any) -> Any:
        """State on the page that ``left``, a symbol or LaTeX, stands for ``right``; return ``right`` for later steps.

        ``text`` is the sentence above the equation.
        """
        self.passage(text, (left, right))
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
        display: Any = None,
        source: str = "",
        via: Sequence[tuple[str, Any, Any]] = (),
        board: Sequence[tuple[str, str]] = (),
    ) -> Step:
        """Prove ``left = right`` and add it as a step; return the step.

        Parameters
        ----------
        claim : str
            The statement of the step, a sentence.
        left, right : Expr or Matrix
            The two sides of the equation, of equal shape; 0 stands for a zero matrix.
        because : str
            The reason, as the page prints it.
        relations : sequence of Expr or Eq
            Hypotheses, such as unit norm.
        named : str
            LaTeX to display instead of the left side.
        display : str, Expr or Matrix
            An equal form of the right side, to display in its place.
        source : str
            Book and page, if the step is printed elsewhere.
        via : sequence of (str, Expr, Expr)
            Intermediate equations (words, left, right), proven too, for the page that shows the step in detail.
        board : sequence of (str, str)
            The proof as a teacher writes it on the board: reasons and LaTeX of expressions that lead from the left side
            to the right one. Each is parsed and proven equal to the left side. The page that shows the step in detail
            prints these expressions instead of multiplying out the components of the vectors and matrices.

        Raises
        ------
        ProofError
            If left - right does not reduce to zero; the message has the residual and, if known, a point where the sides
            differ. Also if an equation of ``via`` or a displayed form does not hold, or if ``board`` cannot be parsed.
        InputError
            If an expression is not accepted by :func:`symrot.exact.decide.decide`.
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
            self._is_read_back(claim, named or None, left, sides, relations),
            self._is_read_back(claim, display, right, sides, relations),
        )
        for _, text in board:
            if not self._is_read_back(claim, text, left, sides, relations):
                raise ProofError(
                    f"{self.name}, {claim!r}: expected LaTeX that can be parsed in the detailed proof of the step, got "
                    f"{text}"
                )
        step = Step(
            claim, left, right, because, "=", hypotheses, conditions, named, display, source, tuple(via), printed,
            tuple(board),
        )  # fmt: skip
        self.items.append(step)
        return step

    def tabulate(self, text: str, head: Sequence[str], rows: Sequence[tuple[Sequence[str], Sequence[Step]]]) -> None:
        """Print steps that have been added already as the rows of one table, below everything else on the page so far.

        Parameters
        ----------
        text : str
            The paragraph above the table.
        head : sequence of str
            Titles of the columns.
        rows : sequence of (cells, steps)
            The cells of each row, Markdown, and the steps that prove them.
        """
        table = Table(text, tuple(head), tuple((tuple(cells), tuple(steps)) for cells, steps in rows))
        moved = {id(step) for step in table.steps}
        self.items = [item for item in self.items if id(item) not in moved]
        self.items.append(table)

    def positive(self, claim: str, expression: Any, *, because: str, named: str = "") -> Step:
        """Prove ``expression > 0`` from the signs of the symbols in it, and add it as a step; return the step.

        Raises
        ------
        ProofError
            If ``expression > 0`` does not follow from the signs of its terms and factors.
        """
        reduced = factor(normal_form(expression))
        if reduced.is_positive is not True:
            raise ProofError(f"{self.name}, {claim!r}: the signs of its symbols do not prove {reduced} positive")
        step = Step(claim, _frozen(expression), S.Zero, because, ">", named=named, display=reduced)
        self.items.append(step)
        return step

    def _proven(self, claim: str, left: Any, right: Any, relations: Sequence[Any]) -> Decision:
        """Return the verdict on the equation ``left = right`` under the hypotheses ``relations``.

        ProofError, which names the sentence ``claim`` of the step, is raised if the equation is not proven.
        """
        verdict = decide(left, right, relations)
        if verdict.verdict != "true":
            where = f" ({verdict.counterexample})" if verdict.counterexample else ""
            raise ProofError(
                f"{self.name}, step {len(self.steps) + 1}, {claim!r} does not hold: left - right = "
                f"{_short(verdict.residual)}{where}"
            )
        return verdict

    def _is_read_back(
        self, claim: str, display: Any, side: Any, sides: tuple[Any, Any], relations: Sequence[Any]
    ) -> bool:
        """Return whether the form that the page prints for one side of a step's equation was proven equal to that side.

        Parameters
        ----------
        claim : str
            The statement of the step, for the message of an error.
        display : str, Expr, Matrix or None
            The printed form, LaTeX or a formula; None if the page prints the side itself. LaTeX that cannot be parsed,
            and a form whose matrix shape differs from the side, are only labels: the result is then False.
        side : Expr or Matrix
            The side for which ``display`` is printed.
        sides : (left, right)
            Both sides of the equation; LaTeX may contain their symbols.
        relations : sequence of Expr or Eq
            Hypotheses of the step.

        Raises
        ------
        ProofError
            If the printed form can be parsed and is not equal to the side under the hypotheses.
        """
        if display is None:
            return True
        try:
            values = self._read(display, sides) if isinstance(display, str) else [display]
        # a name in the LaTeX has no declared meaning
        except Unread:
            return False
        values = [_as_side(value, side) for value in values]
        if any(_shape(value) != _shape(side) for value in values):
            return False
        for value in values:
            if value != side:
                self._proven(f"{claim} as displayed, {display}", value, side, relations)
        return True

    def _read(self, text: str, sides: tuple[Any, Any] = (S.Zero, S.Zero)) -> list[Any]:
        r"""Return the values of the sides of an equation in LaTeX: two for ``X = Y``, one for ``X`` alone.

        If X in ``X = Y`` cannot be parsed, X becomes a name for the value of Y: LaTeX of later steps may contain X, and
        the result is the value of Y alone.

        A text may have further equations, separated by ``, \quad``, such as ``X = a + b, \quad a = 2 c``. Each is
        checked. If the left side of a further equation has no meaning, it becomes a name for the value of the last
        side, in this text alone. The main equation is the first one; if the last part of the text is a formula without
        ``=``, that formula takes the place of the main equation.

        ``sides`` are two formulas, the sides of the equation of the step: their symbols may occur in the text without
        a declared meaning.

        Raises
        ------
        Unread
            If Y, or X alone, or a side of a further equation cannot be parsed.
        ProofError
            If a further equation does not hold.
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
                raise ProofError(f"{self.name}: the displayed equation {text} does not hold")
        values = []
        for number, side in enumerate(main):
            try:
                values.append(read(side, names, self.rates))
            except Unread:
                if number or len(main) == 1:
                    raise
        if len(values) < len(main):
            self.names[key(main[0])] = values[0]
        return values

    def _note(self, left: Any, right: Any) -> None:
        """Declare that ``left``, a symbol or the LaTeX of a name, stands for ``right`` in later LaTeX.

        If ``right`` is LaTeX that cannot be parsed, the meaning that the LaTeX of the name ``left`` had before is
        removed.
        """
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


def _tidied(conditions: Sequence[Any]) -> list[Any]:
    """Return a step's conditions without repetitions: ``Ne(a*sqrt(b), 0)`` gives ``Ne(a, 0)`` and ``Ne(b, 0)``."""
    independent: dict[Any, Any] = {}
    for condition in conditions:
        if not isinstance(condition, Ne):
            independent.setdefault((type(condition), normal_form(condition.lhs)), condition)
            continue
        # a product that is not zero gives one condition per factor, and a root gives one for its radicand
        for piece in Mul.make_args(condition.lhs):
            base = piece.base if piece.is_Pow and piece.exp.is_Rational else piece
            base = base.args[0] if isinstance(base, Abs) else base
            for part in (part for side in fraction(base) for part in _factors(side)):
                value = normal_form(part)
                if not (part.is_nonzero or value.is_number or (Ne, -value) in independent):
                    independent.setdefault((Ne, value), Ne(part, 0))
    return list(independent.values())


def _factors(expression: Expr) -> list[Expr]:
    """Return the factors of a polynomial: ``[x, x + 1]`` for ``x**2 + x``.

    The result is ``[expression]`` if the expression is not a product of different factors, or no polynomial.
    """
    plain = not expression.is_number and expression.is_polynomial(*expression.free_symbols)
    factors = [base for base, _ in factor_list(expression)[1]] if plain else []
    return factors if len(factors) > 1 else [expression]


def _shape(side: Any) -> Any:
    return side.shape if isinstance(side, MatrixBase) else None


def _as_side(display: Any, side: Any) -> Any:
    """Return ``display``, which the page prints instead of ``side``, as a matrix if ``side`` is a matrix."""
    display = _frozen(display)
    if isinstance(side, MatrixBase) and not isinstance(display, MatrixBase):
        # the zero matrix; below, a number stands for this multiple of the identity matrix
        if display == 0:
            return ImmutableMatrix.zeros(*side.shape)
        return ImmutableMatrix.eye(side.rows) * display if side.is_square else display
    return display


def _frozen(side: Any) -> Any:
    side = sympify(side)
    if isinstance(side, MatrixExpr) and not isinstance(side, MatrixBase):
        side = side.doit()  # a product of matrices; as_explicit alone would write a sum for each entry, 20 times slower
        side = side.as_explicit()
    return ImmutableMatrix(side) if isinstance(side, MatrixBase) else side


def _short(residual: Any) -> str:
    """Return the residual of a refuted equation as short text for a message, such as ``a - b in entry (1, 2)``."""
    if isinstance(residual, MatrixBase):
        # the first nonzero entry of a matrix
        place = next(n for n, entry in enumerate(residual) if entry != 0)
        text = f"{residual[place]} in entry ({place // residual.cols + 1}, {place % residual.cols + 1})"
    else:
        text = str(residual)
    return text if len(text) <= 160 else text[:157] + "..."
