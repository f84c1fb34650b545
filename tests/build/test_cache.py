"""Laws of the kernel cache: compiled kernels are stored, loaded again, and checked before they are used."""

import ctypes
import errno
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

from symrot.build import cache as library
from symrot.build import compiler as compiler_run
from symrot.build import directories
from symrot.errors import CompilerError

SOURCE = "double answer(void) { return 42.0; }\n"


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    """Give every test its own cache, and no temporary directory of another test."""
    monkeypatch.setenv("SYMROT_CACHE", str(tmp_path / "cache"))
    temporary = library.Temporary()
    monkeypatch.setattr(library, "_temporary", temporary)
    yield tmp_path / "cache" / "kernels"
    if temporary.path is not None:
        shutil.rmtree(temporary.path, ignore_errors=True)


@pytest.fixture
def no_compiling(monkeypatch):
    """Make the test fail if any program is run."""

    def refuse(*arguments, **options):
        raise AssertionError("a program was run")

    return lambda: monkeypatch.setattr(compiler_run, "Popen", refuse)


def answer(path):
    """Return the number that a library computes; a copy of the file is loaded, because the loader caches libraries by
    name.
    """
    copy = path.with_name(f"loaded-{os.urandom(4).hex()}")
    shutil.copy(path, copy)
    function = ctypes.CDLL(str(copy)).answer
    copy.unlink()
    function.restype = ctypes.c_double
    return function()


def fake_compiler(tmp_path, script, name="fakecc"):
    path = tmp_path / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


def test_a_library_is_built_once(own_cache, no_compiling):
    path = library.build(SOURCE, "answer")
    assert path.parent == own_cache
    assert path.name.startswith("answer-")
    assert answer(path) == 42.0
    no_compiling()
    assert library.build(SOURCE, "answer") == path


@pytest.mark.parametrize(
    "change",
    ["source", "flags", "compiler", "compiler arguments", "processor"],
    ids=lambda text: text.replace(" ", "-"),
)
def test_whatever_shapes_a_library_is_in_its_key(change, tmp_path, monkeypatch, no_compiling):
    tool = fake_compiler(tmp_path, 'exec cc "$@"')
    monkeypatch.setenv("CC", str(tool))
    library.build(SOURCE, "answer")
    source, flags = SOURCE, library.FLAGS
    if change == "source":
        source += "\n"
    elif change == "flags":
        flags = (*flags, "-O1")
    elif change == "compiler":
        os.utime(tool, ns=(0, 0))
    elif change == "compiler arguments":
        monkeypatch.setenv("CC", f"{tool} -g0")
    else:
        monkeypatch.setattr(library, "_processor", lambda: "another one")
    no_compiling()
    with pytest.raises(AssertionError, match="a program was run"):
        library.build(source, "answer", flags)


def test_the_processor_does_not_matter_without_native_flags(monkeypatch, no_compiling):
    flags = tuple(flag for flag in library.FLAGS if flag != library.NATIVE)
    path = library.build(SOURCE, "answer", flags)
    monkeypatch.setattr(library, "_processor", lambda: "another one")
    no_compiling()
    assert library.build(SOURCE, "answer", flags) == path


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.write_bytes(b""),
        lambda path: path.write_bytes(path.read_bytes()[:-1]),
        lambda path: path.write_bytes(path.read_bytes()[:2000]),
        lambda path: path.write_bytes(path.read_bytes().replace(b"answer", b"enswer")),
        lambda path: path.unlink(),
        lambda path: next(path.parent.glob("*.index")).write_bytes(b""),
        lambda path: next(path.parent.glob("*.index")).write_bytes(b"../../../../bin/sh"),
        lambda path: next(path.parent.glob("*.index")).write_bytes(b"\xff\x00" * 40),
    ],
    ids=["empty", "short", "torn", "altered", "gone", "empty index", "foreign index", "binary index"],
)
def test_a_damaged_entry_is_built_anew(damage):
    path = library.build(SOURCE, "answer")
    sound = path.read_bytes()
    damage(path)
    again = library.build(SOURCE, "answer")
    assert again.read_bytes() == sound
    assert answer(again) == 42.0


def test_processes_that_build_at_once_do_not_disturb_each_other(own_cache):
    """Eight processes build at once, twice; each loads what it built, and no partial file remains."""
    program = (
        "import ctypes, sys; from symrot.build import cache as library\n"
        "for number in range(2):\n"
        "    path = library.build(f'double answer(void) {{ return {number}.5; }}', 'answer')\n"
        "    function = ctypes.CDLL(str(path)).answer; function.restype = ctypes.c_double\n"
        "    assert function() == number + 0.5\n"
        "    assert path.parent.parent.name == 'cache', path\n"
    )
    command = [sys.executable, "-c", program]
    running = [subprocess.Popen(command, stderr=subprocess.PIPE, text=True) for _ in range(8)]
    for process in running:
        _, complaint = process.communicate(timeout=120)
        assert process.returncode == 0, complaint
    names = sorted(path.name for path in own_cache.iterdir())
    assert not [name for name in names if name.startswith(".")]
    assert len([name for name in names if name.endswith(".index")]) == 2


