"""Body with an imprint: contact meets its surface as it is by now.

The surface nodes move, those inside stay, and the compliance stays that of the body at rest: an
imprint is shallow beside the body. So the tetrahedra are good for their surface only.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray
from palpate_servo import closest_points

from ..mesh.surface import Surface
from ..mesh.tet_mesh import TetMesh
from .soft_body import SoftBody

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DrawnImprint:
    """Imprint of a drawn surface: ``vertices`` (p, 3) at rest, ``triangles`` (m, 3) between them,
    and how far it has ``moved`` them (p, 3), metres.
    """

    vertices: Array
    triangles: NDArray[np.int64]
    moved: Array

    def at(self, places: Array) -> Array:
        """How far it moved the places (k, 3) of the surface at rest, metres."""
        # Drawn meshes have triangles without area, as at the poles of half a sphere.
        wide = Surface(self.vertices, self.triangles).areas > 0.0
        triangles = self.triangles[wide]
        triangle, alpha = closest_points(self.vertices, triangles, places)
        found: Array = np.einsum("kc,kcx->kx", alpha, self.moved[triangles[triangle]])
        return found


@dataclass(frozen=True, eq=False, kw_only=True)
class ImprintedBody(SoftBody):
    """Body with its imprint; ``at_rest`` is the same without. Its key stays that of the body."""

    at_rest: SoftBody
    imprint: DrawnImprint


def as_touched(body: SoftBody, places: Array) -> Array:
    """Where contact meets places (k, 3) of the surface at rest: with the imprint, as it is drawn,
    since the triangles of the body are coarser than a dent.
    """
    return places + body.imprint.at(places) if isinstance(body, ImprintedBody) else places


def imprinted(body: SoftBody, imprint: DrawnImprint) -> ImprintedBody:
    """The body with an imprint."""
    nodes, surface = body.mesh.nodes.copy(), body.mesh.surface_nodes
    nodes[surface] += imprint.at(nodes[surface])
    same = {one.name: getattr(body, one.name) for one in fields(SoftBody)}
    changed = {"mesh": TetMesh(nodes, body.mesh.tets), "older_key": body.key}
    return ImprintedBody(**{**same, **changed}, at_rest=body, imprint=imprint)
