"""Tools that press bodies without pins: the referee's and Palpate's of one shape, where they go."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from palpate.benchmarks.measuring.shape.pressed.pressers import Ball, Block, Presser, Rod, Wall
from palpate.core.contact.tool.pose import Pose, facing
from palpate.core.contact.tool.tools import Tool, plate, rod, sphere
from palpate.core.rest.support import Floor

Array = NDArray[np.float64]

# Rounding of a block's edges, over its half width.
ROUNDING = 0.3


@dataclass(frozen=True, eq=False)
class Hand:
    """A tool at a pose in the world, and the same for the referee."""

    tool: Tool
    pose: Pose
    presser: Presser


def ball(front: Array, inward: Array, radius: float) -> Hand:
    """A ball whose front is at a place (3,), on its way ``inward`` (3,), unit."""
    middle = front - radius * inward
    return Hand(sphere(radius), Pose.at(middle), Ball(middle, radius))


def wall(front: Array, inward: Array, size: float) -> Hand:
    """A plate, ``size`` wide, about a place (3,) of its face; the referee's has no edge."""
    pose = Pose.at(front, facing(-inward, _aside(inward)))
    return Hand(plate(size, size), pose, Wall(front, -inward))


def lying_rod(front: Array, inward: Array, radius: float, length: float) -> Hand:
    """A rod across the way, so long between its round ends."""
    middle, axis = front - radius * inward, _aside(inward)
    pose = Pose.at(middle, facing(-inward, axis))
    return Hand(rod(radius, length), pose, Rod(middle, axis, length / 2.0, radius))


def edged(front: Array, inward: Array, width: float, length: float) -> Hand:
    """A long block, a convex tool, that goes in with a rounded edge of its square section."""
    axis = _aside(inward)
    turn = facing(-inward + np.cross(-inward, axis), axis)
    radius = ROUNDING * width / 2.0
    core = np.array([length / 2.0, *2 * [width / 2.0 - radius]])
    middle = front - (radius + np.sqrt(2.0) * core[1]) * inward
    corners = core * (1.0 - 2.0 * np.array(list(np.ndindex(2, 2, 2))))
    tool = Tool("edged", corners, radius)
    return Hand(tool, Pose.at(middle, turn), Block(middle, turn, core, radius))


def floor_wall(floor: Floor) -> Wall:
    """The referee's wall where a floor is."""
    up = np.asarray(floor.up)
    return Wall(floor.height * up, -up, floor.friction)


def _aside(inward: Array) -> Array:
    """A direction (3,) of the axes that is across the way."""
    axis: Array = np.eye(3)[(int(np.abs(inward).argmax()) + 1) % 3]
    return axis
