"""Settings of a body that nobody holds."""

from __future__ import annotations

from dataclasses import dataclass

EARTH = (0.0, 0.0, -9.81)


@dataclass(frozen=True)
class RestSettings:
    """Settings of a free body.

    Attributes
    ----------
    young_modulus : pascal; None for the body's own.
    friction : Coulomb's coefficient between tools and body; supports have their own.
    gravity : m/s2, in the world.
    drag_time : seconds; under a force the body goes by force over mass times this, metres a second.
        Where it comes to rest does not depend on it, without friction.
    spacing : metres between contact points for supports; None for one that follows the curvature.
    """

    young_modulus: float | None = None
    friction: float = 0.5
    gravity: tuple[float, float, float] = EARTH
    drag_time: float = 0.05
    spacing: float | None = None


USUAL_REST = RestSettings()
