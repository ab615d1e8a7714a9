"""Recordings become Empties with keyframes, which lead a tool again."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
import pytest
from soft_scene import begin, error_of, part, select, soft_cube, wait

RATE = 1000
RADIUS, SUNK = 0.008, 0.003


@pytest.fixture
def tap(palpate, monkeypatch):
    """A second of a fingertip that goes 4 mm into the cube's top and comes out again."""
    dtype = part("core.record.recording").DTYPE
    samples = np.zeros(RATE + 1, dtype)
    samples["time"] = np.arange(RATE + 1) / RATE
    sunk = 0.004 * np.sin(np.pi * samples["time"]) ** 2
    samples["probe"] = [0.004, 0.0, 0.045]
    samples["probe"][:, 2] -= sunk
    samples["proxy"] = samples["probe"]
    samples["proxy"][:, 2] += sunk
    samples["force"][:, 2] = 100 * sunk
    recording = part("operators.record.recording")
    monkeypatch.setattr(recording, "_last", recording.Kept(samples, RATE))
    return sunk


def test_the_probe_moves_as_the_finger_did_and_carries_its_force(tap):
    thing, scene = soft_cube(), bpy.context.scene
    thing.scale, thing.rotation_euler, thing.location = (1, 1, 1), (0, np.pi / 2, 0), (1, 2, 3)
    bpy.context.view_layer.update()
    scene.frame_set(11)
    assert bpy.ops.palpate.animate_recording() == {"FINISHED"}
    probe = scene.palpate.source_empty
    fps = scene.render.fps
    for seconds in (0.0, 0.25, 0.5, 1.0):
        scene.frame_set(11 + round(seconds * fps))
        depth = tap[round(seconds * RATE)]
        # Turned by a right angle: the body's z is the world's x.
        wanted = np.array([1 + 0.045 - depth, 2.0, 3 - 0.004])
        np.testing.assert_allclose(probe.matrix_world.translation, wanted, atol=5e-5)
        assert probe["depth_m"] == pytest.approx(depth, abs=5e-5)
        np.testing.assert_allclose(probe["force_N"], [100 * depth, 0, 0], atol=5e-3)
        assert probe["strength_N"] == pytest.approx(100 * depth, abs=5e-3)
    assert scene.frame_end >= 11 + fps


def test_a_recorded_tap_is_baked_into_a_cache(tap, tmp_path):
    thing, scene = soft_cube(), bpy.context.scene
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "tap.blend"))
    scene.frame_set(1)
    assert bpy.ops.palpate.animate_recording() == {"FINISHED"}
    scene.palpate.tip, scene.palpate.tip_radius = "SPHERE", 0.02
    assert bpy.ops.palpate.press_frames(frame_start=1, frame_end=13, step=6) == {"FINISHED"}
    heights = []
    for frame in (1, 13):
        scene.frame_set(frame)
        evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
        heights.append(max(vertex.co.z for vertex in evaluated.data.vertices))
    assert heights[1] < heights[0] - 1e-4


def test_idle_seconds_before_the_touch_are_not_animated(tap, monkeypatch):
    recording, scene = part("operators.record.recording"), bpy.context.scene
    samples = np.concatenate(
        [np.repeat(recording.last().samples[:1], 5 * RATE), recording.last().samples]
    )
    samples["time"] = np.arange(len(samples)) / RATE
    monkeypatch.setattr(recording, "_last", recording.Kept(samples, RATE))
    soft_cube()
    scene.frame_set(1)
    assert bpy.ops.palpate.animate_recording() == {"FINISHED"}
    depths = []
    for frame in range(1, scene.render.fps + 1):
        scene.frame_set(frame)
        depths.append(scene.palpate.source_empty["depth_m"])
    assert depths[0] < 1e-4
    assert max(depths) > 0.0035


