"""Update Pins: hold the body where the pins are now, without a bake."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ..object import pin_change, soft_object
from ..scene import drawn_surface
from ..scene.translated import reported, shown
from ..session import press_session
from . import bake_session


class PALPATE_OT_update_pins(bpy.types.Operator):
    bl_idname = "palpate.update_pins"
    bl_label = "Update Pins"
    bl_description = (
        "Hold the body where the pins are now. More pins take about a second and no bake; "
        "so do pins that were baked before"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = soft_object.refusal(context.object)
        if not reason and not context.object.palpate.body_key:
            reason = Sentence("{name} is not soft yet; press Make Soft", name=context.object.name)
        if not reason and (bake_session.current() or press_session.current()):
            reason = "Finish baking or pressing first"
        if reason:
            cls.poll_message_set(shown(reason))
        return not reason

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        context.window.cursor_modal_set("WAIT")
        try:
            return self.execute(context)
        finally:
            context.window.cursor_modal_restore()

    def execute(self, context: bpy.types.Context) -> set[str]:
        thing = context.object
        try:
            drawn = drawn_surface.read(thing, context.scene)
            soft_object.refuse_changed(thing, soft_object.mesh_status(thing, drawn))
            body = pin_change.take_over(thing, drawn)
        except PalpateError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        self.report(
            {"INFO"},
            reported(
                "{name}: {count} nodes are pinned, without a bake",
                name=thing.name,
                count=len(body.fixed),
            ),
        )
        return {"FINISHED"}


classes = (PALPATE_OT_update_pins,)
