"""Body files and what is changed in them."""

import numpy as np
import pytest

from palpate.core.body import body_file


@pytest.fixture
def file(cube, tmp_path):
    path = tmp_path / "cube.npz"
    body_file.save(cube, path)
    return path


@pytest.fixture
def rewrite():
    """Write the same file with some arrays changed (or dropped, given None)."""

    def change(path, **changes):
        with np.load(path, allow_pickle=False) as stored:
            arrays = {**stored, **changes}
        np.savez(path, **{name: value for name, value in arrays.items() if value is not None})

    return change
