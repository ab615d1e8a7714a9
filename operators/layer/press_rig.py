"""Press rig: the answers of a body to a unit push at a place, along three axes, as sliders.

A linear body answers in proportion and its answers add up, so the sliders are exact. Vectors are
attributes, added by a modifier: a rig plays without Palpate, animated or driven.
"""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from . import layers, remains
from .layer_groups import AXES, DISPLACEMENT, Kind

STEM = "Push"


def add(thing: bpy.types.Object, answers: NDArray[np.float32]) -> bpy.types.NodesModifier:
    """Add a rig with displacements of the vertices (3, p, 3), local units, for a unit each along X,
    Y and Z; its sliders begin at 0.
    """
    mesh = layers.drawn_mesh(thing)
    remains.sweep(mesh)
    name = layers.free_name(thing, mesh, STEM)
    for axis, answer in zip(AXES, answers, strict=True):
        attribute = mesh.attributes.new(f"{name} {axis}", "FLOAT_VECTOR", "POINT")
        if attribute.name != f"{name} {axis}":
            raise RuntimeError(f"{mesh.name} has an attribute {name} {axis}")
        attribute.data.foreach_set("vector", np.ascontiguousarray(answer, np.float32).ravel())
    remains.note(mesh, name)
    mesh.update_tag()
    rig = layers.add_modifier(thing, name, Kind.RIG, {DISPLACEMENT: name})
    rig.show_expanded = True
    return rig


def rigs_of(thing: bpy.types.Object) -> list[bpy.types.NodesModifier]:
    """Rigs of an object, in their order."""
    return [modifier for modifier in thing.modifiers if layers.kind(modifier) is Kind.RIG]
