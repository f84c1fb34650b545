"""The reader of emitted C: it returns the operations that the text performs, and refuses other C.

A function works on one sample, or on a batch of many samples. This module shares no code with the emitter.
``where`` is the name of a file, for error messages; ``scope`` has the names that are known at a line of the text.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache

from symrot.certificates.readback.c_functions import CFunction, Cursor, Parameter, Token, functions_of
from symrot.certificates.readback.intended_constants import rounds_to
from symrot.certificates.readback.operations import RELATIONS, GraphBuilder, Operations
from symrot.errors import CertificateError

__all__ = ["LIBRARY", "read_batch", "read_kernel"]

LIBRARY: dict[str, int] = {  # functions of <math.h> that kernels call, without the f of their float forms
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2, "exp": 1, "log": 1,
    "sinh": 1, "cosh": 1, "tanh": 1,
}  # fmt: skip
ROUNDED = {"sqrt": ("sqrt", 1), "fabs": ("abs", 1), "copysign": ("copysign", 2)}  # exact, or rounded correctly
VECTORISED = {"symrot_sin": "sin", "symrot_cos": "cos"}  # vectorised, from symrot_math.h; their error is assumed
ARC = {"symrot_atan2": "atan2"}  # also from symrot_math.h, but accurate for all arguments
# from symrot_math.h: choices without a branch
SELECT = {"symrot_select_lt": "<", "symrot_select_eq": "==", "symrot_choose_ge": ">="}
SPAN = "SYMROT_SPAN"  # number of samples in a block, which several loops of a batch process one after the other
DEEPEST = 200  # limit on the nesting of an expression


# The accepted subset of C: functions of double or float; const temporaries, assigned once; + - * /, unary minus, a < b
# ? x : y; calls of the C library and of static inline functions of the same file; each element of an output array
# assigned once; in a batch, one loop over samples, or loops over blocks of samples.
@dataclass
class _Scope:
    """The names known inside one C function: numbers, arrays, and the output elements that have been assigned."""

    values: dict[str, int] = field(default_factory=dict)
    arrays: dict[str, Parameter] = field(default_factory=dict)
    scalars: frozenset[str] = frozenset()  # arrays of a batch that hold one number for each sample
    written: dict[tuple[str, int], int] = field(default_factory=dict)
    loop: str = ""  # in a batch, the name of the sample's index
    count: str = ""  # in a batch, the name of the number of samples


class _BodyReader:
    """A reader of the body of a C function, which turns statements into a graph of rounded operations."""

    def __init__(self, functions: Mapping[str, CFunction], where: str, real: str, batch: bool = False) -> None:
        self.functions, self.where, self.real, self.batch = functions, where, real, batch
        self.builder = GraphBuilder()
        self.inputs: dict[str, int] = {}  # place -> its node
        self.calls: list[str] = []
        self.depth = 0
        # the arguments of symrot_sin and symrot_cos; None where these must not be called
        self.vectorised_angles: set[int] | None = None

    def input(self, place: str) -> int:
        """Return the node (its index in the graph of operations) for an input component, such as ``"q[1]"``."""
        return self.inputs.setdefault(place, self.builder.add("in", place))

    def statements(self, cursor: Cursor, scope: _Scope) -> int | None:
        """Read the statements of a body; return the node of the value after ``return``, or None without ``return``."""
        while cursor.peek():
            if cursor.peek() == "(":
                cursor.expect("(", "void", ")")
                self._known(cursor, scope, cursor.name())
                cursor.expect(";")
            elif cursor.peek() == "return":
                cursor.next()
                value = self.expression(cursor, scope)
                cursor.expect(";")
                if cursor.peek():
                    raise cursor.fail("the end of the function after its return statement")
                return value
            elif cursor.peek() == "const":
                cursor.expect("const", self.real)
                name = cursor.name()
                if name in scope.values or name in scope.arrays or name in (scope.loop, scope.count):
                    raise cursor.fail("a name that is not yet used", repr(name))
                cursor.expect("=")
                # a new name for the statements that follow
                scope.values[name] = self.expression(cursor, scope)
                cursor.expect(";")
            else:
                self._assignment(cursor, scope)
        return None

    def _known(self, cursor: Cursor, scope: _Scope, name: str) -> None:
        """Raise CertificateError unless ``name`` is a number or an array that the C function declared before."""
        if name not in scope.values and name not in scope.arrays:
            raise cursor.fail("the name of a parameter", repr(name))

    def _assignment(self, cursor: Cursor, scope: _Scope) -> None:
        """Read an assignment to one element of an output array, and record it in ``scope.written``."""
        name = cursor.name()
        array = scope.arrays.get(name)
        if array is None or array.is_const:
            raise cursor.fail("an output array", repr(name))
        index = self._index(cursor, scope, array)
        cursor.expect("=")
        value = self.expression(cursor, scope)
        cursor.expect(";")
        if (name, index) in scope.written:
            raise cursor.fail(f"one assignment to {name}[{index}]", "a second assignment")
        scope.written[name, index] = value

    def _index(self, cursor: Cursor, scope: _Scope, array: Parameter) -> int:
        """Return the component i of an array index ``[i]``, or ``[i*n + k]`` for sample k of n, and move past it."""
        cursor.expect("[")
        if array.size > 0:
            index = cursor.integer()
            if index >= array.size:
                raise cursor.fail(f"an index below {array.size} for {array.name}", str(index))
        else:
            if not scope.loop:
                raise cursor.fail("an array with a length, such as q[4]", repr(array.name))
            index = 0
            if cursor.peek() == scope.count:
                index = 1
                cursor.expect(scope.count, "+")
            elif cursor.peek() != scope.loop:
                index = cursor.integer()
                cursor.expect("*", scope.count, "+")
            cursor.expect(scope.loop)
        cursor.expect("]")
        return index

    def expression(self, cursor: Cursor, scope: _Scope) -> int:
        """Read an expression, which is ``a < b ? x : y`` or a sum; return its node."""
        self.depth += 1
        if self.depth > DEEPEST:
            raise cursor.fail(f"an expression with at most {DEEPEST} levels of brackets", "an expression with more")
        value = self.sum(cursor, scope)
        relation = cursor.peek()
        if relation in RELATIONS:
            cursor.next()
            other = self.sum(cursor, scope)
            cursor.expect("?")
            first = self.expression(cursor, scope)
            cursor.expect(":")
            value = self.builder.add("select", relation, value, other, first, self.expression(cursor, scope))
        self.depth -= 1
        return value

    def sum(self, cursor: Cursor, scope: _Scope) -> int:
        """Read a sum: terms with + or - between them; return its node."""
        value = self.product(cursor, scope)
        while cursor.peek() in ("+", "-"):
            kind = "add" if cursor.next().text == "+" else "sub"
            value = self.builder.add(kind, value, self.product(cursor, scope))
        return value

    def product(self, cursor: Cursor, scope: _Scope) -> int:
        """Read a product: factors with * or / between them; return its node."""
        value = self.factor(cursor, scope)
        while cursor.peek() in ("*", "/"):
            kind = "mul" if cursor.next().text == "*" else "div"
            value = self.builder.add(kind, value, self.factor(cursor, scope))
        return value

    def factor(self, cursor: Cursor, scope: _Scope) -> int:
        """Read a factor: a negated factor, a bracket, a number, a call, an array element or a name; return its node."""
        if cursor.peek() == "-":
            cursor.next()
            value = self.factor(cursor, scope)
            node = self.builder.nodes[value]
            return self.builder.add("const", -node[1]) if node[0] == "const" else self.builder.add("neg", value)
        if cursor.peek() == "(":
            cursor.next()
            value = self.expression(cursor, scope)
            cursor.expect(")")
            return value
        if cursor.index < len(cursor.tokens) and cursor.tokens[cursor.index].kind == "number":
            return self._literal(cursor)
        name = cursor.name()
        if cursor.peek() == "(":
            return self._call(cursor, scope, name)
        if cursor.peek() == "[":
            return self._element(cursor, scope, name)
        if name not in scope.values:
            raise cursor.fail("a name that has a value", repr(name))
        return scope.values[name]

    def _literal(self, cursor: Cursor) -> int:
        """Read a number in the kernel's type, such as 2.0 for double or 2.0f for float; return its node."""
        text = cursor.peek()
        is_float = text.endswith("f")  # a suffix in hexadecimal literals too: their exponent is decimal
        if is_float != (self.real == "float") or text.isdigit():
            raise cursor.fail(f"a literal of type {self.real}")
        cursor.next()
        try:
            return self.builder.add("const", _nearest(text.removesuffix("f") if is_float else text, self.real))
        except OverflowError:
            raise cursor.fail(f"a literal within the range of {self.real}", repr(text)) from None

    def _element(self, cursor: Cursor, scope: _Scope, name: str) -> int:
        """Read the index after the name of an input array; return the node for this component, such as ``q[1]``."""
        array = scope.arrays.get(name)
        if array is None or not array.is_const:
            raise cursor.fail("an input array", repr(name))
        if scope.loop and name in scope.scalars:  # a scalar of one sample, t[k]
            cursor.expect("[", scope.loop, "]")
            return self.input(name)
        return self.input(f"{name}[{self._index(cursor, scope, array)}]")

    def _call(self, cursor: Cursor, scope: _Scope, name: str) -> int:
        """Read the arguments of a function call; return the node of the call."""
        cursor.expect("(")
        arguments = [self.expression(cursor, scope)]
        while cursor.peek() == ",":
            cursor.next()
            arguments.append(self.expression(cursor, scope))
        cursor.expect(")")
        if name in self.functions:
            return self._inlined(cursor, self.functions[name], arguments)
        bare = name.removesuffix("f") if self.real == "float" else name
        if self.real == "float" and bare == name:
            raise cursor.fail(f"the function for floats instead of {name}, such as sinf for sin", repr(name))
        if bare in ROUNDED and ROUNDED[bare][1] == len(arguments):
            return self.builder.add(ROUNDED[bare][0], *arguments)
        if self.vectorised_angles is not None and bare in VECTORISED and len(arguments) == 1:
            self.vectorised_angles.add(arguments[0])
            return self.builder.add("call", VECTORISED[bare], tuple(arguments))
        if self.batch and bare in ARC and len(arguments) == 2:
            return self.builder.add("call", ARC[bare], tuple(arguments))
        if self.batch and bare in SELECT and len(arguments) == 4:
            return self.builder.add("select", SELECT[bare], *arguments)
        if LIBRARY.get(bare) != len(arguments):
            raise cursor.fail("a function of <math.h> that kernels use", repr(name))
        return self.builder.add("call", bare, tuple(arguments))

    def _inlined(self, cursor: Cursor, function: CFunction, arguments: list[int]) -> int:
        """Return the node for a call of a function of the same file, whose body is read as if it replaced the call."""
        parameters = function.parameters
        if function.returns != self.real or any(p.size or p.type != self.real for p in parameters):
            raise cursor.fail(f"a function of type {self.real}", repr(function.name))
        if len(parameters) != len(arguments):
            raise cursor.fail(f"{len(parameters)} arguments for {function.name}", str(len(arguments)))
        if function.name in self.calls:
            raise cursor.fail("functions without recursion", f"a call of {function.name} in itself")
        self.calls.append(function.name)
        scope = _Scope(values={p.name: value for p, value in zip(parameters, arguments, strict=True)})
        value = self.statements(Cursor(function.body, self.where), scope)
        self.calls.pop()
        if value is None:
            raise cursor.fail(f"a return statement in {function.name}", "none")
        return value


