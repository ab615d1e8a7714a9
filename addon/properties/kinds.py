"""Kinds of properties, each declared with its name, its description and its numbers."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

LARGEST = 3.4028234663852886e38
"""Upper bound of a number without one, as Blender has it."""
OF_RESULTS = {
    str: bpy.props.StringProperty,
    int: bpy.props.IntProperty,
    float: bpy.props.FloatProperty,
}


def span(low: float, high: float = LARGEST, **more: object) -> dict[str, object]:
    """From where to where a number goes; ``more`` as of Blender's FloatProperty."""
    return {"min": low, "max": high, **more}


LENGTHS = span(1e-6, soft_max=10.0, precision=4, step=0.1, subtype="DISTANCE", unit="LENGTH")


def number(
    name: str, description: str, default: float, within: dict[str, object], **more: object
) -> object:
    """Whole number, or any, as its default is."""
    kind = bpy.props.IntProperty if isinstance(default, int) else bpy.props.FloatProperty
    return kind(name=name, description=description, default=default, **within, **more)


def length(name: str, description: str, default: float, **more: object) -> object:
    """Length in scene units, over 0."""
    return number(name, description, default, LENGTHS, **more)


def switch(name: str, description: str, *, on: bool = False, **more: object) -> object:
    """Something that is on or off."""
    return bpy.props.BoolProperty(name=name, description=description, default=on, **more)


def choice(
    name: str, description: str, items: Sequence[tuple[object, ...]], default: str, **more: object
) -> object:
    """One of several items."""
    return bpy.props.EnumProperty(
        name=name, description=description, items=items, default=default, **more
    )


def text(name: str, description: str, default: str = "", **more: object) -> object:
    """A word, such as the name of a vertex group, or a path."""
    return bpy.props.StringProperty(name=name, description=description, default=default, **more)


def chosen_object(name: str, description: str, kind: str | None = None) -> object:
    """An object of the scene, of a ``kind`` such as "EMPTY" where one is named."""
    return bpy.props.PointerProperty(
        name=name,
        description=description,
        type=bpy.types.Object,
        poll=lambda _, candidate: kind in {None, candidate.type},
    )


def chosen_collection(name: str, description: str, **more: object) -> object:
    """A collection of objects."""
    return bpy.props.PointerProperty(
        name=name, description=description, type=bpy.types.Collection, **more
    )


def result(default: str | float, **more: object) -> object:
    """What operators write, and nobody else; of the type of ``default``."""
    return OF_RESULTS[type(default)](default=default, options={"HIDDEN"}, **more)
