"""Played in the windowed Blender by `benchmarks/drawn/redraw.py`, with vertex counts.

Milliseconds of the processor, of all threads, medians: of what hands a step over (own), of
evaluating the mesh, and of drawing it; megabytes of memory that the system hands out page by page
for the first two. Drawing in software goes on in threads of its own after Blender has asked for it:
each step begins when these are done.
"""

from __future__ import annotations

import resource
import time
from collections.abc import Callable

import bpy
import numpy as np
from numpy.typing import NDArray
from stage import Stage, Wait

from bl_ext.user_default.palpate.core.contact.tool.pose import Pose
from bl_ext.user_default.palpate.core.contact.tool.tool_dent import PressingTool
from bl_ext.user_default.palpate.core.contact.tool.tools import sphere
from bl_ext.user_default.palpate.operators.layer import live_layer
from bl_ext.user_default.palpate.operators.object import drawn_body

STEPS = 9
# Drawing is over when all threads together spend less than this share of a core.
SECONDS_OF_REST, IDLE = 0.05, 0.02
GRAB = "brushes/essentials_brushes-mesh_sculpt.blend/Brush/Elastic Grab"
Step = Callable[[int], object]


def a_step_is_drawn(stage: Stage) -> Wait:
    """Steps of a layer, a shape key and a sculpting stroke, noted by the counts of vertices."""
    stage.area.spaces.active.show_gizmo = False
    stage.area.spaces.active.overlay.show_overlays = False
    for count in map(int, stage.arguments):
        yield from _ball(stage, count)
        thing = bpy.context.object
        figures = {"vertices": len(thing.data.vertices)}
        figures["layer"] = _steps(stage, _layer(thing))
        live_layer.remove(thing)
        figures["shape key"] = _steps(stage, _shape_key(thing))
        thing.shape_key_clear()
        figures["elastic grab"] = _grabbed(stage)
        stage.note(**{str(count): figures})
        yield


