"""Blender's interface and properties, and their registration."""

import bpy

from ..operators.animation import animate_recording, bake_animation
from ..operators.bake import (
    cancel_bake,
    fit_memory,
    make_soft,
    pin_below,
    rebuild_body,
    remove_softness,
    show_problems,
    update_pins,
)
from ..operators.device import refresh_devices
from ..operators.kept import animate_layers, apply_layers, convert_layers, remove_layer
from ..operators.press import (
    add_press_rig,
    pinch,
    press,
    record,
    save_recording,
    switch_force,
)
from ..operators.record import recording_writer
from ..operators.rest import reset, settle
from ..operators.softness import force_curve, read_durometer, softness_colours
from ..operators.stroke import stroke_operator, stroke_size
from . import command, handlers, preferences, translations
from .inspection import body_view
from .overlay import view
from .panels import sidebar
from .properties import soft_object, softness
from .toolbar import keys, palpate_tool, surface_circle

# In the order of registration; properties first, since all others refer to them.
modules = (
    soft_object,
    softness,
    preferences,
    make_soft,
    rebuild_body,
    cancel_bake,
    pin_below,
    update_pins,
    fit_memory,
    show_problems,
    press,
    pinch,
    bake_animation,
    animate_recording,
    switch_force,
    record,
    recording_writer,
    save_recording,
    refresh_devices,
    convert_layers,
    apply_layers,
    add_press_rig,
    animate_layers,
    remove_layer,
    remove_softness,
    read_durometer,
    force_curve,
    softness_colours,
    settle,
    reset,
    stroke_operator,
    stroke_size,
    sidebar,
    view,
    body_view,
    surface_circle,
    palpate_tool,
    keys,
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
    """Remove all of Palpate from Blender; running work ends first."""
    # Handlers first: they end a bake or press while everything is still registered.
    for module in reversed(modules):
        if hasattr(module, "unregister"):
            module.unregister()
        for cls in reversed(getattr(module, "classes", ())):
            bpy.utils.unregister_class(cls)
