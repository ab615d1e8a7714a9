import itertools

import numpy as np
import pytest

from palpate.core.compliance.ordering.vertex_cover import minimum_vertex_cover


def smallest_cover_size(edges, nodes):
    for size in range(len(nodes) + 1):
        for chosen in itertools.combinations(nodes, size):
            if np.isin(edges, chosen).any(axis=1).all():
                return size
    return len(nodes)


@pytest.mark.parametrize("seed", range(40))
def test_no_smaller_set_meets_every_edge(seed):
    rng = np.random.default_rng(seed)
    left_count, right_count = rng.integers(1, 7, 2)
    edges = np.argwhere(rng.random((left_count, right_count)) < rng.uniform(0.1, 0.9))
    edges = edges + np.array([0, 100])
    cover = minimum_vertex_cover(edges[:, 0], edges[:, 1])
    assert len(np.unique(cover)) == len(cover)
    assert np.isin(edges, cover).any(axis=1).all()
    assert len(cover) == smallest_cover_size(edges, np.unique(edges))


def test_a_star_is_covered_by_its_middle():
    cover = minimum_vertex_cover(np.zeros(5, dtype=int), np.arange(1, 6))
    np.testing.assert_array_equal(cover, [0])


def test_without_edges_nothing_is_needed():
    nothing = np.zeros(0, dtype=int)
    assert minimum_vertex_cover(nothing, nothing).size == 0
