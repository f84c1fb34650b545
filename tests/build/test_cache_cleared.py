"""If another process clears the cache between compiling and loading, the library is built again."""

from symrot.build import cache as library
from symrot.closed_form import build as closed_forms


def test_a_closed_form_is_compiled_again_if_it_was_cleared_before_it_was_loaded(tmp_path, monkeypatch):
    monkeypatch.setenv("SYMROT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(closed_forms, "_loaded", {})
    monkeypatch.setattr(closed_forms, "_begun", {})
    first = closed_forms.begin("gyrostat")
    for part in first:
        part.path()
    assert library.clear()
    assert closed_forms.load("gyrostat")