def _nearest(digits: str, real: str) -> Fraction:
    """Return the double or float nearest to the text of a number; raise OverflowError if it is too large."""
    # rounding the nearest double again could give the neighbouring float
    return rounds_to(_exact(digits), "binary64" if real == "double" else "binary32")


def _exact(digits: str) -> Fraction:
    """Return the exact value of a decimal or hexadecimal number, such as 0x1.8p-1 = 3/4."""
    if re.search(r"[ep][-+]?0*\d{5}", digits, re.IGNORECASE):
        raise OverflowError
    if not digits.lower().startswith("0x"):
        return Fraction(digits)
    mantissa, _, exponent = digits.lower().removeprefix("0x").partition("p")
    whole, _, part = mantissa.partition(".")
    return Fraction(int(whole + part, 16), 16 ** len(part)) * Fraction(2) ** int(exponent)


def _defined(functions: Mapping[str, CFunction], name: str, where: str) -> CFunction:
    """Return the C function of this name; raise CertificateError if the file does not define it.

    ``where`` is the file's name, for the message.
    """
    if name not in functions:
        raise CertificateError(
            f"{where}: expected a function named {name}, got {', '.join(functions) or 'no function'}"
        )
    return functions[name]


def _real_of(function: CFunction, where: str) -> str:
    """Return the type of a kernel's numbers, ``"double"`` or ``"float"``; CertificateError unless there is one type."""
    types = {p.type for p in function.parameters} - {"size_t"}
    if function.returns != "void" or len(types) != 1:
        raise CertificateError(
            f"{where}, line {function.line}: expected only double or only float in a kernel, got both"
        )
    return types.pop()


