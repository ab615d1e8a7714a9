"""Preferences of the extension, for all files.

What guards the hand that holds a device is kept here, never in a .blend: that may be a stranger's.
"""

import bpy

from ..operators.scene.package_preferences import PACKAGE
from .properties.kinds import choice, number, span, switch, text
from .properties.scene import SOURCE_ITEMS


def colour(name: str, default: tuple[float, float, float, float]) -> object:
    """Colour of something in the view, with its opacity."""
    return bpy.props.FloatVectorProperty(
        name=name, subtype="COLOR", size=4, min=0.0, max=1.0, default=default
    )


def _lead_there(self: bpy.types.AddonPreferences, _context: bpy.types.Context) -> None:
    """Name a folder beside the .blend in full, which else were another one in the next file."""
    if self.body_folder.startswith("//"):
        self.body_folder = bpy.path.abspath(self.body_folder) if bpy.data.filepath else ""


class PalpatePreferences(bpy.types.AddonPreferences):
    bl_idname = PACKAGE

    default_source: choice("Press With", "What new files press with", SOURCE_ITEMS, "POINTER")
    max_force: number(
        "Largest Force",
        "A device never gives more than this, in newtons, nor more than it says itself",
        3.0,
        span(0.1, 40.0, precision=1, step=10),
    )
    stable_contact: switch(
        "Stable Contact",
        "Let the motors feel no contact that is too stiff for them and your hand to "
        "hold without shaking. The shape stays as it is",
        on=True,
    )
    own_coupling: switch(
        "Own Values",
        "Choose yourself what keeps the contact stable, for a device that you know",
    )
    coupling_stiffness: number(
        "Largest Stiffness",
        "The stiffest contact that the motors feel, in newtons per metre",
        800.0,
        span(1.0, 100_000.0, soft_max=5_000.0, precision=0, step=10000),
    )
    coupling_damping: number(
        "Damping",
        "What brakes the device in a contact of that stiffness, in newton seconds per "
        "metre; softer contacts get their share",
        3.2,
        span(0.0, 100.0, soft_max=20.0, precision=1, step=10),
    )
    passivity_control: switch(
        "Passivity Control",
        "Watch the energy that the motors give, and brake away what no soft body could have stored",
        on=True,
    )
    sensitivity: number(
        "Pointer Sensitivity",
        "How deep a drag presses: 1 follows the pointer",
        1.0,
        span(0.05, 5.0, precision=2, step=5),
    )
    body_folder: text(
        "Body Folder",
        "Where bodies of files not yet saved are kept. Empty: the extension's own user folder",
        subtype="DIR_PATH",
        update=_lead_there,
    )
    probe_color: colour("Probe", (1.0, 0.55, 0.1, 1.0))
    contact_color: colour("Contact", (0.15, 0.75, 1.0, 1.0))
    force_color: colour("Force", (0.95, 0.2, 0.35, 1.0))
    probe_pixels: number(
        "Probe Size", "Radius of the probe on the screen", 9.0, span(3.0, 40.0, subtype="PIXEL")
    )
    arrow_pixels: number(
        "Arrow Length",
        "Length of the arrow for large forces; half of it at 0.3 N",
        160.0,
        span(20.0, 600.0, subtype="PIXEL"),
    )

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        column = layout.column(heading="Pressing")
        column.prop(self, "default_source")
        column.prop(self, "max_force")
        column.prop(self, "stable_contact")
        if self.stable_contact:
            column.prop(self, "own_coupling")
        if self.stable_contact and self.own_coupling:
            for name in ("coupling_stiffness", "coupling_damping", "passivity_control"):
                column.prop(self, name)
        column.prop(self, "sensitivity")
        column = layout.column(heading="Files")
        column.prop(self, "body_folder")
        column = layout.column(heading="In the View")
        for name in ("probe_color", "contact_color", "force_color", "probe_pixels", "arrow_pixels"):
            column.prop(self, name)


classes = (PalpatePreferences,)
