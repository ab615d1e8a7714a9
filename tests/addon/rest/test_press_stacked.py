"""Presses, by the events of the modal side, of an object that lies on another soft one."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    begin,
    layer_names,
    lead,
    lying_state,
    part,
    sag,
    select,
    wait,
)

# Over the upper cube's top, and how far the finger goes down from there.
OVER, DOWN = (0.006, 0.001, 0.1155), (0.0, 0.0, -0.012)


@pytest.fixture
def upper(stack, tip):
    """A second cube over the first."""
    made = stack()
    select(made)
    return made


def height(thing):
    """Of its origin, metres."""
    bpy.context.view_layer.update()
    return thing.matrix_world.translation.z


def test_the_one_beneath_is_seen_to_give_way_and_all_is_given_back(
    free_cube, upper, sessions, states
):
    before = lying_state(free_cube), lying_state(upper)
    session = begin(sessions, states, upper)
    wait(session, lambda: session.snapshot.tick > 200)
    rested, sagged = height(upper), sag(free_cube)
    lead(session, states, OVER, DOWN)
    assert session.snapshot.fingers[0].touching
    assert np.abs(sag(free_cube) - sagged).max() > 3e-4
    assert height(upper) < rested - 3e-4
    session.post(states.Moment.CANCEL)
    assert (lying_state(free_cube), lying_state(upper)) == before


def test_the_force_is_that_of_the_pile(free_cube, upper, sessions, states):
    session = begin(sessions, states, upper)
    prop, settings = session.prop, part("core.pile.pile_settings").PileSettings
    lead(session, states, OVER, DOWN)
    felt = session.snapshot.fingers[0].contact_force
    felt = session.frames[0].turn_to_world(felt)
    session.post(states.Moment.CANCEL)
    rest, pose = part("core.rest.support"), part("core.contact.tool.pose").Pose
    (beneath,) = prop.others
    laid = [(prop.drawn.body, prop.start), (beneath.body, beneath.rested.rest.placement)]
    chosen = upper.palpate
    alone = part("core.pile.pile").Pile(
        laid,
        [rest.Floor(0.0, chosen.rest_friction)],
        [(session.tip.tool, pose.at(np.array(OVER)))],
        settings=settings(friction=chosen.rest_friction, tool_friction=chosen.static_friction),
    )
    alone.come_in()
    alone.lead([pose.at(np.add(OVER, DOWN))])
    expected = alone.settle()[0].tools[0].force
    assert felt[2] == pytest.approx(expected[2], rel=0.03)


def test_enter_keeps_all_where_they_are(free_cube, upper, sessions, states):
    session = begin(sessions, states, upper)
    lead(session, states, OVER, DOWN)
    lay = height(upper), sag(free_cube)
    session.post(states.Keep(session.seen.stays(upper)))
    assert session.kept
    assert layer_names(upper) == ["Rests", "Press 1"]
    assert layer_names(free_cube) == ["Rests"]
    assert height(upper) == pytest.approx(lay[0], abs=1e-6)
    np.testing.assert_allclose(sag(free_cube), lay[1], atol=1e-5)
    assert free_cube.palpate.is_laid


def test_a_press_ends_when_the_one_beneath_is_deleted(free_cube, upper, sessions, states):
    session = begin(sessions, states, upper)
    wait(session, lambda: session.snapshot.tick > 50)
    bpy.data.objects.remove(free_cube)
    session.tick()
    assert sessions.current() is None
    assert any("was deleted" in said.text for said in session.said)
    assert layer_names(upper) == []


def test_a_point_finds_the_one_beneath_as_it_is(free_cube, upper, sessions, states):
    bpy.context.scene.palpate.tip = "POINT"
    session = begin(sessions, states, upper)
    lead(session, states, (0.006, 0.001, 0.103), (0.0, 0.0, -0.004))
    assert session.snapshot.fingers[0].touching
    assert layer_names(free_cube) == []
    assert not free_cube.palpate.is_laid
    session.post(states.Moment.CANCEL)
