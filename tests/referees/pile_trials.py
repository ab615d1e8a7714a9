"""One body laid down anyhow on another, dropped, pressed, pinched and lifted, and what must hold.

As of one body (``rest_trials.py``): in no tick the energy of both grows by more than hands put in,
neither sinks into the floor or leaves the rest of itself, and at the end the floor bears both. Nor
is one within the other then.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from palpate.core.contact.tool.pose import Pose
from palpate.core.mesh.closest_point import ClosestPoints
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.winding_volume import is_inside
from palpate.core.pile.pile import Pile
from palpate.core.pile.pile_settings import PileSettings
from palpate.core.rest.rest import Rest
from palpate.core.rest.support import Floor

from .rest_trials import (
    ALONE,
    KINDS,
    Hands,
    Outcome,
    Trial,
    hands_for,
    shapes,
)

# Of the size: how far a corner of one body may be in the other at the end, between contact points.
MOST_WITHIN = 0.05
# They fall from so high, m, and as far aside at most.
APART, ASIDE = 2e-3, 0.012


@dataclass(frozen=True)
class PileOutcome(Outcome):
    """What became of a trial of two.

    Attributes
    ----------
    within : how deep a corner of one was in the other at the end, as a share of the larger's size.
    """

    within: float

    @property
    def holds(self) -> bool:
        """Whether nothing exploded, fell through or gained energy."""
        return super().holds and self.within <= MOST_WITHIN


def pile_trial(seed: int) -> PileOutcome:
    """The outcome of the trial with this seed, of the kind ``KINDS[seed % 4]``."""
    random = np.random.default_rng(seed)
    bodies = [shapes()[int(random.integers(len(shapes())))] for _ in range(2)]
    turns = [Rotation.random(random_state=random).as_matrix() for _ in bodies]
    heights = [(body.mesh.nodes @ turn.T)[:, 2] for body, turn in zip(bodies, turns, strict=True)]
    beneath = APART - heights[0].min()
    above = beneath + heights[0].max() + APART - heights[1].min()
    placements = [
        Pose.at([0.0, 0.0, beneath], turns[0]),
        Pose.at([*random.uniform(-ASIDE, ASIDE, 2), above], turns[1]),
    ]
    floors = [Floor(friction=float(random.choice([0.0, 0.2, 0.8])))]
    settings = PileSettings(
        friction=float(random.choice([0.0, 0.3, 0.8])),
        tool_friction=float(random.choice([0.0, 0.3, 1.0])),
        drag_time=float(random.uniform(0.02, 0.1)),
    )
    tried = Trial(bodies)
    pile = Pile(list(zip(bodies, placements, strict=True)), floors, settings=settings)
    rests = tried.go(pile, ALONE, 1e-3)
    kind = KINDS[seed % len(KINDS)]
    if kind != "settle":
        hands = hands_for(kind, random, rests[1].surface())
        # Hands beside the upper body may stand in the lower one.
        if _are_clear(hands, rests[0]):
            laid = [(rest.body, rest.placement) for rest in rests]
            pile = Pile(laid, floors, hands.tools, settings=settings)
            pile.come_in()
            rests = tried.go(pile, hands, 1e-3)
            laid = [(rest.body, rest.placement) for rest in rests]
            pile = Pile(laid, floors, settings=settings)
            pile.come_in()
    rests, unborne = tried.left_alone(pile)
    within = max(_within(*rests), _within(*reversed(rests))) / max(tried.sizes)
    return PileOutcome(tried.gained, tried.sunk, tried.stretched, unborne, within)


def _are_clear(hands: Hands, rest: Rest) -> bool:
    surface = rest.surface()
    return all((tool.distance(pose.to_tool(surface))[0] > 0.0).all() for tool, pose in hands.tools)


def _within(one: Rest, other: Rest) -> float:
    """How deep a corner of one is in the other, as both are drawn, m."""
    surface, corners = _surface(other), one.surface()
    inside = corners[is_inside(corners, surface)]
    found = ClosestPoints(surface.vertices, surface.triangles).query(inside)
    return float(found.distance.max(initial=0.0))


def _surface(rest: Rest) -> Surface:
    return Surface(rest.surface(), rest.body.mesh.surface_local_triangles)
