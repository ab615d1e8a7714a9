"""What a block resists tools with, over what closed forms say of a half-space.

The block ends, and its outer elements are large; by how much less it gives way (its *lift*) is
taken from the depths.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.near_field.compliance_beneath import NearCorrection, near_correction
from palpate.core.contact.near_field.contact_points import ContactPoints
from palpate.core.contact.near_field.regular_field import RegularField
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import Tool, sphere
from palpate.tests.bodies.graded_block import YOUNG_MODULUS, points_around

ELEMENT = 1e-3
HERTZ_RADIUS = 100 * ELEMENT
SMALL_PLACES = {"node": (0.0, 0.0), "edge": (0.5, 0.0), "triangle": (0.3, 0.2), "next": (1.0, 0.0)}
POINTS_IN_RADIUS = 3.0
PUNCH_SIDES = 32
SMALLEST_CLAIMED_RADIUS = 4.0


def hertz(
    body: SoftBody,
    points: ContactPoints,
    correction: NearCorrection | None,
    shift: float,
    core: int,
) -> list[tuple[float, float, float]]:
    """Contact radius in elements, force over Hertz's, and the exponent from the row before."""
    modulus = YOUNG_MODULUS / (1.0 - body.poisson_ratio**2)
    tool = sphere(HERTZ_RADIUS)
    rows: list[tuple[float, float, float]] = []
    before = (np.nan, np.nan)
    for elements in range(1, core):
        depth = (elements * ELEMENT) ** 2 / HERTZ_RADIUS
        pose = Pose.at([0.0, 0.0, HERTZ_RADIUS - depth])
        touch = press_tool(body, tool, pose, spread=(points, correction))
        force = float(touch.force[2])
        # What the block gives way less than a half-space, as if it lay on rising ground.
        deep = depth - shift * force
        closed_form = 4.0 / 3.0 * modulus * np.sqrt(HERTZ_RADIUS) * deep**1.5
        exponent = float(np.log(force / before[0]) / np.log(deep / before[1]))
        radius = float(np.sqrt(HERTZ_RADIUS * deep)) / ELEMENT
        rows.append((radius, force / closed_form, exponent))
        before = (force, deep)
    return rows


def small_contacts(field: RegularField, shift: float, elements: float) -> list[float]:
    """Force over Hertz's at a contact radius of so many elements, at the small places."""
    body, radius, forces = field.body, elements * ELEMENT, []
    for place in SMALL_PLACES.values():
        middle = ELEMENT * np.array(place)
        points = points_around(body, middle, radius / POINTS_IN_RADIUS, 1.3 * radius)
        near = near_correction(body, points, field)
        forces.append(sphere_force(body, points, near, shift, radius, middle))
    return forces


def sphere_force(
    body: SoftBody,
    points: ContactPoints,
    correction: NearCorrection,
    shift: float,
    radius: float,
    middle: NDArray[np.float64],
) -> float:
    """Force over Hertz's of the sphere pressed on ``middle`` (2,) as deep as a contact ``radius``
    asks for.
    """
    depth = radius**2 / HERTZ_RADIUS
    pose = Pose.at([*middle, HERTZ_RADIUS - depth])
    touch = press_tool(body, sphere(HERTZ_RADIUS), pose, spread=(points, correction))
    force = float(touch.force[2])
    modulus = YOUNG_MODULUS / (1.0 - body.poisson_ratio**2)
    return force / (4.0 / 3.0 * modulus * np.sqrt(HERTZ_RADIUS) * (depth - shift * force) ** 1.5)


def punch(
    body: SoftBody, points: ContactPoints, correction: NearCorrection | None, shift: float
) -> float:
    """Force of a flat round punch over 2 E* a d.

    Its edge is rounded by half an element. Pressed nodes carry their share of the surface, so the
    pressed area tells the radius that the mesh sees.
    """
    rounding = 0.5 * ELEMENT
    turn = np.arange(PUNCH_SIDES) * 2 * np.pi / PUNCH_SIDES
    ring = 5.0 * ELEMENT * np.column_stack([np.cos(turn), np.sin(turn)])
    ends = [np.column_stack([ring, np.full(PUNCH_SIDES, z)]) for z in (rounding, 20 * ELEMENT)]
    tool = Tool("punch", np.vstack(ends), rounding)
    depth = 0.02 * ELEMENT
    touch = press_tool(body, tool, Pose.at([0.0, 0.0, -depth]), spread=(points, correction))
    radius = np.sqrt(touch.area / np.pi)
    force = float(touch.force[2])
    modulus = YOUNG_MODULUS / (1.0 - body.poisson_ratio**2)
    return force / (2.0 * modulus * float(radius) * (depth - shift * force))
