"""Newton's equilibria against scikit-fem, which assembles and solves by itself."""

import numpy as np
import pytest
from bodies.bare_body import bare_body
from bodies.large_loads import carried, large_loads
from referees.nonlinear_reference import (
    NEO_HOOKEAN,
    ST_VENANT_KIRCHHOFF,
    NonlinearReference,
)

from palpate.core.law.neo_hookean import NeoHookean
from palpate.core.law.st_venant_kirchhoff import StVenantKirchhoff
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.solid.free_solid import FreeSolid

LAWS = {
    "neo-Hookean": (NeoHookean(), NEO_HOOKEAN),
    "St. Venant-Kirchhoff": (StVenantKirchhoff(), ST_VENANT_KIRCHHOFF),
}


@pytest.fixture(scope="module", params=LAWS.values(), ids=LAWS)
def cube(request):
    mesh, fixed = paper_cube(cells=3)
    law, by_another = request.param
    body = FreeSolid.of(bare_body(mesh, fixed, 0.4), law)
    return body, NonlinearReference(mesh, body.free, 0.4, by_another)


@pytest.mark.parametrize("load", ["press on the end", "bend", "twist", "pull, spread"])
def test_another_program_finds_the_same_shape(cube, load):
    body, reference = cube
    forces, found = carried(body, large_loads(body, 2)[load])
    expected = reference.displacements(forces, 4)
    size = np.abs(expected).max()
    assert size > 0.1 * 0.05
    assert np.abs(found.displacements - expected).max() < 1e-9 * size
