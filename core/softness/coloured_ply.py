"""PLY of a body's surface with its stiffness as colours and numbers."""

from __future__ import annotations

from typing import IO

import numpy as np

from ..body.soft_body import SoftBody
from .ramp import ramp
from .softness_map import SoftnessMap

VERTEX = np.dtype(
    [
        *((axis, "<f4") for axis in "xyz"),
        *((name, "u1") for name in ("red", "green", "blue")),
        ("stiffness", "<f4"),
    ]
)
FACE = np.dtype([("count", "u1"), ("vertex_indices", "<i4", (3,))])
HEAD = """ply
format binary_little_endian 1.0
comment stiffness in N/m; colours on a scale of ratios from {low:.6g} to {high:.6g}
element vertex {vertices}
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
property float stiffness
element face {faces}
property list uchar int vertex_indices
end_header
"""


def write_ply(file: IO[bytes], body: SoftBody, found: SoftnessMap) -> None:
    """Write vertices with red, green, blue and ``stiffness`` in N/m, and triangles, in metres."""
    places = body.mesh.nodes[body.mesh.surface_nodes]
    colours = np.round(255.0 * ramp(found.shares())).astype(np.uint8)
    vertices = np.empty(len(places), dtype=VERTEX)
    columns = [*places.T, *colours.T, found.stiffness]
    for name, column in zip(VERTEX.names or (), columns, strict=True):
        vertices[name] = column
    triangles = body.mesh.surface_local_triangles
    faces = np.empty(len(triangles), dtype=FACE)
    faces["count"], faces["vertex_indices"] = 3, triangles
    low, high = found.span
    head = HEAD.format(low=low, high=high, vertices=len(vertices), faces=len(faces))
    file.write(head.encode("ascii") + vertices.tobytes() + faces.tobytes())
