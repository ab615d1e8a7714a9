"""Circle of a stroke's radius, drawn on the surface under the pointer before it is touched.

The place is found when the pointer moves, before anything is drawn: a drawing must not evaluate,
and what was evaluated last may be gone by then.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import gpu
import numpy as np
from bpy_extras import view3d_utils
from gpu_extras.batch import batch_for_shader
from mathutils import Vector
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...operators.place.seen_place import SeenPlace, under_pointer
from ...operators.scene import viewport
from ...operators.scene.drawn_surface import metres_per_unit
from ...operators.scene.viewport import Viewport
from ...operators.session import press_session
from ...operators.stroke import stroke_size
from ...operators.stroke.stroke_size import radius_for

SEGMENTS = 48
INWARD, OUTWARD = (0.35, 0.75, 1.0, 0.9), (1.0, 0.65, 0.3, 0.9)
LINE_PIXELS = 1.6


@dataclass(frozen=True, eq=False)
class _Found:
    """Points (k, 3) of the circle, world coordinates, for a line of sight: origin and direction."""

    line: tuple[NDArray[np.float64], NDArray[np.float64]]
    points: NDArray[np.float64]


_found: _Found | None = None


class PALPATE_OT_hover(bpy.types.Operator):
    bl_idname = "palpate.hover"
    bl_label = "Show the Tool's Radius"
    bl_description = "Find the surface under the pointer, where a circle shows the tool's radius"
    bl_options = {"INTERNAL"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        global _found  # noqa: PLW0603  there is one pointer
        here = viewport.under_pointer(context.window, event.mouse_x, event.mouse_y)
        _found = None if here is None or context.mode != "OBJECT" else _find(context, here)
        return {"PASS_THROUGH"}


def draw(xy: tuple[int, int]) -> None:
    """Draw at a pointer in window coordinates; nothing beside soft objects, nor while a press shows
    its own finger.
    """
    context = bpy.context
    if press_session.current() is not None or context.window is None or context.mode != "OBJECT":
        return
    here = viewport.under_pointer(context.window, *xy)
    if here is None or context.region != here.region:
        return
    around = _around(here)
    points = None if around is None else _on_screen(around, here)
    if points is not None:
        outward = context.scene.palpate.stroke_outward
        _draw_line(points, OUTWARD if outward else INWARD, context)


def _around(here: Viewport) -> NDArray[np.float64] | None:
    """Points of the circle, world coordinates: where its size is being set, else at the pointer."""
    sized = stroke_size.being_set()
    if sized is not None:
        return _circle(sized.touched, sized.radius)
    if _found is None or not all(map(np.array_equal, _found.line, here.line_of_sight())):
        # The view has moved under the pointer.
        return None
    return _found.points


def _find(context: bpy.types.Context, here: Viewport) -> _Found | None:
    scene = context.scene
    try:
        touched = under_pointer(scene, context.evaluated_depsgraph_get(), here)
        if touched is None:
            return None
        radius = radius_for(scene, touched.thing) / metres_per_unit(scene)
    except PalpateError:
        # A flattened object; a stroke reports it with its remedy.
        return None
    return _Found(here.line_of_sight(), _circle(touched, radius))


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


classes = (PALPATE_OT_hover,)
