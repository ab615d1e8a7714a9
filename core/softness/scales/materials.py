"""Material presets for prop makers: Young's modulus, Poisson's ratio and density, with sources.

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

from ...law.of_material import RUBBER
from .shore import Shore, young_from_shore

TENSILE = (
    "Marechal et al. 2021, Soft Robotics 8, 284: neo-Hookean fit of their tensile data up to 30 % "
    "strain; Shore and density by Smooth-On's data sheet"
)
NGUYEN = "Nguyen et al. 2014, Ultrasound in Medicine and Biology 40, 168"
SLAB = (
    "by the law of foam, an indentation load deflection (ASTM D3574: disc of 323 cm2, 25 % of a "
    "slab of 380 x 380 x 100 mm)"
)


@dataclass(frozen=True)
class Material:
    """Named isotropic material.

    Attributes
    ----------
    name : in panels and tables.
    young_modulus : pascal, at small strain.
    poisson_ratio : without unit.
    density : kilograms per cubic metre.
    source : of the figures.
    basis : "measured", "derived" or "estimate"; see above.
    shore : by the data sheet, where it gives one.
    relaxation : how it gives way with time, a key of
        :data:`palpate.core.law.relaxation.RELAXATIONS`.
    law : how it gives way at depth, a key of :data:`palpate.core.law.of_material.LAWS`.
    """

    name: str
    young_modulus: float
    poisson_ratio: float
    density: float
    source: str = "order of magnitude"
    basis: str = "estimate"
    shore: Shore | None = None
    relaxation: str = "NONE"
    law: str = RUBBER


def _silicone(name: str, shore: Shore, young_modulus: float, density: float) -> Material:
    """Silicone by Smooth-On, as it was pulled."""
    return Material(name, young_modulus, 0.48, density, TENSILE, "measured", shore)


def _eva() -> Material:
    shore = Shore("A", 30.0)
    return Material(
        "EVA foam (Shore A 30)",
        float(f"{young_from_shore(shore, 0.40):.3g}"),
        0.40,
        200.0,
        "EVA sheet sold by its Shore value; the relation is for rubber and stretched here to foam",
        "derived",
        shore,
    )


# Files refer to the first seven by number: add new ones at the end only.
MATERIALS = {
    "PLUSH": Material(
        "Plush toy",
        1_000.0,
        0.30,
        40.0,
        "order of magnitude; density with its cloth, of a bear of 300 g and 7.5 litres",
        law="fibres",
    ),
    "JELLY": Material(
        "Jelly",
        5_000.0,
        0.45,
        1_000.0,
        f"a little softer than gelatine of 3 % ({NGUYEN}: 6.0 kPa); density of water",
    ),
    "PAPER_CUBE": Material(
        "Paper's soft cube",
        10_000.0,
        0.49,
        1_000.0,
        "Poisson's ratio of Hirota and Kaneko 1999; modulus an order of magnitude, density water's",
    ),
    "FOAM": Material(
        "Upholstery foam",
        30_000.0,
        0.20,
        35.0,
        f"{SLAB} of 22 lbf (96 N): a soft cushion; density of seats, which have 1.5 to 2.5 lb/ft3",
        law="foam",
    ),
    "SILICONE_SOFT": Material(
        "Soft silicone (Shore 00-30)",
        51_000.0,
        0.48,
        1_070.0,
        "as Ecoflex 00-30 below",
        shore=Shore("00", 30.0),
    ),
    "SILICONE_FIRM": Material(
        "Firm silicone (Shore A 20)",
        394_000.0,
        0.48,
        1_080.0,
        "as Dragon Skin 20 below",
        shore=Shore("A", 20.0),
    ),
    "RUBBER": Material(
        "Rubber (Shore A 50)",
        2_200_000.0,
        0.49,
        1_080.0,
        "natural rubber of 50 IRHD by Lindley 1978, Engineering design with natural rubber; "
        "density of a mixture with 30 parts of carbon black in 100",
        "measured",
        Shore("A", 50.0),
        law="natural-rubber",
    ),
    "ECOFLEX_10": _silicone("Ecoflex 00-10", Shore("00", 10.0), 29_000.0, 1_040.0),
    "ECOFLEX_20": Material(
        "Ecoflex 00-20",
        38_000.0,
        0.48,
        1_070.0,
        "between Ecoflex 00-10 and 00-30; Shore and density by Smooth-On's data sheet",
        shore=Shore("00", 20.0),
    ),
    "ECOFLEX_30": _silicone("Ecoflex 00-30", Shore("00", 30.0), 51_000.0, 1_070.0),
    "ECOFLEX_50": _silicone("Ecoflex 00-50", Shore("00", 50.0), 74_000.0, 1_070.0),
    "DRAGON_SKIN_10": _silicone("Dragon Skin 10", Shore("A", 10.0), 147_000.0, 1_070.0),
    "DRAGON_SKIN_20": _silicone("Dragon Skin 20", Shore("A", 20.0), 394_000.0, 1_080.0),
    "DRAGON_SKIN_30": _silicone("Dragon Skin 30", Shore("A", 30.0), 587_000.0, 1_080.0),
    "PU_FOAM_SOFT": Material(
        "Soft polyurethane foam",
        25_000.0,
        0.20,
        25.0,
        f"{SLAB} of 18 lbf (80 N)",
        law="foam",
    ),
    "LATEX_FOAM": Material(
        "Latex foam",
        39_000.0,
        0.20,
        75.0,
        f"{SLAB} of 28 lbf (125 N)",
        law="foam",
    ),
    "EVA_FOAM": _eva(),
    "GELATINE_3": Material(
        "Gelatine 3 %",
        6_000.0,
        0.49,
        1_000.0,
        f"{NGUYEN}: shear modulus 2.0 kPa, times 3",
        "measured",
        relaxation="GEL",
    ),
    "GELATINE_5": Material(
        "Gelatine 5 %",
        12_500.0,
        0.49,
        1_010.0,
        f"{NGUYEN}: shear modulus 4.2 kPa, times 3",
        "measured",
        relaxation="GEL",
    ),
    "BALLISTIC_GEL": Material(
        "Ballistic gel 10 %",
        60_000.0,
        0.49,
        1_030.0,
        f"carried on from 3 to 7 % gelatine ({NGUYEN}) with their exponent of 1.9",
        relaxation="GEL",
    ),
    "STUFFING": Material(
        "Firm toy stuffing",
        3_000.0,
        0.20,
        30.0,
        "order of magnitude; the plush toy above, filled tighter",
        law="fibres",
    ),
    "FLESH": Material(
        "Skin over flesh",
        8_000.0,
        0.48,
        1_050.0,
        "what an indenter feels on a forearm as a whole, about 5 to 10 kPa; order of "
        "magnitude after Pailler-Mattei et al. 2008, Medical Engineering and Physics 30, 599",
        relaxation="FLESH",
    ),
    "MEMORY_FOAM": Material(
        "Memory foam",
        16_000.0,
        0.20,
        55.0,
        f"{SLAB} of 12 lbf (53 N)",
        relaxation="MEMORY_FOAM",
        law="foam",
    ),
    "CHEWING_GUM": Material(
        "Chewing gum",
        2_000.0,
        0.48,
        1_150.0,
        "order of magnitude of what lasts",
        relaxation="CHEWING_GUM",
    ),
}
