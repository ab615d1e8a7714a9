"""Compliance of the free surface from the stiffness matrix (paper, eq. 4 to 8)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..mesh.tet_mesh import TetMesh
from ..progress import Progress, unwatched
from .dense import DenseCompliance
from .elimination.inverse import inverse_table
from .elimination.plan import EliminationPlan, plan_surface_inverse
from .elimination.surface_columns import metered_columns
from .elimination.work import Meter


def surface_compliance(
    mesh: TetMesh,
    stiffness: csr_array,
    fixed: NDArray[np.int64],
    progress: Progress = unwatched,
    dtype: type[np.floating] = np.float32,
) -> DenseCompliance:
    """Invert the stiffness for the free surface nodes (paper, eq. 4, restricted as in its text).

    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> from palpate.core.stiffness.assembly import assemble
    >>> mesh, fixed = paper_cube()
    >>> compliance = surface_compliance(mesh, assemble(mesh, poisson_ratio=0.45), fixed)
    >>> compliance.node_count, compliance.block(0, 1).shape
    (73, (3, 3))

    Parameters
    ----------
    mesh : the body.
    stiffness : (3N, 3N) at E = 1 Pa, from :func:`palpate.core.stiffness.assembly.assemble`.
    fixed : numbers of the pinned nodes; none for a free body, see :mod:`.free_body`.
    progress : called with the share of the time done, 0 to 1; may raise to cancel.
    dtype : of the result; the computation is float64.

    Raises
    ------
    PalpateError
        Pins that do not hold the body, or leave nothing to touch; a free body of several pieces.
    """
    plan = plan_surface_inverse(mesh, stiffness, fixed, dtype, lambda _: progress(0.0))
    return planned_compliance(plan, progress, dtype)


def planned_compliance(
    plan: EliminationPlan,
    progress: Progress = unwatched,
    dtype: type[np.floating] = np.float32,
) -> DenseCompliance:
    """Carry out a plan of :func:`palpate.core.compliance.elimination.plan.plan_surface_inverse`."""
    meter = Meter(plan.weight, progress)
    source = metered_columns(plan, meter)
    table = inverse_table(source.factor, source.ranks, dtype, meter, source.rigid)
    progress(1.0)
    return DenseCompliance(plan.free_surface, table)
