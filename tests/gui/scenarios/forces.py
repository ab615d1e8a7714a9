"""A device with motors in the window: letting it go, and recording what it does."""

from __future__ import annotations

import bpy
import numpy as np
from mouse_scene import depth, end_press, open_mouse, start_press, type_key
from shown import all_panels_open
from stage import Stage, Wait, at_length

from bl_ext.user_default.palpate.core.record.read_recording import read_recording
from bl_ext.user_default.palpate.operators.session import press_session
from bl_ext.user_default.palpate.operators.session.press_state import CALM_SECONDS


@at_length
def space_lets_the_device_go_and_what_it_did_is_saved(stage: Stage) -> Wait:
    with all_panels_open():
        yield from open_mouse(stage)
        chosen = bpy.context.scene.palpate
        chosen.source, chosen.record_from_start = "SIMULATED", True
        yield from start_press(stage)
        yield from stage.until(lambda: depth() > 0.008, "the device's press")
        yield from stage.picture("touching")
        yield from type_key(stage, "SPACE")
        yield from stage.until(lambda: _state() == "disabled", "the limp device")
        assert not np.any(press_session.current().snapshot.output_force)
        yield from stage.picture("let-go")
        yield CALM_SECONDS
        yield from type_key(stage, "SPACE")
        yield from stage.until(lambda: _state() in {"ramping", "free", "touching"}, "its return")
        yield from end_press(stage)
    path = stage.files / "recording.npz"
    assert bpy.ops.palpate.save_recording(filepath=str(path)) == {"FINISHED"}
    samples = read_recording(path).samples
    # Not one tick is missing, though drawing took a quarter of a second for each frame.
    assert np.array_equal(samples["tick"], np.arange(1, len(samples) + 1))


def _state() -> str:
    return str(press_session.current().snapshot.state)
