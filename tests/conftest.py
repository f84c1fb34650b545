"""Fixtures of all tests: a common cache of compiled kernels, the order of the tests, and a check of mpmath's precision."""

import gc
import os
import shlex
import shutil
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from importlib import import_module
from itertools import chain
from pathlib import Path
from typing import Any

import pytest
from _pytest.runner import runtestprotocol
from mpmath import mp

from symrot.build import cache as library

os.environ.setdefault("SYMPY_CACHE_SIZE", "100000")  # results of SymPy in memory, for derivations that repeat them
os.environ.pop(
    "PYTHONDONTWRITEBYTECODE", None
)  # the tests start hundreds of processes: each would compile symrot again
sys.dont_write_bytecode = False

QUICK_COMPILER = """#!/bin/sh
case " $* " in
*" -ffp-contract=fast "*) text=$(cat) ;;
*) exec {command} "$@" ;;
esac
case $text in
*"long double"*) ;;  # tcc loses digits of it
*) printf '%s\\n' "$text" | {tcc} "$@" 2>/dev/null && exit ;;
esac
printf '%s\\n' "$text" | {command} "$@" -O0
"""


@pytest.hookimpl(optionalhook=True, tryfirst=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give each process a run of neighbouring tests, so that one process derives and compiles what a module needs.

    A process that has finished takes over the last part of another process's run. ``--dist`` chooses another scheduler.
    """
    if config.getoption("dist") != "load":
        return None
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)


@pytest.hookimpl(wrapper=True)
def pytest_collection(session: pytest.Session) -> Iterator[None]:
    """Collect without the garbage collector; begin at another module in each process.

    In a new clone pytest compiles each module with its assertions rewritten. Processes that all begin at the first
    module would each compile all of them.
    """
    gc.disable()
    process = getattr(session.config, "workerinput", None)
    if process is not None:
        import_test_modules(session.config.args, int(process["workerid"].removeprefix("gw")), process["workercount"])
    result = yield
    gc.enable()
    return result


def import_test_modules(folders: list[str], process: int, processes: int) -> None:
    """Import the test modules of ``folders``, in an order that begins at the share of ``process``."""
    root = Path(__file__).parents[1]
    modules = sorted(path for folder in folders for path in Path(folder).rglob("test_*.py"))
    begin = len(modules) * process // processes
    for path in modules[begin:] + modules[:begin]:
        with suppress(Exception, pytest.skip.Exception):  # pytest reports it when it collects the module
            import_module(".".join(path.resolve().relative_to(root).with_suffix("").parts))


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave most cases of tests marked ``thinned(n)`` to ``pytest -m campaign``; put modules marked ``first`` first.

    Every n-th case stays, and as many more as are needed for each value of each parameter to stay. A module at the end
    may be divided between two processes, and each would then make its fixtures.
    """
    forgo_constants_of_modules()
    items.sort(key=lambda item: item.get_closest_marker("first") is None)
    functions: dict[str, list[Any]] = {}
    for item in items:
        if item.get_closest_marker("thinned") and not item.get_closest_marker("campaign"):
            functions.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for cases in functions.values():
        every = cases[0].get_closest_marker("thinned").args[0]
        values = [{(name, id(value)) for name, value in case.callspec.params.items()} for case in cases]
        shared = {value for value, count in Counter(chain(*values)).items() if count > 1}
        seen = set().union(*values[::every])
        for number, (case, own) in enumerate(zip(cases, values, strict=True)):
            if number % every and (own & shared) <= seen:
                case.add_marker("campaign")
            seen |= own if case.get_closest_marker("campaign") is None else set()


def forgo_constants_of_modules() -> None:
    """Keep Hypothesis from parsing all modules for constants to draw: it takes 2.4 s in each process of a new clone."""
    providers: Any = sys.modules.get("hypothesis.internal.conjecture.providers")
    constants = getattr(providers, "_local_constants", None)
    if constants is not None:
        providers._get_local_constants = lambda: constants


def pytest_collection_finish() -> None:
    """Keep the garbage collector from visiting all modules and tests again and again while SymPy derives."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool | None:
    """Report a test to xdist once, not also its set-up and tear-down if these pass: ten thousand tests take 5 s less.

    They are reported too if ``--durations`` or ``--junit-xml`` asks for their times.
    """
    option = item.config.option
    if not hasattr(item.config, "workerinput") or option.durations is not None or option.xmlpath:
        return None
    hook, place = item.ihook, {"nodeid": item.nodeid, "location": item.location}
    hook.pytest_runtest_logstart(**place)
    for report in runtestprotocol(item, log=False, nextitem=nextitem):
        if report.when == "call" or not report.passed:
            hook.pytest_runtest_logreport(report=report)
    hook.pytest_runtest_logfinish(**place)
    return True


@pytest.fixture(scope="session")
def shared_directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a directory that all processes of this session share."""
    own = tmp_path_factory.getbasetemp()
    shared = own.parent if "PYTEST_XDIST_WORKER" in os.environ else own
    directory = shared / "shared"
    directory.mkdir(mode=0o700, exist_ok=True)
    return directory


@pytest.fixture(scope="session", autouse=True)
def session_cache(shared_directory: Path) -> Iterator[None]:
    """Point SYMROT_CACHE at one directory of this session, for all its processes and the processes that they start."""
    before = os.environ.get("SYMROT_CACHE")
    os.environ["SYMROT_CACHE"] = str(shared_directory / "cache")
    yield
    if before is None:
        del os.environ["SYMROT_CACHE"]
    else:
        os.environ["SYMROT_CACHE"] = before


@pytest.fixture(scope="session")
def quick_compiler_words(shared_directory: Path) -> str | None:
    """Return a compiler command that compiles the kernels of scenes in little time, or None if there is no compiler.

    With tcc it takes 1 % of the time of -O2, with -O0 25 %. Closed forms (-ffp-contract=off), which all tests load, are
    compiled as usual.
    """
    if library.missing() or os.name != "posix":
        return None
    command = " ".join(map(shlex.quote, library.compiler().command))
    tcc = shutil.which("tcc") or "false"  # "false" fails like a tcc that does not know a word of GNU C
    script = shared_directory / "quick_cc"
    own = shared_directory / f"quick_cc.{os.getpid()}"
    own.write_text(QUICK_COMPILER.format(command=command, tcc=shlex.quote(tcc)))
    own.chmod(0o755)
    with suppress(FileExistsError):  # another process was first
        script.hardlink_to(own)
    own.unlink()
    return str(script)


@pytest.fixture
def quick_compiler(
    request: pytest.FixtureRequest, quick_compiler_words: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Compile quickly for a test of motions and messages; tests of speed and bits use the normal flags.

    In a module of such tests, the mark ``shipped_flags`` keeps the normal flags: for a test that computes for seconds,
    or whose digits need them.
    """
    if quick_compiler_words is not None and request.node.get_closest_marker("shipped_flags") is None:
        monkeypatch.setenv("CC", quick_compiler_words)


@pytest.fixture(autouse=True)
def precision_is_left_alone() -> Iterator[None]:
    """Fail a test if it, or the code under test, leaves mpmath's global precision changed: results would depend on
    order.
    """
    before = mp.prec
    yield
    after, mp.prec = mp.prec, before
    assert after == before, f"mpmath was left at {after} bits, it began with {before}"
