"""A tool's animation, baked in the window: with a bar, and Escape."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from mouse_scene import own_copy, type_key
from stage import Stage, Wait, at_length

NAME = "Mouse"


def escape_ends_the_baking_of_an_animation_and_changes_nothing(stage: Stage) -> Wait:
    yield from _begin(stage)
    frame = bpy.context.scene.frame_current
    yield from _bake(stage, last=1000)
    # Some frames on: the timer presses a slice at a time, and the window is drawn in between.
    yield from stage.until(lambda: bpy.context.scene.frame_current > frame, "a frame")
    yield from stage.picture("bar")
    yield from type_key(stage, "ESC")
    yield from stage.until(lambda: bpy.context.scene.frame_current == frame, "the old frame")
    assert not _thing().modifiers
    assert not _caches(stage)


@at_length
def a_baked_animation_plays_by_its_modifier(stage: Stage) -> Wait:
    yield from _begin(stage)
    yield from _bake(stage)
    yield from stage.until(lambda: _thing().modifiers, "the mesh cache")
    heights = {}
    for frame in (21, 1):
        bpy.context.scene.frame_set(frame)
        yield from stage.picture(f"frame-{frame}")
        heights[frame] = _places()
    assert np.abs(heights[21] - heights[1]).max() > 1e-3
    with stage.view():
        bpy.ops.ed.undo()
    yield
    assert not _thing().modifiers


@at_length
def pressers_are_followed_while_scrubbing(stage: Stage) -> Wait:
    yield from _begin(stage)
    hand = bpy.data.collections.new("Hand")
    hand.objects.link(bpy.data.objects["Finger Skin"])
    bpy.context.scene.frame_set(1)
    rest = _places()
    _thing().palpate.pressers = hand
    for frame in (21, 16, 21):
        bpy.context.scene.frame_set(frame)
        yield
    yield from stage.picture("frame-21")
    assert np.abs(_places() - rest).max() > 1e-3
    bpy.context.scene.frame_set(1)
    yield
    assert np.abs(_places() - rest).max() < 1e-6


class Looking(bpy.types.RenderEngine):
    """Renders nothing, and notes where the vertices are in each frame."""

    bl_idname, bl_label = "PALPATE_LOOKING", "Looking"
    seen: dict[int, np.ndarray] = {}  # noqa: RUF012  Blender makes an engine of its own

    def render(self, graph: bpy.types.Depsgraph) -> None:
        self.seen[graph.scene.frame_current] = _places(graph)


def a_render_beside_the_window_follows_pressers_once_that_is_locked(stage: Stage) -> Wait:
    yield from _begin(stage)
    scene, hand = bpy.context.scene, bpy.data.collections.new("Hand")
    hand.objects.link(bpy.data.objects["Finger Skin"])
    scene.frame_set(1)
    _thing().palpate.pressers = hand
    bpy.utils.register_class(Looking)
    scene.render.engine, scene.render.filepath = Looking.bl_idname, str(stage.files / "looked_")
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.frame_start, scene.frame_end, scene.frame_step = 1, 21, 10
    for locked in (False, True):
        Looking.seen.clear()
        scene.render.use_lock_interface = locked
        with stage.view():
            bpy.ops.render.render("INVOKE_DEFAULT", animation=True)
        yield from stage.until(lambda: 21 in Looking.seen, "the last frame")
        yield from stage.until(lambda: not bpy.app.is_job_running("RENDER"), "the render's end")
        assert (np.abs(Looking.seen[21] - Looking.seen[1]).max() > 1e-3) == locked
        yield from stage.picture("locked" if locked else "unlocked")
    bpy.utils.unregister_class(Looking)


def _caches(stage: Stage) -> list[Path]:
    return list((stage.files / "scene" / "palpate").glob("*.pc2*"))


def _begin(stage: Stage) -> Wait:
    # What earlier runs baked.
    for cache in _caches(stage):
        cache.unlink()
    stage.open_scene(own_copy(stage, "sample_scenes/fingertip.blend"))
    yield 0.5
    yield from stage.open_sidebar("Palpate")
    bpy.context.view_layer.objects.active = _thing()
    # Fewer contact points than the finger of the scene has, for time.
    bpy.context.scene.palpate.tip_radius = 0.016
    bpy.ops.ed.undo_push(message="Opened")
    yield


def _bake(stage: Stage, last: int = 21) -> Wait:
    with stage.view():
        bpy.ops.palpate.press_frames("INVOKE_DEFAULT", frame_start=11, frame_end=last)
    yield


def _thing() -> bpy.types.Object:
    return bpy.data.objects[NAME]


def _places(graph: bpy.types.Depsgraph | None = None) -> np.ndarray:
    evaluated = _thing().evaluated_get(graph or bpy.context.evaluated_depsgraph_get())
    places = np.empty(3 * len(evaluated.data.vertices), np.float32)
    evaluated.data.vertices.foreach_get("co", places)
    return places
