"""A body on the nodes of a coarse lattice: the same material, volume and pins, seen more roughly.

A part of the lattice is integrated at four points, which stand for the quarters of what the body
fills of it and lie where their second moment is that of the filling, less a quarter: a cube of
trilinear displacements is as much too stiff in bending as its four points then take away. Pressure
counts once in a part, at its middle, so that nothing locks where volume is nearly kept.

Displacements that four points cannot see, because what is filled is thin, are held weakly; they
vanish where a part only moves, turns or strains evenly. Pinned nodes of the body are held by stiff
springs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array, eye_array, kron

from ...law.law import Law
from ...law.of_material import law_of
from ...mesh.tet_mesh import TetMesh
from ...stiffness.assembly import lame_parameters
from ..solid.solid import Solid
from ..solid.strain_term import StrainTerm
from .lattice import CORNERS, Lattice

# Directions from the middle to the four quarters.
QUARTERS = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
# Second moment of the four points over that of what they stand for, and how far they may be moved
# apart for it.
MOMENT_SHARE = 0.75
LARGEST_SPREAD = 1.6
# What a part has at least at each of its points, as a share of a quarter of a cube.
LEAST_FILLING = 1e-3
# Stiffness in shear moduli times edge: of all pins in a part together, and of what four points do
# not see, for a full cube.
PIN_STIFFNESS = 100.0
UNSEEN_STIFFNESS = 0.02


@dataclass(frozen=True, eq=False)
class CoarseSolid:
    """A body on a lattice, at unit modulus.

    Attributes
    ----------
    lattice : c nodes, p parts.
    solid : its strain energy.
    springs : csr (c, c), its pins, and what holds what the strains do not see.
    part_modulus : (p,), mean factor of Young's modulus.
    """

    lattice: Lattice
    solid: Solid
    springs: csr_array
    part_modulus: NDArray[np.float64]

    @classmethod
    def of(
        cls,
        lattice: Lattice,
        mesh: TetMesh,
        fixed: NDArray[np.int64],
        poisson_ratio: float,
        young_scale: NDArray[np.float64] | None = None,
        law: Law | None = None,
    ) -> CoarseSolid:
        """Coarse solid of a body's tetrahedra and pins.

        Parameters
        ----------
        lattice : around ``mesh``.
        fixed : (k,), pinned nodes of the mesh.
        poisson_ratio, young_scale : as in :func:`.solid.solid`.
        law : of the material; None for the one that Poisson's ratio alone tells.
        """
        scale = np.ones(len(mesh.tets)) if young_scale is None else young_scale
        quarters = _Quarters.of(lattice, scale)
        first_lame, shear = lame_parameters(1.0, poisson_ratio)
        modulus, volumes = quarters.modulus, quarters.volumes
        gradients = lattice.gradients(quarters.points, np.arange(len(volumes)) // 4)
        # Without pressure, or where it is negative, one term holds all.
        pressed = 0.0 if first_lame > 0 else first_lame
        terms = [StrainTerm(gradients, volumes, pressed * modulus, shear * modulus)]
        by_part = volumes.reshape(-1, 4)
        part_volumes = by_part.sum(axis=1)
        part_modulus = (by_part * modulus.reshape(-1, 4)).sum(axis=1) / part_volumes
        if first_lame > 0:
            shares = (by_part / part_volumes[:, None]).ravel()
            mean = _part_means(shares) @ gradients
            terms.append(
                StrainTerm(mean, part_volumes, first_lame * part_modulus, 0.0 * part_modulus)
            )
        stiffness = shear * lattice.edge * part_modulus
        unseen = stiffness * part_volumes / lattice.edge**3
        springs = _pins(lattice, mesh, fixed, PIN_STIFFNESS * stiffness) + _unseen(lattice, unseen)
        return cls(
            lattice,
            Solid(tuple(terms), lattice.node_count, law or law_of(poisson_ratio)),
            springs,
            part_modulus,
        )

    @property
    def stiffness(self) -> csr_array:
        """At rest, springs included, (3c, 3c)."""
        at_rest = self.solid.tangent(np.zeros((self.lattice.node_count, 3)))
        return csr_array(at_rest + by_axes(self.springs))


def by_axes(matrix: csr_array) -> csr_array:
    """A matrix of nodes (c, c) for their three axes, (3c, 3c)."""
    return csr_array(kron(matrix, eye_array(3), format="csr"))


@dataclass(frozen=True, eq=False)
class _Quarters:
    """Points (4p, 3), volumes and moduli (4p,) of parts, four after four."""

    points: NDArray[np.float64]
    volumes: NDArray[np.float64]
    modulus: NDArray[np.float64]

    @classmethod
    def of(cls, lattice: Lattice, scale: NDArray[np.float64]) -> _Quarters:
        samples, parts, count = lattice.samples, lattice.sample_parts, len(lattice.origins)
        volumes, each = samples.volumes, scale[samples.tets]
        filled = np.bincount(parts, volumes, count)
        centres = _sums(parts, volumes[:, None] * samples.points, count) / filled[:, None]
        away = samples.points - centres[parts]
        quarter = 4 * parts + (away @ QUARTERS.T).argmax(axis=1)
        least = LEAST_FILLING * lattice.edge**3 / 4
        own = np.bincount(quarter, volumes, 4 * count).astype(np.float64) + least
        spread = least * np.tile(0.25 * lattice.edge * QUARTERS, (count, 1))
        offsets = (_sums(quarter, volumes[:, None] * away, 4 * count) + spread) / own[:, None]
        squares = volumes * np.einsum("qj,qj->q", away, away) + samples.moments
        moments = np.bincount(parts, squares, count)
        seen = (own * np.einsum("qj,qj->q", offsets, offsets)).reshape(-1, 4).sum(axis=1)
        apart = np.minimum(np.sqrt(MOMENT_SHARE * moments / seen), LARGEST_SPREAD)
        points = np.repeat(centres, 4, axis=0) + np.repeat(apart, 4)[:, None] * offsets
        moduli = np.bincount(parts, volumes * each, count) / filled
        stiff = np.bincount(quarter, volumes * each, 4 * count) + least * np.repeat(moduli, 4)
        return cls(points, own, stiff / own)


def _sums(at: NDArray[np.int64], vectors: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    return np.stack([np.bincount(at, vectors[:, axis], count) for axis in range(3)], axis=1)


def _part_means(shares: NDArray[np.float64]) -> csr_array:
    """Means over four points, for three axes at once, csr (3p, 12p)."""
    count = len(shares) // 4
    means = csr_array((shares, np.arange(4 * count), 4 * np.arange(count + 1)))
    return by_axes(means)


def _pins(
    lattice: Lattice, mesh: TetMesh, fixed: NDArray[np.int64], stiffness: NDArray[np.float64]
) -> csr_array:
    """The springs of pinned nodes (k,), csr (c, c), by part of ``stiffness`` (p,)."""
    held = lattice.interpolation(mesh.nodes[fixed], lattice.node_parts[fixed])
    return csr_array(held.T @ diags_array(spring_of_each(lattice, fixed, stiffness)) @ held)


def spring_of_each(
    lattice: Lattice, nodes: NDArray[np.int64], stiffness: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The share (k,) of each of a body's nodes in the stiffness (p,) of its part."""
    parts = lattice.node_parts[nodes]
    shared: NDArray[np.float64] = stiffness[parts] / np.bincount(parts)[parts]
    return shared


def _unseen(lattice: Lattice, stiffness: NDArray[np.float64]) -> csr_array:
    """Stiffness of a cube's four trilinear displacements that are not linear, csr (c, c)."""
    x, y, z = (2.0 * CORNERS - 1.0).T
    modes = np.stack([x * y, y * z, z * x, x * y * z]) / 8
    count = len(stiffness)
    rows = np.arange(4 * count).repeat(8)
    columns = lattice.corners.repeat(4, axis=0).ravel()
    values = np.tile(modes.ravel(), count)
    seen = coo_array((values, (rows, columns)), shape=(4 * count, lattice.node_count)).tocsr()
    return csr_array(seen.T @ diags_array(np.repeat(UNSEEN_STIFFNESS * stiffness, 4)) @ seen)
