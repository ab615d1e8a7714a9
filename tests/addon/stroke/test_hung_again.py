"""A stroke after another does not look for the drawn vertices' places again."""

from __future__ import annotations

import bpy
from soft_scene import TOP, part


def test_the_map_is_kept_between_strokes_and_made_anew_for_another_mesh(thing):
    open_body = part("operators.object.drawn_body").open_body
    first = open_body(thing, bpy.context.scene).hung
    bpy.ops.palpate.stroke(motion="PUSH", place=TOP, radius=0.02, depth=0.003)
    assert open_body(thing, bpy.context.scene).hung is first
    part("operators.object.kept_body").forget()
    assert open_body(thing, bpy.context.scene).hung is not first
