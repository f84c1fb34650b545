"""C functions by which kernels are timed: they call a kernel for one sample after the other, or for a batch.

``symrot_repeat_one`` and ``symrot_repeat_batch`` compute n samples, ``repeats`` times; ``a`` holds the addresses of the
arrays for the kernel's arguments.
"""

from symrot.bench.by_hand.kernel_heyoka import LANES
from symrot.codegen.printing.c_function import c_arguments, c_name
from symrot.formula.program import Program, Signature

__all__ = ["drivers", "heyoka_drivers"]


def drivers(signature: Signature, batch: bool) -> str:
    """Return C functions that call a kernel many times, to be timed: ``symrot_repeat_one``, ``symrot_repeat_batch``.

    The first calls the kernel for one sample after the other, the second calls its batch function for all samples. The
    text is to be appended to the C text of the kernel. If ``batch`` is False, the kernel has no batch function, and a
    loop over its one-sample function replaces it.
    """
    every, sizes = signature.arguments, _sizes(signature)
    one = ", ".join(f"{'' if a.is_scalar else '&'}a[{i}][{sizes[a.role]}*k]" for i, a in enumerate(every))
    lines = [] if batch else _batch_of_one(signature)
    lines += [f"static __attribute__((noinline)) void single({c_arguments(Program(signature, (), ()))})", "{",
              f"    {c_name(signature.name)}({', '.join(a.name for a in every)});", "}"]  # fmt: skip
    arguments = ", ".join(f"a[{i}]" for i in range(len(every)))
    return "\n".join([
        "#include <stddef.h>", *lines,
        _REPEAT_ONE.format(call=f"single({one})"),
        _REPEAT_BATCH.format(call=f"{f'{c_name(signature.name)}_batch' if batch else 'batch'}(n, {arguments})"),
    ])  # fmt: skip


_REPEAT_ONE = """void symrot_repeat_one(size_t repeats, size_t n, double **a)
{{
    for (size_t r = 0; r < repeats; ++r)
        for (size_t k = 0; k < n; ++k) {{
            {call};
            __asm__ volatile("" ::: "memory"); /* one sample at a time */
        }}
}}
"""
_REPEAT_BATCH = """void symrot_repeat_batch(size_t repeats, size_t n, double **a)
{{
    for (size_t r = 0; r < repeats; ++r) {{
        {call};
        __asm__ volatile("" ::: "memory");
    }}
}}
"""


def _sizes(signature: Signature) -> dict[str, int]:
    """Return how many numbers a kernel takes (key ``"in"``) and returns (key ``"out"``) for one sample."""
    return {role: sum(a.size for a in signature.arguments if a.role == role) for role in ("in", "out")}


def _batch_of_one(signature: Signature) -> list[str]:
    """Return the C text of a batch function whose loop inlines the kernel's one-sample function."""
    inputs, outputs = ([a for a in signature.arguments if a.role == role] for role in ("in", "out"))
    every = signature.arguments
    pointers = [f"{'const ' if a.role == 'in' else ''}double *restrict {a.name}" for a in every]
    lines = [f"static void batch(size_t n, {', '.join(pointers)})", "{", '    _Pragma("GCC ivdep")',
             "    for (size_t k = 0; k < n; ++k) {"]  # fmt: skip
    for a in inputs:
        values = ", ".join(f"{a.name}[{i}*n + k]" for i in range(a.size))
        held = f"{a.name}_k = {values}" if a.is_scalar else f"{a.name}_k[{a.size}] = {{{values}}}"
        lines.append(f"        const double {held};")
    lines += [f"        double {a.name}_k[{a.size}];" for a in outputs]
    lines.append(f"        {c_name(signature.name)}({', '.join(f'{a.name}_k' for a in every)});")
    lines += [f"        {a.name}[{i}*n + k] = {a.name}_k[{i}];" for a in outputs for i in range(a.size)]
    return [*lines, "    }", "}"]


def heyoka_drivers(signature: Signature) -> str:
    """Return the C functions that :func:`drivers` returns, for a kernel that heyoka has compiled.

    The C text also has a function ``symrot_take``. Before the first call of the others, it must be called with the
    addresses of the three functions that heyoka has compiled.
    """
    sizes, out = _sizes(signature), sum(a.role == "in" for a in signature.arguments)
    return "\n".join([
        "#include <stddef.h>",
        "typedef void (*of_one)(double *, const double *, const double *, const double *);",
        "typedef void (*of_batch)(double *, const double *, const double *, const double *, size_t);",
        "static of_one one;", "static of_batch neighbour, neighbours;",
        "void symrot_take(of_one a, of_batch b, of_batch c)", "{", "    one = a, neighbour = b, neighbours = c;", "}",
        "static void batch(size_t n, const double *in, double *out)", "{", "    size_t k = 0;",
        f"    for (; k + {LANES} <= n; k += {LANES})", "        neighbours(out + k, in + k, 0, 0, n);",
        "    for (; k < n; ++k)", "        neighbour(out + k, in + k, 0, 0, n);", "}",
        _REPEAT_ONE.format(call=f"one(a[{out}] + {sizes['out']}*k, a[0] + {sizes['in']}*k, 0, 0)"),
        _REPEAT_BATCH.format(call=f"batch(n, a[0], a[{out}])"),
    ])  # fmt: skip
