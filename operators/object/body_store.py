"""Files of objects' bodies: next to the .blend, or in the user's folder before there is one.

A file holds the compliance and may be large. If it is missing or damaged, the tetrahedra stored
with the object give the same body in seconds, without a new tetrahedralization.

The .blend may be a stranger's, and so is the name that it gives its body. It is looked up by
:func:`locate` only, if it is a name that Palpate gives (:mod:`...core.body.body_name`), and only in
these folders. What is no body file of Palpate's is never copied, replaced or deleted.
"""

from __future__ import annotations

import itertools
import os
import sys
from pathlib import Path

import bpy

from ...core.bake.job import run_bake
from ...core.body import body_file
from ...core.body.body_file import BodyFileError
from ...core.body.body_name import KEY_LETTERS, body_name, is_body_name
from ...core.body.soft_body import SoftBody
from ...core.errors import PalpateError
from ...core.files.own_file import is_free, is_ordinary, is_own, stays_within
from ...core.files.windows.long_path import reaching
from ...core.files.windows.set_aside import discard
from ..scene.package_preferences import PACKAGE, preferences
from . import baked_settings, embedded_body

FOLDER = "palpate"
# Settings of an object that go with its body.
FORGOTTEN = (
    "body_key",
    "body_file",
    "fingerprint",
    "baked_formulation",
    "baked_form",
    "preview_off",
)
NOT_SOFT = "{name} is not soft yet; press Make Soft first"

# Damaged files and their modification times: the panel offers to rebuild them.
_damaged: dict[Path, int] = {}
# Places that had a body file, perhaps another program's, when a new one was to be written there.
_replaced: set[Path] = set()


def place_for(thing: bpy.types.Object, key: str) -> Path:
    """Where the object's body of this ``key`` is written: ``<object>-<start of the key>.npz``.

    Nothing is there, or a body file of Palpate's; if something else is, the next name is taken.

    Raises
    ------
    PalpateError
        The folder beside the .blend leads elsewhere.
    """
    folder, word = folder_for_new_files(), bpy.path.clean_name(thing.name)
    places = (folder / body_name(word, key, number) for number in itertools.count(1))
    chosen = next(place for place in places if is_free(place, body_file.FORMAT))
    (_replaced.add if os.path.lexists(reaching(chosen)) else _replaced.discard)(chosen)
    return chosen


def folder_for_new_files() -> Path:
    """Folder next to the saved .blend; before saving that of the preferences, or the user's.

    Raises
    ------
    PalpateError
        The folder next to the .blend is a link to somewhere else.
    """
    return folder_beside(Path(bpy.data.filepath)) if bpy.data.filepath else _unsaved_folder()


def folder_beside(blend: Path) -> Path:
    """Folder next to a .blend.

    Raises
    ------
    PalpateError
        It is a link to somewhere else.
    """
    folder = blend.parent / FOLDER
    if not stays_within(folder, blend.parent):
        raise PalpateError(
            "{folder}: is a link to another place; put a folder there instead", folder=folder
        )
    return folder


def _unsaved_folder() -> Path:
    chosen = preferences().body_folder
    # Beside a .blend that is not saved is nowhere; preferences of before may have that.
    if chosen and not chosen.startswith("//"):
        return Path(chosen)
    if PACKAGE.startswith("bl_ext."):
        return Path(bpy.utils.extension_path_user(PACKAGE, path="bodies", create=True))
    return Path(bpy.utils.user_resource("DATAFILES", path=FOLDER, create=True))


def locate(thing: bpy.types.Object) -> Path | None:
    """Body file of the object, searched in all known folders.

    None also where the .blend gives a name that Palpate does not give.
    """
    baked = thing.palpate
    if not is_body_name(baked.body_file, baked.body_key):
        return None
    found = (place / baked.body_file for place in _places())
    return next(filter(is_ordinary, found), None)


def locate_key(key: str) -> Path | None:
    """Body file with this key, of any object."""
    found = (path for place in _places() for path in place.glob(f"*-{key[:KEY_LETTERS]}.npz"))
    bodies = (path for path in found if is_own(path, body_file.FORMAT))
    return next((path for path in bodies if not is_known_damaged(path)), None)


def _places() -> list[Path]:
    """Folders in which bodies are looked up."""
    blend = Path(bpy.data.filepath)
    is_beside = bpy.data.filepath and stays_within(blend.parent / FOLDER, blend.parent)
    return [*([blend.parent / FOLDER] if is_beside else []), _unsaved_folder()]


