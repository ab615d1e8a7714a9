"""Whether force may come, letting it go, and what else is set, seen and recorded while pressing."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from recorded_layout import RecordedLayout
from soft_scene import (
    DEEP,
    begin,
    cube,
    error_of,
    layer_names,
    mesh_state,
    part,
    press_in,
    select,
    soft_cube,
    unbraked,
    wait,
)


def said(session):
    return part("operators.device.servo_words").standing(session.snapshot)


def simulated_press(sessions, states, thing):
    bpy.context.scene.palpate.source = "SIMULATED"
    session = begin(sessions, states, thing, "DEVICE")
    wait(session, lambda: np.linalg.norm(session.snapshot.output_force) > 0.005)
    return session


def test_force_off_is_zero_at_once_and_force_on_rises_from_nothing(sessions, states):
    session = simulated_press(sessions, states, soft_cube())
    assert bpy.ops.palpate.switch_force() == {"FINISHED"}
    wait(session, lambda: session.snapshot.state == "disabled")
    assert not np.any(session.snapshot.output_force)
    assert said(session).word == "Force Off"
    assert "Space" in said(session).why
    # Neither view nor panel tells a force that nobody feels.
    assert part("addon.overlay.reading").reading(session).force == 0.0
    # Struck once more in alarm: it stays off.
    bpy.ops.palpate.switch_force()
    time.sleep(0.1)
    # But for a fault of a computer that stands still just then.
    wait(session, lambda: session.snapshot.state != "fault")
    assert session.snapshot.state == "disabled"
    time.sleep(part("operators.session.press_state").CALM_SECONDS)
    bpy.ops.palpate.switch_force()
    wait(session, lambda: session.snapshot.state != "disabled")
    wait(session, lambda: np.linalg.norm(session.snapshot.output_force) > 0.005)


def test_an_adapter_that_holds_bytes_back_is_explained_in_the_panel(sessions, states, monkeypatch):
    panel = part("addon.panels.device")
    session = begin(sessions, states, soft_cube())
    session.tick()
    scaled = SimpleNamespace(system=SimpleNamespace(ui_scale=1.0))
    context = SimpleNamespace(region=SimpleNamespace(width=260), preferences=scaled)
    layout = RecordedLayout()
    panel.draw_adapter_warning(layout, context)
    assert layout.written.lines == []
    link = {"bursts": 50, "burst_states": 800, "states": 800, "burst_ms": 16.0}
    link["state_interval_us"] = {"device": 1000.0}
    monkeypatch.setitem(session.loop.figures.counters, "link", link)
    panel.draw_adapter_warning(layout, context)
    assert "62.5 Hz" in layout.written.text


@pytest.fixture
def kept(palpate):
    """The preferences, put back afterwards."""
    kept = part("operators.scene.package_preferences").preferences()
    yield kept
    for name in ("stable_contact", "own_coupling", "coupling_stiffness"):
        kept.property_unset(name)


def test_the_coupling_is_the_default_of_the_rate_until_own_values_are_chosen(kept):
    scene, of = bpy.context.scene, part("operators.session.live_settings").coupling_of
    scene.palpate.rate = 2000
    default = of(scene)
    assert default.passivity_control
    assert 0.0 < default.stiffness < np.inf
    assert vars(default) == part("core.servo.session").device_coupling(2000)
    scene.palpate.source = "HAPLY"
    servo = part("core.servo.session")
    step = servo.haply_encoder_step(scene.palpate.haply_model)
    assert vars(of(scene)) == servo.device_coupling(2000, encoder_step=step) != vars(default)
    kept.own_coupling = True
    kept.coupling_stiffness = 300.0
    assert of(scene).stiffness == 300.0
    kept.stable_contact = False
    assert of(scene).stiffness == np.inf
    assert not of(scene).passivity_control


GUARDS = ("stable_contact", "own_coupling", "coupling_stiffness", "passivity_control", "max_force")


def test_no_file_switches_off_what_guards_the_hand(kept, tmp_path):
    of, scene = part("operators.session.live_settings").coupling_of, bpy.context.scene
    default = of(scene)
    for name in GUARDS:
        assert not hasattr(scene.palpate, name)
        # As files of before have it, or strangers write it.
        scene.palpate[name] = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "stranger.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "stranger.blend"))
    scene = bpy.context.scene
    scene.palpate.rate = 1000
    assert of(scene) == default
    assert kept.max_force == 3.0


def test_the_pointer_has_no_force_to_switch_off(sessions, states):
    begin(sessions, states, soft_cube())
    assert "device" in error_of(bpy.ops.palpate.switch_force)


def test_friction_set_while_pressing_is_felt_sideways(sessions, states, thing):
    session = begin(sessions, states, thing)
    press_in(session, states)

    def slope_at_rest(x):
        place = (x, 0.0, DEEP[2])
        session.post(states.Move(place))
        wait(session, lambda: np.allclose(session.snapshot.probe, place, atol=1e-6))
        wait(session, lambda: unbraked(session.snapshot))
        x, y, z = session.snapshot.contact_force
        return np.hypot(x, y) / z

    smooth = slope_at_rest(0.002)
    thing.palpate.dynamic_friction = 0.5
    session.tick()
    time.sleep(0.05)
    assert slope_at_rest(0.006) > smooth + 0.1


def test_sliding_never_holds_better_than_resting(palpate):
    settings = cube().palpate
    settings.dynamic_friction = 0.6
    assert settings.static_friction == settings.dynamic_friction
    settings.static_friction = 0.25
    assert settings.dynamic_friction == settings.static_friction == 0.25


def test_the_loop_runs_at_the_chosen_rate_and_tells_its_times(sessions, states):
    bpy.context.scene.palpate.rate = 500
    session = begin(sessions, states, soft_cube())
    session.tick()
    counters = session.loop.figures.counters
    assert counters["rate_hz"] == 500
    assert set(part("addon.panels.device").STAGE_NAMES) == set(counters["stages_us"])


def test_a_recording_misses_no_tick_while_blender_is_busy_and_outlives_the_press(
    sessions, states, tmp_path
):
    bpy.context.scene.palpate.record_from_start = True
    session = begin(sessions, states, soft_cube())
    press_in(session, states)
    end = time.monotonic() + 0.3
    while time.monotonic() < end:
        pass
    pressed_before = session.snapshot.tick
    session.tick()
    ticks = session.snapshot.tick
    # How many of a thousand a second depends on the machine.
    assert ticks > pressed_before
    assert session.loop.recorder.going_on
    assert session.loop.recorder.seconds > 0.3
    session.post(states.Moment.CANCEL)
    assert sessions.current() is None
    for name in ("felt.csv", "felt.npz"):
        path = tmp_path / name
        assert bpy.ops.palpate.save_recording(filepath=str(path)) == {"FINISHED"}
        samples = part("core.record.read_recording").read_recording(path).samples
        assert len(samples) >= ticks
        assert np.array_equal(samples["tick"], np.arange(1, len(samples) + 1))
        assert np.linalg.norm(samples["force"], axis=1).max() > 0.01


def test_a_recording_is_begun_and_ended_while_pressing_and_saved_meanwhile(
    sessions, states, tmp_path
):
    session = begin(sessions, states, soft_cube())
    wait(session, lambda: session.snapshot.tick > 50)
    assert bpy.ops.palpate.record() == {"FINISHED"}
    wait(session, lambda: session.loop.recorder.seconds > 0.1)
    path = tmp_path / "meanwhile.npz"
    bpy.ops.palpate.save_recording(filepath=str(path))
    assert sessions.current() is session
    samples = part("core.record.read_recording").read_recording(path).samples
    assert samples["tick"][0] > 50
    bpy.ops.palpate.record()
    session.tick()
    assert not session.loop.recorder.going_on
    assert not session.loop.recorder.full
    length = session.loop.recorder.seconds
    time.sleep(0.05)
    session.tick()
    assert session.loop.recorder.seconds == length


def test_a_recording_that_has_reached_its_length_says_so(sessions, states):
    session = begin(sessions, states, soft_cube())
    session.tick()
    session.loop.recorder.start(0.1, session.snapshot.time)
    wait(session, lambda: session.loop.recorder.full)
    assert session.loop.recorder.seconds == pytest.approx(0.1, abs=0.02)


def test_a_recording_that_cannot_be_written_is_refused_with_a_remedy(sessions, states, tmp_path):
    bpy.context.scene.palpate.record_from_start = True
    session = begin(sessions, states, soft_cube())
    session.tick()
    session.post(states.Moment.CANCEL)
    assert ".csv" in error_of(bpy.ops.palpate.save_recording, filepath=str(tmp_path / "a.txt"))
    nowhere = tmp_path / "nowhere" / "a.csv"
    assert "folder" in error_of(bpy.ops.palpate.save_recording, filepath=str(nowhere))


def test_a_long_recording_is_written_while_the_press_goes_on(
    sessions, states, tmp_path, monkeypatch
):
    writer, scene = part("operators.record.recording_writer"), bpy.context.scene
    scene.palpate.record_from_start = True
    session = begin(sessions, states, soft_cube())
    wait(session, lambda: session.snapshot.tick > 50)
    may_write, write = threading.Event(), part("operators.record.recording").write
    monkeypatch.setattr(
        part("operators.record.recording"),
        "write",
        lambda *given: may_write.wait(10.0) and write(*given),
    )
    path = tmp_path / "felt.csv"
    try:
        writer.begin(path, part("operators.press.save_recording").recorded())
        assert "is being written" in error_of(bpy.ops.palpate.save_recording, filepath=str(path))
        before = session.snapshot.tick
        wait(session, lambda: session.snapshot.tick > before)
        assert not path.exists()
    finally:
        may_write.set()
        writer.unregister()
    assert len(part("core.record.read_recording").read_recording(path).samples) > 50
    assert writer.latest().problem == ""
    session.post(states.Moment.CANCEL)
    monkeypatch.undo()
    (tmp_path / "taken.csv").mkdir()
    with pytest.raises(part("core.errors").PalpateError, match="folder"):
        writer.begin(tmp_path / "taken.csv", part("operators.record.recording").last())
    begin(sessions, states, soft_cube())
    assert writer.latest() is None


def test_a_haply_presses_in_the_upright_plane_through_the_top(sessions, states, thing, before):
    scene = bpy.context.scene
    scene.palpate.source, scene.palpate.simulated_kind = "SIMULATED", "HAPLY"
    session = begin(sessions, states, thing, "DEVICE")
    wait(session, lambda: np.linalg.norm(session.snapshot.output_force) > 0.005)
    device = session.loop.figures.counters["link"]["device"]
    assert "2DIY" in device["name"]
    # The plane is the world's X and Z through the cube's middle.
    assert abs(session.snapshot.probe[1]) < 1e-6
    lines = part("addon.overlay.workspace").outline(bpy.context, session)
    ends = np.array(lines).reshape(-1, 3)
    assert len(lines) == 4
    assert np.allclose(np.ptp(ends, axis=0), [0.12, 0.0, 0.07], atol=1e-6)
    session.post(states.Moment.CANCEL)
    assert mesh_state(thing) == before


def test_an_empty_turns_the_plane_of_a_haply(palpate):
    thing, scene = soft_cube(), bpy.context.scene
    scene.palpate.source = "HAPLY"
    bpy.ops.object.empty_add(location=(0.0, 0.1, 0.3))
    scene.palpate.device_frame = bpy.context.object
    select(thing)
    ends = np.array(part("addon.overlay.workspace").outline(bpy.context, None)).reshape(-1, 3)
    assert np.allclose(ends[:, 2], 0.3)
    assert np.allclose(ends.mean(axis=0), [0.0, 0.1, 0.3])
    scene.palpate.show_workspace = False
    assert part("addon.overlay.workspace").outline(bpy.context, None) == []


def test_a_flattened_device_frame_is_said_and_the_press_goes_on(sessions, states, silent_port):
    thing, scene = soft_cube(), bpy.context.scene
    bpy.ops.object.empty_add(location=(0.0, 0.0, 0.3))
    empty = scene.palpate.device_frame = bpy.context.object
    scene.palpate.source, scene.palpate.port = "SERIAL", silent_port
    session = begin(sessions, states, thing, "DEVICE")
    empty.scale = (0.0, 1.0, 1.0)
    bpy.context.view_layer.update()
    for _ in range(3):
        session.tick()
    assert sessions.current() is session
    assert [empty.name in said.text for said in session.said] == [True]
    sessions.give_way("")
    with pytest.raises(part("core.errors").PalpateError, match=empty.name):
        begin(sessions, states, thing, "DEVICE")
    assert layer_names(thing) == []


@pytest.mark.parametrize("problem", [ValueError, RuntimeError, OverflowError])
def test_what_the_servo_refuses_is_a_sentence_with_a_remedy(palpate, problem):
    error = part("core.errors").PalpateError
    with (
        pytest.raises(error, match=r"servo: why; "),
        part("operators.session.force_loop").servo_errors(),
    ):
        raise problem("why")


def test_a_port_that_cannot_be_opened_has_one_remedy(palpate):
    import palpate_servo

    body = palpate_servo.Body(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        np.tile(np.eye(3), (4, 1, 1)),
    )
    servo = palpate_servo.Servo(body, part("core.servo.settings").Settings(1000.0))
    error = part("core.errors").PalpateError
    with (
        pytest.raises(error, match=r"^device: /no/such/port: cannot be opened \([^;]*\); [^;]*$"),
        part("operators.session.force_loop").servo_errors(),
    ):
        servo.start(palpate_servo.LinkDevice("/no/such/port"))


def test_a_failed_force_loop_ends_the_press_and_leaves_the_mesh_clean(
    sessions, states, thing, before
):
    session = begin(sessions, states, thing)
    press_in(session, states)
    dead = SimpleNamespace(state="stopped", fault="internal error", reason="", limited="")
    session._watch_faults(dead)
    assert sessions.current() is None
    assert "press again" in session.state.message
    assert mesh_state(thing) == before


@pytest.mark.parametrize(
    ("shot", "signal", "words"),
    [
        ({"state": "free"}, "READY", "Force comes"),
        ({"state": "touching", "limited": "clamp"}, "FORCE", "largest force"),
        ({"state": "ramping", "reason": "after stale"}, "RETURNING", "fault is gone"),
        ({"state": "fault", "fault": "unplugged"}, "FAULT", "plug it in again"),
        ({"state": "disabled", "reason": "device button"}, "OFF", "let it go"),
        ({"state": "waiting", "reason": "no STATE yet"}, "WAITING", "no position"),
        ({"state": "fault", "fault": "unheard of"}, "FAULT", "unheard of"),
    ],
)
def test_each_state_is_told_with_its_reason_and_what_to_do(palpate, shot, signal, words):
    whole = {"fault": "", "reason": "", "limited": ""} | shot
    standing = part("operators.device.servo_words").standing(SimpleNamespace(**whole))
    assert standing.signal.name == signal
    assert words in f"{standing.why} {standing.limit}"
