"""Modifiers that make another number of vertices from frame to frame: no layer can follow them."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..layer import stack
from ..scene import curves
from . import seen_mesh

# What may make other vertices as time goes on, without a setting that is animated.
MAY_CHANGE = frozenset(
    [
        "BOOLEAN",
        "BUILD",
        "DECIMATE",
        "EXPLODE",
        "FLUID",
        "MASK",
        "NODES",
        "PARTICLE_INSTANCE",
        "REMESH",
        "SKIN",
        "VOLUME_TO_MESH",
        "WELD",
    ]
)


def refuse(thing: bpy.types.Object, scene: bpy.types.Scene) -> None:
    """Refuse an object whose modifiers make other vertices in other frames of the scene.

    Raises
    ------
    PalpateError
        The first of them that does, and the remedy.
    """
    made_by, now = stack.making(thing), scene.frame_current
    if not any(one.type in MAY_CHANGE or _is_animated(thing, one) for one in made_by):
        return
    first, last = scene.frame_start, scene.frame_end
    before = _counts(thing, made_by)
    try:
        for frame in sorted({first, (first + last) // 2, last} - {now}):
            scene.frame_set(frame)
            for modifier, then, here in zip(made_by, before, _counts(thing, made_by), strict=True):
                if then != here:
                    raise PalpateError(
                        "{name}: '{modifier}' makes {here} vertices in frame {frame} and {then} in "
                        "frame {now}, which no dent can follow; apply it, or set Bake From to Base "
                        "Mesh",
                        name=thing.name,
                        modifier=modifier.name,
                        here=here,
                        frame=frame,
                        then=then,
                        now=now,
                    )
    finally:
        if scene.frame_current != now:
            scene.frame_set(now)


def _counts(thing: bpy.types.Object, made_by: list[bpy.types.Modifier]) -> list[int]:
    """Vertices after each modifier."""
    counts = []
    for number in range(len(made_by)):
        with seen_mesh.made(thing, made_by[: number + 1]) as mesh:
            counts.append(len(mesh.vertices))
    return counts


def _is_animated(thing: bpy.types.Object, modifier: bpy.types.Modifier) -> bool:
    start = f"{modifier.path_from_id()}."
    data = thing.animation_data
    drivers = data.drivers if data is not None else ()
    return any(one.data_path.startswith(start) for one in (*curves.curves(thing), *drivers))
