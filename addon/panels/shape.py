"""Large deformation: drawn shape, its cost and progress."""

from collections.abc import Sequence
from typing import Any

import bpy

from ...core.quantities import duration, memory, waiting
from ...core.shape.rotation_strain.rotation_strain_shape import MOST_FELT
from ...core.shape.shape_cost import BodySize, ShapeCost, shape_cost
from ...core.shape.shapes import shape_name
from ...operators.reporting.translated import shown
from ...operators.session import press_session
from ...operators.session.press_session import PressSession
from ...operators.shape.drawn_shape import chosen_shape
from ..properties.shape import FORMER_ITEM, SHAPE_ITEMS
from .base import PalpatePanel, draw_rows, named_properties
from .sentence import say

# Seconds of a frame that leave Blender time for 60 a second.
SMOOTH_SECONDS = 0.012


class PALPATE_PT_shape(PalpatePanel, bpy.types.Panel):
    bl_idname = "PALPATE_PT_shape"
    bl_label = "Large Deformation"
    bl_parent_id = "PALPATE_PT_advanced"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, thing = named_properties(self), context.object
        settings = thing.palpate
        choices = layout.column(heading="Shape", align=True)
        for item in SHAPE_ITEMS:
            choices.prop_enum(settings, "shape", item[0])
        say(layout, context, _explained([*SHAPE_ITEMS, FORMER_ITEM], settings.shape), "BLANK1")
        _draw_cost(layout, context, thing)
        press = press_session.current()
        if press is not None and press.handle.find() == thing:
            draw_progress(layout, context, press)


def draw_progress(
    layout: bpy.types.UILayout, context: bpy.types.Context, press: PressSession
) -> None:
    """Draw the progress of the touched place's part of a table, or why there is none."""
    shape = press.seen.shape
    if shape.problem:
        say(layout, context, shape.problem, "ERROR")
        say(layout, context, "The linear shape is drawn", "BLANK1")
    elif shape.ready < 1.0:
        text = shown("Shape {share} %", share=f"{100 * shape.ready:.0f}")
        layout.progress(factor=shape.ready, type="BAR", text=text, translate=False)


def cost_now(thing: bpy.types.Object) -> ShapeCost | None:
    """Cost of the chosen shape for the object's body; None for an object that is not soft."""
    baked = thing.palpate
    if not baked.free_surface_count:
        return None
    size = BodySize(baked.node_count, baked.tet_count, baked.free_surface_count)
    return shape_cost(shape_name(chosen_shape(thing)), size)


def _limit_of(thing: bpy.types.Object) -> str:
    """What of Real this object lacks; nothing for most."""
    baked = thing.palpate
    if baked.node_count - baked.pinned_count > MOST_FELT:
        return (
            "So large a body is drawn so but for what is finer than a coarse lattice, and felt as "
            "a linear one; a coarser bake is felt, too"
        )
    return ""


def _draw_cost(
    layout: bpy.types.UILayout, context: bpy.types.Context, thing: bpy.types.Object
) -> None:
    cost = cost_now(thing)
    if cost is None or thing.palpate.shape == "LINEAR":
        return
    if shape_name(chosen_shape(thing)) == "real" and (limit := _limit_of(thing)):
        say(layout, context, limit, "INFO")
    box = layout.box().column(align=True)
    rows = [("A Frame, About", f"{1000 * cost.frame_seconds:.2g} ms")]
    if cost.first_seconds >= 0.1:
        rows.append(("First Touch, About", waiting(cost.first_seconds)))
    if cost.table_seconds:
        rows.append(("Whole Table, About", duration(cost.table_seconds)))
    rows.append(("Memory, About", memory(cost.memory_bytes)))
    draw_rows(box, rows)
    if cost.frame_seconds > SMOOTH_SECONDS:
        say(
            box,
            context,
            "Too large a body to be drawn 60 times a second this way",
            "INFO",
            boxed=True,
        )
    if cost.table_seconds:
        say(box, context, "Computed around the touched place first, and kept", "INFO", boxed=True)


def _explained(items: Sequence[tuple[Any, ...]], chosen: str) -> str:
    return next(item[2] for item in items if item[0] == chosen)
