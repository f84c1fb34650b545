"""The package as installed: its rooms and the imports between them, its wheel, its import time."""

import ast
import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections import Counter
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import symrot
from tests.syntax import import_statements

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "symrot"

ROOMS = (  # from left to right: a module imports, anywhere, only from its own room and from rooms on its left
    {"errors", "conventions", "files", "formula", "latex", "symbols"},
    {"exact"},
    {"proof"},
    {"kinematics", "inertia"},
    {"exchange"},
    {"dynamics"},
    {"catalogue", "textbook", "scene"},
    {"checker"},
    {"planning", "kernels"},
    {"codegen", "build"},
    {"certificates"},
    {"results"},
    {"closed_form", "propagation"},
    {"ensemble"},
    {"sweeps"},
    {"viewer"},
    {"figures"},
    {"exercises"},
    {"lessons"},
    {"report"},
    {"workshop"},
    {"notebook"},
    {"bench"},
    {"cli", "__main__"},
)
MOST_IN_A_ROOM = 16
ORDER = {room: place for place, rooms in enumerate(ROOMS) for room in rooms}
WITHOUT_SYMPY = (
    "errors", "conventions", "latex.reader", "latex.cursor", "formula.tree", "formula.exact_numbers", "formula.program", "kinematics.conversions", "kinematics.continuity",
    "kinematics.hamilton", "kinematics.rates",
    "inertia.composite",
    "inertia.principal", "dynamics.structure", "dynamics.torque_kinds", "scene.scene", "planning.plan", "planning.scene_kernel", "build.cache",
    "propagation.propagator", "propagation.trajectory", "results.samples", "results.tables", "report.summary", "cli.main",
)  # fmt: skip


def room_of(module):
    parts = module.split(".")
    return parts[1] if parts[0] == "symrot" and len(parts) > 1 else None


def imports_of(path):
    """Return the modules of symrot that a file imports anywhere: at its top, in functions, or for types alone."""
    for node in import_statements(path):
        if isinstance(node, ast.ImportFrom) and node.module:
            for name in node.names:
                yield f"{node.module}.{name.name}" if f"{node.module}.{name.name}" in MODULES else node.module
        elif isinstance(node, ast.Import):
            yield from (name.name for name in node.names)


