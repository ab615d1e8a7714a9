"""Plan of an elimination, with its exact cost before it starts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ...mesh.tet_mesh import TetMesh
from ...progress import Progress, unwatched
from ...stiffness.held_pins import free_or_pinned
from ..free_body.hold import held
from ..free_body.inertia import Inertia, RigidMotions
from ..ordering.dissection import dissect
from ..ordering.postorder import with_least_held
from ..ordering.symbolic import SymbolicFactor, analyse
from .block_matrix import BlockMatrix, free_blocks
from .inverse import inverse_bytes, inverse_weight
from .work import FrontWork, elimination_peak_bytes, memory_by_front


@dataclass(frozen=True, eq=False)
class EliminationPlan:
    """Symbolic step of a body's elimination, and its cost.

    Attributes
    ----------
    free_surface : int64 (n,), the nodes whose compliance is wanted, ascending.
    matrix : the stiffness between free nodes, the upper half in order of elimination.
    symbolic : fronts and order; nodes are counted among the free ones.
    ranks : int64 (n,), for each loaded node in order of elimination, its place in free_surface.
    table_itemsize : bytes of a number of the resulting table; 0 for none.
    motions : of a body without pins, whose matrix is held by springs; else None.
    """

    free_surface: NDArray[np.int64]
    matrix: BlockMatrix
    symbolic: SymbolicFactor
    ranks: NDArray[np.int64]
    table_itemsize: int
    motions: RigidMotions | None = None

    @cached_property
    def works(self) -> list[FrontWork]:
        """Work of each front."""
        return [FrontWork.of(front) for front in self.symbolic.fronts]

    @cached_property
    def flops(self) -> float:
        """Floating point operations, exactly those of BLAS and LAPACK."""
        eliminated = sum(work.flops for work in self.works)
        if not self.table_itemsize:
            return eliminated
        return eliminated + sum(work.gram_flops for work in self.works)

    @cached_property
    def weight(self) -> float:
        """Time needed, in floating point operations of a large matrix product."""
        eliminated = sum(work.weight for work in self.works)
        if not self.table_itemsize:
            return eliminated
        return eliminated + inverse_weight(self.works, len(self.ranks))

    @cached_property
    def peak_bytes(self) -> int:
        """Peak bytes allocated by the numeric steps, the plan's matrix included.

        A process grows by a little more, measured: memory of small arrays is not all returned.
        """
        fronts = self.symbolic.fronts
        peak, factor = elimination_peak_bytes(fronts, memory_by_front(fronts))
        table = inverse_bytes(len(self.ranks), self.table_itemsize)
        return self.matrix.nbytes + max(self.matrix.index_bytes + peak, factor + table)

    @cached_property
    def factor_bytes(self) -> int:
        """Bytes of W."""
        return sum(work.result_bytes for work in self.works)


def plan_surface_inverse(
    mesh: TetMesh,
    stiffness: csr_array,
    fixed: NDArray[np.int64],
    dtype: type[np.floating] = np.float32,
    progress: Progress = unwatched,
) -> EliminationPlan:
    """Plan the full compliance of the free surface, stored as ``dtype``.

    ``progress`` is called with the approximate share done; it may raise to cancel.

    Without any pins in ``fixed`` it is that of a free body; see :mod:`..free_body`.

    Raises
    ------
    PalpateError
        Pins that do not hold the body, or leave nothing to touch; a free body of several pieces.
    """
    return _planned(mesh, stiffness, fixed, np.dtype(dtype).itemsize, progress)


def plan_factor(
    mesh: TetMesh,
    stiffness: csr_array,
    fixed: NDArray[np.int64],
    progress: Progress = unwatched,
) -> EliminationPlan:
    """Plan the factor alone, for single columns; otherwise as :func:`plan_surface_inverse`."""
    return _planned(mesh, stiffness, fixed, 0, progress)


def _planned(
    mesh: TetMesh,
    stiffness: csr_array,
    fixed: NDArray[np.int64],
    itemsize: int,
    progress: Progress,
) -> EliminationPlan:
    pins = free_or_pinned(mesh, fixed)
    is_free = not len(pins)
    free = np.setdiff1d(np.arange(len(mesh.nodes)), pins)
    free_surface = np.setdiff1d(mesh.surface_nodes, pins)
    loaded = np.zeros(len(free), dtype=bool)
    loaded[np.searchsorted(free, free_surface)] = True
    progress(0.0)
    matrix = free_blocks(held(mesh.nodes, stiffness) if is_free else stiffness, free)
    progress(0.0)
    edges = matrix.edges
    dissection = dissect(edges, mesh.nodes[free], loaded, progress=progress)
    symbolic = analyse(dissection, edges, loaded)
    memory = memory_by_front(symbolic.fronts)
    dissection = with_least_held(
        dissection,
        [front.needed for front in memory],
        [front.left for front in memory],
        [front.kept for front in memory],
    )
    symbolic = analyse(dissection, edges, loaded)
    matrix = matrix.upper_half(symbolic.place)
    progress(1.0)
    ranks = np.searchsorted(free_surface, free[symbolic.loaded])
    motions = RigidMotions.of(Inertia.of(mesh), mesh.nodes) if is_free else None
    return EliminationPlan(free_surface, matrix, symbolic, ranks, itemsize, motions)
