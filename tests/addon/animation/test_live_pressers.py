"""Pressers: a soft object follows what presses it, in any order of frames."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from pressed_scene import tapped_by_ball
from soft_scene import error_of, mesh_state, part, seen_places


@pytest.fixture
def pressed(palpate):
    """A cube with a ball that goes into and out of its top within the frames 1 to 7."""
    return tapped_by_ball()


def test_frames_may_come_in_any_order(pressed):
    scene, rest = bpy.context.scene, mesh_state(pressed)["mesh"]
    seen = {}
    for frame in (1, 2, 3, 4, 5, 6, 7):
        scene.frame_set(frame)
        seen[frame] = seen_places(pressed)
    still = np.array([vertex.co for vertex in pressed.data.vertices])
    np.testing.assert_allclose(seen[1], still, atol=1e-7)
    assert (still - seen[4])[:, 2].max() > 1e-4
    for frame in (4, 1, 6, 3, 7, 2, 5):
        scene.frame_set(frame)
        np.testing.assert_allclose(seen_places(pressed), seen[frame], atol=1e-9)
    assert mesh_state(pressed)["mesh"] == rest


def test_a_presser_moved_by_hand_is_followed_at_once(pressed):
    before = seen_places(pressed)
    ball = bpy.data.objects["Ball"]
    ball.animation_data_clear()
    ball.location.z = 0.041
    bpy.context.view_layer.update()
    bpy.context.view_layer.update()
    assert (before - seen_places(pressed))[:, 2].max() > 1e-4


def test_what_is_live_is_baked(pressed, tmp_path):
    scene, rest = bpy.context.scene, seen_places(pressed)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "pressed.blend"))
    scene.frame_set(4)
    live = seen_places(pressed)
    bpy.context.view_layer.objects.active = pressed
    assert bpy.ops.palpate.press_frames(frame_start=1, frame_end=7) == {"FINISHED"}
    scene.frame_set(4)
    assert [one.type for one in pressed.modifiers] == ["MESH_CACHE"]
    # What comes down from above may rest a little aside of what is there at once.
    live_dent, baked_dent = (np.mean((rest - seen)[:, 2]) for seen in (live, seen_places(pressed)))
    assert baked_dent == pytest.approx(live_dent, rel=0.3)


def test_no_dent_of_another_frame_is_seen_while_it_is_baked(pressed, tmp_path, monkeypatch):
    scene, rest = bpy.context.scene, seen_places(pressed)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "pressed.blend"))
    scene.frame_set(4)
    dented = seen_places(pressed)
    assert np.abs(dented - rest).max() > 1e-4
    frames = part("operators.animation.all_frames")
    seen, original = [], frames.press_frames

    def watched(*arguments):
        for here in original(*arguments):
            seen.append(seen_places(pressed))
            yield here
        raise part("core.errors").PalpateError("The line is down")

    monkeypatch.setattr(frames, "press_frames", watched)
    bpy.context.view_layer.objects.active = pressed
    assert "The line is down" in error_of(bpy.ops.palpate.press_frames, frame_start=1, frame_end=7)
    np.testing.assert_array_equal(seen, [rest] * 7)
    # And it is as it was.
    np.testing.assert_array_equal(seen_places(pressed), dented)


def test_several_parts_press_together_and_an_empty_is_a_sphere(pressed):
    scene = bpy.context.scene
    scene.frame_set(4)
    one = seen_places(pressed)
    finger = bpy.data.objects.new("Finger", None)
    scene.collection.objects.link(finger)
    finger.empty_display_size, finger.location = 0.02, (0.041, 0.0, 0.0)
    bpy.context.view_layer.update()
    pressed.palpate.pressers.objects.link(finger)
    scene.frame_set(4)
    both = seen_places(pressed)
    moved = both - one
    assert moved[:, 0].min() < -1e-4
    assert part("operators.animation.failures").reason(pressed) == ""


def test_an_empty_collection_is_named(pressed):
    pressed.palpate.pressers = bpy.data.collections.new("Hand")
    told = part("operators.animation.failures").reason(pressed)
    assert "nothing is in Hand" in str(told)


def test_what_cannot_press_is_told_and_the_rest_goes_on(pressed):
    failures = part("operators.animation.failures")
    light = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    bpy.context.scene.collection.objects.link(light)
    pressed.palpate.pressers.objects.link(light)
    bpy.context.scene.frame_set(2)
    assert "Lamp is neither a mesh nor an Empty" in str(failures.reason(pressed))
    bpy.context.view_layer.objects.active = pressed
    assert "Lamp is neither" in error_of(bpy.ops.palpate.press_frames, keep="KEYS")
    pressed.palpate.pressers.objects.unlink(light)
    bpy.context.scene.frame_set(4)
    assert failures.reason(pressed) == ""


def test_without_pressers_nothing_is_left(pressed):
    bpy.context.scene.frame_set(4)
    assert [one.name for one in pressed.modifiers] == ["Palpate Pressers"]
    pressed.palpate.pressers = None
    assert not pressed.modifiers
    assert "Palpate Pressers" not in pressed.data.attributes


def test_only_a_change_of_the_objects_is_looked_through(pressed, monkeypatch):
    live, scene = part("operators.animation.live_pressers"), bpy.context.scene
    scene.frame_set(1)
    looked = []
    handle = live.ObjectHandle
    monkeypatch.setattr(live, "ObjectHandle", type("Seen", (), {"of": looked.append}))
    scene.frame_set(4)
    assert not looked
    monkeypatch.setattr(live, "ObjectHandle", handle)
    # A copy is found, and follows by itself.
    other = pressed.copy()
    other.data = pressed.data.copy()
    scene.collection.objects.link(other)
    bpy.context.view_layer.update()
    for one in (1, 4):
        scene.frame_set(one)
    np.testing.assert_allclose(seen_places(other), seen_places(pressed), atol=1e-7)
    assert (seen_places(other) != np.array([vertex.co for vertex in other.data.vertices])).any()
