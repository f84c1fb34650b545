"""Loops over many arrays compute everything before the first store, beginning with the results that need the fewest
inputs.
"""

import re

import pytest

from symrot.certificates.readback.readback import read_batch, read_kernel
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.printing.banner import Description
from symrot.codegen.printing.c_batch import WAYS
from symrot.codegen.printing.c_source import c_source
from symrot.formula.program import Argument, Program, Signature
from symrot.workshop.emit import emit

LOOP = re.compile(r"\+\+k\) \{\n(.*?)\n\s*\}\n", re.DOTALL)
COMPUTED = re.compile(r"const \w+ \w+ = .*")
STORED = re.compile(r"\w+\[(\d+\*n \+ |n \+ |)k\] = (\w+|\d+\.\d+f?)")
INDEX = {0: "k", 1: "n + k"}
ASKED = re.compile(r"beyond \+= .*")


def loops(text):
    return [[" ".join(line.split()) for line in body.split(";") if line.strip()] for body in LOOP.findall(text)]


def computes_first(statements):
    """Return whether a loop's statements first compute, then store, then test the size of angles."""
    kinds = [next((i for i, kind in enumerate((COMPUTED, STORED, ASKED)) if kind.fullmatch(s)), 3) for s in statements]
    return kinds == sorted(kinds) and 1 in kinds and 3 not in kinds


def defined(statements, name):
    """Return the index of the loop's statement that gives a name its value."""
    return next(i for i, s in enumerate(statements) if re.match(rf"const \w+ {name} =", s))


def of_many_arrays():
    """Return a program whose outputs are named like an argument, an input, a temporary, a word of the loop and a
    function.
    """
    inputs = tuple((f"a{i}", "rad", "") for i in range(WAYS))
    results = ("y", "a1", "s", "s_", "k", "end", "sin", "of")
    signature = Signature("f", (Argument("x", "in", inputs), Argument("y", "out", tuple((r, "", "") for r in results))))
    sine = ("s", ("call", "sin", (("symbol", "a0"),)))
    nodes = [("*", ("symbol", "s"), ("symbol", f"a{i}")) for i in range(len(results) - 1)]
    return Program(signature, (sine,), tuple(zip(results, [*nodes, ("symbol", "a2")], strict=True)))


@pytest.mark.parametrize("name, count", [("heavy_top", 2), ("inertia_tetrahedron", 2)])
def test_nothing_is_computed_after_the_first_store(name, count):
    found = loops(emit(name).source)
    assert len(found) == count
    assert all(map(computes_first, found))


def test_a_loop_of_a_part_stores_last_where_it_walks_along_many_arrays_itself():
    """The accelerations take twelve arrays and give three; the quaternion rates use eleven in all."""
    found = loops(emit("rigid_body_tensor").source)
    assert [computes_first(each) for each in found] == [True, False, True, False]


def test_nothing_is_computed_after_the_first_store_where_angles_are_asked_for():
    """The results have new names, and both loops still equal the one-sample function."""
    text = c_source(of_many_arrays(), Description("products", "all", "none", "none"), branch_free=True)
    assert "const double a1_ =" in text and "const double s_ =" in text and "const double s__ =" in text
    assert len(loops(text)) == 2
    assert all(map(computes_first, loops(text)))
    assert read_batch(text, "symrot_f_batch").digest() == read_kernel(text, "symrot_f").digest()


@pytest.mark.parametrize(
    "name, early, later",
    [
        ("heavy_top", "dq3", ["A", "B", "C", "c_1", "c_2", "c_3", "domega_1"]),
        ("heavy_top_symmetric", "dq3", ["A", "C", "domega_1"]),
        ("inertia_tetrahedron", "z", ["I_xx"]),
    ],
)
def test_results_of_the_fewest_inputs_are_computed_first(name, early, later):
    """They precede loads that only other results need; stores follow the order of the arguments."""
    text = emit(name).source
    outputs = [a for a in kernel_program(name).signature.arguments if a.role == "out"]
    for statements in loops(text):
        assert defined(statements, early) < min(defined(statements, each) for each in later)
        stores = [s.split(" = ")[0] for s in statements if STORED.fullmatch(s)]
        assert stores == [f"{a.name}[{INDEX.get(i, f'{i}*n + k')}]" for a in outputs for i in range(a.size)]
    for kernel in (name, f"{name}f"):
        assert read_batch(text, f"symrot_{kernel}_batch").digest() == read_kernel(text, f"symrot_{kernel}").digest()


def test_where_all_values_fit_into_registers_results_are_computed_in_the_order_of_the_arguments():
    for statements in loops(emit("inertia_triangular_prism").source):
        assert defined(statements, "I_xx") < defined(statements, "x")


def test_with_few_arrays_results_are_stored_where_they_are_computed():
    assert not any(map(computes_first, loops(emit("quaternion_product").source)))


def test_a_result_after_a_store_is_noticed():
    before = "const double a = x[0*n + k]; y[0*n + k] = a; "
    assert computes_first([s.strip() for s in (before + "y[1*n + k] = 0.5").split(";")])
    assert not computes_first([s.strip() for s in (before + "y[1*n + k] = a*a").split(";")])
    assert not computes_first([s.strip() for s in (before + "const double b = a*a; y[1*n + k] = b").split(";")])
