"""Bodies for the tests of the command line, and the commands as a user runs them."""

import json
import math

import numpy as np
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

from palpate.cli.bake import status_line
from palpate.cli.main import main
from palpate.core.body import body_file


@pytest.fixture(scope="module")
def tets(tmp_path_factory, cube_mesh):  # noqa: F811
    """The cube's tetrahedra as a file."""
    mesh, fixed = cube_mesh
    path = tmp_path_factory.mktemp("mesh") / "cube-tets.npz"
    np.savez(path, X=mesh.nodes, T=mesh.tets, fixed=fixed)
    return path


@pytest.fixture(scope="module")
def cube_file(tmp_path_factory, cube):  # noqa: F811
    """The cube as a body file."""
    path = tmp_path_factory.mktemp("cube") / "cube.npz"
    body_file.save(cube, path)
    return path


@pytest.fixture
def palpate(capfd, monkeypatch):
    """Run a command: status, what it printed, and what it said beside it.

    On a busy computer no less and no more: without the lines now and then for those who wait.
    """
    monkeypatch.setattr(status_line, "SECONDS_BETWEEN_LINES", math.inf)

    def run(*words):
        capfd.readouterr()
        try:
            status = main([str(word) for word in words])
        except SystemExit as ended:
            status = ended.code
        return (status, *capfd.readouterr())

    return run


@pytest.fixture
def figures_of(palpate):
    """Run a command that succeeds and return its figures."""

    def run(*words):
        status, printed, said = palpate(*words, "--json")
        assert status == 0, said
        return json.loads(printed)

    return run


@pytest.fixture
def refusal(palpate):
    """Run a command that is refused in one line, and return the line."""

    def run(*words):
        status, printed, said = palpate(*words)
        assert (status, printed, len(said.splitlines())) == (2, "", 1)
        assert said.startswith("palpate: ")
        return said

    return run
