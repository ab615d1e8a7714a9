"""A body with an inner corner: two parts that face different ways, close to each other."""

from __future__ import annotations

import numpy as np

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.body.soft_body import SoftBody
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.pins import PinNodes


def inner_corner() -> SoftBody:
    """The paper's cube without a quarter: a floor at z = 25 mm that meets a wall at x = 25 mm."""
    mesh, _ = paper_cube()
    middles = mesh.nodes[mesh.tets].mean(axis=1)
    kept = mesh.tets[(middles[:, [0, 2]] < 0.025).any(axis=1)]
    used, numbered = np.unique(kept, return_inverse=True)
    nodes = mesh.nodes[used]
    corner = TetMesh.checked(nodes, numbered.reshape(-1, 4))
    pinned = np.flatnonzero(nodes[:, 2] == 0.0)
    return bake(corner, BakeSettings(0.49, 10_000.0, PinNodes(pinned)))[0]
