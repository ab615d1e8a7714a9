"""Materials a prop maker knows, as Young's modulus and Poisson's ratio.

Orders of magnitude for soft goods; real batches differ by a factor of two either way.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """A named isotropic material: ``young_modulus`` in pascal, ``poisson_ratio`` without unit."""

    name: str
    young_modulus: float
    poisson_ratio: float


MATERIALS = {
    "PLUSH": Material("Plush toy", 1_000.0, 0.30),
    "JELLY": Material("Jelly", 5_000.0, 0.45),
    "PAPER_CUBE": Material("Soft cube of the paper", 10_000.0, 0.49),
    "FOAM": Material("Upholstery foam", 30_000.0, 0.20),
    "SILICONE_SOFT": Material("Soft silicone (Shore 00-30)", 70_000.0, 0.48),
    "SILICONE_FIRM": Material("Firm silicone (Shore A 20)", 700_000.0, 0.48),
    "RUBBER": Material("Rubber (Shore A 50)", 2_500_000.0, 0.49),
}
