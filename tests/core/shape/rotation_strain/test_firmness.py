"""Firmness of presses: what a body of its law needs to be pressed as deep as a linear one."""

import math
from dataclasses import replace

import numpy as np
import pytest
from bodies.bare_body import bare_body, beam_mesh

from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.rotation_strain import firmness
from palpate.core.shape.rotation_strain.finger_load import FingerLoad
from palpate.core.shape.rotation_strain.firmness import FirmBody
from palpate.core.shape.rotation_strain.pressed import FARTHER, Firmness, through
from palpate.core.shape.rotation_strain.relaxation import relaxation
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium

LENGTH = 5.0


def firm_body(mesh, fixed, poisson_ratio=0.45, formulation="smoothed"):
    body = bare_body(mesh, fixed, poisson_ratio, formulation)
    solid = FreeSolid.of(body)
    return FirmBody(body, solid, relaxation(solid))


@pytest.fixture(scope="module")
def bar():
    return firm_body(*beam_mesh(4, LENGTH, 0))


@pytest.fixture(scope="module")
def block():
    return firm_body(*paper_cube(1.0, 6))


def at_node(body, place, way):
    """Load of a point that holds the node nearest to ``place`` moved by ``way``, linearly."""
    node = np.linalg.norm(body.solid.positions - place, axis=1).argmin()
    columns = []
    for axis in np.eye(3):
        forces = np.zeros((body.solid.node_count, 3))
        forces[node] = axis
        columns.append(body.solid.linear(forces)[node])
    force = np.linalg.solve(np.stack(columns, axis=1), way)
    return node, FingerLoad(body.solid.free[[node]], force[None], sticks=True)


def spread(body, size):
    """Load of something broad on the middle of the top that goes in by ``size``."""
    away = np.linalg.norm(body.solid.positions - [0.5, 0.5, 1.0], axis=1)
    nodes = np.flatnonzero(away < 0.4)
    forces = np.tile([0.0, 0.0, -1.0], (len(nodes), 1))
    whole = body.solid.on_free_nodes(body.solid.free[nodes], forces)
    forces *= size / np.abs(body.solid.linear(whole)).max()
    return FingerLoad(body.solid.free[nodes], forces)


def energy_of(body, load):
    whole = body.solid.on_free_nodes(load.nodes, load.forces)
    return 0.5 * float((whole * body.solid.linear(whole)).sum())


@pytest.mark.parametrize(
    "way",
    [
        (0.0, 0.0, 1.2),
        *(
            pytest.param(way, marks=pytest.mark.at_length)
            for way in [(0.0, 0.0, 0.5), (-0.2, 0.3, 1.0)]
        ),
    ],
)
def test_a_point_that_bends_a_bar_feels_what_newtons_method_finds(bar, way):
    node, load = at_node(bar, [LENGTH, 0.5, 1.0], np.array(way))
    pressed = bar.pressed([load])
    moved, firmness = pressed.displacements, pressed.firmness
    assert firmness.is_whole
    assert np.linalg.norm(moved[node] - way) < 2e-3 * np.linalg.norm(way)
    # Newton's method under what holds that node there.
    forces = np.zeros_like(moved)
    forces[node] = bar.solid.forces(moved)[node]
    truth = equilibrium(bar.solid, forces).displacements
    assert np.linalg.norm(truth[node] - way) < 0.01 * np.linalg.norm(way)
    true = float(forces[node] @ way) / float(load.forces[0] @ way)
    assert firmness.deepest == pytest.approx(true, rel=0.01)
    assert abs(true - 1.0) > 0.01


def test_small_presses_are_linear_and_deep_ones_of_rubber_firmer(block):
    energies = []
    for size in (1e-4, 0.05, 0.25):
        load = spread(block, size)
        energies.append((block.pressed([load]).firmness.deepest, energy_of(block, load)))
    assert energies[0][0] == pytest.approx(1.0, abs=5e-3)
    assert 1.0 < energies[1][0] < energies[2][0] < 2.0
    assert energies[1][1] < energies[2][1]


def test_what_is_known_of_a_deep_press_tells_of_those_on_the_way(block):
    deep, half = (block.pressed([spread(block, size)]).firmness for size in (0.24, 0.12))
    assert deep.at(half.reach) == pytest.approx(half.deepest, abs=0.01)
    assert deep.at(0.0) == 1.0
    assert deep.at(math.inf) == deep.deepest


