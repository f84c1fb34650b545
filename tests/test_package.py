"""The package as it is installed: its walls, its wheel, its import time."""

import ast
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import symrot

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "symrot"

ROOMS = (  # from left to right: a module imports at its top only from its own room and from rooms on its left
    {
        "errors",
        "conventions",
        "expression",
        "expression_advice",
        "input_file",
        "switches",
        "number",
        "symbols",
        "kernel",
    },
    {"exact"},
    {"proof", "proof_pages"},
    {"kinematics", "inertia"},
    {"dynamics"},
    {"catalogue", "textbook"}
    | {"scene_reader", "scene_file", "scene_attitude", "scene_body", "scene_torque", "scene_table", "scene"},
    {"checker"},
    {"planner", "scene_kernel", "kernels"},
    {"codegen"},
    {"certify"},
    {"closed_form", "propagation"},
    {"ensemble"},
    {"interface"},
    {"report", "bench"},
    {"cli_output", "cli_certify", "cli", "__main__"},
)
ORDER = {room: place for place, rooms in enumerate(ROOMS) for room in rooms}
WITHOUT_SYMPY = (
    "errors", "conventions", "expression", "number", "kernel", "kinematics.conversions", "kinematics.continuity", "kinematics.rates",
    "inertia.composite",
    "inertia.principal", "dynamics.torque_kinds", "scene", "planner", "scene_kernel", "codegen.library",
    "propagation.propagator", "propagation.trajectory", "report.summary", "cli",
)  # fmt: skip


def room_of(module):
    parts = module.split(".")
    return parts[1] if parts[0] == "symrot" and len(parts) > 1 else None


def imports_of(path):
    """The modules of symrot that a file imports when it is imported itself."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = (
                [f"{node.module}.{alias.name}" for alias in node.names] if node.module == "symrot" else [node.module]
            )
            yield from (name for name in names if room_of(name) in ORDER)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if room_of(alias.name))


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_go_one_way(path):
    own = path.relative_to(PACKAGE).with_suffix("").parts[0]
    if own == "__init__":
        return
    assert own in ORDER, f"{own} has no place in the table of rooms"
    for module in imports_of(path):
        assert ORDER[room_of(module)] <= ORDER[own], f"{own} imports {module} from its right"


def run(code, **environment):
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=os.environ | environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("module", WITHOUT_SYMPY)
def test_the_numeric_half_imports_neither_sympy_nor_scipy(module):
    code = f"import sys, symrot.{module}; print([m for m in ('sympy', 'scipy', 'matplotlib') if m in sys.modules])"
    assert run(code).strip() == "[]"


def test_importing_symrot_imports_next_to_nothing():
    loaded = run("import sys, symrot; print(*[m for m in sys.modules if m.startswith('symrot.')])").split()
    assert loaded == []


@pytest.mark.parametrize("name", sorted(set(symrot.__all__) - {"__version__"}))
def test_every_public_name_is_there_and_documented(name):
    value = getattr(symrot, name)
    assert isinstance(value, tuple) or value.__doc__


def test_a_name_that_is_not_there_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = symrot.nothing


@pytest.fixture(scope="module")
def unpacked_wheel(tmp_path_factory):
    """The wheel, unpacked outside the source tree."""
    directory = tmp_path_factory.mktemp("wheel")
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
        str(ROOT),
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
        for suffix in ("py", "toml", "c", "h", "typed")
        for path in PACKAGE.rglob(f"*.{suffix}")
    }
    assert wanted <= held
    assert not any(name.startswith("tests") for name in held)


def test_a_warm_run_imports_nothing_it_can_do_without(tmp_path):
    """A start costs what it imports: neither OpenSSL nor archives nor the commands that were not asked for."""
    spared = (
        "sympy",
        "scipy",
        "matplotlib",
        "hashlib",
        "_hashlib",
        "shutil",
        "bz2",
        "symrot.bench",
        "symrot.report.box",
    )
    code = (
        "import sys, io; from symrot.cli import main; sys.stdout = io.StringIO(); main(['run', 'tumbling_prism']); "
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
    """One parser for a known command; the names of all for `--help` and for what is no command."""
    lines = run("from symrot.cli import COMMANDS, _parser; print(_parser('run').format_help(), *COMMANDS)")
    assert "propagate a scene" in lines and "bench" in lines
    done = subprocess.run([sys.executable, "-m", "symrot", "--help"], capture_output=True, text=True)
    assert all(name in done.stdout for name in ("run", "certify", "bench", "doctor"))
    done = subprocess.run([sys.executable, "-m", "symrot", "run", "--help"], capture_output=True, text=True)
    assert "usage: symrot run" in done.stdout and "--tolerance" in done.stdout
