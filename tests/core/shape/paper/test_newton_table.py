"""Entries of the paper's tables against equilibria found on another way, and where F0 must give."""

import numpy as np
import pytest
from referees.nonlinear_reference import NonlinearReference

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.dense import DenseCompliance
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.shape.paper.newton_table import (
    largest_carried,
    newton_column,
    usual_largest_force,
)
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import NoEquilibrium, equilibrium


@pytest.fixture(scope="module")
def cube():
    mesh, fixed = paper_cube(cells=2)
    nodes = np.setdiff1d(mesh.surface_nodes, fixed)
    none = DenseCompliance(nodes, np.empty((len(nodes), 3, 0)))
    return FreeSolid.of(SoftBody(mesh, fixed, 0.45, none, 1.0)), mesh


def unit_load(body, freedom):
    node, axis = divmod(freedom, 3)
    forces = np.zeros((body.node_count, 3))
    forces[body.surface[node], axis] = 1.0
    return forces


@pytest.mark.parametrize("freedom", [0, 13, 30])
def test_entries_are_what_another_program_finds(cube, freedom):
    body, mesh = cube
    column = newton_column(body, freedom, usual_largest_force(mesh))
    reference = NonlinearReference(mesh, body.free, 0.45)
    for entries, load in zip(column.per_force, column.largest * [1, -1], strict=True):
        expected = reference.displacements(load * unit_load(body, freedom), 2)[body.surface] / load
        assert np.abs(entries - expected.ravel()).max() < 1e-6 * np.abs(expected).max()


def test_the_usual_force_is_the_papers_on_its_cube(cube):
    assert 10_000.0 * usual_largest_force(cube[1]) == pytest.approx(2.0)


def test_where_the_solid_gives_way_the_force_is_halved_until_it_holds(cube):
    body, _ = cube
    freedom, wanted = 3 * int(np.argmax(body.positions[body.surface, 2])) + 2, -1e-3
    load, found = largest_carried(body, freedom, wanted)
    halvings = np.log2(wanted / load)
    assert halvings == round(halvings) >= 1
    assert found.residual < 1e-10
    assert np.allclose(body.forces(found.displacements), load * unit_load(body, freedom))
    with pytest.raises(NoEquilibrium):
        equilibrium(body, 2.0 * load * unit_load(body, freedom))
