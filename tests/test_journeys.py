"""Each of the three journeys passes each room once: it reads, plans, derives, interprets and prints nothing twice.

Python's profiler counts the calls, so a count does not depend on how a function is imported.
"""

import sys
from collections import Counter
from contextlib import contextmanager
from pathlib import Path
from types import CodeType

import pytest

import symrot
from symrot.certificates.readback.readback import read_kernel
from symrot.checker.claim.claims import Claim
from symrot.closed_form.registry import exact_form
from symrot.codegen.library_kernels import kernel_program
from symrot.codegen.lowering.lower import lower
from symrot.codegen.printing.c_function import c_function
from symrot.codegen.printing.c_source import c_functions
from symrot.codegen.printing.numpy_source import numpy_source
from symrot.codegen.scene_kernels import derive_scene_kernel, rates_program
from symrot.dynamics.equations import equations_of_motion
from symrot.planning.plan import make_plan
from symrot.propagation.method import choose_method
from symrot.propagation.steppers.smoothness import non_smooth_torque
from symrot.scene.scene import load_scene
from symrot.workshop import kernel_files as files
from symrot.workshop.certify import audit_file
from symrot.workshop.kernel_text import LibraryText, SceneText


@contextmanager
def counted(*functions):
    """Count the calls of functions, by name, while the ``with`` block runs."""
    codes: dict[CodeType, str] = {function.__code__: function.__qualname__ for function in functions}
    calls: Counter[str] = Counter()

    def count(frame, event, argument):
        if event == "call" and frame.f_code in codes:
            calls[codes[frame.f_code]] += 1

    before = sys.getprofile()
    sys.setprofile(count)
    try:
        yield calls
    finally:
        sys.setprofile(before)


@pytest.mark.parametrize(("scene", "method"), [("t_handle", "exact"), ("damped_disk", "taylor")])
def test_a_scene_is_read_planned_and_judged_once_on_its_way_to_a_trajectory(scene, method):
    with counted(load_scene, make_plan, choose_method, exact_form, non_smooth_torque, derive_scene_kernel) as calls:
        assert symrot.propagate(scene).method == method
    assert calls.pop("derive_scene_kernel", 0) <= 1  # 0 if an earlier test left the kernel in the cache
    once = {"load_scene", "make_plan", "choose_method", "exact_form"}
    assert calls == dict.fromkeys(once | ({"non_smooth_torque"} if method == "taylor" else set()), 1)


@pytest.mark.parametrize("text", ["sin(2*x) == 2*sin(x)*cos(x)", "sin(2*x) == sin(x)*cos(x)"])
def test_a_claim_gets_its_meaning_once_on_its_way_to_a_verdict(text):
    with counted(Claim.definitions.func, Claim.equation.func) as calls:
        verdict = symrot.check(text, repair=False)
    assert calls == {"Claim.definitions": 1, "Claim.equation": 1}
    assert bool(verdict) == ("2*sin(x)" in text)


def certified(kernel, folder):
    """Return all files of a kernel, as `symrot emit --all` and `symrot certify` make them."""
    bounds = files.stored_bounds(kernel, folder)
    texts = kernel.files("c", bounds) | kernel.files("numpy")
    return texts | files.certificate_files(kernel, folder, bounds)


def test_an_audit_reads_each_function_once():
    """Four functions (C for double and float, JavaScript, JAX) are read once in the files and, unless an earlier test did
    this, once as printed.
    """
    read_kernel.cache_clear()
    with counted(read_kernel.__wrapped__) as calls:
        audit_file(Path(__file__).parents[1] / "generated" / "c" / "quaternion_dcm.cert.json")
    assert 2 <= calls["read_kernel"] <= 8


PRINTERS = (lower, c_functions, c_function, numpy_source)


def test_a_library_kernel_is_lowered_once_and_printed_once_per_precision(tmp_path):
    kernel = LibraryText("quaternion_body_rates")
    kernel_program.cache_clear()
    with counted(*PRINTERS) as calls:
        texts = certified(kernel, tmp_path)
    assert calls == {"lower": 1, "c_functions": 1, "c_function": 2, "numpy_source": 1}
    assert len(texts) == 4


def test_a_scene_kernel_is_planned_derived_and_printed_once(tmp_path):
    with counted(load_scene, make_plan, equations_of_motion, rates_program, *PRINTERS) as calls:
        texts = certified(SceneText(load_scene("t_handle")), tmp_path)
    assert calls == dict.fromkeys(
        ("load_scene", "make_plan", "equations_of_motion", "rates_program", "lower", "c_functions", "c_function",
         "numpy_source"), 1,
    )  # fmt: skip
    assert len(texts) == 4
