"""Bodies beside rigid tools: held by Newton's first law and the tools' own distance."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.contact.single_press import press_tool, press_tools, touch_nearest
from palpate.core.contact.tool.pose import Pose, facing
from palpate.core.contact.tool.tools import plate, rod, sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.felt import loads_of
from palpate.core.shape.rotation_strain.firmness import FirmBody
from palpate.core.shape.rotation_strain.kept_out import PLACES, kept_out
from palpate.core.shape.rotation_strain.relaxation import relaxation
from palpate.core.shape.solid.free_solid import FreeSolid

UP = np.array([0.0, 0.0, 1.0])
DEPTH = 0.008
TURN = facing(UP, np.eye(3)[0])
TOOLS = {
    "ball": (sphere(0.012), [0.025, 0.025, 0.062 - DEPTH]),
    "rod": (rod(0.01, 0.02), [0.025, 0.025, 0.06 - DEPTH]),
    "wall": (plate(0.1, 0.1), [0.025, 0.025, 0.05 - DEPTH]),
}


@pytest.fixture(scope="module")
def firm():
    mesh, fixed = paper_cube(cells=6)
    body = baked_body(mesh, fixed, 0.45, 1.0, "smoothed")
    solid = FreeSolid.of(body)
    return FirmBody(body, solid, relaxation(solid))


def drawn_places(body, solid, moved):
    """Three of each triangle, (t, 3, 3), where they are."""
    nodes = body.mesh.nodes.copy()
    nodes[solid.free] += moved
    return np.einsum("pa,tai->tpi", PLACES, nodes[body.mesh.surface_triangles])


def depth_within(tool, pose, places):
    distance, _ = tool.distance((places.reshape(-1, 3) - pose.position) @ pose.rotation)
    return -float(distance.min())


@pytest.mark.parametrize("name", TOOLS)
def test_what_is_drawn_is_beside_the_tool_and_at_rest(firm, name):
    tool, position = TOOLS[name]
    pose = Pose.at(position, np.eye(3) if name == "ball" else TURN)
    touch = press_tool(firm.body, tool, pose)
    moved = firm.pressed(loads_of([touch])).displacements
    places = drawn_places(firm.body, firm.solid, moved)
    # Nothing within it, where the forces in proportion leave a tenth of the depth and more.
    assert depth_within(tool, pose, places) < 0.01 * DEPTH
    # What holds the body: forces at the tool alone, which press and do not pull.
    forces = firm.solid.forces(moved)
    top = firm.solid.positions[:, 2] > 0.0499
    largest = np.abs(forces).max()
    assert np.abs(forces[~top]).max() < 0.01 * largest
    assert forces[top][:, 2].max() < 0.01 * largest
    distance, _ = tool.distance((firm.solid.positions + moved - pose.position) @ pose.rotation)
    assert np.abs(forces[distance > 0.01]).max(initial=0.0) < 0.01 * largest


def test_only_tools_that_slide_keep_a_body_out(firm):
    point = touch_nearest(firm.body, (0.025, 0.025, 0.05), (0.0, 0.0, -0.002))
    none = np.zeros((firm.solid.node_count, 3))
    loads = loads_of([point])
    assert loads[0].by is None
    assert kept_out(firm.body, firm.solid, firm.relaxation, loads, none) is None
    assert kept_out(firm.body, firm.solid, firm.relaxation, [], none) is None


def test_two_tools_keep_it_out_together(firm):
    tool = sphere(0.008)
    starts = [Pose.at([x, 0.025, 0.0585]) for x in (0.01, 0.04)]
    touches = press_tools(firm.body, tool, starts, [-0.005 * UP] * 2)
    moved = firm.pressed(loads_of(touches)).displacements
    places = drawn_places(firm.body, firm.solid, moved)
    for touch in touches:
        assert depth_within(tool, touch.pose, places) < 5e-5


def test_a_touch_finer_than_the_mesh_is_drawn_by_its_nodes(firm):
    """Where no place of a triangle is reached, there still is a dent."""
    tool, depth = sphere(0.012), 2e-5
    touch = press_tool(firm.body, tool, Pose.at([0.025, 0.025, 0.062 - depth]))
    moved = firm.pressed(loads_of([touch])).displacements
    assert moved[:, 2].min() < -0.3 * depth
