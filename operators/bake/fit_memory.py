"""Fit Memory: settings with which a bake that is too large for this machine fits it."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..carrier import body_source
from ..object import soft_object
from ..object.mesh_look import shape_size
from ..reporting.acting import Acting
from .bake_prediction import Prediction, pins_of, predict, settings_of


class PALPATE_OT_fit_memory(Acting, bpy.types.Operator):
    bl_idname = "palpate.fit_memory"
    bl_label = "Fit Memory"
    bl_description = "Change the bake's settings so that the memory of this machine suffices"
    bl_options = {"REGISTER", "UNDO"}

    by: bpy.props.EnumProperty(
        name="By",
        description="What is changed",
        items=[
            ("COMPRESSED", "Compressed", "Keep the computed response compressed"),
            ("COARSER", "Coarser", "Take the smallest edge length that fits"),
        ],
    )

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        return soft_object.refusal(context.object)

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        surface = body_source.read(thing, context.scene).surface()
        settings = settings_of(thing, pins_of(thing))
        self._change(thing, predict(shape_size(surface), settings))

    def _change(self, thing: bpy.types.Object, now: Prediction) -> None:
        if self.by == "COMPRESSED":
            if not now.compressed_fits:
                raise PalpateError(
                    "{name}: compressed, too, it takes more memory than there is; use a larger "
                    "edge length",
                    name=thing.name,
                )
            thing.palpate.form = "COMPRESSED"
            return
        if now.edge_length is None:
            raise PalpateError(
                "{name}: no edge length fits the memory there is; close other programs",
                name=thing.name,
            )
        thing.palpate.edge_length = now.edge_length


classes = (PALPATE_OT_fit_memory,)
