"""An attribute of a mesh's vertices, whatever a stranger's file has under its name."""

from __future__ import annotations

import bpy


def point_attribute(mesh: bpy.types.Mesh, name: str, kind: str) -> bpy.types.Attribute:
    """Attribute of this name and data type on vertices; one of another kind makes room for it."""
    found = mesh.attributes.get(name)
    if found is not None and (found.data_type, found.domain) == (kind, "POINT"):
        return found
    if found is not None:
        mesh.attributes.remove(found)
    return mesh.attributes.new(name, kind, "POINT")
