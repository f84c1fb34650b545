"""What the shell completes, and what a mistyped word is told."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from symrot.cli.main import COMMANDS, _parser, main
from symrot.errors import nearest, with_hint


def completions(line):
    """Return the words that argcomplete offers after a line."""
    argcomplete = pytest.importorskip("argcomplete")
    from symrot.cli.completion import completers

    parser = _parser("")
    completers(parser)
    finder = argcomplete.CompletionFinder(parser)
    _, prefix, _, words, _ = argcomplete.split_line(line, len(line))
    return [word.strip() for word in finder._get_completions(words, prefix, "", None)]


@pytest.mark.parametrize(("line", "word"), [
    ("symrot ru", "run"), ("symrot run t_h", "t_handle"), ("symrot run t_handle --pl", "--plot"),
    ("symrot run t_handle --method ta", "taylor"), ("symrot derive poin", "poinsot"),
    ("symrot emit euler_zxz_body_r", "euler_zxz_body_rates"), ("symrot exercise heavy", "heavy_tops"),
    ("symrot check --textbook bro", "brown"), ("symrot emit x --target nu", "numpy"),
    ("symrot emit t_handle --step ta", "taylor"), ("symrot sweep t_handle --sampling la", "latin"),
    ("symrot sweep t_handle --statistics per", "percentiles"), ("symrot run t_handle --state zyx", "zyx"),
])  # fmt: skip
def test_a_shell_completes_commands_options_and_names(line, word):
    assert word in completions(line)


def test_a_shell_completes_nothing_that_does_not_fit():
    assert "t_handle" not in completions("symrot run heavy")
    assert completions("symrot run --zzz") == []
    assert set(completions("symrot run t_handle --method ")) == {"auto", "exact", "taylor", "dop853", "scipy"}


@pytest.mark.skipif(shutil.which("bash") is None, reason="needs bash")
def test_bash_completes_the_command_that_is_installed(tmp_path):
    """The line of docs/commands.md completes words at the Tab key: bash then starts symrot without arguments."""
    pytest.importorskip("argcomplete")
    symrot = tmp_path / "symrot"
    symrot.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m symrot "$@"\n', encoding="utf-8")
    symrot.chmod(0o755)
    folders = [str(tmp_path), str(Path(sys.executable).parent), os.environ["PATH"]]
    environment = {**os.environ, "PATH": os.pathsep.join(folders)}
    press_tab = """eval "$(register-python-argcomplete symrot)"
        COMP_LINE="symrot run t_h" COMP_POINT=14 COMP_TYPE=9 COMP_WORDS=(symrot run t_h) COMP_CWORD=2
        _python_argcomplete symrot t_h run; echo "${COMPREPLY[@]}" """
    done = subprocess.run(["bash", "-c", press_tab], capture_output=True, text=True, env=environment, timeout=60)
    assert done.stdout.split() == ["t_handle"]


@pytest.mark.parametrize(("words", "hint"), [
    (["run", "t_handl"], "did you mean 't_handle'? `symrot scenes` lists all"),
    (["run", "t_handle", "--plto", "x.png"], "run: expected an option of `symrot run --help`, got '--plto' (did you mean '--plot'?)"),
    (["run", "t_handle", "more"], "expected no further word of `symrot run --help`, got 'more'"),
    (["run", "t_handle", "--method", "tayler"], "did you mean 'taylor'?"),
    (["derive", "poinso"], "did you mean 'poinsot'? `symrot derive` lists all"),
    (["emit", "quaternion_to_dcm"], "did you mean 'quaternion_of_dcm'?"),
    (["check", "--textbook", "browm"], "did you mean 'brown'?"),
    (["exercise", "heavy_top"], "did you mean 'heavy_tops'?"),
    (["bench", "t_handle", "--methods", "taylr"], "did you mean 'taylor'?"),
    (["sow"], "did you mean 'show'?"),
])  # fmt: skip
def test_a_mistyped_word_is_told_the_nearest_one(words, hint, capsys):
    assert main(words) == 2
    assert hint in capsys.readouterr().err


@pytest.mark.parametrize("word", ["satelite.toml", "satellite", "satellite.tml"])
def test_a_mistyped_scene_file_is_told_the_file_in_its_folder(tmp_path, capsys, word):
    (tmp_path / "satellite.toml").touch()
    assert main(["run", str(tmp_path / word)]) == 2
    assert "(did you mean 'satellite.toml'?)" in capsys.readouterr().err


def test_a_word_like_no_other_gets_no_hint():
    assert nearest("zzzzzz", COMMANDS) == ""
    assert with_hint("expected a command", "zzzzzz", COMMANDS) == "expected a command"
