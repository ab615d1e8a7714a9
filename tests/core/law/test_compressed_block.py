"""A block between two plates, pressed to two fifths of its height by every law that bears it."""

import numpy as np
import pytest

from palpate.core.law.foam import Foam, FoamTerm
from palpate.core.law.neo_hookean import NeoHookean
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.solid.inversion import is_upright, unhindered_share
from palpate.core.shape.solid.solid import solid

EDGE = 0.05
STEP = 0.05
FOAM = (FoamTerm(0.7, 8.0), FoamTerm(0.3, -2.0))
MATERIALS = {
    "rubber": (0.45, NeoHookean(), "smoothed"),
    "soft rubber": (0.3, NeoHookean(), "linear"),
    "foam": (0.1, Foam(0.1, FOAM), "linear"),
    "auxetic foam": (-0.2, Foam(-0.2), "smoothed"),
}


def settled(body, u, free):
    """Newton's method with a line search on the energy; the other freedoms stay as they are."""
    for _ in range(40):
        rest = -body.forces(u).ravel()[free]
        scale = np.abs(body.forces(u)).max()
        if np.abs(rest).max() < 1e-8 * scale:
            return u
        for convex in (False, True):
            blocks = body.tangent_blocks(u, convex=convex)
            pattern = body.pattern
            rows = (3 * pattern.rows[:, None, None] + np.arange(3)[:, None]).repeat(3, axis=2)
            columns = (3 * pattern.columns[:, None, None] + np.arange(3)).repeat(3, axis=1)
            matrix = np.zeros((u.size, u.size))
            matrix[rows.ravel(), columns.ravel()] = blocks.ravel()
            own = matrix[np.ix_(free, free)]
            if convex or np.linalg.eigvalsh(own)[0] > 0.0:
                break
        way = np.zeros(u.size)
        way[free] = np.linalg.solve(own, rest)
        way = way.reshape(u.shape)
        part, energy = unhindered_share(body, u, way), body.energy(u)
        while body.energy(u + part * way) > energy + 1e-12 * abs(energy):
            part *= 0.5
            assert part > 1e-6
        u = u + part * way
    raise AssertionError("no equilibrium")


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
