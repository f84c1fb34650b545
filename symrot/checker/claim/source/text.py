"""Reading a claim from the text of one equation, with its hypotheses, vectors, matrices and quaternions."""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from symrot.checker.arrays.complex_parts import imaginary_unit, is_complex, with_parts
from symrot.checker.arrays.index_notation import written_out
from symrot.checker.arrays.matrices import (
    bold_matrices,
    bold_unit_matrices,
    matrices_of_entries,
    matrix_of_entries,
    rate_matrices,
    used_columns,
    used_matrices,
    with_lengths,
    without_time,
)
from symrot.checker.arrays.matrices_of_vectors import with_matrices_of_vectors
from symrot.checker.arrays.pauli import with_pauli_matrices
from symrot.checker.arrays.quaternions import Quaternions, used_quaternions
from symrot.checker.arrays.rotated_vectors import as_matrix_of_map
from symrot.checker.claim.claims import Claim, assumed_names
from symrot.checker.claim.functions import BUILT_IN, ROTATIONS, arguments_expected
from symrot.checker.claim.quantities import (
    OTHER_MEANINGS,
    has_natural_base,
    letters_of_quantities,
    with_natural_base,
)
from symrot.checker.claim.reader import read_relation, readings_of, with_time
from symrot.checker.claim.shapes import (
    Shape,
    added_names,
    multiplied_names,
    operand_names,
    shape_of,
    with_unit_matrices,
)
from symrot.checker.claim.tree import TIME, Node, names_in, negated, nodes_of
from symrot.checker.claim.tree import number as number_node
from symrot.checker.claim.vectors import Vector, gyroscopic_tensors, is_tensor, with_scalar_products
from symrot.checker.context.context import quantities_of
from symrot.checker.latex.reader import Names, read_latex
from symrot.checker.typed.readings import Declared, Relation
from symrot.checker.units.units import read_unit
from symrot.errors import InputError, complaint

__all__ = [
    "ON_PAULI", "check_units", "claim_of_relation", "claim_of_text", "functions_of_time", "is_latex",
    "names_in_hypotheses", "read_hypothesis",
]  # fmt: skip

ON_PAULI = "sigma_x, sigma_y and sigma_z are Pauli's matrices, and i is the imaginary unit"


def claim_of_text(source: str, assume: Sequence[str] = (), units: Mapping[str, str] | None = None) -> Claim:
    """Return the claim of a text ``left == right``, which may be LaTeX.

    An ambiguous text raises InputError.
    """
    # claims_of_reading accepts ambiguous texts
    vectors: tuple[Vector, ...] = ()
    if isinstance(source, str) and is_latex(source):
        equation = read_latex(source, names=Names(functions=functions_of_time(assume)))
        source, vectors = equation.text, equation.vectors
    return claim_of_relation(read_relation(source), source, assume, units, vectors=vectors)


