"""Loads that fronts pass on to their parents, in panels of columns.

Columns of W are independent of each other, so each panel is solved and passed on by itself, and
a child's panel is given up as soon as it has arrived: never do all loads of a front stand beside
all of its children's.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...machine.available_memory import zeros_apart
from ..ordering.symbolic import Front
from .extend_add import Run

# Columns of a panel, enough for products at full speed: narrower ones are joined.
PANEL = 512


@dataclass(frozen=True, eq=False)
class Panel:
    """Some loads as they act on a front's boundary.

    Attributes
    ----------
    start, stop : the load freedoms, in order of elimination.
    rows : float64 (b, stop - start), Fortran order.
    """

    start: int
    stop: int
    rows: NDArray[np.float64]


def panel_edges(fronts: Sequence[Front]) -> list[tuple[int, ...]]:
    """Of each front, where the panels of its loads start, and where the last one ends.

    Those of the children, in order, then those on its own pivots; joined until they are wide.
    """
    edges: list[tuple[int, ...]] = []
    for front in fronts:
        stop = 3 * front.load_stop
        stops = [edge for child in front.children for edge in edges[child][1:]]
        stops += range(stop - 3 * len(front.loaded_pivots) + PANEL, stop, PANEL)
        joined = [3 * front.load_start]
        for each in [*stops, stop]:
            if len(joined) > 1 and joined[-1] - joined[-2] < PANEL:
                joined[-1] = each
            elif each > joined[-1]:
                joined.append(each)
        edges.append(tuple(joined))
    return edges


def arriving(
    front: Front,
    edges: tuple[int, ...],
    children: Sequence[tuple[list[Panel], list[Run]]],
    own: NDArray[np.float64],
    boundary: int,
) -> Iterator[Panel]:
    """A front's panels before they are solved, one after the other.

    Parameters
    ----------
    front : where they arrive.
    edges : its own of :func:`panel_edges`.
    children : panels of each child, which are taken out of the list, and where its boundary lies.
    own : (r, c), takes what acts on pivots.
    boundary : freedoms of the front's boundary, b.
    """
    waiting = [(panels, runs) for panels, runs in children if panels]
    for start, stop in pairwise(edges):
        passed = zeros_apart((boundary, stop - start))
        while waiting and waiting[0][0][0].start < stop:
            panels, runs = waiting[0]
            panel = panels.pop(0)
            for run in runs:
                target, first = (
                    (own, 3 * front.load_start) if run.parent_tile < 0 else (passed, start)
                )
                target[run.onward, panel.start - first : panel.stop - first] = panel.rows[run.below]
            del panel
            if not panels:
                waiting.pop(0)
        yield Panel(start, stop, passed)
