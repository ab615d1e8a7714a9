"""What a bake will take, said before it starts if it is much."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

from ...core.bake.cost.bake_cost import BakeCost
from ...core.bake.cost.memory import memory_refusal
from ...core.bake.cost.prediction import edge_length_that_fits, estimate_cost
from ...core.bake.cost.size import MeshSize, ShapeSize
from ...core.errors import PalpateError
from ...core.machine.available_memory import available_memory
from ...core.mesh.surface import Surface
from .bake_options import BakeInput
from .status_line import duration

# Seconds and memory, as a share of what there is, from which on a bake is announced.
LONG_SECONDS = 60.0
LARGE_SHARE = 0.5
# A coarser mesh that is offered instead.
COARSER = 2.0


def size_of(given: BakeInput) -> ShapeSize | MeshSize:
    """Size that the cost of a bake depends on."""
    source = given.source
    return ShapeSize.of(source) if isinstance(source, Surface) else MeshSize.of(source)


def foretell(mesh: Path, given: BakeInput) -> None:
    """Announce a bake that is long or large.

    Raises
    ------
    PalpateError
        It would not fit the memory even if the prediction errs as far as it may.
    """
    size, available = size_of(given), available_memory()
    cost = estimate_cost(size, given.settings, available)
    if isinstance(size, ShapeSize):
        _refuse_too_large(mesh, size, given, cost, available)
    if cost.seconds >= LONG_SECONDS or cost.peak_bytes >= LARGE_SHARE * available:
        print(f"palpate: {sentence(mesh, cost)}{_quicker(size, given)}", file=sys.stderr)


def sentence(mesh: Path, cost: BakeCost) -> str:
    """The cost of a mesh's bake in a line."""
    return (
        f"{mesh}: {cost.nodes:,} nodes, {cost.free_surface_nodes:,} free on the surface"
        f"{_within(cost.spread)}; {cost.form}, about {duration(max(1.0, cost.seconds))}"
        f"{_within(cost.seconds_spread)}, {readable_bytes(cost.peak_bytes)} of memory, "
        f"a file of {readable_bytes(cost.file_bytes)}"
    )


def _refuse_too_large(
    mesh: Path, size: ShapeSize, given: BakeInput, cost: BakeCost, available: int
) -> None:
    # Memory goes about with the square of the nodes.
    least = replace(cost, peak_bytes=int(cost.peak_bytes / cost.spread**2))
    if memory_refusal(least, available) is None:
        return
    fitting = edge_length_that_fits(size, given.settings, available)
    remedy = "simplify the mesh" if fitting is None else f"use --edge-length {fitting:g} or more"
    raise PalpateError(
        f"{mesh}: about {cost.nodes:,} nodes would take {readable_bytes(cost.peak_bytes)} of "
        f"memory, and {readable_bytes(available)} can be had; {remedy}"
    )


def _quicker(size: ShapeSize | MeshSize, given: BakeInput) -> str:
    if isinstance(size, MeshSize):
        return ""
    coarser = replace(given.settings, edge_length=COARSER * given.settings.edge_length)
    seconds = max(1.0, estimate_cost(size, coarser).seconds)
    return f"; with --edge-length {coarser.edge_length:g} about {duration(seconds)}"


def _within(spread: float) -> str:
    return "" if spread == 1 else f" (within a factor of {spread:g})"


def readable_bytes(count: int) -> str:
    """Bytes in readable units, three digits."""
    return f"{count / 1e9:.3g} GB" if count >= 1e9 else f"{count / 1e6:.3g} MB"
