"""SymPy expressions to a straight-line program with few operations.

Three steps, each exact: constants are gathered and hoisted (whatever does not depend on time or state is computed
once, when parameters are bound), common factors and sums are shared, and names are given. The result depends on the
expressions alone, never on the order of a hash table.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, combinations_with_replacement
from typing import Any

from sympy import Abs, Expr, Function, Integer, Mul, Number, S, Symbol, default_sort_key

from symrot.codegen.sums import negative, summed
from symrot.errors import InputError
from symrot.expression import FUNCTIONS, Node, children, rename, text
from symrot.kernel import Argument, Program, Signature
from symrot.kernels.removable import FUNCTIONS as OWN_FUNCTIONS

__all__ = ["Lowered", "lower", "to_node"]

Tree = tuple[Any, ...]  # sym name | num Fraction | mul factors divisors | add (sign, tree)... | call name args
ONE: Tree = ("num", Fraction(1))
_HOISTED = "$"  # first letter of a constant that has no number yet


@dataclass(frozen=True)
class Lowered:
    """A program and the constants it takes: ``parameters[k]`` is (name, formula over the physical constants)."""

    program: Program
    parameters: tuple[tuple[str, Node], ...]


def to_node(expr: Expr) -> Node:
    """Return a SymPy expression as a formula tree, term by term; raises InputError for what kernels cannot hold."""
    if expr.is_Rational:
        return ("number", Fraction(int(expr.p), int(expr.q)))
    if expr.is_Symbol or expr is S.Pi:
        return ("symbol", str(expr))
    if expr.is_Pow:
        base, power = expr.as_base_exp()
        if (2 * power).is_Integer:
            if power < 0:
                return ("/", ("number", Fraction(1)), to_node(base**-power))
            node = to_node(base) if power.is_Integer else ("call", "sqrt", (to_node(base),))
            count = int(power) if power.is_Integer else int(2 * power)
            return node if count == 1 else ("**", node, count)
    if expr.is_Mul:
        top, bottom = expr.as_numer_denom()
        if bottom != 1:
            return ("/", to_node(top), to_node(bottom))
        coefficient, rest = expr.as_coeff_Mul()
        if coefficient == -1:
            return ("neg", to_node(rest))
        return _chain("*", [to_node(factor) for factor in expr.as_ordered_factors()])
    if expr.is_Add:
        terms = sorted(expr.as_ordered_terms(), key=lambda term: term.could_extract_minus_sign())
        node = to_node(terms[0])
        for term in terms[1:]:
            negative = term.could_extract_minus_sign()
            node = ("-" if negative else "+", node, to_node(-term if negative else term))
        return node
    name = _function_name(expr)
    return ("call", name, tuple(to_node(argument) for argument in expr.args))


def _chain(mark: str, nodes: Sequence[Node]) -> Node:
    result = nodes[0]
    for node in nodes[1:]:
        result = (mark, result, node)
    return result


def _function_name(expr: Expr) -> str:
    name = "abs" if isinstance(expr, Abs) else "exp" if expr.func.__name__ == "exp" else str(expr.func)
    if not isinstance(expr, Function) or (FUNCTIONS | OWN_FUNCTIONS).get(name) != len(expr.args):
        raise InputError(f"expected a formula of + - * /, whole and half powers and {', '.join(FUNCTIONS)}; got {expr}")
    return name


class _Gather:
    """Splits every expression into constant times core, hoisting what does not depend on the variables."""

    def __init__(self, variables: Iterable[Symbol], flat: bool = False) -> None:
        self.variables, self.flat = frozenset(variables), flat
        self.hoisted: dict[Expr, str] = {}
        self.memo: dict[Expr, tuple[Expr, Tree]] = {}

    def is_variable(self, expr: Expr) -> bool:
        return bool(expr.free_symbols & self.variables)

    def constant(self, value: Expr) -> tuple[int, Tree | None]:
        """Return sign and atom of a constant; the atom of one is None."""
        sign, value = _oriented(value)
        if value == 1:
            return sign, None
        if value.is_Rational:
            return sign, ("num", Fraction(int(value.p), int(value.q)))
        name = self.hoisted.setdefault(value, f"{_HOISTED}{len(self.hoisted)}")
        return sign, ("sym", name)

    def scaled(self, coefficient: Expr, core: Tree) -> tuple[int, Tree]:
        """Return sign and tree of coefficient times core."""
        sign, atom = self.constant(coefficient)
        if atom is None:
            return sign, core
        if core == ONE:
            return sign, atom
        factors, divisors = (core[1], core[2]) if core[0] == "mul" else ((core,), ())
        return sign, ("mul", (atom, *factors), divisors)

    def split(self, expr: Expr) -> tuple[Expr, Tree]:
        """Return (constant, core) with expr = constant * core; the core of a constant is ONE."""
        if expr not in self.memo:
            self.memo[expr] = self._split(expr)
        return self.memo[expr]

    def _split(self, expr: Expr) -> tuple[Expr, Tree]:
        if not self.is_variable(expr):
            return expr, ONE
        if expr.is_Symbol:
            return S.One, ("sym", str(expr))
        if expr.is_Mul:
            return self._product(expr.args)
        if expr.is_Add:
            return self._sum(expr.args)
        if expr.is_Pow:
            return self._power(expr)
        name = _function_name(expr)
        return S.One, ("call", name, tuple(self.whole(argument) for argument in expr.args))

    def whole(self, expr: Expr) -> Tree:
        """Return the tree of an expression with its constant inside."""
        sign, tree = self.scaled(*self.split(expr))
        return tree if sign > 0 else ("add", ((-1, tree),))

    def _distributed(self, ordered: Sequence[Expr]) -> list[Expr]:
        """Return the terms of a constant times one sum, which are cheaper: c*(a + b*x) is c*a + (c*b)*x; else none."""
        sums = [argument for argument in ordered if self.is_variable(argument)]
        if len(sums) != 1 or not sums[0].is_Add:
            return []
        outer = Mul(*(argument for argument in ordered if argument is not sums[0]))
        return [outer * term for term in sums[0].args]

    def _flattened(self, terms: Iterable[Expr]) -> Iterable[Expr]:
        """Yield the terms of a sum, and those of sums in it, so that constants and equal terms meet."""
        for term in terms:
            inner = list(term.args) if term.is_Add else []
            if term.is_Mul:
                inner = self._distributed(sorted(term.args, key=default_sort_key))
            yield from self._flattened(inner) if inner else (term,)

    def _product(self, arguments: Iterable[Expr]) -> tuple[Expr, Tree]:
        constant, factors, divisors = S.One, [], []
        ordered = sorted(arguments, key=default_sort_key)
        if terms := self._distributed(ordered):
            return self._sum(terms)
        for argument in ordered:
            own, core = self.split(argument)
            constant *= own
            if core == ONE:
                continue
            if core[0] == "mul":
                factors += core[1]
                divisors += core[2]
            else:
                factors.append(core)
        if not divisors and len(factors) == 1:
            return constant, factors[0]
        return constant, ("mul", tuple(factors), tuple(divisors))

    def _power(self, expr: Expr) -> tuple[Expr, Tree]:
        base, power = expr.as_base_exp()
        if not (2 * power).is_Integer:
            raise InputError(f"expected whole and half powers in a kernel, got {expr}")
        if power.is_Integer:
            constant, core = self.split(base)
        else:
            constant, core, power = S.One, ("call", "sqrt", (self.whole(base),)), Integer(2 * power)
        factors, divisors = (core[1], core[2]) if core[0] == "mul" else ((core,), ())
        if power < 0:
            factors, divisors = divisors, factors
        count = abs(int(power))
        if count == 1 and not divisors and len(factors) == 1:
            return constant**power, factors[0]
        return constant**power, ("mul", factors * count, divisors * count)

    def _sum(self, terms: Iterable[Expr]) -> tuple[Expr, Tree]:
        total: dict[Tree, Expr] = {}  # core -> its constant, equal cores taken together
        for term in sorted(self._flattened(terms) if self.flat else terms, key=default_sort_key):
            constant, core = self.split(term)
            total[core] = total.get(core, S.Zero) + constant
        groups: dict[Expr, list[tuple[int, Tree]]] = {}
        for core, constant in total.items():
            if constant != 0:
                sign, constant = _oriented(constant)
                groups.setdefault(constant, []).append((sign, core))
        if not groups:
            return S.Zero, ONE
        if len(groups) == 1:
            ((constant, group),) = groups.items()
            sign, tree = _signed_sum(group)
            return constant * sign, tree
        parts: list[tuple[int, Tree]] = []
        for constant, group in groups.items():
            if constant == 1:
                parts += group
                continue
            outer, tree = _signed_sum(group)
            inner, scaled = self.scaled(constant, tree)
            parts.append((outer * inner, scaled))
        sign, tree = _signed_sum(parts)
        return Integer(sign), tree


def _oriented(value: Expr) -> tuple[int, Expr]:
    """Return sign and size of a constant: the same size for a and for -a, for (A - C)/A and for (C - A)/A."""
    sign, factors = 1, []
    for factor in Mul.make_args(value):
        base, power = factor.as_base_exp()
        if power.is_Integer and (base.is_Add or base.is_Number) and base.could_extract_minus_sign():
            sign, factor = sign * (-1) ** int(power), (-base) ** power
        factors.append(factor)
    return sign, Mul(*factors)


def _signed_sum(terms: Sequence[tuple[int, Tree]]) -> tuple[int, Tree]:
    """Return the sum with its first term positive, and the sign taken out for that."""
    if len(terms) == 1:
        return terms[0]
    sign = 1 if any(s > 0 for s, _ in terms) else -1
    if sum(s for s, _ in terms) < 0 or (sum(s for s, _ in terms) == 0 and terms[0][0] < 0):
        sign = -1
    return sign, ("add", tuple((s * sign, tree) for s, tree in terms))


class _Share:
    """Finds common factors and common sums, most frequent pair first, ties by order of appearance."""

    def __init__(self) -> None:
        self.identity: dict[Tree, int] = {}
        self.nodes: list[tuple[Any, ...]] = []  # over identities

    def intern(self, node: Tree) -> int:
        if node not in self.identity:
            self.identity[node] = len(self.nodes)
            self.nodes.append(node)
        return self.identity[node]

    def add(self, tree: Tree) -> int:
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
        """Replace the most frequent pair by a node of its own until none occurs twice."""
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
                best = max(count, key=lambda pair: (count[pair], self._is_variable(pair), _negated(pair)), default=None)
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

    def _is_variable(self, pair: Any) -> bool:
        """Whether a pair holds no constant: such pairs are shared first."""
        return pair[0] == "add" or not any(self.nodes[i][0] == "num" for part in pair[1:] for i in part)

    def _replace(self, kind: str, pair: tuple[Any, ...], swap: Callable[..., tuple[Any, ...]]) -> None:
        """Give the pair an identity of its own, an existing one if there is, and put it wherever the pair stands."""
        if pair not in self.nodes:
            self.nodes.append(pair)
        new = self.nodes.index(pair)
        for index, node in enumerate(self.nodes):
            if index != new and node[0] == kind:
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
        wanted = Counter(pair[1])
        parts = []
        for part in node[1:]:
            held = Counter(part)
            while all(held[i] >= n for i, n in wanted.items()):
                held = held - wanted
                held[new] += 1
            parts.append(tuple(sorted(held.elements())))
        return "mul", *parts

    @staticmethod
    def _swap_sum(node: tuple[Any, ...], pair: tuple[Any, ...], new: int) -> tuple[Any, ...]:
        (a, _), (b, relative) = pair[1]
        signs = dict(node[1])
        if a not in signs or b not in signs or signs[a] * signs[b] != relative:
            return node
        rest = (item for item in node[1] if item[0] not in (a, b))
        return "add", tuple(sorted((*rest, (new, signs[a]))))


def _without(part: tuple[int, ...], item: int) -> tuple[int, ...]:
    where = part.index(item)
    return part[:where] + part[where + 1 :]


def _negated(pair: Any) -> Any:
    """Order pairs so that `max` takes the one that appeared first."""
    return tuple(_negated(item) if isinstance(item, tuple) else -item for item in pair if not isinstance(item, str))


class _Writer:
    """Gives names to shared nodes and writes formulas in the order they are needed."""

    def __init__(self, share: _Share, roots: Sequence[int], taken: Iterable[str], named: dict[int, str]) -> None:
        self.nodes, self.named, self.taken = share.nodes, dict(named), set(taken) | set(named.values())
        self.uses: Counter[int] = Counter()
        seen: set[int] = set()
        for root in roots:
            self._count(root, seen)
        self.temporaries: list[tuple[str, Node]] = []
        self.written: set[int] = set()

    def _operands(self, index: int) -> list[int]:
        node = self.nodes[index]
        if node[0] == "mul":
            return [*node[1], *node[2]]
        if node[0] == "add":
            return [i for i, _ in node[1]]
        return list(node[2]) if node[0] == "call" else []

    def _count(self, index: int, seen: set[int]) -> None:
        self.uses[index] += 1
        if index not in seen:
            seen.add(index)
            for operand in self._operands(index):
                self._count(operand, seen)

    def node(self, index: int) -> Node:
        """Return the formula of a node, as a symbol when it has a name."""
        kind = self.nodes[index][0]
        if kind == "num":
            return ("number", self.nodes[index][1])
        if kind == "sym":
            return ("symbol", self.nodes[index][1])
        if index not in self.named and kind != "call" and self.uses[index] < 2:
            return self._formula(index)
        if index not in self.written:
            formula = self._formula(index)
            self.named.setdefault(index, self._name(index))
            self.written.add(index)
            self.temporaries.append((self.named[index], formula))
        return ("symbol", self.named[index])

    def _name(self, index: int) -> str:
        kind, *rest = self.nodes[index]
        if kind == "call" and len(rest[1]) == 1 and self.nodes[rest[1][0]][0] == "sym":
            name = f"{rest[0]}_{self.nodes[rest[1][0]][1]}"
        else:
            count = 0
            while (name := f"x{count}") in self.taken:
                count += 1
        self.taken.add(name)
        return name

    def _is_constant(self, index: int) -> bool:
        kind, first, *_ = self.nodes[index]
        return bool(kind == "num" or (kind == "sym" and first.startswith(_HOISTED)))

    def _is_sum(self, index: int) -> bool:
        """Whether a node is written as a sum in brackets: such a factor comes first, as in (A - B) x y."""
        return bool(self.nodes[index][0] == "add" and self.uses[index] < 2 and index not in self.named)

    def _formula(self, index: int) -> Node:
        node = self.nodes[index]
        if node[0] == "call":
            return ("call", node[1], tuple(self.node(argument) for argument in node[2]))
        if node[0] == "mul":
            factors = sorted(node[1], key=lambda i: (not self._is_constant(i), not self._is_sum(i)))
            top = _chain("*", [self.node(i) for i in factors] or [("number", Fraction(1))])
            return top if not node[2] else ("/", top, _chain("*", [self.node(i) for i in node[2]]))
        terms = sorted(node[1], key=lambda item: item[1] < 0)
        first, sign = terms[0]
        start = self.node(first) if sign > 0 else negative(self.node(first))
        return summed(start, [(sign, self.node(term)) for term, sign in terms[1:]])


def lower(
    signature: Signature,
    outputs: Sequence[tuple[str, Expr]],
    definitions: Sequence[tuple[Symbol, Expr]] = (),
    parameter_argument: str = "p",
) -> Lowered:
    """Return the straight-line program of some expressions.

    Parameters
    ----------
    signature : Signature
        The variables are the components of its input arguments; every other symbol is a physical constant. It must
        not hold the parameter argument, which is appended here once its size is known.
    outputs : sequence of (component name, Expr)
        In the order of the output argument.
    definitions : sequence of (Symbol, Expr)
        Quantities with a physical name, used by later definitions and outputs as that symbol.
    parameter_argument : str
        Name of the array of hoisted constants.

    Returns
    -------
    Lowered
        The program and the formulas of its parameters over the physical constants.

    Raises
    ------
    InputError
        For a function or a power that kernels do not hold.
    """
    ways = [_lowered(signature, outputs, definitions, parameter_argument, flat) for flat in (False, True)]
    return min(ways, key=lambda way: way.program.operations().total())


def _lowered(
    signature: Signature, outputs: Sequence[tuple[str, Expr]], definitions: Sequence[tuple[Symbol, Expr]],
    parameter_argument: str, flat: bool,
) -> Lowered:  # fmt: skip
    """Return the program with sums as they stand, whose parts may be shared, or with ``flat`` ones."""
    inputs = [name for a in signature.arguments if a.role == "in" for name, *_ in a.components]
    held = {symbol for _, expr in [*outputs, *definitions] for symbol in expr.free_symbols}
    defined = [symbol for symbol, _ in definitions]
    gather = _Gather([symbol for symbol in held if str(symbol) in inputs or symbol in defined], flat)
    share, named = _Share(), {}
    alias: dict[str, Tree] = {}
    for symbol, expr in definitions:
        alias[str(symbol)] = _substitute(gather.whole(_exact(expr)), alias)
        index = share.add(alias[str(symbol)])
        if share.nodes[index][0] not in ("sym", "num"):
            named[index] = str(symbol)
    signed = [gather.scaled(*gather.split(_exact(expr))) for _, expr in outputs]
    roots = [share.add(_substitute(tree, alias)) for _, tree in signed]
    share.extract()
    writer = _Writer(share, roots, inputs, named)
    formulas = [writer.node(root) for root in roots]
    formulas = [node if sign > 0 else negative(node) for (sign, _), node in zip(signed, formulas, strict=True)]
    targets = [name for name, _ in outputs]
    return _numbered(signature, gather.hoisted, writer.temporaries, targets, formulas, parameter_argument)


def _numbered(
    signature: Signature,
    hoisted: dict[Expr, str],
    temporaries: Sequence[tuple[str, Node]],
    targets: Sequence[str],
    formulas: Sequence[Node],
    parameter_argument: str,
) -> Lowered:
    """Number the constants in the order of their use, and append them to the signature."""
    order: dict[str, str] = {}
    for node in [node for _, node in temporaries] + list(formulas):
        for name in _leaves(node):
            if name.startswith(_HOISTED):
                order.setdefault(name, f"{parameter_argument}{len(order)}")
    values = {name: to_node(value) for value, name in hoisted.items()}
    parameters = tuple((new, values[old]) for old, new in order.items())
    inputs = [a for a in signature.arguments if a.role == "in"]
    outs = [a for a in signature.arguments if a.role == "out"]
    described = tuple((name, "", text(formula)) for name, formula in parameters)
    full = Signature(signature.name, (*inputs, Argument(parameter_argument, "in", described), *outs))
    program = Program(
        full,
        tuple((name, rename(node, order)) for name, node in temporaries),
        tuple((name, rename(node, order)) for name, node in zip(targets, formulas, strict=True)),
    )
    return Lowered(program, parameters)


def _leaves(node: Node) -> Iterable[str]:
    """Yield the symbols of a formula from left to right."""
    if node[0] == "symbol":
        yield node[1]
    for child in children(node):
        yield from _leaves(child)


def _exact(expr: Expr) -> Expr:
    """Return the expression with floats refused: the symbolic layer is exact."""
    if expr.has(Number) and any(not number.is_Rational for number in expr.atoms(Number)):
        raise InputError(f"expected exact numbers in a kernel, got a float in {expr}")
    return expr


def _substitute(tree: Tree, alias: dict[str, Tree]) -> Tree:
    """Put the trees of defined symbols in their place."""
    kind = tree[0]
    if kind == "sym":
        return alias.get(tree[1], tree)
    if kind == "num":
        return tree
    if kind == "call":
        return ("call", tree[1], tuple(_substitute(argument, alias) for argument in tree[2]))
    if kind == "mul":
        return ("mul", *(tuple(_substitute(item, alias) for item in part) for part in tree[1:]))
    return ("add", tuple((sign, _substitute(item, alias)) for sign, item in tree[1]))
