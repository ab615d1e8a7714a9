"""Strokes with the tool of the toolbar, by the events of a pointer."""

from __future__ import annotations

import math

import bmesh
import bpy
import numpy as np
from bl_keymap_utils import keymap_hierarchy
from free_cube import free_default_cube, layer_names, lowest, placed
from mouse_scene import open_mouse, type_key
from random_drags import Drag, random_drags
from stage import Stage, Wait, at_length

from bl_ext.user_default.palpate.operators.layer import layers, live_layer
from bl_ext.user_default.palpate.operators.object import soft_object

TOOL = "palpate.tool"
DIRECTIONS = {
    "right": (90, 0),
    "left": (-90, 0),
    "up": (0, 90),
    "down": (0, -90),
}


@at_length
def the_default_cube_is_pushed_by_a_drag_in_every_direction(stage: Stage) -> Wait:
    cube = yield from _soft_default_cube(stage)
    _choose_tool(stage)
    for number, (name, (x, y)) in enumerate(DIRECTIONS.items(), start=1):
        here = stage.pixel(_place_on_cube(number))
        yield from stage.move(here)
        yield from stage.picture(f"circle-{name}")
        yield from stage.drag([here, (here[0] + x, here[1] + y)], release=False)
        yield from stage.picture(f"push-{name}")
        yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
        yield from stage.until(lambda n=number: len(kept(cube)) == n, "the stroke that is kept")
        shift = last_stroke(cube)
        inward = -np.eye(3)[1] * -1 if number % 2 else -np.eye(3)[2]
        assert (shift @ inward).max() > 0.05, f"{name} did not push in"
    for number in (3, 2, 1, 0):
        yield from type_key(stage, "Z", ctrl=True)
        yield from stage.until(
            lambda n=number: len(kept(bpy.data.objects["Cube"])) == n, "one undo step a stroke"
        )


def every_kind_of_stroke_is_kept_and_escape_restores(stage: Stage) -> Wait:
    cube = yield from _soft_default_cube(stage)
    _choose_tool(stage)
    here = stage.pixel((0.1, 0.2, 1.0))
    for number, (motion, shift) in enumerate(
        [("PUSH", False), ("PUSH", True), ("GRAB", False), ("TWIST", False), ("PINCH", False)]
    ):
        bpy.context.scene.palpate.stroke = motion
        yield from stage.drag([here, (here[0] + 60, here[1] + 40)], release=False, shift=shift)
        yield from stage.picture(f"{motion.lower()}-{'other-way' if shift else 'drag'}")
        if number % 2:
            yield from stage.key("ESC")
            yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
            yield 0.3
            assert kept(cube) == []
            continue
        yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
        yield from stage.until(lambda: len(kept(bpy.data.objects["Cube"])) == 1, "the stroke")
        yield from type_key(stage, "Z", ctrl=True)
        yield from stage.until(lambda: not kept(bpy.data.objects["Cube"]), "the undo")
        cube = bpy.data.objects["Cube"]


@at_length
def a_drag_beside_the_object_selects_and_moves_nothing(stage: Stage) -> Wait:
    cube = yield from _soft_default_cube(stage)
    _choose_tool(stage)
    with stage.view():
        bpy.ops.view3d.view_axis(type="FRONT")
    yield 0.5
    beside, across = stage.pixel((-1.6, 0.0, 1.4)), stage.pixel((0.0, 0.0, 0.0))
    others = [one for one in bpy.context.view_layer.objects if one != cube]
    for name, held in (("a-box", False), ("more", True)):
        for one in others:
            one.select_set(held)
        cube.select_set(not held)
        yield from stage.drag([beside, across], shift=held)
        yield from stage.picture(f"{name}-is-selected")
        assert cube.select_get(), f"{name}: what the box met is not selected"
        assert all(one.select_get() == held for one in others), name
    assert not any(cube.location), f"it was moved to {cube.location}"
    assert not kept(cube)


