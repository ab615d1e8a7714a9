import numpy as np
import pytest
from awkward_bodies import block_of_cubes
from test_dissection import BODIES, dissected, edges_of

from palpate.core.compliance.ordering.symbolic import analyse


def filled(edges, order):
    """For each place in the order the later places its elimination couples, by sets."""
    place = np.empty(len(order), dtype=int)
    place[order] = np.arange(len(order))
    later = [set() for _ in order]
    for a, b in np.sort(place[edges], axis=1):
        later[a].add(int(b))
    for own in later:
        if own:
            first = min(own)
            later[first] |= own - {first}
    return later


@pytest.fixture(params=["block", "bar", "plate", "two pieces", "crumbs"])
def analysed(request):
    mesh = BODIES[request.param]
    loaded = np.isin(np.arange(len(mesh.nodes)), mesh.surface_nodes)
    dissection = dissected(mesh)
    return mesh, dissection, loaded, analyse(dissection, edges_of(mesh), loaded)


def test_fronts_hold_what_elimination_fills(analysed):
    """Against elimination node by node, of which a front merges some."""
    mesh, dissection, _, symbolic = analysed
    later = filled(edges_of(mesh), dissection.order)
    for front in symbolic.fronts:
        touched = set().union(*later[front.start : front.stop])
        touched -= set(range(front.start, front.stop))
        assert touched <= set(front.boundary.tolist())
    # Merging pivots adds nothing but what some pivot of the same front or below would have.
    held = sum(len(front.boundary) for front in symbolic.fronts)
    needed = sum(len(set().union(*later[front.start : front.stop])) for front in symbolic.fronts)
    assert held <= 1.1 * needed + 10


def test_what_a_front_leaves_has_a_place_in_its_parent(analysed):
    symbolic = analysed[3]
    for front in symbolic.fronts:
        room = set(front.boundary.tolist()) | set(range(front.start, front.stop))
        for child in front.children:
            assert set(symbolic.fronts[child].boundary.tolist()) <= room


def test_boundaries_ascend_and_roots_have_none(analysed):
    _, dissection, _, symbolic = analysed
    for front, parent in zip(symbolic.fronts, dissection.parents, strict=True):
        assert (np.diff(front.boundary) > 0).all()
        assert not front.boundary.size or front.boundary[0] >= front.stop
        assert parent >= 0 or not front.boundary.size


def test_loads_come_from_below_and_from_own_pivots(analysed):
    _, _, loaded, symbolic = analysed
    np.testing.assert_array_equal(symbolic.loaded, symbolic.order[loaded[symbolic.order]])
    for front in symbolic.fronts:
        below = sum(symbolic.fronts[child].load_count for child in front.children)
        assert front.load_count == below + len(front.loaded_pivots)
        own = symbolic.order[front.start : front.stop][front.loaded_pivots]
        np.testing.assert_array_equal(
            symbolic.loaded[front.load_stop - len(own) : front.load_stop], own
        )


def test_loads_never_reach_pivots_before_the_first_loaded_one():
    mesh = block_of_cubes(4, 4, 4)
    loaded = np.isin(np.arange(len(mesh.nodes)), mesh.surface_nodes)
    front = analyse(dissected(mesh, 200), edges_of(mesh), loaded).fronts[0]
    assert front.first_loaded == np.count_nonzero(~loaded)
