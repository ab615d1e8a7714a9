"""Pressers that cannot be followed: told once, tried again when something has changed, never waited
for.
"""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from pressed_scene import collection, tapped_by_ball
from soft_scene import empty, locate, moved, part, pose_by_bone, seen_places


@pytest.fixture
def pressed(palpate):
    """A cube that a ball taps."""
    return tapped_by_ball()


@pytest.fixture
def opened(pressed, monkeypatch):
    """The objects whose bodies are opened from now on."""
    live, found = part("operators.animation.live_pressers"), []
    open_body = live.open_body

    def noted(thing, *arguments, **words):
        found.append(thing.name)
        return open_body(thing, *arguments, **words)

    monkeypatch.setattr(live, "open_body", noted)
    return found


def reason(thing):
    return str(part("operators.animation.failures").reason(thing))


def move_something(times=1):
    """Moves of what presses nothing."""
    lamp = bpy.data.objects.get("Lamp") or empty("Lamp")
    for _ in range(times):
        lamp.location.x += 1.0
        bpy.context.view_layer.update()


def test_neither_opening_a_file_nor_playing_it_bakes_a_missing_body(pressed, tmp_path):
    alone = tmp_path / "alone.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(alone))
    locate(pressed).unlink()
    bpy.ops.wm.open_mainfile(filepath=str(alone))
    for frame in (2, 4):
        bpy.context.scene.frame_set(frame)
    thing = next(one for one in bpy.data.objects if one.palpate.pressers)
    assert locate(thing) is None
    assert "press Rebuild Body" in reason(thing)
    # A click may: it follows from the next move on.
    bpy.context.view_layer.objects.active = thing
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    move_something(2)
    assert reason(thing) == ""
    # So may a choice of Pressers.
    locate(thing).unlink()
    hand, thing.palpate.pressers = thing.palpate.pressers, None
    thing.palpate.pressers = hand
    assert reason(thing) == ""
    assert locate(thing) is not None


def test_new_pins_wait_for_a_click(pressed):
    bpy.context.scene.frame_set(2)
    key = pressed.palpate.body_key
    pressed.palpate.pin_fraction = 2.0 * pressed.palpate.pin_fraction
    part("operators.animation.live_pressers").forget()
    bpy.context.scene.frame_set(4)
    assert pressed.palpate.body_key == key
    assert "press Update Pins" in reason(pressed)


def test_what_is_small_is_counted_of_the_tetrahedra(pressed, monkeypatch):
    drawn = part("operators.object.drawn_body")
    pressed.palpate.free_surface_count = 1
    handle = drawn.ObjectHandle.of(pressed)
    assert drawn._is_small(handle, "as it is")
    monkeypatch.setattr(drawn, "MOST_NODES_AT_ONCE", 5)
    assert not drawn._is_small(handle, "with another bound")


def test_a_failure_is_not_tried_again_until_the_mesh_is_another(pressed, opened):
    bpy.context.scene.frame_set(4)
    corner, before = pressed.data.vertices[0].co, pressed.data.vertices[0].co.x
    corner.x *= 1.2
    pressed.data.update()
    part("operators.animation.live_pressers").forget()
    move_something(10)
    assert "press Make Soft" in reason(pressed)
    assert len(opened) == 1
    pressed.data.vertices[0].co.x = before
    pressed.data.update()
    move_something(2)
    assert reason(pressed) == ""
    assert len(opened) == 2


def test_what_is_not_shown_is_told_and_does_not_stop_the_next(pressed):
    scene = bpy.context.scene
    bpy.context.view_layer.objects.active = pressed
    other = pressed.copy()
    other.data = pressed.data.copy()
    scene.collection.objects.link(other)
    pose_by_bone(pressed, 0.2)
    hidden = collection("Hidden", pressed)
    scene.collection.children.link(hidden)
    for one in pressed.users_collection:
        if one != hidden:
            one.objects.unlink(pressed)
    bpy.context.view_layer.layer_collection.children["Hidden"].exclude = True
    scene.frame_set(4)
    assert "is not in this view layer or render" in reason(pressed)
    assert reason(other) == ""
    assert np.abs(moved(other, "Palpate Pressers")).max() > 1e-4


def test_a_bug_stops_no_other_object_and_is_raised(pressed, monkeypatch):
    live, scene = part("operators.animation.live_pressers"), bpy.context.scene
    other = pressed.copy()
    other.data = pressed.data.copy()
    scene.collection.objects.link(other)
    press, ball = live._press, bpy.data.objects["Ball"]

    def broken(thing, *arguments, **words):
        if thing == pressed:
            raise RuntimeError("broken")
        press(thing, *arguments, **words)

    with live.paused():
        scene.frame_set(4)
    monkeypatch.setattr(live, "_press", broken)
    graph = bpy.context.evaluated_depsgraph_get()
    with pytest.raises(ExceptionGroup) as raised:
        live.follow_all(graph)
    assert [str(one) for one in raised.value.exceptions] == ["broken"]
    assert reason(pressed) == "broken"
    assert np.abs(moved(other, "Palpate Pressers")).max() > 1e-4
    # Until something moves.
    live.follow_all(graph)
    assert ball.matrix_world.translation.z == pytest.approx(0.041)


def test_the_hull_of_a_rigid_presser_is_made_once(pressed, monkeypatch):
    hull, made = part("operators.tool.hull"), []
    blenders = hull._blenders_hull
    monkeypatch.setattr(hull, "_blenders_hull", lambda mesh: made.append(mesh) or blenders(mesh))
    hull.forget()
    for frame in (2, 3, 4):
        bpy.context.scene.frame_set(frame)
    assert len(made) == 1
    bpy.data.objects["Ball"].scale = (0.5, 1.0, 1.0)
    bpy.context.view_layer.update()
    corners = hull.hull_of(bpy.data.objects["Ball"], bpy.context.scene).corners
    np.testing.assert_allclose(np.ptp(corners, axis=0), [0.02, 0.04, 0.04], rtol=0.1)
    assert len(made) == 1
    bpy.data.objects["Ball"].data.vertices[0].co *= 1.5
    bpy.data.objects["Ball"].data.update()
    hull.hull_of(bpy.data.objects["Ball"], bpy.context.scene)
    assert len(made) == 2


def test_a_presser_of_another_shape_presses_anew(pressed):
    scene = bpy.context.scene
    scene.frame_set(4)
    before = seen_places(pressed)
    ball = bpy.data.objects["Ball"]
    for vertex in ball.data.vertices:
        vertex.co *= 1.5
    ball.data.update()
    move_something(2)
    assert (before - seen_places(pressed))[:, 2].max() > 1e-4


def test_a_presser_that_is_shown_nowhere_moves_all_the_same(pressed):
    scene, ball = bpy.context.scene, bpy.data.objects["Ball"]
    scene.frame_set(4)
    shown = seen_places(pressed)
    scene.frame_set(1)
    bpy.data.collections["Collection"].objects.unlink(ball)
    scene.frame_set(4)
    assert reason(pressed) == ""
    np.testing.assert_allclose(seen_places(pressed), shown, atol=1e-7)
