"""Turn a signed distance field into a closed surface of quads (naive surface nets, projected)."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Field = Callable[[Points], NDArray[np.float64]]

CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
EDGES = [
    (a, b) for a in range(8) for b in range(a + 1, 8) if np.abs(CORNERS[a] - CORNERS[b]).sum() == 1
]


def surface_net(
    field: Field, low: Points, high: Points, spacing: float, relax: int = 30
) -> tuple[Points, NDArray[np.int64]]:
    """Return vertices (v, 3) and outward quads (q, 4) of the zero set of `field`.

    `field` takes points (m, 3) and gives signed distances (m,), negative inside; the zero set
    must lie within the box from `low` to `high`. `relax` rounds of tangential smoothing, each
    followed by a projection, even the quads out and leave the shape alone.

    Raises ValueError where a crevice narrower than the grid would give edges with four quads;
    another spacing or a filled crevice cures that.
    """
    counts = np.ceil((high - low) / spacing).astype(int) + 1
    axes = [low[i] + spacing * np.arange(counts[i]) for i in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    values = field(grid.reshape(-1, 3)).reshape(tuple(counts))
    vertices, cell_vertex = _cell_vertices(values, low, spacing)
    quads = _quads(values, cell_vertex)
    crevices = vertices[_crowded_edges(quads)].mean(axis=1)
    if len(crevices):
        raise ValueError(f"edges with more than two quads at {crevices.round(1).tolist()}")
    step = 0.05 * spacing
    for _ in range(relax):
        vertices = project(field, _smoothed(vertices, quads), step)
    return project(field, vertices, step, rounds=3), quads


def gradient(field: Field, points: Points, step: float) -> Points:
    """Central differences of `field` at points (m, 3): gradients (m, 3)."""
    result = np.empty_like(points)
    for axis in range(3):
        shift = np.zeros(3)
        shift[axis] = step
        result[:, axis] = (field(points + shift) - field(points - shift)) / (2.0 * step)
    return result


def project(field: Field, points: Points, step: float, rounds: int = 1) -> Points:
    """Move points (m, 3) onto the zero set by `rounds` Newton steps along the gradient."""
    for _ in range(rounds):
        slope = gradient(field, points, step)
        square = np.maximum((slope * slope).sum(axis=1), 0.25)
        points = points - (field(points) / square)[:, None] * slope
    return points


def _cell_vertices(
    values: NDArray[np.float64], low: Points, spacing: float
) -> tuple[Points, NDArray[np.int64]]:
    """Put one vertex into each cell the surface crosses: the mean of its edge crossings."""
    shape = tuple(n - 1 for n in values.shape)
    corner = [values[x : x + shape[0], y : y + shape[1], z : z + shape[2]] for x, y, z in CORNERS]
    total = np.zeros((*shape, 3))
    crossings = np.zeros(shape)
    for a, b in EDGES:
        cut = (corner[a] < 0) != (corner[b] < 0)
        span = np.where(cut, corner[a] - corner[b], 1.0)
        t = np.where(cut, corner[a] / span, 0.0)
        at = CORNERS[a] + t[..., None] * (CORNERS[b] - CORNERS[a])
        total += np.where(cut[..., None], at, 0.0)
        crossings += cut
    active = crossings > 0
    cells = np.argwhere(active)
    cell_vertex = np.full(shape, -1, dtype=np.int64)
    cell_vertex[active] = np.arange(len(cells))
    return low + spacing * (cells + total[active] / crossings[active][:, None]), cell_vertex


def _quads(values: NDArray[np.float64], cell_vertex: NDArray[np.int64]) -> NDArray[np.int64]:
    """Join the four cells round each grid edge that the surface crosses."""
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        before = np.moveaxis(values, (axis, u, v), (0, 1, 2))
        cells = np.moveaxis(cell_vertex, (axis, u, v), (0, 1, 2))
        start, end = before[:-1, 1:-1, 1:-1] < 0, before[1:, 1:-1, 1:-1] < 0
        for rows, order in ((start & ~end, (0, 1, 2, 3)), (~start & end, (3, 2, 1, 0))):
            i, j, k = np.nonzero(rows)
            ring = [cells[i, j, k], cells[i, j + 1, k], cells[i, j + 1, k + 1], cells[i, j, k + 1]]
            quads.append(np.stack([ring[n] for n in order], axis=1))
    return np.concatenate(quads)


def _crowded_edges(quads: NDArray[np.int64]) -> NDArray[np.int64]:
    """Edges (e, 2) that belong to other than two quads."""
    edges = np.concatenate([quads[:, [i, (i + 1) % 4]] for i in range(4)])
    edges, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    return edges[count != 2]


def _smoothed(vertices: Points, quads: NDArray[np.int64]) -> Points:
    """Move each vertex half way towards the mean of the centres of its quads."""
    centres = vertices[quads].mean(axis=1)
    total = np.zeros_like(vertices)
    count = np.zeros(len(vertices))
    for corner in range(4):
        np.add.at(total, quads[:, corner], centres)
        np.add.at(count, quads[:, corner], 1.0)
    return 0.5 * vertices + 0.5 * total / count[:, None]
