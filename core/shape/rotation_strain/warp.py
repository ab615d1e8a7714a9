"""Rotation-strain coordinates: a linear displacement, bent and twisted by the rotations it means.

In every tetrahedron, or domain where strains are smoothed, the gradient of a linear displacement
falls into a strain e and a small rotation w. Taken as what they stand for, a stretch U and a finite
rotation, they ask for the deformation gradient F = exp([w]x) U; where that does not fit together,
the displacement whose gradients come nearest is taken, a Poisson equation with the pins held.

For the stretch Huang and others take U = I + e. Here it is U = e + 3 I - 2 (I + e^2 / 4)^-1, which
agrees with e + (I + e^2)^(1/2) to the fourth order. There U - U^-1 is 2 e, so that the stress of a
neo-Hookean solid is the one that the linear computation found, and its volume exp(tr e) as nearly:
it matters where volume is nearly kept. It grows with e everywhere, and nothing is inside out that
is not pressed to e = -2.

References
----------
J. Huang, Y. Tong, K. Zhou, H. Bao, M. Desbrun: Interactive Shape Interpolation through Controllable
Dynamic Deformation, IEEE Transactions on Visualization and Computer Graphics 17, 2011, section 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import diags_array
from scipy.sparse.linalg import SuperLU, splu

from ...law.by_component import (
    Array,
    axial,
    cross_matrices,
    diagonal,
    identity_added,
    inverse_above_identity,
    product,
    symmetric_part,
    transposed_product,
)
from ..solid.gradients import Gradients
from ..solid.springs import Springs
from ..solid.strain_term import StrainTerm
from .rotations import pulled_back_turns, rotations_less_identity


@dataclass(frozen=True, eq=False)
class Warped:
    """A linear displacement warped, with what it was made of in every domain.

    Attributes
    ----------
    displacements : (3, f), of the free nodes.
    strain : e, (3, 3, m).
    bounded : (I + e^2 / 4)^-1, (3, 3, m).
    rotation_vectors : w, (3, m).
    rotations : exp([w]x), (3, 3, m).
    """

    displacements: Array
    strain: Array
    bounded: Array
    rotation_vectors: Array
    rotations: Array


@dataclass(frozen=True, eq=False)
class RotationStrain:
    """The map from linear displacements of the free nodes to warped ones.

    Attributes
    ----------
    gradients : in the domains, of the free nodes.
    weights : (m,), what each counts where gradients do not fit together.
    springs : what else holds nodes where the linear displacement has them.
    """

    gradients: Gradients
    weights: NDArray[np.float64]
    springs: Springs | None = None

    @classmethod
    def of(cls, term: StrainTerm, springs: Springs | None = None) -> RotationStrain:
        """For the nodes of a term of the strain energy that has shear; all nodes are free.

        A domain counts by its volume and its stiffness: what does not fit together then strains
        what is soft, and bone stays bone.
        """
        weights = term.volumes * term.shear_modulus
        return cls(term.by_component, weights, springs)

    def warp(self, linear: Array) -> Warped:
        """Warp linear displacements (3, f)."""
        gradient = self.gradients.of_displacements(linear)
        vectors = 0.5 * axial(gradient)
        strain = symmetric_part(gradient)
        turned = rotations_less_identity(vectors)
        squared = 0.25 * product(strain, strain)
        bounded = inverse_above_identity(identity_added(squared))
        # I - (I + q)^-1 = q (I + q)^-1: what is small is never added to the identity.
        stretch = strain + 2.0 * product(squared, bounded)
        wanted = product(turned, stretch)
        wanted += turned
        wanted += stretch
        right = self.gradients.nodal(self.weights * wanted)
        if self.springs is not None:
            right += self.springs.forces(linear)
        fitted = self._solved(right)
        return Warped(fitted, strain, bounded, vectors, identity_added(turned))

    def pulled_back(self, warped: Warped, forces: Array) -> Array:
        """The transposed derivative of :meth:`warp` there, applied to nodal forces (3, f).

        The work of ``forces`` on any change of the warped displacements is the work of the result
        on the change of the linear ones that causes it.
        """
        e, bounded = warped.strain, warped.bounded
        solved = self._solved(forces)
        stress = self.weights * self.gradients.of_displacements(solved)
        local = transposed_product(warped.rotations, stress)
        # The work R^T stress does on a turn, [a]x U, with a = J dw ...
        stretched = e - 2.0 * bounded
        on_diagonal = diagonal(stretched)
        on_diagonal += 3.0
        turns = axial(product(local, stretched))
        moments = pulled_back_turns(warped.rotation_vectors, turns)
        # ... and on dU = de + S (de e + e de) S / 2, S the bounded part.
        local = symmetric_part(local)
        inner = product(product(bounded, local), bounded)
        local += symmetric_part(product(e, inner))
        local += 0.5 * cross_matrices(moments)
        pulled_back = self.gradients.nodal(local)
        if self.springs is not None:
            pulled_back += self.springs.forces(solved)
        return pulled_back

    def factored(self) -> RotationStrain:
        """Itself, after the work that the first warp would do."""
        _ = self._poisson
        return self

    @cached_property
    def _poisson(self) -> SuperLU:
        backward, forward = self.gradients.backward, self.gradients.forward
        matrix = backward @ diags_array(np.tile(self.weights, 3)) @ forward
        if self.springs is not None:
            matrix = matrix + self.springs.matrix
        return splu(
            matrix.tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def _solved(self, right: Array) -> Array:
        solution: Array = self._poisson.solve(right.T)
        return solution.T
