"""Public names: docstrings with all sections, examples that run, exported types, and types that checkers see."""

import ast
import builtins
import doctest
import importlib
import inspect
import re
import subprocess
import sys
import textwrap
import tomllib
import typing
from pathlib import Path

import pytest

import symrot
from tests.syntax import import_statements

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "symrot"
PUBLIC = [name for name in symrot.__all__ if callable(getattr(symrot, name))]
WITH_EXAMPLES = sorted(
    ".".join(("symrot", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")
    for path in PACKAGE.rglob("*.py")
    if ">>>" in path.read_text(encoding="utf-8")
)
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def failures(module):
    """Run the examples in a module's docstrings; return the number of failures and the number of examples."""
    return tuple(doctest.testmod(module, optionflags=FLAGS))


@pytest.mark.usefixtures("quick_compiler")
@pytest.mark.parametrize("name", WITH_EXAMPLES)
def test_the_examples_of_a_module_run(name):
    failed, tried = failures(importlib.import_module(name))
    assert failed == 0 and tried > 0


def missing_sections(value):
    """Return the sections that are missing in the docstring of a public function or class."""
    document = inspect.getdoc(value) or ""
    present = {title for title in ("Parameters", "Attributes", "Returns", "Raises", "Examples")
               if f"\n{title}\n{'-' * len(title)}\n" in document}  # fmt: skip
    required = {"Examples"}
    if inspect.isclass(value):
        fields = getattr(value, "__dataclass_fields__", None) or getattr(value, "_fields", None)
        if fields and not present & {"Parameters", "Attributes"}:
            required.add("Attributes")
    else:
        required |= {"Parameters"} if inspect.signature(value).parameters else set()
        required |= {"Returns"}
        tree = ast.parse(textwrap.dedent(inspect.getsource(value)))
        required |= {"Raises"} if any(isinstance(node, ast.Raise) for node in ast.walk(tree)) else set()
    if ">>>" not in document.partition("\nExamples\n")[2]:
        present.discard("Examples")
    return sorted(required - present)


def unmentioned_parameters(function):
    """Return the parameters of a function that its section Parameters does not name."""
    section = (inspect.getdoc(function) or "").partition("\nParameters\n")[2].partition("\n\n")[0]
    named = {name.strip("* ") for line in section.splitlines() if not line.startswith(" ")
             for name in line.partition(" : ")[0].split(",")}  # fmt: skip
    return sorted(set(inspect.signature(function).parameters) - named)


def test_a_public_name_has_all_sections():
    for name in PUBLIC:
        value = getattr(symrot, name)
        assert missing_sections(value) == [], name
        if inspect.isfunction(value):
            assert unmentioned_parameters(value) == [], name


def undocumented(angle):
    """Return an angle."""
    if angle < 0:
        raise ValueError(angle)
    return angle


def test_missing_sections_and_wrong_examples_are_noticed():
    assert missing_sections(undocumented) == ["Examples", "Parameters", "Raises", "Returns"]
    assert unmentioned_parameters(undocumented) == ["angle"]
    module = type(sys)("wrong")
    module.__doc__ = ">>> 1 + 1\n3\n"
    runner = doctest.DocTestRunner(optionflags=FLAGS, verbose=False)
    (test,) = doctest.DocTestFinder().find(module, "wrong")
    assert runner.run(test, out=lambda text: None) == (1, 1)


def own_classes(annotation):
    """Yield the classes of symrot in an annotation, also those inside unions and containers."""
    for part in typing.get_args(annotation):
        yield from own_classes(part)
    if inspect.isclass(annotation) and annotation.__module__.startswith("symrot."):
        yield annotation


def unexported(function):
    """Return the classes of symrot that a function takes or returns and symrot does not export."""
    names = {name: getattr(symrot, name) for name in symrot.__all__}
    hints = typing.get_type_hints(function, localns={**vars(builtins), **names})
    classes = {each for hint in hints.values() for each in own_classes(hint)}
    return sorted(each.__name__ for each in classes if names.get(each.__name__) is not each)


def callables_of(value):
    """Yield a public function, or the public methods and properties of a public class."""
    if not inspect.isclass(value):
        yield value
        return
    for name, member in vars(value).items():
        function = getattr(member, "fget", None) or getattr(member, "func", None) or member
        if (not name.startswith("_") or name == "__call__") and inspect.isfunction(function):
            yield function


def test_public_functions_take_and_return_exported_classes():
    functions = [getattr(symrot, name) for name in PUBLIC if inspect.isfunction(getattr(symrot, name))]
    assert {name for function in functions for name in unexported(function)} == set()


def test_public_methods_return_few_classes_that_are_not_exported():
    """The exceptions are parts of kernels, plans, solids and inertials that only symrot makes and reads."""
    inner = {
        "Conserved", "FormulaTorque", "Integral", "MassProperties", "Motion", "Principal", "Program", "Shape",
    }  # fmt: skip
    functions = [function for name in PUBLIC for function in callables_of(getattr(symrot, name))]
    assert {name for function in functions for name in unexported(function)} == inner


def raised_names(function):
    """Return the exceptions in a docstring's section Raises."""
    section = (inspect.getdoc(function) or "").partition("\nRaises\n")[2].partition("\n\n")[0]
    lines = [line for line in section.splitlines()[1:] if not line.startswith(" ")]
    return [name.strip() for line in lines for name in line.split(",")]


def test_documented_exceptions_are_exported():
    for name in PUBLIC:
        for function in callables_of(getattr(symrot, name)):
            others = [each for each in raised_names(function) if each not in symrot.__all__]
            assert all(hasattr(builtins, each) for each in others), (name, others)


def test_a_class_that_is_not_exported_is_noticed():
    from symrot.scene.reader import Entry

    def function(entry: list[Entry | None]) -> symrot.Scene: ...

    assert unexported(function) == ["Entry"]


def test_stub_and_lazy_imports_name_the_same_things():
    stub = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    imported = {
        alias.name: node.module for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    assert sorted([*imported, "__version__"]) == sorted(symrot.__all__)
    for name, module in imported.items():
        assert getattr(importlib.import_module(module), name) is getattr(symrot, name)


def test_old_names_warn_and_still_work():
    with pytest.warns(DeprecationWarning, match=r"symrot\.quaternion_product"):
        assert symrot.qmul is symrot.quaternion_product
    with pytest.warns(DeprecationWarning, match=r"symrot\.quaternion_to_dcm"):
        assert symrot.dcm_of is symrot.quaternion_to_dcm


def test_only_input_errors_are_value_errors():
    errors = {name: getattr(symrot, name) for name in symrot.__all__ if name.endswith("Error")}
    errors = {name: each for name, each in errors.items() if issubclass(each, Exception)}
    assert {name for name, each in errors.items() if issubclass(each, ValueError)} == {"InputError"}
    assert all(issubclass(each, symrot.SymrotError) for each in errors.values())


def test_the_python_page_lists_every_public_name():
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    paths = [line.removeprefix("::: ").rsplit(".", 1) for line in page.splitlines() if line.startswith("::: ")]
    assert sorted(name for _, name in paths) == sorted(set(symrot.__all__) - {"__version__"})
    assert all(getattr(importlib.import_module(module), name) is getattr(symrot, name) for module, name in paths)


OPTIONAL = {
    "argcomplete",
    "dask",
    "matplotlib",
    "mpl_toolkits",
    "PIL",
    "imageio_ffmpeg",
    "tqdm",
    "heyoka",
    "symforce",
    "casadi",
    "distributed",
    "trimesh",
}  # extras (matplotlib brings mpl_toolkits and requires PIL), peers of benchmarks


def undeclared(imports, dependencies):
    """Return the imported packages that are not declared dependencies, optional or part of standard Python."""
    return imports - dependencies - OPTIONAL - set(sys.stdlib_module_names) - {"symrot"}


def test_every_third_party_import_is_declared():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    dependencies = {re.split(r"[<>=]", each)[0] for each in project["dependencies"]}
    imports = set()
    for path in PACKAGE.rglob("*.py"):
        for node in import_statements(path):
            if isinstance(node, ast.Import):
                imports |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                imports.add(node.module.partition(".")[0])
    assert undeclared(imports, dependencies) == set() and dependencies <= imports
    assert undeclared(imports, dependencies - {"mpmath"}) == {"mpmath"}


REVEALED = {  # expression -> the type that mypy reveals
    'symrot.propagator("t_handle")': "symrot.propagation.propagator.Propagator",
    'symrot.propagate("t_handle")': "symrot.propagation.trajectory.Trajectory",
    'symrot.propagate("t_handle").invariants[0]': "symrot.propagation.trajectory.Invariant",
    'symrot.load_scene("t_handle")': "symrot.scene.scene.Scene",
    'symrot.plan("t_handle")': "symrot.planning.plan.Plan",
    'symrot.check("x == x")': "symrot.checker.verdict.Verdict",
    'symrot.check("x == x").counterexample': "symrot.exact.evidence.Counterexample | None",
    'symrot.identify("x")[0]': "symrot.checker.verdict.Identification",
    'symrot.derivation("poinsot")': "symrot.proof.derivation.Derivation",
    'symrot.solid("cone")': "symrot.inertia.solids.Solid",
    'symrot.rate_jacobian("ZXZ")': "symrot.kinematics.euler.EulerRateMatrix",
    'symrot.emit("heavy_top")': "symrot.workshop.emit.Emitted",
    'symrot.certify("heavy_top")': "symrot.workshop.certification.Certificate",
    'symrot.audit("heavy_top.cert.json")': "symrot.workshop.certification.Audit",
    'symrot.bound("heavy_top")': "symrot.workshop.certification.RoundingBounds",
    "symrot.kernel_names()": "tuple[str, ...]",
    'symrot.propagate_ensemble("t_handle")': "symrot.ensemble.ensemble.Ensemble",
}


def test_type_checkers_see_every_public_name(tmp_path):
    """A user's script passes mypy --strict, which reports an unknown name in it."""
    pytest.importorskip("mypy")
    lines = ["import symrot", *(f"reveal_type({expression})" for expression in REVEALED), "symrot.no_such_name"]
    script = tmp_path / "script.py"
    script.write_text("\n".join(lines) + "\n", encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file", str(ROOT / "pyproject.toml"), "--no-pretty", str(script)],
        capture_output=True, text=True, cwd=ROOT,
    )  # fmt: skip
    revealed = [line.partition('"')[2].rstrip('"') for line in done.stdout.splitlines() if "Revealed type" in line]
    revealed = [each.partition("fallback=")[2].rstrip("]") or each for each in revealed]  # a NamedTuple is also a tuple
    assert revealed == list(REVEALED.values()), done.stdout
    errors = [line for line in done.stdout.splitlines() if ": error:" in line]
    assert len(errors) == 1 and "no_such_name" in errors[0]
