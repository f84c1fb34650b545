"""Rates dy/dt with time counted from an epoch, for motions that start far from t = 0.

A double holds 53 bits of ``a*t + b``: at t = 1e9 s the error of a phase is 1e-7 rad. With ``t = epoch + tau``, a
polynomial of t becomes a polynomial of tau, whose coefficients are computed exactly and rounded once. Standard library
only.
"""

from collections.abc import Collection, Iterator, Sequence
from fractions import Fraction
from math import comb
from typing import NamedTuple

from symrot.codegen.printing.c_function import c_function
from symrot.codegen.taylor.linear_forms import ONE, ZERO
from symrot.formula.program import Argument, Program, Signature
from symrot.formula.tree import Node, children, evaluate, names, with_children
from symrot.planning.scene_kernel import EPOCH, Parameters, SceneKernel

__all__ = ["from_epoch", "moved", "moved_formulas"]

TIME = "t"
TURNING = {"sin", "cos", "tan"}
HIGHEST = 12  # largest degree of a polynomial of t that is shifted as a whole


def from_epoch(kernel: SceneKernel) -> SceneKernel:
    """Return the kernel of a scene in whose rates the time t is counted from the new constant ``epoch``, s.

    Conserved quantities whose formulas contain t are marked as not conserved.
    """
    rates, parameters = moved(kernel.rates, kernel.rate_parameters)
    # their formulas would still contain the original time
    timeless = [
        item._replace(holds=item.holds and not kernel.quantities.uses(TIME, (item.output,)))
        for item in kernel.conserved
    ]
    source = c_function(rates, "static inline ")
    return SceneKernel.of(rates, parameters, kernel.quantities, kernel.quantity_parameters, tuple(timeless), source)


def moved(program: Program, parameters: Parameters) -> tuple[Program, Parameters]:
    """Return a right-hand side in which time is counted from ``epoch``, and the formulas of its parameters.

    Parameters
    ----------
    program : Program
        ``dy = f(t, y, p)``, with the arguments t, y, p (optional) and dy; its formulas contain t.
    parameters : tuple of (name, Node)
        The components of p as formulas of constants. The formulas in the result may also contain ``epoch``, in s.
    """
    return _Mover(program, parameters).result()


def moved_formulas(formulas: Sequence[Node], constants: Collection[str]) -> tuple[tuple[Node, ...], Parameters]:
    """Return formulas in which t is counted from ``epoch``, and the parameters in the formulas as (name, formula).

    Parameters
    ----------
    formulas : sequence of Node
        Formulas that contain the time, constants, and states with any names.
    constants : collection of str
        The names of constants; all other names are states.
    """
    # sin(a*t) becomes sin(a*t + p) with the parameter p = a*epoch, as it would lose digits for times far from 0
    used = sorted(set().union(*map(names, formulas)) - {TIME})
    shared = tuple((name, ("symbol", name)) for name in used if name in constants)
    states = Argument("y", "in", tuple((name, "", "") for name in used if name not in constants))
    own = Argument("p", "in", tuple((name, "", "") for name, _ in shared))
    signature = Signature("formulas", (Argument(TIME, "in", ((TIME, "s", ""),), True), states, own))
    listed = tuple((f"formula_{number}", formula) for number, formula in enumerate(formulas))
    program, parameters = moved(Program(signature, (), listed), shared)
    return tuple(formula for _, formula in program.outputs), parameters


class _Form(NamedTuple):
    """A formula in the time tau = t - epoch (``node``) and, if it is a polynomial in t, its coefficients in t."""

    node: Node | None  # None for a polynomial of degree one, whose formula is made from the terms when it is used
    # the coefficients: constant formulas, lowest power first
    terms: tuple[Node, ...] | None = None
    centred: bool = False  # whether it is a product with a factor a t + b, which is small near its zero -b/a


