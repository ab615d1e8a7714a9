"""Smoothed strains: averages of the gradients of tetrahedra over the domains around edges or nodes.

Nearly incompressible linear tetrahedra have one volume constraint each, more than there are
displacements to satisfy them, so they lock. Averaged around nodes there is one constraint a node.
Shear averaged around edges bends nearly as softly as quadratic elements, and keeps the strain
energy positive for every deformation, which averaging around nodes does not.

References
----------
J. Bonet, A. J. Burton: A simple average nodal pressure tetrahedral element, Communications in
Numerical Methods in Engineering 14, 1998.
T. Nguyen-Thoi, G. R. Liu, H. C. Vu-Do, H. Nguyen-Xuan: A face-based smoothed finite element method
(FS-FEM) for 3D linear and geometrically non-linear solid mechanics using 4-node tetrahedral
elements, International Journal for Numerical Methods in Engineering 78, 2009; there also the
selective combination of two kinds of domains.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_array, csr_array, diags_array

# Corners of a tetrahedron's six edges.
TET_EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])

# Tetrahedra around one edge or node whose moduli differ by more than this factor are not averaged
# with each other: bone and the fat beside it strain differently.
LARGEST_SPREAD = 4.0

# Relative difference of moduli that is rounding.
ROUNDING = 1e-6


@dataclass(frozen=True, eq=False)
class SmoothingDomains:
    """Domains over which strain is averaged; they partition the body.

    Attributes
    ----------
    shares : csr (D, M), the volume that domain d takes of tetrahedron t, cubic metres.
    young_scale : (D,), each domain's mean factor on Young's modulus.
    """

    shares: csr_array
    young_scale: NDArray[np.float64]

    @property
    def volumes(self) -> NDArray[np.float64]:
        """Volume of each domain, (D,), cubic metres."""
        return np.asarray(self.shares.sum(axis=1))


def tet_domains(volumes: NDArray[np.float64], young_scale: NDArray[np.float64]) -> SmoothingDomains:
    """One domain a tetrahedron: no smoothing. ``volumes`` (M,), ``young_scale`` (M,)."""
    return SmoothingDomains(diags_array(volumes, format="csr"), young_scale)


def edge_domains(
    tets: NDArray[np.int64], volumes: NDArray[np.float64], young_scale: NDArray[np.float64]
) -> SmoothingDomains:
    """One domain an edge, with a sixth of each tetrahedron around it.

    ``tets`` (M, 4), ``volumes`` (M,), ``young_scale`` (M,).
    """
    ends = np.sort(tets[:, TET_EDGES], axis=2)
    edges = ends[:, :, 0] * (tets.max() + 1) + ends[:, :, 1]
    return _domains(edges, volumes, young_scale)


def node_domains(
    tets: NDArray[np.int64], volumes: NDArray[np.float64], young_scale: NDArray[np.float64]
) -> SmoothingDomains:
    """One domain a node, with a quarter of each tetrahedron around it.

    ``tets`` (M, 4), ``volumes`` (M,), ``young_scale`` (M,).
    """
    return _domains(tets, volumes, young_scale)


def gradient_products(
    domains: SmoothingDomains, tets: NDArray[np.int64], gradients: NDArray[np.float64]
) -> bsr_array:
    """Sum over domains of volume x modulus factor x (smoothed gradient a) (smoothed gradient b)^T.

    ``tets`` (M, 4), ``gradients`` (M, 4, 3) of the shape functions, 1/metre. All isotropic
    stiffness matrices are made of these blocks.

    Returns
    -------
    bsr_array (3N, 3N) of 3 x 3 blocks, exactly symmetric, metre.
    """
    tet_count, size = len(tets), 3 * (int(tets.max()) + 1)
    corners = tets.ravel().astype(np.int32)
    starts = np.arange(0, 4 * tet_count + 1, 4, dtype=np.int32)
    of_tets = bsr_array((gradients.reshape(-1, 1, 3), corners, starts), shape=(tet_count, size))
    smoothed = domains.shares.tobsr((1, 1)) @ of_tets
    # Half of the factor on each side: the product is symmetric to the last bit.
    factor = np.sqrt(domains.young_scale / domains.volumes)
    smoothed.data *= np.repeat(factor, np.diff(smoothed.indptr))[:, None, None]
    products: bsr_array = smoothed.T @ smoothed
    return products


def _domains(
    groups: NDArray[np.int64], volumes: NDArray[np.float64], young_scale: NDArray[np.float64]
) -> SmoothingDomains:
    """Domains of tetrahedra with the same group (M, c), split where moduli differ."""
    tet_count, per_tet = groups.shape
    members = np.repeat(np.arange(tet_count), per_tet)
    group = np.unique(groups, return_inverse=True)[1].ravel()
    softest = np.full(group.max() + 1, np.inf)
    np.minimum.at(softest, group, young_scale[members])
    ratio = young_scale[members] / softest[group]
    level = np.floor(np.log(ratio) / np.log(LARGEST_SPREAD) + ROUNDING).astype(np.int64)
    domain = np.unique(group * (level.max() + 1) + level, return_inverse=True)[1]
    share = np.repeat(volumes / per_tet, per_tet)
    count = int(domain.max()) + 1
    # 32-bit indices: those of K, the largest arrays, inherit their type from here.
    places = domain.astype(np.int32), members.astype(np.int32)
    shares = csr_array((share, places), shape=(count, tet_count))
    total = np.bincount(domain, weights=share)
    scale = np.bincount(domain, weights=share * young_scale[members]) / total
    return SmoothingDomains(shares, scale)
