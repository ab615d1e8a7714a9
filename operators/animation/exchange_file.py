"""Alembic and USD: an animation as a file that other programs read too.

Blender writes the file from a twin of the object that plays a point cache, and its own modifier
plays it again; both without Palpate.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from enum import Enum
from pathlib import Path

import bpy

from ...core.errors import PalpateError
from ...core.files.atomic_file import atomic_file
from ...core.files.point_cache import CacheSize
from ..layer import layers
from ..played import mesh_cache
from ..scene.active_object import chosen_alone
from ..traction.frame_tractions import FrameTractions, shown_by

TWIN, MESH = "palpate_surface", "palpate_surface_mesh"


class Exchange(Enum):
    """Kind of file, by its suffix."""

    ALEMBIC = ".abc"
    USD = ".usdc"

    @property
    def holds_attributes(self) -> bool:
        """Whether Blender writes attributes of vertices into it, frame by frame."""
        return self is Exchange.USD

    @property
    def is_built_in(self) -> bool:
        """Whether this Blender writes it."""
        options = bpy.app.build_options
        return bool(options.alembic if self is Exchange.ALEMBIC else options.usd)


def write(
    thing: bpy.types.Object,
    scene: bpy.types.Scene,
    cache: Path,
    size: CacheSize,
    target: Path,
    kind: Exchange,
    forces: FrameTractions | None = None,
) -> str:
    """Write what a point cache has of an object's vertices, and what they bear where that is given;
    returns the surface's path in the file.

    A file that was there stays as it was until the new one is whole.

    Raises
    ------
    PalpateError
        Blender could not write it.
    """
    made = cache.with_suffix(kind.value)
    with _twin(thing, scene, cache, size) as twin:
        with nullcontext() if forces is None else shown_by(twin.data, forces):
            _export(twin, scene, size, made, kind)
        path = _path_of(twin, kind)
    if not made.is_file():
        raise PalpateError(
            "{path}: Blender wrote no file; keep the animation as a Mesh Cache", path=target
        )
    _close(thing)
    with (
        made.open("rb") as exported,
        atomic_file(target, make_folders=True, follows_links=False) as file,
    ):
        shutil.copyfileobj(exported, file)
    return path


def play(thing: bpy.types.Object, target: Path, path: str, *, attributes: bool) -> None:
    """Let the object's modifier play a file, before all that deforms the mesh further; with the
    attributes of its vertices, or their places alone.

    Raises
    ------
    PalpateError
        Blender does not open it; what the object played before stays.
    """
    before = set(bpy.data.cache_files)
    bpy.ops.cachefile.open(filepath=str(target), relative_path=False)
    opened = next(one for one in bpy.data.cache_files if one not in before)
    if not _has(opened, path):
        bpy.data.batch_remove([opened])
        raise PalpateError(
            "{path}: Blender wrote this file and does not open it there; choose a Body Folder "
            "without letters beyond a to z, or keep the animation as a Mesh Cache",
            path=target,
        )
    opened.filepath = mesh_cache.shortest(target)
    modifier = mesh_cache.modifier_of(thing, "MESH_SEQUENCE_CACHE")
    modifier.cache_file, modifier.object_path = opened, path
    modifier.read_data = {"VERT", "ATTRIBUTES"} if attributes else {"VERT"}


def _has(opened: bpy.types.CacheFile, path: str) -> bool:
    """Whether an opened file has a surface: it is read as somebody plays it."""
    mesh = bpy.data.meshes.new(MESH)
    reader = bpy.data.objects.new(TWIN, mesh)
    try:
        bpy.context.scene.collection.objects.link(reader)
        modifier = reader.modifiers.new(TWIN, "MESH_SEQUENCE_CACHE")
        modifier.cache_file, modifier.object_path = opened, path
        bpy.context.view_layer.update()
        return any(one.path == path for one in opened.object_paths)
    finally:
        bpy.data.objects.remove(reader)
        bpy.data.meshes.remove(mesh)


def _close(thing: bpy.types.Object) -> None:
    """Let go of the file that is played: where it is open it cannot be replaced."""
    modifier = thing.modifiers.get(mesh_cache.MODIFIER_NAME)
    if modifier is not None and modifier.type == "MESH_SEQUENCE_CACHE":
        played = modifier.cache_file
        modifier.cache_file = None
        # Its own count has one too many from the operator that opened it.
        if played is not None and not bpy.data.user_map(subset={played})[played]:
            bpy.data.batch_remove([played])
        # What was evaluated has it open, too, until there is something newer: Windows would mind.
        bpy.context.view_layer.update()


@contextmanager
def _twin(
    thing: bpy.types.Object, scene: bpy.types.Scene, cache: Path, size: CacheSize
) -> Iterator[bpy.types.Object]:
    """Object of the same mesh, at the same place in every frame, that plays a cache; the only one
    that is selected.
    """
    mesh = layers.drawn_mesh(thing).copy()
    mesh.name = MESH
    twin = bpy.data.objects.new(TWIN, mesh)
    try:
        twin.shape_key_clear()
        scene.collection.objects.link(twin)
        twin.constraints.new("COPY_TRANSFORMS").target = thing
        mesh_cache.play(twin, cache, size)
        with chosen_alone(twin):
            yield twin
    finally:
        bpy.data.objects.remove(twin)
        bpy.data.meshes.remove(mesh)


def _export(
    twin: bpy.types.Object, scene: bpy.types.Scene, size: CacheSize, made: Path, kind: Exchange
) -> None:
    first = int(size.first_frame)
    last = first + int(size.step) * (size.samples - 1)
    if kind is Exchange.ALEMBIC:
        bpy.ops.wm.alembic_export(
            filepath=str(made), start=first, end=last, selected=True, as_background_job=False
        )
        return
    shown = scene.frame_start, scene.frame_end
    scene.frame_start, scene.frame_end = first, last
    try:
        bpy.ops.wm.usd_export(
            filepath=str(made),
            selected_objects_only=True,
            export_animation=True,
            export_materials=False,
        )
    finally:
        scene.frame_start, scene.frame_end = shown


def _path_of(twin: bpy.types.Object, kind: Exchange) -> str:
    # A name that is taken gets a number after a dot, which both kinds of file know as a line.
    names = (one.name.replace(".", "_") for one in (twin, twin.data))
    return "/".join(("" if kind is Exchange.ALEMBIC else "/root", *names))
