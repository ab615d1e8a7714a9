"""What a press shows in the view: probe, contact on the surface, the line between, and the force.

Everything is drawn twice: faintly through the body, and fully where nothing hides it.
"""

from collections.abc import Sequence

import bpy
import gpu
import numpy as np
from bpy_extras import view3d_utils
from gpu_extras.batch import batch_for_shader
from mathutils import Vector
from numpy.typing import NDArray

from ..operators import press_session
from ..operators.package_preferences import preferences
from ..operators.press_session import PressSession
from ..operators.press_state import Phase
from . import hud, workspace
from .overlay_shapes import CONE, SPHERE, Lit, lit
from .reading import Reading, reading

Array = NDArray[np.float64]
# Start, end, colour and width in pixels of a line.
Line = tuple[Array, Array, Sequence[float], float]

SEEN_THROUGH = 0.5
# The arrow has half its full length at this force: small ones show, large ones fit the screen.
HALF_LENGTH_FORCE = 0.3
CONTACT_SIZE, LINE_PIXELS = 0.6, 2.5
WORKSPACE_COLOR, WORKSPACE_PIXELS = (0.75, 0.85, 1.0, 0.4), 1.5
HEAD_LENGTH, HEAD_WIDTH, SHAFT_PIXELS = 20.0, 7.0, 4.0


def draw_in_view() -> None:
    """Draw in world coordinates, after the scene."""
    session = press_session.current()
    region, region_3d = bpy.context.region, bpy.context.region_data
    if region_3d is None:
        return
    scale = bpy.context.preferences.system.ui_scale
    reach: list[Line] = [
        (start, end, WORKSPACE_COLOR, WORKSPACE_PIXELS * scale)
        for start, end in workspace.outline(bpy.context, session)
    ]
    if reach:
        _draw([], reach, "LESS_EQUAL", 1.0)
    if session is None:
        return
    figures = reading(session)
    if session.snapshot is None or not _worth_drawing(session, figures):
        return
    chosen = preferences()
    parts = []
    pixel = _world_per_pixel(region, region_3d, figures.probe) * scale
    toward = np.array(region_3d.view_matrix)[:3, :3]
    parts.append(
        lit(SPHERE, figures.probe, chosen.probe_pixels * pixel, chosen.probe_color, toward)
    )
    lines = []
    if figures.touching:
        radius = CONTACT_SIZE * chosen.probe_pixels * pixel
        parts.append(lit(SPHERE, figures.contact, radius, chosen.contact_color, toward))
        lines.append((figures.probe, figures.contact, chosen.contact_color, LINE_PIXELS * scale))
        if figures.force > 0.0:
            shaft, head = _arrow(figures, chosen, pixel, toward)
            lines.append((*shaft, chosen.force_color, SHAFT_PIXELS * scale))
            parts.append(head)
    for depth_test, opacity in (("NONE", SEEN_THROUGH), ("LESS_EQUAL", 1.0)):
        _draw(parts, lines, depth_test, opacity)


def _worth_drawing(session: PressSession, figures: Reading) -> bool:
    """A pointer that has not touched yet has no probe to show, nor has a device not heard of."""
    nowhere = session.awaits_device or session.state.phase in {Phase.READY, Phase.LOST}
    return figures.touching or not nowhere


def _arrow(
    figures: Reading, chosen: bpy.types.AddonPreferences, pixel: float, toward: Array
) -> tuple[tuple[Array, Array], Lit]:
    direction = figures.force_vector / np.linalg.norm(figures.force_vector)
    share = figures.force / (figures.force + HALF_LENGTH_FORCE)
    tip = figures.contact + (HEAD_LENGTH + chosen.arrow_pixels * share) * pixel * direction
    neck = tip - HEAD_LENGTH * pixel * direction
    size = np.array([HEAD_WIDTH, HEAD_WIDTH, HEAD_LENGTH]) * pixel
    turn = Vector((0, 0, 1)).rotation_difference(Vector(direction)).to_matrix()
    head = lit(CONE, neck, size, chosen.force_color, toward, np.array(turn))
    return (figures.contact, neck), head


def _draw(parts: list[Lit], lines: list[Line], depth_test: str, opacity: float) -> None:
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set(depth_test)
    gpu.state.face_culling_set("BACK")
    shader = gpu.shader.from_builtin("SMOOTH_COLOR")
    for vertices, colors, triangles in parts:
        faded = colors * np.array([1.0, 1.0, 1.0, opacity], dtype=np.float32)
        batch = batch_for_shader(
            shader, "TRIS", {"pos": vertices, "color": faded}, indices=triangles
        )
        batch.draw(shader)
    gpu.state.face_culling_set("NONE")
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    viewport = gpu.state.viewport_get()
    for start, end, color, width in lines:
        ends = np.array([start, end], dtype=np.float32)
        batch = batch_for_shader(shader, "LINES", {"pos": ends})
        shader.bind()
        shader.uniform_float("viewportSize", viewport[2:])
        shader.uniform_float("lineWidth", width)
        shader.uniform_float("color", (*color[:3], color[3] * opacity))
        batch.draw(shader)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


def _world_per_pixel(
    region: bpy.types.Region, region_3d: bpy.types.RegionView3D, place: Array
) -> float:
    """Length of a pixel at ``place`` in world units."""
    right = np.array(region_3d.view_matrix)[0, :3]
    step = 0.01 * region_3d.view_distance
    here, aside = (
        view3d_utils.location_3d_to_region_2d(region, region_3d, Vector(point))
        for point in (place, place + step * right)
    )
    pixels = (aside - here).length if here is not None and aside is not None else 0.0
    return step / pixels if pixels > 0.0 else 0.0


def draw_hud() -> None:
    """Draw in pixels, on top of everything."""
    session = press_session.current()
    if session is not None:
        hud.draw(bpy.context, session)


_handles: list[object] = []


def register() -> None:
    """Draw in all 3D views."""
    if bpy.app.background:
        # There is no view to draw in.
        return
    add = bpy.types.SpaceView3D.draw_handler_add
    _handles.append(add(draw_in_view, (), "WINDOW", "POST_VIEW"))
    _handles.append(add(draw_hud, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    """Stop drawing."""
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
