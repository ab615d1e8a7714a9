"""Where a tool may touch: on the surface, evenly, whatever the mesh."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from palpate.core.contact.near_field.contact_points import MOST_ON_BODY, contact_points, spacing_on
from palpate.core.contact.near_field.point_compliance import point_compliance
from palpate.core.contact.near_field.surface_shape import smooth_corner_normals
from palpate.core.contact.near_field.surface_shares import surface_shares
from palpate.core.errors import PalpateError
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh

SPACINGS = [0.003, 0.007, 0.02]


def surface_area(mesh):
    i, j, k = np.moveaxis(mesh.nodes[mesh.surface_triangles], 1, 0)
    return 0.5 * np.linalg.norm(np.cross(j - i, k - i), axis=1).sum()


@pytest.mark.parametrize("spacing", SPACINGS)
def test_the_points_share_the_whole_surface(body, spacing):
    points = contact_points(body, spacing)
    assert points.areas.sum() == pytest.approx(surface_area(body.mesh), rel=1e-12)
    assert (points.areas > 0).all()


@pytest.mark.parametrize("spacing", SPACINGS)
def test_the_points_lie_where_their_triangle_and_area_coordinates_say(body, spacing):
    points = contact_points(body, spacing)
    corners = body.mesh.nodes[body.mesh.surface_triangles[points.triangles]]
    np.testing.assert_allclose(
        np.einsum("pc,pcx->px", points.alphas, corners), points.positions, atol=1e-15
    )
    np.testing.assert_allclose(points.alphas.sum(axis=1), 1.0)
    assert points.alphas.min() >= 0
    np.testing.assert_allclose(np.linalg.norm(points.normals, axis=1), 1.0)


@pytest.mark.parametrize("spacing", SPACINGS)
def test_no_two_points_are_too_close_and_no_place_is_far_from_one(body, spacing, rng):
    points = contact_points(body, spacing)
    tree = cKDTree(points.positions)
    for i, j in tree.query_pairs(0.5 * spacing):
        # Only the two sides of a thin place or of a sharp edge may be.
        assert points.normals[i] @ points.normals[j] <= 0
    corners = body.mesh.nodes[body.mesh.surface_triangles]
    chosen = rng.integers(0, len(corners), 2000)
    places = np.einsum("pc,pcx->px", rng.dirichlet([1, 1, 1], 2000), corners[chosen])
    assert tree.query(places)[0].max() < 1.2 * spacing


def test_the_lattices_of_neighbours_meet_on_their_edge(body):
    """Seen from either triangle an edge carries the same points, in equal parts."""
    spacing, triangles = 0.003, body.mesh.surface_triangles
    points = contact_points(body, spacing)
    on_edge = (points.alphas == 0).sum(axis=1) == 1
    nodes, alphas = triangles[points.triangles[on_edge]], points.alphas[on_edge]
    ends = np.array([corner[alpha > 0] for corner, alpha in zip(nodes, alphas, strict=True)])
    shares = np.array([alpha[alpha > 0][0] for alpha in alphas])
    shares = np.where(ends[:, 0] < ends[:, 1], shares, 1 - shares)
    ends = np.sort(ends, axis=1)
    lengths = np.linalg.norm(body.mesh.nodes[ends[:, 0]] - body.mesh.nodes[ends[:, 1]], axis=1)
    found = {}
    for edge, share, length in zip(map(tuple, ends), shares, lengths, strict=True):
        found.setdefault(edge, (length, []))[1].append(share)
    assert len(found) > 50
    for length, on_it in found.values():
        # Cut so that a part is as near to the spacing as it can be; not one point twice.
        parts = [n for n in range(1, 60) if 0.7 < length / n / spacing < 1.42]
        fits = [
            np.allclose(np.array(on_it) * n % 1, 0, atol=1e-9)
            or np.allclose(-np.array(on_it) * n % 1, 0, atol=1e-9)
            for n in parts
        ]
        assert any(fits)
        assert len(np.unique(np.round(on_it, 9))) == len(on_it)


def test_a_fine_mesh_is_touched_at_some_of_its_nodes(mouse):
    points = contact_points(mouse, 0.05)
    assert 10 < len(points) < 40
    assert (points.alphas.max(axis=1) == 1).mean() > 0.9


def test_normals_are_those_of_the_faces_up_to_the_cubes_edges(cube):
    points = contact_points(cube, 0.004)
    edge = 0.05
    on_top = points.positions[:, 2] == edge
    inside = (np.abs(points.positions[:, :2] - edge / 2) < edge / 2).all(axis=1)
    np.testing.assert_allclose(points.normals[on_top & inside], [[0, 0, 1]] * sum(on_top & inside))
    x, y, z = points.positions.T
    on_rim = on_top & (x == 0) & (y > 0) & (y < edge)
    np.testing.assert_allclose(
        points.normals[on_rim], [np.array([-1, 0, 1]) / np.sqrt(2)] * sum(on_rim), atol=1e-12
    )
    tip = points.normals[(x == edge) & (y == edge) & (z == edge)]
    np.testing.assert_allclose(tip, [np.ones(3) / np.sqrt(3)], atol=1e-12)


def test_normals_at_the_corners_of_triangles_look_out_of_the_body(body):
    i, j, k = np.moveaxis(body.mesh.nodes[body.mesh.surface_triangles], 1, 0)
    faces = np.cross(j - i, k - i)
    faces /= np.linalg.norm(faces, axis=1)[:, None]
    normals = smooth_corner_normals(body.mesh)
    # What is beyond a crease has not turned them: none is far from its own face.
    assert np.einsum("tcx,tx->tc", normals, faces).min() > np.cos(np.radians(60))


@pytest.mark.parametrize("spacing", [0.0, -1.0, np.nan, np.inf])
def test_a_spacing_that_is_no_length_is_refused(cube, spacing):
    with pytest.raises(PalpateError, match="positive length"):
        contact_points(cube, spacing)


def test_more_points_than_a_body_may_have_are_refused(cube):
    with pytest.raises(PalpateError, match="larger tool"):
        contact_points(cube, 1e-5)


def test_a_force_at_one_point_moves_another_as_the_body_says(body, rng):
    """Through the whole table: nodal forces, displacements of nodes, the point between them."""
    points = contact_points(body, 0.006)
    held = np.isin(body.mesh.surface_triangles, body.fixed)[points.triangles]
    loose = np.flatnonzero(~(held & (points.alphas > 0)).any(axis=1))
    i, j = rng.choice(loose, 7, replace=False), rng.choice(loose, 5, replace=False)
    blocks = point_compliance(body, points, i, j)
    free, triangles = body.free_index, body.mesh.surface_triangles
    for column, loaded in enumerate(j):
        force = rng.normal(size=3)
        moved = body.deform(
            triangles[points.triangles[loaded]], points.alphas[loaded][:, None] * force, 1.0
        )
        for row, seen in enumerate(i):
            corners = free(triangles[points.triangles[seen]])
            expected = points.alphas[seen][corners >= 0] @ moved[corners[corners >= 0]]
            np.testing.assert_allclose(
                blocks[row, column] @ force, expected, rtol=1e-5, atol=1e-6 * np.abs(moved).max()
            )


def test_a_pinned_point_answers_as_the_firmest_node_and_only_itself(cube):
    points = contact_points(cube, 0.02)
    held = np.isin(cube.mesh.surface_triangles, cube.fixed)[points.triangles]
    pinned = np.flatnonzero((points.alphas == (points.alphas > 0) * held).all(axis=1))[:3]
    assert (points.alphas[pinned].max(axis=1) == 1).all()
    blocks = point_compliance(cube, points, pinned, np.arange(len(points)))
    firmest = np.linalg.eigvalsh(cube.compliance.diagonal()).min()
    for row, point in enumerate(pinned):
        np.testing.assert_allclose(blocks[row, point], firmest * np.eye(3))
        assert not np.delete(blocks[row], pinned, axis=0).any()


def test_the_sides_of_a_thin_plate_take_nothing_from_each_other():
    """One point above, three below: all of the upper side belongs to the first one."""
    mesh, _ = paper_cube(1.0, 4)
    plate = TetMesh.checked(mesh.nodes * [1.0, 1.0, 0.02], mesh.tets)
    places = np.array([[0.5, 0.5, 0.02], [0.2, 0.2, 0.0], [0.8, 0.2, 0.0], [0.5, 0.8, 0.0]])
    normals = np.array([[0.0, 0.0, 1.0], *3 * [[0.0, 0.0, -1.0]]])
    shares = surface_shares(plate, smooth_corner_normals(plate), places, normals, 0.5)
    assert shares.sum() == pytest.approx(surface_area(plate))
    assert 1.0 - 1e-9 < shares[0] < 1.0 + 4 * 0.02
    assert shares[1:].sum() > 1.0 - 1e-9


def test_a_tool_small_for_its_body_gets_points_farther_apart(mouse):
    assert spacing_on(mouse, 0.002) == 0.002
    area = 0.5 * np.linalg.norm(
        np.cross(
            *np.diff(mouse.mesh.nodes[mouse.mesh.surface_triangles], axis=1).transpose(1, 0, 2)
        ),
        axis=1,
    )
    wider = spacing_on(mouse, 0.0004)
    assert 0.0004 < wider < 0.001
    assert 1.3 * area.sum() / wider**2 == pytest.approx(MOST_ON_BODY, rel=0.03)
    # Smaller still, and it would fall between them: that is refused.
    with pytest.raises(PalpateError, match="take a larger tool"):
        contact_points(mouse, spacing_on(mouse, 0.0002))
