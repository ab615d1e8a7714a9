"""What is seen is what is touched, in the window."""

from __future__ import annotations

import bpy
import numpy as np
import posed_bodies
from mathutils import Matrix, Vector
from mouse_scene import BACK, depth, kept, mouse, open_mouse, phase, start_press, type_key
from stage import Stage, Wait, at_length

from bl_ext.user_default.palpate.operators.session import press_session
from bl_ext.user_default.palpate.operators.session.press_state import Phase


@at_length
def a_posed_body_is_pressed_where_it_is_seen(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    turn = _pose_by_bone(np.radians(40.0))
    yield from start_press(stage)
    place = turn @ Vector(BACK)
    x, y = stage.pixel(place)
    yield from stage.drag([(x, y), (x + 25, y - 40)], release=False)
    yield from stage.until(lambda: depth() > 0.004, "a depth of 4 mm")
    seen = press_session.current().places[0].seen
    assert np.linalg.norm(seen - np.array(place)) < 0.01
    yield from stage.picture("posed")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: phase() is Phase.HOLDING, "the hold")
    yield from type_key(stage, "RET")
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")
    assert kept() == ["Press 1", "Pose"]


@at_length
def a_bent_elbow_is_dented_inward_from_outside_and_inside(stage: Stage) -> Wait:
    thing = posed_bodies.arm()
    rest = posed_bodies.places(thing)
    bpy.ops.palpate.make_soft("EXEC_DEFAULT")
    posed_bodies.bend(thing, np.radians(90.0))
    # Places at rest, and from where they are seen.
    for side, place, eye in (
        ("outside", (0.0, 0.0, -0.5), (0.8, -1.0, -0.7)),
        ("inside", (-0.9, 0.0, 0.5), (-0.9, -1.0, 0.9)),
    ):
        vertex = int(np.argmin(np.linalg.norm(rest - place, axis=1)))
        yield from _look_from(stage, eye)
        at = posed_bodies.places(thing)[vertex]
        inward = -np.array(_seen_normal(thing, vertex))
        yield from _stroke_at(stage, thing, stage.pixel(at))
        yield from stage.picture(side)
        before, moved = _dent(thing)
        deepest = int(np.argmax(np.linalg.norm(moved, axis=1)))
        assert np.linalg.norm(before[deepest] - at) < 0.2, side
        assert moved[deepest] @ inward > 0.05, side
        # Which vertex is the deepest follows the tetrahedra, and those are others each time.
        length = np.linalg.norm(moved, axis=1)
        way = moved[length > 0.5 * length[deepest]].mean(axis=0)
        assert way @ inward > 0.95 * np.linalg.norm(way), (side, way @ inward / np.linalg.norm(way))
        yield from type_key(stage, "Z", ctrl=True)
        thing = bpy.data.objects["Arm"]


def a_mirrored_half_is_dented_at_the_cursor_keyed_larger_and_scaled_unevenly(stage: Stage) -> Wait:
    thing = posed_bodies.half_sphere()
    thing.scale = (1.0, 1.4, 0.7)
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Large")
    for point in key.points:
        point.co *= 1.5
    bpy.context.view_layer.update()
    bpy.ops.palpate.make_soft("EXEC_DEFAULT")
    key.value = 1.0
    yield from _look_from(stage, (0.3, -1.0, 1.4))
    coarse = posed_bodies.places(thing)
    # Near the seam, on the side that the Mirror makes.
    at = coarse[np.argmin(np.linalg.norm(coarse - (-0.15, -0.3, 1.0), axis=1))]
    yield from _stroke_at(stage, thing, stage.pixel(at))
    yield from stage.picture("mirrored")
    before, moved = _dent(thing)
    deepest = int(np.argmax(np.linalg.norm(moved, axis=1)))
    assert np.linalg.norm(before[deepest] - at) < 0.2
    assert moved[deepest, 2] < -0.05
    assert (moved[before[:, 0] > 0.05, 2] < -0.01).any(), "the other side of the seam"
    assert np.ptp(before[:, 0]) > 2.9, "both halves are drawn"


def _dent(thing: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Places (p, 3) as seen without the first stroke, and what it moves them by, world."""
    layer = thing.modifiers["Press 1"]
    dented = posed_bodies.places(thing)
    layer.show_viewport = False
    before = posed_bodies.places(thing)
    layer.show_viewport = True
    return before, dented - before


def _stroke_at(stage: Stage, thing: bpy.types.Object, here: tuple[float, float]) -> Wait:
    """Push a little with the tool."""
    yield from stage.drag([here, (here[0] + 24, here[1])], steps=4)
    yield from stage.until(lambda: "Press 1" in thing.modifiers, "the stroke that is kept")


def _look_from(stage: Stage, eye: tuple[float, float, float]) -> Wait:
    """Look at the origin from a side, with the tool in hand."""
    region = stage.area.spaces.active.region_3d
    region.view_rotation = Vector(eye).to_track_quat("Z", "Y")
    region.view_location, region.view_distance = (0.0, 0.0, 0.4), 8.0
    stage.area.spaces.active.overlay.show_floor = False
    with stage.view():
        bpy.ops.wm.tool_set_by_id(name="palpate.tool")
    bpy.ops.ed.undo_push(message="Looked at")
    yield 0.1


def _seen_normal(thing: bpy.types.Object, vertex: int) -> Vector:
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return mesh.vertices[vertex].normal.copy()


def _pose_by_bone(angle: float) -> Matrix:
    """Turn the whole mouse by a bone, about X; returns that turn."""
    thing = mouse()
    armature = bpy.data.objects.new("Armature", bpy.data.armatures.new("Armature"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0.0, 0.0, 0.0), (0.0, 0.0, 0.1)
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.hide_set(True)
    group = thing.vertex_groups.new(name="Bone")
    group.add(range(len(thing.data.vertices)), 1.0, "REPLACE")
    modifier = thing.modifiers.new("Pose", "ARMATURE")
    modifier.object = armature
    pose = armature.pose.bones["Bone"]
    pose.rotation_mode = "XYZ"
    pose.rotation_euler.x = angle
    bpy.context.view_layer.objects.active = thing
    bpy.context.view_layer.update()
    return thing.matrix_world @ pose.matrix_channel @ thing.matrix_world.inverted()
