"""Settings of bodies that press each other."""

from __future__ import annotations

from dataclasses import dataclass

from ..rest.rest_settings import EARTH


@dataclass(frozen=True)
class PileSettings:
    """Settings of a pile.

    Attributes
    ----------
    friction : Coulomb's coefficient between bodies; supports have their own.
    tool_friction : that between tools and bodies; None for the same.
    gravity : m/s2, in the world.
    drag_time : seconds, as of one free body (``RestSettings``).
    spacing : metres between contact points of all bodies; None for one that follows the curvature.
    steady : numbers of bodies that a hand keeps from sliding and turning (``RestSettings``).
    """

    friction: float = 0.5
    tool_friction: float | None = None
    gravity: tuple[float, float, float] = EARTH
    drag_time: float = 0.05
    spacing: float | None = None
    steady: tuple[int, ...] = ()


USUAL_PILE = PileSettings()
