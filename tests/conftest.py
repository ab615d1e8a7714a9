"""What every test process needs before it imports numpy, and patience for what takes its time."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
import time
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

# One thread for BLAS: results do not depend on the number of cores, and the servo keeps its own.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

# For all that is drawn: the same examples in every run, so that a red test means a changed program,
# and no limit of time, which a busy machine would break. In `long` each round is short, so that all
# properties have many turns (benchmarks/files/fuzz.py).
settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.register_profile("long", max_examples=250, deadline=None, database=None)
settings.load_profile("repeatable")


def is_wine() -> bool:
    """Whether this is a Windows of wine's, which wakes threads late by milliseconds."""
    return sys.platform == "win32" and hasattr(ctypes.WinDLL("ntdll"), "wine_get_version")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Leave out where time means nothing what is about the times of ticks."""
    if is_wine():
        late = pytest.mark.skip(reason="about ticks in time, and wine's are late by milliseconds")
        for item in items:
            if item.get_closest_marker("in_time"):
                item.add_marker(late)


@pytest.fixture(scope="session")
def eventually() -> Callable[..., Any]:
    """Wait until a condition holds, and return its value; fails after `seconds`, telling `what`.

    Long enough for a machine that is busy elsewhere.
    """

    def wait(condition: Callable[[], Any], what: object = "", seconds: float = 20.0) -> Any:
        deadline = time.monotonic() + seconds
        while not (value := condition()):
            if time.monotonic() > deadline:
                pytest.fail(f"did not happen in {seconds} s: {what() if callable(what) else what}")
            time.sleep(0.002)
        return value

    return wait


@pytest.fixture
def link() -> Callable[[Path, Path], None]:
    """Make a symbolic link at a place; skips where there are none (wine has none)."""

    def make(place: Path, leads_to: Path) -> None:
        with contextlib.suppress(OSError):
            place.symlink_to(leads_to)
        if not place.is_symlink():
            pytest.skip("no symbolic links here")

    return make