def test_several_fingers_have_one_firmness(block):
    load = spread(block, 0.15)
    parts = [
        FingerLoad(load.nodes[side], load.forces[side])
        for side in (slice(None, None, 2), slice(1, None, 2))
    ]
    whole, together = block.pressed([load]).firmness, block.pressed(parts).firmness
    assert together.deepest == pytest.approx(whole.deepest, abs=0.02)
    assert together.reach == pytest.approx(whole.reach, rel=1e-6)


def test_without_a_load_the_body_is_linear(block):
    none = FingerLoad(block.solid.free[:1], np.zeros((1, 3)))
    assert block.pressed([]).firmness == block.pressed([none]).firmness == Firmness()


def test_where_no_rest_is_found_it_says_so(block, monkeypatch):
    monkeypatch.setattr(firmness, "USUALLY", replace(firmness.USUALLY, steps=0))
    found = block.pressed([spread(block, 0.3)]).firmness
    assert not found.is_whole
    assert found.deepest == 1.0


def test_it_is_bounded():
    assert through([(1.0, -99.0), (4.0, 100.0)]).shares == (0.1, 30.0)


def test_it_is_straight_over_the_depth_and_goes_on_half_as_steeply():
    found = Firmness((1.0, 4.0), (1.2, 1.6))
    assert [found.at(energy) for energy in (0.0, 0.25, 2.25, 9.0)] == pytest.approx(
        [1, 1.1, 1.4, 1.6]
    )
    depths = np.linspace(0.0, 2.0, 4001)
    held = np.trapezoid([2.0 * s * found.at(s * s) for s in depths], depths)
    assert found.mean == pytest.approx(held / 4.0, rel=1e-6)
    further = found.going_on()
    assert further.at(4.0) == found.deepest
    force = [s * further.at(s * s) for s in (2.0, 2.0 * FARTHER[0])]
    linear = 2.0 * (FARTHER[0] - 1.0)
    assert (force[1] - force[0]) / linear == pytest.approx(1.6 + 0.5 * 0.4 * 2.0)
    assert Firmness().going_on() == Firmness()


def test_a_wall_presses_a_block_that_would_turn_aside_under_its_forces(block):
    """Where no force in proportion has a rest: rubber under plates by two fifths."""
    top = np.flatnonzero(block.solid.positions[:, 2] == 1.0)
    unit = []
    for axis in range(3):
        for node in top:
            forces = np.zeros((block.solid.node_count, 3))
            forces[node, axis] = 1.0
            unit.append(forces)
    down = np.stack(unit[2 * len(top) :])
    moved = np.stack([block.solid.linear(one)[top, 2] for one in down])
    forces = np.zeros((len(top), 3))
    forces[:, 2] = np.linalg.solve(moved, np.full(len(top), -0.4))
    firmness = block.pressed([FingerLoad(block.solid.free[top], forces)]).firmness
    assert firmness.is_whole
    # Neo-Hookean rubber under a smooth wall on a base that holds it.
    assert 1.45 < firmness.deepest < 1.75


def test_a_thin_part_does_not_swing_away_from_its_tool():
    """A plate pushed down and towards where it is held: under forces in proportion its end went
    nearly twice as far as that of a linear one. Where leading each node does no better, it counts
    as not found so deep.
    """
    cube, _ = paper_cube(1.0, 6)
    mesh = TetMesh.checked(cube.nodes * [2.0, 1.0, 0.3], cube.tets)
    plate = firm_body(mesh, np.flatnonzero(mesh.nodes[:, 0] == 0.0), 0.3)
    away = np.linalg.norm(plate.solid.positions - [0.33, 0.5, 0.3], axis=1)
    nodes, way = np.flatnonzero(away < 0.36), np.array([-1.0, 0.0, -1.0])
    on_top = nodes[plate.solid.positions[nodes, 2] > 0.299]
    load = FingerLoad(plate.solid.free[on_top], np.tile(way, (len(on_top), 1)))
    linear = plate.solid.linear(plate.solid.on_free_nodes(load.nodes, load.forces))
    size = 0.3 / np.abs(linear[on_top] @ way).max()
    found = plate.pressed([replace(load, forces=size * load.forces)])
    farthest = size * np.linalg.norm(linear, axis=1).max()
    moved = found.displacements
    assert moved is None or np.linalg.norm(moved, axis=1).max() < 1.3 * farthest
    assert found.firmness.reach > 0.0
