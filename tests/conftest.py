"""What all tests share: a cache of compiled kernels of their own, so that no test reads or fills the user's."""

import os
from collections.abc import Iterator

import pytest


@pytest.fixture(scope="session", autouse=True)
def session_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Point SYMROT_CACHE, for this process and those it starts, at a directory of this session."""
    before = os.environ.get("SYMROT_CACHE")
    os.environ["SYMROT_CACHE"] = str(tmp_path_factory.mktemp("cache"))
    yield
    if before is None:
        del os.environ["SYMROT_CACHE"]
    else:
        os.environ["SYMROT_CACHE"] = before
