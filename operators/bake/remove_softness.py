"""Remove Softness: take the body away; the mesh and the shapes kept from it stay."""

import bpy

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ..object import body_store, soft_object
from ..scene.translated import reported, shown
from ..session import press_session
from . import bake_session


class PALPATE_OT_remove_softness(bpy.types.Operator):
    bl_idname = "palpate.remove_softness"
    bl_label = "Remove Softness"
    bl_description = "Delete the body and its file. Mesh, pins and kept shapes stay"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        reason = soft_object.refusal(context.object)
        if not reason and not context.object.palpate.body_key:
            reason = Sentence("{name} is not soft", name=context.object.name)
        if not reason and (bake_session.current() or press_session.current()):
            reason = "Finish baking or pressing first"
        if reason:
            cls.poll_message_set(shown(reason))
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            body_store.forget(context.object)
        except PalpateError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        return {"FINISHED"}


classes = (PALPATE_OT_remove_softness,)
