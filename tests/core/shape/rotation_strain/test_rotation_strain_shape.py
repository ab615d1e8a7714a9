"""The shape without a table as Blender draws it: prepared in the background, linear until then."""

import threading

import numpy as np
import pytest

from palpate.core.errors import PalpateError
from palpate.core.shape.rotation_strain import rotation_strain_shape
from palpate.core.shape.rotation_strain.rotation_strain_shape import FramePlan, RotationStrainShape
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium


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
    assert error < 0.25 * np.linalg.norm(cube.deform(nodes, forces) - truth)


whole_or_on_a_lattice = pytest.mark.parametrize(
    ("part", "arguments"), [("FreeSolid", ()), ("TwoLevels", (FramePlan(1, 30),))]
)


@whole_or_on_a_lattice
def test_it_is_linear_until_it_is_prepared_and_ends_when_closed(cube, monkeypatch, part, arguments):
    goes_on, kind = threading.Event(), getattr(rotation_strain_shape, part)
    made = kind.of

    def held_up(*given):
        assert goes_on.wait(10)
        return made(*given)

    monkeypatch.setattr(kind, "of", held_up)
    kept, closed = (RotationStrainShape(cube, *arguments) for _ in range(2))
    nodes, forces = bend(cube)
    linear = cube.deform(nodes, forces)
    for shape in (kept, closed):
        assert shape.ready == 0.0 or arguments
        assert shape.ready < 1.0
        np.testing.assert_array_equal(shape.displacements(nodes, forces), linear)
    closed.close()
    goes_on.set()
    kept.wait_for(nodes)
    assert kept.ready == 1.0
    assert np.abs(kept.displacements(nodes, forces) - linear).max() > 0.0
    with pytest.raises(PalpateError, match="closed before it was prepared; make a new one"):
        closed.wait_for(nodes)
    assert closed.ready < 1.0
    np.testing.assert_array_equal(closed.displacements(nodes, forces), linear)


@whole_or_on_a_lattice
def test_what_fails_in_the_background_is_told(cube, monkeypatch, part, arguments):
    def fails(*_):
        raise ZeroDivisionError

    monkeypatch.setattr(getattr(rotation_strain_shape, part), "of", fails)
    shape = RotationStrainShape(cube, *arguments)
    nodes, forces = bend(cube)
    with pytest.raises(ZeroDivisionError):
        shape.wait_for(nodes)
    with pytest.raises(ZeroDivisionError):
        shape.displacements(nodes, forces)
    assert shape.ready < 1.0


def test_on_a_lattice_it_is_a_function_of_the_forces_over_the_modulus(cube):
    shape = RotationStrainShape(cube, FramePlan(1, 30))
    nodes, forces = bend(cube)
    shape.wait_for(nodes)
    assert shape.ready == 1.0
    first = shape.displacements(nodes, forces)
    assert np.abs(first - cube.deform(nodes, forces)).max() > 0.05 * np.abs(first).max()
    np.testing.assert_allclose(
        shape.displacements(nodes, 3 * forces, 3 * cube.young_modulus),
        first,
        rtol=1e-9,
        atol=1e-12,
    )
    shape.displacements(nodes, -forces)
    np.testing.assert_array_equal(shape.displacements(nodes, forces), first)
    # What is on pinned nodes moves nothing.
    pinned = np.append(nodes, cube.fixed[0]), np.vstack([forces, [[1.0, 2.0, 3.0]]])
    np.testing.assert_allclose(shape.displacements(*pinned), first, rtol=1e-12, atol=1e-15)
