"""Properties of a scene's fingers: contact mode, tip, and the second finger."""

import bpy

from ...core.errors import PalpateError
from ...operators.scene.drawn_surface import metres_per_unit, size_of
from ...operators.tool.tool_sizes import ToolSizes, has_exact_sizes
from .kinds import choice, chosen_object, length, number, span, switch, text

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


def _take_length(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Sizes are lengths from now on: one was set, by hand or by a script."""
    if not settings.own_sizes:
        settings.own_sizes = True


def _begin_with_share(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Lengths begin as those of the active object's share, unless one was ever set."""
    thing = context.object
    if not settings.own_sizes or has_exact_sizes(settings) or thing is None:
        return
    scene = settings.id_data
    try:
        sizes = ToolSizes.of_share(settings.tip_share, size_of(thing, scene))
    except PalpateError:
        # A flattened object has no size; Press reports it with its remedy.
        return
    for name, metres in sizes.lengths.items():
        setattr(settings, name, metres / metres_per_unit(scene))


def _tool_length(name: str, description: str, default: float, **more: object) -> object:
    return length(name, description, default, update=_take_length, **more)


def haply_model() -> object:
    """Model of a finger's Haply 2DIY."""
    return choice("Model", "Which of the 2DIYs it is", HAPLY_ITEMS, "2diy-3.1")


def haply_at_rest() -> object:
    """Whether its handle is in the rest pose, from which its angles count."""
    return switch(
        "Handle at Rest",
        "The handle lies in its rest pose now: let the board count its angles from there anew, "
        "also if it was in use before",
    )


class FingerProperties:
    """Part of ``scene.palpate`` for fingers; lengths in scene units."""

    contact_mode: choice(
        "Contact", "How the force follows from the depth", MODE_ITEMS, "CONSISTENT"
    )
    tip: choice("Finger", "What touches the surface", TIP_ITEMS, "SPHERE")
    tip_share: number(
        "Size",
        "Radius of the fingertip as a share of the body's size; rod and plate are in proportion",
        5.0,
        span(0.5, 100.0, soft_max=20.0, precision=1, step=50, subtype="PERCENTAGE"),
    )
    own_sizes: switch(
        "Exact Size",
        "Give the tool's size in lengths, the same for every object",
        update=_begin_with_share,
    )
    tip_radius: _tool_length("Radius", "Radius of the fingertip or rod", 0.008)
    rod_length: _tool_length("Length", "Length of the rod without its round ends", 0.03)
    plate_width: _tool_length("Width", "Width of the plate", 0.02)
    # Not the depth of a press: some languages have two words.
    plate_depth: _tool_length(
        "Depth", "Depth of the plate, across its width", 0.02, translation_context="Palpate"
    )
    tip_object: chosen_object(
        "Tool", "Mesh object that presses. Its convex hull is used; it is never changed", "MESH"
    )
    tip_turn: choice("Turned", "How the tool is turned", TURN_ITEMS, "SURFACE")
    turn_object: chosen_object(
        "Turned As",
        "Object whose axes the tool has: its face looks along minus Z, a rod lies "
        "along X. Without one, a mesh that presses is turned as it is",
    )
    show_pressure: switch(
        "Show Pressure", "Draw where the tool touches, coloured by pressure", on=True
    )
    source_empty: chosen_object(
        "Led By",
        "Empty whose place is the finger's: by keyframes, constraints or your hand",
        "EMPTY",
    )
    second: choice(
        "Second Finger", "Who moves a second finger on the same body", SECOND_ITEMS, "NONE"
    )
    second_empty: chosen_object("Led By", "Empty whose place is the second finger's", "EMPTY")
    second_port: text("Port", "Serial port of the second device: such as /dev/ttyACM1 or COM4")
    second_haply_model: haply_model()
    second_haply_at_rest: haply_at_rest()
    second_frame: chosen_object(
        "Device Frame", "Empty that says where the second device's origin and axes are", "EMPTY"
    )
