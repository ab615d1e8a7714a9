"""What a scene remembers: who presses, where the device is, and how the force loop runs."""

import bpy

from ..operators import refresh_devices

# Files hold the numbers of these items: add new ones at the end only.
SOURCE_ITEMS = [
    ("POINTER", "Pointer", "Mouse, pen or trackpad press on the surface"),
    ("SIMULATED", "Simulated Device", "A program that behaves like a haptic device"),
    ("SERIAL", "Serial Device", "A haptic device on a serial port"),
]


def _is_empty(scene_settings: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return candidate.type == "EMPTY"


def _suggest_ports(
    settings: bpy.types.PropertyGroup, context: bpy.types.Context, edit_text: str
) -> list[str]:
    return [f"{path} ({text})" if text else path for path, text in refresh_devices.known_ports()]


class PalpateScene(bpy.types.PropertyGroup):
    """``scene.palpate``: who presses."""

    source: bpy.props.EnumProperty(
        name="Press With",
        description="Who moves the probe",
        items=SOURCE_ITEMS,
        default="POINTER",
    )
    port: bpy.props.StringProperty(
        name="Port",
        description="Serial port of the device: one from the list, or a path typed in",
        search=_suggest_ports,
        search_options={"SUGGESTION"},
    )
    device_frame: bpy.props.PointerProperty(
        name="Device Frame",
        description="Empty that says where the device's origin and axes are. "
        "Without one they are the object's",
        type=bpy.types.Object,
        poll=_is_empty,
    )
    device_scale: bpy.props.FloatProperty(
        name="Motion Scale",
        description="How far the probe moves per movement of the device",
        default=1.0,
        min=0.01,
        max=100.0,
    )
    record_from_start: bpy.props.BoolProperty(
        name="Record from Start",
        description="Record every tick from the beginning of a press",
    )
    record_minutes: bpy.props.FloatProperty(
        name="Longest Recording",
        description="How long a recording may become, in minutes; then it stops by itself",
        default=10.0,
        min=0.1,
        max=120.0,
        precision=1,
        step=100,
    )
    rate: bpy.props.IntProperty(
        name="Rate",
        description="How often a second the force is computed, in hertz. Firmer bodies want more, "
        "slow devices and computers less",
        default=1000,
        min=100,
        max=8000,
        step=100,
    )
