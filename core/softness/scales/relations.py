"""Relations between Shore values and Young's modulus, each with its range.

Each gives the modulus of a large, thick, linear block on which a durometer reads S. They are
monotonic in S and can be inverted. Real materials differ by a factor of two.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .durometer_type import TYPE_00, TYPE_A, DurometerType
from .indentation import hertz_force, indenter_force, rubber_ball_force

RUBBER_POISSON_RATIO = 0.5
MEGAPASCAL = 1e6


@dataclass(frozen=True)
class Relation:
    """Relation between a Shore value and Young's modulus.

    Attributes
    ----------
    name : for users to choose by.
    scale : "A" or "00".
    lowest, highest : readings, its range.
    rubber_modulus : Young's modulus in pascal at a reading, for a Poisson's ratio of 0.5.
    source : publication.
    """

    name: str
    scale: str
    lowest: float
    highest: float
    rubber_modulus: Callable[[float], float]
    source: str


def gent(reading: float) -> float:
    """Young's modulus in pascal at a Shore A reading: a flat punch of 0.516 mm on the spring.

    Gent 1958, Rubber Chemistry and Technology 31, 896; his radius lies halfway between tip and
    shaft of the indenter.
    """
    force = 0.0981 * (56.0 + 7.62336 * reading)
    return MEGAPASCAL * force / (0.137505 * (254.0 - 2.54 * reading))


def boyce(reading: float) -> float:
    """Young's modulus in pascal at a Shore A reading, from simulations of the test at large strain.

    Qi, Joyce and Boyce 2003, Rubber Chemistry and Technology 76, 419: log10 E = 0.0235 S - 0.6403
    in MPa, for neo-Hookean rubber.
    """
    return float(MEGAPASCAL * 10.0 ** (0.0235 * reading - 0.6403))


def mix(reading: float) -> float:
    """Young's modulus in pascal at a Shore 00 reading: Hertz's ball on the spring.

    Mix and Giacomin 2011, Journal of Testing and Evaluation 39, 696.
    """
    area = hertz_force(TYPE_00.shaft, TYPE_00.depth(reading))
    return _rubber_modulus(TYPE_00, reading, area)


def cone(reading: float) -> float:
    """Young's modulus in pascal at a Shore A reading: the exact cone (Sneddon 1965)."""
    return _rubber_modulus(TYPE_A, reading, indenter_force(TYPE_A, TYPE_A.depth(reading)))


def ball(reading: float) -> float:
    """Young's modulus in pascal at a Shore 00 reading: the exact ball (Segedin 1957)."""
    return _rubber_modulus(TYPE_00, reading, indenter_force(TYPE_00, TYPE_00.depth(reading)))


def deep_ball(reading: float) -> float:
    """Young's modulus in pascal at a Shore 00 reading: the ball as deep in neo-Hookean rubber."""
    area = rubber_ball_force(TYPE_00.shaft, TYPE_00.depth(reading))
    return _rubber_modulus(TYPE_00, reading, area)


def _rubber_modulus(kind: DurometerType, reading: float, area: float) -> float:
    return (1.0 - RUBBER_POISSON_RATIO**2) * kind.force(reading) / area


RELATIONS = {
    relation.name: relation
    for relation in (
        Relation("gent", "A", 10.0, 90.0, gent, "Gent 1958"),
        Relation("boyce", "A", 20.0, 80.0, boyce, "Qi, Joyce and Boyce 2003"),
        Relation("cone", "A", 10.0, 90.0, cone, "Sneddon 1965 with the geometry of ASTM D2240"),
        Relation("mix", "00", 10.0, 90.0, mix, "Mix and Giacomin 2011"),
        Relation("rubber", "00", 10.0, 90.0, deep_ball, "finite elements of neo-Hookean rubber"),
        Relation("ball", "00", 10.0, 90.0, ball, "Segedin 1957 with the geometry of ASTM D2240"),
    )
}
USUAL = {"A": "gent", "00": "mix"}