def claim_of_relation(
    relation: Relation, source: str, assume: Sequence[str] = (), units: Mapping[str, str] | None = None,
    define: Sequence[tuple[str, Node]] = (), notes: Sequence[str] = (), context: Sequence[Node] = (),
    vectors: Sequence[Vector] = (), pauli_as_numbers: bool = False,
) -> Claim:  # fmt: skip
    """Return the claim of an equation in a text.

    ``define`` and ``context`` are the definitions and the other formulas of the same text. With ``pauli_as_numbers``,
    sigma_x is a number, such as a stress, and not one of Pauli's matrices.

    Raises
    ------
    InputError
        For a relation that is no equation, a built-in function with too few or too many arguments, a hypothesis that
        cannot be read, and a unit that is unknown or belongs to a name that the claim does not have.
    """
    if relation[0] != "==":
        instead = "an inequality cannot be decided here; write '=' to ask whether both sides are equal"
        raise InputError(f"expected a claim with '=', got '{relation[0]}' in {source[:60]!r} ({instead})")
    _check_arguments((*relation[1:], *(tree for _, tree in define), *context), source.strip())
    relation, on_indices = written_out(relation)
    notes = [*notes, *([on_indices] if on_indices else [])]
    relation, on_form = _with_own_name(relation)
    notes = [*notes, *([on_form] if on_form else [])]
    names = names_in(*relation[1:])
    words = {name for name in names if len(name) > 1 and name.isalpha()}
    matrices = {source: _matrix_given(source, words) for source in assume}
    assume = [source for source in assume if matrices[source] is None]
    define = [*_with_entries([matrix for matrix in matrices.values() if matrix], relation), *define]
    hypotheses = _of_one_time([read_hypothesis(source, "given", words=words) for source in assume])
    with_matrices = with_matrices_of_vectors(relation, vectors, {name for name, _ in define})
    vectors = [*(vector for vector in vectors if vector.name not in with_matrices.letters), *with_matrices.vectors]
    relation, notes = with_matrices.relation, [*notes, *with_matrices.notes]
    known = {name for name, _ in define}
    relation, pauli = (relation, ()) if pauli_as_numbers else with_pauli_matrices(relation, known)
    define = [*pauli, *define]
    notes = [*notes, *([ON_PAULI] if pauli else [])]
    unit = None if pauli else imaginary_unit([*relation[1:], *context])
    is_vector = unit is not None and unit.value in {vector.name for vector in vectors}
    if unit is not None and (is_vector or not is_complex(relation[1:], str(unit.value))):
        unit = None
    unsplit = None
    if unit is not None:
        unsplit = str(unit.value), relation
        relation = with_parts(relation, str(unit.value), source)
        notes = [*notes, f"{unit.value} is the imaginary unit, and real and imaginary parts are compared"]
    moving_matrices = {
        name: timed for name, timed in rate_matrices(relation).items() if name not in (*dict(define), *BUILT_IN)
    }
    sign, left, right = relation
    relation = sign, without_time(left, moving_matrices), without_time(right, moving_matrices)
    vectors = [vector for vector in vectors if vector.name not in bold_unit_matrices(relation[1:])]
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
    own = {name for name, _ in define} - {*bold}
    linear, on_map = as_matrix_of_map(relation, {vector.name for vector in vectors}, own)
    if on_map:
        solved = {side.value for side in linear[1:]} - {side.value for side in relation[1:]}
        define = [(name, tree) for name, tree in define if name not in solved]
        notes = [*(note for note in notes if note not in map(_on_matrix, solved)), on_map]
        relation = linear
        used = {node.value for node in nodes_of(*relation[1:])}
        vectors = [vector for vector in vectors if vector.name in used]
    relation, lengths = with_lengths(relation, _shapes(vectors, define))
    notes = [*notes, *(f"{name} means the length of the vector where a vector makes no sense" for name in lengths)]
    moving = {str(node.value) for v in vectors if v.timed for node in nodes_of(v.components) if node.args == (TIME,)}
    relation = relation[0], with_time(relation[1], moving), with_time(relation[2], moving)
    hypotheses += tuple(vector.length_is_one for vector in vectors if vector.unit and not vector.is_axis)
    define = [*((vector.name, vector.components) for vector in vectors), *define]
    hidden = {vector.name for vector in with_matrices.vectors}  # unit vectors without a hat
    named = [replace(vector, unit=vector.unit and vector.name not in hidden) for vector in vectors]
    notes = [*notes, *_on_vectors(named), *(["I is read as the unit matrix"] if with_units else [])]
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
    calls = (node for node in nodes_of(*trees) if node.kind == "call")
    functions = {str(node.value) for node in calls if node.args == (TIME,)}
    letters = letters_of_quantities(trees)
    of_axes = _with_rotated_axes(relation)
    used = {str(node.value) for node in nodes_of(*relation[1:]) if node.kind in ("name", "call")}
    return Claim(
        relation=relation,
        symbols=letters,
        functions=tuple(letter for letter in OTHER_MEANINGS if letter in functions),
        define=tuple(define),
        hypotheses=hypotheses,
        alternatives=() if of_axes == relation else (of_axes,),
        implied=True,
        sources=sources,
        units={**_units_of_directions(vectors), **check_units(dict(units or {}), used, "claim")},
        has_parts=unit is not None or bool(on_indices),
        written=with_matrices.written,
        unsplit=unsplit,
        notes=(*notes, *(f"{letter} is read as a quantity, not as {OTHER_MEANINGS[letter]}" for letter in letters)),
    )


def _check_arguments(trees: Sequence[Node], source: str) -> None:
    """Raise InputError if a built-in function, such as ``dot``, has too few or too many arguments in a tree.

    ``Matrix`` and ``diff`` without brackets are refused too.
    """
    for node in nodes_of(*trees):
        if node.kind == "name" and node.value in ("Matrix", "diff"):
            raise complaint(source, "", node.span[0], f"brackets after the function {node.value}")
        if node.kind == "call" and node.value in BUILT_IN and (expected := arguments_expected(node)):
            raise complaint(source, "", node.span[0], expected)


def _with_own_name(relation: Relation) -> tuple[Relation, str]:
    """Return ``I_n = n.T*I*n`` for ``I = n.T*I*n``, and a note for the user; other equations unchanged, with an empty
    note.
    """
    sign, left, right = relation
    first, *rest = right.args if right.kind == "product" else (right,)
    is_form = first.kind == "transpose" and len(rest) > 1 and rest[-1] == first.args[0] and rest[-1].kind == "name"
    if left.kind != "name" or not is_form or left not in rest[:-1]:
        return relation, ""
    name = f"{left.value}_{rest[-1].value}"
    note = f"{left.value} on the left is the moment {name} about the axis {rest[-1].value}, on the right the tensor"
    # the left side is a number, the I on the right a tensor
    return (sign, Node("name", name), right), note


