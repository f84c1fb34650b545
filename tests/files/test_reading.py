"""A pipe, device, folder, socket or endless file in place of any input file is refused in one sentence."""

import json
import os
import shutil
import signal
import socket
from pathlib import Path

import pytest

import symrot
from symrot.cli import main as cli
from symrot.errors import InputError
from symrot.files.reading import read_input
from tests.bad_scenes import GOOD

SECONDS = 20  # only a read that blocks takes longer: nothing here computes at length
CSV = "t, M1, M2, M3\n0, 0, 0, 0\n5, 1, 0, 0\n10, 0, 0, 0\n"
GENERATED = Path(symrot.__file__).parents[1] / "generated" / "c"
KERNEL = "euler_zyx_dcm"


@pytest.fixture(autouse=True)
def no_endless_wait():
    """Raise TimeoutError in a test whose read blocks, so that the test does not wait for ever."""

    def stop(*_):
        raise TimeoutError("blocked")

    before = signal.signal(signal.SIGALRM, stop)
    signal.alarm(SECONDS)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def _pipe(path):
    os.mkfifo(path)


def _socket(path):
    with socket.socket(socket.AF_UNIX) as made:
        here = Path.cwd()
        os.chdir(path.parent)  # the path of a socket has at most 108 bytes
        made.bind(path.name)
        os.chdir(here)


def _huge(path):
    with path.open("wb") as stream:
        stream.truncate(1 << 40)  # a hole: no disk holds it


SPECIAL = {
    "pipe": (_pipe, "a pipe"),
    "folder": (Path.mkdir, "a folder"),
    "socket": (_socket, "a socket"),
    "endless": (lambda path: path.symlink_to("/dev/zero"), "a device"),
    "terabyte": (_huge, "a larger one"),
    "circle": (lambda path: path.symlink_to(path.name), "symbolic links"),
}


@pytest.fixture(params=SPECIAL)
def special(request, tmp_path):
    """Return a function that creates a special file at a path, and the words that the message must contain."""
    make, said = SPECIAL[request.param]
    return make, said


def refusal(capsys, *words):
    code = cli.main([str(word) for word in words])
    out, err = capsys.readouterr()
    assert (code, out) == (2, "")
    assert err.startswith("symrot: ") and err.count("\n") == 1 and len(err) < 600
    return err


def test_a_special_file_is_no_input(special, tmp_path):
    make, said = special
    make(tmp_path / "given")
    with pytest.raises(OSError) as refused:
        read_input(tmp_path / "given", 1000)
    assert said in str(refused.value.strerror)


def test_an_input_may_be_as_large_as_allowed(tmp_path):
    path = tmp_path / "given"
    path.write_bytes(b"x" * 1000)
    assert read_input(path, 1000) == b"x" * 1000
    with pytest.raises(OSError, match="a larger one"):
        read_input(path, 999)


