"""Shore values as makers write them, and their conversion to and from Young's modulus."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from scipy.optimize import brentq

from ...errors import PalpateError
from ...sentence import Sentence
from .relations import RELATIONS, RUBBER_POISSON_RATIO, USUAL, Relation

SCALES = tuple(sorted(USUAL))
# Relative tolerance at the ends of a range, below what a durometer resolves.
SLACK = 0.01
# "00-30", "OO 30", "A20", "20A", "20 Shore A", "Shore A 20"; letters O for zeros are common.
_SCALE_FIRST = re.compile(r"(?:SHORE\s*)?(00|OO|A)[\s-]*(\d+(?:\.\d+)?)")
_SCALE_LAST = re.compile(r"(\d+(?:\.\d+)?)\s*(?:SHORE\s*)?(00|OO|A)")


@dataclass(frozen=True)
class Shore:
    """Reading on a Shore scale, "00" or "A"."""

    scale: str
    value: float

    def __str__(self) -> str:
        """Text as makers write it: ``00-30``, ``A 20``."""
        return f"00-{self.value:.3g}" if self.scale == "00" else f"{self.scale} {self.value:.3g}"

    @classmethod
    def parse(cls, text: str) -> Shore:
        """Read ``00-30``, ``A20``, ``20A`` or ``Shore A 20``.

        Raises
        ------
        PalpateError
            Something else.
        """
        word = text.strip().upper()
        first, last = _SCALE_FIRST.fullmatch(word), _SCALE_LAST.fullmatch(word)
        if first is not None:
            scale, value = first.groups()
        elif last is not None:
            value, scale = last.groups()
        else:
            raise PalpateError(
                "'{text}' is not a Shore value of the scales 00 or A; write it as 00-30 or A20",
                text=text,
            )
        return cls("A" if scale == "A" else "00", float(value))


def relation_for(scale: str, name: str | None = None) -> Relation:
    """Relation of this name, or the scale's usual one.

    Raises
    ------
    PalpateError
        An unknown scale or relation, or a relation of another scale.
    """
    if scale not in USUAL:
        raise PalpateError(
            "Shore {scale}: there is no such scale here; choose 00 or A", scale=scale
        )
    relation = RELATIONS.get(USUAL[scale] if name is None else name)
    if relation is None or relation.scale != scale:
        known = ", ".join(known for known in RELATIONS if RELATIONS[known].scale == scale)
        raise PalpateError(
            "relation '{name}': not one of Shore {scale}; choose from {known}",
            name=name,
            scale=scale,
            known=known,
        )
    return relation


def young_from_shore(
    shore: Shore, poisson_ratio: float = RUBBER_POISSON_RATIO, relation: str | None = None
) -> float:
    """Young's modulus in pascal of a large block on which a durometer reads ``shore``.

    >>> round(young_from_shore(Shore.parse("00-30")), -3)
    103000.0

    A durometer senses E / (1 - nu^2); the relations, which are for rubber, nu = 0.5, are converted
    by that.

    Raises
    ------
    PalpateError
        A reading outside the relation's range; an unknown scale or relation.
    """
    chosen = relation_for(shore.scale, relation)
    if not chosen.lowest <= shore.value <= chosen.highest:
        raise PalpateError(
            "Shore {shore}: {source}'s relation holds from {lowest:g} to {highest:g}; {remedy}",
            shore=shore,
            source=chosen.source,
            lowest=chosen.lowest,
            highest=chosen.highest,
            remedy=_neighbour(shore, chosen),
        )
    return chosen.rubber_modulus(shore.value) * _against_rubber(poisson_ratio)


def shore_from_young(
    young_modulus: float,
    scale: str,
    poisson_ratio: float = RUBBER_POISSON_RATIO,
    relation: str | None = None,
) -> Shore:
    """Reading of this scale's durometer on a large block of ``young_modulus``, pascal.

    Raises
    ------
    PalpateError
        No positive number; softer or firmer than the relation's range says; an unknown scale or
        relation.
    """
    if not (math.isfinite(young_modulus) and young_modulus > 0.0):
        raise PalpateError(
            "Young's modulus {young_modulus:g} Pa: nothing has it; give a positive number",
            young_modulus=young_modulus,
        )
    chosen = relation_for(scale, relation)
    softest, firmest = young_range(scale, poisson_ratio, relation)
    if not (1.0 - SLACK) * softest <= young_modulus <= (1.0 + SLACK) * firmest:
        low, high = Shore(scale, chosen.lowest), Shore(scale, chosen.highest)
        raise PalpateError(
            "Young's modulus {young_modulus:g} Pa: the scale Shore {scale} is used from {low} to "
            "{high}, which is {softest:.3g} to {firmest:.3g} Pa; {remedy}",
            young_modulus=young_modulus,
            scale=scale,
            low=low,
            high=high,
            softest=softest,
            firmest=firmest,
            remedy=_other_scale(scale, young_modulus < softest),
        )
    rubber = young_modulus / _against_rubber(poisson_ratio)
    # Within the tolerance at the ends there is no change of sign.
    if rubber <= chosen.rubber_modulus(chosen.lowest):
        return Shore(scale, chosen.lowest)
    if rubber >= chosen.rubber_modulus(chosen.highest):
        return Shore(scale, chosen.highest)
    value = brentq(
        lambda reading: math.log(chosen.rubber_modulus(reading) / rubber),
        chosen.lowest,
        chosen.highest,
        xtol=1e-9,
    )
    return Shore(scale, float(value))


def young_range(
    scale: str, poisson_ratio: float = RUBBER_POISSON_RATIO, relation: str | None = None
) -> tuple[float, float]:
    """Young's modulus in pascal at the ends of a relation's range."""
    chosen = relation_for(scale, relation)
    factor = _against_rubber(poisson_ratio)
    lowest, highest = (chosen.rubber_modulus(end) for end in (chosen.lowest, chosen.highest))
    return factor * lowest, factor * highest


def _against_rubber(poisson_ratio: float) -> float:
    """Ratio of 1 - nu^2 to that of rubber.

    Raises
    ------
    PalpateError
        A Poisson's ratio that no material has.
    """
    if not -1.0 < poisson_ratio <= 0.5:
        raise PalpateError(
            "Poisson's ratio {poisson_ratio:g}: no stable material has it; give one above -1 and "
            "up to 0.5",
            poisson_ratio=poisson_ratio,
        )
    return (1.0 - poisson_ratio**2) / (1.0 - RUBBER_POISSON_RATIO**2)


def _neighbour(shore: Shore, chosen: Relation) -> Sentence:
    if shore.scale == "A" and shore.value < chosen.lowest:
        return Sentence("use the scale 00, or give Young's modulus itself")
    if shore.scale == "00" and shore.value >= chosen.lowest:
        return Sentence("use the scale A, or give Young's modulus itself")
    return Sentence("give Young's modulus itself")


def _other_scale(scale: str, too_soft: bool) -> Sentence:
    other = "00" if too_soft else "A"
    if other == scale:
        return Sentence("keep to Young's modulus")
    return Sentence("try the scale {scale}, or keep to Young's modulus", scale=other)
