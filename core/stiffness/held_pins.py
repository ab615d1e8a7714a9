"""Check that pins hold a body, so that its stiffness has an inverse."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..mesh.tet_mesh import TetMesh


def pins_checked(mesh: TetMesh, fixed: NDArray[np.int64]) -> NDArray[np.int64]:
    """Pinned nodes, sorted and unique, checked to exist and to hold every piece of the body.

    Raises
    ------
    PalpateError
        Node numbers out of range; a piece with fewer than three pins, or with all its pins on
        one line, so that it could still move; no free surface node left.
    """
    pins = np.unique(np.asarray(fixed, dtype=np.int64))
    if pins.size and (pins[0] < 0 or pins[-1] >= len(mesh.nodes)):
        raise PalpateError(
            f"pinned nodes: {pins[0] if pins[0] < 0 else pins[-1]} is not a node of this body "
            f"(0 to {len(mesh.nodes) - 1}); pin nodes that exist"
        )
    for piece in range(mesh.component_count):
        held = mesh.nodes[pins[mesh.node_components[pins] == piece]]
        if not _holds(held):
            where = "the body" if mesh.component_count == 1 else f"piece {piece + 1} of the body"
            raise PalpateError(
                f"pins: {where} is pinned at {len(held)} nodes"
                f"{' on one line' if len(held) > 2 else ''} and could move away; pin at least "
                "three nodes that do not lie on a line in each piece"
            )
    if not np.setdiff1d(mesh.surface_nodes, pins).size:
        raise PalpateError(
            "pins: every surface node is pinned, so nothing is left to touch; pin fewer"
        )
    return pins


def _holds(held: NDArray[np.float64]) -> bool:
    """Whether pinned points (k, 3) leave no rotation: at least three, not on one line."""
    if len(held) < 3:
        return False
    spread = np.linalg.svd(held - held.mean(axis=0), compute_uv=False)
    return bool(spread[1] > 1e-9 * spread[0])
