"""Fingers with a shape and two of them, in the window."""

from __future__ import annotations

import bpy
import numpy as np
from mouse_scene import end_press, over_the_view, own_copy, type_key
from random_drags import seen_points
from stage import Pixel, Stage, Wait, at_length

from bl_ext.user_default.palpate.addon.overlay.reading import Reading, readings
from bl_ext.user_default.palpate.operators.session import press_session
from bl_ext.user_default.palpate.operators.session.press_state import Phase

PINCH, FINGERTIP = "sample_scenes/pinch.blend", "sample_scenes/fingertip.blend"
STACKED, JELLY = "sample_scenes/stacked.blend", ("Lime", "Cherry", "Lemon")
# A place on the mouse's back that the view shows from above, world coordinates.
BACK = (-0.018, -0.014, 0.057)


@at_length
def a_fingertip_led_by_the_mouse_shows_its_patch_and_force(stage: Stage) -> Wait:
    yield from _open(stage, FINGERTIP, "Mouse")
    before = _coordinates("Mouse")
    yield from _press(stage)
    x, y = stage.pixel(BACK)
    yield from stage.drag([(x, y), (x + 8, y - 34)], steps=4, release=False)
    yield from stage.until(lambda: _figures()[0].depth > 0.004, "a depth of 4 mm")
    yield from stage.picture("pressed")
    figures = _figures()[0]
    assert figures.patch is not None
    assert len(figures.patch.pressures) > 3
    # The tip pushes down, so what it feels goes up.
    assert figures.force_vector[2] > 0.5 * figures.force > 0.0
    stage.note(newton=figures.force, kilopascal=figures.largest_pressure / 1000)
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from end_press(stage)
    assert _coordinates("Mouse") == before
    assert not bpy.data.objects["Mouse"].modifiers


@at_length
def a_plate_and_a_mesh_are_chosen_in_the_panel_and_press(stage: Stage) -> Wait:
    yield from _open(stage, FINGERTIP, "Mouse")
    chosen = bpy.context.scene.palpate
    chosen.tip = "PLATE"
    yield from _press(stage)
    x, y = stage.pixel(BACK)
    yield from stage.drag([(x, y), (x + 6, y - 28)], steps=3)
    yield from stage.until(lambda: _figures()[0].area > 1e-5, "the plate's contact")
    yield from stage.picture("plate")
    yield from end_press(stage)
    chosen.tip = "MESH"
    yield from stage.picture("no-tool")
    with stage.view():
        assert "pick one under Finger" in _refusal()
    chosen.tip_object = bpy.data.objects["Finger Skin"]
    yield from _press(stage)
    yield from stage.drag([(x, y), (x + 6, y - 28)], steps=3)
    yield from stage.until(lambda: _figures()[0].area > 1e-6, "the mesh's contact")
    bpy.data.objects.remove(bpy.data.objects["Finger Skin"])
    yield from stage.picture("mesh-deleted")
    assert press_session.current() is not None
    yield from end_press(stage)


def two_handles_pinch_and_escape_restores_every_bit(stage: Stage) -> Wait:
    yield from _open(stage, PINCH, "Nodes")
    before = _coordinates("Nodes")
    with stage.view():
        bpy.ops.palpate.pinch("INVOKE_DEFAULT")
    yield from stage.until(lambda: len(_figures()) == 2, "the first tick")
    yield from stage.picture("handles")
    for finger, way in ((0, 45), (1, -45)):
        x, y = _handle(stage, finger)
        yield from stage.drag([(x, y), (x + way, y)], steps=5)
        yield from stage.until(lambda n=finger: _figures()[n].depth > 0.003, "a depth of 3 mm")
        assert press_session.current().state.phase is Phase.HOLDING
    yield from stage.picture("pinched")
    left, right = _figures()
    # Each is pushed back to the side that it came from.
    assert left.force_vector[0] < 0.0 < right.force_vector[0]
    held = left.depth
    x, y = _handle(stage, 1)
    yield from stage.drag([(x, y), (x + 20, y)], steps=3)
    yield from stage.until(lambda: _figures()[1].depth < right.depth, "the way back of one")
    assert abs(_figures()[0].depth - held) < 1e-6
    yield from end_press(stage)
    assert _coordinates("Nodes") == before
    assert bpy.data.objects["Nodes"].modifiers.keys() == ["Pinched"]


@at_length
def two_empties_press_as_the_animation_leads_them(stage: Stage) -> Wait:
    yield from _open(stage, PINCH, "Nodes")
    yield from _press(stage)
    assert not any(one.touching for one in _figures())
    bpy.context.scene.frame_set(20)
    yield from stage.until(
        lambda: all(one.depth > 0.0079 for one in _figures()), "both fingers' depths"
    )
    yield from stage.picture("led")
    left, right = _figures()
    assert np.isclose(left.force, right.force, rtol=0.02)
    bpy.data.objects.remove(bpy.data.objects["Nodes Left"])
    yield 0.3
    assert press_session.current() is not None
    yield from type_key(stage, "RET")
    yield from stage.until(lambda: press_session.current() is None, "the kept shape")
    assert "Press 1" in bpy.data.objects["Nodes"].modifiers


def a_press_on_a_stack_moves_what_is_beneath_and_escape_gives_all_back(stage: Stage) -> Wait:
    yield from _open(stage, STACKED, "Lemon")
    before = [seen_points(name) for name in JELLY]
    yield from _press(stage)
    # The front of the uppermost, from which a push presses it into the one beneath, too.
    x, y = stage.pixel(tuple(seen_points("Lemon").mean(axis=0)))
    yield from stage.drag([(x, y), (x + 4, y - 40)], steps=4, release=False)
    yield from stage.until(lambda: _figures()[0].force > 0.002, "the force")
    yield from stage.picture("stack-pressed")
    moved = [np.abs(seen_points(name) - lay).max() for name, lay in zip(JELLY, before, strict=True)]
    assert min(moved) > 1e-5, moved
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from end_press(stage)
    for name, lay in zip(JELLY, before, strict=True):
        np.testing.assert_allclose(seen_points(name), lay, rtol=0, atol=1e-6)


def _open(stage: Stage, file: str, name: str) -> Wait:
    stage.open_scene(own_copy(stage, file))
    yield 0.5
    stage.area.spaces.active.shading.show_cavity = False
    yield from stage.open_sidebar("Palpate")
    bpy.context.view_layer.objects.active = bpy.data.objects[name]
    yield


def _press(stage: Stage) -> Wait:
    yield from stage.move(over_the_view(stage))
    with stage.view():
        bpy.ops.palpate.press("INVOKE_DEFAULT")
    yield from stage.until(lambda: press_session.current().snapshot, "the first tick")


def _figures() -> tuple[Reading, ...]:
    session = press_session.current()
    return readings(session) if session.snapshot is not None else ()


def _handle(stage: Stage, finger: int) -> Pixel:
    return stage.pixel(_figures()[finger].probe)


def _refusal() -> str:
    try:
        bpy.ops.palpate.press("INVOKE_DEFAULT")
    except RuntimeError as refusal:
        return str(refusal)
    return ""


def _coordinates(name: str) -> bytes:
    mesh = bpy.data.objects[name].data
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat.tobytes()
