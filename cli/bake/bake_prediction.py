"""``palpate bake --predict``: predicted cost of a bake."""

from __future__ import annotations

import argparse
import dataclasses
import json
from pathlib import Path

from ...core.bake.cost.bake_cost import BakeCost
from ...core.bake.cost.memory import memory_refusal
from ...core.bake.cost.prediction import estimate_cost
from ...core.machine.available_memory import available_memory
from .bake_options import bake_input
from .forecast import sentence, size_of


def run(arguments: argparse.Namespace) -> int:
    """Print a prediction for each mesh."""
    available = available_memory()
    predictions = {mesh: _predicted(arguments, mesh, available) for mesh in arguments.meshes}
    if arguments.json:
        figures = [_figures(mesh, cost, available) for mesh, cost in predictions.items()]
        print(json.dumps({"predictions": figures}))
        return 0
    for mesh, cost in predictions.items():
        print(sentence(mesh, cost))
        refusal = memory_refusal(cost, available)
        if refusal is not None:
            print(f"  {refusal}")
    return 0


def _predicted(arguments: argparse.Namespace, mesh: Path, available: int) -> BakeCost:
    given = bake_input(arguments, mesh, arguments.threads)
    return estimate_cost(size_of(given), given.settings, available)


def _figures(mesh: Path, cost: BakeCost, available: int) -> dict[str, object]:
    return {
        "mesh": str(mesh),
        **dataclasses.asdict(cost),
        "available_bytes": available,
        "refusal": memory_refusal(cost, available),
    }
