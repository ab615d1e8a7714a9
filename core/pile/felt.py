"""What a body of a pile feels of others and of rigid tools."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..contact.near_field.contact_points import ContactPoints
from ..contact.tool.pose import Pose
from ..contact.tool.tools import Tool
from ..contact.touches import ToolTouch
from ..rest.rest import BodyTouch

if TYPE_CHECKING:
    # Types only, absent at run time.
    from palpate_servo import PileContacts

Numbers = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Felt:
    """Contacts of all bodies as one of them has them.

    ``number`` is the body's, ``placement`` that of its frame; forces in ``contacts`` are in the
    world, on the body whose point it is.
    """

    number: int
    body: SoftBody
    points: ContactPoints
    placement: Pose
    contacts: PileContacts

    def of_obstacle(self, obstacle: int, pose: Pose) -> BodyTouch:
        """Touch with a rigid tool."""
        told = self.contacts
        which = np.flatnonzero((told["body"] == self.number) & (told["obstacle"] == obstacle))
        return self._touch(which, self._own(which), 1.0, pose)

    def of_tool(self, obstacle: int, tool: Tool, pose: Pose) -> ToolTouch:
        """The same in the body's own frame, as of a pinned body; how stiff it is nobody tells."""
        told = self.contacts
        which = np.flatnonzero((told["body"] == self.number) & (told["obstacle"] == obstacle))
        touch, turn = self._touch(which, self._own(which), 1.0, pose), self.placement.rotation
        points = told["point"][which]
        order = np.argsort(points)
        which, points = which[order], points[order]
        places = self.points.positions[points]
        moved = self.placement.to_tool(told["place"][which])
        own = Pose(self.placement.to_tool(pose.position), turn.T @ pose.rotation)
        normals = tool.distance(own.to_tool(moved))[1] @ own.rotation.T
        return ToolTouch(
            body=self.body,
            tool=tool,
            pose=own,
            force=touch.force @ turn,
            torque=touch.torque @ turn,
            stiffness=np.zeros((3, 3)),
            points=points,
            places=places,
            displacements=moved - places,
            normals=normals,
            forces=told["force"][which] @ turn,
            pushes=told["push"][which],
            areas=self.points.areas[points],
            nodes=touch.nodes,
            nodal_forces=touch.nodal_forces,
        )

    def of_body(self, other: int, pose: Pose) -> BodyTouch:
        """Touch with another body, whose points or this one's carry the contacts."""
        told = self.contacts
        which = np.flatnonzero((told["body"] == self.number) & (told["other"] == other))
        if which.size:
            return self._touch(which, self._own(which), 1.0, pose)
        which = np.flatnonzero((told["body"] == other) & (told["other"] == self.number))
        return self._touch(which, self._shared(which), -1.0, pose)

    def _own(self, which: Numbers) -> tuple[Numbers, Numbers, NDArray[np.float64]]:
        points = self.contacts["point"][which]
        return np.arange(len(which)), points, np.ones(len(which))

    def _shared(self, which: Numbers) -> tuple[Numbers, Numbers, NDArray[np.float64]]:
        told = self.contacts
        place = np.full(len(told["body"]), -1)
        place[which] = np.arange(len(which))
        chosen = place[told["shared_contact"]] >= 0
        contact = place[told["shared_contact"][chosen]]
        return contact, told["shared_point"][chosen], told["share"][chosen]

    def _touch(
        self,
        which: Numbers,
        shares: tuple[Numbers, Numbers, NDArray[np.float64]],
        sign: float,
        pose: Pose,
    ) -> BodyTouch:
        """A touch by some contacts, whose forces, times ``sign``, points carry by their shares."""
        told, (contact, point, share) = self.contacts, shares
        forces, places = sign * told["force"][which], told["place"][which]
        own = forces[contact] @ self.placement.rotation * share[:, None]
        corners = self.body.mesh.surface_triangles[self.points.triangles[point]]
        nodal = self.points.alphas[point][:, :, None] * own[:, None, :]
        nodes, inverse = np.unique(corners.reshape(-1), return_inverse=True)
        nodal_forces = np.zeros((len(nodes), 3))
        np.add.at(nodal_forces, inverse, nodal.reshape(-1, 3))
        at_rest, areas = np.zeros((len(which), 3)), np.zeros(len(which))
        np.add.at(at_rest, contact, share[:, None] * self.points.positions[point])
        np.add.at(areas, contact, share * self.points.areas[point])
        return BodyTouch(
            force=-forces.sum(axis=0),
            torque=-np.cross(places - pose.position, forces).sum(axis=0),
            at_rest=at_rest,
            places=places,
            pushes=told["push"][which],
            areas=areas,
            nodes=nodes,
            nodal_forces=nodal_forces,
        )
