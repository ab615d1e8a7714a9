"""Objects as Blender evaluates them: in a render the originals stay where the view has them."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError


def evaluated(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> bpy.types.Object:
    """The object as evaluated for a view, or for a render.

    Raises
    ------
    PalpateError
        It is not shown there, so that it is not moved either.
    """
    found = thing.evaluated_get(graph)
    if not found.is_evaluated:
        raise PalpateError(
            "{name} is not in this view layer or render, so it does not move there; show it, with "
            "its collection (what is hidden by H moves)",
            name=thing.name,
        )
    return found
