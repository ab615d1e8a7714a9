"""Carrier: a hidden object whose mesh has, at rest, the vertices that an object's layers move.

Where modifiers make vertices, or a coarse mesh is divided for a dent, the object's own mesh cannot
hold what these are moved by. The carrier is in no collection; the layers' modifiers name it, so it
goes wherever the object goes.
"""

from __future__ import annotations

import bpy
import numpy as np

from ..layer import layers, stack
from ..layer.layers import HALVED, SEEN
from ..scene.drawn_surface import DrawnSurface, rest_coordinates
from . import resolution, seen_mesh
from .seen_mesh import SeenSurface


def give(thing: bpy.types.Object, scene: bpy.types.Scene, surface: DrawnSurface) -> None:
    """Give an object the carrier that it needs for a body baked from ``surface``, or none.

    One with the same vertices stays, with the layers that it carries.
    """
    as_seen = isinstance(surface, SeenSurface)
    fine = thing.palpate.bake_from != "BASE"
    level = resolution.halvings(thing, surface, as_seen=as_seen) if fine else 0
    if not as_seen and not level:
        thing.palpate.carrier = None
        return
    with seen_mesh.made(thing, stack.making(thing) if as_seen else []) as mesh:
        made = _made(thing, scene, mesh, level)
    made[HALVED], made[SEEN] = level, len(surface.local) if as_seen else 0
    before = layers.carrier(thing)
    if before is not None and _same(before, made):
        mesh = made.data
        bpy.data.objects.remove(made)
        bpy.data.meshes.remove(mesh)
        return
    thing.palpate.carrier = made


def is_carrier(thing: bpy.types.Object) -> bool:
    """Whether an object is the carrier of another one, by its marks."""
    return thing.type == "MESH" and HALVED in thing and SEEN in thing


def unlink(made: bpy.types.Object) -> None:
    """Take a carrier out of all collections: Blender links what is appended to one."""
    for collection in made.users_collection:
        if collection.library is None:
            collection.objects.unlink(made)


def take_unused(thing: bpy.types.Object) -> None:
    """Take an object's carrier away, unless layers need it."""
    carrier = thing.palpate.carrier
    if carrier is None or any(layers.carrier_of(one) == carrier for one in layers.layers_of(thing)):
        return
    thing.palpate.carrier = None
    mesh = carrier.data
    bpy.data.objects.remove(carrier)
    if not mesh.users:
        bpy.data.meshes.remove(mesh)


def _made(
    thing: bpy.types.Object, scene: bpy.types.Scene, mesh: bpy.types.Mesh, level: int
) -> bpy.types.Object:
    name = f"{thing.name} Carrier"
    made = bpy.data.objects.new(name, mesh.copy())
    if level:
        # Blender's own division, for its order of vertices.
        coarse = made.data
        made[HALVED] = level
        layers.refine(made, level)
        scene.collection.objects.link(made)
        graph = bpy.context.evaluated_depsgraph_get()
        made_fine = bpy.data.meshes.new_from_object(made.evaluated_get(graph), depsgraph=graph)
        scene.collection.objects.unlink(made)
        made.modifiers.clear()
        made.data = made_fine
        bpy.data.meshes.remove(coarse)
    made.data.name = name
    # A Blender without Palpate that appends the object links this one to the scene, too.
    made.hide_render = True
    _strip(made)
    return made


def _strip(made: bpy.types.Object) -> None:
    """Keep the places and faces alone."""
    mesh = made.data
    mesh.materials.clear()
    made.vertex_groups.clear()
    names = [one.name for one in mesh.attributes if not one.is_required and not one.is_internal]
    for name in names:
        mesh.attributes.remove(mesh.attributes[name])


def _same(before: bpy.types.Object, made: bpy.types.Object) -> bool:
    if any(before.get(name) != made.get(name) for name in (HALVED, SEEN)):
        return False
    one, other = rest_coordinates(before.data), rest_coordinates(made.data)
    return one.shape == other.shape and np.allclose(one, other, rtol=0.0, atol=1e-6)
