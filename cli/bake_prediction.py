"""``palpate bake --predict``: what a bake would take, before it starts."""

from __future__ import annotations

import argparse
import dataclasses
import json
from pathlib import Path

from ..core.available_memory import available_memory
from ..core.bake_cost import MeshSize, ShapeSize, estimate_cost, memory_refusal
from ..core.surface import Surface
from .bake_options import bake_input
from .body_figures import as_lines


def run(arguments: argparse.Namespace) -> int:
    """Print a prediction for each mesh."""
    predictions = [_prediction(arguments, mesh) for mesh in arguments.meshes]
    if arguments.json:
        print(json.dumps({"predictions": predictions}))
        return 0
    print("\n\n".join(as_lines(prediction) for prediction in predictions))
    return 0


def _prediction(arguments: argparse.Namespace, mesh: Path) -> dict[str, object]:
    given = bake_input(arguments, mesh, arguments.threads)
    source = given.source
    size = ShapeSize.of(source) if isinstance(source, Surface) else MeshSize.of(source)
    available = available_memory()
    cost = estimate_cost(size, given.settings, available)
    return {
        "mesh": str(mesh),
        **dataclasses.asdict(cost),
        "available_bytes": available,
        "refusal": memory_refusal(cost, available),
    }
