"""What Blender shows and keeps. The one place where classes, handlers and draw callbacks register."""

import bpy

from ..operators import (
    cancel_bake,
    make_soft,
    pin_below,
    press,
    rebuild_body,
    refresh_devices,
    remove_softness,
)
from . import command, handlers, overlay, panels, preferences, properties, translations

# In the order of registration; properties first, since all others refer to them.
modules = (
    properties,
    preferences,
    make_soft,
    rebuild_body,
    cancel_bake,
    pin_below,
    press,
    refresh_devices,
    remove_softness,
    panels,
    overlay,
    handlers,
    command,
    translations,
)


def register():
    for module in modules:
        for cls in getattr(module, "classes", ()):
            bpy.utils.register_class(cls)
        if hasattr(module, "register"):
            module.register()


def unregister():
    # Handlers first: they end a bake or press while everything is still there.
    for module in reversed(modules):
        if hasattr(module, "unregister"):
            module.unregister()
        for cls in reversed(getattr(module, "classes", ())):
            bpy.utils.unregister_class(cls)
