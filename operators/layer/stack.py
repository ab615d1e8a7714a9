"""Modifiers of an object by what they do: make the mesh that is seen, or pose what was made."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
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
# Settings that change nothing about the mesh, beside those that every modifier has.
_ASIDE = frozenset(
    [
        "render_levels",
        "render_steps",
        "show_group_selector",
        "show_manage_panel",
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


@contextmanager
def silent(thing: bpy.types.Object, *names: str) -> Iterator[None]:
    """Modifiers of these names are not shown meanwhile; what is done may remove one."""
    found = (thing.modifiers.get(name) for name in names)
    shown = [one.name for one in found if one is not None and one.show_viewport]
    for name in shown:
        thing.modifiers[name].show_viewport = False
    try:
        yield
    finally:
        for name in shown:
            if name in thing.modifiers:
                thing.modifiers[name].show_viewport = True


def words(thing: bpy.types.Object, made_by: list[bpy.types.Modifier]) -> str:
    """Text that changes with the settings of modifiers; what is animated is left out.

    What is as it is at first is left out, too: another Blender may have settings that this one has
    not, and files of before have them so.
    """
    return "; ".join(_words(thing, modifier) for modifier in made_by)


def _words(thing: bpy.types.Object, modifier: bpy.types.Modifier) -> str:
    found = []
    for one in modifier.bl_rna.properties:
        name = one.identifier
        if _is_aside(one) or curves.is_animated(thing, modifier.path_from_id(name)):
            continue
        word = _word(one, getattr(modifier, name))
        if word != _word(one, _at_first(one)):
            found.append(f"{name}={word}")
    if modifier.type == "NODES":
        found += (
            f"{key}={_input_word(value)}"
            for key, path, value in modifier_inputs.all_values(modifier)
            if value is not None and not curves.is_animated(thing, path)
        )
    return " ".join([modifier.type, *sorted(found)])


def _is_aside(one: bpy.types.Property) -> bool:
    plain = one.type in {"BOOLEAN", "INT", "FLOAT", "STRING", "ENUM", "POINTER"}
    of_all = one.identifier in bpy.types.Modifier.bl_rna.properties
    # Of a panel, whether it is open.
    panel = one.identifier.startswith("open_") and one.identifier.endswith("_panel")
    return not plain or of_all or panel or one.identifier in _ASIDE


def _at_first(one: bpy.types.Property) -> Any:
    """Value that a new modifier has."""
    if one.type == "POINTER":
        return None
    if one.type == "ENUM" and one.is_enum_flag:
        return one.default_flag
    return one.default_array if getattr(one, "is_array", False) else one.default


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
    if one.type == "ENUM" and one.is_enum_flag:
        return ",".join(sorted(value))
    return str(tuple(value) if getattr(one, "is_array", False) else value)