PRECISION = {"double": "binary64", "float": "binary32"}


@lru_cache(maxsize=32)
def read_kernel(text: str, name: str, where: str = "kernel") -> Operations:
    """Read a one-sample function of a C file and return its operations; the last 32 results are cached.

    Parameters
    ----------
    text : str
        A C file as symrot emits it.
    name : str
        The name of the function.
    where : str
        The file's name, for error messages.

    Raises
    ------
    CertificateError
        If the text contains C that symrot does not emit, such as an unknown call, a name without a value, an output
        that is assigned twice or never, or an index beyond its array.
    """
    functions = functions_of(text, where)
    function = _defined(functions, name, where)
    real = _real_of(function, where)
    reader, scope = _BodyReader(functions, where, real), _Scope()
    for parameter in function.parameters:
        if parameter.size == 0:
            scope.values[parameter.name] = reader.input(parameter.name)
        else:
            scope.arrays[parameter.name] = parameter
            if parameter.is_const:
                for index in range(parameter.size):
                    reader.input(f"{parameter.name}[{index}]")
    reader.statements(Cursor(function.body, where), scope)
    places = [(p.name, i) for p in function.parameters if p.size > 0 and not p.is_const for i in range(p.size)]
    return _finished(reader, scope, function, places, where)


def read_batch(text: str, name: str, where: str = "kernel") -> Operations:
    """Return the operations of a batch function for one sample, with names as in the one-sample function.

    Raises
    ------
    CertificateError
        In the cases of :func:`read_kernel`, and if a loop does not run over all samples.

    Notes
    -----
    ``symrot_sin``, ``symrot_cos`` and ``symrot_atan2`` are read as sine, cosine and arc tangent; it is assumed that
    ``symrot_math.h`` computes them to its stated accuracy. ``symrot_sin`` and ``symrot_cos`` are accurate in a range of
    angles only. They are accepted if the loop tests whether each of their arguments is in that range, and a second loop
    computes the block of samples again with the C library if a test fails.
    """
    functions = functions_of(text, where)
    function = _defined(functions, name, where)
    real = _real_of(function, where)
    counts = [p.name for p in function.parameters if p.type == "size_t"]
    if len(counts) != 1:
        raise CertificateError(
            f"{where}, line {function.line}: expected the function {name} to have one argument of the type size_t, the "
            f"number of samples, got {len(counts)}"
        )
    reader, scope = _BodyReader(functions, where, real, batch=True), _Scope(count=counts[0])
    scope.arrays = {p.name: p for p in function.parameters if p.type != "size_t"}
    one = functions.get(name.removesuffix("_batch"))
    scope.scalars = frozenset(p.name for p in one.parameters if not p.size) if one else frozenset()
    cursor = Cursor(function.body, where)
    while cursor.peek() == "(":
        cursor.expect("(", "void", ")")
        reader._known(cursor, scope, cursor.name())
        cursor.expect(";")
    if cursor.peek(3) == "start" and cursor.peek(14) == SPAN:
        _parts(cursor, reader, scope)
    elif cursor.peek(3) == "start":
        _blocks(cursor, reader, scope)
    else:
        reader.statements(Cursor(_samples(cursor, scope, "0", scope.count), where), scope)
    if cursor.peek():
        raise cursor.fail("the end of the function after the loop over samples")
    order = [parameter.name for parameter in function.parameters]
    places = sorted(scope.written, key=lambda place: (order.index(place[0]), place[1]))
    return _finished(reader, scope, function, places, where)


