"""Preferences of the extension, also where they are not registered."""

from __future__ import annotations

import bpy

# Name under which Blender loaded the extension: ``bl_ext.<repository>.palpate``.
PACKAGE = __package__.removesuffix(".operators.scene")


def preferences() -> bpy.types.AddonPreferences:
    """Preferences registered by :mod:`addon.preferences`."""
    return bpy.context.preferences.addons[PACKAGE].preferences
