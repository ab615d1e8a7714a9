"""Overlay of a press: fingers with contact and force, tools as glass, contact patches as colour.

Probes and arrows are drawn twice: faintly through the body, and fully where visible.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from weakref import WeakKeyDictionary

import bpy
import gpu
import numpy as np
from bpy_extras import view3d_utils
from gpu_extras.batch import batch_for_shader
from mathutils import Vector
from numpy.typing import NDArray

from ...core.contact.tool.tools import Tool
from ...operators.reporting.quantities import newtons
from ...operators.scene.package_preferences import preferences
from ...operators.session import press_session
from ...operators.session.press_session import PressSession
from ...operators.session.press_state import Phase
from . import hud, labels, regions, workspace
from .contact_film import contact_film
from .labels import Label
from .pressure_colors import PressureScale
from .reading import Patch, Reading, readings
from .shapes import CONE, SPHERE, Lit, Shape, glass, lit, tool_shape

Array = NDArray[np.float64]
# Start, end, colour and width in pixels of a line.
Line = tuple[Array, Array, Sequence[float], float]

SEEN_THROUGH = 0.5
# Force of an arrow of half the full length: small ones show, large ones fit the screen.
HALF_LENGTH_FORCE = 0.3
CONTACT_SIZE, LINE_PIXELS = 0.6, 2.5
WORKSPACE_COLOR, WORKSPACE_PIXELS = (0.75, 0.85, 1.0, 0.4), 1.5
HEAD_LENGTH, HEAD_WIDTH, SHAFT_PIXELS = 20.0, 7.0, 4.0
# The patch is drawn this share of its points' spacing nearer to the viewer, since the drawn surface
# is coarser than the contact.
PATCH_LIFT, PATCH_SEEN_THROUGH = 0.5, 0.15


@dataclass(frozen=True, eq=False)
class View:
    """View being drawn: its axes (3, 3) in the world, and the interface's scale."""

    region: bpy.types.Region
    region_3d: bpy.types.RegionView3D
    scale: float

    @property
    def axes(self) -> Array:
        """Right, up and toward the viewer, as rows."""
        axes: Array = np.array(self.region_3d.view_matrix)[:3, :3]
        return axes

    def pixel_at(self, place: Array) -> float:
        """Length of an unscaled pixel at ``place`` in world units."""
        step = 0.01 * self.region_3d.view_distance
        here, aside = (self.seen(point) for point in (place, place + step * self.axes[0]))
        pixels = (aside - here).length if here is not None and aside is not None else 0.0
        return self.scale * step / pixels if pixels > 0.0 else 0.0

    def seen_all(self, places: Array) -> Array:
        """Pixels (n, 2) in the region of those world places (p, 3) that are before the viewer."""
        matrix = np.array(self.region_3d.perspective_matrix)
        clip = places @ matrix[:, :3].T + matrix[:, 3]
        before = clip[clip[:, 3] > 0.0]
        half = 0.5 * np.array([self.region.width, self.region.height])
        seen: Array = half * (1.0 + before[:, :2] / before[:, 3:])
        return seen

    def seen(self, place: Array) -> Vector | None:
        """Position of a world place in the region, pixels."""
        return view3d_utils.location_3d_to_region_2d(self.region, self.region_3d, Vector(place))


_scales: WeakKeyDictionary[PressSession, PressureScale] = WeakKeyDictionary()


def draw_in_view() -> None:
    """Draw in world coordinates, after the scene."""
    session, view = press_session.current(), _view()
    if view is None:
        return
    reach: list[Line] = [
        (start, end, WORKSPACE_COLOR, WORKSPACE_PIXELS * view.scale)
        for start, end in workspace.outline(bpy.context, session)
    ]
    if reach:
        _draw([], reach, "LESS_EQUAL", 1.0)
    if session is None or session.snapshot is None:
        return
    shown = [one for one in readings(session) if _worth_drawing(session, one)]
    parts: list[Lit] = []
    lines: list[Line] = []
    for figures in shown:
        if session.tip.tool is None or session.pinches or not figures.touching:
            parts.append(_ball(figures.probe, 1.0, preferences().probe_color, view))
        if figures.touching:
            _add_contact(figures, session, view, parts, lines)
    patches = [one.patch for one in shown if one.patch is not None]
    if patches and session.scene.palpate.show_pressure:
        _draw_patches(patches, _pressure_scale(session, shown), view)
    for depth_test, opacity in (("NONE", SEEN_THROUGH), ("LESS_EQUAL", 1.0)):
        _draw(parts, lines, depth_test, opacity)
    if session.tip.tool is not None:
        _draw([_tool(session, session.tip.tool, one, view) for one in shown], [], "LESS_EQUAL", 1.0)


def _view() -> View | None:
    context = bpy.context
    if context.region_data is None:
        return None
    return View(context.region, context.region_data, context.preferences.system.ui_scale)


def _worth_drawing(session: PressSession, figures: Reading) -> bool:
    """Whether a finger has a probe to show: pointers after the first touch, devices after the
    first STATE, handles always.
    """
    nowhere = session.awaits_device or session.state.phase in {Phase.READY, Phase.LOST}
    return figures.touching or session.pinches or not nowhere


def _pressure_scale(session: PressSession, shown: list[Reading]) -> float:
    """Pressure of the last colour, one scale for all fingers of a press."""
    scale = _scales.setdefault(session, PressureScale())
    return scale.follow(max(one.largest_pressure for one in shown))


