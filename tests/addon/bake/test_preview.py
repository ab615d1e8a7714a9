"""A coarse body can be pressed while the fine one is baked, and is gone when that is there."""

from __future__ import annotations

import time

import bpy
import numpy as np
import pytest
from soft_scene import (
    begin_pressed,
    cube,
    layer_names,
    locate,
    mesh_state,
    part,
    press_down,
    status,
)


@pytest.fixture
def previewed(palpate, monkeypatch):
    """A cube that is pinned, its bake, and its preview, which the bake is not before."""
    yield from made_soft_by_hand(monkeypatch, "BELOW")


@pytest.fixture
def standing(palpate, monkeypatch):
    """The same of one whose pins nobody chose."""
    yield from made_soft_by_hand(monkeypatch, None)


def made_soft_by_hand(monkeypatch, pins):
    bake = part("operators.bake.bake_session")
    monkeypatch.setattr(bake, "QUICK_SECONDS", 0.0)
    thing = cube()
    if pins is not None:
        thing.palpate.pin_mode = pins
    session = bake.start(thing, bpy.context.scene, by_hand=True)
    end = time.monotonic() + 60.0
    while not session.preview_off:
        session.poll()
        assert time.monotonic() < end, "waited in vain for the preview"
        time.sleep(0.01)
    yield thing, session
    session.end()


def pressing():
    """Modules of a running press, and of its events."""
    return part("operators.session.press_session"), part("operators.session.press_events")


def finish(session):
    """Wait for the fine body and give it to the object."""
    while not session.poll():
        time.sleep(0.01)
    return session.commit()[0]


def test_a_preview_is_pressed_and_its_layer_outlives_it(previewed):
    thing, session = previewed
    before = mesh_state(thing)
    assert 0.0 < thing.palpate.preview_off < 0.1
    assert status(thing).fit.name == "READY"
    assert locate(thing) is None
    coarse = thing.palpate.body_key
    press_down(thing)
    body = finish(session)
    assert thing.palpate.body_key == body.key != coarse
    assert thing.palpate.preview_off == 0.0
    assert locate(thing).is_file()
    assert layer_names(thing) == ["Press 1"]
    assert mesh_state(thing)["mesh"] == before["mesh"]
    press_down(thing)


def test_a_preview_of_what_rests_where_it_stands_is_pushed(standing):
    thing, session = standing
    assert thing.palpate.pin_mode == "NONE"
    top = (0.0, 0.0, 0.025)
    for _ in range(2):
        made = bpy.ops.palpate.stroke(place=top, radius=0.012, depth=0.004)
        assert made == {"FINISHED"}
        if session is not None:
            finish(session)
            session = None
    assert layer_names(thing) == ["Rests", "Press 1", "Press 2"]
    # It lies where it stood, but for how it is borne.
    np.testing.assert_allclose(np.array(thing.location), 0.0, atol=1e-3)


def test_a_running_press_goes_on_and_the_fine_body_waits_for_it(previewed):
    thing, session = previewed
    sessions, states = (
        part("operators.session.press_session"),
        part("operators.session.press_events"),
    )
    press = begin_pressed(sessions, states, thing)
    while not session.poll():
        time.sleep(0.01)
    assert session.awaits_press
    assert not session.can_commit
    press.post(states.Keep(dented=True))
    assert session.can_commit
    session.commit()
    assert layer_names(thing) == ["Press 1"]


def test_a_cancelled_bake_takes_its_preview_back(previewed):
    thing, session = previewed
    session.end()
    assert not thing.palpate.body_key
    assert not thing.palpate.preview_off
    assert "nodes" not in thing.palpate
    assert locate(thing) is None


def test_a_cancelled_bake_ends_the_press_of_its_preview(previewed):
    thing, session = previewed
    sessions, states = (
        part("operators.session.press_session"),
        part("operators.session.press_events"),
    )
    before = mesh_state(thing)
    begin_pressed(sessions, states, thing)
    session.end()
    assert sessions.current() is None
    assert layer_names(thing) == []
    assert mesh_state(thing) == before


def test_a_preview_that_fails_leaves_the_bake_alone(previewed, monkeypatch):
    thing, session = previewed

    def fails():
        raise part("core.errors").PalpateError("the disk is full")

    monkeypatch.setattr(session.preview, "poll", fails)
    body = finish(session)
    assert session.preview is None
    assert thing.palpate.body_key == body.key


def test_a_quick_bake_has_no_preview(palpate, monkeypatch):
    bake = part("operators.bake.bake_session")
    monkeypatch.setattr(bake, "QUICK_SECONDS", np.inf)
    session = bake.start(cube(), bpy.context.scene, by_hand=True)
    assert session.preview is None
    session.end()


@pytest.mark.usefixtures("previewed")
def test_a_file_saved_with_a_preview_opens_with_one_that_can_be_pressed(tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "previewed.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "previewed.blend"))
    again = bpy.context.object
    assert part("operators.bake.bake_session").current() is None
    assert again.palpate.preview_off > 0.0
    press_down(again)
