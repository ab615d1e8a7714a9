"""PLY of a body's surface with its stiffness as colours and numbers."""

from __future__ import annotations

from typing import IO

import numpy as np
from plyfile import PlyData, PlyElement

from ..body.soft_body import SoftBody
from .ramp import ramp
from .softness_map import SoftnessMap


def write_ply(file: IO[bytes], body: SoftBody, found: SoftnessMap) -> None:
    """Write vertices with red, green, blue and ``stiffness`` in N/m, and triangles, in metres."""
    places = body.mesh.nodes[body.mesh.surface_nodes]
    colours = np.round(255.0 * ramp(found.shares())).astype(np.uint8)
    names = ["x", "y", "z", "red", "green", "blue", "stiffness"]
    kinds = ["f4", "f4", "f4", "u1", "u1", "u1", "f4"]
    vertices = np.empty(len(places), dtype=list(zip(names, kinds, strict=True)))
    for name, column in zip(names, [*places.T, *colours.T, found.stiffness], strict=True):
        vertices[name] = column
    triangles = body.mesh.surface_local_triangles
    faces = np.empty(len(triangles), dtype=[("vertex_indices", "i4", (3,))])
    faces["vertex_indices"] = triangles
    low, high = found.span
    comment = f"stiffness in N/m; colours on a scale of ratios from {low:.6g} to {high:.6g}"
    elements = [PlyElement.describe(vertices, "vertex"), PlyElement.describe(faces, "face")]
    PlyData(elements, comments=[comment]).write(file)
