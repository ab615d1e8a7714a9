"""Bodies beside rigid tools: held by Newton's first law, by work and by the tools' own distance."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.body.imprinted_body import DrawnImprint, imprinted
from palpate.core.contact.single_press import press_tool, press_tools, touch_nearest
from palpate.core.contact.tool.pose import Pose, facing
from palpate.core.contact.tool.tools import plate, rod, sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.felt import loads_of
from palpate.core.shape.rotation_strain.beside.beside_tools import beside_tools
from palpate.core.shape.rotation_strain.beside.kept_out import CLOSE, STIFF, kept_out
from palpate.core.shape.rotation_strain.beside.reached import PLACES, Reached
from palpate.core.shape.rotation_strain.finger_load import on_free_nodes
from palpate.core.shape.rotation_strain.firmness import FirmBody
from palpate.core.shape.rotation_strain.relaxation import relaxation
from palpate.core.shape.solid.free_solid import FreeSolid

UP = np.array([0.0, 0.0, 1.0])
DEPTH = 0.008
CELLS = 8
TURN = facing(UP, np.eye(3)[0])
TOOLS = {
    "ball": (sphere(0.012), [0.025, 0.025, 0.062 - DEPTH]),
    "rod": (rod(0.01, 0.02), [0.025, 0.025, 0.06 - DEPTH]),
    "wall": (plate(0.1, 0.1), [0.025, 0.025, 0.05 - DEPTH]),
}


@pytest.fixture(scope="module")
def firm():
    mesh, fixed = paper_cube(cells=CELLS)
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
    loads = loads_of([point])
    assert loads[0].by is None
    assert Reached.of(firm.body, firm.solid, loads) is None
    assert Reached.of(firm.body, firm.solid, []) is None


def kept(firm, touches):
    loads = loads_of(touches)
    start = firm.solid.linear(on_free_nodes(firm.solid, loads))
    reached = Reached.of(firm.body, firm.solid, loads)
    return kept_out(firm.solid, firm.relaxation, reached, loads, start, start)


def test_two_tools_keep_it_out_together(firm):
    tool = sphere(0.008)
    starts = [Pose.at([x, 0.025, 0.0585]) for x in (0.01, 0.04)]
    touches = press_tools(firm.body, tool, starts, [-0.005 * UP] * 2)
    moved = kept(firm, touches).displacements
    places = drawn_places(firm.body, firm.solid, moved)
    for touch in touches:
        assert depth_within(tool, touch.pose, places) < 5e-5


def test_a_touch_finer_than_the_mesh_is_drawn_by_its_nodes(firm):
    """Where no place of a triangle is reached, there still is a dent."""
    tool, depth = sphere(0.012), 2e-5
    touch = press_tool(firm.body, tool, Pose.at([0.025, 0.025, 0.062 - depth]))
    moved = firm.pressed(loads_of([touch])).displacements
    assert moved[:, 2].min() < -0.3 * depth


def beside(firm, touch):
    found = beside_tools(firm.body, firm.solid, firm.relaxation, loads_of([touch]), 1.0)
    assert found is not None
    return found


def test_the_work_of_the_tool_is_what_the_body_holds(firm):
    """Force over the way, summed, beside the energy of the solid, which knows of no contact."""
    depths = np.linspace(0.0, DEPTH, 17)
    forces, moved = [0.0], None
    for depth in depths[1:]:
        touch = press_tool(firm.body, sphere(0.012), Pose.at([0.025, 0.025, 0.062 - depth]))
        found = kept(firm, [touch])
        forces.append(-found.forces[0, 2])
        moved = found.displacements
    assert np.trapezoid(forces, depths) == pytest.approx(firm.solid.energy(moved), rel=0.02)


@pytest.mark.parametrize("name", TOOLS)
def test_on_stiff_springs_it_rests_as_where_pushes_are_counted_in(firm, name):
    tool, position = TOOLS[name]
    pose = Pose.at(position, np.eye(3) if name == "ball" else TURN)
    loads = loads_of([press_tool(firm.body, tool, pose)])
    start = firm.solid.linear(on_free_nodes(firm.solid, loads))
    reached = Reached.of(firm.body, firm.solid, loads)
    counted, sprung = (
        kept_out(firm.solid, firm.relaxation, one, loads, start, start)
        for one in (reached, reached.on_springs(STIFF))
    )
    assert sprung.left <= CLOSE
    assert sprung.forces[0, 2] == pytest.approx(counted.forces[0, 2], rel=0.02)
    off = np.abs(sprung.displacements - counted.displacements).max()
    assert off < 0.02 * DEPTH


@pytest.mark.parametrize("name", TOOLS)
def test_the_surface_lies_against_the_tool_everywhere(firm, name):
    """At random places of it, not those that the contact looks at."""
    tool, position = TOOLS[name]
    pose = Pose.at(position, np.eye(3) if name == "ball" else TURN)
    moved = beside(firm, press_tool(firm.body, tool, pose)).kept.displacements
    nodes = firm.body.mesh.nodes.copy()
    nodes[firm.solid.free] += moved
    shares = np.random.default_rng(18).dirichlet([1.0, 1.0, 1.0], 40)
    triangles = firm.body.mesh.surface_triangles
    places = np.einsum("pa,tai->tpi", shares, nodes[triangles]).reshape(-1, 3)
    distance, _ = tool.distance(pose.to_tool(places))
    # A flat triangle between places on what is round goes through it by its edge's square over 8
    # radii.
    edge = 0.05 / CELLS
    sag = edge**2 / (8.0 * tool.radius) if name != "wall" else 0.0
    assert -distance.min() < 0.02 * DEPTH + sag
    touches = distance < 0.02 * DEPTH + sag
    assert abs(distance[touches].mean()) < 0.01 * DEPTH + 0.5 * sag


def test_an_imprint_is_pressed_as_deep_as_the_tool_is_in_it(firm):
    """A top that lies 3 mm lower, and a tool that is so much lower, are the same press."""
    lower = 0.003
    mesh = firm.body.mesh
    moved = np.where(mesh.nodes[:, 2:] > 0.0499, [0.0, 0.0, -lower], 0.0)
    dented = imprinted(firm.body, DrawnImprint(mesh.nodes, mesh.surface_triangles, moved))
    tool, position = sphere(0.012), np.array([0.025, 0.025, 0.062 - DEPTH])
    before = beside(firm, press_tool(firm.body, tool, Pose.at(position)))
    after = beside(firm, press_tool(dented, tool, Pose.at(position - lower * UP)))
    assert after.share == pytest.approx(before.share, rel=1e-3)
    np.testing.assert_allclose(
        after.kept.displacements, before.kept.displacements, atol=0.002 * DEPTH
    )


def test_firmness_begins_with_that_of_the_linear_body(firm):
    """Though triangles are too coarse for a shallow touch, it is no less firm for that."""
    shares = []
    for depth in (0.0005, 0.001, 0.002, 0.004):
        pose = Pose.at([0.025, 0.025, 0.05 - depth], TURN)
        shares.append(beside(firm, press_tool(firm.body, plate(0.1, 0.1), pose)).share)
    # Rubber's at a hundredth of the height is that of the law, 1 + 3/2 of the strain.
    assert shares[0] == pytest.approx(1.0, abs=0.025)
    assert np.all(np.diff(shares) > 0.0)


@pytest.mark.parametrize("aside", [(0.001, 0.002), (0.0035, 0.0015), (0.0045, 0.004)])
def test_a_light_touch_of_few_triangles_is_as_firm_as_on_the_linear_body(firm, aside):
    """Wherever its places lie in them."""
    place = np.array([0.025 + aside[0], 0.025 + aside[1], 0.05])
    for depth in (0.0003, 0.0006):
        touch = press_tool(firm.body, sphere(0.008), Pose.at(place + (0.008 - depth) * UP))
        assert firm.pressed(loads_of([touch])).firmness.deepest == pytest.approx(1.0, abs=0.02)


def test_light_touches_of_two_tools_are_as_firm_together(firm):
    """Though the places of one tell more of its force than those of the other."""
    starts = [Pose.at([x, y, 0.0585]) for x, y in ((0.0128, 0.0131), (0.0407, 0.0395))]
    touches = press_tools(firm.body, sphere(0.008), starts, [-0.0013 * UP] * 2)
    assert firm.pressed(loads_of(touches)).firmness.deepest == pytest.approx(1.0, abs=0.02)


def test_among_coarse_triangles_a_dent_is_deepest_where_it_is_pressed():
    """Where three places of a triangle are farther apart than a touch is wide."""
    mesh, fixed = paper_cube(cells=3)
    body = baked_body(mesh, fixed, 0.45, 1.0, "smoothed")
    solid = FreeSolid.of(body)
    coarse = FirmBody(body, solid, relaxation(solid))
    for place in (np.array([0.0275, 0.03, 0.05]), np.array([0.019, 0.0315, 0.05])):
        pose = Pose.at(place + (0.006 - 0.003) * UP)
        loads = loads_of([press_tool(body, sphere(0.006), pose)])
        assert beside_tools(body, solid, coarse.relaxation, loads, 1.0) is None
        moved = coarse.pressed(loads).displacements
        deepest = solid.positions[np.argmin(moved[:, 2])]
        assert np.linalg.norm(deepest - place) < 0.75 * 0.05 / 3
