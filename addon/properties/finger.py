"""Properties of a scene's fingers: contact mode, tip, and the second finger."""

import bpy

# Files hold the numbers of these items: add new ones at the end only.
MODE_ITEMS = [
    (
        "CONSISTENT",
        "Consistent",
        "The touched point moves exactly as far as the finger, by the least force that does it",
    ),
    (
        "PAPER",
        "Paper",
        "The paper's (11) to (14): inside triangles the surface stays a little short of the finger",
    ),
]
TIP_ITEMS = [
    ("POINT", "Point", "A needle's tip. The force depends on how finely the body is meshed"),
    ("SPHERE", "Fingertip", "A sphere, such as a finger's end"),
    ("PLATE", "Plate", "A flat rectangle whose face presses"),
    ("ROD", "Rod", "A cylinder with round ends, lying on the surface"),
    ("MESH", "Mesh", "A mesh object of the scene, made convex"),
]
TURN_ITEMS = [
    ("SURFACE", "Along Surface", "The tool's face lies on the surface where it is set down"),
    ("VIEW", "Facing View", "The tool's face looks away from you, into the screen"),
    ("OBJECT", "As Object", "The tool is turned as an object of the scene, also an animated one"),
]
SECOND_ITEMS = [
    ("NONE", "None", "One finger presses"),
    ("EMPTY", "Empty", "An Empty of the scene leads a second finger"),
    ("SIMULATED", "Simulated Device", "A program that behaves like a haptic device"),
    ("SERIAL", "Serial Device", "A second haptic device on a serial port"),
    ("HAPLY", "Haply 2DIY", "A Haply 2DIY on a serial port of its own; it moves in a plane"),
]
HAPLY_ITEMS = [
    ("2diy-3.1", "2DIY 3.1", "Motors side by side, the newest boards"),
    ("2diy-3.0", "2DIY 3.0", "Motors side by side, earlier boards"),
    ("2diy-2", "2DIY 2", "Motors on one axis"),
    ("kit", "Dev Kit", "The small early kit"),
]


def haply_model() -> object:
    """Model of a finger's Haply 2DIY."""
    return bpy.props.EnumProperty(
        name="Model",
        description="Which of the 2DIYs it is",
        items=HAPLY_ITEMS,
        default="2diy-3.1",
    )


def haply_at_rest() -> object:
    """Whether its handle is in the rest pose, from which its angles count."""
    return bpy.props.BoolProperty(
        name="Handle at Rest",
        description="The handle lies in its rest pose now: let the board count its angles from "
        "there anew, also if it was in use before",
    )


def _is_empty(settings: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return candidate.type == "EMPTY"


def _is_mesh(settings: bpy.types.PropertyGroup, candidate: bpy.types.Object) -> bool:
    return candidate.type == "MESH"


def _length(name: str, description: str, default: float, context: str = "*") -> object:
    return bpy.props.FloatProperty(
        name=name,
        translation_context=context,
        description=description,
        default=default,
        min=1e-6,
        soft_max=10.0,
        precision=4,
        step=0.1,
        subtype="DISTANCE",
        unit="LENGTH",
    )


class FingerProperties:
    """Part of ``scene.palpate`` for fingers; lengths in scene units."""

    contact_mode: bpy.props.EnumProperty(
        name="Contact",
        description="How the force follows from the depth",
        items=MODE_ITEMS,
        default="CONSISTENT",
    )
    tip: bpy.props.EnumProperty(
        name="Finger", description="What touches the surface", items=TIP_ITEMS, default="POINT"
    )
    tip_radius: _length("Radius", "Radius of the fingertip or rod", 0.008)
    rod_length: _length("Length", "Length of the rod without its round ends", 0.03)
    plate_width: _length("Width", "Width of the plate", 0.02)
    # Not the depth of a press: some languages have two words.
    plate_depth: _length("Depth", "Depth of the plate, across its width", 0.02, "Palpate")
    tip_object: bpy.props.PointerProperty(
        name="Tool",
        description="Mesh object that presses. Its convex hull is used; it is never changed",
        type=bpy.types.Object,
        poll=_is_mesh,
    )
    tip_turn: bpy.props.EnumProperty(
        name="Turned", description="How the tool is turned", items=TURN_ITEMS, default="SURFACE"
    )
    turn_object: bpy.props.PointerProperty(
        name="Turned As",
        description="Object whose axes the tool has: its face looks along minus Z, a rod lies "
        "along X. Without one, a mesh that presses is turned as it is",
        type=bpy.types.Object,
    )
    show_pressure: bpy.props.BoolProperty(
        name="Show Pressure",
        description="Draw where the tool touches, coloured by pressure",
        default=True,
    )
    source_empty: bpy.props.PointerProperty(
        name="Led By",
        description="Empty whose place is the finger's: by keyframes, constraints or your hand",
        type=bpy.types.Object,
        poll=_is_empty,
    )
    second: bpy.props.EnumProperty(
        name="Second Finger",
        description="Who moves a second finger on the same body",
        items=SECOND_ITEMS,
        default="NONE",
    )
    second_empty: bpy.props.PointerProperty(
        name="Led By",
        description="Empty whose place is the second finger's",
        type=bpy.types.Object,
        poll=_is_empty,
    )
    second_port: bpy.props.StringProperty(
        name="Port", description="Serial port of the second device: a path such as /dev/ttyACM1"
    )
    second_haply_model: haply_model()
    second_haply_at_rest: haply_at_rest()
    second_frame: bpy.props.PointerProperty(
        name="Device Frame",
        description="Empty that says where the second device's origin and axes are",
        type=bpy.types.Object,
        poll=_is_empty,
    )
