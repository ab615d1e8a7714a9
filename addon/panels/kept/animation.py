"""Animation: what presses while it plays, and how that is kept."""

import bpy

from ....operators.animation import failures, frame_keys
from ....operators.played import mesh_cache
from ..base import PalpatePanel, named_properties, while_idle
from ..sentence import say


class PALPATE_PT_animation(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_animation"
    bl_label = "Animation"
    bl_parent_id = "PALPATE_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, thing = named_properties(self), context.object
        column = while_idle(layout)
        column.prop(thing.palpate, "pressers")
        problem = failures.reason(thing)
        if problem:
            say(layout, context, problem, "ERROR")
        # Renders show what is baked without it.
        if thing.palpate.pressers is not None and not _is_baked(thing):
            column.prop(context.scene.render, "use_lock_interface")
            text = "Lock Interface lets renders show them; a farm needs Bake Animation"
            say(column, context, text, "INFO")
        column.operator("palpate.press_frames", icon="RENDER_ANIMATION")
        column.operator("palpate.animate_recording", icon="ANIM")


def _is_baked(thing: bpy.types.Object) -> bool:
    return mesh_cache.plays(thing) or frame_keys.plays(thing)


classes = (PALPATE_PT_animation,)
