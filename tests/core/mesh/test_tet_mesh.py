import numpy as np
import pytest

from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])


def test_the_paper_cube_is_table_1_exactly(cube_mesh):
    mesh, fixed = cube_mesh
    assert len(mesh.nodes) == 125
    assert len(mesh.tets) == 320
    assert len(mesh.surface_nodes) == 98
    assert len(mesh.surface_triangles) == 192
    assert len(fixed) == 25
    assert len(np.setdiff1d(mesh.surface_nodes, fixed)) == 73
    assert mesh.volume == pytest.approx(0.05**3, rel=1e-14)
    np.testing.assert_allclose(np.ptp(mesh.nodes, axis=0), 0.05)


@pytest.mark.parametrize("cells", [1, 2, 3, 5])
def test_cubes_of_any_number_of_cells_are_filled_without_gaps(cells):
    mesh, _ = paper_cube(1.0, cells)
    assert mesh.volume == pytest.approx(1.0)
    assert len(mesh.tets) == 5 * cells**3
    assert len(mesh.surface_triangles) == 12 * cells**2


def test_boundary_triangles_are_closed_and_point_outward(mouse_mesh):
    mesh, _ = mouse_mesh
    i, j, k = (mesh.nodes[mesh.surface_triangles[:, corner]] for corner in range(3))
    normals = np.cross(j - i, k - i)
    np.testing.assert_allclose(normals.sum(axis=0), 0, atol=1e-15)
    # Divergence theorem: only outward normals give the volume of the tetrahedra.
    assert np.einsum("ij,ij->", i, normals) / 6 == pytest.approx(mesh.volume, rel=1e-12)


def test_components_are_counted_by_shared_nodes():
    two = np.concatenate([CORNERS, CORNERS + 5])
    assert TetMesh.checked(two, [[0, 1, 2, 3], [4, 5, 6, 7]]).component_count == 2
    assert TetMesh.checked(CORNERS, [[0, 1, 2, 3]]).component_count == 1


@pytest.mark.parametrize(
    ("nodes", "tets", "said"),
    [
        (CORNERS, [[0, 2, 1, 3]], "inverted"),
        (CORNERS * [1, 1, 0], [[0, 1, 2, 3]], "no volume"),
        (np.vstack([CORNERS, [9, 9, 9]]), [[0, 1, 2, 3]], "node 4"),
        (CORNERS, [[0, 1, 2, 4]], "names node 4"),
        (CORNERS, [[0, 1, 2, -1]], "names node -1"),
        (CORNERS, [[0, 1, 2]], "shape"),
        (CORNERS, [[0.0, 1, 2, 3]], "integers"),
        (CORNERS * np.nan, [[0, 1, 2, 3]], "finite"),
        (CORNERS[:, :2], [[0, 1, 2, 3]], "shape"),
        (np.empty((0, 3)), np.empty((0, 4), dtype=int), "shape"),
    ],
)
def test_what_fem_cannot_use_is_refused_by_name(nodes, tets, said):
    with pytest.raises(PalpateError, match=said):
        TetMesh.checked(nodes, tets)


def test_overlapping_tetrahedra_are_refused():
    nodes = np.vstack([CORNERS, [0, 0, 2.0], [0, 0, 3.0]])
    mesh = TetMesh.checked(nodes, [[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 2, 5]])
    with pytest.raises(PalpateError, match="overlap"):
        _ = mesh.surface_triangles


def test_the_callers_arrays_are_copied():
    nodes = CORNERS.copy()
    mesh = TetMesh.checked(nodes, [[0, 1, 2, 3]])
    nodes[0] = 9
    assert mesh.nodes[0, 0] == 0
    with pytest.raises(ValueError, match="read-only"):
        mesh.nodes[0] = 1