def _samples(cursor: Cursor, scope: _Scope, start: str, end: str) -> tuple[Token, ...]:
    """Move past a loop over samples, from the C variable ``start`` to ``end``; return the tokens of its body.

    The name of the sample's index is stored in ``scope.loop``.
    """
    if cursor.peek() == "SYMROT_INDEPENDENT":
        cursor.next()
    cursor.expect("for", "(", "size_t")
    scope.loop = cursor.name()
    if scope.loop in (scope.count, start, end, *scope.arrays):  # it would hide that variable in the loop
        raise cursor.fail("a name that is not yet used", repr(scope.loop))
    cursor.expect("=", start, ";", scope.loop, "<", end, ";", "++", scope.loop, ")")
    return cursor.block()


def _parts(cursor: Cursor, reader: _BodyReader, scope: _Scope) -> None:
    """Read several loops over the same block of samples, and record their outputs in ``scope``."""
    _heads(cursor, scope, SPAN)
    # a kernel with many outputs is computed in several loops
    while cursor.peek() != "}":
        part = _Scope(arrays=scope.arrays, scalars=scope.scalars, count=scope.count)
        reader.statements(Cursor(_samples(cursor, part, "start", "end"), cursor.where), part)
        twice = [f"{name}[{index}]" for name, index in part.written if (name, index) in scope.written]
        if twice:
            raise cursor.fail(f"one assignment to {twice[0]}", "a second assignment in another loop")
        scope.written |= part.written
    cursor.expect("}")


