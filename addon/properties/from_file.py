"""Values from a file that no user interface could have set.

Blender keeps a file's values as they are: ranges and items of a property bind whoever sets it, not
the file. So they are looked at once, where they come in, and everybody else may rely on them.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

import bpy


def mend(group: bpy.types.PropertyGroup, held: Collection[str]) -> list[str]:
    """Give impossible values among those ``held`` of a group, by name, their defaults; the names of
    these properties.
    """
    known = group.bl_rna.properties
    properties = [known[name] for name in held if name in known]
    found = [
        one.identifier
        for one in properties
        if not one.is_readonly and not allows(one, getattr(group, one.identifier))
    ]
    for name in found:
        group.property_unset(name)
    return found


def mend_all() -> None:
    """The same for whatever is open; the console tells of it."""
    for owner in (*bpy.data.objects, *bpy.data.scenes):
        held = _held(owner)
        if held and (names := mend(owner.palpate, held)):
            # A handler has no report.
            print(f"palpate: {owner.name}: impossible values, now as at first: {', '.join(names)}")  # noqa: T201


def _held(owner: bpy.types.ID) -> Collection[str]:
    """Names of the values of Palpate's that a file holds for an object or a scene: of most there
    are none, and of thousands all are asked.
    """
    # Blender 5.0 keeps what extensions define apart from what users do.
    kept = owner.bl_system_properties_get() if bpy.app.version >= (5, 0) else owner
    group = None if kept is None else kept.get("palpate")
    # A stranger may have put anything there.
    return list(getattr(group, "keys", tuple)())


def allows(one: bpy.types.Property, value: Any) -> bool:
    """Whether a property could have been set to this value."""
    match one.type:
        case "ENUM":
            # Without items they depend on the moment, and are looked at there.
            return not one.enum_items or value in one.enum_items
        case "INT" | "FLOAT":
            numbers = value if one.is_array else (value,)
            return all(math.isfinite(n) and one.hard_min <= n <= one.hard_max for n in numbers)
        case _:
            return True
