"""What the freedoms of a touched triangle do together, in the second order of the series.

(16) sums over freedoms as if each were alone. The second order of a load F is a quadratic form of
it, ``sum_j a_jj F_j^2 + sum_(j < k) a_jk F_j F_k``; a table has its diagonal. Here is the rest, for
the places touched last: 36 columns for three nodes, by polarisation, ``a_jk = a(j + k) - a_jj -
a_kk``, one solve each.
"""

from __future__ import annotations

import threading
from collections import OrderedDict

import numpy as np
from numpy.typing import NDArray

from ...stiffness.freedoms import freedoms
from .power_series import SeriesSolid

# Places that are kept, each with 36 columns.
PLACES_KEPT = 8
# Those of two fingers, with 153 columns; more nodes are a tool's, and their pairs too many.
MOST_NODES = 6
COLUMNS_AT_ONCE = 9


class SeriesPairs:
    """Mixed columns of the second order, for a body of 1 Pa, by the nodes they belong to.

    May be filled by one thread and drawn from by another.
    """

    def __init__(self) -> None:
        self._kept: OrderedDict[tuple[int, ...], NDArray[np.float32]] = OrderedDict()
        self._lock = threading.Lock()

    def has(self, places: NDArray[np.int64]) -> bool:
        """Whether these places (k,) of the free surface, ascending, need nothing more."""
        with self._lock:
            return len(places) > MOST_NODES or tuple(places.tolist()) in self._kept

    def fill(self, solid: SeriesSolid, places: NDArray[np.int64]) -> None:
        """Compute what places (k,), ascending, do together."""
        if self.has(places):
            return
        first = solid.solve(solid.unit_loads(freedoms(places)))
        one, other = np.triu_indices(first.shape[2], 1)
        alone = _second_order(solid, first)
        columns = np.empty((len(solid.body.surface), 3, len(one)), dtype=np.float32)
        for start in range(0, len(one), COLUMNS_AT_ONCE):
            part = slice(start, start + COLUMNS_AT_ONCE)
            j, k = one[part], other[part]
            together = _second_order(solid, first[:, :, j] + first[:, :, k])
            columns[:, :, part] = together - alone[:, :, j] - alone[:, :, k]
        with self._lock:
            self._kept[tuple(places.tolist())] = columns
            if len(self._kept) > PLACES_KEPT:
                self._kept.popitem(last=False)

    def displacements(
        self, places: NDArray[np.int64], loads: NDArray[np.float64], largest: NDArray[np.float64]
    ) -> NDArray[np.float64] | float:
        """What loads (k, 3) on places (k,), ascending, add; zero where it is not known.

        ``largest`` (k, 3) are the freedoms' F0. As soon as one load exceeds its own, the sum goes
        on straight along the load as the rest does; see :mod:`.continued_powers`.
        """
        with self._lock:
            columns = self._kept.get(tuple(places.tolist()))
        if columns is None:
            return 0.0
        flat = loads.ravel()
        reach = max(float((np.abs(flat) / largest.ravel()).max()), 1.0)
        one, other = np.triu_indices(len(flat), 1)
        added: NDArray[np.float64] = columns @ (flat[one] * flat[other])
        return added * (2.0 * reach - 1.0) / reach**2


def _second_order(solid: SeriesSolid, first: NDArray[np.float64]) -> NDArray[np.float64]:
    """a_2 on the free surface, (n, 3, k), of loads whose a_1 (f, 3, k) is given."""
    return solid.second(first)[solid.body.surface]
