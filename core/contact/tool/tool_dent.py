"""Drawn surface, kept out of the tools that press it.

The near field (:mod:`..near_field`) is not in the finite elements, so their shape under the same
forces is short of the tool, which would be seen inside a coarse body. But in contact the surface
lies on the tool, so its place is known there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .pose import Pose
from .tools import Tool

# Share of the tool's inner radius, on both sides of its surface and at most its depth, over which
# the shift fades in, so that no edge is drawn around the contact.
FADE = 0.25

# A surface whose normal has a smaller product than the first with the force on the tool is not the
# side that is pressed, from the second on it is wholly: what lies across a thin part stays.
PRESSED_SIDE = (-0.2, 0.2)


@dataclass(frozen=True, eq=False)
class PressingTool:
    """Tool at a ``pose``, on which the body exerts ``force`` (3,), newton, body axes."""

    tool: Tool
    pose: Pose
    force: NDArray[np.float64]


def kept_out(
    places: NDArray[np.float64], normals: NDArray[np.float64], pressing: PressingTool
) -> NDArray[np.float64]:
    """Where places (p, 3) of the deformed surface are drawn, metres, with outward unit normals at
    rest (p, 3): those within the tool on its surface, close to it smoothly between.
    """
    tool, pose = pressing.tool, pressing.pose
    size = float(np.linalg.norm(pressing.force))
    away = np.linalg.norm(places - pose.position, axis=1)
    near = np.flatnonzero(away < tool.reach + FADE * tool.inner_radius)
    if size == 0.0 or not near.size:
        return places
    distances, normals_of_tool = tool.distance(pose.to_tool(places[near]))
    outward = normals_of_tool @ pose.rotation.T
    low, high = PRESSED_SIDE
    share = np.clip((normals[near] @ pressing.force / size - low) / (high - low), 0.0, 1.0)
    deepest = -float(np.where(share > 0.0, distances, 0.0).min())
    shift = share * _soft_depth(distances, min(FADE * tool.inner_radius, deepest))
    moved = places.copy()
    moved[near] += shift[:, None] * outward
    return moved


def _soft_depth(distances: NDArray[np.float64], fade: float) -> NDArray[np.float64]:
    """Shift of each place: its depth, with a parabola across the tool's surface."""
    if fade <= 0.0:
        return np.maximum(-distances, 0.0)
    soft = (fade - distances) ** 2 / (4.0 * fade)
    depth: NDArray[np.float64] = np.where(
        np.abs(distances) < fade, soft, np.maximum(-distances, 0.0)
    )
    return depth