COMMANDS = {
    "run": ("run", "{}.toml"),
    "explain": ("explain", "{}.toml"),
    "emit": ("emit", "{}.toml"),
    "bench": ("bench", "{}.toml"),
    "check": ("check", "{}.toml"),
    "audit": ("audit", "{}.cert.json"),
    "certify": ("certify", "{}.toml"),
    "certify a certificate": ("certify", KERNEL + ".cert.json"),
    "certify a text": ("certify", KERNEL + ".c"),
    "bound": ("bound", "{}.toml"),
    "compare": ("bench", "--compare", "{}.json", "{}.json"),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_special_file_is_no_input_of_a_command(command, special, tmp_path, monkeypatch, capsys):
    make, _ = special
    monkeypatch.chdir(tmp_path)
    words = [word.format("given") for word in COMMANDS[command]]
    make(tmp_path / words[-1])
    assert words[-1] in refusal(capsys, *words)


@pytest.mark.parametrize("end", [".c", ".h", ".cert.json"])
def test_a_special_file_beside_a_certificate_is_refused(end, special, tmp_path, capsys):
    make, _ = special
    for file in (f"{KERNEL}.c", f"{KERNEL}.h", f"{KERNEL}.cert.json", "symrot_math.h"):
        shutil.copy(GENERATED / file, tmp_path)
    (tmp_path / f"{KERNEL}{end}").unlink()
    make(tmp_path / f"{KERNEL}{end}")
    assert cli.main(["audit", str(tmp_path / f"{KERNEL}.cert.json")]) in (1, 2)
    out, err = capsys.readouterr()
    assert KERNEL in err and err.count("\n") == 1 and not out
    if end != ".cert.json":
        from symrot.certificates import recheck

        with pytest.raises((ValueError, OSError)):
            recheck.check(tmp_path / f"{KERNEL}.cert.json")


def test_an_object_that_is_special_is_refused(special, tmp_path, capsys):
    make, said = special
    if said == "a larger one":
        pytest.skip("objdump looks at the start of a file alone")
    make(tmp_path / "given.o")
    code = cli.main(["audit", str(GENERATED / f"{KERNEL}.cert.json"), "--object", str(tmp_path / "given.o")])
    assert code in (1, 2) and capsys.readouterr().err.count("\n") == 1


def test_emitted_files_take_the_place_of_special_ones(tmp_path, capsys):
    """The earlier certificate is read from the folder into which files are written."""
    os.mkfifo(tmp_path / f"{KERNEL}.cert.json")
    assert cli.main(["emit", KERNEL, "--target", "c", "-o", str(tmp_path)]) == 0
    assert json.loads((tmp_path / f"{KERNEL}.cert.json").read_text())["kernel"] == KERNEL


def test_pages_are_not_written_into_a_pipe(tmp_path, monkeypatch, capsys):
    from symrot.workshop import derivation_pages

    monkeypatch.setattr(derivation_pages, "pages", lambda say: {"page.md": "text"})
    os.mkfifo(tmp_path / "page.md")
    os.mkfifo(tmp_path / "other.md")
    (tmp_path / "latin.md").write_bytes(b"\xe9")
    assert "a pipe" in refusal(capsys, "derive", "--all", "-o", tmp_path)


# --- what a scene of a stranger may open --------------------------------------------------------------------------------


def scene_with_table(folder, file):
    path = folder / "scene.toml"
    path.write_text(f"{GOOD}\n[[torque]]\nkind = \"table\"\nfile = '{file}'\n")
    return path


@pytest.fixture
def folders(tmp_path):
    """Return the folder of a scene, and a folder next to it with a table and a secret."""
    here, elsewhere = tmp_path / "here", tmp_path / "elsewhere"
    for folder in (here, here / "below", elsewhere):
        folder.mkdir()
        (folder / "moments.csv").write_text(CSV)
    (elsewhere / "secret").write_text("the password\n")
    return here, elsewhere


@pytest.mark.parametrize("file", ["moments.csv", "below/moments.csv", "below/../moments.csv", "./moments.csv"])
def test_a_table_may_lie_in_the_folder_of_the_scene_or_below(file, folders, monkeypatch):
    here, _ = folders
    assert symrot.load_scene(scene_with_table(here, file)).table.times == (0.0, 5.0, 10.0)
    monkeypatch.chdir(here)
    assert symrot.load_scene("scene.toml").table.times == (0.0, 5.0, 10.0)


@pytest.mark.thinned(3)
@pytest.mark.parametrize("file", ["moments.csv", "secret"])
@pytest.mark.parametrize("way", ["up", "absolute", "link", "linked folder", "up through a link"])
def test_a_table_elsewhere_needs_leave(way, file, folders, capsys):
    here, elsewhere = folders
    name = {
        "up": f"../elsewhere/{file}", "absolute": str(elsewhere / file), "link": "linked.csv",
        "linked folder": f"linked/{file}", "up through a link": f"linked/../elsewhere/{file}",
    }[way]  # fmt: skip
    (here / "linked.csv").symlink_to(elsewhere / file)
    (here / "linked").symlink_to(elsewhere)
    path = scene_with_table(here, name)
    said = refusal(capsys, "run", path)
    assert "a file in the folder of the scene or below it" in said and "--table-folder" in said
    assert "password" not in said
    if file == "moments.csv":
        for allowed in ([elsewhere], (str(elsewhere.parent),), elsewhere):
            assert symrot.load_scene(path, table_folders=allowed).table.times == (0.0, 5.0, 10.0)
        assert cli.main(["run", str(path), "--table-folder", str(here), "--table-folder", str(elsewhere)]) == 0
        assert cli.main(["explain", str(path), "--table-folder", str(elsewhere)]) == 0
        capsys.readouterr()
    else:
        said = refusal(capsys, "run", path, "--table-folder", elsewhere)
        assert "the columns t, M1, M2, M3" in said and "password" not in said


@pytest.mark.parametrize("file", ["below\\\\moments.csv", "..\\\\elsewhere\\\\moments.csv", "C:\\\\moments.csv", " "])
def test_a_table_is_named_as_on_every_machine(file, folders, capsys):
    here, _ = folders
    assert "with / between folders" in refusal(capsys, "run", scene_with_table(here, file.replace("\\\\", "\\")))


def test_a_scene_of_a_dict_names_files_in_the_current_folder(folders, monkeypatch):
    here, elsewhere = folders
    monkeypatch.chdir(here)
    content = {
        "schema": 1, "body": {"principal": [1, 2, 3]}, "initial": {"omega": [0, 1, 0]}, "span": {"t": [0, 10]},
        "torque": [{"kind": "table", "file": str(elsewhere / "moments.csv")}],
    }  # fmt: skip
    with pytest.raises(InputError, match="folder of the scene"):
        symrot.Scene.from_dict(content)
    assert symrot.Scene.from_dict(content, table_folders=elsewhere).table.times == (0.0, 5.0, 10.0)


@pytest.mark.parametrize("folders", [None, 3, [3], b"."])
def test_folders_that_are_no_paths_are_refused(folders):
    for read in (symrot.load_scene, lambda name, **options: symrot.sweep(name, outputs="omega@end", **options)):
        with pytest.raises(InputError, match=r"^table_folders: expected a folder or a list of folders, got "):
            read("t_handle", table_folders=folders)
    with pytest.raises(InputError, match=r"^table_folders: expected a folder or a list of folders, got "):
        symrot.Scene.from_dict(symrot.load_scene("t_handle").to_dict(), table_folders=folders)


@pytest.mark.parametrize("path", [3, b"a.npz"])
def test_a_path_that_is_no_text_is_refused(path):
    trajectory = symrot.propagate("t_handle", t=[0, 1])
    uses = [
        lambda: symrot.save(trajectory, path), lambda: symrot.show(trajectory, path), lambda: symrot.check_file(path),
        lambda: symrot.mesh(path, mass=1), lambda: symrot.links(path),
        lambda: symrot.sweep("t_handle", {"omega_1": "values(1)"}, outputs="omega@end", path=path),
    ]  # fmt: skip
    for use in uses:
        with pytest.raises(InputError, match="expected the path of a file, as a string or Path, got"):
            use()


def test_a_byte_of_a_file_that_is_no_table_is_not_quoted(folders, capsys):
    here, _ = folders
    (here / "moments.csv").write_bytes(b"\xe9secret")
    said = refusal(capsys, "run", scene_with_table(here, "moments.csv"))
    assert "UTF-8" in said and "e9" not in said and "secret" not in said
