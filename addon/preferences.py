"""Preferences of the extension, for all files."""

import bpy

from ..operators.scene.package_preferences import PACKAGE
from .properties.scene import SOURCE_ITEMS


class PalpatePreferences(bpy.types.AddonPreferences):
    bl_idname = PACKAGE

    default_source: bpy.props.EnumProperty(
        name="Press With",
        description="What new files press with",
        items=SOURCE_ITEMS,
        default="POINTER",
    )
    max_force: bpy.props.FloatProperty(
        name="Largest Force",
        description="A device never gives more than this, in newtons, nor more than it says itself",
        default=3.0,
        min=0.1,
        max=40.0,
        precision=1,
        step=10,
    )
    sensitivity: bpy.props.FloatProperty(
        name="Pointer Sensitivity",
        description="How deep a drag presses: 1 follows the pointer",
        default=1.0,
        min=0.05,
        max=5.0,
        precision=2,
        step=5,
    )
    body_folder: bpy.props.StringProperty(
        name="Body Folder",
        description="Where bodies of files not yet saved are kept. "
        "Empty: the extension's own user folder",
        subtype="DIR_PATH",
    )
    probe_color: bpy.props.FloatVectorProperty(
        name="Probe", subtype="COLOR", size=4, min=0.0, max=1.0, default=(1.0, 0.55, 0.1, 1.0)
    )
    contact_color: bpy.props.FloatVectorProperty(
        name="Contact", subtype="COLOR", size=4, min=0.0, max=1.0, default=(0.15, 0.75, 1.0, 1.0)
    )
    force_color: bpy.props.FloatVectorProperty(
        name="Force", subtype="COLOR", size=4, min=0.0, max=1.0, default=(0.95, 0.2, 0.35, 1.0)
    )
    probe_pixels: bpy.props.FloatProperty(
        name="Probe Size",
        description="Radius of the probe on the screen",
        default=9.0,
        min=3.0,
        max=40.0,
        subtype="PIXEL",
    )
    arrow_pixels: bpy.props.FloatProperty(
        name="Arrow Length",
        description="Length of the arrow for large forces; half of it at 0.3 N",
        default=160.0,
        min=20.0,
        max=600.0,
        subtype="PIXEL",
    )

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        column = layout.column(heading="Pressing")
        column.prop(self, "default_source")
        column.prop(self, "max_force")
        column.prop(self, "sensitivity")
        column = layout.column(heading="Files")
        column.prop(self, "body_folder")
        column = layout.column(heading="In the View")
        for name in ("probe_color", "contact_color", "force_color", "probe_pixels", "arrow_pixels"):
            column.prop(self, name)


classes = (PalpatePreferences,)
