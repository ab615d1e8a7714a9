"""Mesh that the modifiers of an object make at rest, before it is posed."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..layer import stack
from ..scene import drawn_surface
from ..scene.drawn_surface import DrawnSurface
from ..scene.fingerprint import Fingerprint

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SeenSurface(DrawnSurface):
    """Arrays of the mesh that modifiers make.

    Attributes
    ----------
    of_object : the object's own mesh, which users edit and paint.
    stack : text that changes with the settings of the modifiers.
    weights : (p,) of the vertex groups that pin and stiffen, by their names.
    """

    of_object: DrawnSurface
    stack: str
    weights: Mapping[str, Array]

    @property
    def base(self) -> DrawnSurface:
        return self.of_object

    @property
    def shape(self) -> Fingerprint:
        """Fingerprint of the object's own mesh and of the modifiers, which need no evaluation."""
        return replace(self.of_object.shape, stack=self.stack)

    def group(self, thing: bpy.types.Object, name: str) -> Array:
        return self.weights[name]


def digest(thing: bpy.types.Object) -> str:
    """Short text that changes with the settings of the modifiers that make an object's mesh."""
    words = stack.words(thing, stack.making(thing))
    return hashlib.sha256(words.encode()).hexdigest()[:16]


def read(thing: bpy.types.Object, scene: bpy.types.Scene) -> SeenSurface:
    """Read the mesh that the modifiers of an object make.

    Raises
    ------
    PalpateError
        They make no faces, or nothing evaluates them; its transform flattens it.
    """
    chosen = (thing.palpate.pin_group, thing.palpate.stiff_group)
    with made(thing, stack.making(thing)) as mesh:
        if not len(mesh.polygons):
            raise PalpateError(
                "{name}: its modifiers leave no faces; Realize Instances makes some of instances",
                name=thing.name,
            )
        seen = drawn_surface.read(thing, scene, mesh)
        weights = {
            name: drawn_surface.group_weights(mesh, thing.vertex_groups[name].index)
            for name in chosen
            if name in thing.vertex_groups
        }
    return SeenSurface(
        seen.local,
        seen.triangles,
        seen.corners,
        seen.face_starts,
        seen.frame,
        of_object=drawn_surface.read(thing, scene),
        stack=digest(thing),
        weights=weights,
    )


def is_evaluated(thing: bpy.types.Object) -> bool:
    """Whether the modifiers of an object are evaluated where the user is now."""
    found: bool = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).is_evaluated
    return found


@contextmanager
def made(
    thing: bpy.types.Object,
    modifiers: Sequence[bpy.types.Modifier],
    layer: bpy.types.ViewLayer | None = None,
) -> Iterator[bpy.types.Mesh]:
    """What these modifiers make of an object's mesh at rest, in a view layer or the present one: a
    copy, removed afterwards.

    Raises
    ------
    PalpateError
        Nothing evaluates the modifiers: the object itself would be taken for what they make.
    """
    with _only(thing, modifiers):
        if layer is not None:
            layer.update()
        graph = bpy.context.evaluated_depsgraph_get() if layer is None else layer.depsgraph
        evaluated = thing.evaluated_get(graph)
        if modifiers and not evaluated.is_evaluated:
            raise PalpateError(
                "{name}: it is disabled in viewports or not in this view layer, so its modifiers "
                "make nothing; enable it, with its collection (what is hidden by H is known)",
                name=thing.name,
            )
        mesh = bpy.data.meshes.new_from_object(
            evaluated, preserve_all_data_layers=True, depsgraph=graph
        )
    try:
        yield mesh
    finally:
        bpy.data.meshes.remove(mesh)


@contextmanager
def _only(thing: bpy.types.Object, modifiers: Sequence[bpy.types.Modifier]) -> Iterator[None]:
    """The Basis and these modifiers are seen alone, for as long as it lasts."""
    hidden = [one for one in thing.modifiers if one.show_viewport and one not in modifiers]
    key = (thing.show_only_shape_key, thing.active_shape_key_index)
    for modifier in hidden:
        modifier.show_viewport = False
    if thing.data.shape_keys:
        thing.show_only_shape_key, thing.active_shape_key_index = True, 0
    try:
        yield
    finally:
        for modifier in hidden:
            modifier.show_viewport = True
        if thing.data.shape_keys:
            thing.show_only_shape_key, thing.active_shape_key_index = key
        bpy.context.view_layer.update()
