"""Pressing and making soft in the window, the way a user does it."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from mouse_scene import (
    BACK,
    depth,
    drag_in,
    end_press,
    kept,
    mouse,
    open_mouse,
    own_copy,
    phase,
    start_press,
    type_key,
)
from numpy.typing import NDArray
from shown import replaced
from stage import MODULE, Stage, Wait, at_length

from bl_ext.user_default.palpate.addon.overlay import pixels
from bl_ext.user_default.palpate.operators.bake import bake_session
from bl_ext.user_default.palpate.operators.object import body_store
from bl_ext.user_default.palpate.operators.session import press_session
from bl_ext.user_default.palpate.operators.session.press_state import Phase

# Of one moment, until one shows it.
MOST_PICTURES = 5


def dragging_dents_the_surface_and_enter_keeps_the_shape(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from stage.picture("panel")
    yield from start_press(stage)
    yield from drag_in(stage, release=False)
    force = np.linalg.norm(press_session.current().snapshot.contact_force)
    stage.note(force_newton=float(force))
    assert force > 0.005
    yield from stage.picture("dragging")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: phase() is Phase.HOLDING, "the hold")
    yield from stage.picture("held")
    yield from type_key(stage, "RET")
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")
    assert kept() == ["Press 1"]
    yield from stage.picture("kept")
    yield from type_key(stage, "Z", ctrl=True)
    yield from stage.until(lambda: kept() == [], "one undo step back to before the press")
    yield from type_key(stage, "Z", ctrl=True, shift=True)
    yield from stage.until(lambda: kept() == ["Press 1"], "the redo")


def escape_and_right_click_restore_every_bit(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    before = _coordinates()
    for leave in (end_press, _right_click):
        yield from start_press(stage)
        yield from drag_in(stage)
        yield from leave(stage)
        assert kept() == []
        assert _coordinates() == before


@at_length
def the_wheel_goes_deeper_while_the_button_is_held(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from start_press(stage)
    here = stage.pixel(BACK)
    yield from stage.drag([here, here], steps=1, release=False)
    for _ in range(5):
        yield from stage.event("WHEELUPMOUSE", "PRESS", here)
    size = press_session.current().drawn.size
    yield from stage.until(lambda: depth() > 0.045 * size, "five steps of a hundredth each")
    for _ in range(5):
        yield from stage.event("WHEELDOWNMOUSE", "PRESS", here)
    yield from stage.until(lambda: depth() < 0.005 * size, "the way back")
    yield from stage.event("LEFTMOUSE", "RELEASE", here)
    yield from type_key(stage, "ESC")


@at_length
def the_view_turns_while_a_dent_is_held_and_another_touch_starts_elsewhere(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from start_press(stage)
    yield from drag_in(stage)
    held = depth()
    before = stage.area.spaces.active.region_3d.view_rotation.copy()
    x, y = stage.pixel(BACK)
    yield from stage.drag([(x, y), (x + 120, y + 20)], "MIDDLEMOUSE")
    yield 0.3
    turned = stage.area.spaces.active.region_3d.view_rotation.rotation_difference(before).angle
    assert turned > 0.05
    assert abs(depth() - held) < 1e-4
    yield from stage.picture("turned")
    yield from stage.drag([stage.pixel(BACK), stage.pixel((0.0, -0.02, 0.03))], release=False)
    yield from stage.until(lambda: phase() is Phase.DRAGGING, "the next touch")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from end_press(stage)


@at_length
def numpad_turns_the_view_and_ctrl_s_saves_while_a_dent_is_held(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from start_press(stage)
    yield from drag_in(stage)
    before = stage.area.spaces.active.region_3d.view_rotation.copy()
    yield from type_key(stage, "NUMPAD_1")
    yield from stage.until(
        lambda: stage.area.spaces.active.region_3d.view_rotation != before, "the front view"
    )
    file = Path(bpy.data.filepath)
    stamp = file.stat().st_mtime_ns
    yield from type_key(stage, "S", ctrl=True)
    yield from stage.until(lambda: file.stat().st_mtime_ns != stamp, "the saved file")
    yield from stage.until(lambda: kept() == ["Palpate Live"], "the dent's return")
    assert depth() > 0.005
    yield from type_key(stage, "ESC")
    yield from stage.until(lambda: kept() == [], "the end of the press")
    # The others shall open the scene as it was.
    file.unlink()


@at_length
def a_probe_led_outward_keeps_no_shape(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from start_press(stage)
    x, y = stage.pixel(BACK)
    yield from stage.drag([(x, y), (x - 25, y + 40)])
    yield from stage.until(lambda: phase() is Phase.HOLDING, "the hold")
    yield from stage.picture("in-the-air")
    yield from type_key(stage, "RET")
    yield 0.3
    assert press_session.current() is not None
    assert "no shape" in press_session.current().state.message
    yield from end_press(stage)
    assert kept() == []


@at_length
def closing_the_window_in_which_is_pressed_ends_the_press(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    before = _coordinates()
    with stage.view():
        bpy.ops.wm.window_new()
    yield 1.0
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[1]):
        bpy.ops.palpate.press("INVOKE_DEFAULT")
    yield from stage.until(lambda: press_session.current().snapshot, "the first tick")
    servo = press_session.current().loop.servo
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[1]):
        bpy.ops.wm.window_close()
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")
    assert not servo.running
    assert kept() == []
    assert _coordinates() == before


@at_length
def the_figures_fit_a_narrow_view(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    with stage.view():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.75)
    narrow = min((a for a in stage.window.screen.areas if a.type == "VIEW_3D"), key=_width)
    narrow.spaces.active.show_region_ui = narrow.spaces.active.show_region_toolbar = False
    yield
    beyond: list[float] = []
    drawn: set[float] = set()
    draw = pixels.rectangle

    def rectangle(x: float, y: float, width: float, *others: object) -> None:
        drawn.add(bpy.context.region.width)
        beyond.append(x + width - bpy.context.region.width)
        draw(x, y, width, *others)

    across = next(region for region in narrow.regions if region.type == "WINDOW")
    with replaced(pixels, "rectangle", rectangle):
        with bpy.context.temp_override(window=stage.window, area=narrow, region=across):
            bpy.ops.palpate.press("INVOKE_DEFAULT")
        yield from stage.until(lambda: press_session.current().snapshot, "the first tick")
        yield from drag_in(stage)
        yield from stage.picture("narrow")
    assert drawn == {across.width}
    assert max(beyond) <= 0
    yield from end_press(stage)


def a_hidden_object_is_refused_with_a_remedy(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    mouse().hide_set(True)
    assert "show it" in _refusal(stage)
    assert press_session.current() is None
    yield


@at_length
def the_modulus_slider_is_felt_while_pressing(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from start_press(stage)
    yield from drag_in(stage)
    soft = _force()
    mouse().palpate.young_modulus *= 2
    yield from stage.until(lambda: np.isclose(_force(), 2 * soft, rtol=0.01), "twice the force")
    yield from type_key(stage, "ESC")


def deleting_the_object_while_pressing_ends_the_press(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from start_press(stage)
    yield from drag_in(stage)
    servo = press_session.current().loop.servo
    bpy.data.objects.remove(mouse())
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")
    assert not servo.running


@at_length
def opening_another_file_while_pressing_ends_the_press(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    yield from start_press(stage)
    yield from drag_in(stage)
    servo = press_session.current().loop.servo
    stage.open_scene(own_copy(stage))
    yield 0.5
    assert press_session.current() is None
    assert not servo.running
    assert kept() == []


def the_simulated_device_presses_is_unplugged_and_comes_back(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    before = _coordinates()
    bpy.context.scene.palpate.source = "SIMULATED"
    yield from start_press(stage)
    yield from stage.until(lambda: depth() > 0.008, "the device's press")
    # Its hand goes on while a slow computer draws; the picture is to show it pressing.
    for _ in range(MOST_PICTURES):
        yield from stage.picture("device")
        if depth() > 0.0:
            break
        yield from stage.until(lambda: depth() > 0.008, "its next press")
    session = press_session.current()
    session.loop.simulated.unplug()
    yield from stage.until(lambda: phase() is Phase.LOST, "the message")
    yield 0.3
    assert not np.any(session.snapshot.output_force)
    assert not _live_displacement().any()
    yield from stage.picture("unplugged")
    session.loop.simulated.plug_in()
    yield from stage.until(lambda: phase() is Phase.FEELING, "the device's return")
    yield from stage.until(lambda: depth() > 0.008, "its next press")
    child = session.loop.simulated.pid
    yield from end_press(stage)
    assert _coordinates() == before
    assert not Path(f"/proc/{child}").exists()


def make_soft_shows_progress_and_escape_leaves_nothing(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    bpy.ops.palpate.remove_softness()
    files = _files()
    yield from stage.picture("not-soft")
    with stage.view():
        bpy.ops.palpate.make_soft("INVOKE_DEFAULT")
    yield from stage.until(
        lambda: bake_session.current().progress.step == "tetrahedralize", "the child's first step"
    )
    yield from stage.picture("baking")
    session = bake_session.current()
    child, folder = session.job._child, session.job._folder
    yield from type_key(stage, "ESC")
    yield from stage.until(lambda: bake_session.current() is None, "the end of the bake")
    assert child.poll() is not None
    assert not folder.exists()
    assert _files() == files
    assert not mouse().palpate.body_key
    assert kept() == []


@at_length
def make_soft_beside_blender_makes_the_mouse_pressable(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    bpy.ops.palpate.remove_softness()
    with stage.view():
        bpy.ops.palpate.make_soft("INVOKE_DEFAULT")
    yield from stage.until(lambda: bake_session.current() is None, "the bake")
    assert mouse().palpate.body_key
    stage.note(nodes=mouse().palpate.node_count, seconds=mouse().palpate.bake_seconds)
    yield from stage.picture("baked")
    yield from start_press(stage)
    yield from drag_in(stage)
    yield from type_key(stage, "RET")
    yield from stage.until(lambda: kept() == ["Press 1"], "the kept shape")


def opening_another_file_during_make_soft_ends_it(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    with stage.view():
        bpy.ops.palpate.make_soft("INVOKE_DEFAULT")
    child = bake_session.current().job._child
    yield 1.0
    stage.open_scene(own_copy(stage))
    yield 0.5
    assert bake_session.current() is None
    assert child.poll() is not None


@at_length
def switching_the_extension_off_while_pressing_leaves_a_clean_mesh(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    before = _coordinates()
    yield from start_press(stage)
    yield from drag_in(stage)
    servo = press_session.current().loop.servo
    bpy.ops.preferences.addon_disable(module=MODULE)
    yield 0.5
    bpy.ops.preferences.addon_enable(module=MODULE)
    yield
    assert not servo.running
    assert kept() == []
    assert _coordinates() == before


def an_edited_mesh_is_said_in_the_panel(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    with stage.view():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.mesh.poke()
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from stage.picture("panel")
    assert "Make Soft" in _refusal(stage)


def _right_click(stage: Stage) -> Wait:
    yield from stage.click(stage.pixel(BACK), "RIGHTMOUSE")
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")


def _width(area: bpy.types.Area) -> int:
    return int(area.width)


def _refusal(stage: Stage) -> str:
    """What Press says when it does not start."""
    with stage.view():
        try:
            bpy.ops.palpate.press("INVOKE_DEFAULT")
        except RuntimeError as refusal:
            return str(refusal)
    return ""


def _coordinates() -> bytes:
    mesh = mouse().data
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.tobytes()


def _files() -> set[str]:
    """Body files beside the .blend and in the user's folder."""
    folders = {body_store.folder_for_new_files(), body_store._unsaved_folder()}
    return {str(path) for folder in folders if folder.is_dir() for path in folder.iterdir()}


def _force() -> float:
    return float(np.linalg.norm(press_session.current().snapshot.contact_force))


def _live_displacement() -> NDArray[np.float32]:
    data = mouse().data.attributes["Palpate Live"].data
    flat = np.empty(3 * len(data), dtype=np.float32)
    data.foreach_get("vector", flat)
    return flat
