"""The sample scenes open ready to press, and the drumstick's bone is felt."""

from __future__ import annotations

import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest
from soft_scene import part, select

SCENES = Path(__file__).resolve().parents[2] / "sample_scenes"
MATERIALS = {"cube": "PAPER_CUBE", "mouse": "PLUSH", "drumstick": "JELLY"}
# Places on top, metres: where the meat tapers over the bone, and where it is thick.
OVER_BONE, OVER_MEAT = (0.048, 0.0, 0.0335), (-0.02, 0.0, 0.068)


def opened(name, folder):
    copy = folder / f"{name}.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    return select(bpy.data.objects[name.title()])


def force(thing, at):
    pressed = part("operators.press_once").press_once(
        thing, bpy.context.scene, at, (0.0, 0.0, -0.004), keep=False
    )
    return np.linalg.norm(pressed.force)


@pytest.mark.parametrize("name", MATERIALS)
def test_a_sample_scene_only_lacks_its_body_file(palpate, tmp_path, name):
    thing = opened(name, tmp_path)
    status = part("operators.soft_object").body_status(thing, bpy.context.scene)
    assert status.fit.name == "FILE_MISSING"
    assert status.changed == ()
    assert status.pins.fit.name == "SAME"
    assert thing.palpate.material == MATERIALS[name]


def test_the_bone_in_the_drumstick_is_felt_and_only_where_it_is(palpate, tmp_path):
    thing = opened("drumstick", tmp_path)
    boned = {place: force(thing, place) for place in (OVER_BONE, OVER_MEAT)}
    thing.palpate.stiff_group = ""
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    boneless = {place: force(thing, place) for place in (OVER_BONE, OVER_MEAT)}
    assert boned[OVER_BONE] > 1.4 * boned[OVER_MEAT]
    assert boneless[OVER_BONE] < boneless[OVER_MEAT]
    assert boned[OVER_BONE] > 2 * boneless[OVER_BONE]
    assert boned[OVER_MEAT] < 1.3 * boneless[OVER_MEAT]