# ------------------------------------------------------------------------------------------------ the compiler


def test_a_refused_source_quotes_the_first_complaint():
    with pytest.raises(CompilerError, match=r"fails on the kernel 'wrong': <stdin>:2:\d+: error: ") as caught:
        library.build("double answer(void)\n{ return nothing; }\n", "wrong")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("chosen", ["no-such-compiler", "/nowhere/cc -O3"])
def test_a_missing_compiler_names_the_variable(chosen, monkeypatch):
    monkeypatch.setenv("CC", chosen)
    with pytest.raises(CompilerError, match=f"CC='{chosen}' names no program; set CC"):
        library.build(SOURCE, "answer")


def test_an_empty_path_names_the_variable_too(monkeypatch, tmp_path):
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(CompilerError, match="none of cc, gcc, clang is on the path; set CC to one"):
        library.compiler()


def test_the_compiler_may_have_arguments_or_a_blank_in_its_name(monkeypatch, tmp_path):
    plain, spaced = fake_compiler(tmp_path, 'exec cc "$@"'), fake_compiler(tmp_path, 'exec cc "$@"', "c c")
    for chosen, command in ((f"{plain} -g0", (str(plain), "-g0")), (str(spaced), (str(spaced),))):
        monkeypatch.setenv("CC", chosen)
        assert library.compiler().command == command
        assert answer(library.build(SOURCE, "answer")) == 42.0


@pytest.mark.parametrize(
    "script, sentence",
    [
        ("exit 3", "exit status 3, no message"),
        ("exit 0", "no library was written"),
        ("echo first >&2; echo second >&2; exit 1", "fails on the kernel 'answer': first"),
        ("echo note >&2; echo 'x: error: bad' >&2; exit 1", "fails on the kernel 'answer': x: error: bad"),
        ("printf '\\377\\376' >&2; exit 1", "fails on the kernel 'answer': "),
    ],
)
def test_a_failing_compiler_is_one_sentence(script, sentence, monkeypatch, tmp_path):
    monkeypatch.setenv("CC", str(fake_compiler(tmp_path, script)))
    with pytest.raises(CompilerError, match=sentence):
        library.build(SOURCE, "answer")


def test_a_program_that_is_no_program_is_one_sentence(monkeypatch, tmp_path):
    path = tmp_path / "cc"
    path.write_bytes(b"\x7fELF")
    path.chmod(0o755)
    monkeypatch.setenv("CC", str(path))
    with pytest.raises(CompilerError, match="it cannot be run: "):
        library.build(SOURCE, "answer")


def test_a_hanging_compiler_is_given_up(monkeypatch, tmp_path):
    monkeypatch.setenv("CC", str(fake_compiler(tmp_path, "exec sleep 60")))
    monkeypatch.setattr(library, "SECONDS_TO_COMPILE", 0.2)
    with pytest.raises(CompilerError, match=r"did not end within 0\.2 s"):
        library.build(SOURCE, "answer")


def ended(process: int, within: float) -> bool:
    """Return whether a process ends, or is a zombie, within some seconds; a killed process still runs until it is
    scheduled.
    """
    limit = monotonic() + within
    while monotonic() < limit:
        try:
            state = Path(f"/proc/{process}/stat").read_text().split()[2]
        except (FileNotFoundError, ProcessLookupError):
            return True
        if state == "Z":
            return True
        sleep(0.01)
    return False


def test_what_a_hanging_compiler_started_is_stopped_too(monkeypatch, tmp_path):
    """Otherwise the output stays open and its reader waits for ever; the compiler is asked once, not once per set of
    flags.
    """
    script = f"echo asked >> {tmp_path}/asked\nsleep 60 &\necho $! > {tmp_path}/child\nsleep 60"
    monkeypatch.setenv("CC", str(fake_compiler(tmp_path, script)))
    monkeypatch.setattr(library, "SECONDS_TO_COMPILE", 0.5)
    with pytest.raises(CompilerError, match=r"did not end within 0\.5 s"):
        library.build(SOURCE, "answer", (*library.FLAGS, *library.TUNING))
    assert (tmp_path / "asked").read_text() == "asked\n"
    assert ended(int((tmp_path / "child").read_text()), within=10)


