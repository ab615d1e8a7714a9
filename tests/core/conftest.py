"""Bodies for the tests of core, the same examples in every run, and a place for litter."""

import os

import pytest
from bodies.shared import (  # noqa: F401
    body,
    cube,
    cube_mesh,
    mouse,
    mouse_mesh,
    rng,
    solved_displacements,
)


@pytest.fixture(scope="module", autouse=True)
def somewhere_else(tmp_path_factory):
    """fTetWild writes files where it runs; see core/mesh/tetrahedralize.py."""
    before = os.getcwd()  # noqa: PTH109  what os.chdir takes
    os.chdir(tmp_path_factory.mktemp("here"))
    yield
    os.chdir(before)
