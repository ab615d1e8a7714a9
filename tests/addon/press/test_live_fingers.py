"""Two fingers that press at once, by the events that the modal side posts."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    begin,
    empty,
    layer_names,
    locate,
    mesh_state,
    part,
    soft_cube,
    unbraked,
    wait,
)

LEFT, RIGHT = (-0.02501, 0.0, 0.01), (0.02501, 0.0, 0.01)
LEFT_IN, RIGHT_IN = (-0.022, 0.0, 0.01), (0.022, 0.0, 0.01)


def arrived(session, *places):
    fingers = session.snapshot.fingers
    return all(
        finger.touching and np.allclose(finger.probe, place)
        for finger, place in zip(fingers, places, strict=True)
    )


def test_a_pinch_is_felt_by_both_and_agrees_with_the_one_without_a_clock(
    sessions, states, thing, before
):
    once = part("operators.press.press_once").press_several(
        thing,
        bpy.context.scene,
        [LEFT, RIGHT],
        [(0.003, 0, 0), (-0.003, 0, 0)],
        keep=False,
    )
    session = begin(sessions, states, thing, pinch=True)
    session.post(states.SetDown(LEFT, 0))
    session.post(states.Move(LEFT_IN, 0))
    session.post(states.Moment.RELEASE)
    session.post(states.SetDown(RIGHT, 1))
    session.post(states.Move(RIGHT_IN, 1))
    wait(session, lambda: arrived(session, LEFT_IN, RIGHT_IN))
    figures = part("addon.overlay.reading").readings(session)
    for seen, told in zip(figures, once.fingers, strict=True):
        assert np.allclose(seen.force_vector, told.force, rtol=0.05, atol=0.02 * seen.force)
        assert seen.depth == pytest.approx(0.003, abs=1e-4)
    session.post(states.Moment.CANCEL)
    assert mesh_state(thing) == before


def test_empties_lead_both_fingers_and_one_may_be_deleted(sessions, states):
    thing, scene = soft_cube(), bpy.context.scene
    left, right = empty("Left", (-0.05, 0, 0.01)), empty("Right", (0.05, 0, 0.01))
    chosen = scene.palpate
    chosen.source, chosen.source_empty, chosen.second = "EMPTY", left, "EMPTY"
    chosen.second_empty = right
    session = begin(sessions, states, thing, "EMPTY")
    wait(session, lambda: session.snapshot.tick > 0)
    assert not any(finger.touching for finger in session.snapshot.fingers)
    left.location, right.location = LEFT_IN, RIGHT_IN
    bpy.context.view_layer.update()
    wait(session, lambda: arrived(session, LEFT_IN, RIGHT_IN))
    bpy.data.objects.remove(left)
    session.tick()
    assert [said.text for said in session.said if "Left was deleted" in said.text]
    wait(session, lambda: arrived(session, LEFT_IN, RIGHT_IN))
    session.post(states.Keep(session.seen.displacements is not None))
    assert layer_names(thing) == ["Press 1"]


def test_a_simulated_device_presses_beside_the_pointer(sessions, states, thing):
    bpy.context.scene.palpate.second = "SIMULATED"
    session = begin(sessions, states, thing)
    assert session.state.has_device
    session.post(states.SetDown(LEFT, 0))
    session.post(states.Move(LEFT_IN, 0))
    wait(session, lambda: session.snapshot.fingers[0].touching, 20.0)
    wait(session, lambda: session.snapshot.fingers[1].touching, 20.0)
    device = session.loop.second_simulated
    session.post(states.Moment.CANCEL)
    assert sessions.current() is None
    assert not device.running


def test_a_haply_presses_beside_the_pointer(sessions, states):
    """In the upright plane through the top, where its simulated hand comes from above."""
    thing, scene = soft_cube(), bpy.context.scene
    chosen = scene.palpate
    chosen.second = "HAPLY"
    chosen.second_haply_at_rest = True
    with pytest.raises(part("core.errors").PalpateError, match="no port"):
        begin(sessions, states, thing)
    device_source = part("operators.device.device_source")
    drawn = part("operators.object.drawn_body").open_body(thing, scene)
    home = device_source.home_of_device(thing, scene, drawn.frame, 1)
    frame = device_source.device_frame(thing, scene, drawn.frame, home, 1)
    with device_source.start_simulated(drawn, frame, haply="2diy-3.1") as device:
        chosen.second_port = device.port
        session = begin(sessions, states, thing)
        assert session.loop.settings.servo.coupling.stiffness < 800
        session.post(states.SetDown(LEFT, 0))
        session.post(states.Move(LEFT_IN, 0))
        wait(session, lambda: session.snapshot.fingers[0].touching, 20.0)
        wait(session, lambda: session.snapshot.fingers[1].touching, 20.0)
        second = session.snapshot.fingers[1]
        assert abs(second.probe[1]) < 1e-6
        assert second.proxy[2] == pytest.approx(0.025, abs=1e-3)
        session.post(states.Moment.CANCEL)


def test_the_mode_is_felt_while_pressing(sessions, states, thing):
    session = begin(sessions, states, thing)
    place, deep = (0.004, 0.001, 0.02501), (0.004, 0.001, 0.021)
    session.post(states.SetDown(place))
    session.post(states.Move(deep))
    wait(session, lambda: arrived(session, deep) and unbraked(session.snapshot))
    consistent = np.linalg.norm(session.snapshot.contact_force)
    bpy.context.scene.palpate.contact_mode = "PAPER"
    wait(
        session,
        lambda: (
            abs(np.linalg.norm(session.snapshot.contact_force) - consistent) > 0.01 * consistent
        ),
    )


def test_a_fingertip_is_felt_as_without_a_clock_and_its_patch_is_seen(sessions, states):
    thing, chosen = soft_cube(), bpy.context.scene.palpate
    chosen.tip, chosen.tip_radius = "SPHERE", 0.02
    before = mesh_state(thing)
    top, deep = (0.0, 0.0, 0.025), 0.003
    once = part("operators.press.press_once").press_once(
        thing, bpy.context.scene, top, (0.0, 0.0, -deep), keep=False
    )
    session = begin(sessions, states, thing)
    upright = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    pressed = (0.0, 0.0, 0.045 - deep)
    session.post(states.SetDown((0.0, 0.0, 0.0451), 0, upright))
    session.post(states.Move(pressed))
    wait(session, lambda: arrived(session, pressed))
    wait(session, lambda: session.snapshot.tick > 400)
    seen = part("addon.overlay.reading").reading(session)
    assert np.allclose(seen.force_vector, once.force, atol=0.05 * once.force[2])
    assert seen.depth == pytest.approx(deep, rel=0.1)
    made = once.fingers[0].made
    assert seen.area == pytest.approx(made.area, rel=0.2)
    assert seen.largest_pressure == pytest.approx(made.largest_pressure, rel=0.2)
    patch = seen.patch
    # The patch lies in the tip, and its normals point out of the body.
    distance = np.linalg.norm(patch.places - np.array(pressed), axis=1)
    assert np.abs(distance - 0.02).max() < 2e-3
    assert (patch.normals[:, 2] > 0.5).all()
    session.post(states.Moment.CANCEL)
    assert mesh_state(thing) == before


def test_a_tool_object_may_be_deleted_while_it_presses(sessions, states):
    thing, chosen = soft_cube(), bpy.context.scene.palpate
    bpy.ops.mesh.primitive_cube_add(size=0.03, location=(0.0, 0.0, 0.2))
    tool = bpy.context.object
    chosen.tip, chosen.tip_object, chosen.tip_turn = "MESH", tool, "OBJECT"
    bpy.context.view_layer.objects.active = thing
    session = begin(sessions, states, thing)
    session.post(states.SetDown((0.0, 0.0, 0.0401)))
    session.post(states.Move((0.0, 0.0, 0.038)))
    wait(session, lambda: session.snapshot.fingers[0].touching)
    bpy.data.objects.remove(tool)
    for _ in range(3):
        session.tick()
    assert session.snapshot.fingers[0].touching
    session.post(states.Keep(session.seen.displacements is not None))
    assert layer_names(thing) == ["Press 1"]


def test_the_next_press_does_not_read_the_body_again_unless_its_file_changed(
    sessions, states, thing
):
    bodies = []
    for touch_file in (False, False, True):
        if touch_file:
            locate(thing).touch()
        session = begin(sessions, states, thing)
        bodies.append(session.drawn.body)
        session.post(states.Moment.CANCEL)
    assert bodies[0] is bodies[1]
    assert bodies[2] is not bodies[1]
