"""Memory that can be had, also within a container."""

import numpy as np
import psutil
import pytest

from palpate.core.machine.available_memory import available_memory, zeros_apart


def group(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def test_without_a_container_it_is_what_the_system_says(tmp_path):
    assert available_memory(tmp_path) == pytest.approx(psutil.virtual_memory().available, rel=0.2)


@pytest.mark.parametrize(
    "files",
    [
        {
            "memory.max": "5000000\n",
            "memory.current": "4000000\n",
            "memory.stat": "anon 3000000\ninactive_file 900000\n",
        },
        {
            "memory/memory.limit_in_bytes": "5000000\n",
            "memory/memory.usage_in_bytes": "4000000\n",
            "memory/memory.stat": "cache 1000000\ntotal_inactive_file 900000\n",
        },
    ],
    ids=["version 2", "version 1"],
)
def test_a_container_may_have_less_and_gives_back_pages_of_files(tmp_path, files):
    assert available_memory(group(tmp_path, files)) == 1_900_000


def test_a_container_without_a_limit_has_what_the_system_has(tmp_path):
    files = {"memory.max": "max\n", "memory.current": "4000000\n", "memory.stat": ""}
    assert available_memory(group(tmp_path, files)) > 1_000_000


def test_a_container_that_is_full_has_nothing(tmp_path):
    files = {"memory.max": "100\n", "memory.current": "4000000\n", "memory.stat": ""}
    assert available_memory(group(tmp_path, files)) == 0


@pytest.mark.parametrize("shape", [(0, 3), (4, 5), (700, 900), (1, 300_000)])
def test_zeros_apart_are_zeros_to_write_to_by_columns(shape):
    zeros = zeros_apart(shape)
    assert zeros.shape == shape
    assert zeros.dtype == np.float64
    assert zeros.flags.f_contiguous
    assert zeros.flags.writeable
    assert not zeros.any()
    zeros[-1:, -1] = 2.0
    assert zeros.sum() == (2.0 if zeros.size else 0.0)
