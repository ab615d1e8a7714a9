"""What an object rests on: a floor at a height, and the colliders that it names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.tool.pose import Pose
from ...core.contact.tool.tools import Tool
from ...core.errors import PalpateError
from ...core.rest.support import Floor, Support
from ..object.drawn_body import DrawnBody
from ..place.evaluation import evaluated
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import frame_of, metres_per_unit
from .collider_tool import collider_tools
from .laid import found_floor
from .placement import placement_of

# Share of its size by which an object may be beneath the ground and still stand on it.
ROUNDING = 1e-4
# A vertex whose normal is that of the support's surface to this cosine is on the far side of a part
# that the support is in; at an edge it may be one of either side.
FAR_SIDE = 0.5


@dataclass(frozen=True, eq=False)
class Supports:
    """Supports of an object as a graph has them; ``floor`` is its height, metres, None without."""

    all: tuple[Floor | Support, ...]
    floor: float | None

    @property
    def ways(self) -> list[tuple[Tool | None, Pose]]:
        """Tool and pose of each; a floor has no tool."""
        return [(getattr(one, "tool", None), one.pose) for one in self.all]

    def gap_beneath(self, places: NDArray[np.float64]) -> float:
        """How far places (n, 3) in the world can go straight down at least before one meets a
        support, metres; infinite where none is under them.
        """
        low, high = places.min(axis=0), places.max(axis=0)
        gap = np.inf if self.floor is None else low[2] - self.floor
        for tool, pose in self.ways:
            if tool is not None:
                least, most = _bounds(tool, pose)
                if (least[:2] < high[:2]).all() and (low[:2] < most[:2]).all():
                    gap = min(gap, low[2] - most[2] if high[2] > least[2] else np.inf)
        return max(float(gap), 0.0)

    def keep_out(
        self, drawn: DrawnBody, frame: BodyFrame, moved: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """Displacements (3 p,) of the drawn vertices, local units, none of which leads into a
        support: where that presses, the body gives way by more than its elements show.
        """
        if not self.all:
            return moved
        local = (drawn.rest + moved).reshape(-1, 3).astype(np.float64)
        metres = frame.metres_per_unit
        places = frame.world_from_body(frame.body_from_local(local)) * metres
        # Coordinate by coordinate, as they are compared for each of perhaps sixteen supports.
        found = np.array(places, order="F")
        for tool, pose in self.ways:
            if tool is not None:
                _leave(found, tool, pose, drawn, frame)
        if self.floor is not None:
            found[:, 2] = np.maximum(found[:, 2], self.floor)
        led = np.flatnonzero((found != places).any(axis=1))
        if not len(led):
            return moved
        back = frame.local_from_body(frame.body_from_world(found[led] / metres))
        shown = moved.copy()
        shown.reshape(-1, 3)[led] = back - drawn.rest.reshape(-1, 3)[led]
        return shown


def _leave(
    places: NDArray[np.float64], tool: Tool, pose: Pose, drawn: DrawnBody, frame: BodyFrame
) -> None:
    """Lead drawn vertices that are in a support out of it, but those that have come through it."""
    low, high = _bounds(tool, pose)
    is_near = np.ones(len(places), dtype=np.bool_)
    for axis in range(3):
        is_near &= (places[:, axis] > low[axis]) & (places[:, axis] < high[axis])
    near = np.flatnonzero(is_near)
    if not len(near):
        return
    distances, normals = tool.distance(pose.to_tool(places[near]))
    outward = normals @ pose.rotation.T
    facing = drawn.hung.normals[drawn.hung.triangle[near]] @ frame.rotation.T
    within = (distances < 0.0) & (np.einsum("kx,kx->k", outward, facing) < FAR_SIDE)
    places[near[within]] -= distances[within, None] * outward[within]


def _bounds(tool: Tool, pose: Pose) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The least and the largest coordinates of a tool in the world, metres."""
    core = pose.to_world(tool.core)
    return core.min(axis=0) - tool.radius, core.max(axis=0) + tool.radius


def supports_of(
    thing: bpy.types.Object,
    drawn: DrawnBody,
    graph: bpy.types.Depsgraph,
    *,
    besides: Sequence[bpy.types.Object] | None = None,
) -> Supports:
    """What an object rests on, besides itself and soft objects that bear it by giving way.

    Raises
    ------
    PalpateError
        There is nothing, or a collider cannot bear it.
    """
    chosen = thing.palpate
    friction = chosen.rest_friction
    height = _floor_height(thing, drawn, metres_per_unit(graph.scene))
    found: list[Floor | Support] = [] if height is None else [Floor(height, friction)]
    for one in [] if chosen.colliders is None else chosen.colliders.all_objects:
        if one == thing or one in (besides or ()):
            continue
        pose = placement_of(frame_of(evaluated(one, graph), graph.scene))
        found.extend(Support(tool, pose, friction) for tool in collider_tools(one, graph))
    if not found and besides is None:
        raise PalpateError(
            "{name}: there is nothing under it; choose a floor or colliders under Rests On",
            name=thing.name,
        )
    return Supports(tuple(found), height)


def floor_of(thing: bpy.types.Object, drawn: DrawnBody, graph: bpy.types.Depsgraph) -> float | None:
    """Height of an object's floor, metres; None where there is none."""
    return _floor_height(thing, drawn, metres_per_unit(graph.scene))


def _floor_height(thing: bpy.types.Object, drawn: DrawnBody, metres: float) -> float | None:
    """Height of the floor, metres: as chosen, as found before, or under the object; None where
    there is none.
    """
    chosen = thing.palpate
    if chosen.floor == "NONE":
        return None
    if chosen.floor == "HEIGHT":
        return float(metres * chosen.floor_height)
    before = found_floor(thing)
    if before is not None:
        return before
    lowest = metres * float(drawn.frame.world_from_body(drawn.places)[:, 2].min())
    return lowest if lowest < -ROUNDING * drawn.size else 0.0


def same_shapes(before: Supports, after: Supports) -> bool:
    """Whether two are of the same shapes, perhaps elsewhere."""
    return len(before.all) == len(after.all) and all(
        (one is None and other is None)
        or (
            one is not None
            and other is not None
            and one.core.shape == other.core.shape
            and np.allclose(one.core, other.core, rtol=0.0, atol=1e-3 * one.radius)
        )
        for (one, _), (other, _) in zip(before.ways, after.ways, strict=True)
    )
