"""Rebuild Body: recompute the body from the tetrahedra in the .blend, with present settings."""

import bpy

from ..object import soft_object
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
    def refusal(cls, context: bpy.types.Context) -> str:
        return super().refusal(context) or soft_object.refusal_unbaked(context.object)


classes = (PALPATE_OT_rebuild_body,)
