"""Order of a tree's fronts in which the least memory is held at once.

What a front leaves waits until its parent takes it. So of a parent's children the one comes first
that needs most beside what it leaves (Liu, *On the storage requirement in the out-of-core
multifrontal method for sparse factorization*, 1986). Arithmetic stays what it was.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .dissection import Dissection


def with_least_held(
    dissection: Dissection, needed: Sequence[int], left: Sequence[int], kept: Sequence[int]
) -> Dissection:
    """The same fronts, children reordered; still in postorder.

    Parameters
    ----------
    dissection : of f fronts.
    needed : (f,), bytes held at most while a front is eliminated, what its children left included.
    left : (f,), bytes that it leaves to its parent.
    kept : (f,), bytes that it leaves for good.
    """
    parents = dissection.parents.tolist()
    children: list[list[int]] = [[] for _ in parents]
    peaks, stay = list(needed), list(kept)
    for front, parent in enumerate(parents):
        below = children[front]
        below.sort(key=lambda child: peaks[child] - left[child] - stay[child], reverse=True)
        held = peak = 0
        for child in below:
            peak = max(peak, held + peaks[child])
            held += left[child] + stay[child]
        before = sum(stay[child] for child in below)
        peaks[front] = max(peak, before + needed[front])
        stay[front] += before
        if parent >= 0:
            children[parent].append(front)
    return _in_order(dissection, _postorder(parents, children, peaks, left, stay))


def _postorder(
    parents: list[int],
    children: list[list[int]],
    peaks: list[int],
    left: Sequence[int],
    stay: list[int],
) -> list[int]:
    """Fronts by descendants first, roots too in the order of what they need."""
    roots = [front for front, parent in enumerate(parents) if parent < 0]
    roots.sort(key=lambda root: peaks[root] - left[root] - stay[root], reverse=True)
    found, waiting = [], roots
    # From the last one backwards: each front before its children, these from the last one, too.
    while waiting:
        front = waiting.pop()
        found.append(front)
        waiting.extend(children[front])
    return found[::-1]


def _in_order(dissection: Dissection, fronts: list[int]) -> Dissection:
    place = np.empty(len(fronts), dtype=np.int64)
    place[fronts] = np.arange(len(fronts))
    starts, parents = dissection.starts, dissection.parents[fronts]
    pivots = [dissection.order[starts[front] : starts[front + 1]] for front in fronts]
    sizes = [len(front) for front in pivots]
    return Dissection(
        np.concatenate(pivots),
        np.concatenate([[0], np.cumsum(sizes)]),
        np.where(parents >= 0, place[parents], -1),
    )
