import itertools

import numpy as np
import pytest
from awkward_bodies import block_of_cubes, joined

from palpate.core.compliance.ordering.dissection import dissect


def edges_of(mesh):
    pairs = np.concatenate([mesh.tets[:, pair] for pair in itertools.combinations(range(4), 2)])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def dissected(mesh, leaf_nodes=20):
    last = np.zeros(len(mesh.nodes), dtype=bool)
    last[mesh.surface_nodes] = True
    return dissect(edges_of(mesh), mesh.nodes, last, leaf_nodes)


BODIES = {
    "block": block_of_cubes(8, 8, 8),
    "bar": block_of_cubes(60, 2, 2),
    "plate": block_of_cubes(20, 20, 1),
    "two pieces": joined(block_of_cubes(5, 5, 5), block_of_cubes(3, 3, 3, origin=(1, 0, 0))),
    "crumbs": joined(*(block_of_cubes(1, 1, 1, origin=(i, 0, 0)) for i in range(30))),
    "large enough for several cuts": block_of_cubes(12, 12, 12),
}


@pytest.fixture(params=BODIES, ids=str)
def mesh(request):
    return BODIES[request.param]


def test_every_node_is_eliminated_once(mesh):
    dissection = dissected(mesh)
    np.testing.assert_array_equal(np.sort(dissection.order), np.arange(len(mesh.nodes)))
    assert dissection.starts[0] == 0
    assert dissection.starts[-1] == len(mesh.nodes)
    assert (np.diff(dissection.starts) > 0).all()


def test_fronts_stand_in_postorder(mesh):
    """All that end up in a front stand directly before it."""
    parents = dissected(mesh).parents
    below = np.ones(len(parents), dtype=int)
    for front, parent in enumerate(parents):
        if parent >= 0:
            assert parent > front
            below[parent] += below[front]
    for front, parent in enumerate(parents):
        if parent >= 0:
            assert parent - below[parent] < front - below[front] + 1


def test_separators_separate(mesh):
    """Two coupled nodes are in one front, or one's front is above the other's."""
    dissection = dissected(mesh)
    front_of = np.empty(len(mesh.nodes), dtype=int)
    for front in range(len(dissection.parents)):
        span = slice(*dissection.starts[front : front + 2])
        front_of[dissection.order[span]] = front
    above = []
    for front in range(len(dissection.parents)):
        chain = {front}
        while (front := int(dissection.parents[front])) >= 0:
            chain.add(front)
        above.append(chain)
    for a, b in front_of[edges_of(mesh)]:
        assert b in above[a] or a in above[b]


def test_leaves_are_small_and_end_with_the_nodes_that_come_last(mesh):
    dissection = dissected(mesh)
    surface = np.isin(np.arange(len(mesh.nodes)), mesh.surface_nodes)
    for front in set(range(len(dissection.parents))) - set(dissection.parents.tolist()):
        nodes = dissection.order[slice(*dissection.starts[front : front + 2])]
        assert len(nodes) <= 20
        assert (np.diff(surface[nodes].astype(int)) >= 0).all()


def test_a_blocks_first_separator_is_about_a_plane_of_nodes():
    mesh = BODIES["large enough for several cuts"]
    dissection = dissected(mesh)
    assert np.diff(dissection.starts)[-1] <= 13 * 13


def test_small_pieces_share_a_front():
    """Thirty pieces of eight nodes, four to a front: half of the nodes that a leaf may have."""
    assert len(dissected(BODIES["crumbs"], 64).parents) == 8


def test_what_cannot_be_cut_is_one_front():
    """Where all nodes are coupled, any separator leaves one side empty."""
    pairs = np.array(list(itertools.combinations(range(9), 2)))
    positions = np.random.default_rng(3).normal(size=(9, 3))
    dissection = dissect(pairs, positions, np.zeros(9, dtype=bool), leaf_nodes=4)
    assert dissection.parents[-1] == -1
    assert len(dissection.order) == 9


@pytest.mark.parametrize("count", [1, 5])
def test_nodes_without_couplings(count):
    none = np.zeros((0, 2), dtype=np.int64)
    positions = np.zeros((count, 3))
    dissection = dissect(none, positions, np.ones(count, dtype=bool), leaf_nodes=2)
    np.testing.assert_array_equal(np.sort(dissection.order), np.arange(count))
