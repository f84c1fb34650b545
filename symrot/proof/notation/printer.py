"""Printer of formulas as LaTeX with the conventions of textbooks."""

from typing import Any

from sympy import Expr, MatrixBase, Symbol, preorder_traversal
from sympy.printing.latex import LatexPrinter

from symrot.symbols import UNIT

__all__ = ["formula"]

MADE = {str(symbol): symbol for symbol in UNIT}
RATES = {"dd": "ddot", "d": "dot"}
COMMANDS = {"sech": r"\mathrm{sech}"}
ROMAN = ("sn", "cn", "dn")


class PagePrinter(LatexPrinter):  # type: ignore[misc]
    """SymPy's LaTeX printer with conventions of textbooks: a dot for a rate, no parentheses around a simple angle."""

    def _print_Symbol(self, symbol: Symbol, style: str = "plain") -> str:
        name = symbol.name
        base, _, index = name.partition("_")
        if base in ROMAN:
            return rf"\mathrm{{{base}}}" + (f"_{{{index}}}" if index else "")
        for rate, dot in RATES.items():
            if name.startswith(rate) and name[len(rate) :] in MADE:
                letter, _, index = self._print_Symbol(MADE[name[len(rate) :]]).partition("_")
                return rf"\{dot}{{{letter}}}" + (f"_{index}" if index else "")
        return str(super()._print_Symbol(symbol))

    def _print_of_angle(self, function: Expr, exp: str | None = None) -> str:
        power = f"^{{{exp}}}" if exp else ""
        argument = function.args[0]
        inside = self._print(argument)
        if not argument.is_Symbol:
            inside = rf"\left({inside}\right)"
        name = type(function).__name__
        return COMMANDS.get(name, rf"\{name}") + f"{power} {inside}"

    _print_sin = _print_cos = _print_tan = _print_cot = _print_sec = _print_csc = _print_of_angle
    _print_tanh = _print_sech = _print_of_angle

    def _print_MatrixBase(self, matrix: MatrixBase) -> str:
        """Return the LaTeX of a matrix; a denominator that all entries have in common is printed in front as 1/D."""
        if matrix.is_zero_matrix:
            return "0"
        if matrix.is_square and matrix.is_Identity:
            return r"\mathbf{1}"
        scale = _common_scale(matrix)
        if scale == 1:
            return str(super()._print_MatrixBase(matrix))
        scaled = matrix.applyfunc(lambda entry: entry / scale)
        return rf"{self._print(scale)} {super()._print_MatrixBase(scaled)}"

    def _print_Add(self, expr: Expr, order: str | None = None) -> str:
        """Return the LaTeX of a sum with its positive terms first, so that few sums begin with a minus sign."""
        terms = self._as_ordered_terms(expr, order=order)
        terms = sorted(terms, key=lambda term: term.could_extract_minus_sign())  # stable
        text = ""
        for term in terms:
            negative = term.could_extract_minus_sign() and not term.is_Add
            piece = self._print(-term if negative else term)
            if self._needs_add_brackets(term):
                piece = rf"\left({piece}\right)"
            text += (" - " if negative else " + ") + piece if text else ("-" if negative else "") + piece
        return text

    _print_ImmutableDenseMatrix = _print_Matrix = _print_ImmutableMatrix = _print_MatrixBase


def _common_scale(matrix: MatrixBase) -> Any:
    """Return 1/D if all nonzero entries of a matrix have the same denominator D; otherwise return 1.

    Return 1 also for a matrix with a single entry, and if an entry times D still contains a fraction.
    """
    denominators = {entry.as_numer_denom()[1] for entry in matrix if entry != 0}
    if len(denominators) != 1 or len(matrix) < 2:
        return 1
    (denominator,) = denominators
    scale = 1 / denominator
    clean = not any(
        part.is_Pow and part.exp.is_negative for entry in matrix for part in preorder_traversal(entry / scale)
    )
    return scale if clean else 1


_PRINTER = PagePrinter({"mat_delim": "[", "mat_str": "matrix", "fold_short_frac": False, "ln_notation": True})


def formula(side: Any) -> str:
    """Return the LaTeX of an Expr or Matrix on one line; a str must be LaTeX and is returned unchanged."""
    return side if isinstance(side, str) else str(_PRINTER.doprint(side)).replace("\n", " ")
