"""A body is drawn without passing through itself, by a referee that looks into its tetrahedra."""

from __future__ import annotations

import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.soft_block import block_mesh
from palpate_servo import Body, MovedSurface
from scipy.spatial.transform import Rotation

from palpate.core.fold.folds import UNSEEN, Folds
from palpate.core.mesh.tet_mesh import TetMesh

# Cells of 10 mm: two prongs, one cell across each, 20 mm apart, on a base.
CELL, WIDE, DEEP, HIGH, BASE = 0.01, 4, 1, 9, 1
LEFT, RIGHT = (0, 1), (3, 4)


@pytest.fixture(scope="module")
def tongs():
    """Pinned by its lowest nodes."""
    block = block_mesh((CELL * WIDE, CELL * DEEP, CELL * HIGH), (WIDE, DEEP, HIGH))
    middles = block.nodes[block.tets].mean(axis=1) / CELL
    is_prong = (middles[:, 0] < LEFT[1]) | (middles[:, 0] > RIGHT[0])
    used, tets = np.unique(block.tets[is_prong | (middles[:, 2] < BASE)], return_inverse=True)
    mesh = TetMesh.checked(block.nodes[used], tets.reshape(-1, 4))
    fixed = np.flatnonzero(mesh.nodes[:, 2] == 0.0)
    return baked_body(mesh, fixed, 0.3, 1e5)


def prong(body, side):
    """Nodes of a prong, and its tetrahedra."""
    x, _, z = body.mesh.nodes.T / CELL
    low, high = side
    within = (x >= low - 1e-6) & (x <= high + 1e-6) & (z >= BASE - 1e-6)
    return np.flatnonzero(within), body.mesh.tets[within[body.mesh.tets].all(axis=1)]


def bent(body, by):
    """Displacements (n, 3) under forces that bring the tips together by ``by`` metres each."""
    tips = [np.flatnonzero(body.mesh.nodes[:, 2] > CELL * (HIGH - 0.5))]
    x = body.mesh.nodes[tips[0], 0] / CELL
    forces = np.zeros((len(tips[0]), 3))
    forces[:, 0] = np.where(x < 2.0, 1.0, -1.0)
    made = body.deform(tips[0], forces, 1.0)
    return made * (by / np.abs(made[:, 0]).max())


def depth_of(body, displacements):
    """How deep a node of one prong is within the other at most, metres: by the tetrahedra in which
    it lies, and its distance to their faces. All nodes of the prongs are on the surface.
    """
    places = body.mesh.nodes.copy()
    places[body.compliance.free_surface] += displacements
    most = 0.0
    for own, other in ((LEFT, RIGHT), (RIGHT, LEFT)):
        nodes, (_, tets) = prong(body, own)[0], prong(body, other)
        corners = places[tets]
        edges = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
        for node in nodes:
            shares = np.linalg.solve(edges, (places[node] - corners[:, 0])[..., None])[..., 0]
            if (np.column_stack([1.0 - shares.sum(axis=1), shares]) > 0.0).all(axis=1).any():
                most = max(most, nearest(places[node], faces(places, tets)))
    return most


def faces(places, tets):
    """Triangles (f, 3, 3) that belong to one tetrahedron alone."""
    all_of = np.concatenate(
        [tets[:, [b, c, d]] for b, c, d in ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))]
    )
    _, first, count = np.unique(
        np.sort(all_of, axis=1), axis=0, return_index=True, return_counts=True
    )
    return places[all_of[first[count == 1]]]


def nearest(place, triangles):
    """Least distance to triangles, by a fine grid of places of each."""
    steps = np.linspace(0.0, 1.0, 21)
    a, b = (each.ravel() for each in np.meshgrid(steps, steps))
    a, b = a[a + b <= 1.0], b[a + b <= 1.0]
    shares = np.column_stack([1.0 - a - b, a, b])
    grid = np.einsum("gc,fci->fgi", shares, triangles)
    return float(np.linalg.norm(grid - place, axis=2).min())


@pytest.mark.parametrize("by", [0.016, 0.02, 0.024])
def test_tongs_that_close_do_not_pass_through_each_other(tongs, by):
    folds, made = Folds(tongs), bent(tongs, by)
    before = depth_of(tongs, made)
    assert before > 1.5e-3
    opened = folds.opened(made)
    assert depth_of(tongs, opened) < 0.02 * folds.size
    assert folds.within(opened).deepest <= UNSEEN * folds.size
    # They touch, and are not driven farther apart than that.
    gap = gap_between(tongs, opened)
    assert gap < 0.01 * folds.size
    # Nothing is kept: again it is the same.
    np.testing.assert_array_equal(folds.opened(made), opened)


def gap_between(body, displacements):
    """Between the tips, metres."""
    places = body.mesh.nodes.copy()
    places[body.compliance.free_surface] += displacements
    tip = body.mesh.nodes[:, 2] > CELL * (HIGH - 0.5)
    x = body.mesh.nodes[:, 0] / CELL
    return (
        places[tip & (np.abs(x - RIGHT[0]) < 1e-6), 0].min()
        - places[tip & (np.abs(x - LEFT[1]) < 1e-6), 0].max()
    )


def test_what_does_not_meet_itself_stays_as_it_is_to_the_bit(tongs):
    folds = Folds(tongs)
    for by in (0.004, 0.009, -0.02):
        made = bent(tongs, by)
        assert folds.opened(made) is made


def test_what_a_thin_part_has_on_its_other_side_is_no_fold(tongs):
    """However flat it is squeezed."""
    nodes = tongs.mesh.nodes[tongs.compliance.free_surface]
    x, _, z = nodes.T / CELL
    made = np.zeros_like(nodes)
    own = (z > BASE) & (x < 2.0)
    made[own, 0] = -0.9 * (x[own] - 0.5) * CELL
    assert Folds(tongs).opened(made) is made


def test_turns_are_those_of_a_body_that_turns():
    mesh = block_mesh((0.05, 0.04, 0.03), (2, 2, 2))
    rest = mesh.nodes[mesh.surface_nodes]
    turn = Rotation.random(random_state=7).as_matrix()
    blocks = np.tile(np.eye(3), (len(rest), 1, 1))
    surface = MovedSurface(Body(rest, mesh.surface_local_triangles, blocks))
    found = surface.turns(rest @ turn.T + [0.1, 0.0, 0.2]).reshape(-1, 3, 3)
    np.testing.assert_allclose(found, np.tile(turn, (len(rest), 1, 1)), atol=1e-9)
