"""A block between two plates, pressed to two fifths of its height by every law that bears it."""

import numpy as np
import pytest
from referees.led_solid import settled

from palpate.core.law.foam import Foam
from palpate.core.law.neo_hookean import NeoHookean
from palpate.core.law.principal import Power
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.solid.inversion import is_upright
from palpate.core.shape.solid.solid import solid

EDGE = 0.05
STEP = 0.05
FOAM = (Power(0.7, 8.0), Power(0.3, -2.0))
MATERIALS = {
    "rubber": (0.45, NeoHookean(), "smoothed"),
    "soft rubber": (0.3, NeoHookean(), "linear"),
    "foam": (0.1, Foam(0.1, FOAM), "linear"),
    "auxetic foam": (-0.2, Foam(-0.2), "smoothed"),
}


@pytest.mark.parametrize(("ratio", "law", "formulation"), MATERIALS.values(), ids=MATERIALS)
def test_a_block_is_pressed_by_three_fifths_and_pushes_back_ever_harder(ratio, law, formulation):
    mesh, _ = paper_cube(EDGE, 3)
    body = solid(mesh, ratio, law, formulation)
    low, high = (np.isclose(mesh.nodes[:, 2], z) for z in (0.0, EDGE))
    free = np.flatnonzero(np.repeat(~(low | high), 3))
    u, pushes = np.zeros(mesh.nodes.shape), []
    for share in np.arange(STEP, 0.6 + STEP / 2, STEP):
        # Everything goes down with the plate first, so that no element is turned over.
        u[:, 2] -= STEP * mesh.nodes[:, 2]
        u[low], u[high] = 0.0, [0.0, 0.0, -share * EDGE]
        u = settled(body, u, free)
        assert is_upright(body, u)
        pushes.append(-body.forces(u)[high, 2].sum())
    assert (np.diff(pushes) > 0.0).all()
