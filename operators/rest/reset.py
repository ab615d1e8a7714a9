"""Reset: bring an object that has come to lie back to where it was, as it was."""

from __future__ import annotations

import bpy

from ..layer import live_layer
from ..layer.stack import PLAYERS
from ..lying import rest_layer
from ..lying.laid import CHANNELS, bring_back
from ..lying.together import together
from ..object import soft_object
from ..played import mesh_cache
from ..reporting.acting import Acting
from ..scene import curves
from ..session import press_session


class PALPATE_OT_reset_rest(Acting, bpy.types.Operator):
    bl_idname = "palpate.reset_rest"
    bl_label = "Reset"
    bl_description = (
        "Bring the object back to where it was before it settled, without its sag and without the "
        "animation that was baked of it, and all that settled with it. Kept presses stay"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        # A stroke's layer is live, too.
        reason = press_session.refusal() or live_layer.refusal(context.object)
        return reason or soft_object.refusal(context.object)

    def act(self, context: bpy.types.Context) -> None:
        for thing in together(context.object, context.selected_objects):
            reset(thing)


def reset(thing: bpy.types.Object) -> None:
    """Bring an object back, with the sag and the baked animation gone. Safe where it never lay."""
    if thing.palpate.is_keyed:
        for channel in CHANNELS:
            curves.remove(thing, channel)
        player = thing.modifiers.get(mesh_cache.MODIFIER_NAME)
        if player is not None and player.type in PLAYERS:
            thing.modifiers.remove(player)
    bring_back(thing)
    rest_layer.remove(thing)


classes = (PALPATE_OT_reset_rest,)
