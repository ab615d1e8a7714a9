"""Where a free body is, and what touches it there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..body.soft_body import SoftBody
from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool

Array = NDArray[np.float64]

# Places that are less than this share of the body's size apart are one.
SAME = 1e-9


@dataclass(frozen=True, eq=False)
class BodyTouch:
    """Touch of a tool, grip, support or other body with a body that nobody holds.

    A grip presses no places with an area.

    Attributes
    ----------
    force : float64 (3,), on what touches it, newton, in the world.
    torque : float64 (3,), on that about its reference point, newton metres, in the world.
    at_rest : float64 (p, 3), pressed places at rest, metres, in the body's own frame.
    places : float64 (p, 3), these where they are now, metres, in the world.
    pushes : float64 (p,), normal forces there, newton, all > 0.
    areas : float64 (p,), the places' shares of the surface, square metres.
    nodes : int64 (k,), nodes of the mesh that carry force.
    nodal_forces : float64 (k, 3), on these, newton, in the body's own frame.
    by : what touches it and where that is in the body's own frame, where it is a tool.
    friction : Coulomb's coefficient of that.
    """

    force: Array
    torque: Array
    at_rest: Array
    places: Array
    pushes: Array
    areas: Array
    nodes: NDArray[np.int64]
    nodal_forces: Array
    by: tuple[Tool, Pose] | None = None
    friction: float = 0.0

    @property
    def pressures(self) -> Array:
        """Normal pressure at the pressed places, (p,), pascal."""
        pressures: Array = self.pushes / self.areas
        return pressures


@dataclass(frozen=True, eq=False)
class Rest:
    """A free body in the world.

    Attributes
    ----------
    body : it.
    placement : of its frame in the world.
    tools, supports : what touches it.
    elastic : elastic energy in it, joule.
    time : seconds on the way here, by its drag.
    young_modulus : as firm as a linear body is that presses back as it does, pascal.
    others : soft bodies that touch it, by their numbers in a pile.
    deformed : float64 (n, 3), displacements of its surface nodes by its law, metres; None where
        they are linear.
    let_go : float64 (3,), the only direction in the body's own frame in which a hand that steadies
        it lets it go; None without such a hand.
    """

    body: SoftBody
    placement: Pose
    tools: tuple[BodyTouch, ...]
    supports: tuple[BodyTouch, ...]
    elastic: float
    time: float
    young_modulus: float
    others: tuple[BodyTouch, ...] = ()
    deformed: Array | None = None
    let_go: Array | None = None

    @property
    def centre(self) -> Array:
        """Centre of mass in the world, (3,), metres."""
        return self.to_world(self.body.inertia.centre)

    def to_world(self, places: Array) -> Array:
        """Places (..., 3) of the body's frame in the world, metres."""
        return self.placement.to_world(places)

    def displacements(self) -> Array:
        """Elastic displacements (n, 3) of the surface nodes in the body's frame, metres."""
        if self.deformed is not None:
            return self.deformed
        nodes = [touch.nodes for touch in self.touches]
        forces = [touch.nodal_forces for touch in self.touches]
        return self.body.deform(
            np.concatenate([np.empty(0, np.int64), *nodes]),
            np.concatenate([np.empty((0, 3)), *forces]),
            self.young_modulus,
        )

    def surface(self) -> Array:
        """The surface nodes (n, 3), moved and deformed, metres, in the world.

        One that is a pressed place of a linear body is where contact has it: beneath it the body
        gives way by its near field, too, so that a tip is flat where it stands.
        """
        nodes = self.body.mesh.nodes[self.body.compliance.free_surface]
        surface = self.to_world(nodes + self.displacements())
        if self.deformed is not None:
            return surface
        tree = cKDTree(nodes)
        for touch in self.touches:
            away, found = tree.query(touch.at_rest)
            nearest, is_node = np.asarray(found), away < SAME * np.ptp(nodes)
            surface[nearest[is_node]] = touch.places[is_node]
        return surface

    @property
    def touches(self) -> tuple[BodyTouch, ...]:
        """All of them."""
        return (*self.tools, *self.supports, *self.others)
