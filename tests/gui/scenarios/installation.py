"""The extension is there once installed, and what is typed arrives as from a user's hands."""

from __future__ import annotations

import bpy
from stage import MODULE, Stage, Wait, at_length
from storm.random_events import storm


def the_extension_is_enabled_after_installation(stage: Stage) -> Wait:
    yield
    assert MODULE in bpy.context.preferences.addons


def the_sidebar_has_a_tab_palpate(stage: Stage) -> Wait:
    yield from stage.open_sidebar("Palpate")
    yield from stage.picture("sidebar")
    assert stage.region("UI").active_panel_category == "Palpate"


def keys_and_mouse_move_an_object_and_take_it_back(stage: Stage) -> Wait:
    x, y = stage.pixel((0.0, 0.0, 0.0))
    yield from stage.click((x, y))
    yield from stage.key("G")
    yield from stage.move((x + 100, y))
    yield from stage.move((x + 150, y))
    yield from stage.click((x + 150, y))
    yield from stage.until(lambda: bpy.data.objects["Cube"].location.length > 0.1, "the move")
    yield from stage.key("Z", ctrl=True)
    yield from stage.until(lambda: bpy.data.objects["Cube"].location.length < 1e-6, "the undo")


def dragging_draws_a_selection_box(stage: Stage) -> Wait:
    """Runs after a scenario with a modifier key, which Blender must not hold any more."""
    x, y = stage.pixel((0.0, 0.0, 0.0))
    with stage.view():
        bpy.ops.object.select_all(action="DESELECT")
    yield from stage.drag([(x - 200, y - 200), (x + 200, y + 200)])
    yield from stage.until(bpy.data.objects["Cube"].select_get, "the selection")


@at_length
def random_events_leave_the_meshes_and_nothing_running(stage: Stage) -> Wait:
    yield from storm(stage, seed=16, count=200)