class _Mover:
    def __init__(self, program: Program, parameters: Parameters) -> None:
        self.program, self.formulas = program, dict(parameters)
        arguments = {a.name: a for a in program.signature.arguments}
        self.states, self.own = arguments["y"], arguments.get("p", Argument("p", "in", ()))
        self.forms: dict[str, _Form] = {TIME: _Form(None, (ZERO, ONE))}
        self.forms |= {name: _Form(("symbol", name)) for name, *_ in self.states.components}
        self.forms |= {name: _Form(("symbol", name), (("symbol", name),)) for name, *_ in self.own.components}
        self.known: dict[tuple[Node, ...], Node] = {}
        self.added: list[tuple[str, Node]] = []

    def result(self) -> tuple[Program, Parameters]:
        temporaries = []
        for name, node in self.program.temporaries:
            form = self.read(node)
            if form.node is not None:
                temporaries.append((name, form.node))
                form = form._replace(node=("symbol", name))
            self.forms[name] = form
        outputs = tuple((name, self.written(self.read(node))) for name, node in self.program.outputs)
        signature = self.program.signature
        added = tuple((name, "", "of a polynomial of the time") for name, _ in self.added)
        own = Argument("p", "in", (*self.own.components, *added))
        others = [a for a in signature.arguments if a.name != "p"]
        place = others.index(self.states) + 1
        program = Program(
            Signature(signature.name, (*others[:place], own, *others[place:])), tuple(temporaries), outputs
        )
        return program, (*self.formulas.items(), *self.added)

    def read(self, node: Node) -> _Form:
        kind = node[0]
        if kind == "number":
            return _Form(node, (node,))
        if kind == "symbol":
            return self.forms[node[1]]
        if kind in ("+", "-") and (gathered := self.gathered(node)):
            return gathered
        parts = [self.read(child) for child in children(node)]
        terms = _terms(node, [part.terms for part in parts])
        if terms is not None and len(terms) == 2:
            return _Form(None, terms)
        phase = parts[0].terms
        if kind == "call" and node[1] in TURNING and phase is not None and len(phase) > 1 and not parts[0].centred:
            return _Form(self.turned(node[1], phase))
        written = tuple(map(self.written, parts))
        if kind == "call":
            return _Form((kind, node[1], written), terms)
        # such a product is not expanded: ((t - c)/w)**2 would become a difference of large numbers near a narrow pulse
        centred = any(part.centred for part in parts) or (kind in ("*", "**") and any(map(_is_shifted, parts)))
        return _Form((kind, *written, *node[2:]) if kind == "**" else (kind, *written), terms, centred)

    def gathered(self, node: Node) -> _Form | None:
        """Return a sum with its terms of the form a t + b added up: ``(t - 2) + x + 3`` becomes ``(t + 1) + x``.

        The result is None if all terms have the form a t + b, if fewer than two have it, or if no term of the form
        contains t.
        """
        lines: list[tuple[Node, ...]] = []
        others: list[tuple[bool, _Form]] = []
        for negative, form in self.summands(node, False):
            if form.terms is not None and len(form.terms) <= 2:
                lines.append(tuple(map(_negative, form.terms)) if negative else form.terms)
            else:
                others.append((negative, form))
        # without other terms, the sum itself is a t + b
        if not others or len(lines) < 2 or max(map(len, lines)) == 1:
            return None
        # constants b nearly cancel far from t = 0
        line = _trimmed([_total([each[i] for each in lines if i < len(each)]) for i in (0, 1)])
        gathered = self.written(_Form(None, line))
        for negative, other in others:
            gathered = ("-" if negative else "+", gathered, self.written(other))
        return _Form(gathered)

    def summands(self, node: Node, negative: bool) -> Iterator[tuple[bool, _Form]]:
        """Yield the terms of a sum as (subtracted, term): ``a - (b + c)`` gives (False, a), (True, b), (True, c).

        ``negative`` tells whether the whole sum is subtracted.
        """
        if node[0] in ("+", "-"):
            yield from self.summands(node[1], negative)
            yield from self.summands(node[2], negative != (node[0] == "-"))
        elif node[0] == "neg":
            yield from self.summands(node[1], not negative)
        else:
            yield negative, self.read(node)

    def written(self, form: _Form) -> Node:
        """Return the formula of ``form`` in tau = t - epoch, the time counted from the epoch.

        If ``form.node`` is None, the formula is made from the coefficients of the polynomial in t, ``form.terms``.
        """
        if form.node is not None:
            return form.node
        assert form.terms is not None
        if form.terms not in self.known:
            self.known[form.terms] = self.power_sum(self.shifted(form.terms))
        return self.known[form.terms]

    def turned(self, function: str, phase: tuple[Node, ...]) -> Node:
        """Return the formula of the sine, cosine or tangent of a polynomial in t with the coefficients ``phase``.

        The polynomial is c + u, where c is its value at the epoch and u its change since then. The sine is written as
        ``sin(c)*cos(u) + cos(c)*sin(u)``: for a large c, the rounding of c + u would lose digits of the phase.
        """
        constant, *rest = self.shifted(phase)
        advance = self.power_sum([ZERO, *rest])
        sine, cosine = (("call", name, (advance,)) for name in ("sin", "cos"))
        sine_there, cosine_there = (self.parameter(("call", name, (constant,))) for name in ("sin", "cos"))
        above = ("+", ("*", sine_there, cosine), ("*", cosine_there, sine))
        below = ("-", ("*", cosine_there, cosine), ("*", sine_there, sine))
        return above if function == "sin" else below if function == "cos" else ("/", above, below)

    def shifted(self, terms: tuple[Node, ...]) -> list[Node]:
        """Return the coefficients in tau = t - epoch of the polynomial with the coefficients ``terms`` in t.

        Both are listed from the lowest power on; the new ones are formulas in constants and the symbol ``epoch``.
        """
        old, new = [self.resolved(term) for term in terms], []
        for i in range(len(old)):
            coefficient: Node = ZERO
            for j in range(i, len(old)):
                share = _times(("number", Fraction(comb(j, i))), old[j])
                coefficient = _plus(coefficient, _times(share, ("**", ("symbol", EPOCH), j - i) if j > i else ONE))
            new.append(coefficient)
        return new

    def power_sum(self, coefficients: list[Node]) -> Node:
        """Return the formula of the polynomial in tau = t - epoch with the given coefficients, lowest power first."""
        time, value = ("symbol", TIME), None
        for new in reversed(coefficients):
            coefficient = new if new[0] == "number" else self.parameter(new)
            grown: Node | None = value if value is None else time if value == ONE else ("*", value, time)
            value = coefficient if grown is None else grown if coefficient == ZERO else ("+", coefficient, grown)
        assert value is not None
        return value

    def parameter(self, formula: Node) -> Node:
        """Return the symbol of the parameter with the formula ``formula``; if no parameter has it, one is added."""
        for name, known in (*self.formulas.items(), *self.added):
            if known == formula:
                return ("symbol", name)
        self.added.append((f"clock_{len(self.added)}", formula))
        return ("symbol", self.added[-1][0])

    def resolved(self, node: Node) -> Node:
        """Return a constant formula in which each parameter is replaced by its formula: p0 becomes ``(B - C)/A``."""
        if node[0] == "symbol":
            return self.formulas[node[1]]
        return with_children(node, list(map(self.resolved, children(node))))


