"""Poses that move while they are pressed, and all that presses besides the pointer."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    BESIDE,
    DEPTH,
    begin,
    depth,
    empty,
    hide_layers,
    moved,
    part,
    pose_by_bone,
    rest_places,
    seen_places,
    select,
    soft_cube,
    wait,
)

QUARTER = np.pi / 2


def turn_of(armature):
    return np.array(armature.pose.bones["Bone"].matrix_channel)[:3, :3]


def bend(armature, angle):
    armature.pose.bones["Bone"].rotation_euler.x = angle
    bpy.context.view_layer.update()


@pytest.fixture
def posed(thing):
    return pose_by_bone(thing, 0.5)


def test_a_press_goes_along_with_a_pose_that_is_played(sessions, states, thing, posed):
    session = begin(sessions, states, thing)
    bpy.context.view_layer.update()
    touched = part("operators.place.touched_place")
    frame = part("operators.scene.drawn_surface").frame_of(thing, bpy.context.scene)
    x, y, z = BESIDE
    rest = np.array([x, y, 0.025])
    session.touch(touched.nearest(thing, frame, turn_of(posed) @ rest), thing)
    session.post(states.SetDown(BESIDE))
    session.post(states.Move((x, y, z - DEPTH)))
    session.post(states.Moment.RELEASE)
    wait(session, lambda: session.seen.displacements is not None and depth(session) > 0.99 * DEPTH)
    reading = part("addon.overlay.reading").readings
    before = np.array(reading(session)[0].force_vector)
    for angle in (0.8, 1.4):
        bend(posed, angle)
        session.tick()
        turn = turn_of(posed)
        # The dent moves the touched triangle; its place is told without it.
        np.testing.assert_allclose(session.places[0].turn, turn, atol=1e-4)
        np.testing.assert_allclose(session.frames[0].world_from_body(rest), turn @ rest, atol=1e-6)
    wait(session, lambda: np.isfinite(reading(session)[0].force_vector).all())
    now = np.array(reading(session)[0].force_vector)
    way = turn @ [0.0, 0.0, 1.0]
    assert now @ way > 0.95 * np.linalg.norm(now)
    np.testing.assert_allclose(np.linalg.norm(now), np.linalg.norm(before), rtol=0.1)
    session.post(states.Moment.CANCEL)


def test_an_empty_meets_a_posed_limb_where_it_is_seen(sessions, states, thing, posed):
    turn, scene = turn_of(posed), bpy.context.scene
    leader = empty("Leader", at=tuple(turn @ [0.004, 0.003, 0.03]))
    scene.palpate.source_empty = leader
    select(thing)
    session = begin(sessions, states, thing, "EMPTY")
    session.tick()
    leader.location = turn @ [0.004, 0.003, 0.022]
    bpy.context.view_layer.update()
    wait(session, lambda: session.snapshot.touching and depth(session) > 0.0025)
    bpy.context.view_layer.update()
    push = np.array(part("addon.overlay.reading").readings(session)[0].force_vector)
    assert push @ (turn @ [0.0, 0.0, 1.0]) > 0.95 * np.linalg.norm(push)
    session.tick()
    dent = (seen_places(thing) - rest_places(thing) @ turn.T) @ turn
    top = rest_places(thing)[:, 2] > 0.02
    assert dent[top, 2].min() < -2e-4
    session.post(states.Moment.CANCEL)


@pytest.mark.parametrize("bake", [False, True])
def test_pressers_meet_a_posed_limb_where_it_is_seen(thing, posed, bake):
    """Referee: the same presser beside the same body at rest."""
    scene = bpy.context.scene
    scene.frame_start = scene.frame_end = 1
    turn, place = turn_of(posed), np.array([0.012, 0.01, 0.031])
    dents = []
    for pose in (np.eye(3), turn):
        thing.modifiers["Pose"].show_viewport = pose is turn
        tool = empty(f"Ball {len(dents)}", at=tuple(pose @ place))
        tool.empty_display_size = 0.01
        group = bpy.data.collections.new("Tools")
        group.objects.link(tool)
        select(thing)
        thing.palpate.pressers = group
        name = "Palpate Pressers"
        if bake:
            assert bpy.ops.palpate.press_frames(current_only=True) == {"FINISHED"}
            name = f"Press {len(dents) + 1}"
        else:
            graph = bpy.context.evaluated_depsgraph_get()
            part("operators.animation.live_pressers").follow(thing, graph)
        dents.append(moved(thing, name).copy())
        # What is kept is seen, and would be met.
        hide_layers(thing)
        part("operators.animation.live_pressers").end(thing)
        thing.palpate.pressers = None
    straight, bent = dents
    assert np.abs(straight).max() > 1e-3
    np.testing.assert_allclose(bent, straight, atol=0.03 * np.abs(straight).max())
    assert not [one.name for one in thing.data.attributes if one.name.startswith("palpate_")]


def test_softness_is_measured_where_it_is_seen(palpate):
    thing = soft_cube()
    softness_place = part("operators.softness.softness_place")
    armature = pose_by_bone(thing, QUARTER)
    drawn = part("operators.object.drawn_body").open_body(thing, bpy.context.scene)
    at = np.array([0.006, 0.004, 0.025])
    bpy.context.scene.cursor.location = turn_of(armature) @ at
    thing.palpate_softness.place = "CURSOR"

    class Asked:
        """An operator without a place of its own."""

        class properties:  # noqa: N801 -- as Blender names it
            @staticmethod
            def is_property_set(_):
                return False

    found = softness_place.place_in_body(drawn, bpy.context, Asked)
    np.testing.assert_allclose(found, at, atol=1e-6)


def test_handles_of_a_pinch_are_set_down_on_what_is_seen(sessions, states, thing, posed):
    session = begin(sessions, states, thing, pinch=True)
    bpy.context.view_layer.update()
    hand = part("operators.session.pointer_hand").PointerHand(session, (0, 1))

    class View:
        """A view from the front."""

        view_matrix = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])

    hand.place_on_both_sides(View)
    sides = [session.frames[k].world_from_body(held.target) for k, held in hand.held.items()]
    for side, sign in zip(sides, (-1.0, 1.0), strict=True):
        # Turned about X, both sides stay where they were along it.
        assert abs(side[0] - sign * 0.025) < 0.002
        np.testing.assert_allclose(side[1:], 0.0, atol=0.002)
    session.post(states.Moment.CANCEL)
