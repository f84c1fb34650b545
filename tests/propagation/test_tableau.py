"""The coefficients of DOP853 satisfy all order conditions of Runge-Kutta theory to every printed digit.

Rooted trees: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., sections II.2 and II.6.
"""

from decimal import Decimal, getcontext
from functools import cache
from itertools import combinations_with_replacement
from math import prod

import numpy as np
import pytest

from symrot.propagation.steppers import tableau

getcontext().prec = 50
PRINTED = Decimal("1e-24")  # dop853.f has 28 to 30 digits, and the weights reach 400
NODES = [Decimal(tableau.NODES[stage]) for stage in sorted(tableau.NODES)]
STAGES = len(NODES)

Tree = tuple  # of its branches, each a tree; the single vertex is ()


@cache
def trees(order: int) -> tuple[Tree, ...]:
    """Return all rooted trees with ``order`` vertices."""
    return tuple(sorted({tuple(sorted(forest)) for forest in _forests(order - 1, order - 1)}))


@cache
def _forests(vertices: int, largest: int) -> tuple[tuple[Tree, ...], ...]:
    if vertices == 0:
        return ((),)
    return tuple(
        (*chosen, *rest)
        for size in range(min(vertices, largest), 0, -1)
        for count in range(1, vertices // size + 1)
        for chosen in combinations_with_replacement(trees(size), count)
        for rest in _forests(vertices - size * count, size - 1)
    )


def vertices(tree: Tree) -> int:
    return 1 + sum(map(vertices, tree))


def density(tree: Tree) -> int:
    return vertices(tree) * prod(map(density, tree))


def rows() -> list[dict[int, Decimal]]:
    """Return the coefficients of every stage; stage 13 is the end of the step."""
    table = {**tableau.STAGE_WEIGHTS, 13: tableau.WEIGHTS}
    return [{s - 1: Decimal(value) for s, value in table.get(stage, {}).items()} for stage in range(1, STAGES + 1)]


def elementary(tree: Tree, table: list[dict[int, Decimal]], memory: dict[Tree, list[Decimal]]) -> list[Decimal]:
    """Return a tree's elementary weight in each stage: the product, over its branches, of their weights summed by the
    table.
    """
    if tree not in memory:
        branches = [elementary(branch, table, memory) for branch in tree]
        sums = [[sum((a * weights[j] for j, a in row.items()), Decimal(0)) for row in table] for weights in branches]
        memory[tree] = [prod((branch[i] for branch in sums), start=Decimal(1)) for i in range(STAGES)]
    return memory[tree]


def defects(weights: dict[int, Decimal], order: int, theta: Decimal = Decimal(1), table=None) -> list[Decimal]:
    """Return sum b_i Phi_i - theta^order / gamma for every tree of one order."""
    table, memory = table or rows(), {}
    return [
        sum(b * elementary(tree, table, memory)[i] for i, b in weights.items()) - theta**order / density(tree)
        for tree in trees(order)
    ]


def numbers(coefficients) -> dict[int, Decimal]:
    return {stage - 1: Decimal(value) for stage, value in coefficients.items()}


def test_the_rooted_trees_are_as_many_as_they_should_be():
    assert [len(trees(order)) for order in range(1, 9)] == [1, 1, 2, 4, 9, 20, 48, 115]


def test_every_node_is_the_sum_of_its_row():
    for node, row in zip(NODES, rows(), strict=True):
        assert abs(node - sum(row.values())) < PRINTED


@pytest.mark.parametrize("order", range(1, 9))
def test_the_step_has_order_8(order):
    assert max(map(abs, defects(numbers(tableau.WEIGHTS), order))) < PRINTED


def test_the_step_has_not_order_9():
    assert max(map(abs, defects(numbers(tableau.WEIGHTS), 9))) > Decimal("1e-8")


def test_a_wrong_digit_is_noticed():
    table = rows()
    table[8][5] += Decimal("1e-20")
    assert max(abs(d) for order in range(1, 9) for d in defects(numbers(tableau.WEIGHTS), order, table=table)) > PRINTED


@pytest.mark.parametrize(
    "weights, order",
    [
        ({i: b - numbers(tableau.ERROR_5).get(i, 0) for i, b in numbers(tableau.WEIGHTS).items()}, 5),
        (numbers(tableau.WEIGHTS_3), 3),
    ],
    ids=["fifth", "third"],
)
def test_the_embedded_solutions_have_their_order_and_no_more(weights, order):
    for lower in range(1, order + 1):
        assert max(map(abs, defects(weights, lower))) < PRINTED
    assert max(map(abs, defects(weights, order + 1))) > Decimal("1e-6")


def dense_weights(theta: Decimal) -> dict[int, Decimal]:
    """Return the weights b_i(theta) of the dense output, combined as in dop853.c."""
    step, first, last = numbers(tableau.WEIGHTS), {0: Decimal(1)}, {12: Decimal(1)}
    bend = _combined((1, first), (-1, step))
    terms = [step, bend, _combined((1, step), (-1, last), (-1, bend))]
    terms += [numbers(tableau.DENSE[order]) for order in (5, 6, 7, 8)]
    found: dict[int, Decimal] = {}
    for index in reversed(range(len(terms))):
        factor = theta if index % 2 == 0 else 1 - theta
        found = _combined((factor, terms[index]), (factor, found))
    return found


def _combined(*parts) -> dict[int, Decimal]:
    return {i: sum((factor * part.get(i, 0) for factor, part in parts), Decimal(0)) for _, p in parts for i in p}


@pytest.mark.parametrize("theta", [Decimal(n) / 16 for n in (2, 8, 13, 16)])
def test_the_dense_output_has_order_7_throughout_the_step(theta):
    for order in range(1, 8):
        assert max(map(abs, defects(dense_weights(theta), order, theta))) < 100 * PRINTED


def test_the_coefficients_are_those_of_scipy():
    """SciPy's coefficients were typed independently; both round to the same doubles."""
    from scipy.integrate._ivp import dop853_coefficients as scipy

    def filled(coefficients, length):
        row = np.zeros(length)
        for stage, value in coefficients.items():
            row[stage - 1] = float(value)
        return row

    a = np.array([filled(tableau.STAGE_WEIGHTS.get(s, tableau.WEIGHTS if s == 13 else {}), 16) for s in range(1, 17)])
    assert np.array_equal(a, scipy.A)
    assert np.array_equal([float(node) for node in NODES], scipy.C)
    assert np.array_equal(filled(tableau.ERROR_5, 13), scipy.E5)
    assert np.array_equal(filled(tableau.WEIGHTS, 13) - filled(tableau.WEIGHTS_3, 13), scipy.E3)
    assert np.array_equal([filled(row, 16) for row in tableau.DENSE.values()], scipy.D)


def test_the_header_is_printed_from_the_table():
    assert tableau.HEADER.read_text(encoding="utf-8") == tableau.c_header()
