"""Claims (equations to be checked), read from a text or a TOML file: first as syntax trees, then as formulas of SymPy.

A claim keeps its syntax trees because the search for its fault edits them. A file of claims does not say which of them
are true.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from sympy import Expr, Symbol

from symrot.checker.arrays.complex_parts import imaginary_unit, is_complex, with_parts
from symrot.checker.arrays.index_notation import written_out
from symrot.checker.arrays.matrices import (
    bold_matrices,
    matrices_of_entries,
    matrix_of_entries,
    rate_matrices,
    used_columns,
    used_matrices,
    with_lengths,
    without_time,
)
from symrot.checker.arrays.pauli import with_pauli_matrices
from symrot.checker.arrays.quaternions import Quaternions, used_quaternions
from symrot.checker.claim.functions import BUILT_IN, ROTATIONS
from symrot.checker.claim.interpreter import CONSTANTS, Interpreter, time
from symrot.checker.claim.quantities import (
    OTHER_MEANINGS,
    has_natural_base,
    letters_of_quantities,
    with_natural_base,
)
from symrot.checker.claim.reader import Declared, Relation, read_expression, read_relation, readings_of, with_time
from symrot.checker.claim.scope import Divisor, is_matrix
from symrot.checker.claim.shapes import (
    Shape,
    added_names,
    multiplied_names,
    operand_names,
    shape_of,
    with_unit_matrices,
)
from symrot.checker.claim.tree import Node, negated, text, walk
from symrot.checker.claim.tree import number as number_node
from symrot.checker.claim.vectors import Vector, gyroscopic_tensors, is_tensor, with_scalar_products
from symrot.checker.context.context import NO_CONTEXT, Context, quantities_of, read_context
from symrot.checker.decide.decision import Equation
from symrot.checker.latex.reader import Names, read_latex
from symrot.checker.typed.cursor import TIME
from symrot.checker.units.units import read_unit
from symrot.errors import InputError
from symrot.exact.decision import ShapeMismatch, matched_sides

__all__ = [
    "SIDES",
    "Claim",
    "Definitions",
    "Refusal",
    "check_units",
    "claim_of_relation",
    "claim_of_text",
    "functions_of_time",
    "is_latex",
    "read_claims",
    "read_entries",
    "relation_text",
]  # fmt: skip


SIDES = ("left", "right")

ON_PAULI = "sigma_x, sigma_y and sigma_z are Pauli's matrices, and i is the imaginary unit"


@dataclass(frozen=True)
class Definitions:
    """The symbols and definitions of a claim as SymPy values.

    Attributes
    ----------
    values : mapping
        Symbols and definitions by name.
    functions : frozenset of str
        Names of functions of time.
    divisors, radicands : tuple
        Formulas that the texts of the definitions divide by, or take even roots of.
    bases : tuple of Expr
        Bases of powers whose exponents are not numbers.
    """

    values: Mapping[str, Any]
    functions: frozenset[str]
    divisors: tuple[Divisor, ...]
    radicands: tuple[Expr, ...]
    bases: tuple[Expr, ...]


@dataclass(frozen=True)
class Claim:
    """One claim: its trees, and its formulas in SymPy, each computed once.

    Attributes
    ----------
    id, where : str
        The name of the claim, and its place in a document.
    symbols, functions : tuple of str
        Declared names of real symbols and of functions of time.
    define : tuple of (str, Node)
        Definitions in order, each of which may use those before it.
    hypotheses : tuple of Relation
    relation : Relation or None
        The equation; None for a worked number, which has ``value`` and ``printed`` instead.
    value : Node or None
    printed : str
        The decimal number that a document prints for ``value``.
    alternatives : tuple of Relation
        Other equations that the text may stand for, if the document lost characters.
    implied : bool
        Whether undeclared names become real symbols and functions of time.
    sources : mapping
        The texts that were read, by key, for error messages.
    units : mapping
        Units by name.
    notes : tuple of str
        Sentences about how the text is read.
    editable : tuple of str
        The parts that repairs may change: ``"left"``, ``"right"``, and names of definitions. The other parts are what
        the claim is measured against.
    has_parts : bool
        Whether the equation is one of real and imaginary parts, made from the text's equation of complex numbers, or
        one of components, made from the text's equation in index notation.
    context : Context
        What is said in words about the names of the claim, and about the body.
    """

    id: str = ""
    where: str = ""
    symbols: tuple[str, ...] = ()
    functions: tuple[str, ...] = ()
    define: tuple[tuple[str, Node], ...] = ()
    hypotheses: tuple[Relation, ...] = ()
    relation: Relation | None = None
    value: Node | None = None
    printed: str = ""
    alternatives: tuple[Relation, ...] = ()
    implied: bool = False
    sources: Mapping[str, str] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    editable: tuple[str, ...] = SIDES
    has_parts: bool = False
    context: Context = NO_CONTEXT

    @property
    def without_context(self) -> "Claim":
        """The claim without its context, the words about its names and its body."""
        return replace(self, context=NO_CONTEXT)

    @property
    def defining(self) -> dict[str, Node]:
        """The names that hypotheses such as ``c1 == cos(alpha)`` define by a scalar formula, each with its formula."""
        definitions: dict[str, Node] = {}
        for sign, left, right in self.hypotheses:
            inside = {str(node.value) for _, node in walk(right) if node.kind in ("name", "call")}
            if sign == "==" and left.kind == "name" and left.value not in inside and shape_of(right, {}) is None:
                definitions.setdefault(str(left.value), right)
        return definitions

    def with_definitions(self, value: Any) -> Any:
        """Return a SymPy value in which each name of :attr:`defining` is replaced by its formula."""
        interpreter = self.interpreter()
        for name, tree in self.defining.items():
            value = value.xreplace({interpreter.read(Node("name", name)): interpreter.read(tree)})
        return value

    @property
    def expanded(self) -> "Claim":
        """The claim in which formulas replace the names of :attr:`defining`, without the hypotheses for these names."""
        definitions = self.defining
        if self.relation is None or not definitions:
            return self
        rest = tuple(
            hypothesis for hypothesis in self.hypotheses if definitions.get(str(hypothesis[1].value)) != hypothesis[2]
        )
        sign, left, right = self.relation
        relation = sign, _substituted(left, definitions), _substituted(right, definitions)
        return replace(self, relation=relation, hypotheses=rest, alternatives=())

    @property
    def text(self) -> str:
        """The claim as text."""
        if self.relation is None:
            return f"{self.sources['value']} == {self.printed}"
        return self.sources.get("claim") or relation_text(self.relation)

    def label(self, key: str) -> str:
        """Return the place of one text of the claim, such as its equation (``key`` "claim"), for error messages."""
        return f"{self.id}: {key}" if self.id else ""

    def with_relation(self, relation: Relation, **changes: Any) -> "Claim":
        """Return the claim with another equation.

        ``changes`` are new values of other fields, on which the definitions must not depend.
        """
        other = replace(self, relation=relation, **changes)
        if "definitions" in self.__dict__:
            other.__dict__["definitions"] = self.definitions
        return other

    def with_parts(self, parts: Mapping[str, Node]) -> "Claim":
        """Return the claim with new trees for some of its parts: ``"left"``, ``"right"`` or names of definitions."""
        assert self.relation is not None
        sign, left, right = self.relation
        relation = (sign, parts.get("left", left), parts.get("right", right))
        if not parts.keys() - {*SIDES}:
            return self.with_relation(relation)
        define = tuple((name, parts.get(name, tree)) for name, tree in self.define)
        return replace(self, relation=relation, define=define)

    @cached_property
    def definitions(self) -> Definitions:
        """The symbols and definitions as SymPy values; a symbol is positive if a hypothesis says so.

        Raises
        ------
        InputError
            For a definition that has no value in SymPy, with its place.
        """
        interpreter = Interpreter(implied=self.implied, functions=set(self.functions))
        values = interpreter.values
        positive = _assumed(self.hypotheses, ">")
        nonnegative = _assumed(self.hypotheses, ">=")
        names = [*self.symbols, *(positive | nonnegative if self.implied else ())]
        for name in names:
            if name in positive:
                values[name] = Symbol(name, positive=True)
            elif name in nonnegative:
                values[name] = Symbol(name, nonnegative=True)
            else:
                values[name] = time if name == "t" else Symbol(name, real=True)
        for number, (name, node) in enumerate(self.define):
            source, place = self.sources.get(f"define.{number}", ""), self.label(f"define {name}")
            values[name] = interpreter.read(node, source, place)
        return Definitions(
            values, frozenset(interpreter.functions), tuple(interpreter.divisors), tuple(interpreter.radicands),
            tuple(interpreter.bases),
        )  # fmt: skip

    def interpreter(self) -> Interpreter:
        """Return a new interpreter, which turns further syntax trees that use the names of the claim into SymPy."""
        known = self.definitions
        return Interpreter(
            values=dict(known.values), functions=set(known.functions), implied=self.implied,
            divisors=list(known.divisors), radicands=list(known.radicands), bases=list(known.bases),
        )  # fmt: skip

    @cached_property
    def equation(self) -> Equation:
        """The equation to be decided.

        Raises
        ------
        InputError
            For a piece that has no value in SymPy, with its place.
        """
        assert self.relation is not None
        interpreter = self.interpreter()
        hypotheses, nonzero = [], []
        for number, relation in enumerate(self.hypotheses):
            sign, left, right = relation
            source = self.sources.get(f"given.{number}", "")
            lhs, rhs = (interpreter.read(side, source, self.label("given")) for side in (left, right))
            if sign == "==":
                hypotheses.extend(_differences(lhs, rhs, self.label("given")))
            elif sign == "!=":
                nonzero.extend(_differences(lhs, rhs, self.label("given")))
        source = self.sources.get("claim", "")
        left, right = self.relation[1:]
        lhs = interpreter.read(left, source, self.label("claim"))
        rhs = lhs if right is left else interpreter.read(right, source, self.label("claim"))
        divisors = tuple(dict.fromkeys(divisor.value for divisor in interpreter.divisors))
        radicands = tuple(dict.fromkeys(interpreter.radicands))
        same = text(left) == text(right)  # equal sides are equal for all bases
        bases = () if same else interpreter.assumed_bases
        return Equation(lhs, rhs, tuple(hypotheses), divisors, tuple(nonzero), radicands, bases)


def _substituted(tree: Node, definitions: Mapping[str, Node]) -> Node:
    """Return a tree in which names are replaced by their formulas in ``definitions``."""
    if tree.kind == "name" and tree.value in definitions:
        return definitions[tree.value]
    return replace(tree, args=tuple(_substituted(child, definitions) for child in tree.args))


def relation_text(relation: Relation) -> str:
    """Return a relation, such as ``left == right`` or ``x > 0``, as text."""
    sign, left, right = relation
    return f"{text(left)} {sign} {text(right)}"


def _differences(left: Any, right: Any, where: str) -> list[Expr]:
    """Return left - right of an equation that is a hypothesis, as a list: one difference for each entry of a matrix."""
    try:
        lefts, rights, _ = matched_sides(left, right)
    except ShapeMismatch:
        raise InputError(f"{where}: expected a hypothesis whose two sides have the same shape") from None
    return [a - b for a, b in zip(lefts, rights, strict=True)]


def _assumed(hypotheses: Sequence[Relation], sign: str) -> set[str]:
    """Return the names x of hypotheses ``x > 0`` (or ``0 < x``). With the sign ``>=``, return those of ``x >= 0``."""
    mirrored = {">": "<", ">=": "<="}[sign]
    zero = ("number", 0)
    names = set()
    for mark, left, right in hypotheses:
        if mark == mirrored:
            left, right = right, left
        if mark in (sign, mirrored) and left.kind == "name" and (right.kind, right.value) == zero:
            names.add(left.value)
    return names


def _hypothesis(source: str, where: str, declared: Declared | None = None, words: Collection[str] = ()) -> Relation:
    """Return a hypothesis, read from text; ``words`` are names of the claim, never split into products of letters."""
    if declared is None and isinstance(source, str) and is_latex(source):
        relation = read_latex(source, where).relation
    elif declared is None:
        relation = read_relation(source, where, Declared(words) if words else None, rates=True)
    else:
        relation = read_relation(source, where, declared)
    if relation[0] in ("==", "!=") or _assumed([relation], ">") or _assumed([relation], ">="):
        return relation
    raise InputError(f"{where}: expected a hypothesis like a == b, a != b, or x > 0 for a symbol x, got {source!r}")


def claim_of_text(source: str, assume: Sequence[str] = (), units: Mapping[str, str] | None = None) -> Claim:
    """Return the claim of a text ``left == right``. Text with a backslash, a brace or a dollar sign is read as LaTeX.

    Names become real symbols, or functions of time if they are written ``f(t)``; so do the names in the hypotheses. A
    text that can be read in two ways is refused; :func:`symrot.checker.claim.lines.claims_of_reading` accepts it.
    """
    vectors: tuple[Vector, ...] = ()
    if isinstance(source, str) and is_latex(source):
        equation = read_latex(source, names=Names(functions=functions_of_time(assume)))
        source, vectors = equation.text, equation.vectors
    return claim_of_relation(read_relation(source), source, assume, units, vectors=vectors)


def claim_of_relation(
    relation: Relation, source: str, assume: Sequence[str] = (), units: Mapping[str, str] | None = None,
    define: Sequence[tuple[str, Node]] = (), notes: Sequence[str] = (), context: Sequence[Node] = (),
    vectors: Sequence[Vector] = (),
) -> Claim:  # fmt: skip
    """Return the claim of an equation that was read from a text.

    ``define`` are the definitions on earlier lines of the text, ``context`` are its other formulas, and ``vectors`` are
    names with three components.

    Raises
    ------
    InputError
        For a relation that is no equation, and for units of names that the claim does not have.
    """
    if relation[0] != "==":
        instead = "an inequality is not decided; write '=' for the case in which both sides are equal"
        raise InputError(f"expected a claim with '=', got '{relation[0]}' in {source[:60]!r} ({instead})")
    relation, on_indices = written_out(relation)
    notes = [*notes, *([on_indices] if on_indices else [])]
    names = {str(node.value) for side in relation[1:] for _, node in walk(side) if node.kind == "name"}
    words = {name for name in names if len(name) > 1 and name.isalpha()}
    matrices = {source: _matrix_given(source, words) for source in assume}
    assume = [source for source in assume if matrices[source] is None]
    define = [*_with_entries([matrix for matrix in matrices.values() if matrix], relation), *define]
    hypotheses = _of_one_time([_hypothesis(source, "given", words=words) for source in assume])
    relation, pauli = with_pauli_matrices(relation, {name for name, _ in define})
    define = [*pauli, *define]
    notes = [*notes, *([ON_PAULI] if pauli else [])]
    unit = None if pauli else imaginary_unit([*relation[1:], *context])
    if unit is not None and not is_complex(relation[1:], str(unit.value)):
        unit = None
    if unit is not None:
        relation = with_parts(relation, str(unit.value), source)
        notes = [*notes, f"{unit.value} is the imaginary unit, and real and imaginary parts are compared"]
    moving_matrices = {name: timed for name, timed in rate_matrices(relation).items() if name not in dict(define)}
    sign, left, right = relation
    relation = sign, without_time(left, moving_matrices), without_time(right, moving_matrices)
    bold = bold_matrices(relation[1:], {vector.name for vector in vectors}) | moving_matrices
    vectors = [vector for vector in vectors if vector.name not in bold]
    define = [*((name, matrix_of_entries(name, timed)) for name, timed in bold.items()), *define]
    arrays = _with_arrays(relation, vectors, define)
    solved = {side.value for side in arrays.relation[1:]} - {side.value for side in relation[1:]}
    define = [(name, tree) for name, tree in define if name not in bold or name not in solved]
    notes = [*notes, *(_on_matrix(name) for name in bold if name not in solved)]
    relation, define, notes = arrays.relation, [*arrays.definitions, *define], [*notes, *arrays.notes]
    vectors = [*vectors, *map(Vector, arrays.vectors)]
    vectors = [vector for vector in vectors if vector.name not in dict(define)]
    relation, vectors, with_units = _with_vectors(relation, vectors, define)
    relation, lengths = with_lengths(relation, _shapes(vectors, define))
    notes = [*notes, *(f"{name} means the length of the vector where a vector makes no sense" for name in lengths)]
    moving = {str(node.value) for v in vectors if v.timed for _, node in walk(v.components) if node.args == (TIME,)}
    relation = relation[0], with_time(relation[1], moving), with_time(relation[2], moving)
    hypotheses += tuple(vector.length_is_one for vector in vectors if vector.unit and not vector.is_axis)
    define = [*((vector.name, vector.components) for vector in vectors), *define]
    notes = [*notes, *_on_vectors(vectors), *(["I is read as the unit matrix"] if with_units else [])]
    everything = [*relation[1:], *context, *(side for hypothesis in hypotheses for side in hypothesis[1:])]
    if has_natural_base(everything) and not any(name == "e" for name, _ in define):
        notes.append("e is read as the base of the exponential function")
        relation = _with_natural_base(relation)
        hypotheses = tuple(map(_with_natural_base, hypotheses))
        define = [(name, with_natural_base(tree)) for name, tree in define]
    sources = {"claim": source.strip(), **{f"given.{n}": text for n, text in enumerate(assume)}}
    sources |= {f"define.{n}": source for n in range(len(define))}
    trees = [
        *relation[1:],
        *(side for hypothesis in hypotheses for side in hypothesis[1:]),
        *(tree for _, tree in define),
        *context,
    ]
    rates = {
        str(node.value) for tree in trees for _, node in walk(tree) if node.kind == "call" and node.args == (TIME,)
    }
    letters = letters_of_quantities(trees)
    of_axes = _with_rotated_axes(relation)
    used = {str(node.value) for side in relation[1:] for _, node in walk(side) if node.kind in ("name", "call")}
    return Claim(
        relation=relation,
        symbols=letters,
        functions=tuple(letter for letter in OTHER_MEANINGS if letter in rates),
        define=tuple(define),
        hypotheses=hypotheses,
        alternatives=() if of_axes == relation else (of_axes,),
        implied=True,
        sources=sources,
        units=check_units(dict(units or {}), used, "claim"),
        has_parts=unit is not None or bool(on_indices),
        notes=(*notes, *(f"{letter} is read as a quantity, not as {OTHER_MEANINGS[letter]}" for letter in letters)),
    )


def _of_one_time(hypotheses: Sequence[Relation]) -> tuple[Relation, ...]:
    """Return hypotheses in which a name with a rate in one of them is a function of time in all of them."""
    nodes = [node for hypothesis in hypotheses for side in hypothesis[1:] for _, node in walk(side)]
    rates = {str(node.value) for node in nodes if node.kind == "call" and node.args == (TIME,)} - {*BUILT_IN}
    return tuple((sign, with_time(left, rates), with_time(right, rates)) for sign, left, right in hypotheses)


def _matrix_given(source: str, words: Collection[str]) -> tuple[str, Node] | None:
    """Return name and formula of a hypothesis that defines a matrix, ``R == R_z(psi)*R_y(theta)``; otherwise None."""
    sign, left, right = _hypothesis(source, "given", words=words)
    is_definition = sign == "==" and left.kind == "name" and shape_of(right, {}) not in (None, (1, 1))
    return (str(left.value), right) if is_definition else None


def _with_entries(matrices: Sequence[tuple[str, Node]], relation: Relation) -> Iterator[tuple[str, Node]]:
    """Yield definitions: of matrices in hypotheses, and of the entries of R that a claim names R_31, R31 or r_31."""
    names = dict.fromkeys(str(node.value) for side in relation[1:] for _, node in walk(side) if node.kind == "name")
    for matrix, tree in matrices:
        yield matrix, tree
        for name in names:
            if entry := re.fullmatch(rf"(?:{matrix}|{matrix.lower()})_?([1-3])_?([1-3])", name):
                places = [number_node(int(digit) - 1) for digit in entry.groups()]
                yield name, Node("index", None, (Node("name", matrix), *places))


def _with_vectors(
    relation: Relation, vectors: list[Vector], define: Sequence[tuple[str, Node]]
) -> tuple[Relation, list[Vector], bool]:
    """Return a relation whose unit matrices are written ``eye(n)``, its vectors, and whether it has unit matrices.

    A name that is added to a vector is a vector too. The name of an inertia, added to a matrix, is a tensor.
    """
    named = {name for name, _ in define} | {vector.name for vector in vectors}
    vectors = [*vectors, *map(Vector, dict.fromkeys(n for n in gyroscopic_tensors(relation[1:]) if n not in named))]
    shapes = _shapes(vectors, define)
    operands = {name: shape for name, shape in operand_names(relation, shapes).items() if name not in named}
    vectors = [*vectors, *map(Vector, operands)]
    shapes |= operands
    with_units = with_unit_matrices(relation, shapes)
    while new := {
        name: shape
        for name, shape in (*added_names(with_units, shapes).items(), *multiplied_names(with_units, shapes).items())
        if shape == (3, 1) or (shape == (3, 3) and is_tensor(name))
    }:
        vectors = [*vectors, *map(Vector, new)]
        shapes |= new
    return with_units, vectors, with_units != relation


def _shapes(vectors: Sequence[Vector], define: Sequence[tuple[str, Node]]) -> dict[str, Shape]:
    """Return the shapes of vectors and of defined names."""
    shapes: dict[str, Shape] = {}
    for name, tree in (*((vector.name, vector.components) for vector in vectors), *define):
        shapes[name] = shape_of(tree, shapes)
    return shapes


def _with_arrays(relation: Relation, vectors: Sequence[Vector], define: Sequence[tuple[str, Node]]) -> Quaternions:
    """Return definitions for the quaternions, matrices and columns that a relation uses, and the changed relation."""
    known = {name for name, _ in define}
    names = {vector.name for vector in vectors}
    generic = {*matrices_of_entries(define)}
    arrays = used_quaternions(relation, names, _shapes(vectors, define), known - generic)
    known |= names | {name for name, _ in arrays.definitions}
    matrices = used_matrices(arrays.relation[1:], known)
    columns = [name for name in used_columns(arrays.relation[1:], known) if name not in matrices]
    return replace(
        arrays,
        definitions=(*arrays.definitions, *((name, matrix_of_entries(name)) for name in matrices)),
        relation=_with_scalar_products(arrays.relation, [*columns, *names]),
        vectors=(*arrays.vectors, *columns),
        notes=(
            *arrays.notes,
            *map(_on_matrix, matrices),
        ),
    )


def _on_matrix(name: str) -> str:
    """Return the note on a name that is read as a matrix."""
    return (
        f"{name} is any 3 x 3 matrix with the entries {name}_11, {name}_12 and so on; "
        f"a rotation is stated as --given '{name} = R_z(a) R_x(b) R_z(c)'"
    )


def _with_scalar_products(relation: Relation, names: Sequence[str]) -> Relation:
    sign, left, right = relation
    return sign, with_scalar_products(left, names), with_scalar_products(right, names)


def _on_vectors(vectors: Sequence[Vector]) -> Iterator[str]:
    """Yield notes on the names that are read as vectors and tensors."""
    columns = [vector for vector in vectors if not is_tensor(vector.name) and not vector.is_axis]
    if columns:
        *others, last = sorted(vector.name for vector in columns)
        are = f"{', '.join(others)} and {last} are vectors" if others else f"{last} is a vector"
        first = min(columns, key=lambda vector: vector.name)
        parts = ", ".join(f"{first.name}_{axis}" for axis in first.axes)
        yield f"{are} with the components {parts}{' and so on' if others else ''}"
    for vector in vectors:
        if is_tensor(vector.name):
            yield f"{vector.name} is a symmetric tensor with the entries {vector.name}_xx, {vector.name}_xy and so on"
        if vector.is_axis:
            yield f"{vector.name} with a hat is the {vector.name} axis"
        elif vector.unit:
            yield f"{vector.name} has the length 1, as its hat says"


def _with_natural_base(relation: Relation) -> Relation:
    sign, left, right = relation
    return sign, with_natural_base(left), with_natural_base(right)


def _with_rotated_axes(relation: Relation) -> Relation:
    """Return a relation with R_x(-a) in place of ``R_x(a)``, which in some books rotates the axes, not the vectors."""

    def turned(node: Node) -> Node:
        args = tuple(map(turned, node.args))
        if node.kind == "call" and node.value in ROTATIONS and "_" in node.value:
            args = (negated(args[0]),)
        return replace(node, args=args)

    sign, left, right = relation
    return sign, turned(left), turned(right)


# -- TOML -------------------------------------------------------------------------------------------------------------

TEXT_KEYS = (
    "id", "body", "frame", "sequence", "source", "note", "printed", "kind", "claim", "latex", "value", "printed_value",
    "against",
)  # fmt: skip
LIST_KEYS = ("symbols", "functions", "given", "alternatives", "lost", "editable")
OTHER_KEYS = ("where", "define", "units")
"""The keys of a claim, by the type of their value."""

FILE_KEYS = ("schema", "claim", "document", "title", "kind", "lost", "note")
"""The keys of a file; the last five describe the document from which its claims come."""

MOST_CLAIMS = 2000
MOST_NAMES = 500
"""The most claims of a file, and the most names that one claim may declare or define."""


@dataclass(frozen=True)
class Refusal:
    """An entry of a file that cannot be read as a claim: its id, place and text, and a sentence with the reason."""

    id: str
    where: str
    text: str
    reason: str


def read_claims(path: str | Path) -> list[Claim]:
    """Return the claims of a TOML file, all of which must be readable.

    Raises
    ------
    InputError
        Naming the file, the claim, the key, and the expected value.
    """
    entries = read_entries(path)
    for entry in entries:
        if isinstance(entry, Refusal):
            raise InputError(entry.reason)
    return [entry for entry in entries if isinstance(entry, Claim)]


def read_entries(path: str | Path) -> list[Claim | Refusal]:
    """Return the claims of a TOML file, with a :class:`Refusal` in place of each claim that cannot be read.

    Raises
    ------
    InputError
        If the file as a whole is not a file of claims.
    """
    from symrot.scene.file import read_toml

    label = str(path)
    table = read_toml(Path(path), label, "claim")
    if table.get("schema") != 1:
        raise InputError(f"{label}: expected schema = 1, got {table.get('schema')!r}")
    unknown = next((key for key in table if key not in FILE_KEYS), None)
    if unknown is not None:
        raise InputError(f"{label}: expected schema and [[claim]] tables, got the key {unknown[:40]!r}")
    tables = table.get("claim")
    if not isinstance(tables, list) or not tables or not all(isinstance(entry, dict) for entry in tables):
        raise InputError(f"{label}: expected [[claim]] tables, got {'none' if not tables else 'something else'}")
    if len(tables) > MOST_CLAIMS:
        raise InputError(f"{label}: expected at most {MOST_CLAIMS} claims in a file, got {len(tables)}")
    entries: list[Claim | Refusal] = []
    names: set[str] = set()
    for number, entry in enumerate(tables, start=1):
        try:
            claim = _claim(entry, number, label)
            if claim.id in names:
                raise InputError(f"{label}: expected every id once, got {claim.id!r} twice")
            names.add(claim.id)
            entries.append(claim)
        except InputError as reason:
            name, where, excerpt = (str(entry.get(key, other))[:80] for key, other in (
                ("id", f"claim-{number}"), ("where", ""), ("claim", entry.get("latex", "")),
            ))  # fmt: skip
            place = where if isinstance(entry.get("where", ""), str) else ""
            entries.append(Refusal(name, place, excerpt, str(reason)))
    return entries


def _claim(entry: dict[str, Any], number: int, label: str) -> Claim:
    name = entry.get("id", f"claim-{number}")
    if not isinstance(name, str):
        raise InputError(f"{label}: claim {number}: expected a text as the value of id, got {name!r}")
    place = f"{label}: {name}"
    for key, value in entry.items():
        _check_key(key, value, place)
    symbols, functions = _names(entry, "symbols", place), _names(entry, "functions", place)
    define, sources = [], {}
    known = {*symbols, *functions}
    if len(known) < len(symbols) + len(functions):
        raise InputError(f"{place}: expected every symbol and function to be declared once")
    if len(known) + len(entry.get("define", ())) > MOST_NAMES:
        raise InputError(f"{place}: expected at most {MOST_NAMES} names in a claim, got {len(known)} and more")
    for place_of, (defined, formula) in enumerate(entry.get("define", ())):
        _check_name(defined, "define", place)
        if defined in known:
            raise InputError(f"{place}: define: expected a new name, got {defined!r}, which the claim has already")
        known.add(defined)
        own = Declared((known | {*symbols}) - {*functions}, functions)
        define.append((defined, read_expression(formula, f"{place}: define {defined}", own)))
        sources[f"define.{place_of}"] = formula
    own = Declared(known - {*functions}, functions)
    hypotheses = tuple(_hypothesis(text, f"{place}: given", own) for text in entry.get("given", ()))
    sources |= {f"given.{n}": text for n, text in enumerate(entry.get("given", ()))}
    where = entry.get("where", "")
    meanings = [] if isinstance(where, str) else where
    body, frame, sequence = (str(entry.get(key, "")) for key in ("body", "frame", "sequence"))
    context = read_context(meanings, body, frame, sequence, label=place)
    units = check_units(entry.get("units", {}), known, place)
    claim = Claim(
        name, "" if meanings else where, symbols, functions, tuple(define), hypotheses, sources=sources,
        units={**context.units({*symbols}, units), **units}, editable=_editable(entry, define, place), context=context,
    )  # fmt: skip
    others = list(entry.get("alternatives", ()))
    kinds = [key for key in ("claim", "latex", "value") if key in entry]
    if not kinds and others:
        entry, kinds = {**entry, "claim": others.pop(0)}, ["claim"]
    if len(kinds) != 1:
        raise InputError(f"{place}: expected exactly one of claim, latex and value, got {', '.join(kinds) or 'none'}")
    if kinds == ["value"]:
        if "printed_value" not in entry:
            raise InputError(f"{place}: expected the key printed_value together with the key value, got value alone")
        if others:
            raise InputError(
                f"{place}: alternatives: expected other readings of a claim, got them together with a value"
            )
        sources["value"] = entry["value"]
        value = read_expression(entry["value"], f"{place}: value", own)
        return replace(claim, value=value, printed=entry["printed_value"])
    (key,) = kinds
    names = None
    readings = []
    for number_of, (source, at) in enumerate([(entry[key], key), *((other, "alternatives") for other in others)]):
        if is_latex(source) or (number_of == 0 and key == "latex"):
            names = names or _names_for_latex(claim)
            reading = read_latex(source, f"{place}: {at}", names)
            readings.append((reading.relation, reading.text))
        else:
            readings.append((_equation(source, f"{place}: {at}", own), source))
    (relation, sources["claim"]), *rest = readings
    try:
        context.check_names({name for side in relation[1:] for name in quantities_of(side)})
    except InputError as reason:
        raise InputError(f"{place}: {reason}") from None
    return claim.with_relation(relation, alternatives=tuple(other for other, _ in rest))


def is_latex(source: str) -> bool:
    """Return whether a text is LaTeX: it has a backslash, a brace or a dollar sign."""
    return any(mark in source for mark in "\\${")


def functions_of_time(assume: Sequence[str]) -> set[str]:
    """Return the names f that occur in hypotheses as ``f(t)`` or with a time derivative."""
    sides = [
        side
        for source in assume
        for side in (
            read_latex(source, "given").relation[1:]
            if is_latex(source)
            else [side for chain in readings_of(source, "given")[0].lines for side in chain.sides]
        )
    ]
    return {
        str(node.value)
        for side in sides
        for _, node in walk(side)
        if node.kind == "call" and node.value not in BUILT_IN and [part.value for part in node.args] == ["t"]
    }


def check_units(units: dict[str, str], known: set[str], place: str) -> dict[str, str]:
    """Return the units of a claim. Raise InputError for an unknown unit, or for a name that the claim does not have."""
    for name, unit in units.items():
        if name not in known:
            raise InputError(f"{place}: units: expected units of names that the claim has, got {str(name)[:40]!r}")
        if not isinstance(unit, str):
            raise InputError(f"{place}: units: expected the unit of {name} as text, got {unit!r}")
        read_unit(unit, f"{place}: units: {name}")
    return units


def _names_for_latex(claim: Claim) -> Names:
    """Return the names of a claim for the LaTeX reader, with matrices and columns in separate sets."""
    values = claim.definitions.values
    defined = [name for name, _ in claim.define]
    matrices = {name for name in defined if is_matrix(values[name])}
    columns = {name for name in matrices if values[name].cols == 1}
    return Names(claim.symbols, claim.functions, matrices, columns, {*defined} - matrices, implied=False)


def _equation(source: str, where: str, declared: Declared) -> Relation:
    relation = read_relation(source, where, declared)
    if relation[0] != "==":
        raise InputError(f"{where}: expected '==', got '{relation[0]}' in {source[:60]!r}")
    return relation


def _check_key(key: str, value: Any, place: str) -> None:
    if key in TEXT_KEYS:
        expected, fits = "text", isinstance(value, str)
    elif key in LIST_KEYS:
        expected, fits = "a list of texts", isinstance(value, list) and all(isinstance(v, str) for v in value)
    elif key == "define":
        expected = 'a list of pairs ["name", "formula"]'
        fits = isinstance(value, list) and all(
            isinstance(pair, list) and len(pair) == 2 and all(isinstance(v, str) for v in pair) for pair in value
        )
    elif key == "where":
        expected = "a text, the place in a document, or a list of texts 'NAME = words'"
        fits = isinstance(value, str) or (isinstance(value, list) and all(isinstance(v, str) for v in value))
    elif key == "units":
        expected = "a table of units by symbol"
        fits = isinstance(value, dict) and all(isinstance(v, str) for v in value.values())
    else:
        keys = ", ".join((*TEXT_KEYS, *LIST_KEYS, *OTHER_KEYS))
        raise InputError(f"{place}: expected one of the keys {keys}, got {key!r}")
    if not fits:
        raise InputError(f"{place}: {key}: expected {expected}, got {str(value)[:60]!r}")


def _names(entry: dict[str, Any], key: str, place: str) -> tuple[str, ...]:
    names = entry.get(key, [])
    for name in names:
        _check_name(name, key, place)
    if len(set(names)) < len(names):
        twice = next(name for number, name in enumerate(names) if name in names[:number])
        raise InputError(f"{place}: {key}: expected every name once, got {twice!r} twice")
    return tuple(names)


def _editable(entry: dict[str, Any], define: Sequence[tuple[str, Node]], place: str) -> tuple[str, ...]:
    """Return the parts of a claim that repairs may change: those that its entry lists, by default both sides."""
    parts = tuple(entry.get("editable", SIDES))
    known = (*SIDES, *(name for name, _ in define))
    for part in parts:
        if part not in known:
            raise InputError(f"{place}: editable: expected left, right or the name of a definition, got {part[:40]!r}")
    return parts


def _check_name(name: str, key: str, place: str) -> None:
    if not (name.isascii() and name.isidentifier() and name[0].isalpha()):
        raise InputError(f"{place}: {key}: expected a name of letters, digits and underscores, got {name[:40]!r}")
    if name in BUILT_IN or name in CONSTANTS:
        raise InputError(f"{place}: {key}: expected a name of your own, got {name!r}, which is built in")
