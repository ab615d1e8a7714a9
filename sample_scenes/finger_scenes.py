"""The scenes about fingers: a pinch with two of them, a fingertip with a radius, kept dents, what
stays in clay, and a baked animation.
"""

import bodies
import bpy
import fabric
import numpy as np
import scenes
import studio
from installed import palpate
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float, float]

# Two cubes beside each other, metres; how deep they are pinched.
APART, DEPTH = 0.045, 0.008
# Middles of the left and right side, where the body has nodes: the paper's Figure 5 ...
ON_NODES = ((-0.025, 0.0, 0.025), (0.025, 0.0, 0.025))
# ... and places within triangles, not opposite to each other.
IN_TRIANGLES = ((-0.025, -0.0045, 0.0285), (0.025, 0.0055, 0.0215))
# Frames: in the air, pressed, still pressed, in the air again.
FRAMES = (1, 20, 40, 60)
# A finger's end, and the place on the mouse's back where it comes down, metres.
FINGER_RADIUS, FINGER_LENGTH = 0.008, 0.045
BACK, FINGER_DEPTH, FINGER_LIFT = (-0.018, -0.006, 0.0595), 0.009, 0.03
# A thumb's print on a cube's top: x, y and radius, metres; frames from one sample to the next.
THUMB, BAKED_STEP = (0.0, -0.012, 0.009), 3
SKIN = (0.80, 0.50, 0.38)


def pinch_scene() -> list[bpy.types.Object]:
    """Two of the paper's cubes, each between two Empties: on nodes, and within triangles."""
    scene = studio.empty_scene("Pinch")
    cubes = []
    for name, x, places in (("Nodes", -APART, ON_NODES), ("Triangles", APART, IN_TRIANGLES)):
        cube = scenes.paper_cube(scene, name)
        # As the paper's figure is.
        cube.palpate.shape, cube.location.x = "LINEAR", x
        for side, place, inward in zip(("Left", "Right"), places, (1.0, -1.0), strict=True):
            here = (place[0] + x, place[1], place[2])
            empty = leading_empty(scene, f"{name} {side}", 0.004)
            keyframes(empty, here, (inward, 0.0, 0.0), lift=0.004, depth=DEPTH)
        cubes.append(cube)
    chosen = scene.palpate
    # The paper presses nodes, so with points.
    chosen.tip, chosen.source, chosen.second = "POINT", "EMPTY", "EMPTY"
    chosen.source_empty = scene.objects["Nodes Left"]
    chosen.second_empty = scene.objects["Nodes Right"]
    _show(scene, cubes)
    studio.show_empties()
    return cubes


def _show(scene: bpy.types.Scene, cubes: list[bpy.types.Object]) -> None:
    """Set the frames, and two cubes before a backdrop, lit and in view."""
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    aim = (0.0, 0.0, 0.023)
    studio.present(scene, cubes[0], aim, (0.10, -0.40, 0.20), 88.0, 0.21)


def keep_pinches() -> None:
    """Both cubes pinched as the paper's Figure 5 shows it, in layers that are off at first."""
    press = palpate("operators.press.press_once").press_several
    for name, x, places in (("Nodes", -APART, ON_NODES), ("Triangles", APART, IN_TRIANGLES)):
        cube = bpy.data.objects[name]
        ats = list(np.array(places) + np.array([x, 0.0, 0.0]))
        press(cube, bpy.context.scene, ats, [(DEPTH, 0.0, 0.0), (-DEPTH, 0.0, 0.0)])
        layers, layer = palpate("operators.layer.layers"), cube.modifiers.active
        layers.rename(cube, layer, "Pinched")
        layers.set_strength(cube, layer, 0.0)


def dents_scene() -> list[bpy.types.Object]:
    """Two cubes: one for dents that come one after the other, one for a poke with sliders."""
    scene = studio.empty_scene("Dents")
    cubes = []
    for name, x in (("Dents", -APART), ("Poke", APART)):
        cube = scenes.paper_cube(scene, name)
        cube.location.x = x
        cubes.append(cube)
    _show(scene, cubes)
    return cubes