def module_of(path):
    return ".".join(("symrot", *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")


MODULES = {module_of(path): path for path in sorted(PACKAGE.rglob("*.py"))}


@pytest.fixture(scope="module")
def imports():
    """Return each module with the modules of symrot that it imports."""
    return {
        module: {name for name in imports_of(path) if name in MODULES} - {module} for module, path in MODULES.items()
    }


def backward(imports):
    """Return the imports, as (module, imported name), that lead from a room to a room on its right."""
    return [
        (module, name)
        for module, names in imports.items()
        for name in sorted(names)
        if module != "symrot" and room_of(name) and ORDER[room_of(name)] > ORDER[room_of(module)]
    ]


def test_imports_go_one_way(imports):
    assert {room_of(module) for module in MODULES} - {None} == set(ORDER)
    assert backward(imports) == []


def test_no_modules_import_each_other_in_a_circle(imports):
    tuple(TopologicalSorter(imports).static_order())


def test_walls_and_circles_are_noticed(imports):
    assert backward({"symrot.exact.decide": {"symrot.cli.main"}}) == [("symrot.exact.decide", "symrot.cli.main")]
    with pytest.raises(CycleError):
        tuple(TopologicalSorter({**imports, "symrot.errors": {"symrot.cli.main"}}).static_order())


def test_no_room_is_crowded():
    """A folder has at most 16 modules beside tables of data, so that a reader can survey it."""
    rooms = Counter(path.parent for path in MODULES.values() if path.stem != "__init__")
    assert {str(room.relative_to(PACKAGE)): count for room, count in rooms.items() if count > MOST_IN_A_ROOM} == {}


def run(code, **environment):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=os.environ | environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_numeric_half_imports_neither_sympy_nor_scipy():
    """One process imports all its modules."""
    modules = ", ".join(f"symrot.{module}" for module in WITHOUT_SYMPY)
    code = f"import sys, {modules}; print([m for m in ('sympy', 'scipy', 'matplotlib') if m in sys.modules])"
    assert run(code).strip() == "[]"


def test_importing_symrot_imports_next_to_nothing():
    loaded = run("import sys, symrot; print(*[m for m in sys.modules if m.startswith('symrot.')])").split()
    assert loaded == []


def test_a_check_without_integrals_imports_no_numpy():
    claims = ["sqrt(x**2) == x", "I = 2/5 m r^2"]
    code = f"import sys, symrot; print([symrot.check(c).verdict for c in {claims}], 'numpy' in sys.modules)"
    assert run(code).strip() == "['conditional', 'recognised'] False"


def test_an_identity_is_checked_without_the_table_of_known_formulas():
    recognition = "symrot.checker.recognition.known_formulas"
    code = f"import sys, symrot; print(symrot.check('sin(2x) = 2 sin x cos x').verdict, {recognition!r} in sys.modules)"
    assert run(code).strip() == "true False"


def test_every_public_name_is_there_and_documented():
    for name in set(symrot.__all__) - {"__version__"}:
        value = getattr(symrot, name)
        assert isinstance(value, tuple) or value.__doc__, name


def test_a_name_that_is_not_there_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = symrot.nothing


@pytest.fixture(scope="module")
def unpacked_wheel(tmp_path_factory):
    """Return the folder of the wheel, unpacked outside the source tree.

    It is built from a copy, because setuptools writes into the folder that it builds, and two processes may test.
    """
    directory = tmp_path_factory.mktemp("wheel")
    source = directory / "source"
    shutil.copytree(PACKAGE, source / "symrot", ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "README.md", "LICENSE", "MANIFEST.in"):
        shutil.copy(ROOT / name, source)
    command = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--no-deps",
        "--no-build-isolation",
        "-w",
        str(directory),
        str(source),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (wheel,) = directory.glob("symrot-*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(directory / "site")
    return directory / "site"


def test_the_wheel_runs_a_shipped_scene_outside_the_source_tree(unpacked_wheel, tmp_path):
    code = "import symrot, sys; assert symrot.__file__.startswith(sys.argv[1]); print(symrot.propagate('heavy_top_loops').success)"
    done = subprocess.run(
        [sys.executable, "-c", code, str(unpacked_wheel)], cwd=tmp_path, capture_output=True, text=True,
        env=os.environ | {"PYTHONPATH": str(unpacked_wheel), "SYMROT_CACHE": str(tmp_path / "cache")},
    )  # fmt: skip
    assert done.stdout.strip() == "True", done.stderr


def test_the_wheel_holds_all_data_and_no_test(unpacked_wheel):
    held = {str(path.relative_to(unpacked_wheel)) for path in unpacked_wheel.rglob("*") if path.is_file()}
    wanted = {
        str(path.relative_to(ROOT))
        for suffix in ("py", "pyi", "toml", "c", "h", "typed", "css", "js", "woff2")
        for path in PACKAGE.rglob(f"*.{suffix}")
    }
    assert wanted <= held
    assert not any(name.startswith("tests") for name in held)


def test_all_files_name_the_same_version(unpacked_wheel):
    (metadata,) = unpacked_wheel.glob("symrot-*.dist-info/METADATA")
    (changes,) = re.findall(r"^## \[(\d.*?)\]", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)[:1]
    (citation,) = re.findall(r"^version: (.*)$", (ROOT / "CITATION.cff").read_text("utf-8"), re.MULTILINE)
    (installed,) = re.findall(r"^Version: (.*)$", metadata.read_text("utf-8"), re.MULTILINE)
    assert {changes, citation, installed} == {symrot.__version__}


def test_a_warm_run_imports_nothing_it_can_do_without(tmp_path):
    """The start is fast if it imports neither OpenSSL nor archives nor commands that are not used."""
    spared = (
        "sympy",
        "scipy",
        "matplotlib",
        "hashlib",
        "_hashlib",
        "shutil",
        "bz2",
        "symrot.bench",
        "symrot.workshop.input_ranges",
    )
    code = (
        "import sys, io; from symrot.cli.main import main; sys.stdout = io.StringIO(); main(['run', 'tumbling_prism']); "
        f"print([m for m in {spared!r} if m in sys.modules], file=sys.stderr)"
    )
    for _ in range(2):  # the first fills the cache
        done = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            env=os.environ | {"SYMROT_CACHE": str(tmp_path)},
        )
    assert done.stderr.strip().splitlines()[-1] == "[]"


def test_help_of_one_command_and_of_all():
    """A known command builds its parser alone; `--help` and an unknown command list the names of all."""
    lines = run("from symrot.cli.main import COMMANDS, _parser; print(_parser('run').format_help(), *COMMANDS)")
    assert "propagate a scene" in lines and "bench" in lines
    done = subprocess.run([sys.executable, "-m", "symrot", "--help"], capture_output=True, text=True)
    assert all(name in done.stdout for name in ("run", "certify", "bench", "doctor"))
    done = subprocess.run([sys.executable, "-m", "symrot", "run", "--help"], capture_output=True, text=True)
    assert "usage: symrot run" in done.stdout and "--tolerance" in done.stdout
