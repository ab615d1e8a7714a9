"""A fingertip of 14 mm on the middle of a cube of 50 mm, whose mesh may be moved within it."""

from __future__ import annotations

import numpy as np

from palpate.core.contact.near_field.compliance_beneath import near_correction
from palpate.core.contact.near_field.contact_points import contact_points
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh

from .baked_body import baked_body

EDGE, RADIUS = 0.05, 0.014
YOUNG_MODULUS, POISSON_RATIO = 10_000.0, 0.3
DEPTHS = (0.0007, 0.0014, 0.002)
FINE_SPACING = 0.0015

# By how much the mesh is moved at the middle of the top, metres.
MOVED = (
    (0.0, 0.0),
    (0.001, 0.0005),
    (0.002, 0.0),
    (0.0015, 0.0025),
    (-0.003, 0.001),
    (0.004, 0.0),
    (-0.0025, -0.003),
)


def pressed(cells: int, *, fine: bool, moved: tuple[float, float] = (0.0, 0.0)) -> list[float]:
    """Palpate's forces on the sphere, newton, for a cube of so many cells.

    The mesh is ``moved`` so far at the middle of the top, metres, less and less towards the sides.
    """
    even, fixed = paper_cube(EDGE, cells)
    nodes = even.nodes.copy()
    for axis, way in enumerate(moved):
        nodes[:, axis] += 4 * way * nodes[:, axis] * (EDGE - nodes[:, axis]) / EDGE**2
    mesh = TetMesh.checked(nodes, even.tets)
    body = baked_body(mesh, fixed, POISSON_RATIO, YOUNG_MODULUS)
    spread = None
    if fine:
        every = contact_points(body, FINE_SPACING)
        middle = np.array([EDGE / 2, EDGE / 2, EDGE])
        surface = every.taken(np.linalg.norm(every.positions - middle, axis=1) < RADIUS)
        spread = surface, near_correction(body, surface)
    forces = []
    for depth in DEPTHS:
        pose = Pose.at([EDGE / 2, EDGE / 2, EDGE + RADIUS - depth])
        touch = press_tool(body, sphere(RADIUS), pose, spread=spread)
        forces.append(float(touch.force[2]))
    return forces
