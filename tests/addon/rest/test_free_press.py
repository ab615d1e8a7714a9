"""Presses of objects that nobody holds, through the servo, by the events of the modal side."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    at_rest,
    begin,
    empty,
    layer_names,
    lead,
    lying_state,
    part,
    seen_places,
    set_off,
    wait,
)

RADIUS = 0.012
# Outside, over the top and beside the cube of 50 mm that stands around the origin.
OVER, BESIDE = (0.004, 0.002, 0.0385), (0.0385, 0.0, 0.0)


def lowest(thing):
    bpy.context.view_layer.update()
    matrix = np.array(thing.matrix_world)
    return (seen_places(thing) @ matrix[:3, :3].T + matrix[:3, 3])[:, 2].min()


def test_a_press_from_above_feels_the_floor_and_is_given_back(free_cube, tip, sessions, states):
    before = lying_state(free_cube)
    session = begin(sessions, states, free_cube)
    lead(session, states, OVER, (0.0, 0.0, -0.006))
    felt = session.snapshot.fingers[0]
    rest, tools = part("core.rest.resting"), part("core.contact.tool.tools")
    pose, support = part("core.contact.tool.pose").Pose, part("core.rest.support")
    body, place = session.drawn.body, np.array(OVER)
    alone = rest.Resting(
        body,
        [support.Floor(-0.025, 0.5)],
        [(tools.sphere(RADIUS), pose(place, np.eye(3)))],
        settings=rest.RestSettings(free_cube.palpate.young_modulus, 0.5),
    )
    alone.settle()
    alone.lead([pose(place - (0.0, 0.0, 0.006), np.eye(3))])
    expected = alone.settle().tools[0].force
    force = session.frames[0].turn_to_world(felt.contact_force)
    assert force[2] == pytest.approx(expected[2], rel=0.03)
    # What is seen is the body as it is borne: pressed in above, and not through the floor.
    assert abs(lowest(free_cube) + 0.025) < 2e-4
    figures = part("addon.overlay.reading").readings(session)[0]
    assert figures.touching
    assert np.allclose(figures.probe, place - (0.0, 0.0, 0.006), atol=1e-4)
    session.post(states.Moment.CANCEL)
    assert lying_state(free_cube) == before


def test_what_gives_way_with_time_does_so_under_a_tool(free_cube, tip, sessions, states):
    free_cube.palpate.relaxation = "MEMORY_FOAM"
    session = begin(sessions, states, free_cube)
    end = set_off(session, states, OVER, (0.0, 0.0, -0.006))

    def finger():
        return session.loop.servo.snapshot().fingers[0]

    wait(session, lambda: np.allclose(finger().probe, end, atol=1e-6))
    at_first = finger().contact_force[2]
    assert at_first > 0.0
    wait(session, lambda: finger().contact_force[2] < 0.6 * at_first)
    session.post(states.Moment.CANCEL)


def test_a_press_from_the_side_takes_it_along_and_enter_keeps_it_there(
    free_cube, tip, sessions, states
):
    free_cube.palpate.rest_friction = 0.1
    session = begin(sessions, states, free_cube)
    lead(session, states, BESIDE, (-0.02, 0.0, 0.0))
    assert -0.022 < free_cube.location.x < -0.01
    # Its hand is in the world: the object has moved, the finger is where it was led.
    assert np.allclose(session.hands[0].origin, 0.0)
    session.post(states.Keep(session.seen.stays(free_cube)))
    assert session.kept
    assert session.kept_name == "Press 1"
    assert layer_names(free_cube) == ["Rests", "Press 1"]
    assert -0.022 < free_cube.location.x < -0.01
    bpy.ops.palpate.reset_rest()
    assert np.allclose(free_cube.location, 0.0)


def test_an_empty_that_leaves_it_has_only_moved_it(free_cube, tip, sessions, states):
    free_cube.palpate.rest_friction = 0.1
    finger = empty("Finger", BESIDE)
    bpy.context.scene.palpate.source_empty = finger
    session = begin(sessions, states, free_cube, "EMPTY")
    for x in np.linspace(BESIDE[0], 0.02, 8):
        finger.location.x = x
        bpy.context.view_layer.update()
        session.tick()
        at_rest(session, tuple(finger.matrix_world.translation))
    finger.location.x = 0.1
    bpy.context.view_layer.update()
    session.tick()
    at_rest(session, tuple(finger.matrix_world.translation))
    session.tick()
    assert session.seen.stays(free_cube)
    session.post(states.Keep(True))
    assert session.kept
    assert layer_names(free_cube) == ["Rests"]
    assert free_cube.location.x < -0.01


def test_a_press_on_a_board_feels_the_board(free_cube, board, tip, sessions, states):
    board((0.0, 0.0, -0.03))
    free_cube.palpate.floor = "NONE"
    session = begin(sessions, states, free_cube)
    wait(session, lambda: session.snapshot.tick > 500)
    placed = np.array(free_cube.matrix_world)
    assert abs(lowest(free_cube) + 0.03) < 3e-4
    lead(session, states, OVER, (0.0, 0.0, -0.008))
    assert session.snapshot.fingers[0].touching
    np.testing.assert_allclose(np.array(free_cube.matrix_world)[:3, 3], placed[:3, 3], atol=2e-3)


def test_a_simulated_device_presses_it_where_it_lies(free_cube, tip, sessions, states):
    free_cube.location = (0.3, 0.1, 0.2)
    bpy.context.view_layer.update()
    tip.source = "SIMULATED"
    session = begin(sessions, states, free_cube, "DEVICE")
    wait(session, lambda: session.snapshot is not None and session.snapshot.touching)
    wait(session, lambda: session.snapshot.output_force[2] > 0.05)
    np.testing.assert_allclose(np.array(free_cube.location)[:2], (0.3, 0.1), atol=0.02)
    session.post(states.Moment.CANCEL)
    np.testing.assert_allclose(free_cube.location, (0.3, 0.1, 0.2), atol=1e-7)


def test_a_file_is_saved_with_the_object_as_it_was(free_cube, tip, sessions, states):
    before = lying_state(free_cube)
    session = begin(sessions, states, free_cube)
    lead(session, states, OVER, (0.0, 0.0, -0.004))
    session.post(states.Moment.SAVE_BEGINS)
    session.tick()
    assert lying_state(free_cube) == before
    session.post(states.Moment.SAVE_ENDS)
    session.tick()
    assert free_cube.palpate.is_laid
    session.post(states.Moment.CANCEL)
    assert lying_state(free_cube) == before


def test_a_recording_of_it_is_one_in_the_world(free_cube, tip, sessions, states):
    bpy.context.scene.palpate.record_from_start = True
    session = begin(sessions, states, free_cube)
    lead(session, states, OVER, (0.0, 0.0, -0.004))
    session.post(states.Moment.CANCEL)
    free_cube.location.x = 1.0
    bpy.context.view_layer.update()
    bpy.ops.palpate.animate_recording()
    probe = bpy.data.objects["Palpate Probe"]
    bpy.context.scene.frame_set(bpy.context.scene.frame_end)
    assert probe.parent is None
    np.testing.assert_allclose(probe.matrix_world.translation[:2], OVER[:2], atol=1e-4)
