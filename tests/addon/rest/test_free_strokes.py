"""Strokes on objects that nobody holds: they give way, move, and are given back."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import error_of, layer_names, lying_state, part, seen_places, select

TOP, RADIUS = (0.004, 0.002, 0.025), 0.012


def push(thing, depth, place=TOP, **more):
    select(thing)
    return bpy.ops.palpate.stroke(place=place, radius=RADIUS, depth=depth, **more)


def test_a_push_dents_the_object_and_stays_as_a_layer(free_cube):
    assert push(free_cube, 0.003) == {"FINISHED"}
    assert layer_names(free_cube) == ["Rests", "Press 1"]
    layers = part("operators.layer.layers")
    dent = layers.displacement(free_cube, free_cube.modifiers["Press 1"])
    # Its corners alone are drawn.
    assert np.abs(dent).max() > 5e-5
    # What is seen is the sag and the dent together, above the floor.
    bpy.context.view_layer.update()
    matrix = np.array(free_cube.matrix_world)
    low = (seen_places(free_cube) @ matrix[:3, :3].T + matrix[:3, 3])[:, 2].min()
    assert low > -0.025 - 1e-5


def test_the_force_is_that_of_a_body_which_rests(free_cube, force_alone):
    """By the engine alone, of a cube that lies on a floor."""
    body = part("operators.object.drawn_body").open_body(free_cube, bpy.context.scene)
    stroke = part("operators.stroke.answer.free_stroke").FreeStroke
    grips = part("operators.stroke.answer.grips").grips_at(
        body, np.array(TOP), RADIUS, (False, False, False)
    )
    asked = part("operators.stroke.answer.motion")
    begun = stroke.begin(free_cube, body, grips)
    _, made = begun.stroked(asked.Asked(asked.Motion.PUSH, 0.003))
    # The place may lie a little higher or lower than the highest of the surface.
    assert made.force == pytest.approx(np.linalg.norm(force_alone), rel=0.1)


def test_a_push_from_the_side_moves_it_along(free_cube):
    free_cube.palpate.rest_friction = 0.1
    assert push(free_cube, 0.02, place=(0.025, 0.0, 0.0)) == {"FINISHED"}
    assert -0.025 < free_cube.location.x < -0.005
    assert abs(free_cube.location.y) < 2e-3


def test_reset_brings_it_back_to_before_all_strokes(free_cube):
    free_cube.palpate.rest_friction = 0.1
    before = np.array(free_cube.matrix_world)
    for place in ((0.025, 0.0, 0.0), (0.01, 0.0, 0.0)):
        push(free_cube, 0.015, place=place)
        assert free_cube.location.x < -0.005
    bpy.ops.palpate.reset_rest()
    np.testing.assert_allclose(np.array(free_cube.matrix_world), before, atol=1e-6)


def test_the_next_push_begins_where_the_object_is_then(free_cube):
    push(free_cube, 0.003)
    push(free_cube, 0.003, place=(-0.008, 0.0, 0.025))
    assert layer_names(free_cube) == ["Rests", "Press 1", "Press 2"]


SIDE = (0.025, 0.0, 0.0)


def height(thing):
    """Of the lowest place that is seen."""
    bpy.context.view_layer.update()
    matrix = np.array(thing.matrix_world)
    return (seen_places(thing) @ matrix[:3, :3].T + matrix[:3, 3])[:, 2].min()


def begun_on(thing, place, mirrored=(False, False, False)):
    """The body, a stroke on it that has begun, and what motions are asked with."""
    body = part("operators.object.drawn_body").open_body(thing, bpy.context.scene)
    grips = part("operators.stroke.answer.grips").grips_at(body, np.array(place), RADIUS, mirrored)
    stroke = part("operators.stroke.answer.free_stroke").FreeStroke.begin(thing, body, grips)
    return body, stroke, part("operators.stroke.answer.motion")


def test_a_fingertip_is_not_swallowed_where_the_floor_holds_against_it(free_cube):
    """By three quarters of its width at the most, as on what is pinned, with the limit's reason."""
    _, stroke, motions = begun_on(free_cube, TOP)
    asked, made = stroke.stroked(motions.Asked(motions.Motion.PUSH, 0.045))
    assert asked.amount == pytest.approx(1.5 * RADIUS, rel=0.1)
    assert "larger" in made.ends
    assert made.force > 0.0


def test_a_push_goes_on_as_far_as_the_object_gives_way(free_cube):
    """Three times as far as its fingertip goes in, and the object before it."""
    free_cube.palpate.rest_friction = 0.1
    assert push(free_cube, 0.06, place=SIDE) == {"FINISHED"}
    assert free_cube.location.x == pytest.approx(-0.06, abs=1.5 * RADIUS)
    assert np.isclose(free_cube.location.x, -0.055, atol=0.005)


def test_a_grab_carries_the_object_about_and_it_comes_down_where_it_is_let_go(free_cube):
    bpy.ops.palpate.settle()
    before = np.array(free_cube.matrix_world)
    assert push(free_cube, 0.0, place=SIDE, motion="GRAB", by=(0.1, 0.02, 0.3)) == {"FINISHED"}
    gone = np.array(free_cube.matrix_world)[:3, 3] - before[:3, 3]
    # It hangs by its side and may come down on another one.
    np.testing.assert_allclose(gone[:2], (0.1, 0.02), atol=0.03)
    assert abs(height(free_cube) + 0.025) < 5e-4
    assert layer_names(free_cube) == ["Rests"]


