"""Prediction of the cost from a surface, since fTetWild is not deterministic.

The figures below were fitted to fTetWild's runs on seven shapes (cube, plate, bar, sphere, capsule,
torus, plush mouse), with edge lengths from 0.0175 to 0.1 of the diagonal and epsilons from 0.001 to
0.01, and to the plans of their bodies.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...compliance.dense import BYTES_PER_PAIR
from ...machine.machine_speed import dgemm_rate
from ...mesh.surface import Surface
from ...mesh.tet_mesh import TetMesh
from ...stiffness.formulation import LINEAR, SMOOTHED
from ...stiffness.pins import NoPins, PinBelow, PinCore, PinNodes, Pins, PinWeights
from ..settings import BakeSettings
from .bake_cost import COMPRESSING_SHARE, BakeCost, compressing_flops, process_bytes
from .memory import automatic_form, memory_refusal
from .size import MeshSize, ShapeSize

# Surface nodes, for an edge length h and an envelope e in metres:
# ((1.24 area / h^2)^1.6 + (0.31 bending / e)^1.6)^(1/1.6). The first is for equilateral
# triangles, the second for staying within the envelope of a curved surface.
NODES_PER_AREA = 1.24
NODES_PER_BENDING = 0.31
BLENDING = 1.6
# And where it passes through itself, times crossing / diagonal.
CROSSING_NODES = 1_800
# All nodes: these, volume / h^3, and a layer graded from the surface inwards.
GRADED_NODES = 0.23
# Nine of ten runs had between 0.7 and 1.3 times the predicted nodes; without the bending, which is
# nil for boxes and large for limbs, between half and twice.
NODE_SPREAD = 1.5

# Seconds of fTetWild: NODE a node, and for following the surface, which a smaller epsilon makes
# longer by its power, TRIANGLE a triangle, DETAIL bending / diagonal and CROSSING crossing /
# diagonal (Suzanne, the Utah teapot and a cow, of 0.46, 0.57, 0.27). It is not deterministic:
# of 57 runs on nineteen shapes, edge lengths 0.03 to 0.08 and epsilons 0.001 and 0.003, 53 were
# within a factor of two, and the farthest off by 2.2.
NODE_SECONDS = 5.4e-4
TRIANGLE_SECONDS = 4.0e-4
DETAIL_SECONDS = 0.24
CROSSING_SECONDS = 6.0
FINENESS_EXPONENT = -0.5
USUAL_EPSILON = 0.003
TETRAHEDRALIZE_SPREAD = 2.0
# Starting the child process and what it imports.
START_SECONDS = 0.7

# Seconds for each tetrahedron to assemble, for each node to plan; by formulation.
ASSEMBLY_SECONDS = {LINEAR: 2e-6, SMOOTHED: 15e-6}
PLANNING_SECONDS = {LINEAR: 30e-6, SMOOTHED: 60e-6}
TETS_PER_NODE = 5.0
# Comparing with the mesh: seconds for each of its triangles and each surface node.
CHECK_SECONDS = 2.5e-5

# Bytes of the stiffness for each node, besides the elimination's.
STIFFNESS_BYTES = {LINEAR: 1_500, SMOOTHED: 7_000}

# The factor, of the bytes that computing it takes at most.
FACTOR_SHARE = 0.4

# A compressed table has about 3.3 MB for 1,000 free surface nodes at a tolerance of 0.001.
COMPRESSED_BYTES = 3.3e6
COMPRESSED_EXPONENTS = (1.3, -0.3)
# Bytes of a body file for each node of the mesh, besides the compliance.
MESH_BYTES = 300

# Edge lengths to offer when the set one takes too much memory.
COARSENING = 1.05
COARSEST_EDGE_LENGTH = 0.5


@dataclass(frozen=True)
class PowerLaw:
    """Power law ``scale * nodes^by_nodes * free_surface_nodes^by_surface``."""

    scale: float
    by_nodes: float
    by_surface: float

    def at(self, nodes: int, free_surface_nodes: int) -> float:
        """Value for a body."""
        return float(self.scale * nodes**self.by_nodes * free_surface_nodes**self.by_surface)


@dataclass(frozen=True)
class EliminationLaws:
    """Cost of eliminations, fitted to plans; shapes scatter by a factor of two.

    Attributes
    ----------
    table_weight, table_peak : time in floating point operations, and bytes, for the dense form.
    factor_weight, factor_peak : the same for the factor alone.
    """

    table_weight: PowerLaw
    table_peak: PowerLaw
    factor_weight: PowerLaw
    factor_peak: PowerLaw


ELIMINATION = {
    LINEAR: EliminationLaws(
        PowerLaw(2220.0, 1.80, 0.14),
        PowerLaw(258.0, 1.025, 0.59),
        PowerLaw(7010.0, 2.20, -0.58),
        PowerLaw(290.0, 1.155, 0.34),
    ),
    SMOOTHED: EliminationLaws(
        PowerLaw(676.0, 1.88, 0.35),
        PowerLaw(1780.0, 0.984, 0.45),
        PowerLaw(1210.0, 2.30, -0.30),
        PowerLaw(1164.0, 0.993, 0.46),
    ),
}


def estimate_cost(
    size: ShapeSize | MeshSize, settings: BakeSettings, available: int | None = None
) -> BakeCost:
    """Predicted cost of a bake. Quick enough for a panel once the machine's speed is known.

    Parameters
    ----------
    size : of the surface or of given tetrahedra.
    settings : as for the bake.
    available : bytes of memory; None to ignore them for ``form="auto"``.
    """
    if isinstance(size, MeshSize):
        cost = replace(_form_cost(size, settings, available), seconds_spread=2.0)
        return replace(cost, seconds=cost.seconds + sum(_assembly_seconds(size, settings)))
    mesh = predicted_mesh(size, settings)
    cost = _form_cost(mesh, settings, available)
    seconds = cost.seconds + sum(_assembly_seconds(mesh, settings))
    seconds += tetrahedralize_seconds(size, settings, mesh.nodes) + START_SECONDS
    return replace(cost, seconds=seconds, spread=NODE_SPREAD, seconds_spread=TETRAHEDRALIZE_SPREAD)


def rest_seconds(size: MeshSize, settings: BakeSettings) -> dict[str, float]:
    """Seconds of each step after tetrahedralization, before the elimination is planned."""
    assembly, planning = _assembly_seconds(size, settings)
    cost = _form_cost(size, settings, None)
    compressing = 0.0
    if cost.form == "compressed":
        laws = ELIMINATION[settings.formulation]
        factor = laws.factor_peak.at(size.nodes, cost.free_surface_nodes)
        compressing = compressing_flops(
            cost.free_surface_nodes, FACTOR_SHARE * factor
        ) / dgemm_rate(settings.threads)
    return {
        "stiffness": assembly,
        "plan": planning,
        "compliance": cost.seconds - compressing,
        "compress": compressing,
    }


def check_seconds(surface: Surface, mesh: TetMesh) -> float:
    """Seconds to compare a body with the surface it was made from."""
    return CHECK_SECONDS * (len(surface.triangles) + len(mesh.surface_nodes))


def edge_length_that_fits(size: ShapeSize, settings: BakeSettings, available: int) -> float | None:
    """Smallest edge length, from the set one upwards, whose bake fits the memory."""
    edge_length = settings.edge_length
    while edge_length <= COARSEST_EDGE_LENGTH:
        # Two digits, as a person would type.
        rounded = max(settings.edge_length, float(f"{edge_length:.2g}"))
        cost = estimate_cost(size, replace(settings, edge_length=rounded), available)
        if memory_refusal(cost, available) is None:
            return rounded
        edge_length *= COARSENING
    return None


def predicted_mesh(size: ShapeSize, settings: BakeSettings) -> MeshSize:
    """Predicted nodes and surface nodes of fTetWild's mesh."""
    length = settings.edge_length * size.diagonal
    # The envelope is not followed more finely than the given surface.
    finest = 0.5 * min(size.triangles, settings.decimate_above)
    curved = min(NODES_PER_BENDING * _bends(size) / (settings.epsilon * size.diagonal), finest)
    flat = NODES_PER_AREA * size.area / length**2
    surface_nodes = (flat**BLENDING + curved**BLENDING) ** (1 / BLENDING)
    surface_nodes += CROSSING_NODES * size.crossing / size.diagonal * _fineness(settings)
    nodes = (1 + GRADED_NODES) * surface_nodes + size.volume / length**3
    return MeshSize(max(4, round(nodes)), max(4, round(surface_nodes)))


