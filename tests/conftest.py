"""What all tests share: a cache of compiled kernels of their own, and a precision of mpmath that none may change."""

import os
from collections.abc import Iterator

import pytest
from mpmath import mp


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


@pytest.fixture(autouse=True)
def precision_is_left_alone() -> Iterator[None]:
    """Refuse a test, or the code under it, that leaves mpmath's global precision changed: results would depend on order."""
    before = mp.prec
    yield
    after, mp.prec = mp.prec, before
    assert after == before, f"mpmath was left at {after} bits, it began with {before}"
