"""A body with its compliance, of a mesh and its pins."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.compliance.surface_compliance import surface_compliance
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.stiffness.assembly import assemble


def baked_body(
    mesh: TetMesh,
    fixed: ArrayLike,
    poisson_ratio: float = 0.3,
    young_modulus: float = 10_000.0,
    formulation: str = "linear",
    young_scale: NDArray[np.float64] | None = None,
    dtype: type[np.floating] = np.float32,
    density: float | None = None,
) -> SoftBody:
    """As a bake makes it, in memory; the compliance in ``dtype``. Without pins, a free body."""
    stiffness = assemble(mesh, poisson_ratio, formulation=formulation, young_scale=young_scale)
    table = surface_compliance(mesh, stiffness, fixed, dtype=dtype)
    pins = np.unique(np.asarray(fixed, dtype=np.int64))
    return SoftBody(
        mesh,
        pins,
        poisson_ratio,
        table,
        young_modulus,
        formulation,
        young_scale,
        density=density,
    )
