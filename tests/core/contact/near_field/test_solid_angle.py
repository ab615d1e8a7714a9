"""How much of a body is around a place: half a sphere where it is flat."""

import numpy as np
import pytest

from palpate.core.contact.near_field.solid_angle import solid_angles
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh


def step_shaped():
    """A cube of edge 2 without the quarter beyond x = 1 and z = 1."""
    mesh, _ = paper_cube(2.0, 2)
    middles = mesh.nodes[mesh.tets].mean(axis=1)
    tets = mesh.tets[(middles[:, 0] < 1) | (middles[:, 2] < 1)]
    used, corners = np.unique(tets, return_inverse=True)
    return TetMesh.checked(mesh.nodes[used], corners.reshape(-1, 4))


def angle_at(mesh, place):
    """Of the triangle nearest to the place, which has it as a corner or in the middle of a side."""
    corners = mesh.nodes[mesh.surface_triangles]
    alphas = np.concatenate([np.eye(3), 0.5 * (1 - np.eye(3)), np.full((1, 3), 1 / 3)])
    found = [
        solid_angles(mesh, np.array([triangle]), alpha[None])[0]
        for triangle, corner in enumerate(corners)
        for alpha in alphas
        if np.allclose(alpha @ corner, place)
    ]
    assert found
    np.testing.assert_allclose(found, found[0])
    return found[0]


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((2, 2, 0), np.pi / 2),
        ((2, 1, 0), np.pi),
        ((2, 1.5, 0), np.pi),
        ((2, 1, 0.5), 2 * np.pi),
        ((2, 1.5, 0.5), 2 * np.pi),
        ((1, 1, 1), 3 * np.pi),
        ((1, 1.5, 1), 3 * np.pi),
        ((1, 0, 1), 1.5 * np.pi),
    ],
)
def test_tips_edges_faces_and_the_edge_inside_a_step(place, expected):
    assert angle_at(step_shaped(), np.array(place, dtype=float)) == pytest.approx(expected)


def test_inside_a_triangle_it_is_flat(mouse_mesh):
    mesh, _ = mouse_mesh
    count = len(mesh.surface_triangles)
    found = solid_angles(mesh, np.arange(count), np.full((count, 3), 1 / 3))
    np.testing.assert_array_equal(found, 2 * np.pi)


def test_a_rounder_surface_is_nearly_flat_everywhere(mouse_mesh):
    mesh, _ = mouse_mesh
    count = len(mesh.surface_triangles)
    found = solid_angles(mesh, np.arange(count), np.tile([1.0, 0.0, 0.0], (count, 1)))
    assert abs(np.median(found) / (2 * np.pi) - 0.9) < 0.1
