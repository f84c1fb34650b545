"""Batches over many arrays: in each loop over samples nothing is computed after the first store."""

import re

import pytest

from symrot.certify.readback import read_batch, read_kernel
from symrot.codegen.banner import Description
from symrot.codegen.c_source import WAYS, c_source
from symrot.interface import emit
from symrot.kernel import Argument, Program, Signature

LOOP = re.compile(r"\+\+k\) \{\n(.*?)\n\s*\}\n", re.DOTALL)
COMPUTED = re.compile(r"const \w+ \w+ = .*")
STORED = re.compile(r"\w+\[\d+\*n \+ k\] = (\w+|\d+\.\d+f?)")
ASKED = re.compile(r"beyond \+= .*")


def loops(text):
    return [[" ".join(line.split()) for line in body.split(";") if line.strip()] for body in LOOP.findall(text)]


def computes_first(statements):
    """Whether statements of a loop are what is computed, then what is stored, then what is asked of angles."""
    kinds = [next((i for i, kind in enumerate((COMPUTED, STORED, ASKED)) if kind.fullmatch(s)), 3) for s in statements]
    return kinds == sorted(kinds) and 1 in kinds and 3 not in kinds


def of_many_arrays():
    """Return a program whose outputs are called as an argument, an input, a temporary, words of the loop, a function."""
    inputs = tuple((f"a{i}", "rad", "") for i in range(WAYS))
    results = ("y", "a1", "s", "s_", "k", "end", "sin", "of")
    signature = Signature("f", (Argument("x", "in", inputs), Argument("y", "out", tuple((r, "", "") for r in results))))
    sine = ("s", ("call", "sin", (("symbol", "a0"),)))
    nodes = [("*", ("symbol", "s"), ("symbol", f"a{i}")) for i in range(len(results) - 1)]
    return Program(signature, (sine,), tuple(zip(results, [*nodes, ("symbol", "a2")], strict=True)))


@pytest.mark.parametrize("name, count", [("heavy_top", 2), ("rigid_body_tensor", 4), ("inertia_tetrahedron", 2)])
def test_nothing_is_computed_after_the_first_store(name, count):
    found = loops(emit(name).source)
    assert len(found) == count
    assert all(map(computes_first, found))


def test_nothing_is_computed_after_the_first_store_where_angles_are_asked_for():
    """The names of the results are new, and both loops are still the one-sample function."""
    text = c_source(of_many_arrays(), Description("products", "all", "none", "none"), near=True)
    assert "const double a1_ =" in text and "const double s_ =" in text and "const double s__ =" in text
    assert len(loops(text)) == 2
    assert all(map(computes_first, loops(text)))
    assert read_batch(text, "f_batch").digest() == read_kernel(text, "f").digest()


def test_with_few_arrays_results_are_stored_where_they_are_computed():
    assert not any(map(computes_first, loops(emit("quaternion_product").source)))


def test_a_result_after_a_store_is_noticed():
    before = "const double a = x[0*n + k]; y[0*n + k] = a; "
    assert computes_first([s.strip() for s in (before + "y[1*n + k] = 0.5").split(";")])
    assert not computes_first([s.strip() for s in (before + "y[1*n + k] = a*a").split(";")])
    assert not computes_first([s.strip() for s in (before + "const double b = a*a; y[1*n + k] = b").split(";")])
