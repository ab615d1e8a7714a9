"""A tool as the native engine takes it."""

from palpate_servo import Tool as NativeTool
from palpate_servo import ToolSurface

from palpate.core.contact.tool.tool_surface import surface_and_correction


def native_tip(body, native, tool):
    """Its contact points on a body, of which ``native`` is the native form, and its shape."""
    points, correction = surface_and_correction(body, tool)
    arrays = [points.positions, points.normals, points.triangles, points.alphas, points.areas]
    surface = ToolSurface(native, *arrays, correction.arrays())
    return surface, NativeTool(tool.core, tool.radius)
