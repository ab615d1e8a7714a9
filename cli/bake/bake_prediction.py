"""``palpate bake --predict``: predicted cost of a bake."""

from __future__ import annotations

import argparse
import dataclasses
import json
from pathlib import Path

from ...core.bake.cost.bake_cost import BakeCost
from ...core.bake.cost.memory import memory_refusal
from ...core.bake.cost.prediction import estimate_cost
from ...core.bake.cost.size import MeshSize, ShapeSize
from ...core.machine.available_memory import available_memory
from ...core.mesh.surface import Surface
from .bake_options import bake_input
from .status_line import duration


def run(arguments: argparse.Namespace) -> int:
    """Print a prediction for each mesh."""
    available = available_memory()
    predictions = {mesh: _predicted(arguments, mesh, available) for mesh in arguments.meshes}
    if arguments.json:
        figures = [_figures(mesh, cost, available) for mesh, cost in predictions.items()]
        print(json.dumps({"predictions": figures}))
        return 0
    for mesh, cost in predictions.items():
        print(_sentence(mesh, cost))
        refusal = memory_refusal(cost, available)
        if refusal is not None:
            print(f"  {refusal}")
    return 0


def _predicted(arguments: argparse.Namespace, mesh: Path, available: int) -> BakeCost:
    given = bake_input(arguments, mesh, arguments.threads)
    source = given.source
    size = ShapeSize.of(source) if isinstance(source, Surface) else MeshSize.of(source)
    return estimate_cost(size, given.settings, available)


def _figures(mesh: Path, cost: BakeCost, available: int) -> dict[str, object]:
    return {
        "mesh": str(mesh),
        **dataclasses.asdict(cost),
        "available_bytes": available,
        "refusal": memory_refusal(cost, available),
    }


def _sentence(mesh: Path, cost: BakeCost) -> str:
    return (
        f"{mesh}: {cost.nodes:,} nodes, {cost.free_surface_nodes:,} free on the surface"
        f"{_within(cost.spread)}; {cost.form}, about {duration(max(1.0, cost.seconds))}"
        f"{_within(cost.seconds_spread)}, {_size(cost.peak_bytes)} of memory, "
        f"a file of {_size(cost.file_bytes)}"
    )


def _within(spread: float) -> str:
    return "" if spread == 1 else f" (within a factor of {spread:g})"


def _size(count: int) -> str:
    """Bytes in readable units, three digits."""
    return f"{count / 1e9:.3g} GB" if count >= 1e9 else f"{count / 1e6:.3g} MB"
