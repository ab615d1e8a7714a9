"""What a bake will cost, told before it starts: nodes, time, memory, size of the file.

From a surface these are predictions, since fTetWild does not make the same tetrahedra twice; once
the elimination is planned, memory and arithmetic are known exactly. The figures below were fitted
to fTetWild's runs on seven shapes (cube, plate, bar, sphere, capsule, torus, plush mouse), with
edge lengths from 0.0175 to 0.1 of the diagonal and epsilons from 0.001 to 0.01, and to the plans of
their bodies.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..compliance.dense import BYTES_PER_PAIR
from ..compliance.elimination.plan import EliminationPlan
from ..errors import PalpateError
from ..machine.machine_speed import dgemm_rate
from ..mesh.surface import Surface
from ..mesh.tet_mesh import TetMesh
from ..mesh.winding_volume import enclosed_volume
from ..sentence import Sentence
from ..stiffness.formulation import LINEAR, formulation_for
from ..stiffness.pins import PinBelow, PinNodes, Pins, PinWeights
from .settings import BakeSettings

# A dense table of more bytes is compressed when the form is left open.
LARGEST_AUTOMATIC_TABLE = 300_000_000

# Surface nodes, for an edge length h and an envelope e in metres:
# ((1.24 area / h^2)^1.6 + (0.31 bending / e)^1.6)^(1/1.6). The first is what equilateral triangles
# ask for, the second what it takes to stay within the envelope where the surface is curved.
NODES_PER_AREA = 1.24
NODES_PER_BENDING = 0.31
BLENDING = 1.6
# All nodes are these and volume / h^3, and a layer that grades from the surface inwards.
GRADED_NODES = 0.23
# Nine of ten runs had between 0.7 and 1.3 times the nodes so predicted; without the bending, which
# is nil for boxes and large for limbs, between half and twice of them.
NODE_SPREAD = 1.5

# Edges sharper than this are edges of the shape, which need no finer triangles.
SHARP_EDGE = np.radians(60.0)

# Seconds of fTetWild: 6.5e-6 triangles^0.93 epsilon^-0.64 nodes^0.3, within a factor of three.
TETRAHEDRALIZE_SCALE = 6.5e-6
TETRAHEDRALIZE_EXPONENTS = (0.93, -0.64, 0.30)
TETRAHEDRALIZE_SPREAD = 3.0

# Seconds for each tetrahedron to assemble, for each node to plan; by formulation.
ASSEMBLY_SECONDS = {LINEAR: 2e-6, "smoothed": 15e-6}
PLANNING_SECONDS = {LINEAR: 30e-6, "smoothed": 60e-6}
TETS_PER_NODE = 5.0
# Comparing with the mesh: seconds for each of its triangles and each surface node.
CHECK_SECONDS = 2.5e-5

# A process grows by more than is asked for at once: freed memory is not all given back. Measured,
# from 1,000 to 46,000 nodes: by up to 1.31 times as much.
PROCESS_GROWTH = 1.35

# Bytes of the stiffness for each node, beside what the elimination holds.
STIFFNESS_BYTES = {LINEAR: 1_500, "smoothed": 7_000}

# A compressed table has about 3.3 MB for 1,000 free surface nodes at a tolerance of 0.001.
COMPRESSED_BYTES = 3.3e6
COMPRESSED_EXPONENTS = (1.3, -0.3)
# Couplings before they are rounded, as a share of the dense table.
COMPRESSING_SHARE = 0.1
# Floating point operations to compress: each cluster of columns multiplies the whole factor.
COMPRESSING_FLOPS = 0.4

# What a body file holds besides the compliance, for each node of the mesh.
MESH_BYTES = 300

# Edge lengths that are offered when the one that is set takes too much memory.
COARSENING = 1.05
COARSEST_EDGE_LENGTH = 0.5


@dataclass(frozen=True)
class PowerLaw:
    """``scale * nodes^by_nodes * free_surface_nodes^by_surface``."""

    scale: float
    by_nodes: float
    by_surface: float

    def at(self, nodes: int, free_surface_nodes: int) -> float:
        """Its value for a body."""
        return float(self.scale * nodes**self.by_nodes * free_surface_nodes**self.by_surface)


@dataclass(frozen=True)
class EliminationLaws:
    """What eliminations take, fitted to plans; shapes scatter by a factor of two.

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
        PowerLaw(5350.0, 0.71, 0.59),
        PowerLaw(7010.0, 2.20, -0.58),
        PowerLaw(400.0, 1.14, 0.34),
    ),
    "smoothed": EliminationLaws(
        PowerLaw(676.0, 1.88, 0.35),
        PowerLaw(3650.0, 0.93, 0.45),
        PowerLaw(1210.0, 2.30, -0.30),
        PowerLaw(554.0, 1.10, 0.46),
    ),
}