def _of_one_time(hypotheses: Sequence[Relation]) -> tuple[Relation, ...]:
    """Return hypotheses with ``f(t)`` for f, if one of them has ``f(t)`` or a time derivative of f."""
    nodes = [node for hypothesis in hypotheses for node in nodes_of(*hypothesis[1:])]
    rates = {str(node.value) for node in nodes if node.kind == "call" and node.args == (TIME,)} - {*BUILT_IN}
    return tuple((sign, with_time(left, rates), with_time(right, rates)) for sign, left, right in hypotheses)


def _matrix_given(source: str, words: Collection[str]) -> tuple[str, Node] | None:
    """Return R and its formula for a hypothesis such as ``R == R_z(psi)*R_y(theta)``; None if no matrix is defined.

    ``source`` is the text of the hypothesis. ``words`` are the names of several letters in the claim; the hypothesis is
    read with the same names, not as products of letters.
    """
    sign, left, right = read_hypothesis(source, "given", words=words)
    is_definition = sign == "==" and left.kind == "name" and shape_of(right, {}) not in (None, (1, 1))
    return (str(left.value), right) if is_definition else None


def _with_entries(matrices: Sequence[tuple[str, Node]], relation: Relation) -> Iterator[tuple[str, Node]]:
    """Yield pairs (name, formula): the definitions ``matrices``, and (R_31, ``R[2, 0]``) for each entry in a
    relation.
    """
    names = dict.fromkeys(str(node.value) for node in nodes_of(*relation[1:]) if node.kind == "name")
    for matrix, tree in matrices:
        yield matrix, tree
        for name in names:
            if entry := re.fullmatch(rf"(?:{matrix}|{matrix.lower()})_?([1-3])_?([1-3])", name):
                places = [number_node(int(digit) - 1) for digit in entry.groups()]
                # R_31, R31 or r_31
                yield name, Node("index", None, (Node("name", matrix), *places))


def _with_vectors(
    relation: Relation, vectors: list[Vector], define: Sequence[tuple[str, Node]]
) -> tuple[Relation, list[Vector], bool]:
    """Return (relation, vectors, changed): a relation with ``eye(n)`` for the unit matrix I or 1, and its vectors.

    The list of vectors has ``vectors`` and the undefined names that the relation uses as vectors or inertia tensors,
    such as b in ``cross(a, b)``. ``define`` are the definitions of the claim. "changed" says whether there was a unit
    matrix.
    """
    # defined names are no new vectors
    named = {name for name, _ in define} | {vector.name for vector in vectors}
    vectors = [*vectors, *map(Vector, dict.fromkeys(n for n in gyroscopic_tensors(relation[1:]) if n not in named))]
    shapes = _shapes(vectors, define)
    operands = {name: shape for name, shape in operand_names(relation, shapes).items() if name not in named}
    vectors = [*vectors, *map(Vector, operands)]
    shapes |= operands
    with_units = with_unit_matrices(relation, shapes)
    # a name that is added to a vector is one, as is the name of an inertia that is added to a matrix
    while new := {
        name: shape
        for name, shape in (*added_names(with_units, shapes).items(), *multiplied_names(with_units, shapes).items())
        if shape == (3, 1) or (shape == (3, 3) and is_tensor(name))
    }:
        vectors = [*vectors, *map(Vector, new)]
        shapes |= new
    return with_units, vectors, with_units != relation


def _shapes(vectors: Sequence[Vector], define: Sequence[tuple[str, Node]]) -> dict[str, Shape]:
    """Return the shapes (rows, columns) of vectors and of defined names."""
    shapes: dict[str, Shape] = {}
    for name, tree in (*((vector.name, vector.components) for vector in vectors), *define):
        shapes[name] = shape_of(tree, shapes)
    return shapes


def _with_arrays(relation: Relation, vectors: Sequence[Vector], define: Sequence[tuple[str, Node]]) -> Quaternions:
    """Return an equation together with the quaternions, matrices and columns that it uses without a definition.

    ``vectors`` and ``define`` are the vectors and definitions that the claim already has. In the result,
    ``definitions`` holds the components of the quaternions and the entries of the matrices. ``vectors`` has the names
    of the columns, and of the vectors that are multiplied by quaternions. ``relation`` is the equation with
    ``qmul(q, p)`` for the product of quaternions and ``dot(a, b)`` for ``a^T b``.
    """
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
    """Return the note for the user that ``name`` is read as a matrix with any entries."""
    return (
        f"{name} is any 3 x 3 matrix with the entries {name}_11, {name}_12 and so on; "
        f"a rotation is stated as --given '{name} = R_z(a) R_x(b) R_z(c)'"
    )


