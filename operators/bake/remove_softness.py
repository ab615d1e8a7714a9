"""Remove Softness: delete the body; the mesh and its kept shapes stay."""

import bpy

from ..object import body_store
from ..reporting.acting import Acting
from .bake_session import refusal_of_soft


class PALPATE_OT_remove_softness(Acting, bpy.types.Operator):
    bl_idname = "palpate.remove_softness"
    bl_label = "Remove Softness"
    bl_description = "Delete the body and its file. Mesh, pins and kept shapes stay"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        return refusal_of_soft(context)

    def act(self, context: bpy.types.Context) -> None:
        body_store.forget(context.object)


classes = (PALPATE_OT_remove_softness,)
