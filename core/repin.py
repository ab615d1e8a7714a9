"""Pins without a new bake: the compliance of a body that is held at more of its surface."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import cho_factor, cho_solve

from .dense_compliance import DenseCompliance
from .errors import PalpateError
from .held_pins import pins_checked
from .soft_body import SoftBody
from .tet_mesh import TetMesh

PinsChange = Literal["same", "more", "bake"]


def pins_change(mesh: TetMesh, old: ArrayLike, new: ArrayLike) -> PinsChange:
    """What other pins ask for: nothing, :func:`pin_more`, or a bake.

    Parameters
    ----------
    mesh : the body's tetrahedra.
    old, new : pinned node numbers, in any order.

    Returns
    -------
    ``same``; ``more`` where pins of surface nodes are added and none is taken away; else ``bake``.
    """
    before, after = np.unique(np.asarray(old)), np.unique(np.asarray(new))
    if np.setdiff1d(before, after).size:
        return "bake"
    added = np.setdiff1d(after, before)
    if not added.size:
        return "same"
    return "more" if np.isin(added, mesh.surface_nodes).all() else "bake"


def pin_more(body: SoftBody, added_nodes: ArrayLike) -> SoftBody:
    """The same body, held at further nodes of its surface.

    L' = L - L_:P L_PP^-1 L_P: for the nodes that stay free: the forces that keep the nodes P where
    they are, superposed.

    Parameters
    ----------
    body : as it is; it stays so.
    added_nodes : numbers of nodes to pin besides; what is pinned already changes nothing.

    Raises
    ------
    PalpateError
        A node inside the body, which needs a bake; no such node; nothing left to touch.
    """
    added = np.setdiff1d(np.asarray(added_nodes, dtype=np.int64), body.fixed)
    fixed = pins_checked(body.mesh, np.union1d(body.fixed, added))
    inside = np.setdiff1d(added, body.mesh.surface_nodes)
    if inside.size:
        raise PalpateError(
            f"pins: node {inside[0]} lies inside the body, and only its surface can be pinned "
            "without a new bake; bake again with these pins"
        )
    if not added.size:
        return body
    return replace(body, fixed=fixed, compliance=_downdated(body, body.free_index(added)))


def _downdated(body: SoftBody, pinned: NDArray[np.int64]) -> DenseCompliance:
    """L' where ``pinned`` are the places, among the free surface nodes, of those now held."""
    if not isinstance(body.compliance, DenseCompliance):
        raise TypeError(f"no downdate for a compliance of the form {body.compliance.form}")
    count = body.compliance.node_count
    kept = np.setdiff1d(np.arange(count), pinned)
    pinned_dofs, kept_dofs = (
        (3 * nodes[:, None] + np.arange(3)).ravel() for nodes in (pinned, kept)
    )
    columns = body.compliance.columns(pinned)
    factor = cho_factor(columns[pinned_dofs])
    table = body.compliance.table.reshape(3 * count, -1)
    downdated = table[np.ix_(kept_dofs, kept_dofs)].astype(np.float64)
    downdated -= columns[kept_dofs] @ cho_solve(factor, columns[kept_dofs].T)
    return DenseCompliance(
        body.compliance.free_surface[kept],
        downdated.astype(np.float32).reshape(len(kept), 3, -1),
    )
