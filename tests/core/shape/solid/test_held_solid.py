"""Nodes that a hand holds: rests beside a referee that leads their freedoms."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.bare_body import bare_body
from referees.led_solid import settled

from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.rotation_strain import firmness
from palpate.core.shape.rotation_strain.finger_load import FingerLoad
from palpate.core.shape.rotation_strain.firmness import FirmBody
from palpate.core.shape.rotation_strain.relaxation import relaxation
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.held_solid import led_to


@pytest.fixture(scope="module")
def cube():
    return bare_body(*paper_cube(1.0, 4), 0.49, "smoothed")


@pytest.fixture(scope="module")
def solid(cube):
    return FreeSolid.of(cube)


@pytest.fixture(scope="module")
def top(solid):
    return np.flatnonzero(solid.positions[:, 2] > 1.0 - 1e-9)


def turned(solid, nodes, degrees):
    angle = np.radians(degrees)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) - np.eye(2)
    away = solid.positions[nodes, :2] - 0.5
    return np.hstack([away @ turn.T, np.full((len(nodes), 1), 0.1)])


def test_it_rests_where_its_held_nodes_are_led(solid, top):
    way = turned(solid, top, 70.0)
    share, moved = led_to(solid, top, way, 0.0, np.zeros((solid.node_count, 3)))
    assert share == 1.0
    np.testing.assert_allclose(moved[top], way, atol=1e-4)
    free = np.setdiff1d(np.arange(3 * solid.node_count), 3 * top[:, None] + np.arange(3))
    referee = np.zeros_like(moved)
    for part in (0.25, 0.5, 0.75, 1.0):
        referee[top] = part * way
        referee = settled(solid.solid, referee, free)
    np.testing.assert_allclose(moved, referee, atol=2e-4)


def test_it_tells_how_far_they_can_be_led(solid, top):
    """A block cannot be pressed flat, and what inverts is no rest."""
    way = np.tile([0.0, 0.0, -1.2], (len(top), 1))
    share, moved = led_to(solid, top, way, 0.0, np.zeros((solid.node_count, 3)))
    assert 0.4 < share < 1.0
    np.testing.assert_allclose(moved[top], share * way, atol=1e-3)
    assert solid.solid.terms[0].volume_ratios(moved).min() > 0.0


def test_what_forces_do_not_lead_there_newtons_method_does(cube, solid, top, monkeypatch):
    monkeypatch.setattr(firmness, "HELD", replace(firmness.HELD, steps=8))
    way = turned(solid, top, 50.0)
    loads = held(cube, solid, top, way)
    found = FirmBody(cube, solid, relaxation(solid)).pressed(loads)
    monkeypatch.undo()
    led = FirmBody(cube, solid, relaxation(solid)).pressed(loads)
    assert found.firmness.is_whole
    assert led.firmness.is_whole
    assert found.firmness.deepest == pytest.approx(led.firmness.deepest, rel=0.02)
    np.testing.assert_allclose(found.displacements, led.displacements, atol=0.01)


def held(cube, solid, nodes, way):
    """Loads that hold nodes of the linear body there, each by itself."""
    columns = np.zeros((3 * solid.node_count, 3 * len(nodes)))
    columns[(3 * nodes[:, None] + np.arange(3)).ravel(), np.arange(3 * len(nodes))] = 1.0
    moved = solid.factor.solve(columns)[(3 * nodes[:, None] + np.arange(3)).ravel()]
    forces = np.linalg.solve(moved, way.ravel()).reshape(-1, 3)
    return [
        FingerLoad(solid.free[[node]], force[None], sticks=True)
        for node, force in zip(nodes, forces, strict=True)
    ]
