"""Regions of a 3D view: where the HUD is drawn, and what of it is free."""

from __future__ import annotations

import bpy

from .free_corner import Room

# Blender's own text in the upper left, and the buttons in the upper right, unscaled pixels.
TEXT_HEIGHT, STATISTICS_HEIGHT, BUTTONS_WIDTH = 50, 110, 50
MARGIN = 12


def is_main(context: bpy.types.Context, area: int) -> bool:
    """Whether the region being drawn is the one for figures: the largest of the area of this
    address, or of the largest 3D view where there is none such.
    """
    views = [
        view
        for window in context.window_manager.windows
        for view in window.screen.areas
        if view.type == "VIEW_3D"
    ]
    chosen = next((view for view in views if view.as_pointer() == area), None)
    chosen = chosen or max(views, key=lambda view: view.width * view.height)
    windows = [region for region in chosen.regions if region.type == "WINDOW"]
    largest = max(windows, key=lambda region: region.width * region.height)
    return bool(largest == context.region)


def room(context: bpy.types.Context) -> Room:
    """Part of the region being drawn that no other region and none of Blender's text covers."""
    scale, space, region = context.preferences.system.ui_scale, context.space_data, context.region
    margin = MARGIN * scale
    above = covered(context, "HEADER", "TOP") + covered(context, "TOOL_HEADER", "TOP")
    if space.overlay.show_overlays and space.overlay.show_stats:
        above += STATISTICS_HEIGHT * scale
    elif space.overlay.show_overlays and space.overlay.show_text:
        above += TEXT_HEIGHT * scale
    beside = BUTTONS_WIDTH * scale if space.show_gizmo_navigate else 0.0
    below = covered(context, "ASSET_SHELF", "BOTTOM") + covered(context, "HEADER", "BOTTOM")
    return Room(
        left=covered(context, "TOOLS", "LEFT") + covered(context, "UI", "LEFT") + margin,
        bottom=below + margin,
        right=region.width
        - covered(context, "UI", "RIGHT")
        - covered(context, "TOOLS", "RIGHT")
        - beside
        - margin,
        top=region.height - above - margin,
    )


def covered(context: bpy.types.Context, kind: str, side: str) -> float:
    """Pixels of the view covered by regions of this kind at one of its sides."""
    overlap = context.preferences.system.use_region_overlap
    across = "width" if side in {"LEFT", "RIGHT"} else "height"
    return sum(
        getattr(region, across)
        for region in context.area.regions
        if overlap
        and region.type == kind
        and region.width > 1
        and region.height > 1
        and region.alignment == side
    )