@at_length
def a_push_goes_along_the_surface_with_ctrl(stage: Stage) -> Wait:
    cube = yield from _soft_default_cube(stage)
    _choose_tool(stage)
    here = stage.pixel((-0.3, 0.0, 1.0))
    yield from stage.move(here)
    yield from stage.picture("circle")
    yield from stage.drag([here, (here[0], here[1] - 40)], release=False)
    before, (x, y) = _live_depth(cube), stage.mouse
    assert before > 0.05
    yield from stage.event("LEFT_CTRL", "PRESS", stage.mouse, ctrl=True)
    for step in range(1, 11):
        yield from stage.move((x + 7 * step, y), ctrl=True)
    yield from stage.event("LEFT_CTRL", "RELEASE", stage.mouse)
    yield from stage.picture("slid")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: len(kept(cube)) == 1, "the stroke")
    done = bpy.context.window_manager.operators[-1].properties
    assert math.hypot(*done["by"]) > 0.2, "it did not go along"
    # As deep as before, to what the coarse dent shows of it.
    assert math.isclose(-last_stroke(cube)[:, 2].min(), before, rel_tol=0.3)


@at_length
def a_stroke_is_undone_and_done_again_by_keys(stage: Stage) -> Wait:
    cube = yield from _soft_default_cube(stage)
    _choose_tool(stage)
    name, strokes = cube.name, []
    for number in (1, 2):
        here = stage.pixel(_place_on_cube(number))
        yield from stage.drag([here, (here[0], here[1] - 90)])
        yield from stage.until(
            lambda n=number: len(kept(bpy.data.objects[name])) == n, "the stroke that is kept"
        )
        strokes.append(last_stroke(bpy.data.objects[name]))
    for count in (1, 0):
        yield from type_key(stage, "Z", ctrl=True)
        yield from stage.until(
            lambda n=count: len(kept(bpy.data.objects[name])) == n, "one stroke fewer"
        )
    yield from stage.picture("undone")
    for number, stroke in enumerate(strokes, start=1):
        yield from type_key(stage, "Z", ctrl=True, shift=True)
        yield from stage.until(
            lambda n=number: len(kept(bpy.data.objects[name])) == n, "the stroke again"
        )
        np.testing.assert_array_equal(last_stroke(bpy.data.objects[name]), stroke)
    yield from stage.picture("done-again")


def shortcuts_stand_in_the_preferences(stage: Stage) -> Wait:
    """Where Blender's own list of keymaps looks for them."""
    yield from stage.picture("start")
    listed = {name: within for name, _, _, within in _all_keymaps()}
    assert "3D View Tool: Object, Palpate" in listed
    keyed = {
        item.idname
        for keys in bpy.context.window_manager.keyconfigs.user.keymaps
        if keys.name in listed
        for item in keys.keymap_items
        if item.idname.startswith("palpate.") or getattr(item.properties, "name", "") == TOOL
    }
    assert {"palpate.stroke", "palpate.stroke_size", "wm.tool_set_by_id"} <= keyed


@at_length
def a_depth_is_typed_while_dragging(stage: Stage) -> Wait:
    cube = yield from _soft_default_cube(stage)
    _choose_tool(stage)
    here = stage.pixel((0.0, 0.0, 1.0))
    yield from stage.drag([here, (here[0] + 30, here[1])], release=False)
    for digit in ("PERIOD", "TWO"):
        yield from stage.key(digit)
    yield from stage.picture("typed")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: len(kept(cube)) == 1, "the stroke")
    last = bpy.context.window_manager.operators[-1]
    assert last.bl_idname == "PALPATE_OT_stroke"
    assert math.isclose(last.properties["depth"], 0.2, rel_tol=1e-5)


