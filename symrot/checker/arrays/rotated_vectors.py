"""The matrix R of a linear map, from an equation such as ``R v = q v q*`` or ``R v = v cos θ + n × v sin θ + ..``.

The equation holds for every vector v. So R is the matrix of the map from v to the other side.
"""

from collections.abc import Collection

from symrot.checker.claim.tree import Node, column_vector, matrix_of_rows, nodes_of, number, substituted

__all__ = ["as_matrix_of_map"]

Relation = tuple[str, Node, Node]


def as_matrix_of_map(relation: Relation, vectors: Collection[str], known: Collection[str]) -> tuple[Relation, str]:
    """Turn ``R v = f(v)`` into the equation R = (matrix of f), with a note; return other equations unchanged.

    Parameters
    ----------
    relation : Relation
        The equation, in which f is a product of quaternions, or a sum with cross or dot products of v.
    vectors : collection of str
        The names of vectors.
    known : collection of str
        The names that the claim defines; R is not one of them.
    """
    sign, left, right = relation
    for side, image in ((left, right), (right, left)):
        factors = side.args if side.kind == "product" else ()
        if len(factors) != 2 or factors[1].kind != "name" or factors[1].value not in vectors:
            continue
        matrix, vector = factors
        name = matrix.args[0] if matrix.kind == "transpose" else matrix
        is_matrix = name.kind == "name" and str(name.value)[0].isupper() and name.value not in known
        if not is_matrix or not _is_image(image, vector) or name in nodes_of(image):
            continue
        rows = _matrix_of(image, vector)
        written = f"{name.value}^T" if matrix.kind == "transpose" else str(name.value)
        rows = Node("transpose", None, (rows,)) if matrix.kind == "transpose" else rows
        note = f"{written} is read as the matrix that maps every {vector.value} to the vector on the other side"
        return ((sign, name, rows) if side is left else (sign, rows, name)), note
    return relation, ""


def _is_image(image: Node, vector: Node) -> bool:
    """Return whether the form of a formula ``image`` shows that it is a linear map of ``vector``, here v.

    True for the vector part of a formula that contains v once, such as ``q v q*``; also for a formula that is linear in
    v and has v in a cross or dot product, such as ``v cos θ + n × v sin θ``.
    """
    nodes = nodes_of(image)
    if image.kind == "call" and image.value == "vector_part":
        return nodes.count(vector) == 1
    products = [node for node in nodes if node.kind == "call" and node.value in ("cross", "dot")]
    return _is_linear(image, vector) and any(vector in part for part in map(nodes_of, products))


def _is_linear(tree: Node, vector: Node) -> bool:
    """Return whether a formula is linear in a vector by its form: by sums, products, and cross and dot products."""
    if tree == vector:
        return True
    if tree.kind in ("sum", "neg"):
        return all(_is_linear(term, vector) for term in tree.args)
    is_product = tree.kind == "product" or (tree.kind == "call" and tree.value in ("cross", "dot"))
    factors = [factor for factor in tree.args if vector in nodes_of(factor)]
    return is_product and len(factors) == 1 and _is_linear(factors[0], vector)


def _matrix_of(image: Node, vector: Node) -> Node:
    """Return the matrix of the linear map that takes ``vector`` to ``image``.

    Its columns are the images of the unit vectors.
    """
    units = [column_vector([number(int(place == n)) for n in range(3)]) for place in range(3)]
    columns = [substituted(image, {str(vector.value): unit}) for unit in units]
    rows = [[Node("index", None, (own, number(row), number(0))) for own in columns] for row in range(3)]
    return matrix_of_rows(rows)
