"""3D view under the pointer: its line of sight, and its scale at a place."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np
from bpy_extras import view3d_utils
from mathutils import Vector
from numpy.typing import NDArray

from .body_frame import BodyFrame
from .probe_drag import View

Array = NDArray[np.float64]

# Blender's navigation gizmos in the corner, in unscaled pixels: the ball and its margin, then a
# column of round buttons, each with its spacing.
BALL_MARGIN, BUTTON_SIZE, BUTTON_SPACING = 10.0, 28.0, 30.0
BUTTONS, BELOW_BALL, FROM_CORNER = 4, 2.1, 0.75
# Without the ball there are small axes: their size in units of the interface, and twice their own.
SMALL_AXES_UNITS, UNIT = 2.5, 20.0
DEFAULT_BALL_SIZE = 80


@dataclass(frozen=True, eq=False)
class Viewport:
    """Window region of a 3D view and a pointer in it, in pixels of the region."""

    area: bpy.types.Area
    region: bpy.types.Region
    cursor: tuple[float, float]

    @property
    def region_3d(self) -> bpy.types.RegionView3D:
        """Projection of the view."""
        return self.region.data

    def ray(self, frame: BodyFrame) -> tuple[Array, Array]:
        """Line of sight through the pointer in body coordinates: origin and unit direction (3,)."""
        origin, along = self.line_of_sight()
        direction = frame.turn_to_body(along)
        return frame.body_from_world(origin), direction / np.linalg.norm(direction)

    def line_of_sight(self) -> tuple[Array, Array]:
        """Line of sight through the pointer, world coordinates: origin and direction (3,)."""
        origin = view3d_utils.region_2d_to_origin_3d(self.region, self.region_3d, self.cursor)
        along = view3d_utils.region_2d_to_vector_3d(self.region, self.region_3d, self.cursor)
        return np.array(origin), np.array(along)

    def view_at(self, point: Array, frame: BodyFrame) -> View | None:
        """Screen axes and scale at ``point`` (body coordinates); None behind the viewer."""
        axes = np.array(self.region_3d.view_matrix)[:3, :3]
        right, up = frame.turn_to_body(axes[0]), frame.turn_to_body(axes[1])
        here = Vector(frame.world_from_body(point))
        step = self.region_3d.view_distance * 0.01
        aside = here + step * Vector(axes[0])
        ends = [
            view3d_utils.location_3d_to_region_2d(self.region, self.region_3d, place)
            for place in (here, aside)
        ]
        if None in ends or (ends[1] - ends[0]).length == 0.0:
            return None
        metres = step * frame.metres_per_unit / (ends[1] - ends[0]).length
        return View(right, up, metres)

    def over_gizmos(self) -> bool:
        """Whether the pointer is on a navigation gizmo of the view, which must keep working."""
        return any(
            np.hypot(*np.subtract(self.cursor, middle)) <= radius
            for middle, radius in self.gizmos()
        )

    def gizmos(self) -> list[tuple[tuple[float, float], float]]:
        """Middles and radii of the navigation gizmos, pixels of the region."""
        if not self.area.spaces.active.show_gizmo_navigate:
            return []
        preferences = bpy.context.preferences
        view, scale = preferences.view, preferences.system.ui_scale
        ball = 0.5 * getattr(view, "gizmo_size_navigate_view", DEFAULT_BALL_SIZE) * scale
        right = self.region.width - self._covered("UI")
        top = self.region.height - self._covered("HEADER") - self._covered("TOOL_HEADER")
        offset, spacing = ball + BALL_MARGIN * scale, BUTTON_SPACING * scale
        found, below = [], FROM_CORNER * spacing
        if view.mini_axis_type == "GIZMO":
            found.append(((right - offset, top - offset), ball))
            below = BELOW_BALL * offset
        elif view.mini_axis_type == "MINIMAL":
            axes = 2.0 * view.mini_axis_size * preferences.system.pixel_size
            below = SMALL_AXES_UNITS * UNIT * scale + axes
        if view.show_navigate_ui:
            # Of a camera's view there is one more, which locks it.
            count = BUTTONS + (self.region_3d.view_perspective == "CAMERA")
            found += [
                (
                    (right - FROM_CORNER * spacing, top - below - slot * spacing),
                    0.5 * BUTTON_SIZE * scale,
                )
                for slot in range(count)
            ]
        return found

    def _covered(self, kind: str) -> int:
        """Pixels of the window region covered by another region of this kind."""
        across = "width" if kind == "UI" else "height"
        return sum(
            getattr(r, across)
            for r in self.area.regions
            if r.type == kind and _overlaps(r, self.region)
        )


def under_pointer(window: bpy.types.Window, x: int, y: int) -> Viewport | None:
    """3D view at window coordinates, unless another region covers it there."""
    for area in window.screen.areas:
        if area.type != "VIEW_3D":
            continue
        here = [r for r in area.regions if _contains(r, x, y)]
        if any(r.type != "WINDOW" for r in here):
            return None
        for region in here:
            return Viewport(area, region, (x - region.x, y - region.y))
    return None


def over_file_browser(window: bpy.types.Window, event: bpy.types.Event) -> bool:
    """Whether an event belongs to a file browser in this window."""
    return any(
        area.type == "FILE_BROWSER" and _contains(area, event.mouse_x, event.mouse_y)
        for area in window.screen.areas
    )


def redraw_views() -> None:
    """Redraw all 3D views and their sidebars."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _contains(region: bpy.types.Region | bpy.types.Area, x: int, y: int) -> bool:
    # A closed region has a size of one pixel.
    return (
        region.width > 1
        and region.height > 1
        and region.x <= x < region.x + region.width
        and region.y <= y < region.y + region.height
    )


def _overlaps(region: bpy.types.Region, other: bpy.types.Region) -> bool:
    return (
        region.width > 1
        and region.height > 1
        and region.x < other.x + other.width
        and other.x < region.x + region.width
        and region.y < other.y + other.height
        and other.y < region.y + region.height
    )
