"""Pressing: scripts by the operator, sessions by the events that its modal side posts."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    MODULE,
    TOP,
    begin,
    cube,
    error_of,
    hide_layers,
    layer_names,
    locate,
    mesh_state,
    moved,
    part,
    press_down,
    press_in,
    rest_places,
    select,
    status,
    wait,
)


def test_a_script_presses_and_keeps_a_shape(thing):
    press_down(thing)
    assert layer_names(thing) == ["Press 1"]
    dent = moved(thing, "Press 1")
    assert dent[:, 2].min() < -1e-4
    assert np.abs(dent).max() <= 0.005
    press_down(thing)
    assert layer_names(thing) == ["Press 1", "Press 2"]


def test_without_keep_nothing_changes(palpate, thing, before):
    assert bpy.ops.palpate.press(at=TOP, by=(0, 0, -0.005), keep=False) == {"FINISHED"}
    assert mesh_state(thing) == before


def test_force_grows_with_the_modulus_and_the_shape_does_not_without_a_bake(palpate, thing):
    press = part("operators.press.press_once").press_once
    path = locate(thing)
    stamp = path.stat().st_mtime_ns
    soft = press(thing, bpy.context.scene, TOP, (0, 0, -0.005))
    hide_layers(thing)
    thing.palpate.young_modulus *= 3
    firm = press(thing, bpy.context.scene, TOP, (0, 0, -0.005))
    assert np.allclose(np.array(firm.force), 3 * np.array(soft.force))
    assert np.array_equal(moved(thing, "Press 1"), moved(thing, "Press 2"))
    assert path.stat().st_mtime_ns == stamp
    assert status(thing).fit.name == "READY"


def test_what_was_never_baked_cannot_be_pressed(palpate):
    cube()
    assert "Make Soft" in error_of(bpy.ops.palpate.press, at=TOP, by=(0, 0, -0.005))


@pytest.mark.parametrize("with_keys", [False, True])
def test_cancel_restores_every_bit(sessions, states, with_keys, thing):
    if with_keys:
        thing.shape_key_add(name="Basis")
        other = thing.shape_key_add(name="Other")
        other.points[0].co.x += 0.01
        other.value = 0.3
        thing.active_shape_key_index = 1
        thing.show_only_shape_key = True
    before = mesh_state(thing)
    session = begin(sessions, states, thing)
    press_in(session, states)
    assert np.abs(moved(thing, "Palpate Live")).max() > 1e-4
    session.post(states.Moment.CANCEL)
    assert mesh_state(thing) == before
    assert sessions.current() is None


@pytest.mark.parametrize("with_keys", [False, True])
def test_keep_leaves_one_new_layer_and_all_else(sessions, states, with_keys, thing):
    if with_keys:
        thing.shape_key_add(name="Basis")
        thing.shape_key_add(name="Other").value = 0.3
    before = mesh_state(thing)
    session = begin(sessions, states, thing)
    press_in(session, states)
    seen = moved(thing, "Palpate Live")
    session.post(states.Moment.RELEASE)
    session.post(states.Keep())
    after = mesh_state(thing)
    assert np.array_equal(moved(thing, "Press 1"), seen)
    assert layer_names(thing) == ["Press 1"]
    del after["layer", "Press 1"]
    after["attributes"].remove("Press 1")
    after["modifiers"].remove("Press 1")
    assert after == before


@pytest.fixture
def session(sessions, states, thing, before):
    """A running press into the top of the cube."""
    session = begin(sessions, states, thing)
    press_in(session, states)
    return session


def test_a_modulus_changed_while_pressing_is_felt_at_once(thing, session):
    soft = np.linalg.norm(session.snapshot.contact_force)
    thing.palpate.young_modulus *= 2
    wait(
        session,
        lambda: np.isclose(np.linalg.norm(session.snapshot.contact_force), 2 * soft, rtol=1e-3),
    )


def scaled(thing):
    thing.scale.x = 1.2
    bpy.context.view_layer.update()


def deleted(thing):
    bpy.data.objects.remove(thing)


ENDS = {
    "scaled": scaled,
    "edited": lambda _: bpy.ops.object.mode_set(mode="EDIT"),
    "deleted": deleted,
    "another file": lambda _: bpy.ops.wm.read_homefile(use_factory_startup=True),
    "switched off": lambda _: bpy.ops.preferences.addon_disable(module=MODULE),
}


@pytest.mark.parametrize("end", ENDS)
def test_what_happens_to_the_object_or_the_file_ends_the_press(
    sessions, thing, before, session, end
):
    """A mesh that is still there is left clean."""
    servo = session.loop.servo
    ENDS[end](thing)
    # Of a file or an extension that goes handlers tell at once, the rest is seen in the next tick.
    if end in {"scaled", "edited", "deleted"}:
        session.tick()
    assert sessions.current() is None
    assert session.loop is None
    assert not servo.running
    assert ("scaled" in session.state.message) == (end == "scaled")
    if end not in {"deleted", "another file"}:
        bpy.ops.object.mode_set(mode="OBJECT")
        assert mesh_state(thing) == before


def test_an_object_may_be_moved_while_pressed(sessions, thing, session):
    thing.location.x += 1.0
    thing.rotation_euler.z += 0.5
    bpy.context.view_layer.update()
    session.tick()
    assert sessions.current() is session


def test_a_renamed_object_is_pressed_on(sessions, states, thing):
    session = begin(sessions, states, thing)
    thing.name = "Another name"
    press_in(session, states)
    session.post(states.Moment.CANCEL)
    assert layer_names(thing) == []


def test_a_save_while_pressing_writes_no_live_shape_and_the_press_goes_on(
    sessions, states, thing, session, tmp_path
):
    name = thing.name
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert sessions.current() is session
    session.tick()
    assert layer_names(thing) == ["Palpate Live"]
    session.post(states.Moment.CANCEL)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert layer_names(bpy.data.objects[name]) == []


def test_undo_while_pressing_ends_it_and_leaves_the_mesh_clean(sessions, states, thing):
    name = thing.name
    bpy.ops.ed.undo_push(message="soft")
    session = begin(sessions, states, thing)
    press_in(session, states)
    bpy.ops.ed.undo_push(message="something with the live layer in it")
    servo = session.loop.servo
    bpy.ops.ed.undo()
    assert sessions.current() is None
    assert not servo.running
    assert layer_names(bpy.data.objects[name]) == []
    bpy.ops.ed.redo()
    assert layer_names(bpy.data.objects[name]) == []


def test_only_one_press_at_a_time(sessions, states, thing, session):
    error = part("core.errors").PalpateError
    with pytest.raises(error, match="Escape"):
        begin(sessions, states, thing)
    assert "press" in error_of(bpy.ops.palpate.press, at=TOP, by=(0, 0, -0.005))


def test_a_port_that_is_not_there_is_refused_and_leaves_the_mesh_clean(
    sessions, states, thing, before
):
    bpy.context.scene.palpate.source = "SERIAL"
    bpy.context.scene.palpate.port = "/nowhere/port"
    error = part("core.errors").PalpateError
    with pytest.raises(error, match="/nowhere/port"):
        begin(sessions, states, thing, "DEVICE")
    assert mesh_state(thing) == before
    assert sessions.current() is None


def test_a_port_is_taken_as_typed_or_with_what_the_list_says_of_it(palpate):
    port_of, scene = part("operators.device.device_source").port_of, bpy.context.scene
    for text, port in {
        "/dev/ttyACM0 (Arduino Uno (R3))": "/dev/ttyACM0",
        " COM3": "COM3",
        "/dev/my links/device": "/dev/my links/device",
    }.items():
        scene.palpate.port = text
        assert port_of(scene) == port


def test_a_device_that_says_nothing_is_waited_for(sessions, states, silent_port, thing):
    bpy.context.scene.palpate.source = "SERIAL"
    bpy.context.scene.palpate.port = silent_port
    session = begin(sessions, states, thing, "DEVICE")
    wait(session, lambda: session.snapshot.tick > 50)
    assert session.awaits_device
    nothing = part("addon.overlay.reading").NOTHING
    assert not part("addon.overlay.view")._worth_drawing(session, nothing)
    sessions.give_way("")
    assert layer_names(thing) == []


def test_a_servo_that_fails_to_stop_does_not_leave_the_live_layer(
    sessions, states, thing, before, session
):
    servo = session.loop.servo

    class Failing:
        def stop(self):
            servo.stop()
            raise RuntimeError("it did not stop")

    session.loop.servo = Failing()
    with pytest.raises(RuntimeError, match="it did not stop"):
        session.post(states.Moment.CANCEL)
    assert mesh_state(thing) == before
    assert sessions.current() is None


def test_the_simulated_device_presses_is_unplugged_and_comes_back(sessions, states, thing, before):
    bpy.context.scene.palpate.source = "SIMULATED"
    session = begin(sessions, states, thing, "DEVICE")
    wait(session, lambda: session.snapshot.touching)
    wait(session, lambda: np.linalg.norm(session.snapshot.output_force) > 0.01)
    session.loop.simulated.unplug()
    # A computer that stands still just then may be told before.
    wait(session, lambda: "plug" in session.state.message)
    assert session.state.phase is states.Phase.LOST
    assert not moved(thing, "Palpate Live").any()
    assert not np.any(session.snapshot.output_force)
    session.loop.simulated.plug_in()
    wait(session, lambda: session.state.phase is states.Phase.FEELING)
    wait(session, lambda: session.snapshot.touching)
    child = session.loop.simulated._process
    session.post(states.Moment.CANCEL)
    assert child.poll() is not None
    assert mesh_state(thing) == before


def test_an_empty_places_the_device(sessions, states, thing):
    bpy.ops.object.empty_add(location=(0.0, 0.0, 0.3), rotation=(0.3, 0.0, 0.0))
    scene = bpy.context.scene
    scene.palpate.device_frame, scene.palpate.device_scale = bpy.context.object, 2.0
    bpy.context.view_layer.update()
    body = part("operators.scene.drawn_surface").frame_of(thing, scene)
    source = part("operators.device.device_source")
    frame = source.device_frame(thing, scene, body, source.home_of_device(thing, scene, body))
    device = np.array([0.01, 0.02, 0.03])
    expected = np.array(bpy.context.object.matrix_world.to_3x3()) @ (2 * device) + [0, 0, 0.3]
    mapped = frame.scale * frame.rotation @ device + frame.translation
    assert np.allclose(body.world_from_body(mapped), expected, atol=1e-6)
    assert np.allclose(frame.device_from_body(mapped), device)
    select(thing)


def test_bounding_box_and_normals_follow_each_frame(thing):
    """Blender 5.0 leaves both stale after bulk writes in some places."""
    live = part("operators.layer.live_layer")
    live.hang(thing)
    rest = rest_places(thing)
    graph = bpy.context.evaluated_depsgraph_get()
    for factor in (1.5, 2.0):
        live.write(thing, (rest * [0, 0, factor - 1]).astype(np.float32).ravel())
        bpy.context.view_layer.update()
        seen = thing.evaluated_get(graph)
        assert np.isclose(np.array(seen.bound_box)[:, 2].max(), 0.025 * factor)
    live.write(thing, (rest[:, [2, 0, 1]] * [0, 0, 0.5]).astype(np.float32).ravel())
    bpy.context.view_layer.update()
    seen = thing.evaluated_get(graph).data
    fresh = seen.copy()
    fresh.update()
    for polygon, again in zip(seen.polygons, fresh.polygons, strict=True):
        assert np.allclose(polygon.normal, again.normal)
    live.remove(thing)
