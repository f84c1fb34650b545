"""The reader of emitted JAX text: it rewrites the text as C with the same meaning, which readback.py reads.

Kernels in JAX use few words, so that replacing them gives C; other Python is refused. Array sizes come from the C
function of the same kernel. This module shares no code with the emitter.
``where`` is the name of a file, for error messages.
"""

import re

from symrot.certificates.readback.c_functions import CFunction
from symrot.certificates.readback.other_languages import compare_operations, kernel_head
from symrot.errors import CertificateError

__all__ = ["compare_jax"]

_HEAD = re.compile(r'"""(?:(?!""")[^\\])*"""\n\n(?:import jax\n)?import jax\.numpy as jnp\n', re.ASCII)
_DEFINITION = re.compile(r"((?:@jax\.custom_jvp\n)?)def (\w+)\(([\w, ]*)\):\n", re.ASCII)
_ASSIGNMENT = re.compile(r"    ([A-Za-z_]\w*) = (.+)", re.ASCII)
_UNPACKING = re.compile(r"    \(?(\w+(?:, \w+)*)(?:,\))? = ([A-Za-z_]\w*)", re.ASCII)
_STACK = re.compile(r"    ([A-Za-z_]\w*) = jnp\.stack\(\[", re.ASCII)
_ENTRY = re.compile(r"        (.+),", re.ASCII)
_RETURN = re.compile(r"    return (.+)", re.ASCII)
_CHOICE = re.compile(r"jnp\.where\((.*)\)", re.ASCII)
_TOKEN = re.compile(r"\s+|\d[\w.]*(?:(?<=[eE])[+-]\d+)?|[A-Za-z_]\w*(?:\.[a-z]\w*)?|>=|<=|==|[-+*/()\[\],<>]", re.ASCII)
_ARRAY_FUNCTIONS = {
    f"jnp.{name}": name for name in ("sqrt", "sin", "cos", "tan", "exp", "log", "sinh", "cosh", "tanh", "copysign")
} | {"jnp.abs": "fabs", "jnp.arcsin": "asin", "jnp.arccos": "acos", "jnp.arctan": "atan", "jnp.arctan2": "atan2"}
_ONLY_IN_C = {"double", "float", "void", "static", "inline", "size_t", "const", "return", *_ARRAY_FUNCTIONS.values()}
_NOT_IN_C = {"and", "or", "not", "if", "else", "in", "is", "lambda", "for", "jnp", "jax"}
_SLOPES = {"sinc": "tangent_gap", "sine_gap": "sine_bend", "tangent_gap": "tangent_bend"}
_RULES = {
    name: f"@_{name}.defjvp\ndef _{name}_jvp(primals, tangents):\n    (x,), (dx,) = primals, tangents\n"
    f"    return _{name}(x), -x*_{slope}(x)*dx\n"
    for name, slope in _SLOPES.items()
}
"""Function -> the text that must define its derivative in JAX, accepted only word for word.

For example, the derivative of sinc(x) = sin(x)/x is -x*tangent_gap(x), where tangent_gap(x) = (sin x - x cos x)/x^3.
"""


def compare_jax(text: str, name: str, c_text: str, where: str = "kernel") -> None:
    """Raise CertificateError unless a JAX kernel performs the same operations as the C function for doubles."""
    compare_operations(_as_c, text, name, c_text, where)


def _as_c(text: str, name: str, model: CFunction, where: str) -> str:
    """Return a JAX module as C text with the same meaning; ``model`` is the kernel's C function."""
    head = _HEAD.match(text)
    if head is None:
        raise CertificateError(f"{where}: expected a docstring and the import of jax.numpy, as symrot emits them")
    functions, rules, needed = [], set[str](), set[str]()
    for block in text[head.end() :].strip("\n").split("\n\n"):
        block = block.strip("\n") + "\n"
        # the rules that JAX needs for derivatives are accepted word for word
        rule = next((each for each, words in _RULES.items() if words == block), None)
        if rule is not None:
            rules.add(rule)
            continue
        definition = _DEFINITION.match(block)
        if definition is None:
            raise CertificateError(f"{where}: expected only definitions of functions, got {block[:30]!r}")
        mark, function, arguments = definition.groups()
        lines, inputs = block[definition.end() :].splitlines(), arguments.split(", ") if arguments else []
        if function == name:
            functions.append(_kernel(lines, inputs, model, where))
            continue
        if mark:
            needed.add(function.removeprefix("_"))
        if not re.fullmatch("_[a-z][a-z_]*", function) or set(inputs) & (_ONLY_IN_C | _NOT_IN_C):
            raise CertificateError(
                f"{where}: expected auxiliary functions with a name such as _sinc, got {function}({arguments})"
            )
        functions.append(_function(function, lines, inputs, where))
    if rules != needed:
        raise CertificateError(
            f"{where}: expected a rule for the derivative of each function that is marked with jax.custom_jvp, and no "
            "other rules"
        )
    return "\n".join(functions)