def tetrahedralize_seconds(size: ShapeSize, settings: BakeSettings, nodes: int) -> float:
    """Seconds of fTetWild for a surface that becomes so many nodes."""
    triangles = min(size.triangles, settings.decimate_above)
    following = TRIANGLE_SECONDS * triangles
    following += (DETAIL_SECONDS * _bends(size) + CROSSING_SECONDS * size.crossing) / size.diagonal
    return float(NODE_SECONDS * nodes + following * _fineness(settings))


def _fineness(settings: BakeSettings) -> float:
    """How much more a smaller epsilon asks."""
    return float((settings.epsilon / USUAL_EPSILON) ** FINENESS_EXPONENT)


def _bends(size: ShapeSize) -> float:
    """Bending; as of a ball of this area and volume where it was not measured."""
    # Boxes bend less, limbs more.
    return size.area**2 / max(6 * size.volume, 1e-300) if size.bending is None else size.bending


def _assembly_seconds(size: MeshSize, settings: BakeSettings) -> tuple[float, float]:
    """Seconds to assemble the stiffness, and to plan its elimination."""
    tets = TETS_PER_NODE * size.nodes
    assembly = ASSEMBLY_SECONDS[settings.formulation] * tets
    return assembly, PLANNING_SECONDS[settings.formulation] * size.nodes


