"""The sample scene with the mouse, as scenarios find it, and what they do with it."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import bpy
from stage import Pixel, Stage, Wait

from bl_ext.user_default.palpate.addon.overlay.reading import reading
from bl_ext.user_default.palpate.operators.session import press_session
from bl_ext.user_default.palpate.operators.session.press_state import Phase

SCENE, NAME = "sample_scenes/mouse.blend", "Mouse"
# A place on the back, world coordinates: its inward normal points down and right on the screen.
BACK = (-0.027, -0.014, 0.057)


def mouse() -> Any:
    return bpy.data.objects[NAME]


def phase() -> Phase | None:
    session = press_session.current()
    return session.state.phase if session else None


def depth() -> float:
    """How deep the probe is, in metres."""
    return reading(press_session.current()).depth


def open_mouse(stage: Stage) -> Wait:
    """Open the mouse as it lies in the repository, without a body file: Press makes one."""
    stage.open_scene(own_copy(stage))
    yield 0.5
    # Without a graphics card it takes two thirds of a frame's time.
    stage.area.spaces.active.shading.show_cavity = False
    yield from stage.open_sidebar("Palpate")
    bpy.context.view_layer.objects.active = mouse()
    bpy.ops.ed.undo_push(message="Mouse opened")
    yield


def own_copy(stage: Stage, file: str = SCENE) -> str:
    """A copy of a scene, so that no body file is made or removed beside the repository's."""
    copy, scene = stage.files / "scene" / Path(file).name, stage.repository / file
    if not copy.is_file() or copy.stat().st_mtime < scene.stat().st_mtime:
        copy.parent.mkdir(exist_ok=True)
        shutil.copyfile(scene, copy)
    return str(copy)


def start_press(stage: Stage) -> Wait:
    yield from stage.move(stage.pixel(BACK))
    with stage.view():
        bpy.ops.palpate.press("INVOKE_DEFAULT")
    yield from stage.until(
        lambda: press_session.current() and press_session.current().snapshot, "the first tick"
    )


def drag_in(stage: Stage, *, release: bool = True) -> Wait:
    """Press the back with the pointer until it is well dented."""
    x, y = stage.pixel(BACK)
    yield from stage.drag([(x, y), (x + 25, y - 40)], release=release)
    yield from stage.until(lambda: depth() > 0.005, "a depth of 5 mm")


def type_key(stage: Stage, kind: str, **modifiers: bool) -> Wait:
    """Type a key with the mouse over the view."""
    yield from stage.move(over_the_view(stage))
    yield from stage.key(kind, **modifiers)


def end_press(stage: Stage) -> Wait:
    """Give a press up by Escape."""
    yield from type_key(stage, "ESC")
    yield from stage.until(lambda: press_session.current() is None, "the end of the press")


def over_the_view(stage: Stage) -> Pixel:
    region = stage.region("WINDOW")
    return (region.x + region.width / 3, region.y + region.height / 3)


def kept() -> list[str]:
    """Names of the mouse's modifiers: it has none but layers."""
    return list(mouse().modifiers.keys())
