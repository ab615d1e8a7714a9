"""Remove Softness: delete the body; the mesh and its kept shapes stay."""

import bpy

from ..object import body_store
from .bake_session import OnSoft


class PALPATE_OT_remove_softness(OnSoft, bpy.types.Operator):
    bl_idname = "palpate.remove_softness"
    bl_label = "Remove Softness"
    bl_description = "Delete the body and its file. Mesh, pins and kept shapes stay"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: bpy.types.Context) -> None:
        body_store.forget(context.object)


classes = (PALPATE_OT_remove_softness,)