def _form_cost(size: MeshSize, settings: BakeSettings, available: int | None) -> BakeCost:
    """Cost of the elimination in the chosen form, or in that of ``auto``."""
    pinned = _pinned_share(settings.pins, size.surface_nodes)
    free = max(1, round(size.surface_nodes * (1 - pinned)))
    dense = _elimination_cost(size.nodes, free, settings, "dense")
    form = automatic_form(settings.form, dense, available)
    return dense if form == "dense" else _elimination_cost(size.nodes, free, settings, form)


def _elimination_cost(nodes: int, free: int, settings: BakeSettings, form: str) -> BakeCost:
    laws = ELIMINATION[settings.formulation]
    stiffness = STIFFNESS_BYTES[settings.formulation]
    table = float(BYTES_PER_PAIR * free**2)
    factor = laws.factor_peak.at(nodes, free)
    if form == "dense":
        flops = laws.table_weight.at(nodes, free)
        # In sheets and bars nearly all nodes are free surface nodes: the table outweighs the rest.
        peak = max(laws.table_peak.at(nodes, free), table + factor)
    else:
        flops = laws.factor_weight.at(nodes, free) + compressing_flops(free, FACTOR_SHARE * factor)
        peak = factor + COMPRESSING_SHARE * table
        by_nodes, by_tolerance = COMPRESSED_EXPONENTS
        fineness = (settings.tolerance / 1e-3) ** by_tolerance
        table = min(table, COMPRESSED_BYTES * (free / 1000) ** by_nodes * fineness)
    return BakeCost(
        nodes,
        free,
        flops / dgemm_rate(settings.threads),
        process_bytes(peak) + stiffness * nodes,
        int(table + MESH_BYTES * nodes),
        form,
    )


def _pinned_share(pins: Pins, surface_nodes: int) -> float:
    match pins:
        case PinBelow(fraction):
            # As if the surface were spread evenly over the height.
            return min(1.0, fraction)
        case PinCore() | NoPins():
            return 0.0
        case PinWeights(weights):
            return float(np.mean(weights >= 0.5)) if len(weights) else 0.0
        case PinNodes(nodes):
            return min(1.0, len(nodes) / surface_nodes)
