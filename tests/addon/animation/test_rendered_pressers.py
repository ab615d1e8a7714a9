"""Pressers in renders: Blender moves copies of the objects there, and the window may run beside."""

from __future__ import annotations

import threading

import bpy
import numpy as np
import pytest
from pressed_scene import tapped_by_ball
from soft_scene import part, pose_by_bone, seen_places

FRAMES = (1, 2, 3, 4)


class Looking(bpy.types.RenderEngine):
    """Renders nothing, and notes where the cube's vertices are in each frame."""

    bl_idname, bl_label = "PALPATE_LOOKING", "Looking"
    seen: dict[int, np.ndarray] = {}  # noqa: RUF012  Blender makes an engine of its own

    def render(self, graph):
        vertices = bpy.data.objects["Soft"].evaluated_get(graph).data.vertices
        places = np.array([vertex.co for vertex in vertices])
        self.seen[graph.scene.frame_current] = places


@pytest.fixture
def pressed(palpate, tmp_path):
    """A cube that a ball taps, in a scene that is rendered in no time."""
    bpy.utils.register_class(Looking)
    thing, scene, render = tapped_by_ball(), bpy.context.scene, bpy.context.scene.render
    thing.name = "Soft"
    render.engine, render.filepath = Looking.bl_idname, str(tmp_path / "frame_")
    render.resolution_x = render.resolution_y = 8
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    Looking.seen.clear()
    yield thing
    bpy.utils.unregister_class(Looking)


@pytest.mark.parametrize("case", ["at rest", "posed", "the ball is hidden"])
def test_rendered_frames_show_what_the_view_does(pressed, case):
    scene = bpy.context.scene
    if case == "posed":
        pose_by_bone(pressed, 0.2)
    bpy.data.objects["Ball"].hide_render = case == "the ball is hidden"
    viewed = {}
    for frame in FRAMES:
        scene.frame_set(frame)
        viewed[frame] = seen_places(pressed)
    scene.frame_set(1)
    bpy.ops.render.render(animation=True)
    assert np.abs(viewed[4] - viewed[1]).max() > 1e-4
    for frame in FRAMES:
        np.testing.assert_allclose(Looking.seen[frame], viewed[frame], atol=2e-6)


def test_a_render_beside_the_window_is_refused_unless_that_is_locked(pressed):
    scene, graph = bpy.context.scene, bpy.context.evaluated_depsgraph_get()
    live, failures = (part(f"operators.animation.{name}") for name in ("live_pressers", "failures"))
    with live.paused():
        scene.frame_set(4)
    before = seen_places(pressed)
    for locked in (False, True):
        scene.render.use_lock_interface = locked
        beside = threading.Thread(target=live.follow_all, args=[graph])
        beside.start()
        beside.join()
        assert ("Lock Interface" in str(failures.reason(pressed))) is not locked
        assert bool(np.abs(seen_places(pressed) - before).max() > 1e-4) is locked