def _ball(place: Array, size: float, color: Sequence[float], view: View) -> Lit:
    radius = size * preferences().probe_pixels * view.pixel_at(place)
    return lit(SPHERE, place, radius, color, view.axes)


def _add_contact(
    figures: Reading, session: PressSession, view: View, parts: list[Lit], lines: list[Line]
) -> None:
    """Add a point's contact and the line to its probe, and the force of any finger."""
    chosen = preferences()
    if session.tip.tool is None:
        parts.append(_ball(figures.contact, CONTACT_SIZE, chosen.contact_color, view))
        width = LINE_PIXELS * view.scale
        lines.append((figures.probe, figures.contact, chosen.contact_color, width))
    if figures.force > 0.0:
        pixel = view.pixel_at(figures.contact)
        tip, direction = arrow_tip(figures, pixel)
        neck = tip - HEAD_LENGTH * pixel * direction
        size = np.array([HEAD_WIDTH, HEAD_WIDTH, HEAD_LENGTH]) * pixel
        turn = Vector((0, 0, 1)).rotation_difference(Vector(direction)).to_matrix()
        color = chosen.force_color
        lines.append((figures.contact, neck, color, SHAFT_PIXELS * view.scale))
        parts.append(lit(CONE, neck, size, color, view.axes, np.array(turn)))


def arrow_tip(figures: Reading, pixel: float) -> tuple[Array, Array]:
    """Tip and unit direction of a force's arrow, world; ``pixel`` is a pixel's length."""
    direction = figures.force_vector / np.linalg.norm(figures.force_vector)
    share = figures.force / (figures.force + HALF_LENGTH_FORCE)
    length = HEAD_LENGTH + preferences().arrow_pixels * share
    return figures.contact + length * pixel * direction, direction


def _draw_patches(patches: list[Patch], top: float, view: View) -> None:
    """Draw patches, faintly also through the drawn surface where they face the viewer."""
    for patch in patches:
        film = contact_film(patch, top, PATCH_LIFT * view.axes[2])
        _draw([film], [], "NONE", PATCH_SEEN_THROUGH)
        _draw([film], [], "LESS_EQUAL", 1.0, both_sides=True)


def _tool(session: PressSession, tool: Tool, figures: Reading, view: View) -> Lit:
    units = 1.0 / session.drawn.frame.metres_per_unit
    color = preferences().probe_color
    return glass(_shape_of(tool), figures.probe, units, color, view.axes, figures.turn)


@lru_cache(maxsize=2)
def _shape_of(tool: Tool) -> Shape:
    return tool_shape(tool)


def _draw(
    parts: list[Lit],
    lines: list[Line],
    depth_test: str,
    opacity: float,
    *,
    both_sides: bool = False,
) -> None:
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set(depth_test)
    gpu.state.face_culling_set("NONE" if both_sides else "BACK")
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


def draw_hud() -> None:
    """Draw the HUD in pixels, on top of everything, in the view where it is pressed."""
    session, view = press_session.current(), _view()
    if session is None or view is None or not regions.is_main(bpy.context, session.area):
        return
    if session.snapshot is None:
        hud.draw(bpy.context, session, np.zeros((0, 2)), None)
        return
    shown = [one for one in readings(session) if _worth_drawing(session, one)]
    top = None
    if any(one.patch for one in shown) and session.scene.palpate.show_pressure:
        top = _pressure_scale(session, shown)
    drawn = hud.draw(bpy.context, session, _looked_at(session, shown, view), top)
    labels.draw(_labels(session, shown, view, figured=not drawn), view.region, view.scale)


def _looked_at(session: PressSession, shown: list[Reading], view: View) -> Array:
    """Pixels (n, 2) of the body and of all that is drawn of its fingers."""
    tool, metres = session.tip.tool, session.drawn.frame.metres_per_unit
    nodes = session.seen.nodes()[session.drawn.body.mesh.surface_nodes]
    places = [frame.world_from_body(nodes) for frame in dict.fromkeys(session.frames)]
    for figures in shown:
        around = np.zeros((1, 3)) if tool is None else _shape_of(tool).vertices
        places.append(figures.probe + around @ figures.turn.T / metres)
        if figures.force > 0.0:
            places.append(arrow_tip(figures, view.pixel_at(figures.contact))[0][None])
    return view.seen_all(np.concatenate(places))


def _labels(
    session: PressSession, shown: list[Reading], view: View, *, figured: bool
) -> list[Label]:
    """Numbers of several fingers, and ``figured`` the force at each arrow."""
    labels = []
    for number, figures in enumerate(shown, start=1):
        name = f"{number}  " if len(session.leads) > 1 else ""
        if figures.force > 0.0 and (name or figured):
            tip, _ = arrow_tip(figures, view.pixel_at(figures.contact))
            labels.append(Label(f"{name}{newtons(figures.force)}", view.seen(tip)))
        elif name:
            labels.append(Label(name.strip(), view.seen(figures.probe)))
    return labels


_handles: list[object] = []


def register() -> None:
    """Add the drawing to all 3D views."""
    if bpy.app.background:
        # No views in background mode.
        return
    add = bpy.types.SpaceView3D.draw_handler_add
    _handles.append(add(draw_in_view, (), "WINDOW", "POST_VIEW"))
    _handles.append(add(draw_hud, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    """Stop drawing."""
    while _handles:
        bpy.types.SpaceView3D.draw_handler_remove(_handles.pop(), "WINDOW")