def keep_dents() -> None:
    """A push, a grab and a twist as layers with keyframes; a press rig, its sliders keyed."""
    scene, (dents, poke) = bpy.context.scene, (bpy.data.objects[one] for one in ("Dents", "Poke"))
    bpy.context.view_layer.objects.active = dents
    stroke = bpy.ops.palpate.stroke
    stroke(motion="PUSH", place=(-APART - 0.01, -0.005, 0.05), radius=0.008, depth=0.006)
    corner = (-APART + 0.025, -0.025, 0.05)
    stroke(motion="GRAB", place=corner, radius=0.015, by=(0.006, -0.006, 0.006))
    stroke(motion="TWIST", place=(-APART, -0.025, 0.02), radius=0.012, angle=0.9)
    bpy.ops.palpate.animate_layers()
    bpy.context.view_layer.objects.active = poke
    bpy.ops.palpate.add_press_rig(use_cursor=False, at=(APART, 0.0, 0.05), radius=0.12)
    rig = palpate("operators.layer.press_rig").rigs_of(poke)[0]
    inputs = palpate("operators.layer.modifier_inputs")
    for frame, (aside, up) in zip(FRAMES, ((0, 0), (0, -0.8), (0.8, 0), (0, 0)), strict=True):
        for axis, way in (("X", aside), ("Z", up)):
            inputs.set_value(rig, axis, float(way))
            poke.keyframe_insert(inputs.path(rig, axis), frame=frame)
    scene.frame_set(FRAMES[1])


def imprint_scene() -> list[bpy.types.Object]:
    """Two cubes that yield: clay keeps what is pressed into it, memory foam forgets it."""
    scene = studio.empty_scene("Imprint")
    cubes = []
    for name, x, forget in (("Clay", -APART, 0.0), ("Foam", APART, 0.5)):
        cube = scenes.paper_cube(scene, name)
        cube.location.x = x
        cube.palpate.yield_depth, cube.palpate.forget_time = 0.0005, forget
        cubes.append(cube)
    _show(scene, cubes)
    return cubes


def keep_imprints() -> None:
    """Three fingertips and a thumb in clay, and a thumb in foam, which fades."""
    stroke = bpy.ops.palpate.stroke
    for name, prints in (
        ("Clay", ((-0.013, 0.010, 0.006), (0.0, 0.013, 0.006), (0.013, 0.010, 0.006), THUMB)),
        ("Foam", (THUMB,)),
    ):
        cube = bpy.data.objects[name]
        bpy.context.view_layer.objects.active = cube
        for x, y, radius in prints:
            place = (cube.location.x + x, y, scenes.CUBE_EDGE)
            stroke(motion="PUSH", place=place, radius=radius, depth=0.007)


def animated_scene() -> list[bpy.types.Object]:
    """A cube, and a finger that comes down on it, goes along and leaves."""
    scene = studio.empty_scene("Animated")
    cube = scenes.paper_cube(scene, "Animated")
    empty = leading_empty(scene, "Finger", FINGER_RADIUS)
    top = scenes.CUBE_EDGE + FINGER_RADIUS
    for frame, (x, height) in zip(
        FRAMES, ((-0.012, 0.02), (-0.012, -0.008), (0.012, -0.008), (0.012, 0.02)), strict=True
    ):
        empty.location = (x, 0.0, top + height)
        empty.keyframe_insert("location", frame=frame)
    finger = studio.link(scene, "Finger Skin", finger_mesh())
    finger.parent = empty
    finger.hide_select = True
    chosen = scene.palpate
    chosen.tip, chosen.tip_radius, chosen.source_empty = "SPHERE", FINGER_RADIUS, empty
    _show(scene, [cube])
    return [cube]


