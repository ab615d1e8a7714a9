"""A model that nobody here has seen, made soft with defaults and dragged at in the window."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from random_drags import Drag, clear_of_sidebar, random_drags, undo_all
from stage import Stage, Wait

from bl_ext.user_default.palpate.addon import known_status
from bl_ext.user_default.palpate.core.errors import PalpateError
from bl_ext.user_default.palpate.operators.bake import bake_session

SCALES = (1.0, 1.75)
DRAGS = 20
LONGEST_BAKE = 900.0


def drags_press_where_the_cursor_is(stage: Stage) -> Wait:
    path = Path(stage.arguments[0])
    yield from _only_model(stage, path)
    # Undo makes objects anew.
    name = bpy.context.object.name
    yield from stage.open_sidebar("Palpate")
    yield from _predicted(stage)
    stage.note(model=path.name, vertices=len(bpy.context.object.data.vertices))
    yield from stage.picture("imported")
    try:
        yield from _make_soft(stage)
    except AssertionError as problem:
        stage.note(refused=str(problem))
        yield from stage.picture("refused")
        return
    yield from stage.picture("soft")
    missed: list[Drag] = []
    for scale in SCALES:
        drags: list[Drag] = []
        yield from _scaled(stage, scale)
        try:
            rng = np.random.default_rng(round(100 * scale))
            yield from random_drags(stage, name, rng, DRAGS, drags)
        finally:
            yield from stage.picture(f"dragged-{scale:g}")
            bpy.context.preferences.view.ui_scale = 1.0
            _note_drags(stage, scale, drags)
        missed += [drag for drag in drags if not drag.hit]
        yield from undo_all(stage, name)
    assert not missed, f"{len(missed)} drags missed, the first: {missed[0]}"


def _note_drags(stage: Stage, scale: float, drags: list[Drag]) -> None:
    said = sorted({text for drag in drags if not drag.hit for text in drag.said})
    stage.note(
        **{
            f"hits at {scale:g}": sum(drag.hit for drag in drags),
            f"more elsewhere at {scale:g}": sum(drag.elsewhere for drag in drags),
            f"drags at {scale:g}": [str(drag) for drag in drags],
            f"missed at {scale:g}, said": said,
        }
    )


def _only_model(stage: Stage, path: Path) -> Wait:
    """Open or import a model as a user would, and choose its largest mesh, a soft one if there is
    one: sample scenes stand on a larger table.
    """
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    if path.suffix == ".blend":
        bpy.ops.wm.open_mainfile(filepath=str(path))
        yield 0.5
    else:
        with stage.view():
            _import(path)
    yield 0.3
    meshes = [
        thing for thing in bpy.context.scene.objects if thing.type == "MESH" and thing.visible_get()
    ]
    assert meshes, f"{path.name} has no mesh"
    meshes.sort(key=lambda thing: np.prod(np.maximum(thing.dimensions, 1e-6)))
    largest = ([thing for thing in meshes if thing.palpate.body_key] or meshes)[-1]
    # A backdrop hides what stands before it from three sides.
    for other in meshes[meshes.index(largest) + 1 :]:
        other.hide_set(True)
    for other in bpy.context.scene.objects:
        other.select_set(other == largest)
    bpy.context.view_layer.objects.active = largest
    # Where the first stroke is taken back to.
    bpy.ops.ed.undo_push(message="Only the model")
    # Without a graphics card these take much of a frame's time.
    space = stage.area.spaces.active
    space.overlay.show_floor = space.shading.show_cavity = False
    with stage.view():
        bpy.ops.view3d.view_selected()
    yield 0.5


def _import(path: Path) -> None:
    match path.suffix.lower():
        case ".obj":
            bpy.ops.wm.obj_import(filepath=str(path))
        case ".stl":
            bpy.ops.wm.stl_import(filepath=str(path))
        case ".ply":
            bpy.ops.wm.ply_import(filepath=str(path))
        case _:
            bpy.ops.import_scene.gltf(filepath=str(path))


def _predicted(stage: Stage) -> Wait:
    thing, scene = bpy.context.object, bpy.context.scene
    prediction = None
    for _ in range(100):
        try:
            prediction = known_status.prediction(thing, scene)
        except PalpateError as problem:
            stage.note(predicted=str(problem))
            return
        if prediction is not None:
            break
        yield 0.1
    assert prediction is not None
    stage.note(predicted=round(prediction.cost.seconds, 1))


def _make_soft(stage: Stage) -> Wait:
    thing = bpy.context.object
    if thing.palpate.body_key:
        return
    with stage.view():
        try:
            bpy.ops.palpate.make_soft("INVOKE_DEFAULT")
        except RuntimeError as problem:
            raise AssertionError(str(problem)) from problem
    yield from stage.until(
        lambda: bake_session.current() is None, "the end of the bake", LONGEST_BAKE
    )
    yield 0.3
    assert thing.palpate.body_key, "the bake ended without a body"
    stage.note(taken=round(thing.palpate.bake_seconds, 1))


def _scaled(stage: Stage, scale: float) -> Wait:
    """Draw the interface larger, and wait until the sidebar has its place, which comes in steps."""
    bpy.context.preferences.view.ui_scale = scale
    before = None
    while before != (before := (stage.region("UI").x, stage.region("UI").width)):
        yield 1.0
        yield
    with stage.view():
        bpy.ops.view3d.view_selected()
    # The view goes there in steps.
    yield 1.0
    clear_of_sidebar(stage)
    yield 0.5