def test_compilers_can_be_stopped_from_another_thread(monkeypatch, tmp_path):
    monkeypatch.setenv("CC", str(fake_compiler(tmp_path, f"touch {tmp_path}/started; sleep 60")))
    building = library.Building(SOURCE, "answer")
    while not (tmp_path / "started").exists():
        pass
    library.stop_compilers()
    with pytest.raises(CompilerError, match="was killed before it had finished"):
        building.path()


def test_a_compiler_without_native_tuning_is_asked_again_without_it(monkeypatch, tmp_path, no_compiling):
    script = 'case "$*" in *march=native*) echo "error: bad -march" >&2; exit 1;; esac; exec cc "$@"'
    monkeypatch.setenv("CC", str(fake_compiler(tmp_path, script)))
    path = library.build(SOURCE, "answer")
    assert answer(path) == 42.0
    no_compiling()
    assert library.build(SOURCE, "answer") == path


# ------------------------------------------------------------------------------------------------ the cache


def test_the_cache_is_private(own_cache):
    library.build(SOURCE, "answer")
    assert stat.S_IMODE(own_cache.stat().st_mode) == 0o700
    own_cache.chmod(0o777)
    library.build(SOURCE, "answer")
    assert stat.S_IMODE(own_cache.stat().st_mode) == 0o700
    assert library.cache() == (own_cache, "")


def block_parent(room, monkeypatch):
    room.parent.write_text("a file where a directory should be")


def full_disk(room, monkeypatch):
    write = Path.write_bytes

    def refuse(path, content):
        if room in path.parents:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(path, content)

    monkeypatch.setattr(Path, "write_bytes", refuse)


def read_only(room, monkeypatch):
    monkeypatch.setattr(os, "access", lambda path, mode: not (Path(path) == room and mode == os.W_OK))


def another_owner(room, monkeypatch):
    room.mkdir(parents=True)
    mine, look = os.getuid(), Path.lstat

    def lstat(path):
        found = list(look(path))
        if path == room:
            found[stat.ST_UID] = mine + 1
        return os.stat_result(found)

    monkeypatch.setattr(Path, "lstat", lstat)


def symbolic_link(room, monkeypatch):
    room.parent.mkdir()
    (room.parent.parent / "elsewhere").mkdir()
    room.symlink_to(room.parent.parent / "elsewhere")


def open_parent(room, monkeypatch):
    room.mkdir(parents=True)
    room.parent.chmod(0o777)


def open_grandparent(room, monkeypatch):
    room.mkdir(parents=True)
    room.parents[1].chmod(0o707)


def shared_by_a_group(room, monkeypatch):
    room.mkdir(parents=True)
    room.parent.chmod(0o770)
    monkeypatch.setattr(directories, "_shared_group", lambda group: True)


def foreign_parent(room, monkeypatch):
    room.mkdir(parents=True)
    mine, look = os.getuid(), Path.stat

    def stat_of(path, **options):
        found = list(look(path, **options))
        if path == room.parent:
            found[stat.ST_UID] = mine + 1
        return os.stat_result(found)

    monkeypatch.setattr(Path, "stat", stat_of)


def link_in_an_open_folder(room, monkeypatch):
    """Return a cache path through a link that other users can replace; the link's target is a private folder."""
    private, shared = room.parents[1] / "private", room.parents[1] / "shared"
    private.mkdir()
    shared.mkdir()
    shared.chmod(0o777)
    (shared / "link").symlink_to(private)
    monkeypatch.setenv("SYMROT_CACHE", str(shared / "link"))


def link_into_an_open_folder(room, monkeypatch):
    shared = room.parents[1] / "shared"
    (shared / "mine" / "kernels").mkdir(parents=True)
    shared.chmod(0o777)
    room.parent.symlink_to(shared / "mine")


@pytest.mark.parametrize(
    "trouble, reason",
    [
        (open_parent, "cache can be written by other users"),
        (open_grandparent, "can be written by other users, who could replace"),
        (shared_by_a_group, "cache can be written by other users"),
        (foreign_parent, "cache belongs to another user"),
        (link_in_an_open_folder, "shared can be written by other users"),
        (link_into_an_open_folder, "shared can be written by other users"),
        (block_parent, "cannot be used"),
        (full_disk, "No space left on device"),
        (read_only, "cannot be written"),
        (another_owner, "belongs to another user"),
        (symbolic_link, "is a symbolic link"),
    ],
)
def test_an_unusable_cache_is_replaced_for_this_process(trouble, reason, own_cache, monkeypatch, no_compiling):
    trouble(own_cache, monkeypatch)
    path = library.build(SOURCE, "answer")
    assert answer(path) == 42.0
    assert own_cache not in path.parents
    assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700
    library.store("key", "{}")
    assert library.fetch("key") == "{}"
    assert library.cache() == (path.parent, library.cache().reason)
    assert reason in library.cache().reason
    no_compiling()
    assert library.build(SOURCE, "answer") == path


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="the system has no owners of files")
def test_a_cache_in_a_sticky_folder_is_used(own_cache, tmp_path):
    """In a folder like /tmp only the owner of a file can rename it."""
    own_cache.mkdir(parents=True)
    tmp_path.chmod(0o1777)
    assert library.cache() == (own_cache, "")


