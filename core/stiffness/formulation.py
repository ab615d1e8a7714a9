"""Which finite element formulation makes the stiffness matrix, and which one suits a material."""

from __future__ import annotations

from typing import Final

from ..errors import PalpateError

# The paper's: strain constant in each tetrahedron.
LINEAR: Final = "linear"
# Selective edge-based and node-based smoothing of the strain; see strain_smoothing.py.
SMOOTHED: Final = "smoothed"
FORMULATIONS: Final = (LINEAR, SMOOTHED)
AUTOMATIC: Final = "auto"

# From here on linear tetrahedra are far too stiff for what they stand for (docs/materials.md).
LOCKING_POISSON_RATIO: Final = 0.4


def formulation_for(choice: str, poisson_ratio: float) -> str:
    """The formulation, one of :data:`FORMULATIONS`, that ``choice`` means for a material.

    ``"auto"`` takes linear tetrahedra below a Poisson's ratio of :data:`LOCKING_POISSON_RATIO` and
    the smoothed ones from there on; any other choice stands for itself.

    Raises
    ------
    PalpateError
        A choice that does not exist; names those that do.
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
            f"stiffness: there is no formulation '{name}'; choose {' or '.join(FORMULATIONS)}, "
            f"or {AUTOMATIC} for a bake"
        )
    return name
