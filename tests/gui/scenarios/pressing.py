"""Pressing a soft object with the pointer, the way a user does it."""

from __future__ import annotations

import bpy
import numpy as np
from stage import Stage, Wait

SCENE, NAME = "sample_scenes/mouse.blend", "Mouse"


def _mouse() -> bpy.types.Object:
    return bpy.data.objects[NAME]


def _session():
    from bl_ext.user_default.palpate.operators import press_session

    return press_session.current()


def _ready(stage: Stage) -> Wait:
    """Open the mouse with its body there, the sidebar at Palpate."""
    stage.open_scene(SCENE)
    yield 0.5
    yield from stage.open_sidebar("Palpate")
    with stage.view():
        bpy.context.view_layer.objects.active = _mouse()
        bpy.ops.palpate.rebuild_body("EXEC_DEFAULT")
    yield


def _press(stage: Stage) -> Wait:
    with stage.view():
        bpy.ops.palpate.press("INVOKE_DEFAULT")
    yield 0.3
    assert _session() is not None


def _back(stage: Stage) -> tuple[float, float]:
    """A pixel on the mouse's back, well away from its ears."""
    return stage.pixel((-0.027, -0.014, 0.057))


def _coordinates() -> np.ndarray:
    mesh = _mouse().data
    flat = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.attributes["position"].data.foreach_get("vector", flat)
    return flat


def dragging_dents_the_surface_and_enter_keeps_the_shape(stage: Stage) -> Wait:
    yield from _ready(stage)
    yield from stage.picture("panel")
    yield from _press(stage)
    yield from stage.picture("ready")
    here = _back(stage)
    yield from stage.drag([here, (here[0], here[1] - 45)], release=False)
    yield 0.5
    yield from stage.picture("dragging")
    session = _session()
    assert session.snapshot.touching
    assert np.linalg.norm(session.snapshot.contact_force) > 0.005
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from stage.picture("held")
    yield from stage.key("RET")
    yield from stage.until(lambda: _session() is None, "the end of the press")
    assert _mouse().data.shape_keys.key_blocks.keys() == ["Basis", "Press 1"]
    yield from stage.picture("kept")
