"""Every scene that cannot be used is refused quickly, in one clear sentence."""

import copy
import random
import time
import tomllib
from decimal import Decimal
from functools import reduce
from operator import getitem
from pathlib import Path

import pytest

from symrot.errors import InputError
from symrot.scene.file import SHIPPED
from symrot.scene.scene import Scene, load_scene
from tests.bad_scenes import GOOD, PARTS, SHAPE, TOP, bad_scenes, base_scene

BAD = bad_scenes()


def test_the_scenes_that_the_faults_are_put_into_are_good(tmp_path):
    """Otherwise the tests below could pass for a wrong reason."""
    path = tmp_path / "good.toml"
    for body in (None, SHAPE, TOP, PARTS):
        path.write_text(GOOD if body is None else base_scene(body=body))
        assert load_scene(path).name == "good"


@pytest.mark.thinned(3)
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
        ("tumbling_prsim", ("tumbling_prsim", "did you mean 'tumbling_prism'?", "`symrot scenes` lists all")),
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


STRANGE = [
    None, True, 0, -1, 1e308, 1e-308, float("nan"), float("inf"), 10**400, Decimal("sNaN"), "", "x", "1/0", "tan(pi/2)",
    "(9**64)**64", "sqrt(-1)", "\n", [], [1], [1, 2, 3], [None] * 3, [0, 0, 0], {}, {"a": 1}, b"x", 1j, object(), "1/x",
]  # fmt: skip


def places(node, place=()):
    """Yield the path to every value in a nested scene."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield (*place, key)
        yield from places(value, (*place, key))


@pytest.mark.thinned(6)
@pytest.mark.parametrize("path", sorted(SHIPPED.glob("*.toml")), ids=lambda path: path.stem)
def test_a_strange_value_anywhere_is_read_or_refused_in_one_sentence(path):
    """Each value of each shipped scene is replaced by strange values; no other exception is raised."""
    chance = random.Random(path.stem)
    content = tomllib.loads(path.read_text(), parse_float=Decimal)
    for *table, key in places(content):
        for value in chance.sample(STRANGE, 4):
            changed = copy.deepcopy(content)
            reduce(getitem, table, changed)[key] = value
            try:
                Scene.from_dict(changed, "mine")
            except InputError as error:
                assert str(error).startswith("mine: ") and "expected" in str(error) and "\n" not in str(error)


@pytest.mark.parametrize("content", [None, [], "schema = 1", 3, {}, {"schema": 1}, {1: 2}])
def test_a_dict_is_read_as_strictly_as_a_file(content):
    with pytest.raises(InputError, match=r"^mine: .*expected"):
        Scene.from_dict(content, "mine")
