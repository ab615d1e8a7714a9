"""Modifiers of an object by what they do: make the mesh that is seen, or pose what was made."""

from __future__ import annotations

from typing import Any

import bpy

from ..scene import curves
from . import modifier_inputs
from .layer_groups import kind_of

# What makes vertices or faces. Groups of geometry nodes may do anything.
MAKES = frozenset(
    [
        "ARRAY",
        "BEVEL",
        "BOOLEAN",
        "BUILD",
        "DECIMATE",
        "EDGE_SPLIT",
        "EXPLODE",
        "FLUID",
        "MASK",
        "MIRROR",
        "MULTIRES",
        "NODES",
        "OCEAN",
        "PARTICLE_INSTANCE",
        "REMESH",
        "SCREW",
        "SKIN",
        "SOLIDIFY",
        "SUBSURF",
        "TRIANGULATE",
        "VOLUME_TO_MESH",
        "WELD",
        "WIREFRAME",
    ]
)
# What takes the mesh out of its rest, and all that comes after it.
POSES = frozenset(
    [
        "ARMATURE",
        "CLOTH",
        "CURVE",
        "HOOK",
        "LATTICE",
        "MESH_CACHE",
        "MESH_DEFORM",
        "MESH_SEQUENCE_CACHE",
        "SOFT_BODY",
        "SURFACE_DEFORM",
    ]
)
# What plays the places of all vertices.
PLAYERS = ("MESH_CACHE", "MESH_SEQUENCE_CACHE")
# Settings that change nothing about the mesh.
_ASIDE = frozenset(
    [
        "name",
        "is_active",
        "is_override_data",
        "use_pin_to_last",
        "show_expanded",
        "show_in_editmode",
        "show_on_cage",
        "show_render",
        "render_levels",
        "execution_time",
        "persistent_uid",
        "type",
    ]
)


def is_own(modifier: bpy.types.Modifier) -> bool:
    """Whether a modifier is of Palpate's node groups."""
    return modifier.type == "NODES" and kind_of(modifier.node_group) is not None


def making(thing: bpy.types.Object) -> list[bpy.types.Modifier]:
    """Shown modifiers that make the mesh as seen: all up to the last one that makes vertices or
    faces, before the first that poses. Empty where the mesh itself is seen.
    """
    before: list[bpy.types.Modifier] = []
    last = 0
    for modifier in thing.modifiers:
        if is_own(modifier) or not modifier.show_viewport:
            continue
        # A pinned one stays behind all layers.
        if modifier.type in POSES or modifier.use_pin_to_last:
            break
        before.append(modifier)
        if modifier.type in MAKES:
            last = len(before)
    return before[:last]


def following(thing: bpy.types.Object, made_by: list[bpy.types.Modifier]) -> list[str]:
    """Types of the shown modifiers that come after those that make the mesh."""
    return [
        modifier.type
        for modifier in thing.modifiers
        if modifier.show_viewport
        and not is_own(modifier)
        and not modifier.use_pin_to_last
        and modifier not in made_by
    ]


def words(thing: bpy.types.Object, made_by: list[bpy.types.Modifier]) -> str:
    """Text that changes with the settings of modifiers; what is animated is left out."""
    return "; ".join(_words(thing, modifier) for modifier in made_by)


def _words(thing: bpy.types.Object, modifier: bpy.types.Modifier) -> str:
    found = [modifier.type]
    for one in modifier.bl_rna.properties:
        name = one.identifier
        plain = one.type in {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM", "POINTER"}
        if not plain or name in _ASIDE or name.startswith("rna_"):
            continue
        if not curves.is_animated(thing, modifier.path_from_id(name)):
            found.append(f"{name}={_word(one, getattr(modifier, name))}")
    if modifier.type == "NODES":
        found += (
            f"{key}={_input_word(value)}"
            for key, path, value in modifier_inputs.all_values(modifier)
            if value is not None and not curves.is_animated(thing, path)
        )
    return " ".join(found)


def _input_word(value: Any) -> str:
    if isinstance(value, bpy.types.ID):
        return value.name
    numbers = value if hasattr(value, "__len__") and not isinstance(value, str) else (value,)
    return ",".join(f"{one:.6g}" if isinstance(one, float) else str(one) for one in numbers)


def _word(one: bpy.types.Property, value: Any) -> str:
    if one.type == "POINTER":
        return str(getattr(value, "name", ""))
    if one.type == "FLOAT":
        numbers = value if one.is_array else (value,)
        return ",".join(f"{number:.6g}" for number in numbers)
    return str(tuple(value) if getattr(one, "is_array", False) else value)
