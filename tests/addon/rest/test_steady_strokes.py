"""Strokes and presses on an object that nobody pins and a hand steadies: it stays where it lies."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import begin, layer_names, lead, lying_state, part, select

RADIUS, TOP, SIDE = 0.012, (0.004, 0.002, 0.025), (0.025, 0.0, 0.004)
BESIDE = (0.0385, 0.0, 0.0)


@pytest.fixture
def steady_cube(free_cube):
    free_cube.palpate.steady = True
    bpy.ops.palpate.settle()
    return free_cube


def stroke(thing, depth=0.0, **more):
    select(thing)
    assert bpy.ops.palpate.stroke(radius=RADIUS, depth=depth, **more) == {"FINISHED"}


def begun_on(thing):
    """The body, a stroke on its top that has begun, and what motions are asked with."""
    body = part("operators.object.drawn_body").open_body(thing, bpy.context.scene)
    parts = "operators.stroke.answer."
    grips = part(f"{parts}grips").grips_at(body, np.array(TOP), RADIUS, (False, False, False))
    begun = part(f"{parts}free_stroke").FreeStroke.begin(thing, body, grips)
    return body, begun, part(f"{parts}motion")


def dent(thing, name="Press 1"):
    """Displacements (p, 3) of a layer, metres."""
    return part("operators.layer.layers").displacement(thing, thing.modifiers[name])


@pytest.mark.parametrize("place", [TOP, SIDE])
def test_a_push_dents_it_and_it_lies_where_it_lay(steady_cube, place):
    before = np.array(steady_cube.matrix_world)
    stroke(steady_cube, 0.006, place=place)
    np.testing.assert_allclose(np.array(steady_cube.matrix_world), before, atol=3e-5)
    assert layer_names(steady_cube) == ["Rests", "Press 1"]
    moved = dent(steady_cube)
    assert np.abs(moved).max() > 2e-4
    # What is drawn keeps above the floor.
    bpy.context.view_layer.update()
    matrix = np.array(steady_cube.matrix_world)
    evaluated = steady_cube.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    low = min((matrix @ [*vertex.co, 1.0])[2] for vertex in evaluated.vertices)
    assert low > -0.025 - 1e-5


def test_without_a_hand_the_same_push_moves_it(free_cube):
    free_cube.palpate.rest_friction = 0.1
    stroke(free_cube, 0.02, place=SIDE)
    assert free_cube.location.x < -0.005


def test_a_push_from_above_takes_the_force_of_one_that_lies_there(steady_cube, force_alone):
    _, begun, motions = begun_on(steady_cube)
    _, made = begun.stroked(motions.Asked(motions.Motion.PUSH, 0.003))
    begun.close()
    assert made.force == pytest.approx(np.linalg.norm(force_alone), rel=0.1)


@pytest.mark.parametrize(
    "motion",
    [
        {"motion": "GRAB", "by": (0.006, 0.0, 0.004)},
        {"motion": "TWIST", "angle": 0.5},
        {"motion": "PINCH", "share": 0.3},
        {"depth": -0.006},
    ],
)
def test_what_holds_a_patch_stretches_it_and_stays_as_a_layer(steady_cube, motion):
    before = np.array(steady_cube.matrix_world)
    stroke(steady_cube, place=TOP, **motion)
    np.testing.assert_allclose(np.array(steady_cube.matrix_world), before, atol=3e-5)
    assert layer_names(steady_cube) == ["Rests", "Press 1"]


def test_a_grab_takes_the_patch_as_far_as_the_hand_goes(steady_cube):
    body, begun, motions = begun_on(steady_cube)
    way = np.array([0.006, 0.0, 0.004])
    _, made = begun.stroked(motions.Asked(motions.Motion.GRAB, by=way))
    begun.close()
    sag = begun.rested.displacements
    (gone,) = body.surface_displacements(made.displacements - sag, np.array([TOP]))
    np.testing.assert_allclose(gone, way, atol=0.1 * np.linalg.norm(way))
    # The rest is held by all of its mass, and hardly moves in the mean.
    mean = (made.displacements - sag).mean(axis=0)
    assert np.linalg.norm(mean) < 0.35 * np.linalg.norm(way)


@pytest.mark.parametrize("shape", ["LINEAR", "ROTATION_STRAIN"])
def test_a_press_from_the_side_does_not_move_it(steady_cube, tip, sessions, states, shape):
    steady_cube.palpate.shape = shape
    before = lying_state(steady_cube)
    session = begin(sessions, states, steady_cube)
    lead(session, states, BESIDE, (-0.006, 0.0, 0.0))
    felt = session.snapshot.fingers[0]
    assert felt.touching
    placement, turn = session.snapshot.placement
    rested = session.prop.start
    np.testing.assert_allclose(turn, rested.rotation, atol=1e-9)
    np.testing.assert_allclose(placement[:2], rested.position[:2], atol=1e-9)
    # Nor is it drawn turned: what is far from the fingertip hardly moves.
    far = session.drawn.surface_nodes[:, 0] < 0.0
    assert np.abs(session.seen.displacements[far]).max() < 2e-3
    session.post(states.Moment.CANCEL)
    assert lying_state(steady_cube) == before


def test_settle_does_not_steady_it(steady_cube):
    steady_cube.rotation_euler = (0.0, 0.6, 0.0)
    bpy.context.view_layer.update()
    bpy.ops.palpate.settle()
    # It falls onto a face, which a hand that steadies it would not let it do.
    angle = steady_cube.matrix_world.to_euler().y % (np.pi / 2)
    assert min(angle, np.pi / 2 - angle) < 1e-2


def test_a_press_meets_the_surface_where_layers_show_it(steady_cube, tip, sessions, states):
    """A hand that is over a place that was grabbed feels nothing, and then as much as without."""
    select(steady_cube)
    way = (0.004, 0.0, 0.006)
    made = bpy.ops.palpate.stroke(place=TOP, radius=0.045, motion="GRAB", by=way)
    assert made == {"FINISHED"}
    bpy.context.view_layer.update()
    session = begin(sessions, states, steady_cube)
    touched = part("operators.place.touched_place")
    frame = part("operators.scene.drawn_surface").frame_of(steady_cube, bpy.context.scene)
    over = np.array([TOP[0] + 0.002, TOP[1], 0.1])
    place = touched.under_ray(steady_cube, frame, over, np.array([0.0, 0.0, -1.0]))
    assert place.seen[2] - place.rest[2] > 0.0015
    session.touch(place, steady_cube)
    hand = session.hands[0]
    start = hand.body_from_world(
        frame.world_from_body(place.seen) + np.array([0.0, 0.0, RADIUS + 2e-4])
    )
    session.post(states.SetDown(tuple(start), 0))
    session.tick()
    assert not session.snapshot.fingers[0].touching
    down = hand.rotation.T @ [0.0, 0.0, -0.0032]
    lead(session, states, tuple(start), tuple(down))
    there = np.linalg.norm(session.snapshot.fingers[0].contact_force)
    session.post(states.Moment.CANCEL)
    begin_again = begin(sessions, states, steady_cube)
    prop = begin_again.prop
    (sag,) = prop.drawn.surface_displacements(prop._rested.displacements, place.rest[None])
    start = prop.start.to_world(place.rest + sag) + np.array([0.0, 0.0, RADIUS + 2e-4])
    lead(begin_again, states, tuple(start), (0.0, 0.0, -0.0032))
    alone = np.linalg.norm(begin_again.snapshot.fingers[0].contact_force)
    begin_again.post(states.Moment.CANCEL)
    assert there == pytest.approx(alone, rel=0.05)
    assert there > 0.02
