"""Modifiers that make another number of vertices from frame to frame: no layer can follow them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ...core.errors import PalpateError
from ..layer import stack
from ..scene import curves
from . import seen_mesh

# Custom property of a scene that is there only to look at other frames.
ASIDE = "palpate_aside"
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
    with _aside(thing, scene) as aside:
        before = _counts(thing, made_by, aside)
        for frame in sorted({first, (first + last) // 2, last} - {now}):
            aside.frame_set(frame)
            found = _counts(thing, made_by, aside)
            for modifier, then, here in zip(made_by, before, found, strict=True):
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


def is_aside(scene: bpy.types.Scene) -> bool:
    """Whether a scene is there only to look at other frames."""
    return ASIDE in scene


@contextmanager
def _aside(thing: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    """Scene of an object alone at the present frame, which can go to others: the user's scene stays
    where it is, and what is moved and not keyed stays as it is.
    """
    now, part = scene.frame_current, scene.frame_subframe
    moving = [one.original for one in bpy.context.evaluated_depsgraph_get().ids]
    aside = bpy.data.scenes.new(scene.name)
    try:
        aside[ASIDE] = True
        aside.render.fps, aside.render.fps_base = scene.render.fps, scene.render.fps_base
        aside.collection.objects.link(thing)
        with curves.kept(moving):
            try:
                aside.frame_set(now, subframe=part)
                yield aside
            finally:
                # What is driven follows again.
                aside.frame_set(now, subframe=part)
    finally:
        bpy.data.scenes.remove(aside)
        bpy.context.view_layer.update()


def _counts(
    thing: bpy.types.Object, made_by: list[bpy.types.Modifier], aside: bpy.types.Scene
) -> list[int]:
    """Vertices after each modifier."""
    counts = []
    for number in range(len(made_by)):
        with seen_mesh.made(thing, made_by[: number + 1], aside.view_layers[0]) as mesh:
            counts.append(len(mesh.vertices))
    return counts


def _is_animated(thing: bpy.types.Object, modifier: bpy.types.Modifier) -> bool:
    start = f"{modifier.path_from_id()}."
    data = thing.animation_data
    drivers = data.drivers if data is not None else ()
    return any(one.data_path.startswith(start) for one in (*curves.curves(thing), *drivers))
