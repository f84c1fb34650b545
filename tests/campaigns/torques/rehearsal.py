"""Jobs that end, hang or die, for the test of the pool of processes; each process imports this module alone."""

import os
import time
from collections.abc import Callable

__all__ = ["rehearse"]


def rehearse(job: str, started: Callable[[], object]) -> str:
    started()
    if job == "hang":
        time.sleep(60)
    if job == "die":
        os._exit(3)
    return f"done {job}"