def _with_scalar_products(relation: Relation, names: Sequence[str]) -> Relation:
    sign, left, right = relation
    names = [name for name in names if not is_tensor(name)]
    return sign, with_scalar_products(left, names), with_scalar_products(right, names)


def _on_vectors(vectors: Sequence[Vector]) -> Iterator[str]:
    """Yield the notes for the user on the names that are read as vectors and tensors."""
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
        if vector.place is not None:
            yield f"{vector.name} is the unit vector of the {'xyz'[vector.place]} axis"
        elif vector.is_axis:
            yield f"{vector.name} with a hat is the {vector.name} axis"
        elif vector.unit:
            yield f"{vector.name} has the length 1, as its hat says"


def _units_of_directions(vectors: Sequence[Vector]) -> dict[str, str]:
    """Return {"n_x": "1"}, the unit 1 (dimensionless) for each component of each vector whose length is 1.

    Without this entry, the letter of a component would suggest a unit: rad/s for omega_x, although the vector is omega
    with a hat, a direction. Coordinate axes such as e_x are left out: their components are the numbers 0 and 1.
    """
    return {f"{v.name}_{axis}": "1" for v in vectors if v.unit and not v.is_axis for axis in v.axes}


def _with_natural_base(relation: Relation) -> Relation:
    sign, left, right = relation
    return sign, with_natural_base(left), with_natural_base(right)


def _with_rotated_axes(relation: Relation) -> Relation:
    """Return a relation with ``R_x(-a)`` in place of ``R_x(a)``, for books in which ``R_x(a)`` rotates the axes."""

    def turned(node: Node) -> Node:
        args = tuple(map(turned, node.args))
        if node.kind == "call" and node.value in ROTATIONS and "_" in node.value:
            args = (negated(args[0]),)
        return replace(node, args=args)

    sign, left, right = relation
    return sign, turned(left), turned(right)


def read_hypothesis(source: str, where: str, declared: Declared | None = None, words: Collection[str] = ()) -> Relation:
    """Return a hypothesis such as ``x > 0`` as (sign, left, right); raise InputError if it cannot be read.

    ``declared`` are the names of a claim that declares its names; names in ``words`` are not split into letters.
    """
    if declared is None and isinstance(source, str) and is_latex(source):
        relation = read_latex(source, where).relation
    elif declared is None:
        relation = read_relation(source, where, Declared(words) if words else None, rates=True)
    else:
        relation = read_relation(source, where, declared)
    if relation[0] in ("==", "!=") or assumed_names([relation], ">") or assumed_names([relation], ">="):
        return relation
    raise InputError(f"{where}: expected a hypothesis like a == b, a != b, or x > 0 for a symbol x, got {source!r}")


def is_latex(source: str) -> bool:
    """Return whether a text is LaTeX: it has a backslash, a brace or a dollar sign."""
    return any(mark in source for mark in "\\${")


def names_in_hypotheses(assume: Sequence[str]) -> set[str]:
    """Return the names of quantities in hypotheses; the rate of phi has the name dphi."""
    return {name for side in _sides_of_hypotheses(assume) for name in quantities_of(side)}


def _sides_of_hypotheses(assume: Sequence[str]) -> list[Node]:
    return [
        side
        for source in assume
        for side in (
            read_latex(source, "given").relation[1:]
            if is_latex(source)
            else [side for chain in readings_of(source, "given")[0].lines for side in chain.sides]
        )
    ]


def functions_of_time(assume: Sequence[str]) -> set[str]:
    """Return the names that hypotheses write as ``f(t)`` or with a time derivative."""
    return {
        str(node.value)
        for node in nodes_of(*_sides_of_hypotheses(assume))
        if node.kind == "call" and node.value not in BUILT_IN and [part.value for part in node.args] == ["t"]
    }


def check_units(units: dict[str, str], known: set[str], place: str) -> dict[str, str]:
    """Return the units of a claim; raise InputError for an unknown unit, or for a name that the claim does not have."""
    for name, unit in units.items():
        if name not in known:
            raise InputError(
                f"{place}: units: expected units only for names that occur in the claim, got {str(name)[:40]!r}"
            )
        if not isinstance(unit, str):
            raise InputError(f"{place}: units: expected the unit of {name} as text, got {unit!r}")
        read_unit(unit, f"{place}: units: {name}")
    return units
