"""Single columns of the compliance on demand, from a factor smaller than the full table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dgemm
from scipy.sparse import csr_array

from ...mesh.tet_mesh import TetMesh
from ...progress import Progress, unwatched
from ...stiffness.freedoms import freedoms
from ..free_body.carried_loads import CarriedLoads
from ..free_body.rigid_part import RigidPart
from .numeric import LoadRows, inverse_factor
from .plan import EliminationPlan, plan_factor
from .work import Meter


@dataclass(frozen=True, eq=False)
class SurfaceColumns:
    """Compliance of the free surface as its factor W, L = W^T W, in float64.

    W has a row for every node of a front that loads reach, and a column for each load from that
    part of the body. A column of L needs the fronts from its node to the root, no solve.

    Attributes
    ----------
    free_surface : int64 (n,), node numbers, ascending.
    factor : the fronts' rows of W; loads in order of elimination.
    ranks : int64 (n,), for each loaded node in that order, its place in ``free_surface``.
    rigid : of a body without pins, in order of elimination: what is taken away from W^T W.
    """

    free_surface: NDArray[np.int64]
    factor: tuple[LoadRows, ...]
    ranks: NDArray[np.int64]
    rigid: RigidPart | None = None

    @property
    def node_count(self) -> int:
        """Number of free surface nodes, n."""
        return len(self.free_surface)

    @property
    def nbytes(self) -> int:
        """Bytes of the factor."""
        return sum(part.rows.nbytes for part in self.factor)

    def columns(self, nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        """The columns of L for forces on ``nodes`` (k,), as a matrix (3n, 3k), float64.

        Nodes are counted by their place in ``free_surface``. Nodes near each other share most
        fronts: cheapest together.
        """
        order = np.argsort(self.ranks)
        wanted = freedoms(order[nodes])
        eliminated = np.zeros((3 * self.node_count, len(wanted)))
        for part in self.factor:
            reached = np.flatnonzero((wanted >= part.start) & (wanted < part.stop))
            if reached.size:
                loaded = part.rows[:, wanted[reached] - part.start]
                moved = dgemm(1.0, part.rows, loaded, trans_a=True)
                target = eliminated[part.start : part.stop]
                if len(reached) == len(wanted):
                    target += moved
                else:
                    target[:, reached] += moved
        if self.rigid is not None:
            eliminated -= self.rigid.against(self.rigid.at(wanted))
        by_node = eliminated.reshape(self.node_count, 3, -1)
        return by_node[order].reshape(3 * self.node_count, -1)

    def diagonal(self) -> NDArray[np.float64]:
        """All blocks L_ii, (n, 3, 3), without full columns."""
        eliminated = np.zeros((self.node_count, 3, 3))
        for part in self.factor:
            loads = part.rows.T.reshape((part.stop - part.start) // 3, 3, -1)
            eliminated[part.start // 3 : part.stop // 3] += loads @ loads.transpose(0, 2, 1)
        if self.rigid is not None:
            eliminated -= self.rigid.diagonal()
        return eliminated[np.argsort(self.ranks)]


def factor_for_columns(
    mesh: TetMesh,
    stiffness: csr_array,
    fixed: NDArray[np.int64],
    progress: Progress = unwatched,
) -> SurfaceColumns:
    """Factor the stiffness for single columns of the compliance.

    Parameters
    ----------
    mesh : the body.
    stiffness : (3N, 3N) at E = 1 Pa.
    fixed : numbers of the pinned nodes; none for a free body.
    progress : called with the share of the time done, 0 to 1; may raise to cancel.

    Raises
    ------
    PalpateError
        Pins that do not hold the body, or leave nothing to touch.
    """
    plan = plan_factor(mesh, stiffness, fixed, lambda _: progress(0.0))
    return planned_columns(plan, progress)


def planned_columns(plan: EliminationPlan, progress: Progress = unwatched) -> SurfaceColumns:
    """Carry out a plan of :func:`palpate.core.compliance.elimination.plan.plan_factor`."""
    columns = metered_columns(plan, Meter(plan.weight, progress))
    progress(1.0)
    return columns


def metered_columns(plan: EliminationPlan, meter: Meter) -> SurfaceColumns:
    """The same as a part of a work that is metered as a whole."""
    if plan.motions is None:
        factor = inverse_factor(plan.matrix, plan.symbolic, meter)
        return SurfaceColumns(plan.free_surface, tuple(factor), plan.ranks)
    carried = CarriedLoads(plan.motions.loads, plan.symbolic)
    factor = inverse_factor(plan.matrix, plan.symbolic, meter, carried)
    modes = plan.motions.modes[freedoms(plan.symbolic.loaded)]
    rigid = RigidPart.of(modes, carried.moved, carried.energy)
    return SurfaceColumns(plan.free_surface, tuple(factor), plan.ranks, rigid)
