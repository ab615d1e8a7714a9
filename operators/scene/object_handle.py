"""Handle of an object instead of a reference, since undo frees and replaces Blender's data."""

from __future__ import annotations

from dataclasses import dataclass

import bpy


@dataclass(frozen=True)
class ObjectHandle:
    """Object by its identity in this session; survives undo and renaming."""

    session_uid: int
    name: str

    @classmethod
    def of(cls, thing: bpy.types.Object) -> ObjectHandle:
        """Handle of an existing object."""
        return cls(thing.session_uid, thing.name)

    def find(self) -> bpy.types.Object | None:
        """The object, or None if it was deleted."""
        likely = bpy.data.objects.get(self.name)
        if likely is not None and likely.session_uid == self.session_uid:
            return likely
        return next((o for o in bpy.data.objects if o.session_uid == self.session_uid), None)
