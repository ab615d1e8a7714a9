"""A newcomer's way, by clicks on real buttons alone, without a setting. Its pictures are those of
docs/tutorial.md (`make pictures`).
"""

from __future__ import annotations

import bpy
import numpy as np
from stage import Pixel, Stage, Wait

from bl_ext.user_default.palpate.operators.bake import bake_session
from bl_ext.user_default.palpate.operators.layer import layers

MOST_CLICKS = 8
TOP = (0.1, -0.2, 1.0)
# Of Blender's own menu bar, from the window's upper left corner: it has no area to look in.
RENDER_MENU, RENDER_IMAGE = (126.0, 14.0), (150.0, 40.0)


def from_the_default_cube_to_a_rendered_animation_in_eight_clicks(stage: Stage) -> Wait:
    clicks: list[str] = []

    def click(what: str, at: Pixel) -> Wait:
        clicks.append(what)
        yield from stage.click(at)
        yield

    # Without a graphics card these take much of the time, the grid a large part of a frame's.
    stage.area.spaces.active.overlay.show_floor = False
    bpy.context.scene.render.engine = "BLENDER_WORKBENCH"
    bpy.context.scene.render.resolution_percentage = 20
    rendered: list[str] = []
    bpy.app.handlers.render_complete.append(lambda *_: rendered.append("image"))
    view = stage.area
    yield 0.5

    tool = yield from stage.button(view, "TOOLS", 'bpy.ops.wm.tool_set_by_id(name="palpate')
    yield from click("Palpate in the toolbar", tool)
    yield from stage.picture("1-tool")
    soft = yield from stage.button(view, "TOOL_HEADER", "bpy.ops.palpate.make_soft(")
    yield from click("Make Soft in the header", soft)
    yield from stage.until(lambda: bpy.data.objects["Cube"].palpate.body_key, "the first body")
    yield from stage.until(lambda: bake_session.current() is None, "the bake")
    yield 0.3
    yield from stage.picture("2-soft")

    x, y = stage.pixel(TOP)
    clicks.append("hold and drag on the cube")
    yield from stage.drag([(x, y), (x + 4, y - 34)], release=False)
    yield from stage.picture("3-stroke")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: layers.layers_of(bpy.data.objects["Cube"]), "the dent")
    # At most what was dragged.
    assert 0.05 < _largest(0) < 0.84
    yield from stage.move((x + 150, y))
    yield from stage.picture("4-kept")

    animate = yield from stage.button(view, "TOOL_HEADER", "bpy.ops.palpate.animate_layers(")
    yield from click("Animate Dents in the header", animate)
    yield from stage.until(lambda: bpy.data.objects["Cube"].animation_data, "keyframes")
    yield from stage.picture("5-animated")
    yield from _plays(stage, click)

    x, top = RENDER_MENU
    yield from click("Render", (x, stage.window.height - top))
    yield 0.3
    x, top = RENDER_IMAGE
    yield from stage.move((x, stage.window.height - top))
    yield from click("Render Image", (x, stage.window.height - top))
    # Away from what would show its tooltip in the picture.
    yield from stage.move((stage.window.width / 2, stage.window.height / 2))
    yield from stage.until(lambda: rendered, "the rendered image")
    yield from stage.picture("6-rendered")
    stage.note(clicks=clicks)
    assert len(clicks) <= MOST_CLICKS


def _plays(stage: Stage, click) -> Wait:
    timeline = next(area for area in stage.window.screen.areas if area.type == "DOPESHEET_EDITOR")
    play = yield from stage.button(timeline, "HEADER", "bpy.ops.screen.animation_play(")
    yield from click("Play below the timeline", play)
    frame = bpy.context.scene.frame_current
    yield from stage.until(lambda: bpy.context.scene.frame_current != frame, "another frame")
    with stage.view():
        bpy.ops.screen.animation_cancel(restore_frame=True)
    assert {round(_largest(at), 2) for at in (1, 7, 13)} == {0.0, *_seen_at((7, 13))}


def _seen_at(frames: tuple[int, ...]) -> set[float]:
    return {round(_largest(frame), 2) for frame in frames}


def _largest(frame: int) -> float:
    """Largest displacement of the last layer, metres; 0 for the present frame."""
    cube = bpy.data.objects["Cube"]
    if frame:
        bpy.context.scene.frame_set(frame)
    layer = layers.layers_of(cube)[-1]
    moved = layers.displacement(cube, layer)
    assert moved is not None
    return layers.strength(layer) * float(np.linalg.norm(moved, axis=1).max())
