"""Pin Below Height: assign all vertices below a height to the group "Pinned"."""

import bpy

from ...core.sentence import Sentence
from ..object import soft_object
from ..pins import pin_group
from ..reporting.acting import Acting
from ..reporting.translated import reported
from ..scene import drawn_surface


class PALPATE_OT_pin_below(Acting, bpy.types.Operator):
    bl_idname = "palpate.pin_below"
    bl_label = "Make Pin Group"
    bl_description = (
        "Put all vertices below this share of the object's height, as it stands now, "
        "into the vertex group Pinned"
    )
    bl_options = {"REGISTER", "UNDO"}

    fraction: bpy.props.FloatProperty(
        name="Height",
        description="Share of the object's height in world Z below which vertices are pinned",
        default=0.1,
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        reason = soft_object.refusal(context.object)
        if not reason and not context.object.data.polygons:
            reason = Sentence("{name} has no faces", name=context.object.name)
        return reason

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self.fraction = context.object.palpate.pin_fraction
        return self.execute(context)

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        drawn = drawn_surface.read(thing, context.scene)
        group, count = pin_group.mark_below(thing, drawn, self.fraction)
        thing.palpate.pin_mode, thing.palpate.pin_group = "GROUP", group.name
        self.report({"INFO"}, reported("{count} vertices pinned", count=count))


classes = (PALPATE_OT_pin_below,)
