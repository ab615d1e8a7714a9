"""What a bake will cost, told before it starts: nodes, time, memory, size of the file.

From a surface these are predictions, since fTetWild does not make the same tetrahedra twice; from
tetrahedra only the time is. The figures below were fitted to fTetWild's runs on seven shapes, from
a cube to a plush mouse, with edge lengths from 0.025 to 0.1 of the diagonal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from .bake_settings import BakeSettings
from .machine_speed import dgemm_rate
from .pins import PinBelow, PinNodes, Pins, PinWeights
from .surface import Surface
from .tet_mesh import TetMesh
from .winding_volume import enclosed_volume

# A dense table of more bytes is compressed when the form is left open.
LARGEST_AUTOMATIC_TABLE = 300_000_000

# How much smaller a compressed table is, typically, at a tolerance of 0.1 %.
COMPRESSION = 10.0

# Edge lengths that are offered when the one that is set takes too much memory.
COARSENING = 1.05
COARSEST_EDGE_LENGTH = 0.5


@dataclass(frozen=True)
class ShapeSize:
    """What the cost of a surface's bake depends on.

    Attributes
    ----------
    area : of the surface, square metres.
    volume : that it encloses, cubic metres.
    diagonal : of its bounding box, metres.
    triangles : how many it has.
    """

    area: float
    volume: float
    diagonal: float
    triangles: int

    @classmethod
    def of(cls, surface: Surface) -> ShapeSize:
        """Measure a surface; for open or overlapping ones this takes up to a second."""
        welded = surface.welded()
        return cls(
            float(welded.areas.sum()),
            enclosed_volume(welded),
            welded.diagonal,
            len(welded.triangles),
        )


@dataclass(frozen=True)
class MeshSize:
    """What the cost of a bake from tetrahedra depends on: counts of its nodes."""

    nodes: int
    surface_nodes: int

    @classmethod
    def of(cls, mesh: TetMesh) -> MeshSize:
        """Count a mesh's nodes."""
        return cls(len(mesh.nodes), len(mesh.surface_nodes))


@dataclass(frozen=True)
class BakeCost:
    """What a bake takes.

    Attributes
    ----------
    nodes, free_surface_nodes : of the tetrahedra.
    seconds : from the start to the body.
    peak_bytes : memory at the moment that takes most.
    file_bytes : of the body file.
    form : of the compliance, ``dense`` or ``compressed``.
    spread : the true number of nodes lies within this factor of the predicted one, either way, in
        nine of ten cases; 1 where it is known. Memory goes with its square, time with its cube.
    """

    nodes: int
    free_surface_nodes: int
    seconds: float
    peak_bytes: int
    file_bytes: int
    form: str
    spread: float = 1.0


def estimate_cost(
    size: ShapeSize | MeshSize, settings: BakeSettings, available: int | None = None
) -> BakeCost:
    """Predict what a bake will take. Quick enough for a panel once the machine's speed is known.

    Parameters
    ----------
    size : of the surface or of the tetrahedra that are given.
    settings : as for the bake.
    available : bytes of memory that can be had; None where ``form="auto"`` need not look at them.
    """
    if isinstance(size, MeshSize):
        nodes, surface_nodes, seconds, spread = size.nodes, size.surface_nodes, 0.0, 1.0
    else:
        nodes, surface_nodes = _predicted_nodes(size, settings)
        seconds = _tetrahedralize_seconds(size, settings, nodes)
        spread = 1.5
    free = max(1, round(surface_nodes * (1 - _pinned_share(settings.pins, surface_nodes))))
    costs = {
        form: replace(_compliance_cost(nodes, free, form), spread=spread)
        for form in ("dense", "compressed")
    }
    chosen = costs[automatic_form(settings.form, costs["dense"], available)]
    return replace(chosen, seconds=chosen.seconds + seconds)


def automatic_form(form: str, dense: BakeCost, available: int | None) -> str:
    """The form that ``auto`` stands for: ``dense`` unless its table is large or does not fit."""
    if form != "auto":
        return form
    too_large = 36 * dense.free_surface_nodes**2 > LARGEST_AUTOMATIC_TABLE
    does_not_fit = available is not None and dense.peak_bytes > available
    return "compressed" if too_large or does_not_fit else "dense"


def memory_refusal(cost: BakeCost, available: int) -> str | None:
    """Why a bake must not start, with the remedy; None where the memory suffices."""
    if cost.peak_bytes <= available:
        return None
    remedies = "choose the compressed form or " if cost.form == "dense" else ""
    return (
        f"bake: {cost.free_surface_nodes:,} free surface nodes take {cost.peak_bytes / 1e9:.1f} GB "
        f"of memory, and {available / 1e9:.1f} GB can be had; {remedies}use a larger edge length"
    )


def edge_length_that_fits(size: ShapeSize, settings: BakeSettings, available: int) -> float | None:
    """The smallest edge length from the one that is set upwards whose bake fits the memory."""
    edge_length = settings.edge_length
    while edge_length <= COARSEST_EDGE_LENGTH:
        # Two digits are what a person would type.
        rounded = float(f"{edge_length:.2g}")
        cost = estimate_cost(size, replace(settings, edge_length=rounded), available)
        if memory_refusal(cost, available) is None:
            return rounded
        edge_length *= COARSENING
    return None


def _predicted_nodes(size: ShapeSize, settings: BakeSettings) -> tuple[int, int]:
    """Nodes and surface nodes that fTetWild will make."""
    length = settings.edge_length * size.diagonal
    surface_nodes = 2.0 * size.area / length**2
    inside = 2.0 * size.volume / length**3
    return round(surface_nodes + inside), max(4, round(surface_nodes))


def _tetrahedralize_seconds(size: ShapeSize, settings: BakeSettings, nodes: int) -> float:
    triangles = min(size.triangles, settings.decimate_above)
    return 1.0 + 5e-4 * triangles + 1e-3 * nodes


def _compliance_cost(nodes: int, free: int, form: str) -> BakeCost:
    table = 36 * free**2
    inside = 40.0 * nodes**2
    if form == "dense":
        flops = 27.0 * free**3 + 1e3 * inside
        peak, file = int(3 * table + 400 * nodes), table
    else:
        flops = 27.0 * free**3 + 2e3 * inside
        peak, file = int(table + 4000 * nodes), int(table / COMPRESSION)
    seconds = flops / (0.5 * dgemm_rate()) + 1e-4 * nodes
    return BakeCost(nodes, free, seconds, peak, file + 300 * nodes, form)


def _pinned_share(pins: Pins, surface_nodes: int) -> float:
    match pins:
        case PinBelow(fraction):
            # As if the surface were spread evenly over the height.
            return min(1.0, fraction)
        case PinWeights(weights):
            return float(np.mean(weights >= 0.5)) if len(weights) else 0.0
        case PinNodes(nodes):
            return min(1.0, len(nodes) / surface_nodes)
    return math.nan
