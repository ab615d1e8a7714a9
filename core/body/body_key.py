"""Key of a compliance: a digest of everything that it depends on."""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
    scale = None if young_scale is None else np.asarray(young_scale)
    # Two ways to write the same body: -0.0 is 0.0, and a factor of 1 everywhere is none.
    varies = scale is not None and not np.array_equal(scale, np.ones_like(scale))
    return _digest(
        mesh.nodes + 0.0, mesh.tets, fixed, poisson_ratio, formulation, scale if varies else None
    )


def is_key_of(
    key: str,
    mesh: TetMesh,
    fixed: ArrayLike,
    poisson_ratio: float,
    formulation: str = "linear",
    young_scale: ArrayLike | None = None,
) -> bool:
    """Whether ``key`` is that of a body, by :func:`body_key` or as files from before it knew that
    -0.0 is 0.0 have it.
    """
    return key in {
        body_key(mesh, fixed, poisson_ratio, formulation, young_scale),
        _digest(mesh.nodes, mesh.tets, fixed, poisson_ratio, formulation, young_scale),
    }


def _digest(
    nodes: NDArray[np.float64],
    tets: NDArray[np.int64],
    fixed: ArrayLike,
    poisson_ratio: float,
    formulation: str,
    young_scale: ArrayLike | None,
) -> str:
    digest = hashlib.sha256(f"palpate-body {KEY_VERSION}".encode())
    digest.update(nodes.astype("<f8").tobytes())
    digest.update(tets.astype("<i8").tobytes())
    digest.update(np.unique(np.asarray(fixed)).astype("<i8").tobytes())
    digest.update(np.float64(poisson_ratio).astype("<f8").tobytes())
    if formulation != "linear":
        digest.update(f"formulation {formulation}".encode())
    if young_scale is not None:
        digest.update(b"young scale")
        digest.update(np.asarray(young_scale).astype("<f8").tobytes())
    return digest.hexdigest()
