"""The factory scene's cube as an object that nobody holds."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
from stage import Stage, Wait

from bl_ext.user_default.palpate.operators.layer import layers


def free_default_cube(stage: Stage) -> Wait:
    """The factory scene's cube, with vertices to dent, a little over the ground, without pins."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=False)
    yield 0.3
    cube = default_cube()
    mesh = bmesh.new()
    mesh.from_mesh(cube.data)
    bmesh.ops.subdivide_edges(mesh, edges=mesh.edges[:], cuts=15, use_grid_fill=True)
    mesh.to_mesh(cube.data)
    mesh.free()
    cube.location.z = 1.1
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


def default_cube() -> bpy.types.Object:
    return bpy.data.objects["Cube"]


def placed() -> np.ndarray:
    bpy.context.view_layer.update()
    return np.array(default_cube().matrix_world)


def layer_names() -> list[str]:
    return [layer.name for layer in layers.layers_of(default_cube())]


def lowest() -> float:
    matrix = placed()
    return float((_seen() @ matrix[:3, :3].T + matrix[:3, 3])[:, 2].min())


def _seen() -> np.ndarray:
    """Vertices (p, 3) as they are seen, in the cube's own axes."""
    graph = bpy.context.evaluated_depsgraph_get()
    mesh = default_cube().evaluated_get(graph).to_mesh()
    places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", places)
    return places.reshape(-1, 3)
