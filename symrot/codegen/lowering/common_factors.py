"""Common factors and common sums of several formulas, each of which is computed only once.

In ``a*b*c`` and ``a*b + d`` the product ``a*b`` becomes one node, which both formulas use.
"""

from collections import Counter
from collections.abc import Callable, Iterable
from itertools import combinations, combinations_with_replacement
from typing import Any

from symrot.codegen.lowering.constants import Tree

__all__ = ["Share"]


class Share:
    """A collection of formula trees in which products and sums that occur repeatedly become one shared node."""

    def __init__(self) -> None:
        # first add() all formulas, then extract()
        self.identity: dict[Tree, int] = {}
        self.nodes: list[tuple[Any, ...]] = []  # operands are indices into this list; equal nodes have one index

    def intern(self, node: Tree) -> int:
        """Return the index of ``node`` in ``nodes``, and add the node if it is new."""
        # its operands are indices too
        if node not in self.identity:
            self.identity[node] = len(self.nodes)
            self.nodes.append(node)
        return self.identity[node]

    def add(self, tree: Tree) -> int:
        """Add a formula tree and all its parts to ``nodes``, and return the index of the whole tree."""
        kind = tree[0]
        if kind in ("sym", "num"):
            return self.intern(tree)
        if kind == "call":
            return self.intern(("call", tree[1], tuple(self.add(argument) for argument in tree[2])))
        if kind == "mul":
            factors, divisors = (tuple(sorted(self.add(item) for item in part)) for part in tree[1:])
            return self.intern(("mul", factors, divisors))
        return self.intern(("add", tuple(sorted(((self.add(item), sign) for sign, item in tree[1])))))

    def extract(self) -> None:
        """Replace repeated pairs of factors or terms by new nodes: ``a*b*c``, ``a*b*d`` become ``p*c``, ``p*d``."""
        # quotients a/b are replaced first, then reciprocals 1/b, products and sums
        for kind, pairs, swap in (
            ("mul", self._quotient_pairs, self._swap_quotient),
            ("mul", self._reciprocals, self._swap_reciprocal),
            ("mul", self._product_pairs, self._swap_product),
            ("add", self._sum_pairs, self._swap_sum),
        ):
            while True:
                count: Counter[Any] = Counter()
                for node in self.nodes:
                    if node[0] == kind:
                        count.update(set(pairs(node)))
                # the most frequent pair; between equals, one without numbers, then the one with the lowest indices
                best = max(
                    count, key=lambda pair: (count[pair], self._is_preferred(pair), _negated(pair)), default=None
                )
                if best is None or count[best] < 2:
                    break
                self._replace(kind, best, swap)

    def _quotient_pairs(self, node: tuple[Any, ...]) -> Iterable[Any]:
        return ((("mul", (a,), (b,))) for a in set(node[1]) for b in set(node[2]))

    def _reciprocals(self, node: tuple[Any, ...]) -> Iterable[Any]:
        return (("mul", (), (b,)) for b in set(node[2]) if node[1:] != ((), (b,)))

    def _product_pairs(self, node: tuple[Any, ...]) -> Iterable[Any]:
        for part in node[1:]:
            held = Counter(part)
            for a, b in combinations_with_replacement(sorted(held), 2):
                if a != b or held[a] > 1:
                    yield "mul", (a, b), ()

    def _sum_pairs(self, node: tuple[Any, ...]) -> Iterable[Any]:
        for (a, s), (b, r) in combinations(node[1], 2):
            yield "add", ((a, 1), (b, s * r))

    def _is_preferred(self, pair: Any) -> bool:
        """Return whether ``pair`` becomes a shared node before other pairs that are equally frequent.

        The result is True for a sum, and for a product, quotient or reciprocal without numbers. A pair has the form
        ``("mul", factors, divisors)`` or ``("add", terms with signs)``. With the indices a and b of two nodes, it is
        ``("mul", (a, b), ())`` for a*b, ``("mul", (a,), (b,))`` for a/b, ``("mul", (), (b,))`` for 1/b, or
        ``("add", ((a, 1), (b, sign)))`` for a + b and a - b.
        """
        return pair[0] == "add" or not any(self.nodes[i][0] == "num" for part in pair[1:] for i in part)

    def _replace(self, kind: str, pair: tuple[Any, ...], swap: Callable[..., tuple[Any, ...]]) -> None:
        """Add ``pair``, such as a*b, a/b, 1/b or a + b, as a node, and use this node wherever the pair occurs.

        :meth:`_is_preferred` explains the form of ``pair``.
        """
        if pair not in self.nodes:
            self.nodes.append(pair)
        new = self.nodes.index(pair)
        for index, node in enumerate(self.nodes):
            if index != new and node[0] == kind:
                # x*y*z becomes new*z for the pair x*y; a node without the pair is unchanged
                self.nodes[index] = swap(node, pair, new)

    @staticmethod
    def _swap_quotient(node: tuple[Any, ...], pair: tuple[Any, ...], new: int) -> tuple[Any, ...]:
        (a,), (b,) = pair[1:]
        if a not in node[1] or b not in node[2]:
            return node
        return "mul", tuple(sorted((*_without(node[1], a), new))), _without(node[2], b)

    @staticmethod
    def _swap_reciprocal(node: tuple[Any, ...], pair: tuple[Any, ...], new: int) -> tuple[Any, ...]:
        (b,) = pair[2]
        if b not in node[2]:
            return node
        return "mul", tuple(sorted((*node[1], new))), _without(node[2], b)

    @staticmethod
    def _swap_product(node: tuple[Any, ...], pair: tuple[Any, ...], new: int) -> tuple[Any, ...]:
        factors = Counter(pair[1])
        parts = []
        for part in node[1:]:
            rest = Counter(part)
            while all(rest[i] >= n for i, n in factors.items()):
                rest = rest - factors
                rest[new] += 1
            parts.append(tuple(sorted(rest.elements())))
        return "mul", *parts

    @staticmethod
    def _swap_sum(node: tuple[Any, ...], pair: tuple[Any, ...], new: int) -> tuple[Any, ...]:
        (a, _), (b, relative) = pair[1]
        for sign in (1, -1):
            # a sum may contain a node repeatedly, as in p + p + c: only one term for each of a and b is replaced
            rest = Counter(node[1])
            rest.subtract([(a, sign), (b, sign * relative)])
            if min(rest.values()) >= 0:
                return "add", tuple(sorted((*rest.elements(), (new, sign))))
        return node


def _without(part: tuple[int, ...], item: int) -> tuple[int, ...]:
    where = part.index(item)
    return part[:where] + part[where + 1 :]


def _negated(pair: Any) -> Any:
    """Return ``pair`` with all indices negated, as a sort key with which ``max`` selects the lowest indices."""
    return tuple(_negated(item) if isinstance(item, tuple) else -item for item in pair if not isinstance(item, str))