@at_length
def clay_springs_back_to_its_imprint_by_strokes_and_presses(stage: Stage) -> Wait:
    cube = yield from _soft_default_cube(stage)
    cube.palpate.yield_depth = 0.1
    _choose_tool(stage)
    here = stage.pixel((0.3, -1.0, 0.2))
    yield from stage.drag([here, (here[0] + 90, here[1])], release=False)
    yield from stage.picture("held")
    held = _live_depth(cube)
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: kept(cube), "the imprint")
    left = np.linalg.norm(last_stroke(cube), axis=1).max()
    assert math.isclose(left, held - 0.1, abs_tol=1e-5)
    # A press that is led along leaves its way.
    start, end = stage.pixel((-0.6, 0.0, 1.0)), stage.pixel((0.6, 0.0, 1.0))
    with stage.view():
        bpy.ops.palpate.press("INVOKE_DEFAULT")
    yield 0.3
    yield from stage.drag([start, end], steps=8, release=False)
    for _ in range(3):
        yield from stage.event("WHEELDOWNMOUSE", "PRESS", stage.mouse)
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield 0.5
    yield from stage.picture("press-held")
    yield from stage.key("RET")
    yield from stage.until(lambda: len(kept(cube)) == 2, "the imprint of the press")
    yield from stage.picture("let-go")
    # A second tap beside the first goes on from its imprint: it is seen where it touches.
    beside = (here[0] + 12, here[1] + 6)
    yield from stage.drag([beside, (beside[0] + 90, beside[1])])
    yield from stage.until(lambda: len(kept(cube)) == 3, "the second tap")
    yield from stage.picture("second-tap")
    both = [layers.displacement(cube, cube.modifiers[name]) for name in ("Press 1", "Press 3")]
    sum_of = np.linalg.norm(both[0] + both[1], axis=1).max()
    assert sum_of > 1.3 * left


@at_length
def random_drags_press_where_the_cursor_is(stage: Stage) -> Wait:
    yield from _random_drags_on_bodies(stage, 1.0)


@at_length
def random_drags_press_where_the_cursor_is_in_a_large_interface(stage: Stage) -> Wait:
    try:
        yield from _random_drags_on_bodies(stage, 1.75)
    finally:
        bpy.context.preferences.view.ui_scale = 1.0


def _random_drags_on_bodies(stage: Stage, scale: float) -> Wait:
    """Ten drags in all, with the sidebar open."""
    rng = np.random.default_rng(round(100 * scale))
    for name in ("Cube", "Mouse"):
        yield from (_soft_default_cube(stage) if name == "Cube" else open_mouse(stage))
        bpy.context.preferences.view.ui_scale = scale
        yield 0.5
        yield from stage.open_sidebar("Palpate")
        yield from _settled(stage)
        drags: list[Drag] = []
        yield from random_drags(stage, name, rng, 5, drags)
        yield from stage.picture(name)
        missed = [drag for drag in drags if not drag.hit]
        assert not missed, f"{name}: {missed}"


def an_object_without_pins_settles_is_pushed_along_and_given_back(stage: Stage) -> Wait:
    yield from free_default_cube(stage)
    before = placed()
    with stage.view():
        bpy.ops.palpate.settle("INVOKE_DEFAULT", True)
    yield from stage.until(lambda: 0.02 < before[2, 3] - placed()[2, 3] < 0.05, "its fall")
    yield from stage.picture("falls")
    yield from stage.key("ESC")
    yield from stage.until(lambda: layer_names() == [], "the object given back")
    np.testing.assert_allclose(placed(), before, rtol=0, atol=1e-6)
    with stage.view():
        bpy.ops.palpate.settle("INVOKE_DEFAULT", True)
    yield from stage.until(lambda: not stage.window.modal_operators, "the object at rest")
    assert layer_names() == ["Rests"]
    settled = placed()
    assert 0.05 < before[2, 3] - settled[2, 3] < 0.3
    yield from stage.picture("settled")
    with stage.view():
        bpy.ops.wm.tool_set_by_id(name="palpate.tool")
    # From the front right: it gives way, and slides.
    here = stage.pixel((0.2, -1.0, 1.2))
    drag = [here, (here[0] + 80, here[1])]
    yield from stage.drag(drag, release=False)
    yield from stage.picture("pushed")
    assert np.abs(placed() - settled).max() > 1e-3
    yield from stage.key("ESC")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: layer_names() == ["Rests"], "the object given back")
    np.testing.assert_allclose(placed(), settled, rtol=0, atol=1e-5)
    yield from stage.drag(drag, release=False)
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: "Press 1" in layer_names(), "the stroke that is kept")
    yield from stage.picture("kept")
    assert np.abs(placed() - settled).max() > 1e-3
    yield from type_key(stage, "Z", ctrl=True)
    yield from stage.until(lambda: layer_names() == ["Rests"], "the undo of the stroke")
    np.testing.assert_allclose(placed(), settled, rtol=0, atol=1e-5)
    yield from _carried_about(stage, settled)
    yield from _pressed_aside(stage, settled)
    with stage.view():
        bpy.ops.palpate.reset_rest()
    yield from stage.until(lambda: layer_names() == [], "the object as it was")
    np.testing.assert_allclose(placed(), before, rtol=0, atol=1e-6)


