"""Drags at random visible places of a soft object in random directions, and where each pressed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from bpy_extras.view3d_utils import (
    location_3d_to_region_2d,
    region_2d_to_location_3d,
    region_2d_to_origin_3d,
    region_2d_to_vector_3d,
)
from mathutils import Euler, Vector
from numpy.typing import NDArray
from shown import replaced
from stage import Pixel, Stage, Wait

from bl_ext.user_default.palpate.operators.layer import layers
from bl_ext.user_default.palpate.operators.scene.drawn_surface import metres_per_unit
from bl_ext.user_default.palpate.operators.scene.viewport import Viewport, under_pointer
from bl_ext.user_default.palpate.operators.stroke import stroke_operator
from bl_ext.user_default.palpate.operators.stroke.answer import deepest
from bl_ext.user_default.palpate.operators.stroke.stroke_size import radius_for

TOOL = "palpate.tool"
Points = NDArray[np.float64]
DRAG_PIXELS = 40.0
# The sidebar's edge can be dragged, also from a little beside it.
BESIDE_EDGE = 20
# Of a button's radius; the strip belongs to the gizmo, too.
STRIP = 1.6
# Of the way that the pointer was dragged; and where the stroke says that it goes no deeper, as on
# an ear that is thinner than the drag is long.
LEAST_PRESSED, LEAST_AT_END = 0.4, 0.2
# Drags after which the object is looked at from elsewhere.
LOOKS_FROM = 5


@dataclass(frozen=True)
class Drag:
    """One drag and what came of it; lengths in pixels at the touched place.

    Attributes
    ----------
    at : where it began, in the window.
    off : from there to the place that moved most, as it was seen before.
    radius : of the tool.
    moved : by how much the place that moved most did.
    pressed : by how much the surface under the cursor went in.
    said : what the stroke reported or refused meanwhile.
    """

    at: Pixel
    off: float
    radius: float
    moved: float
    pressed: float
    said: tuple[str, ...]

    @property
    def hit(self) -> bool:
        """Whether the surface was pressed where the cursor was, as one would see it."""
        most = self.moved if self.off <= self.radius else self.pressed
        ends = not {deepest.ENDS, deepest.PINNED, deepest.DEEPEST}.isdisjoint(self.said)
        least = LEAST_AT_END if ends else LEAST_PRESSED
        return max(most, self.pressed) >= least * DRAG_PIXELS

    @property
    def elsewhere(self) -> bool:
        """Whether another place moved more, as the tip of a limb that bends."""
        return self.off > self.radius


def random_drags(
    stage: Stage, name: str, rng: np.random.Generator, count: int, drags: list[Drag]
) -> Wait:
    """Append what came of so many drags with the tool Palpate, seen from all around.

    Those seen from one side go on from each other; after them all are undone, but the last.
    """
    with stage.view():
        bpy.ops.wm.tool_set_by_id(name=TOOL)
    for number in range(count):
        if number % LOOKS_FROM == 0 and number:
            yield from undo_all(stage, name)
            yield from _look_from_elsewhere(stage, rng)
        at = visible_place(stage, name, rng)
        yield from _drag(stage, name, at, rng.uniform(0.0, 2.0 * math.pi), drags)
        if not drags[-1].hit:
            yield from stage.picture(f"missed-{bpy.context.preferences.view.ui_scale:g}-{number}")


def _drag(stage: Stage, name: str, at: Pixel, angle: float, drags: list[Drag]) -> Wait:
    count = len(layers.layers_of(bpy.data.objects[name]))
    met = _world_under(stage, at, name)
    assert met is not None
    here, inward = met
    end = (at[0] + DRAG_PIXELS * math.cos(angle), at[1] + DRAG_PIXELS * math.sin(angle))
    with _heard() as said:
        yield from stage.drag([at, end], steps=3)
        yield 0.1
        yield
    thing = bpy.data.objects[name]
    scale = _pixels_per_unit(stage, here)
    radius = radius_for(bpy.context.scene, thing) / metres_per_unit(bpy.context.scene) * scale
    if len(layers.layers_of(thing)) == count:
        drags.append(Drag(at, math.inf, radius, 0.0, 0.0, tuple(said)))
        return
    after, before = seen_points(name), _without_last(thing)
    shift = after - before
    moved = np.linalg.norm(shift, axis=1)
    most = int(np.argmax(moved))
    away = np.linalg.norm(before - np.array(here), axis=1)
    touched = away <= max(0.5 * radius / scale, away.min())
    pressed = float((shift[touched] @ inward).max()) * scale
    off = math.dist(at, stage.pixel(before[most]))
    drags.append(Drag(at, off, radius, float(moved[most]) * scale, pressed, tuple(said)))


def _without_last(thing: bpy.types.Object) -> Points:
    """Vertices (p, 3) as they are drawn without the last layer, on the same divided faces."""
    last = layers.layers_of(thing)[-1]
    layers.set_strength(thing, last, 0.0)
    before = seen_points(thing.name)
    layers.set_strength(thing, last, 1.0)
    return before


def visible_place(stage: Stage, name: str, rng: np.random.Generator) -> Pixel:
    """A pixel at which the object is seen, covered by no panel and no gizmo."""
    region = stage.region("WINDOW")
    for _ in range(5000):
        at = (
            round(region.x + rng.uniform(0.02, 0.98) * region.width),
            round(region.y + rng.uniform(0.02, 0.98) * region.height),
        )
        here = under_pointer(stage.window, *at)
        if here is None or _beside_gizmos(here):
            continue
        sidebar, toolbar = stage.region("UI"), stage.region("TOOLS")
        edges = sidebar.x, toolbar.x + toolbar.width
        if min(abs(at[0] - edge) for edge in edges) > BESIDE_EDGE and _world_under(stage, at, name):
            return at
    raise AssertionError(f"{name} is nowhere to be seen")


def _beside_gizmos(here: Viewport) -> bool:
    """Whether a pointer is on a navigation gizmo, or on the strip on which its buttons stand."""
    return any(math.dist(here.cursor, middle) <= STRIP * radius for middle, radius in here.gizmos())


def seen_points(name: str) -> Points:
    """Vertices (p, 3) as they are drawn, world coordinates."""
    thing = bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())
    flat = np.empty(3 * len(thing.data.vertices), dtype=np.float32)
    thing.data.vertices.foreach_get("co", flat)
    matrix = np.array(thing.matrix_world)
    return flat.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def _world_under(stage: Stage, at: Pixel, name: str) -> tuple[Vector, Points] | None:
    """Where the line of sight through a pixel meets the object first, world coordinates, and the
    inward unit normal (3,) there.
    """
    region, view = stage.region("WINDOW"), stage.area.spaces.active.region_3d
    cursor = (at[0] - region.x, at[1] - region.y)
    along = region_2d_to_vector_3d(region, view, cursor)
    met, place, normal, _, thing, _ = bpy.context.scene.ray_cast(
        bpy.context.evaluated_depsgraph_get(),
        region_2d_to_origin_3d(region, view, cursor),
        along,
    )
    if not met or thing.name != name:
        return None
    return place, np.array(normal if normal.dot(along) > 0.0 else -normal)


def _pixels_per_unit(stage: Stage, here: Vector) -> float:
    region, view = stage.region("WINDOW"), stage.area.spaces.active.region_3d
    step = 0.01 * view.view_distance
    aside = here + step * view.view_matrix.to_3x3()[0]
    ends = [location_3d_to_region_2d(region, view, place) for place in (here, aside)]
    return float((ends[1] - ends[0]).length) / step


def undo_all(stage: Stage, name: str) -> Wait:
    """Take the drags back that were seen from one side."""
    region = stage.region("WINDOW")
    yield from stage.move((region.x + 0.3 * region.width, region.y + 0.3 * region.height))
    for _ in range(LOOKS_FROM):
        count = len(layers.layers_of(bpy.data.objects[name]))
        if count:
            yield from stage.key("Z", ctrl=True)
            yield from stage.until(
                lambda n=count: len(layers.layers_of(bpy.data.objects[name])) < n, "the undo"
            )


def _look_from_elsewhere(stage: Stage, rng: np.random.Generator) -> Wait:
    tilt, turn = rng.uniform(math.radians(30), math.radians(110)), rng.uniform(0, 2 * math.pi)
    stage.area.spaces.active.region_3d.view_rotation = Euler((tilt, 0.0, turn)).to_quaternion()
    with stage.view():
        bpy.ops.view3d.view_selected()
    # The view goes there in steps.
    yield 1.0
    clear_of_sidebar(stage)
    yield
    yield


def clear_of_sidebar(stage: Stage) -> None:
    """Move the view aside, as a user does, where a wide sidebar covers its middle."""
    region, covered = stage.region("WINDOW"), stage.region("UI").width
    if covered < region.width / 3:
        return
    view = stage.area.spaces.active.region_3d
    here, aside = (
        region_2d_to_location_3d(region, view, (x, region.height / 2), view.view_location)
        for x in (region.width / 2, region.width / 2 + covered / 2)
    )
    view.view_location += aside - here


@contextmanager
def _heard() -> Iterator[list[str]]:
    """What strokes say meanwhile."""
    said: list[str] = []

    def hearing(say: Callable[..., str]) -> Callable[..., str]:
        def hear(text: object, **figures: object) -> str:
            said.append(str(say(text, **figures)))
            return said[-1]

        return hear

    with (
        replaced(stroke_operator, "reported", hearing(stroke_operator.reported)),
        replaced(stroke_operator, "shown", hearing(stroke_operator.shown)),
    ):
        yield said
