"""Additional pins for a baked body, at further nodes of its surface.

A dense compliance is downdated, which takes seconds where a bake takes minutes. Where the stored
precision does not suffice, the body's tetrahedra are eliminated again; a new tetrahedralization is
never needed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from scipy.linalg.blas import dgemm

from ..body.soft_body import SoftBody
from ..compliance.compression.compress import compress
from ..compliance.compression.compressed_compliance import CompressedCompliance
from ..compliance.dense import DenseCompliance
from ..compliance.elimination.surface_columns import factor_for_columns
from ..compliance.mapped import MappedCompliance
from ..compliance.protocol import Compliance
from ..compliance.surface_compliance import surface_compliance
from ..errors import PalpateError
from ..machine.machine_speed import dgemm_rate
from ..mesh.tet_mesh import TetMesh
from ..stiffness.assembly import assemble
from ..stiffness.freedoms import freedoms
from ..stiffness.held_pins import free_or_pinned
from .cost.prediction import estimate_cost
from .cost.size import MeshSize
from .settings import BakeSettings

# Largest relative error of a column from a downdate.
LARGEST_ERROR = 2e-5

# Standard deviation of a rounding error, in units in the last place.
ROUNDING_DEVIATION = 0.29

# Rows computed at once: enough for BLAS to run at full speed.
ROWS_PER_PRODUCT = 384

# Seconds to read, change and write a number of a table, on one core.
SECONDS_PER_ENTRY = 2e-8

PinsChange = Literal["same", "more", "bake"]


def pins_change(mesh: TetMesh, old: ArrayLike, new: ArrayLike) -> PinsChange:
    """Work that changed pins need: none, :func:`pin_more`, or a bake.

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
    """The same body pinned at further nodes of its surface; equal to a bake with these pins.

    A dense compliance is downdated, L' = L - L_:P L_PP^-1 L_P: for the nodes that stay free: minus
    the displacements by the forces that hold the nodes P. Of a free body these forces also balance
    the load, and the body may move as a whole: six rows and columns R_P join L_PP, and R^T those of
    L_P:. The relative error of the columns is at
    most :data:`LARGEST_ERROR`; where rounding would cause more, and for a compressed compliance
    (whose error L_PP^-1 would amplify), it is computed anew from the body's tetrahedra.

    Parameters
    ----------
    body : not modified.
    added_nodes : numbers of nodes to pin; those already pinned make no difference.

    Raises
    ------
    PalpateError
        A node inside the body, which needs a bake; no such node; nothing left to touch.
    """
    added = np.setdiff1d(np.asarray(added_nodes, dtype=np.int64), body.fixed)
    fixed = free_or_pinned(body.mesh, np.union1d(body.fixed, added))
    inside = np.setdiff1d(added, body.mesh.surface_nodes)
    if inside.size:
        raise PalpateError(
            "pins: node {node} lies inside the body, and only its surface can be pinned without a "
            "new bake; bake again with these pins",
            node=inside[0],
        )
    if not added.size:
        return body
    compliance: Compliance | None = None
    if isinstance(body.compliance, (DenseCompliance, MappedCompliance)):
        compliance = _downdated(body.compliance, body.free_index(added), _motions(body))
    return replace(
        body, fixed=fixed, older_key=None, compliance=compliance or _computed(body, fixed)
    )


def pin_more_seconds(
    size: MeshSize, settings: BakeSettings, free_surface_nodes: int, added: int
) -> float:
    """Estimated seconds of :func:`pin_more`.

    Parameters
    ----------
    size : of the body's tetrahedra.
    settings : of the body's bake: form, formulation, tolerance. A ``dense`` body is assumed to be
        downdated, a ``compressed`` one to be computed anew.
    free_surface_nodes : before the new pins.
    added : number of nodes to pin.
    """
    if settings.form == "compressed":
        return estimate_cost(size, settings).seconds
    pinned, rows = 3.0 * added, 3.0 * free_surface_nodes
    flops = pinned * rows**2 + 2 * pinned**2 * rows
    return flops / dgemm_rate(settings.threads) + SECONDS_PER_ENTRY * rows**2


