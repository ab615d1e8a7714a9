"""How an object lay before it was pressed, to be given back."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from ..layer import layers
from . import rest_layer
from .laid import REMEMBERED


@dataclass(frozen=True, eq=False)
class Before:
    """An object's transform, what it remembers of that, and how it sags, flat (3 p,)."""

    matrix: Matrix
    scale: tuple[float, float, float]
    remembered: dict[str, object]
    sag: NDArray[np.float32] | None

    @classmethod
    def of(cls, thing: bpy.types.Object) -> Before:
        """How an object is now."""
        count = len(layers.drawn_mesh(thing).vertices)
        sag = rest_layer.shown(thing, count) if rest_layer.is_shown(thing) else None
        remembered = {name: _plain(getattr(thing.palpate, name)) for name in REMEMBERED}
        x, y, z = thing.scale
        return cls(thing.matrix_world.copy(), (x, y, z), remembered, sag)

    def give_back(self, thing: bpy.types.Object) -> None:
        """Have the object as it was."""
        if thing.matrix_world != self.matrix:
            thing.matrix_world = self.matrix
            thing.scale = self.scale
        for name, value in self.remembered.items():
            setattr(thing.palpate, name, value)
        if self.sag is None:
            rest_layer.remove(thing)
        else:
            rest_layer.show(thing, self.sag)


def _plain(value: object) -> object:
    """A value that stays as it is; Blender's arrays are views."""
    return tuple(value) if isinstance(value, Iterable) else value
