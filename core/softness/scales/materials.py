"""Material presets for prop makers: Young's modulus and Poisson's ratio, each with its source.

The modulus is that of small strain, where light touch lives; what a material does beyond is its
law's (:mod:`palpate.core.law`). A Shore value is what the tin says: a durometer goes in by strains
of about one, and makers' silicones read two to three times as firm by it as they are when pulled
a little.

Real batches differ by a factor of two either way. ``basis`` is the origin of a modulus:

measured    by the named paper
derived     from the Shore value on the data sheet by the usual relation of its scale, for want of a
            tensile test
estimate    from descriptions, from what is alike, or an order of magnitude
"""

from __future__ import annotations

from dataclasses import dataclass

from .shore import Shore, young_from_shore

TENSILE = (
    "Marechal et al. 2021, Soft Robotics 8, 284: neo-Hookean fit of their tensile data up to 30 % "
    "strain; Shore and density by Smooth-On's data sheet"
)
NGUYEN = "Nguyen et al. 2014, Ultrasound in Medicine and Biology 40, 168"
SLAB = (
    "which a slab of 380 x 380 x 100 mm on a smooth plate gives: the mean of what is firm at first "
    "and yields"
)


@dataclass(frozen=True)
class Material:
    """Named isotropic material.

    Attributes
    ----------
    name : in panels and tables.
    young_modulus : pascal, at small strain.
    poisson_ratio : without unit.
    source : of the figures.
    basis : "measured", "derived" or "estimate"; see above.
    shore : by the data sheet, where it gives one.
    density : kilograms per cubic metre, where it is known.
    """

    name: str
    young_modulus: float
    poisson_ratio: float
    source: str = "order of magnitude"
    basis: str = "estimate"
    shore: Shore | None = None
    density: float | None = None


def _silicone(name: str, shore: Shore, young_modulus: float, density: float) -> Material:
    """Silicone by Smooth-On, as it was pulled."""
    return Material(name, young_modulus, 0.48, TENSILE, "measured", shore, density)


def _eva() -> Material:
    shore = Shore("A", 30.0)
    return Material(
        "EVA foam (Shore A 30)",
        float(f"{young_from_shore(shore, 0.40):.3g}"),
        0.40,
        "EVA sheet sold by its Shore value; the relation is for rubber and stretched here to foam",
        "derived",
        shore,
        200.0,
    )


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
    "SILICONE_SOFT": Material(
        "Soft silicone (Shore 00-30)",
        51_000.0,
        0.48,
        "as Ecoflex 00-30 below",
        shore=Shore("00", 30.0),
    ),
    "SILICONE_FIRM": Material(
        "Firm silicone (Shore A 20)",
        394_000.0,
        0.48,
        "as Dragon Skin 20 below",
        shore=Shore("A", 20.0),
    ),
    "RUBBER": Material(
        "Rubber (Shore A 50)",
        2_200_000.0,
        0.49,
        "natural rubber of 50 IRHD by Lindley 1978, Engineering design with natural rubber",
        "measured",
        Shore("A", 50.0),
    ),
    "ECOFLEX_10": _silicone("Ecoflex 00-10", Shore("00", 10.0), 29_000.0, 1_040.0),
    "ECOFLEX_20": Material(
        "Ecoflex 00-20",
        38_000.0,
        0.48,
        "between Ecoflex 00-10 and 00-30; Shore and density by Smooth-On's data sheet",
        shore=Shore("00", 20.0),
        density=1_070.0,
    ),
    "ECOFLEX_30": _silicone("Ecoflex 00-30", Shore("00", 30.0), 51_000.0, 1_070.0),
    "ECOFLEX_50": _silicone("Ecoflex 00-50", Shore("00", 50.0), 74_000.0, 1_070.0),
    "DRAGON_SKIN_10": _silicone("Dragon Skin 10", Shore("A", 10.0), 147_000.0, 1_070.0),
    "DRAGON_SKIN_20": _silicone("Dragon Skin 20", Shore("A", 20.0), 394_000.0, 1_080.0),
    "DRAGON_SKIN_30": _silicone("Dragon Skin 30", Shore("A", 30.0), 587_000.0, 1_080.0),
    "PU_FOAM_SOFT": Material(
        "Soft polyurethane foam",
        7_000.0,
        0.20,
        f"indentation load deflection of 18 lbf (80 N on 323 cm2 at 25 %), {SLAB}",
        density=25.0,
    ),
    "LATEX_FOAM": Material(
        "Latex foam",
        11_000.0,
        0.20,
        f"indentation load deflection of 28 lbf (125 N on 323 cm2 at 25 %), {SLAB}",
        density=75.0,
    ),
    "EVA_FOAM": _eva(),
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
