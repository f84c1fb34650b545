"""Long motions tell how much of the whole span they have followed; the line on a terminal stays one line."""

import os
import sys

import pytest

import symrot
from symrot.cli import output as cli_output
from symrot.propagation.progress import reporting
from symrot.scene.scene import Scene
from tests.needs import needs_compiler

FORMULAS = {
    "smooth": "sin(t)/10 - omega_3/1000000",
    "pulses": "where(mod(t, 1) < 1/100, k, 0)",
    "friction": "sin(t/3) - k*sign(omega_3)/2",
}


def scene(formula, stop):
    torque = {"kind": "expression", "torque": ["0", "0", formula], "parameters": {"k": 1}}
    more = {"body": {"principal": [1, 2, 3]}, "initial": {"omega": [1, 2, 3]}, "span": {"t": [0, stop], "samples": 3}}
    return Scene.from_dict({"schema": 1, "title": "x", "torque": [torque], **more}, "x")


@pytest.mark.thinned(2)
@needs_compiler
@pytest.mark.parametrize(
    ("name", "method"),
    [("smooth", "taylor"), ("smooth", "dop853"), ("smooth", "scipy:DOP853"), ("pulses", "taylor"),
     ("pulses", "dop853"), ("friction", "dop853"), ("friction", "scipy:DOP853")],
)  # fmt: skip
def test_progress_is_of_the_whole_span(name, method):
    """This holds also where the motion goes from switch to switch, or window by window."""
    heard: list[tuple[float, float, float]] = []
    stop = 30000 if name == "smooth" and method != "scipy:DOP853" else 3 if name == "friction" else 30
    with reporting(lambda *given: heard.append(given)):
        symrot.propagate(scene(FORMULAS[name], stop), method=method, tolerance=1e-9)
    assert heard and {(start, end) for _, start, end in heard} == {(0.0, float(stop))}
    parts = [t / stop for t, _, _ in heard]
    assert 0 <= min(parts) < 0.2 and 0.7 < max(parts) <= 1


@needs_compiler
def test_progress_of_a_table_is_not_of_the_part_up_to_the_next_switching_time():
    heard: list[float] = []
    table = {"kind": "table", "t": [0, 5, 5, 30000], "moment": [[0, 0, 0]] * 4, "switching_times": [5]}
    more = {"body": {"principal": [1, 2, 3]}, "initial": {"omega": [1, 2, 3]}, "span": {"t": [0, 30000], "samples": 3}}
    propagator = symrot.propagator(Scene.from_dict({"schema": 1, "title": "x", "torque": [table], **more}, "x"))
    with reporting(lambda t, start, stop: heard.append(stop)):
        propagator()
    assert heard and set(heard) == {30000.0}


class Terminal:
    def __init__(self):
        self.text = ""

    def isatty(self):
        return True

    def fileno(self):
        return 2

    def write(self, text):
        self.text += text

    def flush(self):
        pass


def test_a_line_of_progress_is_cut_to_the_width_of_the_terminal(monkeypatch):
    """A longer line would wrap, and the next line would not clear the rest."""
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(os, "get_terminal_size", lambda number: os.terminal_size((40, 24)))
    cli_output.progress("reference: " + "long " * 30)
    cli_output.progress("")
    first, second = terminal.text.split("\r\x1b[K")[1:]
    assert len(first) == 39 and second == ""


def test_a_terminal_that_does_not_know_its_width_shows_the_whole_line(monkeypatch):
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(os, "get_terminal_size", lambda number: os.terminal_size((0, 0)))
    cli_output.progress("1 of 2: deriving poinsot")
    assert terminal.text == "\r\x1b[K1 of 2: deriving poinsot"
