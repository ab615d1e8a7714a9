"""Seconds that Blender takes to write all coordinates of a shape key, printed as JSON.

    python shape_key_write.py VERTICES REPEATS          (a Python that has bpy)

As the extension does while somebody presses: one flat float32 array for the key's points, then the
mesh's update. Drawing itself is not part of it.
"""

from __future__ import annotations

import json
import sys
import time

import bpy
import numpy as np


def main(vertices: int, repeats: int) -> None:
    """Write two shapes in turn."""
    rng = np.random.default_rng(1)
    side = int(np.ceil(np.sqrt(vertices)))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=side - 1, y_subdivisions=side - 1)
    thing = bpy.context.object
    mesh = thing.data
    count = len(mesh.vertices)
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Pressed")
    shapes = [rng.normal(size=3 * count).astype(np.float32) for _ in range(2)]
    seconds = []
    for number in range(repeats):
        start = time.perf_counter()
        key.points.foreach_set("co", shapes[number % 2])
        mesh.update()
        seconds.append(time.perf_counter() - start)
    print(json.dumps({"vertices": count, "seconds": float(np.median(seconds))}))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
