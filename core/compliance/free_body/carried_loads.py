"""Loads on all nodes, carried through an elimination beside the unit loads of the surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dtrsm

from ...stiffness.freedoms import freedoms
from ..ordering.symbolic import Front, SymbolicFactor


class CarriedLoads:
    """Loads b on all nodes; with K = C C^T, C^-1 b front by front.

    Nothing is solved backwards: with W = C^-1 E of the unit loads, E^T K^-1 b = W^T (C^-1 b).

    Parameters
    ----------
    loads : (3n, k), by the matrix's nodes.
    symbolic : order of elimination and fronts.
    """

    def __init__(self, loads: NDArray[np.float64], symbolic: SymbolicFactor) -> None:
        self._held = np.asfortranarray(loads[freedoms(symbolic.order)])
        self._moved = np.zeros((3 * len(symbolic.loaded), loads.shape[1]))

    def eliminate(
        self, front: Front, factor: NDArray[np.float64], border: NDArray[np.float64]
    ) -> None:
        """Eliminate the pivots of a front: its Cholesky factor (p, p), and border (p, b)."""
        span = slice(3 * front.start, 3 * front.stop)
        own = dtrsm(1.0, factor, self._held[span], trans_a=True)
        self._held[span] = own
        self._held[freedoms(front.boundary)] -= border.T @ own

    def meet(self, front: Front, loaded: NDArray[np.float64]) -> None:
        """Add what the front's rows of W, (r, c), move; its pivots are eliminated already."""
        own = self._held[3 * front.stop - len(loaded) : 3 * front.stop]
        self._moved[3 * front.load_start : 3 * front.load_stop] += loaded.T @ own

    @property
    def moved(self) -> NDArray[np.float64]:
        """E^T K^-1 b, displacements of the loaded nodes in order of elimination, (3m, k)."""
        return self._moved

    @property
    def energy(self) -> NDArray[np.float64]:
        """b^T K^-1 b, (k, k)."""
        energy: NDArray[np.float64] = self._held.T @ self._held
        return energy