def _heads(cursor: Cursor, scope: _Scope, size: str) -> None:
    """Move past the two lines that begin a loop over blocks of samples; raise CertificateError for other text.

    ``size`` is the C macro for the number of samples in a block, such as ``"SYMROT_BLOCK"``.
    """
    cursor.expect(*f"for ( size_t start = 0 ; start < {scope.count} ; start + = {size} ) {{".split())
    cursor.expect(*f"const size_t end = {scope.count} - start < {size} ? {scope.count} : start + {size} ;".split())


def _blocks(cursor: Cursor, reader: _BodyReader, scope: _Scope) -> None:
    """Read a loop over blocks of samples, computed with ``symrot_math.h`` and, for large angles, with libm.

    The C text adds ``symrot_far(x)``, which is 0 for an angle x in the range of ``symrot_math.h``, to the variable
    ``beyond``. If the sum is not 0 at the end of a block, a second loop computes the block again with libm.
    """
    _heads(cursor, scope, "SYMROT_BLOCK")
    cursor.expect("uint32_t" if reader.real == "float" else "uint64_t", "beyond", "=", "0", ";")
    far = "symrot_farf" if reader.real == "float" else "symrot_far"
    body = _samples(cursor, scope, "start", "end")
    split = next((i for i, token in enumerate(body) if token.text == "beyond"), len(body))
    plain = _Scope(arrays=scope.arrays, scalars=scope.scalars, loop=scope.loop, count=scope.count)
    # the test for large angles must cover every argument of symrot_sin and symrot_cos
    reader.vectorised_angles = set()
    reader.statements(Cursor(body[:split], cursor.where), scope)
    tested, mark = set(), "="
    range_test = Cursor(body[split:], cursor.where)
    range_test.expect("beyond", "+")
    while range_test.peek() == mark:
        range_test.expect(mark, far, "(")
        tested.add(reader.expression(range_test, scope))
        range_test.expect(")")
        mark = "+"
    range_test.expect(";")
    if range_test.peek() or not reader.vectorised_angles <= tested:
        raise range_test.fail(
            f"one last statement `beyond += {far}(x) + ..;` in the loop, with a term {far}(x) for each argument x of a "
            "sine or cosine, as symrot prints it"
        )
    reader.vectorised_angles = None
    cursor.expect(*["const", "size_t", "again", "=", "beyond", "==", "0", "?", "start", ":", "end", ";"])
    reader.statements(Cursor(_samples(cursor, plain, "start", "again"), cursor.where), plain)
    cursor.expect("}")
    # both computations must perform the same operations
    if plain.written != scope.written:
        raise cursor.fail("the second loop over samples to assign the same outputs as the first", "other outputs")


def _finished(
    reader: _BodyReader, scope: _Scope, function: CFunction, places: list[tuple[str, int]], where: str
) -> Operations:
    """Return the operations of a C function whose body was read; ``places`` are the outputs that it must assign."""
    missing = [f"{name}[{index}]" for name, index in places if (name, index) not in scope.written]
    if missing or not places:
        raise CertificateError(f"{where}: expected {function.name} to assign {', '.join(missing) or 'an output'}")
    outputs = [(f"{name}[{index}]", scope.written[name, index]) for name, index in places]
    precision = PRECISION[reader.real]
    return reader.builder.finish(function.name, precision, tuple(reader.inputs), outputs)
