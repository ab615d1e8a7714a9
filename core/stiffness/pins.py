"""Pins: rules stated by the user, and the node numbers that follow from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import PalpateError
from ..mesh.closest_point import ClosestPoints, SurfacePoints
from ..mesh.surface import Surface
from ..mesh.tet_mesh import TetMesh


@dataclass(frozen=True)
class PinBelow:
    """Pin the surface within the lowest ``fraction`` of the body's height along ``axis``."""

    fraction: float
    axis: int = 2


@dataclass(frozen=True, eq=False)
class PinWeights:
    """Pin where weights (V,) painted on the input surface's vertices reach one half."""

    weights: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PinNodes:
    """Pin these nodes, int64 (p,), of a tetrahedral mesh that is given."""

    nodes: NDArray[np.int64]


@dataclass(frozen=True)
class PinCore:
    """Pin what lies deepest in each piece of the body, and nothing of its surface: nodes under at
    least this ``share`` of the depth of its deepest one.

    So a body is held as by a skeleton: where it is thick it gives way only around what presses, and
    does not lean, however slender what it stands on is; limbs bend. A shell has no such inside; the
    lowest tenth of its surface along ``up`` (3,) is pinned.
    """

    share: float = 0.5
    up: tuple[float, float, float] = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class NoPins:
    """Pin nothing: a free body, held by what it meets."""


Pins = PinBelow | PinCore | PinWeights | PinNodes | NoPins


def held_at(nodes: NDArray[np.int64]) -> PinNodes | NoPins:
    """The rule that pins just these nodes (p,) of a given mesh; none of them, of a free body."""
    return PinNodes(nodes) if len(nodes) else NoPins()


# A piece is a shell when nothing in it is as deep as this share of its diagonal.
SHALLOW = 0.03
LOWEST = 0.1


def pinned_nodes(
    pins: Pins, mesh: TetMesh, surface: Surface | None, places: SurfacePoints | None = None
) -> NDArray[np.int64]:
    """Numbers of the pinned nodes, ascending.

    Parameters
    ----------
    surface : the input surface that :class:`PinWeights` refer to, None for a body given as
        tetrahedra.
    places : :func:`places_on` of this mesh and surface, if already known.

    Raises
    ------
    PalpateError
        A fraction outside 0 to 1, weights without a surface or not one per vertex, or a rule that
        pins nothing.
    """
    if isinstance(pins, NoPins):
        return np.empty(0, dtype=np.int64)
    if isinstance(pins, PinNodes):
        return np.unique(pins.nodes)
    if isinstance(pins, PinBelow):
        return _below(pins, mesh)
    if isinstance(pins, PinCore):
        return _core(pins, mesh)
    return _weighted(pins, mesh, surface, places)


def places_on(surface: Surface, mesh: TetMesh) -> SurfacePoints:
    """Places of the body's surface nodes on the surface it was made from, one a node."""
    return ClosestPoints(surface.vertices, surface.triangles).query(mesh.nodes[mesh.surface_nodes])


def fraction_checked(fraction: float) -> float:
    """``fraction`` of a :class:`PinBelow`, checked.

    Raises
    ------
    PalpateError
        It does not lie between 0 and 1.
    """
    if not 0 <= fraction <= 1:
        raise PalpateError(
            "pins: the fraction is {fraction}, but must lie between 0 (only the very bottom) and "
            "1 (everything)",
            fraction=fraction,
        )
    return fraction


def _below(pins: PinBelow, mesh: TetMesh) -> NDArray[np.int64]:
    fraction_checked(pins.fraction)
    height = mesh.nodes[mesh.surface_nodes, pins.axis]
    # The last terms make sure that all of a level bottom is pinned despite rounding, which is of
    # the coordinates themselves far from the origin.
    rounding = max(1e-9 * np.ptp(height), 4 * np.spacing(np.abs(height).max()))
    limit = height.min() + pins.fraction * np.ptp(height) + rounding
    low: NDArray[np.int64] = mesh.surface_nodes[height <= limit]
    return low


def _core(pins: PinCore, mesh: TetMesh) -> NDArray[np.int64]:
    depth = np.zeros(len(mesh.nodes))
    inner = np.setdiff1d(np.arange(len(mesh.nodes)), mesh.surface_nodes)
    found = ClosestPoints(mesh.nodes, mesh.surface_triangles).query(mesh.nodes[inner])
    depth[inner] = found.distance
    cores = [
        _core_of_piece(pins, mesh.nodes, depth, np.flatnonzero(mesh.node_components == piece))
        for piece in range(mesh.component_count)
    ]
    core: NDArray[np.int64] = np.sort(np.concatenate(cores))
    return core


def _core_of_piece(
    pins: PinCore, nodes: NDArray[np.float64], depth: NDArray[np.float64], piece: NDArray[np.int64]
) -> NDArray[np.int64]:
    places, deepest = nodes[piece], depth[piece].max()
    deep: NDArray[np.int64] = piece[(depth[piece] > 0.0) & (depth[piece] >= pins.share * deepest)]
    if deepest >= SHALLOW * np.linalg.norm(np.ptp(places, axis=0)) and holds(nodes[deep]):
        return deep
    height = places @ np.array(pins.up)
    order: NDArray[np.int64] = piece[np.argsort(height, kind="stable")]
    count = int((height <= height.min() + LOWEST * np.ptp(height)).sum())
    while not holds(nodes[order[:count]]) and count < len(piece):
        count += 1
    return order[:count]


def holds(held: NDArray[np.float64]) -> bool:
    """Whether pinned points (k, 3) leave no rotation: at least three, not on one line."""
    if len(held) < 3:
        return False
    spread = np.linalg.svd(held - held.mean(axis=0), compute_uv=False)
    return bool(spread[1] > 1e-9 * spread[0])


def _weighted(
    pins: PinWeights, mesh: TetMesh, surface: Surface | None, places: SurfacePoints | None
) -> NDArray[np.int64]:
    if surface is None or len(pins.weights) != len(surface.vertices):
        raise PalpateError(
            "pins: painted weights need the surface they were painted on, one weight per vertex"
        )
    known = places_on(surface, mesh) if places is None else places
    corner_weights = pins.weights[surface.triangles[known.triangle]]
    weight = np.einsum("pc,pc->p", known.alpha, corner_weights)
    pinned: NDArray[np.int64] = mesh.surface_nodes[weight >= 0.5]
    if not pinned.size:
        raise PalpateError(
            "pins: no node of the body lies where the pin group reaches a weight of 0.5; assign "
            "more vertices to it, or use a smaller edge length"
        )
    return pinned
