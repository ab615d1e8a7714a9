"""Grips of a stroke: the touched place and its mirror images."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from ....core.contact.place import nearest_place
from ....core.grip.patch import Grip
from ...object.drawn_body import DrawnBody

Array = NDArray[np.float64]


def grips_at(
    drawn: DrawnBody, rest: Array, radius: float, mirrored: tuple[bool, bool, bool]
) -> tuple[Grip, ...]:
    """Grips at ``rest`` (3,), metres, body coordinates, and at its images in the planes through the
    object's origin across those of its axes that are ``mirrored``; none where an image is off the
    surface by more than the radius.
    """
    grips = [grip_at(drawn, rest, radius, np.eye(3))]
    metric = drawn.frame.metric
    choices = [(1.0, -1.0) if one else (1.0,) for one in mirrored]
    for signs in list(itertools.product(*choices))[1:]:
        mirror = metric @ np.diag(signs) @ np.linalg.inv(metric)
        image = mirror @ rest
        place = nearest_place(drawn.body, image)
        if np.linalg.norm(place.position - image) <= radius:
            grips.append(grip_at(drawn, image, radius, mirror))
    return tuple(grips)


def grip_at(drawn: DrawnBody, at: Array, radius: float, mirror: Array) -> Grip:
    """Grip at the place of the surface nearest to ``at`` (3,), metres, body coordinates."""
    place = nearest_place(drawn.body, at)
    corners = drawn.body.mesh.surface_triangles[place.triangle]
    normal = place.alpha @ drawn.node_normals[corners]
    return Grip(place.triangle, place.alpha, normal / np.linalg.norm(normal), radius, mirror)
