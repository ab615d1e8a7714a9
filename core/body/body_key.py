"""Key of a compliance: a digest of everything that it depends on."""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import ArrayLike

from ..mesh.tet_mesh import TetMesh

# Version of the key's ingredients, not of the file.
KEY_VERSION = 1


def body_key(
    mesh: TetMesh,
    fixed: ArrayLike,
    poisson_ratio: float,
    formulation: str = "linear",
    young_scale: ArrayLike | None = None,
) -> str:
    """Hex digest of everything the compliance depends on.

    Young's modulus is not part of it, nor is the form of the compliance.

    Parameters
    ----------
    mesh : the tetrahedra.
    fixed : pinned node numbers, in any order.
    poisson_ratio : without unit.
    formulation : of the stiffness; see :mod:`.formulation`.
    young_scale : factor of Young's modulus per tetrahedron, (M,); None where all are 1.
    """
    digest = hashlib.sha256(f"palpate-body {KEY_VERSION}".encode())
    digest.update(mesh.nodes.astype("<f8").tobytes())
    digest.update(mesh.tets.astype("<i8").tobytes())
    digest.update(np.unique(np.asarray(fixed)).astype("<i8").tobytes())
    digest.update(np.float64(poisson_ratio).astype("<f8").tobytes())
    if formulation != "linear":
        digest.update(f"formulation {formulation}".encode())
    if young_scale is not None:
        digest.update(b"young scale")
        digest.update(np.asarray(young_scale).astype("<f8").tobytes())
    return digest.hexdigest()