def test_the_recorded_finger_leads_and_not_the_pressers(tap):
    thing, scene = soft_cube(), bpy.context.scene
    scene.palpate.tip = "SPHERE"
    thing.palpate.pressers = bpy.data.collections.new("Hand")
    assert bpy.ops.palpate.animate_recording() == {"FINISHED"}
    assert thing.palpate.pressers is None
    (presser,) = _pressers(thing)
    scene.frame_set(scene.frame_current)
    np.testing.assert_allclose(
        presser.place, scene.palpate.source_empty.matrix_world.translation, atol=1e-6
    )


def test_a_fingertip_is_as_deep_as_it_went_beyond_the_surface(sessions, states):
    """A ball's depth below a flat top is known: its lowest place below the rest height."""
    thing, scene = soft_cube(), bpy.context.scene
    chosen = scene.palpate
    chosen.tip, chosen.tip_radius, chosen.own_sizes = "SPHERE", RADIUS, True
    chosen.record_from_start = True
    session = begin(sessions, states, thing)
    above = 0.025 + RADIUS
    for height in (above + 0.001, above - SUNK):
        post = states.SetDown if height > above else states.Move
        session.post(post((0.003, 0.001, height)))
        wait(session, lambda height=height: abs(session.snapshot.probe[2] - height) < 1e-6)
    shown = part("addon.overlay.reading").reading(session).depth
    assert shown == pytest.approx(SUNK, abs=2e-5)
    since = session.snapshot.time
    wait(session, lambda: session.snapshot.time > since + 0.5)
    session.post(states.Moment.CANCEL)
    assert bpy.ops.palpate.animate_recording() == {"FINISHED"}
    depths = []
    for frame in range(scene.frame_current, scene.frame_end + 1):
        scene.frame_set(frame)
        depths.append(chosen.source_empty["depth_m"])
    assert max(depths) == pytest.approx(SUNK, abs=2e-5)
    assert depths[0] < 0.5 * SUNK


def _pressers(thing):
    drawn = part("operators.object.drawn_body").open_body(thing, bpy.context.scene)
    graph = bpy.context.evaluated_depsgraph_get()
    return part("operators.animation.frames.pressers").pressers_of(thing, graph, drawn)


@pytest.mark.parametrize("own_sizes", [False, True])
def test_the_empty_is_as_large_as_the_finger(tap, own_sizes):
    thing, scene = soft_cube(), bpy.context.scene
    thing.scale, scene.unit_settings.scale_length = (2, 2, 2), 0.01
    bpy.context.view_layer.update()
    chosen = scene.palpate
    chosen.tip_radius, chosen.tip_share, chosen.own_sizes = 0.3, 20.0, own_sizes
    assert bpy.ops.palpate.animate_recording() == {"FINISHED"}
    bpy.context.view_layer.update()
    probe = chosen.source_empty
    radius = probe.empty_display_size * probe.matrix_world.to_scale().x
    # 20 % of the cube's diagonal.
    assert radius == pytest.approx(0.3 if own_sizes else 0.2 * 0.1 * 3**0.5, rel=1e-5)


def test_only_what_was_recorded_is_animated(tap, sessions, states, monkeypatch):
    first, second = soft_cube(), soft_cube()
    recording, scene = part("operators.record.recording"), bpy.context.scene
    kept = recording.last()
    scene.palpate.record_from_start = True
    begin(sessions, states, first)
    sessions.give_way("")
    pressed = recording.last().pressed
    assert pressed.find() == first
    monkeypatch.setattr(recording, "_last", replace(kept, pressed=pressed))
    select(second)
    assert f"{first.name} was recorded" in error_of(bpy.ops.palpate.animate_recording)
    assert scene.palpate.source_empty is None


def test_without_a_recording_it_is_refused(palpate, monkeypatch):
    soft_cube()
    monkeypatch.setattr(part("operators.record.recording"), "_last", None)
    assert "Nothing is recorded" in error_of(bpy.ops.palpate.animate_recording)
