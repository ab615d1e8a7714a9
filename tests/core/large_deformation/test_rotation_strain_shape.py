"""The shape without a table as Blender draws it: prepared in the background, linear until then."""

import threading

import numpy as np
import pytest

from palpate.core.large_deformation import rotation_strain_shape
from palpate.core.large_deformation.free_solid import FreeSolid
from palpate.core.large_deformation.newton import equilibrium
from palpate.core.large_deformation.rotation_strain_shape import RotationStrainShape


def bend(body):
    """Forces that push the whole top sideways by half the cube's edge."""
    nodes = np.flatnonzero(body.mesh.nodes[:, 2] == body.mesh.nodes[:, 2].max())
    forces = np.tile([1.0, 0.0, 0.0], (len(nodes), 1))
    return nodes, forces * 0.025 / np.abs(body.deform(nodes, forces)).max()


def test_it_comes_near_the_true_shape(cube):
    shape = RotationStrainShape(cube)
    nodes, forces = bend(cube)
    shape.wait_for(nodes)
    solid = FreeSolid.of(cube)
    found = equilibrium(solid, solid.on_free_nodes(nodes, forces / cube.young_modulus))
    truth = found.displacements[solid.surface]
    error = np.linalg.norm(shape.displacements(nodes, forces) - truth)
    assert error < 0.1 * np.linalg.norm(cube.deform(nodes, forces) - truth)


def test_it_is_linear_until_it_is_prepared_and_ends_when_closed(cube, monkeypatch):
    goes_on = threading.Event()
    made = FreeSolid.of(cube)

    def held_up(_):
        assert goes_on.wait(10)
        return made

    monkeypatch.setattr(rotation_strain_shape.FreeSolid, "of", held_up)
    shape = RotationStrainShape(cube)
    nodes, forces = bend(cube)
    assert shape.ready == 0.0
    np.testing.assert_array_equal(shape.displacements(nodes, forces), cube.deform(nodes, forces))
    shape.close()
    goes_on.set()
    shape.wait_for(nodes)
    assert shape.ready < 1.0
    np.testing.assert_array_equal(shape.displacements(nodes, forces), cube.deform(nodes, forces))


def test_what_fails_in_the_background_is_told(cube, monkeypatch):
    def fails(_):
        raise ZeroDivisionError

    monkeypatch.setattr(rotation_strain_shape.FreeSolid, "of", fails)
    shape = RotationStrainShape(cube)
    nodes, forces = bend(cube)
    with pytest.raises(ZeroDivisionError):
        shape.wait_for(nodes)
    with pytest.raises(ZeroDivisionError):
        shape.displacements(nodes, forces)