def _is_shifted(form: _Form) -> bool:
    """Return whether a formula is a t + b with b other than zero, such as ``t - c``."""
    return form.terms is not None and len(form.terms) == 2 and form.terms[0] != ZERO


def _terms(node: Node, parts: list[tuple[Node, ...] | None]) -> tuple[Node, ...] | None:
    """Return the coefficients in t, lowest power first, of an operation on polynomials with the coefficients ``parts``.

    The result is None if an operand is no polynomial (None in ``parts``), or if the operation gives no polynomial or
    one of a degree above ``HIGHEST``.
    """
    if any(part is None for part in parts):
        return None
    kind, polynomials = node[0], [part for part in parts if part is not None]
    constant = all(len(part) == 1 for part in polynomials)
    if kind == "call":
        return (("call", node[1], tuple(part[0] for part in polynomials)),) if constant else None
    if constant:
        return ((kind, polynomials[0][0], node[2]) if kind == "**" else (kind, *(part[0] for part in polynomials)),)
    if kind == "neg":
        return tuple(_negative(term) for term in polynomials[0])
    if kind in "+-":
        size = max(map(len, polynomials))
        left, right = (part + (ZERO,) * (size - len(part)) for part in polynomials)
        return _trimmed([_plus(a, b if kind == "+" else _negative(b)) for a, b in zip(left, right, strict=True)])
    if kind == "*":
        return _product(*polynomials)
    if kind == "/":
        return tuple(_over(term, polynomials[1][0]) for term in polynomials[0]) if len(polynomials[1]) == 1 else None
    if not 0 < node[2] <= HIGHEST:
        return None
    power: tuple[Node, ...] | None = (ONE,)
    for _ in range(node[2]):
        power = power and _product(power, polynomials[0])
    return power


def _product(left: tuple[Node, ...], right: tuple[Node, ...]) -> tuple[Node, ...] | None:
    if len(left) + len(right) - 2 > HIGHEST:
        return None
    terms = [ZERO] * (len(left) + len(right) - 1)
    for i, a in enumerate(left):
        for j, b in enumerate(right):
            terms[i + j] = _plus(terms[i + j], _times(a, b))
    return _trimmed(terms)


def _trimmed(terms: list[Node]) -> tuple[Node, ...]:
    while len(terms) > 1 and terms[-1] == ZERO:
        terms.pop()
    return tuple(terms)


def _folded(node: Node) -> Node:
    return ("number", evaluate(node, {})) if all(part[0] == "number" for part in children(node)) else node


def _negative(a: Node) -> Node:
    return _folded(("neg", a))


def _plus(a: Node, b: Node) -> Node:
    return b if a == ZERO else a if b == ZERO else _folded(("+", a, b))


def _total(terms: Sequence[Node]) -> Node:
    total = ZERO
    for term in terms:
        total = _plus(total, term)
    return total


def _times(a: Node, b: Node) -> Node:
    return ZERO if ZERO in (a, b) else b if a == ONE else a if b == ONE else _folded(("*", a, b))


def _over(a: Node, b: Node) -> Node:
    return a if ZERO in (a, b) or b == ONE else _folded(("/", a, b))