def _ball(stage: Stage, count: int) -> Wait:
    """A soft ball of about so many vertices."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    thing = bpy.data.objects.new("Ball", _round_mesh(round((count / 2) ** 0.5), 0.1))
    bpy.context.collection.objects.link(thing)
    bpy.context.view_layer.objects.active = thing
    thing.select_set(True)
    thing.palpate.edge_length, thing.palpate.decimate_above = 0.08, 1000
    # No finer vertices than the shape key has.
    thing.palpate.bake_from = "BASE"
    bpy.ops.palpate.make_soft()
    with stage.view():
        bpy.ops.view3d.view_selected()
    yield


def _round_mesh(rings: int, radius: float) -> bpy.types.Mesh:
    """A sphere of quads, 2 `rings` around, triangles at its poles.

    Blender's own operator also lays out a UV map, which took longer than all that is measured.
    """
    around = 2 * rings
    polar = np.linspace(0.0, np.pi, rings + 1)[1:-1, None]
    turn = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)[None]
    height = np.cos(polar) + 0.0 * turn
    rows = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), height], axis=2)
    poles = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]
    number = np.arange(rows[..., 0].size).reshape(rings - 1, around)
    beside = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], number[1:], beside[1:], beside[:-1]], axis=2)
    top, bottom = number.size, number.size + 1
    caps = [(top, *pair) for pair in zip(number[0].tolist(), beside[0].tolist(), strict=True)]
    caps += [(bottom, *pair) for pair in zip(beside[-1].tolist(), number[-1].tolist(), strict=True)]
    mesh = bpy.data.meshes.new("Ball")
    vertices = radius * np.concatenate([rows.reshape(-1, 3), poles])
    mesh.from_pydata(vertices.tolist(), [], quads.reshape(-1, 4).tolist() + caps)
    return mesh


def _layer(thing: bpy.types.Object) -> Step:
    drawn = drawn_body.open_body(thing, bpy.context.scene)
    live_layer.hang(thing)
    rng = np.random.default_rng(15)
    moves = 1e-3 * rng.normal(size=(drawn.body.compliance.node_count, 3))
    # A fingertip, out of which vertices are kept, 2 mm deep in the side: at the poles the ball has
    # more vertices than anywhere.
    at, outward = np.array([0.108, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])
    tip = PressingTool(sphere(0.01), Pose.at(at), outward)

    def step(number: int) -> None:
        grown = moves * (1 + 0.1 * number)
        live_layer.write(thing, drawn.drawn_displacement(grown, (tip,), drawn.canvas))

    return step


def _shape_key(thing: bpy.types.Object) -> Step:
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Press")
    key.value = 1.0
    places = np.empty(3 * len(thing.data.vertices), dtype=np.float32)
    key.points.foreach_get("co", places)

    def step(number: int) -> None:
        key.points.foreach_set("co", places * np.float32(1 + 0.001 * number))
        thing.data.update_tag()

    return step


def _grabbed(stage: Stage) -> dict[str, float]:
    """A stroke of many steps, each of which is evaluated by itself; drawn at its end."""
    with stage.view():
        bpy.ops.object.mode_set(mode="SCULPT")
        bpy.ops.brush.asset_activate(
            asset_library_type="ESSENTIALS", relative_asset_identifier=GRAB
        )
        region = stage.region("WINDOW")
        x, y = region.width / 2, region.height / 2
        path = [
            {
                "name": "",
                "location": (0.0, 0.0, 0.0),
                "mouse": (x + 3 * number, y),
                "mouse_event": (x + 3 * number, y),
                "pressure": 1.0,
                "size": 100.0,
                "is_start": number == 0,
                "time": 0.1 * number,
                "x_tilt": 0.0,
                "y_tilt": 0.0,
            }
            for number in range(STEPS + 1)
        ]
        before = _places()
        # The first stroke prepares what later ones have.
        bpy.ops.sculpt.brush_stroke(stroke=path, mode="NORMAL")
        begun = time.process_time()
        bpy.ops.sculpt.brush_stroke(stroke=path, mode="NORMAL")
        own = (time.process_time() - begun) / STEPS
        drawing = _cost(_draw)
        bpy.ops.object.mode_set(mode="OBJECT")
    if np.array_equal(_places(), before):
        raise RuntimeError("the stroke moved nothing")
    return {
        "own": 1e3 * own,
        "evaluation": 0.0,
        "drawing": 1e3 * drawing,
        "fresh for own": 0.0,
        "fresh for evaluation": 0.0,
    }


def _steps(stage: Stage, step: Step) -> dict[str, float]:
    found, handed = [], []
    with stage.view():
        _draw()
        for number in range(STEPS):
            before = _fresh_memory()
            own = _cost(lambda number=number: step(number))
            between = _fresh_memory()
            evaluation = _cost(bpy.context.view_layer.update)
            handed.append(np.diff([before, between, _fresh_memory()]))
            found.append((own, evaluation, _cost(_draw)))
    medians = 1e3 * np.median(found, axis=0)
    figures = dict(zip(("own", "evaluation", "drawing"), medians.tolist(), strict=True))
    fresh = np.median(handed, axis=0).tolist()
    return figures | dict(zip(("fresh for own", "fresh for evaluation"), fresh, strict=True))


def _fresh_memory() -> float:
    """Megabytes that the system has handed to this process page by page."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt * resource.getpagesize() / 1e6


def _places() -> NDArray[np.float32]:
    vertices = bpy.context.object.data.vertices
    places = np.empty(3 * len(vertices), dtype=np.float32)
    vertices.foreach_get("co", places)
    return places


def _draw() -> None:
    """Draw, to the end."""
    bpy.ops.wm.redraw_timer(type="DRAW", iterations=1)
    while _cost(lambda: time.sleep(SECONDS_OF_REST)) > IDLE * SECONDS_OF_REST:
        pass


def _cost(work: Callable[[], object]) -> float:
    """Seconds of the processor."""
    begun = time.process_time()
    work()
    return time.process_time() - begun