def bake_animation() -> None:
    """What the finger does, as a point cache beside the scene, which plays without Palpate."""
    bpy.context.scene.palpate.source = "EMPTY"
    if bpy.ops.palpate.press_frames(step=BAKED_STEP) != {"FINISHED"}:
        raise RuntimeError("Animated: Bake Animation did not finish")
    bpy.context.scene.frame_set(FRAMES[1] + 10)


def fingertip_scene() -> list[bpy.types.Object]:
    """The plush mouse, and a finger that an Empty leads onto its back."""
    scene = studio.empty_scene("Fingertip")
    mouse = scenes.plush_mouse(scene)
    empty = leading_empty(scene, "Finger", FINGER_RADIUS)
    centre = (BACK[0], BACK[1], BACK[2] + FINGER_RADIUS)
    keyframes(empty, centre, (0.0, 0.0, -1.0), lift=FINGER_LIFT, depth=FINGER_DEPTH)
    finger = studio.link(scene, "Finger Skin", finger_mesh())
    finger.parent = empty
    finger.hide_select = True
    chosen = scene.palpate
    chosen.tip, chosen.tip_radius = "SPHERE", FINGER_RADIUS
    chosen.source_empty = empty
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    aim = (-0.004, -0.004, 0.042)
    studio.present(scene, mouse, aim, (0.23, -0.33, 0.19), 76.0, 0.16, lit=(0.0, 0.0, 0.04))
    # Near enough for the pressure under a finger to be seen.
    studio.open_view(scene, mouse, 0.16, (-0.012, -0.010, 0.046))
    studio.show_empties()
    return [mouse]


def finger_mesh() -> bpy.types.Mesh:
    """A finger upright, the middle of its round end at the origin."""
    rings, segments = 12, 32
    angle = np.linspace(-0.5 * np.pi, 0.0, rings)
    radius = np.append(FINGER_RADIUS * np.cos(angle), 1.06 * FINGER_RADIUS)
    height = np.append(FINGER_RADIUS * np.sin(angle), FINGER_LENGTH)
    turn = 2.0 * np.pi * np.arange(segments) / segments
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    vertices = np.concatenate(
        [
            np.column_stack([r * circle, np.full(segments, z)])
            for r, z in zip(radius, height, strict=True)
        ]
    )
    faces = [
        (
            segments * ring + s,
            segments * ring + t,
            segments * (ring + 1) + t,
            segments * (ring + 1) + s,
        )
        for ring in range(rings)
        for s, t in zip(range(segments), [*range(1, segments), 0], strict=True)
    ]
    mesh = bpy.data.meshes.new("Finger Skin")
    mesh.from_pydata(vertices, [], faces)
    mesh.shade_smooth()
    mesh.materials.append(fabric.felt(SKIN))
    scenes.paint(mesh, np.tile(SKIN, (len(vertices), 1)))
    return mesh


def leading_empty(scene: bpy.types.Scene, name: str, size: float) -> bpy.types.Object:
    """An Empty that leads a finger."""
    empty = studio.link(scene, name, None)
    empty.empty_display_type, empty.empty_display_size = "SPHERE", size
    return empty


def keyframes(
    empty: bpy.types.Object, place: Point, inward: Point, *, lift: float, depth: float
) -> None:
    """From the air to a place, in, a rest there, and back."""
    for frame, way in zip(FRAMES, (-lift, depth, depth, -lift), strict=True):
        empty.location = np.array(place) + way * np.array(inward)
        empty.keyframe_insert("location", frame=frame)


def tets() -> dict[str, bodies.Tets]:
    """The stored tetrahedra of each object of these scenes."""
    cube = bodies.cube_tets()
    cubes = dict.fromkeys(("Nodes", "Triangles", "Dents", "Poke", "Clay", "Foam", "Animated"), cube)
    return {**cubes, "Mouse": bodies.stored_tets("mouse")}
