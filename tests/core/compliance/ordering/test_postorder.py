from itertools import permutations, product

import numpy as np
import pytest

from palpate.core.compliance.ordering.dissection import Dissection
from palpate.core.compliance.ordering.postorder import with_least_held


def peak_of(dissection, needed, left, kept):
    """Bytes held at most, front after front."""
    parents, held, peak = dissection.parents, 0, 0
    for front in range(len(parents)):
        below = sum(left[child] for child in np.flatnonzero(parents == front))
        peak = max(peak, held - below + needed[front])
        held += left[front] + kept[front] - below
    return peak


def all_orders(children, root):
    """Every postorder of the tree below ``root``."""
    for order in permutations(children[root]):
        for parts in product(*(list(all_orders(children, child)) for child in order)):
            yield [front for part in parts for front in part] + [root]


@pytest.fixture
def tree(rng):
    """Of seven fronts: two children of the root with two and three children."""
    parents = np.array([2, 2, 7, 6, 6, 6, 7, -1])
    starts = np.concatenate([[0], np.cumsum(rng.integers(1, 4, size=8))])
    dissection = Dissection(rng.permutation(starts[-1]), starts, parents)
    left, kept = rng.integers(1, 50, size=(2, 8))
    below = np.array([left[parents == front].sum() for front in range(8)])
    return dissection, below + left + kept + rng.integers(0, 200, size=8), left, kept


def test_no_other_order_holds_less(tree):
    dissection, needed, left, kept = tree
    found = with_least_held(dissection, needed.tolist(), left.tolist(), kept.tolist())
    children = [np.flatnonzero(dissection.parents == front).tolist() for front in range(8)]
    pivots = np.split(dissection.order, dissection.starts[1:-1])
    fronts = [
        next(old for old, those in enumerate(pivots) if those[0] == found.order[start])
        for start in found.starts[:-1]
    ]
    reached = peak_of(found, needed[fronts], left[fronts], kept[fronts])
    for order in all_orders(children, 7):
        place = np.argsort(order)
        parents = dissection.parents[order]
        other = Dissection(
            dissection.order, dissection.starts, np.where(parents < 0, -1, place[parents])
        )
        assert reached <= peak_of(other, needed[order], left[order], kept[order])


def test_fronts_stay_what_they_were(tree):
    dissection, needed, left, kept = tree
    found = with_least_held(dissection, needed.tolist(), left.tolist(), kept.tolist())

    def families(some):
        pivots = [tuple(part) for part in np.split(some.order, some.starts[1:-1])]
        return {
            (those, pivots[parent] if parent >= 0 else None)
            for those, parent in zip(pivots, some.parents, strict=True)
        }

    assert families(found) == families(dissection)
    parents = found.parents
    assert all(parents[front] > front for front in np.flatnonzero(parents >= 0))
