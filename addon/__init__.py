"""What Blender shows and keeps, and the one place where all of it registers."""

import bpy

from ..operators import (
    cancel_bake,
    fit_memory,
    force_curve,
    make_soft,
    pin_below,
    pinch,
    press,
    press_frames,
    read_durometer,
    rebuild_body,
    record,
    recording_writer,
    refresh_devices,
    remove_softness,
    save_recording,
    softness_colours,
    switch_force,
    update_pins,
)
from . import (
    command,
    handlers,
    overlay,
    panels,
    preferences,
    properties,
    softness_properties,
    translations,
)

# In the order of registration; properties first, since all others refer to them.
modules = (
    properties,
    softness_properties,
    preferences,
    make_soft,
    rebuild_body,
    cancel_bake,
    pin_below,
    update_pins,
    fit_memory,
    press,
    pinch,
    press_frames,
    switch_force,
    record,
    recording_writer,
    save_recording,
    refresh_devices,
    remove_softness,
    read_durometer,
    force_curve,
    softness_colours,
    panels,
    overlay,
    handlers,
    command,
    translations,
)


def register() -> None:
    """Add all of Palpate to Blender."""
    for module in modules:
        for cls in getattr(module, "classes", ()):
            bpy.utils.register_class(cls)
        if hasattr(module, "register"):
            module.register()


def unregister() -> None:
    """Take all of it out again; what is going on ends first."""
    # Handlers first: they end a bake or press while everything is still there.
    for module in reversed(modules):
        if hasattr(module, "unregister"):
            module.unregister()
        for cls in reversed(getattr(module, "classes", ())):
            bpy.utils.unregister_class(cls)
