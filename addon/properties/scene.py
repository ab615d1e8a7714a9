"""Properties of a scene: pressing device, its place, and the force loop."""

import bpy

from ...operators.device import refresh_devices
from .finger import FingerProperties, haply_at_rest, haply_model

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


def _is_empty(scene_settings: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return candidate.type == "EMPTY"


def _suggest_ports(
    settings: bpy.types.PropertyGroup, context: bpy.types.Context, edit_text: str
) -> list[str]:
    return [f"{path} ({text})" if text else path for path, text in refresh_devices.known_ports()]


class PalpateScene(FingerProperties, bpy.types.PropertyGroup):
    """``scene.palpate``: device, place and force loop."""

    source: bpy.props.EnumProperty(
        name="Press With",
        description="Who moves the probe",
        items=SOURCE_ITEMS,
        default="POINTER",
    )
    simulated_kind: bpy.props.EnumProperty(
        name="Kind",
        description="Which device is simulated",
        items=SIMULATED_ITEMS,
        default="LINK",
    )
    haply_model: haply_model()
    haply_at_rest: haply_at_rest()
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
    show_workspace: bpy.props.BoolProperty(
        name="Show Workspace",
        description="Draw in the view where the device reaches",
        default=True,
    )
    stable_contact: bpy.props.BoolProperty(
        name="Stable Contact",
        description="Let the motors feel no contact that is too stiff for them and your hand to "
        "hold without shaking. The shape stays as it is",
        default=True,
    )
    own_coupling: bpy.props.BoolProperty(
        name="Own Values",
        description="Choose yourself what keeps the contact stable, for a device that you know",
    )
    coupling_stiffness: bpy.props.FloatProperty(
        name="Largest Stiffness",
        description="The stiffest contact that the motors feel, in newtons per metre",
        default=800.0,
        min=1.0,
        max=100_000.0,
        soft_max=5_000.0,
        precision=0,
        step=10000,
    )
    coupling_damping: bpy.props.FloatProperty(
        name="Damping",
        description="What brakes the device in a contact of that stiffness, in newton seconds per "
        "metre; softer contacts get their share",
        default=3.2,
        min=0.0,
        max=100.0,
        soft_max=20.0,
        precision=1,
        step=10,
    )
    passivity_control: bpy.props.BoolProperty(
        name="Passivity Control",
        description="Watch the energy that the motors give, and brake away what no soft body "
        "could have stored",
        default=True,
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
        max=60.0,
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
