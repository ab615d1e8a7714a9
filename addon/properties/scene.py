"""Properties of a scene: pressing device, its place, and the force loop."""

import bpy

from ...operators.device import refresh_devices
from .finger import FingerProperties, haply_at_rest, haply_model
from .inspection import InspectionProperties
from .kinds import choice, chosen_object, number, span, switch, text
from .stroke import StrokeProperties

# Files hold the numbers of these items: add new ones at the end only.
SOURCE_ITEMS = [
    ("POINTER", "Pointer", "Mouse, pen or trackpad press on the surface"),
    ("SIMULATED", "Simulated Device", "A program that behaves like a haptic device"),
    ("SERIAL", "Serial Device", "A haptic device on a serial port"),
    ("HAPLY", "Haply 2DIY", "A Haply 2DIY on its serial port; it moves in a plane"),
    ("EMPTY", "Empty", "An Empty of the scene leads the finger: by keyframes or moved by hand"),
]
SIMULATED_ITEMS = [
    ("LINK", "Three Axes", "A device that speaks Palpate's serial link"),
    ("HAPLY", "Haply 2DIY", "A Haply 2DIY with its board; it moves in a plane"),
]


def _suggest_ports(
    settings: bpy.types.PropertyGroup, context: bpy.types.Context, edit_text: str
) -> list[str]:
    return [f"{path} ({text})" if text else path for path, text in refresh_devices.known_ports()]


class PalpateScene(
    FingerProperties, InspectionProperties, StrokeProperties, bpy.types.PropertyGroup
):
    """``scene.palpate``: device, place and force loop."""

    source: choice("Press With", "Who moves the probe", SOURCE_ITEMS, "POINTER")
    simulated_kind: choice("Kind", "Which device is simulated", SIMULATED_ITEMS, "LINK")
    haply_model: haply_model()
    haply_at_rest: haply_at_rest()
    port: text(
        "Port",
        "Serial port of the device: one from the list, or a path typed in",
        search=_suggest_ports,
        search_options={"SUGGESTION"},
    )
    baud: number(
        "Line Speed",
        "Bits a second of a device on a serial line, as it has them. 0 for USB of the device's "
        "own, where speed has no meaning, and for 115200",
        0,
        span(0, 12_000_000, step=9600),
    )
    device_frame: chosen_object(
        "Device Frame",
        "Empty that says where the device's origin and axes are. Without one they are the object's",
        "EMPTY",
    )
    device_scale: number(
        "Motion Scale",
        "How far the probe moves per movement of the device",
        1.0,
        span(0.01, 100.0),
    )
    show_workspace: switch("Show Workspace", "Draw in the view where the device reaches", on=True)
    record_from_start: switch(
        "Record from Start", "Record every tick from the beginning of a press"
    )
    record_minutes: number(
        "Minutes",
        "How long a recording may become, in minutes; then it stops by itself",
        10.0,
        span(0.1, 60.0, precision=1, step=100),
    )
    rate: number(
        "Rate",
        "How often a second the force is computed, in hertz. Firmer bodies want more, "
        "slow devices and computers less",
        1000,
        span(100, 8000, step=100),
    )
