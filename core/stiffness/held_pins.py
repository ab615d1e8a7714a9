"""Check that pins hold a body, or that it can be without any."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..mesh.tet_mesh import TetMesh
from ..sentence import Sentence
from .pins import holds


def free_or_pinned(mesh: TetMesh, fixed: NDArray[np.int64]) -> NDArray[np.int64]:
    """Pinned nodes as :func:`pins_checked` has them; none at all are those of a free body.

    Raises
    ------
    PalpateError
        A free body of several pieces, of which each could move by itself; pins that do not hold.
    """
    if len(fixed):
        return pins_checked(mesh, fixed)
    if mesh.component_count > 1:
        raise PalpateError(
            "pins: the body is made of {count} pieces, and without pins each would move by itself; "
            "join them in the mesh, or pin each piece",
            count=mesh.component_count,
        )
    return np.empty(0, dtype=np.int64)


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
            "pinned nodes: {node} is not a node of this body (0 to {last}); pin nodes that exist",
            node=pins[0] if pins[0] < 0 else pins[-1],
            last=len(mesh.nodes) - 1,
        )
    for piece in range(mesh.component_count):
        held = mesh.nodes[pins[mesh.node_components[pins] == piece]]
        if not holds(held):
            alone, few = mesh.component_count == 1, len(held) <= 2
            raise PalpateError(
                "pins: {where} is pinned at {held} and could move away; pin at least three nodes "
                "that do not lie on a line in each piece",
                where=Sentence("the body")
                if alone
                else Sentence("piece {number} of the body", number=piece + 1),
                held=Sentence("{count} nodes", count=len(held))
                if few
                else Sentence("{count} nodes on one line", count=len(held)),
            )
    if not np.setdiff1d(mesh.surface_nodes, pins).size:
        raise PalpateError(
            "pins: every surface node is pinned, so nothing is left to touch; pin fewer"
        )
    return pins
