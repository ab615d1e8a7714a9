"""Rebuild Body: the body again from the tetrahedra in the .blend, with what is set now."""

import bpy

from ..scene.translated import shown
from .make_soft import BakingOperator


class PALPATE_OT_rebuild_body(BakingOperator, bpy.types.Operator):
    bl_idname = "palpate.rebuild_body"
    bl_label = "Rebuild Body"
    bl_description = (
        "Compute the body again from the tetrahedra stored in this file, with the pins and "
        "the material set now. Also for a body file that is missing or damaged"
    )
    bl_options = {"UNDO"}
    rebuild = True

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        if not context.object.palpate.body_key:
            cls.poll_message_set(
                shown("{name} is not soft yet; press Make Soft", name=context.object.name)
            )
            return False
        return True


classes = (PALPATE_OT_rebuild_body,)
