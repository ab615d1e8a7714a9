"""Material presets for prop makers: Young's modulus and Poisson's ratio, each with its source.

Real batches differ by a factor of two either way. ``basis`` is the origin of a modulus:

measured    by the named paper
derived     from the Shore value on the data sheet by the usual relation of its scale, so that a
            virtual durometer reads the data sheet's value; ``measured_modulus`` is that of
            published tensile tests
estimate    from descriptions, or an order of magnitude
"""

from __future__ import annotations

from dataclasses import dataclass

from .shore import Shore, young_from_shore

SMOOTH_ON = "Shore and density by Smooth-On's data sheet; modulus derived from the Shore value"
TENSILE = (
    "; measured: Marechal et al. 2021, Soft Robotics 8, 284, neo-Hookean fit of their tensile data "
    "up to 30 % strain"
)
NGUYEN = "Nguyen et al. 2014, Ultrasound in Medicine and Biology 40, 168"


@dataclass(frozen=True)
class Material:
    """Named isotropic material.

    Attributes
    ----------
    name : in panels and tables.
    young_modulus : pascal.
    poisson_ratio : without unit.
    source : of the figures.
    basis : "measured", "derived" or "estimate"; see above.
    shore : by the data sheet, where it gives one.
    density : kilograms per cubic metre, where it is known.
    measured_modulus : pascal, by tensile tests at small strain, where ``basis`` is another.
    """

    name: str
    young_modulus: float
    poisson_ratio: float
    source: str = "order of magnitude"
    basis: str = "estimate"
    shore: Shore | None = None
    density: float | None = None
    measured_modulus: float | None = None


def _by_shore(
    name: str,
    shore: Shore,
    source: str = "any silicone of this Shore value",
    poisson_ratio: float = 0.48,
    density: float | None = None,
    measured_modulus: float | None = None,
) -> Material:
    """Material with the modulus of its Shore value, to three digits."""
    young = float(f"{young_from_shore(shore, poisson_ratio):.3g}")
    return Material(name, young, poisson_ratio, source, "derived", shore, density, measured_modulus)


def _smooth_on(
    name: str, shore: Shore, density: float, measured_modulus: float | None = None
) -> Material:
    """Silicone by Smooth-On."""
    source = SMOOTH_ON if measured_modulus is None else SMOOTH_ON + TENSILE
    return _by_shore(name, shore, source, 0.48, density, measured_modulus)


# Files refer to the first seven by number: add new ones at the end only.
MATERIALS = {
    "PLUSH": Material("Plush toy", 1_000.0, 0.30),
    "JELLY": Material(
        "Jelly", 5_000.0, 0.45, f"a little softer than gelatine of 3 % ({NGUYEN}: 6.0 kPa)"
    ),
    "PAPER_CUBE": Material(
        "Paper's soft cube",
        10_000.0,
        0.49,
        "Poisson's ratio of Hirota and Kaneko 1999; modulus an order of magnitude",
    ),
    "FOAM": Material("Upholstery foam", 30_000.0, 0.20),
    "SILICONE_SOFT": _by_shore("Soft silicone (Shore 00-30)", Shore("00", 30.0)),
    "SILICONE_FIRM": _by_shore("Firm silicone (Shore A 20)", Shore("A", 20.0)),
    "RUBBER": Material(
        "Rubber (Shore A 50)",
        2_500_000.0,
        0.49,
        "any rubber of this Shore value",
        "derived",
        Shore("A", 50.0),
    ),
    "ECOFLEX_10": _smooth_on("Ecoflex 00-10", Shore("00", 10.0), 1_040.0, 29_000.0),
    "ECOFLEX_20": _smooth_on("Ecoflex 00-20", Shore("00", 20.0), 1_070.0),
    "ECOFLEX_30": _smooth_on("Ecoflex 00-30", Shore("00", 30.0), 1_070.0, 51_000.0),
    "ECOFLEX_50": _smooth_on("Ecoflex 00-50", Shore("00", 50.0), 1_070.0, 74_000.0),
    "DRAGON_SKIN_10": _smooth_on("Dragon Skin 10", Shore("A", 10.0), 1_070.0, 147_000.0),
    "DRAGON_SKIN_20": _smooth_on("Dragon Skin 20", Shore("A", 20.0), 1_080.0, 394_000.0),
    "DRAGON_SKIN_30": _smooth_on("Dragon Skin 30", Shore("A", 30.0), 1_080.0, 587_000.0),
    "PU_FOAM_SOFT": Material(
        "Soft polyurethane foam",
        10_000.0,
        0.20,
        "secant of an indentation load deflection of 18 lbf (80 N on 323 cm2 at 25 %)",
        density=25.0,
    ),
    "LATEX_FOAM": Material(
        "Latex foam",
        15_000.0,
        0.20,
        "secant of an indentation load deflection of 28 lbf (125 N on 323 cm2 at 25 %)",
        density=75.0,
    ),
    "EVA_FOAM": _by_shore(
        "EVA foam (Shore A 30)",
        Shore("A", 30.0),
        "EVA sheet sold by its Shore value; the relation is for rubber and stretched here to foam",
        poisson_ratio=0.40,
        density=200.0,
    ),
    "GELATINE_3": Material(
        "Gelatine 3 %",
        6_000.0,
        0.49,
        f"{NGUYEN}: shear modulus 2.0 kPa, times 3",
        "measured",
        density=1_000.0,
    ),
    "GELATINE_5": Material(
        "Gelatine 5 %",
        12_500.0,
        0.49,
        f"{NGUYEN}: shear modulus 4.2 kPa, times 3",
        "measured",
        density=1_010.0,
    ),
    "BALLISTIC_GEL": Material(
        "Ballistic gel 10 %",
        60_000.0,
        0.49,
        f"carried on from 3 to 7 % gelatine ({NGUYEN}) with their exponent of 1.9",
        density=1_030.0,
    ),
    "STUFFING": Material(
        "Firm toy stuffing",
        3_000.0,
        0.20,
        "order of magnitude; the plush toy above, filled tighter",
        density=30.0,
    ),
    "FLESH": Material(
        "Skin over flesh",
        8_000.0,
        0.48,
        "what an indenter feels on a forearm as a whole, about 5 to 10 kPa; order of "
        "magnitude after Pailler-Mattei et al. 2008, Medical Engineering and Physics 30, 599",
        density=1_050.0,
    ),
}
