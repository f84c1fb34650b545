"""Every scene that cannot be used is refused in one clear sentence, quickly."""

import time
from pathlib import Path

import pytest
from bad_scenes import GOOD, PARTS, SHAPE, TOP, bad_scenes, base_scene

from symrot.errors import InputError
from symrot.scene import Scene, load_scene

BAD = bad_scenes()


def test_the_scenes_that_the_faults_are_put_into_are_good(tmp_path):
    """Else every test below could pass for a wrong reason."""
    path = tmp_path / "good.toml"
    for body in (None, SHAPE, TOP, PARTS):
        path.write_text(GOOD if body is None else base_scene(body=body))
        assert load_scene(path).name == "good"


@pytest.mark.parametrize(("content", "words"), [entry[1:] for entry in BAD], ids=[entry[0] for entry in BAD])
def test_a_bad_scene_gets_one_sentence(tmp_path, content, words):
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    start = time.perf_counter()
    with pytest.raises(InputError) as error:
        load_scene(path)
    seconds = time.perf_counter() - start
    said = str(error.value)
    assert type(error.value) is InputError
    assert said.startswith(f"{path}: ") and "expected" in said
    assert "\n" not in said and len(said.removeprefix(str(path))) < 500
    for word in words:
        assert word in said
    assert seconds < 2  # none of them may be computed at length; a generous bound for a loaded machine


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("tumbling_prsim", ("tumbling_prsim", "did you mean 'tumbling_prism'?", "earth_wobble")),
        ("", ("expected the name of a scene",)),
        ("no/such/tumbling_prism.toml", ("no/such/tumbling_prism.toml", "there is none")),
        ("a\0b", ("expected the name of a scene",)),
        ("x" * 5000, ("expected",)),
        (str(Path(__file__).parent), ("folder",)),
        (None, ("expected the name of a scene", "None")),
    ],
)
def test_a_scene_that_is_not_there_is_named(source, words):
    with pytest.raises(InputError) as error:
        load_scene(source)
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize("content", [None, [], "schema = 1", 3, {}, {"schema": 1}, {1: 2}])
def test_a_dict_is_read_as_strictly_as_a_file(content):
    with pytest.raises(InputError, match=r"^mine: .*expected"):
        Scene.from_dict(content, "mine")