def _function(name: str, lines: list[str], inputs: list[str], where: str) -> str:
    """Return the C text of a function such as sinc from the ``lines`` of its body in JAX."""
    # assignments, then a choice between two formulas
    body = [_assignment(line, where) for line in lines[:-1]]
    result = _RETURN.fullmatch(lines[-1] if lines else "")
    choice = _CHOICE.fullmatch(result[1]) if result else None
    parts = _split(choice[1]) if choice else []
    if len(parts) != 3:
        raise CertificateError(f"{where}: expected {name} to return jnp.where(condition, value, other)")
    condition, value, other = (_translated(part, where) for part in parts)
    arguments = ", ".join(f"double {each}" for each in inputs)
    return "\n".join(
        [f"static inline double {name}({arguments})", "{", *body, f"return {condition} ? {value} : {other};", "}"]
    )


def _kernel(lines: list[str], inputs: list[str], model: CFunction, where: str) -> str:
    """Return the C text of the kernel from the ``lines`` of its body in JAX; ``model`` is its C function."""
    # arguments and results must be those of ``model``
    outputs = [p for p in model.parameters if p.size and not p.is_const]
    expected = [p.name for p in model.parameters if p not in outputs]
    if inputs != expected:
        raise CertificateError(f"{where}: expected the arguments {', '.join(expected)}, got {', '.join(inputs)}")
    if not lines or lines[-1] != f"    return {', '.join(p.name for p in outputs)}":
        raise CertificateError(f"{where}: expected the function to return {', '.join(p.name for p in outputs)}")
    body, place = [], 0
    for each in (p for p in model.parameters if p.size and p.is_const):
        body += _unpacking(lines[place], each.name, each.size, where)
        place += 1
    while place < len(lines) - 1:
        stack = _STACK.fullmatch(lines[place])
        place += 1
        if stack is None:
            body.append(_assignment(lines[place - 1], where))
            continue
        index = 0
        while (entry := _ENTRY.fullmatch(lines[place])) is not None:
            if len(_split(entry[1])) != 1:
                raise CertificateError(f"{where}: expected one formula in each line of {stack[1]}")
            body.append(f"{stack[1]}[{index}] = {_translated(entry[1], where)};")
            index, place = index + 1, place + 1
        if lines[place] != "    ])":
            raise CertificateError(f"{where}: expected the end of the array {stack[1]}, got {lines[place][:30]!r}")
        place += 1
    return "\n".join([kernel_head(model), "{", *body, "}"])


def _unpacking(line: str, argument: str, size: int, where: str) -> list[str]:
    """Return the line that names the components of an argument as C: ``_, b = x`` gives ``const double b = x[1];``."""
    match = _UNPACKING.fullmatch(line)
    components = match[1].split(", ") if match else []
    if match is None or match[2] != argument or len(components) != size or set(components) & (_ONLY_IN_C | _NOT_IN_C):
        raise CertificateError(f"{where}: expected names for the {size} components of {argument}, got {line[:40]!r}")
    return [f"const double {name} = {argument}[{i}];" for i, name in enumerate(components) if name != "_"]


def _assignment(line: str, where: str) -> str:
    """Return a line of JAX, an assignment to a new variable, as C: ``a = x*y`` gives ``const double a = x*y;``."""
    match = _ASSIGNMENT.fullmatch(line)
    if match is None or match[1] in _ONLY_IN_C | _NOT_IN_C:
        raise CertificateError(f"{where}: expected an assignment as symrot emits it, got {line[:40]!r}")
    return f"const double {match[1]} = {_translated(match[2], where)};"


def _split(text: str) -> list[str]:
    """Return the parts of a text between the commas outside brackets; an empty list if a bracket closes too early."""
    depth, parts = 0, [""]
    for letter in text:
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
        if depth < 0:
            return []
    return parts


def _translated(content: str, where: str) -> str:
    """Return a formula of JAX as C, such as ``sin(x)`` for ``jnp.sin(x)``."""
    place, words = 0, []
    while place < len(content):
        match = _TOKEN.match(content, place)
        if match is None or content[place : place + 2] in ("**", "//"):
            raise CertificateError(f"{where}: expected JAX as symrot emits it, got {content[place : place + 20]!r}")
        word, place = match[0], match.end()
        if word in _ARRAY_FUNCTIONS:
            word = _ARRAY_FUNCTIONS[word]
        elif "." in word and not word[0].isdigit():
            raise CertificateError(f"{where}: expected a function of jax.numpy that kernels use, got {word}")
        # emitted JAX does not contain, for example, names of C functions
        elif word in _ONLY_IN_C or word in _NOT_IN_C or word.startswith("symrot_"):
            raise CertificateError(f"{where}: expected JAX as symrot emits it, got the word {word}")
        words.append(word)
    return "".join(words)
