"""Cost of a bake, exact once its elimination is planned."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ...compliance.dense import BYTES_PER_PAIR
from ...compliance.elimination.plan import EliminationPlan
from ...machine.machine_speed import dgemm_rate

# Growth of a process over the planned peak, since freed memory is not all returned, and by what
# does not depend on the size: from 900 to 45,000 nodes both tell 1.05 times what was measured or
# more.
PROCESS_GROWTH = 1.1
PROCESS_BYTES = 50_000_000

# Interactions before rounding, as a share of the dense table.
COMPRESSING_SHARE = 0.1
# Floating point operations to compress, a node and a byte of the factor: each cluster of columns
# multiplies all of it.
COMPRESSING_FLOPS = 1.0


@dataclass(frozen=True)
class BakeCost:
    """Cost of a bake.

    Attributes
    ----------
    nodes, free_surface_nodes : of the tetrahedra.
    seconds : from the start to the body.
    peak_bytes : of memory.
    file_bytes : of the body file.
    form : of the compliance, ``dense`` or ``compressed``.
    spread : factor, either way, within which the true number of nodes lies in nine of ten cases; 1
        where it is known. Memory goes about with its square.
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


def planned_cost(plan: EliminationPlan, form: str, threads: int | None = None) -> BakeCost:
    """Cost of computing a compliance by its planned elimination."""
    nodes, free = plan.matrix.node_count, len(plan.free_surface)
    table = BYTES_PER_PAIR * free**2
    if form == "dense":
        return BakeCost(
            nodes,
            free,
            plan.weight / dgemm_rate(threads),
            process_bytes(plan.peak_bytes),
            table,
            form,
        )
    factor = replace(plan, table_itemsize=0)
    flops = factor.weight + compressing_flops(free, factor.factor_bytes)
    peak = process_bytes(factor.peak_bytes + COMPRESSING_SHARE * table)
    return BakeCost(nodes, free, flops / dgemm_rate(threads), peak, 0, form)


def process_bytes(peak: float) -> int:
    """By how many bytes a process grows that holds so many at its peak."""
    return int(PROCESS_GROWTH * peak + PROCESS_BYTES)


def compressing_flops(free: int, factor_bytes: float) -> float:
    """Floating point operations to compress the table of so many nodes, from a factor of bytes."""
    return COMPRESSING_FLOPS * free * factor_bytes
