"""Decide whether a certificate claims only what another one claims, or what is proven here: the judge of campaigns.

A claim that is not recognised counts as different. Two claims are the same if they are the same text or the same
expression of SymPy; an expression that vanishes may differ by a rational factor. A law that the other certificate lacks
is proven anew by :func:`symrot.certificates.laws.laws.prove_law`; bounds on another box are computed anew.
"""

import ast
import json
from collections.abc import Callable, Mapping
from typing import Any

from sympy import Abs, Expr, Integer, Symbol, atan2, cos, pi, sin, sqrt

from symrot.certificates.certificate import Data
from symrot.certificates.laws.laws import hypotheses, prove_law
from symrot.certificates.readback.operations import Operations
from symrot.certificates.rounding.section import check_section
from symrot.errors import CertificateError
from symrot.kernels.definition import Law
from symrot.kernels.removable import arc_ratio, copysign, select_ge, sinc, sine_gap, tangent_gap

__all__ = ["is_weaker_or_equal", "same_but_for_bounds"]

FUNCTIONS: dict[str, Callable[..., Expr]] = {
    each.__name__: each for each in (
        sin, cos, atan2, sqrt, Abs, arc_ratio, copysign, select_ge, sinc, sine_gap, tangent_gap,
    )
}  # fmt: skip
OPERATORS: dict[type, Callable[[Expr, Expr], Expr]] = {
    ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b, ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b, ast.Pow: lambda a, b: a**b,
}  # fmt: skip
UNREADABLE = (KeyError, TypeError, ValueError, AttributeError, SyntaxError)


def same_but_for_bounds(data: Data, other: Data, double: Operations, single: Operations | None) -> bool:
    """Return whether certificates differ only in bounds of rounding errors, and these bounds hold.

    Parameters
    ----------
    data, other : dict
        Certificates; their seals are left out.
    double, single : Operations
        The functions that are bounded.
    """
    bare = [{key: value for key, value in each.items() if key not in ("seal", "rounding")} for each in (data, other)]
    if json.dumps(bare[0]) != json.dumps(bare[1]):
        return False
    if json.dumps(data.get("rounding")) == json.dumps(other.get("rounding")):
        return True
    try:
        check_section(other["rounding"], double, single, rerun=True)
    except (CertificateError, *UNREADABLE):
        return False
    return True


def is_weaker_or_equal(data: Data, other: Data) -> bool:
    """Return whether all that ``recheck.py`` reads in a certificate is claimed by another one too, or proven here.

    That is: files, places of inputs, formulas of outputs, laws. Inputs and outputs are identified by their places, so
    the name of an input that no formula and no law uses does not matter.
    """
    try:
        known, claimed = _Claims(data), _Claims(other)
        return claimed.plain <= known.plain and all(law in known.laws or claimed.proves(law) for law in claimed.laws)
    except UNREADABLE:
        return False


class _Claims:
    """The claims of a certificate: ``plain`` ones, and ``laws`` as (vanishing expression, given expressions)."""

    def __init__(self, data: Data) -> None:
        spec = data["spec"]
        self.name = data["kernel"]
        placed = (*data["inputs"], *spec["formulas"])
        self.symbols = {symbol: Symbol(f"at {place}", real=True) for place, symbol, *_ in placed}
        self.named = [(symbol, self.read(text)) for symbol, text in spec["named"]]
        self.formulas = [(place, self.read(text)) for place, _, text in spec["formulas"]]
        self.plain: set[Any] = {("file", *item) for item in data["files"].items()}
        self.plain |= {("input", place) for place, *_ in data["inputs"]}
        self.plain |= {
            ("parameter", self.symbols[symbol], self.read(text)) for symbol, text in spec["parameters"].items()
        }
        self.plain |= {("named", *each) for each in self.named} | {("formula", *each) for each in self.formulas}
        self.plain |= {("function", name, said["type"]) for name, said in data["readback"].items()}
        self.texts: dict[Any, tuple[str, list[str]]] = {}
        for law in data["laws"]:
            given = tuple(self.symbols.get(each, each) for each in law["given"])
            self.texts |= {(_primitive(self.read(text)), given): (text, law["given"]) for text in law["vanishing"]}
        self.laws = set(self.texts)
        self.spec = spec

    def read(self, text: str) -> Expr:
        return _expression(ast.parse(text.strip(), mode="eval").body, self.symbols)

    def proves(self, law: Any) -> bool:
        """Return whether symrot's prover, which evaluates nothing, proves a law from the formulas."""
        names: dict[str, Symbol] = {}
        text, given = self.texts[law]
        vanishing = _expression(ast.parse(text.strip(), mode="eval").body, names)
        formulas = {
            symbol: _expression(ast.parse(each, mode="eval").body, names)
            for symbol, each in (*self.spec["named"], *(item[1:] for item in self.spec["formulas"]))
        }
        if self._follows(Law(text, (vanishing,)), formulas):  # whatever is given
            return True
        relations = hypotheses([names.get(each, Symbol(each, real=True)) for each in given])
        return self._follows(Law(text, (vanishing,), relations), formulas)

    def _follows(self, law: Law, formulas: Mapping[str, Expr]) -> bool:
        try:
            prove_law(self.name, law, formulas)
        except CertificateError:
            return False
        return True


def _primitive(value: Expr) -> Expr:
    """Return an expression without its rational factor."""
    bare = value.primitive()[1]
    return -bare if bare.could_extract_minus_sign() else bare


def _expression(node: ast.expr, symbols: Mapping[str, Symbol]) -> Expr:
    match node:
        case ast.Constant(value=int(number)) if not isinstance(number, bool):
            return Integer(number)
        case ast.Name(id="pi"):
            return pi
        case ast.Name(id=name):
            return symbols.get(name, Symbol(name, real=True))
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_expression(operand, symbols)
        case ast.BinOp(left=left, op=sign, right=right):
            return OPERATORS[type(sign)](_expression(left, symbols), _expression(right, symbols))
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            return FUNCTIONS[name](*(_expression(each, symbols) for each in arguments))
    raise ValueError(f"expected a formula, got {ast.unparse(node)[:60]}")
