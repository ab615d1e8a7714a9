"""Where the files are that animations play from: in the folder beside the .blend.

Before there is a .blend they are in Blender's own temporary folder, as its caches are, and the
first save takes them along. Temporary files stay until Blender ends: undo may play them again.
"""

from __future__ import annotations

import itertools
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import bpy

from ...core.files.atomic_file import atomic_file
from ...core.files.own_file import is_ordinary
from ...core.files.point_cache import is_own_cache
from ..layer.stack import PLAYERS
from ..object import body_store
from ..scene.object_handle import ObjectHandle
from .mesh_cache import MODIFIER_NAME

CACHE_SUFFIX = ".pc2"
UNSAVED_STEM = "untitled"

# What the last save took along: objects, and the paths that they played before.
_taken: list[tuple[ObjectHandle, str]] = []


def place_for(thing: bpy.types.Object, suffix: str) -> Path:
    """Where the object's animation is written: beside its body file, or among temporary files
    before there is a .blend; ``<.blend>-<object>-animation`` and suffix.

    Nothing is there, or what is Palpate's own and only this object plays; if anything else is, the
    next name is taken. Another object, or another .blend of the folder, keeps its animation so.

    Raises
    ------
    PalpateError
        The folder beside the .blend leads elsewhere.
    """
    if not bpy.data.filepath:
        return _place_in(_unsaved_folder(), UNSAVED_STEM, thing, suffix)
    blend = Path(bpy.data.filepath)
    return _place_in(body_store.folder_beside(blend), blend.stem, thing, suffix)


def take_along(blend: Path) -> None:
    """Before a save as ``blend``: copy beside it what temporary files play, and play that.

    Raises
    ------
    PalpateError
        The folder beside it leads elsewhere, or cannot be written.
    """
    _taken.clear()
    temporary = _unsaved_folder().resolve()
    for thing in bpy.data.objects:
        holder, file = _holder(thing), _played(thing)
        if holder is None or file is None or not file.is_relative_to(temporary):
            continue
        if not _owned(file.suffix)(file):
            continue
        target = _place_in(body_store.folder_beside(blend), blend.stem, thing, file.suffix)
        with (
            file.open("rb") as source,
            atomic_file(target, make_folders=True, follows_links=False) as copy,
        ):
            shutil.copyfileobj(source, copy)
        _taken.append((ObjectHandle.of(thing), holder.filepath))
        _play(holder, f"//{target.parent.name}/{target.name}")


def settle(*, is_open_file: bool) -> None:
    """After a save: go on with what was taken along, or back to the temporary files where the open
    file was not saved, or a copy of it.
    """
    for handle, before in _taken:
        thing = handle.find()
        holder = None if thing is None else _holder(thing)
        if holder is not None:
            _play(holder, holder.filepath if is_open_file else before)
    _taken.clear()


def _unsaved_folder() -> Path:
    return Path(bpy.app.tempdir) / body_store.FOLDER


def _place_in(folder: Path, stem: str, thing: bpy.types.Object, suffix: str) -> Path:
    word, is_own = bpy.path.clean_name(f"{stem}-{thing.name}"), _owned(suffix)
    names = itertools.chain(
        (f"{word}-animation{suffix}",),
        (f"{word}-animation-{n}{suffix}" for n in itertools.count(2)),
    )
    places = (folder / name for name in names)
    return next(
        place
        for place in places
        if not os.path.lexists(place) or (is_own(place) and _players(place) == [thing])
    )


def _owned(suffix: str) -> Callable[[Path], bool]:
    """What tells a file of Palpate's; of other programs' kinds any ordinary one may be."""
    return is_own_cache if suffix == CACHE_SUFFIX else is_ordinary


def _players(file: Path) -> list[bpy.types.Object]:
    """Objects that play a file."""
    found = file.resolve()
    return [one for one in bpy.data.objects if _played(one) == found]


def _played(thing: bpy.types.Object) -> Path | None:
    """File that the object's modifier plays, shown or not."""
    holder = _holder(thing)
    if holder is None or not holder.filepath:
        return None
    library = getattr(holder, "library", thing.library)
    return Path(bpy.path.abspath(holder.filepath, library=library)).resolve()


def _holder(
    thing: bpy.types.Object,
) -> bpy.types.MeshCacheModifier | bpy.types.CacheFile | None:
    """What has the path of the object's animation: its modifier, or a data-block of that."""
    modifier = thing.modifiers.get(MODIFIER_NAME)
    if modifier is None or modifier.type not in PLAYERS:
        return None
    return getattr(modifier, "cache_file", modifier)


def _play(holder: bpy.types.MeshCacheModifier | bpy.types.CacheFile, path: str) -> None:
    holder.filepath = path
    holder.id_data.update_tag()
