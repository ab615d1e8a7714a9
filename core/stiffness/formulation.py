"""Finite element formulations, and the one that suits a material."""

from __future__ import annotations

from typing import Final

from ..errors import PalpateError

# The paper's: strain constant in each tetrahedron.
LINEAR: Final = "linear"
# Selective edge-based and node-based smoothing of the strain; see strain_smoothing.py.
SMOOTHED: Final = "smoothed"
FORMULATIONS: Final = (LINEAR, SMOOTHED)
AUTOMATIC: Final = "auto"

# From here on linear tetrahedra lock (docs/materials.md).
LOCKING_POISSON_RATIO: Final = 0.4


def formulation_for(choice: str, poisson_ratio: float) -> str:
    """Formulation, one of :data:`FORMULATIONS`, for a material.

    ``"auto"`` takes linear tetrahedra below a Poisson's ratio of :data:`LOCKING_POISSON_RATIO` and
    smoothed ones from there on; any other choice is itself.

    Raises
    ------
    PalpateError
        Unknown choice; names those that exist.
    """
    if choice == AUTOMATIC:
        return SMOOTHED if poisson_ratio >= LOCKING_POISSON_RATIO else LINEAR
    return formulation_checked(choice)


def formulation_checked(name: str) -> str:
    """``name``, if it is one of :data:`FORMULATIONS`.

    Raises
    ------
    PalpateError
        It is none of them.
    """
    if name not in FORMULATIONS:
        raise PalpateError(
            "stiffness: there is no formulation '{name}'; choose {known}, or {automatic} for a "
            "bake",
            name=name,
            known=" or ".join(FORMULATIONS),
            automatic=AUTOMATIC,
        )
    return name
