"""Whether a compliance that was read is one: finite, symmetric, and no giver of energy.

L of a body at rest is symmetric and positive definite: every force moves its place along, never
against itself. A file may say otherwise, and a device that is told forces by it would be driven.

What is promised, with d_i the blocks L_ii and the energy of forces F the number F L F:

- of every node: L_ii is finite, symmetric and positive definite;
- of up to `NODES_TOGETHER` nodes: L is finite and symmetric, and no forces have an energy below
  -`LEAST` of what they would have if each acted alone (sum F_i d_i F_i): so no eigenvalue of L lies
  below -`LEAST` of the largest;
- of more nodes: the same of so many drawn by lot, anew with each look, `NODES_BY_LOT` where L is
  mapped from its file; where L is held in memory, `PRODUCTS` steps of Lanczos' method find no
  eigenvalue below -`LEAST` of the largest;
- of a compressed L a negative part of up to `OF_TOLERANCE` times its own tolerance is let pass,
  as it comes of rounding.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvalsh_tridiagonal
from scipy.linalg.lapack import spotrf

from ..errors import PalpateError
from .compression.compressed_compliance import CompressedCompliance
from .dense import DenseCompliance
from .mapped import MappedCompliance
from .protocol import Compliance

NODES_TOGETHER = 500
NODES_BY_LOT = 200
PRODUCTS = 48
LEAST = 1e-3
OF_TOLERANCE = 3.0
# Asymmetry of single precision, and of a compliance that is stored by columns.
LARGEST_ASYMMETRY = 1e-4


def refuse_indefinite(compliance: Compliance) -> None:
    """Refuse a compliance with which forces could gain energy; see above for what is promised.

    Raises
    ------
    PalpateError
        Says what is wrong with it.
    """
    blocks = compliance.diagonal()
    _refuse_bad_blocks(blocks)
    least = LEAST
    if isinstance(compliance, CompressedCompliance):
        least = max(LEAST, OF_TOLERANCE * compliance.tolerance)
    count = compliance.node_count
    together = min(count, NODES_TOGETHER if _is_read(compliance) else NODES_BY_LOT)
    lot = np.sort(np.random.default_rng().permutation(count)[:together])
    if isinstance(compliance, MappedCompliance):
        lot = compliance.undamaged(lot)
    _refuse_bad_part(compliance, lot, blocks[lot], least)
    if together < count and _is_read(compliance) and _smallest_share(compliance) < -least:
        raise _gives_energy()


def _is_read(compliance: Compliance) -> bool:
    return not isinstance(compliance, MappedCompliance)


def _refuse_bad_blocks(blocks: NDArray[np.float64]) -> None:
    if not np.isfinite(blocks).all():
        raise PalpateError("its compliance has numbers that are not finite")
    largest = np.abs(blocks).max(axis=(1, 2))
    turned = blocks.transpose(0, 2, 1)
    if np.any(np.abs(blocks - turned).max(axis=(1, 2)) > LARGEST_ASYMMETRY * largest):
        raise PalpateError("its compliance is not symmetric")
    smallest = np.linalg.eigvalsh(blocks)[:, 0]
    if not np.all(smallest > np.finfo(np.float32).eps * largest):
        raise _gives_energy()


def _refuse_bad_part(
    compliance: Compliance, nodes: NDArray[np.int64], blocks: NDArray[np.float64], least: float
) -> None:
    """Refuse L of some nodes (k,), with their ``blocks`` (k, 3, 3), by its Cholesky factor."""
    count = 3 * len(nodes)
    part = compliance.blocks(nodes, nodes).transpose(0, 2, 1, 3).reshape(count, count)
    if not np.isfinite(part).all():
        raise PalpateError("its compliance has numbers that are not finite")
    # In units in which every L_ii is the identity: a small part is then as telling as a large one.
    units = np.linalg.inv(np.linalg.cholesky(0.5 * (blocks + blocks.transpose(0, 2, 1))))
    part = np.einsum("iab,ibjc->iajc", units, part.reshape(-1, 3, len(nodes), 3), optimize=True)
    part = np.einsum("iajc,jdc->iajd", part, units, optimize=True).reshape(count, count)
    if np.abs(part - part.T).max() > LARGEST_ASYMMETRY + (least if least > LEAST else 0.0):
        raise PalpateError("its compliance is not symmetric")
    own = part.reshape(len(nodes), 3, len(nodes), 3)[
        np.arange(len(nodes)), :, np.arange(len(nodes))
    ]
    if np.abs(own - np.eye(3)).max() > LARGEST_ASYMMETRY:
        raise PalpateError("its compliance contradicts its own blocks")
    part[np.diag_indices(count)] += least * (1.0 if least == LEAST else _largest(part))
    _, problem = spotrf(part.astype(np.float32), lower=1, overwrite_a=1, clean=0)
    if problem:
        raise _gives_energy()


def _largest(matrix: NDArray[np.float64]) -> float:
    """A bound of the largest eigenvalue of a symmetric matrix."""
    return float(np.abs(matrix).sum(axis=1).max())


def _smallest_share(compliance: Compliance) -> float:
    """Smallest over largest eigenvalue that Lanczos' method sees after `PRODUCTS` products."""
    rows = 3 * compliance.node_count
    start = np.random.default_rng().standard_normal(rows)
    basis = np.empty((PRODUCTS, rows))
    diagonal, beside = np.empty(PRODUCTS), np.empty(PRODUCTS)
    basis[0] = start / np.linalg.norm(start)
    for step in range(PRODUCTS):
        moved = _product(compliance, basis[step])
        if not np.isfinite(moved).all():
            raise PalpateError("its compliance has numbers that are not finite")
        diagonal[step] = moved @ basis[step]
        # Twice is enough for an orthogonal basis.
        for _ in range(2):
            moved -= basis[: step + 1].T @ (basis[: step + 1] @ moved)
        beside[step] = np.linalg.norm(moved)
        if step + 1 < PRODUCTS:
            basis[step + 1] = moved / beside[step]
    values = eigvalsh_tridiagonal(diagonal, beside[:-1])
    return float(values[0] / values[-1])


def _product(compliance: Compliance, forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """L F for forces on all nodes, flat (3n,)."""
    if isinstance(compliance, DenseCompliance):
        rows = compliance.table.reshape(len(forces), -1)
        moved: NDArray[np.float64] = (forces.astype(rows.dtype) @ rows).astype(np.float64)
        return moved
    return compliance.apply(forces.reshape(-1, 3)).reshape(-1)


def _gives_energy() -> PalpateError:
    return PalpateError("its compliance would give energy to forces, which no body at rest does")
