"""Update Pins: apply changed pins to the body, without a bake."""

from __future__ import annotations

import bpy

from ..carrier import body_source
from ..object import pin_change, soft_object
from ..reporting.translated import reported
from ..reporting.wait_cursor import wait_cursor
from .bake_session import OnSoft


class PALPATE_OT_update_pins(OnSoft, bpy.types.Operator):
    bl_idname = "palpate.update_pins"
    bl_label = "Update Pins"
    bl_description = (
        "Hold the body where the pins are now. More pins take about a second and no bake; "
        "so do pins that were baked before"
    )
    bl_options = {"REGISTER", "UNDO"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        with wait_cursor(context):
            return self.execute(context)

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        drawn = body_source.read_again(thing, context.scene)
        soft_object.refuse_changed(thing, soft_object.mesh_status(thing, drawn))
        body = pin_change.take_over(thing, drawn)
        self.report(
            {"INFO"},
            reported(
                "{name}: {count} nodes are pinned, without a bake",
                name=thing.name,
                count=len(body.fixed),
            ),
        )


classes = (PALPATE_OT_update_pins,)
