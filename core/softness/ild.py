"""Virtual indentation test of foam: the forces by which it is sold (ISO 2439, ASTM D3574).

A slab of 380 x 380 x 100 mm lies on a smooth plate; a flat disc of 323 cm2 goes in by 25, 40 and
65 % of the thickness. Real ones are read after half a minute or a whole one, with the slab kneaded
before: what is left then is what lasts. Here the slab is round, of the same area.

The foam is flexible and of open cells: it is firm until its cells buckle, yields, and is firm again
once they are closed. Over the range of what is sold the shape of that course is much the same, so
one measured law serves, and the force at one depth tells the modulus.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..errors import PalpateError
from ..law.foam import Foam
from ..law.law import Law
from ..law.of_material import law_of
from .pressed_slab import PressedSlab

SIDE, THICKNESS, DISC_AREA = 0.380, 0.100, 0.0323
SHARES = (0.25, 0.40, 0.65)

# Of the presets of foam.
POISSON_RATIO = 0.2
SHALLOW = 0.001


@dataclass(frozen=True)
class IldForces:
    """Forces on the disc, newton, at 25, 40 and 65 % of the thickness.

    Attributes
    ----------
    young_modulus : at small strain, pascal.
    mean_modulus : of a linear slab of Poisson's ratio 0.2 with the same force at 25 %, pascal.
    """

    at_25: float
    at_40: float
    at_65: float
    young_modulus: float
    mean_modulus: float

    @property
    def support_factor(self) -> float:
        """Force at 65 % over that at 25 %; sold foams have 1.5 to 2.8."""
        return self.at_65 / self.at_25


def ild_of_young(young_modulus: float) -> IldForces:
    """Forces of flexible foam with this modulus at small strain, pascal.

    Raises
    ------
    PalpateError
        No positive number.
    """
    if not (np.isfinite(young_modulus) and young_modulus > 0.0):
        raise PalpateError(
            "Young's modulus is {young_modulus} Pa, but must be a positive number; foams of "
            "cushions lie between 5e3 and 1e5 Pa",
            young_modulus=young_modulus,
        )
    at_25, at_40, at_65 = (young_modulus * force for force in _at_one_pascal())
    return IldForces(at_25, at_40, at_65, young_modulus, at_25 / _linear_at_one_pascal())


def ild_of_force(force: float) -> IldForces:
    """The foam that is sold by this force at 25 %, newton.

    Raises
    ------
    PalpateError
        No positive number.
    """
    if not (np.isfinite(force) and force > 0.0):
        raise PalpateError(
            "indentation force is {force} N; give the positive force at 25 %, such as 125 (28 lbf)",
            force=force,
        )
    return ild_of_young(force / _at_one_pascal()[0])


def slab(law: Law, poisson_ratio: float = POISSON_RATIO) -> PressedSlab:
    """The test's slab, of a law."""
    return PressedSlab(
        law,
        poisson_ratio,
        SIDE / float(np.sqrt(np.pi)),
        THICKNESS,
        float(np.sqrt(DISC_AREA / np.pi)),
    )


@lru_cache(maxsize=1)
def _at_one_pascal() -> tuple[float, ...]:
    return tuple(slab(law_of(POISSON_RATIO, "foam")).forces(SHARES).tolist())


@lru_cache(maxsize=1)
def _linear_at_one_pascal() -> float:
    """Force at 25 % of a linear slab of 1 Pa, newton."""
    return float(slab(Foam(POISSON_RATIO)).forces((SHALLOW,))[0] * SHARES[0] / SHALLOW)
