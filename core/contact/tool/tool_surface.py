"""Contact points of a body for a tool, spread once for all its touches."""

from __future__ import annotations

from weakref import WeakKeyDictionary

from ...body.soft_body import SoftBody
from ..near_field.compliance_beneath import NearCorrection, near_correction
from ..near_field.contact_points import ContactPoints, contact_points, spacing_on
from .tools import Tool

# Contact points take long to spread and are the same for every touch of a body by a tool.
_surfaces: WeakKeyDictionary[SoftBody, dict[float, tuple[ContactPoints, NearCorrection]]] = (
    WeakKeyDictionary()
)


def surface_and_correction(body: SoftBody, tool: Tool) -> tuple[ContactPoints, NearCorrection]:
    """Contact points of a body for a tool, and what the near field adds to the compliance between
    them; cached with the body.
    """
    known = _surfaces.setdefault(body, {})
    spacing = spacing_on(body, tool.spacing)
    if spacing not in known:
        points = contact_points(body, spacing)
        known[spacing] = points, near_correction(body, points)
    return known[spacing]
