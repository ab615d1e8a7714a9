"""Settings of a body that nobody holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
    steady : whether a hand keeps the body from sliding and turning: it goes along gravity alone,
        and what else does not balance is carried by all of its mass, as drag is.
    """

    young_modulus: float | None = None
    friction: float = 0.5
    gravity: tuple[float, float, float] = EARTH
    drag_time: float = 0.05
    spacing: float | None = None
    steady: bool = False

    @property
    def let_go(self) -> NDArray[np.float64] | None:
        """The only direction (3,) in the world along which a hand that steadies the body lets it
        go; none without gravity. None without such a hand.
        """
        return down(self.gravity) if self.steady else None


def down(gravity: tuple[float, float, float]) -> NDArray[np.float64]:
    """The direction (3,) of gravity; none without."""
    pull = np.array(gravity)
    return pull / max(float(np.linalg.norm(pull)), np.finfo(float).tiny)


USUAL_REST = RestSettings()
