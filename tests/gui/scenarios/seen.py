"""What is seen is what is touched, in the window."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix, Vector
from mouse_scene import BACK, depth, kept, mouse, open_mouse, phase, start_press, type_key
from stage import Stage, Wait

from bl_ext.user_default.palpate.operators.session import press_session
from bl_ext.user_default.palpate.operators.session.press_state import Phase


def a_posed_body_is_pressed_where_it_is_seen(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    turn = _pose_by_bone(np.radians(40.0))
    yield from start_press(stage)
    place = turn @ Vector(BACK)
    x, y = stage.pixel(place)
    yield from stage.drag([(x, y), (x + 25, y - 40)], release=False)
    yield from stage.until(lambda: depth() > 0.004, "a depth of 4 mm")
    seen = press_session.current().place.seen
    assert np.linalg.norm(seen - np.array(place)) < 0.01
    yield from stage.picture("posed")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: phase() is Phase.HOLDING, "the hold")
    yield from type_key(stage, "RET")
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")
    assert kept() == ["Press 1", "Pose"]


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
