"""Finite element formulations."""

from __future__ import annotations

from typing import Final

from ..errors import PalpateError

# Selective edge-based and node-based smoothing of the strain; see strain_smoothing.py.
SMOOTHED: Final = "smoothed"
# The paper's: strain constant in each tetrahedron.
LINEAR: Final = "linear"
FORMULATIONS: Final = (SMOOTHED, LINEAR)

# From here on linear tetrahedra lock (docs/materials.md).
LOCKING_POISSON_RATIO: Final = 0.4


def formulation_checked(name: str) -> str:
    """``name``, if it is one of :data:`FORMULATIONS`.

    Raises
    ------
    PalpateError
        It is none of them.
    """
    if name not in FORMULATIONS:
        raise PalpateError(
            "stiffness: there is no formulation '{name}'; choose {known}",
            name=name,
            known=" or ".join(FORMULATIONS),
        )
    return name
