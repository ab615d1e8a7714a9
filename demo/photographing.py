"""Pictures of the scene by its camera, and pixels of world points."""

from pathlib import Path

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector


def photograph(path: Path, percent: int = 100) -> Path:
    """Render the scene to a PNG at a share of its own size."""
    scene = bpy.context.scene
    scene.render.resolution_percentage = percent
    scene.render.filepath = str(path)
    # Else the picture tells where on this machine the scene lies.
    scene.render.use_stamp_filename = False
    bpy.ops.render.render(write_still=True)
    return path


def pixel(point: list[float]) -> tuple[float, float]:
    """Position of a world point in the picture, as shares of width and height from top left."""
    scene = bpy.context.scene
    x, y, _ = world_to_camera_view(scene, scene.camera, Vector(point))
    return x, 1.0 - y
