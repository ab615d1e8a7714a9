"""Started in a Blender as a module by `benchmarks/drawn/large_mesh.py`: PACKAGE and vertex counts.

Prints a line of JSON for each count: milliseconds, of the thread's processor time and by the clock.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import tempfile
import time
from collections.abc import Callable
from types import ModuleType

import numpy as np

os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp(prefix="palpate-large-mesh-")

# It reads its user folder when it is imported.
import bpy

MODULE = "bl_ext.user_default.palpate"
RUNS = 5


def part(name: str) -> ModuleType:
    """A module of the installed package."""
    return importlib.import_module(f"{MODULE}.{name}")


def ball(count: int) -> bpy.types.Object:
    """A ball of about so many vertices, mostly quadrilaterals."""
    rings = round((count / 2) ** 0.5)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=2 * rings, ring_count=rings, radius=0.1)
    return bpy.context.object


def times(work: Callable[[], object], runs: int = RUNS) -> tuple[float, float]:
    """Median milliseconds of a call, by the processor and by the clock."""
    found = np.empty((runs, 2))
    for row in found:
        begun = time.process_time(), time.perf_counter()
        work()
        row[:] = time.process_time() - begun[0], time.perf_counter() - begun[1]
    processor, clock = np.median(1e3 * found, axis=0).tolist()
    return processor, clock


def measured(count: int) -> dict[str, object]:
    """What the panel and a press take of a ball."""
    thing, scene = ball(count), bpy.context.scene
    thing.palpate.edge_length = 0.08
    known, looks = part("addon.known_status"), part("operators.object.mesh_look")
    part("core.machine.machine_speed").dgemm_rate(None)
    look = looks.MeshLook.take(thing, scene)
    figures: dict[str, object] = {
        "vertices": len(thing.data.vertices),
        "copy": times(lambda: looks.MeshLook.take(thing, scene)),
        "measure": times(look.measured, 2),
    }
    known.prediction(thing, scene)

    def move() -> None:
        thing.location.x += 0.01
        bpy.context.view_layer.update()
        known.changed(bpy.context.evaluated_depsgraph_get())
        known.body_status(thing, scene)
        known.prediction(thing, scene)

    figures["redraw after a move"] = times(move)
    bpy.ops.palpate.make_soft()
    drawn_body = part("operators.object.drawn_body")
    figures["start of the first press"] = times(lambda: drawn_body.open_body(thing, scene), 1)
    figures["start of a press"] = times(lambda: drawn_body.open_body(thing, scene))
    drawn = drawn_body.open_body(thing, scene)
    moves = 1e-4 * np.random.default_rng(15).normal(size=(drawn.body.compliance.node_count, 3))
    figures["displacements"] = times(lambda: drawn.drawn_displacement(moves, (), drawn.canvas), 20)
    bpy.data.objects.remove(thing)
    return figures


def main() -> None:
    """Install the package and measure."""
    bpy.ops.extensions.package_install_files(
        filepath=sys.argv[1], repo="user_default", enable_on_install=True
    )
    for count in sys.argv[2:]:
        print(json.dumps(measured(int(count))), flush=True)


main()
