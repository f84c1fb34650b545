"""Ctrl-C ends every command at once with exit code 130, without a traceback, and leaves no process running."""

import contextlib
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import symrot

ROOT = Path(symrot.__file__).parents[1]
SECONDS = 20  # a command that swallows the signal, or waits for another process, takes longer on any machine
AT_ITS_END = 0.3  # s after the signal: a command that ends by itself so soon has printed its result already
KERNELS = [str(path) for path in sorted((ROOT / "generated" / "c").glob("*.cert.json"))[:30]]
INTERRUPTED = (130, -signal.SIGINT)  # a shell shows 130 for both; the second where Python was about to end anyway
COMMANDS = {
    "run": ["run", "tumbling_prism"],
    "derive --all": ["derive", "--all", "-o", "pages"],
    "certify --all": ["certify", "--all"],
    "emit --all": ["emit", "--all", "-o", "emitted"],
    "audit": ["audit", *KERNELS],
    "bench": ["bench", "tumbling_prism", "--quick"],
    "check": ["check", "sin(a+b)*cos(c-d)*exp(a)*tanh(d)/sqrt(1+c**2) == cosh(a)**2*sin(b+c)*tan(d)**3"],
    "textbook": ["check", "--textbook", "all"],
}


@pytest.fixture(autouse=True)
def interrupts_arrive():
    """Let commands see SIGINT although the tests run in the background, where a shell makes processes ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def started(words, folder, **environment):
    """Start a command with its own cache, in its own group of processes."""
    cache = {"SYMROT_CACHE": str(folder / "cache"), "PYTHONPATH": str(ROOT)}
    return subprocess.Popen(
        [sys.executable, "-m", "symrot", *words], cwd=folder, env=os.environ | cache | environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
    )  # fmt: skip


def interrupted(process, to_group):
    """Send SIGINT to the whole group, as a terminal does, or to the first process only; return the output."""
    (os.killpg if to_group else os.kill)(process.pid, signal.SIGINT)
    try:
        _, err = process.communicate(timeout=SECONDS)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        pytest.fail("the command went on")
    return err


def left_over(folder):
    return [path for path in folder.rglob("*") if path.name.startswith(".symrot-") or path.suffix == ".part"]


WAYS = ["group", "alone"]


@pytest.mark.thinned(2)
@pytest.mark.parametrize(
    ("command", "to_group"),
    [
        pytest.param(
            command, way == "group", id=f"{command}-{way}",
            marks=[] if way == WAYS[place % 2] else pytest.mark.campaign,
        )
        for place, command in enumerate(COMMANDS)
        for way in WAYS
    ],
)  # fmt: skip
def test_a_command_ends_when_it_is_interrupted(command, to_group, tmp_path):
    process = started(COMMANDS[command], tmp_path)
    time.sleep(random.uniform(0.2, 0.9))  # at any time: the test holds for all of them
    if process.poll() is not None:
        process.communicate()
        pytest.skip("it was done before")
    sent = time.monotonic()
    assert interrupted(process, to_group) == ""
    if process.returncode == 0 and time.monotonic() - sent < AT_ITS_END:
        pytest.skip("it was done when the signal arrived")
    assert process.returncode in INTERRUPTED
    with pytest.raises(ProcessLookupError):
        for _ in range(100):  # a process that was killed may still have to be collected
            os.killpg(process.pid, 0)
            time.sleep(0.05)
    if command not in ("emit --all", "certify --all", "audit"):  # those kill processes that write
        assert left_over(tmp_path) == []


def test_an_import_that_is_interrupted_ends_quietly(monkeypatch, capsys):
    from symrot import __main__
    from symrot.cli import main as cli

    def interrupt():
        raise KeyboardInterrupt

    monkeypatch.setattr(cli, "main", interrupt)
    assert __main__.main() == 130 and capsys.readouterr() == ("", "")


@pytest.mark.parametrize("place", ["import", "command"])
def test_an_interrupt_that_a_library_replaces_by_its_own_error_ends_quietly(place, monkeypatch, capsys):
    """As NumPy does it, whose C code imports a module of Python: the KeyboardInterrupt leaves no trace."""
    from symrot import __main__
    from symrot.cli import main as cli

    def library(*_):
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        raise ImportError("could not import module")

    monkeypatch.setattr(cli, "main" if place == "import" else "_check_command", library)
    monkeypatch.setattr(cli.sys, "argv", ["symrot", "run"])
    assert __main__.main() == 130 and capsys.readouterr() == ("", "")


def test_an_error_without_an_interrupt_is_raised(monkeypatch):
    from symrot import __main__
    from symrot.cli import main as cli

    def library(*_):
        raise ImportError("could not import module")

    monkeypatch.setattr(cli, "_check_command", library)
    monkeypatch.setattr(cli.sys, "argv", ["symrot", "run"])
    with pytest.raises(ImportError):
        __main__.main()


@pytest.mark.parametrize("to_group", [True, pytest.param(False, marks=pytest.mark.campaign)], ids=["group", "alone"])
def test_a_hanging_compiler_is_killed(to_group, tmp_path):
    compiler = tmp_path / "cc"
    compiler.write_text(f"#!/bin/sh\necho $$ >> {tmp_path}/pids\nsleep 100\n")
    compiler.chmod(0o755)
    process = started(["run", "tumbling_prism"], tmp_path, CC=str(compiler))
    pids = tmp_path / "pids"
    while process.poll() is None and not pids.exists():
        time.sleep(0.01)
    time.sleep(random.uniform(0, 1))
    assert interrupted(process, to_group) == "" and process.returncode in INTERRUPTED
    for pid in map(int, pids.read_text().split()):
        with pytest.raises(ProcessLookupError):
            for _ in range(100):
                os.killpg(pid, 0)
                time.sleep(0.05)


LOST = """
import os, signal, threading, time, weakref
from symrot import __main__
from symrot.cli import main as cli

class Thing:
    pass

def command():
    thing = Thing()
    reference = weakref.ref(thing, lambda dead: (os.kill(os.getpid(), signal.SIGINT), time.sleep(0)))
    del thing  # Python discards the KeyboardInterrupt of the callback
    lock = threading.Lock()
    for _ in range(2):
        lock.acquire(timeout=30)  # only a signal ends the second one
    return 0

cli.main = command
raise SystemExit(__main__.main())
"""


def test_an_interrupt_that_python_discards_is_raised_again():
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    run = subprocess.run([sys.executable, "-c", LOST], capture_output=True, text=True, env=environment, timeout=60)
    assert (run.returncode, run.stdout, run.stderr) == (130, "", "")


def test_other_discarded_exceptions_are_reported_as_before():
    program = (
        "from symrot.cli.interrupt import repeat_lost_interrupts\n"
        "repeat_lost_interrupts()\n"
        "class Thing:\n"
        "    def __del__(self):\n"
        "        raise ArithmeticError('lost')\n"
        "thing = Thing()\n"
        "del thing\n"
    )
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment, timeout=60)
    assert run.returncode == 0 and "ArithmeticError: lost" in run.stderr