def load(thing: bpy.types.Object) -> SoftBody:
    """Read the object's body and check that it is this object's.

    Raises
    ------
    PalpateError
        Never baked.
    BodyFileError
        Missing, damaged, or another object's; Rebuild Body makes it again.
    """
    baked = thing.palpate
    if not baked.body_key:
        raise PalpateError(NOT_SOFT, name=thing.name)
    path = locate(thing)
    if path is None:
        raise BodyFileError(
            "{name}: its body file '{file}' is missing; press Rebuild Body",
            name=thing.name,
            file=baked.body_file if is_body_name(baked.body_file, baked.body_key) else "?",
        )
    return load_file(path, baked.body_key)


def load_file(path: Path, key: str) -> SoftBody:
    """Read a body file and check its key; remembers damaged files.

    Raises
    ------
    BodyFileError
        As for :func:`load`.
    """
    try:
        return _with_key(body_file.load(path), key, path)
    except BodyFileError:
        _damaged[path] = reaching(path).stat().st_mtime_ns
        raise


def _with_key(body: SoftBody, key: str, path: Path) -> SoftBody:
    if body.key != key:
        raise BodyFileError(
            "{path}: it is the body of something else than its name says; press Rebuild Body",
            path=path,
        )
    return body


def is_known_damaged(path: Path) -> bool:
    """Whether :func:`load` found this file damaged, and it is unchanged since."""
    return path in _damaged and _damaged[path] == reaching(path).stat().st_mtime_ns


def restore(thing: bpy.types.Object) -> SoftBody:
    """Compute a missing body again from the tetrahedra in the .blend, and store its file.

    Blocks: a second or two for a thousand free surface nodes.

    Raises
    ------
    PalpateError
        There are no tetrahedra, or they are not those of the body that was baked.
    """
    within, settings = embedded_body.embedded(thing), baked_settings.settings_of(thing)
    if not within.has_key(thing.palpate.body_key, settings):
        raise PalpateError(
            "{name}: the tetrahedra in this file are not those of its body; press Make Soft",
            name=thing.name,
        )
    target = place_for(thing, within.key(settings))
    python = (sys.executable, *bpy.app.python_args)
    body, _ = run_bake(within.mesh, within.baked_with(settings), target, python=python)
    thing.palpate.body_key, thing.palpate.body_file = body.key, target.name
    return body


def forget(thing: bpy.types.Object) -> None:
    """Remove the body: its file, unless shared with another object, and the object's record."""
    name, path = thing.palpate.body_file, locate(thing)
    shared = any(o != thing and o.palpate.body_file == name for o in bpy.data.objects)
    if path is not None and not shared:
        _delete(path)
    embedded_body.remove(thing)
    for setting in FORGOTTEN:
        thing.palpate.property_unset(setting)


def _delete(path: Path) -> None:
    """Delete a body file of Palpate's; leave anything else."""
    if is_own(path, body_file.FORMAT):
        discard(path)


def present() -> set[Path]:
    """Folder for new body files, and its contents."""
    folder = folder_for_new_files()
    return {folder, *folder.iterdir()} if folder.is_dir() else set()


def stamp(thing: bpy.types.Object) -> tuple[Path, int, int] | None:
    """The object's body file, and what tells it from another of the same name."""
    path = locate(thing)
    if path is None:
        return None
    about = reaching(path).lstat()
    return path, about.st_ino, about.st_mtime_ns


def take_back(
    thing: bpy.types.Object, before: set[Path], written: tuple[Path, int, int] | None
) -> None:
    """Remove the body file ``written``, by its :func:`stamp`, and its folder, if they are new.

    What was there :func:`before <present>` stays, with the folder; so does a file where another one
    stood when it was written, one that others have put there since, and one that is shared.
    """
    if written is None or stamp(thing) != written:
        return
    path = written[0]
    shared = any(o != thing and o.palpate.body_file == path.name for o in bpy.data.objects)
    if path in before or path in _replaced or shared:
        return
    _delete(path)
    if path.parent not in before and not any(path.parent.iterdir()):
        path.parent.rmdir()


def gather_beside(blend: Path, found: dict[str, Path], *, is_open_file: bool) -> None:
    """After a save, collect the body files at ``found`` (by name) in the folder next to ``blend``.

    Files in the user's folder, from before there was a .blend, are moved, others copied.

    Raises
    ------
    PalpateError
        The folder cannot be written, or leads elsewhere.
    """
    for name, source in found.items():
        target = folder_beside(blend) / name
        if os.path.lexists(reaching(target)) or not is_own(source, body_file.FORMAT):
            continue
        body_file.adopt(source, target)
        if is_open_file and source.parent == _unsaved_folder():
            _delete(source)
