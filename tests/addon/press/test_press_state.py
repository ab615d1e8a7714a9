"""The press as a pure function of state and event; no Blender is asked."""

from __future__ import annotations

import itertools

import pytest
from soft_scene import part

POINT = (0.0, 0.0, 0.1)


@pytest.fixture
def ps(installed):
    return part("operators.session.press_state")


def play(ps, *events):
    """The state after events, and all effects on the way."""
    state, effects = ps.PressState(), []
    for event in events:
        state, more = ps.transition(state, event)
        effects += more
    return state, effects


def test_a_pointer_press_goes_from_touch_to_kept_shape(ps):
    state, effects = play(
        ps,
        ps.Start(ps.Source.POINTER),
        ps.SetDown(POINT),
        ps.Move((0.0, 0.0, 0.09)),
        ps.Moment.RELEASE,
        ps.Keep(),
    )
    assert state.phase is ps.Phase.ENDED
    assert effects == [
        ps.Act.HANG_LIVE_LAYER,
        ps.StartServo(ps.Source.POINTER),
        ps.SetDown(POINT),
        ps.Move((0.0, 0.0, 0.09)),
        ps.Act.STOP_SERVO,
        ps.Act.KEEP_SHAPE,
    ]


def test_a_probe_in_the_air_leaves_no_shape_to_keep(ps):
    touched = (ps.Start(ps.Source.POINTER), ps.SetDown(POINT), ps.Moment.RELEASE)
    state, effects = play(ps, *touched, ps.Keep(dented=False))
    assert state.phase is ps.Phase.HOLDING
    assert "no shape" in state.message
    assert ps.Act.KEEP_SHAPE not in effects


def test_nothing_pressed_cannot_be_kept(ps):
    state, effects = play(ps, ps.Start(ps.Source.POINTER), ps.Keep())
    assert state.phase is ps.Phase.READY
    assert ps.Act.KEEP_SHAPE not in effects


def test_moving_without_the_button_does_not_move_the_probe(ps):
    _, effects = play(ps, ps.Start(ps.Source.POINTER), ps.Move(POINT))
    assert not [effect for effect in effects if isinstance(effect, ps.Move)]


def test_a_device_that_goes_away_leaves_the_rest_shape_and_comes_back(ps):
    state, effects = play(ps, ps.Start(ps.Source.DEVICE), ps.Fault("gone"))
    assert state.phase is ps.Phase.LOST
    assert ps.Act.DRAW_REST in effects
    assert ps.Say("gone", warning=True) in effects
    state, _ = ps.transition(state, ps.Moment.RECOVERED)
    assert state.phase is ps.Phase.FEELING


def test_a_lost_device_has_no_shape_to_keep(ps):
    state, effects = play(ps, ps.Start(ps.Source.DEVICE), ps.Fault("gone"), ps.Keep())
    assert state.phase is ps.Phase.LOST
    assert ps.Act.KEEP_SHAPE not in effects


def test_the_force_is_let_go_at_once_and_comes_back_only_after_a_calm_moment(ps):
    state, effects = play(ps, ps.Start(ps.Source.DEVICE), ps.LetGo(10.0))
    assert not state.force_on
    assert effects[-1] == ps.SwitchForce(on=False)
    # A second strike in alarm must not bring it back.
    alarmed, effects = ps.transition(state, ps.BringBack(10.0 + 0.5 * ps.CALM_SECONDS))
    assert not alarmed.force_on
    assert effects == ()
    calm, effects = ps.transition(alarmed, ps.BringBack(10.1 + ps.CALM_SECONDS))
    assert calm.force_on
    assert effects == (ps.SwitchForce(on=True),)


def test_the_force_can_be_let_go_while_the_device_is_away_and_stays_off_when_it_returns(ps):
    walk = (ps.Fault("gone"), ps.LetGo(1.0), ps.Moment.RECOVERED)
    state, effects = play(ps, ps.Start(ps.Source.DEVICE), *walk)
    assert not state.force_on
    assert effects.count(ps.SwitchForce(on=False)) == 1
    assert ps.SwitchForce(on=True) not in effects


