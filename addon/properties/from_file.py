"""Values from a file that no user interface could have set.

Blender keeps a file's values as they are: ranges and items of a property bind whoever sets it, not
the file. So they are looked at once, where they come in, and everybody else may rely on them.
"""

from __future__ import annotations

import math
from typing import Any

import bpy


def mend(group: bpy.types.PropertyGroup) -> list[str]:
    """Give impossible values of a group their defaults; the names of these properties."""
    properties = [one for one in group.bl_rna.properties if not one.is_readonly]
    found = [
        one.identifier for one in properties if not allows(one, getattr(group, one.identifier))
    ]
    for name in found:
        group.property_unset(name)
    return found


def mend_all() -> None:
    """The same for whatever is open; the console tells of it."""
    for owner in filter(_has_values, (*bpy.data.objects, *bpy.data.scenes)):
        if names := mend(owner.palpate):
            # A handler has no report.
            print(f"palpate: {owner.name}: impossible values, now as at first: {', '.join(names)}")  # noqa: T201


def _has_values(owner: bpy.types.ID) -> bool:
    """Whether a file holds values of Palpate's for an object or a scene; quickly, for thousands."""
    # Blender 5.0 keeps what extensions define apart from what users do.
    held = owner.bl_system_properties_get() if bpy.app.version >= (5, 0) else owner
    return held is not None and bool(held.get("palpate"))


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
