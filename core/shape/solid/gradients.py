"""Gradients of displacements, and the forces of stresses, by component: two passes over a mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from ...law.by_component import Array


@dataclass(frozen=True, eq=False)
class Gradients:
    """Derivatives of nodal values in domains, in the layout of :mod:`.by_component`.

    Attributes
    ----------
    forward : csr (3d, f), 1/metre; row ``J d + k`` is the derivative along J in domain k.
    backward : csr (f, 3d), its transpose.
    """

    forward: csr_array
    backward: csr_array

    @classmethod
    def of(cls, by_domain: csr_array) -> Gradients:
        """From rows ``3 k + J``, as :class:`.solid.StrainTerm` has them."""
        count = by_domain.shape[0] // 3
        rows = np.arange(3 * count).reshape(count, 3).T.ravel()
        forward = csr_array(by_domain[rows])
        forward.sort_indices()
        return cls(_narrow(forward), _narrow(csr_array(forward.T)))

    @property
    def domain_count(self) -> int:
        """Number of domains, d."""
        return int(self.forward.shape[0]) // 3

    def of_displacements(self, displacements: Array) -> Array:
        """H = du/dX, (3, 3, d), of displacements (3, f)."""
        gradients: Array = np.empty((3, 3 * self.domain_count))
        for axis in range(3):
            gradients[axis] = self.forward @ displacements[axis]
        return gradients.reshape(3, 3, -1)

    def nodal(self, stresses: Array) -> Array:
        """The transpose: nodal forces (3, f) of stresses (3, 3, d) that are times their volumes."""
        rows = stresses.reshape(3, -1)
        forces: Array = np.empty((3, self.backward.shape[0]))
        for axis in range(3):
            forces[axis] = self.backward @ rows[axis]
        return forces


def _narrow(matrix: csr_array) -> csr_array:
    """With indices of 32 bits: frames read these matrices from memory again and again."""
    parts = (matrix.data, matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32))
    return csr_array(parts, shape=matrix.shape)
