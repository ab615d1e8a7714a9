"""Base of all panels of the tab."""

import bpy

from ...core.softness.scales.materials import MATERIALS
from ...operators.bake.make_soft import suited
from ...operators.reporting.translated import shown
from ...operators.session import press_session

NAME_SHARE = 0.55


class PalpatePanel:
    """In the tab Palpate, while a mesh object is active."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Palpate"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"


def named_properties(panel: bpy.types.Panel) -> bpy.types.UILayout:
    """Layout for properties with their names on the left."""
    layout = panel.layout
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def while_idle(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    """Column of what cannot be changed during a press."""
    column = layout.column()
    column.enabled = press_session.current() is None
    return column


def draw_rows(layout: bpy.types.UILayout, rows: list[tuple[str, str]]) -> None:
    """Draw figures below each other, their names on the left."""
    for name, value in rows:
        row = layout.split(factor=NAME_SHARE)
        row.label(text=name)
        row.label(text=value, translate=False)


def draw_box(
    layout: bpy.types.UILayout, title: str, rows: list[tuple[str, str]], icon: str = "NONE"
) -> bpy.types.UILayout:
    """Draw figures in a box under a title; returns the box."""
    box = layout.box().column(align=True)
    box.label(text=title, icon=icon)
    draw_rows(box, rows)
    return box


def draw_material(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the material of the active object: the chosen one, or that which Make Soft will choose
    by its size.
    """
    thing = context.object
    suits = suited(thing, context.scene)
    if suits is None:
        layout.prop(thing.palpate, "material", text="")
        return
    text = shown("{material}, by size", material=shown(MATERIALS[suits].name))
    # A header draws a menu as bare words; the arrow says that it opens.
    layout.prop_menu_enum(
        thing.palpate, "material", text=text, translate=False, icon="DOWNARROW_HLT"
    )
