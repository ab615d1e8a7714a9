"""Picture of a sample scene by its own camera, as it opens.

Run as BLENDER_PYTHON picture_scene.py SCENE.blend PICTURE.png, where BLENDER_PYTHON has the bpy
module. Palpate is not needed.
"""

import sys
from pathlib import Path

import bpy
from photographing import photograph

WIDTH, HEIGHT, SAMPLES = 720, 480, 24


def main() -> int:
    """Open and render."""
    scene, picture = (Path(path).resolve() for path in sys.argv[1:3])
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.wm.open_mainfile(filepath=str(scene))
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = WIDTH, HEIGHT
    render.engine = "CYCLES"
    bpy.context.scene.cycles.samples = SAMPLES
    photograph(picture)
    return 0


if __name__ == "__main__":
    sys.exit(main())
