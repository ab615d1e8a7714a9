"""What is seen is what is touched: the same press as at rest, where the mesh is seen, turned."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    begin,
    cube,
    depth,
    empty,
    error_of,
    layer_names,
    mesh_state,
    moved,
    part,
    pose_by_bone,
    rest_places,
    seen_places,
    wait,
)

AT, BY = np.array([0.006, 0.004, 0.025]), np.array([0.001, 0.002, -0.004])
SEVENTY = np.radians(70.0)


def pressed(thing, at, by, *, keep=False):
    return part("operators.press.press_once").press_once(
        thing, bpy.context.scene, tuple(at), tuple(by), keep=keep
    )


@pytest.fixture
def at_rest(thing):
    """The press at rest with which all others are compared."""
    return pressed(thing, AT, BY)


def world(thing, local):
    return np.array(thing.matrix_world)[:3, :3] @ local + np.array(thing.matrix_world)[:3, 3]


def same_contact(one, other):
    np.testing.assert_array_equal(one.fingers[0].made.nodes, other.fingers[0].made.nodes)
    np.testing.assert_allclose(
        one.fingers[0].made.nodal_forces, other.fingers[0].made.nodal_forces, rtol=1e-3, atol=1e-6
    )


def test_a_posed_limb_is_pressed_where_it_is_seen(at_rest, thing):
    armature = pose_by_bone(thing, SEVENTY)
    turn = np.array(armature.pose.bones["Bone"].matrix_channel)[:3, :3]
    posed = pressed(thing, turn @ AT, turn @ BY, keep=True)
    same_contact(posed, at_rest)
    # The force is in world axes.
    np.testing.assert_allclose(posed.force, turn @ np.array(at_rest.force), rtol=1e-3, atol=1e-6)
    dent = seen_places(thing) - rest_places(thing) @ turn.T
    np.testing.assert_allclose(dent, moved(thing, "Press 1") @ turn.T, rtol=0, atol=1e-6)
    assert part("operators.layer.place_marks").NAME not in thing.modifiers
    assert "palpate_rest" not in thing.data.attributes


def test_a_pressed_place_of_a_moved_scaled_object_counts_its_pose_too(thing):
    thing.location, thing.rotation_euler = (0.3, 0.1, -0.2), (0.4, 0.9, -0.3)
    bpy.context.view_layer.update()
    turn = np.array(thing.matrix_world)[:3, :3]
    straight = pressed(thing, world(thing, AT), turn @ BY)
    armature = pose_by_bone(thing, SEVENTY)
    bone = np.array(armature.pose.bones["Bone"].matrix_channel)[:3, :3]
    posed = pressed(thing, world(thing, bone @ AT), turn @ bone @ BY)
    same_contact(posed, straight)
    local = bone @ np.linalg.inv(turn) @ np.array(straight.force)
    np.testing.assert_allclose(posed.force, turn @ local, rtol=1e-3, atol=1e-6)


def test_a_key_that_enlarges_is_pressed_on_its_surface(at_rest, thing):
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Large")
    key.points.foreach_set("co", 1.5 * rest_places(thing).ravel())
    key.value = 1.0
    large = pressed(thing, 1.5 * AT, BY, keep=True)
    same_contact(large, at_rest)
    dented = 1.5 * rest_places(thing) + moved(thing, "Press 1")
    np.testing.assert_allclose(seen_places(thing), dented, rtol=0, atol=1e-6)


def test_the_next_press_goes_on_from_the_dent(at_rest, thing):
    """A bump of 1 cm all over: the place is found on it, not below."""
    layers = part("operators.layer.layers")
    layer = layers.add(thing, "Bump")
    layers.write(thing, layer, np.tile(np.float32([0, 0, 0.01]), len(thing.data.vertices)))
    again = pressed(thing, AT + np.array([0.0, 0.0, 0.01]), BY, keep=True)
    same_contact(again, at_rest)
    assert layer_names(thing) == ["Bump", "Press 1"]


@pytest.mark.parametrize("after", ["SUBSURF", "MIRROR", "TRIANGULATE"])
def test_vertices_that_modifiers_make_after_the_layers_are_followed(at_rest, thing, after):
    pose = pose_by_bone(thing, SEVENTY).pose.bones["Bone"]
    modifier = thing.modifiers.new("More", after)
    if after == "SUBSURF":
        modifier.subdivision_type, modifier.levels = "SIMPLE", 2
    if after == "MIRROR":
        # Another cube beside: the first one is still pressed.
        modifier.mirror_object = empty("Plane", at=(0.1, 0.0, 0.0))
    turn = np.array(pose.matrix_channel)[:3, :3]
    posed = pressed(thing, turn @ AT, turn @ BY, keep=True)
    same_contact(posed, at_rest)
    np.testing.assert_allclose(posed.force, turn @ np.array(at_rest.force), rtol=1e-3, atol=1e-6)


def test_an_uneven_scale_is_of_the_body_and_its_pose_turns_it(palpate):
    """Referee: the object whose scale is applied, posed alike."""
    thing = cube()
    thing.scale = (1.0, 1.4, 0.8)
    bpy.context.view_layer.update()
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    scale = np.array([1.0, 1.4, 0.8])
    straight = pressed(thing, AT * scale, BY)
    key_turn = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], dtype=float)
    pose_by_bone(thing, np.pi / 2)
    bone = np.array(bpy.data.objects["Armature"].pose.bones["Bone"].matrix_channel)[:3, :3]
    np.testing.assert_allclose(bone, key_turn, atol=1e-6)
    posed = pressed(thing, scale * (bone @ AT), BY, keep=True)
    assert np.linalg.norm(posed.force) > 0.0
    # Pressed at the place that was at AT before the pose.
    np.testing.assert_array_equal(posed.fingers[0].made.nodes, straight.fingers[0].made.nodes)


def test_a_session_has_the_seen_place_and_leaves_nothing(sessions, states, thing):
    armature = pose_by_bone(thing, SEVENTY)
    turn = np.array(armature.pose.bones["Bone"].matrix_channel)[:3, :3]
    before = mesh_state(thing)
    session = begin(sessions, states, thing)
    bpy.context.view_layer.update()
    touched = part("operators.place.touched_place")
    drawn_surface = part("operators.scene.drawn_surface")
    outward = turn @ np.array([0.0, 0.0, 1.0])
    seen = turn @ np.array([*AT[:2], 0.025])
    place = touched.under_ray(
        thing, drawn_surface.frame_of(thing, bpy.context.scene), seen + 0.1 * outward, -outward
    )
    np.testing.assert_allclose(place.rest, [*AT[:2], 0.025], atol=1e-6)
    np.testing.assert_allclose(place.seen, seen, atol=1e-6)
    np.testing.assert_allclose(place.turn, turn, atol=1e-5)
    np.testing.assert_allclose(place.normal, outward, atol=1e-5)
    session.touch(place, thing)
    np.testing.assert_allclose(session.frames[0].world_from_body(place.rest), seen, atol=1e-6)
    session.post(states.SetDown((*AT[:2], 0.02501)))
    session.post(states.Move((*AT[:2], 0.021)))
    session.post(states.Moment.RELEASE)
    wait(session, lambda: depth(session) > 0.0039)
    at_surface = seen_places(thing)
    assert np.abs(at_surface - rest_places(thing) @ turn.T).max() > 1e-4
    reading = part("addon.overlay.reading").readings(session)[0]
    push = np.array(reading.force_vector)
    assert push @ outward > 0.99 * np.linalg.norm(push)
    session.post(states.Moment.CANCEL)
    assert mesh_state(thing) == before


def test_a_hidden_face_is_said(thing):
    mask = thing.modifiers.new("Nothing", "MASK")
    mask.vertex_group = thing.vertex_groups.new(name="Nobody").name
    assert "shows no face" in error_of(bpy.ops.palpate.press, at=tuple(AT), by=tuple(BY))
