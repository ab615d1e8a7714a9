"""Meshes that a ray may meet, of all that a dependency graph draws.

A scene may draw thousands of objects, and a pointer that moves asks at every step. So their boxes
are read once; what has moved since is looked at anew in any case, and all of it is read again only
once a handler has told of another change.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ..scene.object_handle import ObjectHandle

Array = NDArray[np.float64]

# Objects that may have moved before all boxes are read again.
MOST_MOVED = 64
# Share of a box by which rounding may put a face beside it.
MARGIN = 1e-5


@dataclass(frozen=True, eq=False)
class _Boxes:
    """Boxes along the world's axes of all meshes that a graph draws, in its order.

    Attributes
    ----------
    graph : what tells it from others.
    low, high : float64 (n, 3), world coordinates.
    owners : the object of each; None for an instance.
    numbers : of objects that are no instances, by their identifiers.
    instanced : identifiers of the objects that instances depend on.
    moved : numbers whose boxes may be others now.
    """

    graph: tuple[object, ...]
    low: Array
    high: Array
    owners: list[ObjectHandle | None]
    numbers: dict[int, int]
    instanced: frozenset[int]
    moved: set[int] = field(default_factory=set)

    def on_ray(self, origin: Array, direction: Array, farthest: float) -> list[int]:
        """Numbers whose boxes a ray meets no farther than so many of its lengths, in their order;
        and all that have moved.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = (self.low - origin) / direction, (self.high - origin) / direction
        # Within a slab that the ray goes along, neither end says anything.
        beside = (direction == 0.0) & ((self.low > origin) | (self.high < origin))
        near = np.where(direction == 0.0, -np.inf, np.minimum(one, two)).max(axis=1)
        far = np.where(direction == 0.0, np.inf, np.maximum(one, two)).min(axis=1)
        met = (near <= far) & (far >= 0.0) & (near <= farthest) & ~beside.any(axis=1)
        return sorted({*np.flatnonzero(met).tolist(), *self.moved})


_last: _Boxes | None = None


def on_ray(
    graph: bpy.types.Depsgraph, origin: Array, direction: Array, farthest: float = np.inf
) -> Iterator[tuple[bpy.types.Object, Matrix]]:
    """Evaluated mesh objects and matrices of those whose boxes a ray (3,), world coordinates, may
    meet no farther than so many of its lengths. Each is valid until the next is asked for.
    """
    global _last  # noqa: PLW0603  see the module
    if _last is None or _last.graph != _key(graph):
        _last = _read(graph)
    boxes, found = _last, _last.on_ray(origin, direction, farthest)
    instances = set()
    for number in found:
        owner = boxes.owners[number]
        if owner is None:
            instances.add(number)
            continue
        thing = owner.find()
        shown = None if thing is None else thing.evaluated_get(graph)
        if shown is not None and shown.is_evaluated:
            yield shown, shown.matrix_world
    if instances:
        for number, instance in enumerate(_drawn(graph)):
            if number in instances:
                yield instance.object, instance.matrix_world


def changed(graph: bpy.types.Depsgraph) -> None:
    """Look anew at what a graph reports as changed."""
    global _last  # noqa: PLW0603  see the module
    if _last is None or _last.graph != _key(graph):
        return
    if len(graph.updates) > MOST_MOVED:
        _last = None
        return
    for update in graph.updates:
        if isinstance(update.id, bpy.types.Scene | bpy.types.Collection):
            _last = None
            return
        if not isinstance(update.id, bpy.types.Object):
            continue
        uid = update.id.original.session_uid
        if uid in _last.instanced:
            _last = None
            return
        if uid in _last.numbers:
            _last.moved.add(_last.numbers[uid])
    if len(_last.moved) > MOST_MOVED:
        _last = None


def forget() -> None:
    """Read all again: another file, or undo."""
    global _last  # noqa: PLW0603  see the module
    _last = None


def _key(graph: bpy.types.Depsgraph) -> tuple[object, ...]:
    return graph.scene.session_uid, graph.view_layer.name, graph.mode


def _drawn(graph: bpy.types.Depsgraph) -> Iterator[bpy.types.DepsgraphObjectInstance]:
    return (
        instance
        for instance in graph.object_instances
        if instance.object.type == "MESH" and instance.show_self
    )


def _read(graph: bpy.types.Depsgraph) -> _Boxes:
    places: list[float] = []
    owners: list[ObjectHandle | None] = []
    numbers: dict[int, int] = {}
    instanced: set[int] = set()
    for number, instance in enumerate(_drawn(graph)):
        thing, matrix = instance.object, instance.matrix_world
        box = thing.bound_box
        for row in (box[0], box[6], *matrix[:3]):
            places.extend(row)
        if instance.is_instance:
            owners.append(None)
            instanced |= {thing.original.session_uid, instance.parent.original.session_uid}
        else:
            handle = ObjectHandle.of(thing.original)
            numbers[handle.session_uid] = number
            owners.append(handle)
    table = np.array(places, dtype=np.float64).reshape(-1, 18)
    low, high, matrices = table[:, :3], table[:, 3:6], table[:, 6:].reshape(-1, 3, 4)
    middle = np.einsum("nij,nj->ni", matrices[:, :, :3], 0.5 * (low + high)) + matrices[:, :, 3]
    half = np.einsum("nij,nj->ni", np.abs(matrices[:, :, :3]), 0.5 * (high - low))
    half += MARGIN * (np.abs(middle) + half).max(axis=1, keepdims=True, initial=0.0)
    return _Boxes(_key(graph), middle - half, middle + half, owners, numbers, frozenset(instanced))