@dataclass(frozen=True)
class ShapeSize:
    """What the cost of a surface's bake depends on.

    Attributes
    ----------
    area : of the surface, square metres.
    volume : that it encloses, cubic metres.
    diagonal : of its bounding box, metres.
    triangles : how many it has.
    bending : see :func:`bending`, metres; None to assume a body as round as its volume allows.
    """

    area: float
    volume: float
    diagonal: float
    triangles: int
    bending: float | None = None

    @classmethod
    def of(cls, surface: Surface) -> ShapeSize:
        """Measure a surface; for open or overlapping ones this takes up to a second."""
        welded = surface.welded()
        return cls(
            float(welded.areas.sum()),
            enclosed_volume(welded),
            welded.diagonal,
            len(welded.triangles),
            bending(welded),
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
        nine of ten cases; 1 where it is known. Memory goes about with its square.
    seconds_spread : the same for the time.
    """

    nodes: int
    free_surface_nodes: int
    seconds: float
    peak_bytes: int
    file_bytes: int
    form: str
    spread: float = 1.0
    seconds_spread: float = 1.0


def bending(surface: Surface) -> float:
    """How much the surface curves in all, metres: half of edge length times angle, summed.

    On a smooth surface that is the integral of the mean curvature. Sharp edges do not count.
    """
    triangles = surface.triangles
    i, j, k = (surface.vertices[triangles[:, corner]] for corner in range(3))
    normals = np.cross(j - i, k - i)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    starts, ends = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    edge = np.minimum(starts, ends) * len(surface.vertices) + np.maximum(starts, ends)
    order = np.argsort(edge)
    first, second = order[:-1], order[1:]
    paired = edge[first] == edge[second]
    first, second = first[paired], second[paired]
    cosine = np.einsum("ex,ex->e", normals[first // 3], normals[second // 3])
    # Faces that look opposite ways do so by their winding, as a rule.
    angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
    along = surface.vertices[ends[first]] - surface.vertices[starts[first]]
    lengths = np.linalg.norm(along, axis=1)
    return float(0.5 * (lengths * angle)[angle < SHARP_EDGE].sum())


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
        cost = replace(_form_cost(size, settings, available), seconds_spread=2.0)
        return replace(cost, seconds=cost.seconds + sum(_assembly_seconds(size, settings)))
    mesh = _predicted_mesh(size, settings)
    cost = _form_cost(mesh, settings, available)
    seconds = cost.seconds + sum(_assembly_seconds(mesh, settings))
    seconds += _tetrahedralize_seconds(size, settings, mesh.nodes)
    return replace(cost, seconds=seconds, spread=NODE_SPREAD, seconds_spread=TETRAHEDRALIZE_SPREAD)


def rest_seconds(size: MeshSize, settings: BakeSettings) -> dict[str, float]:
    """What each step will take once there are tetrahedra, before their elimination is planned."""
    assembly, planning = _assembly_seconds(size, settings)
    cost = _form_cost(size, settings, None)
    compressing = 0.0
    if cost.form == "compressed":
        laws = _laws(settings)
        factor = laws.factor_peak.at(size.nodes, cost.free_surface_nodes)
        compressing = _compressing_flops(cost.free_surface_nodes, factor) / dgemm_rate(
            settings.threads
        )
    return {
        "stiffness": assembly,
        "plan": planning,
        "compliance": cost.seconds - compressing,
        "compress": compressing,
    }


def check_seconds(surface: Surface, mesh: TetMesh) -> float:
    """What comparing a body with the surface it was made from will take."""
    return CHECK_SECONDS * (len(surface.triangles) + len(mesh.surface_nodes))


def planned_cost(plan: EliminationPlan, form: str, threads: int | None = None) -> BakeCost:
    """What computing a compliance takes from here on, when its elimination is planned."""
    nodes, free = plan.matrix.node_count, len(plan.free_surface)
    table = BYTES_PER_PAIR * free**2
    if form == "dense":
        return BakeCost(
            nodes,
            free,
            plan.weight / dgemm_rate(threads),
            int(PROCESS_GROWTH * plan.peak_bytes),
            table,
            form,
        )
    factor = replace(plan, table_itemsize=0)
    flops = factor.weight + _compressing_flops(free, factor.peak_bytes)
    peak = int(PROCESS_GROWTH * factor.peak_bytes + COMPRESSING_SHARE * table)
    return BakeCost(nodes, free, flops / dgemm_rate(threads), peak, 0, form)


def automatic_form(form: str, dense: BakeCost, available: int | None) -> str:
    """The form that ``auto`` stands for: ``dense`` unless its table is large or does not fit."""
    if form != "auto":
        return form
    too_large = BYTES_PER_PAIR * dense.free_surface_nodes**2 > LARGEST_AUTOMATIC_TABLE
    does_not_fit = available is not None and dense.peak_bytes > available
    return "compressed" if too_large or does_not_fit else "dense"


def affordable_form(
    plan: EliminationPlan, settings: BakeSettings, available: int
) -> tuple[str, list[Sentence]]:
    """The form to compute, and what to tell the maker about its choice.

    Raises
    ------
    PalpateError
        The memory does not suffice; with the remedy.
    """
    dense = planned_cost(plan, "dense", settings.threads)
    compressed = planned_cost(plan, "compressed", settings.threads)
    chosen = automatic_form(settings.form, dense, available)
    cost = dense if chosen == "dense" else compressed
    refusal = memory_refusal(cost, available, compressed)
    if refusal is not None:
        raise PalpateError(refusal)
    warnings = []
    if settings.form == "auto" and chosen == "compressed" and dense.peak_bytes > available:
        warnings.append(
            Sentence(
                "the compliance was compressed, since whole it would have taken {needed} of "
                "memory, and {available} could be had",
                needed=_memory(dense.peak_bytes),
                available=_memory(available),
            )
        )
    return chosen, warnings


def memory_refusal(
    cost: BakeCost, available: int, compressed: BakeCost | None = None
) -> Sentence | None:
    """Why a bake must not start, with the remedy; None where the memory suffices.

    ``compressed`` is what the compressed form would cost: it is only offered where it would fit.
    """
    if cost.peak_bytes <= available:
        return None
    would_fit = compressed is None or compressed.peak_bytes <= available
    remedy = Sentence("use a larger edge length")
    if cost.form == "dense" and would_fit:
        remedy = Sentence("choose the compressed form or use a larger edge length")
    return Sentence(
        "bake: {count:,} free surface nodes take {needed} of memory, and {available} can be had; "
        "{remedy}",
        count=cost.free_surface_nodes,
        needed=_memory(cost.peak_bytes),
        available=_memory(available),
        remedy=remedy,
    )


def _memory(count: int) -> str:
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{max(1, round(count / 1e6))} MB"


def edge_length_that_fits(size: ShapeSize, settings: BakeSettings, available: int) -> float | None:
    """The smallest edge length, from the one that is set upwards, whose bake fits the memory."""
    edge_length = settings.edge_length
    while edge_length <= COARSEST_EDGE_LENGTH:
        # Two digits are what a person would type.
        rounded = max(settings.edge_length, float(f"{edge_length:.2g}"))
        cost = estimate_cost(size, replace(settings, edge_length=rounded), available)
        if memory_refusal(cost, available) is None:
            return rounded
        edge_length *= COARSENING
    return None


def _predicted_mesh(size: ShapeSize, settings: BakeSettings) -> MeshSize:
    """Nodes and surface nodes that fTetWild will make."""
    length = settings.edge_length * size.diagonal
    # A ball of this area and volume bends by area^2 / (3 volume); boxes less, limbs more.
    bends = size.area**2 / max(6 * size.volume, 1e-300) if size.bending is None else size.bending
    # The envelope is not followed more finely than the surface that is handed over.
    finest = 0.5 * min(size.triangles, settings.decimate_above)
    curved = min(NODES_PER_BENDING * bends / (settings.epsilon * size.diagonal), finest)
    flat = NODES_PER_AREA * size.area / length**2
    surface_nodes = (flat**BLENDING + curved**BLENDING) ** (1 / BLENDING)
    nodes = (1 + GRADED_NODES) * surface_nodes + size.volume / length**3
    return MeshSize(max(4, round(nodes)), max(4, round(surface_nodes)))


def _tetrahedralize_seconds(size: ShapeSize, settings: BakeSettings, nodes: int) -> float:
    triangles = min(size.triangles, settings.decimate_above)
    by_triangles, by_epsilon, by_nodes = TETRAHEDRALIZE_EXPONENTS
    shell = triangles**by_triangles * settings.epsilon**by_epsilon
    return float(TETRAHEDRALIZE_SCALE * shell * nodes**by_nodes)


def _assembly_seconds(size: MeshSize, settings: BakeSettings) -> tuple[float, float]:
    """To assemble the stiffness, and to plan its elimination."""
    formulation = formulation_for(settings.formulation, settings.poisson_ratio)
    tets = TETS_PER_NODE * size.nodes
    return ASSEMBLY_SECONDS[formulation] * tets, PLANNING_SECONDS[formulation] * size.nodes


def _form_cost(size: MeshSize, settings: BakeSettings, available: int | None) -> BakeCost:
    """The elimination's cost, in the form that is asked for or, by itself, the one that suits."""
    pinned = _pinned_share(settings.pins, size.surface_nodes)
    free = max(1, round(size.surface_nodes * (1 - pinned)))
    dense = _elimination_cost(size.nodes, free, settings, "dense")
    form = automatic_form(settings.form, dense, available)
    return dense if form == "dense" else _elimination_cost(size.nodes, free, settings, form)


def _elimination_cost(nodes: int, free: int, settings: BakeSettings, form: str) -> BakeCost:
    laws = _laws(settings)
    stiffness = STIFFNESS_BYTES[formulation_for(settings.formulation, settings.poisson_ratio)]
    table = float(BYTES_PER_PAIR * free**2)
    factor = laws.factor_peak.at(nodes, free)
    if form == "dense":
        flops = laws.table_weight.at(nodes, free)
        # Of sheets and bars, nearly all nodes are free surface nodes: the table outweighs the rest.
        peak = max(laws.table_peak.at(nodes, free), table + factor)
    else:
        flops = laws.factor_weight.at(nodes, free) + _compressing_flops(free, factor)
        peak = factor + COMPRESSING_SHARE * table
        by_nodes, by_tolerance = COMPRESSED_EXPONENTS
        fineness = (settings.tolerance / 1e-3) ** by_tolerance
        table = min(table, COMPRESSED_BYTES * (free / 1000) ** by_nodes * fineness)
    return BakeCost(
        nodes,
        free,
        flops / dgemm_rate(settings.threads),
        int(PROCESS_GROWTH * peak + stiffness * nodes),
        int(table + MESH_BYTES * nodes),
        form,
    )


def _compressing_flops(free: int, factor_bytes: float) -> float:
    return COMPRESSING_FLOPS * free * factor_bytes


def _laws(settings: BakeSettings) -> EliminationLaws:
    return ELIMINATION[formulation_for(settings.formulation, settings.poisson_ratio)]


def _pinned_share(pins: Pins, surface_nodes: int) -> float:
    match pins:
        case PinBelow(fraction):
            # As if the surface were spread evenly over the height.
            return min(1.0, fraction)
        case PinWeights(weights):
            return float(np.mean(weights >= 0.5)) if len(weights) else 0.0
        case PinNodes(nodes):
            return min(1.0, len(nodes) / surface_nodes)
