"""Show Pins and Show Tetrahedra: drawn over the active object."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...operators.object.embedded_body import embedded
from ...operators.pins import pin_group
from ...operators.scene import drawn_surface
from ...operators.session import press_session
from .cut_body import below, faces_of, outermost
from .film import film

Array = NDArray[np.float64]

# Pins lie below, mostly: they show through the object too.
PIN_COLOR, SEEN_THROUGH = np.array([0.25, 0.62, 1.0, 0.6]), 0.45
TET_COLOR, STIFF_COLOR, PINNED_COLOR = (0.86, 0.78, 0.62), (0.95, 0.95, 0.92), (0.35, 0.62, 0.9)
LIGHT, AMBIENT = np.array([-0.4, 0.6, 0.7]) / np.linalg.norm([-0.4, 0.6, 0.7]), 0.35
# How far the film of the pins lies before the surface, as a share of the view's distance.
BEFORE = 5e-4

# What was drawn last of each kind: what it depends on, object and mesh first, and its world
# coordinates and colours.
_known: dict[str, tuple[tuple[object, ...], tuple[Array, Array]]] = {}
_handles: list[object] = []


def forget() -> None:
    """Compute all anew: another file, another step of undo."""
    _known.clear()


def changed(depsgraph: bpy.types.Depsgraph) -> None:
    """Compute anew what a mesh or its weights were changed of; a transform is looked at."""
    uids = {u.id.original.session_uid for u in depsgraph.updates if u.is_updated_geometry}
    for kind, (which, _) in list(_known.items()):
        if uids & {*which[:2]}:
            del _known[kind]


def draw() -> None:
    """Draw in world coordinates, after the scene."""
    context = bpy.context
    thing, chosen = context.object, context.scene.palpate
    if thing is None or thing.type != "MESH" or thing.mode != "OBJECT" or not thing.visible_get():
        return
    # The body at rest would cover what a press does to it.
    if context.region_data is None or press_session.current() is not None:
        return
    axes = np.array(context.region_data.view_matrix)[:3, :3]
    matrix = tuple(np.array(thing.matrix_world).ravel().tolist())
    uids = thing.session_uid, thing.data.session_uid
    if chosen.show_tetrahedra and thing.palpate.body_key:
        which = (*uids, thing.palpate.body_key, chosen.cut_axis, chosen.cut, matrix)
        _draw_tetrahedra(*_kept("tetrahedra", which, lambda: _tetrahedra(context)), axes)
    if chosen.show_pins:
        settings = thing.palpate
        rule = (settings.pin_mode, settings.pin_group, settings.pin_fraction)
        faces, _ = _kept("pins", (*uids, *rule, matrix), lambda: _pins(context))
        nearer = BEFORE * context.region_data.view_distance * axes[2]
        for depth_test, opacity in (("NONE", SEEN_THROUGH), ("LESS_EQUAL", 1.0)):
            colors = np.tile(PIN_COLOR * [1.0, 1.0, 1.0, opacity], (3 * len(faces), 1))
            _draw_triangles(faces + nearer, colors, depth_test)


def _kept(
    kind: str, which: tuple[object, ...], make: Callable[[], tuple[Array, Array]]
) -> tuple[Array, Array]:
    if kind not in _known or _known[kind][0] != which:
        try:
            made = make()
        except PalpateError:
            # Nothing to show; Make Soft says why, with the remedy.
            made = np.zeros((0, 3, 3)), np.zeros((0, 3))
        _known[kind] = which, made
    return _known[kind][1]


def _pins(context: bpy.types.Context) -> tuple[Array, Array]:
    """Triangles (k, 3, 3) of the pinned part of the surface, world."""
    thing, scene = context.object, context.scene
    if thing.palpate.pin_mode == "NONE":
        return np.zeros((0, 3, 3)), np.zeros((0, 3))
    if thing.palpate.pin_mode == "CORE":
        return _core(context)
    surface = drawn_surface.read(thing, scene)
    triangles = surface.frame.wind(surface.triangles)
    weights = pin_group.pinned_from(thing, surface).weights
    places = film(surface.body, triangles, weights, pin_group.PINNED_FROM)
    return surface.frame.world_from_body(places), np.zeros((0, 3))


def _core(context: bpy.types.Context) -> tuple[Array, Array]:
    """Triangles (k, 3, 3) of the tetrahedra inside that are pinned, world; none before a bake."""
    thing = context.object
    if not thing.palpate.body_key:
        return np.zeros((0, 3, 3)), np.zeros((0, 3))
    body = embedded(thing)
    nodes = drawn_surface.frame_of(thing, context.scene).world_from_body(body.mesh.nodes)
    held = np.isin(body.mesh.tets, body.fixed).sum(axis=1)
    return faces_of(nodes, body.mesh.tets[held >= min(3, held.max())]), np.zeros((0, 3))


def _tetrahedra(context: bpy.types.Context) -> tuple[Array, Array]:
    """Faces (k, 3, 3) of the tetrahedra that are left of the cut, world, and their colours."""
    thing, chosen = context.object, context.scene.palpate
    frame, body = drawn_surface.frame_of(thing, context.scene), embedded(thing)
    nodes = frame.world_from_body(body.mesh.nodes)
    left = below(nodes, body.mesh.tets, "XYZ".index(chosen.cut_axis), 0.01 * chosen.cut)
    shown = left[outermost(body.mesh.tets[left])]
    colors = np.tile(TET_COLOR, (len(shown), 1))
    if body.young_scale is not None:
        colors[body.young_scale[shown] > 1.0] = STIFF_COLOR
    colors[np.isin(body.mesh.tets[shown], body.fixed).any(axis=1)] = PINNED_COLOR
    return faces_of(nodes, body.mesh.tets[shown]), np.repeat(colors, 4, axis=0)


def _draw_tetrahedra(faces: Array, colors: Array, axes: Array) -> None:
    """Draw faces from behind, lit: over the object, which they stand for."""
    across = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)
    toward = np.flatnonzero(across @ axes[2] > 0.0)
    order = toward[np.argsort(faces[toward].mean(axis=1) @ axes[2])]
    light = AMBIENT + (1.0 - AMBIENT) * np.clip(across[order] @ axes.T @ LIGHT, 0.0, 1.0)
    shade = np.ones((len(order), 4))
    shade[:, :3] = colors[order] * light[:, None]
    _draw_triangles(faces[order], np.repeat(shade, 3, axis=0), "NONE")


def _draw_triangles(faces: Array, colors: Array, depth_test: str) -> None:
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    content = {"pos": faces.reshape(-1, 3).astype(np.float32), "color": colors.astype(np.float32)}
    batch = batch_for_shader(shader, "TRIS", content)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set(depth_test)
    batch.draw(shader)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def register() -> None:
    """Add the drawing to all 3D views."""
    if not bpy.app.background:
        _handles.append(bpy.types.SpaceView3D.draw_handler_add(draw, (), "WINDOW", "POST_VIEW"))


def unregister() -> None:
    """Stop drawing."""
    forget()
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