def test_a_grab_lifts_what_is_held(free_cube):
    _, stroke, motion = begun_on(free_cube, TOP)
    up = motion.Asked(motion.Motion.GRAB, by=np.array([0.0, 0.0, 0.05]))
    for _ in range(20):
        _, on_the_way = stroke.towards(up)
    _, made = stroke.stroked(up)
    weight = made.lying.rest.body.mass * 9.81
    assert made.force == pytest.approx(weight, rel=1e-4)
    assert np.linalg.norm(made.lying.rest.supports[0].force) == 0.0
    # What is seen meanwhile is on the way there.
    moved = np.abs(on_the_way.lying.rest.placement.position - made.lying.rest.placement.position)
    assert moved.max() < 2e-3
    _, ended = stroke.ended(up, made)
    assert ended.springs_back
    assert ended.lying.rest.supports[0].force[2] == pytest.approx(-weight, rel=1e-4)


def test_a_twist_turns_the_object(free_cube):
    assert push(free_cube, 0.0, motion="TWIST", angle=0.5) == {"FINISHED"}
    bpy.context.view_layer.update()
    turned = free_cube.matrix_world.to_euler()
    # The floor's friction holds it back, and what is held turns farther.
    assert 0.3 < turned.z <= 0.5
    assert abs(turned.x) + abs(turned.y) < 0.05
    assert layer_names(free_cube) == ["Rests"]


def test_a_pull_lifts_it_by_its_top_and_lets_it_down(free_cube):
    bpy.ops.palpate.settle()
    before = np.array(free_cube.matrix_world)
    assert push(free_cube, -0.05) == {"FINISHED"}
    np.testing.assert_allclose(np.array(free_cube.matrix_world), before, atol=5e-3)


def test_a_pinch_bends_the_object_where_it_lies(free_cube):
    bpy.ops.palpate.settle()
    before = np.array(free_cube.matrix_world)
    assert push(free_cube, 0.0, motion="PINCH", share=0.5) == {"FINISHED"}
    assert layer_names(free_cube) == ["Rests", "Press 1"]
    # It settles before, by what rounding makes of it.
    np.testing.assert_allclose(np.array(free_cube.matrix_world), before, atol=1e-3)


def test_mirrored_hands_turn_nothing_and_stretch_it(free_cube):
    mirrored = (True, False, False)
    _, stroke, motion = begun_on(free_cube, SIDE, mirrored)
    outward = motion.Asked(motion.Motion.GRAB, by=np.array([0.003, 0.0, 0.0]))
    _, made = stroke.stroked(outward)
    one, other = (
        np.sum([t.force for t in made.lying.rest.tools[k : k + 2]], axis=0) for k in (0, 2)
    )
    assert one[0] < -0.05
    np.testing.assert_allclose(one[0], -other[0], rtol=0.2)


def test_more_mirrored_hands_than_there_are_are_refused(free_cube):
    before = lying_state(free_cube)
    message = error_of(
        bpy.ops.palpate.stroke,
        place=(0.02, 0.02, 0.02),
        radius=0.005,
        motion="GRAB",
        by=(0.0, 0.0, 0.01),
        mirrored=(True, True, True),
    )
    assert "two axes" in message
    assert lying_state(free_cube) == before


def test_what_is_let_go_over_nothing_is_given_back(free_cube, board):
    board((0.0, 0.0, -0.025))
    free_cube.palpate.floor = "NONE"
    bpy.ops.palpate.settle()
    before = lying_state(free_cube)
    message = error_of(
        bpy.ops.palpate.stroke, place=TOP, radius=RADIUS, motion="GRAB", by=(2.0, 0.0, 0.1)
    )
    assert "given back" in message
    assert lying_state(free_cube) == before


def test_an_object_high_above_the_floor_comes_down(free_cube):
    free_cube.location.z = 5.0
    free_cube.palpate.floor = "HEIGHT"
    bpy.ops.palpate.settle()
    assert abs(height(free_cube)) < 1e-4


def test_a_stroke_that_is_given_up_gives_all_back(free_cube):
    free_cube.location.z = 0.05
    bpy.context.view_layer.update()
    before = lying_state(free_cube)
    body = part("operators.object.drawn_body").open_body(free_cube, bpy.context.scene)
    grips = part("operators.stroke.answer.grips").grips_at(
        body, np.array(TOP), RADIUS, (False, False, False)
    )
    motion = part("operators.stroke.answer.motion")
    live, drawing = part("operators.layer.live_layer"), part("operators.stroke.stroke_drawing")
    begun = part("operators.stroke.answer.free_stroke").FreeStroke.begin(free_cube, body, grips)
    assert lying_state(free_cube) == before
    begun.make_ready(free_cube)
    live.hang(free_cube)
    for depth in (0.001, 0.002, 0.004):
        _, made = begun.towards(motion.Asked(motion.Motion.PUSH, depth))
        drawing.draw(free_cube, begun, made)
    assert lying_state(free_cube) != before
    live.remove(free_cube)
    begun.give_back(free_cube)
    bpy.context.view_layer.update()
    assert lying_state(free_cube) == before


@pytest.mark.parametrize("hand", ["free_push.FreePush", "free_hold.FreeHold"])
def test_a_hand_that_finds_no_rest_says_which_it_is(palpate, hand):
    """What swallows a fingertip is another thing than what rolls away from it; all else is told as
    it was found.
    """
    room, name = hand.split(".")
    refusals, found = part("core.rest.refusals"), part("core.errors").PalpateError("found")
    hand = getattr(part(f"operators.stroke.answer.{room}"), name)
    refusal = part("operators.stroke.answer.free_stroke").refusal
    told = [
        refusal(hand, problem)
        for problem in (refusals.RestlessError("a"), refusals.SwallowedError("b"), found)
    ]
    assert told[2] is found
    assert len({"a", "b", *map(str, told)}) == 5