def test_the_folders_of_a_new_cache_are_private(own_cache, monkeypatch, tmp_path):
    """They are private whatever the umask of the process is."""
    before = os.umask(0)
    try:
        monkeypatch.setenv("SYMROT_CACHE", str(tmp_path / "a" / "b"))
        assert library.cache() == (tmp_path / "a" / "b" / "kernels", "")
    finally:
        os.umask(before)


def test_a_pipe_in_the_cache_is_no_entry(own_cache):
    library.store("key", "{}")
    (entry,) = own_cache.iterdir()
    entry.unlink()
    os.mkfifo(entry)
    assert library.fetch("key") is None  # and does not wait for a writer


def test_a_probe_finds_a_full_disk(own_cache, monkeypatch):
    assert library.cache(probe=True) == (own_cache, "")
    full_disk(own_cache, monkeypatch)
    assert library.cache().reason == ""
    assert "No space left on device" in library.cache(probe=True).reason


def test_the_temporary_directory_goes_with_the_process(tmp_path):
    (tmp_path / "cache").write_text("")
    program = f"from symrot.build import cache as library; print(library.build({SOURCE!r}, 'answer'))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert not Path(done.stdout.strip()).parent.exists()


def test_no_room_anywhere_is_one_sentence(monkeypatch):
    def refuse(path, content):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", refuse)
    with pytest.raises(CompilerError, match=r"need space on a disk: .*No space left"):
        library.build(SOURCE, "answer")
    library.store("key", "{}")
    assert library.fetch("key") == "{}"


def test_clear_removes_what_is_ours_and_nothing_else(own_cache, tmp_path):
    path = library.build(SOURCE, "answer")
    library.store("key", "{}")
    victim = tmp_path / "victim"
    victim.write_text("not ours")
    strangers = [own_cache / name for name in ("thesis.tex", "answer.so", "answer-0.so", f"x-{'0' * 32}.so.bak")]
    for stranger in strangers:
        stranger.write_text("not ours")
    link = own_cache / f"link-{'0' * 32}.so"
    link.symlink_to(victim)
    directory = own_cache / f"directory-{'0' * 32}.so"
    directory.mkdir()
    removed = library.clear()
    assert path in removed
    assert len(removed) == 3
    assert sorted(own_cache.iterdir()) == sorted([*strangers, link, directory])
    assert victim.read_text() == "not ours"
    assert library.clear() == ()
    assert library.fetch("key") is None
    assert answer(library.build(SOURCE, "answer")) == 42.0


def test_texts_are_kept_by_key(own_cache):
    assert library.fetch("a") is None
    library.store("a", '{"x": "é\\n"}')
    library.store("b", "")
    assert library.fetch("a") == '{"x": "é\\n"}'
    assert library.fetch("b") == ""
    library.store("a", "new")
    assert library.fetch("a") == "new"
    for path in own_cache.iterdir():
        path.write_bytes(path.read_bytes()[:-1] + b"?")
    assert library.fetch("a") is None
    assert library.fetch("b") is None


@pytest.mark.parametrize(
    "variables, place",
    [
        ({"SYMROT_CACHE": "one", "XDG_CACHE_HOME": "two"}, "one/kernels"),
        ({"XDG_CACHE_HOME": "two"}, "two/symrot/kernels"),
        ({"HOME": "three"}, "three/.cache/symrot/kernels"),
    ],
)
@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="another place there")
def test_the_place_of_the_cache(variables, place, monkeypatch, tmp_path):
    for name in ("SYMROT_CACHE", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, str(tmp_path / value))
    assert library.cache() == (tmp_path / place, "")


def test_no_array_or_algebra_package_is_imported():
    program = (
        "import sys; from symrot.build import cache as library; library.build('int x;', 'x'); library.fetch('y')\n"
        "print(sorted({'numpy', 'scipy', 'sympy'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_user_without_a_home_directory_gets_a_temporary_cache(monkeypatch):
    """As in a container whose user has neither HOME nor an entry in the list of users."""

    def unknown(path):
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("SYMROT_CACHE")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(directories.Path, "expanduser", unknown)
    assert answer(library.build(SOURCE, "homeless")) == 42.0
    assert "SYMROT_CACHE" in library.cache().reason
