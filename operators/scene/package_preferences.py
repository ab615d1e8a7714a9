"""The extension's preferences, for code that must also run where they are not registered."""

from __future__ import annotations

import bpy

# The name under which Blender loaded the extension: ``bl_ext.<repository>.palpate``.
PACKAGE = __package__.removesuffix(".operators.scene")


def preferences() -> bpy.types.AddonPreferences:
    """The preferences that :mod:`addon.preferences` registers."""
    return bpy.context.preferences.addons[PACKAGE].preferences
