"""Cubes around a body: what they interpolate, and that what is apart stays apart."""

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.shape.lattice.lattice import Lattice, lattice_of

SLOPES = np.array([[0.3, -1.0, 2.0], [0.5, 0.1, -0.4], [-2.0, 0.7, 0.2]])


def pair_of_plates(gap):
    """Two plates 1 x 1 x 0.3 m, one above the other."""
    mesh, _ = paper_cube(1.0, 4)
    plate = mesh.nodes * [1.0, 1.0, 0.3]
    both = np.concatenate([plate, plate + np.array([0.0, 0.0, 0.3 + gap])])
    return TetMesh.checked(both, np.concatenate([mesh.tets, mesh.tets + len(plate)]))


def pieces(lattice):
    """How many parts of a lattice hang together in none."""
    count = lattice.corners.size // 8
    rows, columns = np.arange(count).repeat(8), count + lattice.corners.ravel()
    size = count + lattice.node_count
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(size, size))
    return connected_components(graph, directed=False)[0]


@pytest.mark.parametrize("edge", [0.7, 0.3, 0.15])
def test_linear_fields_are_interpolated_exactly_with_their_gradients(edge):
    mesh, _ = paper_cube(1.0, 4)
    lattice = Lattice.around(mesh, edge)
    field = lattice.positions @ SLOPES.T
    found = lattice.interpolation(mesh.nodes, lattice.node_parts) @ field
    np.testing.assert_allclose(found, mesh.nodes @ SLOPES.T, atol=1e-12)
    samples, parts = lattice.samples.points, lattice.sample_parts
    gradients = (lattice.gradients(samples, parts) @ field).reshape(-1, 3, 3)
    np.testing.assert_allclose(gradients, np.broadcast_to(SLOPES.T, gradients.shape), atol=1e-10)


def test_every_sample_is_in_its_cube_and_nodes_are_near_theirs():
    mesh, _ = paper_cube(1.0, 4)
    lattice = Lattice.around(mesh, 0.3)
    inside = lattice.local(lattice.samples.points, lattice.sample_parts)
    assert inside.min() >= 0.0
    assert inside.max() <= 1.0
    near = lattice.local(mesh.nodes, lattice.node_parts)
    assert near.min() >= -1e-9
    assert near.max() <= 1.0 + 1e-9


def test_what_is_apart_in_a_cube_stays_apart():
    apart, touching = (Lattice.around(pair_of_plates(gap), 0.5) for gap in (0.01, 0.0))
    assert pieces(apart) == 2
    assert len(apart.positions) > len(np.unique(np.round(apart.positions, 9), axis=0))
    # Nodes in one place are still two nodes: plates that only lie on each other are apart too.
    assert pieces(touching) == 2


@pytest.mark.parametrize("edge", [0.4, 0.1, 0.05])
def test_cubes_much_smaller_than_tetrahedra_hang_together(edge):
    mesh, _ = paper_cube(1.0, 2)
    assert pieces(Lattice.around(mesh, edge)) == 1


@pytest.mark.parametrize("most", [8, 60, 300])
def test_no_more_nodes_are_made_than_asked_for_and_not_many_fewer(most):
    mesh, _ = paper_cube(1.0, 5)
    nodes = mesh.nodes * [3.0, 1.0, 0.5]
    lattice = lattice_of(TetMesh.checked(nodes, mesh.tets), most)
    assert most / 3 < lattice.node_count <= most or most == 8
