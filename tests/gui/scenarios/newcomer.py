"""A newcomer's way. Its pictures are those of docs/tutorial.md (`make tutorial`)."""

from __future__ import annotations

import bpy
import numpy as np
from mouse_scene import type_key
from stage import Stage, Wait

from bl_ext.user_default.palpate.addon.overlay.reading import reading
from bl_ext.user_default.palpate.operators.layer import layers
from bl_ext.user_default.palpate.operators.session import press_session
from bl_ext.user_default.palpate.operators.session.press_state import Phase

TOP = (0.1, -0.2, 1.0)


def the_first_dent_in_the_default_cube_takes_no_setting(stage: Stage) -> Wait:
    yield from stage.open_sidebar("Palpate")
    thing = bpy.data.objects["Cube"]
    # Without a graphics card the grid takes much of a frame's time.
    stage.area.spaces.active.overlay.show_floor = False
    view = stage.area.spaces.active.region_3d
    view.view_distance, view.view_location = 9.0, (0.9, 0.9, 0.0)
    yield 0.5
    yield from stage.picture("1-mesh")
    with stage.view():
        bpy.ops.palpate.make_soft("INVOKE_DEFAULT")
    yield from stage.until(lambda: thing.palpate.body_key, "the bake")
    yield from stage.picture("2-soft")
    with stage.view():
        bpy.ops.palpate.press("INVOKE_DEFAULT")
    yield from stage.until(lambda: press_session.current().snapshot, "the first tick")
    x, y = stage.pixel(TOP)
    yield from stage.drag([(x, y), (x + 4, y - 34)])
    yield from stage.until(
        lambda: (
            press_session.current().state.phase is Phase.HOLDING
            and reading(press_session.current()).depth > 0.05
        ),
        "a depth of 5 cm",
    )
    yield from stage.picture("3-pressed")
    stage.note(newton=reading(press_session.current()).force)
    yield from type_key(stage, "RET")
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")
    yield from stage.picture("4-kept")
    kept = layers.layers_of(thing)
    assert len(kept) == 1
    moved = layers.displacement(thing, kept[0])
    assert 0.05 < float(np.linalg.norm(moved, axis=1).max()) < 0.5