def _carried_about(stage: Stage, settled: np.ndarray) -> Wait:
    """It is grabbed by its side, lifted off the floor, and comes down beside where it was."""
    bpy.context.scene.palpate.stroke = "GRAB"
    here = stage.pixel((0.3, -1.0, 1.2))
    yield from stage.drag([here, (here[0] + 60, here[1] + 150)], release=False)
    yield from stage.until(lambda: lowest() > 0.1, "the object in the air")
    yield from stage.picture("carried")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: layer_names() == ["Rests"], "the object let go")
    yield from stage.picture("let-go")
    assert abs(lowest()) < 0.02
    assert np.linalg.norm((placed() - settled)[:2, 3]) > 0.1
    yield from type_key(stage, "Z", ctrl=True)
    yield from stage.until(
        lambda: np.allclose(placed(), settled, rtol=0, atol=1e-5), "the undo of the grab"
    )


def _pressed_aside(stage: Stage, settled: np.ndarray) -> Wait:
    """A press takes it along; Escape gives it back."""
    bpy.context.scene.palpate.tip = "SPHERE"
    with stage.view():
        bpy.ops.palpate.press("INVOKE_DEFAULT", True)
    yield 0.3
    here = stage.pixel((0.2, -1.0, 0.8))
    yield from stage.drag([here, (here[0], here[1] + 60)], release=False)
    yield from stage.until(lambda: np.abs(placed() - settled).max() > 0.02, "the object aside")
    yield from stage.picture("pressed")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.key("ESC")
    yield from stage.until(lambda: layer_names() == ["Rests"], "the object given back")
    np.testing.assert_allclose(placed(), settled, rtol=0, atol=1e-5)


def _settled(stage: Stage) -> Wait:
    """Wait until the sidebar has its place, which a larger interface gives it in steps."""
    before = None
    while before != (before := (stage.region("UI").x, stage.region("UI").width)):
        yield 1.0
        yield


def _soft_default_cube(stage: Stage) -> Wait:
    """The factory scene's cube, with vertices to dent, made soft."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
    yield 0.3
    cube = bpy.data.objects["Cube"]
    mesh = bmesh.new()
    mesh.from_mesh(cube.data)
    bmesh.ops.subdivide_edges(mesh, edges=mesh.edges[:], cuts=15, use_grid_fill=True)
    mesh.to_mesh(cube.data)
    mesh.free()
    bpy.context.scene.palpate.tip_radius = 0.2
    with stage.view():
        bpy.context.view_layer.objects.active = cube
        bpy.ops.palpate.make_soft("EXEC_DEFAULT")
    region = stage.area.spaces.active.region_3d
    region.view_distance = 6.0
    bpy.ops.ed.undo_push(message="Soft")
    yield 0.3
    assert not soft_object.refusal(cube)
    return cube


def _choose_tool(stage: Stage) -> None:
    with stage.view():
        bpy.ops.wm.tool_set_by_id(name=TOOL)


def _place_on_cube(number: int) -> tuple[float, float, float]:
    """Places on the front and on top, in turn."""
    return (0.3, -1.0, 0.2) if number % 2 else (-0.2, 0.2, 1.0)


def _live_depth(thing: bpy.types.Object) -> float:
    live = live_layer.find(thing)
    moved = None if live is None else layers.displacement(thing, live)
    assert moved is not None
    return float(np.linalg.norm(moved, axis=1).max())


def _all_keymaps(within: list | None = None) -> list[tuple]:
    """Keymaps as the preferences list them, with those inside others."""
    found = []
    for entry in keymap_hierarchy.generate() if within is None else within:
        found += [entry, *_all_keymaps(entry[3])]
    return found


def kept(thing: bpy.types.Object) -> list[str]:
    """Names of the strokes that were kept."""
    return [layer.name for layer in layers.layers_of(thing) if layer.name.startswith("Press")]


def last_stroke(thing: bpy.types.Object) -> np.ndarray:
    """Displacements (p, 3) of the last stroke kept, local units."""
    moved = layers.displacement(thing, thing.modifiers[kept(thing)[-1]])
    assert moved is not None
    return moved
