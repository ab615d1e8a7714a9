"""Application handlers: work that ends or updates before Blender saves, loads or undoes."""

import atexit
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from ..core.bake.job import SCRATCH_WORDS
from ..core.errors import PalpateError
from ..core.files import scratch_folder
from ..operators.animation import live_pressers
from ..operators.bake import bake_session
from ..operators.carrier import carrier
from ..operators.layer import live_layer
from ..operators.object import body_store, kept_body
from ..operators.place import drawn_meshes
from ..operators.played import cache_place
from ..operators.scene import modal_stay
from ..operators.scene.package_preferences import preferences
from ..operators.session import press_session
from ..operators.session.press_events import Moment
from ..operators.tool import hull
from ..operators.tool.tool_sizes import keep_exact_sizes
from . import known_status
from .inspection import body_view
from .properties import from_file

# Body files before a save that may change the .blend's folder.
_found_before_save: dict[str, Path] = {}


def end_everything(reason: str) -> None:
    """Stop bake and press; nothing is left of either."""
    press_session.give_way(reason)
    bake = bake_session.current()
    if bake is not None:
        bake.end()


def _forget() -> None:
    known_status.forget()
    body_view.forget()
    live_pressers.forget()
    hull.forget()
    drawn_meshes.forget()


@persistent
def _before_load(*_: object) -> None:
    end_everything("Another file is being opened; pressing has ended")


@persistent
def _after_load(*_: object) -> None:
    from_file.mend_all()
    _forget()
    kept_body.forget()
    live_layer.remove_leftovers()
    for scene in bpy.data.scenes:
        keep_exact_sizes(scene)
        if not bpy.data.filepath:
            scene.palpate.source = preferences().default_source


@persistent
def _after_import(context: bpy.types.BlendImportContext, *_: object) -> None:
    from_file.mend_all()
    for item in context.import_items:
        if isinstance(item.id, bpy.types.Object) and carrier.is_carrier(item.id):
            carrier.unlink(item.id)
    known_status.forget()


@persistent
def _before_undo(*_: object) -> None:
    press_session.give_way("Undo; pressing has ended")


@persistent
def _after_undo(*_: object) -> None:
    _forget()
    live_layer.remove_leftovers()


@persistent
def _before_save(path: str = "", *_: object) -> None:
    session = press_session.current()
    if session is not None:
        session.post(Moment.SAVE_BEGINS)
    if path:
        try:
            cache_place.take_along(Path(path))
        except PalpateError as problem:
            _tell(problem)
    _found_before_save.clear()
    for thing in bpy.data.objects:
        file = body_store.locate(thing)
        if file is not None:
            _found_before_save[file.name] = file


@persistent
def _after_save(path: str = "", *_: object) -> None:
    written = Path(path or bpy.data.filepath)
    is_open_file = written == Path(bpy.data.filepath)
    cache_place.settle(is_open_file=is_open_file)
    try:
        if written.suffix == ".blend" and _found_before_save:
            body_store.gather_beside(written, _found_before_save, is_open_file=is_open_file)
    except PalpateError as problem:
        _tell(problem)
    finally:
        _end_of_save()


@persistent
def _after_failed_save(*_: object) -> None:
    cache_place.settle(is_open_file=False)
    _end_of_save()


def _tell(problem: PalpateError) -> None:
    """A handler has no report, only the console and the panel's state line."""
    print(f"palpate: {problem}")  # noqa: T201


def _end_of_save() -> None:
    known_status.forget_files()
    session = press_session.current()
    if session is not None:
        session.post(Moment.SAVE_ENDS)


@persistent
def _after_change(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    known_status.changed(depsgraph)
    updates = depsgraph.updates
    drawn_meshes.changed(depsgraph)
    body_view.changed(depsgraph)
    live_pressers.changed(depsgraph)
    if any(update.is_updated_transform for update in updates):
        live_pressers.follow_all(depsgraph)


@persistent
def _after_frame_change(_: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    drawn_meshes.changed(depsgraph)
    live_pressers.changed(depsgraph)
    live_pressers.follow_all(depsgraph)


def _before_exit() -> None:
    end_everything("")


HANDLERS = {
    "load_pre": _before_load,
    "load_post": _after_load,
    "blend_import_post": _after_import,
    "undo_pre": _before_undo,
    "redo_pre": _before_undo,
    "undo_post": _after_undo,
    "redo_post": _after_undo,
    "save_pre": _before_save,
    "save_post": _after_save,
    "save_post_fail": _after_failed_save,
    "depsgraph_update_post": _after_change,
    "frame_change_post": _after_frame_change,
}


def register() -> None:
    """Add the handlers, and remove what a Blender that was killed left behind."""
    scratch_folder.sweep(SCRATCH_WORDS)
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)
    atexit.register(_before_exit)


def unregister() -> None:
    """End everything and remove the handlers."""
    end_everything("Palpate was switched off; pressing has ended")
    modal_stay.end_all(bpy.context)
    kept_body.forget()
    live_pressers.forget()
    known_status.end()
    atexit.unregister(_before_exit)
    for name, handler in HANDLERS.items():
        getattr(bpy.app.handlers, name).remove(handler)
