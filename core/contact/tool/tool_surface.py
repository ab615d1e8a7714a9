"""Contact points of a body for a tool, spread once for all its touches."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeAlias
from weakref import WeakKeyDictionary

import numpy as np

from ...body.imprinted_body import ImprintedBody, as_touched
from ...body.soft_body import SoftBody
from ..near_field.compliance_beneath import NearCorrection, near_correction
from ..near_field.contact_points import ContactPoints, contact_points, spacing_on
from ..near_field.surface_shape import smooth_corner_normals, unit
from .tools import Tool

Touchable: TypeAlias = tuple[ContactPoints, NearCorrection]
"""Contact points, and what the near field adds to the compliance between them."""

# Contact points take long to spread and are the same for every touch of a body by a tool.
_surfaces: WeakKeyDictionary[SoftBody, dict[float, Touchable]] = WeakKeyDictionary()


def surface_and_correction(body: SoftBody, tool: Tool) -> Touchable:
    """Contact points of a body for a tool, and what the near field adds to the compliance between
    them; cached with the body.
    """
    known = _surfaces.setdefault(body, {})
    at_rest = body.at_rest if isinstance(body, ImprintedBody) else body
    spacing = spacing_on(at_rest, tool.spacing)
    if spacing in known:
        return known[spacing]
    if isinstance(body, ImprintedBody):
        points, near = surface_and_correction(at_rest, tool)
        known[spacing] = _imprinted(points, body), near
    else:
        points = contact_points(body, spacing)
        known[spacing] = points, near_correction(body, points)
    return known[spacing]


def _imprinted(points: ContactPoints, body: ImprintedBody) -> ContactPoints:
    """The points of a body at rest where its imprint has them."""
    corner_normals = smooth_corner_normals(body.mesh)[points.triangles]
    return replace(
        points,
        positions=as_touched(body, points.positions),
        normals=unit(np.einsum("pc,pcx->px", points.alphas, corner_normals)),
    )