def test_a_pointer_has_no_force_to_let_go(ps):
    state, effects = play(ps, ps.Start(ps.Source.POINTER), ps.LetGo(1.0))
    assert state.force_on
    assert not [effect for effect in effects if isinstance(effect, ps.SwitchForce)]


def test_a_save_sees_no_live_shape_and_the_press_goes_on(ps):
    state, effects = play(
        ps,
        ps.Start(ps.Source.POINTER),
        ps.SetDown(POINT),
        ps.Moment.SAVE_BEGINS,
        ps.Moment.SAVE_ENDS,
    )
    assert state.phase is ps.Phase.DRAGGING
    assert effects[-2:] == [ps.Act.REMOVE_LIVE_LAYER, ps.Act.HANG_LIVE_LAYER]


def test_whatever_happened_giving_way_stops_the_servo_and_cleans_the_mesh(ps):
    """All walks of three events from both starts."""
    events = [
        ps.SetDown(POINT),
        ps.Move(POINT),
        ps.Moment.RELEASE,
        ps.Fault("gone"),
        ps.Moment.RECOVERED,
        ps.LetGo(0.0),
        ps.Moment.SAVE_BEGINS,
        ps.Moment.SAVE_ENDS,
        ps.Keep(),
        ps.Moment.CANCEL,
    ]
    for source in ps.Source:
        for walk in itertools.product(events, repeat=3):
            state, effects = play(ps, ps.Start(source), *walk, ps.GiveWay("end"))
            assert state.phase is ps.Phase.ENDED
            assert effects.count(ps.Act.STOP_SERVO) == 1
            hung = effects.count(ps.Act.HANG_LIVE_LAYER)
            removed = effects.count(ps.Act.REMOVE_LIVE_LAYER) + effects.count(ps.Act.KEEP_SHAPE)
            assert hung == removed, f"{source}, {walk}"


def test_after_the_end_nothing_has_an_effect(ps):
    state, _ = play(ps, ps.Start(ps.Source.POINTER), ps.Moment.CANCEL)
    for event in (ps.Start(ps.Source.POINTER), ps.SetDown(POINT), ps.Keep(), ps.GiveWay("")):
        assert ps.transition(state, event) == (state, ())


def test_a_pinch_leads_each_finger_and_takes_hold_of_it_again(ps):
    other = (0.1, 0.0, 0.0)
    state, effects = play(
        ps,
        ps.Start(ps.Source.POINTER),
        ps.SetDown(POINT, 0),
        ps.Moment.RELEASE,
        ps.SetDown(other, 1),
        ps.Move(POINT, 1),
        ps.Moment.RELEASE,
        ps.Moment.GRAB,
        ps.Move(other, 0),
    )
    assert state.phase is ps.Phase.DRAGGING
    assert effects[2:] == [
        ps.SetDown(POINT, 0),
        ps.SetDown(other, 1),
        ps.Move(POINT, 1),
        ps.Move(other, 0),
    ]


def test_nothing_can_be_grabbed_that_the_pointer_does_not_lead(ps):
    state, effects = play(ps, ps.Start(ps.Source.EMPTY), ps.Moment.GRAB, ps.SetDown(POINT))
    assert state.phase is ps.Phase.FEELING
    assert ps.SetDown(POINT) not in effects


def test_space_lets_a_second_finger_s_device_go_while_the_pointer_leads_the_first(ps):
    state, effects = play(ps, ps.Start(ps.Source.POINTER, device=True), ps.LetGo(1.0))
    assert effects[-1] == ps.SwitchForce(on=False)
    assert not state.force_on
    _, effects = play(ps, ps.Start(ps.Source.POINTER), ps.LetGo(1.0))
    assert ps.SwitchForce(on=False) not in effects
