"""Objects that nobody holds: they settle, are pushed by the tool, and are given back."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from mouse_scene import type_key
from stage import Stage, Wait

from bl_ext.user_default.palpate.operators.layer import layers

NAME = "Cube"


def an_object_without_pins_settles_is_pushed_along_and_given_back(stage: Stage) -> Wait:
    yield from _free_default_cube(stage)
    before = _place()
    with stage.view():
        bpy.ops.palpate.settle("INVOKE_DEFAULT")
    yield from stage.until(lambda: _names() == ["Rests"], "the object at rest")
    settled = _place()
    assert 0.5 < before[2, 3] - settled[2, 3] < 1.5
    yield from stage.picture("settled")
    with stage.view():
        bpy.ops.wm.tool_set_by_id(name="palpate.tool")
    # From the front right: it gives way, and slides.
    here = stage.pixel((0.2, -1.0, 1.2))
    drag = [here, (here[0] + 80, here[1])]
    yield from stage.drag(drag, release=False)
    yield from stage.picture("pushed")
    assert np.abs(_place() - settled).max() > 1e-3
    yield from stage.key("ESC")
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: _names() == ["Rests"], "the object given back")
    np.testing.assert_allclose(_place(), settled, rtol=0, atol=1e-5)
    yield from stage.drag(drag, release=False)
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.until(lambda: "Press 1" in _names(), "the stroke that is kept")
    yield from stage.picture("kept")
    assert np.abs(_place() - settled).max() > 1e-3
    yield from type_key(stage, "Z", ctrl=True)
    yield from stage.until(lambda: _names() == ["Rests"], "the undo of the stroke")
    np.testing.assert_allclose(_place(), settled, rtol=0, atol=1e-5)
    with stage.view():
        bpy.ops.palpate.reset_rest()
    yield from stage.until(lambda: _names() == [], "the object as it was")
    np.testing.assert_allclose(_place(), before, rtol=0, atol=1e-6)


def _free_default_cube(stage: Stage) -> Wait:
    """The factory scene's cube, with vertices to dent, a metre over the ground, without pins."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
    yield 0.3
    cube = _cube()
    mesh = bmesh.new()
    mesh.from_mesh(cube.data)
    bmesh.ops.subdivide_edges(mesh, edges=mesh.edges[:], cuts=15, use_grid_fill=True)
    mesh.to_mesh(cube.data)
    mesh.free()
    cube.location.z = 2.0
    settings = cube.palpate
    # Two metres of plush would sink into a heap.
    settings.young_modulus, settings.density, settings.pin_mode = 1e5, 100.0, "NONE"
    settings.edge_length = 0.12
    bpy.context.scene.palpate.tip_radius = 0.3
    with stage.view():
        bpy.context.view_layer.objects.active = cube
        bpy.ops.palpate.make_soft("EXEC_DEFAULT")
    yield from stage.open_sidebar("Palpate")
    yield 0.5
    bpy.ops.ed.undo_push(message="Free cube")
    yield


def _cube() -> bpy.types.Object:
    return bpy.data.objects[NAME]


def _place() -> np.ndarray:
    bpy.context.view_layer.update()
    return np.array(_cube().matrix_world)


def _names() -> list[str]:
    return [layer.name for layer in layers.layers_of(_cube())]
