"""Softness measured where the hand points, in the window."""

from __future__ import annotations

import bpy
from mouse_scene import over_the_view, own_copy, type_key
from stage import Stage, Wait

FINGERTIP = "sample_scenes/fingertip.blend"
# A place on the mouse's back that the view shows from above, world coordinates.
BACK = (-0.018, -0.014, 0.057)


def a_force_curve_is_taken_where_the_eyedropper_clicks(stage: Stage) -> Wait:
    stage.open_scene(own_copy(stage, FINGERTIP))
    yield 0.5
    mouse = bpy.context.view_layer.objects.active = bpy.data.objects["Mouse"]
    softness = mouse.palpate_softness
    yield from stage.move(over_the_view(stage))
    _pick(stage)
    yield from type_key(stage, "ESC")
    assert not softness.curve_text
    _pick(stage)
    yield from stage.click(stage.pixel(BACK))
    yield from stage.until(lambda: softness.curve_text, "the curve")
    clicked = softness.curve_stiffness
    with stage.view():
        bpy.ops.palpate.force_curve(at=BACK)
    assert abs(softness.curve_stiffness / clicked - 1.0) < 0.05
    with stage.view():
        bpy.ops.palpate.force_curve(at=(0.09, 0.0, 0.02))
    assert abs(softness.curve_stiffness / clicked - 1.0) > 0.1


def _pick(stage: Stage) -> None:
    with stage.view():
        bpy.ops.palpate.force_curve("INVOKE_DEFAULT", pick=True)
