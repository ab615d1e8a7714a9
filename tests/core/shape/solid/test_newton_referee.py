"""Newton's equilibria against scikit-fem, which assembles and solves by itself."""

import numpy as np
import pytest
from bodies.bare_body import bare_body
from bodies.large_loads import carried, large_loads
from referees.nonlinear_reference import NonlinearReference

from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.solid.free_solid import FreeSolid


@pytest.fixture(scope="module")
def cube():
    mesh, fixed = paper_cube(cells=3)
    return FreeSolid.of(bare_body(mesh, fixed, 0.4)), mesh


@pytest.mark.parametrize("load", ["press on the end", "bend", "twist", "pull, spread"])
def test_another_program_finds_the_same_shape(cube, load):
    body, mesh = cube
    forces, found = carried(body, large_loads(body, 2)[load])
    expected = NonlinearReference(mesh, body.free, 0.4).displacements(forces, 2)
    size = np.abs(expected).max()
    assert size > 0.1 * 0.05
    assert np.abs(found.displacements - expected).max() < 1e-9 * size
