"""Circle of a stroke's radius, drawn on the surface under the pointer before it is touched."""

from __future__ import annotations

import bpy
import gpu
import numpy as np
from bpy_extras import view3d_utils
from gpu_extras.batch import batch_for_shader
from mathutils import Vector
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...operators.layer import live_layer
from ...operators.place.seen_place import SeenPlace, under_pointer
from ...operators.scene import viewport
from ...operators.scene.drawn_surface import metres_per_unit
from ...operators.scene.viewport import Viewport
from ...operators.stroke.stroke_size import radius_for

SEGMENTS = 48
INWARD, OUTWARD = (0.35, 0.75, 1.0, 0.9), (1.0, 0.65, 0.3, 0.9)
LINE_PIXELS = 1.6


def draw(xy: tuple[int, int]) -> None:
    """Draw at a pointer in window coordinates; nothing beside soft objects."""
    context = bpy.context
    if context.window is None or context.mode != "OBJECT":
        return
    here = viewport.under_pointer(context.window, *xy)
    if here is None or context.region != here.region:
        return
    if context.object is not None and live_layer.find(context.object) is not None:
        # Pressed already; and to find a place on a mesh that has just changed takes long.
        return
    scene = context.scene
    try:
        # As it was evaluated last: a drawing must not evaluate.
        touched = under_pointer(scene, context.view_layer.depsgraph, here)
        if touched is None:
            return
        radius = radius_for(scene, touched.thing) / metres_per_unit(scene)
    except PalpateError:
        # A flattened object; a stroke reports it with its remedy.
        return
    points = _on_screen(_circle(touched, radius), here)
    if points is not None:
        _draw_line(points, OUTWARD if scene.palpate.stroke_outward else INWARD, context)


def _circle(touched: SeenPlace, radius: float) -> NDArray[np.float64]:
    """Points (SEGMENTS + 1, 3) around a place, world, and a stroke along its normal after them."""
    normal = touched.normal
    aside = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    aside /= np.linalg.norm(aside)
    across = np.cross(normal, aside)
    angle = np.linspace(0.0, 2.0 * np.pi, SEGMENTS + 1)[:, None]
    around = np.cos(angle) * aside + np.sin(angle) * across
    return touched.seen + radius * around


def _on_screen(points: NDArray[np.float64], here: Viewport) -> list[tuple[float, float]] | None:
    """World places in window pixels; None where one is behind the viewer."""
    seen = [
        view3d_utils.location_3d_to_region_2d(here.region, here.region_3d, Vector(point))
        for point in points
    ]
    if None in seen:
        return None
    return [(here.region.x + point.x, here.region.y + point.y) for point in seen]


def _draw_line(
    points: list[tuple[float, float]],
    color: tuple[float, float, float, float],
    context: bpy.types.Context,
) -> None:
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINE_STRIP", {"pos": [(x, y, 0.0) for x, y in points]})
    gpu.state.blend_set("ALPHA")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", LINE_PIXELS * context.preferences.system.ui_scale)
    shader.uniform_float("color", color)
    batch.draw(shader)
    gpu.state.blend_set("NONE")
