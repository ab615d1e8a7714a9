"""Touches about as wide as a triangle: what places tell of them, and what the near field adds."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.contact.single_press import press_tool, touch_nearest
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.felt import loads_of
from palpate.core.shape.rotation_strain.beside.beside_tools import beside_tools
from palpate.core.shape.rotation_strain.beside.reached import Reached
from palpate.core.shape.rotation_strain.finger_load import on_free_nodes
from palpate.core.shape.rotation_strain.firmness import FirmBody
from palpate.core.shape.rotation_strain.relaxation import relaxation
from palpate.core.shape.solid.free_solid import FreeSolid

EDGE = 0.05
# Aside of all nodes and edges, on the top.
PLACE = np.array([0.026, 0.0235, EDGE])
UP = np.array([0.0, 0.0, 1.0])
BALL = sphere(0.012)


def firm_cube(cells, law="rubber"):
    body = replace(baked_body(*paper_cube(EDGE, cells), 0.45, 1.0, "smoothed"), law=law)
    solid = FreeSolid.of(body)
    return FirmBody(body, solid, relaxation(solid))


@pytest.fixture(scope="module")
def coarse():
    return firm_cube(6)


@pytest.fixture(scope="module")
def fine():
    return firm_cube(12)


def pressed(firm, depth, tool=BALL, place=PLACE):
    pose = Pose.at(place + (tool.radius - depth) * UP)
    return loads_of([press_tool(firm.body, tool, pose)])


def reached(firm, loads):
    moved = firm.solid.linear(on_free_nodes(firm.solid, loads))
    return Reached.of(firm.body, firm.solid, loads), moved


def beds(firm, loads):
    places, moved = reached(firm, loads)
    whole = np.array([load.forces.sum(axis=0) for load in loads])
    return places, places.on_bed(moved, whole, 1.0), moved, whole[0]


def test_a_linear_body_presses_back_at_its_places_as_in_its_contact(coarse):
    """Once the near field is beneath them as a bed, and not otherwise."""
    places, bed, moved, whole = beds(coarse, pressed(coarse, 0.003))
    force, bare = (one.of_tools(one.pushes(moved))[0] for one in (bed, places))
    assert force @ whole == pytest.approx(whole @ whole, rel=0.06)
    assert bare @ whole > 1.04 * (whole @ whole)


def test_its_bed_carries_the_linear_force_where_the_surface_is_in_the_tool(coarse):
    _, bed, moved, whole = beds(coarse, pressed(coarse, 0.003))
    distance, _ = bed.distances(bed.moved(moved))
    carried = bed.firmness @ np.maximum(-distance, 0.0)
    assert carried == pytest.approx(np.linalg.norm(whole), rel=1e-12)


def test_its_pushes_are_those_of_a_contact(coarse):
    """Nothing is pulled, nothing is within, and what pushes touches: Signorini's conditions."""
    loads = pressed(coarse, 0.006)
    places, moved = reached(coarse, loads)
    pushes = places.pushes(moved)
    _, out = places.distances(places.moved(moved))
    sizes = np.einsum("pi,pi->p", pushes, out)
    assert sizes.min() >= 0.0
    forces = np.zeros((coarse.solid.node_count, 3))
    for corner in range(3):
        np.add.at(forces, places.free[:, corner], places.shares[:, [corner]] * pushes)
    there = places.moved(coarse.solid.linear(forces))
    before = places.moved(moved)
    # The tool's surface as the plane that is nearest to each place in the linear contact.
    gaps = places.distances(before)[0] + np.einsum("pi,pi->p", out, there - before)
    gaps += sizes / places.firmness
    depth = np.abs(places.distances(places.rests)[0]).max()
    assert gaps.min() > -1e-4 * depth
    assert np.abs(gaps[sizes > 0.0]).max() < 1e-4 * depth


@pytest.mark.parametrize("depth", [0.003, 0.006, 0.009])
def test_a_coarse_mesh_presses_back_as_one_twice_as_fine(coarse, fine, depth):
    """Where its own rubber, without the near field, is 9 % firmer, and linear 10 % softer."""
    forces = []
    for firm in (coarse, fine):
        loads = pressed(firm, depth)
        linear = float(np.linalg.norm(loads[0].forces.sum(axis=0)))
        forces.append(linear * firm.pressed(loads).firmness.deepest)
    assert forces[0] == pytest.approx(forces[1], rel=0.06)


def test_a_touch_that_places_miss_is_not_told_by_them():
    """A ball of a third of an edge between the places of triangles of 17 mm."""
    firm = firm_cube(3)
    loads = pressed(firm, 0.003, sphere(0.006), np.array([0.0275, 0.03, EDGE]))
    _, bed, moved, whole = beds(firm, loads)
    assert bed.of_tools(bed.pushes(moved))[0] @ whole < 0.5 * (whole @ whole)
    assert beside_tools(firm.body, firm.solid, firm.relaxation, loads, 1.0) is None


@pytest.mark.parametrize("place", [PLACE, np.array([0.0275, 0.03, EDGE])], ids=["node", "edge"])
def test_a_ball_no_wider_than_a_triangle_does_not_go_through_it(place):
    """The deeper the firmer; on its places alone it is at last a third as firm."""
    firm, ball = firm_cube(4), sphere(0.008)
    felt = []
    for depth in ball.radius * np.linspace(0.3, 1.3, 11):
        loads = pressed(firm, depth, ball, place)
        linear = np.linalg.norm(loads[0].forces.sum(axis=0))
        felt.append((linear, linear * firm.pressed(loads).firmness.deepest))
    linear, forces = np.array(felt).T
    assert np.diff(forces).min() > 0.5 * np.diff(linear).min() > 0.0
    assert (forces / linear).min() > 0.92


def test_what_is_felt_grows_without_a_jump(coarse):
    """From a touch that is hardly wider than a triangle to one that is."""
    shares = [
        coarse.pressed(pressed(coarse, depth)).firmness.deepest
        for depth in np.linspace(0.001, 0.01, 28)
    ]
    assert np.abs(np.diff(shares)).max() < 0.04


# Times as deep as a press is the one that is looked for on the way, and the depths of presses.
AHEAD, WAY = 1.25, np.array([0.0004, 0.0008, 0.0016, 0.0024, 0.0036, 0.0052, 0.0072])


def with_a_point(firm, depth):
    return loads_of([touch_nearest(firm.body, PLACE, -depth * UP)])


@pytest.mark.parametrize("press", [with_a_point, pressed], ids=["point", "ball"])
@pytest.mark.parametrize("law", ["rubber", "foam"])
def test_on_the_way_in_it_is_as_firm_as_a_press_that_is_looked_at_by_itself(press, law):
    firm = firm_cube(6, law)
    before = None
    for depth in WAY:
        found = firm.pressed(press(firm, depth), AHEAD, before)
        alone = firm.pressed(press(firm, AHEAD * depth))
        assert found.firmness.deepest == pytest.approx(alone.firmness.deepest, rel=0.02)
        before = found.found


def test_a_press_much_deeper_than_the_last_does_not_go_on_from_there(coarse):
    before = coarse.pressed(pressed(coarse, 0.0002), AHEAD).found
    assert before.taken_to(before.curve.reach) is not None
    deep = pressed(coarse, 0.006)
    anew, found = (coarse.pressed(deep, AHEAD, one) for one in (None, before))
    assert found.firmness == anew.firmness