def _downdated(
    compliance: DenseCompliance | MappedCompliance,
    pinned: NDArray[np.int64],
    motions: NDArray[np.float64],
) -> DenseCompliance | None:
    """L' with ``pinned`` held, places among the free surface nodes; None if too inexact.

    ``motions`` (3n, m) of the nodes need no force.
    """
    count = compliance.node_count
    kept = np.setdiff1d(np.arange(count), pinned)
    pinned_rows, kept_rows = freedoms(pinned), freedoms(kept)
    stored = compliance.table.reshape(3 * count, 3 * count)
    loaded = stored[pinned_rows].astype(np.float64)
    reach = np.concatenate([loaded[:, kept_rows], motions[kept_rows].T])
    try:
        holding = _holding(loaded[:, pinned_rows], motions[pinned_rows], reach)
    except LinAlgError:
        return None
    noise = _rounding_noise(stored, pinned_rows, kept_rows, holding[: len(pinned_rows)])
    table = np.empty((len(kept_rows), len(kept_rows)), dtype=np.float32)
    for first in range(0, len(kept_rows), ROWS_PER_PRODUCT):
        rows = slice(first, min(first + ROWS_PER_PRODUCT, len(kept_rows)))
        part = stored[kept_rows[rows]].take(kept_rows[: rows.stop], axis=1).astype(np.float64)
        part -= dgemm(1.0, reach.T[: rows.stop], holding[:, rows]).T
        # Only one half is computed, so that L' is symmetric to the last bit, as L is.
        table[rows, : rows.stop] = part
        table[:first, rows] = part[:, :first].T
        table[rows, rows] = 0.5 * (part[:, first:] + part[:, first:].T)
    norms = np.linalg.norm(table, axis=1)
    if (noise > LARGEST_ERROR * norms).any():
        return None
    return DenseCompliance(
        compliance.free_surface[kept], table.reshape(len(kept), 3, 3 * len(kept))
    )


def _holding(
    own: NDArray[np.float64], motions: NDArray[np.float64], reach: NDArray[np.float64]
) -> NDArray[np.float64]:
    """For 1 N on a kept freedom the forces that hold the pinned ones, and minus the motions, from
    L_PP (3p, 3p), R_P (3p, m), and L_P: over R^T (3p + m, 3k).

    The motions may be added to L_PP, as the forces balance: so it has a Cholesky factor, and the
    motions follow from m equations more.
    """
    count = len(own)
    held = cho_factor(own + motions @ motions.T)
    wanted = reach[:count] + motions @ reach[count:]
    forces: NDArray[np.float64] = cho_solve(held, wanted)
    if not motions.size:
        return forces
    by_motions = cho_solve(held, motions)
    moved = np.linalg.solve(motions.T @ by_motions, motions.T @ forces - reach[count:])
    return np.concatenate([forces - by_motions @ moved, moved])


def _motions(body: SoftBody) -> NDArray[np.float64]:
    """Rigid motions of the free surface nodes, (3n, 6), as large as L; (3n, 0) of a pinned body."""
    nodes = body.mesh.nodes[body.compliance.free_surface]
    if not body.is_free:
        return np.empty((3 * len(nodes), 0))
    motions = body.inertia.modes(nodes).reshape(-1, 6)
    softness = np.trace(body.compliance.diagonal(), axis1=1, axis2=2).mean()
    scaled: NDArray[np.float64] = motions * np.sqrt(softness / (motions**2).mean(axis=0))
    return scaled


def _rounding_noise(
    table: NDArray[np.floating],
    pinned_rows: NDArray[np.int64],
    kept_rows: NDArray[np.int64],
    holding: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Expected error of the columns of L' from rounding of L, 2-norm, (3k,).

    L' = Q^T L Q with Q = [I, -H] of the kept and the pinned freedoms. For independent
    errors of L_ab with deviation r |L_ab|, the squared errors of L' are the product of the
    elementwise squares of Q^T, r L and Q.
    """
    weights = np.ones(len(kept_rows) + len(pinned_rows))
    squares = holding**2
    weights[pinned_rows] = squares.sum(axis=1)
    spread = np.empty_like(weights)
    for first in range(0, len(table), ROWS_PER_PRODUCT):
        rows = slice(first, first + ROWS_PER_PRODUCT)
        spread[rows] = np.square(table[rows], dtype=np.float64) @ weights
    rounding = ROUNDING_DEVIATION * np.finfo(table.dtype).eps
    noise: NDArray[np.float64] = rounding * np.sqrt(
        spread[kept_rows] + spread[pinned_rows] @ squares
    )
    return noise


def _computed(body: SoftBody, fixed: NDArray[np.int64]) -> Compliance:
    """Compliance by elimination, in the body's form."""
    stiffness = assemble(
        body.mesh,
        body.poisson_ratio,
        formulation=body.formulation,
        young_scale=body.young_scale,
    )
    if not isinstance(body.compliance, CompressedCompliance):
        return surface_compliance(body.mesh, stiffness, fixed)
    source = factor_for_columns(body.mesh, stiffness, fixed)
    positions = body.mesh.nodes[source.free_surface]
    return compress(source, positions, body.compliance.tolerance)
